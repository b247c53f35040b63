"""Where a slip is told: where it was made, and not where it could be made up for.

Every program is right before its slips. What makes up for one elsewhere (a minus in a list of
results, for one in the formula of a result) repairs the program as well, and is not what happened;
where nothing tells two places apart, both are told.
"""

from __future__ import annotations

import pytest
from hand_programs import PROGRAMS as OWN
from hand_programs import asked, told_in_its_line, with_slips, written

import kinlab as kl

ARM = """
import numpy as np
from math import atan2, cos, hypot, sin, sqrt

L1, L2, L3 = 0.5, 0.4, 0.25

def wrap(t):
    t = (t + np.pi) % (2*np.pi) - np.pi
    return t

def f(x, y, phi):
    wx, wy = x - L3*cos(phi), y - L3*sin(phi)
    c2 = (wx*wx + wy*wy - L1*L1 - L2*L2)/(2*L1*L2)
    rows = []
    for side in (1, -1):
        s2 = side*sqrt(max(0.0, 1 - c2*c2))
        t2 = atan2(s2, c2)
        beta = atan2(wy, wx)
        psi = atan2(L2*s2, L1 + L2*c2)
        t1 = beta - psi
        t3 = wrap(phi - t1 - t2)
        rows.append([t1, t2, t3])
    return np.array(rows)
"""
CORIOLIS = """
import numpy as np

a1, a2 = 0.5, 0.4
ac1, ac2 = 0.25, 0.2
m1, m2 = 2.0, 1.5

def slopes(q):
    s2 = np.sin(q[1])
    d = np.zeros((2, 2, 2))
    d[1, 0, 0] = -2*m2*a1*ac2*s2
    d[1, 0, 1] = -m2*a1*ac2*s2
    d[1, 1, 0] = d[1, 0, 1]
    return d

def f(q, v):
    d = slopes(q)
    C = np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            for k in range(2):
                C[k, j] += 0.5*(d[i, k, j] + d[j, k, i] - d[k, i, j])*v[i]
    return C
"""
DIFFERENCES = """
import numpy as np

m1, m2, l1, l2 = 2.0, 1.5, 0.5, 0.4

def mass(q):
    h = m2*l1*l2*np.cos(q[1])
    return np.array([[(m1 + m2)*l1**2 + m2*l2**2 + 2*h, m2*l2**2 + h], [m2*l2**2 + h, m2*l2**2]])

def f(q, v):
    eps = 1e-5
    dM = np.zeros((2, 2, 2))
    for k in range(2):
        e = np.zeros(2)
        e[k] = eps
        dM[:, :, k] = (mass(q + e) - mass(q - e))/(2*eps)
    C = np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            for k in range(2):
                C[i, j] += 0.5*(dM[i, j, k] + dM[i, k, j] - dM[j, k, i])*v[k]
    return C
"""
STATICS = """
import numpy as np
from math import cos, pi, sin

ROWS = [(0, 0, 0), (pi/2, 0, 0), (0, 0.4318, 0.15005), (-pi/2, 0.0203, 0.4318), (pi/2, 0, 0), (-pi/2, 0, 0)]

def frame(row, t):
    al, a, d = row
    ca, sa, ct, st = cos(al), sin(al), cos(t), sin(t)
    R = np.array([[ct, -st, 0], [st*ca, ct*ca, -sa], [st*sa, ct*sa, ca]])
    P = np.array([a, -sa*d, ca*d])
    return R, P

def f(q, wrench):
    force, n = wrench[:3], wrench[3:]
    tau = [n[2]]
    for k in range(5, 0, -1):
        R, P = frame(ROWS[k], q[k])
        force = R @ force
        n = R @ n + np.cross(P, force)
        tau.append(n[2])
    return np.array(tau[::-1])
"""
COLUMNS = """
import numpy as np
from math import cos, pi, sin

KIND = "RRPRRR"
ROWS = [(-pi/2, 0, 0.412), (pi/2, 0, 0.154), (0, 0.0203, 0), (-pi/2, 0, 0), (pi/2, 0, 0), (0, 0, 0.263)]

def step(row, q, kind):
    al, a, d = row
    t = q
    if kind == "P":
        t, d = -pi/2, q
    ct, st, ca, sa = cos(t), sin(t), cos(al), sin(al)
    return np.array([[ct, -st*ca, st*sa, a*ct], [st, ct*ca, -ct*sa, a*st], [0, sa, ca, d], [0, 0, 0, 1]])

def turning(T, p):
    return np.hstack([np.cross(T[:3, 2], p - T[:3, 3]), T[:3, 2]])

def sliding(T):
    return np.hstack([T[:3, 2], np.zeros(3)])

def f(q):
    T = [np.eye(4)]
    for row, angle, kind in zip(ROWS, q, KIND):
        T.append(T[-1] @ step(row, angle, kind))
    p = T[6][:3, 3]
    J = np.zeros((6, 6))
    for k in range(6):
        J[:, k] = turning(T[k], p)
    J[:, 2] = sliding(T[2])
    return J
"""
LEGS = """
import numpy as np

class Leg:
    def __init__(self, crank, rod, base):
        self.crank, self.rod, self.base = crank, rod, base

    def theta(self, r, bend):
        x, y = r[0] - self.base, r[1]
        rho2 = x*x + y*y
        K = (rho2 + self.crank**2 - self.rod**2)/(2*self.crank)
        return np.arctan2(y, x) - bend*np.arctan2(np.sqrt(rho2 - K*K), K)

RIGHT = Leg(0.30, 0.50, 0.12)
LEFT = Leg(0.26, 0.54, -0.12)

def f(xy, mode):
    return np.array([leg.theta(xy, s) for leg, s in zip((RIGHT, LEFT), mode)])
"""
ELBOWS = """
import numpy as np

CRANK, ROD, BASE = (0.30, 0.26), (0.50, 0.54), 0.12

def crank(k, r, side):
    base = np.array([BASE if k == 0 else -BASE, 0.0])
    gap = r - base
    d2 = gap @ gap
    along = (CRANK[k]**2 - ROD[k]**2 + d2)/(2*d2)
    height = np.sqrt(CRANK[k]**2/d2 - along**2)
    normal = np.array([gap[1], -gap[0]])
    elbow = base + along*gap + side*height*normal
    return np.arctan2(elbow[1] - base[1], elbow[0] - base[0])

def f(xy, mode):
    return np.array([crank(k, xy, mode[k]) for k in range(2)])
"""
ENERGY = """
import numpy as np

LINKS = {
    1: dict(a=0.0, al=0.0, m=3.0, c=[0.2, 0.02, -0.01], I=[0.02, 0.08, 0.07, 0.0, 0.0, 0.0]),
    2: dict(a=0.45, al=0.0, m=2.0, c=[0.15, -0.01, 0.03], I=[0.01, 0.04, 0.045, 0.0, 0.0, 0.0]),
    3: dict(a=0.35, al=np.pi/2, m=1.2, c=[0.12, 0.03, 0.01], I=[0.004, 0.012, 0.014, 0.001, 0.0, 0.0005]),
}

def tensor(v):
    xx, yy, zz, xy, xz, yz = v
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

def turned(al, t):
    Rx = np.array([[1, 0, 0], [0, np.cos(al), -np.sin(al)], [0, np.sin(al), np.cos(al)]])
    Rz = np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])
    return Rx @ Rz

def f(q, v):
    w, u, T = np.zeros(3), np.zeros(3), 0.0
    for k in (1, 2, 3):
        link = LINKS[k]
        R = turned(link["al"], q[k - 1])
        u = R.T @ (u + np.cross(w, [link["a"], 0.0, 0.0]))
        w = R.T @ w + np.array([0.0, 0.0, v[k - 1]])
        uc = u + np.cross(w, link["c"])
        T += 0.5*link["m"]*uc @ uc + 0.5*w @ tensor(link["I"]) @ w
    return T
"""
ROD = """
import math

class Rod:
    def __init__(self, mass, length, lc):
        self.mass = mass
        self.length = length
        self.lc = lc

    def inertia(self):
        own = self.mass*self.length**2/12
        return own + self.mass*self.lc**2

    def gravity(self, angle):
        return self.mass*9.81*self.lc*math.cos(angle)

rod = Rod(2.5, 0.6, 0.3)

def f(q, v, tau):
    return [(tau[0] - rod.gravity(q[0]))/rod.inertia()]
"""
PROGRAMS = {
    "masses": ("planar2r", "mass_matrix", OWN["planar mass matrix"].text),
    "arm": ("planar3r", "inverse_kinematics_xyphi", ARM),
    "coriolis": ("planar2r_rods", "coriolis_matrix", CORIOLIS),
    "differences": ("planar2r", "coriolis_matrix", DIFFERENCES),
    "statics": ("puma560_modified", "statics_tool", STATICS),
    "columns": ("stanford", "jacobian", COLUMNS),
    "legs": ("unequal", "fivebar_angles", LEGS),
    "elbows": ("unequal", "fivebar_angles", ELBOWS),
    "energy": ("spatial3r", "kinetic_energy", ENERGY),
    "rod": ("single_link", "forward_dynamics", ROD),
}


