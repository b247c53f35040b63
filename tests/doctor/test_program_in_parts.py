"""Slips that are found in one part of an answer, or in one statement; and what single slips are of
dictionaries, of transforms that are missing, of names that are set and used nowhere.

Every program is right before its slips, which its verdict tells first; what is said makes it right.
"""

from __future__ import annotations

import pytest
from hand_programs import BACK, lines_named, repaired, with_slips, written

import kinlab as kl

TABLE = """
from math import cos, sin

ARM = [{"m": 3.0, "l": 0.5, "c": 0.25}, {"m": 2.0, "l": 0.4, "c": 0.2},
       {"m": 1.0, "l": 0.25, "c": 0.125}]
for one in ARM:
    one["J"] = one["m"]*one["l"]**2/12

def crossed(a, b):
    return a[0]*b[1] - a[1]*b[0]

def f(q, v, a):
    turn = rate = more = 0.0
    acc = [0.0, 9.81]
    kept = []
    for k, one in enumerate(ARM):
        turn += q[k]
        rate += v[k]
        more += a[k]
        e, n = [cos(turn), sin(turn)], [-sin(turn), cos(turn)]
        own = [acc[i] + more*one["c"]*n[i] - rate**2*one["c"]*e[i] for i in range(2)]
        kept.append({
            "F": [one["m"]*own[0], one["m"]*own[1]],
            "N": one["J"]*more,
            "at": [one["c"]*e[0], one["c"]*e[1]],
            "end": [one["l"]*e[0], one["l"]*e[1]],
        })
        acc = [acc[i] + more*one["l"]*n[i] - rate**2*one["l"]*e[i] for i in range(2)]
    push, turning, tau = [0.0, 0.0], 0.0, [0.0, 0.0, 0.0]
    for k in (2, 1, 0):
        s = kept[k]
        turning = turning + s["N"] + crossed(s["at"], s["F"]) + crossed(s["end"], push)
        push = [push[0] + s["F"][0], push[1] + s["F"][1]]
        tau[k] = turning
    return tau
"""
CHAIN = """
import numpy as np
from numpy import cos, sin, pi

def Rz(t):
    return np.array([[cos(t), -sin(t), 0, 0], [sin(t), cos(t), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])

def Rx(t):
    return np.array([[1, 0, 0, 0], [0, cos(t), -sin(t), 0], [0, sin(t), cos(t), 0], [0, 0, 0, 1.0]])

def D(x, y, z):
    T = np.eye(4)
    T[:3, 3] = [x, y, z]
    return T

def f(q):
    A1 = Rz(q[0]) @ D(0, 0, 0.412) @ Rx(-pi/2)
    A2 = Rz(q[1]) @ D(0, 0, 0.154) @ Rx(pi/2)
    A3 = Rz(-pi/2) @ D(0.0203, 0, q[2])
    A4 = Rz(q[3]) @ Rx(-pi/2)
    A5 = Rz(q[4]) @ Rx(pi/2)
    A6 = Rz(q[5]) @ D(0, 0, 0.263)
    return A1 @ A2 @ A3 @ A4 @ A5 @ A6
"""
CORNER = """
import numpy as np

a1, a2, a3 = 0.45, 0.35, 0.30

def plane(x, y, b):
    far = np.hypot(x, y)
    if abs(a1**2 + far**2 - b**2) > 2*a1*far:
        return []
    off = np.arccos((a1**2 + far**2 - b**2)/(2*a1*far))
    out = []
    for s in (1, -1):
        one = np.arctan2(y, x) - s*off
        ex, ey = x - a1*np.cos(one), y - a1*np.sin(one)
        if b < 0:
            ex, ey = -ex, -ey
        out.append((one, np.arctan2(ey, ex) - one))
    return out

def f(x, y, z):
    up = z/a3
    out = []
    for c in (np.sqrt(1 - up**2), -np.sqrt(1 - up**2)):
        for one, two in plane(x, y, a2 + a3*c):
            out.append([one, two, np.arctan2(up, c)])
    return np.array(out)
"""
RIGHT = {
    "table": (TABLE, "planar3r", "inverse_dynamics"),
    "back": (BACK, "spatial3r", "statics"),
    "chain": (CHAIN, "stanford", "fk"),
    "corner": (CORNER, "spatial3r", "inverse_kinematics_xyz"),
}


