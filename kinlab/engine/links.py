"""The single links, by Pinocchio: their motion, the wrenches on them, their energies."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.engine.kinematics import each_state, read_wrench
from kinlab.engine.states import joint_vector, joint_vectors
from kinlab.errors import StateError
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot, require_inertia, scratch

# -------- Motion of the single links, by Pinocchio
# Link frame i lies on joint axis i and moves with link i, as Craig has it. It is DH frame i of a
# modified table. In a standard table DH frame i sits at the far end of link i; the link frame is
# the one before the row's Tx(a) Rx(alpha).


def link_poses(robot: ArmLike, q: ArrayLike) -> Array:
    """Poses of the link frames in the base, each at its link's own joint.

    These are Craig's frames: of a standard table, too, where DH frame i sits at the link's far end.

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n), rad or m.

    Returns:
        (n, 4, 4) or (N, n, 4, 4).

    Raises:
        StateError: q of the wrong shape or type, or not finite.
    """
    robot = as_robot(robot)
    return each_state(robot, _poses, joint_vector(robot, q, "q"))


def link_velocities(robot: ArmLike, q: ArrayLike, v: ArrayLike) -> Array:
    """Velocities (v, omega) of the link frames, each in its own axes (note 000, 000.vel).

    The frames are those of :func:`link_poses`, at each link's own joint.

    Args:
        robot: the robot.
        q, v: joint positions and velocities, (n,) or (N, n).

    Returns:
        (n, 6) or (N, n, 6); linear velocity of the frame's origin first, m/s and rad/s.

    Raises:
        StateError: as :func:`link_poses`.
    """
    robot = as_robot(robot)
    return each_state(robot, _velocities, *joint_vectors(robot, q=q, v=v))


def link_accelerations(robot: ArmLike, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
    """Accelerations (v_dot, omega_dot) of the link frames in their own axes (000.ne.out).

    The frames are those of :func:`link_poses`, at each link's own joint.

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
    robot = as_robot(robot)
    return each_state(robot, _accelerations, *joint_vectors(robot, q=q, v=v, a=a))


