"""Note 002: Lagrange's equation term by term, the single joint, the least action."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.notes import arm as mass
from kinlab.notes.arm import Arm, Array, apply, columns, dot, lengths
from kinlab.notes.note000_dynamics import torques
from kinlab.notes.note002_coriolis import mass_rate, velocity_slope

# -------- Note 002: Lagrange's equation, its terms, and the single-joint example

_EQUATION = "note 002, section 4.1 and core principle"


_term = partial(formula, "002.Mdot", source="note 002, sections 4.2 to 4.5", robots="serial")


@_term(
    part="d/dt dL/dqd",
    quantity="momentum_rate",
    latex=r"\frac{d}{dt}(M \dot q) = \dot M \dot q + M \ddot q",
)
def momentum_rate(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Rate of the generalized momentum."""
    return apply(mass_rate(arm, q, v), v) + apply(mass.mass_matrix(arm, q), a)


@_term(
    part="dL/dqd", quantity="momentum", latex=r"\frac{\partial L}{\partial \dot q} = M(q)\,\dot q"
)
def momentum(arm: Arm, q: Array, v: Array) -> Array:
    """The generalized momentum."""
    return apply(mass.mass_matrix(arm, q), v)


@_term(
    part="Mdot",
    quantity="mass_matrix_dot",
    latex=r"\dot M = \sum_j \frac{\partial M}{\partial q_j} \dot q_j",
)
def mass_matrix_dot(arm: Arm, q: Array, v: Array) -> Array:
    """Rate of the mass matrix."""
    return mass_rate(arm, q, v)


@_term(
    part="dL/dq",
    quantity="lagrangian_gradient",
    latex=r"\frac{\partial L}{\partial q} = \tfrac12\, \dot q^T \frac{\partial M}{\partial q}"
    r" \dot q - G(q)",
)
def lagrangian_gradient(arm: Arm, q: Array, v: Array) -> Array:
    """Gradient of the Lagrangian."""
    return velocity_slope(arm, q, v) - mass.gravity_torques(arm, q)


