"""After a search that failed: the closest pose, a look past the limits, and a reason."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.inverse import kernel, kernel_parts, methods
from kinlab.inverse.result import IKStatus
from kinlab.inverse.setup import Setup, beyond_reach, lm_numbers
from kinlab.robot import Robot
from kinlab.stacks import jacobian

_MANY = 10
"""Searches that must all have come to rest before a pose is suspected to be unreachable; and
searches without limits, to see whether it is the limits that forbid it."""

_SINGULAR = 1e-3
"""sigma_min / sigma_max of J, metres over the arm's length, below which a rest is at a
singularity."""


def look_again(
    arm: Setup, targets: Array, q: Array, ends: Any, searches: int, tolerances: tuple[float, float]
) -> None:
    """Brings failed rows to rest at the closest pose, or finds that only the limits forbid it.

    Args:
        arm: what was searched.
        targets: (N, 4, 4).
        q: (N, n), the closest found, changed in place: to the point of rest, or, where a search
            without limits meets the tolerance, to that q.
        ends: (N,), the kernel's codes, changed in place: ``OUTSIDE`` where that happened.
        searches: how many there were at most; after few, nothing is looked for past the limits.
        tolerances: metres and radians.
    """
    flat = np.ascontiguousarray(targets[:, :3]).reshape(len(targets), 12)
    kernel.settle_rows(*arm[:4], arm.weight, methods.SETTLE, flat, q, 0, len(q))
    if searches < _MANY:
        return
    n = q.shape[1]
    endless = np.full(n, np.inf)
    free, outcome = np.empty_like(q), np.empty((len(q), 3), dtype=np.int64)
    kernel.search_rows(
        arm.fixed, arm.prismatic, -endless, endless, np.ones(n, dtype=np.bool_), arm.weight,
        lm_numbers(arm.reach, tolerances, methods.ITERATIONS["lm"], _MANY), arm.table, arm.starts,
        flat, q, True, free, outcome, 0, len(q),
    )  # fmt: skip
    for row in np.flatnonzero(outcome[:, 0] == kernel.CONVERGED):
        inside = kernel_parts.wrap(arm.prismatic, arm.lower, arm.upper, arm.centre, free[row])
        q[row], ends[row] = free[row], kernel.CONVERGED if inside else kernel.OUTSIDE


def failure(
    robot: Robot,
    arm: Setup,
    target: Array,
    q: Array,
    end: int,
    met: bool,
    searches: int,
    tolerance: float,
) -> IKStatus:
    """Why a search did not succeed.

    Args:
        robot, arm, target: what was asked.
        q: the closest found. end: the kernel's code. met: whether Pinocchio's errors are within
            tolerance at q. searches: how many were made. tolerance: metres.
    """
    if end == kernel.OUTSIDE and met:
        return IKStatus.OUTSIDE_LIMITS
    if beyond_reach(arm, target, tolerance):
        return IKStatus.UNREACHABLE
    if end == kernel.RUNNING:
        return IKStatus.ITERATION_LIMIT
    if searches >= _MANY:
        return IKStatus.UNREACHABLE
    rows = list(arm.rows)
    scaled = np.sqrt(arm.weight[rows])[:, None] * jacobian(robot, q)[rows]
    values = np.linalg.svd(scaled, compute_uv=False)
    lost = values[-1] <= _SINGULAR * values[0]
    return IKStatus.SINGULARITY if lost else IKStatus.LOCAL_MINIMUM
