"""A corrected line is written as people write it: no minus in front of a difference, no half in
front of a quotient, vectors of a cross product exchanged, and the first of two joints in front.

Every program is right before its slips, which its verdict tells first; what is said makes it right.
"""

from __future__ import annotations

import pytest
from hand_programs import BACK, with_slips, written

import kinlab as kl

ELBOW = """
from math import acos, atan2, cos, sin, sqrt

def f(x, y, phi):
    l1, l2, l3 = 0.5, 0.4, 0.25
    px, py = x - l3*cos(phi), y - l3*sin(phi)
    D = (px*px + py*py - l1*l1 - l2*l2)/(2*l1*l2)
    q2 = acos(D)
    q1 = atan2(py, px) - atan2(l2*sin(q2), l1 + l2*cos(q2))
    q3 = phi - q1 - q2
    return q1, q2, q3
"""
RODS = """
from math import cos, sin

class Rods:
    def __init__(self):
        self.m1, self.m2, self.l1, self.r1, self.r2 = 2.0, 1.5, 0.5, 0.25, 0.2
        self.I1, self.I2 = 2.0*0.5**2/12, 1.5*0.4**2/12

    def tau(self, q, v, a):
        m11 = self.I1 + self.I2 + self.m1*self.r1**2
        m11 = m11 + self.m2*(self.l1**2 + self.r2**2 + 2*self.l1*self.r2*cos(q[1]))
        m12 = self.I2 + self.m2*(self.r2**2 + self.l1*self.r2*cos(q[1]))
        m22 = self.I2 + self.m2*self.r2**2
        h = self.m2*self.l1*self.r2*sin(q[1])
        G1 = 9.81*(self.m1*self.r1 + self.m2*self.l1)*cos(q[0])
        G2 = 9.81*self.m2*self.r2*cos(q[0] + q[1])
        first = m11*a[0] + m12*a[1] - h*v[1]*(2*v[0] + v[1]) + G1 + G2
        return [first, m12*a[0] + m22*a[1] + h*v[0]**2 + G2]

ARM = Rods()

def f(q, v, a):
    return ARM.tau(q, v, a)
"""
PLANE = """
import numpy as np

L, C, m = [0.5, 0.4, 0.25], [0.25, 0.2, 0.125], [3.0, 2.0, 1.0]
J = [0.0625, 2*0.4**2/12, 1*0.25**2/12]

def turned(t):
    return np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]])

def f(q, v, a):
    w = wd = 0.0
    acc, F, N = np.array([0.0, 9.81]), [], []
    for i in range(3):
        back = np.array([L[i - 1], 0.0]) if i else np.zeros(2)
        acc = turned(q[i]).T @ (acc + wd*np.array([0.0, back[0]]) - w**2*back)
        w = w + v[i]
        wd = wd + a[i]
        F.append(m[i]*(acc + np.array([-w**2*C[i], wd*C[i]])))
        N.append(J[i]*wd)
    tau, push, turning = np.zeros(3), np.zeros(2), 0.0
    for i in (2, 1, 0):
        push = turned(q[i + 1]) @ push if i < 2 else push
        turning = turning + L[i]*push[1] + N[i] + C[i]*F[i][1]
        push = push + F[i]
        tau[i] = turning
    return tau
"""
PROGRAMS = {
    "elbow": ("planar3r", "inverse_kinematics_xyphi", ELBOW),
    "rods": ("planar2r_rods", "inverse_dynamics", RODS),
    "plane": ("planar3r", "inverse_dynamics", PLANE),
    "back": ("spatial3r", "statics", BACK),
}
FOUND = [
    ("elbow", "phi - q1 - q2", "q1 + q2 - phi"),
    ("elbow", "l2*l2)/(2*l1*l2)", "l2*l2)/(l1*l2)"),
    ("rods", "self.m1*self.r1**2", "self.m1*self.r1"),
    ("rods", "(2*v[0] + v[1])", "(v[0] + v[1])"),
    ("rods", "cos(q[0] + q[1])", "cos(q[1])"),
    ("plane", "L[i]*push[1]", "C[i]*push[1]"),
    ("plane", "wd + a[i]", "a[i]"),
    ("back", "np.cross(P2, f1)", "np.cross(f1, P2)"),
]


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.compare(robot, quantity, written(text)).agrees


@pytest.mark.parametrize(("name", "right", "wrong"), FOUND)
def test_the_line_is_told_as_it_was(name, right, wrong) -> None:
    robot, quantity, text = PROGRAMS[name]
    found = kl.diagnose(robot, quantity, written(with_slips(text, [(right, wrong)])))
    assert not found.agrees
    said = found.causes[0].sentence.replace(" ", "")
    whole = "wd+=a[i]" if wrong == "a[i]" else right.replace(" ", "")
    assert whole in said, said
