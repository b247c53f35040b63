"""What a program holds and never reads was mostly meant for a term that is missing.

Every program is right before its slips; what is said makes it right.
"""

from __future__ import annotations

import pytest
from hand_programs import repaired, with_slips, written

import kinlab as kl

COLUMN = """
import numpy as np

# a, alpha, d, m, rotor
P = np.array([[0.5, 0, 0, 2.0, 0.3], [0.4, 0, 0, 1.5, 0.2]])
g = 9.81

def f(q, v, a):
    t = np.zeros(2)
    x, y = np.cos(np.cumsum(q)), np.sin(np.cumsum(q))
    w, dw = np.cumsum(v), np.cumsum(a)
    acc, f_ends = np.array([0, g]), []
    for i in range(2):
        acc = acc + P[i, 0]*(dw[i]*np.array([-y[i], x[i]]) - w[i]**2*np.array([x[i], y[i]]))
        f_ends.append(P[i, 3]*acc)
    force, moment = np.zeros(2), 0.0
    for i in (1, 0):
        force = force + f_ends[i]
        moment = moment + P[i, 0]*(x[i]*force[1] - y[i]*force[0])
        t[i] = moment + P[i, 4]*a[i]
    return t
"""
NAME = """
import numpy as np
l1, l2, m1, m2, g = 0.5, 0.4, 2.0, 1.5, 9.81
Jm = np.array([0.3, 0.2])

def f(q, v, a):
    c1, c2, c12, s2 = np.cos(q[0]), np.cos(q[1]), np.cos(q[0] + q[1]), np.sin(q[1])
    h = m2*l1*l2*s2
    m11 = (m1 + m2)*l1**2 + m2*l2**2 + 2*m2*l1*l2*c2
    m12 = m2*l2**2 + m2*l1*l2*c2
    t1 = m11*a[0] + m12*a[1] - h*(2*v[0]*v[1] + v[1]**2) + (m1 + m2)*g*l1*c1 + m2*g*l2*c12
    t2 = m12*a[0] + m2*l2**2*a[1] + h*v[0]**2 + m2*g*l2*c12
    return np.array([t1, t2]) + Jm*a
"""
KEY = """
import numpy as np

CRANK = {"l": [0.30, 0.26], "m": [1.0, 0.8], "c": [0.12, 0.15], "I": [0.0075, 0.0060]}
ROD = {"l": [0.50, 0.54], "m": [0.40, 0.35], "c": [0.22, 0.30], "I": [0.0083, 0.0090]}
ROTOR, RATIO, PAYLOAD, BASE = [1.0e-5, 1.2e-5], [10.0, 12.0], 1.5, [0.12, -0.12]
UP = np.array([0.0, 9.81])

def across(x):
    return np.array([-x[1], x[0]])

def f(xy, v, a, mode):
    pull, J, own = PAYLOAD*(a + UP), np.zeros((2, 2)), np.zeros(2)
    for i in range(2):
        l, b = CRANK["l"][i], ROD["l"][i]
        r = xy - np.array([BASE[i], 0.0])
        far = np.hypot(*r)
        th = np.arctan2(r[1], r[0]) - mode[i]*np.arccos((far**2 + l**2 - b**2)/(2*l*far))
        u = np.array([np.cos(th), np.sin(th)])
        w = (r - l*u)/b
        det = u[0]*w[1] - u[1]*w[0]
        J[i], K = w/(l*det), -u/(b*det)
        rate, spin = J[i] @ v, K @ v
        thdd = (a @ w + l*rate**2*(u @ w) + b*spin**2)/(l*det)
        spindd = -(a @ u + l*rate**2 + b*spin**2*(u @ w))/(b*det)
        ac = l*(thdd*across(u) - rate**2*u) + ROD["c"][i]*(spindd*across(w) - spin**2*w)
        G = l*np.outer(across(u), J[i]) + ROD["c"][i]*np.outer(across(w), K)
        pull = pull + G.T @ (ROD["m"][i]*(ac + UP)) + ROD["I"][i]*spindd*K
        around = CRANK["I"][i] + CRANK["m"][i]*CRANK["c"][i]**2 + ROTOR[i]*RATIO[i]**2
        own[i] = around*thdd + CRANK["m"][i]*CRANK["c"][i]*(UP @ across(u))
    return own + np.linalg.solve(J.T, pull)
"""


def geared() -> kl.Robot:
    links = [kl.DHLink(a=0.5, mass=2.0, armature=0.3), kl.DHLink(a=0.4, mass=1.5, armature=0.2)]
    table = kl.DHTable(
        name="geared", convention="standard", links=links, gravity=(0, -9.81, 0), unphysical=True
    )
    return kl.Robot.from_dh(table)


RIGHT = {
    "a column": (COLUMN, geared, "inverse_dynamics"),
    "a name": (NAME, geared, "inverse_dynamics"),
    "a key": (KEY, lambda: "unequal", "fivebar_torque"),
}
SLIPS = [
    ("a column", [(" + P[i, 4]*a[i]", "")]),
    ("a column", [(" + P[i, 4]*a[i]", ""), ("- w[i]**2", "+ w[i]**2")]),
    ("a name", [(" + Jm*a", "")]),
    ("a name", [(" + Jm*a", ""), ("+ h*v[0]**2", "- h*v[0]**2")]),
    ("a key", [(' + ROD["I"][i]*spindd*K', "")]),
    ("a key", [(' + ROD["I"][i]*spindd*K', ""), ("- rate**2*u", "+ rate**2*u")]),
]


@pytest.mark.many
@pytest.mark.parametrize(("name", "slips"), SLIPS)
def test_the_term_with_it_is_told(name, slips) -> None:
    text, robot, quantity = RIGHT[name]
    assert kl.diagnose(robot(), quantity, written(text)).agrees
    wrong = with_slips(text, slips)
    found = kl.diagnose(robot(), quantity, written(wrong))
    assert found.causes, str(found)
    said = found.causes[0].sentence
    assert said.count("should be") == len(slips), said
    mended = repaired(wrong, said)
    assert any(kl.compare(robot(), quantity, one["f"]).agrees for one in mended), said
