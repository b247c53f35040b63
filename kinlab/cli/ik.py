"""Command ``ik``: one pose from the command line."""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from typing import Annotated

import typer

from kinlab.cli.robots import NAME, TOOL
from kinlab.cli.screen import echo, wrote
from kinlab.host.language import _


def ik(
    name: NAME,
    xyz: Annotated[
        tuple[float, float, float], typer.Option(help="Position of the tool in the base, metres.")
    ],
    rpy: Annotated[
        tuple[str, str, str],
        typer.Option(help="Roll, pitch, yaw of the tool; radians, or 'pi/2', or '90 deg'."),
    ] = ("0", "0", "0"),
    method: Annotated[str, typer.Option(help="lm, newton or gradient.")] = "lm",
    task: Annotated[
        str,
        typer.Option(
            help="pose, position, orientation, xy, xytheta, or auto: what the arm can do."
        ),
    ] = "auto",
    q0: Annotated[
        str | None, typer.Option(help="Where to start: angles with commas, as '0, pi/2, 0'.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the starts.")] = 0,
    tol_position: Annotated[float, typer.Option(help="Metres.")] = 1e-6,
    tol_rotation: Annotated[float, typer.Option(help="Radians.")] = 1e-6,
    branches: Annotated[bool, typer.Option("--branches", help="List all solutions.")] = False,
    history: Annotated[
        Path | None, typer.Option(help="Draw the error over the iterations into this file.")
    ] = None,
    tool: TOOL = None,
) -> None:
    """Find joint positions that bring the tool to a pose.

    Exit code 1 where the pose is not met within the limits; the closest pose found, or one that
    is met only outside the limits, is printed all the same.
    """
    import numpy as np

    from kinlab.formulas.numbers import parse_angle
    from kinlab.model.library import load
    from kinlab.model.rotations import rpy_matrix

    _announce_compilation()
    robot = load(name, tool)
    pose = np.eye(4)
    pose[:3, :3] = rpy_matrix(*(parse_angle(text) for text in rpy))
    pose[:3, 3] = xyz
    if branches:
        _print_branches(robot, pose)
        return
    from kinlab.engine.fast.arrays import chain
    from kinlab.inverse.search import ik as solve

    start = None if q0 is None else [parse_angle(text) for text in q0.split(",")]
    answer = solve(
        robot,
        pose,
        start,
        method,
        tol_position,
        tol_rotation,
        seed,
        task=task,
        history=history is not None,
    )
    slides = np.resize(chain(robot).prismatic, robot.n)
    width = max(len(joint) for joint in robot.joint_names)
    for joint, value, slide in zip(robot.joint_names, answer.q, slides, strict=True):
        shown = f"{1e3 * value:+.4f} mm" if slide else f"{np.degrees(value):+.4f} deg"
        echo(f"{joint:{width}}  {value:+.9f}  ({shown})")
    told = _(
        "{status}: position error {position} mm, rotation error {rotation} deg, {iterations} "
        "iterations, {restarts} restarts, task {task}"
    )
    echo(
        told.format(
            status=answer.status,
            position=f"{1e3 * answer.position_error:.3g}",
            rotation=f"{np.degrees(answer.rotation_error):.3g}",
            iterations=answer.iterations,
            restarts=answer.restarts,
            task=answer.task,
        )
    )
    for remark in answer.remarks:
        echo(_("note: {note}").format(note=remark))
    if history is not None and answer.history is not None:
        from kinlab.plots.canvas import save
        from kinlab.plots.searches import ik_history

        save(ik_history({method: answer.history}, f"{robot.name}: {answer.status}"), history)
        wrote(history)
    broken = [
        _("{joint} ({low} to {high})").format(joint=joint, low=f"{low:g}", high=f"{high:g}")
        for joint, value, low, high in zip(
            robot.joint_names, answer.q, robot.lower, robot.upper, strict=True
        )
        if not low <= value <= high
    ]
    if broken:
        told = _("kinlab: outside the limits of {joints}").format(joints=_(", ").join(broken))
        echo(told, err=True)
    if not answer.success:
        raise typer.Exit(1)


def _print_branches(robot: object, pose: object) -> None:
    import numpy as np

    from kinlab.inverse.branches.solutions import ik_branches

    found = ik_branches(robot, pose)  # type: ignore[arg-type]
    for q, name, inside in zip(found.q, found.names, found.within_limits, strict=True):
        values = " ".join(f"{value:+.6f}" for value in q)
        echo(f"{values}  {name}" + ("" if inside else "  " + _("(outside the limits)")))
    worst = max(found.position_error, default=0.0), max(found.rotation_error, default=0.0)
    if found.complete:
        told = _(
            "{count} solutions by {method}, {inside} within the limits, all there are; worst "
            "error {position} mm, {rotation} deg"
        )
    else:
        told = _(
            "{count} solutions by {method}, {inside} within the limits, not all there are; worst "
            "error {position} mm, {rotation} deg"
        )
    echo(
        told.format(
            count=len(found),
            method=found.method,
            inside=int(np.sum(found.within_limits)),
            position=f"{1e3 * worst[0]:.2g}",
            rotation=f"{np.degrees(worst[1]):.2g}",
        )
    )
    if not len(found):
        raise typer.Exit(1)


def _announce_compilation() -> None:
    """Lets the message about compiling through to stderr: the first run takes some seconds."""
    handler = logging.StreamHandler(sys.stderr)
    handler.set_name("kinlab ik")
    handler.setFormatter(logging.Formatter("kinlab: %(message)s"))
    logger = logging.getLogger("kinlab.engine.fast.compiled")
    for before in [known for known in logger.handlers if known.get_name() == handler.get_name()]:
        logger.removeHandler(before)  # its stderr may be closed by now
    logger.addHandler(handler)
    logger.setLevel(logging.INFO)


COMMANDS = {"ik": ik}
