"""Inverse kinematics of one pose."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.errors import OptionError
from kinlab.inverse import kernel, methods, solve
from kinlab.inverse.chosen import on_branch
from kinlab.inverse.failed import failure, look_again
from kinlab.inverse.request import (
    RESTARTS,
    positive,
    read_guess,
    read_target,
    read_tolerances,
    require_robot,
    whole,
)
from kinlab.inverse.result import IKHistory, IKResult, IKStatus
from kinlab.inverse.setup import STARTS, Setup, lm_numbers, rows_of, setup
from kinlab.inverse.verify import measure
from kinlab.robot import Robot

TOL_STEP = 1e-13
"""||q_{k+1} - q_k|| below which the readable search stops, where the caller gives none."""


def ik(
    robot: Robot,
    T: ArrayLike,
    q0: ArrayLike | None = None,
    method: str = "lm",
    tol_position: float = 1e-6,
    tol_rotation: float = 1e-6,
    seed: int = 0,
    *,
    task: Any = "pose",
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
        task: a name of :data:`kinlab.structure.tasks.TASKS`, a mask of six booleans, or ``"auto"``.
            With ``"pose"``, an arm of fewer than six joints meets only those T on its way.
        restarts: searches after the first.
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
    require_robot(robot)
    target = read_target(robot, T)
    tolerances = read_tolerances(tol_position, tol_rotation)
    searches = 1 + whole(restarts, "restarts", 0)
    seed = whole(seed, "seed", 0)
    step = methods.choose(method, alpha)
    if branch is not None:
        if not isinstance(task, str) or task not in ("pose", "auto") or history:
            raise OptionError("branch takes the whole pose: leave task and history out with it")
        return on_branch(robot, target, branch, q0, tolerances)
    arm = setup(robot, rows_of(robot, task), seed, max(searches, STARTS))
    remarks: list[str] = []
    start: Array | None = None
    if q0 is not None:
        start, remarks = read_guess(robot, q0)
    if max_iterations is None:
        iterations = methods.ITERATIONS[method]
    else:
        iterations = whole(max_iterations, "max_iterations", 1)
    if method == "lm" and not history and tol_step is None:
        numbers = lm_numbers(arm.reach, tolerances, iterations, searches)
        q, outcome = np.empty((1, robot.n)), np.empty((1, 3), dtype=np.int64)
        guess = arm.centre if start is None else start
        kernel.search_rows(
            *arm[:4], arm.wide, arm.weight, numbers, arm.table, arm.starts,
            target[:3].reshape(1, 12), guess.reshape(1, -1), start is not None, q, outcome, 0, 1,
        )  # fmt: skip
        end, steps, tried = outcome[0].tolist()
        return _finish(robot, arm, target, tolerances, True, q[0], end, steps, tried, remarks, None)
    limits = solve.Limits(
        *tolerances,
        TOL_STEP if tol_step is None else positive(tol_step, "tol_step"),
        iterations,
        searches,
        methods.PATIENCE[method],
    )
    answer = solve.search(robot, arm, target, start, step, limits)
    record = answer.history if history else None
    return _finish(
        robot, arm, target, tolerances, method == "lm", np.array(answer.q), answer.end,
        answer.iterations, answer.searches, remarks, record,
    )  # fmt: skip


def _finish(
    robot: Robot,
    arm: Setup,
    target: Array,
    tolerances: tuple[float, float],
    settle: bool,
    q: Array,
    end: int,
    iterations: int,
    searches: int,
    remarks: list[str],
    record: IKHistory | None,
) -> IKResult:
    """Brings a failed damped search to rest, measures with Pinocchio, says what it is."""
    if settle and end not in (kernel.CONVERGED, kernel.OUTSIDE):
        ends = np.array([end])
        look_again(arm, target[np.newaxis], q[np.newaxis], ends, searches, tolerances)
        end = int(ends[0])
    position, rotation = measure(robot, q, target, arm.weight)
    met = position <= tolerances[0] and rotation <= tolerances[1]
    status = IKStatus.CONVERGED
    if end == kernel.OUTSIDE or not met:
        status = failure(robot, arm, target, q, end, met, searches, tolerances[0])
    return IKResult(
        q, status is IKStatus.CONVERGED, status, position, rotation, iterations, searches - 1,
        tuple(remarks), record,
    )  # fmt: skip
