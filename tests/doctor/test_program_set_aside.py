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


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("stanford", "fk", METHOD, "T = T.dot(row.matrix(-np.pi/2 if slides else q[k], q[k] if slides else 0))", "T = row.matrix(-np.pi/2 if slides else q[k], q[k] if slides else 0).dot(T)"),
        ("stanford", "gravity_torques", IDLE, "@ load", "@ turn"),
        ("scara", "jacobian_spatial", SCREWS, "[-yb, xb, 0, 0, 0, -1]", "[yb, -xb, 0, 0, 0, -1]"),
    ],
    ids=["method", "idle", "screw"],
)  # fmt: skip
def test_what_is_written_for_another_is_told_in_its_line(
    robot, quantity, text, right, slip, tmp_path
) -> None:
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")
