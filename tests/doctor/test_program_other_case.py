"""What is set and used nowhere, inverses of poses, methods in place of operators, other arms.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line

STATICS = """
import numpy as np
D = [0.089159, 0, 0, 0.10915, 0.09465, 0.0823]
A = [0, -0.425, -0.39225, 0, 0, 0]
AL = [np.pi/2, 0, 0, np.pi/2, -np.pi/2, 0]

def f(q, w):
    T, frames = np.diag([-1.0, -1.0, 1.0, 1.0]), []
    for t, d, a, al in zip(q, D, A, AL):
        frames.append(T)
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
        T = T.dot(np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]]))
    J = np.column_stack([np.r_[np.cross(F[:3, 2], T[:3, 3] - F[:3, 3]), F[:3, 2]] for F in frames])
    return J.T.dot(w)
"""
SLIDE = """
import numpy as np
KIND = "RRPRRR"
AL = (-np.pi/2, np.pi/2, 0, -np.pi/2, np.pi/2, 0)
D, A = [0.412, 0.154, 0, 0, 0, 0.263], [0, 0, 0.0203, 0, 0, 0]

def f(q):
    T, frames = np.eye(4), [np.eye(4)]
    for k, kind in enumerate(KIND):
        t, d = (q[k], D[k]) if kind == "R" else (-np.pi/2, q[k])
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(AL[k]), np.sin(AL[k])
        T = T @ np.array([[c, -s*ca, s*sa, A[k]*c], [s, c*ca, -c*sa, A[k]*s], [0, sa, ca, d],
                          [0, 0, 0, 1]])
        frames.append(T)
    J = np.zeros((6, 6))
    for k, kind in enumerate(KIND):
        axis, lever = frames[k][:3, 2], T[:3, 3] - frames[k][:3, 3]
        hinge = np.hstack([np.cross(axis, lever), axis])
        slide = np.hstack([axis, np.zeros(3)])
        J[:, k] = hinge if kind == "R" else slide
    return J
"""
ROTORS = """
import numpy as np

def f(q, v, a):
    phi = np.cumsum(q[:2])
    w, dw = np.cumsum(v[:2]), np.cumsum(a[:2])
    end, dend = phi[1] - q[3], dw[1] - a[3]
    u, ue = np.exp(1j*phi), np.exp(1j*end)
    turn = lambda r, k: (1j*dw[k] - w[k]**2)*r*u[k]
    elbow = turn(0.325, 0)
    acc = [turn(0.165, 0), elbow + turn(0.145 - 0.005j, 1), elbow + turn(0.275, 1)]
    acc.append(acc[2] + (1j*dend - (w[1] - v[3])**2)*0.01*ue)
    at = [0.165*u[0], 0.325*u[0] + (0.145 - 0.005j)*u[1], 0.325*u[0] + 0.275*u[1]]
    at.append(at[2] + 0.01*ue)
    force = [m*x for m, x in zip((7.0, 5.0, 1.2, 0.4), acc)]
    spin = [0.1*dw[0], 0.055*dw[1], 0.0008*dw[1], 0.0006*dend]
    about = lambda p, k: sum(spin[j] + ((at[j] - p).conjugate()*force[j]).imag for j in range(k, 4))
    up = 1.6*(a[2] - 9.81)
    J = (0.3, 0.1, 2.0, 0.02)
    return [about(0, 0) + J[0]*a[0], about(0.325*u[0], 1) + J[1]*a[1], up + J[2]*a[2], J[3]*a[3] - about(at[2], 3)]
"""
FLANGE = """
import numpy as np
ALPHA = np.array([0, -1, 1, 1, -1, 1, 1])*np.pi/2
A, D = (0, 0, 0, 0.0825, -0.0825, 0, 0.088), (0.333, 0, 0.316, 0, 0.384, 0, 0)
FLANGE = 0.107

def f(q):
    T, frames = np.eye(4), np.zeros((7, 4, 4))
    for k in range(7):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(ALPHA[k]), np.sin(ALPHA[k])
        T = T @ np.array([[c, -s, 0, A[k]], [s*ca, c*ca, -sa, -sa*D[k]], [s*sa, c*sa, ca, ca*D[k]],
                          [0, 0, 0, 1]])
        frames[k] = T
    z, p = frames[:, :3, 2], frames[:, :3, 3]
    tip = p[6] + FLANGE*z[6]
    return np.vstack([np.cross(z, tip - p).T, z.T])
"""
BODY = """
import numpy as np

def hat(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])

def adjoint(T):
    R, p = T[:3, :3], T[:3, 3]
    return np.block([[R, np.zeros((3, 3))], [hat(p) @ R, R]])

