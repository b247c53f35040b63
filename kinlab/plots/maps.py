"""Workspace maps: filled for planar arms, a section or a cloud for spatial ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from kinlab.analysis.singularities.loci import singular_loci
from kinlab.analysis.structure.task_space import mask_of
from kinlab.analysis.workspace.boundary import PlanarBoundary, planar_boundary
from kinlab.analysis.workspace.sections import WorkspaceSection, takes_limits, workspace_section
from kinlab.arrays import Array
from kinlab.engine.fast.stacks import fk
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.plots.canvas import RED, new_axes, spread_labels
from kinlab.sweeps.workspace import BinnedMap, WorkspaceMap, binned, sample_workspace

_LABELS = {"x": "x [m]", "y": "y [m]", "z": "z [m]", "r": "distance from the z axis [m]"}
_INSIDE = 0.6
"""Share of filled cells from which a place without a sample counts as inside."""

_METRICS = {
    "inverse_condition": "inverse condition number 1/κ",
    "yoshikawa": "Yoshikawa's measure",
    "min_singular": "smallest singular value",
    "asada": "Asada's measure",
    "isotropy": "isotropy index",
}


def workspace(
    robot: ArmLike,
    chart: WorkspaceMap | None = None,
    *,
    plane: str = "",
    cells: int = 0,
    samples: int = 20_000,
    ax: Any = None,
) -> Any:
    """Where the tool can be and how well it moves there, with all that is known of the edges.

    Planar arms of up to three joints have their boundary and singular curves drawn, spatial ones
    the curves of the section through the first axis where that stands upright.

    Args:
        robot: the robot.
        chart: of :func:`kinlab.sample_workspace`; sampled here if left out.
        plane, cells: as in :func:`kinlab.sweeps.workspace.binned`.
        samples: how many, for a chart that is sampled here.
        ax: where to draw; a new figure if left out.

    Returns:
        The axes.

    Raises:
        KinlabError: as :func:`kinlab.sample_workspace`.
        MissingExtraError: matplotlib is not installed.
    """
    robot = as_robot(robot)
    if chart is None:
        chart = sample_workspace(robot, samples=samples)
    boundary, curves, section = None, [], None
    if not chart.planar and plane in ("", "rz"):
        section = _section(robot)
    if chart.planar and robot.n <= 3:
        boundary = planar_boundary(robot)
        needed = abs(len(chart.rows) - robot.n) + 2
        if needed == robot.n:  # in a smaller slice the others would be held: not the whole set
            loci = singular_loci(robot, list(range(needed)), task=mask_of(chart.rows))
            curves = [fk(robot, curve.q)[:, :3, 3] for curve in loci.curves]
    return workspace_map(
        chart, boundary=boundary, curves=curves, section=section, plane=plane, cells=cells, ax=ax
    )


def _section(robot: Robot) -> WorkspaceSection | None:
    """The section through the first axis where that is the base's z and every edge is known (a
    tool off the wrist's last axes makes that a matter of minutes); else nothing."""
    if not takes_limits(robot):
        return None
    section = workspace_section(robot)
    upright = abs(float(section.axis[2])) > 1.0 - 1e-9
    centred = float(np.linalg.norm(section.origin[:2])) < 1e-9
    return section if upright and centred else None


def workspace_map(
    chart: WorkspaceMap,
    *,
    boundary: PlanarBoundary | None = None,
    curves: Sequence[Array] = (),
    section: WorkspaceSection | None = None,
    plane: str = "",
    cells: int = 0,
    ax: Any = None,
) -> Any:
    """The best measure in each cell of a plane.

    Args:
        chart: the map.
        boundary: drawn as lines, for planar arms.
        curves: tool positions of singular loci, each (K, 3); drawn in the same plane.
        section: edges and internal boundaries, for the plane ``rz``.
        plane, cells: as in :func:`kinlab.sweeps.workspace.binned`.
        ax: where to draw; a new figure if left out.

    Returns:
        The axes.
    """
    flat = binned(chart, cells, plane)
    axes = ax
    if axes is None:
        part = "" if chart.complete else ", stopped early"
        title = f"{chart.robot}: task {chart.task}, {len(chart.values)} samples{part}"
        wide, high = np.ptp(flat.u), np.ptp(flat.v)
        axes = new_axes(title, size=(float(np.clip(1.6 + 4.6 * wide / high, 5.2, 8.0)), 5.2))
    shown = _smooth(axes, flat)
    axes.figure.colorbar(shown, ax=axes, label=f"best {_METRICS[chart.metric]}", shrink=0.85)
    _lines(axes, flat, boundary, curves)
    if section is not None:
        _section_lines(axes, section)
    axes.set_aspect("equal")
    axes.set_xlabel(_LABELS[flat.plane[0]])
    axes.set_ylabel(_LABELS[flat.plane[1]])
    return axes


