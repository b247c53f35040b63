"""Forward kinematics, Jacobians and statics, by Pinocchio, for any number of states.

A stack is looped over; :mod:`kinlab.engine.fast.stacks` has the same functions with a faster road
for long stacks.
The one place that knows ``pin.ReferenceFrame``. Twists and wrenches are linear first, (v, w)
and (f, n); see :data:`FRAMES` for the three frames a Jacobian can be in.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.engine.states import joint_vector, joint_vectors
from kinlab.errors import NameUnknownError, StateError, near
from kinlab.host.answers import once
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot, frame_id, scratch

FRAMES = {
    "base": pin.ReferenceFrame.LOCAL_WORLD_ALIGNED,
    "tool": pin.ReferenceFrame.LOCAL,
    "spatial": pin.ReferenceFrame.WORLD,
}
"""``base``: axes of the base, reference point the tool origin (the textbook 0J). ``tool``: axes
of the tool, reference point the tool origin. ``spatial``: axes of the base, reference point the
base origin (Lynch & Park's space Jacobian)."""


def fk(robot: ArmLike, q: ArrayLike, at: str | None = None) -> Array:
    """Pose of the tool, or of another frame, in the base.

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n), rad or m.
        at: any frame of the robot by name, such as ``"camera_link"``; left out, the tool.

    Returns:
        Homogeneous transform, (4, 4) or (N, 4, 4).

    Raises:
        StateError: q of the wrong shape or type, or not finite.
        NameUnknownError: no frame of that name.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    q = joint_vector(robot, q, "q")
    return each_state(robot, frame_pose, q, place(robot, at))


def jacobian(robot: ArmLike, q: ArrayLike, frame: str = "base", at: str | None = None) -> Array:
    """Geometric Jacobian: twist of the tool (v, w) = J qdot (note 000, section 4).

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n).
        frame: ``"base"``, ``"tool"`` or ``"spatial"``; see :data:`FRAMES`.
        at: any frame of the robot by name, which then stands for the tool, also in what
            ``frame`` says; left out, the tool.

    Returns:
        (6, n) or (N, 6, n); rows 0 to 2 linear (m/s per unit), 3 to 5 angular.

    Raises:
        StateError: as :func:`fk`.
        NameUnknownError: another frame, or none of the name in ``at``.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    states = joint_vector(robot, q, "q")
    return each_state(robot, frame_jacobian, states, reference(frame), place(robot, at))


def jacobian_dot(
    robot: ArmLike, q: ArrayLike, v: ArrayLike, frame: str = "base", at: str | None = None
) -> Array:
    """Time derivative of the Jacobian along the motion v = qdot.

    Args:
        robot: the robot.
        q, v: joint positions and velocities, (n,) or (N, n).
        frame: as in :func:`jacobian`. In ``"tool"`` it is the derivative of the tool-frame
            Jacobian's entries; in ``"base"`` and ``"spatial"`` those of theirs.
        at: as in :func:`jacobian`.

    Returns:
        (6, n) or (N, 6, n).

    Raises:
        StateError, NameUnknownError: as :func:`jacobian`.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    q, v = joint_vectors(robot, q=q, v=v)
    return each_state(robot, _jacobian_dot, q, v, reference(frame), place(robot, at))


def statics(robot: ArmLike, q: ArrayLike, wrench: ArrayLike, frame: str = "base") -> Array:
    """Joint torques that hold a wrench which the tool exerts: tau = J^T F (note 000, 000.JTF).

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n).
        wrench: (f, n) that the tool exerts on the environment, N and N m, (6,) or (N, 6), in
            ``frame``.
        frame: as in :func:`jacobian`.

    Returns:
        tau, (n,) or (N, n), N m or N. Gravity is not in it.

    Raises:
        StateError, NameUnknownError: as :func:`jacobian`.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    q = joint_vector(robot, q, "q")
    force = wrench_for(robot, q, wrench)
    return held(jacobian(robot, q, frame), force)


def wrench_for(robot: Robot, q: Array, wrench: ArrayLike) -> Array:
    """Reads the wrench that goes with q, (6,) or (N, 6).

    Raises:
        StateError: as :func:`read_wrench`, or stacks of different length.
    """
    force = read_wrench(robot, wrench)
    if q.ndim == 2 and force.ndim == 2 and len(q) != len(force):
        raise StateError(
            f"robot {robot.name!r}: stacks of different length: q {q.shape}, wrench {force.shape}"
        )
    return force


def held(jacobians: Array, force: Array) -> Array:
    """tau = J^T F of (..., 6, n) and (..., 6)."""
    tau: Array = np.einsum("...ij,...i->...j", jacobians, force)
    return tau


