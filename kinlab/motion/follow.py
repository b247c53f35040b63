"""Joint positions along a path of the tool: on one branch, clear of singularities, or refused.

What is refused is said with its time and place, and up to where the way can be had.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.structure.task_space import TaskSpace, mask_of
from kinlab.arrays import Array, between
from kinlab.engine.fast.stacks import fk, jacobian
from kinlab.errors import SingularError, UnreachableError
from kinlab.inverse.methods import pose_error
from kinlab.inverse.postures.path import IKPath, ik_path
from kinlab.inverse.search import ik
from kinlab.model.robot import Robot
from kinlab.motion.paths import TimedPath
from kinlab.tolerances import TOLERANCES

_ROWS = 20
"""Poses that are followed at a time: a path that ends is not searched on beyond its end."""


def follow(
    robot: Robot,
    space: TaskSpace,
    path: TimedPath,
    times: Array,
    goals: Array,
    q0: ArrayLike | None,
    seed: int,
) -> Array:
    """Joint positions at the times, (N, n), on one branch and clear of singularities."""
    mask = mask_of(space.rows)
    near = TOLERANCES.follows
    begin = ik(robot, goals[0], q0, "lm", near, near, seed, task=mask)
    if not begin.success:
        raise UnreachableError(_unreachable(robot, goals[0], 0.0, begin, None))
    if space.m < robot.n:
        q = _with_spare_joints(robot, space, path, times, goals, begin.q)
    else:
        q = _on_one_branch(robot, space, times, goals, begin.q, seed)
    _require_one_side(robot, space, times, goals, q)
    return _sharpened(space, goals, q)


def _sharpened(space: TaskSpace, goals: Array, q: Array) -> Array:
    """Two Newton steps for all rows: what is left of an error, accelerations weigh by 1/step²."""
    rows = list(space.rows)
    for _ in range(2):
        errors = [pose_error(*pair) for pair in zip(fk(space.robot, q), goals, strict=True)]
        inverse = np.linalg.pinv(jacobian(space.robot, q)[:, rows])
        q = q + np.einsum("nij,nj->ni", inverse, np.array(errors)[:, rows])
    return q


def _on_one_branch(
    robot: Robot, space: TaskSpace, times: Array, goals: Array, q: Array, seed: int
) -> Array:
    """:func:`kinlab.ik_path` from q on, some rows at a time, up to the first that ends the way."""
    mask = mask_of(space.rows)
    rows = [q[np.newaxis]]
    near = TOLERANCES.follows
    for first in range(0, len(goals), _ROWS):
        part = slice(first, first + _ROWS)
        found = ik_path(robot, goals[part], rows[-1][-1], near, near, seed, task=mask)
        ended = np.flatnonzero(found.conditioning < TOLERANCES.way_lost)
        bad = np.union1d(np.flatnonzero(~found.success), found.jumps).astype(int)
        if len(ended) and (not len(bad) or ended[0] < bad[0]):
            row = first + int(ended[0])
            raise SingularError(_singular(robot, space, times, goals, found.q[ended[0]], row))
        if len(bad):
            _refuse_row(robot, times, goals, found, int(bad[0]), first, mask)
        rows.append(found.q)
    return np.concatenate(rows[1:])


def _refuse_row(
    robot: Robot,
    times: Array,
    goals: Array,
    found: IKPath,
    bad: int,
    first: int,
    mask: tuple[bool, ...],
) -> None:
    """Says why a row of a path cannot be had: another branch, or out of reach."""
    row = first + bad
    before = None if row == 0 else (float(times[row - 1]), goals[row - 1])
    if bad in found.jumps and found.success[bad] and before is not None:
        raise UnreachableError(
            f"robot {robot.name!r}: {_place(times[row], goals[row])}, the way goes on only on "
            f"another branch; {_until(*before)}"
        )
    answer = ik(robot, goals[row], found.q[max(bad - 1, 0)], task=mask)
    raise UnreachableError(_unreachable(robot, goals[row], times[row], answer, before))


def _require_one_side(robot: Robot, space: TaskSpace, times: Array, goals: Array, q: Array) -> None:
    """Refuses a path whose det J changes its sign between samples, or that all but loses rank.

    Raises:
        SingularError: when and where.
    """
    jac = space.jacobian(q, space.scale)
    values = np.linalg.svd(jac, compute_uv=False)
    lost = values[:, -1] < TOLERANCES.way_lost * values[:, 0]
    if space.m == robot.n:
        sign = np.sign(np.linalg.det(jac))
        lost |= np.concatenate([[False], sign[1:] != sign[:-1]])
    if lost.any():
        raise SingularError(
            _singular(robot, space, times, goals, q[int(np.argmax(lost))], int(np.argmax(lost)))
        )


def _with_spare_joints(
    robot: Robot, space: TaskSpace, path: TimedPath, times: Array, goals: Array, q: Array
) -> Array:
    """The least-norm motion qdot = J⁺ V from q on, kept on the poses by Newton steps."""
    rows = [q]
    for k in range(1, len(times)):
        step = times[k] - times[k - 1]
        middle = 0.5 * (times[k] + times[k - 1])
        _, twists, _ = path.at(np.array([times[k - 1], middle, times[k]]))
        k1 = _least(space, q, twists[0])
        k2 = _least(space, q + 0.5 * step * k1, twists[1])
        k3 = _least(space, q + 0.5 * step * k2, twists[1])
        k4 = _least(space, q + step * k3, twists[2])
        q = q + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        for _ in range(8):
            error = pose_error(fk(robot, q), goals[k])[list(space.rows)]
            if np.abs(error).max() <= TOLERANCES.follows:
                break
            q = q + np.linalg.pinv(jacobian(robot, q)[list(space.rows)]) @ error
        else:
            raise SingularError(_singular(robot, space, times, goals, rows[-1], k - 1))
        outside = ~between(q, robot.lower, robot.upper, TOLERANCES.limit_digits)
        if outside.any():
            name = robot.joint_names[int(np.argmax(outside))]
            raise UnreachableError(
                f"robot {robot.name!r}: {_place(times[k], goals[k])}, {name} reaches its limit "
                f"when the spare joints move least; {_until(times[k - 1], goals[k - 1])}"
            )
        rows.append(q)
    return np.array(rows)


def _least(space: TaskSpace, q: Array, twist: Array) -> Array:
    rows = list(space.rows)
    return np.linalg.pinv(jacobian(space.robot, q)[rows]) @ twist[rows]


# -------- What is said where a path cannot be had


def _place(t: float, pose: Array) -> str:
    x, y, z = pose[:3, 3]
    return f"at t = {t:.4g} s, tool at ({x:.4g}, {y:.4g}, {z:.4g}) m"


def _until(t: float, pose: Array) -> str:
    x, y, z = pose[:3, 3]
    return f"the way can be had until t = {t:.4g} s, ({x:.4g}, {y:.4g}, {z:.4g}) m"


def _unreachable(
    robot: Robot, goal: Array, t: float, answer: Any, before: tuple[float, Array] | None
) -> str:
    near = fk(robot, answer.q)[:3, 3]
    status = str(answer.status.value).replace("_", " ")
    text = (
        f"robot {robot.name!r}: {_place(t, goal)}, the pose cannot be had ({status}: "
        f"{answer.position_error:.3g} m and {answer.rotation_error:.3g} rad off); the nearest "
        f"found has the tool at ({near[0]:.4g}, {near[1]:.4g}, {near[2]:.4g}) m"
    )
    return text if before is None else f"{text}; {_until(*before)}"


def _singular(
    robot: Robot, space: TaskSpace, times: Array, goals: Array, q: Array, row: int
) -> str:
    values = space.sigma(q)
    text = (
        f"robot {robot.name!r}: {_place(times[row], goals[row])}, the way meets a singularity of "
        f"task {space.name}: sigma_min / sigma_max is {values[-1] / values[0]:.2g}"
    )
    if row == 0:
        return f"{text}; start from another pose or branch (q0)"
    return f"{text}; {_until(times[row - 1], goals[row - 1])}"
