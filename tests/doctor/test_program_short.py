"""Short programs as they are typed from a book: slips that are found at once, in their lines."""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import told_in_its_line, written

import kinlab as kl
from kinlab.doctor.program.grounds.apart import arm_apart
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.read import read
from kinlab.doctor.program.trial import Trial

LAGRANGIAN = """
from math import cos, sin
m1, m2, l1, l2, g = 2.0, 1.5, 0.5, 0.4, 9.81
r1, r2 = l1/2, l2/2

def f(q, qd):
    (a, b), (da, db) = q, qd
    w = da + db
    v = (l1*da)**2 + (r2*w)**2 + 2*l1*r2*da*w*cos(b)
    K = m1*(r1*da)**2/2 + m2*v/2 + m1*l1**2*da**2/24 + m2*l2**2*w**2/24
    return K - m1*g*r1*sin(a) - m2*g*(l1*sin(a) + r2*sin(a + b))
"""
CONGRUENT = """
import numpy as np
l = np.array([0.5, 0.4, 0.25])
m = np.array([3.0, 2.0, 1.0])

def f(q):
    phi = np.cumsum(q)
    H = np.diag(m*l**2/12)
    for i in range(3):
        far = m[i+1:].sum()
        H[i, i] += (m[i]/4 + far)*l[i]**2
        for j in range(i):
            H[i, j] = H[j, i] = (m[i]/2 + far)*l[i]*l[j]*np.cos(phi[i] - phi[j])
    S = np.tril(np.ones((3, 3)))
    return S.T @ H @ S
"""
HEIGHTS = """
import numpy as np
twist = np.radians([90, 0, -90, 90, -90, 0])
a = [0, .4318, .0203, 0, 0, 0]
d = [0, 0, .15005, .4318, 0, 0]
kg = [0, 17.4, 4.8, .82, .34, .09]
at = [[0, 0, 0], [-.3638, .006, .2275], [-.0203, -.0141, .07], [0, .019, 0], [0, 0, 0], [0, 0, .032]]

def f(q):
    T, E = np.eye(4), 0.0
    for i in range(6):
        c, s, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(twist[i]), np.sin(twist[i])
        T = T @ np.array([[c, -s*ca, s*sa, a[i]*c], [s, c*ca, -c*sa, a[i]*s], [0, sa, ca, d[i]], [0, 0, 0, 1]])
        E += 9.81*kg[i]*(T[2, 3] + T[2, :3] @ at[i])
    return E
"""  # fmt: skip
TABLE = """
import numpy as np

def A(theta, d, a, alpha):
    c, s = np.cos(theta), np.sin(theta)
    ca, sa = np.cos(np.radians(alpha)), np.sin(np.radians(alpha))
    return np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])

def f(q):
    return np.array([A(q[0], 0, 0, 90), A(q[1], 0, 0.4318, 0), A(q[2], 0.15005, 0.0203, -90),
                     A(q[3], 0.4318, 0, 90), A(q[4], 0, 0, -90), A(q[5], 0, 0, 0)])
"""
STEP = """
import numpy as np
h = 1e-20

def tensor(xx, yy, zz, xy=0.0, xz=0.0, yz=0.0):
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

I = [np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045]),
     tensor(0.004, 0.012, 0.014, xy=0.001, yz=0.0005)]
a, b, m = [0.0, 0.45, 0.35], [0.0, 0.0, np.pi/2], [3.0, 2.0, 1.2]
p = [[0.20, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]]

def mass(q):
    T, z, o, M = np.eye(4, dtype=complex), [], [], np.zeros((3, 3), dtype=complex)
    for i in range(3):
        ca, sa, c, s = np.cos(b[i]), np.sin(b[i]), np.cos(q[i]), np.sin(q[i])
        T = T @ np.array([[c, -s, 0, a[i]], [s*ca, c*ca, -sa, 0], [s*sa, c*sa, ca, 0], [0, 0, 0, 1]])
        R = T[:3, :3]
        z.append(R[:, 2])
        o.append(T[:3, 3])
        J, W = np.zeros((3, 3), dtype=complex), np.zeros((3, 3), dtype=complex)
        for j in range(i + 1):
            J[:, j] = np.cross(z[j], T[:3, 3] + R @ p[i] - o[j])
            W[:, j] = z[j]
        W = R.T @ W
        M += m[i]*J.T @ J + W.T @ I[i] @ W
    return M

def f(q, v):
    return mass(q + 1j*h*v).imag/h
"""  # fmt: skip
INWARD = """
import numpy as np
from numpy import cross

def R(t):
    return np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])

def f(q, v, a):
    m1, m2, I1, I2 = 2.0, 1.5, 2.0*.5**2/12, 1.5*.4**2/12
    P2, C1, C2 = np.array([.5, 0, 0]), np.array([.25, 0, 0]), np.array([.2, 0, 0])
    w1, w2 = np.array([0, 0, v[0]]), np.array([0, 0, v[0] + v[1]])
    b1, b2 = np.array([0, 0, a[0]]), np.array([0, 0, a[0] + a[1]])
    a1 = R(q[0]).T @ [0, 9.81, 0]
    a2 = R(q[1]).T @ (a1 + cross(b1, P2) + cross(w1, cross(w1, P2)))
    F1 = m1*(a1 + cross(b1, C1) + cross(w1, cross(w1, C1)))
    F2 = m2*(a2 + cross(b2, C2) + cross(w2, cross(w2, C2)))
    n2 = I2*b2 + cross(C2, F2)
    n1 = I1*b1 + n2 + cross(C1, F1) + cross(P2, R(q[1]) @ F2)
    return np.array([n1[2], n2[2]])
"""
SYMBOLS = """
import numpy as np

def f(q, v):
    b = -1.5*0.5*0.4*np.sin(q[1])
    dM = np.zeros((2, 2, 2))
    dM[:, :, 1] = [[2*b, b], [b, 0]]
    C = np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            for k in range(2):
                C[i, j] += 0.5*(dM[i, j, k] + dM[i, k, j] - dM[j, k, i])*v[k]
    return C
"""
AXES = """
import numpy as np

def f(q):
    b = -1.5*0.5*0.4*np.sin(q[1])
    dM = np.zeros((2, 2, 2))
    dM[:, :, 1] = [[2*b, b], [b, 0]]
    return 0.5*(dM + dM.transpose(0, 2, 1) - dM.transpose(2, 0, 1))
"""
SLOPES = """
import numpy as np
r, h, k = 0.5*0.4*2.0, 0.5*0.25*0.5, 0.4*0.25*0.5

def f(q):
    s2, s3, s23 = np.sin(q[1]), np.sin(q[2]), np.sin(q[1] + q[2])
    out = np.zeros((3, 3, 3))
    c11, c12 = -2*r*s2 - 2*h*s23, -r*s2 - h*s23
    c13 = -h*s23
    out[:, :, 1] = [[c11*1.0, c12, c13], [c12, 0, 0], [c13, 0, 0]]
    d11, d12 = -2*h*s23 - 2*k*s3, -h*s23 - 2*k*s3
    d13 = -h*s23 - k*s3
    d22 = -2*k*s3
    d23 = -k*s3
    out[:, :, 2] = [[d11, d12, d13], [d12, d22, d23], [d13, d23, 0]]
    return out
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar2r_rods", "lagrangian", LAGRANGIAN, "+ 2*l1*r2*da", "+ l1*r2*da"),
        ("planar3r", "mass_matrix", CONGRUENT, "S.T @ H @ S", "S @ H @ S.T"),
        ("puma560", "potential_energy", HEIGHTS, "(T[2, 3] + T[2, :3] @ at[i])", "T[2, 3]"),
        ("puma560", "link_transforms", TABLE, "[0, sa, ca, d]", "[0, -sa, ca, d]"),
        ("spatial3r", "mass_matrix_dot", STEP, "m[i]*J.T @ J", "m[i]*J.conj().T @ J"),
        ("spatial3r", "mass_matrix_dot", STEP, "xy=0.001", "xz=0.001"),
        ("planar2r_rods", "inverse_dynamics", INWARD, "F1) + cross(P2, R(q[1]) @ F2)", "F1)"),
        ("planar2r", "coriolis_matrix", SYMBOLS, "dM[j, k, i]", "dM[j, i, k]"),
        ("planar2r", "christoffel", AXES, "dM.transpose(2, 0, 1)", "dM.transpose(1, 2, 0)"),
        ("planar3r", "mass_matrix_derivatives", SLOPES, "d22 = -2*k*s3", "d22 = -k*s3"),
    ],
    ids=[
        "mixed",
        "congruent",
        "height",
        "sign",
        "conjugate",
        "word",
        "moment",
        "symbol",
        "axes",
        "slope",
    ],
)
def test_a_slip_is_told_in_its_line(robot, quantity, text, right, slip, tmp_path):
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")


def test_two_numbers_of_the_arm_that_are_one_stay_one() -> None:
    """The Puma's a2 is its d4: where nothing tells which of them a number is, both go on as one."""
    robot = kl.load("puma560")
    trial = Trial(read(written(TABLE)))
    other = arm_apart(robot, trial, Observed(trial, [(np.zeros(6),)]), masses=False)
    assert other is not None
    links = other.table.links
    assert links[1].a == links[3].d != robot.table.links[1].a
    assert links[2].a / robot.table.links[2].a != links[1].a / robot.table.links[1].a
