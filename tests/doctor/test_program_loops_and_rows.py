"""Counters of two loops, entries of rows, terms about another point, tensors and quarter turns.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line

CARRIED = """
import numpy as np
M, L = [3.0, 2.0, 1.0], [0.5, 0.4, 0.25]

def chain(q):
    R, p, out = np.eye(3), np.zeros(3), [(np.eye(3), np.zeros(3))]
    for a, t in zip(L, q):
        c, s = np.cos(t), np.sin(t)
        R = R @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        p = p + R @ np.array([a, 0, 0])
        out.append((R, p))
    return out

def f(q):
    frames, up = chain(q), np.array([0, 9.81, 0])
    force, moment, tau = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in (2, 1, 0):
        R, p = frames[i + 1]
        _, pb = frames[i]
        c = p - R @ np.array([L[i]/2, 0, 0])
        moment = moment + np.cross(c - pb, M[i]*up) + np.cross(p - pb, force)
        force = force + M[i]*up
        tau[i] = moment[2]
    return tau
"""
LOADED = """
import numpy as np
links = [dict(l=0.5, m=3.0), dict(l=0.4, m=2.0), dict(l=0.25, m=1.0)]

def f(q, wrench):
    phi = np.cumsum(q)
    force, moment, tau = np.array(wrench[:2]), 0.0, np.zeros(3)
    moment = wrench[5]
    for i in (2, 1, 0):
        r = links[i]["l"]*np.array([np.cos(phi[i]), np.sin(phi[i])])
        moment = moment + r[0]*force[1] - r[1]*force[0]
        tau[i] = moment
    return tau
"""
LETTERS = """
import numpy as np
LINKS = [("R", 0.325, 0.0, 0.387, 7.0, [-0.16, 0, 0.02]), ("R", 0.275, np.pi, 0, 5.0, [-0.13, 0.005, -0.03]),
         ("P", 0.0, 0.0, 0, 1.2, [0, 0, -0.05]), ("R", 0.0, 0.0, 0.0, 0.4, [0.01, 0, -0.01])]

