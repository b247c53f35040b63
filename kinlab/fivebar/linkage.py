"""``FiveBar``: the numbers of a five-bar linkage, and the table of its methods.

Two cranks turn about base pins on the x axis, leg 1 at (+e, 0) and leg 2 at (-e, 0); each
carries a rod, and the rods meet at the tool. u_i points along crank i, w_i along rod i from the
elbow to the tool. The plane is (x, y), angles are counter-clockwise from x.

The methods *are* the functions of this package: the class binds them, so that
``fivebar.ik(xy)`` is ``geometry.ik(fivebar, xy)``, with one docstring and one signature. The
files of the functions know this class by its type only.

Source: note 003; Huang et al. 2005, doi 10.1115/1.1898343.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path
from typing import Any, Generic, TypeVar, overload

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, frozen, real_array, shaped, shown
from kinlab.errors import MechanismError
from kinlab.fivebar import closed_chain as chain
from kinlab.fivebar import (
    cycle,
    dynamics,
    export,
    files,
    geometry,
    metrics,
    servo,
    singularity,
    workspace,
)
from kinlab.host.introductions import Answer, Introduction, brief, vector
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot

T = TypeVar("T")


class Converted(Generic[T]):
    """A field of a frozen dataclass that a function reads when it is set.

    This is Python's descriptor-typed field of a dataclass: the constructor sets it through
    ``__set__`` and takes its default from the class; assignment is refused by the dataclass.

    Args:
        read: from what was given, and the field's name in messages, to what is kept.
        default: what the constructor takes where nothing is given.
    """

    def __init__(
        self, read: Callable[[ArrayLike, str], T], default: ArrayLike | None = None
    ) -> None:
        self._read, self._default = read, default

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, holder: None, owner: type) -> ArrayLike: ...
    @overload
    def __get__(self, holder: object, owner: type) -> T: ...
    def __get__(self, holder: object | None, owner: type) -> T | ArrayLike:
        if holder is not None:
            value: T = vars(holder)[self._name]
            return value
        if self._default is None:
            raise AttributeError(f"{owner.__name__}.{self._name} has no default")
        return self._default

    def __set__(self, holder: object, value: ArrayLike) -> None:
        vars(holder)[self._name] = self._read(value, f"five-bar: {self._name}")


def _pair(value: ArrayLike, what: str) -> Array:
    array = real_array(value, what, MechanismError)
    if array.shape not in ((), (2,)):
        raise MechanismError(
            f"{what} has shape {array.shape}; expected one number or a pair (leg 1, leg 2)"
        )
    return frozen(np.broadcast_to(array, (2,)))


def _both(pair: Array) -> str:
    """One number where both legs have the same."""
    return " and ".join(f"{value:g}" for value in dict.fromkeys(pair.tolist()))


def _number(value: ArrayLike, what: str) -> float:
    return float(shaped(value, (), what, MechanismError))


def _vector(value: ArrayLike, what: str) -> Array:
    return frozen(shaped(value, (2,), what, MechanismError))


Pair = Converted[Array]
"""Given as one number for both legs or as (leg 1, leg 2); kept as (2,)."""

Number = Converted[float]
Vector = Converted[Array]
"""Given and kept as (2,)."""


@dataclass(frozen=True, eq=False, repr=False)
class FiveBar(Answer):
    """A five-bar linkage. Pairs are (leg 1, leg 2); one number serves both legs.

    Leg 1 is based at (+e, 0), leg 2 at (-e, 0); theta_i and u_i belong to crank i, w_i to rod i.
    A mode is (sign of u_1 x w_1, sign of u_2 x w_2); the default (-1, +1) hangs below the base
    with its elbows outward. An assembly is the sign of w_1 x w_2. Methods take points (2,) or
    (N, 2). Nothing is guessed: masses, centres and inertias that are not given are zero.

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

    l1: Pair = Converted(_pair)
    l2: Pair = Converted(_pair)
    e: Number = Converted(_number)
    crank_mass: Pair = Converted(_pair, 0.0)
    crank_com: Pair = Converted(_pair, 0.0)
    crank_inertia: Pair = Converted(_pair, 0.0)
    rod_mass: Pair = Converted(_pair, 0.0)
    rod_com: Pair = Converted(_pair, 0.0)
    rod_inertia: Pair = Converted(_pair, 0.0)
    payload: Number = Converted(_number, 0.0)
    rotor_inertia: Pair = Converted(_pair, 0.0)
    gear_ratio: Pair = Converted(_pair, 1.0)
    gravity: Vector = Converted(_vector, (0.0, -9.81))
    name: str = "five-bar"
    source: str = ""

    # geometry: positions, rates, accelerations
    ik = geometry.ik
    fk = geometry.fk
    reachable = geometry.reachable
    mode_of = geometry.mode_of
    jacobian = geometry.jacobian
    acceleration_bias = geometry.acceleration_bias
    joint_rates = geometry.joint_rates
    joint_accelerations = geometry.joint_accelerations

    # dynamics: torque, mass matrix, energy, power
    inverse_dynamics = dynamics.inverse_dynamics
    forward_dynamics = dynamics.forward_dynamics
    mass_matrix = dynamics.mass_matrix
    task_mass_matrix = dynamics.task_mass_matrix
    gravity_torques = dynamics.gravity_torques
    bias_torques = dynamics.bias_torques
    kinetic_energy = dynamics.kinetic_energy
    potential_energy = dynamics.potential_energy
    joint_power = dynamics.joint_power

    # metrics: how good a pose is
    determinant = metrics.determinant
    singular_values = metrics.singular_values
    condition_number = metrics.condition_number
    passive_angles = metrics.passive_angles
    pressure_angles = metrics.pressure_angles
    transmission_angle = metrics.transmission_angle
    stiffness = metrics.stiffness
    isotropic_poses = metrics.isotropic_poses

    # singularity: where the loci are, and how far away
    type_one = singularity.type_one
    type_two = singularity.type_two
    type_two_polynomial = singularity.type_two_polynomial
    type_two_contour = singularity.type_two_contour
    singularity_distances = singularity.distances
    classify = singularity.classify

    # workspace: what can be reached, and the regions free of singularities
    reachable_area = workspace.reachable_area
    workspace_map = workspace.workspace_map
    free_region = workspace.free_region
    largest_circle = workspace.largest_circle
    largest_rectangle = workspace.largest_rectangle

    # drives, Pinocchio's closed chain, files
    follow = cycle.follow
    size_servo = servo.size_servo
    size_cycle = cycle.size_cycle
    fastest_cycle = cycle.fastest_cycle
    fit_to_motor = cycle.fit_to_motor
    closed_chain = chain.build
    export = export.export
    save = files.write

    @staticmethod
    def load(name_or_path: str | Path) -> FiveBar:
        """A preset by name ("isotropic"), or a TOML file.

        Raises:
            NameUnknownError: no preset of that name.
            FileError: the file cannot be read.
            MechanismError: not TOML, a key that does not exist or is missing, not a number, or
                an impossible linkage.
        """
        return FiveBar(**files.read(name_or_path, [f.name for f in fields(FiveBar)]))

    def with_masses(
        self,
        crank: ArrayLike | None = None,
        rod: ArrayLike | None = None,
        payload: float | None = None,
    ) -> FiveBar:
        """The same linkage with uniform bars of these masses; ``None`` leaves what is there.

        Args:
            crank, rod: kg, one number or a pair; centre in the middle, inertia m l²/12.
            payload: kg.

        Raises:
            MechanismError: a mass that is negative or no number.
        """
        values: dict[str, Any] = {}
        for name, mass, length in (("crank", crank, self.l1), ("rod", rod, self.l2)):
            if mass is not None:
                each = _pair(mass, f"{self.name}: {name}_mass")
                bar = {"mass": each, "com": 0.5 * length, "inertia": each * length**2 / 12.0}
                values |= {f"{name}_{key}": value for key, value in bar.items()}
        if payload is not None:
            values["payload"] = payload
        return replace(self, **values)

    def introduction(self) -> Introduction:
        """Lengths and masses, and where the numbers come from."""
        bars = (("cranks", self.l1, self.crank_mass), ("rods", self.l2, self.rod_mass))
        lengths = [f"{name} {_both(length)} m" for name, length, _ in bars]
        pins = f"base pins at x = ±{self.e:g} m" if self.e else "both cranks on one axis"
        masses = [f"{name} {_both(mass)} kg" for name, _, mass in bars if np.any(mass)]
        masses += [f"payload {self.payload:g} kg"] if self.payload else []
        carried = f"{', '.join(masses)}, gravity {vector(self.gravity)} m/s²"
        lines = (brief(self.source), carried if masses else "no masses given")
        return Introduction(
            f"five-bar {self.name}: {', '.join([*lengths, pins])}",
            tuple(line for line in lines if line),
        )

    def __repr__(self) -> str:
        lengths = f"l1 {_both(self.l1)}, l2 {_both(self.l2)}, e {self.e:g} m"
        return f"<FiveBar {self.name!r}: {lengths}>"

    @property
    def base_x(self) -> Array:
        """x of the two base pins, (2,): (+e, -e)."""
        return np.array([self.e, -self.e])

    @property
    def reflected_inertia(self) -> Array:
        """j² I_M: the rotors' inertia at the cranks, (2,), kg m²."""
        return np.asarray(self.gear_ratio**2 * self.rotor_inertia)

    def values(self) -> dict[str, Any]:
        """The constructor's arguments as plain numbers and text, pairs as lists."""
        return {
            f.name: value.tolist() if isinstance(value, np.ndarray) else value
            for f in fields(self)
            for value in [getattr(self, f.name)]
        }

    def __eq__(self, other: object) -> bool:
        return self.values() == other.values() if isinstance(other, FiveBar) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.name, self.e, self.payload, *self.l1, *self.l2))

    def __post_init__(self) -> None:
        """Refuses signs that cannot be, and bars that cannot close into a loop that moves."""
        for column, text in (("name", self.name), ("source", self.source)):
            if not isinstance(text, str):
                raise MechanismError(f"five-bar: {column} is {shown(text)}; it must be text")
        if not self.name.strip() or not self.name.isprintable():
            raise MechanismError(f"five-bar: name is {shown(self.name)}; it must be printable")
        bounds = {
            "must be positive": (np.less_equal, ("l1", "l2", "gear_ratio")),
            "must be >= 0": (
                np.less,
                ("crank_mass", "crank_inertia", "rod_mass", "rod_inertia", "rotor_inertia"),
            ),
        }
        for rule, (breaks, columns) in bounds.items():
            for column in columns:
                for leg, value in enumerate(getattr(self, column), 1):
                    if breaks(value, 0.0):
                        raise MechanismError(
                            f"{self.name}: {column} of leg {leg} is {value:g}; it {rule}"
                        )
        for column in ("e", "payload"):
            if getattr(self, column) < 0.0:
                raise MechanismError(
                    f"{self.name}: {column} is {getattr(self, column):g}; it must be >= 0"
                )
        (a1, b1), (a2, b2) = self.l1, self.l2
        bars = {"crank 1": a1, "rod 1": a2, "crank 2": b1, "rod 2": b2, "base 2e": 2.0 * self.e}
        total = sum(bars.values())
        for bar, length in bars.items():  # each must be shorter than the others together
            if length >= total - length:
                raise MechanismError(
                    f"{self.name}: the loop cannot close and move: {bar} is {length:g} m long, "
                    f"the other four bars together {total - length:g} m; it must be shorter"
                )


