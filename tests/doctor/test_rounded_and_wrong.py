"""A rounded number beside a slip: the slip is told, and the number is read as what it stands for."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.report import of_document


def judged(robot="planar2r", **formulas):
    found, unread = of_document({"robot": robot, "formulas": formulas}, "f.toml")
    assert not unread
    return found


@pytest.mark.parametrize(
    ("robot", "formulas", "told", "correct"),
    [
        (
            "planar2r",
            {"V": "m1*9.8*l1*s1 + m2*9.8*(l1*s1 + l2*s2)"},
            "V: s2 should be s12",
            "l2*s12)",
        ),
        (
            "planar3r",
            {"V": "9.8*(m1*l1/2*s1 + m2*(l1*s1+l2/2*s12) + m3*(l1*s1+l2*s12+l3/2*s12))"},
            "s12 should be s123",
            "l3/2*s123))",
        ),
        ("planar2r", {"g2": "m2*9.8*l2*c2"}, "c2 should be c12", "l2*c12"),
        (
            "planar2r",
            {"g1": "(m1+m2)*g*l1*c1 + m2*g*l2*c12", "g2": "m2*9.8*l2*c2"},
            "g2: c2 should be c12",
            "l2*c12",
        ),
        (
            "planar2r",
            {"g1": "(m1+m2)*g*l1*c1 + m2*g*l2*c2", "g2": "m2*9.8*l2*c12"},
            "g1: c2 should be c12",
            "l2*c12",
        ),
    ],
)
def test_a_slip_beside_a_rounded_g(robot, formulas, told, correct):
    (found,) = judged(robot, **formulas)
    assert not found.agrees
    first = found.causes[0]
    assert told in first.sentence
    assert "9.8 stands for g = 9.81" in first.sentence
    assert "sign" not in first.sentence
    assert any(text.endswith(correct) for text in first.corrected.values())


def test_a_rounded_g_alone_is_right_whatever_else_the_file_holds():
    wrong, right = judged(T="m1*l1**2*qd1**2", g2="m2*9.8*l2*c12")
    assert not wrong.agrees
    assert right.agrees
    assert right.form == "rounded"
    assert right.remarks == ("9.8 stands for g = 9.81",)


@pytest.mark.parametrize(
    ("x", "told"), [("-0.41*s12", "0.41 should be l2"), ("-0.5*s12", "0.5 should be l2")]
)
def test_the_number_of_a_length_mistaken(x, told):
    (found,) = judged(J12=x)
    assert told in found.causes[0].sentence
    assert set(found.causes[0].corrected.values()) == {"-l2*s12"}


def test_one_entry_of_C_is_said_to_be_judged_by_christoffel_s():
    (found,) = judged(C12="-m2*l1*l2*s2*(2*qd1+qd2)")
    assert "Christoffel's C is meant" in found.causes[0].sentence
    whole_row = judged(C11="0", C12="-m2*l1*l2*s2*(2*qd1+qd2)")
    assert [one.form for one in whole_row] == ["unusual"]


@pytest.mark.parametrize(
    ("robot", "entry", "text", "right"),
    [
        ("planar2r", "M22", "0.2412", "0.24"),
        ("planar2r", "g1", "(m1 + m2)*g*l1*c1 + 5.913*c12", "(m1 + m2)*g*l1*c1 + 5.886*c12"),
        ("planar2r", "J11", "-l1*s1 - 0.402*s12", "-l1*s1 - l2*s12"),
        ("planar2r_rods", "M22", "0.3344*m2*l2**2", "(1/3)*m2*l2**2"),
        ("planar2r", "M22", "1.5*0.16*1.001", "1.5*0.16"),
    ],
)
def test_a_number_that_is_off_is_put_right(robot, entry, text, right):
    (found,) = judged(robot, **{entry: text})
    assert found.grade == "wrong"
    assert found.causes[0].shown == {entry: right}
    assert len(found.causes[0].kinds) == 1


def test_a_slide_is_called_d_as_in_the_table():
    links = (
        kl.DHLink(joint="revolute", alpha=np.pi / 2, mass=1.0),
        kl.DHLink(joint="prismatic", mass=2.0),
    )
    arm = kl.Robot.from_dh(kl.DHTable("polar", "standard", links, gravity=(0.0, -9.81, 0.0)))
    tau2 = r"$m_2 \ddot{d}_2 - m_2 d_2 \dot{\theta}_1^2 - m_2 g \cos\theta_1$"
    assert kl.diagnose(arm, "tau2", tau2, samples=30).agrees
    lost = kl.diagnose(arm, "tau2", tau2.replace("_1^2", "_1"), samples=30)
    assert lost.causes[0].shown == {"tau2": tau2.strip("$")}
    assert kl.diagnose(arm, "tau1", "m2*(d2^2*qdd1 + 2*d2*d2_dot*qd1 + g*d2*s1)").agrees


def test_one_digit_is_no_rounding_of_a_third():
    (found,) = judged("planar3r", M33="0.3*m3*l3**2")
    assert not found.agrees and "0.3 should be (1/3)" in found.sentence
    (found,) = judged("planar3r", M33="0.33*m3*l3**2")
    assert found.agrees and "0.33 stands for 1/3" in found.sentence


@pytest.mark.parametrize(
    "energy", ["17.0*sin(q1) + 5.9*sin(q1+q2)", "17.2*s1+5.8*s12", "16.9*s1 + 5.886*s12"]
)
def test_a_number_that_is_off_is_no_opposite_sign(energy):
    (found,) = judged(V=energy)
    assert not found.agrees
    assert all("sign" not in cause.kinds for cause in found.causes)


def test_a_power_is_written_back_as_it_was_typed():
    (found,) = judged(M12="m2*l2^2 + 2*m2*l1*l2*cos(theta2)")
    assert "correct: M12 = m2*l2^2 + m2*l1*l2*cos(theta2)" in str(found)


def test_what_is_right_when_rounded_is_not_blamed_beside_a_wrong_sister():
    (found,) = judged(M11="1.1 + 0.6*c2", M12="0.24 + 0.3*c2", M22="0.239")
    assert found.causes[0].shown == {"M22": "0.24"}
    assert found.worst_entry == "mass_matrix[1,1]"  # M11 is further off, and right
    torques = {
        "tau1": "1.1*qdd1 + 0.6*c2*qdd1 + (0.24+0.3*c2)*qdd2 - 0.3*s2*(2*qd1*qd2+qd2**2) + 17.2*c1"
        " + 5.89*c12",
        "tau2": "(0.24+0.3*c2)*qdd1 + 0.24*qdd2 + 0.3*s2*qd1**2 + 5.8*c12",
    }
    (found,) = judged(**torques)
    assert found.causes[0].shown == {"tau2": torques["tau2"].replace("5.8", "5.886")}
    _right, wrong = judged(g2="9.8*m2*l2*c12", V="9.81*m1*l1*s1 + 9.81*m2*(l1*s1 - l2*s12)")
    assert "9.8 " not in wrong.sentence
    (wrong,) = judged(tau1=torques["tau1"], tau2=torques["tau2"].replace("s2*qd1", "c2*qd1"))
    assert not any("opposite sign" in cause.sentence for cause in wrong.causes)


def test_a_number_is_not_called_a_parameter_by_chance():
    (found,) = judged("planar3r", M12="0.2875 + 0.1*c3 + 0.4*c2 + 0.063*c23")
    assert found.agrees and "0.063 stands for 0.0625" in found.sentence  # m3*l1*l3/2, not I1


@pytest.mark.parametrize(
    ("entry", "text", "right", "kinds"),
    [
        ("J12", "0.4*c12", "-0.4*s12", ("sin/cos",)),
        ("J11", "-l1*s1 + l1*c12", "-l1*s1 - l2*s12", ("index", "sin/cos")),
        ("J21", "-l_1 s_1 + l_2 c_{12}", "l_1 c_1 + l_2 c_{12}", ("sin/cos",)),
        (
            "g1",
            "(m2+m2)*g*l1*cos(q1) - m1*g*l2*cos(q1+q2)",
            "(m1+m2)*g*l1*cos(q1) + m2*g*l2*cos(q1+q2)",
            ("index", "sign", "index"),
        ),
        (
            "T",
            "m1*l1^2*qd1^2/2 + m2*(l1^2*qd1^2 - l2^2*(qd1-qd2)^2 + 2*l1*l2*cos(q2)*qd1*(qd1+qd2))/2",
            "m1*l1^2*qd1^2/2 + m2*(l1^2*qd1^2 + l2^2*(qd1+qd2)^2 + 2*l1*l2*cos(q2)*qd1*(qd1+qd2))/2",
            ("sign", "sign"),
        ),
        (
            "tau1",
            "m2*l2^2*(qdd1+qdd2) + m2*l1*l2*c2*(2*qdd1+qdd2) + (m1+m2)*l1^2*qdd1"
            " - m2*l1*l2*s2*qd2^2 + 2*m2*l1*l2*s2*qd1*qd1 + m2*l2*g*c12 + (m1+m2)*l1*g*c1",
            "m2*l2^2*(qdd1+qdd2) + m2*l1*l2*c2*(2*qdd1+qdd2) + (m1+m2)*l1^2*qdd1"
            " - m2*l1*l2*s2*qd2^2 - 2*m2*l1*l2*s2*qd2*qd1 + m2*l2*g*c12 + (m1+m2)*l1*g*c1",
            ("sign", "index"),
        ),
    ],
)
def test_simple_slips_before_roundabout_ones_in_the_writers_line(entry, text, right, kinds):
    (found,) = judged(**{entry: text})
    assert found.causes[0].shown == {entry: right}
    assert found.causes[0].kinds == kinds


def test_no_number_is_put_right_by_chance_of_the_masses():
    half = "(m1 + 0.5*m2)*g*l1*c1 + 0.5*m2*g*l2*c12"  # m1/2 + m2 is m1 + m2/3 with these masses
    (found,) = judged("planar2r_rods", g1=half)
    assert found.causes[0].shown == {"g1": "(m2 + 0.5*m1)*g*l1*c1 + 0.5*m2*g*l2*c12"}


def test_a_sign_and_another_slip_at_the_same_letter():
    (found,) = judged(M12="s2*m2*l1*l2 - m2*l2**2")
    assert found.causes[0].shown == {"M12": "c2*m2*l1*l2 + m2*l2**2"}
    (found,) = judged(J12="c12*l2")
    assert found.causes[0].shown == {"J12": "-s12*l2"}


@pytest.mark.parametrize(
    ("robot", "formulas", "right"),
    [
        ("planar2r", {"V": "17.0*sin(q1) + 5.9*sin(q1+q2)"}, {"V": ("17.0", "17.1675")}),
        (
            "planar2r",
            {"g1": "17.1*c1 + 5.89*c12", "g2": "5.9*c12"},
            {"g1": ("17.1*", "17.1675*")},
        ),
        ("planar3r", {"M13": "0.02 + 0.05*c3 + 0.06*c23"}, {"M13": None}),
        (
            "planar2r",
            {"tau2": "(0.24+0.3*c2)*qdd1 + 0.24*qdd2 + 0.3*c2*qd1**2 + 5.89*c12"},
            {"tau2": ("0.3*c2*qd1", "0.3*s2*qd1")},
        ),
        (
            "planar3r",
            {"M22": "0.3*m2*l2**2 + 0.3*m3*l3**2 + m3*l2**2 + m3*l2*l3*c3"},
            {"M22": ("0.3*m", "(1/3)*m")},
        ),
    ],
)
def test_numbers_off_beside_rounded_ones(robot, formulas, right):
    (found,) = judged(robot, **formulas)
    for entry, change in right.items():
        corrected = found.causes[0].shown[entry]
        if change is None:
            assert corrected == "0.0208333333333 + 0.05*c3 + 0.0625*c23"
        else:
            assert corrected == formulas[entry].replace(*change)
    assert set(found.causes[0].shown) == set(right)


@pytest.mark.parametrize(
    ("robot", "entry", "text", "change"),
    [
        ("planar2r", "tau2", "-0.3*sin(q2)*qd1^2 + 5.89*cos(q1+q2)", ("-0.3", "0.3")),
        ("planar2r", "tau2", "0.3*sin(q2)*qd2^2 + 5.89*cos(q1+q2)", ("qd2^2", "qd1^2")),
        ("planar2r", "tau2", "0.3*sin(q2)*qd1^2 + 5.89*cos(q1)", ("cos(q1)", "cos(q1 + q2)")),
        ("planar2r", "tau2", "0.3*sin(q2)*qd1^2 + 6*cos(q1+q2)", ("6*", "5.886*")),
        (
            "planar2r",
            "tau2",
            "m2*l1*l2*sin(q2)*qd1^2 + 14.7*l2*cos(q1)",
            ("cos(q1)", "cos(q1 + q2)"),
        ),
        ("planar2r", "g1", "17.17*c1-5.89*c12", ("-", "+")),
        ("planar2r", "M11", "1.12+0.6*s2", ("s2", "c2")),
        ("planar3r", "M13", "0.0208+0.0625*c23+0.05*c2", ("c2", "c3")),
        ("planar3r", "M33", "1/50", ("50", "48")),
    ],
)
def test_one_slip_beside_a_product_of_the_robots_numbers_rounded(robot, entry, text, change):
    inertia = {"tau2": "(0.24+0.3*cos(q2))*qdd1 + 0.24*qdd2 + "}.get(entry, "")
    typed = f"{inertia}{text}".replace("+ -", "- ")
    right = f"{inertia}{(text[::-1].replace(change[0][::-1], change[1][::-1], 1))[::-1]}"
    (found,) = judged(robot, **{entry: typed})
    first = found.causes[0]
    assert found.grade == "wrong"
    assert len(first.kinds) == 1
    assert first.shown == {entry: right}


def test_a_number_nearly_a_coefficient_beside_a_slip():
    (found,) = judged(g1="17*c1 - 5.9*c12")
    assert found.causes[0].shown == {"g1": "17.1675*c1 + 5.9*c12"}
    assert set(found.causes[0].kinds) == {"coefficient", "sign"}


@pytest.mark.parametrize(
    ("robot", "entry", "text", "right", "kinds"),
    [
        ("planar2r", "g2", "6*c12", "5.886*c12", ["coefficient"]),
        ("planar2r", "M22", "1", "0.24", ["coefficient"]),
        (
            "planar2r",
            "T",
            "0.44*qd1 + 0.12*(qd1 + qd2)^2 + 0.3*c2*qd1*(qd1 + qd2)",
            "0.44*qd1^2 + 0.12*(qd1 + qd2)^2 + 0.3*c2*qd1*(qd1 + qd2)",
            ["power"],
        ),
        (
            "planar2r",
            "tau2",
            "0.24*(qdd1 + qdd2) + 0.3*c2*qdd1 + 0.3*s2*qd1 + 5.886*s12",
            "0.24*(qdd1 + qdd2) + 0.3*c2*qdd1 + 0.3*s2*qd1^2 + 5.886*c12",
            ["power", "sin/cos"],
        ),
        (
            "planar3r",
            "x",
            "-0.5*cos(q1) + 0.45*cos(q1+q2) + 0.25*sin(q1+q2+q3)",
            "0.5*cos(q1) + 0.4*cos(q1+q2) + 0.25*cos(q1+q2+q3)",
            ["sign", "coefficient", "sin/cos"],
        ),
    ],
)
def test_slips_in_a_formula_of_numbers_alone(robot, entry, text, right, kinds):
    (found,) = judged(robot, **{entry: text})
    first = found.causes[0]
    assert sorted(first.kinds) == sorted(kinds)
    assert first.corrected[entry].replace("**", "^") == right


IK_1 = "atan2(y, x) - atan2(l2*sin(q2), l1 + l2*cos(q2))"
IK_2 = "3.1416 - acos((l1^2 + l2^2 - x^2 - y^2)/(2*l1*l2))"


@pytest.mark.parametrize(
    ("formulas", "told", "rounded"),
    [
        (
            {"g1": "(m1+m2)*g*l1*s1 + m2*g*l2*c12", "g2": "m2*g*l2*sin(q1 + q2 + 3.1416/2)"},
            "g1: s1 should be c1",
            "3.1416 stands for pi",
        ),
        (
            {"g1": "17.1675*sin(q1 + 1.57) + 5.886*cos(q2)"},
            "g1: cos(q2) should be cos(q1 + q2)",
            "1.57 stands for pi/2",
        ),
        (
            {"q1": IK_1.replace(" - ", " + "), "q2": IK_2},
            "with the opposite sign in the angle q1",
            "3.1416 stands for pi",
        ),
        (
            {"q1": IK_1, "q2": IK_2.replace("2*l1*l2", "2*l1*l1")},
            "l1 for l2 in the cosine of q2",
            "3.1416 stands for pi",
        ),
    ],
)
def test_a_slip_beside_a_rounded_angle(formulas, told, rounded):
    (found,) = judged(**formulas)
    assert not found.agrees
    first = found.causes[0]
    assert len(first.kinds) == 1
    assert told in first.sentence and rounded in first.sentence


def test_a_length_near_a_right_angle_is_none():
    (found,) = judged(x="1.57*cos(q1) + 0.4*cos(q1 + q2)")
    assert "1.57 should be 0.5" in found.causes[0].sentence
    assert "pi" not in found.causes[0].sentence


@pytest.mark.parametrize(
    ("entry", "formula"),
    [
        ("g1", "17.15*c1 + 5.88*c12"),
        ("tau2", "0.24*(qdd1 + qdd2) + 0.3*c2*qdd1 + 0.3*s2*qd1^2 + 5.88*c12"),
    ],
)
def test_coefficients_worked_out_with_a_rounded_g_are_right(entry, formula):
    found = kl.diagnose("planar2r", entry, formula)
    assert (found.agrees, found.form) == (True, "rounded")
    assert found.remarks == ("g = 9.8 stands for 9.81",)


@pytest.mark.parametrize(
    "formula", ["17.15*c1 + 5.886*c12", "17.15*c1 - 5.88*c12", "17.5*c1 + 6*c12"]
)
def test_coefficients_of_two_gs_are_not(formula):
    assert not kl.diagnose("planar2r", "g1", formula).agrees


@pytest.mark.parametrize("formula", ["1.5*9.81*0.4*c12*180/pi", "m2*g*l2*c12*pi/180"])
def test_a_fraction_that_does_not_belong_goes_as_a_whole(formula):
    found = kl.diagnose("planar2r", "g2", formula)
    assert f"the factor {formula.split('c12*')[1]} does not belong" in found.sentence


def test_what_a_rounded_number_of_a_corrected_formula_stands_for_is_told():
    said = str(kl.diagnose("planar2r", "M11", "1.12 - 0.6*c2"))
    assert "correct: M11 = 1.12 + 0.6*c2" in said
    assert "1.12 stands for" in said
    assert "= 1.115" in said
