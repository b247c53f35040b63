"""A formula as text from Python: the same door as a function."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.report import of_document
from kinlab.errors import ExpressionError, KinlabError

TAU2 = "m2*l1*l2*c2*qdd1 + m2*l1*l2*s2*qd1**2 + m2*l2*g*c12 + m2*l2**2*(qdd1 + qdd2)"


@pytest.mark.parametrize("quantity", ["tau2", "inverse_dynamics[1]", r"\tau_2"])
def test_a_text_is_judged(quantity):
    assert kl.diagnose("planar2r", quantity, TAU2, samples=30).agrees
    wrong = kl.diagnose("planar2r", quantity, TAU2.replace("qd1**2", "qd1"), samples=30)
    assert not wrong.agrees
    assert list(wrong.causes[0].shown.values()) == [TAU2]


def test_a_text_of_a_robot_that_is_loaded():
    arm = kl.load("planar2r")
    latex = r"\begin{pmatrix} -l_1 s_1 - l_2 s_{12} & l_2 s_{12} \end{pmatrix}"
    found = kl.diagnose(arm, "J12", "l2*s12", samples=30)
    assert found.causes[0].shown == {"J12": "-l2*s12"}
    assert kl.diagnose(arm.table, "V", r"m_1 g l_1 s_1 + m_2 g (l_1 s_1 + l_2 s_{12})").agrees
    assert kl.diagnose(arm, "J", latex).causes[0].shown == {"J12": "-l_2 s_{12}"}


def test_a_function_may_have_a_books_name():
    assert kl.diagnose("planar2r", "g2", lambda q: 5.886 * np.cos(q[0] + q[1])).agrees
    with pytest.raises(KinlabError, match="nothing"):
        kl.diagnose("planar2r", "nothing", lambda q: 0.0)


def test_what_is_no_formula_is_refused():
    with pytest.raises(ExpressionError, match="tau2"):
        kl.diagnose("planar2r", "tau2", "m2 l2 +")
    with pytest.raises(KinlabError, match="cannot be called"):
        kl.diagnose("planar2r", "tau2", 3.0)


def test_the_printed_gradient_of_the_energy_as_text():
    """Note 002 sums qd_j over the vector dT/dq; Mq and T of the arm, by hand."""
    right = ["0", "-m2*l1*l2*s2*qd1*(qd1 + qd2)"]
    printed = f"qd2*({right[1]})"
    assert kl.diagnose("planar2r", "kinetic_gradient", f"[{', '.join(right)}]").agrees
    found = kl.diagnose("planar2r", "kinetic_gradient", f"[{printed}, {printed}]")
    assert found.causes[0].kinds == ("one number",)


@pytest.mark.parametrize(
    ("formulas", "told", "right"),
    [
        (
            {"tau1": "-(l1*s1 + l2*s12)*fx + (l1*c1 + l2*s12)*fy"},
            "s12 should be c12 in l2*s12",
            "-(l1*s1 + l2*s12)*fx + (l1*c1 + l2*c12)*fy",
        ),
        (
            {
                "tau1": "-(l1*s1 + l2*s12)*fx + (l1*c1 + l2*c12)*fy",
                "tau2": "-l2*s12*fx + l2*c12*fx",
            },
            "fx should be fy",
            "-l2*s12*fx + l2*c12*fy",
        ),
        (
            {"tau1": "-(l1*s1 + l2*s12)*fx + nz", "tau2": "-l2*s12*fx"},
            "the term nz is missing",
            "-l2*s12*fx + nz",
        ),
        (
            {"tau1": "l2*fy + l1*s2*fx + l1*s2*fy", "tau2": "l2*fy"},
            "the wrench is read in tool axes",
            "l2*fy + l1*s2*fx + l1*c2*fy",
        ),
        (
            {"tau2": "m2*l2*(l2*(qdd1 + qdd2) + l1*(c2*qdd1 + s2*qd1^2) + g*c12) + l2*c2*fy"},
            "c2 should be c12 in l2*c2*fy",
            "m2*l2*(l2*(qdd1 + qdd2) + l1*(c2*qdd1 + s2*qd1^2) + g*c12) + l2*c12*fy",
        ),
    ],
)
def test_a_slip_beside_a_force_of_the_tool(formulas, told, right):
    (found,), unread = of_document({"robot": "planar2r", "formulas": formulas}, "f.toml", 60)
    assert not unread
    assert told in found.causes[0].sentence
    assert [text.replace("**", "^") for text in found.causes[0].shown.values()] == [right]


@pytest.mark.parametrize(
    ("robot", "entry", "text", "right"),
    [
        (
            "planar3r",
            "g2",
            "m1*g*l2*c12 + m3*g*(l2*c12 + l3/2*c123)",
            "m2*g*l2*c12/2 + m3*g*(l2*c12 + l3/2*c123)",
        ),
        (
            "planar2r_rods",
            "V",
            "g*(l2/2*s1 + m2*(l1*s1 + l2/2*sin(q2+q2)))",
            "g*(m1*l1/2*s1 + m2*(l1*s1 + l2/2*sin(q1+q2)))",
        ),
        (
            "planar2r",
            "T",
            "0.5*(m2+m2)*l1*qd1^2 + 0.5*m2*l2^2*(qd1+qd2)^2 + m2*l1*l2*c2*qd1*(qd1+qd2)",
            "0.5*(m1+m2)*l1^2*qd1^2 + 0.5*m2*l2^2*(qd1+qd2)^2 + m2*l1*l2*c2*qd1*(qd1+qd2)",
        ),
    ],
)
def test_no_repair_holds_at_the_robots_own_numbers_alone(robot, entry, text, right):
    """m1 is 3 and m2 is 2 in the planar 3R arm: one sign less would give the same torque."""
    (found,), _unread = of_document({"robot": robot, "formulas": {entry: text}}, "f.toml", 60)
    assert found.causes[0].shown[entry].replace("**", "^") in (
        right,
        right.replace("m1+m2", "m2+m1"),
    )


BOOKS = "m1*lc1^2 + I1 + m2*(l1^2 + lc2^2 + 2*l1*lc2*c2) + I2"
"""Spong's entry of the mass matrix."""