def as_five_bar(mechanism: FiveBar | str | Path) -> FiveBar:
    """The five-bar that a caller means; a preset is read once, a file at each call.

    Args:
        mechanism: a FiveBar, which comes back as it is; or a name or path, as for
            :meth:`FiveBar.load`.

    Raises:
        MechanismError: neither.
        KinlabError: as :meth:`FiveBar.load`.
    """
    if isinstance(mechanism, FiveBar):
        return mechanism
    if isinstance(mechanism, (str, Path)):
        text = str(mechanism)
        return _preset(text) if text in files.presets() else FiveBar.load(text)
    kind = type(mechanism).__name__
    raise MechanismError(f"five-bar: {kind} is none; give a FiveBar, a preset's name, or a path")


@cache
def _preset(name: str) -> FiveBar:
    return FiveBar.load(name)


def as_mechanism(mechanism: ArmLike | FiveBar) -> Robot | FiveBar:
    """The arm or five-bar that a caller means, where a function takes both.

    Raises:
        KinlabError: as :func:`kinlab.model.library.as_robot` and :func:`as_five_bar`.
    """
    if isinstance(mechanism, FiveBar):
        return mechanism
    if isinstance(mechanism, (str, Path)) and files.holds_five_bar(mechanism):
        return as_five_bar(mechanism)
    return as_robot(mechanism)
