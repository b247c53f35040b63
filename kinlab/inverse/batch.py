"""Inverse kinematics of many poses, on all processors."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.compiled import over_rows
from kinlab.inverse import kernel, methods
from kinlab.inverse.failed import failure, look_again
from kinlab.inverse.request import (
    RESTARTS,
    read_guess,
    read_targets,
    read_tolerances,
    require_robot,
    whole,
)
from kinlab.inverse.result import IKBatch, IKStatus
from kinlab.inverse.setup import STARTS, lm_numbers, rows_of, setup
from kinlab.inverse.verify import measure_all
from kinlab.robot import Robot

_GRAIN = 32
"""Poses worth handing to a thread: some 0.2 ms of work."""


def ik_batch(
    robot: Robot,
    Ts: ArrayLike,
    q0: ArrayLike | None = None,
    tol_position: float = 1e-6,
    tol_rotation: float = 1e-6,
    seed: int = 0,
    *,
    task: Any = "pose",
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
    require_robot(robot)
    targets = read_targets(robot, Ts)
    tolerances = read_tolerances(tol_position, tol_rotation)
    searches = 1 + whole(restarts, "restarts", 0)
    seed = whole(seed, "seed", 0)
    arm = setup(robot, rows_of(robot, task), seed, max(searches, STARTS))
    count = len(targets)
    remarks: list[str] = []
    guesses = arm.centre
    if q0 is not None:
        guesses, remarks = read_guess(robot, q0, count)
    iterations = methods.ITERATIONS["lm"]
    if max_iterations is not None:
        iterations = whole(max_iterations, "max_iterations", 1)
    flat = np.ascontiguousarray(targets[:, :3]).reshape(count, 12)
    q, outcome = np.empty((count, robot.n)), np.empty((count, 3), dtype=np.int64)
    errors = np.empty((count, 2))

    def verify(first: int, last: int) -> None:
        part = slice(first, last)
        ends = outcome[part, 0]
        failed = first + np.flatnonzero((ends != kernel.CONVERGED) & (ends != kernel.OUTSIDE))
        if len(failed):
            closest, codes = q[failed], outcome[failed, 0]
            look_again(arm, targets[failed], closest, codes, searches, tolerances)
            q[failed], outcome[failed, 0] = closest, codes
        measure_all(robot, q[part], targets[part], arm.weight, errors[part])

    over_rows(
        kernel.search_rows, count, *arm[:4], arm.wide, arm.weight,
        lm_numbers(arm.reach, tolerances, iterations, searches), arm.table, arm.starts, flat,
        guesses.reshape(-1, robot.n), q0 is not None, q, outcome,
        threads=threads, grain=_GRAIN, then=verify,
    )  # fmt: skip
    position, rotation = errors[:, 0].copy(), errors[:, 1].copy()
    met = (position <= tolerances[0]) & (rotation <= tolerances[1])
    success = met & (outcome[:, 0] != kernel.OUTSIDE)
    status = np.full(count, IKStatus.CONVERGED.value, dtype="<U24")
    for row in np.flatnonzero(~success):
        end, _, tried = outcome[row].tolist()
        status[row] = failure(
            robot, arm, targets[row], q[row], end, bool(met[row]), tried, tolerances[0]
        ).value
    return IKBatch(
        q, success, status, position, rotation, outcome[:, 1].copy(), outcome[:, 2] - 1,
        tuple(remarks),
    )  # fmt: skip
