"""Slips in what the writer's own names stand for, alone and beside one more; three in one line."""

from __future__ import annotations

import numpy as np
import pytest
import sympy

import kinlab as kl

RODS = (
    "a = I1 + I2 + m1*lc1**2 + m2*(l1**2 + lc2**2); b = m2*l1*lc2; d = I2 + m2*lc2**2; "
    "tau1 = (a + 2*b*c2)*qdd1 + (d + b*c2)*qdd2 - b*s2*qd2*qd1 - b*s2*(qd1 + qd2)*qd2 "
    "+ g*(m1*lc1 + m2*l1)*c1 + m2*g*lc2*c12"
)
CRANK = (
    "A1 = 2*l1*(e - x); B1 = -2*l1*y; C1 = l2^2 - e^2 - l1^2 - x^2 - y^2 + 2*e*x; "
    "theta1 = 2*atan2(B1 + sqrt(A1^2 + B1^2 - C1^2), A1 + C1)"
)
TURN = (
    "vw = vx*w1x + vy*w1y; vu = vx*u1x + vy*u1y; k = u1x*w1y - u1y*w1x; "
    "thetadd1 = (ax*w1x + ay*w1y)/(l1*k) "
    "+ (vw^2*(u1x*w1x + u1y*w1y)/l1 + vu^2/l2)/(l1*k^3)"
)
POSITION = "-s1*(a2*c2 + a3*c23 + d5*s234) + d4*c1 + d6*(c1*c5 + s1*s5*c234)"


def with_slips(text: str, slips: list[tuple[str, str]]) -> str:
    for right, wrong in slips:
        assert right in text
        text = text.replace(right, wrong, 1)
    return text


@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [
        ("planar2r_rods", "tau1", RODS),
        ("isotropic", "theta1", CRANK),
        ("isotropic", "thetadd1", TURN),
        ("ur5", "T24", POSITION),
    ],
)
def test_the_texts_without_slips_are_right(robot: str, entry: str, text: str) -> None:
    assert kl.diagnose(robot, entry, text).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("robot", "entry", "text", "slips"),
    [
        pytest.param("planar2r_rods", "tau1", RODS, [("b = m2*l1*lc2", "b = m2*l1*l2")], id="a length for a centre"),
        pytest.param("isotropic", "theta1", CRANK, [("A1 = 2*l1*(e - x)", "A1 = 2*l1*(e + x)")], id="within a root"),
        pytest.param("planar2r_rods", "tau1", RODS, [("b = m2*l1", "b = m2*lc1"), ("d = I2 + m2*lc2**2", "d = I2 + m2*lc2")], id="two definitions"),
        pytest.param("planar2r_rods", "tau1", RODS, [("d = I2 + m2*lc2**2", "d = I2 + m2*l2**2"), ("- b*s2*qd2*qd1", "+ b*s2*qd2*qd1")], id="one of each"),
        pytest.param("isotropic", "theta1", CRANK, [("(e - x)", "(e + x)"), ("A1 + C1", "A1 - C1")], id="one of each, within a root"),
        pytest.param("isotropic", "thetadd1", TURN, [("+ ay*w1y", "- ay*w1y"), ("vu^2/l2", "vu/l2"), ("k^3", "k^2")], id="three, two in a product"),
        pytest.param("ur5", "T24", POSITION, [("-s1*(", "s1*("), ("d5*s234", "d5*c234"), ("+ d4*c1", "- d4*c1")], id="three, two in one term"),
    ],
)  # fmt: skip
def test_slips_are_told_where_they_are(robot, entry, text, slips) -> None:
    """What is shown as right is what was there, whatever the slips do to one another."""
    found = kl.diagnose(robot, entry, with_slips(text, slips))
    assert found.causes and len(found.causes[0].kinds) == len(slips), str(found)
    shown = "".join(found.causes[0].shown.values()).replace(" ", "").replace("**", "^")
    for right, _wrong in slips:
        piece = right.split("= ")[-1].replace(" ", "").replace("**", "^").lstrip("+-")
        assert piece in shown, str(found)