def back(T):
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = T[:3, :3].T, -T[:3, :3].T @ T[:3, 3]
    return out

def exp6(V, t):
    W, T = hat(V[:3]), np.eye(4)
    T[:3, :3] += np.sin(t)*W + (1 - np.cos(t))*W @ W
    T[:3, 3] = (np.eye(3)*t + (1 - np.cos(t))*W + (t - np.sin(t))*W @ W) @ V[3:]
    return T

AXES = [[0, 0, 1], [0, -1, 0], [0, -1, 0], [0, -1, 0], [0, 0, -1], [0, -1, 0]]
POINTS = [[0, 0, 0], [0, 0, 0.089159], [-0.425, 0, 0.089159], [-0.81725, 0, 0.089159],
          [-0.81725, -0.10915, 0.089159], [-0.81725, 0, -0.005491]]
S = np.array([np.r_[w, -np.cross(w, p)] for w, p in zip(AXES, POINTS)], dtype=float)
HOME = np.array([[1, 0, 0, -0.81725], [0, 0, -1, -0.19145], [0, 1, 0, -0.005491], [0, 0, 0, 1.0]])

def f(q):
    T, columns = np.eye(4), []
    for V, t in zip(S, q):
        columns.append(adjoint(T) @ V)
        T = T @ exp6(V, t)
    J = adjoint(np.linalg.inv(T @ HOME)) @ np.column_stack(columns)
    return J[[3, 4, 5, 0, 1, 2]]
"""
WITH_BACK = BODY.replace("np.linalg.inv(T @ HOME)", "back(T @ HOME)")
FALLING = """
import numpy as np
TABLE = [(0.0, np.pi/2, 0.0), (0.4318, 0.0, 0.0), (0.0203, -np.pi/2, 0.15005), (0.0, np.pi/2, 0.4318),
         (0.0, -np.pi/2, 0.0), (0.0, 0.0, 0.0)]
M = [0, 17.4, 4.8, 0.82, 0.34, 0.09]
C = [[0, 0, 0], [-0.3638, 0.006, 0.2275], [-0.0203, -0.0141, 0.07], [0, 0.019, 0], [0, 0, 0], [0, 0, 0.032]]

def f(q):
    R, way, falls = [], [], []
    whole = np.eye(3)
    for t, (a, al, d) in zip(q, TABLE):
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
        R.append(np.array([[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]]))
        way.append(np.array([a, d*sa, d*ca]))
    for k in range(6):
        whole = whole @ R[k]
        falls.append(whole.T @ [0, 0, 9.81])
    push, turn, out = np.zeros(3), np.zeros(3), np.zeros(6)
    for k in (5, 4, 3, 2, 1, 0):
        R2 = R[k+1] if k < 5 else np.eye(3)
        push, turn = R2 @ push, R2 @ turn
        turn = turn + np.cross(way[k], push) + np.cross(way[k] + C[k], M[k]*falls[k])
        push = push + M[k]*falls[k]
        out[k] = turn @ (R[k].T @ [0, 0, 1])
    return out
"""
ENERGY = """
import numpy as np
AL = [0, np.pi/2, 0, -np.pi/2, np.pi/2, -np.pi/2]
P = [[0, 0, 0], [0, 0, 0], [0.4318, 0, 0.15005], [0.0203, 0.4318, 0], [0, 0, 0], [0, 0, 0]]
M = [0, 17.4, 4.8, 0.82, 0.34, 0.09]
C = [[0, 0, 0], [0.068, 0.006, 0.2275], [0, 0.07, 0.0141], [0, 0, 0.019], [0, 0, 0], [0, 0, 0.032]]
I = np.array([[0, 0, 0], [0.13, 0.524, 0.539], [0.0685, 0.015, 0.0835], [1.8e-3, 1.8e-3, 1.3e-3],
              [3e-4, 3e-4, 4e-4], [1.5e-4, 1.5e-4, 4e-5]])
J = [1.134029969, 2.324814845, 0.576873332, 0.190790626, 0.170706292, 0.194064506]

def f(q, v):
    w, u, T = np.zeros(3), np.zeros(3), 0.0
    for k in range(6):
        c, s, ca, sa = np.cos(q[k]), np.sin(q[k]), np.cos(AL[k]), np.sin(AL[k])
        down = np.array([[c, s*ca, s*sa], [-s, c*ca, c*sa], [0, -sa, ca]])
        u = down @ (u + np.cross(w, P[k]))
        w = down @ w + [0, 0, v[k]]
        g = u + np.cross(w, C[k])
        T += 0.5*(M[k]*g.dot(g) + (I[k]*w).dot(w) + J[k]*v[k]**2)
    return T
