"""One slip in all places of a statement, and others that stand in one word of it.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import EXPONENTIALS, asked, with_slips, written

import kinlab as kl

STANFORD = """
import numpy as np
slides = [0, 0, 1, 0, 0, 0]
theta0 = [0, 0, -np.pi/2, 0, 0, 0]
d0 = [0.412, 0.154, 0, 0, 0, 0.263]
a0 = [0, 0, 0.0203, 0, 0, 0]
alpha0 = [-np.pi/2, np.pi/2, 0, -np.pi/2, np.pi/2, 0]

def f(q):
    frames = [np.eye(4)]
    for k in range(6):
        th = theta0[k] + (0 if slides[k] else q[k])
        d = d0[k] + (q[k] if slides[k] else 0)
        c, s, ca, sa = np.cos(th), np.sin(th), np.cos(alpha0[k]), np.sin(alpha0[k])
        frames.append(frames[-1] @ np.array([[c, -s*ca, s*sa, a0[k]*c], [s, c*ca, -c*sa, a0[k]*s],
                                             [0, sa, ca, d], [0, 0, 0, 1]]))
    J = np.zeros((6, 6))
    for k in range(6):
        axis, at = frames[k][:3, 2], frames[k][:3, 3]
        J[:3, k] = axis if slides[k] else np.cross(axis, frames[6][:3, 3] - at)
        J[3:, k] = 0 if slides[k] else axis
    return J
"""
ENERGY = """
import numpy as np

def f(q, qd):
    m, l = np.array([3.0, 2.0, 1.0]), np.array([0.5, 0.4, 0.25])
    phi, w = np.cumsum(q), np.cumsum(qd)
    T = 0.0
    for i in range(3):
        arm = np.append(l[:i], l[i]/2)
        for j in range(i + 1):
            for k in range(i + 1):
                T += 0.5*m[i]*arm[j]*arm[k]*np.cos(phi[j] - phi[k])*w[j]*w[k]
        T += m[i]*l[i]**2/24*w[i]**2
    return T
"""
STACKED = """
import numpy as np
A, ALPHA = np.array([0, 0.45, 0.35]), np.array([0, 0, np.pi/2])
MASS = np.array([3.0, 2.0, 1.2])
COM = np.array([[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]])
TENSOR = np.array([np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045]),
                   [[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]]])

def f(q):
    R, p = np.zeros((4, 3, 3)), np.zeros((4, 3))
    R[0] = np.eye(3)
    for k in range(3):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(ALPHA[k]), np.sin(ALPHA[k])
        p[k+1] = p[k] + R[k] @ [A[k], 0, 0]
        R[k+1] = R[k] @ np.array([[c, -s, 0], [s*ca, c*ca, -sa], [s*sa, c*sa, ca]])
    z = R[1:, :, 2]
    centre = p[1:] + np.einsum('iab,ib->ia', R[1:], COM)
    on = np.tril(np.ones((3, 3)))
    Jw = np.einsum('ij,ja->iaj', on, z)
    Jv = np.einsum('ij,ija->iaj', on, np.cross(z[None], centre[:, None] - p[None, 1:]))
    I = np.einsum('iab,ibc,idc->iad', R[1:], TENSOR, R[1:])
    return np.einsum('i,iaj,iak->jk', MASS, Jv, Jv) + np.einsum('iaj,iab,ibk->jk', Jw, I, Jw)
"""
RATES = """
import numpy as np
A = (0, 0.45, 0.35)
MASS = (3.0, 2.0, 1.2)
COM = ((0.2, 0.02, -0.01), (0.15, -0.01, 0.03), (0.12, 0.03, 0.01))
TENSOR = (np.diag((0.02, 0.08, 0.07)), np.diag((0.01, 0.04, 0.045)),
          np.array(((0.004, 0.001, 0), (0.001, 0.012, 0.0005), (0, 0.0005, 0.014))))

def turned(q):
    R, p, found = np.eye(3), np.zeros(3), []
    for k in range(3):
        p = p + R[:, 0]*A[k]
        if k == 2:
            R = R @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
        c, s = np.cos(q[k]), np.sin(q[k])
        R = R @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        found.append((R, p))
    return found

