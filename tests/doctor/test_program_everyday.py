"""Slips of the most ordinary kind: a counter, a sine, a key, a term, a sign, forgotten or exchanged.

Every program is right before its slip, which its verdict tells first; what is said makes it right.
"""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line, with_slips, written

import kinlab as kl

LEGS = """
import numpy as np

L1 = (0.30, 0.26)
L2 = (0.50, 0.54)
E = 0.12

def leg(i, x, y):
    base = E if i == 0 else -E
    A = 2*L1[i]*(x - base)
    B = 2*L1[i]*y
    C = (x - base)**2 + y**2 + L1[i]**2 - L2[i]**2
    return A, B, C

def f(xy, mode):
    x, y = xy
    theta = np.zeros(2)
    for i in range(2):
        A, B, C = leg(i, x, y)
        root = np.sqrt(A**2 + B**2 - C**2)
        theta[i] = 2*np.arctan2(B - mode[i]*root, A + C)
    return np.arctan2(np.sin(theta), np.cos(theta))
"""
MILLIMETRES = """
import math

HALF_BASE, L = 59, 90

def f(theta, xy):
    x, y = 1000*xy[0], 1000*xy[1]
    x1 = HALF_BASE + L*math.cos(theta[0])
    y1 = L*math.sin(theta[0])
    x2 = -HALF_BASE + L*math.cos(theta[1])
    y2 = L*math.sin(theta[1])
    g1 = (x - x1)**2 + (y - y1)**2 - L**2
    g2 = (x - x2)**2 + (y - y2)**2 - L**2
    return [g1/1e6, g2/1e6]
"""
FORWARD = """
import numpy as np
from math import cos, sin

m1, m2, L1, L2, g = 2.0, 1.5, 0.5, 0.4, 9.81

def f(q, qd, tau):
    th1, th2 = q
    c2 = cos(th2)
    M11 = (m1 + m2)*L1**2 + m2*L2**2 + 2*m2*L1*L2*c2
    M12 = m2*L2**2 + m2*L1*L2*c2
    M22 = m2*L2**2
    h = m2*L1*L2*sin(th2)
    b1 = -h*(2*qd[0]*qd[1] + qd[1]**2) + (m1 + m2)*g*L1*cos(th1) + m2*g*L2*cos(th1 + th2)
    b2 = h*qd[0]**2 + m2*g*L2*cos(th1 + th2)
    return np.linalg.solve([[M11, M12], [M12, M22]], [tau[0] - b1, tau[1] - b2])
"""
QUILL = """
import numpy as np

DH = [(0.387, 0.325, 0.0), (0.0, 0.275, np.pi), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
SLIDE = (False, False, True, False)
MASS = (7.0, 5.0, 1.2, 0.4)
COM = ((-0.16, 0, 0.02), (-0.13, 0.005, -0.03), (0, 0, -0.05), (0.01, 0, -0.01))
IZ = (0.1, 0.055, 0.0008, 0.0006)
ROTOR = (0.3, 0.1, 2.0, 0.02)

def geometry(q):
    R, p, out = np.eye(3), np.zeros(3), []
    for (d, a, alpha), slide, qi in zip(DH, SLIDE, q):
        th, d = (0.0, d + qi) if slide else (qi, d)
        z, start = R[:, 2], p
        c, s, ca, sa = np.cos(th), np.sin(th), np.cos(alpha), np.sin(alpha)
        p = p + R @ [a*c, a*s, d]
        R = R @ np.array([[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]])
        out.append((z, start, R, p))
    return out

def torques(geo, v, a, g):
    w, wd, vd = 0.0, 0.0, np.array([0, 0, g])
    tau = np.array(ROTOR)*a
    for k, (z, start, R, p) in enumerate(geo):
        if SLIDE[k]:
            vd = vd + z*a[k]
        else:
            w, wd = w + z[2]*v[k], wd + z[2]*a[k]
        k_ = np.array([0, 0, 1.0])
        vd = vd + wd*np.cross(k_, p - start) - w*w*np.array([*(p - start)[:2], 0])
        rc = R @ COM[k]
        f = MASS[k]*(vd + wd*np.cross(k_, rc) - w*w*np.array([*rc[:2], 0]))
        n = np.array([0, 0, IZ[k]*wd])
        for j in range(k + 1):
            zj, oj = geo[j][0], geo[j][1]
            tau[j] += zj @ f if SLIDE[j] else zj @ (n + np.cross(p + rc - oj, f))
    return tau

def f(q, v, tau):
    geo = geometry(q)
    bias = torques(geo, v, np.zeros(4), 9.81)
    M = np.stack([torques(geo, np.zeros(4), e, 0.0) for e in np.eye(4)], axis=1)
    return np.linalg.solve(M, tau - bias)
"""
MASSES = """
import numpy as np

M = {"arm": 7.0, "fore": 5.0, "quill": 1.2, "hand": 0.4}

def f(q):
    hanging = M["quill"] + M["hand"]
    return [0.0, 0.0, -hanging*9.81, 0.0]
"""
NEWTON = """
import numpy as np

L = np.array([0.5, 0.4, 0.25])

def place(q):
    ang = np.cumsum(q)
    return np.array([L @ np.cos(ang), L @ np.sin(ang), ang[-1]])

def J(q):
    ang = np.cumsum(q)
    up = np.triu(np.ones((3, 3)))
    jx = up @ (-L*np.sin(ang))
    jy = up @ (L*np.cos(ang))
    return np.vstack([jx, jy, np.ones(3)])

def f(q, target):
    e = target - place(q)
    return q + np.linalg.solve(J(q), e)
"""
STATICS = """
import numpy as np

a1, a2 = 0.325, 0.275

def f(q, wrench):
    s1, c1, s12, c12 = np.sin(q[0]), np.cos(q[0]), np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    col1 = [-a1*s1 - a2*s12, a1*c1 + a2*c12, 0, 0, 0, 1]
    col2 = [-a2*s12, a2*c12, 0, 0, 0, 1]
    col3 = [0, 0, -1, 0, 0, 0]
    col4 = [0, 0, 0, 0, 0, -1]
    return np.array([col1, col2, col3, col4]) @ wrench
"""
CRAIG = """
import numpy as np

Z = np.array([0.0, 0.0, 1.0])
ROWS = [(0.0, 0.0), (0.45, 0.0), (0.35, np.pi/2)]
mass = [3.0, 2.0, 1.2]
Pc = np.array([[0.20, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]])
Ic = [
    np.diag([0.02, 0.08, 0.07]),
    np.diag([0.01, 0.04, 0.045]),
    np.array([[0.004, 0.001, 0.0], [0.001, 0.012, 0.0005], [0.0, 0.0005, 0.014]]),
]

def frame(i, t):
    a, al = ROWS[i]
    c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
    return np.array([[c, -s, 0], [s*ca, c*ca, -sa], [s*sa, c*sa, ca]]), np.array([a, 0.0, 0.0])

def f(q, v, a):
    frames = [frame(i, q[i]) for i in range(3)]
    w, wd, vd = np.zeros(3), np.zeros(3), np.array([0.0, 0.0, 9.81])
    F, N = [], []
    for i in range(3):
        R, p = frames[i]
        vd = R.T @ (np.cross(wd, p) + np.cross(w, np.cross(w, p)) + vd)
        wd = R.T @ wd + np.cross(R.T @ w, v[i]*Z) + a[i]*Z
        w = R.T @ w + v[i]*Z
        vc = np.cross(wd, Pc[i]) + np.cross(w, np.cross(w, Pc[i])) + vd
        F.append(mass[i]*vc)
        N.append(Ic[i] @ wd + np.cross(w, Ic[i] @ w))
    force, n, R, p = np.zeros(3), np.zeros(3), np.eye(3), np.zeros(3)
    tau = np.zeros(3)
    for i in (2, 1, 0):
        n = N[i] + R @ n + np.cross(Pc[i], F[i]) + np.cross(p, R @ force)
        force = R @ force + F[i]
        tau[i] = n @ Z
        R, p = frames[i]
    return tau
"""
WRENCH = """
import numpy as np

def turn(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

def f(q, wrench):
    R = turn(q[0] + q[1])
    force = R @ wrench[:3]
    moment = R @ wrench[3:]
    elbow = turn(q[0]) @ [0.5, 0.0, 0.0]
    tool = elbow + R @ [0.4, 0.0, 0.0]
    tau = []
    for p in (np.zeros(3), elbow):
        tau.append((moment + np.cross(tool - p, force))[2])
    return np.array(tau)
"""
PROGRAMS = {
    "legs": ("unequal", "fivebar_angles", LEGS),
    "millimetres": ("equal_links", "fivebar_loop", MILLIMETRES),
    "forward": ("planar2r", "forward_dynamics", FORWARD),
    "quill": ("scara", "forward_dynamics", QUILL),
    "masses": ("scara", "gravity_torques", MASSES),
    "newton": ("planar3r", "newton_step", NEWTON),
    "statics": ("scara", "statics", STATICS),
    "wrench": ("planar2r", "statics_tool", WRENCH),
    "craig": ("spatial3r", "inverse_dynamics", CRAIG),
}


