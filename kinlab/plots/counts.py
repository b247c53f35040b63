"""The number of solutions over a section of the workspace."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.inverse.postures.solution_map import SolutionMap, solution_map
from kinlab.model.library import ArmLike
from kinlab.plots.canvas import RED, new_axes

_LABELS = {
    "rho": "distance from the first axis [m]",
    "z": "along the first axis [m]",
    "x": "x [m]",
    "y": "y [m]",
}
_SHADES = ("#ffffff", "#eef2f7", "#cfe0f1", "#b5cfe8", "#86b0d8", "#5f93c6", "#3d76b0")


def solutions(chart: SolutionMap | ArmLike, *, ax: Any = None) -> Any:
    """Cells coloured by how many solutions are within the limits, with curves, cusps and nodes.

    Args:
        chart: the map, or an arm, whose map is made.
        ax: where to draw; a new figure if left out.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
        OptionError: an arm that has no such map, see :func:`kinlab.solution_map`.
    """
    if not isinstance(chart, SolutionMap):
        chart = solution_map(chart)
    axes = ax
    if axes is None:
        axes = new_axes(f"{chart.robot}: number of solutions\n{chart.text}")
    from matplotlib.collections import LineCollection
    from matplotlib.colors import BoundaryNorm, ListedColormap
    from matplotlib.patches import Patch

    count = chart.within_limits
    most = max(int(count.max(initial=0)), 1)
    shades = [_SHADES[min(i, len(_SHADES) - 1)] for i in range(most + 1)]
    axes.pcolormesh(
        chart.u,
        chart.v,
        np.asarray(count).T,
        cmap=ListedColormap(shades),
        norm=BoundaryNorm(np.arange(most + 2) - 0.5, most + 1),
        shading="nearest",
        rasterized=True,
    )
    axes.add_collection(LineCollection(list(chart.curves), colors=RED, linewidths=1.3))
    handles: list[Any] = [
        Patch(facecolor=shades[i], edgecolor="0.6", label=f"{i}") for i in np.unique(count)
    ]
    handles.extend(axes.plot([], [], color=RED, lw=1.3, label="singular"))
    for points, mark, name in (
        (chart.cusps, "o", "cusp"),
        (chart.nodes, "s", "node"),
        (chart.collapsed, "D", "singular line"),
    ):
        if len(points):
            handles.extend(
                axes.plot(*points.T, mark, color="black", ms=4.5, mfc="white", label=name, zorder=4)
            )
    axes.set_aspect("equal")
    axes.set_xlabel(_LABELS[chart.labels[0]])
    axes.set_ylabel(_LABELS[chart.labels[1]])
    axes.figure.legend(
        handles=handles, loc="outside lower center", ncols=len(handles), fontsize=9, frameon=False
    )
    return axes
