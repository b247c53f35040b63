"""Of repairs that make a program right, the one that somebody would make is told.

Every program is right before its slips; the expected repairs are what was there.
"""

from __future__ import annotations

import ast
import re

import numpy as np
import pytest
from hand_programs import searched, with_slips, written

import kinlab as kl
from kinlab.doctor.program.places import changed
from kinlab.doctor.program.search.chosen import chosen

RODS = """
import numpy as np
m, l = [3.0, 2.0, 1.0], [0.5, 0.4, 0.25]
lc = [0.25, 0.2, 0.125]
I = [mass*length**2/12 for mass, length in zip(m, l)]

def f(q):
    t = np.cumsum(q)
    c, s = np.cos(t), np.sin(t)
    J = [np.array([[-lc[0]*s[0], 0, 0], [lc[0]*c[0], 0, 0]]),
         np.array([[-l[0]*s[0] - lc[1]*s[1], -lc[1]*s[1], 0],
                   [l[0]*c[0] + lc[1]*c[1], lc[1]*c[1], 0]]),
         np.array([[-l[0]*s[0] - l[1]*s[1] - lc[2]*s[2], -l[1]*s[1] - lc[2]*s[2], -lc[2]*s[2]],
                   [l[0]*c[0] + l[1]*c[1] + lc[2]*c[2], l[1]*c[1] + lc[2]*c[2], lc[2]*c[2]]])]
    W = [np.array([[1, 0, 0]]), np.array([[1, 1, 0]]), np.array([[1, 1, 1]])]
    return sum(m[k]*J[k].T @ J[k] + I[k]*W[k].T @ W[k] for k in range(3))
"""
CHRISTOFFEL = """
import numpy as np
l1, l2, m1, m2 = 0.5, 0.4, 2.0, 1.5
lc1, lc2 = l1/2, l2/2

def slopes(q):
    h = m2*l1*lc2*np.sin(q[1])
    D = np.zeros((2, 2, 2))
    D[0, 0, 1] = -2*h
    D[0, 1, 1] = -h
    D[1, 0, 1] = -h
    return D

def f(q, v):
    D, C = slopes(q), np.zeros((2, 2))
    for k in range(2):
        for j in range(2):
            for i in range(2):
                C[k, j] += 0.5*(D[k, j, i] + D[k, i, j] - D[i, j, k])*v[i]
    return C
"""
TURNS = """
import numpy as np

def about_z(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])

def about_x(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])

def along(x, z):
    T = np.eye(4)
    T[0, 3], T[2, 3] = x, z
    return T

ROWS = [(0.0, np.pi/2, 0.0), (0.4318, 0.0, 0.0), (0.0203, -np.pi/2, 0.15005),
        (0.0, np.pi/2, 0.4318), (0.0, -np.pi/2, 0.0), (0.0, 0.0, 0.0)]

def f(q):
    T = np.eye(4)
    for t, (a, alpha, d) in zip(q, ROWS):
        T = T @ about_z(t) @ along(a, d) @ about_x(alpha)
    return T
"""
MILLIMETRES = """
import numpy as np

MM = [(0.0, 90, 0.0), (431.8, 0, 0.0), (20.3, -90, 150.05), (0.0, 90, 431.8), (0.0, -90, 0.0),
      (0.0, 0, 0.0)]

def f(q):
    T = np.eye(4)
    for t, (a, alpha, d) in zip(q, MM):
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(np.radians(alpha)), np.sin(np.radians(alpha))
        T = T @ np.array([[c, -s*ca, s*sa, a*c/1000], [s, c*ca, -c*sa, a*s/1000],
                          [0, sa, ca, d/1000], [0, 0, 0, 1]])
    return T
"""
CRAIG = """
import numpy as np

# a and alpha of the link before, d, theta, whether it slides: as Craig has them
ROWS = [(0.0, 0.0, 0.412, 0.0, False), (0.0, -np.pi/2, 0.154, 0.0, False),
        (0.0, np.pi/2, 0.0, -np.pi/2, True), (0.0203, 0.0, 0.0, 0.0, False),
        (0.0, -np.pi/2, 0.0, 0.0, False), (0.0, np.pi/2, 0.263, 0.0, False)]

def f(q):
    T = np.eye(4)
    for x, (a, alpha, d, theta, slides) in zip(q, ROWS):
        d, theta = (d + x, theta) if slides else (d, theta + x)
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
        T = T @ np.array([[c, -s, 0, a], [s*ca, c*ca, -sa, -sa*d], [s*sa, c*sa, ca, ca*d],
                          [0, 0, 0, 1]])
    return T
"""
UR = """
import numpy as np

LINKS = [dict(a=0.0, al=np.pi/2, d=0.089159, m=3.7, c=(0, 0, 0)),
         dict(a=-0.425, al=0.0, d=0.0, m=8.393, c=(0.145, 0, 0.13585)),
         dict(a=-0.39225, al=0.0, d=0.0, m=2.275, c=(0.14225, 0, 0.01615)),
         dict(a=0.0, al=np.pi/2, d=0.10915, m=1.219, c=(0, -0.093, 0)),
         dict(a=0.0, al=-np.pi/2, d=0.09465, m=1.219, c=(0, 0.09465, 0)),
         dict(a=0.0, al=0.0, d=0.0823, m=0.1879, c=(0, 0, -0.0823))]

def step(t, k):
    c, s, ca, sa = np.cos(t), np.sin(t), np.cos(k["al"]), np.sin(k["al"])
    return np.array([[c, -s*ca, s*sa, k["a"]*c], [s, c*ca, -c*sa, k["a"]*s], [0, sa, ca, k["d"]],
                     [0, 0, 0, 1]])

def f(q):
    frames = [np.diag([-1.0, -1.0, 1.0, 1.0])]
    for t, k in zip(q, LINKS):
        frames.append(frames[-1] @ step(t, k))
    out = np.zeros(6)
    for i, k in enumerate(LINKS):
        p = (frames[i + 1] @ np.append(k["c"], 1.0))[:3]
        for j in range(i + 1):
            z, o = frames[j][:3, 2], frames[j][:3, 3]
            out[j] += k["m"]*9.81*np.cross(z, p - o)[2]
    return out
"""
CASES = {
    "a rod about its end, and a sign": (
        RODS, "planar3r", "mass_matrix", [("**2/12", "**2/3"), ("l[0]*c[0] + lc[1]*c[1]", "l[0]*c[0] - lc[1]*c[1]")],
        ["mass*length**2/12", "l[0]*c[0] + lc[1]*c[1]"],
    ),
    "own rates for those of all links before": (
        RODS, "planar3r", "mass_matrix", [("[[1, 1, 0]]", "[[0, 1, 0]]"), ("[[1, 1, 1]]", "[[0, 0, 1]]")],
        ["np.array([[1, 1, 0]]), np.array([[1, 1, 1]])"],
    ),
    "a turn the other way, where it is made": (
        TURNS, "puma560", "fk", [("[[c, -s, 0, 0], [s, c, 0, 0]", "[[c, s, 0, 0], [-s, c, 0, 0]")],
        ["[[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"],
    ),
    "millimetres, and another slip": (
        MILLIMETRES, "puma560", "fk", [("(431.8, 0", "(413.8, 0"), ("-c*sa, a*s", "c*sa, a*s")],
        ["431.8", "-c*sa, a*s/1000"],
    ),
    "a row of a table in Craig's way": (
        CRAIG, "stanford", "fk", [("(0.0203, 0.0, 0.0, 0.0", "(0.0, 0.0, 0.0203, 0.0")],
        ["(0.0203, 0.0, 0"],
    ),
    "the number of the row below, and a sign": (
        UR, "ur5", "gravity_torques", [("d=0.09465", "d=0.0823"), ("-0.0823", "0.0823")],
        ["`d=0.09465`", "-0.0823)"],
    ),
}  # fmt: skip


