"""Equations that give an entry otherwise than by its name alone; asked of the engine's own values."""

from __future__ import annotations

import pytest

import kinlab as kl

TAU2 = "l2^2*(qdd1 + qdd2) + l1*l2*c2*qdd1 + l1*l2*s2*qd1^2 + g*l2*c12"
LATEX = r"l_2^2(\ddot q_1+\ddot q_2) + l_1 l_2 c_2 \ddot q_1 + l_1 l_2 s_2\dot q_1^2 + g l_2 c_{12}"
RIGHT = [
    ("planar2r", "tau2", f"tau2/m2 = {TAU2}"),
    ("planar2r", "tau2", rf"\tau_2/m_2 = {LATEX}"),
    ("planar2r", "tau2", rf"\frac{{\tau_2}}{{m_2}} = {LATEX}"),
    ("planar2r", "tau2", rf"m_2({LATEX}) - \tau_2 = 0"),
    ("planar2r", "M12", "M_{12}/l_2 = m_2 l_2 + m_2 l_1 c_2"),
    ("planar2r", "M12", "-M12 = -m2*l2^2 - m2*l1*l2*c2"),
    ("planar2r", "g2", "g2/9.81 = 0.6*c12"),
    ("planar2r", "g1", "g1/g = (m1 + m2)*l1*c1 + m2*l2*c12"),
    ("planar2r", "V", "V/g = (m1 + m2)*l1*s1 + m2*l2*s12"),
    ("planar2r", "T", "2T = (m1 + m2)*l1^2*qd1^2 + m2*l2^2*(qd1 + qd2)^2 + 2*m2*l1*l2*c2*qd1*(qd1 + qd2)"),
    ("planar2r", "x", "-x = -l1*c1 - l2*c12"),
    ("planar2r", "x", "x - l1*c1 = l2*c12"),
    ("planar2r", "x", "0 = l1*c1 + l2*c12 - x"),
    ("planar2r", "x", "x/l1 = c1 + l2/l1*c12"),
    ("single_link", "tau1", r"\frac13 m l^2 \ddot q = \tau - \frac12 m g l \cos q"),
    ("isotropic", "thetad1", "l1*k*thetad1 = vx*w1x + vy*w1y, k = u1x*w1y - u1y*w1x"),
]  # fmt: skip


@pytest.mark.parametrize(("robot", "entry", "text"), RIGHT)
def test_an_equation_is_solved_for_the_entry(robot: str, entry: str, text: str) -> None:
    assert kl.diagnose(robot, entry, text).agrees


@pytest.mark.parametrize(
    ("entry", "text", "shown"),
    [
        ("tau2", f"tau2/m2 = {TAU2}".replace("+ l1*l2*s2", "- l1*l2*s2"), f"m2*({TAU2})"),
        ("g2", "g_2/g = m_2 l_1 c_{12}", r"g \left(m_2 l_2 c_{12}\right)"),
        ("x", "x - l1*c1 = l2*s12", "l2*c12 + l1*c1"),
        ("x", "-x = -l1*c1 + l2*c12", "-(-l1*c1 - l2*c12)"),
    ],
)
def test_a_slip_in_such_an_equation_is_told_as_it_was_typed(entry, text, shown) -> None:
    found = kl.diagnose("planar2r", entry, text)
    assert not found.agrees and found.causes[0].shown == {entry: shown}, str(found)


@pytest.mark.parametrize(
    ("entry", "text", "said"),
    [
        ("x", "x^2 = l1*c1", "nowhere else"),
        ("x", "x*c1 = x + l1*c1", "nowhere else"),
        ("M12", "M11/2 = m2*l2^2", "which is another"),
        ("x", "2*y = l1*c1", "which is another"),
    ],
)
def test_an_equation_that_gives_no_entry_is_refused(entry: str, text: str, said: str) -> None:
    with pytest.raises(kl.errors.ExpressionError, match=said):
        kl.diagnose("planar2r", entry, text)
