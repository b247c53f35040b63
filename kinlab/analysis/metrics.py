"""Measures of dexterity from singular values, never from det(J J^T).

With sigma_1 >= ... >= sigma_m the singular values of the task's J (m rows; fewer joints than
rows count as zeros, for the ellipsoid is then flat):

* ``yoshikawa``: product of all sigma, the volume of the velocity ellipsoid up to a constant
  (Yoshikawa, "Manipulability of robotic mechanisms", IJRR 4(2), 1985).
* ``inverse_condition``: sigma_m / sigma_1, 0 at singularities, 1 at isotropy (Salisbury & Craig,
  "Articulated hands: force control and kinematic issues", IJRR 1(1), 1982).
* ``min_singular``: sigma_m, the slowest direction at unit joint speed (Klein & Blaho, 1987).
* ``asada``: least over greatest principal axis squared of the generalised inertia ellipsoid
  Lambda = (J M^-1 J^T)^-1 (Asada, "A geometrical representation of manipulator dynamics and its
  application to arm design", ASME J. DSMC 105, 1983). With M = L L^T it is (s_m / s_1)^2 for the
  singular values s of J L^-T, so that it is exact, and 0, where Lambda does not exist.
* ``isotropy``: geometric over arithmetic mean of sigma_i^2, (prod)^(1/m) / (sum / m) (Kim &
  Khosla, "Dexterity measures for design and control of manipulators", IROS 1991).

Why not det: on exactly singular matrices rounding makes det(J J^T) negative about half of the
time, and its root wrong by the square root of rounding.

The characteristic length of a mixed task: the one that makes J best conditioned at a q.

Angeles, *Fundamentals of Robotic Mechanical Systems*, section 5.8, and Ranjbaran, Angeles &
Gonzalez-Palacios, "The mechanical design of a seven-axes manipulator with kinematic isotropy"
(JIRS 14, 1995): the characteristic length is the L that minimises the condition number of J with
its entries in metres divided by L.

Velocity, force and dynamic ellipsoids: principal axes and lengths from singular values.

* velocity: tool velocities of joint speeds with |qdot| <= 1; semi-axes sigma_i (Yoshikawa, IJRR
  4(2), 1985).
* force: tool forces held by joint torques with |tau| <= 1; the same axes, semi-axes 1 / sigma_i.
* dynamic: tool accelerations from rest, without gravity, of joint torques with |tau| <= 1;
  singular values of J M^-1 (Yoshikawa, "Dynamic manipulability of robot manipulators", 1985).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.structure.task_space import TaskSpace, one_state, read_length, read_task
from kinlab.arrays import Array, frozen, real_array, word
from kinlab.engine.dynamics import mass_matrix
from kinlab.engine.states import joint_vector
from kinlab.errors import NameUnknownError, OptionError
from kinlab.host.introductions import Answer, Introduction, vector
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import require_inertia
from kinlab.tolerances import TOLERANCES


def yoshikawa(sigma: Array) -> Array:
    """Product of the singular values, (..., m) to (...)."""
    product: Array = np.prod(sigma, axis=-1)
    return product


def inverse_condition(sigma: Array) -> Array:
    """Least over greatest singular value, 0 for a zero matrix."""
    largest, least = sigma.max(axis=-1), sigma.min(axis=-1)
    ratio: Array = least / np.where(largest > 0.0, largest, 1.0)
    return ratio


def min_singular(sigma: Array) -> Array:
    """The least singular value."""
    least: Array = sigma.min(axis=-1)
    return least


def isotropy(sigma: Array) -> Array:
    """Geometric over arithmetic mean of the squares, 0 for a zero matrix."""
    largest = sigma.max(axis=-1, keepdims=True)
    scaled = sigma / np.where(largest > 0.0, largest, 1.0)  # no overflow, no underflow of the sum
    mean = np.mean(scaled**2, axis=-1)
    index: Array = np.prod(scaled ** (2.0 / sigma.shape[-1]), axis=-1) / np.where(
        mean > 0.0, mean, 1.0
    )
    return index


KINDS: dict[str, Callable[[Array], Array]] = {
    "yoshikawa": yoshikawa,
    "inverse_condition": inverse_condition,
    "min_singular": min_singular,
    "asada": lambda s: inverse_condition(s) ** 2,  # of J L^-T, see weighted()
    "isotropy": isotropy,
}
"""Name to function of the singular values."""


def singular_values(jacobians: ArrayLike) -> Array:
    """All m singular values of each (m, n) matrix, descending; zeros where n < m.

    Args:
        jacobians: (..., m, n).

    Returns:
        (..., m).
    """
    matrix = real_array(jacobians, "Jacobian", OptionError)
    if matrix.ndim < 2 or 0 in matrix.shape[-2:]:
        raise OptionError(f"Jacobian: shape {matrix.shape}; expected (..., m, n)")
    values = np.linalg.svd(matrix, compute_uv=False)
    missing = matrix.shape[-2] - values.shape[-1]
    return np.pad(values, [(0, 0)] * (values.ndim - 1) + [(0, max(missing, 0))])


def condition_number(sigma: Array) -> Array:
    """Greatest over least singular value; infinity where that is 0, on purpose."""
    ratio = inverse_condition(sigma)
    large = ratio >= np.finfo(np.float64).tiny  # of anything less there is no inverse
    return np.divide(1.0, ratio, out=np.full_like(ratio, np.inf), where=large)


def manipulability(
    robot: ArmLike,
    q: ArrayLike,
    kind: str = "yoshikawa",
    task: Any = "auto",
    length: float = 1.0,
) -> Any:
    """A measure of dexterity at q; the definitions stand at the top of this module.

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n).
        kind: ``"yoshikawa"``, ``"inverse_condition"``, ``"min_singular"``, ``"asada"`` or
            ``"isotropy"``.
        task: ``"pose"``, ``"position"``, ``"orientation"``, ``"xy"``, ``"xytheta"``, a mask of
            six booleans, or ``"auto"`` for the largest that suits the arm. An arm with fewer
            joints than the task has rows is flat: every measure is 0 at every q.
        length: characteristic length in metres by which entries in metres are divided; 1 m
            leaves the SI numbers, and then a mixed task weighs 1 m like 1 rad.

    Returns:
        A float, or (N,), each with the attribute ``task``. Finite, and 0 at singularities up to
        rounding (of which ``"isotropy"`` takes the third root in a space of six coordinates: 1e-6).

    Raises:
        StateError: q of the wrong shape or type, or not finite.
        NameUnknownError: another kind or task; the valid ones are listed.
        OptionError: a mask that is none, length <= 0.
        InertiaError: ``"asada"`` of a robot with a singular mass matrix.
    """
    robot = as_robot(robot)
    measure = read_kind(kind)
    space, size = read_task(robot, task), read_length(length)
    states = joint_vector(robot, q, "q")
    matrix = space.jacobian(states, size)
    if kind == "asada":
        matrix = weighted(matrix, mass_matrix(robot, states))
    value = measure(singular_values(matrix))
    return Value(value, space.name) if states.ndim == 1 else Values(value, space.name)


class Value(float):
    """A measure at one q: a number that knows its task."""

    task: str

    def __new__(cls, value: Any, task: str) -> Value:
        made = super().__new__(cls, value)
        made.task = task
        return made

    def __getnewargs__(self) -> Any:
        return float(self), self.task


class Values(np.ndarray[Any, np.dtype[np.float64]]):
    """A measure at many q, (N,): an array that knows its task, as do slices of it."""

    task: str

    def __new__(cls, values: Array, task: str) -> Values:
        made = np.asarray(values, dtype=np.float64).view(cls)
        made.task = task
        return made

    def __array_finalize__(self, made_from: Any) -> None:
        self.task = getattr(made_from, "task", "")


def read_kind(kind: Any) -> Callable[[Array], Array]:
    """The function of a measure's name.

    Raises:
        NameUnknownError: no such measure; the valid ones are listed.
    """
    return KINDS[word(kind, KINDS, "metric")]


def weighted(matrix: Array, mass: Array) -> Array:
    """J L^-T with M = L L^T, whose singular values squared are 1 / eigenvalues of Lambda."""
    lower = np.linalg.cholesky(mass)
    return np.swapaxes(np.linalg.solve(lower, np.swapaxes(matrix, -1, -2)), -1, -2)


@dataclass(frozen=True, repr=False)
class Dexterity(Answer):
    """Every measure at one q, with the task and the length they hold for.

    Attributes:
        task: name of the task. suggested: kinlab chose it.
        length: characteristic length in metres, ``None`` where the task needs none.
        sigma: singular values, descending, (m,).
        yoshikawa, inverse_condition, min_singular, isotropy: see the module.
        condition: greatest over least singular value; infinity where that is 0, and above 1e10
            where rounding leaves something of it.
        rank: number of singular values above 1e-10 of the greatest.
    """

    task: str
    suggested: bool
    length: float | None
    sigma: Array
    yoshikawa: float
    inverse_condition: float
    min_singular: float
    isotropy: float
    condition: float
    rank: int

    def introduction(self) -> Introduction:
        """How near the arm is to a singularity, and every measure."""
        whole = self.rank == len(self.sigma)
        state = f"condition number {self.condition:.6g}" if whole else f"singular, rank {self.rank}"
        return Introduction(
            f"dexterity, {_of_task(self.task, self.suggested, self.length)}: {state}",
            (
                f"singular values {vector(self.sigma)}",
                f"manipulability (Yoshikawa) {self.yoshikawa:.5g}, inverse condition "
                f"{self.inverse_condition:.5g}, isotropy index {self.isotropy:.5g}",
            ),
        )


def dexterity(robot: ArmLike, q: ArrayLike, task: Any = "auto", length: float = 1.0) -> Dexterity:
    """Every measure at one q.

    Args:
        robot: the robot.
        q: joint positions, (n,).
        task, length: as in :func:`manipulability`; the task is chosen where none is given.

    Raises:
        StateError, NameUnknownError, OptionError: as :func:`manipulability`.
    """
    robot = as_robot(robot)
    space, size = read_task(robot, task), read_length(length)
    state = one_state(robot, q)
    sigma = singular_values(space.jacobian(state, size))
    numbers = {name: float(KINDS[name](sigma)) for name in KINDS if name != "asada"}
    rank = int(np.sum(regular(sigma)))
    return Dexterity(
        space.name,
        space.suggested,
        size if space.mixed else None,
        sigma,
        condition=float(condition_number(sigma)),
        rank=rank,
        **numbers,
    )


def regular(sigma: Array) -> Any:
    """Which singular values, (m,) descending, count as more than zero: their inverses exist."""
    return sigma > max(TOLERANCES.singular * float(sigma[0]), float(np.finfo(np.float64).tiny))


def counting(sigma: Any, share: float = TOLERANCES.singular) -> Any:
    """Which singular values (..., m), descending, of a J in the arm's own length unit count.

    Those above a share of the greatest; of a J that is rounding altogether, none.
    """
    largest = np.where(sigma[..., :1] > TOLERANCES.singular, sigma[..., :1], np.inf)
    return sigma > share * largest


OPTIMAL = "optimal"
"""In place of a number of metres: the length that minimises the condition number."""

_DECADES = 3.0
"""The search spans the arm's own length unit times 10^-3 to 10^3."""


