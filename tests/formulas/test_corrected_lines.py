r"""Random slips in typed lines: what comes back is typed alike, reads again, and is the engine's."""

from __future__ import annotations

import random
import re

import pytest

import kinlab as kl
from kinlab.doctor.report import of_document

LINES = [
    ("planar2r_rods", "M11", "latex", r"\frac{m_1 l_1^2}{3} + m_2\left(l_1^2 + \frac{l_2^2}{3} + l_1 l_2 c_2\right)"),
    ("planar2r_rods", "M12", "latex", r"m_2 \left( \frac{l_2^2}{3} + \frac{l_1 l_2}{2} \cos \theta_2 \right)"),
    ("planar2r_rods", "g1", "latex", r"\left(\frac{m_1}{2} + m_2\right) g l_1 c_1 + \frac{1}{2} m_2 g l_2 c_{12}"),
    ("planar2r_rods", "V", "latex", r"g\left(\frac{m_1 l_1}{2}\sin\theta_1 + m_2\left(l_1\sin\theta_1 + \frac{l_2}{2}\sin(\theta_1+\theta_2)\right)\right)"),
    ("planar3r", "g2", "latex", r"m_2 g \frac{l_2}{2} \cos(\theta_1+\theta_2) + m_3 g \left(l_2 \cos(\theta_1+\theta_2) + \frac{l_3}{2} \cos(\theta_1+\theta_2+\theta_3)\right)"),
    ("planar2r", "T", "latex", r"\frac{1}{2}\left(m_1+m_2\right) l_1^2\dot{q}_1^2 + \frac{m_2}{2} l_2^2(\dot q_1+\dot q_2)^2 + m_2 l_1 l_2\dot q_1\left(\dot q_1+\dot q_2\right)\cos q_2"),
    ("planar2r", "tau1", "latex", r"\left[(m_1+m_2) l_1^2 + m_2 l_2^2 + 2 m_2 l_1 l_2 c_2\right]\ddot{\theta}_1 + m_2 l_2\left(l_2 + l_1 c_2\right)\ddot{\theta}_2 - m_2 l_1 l_2 s_2\left(2\dot{\theta}_1\dot{\theta}_2 + \dot{\theta}_2^2\right) + (m_1+m_2) g l_1 c_1 + m_2 g l_2 c_{12}"),
    ("planar2r", "g1", "matlab", "(m1 + m2)*g*l1*cos(q(1)) + m2*g*l2*cos(q(1)+q(2))"),
    ("planar3r", "y", "matlab", "l1*sin(q(1)) + l2*sin(q(1)+q(2)) + l3*sin(q(1)+q(2)+q(3))"),
    ("planar2r", "T", "matlab", "0.5*(m1+m2)*l1^2*dq(1).^2 + 0.5*m2*l2^2*(dq(1)+dq(2)).^2 + m2*l1*l2*cos(q(2)).*dq(1).*(dq(1)+dq(2))"),
    ("planar2r", "x", "python", "l1*np.cos(q[0]) + l2*np.cos(q[0] + q[1])"),
    ("planar2r_rods", "tau2", "python", "m2*l2**2/3*(ddth1 + ddth2) + m2*l1*l2/2*(cos(th2)*ddth1 + sin(th2)*dth1**2) + m2*g*l2/2*cos(th1 + th2)"),
    ("planar2r", "V", "python", "(m1 + m2)*g*l1*np.sin(q[0]) + m2*g*l2*np.sin(q[0] + q[1])"),
]  # fmt: skip
SLIPS = [
    (r"(?<=[\w)}\]] )\+(?= )", "-"),
    (r"sin", "cos"),
    (r"cos(?!h)", "sin"),
    (r"(?:\*\*|\.?\^)2", ""),
    (r"\\frac\{([^{}]{2,})\}\{\d\}", r"\1"),
    (r"\\frac\{1\}\{\d\} ?", ""),
    (r"\{3\}", "{12}"),
    (r"/[23]", ""),
    (r"(?<=[ (\[])2[ *](?=m)|0\.5\*", ""),
    (r"([lm])(_?)1(?!\d)", r"\g<1>\g<2>2"),
    (r"([lm])(_?)2(?!\d)", r"\g<1>\g<2>1"),
    (r"g[ *](?=l)|m_2 (?=g)|l_1 (?=l)|l\d\*(?=[sc])", ""),
    (r"c_\{12\}", "c_2"),
    (r"\\theta_1\+(\\theta_2)", r"\1"),
    (r"(?:q\(1\)\+|th1 \+ |q\[0\] \+ )(?=q|th)", ""),
    (r"\\ddot", r"\\dot"),
    (r"ddth", "dth"),
]
_FOREIGN = {
    "latex": r"\*|(?<![\\\w{])[lm]\d|(?<![\\a-z])(?:sin|cos)",
    "matlab": r"\*\*|\[|\bd*q\d",
    "python": r"\^|\bq\d|(?<=np)(?!\.)",
}
"""What a writer of the one notation would never type."""


def with_slips(rng: random.Random, text: str) -> str:
    """The line with one slip of what is typed, or two."""
    for _ in range(rng.choice((1, 1, 2))):
        pattern, new = rng.choice([s for s in SLIPS if re.search(s[0], text)])
        found = rng.choice(list(re.finditer(pattern, text)))
        text = text[: found.start()] + found.expand(new) + text[found.end() :]
    return text


def judged(robot: str, entry: str, style: str, text: str):
    table = "latex" if style == "latex" else "formulas"
    found, unread = of_document({"robot": robot, table: {entry: text}}, "f.toml", 30)
    assert not unread, (text, unread)
    return found[0]


