"""Whether a singular configuration lies on the edge of the workspace, or the tool passes on.

Where J loses the direction u, joint speeds v with J v = 0 accelerate the tool along u by the
quadratic form v -> u . (dJ/dt) v. If it takes both signs, both sides are reached from here: proved
(the map is open there). Otherwise solutions are looked for a little ahead on both sides, from many
starts and from along the motions that the pose leaves free, where other branches begin: a solution
on each side proves that the tool passes. Only where the form has one sign, the other side shows no
solution and this side shows several is it *called* an edge (of a redundant arm the form has zeros
besides, for its self-motion); everything else is undecided.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from kinlab.analysis.metrics import counting
from kinlab.analysis.solver import jacobian_derivative
from kinlab.analysis.structure.task_space import TaskSpace, revolute, search_box, wrap
from kinlab.arrays import Array
from kinlab.engine.kinematics import fk, jacobian
from kinlab.host.evidence import Evidence
from kinlab.tolerances import TOLERANCES

_STEPS = (1e-3, 1e-2)
"""Of the arm's length: how far ahead the tool is asked to go. A fold leaves a gap as large as the
step, so that a thousandth is told from rounding with ease; the longer one is easier to solve."""
_MISS = 0.1
"""Share of the step within which the tool counts as arrived."""
_SECOND = "the second-order form of the internal motions"
_STARTS = 160
_ENOUGH = 4
"""Solutions on the near side without which silence on the far side says nothing."""


@dataclass(frozen=True)
class Edge:
    """Answer of :func:`edge`.

    Attributes:
        beyond: ``True``: the tool passes on to both sides. ``False``: the tool turns back and on
            one side no solution was found. ``None``: undecided.
        evidence: what that rests on.
    """

    beyond: bool | None
    evidence: Evidence


def edge(space: TaskSpace, q: Array, lost: Array) -> Edge:
    """Whether the tool can pass on in the lost direction.

    Args:
        space: the task.
        q: a singular configuration, (n,).
        lost: the lost directions, (m, m - rank), entries in metres over ``space.scale``.
    """
    single = lost.shape[1] == 1
    least, most = second_order_form(space, q, lost[:, 0]) if single else (0.0, 0.0)
    sign = TOLERANCES.form_has_sign
    if least < -sign and most > sign:
        return Edge(True, Evidence(_SECOND, proved="the tool passes on to both sides"))
    if not _can_step(space):
        why = "nothing: steps ahead mean nothing for a part of the orientation"
        return Edge(None, Evidence(_SECOND, found=why))
    searched = f"{_STARTS} starts on either side of the lost direction"
    counts = (0, 0)
    for step in _STEPS:
        counts = (
            solutions_ahead(space, q, step * lost[:, 0]),
            solutions_ahead(space, q, -step * lost[:, 0]),
        )
        if min(counts) > 0:
            proved = (
                "the tool passes on to both sides: met a small step ahead on each, to a tenth of it"
            )
            return Edge(True, Evidence(searched, min(counts), _STARTS, proved))
        if step == _STEPS[0]:
            near = counts
    ahead, behind = near
    up = most > sign and least > -sign and behind == 0 and ahead >= _ENOUGH
    down = least < -sign and most < sign and ahead == 0 and behind >= _ENOUGH
    if (up or down) and 0 in counts:
        # motions that leave the tool where it is give the form zeros: then it proves nothing
        strict = least > sign or most < -sign
        turns = "near this configuration the tool turns back (second order)"
        other = "that no other branch reaches beyond"
        if strict:
            return Edge(False, Evidence(searched, max(near), _STARTS, turns, other))
        return Edge(False, Evidence(searched, max(near), _STARTS, "", f"{turns}; {other}"))
    return Edge(None, Evidence(searched, max(near), _STARTS, found="no solution on one side"))


def second_order_form(space: TaskSpace, q: Array, direction: Array) -> tuple[float, float]:
    """Least and greatest eigenvalue of v -> u . (dJ/dt) v on J v = 0, limits respected.

    Zeros where joints on their limits leave J more directions to lose than u: then one form
    decides nothing.
    """
    robot = space.robot
    full = jacobian(robot, q)
    turning = revolute(robot) & (robot.upper - robot.lower >= 2.0 * np.pi - 1e-9)
    inside = turning | ((q > robot.lower + 1e-9) & (q < robot.upper - 1e-9))
    matrix = space.select(full, space.scale) * inside
    change = space.select(jacobian_derivative(full), space.scale)  # [j, :, i]
    change = change * _unit(space)[:, np.newaxis, np.newaxis]
    bilinear = np.einsum("m,jmi->ji", direction, change) * np.outer(inside, inside)
    _, sigma, right = np.linalg.svd(matrix)
    rank = int(np.sum(counting(sigma, TOLERANCES.internal_motion)))
    if rank < space.m - 1:
        return 0.0, 0.0
    motions = right[rank:].T * inside[:, np.newaxis]
    if not motions.size:
        return 0.0, 0.0
    values = np.linalg.eigvalsh(0.5 * motions.T @ (bilinear + bilinear.T) @ motions)
    return float(values[0]), float(values[-1])


def _can_step(space: TaskSpace) -> bool:
    rows = np.asarray(space.rows)
    angular = tuple(rows[rows >= 3])
    flat = float(np.abs(space.sample[:, 3:5, :]).max()) < 1e-9
    return angular in ((), (3, 4, 5)) or (angular == (5,) and flat)


def solutions_ahead(space: TaskSpace, q: Array, twist: Array) -> int:
    """How many starts within the limits bring the tool to the pose ahead of q by a small twist;
    counted up to a few.

    Args:
        space: the task.
        q: a configuration, (n,).
        twist: (m,), entries in metres over ``space.scale``.
    """
    robot = space.robot
    full = np.zeros(6)
    full[list(space.rows)] = twist
    full[:3] *= space.scale
    here = fk(robot, q)
    target = here.copy()
    target[:3, 3] += full[:3]
    target[:3, :3] = pin.exp3(full[3:]) @ here[:3, :3]
    tolerance = _MISS * float(np.linalg.norm(twist))
    states = _starts(space, q)
    lower, upper = search_box(robot)
    lower, upper = np.minimum(lower, q), np.maximum(upper, q)
    unit, eye, count = _unit(space), np.eye(space.m), 0
    for round_ in range(60):
        miss = _miss(space, states, target)
        size = np.linalg.norm(miss, axis=1)
        there = size < tolerance
        count += int(there.sum())
        if not len(there) or count >= _ENOUGH:
            break
        keep = np.flatnonzero(~there)
        if round_ % 15 == 14:  # the slow half gives up, as long as some remain
            slow_last = keep[np.argsort(size[keep], kind="stable")]
            keep = np.sort(slow_last[: max(16, len(keep) // 2)])
        states, miss, size = states[keep], miss[keep], size[keep]
        matrix = space.select(jacobian(robot, states), space.scale)
        step = _damped(matrix, miss, size, eye)
        # joints on a limit that the step would push beyond it stay there
        pushed = ((states <= lower) & (step < 0.0)) | ((states >= upper) & (step > 0.0))
        if pushed.any():
            step = _damped(np.where(pushed[:, np.newaxis], 0.0, matrix), miss, size, eye)
        largest = np.abs(step).max(axis=1, keepdims=True)
        step *= np.minimum(1.0, 0.5 / np.maximum(largest, 1e-12)) * unit
        states = np.clip(states + step, lower, upper)
    return count


def _damped(matrix: Array, miss: Array, size: Array, eye: Array) -> Array:
    damping = (1e-10 + 1e-2 * size**2)[:, np.newaxis, np.newaxis]
    gram = matrix @ matrix.swapaxes(1, 2) + damping * eye
    step: Array = np.einsum(
        "nmi,nm->ni", matrix, np.linalg.solve(gram, miss[..., np.newaxis])[..., 0]
    )
    return step


def _starts(space: TaskSpace, q: Array) -> Array:
    """Random ones, ones near q, and ones along the motions that leave the tool where it is."""
    robot = space.robot
    lower, upper = search_box(robot)
    rng = np.random.default_rng(0)
    states = rng.uniform(lower, upper, (_STARTS, robot.n))
    quarter = _STARTS // 4
    states[:quarter] = q + rng.normal(scale=0.1, size=(quarter, robot.n))
    _, sigma, right = np.linalg.svd(space.jacobian(q, space.scale))
    motions = right[int(np.sum(counting(sigma, TOLERANCES.internal_motion))) :]
    share = rng.normal(size=(quarter, len(motions)))
    share /= np.abs(share @ motions).max(axis=1, keepdims=True)
    share *= rng.uniform(0.0, np.pi, (quarter, 1))
    swept = q + (share @ motions + rng.normal(scale=0.01, size=(quarter, robot.n))) * _unit(space)
    states[quarter : 2 * quarter] = wrap(robot, swept)
    return np.clip(states, np.minimum(lower, q), np.maximum(upper, q))


def _unit(space: TaskSpace) -> Array:
    """What one unit of each joint means in J with its metres divided by the scale, (n,)."""
    return np.where(revolute(space.robot), 1.0, space.scale)


def _miss(space: TaskSpace, q: Array, target: Array) -> Array:
    poses = fk(space.robot, q)
    twist = np.zeros((len(q), 6))
    twist[:, :3] = (target[:3, 3] - poses[:, :3, 3]) / space.scale
    if max(space.rows) >= 3:
        twist[:, 3:] = _rotation_vectors(target[:3, :3] @ poses[:, :3, :3].swapaxes(1, 2))
    return twist[:, list(space.rows)]


def _rotation_vectors(turn: Array) -> Array:
    """Rotation vectors (N, 3) of rotations (N, 3, 3); near a half turn any step that turns."""
    axis = 0.5 * np.stack(
        [
            turn[:, 2, 1] - turn[:, 1, 2],
            turn[:, 0, 2] - turn[:, 2, 0],
            turn[:, 1, 0] - turn[:, 0, 1],
        ],
        axis=1,
    )
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, 0.5 * (np.trace(turn, axis1=1, axis2=2) - 1.0))
    factor: Array = np.where(sine > 1e-9, angle / np.maximum(sine, 1e-9), 1.0)
    return factor[:, np.newaxis] * axis
