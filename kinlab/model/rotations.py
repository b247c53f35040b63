"""Rotations: about an axis, along a rotation vector, and as URDF writes them (roll, pitch, yaw)."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

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


def about_axis(axis: int, angle: ArrayLike) -> Array:
    """Rotations about x, y or z (axis 0, 1, 2) by angles (...), shape (..., 3, 3)."""
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.zeros((*np.shape(angle), 3, 3))
    out[..., axis, axis] = 1.0
    out[..., i, i] = out[..., j, j] = c
    out[..., j, i], out[..., i, j] = s, -s
    return out


def rotations_along(vector: Array, share: ArrayLike = 1.0) -> Array:
    """exp([vector] share), shape (..., 3, 3) for shares (...), by Rodrigues; vector (3,), rad."""
    angle = float(np.linalg.norm(vector))
    x, y, z = vector / angle if angle > 0.0 else vector
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    phi = angle * np.asarray(share, dtype=np.float64)[..., np.newaxis, np.newaxis]
    out: Array = np.eye(3) + np.sin(phi) * cross + 2.0 * np.sin(0.5 * phi) ** 2 * (cross @ cross)
    return out


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
