"""Parentheses of a formula as text that are lost, closed too early or too late, or too many."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.text.line import Line
from kinlab.formulas import tree


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
        ("scara", "g3", "", "-m3 + m4*g", "-(m3 + m4)*g", ""),
        (
            *("planar2r_rods", "g1", ""),
            r"\frac{m_1}{2}+m_2 g l_1\cos\theta_1",
            r"(\frac{m_1}{2}+m_2) g l_1 \cos\theta_1",
            r" + \frac12 m_2 g l_2\cos(\theta_1+\theta_2)",
        ),
        ("planar3r", "J23", "l3*", "cos(q1+q2)+q3", "cos(q1+q2+q3)", ""),
        ("planar3r", "x", "l1*c1 + l3*c123 + l2*", "cos(q1)+q2", "cos(q1+q2)", ""),
        ("planar3r", "M33", "", "(I_3 + m_3) l_{c3}^2", "I_3 + m_3 l_{c3}^2", ""),
        (
            *("planar2r_rods", "M11", "I1 + m1*lc1^2 + "),
            "m2*(l1^2 + lc2^2 + 2*l1*lc2*cos(q2) + I2)",
            "m2*(l1^2 + lc2^2 + 2*l1*lc2*cos(q2)) + I2",
            "",
        ),
        (
            *("planar2r", "g1", ""),
            "(m1+m2)*g*(l1*cos(q1) + m2*g*l2*cos(q1+q2))",
            "(m1+m2)*g*l1*cos(q1) + m2*g*l2*cos(q1+q2)",
            "",
        ),
    ],
    ids=[
        "in front",
        "three terms",
        "behind",
        "within",
        "sign",
        "quotient",
        "angle",
        "last angle",
        "added",
        "late",
        "around",
    ],
)
def test_parentheses_are_set_right(robot, entry, front, old, new, behind) -> None:
    assert kl.diagnose(robot, entry, front + new + behind).agrees
    (cause,) = kl.diagnose(robot, entry, front + old + behind).causes
    assert cause.kinds == ("parentheses",), cause
    assert f"{old} should be {new} " in cause.sentence


FORMULAS = [
    ("planar3r", "J11", "-2*l1*(s1 + l2*s12 - l3*s123)"),
    ("planar3r", "J11", "l2 - l1*(s1 + l2*s12 - l3*s123)/2"),
    ("planar3r", "J11", "l2*s1 - (s1 + l2*s12 - l3*s123)*l2/2"),
    ("planar3r", "J11", "-(l2*s1 + l3)*s12 - l1*s1 - l3*(s1 - l2)*s123"),
    ("planar3r", "y", "l1*sin(q1)-q2 + l2*sin(q1)+q2-q3 - l3*cos(q1+q2)-q3"),
    ("planar2r", "g1", "(m1+m2)*g*-l1*c1 + -m2*g*l2*c12"),
    (
        "planar2r_rods",
        "M11",
        r"\frac{m_1+m_2}{3} l_1^2 + \frac12 m_2 (l_1 l_2 c_2 + \frac{l_2^2}{3})",
    ),
    ("planar2r_rods", "T", "1/2*(m1+m2)*l1**2*qd1**2 + 1/2*m2*(l1**2*qd1**2 + l2**2*qd2**2)"),
    ("planar2r_rods", "tau2", "I2 + m2*lc2^2/3*(qdd1+qdd2) - m2*l1*lc2*(c2*qdd1 - s2*qd1^2 + qd2)"),
]


def test_what_is_written_is_what_was_tried(monkeypatch) -> None:
    """The sum of a slip's effects is not asked here: each text that is proposed has its value."""
    tried, edit = [], Line.edit

    def noted(self, place, value, span, kind, cost, told, pieces, everywhere=()):
        if kind == "parentheses":
            text = self.source[: span[0]] + span[2] + self.source[span[1] :]
            with np.errstate(all="ignore"):
                typed = tree.evaluate(self.meant(text), self.at)
                tried.append((text, self.climbed(place, value), np.broadcast_to(typed, self.count)))
        return edit(self, place, value, span, kind, cost, told, pieces, everywhere)

    monkeypatch.setattr(Line, "edit", noted)
    for one in FORMULAS:
        assert not kl.diagnose(*one).agrees
    for text, value, typed in tried:
        sure = np.isfinite(value) & np.isfinite(typed)
        assert sure.any(), text
        np.testing.assert_allclose(value[sure], typed[sure], rtol=1e-6, atol=1e-9, err_msg=text)
    assert len(tried) > 150


@pytest.mark.parametrize(
    ("robot", "entry", "text", "said"),
    [
        (
            "planar3r",
            "c3",
            "c3 = l1*l3*m3*qd1^2*sin(q2+q3)/2 + l2*l3*m3*qd1^2/2"
            " + l2*l3*m3*qd1*qd2*sin(q3) + l2*l3*m3*qd2^2*sin(q3)/2",
            "c3: the factor sin(q3) is missing in l2*l3*m3*qd1^2/2 ",
        ),
        (
            "planar2r_rods",
            "T",
            "T = 1/2*m1*lc1^2*qd1^2 + I1*qd1^2 + 1/2*I2*(qd1+qd2)^2"
            " + 1/2*m2*(l1^2*qd1^2 + lc2^2*(qd1+qd2)^2 + 2*l1*lc2*qd1*(qd1+qd2)*cos(q2))",
            "T: I1*qd1^2 should be I1*qd1^2/2 ",
        ),
        (
            "planar3r",
            "c3",
            "c3 = 2.*(l3.*m3.*(l1.*qd(1).^2.*sin(q(2) + q(3))/2 + l2.*(qd(1)+qd(2)).^2.*sin(q(3))/2))",
            "c3: the factor 2. does not belong ",
        ),
        ("planar2r", "g1", "g1 = m1 + m2*g*l1*c1 + m2*g*l2*c12", "g1: m1 + m2*g*l1*c1 should be ("),
    ],
    ids=["sine", "half", "too many", "parentheses"],
)
def test_one_factor_alone_is_rather_missing_in_the_other_term(robot, entry, text, said):
    """And a 2 in front of halves of lengths does not belong: no length is its centre's."""
    found = kl.diagnose(robot, entry, text)
    assert found.sentence.startswith(said), found
