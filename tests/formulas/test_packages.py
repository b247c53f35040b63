r"""Formulas as programs and LaTeX's packages print them: right ones are, slips are told."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError

OF_SYMPY = (
    r"\frac{g l_{2} m_{2} \cos{\left(\theta_{1}{\left(t \right)} + \theta_{2}{\left(t \right)} "
    r"\right)}}{2} + \frac{l_{1} l_{2} m_{2} \sin{\left(\theta_{2}{\left(t \right)} \right)} "
    r"\left(\frac{d}{d t} \theta_{1}{\left(t \right)}\right)^{2}}{2} + \frac{l_{1} l_{2} m_{2} "
    r"\cos{\left(\theta_{2}{\left(t \right)} \right)} \frac{d^{2}}{d t^{2}} \theta_{1}{\left(t "
    r"\right)}}{2} + \frac{l_{2}^{2} m_{2} \frac{d^{2}}{d t^{2}} \theta_{1}{\left(t \right)}}{3} "
    r"+ \frac{l_{2}^{2} m_{2} \frac{d^{2}}{d t^{2}} \theta_{2}{\left(t \right)}}{3}"
)
OF_MATHEMATICA = (
    "(m1*l1^2*Derivative[1][q1][t]^2)/2 + (m2*(l1^2*Derivative[1][q1][t]^2 + "
    "l2^2*(Derivative[1][q1][t] + Derivative[1][q2][t])^2 + 2*l1*l2*Cos[q2[t]]*"
    "Derivative[1][q1][t]*(Derivative[1][q1][t] + Derivative[1][q2][t])))/2"
)
OF_PHYSICS = r"\tau_{g,2} = \pdv{U}{\theta_2} = m_2 \, g \, l_2 \cos\qty(\theta_1 + \theta_2)"
OF_MAXIMA = (
    r"tex(K);"
    "\n"
    r"$${{m_{1}\,l_{1}^2\,\dot{q}_{1}^2}\over{6}}+{{m_{2}\,\left(3\,l_{1}^2\,\dot{q}_{1}^2+3\,l_{1}"
    r"\,l_{2}\,\cos q_{2}\,\dot{q}_{1}\,\left(\dot{q}_{1}+\dot{q}_{2}\right)+l_{2}^2\,\left("
    r"\dot{q}_{1}+\dot{q}_{2}\right)^2\right)}\over{6}}$$"
)
IN_A_TABLE = (
    "| Eintrag | Wert |\n|---|---|\n"
    "| M11 | I1 + I2 + m1*lc1^2 + m2*(l1^2 + lc2^2 + 2*l1*lc2*cos(q2)) |\n"
    "| M12 = M21 | I2 + m2*(lc2^2 + l1*lc2*cos(q2)) |\n| M22 | I2 + m2*lc2^2 |\n"
    "mit lc1 = l1/2, lc2 = l2/2"
)
TALL = (
    "⎡-l₁⋅sin(q₁) - l₂⋅sin(q₁ + q₂)  -l₂⋅sin(q₁ + q₂)⎤\n"
    "⎢                                               ⎥\n"
    "⎢l₁⋅cos(q₁) + l₂⋅cos(q₁ + q₂)   l₂⋅cos(q₁ + q₂) ⎥\n"
    "⎢                                               ⎥\n"
    "⎣              1                       1        ⎦"
)
ROW_BY_ROW = (
    "T03 = A1 A2 A3 =\n( s1   c1c2   c1s2   c1s2 d3 − s1(d2 − a3) )\n"
    "( −c1  s1c2   s1s2   s1s2 d3 + c1(d2 − a3) )\n( 0    −s2    c2     d1 + c2 d3 )\n"
    "( 0    0      0      1 )\nwith d3 = q3, d1 = 0.412, d2 = 0.154, a3 = 0.0203"
)
BEHIND_WORDS = (
    r"Sei $h = -m_2 l_1 l_2 \sin\theta_2$. Dann"
    "\n"
    r"\begin{equation}\bm{C}(\bm{\theta},\dot{\bm{\theta}}) = \begin{pmatrix} h\dot\theta_2 & "
    r"h(\dot\theta_1+\dot\theta_2)\\ -h\dot\theta_1 & 0\end{pmatrix}\end{equation}"
)
HENCE = (
    "U = Σ mᵢ g yᵢ = m₁g·y₁ + m₂g·y₂, où y₁ = l₁ sin θ₁ et y₂ = l₁ sin θ₁ + l₂ sin(θ₁ + θ₂). "
    "Donc U = (m₁ + m₂) g l₁ sin θ₁ + m₂ g l₂ sin(θ₁ + θ₂)"
)
CASES = [
    ("planar2r_rods", "inverse_dynamics[1]", OF_SYMPY, r"\sin{\left(", r"\cos{\left("),
    ("planar2r", "kinetic_energy", OF_MATHEMATICA, "2*l1", "l1"),
    ("planar2r", "gravity_torques[1]", OF_PHYSICS, r"\cos\qty", r"\sin\qty"),
    ("planar2r_rods", "kinetic_energy", OF_MAXIMA, r"\dot{q}_{2}\right)^2", r"\dot{q}_{2}\right)"),
    ("planar2r_rods", "mass_matrix", IN_A_TABLE, "I2 + m2*lc2^2 |", "I1 + m2*lc2^2 |"),
    ("planar2r", "planar_jacobian", TALL, "⎡-l₁⋅", "⎡ l₁⋅"),
    ("stanford", "dh_poses[2]", ROW_BY_ROW, "+ c2 d3", "− c2 d3"),
    ("planar2r", "coriolis_matrix", BEHIND_WORDS, "-h", "h"),
    ("planar2r", "potential_energy", HENCE, "l₁ sin θ₁ + m₂ g", "l₁ cos θ₁ + m₂ g"),
    ("spatial3r", "fk[2,3]", "z = l3·sen(q3)", "sen", "cos"),
    ("planar3r", "christoffel[2,1,1]", "c_{3,22} = ½·m₃·l₂·l₃·sin q₃", "= ½", "= −½"),
    ("scara", "jacobian[1,0]", "J[2,1] = a1*cos(q1) + a2*cos(q1+q2) # 1-based", "+ a2", "- a2"),
    ("scara", "fk[0,3]", r"x = \SI{0.325}{\metre}\cos q_1 + a_2\cos(q_1+q_2)", "+ a", "- a"),
]


@pytest.mark.parametrize(("robot", "quantity", "text", "good", "slip"), CASES)
def test_what_was_printed_is_read(
    robot: str, quantity: str, text: str, good: str, slip: str
) -> None:
    assert kl.diagnose(robot, quantity, text).agrees
    assert text.count(good) >= 1
    wrong = kl.diagnose(robot, quantity, text.replace(good, slip, 1))
    assert not wrong.agrees
    assert wrong.causes, wrong


@pytest.mark.parametrize("word", ["Hence", "So", "Therefore,", "It follows that", "Also", "Quindi"])
@pytest.mark.parametrize("sign", ["+", "-"])
def test_what_follows_behind_what_is_explained_is_another_step(word: str, sign: str) -> None:
    """A right formula was called wrong: the last step was taken for what y2 is."""
    text = (
        "U = m1*g*y1 + m2*g*y2, where y1 = l1*sin(q1) and y2 = l1*sin(q1) + l2*sin(q1+q2). "
        f"{word} U = (m1 + m2)*g*l1*sin(q1) {sign} m2*g*l2*sin(q1 + q2)"
    )
    assert kl.diagnose("planar2r", "potential_energy", text).agrees == (sign == "+")


@pytest.mark.parametrize("word", ["mit", "with", "where", ""])
def test_what_is_explained_below_several_lines(word: str) -> None:
    """A right matrix was called wrong for a line that begins with ``mit``."""
    text = (
        "M11 = I1 + I2 + m1*lc1^2 + m2*(l1^2 + lc2^2 + 2*l1*lc2*cos(q2))\n"
        "M12 = I2 + m2*(lc2^2 + l1*lc2*cos(q2))\nM21 = M12\nM22 = I2 + m2*lc2^2\n"
        f"{word} lc1 = l1/2, lc2 = l2/2"
    )
    assert kl.diagnose("planar2r_rods", "mass_matrix", text).agrees


def test_decimal_commas() -> None:
    text = "Drehmoment am Gelenk: τ = 0,3 q̈ + 7,3575 cos(q) [Nm], Stab mit J = ml²/3"
    assert kl.diagnose("single_link", "inverse_dynamics[0]", text).agrees
    wrong = kl.diagnose("single_link", "inverse_dynamics[0]", text.replace("7,3575", "73,575"))
    assert not wrong.agrees
    assert wrong.causes


@pytest.mark.parametrize(
    ("quantity", "text"),
    [
        (
            "gravity_torques[1]",
            r"g_2 = m_2 g l_2 \cos(\theta_1+\theta_2) \unit{\milli\newton\metre}",
        ),
        ("fk[0,3]", r"x = \SI{500}{\milli\metre}\cos q_1 + l_2\cos(q_1+q_2)"),
        ("fk[0,3]", r"x = \SI{0.5}{mm}\cos q_1 + l_2\cos(q_1+q_2)"),
    ],
)
def test_units_that_change_a_number_are_not_passed_over(quantity: str, text: str) -> None:
    with pytest.raises(ExpressionError):
        kl.diagnose("planar2r", quantity, text)


@pytest.mark.parametrize(
    "unit", [r"\newton\metre", r"\kilogram\metre\squared\per\second\squared", "N m"]
)
def test_units_of_si_are_left_out(unit: str) -> None:
    text = rf"g_2 = m_2 g l_2 \cos(\theta_1+\theta_2) \unit{{{unit}}}"
    assert kl.diagnose("planar2r", "gravity_torques[1]", text).agrees


@pytest.mark.parametrize("step", ["Σ mᵢ g xᵢ", r"\sum m_i g x_i", "A2 A1"])
def test_a_step_that_is_left_out_is_said(step: str) -> None:
    text = f"U = {step} = (m1+m2)*g*l1*sin(q1) + m2*g*l2*sin(q1+q2)"
    found = kl.diagnose("planar2r", "potential_energy", text)
    assert found.agrees
    assert any("was not judged" in remark for remark in found.remarks)
