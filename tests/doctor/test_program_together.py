"""Slips that move more than one place of a program, what tells two repairs apart, and rounded
numbers: each sentence is held against the right program, or against the line that was spoilt."""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import repaired

import kinlab as kl
from kinlab.doctor.examine import prepare

PLANAR = """
import numpy as np

l1, l2 = 0.5, 0.4

def f(q):
    t1, t12 = q[0], q[0] + q[1]
    x = l1*np.cos(t1) + l2*np.cos(t12)
    y = l1*np.sin(t1) + l2*np.sin(t12)
    c, s = np.cos(t12), np.sin(t12)
    return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])
"""
CHAIN = """
import numpy as np

DH = [[0, np.pi/2, 0], [0.4318, 0, 0], [0.0203, -np.pi/2, 0.15005],
      [0, np.pi/2, 0.4318], [0, -np.pi/2, 0], [0, 0, 0]]

def step(row, angle):
    a, alpha, d = row
    ct, st, ca, sa = np.cos(angle), np.sin(angle), np.cos(alpha), np.sin(alpha)
    return np.array([[ct, -st*ca, st*sa, a*ct], [st, ct*ca, -ct*sa, a*st],
                     [0, sa, ca, d], [0, 0, 0, 1]])

def f(q):
    T = np.eye(4)
    for row, angle in zip(DH, q):
        A = step(row, angle)
        T = T @ A
    return T
"""
OBJECTS = """
import numpy as np

class Link:
    def __init__(self, length, centre):
        self.length, self.centre = length, centre
    def end(self, angle):
        return np.array([self.length*np.cos(angle), self.length*np.sin(angle)])

links = [Link(0.5, 0.25), Link(0.4, 0.2)]

def f(q):
    total, place = 0.0, np.zeros(2)
    for link, turn in zip(links, q):
        total = total + turn
        place = place + link.end(total)
    c, s = np.cos(total), np.sin(total)
    return np.array([[c, -s, 0, place[0]], [s, c, 0, place[1]], [0, 0, 1, 0], [0, 0, 0, 1]])
"""
TORQUES = """
import numpy as np

m1, m2, l1, l2, g = 2.0, 1.5, 0.5, 0.4, 9.81

def f(q, v, a):
    c1, c12 = np.cos(q[0]), np.cos(q[0] + q[1])
    c2, s2 = np.cos(q[1]), np.sin(q[1])
    g2 = m2*l2*g*c12
    g1 = (m1 + m2)*l1*g*c1 + g2
    h = m2*l1*l2*s2
    m12 = m2*l2**2 + m2*l1*l2*c2
    t1 = (m1*l1**2 + m2*(l1**2 + l2**2 + 2*l1*l2*c2))*a[0] + m12*a[1] \\
        - h*(2*v[0]*v[1] + v[1]**2) + g1
    t2 = m12*a[0] + m2*l2**2*a[1] + h*v[0]**2 + g2
    return np.array([t1, t2])
"""
ASKED = {
    PLANAR: ("planar2r", "fk"),
    CHAIN: ("puma560", "fk"),
    OBJECTS: ("planar2r", "fk"),
    TORQUES: ("planar2r", "inverse_dynamics"),
}


def loaded(text):
    space = {"__name__": "hand"}
    exec(compile(text, "<hand>", "exec"), space)  # noqa: S102  texts of this file
    return space["f"]


def examined(text, right):
    return kl.diagnose(*ASKED[right], loaded(text), samples=20)


def answers(function, right):
    case, _engine = prepare(*ASKED[right], (), 10, 5)
    stacks = case.arguments.values()
    return np.array([function(*map(np.copy, state)) for state in zip(*stacks, strict=True)])


@pytest.mark.parametrize("right", ASKED, ids=["planar", "chain", "objects", "torques"])
def test_the_programs_are_right(right) -> None:
    assert examined(right, right).agrees


SLIPS = [
    (PLANAR, "x = l1*np.cos(t1) + l2*", "x = l2*np.cos(t1) + l1*"),
    (PLANAR, "t1, t12 = q[0]", "t12, t1 = q[0]"),
    (PLANAR, "y = l1*np.sin(t1) + l2*np.sin(t12)", "y = l1*np.cos(t1) + l2*np.cos(t12)"),
    (CHAIN, "a, alpha, d = row", "a, d, alpha = row"),
    (OBJECTS, "self.length*np.sin", "self.centre*np.sin"),
    (OBJECTS, "Link(0.4, 0.2)", "Link(0.45, 0.2)"),
    (TORQUES, "m2*(l1**2 + l2**2 + 2*l1*l2*c2)", "m2*l1**2 + l2**2 + 2*l1*l2*c2"),
    (TORQUES, "h = m2*l1*l2*s2", "h = m2*l2*s2"),
    (TORQUES, "+ 2*l1*l2*c2", "+ l1*l2*c2"),
    (TORQUES, "g2 = m2*l2*g*c12", "g2 = m2*l2*c12"),
]


