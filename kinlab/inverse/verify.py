"""The last word: errors measured by Pinocchio at the q that is handed back.

``pin.forwardKinematics`` is called here on purpose, not :func:`kinlab.fk`, whose batches may run
on the same compiled chain as the search.
"""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.compiled import kernel
from kinlab.inverse.kernel_parts import rotation_vector
from kinlab.robot import Robot, scratch


@kernel
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
    rotation_vector(r, e)
    for i in range(3):
        if weight[3 + i] > 0.0:
            rotation += e[i] ** 2
    return math.sqrt(position), math.sqrt(rotation)


@kernel
def _errors_of_rows(poses, targets, weight, errors):  # type: ignore[no-untyped-def]
    for row in range(poses.shape[0]):
        errors[row, 0], errors[row, 1] = task_errors(poses[row], targets[row], weight)


def measure(robot: Robot, q: Array, target: Array, weight: Array) -> tuple[float, float]:
    """Position and rotation error of one q, by Pinocchio.

    Args:
        robot: the robot.
        q: (n,).
        target: (4, 4).
        weight: (6,), zero for coordinates not asked for.

    Returns:
        metres, radians.
    """
    errors: tuple[float, float] = task_errors(_pose(robot, q), target, weight)
    return errors


def measure_all(robot: Robot, q: Array, targets: Array, weight: Array, errors: Array) -> None:
    """As :func:`measure` for q (N, n) and targets (N, 4, 4); errors (N, 2) is written."""
    model, data, tool = robot.model, scratch(robot), robot.tool
    forward, place = pin.forwardKinematics, pin.updateFramePlacement
    poses = np.empty((len(q), 4, 4))
    for row, values in enumerate(q):
        forward(model, data, values)
        poses[row] = place(model, data, tool).homogeneous
    _errors_of_rows(poses, targets, weight, errors)


def _pose(robot: Robot, q: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q)
    pose: Array = pin.updateFramePlacement(robot.model, data, robot.tool).homogeneous
    return pose