def workspace_cloud(chart: WorkspaceMap, *, most: int = 6000, ax: Any = None) -> Any:
    """The samples as a cloud in space, coloured by the measure, cut open towards the viewer.

    Args:
        chart: the map. most: points drawn, evenly taken.
        ax: three-dimensional axes; a new figure if left out.

    Returns:
        The axes.
    """
    axes = ax if ax is not None else new_axes(f"{chart.robot}: task {chart.task}", three_d=True)
    behind = np.flatnonzero(~((chart.points[:, 0] > 0.0) & (chart.points[:, 1] < 0.0)))
    chosen = behind[:: max(1, len(behind) // most)]
    x, y, z = chart.points[chosen].T
    shown = axes.scatter(
        x, y, z, c=chart.values[chosen], s=6, depthshade=False, cmap="viridis", vmin=0.0, lw=0
    )
    axes.figure.colorbar(shown, ax=axes, label=_METRICS[chart.metric], shrink=0.7, pad=0.1)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.set_zlabel("z [m]")
    spread_labels(axes)
    return axes


def _smooth(axes: Any, flat: BinnedMap) -> Any:
    """The best values as a smooth surface, cut off where the filled cells end.

    Cells at the edge are filled in part, half of them on average: the cut goes by their centres.
    """
    from contourpy import contour_generator
    from matplotlib.path import Path

    u, v = _centres(flat.u), _centres(flat.v)
    filled = np.pad(flat.count > 0, 1)
    values = _spread(np.pad(flat.best, 1), filled)
    shown = axes.pcolormesh(
        u, v, values.T, cmap="viridis", vmin=0.0, shading="gouraud", rasterized=True
    )
    inside = np.where(filled, np.maximum(_blurred(filled), _INSIDE + 0.01), _blurred(filled))
    outline: Any = contour_generator(u, v, inside.T, fill_type="OuterCode")
    points, codes = outline.filled(_INSIDE, 2.0)
    shown.set_clip_path(Path(np.concatenate(points), np.concatenate(codes)), axes.transData)
    axes.set_xlim(u[0], u[-1])
    axes.set_ylim(v[0], v[-1])
    return shown


def _blurred(filled: Any) -> Array:
    """Share of the cells about each that are filled, near ones more."""
    rows, columns = filled.shape
    padded = np.pad(filled.astype(float), 1)
    weights = np.outer([1.0, 2.0, 1.0], [1.0, 2.0, 1.0]) / 16.0
    share: Array = sum(
        weights[i, j] * padded[i : i + rows, j : j + columns] for i, j in np.ndindex(3, 3)
    )
    return share


def _centres(edges: Array) -> Array:
    """Centres of the cells between edges (K,), and of one more cell on both sides, (K + 1,)."""
    width = float(edges[1] - edges[0])
    centres = 0.5 * (edges[1:] + edges[:-1])
    return np.array([centres[0] - width, *centres, centres[-1] + width])


def _spread(values: Array, filled: Any) -> Array:
    """Values carried on into the empty cells next to filled ones, so that colours do not fade."""
    rows, columns = values.shape
    total = np.pad(np.where(filled, values, 0.0), 1)
    count = np.pad(filled.astype(float), 1)
    near, weight = np.zeros_like(values), np.zeros_like(values)
    for i, j in np.ndindex(3, 3):
        near += total[i : i + rows, j : j + columns]
        weight += count[i : i + rows, j : j + columns]
    return np.where(filled, values, near / np.maximum(weight, 1.0))


def _lines(
    axes: Any, flat: BinnedMap, boundary: PlanarBoundary | None, curves: Sequence[Array]
) -> None:
    labelled = False
    for curve in curves:
        axes.plot(
            *_in_plane(curve, flat.plane),
            color=RED,
            lw=1.6,
            label=None if labelled else "singular locus",
        )
        labelled = True
    if boundary is not None:
        for i, arc in enumerate(boundary.arcs):
            axes.plot(
                *arc.points(200).T, color="black", lw=1.4, ls="--", label=None if i else "boundary"
            )
    if labelled or boundary is not None:
        axes.figure.legend(loc="outside lower center", ncols=2, fontsize=9, frameon=False)


def _section_lines(axes: Any, section: WorkspaceSection) -> None:
    """Edges in black, what lies inside in red; dashed where a joint stands at a limit."""
    for curve in section.curves:
        style = "--" if curve.locked else "-"
        inside = np.where(curve.edge[:, np.newaxis], np.nan, curve.points)
        # an edge reaches to the next point on both sides
        near = curve.edge | np.roll(curve.edge, 1) | np.roll(curve.edge, -1)
        edge = np.where(near[:, np.newaxis], curve.points, np.nan)
        axes.plot(*inside.T, color=RED, lw=1.4, ls=style)
        axes.plot(*edge.T, color="black", lw=1.4, ls=style)
    named = (
        ("edge", "black", "-", any(np.any(c.edge) for c in section.curves)),
        ("inside: solutions change", RED, "-", not all(np.all(c.edge) for c in section.curves)),
        ("with a joint at a limit", "0.4", "--", any(c.locked for c in section.curves)),
    )
    for label, colour, style, drawn in named:
        if drawn:
            axes.plot([], [], color=colour, ls=style, lw=1.4, label=label)
    axes.figure.legend(loc="outside lower center", ncols=3, fontsize=9, frameon=False)


def _in_plane(curve: Array, plane: str) -> tuple[Array, Array]:
    x, y, z = curve.T
    named = {"x": x, "y": y, "z": z, "r": np.hypot(x, y)}
    return named[plane[0]], named[plane[1]]
