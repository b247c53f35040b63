"""Errors of inverse kinematics over its iterations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from kinlab.errors import OptionError
from kinlab.inverse.result import IKHistory, IKResult
from kinlab.plots.canvas import BLUE, GREEN, GREY, RED, new_axes, whole_ticks
from kinlab.tolerances import TOLERANCES


def ik_history(
    histories: IKResult | IKHistory | Mapping[str, IKHistory], title: str = "", ax: Any = None
) -> Any:
    """Position error (full line) and rotation error (dashed) of each search.

    Args:
        histories: a result of ``kinlab.ik(..., history=True)``, its ``history``, or several of
            these by label.
        title: of the figure.
        ax: where to draw; a new figure if left out.

    Returns:
        The axes.

    Raises:
        OptionError: a result without a history.
        MissingExtraError: matplotlib is not installed.
    """
    histories = _by_label(histories)
    axes = ax if ax is not None else new_axes(title)
    longest = 1
    for (label, history), colour in zip(
        histories.items(), (BLUE, RED, GREEN, GREY) * len(histories), strict=False
    ):
        steps = np.arange(1, len(history.q) + 1)
        longest = max(longest, len(steps))
        shown = np.maximum(history.position_error, TOLERANCES.drawn_error)
        axes.plot(steps, shown, color=colour, label=label)
        if history.rotation_error.any():
            shown = np.maximum(history.rotation_error, TOLERANCES.drawn_error)
            axes.plot(steps, shown, color=colour, linestyle="--", alpha=0.7)
        for start in np.flatnonzero(np.diff(history.search)) + 1.5:
            axes.axvline(start, color=colour, linewidth=0.6, linestyle=":")
    axes.set_yscale("log")
    if longest > 100:
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    else:
        whole_ticks(axes.xaxis)
    axes.set_xlabel("iteration (dotted: a new start)")
    axes.set_ylabel("error: position [m] full, rotation [rad] dashed")
    axes.grid(alpha=0.25, which="major")
    axes.legend(fontsize=9)
    return axes


def _by_label(histories: IKResult | IKHistory | Mapping[str, IKHistory]) -> Mapping[str, IKHistory]:
    if isinstance(histories, IKHistory):
        return {"search": histories}
    if isinstance(histories, IKResult):
        if histories.history is None:
            raise OptionError("this result has no history; ask for it: kl.ik(..., history=True)")
        return {str(histories.status): histories.history}
    return histories
