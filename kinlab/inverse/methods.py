"""The readable search: one step of each method, and searches over Pinocchio calls on record.

Each step takes the Jacobian (r, m) of the r coordinates asked for and the m joints that may
move, and the error e (r,) = x_d - f(q), and gives the change of q. Metres are divided by a length
of the arm in both. :func:`search` follows :mod:`kinlab.inverse.kernel` line by line and is its
oracle: with ``lm`` both visit the same states.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from kinlab.arrays import Array, real_array
from kinlab.engine.fast.stacks import fk, jacobian
from kinlab.errors import NameUnknownError, OptionError, near
from kinlab.inverse import kernel
from kinlab.inverse.result import IKHistory
from kinlab.inverse.setup import DAMPING, Setup, beyond_reach
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_RUNAWAY = 1e6
"""Radians (or lengths of the arm) in one step, beyond which q has lost its digits."""


Step = Callable[[Array, Array], Array]


def newton(jac: Array, error: Array) -> Array:
    """dq = J^-1 e; with the right or left inverse where J is not square (note 000, 000.newton).

    A redundant arm (m > r) takes J^T (J J^T)^-1, the smallest dq; one with fewer joints than
    coordinates (m < r) takes (J^T J)^-1 J^T, the least squares. The note prints the second for
    the redundant case (000.pinv).

    Raises:
        numpy.linalg.LinAlgError: J is exactly singular.
    """
    r, m = jac.shape
    if r == m:
        return _solve(jac, error)
    if r < m:
        return jac.T @ _solve(jac @ jac.T, error)
    return _solve(jac.T @ jac, jac.T @ error)


def gradient(jac: Array, error: Array, alpha: float) -> Array:
    """dq = alpha J^T e, the gradient of ||e||^2 / 2 with a fixed step (note 000, 000.grad).

    It descends where alpha < 2 / sigma_max(J)^2.
    """
    return alpha * (jac.T @ error)


def gradient_exact(jac: Array, error: Array) -> Array:
    """dq = alpha J^T e with the alpha that minimises ||e - alpha J J^T e|| along the line.

    alpha = <e, J J^T e> / ||J J^T e||^2 (Buss 2004, "Introduction to inverse kinematics with
    Jacobian transpose, pseudoinverse and damped least squares methods", section 4).
    """
    downhill = jac.T @ error
    motion = jac @ downhill
    square = float(motion @ motion)
    return downhill * (float(error @ motion) / square) if square > 0.0 else downhill


def lm(jac: Array, error: Array) -> Array:
    """(J^T J + mu 1) dq = J^T e with mu = DAMPING ||e||^2 / 2 + damping_floor (Sugihara 2011)."""
    damped = jac.T @ jac
    mu = 0.5 * DAMPING * float(error @ error) + TOLERANCES.damping_floor
    damped[np.diag_indices_from(damped)] += mu
    return _solve(damped, jac.T @ error)


def _solve(matrix: Array, right: Array) -> Array:
    solution: Any = np.linalg.solve(matrix, right)  # numpy's stub loses the float64
    return np.asarray(solution)


METHODS: dict[str, Step] = {"newton": newton, "gradient": gradient_exact, "lm": lm}
"""Name to step; ``gradient`` with a fixed alpha is made by :func:`choose`."""


def choose(method: Any, alpha: Any) -> Step:
    """The step function of a method.

    Args:
        method: ``"lm"``, ``"newton"`` or ``"gradient"``.
        alpha: for the gradient: ``"exact"``, or a fixed positive number.

    Raises:
        NameUnknownError: another method.
        OptionError: an alpha that is neither, or one given to another method.
    """
    if not isinstance(method, str) or method not in METHODS:
        raise NameUnknownError(f"method {method!r} is unknown; {near(str(method), METHODS)}")
    if isinstance(alpha, str) and alpha == "exact":
        return METHODS[method]
    if method != "gradient":
        raise OptionError(f"alpha belongs to method 'gradient'; leave it out for {method!r}")
    if isinstance(alpha, (str, bool)):
        raise OptionError(f"alpha is {alpha!r}; give 'exact' or a positive number")
    value = real_array(alpha, "alpha", OptionError)
    if value.shape != () or not 0.0 < float(value) < math.inf:
        raise OptionError(f"alpha is {alpha!r}; give 'exact' or a positive number")
    return partial(gradient, alpha=float(value))


def search(
    robot: Robot,
    arm: Setup,
    target: Array,
    q0: Array | None,
    step: Step,
    problem: kernel.Search,
    least: float,
) -> tuple[Array, tuple[int, int, int], IKHistory]:
    """Searches from q0, the starts nearest to the target, and others, until one succeeds.

    Args:
        robot: the robot.
        arm: what is kept of it for this task.
        target: (4, 4).
        q0: (n,), where to start first, within the limits; ``None``: at the nearest start.
        step: the method.
        problem: what a search works with, and when it stops: ||x_d - f(q)|| below the tolerances.
        least: the note's other rule, ||q_{k+1} - q_k|| < least, rad or m.

    Returns:
        As the kernel: q; how it ended (its codes), iterations, searches; and the record.
    """
    record: list[tuple[Array, float, float, int]] = []
    best, best_q, best_end = math.inf, arm.centre, kernel.STALLED
    distance = np.empty(len(problem.starts))
    kernel.nearest(problem.table, target[:3].ravel(), problem.weight, distance)
    tries = 1 if beyond_reach(arm, target, problem.tolerances[0]) else problem.searches
    tried = 0
    while tried < tries:
        if tried == 0 and q0 is not None:
            q = q0.copy()
        else:
            if tried == kernel.NEAREST:
                distance[np.isfinite(distance)] = 0.0
            choice = int(np.argmin(distance))
            distance[choice] = math.inf
            q = problem.starts[choice].copy()
        end, q = _one_search(robot, arm, target, q, q0, step, problem, least, tried, record)
        tried += 1
        if end == kernel.CONVERGED:
            best_q, best_end = q, end
            break
        if end == kernel.OUTSIDE:
            if best_end != kernel.OUTSIDE:
                best, best_q, best_end = 0.0, q, end
        elif best_end != kernel.OUTSIDE:
            wrap(arm, q, q0)
            q = np.clip(q, problem.lower, problem.upper)
            energy = _energy(_weighted(problem, pose_error(fk(robot, q), target)))
            if energy < best:
                best, best_q, best_end = energy, q, end
    return best_q, (best_end, len(record), tried), _history(record, robot.n)


def _one_search(
    robot: Robot,
    arm: Setup,
    target: Array,
    q: Array,
    q0: Array | None,
    step: Step,
    problem: kernel.Search,
    least: float,
    number: int,
    record: list[tuple[Array, float, float, int]],
) -> tuple[int, Array]:
    """One search from one start: how it ended (the kernel's codes), and where."""
    rows = list(arm.rows)
    partly = 0 < len([i for i in rows if i > 2]) < 3
    scale = np.sqrt(problem.weight[rows])
    free = problem.wide.copy()
    mark, tolerance = math.inf, problem.tolerances
    outside: Array | None = None
    for count in range(problem.iterations):
        error = pose_error(fk(robot, q), target)
        asked = np.where(problem.weight > 0.0, error, 0.0)
        position, rotation = float(np.linalg.norm(asked[:3])), float(np.linalg.norm(asked[3:]))
        record.append((q.copy(), position, rotation, number))
        if position <= 0.99 * tolerance[0] and rotation <= 0.99 * tolerance[1]:
            if wrap(arm, q, q0):
                return kernel.CONVERGED, q
            if outside is not None:
                break
            outside = q.copy()  # put it back onto the limits and go on, once
            free &= (q >= problem.lower) & (q <= problem.upper)
            q = np.clip(q, problem.lower, problem.upper)
            mark = math.inf
            continue
        energy = _energy(_weighted(problem, error))
        if count % problem.patience == problem.patience - 1:
            if energy > 0.5 * mark:
                return (kernel.STALLED, q) if outside is None else (kernel.OUTSIDE, outside)
            mark = energy
        jac = jacobian(robot, q)
        if partly:
            kernel.turn_rows(jac, error, robot.n)
        jac, e = scale[:, None] * jac[rows], scale * error[rows]
        slope = jac.T @ e
        held = ~free & (((q >= problem.upper) & (slope > 0)) | ((q <= problem.lower) & (slope < 0)))
        change = np.zeros(robot.n)
        try:
            change[~held] = step(jac[:, ~held], e)
        except np.linalg.LinAlgError:  # exactly singular: Newton has no step here
            break
        size = float(np.linalg.norm(change))
        if not size <= _RUNAWAY:
            break
        q = q + change
        q = np.where(free, q, np.clip(q, problem.lower, problem.upper))
        if size < least:
            break
    else:
        return (kernel.RUNNING, q) if outside is None else (kernel.OUTSIDE, outside)
    return (kernel.STALLED, q) if outside is None else (kernel.OUTSIDE, outside)


def pose_error(here: Array, goal: Array) -> Array:
    """(p_d - p, log(R_d R^T)) in the base's axes, (6,), between two poses (4, 4)."""
    error, turned = np.empty(6), np.empty(9)
    kernel.pose_error(here[:3].ravel(), goal[:3].ravel(), turned, error)
    return error


def _weighted(problem: kernel.Search, error: Array) -> Array:
    return np.asarray(np.sqrt(problem.weight) * error)


def _energy(error: Array) -> float:
    return 0.5 * float(error @ error)


def wrap(arm: Setup, q: Array, q0: Array | None = None) -> bool:
    """:func:`kinlab.inverse.kernel.wrap` into the arm's limits, as near to q0 as they allow."""
    known, centre = arm.search, arm.centre if q0 is None else q0
    return bool(kernel.wrap(known.prismatic, known.lower, known.upper, centre, q))


def _history(record: list[tuple[Array, float, float, int]], n: int) -> IKHistory:
    return IKHistory(
        np.array([r[0] for r in record]).reshape(-1, n),
        np.array([r[1] for r in record]),
        np.array([r[2] for r in record]),
        np.array([r[3] for r in record], dtype=np.int64),
    )
