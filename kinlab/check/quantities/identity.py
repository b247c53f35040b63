"""Identities of vectors and rotations: quantities that need no mechanism.

Their engine side is an independent computation, by Pinocchio's spatial algebra or LAPACK.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.check.quantities.quantity import Domain
from kinlab.errors import NameUnknownError

POINTS = 6
"""Point masses of a sampled body."""


def _rotation(count: int, rng: np.random.Generator) -> Array:
    turned = rng.standard_normal((count, 4))
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    return np.stack([pin.Quaternion(*quaternion).toRotationMatrix() for quaternion in turned])


def _uniform(low: float, high: float, *shape: int) -> Callable[[int, np.random.Generator], Array]:
    return lambda count, rng: rng.uniform(low, high, (count, *shape))


DRAWS: dict[str, Callable[[int, np.random.Generator], Array]] = {
    "rotation": _rotation,
    "point": _uniform(-2.0, 2.0, 3),
    "other": _uniform(-2.0, 2.0, 3),
    "points": _uniform(-1.0, 1.0, POINTS, 3),
    "masses": _uniform(0.1, 3.0, POINTS),
    "omega": _uniform(-3.0, 3.0, 3),
    "theta": _uniform(-np.pi, np.pi),
    "alpha": _uniform(-np.pi, np.pi),
    "d": _uniform(-1.0, 1.0),
    "a": _uniform(-1.0, 1.0),
}


def _sample(
    mechanism: Any, arguments: tuple[str, ...], count: int, rng: np.random.Generator
) -> tuple[Array, ...]:
    del mechanism
    return tuple(DRAWS[name](count, rng) for name in arguments)


def _load(name: Any) -> None:
    if name != "identity":
        raise NameUnknownError(f"{name!r}: an identity has no mechanism; give 'identity'")


IDENTITY = Domain(
    "identity", _load, lambda mechanism: "identity", lambda mechanism: None, lambda n: (n,), _sample
)


def elementary(mechanism: None, theta: Array, d: Array, a: Array, alpha: Array) -> Array:
    """Rz(theta), Tz(d), Tx(a), Rx(alpha) by Pinocchio's SE3, (N, 4, 4, 4)."""
    del mechanism
    still = np.zeros(3)
    return np.stack(
        [
            [
                pin.SE3(pin.utils.rotate("z", float(t)), still).homogeneous,
                pin.SE3(np.eye(3), np.array([0.0, 0.0, dd])).homogeneous,
                pin.SE3(np.eye(3), np.array([aa, 0.0, 0.0])).homogeneous,
                pin.SE3(pin.utils.rotate("x", float(al)), still).homogeneous,
            ]
            for t, dd, aa, al in zip(theta, d, a, alpha, strict=True)
        ]
    )


def point_inertia(mechanism: None, points: Array, masses: Array) -> Array:
    """Inertia tensor of point masses about the origin, by adding up Pinocchio's inertias."""
    del mechanism
    tensors = []
    for body, weights in zip(points, masses, strict=True):
        total = pin.Inertia.Zero()
        for place, mass in zip(body, weights, strict=True):
            total += pin.Inertia(float(mass), place, np.zeros((3, 3)))
        tensors.append(total.matrix()[3:, 3:])
    return np.stack(tensors)


def turning_energy(mechanism: None, points: Array, masses: Array, omega: Array) -> Any:
    """½ Σ m |omega x r|², point by point."""
    del mechanism
    speeds = np.cross(omega[:, None, :], points)
    return 0.5 * np.einsum("ap,api,api->a", masses, speeds, speeds)


def _length(mechanism: None, rotation: Array, point: Array) -> Any:
    turned = np.einsum("aij,aj->ai", rotation, point)
    return np.sqrt(np.einsum("ai,ai->a", turned, turned))


def _cross_norm(mechanism: None, point: Array, other: Array) -> Any:
    product = np.stack([pin.skew(p) @ o for p, o in zip(point, other, strict=True)])
    return np.einsum("ai,ai->a", product, product)


_ROWS: tuple[tuple[str, str, Any, str], ...] = (
    ("rotation_inverse", "rotation", lambda _, r: np.linalg.inv(r), "R^-1 by elimination, (3, 3)"),
    ("rotation_determinant", "rotation", lambda _, r: np.linalg.det(r), "det R, a number"),
    ("rotated_length", "rotation point", _length, "|R p|, a number"),
    ("elementary", "theta d a alpha", elementary, "the four elementary matrices, (4, 4, 4)"),
    ("point_inertia", "points masses", point_inertia, "tensor of point masses, (3, 3)"),
    ("turning_energy", "points masses omega", turning_energy, "½ Σ m |omega x r|², a number"),
    ("cross_norm_squared", "point other", _cross_norm, "|a x b|², a number"),
)

QUANTITIES = tuple(IDENTITY.quantity(*row) for row in _ROWS)
