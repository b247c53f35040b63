"""One row of a DH table: convention, geometry, limits, inertia, and what an inertia can be."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from enum import StrEnum
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, frozen, set_fields, shaped, shown
from kinlab.errors import TableError
from kinlab.tolerances import TOLERANCES

# -------- The two Denavit-Hartenberg conventions. Every table states its own; there is no
#          default


class Convention(StrEnum):
    """Which of the two DH conventions a table is written in.

    STANDARD: T_i = Rz(theta_i) Tz(d_i) Tx(a_i) Rx(alpha_i); frame i at the far end of link i.
    MODIFIED: T_i = Rx(alpha_{i-1}) Tx(a_{i-1}) Rz(theta_i) Tz(d_i); frame i on joint axis i.
        The row of link i holds alpha_{i-1} and a_{i-1}, as Craig prints it.
    """

    STANDARD = "standard"
    MODIFIED = "modified"


def read_convention(value: object, place: str) -> Convention:
    """Reads a convention; there is no default.

    Raises:
        TableError: missing or unknown, with ``place`` in front.
    """
    choices = 'choose "standard" or "modified"'
    if value is None or (isinstance(value, str) and not value):
        raise TableError(f"{place}: convention is missing; {choices}")
    if isinstance(value, str) and value in tuple(Convention):
        return Convention(value)
    raise TableError(f"{place}: convention {shown(value)} is unknown; {choices}")


# -------- What an inertia tensor can be


def check_inertia(inertia: Array, place: str, error: type[Exception]) -> None:
    """Refuses a tensor that no distribution of mass can have.

    Args:
        inertia: (3, 3) about the centre of mass, kg m².
        place: what to put in front of the message.
        error: the class to raise.

    Raises:
        Exception: (the class given) not symmetric, negative, or I1 + I2 < I3 for the
            principal moments (the triangle inequality).
    """
    scale = max(float(np.max(np.abs(inertia), initial=0.0)), TOLERANCES.inertia_floor)
    skew = float(np.max(np.abs(inertia - inertia.T)))
    if skew > TOLERANCES.inertia_symmetry * scale:
        raise error(f"{place}: inertia is not symmetric (off by {skew:.3g} kg m^2)")
    principal = np.linalg.eigvalsh(0.5 * (inertia + inertia.T))
    allowance = TOLERANCES.inertia_triangle * scale
    if principal[0] < -allowance:
        raise error(
            f"{place}: inertia is not positive (a principal moment is {principal[0]:.3g} kg m^2)"
        )
    if principal[0] + principal[1] < principal[2] - allowance:
        raise error(
            f"{place}: inertia breaks the triangle inequality: principal moments "
            f"{principal[0]:.4g} + {principal[1]:.4g} < {principal[2]:.4g} kg m^2"
        )


# -------- One row of a DH table: geometry, limits and inertia of a link and its joint

_GEOMETRY = ("a", "alpha", "d", "theta")
_FRICTION = ("viscous_friction", "coulomb_friction")
_NUMBERS = (*_GEOMETRY, "lower", "upper", "velocity", "effort", "mass", "armature", *_FRICTION)


@dataclass(frozen=True, eq=False)
class DHLink:
    """One row of a DH table with the link's limits and inertia.

    Attributes:
        joint: ``"revolute"`` or ``"prismatic"``.
        a: length along x, metres (modified: a_{i-1}).
        alpha: twist about x, radians (modified: alpha_{i-1}).
        d: offset along z, metres; for a prismatic joint the constant added to q.
        theta: angle about z, radians; for a revolute joint the constant added to q.
        flip: the joint turns or slides against z: q enters with a minus sign.
        lower, upper: limits of q, radians or metres. Not stated: one turn (±pi), or ±1 m.
        velocity: limit, rad/s or m/s.
        effort: limit, N m or N.
        mass: kg.
        com: centre of mass in DH frame i, metres, shape (3,).
        inertia: tensor about the centre of mass with the axes of DH frame i, kg m², (3, 3).
        armature: rotor inertia reflected to the joint, kg m² or kg; adds to M_ii.
        viscous_friction: torque per speed that the joint's bearings take, N m s/rad or N s/m: the
            ``damping`` of URDF.
        coulomb_friction: torque that they take at any speed, N m or N: the ``friction`` of URDF.
        name: the joint's name; ``None`` numbers it.

    Raises:
        TableError: a value that is no number, not finite, or physically impossible.
    """

    joint: Literal["revolute", "prismatic"] = "revolute"
    a: float = 0.0
    alpha: float = 0.0
    d: float = 0.0
    theta: float = 0.0
    flip: bool = False
    lower: float | None = None
    upper: float | None = None
    velocity: float = 10.0
    effort: float = 1000.0
    mass: float = 0.0
    com: ArrayLike = (0.0, 0.0, 0.0)
    inertia: ArrayLike = field(default_factory=lambda: np.zeros((3, 3)))
    armature: float = 0.0
    viscous_friction: float = 0.0
    coulomb_friction: float = 0.0
    name: str | None = None

    def __post_init__(self) -> None:
        if self.name is not None:
            check_name(self.name, "link: name")
        place = f"link {self.name!r}" if self.name else "link"
        if not isinstance(self.joint, str) or self.joint not in ("revolute", "prismatic"):
            raise TableError(
                f'{place}: joint type {shown(self.joint)}; choose "revolute" or "prismatic"'
            )
        if not isinstance(self.flip, (bool, np.bool_)):
            raise TableError(f"{place}: flip is {self.flip!r}; it must be true or false")
        reach = math.pi if self.joint == "revolute" else 1.0
        defaults = {"lower": -reach, "upper": reach}
        numbers = {}
        for column in _NUMBERS:
            value = getattr(self, column)
            value = defaults[column] if value is None and column in defaults else value
            numbers[column] = float(shaped(value, (), f"{place}: {column}", TableError))
        com = shaped(self.com, (3,), f"{place}: com", TableError)
        inertia = shaped(self.inertia, (3, 3), f"{place}: inertia", TableError)
        set_fields(self, **numbers, com=frozen(com), inertia=frozen(inertia))
        self._check_physics(place)

    def _check_physics(self, place: str) -> None:
        assert self.lower is not None and self.upper is not None
        if self.lower > self.upper:
            raise TableError(f"{place}: lower {self.lower:g} is above upper {self.upper:g}")
        for column in ("mass", "armature", "velocity", "effort", *_FRICTION):
            if getattr(self, column) < 0:
                raise TableError(f"{place}: {column} is {getattr(self, column):g}; it must be >= 0")
        check_inertia(np.asarray(self.inertia), place, TableError)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, DHLink):
            return NotImplemented
        return all(same_value(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))

    def __hash__(self) -> int:
        return hash((self.joint, self.a, self.alpha, self.d, self.theta, self.mass))


def check_name(name: object, place: str) -> None:
    """Refuses a name that is no printable text.

    Raises:
        TableError: with ``place`` in front.
    """
    if not isinstance(name, str) or not name.strip() or not name.isprintable():
        raise TableError(f"{place} is {shown(name)}; it must be printable text")


def same_value(one: Any, two: Any) -> bool:
    """Equality of two field values, arrays entry by entry."""
    if isinstance(one, np.ndarray):
        return np.array_equal(one, two)
    return bool(one == two)
