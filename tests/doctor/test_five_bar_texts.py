"""Formulas of the five-bar as text: note 003 and Huang et al. 2005, right, misprinted, and slips.

The engine is the second road: every slip that is named is put right, and the corrected formula is
judged again.
"""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import ExpressionError

LOOP = "(e + l1*cos(theta1) - x)**2 + (l1*sin(theta1) - y)**2 - l2**2"
C1 = "l2**2 - l1**2 - e**2 - x**2 - y**2 + 2*e*x"
TAN = "2*atan((B1 + sqrt(A1**2 + B1**2 - C1**2))/(A1 + C1))"
ACOS = "atan2(B1, A1) + acos(C1/sqrt(A1**2 + B1**2))"
TRIANGLE = (
    "atan2(y, x - e) + acos((l1**2 + (x - e)**2 + y**2 - l2**2)/(2*l1*sqrt((x - e)**2 + y**2)))"
)
J11 = "w1x/(l1*(u1x*w1y - u1y*w1x))"
IN_XY = "(x - e - l1*cos(theta1))/(l1*(y*cos(theta1) - (x - e)*sin(theta1)))"
RATE = "(w1x*vx + w1y*vy)/(l1*(u1x*w1y - u1y*w1x))"
TURN = (
    "J11*ax + J12*ay + ((vx*w1x + vy*w1y)**2*(u1x*w1x + u1y*w1y)/l1"
    " + (vx*u1x + vy*u1y)**2/l2)/(l1*uHw1**3)"
)
TORQUE = "I_A*thetadd1 + m1*lc1*g*cos(theta1) + m*(J22*ax - J21*(ay + g))/(J11*J22 - J12*J21)"
GAIN = "I_A*J12 - m*J21/(J11*J22 - J12*J21)"

RIGHT = [
    ("loop1", LOOP),
    ("loop1", r"$(e + l_1\cos\theta_1 - x)^2 + (l_1\sin\theta_1 - y)^2 = l_2^2$"),
    ("loop1", "sqrt((e + l1*cos(theta1) - x)^2 + (l1*sin(theta1) - y)^2) = l2"),
    ("loop1", "2*(e - x)*l1*cos(theta1) - 2*y*l1*sin(theta1) = " + C1),
    ("loop", "(s*e + l1*cos(theta) - x)**2 + (l1*sin(theta) - y)**2 = l2**2"),
    ("loop2", "(-e + l1*cos(θ_2) - x)² + (l1*sin(θ_2) - y)² = l2²"),
    ("A1", "2*(e - x)*l1"), ("A", "2*(s*e - x)*l1"), ("A_2", "-2*l_1*(x + e)"),
    ("B1", "-2*y*l1"), ("B", "-2 y l_1"),
    ("C1", C1), ("C1", "l2^2 - l1^2 - (x - e)^2 - y^2"),
    ("C", r"$l_2^2 - l_1^2 - e^2 - x^2 - y^2 + 2 s e x$"), ("C2", C1.replace("+ 2", "- 2")),
    ("theta1", TAN), ("theta1", TAN.replace("+ sqrt", "- sqrt")), ("theta_1", ACOS),
    ("theta1", ACOS.replace("+ acos", "- acos")), ("theta1", TRIANGLE),
    ("theta1", "2*atan2(B1 - sqrt(A1^2 + B1^2 - C1^2), A1 + C1)"),
    ("theta1", r"$2\arctan\frac{B_1 \pm \sqrt{A_1^2 + B_1^2 - C_1^2}}{A_1 + C_1}$".replace(r"\pm", "+")),
    ("theta", "2*atan((B + sqrt(A**2 + B**2 - C**2))/(A + C))"),
    ("w1x", "(x - e - l1*cos(theta1))/l2"), ("w_1x", r"$\frac{x - e - l_1 u_{1x}}{l_2}$"),
    ("w2y", "(y - l1*sin(theta2))/l2"), ("w_x", "(x - s*e - l1*cos(theta))/l2"),
    ("J11", J11), ("J11", IN_XY), ("J11", "w1x/(l1*uHw1)"),
    ("J_11", r"$\frac{w_{1x}}{l_1 (u_{1x} w_{1y} - u_{1y} w_{1x})}$"),
    ("J22", "w2y/(l1*(cos(theta2)*w2y - sin(theta2)*w2x))"),
    ("theta_dot_1", r"$J_{11}\dot{x} + J_{12}\dot{y}$"), ("w1x", "(x - e - L1*cos(th1))/L2"),
    ("theta_dot_1", RATE), ("thetad1", "J11*vx + J12*vy"), ("thetad2", r"$J_{21} v_x + J_{22} v_y$"),
    ("thetadd1", TURN), ("theta_ddot_1", "J11*ax + J12*ay + f1".replace("f1", TURN.split("J12*ay + ")[1])),
    ("tau1", TORQUE), ("tau1", "G11*ax + G12*ay + I_A*f1 + tauAg1 - m*g*J21/detJ"),
    ("tau2", "I_A*thetadd2 + tauAg2 + m*(J11*(ay + g) - J12*ax)/(J11*J22 - J12*J21)"),
    ("G12", GAIN), ("G12", "I_A*(J12 - eta*J21/detJ)"), ("P1", "tau1*thetad1"),
    ("I_L1", "I_A + m*(J21**2 + J22**2)/(J11*J22 - J12*J21)**2"),
    (r"\dot\Theta_1", r"$\sqrt{J_{11}^2 + J_{12}^2} v_{\max}$"),
    (r"T_{\max,2}", r"\sqrt{G_{21}^2 + G_{22}^2}\,a_{\max}"),
    ("T_max1", "a_max*sqrt((I_A*J11 + m*J22/detJ)**2 + (I_A*J12 - m*J21/detJ)**2)"),
    ("fivebar_rate_per_speed[1]", "sqrt(J21^2 + J22^2)"),
    ("j", r"\frac{\pi N_{\max}}{30\dot\Theta_{\max}}"), ("j", "2*pi*N_max/(60*Thetad_max)"),
    ("I_Mmin", "I_L/(3*j**2)"), (r"I_{M\max}", r"\frac{I_L}{j^2}"),
    (r"\tau_{M\max}", r"T_{\max}/j"), ("tau_M", "T_max/j"),
]  # fmt: skip


