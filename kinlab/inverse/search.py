"""Inverse kinematics by search, of one pose or many: one pipeline.

Read the request, search (compiled), bring what failed to rest, measure with Pinocchio, say how it
ended. :func:`ik` is this with one row; with another method than ``lm``, or a history, the search is
the readable one of :mod:`kinlab.inverse.methods`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, number, truth
from kinlab.engine.fast.compiled import kernel as compiled
from kinlab.engine.fast.stacks import jacobian
from kinlab.engine.fast.threads import over_rows
from kinlab.engine.kinematics import tool_poses
from kinlab.errors import OptionError
from kinlab.host.progress import takes_long
from kinlab.inverse import kernel, methods
from kinlab.inverse.branches.names import matching
from kinlab.inverse.branches.solutions import IKBranches, ik_branches
from kinlab.inverse.request import RESTARTS, Request, read_request
from kinlab.inverse.result import BRANCH, IKBatch, IKHistory, IKResult, IKStatus
from kinlab.inverse.setup import (
    ITERATIONS,
    PATIENCE,
    SETTLE,
    STARTS,
    Setup,
    beyond_reach,
    search_of,
    setup,
)
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_GRAIN = 32
"""Poses worth handing to a thread: some 0.2 ms of work."""

_MANY = 10
"""Searches that must all have come to rest before a pose is suspected to be unreachable."""

_ENDLESS, _LONG = 5, (200, 20)
"""Searches without limits, to see whether it is the limits that forbid a pose; their iterations and
patience, for at a singularity a search halves its error slowly."""

_FURTHER = 80
"""Searches more for a pose that has been met outside the limits only. Of 200,000 reachable poses
on ten arms 64 were missed without them."""


def ik(
    robot: ArmLike,
    T: ArrayLike,
    q0: ArrayLike | None = None,
    method: str = "lm",
    tol_position: float = 1e-6,
    tol_rotation: float = 1e-6,
    seed: int = 0,
    *,
    task: Any = "auto",
    restarts: int = RESTARTS,
    max_iterations: int | None = None,
    tol_step: float | None = None,
    alpha: str | float = "exact",
    history: bool = False,
    branch: str | None = None,
) -> IKResult:
    """Joint positions at which the tool is at T.

    The same arguments give the same answer, bit for bit. A failed search does not raise: look
    at ``success`` and ``status``.

    Args:
        robot: the robot.
        T: target of the tool in the base, (4, 4).
        q0: where to start, (n,); angles of the answer are the turns nearest to it. Left out,
            the search starts at the nearest of a table of states drawn with ``seed``.
        method: ``"lm"`` (damped, the default), ``"newton"`` (J^-1 or its right or left inverse)
            or ``"gradient"`` (J^T e).
        tol_position: metres, in the coordinates of the task.
        tol_rotation: radians, of the rotation vector log(R_d R^T) in the base's axes, in the
            coordinates of the task.
        seed: of the table of starts.
        task: a name of :data:`kinlab.analysis.structure.tasks.TASKS`, a mask of six booleans, or
            ``"auto"``: as many coordinates as the arm can move independently (the answer's
            ``task`` says which), and the rest of T too where one of the solutions is found to
            meet it. With ``"pose"``, an arm of fewer than six joints meets only those T on its
            way.
        restarts: searches after the first; from 10 up, a pose that is met outside the limits
            only gets further ones.
        max_iterations: of one search; left out, 60 (gradient: 5000).
        tol_step: also stop where ||q_{k+1} - q_k|| is below this, rad or m.
        alpha: for the gradient: ``"exact"`` (minimises the linearised error along the line), or
            a fixed number, in units where metres are divided by ``LENGTH`` of the arm.
        history: keep every iteration (the slow search over Pinocchio calls).
        branch: only solutions of this name, such as ``"shoulder left, elbow up"`` (words that are
            left out may be anything): one of :func:`kinlab.ik_branches`, within the limits where
            there is one, the nearest to q0. No search is made.

    Returns:
        The result, its errors measured by Pinocchio at the q in it.

    Raises:
        StateError: T not 4x4, not finite, not orthonormal, mirrored; q0 of the wrong shape.
        OptionError: a tolerance, number or task that cannot be had.
        NameUnknownError: no such method or task; no such branch (those of the pose are listed).
        StructureError: not a robot of one-degree-of-freedom joints.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    asked = read_request(
        robot, T, False, q0, tol_position, tol_rotation, seed, restarts, max_iterations
    )
    history = history is not False and truth(history, "history")
    if branch is not None:
        if not isinstance(task, str) or task not in ("pose", "auto") or history:
            raise OptionError("branch takes the whole pose: leave task and history out with it")
        return _on_branch(robot, asked, branch)
    arm, tolerance = setup(robot, task, asked.seed, max(asked.searches, STARTS)), asked.tolerances
    texts = isinstance(method, str) and isinstance(alpha, str)
    plain = texts and method == "lm" and alpha == "exact"
    record = None
    for one in (arm,) if arm.whole is None else (arm.whole, arm):
        if plain and not history and tol_step is None:
            q, outcome, errors = _search(robot, one, asked, 1)
        else:
            q, outcome, errors, record = _readable(robot, one, asked, method, alpha, tol_step)
        if one is not arm and _met(asked, outcome, errors)[0]:
            _measure(robot, q, asked.targets, arm.search.weight, errors)
            break
    end, iterations, searches = outcome[0].tolist()
    position, rotation = errors[0].tolist()
    status = IKStatus.CONVERGED
    if end == kernel.OUTSIDE or position > tolerance[0] or rotation > tolerance[1]:
        status = _why(robot, arm, asked, 0, q, outcome, errors)
    return IKResult(
        q[0],
        status is IKStatus.CONVERGED,
        status,
        position,
        rotation,
        iterations,
        searches - 1,
        asked.remarks,
        record if history else None,
        arm.task,
    )


