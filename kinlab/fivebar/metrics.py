"""How good a pose of a five-bar is: determinant, condition, angles, stiffness, isotropy.

All of them follow from J of theta_dot = J v. Singular values come from the two-by-two formula
sigma = ½ |hypot(a + d, b - c) ± hypot(a - d, b + c)|, never from sqrt(det(J J^T)).

Sources: note 003; Huang et al. 2005; singularity types: Gosselin & Angeles 1990
(doi 10.1109/70.56660).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, first_largest, real_array, smallest_first
from kinlab.errors import OptionError
from kinlab.fivebar.arguments import HANGING, Mode, OnUnreachable, cross
from kinlab.fivebar.geometry import Pose, grid, rate_matrix, solve_pose
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar


def determinant(
    linkage: FiveBar,
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
    return pose.restore(pose.rods / np.prod(linkage.l1 * pose.sine, axis=1))


def singular_values(
    linkage: FiveBar,
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
    return pose.restore(sigma(linkage, pose))


def sigma(linkage: FiveBar, pose: Pose) -> Array:
    """The formula of :func:`singular_values` for solved poses, (N, 2)."""
    jac = rate_matrix(linkage, pose)
    a, b, c, d = jac[:, 0, 0], jac[:, 0, 1], jac[:, 1, 0], jac[:, 1, 1]
    rotation, mirror = np.hypot(a + d, b - c), np.hypot(a - d, b + c)
    return 0.5 * np.stack([rotation + mirror, np.abs(rotation - mirror)], axis=1)


def condition_number(
    linkage: FiveBar,
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
    both = sigma(linkage, pose)
    return pose.restore(both[:, 0] / both[:, 1])


def passive_angles(linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING) -> Array:
    """psi_i, from crank to rod at the elbows, (2,) or (N, 2), rad; its sign is the mode's.

    Raises:
        UnreachableError: a point out of reach.
    """
    pose = solve_pose(linkage, xy, mode)
    return pose.restore(np.arctan2(pose.sine, np.einsum("nij,nij->ni", pose.u, pose.w)))


def pressure_angles(linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING) -> Array:
    """Between each rod and the direction in which its elbow moves, (2,) or (N, 2), rad.

    0 where crank and rod are at right angles, pi/2 at type I.

    Raises:
        UnreachableError: a point out of reach.
    """
    pose = solve_pose(linkage, xy, mode)
    along = np.abs(np.einsum("nij,nij->ni", pose.u, pose.w))
    return pose.restore(np.arctan2(along, np.abs(pose.sine)))


def transmission_angle(linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING) -> Array:
    """gamma between the two rods at the tool, () or (N,), rad in [0, pi].

    pi/2 is best; 0 (folded) and pi (stretched) are type II.

    Raises:
        UnreachableError: a point out of reach.
    """
    pose = solve_pose(linkage, xy, mode)
    along = np.einsum("nj,nj->n", pose.w[:, 0], pose.w[:, 1])
    return pose.restore(np.arctan2(np.abs(cross(pose.w[:, 0], pose.w[:, 1])), along))


def stiffness(linkage: FiveBar, xy: ArrayLike, k: ArrayLike, mode: Mode = HANGING) -> Array:
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
    return pose.restore(jac.swapaxes(1, 2) @ (np.broadcast_to(springs, (2,))[:, None] * jac))


# -------- Isotropic poses
# J J^T = c I needs rods at right angles and rows of one length,
# l1_1 |u_1 x w_1| = l1_2 |u_2 x w_2|. On the axis of a symmetric linkage the second holds by
# itself. With zero pressure angles as well the pose is fully isotropic; that exists iff
# e = (l2 - l1)/√2, at (0, ∓(l1 + l2)/√2).
#
# There the lengths of the rows are stationary, since each sine is at its largest, and so is every
# measure made of them, kappa included: it cannot tell where the pose is. For equal cranks the
# condition is sin² psi_1 - sin² psi_2 = sin(psi_1 + psi_2) sin(psi_1 - psi_2) = 0, and each factor
# alone crosses zero with a slope. So the factors are solved one by one.
#
# Sources: note 000 (000.iso); Huang et al. 2005, doi 10.1115/1.1898343.
_DESCENT_STEPS, _NEWTON_STEPS = 60, 30


@dataclass(frozen=True)
class IsotropicPose:
    """One isotropic pose.

    Attributes:
        xy: tool, m.
        mode: working mode.
        condition: kappa of J there, as measured.
        rate: the common singular value of J, rad/m.
        pressure: pressure angles, rad; both zero at a fully isotropic pose.
    """

    xy: tuple[float, float]
    mode: tuple[int, int]
    condition: float
    rate: float
    pressure: tuple[float, float]


def isotropic_poses(
    linkage: FiveBar, mode: Mode = HANGING, resolution: int = 41
) -> list[IsotropicPose]:
    """Finds the isotropic poses of one working mode by descent from a grid of starts.

    With both cranks on one axis (e = 0) each pose is one of a whole circle; the one straight
    below is returned.

    Args:
        linkage: the five-bar.
        mode: signs of u_i x w_i.
        resolution: starts along the longer side of the workspace.

    Returns:
        Poses with kappa = 1 to 1e-9, from the lowest up; empty if none was found.

    Raises:
        OptionError: a mode that does not exist.
    """
    _, _, points = grid(linkage, resolution)
    points = points[solve_pose(linkage, points, mode, "mask", regular="I II").ok]
    size = float(np.sum(linkage.l1) + np.sum(linkage.l2))
    found, sharp = zip(
        *(_solved(linkage, points, mode, size, factor) for factor in _factors(linkage)), strict=True
    )
    points, sharpness = np.concatenate(found), np.concatenate(sharp)
    if linkage.e == 0.0:
        points = np.stack([np.zeros(len(points)), -np.hypot(points[:, 0], points[:, 1])], axis=1)
    places = []
    while len(points):
        near = np.linalg.norm(points - points[0], axis=1) <= TOLERANCES.same_pose_of_fivebar * size
        places.append(points[near][first_largest(sharpness[near])])
        points, sharpness = points[~near], sharpness[~near]
    if not places:
        return []
    ranked = np.array(places)
    for column in (0, 1):  # by y, those of one height by x
        ranked = ranked[smallest_first(ranked[:, column])]
    return [_describe(linkage, point, mode) for point in ranked]


def _factors(linkage: FiveBar) -> tuple[int, ...]:
    """Which conditions stand for rows of one length: two factors, or for unequal cranks one, 0."""
    first, second = linkage.l1.tolist()
    return (1, -1) if abs(first - second) <= TOLERANCES.equal_cranks * (first + second) else (0,)


def _solved(
    linkage: FiveBar, points: Array, mode: Mode, size: float, factor: int
) -> tuple[Array, Array]:
    """Isotropic poses reached from the points, and how sharply the conditions place each.

    Returns:
        Points, (M, 2), and the smaller singular value of the conditions' slope there, (M,), of
        the two conditions by parts of the size.
    """
    points = _descend(linkage, points, mode, size, factor)
    # descent creeps along a curved, nearly flat valley; Newton jumps
    jumped = _newton(linkage, points, mode, size, factor)
    points = np.concatenate([points, jumped])
    points = points[condition_number(linkage, points, mode) - 1.0 < 1e-9]
    _, derivative = _conditions(linkage, points, mode, 1e-6 * size, factor)
    sharpness = np.asarray(np.linalg.svd(size * derivative, compute_uv=False)[:, -1], dtype=float)
    return points, sharpness


def _descend(linkage: FiveBar, points: Array, mode: Mode, size: float, factor: int) -> Array:
    """Levenberg-Marquardt on the two conditions from all points at once."""
    damping = np.full(len(points), 1e-3)
    value, derivative = _conditions(linkage, points, mode, 1e-6 * size, factor)
    derivative = derivative * size  # steps in parts of the size
    for _ in range(_DESCENT_STEPS):
        normal = derivative.swapaxes(1, 2) @ derivative + damping[:, None, None] * np.eye(2)
        gradient = np.einsum("nji,nj->ni", derivative, value)
        step = np.linalg.solve(normal, -gradient[..., None])[..., 0]
        step *= np.minimum(1.0, 0.05 / np.maximum(np.linalg.norm(step, axis=1), 1e-300))[:, None]
        trial = points + size * step
        inside = solve_pose(linkage, trial, mode, "mask", regular="I II").ok
        trial = np.where(inside[:, None], trial, points)
        new_value, new_derivative = _conditions(linkage, trial, mode, 1e-6 * size, factor)
        better = inside & (np.sum(new_value**2, axis=1) < np.sum(value**2, axis=1))
        points = np.where(better[:, None], trial, points)
        value = np.where(better[:, None], new_value, value)
        derivative = np.where(better[:, None, None], size * new_derivative, derivative)
        damping = np.clip(np.where(better, 0.1 * damping, 10.0 * damping), 1e-14, 1e6)
    return points


def _newton(linkage: FiveBar, points: Array, mode: Mode, size: float, factor: int) -> Array:
    """Newton by pseudo-inverse; points that leave the workspace are dropped."""
    for _ in range(_NEWTON_STEPS):
        value, derivative = _conditions(linkage, points, mode, 1e-6 * size, factor)
        points = points - np.einsum("nij,nj->ni", np.linalg.pinv(derivative, rcond=1e-7), value)
        points = points[solve_pose(linkage, points, mode, "mask", regular="I II").ok]
    return points


def _conditions(
    linkage: FiveBar, points: Array, mode: Mode, h: float, factor: int
) -> tuple[Array, Array]:
    """w_1·w_2 and what makes the rows equally long, with central differences by x and y.

    The second is sin(psi_1 ± psi_2) for the factors 1 and -1 of equal cranks, and the relative
    difference of the rows' lengths for 0.
    """

    def value(at: Array) -> Array:
        pose = solve_pose(linkage, at, mode, "mask")
        square = np.einsum("nj,nj->n", pose.w[:, 0], pose.w[:, 1])
        if factor:
            cosine = np.einsum("nij,nij->ni", pose.u, pose.w)
            factored = pose.sine[:, 0] * cosine[:, 1] + factor * cosine[:, 0] * pose.sine[:, 1]
            return np.stack([square, factored], axis=1)
        reach = linkage.l1 * np.abs(pose.sine)
        return np.stack([square, (reach[:, 0] - reach[:, 1]) / reach.sum(axis=1)], axis=1)

    # one call for all: what a call costs beside its rows is most of what few rows cost
    right, up = h * np.eye(2)
    around = np.stack([points, points + right, points - right, points + up, points - up])
    here, east, west, north, south = value(around.reshape(-1, 2)).reshape(around.shape)
    return here, np.stack([(east - west) / (2.0 * h), (north - south) / (2.0 * h)], axis=2)


def _describe(linkage: FiveBar, point: Array, mode: Mode) -> IsotropicPose:
    pressure = pressure_angles(linkage, point, mode)
    return IsotropicPose(
        (float(point[0]), float(point[1])),
        (int(mode[0]), int(mode[1])),
        float(condition_number(linkage, point, mode)),
        float(singular_values(linkage, point, mode).mean()),
        (float(pressure[0]), float(pressure[1])),
    )
