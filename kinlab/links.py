"""Motion of the single links, by Pinocchio.

Link frame i lies on joint axis i and moves with link i, as Craig has it. It is DH frame i of a
modified table. In a standard table DH frame i sits at the far end of link i; the link frame is
the one before the row's Tx(a) Rx(alpha).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.kinematics import each_state
from kinlab.robot import Robot, scratch
from kinlab.states import joint_vector, joint_vectors


def link_poses(robot: Robot, q: ArrayLike) -> Array:
    """Poses of the link frames in the base.

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n), rad or m.

    Returns:
        (n, 4, 4) or (N, n, 4, 4).

    Raises:
        StateError: q of the wrong shape or type, or not finite.
    """
    return each_state(robot, _poses, joint_vector(robot, q, "q"))


def link_velocities(robot: Robot, q: ArrayLike, v: ArrayLike) -> Array:
    """Velocities (v, omega) of the link frames, each in its own axes (note 000, 000.vel).

    Args:
        robot: the robot.
        q, v: joint positions and velocities, (n,) or (N, n).

    Returns:
        (n, 6) or (N, n, 6); linear velocity of the frame's origin first, m/s and rad/s.

    Raises:
        StateError: as :func:`link_poses`.
    """
    return each_state(robot, _velocities, *joint_vectors(robot, q=q, v=v))


def link_accelerations(robot: Robot, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
    """Accelerations (v_dot, omega_dot) of the link frames in their own axes (000.ne.out).

    These are the accelerations of the frame's origin as a point (not spatial ones), the base at
    rest: gravity is not in them.

    Args:
        robot: the robot.
        q, v, a: joint positions, velocities and accelerations, (n,) or (N, n).

    Returns:
        (n, 6) or (N, n, 6), linear first, m/s² and rad/s².

    Raises:
        StateError: as :func:`link_poses`.
    """
    return each_state(robot, _accelerations, *joint_vectors(robot, q=q, v=v, a=a))


def com_accelerations(robot: Robot, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
    """Accelerations of the links' centres of mass, each in its link's axes (000.ne.com).

    Args, Raises: as :func:`link_accelerations`.

    Returns:
        (n, 3) or (N, n, 3), m/s²; gravity is not in them.
    """
    return each_state(robot, _com_accelerations, *joint_vectors(robot, q=q, v=v, a=a))


def com_positions(robot: Robot, q: ArrayLike) -> Array:
    """Centres of mass of the links in the base (note 002, 002.com).

    Args, Raises: as :func:`link_poses`.

    Returns:
        (n, 3) or (N, n, 3), m.
    """
    return each_state(robot, _com_positions, joint_vector(robot, q, "q"))


def com_jacobians(robot: Robot, q: ArrayLike) -> Array:
    """Jacobians of the links' centres of mass, base axes, linear rows first (002.M).

    Args, Raises: as :func:`link_poses`.

    Returns:
        (n, 6, n) or (N, n, 6, n): entry i maps qdot to (r_dot_i, omega_i).
    """
    return each_state(robot, _com_jacobians, joint_vector(robot, q, "q"))


def _poses(robot: Robot, q: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q)
    return np.stack([data.oMi[j].homogeneous for j in _joints(robot)])


def _velocities(robot: Robot, q: Array, v: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q, v)
    return np.stack([data.v[j].vector for j in _joints(robot)])


def _accelerations(robot: Robot, q: Array, v: Array, a: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q, v, a)
    local = pin.ReferenceFrame.LOCAL
    return np.stack(
        [pin.getClassicalAcceleration(robot.model, data, j, local).vector for j in _joints(robot)]
    )


def _com_accelerations(robot: Robot, q: Array, v: Array, a: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q, v, a)
    answers = []
    for j in _joints(robot):
        centre = pin.SE3(np.eye(3), robot.model.inertias[j].lever)
        velocity, spatial = centre.actInv(data.v[j]), centre.actInv(data.a[j])
        answers.append(spatial.linear + np.cross(velocity.angular, velocity.linear))
    return np.stack(answers)


def _com_positions(robot: Robot, q: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q)
    return np.stack([data.oMi[j].act(robot.model.inertias[j].lever) for j in _joints(robot)])


def _com_jacobians(robot: Robot, q: Array) -> Array:
    data = scratch(robot)
    pin.computeJointJacobians(robot.model, data, q)
    frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    answers = []
    for j in _joints(robot):
        jacobian = pin.getJointJacobian(robot.model, data, j, frame).reshape(6, robot.n)
        arm = data.oMi[j].rotation @ robot.model.inertias[j].lever
        jacobian[:3] += np.cross(jacobian[3:], arm, axisa=0, axisc=0)
        answers.append(jacobian)
    return np.stack(answers)


def _joints(robot: Robot) -> Any:
    return range(1, robot.model.njoints)