@pytest.mark.parametrize("robot", ["isotropic", "unequal"])
@pytest.mark.parametrize(("entry", "text"), RIGHT)
def test_what_is_right_is_right_as_it_is_typed(robot: str, entry: str, text: str) -> None:
    found = kl.diagnose(robot, entry, text, samples=40)
    assert found.grade == "right", str(found)
    assert not found.remarks


@pytest.mark.parametrize(
    ("entry", "text", "said"),
    [
        ("C", "(l2**2 - l1**2 - e**2 - x**2 - y**2)/2 + s*e*x", "multiplied by 1/2"),
        ("A1", "(x - e)*l1", "multiplied by -1/2"),
        ("B1", "-y", "multiplied by 1/(2*l1)"),
    ],
)
def test_an_equation_is_right_with_any_factor(entry: str, text: str, said: str) -> None:
    found = kl.diagnose("isotropic", entry, text, samples=40)
    assert found.grade == "right but written unusually"
    assert said in found.sentence


def test_numbers_for_names_are_right_and_said() -> None:
    typed = IN_XY.replace("l1", "0.3").replace("x - e", "x - 0.14")
    found = kl.diagnose("isotropic", "J11", typed, samples=40)
    assert found.grade == "right with rounded numbers"
    assert "0.14 stands for e = 0.1414213562" in found.sentence
    found = kl.diagnose("isotropic", "J11", IN_XY.replace("l1", "0.3"), samples=40)
    assert "holds only for l1 = 0.3" in found.sentence


def test_a_number_of_the_other_leg_is_told() -> None:
    found = kl.diagnose("unequal", "J21", "w2x/(0.3*uHw2)", samples=40)
    assert "0.3 should be l1" in found.sentence


def _same(old: str, new: str, text: str) -> str:
    assert old in text
    return text.replace(old, new, 1)


