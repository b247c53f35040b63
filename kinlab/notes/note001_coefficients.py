"""Note 001, "Rearrange": the coefficients D_ij, D_ijk and D_i of the planar 2R arm."""

from __future__ import annotations

import numpy as np

from kinlab.formula import Printed, formula
from kinlab.notes.arm import Arm, Array, apply, columns, matrix, vector
from kinlab.notes.note001_energies import ARM, numbers

_SOURCE = "note 001, section 2, rearranged"


@formula(
    "001.D",
    part="D_ij",
    source=_SOURCE,
    quantity="mass_matrix",
    robots=ARM,
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


@formula(
    "001.D",
    part="D_ijk",
    source=_SOURCE,
    quantity="christoffel",
    robots=ARM,
    latex=r"D_{122} = D_{112} = D_{121} = -m_2 l_1 l_2 s_2,\quad D_{211} = m_2 l_1 l_2 s_2,\quad"
    r" D_{111} = D_{222} = D_{212} = D_{221} = 0",
)
def velocity_coefficients(arm: Arm, q: Array) -> Array:
    """Centripetal and Coriolis coefficients."""
    _, m2, l1, l2, _ = numbers(arm)
    h = m2 * l1 * l2 * np.sin(columns(q)[1])
    first, second = matrix([0.0, -h], [-h, -h]), matrix([h, 0.0], [0.0, 0.0])
    return np.stack([first, second], axis=-3)


@formula(
    "001.D",
    part="D_i",
    source=_SOURCE,
    quantity="gravity_torques",
    robots=ARM,
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


def _tau_printed(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    return _assembled(arm, q, v, a, v)


_D = (
    r"\tau_i = D_{i1}\ddot\theta_1 + D_{i2}\ddot\theta_2 + D_{i11}",
    r" + D_{i22}",
    r" + D_{i12}\dot\theta_1\dot\theta_2 + D_{i21}\dot\theta_2\dot\theta_1 + D_i",
)


@formula(
    "001.D",
    part="tau",
    source=_SOURCE,
    quantity="inverse_dynamics",
    robots=ARM,
    latex=_D[0] + r"\fixed{\dot\theta_1^2}" + _D[1] + r"\fixed{\dot\theta_2^2}" + _D[2],
    printed=Printed(
        _tau_printed,
        "D_ijj multiplies theta_j_dot², printed theta_j_dot",
        _D[0] + r"\wrong{\dot\theta_1}" + _D[1] + r"\wrong{\dot\theta_2}" + _D[2],
    ),
)
def assembled_torques(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Torques put together from the coefficients."""
    return _assembled(arm, q, v, a, np.asarray(v) ** 2)
