"""Closed form of planar arms with two or three parallel revolute joints (note 000).

All vectors lie in the plane of the arm, as seen from the first joint's frame. With a from joint 1
to joint 2 (turned by q1) and b from joint 2 to the point asked for (turned by q1 + q2):
|a + R(q2) b|^2 = |p|^2 is linear in cos q2 and sin q2 and has two solutions, elbow one way and
the other; q1 then turns a + R(q2) b onto p. None where p is out of reach, one where stretched.
"""

from __future__ import annotations

import math

import numpy as np

from kinlab.arrays import Array
from kinlab.chain_arrays import Chain

_PARALLEL = 1e-9


def is_planar(chain: Chain) -> bool:
    """Whether there are two or three revolute joints with parallel axes, up to their sign."""
    rotations = chain.fixed[1:-1].reshape(-1, 3, 4)[:, :, :3]
    return (
        len(chain.prismatic) in (2, 3)
        and not chain.prismatic.any()
        and bool(np.all(np.hypot(rotations[:, 0, 2], rotations[:, 1, 2]) < _PARALLEL))
    )


def solve(chain: Chain, target: Array) -> list[Array]:
    """All q that bring the tool to the target's place in the plane.

    Args:
        chain: of a planar arm (:func:`is_planar`).
        target: (4, 4). Two joints: its point in the plane counts; three: also its angle.

    Returns:
        Up to two (n,), angles not wrapped.
    """
    steps = np.tile(np.eye(4), (len(chain.fixed), 1, 1))
    steps[:, :3] = chain.fixed.reshape(-1, 3, 4)
    # an axis against the first one turns the plane's picture over: undo it, and negate q there
    signs = [1.0]
    for step in steps[1:-1]:
        signs.append(signs[-1] * math.copysign(1.0, step[2, 2]))
    home = [np.eye(4)]
    for step in steps[1:]:
        home.append(home[-1] @ step)
    points = np.array([f[:2, 3] for f in home])  # joints 1..n and the tool, at q = 0
    goal = np.linalg.inv(steps[0]) @ target
    if len(signs) == 2:
        found = _two_links(points[1] - points[0], points[2] - points[1], goal[:2, 3])
        return [np.array([q1, signs[1] * q2]) for q1, q2 in found]
    # three joints: the angle fixes where the last link lies
    turn = goal[:3, :3] @ home[-1][:3, :3].T
    angle = math.atan2(turn[1, 0], turn[0, 0])
    c, s = math.cos(angle), math.sin(angle)
    last = points[3] - points[2]
    wrist = goal[:2, 3] - np.array([c * last[0] - s * last[1], s * last[0] + c * last[1]])
    found = _two_links(points[1] - points[0], points[2] - points[1], wrist)
    return [np.array([q1, signs[1] * q2, signs[2] * (angle - q1 - q2)]) for q1, q2 in found]


def _two_links(a: Array, b: Array, p: Array) -> list[tuple[float, float]]:
    """(q1, q2) with R(q1) (a + R(q2) b) = p."""
    cosine = float(a @ b)
    sine = float(a[1] * b[0] - a[0] * b[1])
    answers = []
    for q2 in linear_trig(2.0 * cosine, 2.0 * sine, float(p @ p - a @ a - b @ b)):
        c, s = math.cos(q2), math.sin(q2)
        out = a + np.array([c * b[0] - s * b[1], s * b[0] + c * b[1]])
        answers.append((math.atan2(p[1], p[0]) - math.atan2(out[1], out[0]), q2))
    return answers


def linear_trig(a: float, b: float, c: float) -> list[float]:
    """Solutions x of a cos x + b sin x = c: atan2(b, a) +- acos(c / hypot(a, b)).

    Two, one where they coincide, none where |c| is larger than hypot(a, b), and none where a and
    b vanish (every x or none would do). A c that is too large by rounding counts as equal.
    """
    size = math.hypot(a, b)
    if size == 0.0 or abs(c) > size * (1.0 + 1e-9):
        return []
    middle = math.atan2(b, a)
    half = math.acos(max(-1.0, min(1.0, c / size)))
    return [middle + half, middle - half] if half > 0.0 else [middle]
