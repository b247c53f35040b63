"""Isotropic poses of a five-bar: those where the tool moves equally well in every direction.

J J^T = c I needs rods at right angles and rows of one length, l1_1 |u_1 x w_1| = l1_2 |u_2 x w_2|.
On the axis of a symmetric linkage the second holds by itself. With zero pressure angles as well
the pose is fully isotropic; that exists iff e = (l2 - l1)/√2, at (0, ∓(l1 + l2)/√2).

There the lengths of the rows are stationary, since each sine is at its largest, and so is every
measure made of them, kappa included: it cannot tell where the pose is. For equal cranks the
condition is sin² psi_1 - sin² psi_2 = sin(psi_1 + psi_2) sin(psi_1 - psi_2) = 0, and each factor
alone crosses zero with a slope. So the factors are solved one by one.

Sources: note 000 (000.iso); Huang et al. 2005, doi 10.1115/1.1898343.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array, first_largest, smallest_first
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.loci import grid
from kinlab.fivebar.metrics import condition_number, pressure_angles, singular_values
from kinlab.fivebar.pose import HANGING, Mode, solve_pose

_STEPS, _NEWTON_STEPS = 60, 30
_SAME_PLACE = 3e-3
"""Two answers closer than this part of the linkage's size are one. At a fully isotropic pose
one factor's curve crosses that of the right angles, which gives the place to rounding; the other's
touches it, and descent along that one ends anywhere within a few 1e-4."""
_EQUAL_CRANKS = 1e-12
"""Relative difference of the cranks below which they are equal."""


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
    linkage: Linkage, mode: Mode = HANGING, resolution: int = 41
) -> list[IsotropicPose]:
    """Finds the isotropic poses of one working mode by descent from a grid of starts.

    With both cranks on one axis (e = 0) each pose is one of a whole circle; the one straight
    below is returned.

    Args:
        linkage: the five-bar.
        mode: signs of u_i x w_i.
        resolution: starts along the longer side of the workspace.

    Returns:
        Poses with kappa = 1 to 1e-9, from the lowest up; empty if there are none.

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
        near = np.linalg.norm(points - points[0], axis=1) <= _SAME_PLACE * size
        places.append(points[near][first_largest(sharpness[near])])
        points, sharpness = points[~near], sharpness[~near]
    if not places:
        return []
    ranked = np.array(places)
    for column in (0, 1):  # by y, those of one height by x
        ranked = ranked[smallest_first(ranked[:, column])]
    return [_describe(linkage, point, mode) for point in ranked]


def _factors(linkage: Linkage) -> tuple[int, ...]:
    """Which conditions stand for rows of one length: two factors, or for unequal cranks one, 0."""
    first, second = np.asarray(linkage.l1, dtype=float).tolist()
    return (1, -1) if abs(first - second) <= _EQUAL_CRANKS * (first + second) else (0,)


def _solved(
    linkage: Linkage, points: Array, mode: Mode, size: float, factor: int
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
    _, slope = _conditions(linkage, points, mode, 1e-6 * size, factor)
    sharpness = np.asarray(np.linalg.svd(size * slope, compute_uv=False)[:, -1], dtype=float)
    return points, sharpness


def _descend(linkage: Linkage, points: Array, mode: Mode, size: float, factor: int) -> Array:
    """Levenberg-Marquardt on the two conditions from all points at once."""
    damping = np.full(len(points), 1e-3)
    value, slope = _conditions(linkage, points, mode, 1e-6 * size, factor)
    slope = slope * size  # steps in parts of the size
    for _ in range(_STEPS):
        normal = slope.swapaxes(1, 2) @ slope + damping[:, None, None] * np.eye(2)
        pull = np.einsum("nji,nj->ni", slope, value)
        step = np.linalg.solve(normal, -pull[..., None])[..., 0]
        step *= np.minimum(1.0, 0.05 / np.maximum(np.linalg.norm(step, axis=1), 1e-300))[:, None]
        trial = points + size * step
        inside = solve_pose(linkage, trial, mode, "mask", regular="I II").ok
        trial = np.where(inside[:, None], trial, points)
        new_value, new_slope = _conditions(linkage, trial, mode, 1e-6 * size, factor)
        better = inside & (np.sum(new_value**2, axis=1) < np.sum(value**2, axis=1))
        points = np.where(better[:, None], trial, points)
        value = np.where(better[:, None], new_value, value)
        slope = np.where(better[:, None, None], size * new_slope, slope)
        damping = np.clip(np.where(better, 0.1 * damping, 10.0 * damping), 1e-14, 1e6)
    return points


def _newton(linkage: Linkage, points: Array, mode: Mode, size: float, factor: int) -> Array:
    """Newton by pseudo-inverse; points that leave the workspace are dropped."""
    for _ in range(_NEWTON_STEPS):
        value, slope = _conditions(linkage, points, mode, 1e-6 * size, factor)
        points = points - np.einsum("nij,nj->ni", np.linalg.pinv(slope, rcond=1e-7), value)
        points = points[solve_pose(linkage, points, mode, "mask", regular="I II").ok]
    return points


def _conditions(
    linkage: Linkage, points: Array, mode: Mode, h: float, factor: int
) -> tuple[Array, Array]:
    """w_1·w_2 and what makes the rows equally long, with central differences by x and y.

    The second is sin(psi_1 ± psi_2) for the factors 1 and -1 of equal cranks, and the relative
    difference of the rows' lengths for 0.
    """

    def value(at: Array) -> Array:
        pose = solve_pose(linkage, at, mode, "mask")
        right = np.einsum("nj,nj->n", pose.w[:, 0], pose.w[:, 1])
        if factor:
            cosine = np.einsum("nij,nij->ni", pose.u, pose.w)
            turned = pose.sine[:, 0] * cosine[:, 1] + factor * cosine[:, 0] * pose.sine[:, 1]
            return np.stack([right, turned], axis=1)
        reach = np.asarray(linkage.l1) * np.abs(pose.sine)
        return np.stack([right, (reach[:, 0] - reach[:, 1]) / reach.sum(axis=1)], axis=1)

    slopes = [(value(points + s) - value(points - s)) / (2.0 * h) for s in h * np.eye(2)]
    return value(points), np.stack(slopes, axis=2)


def _describe(linkage: Linkage, point: Array, mode: Mode) -> IsotropicPose:
    pressure = pressure_angles(linkage, point, mode)
    return IsotropicPose(
        (float(point[0]), float(point[1])),
        (int(mode[0]), int(mode[1])),
        float(condition_number(linkage, point, mode)),
        float(singular_values(linkage, point, mode).mean()),
        (float(pressure[0]), float(pressure[1])),
    )
