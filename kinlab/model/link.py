"""One row of a DH table: convention, geometry, limits, inertia, and what an inertia can be."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from decimal import Decimal
from enum import StrEnum
from functools import cached_property
from itertools import chain, combinations
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, frozen, set_fields, shaped, shown
from kinlab.errors import KinlabError, TableError, warn
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
# A tensor I belongs to a distribution of mass if and only if S = ½ tr(I) 1 - I, the integral of
# r r^T dm, has no negative eigenvalue (Traversaro, Brossette, Escande and Nori 2016,
# "Identification of fully physical consistent inertial parameters using optimization on
# manifolds"). In principal moments: I1 + I2 >= I3 whichever is the largest, none negative.


@dataclass(frozen=True, eq=False)
class InertiaFlaw:
    """What no body can have about a tensor.

    Attributes:
        told: what is wrong, such as ``"inertia breaks the triangle inequality: ..."``.
        nearest: the nearest tensor that a body can have (Frobenius norm), (3, 3), kg m².
        rounding: whether a tensor that a body can have prints as the same digits.
    """

    told: str
    nearest: Array
    rounding: bool

    @property
    def remedy(self) -> str:
        """The nearest tensor in words."""
        return f"the nearest tensor that a body can have is {tensor_text(self.nearest)}"


def check_symmetric(inertia: Array, place: str, error: type[KinlabError]) -> None:
    """Refuses a matrix that is no tensor.

    Raises:
        KinlabError: (the class given) not symmetric, with ``place`` in front.
    """
    skew = float(np.max(np.abs(inertia - inertia.T)))
    if skew > TOLERANCES.inertia_symmetry * _size(inertia):
        raise error(f"{place}: inertia is not symmetric (off by {skew:.3g} kg m^2)")


def inertia_flaw(inertia: Array) -> InertiaFlaw | None:
    """What no body can have about a symmetric tensor, (3, 3), kg m²; None where it is sound."""
    if not inertia.any():
        return None
    allowance = TOLERANCES.inertia_triangle * _size(inertia)
    principal, axes = np.linalg.eigh(0.5 * (inertia + inertia.T))
    if principal[0] < -allowance:
        told = f"inertia is not positive (a principal moment is {principal[0]:.3g} kg m^2)"
    elif principal[0] + principal[1] < principal[2] - allowance:
        told = (
            "inertia breaks the triangle inequality: principal moments "
            f"{principal[0]:.4g} + {principal[1]:.4g} < {principal[2]:.4g} kg m^2"
        )
    else:
        return None
    nearest = axes @ np.diag(_nearest_moments(principal)) @ axes.T
    nearest = 0.5 * (nearest + nearest.T)
    nearest[np.abs(nearest) < TOLERANCES.residue * _size(nearest)] = 0.0
    return InertiaFlaw(told, nearest, _is_rounding(inertia, principal, axes))


def check_inertia(inertia: Array, place: str, error: type[KinlabError], way_out: str = "") -> None:
    """Refuses a tensor that no distribution of mass can have.

    Args:
        inertia: (3, 3) about the centre of mass, kg m².
        place: what to put in front of the message.
        error: the class to raise.
        way_out: how to use the numbers all the same, for the end of the message.

    Raises:
        KinlabError: (the class given) not symmetric, negative, or I1 + I2 < I3 for the
            principal moments (the triangle inequality).

    Warns:
        KinlabWarning: it fails only by the rounding of its printed digits.
    """
    check_symmetric(inertia, place, error)
    refuse_flaw(inertia_flaw(inertia), place, error, way_out)


def refuse_flaw(
    flaw: InertiaFlaw | None, place: str, error: type[KinlabError], way_out: str = ""
) -> None:
    """Raises or warns of a flaw, as :func:`check_inertia`."""
    if flaw is None:
        return
    if flaw.rounding:
        warn(
            f"{place}: {flaw.told}: no more than the rounding of its printed digits; it is used as "
            f"it stands ({flaw.remedy})"
        )
        return
    raise error(f"{place}: {flaw.told}; {flaw.remedy}" + (f"; {way_out}" if way_out else ""))


def steiner(mass: float, lever: Array) -> Array:
    """m (c² 1 - c c^T), (3, 3): what the parallel-axis theorem adds at a distance c, kg m²."""
    out: Array = mass * (float(lever @ lever) * np.eye(3) - np.outer(lever, lever))
    return out


def tensor_text(inertia: Array) -> str:
    """A tensor in a message: its moments, and its products where it has any."""
    entries = {
        "ixx": inertia[0, 0],
        "iyy": inertia[1, 1],
        "izz": inertia[2, 2],
        "ixy": inertia[0, 1],
        "ixz": inertia[0, 2],
        "iyz": inertia[1, 2],
    }
    told = [f"{key} = {x:.4g}" for key, x in entries.items() if x or key[1] == key[2]]
    return "{ " + ", ".join(told) + " }"


def _size(inertia: Array) -> float:
    return max(float(np.max(np.abs(inertia), initial=0.0)), TOLERANCES.inertia_floor)


_FACES = np.ones((3, 3)) - 2.0 * np.eye(3)
"""Row k times the principal moments must not be negative."""


def _nearest_moments(moments: Array) -> Array:
    """The nearest triple that keeps all three triangle inequalities, (3,).

    It is the foot of the perpendicular on one of the cone's faces, edges or its tip.
    """
    found = np.zeros(3)
    for active in chain.from_iterable(combinations(range(3), k) for k in (1, 2)):
        faces = _FACES[list(active)]
        foot = moments - np.linalg.pinv(faces) @ (faces @ moments)
        inside = bool(np.all(_FACES @ foot >= -TOLERANCES.residue * np.max(np.abs(moments))))
        if inside and np.linalg.norm(foot - moments) < np.linalg.norm(found - moments):
            found = foot
    return found


def _is_rounding(inertia: Array, principal: Array, axes: Array) -> bool:
    """Whether changes within half a unit of the last printed digit can make S positive.

    In each direction u in which S is negative, changes of the entries must gain enough.
    """
    spread = 0.5 * np.sum(principal) - principal
    lacking = spread < 0.0
    if np.min(spread) < -TOLERANCES.inertia_rounding * _size(inertia):
        return False
    for u, gap in zip(axes[:, lacking].T, -spread[lacking], strict=True):
        weight = np.abs(0.5 * np.eye(3) - np.outer(u, u))
        if float(np.sum(_half_units(inertia) * weight)) < gap:
            return False
    return True


def _half_units(inertia: Array) -> Array:
    """Half a unit of the last digit of each entry, (3, 3); a zero has the finest of them."""
    last = [_last_digit(abs(float(x))) for x in inertia.ravel()]
    finest = min(x for x in last if x)
    return 0.5 * np.reshape([x or finest for x in last], (3, 3))


def _last_digit(value: float) -> float:
    """One unit of the last digit that a number is written with; 0 for zero."""
    if value == 0.0:
        return 0.0
    return 10.0 ** int(Decimal(repr(value)).normalize().as_tuple().exponent)


# -------- One row of a DH table: geometry, limits and inertia of a link and its joint

_GEOMETRY = ("a", "alpha", "d", "theta")
FRICTION = ("viscous_friction", "coulomb_friction")
_NUMBERS = (*_GEOMETRY, "lower", "upper", "velocity", "effort", "mass", "armature", *FRICTION)


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
        TableError: a value that is no number, not finite, or physically impossible. Whether a
            body can have the inertia is asked by the table, which can be ``unphysical``.
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
        for column in ("mass", "armature", "velocity", "effort", *FRICTION):
            if getattr(self, column) < 0:
                raise TableError(f"{place}: {column} is {getattr(self, column):g}; it must be >= 0")
        check_symmetric(np.asarray(self.inertia), place, TableError)

    @cached_property
    def inertia_flaw(self) -> InertiaFlaw | None:
        """What no body can have about the inertia, or None; tables refuse it (``unphysical``)."""
        return inertia_flaw(np.asarray(self.inertia))

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
