"""What is left out of a recursion or a sum, and single slips in rows, loops and quadrants.

Every program is right before its slips, which its verdict tells first; what is said makes it right.
"""

from __future__ import annotations

import pytest
from hand_programs import repaired, with_slips, written

import kinlab as kl

ENERGY = """
import numpy as np

hp = np.pi/2
ROWS = [(0.0, 0.412, 0.0, -hp), (0.0, 0.154, 0.0, hp), (-hp, 0.0, 0.0203, 0.0),
        (0.0, 0.0, 0.0, -hp), (0.0, 0.0, 0.0, hp), (0.0, 0.263, 0.0, 0.0)]
MASS = [9.29, 5.01, 4.25, 1.08, 0.63, 0.51]
COM = np.array([[0, 0.0175, -0.1105], [0, -0.1054, 0], [0, 0, -0.6447],
                [0, 0.0092, -0.0054], [0, 0, 0.0566], [0, 0, 0.1554]])
INERTIA = [(0.276, 0.255, 0.071), (0.108, 0.018, 0.1), (2.51, 2.51, 0.006),
           (0.002, 0.001, 0.001), (0.003, 0.003, 0.0004), (0.013, 0.013, 0.0003)]
ROTOR = [0.953, 2.193, 0.782, 0.106, 0.097, 0.02]

def f(q, qd):
    R, w, v = np.eye(3), np.zeros(3), np.zeros(3)
    total = 0.0
    for i, (th, d, a, al) in enumerate(ROWS):
        z = R[:, 2]
        if i == 2:
            d = d + q[i]
            v = v + qd[i]*z
        else:
            th = th + q[i]
            w = w + qd[i]*z
        ct, st, ca, sa = np.cos(th), np.sin(th), np.cos(al), np.sin(al)
        r = R @ np.array([a*ct, a*st, d])
        R = R @ np.array([[ct, -st*ca, st*sa], [st, ct*ca, -ct*sa], [0, sa, ca]])
        v = v + np.cross(w, r)
        vc = v + np.cross(w, R @ COM[i])
        wl = R.T @ w
        total += 0.5*MASS[i]*vc @ vc
        total += 0.5*wl @ (np.array(INERTIA[i])*wl)
        total += 0.5*ROTOR[i]*qd[i]**2
    return total
"""
LEGS = """
import numpy as np

l1, l2, e = 0.3, 0.5, 0.2/np.sqrt(2)
mc, rc, Ic = 1.0, 0.15, 1.0*0.3**2/12
mr, rr, Ir = 0.4, 0.25, 0.4*0.5**2/12
mp = 1.0
grav = np.array([0.0, -9.81])

def perp(u):
    return np.array([-u[1], u[0]])

def leg(A, p, v, a, mode):
    d = p - A
    r = np.hypot(d[0], d[1])
    cosine = (r**2 + l1**2 - l2**2)/(2*l1*r)
    th = np.arctan2(d[1], d[0]) - mode*np.arccos(cosine)
    u = np.array([np.cos(th), np.sin(th)])
    w = (d - l1*u)/l2
    s = u[0]*w[1] - u[1]*w[0]
    Jt, Jp = w/(l1*s), -u/(l2*s)
    td, pd = Jt @ v, Jp @ v
    tdd = Jt @ a + (l1*td**2*(u @ w) + l2*pd**2)/(l1*s)
    pdd = Jp @ a - (l1*td**2 + l2*pd**2*(u @ w))/(l2*s)
    Q = (Ic + mc*rc**2)*tdd*Jt
    Q = Q - mc*rc*(grav @ perp(u))*Jt
    ac = l1*(tdd*perp(u) - td**2*u) + rr*(pdd*perp(w) - pd**2*w)
    Jc = l1*np.outer(perp(u), Jt) + rr*np.outer(perp(w), Jp)
    Q = Q + mr*Jc.T @ (ac - grav) + Ir*pdd*Jp
    return Jt, Q

def f(xy, v, a, mode):
    J1, Q1 = leg(np.array([e, 0.0]), xy, v, a, mode[0])
    J2, Q2 = leg(np.array([-e, 0.0]), xy, v, a, mode[1])
    Q = Q1 + Q2 + mp*(a - grav)
    J = np.array([J1, J2])
    return np.linalg.solve(J.T, Q)
"""
SYMBOLS = """
import numpy as np

L, LC, M, I = [0.5, 0.4, 0.25], [0.25, 0.2, 0.125], [3.0, 2.0, 1.0], [0.0625, 0.08/3, 0.0625/12]

def mass(q):
    th = np.cumsum(q)
    D = np.zeros((3, 3))
    for i in range(3):
        J = np.zeros((2, 3))
        for j in range(i + 1):
            for k in range(j, i + 1):
                l = LC[k] if k == i else L[k]
                J[:, j] += [-l*np.sin(th[k]), l*np.cos(th[k])]
        w = np.array([1.0]*(i + 1) + [0.0]*(2 - i))
        D += M[i]*J.T @ J + I[i]*np.outer(w, w)
    return D

def f(q, qd):
    h, n = 1e-5, 3
    dD = np.zeros((n, n, n))
    for k in range(n):
        e = np.zeros(n)
        e[k] = h
        dD[:, :, k] = (mass(q + e) - mass(q - e))/(2*h)
    C = np.zeros((n, n))
    for i in range(n):
        for j in range(n):
            for k in range(n):
                C[i, j] += 0.5*(dD[i, j, k] + dD[i, k, j] - dD[j, k, i])*qd[k]
    return C
"""
BASED = """
import numpy as np
from numpy import sin, cos, zeros, pi

d = [0.089159, 0, 0, 0.10915, 0.09465, 0.0823]
a = [0, -0.425, -0.39225, 0, 0, 0]
alpha = [pi/2, 0, 0, pi/2, -pi/2, 0]

def dh(theta, d, a, alpha):
    ct, st, ca, sa = cos(theta), sin(theta), cos(alpha), sin(alpha)
    return np.array([[ct, -st*ca, st*sa, a*ct], [st, ct*ca, -ct*sa, a*st],
                     [0, sa, ca, d], [0, 0, 0, 1]])

def f(q):
    T = zeros((4, 4, 7))
    T[:, :, 0] = np.diag([-1.0, -1.0, 1.0, 1.0])
    for k in range(6):
        T[:, :, k + 1] = T[:, :, k] @ dh(q[k], d[k], a[k], alpha[k])
    tip = T[0:3, 3, 6]
    J = zeros((6, 6))
    for k in range(6):
        z, p = T[0:3, 2, k], T[0:3, 3, k]
        J[0:3, k] = np.cross(z, tip - p)
        J[3:6, k] = z
    return J
"""
SLIDING = """
import numpy as np

A, ALPHA = [0, 0, 0.0203, 0, 0, 0], [-90, 90, 0, -90, 90, 0]
D, THETA = [0.412, 0.154, 0, 0, 0, 0.263], [0, 0, -90, 0, 0, 0]

def step(i, qi):
    th, al = np.deg2rad(THETA[i]), np.deg2rad(ALPHA[i])
    th, d = (th, qi) if i == 2 else (th + qi, D[i])
    ct, st, ca, sa = np.cos(th), np.sin(th), np.cos(al), np.sin(al)
    return np.array([[ct, -st*ca, st*sa, A[i]*ct], [st, ct*ca, -ct*sa, A[i]*st],
                     [0, sa, ca, d], [0, 0, 0, 1]])

def f(q):
    T = [np.eye(4)]
    for i in range(6):
        T.append(T[-1] @ step(i, q[i]))
    tip = T[6][:3, 3]
    Jv, Jw = np.zeros((3, 6)), np.zeros((3, 6))
    for i in range(6):
        z, p = T[i][:3, 2], T[i][:3, 3]
        if i == 2:
            Jv[:, i] = z
        else:
            Jv[:, i] = np.cross(z, tip - p)
            Jw[:, i] = z
    return np.vstack([Jv, Jw])
"""
WEIGHTS = """
from math import cos
import numpy as np

L1, L2, L3 = 0.5, 0.4, 0.25
LC1, LC2, LC3 = L1/2, L2/2, L3/2
M1, M2, M3 = 3.0, 2.0, 1.0
G = 9.81

def f(q):
    t1, t2, t3 = q
    c1, c12, c123 = cos(t1), cos(t1 + t2), cos(t1 + t2 + t3)
    g3 = M3*G*LC3*c123
    g2 = g3 + M3*G*L2*c12 + M2*G*LC2*c12
    g1 = g2 + M3*G*L1*c1 + M2*G*L1*c1 + M1*G*LC1*c1
    return np.array([g1, g2, g3])
"""
RATES = """
from math import cos, sin

def f(q, v, a):
    l1, l2, m1, m2, g = 0.5, 0.4, 2.0, 1.5, 9.81
    c2, s2 = cos(q[1]), sin(q[1])
    weight = m2*l2*g*cos(q[0] + q[1])
    tau1 = m2*l2**2*(a[0] + a[1]) + m2*l1*l2*c2*(2*a[0] + a[1]) + (m1 + m2)*l1**2*a[0]
    tau1 = tau1 - m2*l1*l2*s2*v[1]**2 - 2*m2*l1*l2*s2*v[0]*v[1]
    tau1 = tau1 + weight + (m1 + m2)*l1*g*cos(q[0])
    tau2 = m2*l1*l2*c2*a[0] + m2*l1*l2*s2*v[0]**2 + weight + m2*l2**2*(a[0] + a[1])
    return [tau1, tau2]
"""
OF_A_CLASS = """
import numpy as np

class Arm:
    d = np.array([0.089159, 0, 0, 0.10915, 0.09465, 0.0823])
    a = np.array([0, -0.425, -0.39225, 0, 0, 0])
    alpha = np.array([1, 0, 0, 1, -1, 0])*np.pi/2

    def joint(self, i, th):
        ct, st = np.cos(th), np.sin(th)
        ca, sa = np.cos(self.alpha[i]), np.sin(self.alpha[i])
        Rz = np.array([[ct, -st, 0, 0], [st, ct, 0, 0], [0, 0, 1, self.d[i]], [0, 0, 0, 1]])
        Rx = np.array([[1, 0, 0, self.a[i]], [0, ca, -sa, 0], [0, sa, ca, 0], [0, 0, 0, 1]])
        return Rz @ Rx

    def forward(self, q):
        T = np.diag([-1.0, -1.0, 1.0, 1.0])
        for i in range(6):
            T = T @ self.joint(i, q[i])
        return T

ARM = Arm()

def f(q):
    return ARM.forward(q)
"""
GENERATED = """
import numpy as np

across = lambda r, F: r[0]*F[1] - r[1]*F[0]

def f(q, wrench):
    F, n = wrench[:2], wrench[5]
    joints, angle = [np.zeros(2)], 0.0
    for length, turn in zip([0.5, 0.4, 0.25], q):
        angle += turn
        joints.append(joints[-1] + length*np.array([np.cos(angle), np.sin(angle)]))
    return np.array([across(joints[-1] - joints[i], F) + n for i in range(3)])
"""
SHARED = """
import numpy as np

S, C = np.sin, np.cos

def f(q):
    L, m = np.array([0.5, 0.4, 0.25]), np.array([3.0, 2.0, 1.0])
    th, M = np.cumsum(q), np.zeros((3, 3))
    e = np.stack([-S(th), C(th)])
    for i in range(3):
        J = np.zeros((2, 3))
        for j in range(i + 1):
            for k in range(j, i + 1):
                arm = L[k]/2 if k == i else L[k]
                J[:, j] += arm*e[:, k]
        w = np.array([1.0 if j <= i else 0.0 for j in range(3)])
        M += m[i]*J.T @ J + m[i]*L[i]**2/12*np.outer(w, w)
    return M
"""
PROGRAMS = {
    "class": ("ur5", "fk", OF_A_CLASS),
    "generated": ("planar3r", "statics", GENERATED),
    "shared": ("planar3r", "mass_matrix", SHARED),
    "energy": ("stanford", "kinetic_energy", ENERGY),
    "legs": ("isotropic", "fivebar_torque", LEGS),
    "symbols": ("planar3r", "coriolis_matrix", SYMBOLS),
    "based": ("ur5", "jacobian", BASED),
    "sliding": ("stanford", "jacobian", SLIDING),
    "weights": ("planar3r", "gravity_torques", WEIGHTS),
    "rates": ("planar2r", "inverse_dynamics", RATES),
}


