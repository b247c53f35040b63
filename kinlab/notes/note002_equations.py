"""Note 002: Lagrange's equation, its terms, and the single-joint example."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.formula import Printed, formula
from kinlab.notes import mass
from kinlab.notes.arm import Arm, Array, apply, columns, lengths
from kinlab.notes.note002_coriolis import mass_rate, velocity_slope

_EQUATION = "note 002, section 4.1 and core principle"
_TERMS = "note 002, sections 4.2 to 4.5"
_EXAMPLE = "note 002, section 4.7, single joint"


@formula(
    "002.Mdot",
    part="d/dt dL/dqd",
    source=_TERMS,
    quantity="momentum_rate",
    robots="serial",
    latex=r"\frac{d}{dt}(M \dot q) = \dot M \dot q + M \ddot q",
)
def momentum_rate(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Rate of the generalized momentum."""
    return apply(mass_rate(arm, q, v), v) + apply(mass.mass_matrix(arm, q), a)


@formula(
    "002.Mdot",
    part="dL/dqd",
    source=_TERMS,
    quantity="momentum",
    robots="serial",
    latex=r"\frac{\partial L}{\partial \dot q} = M(q)\,\dot q",
)
def momentum(arm: Arm, q: Array, v: Array) -> Array:
    """The generalized momentum."""
    return apply(mass.mass_matrix(arm, q), v)


@formula(
    "002.Mdot",
    part="Mdot",
    source=_TERMS,
    quantity="mass_matrix_dot",
    robots="serial",
    latex=r"\dot M = \sum_j \frac{\partial M}{\partial q_j} \dot q_j",
)
def mass_matrix_dot(arm: Arm, q: Array, v: Array) -> Array:
    """Rate of the mass matrix."""
    return mass_rate(arm, q, v)


@formula(
    "002.Mdot",
    part="dL/dq",
    source=_TERMS,
    quantity="lagrangian_gradient",
    robots="serial",
    latex=r"\frac{\partial L}{\partial q} = \tfrac12\, \dot q^T \frac{\partial M}{\partial q}"
    r" \dot q - G(q)",
)
def lagrangian_gradient(arm: Arm, q: Array, v: Array) -> Array:
    """Gradient of the Lagrangian."""
    return velocity_slope(arm, q, v) - mass.gravity_torques(arm, q)


def _reversed(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    return lagrangian_gradient(arm, q, v) - momentum_rate(arm, q, v, a)


@formula(
    "002.el",
    source=_EQUATION,
    quantity="inverse_dynamics",
    robots="serial",
    latex=r"\fixed{\frac{d}{dt}\frac{\partial L}{\partial \dot q}"
    r" - \frac{\partial L}{\partial q}} = Q",
    printed=Printed(
        _reversed,
        "wrong sign: dL/dq - d/dt dL/dqd is -Q (the note has it right in section 4.1)",
        r"\wrong{\frac{\partial L}{\partial q}"
        r" - \frac{d}{dt}\frac{\partial L}{\partial \dot q}} = Q",
    ),
)
def lagrange_equation(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Lagrange's equation with a generalized force."""
    return momentum_rate(arm, q, v, a) - lagrangian_gradient(arm, q, v)


def _pendulum(arm: Arm) -> tuple[float, float]:
    """I about the joint and m g l_c."""
    (l,) = lengths(arm)
    centre = l + arm.com[0, 0]
    inertia = arm.inertia[0, 2, 2] + arm.mass[0] * centre**2
    return inertia, arm.mass[0] * -arm.gravity[1] * centre


def _from_upright(q: Array) -> Any:
    """The note's q: zero where the link points straight up, so that V = m g l_c cos q."""
    return columns(q)[0] - np.pi / 2


def _pendulum_printed(arm: Arm, q: Array, v: Array, a: Array) -> Any:
    del v
    inertia, weight = _pendulum(arm)
    return inertia * columns(a)[0] + weight * np.sin(_from_upright(q))


@formula(
    "002.pend",
    part="torque",
    source=_EXAMPLE,
    quantity="inverse_dynamics[0]",
    robots="single_link",
    latex=r"V = m g l_c \cos q \Rightarrow I \ddot q \fixed{-} m g l_c \sin q = \tau",
    printed=Printed(
        _pendulum_printed,
        "with V = m g l_c cos q the gravity torque is -m g l_c sin q; the printed sign measures q "
        "from hanging down",
        r"V = m g l_c \cos q \Rightarrow I \ddot q \wrong{+} m g l_c \sin q = \tau",
    ),
)
def pendulum_torque(arm: Arm, q: Array, v: Array, a: Array) -> Any:
    """Equation of the single joint, q from upright."""
    del v
    inertia, weight = _pendulum(arm)
    return inertia * columns(a)[0] - weight * np.sin(_from_upright(q))


def _lagrangian_printed(arm: Arm, q: Array, v: Array) -> Any:
    inertia, weight = _pendulum(arm)
    return 0.5 * inertia * columns(v)[0] ** 2 + weight * np.cos(_from_upright(q))


@formula(
    "002.pend",
    part="L",
    source=_EXAMPLE,
    quantity="lagrangian",
    robots="single_link",
    latex=r"L = T - V = \tfrac12 I \dot q^2 \fixed{-} m g l_c \cos q",
    printed=Printed(
        _lagrangian_printed,
        "L = T - V is printed T + V (two lines on the note has it right)",
        r"L = T - V = \tfrac12 I \dot q^2 \wrong{+} m g l_c \cos q",
    ),
)
def pendulum_lagrangian(arm: Arm, q: Array, v: Array) -> Any:
    """Lagrangian of the single joint, q from upright."""
    inertia, weight = _pendulum(arm)
    return 0.5 * inertia * columns(v)[0] ** 2 - weight * np.cos(_from_upright(q))


@formula(
    "002.pend",
    part="dL/dq",
    source=_EXAMPLE,
    quantity="lagrangian_gradient[0]",
    robots="single_link",
    latex=r"\frac{\partial L}{\partial q} = m g l_c \sin q",
)
def pendulum_gradient(arm: Arm, q: Array, v: Array) -> Any:
    """Gradient of the single joint's Lagrangian, q from upright."""
    del v
    return _pendulum(arm)[1] * np.sin(_from_upright(q))
