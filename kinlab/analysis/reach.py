"""Whether the tool can be somewhere, within the joint limits: many bounded solves at once.

A point that no start reaches is *called* out of reach; the number of starts is the proof of
effort. For arms of two or three joints this is as good as certain.
"""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.kinematics import fk, jacobian
from kinlab.structure.task_space import TaskSpace, search_box

_STEP = 1e-3
"""Of the arm's length: how far beyond a singular configuration the tool is asked to go. A fold
leaves a gap as large as the step, so that a thousandth is told from rounding with ease."""
_MISS = 0.2
"""Share of the step within which the tool counts as arrived."""


def passes_beyond(space: TaskSpace, q: Array, direction: Array, starts: int = 96) -> bool | None:
    """Whether the tool reaches poses a little ahead of q on both sides along ``direction``.

    Args:
        space: the task.
        q: a singular configuration, (n,).
        direction: the lost direction, (m,), entries in metres over ``space.scale``.
        starts: starting points of each solve.

    Returns:
        ``False`` where one side is out of reach: q lies on the boundary of the workspace.
        ``None`` for a task with a part of the orientation, for which "ahead" has no meaning.
    """
    rows = np.asarray(space.rows)
    angular = tuple(rows[rows >= 3])
    planar = angular == (5,) and _turns_about_z(space)
    if angular not in ((), (3, 4, 5)) and not planar:
        return None
    twist = np.zeros(6)
    twist[rows] = direction
    twist[:3] *= space.scale
    here = fk(space.robot, q)
    for side in (_STEP, -_STEP):
        target = here.copy()
        target[:3, 3] += side * twist[:3]
        target[:3, :3] = pin.exp3(side * twist[3:]) @ here[:3, :3]
        if not reaches(space, target, _MISS * _STEP, starts, q):
            return False
    return True


def reaches(
    space: TaskSpace, target: Array, tolerance: float, starts: int, near: Array | None = None
) -> bool:
    """Whether some start within the limits brings the task's coordinates to ``target``.

    Args:
        space: the task.
        target: pose of the tool, (4, 4); coordinates outside the task are ignored.
        tolerance: norm of the miss in ``space.scale`` and radians.
        starts: how many random starts.
        near: a first start, (n,).
    """
    robot = space.robot
    lower, upper = search_box(robot)
    rng = np.random.default_rng(0)
    q = rng.uniform(lower, upper, (starts, robot.n))
    if near is not None:
        q[: starts // 4] = near + rng.normal(scale=0.1, size=(starts // 4, robot.n))
    q = np.clip(q, lower, upper)
    eye = np.eye(space.m)
    for round_ in range(60):
        miss = _miss(space, q, target)
        size = np.linalg.norm(miss, axis=1)
        if float(size.min()) < tolerance:
            return True
        if round_ >= 15:  # give up on the slow half, as long as some remain
            keep = np.argsort(size, kind="stable")[: max(8, len(size) // 2)]
            q, miss, size = q[keep], miss[keep], size[keep]
        matrix = space.select(jacobian(robot, q), space.scale)
        damping = (1e-8 + 1e-2 * size**2)[:, np.newaxis, np.newaxis]
        gram = matrix @ matrix.swapaxes(1, 2) + damping * eye
        step = np.einsum("nmi,nm->ni", matrix, np.linalg.solve(gram, miss[..., np.newaxis])[..., 0])
        largest = np.abs(step).max(axis=1, keepdims=True)
        q = np.clip(q + step * np.minimum(1.0, 0.5 / np.maximum(largest, 1e-12)), lower, upper)
    return False


def _miss(space: TaskSpace, q: Array, target: Array) -> Array:
    poses = fk(space.robot, q)
    twist = np.zeros((len(q), 6))
    twist[:, :3] = (target[:3, 3] - poses[:, :3, 3]) / space.scale
    if max(space.rows) >= 3:
        turn = target[:3, :3] @ poses[:, :3, :3].swapaxes(1, 2)
        twist[:, 3:] = [pin.log3(r) for r in turn]
    return twist[:, list(space.rows)]


def _turns_about_z(space: TaskSpace) -> bool:
    return bool(np.abs(space.sample[:, 3:5, :]).max() < 1e-9)
