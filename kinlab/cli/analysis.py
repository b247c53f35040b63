"""Commands about dexterity: singular, isotropy, workspace."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kinlab.cli import analysis_pictures as pictures
from kinlab.cli.robots import NAME, TIP

if TYPE_CHECKING:
    from kinlab.analysis.isotropy import IsotropySearch
    from kinlab.analysis.singularity import SingularitySearch
    from kinlab.robot import Robot

TASK = Annotated[
    str,
    typer.Option(
        "--task",
        help="pose, position, orientation, xy, xytheta, a mask such as 110001, or auto.",
    ),
]
PICTURE = Annotated[
    Path | None, typer.Option("--output", "-o", help="Write a picture (.png, .svg, .pdf).")
]
SEED = Annotated[int, typer.Option("--seed", help="Seed of the search.")]


def register(app: typer.Typer) -> None:
    """Adds the commands of this file."""
    app.command("singular")(singular)
    app.command("isotropy")(isotropy)
    app.command("workspace")(workspace)


def singular(
    name: NAME,
    tip: TIP = None,
    task: TASK = "auto",
    at: Annotated[
        str | None,
        typer.Option("--at", help="Nearest singularity to this q: numbers with commas, rad or m."),
    ] = None,
    slice_: Annotated[
        str | None, typer.Option("--slice", help="Joints of the picture: 2,3 or 2,3,5.")
    ] = None,
    seed: SEED = 0,
    output: PICTURE = None,
) -> None:
    """Singular configurations by family, det J in factors, and a picture of the singular curves."""
    from rich.console import Console

    from kinlab.analysis.nearest import nearest_singularity
    from kinlab.analysis.singularity import find_singularities
    from kinlab.library import load

    robot, console = load(name, tip), Console()
    chosen = _task(task)
    search = find_singularities(robot, chosen, seed=seed)
    console.print(_headline(robot, search.task, search.suggested), highlight=False)
    _print_determinant(console, robot, chosen)
    console.print(_families(search))
    effort = search.effort
    console.print(
        f"[dim]{effort.seeds} starts, {effort.converged} reached the singular set within the "
        f"limits; the last new family came with start {effort.last_new} (seed {effort.seed})[/dim]",
        highlight=False,
    )
    if at is not None:
        near = nearest_singularity(robot, _numbers(at, robot.n, "--at"), chosen, seed=seed)
        console.print(_nearest_text(near), highlight=False)
    if output is not None:
        pictures.singular(robot, chosen, slice_, seed, output)
        console.print(f"wrote {output}", highlight=False)


def isotropy(
    name: NAME,
    tip: TIP = None,
    task: TASK = "auto",
    length: Annotated[
        str, typer.Option("--length", help="Characteristic length in metres, or optimal.")
    ] = "optimal",
    free: Annotated[
        str | None,
        typer.Option("--free", help="Numbers of the table to design: a1,a2,tool.x,alpha3."),
    ] = None,
    seeds: Annotated[int, typer.Option("--seeds", help="Starts of the search.")] = 400,
    seed: SEED = 0,
    output: PICTURE = None,
) -> None:
    """Isotropic configurations, or the best condition number; with --free, isotropic designs."""
    from rich.console import Console

    from kinlab.analysis.isotropy import find_isotropic
    from kinlab.library import load

    robot, console = load(name, tip), Console()
    chosen, size = _task(task), _length(length)
    if free is not None:
        robot = _print_designs(console, robot, free, chosen, size, seeds, seed) or robot
    search = find_isotropic(robot, chosen, size, seeds=seeds, seed=seed)
    console.print(_headline(robot, search.task, search.suggested), highlight=False)
    _print_isotropy(console, robot, search)
    if output is not None:
        pictures.isotropy(robot, search, output)
        console.print(f"wrote {output}", highlight=False)


def workspace(
    name: NAME,
    tip: TIP = None,
    task: TASK = "auto",
    metric: Annotated[
        str,
        typer.Option(help="inverse_condition, yoshikawa, min_singular, asada or isotropy."),
    ] = "inverse_condition",
    length: Annotated[float, typer.Option("--length", help="Characteristic length, m.")] = 1.0,
    samples: Annotated[int, typer.Option("--samples", "-n")] = 50_000,
    sampling: Annotated[str, typer.Option(help="random or grid.")] = "random",
    plane: Annotated[str, typer.Option(help="xy, xz, yz or rz of the picture.")] = "",
    cloud: Annotated[bool, typer.Option("--cloud", help="Draw a cloud in space.")] = False,
    save: Annotated[
        Path | None, typer.Option("--save", help="Write the samples to this .npz file.")
    ] = None,
    seed: SEED = 0,
    output: PICTURE = None,
) -> None:
    """Sample the workspace with a measure of dexterity; Ctrl-C keeps what was computed."""
    from rich.console import Console
    from rich.progress import Progress

    from kinlab.analysis.workspace import sample_workspace
    from kinlab.library import load

    robot, console = load(name, tip), Console()
    with Progress(console=Console(stderr=True), transient=True) as bar:
        row = bar.add_task("sampling", total=samples)
        chart = sample_workspace(
            robot, _task(task), metric, samples=samples, sampling=sampling, length=length,
            seed=seed, progress=lambda done, total: bar.update(row, completed=done, total=total),
        )  # fmt: skip
    console.print(_headline(robot, chart.task, task == "auto"), highlight=False)
    if not chart.complete:
        console.print(f"[yellow]stopped after {len(chart.values)} samples[/yellow]")
    if not len(chart.values):
        return
    console.print(_workspace_table(chart))
    if save is not None:
        chart.save(save)
        console.print(f"wrote {save}", highlight=False)
    if output is not None:
        pictures.workspace(robot, chart, plane, cloud, output)
        console.print(f"wrote {output}", highlight=False)


def _task(text: str) -> Any:
    """A task's name, or six digits 0 and 1 as a mask."""
    if len(text) == 6 and set(text) <= {"0", "1"}:
        return tuple(c == "1" for c in text)
    return text


