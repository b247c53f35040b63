"""What is put in place of a whole: a name for a part of something, a transform for its neighbour.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import EXPONENTIALS, asked, told_in_its_line, with_slips

STATICS = """
import numpy as np
rows = [(0.5, 0), (0.4, 0)]

def f(q, F):
    p, angle, points, axes = np.zeros(3), 0.0, [], []
    for (a, d), t in zip(rows, q):
        points.append(p)
        angle = angle + t
        p = p + np.array([a*np.cos(angle), a*np.sin(angle), d])
    points.append(p)
    force, n = F[:3], F[3:]
    tau = np.zeros(2)
    for i in (1, 0):
        n = n + np.cross(points[i + 1] - points[i], force)
        tau[i] = n[2]
    return tau
"""
STEP = """
import numpy as np
table = [(0.45, 0, 0), (0.35, np.pi/2, 0), (0.3, 0, 0)]

def f(q):
    R, p = np.eye(3), np.zeros(3)
    frames = []
    for (a, al, d), t in zip(table, q):
        frames.append((R[:, 2], p))
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
        p = p + R @ np.array([a*c, a*s, d])
        R = R @ np.array([[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]])
    J = np.zeros((6, 3))
    for k, (z, o) in enumerate(frames):
        J[:3, k] = np.cross(z, p - o)
        J[3:, k] = z
    return J
"""
CHAIN = """
import numpy as np
from functools import reduce

def rotz(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])

def rotx(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])

def transx(a):
    T = np.eye(4)
    T[0, 3] = a
    return T

def f(q):
    return reduce(np.matmul, [rotz(q[0]), transx(0.45), rotz(q[1]), transx(0.35),
                              rotx(np.pi/2), rotz(q[2]), transx(0.3)])
"""
POINTS = """
from numpy import array, cos, sin

def f(q):
    C1, S1, C12, S12 = cos(q[0]), sin(q[0]), cos(q[0] + q[1]), sin(q[0] + q[1])
    r = 0.35 + 0.3*cos(q[2])
    return array([[C12*cos(q[2]), -C12*sin(q[2]), S12, 0.45*C1 + C12*r],
                  [S12*cos(q[2]), -S12*sin(q[2]), -C12, 0.45*S1 + r*S12],
                  [sin(q[2]), cos(q[2]), 0, 0.3*sin(q[2])],
                  [0, 0, 0, 1]])
"""
SLIPS = [
    ("planar2r", "statics", STATICS, "n + np.cross", "F[3:] + np.cross"),
    ("spatial3r", "jacobian", STEP, "J[3:, k] = z", "J[3:, k] = R[:, 2]"),
    ("spatial3r", "fk", CHAIN, "rotx(np.pi/2), rotz(q[2])", "rotz(q[2]), rotx(np.pi/2)"),
    ("planar2r", "fk", EXPONENTIALS, "(theta - np.sin(theta))*W", "np.sin(theta)*W"),
    ("spatial3r", "fk", POINTS, "0.45*C1 + C12*r", "0.45*C1 - S12*r"),
]


@pytest.mark.parametrize(("robot", "quantity", "text", "right", "slip"), SLIPS)
def test_what_stood_there_is_told(robot, quantity, text, right, slip, tmp_path) -> None:
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


DEGREES = """
import numpy as np
DEG = np.pi/180
TABLE = [(0, 0.412, 0, -90), (0, 0.154, 0, 90), (-90, 0, 0.0203, 0),
         (0, 0, 0, -90), (0, 0, 0, 90), (0, 0.263, 0, 0)]

def rot(axis, t):
    R = np.eye(4)
    i, j = {"x": (1, 2), "z": (0, 1)}[axis]
    R[i, i] = R[j, j] = np.cos(t)
    R[i, j], R[j, i] = -np.sin(t), np.sin(t)
    return R

def f(q):
    T = np.eye(4)
    for i in range(6):
        th, d, a, al = TABLE[i]
        th = th*DEG + (0 if i == 2 else q[i])
        shift = np.eye(4)
        shift[0, 3], shift[2, 3] = a, q[i] if i == 2 else d
        T = T @ rot("z", th) @ shift @ rot("x", al*DEG)
    return T
"""


def test_whole_degrees_that_are_given_on(tmp_path) -> None:
    """Whole numbers are no counters where they are angles."""
    told_in_its_line("stanford", "fk", DEGREES, '"x", al*DEG', '"x", al', tmp_path / "hand.py")


PSEUDO = """
import numpy as np
a, l = np.array([0.5, 0.4]), np.array([0.25, 0.2])
m, I = np.array([2.0, 1.5]), np.array([0.0416666666666667, 0.02])
Q = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]])

