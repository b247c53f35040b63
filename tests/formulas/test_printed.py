"""Formulas as they are printed over several lines, or scanned: right ones are, slips are told."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError
from kinlab.formulas.signs.printed import as_typed

PRETTY = (
    "            2                               2         2   \n"
    "I₁ + I₂ + l₁ ⋅m₂ + 2⋅l₁⋅lc₂⋅m₂⋅cos(q₂) + lc₁ ⋅m₁ + lc₂ ⋅m₂"
)
DRAWN = "k = -m2 l1 lc2 sin(q2)\nC = [ k q̇2     k (q̇1+q̇2)\n     -k q̇1        0      ]"
SCANNED = "M 1 1 = ( m 1 + m 2 ) l 1 ^ 2 + m 2 l 2 ^ 2 + 2 m 2 l 1 l 2 cos ( q 2 )"
SOLVED = (
    "θ1'' = [ M22 (τ1 − n1) − M12 (τ2 − n2) ] / (M11 M22 − M12²)\n"
    "M11 = I1 + I2 + m1 lc1² + m2 (l1² + lc2² + 2 l1 lc2 cos θ2) ; "
    "M12 = I2 + m2 (lc2² + l1 lc2 cos θ2) ; M22 = I2 + m2 lc2²\n"
    "n1 = −m2 l1 lc2 sin θ2 (2 θ1' θ2' + θ2'²) + (m1 lc1 + m2 l1) g cos θ1 + m2 g lc2 cos(θ1+θ2)\n"
    "n2 = m2 l1 lc2 sin θ2 θ1'² + m2 g lc2 cos(θ1+θ2)"
)
FORCES = "τ₂ = −(l₂ s₁₂ + l₃ s₁₂₃) Fx + (l₂ c₁₂ + l₃ c₁₂₃) Fy + Mz"
SO_ON = (
    r"J_{11}=-l_1 s_1 - l_2 s_{12},\ s_1=\sin\theta_1,\ s_{12}=\sin(\theta_1+\theta_2)\ \text{usw.}"
)
IN_ROWS = (
    r"\begin{aligned} x &= l_1 C_1 + l_2 C_{12} + l_3 C_{123}\\ "
    r"y &= l_1 S_1 + l_2 S_{12} + l_3 S_{123}\\ "
    r"\cos\varphi &= C_{123}\\ \sin\varphi &= S_{123} \end{aligned}"
)
IN_WAVES = "x = l1 c1 + l2 c12; y = l1 s1 + l2 s12; cos(phi) = c12; s_phi = s12"
HALVES = r"V = m g \frac l2 \sin q"
BY_LAW = "τ = Jᵀ F : tau1 = -(l1 s1 + l2 s12) Fx + (l1 c1 + l2 c12) Fy + Mz, tau2 = -l2 s12 Fx + l2 c12 Fy + Mz"
CASES = [
    ("planar3r", "planar_pose", IN_ROWS, "&= C_{123}", "&= C_{12}"),
    ("planar2r", "planar_pose", IN_WAVES, "s_phi = s12", "s_phi = s1"),
    ("single_link", "potential_energy", HALVES, r"\sin q", r"\cos q"),
    ("planar2r", "statics", BY_LAW, "tau2 = -", "tau2 = "),
    ("planar2r_rods", "mass_matrix[0,0]", PRETTY, "cos(q₂) + ", "cos(q₂) - "),
    ("planar2r_rods", "coriolis_matrix", DRAWN, "(q̇1+q̇2)", "(q̇1-q̇2)"),
    ("planar2r", "mass_matrix[0,0]", SCANNED, "2 m 2", "m 2"),
    ("planar2r_rods", "forward_dynamics[0]", SOLVED, "− M12 (", "+ M12 ("),
    ("planar3r", "statics[1]", FORCES, "Fy + ", "Fy - "),
    ("planar2r", "planar_jacobian[0,0]", SO_ON, "- l_2", "+ l_2"),
]


@pytest.mark.parametrize(("robot", "quantity", "text", "good", "slip"), CASES)
def test_what_was_printed_is_read(
    robot: str, quantity: str, text: str, good: str, slip: str
) -> None:
    assert kl.diagnose(robot, quantity, text).agrees
    wrong = kl.diagnose(robot, quantity, text.replace(good, slip, 1))
    assert not wrong.agrees
    assert wrong.causes
    assert len(wrong.causes[0].kinds) == 1


@pytest.mark.parametrize(
    "text",
    [
        "2\nl1*cos(q1)",
        " 2\nl1*cos(q1)",
        "x = 3\n4\ny = l 1",
        "[a, b;\n c, d]",
        "[a  b\n c]",
        "m 2 + 3 l",
        "m1 2 + l 1 + l 2 + m 2 + m 1",
    ],
)
def test_what_may_be_something_else_stays(text: str) -> None:
    assert as_typed(text) == text


@pytest.mark.parametrize("told", ["rounded", "gerundet", "valori numerici arrotondati"])
@pytest.mark.parametrize(("number", "right"), [("0.6217", True), ("0.5417", False)])
def test_rounded_numbers_with_a_remark(told: str, number: str, right: bool) -> None:
    text = f"M_11 = {number} + 0.3 cos(q2)  ({told})"
    found = kl.diagnose("planar2r_rods", "mass_matrix[0,0]", text)
    assert found.agrees == right
    assert found.form == ("rounded" if right else "")


@pytest.mark.parametrize("said", ["with the payload attached", "with the table upside down"])
def test_words_in_parentheses_are_said_though_they_begin_with_where(said: str) -> None:
    text = f"g2 = m2*g*lc2*cos(q1+q2) ({said})"
    found = kl.diagnose("planar2r_rods", "gravity_torques[1]", text)
    assert any(said.removeprefix("with ") in remark for remark in found.remarks)


def test_the_writer_s_name_of_a_sum_of_rates_for_one_of_them() -> None:
    text = (
        "tau3 = m3*l3^2*(ddth1 + ddth2 + ddth3)/3 + m3*g*l3*cos(th1 + th2 + th3)/2"
        " + m3*l2*l3*(cos(th3)*(ddth1 + ddth2) + sin(th3)*w12^2)/2"
        " + m3*l1*l3*(cos(th2 + th3)*ddth1 + sin(th2 + th3)*w12^2)/2, w12 = dth1 + dth2"
    )
    found = kl.diagnose("planar3r", "inverse_dynamics[2]", text)
    assert found.causes[0].kinds == ("index",)
    assert "w12 should be dth1" in found.sentence


@pytest.mark.parametrize(
    "check", [", check: q1 = q2 = 0 gives 0.9", ". Checked with q1=q2=0: 0.9 m, ok"]
)
@pytest.mark.parametrize("sign", ["+", "-"])
def test_what_a_formula_was_tried_at_is_none_of_its_conditions(check: str, sign: str) -> None:
    text = f"px = l1*cos(q1) {sign} l2*cos(q1+q2){check}"
    found = kl.diagnose("planar2r", "fk[0,3]", text)
    assert found.agrees == (sign == "+")
    assert any("was not read" in remark for remark in found.remarks)


@pytest.mark.parametrize(
    ("robot", "quantity", "text"),
    [
        ("planar2r", "fk[0,3]", "l1*cos(q1) + l2*cos(q1+q2). Checked only for q1 = 0"),
        ("planar2r", "fk[0,3]", "l1*cos(q1) + l2*cos(q1+q2); q2 is not the relative angle"),
        ("planar2r", "christoffel[0,1,1]", "-m2*l1*l2*sin(q2), of the second kind"),
        ("scara", "mass_matrix[2,2]", "m3 + m4 + Ia3; the tool has not been added yet"),
    ],
)
def test_what_denies_it_is_heard(robot: str, quantity: str, text: str) -> None:
    with pytest.raises(ExpressionError):
        kl.diagnose(robot, quantity, text)
