"""Engine quantities of single links, of dM/dq, and of Lagrange's equation."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.quantity import Quantity
from kinlab.check.quantities.serial import SERIAL
from kinlab.engine import dynamics, links
from kinlab.engine import lagrange as energies
from kinlab.engine import lagrange as mass_derivatives
from kinlab.engine import links as link_forces
from kinlab.model.robot import Robot


def mass_rate_power(robot: Robot, q: Any, v: Any) -> Array:
    """v^T (Mdot - 2 C) v / (|v^T Mdot v| + |2 v^T C v|): 0 where Mdot - 2C is skew."""
    rate = np.einsum("ai,aij,aj->a", v, mass_derivatives.mass_matrix_dot(robot, q, v), v)
    coriolis = 2.0 * np.einsum("ai,aij,aj->a", v, dynamics.coriolis_matrix(robot, q, v), v)
    size = np.abs(rate) + np.abs(coriolis)
    share: Array = (rate - coriolis) / np.where(size > 0.0, size, 1.0)
    return share


def mass_rate_velocity(robot: Robot, q: Any, v: Any) -> Array:
    """Mdot qdot."""
    product: Array = np.einsum("aij,aj->ai", mass_derivatives.mass_matrix_dot(robot, q, v), v)
    return product


def skew_matrix(robot: Robot, q: Any, v: Any) -> Array:
    """Mdot - 2C."""
    rate = mass_derivatives.mass_matrix_dot(robot, q, v)
    matrix: Array = rate - 2.0 * dynamics.coriolis_matrix(robot, q, v)
    return matrix


def half_velocity_gradient(robot: Robot, q: Any, v: Any) -> Array:
    """½ v^T dM/dq v = dT/dq."""
    slope = mass_derivatives.mass_matrix_derivatives(robot, q)
    gradient: Array = 0.5 * np.einsum("ai,aijk,aj->ak", v, slope, v)
    return gradient


def inverse_without_gravity(robot: Robot, q: Any, v: Any, a: Any) -> Array:
    """M a + C v."""
    tau: Array = dynamics.inverse_dynamics(robot, q, v, a) - dynamics.gravity_torques(robot, q)
    return tau


_ROWS: tuple[tuple[str, str, Any, str], ...] = (
    ("link_poses", "q", links.link_poses, "poses of the link frames in the base, (n, 4, 4)"),
    ("link_velocities", "q v", links.link_velocities, "(v, omega), link axes, (n, 6)"),
    (
        "link_accelerations",
        "q v a",
        links.link_accelerations,
        "(v_dot, omega_dot), link axes, without gravity, (n, 6)",
    ),
    ("com_positions", "q", links.com_positions, "centres of mass in the base, m, (n, 3)"),
    ("com_jacobians", "q", links.com_jacobians, "of each centre, base axes, (n, 6, n)"),
    ("com_accelerations", "q v a", links.com_accelerations, "link axes, m/s², (n, 3)"),
    (
        "joint_wrenches",
        "q v a wrench",
        link_forces.joint_wrenches,
        "(f_i, n_i) through joint i, link axes; the tool exerts a wrench, (n, 6)",
    ),
    (
        "static_wrenches",
        "q wrench",
        link_forces.static_wrenches,
        "the same at rest without gravity, (n, 6)",
    ),
    ("inertial_wrenches", "q v a", link_forces.inertial_wrenches, "(F_i, N_i) at C_i, (n, 6)"),
    ("link_kinetic_energies", "q v", link_forces.link_kinetic_energies, "k_i, J, (n,)"),
    ("link_potential_energies", "q", link_forces.link_potential_energies, "u_i, J, (n,)"),
    ("christoffel", "q", mass_derivatives.christoffel, "D_ijk, (n, n, n)"),
    (
        "mass_matrix_derivatives",
        "q",
        mass_derivatives.mass_matrix_derivatives,
        "dM_ij/dq_k, (n, n, n)",
    ),
    ("mass_matrix_dot", "q v", mass_derivatives.mass_matrix_dot, "Mdot, (n, n)"),
    ("mass_rate_velocity", "q v", mass_rate_velocity, "Mdot qdot, (n,)"),
    ("skew_matrix", "q v", skew_matrix, "Mdot - 2C, (n, n)"),
    ("mass_rate_power", "q v", mass_rate_power, "v^T (Mdot - 2C) v over its parts' size"),
    (
        "coriolis_coefficients",
        "q",
        mass_derivatives.coriolis_coefficients,
        "B of the MVG form, (n, n(n-1)/2)",
    ),
    (
        "centrifugal_coefficients",
        "q",
        mass_derivatives.centrifugal_coefficients,
        "C of the MVG form, (n, n)",
    ),
    ("lagrangian", "q v", energies.lagrangian, "L = T - V, J, a number"),
    ("momentum", "q v", energies.momentum, "dL/dqdot, (n,)"),
    ("momentum_rate", "q v a", energies.momentum_rate, "d/dt dL/dqdot, N m, (n,)"),
    ("lagrangian_gradient", "q v", energies.lagrangian_gradient, "dL/dq, N m, (n,)"),
    ("kinetic_gradient", "q v", half_velocity_gradient, "dT/dq, N m, (n,)"),
    (
        "lagrange_torques",
        "q v a",
        energies.lagrange_torques,
        "tau by differentiation of the energies, N m, (n,)",
    ),
    ("inverse_without_gravity", "q v a", inverse_without_gravity, "M a + C v, N m, (n,)"),
)

_SCALES = {"mass_rate_power": 1.0}

QUANTITIES = tuple(
    Quantity(name, tuple(arguments.split()), engine, about, SERIAL, scale=_SCALES.get(name, 0.0))
    for name, arguments, engine, about in _ROWS
)
