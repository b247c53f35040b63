"""Wrist, shoulder, elbow: what the geometry of the joint axes calls a singularity.

Names follow Craig, *Introduction to Robotics*, section 5.8, and Hawkins, "Analytic inverse
kinematics for the Universal Robots UR-5/UR-10 arms" (2013). An arm whose structure is none of
those below has no such names, and gets none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.engine.fast.stacks import fk, jacobian
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True)
class Axes:
    """The joint axes at one q in the base.

    Attributes:
        turns: which joints are revolute, (n,).
        direction: unit vectors, (n, 3).
        point: a point on each revolute axis, (n, 3); zero for prismatic joints.
    """

    turns: Array
    direction: Array
    point: Array

    @staticmethod
    def at(robot: Robot, q: Array) -> Axes:
        """The axes at q."""
        spatial = jacobian(robot, q, "spatial").T
        linear, angular = spatial[:, :3], spatial[:, 3:]
        turns = np.linalg.norm(angular, axis=1) > 0.5
        direction = np.where(turns[:, np.newaxis], angular, linear)
        return Axes(turns, direction, np.cross(angular, linear))

    def parallel(self, i: int, j: int) -> bool:
        """Whether axes i and j have the same direction or the opposite one."""
        return (
            float(np.linalg.norm(np.cross(self.direction[i], self.direction[j])))
            < TOLERANCES.axes_meet
        )

    def column(self, i: int, at: Array) -> Array:
        """Velocity of the point ``at`` per unit speed of joint i, (3,)."""
        if not self.turns[i]:
            slide: Array = self.direction[i]
            return slide
        velocity: Array = np.cross(self.direction[i], at - self.point[i])
        return velocity


def frame_origins(robot: Robot, q: Array) -> Array:
    """Origins of the base, the joint frames and the tool, (n + 2, 3)."""
    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, q)
    joints = [placement.translation for placement in list(data.oMi)[1:]]
    return np.array([np.zeros(3), *joints, fk(robot, q)[:3, 3]])


def first_axis(robot: Robot) -> tuple[Array, Array]:
    """A point of the first axis, nearest to the base's origin, and its direction, (3,) each."""
    axes = Axes.at(robot, np.zeros(robot.n))
    axis, origin = axes.direction[0], axes.point[0]
    axis = axis * np.sign(axis[int(np.argmax(np.abs(axis)))])  # z points up, however joint 1 turns
    return origin - axis * float(origin @ axis), axis


def meeting_point(axes: Axes, joints: tuple[int, ...]) -> Array | None:
    """The point where these revolute axes meet, (3,), or ``None``."""
    chosen = list(joints)
    if not axes.turns[chosen].all():
        return None
    # the point nearest to the lines, by least squares on (1 - z z^T)(p - c) = 0
    planes = [np.eye(3) - np.outer(z, z) for z in axes.direction[chosen]]
    left = np.concatenate(planes)
    right = np.concatenate([a @ p for a, p in zip(planes, axes.point[chosen], strict=True)])
    centre, *_ = np.linalg.lstsq(left, right, rcond=None)
    return centre if float(np.linalg.norm(left @ centre - right)) < TOLERANCES.axes_meet else None


def wrist_centre(axes: Axes) -> Array | None:
    """The point where the last three revolute axes meet, or ``None``."""
    n = len(axes.turns)
    return meeting_point(axes, (n - 3, n - 2, n - 1)) if n >= 4 else None


def structure(robot: Robot) -> str:
    """What the arm is: ``planar``, ``wrist-partitioned``, ``parallel-arm``, ``regional``,
    ``anthropomorphic-7`` or ``""``.

    planar: every axis parallel, two or three revolute joints. wrist-partitioned: six joints,
    the last three meeting in one point. parallel-arm: six revolute joints, the second to fourth
    parallel (UR). regional: three joints that place a point. anthropomorphic-7: seven revolute
    joints, the first three meeting in one point and the last three in another (SRS).
    """
    q = np.random.default_rng(1).uniform(-1.0, 1.0, robot.n)
    axes = Axes.at(robot, q)
    if axes.turns.all() and all(axes.parallel(0, i) for i in range(1, robot.n)):
        return "planar" if robot.n in (2, 3) else ""
    if robot.n == 6 and wrist_centre(axes) is not None:
        return "wrist-partitioned"
    if robot.n == 6 and axes.turns.all() and axes.parallel(1, 2) and axes.parallel(2, 3):
        return "parallel-arm"
    if (
        robot.n == 7
        and wrist_centre(axes) is not None
        and meeting_point(axes, (0, 1, 2)) is not None
    ):
        return "anthropomorphic-7"
    return "regional" if robot.n == 3 else ""


def name_singularity(robot: Robot, kind: str, q: Array, deciding: tuple[int, ...]) -> str:
    """``wrist``, ``elbow``, ``shoulder`` (joined by " + " where several hold), or ``""``.

    Args:
        robot: the robot; its task has as many rows as it has joints, or it has one joint more
            and is ``anthropomorphic-7``.
        kind: answer of :func:`structure`.
        q: a singular configuration, (n,).
        deciding: indices of the joints that decide; used where the arm has seven joints.
    """
    axes = Axes.at(robot, q)
    match kind:
        case "anthropomorphic-7":
            parts = (("shoulder", {0, 1, 2}), ("elbow", {3}), ("wrist", {4, 5, 6}))
            return " + ".join(name for name, joints in parts if joints & set(deciding))
        case "planar":
            return "elbow"
        case "wrist-partitioned":
            centre = wrist_centre(axes)
            if centre is None:
                return ""
            names = _regional(axes, centre)
            if _flat(axes.direction[3:]):
                names = ["wrist", *names]
            return " + ".join(names)
        case "parallel-arm":
            names = ["wrist"] if _flat(axes.direction[[3, 5]]) else []
            planar = np.stack([axes.point[i] - axes.point[1] for i in (2, 3)])
            side = planar - np.outer(planar @ axes.direction[1], axes.direction[1])
            names += ["elbow"] if _flat(side) else []
            return " + ".join(names or ["shoulder"])
        case "regional":
            return " + ".join(_regional(axes, fk(robot, q)[:3, 3]))
        case _:
            return ""


def _regional(axes: Axes, point: Array) -> list[str]:
    """Names for the first three joints carrying ``point``; none unless axes 2 and 3 are parallel
    (an anthropomorphic arm) or the third joint slides (then only the shoulder has a name)."""
    columns = np.stack([axes.column(i, point) for i in range(3)])
    if not axes.turns[2]:
        return ["shoulder"] if _flat(columns) else []
    if not axes.parallel(1, 2):
        return []
    names = []
    if _flat(columns[1:]):
        names.append("elbow")
    # the arm's plane is normal to axis 2; joint 1 must move the point out of it
    out = abs(float(columns[0] @ axes.direction[1]))
    if out < TOLERANCES.dependent * float(np.linalg.norm(columns)):
        names.append("shoulder")
    return names


def _flat(rows: Array) -> bool:
    """Whether vectors (k, 3) are linearly dependent."""
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    if float(lengths.min()) < TOLERANCES.dependent * float(lengths.max()):
        return True
    values = np.linalg.svd(rows / lengths, compute_uv=False)
    return bool(values[-1] < TOLERANCES.dependent)
