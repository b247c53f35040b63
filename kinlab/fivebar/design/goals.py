"""What a five-bar can be designed for: each goal is the worst of a few smooth quantities.

Every quantity is a formula of a pose that is to be kept small, and its worst over the rectangle is
what counts. The same formulas run on one linkage, on one linkage per point (a whole population of
candidates at once) and on cells, where they prove the worst.

Terms: the transmission angle is the one between the rods at the tool, measured to the nearer of
folded and stretched (Gosselin & Angeles 1990 call what it bounds type II). Clearance is the least
of all lengths that must not vanish: the lever arms of cranks and rods (zero at a singularity of
type I and II), and the distances of pins that no bar joins (zero where pins collide).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.fivebar.geometry import Pose
from kinlab.fivebar.metrics import sigma

GRAVITY = 9.81
"""m/s². The payload's weight, in any direction, is what the goal ``torque`` holds."""


@dataclass(frozen=True)
class Candidates:
    """Linkages, one per pose: what the formulas of this room need of a linkage.

    Attributes:
        l1, l2: (N, 2), m. e: (N,), m.
    """

    l1: Array
    l2: Array
    e: Array

    @property
    def base_x(self) -> Array:
        """x of the base pins, (N, 2)."""
        return np.stack([self.e, -self.e], axis=-1)


def _condition(linkage: Any, pose: Pose) -> Any:
    both = sigma(linkage, pose)
    return (both[:, 0] / both[:, 1])[:, None]


def _torque(linkage: Any, pose: Pose) -> Any:
    """Crank torque for a force of 1 N in its worst direction: l1 |u x w| / |w_1 x w_2|."""
    return np.abs(linkage.l1 * pose.sine) / np.abs(pose.rods)[:, None]


def _clearance(linkage: Any, pose: Pose) -> Any:
    """The lengths that must not vanish, each with a minus."""
    base_x = linkage.base_x
    base = np.stack([base_x, np.zeros_like(base_x)], axis=-1)
    elbow = base + linkage.l1[..., None] * pose.u
    to_tool, between = pose.xy[:, None, :] - base, elbow[:, 0] - elbow[:, 1]
    across = elbow - base[..., ::-1, :]
    pins = [np.hypot(gap[..., 0], gap[..., 1]) for gap in (to_tool, across)]
    cranks = np.abs(linkage.l1 * pose.sine)
    rods = linkage.l2 * np.abs(pose.rods)[:, None]
    each = [part[:, leg] for part in (cranks, rods, *pins) for leg in (0, 1)]
    return -np.stack([*each, np.hypot(between[:, 0], between[:, 1])], axis=1)


def _transmission(linkage: Any, pose: Pose) -> Any:
    """|w_1 · w_2|, which grows as the transmission angle leaves 90 degrees."""
    del linkage
    return np.abs(np.einsum("nj,nj->n", pose.w[:, 0], pose.w[:, 1]))[:, None]


@dataclass(frozen=True)
class Goal:
    """One thing to design for.

    Attributes:
        pieces: quantities (N, k) to be kept small; ``None`` for what is no matter of poses.
        shown: from the worst of the pieces to what a user reads.
        inner: the way back.
        unit: of what a user reads.
        words: what it is.
        most: a user's limit is the largest value allowed; false: the least.
    """

    pieces: Callable[[Any, Pose], Any] | None
    shown: Callable[[float], float]
    inner: Callable[[float], float]
    unit: str
    words: str
    most: bool = True


def _same(value: float) -> float:
    return value


GOALS: dict[str, Goal] = {
    "condition": Goal(_condition, _same, _same, "", "condition number"),
    "size": Goal(None, _same, _same, "m", "size l1 + l2 + e"),
    "torque": Goal(_torque, _same, _same, "N m", "crank torque for the payload"),
    "clearance": Goal(
        _clearance,
        lambda worst: -worst,
        lambda least: -least,
        "m",
        "clearance",
        most=False,
    ),
    "transmission": Goal(
        _transmission,
        lambda worst: float(np.degrees(np.arccos(min(worst, 1.0)))),
        lambda angle: float(np.cos(np.radians(angle))),
        "°",
        "transmission angle",
        most=False,
    ),
}
"""Goals by name. ``size`` is half of all bars and the base together; divided by 3 it is the scale
by which Liu, Wang and Pritschow make the lengths dimensionless (from memory)."""
