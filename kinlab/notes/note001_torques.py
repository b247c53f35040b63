"""Note 001: Lagrange's equation of the planar 2R arm, term by term, and its coefficients D."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.notes.arm import Arm, Array, apply, columns, matrix, vector
from kinlab.notes.note001_energies import ARM, numbers, two_link

# -------- Note 001: Lagrange's equation of the planar 2R arm, term by term, and the D
#          coefficients
# As in :mod:`kinlab.notes.note001_energies`; a1, a2 are the joint accelerations.


@two_link(
    "001.dLdd1",
    quantity="momentum[0]",
    latex=r"\frac{\partial L}{\partial \dot\theta_1} = (m_1 + m_2) l_1^2 \dot\theta_1"
    r" + m_2 l_2^2 \dot\theta_1 + m_2 l_2^2 \dot\theta_2 + 2 m_2 l_1 l_2 c_2 \dot\theta_1"
    r" + m_2 l_1 l_2 c_2 \dot\theta_2",
)
def momentum_1(arm: Arm, q: Array, v: Array) -> Any:
    """dL/dd1."""
    m1, m2, l1, l2, _ = numbers(arm)
    c2 = np.cos(columns(q)[1])
    d1, d2 = columns(v)
    return (
        (m1 + m2) * l1**2 * d1
        + m2 * l2**2 * d1
        + m2 * l2**2 * d2
        + 2 * m2 * l1 * l2 * c2 * d1
        + m2 * l1 * l2 * c2 * d2
    )


def _rate_1_printed(arm: Arm, q: Array, v: Array, a: Array) -> Any:
    m1, m2, l1, l2, _ = numbers(arm)
    q2 = columns(q)[1]
    a1, a2 = columns(a)
    return (
        ((m1 + m2) * l1**2 + m2 * l2 + 2 * m2 * l1 * l2 * np.cos(q2)) * a1
        + (m2 * l2 + m2 * l1 * l2 * np.cos(q2)) * a2
        - 2 * m2 * l1 * l2 * np.sin(q2) * a1 * a2
        - m2 * l1 * l2 * np.sin(q2) * a2**2
    )


@two_link(
    "001.ddt1",
    quantity="momentum_rate[0]",
    latex=r"\frac{d}{dt}\frac{\partial L}{\partial \fixed{\dot\theta_1}} ="
    r" [(m_1 + m_2) l_1^2 + \fixed{m_2 l_2^2} + 2 m_2 l_1 l_2 c_2]\ddot\theta_1"
    r" + (\fixed{m_2 l_2^2} + m_2 l_1 l_2 c_2)\ddot\theta_2"
    r" - 2 m_2 l_1 l_2 s_2 \fixed{\dot\theta_1\dot\theta_2} - m_2 l_1 l_2 s_2"
    r" \fixed{\dot\theta_2^2}",
    printed=Printed(
        _rate_1_printed,
        "m2 l2 for m2 l2² (twice), accelerations for velocities in the last two terms, and L is "
        "differentiated by theta_ddot on the left",
        r"\frac{d}{dt}\frac{\partial L}{\partial \wrong{\ddot\theta_1}} ="
        r" [(m_1 + m_2) l_1^2 + \wrong{m_2 l_2} + 2 m_2 l_1 l_2 c_2]\ddot\theta_1"
        r" + (\wrong{m_2 l_2} + m_2 l_1 l_2 c_2)\ddot\theta_2"
        r" - 2 m_2 l_1 l_2 s_2 \wrong{\ddot\theta_1\ddot\theta_2} - m_2 l_1 l_2 s_2"
        r" \wrong{\ddot\theta_2^2}",
    ),
)
def momentum_rate_1(arm: Arm, q: Array, v: Array, a: Array) -> Any:
    """d/dt dL/dd1."""
    m1, m2, l1, l2, _ = numbers(arm)
    q2 = columns(q)[1]
    d1, d2 = columns(v)
    a1, a2 = columns(a)
    return (
        ((m1 + m2) * l1**2 + m2 * l2**2 + 2 * m2 * l1 * l2 * np.cos(q2)) * a1
        + (m2 * l2**2 + m2 * l1 * l2 * np.cos(q2)) * a2
        - 2 * m2 * l1 * l2 * np.sin(q2) * d1 * d2
        - m2 * l1 * l2 * np.sin(q2) * d2**2
    )


@two_link(
    "001.dLdt1",
    quantity="lagrangian_gradient[0]",
    latex=r"\frac{\partial L}{\partial \theta_1} = -(m_1 + m_2) g l_1 c_1 - m_2 g l_2 c_{12}",
)
def gradient_1(arm: Arm, q: Array, v: Array) -> Any:
    """dL/dtheta1."""
    del v
    m1, m2, l1, l2, g = numbers(arm)
    q1, q2 = columns(q)
    return -(m1 + m2) * g * l1 * np.cos(q1) - m2 * g * l2 * np.cos(q1 + q2)


def _tau_1_printed(arm: Arm, q: Array, v: Array, a: Array) -> Any:
    m1, m2, l1, l2, g = numbers(arm)
    q1, q2 = columns(q)
    d1, d2 = columns(v)
    a1, a2 = columns(a)
    return (
        ((m1 + m2) * l1**2 + m2 * l2**2 + m2 * l2**2 + 2 * m2 * l1 * l2 * np.cos(q2)) * a1
        + (m2 * l2**2 + m2 * l1 * l2 * np.cos(q2)) * a2**2
        - 2 * m2 * l1 * l2 * np.sin(q2) * d1 * d2
        - m2 * l1 * l2 * np.sin(q2) * d2**2
        + (m1 + m2) * g * l1 * np.cos(q1)
        + m2 * g * l2 * np.cos(q1 + q2)
    )


_TAU1 = (
    r" - 2 m_2 l_1 l_2 s_2 \dot\theta_1\dot\theta_2 - m_2 l_1 l_2 s_2 \dot\theta_2^2"
    r" + (m_1 + m_2) g l_1 c_1 + m_2 g l_2 c_{12}"
)


@two_link(
    "001.tau1",
    quantity="inverse_dynamics[0]",
    latex=r"\tau_1 = [(m_1 + m_2) l_1^2 + \fixed{m_2 l_2^2} + 2 m_2 l_1 l_2 c_2]\ddot\theta_1"
    r" + (m_2 l_2^2 + m_2 l_1 l_2 c_2)\fixed{\ddot\theta_2}" + _TAU1,
    printed=Printed(
        _tau_1_printed,
        "m2 l2² is counted twice and theta2_ddot is squared: printed - true = "
        "m2 l2 (l2 a1 + (l2 + l1 c2)(a2² - a2))",
        r"\tau_1 = [(m_1 + m_2) l_1^2 + \wrong{m_2 l_2^2 + m_2 l_2^2}"
        r" + 2 m_2 l_1 l_2 c_2]\ddot\theta_1"
        r" + (m_2 l_2^2 + m_2 l_1 l_2 c_2)\wrong{\ddot\theta_2^2}" + _TAU1,
    ),
)
def tau_1(arm: Arm, q: Array, v: Array, a: Array) -> Any:
    """Torque of joint 1."""
    m1, m2, l1, l2, g = numbers(arm)
    q1, q2 = columns(q)
    d1, d2 = columns(v)
    a1, a2 = columns(a)
    return (
        ((m1 + m2) * l1**2 + m2 * l2**2 + 2 * m2 * l1 * l2 * np.cos(q2)) * a1
        + (m2 * l2**2 + m2 * l1 * l2 * np.cos(q2)) * a2
        - 2 * m2 * l1 * l2 * np.sin(q2) * d1 * d2
        - m2 * l1 * l2 * np.sin(q2) * d2**2
        + (m1 + m2) * g * l1 * np.cos(q1)
        + m2 * g * l2 * np.cos(q1 + q2)
    )


@two_link(
    "001.dLdd2",
    quantity="momentum[1]",
    latex=r"\frac{\partial L}{\partial \dot\theta_2} = m_2 l_2^2 \dot\theta_1"
    r" + m_2 l_2^2 \dot\theta_2 + m_2 l_1 l_2 c_2 \dot\theta_1",
)
def momentum_2(arm: Arm, q: Array, v: Array) -> Any:
    """dL/dd2."""
    _, m2, l1, l2, _ = numbers(arm)
    d1, d2 = columns(v)
    return m2 * l2**2 * d1 + m2 * l2**2 * d2 + m2 * l1 * l2 * np.cos(columns(q)[1]) * d1


@two_link(
    "001.ddt2",
    quantity="momentum_rate[1]",
    latex=r"\frac{d}{dt}\frac{\partial L}{\partial \dot\theta_2} = m_2 l_2^2 \ddot\theta_1"
    r" + m_2 l_2^2 \ddot\theta_2 + m_2 l_1 l_2 c_2 \ddot\theta_1"
    r" - m_2 l_1 l_2 s_2 \dot\theta_1\dot\theta_2",
    remark="the left side is printed with L differentiated by theta2_ddot",
)
def momentum_rate_2(arm: Arm, q: Array, v: Array, a: Array) -> Any:
    """d/dt dL/dd2."""
    _, m2, l1, l2, _ = numbers(arm)
    q2 = columns(q)[1]
    d1, d2 = columns(v)
    a1, a2 = columns(a)
    return (
        m2 * l2**2 * a1
        + m2 * l2**2 * a2
        + m2 * l1 * l2 * np.cos(q2) * a1
        - m2 * l1 * l2 * np.sin(q2) * d1 * d2
    )


@two_link(
    "001.dLdt2",
    quantity="lagrangian_gradient[1]",
    latex=r"\frac{\partial L}{\partial \theta_2} ="
    r" -m_2 l_1 l_2 s_2(\dot\theta_1^2 + \dot\theta_1\dot\theta_2) - m_2 g l_2 c_{12}",
)
def gradient_2(arm: Arm, q: Array, v: Array) -> Any:
    """dL/dtheta2."""
    _, m2, l1, l2, g = numbers(arm)
    q1, q2 = columns(q)
    d1, d2 = columns(v)
    return -m2 * l1 * l2 * np.sin(q2) * (d1**2 + d1 * d2) - m2 * g * l2 * np.cos(q1 + q2)


@two_link(
    "001.tau2",
    quantity="inverse_dynamics[1]",
    latex=r"\tau_2 = (m_2 l_2^2 + m_2 l_1 l_2 c_2)\ddot\theta_1 + m_2 l_2^2 \ddot\theta_2"
    r" + m_2 l_1 l_2 s_2 \dot\theta_1^2 + m_2 l_2 g c_{12}",
)
def tau_2(arm: Arm, q: Array, v: Array, a: Array) -> Any:
    """Torque of joint 2."""
    _, m2, l1, l2, g = numbers(arm)
    q1, q2 = columns(q)
    d1, _ = columns(v)
    a1, a2 = columns(a)
    return (
        (m2 * l2**2 + m2 * l1 * l2 * np.cos(q2)) * a1
        + m2 * l2**2 * a2
        + m2 * l1 * l2 * np.sin(q2) * d1**2
        + m2 * l2 * g * np.cos(q1 + q2)
    )


# -------- Note 001, "Rearrange": the coefficients D_ij, D_ijk and D_i of the planar 2R arm

_coefficients = partial(formula, "001.D", source="note 001, section 2, rearranged", robots=ARM)


@_coefficients(
    part="D_ij",
    quantity="mass_matrix",
    latex=r"D_{11} = (m_1 + m_2) l_1^2 + m_2 l_2^2 + 2 m_2 l_1 l_2 c_2,\quad"
    r" D_{12} = D_{21} = m_2 l_2^2 + m_2 l_1 l_2 c_2,\quad D_{22} = m_2 l_2^2",
    remark="at joint i the coupling torque is D_ij theta_j_ddot; D_ij theta_i_ddot is joint j's",
)
def inertias(arm: Arm, q: Array) -> Array:
    """Effective and coupling inertias."""
    m1, m2, l1, l2, _ = numbers(arm)
    c2 = np.cos(columns(q)[1])
    coupling = m2 * l2**2 + m2 * l1 * l2 * c2
    return matrix(
        [(m1 + m2) * l1**2 + m2 * l2**2 + 2 * m2 * l1 * l2 * c2, coupling],
        [coupling, m2 * l2**2],
    )


@_coefficients(
    part="D_ijk",
    quantity="christoffel",
    latex=r"D_{122} = D_{112} = D_{121} = -m_2 l_1 l_2 s_2,\quad D_{211} = m_2 l_1 l_2 s_2,\quad"
    r" D_{111} = D_{222} = D_{212} = D_{221} = 0",
)
def velocity_coefficients(arm: Arm, q: Array) -> Array:
    """Centripetal and Coriolis coefficients."""
    _, m2, l1, l2, _ = numbers(arm)
    h = m2 * l1 * l2 * np.sin(columns(q)[1])
    first, second = matrix([0.0, -h], [-h, -h]), matrix([h, 0.0], [0.0, 0.0])
    return np.stack([first, second], axis=-3)


@_coefficients(
    part="D_i",
    quantity="gravity_torques",
    latex=r"D_1 = (m_1 + m_2) g l_1 c_1 + m_2 g l_2 c_{12},\quad D_2 = m_2 g l_2 c_{12}",
)
def gravity(arm: Arm, q: Array) -> Array:
    """Gravity torques."""
    m1, m2, l1, l2, g = numbers(arm)
    q1, q2 = columns(q)
    outer = m2 * g * l2 * np.cos(q1 + q2)
    return vector((m1 + m2) * g * l1 * np.cos(q1) + outer, outer)


def _assembled(arm: Arm, q: Array, v: Array, a: Array, squares: Array) -> Array:
    """D_ij a_j + D_ijj squares_j + 2 D_i12 d1 d2 + D_i."""
    symbols = velocity_coefficients(arm, q)
    d1, d2 = columns(v)
    coriolis: Array = (symbols[..., 0, 1] + symbols[..., 1, 0]) * (d1 * d2)[..., None]
    centripetal: Array = np.einsum("...ijj,...j->...i", symbols, squares)
    return apply(inertias(arm, q), a) + centripetal + coriolis + gravity(arm, q)


_D = (
    r"\tau_i = D_{i1}\ddot\theta_1 + D_{i2}\ddot\theta_2 + D_{i11}",
    r" + D_{i22}",
    r" + D_{i12}\dot\theta_1\dot\theta_2 + D_{i21}\dot\theta_2\dot\theta_1 + D_i",
)


@_coefficients(
    part="tau",
    quantity="inverse_dynamics",
    latex=_D[0] + r"\fixed{\dot\theta_1^2}" + _D[1] + r"\fixed{\dot\theta_2^2}" + _D[2],
    printed=Printed(
        lambda arm, q, v, a: _assembled(arm, q, v, a, v),
        "D_ijj multiplies theta_j_dot², printed theta_j_dot",
        _D[0] + r"\wrong{\dot\theta_1}" + _D[1] + r"\wrong{\dot\theta_2}" + _D[2],
    ),
)
def assembled_torques(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Torques put together from the coefficients."""
    return _assembled(arm, q, v, a, np.asarray(v) ** 2)