@takes_long("inverse kinematics")
def ik_batch(
    robot: ArmLike,
    Ts: ArrayLike,
    q0: ArrayLike | None = None,
    tol_position: float = 1e-6,
    tol_rotation: float = 1e-6,
    seed: int = 0,
    *,
    task: Any = "auto",
    restarts: int = RESTARTS,
    max_iterations: int | None = None,
    threads: int | None = None,
) -> IKBatch:
    """Joint positions for many poses, by the damped method.

    Row i is what :func:`kinlab.ik` answers for pose i, bit for bit, whatever the number of
    threads and whatever the other poses are.

    Args:
        robot: the robot.
        Ts: targets, (N, 4, 4).
        q0: where to start, (n,) or (N, n).
        tol_position, tol_rotation, seed, task, restarts, max_iterations: as in
            :func:`kinlab.ik`.
        threads: how many; left out, as many as there are processors.

    Returns:
        Arrays with one row a pose; every success measured by Pinocchio.

    Raises:
        StateError, OptionError, NameUnknownError, StructureError: as :func:`kinlab.ik`; a bad
            pose is named by its row.
    """
    robot = as_robot(robot)
    asked = read_request(
        robot, Ts, True, q0, tol_position, tol_rotation, seed, restarts, max_iterations
    )
    arm = setup(robot, task, asked.seed, max(asked.searches, STARTS))
    q, outcome, errors = _search(robot, arm.whole or arm, asked, threads)
    success = _met(asked, outcome, errors)
    if arm.whole is not None:
        _measure(robot, q, asked.targets, arm.search.weight, errors)
        left = np.flatnonzero(~success)
        start = asked.start if asked.start is None or asked.start.ndim == 1 else asked.start[left]
        again = asked._replace(targets=asked.targets[left], start=start)
        q[left], outcome[left], errors[left] = _search(robot, arm, again, threads)
        success = _met(asked, outcome, errors)
    status = np.full(len(q), IKStatus.CONVERGED.value, dtype="<U24")
    for row in np.flatnonzero(~success):
        status[row] = _why(robot, arm, asked, int(row), q, outcome, errors).value
    return IKBatch(
        q,
        success,
        status,
        errors[:, 0].copy(),
        errors[:, 1].copy(),
        outcome[:, 1].copy(),
        outcome[:, 2] - 1,
        asked.remarks,
        arm.task,
    )


