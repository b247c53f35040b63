"""What the general formulas stand on: the arm's numbers, its link frames, its mass matrix."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinlab.host.answers import once

# -------- The numbers of a serial arm as the hand formulas read them, and small vector
#          helpers
# Angles in radians, lengths in metres. Every helper works on the last axes and keeps leading ones.

Array = NDArray[np.float64]

Z = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, eq=False)
class Arm:
    """A DH table as plain arrays; row i of every array is joint i + 1.

    Attributes:
        name: the arm's name.
        convention: ``"standard"`` or ``"modified"``.
        prismatic: (n,) bool.
        a, alpha, d, theta: the DH columns, (n,).
        sign: +1, or -1 for a joint that moves against its z axis, (n,).
        mass: (n,) kg.
        com: centre of mass in DH frame i, (n, 3).
        inertia: about the centre, in the axes of DH frame i, (n, 3, 3).
        armature: rotor inertia at the joint, (n,).
        base, tool: (4, 4).
        gravity: in the world, (3,).
    """

    name: str
    convention: str
    prismatic: NDArray[np.bool_]
    a: Array
    alpha: Array
    d: Array
    theta: Array
    sign: Array
    mass: Array
    com: Array
    inertia: Array
    armature: Array
    base: Array
    tool: Array
    gravity: Array

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.a)


def lengths(arm: Arm) -> tuple[Any, ...]:
    """l_1 ... l_n of a planar arm: the distance from each joint to the next, then to the tip."""
    if arm.convention == "modified":
        return (*arm.a[1:], arm.tool[0, 3])
    return tuple(arm.a)


def columns(q: Array) -> Any:
    """q_1 ... q_n, each with the leading axes: ``q1, q2 = columns(q)``."""
    return np.moveaxis(np.asarray(q), -1, 0)


def vector(*entries: Any) -> Array:
    """A vector from its entries, each a number or an array of the leading axes."""
    return np.stack(np.broadcast_arrays(*entries), axis=-1)


def matrix(*rows: Any) -> Array:
    """A matrix from its rows, each a sequence of entries."""
    width = len(rows[0])
    entries = np.broadcast_arrays(*(entry for row in rows for entry in row))
    flat = np.stack(entries, axis=-1)
    return flat.reshape(*flat.shape[:-1], len(rows), width)


def apply(matrices: Any, vectors: Any) -> Array:
    """Matrix times vector on the last axes."""
    product: Array = np.einsum("...ij,...j->...i", matrices, vectors)
    return product


def transpose(matrices: Any) -> Array:
    """Transpose of the last two axes: the inverse of a rotation."""
    return np.swapaxes(matrices, -1, -2)


def cross(a: Any, b: Any) -> Array:
    """Cross product of the last axis."""
    a, b = np.asarray(a), np.asarray(b)
    return np.stack(
        [
            a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
            a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
            a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
        ],
        axis=-1,
    )


def dot(a: Any, b: Any) -> Any:
    """Scalar product of the last axis."""
    return np.sum(np.asarray(a) * np.asarray(b), axis=-1)


# -------- Chains of link frames that the general formulas stand on
# Note 000 writes Craig's convention, note 002 the standard one. :func:`craig` rewrites a standard
# table in Craig's, so that the recursions of note 000 run on every arm.


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
        inertia=tilt @ arm.inertia @ transpose(tilt),
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
    return transpose(np.concatenate([linear, angular], axis=-1))


def tool_pose(arm: Arm, q: Array) -> Array:
    """Pose of the tool in the base, (..., 4, 4)."""
    return frames(arm, q)[..., -1, :, :] @ arm.tool


# -------- The mass matrix from the link Jacobians, its derivatives, and the potential
#          energy, by hand
# Sources: note 002 sections 2 and 3; note 000, dynamics 3. Everything is in the base's axes.


class Links(NamedTuple):
    """Where the links' centres are and how they move.

    Attributes:
        centres: (..., n, 3).
        inertias: R I R^T, (..., n, 3, 3).
        linear: column j of link i's Jacobian, (..., n, n, 3), indices i, j.
        angular: the same for omega.
    """

    centres: Array
    inertias: Array
    linear: Array
    angular: Array


def centres(arm: Arm, q: Array) -> Array:
    """r_i = p_0i + R_i com_i, (..., n, 3)."""
    poses = frames(arm, q)[..., 1:, :, :]
    return poses[..., :3, 3] + apply(poses[..., :3, :3], arm.com)


def links(arm: Arm, q: Array) -> Links:
    """Centres, tensors and Jacobian columns of every link; joint j moves link i where j <= i."""
    rotations = frames(arm, q)[..., 1:, :3, :3]
    z, p = axes(arm, q)
    r = centres(arm, q)
    reach = r[..., :, None, :] - p[..., None, :, :]
    direction = np.broadcast_to(z[..., None, :, :], reach.shape)
    revolute = ~arm.prismatic[:, None]
    moved = np.tri(arm.n, dtype=bool)[..., None]
    linear = np.where(revolute, cross(direction, reach), direction)
    return Links(
        centres=r,
        inertias=rotations @ arm.inertia @ transpose(rotations),
        linear=np.where(moved, linear, 0.0),
        angular=np.where(moved & revolute, direction, 0.0),
    )


def mass_matrix(arm: Arm, q: Array) -> Array:
    """M = Σ m J^T J + Jw^T (R I R^T) Jw, and the rotors on the diagonal, (..., n, n)."""
    body = links(arm, q)
    total: Array = np.einsum("l,...lic,...ljc->...ij", arm.mass, body.linear, body.linear)
    total = total + np.einsum(
        "...lia,...lab,...ljb->...ij", body.angular, body.inertias, body.angular
    )
    return total + np.diag(arm.armature)


def mass_derivatives(arm: Arm, q: Array) -> Array:
    """dM_ij/dq_k, exactly, (..., n, n, n).

    Joint k turns whatever lies behind it: dz_j/dq_k = w_k x z_j and dp_j/dq_k = its Jacobian
    column at p_j for k < j; dr_l/dq_k is column k of link l's Jacobian; and the tensor of link l
    turns as d(R I R^T)/dq_k = W_k I - I W_k for k <= l.
    """
    derivative: Array = once(_mass_derivatives, arm, q)
    return derivative


def _mass_derivatives(arm: Arm, q: Array) -> Array:
    body = links(arm, q)
    z, p = axes(arm, q)
    revolute = ~arm.prismatic[:, None]
    spin = np.where(revolute, z, 0.0)  # w_k
    behind = np.tri(arm.n, k=-1, dtype=bool)[..., None]  # joint j lies behind joint k
    # indices j, k
    dz = np.where(behind, cross(spin[..., None, :, :], z[..., :, None, :]), 0.0)
    reach = p[..., :, None, :] - p[..., None, :, :]
    direction = np.broadcast_to(z[..., None, :, :], reach.shape)
    dp = np.where(behind, np.where(revolute, cross(direction, reach), direction), 0.0)
    # columns of link l: d(z_j x (r_l - p_j)), indices l, j, k
    turning = cross(
        dz[..., None, :, :, :], (body.centres[..., :, None, :] - p[..., None, :, :])[..., None, :]
    )
    carried = body.linear[..., :, None, :, :] - dp[..., None, :, :, :]
    moving = turning + cross(z[..., None, :, None, :], carried)
    is_revolute = ~arm.prismatic[:, None, None]
    moved = np.tri(arm.n, dtype=bool)[..., None, None]
    d_linear = np.where(moved, np.where(is_revolute, moving, dz[..., None, :, :, :]), 0.0)
    d_angular = np.where(moved & is_revolute, dz[..., None, :, :, :], 0.0)
    derivative: Any = np.einsum("l,...likc,...ljc->...ijk", arm.mass, d_linear, body.linear)
    held = apply(body.inertias[..., :, None, :, :], body.angular)  # I Jw, indices l, j
    derivative = derivative + np.einsum("...lika,...lja->...ijk", d_angular, held)
    derivative = derivative + np.swapaxes(derivative, -3, -2)
    # Jw_i^T (W_k I - I W_k) Jw_j = -(w_k x Jw_i)·I Jw_j - (I Jw_i)·(w_k x Jw_j), per link
    swing = cross(body.angular[..., None, :, :], body.angular[..., :, None, :])  # l, i, k: w_k x
    half = -np.einsum("...lika,...lja->...ijk", swing, held)
    result: Array = derivative + half + np.swapaxes(half, -3, -2)
    return result


def potential(arm: Arm, q: Array) -> Any:
    """V = -Σ m g^T r, (...)."""
    return -np.einsum("l,...lc,c->...", arm.mass, centres(arm, q), arm.gravity)


def gravity_torques(arm: Arm, q: Array) -> Array:
    """dV/dq_j = -Σ m_i g^T dr_i/dq_j, (..., n)."""
    torque: Array = -np.einsum("l,...ljc,c->...j", arm.mass, links(arm, q).linear, arm.gravity)
    return torque


def christoffel(arm: Arm, q: Array) -> Array:
    """D_ijk = ½ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i), (..., n, n, n)."""
    derivative = mass_derivatives(arm, q)
    return 0.5 * (derivative + np.swapaxes(derivative, -1, -2) - np.moveaxis(derivative, -1, -3))