def told(name: str, slips: list[tuple[str, str]]) -> str:
    """What is said of a wrong program; what is said makes it right."""
    robot, quantity, right = PROGRAMS[name]
    text = with_slips(right, slips)
    found = kl.diagnose(robot, quantity, written(text))
    assert not found.agrees
    assert found.causes, str(found)
    said = found.causes[0].sentence
    if "a line is missing" not in said:
        every = [after["f"] for after in repaired(text, said)]
        assert any(kl.compare(robot, quantity, f).agrees for f in every), said
    return said.replace(" ", "")


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    [
        ("energy", "        v = v + np.cross(w, r)", "        pass"),
        ("energy", "            v = v + qd[i]*z", "            pass"),
        ("legs", "np.arctan2(d[1], d[0])", "np.arctan(d[1]/d[0])"),
        ("legs", "mp*(a - grav)", "mp*a"),
        ("legs", " + Ir*pdd*Jp", ""),
        ("legs", "+ l1**2 - l2**2", "- l1**2 + l2**2"),
        ("symbols", " - dD[j, k, i]", ""),
        ("based", "np.diag([-1.0, -1.0, 1.0, 1.0])", "np.eye(4)"),
        ("based", "np.cross(z, tip - p)", "np.cross(z, p - tip)"),
        ("sliding", "            Jv[:, i] = z", "            Jw[:, i] = z"),
        ("sliding", "[0, 0, -90, 0, 0, 0]", "[0, 0, 90, 0, 0, 0]"),
        ("weights", " + M3*G*L2*c12", ""),
        ("rates", "s2*v[0]*v[1]", "s2*v[0]**2"),
        ("class", "return Rz @ Rx", "return Rx @ Rz"),
        ("class", "np.diag([-1.0, -1.0, 1.0, 1.0])", "np.eye(4)"),
        ("generated", "F) + n for", "F) for"),
        ("shared", "L[k]/2 if k == i else L[k]", "L[k]/2"),
    ],
)
def test_one_slip(name, right, wrong) -> None:
    said = told(name, [(right, wrong)])
    whole = "90shouldbe-90" if "-90" in right and name == "sliding" else right
    assert whole.replace(" ", "") in said, said


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips"),
    [
        ("sliding", [("            Jv[:, i] = z", "            Jw[:, i] = z"),
                     ("[-90, 90, 0, -90, 90, 0]", "[90, 90, 0, -90, 90, 0]")]),
        ("energy", [("        v = v + np.cross(w, r)", "        pass"),
                    ("wl = R.T @ w", "wl = w")]),
        ("legs", [("+ l1**2 - l2**2", "- l1**2 + l2**2"), ("l1*td**2*(u @ w)", "l1*td*(u @ w)")]),
    ],
)  # fmt: skip
def test_two_slips(name, slips) -> None:
    """One leaves no number, one is put where lanes cannot follow, one line is missing."""
    said = told(name, slips)
    for right, _wrong in slips:
        assert right.replace(" ", "") in said or "90" in right, said
