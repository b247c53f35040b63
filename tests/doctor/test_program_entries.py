"""Slips in entries: one that is not set, a point for its centre, a number that nothing uses."""

from __future__ import annotations

import pytest
from hand_programs import asked, written

import kinlab as kl

CHRISTOFFEL = """
import numpy as np
m, l, lc = [3.0, 2.0, 1.0], [0.5, 0.4, 0.25], [0.25, 0.2, 0.125]

def slopes(q):
    s2, s3, s23 = np.sin(q[1]), np.sin(q[2]), np.sin(q[1] + q[2])
    h12 = m[1]*l[0]*lc[1] + m[2]*l[0]*l[1]
    h13, h23 = m[2]*l[0]*lc[2], m[2]*l[1]*lc[2]
    D = np.zeros((3, 3, 3))
    D[0, 0, 1] = -2*h12*s2 - 2*h13*s23
    D[0, 0, 2] = -2*h13*s23 - 2*h23*s3
    D[0, 1, 1] = D[1, 0, 1] = -h12*s2 - h13*s23
    D[0, 1, 2] = D[1, 0, 2] = -h13*s23 - 2*h23*s3
    D[0, 2, 1] = D[2, 0, 1] = -h13*s23
    D[0, 2, 2] = D[2, 0, 2] = -h13*s23 - h23*s3
    D[1, 1, 2] = -2*h23*s3
    D[1, 2, 2] = D[2, 1, 2] = -h23*s3
    return D

def f(q, v):
    D = slopes(q)
    C = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                C[i, j] += 0.5*(D[i, j, k] + D[i, k, j] - D[j, k, i])*v[k]
    return C
"""
CRANKS = """
import numpy as np
l1, l2 = 0.3, 0.5
e = 0.2/np.sqrt(2)
H = np.array([[0, 1], [-1, 0]])

def crank(x, y, s, mode):
    A, B = 2*l1*(s*e - x), -2*l1*y
    C = l2**2 - e**2 - l1**2 - x**2 - y**2 + 2*s*e*x
    for sign in (1, -1):
        th = 2*np.arctan2(B + sign*np.sqrt(A**2 + B**2 - C**2), A + C)
        u = np.array([np.cos(th), np.sin(th)])
        w = (np.array([x - s*e, y]) - l1*u)/l2
        if np.sign(u @ H @ w) == mode:
            return u, w

def f(xy, mode):
    J = np.zeros((2, 2))
    for i, s in enumerate((1, -1)):
        u, w = crank(xy[0], xy[1], s, mode[i])
        J[i] = w/(l1*(u @ H @ w))
    return J
"""
CENTRES = """
import numpy as np
a, alpha, d = [0, 0.4318, 0.0203, 0, 0, 0], np.deg2rad([90, 0, -90, 90, -90, 0]), [0, 0, 0.15005, 0.4318, 0, 0]
m = [0, 17.4, 4.8, 0.82, 0.34, 0.09]
rc = np.array([[0, 0, 0], [-0.3638, 0.006, 0.2275], [-0.0203, -0.0141, 0.07], [0, 0.019, 0], [0, 0, 0], [0, 0, 0.032]])

def f(q):
    R, p, V = np.eye(3), np.zeros(3), 0.0
    for i in range(6):
        ct, st, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(alpha[i]), np.sin(alpha[i])
        p = p + R @ np.array([a[i]*ct, a[i]*st, d[i]])
        R = R @ np.array([[ct, -st*ca, st*sa], [st, ct*ca, -ct*sa], [0, sa, ca]])
        c = R @ rc[i]
        V += m[i]*9.81*(p + c)[2]
    return V
"""
STEP = """
import numpy as np
l1, l2, l3 = 0.5, 0.4, 0.25

def f(q):
    s1, c1 = np.sin(q[0]), np.cos(q[0])
    s12, c12 = np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    s123, c123 = np.sin(q.sum()), np.cos(q.sum())
    return np.array([
        [-l1*s1 - l2*s12 - l3*s123, -l2*s12 - l3*s123, -l3*s123],
        [l1*c1 + l2*c12 + l3*c123, l2*c12 + l3*c123, l3*c123],
        [1, 1, 1],
    ])
"""
ABSOLUTE = """
import numpy as np
m, l = np.array([3.0, 2.0, 1.0]), np.array([0.5, 0.4, 0.25])
lever = np.tril(np.tile(l, (3, 1)), -1) + np.diag(l/2)
h, static, I = np.einsum('k,ki,kj->ij', m, lever, lever), m @ lever, m*l**2/12

def fold(t):
    return np.cumsum(t[::-1])[::-1]

def f(q, qd, qdd):
    phi, dphi, ddphi = np.cumsum(q), np.cumsum(qd), np.cumsum(qdd)
    delta = phi[:, None] - phi[None, :]
    H = h*np.cos(delta) + np.diag(I)
    return fold(H @ ddphi + (h*np.sin(delta)) @ dphi**2 + 9.81*static*np.cos(phi))
"""
FORWARD = """
import numpy as np
L, M = [0.5, 0.4, 0.25], [3.0, 2.0, 1.0]

def torques(q, qd, qdd, g):
    th, w, al = np.cumsum(q), np.cumsum(qd), np.cumsum(qdd)
    acc, forces, arms = np.array([0.0, g]), [], []
    for t, wi, ai, l in zip(th, w, al, L):
        u, n = np.array([np.cos(t), np.sin(t)]), np.array([-np.sin(t), np.cos(t)])
        forces.append(acc + l/2*(ai*n - wi**2*u))
        acc = acc + l*(ai*n - wi**2*u)
        arms.append(l*u)
    tau, f, n = np.zeros(3), np.zeros(2), 0.0
    for i in (2, 1, 0):
        r, F = arms[i], M[i]*forces[i]
        n = n + M[i]*L[i]**2/12*al[i] + (r[0]*F[1] - r[1]*F[0])/2 + r[0]*f[1] - r[1]*f[0]
        f = f + F
        tau[i] = n
    return tau

def f(q, qd, tau):
    zero = np.zeros(3)
    bias = torques(q, qd, zero, 9.81)
    D = np.column_stack([torques(q, zero, e, 0.0) for e in np.eye(3)])
    return np.linalg.solve(D, tau - bias)
"""
COLUMNS = """
import numpy as np
pi = np.pi

def dh(th, d, a, al):
    ct, st, ca, sa = np.cos(th), np.sin(th), np.cos(al), np.sin(al)
    return np.array([[ct, -st*ca, st*sa, a*ct], [st, ct*ca, -ct*sa, a*st], [0, sa, ca, d], [0, 0, 0, 1]])

def f(q):
    T = [np.eye(4)]
    for row in [(q[0], 0.412, 0, -pi/2), (q[1], 0.154, 0, pi/2), (-pi/2, q[2], 0.0203, 0),
                (q[3], 0, 0, -pi/2), (q[4], 0, 0, pi/2), (q[5], 0.263, 0, 0)]:
        T.append(T[-1] @ dh(*row))
    z, o, J = [t[:3, 2] for t in T], [t[:3, 3] for t in T], np.zeros((6, 6))
    for i in (0, 1, 3, 4, 5):
        J[:, i] = np.hstack([np.cross(z[i], o[6] - o[i]), z[i]])
    J[:, 2] = np.hstack([z[2], np.zeros(3)])
    return J
"""
BODIES = """
import numpy as np
a, alpha, d = [0, 0.4318, 0.0203, 0, 0, 0], np.deg2rad([90, 0, -90, 90, -90, 0]), [0, 0, 0.15005, 0.4318, 0, 0]
m = [0, 17.4, 4.8, 0.82, 0.34, 0.09]
rc = np.array([[0, 0, 0], [-0.3638, 0.006, 0.2275], [-0.0203, -0.0141, 0.07], [0, 0.019, 0], [0, 0, 0], [0, 0, 0.032]])
I = [(0, 0, 0, 0, 0, 0), (0.13, 0.524, 0.539, 0, 0, 0), (0.0685, 0.0835, 0.015, 0, 0, 0),
     (0.0018, 0.0013, 0.0018, 0, 0, 0), (0.0003, 0.0004, 0.0003, 0, 0, 0), (0.00015, 0.00015, 4e-05, 0, 0, 0)]

def tensor(i):
    return np.array([[i[0], i[3], i[4]], [i[3], i[1], i[5]], [i[4], i[5], i[2]]])

def f(q, qd):
    R, p, w, v, T = np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3), []
    for i in range(6):
        w = w + R[:, 2]*qd[i]
        ct, st, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(alpha[i]), np.sin(alpha[i])
        p_new = p + R @ np.array([a[i]*ct, a[i]*st, d[i]])
        R_new = R @ np.array([[ct, -st*ca, st*sa], [st, ct*ca, -ct*sa], [0, sa, ca]])
        v = v + np.cross(w, p_new - p)
        vc, own = v + np.cross(w, R_new @ rc[i]), R_new.T @ w
        T.append(0.5*m[i]*vc @ vc + 0.5*own @ tensor(I[i]) @ own)
        R, p = R_new, p_new
    return np.array(T)
"""
MIXED = """
import numpy as np
from math import sin, cos

def f(q):
    m1, m2, l1, l2 = 2.0, 1.5, 0.5, 0.4
    lc1, lc2 = l1/2, l2/2
    I1, I2 = m1*l1**2/12, m2*l2**2/12
    d11 = m1*lc1**2 + m2*(l1**2 + lc2**2 + 2*l1*lc2*cos(q[1])) + I1 + I2
    d12 = m2*(lc2**2 + l1*lc2*cos(q[1])) + I2
    return np.array([[d11, d12], [d12, m2*lc2**2 + I2]])
"""
INWARD = """
import numpy as np
from math import sin, cos
l1, l2, m1, m2, g = 0.5, 0.4, 2.0, 1.5, 9.81

def f(q, qd, qdd):
    s1, c1, s2, c2 = sin(q[0]), cos(q[0]), sin(q[1]), cos(q[1])
    w, al = qd[0] + qd[1], qdd[0] + qdd[1]
    a1x, a1y = g*s1 - l1*qd[0]**2, g*c1 + l1*qdd[0]
    a2x, a2y = c2*a1x + s2*a1y - l2*w**2, c2*a1y - s2*a1x + l2*al
    f1y, f2x, f2y = m1*a1y, m2*a2x, m2*a2y
    n2 = l2*f2y
    return np.array([n2 + l1*f1y + l1*c2*f2y + l1*s2*f2x, n2])
"""
WRENCH = """
import numpy as np

def f(q, wrench):
    fx, fy, fz, nx, ny, nz = wrench
    phi = np.cumsum(q)
    x, y = [0.5, 0.4, 0.25]*np.cos(phi), [0.5, 0.4, 0.25]*np.sin(phi)
    return np.array([nz + sum(x[k:])*fy - sum(y[k:])*fx for k in range(3)])
"""
PROGRAMS = {
    "mixed": ("planar2r_rods", "mass_matrix", MIXED),
    "inward": ("planar2r", "inverse_dynamics", INWARD),
    "wrench": ("planar3r", "statics", WRENCH),
    "absolute": ("planar3r", "inverse_dynamics", ABSOLUTE),
    "forward": ("planar3r", "forward_dynamics", FORWARD),
    "columns": ("stanford", "jacobian", COLUMNS),
    "bodies": ("puma560", "link_kinetic_energies", BODIES),
    "symbols": ("planar3r", "coriolis_matrix", CHRISTOFFEL),
    "cranks": ("isotropic", "fivebar_jacobian", CRANKS),
    "centres": ("puma560", "potential_energy", CENTRES),
    "rows": ("planar3r", "planar_jacobian", STEP),
}


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name: str) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.compare(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips", "told"),
    [
        pytest.param("symbols", [("D[0, 2, 1] = D[2, 0, 1] = -h13", "D[0, 2, 1] = -h13")],
                     "should be `D[0, 2, 1] = D[2, 0, 1] = -h13*s23`", id="the entry across"),
        pytest.param("cranks", [("w/(l1*(u @ H @ w))", "w/(u @ H @ w)"), ("(1, -1)):\n        u", "(-1, 1)):\n        u")],
                     "`for i, s in enumerate((-1, 1))` should be", id="the legs, and a length that is used elsewhere"),
        pytest.param("centres", [("(p + c)[2]", "p[2]")], "`V += m[i]*9.81*(p[2] + c[2])`", id="the origin for the centre"),
        pytest.param("mixed", [("2*l1*lc2", "l1*lc2")], "2*l1*lc2*cos(q[1])) + I1", id="the mixed term of a square"),
        pytest.param("mixed", [("m1*l1**2/12", "m1*l1**2/3")], "m1*l1**2/12", id="a rod about its middle"),
        pytest.param("inward", [(" + l1*s2*f2x", "")], "l1*c2*f2y + l1*s2*f2x", id="the part along the other axis"),
        pytest.param("wrench", [("fx, fy, fz, nx, ny, nz =", "nx, ny, nz, fx, fy, fz =")], "`fx, fy, fz, nx, ny, nz = wrench`",
                     id="the halves of a wrench"),
        pytest.param("absolute", [(" + np.diag(I)", " + I")], "np.diag(I)`", id="a row for a diagonal"),
        pytest.param("absolute", [("np.cumsum(t[::-1])[::-1]", "np.cumsum(t)")], "np.cumsum(t[::-1])[::-1]`",
                     id="a sum that runs the other way"),
        pytest.param("forward", [("torques(q, zero, e", "torques(q, qd, e")], "should be `np.column_stack([torques(q, np.zeros(3), e, 0.0)",
                     id="rates in the columns of the mass matrix"),
        pytest.param("columns", [("np.hstack([z[2], np.zeros(3)])", "np.hstack([np.cross(z[2], o[6] - o[2]), z[2]])")],
                     "np.hstack([z[2], np.zeros(3)])", id="a slide's column"),
        pytest.param("bodies", [("[[i[0], i[3], i[4]], [i[3], i[1], i[5]], [i[4], i[5], i[2]]]",
                                 "[[i[0], i[1], i[2]], [i[1], i[3], i[4]], [i[2], i[4], i[5]]]")],
                     "[[i[0], i[3], i[4]], [i[3], i[1], i[5]], [i[4], i[5], i[2]]]", id="the order of a tensor's numbers"),
        pytest.param("bodies", [("p_new - p)", "p_new)")], "np.cross(w, p_new - p)", id="no line that does nothing"),
        pytest.param("rows", [("[1, 1, 1]", "[0, 0, 1]")], "`[0, 0, 1]` should be `[1, 1, 1]`", id="all joints turn the tool"),
    ],
)  # fmt: skip
def test_a_slip_in_an_entry(name: str, slips: list, told: str) -> None:
    robot, quantity, text = PROGRAMS[name]
    for right, slip in slips:
        assert text.count(right) == 1
        text = text.replace(right, slip)
    found, good = asked(text, robot, quantity)
    assert good and told in found.sentence, str(found)


def test_two_numbers_in_front_are_told_as_one() -> None:
    text = """
import numpy as np
m2, l1, l2 = 1.5, 0.5, 0.4

def f(q, v):
    h = -2*m2*l1*l2*np.sin(q[1])
    return np.array([2*h*v[0]*v[1] + h*v[1]**2, -h*v[0]**2])
"""
    assert kl.compare("planar2r", "coriolis_torques", written(text.replace("-2*m2", "-m2"))).agrees
    found, good = asked(text, "planar2r", "coriolis_torques")
    assert good and "should be `h = -m2*l1*l2*np.sin(q[1])`" in found.sentence, str(found)
