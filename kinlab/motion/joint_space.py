"""Motions between joint positions: trapezoid, quintic, spline, jerk-limited, time-optimal."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import make_interp_spline

from kinlab.arrays import Array, between, number, word
from kinlab.drives import laws
from kinlab.engine.states import joint_vector
from kinlab.errors import LimitError, OptionError, StateError
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.motion import jerk_limited, time_optimal
from kinlab.motion.limits import Limits, read_limits, require_limits, stretch_to
from kinlab.motion.record import Motion, along_lines, motion_of, pieces_of, stretch
from kinlab.tolerances import TOLERANCES

STEP = 0.01
"""s between samples where nobody asks for another."""


class _Planner(NamedTuple):
    """How a law plans: the curve through points (K, n) within limits, and what it needs for it."""

    plan: Callable[[Array, Limits], Any]
    needs: tuple[str, ...]


def joint(
    robot: ArmLike,
    points: ArrayLike,
    law: str = "quintic",
    *,
    velocity: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
    jerk: ArrayLike | None = None,
    duration: float | None = None,
    step: float = STEP,
) -> Motion:
    """A motion from one joint position to the next, at rest at both ends.

    ===============  =======================================================================
    law              what it does
    ===============  =======================================================================
    ``"quintic"``    straight from point to point, at rest in each; a is continuous
    ``"trapezoid"``  the same with constant accelerations: the fastest within v and a limits
    ``"jerk"``       the same as fast as v, a and jerk limits allow (package ruckig)
    ``"spline"``     through the points without a stop, on a spline of fifth degree
    ``"optimal"``    through the points as fast as v and a limits allow on a cubic spline, to
                     the accuracy of a grid of 800 path positions (package toppra)
    ===============  =======================================================================

    All joints start and arrive together. A spline's points are passed at times in proportion to
    the longest move of a joint, over its velocity limit.

    Args:
        robot: the arm.
        points: joint positions in order, (K, n), K at least 2, within the limits.
        law: one of the names above.
        velocity: largest |v|, one for all joints or (n,), rad/s (m/s); left out, the robot's own.
        acceleration: largest |a|, rad/s²; no table or URDF states it, so it has no default.
        jerk: largest |da/dt|, rad/s³; needed by ``"jerk"``.
        duration: of the whole motion, s; left out, the shortest of its law within the limits.
        step: largest time between the samples of the answer, s.

    Returns:
        The motion, held within position, velocity and acceleration limits at all times.

    Raises:
        StateError: points of another shape, not finite, or none differs from the first.
        LimitError: outside a joint's limits (says where, when, by how much), or a duration within
            which a limit cannot be held; says the shortest that works.
        OptionError: neither acceleration nor duration; a limit that is not positive.
        NameUnknownError: no such law. MissingExtraError: its package is not installed.
    """
    robot = as_robot(robot)
    rows = read_points(robot, points)
    planner = _PLANNERS[word(law, _PLANNERS, "law")]
    limits = read_limits(robot, velocity, acceleration, jerk)
    given = {"velocity": limits.velocity, "acceleration": limits.acceleration, "jerk": limits.jerk}
    for name in planner.needs:
        if not np.isfinite(given[name]).all():
            raise OptionError(f"robot {robot.name!r}: law {law!r} needs {name}=, for every joint")
    if jerk is not None and law in ("trapezoid", "optimal"):
        raise OptionError(
            f"robot {robot.name!r}: law {law!r} jumps in acceleration, so it holds no limit of "
            "jerk; use 'quintic', 'spline' or 'jerk'"
        )
    free = not np.isfinite(limits.acceleration).all()
    if duration is None and free:
        raise OptionError(
            f"robot {robot.name!r}: how fast? give acceleration= (rad/s^2, one for all joints or "
            "one for each), or duration= (s)"
        )
    curve = planner.plan(rows, limits)
    if duration is not None:
        wanted = number(duration, "duration", above=0.0)
        curve = stretch(curve, wanted / float(curve.x[-1]))
    require_limits(robot, curve, limits)
    return motion_of(robot.name, law, curve, step)


def read_points(robot: Robot, points: ArrayLike) -> Array:
    """Reads joint positions in order, (K, n); points that repeat the one before are left out.

    Raises:
        StateError: another shape, not finite, or nothing moves.
        LimitError: outside the limits.
    """
    rows = joint_vector(robot, points, "points")
    if rows.ndim != 2 or len(rows) < 2:
        raise StateError(
            f"robot {robot.name!r}: points has shape {rows.shape}; expected (K, {robot.n}), K at "
            "least 2"
        )
    slack = TOLERANCES.same_number * np.maximum(1.0, np.abs(rows))
    outside = ~between(rows, robot.lower, robot.upper, slack)
    if outside.any():
        row, joint_ = (int(i) for i in np.argwhere(outside)[0])
        low, high = robot.lower[joint_], robot.upper[joint_]
        raise LimitError(
            f"robot {robot.name!r}: point {row + 1} of {len(rows)}: {robot.joint_names[joint_]} is "
            f"{rows[row, joint_]:.6g}, outside {low:.6g} to {high:.6g}; the nearest that works is "
            f"{low if rows[row, joint_] < low else high:.6g}"
        )
    moved = np.concatenate([[True], np.abs(np.diff(rows, axis=0)).max(axis=1) > 0.0])
    if moved.sum() < 2:
        raise StateError(f"robot {robot.name!r}: all points are the same; nothing moves")
    kept: Array = rows[moved]
    return kept


def _straight(law: Callable[[float, float], Any]) -> Callable[[Array, Limits], Any]:
    """Straight lines in joint space, each by one law, at rest in every point."""

    def plan(rows: Array, limits: Limits) -> Any:
        return along_lines(rows, lambda line: law(*_caps(line, limits)))

    return plan


def _caps(displacement: Array, limits: Limits) -> tuple[float, float]:
    """Largest speed and acceleration along a line, as parts of it per s and s²."""
    moves = np.abs(displacement) > 0.0
    size = np.abs(displacement[moves])
    velocity, acceleration = limits.velocity[moves], limits.acceleration[moves]
    speed = float(np.min(velocity / size))
    gain = float(np.min(acceleration / size))
    return laws.completed(speed, gain, float(size.max()))


def _spline(rows: Array, limits: Limits) -> Any:
    """A spline of fifth degree through the points, at rest with no acceleration at both ends."""
    size = np.abs(np.diff(rows, axis=0))
    pace = np.where(np.isfinite(limits.velocity), limits.velocity, 1.0)
    times = np.concatenate([[0.0], np.cumsum((size / pace).max(axis=1))])
    still = [(1, np.zeros(rows.shape[1])), (2, np.zeros(rows.shape[1]))]
    curve = pieces_of(make_interp_spline(times, rows, k=5, bc_type=(still, still)))
    return stretch(curve, stretch_to(curve, limits) or 1.0)


_PLANNERS = {
    "quintic": _Planner(_straight(laws.quintic), ()),
    "trapezoid": _Planner(_straight(laws.trapezoid), ()),
    "jerk": _Planner(jerk_limited.plan, ("velocity", "acceleration", "jerk")),
    "spline": _Planner(_spline, ()),
    "optimal": _Planner(time_optimal.plan, ("velocity", "acceleration")),
}
