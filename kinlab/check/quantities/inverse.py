"""Inverse kinematics as a quantity: joint positions are right where their pose is the target.

A hand formula answers with one solution (n,) or several (m, n), of any branch; what is compared
is the place that Pinocchio's forward kinematics has for them, of several the one furthest off.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial, wraps
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.quantity import Quantity
from kinlab.check.quantities.serial import SERIAL, planar_jacobian, positions
from kinlab.engine import kinematics
from kinlab.errors import StructureError
from kinlab.formulas.record import AnswerShapeError
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_CLEAR = 0.05
"""Least over largest singular value of the task's Jacobian, where a pose is far from singular."""
_NEAR_ONES = 4
"""One target of so many is near a singular pose: there formulas clamp, and lose a branch."""
_TRIES = 50
_MOST = 16
"""Solutions of one target that are looked at: no arm of six hinges has more."""
_DOMAIN = re.compile("math domain|in range|nonnegative")
"""What Python says of acos(1.2) and sqrt(-1)."""


@dataclass(frozen=True)
class Task:
    """What of the tool's pose is given: the arguments, and how they follow from the pose.

    Attributes:
        arguments: their names.
        given: from poses (..., 4, 4) to one array per argument.
        place: from poses to what is compared, (..., k); an angle as its cosine and sine.
        jacobian: from robot and positions to the task's Jacobian.
    """

    arguments: str
    given: Callable[[Array], tuple[Array, ...]]
    place: Callable[[Array], Array]
    jacobian: Callable[[Robot, Array], Array]

    def target(self, *given: Any) -> Array:
        """What is given, as it is compared: (N, k)."""
        named = dict(zip(self.arguments.split(), given, strict=True))
        if "pose" in named:
            return np.asarray(named["pose"])
        phi = named.pop("phi", None)
        angle = [] if phi is None else [np.cos(phi), np.sin(phi)]
        return np.stack([*named.values(), *angle], axis=-1)


def _along(*rows: int) -> Callable[[Array], tuple[Array, ...]]:
    return lambda pose: tuple(pose[..., row, 3] for row in rows)


def _turned(*rows: int) -> Callable[[Array], tuple[Array, ...]]:
    """Coordinates of the tool, and the angle phi of its x axis in the x-y plane."""
    return lambda pose: (*_along(*rows)(pose), np.arctan2(pose[..., 1, 0], pose[..., 0, 0]))


def _placed(*rows: int) -> Callable[[Array], Array]:
    return lambda pose: np.stack(_along(*rows)(pose), axis=-1)


def _placed_and_turned(*rows: int) -> Callable[[Array], Array]:
    return lambda pose: np.stack([*_along(*rows)(pose), pose[..., 0, 0], pose[..., 1, 0]], axis=-1)


def _rows(*rows: int) -> Callable[[Robot, Array], Array]:
    return lambda robot, q: kinematics.jacobian(robot, q)[:, list(rows)]


TASKS = {
    "inverse_kinematics_xy": Task("x y", _along(0, 1), _placed(0, 1), _rows(0, 1)),
    "inverse_kinematics_xyphi": Task(
        "x y phi", _turned(0, 1), _placed_and_turned(0, 1), planar_jacobian
    ),
    "inverse_kinematics_xyz": Task("x y z", _along(0, 1, 2), _placed(0, 1, 2), _rows(0, 1, 2)),
    "inverse_kinematics_xyzphi": Task(
        "x y z phi", _turned(0, 1, 2), _placed_and_turned(0, 1, 2), _rows(0, 1, 2, 5)
    ),
    "inverse_kinematics": Task("pose", lambda pose: (pose,), lambda pose: pose, _rows(*range(6))),
}
"""What is given, by quantity."""


def reached(robot: Robot, task: Task, solutions: Any) -> Array:
    """Where the tool is at joint positions (N, m, n); NaN for those that are no numbers."""
    flat = np.asarray(solutions, dtype=float).reshape(-1, robot.n)
    known = np.isfinite(flat).all(axis=1)
    poses = np.full((len(flat), 4, 4), np.nan)
    if known.any():
        poses[known] = kinematics.fk(robot, flat[known])
    places = task.place(poses)
    return places.reshape(*np.shape(solutions)[:-1], *places.shape[1:])


def as_solutions(robot: Robot, answers: Any) -> Array:
    """A hand formula's answers as (N, m, n), m >= 1, from one solution (N, n) or several.

    Raises:
        AnswerShapeError: answers of another shape.
    """
    values: Array = np.asarray(answers, dtype=float)
    if values.ndim == 2:
        values = values[:, None]
    if values.ndim != 3 or values.shape[2] != robot.n:
        raise AnswerShapeError(_shape_told(robot, np.shape(answers)[1:]))
    if not values.shape[1]:  # no row at any target: one that is no solution
        return np.full((len(values), 1, robot.n), np.nan)
    return values


def _shape_told(robot: Robot, shape: tuple[int, ...]) -> str:
    return (
        f"answered with shape {shape}; inverse kinematics has shape ({robot.n},), or "
        f"(m, {robot.n}) with a row for each solution"
    )