def _met(asked: Request, outcome: Any, errors: Array) -> Any:
    """Which rows are within the tolerances and the limits, (N,) of booleans."""
    return (errors <= asked.tolerances).all(axis=1) & (outcome[:, 0] != kernel.OUTSIDE)


def _search(
    robot: Robot, arm: Setup, asked: Request, threads: int | None
) -> tuple[Array, Any, Array]:
    """Searches for every target.

    Returns:
        q (N, n); how each ended, its iterations and searches, (N, 3); errors by Pinocchio, (N, 2).
    """
    count, n = len(asked.targets), robot.n
    iterations = ITERATIONS["lm"] if asked.iterations is None else asked.iterations
    problem = search_of(arm, asked.tolerances, iterations, asked.searches)
    # one layout, so that the kernel is compiled once for one pose and for many
    flat = np.ascontiguousarray(asked.targets[:, :3].reshape(count, 12))
    guesses = _guesses(arm, asked)
    q, outcome = np.empty((count, n)), np.empty((count, 3), dtype=np.int64)
    errors = np.empty((count, 2))
    arguments = (problem, flat, guesses, asked.start is not None, q, outcome)

    def verify(first: int, last: int) -> None:
        failed = first + np.flatnonzero(outcome[first:last, 0] > kernel.OUTSIDE)
        if len(failed):
            closest, codes = q[failed], outcome[failed, 0]
            _look_again(arm, asked, flat[failed], closest, codes)
            q[failed], outcome[failed, 0] = closest, codes
        _insist(arm, asked, flat, q, outcome, first, last)
        _measure(
            robot, q[first:last], asked.targets[first:last], arm.search.weight, errors[first:last]
        )

    if count == 1:  # the same without slices, which cost more than the search
        kernel.search_rows(*arguments, 0, 1)
        if outcome[0, 0] > kernel.OUTSIDE:
            _look_again(arm, asked, flat, q, outcome[:, 0])
        _insist(arm, asked, flat, q, outcome, 0, 1)
        _measure(robot, q, asked.targets, arm.search.weight, errors)
    else:
        over_rows(kernel.search_rows, count, *arguments, threads=threads, grain=_GRAIN, then=verify)
    return q, outcome, errors


def _readable(
    robot: Robot, arm: Setup, asked: Request, method: str, alpha: Any, tol_step: Any
) -> tuple[Array, Any, Array, IKHistory]:
    """As :func:`_search` for one target, over Pinocchio calls, with every iteration."""
    step = methods.choose(method, alpha)
    least = TOLERANCES.search_step
    if tol_step is not None:
        least = number(tol_step, "tol_step", above=0.0)
    iterations = ITERATIONS[method] if asked.iterations is None else asked.iterations
    problem = search_of(arm, asked.tolerances, iterations, asked.searches)
    problem = problem._replace(patience=PATIENCE[method])
    target = asked.targets[0]
    found, counts, history = methods.search(robot, arm, target, asked.start, step, problem, least)
    q, outcome = np.array(found)[np.newaxis], np.array([counts])
    if method == "lm":
        flat, ends = asked.targets[:, :3].reshape(1, 12), outcome.copy()
        if counts[0] > kernel.OUTSIDE:
            _look_again(arm, asked, flat, q, ends[:, 0])
        _insist(arm, asked, flat, q, ends, 0, 1)
        outcome[:, 0] = ends[:, 0]  # the counts are of what is in the history
    errors = np.empty((1, 2))
    _measure(robot, q, asked.targets, arm.search.weight, errors)
    return q, outcome, errors, history


