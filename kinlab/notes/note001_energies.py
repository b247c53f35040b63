"""Note 001: the planar 2R arm with point masses, from the energies to the Lagrangian.

theta is measured from the horizontal x axis, y is up, the masses sit at the links' far ends.
Throughout d1, d2 are the joint rates.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.notes import arm as mass
from kinlab.notes.arm import (
    Arm,
    Array,
    apply,
    columns,
    geometric_jacobian,
    lengths,
    tool_pose,
    transpose,
    vector,
)
from kinlab.notes.note000_dynamics import torques

ARM = "planar2r"
SECTION = "note 001, section 2"


def numbers(arm: Arm) -> tuple[float, float, float, float, float]:
    """m1, m2, l1, l2, g."""
    l1, l2 = lengths(arm)
    m1, m2 = arm.mass
    return m1, m2, l1, l2, -arm.gravity[1]


def _contact(arm: Arm, q: Array, wrench: Array) -> Array:
    """J_c^T F_c of a force F_c on the arm: the tool exerts its opposite."""
    jacobian = geometric_jacobian(arm, q, tool_pose(arm, q)[..., :3, 3])
    return apply(transpose(jacobian), -wrench)


def _inertial(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """M qdd + b."""
    return torques(arm, q, v, a, None, np.zeros(3))


@formula(
    "001.eom",
    source="note 001, section 1",
    quantity="inverse_dynamics_loaded",
    robots="serial",
    latex=r"M(q)\ddot q + b(q, \dot q) + \fixed{g(q)} = \tau + J_c^T F_c",
    printed=Printed(
        lambda arm, q, v, a, wrench: _inertial(arm, q, v, a) + q - _contact(arm, q, wrench),
        "q(q) stands for the gravity term g(q) (read literally: q itself)",
        r"M(q)\ddot q + b(q, \dot q) + \wrong{q(q)} = \tau + J_c^T F_c",
    ),
    remark="F_c acts on the arm; J_c is a Jacobian matrix, which the note calls a determinant",
)
def equation_of_motion(arm: Arm, q: Array, v: Array, a: Array, wrench: Array) -> Array:
    """Torques of a motion under an outer force."""
    return _inertial(arm, q, v, a) + mass.gravity_torques(arm, q) - _contact(arm, q, wrench)


two_link = partial(formula, source=SECTION, robots=ARM)


@two_link(
    "001.K",
    quantity="link_kinetic_energies",
    latex=r"K_1 = \tfrac12 m_1 l_1^2 \dot\theta_1^2,\quad K_2 = \tfrac12 m_2 v_2^2",
    remark="the note sets the square of theta_1 under the dot",
)
def kinetic_energies(arm: Arm, q: Array, v: Array) -> Array:
    """Kinetic energies of the two masses."""
    m1, m2, l1, _, _ = numbers(arm)
    d1, _ = columns(v)
    return vector(0.5 * m1 * l1**2 * d1**2, 0.5 * m2 * speed_squared(arm, q, v))


@two_link(
    "001.P",
    quantity="link_potential_energies",
    latex=r"P_1 = m_1 g l_1 \sin\theta_1,\quad"
    r" P_2 = m_2 g l_1 \sin\theta_1 + m_2 g l_2 \sin(\theta_1 + \theta_2)",
)
def potential_energies(arm: Arm, q: Array) -> Array:
    """Potential energies of the two masses."""
    m1, m2, l1, l2, g = numbers(arm)
    q1, q2 = columns(q)
    return vector(
        m1 * g * l1 * np.sin(q1),
        m2 * g * l1 * np.sin(q1) + m2 * g * l2 * np.sin(q1 + q2),
    )


def _v2_printed(arm: Arm, q: Array, v: Array) -> Any:
    _, _, l1, l2, _ = numbers(arm)
    _, q2 = columns(q)
    d1, d2 = columns(v)
    return (
        l1**2 * d1**2
        + l2**2 * (d1**2 + 2 * d1 + d2 + d2**2)
        + 2 * l1 * l2 * np.cos(q2) * (d1**2 + d1 * d2)
    )


_V2 = (
    r"v_2^2 = l_1^2\dot\theta_1^2 + l_2^2(\dot\theta_1^2 + ",
    r" + \dot\theta_2^2) + 2 l_1 l_2 \cos\theta_2\,(\dot\theta_1^2 + \dot\theta_1\dot\theta_2)",
)


@two_link(
    "001.v2",
    quantity="tip_speed_squared",
    latex=_V2[0] + r"\fixed{2\dot\theta_1\dot\theta_2}" + _V2[1],
    printed=Printed(
        _v2_printed,
        "2 d1 d2 is printed 2 d1 + d2",
        _V2[0] + r"\wrong{2\dot\theta_1 + \dot\theta_2}" + _V2[1],
    ),
    remark="the line before sets the square under the dot: x_2^2, y_2^2 and v_2^2 with a dot each",
)
def speed_squared(arm: Arm, q: Array, v: Array) -> Any:
    """Squared speed of the second mass."""
    _, _, l1, l2, _ = numbers(arm)
    _, q2 = columns(q)
    d1, d2 = columns(v)
    return (
        l1**2 * d1**2
        + l2**2 * (d1**2 + 2 * d1 * d2 + d2**2)
        + 2 * l1 * l2 * np.cos(q2) * (d1**2 + d1 * d2)
    )


def _lagrangian_printed(arm: Arm, q: Array, v: Array) -> Any:
    m1, m2, l1, l2, g = numbers(arm)
    q1, q2 = columns(q)
    d1, d2 = columns(v)
    return (
        0.5 * (m1 + m2) * l1**2 * d1**2
        + 0.5 * m2 * l2**2 * (d1**2 + m2 * d1 + d2 + d2**2)
        + 2 * l1 * l2 * np.cos(q2) * (d1**2 + d1 * d2)
        - (m1 + m2) * g * l1 * np.sin(q1)
        - m2 * g * l2 * np.sin(q1 + q2)
    )


_LAGRANGIAN = (
    r"L = \tfrac12 (m_1 + m_2) l_1^2 \dot\theta_1^2 + \tfrac12 m_2 l_2^2 (\dot\theta_1^2 + ",
    r" + \dot\theta_2^2) + ",
    r" \cos\theta_2\,(\dot\theta_1^2 + \dot\theta_1\dot\theta_2)"
    r" - (m_1 + m_2) g l_1 \sin\theta_1 - m_2 g l_2 \sin(\theta_1 + \theta_2)",
)


@two_link(
    "001.L",
    quantity="lagrangian",
    latex=_LAGRANGIAN[0]
    + r"\fixed{2\dot\theta_1\dot\theta_2}"
    + _LAGRANGIAN[1]
    + r"\fixed{m_2 l_1 l_2}"
    + _LAGRANGIAN[2],
    printed=Printed(
        _lagrangian_printed,
        "2 d1 d2 is printed m2 d1 + d2, and 2 l1 l2 c2 stands where m2 l1 l2 c2 belongs",
        _LAGRANGIAN[0]
        + r"\wrong{m_2\dot\theta_1 + \dot\theta_2}"
        + _LAGRANGIAN[1]
        + r"\wrong{2 l_1 l_2}"
        + _LAGRANGIAN[2],
    ),
)
def lagrangian(arm: Arm, q: Array, v: Array) -> Any:
    """The Lagrangian K - P."""
    m1, m2, l1, l2, g = numbers(arm)
    q1, q2 = columns(q)
    d1, d2 = columns(v)
    return (
        0.5 * (m1 + m2) * l1**2 * d1**2
        + 0.5 * m2 * l2**2 * (d1**2 + 2 * d1 * d2 + d2**2)
        + m2 * l1 * l2 * np.cos(q2) * (d1**2 + d1 * d2)
        - (m1 + m2) * g * l1 * np.sin(q1)
        - m2 * g * l2 * np.sin(q1 + q2)
    )