def torques(q, v, a, g):
    w, dw, acc, before = np.zeros(3), np.zeros(3), np.array([0, 0, g]), np.zeros(3)
    loads, frames = [], turned(q)
    for k, (R, p) in enumerate(frames):
        step = p - before
        acc = acc + np.cross(dw, step) + np.cross(w, np.cross(w, step))
        z = R[:, 2]
        dw = dw + a[k]*z + np.cross(w, v[k]*z)
        w = w + v[k]*z
        c = R @ COM[k]
        I = R @ TENSOR[k] @ R.T
        force = MASS[k]*(acc + np.cross(dw, c) + np.cross(w, np.cross(w, c)))
        loads.append((p + c, force, I @ dw + np.cross(w, I @ w)))
        before = p
    return np.array([R[:, 2] @ sum(n + np.cross(x - p, F) for x, F, n in loads[k:])
                     for k, (R, p) in enumerate(frames)])

def f(q, v, tau):
    still = np.zeros(3)
    M = np.column_stack([torques(q, still, e, 0.0) for e in np.eye(3)])
    return np.linalg.solve(M, tau - torques(q, v, still, 9.81))
"""
STEPS = """
import numpy as np
links = [(0.0, 0.0, 3.0, [0.2, 0.02, -0.01], np.diag([0.02, 0.08, 0.07])),
         (0.45, 0.0, 2.0, [0.15, -0.01, 0.03], np.diag([0.01, 0.04, 0.045])),
         (0.35, np.pi/2, 1.2, [0.12, 0.03, 0.01],
          np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]]))]

def inner(q, u, v):
    total, wu, wv, pu, pv = 0.0, np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    for k, (a, alpha, m, c, I) in enumerate(links):
        ct, st, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(alpha), np.sin(alpha)
        E = np.array([[ct, -st, 0], [st*ca, ct*ca, -sa], [st*sa, ct*sa, ca]]).T
        pu, pv = E @ (pu + np.cross(wu, [a, 0, 0])), E @ (pv + np.cross(wv, [a, 0, 0]))
        wu, wv = E @ wu + [0, 0, u[k]], E @ wv + [0, 0, v[k]]
        total += m*(pu + np.cross(wu, c)) @ (pv + np.cross(wv, c)) + wu @ I @ wv
    return total

def mass(q):
    return np.array([[inner(q, u, v) for v in np.eye(3)] for u in np.eye(3)])

def f(q, qd):
    h, D = 1e-3, np.zeros((3, 3, 3))
    for k in range(3):
        e = h*np.eye(3)[k]
        D[:, :, k] = (mass(q - 2*e) - 8*mass(q - e) + 8*mass(q + e) - mass(q + 2*e))/(12*h)
    C = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                C[i, j] += 0.5*(D[i, j, k] + D[i, k, j] - D[j, k, i])*qd[k]
    return C
"""
LINKS = """
import numpy as np

class Link:
    def __init__(self, a, l, m, I):
        self.a, self.l, self.m, self.I = a, l, m, I

ARM = [Link(0.5, 0.25, 3.0, 0.0625), Link(0.4, 0.2, 2.0, 0.08/3), Link(0.25, 0.125, 1.0, 0.0625/12)]
z = np.array([0.0, 0.0, 1.0])

def f(q):
    th, at, M = np.cumsum(q), [np.zeros(3)], np.zeros((3, 3))
    for k, link in enumerate(ARM):
        at.append(at[-1] + link.a*np.array([np.cos(th[k]), np.sin(th[k]), 0.0]))
    for k, link in enumerate(ARM):
        c = at[k] + link.l*np.array([np.cos(th[k]), np.sin(th[k]), 0.0])
        Jv, Jw = np.zeros((3, 3)), np.zeros((3, 3))
        for j in range(k + 1):
            Jv[:, j] = np.cross(z, c - at[j])
            Jw[:, j] = z
        M += link.m*Jv.T @ Jv + link.I*Jw.T @ Jw
    return M
"""
ABSOLUTE = """
import numpy as np
m1, m2, m3 = 3.0, 2.0, 1.0
a1, a2, a3 = 0.5, 0.4, 0.25

