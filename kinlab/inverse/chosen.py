"""Inverse kinematics on a branch that was named."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.inverse.branch_names import matching
from kinlab.inverse.branches import IKBranches, ik_branches
from kinlab.inverse.request import read_guess
from kinlab.inverse.result import IKResult, IKStatus
from kinlab.kinematics import jacobian
from kinlab.robot import Robot


def on_branch(
    robot: Robot,
    target: Array,
    branch: str,
    q0: ArrayLike | None,
    tolerances: tuple[float, float],
) -> IKResult:
    """The solution of a named branch, within the limits where there is one, nearest to q0.

    Args:
        robot: the robot. target: (4, 4). branch: a name, or some of its words.
        q0: (n,), or ``None`` for the middle nearest to zero.
        tolerances: metres and radians.

    Raises:
        NameUnknownError: the pose has no such branch.
    """
    found: IKBranches = ik_branches(robot, target)
    rows = matching(branch, found.names, f"robot {robot.name!r}")
    remarks: list[str] = []
    near = np.clip(0.0, robot.lower, robot.upper)
    if q0 is not None:
        near, remarks = read_guess(robot, q0)
    slides = ~np.any(jacobian(robot, near)[3:], axis=0)
    best: Any = None
    for row in rows:
        q = found.q[row].copy()
        # the whole turn of each angle that lies nearest to q0, as far as the limits allow
        turned = q + 2.0 * np.pi * np.round((near - q) / (2.0 * np.pi))
        allowed = ~slides & (turned >= robot.lower) & (turned <= robot.upper)
        q[allowed] = turned[allowed]
        key = (not found.within_limits[row], float(np.abs(q - near).max()), row)
        if best is None or key < best[0]:
            best = (key, q)
    (outside, _, row), q = best
    position, rotation = float(found.position_error[row]), float(found.rotation_error[row])
    status = IKStatus.OUTSIDE_LIMITS if outside else IKStatus.CONVERGED
    if position > tolerances[0] or rotation > tolerances[1]:
        status = IKStatus.LOCAL_MINIMUM
    return IKResult(
        q, status is IKStatus.CONVERGED, status, position, rotation, 0, 0, tuple(remarks)
    )