def com_accelerations(robot: ArmLike, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
    """Accelerations of the links' centres of mass, each in its link's axes (000.ne.com).

    Args, Raises: as :func:`link_accelerations`.

    Returns:
        (n, 3) or (N, n, 3), m/s²; gravity is not in them.
    """
    robot = as_robot(robot)
    return each_state(robot, _com_accelerations, *joint_vectors(robot, q=q, v=v, a=a))


def com_positions(robot: ArmLike, q: ArrayLike) -> Array:
    """Centres of mass of the links in the base (note 002, 002.com).

    Args, Raises: as :func:`link_poses`.

    Returns:
        (n, 3) or (N, n, 3), m.
    """
    robot = as_robot(robot)
    return each_state(robot, _com_positions, joint_vector(robot, q, "q"))


def com_jacobians(robot: ArmLike, q: ArrayLike) -> Array:
    """Jacobians of the links' centres of mass, base axes, linear rows first (002.M).

    Args, Raises: as :func:`link_poses`.

    Returns:
        (n, 6, n) or (N, n, 6, n): entry i maps qdot to (r_dot_i, omega_i).
    """
    robot = as_robot(robot)
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


# -------- Forces and energies of the single links, by Pinocchio
# Link frames are those of the first part. The components of a joint's wrench off its axis do
# not show in tau; the bearings and the link carry them, which is what a strength check needs
# (note 000, statics).


def joint_wrenches(
    robot: ArmLike, q: ArrayLike, v: ArrayLike, a: ArrayLike, wrench: ArrayLike | None = None
) -> Array:
    """Wrench (f_i, n_i) that link i-1 puts on link i through joint i (000.ne.in).

    Args:
        robot: the robot.
        q, v, a: joint positions, velocities and accelerations, (n,) or (N, n).
        wrench: (f, n) that the tool exerts on the environment, base axes, reference point the
            tool origin, (6,) or (N, 6), N and N m.

    Returns:
        (n, 6) or (N, n, 6), force first, in the axes of link frame i about its origin; gravity
        is in it. Entry 5 (revolute) or 2 (prismatic) is the joint's torque or force without the
        armature's share, its sign turned where the joint moves against its axis.

    Raises:
        StateError: an argument of the wrong shape or type, or not finite.
        InertiaError: a joint moves no inertia.
    """
    robot = as_robot(robot)
    require_inertia(robot)
    q, v, a = joint_vectors(robot, q=q, v=v, a=a)
    load = _loads(robot, q, np.zeros(6) if wrench is None else wrench)
    return each_state(robot, _wrenches, q, v, a, load)


def static_wrenches(robot: ArmLike, q: ArrayLike, wrench: ArrayLike) -> Array:
    """Joint wrenches (f_i, n_i) of an arm at rest that holds a load, without gravity (000.force).

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n).
        wrench: as in :func:`joint_wrenches`.

    Returns:
        (n, 6) or (N, n, 6), force first, in the axes of link frame i about its origin.

    Raises:
        StateError: as :func:`joint_wrenches`.
    """
    robot = as_robot(robot)
    q = joint_vector(robot, q, "q")
    return each_state(robot, _static, q, _loads(robot, q, wrench))


def inertial_wrenches(robot: ArmLike, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
    """F_i = m v_dot_C and N_i = I omega_dot + omega x I omega of each link (000.ne.FN).

    Args:
        robot: the robot.
        q, v, a: joint positions, velocities and accelerations, (n,) or (N, n).

    Returns:
        (n, 6) or (N, n, 6): F, then N about the centre of mass, in the link's axes. Gravity is
        not in it.

    Raises:
        StateError, InertiaError: as :func:`joint_wrenches`.
    """
    robot = as_robot(robot)
    require_inertia(robot)
    return each_state(robot, _inertial, *joint_vectors(robot, q=q, v=v, a=a))


def link_kinetic_energies(robot: ArmLike, q: ArrayLike, v: ArrayLike) -> Array:
    """k_i = ½ m v_C² + ½ omega^T I omega of each link (000.lag), without armatures.

    Args:
        robot: the robot.
        q, v: joint positions and velocities, (n,) or (N, n).

    Returns:
        (n,) or (N, n), J. Their sum and ½ Σ armature qdot² make ``kl.kinetic_energy``.

    Raises:
        StateError, InertiaError: as :func:`joint_wrenches`.
    """
    robot = as_robot(robot)
    require_inertia(robot)
    return each_state(robot, _kinetic, *joint_vectors(robot, q=q, v=v))


def link_potential_energies(robot: ArmLike, q: ArrayLike) -> Array:
    """u_i = -m_i g^T P_C of each link, zero at the base origin (000.lag).

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n).

    Returns:
        (n,) or (N, n), J. Their sum is ``kl.potential_energy``.

    Raises:
        StateError, InertiaError: as :func:`joint_wrenches`.
    """
    robot = as_robot(robot)
    require_inertia(robot)
    return each_state(robot, _potential, joint_vector(robot, q, "q"))


def _loads(robot: Robot, q: Array, wrench: ArrayLike) -> Array:
    load = read_wrench(robot, wrench)
    if (q.ndim == 1 and load.ndim == 2) or (q.ndim == 2 and load.ndim == 2 and len(q) != len(load)):
        raise StateError(
            f"robot {robot.name!r}: stacks of different length: q {q.shape}, wrench {load.shape}"
        )
    return load if q.ndim == 1 else np.broadcast_to(load, (len(q), 6))


def _external(robot: Robot, data: Any, load: Array) -> Any:
    """What the environment does to each body, in the joints' own frames."""
    model = robot.model
    frame = model.frames[robot.tool]
    forces = [pin.Force.Zero() for _ in range(model.njoints)]
    joint = data.oMi[frame.parentJoint]
    tool = joint * frame.placement
    aligned = joint.inverse() * pin.SE3(np.eye(3), tool.translation)
    forces[frame.parentJoint] = aligned.act(pin.Force(-load[:3], -load[3:]))
    return pin.StdVec_Force(forces)


def _wrenches(robot: Robot, q: Array, v: Array, a: Array, load: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q)
    pin.rnea(robot.model, data, q, v, a, _external(robot, data, load))
    return np.stack([data.f[j].vector for j in _joints(robot)])


def _static(robot: Robot, q: Array, load: Array) -> Array:
    still = np.zeros(robot.n)
    own = _wrenches(robot, q, still, still, np.zeros(6))
    return _wrenches(robot, q, still, still, load) - own


def _inertial(robot: Robot, q: Array, v: Array, a: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q, v, a)
    answers = []
    for j in _joints(robot):
        inertia = robot.model.inertias[j]
        force = inertia * data.a[j] + inertia.vxiv(data.v[j])
        answers.append(pin.SE3(np.eye(3), inertia.lever).actInv(force).vector)
    return np.stack(answers)


def _kinetic(robot: Robot, q: Array, v: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q, v)
    inertias = robot.model.inertias
    return np.array([0.5 * inertias[j].vtiv(data.v[j]) for j in _joints(robot)])


def _potential(robot: Robot, q: Array) -> Array:
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q)
    gravity = robot.model.gravity.linear
    inertias = robot.model.inertias
    return np.array(
        [-inertias[j].mass * gravity @ data.oMi[j].act(inertias[j].lever) for j in _joints(robot)]
    )
