"""Chains of link frames that the general formulas stand on.

Note 000 writes Craig's convention, note 002 the standard one. :func:`craig` rewrites a standard
table in Craig's, so that the recursions of note 000 run on every arm.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.notes.arm import Arm, Array, apply, cross, matrix, turn


def craig(arm: Arm) -> Arm:
    """The same arm in Craig's (modified) convention.

    Standard: Rz Tz | Tx Rx, row by row. Read with the bar moved by one half row, the same
    product is Craig's: a_{i-1} and alpha_{i-1} are those of the row before, the last row's go to
    the tool, and frame i is the one before Tx(a_i) Rx(alpha_i), on the axis of joint i. Centre
    and inertia move into that frame.
    """
    if arm.convention == "modified":
        return arm
    before = np.concatenate([[0.0], arm.a[:-1]]), np.concatenate([[0.0], arm.alpha[:-1]])
    ca, sa = np.cos(arm.alpha), np.sin(arm.alpha)
    zero, one = np.zeros(arm.n), np.ones(arm.n)
    tilt = matrix([one, zero, zero], [zero, ca, -sa], [zero, sa, ca])
    shift = np.stack([arm.a, zero, zero], axis=-1)
    last = np.eye(4)
    last[:3, :3], last[:3, 3] = tilt[-1], shift[-1]
    return replace(
        arm,
        convention="modified",
        a=before[0],
        alpha=before[1],
        com=apply(tilt, arm.com) + shift,
        inertia=tilt @ arm.inertia @ turn(tilt),
        tool=last @ arm.tool,
    )


def joint_columns(arm: Arm, q: Array) -> tuple[Array, Array]:
    """theta and d of every row at q, each (..., n)."""
    moved = arm.sign * np.asarray(q)
    theta = arm.theta + np.where(arm.prismatic, 0.0, moved)
    d = arm.d + np.where(arm.prismatic, moved, 0.0)
    return theta, d


def modified_transform(a: Any, alpha: Any, d: Any, theta: Any) -> Array:
    """000.dh: the matrix of Craig's Rx(alpha) Tx(a) Rz(theta) Tz(d)."""
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return matrix(
        [c, -s, 0.0, a],
        [s * ca, c * ca, -sa, -sa * d],
        [s * sa, c * sa, ca, ca * d],
        [0.0, 0.0, 0.0, 1.0],
    )


def standard_transform(a: Any, alpha: Any, d: Any, theta: Any) -> Array:
    """002.T: the matrix of Rz(theta) Tz(d) Tx(a) Rx(alpha)."""
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return matrix(
        [c, -s * ca, s * sa, a * c],
        [s, c * ca, -c * sa, a * s],
        [0.0, sa, ca, d],
        [0.0, 0.0, 0.0, 1.0],
    )


def link_transforms(arm: Arm, q: Array) -> Array:
    """^{i-1}T_i of every row, (..., n, 4, 4), in the table's own convention."""
    theta, d = joint_columns(arm, q)
    product = modified_transform if arm.convention == "modified" else standard_transform
    return product(arm.a, arm.alpha, d, theta)


def frames(arm: Arm, q: Array) -> Array:
    """^0T_i of every DH frame in the base, (..., n + 1, 4, 4); entry 0 is the base itself."""
    steps = link_transforms(arm, q)
    poses = [np.broadcast_to(arm.base, (*steps.shape[:-3], 4, 4))]
    for i in range(arm.n):
        poses.append(poses[-1] @ steps[..., i, :, :])
    return np.stack(poses, axis=-3)


def axes(arm: Arm, q: Array) -> tuple[Array, Array]:
    """Direction and a point of every joint axis in the base, each (..., n, 3).

    Joint i turns about z_i of its frame in Craig's convention, about z_{i-1} in the standard
    one; a joint that moves against its axis has the direction turned round.
    """
    poses = frames(arm, q)
    on_axis = poses[..., 1:, :, :] if arm.convention == "modified" else poses[..., :-1, :, :]
    return arm.sign[:, None] * on_axis[..., :3, 2], on_axis[..., :3, 3]


def geometric_jacobian(arm: Arm, q: Array, points: Array) -> Array:
    """Columns (z x (point - p), z) of a revolute and (z, 0) of a prismatic joint.

    Args:
        arm: the arm.
        q: (..., n).
        points: points of the last link in the base, (..., 3).

    Returns:
        (..., 6, n), base axes.
    """
    z, p = axes(arm, q)
    revolute = ~arm.prismatic[:, None]
    linear = np.where(revolute, cross(z, points[..., None, :] - p), z)
    angular = np.where(revolute, z, 0.0)
    return turn(np.concatenate([linear, angular], axis=-1))


def tool_pose(arm: Arm, q: Array) -> Array:
    """Pose of the tool in the base, (..., 4, 4)."""
    return frames(arm, q)[..., -1, :, :] @ arm.tool
