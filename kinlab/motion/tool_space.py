"""Motions of the tool: straight lines with slerp, arcs, blends; joints by inverse kinematics."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.structure.task_space import TaskSpace, read_reachable_task
from kinlab.arrays import Array, number, word
from kinlab.drives import laws
from kinlab.engine.fast.stacks import fk, jacobian
from kinlab.engine.kinematics import jacobian_dot
from kinlab.errors import OptionError
from kinlab.inverse.methods import pose_error
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.motion.follow import follow
from kinlab.motion.joint_space import STEP
from kinlab.motion.limits import read_limits, require_limits
from kinlab.motion.paths import Leg, TimedPath, read_legs
from kinlab.motion.record import Motion, even_times, hermite, motion_of

_DENSE = 4001
"""Times at which the tool's speed and acceleration are compared with their limits."""
_LEAST = 200
"""Samples inside a motion, whatever its step: the joints' curve is fitted through them."""


@dataclass(frozen=True)
class ToolLimits:
    """Largest speeds and accelerations of the tool: m/s, m/s², rad/s, rad/s²."""

    velocity: float
    acceleration: float
    angular_velocity: float
    angular_acceleration: float


def cartesian(
    robot: ArmLike,
    poses: Sequence[Any] | ArrayLike,
    *,
    q0: ArrayLike | None = None,
    law: str = "quintic",
    velocity: float | None = None,
    acceleration: float | None = None,
    angular_velocity: float | None = None,
    angular_acceleration: float | None = None,
    duration: float | None = None,
    blend: float = 0.0,
    joint_velocity: ArrayLike | None = None,
    joint_acceleration: ArrayLike | None = None,
    task: Any = "auto",
    step: float = STEP,
    seed: int = 0,
) -> Motion:
    """A motion of the tool through poses, along straight lines and arcs.

    The rotation of a leg goes about one axis at the law's pace (slerp). Joint positions come from
    :func:`kinlab.ik_path`; velocities and accelerations from the Jacobian and its derivative, at
    the samples; between them runs a curve of fifth degree, whose distance from the wanted path is
    measured and stands in ``remarks``. Arms with joints to spare move them as little as possible.

    Args:
        robot: the arm.
        poses: (4, 4) each, or :class:`kinlab.motion.Arc` for a leg along a circle; the first is
            where the motion starts.
        q0: joint positions at or near the start, (n,): they choose the branch.
        law: ``"quintic"`` or ``"trapezoid"``, for each leg.
        velocity, acceleration: largest of the tool, m/s and m/s².
        angular_velocity, angular_acceleration: rad/s and rad/s².
        duration: of the whole, s; left out, the shortest within the tool's limits.
        blend: part of the shorter neighbour that overlaps at a corner, from 0 (stop there) to 1.
        joint_velocity: largest |v| of the joints; left out, the robot's own.
        joint_acceleration: largest |a| of the joints; left out, any.
        task: which coordinates of the tool are held, as in :func:`kinlab.ik`; ``"auto"``: as
            many as the arm can move.
        step: largest time between the samples of the answer, s.
        seed: of the inverse kinematics.

    Returns:
        The motion; ``poses`` holds what the tool was asked to do at the samples.

    Raises:
        UnreachableError: a pose out of reach, or only on another branch; says when and where, and
            up to where the way can be had.
        SingularError: the way meets a singularity; says the same.
        LimitError: joint speeds or accelerations above their limits; says the duration that works.
        StateError, OptionError, NameUnknownError: arguments that cannot be used.
    """
    robot = as_robot(robot)
    start, legs = read_legs(robot.name, poses)
    caps = _read_caps(
        robot, legs, velocity, acceleration, angular_velocity, angular_acceleration, duration
    )
    planned = laws.LAWS[word(law, laws.LAWS, "law")]
    overlap = number(blend, "blend")
    if not 0.0 <= overlap <= 1.0:
        raise OptionError(f"blend is {overlap:g}; it must lie between 0 (stop) and 1")
    path = _timed(start, legs, planned, caps, overlap)
    if duration is not None:
        path = path.stretched(number(duration, "duration", above=0.0) / path.duration)
    space = read_reachable_task(robot, task)
    times = _sample_times(path, step)
    goals, _, _ = path.at(times)
    q = follow(robot, space, path, times, goals, q0, seed)
    curve = _joint_curve(space, path, times, q)
    require_limits(robot, curve, read_limits(robot, joint_velocity, joint_acceleration))
    miss, off = _miss(space, path, times, curve)
    remark = (
        f"between the samples the tool is at most {miss:.2g} m and {off:.2g} rad off the way, "
        "measured in their middles"
    )
    wanted = even_times(path.duration, step)
    goals, _, _ = path.at(wanted)
    return motion_of(robot.name, law, curve, step, goals, (remark,), wanted)


# -------- Times along the path