SLIPS = [
    # note 003 as it is printed
    ("C", "l2^2 - l1^2 - e^2 - x^2 - y^2", "the term 2*s*e*x is missing"),
    ("C1", "l2**2 - l1**2 - e**2 - x**2 - y**2", "the term 2*e*x is missing"),
    ("loop1", "2*(e - x)*l1*cos(theta1) - 2*y*l1*sin(theta1) = l2**2 - l1**2 - e**2 - x**2 - y**2",
     "term"),
    ("loop1", _same("- x", "+ x", LOOP), "+ x should be - x"),
    ("loop1", _same("sin", "cos", LOOP), "cos(theta1) should be sin(theta1)"),
    (r"\dot\Theta_1", r"\sqrt{J_{11}^2 + J_{21}^2} v_{\max}", r"J_{21} should be J_{12}"),
    ("Thetad2", "(J21**2 + J22**2)*v_max", "sqrt(J21**2 + J22**2)"),
    ("T_max1", "sqrt(G11**2 - G12**2)*a_max", "- G12**2 should be + G12**2"),
    ("T_max1", "sqrt(G11**2 + G12**2)", "the factor amax is missing"),
    ("j", "30*N_max/(pi*Thetad_max)", "pi*N_max/(30*Thetad_max)"),
    ("j", "pi*N_max/(60*Thetad_max)", "60 should be 30"),
    ("j", "N_max/(30*Thetad_max)", "pi*N_max"),
    ("tau_M", "T_max*j", "T_max/j"), ("tau_M", "j/T_max", "T_max/j"),
    ("I_Mmax", "I_L/j", "j should be j**2"), ("I_Mmin", "I_L/(2*j**2)", "2 should be 3"),
    ("loop1", _same("- l2**2", "- l1**2", LOOP), "l1 should be l2"),
    ("loop", "(s*e + l1*cos(theta) - y)**2 + (l1*sin(theta) - y)**2 = l2**2", "y should be x"),
    ("loop2", r"$(e + l_1\cos\theta_2 - x)^2 + (l_1\sin\theta_2 - y)^2 = l_2^2$", "should be -e"),
    ("A1", "2*(e + x)*l1", "+ x should be - x"),
    ("A1", "2*(e - x)*l2", "l2 should be l1"),
    ("A1", "2*(e - y)*l1", "y should be x"),
    ("A", "2*(e - x)*l1", "factor s is missing"),
    ("B1", "-2*x*l1", "x should be y"),
    ("C1", _same("- y**2", "+ y**2", C1), "+ y**2 should be - y**2"),
    ("C1", _same("- e**2", "- e", C1), "e should be e**2"),
    ("C1", _same("+ 2*e*x", "+ e*x", C1), "2*e*x"),
    ("C1", _same("+ 2*e*x", "- 2*e*x", C1), "- 2*e*x should be + 2*e*x"),
    ("theta1", _same("- C1**2", "+ C1**2", TAN), "+ C1**2 should be - C1**2"),
    ("theta1", _same("(A1 + C1)", "(A1 - C1)", TAN), "- C1 should be + C1"),
    ("theta1", _same("2*atan", "atan", TAN), "2*atan"),
    ("theta1", _same("atan2(B1, A1)", "atan2(A1, B1)", ACOS), "atan2(B1, A1)"),
    ("theta1", _same("x - e", "x + e", TRIANGLE), "+ e should be - e"),
    ("theta1", _same("+ y**2 -", "+ y -", TRIANGLE), "y should be y**2"),
    ("w1x", "(x + e - l1*cos(theta1))/l2", "+ e should be - e"),
    ("w1x", "(x - e - l1*sin(theta1))/l2", "sin(theta1) should be cos(theta1)"),
    ("w1x", "(x - e - l1*cos(theta1))/l1", "l1 should be l2"),
    ("w1x", "(x - e - cos(theta1))/l2", "factor l1 is missing"),
    ("w_x", "(x - s*e - l2*cos(theta))/l2", "l2 should be l1"),
    ("J11", _same("- u1y", "+ u1y", J11), "+ u1y*w1x should be - u1y*w1x"),
    ("J11", _same("w1x/", "w1y/", J11), "w1y should be w1x"),
    ("J11", _same("l1*", "l2*", J11), "l2 should be l1"),
    ("J11", "w1x/(l1*(u1x*w1y))", "the term -u1y*w1x is missing"),
    ("J11", _same("y*cos", "y*sin", IN_XY), "sin(theta1) should be cos(theta1)"),
    ("J21", "w2x/(l1*(u1x*w2y - u2y*w2x))", "u1x should be u2x"),
    ("thetad1", _same("+ w1y*vy", "- w1y*vy", RATE), "- w1y*vy should be + w1y*vy"),
    ("thetad1", "(w1x*vx + w1y*vy)/(u1x*w1y - u1y*w1x)", "l1*(u1x*w1y - u1y*w1x)"),
    ("thetad1", "J11*vx + J21*vy", "J21 should be J12"),
    ("thetadd1", _same("uHw1**3", "uHw1**2", TURN), "uHw1**2 should be uHw1**3"),
    ("thetadd1", _same("u1y)**2/l2", "u1y)/l2", TURN), "(vx*u1x + vy*u1y)**2"),
    ("thetadd1", _same("/l1 +", "/l2 +", TURN), "l2 should be l1"),
    ("thetadd1", _same("u1x*w1x + u1y", "u1x*w1x - u1y", TURN), "- u1y*w1y should be + u1y*w1y"),
    ("tau1", _same("- J21", "+ J21", TORQUE), "+ J21*(ay + g) should be - J21*(ay + g)"),
    ("tau1", _same("(ay + g)", "ay", TORQUE), "ay should be (ay + g)"),
    ("tau1", _same("m1*lc1*g*cos", "m1*lc1*g*sin", TORQUE), "should be cos(theta1)"),
    ("tau1", _same(" + m1*lc1*g*cos(theta1)", "", TORQUE), "the term tauAg1 is missing"),
    ("tau1", _same("thetadd1", "thetad1", TORQUE), "thetad1 should be thetadd1"),
    ("tau1", _same("J22*ax", "J11*ax", TORQUE), "J11 should be J22"),
    ("G12", _same("- m*J21", "+ m*J21", GAIN), "should be - m*J21"),
    ("G12", _same("- m*J21", "- m*J12", GAIN), "J12 should be J21"),
    ("P1", "tau1*thetad2", "thetad2 should be thetad1"),
    ("I_L1", "I_A + m*(J12**2 + J22**2)/(J11*J22 - J12*J21)**2", "J12 should be J21"),
    ("I_L1", "I_A + m*(J21**2 + J22**2)/(J11*J22 - J12*J21)", "(J11*J22 - J12*J21)**2"),
]  # fmt: skip