@dataclass(frozen=True)
class CharacteristicLength:
    """Answer of :func:`characteristic_length`.

    Attributes:
        length: metres, or ``None`` where the condition number depends on no length.
        condition: condition number of J at that length; infinity where J has a singular value 0.
        task: name of the task.
        how: ``given``, ``optimal`` or ``none needed``.
    """

    length: float | None
    condition: float
    task: str
    how: str


def characteristic_length(
    robot: ArmLike, q: ArrayLike, task: Any = "auto", length: float | str = OPTIMAL
) -> CharacteristicLength:
    """The length that minimises the condition number at q, or the effect of a given one.

    It is looked for from 1/1000 to 1000 times the arm's own length unit. There is one minimum:
    log kappa is convex in log L (norms of D1 J D2 and its inverse, by Hadamard's three lines).

    Args:
        robot: the robot.
        q: joint positions, (n,).
        task: as in :func:`kinlab.manipulability`, or ``"auto"``.
        length: metres, or ``"optimal"``.

    Raises:
        StateError, NameUnknownError, OptionError: bad q, unknown task, length <= 0, or a
            singular q, at which every length is as bad as any other.
    """
    robot = as_robot(robot)
    space = read_task(robot, task)
    state = one_state(robot, q)
    given = read_length_choice(length)
    if not space.mixed:
        return CharacteristicLength(None, _condition(space, state, 1.0), space.name, "none needed")
    if given is not None:
        return CharacteristicLength(given, _condition(space, state, given), space.name, "given")
    values = singular_values(space.jacobian(state, space.scale))
    if values[-1] <= 1e-10 * values[0]:
        raise OptionError(
            f"robot {robot.name!r}: q is singular for task {space.name}; every length gives an "
            "infinite condition number"
        )
    best = best_length(space, state)
    return CharacteristicLength(best, _condition(space, state, best), space.name, "optimal")


