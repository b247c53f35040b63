"""Slips of formulas by hand that are carried on, or made where numbers are put in for names.

What is told is the place where it was made; the repair there is what its writer would put.
"""

from __future__ import annotations

import pytest

import kinlab as kl

CARRIED = "another side of the chain of equalities carries it on"


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        (
            "planar2r",
            "J12",
            "J12 = -l2*cos(q1 + q2) = -l2*(cos(q1)*cos(q2) - sin(q1)*sin(q2))",
            "J12: cos(q1 + q2) should be sin(q1 + q2)",
        ),
        (
            "planar2r_rods",
            "M22",
            r"$M_{22} = I_2 + m_2 l_{c2}^2 = \frac{m_2 l_2^2}{12} + \frac{m_2 l_2^2}{2}"
            r" = \frac{7 m_2 l_2^2}{12}$",
            r"M22: 2 should be 4 in \frac{m_2 l_2^2}{2}",
        ),
        (
            "planar2r",
            "g2",
            "g2 = m2*g*l2*sin(q1 + q2)\n   = m2*g*l2*(s1*c2 + c1*s2)",
            "g2: sin(q1 + q2) should be cos(q1 + q2)",
        ),
        (
            "single_link",
            "T",
            "T = 1/8 m1 l1^2 qd1^2 + 1/12 m1 l1^2 qd1^2 = 5/24 m1 l1^2 qd1^2",
            "T: 12 should be 24",
        ),
    ],
    ids=["expanded", "in the middle", "another line", "a sum"],
)
def test_a_slip_is_told_where_it_is_made(robot, entry, text, said):
    found = kl.diagnose(robot, entry, text)
    assert found.sentence.startswith(said) and CARRIED in found.sentence, found


def test_of_two_slips_in_a_chain_the_last_side_is_what_was_meant():
    """The sides have different values: what is wrong at the end is told."""
    found = kl.diagnose("planar2r", "g2", "g2 = m1*g*l2*cos(q1 + q2) = m2*g*l2*sin(q1 + q2)")
    assert found.sentence.startswith("g2: sin(q1 + q2) should be cos(q1 + q2)"), found
    assert CARRIED not in found.sentence