@pytest.mark.many
@pytest.mark.parametrize(("entry", "text", "told"), SLIPS)
def test_one_slip_is_named_and_put_right(entry: str, text: str, told: str) -> None:
    found = kl.diagnose("isotropic", entry, text, samples=40)
    assert found.verdict == "differs", str(found)
    cause = found.causes[0]
    assert len(cause.kinds) == 1
    assert told in cause.sentence
    (right,) = cause.shown.values()
    assert kl.diagnose("unequal", entry, right, samples=40).agrees


PAIRS = [
    ("C1", "l2**2 + l1**2 - e**2 - x**2 - y**2 - 2*e*x"),
    ("C1", "l2**2 - l1**2 - e**2 - x**2 + y**2 + e*x"),
    ("C", "l2**2 - l1**2 - e - x**2 - y**2"),
    ("w1x", "(x + e - l1*sin(theta1))/l2"),
    ("J11", "w1y/(l2*(u1x*w1y - u1y*w1x))"),
    ("thetad1", "J11*vy + J21*vy"),
    ("thetad1", "(w1x*vx - w1y*vy)/(l2*(u1x*w1y - u1y*w1x))"),
    ("thetadd1", _same("/l2)", "/l1)", _same("/l1 +", "/l2 +", TURN))),
    ("tau1", _same("- J21", "+ J21", _same("cos", "sin", TORQUE))),
    ("tau1", _same("(ay + g)", "ay", _same("m1*lc1*g*cos", "m1*g*cos", TORQUE))),
    ("tau1", _same("J22*ax", "J11*ax", _same("I_A*", "", TORQUE))),
    ("G12", "I_A*J11 + m*J21/(J11*J22 - J12*J21)"),
]  # fmt: skip