def best_length(space: TaskSpace, q: Array) -> float:
    """The minimiser of the condition number over L: log kappa is scanned, then bracketed."""
    from scipy.optimize import minimize_scalar  # `import kinlab` does not wait for scipy

    exponents = np.linspace(-_DECADES, _DECADES, 121)

    def cost(exponent: float) -> float:
        return float(np.log(_condition(space, q, space.scale * 10.0**exponent)))

    at = int(np.argmin([cost(float(e)) for e in exponents]))
    around = exponents[max(at - 1, 0)], exponents[min(at + 1, len(exponents) - 1)]
    found = minimize_scalar(cost, bounds=around, method="bounded", options={"xatol": 1e-12})
    return float(space.scale * 10.0**found.x)


def read_length_choice(length: Any) -> float | None:
    """A number of metres, or ``None`` for ``"optimal"``.

    Raises:
        NameUnknownError: another word. OptionError: not a number above zero.
    """
    if isinstance(length, str):
        if length != OPTIMAL:
            raise NameUnknownError(f'length {length!r} is unknown; give metres or "{OPTIMAL}"')
        return None
    return read_length(length)


def _condition(space: TaskSpace, q: Array, length: float) -> float:
    sigma = singular_values(space.jacobian(q, length))
    return float(sigma[0] / sigma[-1]) if sigma[-1] > 0.0 else float("inf")


