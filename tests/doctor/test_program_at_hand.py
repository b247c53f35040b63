"""What a program lacks and has at hand: another link's term, what its dimension tells, kinds of
joints; numbers between rows, and helpers that are right whatever they are given.

Every program is right before the slips; what is said makes it right again.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import asked, with_slips, written

import kinlab as kl

RODS = """
import numpy as np

a1, a2 = 0.5, 0.4
r1, r2 = a1/2, a2/2
m1, m2 = 2.0, 1.5
J1, J2 = m1*a1**2/12, m2*a2**2/12

def f(q):
    s1, c1 = np.sin(q[0]), np.cos(q[0])
    s12, c12 = np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    V1 = np.array([[-r1*s1, 0], [r1*c1, 0]])
    V2 = np.array([[-a1*s1 - r2*s12, -r2*s12], [a1*c1 + r2*c12, r2*c12]])
    W1, W2 = np.array([[1.0, 0.0]]), np.array([[1.0, 1.0]])
    H = m1*V1.T @ V1 + m2*V2.T @ V2
    H = H + J1*W1.T @ W1 + J2*W2.T @ W2
    return H
"""
ROWS = [("R", 0.0, np.pi / 2, 0.31), ("P", 0.12, -np.pi / 2, 0.22), ("R", 0.29, 0.4, 0.07)]
MASSES, CENTRES = (4.1, 2.7, 1.3), ((0.02, -0.09, 0.03), (-0.17, 0.02, 0.05), (-0.12, 0.01, -0.02))
TENSORS = ((0.05, 0.03, 0.04), (0.01, 0.06, 0.07), (0.004, 0.02, 0.022))
ARM = kl.DHTable(
    "arm",
    "modified",
    [
        kl.DHLink(
            joint={"R": "revolute", "P": "prismatic"}[kind],
            a=a,
            alpha=al,
            d=d,
            mass=m,
            com=c,
            inertia=np.diag(i),
        )
        for (kind, a, al, d), m, c, i in zip(ROWS, MASSES, CENTRES, TENSORS, strict=True)
    ],
)
NUMBERS = f"""
import numpy as np
from collections import namedtuple

Row = namedtuple("Row", "a al d")
KINDS = "RPR"
ROWS = (Row(0.0, np.pi/2, 0.31), Row(0.12, -np.pi/2, 0.22), Row(0.29, 0.4, 0.07))
m = {MASSES}
c = np.array({CENTRES})
I = [np.diag(x) for x in {TENSORS}]
z = np.array([0.0, 0.0, 1.0])

def link(i, x):
    t, d = (x, ROWS[i].d) if KINDS[i] == "R" else (0.0, ROWS[i].d + x)
    ct, st, ca, sa = np.cos(t), np.sin(t), np.cos(ROWS[i].al), np.sin(ROWS[i].al)
    R = np.array([[ct, -st, 0], [st*ca, ct*ca, -sa], [st*sa, ct*sa, ca]])
    return R, np.array([ROWS[i].a, -sa*d, ca*d])
"""
ENERGY = (
    NUMBERS
    + """
def f(q, u):
    w, v, T = np.zeros(3), np.zeros(3), 0.0
    for i in range(3):
        R, p = link(i, q[i])
        v = R.T @ (v + np.cross(w, p))
        w = R.T @ w
        if KINDS[i] == "P":
            v = v + u[i]*z
        else:
            w = w + u[i]*z
        speed = v + np.cross(w, c[i])
        T += 0.5*m[i]*speed @ speed + 0.5*w @ I[i] @ w
    return T
"""
)
TORQUES = (
    NUMBERS
    + """
def f(q, u, b):
    w, dw, dv = np.zeros(3), np.zeros(3), np.array([0, 0, 9.81])
    turns, arms, F, N = [], [], [], []
    for i in range(3):
        R, p = link(i, q[i])
        turns.append(R)
        arms.append(p)
        dv = R.T @ (dv + np.cross(dw, p) + np.cross(w, np.cross(w, p)))
        w, dw = R.T @ w, R.T @ dw
        if KINDS[i] == "P":
            dv = dv + 2*np.cross(w, u[i]*z) + b[i]*z
        else:
            dw = dw + np.cross(w, u[i]*z) + b[i]*z
            w = w + u[i]*z
        dvc = dv + np.cross(dw, c[i]) + np.cross(w, np.cross(w, c[i]))
        F.append(m[i]*dvc)
        N.append(I[i] @ dw + np.cross(w, I[i] @ w))
    f_, n_, tau = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in (2, 1, 0):
        R, p = (turns[i + 1], arms[i + 1]) if i < 2 else (np.eye(3), np.zeros(3))
        n_ = R @ n_ + np.cross(p, R @ f_) + N[i] + np.cross(c[i], F[i])
        f_ = R @ f_ + F[i]
        tau[i] = n_[2] if KINDS[i] == "R" else f_[2]
    return tau