def f(q):
    frames = [np.eye(4)]
    for (kind, a, al, d, m, com), x in zip(LINKS, q):
        t, d = (x, d) if kind == "R" else (0, x)
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
        frames.append(frames[-1] @ [[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])
    G = np.zeros(4)
    for i in range(4):
        p = frames[i + 1][:3, :3] @ LINKS[i][5] + frames[i + 1][:3, 3]
        for j in range(i + 1):
            z, o = frames[j][:3, 2], frames[j][:3, 3]
            col = z if LINKS[j][0] == "P" else np.cross(z, p - o)
            G[j] -= LINKS[i][4]*col[2]*-9.81
    return G
"""
SUMS = """
import numpy as np
L, M = [0.5, 0.4, 0.25], [3.0, 2.0, 1.0]

def f(q):
    phi, g = np.cumsum(q), np.zeros(3)
    for i in range(3):
        for j in range(i + 1):
            reach = L[j] if j < i else L[j]/2
            for k in range(j + 1):
                g[k] += M[i]*9.81*reach*np.cos(phi[j])
    return g
"""
ALL_OF_A_ROW = """
import numpy as np
L = np.array([0.5, 0.4, 0.25])
SUM = np.tril(np.ones((3, 3)))

def f(q, wrench):
    phi = SUM @ q
    hand = L*(np.cos(phi)*wrench[1] - np.sin(phi)*wrench[0])
    hand[2] += wrench[5]
    return SUM.T @ hand
"""
FARTHER = """
import numpy as np
L, M = (0.5, 0.4, 0.25), (3.0, 2.0, 1.0)

def f(q):
    ang = np.cumsum(q)
    u = np.column_stack([np.cos(ang), np.sin(ang)])
    ends = np.cumsum(np.array(L)[:, None]*u, axis=0)
    o = np.vstack([[0, 0], ends[:-1]])
    c, dM = o + 0.5*np.array(L)[:, None]*u, np.zeros((3, 3, 3))
    for b, m in enumerate(M):
        J, dJ = np.zeros((2, 3)), np.zeros((2, 3, 3))
        for j in range(b + 1):
            J[:, j] = [-(c[b] - o[j])[1], (c[b] - o[j])[0]]
            for k in range(b + 1):
                dJ[:, j, k] = -(c[b] - o[max(j, k)])
        dM += m*(np.einsum('aik,aj->ijk', dJ, J) + np.einsum('ai,ajk->ijk', J, dJ))
    return dM
"""
FROM_THE_FARTHER = """
import numpy as np
L, M = (0.5, 0.4), (2.0, 1.5)

def f(q):
    a = np.cumsum(q)
    D = np.zeros((2, 2, 2))
    for p in range(2):
        for k in range(2):
            J, dJ = np.zeros((2, 2)), np.zeros((2, 2))
            for j in range(k + 1):
                for i in range(j, k + 1):
                    J[:, j] += L[i]*np.array([-np.sin(a[i]), np.cos(a[i])])
                for i in range(max(j, p), k + 1):
                    dJ[:, j] -= L[i]*np.array([np.cos(a[i]), np.sin(a[i])])
            D[:, :, p] += M[k]*(dJ.T @ J + J.T @ dJ)
    return D
"""
ONE_OF_ALL = """
import numpy as np
l = np.array([.5, .4, .25])

def f(q):
    phi = q.cumsum()
    u = np.c_[np.cos(phi), np.sin(phi)]
    origin = np.zeros((3, 2))
    for i in range(1, 3):
        origin[i] = origin[i - 1] + l[i - 1]*u[i - 1]
    com, out = origin + 0.5*l[:, None]*u, np.zeros((3, 6, 3))
    for link in range(3):
        for j in range(link + 1):
            dx, dy = com[link] - origin[j]
            out[link, 0, j], out[link, 1, j] = -dy, dx
            out[link, 5, j] = 1
    return out
"""
SECOND_MOMENTS = """
import numpy as np
a, al, com = (0, 0.45, 0.35), (0, 0, np.pi/2), ((0.2, 0.02, -0.01), (0.15, -0.01, 0.03), (0.12, 0.03, 0.01))
m, I = (3.0, 2.0, 1.2), [np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045]),
     np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]])]

def pseudo(k):
    J, r, T = np.empty((4, 4)), np.array(com[k]), np.array(I[k])
    J[:3, :3] = np.trace(T)/2*np.eye(3) - T + m[k]*np.outer(r, r)
    J[:3, 3] = J[3, :3] = m[k]*r
    J[3, 3] = m[k]
    return J

def A(i, t):
    c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al[i]), np.sin(al[i])
    return np.array([[c, -s, 0, a[i]], [s*ca, c*ca, -sa, 0], [s*sa, c*sa, ca, 0], [0, 0, 0, 1]])

Q = np.zeros((4, 4)); Q[0, 1] = -1; Q[1, 0] = 1

def f(q):
    def U(k, j):
        out = np.eye(4)
        for i in range(k + 1):
            out = out @ A(i, q[i])
            if i == j:
                out = out @ Q
        return out
    return np.array([[sum(np.trace(U(k, j) @ pseudo(k) @ U(k, i).T) for k in range(max(i, j), 3))
                      for j in range(3)] for i in range(3)])
"""
HOME = """
import numpy as np

def skew(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])

def exp6(w, v, t):
    W, T = skew(w), np.eye(4)
    T[:3, :3] = np.eye(3) + np.sin(t)*W + (1 - np.cos(t))*W @ W
    T[:3, 3] = (np.eye(3)*t + (1 - np.cos(t))*W + (t - np.sin(t))*W @ W) @ v
    return T

