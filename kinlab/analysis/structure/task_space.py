"""The rows of J that a task asks for, in dimensionless form, and the box searches draw from.

A Jacobian that mixes metres and radians has no condition number of its own. Its entries in
metres (linear rows, revolute columns) are divided by a *characteristic length* L (Angeles,
"The design of isotropic manipulator architectures in the presence of redundancies", IJRR 11(3),
1992); every other entry has no unit. L = 1 m leaves the SI numbers as they are.
"""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.structure.tasks import TASKS, generic_rank, require_task, task_name, task_rows
from kinlab.arrays import Array, frozen, real_array
from kinlab.engine.fast.stacks import jacobian
from kinlab.engine.states import joint_vector
from kinlab.errors import OptionError
from kinlab.model.robot import Robot

AUTO = "auto"
"""The task that suits the arm: as many coordinates as it can move independently."""

MOST_METRES = 1e30
"""Characteristic lengths beyond this, or below its inverse, leave numbers that overflow."""

ENDLESS = 1e6
"""Limits beyond this are none: Pinocchio writes the largest float where a model has no limit."""

_SAMPLE = 8
"""States that show the generic rank of J: one is enough almost surely, eight are cheap."""


@dataclass(frozen=True)
class TaskSpace:
    """The task of one robot.

    Attributes:
        robot: the robot.
        rows: rows of the base-frame Jacobian, ascending.
        name: the task's name, or its coordinates, for messages and answers.
        suggested: the task was chosen by kinlab, not by the caller.
    """

    robot: Robot
    rows: tuple[int, ...]
    name: str
    suggested: bool = False

    @property
    def m(self) -> int:
        """Number of task coordinates."""
        return len(self.rows)

    @cached_property
    def sample(self) -> Array:
        """Jacobians at a few states in general position, (8, 6, n)."""
        return sample_jacobians(self.robot)

    @cached_property
    def metres(self) -> Any:
        """Which entries of the (m, n) Jacobian are in metres per radian."""
        return _metres(self.sample, self.rows)

    @property
    def mixed(self) -> bool:
        """Whether the condition number depends on the unit of length."""
        return bool(self.metres.any() and np.any(~self.metres & self._present))

    @cached_property
    def _present(self) -> Any:
        return np.abs(self.sample[:, list(self.rows), :]).max(axis=0) > 0.0

    @cached_property
    def scale(self) -> float:
        """Root mean square of the entries in metres: a length of the arm's own size."""
        entries = self.sample[:, list(self.rows), :][:, self.metres]
        size = float(np.sqrt(np.mean(entries**2))) if entries.size else 0.0
        return size if size > 0.0 else 1.0

    def jacobian(self, q: Array, length: float | Array = 1.0) -> Array:
        """The task's rows of J, entries in metres divided by ``length``.

        Args:
            q: (n,) or (N, n).
            length: metres; one, or one per state, (N,).

        Returns:
            (m, n) or (N, m, n).
        """
        return self.select(jacobian(self.robot, q), length)

    def sigma(self, q: Array) -> Array:
        """Singular values of the task's J, metres over :attr:`scale`, largest first.

        Args:
            q: (n,) or (N, n).

        Returns:
            (m,) or (N, m); (n,) or (N, n) where the task has more rows than the arm joints.
        """
        values = np.linalg.svd(self.jacobian(q, self.scale), compute_uv=False)
        return np.asarray(values, dtype=np.float64)

    def select(self, full: Array, length: float | Array = 1.0) -> Array:
        """As :meth:`jacobian`, from 6-row Jacobians, (..., 6, n)."""
        rows: Array = full[..., list(self.rows), :]
        factor = np.where(self.metres, 1.0 / np.asarray(length)[..., np.newaxis, np.newaxis], 1.0)
        return rows * factor


_SAMPLED: WeakKeyDictionary[Robot, Array] = WeakKeyDictionary()
_SUGGESTED: WeakKeyDictionary[Robot, tuple[int, ...]] = WeakKeyDictionary()


def sample_jacobians(robot: Robot) -> Array:
    """Base-frame Jacobians at a few seeded states in general position, (8, 6, n), kept."""
    if robot not in _SAMPLED:
        lower, upper = search_box(robot)
        states = np.random.default_rng(0).uniform(lower, upper, (_SAMPLE, robot.n))
        _SAMPLED[robot] = frozen(jacobian(robot, states))
    return _SAMPLED[robot]