"""
)
ROLL = """
import numpy as np

SCREWS = [("turn", [0, 0, 1], [0, 0, 0]), ("turn", [0, -1, 0], [0, 0, 0.42]),
          ("turn", [0, -1, 0], [0.31, 0, 0.42])]
HOME = np.array([[1, 0, 0, 0.48], [0, 0, -1, 0], [0, 1, 0, 0.42], [0, 0, 0, 1.0]])

def cross(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0.0]])

def carried(T):
    R, p = T[:3, :3], T[:3, 3]
    return np.block([[R, np.zeros((3, 3))], [cross(p) @ R, R]])

def moved(axis, point, angle):
    W = cross(np.array(axis, dtype=float))
    T = np.eye(4)
    T[:3, :3] = np.eye(3) + np.sin(angle)*W + (1 - np.cos(angle))*W @ W
    T[:3, 3] = (np.eye(3) - T[:3, :3]) @ np.array(point)
    return T

def f(q):
    T, J = np.eye(4), np.zeros((6, 3))
    for i, (kind, axis, point) in enumerate(SCREWS):
        s = np.hstack([axis, -np.cross(axis, point)])
        J[:, i] = carried(T) @ s
        T = T @ moved(axis, point, q[i])
    tip = (T @ HOME)[:3, 3]
    return np.vstack([J[3:] + np.cross(J[:3].T, tip).T, J[:3]])
"""
ROLLER = kl.DHTable(
    "roller",
    "standard",
    [kl.DHLink(alpha=np.pi / 2, d=0.42), kl.DHLink(a=0.31), kl.DHLink(a=0.17)],
)
POINT = """
import numpy as np

ROWS = [(0.0, 0.0, 0.0), (0.0, 0.45, 0.1), (np.pi/2, 0.35, 0.0)]
TIP = np.array([0.3, 0.02, 0.0, 1.0])

def step(al, a, d, t):
    ca, sa, ct, st = np.cos(al), np.sin(al), np.cos(t), np.sin(t)
    return np.array([[ct, -st, 0, a], [st*ca, ct*ca, -sa, -sa*d],
                     [st*sa, ct*sa, ca, ca*d], [0, 0, 0, 1]])

def f(q):
    T, axes, points = np.eye(4), [], []
    for row, t in zip(ROWS, q):
        T = T @ step(*row, t)
        axes.append(T[:3, 2])
        points.append(T[:3, 3])
    tip = (T @ TIP)[:3]
    return np.vstack([np.array([np.cross(z, tip - o) for z, o in zip(axes, points)]).T,
                      np.array(axes).T])