def refused(style: str, right: str, wrong: str, line: str) -> list[str]:
    """What makes a corrected line unlike the one that was typed."""
    odd = [two for two in ("--", "-(-", "*1*", "+ -", "  ", " *")
           if line.count(two) > max(right.count(two), wrong.count(two))]  # fmt: skip
    odd += [a for a, b in ("()", "[]", "{}") if line.count(a) != line.count(b)]
    odd += ["left"] * (line.count(r"\left") != wrong.count(r"\left"))
    odd += re.findall(r"\(\([^()]*\)(?:\^|\*\*)2\)", line)
    odd += ["right"] * (line.count(r"\left") != line.count(r"\right"))
    return odd + re.findall(_FOREIGN[style], line)


def corrected_lines(seed: int, count: int) -> list[str]:
    """What is wrong with the corrected lines of so many random slips; how many there were."""
    rng, bad, told = random.Random(seed), [], 0
    while told < count:
        robot, entry, style, right = rng.choice(LINES)
        wrong = with_slips(rng, right)
        found = judged(robot, entry, style, wrong)
        if found.agrees:
            continue  # two slips that undo each other
        if not found.causes or not found.causes[0].shown:
            continue  # silence is allowed
        told += 1
        line = found.causes[0].shown[entry]
        odd = refused(style, right, wrong, line)
        if not judged(robot, entry, style, line).agrees:
            odd.append("differs")
        bad += [f"{odd}: {wrong}  ->  {line}"] if odd else []
    return bad


def test_corrected_lines_are_the_writers_and_right():
    assert corrected_lines(3, 15) == []


@pytest.mark.campaign
def test_three_hundred_corrected_lines():
    assert corrected_lines(41, 300) == []


@pytest.mark.parametrize(
    ("robot", "entry", "typed", "correct", "said"),
    [
        ("spatial3r", "fk[1,3]", "l_1 s_1 + l_2 s_{12} + l_3 c_{12} s_3", "l_1 s_1 + l_2 s_{12} + l_3 s_{12} c_3", "s_3 should be c_3"),
        ("single_link", "inverse_dynamics[0]", r"\frac13 m l^2\ddot\theta + \frac12 m g l\sin\theta", r"\frac13 m l^2\ddot\theta + \frac12 m g l\cos\theta", r"\sin\theta should be \cos\theta"),
        ("single_link", "inverse_dynamics[0]", r"(I + m l_c^2)\ddot\theta + m g l\cos\theta, where $l_c = l/2$ and $I=\frac{1}{12}ml^2$", r"(I + m l_c^2)\ddot\theta + m g l_c\cos\theta", "l should be l_c"),
        ("single_link", "inverse_dynamics[0]", r"I\ddot\theta + m g l\cos\theta, where $I=\frac13 ml^2$", r"I\ddot\theta + \frac{1}{2} m g l\cos\theta", "(factor)"),
        ("planar2r_rods", "christoffel[0,0,1]", "-2*m2*l1*lc2*sin(q2)", "-m2*l1*lc2*sin(q2)", "the factor 2 does not belong"),
        ("planar2r_rods", "gravity_torques[0]", r"(m_1 l_1 + m_2 l_1) g \cos q_1 + m_2 g l_2 \cos(q_1+q_2)", r"(m_1 l_{c1} + m_2 l_1) g \cos q_1 + m_2 g l_{c2} \cos(q_1+q_2)", "far end"),
        ("planar2r_rods", "lagrangian", r"\frac{1}{6}m_1 l_1^2\dot q_1^2 + \frac12 m_2(l_1^2\dot q_1^2 + \frac{1}{3} l_2^2(\dot q_1+\dot q_2)^2 + l_1 l_2\cos q_2\,\dot q_1(\dot q_1+\dot q_2)) - \frac12 m_1 g l_1\sin q_1 - m_2 g(l_1\sin q_1 + l_2\sin(q_1+q_2))", r"\frac{1}{6}m_1 l_1^2\dot q_1^2 + \frac12 m_2(l_1^2\dot q_1^2 + \frac{1}{3} l_2^2(\dot q_1+\dot q_2)^2 + l_1 l_2\cos q_2\,\dot q_1(\dot q_1+\dot q_2)) - \frac12 m_1 g l_1\sin q_1 - m_2 g(l_1\sin q_1 + \frac{1}{2} l_2\sin(q_1+q_2))", "(factor)"),
    ],
)  # fmt: skip
def test_a_line_keeps_its_writer_s_names(robot, entry, typed, correct, said):
    found = kl.diagnose(robot, entry, typed)
    (shown,) = found.causes[0].shown.values()
    assert re.sub(r"\s", "", shown) == re.sub(r"\s", "", correct)
    assert said in found.causes[0].sentence


@pytest.mark.parametrize(
    ("behind", "told", "corrected"),
    [
        ("+ -m2*l1*l2*s2*qd1^2", "-m2*l1*l2*s2*qd1^2 should be m2*l1*l2*s2*qd1^2", "+ m2*l1*l2*s2"),
        ("+ (-m2*l1*l2*s2*qd1^2)", "(-m2*l1*l2*s2*qd1^2) should be (m2*", "+ (m2*l1*l2*s2*qd1^2)"),
    ],
)
def test_a_sign_in_front_of_a_sign_is_no_second_one(behind, told, corrected):
    """It was "+ -a should be - -a"."""
    text = f"m2*l2^2*(qdd1+qdd2) + m2*l1*l2*c2*qdd1 {behind} + m2*g*l2*c12"
    found = kl.diagnose("planar2r", "tau2", text)
    assert told in found.sentence, found
    assert corrected in found.causes[0].typed["tau2"], found.causes[0].typed
