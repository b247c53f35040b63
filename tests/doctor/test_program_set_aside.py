"""What is set and used nowhere, products by a method, half a screw.

Every program is right before the slip; what is said makes it right, and is what was there.
"""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line

METHOD = """
import numpy as np
A, AL, D = [0, 0, 0.0203, 0, 0, 0], [-1, 1, 0, -1, 1, 0], [0.412, 0.154, 0, 0, 0, 0.263]

class Row:
    def __init__(self, a, al, d):
        self.a, self.ca, self.sa, self.d = a, np.cos(al*np.pi/2), np.sin(al*np.pi/2), d

    def matrix(self, t, d):
        c, s = np.cos(t), np.sin(t)
        return np.array([[c, -s*self.ca, s*self.sa, self.a*c], [s, c*self.ca, -c*self.sa, self.a*s],
                         [0, self.sa, self.ca, self.d + d], [0, 0, 0, 1]])

ROWS = [Row(*one) for one in zip(A, AL, D)]

def f(q):
    T = np.eye(4)
    for k, row in enumerate(ROWS):
        slides = k == 2
        T = T.dot(row.matrix(-np.pi/2 if slides else q[k], q[k] if slides else 0))
    return T
"""
IDLE = """
import numpy as np
A, D = [0, 0, 0.0203, 0, 0, 0], [0.412, 0.154, 0, 0, 0, 0.263]
AL, M = [-1, 1, 0, -1, 1, 0], [9.29, 5.01, 4.25, 1.08, 0.63, 0.51]
C = [[0, 0.0175, -0.1105], [0, -0.1054, 0], [0, 0, -0.6447], [0, 0.0092, -0.0054],
     [0, 0, 0.0566], [0, 0, 0.1554]]

def f(q):
    T, axes, feet, centres = np.eye(4), [], [], []
    for k in range(6):
        axes.append(T[:3, 2])
        feet.append(T[:3, 3])
        t, d = (-np.pi/2, q[2]) if k == 2 else (q[k], D[k])
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(AL[k]*np.pi/2), np.sin(AL[k]*np.pi/2)
        T = T @ [[c, -s*ca, s*sa, A[k]*c], [s, c*ca, -c*sa, A[k]*s], [0, sa, ca, d], [0, 0, 0, 1]]
        centres.append(T[:3, :3] @ C[k] + T[:3, 3])
    g = np.zeros(6)
    for k in range(6):
        load, turn = np.zeros(3), np.zeros(3)
        for j in range(k, 6):
            weight = np.array([0, 0, 9.81*M[j]])
            load = load + weight
            turn = turn + np.cross(centres[j] - feet[k], weight)
        if k == 2:
            g[k] = axes[k] @ load
        else:
            g[k] = axes[k] @ turn
    return g
"""
SCREWS = """
import numpy as np

def f(q):
    xa, ya = 0.325*np.cos(q[0]), 0.325*np.sin(q[0])
    xb, yb = xa + 0.275*np.cos(q[0] + q[1]), ya + 0.275*np.sin(q[0] + q[1])
    columns = [
        [0, 0, 0, 0, 0, 1],
        [ya, -xa, 0, 0, 0, 1],
        [0, 0, -1, 0, 0, 0],
        [-yb, xb, 0, 0, 0, -1],
    ]
    return np.array(columns).T
"""

