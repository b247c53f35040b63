"""The numbers of a five-bar as the hand formulas of note 003 read them, and small helpers.

Points and vectors are of the plane; arrays have shape (..., 2), and with a leg axis
(..., 2 legs, 2). Leg 1 is based at (+e, 0), leg 2 at (-e, 0).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

S = np.array([1.0, -1.0])
"""s: on which side each leg's base pin lies."""

E1 = np.array([1.0, 0.0])
E2 = np.array([0.0, 1.0])
H = np.array([[0.0, 1.0], [-1.0, 0.0]])
"""u^T H w = k·(u x w)."""


@dataclass(frozen=True, eq=False)
class Loop:
    """A five-bar as plain numbers; pairs are (leg 1, leg 2).

    Attributes:
        name: the linkage's name.
        l1, l2: cranks and rods, (2,), m. e: half the distance of the base pins, m.
        crank: m_1, (2,), kg. crank_com: c_1, (2,), m. crank_inertia: I_1 about it, (2,), kg m².
        rotor: j² I_M, (2,), kg m².
        rod: m_d, (2,), kg. rod_com: from the elbow, (2,), m. rod_inertia: I_c, (2,), kg m².
        payload: m, kg.
        g: acceleration of gravity, along -y, m/s².
    """

    name: str
    l1: Array
    l2: Array
    e: float
    crank: Array
    crank_com: Array
    crank_inertia: Array
    rotor: Array
    rod: Array
    rod_com: Array
    rod_inertia: Array
    payload: float
    g: float

    @property
    def arm(self) -> Array:
        """I_A: a crank about its base pin, with its rotor, (2,)."""
        total: Array = self.crank_inertia + self.crank * self.crank_com**2 + self.rotor
        return total


def legs(value: Array) -> Array:
    """A vector of the tool, once for each leg: (..., 2) to (..., 1, 2)."""
    return value[..., None, :]


def dot(a: Array, b: Array) -> Any:
    """Along the last axis."""
    return np.sum(a * b, axis=-1)


def triple(u: Array, w: Array) -> Any:
    """u^T H w."""
    return np.einsum("...i,ij,...j->...", u, H, w)


def times(matrix: Array, vector: Array) -> Any:
    """Matrix times vector, keeping leading axes."""
    return np.einsum("...ij,...j->...i", matrix, vector)


def inverse_transpose(matrix: Array) -> Any:
    """J^-T."""
    return np.swapaxes(np.linalg.inv(matrix), -1, -2)