@pytest.mark.parametrize(
    "text", ["d, where d = I2 + m2*lc2", "m2*lc2 + m2*l1*cos(q2)", "I2 + m2*lc2 + m2*lc2*cos(q2)"]
)
def test_a_factor_that_is_zero_is_never_what_is_missing(text: str) -> None:
    """I1 and I2 are zero of an arm with point masses: such a factor would take a term out."""
    found = kl.diagnose("planar2r", "M12", text)
    assert found.causes
    told = found.causes[0].sentence
    assert "factor I1" not in told and "factor I2" not in told, str(found)
    assert "I1*" not in str(found) and "I2*" not in str(found), str(found)


def test_a_definition_that_a_right_formula_uses_is_not_blamed() -> None:
    """Of two formulas with one name, where one is right, the slip is in the other itself."""
    file = {"b": "m2*l1*lc2", "M12": "I2 + m2*lc2 + b*cos(q2)", "M21": "I2 + m2*lc2**2 + b*cos(q2)"}
    text = "; ".join(f"{name} = {formula}" for name, formula in file.items())
    found = kl.diagnose("planar2r_rods", "M12", text)
    assert "lc2" in str(found) and "b:" not in str(found), str(found)


@pytest.mark.parametrize("seed", [0, 1, 2, 4])  # 3 draws the slips of 2, and 5 those of 4
def test_what_is_shown_is_right_for_any_numbers(seed: int) -> None:
    """Of a random slip in a definition and one in the formula; asked of sympy, not of the doctor."""
    rng = np.random.default_rng(seed)
    slips = [
        [("b = m2*l1", "b = m1*l1"), ("d = I2", "d = I1"), ("b = m2*l1*lc2", "b = m2*l1*lc1")],
        [("2*b*c2", "b*c2"), ("+ m2*g*lc2*c12", "- m2*g*lc2*c12"), ("m2*l1)*c1", "m2*l1)*s1")],
    ]
    chosen = [some[int(rng.integers(len(some)))] for some in slips]
    found = kl.diagnose("planar2r_rods", "tau1", with_slips(RODS, chosen))
    assert found.causes, str(found)
    shown = dict(found.causes[0].shown)
    right = dict(part.strip().split(" = ") for part in RODS.split(";"))
    names = {name: sympy.Symbol(name) for name in "I1 I2 lc1 lc2 c1 c2 c12 s1 s2".split()}
    for name, text in shown.items():
        assert sympy.expand(sympy.sympify(text.replace("^", "**"), names)) == sympy.expand(
            sympy.sympify(right[name], names)
        )


@pytest.mark.parametrize(
    ("entry", "text", "shown"),
    [
        pytest.param("M12", "d + m2*l1*lc2*cos(q2), d = I2 + m2*lc2", "lc2**2", id="a power, of a moment that is zero"),
        pytest.param("M11", "m1*lc1**2 + I1 + I2*(l1**2 + lc2**2 + 2*l1*lc2*cos(q2))", "I2 should be m2", id="a moment that is zero for a mass"),
        pytest.param("M12", "m2*lc2**2 + I2", "m2*l1*lc2*cos(q2)", id="a length, and no centre that is as far"),
        pytest.param("M12", "m2*lc2**2 + I2 + l2*cos(q2)*m2", "factor l1", id="a factor, and no centre that is as far"),
        pytest.param("C11", "h*qd2, h = -m2*l1*sin(q2)", "h: the factor l2", id="a factor where the name was set"),
    ],
)  # fmt: skip
def test_what_is_equal_by_this_arms_numbers_alone_decides_nothing(entry, text, shown) -> None:
    """Of point masses I2 = 0 and lc1 = l1: a cause is one for any arm."""
    found = kl.diagnose("planar2r", entry, text)
    assert found.causes and shown in found.causes[0].sentence, str(found)


