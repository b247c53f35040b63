"""The command fivebar design: the lengths of a five-bar for a rectangle, and Pareto fronts."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kinlab.cli.screen import fine_table, screen, styled, wrote
from kinlab.errors import OptionError
from kinlab.host.language import _

if TYPE_CHECKING:
    from kinlab.fivebar.design.front import DesignFront
    from kinlab.fivebar.design.synthesis import FiveBarDesign, Proved

_RANGE = "LEAST LARGEST"
RANGE = tuple[float, float] | None


def design(
    workspace: Annotated[
        tuple[float, float, float, float],
        typer.Option(help="The rectangle, m.", metavar="X0 X1 Y0 Y1"),
    ],
    goal: Annotated[
        list[str] | None,
        typer.Option(
            help="condition (where none is given), size, torque, clearance or transmission; with a "
            "weight as in size=0.5, and several for a mix."
        ),
    ] = None,
    pareto: Annotated[
        tuple[str, str] | None,
        typer.Option(help="The Pareto front of two goals instead.", metavar="GOAL GOAL"),
    ] = None,
    l1: Annotated[RANGE, typer.Option(help="Range of the cranks, m.", metavar=_RANGE)] = None,
    l2: Annotated[RANGE, typer.Option(help="Range of the rods, m.", metavar=_RANGE)] = None,
    e: Annotated[
        RANGE, typer.Option("--e", help="Range of half the base, m.", metavar=_RANGE)
    ] = None,
    height: Annotated[
        RANGE,
        typer.Option(help="The rectangle's lower edge is free in this range, m.", metavar=_RANGE),
    ] = None,
    limit: Annotated[
        list[str] | None,
        typer.Option(
            help="What a goal may not exceed (clearance, transmission: fall below), as in "
            "transmission=40 (degrees) or size=1.2; several times."
        ),
    ] = None,
    payload: Annotated[float | None, typer.Option(help="For the goal torque, kg.")] = None,
    mode: Annotated[str | None, typer.Option(help="Working mode, as in -+.")] = None,
    seed: Annotated[int, typer.Option(help="The same seed gives the same answer.")] = 0,
    count: Annotated[int, typer.Option(help="Designs on a Pareto front.")] = 9,
    resume: Annotated[
        Path | None, typer.Option(help="A file that keeps the search; a stopped one goes on.")
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Write the five-bar: a .toml file.")
    ] = None,
    picture: Annotated[
        Path | None, typer.Option(help="Write a picture: a .png, .svg or .pdf file.")
    ] = None,
) -> None:
    """Find l1, l2 and e for a rectangle: the worst pose in it is as good as it can be."""
    from rich.progress import Progress

    from kinlab.fivebar.arguments import read_signs
    from kinlab.fivebar.design.front import fivebar_front
    from kinlab.fivebar.design.synthesis import design_fivebar
    from kinlab.plots.canvas import save

    weights = _numbers(goal or ["condition"], "--goal", 1.0)
    signs = None if mode is None else read_signs(mode)
    limits = _numbers(limit or [], "--limit", None)
    if pareto is not None and (goal or output):
        raise OptionError("--pareto finds many designs: leave out --goal and --output")
    shared = {"l1": l1, "l2": l2, "e": e, "height": height, "limits": limits}
    more = {"payload": payload, "mode": signs, "seed": seed, "resume": resume}
    with Progress(console=screen(stderr=True), transient=True) as bar:
        row = bar.add_task("design", total=None)

        def tell(done: int, total: int, best: float = 0.0) -> None:
            del best
            bar.update(row, completed=done, total=total)

        if pareto is not None:
            front = fivebar_front(workspace, pareto, count, progress=tell, **shared, **more)  # type: ignore[arg-type]
        else:
            found = design_fivebar(workspace, weights, progress=tell, **shared, **more)  # type: ignore[arg-type]
    if pareto is not None:
        _print_front(front)
    else:
        _print_design(found)
    if output is not None:
        found.fivebar.save(output)
        wrote(output)
    if picture is not None:
        from kinlab import plots

        save(
            plots.fivebar_front(front) if pareto is not None else plots.fivebar_design(found),
            picture,
        )
        wrote(picture)


def _numbers(texts: list[str], option: str, default: float | None) -> dict[str, float]:
    """Reads ``name=number``; ``name`` alone has the default.

    Raises:
        OptionError: no such text.
    """
    out: dict[str, float] = {}
    for text in texts:
        name, sign, value = text.partition("=")
        try:
            number = float(value) if sign else default
        except ValueError:
            number = None
        if number is None:
            raise OptionError(f"{option} {text!r}: write it as name=number, such as size=1.2")
        if name in out:
            raise OptionError(f"{option} {name!r} is given twice")
        out[name] = number
    return out


def _print_design(found: FiveBarDesign) -> None:

    console = screen(highlight=False, soft_wrap=True)
    l1, l2, e = found.lengths
    box = found.workspace
    console.print(styled((f"l1 {l1:.6g} m, l2 {l2:.6g} m, e {e:.6g} m", "bold")))
    signs = "".join("+" if s > 0 else "-" for s in found.mode)
    told = _("over x {x0} to {x1}, y {y0} to {y1} m in mode {mode}")
    sides = {"x0": box.x_min, "x1": box.x_max, "y0": box.y_min, "y1": box.y_max}
    console.print(told.format(**{side: f"{at:.6g}" for side, at in sides.items()}, mode=signs))
    from kinlab.fivebar.design.goals import GOALS

    table = fine_table(
        _("worst over the whole rectangle"), _("reached"), _("proved"), _("asked"), left=(0,)
    )
    for name, goal in found.goals.items():
        if name == "torque" and not found.fivebar.payload:
            continue
        asked = _("best") if name in found.weights else ""
        if name in found.limits:
            sign = "≤" if GOALS[name].most else "≥"
            asked = f"{asked} {sign} {found.limits[name]:g}".strip()
        unit = f", {goal.unit}" if goal.unit else ""
        table.add_row(GOALS[name].words + unit, f"{goal.value:.6g}", _bound(goal), asked)
    console.print(table)
    for line in found.remarks:
        console.print(styled((line, "bold")))
    if found.at_limit:
        told = _("at the limit of {names}: beyond it there is more")
        console.print(told.format(names=_(", ").join(found.at_limit)))


def _bound(goal: Proved) -> str:
    return f"{goal.bound:.6g}" if math.isfinite(goal.bound) else _("nothing")


def _print_front(front: DesignFront) -> None:
    from kinlab.fivebar.design.goals import GOALS

    heads = [f"{goal}, {GOALS[goal].unit}".rstrip(", ") for goal in front.goals]
    table = fine_table("l1, m", "l2, m", "e, m", *heads, left=())
    for one in front.designs:
        goals = (f"{one.goals[goal].value:.5g}" for goal in front.goals)
        table.add_row(*(f"{length + 0.0:.5f}" for length in one.lengths), *goals)
    console = screen(highlight=False, soft_wrap=True)
    console.print(table)
    first, second = front.goals
    told = _("{count} designs from the best {first} to the best {second}")
    console.print(told.format(count=len(front.designs), first=first, second=second))
