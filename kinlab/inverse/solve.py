"""The readable search over Pinocchio calls: any method, every iteration on record.

It follows :mod:`kinlab.inverse.kernel` line by line and is its oracle: with ``lm`` both visit the
same states.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinlab.arrays import Array
from kinlab.inverse import kernel, kernel_parts
from kinlab.inverse.methods import Step
from kinlab.inverse.result import IKHistory
from kinlab.inverse.setup import Setup, beyond_reach
from kinlab.robot import Robot
from kinlab.stacks import fk, jacobian

_RUNAWAY = 1e6
"""Radians (or lengths of the arm) in one step, beyond which q has lost its digits."""


class Limits(NamedTuple):
    """When a search stops.

    Attributes:
        position, rotation: tolerances, metres and radians: ||x_d - f(q)|| < eps.
        step: ||q_{k+1} - q_k|| < eps, the note's other rule.
        iterations: of one search.
        searches: how many.
        patience: iterations in which the squared error must halve.
    """

    position: float
    rotation: float
    step: float
    iterations: int
    searches: int
    patience: int


class Outcome(NamedTuple):
    """As the kernel's: q, how it ended (its codes), iterations, searches; and the record."""

    q: Array
    end: int
    iterations: int
    searches: int
    history: IKHistory


def search(
    robot: Robot, arm: Setup, target: Array, q0: Array | None, step: Step, limits: Limits
) -> Outcome:
    """Searches from q0 and then from the starts nearest to the target, until one succeeds.

    Args:
        robot: the robot.
        arm: its arrays for this task.
        target: (4, 4).
        q0: (n,), where to start first, within the limits; ``None``: at the nearest start.
        step: the method.
        limits: when to stop.
    """
    record: list[tuple[Array, float, float, int]] = []
    best, best_q, best_end = math.inf, arm.centre, kernel.STALLED
    distance = np.empty(len(arm.starts))
    kernel_parts.nearest(arm.table, target[:3].ravel(), arm.weight, distance)
    tries = 1 if beyond_reach(arm, target, limits.position) else limits.searches
    tried = 0
    while tried < tries:
        if tried == 0 and q0 is not None:
            q = q0.copy()
        else:
            choice = int(np.argmin(distance))
            distance[choice] = math.inf
            q = arm.starts[choice].copy()
        end, q = _one_search(robot, arm, target, q, q0, step, limits, tried, record)
        tried += 1
        if end == kernel.CONVERGED:
            best_q, best_end = q, end
            break
        if end == kernel.OUTSIDE:
            if best_end != kernel.OUTSIDE:
                best, best_q, best_end = 0.0, q, end
        elif best_end != kernel.OUTSIDE:
            _wrap(arm, q, q0)
            q = np.clip(q, arm.lower, arm.upper)
            energy = _energy(_weighted(arm, _error(robot, q, target)))
            if energy < best:
                best, best_q, best_end = energy, q, end
    return Outcome(best_q, best_end, len(record), tried, _history(record, robot.n))


def _one_search(
    robot: Robot,
    arm: Setup,
    target: Array,
    q: Array,
    q0: Array | None,
    step: Step,
    limits: Limits,
    number: int,
    record: list[tuple[Array, float, float, int]],
) -> tuple[int, Array]:
    """One search from one start: how it ended (the kernel's codes), and where."""
    rows = list(arm.rows)
    partly = 0 < len([i for i in rows if i > 2]) < 3
    scale = np.sqrt(arm.weight[rows])
    free = arm.wide.copy()
    mark = math.inf
    outside: Array | None = None
    for count in range(limits.iterations):
        error = _error(robot, q, target)
        asked = np.where(arm.weight > 0.0, error, 0.0)
        position, rotation = float(np.linalg.norm(asked[:3])), float(np.linalg.norm(asked[3:]))
        record.append((q.copy(), position, rotation, number))
        if position <= 0.99 * limits.position and rotation <= 0.99 * limits.rotation:
            if _wrap(arm, q, q0):
                return kernel.CONVERGED, q
            if outside is not None:
                break
            outside = q.copy()  # put it back onto the limits and go on, once
            free &= (q >= arm.lower) & (q <= arm.upper)
            q = np.clip(q, arm.lower, arm.upper)
            mark = math.inf
            continue
        energy = _energy(_weighted(arm, error))
        if count % limits.patience == limits.patience - 1:
            if energy > 0.5 * mark:
                return (kernel.STALLED, q) if outside is None else (kernel.OUTSIDE, outside)
            mark = energy
        jac = jacobian(robot, q)
        if partly:
            kernel_parts.turn_rows(jac, error, robot.n)
        jac, e = scale[:, None] * jac[rows], scale * error[rows]
        slope = jac.T @ e
        held = ~free & (((q >= arm.upper) & (slope > 0)) | ((q <= arm.lower) & (slope < 0)))
        change = np.zeros(robot.n)
        try:
            change[~held] = step(jac[:, ~held], e)
        except np.linalg.LinAlgError:  # exactly singular: Newton has no step here
            break
        size = float(np.linalg.norm(change))
        if not size <= _RUNAWAY:
            break
        q = q + change
        q = np.where(free, q, np.clip(q, arm.lower, arm.upper))
        if size < limits.step:
            break
    else:
        return (kernel.RUNNING, q) if outside is None else (kernel.OUTSIDE, outside)
    return (kernel.STALLED, q) if outside is None else (kernel.OUTSIDE, outside)


def _error(robot: Robot, q: Array, target: Array) -> Array:
    """(p_d - p, log(R_d R^T)) in the base's axes, (6,)."""
    error, turned = np.empty(6), np.empty(9)
    kernel_parts.pose_error(fk(robot, q)[:3].ravel(), target[:3].ravel(), turned, error)
    return error


def _weighted(arm: Setup, error: Array) -> Array:
    return np.asarray(np.sqrt(arm.weight) * error)


def _energy(error: Array) -> float:
    return 0.5 * float(error @ error)


def _wrap(arm: Setup, q: Array, q0: Array | None) -> bool:
    centre = arm.centre if q0 is None else q0
    return bool(kernel_parts.wrap(arm.prismatic, arm.lower, arm.upper, centre, q))


def _history(record: list[tuple[Array, float, float, int]], n: int) -> IKHistory:
    return IKHistory(
        np.array([r[0] for r in record]).reshape(-1, n),
        np.array([r[1] for r in record]),
        np.array([r[2] for r in record]),
        np.array([r[3] for r in record], dtype=np.int64),
    )
