"""What is put in place of a whole: a name for a part of something, a transform for its neighbour.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line

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
EXPONENTIALS = """
import numpy as np

def exp6(screw, theta):
    w, v = screw[:3], screw[3:]
    W = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
    G = np.eye(3)*theta + (1 - np.cos(theta))*W + (theta - np.sin(theta))*W @ W
    T = np.eye(4)
    T[:3, :3] = np.eye(3) + np.sin(theta)*W + (1 - np.cos(theta))*W @ W
    T[:3, 3] = G @ v
    return T

HOME = np.array([[1, 0, 0, 0.9], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
S1, S2 = np.array([0, 0, 1, 0, 0, 0.0]), np.array([0, 0, 1, 0, -0.5, 0])

def f(q):
    return exp6(S1, q[0]) @ exp6(S2, q[1]) @ HOME
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