def f(q, qd, tau):
    p1, p2, p3 = q[0], q[0] + q[1], q[0] + q[1] + q[2]
    w1, w2, w3 = qd[0], qd[0] + qd[1], qd[0] + qd[1] + qd[2]
    k12, k13, k23 = (m2/2 + m3)*a1*a2, m3/2*a1*a3, m3/2*a2*a3
    A = np.array([[(m1/3 + m2 + m3)*a1**2, k12*np.cos(p1 - p2), k13*np.cos(p1 - p3)],
                  [k12*np.cos(p1 - p2), (m2/3 + m3)*a2**2, k23*np.cos(p2 - p3)],
                  [k13*np.cos(p1 - p3), k23*np.cos(p2 - p3), m3/3*a3**2]])
    b1 = k12*np.sin(p1 - p2)*w2**2 + k13*np.sin(p1 - p3)*w3**2
    b2 = -k12*np.sin(p1 - p2)*w1**2 + k23*np.sin(p2 - p3)*w3**2
    b3 = -k13*np.sin(p1 - p3)*w1**2 - k23*np.sin(p2 - p3)*w2**2
    u = np.array([tau[0] - tau[1], tau[1] - tau[2], tau[2]])
    G = 9.81*np.array([(m1/2 + m2 + m3)*a1*np.cos(p1), (m2/2 + m3)*a2*np.cos(p2),
                       m3/2*a3*np.cos(p3)])
    x = np.linalg.solve(A, u - G - np.array([b1, b2, b3]))
    return np.array([x[0], x[1] - x[0], x[2] - x[1]])
"""

WHOLE = """
from numpy import array, cos

def f(q):
    m1, m2, m3 = 3, 2, 1
    l1, l2, l3 = .5, .4, .25
    r1, r2, r3 = l1/2, l2/2, l3/2
    c2, c3, c23 = cos(q[1]), cos(q[2]), cos(q[1] + q[2])
    C = m3*l3**2/12 + m3*r3**2
    B = m2*l2**2/12 + m2*r2**2 + m3*l2**2 + 2*m3*l2*r3*c3 + C
    A = m1*l1**2/12 + m1*r1**2 + (m2 + m3)*l1**2 + 2*m2*l1*r2*c2
    A += 2*m3*l1*(l2*c2 + r3*c23) + B
    D, E = C + m3*l2*r3*c3, C + m3*l2*r3*c3 + m3*l1*r3*c23
    F = B + m2*l1*r2*c2 + m3*l1*(l2*c2 + r3*c23)
    return array([[A, F, E], [F, B, D], [E, D, C]])
"""
TURNS = """
import numpy as np

class Arm:
    A = (0, 0, 0, 0.0825, -0.0825, 0, 0.088)
    D = (0.333, 0, 0.316, 0, 0.384, 0, 0)
    ALPHA = np.deg2rad([0, -90, 90, 90, -90, 90, 90])

    @staticmethod
    def rot_x(t):
        c, s = np.cos(t), np.sin(t)
        return np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])

    @staticmethod
    def rot_z(t):
        c, s = np.cos(t), np.sin(t)
        return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])

    @staticmethod
    def moved(x, z):
        T = np.eye(4)
        T[0, 3], T[2, 3] = x, z
        return T

    def pose(self, q):
        T = np.eye(4)
        for k in range(7):
            T = T @ self.rot_x(self.ALPHA[k]) @ self.moved(self.A[k], 0)
            T = T @ self.rot_z(q[k]) @ self.moved(0, self.D[k])
        return T @ self.moved(0, 0.107)

f = Arm().pose
"""
HEIGHTS = """
import numpy as np
A, ALPHA = np.array([0, 0.45, 0.35]), np.array([0, 0, np.pi/2])
MASS = [3.0, 2.0, 1.2]
COM = [[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]]

def f(q):
    T, frames = np.eye(4), []
    for k in range(3):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(ALPHA[k]), np.sin(ALPHA[k])
        T = T @ np.array([[c, -s, 0, A[k]], [s*ca, c*ca, -sa, 0], [s*sa, c*sa, ca, 0], [0, 0, 0, 1]])
        frames.append(T)
    tau = np.zeros(3)
    for k in range(3):
        p = (frames[k] @ np.r_[COM[k], 1])[:3]
        for j in range(k + 1):
            tau[j] += MASS[k]*9.81*np.cross(frames[j][:3, 2], p - frames[j][:3, 3])[2]
    return tau
"""

ROWS = """
from math import sin, cos

def f(q):
    r1, r2, r3 = 0.5, 0.4, 0.25
    a, b, c = q[0], q[0] + q[1], q[0] + q[1] + q[2]
    return [
        [-r1*sin(a) - r2*sin(b) - r3*sin(c), -r2*sin(b) - r3*sin(c), -r3*sin(c)],
        [r1*cos(a) + r2*cos(b) + r3*cos(c), r2*cos(b) + r3*cos(c), r3*cos(c)],
        [1, 1, 1],
    ]