@pytest.mark.many
@pytest.mark.parametrize(("entry", "text"), PAIRS)
def test_two_slips_are_named_and_put_right(entry: str, text: str) -> None:
    found = kl.diagnose("isotropic", entry, text, samples=40)
    assert found.causes, str(found)
    assert len(found.causes[0].kinds) == 2
    (right,) = found.causes[0].shown.values()
    assert kl.diagnose("unequal", entry, right, samples=40).agrees


def test_one_formula_of_a_leg_says_the_factor_of_the_others(tmp_path) -> None:
    file = tmp_path / "half.toml"
    file.write_text(
        'robot = "isotropic"\n[formulas]\nA1 = "(e - x)*l1"\nB1 = "-y*l1"\n'
        'C1 = "l2**2 - l1**2 - e**2 - x**2 - y**2 + 2*e*x"\n'
    )
    from kinlab.doctor.file import examine_file

    found = {one.function: one for one in examine_file(file, 40)}
    assert found["A1"].agrees and found["B1"].agrees
    assert found["C1"].causes[0].kinds == ("factor",)


@pytest.mark.parametrize(
    ("robot", "entry", "text", "told"),
    [
        ("isotropic", "M11", "l1", "names no quantity of a five-bar; did you mean 'J11'"),
        ("isotropic", "N", "30*j/pi", "names no quantity of a five-bar"),
        ("isotropic", "j", "pi*N/30", "'N' is unknown"),
        ("isotropic", "T_max1", "sqrt(G11**2 + G12**2)*v_max", "did you mean 'amax'"),
        ("isotropic", "J11", "m3*l1", "'m3' is unknown"),
        (
            "isotropic",
            "C1",
            "l2**2*cos(theta1)",
            "q1 does not belong into fivebar_equation, which depends on xy",
        ),
        ("plotclock", "tau1", "I_A*thetadd1", "plotclock has no masses"),
    ],
)
def test_what_cannot_be_judged_is_refused_at_the_door(robot, entry, text, told) -> None:
    with pytest.raises(ExpressionError, match=told.replace("(", r"\(")):
        kl.diagnose(robot, entry, text)


def test_a_five_bar_without_e_says_what_is_not_judged() -> None:
    found = kl.diagnose("minitaur_leg", "C1", C1, samples=40)
    assert found.agrees
    assert "of this robot e = 0" in found.sentence


def test_a_five_bar_of_ones_own_is_known_by_its_file(tmp_path) -> None:
    (tmp_path / "mine.toml").write_text('name = "mine"\nl1 = 0.2\nl2 = 0.4\ne = 0.1\n')
    file = tmp_path / "formulas.toml"
    file.write_text('robot = "mine.toml"\n[formulas]\nC1 = "l2**2 - l1**2 - e**2 - x**2 - y**2"\n')
    from kinlab.doctor.file import examine_file

    (found,) = examine_file(file, 40)
    assert found.sentence == "C1: the term 2*e*x is missing (missing term)"


def test_a_formula_of_the_other_crank_is_told_as_such() -> None:
    found = kl.diagnose("isotropic", "Thetad2", "sqrt(J11**2 + J12**2)*v_max", samples=40)
    assert "the formula is the other crank's" in found.sentence


def test_a_slip_within_what_a_lost_factor_is_put_in_front_of() -> None:
    """Both stand in the line: they come before any reading of the angle."""
    right = "(x - e - l1*cos(q1))/(l1*(y*cos(q1) - (x - e)*sin(q1)))"
    slips = right.replace("(l1*(y", "((y").replace("- (x - e)*sin", "+ (x - e)*sin")
    assert kl.diagnose("isotropic", "J11", right).agrees
    found = kl.diagnose("isotropic", "J11", slips)
    assert {*found.causes[0].kinds} == {"sign", "missing factor"}, str(found)
    (corrected,) = found.causes[0].corrected.values()
    assert kl.diagnose("isotropic", "J11", corrected).agrees


def test_a_coefficient_alone_that_is_multiplied_is_right_if_all_are() -> None:
    found = kl.diagnose("isotropic", "B1", "-l1*y")
    assert found.agrees and found.form == "unusual"
    assert "A, B and C all are" in found.remarks[0]


