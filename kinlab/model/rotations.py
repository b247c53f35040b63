"""Rotations as URDF writes them: fixed-axis roll, pitch, yaw."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from kinlab.arrays import Array


def rpy_matrix(roll: float, pitch: float, yaw: float) -> Array:
    """R = Rz(yaw) Ry(pitch) Rx(roll), shape (3, 3); angles in radians."""
    cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
    cy, sy = math.cos(yaw), math.sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def matrices_rpy(rotations: Iterable[Array]) -> list[tuple[float, float, float]]:
    """The angles of :func:`rpy_matrix` for each rotation, exact to rounding in gimbal lock too.

    Reading the three angles off the matrix one by one loses them where pitch is ±90°: two of
    them become the arctangent of rounding noise. Here yaw is read first, whatever it is, and the
    other two off Rz(-yaw) R, so that noise in yaw is taken back by roll.

    Args:
        rotations: each (3, 3).

    Returns:
        roll, pitch, yaw of each, in radians.
    """
    angles = []
    for rotation in rotations:
        yaw = math.atan2(rotation[1, 0], rotation[0, 0])
        c, s = math.cos(yaw), math.sin(yaw)
        first = c * rotation[0] + s * rotation[1]
        second = c * rotation[1] - s * rotation[0]
        pitch = math.atan2(-rotation[2, 0], first[0])
        roll = math.atan2(-second[2], second[1])
        angles.append((roll, pitch, yaw))
    return angles
