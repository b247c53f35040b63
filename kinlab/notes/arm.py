"""The numbers of a serial arm as the hand formulas read them, and small vector helpers.

Angles in radians, lengths in metres. Every helper works on the last axes and keeps leading ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

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


def turn(matrices: Any) -> Array:
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