@pytest.mark.parametrize(
    ("entry", "text"),
    [
        ("w1y", "2*y - 0.6*sin(theta1)"),
        ("w1y", "2*(y - 0.3*sin(theta1))"),
        ("w1x", "2*x - 2*e - 0.6*cos(theta1)"),
    ],
)
def test_numbers_for_names_hide_no_two_signs(entry, text) -> None:
    """For another five-bar it is wrong; what undoes nothing, a sign twice, is no slip of it."""
    found = kl.diagnose("isotropic", entry, text)
    assert found.agrees, str(found)


TURNED_LOOP = "(x - e - l1*cos(theta1))^2 + (y - l1*sin(theta1))^2 - l2^2"


@pytest.mark.parametrize(
    "text",
    [
        f"-({TURNED_LOOP})",
        f"2*({TURNED_LOOP})",
        f"({TURNED_LOOP})/l2^2",
        "((x - e - l1*cos(theta1))/l2)^2 + ((y - l1*sin(theta1))/l2)^2 - 1",
        "l2 - sqrt((x - e - l1*cos(theta1))^2 + (y - l1*sin(theta1))^2)",
        "(x - e)*cos(theta1) + y*sin(theta1) - ((x - e)^2 + y^2 + l1^2 - l2^2)/(2*l1)",
    ],
)
def test_the_loop_by_a_constant_or_as_lengths_is_the_same_equation(text) -> None:
    found = kl.diagnose("isotropic", "loop1", text)
    assert found.agrees and found.form == "unusual", str(found)
    wrong = kl.diagnose("isotropic", "loop1", text.replace("- e", "+ e"))
    assert not wrong.agrees, str(wrong)


def test_a_constant_is_one_at_every_five_bar() -> None:
    """l1 for l2 is no constant, though both are equal here."""
    found = kl.diagnose("equal_links", "loop1", f"2*({TURNED_LOOP.replace('l2', 'l1')})")
    assert not found.agrees, str(found)


ONE_MODE = """A = 2*l1*(e - x)
B = -2*l1*y
C = l2^2 - l1^2 - (x - e)^2 - y^2
theta1 = 2*atan((B {sign} sqrt(A^2 + B^2 - C^2))/(A + C))
ux = cos(theta1)
uy = sin(theta1)
wx = (x - e - l1*ux)/l2
wy = (y - l1*uy)/l2
thetad1 = (vx*wx + vy*wy)/(l1*(ux*wy - uy*wx))"""


@pytest.mark.parametrize(("sign", "mode"), [("-", "(-1,"), ("+", "(+1,")])
def test_what_works_the_angle_out_by_itself_is_right_in_its_working_mode(sign, mode) -> None:
    text = ONE_MODE.format(sign=sign)
    found = kl.diagnose("isotropic", "fivebar_rates[0]", text)
    assert found.agrees and mode in found.remarks[0], str(found)
    angle = "\n".join(text.splitlines()[:4])
    assert kl.diagnose("isotropic", "fivebar_angles[0]", angle).agrees


def test_a_slip_in_one_working_mode_is_told() -> None:
    wrong = ONE_MODE.format(sign="-").replace("ux*wy - uy*wx", "ux*wy + uy*wx")
    found = kl.diagnose("isotropic", "fivebar_rates[0]", wrong)
    assert found.causes[0].kinds == ("sign",) and "uy*wx" in found.sentence, str(found)


def test_the_e_of_a_number_is_no_name() -> None:
    found = kl.diagnose("isotropic", "loop1", f"{TURNED_LOOP} + 1e-4")
    assert found.sentence == "loop1: the term 1e-4 does not belong there (extra term)"


def test_one_coefficient_is_judged_alike_as_a_function_and_as_text() -> None:
    def half(xy):
        return 0.3 * (0.2 / np.sqrt(2) - xy[0])

    function = kl.diagnose("isotropic", "fivebar_equation[0,0]", half)
    text = kl.diagnose("isotropic", "A1", "l1*(e - x)")
    assert function.agrees and text.agrees and function.remarks == text.remarks