@pytest.mark.many
@pytest.mark.parametrize(
    ("robot", "entry", "text", "told"),
    [
        pytest.param("planar2r", "M11", "m1*l1^2 + m2*(l1^2 + l2^2 + 2*l1*l2+cos(q2))", "2*l1*l2*cos(q2)", id="a plus for a product"),
        pytest.param("planar2r", "x", "l1*cos(q1) + l2*cos(q1)*cos(q2)", "cos(q1 + q2)", id="a cosine as if it were linear"),
        pytest.param("planar3r", "V", r"m_1 g l_{c1} s_1 + m_2 g (l_1 s_1 + l_{c2} s_1 s_2) + m_3 g (l_1 s_1 + l_2 s_{12} + l_{c3} s_{123})", "s_1 s_2 should be s_{12}", id="s1*s2 for s12"),
        pytest.param("planar3r", "J12", "-l2*sin(a) - l3*sin(b), where a = th1 + th2, b = th2 + th3", "b: th2 + th3 should be", id="an angle where it is set"),
        pytest.param("planar3r", "statics[1]", "X = l2*s12 + l3*s123; Y = l2*c12 + l3*c123; tau2 = X*fx + Y*fy + nz", "X*fx should be -X*fx", id="a sign where it stands"),
        pytest.param("isotropic", "theta1", CRANK.replace("A1 + C1", "A1 - C1"), "- C1 should be + C1", id="a sign within a root"),
        pytest.param("scara", "C11", "p = m4*cx4; r = m2*(a2 + cx2) + (m3 + m4)*a2; C11 = -a1*(r*sin(q2) - m2*cy2*cos(q2))*qd2 - a1*p*sin(q4 - q2)*qd2 - a2*p*sin(q4)*qd4", "", id="a name within another: a1 in Ia1"),
    ],
)  # fmt: skip
def test_one_slip_is_told_as_one_and_where_it_is(robot, entry, text, told) -> None:
    found = kl.diagnose(robot, entry, text)
    assert not found.agrees and found.causes, str(found)
    assert told.replace(" ", "") in found.causes[0].sentence.replace(" ", ""), str(found)


def test_a_slip_in_a_definition_comes_before_two_terms_more_in_the_formula() -> None:
    """The rate of the second link where its energy is set; with a sine that stands in L itself."""
    text = (
        "K1 = (m1*lc1**2 + I1)*qd1**2/2; K2 = m2*(l1**2*qd1**2 + lc2**2*(qd1 + qd2)**2 "
        "+ 2*l1*lc2*cos(q2)*qd1*(qd1 + qd2))/2 + I2*qd2**2/2; "
        "L = K1 + K2 - m1*g*lc1*cos(q1) - m2*g*(l1*sin(q1) + lc2*sin(q1 + q2))"
    )
    cause = kl.diagnose("planar2r_rods", "L", text).causes[0]
    assert "K2: qd2 should be (qd1 + qd2)" in cause.sentence and len(cause.kinds) == 2


def test_a_centre_by_a_letter_of_ones_own_is_told_by_it() -> None:
    text = "β = m₂ l₁ r₂, δ = I₂ + m₂ l₂²; M₁₂ = δ + β cos θ₂"
    found = kl.diagnose("planar2r_rods", "M12", text)
    assert found.causes and found.causes[0].sentence.startswith("delta: l₂ should be r₂"), str(
        found
    )


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        ("planar3r", "M33", "I3 = m3*l3^2/3; M33 = I3 + m3*(l3/2)^2", "I3: 3 should be 12"),
        ("planar2r_rods", "M22", "I2 = m2*l2^2/3, M22 = I2 + m2*lc2^2", "I2: 3 should be 12"),
        # where the name is set as the arm has it, the slip is in the formula
        ("planar3r", "M33", "I3 = m3*l3^2/12; M33 = I3 + m3*l3^2", "M33: m3*l3^2 should be m3*l3^2/4"),
    ],
)  # fmt: skip
def test_a_name_of_the_arm_s_that_is_set_wrongly_is_told_where_it_is_set(robot, entry, text, said):
    assert kl.diagnose(robot, entry, text).sentence.startswith(said)


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        ("spatial3r", "J13", "c3 = cos(q3); s3 = sin(q3); J13 = -xt*c3*cos(q1+q2)", "J13: c3 should be sin(q3)"),
        ("planar2r", "x", "c1 = cos(q1); s12 = sin(q1+q2); x = l1*c1 + l2*s12", "x: s12 should be"),
        ("planar2r", "x", "c1 = sin(q1); x = l1*c1 + l2*cos(q1+q2)", "c1: sin(q1) should be cos(q1)"),
        ("single_link", "T", "I_O = I1 + m1*l1^2; T = 1/2*I_O*qd1^2", "I_O: l1 should be lc1"),
    ],
)  # fmt: skip
def test_a_name_that_is_defined_as_it_is_called_is_not_at_fault(robot, entry, text, said) -> None:
    assert said in kl.diagnose(robot, entry, text).causes[0].sentence


