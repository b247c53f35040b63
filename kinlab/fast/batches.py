"""Many states at once, each quantity by the fastest road there is.

Inverse and forward dynamics go through Pinocchio's parallel calls; poses, Jacobians, M, C and V,
which it has no parallel call for, through the compiled kernels. Each state is worked out by
itself, so the answers do not depend on the number of threads.

The arguments are checked already: q, v, ... are (N, n), float64, finite, contiguous.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.fast.arrays import chain, inertial_chain
from kinlab.fast.threads import thread_count
from kinlab.model.robot import Robot, model_pool


def inverse_dynamics(robot: Robot, q: Array, v: Array, a: Array) -> Array:
    """tau of each row, (N, n)."""
    return _parallel(pin.rneaInParallel, robot, q, v, a)


def forward_dynamics(robot: Robot, q: Array, v: Array, tau: Array) -> Array:
    """qddot of each row, (N, n)."""
    return _parallel(pin.abaInParallel, robot, q, v, tau)


def poses(robot: Robot, q: Array) -> Array:
    """Tool pose of each row, (N, 4, 4)."""
    from kinlab.fast.kinematics_kernels import fk_rows

    out = np.empty((len(q), 4, 4))
    _compiled(fk_rows, *chain(robot), q, out)
    return out


def jacobians(robot: Robot, q: Array, frame: str) -> Array:
    """Jacobian of each row in a named frame, (N, 6, n)."""
    from kinlab.fast.kinematics_kernels import jacobian_rows

    out = np.empty((len(q), 6, robot.n))
    _compiled(jacobian_rows, *chain(robot), q, out)
    if frame == "base":
        return out
    pose = poses(robot, q)
    if frame == "tool":
        axes = np.swapaxes(pose[:, :3, :3], 1, 2)
        return np.concatenate([axes @ out[:, :3], axes @ out[:, 3:]], axis=1)
    out[:, :3] += np.cross(pose[:, :3, 3:], out[:, 3:], axis=1)  # "spatial": v_O = v + p x w
    return out


def singular_values(robot: Robot, q: Array, rows: Array) -> Array:
    """Singular values of some rows of the Jacobian in the base's axes, largest first.

    Args:
        robot: the robot.
        q: (N, n).
        rows: (r,), indices into (v, w).

    Returns:
        (N, min(r, n)).
    """
    from kinlab.fast.kinematics_kernels import singular_value_rows

    out = np.empty((len(q), min(len(rows), robot.n)))
    _compiled(singular_value_rows, *chain(robot), q, np.ascontiguousarray(rows), out)
    return out


def mass_matrices(robot: Robot, q: Array) -> Array:
    """M of each row, (N, n, n)."""
    from kinlab.fast.dynamics_kernels import mass_matrix_rows

    out = np.empty((len(q), robot.n, robot.n))
    armature = np.array(robot.model.armature)
    _compiled(mass_matrix_rows, *inertial_chain(robot), armature, q, out)
    return out


def coriolis_matrices(robot: Robot, q: Array, v: Array) -> Array:
    """Christoffel's C of each row, (N, n, n)."""
    from kinlab.fast.dynamics_kernels import coriolis_rows

    out = np.empty((len(q), robot.n, robot.n))
    _compiled(coriolis_rows, *inertial_chain(robot), q, v, out)
    return out


def potential_energies(robot: Robot, q: Array) -> Array:
    """V of each row, (N,)."""
    from kinlab.fast.dynamics_kernels import potential_rows

    out = np.empty(len(q))
    arm = inertial_chain(robot)
    gravity = np.array(robot.model.gravity.linear)
    _compiled(potential_rows, arm.fixed, arm.prismatic, arm.mass, arm.com, gravity, q, out)
    return out


def _parallel(call: Any, robot: Robot, *stacks: Array) -> Array:
    rows = len(stacks[0])
    out = np.empty((rows, robot.n))
    if rows:
        threads = thread_count(rows)
        # transposed, since Pinocchio wants one state a column; the memory is the same
        call(threads, model_pool(robot, threads), *(stack.T for stack in stacks), out.T)
    return out


def _compiled(function: Any, *arguments: Array) -> None:
    from kinlab.fast.compiled import over_rows

    rows = len(arguments[-1])
    over_rows(function, rows, *arguments, threads=thread_count(rows))
