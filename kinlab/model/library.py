"""Names to robots: the shipped tables, example-robot-data, and files; and the door for arms.

Every public function that is about an arm opens with ``robot = as_robot(robot)``: whatever names an
arm is one.
"""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from functools import cache, lru_cache
from pathlib import Path
from typing import Any, Protocol
from weakref import WeakKeyDictionary

import pinocchio as pin

from kinlab.arrays import shown
from kinlab.errors import FileError, NameUnknownError, StructureError, near
from kinlab.host.files import read_text
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot

# -------- Where the robots that kinlab ships lie: inside the wheel, or beside the package
#          in a checkout

_PACKAGE = Path(__file__).resolve().parents[1]


def robots_dir() -> Path:
    """The folder of the shipped DH tables (``*.toml``)."""
    shipped = _PACKAGE / "robots"
    return shipped if shipped.is_dir() else _PACKAGE.parent / "robots"


@cache
def presets() -> dict[str, Path]:
    """The shipped five-bars, name to file."""
    files = sorted((robots_dir() / "fivebar").glob("*.toml"))
    return {file.stem: file for file in files if file.stem != "motors"}


# -------- Names to robots: the shipped tables, example-robot-data, and files

TABLES, URDFS = (".toml", ".csv"), (".urdf", ".xml")
"""Ends of the names of files that hold an arm."""

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
        tool: for a URDF: the link that is the tool. A DH table has one tool, and takes no other
            name than its own.

    Returns:
        The robot.

    Raises:
        NameUnknownError: no robot of that name, or no such tool; the near names are listed.
        FileError: the file is missing or of another kind.
        TableError, UrdfError, StructureError: the file is not a sound serial arm.
    """
    if tool is not None and not isinstance(tool, str):
        raise NameUnknownError(f"tool is {shown(tool)}; give a link's name")
    text = str(name_or_path)
    suffix = Path(text).suffix.lower()
    if suffix in TABLES:
        return _of_table(DHTable.load(text), tool, text)
    if suffix in URDFS:
        return Robot.from_urdf(text, tool)
    if text in shipped():
        return _of_table(DHTable.load(shipped()[text].path), tool, text)
    plain = text.removeprefix(DATA_PREFIX)
    entry = example_robots().get(plain)
    if entry is not None:
        robot = Robot.from_urdf(entry.path, tool)
        source = f"example-robot-data, {entry.path.name}"
        return Robot(plain, robot.model, robot.tool, robot.urdf, None, robot.folder, source)
    raise _unknown(text)


def _of_table(table: DHTable, tool: str | None, text: str) -> Robot:
    """The robot of a table, whose one tool may be named but not chosen."""
    if tool is not None and tool != table.tool_name:
        told = f"a DH table has one tool, here {table.tool_name!r}; leave tool {shown(tool)} out"
        if text in example_robots():
            told += f", or take the URDF, whose links have names: {DATA_PREFIX + text!r}"
        raise NameUnknownError(f"{text}: {told}")
    return Robot.from_dh(table)


def _unknown(text: str) -> FileError | NameUnknownError:
    """Why a text names no robot: it is nearly a path, a five-bar, or nearly a name."""
    suffix = Path(text).suffix
    kinds = f"a robot file ends in {', '.join(TABLES)} or {URDFS[0]}"
    if suffix or "/" in text or _exists(text):
        kinds = kinds if suffix or _exists(text) else f"no such file; {kinds}"
        like = near(suffix.lower(), [*TABLES, *URDFS]) if suffix else ""
        if not like.startswith("did you mean"):
            return FileError(f"{shown(text)}: {kinds}")
        meant = Path(text).with_suffix(like.split("'")[1])
        return FileError(f"{shown(text)}: {kinds}; did you mean {shown(str(meant))}?")
    if text in presets():
        return NameUnknownError(
            f"{text!r} is a five-bar, not a serial arm: kinlab fivebar analyse {text}, or "
            f"kl.FiveBar.load({text!r})"
        )
    names = [*shipped(), *example_robots()]
    return NameUnknownError(f"robot {shown(text)} is unknown; {near(text, names)} (kinlab list)")


def _exists(text: str) -> bool:
    """Whether there is such a file; what is no path at all is none."""
    try:
        return Path(text).exists()
    except (OSError, ValueError):
        return False


# -------- The door: whatever names an arm is an arm


class PinModel(Protocol):
    """What type checkers ask of a ``pin.Model``, which comes without types of its own."""

    nq: int
    nv: int
    njoints: int


ArmLike = Robot | DHTable | PinModel | str | Path
"""What every public function takes for its robot: see :func:`as_robot`."""


def as_robot(arm: ArmLike) -> Robot:
    """The robot that a caller means.

    What ships, and a table, is built once. A file is read at each call, and its robot built again
    where what it says has changed.

    Args:
        arm: a Robot, which comes back as it is; a DHTable; a ``pin.Model`` whose joints form one
            chain (its tool is the last body frame); or a name or path as for :func:`load`.

    Raises:
        StructureError: none of these, or a model that is no chain.
        KinlabError: as :func:`load`.
    """
    if isinstance(arm, Robot):
        return arm
    if isinstance(arm, (str, Path)):
        return _named(str(arm))
    if isinstance(arm, DHTable):
        robot = _BUILT.get(arm)
        if robot is None:
            robot = _BUILT[arm] = Robot.from_dh(arm)
        return robot
    if isinstance(arm, pin.Model):
        return Robot.from_model(arm)
    raise no_arm(arm)


def no_arm(given: Any) -> StructureError:
    """What to tell someone who gave something else for an arm."""
    kind = given.__name__ if isinstance(given, type) else type(given).__name__
    if kind == "FiveBar":
        told = "a five-bar's functions are its methods, as five_bar.ik(xy)"
    else:
        told = "give a Robot, a DHTable, a pin.Model, a name (kinlab list), or a path of kl.load"
    return StructureError(f"robot: {kind} is no serial arm; {told}")


_BUILT: WeakKeyDictionary[DHTable, Robot] = WeakKeyDictionary()


def _named(text: str) -> Robot:
    if Path(text).suffix.lower() in (*TABLES, *URDFS):
        return _of_file(text, Path(text).absolute(), read_text(text))
    return _shipped_robot(text)


@cache
def _shipped_robot(name: str) -> Robot:
    return load(name)


@lru_cache(maxsize=32)
def _of_file(text: str, place: Path, content: str) -> Robot:
    """A file's robot; the place and the content are what it is remembered by."""
    del place, content
    return load(text)


def mesh_folders(robot: Robot) -> list[Path]:
    """Where mesh names of a robot's URDF may start: its own folders, then example-robot-data."""
    folders = [] if robot.folder is None else [robot.folder, *robot.folder.parents]
    if example_robots():
        data = _data_folder().resolve()
        folders += [data.parent.parent, data.parent, data]
    return folders