WEIGHTS = """c1 = cos(q1); c12 = cos(q1+q2); c123 = cos(q1+q2+q3);
G3 = 0.5*m3*g*l3*c123;
G2 = G3 + (0.5*m2 + m3)*g*l2*c12;
G1 = G2 + (0.5*m1 + m2 + m3)*g*l1*c1;
G = [G1; G2; G3];"""


def test_slips_in_three_definitions_of_one_another_are_told_where_they_are() -> None:
    """A centre's name that comes with a repair has a meaning; c12 is put right where it is set."""
    text = WEIGHTS.replace("c12 = cos(q1+q2)", "c12 = cos(q2)").replace("0.5*m3*g", "m3*g")
    text = text.replace("(0.5*m1 + m2 + m3)", "(0.5*m1 + m2)")
    found = kl.diagnose("planar3r", "gravity_torques", text)
    (cause,) = found.causes
    assert sorted(cause.places) == ["G1", "G3", "c12"], str(found)
    assert "c12: cos(q2) should be cos(q1+q2)" in cause.sentence
    assert "the term m3 is missing in (0.5*m1 + m2)" in cause.sentence
    assert not kl.diagnose("planar3r", "gravity_torques", WEIGHTS).causes


def test_a_definition_is_told_in_its_writer_s_typing() -> None:
    text = (
        "lc2 = l2/2; M12 = I2 + m2*(lc2^2 + l1*lc2*cos(q2)); M22 = I1 + m2*lc2^2; "
        "M11 = I1 + I2 + m1*l1^2/4 + m2*(l1^2 + lc2^2 + 2*l1*lc2*cos(q2)); M = [M11 M12; M12 M22]"
    )
    found = kl.diagnose("planar2r_rods", "mass_matrix", text)
    assert "I1 should be I2 in I1 + m2*lc2^2" in found.causes[0].sentence, str(found)
    assert found.causes[0].typed["M22"] == "I2 + m2*lc2^2"


SOLVED = """M11 = (m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*cos(q2); M12 = m2*l2^2 + m2*l1*l2*cos(q2);
M22 = m2*l2^2; D = M11*M22 - M12^2;
n1 = tau1 + m2*l1*l2*sin(q2)*(2*qd1*qd2 + qd2^2) - (m1+m2)*g*l1*cos(q1) - m2*g*l2*cos(q1+q2);
n2 = tau2 - m2*l1*l2*sin(q2)*qd1^2 - m2*g*l2*cos(q1+q2);"""


@pytest.mark.parametrize(
    ("robot", "entry", "text", "told"),
    [
        ("plotclock", "fivebar_rod_length", "r1 = sqrt((x - e - l1*cos(theta1))^2 + (y - l1*sin(theta1))^2); r2 = sqrt((x + e - l1*cos(theta2))^2 + (y - l1*sin(theta2))^2)", ""),
        ("isotropic", "fivebar_rod_length[0]", "sqrt((x + e - l1*cos(theta1))^2 + (y - l1*sin(theta1))^2)", "+ e should be - e"),
        ("single_link", "forward_dynamics[0]", "qdd1 = (tau1 - 1/2*m1*g*l1*cos(q1))/(1/3*m1*l1^2)", ""),
        ("single_link", "forward_dynamics", "qdd = (tau - m*g*lc*cos(q))/(I + m*lc^2)", ""),
        ("single_link", "inverse_dynamics", "tau1 = (I1 + m1*lc1^2)*qdd1 + m1*g*lc1*cos(q1)", ""),
        ("single_link", "forward_dynamics", r"\ddot q_1 = \frac{\tau_1 - \frac12 m_1 g l_1 \sin q_1}{\frac13 m_1 l_1^2}", r"\sin q_1 should be \cos q_1"),
        ("single_link", "forward_dynamics", "qdd = (tau - m*g*lc*cos(q))/(I + m*lc)", "lc should be lc**2 in m*lc"),
        ("planar2r", "forward_dynamics[1]", f"{SOLVED} qdd2 = (M11*n2 - M12*n1)/D", ""),
        ("planar2r", "forward_dynamics[1]", f"{SOLVED.replace('2*qd1', 'qd1')} qdd2 = (M11*n2 - M12*n1)/D", "n1: qd1*qd2 should be 2*qd1*qd2"),
        ("planar2r", "forward_dynamics[0]", f"{SOLVED} qdd1 = (M22*n1 + M12*n2)/D", "+ M12*n2 should be - M12*n2"),
    ],
)  # fmt: skip
def test_lengths_of_rods_and_forward_dynamics_are_read(robot, entry, text, told) -> None:
    found = kl.diagnose(robot, entry, text)
    assert found.agrees is not bool(told), str(found)
    assert told in "".join(cause.sentence for cause in found.causes)