@pytest.mark.many
@pytest.mark.parametrize(("right", "piece", "slip"), SLIPS)
def test_the_line_is_put_right(right, piece, slip) -> None:
    assert right.count(piece) == 1
    text = right.replace(piece, slip)
    found = examined(text, right)
    assert not found.agrees
    sentence = found.causes[0].sentence
    wanted = answers(loaded(right), right)
    if "links[1].length" in sentence:
        assert "0.45 should be 0.4" in sentence
        return
    spoilt = text[: text.index(slip)].count("\n") + 1
    assert f"line {spoilt} " in sentence + " " or f"line {spoilt}," in sentence
    repairs = [answers(space["f"], right) for space in repaired(text, sentence)]
    assert any(np.allclose(one, wanted, rtol=1e-9, atol=1e-9) for one in repairs)
    if slip == "h = m2*l2*s2":
        assert "l1" in sentence  # which is 0.5: a half is no repair of the larger arm
    if slip == "+ l1*l2*c2":
        assert "2*" in sentence  # which is m1: and m1 is none either


@pytest.mark.parametrize(
    ("right", "piece", "slip", "line", "words"),
    [
        (CHAIN, "    return T\n", "        return T\n", 18, "belongs behind it"),
        (CHAIN, "        T = T @ A\n", "        T = T @ A\n        T = T @ A\n", 18, "one too many"),
        (CHAIN, "        T = T @ A\n", "    T = T @ A\n", 17, "belongs in it"),
        (CHAIN, "        T = T @ A\n", "", 16, "`T = T @ A`"),
    ],
)  # fmt: skip
def test_a_line_in_another_place(right, piece, slip, line, words) -> None:
    assert right.count(piece) == 1
    sentence = examined(right.replace(piece, slip), right).causes[0].sentence
    assert words in sentence
    assert f"line {line}" in sentence


@pytest.mark.parametrize(
    ("piece", "slip", "said"),
    [
        ("[0.0203, -np.pi/2, 0.15005]", "[0.15005, -np.pi/2, 0.0203]", "DH[2], two entries"),
        ("[0.4318, 0, 0], [0.0203, -np.pi/2, 0.15005]",
         "[0.0203, -np.pi/2, 0.15005], [0.4318, 0, 0]", "two rows are exchanged: `[1]` and `[2]`"),
    ],
)  # fmt: skip
def test_numbers_of_a_table_exchanged(piece, slip, said) -> None:
    assert CHAIN.count(piece) == 1
    assert said in examined(CHAIN.replace(piece, slip), CHAIN).causes[0].sentence


def test_the_line_within_a_long_sum() -> None:
    text = TORQUES.replace("        - h*(2*v[0]", "        + h*(2*v[0]")
    line = text[: text.index("        + h*(2")].count("\n") + 1
    assert f"line {line}," in examined(text, TORQUES).causes[0].sentence


RODS = """
import numpy as np

def f(q, v, tau):
    c, s = np.cos(q[1]), np.sin(q[1])
    M = np.array([[{first} + 0.3*c, 0.08 + 0.15*c], [0.08 + 0.15*c, 0.08]])
    g2 = 2.943*np.cos(q[0] + q[1])
    h = np.array([-0.15*s*(2*v[0]*v[1] + v[1]**2) + {weight}*np.cos(q[0]) + g2,
                  0.15*s*v[0]**2 + g2])
    return np.linalg.solve(M, tau - h)
"""


@pytest.mark.parametrize(
    ("first", "weight", "right"),
    [("0.6217", "12.26", True), ("0.622", "12.26", True), ("0.6227", "12.26", False)],
)
def test_rounded_numbers_are_right_to_their_digits(first, weight, right) -> None:
    # m1 l1^2/3 + m2 (l1^2 + l2^2/3) = 0.621667, (m1 l1/2 + m2 l1) g = 12.2625
    function = loaded(RODS.format(first=first, weight=weight))
    found = kl.diagnose("planar2r_rods", "forward_dynamics", function, samples=20)
    assert found.agrees == right
    if right:
        assert found.form == "rounded"
        assert any("0.6216667" in one for one in found.remarks)
