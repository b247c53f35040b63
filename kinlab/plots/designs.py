"""Pictures of designed five-bars: one design over its rectangle, and a Pareto front."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.fivebar.design.front import DesignFront
from kinlab.fivebar.design.goals import GOALS
from kinlab.fivebar.design.synthesis import FiveBarDesign
from kinlab.plots.canvas import BLUE, GREY, new_axes, new_figure
from kinlab.plots.mechanisms import bars, box_of


def fivebar_design(design: FiveBarDesign, *, resolution: int = 121, ax: Any = None) -> Any:
    """The condition number over the rectangle, with the linkage in the rectangle's middle.

    Args:
        design: the answer of :func:`kinlab.design_fivebar`.
        resolution: points along each side.
        ax: where to draw; a new figure if left out.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    axes = new_axes(size=(8.0, 6.4)) if ax is None else ax
    box, five = design.workspace, design.fivebar
    x, y = (np.linspace(a, b, resolution) for a, b in (box[:2], box[2:]))
    points = np.stack(np.meshgrid(x, y), axis=-1)
    kappa = five.condition_number(points.reshape(-1, 2), design.mode).reshape(points.shape[:2])
    drawn = axes.pcolormesh(x, y, kappa, cmap="viridis_r", shading="nearest", rasterized=True)
    axes.figure.colorbar(drawn, ax=axes, label="condition number of J")
    box_of(axes, box, "workspace")
    middle = np.array([0.5 * (box.x_min + box.x_max), 0.5 * (box.y_min + box.y_max)])
    bars(axes, five, middle, design.mode)
    axes.set(aspect="equal", xlabel="x, m", ylabel="y, m")
    l1, l2, e = design.lengths
    axes.set_title(f"l1 = {l1:.4g} m, l2 = {l2:.4g} m, e = {e + 0.0:.4g} m")
    worst = design.goals["condition"]
    text = f"worst condition number {worst.value:.5g}, proved to {worst.bound:.5g}"
    if ax is None:
        axes.figure.supxlabel(text, fontsize=9)
    axes.use_sticky_edges = False
    axes.margins(0.06)
    return axes


def fivebar_front(front: DesignFront, *, ax: Any = None) -> Any:
    """The two goals along a Pareto front, and the three lengths beneath.

    Args:
        front: the answer of :func:`kinlab.fivebar_front`.
        ax: where to draw, two axes one above the other; a new figure if left out.

    Returns:
        The first of its two axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    if ax is None:
        ax = new_figure((7.6, 6.8)).subplots(2, 1, sharex=True, height_ratios=(3, 2))
    above, below = ax
    first, second = front.goals
    x, y = (np.array(front.values(goal)) for goal in (second, first))
    above.plot(x, y, color=BLUE, marker="o", lw=1.4)
    units = {goal: f", {GOALS[goal].unit}" if GOALS[goal].unit else "" for goal in front.goals}
    above.set_ylabel(f"{GOALS[first].words}{units[first]}")
    if first == "condition" and y.max() > 3.0 * y.min():
        above.set_yscale("log")
        above.yaxis.set_major_formatter("{x:g}")
        above.yaxis.set_minor_formatter("{x:g}")
    above.grid(color=GREY, alpha=0.25)
    lengths = np.array([design.lengths for design in front.designs])
    for column, (name, style) in enumerate((("l1", "-"), ("l2", "--"), ("e", ":"))):
        below.plot(x, lengths[:, column], ls=style, marker=".", label=name)
    below.set(xlabel=f"{GOALS[second].words}{units[second]}", ylabel="lengths, m", ylim=(0.0, None))
    below.grid(color=GREY, alpha=0.25)
    below.legend(ncols=3, fontsize=9)
    above.set_title(f"{len(front.designs)} five-bars of which none is better in both")
    return above
