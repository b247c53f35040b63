"""Time laws along a way of length 1: trapezoid of the velocity, and the polynomial of degree five.

A law goes from 0 at rest to 1 at rest as fast as a largest speed V (1/s) and acceleration A (1/s²)
let it. Source: Craig, *Introduction to Robotics*, sections 7.3 (quintic, linear with parabolic
blends); Siciliano et al., *Robotics*, section 4.2.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from kinlab.arrays import Array

QUINTIC_SPEED, QUINTIC_ACCELERATION = 1.875, 10.0 / np.sqrt(3.0)
"""Peaks of 10 τ³ - 15 τ⁴ + 6 τ⁵ over 1 in 1 s."""


QUINTIC = np.array([6.0, -15.0, 10.0, 0.0, 0.0, 0.0])
"""Coefficients of 6 τ⁵ - 15 τ⁴ + 10 τ³, the highest first."""


def rising(tau: Array) -> tuple[Array, Array, Array]:
    """10 τ³ - 15 τ⁴ + 6 τ⁵ from 0 to 1 and its first two derivatives, of any shape."""
    orders = (np.asarray(np.polyder(QUINTIC, m), dtype=np.float64) for m in range(3))
    s, speed, gain = (np.asarray(np.polyval(c, tau), dtype=np.float64) for c in orders)
    return s, speed, gain


def quintic_time(speed: Any, acceleration: Any) -> Any:
    """Least time of the polynomial over a way of length 1 under V and A, s; elementwise."""
    return np.maximum(QUINTIC_SPEED / speed, np.sqrt(QUINTIC_ACCELERATION / acceleration))


def completed(speed: float, acceleration: float, size: float) -> tuple[float, float]:
    """Finite V and A where one of them, or both, are infinite.

    Without an acceleration a trapezoid's three parts take the same time: A = 2 V². Without both,
    a way of that size is passed at about 1 a second; the caller then stretches it.
    """
    if not np.isfinite(acceleration):
        speed = speed if np.isfinite(speed) else 1.0 / size
        return speed, 2.0 * speed**2
    return min(speed, 1e3 * float(np.sqrt(acceleration))), acceleration


def trapezoid(speed: float, acceleration: float) -> Any:
    """Constant acceleration, constant speed, constant deceleration; the second may be missing.

    T = 1/V + V/A, or 2/sqrt(A) where V is never reached (V² >= A).
    """
    from scipy.interpolate import PPoly  # a third of a second, and only motions need it

    ramp = min(speed / acceleration, 1.0 / np.sqrt(acceleration))
    top = acceleration * ramp
    cruise = max(1.0 / top - ramp, 0.0)
    half, rest = 0.5 * top * ramp, 1.0 - 0.5 * top * ramp
    rows = [[0.5 * acceleration, 0.0, 0.0], [0.0, top, half], [-0.5 * acceleration, top, rest]]
    times = np.array([0.0, ramp, ramp + cruise, 2.0 * ramp + cruise])
    kept = np.diff(times) > 1e-12 * times[-1]
    pieces, breaks = np.array(rows)[kept], np.concatenate([[0.0], times[1:][kept]])
    return PPoly(pieces.T, breaks)


def quintic(speed: float, acceleration: float) -> Any:
    """10 τ³ - 15 τ⁴ + 6 τ⁵: speed and acceleration start and end at zero."""
    from scipy.interpolate import PPoly

    time = float(quintic_time(speed, acceleration))
    powers = QUINTIC / time ** np.arange(5, -1, -1.0)
    return PPoly(powers[:, np.newaxis], np.array([0.0, time]))


LAWS: dict[str, Callable[[float, float], Any]] = {"trapezoid": trapezoid, "quintic": quintic}


def values(law: Any, t: Array, side: str = "right") -> tuple[Array, Array, Array]:
    """s, its speed and its acceleration at times t (N,): 0 before, 1 after the law, at rest there.

    ``side`` says which of two accelerations counts where they jump.
    """
    end = float(law.x[-1])
    inside = np.clip(t, 0.0, end)
    s, speed = np.asarray(law(inside)), np.asarray(law(inside, 1))
    nudge = 1e-9 * end if side == "right" else -1e-9 * end
    moved = t + nudge
    # a jump at a knot is met from the wanted side: the piece is chosen there, the value at t
    piece = np.clip(np.searchsorted(law.x, moved, "right") - 1, 0, len(law.x) - 2)
    local = inside - law.x[piece]
    second = law.derivative(2)
    gain = np.zeros_like(t)
    for row in second.c:
        gain = gain * local + row[piece]
    within = (moved > 0.0) & (moved < end)
    return s, np.where((t >= 0.0) & (t <= end), speed, 0.0), np.where(within, gain, 0.0)
