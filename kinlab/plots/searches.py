"""Errors of inverse kinematics over its iterations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from kinlab.inverse.result import IKHistory
from kinlab.plots.canvas import BLUE, GREEN, GREY, RED, new_axes

_FLOOR = 1e-17


def plot_searches(histories: Mapping[str, IKHistory], title: str = "", axes: Any = None) -> Any:
    """Position error (full line) and rotation error (dashed) of each search.

    Args:
        histories: label to the ``history`` of a result of :func:`kinlab.ik`.
        title: of the figure.
        axes: where to draw; a new figure if left out.

    Returns:
        The axes.

    Raises:
        MissingExtraError: matplotlib is not installed.
    """
    axes = axes if axes is not None else new_axes(title)
    longest = 1
    for (label, history), colour in zip(
        histories.items(), (BLUE, RED, GREEN, GREY) * len(histories), strict=False
    ):
        steps = np.arange(1, len(history.q) + 1)
        longest = max(longest, len(steps))
        axes.plot(steps, np.maximum(history.position_error, _FLOOR), color=colour, label=label)
        if history.rotation_error.any():
            shown = np.maximum(history.rotation_error, _FLOOR)
            axes.plot(steps, shown, color=colour, linestyle="--", alpha=0.7)
        for start in np.flatnonzero(np.diff(history.search)) + 1.5:
            axes.axvline(start, color=colour, linewidth=0.6, linestyle=":")
    axes.set_yscale("log")
    if longest > 100:
        axes.set_xscale("log")
    axes.set_xlabel("iteration (dotted: a new start)")
    axes.set_ylabel("error: position [m] full, rotation [rad] dashed")
    axes.grid(alpha=0.25, which="major")
    axes.legend(fontsize=9)
    return axes
