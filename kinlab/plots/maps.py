"""Workspace maps: filled for planar arms, a section or a cloud for spatial ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from kinlab.analysis.boundary import PlanarBoundary
from kinlab.analysis.sections import WorkspaceSection
from kinlab.arrays import Array
from kinlab.plots.canvas import RED, new_axes
from kinlab.sweeps.workspace import BinnedMap, WorkspaceMap, binned

_LABELS = {"x": "x [m]", "y": "y [m]", "z": "z [m]", "r": "distance from the z axis [m]"}
_METRICS = {
    "inverse_condition": "inverse condition number 1/κ",
    "yoshikawa": "Yoshikawa's measure",
    "min_singular": "smallest singular value",
    "asada": "Asada's measure",
    "isotropy": "isotropy index",
}


def plot_map(
    chart: WorkspaceMap,
    *,
    boundary: PlanarBoundary | None = None,
    curves: Sequence[Array] = (),
    section: WorkspaceSection | None = None,
    plane: str = "",
    cells: int = 0,
    axes: Any = None,
) -> Any:
    """The best measure in each cell of a plane.

    Args:
        chart: the map.
        boundary: drawn as lines, for planar arms.
        curves: tool positions of singular loci, each (K, 3); drawn in the same plane.
        section: edges and internal boundaries, for the plane ``rz``.
        plane, cells: as in :func:`kinlab.sweeps.workspace.binned`.
        axes: where to draw; a new figure if left out.

    Returns:
        The axes.
    """
    flat = binned(chart, cells, plane)
    if axes is None:
        part = "" if chart.complete else ", stopped early"
        axes = new_axes(f"{chart.robot}: task {chart.task}, {len(chart.values)} samples{part}")
    shown = axes.pcolormesh(
        flat.u,
        flat.v,
        np.ma.masked_where(flat.count == 0, flat.best).T,
        cmap="viridis",
        vmin=0.0,
        shading="flat",
        rasterized=True,
    )
    axes.figure.colorbar(shown, ax=axes, label=f"best {_METRICS[chart.metric]}", shrink=0.85)
    _lines(axes, flat, boundary, curves)
    if section is not None:
        _section_lines(axes, section)
    axes.set_aspect("equal")
    axes.set_xlabel(_LABELS[flat.plane[0]])
    axes.set_ylabel(_LABELS[flat.plane[1]])
    return axes


def plot_cloud(chart: WorkspaceMap, *, most: int = 6000, axes: Any = None) -> Any:
    """The samples as a cloud in space, coloured by the measure, cut open towards the viewer.

    Args:
        chart: the map. most: points drawn, evenly taken.
        axes: three-dimensional axes; a new figure if left out.

    Returns:
        The axes.
    """
    axes = axes if axes is not None else new_axes(f"{chart.robot}: task {chart.task}", three_d=True)
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
    return axes


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
        ("edge", "black", "-"),
        ("inside: solutions change", RED, "-"),
        ("with a joint at a limit", "0.4", "--"),
    )
    for label, colour, style in named:
        axes.plot([], [], color=colour, ls=style, lw=1.4, label=label)
    axes.figure.legend(loc="outside lower center", ncols=3, fontsize=9, frameon=False)


def _in_plane(curve: Array, plane: str) -> tuple[Array, Array]:
    x, y, z = curve.T
    named = {"x": x, "y": y, "z": z, "r": np.hypot(x, y)}
    return named[plane[0]], named[plane[1]]