def _anywhere(problem: kernel.Search) -> kernel.Search:
    """The same search from the last starts of the table on, wherever they are."""
    starts = np.ascontiguousarray(problem.starts[::-1])
    return problem._replace(table=np.zeros_like(problem.table), starts=starts)


def _guesses(arm: Setup, asked: Request) -> Array:
    """Where to start first, or what angles are preferred near to: (N or 1, n)."""
    return (arm.centre if asked.start is None else asked.start).reshape(-1, len(arm.centre))


def _look_again(arm: Setup, asked: Request, targets: Array, q: Array, ends: Any) -> None:
    """Brings failed rows to rest at the closest pose, or finds that only the limits forbid it.

    Args:
        arm, asked: what was searched.
        targets: (N, 12), of the failed rows.
        q: (N, n), the closest found, changed in place: to the point of rest, or, where a search
            without limits meets the tolerance, to that q.
        ends: (N,), the kernel's codes, changed in place: ``OUTSIDE`` where that happened.
    """
    iterations = ITERATIONS["lm"]
    kernel.settle_rows(
        search_of(arm, asked.tolerances, iterations, 1), SETTLE, targets, q, 0, len(q)
    )
    if asked.searches < _MANY:
        return
    free, outcome = np.empty_like(q), np.empty((len(q), 3), dtype=np.int64)
    endless = _anywhere(search_of(arm, asked.tolerances, _LONG[0], _ENDLESS, limited=False))
    endless = endless._replace(patience=_LONG[1])
    kernel.search_rows(endless, targets, q, True, free, outcome, 0, len(q))
    for row in np.flatnonzero(outcome[:, 0] == kernel.CONVERGED):
        inside = methods.wrap(arm, free[row])
        q[row], ends[row] = free[row], kernel.CONVERGED if inside else kernel.OUTSIDE


def _insist(
    arm: Setup, asked: Request, targets: Array, q: Array, outcome: Any, first: int, last: int
) -> None:
    """Searches on within the limits for what has been met outside them only.

    Near a limit the searches end beyond it many times over; further starts, anywhere, find most
    such poses, and only these rows pay for it.

    Args:
        arm, asked: what was searched. targets: (N, 12).
        q, outcome: (N, n) and (N, 3); rows first to last - 1 are changed where a search succeeds.
        first, last: range of rows.
    """
    if asked.searches < _MANY:
        return
    met = first + np.flatnonzero(outcome[first:last, 0] == kernel.OUTSIDE)
    far = (beyond_reach(arm, asked.targets[row], asked.tolerances[0]) for row in met)
    rows = met[~np.fromiter(far, dtype=np.bool_, count=len(met))]
    if not len(rows):
        return
    further = _anywhere(search_of(arm, asked.tolerances, ITERATIONS["lm"], _FURTHER))
    guesses = _guesses(arm, asked)
    near = np.ascontiguousarray(guesses[rows % len(guesses)])
    found, ends = np.empty((len(rows), q.shape[1])), np.empty((len(rows), 3), dtype=np.int64)
    goals = np.ascontiguousarray(targets[rows])
    kernel.search_rows(further, goals, near, False, found, ends, 0, len(rows))
    won = ends[:, 0] == kernel.CONVERGED
    q[rows[won]], outcome[rows[won], 0] = found[won], kernel.CONVERGED
    outcome[rows, 1:] += ends[:, 1:]


