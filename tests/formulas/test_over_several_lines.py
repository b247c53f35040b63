r"""Derivations over several lines, and formulas as word processors and packages have them.

Right ones are right, and a slip in any line of them is told.
"""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError

LAST_STEP = "m33 = I3 + m3*lc3^2\n    = a + b\nwith a = I3, b = m3*lc3^2"
LAST_LINE = "x = l1*cos(q1) + l2*cos(q1+q2)\n  = A*cos(q1) + B*cos(q1+q2)\nwith A = l1, B = l2"
TYPST = (
    "$ M_(11) = I_1 + I_2 + m_1 l_(c 1)^2 + m_2 (l_1^2 + l_(c 2)^2 + 2 l_1 l_(c 2) cos theta_2) $"
)
DOTS_OF_TYPST = "$ C_(11) = -m_2 l_1 l_2 sin(theta_2) dot(theta)_2 $"
OF_WORD = (
    "T=1/2 m_1 l_(c1)^2 (q_1 ) \u0307^2+1/2 I_1 (q_1 ) \u0307^2+1/2 I_2 ((q_1 ) \u0307+(q_2 ) \u0307 )^2"
    "+1/2 m_2 (l_1^2 (q_1 ) \u0307^2+l_(c2)^2 ((q_1 ) \u0307+(q_2 ) \u0307 )^2"
    "+2l_1 l_(c2) cos\u2061(q_2 ) (q_1 ) \u0307((q_1 ) \u0307+(q_2 ) \u0307 ))"
)
STEINER = "K = 1/2 * I_A * ω², I_A = I_S + m·(l/2)² (Steiner), I_S = m·l²/12"
ENERGIES = (
    "T = T₁ + T₂\nT₁ = ½ (I₁ + m₁ lc₁²) q̇₁²\nT₂ = ½ m₂ (l₁² q̇₁² + lc₂² (q̇₁+q̇₂)² + "
    "2 l₁ lc₂ cos(q₂) q̇₁ (q̇₁+q̇₂)) + ½ I₂ (q̇₁+q̇₂)²\nI₁ = m₁ l₁²/12, I₂ = m₂ l₂²/12"
)
IN_BRACKETS = (
    "J =\n[-l1*sin(q1) - l2*sin(q1+q2)   -l2*sin(q1+q2)]\n"
    "[ l1*cos(q1) + l2*cos(q1+q2)    l2*cos(q1+q2)]\n[1   1]"
)
WITHOUT_BRACKETS = "J = \n-l1*s1 - l2*s12,  -l2*s12\n l1*c1 + l2*c12,   l2*c12\n 1,  1"
OF_SYMPY = "C = h*Matrix([[-dq2, -(dq1 + dq2)],\n              [ dq1,  0]])\nh = m2*l1*l2*sin(q2)"
EQUATION = (
    "Eq(tau2, g*l2*m2*cos(q1(t) + q2(t)) + l1*l2*m2*sin(q2(t))*Derivative(q1(t), t)**2 + "
    "l1*l2*m2*cos(q2(t))*Derivative(q1(t), (t, 2)) + "
    "l2**2*m2*(Derivative(q1(t), (t, 2)) + Derivative(q2(t), (t, 2))))"
)
HEADED = (
    "Gravitationsmomente:\nG_1 = (m_1 + m_2) g l_1 c_1 + m_2 g l_2 c_{12}\nG_2 = m_2 g l_2 c_{12}\n"
    "wobei\nc_1 = \\cos q_1\nc_{12} = \\cos(q_1 + q_2)"
)
FOLLOWS = r"J_{33} = l_3\cos q_3 \quad\Rightarrow\quad \dot J_{33} = -l_3 \sin q_3\;\dot q_3"
BOLD = "**M33** = I3 + m3*lc3^2 = m3*l3^2/12 + m3*(l3/2)^2 = **m3*l3^2/3**"
CHAINED = r"$\tau = m g \frac l2\cos q + \frac13 m l^2\ddot q=0.3\,\ddot q+7.3575\cos q$"
HENCE = (
    r"On dérive l'énergie : $U = (m_1+m_2) g l_1\sin q_1 + m_2 g l_2 \sin(q_1+q_2)$, d'où"
    "\n"
    r"$$g_1 = \frac{\partial U}{\partial q_1} = (m_1+m_2) g l_1 \cos q_1 + m_2 g l_2\cos(q_1+q_2)$$"
)
LAMBDA = (
    "import numpy as np; C = lambda q, qd: np.array([[-0.3*np.sin(q[1])*qd[1], "
    "-0.3*np.sin(q[1])*(qd[0]+qd[1])], [0.3*np.sin(q[1])*qd[0], 0]])"
)
CASES = [
    ("planar3r", "mass_matrix[2,2]", LAST_STEP, "b = m3*lc3^2", "b = 2*m3*lc3^2"),
    ("planar2r", "fk[0,3]", LAST_LINE, "B = l2", "B = l1"),
    ("planar2r_rods", "mass_matrix[0,0]", TYPST, "2 l_1", "l_1"),
    ("planar2r", "coriolis_matrix[0,0]", DOTS_OF_TYPST, "sin(", "cos("),
    ("planar2r_rods", "kinetic_energy", OF_WORD, "1/2 I_1", "I_1"),
    ("single_link", "kinetic_energy", STEINER, "l²/12", "l²/3"),
    ("planar2r_rods", "kinetic_energy", ENERGIES, "½ I₂ (q̇₁+q̇₂)²", "½ I₂ q̇₂²"),
    ("planar2r_rods", "planar_jacobian", IN_BRACKETS, "[ l1*cos", "[ l2*cos"),
    ("planar2r_rods", "planar_jacobian", WITHOUT_BRACKETS, "l2*c12\n", "l2*s12\n"),
    ("planar2r", "coriolis_matrix", OF_SYMPY, "[ dq1,", "[ dq2,"),
    ("planar2r", "inverse_dynamics[1]", EQUATION, "sin(q2(t))", "sin(q1(t))"),
    ("planar2r", "gravity_torques", HEADED, r"c_1 = \cos q_1", r"c_1 = \cos q_2"),
    ("spatial3r", "jacobian_dot[2,2]", FOLLOWS, r"= -l_3 \sin", r"= l_3 \sin"),
    ("planar3r", "mass_matrix[2,2]", BOLD, "l3^2/3**", "l3^2/4**"),
    ("single_link", "inverse_dynamics[0]", CHAINED, r"\ddot q+7", r"\ddot q-7"),
    ("planar2r", "gravity_torques[0]", HENCE, r"l_1 \cos q_1 +", r"l_1 \sin q_1 +"),
    ("planar2r", "coriolis_matrix", LAMBDA, "[[-0.3", "[[0.3"),
]