axes = [np.array([0, 0, 1.]), np.array([0, 0, 1.]), np.array([0, -1., 0])]
points = [np.zeros(3), np.array([0.45, 0, 0]), np.array([0.8, 0, 0])]
M = np.eye(4)
M[:3, 3] = [1.1, 0, 0]
M[:3, :3] = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])

def f(q):
    T = np.eye(4)
    for w, p, t in zip(axes, points, q):
        T = T @ exp6(w, -np.cross(w, p), t)
    return T @ M
"""
ACROSS = """
import numpy as np

def f(q):
    c, s = np.cos(q[0]), np.sin(q[0])
    R1 = np.array([[c, 0, -s], [s, 0, c], [0, -1, 0]])
    c, s = np.cos(q[1]), np.sin(q[1])
    R2 = R1 @ np.array([[c, 0, s], [s, 0, -c], [0, 1, 0]])
    p = np.array([0, 0, 0.412]) + R1 @ [0, 0, 0.154]
    p = p + R2 @ np.array([0, -0.0203, q[2]])
    T, al = np.eye(4), [-np.pi/2, np.pi/2, 0]
    T[:3, :3] = R2 @ [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]
    T[:3, 3] = p
    for t, a, d in zip(q[3:], al, [0, 0, 0.263]):
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(a), np.sin(a)
        T = T @ [[c, -s*ca, s*sa, 0], [s, c*ca, -c*sa, 0], [0, sa, ca, d], [0, 0, 0, 1]]
    return T
"""
TWICE = """
import numpy as np
L, rate = np.array([0.5, 0.4, 0.25]), 0.1

def f(q, target):
    a = np.cumsum(q)
    e = np.array([L @ np.cos(a), L @ np.sin(a), a[-1]]) - target
    J = np.array([[-L[k:] @ np.sin(a[k:]), L[k:] @ np.cos(a[k:]), 1] for k in range(3)]).T
    grad = J.T @ e
    return q - rate*grad
"""
ENTRIES = """
import numpy as np

def f(q):
    c1, s1, c12, s12 = np.cos(q[0]), np.sin(q[0]), np.cos(q[0] + q[1]), np.sin(q[0] + q[1])
    c3, s3 = np.cos(q[2]), np.sin(q[2])
    r11 = c12*c3; r12 = -c12*s3; r13 = s12
    r21 = s12*c3; r22 = -s12*s3; r23 = -c12
    px = 0.45*c1 + 0.35*c12 + 0.3*c12*c3
    py = 0.45*s1 + 0.35*s12 + 0.3*s12*c3
    return np.array([[r11, r12, r13, px], [r21, r22, r23, py], [s3, c3, 0, 0.3*s3], [0, 0, 0, 1]])
"""
MILLIMETRES = """
import numpy as np
INNER, OUTER, COLUMN = 325.0, 275.0, 387.0

def f(q):
    shoulder, elbow, drop, wrist = q
    a = shoulder + elbow
    x = INNER*np.cos(shoulder) + OUTER*np.cos(a)
    y = INNER*np.sin(shoulder) + OUTER*np.sin(a)
    z = COLUMN - 1000*drop
    t = a - wrist
    T = np.eye(4)
    T[:3, :3] = [[np.cos(t), np.sin(t), 0], [np.sin(t), -np.cos(t), 0], [0, 0, -1]]
    T[:3, 3] = np.array([x, y, z])/1000
    return T
"""
ARTICULATED = """
import numpy as np
L, M = [0.5, 0.4], [2.0, 1.5]

def S3(p):
    return np.array([[0, -p[2], p[1]], [p[2], 0, -p[0]], [-p[1], p[0], 0]])

def crm(v):
    return np.block([[S3(v[:3]), np.zeros((3, 3))], [S3(v[3:]), S3(v[:3])]])