"""
TABLE = """
import numpy as np

def turned(angle, twist, a, d):
    c, s, ca, sa = np.cos(angle), np.sin(angle), np.cos(twist), np.sin(twist)
    return np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])

def f(q):
    table = [(q[0], -np.pi/2, 0, 0.412), (q[1], np.pi/2, 0, 0.154), (-np.pi/2, 0, 0.0203, q[2]),
             (q[3], -np.pi/2, 0, 0), (q[4], np.pi/2, 0, 0), (q[5], 0, 0, 0.263)]
    T = np.eye(4)
    for row in table:
        T = T @ turned(*row)
    return T
"""
ABSOLUTE_MASSES = """
import numpy as np

def f(q):
    m, l = np.array([3.0, 2.0, 1.0]), np.array([0.5, 0.4, 0.25])
    c = l/2
    K = np.diag(m*l**2/12 + m*c**2)
    for i in range(3):
        K[i, i] += l[i]**2*m[i + 1:].sum()
        for j in range(i + 1, 3):
            K[i, j] = K[j, i] = l[i]*(m[j]*c[j] + l[j]*m[j + 1:].sum())
    th = np.cumsum(q)
    B = np.tril(np.ones((3, 3)))
    return B.T @ (K*np.cos(th[:, None] - th)) @ B
"""
SUMS = """
import numpy as np
LENGTHS = np.array([0.5, 0.4, 0.25])

def f(q):
    th = np.cumsum(q)
    up, on = LENGTHS*np.cos(th), -LENGTHS*np.sin(th)
    J = np.ones((3, 3))
    for k in range(3):
        J[0, k] = on[k:].sum()
        J[1, k] = up[k:].sum()
    return J
"""
TWISTS = """
import numpy as np
ROWS = [(0.0, 0.0), (0.0, 0.45), (np.pi/2, 0.35)]

def f(q):
    T = np.eye(4)
    for (al, a), th in zip(ROWS, q):
        c, s, ca, sa = np.cos(th), np.sin(th), np.cos(al), np.sin(al)
        T = T @ np.array([[c, -s, 0, a], [s*ca, c*ca, -sa, 0], [s*sa, c*sa, ca, 0], [0, 0, 0, 1.0]])
    T[:3, 3] += 0.3*T[:3, 0]
    return T
"""
ROD = """
from math import cos

def f(q, v, tau):
    mass, length = 2.5, 0.6
    about = mass*length**2/12 + mass*(length/2)**2
    return [(tau[0] - mass*9.81*length/2*cos(q[0]))/about]
"""
STEPS_OF_FOUR = """
import numpy as np
D = (0.412, 0.154, 0, 0, 0, 0.263)
AL = (-np.pi/2, np.pi/2, 0, -np.pi/2, np.pi/2, 0)