FROM_TEXT = '''
import numpy as np
WEIGHTS = """
3.7     0      0        0
8.393   0.145  0        0.13585
2.275   0.14225 0       0.01615
1.219   0     -0.093    0
1.219   0      0.09465  0
0.1879  0      0       -0.0823
"""
WEIGHTS = [[float(x) for x in line.split()] for line in WEIGHTS.strip().split("\\n")]
ROWS = [(0, 1, 0.089159), (-0.425, 0, 0), (-0.39225, 0, 0), (0, 1, 0.10915), (0, -1, 0.09465), (0, 0, 0.0823)]

def poses(q):
    T = np.eye(4)
    yield T
    for t, (a, turn, d) in zip(q, ROWS):
        c, s = np.cos(t), np.sin(t)
        ca, sa = (1, 0) if turn == 0 else (0, turn)
        T = T @ np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])
        yield T

def f(q):
    energy = 0.0
    for T, (m, *c) in zip(list(poses(q))[1:], WEIGHTS):
        energy += 9.81*m*(T[2, :3] @ c + T[2, 3])
    return energy
'''
INNER = """
import numpy as np

def f(q):
    def along(t):
        return np.array([np.cos(t), np.sin(t), 0, 0, 0, 0])

    def across(t):
        return np.array([-np.sin(t), np.cos(t), 0, 0, 0, 0])

    z = np.array([0, 0, 0, 0, 0, 1.0])
    a, b, c = np.cumsum(q)
    hand = 0.25*across(c)
    fore = hand + 0.4*across(b)
    return np.column_stack([fore + 0.5*across(a) + z, fore + z, hand + z])
"""
OWN = """
import numpy as np
M, C = [3.0, 2.0, 1.2], np.array([[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]])
P = np.array([[0, 0, 0], [0.45, 0, 0], [0.35, 0, 0], [0.3, 0, 0]])

def f(q):
    R = [np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]]) for t in q]
    R[2] = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]) @ R[2]
    up, R = [np.array([0, 0, 9.81])], R + [np.eye(3)]
    for i in range(3):
        up.append(R[i].T @ up[i])
    force, moment, tau = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in (2, 1, 0):
        weight, carried = M[i]*up[i + 1], R[i + 1] @ force
        moment = R[i + 1] @ moment + np.cross(C[i], weight) + np.cross(P[i + 1], carried)
        force = weight + carried
        tau[i] = moment[2]
    return tau
"""
NEXT = """
import numpy as np
C = np.array([[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]])  # for a drawing
P = np.array([[0, 0, 0], [0.45, 0, 0], [0.35, 0, 0], [0.3, 0, 0]])

def f(q, wrench):
    R = [np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]]) for t in q]
    R[2] = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]) @ R[2]
    whole = R[0] @ R[1] @ R[2]
    R.append(np.eye(3))
    force, moment, tau = whole.T @ wrench[:3], whole.T @ wrench[3:], np.zeros(3)
    for i in (2, 1, 0):
        carried = R[i + 1] @ force
        moment = R[i + 1] @ moment + np.cross(P[i + 1], carried)
        force = carried
        tau[i] = moment[2]
    return tau
"""
BESIDE = """
import numpy as np

def f(q, twist):
    x2, y2 = 0.4*np.cos(q[0] + q[1]), 0.4*np.sin(q[0] + q[1])
    x1, y1 = 0.5*np.cos(q[0]) + x2, 0.5*np.sin(q[0]) + y2
    a = x1*x1 + y1*y1 + 1
    b = x1*x2 + y1*y2 + 1
    c = x2*x2 + y2*y2 + 1
    u = -y1*twist[0] + x1*twist[1] + twist[5]
    v = -y2*twist[0] + x2*twist[1] + twist[5]
    return np.array([c*u - b*v, a*v - b*u])/(a*c - b*b)
"""


@pytest.mark.many
@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("stanford", "fk", METHOD, "T = T.dot(row.matrix(-np.pi/2 if slides else q[k], q[k] if slides else 0))", "T = row.matrix(-np.pi/2 if slides else q[k], q[k] if slides else 0).dot(T)"),
        ("stanford", "gravity_torques", IDLE, "@ load", "@ turn"),
        ("scara", "jacobian_spatial", SCREWS, "[-yb, xb, 0, 0, 0, -1]", "[yb, -xb, 0, 0, 0, -1]"),
        ("ur5", "potential_energy", FROM_TEXT, "list(poses(q))[1:]", "list(poses(q))"),
        ("ur5", "potential_energy", FROM_TEXT, "s, c*ca, -c*sa", "s, c*ca, c*sa"),
        ("planar3r", "jacobian", INNER, "hand = 0.25*across(c)", "hand = 0.25*along(c)"),
        ("spatial3r", "gravity_torques", OWN, "np.cross(C[i], weight)", "np.cross(P[i + 1], weight)"),
        ("spatial3r", "statics", NEXT, "np.cross(P[i + 1], carried)", "np.cross(C[i], carried)"),
        ("planar2r", "least_rates", BESIDE, "b = x1*x2 + y1*y2 + 1", "b = x1*x2 + y1*y2"),
    ],
    ids=["method", "idle", "screw", "first", "sign", "inner", "own", "next", "beside"],
)  # fmt: skip
def test_what_is_written_for_another_is_told_in_its_line(
    robot, quantity, text, right, slip, tmp_path
) -> None:
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")