def _padded(robot: Robot, function: Callable[..., Any]) -> Callable[..., Any]:
    """A function's solutions of one target as rows of one number of them, the rest NaN.

    ``None``, no rows and an acos or a root that has no value are no solution.

    Raises:
        AnswerShapeError: (when called) an answer that is none of these.
    """

    @wraps(function)
    def padded(*state: Any) -> Array:
        rows = np.full((_MOST, robot.n), np.nan)
        try:
            answer = function(*state)
            found = _real(_as_array(robot, [] if answer is None else answer))
        except (ArithmeticError, ValueError) as problem:
            if isinstance(problem, ValueError) and not _DOMAIN.search(str(problem)):
                raise
            return rows
        if found.size:
            if not found.ndim:
                raise AnswerShapeError(_shape_told(robot, ()))
            solutions = as_solutions(robot, np.atleast_2d(found)[None])[0][:_MOST]
            rows[: len(solutions)] = solutions
        return rows

    return padded


def _as_array(robot: Robot, answer: Any) -> Array:
    """An answer's rows as an array.

    Raises:
        AnswerShapeError: rows of different lengths, or what is no number.
    """
    try:
        found = np.asarray(answer)
        return found if found.dtype.kind in "biufc" else found.astype(float)
    except (ValueError, TypeError):
        raise AnswerShapeError(
            f"answered with something else than rows of {robot.n} numbers; a solution that does "
            "not exist is left out, or is a row of nan"
        ) from None


def _real(answer: Array) -> Array:
    """Numbers of an answer; NaN for those that are complex, as a root of cmath's may be."""
    if np.iscomplexobj(answer):
        answer = np.where(np.isreal(answer), answer.real, np.nan)
    return np.asarray(answer, dtype=float)


def _furthest(task: Task, robot: Robot, answers: Any, engine: Array) -> Array:
    """Of the solutions of each state the place that is furthest off, as the engine has it."""
    if np.shape(answers) == engine.shape and not np.isfinite(answers).any():
        return np.asarray(answers)  # a function that failed
    solutions = as_solutions(robot, answers)
    none = ~np.isfinite(solutions).any(axis=2)
    places = reached(robot, task, solutions)
    gap = np.abs(places - engine[:, None]).reshape(*places.shape[:2], -1).max(axis=2)
    gap = np.where(np.isfinite(gap), gap, np.inf)
    # a row without any number is no solution; where there is none at all, the first stands for it
    gap = np.where(none, -1.0, gap)
    worst = np.argmax(gap, axis=1)
    found: Array = places[np.arange(len(places)), worst]
    return found


def row_by_row(rows: int, task: Task, robot: Robot, answers: Any, engine: Array) -> Array:
    """Of so many solutions of each state the places; what is given beyond is in the last one.

    A row that is no solution is where it should be, if another is one.

    Args:
        rows: how many.
        task: what is asked.
        robot: of whom.
        answers: solutions, (N, m, n).
        engine: the target of each of the rows, (N, rows, ...).
    """
    solutions = as_solutions(robot, answers)
    found = np.full(engine.shape, np.nan)
    most = min(rows - 1, solutions.shape[1] - 1)
    found[:, :most] = reached(robot, task, solutions[:, :most])
    found[:, most] = _furthest(task, robot, solutions[:, most:], engine[:, most])
    given: Any = np.isfinite(solutions).any(axis=2)
    none: Any = np.ones(engine.shape[:2], dtype=bool)
    none[:, :most], none[:, most] = ~given[:, :most], ~given[:, most:].any(axis=1)
    free = none & given.any(axis=1, keepdims=True)
    found[free] = engine[free]
    return found


def _sample(
    task: Task, robot: Robot, arguments: Any, count: int, rng: np.random.Generator
) -> tuple[Array, ...]:
    """Reachable targets: where Pinocchio finds the tool at random positions, none singular.

    The last quarter are near a singular pose, from closest to it on.
    """
    del arguments
    near = count // _NEAR_ONES
    kept, close, how_close = np.empty((0, robot.n)), np.empty((0, robot.n)), np.empty(0)
    for _ in range(_TRIES):
        q = positions(robot, 2 * count, rng)
        values = np.linalg.svd(task.jacobian(robot, q), compute_uv=False)
        ratio = values[:, -1] / values[:, 0]
        clear = ratio > _CLEAR
        kept = np.concatenate([kept, q[clear]])
        some = (ratio > TOLERANCES.near_singular) & ~clear
        close, how_close = np.concatenate([close, q[some]]), np.append(how_close, ratio[some])
        if len(kept) >= count and len(close) >= near:
            break
    if len(kept) < count:
        told = f"{robot.name}: singular everywhere in {task.arguments}; give another arm"
        raise StructureError(told)
    closest = close[np.argsort(how_close, kind="stable")[:near]]
    chosen = np.concatenate([kept[: count - len(closest)], closest])
    return task.given(kinematics.fk(robot, chosen))


def _engine(task: Task, robot: Robot, *given: Any) -> Array:
    """The targets themselves."""
    del robot
    return task.target(*given)


def _quantity(name: str, about: str, joints: int | None = None) -> Quantity:
    task = TASKS[name]
    return SERIAL.quantity(
        name,
        task.arguments,
        partial(_engine, task),
        about,
        joints=joints,
        sample=partial(_sample, task),
        read=partial(_furthest, task),
        asks=_padded,
    )


QUANTITIES = (
    _quantity("inverse_kinematics_xy", "q for x, y of the tool, one row per solution, (m, 2)", 2),
    _quantity("inverse_kinematics_xyphi", "q for x, y and phi in the plane, (m, 3)", 3),
    _quantity("inverse_kinematics_xyz", "q for x, y, z of the tool, (m, 3)", 3),
    _quantity("inverse_kinematics_xyzphi", "q for x, y, z and phi about z, (m, 4)", 4),
    _quantity("inverse_kinematics", "q for the tool's pose (4, 4), (m, n)"),
)
