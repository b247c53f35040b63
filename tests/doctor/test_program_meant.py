"""A slip is told by what else the program has: names, shapes, the rows of a table, idle entries."""

from __future__ import annotations

import cProfile

import pytest
from hand_programs import asked, lines_named, with_slips

CHRISTOFFEL = """
import numpy as np

def f(q, qdot):
    m2, l1 = 1.5, 0.5
    lc2 = 0.2
    h = -m2 * l1 * lc2 * np.sin(q[1])
    c111 = 0.0
    c121 = c211 = h
    c221 = h
    c112 = -h
    c122 = c212 = 0.0
    c222 = 0.0
    C = np.empty((2, 2))
    C[0, 0] = c111 * qdot[0] + c211 * qdot[1]
    C[0, 1] = c121 * qdot[0] + c221 * qdot[1]
    C[1, 0] = c112 * qdot[0] + c212 * qdot[1]
    C[1, 1] = c122 * qdot[0] + c222 * qdot[1]
    return C
"""
SCREWS = """
import numpy as np

w = np.array([[0, 0, 1], [0, 1, 0], [0, 0, 1], [0, -1, 0], [0, 0, 1], [0, -1, 0], [0, 0, -1]], float)
p = np.array([
    [0, 0, 0.333],
    [0, 0, 0.333],
    [0, 0, 0.333],
    [0.0825, 0, 0.333 + 0.316],
    [0, 0, 0.333 + 0.316],
    [0, 0, 0.333 + 0.316 + 0.384],
    [0.088, 0, 0.333 + 0.316 + 0.384],
])
M = np.eye(4)
M[:3, :3] = np.diag([1, -1, -1])
M[:3, 3] = [0.088, 0, 0.333 + 0.316 + 0.384 - 0.107]

def rotation(axis, t):
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.cos(t) * np.eye(3) + np.sin(t) * K + (1 - np.cos(t)) * np.outer(axis, axis)

def f(q):
    T = M
    for k in range(6, -1, -1):
        E = np.eye(4)
        E[:3, :3] = rotation(w[k], q[k])
        E[:3, 3] = p[k] - E[:3, :3] @ p[k]
        T = E @ T
    return T
"""
ENERGY = """
from math import cos, sin

links = [
    {"m": 3.0, "l": 0.50, "lc": 0.25, "I": 0.0625},
    {"m": 2.0, "l": 0.40, "lc": 0.20, "I": 2 * 0.4**2 / 12},
    {"m": 1.0, "l": 0.25, "lc": 0.125, "I": 1 * 0.25**2 / 12},
]

def f(q, v):
    angle, rate = 0.0, 0.0
    vx, vy = 0.0, 0.0
    T = 0.0
    for link, qi, vi in zip(links, q, v):
        angle += qi
        rate += vi
        cx = vx - link["lc"] * sin(angle) * rate
        cy = vy + link["lc"] * cos(angle) * rate
        T += link["m"] * (cx * cx + cy * cy) / 2
        T += link["I"] * rate**2 / 2
        vx -= link["l"] * sin(angle) * rate
        vy += link["l"] * cos(angle) * rate
    return T
"""
ELBOW = """
import numpy as np

m1, m2 = 2.0, 1.5
l1 = 0.5
lc1, lc2 = 0.25, 0.2
I1 = m1 * 0.5**2 / 12
I2 = m2 * 0.4**2 / 12
g = 9.81

def f(q, qd, qdd):
    q1, q2 = q
    d11 = m1 * lc1**2 + m2 * (l1**2 + lc2**2 + 2 * l1 * lc2 * np.cos(q2)) + I1 + I2
    d12 = m2 * (lc2**2 + l1 * lc2 * np.cos(q2)) + I2
    d22 = m2 * lc2**2 + I2
    h = -m2 * l1 * lc2 * np.sin(q2)
    phi1 = (m1 * lc1 + m2 * l1) * g * np.cos(q1) + m2 * lc2 * g * np.cos(q1 + q2)
    phi2 = m2 * lc2 * g * np.cos(q1 + q2)
    tau1 = d11 * qdd[0] + d12 * qdd[1] + h * qd[1]**2 + 2 * h * qd[0] * qd[1] + phi1
    tau2 = d12 * qdd[0] + d22 * qdd[1] - h * qd[0]**2 + phi2
    return np.array([tau1, tau2])
"""
ROD = """
import numpy as np

m = 2.5
l = 0.6
lc = l / 2
g = 9.81

def f(q, qd, qdd):
    Ic = m * l**2 / 12
    Io = Ic + m * lc**2
    inertial = Io * qdd[0]
    weight = m * g * lc * np.cos(q[0])
    return np.array([inertial + weight])
"""
INWARD = """
import numpy as np

m = [3.0, 2.0, 1.0]
L = [0.5, 0.4, 0.25]
Ic = [m[i] * L[i] ** 2 / 12 for i in range(3)]

def perp(r):
    return np.array([-r[1], r[0]])

def cross2(r, F):
    return r[0] * F[1] - r[1] * F[0]

def f(q, qd, qdd):
    th = w = al = 0.0
    acc = np.array([0.0, 9.81])
    arm, com, F, N = [], [], [], []
    for i in range(3):
        th += q[i]
        w += qd[i]
        al += qdd[i]
        u = np.array([np.cos(th), np.sin(th)])
        r = L[i] * u
        rc = L[i] / 2 * u
        ac = acc + al * perp(rc) - w ** 2 * rc
        F.append(m[i] * ac)
        N.append(Ic[i] * al)
        arm.append(r)
        com.append(rc)
        acc = acc + al * perp(r) - w ** 2 * r
    tau = np.zeros(3)
    fn = np.zeros(2)
    nn = 0.0
    for i in (2, 1, 0):
        nn = nn + N[i] + cross2(com[i], F[i]) + cross2(arm[i], fn)
        fn = fn + F[i]
        tau[i] = nn
    return tau
"""
STANFORD = """
import numpy as np

PI2 = np.pi / 2
a = [0, 0, 0.0203, 0, 0, 0]
alpha = [-PI2, PI2, 0, -PI2, PI2, 0]
d = [0.412, 0.154, 0, 0, 0, 0.263]
theta = [0, 0, -PI2, 0, 0, 0]
rho = [1, 1, 0, 1, 1, 1]

def dh(i, qi):
    th = theta[i] + rho[i] * qi
    di = d[i] + (1 - rho[i]) * qi
    c, s = np.cos(th), np.sin(th)
    ca, sa = np.cos(alpha[i]), np.sin(alpha[i])
    return np.array([[c, -s * ca, s * sa, a[i] * c],
                     [s, c * ca, -c * sa, a[i] * s],
                     [0, sa, ca, di],
                     [0, 0, 0, 1]])

def f(q):
    T = [np.eye(4)]
    for i in range(6):
        T.append(T[-1] @ dh(i, q[i]))
    o6 = T[6][:3, 3]
    J = np.zeros((6, 6))
    for i in range(6):
        z = T[i][:3, 2]
        o = T[i][:3, 3]
        if rho[i]:
            J[0:3, i] = np.cross(z, o6 - o)
            J[3:6, i] = z
        else:
            J[0:3, i] = z
    return J
"""
CENTRES = """
import numpy as np

UR10 = {
    "d": [0.1273, 0, 0, 0.163941, 0.1157, 0.0922],
    "a": [0, -0.612, -0.5723, 0, 0, 0],
    "alpha": np.deg2rad([90, 0, 0, 90, -90, 0]),
    "com": [
        (0, 0, 0),
        (0.306, 0, 0.220941),
        (0.28615, 0, 0.049041),
        (0, -0.1149, 0),
        (0, 0.1157, 0),
        (0, 0, -0.0922),
    ],
}

def Rot(axis, t):
    c, s = np.cos(t), np.sin(t)
    T = np.eye(4)
    i, j = {"x": (1, 2), "z": (0, 1)}[axis]
    T[i, i] = T[j, j] = c
    T[i, j], T[j, i] = -s, s
    return T

def Trans(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T

def f(q):
    T = Rot("z", np.pi)
    rc = []
    for i in range(6):
        T = T @ Rot("z", q[i]) @ Trans(0, 0, UR10["d"][i])
        T = T @ Trans(UR10["a"][i], 0, 0) @ Rot("x", UR10["alpha"][i])
        c = np.append(UR10["com"][i], 1)
        rc.append((T @ c)[:3])
    return np.array(rc)
"""
WRENCHES = """
import numpy as np

h = np.pi / 2
ALPHA = [0, h, 0, -h, h, -h]
A = [0, 0, 0.4318, 0.0203, 0, 0]
D = [0, 0, 0.15005, 0.4318, 0, 0]
m = [0, 17.4, 4.8, 0.82, 0.34, 0.09]
pc = np.array([[0, 0, 0], [0.068, 0.006, 0.2275], [0, 0.07, 0.0141], [0, 0, 0.019], [0, 0, 0], [0, 0, 0.032]])
Ic = [
    np.zeros((3, 3)),
    np.diag([0.13, 0.524, 0.539]),
    np.diag([0.0685, 0.015, 0.0835]),
    np.diag([0.0018, 0.0018, 0.0013]),
    np.diag([0.0003, 0.0003, 0.0004]),
    np.diag([0.00015, 0.00015, 0.00004]),
]

def cross(x, y):
    return np.array([x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]])

def f(q, qd, qdd, wrench):
    w, dw, dv = np.zeros(3), np.zeros(3), np.array([0, 0, 9.81])
    R, P, F, N = [], [], [], []
    R0 = np.eye(3)
    for i in range(6):
        c, s, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(ALPHA[i]), np.sin(ALPHA[i])
        Ri = np.array([[c, -s, 0], [s * ca, c * ca, -sa], [s * sa, c * sa, ca]])
        Pi = np.array([A[i], -sa * D[i], ca * D[i]])
        dv = Ri.T @ (dv + cross(dw, Pi) + cross(w, cross(w, Pi)))
        w_in = Ri.T @ w
        z = np.array([0, 0, 1.0])
        dw = Ri.T @ dw + cross(w_in, z * qd[i]) + z * qdd[i]
        w = w_in + z * qd[i]
        dvc = cross(dw, pc[i]) + cross(w, cross(w, pc[i])) + dv
        F.append(m[i] * dvc)
        N.append(Ic[i] @ dw + cross(w, Ic[i] @ w))
        R.append(Ri)
        P.append(Pi)
        R0 = R0 @ Ri
    f_in = R0.T @ wrench[:3]
    n_in = R0.T @ wrench[3:]
    P_in = np.zeros(3)
    out = np.zeros((6, 6))
    for i in range(5, -1, -1):
        n_i = N[i] + n_in + cross(pc[i], F[i]) + cross(P_in, f_in)
        f_i = F[i] + f_in
        out[i] = np.hstack([f_i, n_i])
        P_in = P[i]
        f_in, n_in = R[i] @ f_i, R[i] @ n_i
    return out
"""
OUTWARD = """
import numpy as np

mass = [3.0, 2.0, 1.2]
PC = [np.array([0.2, 0.02, -0.01]), np.array([0.15, -0.01, 0.03]), np.array([0.12, 0.03, 0.01])]
IC = [
    np.diag([0.02, 0.08, 0.07]),
    np.diag([0.01, 0.04, 0.045]),
    np.array([[0.004, 0.001, 0.0], [0.001, 0.012, 0.0005], [0.0, 0.0005, 0.014]]),
]
P = [np.array([0.0, 0, 0]), np.array([0.45, 0, 0]), np.array([0.35, 0, 0])]
alpha = [0.0, 0.0, np.pi / 2]
ez = np.array([0.0, 0.0, 1.0])

def rot(i, th):
    ca, sa, ct, st = np.cos(alpha[i]), np.sin(alpha[i]), np.cos(th), np.sin(th)
    return np.array([[ct, -st, 0], [st * ca, ct * ca, -sa], [st * sa, ct * sa, ca]])

def f(q, qd, qdd):
    w = wd = np.zeros(3)
    vd = np.array([0, 0, 9.81])
    R = [rot(i, q[i]) for i in range(3)]
    F, N = [], []
    for i in range(3):
        Rt = R[i].T
        vd = Rt @ (np.cross(wd, P[i]) + np.cross(w, np.cross(w, P[i])) + vd)
        wd = Rt @ wd + np.cross(Rt @ w, qd[i] * ez) + qdd[i] * ez
        w = Rt @ w + qd[i] * ez
        vdC = np.cross(wd, PC[i]) + np.cross(w, np.cross(w, PC[i])) + vd
        F.append(mass[i] * vdC)
        N.append(IC[i] @ wd + np.cross(w, IC[i] @ w))
    tau = np.zeros(3)
    fn = nn = np.zeros(3)
    R.append(np.eye(3))
    P_next = P[1:] + [np.zeros(3)]
    for i in range(2, -1, -1):
        f_i = R[i + 1] @ fn + F[i]
        n_i = N[i] + R[i + 1] @ nn + np.cross(PC[i], F[i]) + np.cross(P_next[i], R[i + 1] @ fn)
        tau[i] = n_i @ ez
        fn, nn = f_i, n_i
    return tau
"""
POINTS = """
import numpy as np

D1, A2, A3, D4, D5, D6 = 0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922

def f(q, wrench):
    force, moment = wrench[:3], wrench[3:]
    q1 = q[0] + np.pi
    radial = np.array([np.cos(q1), np.sin(q1), 0])
    side = np.array([np.sin(q1), -np.cos(q1), 0])
    up = np.array([0, 0, 1.0])
    b, e, t = q[1], q[1] + q[2], q[1] + q[2] + q[3]
    z5 = np.sin(t) * radial - np.cos(t) * up
    x4 = np.cos(t) * radial + np.sin(t) * up
    z6 = np.cos(q[4]) * side - np.sin(q[4]) * x4
    shoulder = D1 * up
    elbow = shoulder + A2 * (np.cos(b) * radial + np.sin(b) * up)
    wrist1 = elbow + A3 * (np.cos(e) * radial + np.sin(e) * up)
    wrist2 = wrist1 + D4 * side
    wrist3 = wrist2 + D5 * z5
    tool = wrist3 + D6 * z6
    axes = [up, side, side, side, z5, z6]
    points = [np.zeros(3), shoulder, elbow, wrist1, wrist2, wrist3]
    return np.array([z @ (moment + np.cross(tool - p, force)) for z, p in zip(axes, points)])
"""
SCARA = """
import numpy as np

def A(a, alpha, d, theta):
    ct, st = np.cos(theta), np.sin(theta)
    ca, sa = np.cos(alpha), np.sin(alpha)
    return np.array([
        [ct, -st * ca, st * sa, a * ct],
        [st, ct * ca, -ct * sa, a * st],
        [0.0, sa, ca, d],
        [0.0, 0.0, 0.0, 1.0]])

def f(q):
    A1 = A(0.325, 0.0, 0.387, q[0])
    A2 = A(0.275, np.pi, 0.0, q[1])
    A3 = A(0.0, 0.0, q[2], 0.0)
    A4 = A(0.0, 0.0, 0.0, q[3])
    return A1 @ A2 @ A3 @ A4
"""
WEIGHTS = """
import numpy as np

rows = [
    (0.089159, 0.0, np.pi/2, 3.7, (0, 0, 0)),
    (0.0, -0.425, 0.0, 8.393, (0.145, 0, 0.13585)),
    (0.0, -0.39225, 0.0, 2.275, (0.14225, 0, 0.01615)),
    (0.10915, 0.0, np.pi/2, 1.219, (0, -0.093, 0)),
    (0.09465, 0.0, -np.pi/2, 1.219, (0, 0.09465, 0)),
    (0.0823, 0.0, 0.0, 0.1879, (0, 0, -0.0823)),
]

def f(q):
    T = np.diag([-1.0, -1.0, 1.0, 1.0])
    frames = [T]
    weights = []
    for (d, a, al, m, c), th in zip(rows, q):
        ct, st = np.cos(th), np.sin(th)
        ca, sa = np.cos(al), np.sin(al)
        T = T @ np.array([[ct, -st*ca, st*sa, a*ct], [st, ct*ca, -ct*sa, a*st],
                          [0, sa, ca, d], [0, 0, 0, 1]])
        frames.append(T)
        weights.append((m, (T @ np.append(c, 1.0))[:3]))
    g = np.zeros(6)
    for j in range(6):
        z, o = frames[j][:3, 2], frames[j][:3, 3]
        for m, pc in weights[j:]:
            g[j] += z @ np.cross(pc - o, [0, 0, 9.81 * m])
    return g
"""
STATICS = """
import numpy as np

def rot(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])

def f(q, F):
    P = [np.array([0.5, 0, 0]), np.array([0.4, 0, 0]), np.array([0.25, 0, 0])]
    R = [rot(q[0]), rot(q[1]), rot(q[2])]
    R03 = R[0] @ R[1] @ R[2]
    fi = R03.T @ F[:3]
    ni = R03.T @ F[3:]
    tau = np.zeros(3)
    n3 = ni + np.cross(P[2], fi)
    f3 = fi
    tau[2] = n3[2]
    f2 = R[2] @ f3
    n2 = R[2] @ n3 + np.cross(P[1], f2)
    tau[1] = n2[2]
    f1 = R[1] @ f2
    n1 = R[1] @ n2 + np.cross(P[0], f1)
    tau[0] = n1[2]
    return tau
"""
FRAME = """
import numpy as np

L1 = 0.5
L2 = 0.4

def f(q):
    th1, th2 = q
    c1, s1 = np.cos(th1), np.sin(th1)
    c12, s12 = np.cos(th1 + th2), np.sin(th1 + th2)
    x = L1 * c1 + L2 * c12
    y = L1 * s1 + L2 * s12
    T = np.array([
        [c12, -s12, 0.0, x],
        [s12, c12, 0.0, y],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ])
    return T
"""