def read_wrench(robot: Robot, wrench: ArrayLike) -> Array:
    """Reads a wrench (6,) or (N, 6), force first.

    Raises:
        StateError: another shape, or not finite.
    """
    force = real_array(wrench, f"robot {robot.name!r}: wrench")
    if force.ndim not in (1, 2) or force.shape[-1] != 6:
        raise StateError(
            f"robot {robot.name!r}: wrench has shape {force.shape}; expected (6,) or (N, 6), "
            "force first"
        )
    return force


def reference(frame: str) -> Any:
    """Pinocchio's reference frame for one of our names.

    Raises:
        NameUnknownError: another name.
    """
    try:
        return FRAMES[frame]
    except (KeyError, TypeError):
        raise NameUnknownError(f"frame {frame!r} is unknown; {near(str(frame), FRAMES)}") from None


def place(robot: Robot, at: str | None) -> int:
    """Index of the frame that a caller means: the tool where none is named.

    Raises:
        NameUnknownError: no frame of that name; the near names are listed.
    """
    return robot.tool if at is None else frame_id(robot, at)


def each_state(robot: Robot, single: Callable[..., Any], *arguments: Any) -> Array:
    """Applies ``single`` to one state, or to each row of a stack."""
    if arguments[0].ndim == 1:
        answer: Array = single(robot, *arguments)
        return answer
    rows: Array = once(_each_row, robot, single, *arguments)
    return rows


def _each_row(robot: Robot, single: Callable[..., Any], *arguments: Any) -> Array:
    first = arguments[0]
    stacks = [a for a in arguments if isinstance(a, np.ndarray)]
    rest = arguments[len(stacks) :]
    if not len(first):
        sample = single(robot, *(np.zeros(stack.shape[1:]) for stack in stacks), *rest)
        return np.empty((0, *np.shape(sample)))
    rows = zip(*stacks, strict=True)
    answer: Array = np.asarray(single(robot, *next(rows), *rest))
    out = np.empty((len(first), *answer.shape))
    out[0] = answer
    for i, row in enumerate(rows, 1):
        out[i] = single(robot, *row, *rest)
    return out


def each_call(robot: Robot, call: Any, *stacks: Array) -> Array:
    """Pinocchio's ``call(model, data, *state)`` for each row of stacks: half of the time of
    :func:`each_state` for what it answers by value."""
    rows: Array = once(_each_call, robot, call, *stacks)
    return rows


def _each_call(robot: Robot, call: Any, *stacks: Array) -> Array:
    model, data = robot.model, scratch(robot)
    if not len(stacks[0]):
        sample = call(model, data, *(np.zeros(robot.n) for _ in stacks))
        return np.empty((0, *np.shape(sample)))
    return np.array([call(model, data, *state) for state in zip(*stacks, strict=True)])


def frame_pose(robot: Robot, q: Array, index: int) -> Array:
    """:func:`fk` of one state that has been checked, of a frame by its index."""
    data = scratch(robot)
    pin.forwardKinematics(robot.model, data, q)
    pose: Array = pin.updateFramePlacement(robot.model, data, index).homogeneous
    return pose


def tool_poses(robot: Robot, q: Array) -> Array:
    """Tool poses (N, 4, 4) of states (N, n) that have been checked, each by Pinocchio.

    For those who have the last word: :func:`kinlab.fk` may run many on a compiled chain.
    """
    model, data, tool = robot.model, scratch(robot), robot.tool
    forward, place = pin.forwardKinematics, pin.updateFramePlacement
    poses = np.empty((len(q), 4, 4))
    for row, values in enumerate(q):
        forward(model, data, values)
        poses[row] = place(model, data, tool).homogeneous
    return poses


def frame_jacobian(robot: Robot, q: Array, frame: Any, index: int) -> Array:
    """As :func:`frame_pose` for :func:`jacobian`, with the axes in Pinocchio's name of them."""
    data = scratch(robot)
    pin.computeJointJacobians(robot.model, data, q)
    pin.updateFramePlacement(robot.model, data, index)
    jac: Array = pin.getFrameJacobian(robot.model, data, index, frame)
    return jac.reshape(6, robot.n)  # eigenpy hands out a matrix of one column as a vector


def _jacobian_dot(robot: Robot, q: Array, v: Array, frame: Any, index: int) -> Array:
    data = scratch(robot)
    pin.computeJointJacobiansTimeVariation(robot.model, data, q, v)
    pin.updateFramePlacement(robot.model, data, index)
    jac: Array = pin.getFrameJacobianTimeVariation(robot.model, data, index, frame)
    return jac.reshape(6, robot.n)
