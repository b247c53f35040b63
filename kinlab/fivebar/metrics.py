"""How good a pose of a five-bar is: determinant, condition, angles, stiffness.

All of them follow from J of theta_dot = J v. Singular values come from the two-by-two formula
sigma = ½ |hypot(a + d, b - c) ± hypot(a - d, b + c)|, never from sqrt(det(J J^T)).

Sources: note 003; Huang et al. 2005; singularity types: Gosselin & Angeles 1990
(doi 10.1109/70.56660).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.errors import OptionError
from kinlab.fivebar.geometry import rate_matrix
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.pose import HANGING, Mode, OnUnreachable, Pose, cross, solve_pose


def determinant(
    linkage: Linkage,
    xy: ArrayLike,
    mode: Mode = HANGING,
    on_unreachable: OnUnreachable = "raise",
) -> Array:
    """det J = (w_1 x w_2) / (l1_1 l1_2 (u_1 x w_1)(u_2 x w_2)), () or (N,), 1/m².

    Zero at type II, infinite at type I.

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type I.
    """
    pose = solve_pose(linkage, xy, mode, on_unreachable, regular="I")
    return pose.give(pose.rods / np.prod(np.asarray(linkage.l1) * pose.sine, axis=1))


def singular_values(
    linkage: Linkage,
    xy: ArrayLike,
    mode: Mode = HANGING,
    on_unreachable: OnUnreachable = "raise",
) -> Array:
    """Largest and smallest singular value of J, (2,) or (N, 2), rad/m.

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type I.
    """
    pose = solve_pose(linkage, xy, mode, on_unreachable, regular="I")
    return pose.give(_sigma(linkage, pose))


def _sigma(linkage: Linkage, pose: Pose) -> Array:
    jac = rate_matrix(linkage, pose)
    a, b, c, d = jac[:, 0, 0], jac[:, 0, 1], jac[:, 1, 0], jac[:, 1, 1]
    rotation, mirror = np.hypot(a + d, b - c), np.hypot(a - d, b + c)
    return 0.5 * np.stack([rotation + mirror, np.abs(rotation - mirror)], axis=1)


def condition_number(
    linkage: Linkage,
    xy: ArrayLike,
    mode: Mode = HANGING,
    on_unreachable: OnUnreachable = "raise",
) -> Array:
    """kappa = sigma_max / sigma_min of J, () or (N,); 1 at an isotropic pose.

    On the axis of a symmetric linkage it is max(tan(gamma/2), cot(gamma/2)), gamma the angle
    between the rods.

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type I or type II.
    """
    pose = solve_pose(linkage, xy, mode, on_unreachable, regular="I II")
    sigma = _sigma(linkage, pose)
    return pose.give(sigma[:, 0] / sigma[:, 1])


def passive_angles(linkage: Linkage, xy: ArrayLike, mode: Mode = HANGING) -> Array:
    """psi_i, from crank to rod at the elbows, (2,) or (N, 2), rad; its sign is the mode's.

    Raises:
        UnreachableError: a point out of reach.
    """
    pose = solve_pose(linkage, xy, mode)
    return pose.give(np.arctan2(pose.sine, np.einsum("nij,nij->ni", pose.u, pose.w)))


def pressure_angles(linkage: Linkage, xy: ArrayLike, mode: Mode = HANGING) -> Array:
    """Between each rod and the direction in which its elbow moves, (2,) or (N, 2), rad.

    0 where crank and rod are at right angles, pi/2 at type I.

    Raises:
        UnreachableError: a point out of reach.
    """
    pose = solve_pose(linkage, xy, mode)
    along = np.abs(np.einsum("nij,nij->ni", pose.u, pose.w))
    return pose.give(np.arctan2(along, np.abs(pose.sine)))


def transmission_angle(linkage: Linkage, xy: ArrayLike, mode: Mode = HANGING) -> Array:
    """gamma between the two rods at the tool, () or (N,), rad in [0, pi].

    pi/2 is best; 0 (folded) and pi (stretched) are type II.

    Raises:
        UnreachableError: a point out of reach.
    """
    pose = solve_pose(linkage, xy, mode)
    along = np.einsum("nj,nj->n", pose.w[:, 0], pose.w[:, 1])
    return pose.give(np.arctan2(np.abs(cross(pose.w[:, 0], pose.w[:, 1])), along))


def stiffness(linkage: Linkage, xy: ArrayLike, k: ArrayLike, mode: Mode = HANGING) -> Array:
    """K = J^T diag(k) J: the tool's stiffness from that of the cranks, the bars being rigid.

    Args:
        linkage: the five-bar.
        xy: tool, (2,) or (N, 2), m.
        k: stiffness at the cranks, one number or a pair, N m/rad.
        mode: signs of u_i x w_i.

    Returns:
        (2, 2) or (N, 2, 2), symmetric, N/m.

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type I, where the tool cannot give way along the leg.
        OptionError: a stiffness that is not positive.
    """
    springs = real_array(k, f"{linkage.name}: k")
    if springs.shape not in ((), (2,)) or np.any(springs <= 0):
        raise OptionError(f"{linkage.name}: k must be one positive number or a pair of them")
    pose = solve_pose(linkage, xy, mode, regular="I")
    jac = rate_matrix(linkage, pose)
    return pose.give(jac.swapaxes(1, 2) @ (np.broadcast_to(springs, (2,))[:, None] * jac))
