"""Pictures of the commands about dexterity."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kinlab.analysis.isotropy import IsotropySearch
    from kinlab.model.robot import Robot
    from kinlab.postures.solution_map import SolutionMap
    from kinlab.sweeps.workspace import WorkspaceMap


def singular(robot: Robot, task: Any, joints: str | None, seed: int, path: Path) -> None:
    """Singular curves in a slice of joint space."""
    from kinlab.analysis.loci import singular_loci
    from kinlab.errors import OptionError
    from kinlab.plots.canvas import save
    from kinlab.plots.curves import plot_loci
    from kinlab.structure.task_space import read_task

    needed = abs(read_task(robot, task).m - robot.n) + 2
    if joints is not None:
        try:
            chosen = [int(part) - 1 for part in joints.split(",")]
        except ValueError:
            raise OptionError(f"--slice {joints!r}; give joint numbers, as 2,3") from None
    else:
        first = 1 if robot.n > needed else 0  # the first joint seldom decides anything
        chosen = list(range(first, first + needed))
    save(plot_loci(robot, singular_loci(robot, chosen, task=task, seed=seed)), path)


def isotropy(robot: Robot, search: IsotropySearch, path: Path) -> None:
    """The best conditioned pose with its ellipses, or where a spatial arm is well conditioned."""
    from kinlab.plots.arms import plot_ellipse
    from kinlab.plots.canvas import save
    from kinlab.plots.maps import plot_map
    from kinlab.structure.task_space import TaskSpace
    from kinlab.sweeps.workspace import sample_workspace, stays_in_plane

    if stays_in_plane(TaskSpace(robot, (0, 1), "xy")):
        save(plot_ellipse(robot, search.best_q), path)
        return
    chart = sample_workspace(
        robot, _mask(search.rows), samples=20_000, length=search.best_length or 1.0
    )
    save(plot_map(chart), path)


def workspace(robot: Robot, chart: WorkspaceMap, plane: str, cloud: bool, path: Path) -> None:
    """A map, with boundary and singular loci for planar arms, the curves of the section for
    spatial ones; or a cloud."""
    from kinlab.plots.canvas import save
    from kinlab.plots.maps import plot_cloud, plot_map

    if cloud:
        save(plot_cloud(chart), path)
        return
    boundary, curves, section = None, [], None
    if not chart.planar and plane in ("", "rz"):
        section = _section(robot)
    if chart.planar and robot.n <= 3:
        from kinlab.analysis.boundary import planar_boundary
        from kinlab.analysis.loci import singular_loci
        from kinlab.fast.stacks import fk

        boundary = planar_boundary(robot)
        needed = abs(len(chart.rows) - robot.n) + 2
        if needed == robot.n:  # in a smaller slice the others would be held: not the whole set
            loci = singular_loci(robot, list(range(needed)), task=_mask(chart.rows))
            curves = [fk(robot, curve.q)[:, :3, 3] for curve in loci.curves]
    save(plot_map(chart, boundary=boundary, curves=curves, section=section, plane=plane), path)


def solutions(chart: SolutionMap, path: Path) -> None:
    """The number of solutions over a section."""
    from kinlab.plots.canvas import save
    from kinlab.plots.solutions import plot_solutions

    save(plot_solutions(chart), path)


def _section(robot: Robot) -> Any:
    """The section through the first axis where that is the base's z and every edge is known (a
    tool off the wrist's last axes makes that a matter of minutes); else nothing."""
    import numpy as np

    from kinlab.analysis.sections import takes_limits, workspace_section

    if not takes_limits(robot):
        return None
    section = workspace_section(robot)
    upright = abs(float(section.axis[2])) > 1.0 - 1e-9
    centred = float(np.linalg.norm(section.origin[:2])) < 1e-9
    if not (upright and centred):
        return None
    return section


def _mask(rows: tuple[int, ...]) -> tuple[bool, ...]:
    return tuple(i in rows for i in range(6))