def _length(text: str) -> float | str:
    from kinlab.errors import OptionError

    try:
        return text if text == "optimal" else float(text)
    except ValueError:
        raise OptionError(f"--length {text!r}; give metres or optimal") from None


def _numbers(text: str, count: int, option: str) -> list[float]:
    from kinlab.errors import OptionError
    from kinlab.expressions import parse_number

    values = [parse_number(part) for part in text.split(",")]
    if len(values) != count:
        raise OptionError(f"{option} has {len(values)} numbers; the robot has {count} joints")
    return values


def _headline(robot: Robot, task: str, suggested: bool) -> str:
    chosen = " (chosen to suit the arm)" if suggested else ""
    return f"[bold]{robot.name}[/bold]: {robot.n} joints, task {task}{chosen}"


def _print_determinant(console: Any, robot: Robot, task: Any) -> None:
    from kinlab.analysis.determinant import factored_determinant
    from kinlab.analysis.task_space import read_task

    if read_task(robot, task).m != robot.n or robot.table is None:
        return  # no determinant, or one made of 17-digit numbers
    found = factored_determinant(robot, task)
    console.print(f"det J = {found.expression}", highlight=False)
    for factor in found.factors:
        where = "" if factor.within_limits else ", zero outside the joint limits only"
        console.print(f"  {factor.expression} = 0: {factor.meaning}{where}", highlight=False)


def _families(search: SingularitySearch) -> Any:
    from rich.table import Table

    table = Table(box=None, header_style="bold", pad_edge=False)
    for title in ("class", "condition", "rank", "lost direction (at one q)", "joints that cancel"):
        table.add_column(title, overflow="fold")
    for family in search.families:
        if family.pinned:
            pairs = zip(family.deciding, family.pinned, strict=True)
            condition = ", ".join(f"{joint} = {round(value, 6) + 0.0:g}" for joint, value in pairs)
        else:
            condition = "a curve or surface in " + ", ".join(family.deciding)
        edge = " (edge of the workspace)" if family.beyond is False else ""
        first = family.representative
        table.add_row(
            family.kind + edge, condition, str(first.rank), first.lost_direction,
            ", ".join(first.joints),
        )  # fmt: skip
    return table


