"""Motions of an arm for the page: joint sweeps, tool paths by IK, a walk on singularities.

Inverse kinematics brings numba, which would double a cold start; only motions that need it
import it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.structure.task_space import mask_of
from kinlab.arrays import Array, real_array, word
from kinlab.drives.laws import rising
from kinlab.engine.fast.stacks import fk, jacobian
from kinlab.errors import OptionError, StateError, StructureError
from kinlab.host.language import _
from kinlab.model.robot import Robot
from kinlab.viewer.arm_page import judged_rows
from kinlab.viewer.drawing.arm import reach

# -------- A motion for the page: joint positions at given times, with straight lines
#          between them


def motion_json(q: Array, duration: float | ArrayLike, name: str) -> dict[str, Any]:
    """Checks a motion and gives it as plain values.

    Args:
        q: joint positions, (N, n), N at least 2.
        duration: seconds for the whole motion at even steps, or the times themselves, (N,).
        name: heading in the page.

    Raises:
        StateError: fewer than two rows.
        OptionError: a duration that is not positive, or times that do not grow.
    """
    if q.ndim != 2 or len(q) < 2:
        raise StateError(f"motion {name!r}: q has shape {q.shape}; expected (N, n), N at least 2")
    times = real_array(duration, f"motion {name!r}: duration", OptionError)
    if times.ndim == 0:
        if times <= 0:
            raise OptionError(f"motion {name!r}: duration is {times:g} s; it must be positive")
        times = np.linspace(0.0, float(times), len(q))
    if times.shape != (len(q),) or np.any(np.diff(times) <= 0):
        raise OptionError(f"motion {name!r}: give {len(q)} times that grow, one for each row of q")
    return {"name": name, "times": (times - times[0]).tolist(), "q": q.tolist()}


# -------- Motions to show an arm with: a sweep of its joints, tool paths by IK, a walk on
#          singularities

_STEPS = 120


@dataclass(frozen=True)
class ShownMotion:
    """Joint positions (N, n) over ``duration`` seconds, and what to call them."""

    name: str
    q: Array
    duration: float


def motion(robot: Robot, kind: str, start: Array) -> ShownMotion:
    """A motion of an arm by name.

    Args:
        robot: the arm.
        kind: one of :data:`MOTIONS`.
        start: joint positions it starts from, (n,).

    Raises:
        NameUnknownError: no motion of that name.
        StructureError: the arm cannot do it; says why.
    """
    return MOTIONS[word(kind, MOTIONS, "motion")](robot, start)


def sweep(robot: Robot, start: Array) -> ShownMotion:
    """One joint after the other, up and down by at most a quarter turn, and back."""
    wave = np.sin(np.linspace(0.0, 2.0 * np.pi, 41))
    up = np.minimum(robot.upper - start, 0.5 * np.pi)
    down = np.minimum(start - robot.lower, 0.5 * np.pi)
    rows = [start]
    for joint in range(robot.n):
        move = np.zeros((40, robot.n))
        move[:, joint] = np.where(wave > 0, up[joint], down[joint])[1:] * wave[1:]
        rows.extend(start + move)
    return ShownMotion(_("Sweep of the joints"), np.array(rows), 2.5 * robot.n)


def line(robot: Robot, start: Array) -> ShownMotion:
    """The tool along a straight line and back; what else its task holds stays as it is."""
    rows = _tool_path(robot, np.array([[0.0, 0.0], [1.0, 0.0]]))
    return ShownMotion(_("Straight line by IK"), np.vstack([rows, rows[::-1]]), 5.0)


def pick(robot: Robot, start: Array) -> ShownMotion:
    """Up, across, down, and the same way back."""
    rows = _tool_path(robot, np.array([[0.0, 0.0], [0.0, 0.4], [1.0, 0.4], [1.0, 0.0]]))
    return ShownMotion(_("Pick and place by IK"), np.vstack([rows, rows[::-1]]), 7.0)


def locus(robot: Robot, start: Array) -> ShownMotion:
    """A walk along det J = 0: every pose of it is singular.

    Raises:
        StructureError: J of the arm's task is not square, or its determinant never changes sign.
    """
    rows, name = judged_rows(robot)
    if len(rows) != robot.n:
        raise StructureError(
            f"robot {robot.name!r}: J of its {name} is {len(rows)} x {robot.n}; a walk along "
            "det J = 0 needs a square one"
        )

    def det(q: Array) -> Array:
        return np.asarray(np.linalg.det(jacobian(robot, q)[..., rows, :]))

    rng = np.random.default_rng(0)
    q = _on_locus(robot, det, rng)
    heading = rng.normal(size=robot.n)
    walk = [q]
    for _step in range(3 * _STEPS):
        heading = _slide(det, q, heading)
        q = _onto_singularity(det, q + 0.02 * heading)
        outside = (q < robot.lower) | (q > robot.upper)
        if outside.any():  # bounce off the limit
            heading = np.where(outside, -heading, heading)
            q = walk[-1]
        walk.append(q)
    return ShownMotion(_("Walk along det J = 0"), np.array(walk), 12.0)


def posture(robot: Robot, start: Array) -> ShownMotion:
    """From one solution of a pose to another, without meeting a singularity, and back.

    Raises:
        StructureError: no such change was found.
        OptionError: the arm's task leaves joints free.
    """
    from kinlab.inverse.postures.cuspidality import is_cuspidal

    found = is_cuspidal(robot)
    if found.path is None:
        raise StructureError(
            f"robot {robot.name!r}: no change of posture without a singularity was found "
            f"({found.poses} poses, {found.pairs} pairs of solutions)"
        )
    length = float(np.linalg.norm(np.diff(found.path.q, axis=0), axis=1).sum())
    rows = found.path.points(length / _STEPS)
    there_and_back = np.vstack([rows, rows[::-1]])
    return ShownMotion(_("Change of posture without a singularity"), there_and_back, 8.0)


MOTIONS: dict[str, Callable[[Robot, Array], ShownMotion]] = {
    "sweep": sweep,
    "line": line,
    "pick": pick,
    "locus": locus,
    "posture": posture,
}
"""What ``kinlab view --animate`` can show of an arm."""


def _tool_path(robot: Robot, corners: Array) -> Array:
    """Joint positions along a polyline in the plane across and up, (N, n).

    Poses are tried from the best conditioned down, and sizes from large to small.
    """
    rows, _task = judged_rows(robot)
    if 0 not in rows or 1 not in rows:
        raise StructureError(
            f"robot {robot.name!r}: its tool cannot move freely in a plane; use the motion 'sweep'"
        )
    pace, _rate, _jerk = rising(
        np.linspace(0.0, 1.0, _STEPS // (len(corners) - 1))
    )  # rests in corners
    legs = [one + pace[:, None] * (two - one) for one, two in pairwise(corners)]
    shape = np.vstack([legs[0], *(leg[1:] for leg in legs[1:])])
    for q in _comfortable(robot, rows):
        pose = fk(robot, q)
        across, up = np.eye(3)[:2]
        if 2 in rows:
            up = np.eye(3)[2]
            across = np.cross(up, pose[:3, 3])
            if np.linalg.norm(across) < 1e-3:
                continue
            across /= np.linalg.norm(across)
        for size in (0.3, 0.2, 0.1):
            offsets = size * reach(robot) * (shape @ np.array([across, up]))
            found = _track(robot, rows, q, pose, offsets)
            if found is not None:
                return found
    raise StructureError(f"robot {robot.name!r}: no room found for a tool path; use 'sweep'")


def _comfortable(robot: Robot, rows: list[int]) -> Array:
    """Poses within the limits, best conditioned first, (K, n)."""
    rng = np.random.default_rng(0)
    low, high = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
    poses = rng.uniform(0.8 * low + 0.2 * high, 0.2 * low + 0.8 * high, (300, robot.n))
    sigma = np.linalg.svd(jacobian(robot, poses)[:, rows], compute_uv=False)
    best: Array = poses[np.argsort(-sigma[:, -1] / sigma[:, 0])]
    return best[:20]


def _track(robot: Robot, rows: list[int], q: Array, pose: Array, offsets: Array) -> Array | None:
    """Follows a path of positions by IK; None where it cannot be had on one branch."""
    goals = np.tile(pose, (len(offsets), 1, 1))
    goals[:, :3, 3] += offsets
    from kinlab.inverse.postures.path import ik_path

    for pick in (goals[::10], goals):  # a few first: most paths that fail do so there
        way = ik_path(robot, pick, q, 1e-8, 1e-8, task=mask_of(rows))
        if not way.success.all() or len(way.jumps):
            return None
    return way.q


def _on_locus(robot: Robot, det: Callable[[Array], Array], rng: np.random.Generator) -> Array:
    """A pose with det J = 0, by bisection between two of different sign."""
    low, high = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
    poses = rng.uniform(low, high, (200, robot.n))
    values = det(poses)
    if values.min() >= 0.0 or values.max() <= 0.0:
        raise StructureError(f"robot {robot.name!r}: det J does not change sign; no locus found")
    one, two = poses[int(np.argmin(values))], poses[int(np.argmax(values))]
    for _step in range(60):
        middle = 0.5 * (one + two)
        if det(middle) < 0.0:
            one = middle
        else:
            two = middle
    found: Array = one
    return found


def _slope(det: Callable[[Array], Array], q: Array) -> Array:
    step = 1e-6 * np.eye(len(q))
    return (det(q + step) - det(q - step)) / 2e-6


def _slide(det: Callable[[Array], Array], q: Array, heading: Array) -> Array:
    """The heading without its part that leaves the locus, of length 1."""
    normal = _slope(det, q)
    normal /= np.linalg.norm(normal) or 1.0
    along: Array = heading - (heading @ normal) * normal
    along /= np.linalg.norm(along) or 1.0
    return along


def _onto_singularity(det: Callable[[Array], Array], q: Array) -> Array:
    """Back onto det J = 0 by Newton steps along its gradient."""
    for _step in range(4):
        normal = _slope(det, q)
        size = float(normal @ normal)
        if size < 1e-18:  # where two loci cross the gradient vanishes: already on both
            break
        q = q - float(det(q)) / size * normal
    return q
