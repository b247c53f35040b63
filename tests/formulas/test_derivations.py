"""Texts of several steps, of which the entry's own equations are judged."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError

LAGRANGE = """T = 1/2 m1 lc1² q̇1² + 1/2 I1 q̇1²
V = m1 g lc1 sin q1
d/dt(∂T/∂q̇1) = (m1 lc1² + I1) q̈1
∂V/∂q1 = m1 g lc1 cos q1
thus τ1 = d/dt(∂T/∂q̇1) + ∂V/∂q1 = (m1 lc1² + I1) q̈1 + m1 g lc1 cos q1"""
ALIGNED = r"""\begin{align*}
x_2 &= l_1 c_1 + l_{c2} c_{12}, & \dot{x}_2 &= -l_1 s_1 \dot\theta_1 - l_{c2} s_{12}(\dot\theta_1+\dot\theta_2) \\
y_2 &= l_1 s_1 + l_{c2} s_{12}, & \dot{y}_2 &= l_1 c_1 \dot\theta_1 + l_{c2} c_{12}(\dot\theta_1+\dot\theta_2) \\
M_{22} &= m_2 l_{c2}^2 + I_2 \\
M_{12} &= M_{22} + m_2 l_1 l_{c2} c_2
\end{align*}"""
MOMENTA = r"""Momentum first:
\begin{align*}
\dot p_1 &= M_{11}\ddot\theta_1 + M_{12}\ddot\theta_2 - \mu s_2(2\dot\theta_1\dot\theta_2 + \dot\theta_2^2) \\
\frac{\partial L}{\partial\theta_1} &= -(m_1+m_2)gl_1c_1 - m_2gl_2c_{12} \\
\tau_1 &= M_{11}\ddot\theta_1 + M_{12}\ddot\theta_2 - \mu s_2(2\dot\theta_1\dot\theta_2 + \dot\theta_2^2) + (m_1+m_2)gl_1c_1 + m_2gl_2c_{12}
\end{align*}
Here $\mu = m_2l_1l_2$, $M_{11} = (m_1+m_2)l_1^2 + m_2l_2^2 + 2\mu c_2$ and $M_{12} = m_2l_2^2 + \mu c_2$."""
SHORTHAND = """px = l1*cos(q1) + l2*cos(q1+q2)
k = l2*sin(q1+q2)
dpx/dq2 = -k
J11 = -l1*sin(q1) - k"""


@pytest.mark.parametrize(
    ("robot", "entry", "text", "right", "slip", "said"),
    [
        ("single_link", "tau1", LAGRANGE, "+ m1 g lc1 cos q1", "- m1 g lc1 cos q1", "should be + m1 g lc1 cos q1"),
        ("planar2r_rods", "M12", ALIGNED, "l_{c2} c_2", "l_{c2} s_2", "s_2 should be c_2"),
        ("planar2r_rods", "M12", ALIGNED, r"M_{22} &= m_2 l_{c2}^2", r"M_{22} &= m_2 l_2^2", "l_2 should be l_{c2}"),
        ("planar2r", "tau1", MOMENTA, "m_2l_2^2 + \\mu c_2", "m_2l_2^2 + 2\\mu c_2", "the factor 2 does not belong in 2\\mu c_2"),
        ("planar2r", "J11", SHORTHAND, "-l1*sin(q1) - k", "l1*sin(q1) - k", "l1*sin(q1) should be -l1*sin(q1)"),
    ],
)  # fmt: skip
def test_the_end_of_a_derivation_is_judged(robot, entry, text, right, slip, said) -> None:
    found = kl.diagnose(robot, entry, text)
    assert found.agrees
    head, mark, tail = text.rpartition(right)
    assert mark
    wrong = kl.diagnose(robot, entry, head + slip + tail)
    assert not wrong.agrees
    assert said in wrong.causes[0].sentence


def test_that_other_steps_are_not_judged_is_said() -> None:
    found = kl.diagnose("single_link", "tau1", LAGRANGE)
    assert any("no other step" in remark for remark in found.remarks)


@pytest.mark.parametrize(
    "text",
    [
        LAGRANGE + "\nThis is wrong.",
        LAGRANGE.replace("V = ", "For q1 = 0:\nV = ").replace("cos q1", "1"),
        LAGRANGE.replace("τ1 = d", "τ2 = d"),
        LAGRANGE.rpartition("thus")[0],
        LAGRANGE + " = τ2",
    ],
    ids=["denied", "state", "other", "none", "end"],
)
def test_what_means_something_else_is_not_judged(text) -> None:
    with pytest.raises(ExpressionError):
        kl.diagnose("single_link", "tau1", text)


def test_each_equation_of_the_entry_counts() -> None:
    """The one before the last, too: of two that differ one is told."""
    twice = LAGRANGE.replace("thus", "τ1 = (m1 lc1² + 2 I1) q̈1 + m1 g lc1 cos q1\nthus")
    found = kl.diagnose("single_link", "tau1", twice)
    assert not found.agrees


def test_the_torque_of_the_only_joint_needs_no_number() -> None:
    text = (
        r"L = T - V = \frac{1}{6} m l^2 \dot\theta^2 - \frac{1}{2} m g l \sin\theta"
        "\n"
        r"\frac{d}{dt}\frac{\partial L}{\partial\dot\theta} = \frac{1}{3} m l^2\ddot\theta"
        "\n"
        r"\tau = \frac{1}{3} m l^2\ddot\theta + \frac{1}{2} m g l\cos\theta"
    )
    assert kl.diagnose("single_link", "tau1", text).agrees
    wrong = text.replace(r"+ \frac{1}{2} m g l\cos", r"- \frac{1}{2} m g l\cos")
    (cause,) = kl.diagnose("single_link", "tau1", wrong).causes
    assert cause.kinds == ("sign",)