CARRIED = """
from math import sin, cos
import numpy as np

g = 9.81
m3, m4, m5, m6 = 4.25, 1.08, 0.63, 0.51
z3 = -0.6447
y4, z4 = 0.0092, -0.0054
z5 = 0.0566
z6 = 0.263 + 0.1554

def f(q):
    s2, c2 = sin(q[1]), cos(q[1])
    s4, c4 = sin(q[3]), cos(q[3])
    s5, c5 = sin(q[4]), cos(q[4])
    d = q[2]
    mu = m5 * z5 + m6 * z6

    k_2 = -s2 * c5 - c2 * s4 * s5
    k_4 = -s2 * c4 * s5
    k_5 = -c2 * s5 - s2 * s4 * c5

    V_2 = -m3 * (d + z3) * s2 - m4 * ((d - y4) * s2 + z4 * c2 * c4) - (m5 + m6) * d * s2 + mu * k_2
    V_3 = (m3 + m4 + m5 + m6) * c2
    V_4 = m4 * z4 * s2 * s4 + mu * k_4
    V_5 = mu * k_5
    return g * np.array([0, V_2, V_3, V_4, V_5, 0])
"""
WORST = """
import numpy as np

leg = {
    "l1": np.array([0.30, 0.26]),
    "l2": np.array([0.50, 0.54]),
    "base": np.array([[0.12, 0.0], [-0.12, 0.0]]),
    "mass": np.array([1.0, 0.8]),
    "com": np.array([0.12, 0.15]),
    "inertia": np.array([0.0075, 0.0060]),
    "rotor": np.array([1.0e-5, 1.2e-5]),
    "gear": np.array([10.0, 12.0]),
}
payload = 1.5

def directions(xy, mode):
    to_tool = xy - leg["base"]
    D2 = np.einsum("ij,ij->i", to_tool, to_tool)
    D = np.sqrt(D2)
    along = (D2 + leg["l1"]**2 - leg["l2"]**2) / (2 * D)
    across = np.sqrt(leg["l1"]**2 - along**2)
    ex = to_tool / D[:, None]
    ey = np.stack([-ex[:, 1], ex[:, 0]], axis=1)
    elbow = along[:, None] * ex - (np.asarray(mode) * across)[:, None] * ey
    return elbow / leg["l1"][:, None], (to_tool - elbow) / leg["l2"][:, None]

def f(xy, mode):
    u, w = directions(xy, mode)
    triple = u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]
    J = w / (leg["l1"] * triple)[:, None]
    I_A = leg["inertia"] + leg["mass"] * leg["com"]**2 + leg["gear"]**2 * leg["rotor"]
    G = I_A[:, None] * J + payload * np.linalg.inv(J).T
    return np.sqrt((G**2).sum(axis=1))
"""
ROTORS = """
import numpy as np

a = [0, 0.4318, 0.0203, 0, 0, 0]
d = [0, 0, 0.15005, 0.4318, 0, 0]
sa = [1, 0, -1, 1, -1, 0]
ca = [0, 1, 0, 0, 0, 1]
m = [0, 17.4, 4.8, 0.82, 0.34, 0.09]
r = [[0, 0, 0], [-0.3638, 0.006, 0.2275], [-0.0203, -0.0141, 0.07], [0, 0.019, 0], [0, 0, 0], [0, 0, 0.032]]
I = [[0, 0, 0], [0.13, 0.524, 0.539], [0.0685, 0.0835, 0.015],
     [0.0018, 0.0013, 0.0018], [0.0003, 0.0004, 0.0003], [0.00015, 0.00015, 4e-5]]
Jm = np.array([1.134029969, 2.324814845, 0.576873332, 0.190790626, 0.170706292, 0.194064506])

def f(q, qd):
    omega = np.zeros(3)
    vel = np.zeros(3)
    K = 0.0
    for i in range(6):
        c, s = np.cos(q[i]), np.sin(q[i])
        R = np.array([[c, -s * ca[i], s * sa[i]],
                      [s, c * ca[i], -c * sa[i]],
                      [0, sa[i], ca[i]]])
        p = np.array([a[i], d[i] * sa[i], d[i] * ca[i]])
        omega = R.T @ (omega + [0, 0, qd[i]])
        vel = R.T @ vel + np.cross(omega, p)
        vc = vel + np.cross(omega, r[i])
        K += 0.5 * m[i] * vc @ vc
        K += 0.5 * np.sum(I[i] * omega**2)
    return K + 0.5 * Jm @ qd**2
"""
COMPOSITE = """
import numpy as np

S = np.array([0, 0, 1.0, 0, 0, 0])
H = np.pi / 2
DH = [(0, 0, 0.333), (-H, 0, 0), (H, 0, 0.316), (H, 0.0825, 0), (-H, -0.0825, 0.384), (H, 0, 0), (H, 0.088, 0)]
BODY = np.array([
    [4.970684, 0.003875, 0.002081, -0.04762, 0.70337, 0.70661, 0.009117, -0.000139, 0.006772, 0.019169],
    [0.646926, -0.003141, -0.02872, 0.003495, 0.007962, 0.02811, 0.025995, -0.003925, 0.010254, 0.000704],
    [3.228604, 0.027518, 0.039252, -0.066502, 0.037242, 0.036155, 0.01083, -0.004761, -0.011396, -0.012805],
    [3.587895, -0.05317, 0.104419, 0.027454, 0.025853, 0.019552, 0.028323, 0.007796, -0.001332, 0.008641],
    [1.225946, -0.011953, 0.041065, -0.038437, 0.035549, 0.029474, 0.008627, -0.002117, -0.004037, 0.000229],
    [1.666555, 0.060149, -0.014117, -0.010517, 0.001964, 0.004354, 0.005433, 0.000109, -0.001158, 0.000341],
    [1.495522, 0.001720874, 0.001360354, 0.100485281, 0.016529854, 0.014107249, 0.006676956, 0.000394892, -0.000706696, -0.001051105],
])

def crm(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])

def mcI(b):
    m, C = b[0], crm(b[1:4])
    xx, yy, zz, xy, xz, yz = b[4:]
    I = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return np.block([[I + m * C @ C.T, m * C], [m * C.T, m * np.eye(3)]])

def Xup(al, a, d, th):
    ca, sa, c, s = np.cos(al), np.sin(al), np.cos(th), np.sin(th)
    E = np.array([[c, s * ca, s * sa], [-s, c * ca, c * sa], [0, -sa, ca]])
    r = np.array([a, -d * sa, d * ca])
    return np.block([[E, np.zeros((3, 3))], [-E @ crm(r), E]])

def f(q):
    n = len(q)
    X = [Xup(*row, th) for row, th in zip(DH, q)]
    Ic = [mcI(b) for b in BODY]
    M = np.zeros((n, n))
    for i in range(n - 1, -1, -1):
        if i > 0:
            Ic[i - 1] = Ic[i - 1] + X[i].T @ Ic[i] @ X[i]
        F = Ic[i] @ S
        M[i, i] = S @ F
        for j in range(i, 0, -1):
            F = X[j].T @ F
            M[i, j - 1] = M[j - 1, i] = S @ F
    return M
"""
PAUL = """
import numpy as np

def linktran(L, q):
    alpha, A, D = L[0], L[1], L[3]
    ct, st = np.cos(q + L[2]), np.sin(q + L[2])
    ca, sa = np.cos(alpha), np.sin(alpha)
    return np.array([
        [ct, -st*ca, st*sa, A*ct],
        [st, ct*ca, -ct*sa, A*st],
        [0, sa, ca, D],
        [0, 0, 0, 1]])

def f(q):
    dh = [
        [np.pi/2, 0, 0, 0],
        [0, 0.4318, 0, 0],
        [-np.pi/2, 0.0203, 0, 0.15005],
        [np.pi/2, 0, 0, 0.4318],
        [-np.pi/2, 0, 0, 0],
        [0, 0, 0, 0]]
    n = len(dh)
    J = np.zeros((6, n))
    U = np.eye(4)
    for j in range(n - 1, -1, -1):
        U = linktran(dh[j], q[j]) @ U
        d = np.array([-U[0, 0]*U[1, 3] + U[1, 0]*U[0, 3],
                      -U[0, 1]*U[1, 3] + U[1, 1]*U[0, 3],
                      -U[0, 2]*U[1, 3] + U[1, 2]*U[0, 3]])
        delta = U[2, 0:3]
        J[0:3, j] = d
        J[3:6, j] = delta
    return J
"""
POINTS_OF_RODS = """
import numpy as np

ROD_MASS = [3.0, 2.0, 1.0]
ROD_LENGTH = [0.5, 0.4, 0.25]

def f(q, qdot):
    energy = 0.0
    heading, turning = 0.0, 0.0
    vx, vy = 0.0, 0.0
    for m, l, qi, wi in zip(ROD_MASS, ROD_LENGTH, q, qdot):
        heading += qi
        turning += wi
        for share, s in ((1 / 6, 0.0), (4 / 6, 0.5), (1 / 6, 1.0)):
            px = vx - s * l * turning * np.sin(heading)
            py = vy + s * l * turning * np.cos(heading)
            energy += 0.5 * share * m * (px**2 + py**2)
        vx -= l * turning * np.sin(heading)
        vy += l * turning * np.cos(heading)
    return energy
"""
SPONG = """
import numpy as np

m1, m2 = 2.0, 1.5
l1, l2 = 0.5, 0.4
lc1, lc2 = l1 / 2, l2 / 2
I1 = m1 * l1**2 / 12
I2 = m2 * l2**2 / 12
g = 9.81

def D(q):
    d11 = m1 * lc1**2 + m2 * (l1**2 + lc2**2 + 2 * l1 * lc2 * np.cos(q[1])) + I1 + I2
    d12 = m2 * (lc2**2 + l1 * lc2 * np.cos(q[1])) + I2
    d22 = m2 * lc2**2 + I2
    return np.array([[d11, d12], [d12, d22]])

def C(q, qd):
    h = -m2 * l1 * lc2 * np.sin(q[1])
    return np.array([[h * qd[1], h * qd[1] + h * qd[0]], [-h * qd[0], 0.0]])

def phi(q):
    phi2 = m2 * lc2 * g * np.cos(q[0] + q[1])
    phi1 = (m1 * lc1 + m2 * l1) * g * np.cos(q[0]) + phi2
    return np.array([phi1, phi2])

def f(q, qd, qdd):
    return D(q) @ qdd + C(q, qd) @ qd + phi(q)
"""