def f(q, qd, tau):
    S = np.array([0, 0, 1.0, 0, 0, 0])
    X, c, IA, pA, v = [], [], [], [], np.zeros(6)
    for i in range(2):
        E = np.array([[np.cos(q[i]), np.sin(q[i]), 0], [-np.sin(q[i]), np.cos(q[i]), 0], [0, 0, 1]])
        r = np.array([L[0]*i, 0, 0])
        X.append(np.block([[E, np.zeros((3, 3))], [-E @ S3(r), E]]))
        v = X[i] @ v + S*qd[i]
        c.append(crm(v) @ S*qd[i])
        K = S3([L[i], 0, 0])
        IA.append(np.block([[M[i]*K @ K.T, M[i]*K], [M[i]*K.T, M[i]*np.eye(3)]]))
        pA.append(-crm(v).T @ IA[i] @ v)
    U, D, u = [None]*2, [None]*2, [None]*2
    for i in (1, 0):
        U[i] = IA[i] @ S
        D[i] = S @ U[i]
        u[i] = tau[i] - S @ pA[i]
        if i:
            Ia = IA[i] - np.outer(U[i], U[i])/D[i]
            pa = pA[i] + Ia @ c[i] + U[i]*u[i]/D[i]
            IA[i - 1] = IA[i - 1] + X[i].T @ Ia @ X[i]
            pA[i - 1] = pA[i - 1] + X[i].T @ pa
    acc, qdd = np.array([0, 0, 0, 0, 9.81, 0]), np.zeros(2)
    for i in range(2):
        acc = X[i] @ acc + c[i]
        qdd[i] = (u[i] - U[i] @ acc)/D[i]
        acc = acc + S*qdd[i]
    return qdd
"""


@pytest.mark.many
@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar3r", "gravity_torques", CARRIED, "M[i]*up) + np.cross(p - pb, force)", "M[i]*up)"),
        ("planar3r", "statics", LOADED, "moment = wrench[5]", "moment = 0.0"),
        ("scara", "gravity_torques", LETTERS, 'z if LINKS[j][0] == "P" else np.cross(z, p - o)', "np.cross(z, p - o)"),
        ("planar3r", "gravity_torques", SUMS, "g[k] +=", "g[i] +="),
        ("planar3r", "statics", ALL_OF_A_ROW, "hand[2] += wrench[5]", "hand += wrench[5]"),
        ("planar3r", "mass_matrix_derivatives", FARTHER, "o[max(j, k)]", "o[ j]"),
        ("planar2r", "mass_matrix_derivatives", FROM_THE_FARTHER, "range(max(j, p), k + 1)", "range(j,  k + 1)"),
        ("planar3r", "com_jacobians", ONE_OF_ALL, "out[link, 5, j] = 1", "out[link, 5, :] = 1"),
        ("spatial3r", "mass_matrix", SECOND_MOMENTS, "np.trace(T)/2*np.eye(3) - T + m", "T + m"),
        ("spatial3r", "fk", HOME, "= np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])", "= np.eye( 3)"),
        ("stanford", "fk", ACROSS, "[0, -0.0203, q[2]]", "[0.0203, 0, q[2]]"),
        ("planar3r", "gradient_step", TWICE, "q - rate*grad", "q - rate*2*grad"),
        ("spatial3r", "fk", ENTRIES, "r23 = -c12", "r23 = c12"),
        ("scara", "fk", MILLIMETRES, "COLUMN - 1000*drop", "COLUMN - drop"),
        ("planar2r", "forward_dynamics", ARTICULATED, "pA[i] + Ia @ c[i] + U", "pA[i] + U"),
    ],
    ids=["carried", "unread", "letters", "inner", "entry", "index", "range", "slice", "tensor", "home", "axis", "two", "named", "metres", "matrix"],
)  # fmt: skip
def test_a_slip_in_a_loop_or_a_row_is_told_in_its_line(
    robot, quantity, text, right, slip, tmp_path
) -> None:
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")
