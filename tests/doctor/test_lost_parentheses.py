"""Parentheses that are lost around a part of several terms of a formula as text."""

from __future__ import annotations

import pytest

import kinlab as kl


@pytest.mark.parametrize(
    ("robot", "entry", "front", "old", "new", "behind"),
    [
        ("planar2r", "g1", "", "m1 + m2*g*l1*c1", "(m1 + m2)*g*l1*c1", " + m2*g*l2*c12"),
        (
            *("planar2r_rods", "M11", "I1 + I2 + m1*lc1^2 + "),
            "m2*l1^2 + lc2^2 + 2*l1*lc2*cos(q2)",
            "m2*(l1^2 + lc2^2 + 2*l1*lc2*cos(q2))",
            "",
        ),
        (
            *("planar2r_rods", "tau2", "m2*l1*lc2*cos(q2)*qdd1 + m2*l1*lc2*sin(q2)*qd1^2 + "),
            "I2 + m2*lc2^2*(qdd1+qdd2)",
            "(I2+m2*lc2^2)*(qdd1+qdd2)",
            " + m2*g*lc2*cos(q1+q2)",
        ),
        (
            *("single_link", "T", ""),
            r"\frac{1}{2} I_1 + m_1 l_{c1}^2\dot q_1^2",
            r"\frac{1}{2} (I_1 + m_1 l_{c1}^2) \dot q_1^2",
            "",
        ),
    ],
    ids=["in front", "three terms", "behind", "within"],
)
def test_parentheses_around_a_part_of_several_terms(robot, entry, front, old, new, behind) -> None:
    assert kl.diagnose(robot, entry, front + new + behind).agrees
    (cause,) = kl.diagnose(robot, entry, front + old + behind).causes
    assert cause.kinds == ("parentheses",), cause
    assert f"{old} should be {new} " in cause.sentence
