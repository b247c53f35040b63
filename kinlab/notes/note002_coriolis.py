"""Note 002, section 4.6: the Coriolis matrix, what is skew about it, the equation of motion."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.notes import arm as mass
from kinlab.notes.arm import Arm, Array, apply, geometric_jacobian, tool_pose, transpose

_SECTION = "note 002, section 4.6"
MOVING = (
    "planar2r",
    "planar2r_rods",
    "planar3r",
    "spatial3r",
    "scara",
    "stanford",
    "puma560",
    "puma560_modified",
    "panda",
    "ur5",
    "ur10",
)
"""Arms whose mass matrix changes with q; that of the single link is constant."""

_CHRISTOFFEL = (
    r"C_{ij} = \tfrac12 \sum_k \left( \fixed{\frac{\partial M_{ij}}{\partial q_k}}"
    r" + \frac{\partial M_{ik}}{\partial q_j} \fixed{-} \frac{\partial M_{jk}}{\partial q_i}"
    r" \right) \dot q_k"
)
_PRINTED = (
    r"C_{ij} = \tfrac12 \sum_k \left( \frac{\partial M_{ik}}{\partial q_j}"
    r" \wrong{+} \frac{\partial M_{jk}}{\partial q_i} \right) \dot q_k"
)
_MISPRINT = (
    "C_ij lacks dM_ij/dq_k and has the wrong sign before dM_jk/dq_i: it comes out symmetric, which "
    "Christoffel's C is not"
)


def coriolis(arm: Arm, q: Array, v: Array) -> Array:
    """Christoffel's C(q, qdot), (..., n, n)."""
    symbols: Array = np.einsum("...ijk,...k->...ij", mass.christoffel(arm, q), v)
    return symbols


def printed_coriolis(arm: Arm, q: Array, v: Array) -> Array:
    """The note's C."""
    one: Array = np.einsum("...ikj,...k->...ij", mass.mass_derivatives(arm, q), v)
    return 0.5 * (one + transpose(one))


def mass_rate(arm: Arm, q: Array, v: Array) -> Array:
    """Mdot = Σ dM/dq_k qdot_k, (..., n, n)."""
    rate: Array = np.einsum("...ijk,...k->...ij", mass.mass_derivatives(arm, q), v)
    return rate


def velocity_slope(arm: Arm, q: Array, v: Array) -> Array:
    """½ qdot^T dM/dq_i qdot, (..., n)."""
    slope: Array = 0.5 * np.einsum("...jki,...j,...k->...i", mass.mass_derivatives(arm, q), v, v)
    return slope


_coriolis = partial(formula, source=_SECTION, robots=MOVING)


@_coriolis(
    "002.C",
    part="C",
    quantity="coriolis_matrix",
    latex=_CHRISTOFFEL,
    printed=Printed(printed_coriolis, _MISPRINT, _PRINTED),
)
def coriolis_matrix(arm: Arm, q: Array, v: Array) -> Array:
    """The Coriolis matrix."""
    return coriolis(arm, q, v)


@_coriolis(
    "002.C",
    part="symmetry",
    quantity="mass_matrix_dot",
    latex=r"(\dot M - 2C)^T = -(\dot M - 2C) \Rightarrow \fixed{C_{ij} + C_{ji} = \dot M_{ij}}",
    printed=Printed(
        lambda arm, q, v: 2.0 * coriolis(arm, q, v),
        "from Mdot - 2C skew follows C_ij + C_ji = Mdot_ij, not C_ji = C_ij (shown: "
        "with C_ji = C_ij, Mdot would be 2C)",
        r"(\dot M - 2C)^T = -(\dot M - 2C) \Rightarrow \wrong{C_{ji} = C_{ij}}",
    ),
)
def mass_rate_by_symmetry(arm: Arm, q: Array, v: Array) -> Array:
    """Mdot is twice the symmetric part of C."""
    found = coriolis(arm, q, v)
    return np.asarray(found + transpose(found))


@_coriolis(
    "002.C",
    part="torque",
    quantity="coriolis_torques",
    latex=_CHRISTOFFEL + r",\quad \tau = C\dot q",
    printed=Printed(
        lambda arm, q, v: apply(printed_coriolis(arm, q, v), v),
        "the printed C gives wrong torques too: on the 2R arm C qd is off by "
        "m2 l1 l2 s2 (d2(2 d1 + d2)/2, -d1(4 d1 + 3 d2)/2)",
        _PRINTED + r",\quad \tau = C\dot q",
    ),
)
def coriolis_torques(arm: Arm, q: Array, v: Array) -> Array:
    """Coriolis and centrifugal torques."""
    return apply(coriolis(arm, q, v), v)