def f(q):
    T = np.eye(4)
    for k in range(6):
        slide = k == 2
        c, s = np.cos(-np.pi/2 if slide else q[k]), np.sin(-np.pi/2 if slide else q[k])
        T = T @ np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, q[k] if slide else D[k]], [0, 0, 0, 1]])
        c, s = np.cos(AL[k]), np.sin(AL[k])
        T = T @ np.array([[1, 0, 0, 0.0203 if slide else 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])
    return T
"""
_CASES = [
    (ROD, "single_link", "forward_dynamics", [("(length/2)**2", "(length/2)")]),
    (STEPS_OF_FOUR, "stanford", "fk", [("[0, c, -s, 0], [0, s, c, 0]", "[0, c, s, 0], [0, -s, c, 0]")]),
    (ABSOLUTE_MASSES, "planar3r", "mass_matrix", [("l[j]*m[j + 1:]", "l[j]*m[j:]")]),
    (SUMS, "planar3r", "planar_jacobian", [("on[k:]", "on[:k + 1]"), ("= up[k:]", "= on[k:]")]),
    (ROWS, "planar3r", "planar_jacobian", [(" -r2*sin(b) - r3*sin(c), -r3", " -r1*sin(a) - r3*sin(c), -r3")]),
    (ROWS, "planar3r", "planar_jacobian", [(" r2*cos(b) + r3*cos(c), r3", " r2*cos(b) + r1*cos(a), r3")]),
    (TABLE, "stanford", "fk", [("(q[3], -np.pi/2", "(q[3], -90")]),
    (TABLE, "stanford", "fk", [("(-np.pi/2, 0, 0.0203", "(-90, 0, 0.0203")]),
    (WHOLE, "planar3r", "mass_matrix", [("(m2 + m3)*l1**2", "m2*l1**2")]),
    (WHOLE, "planar3r", "mass_matrix", [("2*m3*l2*r3*c3", "m3*l2*r3*c3")]),
    (TURNS, "panda", "fk", [("self.rot_x(self.ALPHA[k])", "self.rot_z(self.ALPHA[k])")]),
    (HEIGHTS, "spatial3r", "gravity_torques", [("np.r_[COM[k], 1]", "np.r_[COM[k], 0]")]),
    (STANFORD, "stanford", "jacobian", [("= 0 if slides[k] else axis", "= axis")]),
    (STANFORD, "stanford", "jacobian", [("axis if slides[k] else np.cross", "np.cross")]),
    (ENERGY, "planar3r", "kinetic_energy", [("phi[j] - phi[k]", "q[j] - q[k]")]),
    (
        STACKED,
        "spatial3r",
        "mass_matrix",
        [("R[1:], TENSOR, R[1:]", "R[:3], TENSOR, R[:3]")],
    ),
    (RATES, "spatial3r", "forward_dynamics", [(" + np.cross(w, v[k]*z)", "")]),
    (
        RATES,
        "spatial3r",
        "forward_dynamics",
        [("[0, 0, -1], [0, 1, 0]", "[0, 0, 1], [0, -1, 0]"), (" + np.cross(w, v[k]*z)", "")],
    ),
    (RATES, "spatial3r", "forward_dynamics", [("np.cross(w, I @ w)", "np.cross(I @ w, w)")]),
    (
        STEPS,
        "spatial3r",
        "coriolis_matrix",
        [("np.cross(wv, [a, 0, 0])", "np.cross(wu, [a, 0, 0])")],
    ),
    (LINKS, "planar3r", "mass_matrix", [("link.l*", "link.a*"), ("range(k + 1)", "range(k)")]),
    (ABSOLUTE, "planar3r", "forward_dynamics", [("tau[1] - tau[2], tau", "tau[1], tau")]),
    (
        ABSOLUTE,
        "planar3r",
        "forward_dynamics",
        [("k12, k13, k23 = (m2/2 + m3)", "k12, k13, k23 = (m2/2 + m3/2)"),
         ("tau[1] - tau[2], tau", "tau[1], tau")],
    ),
]  # fmt: skip


@pytest.mark.many
@pytest.mark.parametrize(("text", "robot", "quantity", "slips"), _CASES)
def test_it_is_told(text, robot, quantity, slips, tmp_path) -> None:
    assert kl.diagnose(robot, quantity, written(text)).agrees
    found, good = asked(with_slips(text, slips), robot, quantity, tmp_path / "hand.py")
    assert good, found.sentence


def _told(text, robot, quantity, slip, file) -> str:
    wrong = with_slips(text, [slip])
    file.write_text(wrong)
    return kl.diagnose(robot, quantity, written(wrong, file)).sentence


def test_a_cross_product_the_wrong_way_about_is_told_as_it_is(tmp_path) -> None:
    slip = ("np.cross(w, I @ w)", "np.cross(I @ w, w)")
    told = _told(RATES, "spatial3r", "forward_dynamics", slip, tmp_path / "hand.py")
    assert "np.cross(w, I @ w)" in told.split("should be")[1]


def test_a_name_goes_before_the_sum_that_it_is(tmp_path) -> None:
    file = tmp_path / "hand.py"
    text = ENERGY.replace("arm[j]*arm[k]", "reach*arm[k]").replace(
        "            for k in range(i + 1):", "            reach = arm[j]*1.0\n"
        "            for k in range(i + 1):")  # fmt: skip
    told = _told(text, "planar3r", "kinetic_energy", ("reach*arm[k]", "arm[k]*arm[k]"), file)
    assert "reach" in told.split("should be")[1]


def test_a_rotation_is_transposed_and_no_row_times_it(tmp_path) -> None:
    slip = ("c = R @ COM[k]", "c = R.T @ COM[k]")
    told = _told(RATES, "spatial3r", "forward_dynamics", slip, tmp_path / "hand.py")
    assert "R @ COM[k]" in told.split("should be")[1]


def test_whole_masses_with_names_are_the_arm_s(tmp_path) -> None:
    slip = ("(m2 + m3)*l1**2", "m2*l1**2")
    told = _told(WHOLE, "planar3r", "mass_matrix", slip, tmp_path / "hand.py")
    assert "m3" in told.split("should be")[1]  # m1 is 3, too


def test_a_twist_in_degrees_that_nobody_turns_is_told(tmp_path) -> None:
    slip = ("(np.pi/2, 0.35)", "(90, 0.35)")
    told = _told(TWISTS, "spatial3r", "fk", slip, tmp_path / "hand.py")
    assert "ROWS[2][0], degrees are taken for radians: 90 should be 1.5708" in told


TURNED = """
import numpy as np

def f(q, qd):
    V = np.zeros((2, 6))
    V[0, 5] = qd[0]
    v = np.array([0.0, 0.5*qd[0]])
    c, s = np.cos(q[1]), np.sin(q[1])
    R = np.array([[c, -s], [s, c]])
    V[1, :2] = R.T @ v
    V[1, 5] = qd[0] + qd[1]
    return V
"""
COLUMNS = """
import numpy as np

def f(q):
    c, s = np.cos(q[0]), np.sin(q[0])
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    Jv, Jw = np.array([[-0.6*s], [0.6*c], [0.0]]), np.array([[0.0], [0.0], [1.0]])
    return np.vstack([R.T @ Jv, R.T @ Jw])
"""


def test_the_tool_at_home_is_a_sum_of_lengths(tmp_path) -> None:
    """The last number of a product of exponentials is of no column: it was held against it."""
    right = "(1 - np.cos(theta))*W + (theta - np.sin(theta))*W @ W"
    wrong = "(theta - np.sin(theta))*W + (1 - np.cos(theta))*W @ W"
    told = _told(EXPONENTIALS, "planar2r", "fk", (right, wrong), tmp_path / "hand.py")
    assert right in told.split("should be")[1]


@pytest.mark.parametrize(
    ("text", "robot", "quantity", "wrong", "line"),
    [
        (TURNED, "planar2r_rods", "link_velocities", "R @ v", "line 10"),
        (COLUMNS, "single_link", "jacobian_tool", "R @ Jv", "line 8"),
    ],
)
def test_a_right_rotation_or_column_is_not_spoilt(
    text, robot, quantity, wrong, line, tmp_path
) -> None:
    """Where the vector has one coordinate alone another sign in the matrix does as well."""
    right = wrong.replace("R @", "R.T @")
    told = _told(text, robot, quantity, (right, wrong), tmp_path / "hand.py")
    assert f"{line}, the transpose" in told
    assert right in told.split("should be")[1]


ROTORS = """
import numpy as np
from math import cos, sin
l1, l2 = 0.325, 0.275
m1, m2, m3, m4 = 7.0, 5.0, 1.2, 0.4
x2, y2, e = 0.145, -0.005, 0.01
J = [0.3, 0.1, 2.0, 0.02]
I1, I2, I3, I4 = 0.1, 0.055, 0.0008, 0.0006

def f(q):
    a4 = I4 + m4*e**2
    k2 = I2 + I3 + m2*(x2**2 + y2**2) + (m3 + m4)*l2**2
    b = m4*e*l2*cos(q[3])
    u = l1*(m2*(x2*cos(q[1]) - y2*sin(q[1])) + (m3 + m4)*l2*cos(q[1]))
    w = l1*m4*e*cos(q[1] - q[3])
    h22 = k2 + a4 + 2*b
    h12 = h22 + u + w
    h11 = I1 + m1*0.165**2 + (m2 + m3 + m4)*l1**2 + h22 + 2*(u + w)
    h24, h14 = -(a4 + b), -(a4 + b + w)
    return np.array([[h11 + J[0], h12, 0, h14], [h12, h22 + J[1], 0, h24],
                     [0, 0, m3 + m4 + J[2], 0], [h14, h24, 0, a4 + J[3]]])
"""


@pytest.mark.parametrize(
    "slips",
    [
        [("-(a4 + b + w)", "a4 + b + w")],
        [("-(a4 + b + w)", "a4 + b + w"), ("(m2 + m3 + m4)*l1**2", "(m2 + m3 + m4)*l1")],
    ],
)
def test_inertias_of_rotors_in_a_list_are_no_link_s(slips, tmp_path) -> None:
    """One of them is the first link's, too: no other arm was right with the repair."""
    found, good = asked(with_slips(ROTORS, slips), "scara", "mass_matrix", tmp_path / "hand.py")
    assert good, found.sentence