def test_words_that_were_not_read_are_held_against_the_side_that_is_told():
    text = "Produktkette der beiden Matrizen:\nx = l1 c1 + c1 (l2 c2) + s1 (l2 s2)\n  = l1 c1 + l2 cos(q1 - q2)"  # fmt: skip
    found = kl.diagnose("scara", "x", text)
    assert found.sentence.startswith("x: + s1 (l2 s2) should be - s1 (l2 s2)"), found


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        ("planar2r_rods", "g2", "g2 = 1.5*9.81*0.4*cos(q1+q2)", "0.4 should be 0.2"),
        ("planar3r", "g3", "g3 = 1*9.81*0.25*cos(q1+q2+q3)", "0.25 should be 0.125"),
        ("planar2r", "M22", "M22 = 1.5*0.4", "0.4 should be 0.4**2"),
        ("planar2r", "g2", "g2 = 1.5*0.4*cos(q1+q2)", "the factor 9.81 is missing in 1.5*0.4"),
        ("planar2r", "g2", "g2 = 1.5*9.81*0.4^2*cos(q1+q2)", "0.4^2 should be 0.4"),
        ("planar2r_rods", "M22", "M22 = 1.5*0.4^2/12", "12 should be 3"),
        ("planar3r", "M33", "M33 = 1*0.25^2/12", "12 should be 3"),  # a square of 1/4 is a quarter
    ],
)
def test_numbers_that_are_put_in_are_what_they_stand_for(robot, entry, text, said):
    """Any of them would do: 0.75 for 1.5, 4.905 for 9.81."""
    assert kl.diagnose(robot, entry, text).sentence.startswith(f"{entry}: {said}")


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        (
            "planar2r",
            "C12",
            "C12 = -m2*l1*l2*s2*qd1*qd2",
            "C12: qd1*qd2 should be (qd1 + qd2)",
        ),
        (
            "planar2r",
            "T",
            "T = m1*l1^2*qd1^2/2 + m2/2*(l1^2*qd1^2 + l2^2*(qd1+qd2) + 2*l1*l2*c2*qd1*(qd1+qd2))",
            "T: qd1+qd2 should be (qd1+qd2)^2 in l2^2*(qd1+qd2)",
        ),
        (
            "planar3r",
            "M12",
            "M12 = M22 + (m2/2 + m3)*l1*l2*c2 with M22 = (m2/3 + m3)*l2^2 + m3*l3^2/3"
            " + m3*l2*l3*c3",
            "M12: the term m3*l1*l3*c23/2 is missing",
        ),
        (
            "planar2r_rods",
            "M12",
            "M12 = I2 + m2*lc2^2 + 2*m2*l1*lc2*c2",
            "M12: the factor 2 does not belong in 2*m2*l1*lc2*c2",
        ),
        (
            "planar2r",
            "M11",
            "M11 = m1*l1^2 + m2*((l1 + l2*cos(q2))^2 + l2*sin(q2))",
            "M11: l2*sin(q2) should be (l2*sin(q2))^2",
        ),
        (
            "planar2r_rods",
            "y",
            "y = 0.5*sin(q1) + 0.4*(sin(q1) + sin(q2))",
            "y: sin(q1) + sin(q2) should be sin(q1 + q2)",
        ),
    ],
    ids=[
        "a product for a sum",
        "a square",
        "another entry is right",
        "a 2 too many",
        "the square of a product",
        "the sine of a sum",
    ],
)
def test_the_likelier_of_two_repairs_is_told(robot, entry, text, said):
    assert kl.diagnose(robot, entry, text).sentence.startswith(said)


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        ("planar2r_rods", "C12", "C12 = h*(qd1 + qd2), h = -m2*l1*l2*s2", "h: -m2*l1*l2*s2 should be -m2*l1*l2*s2/2"),
        ("planar2r", "M11", "M11 = a + b*c2 with a = (m1 + m2)*l1^2 + m2*l2^2, b = m2*l1*l2", "M11: b*c2 should be 2*b*c2"),
        ("planar2r", "C12", "C12 = -h*(qd1 + qd2)/2 with h = m2*l1*l2*s2", "C12: /2 does not belong in"),
        ("planar3r", "M33", "M33 = I3 + m3*lc3^2, with I3 = m3*l3^2/12 and lc3 = l3", "lc3: l3 should be l3/2"),
        ("scara", "J11", "J11 = -l1*sin(q1) - l2*sin(q1+q2) with l1 = 0.325, l2 = 0.325", "l2: 0.325 should be 0.275"),
        (
            "planar2r_rods",
            "T",
            "T = m1*l1^2*qd1^2/6 + m2*l1^2*qd1^2/2 + m2*l2^2*w^2/6 + m2*l1*l2*c2*qd1*w/2 with w = qd2",
            "w: qd2 should be qd1 + qd2",
        ),
    ],
    ids=["a half", "a 2", "a half too many", "a centre", "a number", "a rate"],
)  # fmt: skip
def test_a_name_is_put_right_where_it_is_set(robot, entry, text, said):
    """A half is lost in a definition, the 2 of a mixed term in the formula."""
    assert kl.diagnose(robot, entry, text).sentence.startswith(said)


@pytest.mark.parametrize("name", ["det J", "det(J)", "detJ", "det J(q)", "det of J", "|J|"])
def test_a_determinant_by_any_name(name):
    assert kl.diagnose("planar2r", "det", f"{name} = l1*l2*sin(q2)").agrees
    found = kl.diagnose("planar2r", "det", f"{name} = l1*l2*cos(q2)")
    assert found.sentence.startswith("det: cos(q2) should be sin(q2)")
