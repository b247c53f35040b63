"""Commands about dexterity: singular, isotropy, workspace."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from kinlab.cli import analysis_tables as tables
from kinlab.cli.robots import NAME, TOOL
from kinlab.cli.screen import screen, wrote
from kinlab.host.language import _

if TYPE_CHECKING:
    from kinlab.analysis.isotropy.configurations import IsotropySearch
    from kinlab.model.robot import Robot

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


def singular(
    name: NAME,
    tool: TOOL = None,
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
    from kinlab.analysis.singularities.families import find_singularities
    from kinlab.analysis.singularities.nearest import nearest_singularity
    from kinlab.model.library import load

    robot, console = load(name, tool), screen()
    chosen = _task(task)
    state = None if at is None else _numbers(at, robot.n, "--at")
    search = find_singularities(robot, chosen, seed=seed)
    console.print(tables.headline(robot, search.task, search.suggested), highlight=False)
    tables.print_determinant(console, robot, chosen)
    console.print(tables.families(search))
    effort = search.effort
    told = _(
        "{starts} starts, {converged} reached the singular set within the limits; the last new "
        "family came with start {last} (seed {seed})"
    ).format(
        starts=effort.seeds, converged=effort.converged, last=effort.last_new, seed=effort.seed
    )
    console.dim(f"{told}\n{search.evidence}")
    if state is not None:
        near = nearest_singularity(robot, state, chosen, seed=seed)
        console.print(tables.nearest(near), highlight=False)
        console.dim(near.evidence)
    if output is not None:
        _draw_curves(robot, chosen, slice_, seed, output)
        wrote(output)


def isotropy(
    name: NAME,
    tool: TOOL = None,
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
    from kinlab.analysis.isotropy.configurations import find_isotropic
    from kinlab.model.library import load

    robot, console = load(name, tool), screen()
    chosen, size = _task(task), _length(length)
    if free is not None:
        robot = tables.print_designs(console, robot, free, chosen, size, seeds, seed) or robot
    search = find_isotropic(robot, chosen, size, seeds=seeds, seed=seed)
    console.print(tables.headline(robot, search.task, search.suggested), highlight=False)
    tables.print_isotropy(console, robot, search)
    if output is not None:
        _draw_isotropy(robot, search, output)
        wrote(output)


def workspace(
    name: NAME,
    tool: TOOL = None,
    task: TASK = "auto",
    metric: Annotated[
        str,
        typer.Option(
            "--metric",
            "--measure",
            help="inverse_condition, yoshikawa, min_singular, asada, isotropy, or solutions: how "
            "many joint positions reach each point of a section (3R and planar arms).",
        ),
    ] = "inverse_condition",
    length: Annotated[float, typer.Option("--length", help="Characteristic length, m.")] = 1.0,
    samples: Annotated[int, typer.Option("--samples", "-n")] = 50_000,
    sampling: Annotated[str, typer.Option(help="random or grid.")] = "random",
    plane: Annotated[str, typer.Option(help="xy, xz, yz or rz of the picture.")] = "",
    cloud: Annotated[bool, typer.Option("--cloud", help="Draw a cloud in space.")] = False,
    save: Annotated[
        Path | None, typer.Option("--save", help="Write the samples to this .npz file.")
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes.", min=1)] = 1,
    folder: Annotated[
        Path | None, typer.Option(help="Keep finished chunks there; the same command goes on.")
    ] = None,
    seed: SEED = 0,
    output: PICTURE = None,
) -> None:
    """Sample the workspace with a measure of dexterity; Ctrl-C keeps what was computed."""
    from kinlab.model.library import load
    from kinlab.sweeps.workspace import sample_workspace

    robot, console = load(name, tool), screen()
    if metric == "solutions":
        _solutions(robot, output)
        return
    chart = sample_workspace(
        robot,
        _task(task),
        metric,
        samples=samples,
        sampling=sampling,
        length=length,
        seed=seed,
        workers=workers,
        folder=folder,
    )
    console.print(tables.headline(robot, chart.task, task == "auto"), highlight=False)
    if not chart.complete:
        told = _("stopped after {count} samples").format(count=len(chart.values))
        console.print(told, style="yellow")
    if not len(chart.values):
        return
    console.print(tables.workspace_table(chart))
    console.dim(chart.evidence)
    if save is not None:
        chart.save(save)
        wrote(save)
    if output is not None:
        from kinlab.plots import maps
        from kinlab.plots.canvas import save as save_picture

        drawn = maps.workspace_cloud(chart) if cloud else maps.workspace(robot, chart, plane=plane)
        save_picture(drawn, output)
        wrote(output)


def _solutions(robot: Robot, output: Path | None) -> None:
    """How many solutions the points of a section have, as a table and a picture."""
    import numpy as np

    from kinlab.inverse.postures.solution_map import solution_map

    console = screen()
    chart = solution_map(robot)
    console.print(f"{chart.robot}: {chart.text}", highlight=False)
    for number in np.unique(chart.within_limits):
        share = 100.0 * float(np.mean(chart.within_limits == number))
        told = _("{count} solutions within the limits: {share} % of the cells")
        console.print(told.format(count=int(number), share=f"{share:.1f}"), highlight=False)
    cusp, node = _("cusp at {x} {one} m, {y} {two} m"), _("node at {x} {one} m, {y} {two} m")
    for told, points in ((cusp, chart.cusps), (node, chart.nodes)):
        for one, two in points:
            x, y = chart.labels
            shown = told.format(x=x, one=f"{one:.6g}", y=y, two=f"{two:.6g}")
            console.print(shown, highlight=False)
    console.dim(chart.evidence)
    if output is not None:
        from kinlab.plots import counts
        from kinlab.plots.canvas import save

        save(counts.solutions(chart), output)
        wrote(output)


def _draw_curves(robot: Robot, task: Any, joints: str | None, seed: int, path: Path) -> None:
    """Singular curves in a slice of joint space."""
    from kinlab.errors import OptionError
    from kinlab.plots.canvas import save
    from kinlab.plots.curves import singular_loci

    chosen = None
    if joints is not None:
        try:
            chosen = [int(part) - 1 for part in joints.split(",")]
        except ValueError:
            raise OptionError(f"--slice {joints!r}; give joint numbers, as 2,3") from None
    save(singular_loci(robot, joints=chosen, task=task, seed=seed), path)


def _draw_isotropy(robot: Robot, search: IsotropySearch, path: Path) -> None:
    """The best conditioned pose with its ellipses, or where a spatial arm is well conditioned."""
    from kinlab.analysis.structure.task_space import TaskSpace, mask_of
    from kinlab.plots.arms import ellipses
    from kinlab.plots.canvas import save
    from kinlab.plots.maps import workspace_map
    from kinlab.sweeps.workspace import sample_workspace, stays_in_plane

    if stays_in_plane(TaskSpace(robot, (0, 1), "xy")):
        save(ellipses(robot, search.best_q), path)
        return
    task, length = mask_of(search.rows), search.best_length or 1.0
    save(workspace_map(sample_workspace(robot, task, samples=20_000, length=length)), path)


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
    from kinlab.formulas.numbers import parse_number

    values = [parse_number(part) for part in text.split(",")]
    if len(values) != count:
        raise OptionError(f"{option} has {len(values)} numbers; the robot has {count} joints")
    return values


COMMANDS = {"singular": singular, "isotropy": isotropy, "workspace": workspace}
