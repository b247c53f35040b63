"""All solutions of inverse kinematics, where a closed form is known."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.chain import columns, frames
from kinlab.chain_arrays import Chain, chain
from kinlab.inverse import analytic, kernel, kernel_parts, methods, planar, wrist
from kinlab.inverse.branch_names import planar_name, wrist_arm_name
from kinlab.inverse.request import read_target, require_robot
from kinlab.inverse.verify import measure
from kinlab.robot import Robot

_TOLERANCE = 1e-9
"""Metres and radians that a branch must meet, by Pinocchio. After polishing, rounding remains;
at a singular solution about its square root."""

_SINGULAR_TOLERANCE = 1e-6
"""The same where two branches run together: there the error is flat and q is loose."""

_SAME = 1e-5
"""Radians or metres within which two solutions are one."""


@dataclass(frozen=True, eq=False)
class IKBranches:
    """All solutions found for one pose.

    Attributes:
        q: (m, n); angles turned into the limits where a whole turn does it.
        names: which shoulder, elbow and wrist, one text a row.
        within_limits: (m,), bool.
        position_error, rotation_error: (m,), by Pinocchio, in the coordinates that count.
        method: ``"planar"``, ``"spherical wrist"`` or ``"ssik"``.
        complete: whether these are all; not so for seven joints (a sample of a continuum), nor
            where a solution is singular and one joint could be chosen freely.
    """

    q: Array
    names: tuple[str, ...]
    within_limits: Any
    position_error: Array
    rotation_error: Array
    method: str
    complete: bool

    def __len__(self) -> int:
        return len(self.q)

    def __iter__(self) -> Iterator[Array]:
        return iter(self.q)


def ik_branches(robot: Robot, T: ArrayLike) -> IKBranches:
    """All joint positions at which the tool is at T, whether within limits or not.

    Planar arms of two and three parallel joints and six-joint arms with a spherical wrist (joint
    3 may slide) are solved here in closed form; other arms of six or seven revolute joints by
    the extra ``kinlab[analytic]``. Of a planar arm with two joints only the point of T in the
    plane counts, with three also the angle.

    Args:
        robot: the robot.
        T: target of the tool in the base, (4, 4).

    Returns:
        The solutions, each polished and measured by Pinocchio; none where T is out of reach.

    Raises:
        StateError: T is not a rigid transform.
        StructureError: no closed form for such an arm.
        MissingExtraError: the arm needs ``kinlab[analytic]``.
    """
    require_robot(robot)
    target = read_target(robot, T)
    arm = chain(robot)
    weight = np.ones(6)
    centre = None
    if robot.n == len(arm.prismatic) and planar.is_planar(arm):
        method, found = "planar", planar.solve(arm, target)
        weight, target = _in_the_plane(arm, target)
    elif (centre := wrist.wrist_centre(arm)) is not None and robot.n == 6:
        method, found = "spherical wrist", wrist.solve(arm, target, centre)
    else:
        method, found = "ssik", analytic.solve(robot, arm, target)
    rows: list[tuple[Array, bool, float, float]] = []
    for q in found:
        polished = _polish(robot, arm, target, q, weight)
        if polished is not None and not any(_same(arm, polished[0], r[0]) for r in rows):
            rows.append(polished)
    names = []
    for q, *_ in rows:
        if method == "planar":
            names.append(planar_name(arm, q))
        elif robot.n == 6:
            at = None if centre is None else target[:3, :3] @ centre[1] + target[:3, 3]
            names.append(wrist_arm_name(arm, q, at))
        else:
            names.append("")
    order = sorted(range(len(rows)), key=lambda i: (names[i], tuple(rows[i][0])))
    words = tuple(names[i] for i in order)
    return IKBranches(
        np.array([rows[i][0] for i in order]).reshape(-1, robot.n),
        words,
        np.array([rows[i][1] for i in order], dtype=np.bool_),
        np.array([rows[i][2] for i in order]),
        np.array([rows[i][3] for i in order]),
        method,
        robot.n < 7 and not any("aligned" in w or "over" in w for w in words),
    )


def _in_the_plane(arm: Chain, target: Array) -> tuple[Array, Array]:
    """What counts for a planar arm: the target moved into the plane, where the rest is met."""
    base, flat = np.eye(4), np.eye(4)
    base[:3] = arm.fixed[0].reshape(3, 4)
    for row in arm.fixed[1:]:
        step = np.eye(4)
        step[:3] = row.reshape(3, 4)
        flat = flat @ step
    goal = np.linalg.inv(base) @ target
    goal[2, 3] = flat[2, 3]  # the height and tilt of the tool are the arm's own
    turn = goal[:3, :3] @ flat[:3, :3].T
    angle = math.atan2(turn[1, 0], turn[0, 0])
    c, s = math.cos(angle), math.sin(angle)
    goal[:3, :3] = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ flat[:3, :3]
    weight = np.ones(6) if len(arm.prismatic) == 3 else np.array([1.0, 1, 1, 0, 0, 0])
    return weight, base @ goal


def _polish(
    robot: Robot, arm: Chain, target: Array, q: Array, weight: Array
) -> tuple[Array, bool, float, float] | None:
    """A few damped steps from a closed-form q, wrapped and measured; None if it is no solution."""
    n = robot.n
    endless = np.full(n, np.inf)
    out, outcome = q.reshape(1, n).copy(), np.empty((1, 3), dtype=np.int64)
    numbers = np.array([1e-14, 1e-14, methods.DAMPING, 1e-14, 6.0, 1.0, 100.0, np.inf])
    kernel.search_rows(
        *arm, -endless, endless, np.ones(n, dtype=np.bool_), weight, numbers, np.empty((12, 0)),
        np.empty((0, n)), target[:3].reshape(1, 12), q.reshape(1, n).copy(), True, out, outcome,
        0, 1,
    )  # fmt: skip
    best = out[0]
    lower, upper = np.array(robot.lower), np.array(robot.upper)
    inside = bool(kernel_parts.wrap(arm.prismatic, lower, upper, np.clip(0.0, lower, upper), best))
    position, rotation = measure(robot, best, target, weight)
    error = max(position, rotation)
    if error > _TOLERANCE:
        jac, pose = np.zeros((6, n)), np.empty(12)
        axes = np.empty((len(arm.prismatic), 6))
        frames(*arm, best, axes, pose)
        columns(arm.prismatic, axes, pose, jac)
        values = np.linalg.svd(jac[weight > 0], compute_uv=False)
        if error > _SINGULAR_TOLERANCE or values[-1] > 1e-3 * values[0]:
            return None
    return best, inside, position, rotation


def _same(arm: Chain, one: Array, two: Array) -> bool:
    gap = one - two
    turned = gap - 2.0 * np.pi * np.round(gap / (2.0 * np.pi))
    return bool(np.all(np.abs(np.where(arm.prismatic, gap, turned)) < _SAME))