"""
STACKED = """
import numpy as np
DH = np.array([[0, np.pi/2, 0.089159], [-0.425, 0, 0], [-0.39225, 0, 0],
               [0, np.pi/2, 0.10915], [0, -np.pi/2, 0.09465], [0, 0, 0.0823]])
MASS = np.array([3.7, 8.393, 2.275, 1.219, 1.219, 0.1879])
COG = np.array([[0, 0, 0], [0.145, 0, 0.13585], [0.14225, 0, 0.01615], [0, -0.093, 0],
                [0, 0.09465, 0], [0, 0, -0.0823]])
I = np.array([[0.010267496, 0.00666, 0.010267496], [0.0151074, 0.226890676, 0.226890676],
              [0.004095, 0.049443314, 0.049443314], [0.111172756, 0.111172756, 0.21942],
              [0.111172756, 0.21942, 0.111172756], [0.017136473, 0.033822, 0.017136473]])
BIG = np.diag(np.hstack([MASS[:, None].repeat(3, 1), I]).ravel())

def f(q):
    R, p = np.eye(3), np.zeros(3)
    z, o, rows = np.zeros((6, 3)), np.zeros((6, 3)), np.zeros((6, 6, 6))
    for i, (a, al, d) in enumerate(DH):
        z[i], o[i] = R[:, 2], p
        c, s = np.cos(q[i]), np.sin(q[i])
        p = p + R @ [a*c, a*s, d]
        R = R @ np.array([[c, -s*np.cos(al), s*np.sin(al)], [s, c*np.cos(al), -c*np.sin(al)],
                          [0, np.sin(al), np.cos(al)]])
        for j in range(i + 1):
            rows[i, :3, j] = R.T @ np.cross(z[j], p + R @ COG[i] - o[j])
            rows[i, 3:, j] = R.T @ z[j]
    B = rows.reshape(36, 6)
    return B.T @ BIG @ B
"""
COPIED = """
import numpy as np
A1, A2 = 0.325, 0.275
R1 = A1 - 0.16

def f(q):
    c2, s2, c24, c4 = np.cos(q[1]), np.sin(q[1]), np.cos(q[1] - q[3]), np.cos(q[3])
    k = 5.0*0.145 + 1.6*A2
    N = np.diag([0.1 + 7.0*R1**2 + 6.6*A1**2, 0.0558 + 5.0*(0.145**2 + 0.005**2) + 1.6*A2**2, 0.0006 + 0.4*0.01**2])
    N[0, 1] = N[1, 0] = A1*(k*c2 + 5.0*0.005*s2)
    N[0, 2] = N[2, 0] = 0.4*0.01*A1*c24
    N[1, 2] = N[2, 1] = 0.4*0.01*A2*c4
    W = np.array([[1, 0, 0, 0], [1, 1, 0, 0], [1, 1, 0, -1]])
    return W.T @ N @ W + np.diag([0.3, 0.1, 2.0 + 1.6, 0.02])
"""


@pytest.mark.many
@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("ur5", "statics", STATICS, "return J.T.dot(w)", "return J.dot(w)"),
        ("stanford", "jacobian", SLIDE, 'hinge if kind == "R" else slide\n    return', "hinge\n    return"),
        ("scara", "inverse_dynamics", ROTORS, ", up + J[2]*a[2], J", ", up, J"),
        ("panda", "jacobian", FLANGE, "p[6] + FLANGE*z[6]", "p[6]"),
        ("ur5", "jacobian_tool", BODY, "np.linalg.inv(T @ HOME)", "T @ HOME"),
        ("ur5", "jacobian_tool", WITH_BACK, "back(T @ HOME)", "T @ HOME"),
        ("puma560", "gravity_torques", FALLING, "whole.T @ [0, 0, 9.81]", "R[k].T @ [0, 0, 9.81]"),
        ("puma560_modified", "kinetic_energy", ENERGY, "[-s, c*ca, c*sa]", "[s, c*ca, c*sa]"),
        ("puma560_modified", "kinetic_energy", ENERGY, "(I[k]*w).dot(w)", "(I[k]*w).sum()"),
        ("ur5", "mass_matrix", STACKED, "rows[i, 3:, j] = R.T @ z[j]", "rows[i, 3:, j] = z[j]"),
        ("ur5", "mass_matrix", STACKED, "R @ [a*c, a*s, d]", "R @ [a, 0, d]"),
        ("scara", "mass_matrix", COPIED, "R1 = A1 - 0.16", "R1 = A1"),
    ],
    ids=["dot", "slide", "rotor", "flange", "inverse", "own", "name", "sign", "square", "large", "way", "copy"],
)  # fmt: skip
def test_what_is_lost_is_told_in_its_line(robot, quantity, text, right, slip, tmp_path) -> None:
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")
