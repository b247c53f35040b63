"""The way back: any serial robot to a modified DH table, dynamics included.

Frames are placed as note 000 (section 3) and Craig (section 3.4) say: z_i along joint axis i,
x_i along the common normal of axes i and i+1; where they intersect, x_i = z_i x z_{i+1} / norm;
where they are parallel, frame i stands so that d_i = 0. The world's own z axis is axis 0, so the
table's ``base`` is a turn and a shift about it, and frame n goes on along x_{n-1}.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.errors import StructureError
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.model.urdf_write import written
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True)
class Axis:
    """A joint axis in the world at q = 0: a point on it (metres), its direction, its kind."""

    point: Array
    direction: Array
    joint: str


def to_dh(robot: ArmLike) -> DHTable:
    """Extracts the modified DH table of a serial robot.

    Args:
        robot: the arm (what :func:`kinlab.model.library.as_robot` takes).

    Returns:
        A table with the robot's frames, limits, inertias, armatures, friction and gravity: FK, M
        and g are those of the robot at the same q. Its ``source`` states the measured difference
        of the tool poses.

    Raises:
        StructureError: the joints branch, a joint has several degrees of freedom, or two axes
            are so nearly parallel that no DH table can hold the arm.
    """
    robot = as_robot(robot)
    model, data = robot.model, robot.model.createData()
    zero = np.zeros(robot.n)
    pin.computeJointJacobians(model, data, zero)
    pin.updateFramePlacements(model, data)
    axes = [Axis(np.zeros(3), np.array([0.0, 0.0, 1.0]), "world"), *_axes(model, data)]
    frames = _frames(axes)
    links = [_link(model, data, frames, axes, i) for i in range(1, robot.n + 1)]
    table = DHTable(
        name=robot.name,
        convention="modified",
        links=links,
        base=_clean(frames[0]),
        tool=_clean(_inverse(frames[-1]) @ data.oMf[robot.tool].homogeneous),
        gravity=np.array(model.gravity.linear),
        source=f"extracted from {robot.source or robot.name}",
        tool_name=_tool_name(robot),
        unphysical=any(link.inertia_flaw is not None for link in links),
    )
    miss = _pose_difference(robot, table)
    # near-parallel axes put the common normal far away, where rounding is magnified
    if miss > 1e4 * TOLERANCES.round_trip:
        raise StructureError(
            f"robot {robot.name!r}: two joint axes are nearly but not quite parallel; its best DH "
            f"table misses the tool by {miss:.2g} m. DH parameters cannot hold this arm"
        )
    return replace(table, source=f"{table.source}; tool poses agree to {miss:.1g}")


def as_table(arm: ArmLike) -> DHTable:
    """The DH table of an arm: its own, or the one that :func:`to_dh` extracts.

    Raises:
        KinlabError: as :func:`kinlab.model.library.as_robot` and :func:`to_dh`.
    """
    if isinstance(arm, DHTable):
        return arm
    robot = as_robot(arm)
    return to_dh(robot) if robot.table is None else robot.table


def to_urdf(table: ArmLike) -> str:
    """The URDF of an arm: written from its DH table, or the text that it was read from.

    Args:
        table: a DH table, or anything that names an arm.

    Returns:
        URDF text; of a table, as :func:`kinlab.model.urdf_write.written` says.

    Raises:
        KinlabError: as :func:`kinlab.model.library.as_robot` and :func:`to_dh`.
    """
    if isinstance(table, DHTable):
        return written(table)
    robot = as_robot(table)
    return robot.urdf or written(as_table(robot))


def _axes(model: Any, data: Any) -> list[Axis]:
    axes = []
    for j in range(1, model.njoints):
        # eigenpy hands out a matrix of one column as a vector
        column = data.J.reshape(6, model.nv)[:, model.joints[j].idx_v]
        turns = np.linalg.norm(column[3:]) > 0.5
        direction = column[3:] if turns else column[:3]
        unit = direction / np.linalg.norm(direction)
        kind = "revolute" if turns else "prismatic"
        axes.append(Axis(np.array(data.oMi[j].translation), unit, kind))
    return axes


def _frames(axes: list[Axis]) -> list[Array]:
    """DH frames 0 to n in the world at q = 0."""
    frames: list[Array] = []
    foot, x = axes[0].point, np.array([1.0, 0.0, 0.0])
    for i in range(len(axes) - 1):
        origin, x, foot_next = _common_normal(axes[i], axes[i + 1], foot, x)
        frames.append(_frame(origin, x, axes[i].direction))
        foot = foot_next
    last = axes[-1].direction
    x = x - (x @ last) * last
    frames.append(_frame(foot, x / np.linalg.norm(x), last))
    return frames


def _common_normal(one: Axis, two: Axis, foot: Array, x: Array) -> tuple[Array, Array, Array]:
    """The common normal of two axes.

    Args:
        one, two: the axes.
        foot: where the normal before this one met axis ``one``.
        x: the direction of the normal before this one.

    Returns:
        Its foot on axis ``one``, its unit direction, its foot on axis ``two``.
    """
    z1, z2 = one.direction, two.direction
    cross = np.cross(z1, z2)
    sine = np.linalg.norm(cross)
    if sine < TOLERANCES.parallel_axes:
        gap = two.point - foot
        gap = gap - (gap @ z1) * z1
        length = float(np.linalg.norm(gap))
        if length > TOLERANCES.intersecting_axes:
            return foot, gap / length, foot + gap
        # the same line: nothing turns x away from the one before, made exact to this axis
        along = x - (x @ z1) * z1
        return foot, along / np.linalg.norm(along), foot
    normal = cross / sine
    between = two.point - one.point
    s = float(np.cross(between, z2) @ cross) / sine**2
    t = float(np.cross(between, z1) @ cross) / sine**2
    start, end = one.point + s * z1, two.point + t * z2
    length = float(between @ normal)
    if length < -TOLERANCES.intersecting_axes:
        normal = -normal
    return start, normal, end


def _frame(origin: Array, x: Array, z: Array) -> Array:
    out = np.eye(4)
    out[:3, 0], out[:3, 1], out[:3, 2], out[:3, 3] = x, np.cross(z, x), z, origin
    return out


def _inverse(pose: Array) -> Array:
    out = np.eye(4)
    out[:3, :3] = pose[:3, :3].T
    out[:3, 3] = -pose[:3, :3].T @ pose[:3, 3]
    return out


def _link(model: Any, data: Any, frames: list[Array], axes: list[Axis], i: int) -> DHLink:
    step = _inverse(frames[i - 1]) @ frames[i]
    alpha = math.atan2(-step[1, 2], step[2, 2])
    theta = math.atan2(-step[0, 1], step[0, 0])
    d = float((frames[i][:3, 3] - frames[i - 1][:3, 3]) @ frames[i][:3, 2])
    inertia = pin.SE3(_inverse(frames[i])).act(data.oMi[i].act(model.inertias[i]))
    k = model.joints[i].idx_v
    return DHLink(
        joint="revolute" if axes[i].joint == "revolute" else "prismatic",
        a=_tidy(float(step[0, 3]), 0.0),
        alpha=_tidy(alpha, math.pi / 2),
        d=_tidy(d, 0.0),
        theta=_tidy(theta, math.pi / 2),
        lower=float(model.lowerPositionLimit[k]),
        upper=float(model.upperPositionLimit[k]),
        velocity=_finite(model.upperVelocityLimit[k], DHLink.velocity),
        effort=_finite(model.upperEffortLimit[k], DHLink.effort),
        mass=float(inertia.mass),
        com=np.array(inertia.lever),
        inertia=0.5 * (inertia.inertia + inertia.inertia.T),
        armature=float(model.armature[k]),
        viscous_friction=float(model.damping[k]),
        coulomb_friction=float(model.friction[k]),
        name=str(model.names[i]),
    )


def _finite(value: float, default: float) -> float:
    return float(value) if math.isfinite(value) else default


def _tidy(value: float, unit: float) -> float:
    """Rounding residue of zero, or of a multiple of ``unit``, becomes the number itself."""
    nearest = round(value / unit) * unit if unit else 0.0
    return nearest + 0.0 if abs(value - nearest) < TOLERANCES.residue else value


def _clean(pose: Array) -> Array:
    rounded = np.round(pose)
    return np.asarray(np.where(np.abs(pose - rounded) < TOLERANCES.residue, rounded + 0.0, pose))


def _tool_name(robot: Robot) -> str:
    name = robot.tool_name
    ours = name in ("base_link", "universe") or name.startswith(("link_", "dh_"))
    return "tool" if ours else name


def _pose_difference(robot: Robot, table: DHTable) -> float:
    """Largest entry of the difference of tool poses over seeded states."""
    rng = np.random.default_rng(0)
    data = robot.model.createData()
    miss = 0.0
    for q in rng.uniform(-3.0, 3.0, (8, robot.n)):
        pin.forwardKinematics(robot.model, data, q)
        pose = pin.updateFramePlacement(robot.model, data, robot.tool).homogeneous
        miss = max(miss, float(np.max(np.abs(table.fk(q)[-1] - pose))))
    return miss