def _nearest_text(near: Any) -> str:
    if near.singularity is None:
        return "no singular configuration within the limits was found"
    q = ", ".join(f"{round(float(v), 6) + 0.0:g}" for v in near.singularity.q)
    return (
        f"nearest singularity: {near.singularity.kind} at distance {near.distance:.6g} rad (or m), "
        f"q = {q}; sigma_min here {near.sigma[-1]:.4g} (length {near.length:.4g} m)"
    )


def _print_designs(
    console: Any, robot: Robot, free: str, task: Any, length: float | str, seeds: int, seed: int
) -> Robot | None:
    from rich.table import Table

    from kinlab.analysis.design import design_isotropic
    from kinlab.extract import to_dh
    from kinlab.robot import Robot

    names = [part.strip() for part in free.split(",")]
    source = robot.table if robot.table is not None else to_dh(robot)
    found = design_isotropic(source, names, task, length, seeds=seeds, seed=seed)
    if not len(found):
        console.print(
            f"no isotropic design: best condition number {found.best_condition:.6g} "
            f"from {found.seeds} starts",
            highlight=False,
        )
        return None
    table = Table(box=None, header_style="bold", pad_edge=False)
    for title in [*names, "condition - 1", "family"]:
        table.add_column(title, justify="right")
    for design in found:
        numbers = [f"{value:.9g}" for value in design.values.values()]
        table.add_row(*numbers, f"{design.condition - 1.0:.1e}", f"{design.freedom} free")
    console.print(f"isotropic designs ({found.scale}), the least changed first:", highlight=False)
    console.print(table)
    return Robot.from_dh(found[0].table)


def _print_isotropy(console: Any, robot: Robot, search: IsotropySearch) -> None:
    from rich.table import Table

    size = {"given": "given", "optimal": "solved for", "none needed": "none needed"}[search.length]
    if not search.found:
        assert search.spread is not None
        low, middle, high = search.spread
        at = "" if search.best_length is None else f" at length {search.best_length:.6g} m"
        console.print(
            f"no isotropic configuration; best condition number {search.best_condition:.6g}{at}\n"
            f"q = {_degrees(robot, search.best_q)} (deg or m)\n"
            f"[dim]{search.seeds} starts; local minima: 5 % {low:.6g}, 50 % {middle:.6g}, "
            f"95 % {high:.6g} (seed {search.seed})[/dim]",
            highlight=False,
        )
        return
    table = Table(box=None, header_style="bold", pad_edge=False)
    for title in ("q (deg or m)", "condition - 1", "length (m)", "free joints"):
        table.add_column(title)
    for found in search:
        length = "-" if found.length is None else f"{found.length:.6g}"
        table.add_row(
            _degrees(robot, found.q),
            f"{found.condition - 1.0:.1e}",
            length,
            ", ".join(found.free) or "-",
        )
    console.print(table)
    console.print(
        f"[dim]characteristic length: {size}; {search.converged} of {search.seeds} starts "
        f"(seed {search.seed})[/dim]",
        highlight=False,
    )


def _degrees(robot: Robot, q: Any) -> str:
    """Revolute joints in degrees, prismatic ones in metres."""
    import numpy as np

    from kinlab.analysis.task_space import revolute

    shown = np.where(revolute(robot), np.degrees(q), q)
    return ", ".join(f"{round(v, 4) + 0.0:g}" for v in shown.tolist())


def _workspace_table(chart: Any) -> Any:
    import numpy as np
    from rich.table import Table

    table = Table(box=None, header_style="bold", pad_edge=False)
    for title in ("", "from", "to"):
        table.add_column(title, justify="right" if title else "left")
    for name, column in zip("xyz", chart.points.T, strict=True):
        table.add_row(f"{name} (m)", f"{column.min():.4f}", f"{column.max():.4f}")
    radius = np.linalg.norm(chart.points[:, :2], axis=1)
    table.add_row("distance from z (m)", f"{radius.min():.4f}", f"{radius.max():.4f}")
    table.add_row(chart.metric, f"{chart.values.min():.4g}", f"{chart.values.max():.4g}")
    table.add_row("median", "", f"{np.median(chart.values):.4g}")
    return table
