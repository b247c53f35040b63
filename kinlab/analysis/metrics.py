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
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.structure.task_space import one_state, read_length, read_task
from kinlab.arrays import Array, real_array, word
from kinlab.engine.dynamics import mass_matrix
from kinlab.engine.states import joint_vector
from kinlab.errors import OptionError
from kinlab.host.introductions import Answer, Introduction, vector
from kinlab.model.library import ArmLike, as_robot
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


def of_task(task: str, suggested: bool, length: float | None) -> str:
    """The task of a measure in words, with the length that mixes metres and radians."""
    chosen = " (chosen for this arm)" if suggested else ""
    return f"task {task}{chosen}" + ("" if length is None else f", length {length:.6g} m")


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
            f"dexterity, {of_task(self.task, self.suggested, self.length)}: {state}",
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