@pytest.mark.parametrize(("robot", "quantity", "text", "good", "slip"), CASES)
def test_every_line_counts(robot: str, quantity: str, text: str, good: str, slip: str) -> None:
    assert kl.diagnose(robot, quantity, text).agrees
    assert text.count(good) == 1
    wrong = kl.diagnose(robot, quantity, text.replace(good, slip))
    assert not wrong.agrees
    assert wrong.causes


@pytest.mark.parametrize(
    ("robot", "quantity", "text"),
    [
        ("planar2r", "mass_matrix[1,1]", "$M_{22}=m_2l_2^2$. The unit is g cm², as in the sheet."),
        ("planar2r", "gravity_torques[1]", "G2 = m2*g*l2*cos(q1+q2), con los ángulos en grados"),
        (
            "planar2r",
            "potential_energy",
            "V = (m1+m2)*g*l1*s1 + m2*g*l2*s12. É a cinética, não a potencial.",
        ),
    ],
)
def test_what_denies_a_formula_is_heard(robot: str, quantity: str, text: str) -> None:
    with pytest.raises(ExpressionError):
        kl.diagnose(robot, quantity, text)


def test_what_a_sum_comes_to_is_no_condition() -> None:
    """``cos q = 0.3 qdd`` goes on as a formula; ``q1 = q2 = 0`` says when one holds."""
    said = kl.diagnose("single_link", "inverse_dynamics[0]", CHAINED).remarks
    assert not any("not read" in one for one in said)
    with pytest.raises(ExpressionError, match="not judged"):
        kl.diagnose("planar2r", "fk[0,3]", "x = l1 + l2, q1 = q2 = 0")


def test_a_definition_that_nothing_uses_may_have_any_names() -> None:
    """``0.0203 k`` of a3 made the look at a wrong formula end with an error."""
    text = "p_x = c1*s2*q3 - 0.1743*s1 = c1*s2*d3 - s1*(d2 - a3), with a3 = 0.0203*k, d2 = 0.154, d3 = q3"
    try:
        assert not kl.diagnose("stanford", "dh_poses[2,0,3]", text).agrees
    except ExpressionError as problem:
        assert "unknown" in str(problem) or "not judged" in str(problem)
