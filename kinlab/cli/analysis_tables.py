"""What the commands about dexterity print."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from kinlab.cli.screen import plain_table, styled
from kinlab.host.language import _

if TYPE_CHECKING:
    from kinlab.analysis.isotropy.configurations import IsotropySearch
    from kinlab.analysis.singularities.families import SingularitySearch
    from kinlab.analysis.singularities.nearest import NearestSingularity
    from kinlab.model.robot import Robot
    from kinlab.sweeps.workspace import WorkspaceMap


def headline(robot: Robot, task: str, suggested: bool) -> Any:
    told = _(": {n} joints, task {task}")
    if suggested:
        told = _(": {n} joints, task {task} (chosen to suit the arm)")
    return styled((robot.name, "bold"), told.format(n=robot.n, task=task))


def print_determinant(console: Any, robot: Robot, task: Any) -> None:
    from kinlab.analysis.singularities.determinant import factored_determinant
    from kinlab.analysis.structure.task_space import read_task

    if read_task(robot, task).m != robot.n or robot.table is None:
        return  # no determinant, or one made of 17-digit numbers
    found = factored_determinant(robot, task)
    console.print(f"det J = {found.expression}", highlight=False)
    for factor in found.factors:
        where = "" if factor.within_limits else _(", zero outside the joint limits only")
        console.print(f"  {factor.expression} = 0: {factor.meaning}{where}", highlight=False)


def families(search: SingularitySearch) -> Any:
    heads = _("class"), _("condition"), _("rank"), _("lost direction (at one q)")
    table = plain_table(*heads, _("joints that cancel"))
    for family in search.families:
        if family.pinned:
            pairs = zip(family.deciding, family.pinned, strict=True)
            condition = ", ".join(f"{joint} = {round(value, 6) + 0.0:g}" for joint, value in pairs)
        else:
            told = _("a curve or surface in {joints}")
            condition = told.format(joints=", ".join(family.deciding))
        edges = {False: _(" (edge of the workspace)"), None: _(" (edge undecided)"), True: ""}
        edge = edges[family.beyond]
        first = family.representative
        table.add_row(
            family.kind + edge,
            condition,
            str(first.rank),
            first.lost_direction,
            ", ".join(first.joints),
        )
    return table


def nearest(near: NearestSingularity) -> str:
    if near.singularity is None:
        return _("no singular configuration within the limits was found")
    q = ", ".join(f"{round(float(v), 6) + 0.0:g}" for v in near.singularity.q)
    told = _(
        "nearest singularity: {kind} at distance {distance} rad (or m), q = {q}; sigma_min here "
        "{sigma} (length {length} m)"
    )
    return told.format(
        kind=near.singularity.kind,
        distance=f"{near.distance:.6g}",
        q=q,
        sigma=f"{near.sigma[-1]:.4g}",
        length=f"{near.length:.4g}",
    )


def print_designs(
    console: Any, robot: Robot, free: str, task: Any, length: float | str, seeds: int, seed: int
) -> Robot | None:
    from kinlab.analysis.isotropy.design import design_isotropic
    from kinlab.model.robot import Robot

    names = [part.strip() for part in free.split(",")]
    found = design_isotropic(robot, names, task, length, seeds=seeds, seed=seed)
    if not len(found):
        told = _("no isotropic design: best condition number {best} from {starts} starts")
        best = f"{found.best_condition:.6g}"
        console.print(told.format(best=best, starts=found.seeds), highlight=False)
        return None
    heads = [*names, _("condition - 1"), _("family")]
    table = plain_table(*heads, right=tuple(range(len(heads))))
    for design in found:
        numbers = [f"{value:.9g}" for value in design.values.values()]
        table.add_row(
            *numbers,
            f"{design.condition - 1.0:.1e}",
            _("{count} free").format(count=design.freedom),
        )
    told = _("isotropic designs ({scale}), the least changed first:").format(scale=found.scale)
    console.print(told, highlight=False)
    console.print(table)
    return Robot.from_dh(found[0].table)


def print_isotropy(console: Any, robot: Robot, search: IsotropySearch) -> None:
    sizes = {"given": _("given"), "optimal": _("solved for"), "none needed": _("none needed")}
    size = sizes[search.length]
    if not search.found:
        assert search.spread is not None
        low, middle, high = search.spread
        told = _("no isotropic configuration; best condition number {best}")
        if search.best_length is not None:
            told = _(
                "no isotropic configuration; best condition number {best} at length {length} m"
            )
        best, length = f"{search.best_condition:.6g}", f"{search.best_length or 0.0:.6g}"
        console.print(told.format(best=best, length=length), highlight=False)
        told = _("q = {q} (deg or m)").format(q=_degrees(robot, search.best_q))
        console.print(told, highlight=False)
        shares = {"low": f"{low:.6g}", "middle": f"{middle:.6g}", "high": f"{high:.6g}"}
        told = _("local minima: 5 % {low}, 50 % {middle}, 95 % {high}").format(**shares)
        console.dim(f"{told}\n{search.evidence}")
        return
    heads = _("q (deg or m)"), _("condition - 1"), _("length (m)"), _("free joints")
    table = plain_table(*heads)
    for found in search:
        length = "-" if found.length is None else f"{found.length:.6g}"
        table.add_row(
            _degrees(robot, found.q),
            f"{found.condition - 1.0:.1e}",
            length,
            ", ".join(found.free) or "-",
        )
    console.print(table)
    told = _("characteristic length: {size}; {converged} of {starts} starts (seed {seed})")
    numbers = {"converged": search.converged, "starts": search.seeds, "seed": search.seed}
    console.dim(told.format(size=size, **numbers))


def _degrees(robot: Robot, q: Any) -> str:
    """Revolute joints in degrees, prismatic ones in metres."""
    import numpy as np

    from kinlab.analysis.structure.task_space import revolute

    shown = np.where(revolute(robot), np.degrees(q), q)
    return ", ".join(f"{round(v, 4) + 0.0:g}" for v in shown.tolist())


def workspace_table(chart: WorkspaceMap) -> Any:
    import numpy as np

    table = plain_table("", _("from"), _("to"), right=(1, 2))
    for name, column in zip("xyz", chart.points.T, strict=True):
        table.add_row(f"{name} (m)", f"{column.min():.4f}", f"{column.max():.4f}")
    radius = np.linalg.norm(chart.points[:, :2], axis=1)
    table.add_row(_("distance from z (m)"), f"{radius.min():.4f}", f"{radius.max():.4f}")
    table.add_row(chart.metric, f"{chart.values.min():.4g}", f"{chart.values.max():.4g}")
    table.add_row(_("median"), "", f"{np.median(chart.values):.4g}")
    return table