@pytest.mark.parametrize("name", PROGRAMS)
def test_every_program_is_right(name):
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.parametrize(
    ("name", "right", "slip", "kind"),
    [
        pytest.param("arm", "t1 = beta - psi", "t1 = beta + psi", "sign", id="a sum of two names"),
        pytest.param("arm", "wrap(phi - t1 - t2)", "wrap(t1 + t2 - phi)", "sign", id="before a list of results"),
        pytest.param("columns", 'kind == "P"', 'kind == "R"', "condition", id="a kind of joint"),
        pytest.param("columns", "sliding(T[2])", "turning(T[2], p)", "function", id="a function that nothing calls"),
        pytest.param("legs", "Leg(0.26", "Leg(0.25", "number", id="a leg's number"),
        pytest.param("rod", "length**2/12", "length**2/3", "number", id="and not what an object keeps"),
    ],
)  # fmt: skip
def test_a_slip_is_told_where_it_was_made(name, right, slip, kind, tmp_path):
    cause = told_in_its_line(*PROGRAMS[name], right, slip, tmp_path / "own.py")
    assert kind in cause.kinds[0]


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips", "said"),
    [
        pytest.param(
            "coriolis",
            [("0.25, 0.2", "0.25, 0.4"), ("= -2*m2", "= -m2")],
            ["ac2, a number is wrong: 0.4 should be 0.2", "`d[1, 0, 0] = -2*m2*a1*ac2*s2`"],
            id="a length for a centre",
        ),
        pytest.param(
            "differences",
            [("/(2*eps)", "/eps"), ("+= 0.5*(", "+= (")],
            ["/(2*eps)`", "C[i, j] += 0.5*("],
            id="two factors of the whole",
        ),
        pytest.param(
            "statics",
            [("-sa*d", "sa*d"), ("cross(P, force)", "cross(force, P)")],
            ["P = np.array([a, -sa*d, ca*d])", "np.cross(P, force)`"],
            id="no minus for a length",
        ),
        pytest.param(
            "energy",
            [("[0.15, -0.01, 0.03]", "[0.15, 0.01, 0.03]"), ("Rx @ Rz", "Rz @ Rx")],
            ["LINKS[2]['c'][1], the sign is wrong: 0.01 should be -0.01", "`return Rx @ Rz`"],
            id="a table by keys from 1",
        ),
        pytest.param(
            "masses",
            [("l1, l2 = 0.5, 0.4", "l1, l2 = 0.4, 0.5"), ("M12 = m2 *", "M12 = m1 *")],
            ["two entries are exchanged: `l1 = 0.4, l2 = 0.5`", "M12 = m2*"],
            id="an exchange is one slip",
        ),
    ],
)  # fmt: skip
def test_two_slips_are_told_where_they_were_made(name, slips, said):
    robot, quantity, text = PROGRAMS[name]
    found, good = asked(with_slips(text, slips), robot, quantity)
    assert all(one in found.sentence for one in said), found.sentence
    assert good, found.sentence
    assert len(found.causes[0].kinds) == len(slips), found


