"""Engine quantities of single links, of dM/dq, and of Lagrange's equation."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.serial import SERIAL
from kinlab.engine import dynamics, lagrange, links
from kinlab.model.robot import Robot


def mass_rate_power(robot: Robot, q: Any, v: Any) -> Any:
    """v^T (Mdot - 2 C) v / (|v^T Mdot v| + |2 v^T C v|): 0 where Mdot - 2C is skew."""
    rate = np.einsum("ai,aij,aj->a", v, lagrange.mass_matrix_dot(robot, q, v), v)
    coriolis = 2.0 * np.einsum("ai,aij,aj->a", v, dynamics.coriolis_matrix(robot, q, v), v)
    size = np.abs(rate) + np.abs(coriolis)
    return (rate - coriolis) / np.where(size > 0.0, size, 1.0)


def mass_rate_velocity(robot: Robot, q: Any, v: Any) -> Any:
    """Mdot qdot."""
    return np.einsum("aij,aj->ai", lagrange.mass_matrix_dot(robot, q, v), v)


def skew_matrix(robot: Robot, q: Any, v: Any) -> Array:
    """Mdot - 2C."""
    rate = lagrange.mass_matrix_dot(robot, q, v)
    return rate - 2.0 * dynamics.coriolis_matrix(robot, q, v)


def half_velocity_gradient(robot: Robot, q: Any, v: Any) -> Any:
    """½ v^T dM/dq v = dT/dq."""
    slope = lagrange.mass_matrix_derivatives(robot, q)
    return 0.5 * np.einsum("ai,aijk,aj->ak", v, slope, v)


def inverse_without_gravity(robot: Robot, q: Any, v: Any, a: Any) -> Array:
    """M a + C v."""
    return dynamics.inverse_dynamics(robot, q, v, a) - dynamics.gravity_torques(robot, q)


_ROWS: tuple[tuple[str, str, Any, str], ...] = (
    (
        "link_poses",
        "q",
        links.link_poses,
        "poses in the base of the frames at each link's own joint, as Craig's, (n, 4, 4)",
    ),
    (
        "link_velocities",
        "q v",
        links.link_velocities,
        "(v, omega) of the frames of link_poses, link axes, (n, 6)",
    ),
    (
        "link_accelerations",
        "q v a",
        links.link_accelerations,
        "(v_dot, omega_dot) of the frames of link_poses, link axes, without gravity, (n, 6)",
    ),
    ("com_positions", "q", links.com_positions, "centres of mass in the base, m, (n, 3)"),
    ("com_jacobians", "q", links.com_jacobians, "of each centre, base axes, (n, 6, n)"),
    (
        "com_accelerations",
        "q v a",
        links.com_accelerations,
        "axes of the frames of link_poses, m/s², (n, 3)",
    ),
    (
        "joint_wrenches",
        "q v a wrench",
        links.joint_wrenches,
        "(f_i, n_i) through joint i, axes as link_poses; the tool exerts a wrench, (n, 6)",
    ),
    (
        "static_wrenches",
        "q wrench",
        links.static_wrenches,
        "the same at rest without gravity, (n, 6)",
    ),
    (
        "inertial_wrenches",
        "q v a",
        links.inertial_wrenches,
        "(F_i, N_i) at C_i, axes as link_poses, (n, 6)",
    ),
    ("link_kinetic_energies", "q v", links.link_kinetic_energies, "k_i, J, (n,)"),
    ("link_potential_energies", "q", links.link_potential_energies, "u_i, J, (n,)"),
    ("christoffel", "q", lagrange.christoffel, "D_ijk, (n, n, n)"),
    ("mass_matrix_derivatives", "q", lagrange.mass_matrix_derivatives, "dM_ij/dq_k, (n, n, n)"),
    ("mass_matrix_dot", "q v", lagrange.mass_matrix_dot, "Mdot, (n, n)"),
    ("mass_rate_velocity", "q v", mass_rate_velocity, "Mdot qdot, (n,)"),
    ("skew_matrix", "q v", skew_matrix, "Mdot - 2C, (n, n)"),
    ("mass_rate_power", "q v", mass_rate_power, "v^T (Mdot - 2C) v over its parts' size"),
    (
        "coriolis_coefficients",
        "q",
        lagrange.coriolis_coefficients,
        "B of the MVG form, (n, n(n-1)/2)",
    ),
    (
        "centrifugal_coefficients",
        "q",
        lagrange.centrifugal_coefficients,
        "C of the MVG form, (n, n)",
    ),
    ("lagrangian", "q v", lagrange.lagrangian, "L = T - V, J, a number"),
    ("momentum", "q v", lagrange.momentum, "dL/dqdot, (n,)"),
    ("momentum_rate", "q v a", lagrange.momentum_rate, "d/dt dL/dqdot, N m, (n,)"),
    ("lagrangian_gradient", "q v", lagrange.lagrangian_gradient, "dL/dq, N m, (n,)"),
    ("kinetic_gradient", "q v", half_velocity_gradient, "dT/dq, N m, (n,)"),
    (
        "lagrange_torques",
        "q v a",
        lagrange.lagrange_torques,
        "tau by differentiation of the energies, N m, (n,)",
    ),
    ("inverse_without_gravity", "q v a", inverse_without_gravity, "M a + C v, N m, (n,)"),
)

QUANTITIES = tuple(
    SERIAL.quantity(*row, scale=1.0 if row[0] == "mass_rate_power" else 0.0) for row in _ROWS
)
