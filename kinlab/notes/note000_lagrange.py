"""Note 000, dynamics 2 and 3: the MVG form and the energies of the links."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.formula import Printed, formula
from kinlab.notes import mass
from kinlab.notes.arm import Arm, Array, apply
from kinlab.notes.note000_newton_euler import torques


def _motion_torques(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Newton-Euler without gravity, v and a the same at every state."""
    shape = np.shape(q)
    return torques(arm, q, np.broadcast_to(v, shape), np.broadcast_to(a, shape), None, np.zeros(3))


@formula(
    "000.MVG",
    part="M",
    source="note 000, dynamics 2",
    quantity="mass_matrix",
    robots="serial",
    latex=r"M e_j = \tau(q, 0, e_j) - G",
)
def mvg_mass(arm: Arm, q: Array) -> Array:
    """M read off Newton-Euler at unit accelerations."""
    still = np.zeros(arm.n)
    return np.stack([_motion_torques(arm, q, still, e) for e in np.eye(arm.n)], axis=-1)


@formula(
    "000.MVG",
    part="B",
    source="note 000, dynamics 2",
    quantity="coriolis_coefficients",
    robots=("planar2r", "planar3r", "spatial3r", "scara", "stanford", "puma560", "panda", "ur5"),
    latex=r"V = \underbrace{B(\theta)}_{n \times \binom n2} [\dot\theta_i \dot\theta_j]_{i<j}"
    r" + C(\theta)[\dot\theta^2]",
)
def mvg_products(arm: Arm, q: Array) -> Array:
    """B read off Newton-Euler at pairs of unit velocities."""
    units, still = np.eye(arm.n), np.zeros(arm.n)
    squares = mvg_squares(arm, q)
    pairs = zip(*np.triu_indices(arm.n, 1), strict=True)
    return np.stack(
        [
            _motion_torques(arm, q, units[j] + units[k], still) - squares[..., j] - squares[..., k]
            for j, k in pairs
        ],
        axis=-1,
    )


@formula(
    "000.MVG",
    part="C",
    source="note 000, dynamics 2",
    quantity="centrifugal_coefficients",
    robots="serial",
    latex=r"V = B(\theta)[\dot\theta_i \dot\theta_j] + C(\theta)[\dot\theta^2]",
)
def mvg_squares(arm: Arm, q: Array) -> Array:
    """C read off Newton-Euler at unit velocities."""
    still = np.zeros(arm.n)
    return np.stack([_motion_torques(arm, q, e, still) for e in np.eye(arm.n)], axis=-1)


@formula(
    "000.MVG",
    part="G",
    source="note 000, dynamics 2",
    quantity="gravity_torques",
    robots="serial",
    latex=r"G = \tau(q, 0, 0)",
)
def mvg_gravity(arm: Arm, q: Array) -> Array:
    """G is the torque at rest."""
    still = np.zeros(np.shape(q))
    return torques(arm, q, still, still, None, arm.gravity)


@formula(
    "000.MVG",
    part="tau",
    source="note 000, dynamics 2",
    quantity="inverse_dynamics",
    robots="serial",
    latex=r"\tau = M \ddot\theta + B[\dot\theta_i\dot\theta_j] + C[\dot\theta^2] + G",
)
def mvg_torques(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """The four terms together, M, B and C from the link Jacobians."""
    symbols = mass.christoffel(arm, q)
    j, k = np.triu_indices(arm.n, 1)
    products: Array = np.einsum("...ip,...p->...i", 2.0 * symbols[..., j, k], v[..., j] * v[..., k])
    squares: Array = np.einsum("...ijj,...j->...i", symbols, v * v)
    inertia = apply(mass.mass_matrix(arm, q), a)
    return inertia + products + squares + mass.gravity_torques(arm, q)


@formula(
    "000.lag",
    part="k",
    source="note 000, dynamics 3",
    quantity="link_kinetic_energies",
    robots="serial",
    latex=r"k_i = \tfrac12 m_i \lVert \vec v_{C_i} \rVert^2 + \tfrac12 \omega_i^T I_i\,\omega_i",
)
def kinetic_energies(arm: Arm, q: Array, v: Array) -> Any:
    """Kinetic energy of every link, v_C = d/dt P_C in the base."""
    body = mass.links(arm, q)
    linear = np.einsum("...ljc,...j->...lc", body.linear, v)
    omega = np.einsum("...ljc,...j->...lc", body.angular, v)
    turning = np.einsum("...la,...lab,...lb->...l", omega, body.inertias, omega)
    return 0.5 * arm.mass * np.sum(linear * linear, axis=-1) + 0.5 * turning


def _u_printed(arm: Arm, q: Array) -> Any:
    up = -arm.gravity / np.linalg.norm(arm.gravity)
    height = mass.centres(arm, q) @ up
    return -arm.mass * np.linalg.norm(arm.gravity) * height


@formula(
    "000.lag",
    part="u",
    source="note 000, dynamics 3",
    quantity="link_potential_energies",
    robots="serial",
    latex=r"u_i = \fixed{+m_i g h_i} = -m_i\, \vec g^T \vec P_{C_i}",
    printed=Printed(
        _u_printed,
        "u = -mgh has the wrong sign: with the vector g pointing down, -m g^T P is +mgh",
        r"u_i = \wrong{-m_i g h_i} = -m_i\, \vec g^T \vec P_{C_i}",
    ),
)
def potential_energies(arm: Arm, q: Array) -> Any:
    """Potential energy of every link."""
    return -arm.mass * (mass.centres(arm, q) @ arm.gravity)


@formula(
    "000.lag",
    part="tau",
    source="note 000, dynamics 3",
    quantity="inverse_dynamics",
    robots="serial",
    latex=r"\tau_i = \frac{d}{dt}\frac{\partial k}{\partial \dot\theta_i}"
    r" - \frac{\partial k}{\partial \theta_i} + \frac{\partial u}{\partial \theta_i}",
)
def lagrange_torques(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Joint torques by differentiation of the energies, exactly."""
    slope = mass.mass_derivatives(arm, q)
    turning: Array = np.einsum("...ijk,...k,...j->...i", slope, v, v)
    rate = turning + apply(mass.mass_matrix(arm, q), a)
    gradient: Array = 0.5 * np.einsum("...ijk,...i,...j->...k", slope, v, v)
    return rate - gradient + mass.gravity_torques(arm, q)
