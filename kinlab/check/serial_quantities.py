"""Engine quantities of a serial arm: kinematics and dynamics."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab import dynamics, kinematics
from kinlab.arrays import Array
from kinlab.check.quantity import Quantity
from kinlab.check.serial import SERIAL
from kinlab.robot import Robot


def planar_pose(robot: Robot, q: Any) -> Array:
    """(x, y, phi) of the tool of an arm in the x-y plane; phi as cos and sin to avoid the wrap."""
    pose = kinematics.fk(robot, q)
    return np.stack([pose[..., 0, 3], pose[..., 1, 3], pose[..., 0, 0], pose[..., 1, 0]], axis=-1)


def planar_jacobian(robot: Robot, q: Any) -> Array:
    """Rows vx, vy, wz of the Jacobian in the base."""
    rows: Array = kinematics.jacobian(robot, q)[..., [0, 1, 5], :]
    return rows


def tip_speed_squared(robot: Robot, q: Any, v: Any) -> Array:
    """|J_v qdot|² of the tool origin."""
    speed = np.einsum("aij,aj->ai", kinematics.jacobian(robot, q)[:, :3], v)
    squared: Array = np.linalg.norm(speed, axis=1) ** 2
    return squared


def coriolis_torques(robot: Robot, q: Any, v: Any) -> Array:
    """C(q, v) v: what is left of the torque without gravity and acceleration."""
    still = np.zeros_like(np.asarray(q))
    tau: Array = dynamics.inverse_dynamics(robot, q, v, still) - dynamics.gravity_torques(robot, q)
    return tau


def _serial(name: str, arguments: str, engine: Any, about: str) -> Quantity:
    return Quantity(name, tuple(arguments.split()), engine, about, SERIAL)


QUANTITIES = (
    _serial("fk", "q", kinematics.fk, "pose of the tool in the base, (4, 4)"),
    _serial("jacobian", "q", kinematics.jacobian, "twist of the tool per qdot, base axes, (6, n)"),
    _serial(
        "jacobian_tool", "q", lambda r, q: kinematics.jacobian(r, q, "tool"),
        "twist of the tool per qdot, tool axes, (6, n)",
    ),
    _serial(
        "jacobian_spatial", "q", lambda r, q: kinematics.jacobian(r, q, "spatial"),
        "spatial Jacobian: base axes, reference point the base origin, (6, n)",
    ),
    _serial("jacobian_dot", "q v", kinematics.jacobian_dot, "its time derivative, base, (6, n)"),
    _serial("planar_pose", "q", planar_pose, "x, y, cos phi, sin phi of a planar arm's tool, (4,)"),
    _serial("planar_jacobian", "q", planar_jacobian, "rows vx, vy, wz of the Jacobian, (3, n)"),
    _serial("tip_speed_squared", "q v", tip_speed_squared, "|v|² of the tool, m²/s², a number"),
    _serial(
        "statics", "q wrench", kinematics.statics,
        "joint torques J^T F of a wrench (f, n) that the tool exerts, base axes, (n,)",
    ),
    _serial(
        "statics_tool", "q wrench", lambda r, q, w: kinematics.statics(r, q, w, "tool"),
        "the same, with the wrench in tool axes, (n,)",
    ),
    _serial("mass_matrix", "q", dynamics.mass_matrix, "M, kg m² (kg for a slide), (n, n)"),
    _serial("coriolis_matrix", "q v", dynamics.coriolis_matrix, "Christoffel's C, (n, n)"),
    _serial("coriolis_torques", "q v", coriolis_torques, "C(q, v) v, N m, (n,)"),
    _serial("gravity_torques", "q", dynamics.gravity_torques, "g = dV/dq, N m, (n,)"),
    _serial("inverse_dynamics", "q v a", dynamics.inverse_dynamics, "tau of a motion, N m, (n,)"),
    _serial(
        "inverse_dynamics_loaded", "q v a wrench", dynamics.inverse_dynamics,
        "tau of a motion while the tool exerts a wrench (f, n), base axes, (n,)",
    ),
    _serial("forward_dynamics", "q v tau", dynamics.forward_dynamics, "qddot, rad/s², (n,)"),
    _serial("kinetic_energy", "q v", dynamics.kinetic_energy, "T, J, a number"),
    _serial("potential_energy", "q", dynamics.potential_energy, "V, J, zero at the origin"),
)  # fmt: skip