ELLIPSOIDS = ("velocity", "force", "dynamic")


@dataclass(frozen=True, repr=False)
class Ellipsoid(Answer):
    """An ellipsoid in task coordinates.

    Attributes:
        kind: ``velocity``, ``force`` or ``dynamic``.
        task: the task. suggested: kinlab chose it.
        length: characteristic length, or ``None`` where the task needs none.
        axes: unit principal axes as columns, (m, m).
        lengths: semi-axes, descending, (m,). Zero: flat in that direction. Infinity (force
            only): a force in that direction needs no torque, as at a singularity.
    """

    kind: str
    task: str
    suggested: bool
    length: float | None
    axes: Array
    lengths: Array

    def introduction(self) -> Introduction:
        """Its semi-axes, the longest first, each with its direction."""
        flat = bool(self.lengths[-1] == 0.0)
        state = "flat: the arm is singular here" if flat else f"semi-axes {vector(self.lengths)}"
        rows = tuple(
            (f"{size:.5g}", vector(axis, 4))
            for size, axis in zip(self.lengths, self.axes.T, strict=True)
        )
        return Introduction(
            f"{self.kind} ellipsoid, {_of_task(self.task, self.suggested, self.length)}: {state}",
            (),
            ("semi-axis", "direction"),
            rows,
        )


def _of_task(task: str, suggested: bool, length: float | None) -> str:
    """The task of a measure in words, with the length that mixes metres and radians."""
    chosen = " (chosen for this arm)" if suggested else ""
    return f"task {task}{chosen}" + ("" if length is None else f", length {length:.6g} m")


def ellipsoid(
    robot: ArmLike, q: ArrayLike, kind: str = "velocity", task: Any = "auto", length: float = 1.0
) -> Ellipsoid:
    """An ellipsoid at one q; the three kinds are defined at the top of this module.

    Args:
        robot: the robot.
        q: joint positions, (n,).
        kind: ``"velocity"``, ``"force"`` or ``"dynamic"``.
        task, length: as in :func:`kinlab.manipulability`, or ``"auto"``.

    Raises:
        StateError, NameUnknownError, OptionError: bad q, unknown kind or task, length <= 0.
        InertiaError: ``"dynamic"`` of a robot with a singular mass matrix.
    """
    robot = as_robot(robot)
    kind = word(kind, ELLIPSOIDS, "ellipsoid")
    space, size = read_task(robot, task), read_length(length)
    state = one_state(robot, q)
    matrix = space.jacobian(state, size)
    if kind == "dynamic":
        require_inertia(robot)
        matrix = np.asarray(np.linalg.solve(mass_matrix(robot, state), matrix.T).T, np.float64)
    left: Array = np.linalg.svd(matrix)[0]
    sigma: Array = singular_values(matrix)
    if kind == "force":
        inverse: Array = np.divide(
            1.0, sigma, out=np.full_like(sigma, np.inf), where=regular(sigma)
        )
        left, sigma = left[:, ::-1], inverse[::-1]
    return Ellipsoid(
        kind,
        space.name,
        space.suggested,
        size if space.mixed else None,
        frozen(left),
        frozen(sigma),
    )