def _read_caps(
    robot: Robot,
    legs: tuple[Leg, ...],
    velocity: float | None,
    acceleration: float | None,
    angular_velocity: float | None,
    angular_acceleration: float | None,
    duration: float | None,
) -> ToolLimits:
    given = {
        "velocity": velocity,
        "acceleration": acceleration,
        "angular_velocity": angular_velocity,
        "angular_acceleration": angular_acceleration,
    }
    read = {
        name: np.inf if value is None else number(value, name, above=0.0)
        for name, value in given.items()
    }
    if duration is None:
        moves = any(leg.length > 0.0 for leg in legs)
        only_turns = any(leg.length == 0.0 for leg in legs)
        asked = (["acceleration"] if moves else []) + (
            ["angular_acceleration"] if only_turns else []
        )
        missing = [name for name in asked if not np.isfinite(read[name])]
        if missing:
            raise OptionError(
                f"robot {robot.name!r}: how fast? give {' and '.join(f'{m}=' for m in missing)} "
                "(and velocity=), or duration= (s)"
            )
    return ToolLimits(**read)


def _timed(
    start: Array, legs: tuple[Leg, ...], planned: Any, caps: ToolLimits, overlap: float
) -> TimedPath:
    """Legs one after the other, overlapping, slowed down as a whole to hold the tool's limits."""
    timed = []
    for leg in legs:
        turned = float(np.linalg.norm(leg.rotation_vector))
        speeds = [np.inf] + [
            bound / size
            for bound, size in ((caps.velocity, leg.length), (caps.angular_velocity, turned))
            if size > 0.0
        ]
        gains = [np.inf] + [
            bound / size
            for bound, size in (
                (caps.acceleration, leg.length),
                (caps.angular_acceleration, turned),
            )
            if size > 0.0
        ]
        if leg.angle:  # half of the square each for turning and for speeding up
            share = caps.acceleration / np.sqrt(2.0)
            speeds.append(float(np.sqrt(share / leg.curvature)) / leg.length)
            gains.append(share / leg.length)
        timed.append(planned(*laws.completed(min(speeds), min(gains), leg.length + turned)))
    spans = np.array([law.x[-1] for law in timed])
    lapped = overlap * np.minimum(spans[:-1], spans[1:])
    if len(spans) > 2:  # no more than two legs at a time
        lapped = np.minimum(lapped, 0.5 * np.minimum(spans[:-1], spans[1:]))
    begins = np.concatenate([[0.0], np.cumsum(spans[:-1] - lapped)])
    path = TimedPath(start, legs, tuple(timed), begins)
    t = np.union1d(np.linspace(0.0, path.duration, _DENSE), path.knots)
    factor = 0.0
    for side in ("left", "right"):
        _, twist, change = path.at(t, side)
        for bound, power, rows in (
            (caps.velocity, 1.0, twist[:, :3]),
            (caps.angular_velocity, 1.0, twist[:, 3:]),
            (caps.acceleration, 0.5, change[:, :3]),
            (caps.angular_acceleration, 0.5, change[:, 3:]),
        ):
            factor = max(factor, float(np.linalg.norm(rows, axis=1).max() / bound) ** power)
    return path.stretched(factor) if factor > 0.0 else path


def _sample_times(path: TimedPath, step: float) -> Array:
    """Evenly spaced between the knots, at most a step apart and _LEAST in all."""
    even_times(path.duration, step)  # refuses what is no step
    knots = path.knots
    wide = min(step, path.duration / _LEAST)
    parts = [
        np.linspace(a, b, max(2, int(np.ceil((b - a) / wide - 1e-9)) + 1))[:-1]
        for a, b in itertools.pairwise(knots)
    ]
    return np.concatenate([*parts, knots[-1:]])


# -------- Joints


def _joint_curve(space: TaskSpace, path: TimedPath, times: Array, q: Array) -> Any:
    """Velocities J⁺ V and accelerations at the samples, on both sides of each, as one curve."""
    rows = list(space.rows)
    jac = jacobian(space.robot, q)[:, rows]
    inverse = np.linalg.pinv(jac)
    sides = []
    v = np.empty_like(q)
    for side in ("left", "right"):
        _, twist, change = path.at(times, side)
        v = np.einsum("nij,nj->ni", inverse, twist[:, rows])
        slope = jacobian_dot(space.robot, q, v)[:, rows]
        rest = change[:, rows] - np.einsum("nij,nj->ni", slope, v)
        a = np.einsum("nij,nj->ni", inverse, rest)
        if space.m < space.robot.n:  # how the least-norm answer itself turns with the arm
            weight = np.einsum("nji,nj->ni", inverse, v)  # (J J^T)^-1 V
            pull = np.einsum("nji,nj->ni", slope, weight)
            a += pull - np.einsum("nij,njk,nk->ni", inverse, jac, pull)
        sides.append(a)
    return hermite(times, q, v, *sides)


def _miss(space: TaskSpace, path: TimedPath, times: Array, curve: Any) -> tuple[float, float]:
    """How far the tool is off the path between the samples: metres, rad."""
    middles = 0.5 * (times[1:] + times[:-1])
    goals, _, _ = path.at(middles)
    have = fk(space.robot, np.asarray(curve(middles)))
    errors = np.abs([pose_error(one, two) for one, two in zip(have, goals, strict=True)])
    errors[:, [row for row in range(6) if row not in space.rows]] = 0.0
    return float(errors[:, :3].max()), float(errors[:, 3:].max())