def test_of_two_places_as_likely_both_are_told():
    """The other normal, or the minus where it is used: nothing tells which it was."""
    robot, quantity, text = PROGRAMS["elbows"]
    wrong = with_slips(text, [("[gap[1], -gap[0]]", "[-gap[1], gap[0]]")])
    found = kl.diagnose(robot, quantity, written(wrong))
    assert "or else" in found.sentence, found
    assert "gap + side*height*normal` should be `" in found.sentence
    assert "should be `normal = np.array([gap[1], -gap[0]])`" in found.sentence


def test_a_number_of_several_links_is_said_of_none():
    """0.01 is a coordinate of three centres of mass."""
    robot, quantity, text = PROGRAMS["energy"]
    wrong = with_slips(text, [("[0.15, -0.01, 0.03]", "[0.15, 0.01, 0.03]")])
    found = kl.diagnose(robot, quantity, written(wrong))
    assert "LINKS[2]['c'][1]" in found.sentence, found
    assert "link 1" not in found.sentence, found


INDICES = """
import numpy as np

def f(q):
    t = np.cumsum(q)
    l = np.array([0.5, 0.4, 0.25])
    J = np.zeros((3, 3))
    for i in range(3):
        for j in range(i + 1):
            J[0, j] -= l[i]*np.sin(t[i])
            J[1, j] += l[i]*np.cos(t[i])
    J[2] = 1.0
    return J
"""
TENSORS = """
import numpy as np

A, ALPHA, M = (0.0, 0.45, 0.35), (0.0, 0.0, np.pi/2), (3.0, 2.0, 1.2)
PC = [[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]]
I = np.zeros((3, 3, 3))
I[0] = np.diag([0.02, 0.08, 0.07])
I[1] = np.diag([0.01, 0.04, 0.045])
I[2] = [[0.004, 0.001, 0.0], [0.001, 0.012, 0.0005], [0.0, 0.0005, 0.014]]

def turned(al, t):
    ca, sa, ct, st = np.cos(al), np.sin(al), np.cos(t), np.sin(t)
    return np.array([[ct, -st, 0], [st*ca, ct*ca, -sa], [st*sa, ct*sa, ca]])

def f(q, v):
    w, u, T = np.zeros(3), np.zeros(3), 0.0
    for k in range(3):
        R = turned(ALPHA[k], q[k])
        u = R.T @ (u + np.cross(w, [A[k], 0.0, 0.0]))
        w = R.T @ w + np.array([0.0, 0.0, v[k]])
        uc = u + np.cross(w, PC[k])
        T += 0.5*M[k]*uc @ uc + 0.5*w @ I[k] @ w
    return T
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip", "kind"),
    [
        pytest.param("planar3r", "planar_jacobian", INDICES, "J[1, j]", "J[1, i]", "index", id="a counter in a target"),
        pytest.param("spatial3r", "kinetic_energy", TENSORS, "0.001, 0.012", "0.001, 0.0012", "number", id="a tensor"),
    ],
)  # fmt: skip
def test_where_a_value_is_written_and_a_typed_tensor(
    robot, quantity, text, right, slip, kind, tmp_path
):
    assert kl.diagnose(robot, quantity, written(text)).agrees
    cause = told_in_its_line(robot, quantity, text, right, slip, tmp_path / "own.py")
    assert kind in cause.kinds[0]


def test_two_signs_and_one_of_a_result_are_both_told():
    """Both make the elbow's other solution of it: which happened, nothing tells."""
    robot, quantity, text = PROGRAMS["arm"]
    slips = [("t1 = beta - psi", "t1 = beta + psi"), ("phi - t1 - t2", "phi - t1 + t2")]
    found = kl.diagnose(robot, quantity, written(with_slips(text, slips)))
    assert not found.agrees and "t1 = beta - psi" in found.sentence, found
    assert "phi - t1 - t2" in found.sentence, found
