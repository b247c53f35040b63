"""Torque over speed of the drives of an arm, with the limits of each motor."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.drives.arm import ArmSizing
from kinlab.errors import OptionError
from kinlab.plots.canvas import BLUE, GREEN, GREY, RED, figure_text, new_figure


def torque_speed(sizing: ArmSizing, ax: Any = None) -> Any:
    """The motion of each shaft over speed and torque, inside what its motor allows.

    The drive is the first of each joint's list. Filled: what the motor may do for a while, up to
    its peak torque and largest speed; dashed: its rated torque, for the root mean square, which
    stands as a line of points. A drive that does not fit is framed in red, with the limit that
    fails.

    Args:
        sizing: of :func:`kinlab.size_servos`.
        ax: axes of one figure, as many as joints; a new figure if left out.

    Returns:
        The first of the axes.

    Raises:
        OptionError: too few axes.
        MissingExtraError: matplotlib is not installed.
    """
    count = len(sizing.joints)
    columns = min(3, count)
    rows = -(-count // columns)
    given = (
        new_figure((3.9 * columns, 3.1 * rows + 0.6)).subplots(rows, columns) if ax is None else ax
    )
    grid = np.ravel(given)
    if len(grid) < count:
        raise OptionError(f"ax: {len(grid)} axes; the arm has {count} joints")
    figure = grid[0].figure
    speeds, torques = sizing.at_shafts()
    for joint, axes in enumerate(grid):
        if joint >= count:
            axes.set_visible(False)
            continue
        fit = sizing.fits[joint][0]
        top, peak, rated = (fit.motor.need(f) for f in ("max_speed", "peak_torque", "rated_torque"))
        box = axes.fill_between([-top, top], -peak, peak, color=GREEN, alpha=0.13, lw=0)
        box.set_label("motor: peak torque, largest speed")
        for sign, label in ((1.0, "motor: rated torque"), (-1.0, None)):
            axes.plot([-top, top], [sign * rated] * 2, color=GREEN, lw=1.2, ls="--", label=label)
        axes.plot(speeds[:, joint], torques[:, joint], color=BLUE, lw=1.3, label="shaft")
        for sign, label in ((1.0, "shaft: RMS torque"), (-1.0, None)):
            axes.axhline(sign * fit.rms, color=BLUE, lw=1.0, ls=":", label=label)
        axes.axhline(0.0, color=GREY, lw=0.5, zorder=0)
        axes.axvline(0.0, color=GREY, lw=0.5, zorder=0)
        reach_x = 1.08 * max(top, float(np.abs(speeds[:, joint]).max()))
        reach_y = 1.12 * max(peak, float(np.abs(torques[:, joint]).max()))
        axes.set(xlim=(-reach_x, reach_x), ylim=(-reach_y, reach_y))
        name = f"{sizing.joints[joint]}: {fit.motor.name}, gear {fit.gear_ratio:.3g}"
        verdict = f"least margin {fit.margin:.3g}, {fit.limit}"
        axes.set_title(f"{figure_text(name)}\n{verdict}", fontsize=9)
        if not fit.fits:
            axes.set_title(f"{figure_text(name)}\nfails: {fit.failed[0]}", fontsize=9, color=RED)
            for spine in axes.spines.values():
                spine.set(color=RED, lw=1.6)
        axes.tick_params(labelsize=8)
        if joint % columns == 0:
            axes.set_ylabel("torque at the shaft, N m", fontsize=9)
        if joint + columns >= count:
            axes.set_xlabel("speed of the shaft, r/min", fontsize=9)
    figure.legend(
        *grid[0].get_legend_handles_labels(),
        loc="outside lower center",
        ncols=4,
        fontsize=8,
        frameon=False,
    )
    figure.suptitle(
        f"{figure_text(sizing.robot)}: drives over a motion of {sizing.demand.t[-1]:.3g} s",
        fontsize=11,
    )
    return grid[0]