def pseudo(k):
    c = np.array([l[k] - a[k], 0, 0])
    J = np.zeros((4, 4))
    J[:3, :3] = np.diag([0, 1, 0])*I[k] + m[k]*np.outer(c, c)
    J[:3, 3] = J[3, :3] = m[k]*c
    J[3, 3] = m[k]
    return J

def f(q):
    T = [np.eye(4)]
    for k in range(2):
        c, s = np.cos(q[k]), np.sin(q[k])
        T.append(T[k] @ np.array([[c, -s, 0, a[k]*c], [s, c, 0, a[k]*s],
                                  [0, 0, 1, 0], [0, 0, 0, 1]]))
    U = [[T[j] @ Q @ np.linalg.inv(T[j]) @ T[p + 1] for j in range(p + 1)] for p in range(2)]
    M = np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            for p in range(max(i, j), 2):
                M[i, j] += np.trace(U[p][j] @ pseudo(p) @ U[p][i].T)
    return M
"""


def test_second_moments_that_are_left_out(tmp_path) -> None:
    """And a mass of another link."""
    slips = [(" + m[k]*np.outer(c, c)", ""), ("J[3, 3] = m[k]", "J[3, 3] = m[0]")]
    found, good = asked(
        with_slips(PSEUDO, slips), "planar2r_rods", "mass_matrix", tmp_path / "hand.py"
    )
    assert good, found.sentence
    assert "m[k]*np.outer(c, c)" in found.sentence


ENERGY = """
import numpy as np
rows = [(0, 0), (0.45, 0), (0.35, np.pi/2)]
bodies = [(3.0, (0.2, 0.02, -0.01), (0.02, 0.08, 0.07, 0, 0)),
          (2.0, (0.15, -0.01, 0.03), (0.01, 0.04, 0.045, 0, 0)),
          (1.2, (0.12, 0.03, 0.01), (0.004, 0.012, 0.014, 0.001, 0.0005))]
Q = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]])

def pseudo(m, c, xx, yy, zz, xy, yz):
    c = np.array(c)
    J = np.zeros((4, 4))
    J[:3, :3] = [[(yy + zz - xx)/2, -xy, 0],
                 [-xy, (xx + zz - yy)/2, -yz],
                 [0, -yz, (xx + yy - zz)/2]]
    J[:3, :3] = J[:3, :3] + m*np.outer(c, c)
    J[:3, 3] = J[3, :3] = m*c
    J[3, 3] = m
    return J

def link(row, t):
    a, al = row
    c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
    return np.array([[c, -s, 0, a], [s*ca, c*ca, -sa, 0], [s*sa, c*sa, ca, 0], [0, 0, 0, 1]])

def f(q, qd):
    T, Td, energy = np.eye(4), np.zeros((4, 4)), 0.0
    for i, (m, c, I) in enumerate(bodies):
        A = link(rows[i], q[i])
        Td = Td @ A + T @ A @ Q*qd[i]
        T = T @ A
        energy += 0.5*np.trace(Td @ pseudo(m, c, *I) @ Td.T)
    return energy
"""


def test_one_that_takes_most_of_what_is_wrong_away_comes_first(tmp_path) -> None:
    """Of two slips, of which one is by far the larger; no two effects of an energy add up."""
    slips = [
        ("T @ A @ Q*qd[i]", "T @ Q @ A*qd[i]"),
        ("(xx + zz - yy)/2, -yz", "(xx + zz - yy)/2, yz"),
    ]
    file = tmp_path / "hand.py"
    found, good = asked(with_slips(ENERGY, slips), "spatial3r", "kinetic_energy", file)
    assert good, found.sentence
    assert len(found.causes[0].kinds) == 2


ALIASED = """
import numpy as np
rows = [(0.5, 2.0), (0.4, 1.5)]
com = [0.25, 0.2]

def f(q):
    angle, o = 0.0, np.zeros(3)
    points, centres, masses = [], [], []
    for (a, m), c, t in zip(rows, com, q):
        angle = angle + t
        along = np.array([np.cos(angle), np.sin(angle), 0])
        points.append(o.copy())
        centres.append(o + c*along)
        masses.append(m)
        o += a*along
    tau = np.zeros(2)
    for k in range(2):
        for i in range(k, 2):
            tau[k] += masses[i]*9.81*(centres[i] - points[k])[0]
    return tau
"""
STEPS = """
import numpy as np
m, l, c, I = [2.0, 1.5], 0.5, [0.25, 0.2], [0.0416666666666667, 0.02]