@formula(
    "002.el",
    source=_EQUATION,
    quantity="inverse_dynamics",
    robots="serial",
    latex=r"\fixed{\frac{d}{dt}\frac{\partial L}{\partial \dot q}"
    r" - \frac{\partial L}{\partial q}} = Q",
    printed=Printed(
        lambda arm, q, v, a: lagrangian_gradient(arm, q, v) - momentum_rate(arm, q, v, a),
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


_single_joint = partial(
    formula, "002.pend", source="note 002, section 4.7, single joint", robots="single_link"
)


@_single_joint(
    part="torque",
    quantity="inverse_dynamics[0]",
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


@_single_joint(
    part="L",
    quantity="lagrangian",
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


@_single_joint(
    part="dL/dq",
    quantity="lagrangian_gradient[0]",
    latex=r"\frac{\partial L}{\partial q} = m g l_c \sin q",
)
def pendulum_gradient(arm: Arm, q: Array, v: Array) -> Any:
    """Gradient of the single joint's Lagrangian, q from upright."""
    del v
    return _pendulum(arm)[1] * np.sin(_from_upright(q))


# -------- Note 002, the principle of least action, checked on paths and on simulated
#          motions
# Paths are q(t) = q + v t + ½ a t² for 0 <= t <= T = 0.4 s, varied by dq times a shape in time. The
# integrals are sums over Gauss's 24 nodes, exact to rounding for paths as smooth as these.

_SOURCE = "note 002, principle of least action"
_T = 0.4
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(24)
_TIMES, _SHARES = 0.5 * _T * (_NODES + 1.0), 0.5 * _T * _WEIGHTS


def _inner(arm: Arm, q: Array, v: Array, a: Array, dq: Array, shape: Array) -> Any:
    """∫ (dL/dq - d/dt dL/dqdot) delta q dt; the bracket is -tau of the motion."""
    total: Any = 0.0
    for t, weight, share in zip(_TIMES, _SHARES, shape, strict=True):
        bracket = -torques(arm, q + v * t + 0.5 * a * t**2, v + a * t, a, None, arm.gravity)
        total = total + weight * share * dot(bracket, dq)
    return total


_action = partial(
    formula,
    "002.action",
    source=_SOURCE,
    robots=("single_link", "planar2r", "spatial3r", "stanford"),
)


@_action(
    part="fixed ends",
    quantity="action_variation",
    latex=r"\delta S = \int_{t_1}^{t_2} \left( \frac{\partial L}{\partial q}"
    r" - \frac{d}{dt}\frac{\partial L}{\partial \dot q} \right) \delta q\, dt",
)
def variation(arm: Arm, q: Array, v: Array, a: Array, dq: Array) -> Any:
    """First variation of the action between fixed ends."""
    return _inner(arm, q, v, a, dq, np.sin(np.pi * _TIMES / _T) ** 2)


def _ends(arm: Arm, q: Array, v: Array, a: Array) -> tuple[Array, Array]:
    """dL/dqdot at both ends of the path."""
    late_q, late_v = q + v * _T + 0.5 * a * _T**2, v + a * _T
    return apply(mass.mass_matrix(arm, q), v), apply(mass.mass_matrix(arm, late_q), late_v)


def _ends_printed(arm: Arm, q: Array, v: Array, a: Array, dq: Array) -> Any:
    _, late = _ends(arm, q, v, a)
    return _inner(arm, q, v, a, dq, 1.0 + 2.0 * _TIMES / _T) + dot(late, dq - 3.0 * dq)


_INNER = (
    r"\delta S = \int_{t_1}^{t_2} \left( \frac{\partial L}{\partial q}"
    r" - \frac{d}{dt}\frac{\partial L}{\partial \dot q} \right) \delta q\, dt + "
)


@_action(
    part="boundary term",
    source=_SOURCE + ", integration by parts",
    quantity="action_variation_free_ends",
    latex=_INNER + r"\fixed{\frac{\partial L}{\partial \dot q}(t_2)\,\delta q(t_2)"
    r" - \frac{\partial L}{\partial \dot q}(t_1)\,\delta q(t_1)}",
    printed=Printed(
        _ends_printed,
        "the boundary term has its ends exchanged and one dL/dqdot for both; it drops out of the "
        "note's result because delta q is zero there",
        _INNER + r"\wrong{\frac{\partial L}{\partial \dot q}\,(\delta q(t_1) - \delta q(t_2))}",
    ),
    remark="the line before has d(delta q) dt under one integral: the dt is one too many",
)
def variation_with_boundary(arm: Arm, q: Array, v: Array, a: Array, dq: Array) -> Any:
    """First variation with the boundary term of the integration by parts."""
    early, late = _ends(arm, q, v, a)
    inner = _inner(arm, q, v, a, dq, 1.0 + 2.0 * _TIMES / _T)
    return inner + dot(late, 3.0 * dq) - dot(early, dq)


@_action(
    part="true motion",
    quantity="action_variation_of_motion",
    robots=("single_link", "planar2r"),
    latex=r"\delta S = 0 \ \text{along the true motion}",
    remark="S + delta S = S means that S does not change in first order",
)
def no_variation(arm: Arm, q: Array, v: Array, dq: Array) -> Any:
    """The action is stationary along a simulated free motion."""
    del arm, v, dq
    return np.zeros(np.shape(q)[:-1])


@_action(
    part="least",
    quantity="excess_action_sign",
    robots="single_link",
    latex=r"S_{new} - S \approx \tfrac12 \delta^2 S \ \fixed{\gtrless 0}, \quad \delta^2 S = "
    r"\tfrac{T}{2} A^2 \left( \tfrac{\pi^2}{T^2} I - m g l_c \right)",
    printed=Printed(
        lambda arm, duration: np.ones(np.shape(duration)[:-1]),
        "the action is said to be least; it is stationary only: for a hanging arm watched longer "
        "than half a swing, nearby paths have less",
        r"S_{new} \wrong{> S}",
    ),
)
def excess_sign(arm: Arm, duration: Array) -> Any:
    """Sign of the second variation about rest, hanging."""
    (l,) = lengths(arm)
    centre = l + arm.com[0, 0]
    inertia = arm.inertia[0, 2, 2] + arm.mass[0] * centre**2
    weight = arm.mass[0] * -arm.gravity[1] * centre
    span = columns(duration)[0]
    return np.sign(inertia * np.pi**2 / span**2 - weight)