@pytest.mark.parametrize("name", PROGRAMS)
def test_every_program_is_right(name):
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "right", "slip", "kind"),
    [
        pytest.param("legs", "B = 2*L1[i]*y", "B = 2*L1[0]*y", "index", id="an argument counts"),
        pytest.param("legs", "A**2 + B**2 - C**2", "A**2 - C**2", "missing term", id="a square of three"),
        pytest.param("millimetres", "x2 = -HALF", "x2 = HALF", "sign", id="a whole number that is a length"),
        pytest.param("forward", "L2*sin(th2)", "L2*th2", "function", id="a sine"),
        pytest.param("quill", "vd + z*a[k]", "vd + z*a[0]", "index", id="a counter of enumerate"),
        pytest.param("masses", '"] + M["hand"]', '"]', "missing term", id="another key"),
        pytest.param("newton", "-L*np.sin(ang)", "-L*ang", "function", id="a sine of all angles"),
        pytest.param("statics", "[-a2*s12,", "[s12,", "missing factor", id="a factor with its sign"),
        pytest.param("wrench", "force = R @ wrench", "force = wrench", "missing matrix", id="a part as the other"),
        pytest.param("craig", "R.T @ w, v[i]", "w, v[i]", "missing matrix", id="a term that is nothing here"),
    ],
)  # fmt: skip
def test_an_everyday_slip_is_told(name, right, slip, kind):
    assert kind in told_in_its_line(*PROGRAMS[name], right, slip).kinds[0]


