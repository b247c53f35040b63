"""Names to robots: the shipped tables, example-robot-data, and files."""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from kinlab.arrays import shown
from kinlab.errors import FileError, NameUnknownError, near
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot

# -------- Where the robots that kinlab ships lie: inside the wheel, or beside the package
#          in a checkout

_PACKAGE = Path(__file__).resolve().parents[1]


def robots_dir() -> Path:
    """The folder of the shipped DH tables (``*.toml``)."""
    shipped = _PACKAGE / "robots"
    return shipped if shipped.is_dir() else _PACKAGE.parent / "robots"


# -------- Names to robots: the shipped tables, example-robot-data, and files

DATA_PREFIX = "erd:"
"""Put before a name to mean example-robot-data where a shipped table has the same name."""


@dataclass(frozen=True)
class Entry:
    """One name that :func:`load` knows.

    Attributes:
        name: what to give to ``load``.
        path: the TOML or URDF file.
        origin: ``"kinlab"`` or ``"example-robot-data"``.
    """

    name: str
    path: Path
    origin: str


@cache
def shipped() -> dict[str, Entry]:
    """The DH tables in ``robots/``, by name."""
    files = sorted(robots_dir().glob("*.toml"))
    return {file.stem: Entry(file.stem, file, "kinlab") for file in files}


@cache
def example_robots() -> dict[str, Entry]:
    """The URDFs of example-robot-data, by name."""
    spec = importlib.util.find_spec("example_robot_data")
    if spec is None:
        return {}
    from example_robot_data import robots_loader

    folder = _data_folder()
    entries = {}
    for name, loader in sorted(robots_loader.ROBOTS.items()):
        path = folder / loader.path / loader.urdf_subpath / loader.urdf_filename
        # a few loaders build from SDF or from several files; only plain URDFs are listed
        if loader.urdf_filename and path.is_file():
            entries[name] = Entry(name, path, "example-robot-data")
    return entries


def _data_folder() -> Path:
    """The ``robots`` folder of example-robot-data."""
    from example_robot_data import utils

    return Path(utils.getModelPath("ur_description"))  # the wheel's own constant is wrong


def load(name_or_path: str | Path, tool: str | None = None) -> Robot:
    """Loads a robot by name or from a file.

    Args:
        name_or_path: a shipped table ("puma560", "planar2r"), a robot of example-robot-data
            ("kinova"; ``"erd:ur5"`` where a shipped table has the same name), or a path that
            ends in .toml, .csv or .urdf.
        tool: for a URDF: the link that is the tool.

    Returns:
        The robot.

    Raises:
        NameUnknownError: no robot of that name; the near names are listed.
        FileError: the file is missing or of another kind.
        TableError, UrdfError, StructureError: the file is not a sound serial arm.
    """
    if tool is not None and not isinstance(tool, str):
        raise NameUnknownError(f"tool is {shown(tool)}; give a link's name")
    text = str(name_or_path)
    suffix = Path(text).suffix.lower()
    if suffix in (".toml", ".csv"):
        _refuse_tool(tool, text)
        return Robot.from_dh(DHTable.load(text))
    if suffix in (".urdf", ".xml"):
        return Robot.from_urdf(text, tool)
    plain = text.removeprefix(DATA_PREFIX)
    if text in shipped() and (tool is None or tool == _tool_of(text)):
        return Robot.from_dh(DHTable.load(shipped()[text].path))
    entry = example_robots().get(plain)
    if entry is not None:
        robot = Robot.from_urdf(entry.path, tool)
        source = f"example-robot-data, {entry.path.name}"
        return Robot(plain, robot.model, robot.tool, robot.urdf, None, robot.folder, source)
    _refuse_tool(tool, text)
    if _exists(text):
        raise FileError(f"{text}: a robot file ends in .toml, .csv or .urdf")
    names = [*shipped(), *example_robots()]
    raise NameUnknownError(f"robot {shown(text)} is unknown; {near(text, names)} (kinlab list)")


def _exists(text: str) -> bool:
    """Whether there is such a file; what is no path at all is none."""
    try:
        return Path(text).exists()
    except (OSError, ValueError):
        return False


def _tool_of(name: str) -> str:
    return DHTable.load(shipped()[name].path).tool_name


def _refuse_tool(tool: str | None, text: str) -> None:
    if tool is not None:
        raise NameUnknownError(f"{text}: a DH table has one tool; leave tool {shown(tool)} out")


def mesh_folders(robot: Robot) -> list[Path]:
    """Where mesh names of a robot's URDF may start: its own folders, then example-robot-data."""
    folders = [] if robot.folder is None else [robot.folder, *robot.folder.parents]
    if example_robots():
        data = _data_folder().resolve()
        folders += [data.parent.parent, data.parent, data]
    return folders
