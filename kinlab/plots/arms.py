"""The arm as a line, with its ellipses."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.ellipsoids import ellipsoid
from kinlab.analysis.structure.axes import Axes, frame_origins
from kinlab.analysis.structure.task_space import TaskSpace
from kinlab.engine.states import joint_vector
from kinlab.errors import OptionError
from kinlab.model.library import ArmLike, as_robot
from kinlab.plots.canvas import BLUE, GREEN, GREY, RED, new_axes
from kinlab.sweeps.workspace import stays_in_plane

_STYLES = {"velocity": (GREEN, "-"), "force": (RED, "--"), "dynamic": (GREY, "-.")}


def ellipses(
    robot: ArmLike,
    q: ArrayLike,
    kinds: tuple[str, ...] = ("velocity", "force"),
    ax: Any = None,
    size: float = 0.35,
) -> Any:
    """Draws a planar arm at q with its ellipses at the tool.

    Args:
        robot: an arm that stays in a plane z = const of the base.
        q: joint positions, (n,).
        kinds: of :func:`kinlab.analysis.ellipsoids.ellipsoid`. Each ellipse is drawn with its
            longest axis ``size`` of the arm's reach: units differ, shapes compare.
        ax: where to draw; a new figure if left out.
        size: share of the reach.

    Returns:
        The axes.

    Raises:
        OptionError: an arm that leaves the plane.
        StateError, NameUnknownError, MissingExtraError: bad q, unknown kind, no matplotlib.
    """
    robot = as_robot(robot)
    if not stays_in_plane(TaskSpace(robot, (0, 1), "xy")):
        raise OptionError(
            f"robot {robot.name!r} leaves the x-y plane; ellipses are drawn of planar arms"
        )
    state = joint_vector(robot, q, "q")
    found = [ellipsoid(robot, state, kind, "xy") for kind in kinds]
    axes = ax if ax is not None else new_axes(f"{robot.name}: ellipses at the tool")
    corners = frame_origins(robot, state)[:, :2]
    axes.plot(*corners.T, color=BLUE, lw=4, solid_capstyle="round", zorder=2)
    axes.plot(
        *Axes.at(robot, state).point[:, :2].T, "o", color="white", mec=BLUE, ms=8, mew=2, zorder=3
    )
    reach = float(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum())
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    for shape in found:
        lengths = np.array(shape.lengths)
        if np.isinf(lengths[0]):  # a line without end: drawn across the picture
            lengths = np.where(np.isinf(lengths), 3.0, 0.0)
        unit = size * reach / max(float(lengths[0]), 1e-12)
        ring = shape.axes @ (
            unit * lengths[:, np.newaxis] * np.stack([np.cos(angle), np.sin(angle)])
        )
        colour, line = _STYLES[shape.kind]
        note = ", flat" if lengths[1] <= 1e-9 * lengths[0] else f" {lengths[1] / lengths[0]:.3g}"
        axes.plot(
            corners[-1, 0] + ring[0],
            corners[-1, 1] + ring[1],
            line,
            color=colour,
            lw=1.8,
            label=f"{shape.kind}: axis ratio{note}",
        )
    axes.plot(*corners[-1], "o", color=RED, ms=5, zorder=4)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.grid(alpha=0.25)
    if ax is None:
        axes.figure.legend(loc="outside lower center", ncols=3, fontsize=9, frameon=False)
    else:  # the figure may hold other axes, with legends of their own
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), fontsize=9, frameon=False)
    return axes
