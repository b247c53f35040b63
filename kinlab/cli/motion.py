"""Command motion: from one joint position to the next, checked, timed, and written as CSV."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.cli.robots import TOOL
from kinlab.cli.screen import echo, wrote
from kinlab.host.language import _

if TYPE_CHECKING:
    from kinlab.motion import Motion


def motion(
    name: Annotated[str, typer.Argument(help="A robot by name, or a .toml/.csv/.urdf file.")],
    points: Annotated[
        list[str],
        typer.Argument(help='Joint positions in order, rad and m, "0, pi/4, -0.5" each.'),
    ],
    tool: TOOL = None,
    law: Annotated[
        str, typer.Option(help="quintic, trapezoid, spline, jerk (ruckig), optimal (toppra).")
    ] = "quintic",
    line: Annotated[
        bool, typer.Option("--line", help="Straight lines of the tool between the points.")
    ] = False,
    velocity: Annotated[float | None, typer.Option(help="Of joints, or of the tool.")] = None,
    acceleration: Annotated[float | None, typer.Option(help="Of joints, or of the tool.")] = None,
    jerk: Annotated[float | None, typer.Option(help="Of joints, rad/s³.")] = None,
    duration: Annotated[float | None, typer.Option(help="Of the whole motion, s.")] = None,
    step: Annotated[float, typer.Option(help="Between samples, s.")] = 0.01,
    output: Annotated[Path | None, typer.Option("-o", "--output", help="CSV file.")] = None,
    servos: Annotated[
        bool, typer.Option("--servos", help="Size a drive for each joint, of the shipped motors.")
    ] = False,
) -> None:
    """Plan a motion of an arm, say what it meets on its way, and write it as CSV.

    Points that begin with a minus sign stand behind --.
    """
    import numpy as np

    from kinlab.errors import OptionError
    from kinlab.formulas.numbers import parse_number
    from kinlab.model.library import load
    from kinlab.motion import cartesian, check, joint

    robot = load(name, tool)
    rows = [[parse_number(word.strip()) for word in point.split(",")] for point in points]
    if len({len(row) for row in rows}) > 1:
        raise OptionError("motion: the points have different numbers of joints")
    if line:
        from kinlab.engine.fast.stacks import fk

        if jerk is not None:
            raise OptionError("motion --line: lines have no jerk limit; leave --jerk out")
        planned: Motion = cartesian(
            robot,
            list(fk(robot, np.array(rows))),
            q0=rows[0],
            law=law,
            velocity=velocity,
            acceleration=acceleration,
            duration=duration,
            step=step,
        )
    else:
        planned = joint(
            robot,
            np.array(rows),
            law,
            velocity=velocity,
            acceleration=acceleration,
            jerk=jerk,
            duration=duration,
            step=step,
        )
    told = _("{robot}, {law}: {duration} s, {count} samples")
    duration_told = f"{planned.duration:.6g}"
    echo(told.format(robot=robot.name, law=planned.law, duration=duration_told, count=len(planned)))
    speed, gain = planned.peak_velocity, planned.peak_acceleration
    for i, one in enumerate(robot.joint_names):
        told = _("{joint}: speed up to {speed}, acceleration up to {acceleration}")
        most = {"speed": f"{speed.value[i]:.4g}", "acceleration": f"{gain.value[i]:.4g}"}
        echo("  " + told.format(joint=one, **most))
    echo(str(check(robot, planned)))
    if servos:
        from kinlab.drives.arm import size_servos

        echo(str(size_servos(robot, planned)))
    if output is not None:
        planned.write(output)
        wrote(output)


COMMANDS = {"motion": motion}
