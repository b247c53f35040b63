"""Infinite sets of solutions of one pose: found at singular branches, said and parametrised."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.inverse.branches.rows import miss
from kinlab.inverse.branches.structures import POINTING, POSITION, Form, jacobian_and_pose
from kinlab.inverse.kernel import pose_error
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_FAR = 0.05
"""Radians or metres that a free joint is moved along to see whether the tool stays."""


@dataclass(frozen=True, eq=False)
class IKFamily:
    """Infinitely many solutions of one pose, through one of its branches.

    Attributes:
        branch: row of the branch.
        direction: (n,), unit: the way the joints may move there.
        linear: whether q + t direction is a solution for every t. Otherwise the set is a curve
            with this tangent; hold one of its joints with ``given=`` for a point of it.
        joints: names of the joints that move.
        text: the same in words.
    """

    branch: int
    direction: Array
    linear: bool
    joints: tuple[str, ...]
    text: str


def families_at(
    robot: Robot, form: Form, joints: Any, q: Array, goal: Array
) -> tuple[IKFamily, ...]:
    """The families through the branches of one pose.

    Args:
        robot: the robot.
        form: its form. joints: which of the robot's joints were solved for; ``None``: all.
        q: (m, n), the branches. goal: (12,), what they meet.
    """
    found = []
    index = np.arange(robot.n) if joints is None else joints
    for row, values in enumerate(q):
        start = values[index]
        for tangent in _free(form, start, goal):
            linear = all(
                _miss(form, start + t * tangent, goal) < TOLERANCES.tool_stays
                for t in (_FAR, -0.7, 1.9)
            )
            if not linear and not _curve(form, start, tangent, goal):
                continue
            direction = np.zeros(robot.n)
            direction[index] = tangent
            moving = np.flatnonzero(np.abs(direction) > 1e-6)
            names = tuple(robot.joint_names[i] for i in moving)
            if linear:
                rates = direction / direction[moving[0]]
                terms = " ".join(f"{rates[i]:+.4g} {robot.joint_names[i]}" for i in moving[1:])
                text = f"branch {row}: {names[0]} is free" + (
                    f", with {terms} per unit of it" if terms else ""
                )
            else:
                text = f"branch {row}: {', '.join(names)} move together along a curve"
            found.append(IKFamily(row, direction, linear, names, text))
    return tuple(found)


def _jacobian(form: Form, q: Array) -> tuple[Array, Array]:
    return jacobian_and_pose(form.arm_fixed, form.arm_prismatic, q)


def _rows(form: Form, jac: Array, error: Array, pose: Array) -> tuple[Array, Array]:
    """The rows that count of J and of the error."""
    if form.task == POSITION:
        return jac[:3], error[:3]
    if form.task == POINTING:  # turning about the tool's own z does not count
        z = pose[[2, 6, 10]]
        flat = np.linalg.svd(z[np.newaxis])[2][1:]
        return np.vstack([jac[:3], flat @ jac[3:]]), np.append(error[:3], flat @ error[3:])
    return jac, error


def _free(form: Form, q: Array, goal: Array) -> Array:
    """Directions that leave the tool at rest, to first order; (k, n)."""
    jac, pose = _jacobian(form, q)
    part, _ = _rows(form, jac, np.zeros(6), pose)
    _, values, vectors = np.linalg.svd(part)
    padded = np.zeros(form.real)
    padded[: len(values)] = values
    free: Array = vectors[padded < TOLERANCES.null_direction * padded[0]]
    return free


def _miss(form: Form, q: Array, goal: Array) -> float:
    _, pose = _jacobian(form, q)
    position, rotation = miss(form.task, pose, goal, np.empty(9), np.empty(6))
    return float(max(position, rotation))


def _curve(form: Form, start: Array, tangent: Array, goal: Array) -> bool:
    """Whether solutions go on along the tangent, the other joints following."""
    for way in (_FAR, -_FAR):
        q = start + way * tangent
        for _ in range(12):
            jac, pose = _jacobian(form, q)
            error = np.empty(6)
            pose_error(pose, goal, np.empty(9), error)
            part, wanted = _rows(form, jac, error, pose)
            ahead = tangent @ (start - q) + way
            step, *_ = np.linalg.lstsq(
                np.vstack([part, tangent]), np.append(wanted, ahead), rcond=1e-9
            )
            q = q + step
        if (
            not _miss(form, q, goal) < TOLERANCES.tool_stays
            or abs(tangent @ (q - start)) < 0.5 * _FAR
        ):
            return False
    return True