@_coriolis(
    "002.C",
    part="Mdot qd",
    quantity="mass_rate_velocity",
    latex=r"\dot M \dot q = \fixed{C \dot q + \tfrac12 \dot q^T \frac{\partial M}{\partial q}"
    r" \dot q}",
    printed=Printed(
        lambda arm, q, v: 2.0 * apply(coriolis(arm, q, v), v),
        "Mdot qd = 2 C qd does not follow from qd^T (Mdot - 2C) qd = 0: a vector is not zero "
        "because its product with qd is",
        r"\dot M \dot q = \wrong{2 C \dot q}",
    ),
)
def mass_rate_velocity(arm: Arm, q: Array, v: Array) -> Array:
    """What Mdot qd is, by C."""
    return apply(coriolis(arm, q, v), v) + velocity_slope(arm, q, v)


def _one_number(arm: Arm, q: Array, v: Array) -> Array:
    total = np.einsum("...j,...j->...", v, velocity_slope(arm, q, v))
    return np.broadcast_to(total[..., None], np.shape(q))


@_coriolis(
    "002.C",
    part="gradient",
    quantity="kinetic_gradient",
    latex=r"\left(\tfrac12 \dot q^T \frac{\partial M}{\partial q} \dot q\right)_{\fixed{i}} ="
    r" \tfrac12\, \dot q^T \frac{\partial M}{\partial q_{\fixed{i}}} \dot q",
    printed=Printed(
        _one_number,
        "the sum over j with qd_j turns the vector dT/dq into one number",
        r"\tfrac12 \dot q^T \frac{\partial M}{\partial q} \dot q = \tfrac12 \wrong{\sum_j \dot q_j}"
        r"\, \dot q^T \frac{\partial M}{\partial q_j} \dot q",
    ),
)
def kinetic_gradient(arm: Arm, q: Array, v: Array) -> Array:
    """dT/dq, entry by entry."""
    return velocity_slope(arm, q, v)


@_coriolis(
    "002.C",
    part="reduction",
    quantity="coriolis_torques",
    latex=r"C \dot q = \fixed{\dot M \dot q - \tfrac12 \dot q^T \frac{\partial M}{\partial q}"
    r" \dot q}",
    printed=Printed(
        lambda arm, q, v: 0.5 * apply(mass_rate(arm, q, v), v),
        "the derivation ends in C qd = ½ Mdot qd, which holds for the power qd^T C qd only",
        r"C \dot q = \wrong{\tfrac12 \dot M \dot q}",
    ),
)
def reduced_torques(arm: Arm, q: Array, v: Array) -> Array:
    """C qd as what is left of Lagrange's equation."""
    return apply(mass_rate(arm, q, v), v) - velocity_slope(arm, q, v)


@_coriolis(
    "002.skew",
    part="matrix",
    quantity="skew_matrix",
    latex=r"(\dot M - 2C)_{ij} = \sum_k \left( \fixed{\frac{\partial M_{jk}}{\partial q_i}"
    r" - \frac{\partial M_{ik}}{\partial q_j}} \right) \dot q_k",
    printed=Printed(
        lambda arm, q, v: mass_rate(arm, q, v) - 2.0 * printed_coriolis(arm, q, v),
        "with the printed C, Mdot - 2C is symmetric, not skew (the note's own S_ji = -S_ij "
        "exchanges nothing but names)",
        r"S_{ij} = \sum_k \left( \wrong{\frac{\partial M_{ij}}{\partial q_k}"
        r" - \frac{\partial M_{ik}}{\partial q_j} - \frac{\partial M_{jk}}{\partial q_i}} \right)"
        r" \dot q_k",
    ),
)
def skew_matrix(arm: Arm, q: Array, v: Array) -> Array:
    """Mdot - 2C, skew by its form."""
    one: Any = np.einsum("...ikj,...k->...ij", mass.mass_derivatives(arm, q), v)
    return np.asarray(transpose(one) - one)


@_coriolis(
    "002.skew",
    part="power",
    quantity="mass_rate_power",
    latex=r"\dot q^T (\dot M - 2C)\,\dot q = 0",
)
def no_power(arm: Arm, q: Array, v: Array) -> Any:
    """Coriolis torques do no work beyond ½ Mdot (relative to the two parts)."""
    del arm, v
    return np.zeros(np.shape(q)[:-1])


@formula(
    "002.eomC",
    source=_SECTION,
    quantity="inverse_dynamics_loaded",
    robots="serial",
    latex=r"M(q)\ddot q + C(q, \dot q)\dot q + G(q) = \tau + \tau_d",
    remark="tau_d is what the surroundings add: J^T times the force on the tool",
)
def equation_of_motion(arm: Arm, q: Array, v: Array, a: Array, wrench: Array) -> Array:
    """Joint torques with a disturbance at the tool."""
    point = tool_pose(arm, q)[..., :3, 3]
    disturbance = apply(transpose(geometric_jacobian(arm, q, point)), -wrench)
    inertia = apply(mass.mass_matrix(arm, q), a)
    velocity = apply(coriolis(arm, q, v), v)
    return inertia + velocity + mass.gravity_torques(arm, q) - disturbance