@pytest.mark.many
@pytest.mark.parametrize("case", CASES)
def test_what_was_there_is_told(case, tmp_path) -> None:
    text, robot, quantity, slips, told = CASES[case]
    assert kl.diagnose(robot, quantity, written(text)).agrees
    file = tmp_path / "wrong.py"
    file.write_text(with_slips(text, slips))
    found = kl.diagnose(robot, quantity, written(file.read_text(), file))
    assert len(found.causes) == 1, str(found)
    after = " ".join(found.causes[0].sentence.split("should be")[1:])
    for piece in told:
        assert piece in after, str(found)


def test_no_index_of_three_becomes_another_of_them() -> None:
    """D[i, j, i] for D[k, j, i] may do on one arm, and is in no book."""
    search = searched("planar2r_rods", "coriolis_matrix", CHRISTOFFEL)
    given = search.asked, search.observed, search.known, search.dimensions
    tried = 0
    for edit in chosen(*given, np.inf, 10**6):
        if edit.kind == "index" and edit.part == 0:
            with changed(search.trial, (edit,)):
                text = ast.unparse(search.trial.trees[0])
            every = re.findall(r"D\[([ijk]), ([ijk]), ([ijk])\]", text)
            assert all(len({*some}) == 3 for some in every), text
            tried += bool(every)
    assert tried > 10