SLIPS = [
    (
        CHRISTOFFEL,
        "planar2r_rods",
        "coriolis_matrix",
        [("c112 = -h", "c112 = h")],
        "another name for it",
    ),
    (
        CHRISTOFFEL,
        "planar2r_rods",
        "coriolis_matrix",
        [("lc2 = 0.2", "lc2 = 0.4")],
        "a number by its name in a function",
    ),
    (SCREWS, "panda", "fk", [("T = E @ T", "T = T @ E")], "lengths there and back"),
    (
        ENERGY,
        "planar3r",
        "kinetic_energy",
        [('T += link["I"] * rate**2 / 2', 'T += link["I"] * vi**2 / 2')],
        "a mass in a product of numbers",
    ),
    (
        ELBOW,
        "planar2r_rods",
        "inverse_dynamics",
        [("I1 = m1 * 0.5**2 / 12", "I1 = m1 * 0.5**2 / 3")],
        "a length that is raised",
    ),
    (
        ROD,
        "single_link",
        "inverse_dynamics",
        [("Ic = m * l**2 / 12", "Ic = m * l**2 / 3")],
        "a rod's moment",
    ),
    (
        INWARD,
        "planar3r",
        "inverse_dynamics",
        [("for i in (2, 1, 0):", "for i in range(3):")],
        "a loop the other way",
    ),
    (STANFORD, "stanford", "jacobian", [("J[0:3, i] = z", "J[3:6, i] = z")], "the rows below"),
    (
        WRENCHES,
        "puma560_modified",
        "joint_wrenches",
        [
            (
                "n_i = N[i] + n_in + cross(pc[i], F[i]) + cross(P_in, f_in)",
                "n_i = N[i] + n_in + cross(pc[i], F[i]) + cross(P[i], f_in)",
            )
        ],
        "a name that nothing uses",
    ),
    (
        OUTWARD,
        "spatial3r",
        "inverse_dynamics",
        [
            (
                "wd = Rt @ wd + np.cross(Rt @ w, qd[i] * ez) + qdd[i] * ez",
                "wd = Rt @ wd + qdd[i] * ez",
            )
        ],
        "two summands across",
    ),
    (
        POINTS,
        "ur10",
        "statics",
        [
            (
                "points = [np.zeros(3), shoulder, elbow, wrist1, wrist2, wrist3]",
                "points = [shoulder, elbow, wrist1, wrist2, wrist3, tool]",
            )
        ],
        "points one place on",
    ),
    (
        SCARA,
        "scara",
        "fk",
        [
            ("A2 = A(0.275, np.pi, 0.0, q[1])", "A2 = A(0.275, 0.0, 0.0, q[1])"),
            ("A1 = A(0.325, 0.0, 0.387, q[0])", "A1 = A(0.325, 0.0, 0.0, q[0])"),
        ],
        "calls as the rows of a table",
    ),
    (
        WEIGHTS,
        "ur5",
        "gravity_torques",
        [
            (
                "weights.append((m, (T @ np.append(c, 1.0))[:3]))",
                "weights.append((m, (T @ np.append(c, 0.0))[:3]))",
            ),
            (
                "g[j] += z @ np.cross(pc - o, [0, 0, 9.81 * m])",
                "g[j] += z @ np.cross(pc - o, [0, 0, -9.81 * m])",
            ),
        ],
        "a point that is none",
    ),
    (
        STATICS,
        "planar3r",
        "statics",
        [("f1 = R[1] @ f2", "f1 = R[0] @ f2"), ("n3 = ni + np.cross(P[2], fi)", "n3 = ni")],
        "an entry that nothing uses",
    ),
    (
        FRAME,
        "planar2r",
        "fk",
        [
            (
                "c12, s12 = np.cos(th1 + th2), np.sin(th1 + th2)",
                "c12, s12 = np.cos(th2), np.sin(th2)",
            )
        ],
        "the angle in a whole line",
    ),
    (
        CARRIED,
        "stanford",
        "gravity_torques",
        [("V_3 = (m3 + m4 + m5 + m6) * c2", "V_3 = m3 * c2")],
        "all the masses that a link carries",
    ),
    (
        WORST,
        "unequal",
        "fivebar_torque_per_acceleration_worst",
        [("return np.sqrt((G**2).sum(axis=1))", "return np.sqrt((G**2).sum(axis=0))")],
        "the other axis",
    ),
    (
        ROTORS,
        "puma560",
        "kinetic_energy",
        [("return K + 0.5 * Jm @ qd**2", "return K")],
        "a row that nothing uses",
    ),
    (
        COMPOSITE,
        "panda",
        "mass_matrix",
        [("for j in range(i, 0, -1):", "for j in range(i, 1, -1):")],
        "a large table",
    ),
    (
        PAUL,
        "puma560",
        "jacobian_tool",
        [("[np.pi/2, 0, 0, 0],", "[90, 0, 0, 0],")],
        "degrees among radians",
    ),
    (
        POINTS_OF_RODS,
        "planar3r",
        "kinetic_energy",
        [("turning += wi", "turning = wi")],
        "a sum that forgets",
    ),
    (
        SPONG,
        "planar2r_rods",
        "inverse_dynamics",
        [("h = -m2 * l1 * lc2 * np.sin(q[1])", "h = -m2 * l1 * l2 * np.sin(q[1])")],
        "the centre of the mass's link",
    ),
]