def M(q):
    h = m[1]*l*c[1]*np.cos(q[1])
    d = I[1] + m[1]*c[1]**2
    return np.array([[I[0] + m[0]*c[0]**2 + m[1]*l**2 + d + 2*h, d + h], [d + h, d]])

def f(q, v):
    dM = np.zeros((2, 2, 2))
    for k in range(2):
        z = np.array(q, dtype=complex)
        z[k] += 1e-30j
        dM[:, :, k] = M(z).imag/1e-30
    return 0.5*(np.einsum("ijk,k->ij", dM, v) + np.einsum("ikj,k->ij", dM, v)
                - np.einsum("kji,k->ij", dM, v))
"""
SUMS = """
import numpy as np

def f(q):
    p = np.cumsum(q)
    tail = lambda w: np.cumsum(w[::-1])[::-1]
    L = np.array([0.5, 0.4, 0.25])
    return np.array([-tail(L*np.sin(p)), tail(L*np.cos(p)), np.ones(3)])
"""
HEIGHT = """
import numpy as np
COLUMN_MM = 387

def f(q):
    t = q[0] + q[1]
    H = np.eye(4)
    p = t - q[3]
    H[:2, :2] = [[np.cos(p), np.sin(p)], [np.sin(p), -np.cos(p)]]
    H[2, 2] = -1
    H[:2, 3] = [0.325*np.cos(q[0]) + 0.275*np.cos(t), 0.325*np.sin(q[0]) + 0.275*np.sin(t)]
    H[2, 3] = COLUMN_MM/1000 - q[2]
    return H
"""
PLANE = """
import numpy as np

def f(q, v):
    e1, e2 = np.exp(1j*q[0]), np.exp(1j*(q[0] + q[1]))
    z1, z2 = 0.5*e1, 0.5*e1 + 0.4*e2
    d1, d2 = 0.5j*e1*v[0], 0.5j*e1*v[0] + 0.4j*e2*(v[0] + v[1])
    T = 0.5*(2.0*abs(d1)**2 + 1.5*abs(d2)**2)
    V = 9.81*(2.0*z1.imag + 1.5*z2.imag)
    return T - V
"""
RATES = """
import numpy as np
L1, L2, L3 = 0.45, 0.35, 0.3

def f(q, dq):
    c1, s1, c12, s12 = np.cos(q[0]), np.sin(q[0]), np.cos(q[0] + q[1]), np.sin(q[0] + q[1])
    c3, s3 = np.cos(q[2]), np.sin(q[2])
    w1, w12, w3 = dq[0], dq[0] + dq[1], dq[2]
    r = L2 + L3*c3
    p2 = np.array([L1*c1, L1*s1, 0])
    p3 = p2 + np.array([L2*c12, L2*s12, 0])
    pe = p2 + np.array([r*c12, r*s12, L3*s3])
    v2 = L1*w1*np.array([-s1, c1, 0])
    v3 = v2 + L2*w12*np.array([-s12, c12, 0])
    ve = v2 + np.array([-r*s12*w12 - L3*s3*w3*c12, r*c12*w12 - L3*s3*w3*s12, L3*c3*w3])
    z, z3 = np.array([0, 0, 1.0]), np.array([s12, -c12, 0])
    z3d = w12*np.array([c12, s12, 0])
    Jd = np.zeros((6, 3))
    Jd[:3, 0] = np.cross(z, ve)
    Jd[:3, 1] = np.cross(z, ve - v2)
    Jd[:3, 2] = np.cross(z3d, pe - p3) + np.cross(z3, ve - v3)
    Jd[3:, 2] = z3d
    return Jd
"""
MORE = [
    ("planar2r_rods", "gravity_torques", ALIASED, "points.append(o.copy())", "points.append(o)"),
    ("planar2r_rods", "coriolis_matrix", STEPS, "z[k] += 1e-30j", "z[1] += 1e-30j"),
    ("planar3r", "planar_jacobian", SUMS, "np.cumsum(w[::-1])[::-1]", "np.cumsum(w)[::-1]"),
    ("scara", "fk", HEIGHT, "COLUMN_MM/1000", "COLUMN_MM//1000"),
    ("planar2r", "lagrangian", PLANE, "2.0*z1.imag + 1.5*z2.imag", "2.0*z1.real + 1.5*z2.real"),
    ("spatial3r", "jacobian_dot", RATES, "np.cross(z3d, pe - p3) + np.cross(z3, ve - v3)",
     "np.cross(z3, ve - v3)"),
]  # fmt: skip


@pytest.mark.parametrize(("robot", "quantity", "text", "right", "slip"), MORE)
def test_what_is_put_or_kept_otherwise(robot, quantity, text, right, slip, tmp_path) -> None:
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")
