"""The mass matrix from the link Jacobians, its derivatives, and the potential energy, by hand.

Sources: note 002 sections 2 and 3; note 000, dynamics 3. Everything is in the base's axes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from kinlab.notes.arm import Arm, Array, apply, cross, turn
from kinlab.notes.frames import axes, frames


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
        inertias=rotations @ arm.inertia @ turn(rotations),
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
    turning = cross(dz[..., None, :, :, :], (body.centres[..., :, None, :]
                    - p[..., None, :, :])[..., None, :])  # fmt: skip
    carried = body.linear[..., :, None, :, :] - dp[..., None, :, :, :]
    moving = turning + cross(z[..., None, :, None, :], carried)
    is_revolute = ~arm.prismatic[:, None, None]
    moved = np.tri(arm.n, dtype=bool)[..., None, None]
    d_linear = np.where(moved, np.where(is_revolute, moving, dz[..., None, :, :, :]), 0.0)
    d_angular = np.where(moved & is_revolute, dz[..., None, :, :, :], 0.0)
    slope: Any = np.einsum("l,...likc,...ljc->...ijk", arm.mass, d_linear, body.linear)
    held = apply(body.inertias[..., :, None, :, :], body.angular)  # I Jw, indices l, j
    slope = slope + np.einsum("...lika,...lja->...ijk", d_angular, held)
    slope = slope + np.swapaxes(slope, -3, -2)
    # Jw_i^T (W_k I - I W_k) Jw_j = -(w_k x Jw_i)·I Jw_j - (I Jw_i)·(w_k x Jw_j), per link
    swing = cross(body.angular[..., None, :, :], body.angular[..., :, None, :])  # l, i, k: w_k x
    half = -np.einsum("...lika,...lja->...ijk", swing, held)
    result: Array = slope + half + np.swapaxes(half, -3, -2)
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
    slope = mass_derivatives(arm, q)
    return 0.5 * (slope + np.swapaxes(slope, -1, -2) - np.moveaxis(slope, -1, -3))