def _why(
    robot: Robot, arm: Setup, asked: Request, row: int, q: Array, outcome: Any, errors: Array
) -> IKStatus:
    """Why the search of one row did not succeed."""
    end = int(outcome[row, 0])
    if end == kernel.OUTSIDE and bool((errors[row] <= asked.tolerances).all()):
        return IKStatus.OUTSIDE_LIMITS
    if beyond_reach(arm, asked.targets[row], asked.tolerances[0]):
        return IKStatus.UNREACHABLE
    if end == kernel.RUNNING:
        return IKStatus.ITERATION_LIMIT
    if outcome[row, 2] >= _MANY:
        return IKStatus.UNREACHABLE
    rows = list(arm.rows)
    scaled = np.sqrt(arm.search.weight[rows])[:, None] * jacobian(robot, q[row])[rows]
    values = np.linalg.svd(scaled, compute_uv=False)
    lost = values[-1] <= TOLERANCES.rests_singular * values[0]
    return IKStatus.SINGULARITY if lost else IKStatus.LOCAL_MINIMUM


def _on_branch(robot: Robot, asked: Request, branch: str) -> IKResult:
    """The solution of a named branch, within the limits where there is one, nearest to q0.

    Args:
        robot: the robot. asked: one target. branch: a name, or some of its words.

    Raises:
        NameUnknownError: the pose has no such branch.
    """
    found: IKBranches = ik_branches(robot, asked.targets[0])
    rows = matching(branch, found.names, f"robot {robot.name!r}")
    near = np.clip(0.0, robot.lower, robot.upper) if asked.start is None else asked.start
    slides = ~np.any(jacobian(robot, near)[3:], axis=0)
    ways = []
    for row in rows:
        q = found.q[row].copy()
        # the whole turn of each angle that lies nearest to q0, as far as the limits allow
        turned = q + 2.0 * np.pi * np.round((near - q) / (2.0 * np.pi))
        allowed = ~slides & (turned >= robot.lower) & (turned <= robot.upper)
        q[allowed] = turned[allowed]
        ways.append((not found.within_limits[row], float(np.abs(q - near).max()), row, q))
    outside, _, row, q = min(ways, key=lambda way: way[:3])
    position, rotation = float(found.position_error[row]), float(found.rotation_error[row])
    status = IKStatus.OUTSIDE_LIMITS if outside else IKStatus.CONVERGED
    if position > asked.tolerances[0] or rotation > asked.tolerances[1]:
        status = IKStatus.LOCAL_MINIMUM
    return IKResult(
        q,
        status is IKStatus.CONVERGED,
        status,
        position,
        rotation,
        0,
        0,
        asked.remarks,
        task=BRANCH,
    )


@compiled
def task_errors(pose, target, weight):  # type: ignore[no-untyped-def]
    """Norms of the position and rotation error in the coordinates asked for.

    Args:
        pose, target: (4, 4).
        weight: (6,), zero for what is not asked for.

    Returns:
        metres, radians.
    """
    r, e = np.empty(9), np.empty(3)
    position, rotation = 0.0, 0.0
    for i in range(3):
        if weight[i] > 0.0:
            position += (target[i, 3] - pose[i, 3]) ** 2
        for j in range(3):
            r[3 * i + j] = (
                target[i, 0] * pose[j, 0] + target[i, 1] * pose[j, 1] + target[i, 2] * pose[j, 2]
            )
    kernel.rotation_vector(r, e)
    for i in range(3):
        if weight[3 + i] > 0.0:
            rotation += e[i] ** 2
    return math.sqrt(position), math.sqrt(rotation)


@compiled
def _errors_of_rows(poses, targets, weight, errors):  # type: ignore[no-untyped-def]
    for row in range(poses.shape[0]):
        errors[row, 0], errors[row, 1] = task_errors(poses[row], targets[row], weight)


def _measure(robot: Robot, q: Array, targets: Array, weight: Array, errors: Array) -> None:
    """Position and rotation error of each row, metres and radians, by Pinocchio: the last word.

    Args:
        robot: the robot. q: (N, n). targets: (N, 4, 4).
        weight: (6,), zero for coordinates not asked for. errors: (N, 2), written.
    """
    _errors_of_rows(tool_poses(robot, q), targets, weight, errors)