@pytest.mark.many
@pytest.mark.parametrize(
    ("text", "robot", "quantity", "slips"), [x[:4] for x in SLIPS], ids=[x[4] for x in SLIPS]
)
def test_the_slip_is_told_at_its_line(text, robot, quantity, slips, tmp_path) -> None:
    wrong = with_slips(text, slips)
    found, good = asked(wrong, robot, quantity, tmp_path / "hand.py")
    both = zip(text.split("\n"), wrong.split("\n"), strict=True)
    lines = [k for k, (one, other) in enumerate(both, 1) if one != other]
    assert sorted(lines_named(found.sentence)) == lines, str(found)
    assert good, str(found)


def test_a_row_of_a_dictionary_may_be_in_degrees(tmp_path) -> None:
    wrong = with_slips(CENTRES, [("np.deg2rad", "np.array")])
    found, _good = asked(wrong, "ur10", "com_positions", tmp_path / "hand.py")
    assert "UR10['alpha'], degrees are taken for radians" in found.sentence


def test_a_diagnosis_may_be_profiled(tmp_path) -> None:
    wrong = with_slips(ROD, [("np.cos(q[0])", "np.sin(q[0])")])
    with cProfile.Profile() as profile:
        found, good = asked(wrong, "single_link", "inverse_dynamics", tmp_path / "hand.py")
    assert good, str(found)
    assert any("diagnose" in str(one.code) for one in profile.getstats())