def test_a_factor_of_a_definition_is_told_in_it_beside_a_slip_in_another() -> None:
    text = (
        "K1 = 1/3*m1*l1^2*dq1^2; K2 = 1/2*m2*(l1^2*dq1^2 + l2^2/4*(dq1+dq2)^2 "
        "+ l1*l2*cos(q2)*dq1*(dq1+dq2)) + 1/2*I2*dq2^2; T = K1 + K2"
    )
    (cause,) = kl.diagnose("planar2r_rods", "kinetic_energy", text).causes
    assert cause.places == ("K2", "K1") and "K1: 3 should be 6" in cause.sentence
    assert cause.error_after < 1e-12


def test_an_angle_with_the_other_sign_in_all_its_parts_is_no_other_angle() -> None:
    text = "y = l1*sin(q1) - l2*sin(q1-q2)"
    (cause, *_others) = kl.diagnose("planar2r", "y", text).causes
    assert len(cause.kinds) == 2 and "(-" not in cause.sentence, cause.sentence


TORQUE = (
    "h = m2*l1*lc2*sin(q2); d11 = m1*lc1^2 + I1 + m2*(l1^2 + lc2^2 + 2*l1*lc2*cos(q2)) + I2; "
    "d12 = m2*(lc2^2 + l1*lc2*cos(q2)) + I2; g1 = (m1*lc1 + m2*l1)*g*cos(q1) + "
    "m2*lc2*g*cos(q1+q2); tau1 = d11*qdd1 + d12*qdd2 - h*(2*qd1*qd2 + qd2^2) + g1"
)


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        (" + I1 + m2", " + m2", "d11: the term I1 is missing"),
        ("*cos(q2)) + I2; g1", "*cos(q2)); g1", "d12: the term I2 is missing"),
        ("(m1*lc1 + m2*l1)", "(m1*lc1)", "g1: the term m2*l1 is missing"),
    ],
)
def test_a_term_is_missing_in_the_name_that_lacks_it(right, wrong, told) -> None:
    assert kl.diagnose("planar2r_rods", "inverse_dynamics[0]", TORQUE).agrees
    found = kl.diagnose(
        "planar2r_rods", "inverse_dynamics[0]", with_slips(TORQUE, [(right, wrong)])
    )
    assert told in found.causes[0].sentence, str(found)


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        ("2*b*cos", "b*cos", "b*cos(q2) should be 2*b*cos(q2)"),
        ("+ 2*b", "- 2*b", "- 2*b*cos(q2) should be + 2*b*cos(q2)"),
        ("cos(q2)", "sin(q2)", "sin(q2) should be cos(q2)"),
    ],
)
def test_names_of_numbers_are_no_slips(right, wrong, told) -> None:
    text = "M11 = a + 2*b*cos(q2), a = 1.115, b = 0.3"
    assert kl.diagnose("planar2r", "mass_matrix[0,0]", text).agrees
    found = kl.diagnose("planar2r", "mass_matrix[0,0]", with_slips(text, [(right, wrong)]))
    (cause, *_others) = found.causes
    assert len(cause.kinds) == 1 and told in cause.sentence, str(found)


def test_a_name_of_a_number_is_the_arm_s_by_its_letter_and_its_digit() -> None:
    text = "M44 = Izz4 + m4*r4 + Im4 where r4 = 0.01, Izz4 = 0.0006, Im4 = 0.02"
    (cause, *_others) = kl.diagnose("scara", "mass_matrix[3,3]", text).causes
    assert cause.kinds == ("power",) and "r4 should be r4" in cause.sentence
