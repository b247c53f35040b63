"""The engine's functions with a faster road for long stacks of states: the one door to this room.

Short stacks and single states are the engine's own (:mod:`kinlab.engine.kinematics`,
:mod:`kinlab.engine.dynamics`); long ones take a faster road, with the same answers to rounding:
inverse and forward dynamics go through Pinocchio's parallel calls; poses and Jacobians, which it
has no parallel call for, through the compiled chain. M, C and the energies have no faster road:
a rigid-body engine of our own was 1.5 to 3.7 times faster than Pinocchio on threads, and a second
engine is worth that only from 3 times on, at every length of stack. Each state is worked out by
itself, so the answers do not depend on the number of threads. Check and doctor do not use this
module: what they call the engine is Pinocchio for any number of states.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, TypeVar

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.engine import dynamics, kinematics
from kinlab.engine.dynamics import gravity
from kinlab.engine.fast.arrays import chain
from kinlab.engine.fast.threads import STATES_PER_THREAD, over_rows, thread_count
from kinlab.engine.kinematics import (
    each_call,
    each_state,
    frame_jacobian,
    frame_pose,
    held,
    place,
    reference,
    wrench_for,
)
from kinlab.engine.states import joint_vector
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot, model_pool, require_inertia

COMPILED_FROM = 256
"""Stacks at least this long take the faster road. Below, loading the kernels (0.5 s, once a
process) is out of proportion to a loop of 1 to 2 µs a state."""

PARALLEL_FROM = 32
"""Stacks at least this long go through Pinocchio's parallel calls, which need no kernels. Below, a
call's own 15 µs outweigh what it saves over a loop."""

_Function = TypeVar("_Function", bound=Callable[..., Any])


def _documented(engine: Callable[..., Any]) -> Callable[[_Function], _Function]:
    """Gives a function the docstring of the engine's, whose arguments and answers it shares."""

    def mark(function: _Function) -> _Function:
        function.__doc__ = engine.__doc__
        return function

    return mark


@_documented(kinematics.fk)
def fk(robot: ArmLike, q: ArrayLike, at: str | None = None) -> Array:
    if type(robot) is not Robot:
        robot = as_robot(robot)
    q = joint_vector(robot, q, "q")
    index = robot.tool if at is None else place(robot, at)
    if q.ndim == 1:
        return frame_pose(robot, q, index)
    if len(q) >= COMPILED_FROM and index == robot.tool:  # the compiled chain ends at the tool
        return _poses(robot, q)
    return each_state(robot, frame_pose, q, index)


@_documented(kinematics.jacobian)
def jacobian(robot: ArmLike, q: ArrayLike, frame: str = "base", at: str | None = None) -> Array:
    if type(robot) is not Robot:
        robot = as_robot(robot)
    q = joint_vector(robot, q, "q")
    axes = reference(frame)
    index = robot.tool if at is None else place(robot, at)
    if q.ndim == 1:
        return frame_jacobian(robot, q, axes, index)
    if len(q) >= COMPILED_FROM and index == robot.tool:
        return _jacobians(robot, q, frame)
    return each_state(robot, frame_jacobian, q, axes, index)


@_documented(kinematics.statics)
def statics(robot: ArmLike, q: ArrayLike, wrench: ArrayLike, frame: str = "base") -> Array:
    if type(robot) is not Robot:
        robot = as_robot(robot)
    q = joint_vector(robot, q, "q")
    force = wrench_for(robot, q, wrench)
    return held(jacobian(robot, q, frame), force)


@_documented(dynamics.gravity_torques)
def gravity_torques(robot: ArmLike, q: ArrayLike) -> Array:
    if type(robot) is not Robot:
        robot = as_robot(robot)
    require_inertia(robot)
    q = joint_vector(robot, q, "q")
    if q.ndim == 1:
        return gravity(robot, q)
    if len(q) >= PARALLEL_FROM:
        rest = np.zeros_like(q)
        return _in_parallel(pin.rneaInParallel, robot, pin.rnea, q, rest, rest)
    return each_state(robot, gravity, q)


@_documented(dynamics.inverse_dynamics)
def inverse_dynamics(
    robot: ArmLike,
    q: ArrayLike,
    v: ArrayLike,
    a: ArrayLike,
    wrench: ArrayLike | None = None,
    friction: bool = False,
) -> Array:
    return dynamics.inverse_dynamics(robot, q, v, a, wrench, friction, _ROADS)


@_documented(dynamics.forward_dynamics)
def forward_dynamics(
    robot: ArmLike,
    q: ArrayLike,
    v: ArrayLike,
    tau: ArrayLike,
    wrench: ArrayLike | None = None,
    friction: bool = False,
) -> Array:
    return dynamics.forward_dynamics(robot, q, v, tau, wrench, friction, _ROADS)


def singular_values(robot: Robot, q: Array, rows: Array) -> Array:
    """Singular values of some rows of the Jacobian in the base's axes, largest first.

    Args:
        robot: the robot.
        q: (N, n).
        rows: (r,), indices into (v, w).

    Returns:
        (N, min(r, n)).
    """
    from kinlab.engine.fast.kinematics_kernels import singular_value_rows

    out = np.empty((len(q), min(len(rows), robot.n)))
    _on_threads(singular_value_rows, *chain(robot), q, np.ascontiguousarray(rows), out)
    return out


# -------- The roads. The arguments are checked: q, v, ... are (N, n), float64, finite, contiguous


def _poses(robot: Robot, q: Array) -> Array:
    """Tool pose of each row, (N, 4, 4)."""
    from kinlab.engine.fast.kinematics_kernels import fk_rows

    out = np.empty((len(q), 4, 4))
    _on_threads(fk_rows, *chain(robot), q, out)
    return out


def _jacobians(robot: Robot, q: Array, frame: str) -> Array:
    """Jacobian of each row in a named frame, (N, 6, n)."""
    from kinlab.engine.fast.kinematics_kernels import jacobian_rows

    out = np.empty((len(q), 6, robot.n))
    _on_threads(jacobian_rows, *chain(robot), q, out)
    if frame == "base":
        return out
    pose = _poses(robot, q)
    if frame == "tool":
        axes = np.swapaxes(pose[:, :3, :3], 1, 2)
        return np.concatenate([axes @ out[:, :3], axes @ out[:, 3:]], axis=1)
    out[:, :3] += np.cross(pose[:, :3, 3:], out[:, 3:], axis=1)  # "spatial": v_O = v + p x w
    return out


def _in_parallel(call: Any, robot: Robot, one: Any, *stacks: Array) -> Array:
    """Pinocchio's parallel ``call``; short stacks take ``one``, state by state."""
    rows = len(stacks[0])
    if rows < PARALLEL_FROM:
        return each_call(robot, one, *stacks)
    out = np.empty((rows, robot.n))
    threads = thread_count(rows)
    # transposed, since Pinocchio wants one state a column; the memory is the same
    call(threads, model_pool(robot, threads), *(stack.T for stack in stacks), out.T)
    return out


_ROADS = dynamics.Roads(
    partial(_in_parallel, pin.rneaInParallel), partial(_in_parallel, pin.abaInParallel), statics
)


def _on_threads(function: Any, *arguments: Array) -> None:
    rows = len(arguments[-1])
    if rows < 2 * STATES_PER_THREAD:
        function(*arguments, 0, rows)
    else:
        over_rows(function, rows, *arguments, threads=thread_count(rows))
