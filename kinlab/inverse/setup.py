"""What a search needs to know about an arm and a task, worked out once and kept."""

from __future__ import annotations

import math
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from kinlab.analysis.structure.task_space import ENDLESS, TaskSpace, read_task
from kinlab.analysis.structure.tasks import TASKS, require_task, task_rows
from kinlab.arrays import Array, seed_of
from kinlab.engine.fast.arrays import chain
from kinlab.engine.fast.stacks import fk, jacobian
from kinlab.inverse.kernel import Search
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

STARTS = 256
"""States in the table of starts. From 64 to 256 the mean number of iterations falls by a tenth to
a quarter; beyond, looking the nearest one up costs more than it saves."""

WIDE = 1.6 * math.pi
"""Revolute joints with at least this range stay free inside the iteration. Measured on ten arms:
holding wider ones at their limits makes dead ends (Stanford needs twice the iterations)."""

LENGTH = 0.35
"""Length that divides metres beside radians, as a share of the arm's; flat from 0.25 to 0.5."""

DAMPING = 0.1
"""mu = DAMPING * E + damping_floor; from 0.03 to 0.3 the number of iterations is flat."""

SETTLE = 100
"""Iterations at most to bring a failed search to rest, for the closest pose."""

ITERATIONS = {"newton": 60, "gradient": 5000, "lm": 60}
"""Iterations of one search, where the caller sets none."""

PATIENCE = {"newton": 10, "gradient": 1000, "lm": 5}
"""A search whose squared error has not halved in so many iterations has stalled."""

_KEPT = 16


class Setup(NamedTuple):
    """What is kept of one arm, task and seed; do not write to the arrays.

    Attributes:
        search: what every search works with; a call's own numbers come in by :func:`search_of`.
        centre: angles are wrapped to within half a turn of this, (n,); within the limits.
        rows: the task's rows. task: its name.
        whole: the same arm with the whole pose as its task, which is tried first, where kinlab
            chose the task and it is less.
        kept: the searches made of it (:func:`search_of`).
    """

    search: Search
    centre: Array
    rows: tuple[int, ...]
    task: str
    whole: Setup | None
    kept: dict[Any, Search]


_SETUPS: WeakKeyDictionary[Robot, dict[Any, Setup]] = WeakKeyDictionary()


def setup(robot: Robot, task: Any, seed: int, starts: int = STARTS) -> Setup:
    """The arrays for one arm, task and seed.

    Args:
        robot: the arm.
        task: as in :func:`kinlab.ik`.
        seed: of the table of starts.
        starts: how many at least.

    Raises:
        NameUnknownError: no task of that name.
        OptionError: a task with coordinates that the arm cannot move independently. The full
            pose is exempt: it is the comparison with a whole T, and an arm with fewer joints
            meets those T that lie on its own way.
    """
    kept = _SETUPS.get(robot)
    if kept is None:
        kept = _SETUPS[robot] = {}
    named = task is None or isinstance(task, str)
    key = (task if named else task_rows(task), seed, max(starts, STARTS))
    found = kept.get(key)
    if found is None:
        if len(kept) >= _KEPT:
            kept.clear()
        space = read_task(robot, task)
        found = kept[key] = _work_out(robot, space, *key[1:])
        if space.suggested and space.m < 6:
            found = kept[key] = found._replace(whole=setup(robot, "pose", seed, starts))
    return found


def _work_out(robot: Robot, space: TaskSpace, seed: int, count: int) -> Setup:
    rows = space.rows
    fixed, prismatic = chain(robot)
    k, n = len(prismatic), robot.n
    slides = np.zeros(n, dtype=np.bool_)
    slides[:k] = prismatic
    lower = np.where(robot.lower < -ENDLESS, -np.inf, robot.lower)
    upper = np.where(robot.upper > ENDLESS, np.inf, robot.upper)
    rigid = float(np.linalg.norm(fixed[1:, [3, 7, 11]], axis=1).sum())
    low, high = _window(lower, upper, slides, max(rigid, 1.0))
    sample = np.random.default_rng(seed_of(seed)).uniform(low, high, (count, n))
    if rows != TASKS["pose"]:
        require_task(rows, jacobian(robot, sample[:8]), f"robot {robot.name!r}")
    travel = np.maximum(np.abs(lower), np.abs(upper))[slides].sum()
    reach = rigid + float(travel)
    size = rigid + float((high - low)[slides].sum())
    length = LENGTH * size if size > 0.0 else 1.0
    weight = np.zeros(6)
    weight[list(rows)] = 1.0
    weight[:3] /= length**2
    poses = fk(robot, sample)[:, :3, :].reshape(count, 12)
    search = Search(
        fixed,
        prismatic,
        lower,
        upper,
        ~slides & (upper - lower >= WIDE),
        weight,
        np.ascontiguousarray(poses.T),
        sample,
        np.zeros(2),
        DAMPING,
        TOLERANCES.damping_floor,
        ITERATIONS["lm"],
        1,
        PATIENCE["lm"],
        reach,
    )
    return Setup(search, np.clip(0.0, lower, upper), rows, space.name, None, {})


def _window(lower: Array, upper: Array, slides: Any, length: float) -> tuple[Array, Array]:
    """Where to draw starts from: one turn at most, and a finite stretch of an endless slide."""
    half = np.where(slides, length, math.pi)
    middle = np.clip(0.0, np.minimum(lower + half, upper), np.maximum(upper - half, lower))
    return np.maximum(lower, middle - half), np.minimum(upper, middle + half)


def search_of(
    arm: Setup,
    tolerances: tuple[float, float],
    iterations: int,
    searches: int,
    limited: bool = True,
) -> Search:
    """The compiled search of one arm and task.

    Args:
        arm: the arm. tolerances: metres, radians. iterations: of one search. searches: how many.
        limited: whether the limits hold; without them every joint is free.
    """
    key = (tolerances, iterations, searches, limited)
    kept = arm.kept.get(key)
    if kept is not None:
        return kept
    found = arm.search._replace(
        tolerances=np.array(tolerances), iterations=iterations, searches=searches
    )
    if not limited:
        none, free = np.full_like(arm.centre, np.inf), np.ones(len(arm.centre), dtype=np.bool_)
        found = found._replace(lower=-none, upper=none, wide=free)
    if len(arm.kept) >= _KEPT:
        arm.kept.clear()
    arm.kept[key] = found
    return found


def beyond_reach(arm: Setup, target: Array, tolerance: float) -> bool:
    """Whether the target is farther from the first joint than the arm is long."""
    asked = arm.search.weight[:3] > 0.0
    away = (target[:3, 3] - arm.search.fixed[0, [3, 7, 11]])[asked]
    return float(np.linalg.norm(away)) > arm.search.reach + tolerance
