"""Commands about robots: list, info, urdf, dh."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.cli.screen import echo, fine_table, plain_table, screen, styled, wrote
from kinlab.host.language import N_, _

if TYPE_CHECKING:
    from rich.table import Table

    from kinlab.model.dh import DHTable
    from kinlab.model.robot import Robot

NAME = Annotated[str, typer.Argument(help="A name from `kinlab list`, or a .toml/.csv/.urdf file.")]
TOOL = Annotated[
    str | None,
    typer.Option("--tool", help="Link that is the tool (URDF; a DH table has one of its own)."),
]
OUTPUT = Annotated[Path | None, typer.Option("--output", "-o", help="Write to this file.")]


_JOINT_COLUMNS = (
    N_("joint"),
    N_("kind"),
    N_("lower"),
    N_("upper"),
    N_("velocity"),
    N_("effort"),
    N_("mass"),
    N_("armature"),
)
_KINDS = (N_("revolute"), N_("prismatic"))


def list_robots() -> None:
    """List the robots that can be loaded by name."""
    from kinlab.errors import KinlabError
    from kinlab.model.library import DATA_PREFIX, example_robots, load, shipped

    width = max(len(name) for name in [*shipped(), *example_robots()])
    table = plain_table(_("name"), _("DoF"), _("source"), right=(1,))
    table.columns[0].min_width, table.columns[1].min_width = width, 3
    for name in shipped():
        robot = load(name)
        table.add_row(name, str(robot.n), robot.source.split("; ")[0])
    for name, entry in example_robots().items():
        shown = DATA_PREFIX + name if name in shipped() else name
        try:
            robot = load(DATA_PREFIX + name)
            about = f"example-robot-data, {entry.path.name}"
            table.add_row(shown, str(robot.n), about)
        except KinlabError as problem:
            reason = _("a tree: name a tool") if "a tree" in str(problem) else str(problem)
            table.add_row(shown, "-", styled((f"example-robot-data, {reason}", "dim")))
    screen().print(table)


def info(name: NAME, tool: TOOL = None) -> None:
    """Print a robot's joints, limits, masses, frames and DH rows, after full validation."""
    from kinlab.model.extract import as_table
    from kinlab.model.library import load
    from kinlab.model.robot import remarks

    robot = load(name, tool)
    console = screen()
    gravity = " ".join(f"{g:g}" for g in robot.model.gravity.linear)
    mass = sum(inertia.mass for inertia in list(robot.model.inertias)[1:])
    about = _(": {n} joints, tool frame {tool!r}").format(n=robot.n, tool=robot.tool_name)
    console.print(styled((robot.name, "bold"), about))
    console.print(_("source: {source}").format(source=robot.source), highlight=False)
    told = _("moving mass {mass} kg, gravity {gravity} m/s²")
    console.print(told.format(mass=f"{mass:.4g}", gravity=gravity), highlight=False)
    if robot.singular_mass:
        console.print(robot.singular_mass, style="yellow")
    for line in remarks(robot):
        console.print(line, style="yellow", highlight=False, soft_wrap=True)
    for line in _missing_meshes(robot):
        told = _("{line}; a plain shape is drawn instead").format(line=line)
        console.print(told, style="yellow", highlight=False)
    console.print(_joints(robot))
    if robot.model.damping.any() or robot.model.friction.any():
        console.print(_friction(robot))
    table = as_table(robot)
    console.print(_rows(table, extracted=robot.table is None))
    if robot.table is None:
        console.dim(table.source)
    frames = [str(frame.name) for frame in robot.model.frames][1:]
    told = _("frames: {names}").format(names=", ".join(dict.fromkeys(frames)))
    console.print(told, highlight=False, soft_wrap=False)


def urdf(name: NAME, output: OUTPUT = None, tool: TOOL = None) -> None:
    """Print the URDF of a robot, or write it to a file."""
    from kinlab.model.library import load

    _give(load(name, tool).urdf, output)


def dh(name: NAME, tool: TOOL = None, output: OUTPUT = None) -> None:
    """Print the modified DH table of a robot, or write it as TOML with -o."""
    from kinlab.model.extract import to_dh
    from kinlab.model.library import load

    table = to_dh(load(name, tool))
    if output is not None:
        _give(table.to_toml(), output)
        return
    console = screen()
    console.print(_rows(table, extracted=False))
    for which in (N_("base"), N_("tool")):
        rows = "; ".join(" ".join(f"{x:.6g}" for x in row) for row in getattr(table, which)[:3])
        console.print(f"{_(which)}: {rows}", highlight=False)
    told = _("{source}; write it whole, inertias included, with -o").format(source=table.source)
    console.print(told, highlight=False)


def _give(text: str, output: Path | None) -> None:
    from kinlab.host.files import write_text

    if output is None:
        echo(text, nl=False)
    else:
        write_text(output, text)
        wrote(output)


def _missing_meshes(robot: Robot) -> list[str]:
    from kinlab.model import library, urdf_read

    folders = library.mesh_folders(robot)
    root = urdf_read.parse(robot.urdf, robot.name)
    return list(dict.fromkeys(urdf_read.missing_meshes(root, folders)))


def _joints(robot: Robot) -> Table:
    table = fine_table(*map(_, _JOINT_COLUMNS), left=(0, 1), title=_("joints"))
    model = robot.model
    for j, name in enumerate(robot.joint_names, 1):
        k = model.joints[j].idx_v
        kind = robot.joint_kinds[j - 1]
        unit, factor = ("°", 180 / math.pi) if kind == "revolute" else (" m", 1.0)
        table.add_row(
            name,
            _(kind),
            f"{robot.lower[k] * factor:.5g}{unit}",
            f"{robot.upper[k] * factor:.5g}{unit}",
            f"{model.upperVelocityLimit[k]:.4g}",
            f"{model.upperEffortLimit[k]:.4g}",
            f"{model.inertias[j].mass:.4g}",
            f"{model.armature[k]:.4g}",
        )
    return table


def _friction(robot: Robot) -> Table:
    heads = _("joint"), _("viscous [N m s or N s/m]"), _("Coulomb [N m or N]")
    table = fine_table(*heads, left=(0,), title=_("joint friction"))
    model = robot.model
    for name, *losses in zip(robot.joint_names, model.damping, model.friction, strict=True):
        table.add_row(name, *(f"{loss:.4g}" for loss in losses))
    return table


def _rows(dh_table: DHTable, *, extracted: bool) -> Table:
    from kinlab.model.dh import row_words

    columns, rows = row_words(dh_table)
    told = _("DH table, {convention} convention")
    if extracted:
        told = _("DH table, {convention} convention, extracted")
    title = told.format(convention=_(str(dh_table.convention)))
    table = fine_table(*columns, left=(), title=title)
    for row in rows:
        table.add_row(*row)
    return table


COMMANDS = {"list": list_robots, "info": info, "urdf": urdf, "dh": dh}