def read_task(robot: Robot, task: Any) -> TaskSpace:
    """Reads a task; ``"auto"`` or ``None`` picks the one that suits the arm.

    Args:
        robot: the robot.
        task: a name of :data:`kinlab.analysis.structure.tasks.TASKS`, six booleans, ``"auto"`` or
            ``None``.

    Raises:
        NameUnknownError, OptionError: as :func:`kinlab.analysis.structure.tasks.task_rows`.
    """
    if task is None or (isinstance(task, str) and task == AUTO):
        rows = suggest_rows(robot)
        return TaskSpace(robot, rows, plain_name(rows), suggested=True)
    rows = task_rows(task)
    return TaskSpace(robot, rows, plain_name(rows))


def read_reachable_task(robot: Robot, task: Any) -> TaskSpace:
    """As :func:`read_task`, and the arm must be able to move every coordinate independently.

    Raises:
        OptionError: it cannot; the message names the coordinates and a task that fits.
    """
    space = read_task(robot, task)
    require_task(space.rows, space.sample, f"robot {robot.name!r}")
    return space


def suggest_rows(robot: Robot) -> tuple[int, ...]:
    """As many task coordinates as the arm can move independently, a named task where one fits."""
    if robot not in _SUGGESTED:
        _SUGGESTED[robot] = _suggest(sample_jacobians(robot))
    return _SUGGESTED[robot]


def _suggest(sample: Array) -> tuple[int, ...]:
    rank = generic_rank(sample, range(6))
    for rows in TASKS.values():
        if len(rows) == rank and generic_rank(sample, rows) == rank:
            return rows
    rows = ()
    for i in range(6):  # a coordinate joins where it moves independently of those before
        if generic_rank(sample, (*rows, i)) == len(rows) + 1:
            rows = (*rows, i)
    return rows


def mask_of(rows: Sequence[int]) -> tuple[bool, ...]:
    """The mask of six booleans of these rows, which is a task too."""
    return tuple(row in rows for row in range(6))


def plain_name(rows: tuple[int, ...]) -> str:
    """The task's name without quotes, or its coordinates."""
    name = task_name(rows)
    return str(ast.literal_eval(name)) if name.startswith("'") else name


def one_state(robot: Robot, q: ArrayLike) -> Array:
    """Reads one joint vector, (n,).

    Raises:
        StateError: of another shape, or not finite. OptionError: a stack.
    """
    state = joint_vector(robot, q, "q")
    if state.ndim != 1:
        raise OptionError(f"robot {robot.name!r}: q has shape {state.shape}; give one state")
    return state


def read_length(length: Any) -> float:
    """Reads a characteristic length in metres.

    Raises:
        OptionError: not one finite number above zero.
    """
    value = real_array(length, "characteristic length", OptionError)
    if value.shape != ():
        raise OptionError(f"characteristic length: shape {value.shape}; give one number in metres")
    if value <= 0.0:
        raise OptionError(f"characteristic length {float(value):g} m; it must be above 0")
    if not 1.0 / MOST_METRES <= value <= MOST_METRES:
        bounds = f"{1.0 / MOST_METRES:g} to {MOST_METRES:g} m"
        raise OptionError(f"characteristic length {float(value):g} m; give one from {bounds}")
    return float(value)


def search_box(robot: Robot) -> tuple[Array, Array]:
    """Where searches draw q: the limits, at most one turn about zero for a revolute joint.

    Of a slide without limits (Pinocchio writes the largest float), one metre either way.
    """
    turns = revolute(robot)
    low, high = np.maximum(robot.lower, -ENDLESS), np.minimum(robot.upper, ENDLESS)
    half = np.where(turns, np.pi, np.where(high - low >= ENDLESS, 1.0, np.inf))
    wide = high - low >= 2.0 * half
    return np.where(wide, np.maximum(low, -half), low), np.where(wide, np.minimum(high, half), high)


def revolute(robot: Robot) -> Any:
    """Which joints turn, (n,) of booleans."""
    angular = jacobian(robot, np.zeros(robot.n))[3:]
    return np.abs(angular).max(axis=0) > 0.0


def wrap(robot: Robot, q: ArrayLike) -> Array:
    """Revolute joints by whole turns into the search box, where a turn allows it."""
    lower, upper = search_box(robot)
    turns = revolute(robot)
    values = np.array(q, dtype=np.float64)
    middle = np.where(turns, 0.5 * (lower + upper), 0.0)
    folded = middle + np.mod(values - middle + np.pi, 2.0 * np.pi) - np.pi
    return np.where(turns, folded, values)


def _metres(sample: Array, rows: tuple[int, ...]) -> Any:
    turns = np.abs(sample[:, 3:, :]).max(axis=(0, 1)) > 0.0
    return np.outer(np.asarray(rows) < 3, turns)
