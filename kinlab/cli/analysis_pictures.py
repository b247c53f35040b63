"""Pictures of the commands about dexterity."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from kinlab.analysis.isotropy.configurations import IsotropySearch
    from kinlab.inverse.postures.solution_map import SolutionMap
    from kinlab.model.robot import Robot
    from kinlab.sweeps.workspace import WorkspaceMap


def singular(robot: Robot, task: Any, joints: str | None, seed: int, path: Path) -> None:
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


def isotropy(robot: Robot, search: IsotropySearch, path: Path) -> None:
    """The best conditioned pose with its ellipses, or where a spatial arm is well conditioned."""
    from kinlab.analysis.structure.task_space import TaskSpace
    from kinlab.plots.arms import ellipses
    from kinlab.plots.canvas import save
    from kinlab.plots.maps import workspace_map
    from kinlab.sweeps.workspace import sample_workspace, stays_in_plane

    if stays_in_plane(TaskSpace(robot, (0, 1), "xy")):
        save(ellipses(robot, search.best_q), path)
        return
    chart = sample_workspace(
        robot, _mask(search.rows), samples=20_000, length=search.best_length or 1.0
    )
    save(workspace_map(chart), path)


def workspace(robot: Robot, chart: WorkspaceMap, plane: str, cloud: bool, path: Path) -> None:
    """A map, with boundary and singular loci for planar arms, the curves of the section for
    spatial ones; or a cloud."""
    from kinlab.plots import maps
    from kinlab.plots.canvas import save

    if cloud:
        save(maps.workspace_cloud(chart), path)
        return
    save(maps.workspace(robot, chart, plane=plane), path)


def solutions(chart: SolutionMap, path: Path) -> None:
    """The number of solutions over a section."""
    from kinlab.plots import counts
    from kinlab.plots.canvas import save

    save(counts.solutions(chart), path)


def _mask(rows: tuple[int, ...]) -> tuple[bool, ...]:
    return tuple(i in rows for i in range(6))
