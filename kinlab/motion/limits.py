"""Limits of a motion: read at the door, held exactly, and what would hold them where they break."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.errors import LimitError, OptionError
from kinlab.model.robot import Robot
from kinlab.motion.record import peak_of, stretch
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True)
class Limits:
    """Largest absolute values for each joint, (n,); infinite where there is none.

    Attributes:
        velocity: rad/s (m/s). acceleration: rad/s². jerk: rad/s³.
    """

    velocity: Array
    acceleration: Array
    jerk: Array


def read_limits(
    robot: Robot,
    velocity: ArrayLike | None = None,
    acceleration: ArrayLike | None = None,
    jerk: ArrayLike | None = None,
) -> Limits:
    """Reads limits: one number for all joints, or one for each.

    The velocities are the robot's own where they are left out; accelerations and jerks stand in
    no table or URDF, and are infinite where they are left out.

    Raises:
        OptionError: of another shape, or not positive.
    """
    own = np.array(robot.model.upperVelocityLimit, dtype=np.float64)
    own = np.where((own > 0.0) & (own < 1e100), own, np.inf)
    none = np.full(robot.n, np.inf)
    return Limits(
        _read(robot, "velocity", velocity, own),
        _read(robot, "acceleration", acceleration, none),
        _read(robot, "jerk", jerk, none),
    )


def _read(robot: Robot, name: str, value: ArrayLike | None, default: Array) -> Array:
    if value is None:
        return default
    array = real_array(value, f"robot {robot.name!r}: {name}", OptionError)
    if array.shape not in ((), (robot.n,)):
        raise OptionError(
            f"robot {robot.name!r}: {name} has shape {array.shape}; expected one number or "
            f"({robot.n},)"
        )
    full = np.broadcast_to(array, (robot.n,)).copy()
    if not (full > 0.0).all():
        joint = robot.joint_names[int(np.argmin(full > 0.0))]
        raise OptionError(
            f"robot {robot.name!r}: {name} of {joint} is {full.min():g}; it must be positive"
        )
    return full


def stretch_to(curve: Any, limits: Limits) -> float:
    """By what factor in time a curve just holds its limits; below 1 it may be faster."""
    speed, gain = peak_of(curve, 1).value, peak_of(curve, 2).value
    return float(
        max(
            np.max(speed / limits.velocity),
            np.sqrt(np.max(gain / limits.acceleration)),
            np.cbrt(np.max(peak_of(curve, 3).value / limits.jerk))
            if np.isfinite(limits.jerk).any()
            else 0.0,
        )
    )


def within_time_limits(curve: Any, limits: Limits) -> Any:
    """The curve, slowed down as a whole by as little as holds its limits exactly."""
    factor = stretch_to(curve, limits)
    return stretch(curve, factor) if factor > 1.0 else curve


def require_limits(robot: Robot, curve: Any, limits: Limits) -> None:
    """Refuses a motion that breaks a limit at any time.

    Raises:
        LimitError: naming the joint, when, by how much, and what would work.
    """
    require_positions(robot, curve)
    factor = stretch_to(curve, limits)
    if factor <= 1.0 + TOLERANCES.at_limit:
        return
    duration = float(curve.x[-1])
    for name, order, bound in (
        ("velocity", 1, limits.velocity),
        ("acceleration", 2, limits.acceleration),
        ("jerk", 3, limits.jerk),
    ):
        if not np.isfinite(bound).any():
            continue
        peak = peak_of(curve, order)
        over = peak.value / bound
        if over.max() ** (1.0 / order) >= factor * (1.0 - 1e-12):
            joint = int(np.argmax(over))
            raise LimitError(
                f"robot {robot.name!r}: the {name} of {robot.joint_names[joint]} is "
                f"{peak.value[joint]:.6g} at t = {peak.when[joint]:.6g} s, above its limit "
                f"{bound[joint]:.6g}; the same way holds it in {_up(duration * factor)} s instead "
                f"of {duration:.6g} s"
            )


def require_positions(robot: Robot, curve: Any) -> None:
    """Refuses a motion that leaves the joints' limits at any time.

    Raises:
        LimitError: naming the joint, when, and by how much.
    """
    for joint, (when, by, bound) in positions_outside(robot, curve).items():
        raise LimitError(
            f"robot {robot.name!r}: {robot.joint_names[joint]} leaves its limits by {by:.4g} at "
            f"t = {when:.6g} s; the nearest position it can have there is {bound:.6g}"
        )


def positions_outside(robot: Robot, curve: Any) -> dict[int, tuple[float, float, float]]:
    """Joints that leave their limits: when farthest, by how much, and the limit there."""
    middle, half = 0.5 * (robot.upper + robot.lower), 0.5 * (robot.upper - robot.lower)
    shifted = type(curve)(curve.c.copy(), curve.x)
    shifted.c[-1] -= middle
    peak = peak_of(shifted, 0)
    out = {}
    for joint in np.flatnonzero(peak.value > half + 1e-9 * np.maximum(1.0, half)):
        when = float(peak.when[joint])
        above = float(curve(when)[joint]) > middle[joint]
        bound = float(robot.upper[joint] if above else robot.lower[joint])
        out[int(joint)] = (when, float(peak.value[joint] - half[joint]), bound)
    return out


def _up(value: float) -> str:
    """Six digits, rounded up, so that what is printed works."""
    digits = 10.0 ** (5 - int(np.floor(np.log10(value))))
    return f"{np.ceil(value * digits * (1.0 + 1e-9)) / digits:.6g}"