"""
ELBOW = kl.DHTable(
    "elbow",
    "modified",
    [kl.DHLink(), kl.DHLink(a=0.45, d=0.1), kl.DHLink(a=0.35, alpha=np.pi / 2)],
    tool=np.array([[1, 0, 0, 0.3], [0, 1, 0, 0.02], [0, 0, 1, 0], [0, 0, 0, 1.0]]),
)
RIGHT = [
    (RODS, "planar2r_rods", "mass_matrix"),
    (ENERGY, ARM, "kinetic_energy"),
    (TORQUES, ARM, "inverse_dynamics"),
    (ROLL, ROLLER, "jacobian"),
    (POINT, ELBOW, "jacobian"),
]


@pytest.mark.parametrize("k", range(len(RIGHT)))
def test_the_programs_are_right_before_the_slips(k) -> None:
    text, robot, quantity = RIGHT[k]
    assert kl.compare(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("k", "slips", "kinds"),
    [
        pytest.param(0, [("[[-a1*s1 - r2", "[[-r1*s1 - r2"), (" + J2*W2.T @ W2", "")],
                     {"name", "missing term"}, id="another link's moment, and l for lc"),
        pytest.param(2, [("+ np.cross(c[i], F[i])", ""), ("n_ = R @ n_", "n_ = R.T @ n_")],
                     {"missing term", "transposed"}, id="a moment, and a transpose"),
        pytest.param(1, [("Row(0.12, -np.pi/2, 0.22), Row(0.29", "Row(0.29, -np.pi/2, 0.22), Row(0.12"),
                         ("w = R.T @ w", "w = R @ w")],
                     {"entries swapped", "transposed"}, id="numbers of two rows, and a transpose"),
        pytest.param(3, [("[0.31, 0, 0.42]", "[0.17, 0, 0.42]"), ("(1 - np.cos(angle))*W @ W", "np.cos(angle)*W @ W")],
                     None, id="a point at the zero position, and Rodrigues' formula"),
        pytest.param(4, [("(T @ TIP)[:3]", "T[:3, 3]"), ("np.cross(z, tip - o)", "np.cross(z, tip)")],
                     {"missing matrix", "missing term"}, id="the tool, and the joint's point"),
    ],
)  # fmt: skip
def test_what_is_lacking_is_told(k, slips, kinds, tmp_path) -> None:
    text, robot, quantity = RIGHT[k]
    found, good = asked(with_slips(text, slips), robot, quantity, tmp_path / "hand.py")
    assert good, str(found)
    assert len(found.causes[0].kinds) == len(slips), str(found)
    assert kinds is None or {*found.causes[0].kinds} == kinds, str(found)


def test_of_a_word_of_kinds_two_letters_are_exchanged(tmp_path) -> None:
    slips = [('KINDS = "RPR"', 'KINDS = "PRR"'), ("np.cross(w, c[i])", "np.cross(c[i], w)")]
    found = asked(with_slips(ENERGY, slips), ARM, "kinetic_energy", tmp_path / "hand.py")[0]
    assert "KINDS, two entries are exchanged: `'PRR'` should be `'RPR'`" in found.sentence
    assert "`speed = v + np.cross(c[i], w)` should be" in found.sentence


def test_a_slide_that_is_taken_for_a_hinge(tmp_path) -> None:
    """The line that sets a rate belongs to hinges: what a slide's rate sets is told as well."""
    both = """        if KINDS[i] == "P":
            v = v + u[i]*z
        else:
            w = w + u[i]*z
"""
    slips = [(both, "        w = w + u[i]*z\n"), ("0.5*w @ I", "w @ I")]
    found = asked(with_slips(ENERGY, slips), ARM, "kinetic_energy", tmp_path / "hand.py")[0]
    assert {*found.causes[0].kinds} == {"condition", "factor"}
    right = "`if KINDS[i] == 'R': w = w + u[i]*z; else: v = v + u[i]*z`"
    assert f"`w = w + u[i]*z` should be {right}" in found.sentence


def test_a_helper_that_is_right_whatever_it_is_given_is_not_the_culprit(tmp_path) -> None:
    slips = [("moved(axis, point, q[i])", "moved(axis, point, -q[i])")]
    found, good = asked(with_slips(ROLL, slips), ROLLER, "jacobian", tmp_path / "hand.py")
    assert good
    assert "should be `T = T @ moved(axis, point, q[i])`" in found.sentence


def test_of_several_meanings_of_a_line_none_is_told(tmp_path) -> None:
    text = """
import numpy as np
l, m = [0.5, 0.4], [2.0, 1.5]

def f(q, u, b):
    w = dw = t = 0.0
    acc, accs, arms = np.array([0.0, 9.81]), [], []
    for i in range(2):
        w, dw, t = w + u[i], dw + b[i], t + q[i]
        along = np.array([np.cos(t), np.sin(t)])
        across = np.array([-np.sin(t), np.cos(t)])
        acc = acc + l[i]*(dw*across - w**2*along)
        accs.append(acc)
        arms.append(0.5*l[i]*along)
    force, moment, tau = np.zeros(2), 0.0, np.zeros(2)
    for i in (1, 0):
        force = force + m[i]*accs[i]
        moment = moment + arms[i][0]*force[1] - arms[i][1]*force[0]
        tau[i] = moment
    return tau
"""
    found, good = asked(text, "planar2r", "inverse_dynamics", tmp_path / "hand.py")
    assert good
    assert found.sentence.startswith("line 14, a factor is too many: `arms.append(0.5*l[i]*along)`")