@pytest.mark.parametrize("letters", [("lc", "I"), ("r", "J"), ("L_c", "I_zz")])
def test_a_books_names_have_a_meaning_where_the_robot_has_others(letters):
    """The centre of a rod is at l/2, of a point mass at l: its table has no name for it."""
    typed = BOOKS.replace("lc", letters[0]).replace("I", letters[1])
    rods = kl.diagnose("planar2r_rods", "M11", typed)
    assert rods.agrees and not rods.remarks
    points = kl.diagnose("planar2r", "M11", typed)
    assert points.agrees
    zeros = " and ".join(f"{letters[1]}{k} = 0" for k in (1, 2))
    assert points.remarks == (f"of this robot {zeros}: what stands with it is not judged",)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("m1*lc1^2", "m1*l1^2", "l1 should be lc1 in m1*l1^2"),
        ("+ lc2^2", "+ l2^2", "l2 should be lc2 in l2^2"),
        ("l1*lc2", "lc1*lc2", "lc1 should be l1 in 2*lc1*lc2*c2"),
        ("2*l1*lc2*c2", "l1*lc2*c2", "l1*lc2*c2 should be 2*l1*lc2*c2"),
        ("lc2^2", "lc1^2", "lc1 should be lc2 in lc1^2"),
    ],
)
def test_a_slip_in_a_books_names_is_told_in_them(old, new, told):
    found = kl.diagnose("planar2r_rods", "M11", BOOKS.replace(old, new, 1))
    assert [told in cause.sentence for cause in found.causes] == [True]
    assert found.causes[0].shown["M11"].replace("**", "^") == BOOKS


ENTRY = "m1*l1**2/4 + I1 + m2*l1**2 + m2*l1*l2*cos(q2) + m2*l2**2/4 + I2"
"""The same of rods whose moments have names."""


@pytest.mark.parametrize(
    ("entry", "typed", "told"),
    [
        ("M22", "m2*l2**2/4", ["the term I2 is missing"]),
        ("M11", ENTRY.replace(" + I1", ""), ["the term I1 is missing"]),
        (
            "M11",
            ENTRY.replace(" + I1", "").replace("cos(q2)", "cos(q1)"),
            ["cos(q1) should be cos(q2)", "the term I1 is missing"],
        ),
        ("M22", "m2*l2**2/2", ["2 should be 3 in m2*l2**2/2"]),
        ("M22", "m2*l2/3", ["l2 should be l2**2"]),
    ],
)
def test_a_moment_that_is_left_out_comes_before_one_that_would_be_a_rods(entry, typed, told):
    found = kl.diagnose("planar2r_rods", entry, typed)
    assert all(one in found.causes[0].sentence for one in told), str(found)
    assert len(found.causes[0].kinds) == len(told)