SCREWS = """
import numpy as np

L1, L2, H = 0.325, 0.275, 0.387

def hat(w):
    return np.array([[0.0, -w[2], w[1]], [w[2], 0.0, -w[0]], [-w[1], w[0], 0.0]])

def exp6(w, v, th):
    W = hat(w)
    T = np.eye(4)
    T[:3, :3] = np.eye(3) + np.sin(th)*W + (1 - np.cos(th))*W @ W
    G = np.eye(3)*th + (1 - np.cos(th))*W + (th - np.sin(th))*W @ W
    T[:3, 3] = G @ v
    return T

def adjoint(T):
    R, p = T[:3, :3], T[:3, 3]
    out = np.zeros((6, 6))
    out[:3, :3] = out[3:, 3:] = R
    out[:3, 3:] = hat(p) @ R
    return out

def f(q):
    up = np.array([0.0, 0.0, 1.0])
    axes = [up, up, np.zeros(3), -up]
    points = [np.array([0.0, 0.0, H]), np.array([L1, 0.0, H]), None, np.array([L1 + L2, 0.0, H])]
    screws = [(w, -up if p is None else -np.cross(w, p)) for w, p in zip(axes, points)]
    T, J = np.eye(4), np.zeros((6, 4))
    for i, (w, v) in enumerate(screws):
        J[:, i] = adjoint(T) @ np.concatenate([v, w])
        T = T @ exp6(w, v, q[i])
    return J
"""


def test_two_plain_slips_come_before_one_that_is_far_fetched():
    """Points from joint to joint with another translation are right, too: nobody means that."""
    right = kl.diagnose("scara", "jacobian_spatial", written(SCREWS))
    assert right.agrees, right
    slips = [("(th - np.sin(th))*W", "(th + np.sin(th))*W"), ("L1 + L2, 0.0", "L2, 0.0")]
    found = kl.diagnose("scara", "jacobian_spatial", written(with_slips(SCREWS, slips)))
    assert found.causes and sorted(found.causes[0].kinds) == ["missing term", "sign"], found