TENSORS = """
import numpy as np

m = [3.0, 2.0, 1.2]
c = [np.array([0.2, 0.02, -0.01]), np.array([0.15, -0.01, 0.03]), np.array([0.12, 0.03, 0.01])]
I1, I2 = np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045])
I3 = np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]])
TWISTS = [(0.0, 0.0), (0.45, 0.0), (0.35, np.pi/2)]

def f(q, v):
    R, p, w, u, energy = np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3), 0.0
    for (a, al), t, rate, mass, centre, I in zip(TWISTS, q, v, m, c, [I1, I2, I3]):
        arm = R @ [a, 0, 0]
        u = u + np.cross(w, arm)
        ca, sa, ct, st = np.cos(al), np.sin(al), np.cos(t), np.sin(t)
        R = R @ np.array([[ct, -st, 0], [st*ca, ct*ca, -sa], [st*sa, ct*sa, ca]])
        w = w + rate*R[:, 2]
        vc, wb = u + np.cross(w, R @ centre), R.T @ w
        energy += 0.5*mass*vc @ vc + 0.5*wb @ I @ wb
    return energy
"""


def test_products_of_inertia_with_the_other_sign_are_told(tmp_path) -> None:
    slip = ("[[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]]",
            "[[0.004, -0.001, 0], [-0.001, 0.012, -0.0005], [0, -0.0005, 0.014]]")  # fmt: skip
    wrong = with_slips(TENSORS, [slip])
    found, _good = asked(wrong, "spatial3r", "kinetic_energy", tmp_path / "hand.py")
    assert "I3, the products of inertia have the other sign" in found.sentence