def test_a_books_names_of_arms_that_are_not_planar():
    """Craig's arm with a hinge and a slide: l1 is how far the first centre of mass is."""
    hinge = kl.DHLink(alpha=np.pi / 2, theta=np.pi / 2, mass=2.4, com=(0, 0, 0.4))
    slide = kl.DHLink("prismatic", lower=0.2, upper=0.9, mass=1.1)
    table = kl.DHTable("rp", "standard", [hinge, slide], gravity=(0, -9.81, 0))
    text = r"\tau_1 = (m_1 l_1^2 + m_2 d_2^2)\ddot\theta_1 + 2 m_2 d_2 \dot\theta_1 \dot d_2"
    weight = r" + (m_1 l_1 + m_2 d_2) g \cos\theta_1"
    assert kl.diagnose(table, "tau1", text + weight).agrees
    wrong = kl.diagnose(table, "tau1", text + weight.replace("m_2 d_2", "m_2 l_1"))
    assert "l_1 should be d_2 in m_2 l_1" in wrong.causes[0].sentence


def test_a_moment_is_about_the_one_axis_that_the_arm_turns_about():
    """The hinge's axis is y of both frames, whatever the other moments are."""
    hinge = kl.DHLink(alpha=np.pi / 2, theta=np.pi / 2, mass=2.4, com=(0, 0, 0.4),
                      inertia=np.diag([0.11, 0.12, 0.03]))  # fmt: skip
    slide = kl.DHLink(
        "prismatic", lower=0.2, upper=0.9, mass=1.1, inertia=np.diag([0.05, 0.04, 0.02])
    )
    table = kl.DHTable("rp", "standard", [hinge, slide], gravity=(0, -9.81, 0))
    assert kl.diagnose(table, "M11", "m1*lc1^2 + I1 + I2 + m2*d2^2").agrees
    assert not kl.diagnose(table, "M11", "m1*lc1^2 + I1 + m2*d2^2").agrees


def test_the_centre_of_a_rod_in_space_is_half_its_length():
    """Books write a2/2 there, though the table has a number for it."""
    rows = [kl.DHLink(alpha=np.pi / 2, mass=1.0),
            kl.DHLink(a=0.4, mass=1.2, com=(-0.2, 0, 0)),
            kl.DHLink(a=0.3, mass=0.9, com=(-0.15, 0, 0))]  # fmt: skip
    table = kl.DHTable("rods", "standard", rows)
    text = "m2*g*a2/2*cos(q2) + m3*g*(a2*cos(q2) + a3/2*cos(q2 + q3))"
    right = kl.diagnose(table, "g2", text)
    assert right.agrees and not right.remarks
    wrong = kl.diagnose(table, "g2", text.replace("+ a3/2", "- a3/2").replace("a2/2", "a2"))
    assert wrong.causes[0].kinds == ("factor", "sign"), str(wrong)
    assert kl.diagnose(table, "g3", "m3*g*(a3 + cx3)*cos(q2 + q3)").agrees


def test_the_last_length_of_a_modified_table_is_the_tools():
    rows = [kl.DHLink(d=0.44), kl.DHLink(alpha=np.pi / 2), kl.DHLink(a=0.37)]
    tool = np.eye(4)
    tool[0, 3] = 0.32
    table = kl.DHTable("elbow", "modified", rows, tool=tool)
    assert kl.diagnose(table, "z", r"d_1 + a_2 \sin\theta_2 + a_3 \sin(\theta_2 + \theta_3)").agrees


def test_a_scaras_torque_has_few_terms():
    """Four joints, and a formula as short as of two: what is rounded away is told as that."""
    arm = kl.load("scara")
    assert kl.diagnose(arm, "tau3", "(Ia3 + m3 + m4)*qdd3 - (m3 + m4)*g").agrees
    lost = kl.diagnose(arm, "tau3", "m3*(qdd3 - g) + m4*(qdd3 - g)")
    assert not lost.agrees and "Ia3" in lost.causes[0].sentence


def test_few_states_are_enough():
    found = kl.diagnose("planar2r", "tau2", "1", samples=10)
    assert not found.agrees
