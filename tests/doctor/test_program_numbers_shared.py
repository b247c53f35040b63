"""Programs in which one number stands for several of an arm's, or stands where a loop takes it.

A repair is held against other arms; that the program's numbers are shared is no slip there.
"""

from __future__ import annotations

import pytest
from hand_programs import told_in_its_line

POINT_MASSES = """
import numpy as np
P12 = np.array([0.5, 0, 0])
P2t = np.array([0.4, 0, 0])
m1, m2 = 2.0, 1.5
z = np.array([0, 0, 1.0])

def Rz(a):
    return np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1.0]])

def f(q, qd, qdd, wrench):
    R01, R12, R02 = Rz(q[0]), Rz(q[1]), Rz(q[0] + q[1])
    w1, al1 = qd[0]*z, qdd[0]*z
    w2, al2 = w1 + qd[1]*z, al1 + qdd[1]*z
    a1 = R01.T @ np.array([0, 9.81, 0])
    ac1 = a1 + np.cross(al1, P12) + np.cross(w1, np.cross(w1, P12))
    a2 = R12.T @ ac1
    ac2 = a2 + np.cross(al2, P2t) + np.cross(w2, np.cross(w2, P2t))
    F1, F2 = m1*ac1, m2*ac2
    ft = R02.T @ wrench[:3]
    nt = R02.T @ wrench[3:]
    f2 = F2 + ft
    n2 = nt + np.cross(P2t, F2 + ft)
    f1 = F1 + R12 @ f2
    n1 = R12 @ n2 + np.cross(P12, F1) + np.cross(P12, R12 @ f2)
    return np.array([np.r_[f1, n1], np.r_[f2, n2]])
"""
SAME_LENGTHS = """
import numpy as np
a2, a3, d3 = 0.4318, 0.0203, 0.15005
d4 = a2

def f(q):
    c1, c2, c4, c5, c6 = np.cos(q[[0, 1, 3, 4, 5]])
    s1, s2, s4, s5, s6 = np.sin(q[[0, 1, 3, 4, 5]])
    c23, s23 = np.cos(q[1] + q[2]), np.sin(q[1] + q[2])
    R03 = np.array([[c1*c23, -s1, -c1*s23], [s1*c23, c1, -s1*s23], [s23, 0, c23]])
    R36 = np.array([[c4*c5*c6 - s4*s6, -c4*c5*s6 - s4*c6, -c4*s5],
                    [s4*c5*c6 + c4*s6, -s4*c5*s6 + c4*c6, -s4*s5], [s5*c6, -s5*s6, c5]])
    r = a2*c2 + a3*c23 - d4*s23
    T = np.eye(4)
    T[:3, :3] = R03 @ R36
    T[:3, 3] = [r*c1 + d3*s1, r*s1 - d3*c1, a2*s2 + a3*s23 + d4*c23]
    return T
"""
ABOUT_THE_HINGE = """
import numpy as np

def make(m, l, ic, g):
    half = l/2
    J = ic + m*half**2

    def accel(q, qd, tau):
        pull = m*g*half*np.cos(q)
        return (tau - pull)/J

    return accel

f = make(2.5, 0.6, 0.075, 9.81)
"""
TAKEN_BY_A_LOOP = """
import numpy as np
alphas, a, m = [0, 0, np.pi/2], [0, 0.45, 0.35], [3.0, 2.0, 1.2]
s = [np.array(c) for c in ([0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01])]
I = [np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045]),
     np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]])]

def f(q, qd):
    R, v, w, energy = np.eye(3), np.zeros(3), np.zeros(3), []
    for i in range(3):
        v = v + np.cross(w, R @ [a[i], 0, 0])
        c, k, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(alphas[i]), np.sin(alphas[i])
        R = R @ np.array([[c, -k, 0], [k*ca, c*ca, -sa], [k*sa, c*sa, ca]])
        w = w + R[:, 2]*qd[i]
        vc = v + np.cross(w, R @ s[i])
        wl = R.T @ w
        energy.append(0.5*m[i]*vc @ vc + 0.5*wl @ I[i] @ wl)
    return np.array(energy)
"""


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "slip"),
    [
        ("planar2r", "joint_wrenches", POINT_MASSES, "R02.T @ wrench[3:]", "wrench[3:]"),
        ("puma560", "fk", SAME_LENGTHS, "r*s1 - d3*c1", "r*s1 + d3*c1"),
        ("single_link", "forward_dynamics", ABOUT_THE_HINGE, "half*np.cos(q)", "half*np.sin(q)"),
        ("spatial3r", "link_kinetic_energies", TAKEN_BY_A_LOOP, "v + np.cross(w, R @ s[i])", "v + np.cross(w, s[i])"),
    ],
    ids=["masses", "lengths", "hinge", "loop"],
)  # fmt: skip
def test_a_number_shared_is_no_reason_against_a_repair(
    robot, quantity, text, right, slip, tmp_path
) -> None:
    told_in_its_line(robot, quantity, text, right, slip, tmp_path / "hand.py")