def told(text: str, robot: str, quantity: str) -> str:
    """What is said of a wrong program; what is said makes it right."""
    found = kl.diagnose(robot, quantity, written(text))
    assert not found.agrees
    assert found.causes, str(found)
    said = found.causes[0].sentence
    every = [after["f"] for after in repaired(text, said)]
    assert any(kl.compare(robot, quantity, f).agrees for f in every), said
    return said


@pytest.mark.parametrize("name", RIGHT)
def test_the_programs_are_right(name) -> None:
    text, robot, quantity = RIGHT[name]
    assert kl.compare(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips", "line"),
    [
        pytest.param("table", [('crossed(s["end"], push)', 'crossed(s["at"], push)')],
                     'crossed(s["end"], push)', id="a key that is used nowhere else"),
        pytest.param("table", [('[push[0] + s["F"][0]', '[s["F"][0]')],
                     'push[0] + s["F"][0]', id="an entry as the other one is"),
        pytest.param("back", [("np.cross(P2, f1)", "np.cross(P3, f1)")],
                     "np.cross(P2, f1)", id="a name that a call sets and nothing uses"),
        pytest.param("chain", [("A6 = Rz(q[5]) @ D(0, 0, 0.263)", "A6 = Rz(q[5])")],
                     "Rz(q[5]) @ D(0, 0, 0.263)", id="a transform of a length that is nowhere"),
        pytest.param("chain", [("A3 = Rz(-pi/2) @ D(", "A3 = D(")],
                     "Rz(-np.pi/2) @ D(", id="a turn of the table's that does not move"),
        pytest.param("corner", [("np.arctan2(up, c)", "np.arcsin(up)")],
                     "np.arctan2(up, c)", id="the quadrant"),
    ],
)  # fmt: skip
def test_one_slip(name, slips, line) -> None:
    text, robot, quantity = RIGHT[name]
    said = told(with_slips(text, slips), robot, quantity)
    assert line.replace(" ", "") in said.replace("'", '"').replace(" ", ""), said


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips"),
    [
        pytest.param("table", [("rate += v[k]", "rate = v[k]"),
                               ('one["J"]*more', 'one["J"]*a[k]'),
                               ('"at": [one["c"]*e[0], one["c"]*e[1]]',
                                '"at": [one["l"]*e[0], one["l"]*e[1]]')],
                     id="at rest, with accelerations alone, with speeds"),
        pytest.param("chain", [("A6 = Rz(q[5]) @ D(0, 0, 0.263)", "A6 = Rz(q[5])"),
                               ("D(0.0203, 0, q[2])", "D(0, 0, q[2])")],
                     id="two lengths that are nowhere"),
        pytest.param("corner", [("np.arctan2(y, x) - s*off", "np.arctan2(x, y) - s*off"),
                                ("y - a1*np.sin(one)", "y - a1*np.cos(one)")],
                     id="what lanes cannot follow"),
        pytest.param("back", [("np.cross(P2, f1)", "np.cross(P3, f1)"),
                              ("to @ wrench[3:]", "wrench[3:]")],
                     id="a name that nothing uses, and a rotation"),
    ],
)  # fmt: skip
def test_several_slips(name, slips) -> None:
    text, robot, quantity = RIGHT[name]
    wrong = with_slips(text, slips)
    said = told(wrong, robot, quantity)
    pairs = zip(text.splitlines(), wrong.splitlines(), strict=True)
    want = [k for k, (right, typed) in enumerate(pairs, 1) if right != typed]
    assert sorted({*lines_named(said)}) == want, said
