"""The numbers of a five-bar linkage, checked once and then immutable.

Two cranks turn about base pins on the x axis, leg 1 at (+e, 0) and leg 2 at (-e, 0); each
carries a rod, and the rods meet at the tool. u_i points along crank i, w_i along rod i from the
elbow to the tool. The plane is (x, y), angles are counter-clockwise from x.

Source: note 003; Huang et al. 2005, doi 10.1115/1.1898343.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, frozen, real_array, shaped, shown
from kinlab.errors import MechanismError

JOINTS = ("crank_1", "elbow_1", "crank_2", "elbow_2")
"""Names of the four joints of the tree that the loop is cut into."""

_PAIRS = (
    "l1", "l2", "crank_mass", "crank_com", "crank_inertia", "rod_mass", "rod_com",
    "rod_inertia", "rotor_inertia", "gear_ratio",
)  # fmt: skip
_NOT_NEGATIVE = ("crank_mass", "crank_inertia", "rod_mass", "rod_inertia", "rotor_inertia")


@dataclass(frozen=True, eq=False)
class Linkage:
    """Lengths and masses of a five-bar. Pairs are (leg 1, leg 2); one number serves both legs.

    Nothing is guessed: masses, centres and inertias that are not given are zero.

    Attributes:
        l1: crank lengths, m.
        l2: rod lengths, m.
        e: half the distance between the base pins, m; 0 puts both cranks on one axis.
        crank_mass: kg.
        crank_com: centre of mass from the crank's base pin along u, m.
        crank_inertia: about the crank's centre of mass, kg m².
        rod_mass: kg.
        rod_com: centre of mass from the elbow along w, m.
        rod_inertia: about the rod's centre of mass, kg m².
        payload: point mass at the tool, kg.
        rotor_inertia: of the motor, at the motor's own shaft, kg m².
        gear_ratio: motor turns per crank turn; reflects gear_ratio² rotor_inertia to the crank.
        gravity: acceleration of gravity in the plane, m/s², (2,); (0, 0) for a horizontal one.
        name: how messages call the linkage.
        source: where the numbers come from.

    Raises:
        MechanismError: a length that is not positive, a negative mass, a number that is not
            finite, or lengths that cannot close.
    """

    l1: ArrayLike
    l2: ArrayLike
    e: float
    crank_mass: ArrayLike = 0.0
    crank_com: ArrayLike = 0.0
    crank_inertia: ArrayLike = 0.0
    rod_mass: ArrayLike = 0.0
    rod_com: ArrayLike = 0.0
    rod_inertia: ArrayLike = 0.0
    payload: float = 0.0
    rotor_inertia: ArrayLike = 0.0
    gear_ratio: ArrayLike = 1.0
    gravity: ArrayLike = (0.0, -9.81)
    name: str = "five-bar"
    source: str = ""

    def __post_init__(self) -> None:
        for column, text in (("name", self.name), ("source", self.source)):
            if not isinstance(text, str):
                raise MechanismError(f"five-bar: {column} is {shown(text)}; it must be text")
        if not self.name.strip() or not self.name.isprintable():
            raise MechanismError(f"five-bar: name is {shown(self.name)}; it must be printable")
        for column in _PAIRS:
            object.__setattr__(self, column, frozen(self._pair(column)))
        for column in ("e", "payload"):
            value = shaped(getattr(self, column), (), f"{self.name}: {column}", MechanismError)
            object.__setattr__(self, column, float(value))
        gravity = shaped(self.gravity, (2,), f"{self.name}: gravity", MechanismError)
        object.__setattr__(self, "gravity", frozen(gravity))
        self._check_signs()
        self._check_closes()

    def _pair(self, column: str) -> Array:
        what = f"{self.name}: {column}"
        value = real_array(getattr(self, column), what, MechanismError)
        if value.shape not in ((), (2,)):
            raise MechanismError(
                f"{what} has shape {value.shape}; expected one number or a pair (leg 1, leg 2)"
            )
        return np.broadcast_to(value, (2,))

    def _check_signs(self) -> None:
        for column in ("l1", "l2", "gear_ratio"):
            for leg, value in enumerate(getattr(self, column), 1):
                if value <= 0:
                    raise MechanismError(
                        f"{self.name}: {column} of leg {leg} is {value:g}; it must be positive"
                    )
        for column in _NOT_NEGATIVE:
            for leg, value in enumerate(getattr(self, column), 1):
                if value < 0:
                    raise MechanismError(
                        f"{self.name}: {column} of leg {leg} is {value:g}; it must be >= 0"
                    )
        for column in ("e", "payload"):
            if getattr(self, column) < 0:
                raise MechanismError(
                    f"{self.name}: {column} is {getattr(self, column):g}; it must be >= 0"
                )

    def _check_closes(self) -> None:
        """Five bars close into a loop that can move iff each is shorter than the rest together."""
        (a1, b1), (a2, b2) = np.asarray(self.l1), np.asarray(self.l2)
        bars = {
            "crank 1": a1, "rod 1": a2, "crank 2": b1, "rod 2": b2, "base 2e": 2.0 * self.e,
        }  # fmt: skip
        total = sum(bars.values())
        for bar, length in bars.items():
            if length >= total - length:
                raise MechanismError(
                    f"{self.name}: the loop cannot close and move: {bar} is {length:g} m long, "
                    f"the other four bars together {total - length:g} m; it must be shorter"
                )

    @property
    def base_x(self) -> Array:
        """x of the two base pins, (2,): (+e, -e)."""
        return np.array([self.e, -self.e])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Linkage):
            return NotImplemented
        return all(
            np.array_equal(getattr(self, f.name), getattr(other, f.name)) for f in fields(Linkage)
        )

    def __hash__(self) -> int:
        return hash((self.name, self.e, self.payload, *np.asarray(self.l1), *np.asarray(self.l2)))

    def values(self) -> dict[str, Any]:
        """The constructor's arguments as plain numbers and text, pairs as lists."""
        out: dict[str, Any] = {}
        for f in fields(Linkage):
            value = getattr(self, f.name)
            out[f.name] = value.tolist() if isinstance(value, np.ndarray) else value
        return out
