"""Numbers that are off beside the arm's table are mended first; what is known of a turned base.

Every program is right before its slips; what is said makes it right.
"""

from __future__ import annotations

import cProfile
import sys

import numpy as np
import pytest
from hand_programs import lines_named, repaired, with_slips, written

import kinlab as kl
from kinlab.doctor.program.grounds.evidence import zeros_and_ones
from kinlab.doctor.program.search.mistyped import is_slip

STATICS = """
import numpy as np

A = [0, -0.612, -0.5723, 0, 0, 0]
D = [0.1273, 0, 0, 0.163941, 0.1157, 0.0922]
TURNS = np.array([1, 0, 0, 1, -1, 0])*np.pi/2

def link(k, t):
    c, s, ca, sa = np.cos(t), np.sin(t), np.cos(TURNS[k]), np.sin(TURNS[k])
    R = np.array([[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]])
    return R, np.array([A[k]*c, A[k]*s, D[k]])

def f(q, wrench):
    force, moment = np.array(wrench[:3]), np.array(wrench[3:])
    out = np.zeros(6)
    for k in reversed(range(6)):
        R, p = link(k, q[k])
        force, moment = R @ force, R @ moment
        moment = moment + np.cross(p, force)
        out[k] = moment[2]
    return out
"""
MASSES = """
import numpy as np

ARM = {
    "a": [0, -0.425, -0.39225, 0, 0, 0],
    "d": [0.089159, 0, 0, 0.10915, 0.09465, 0.0823],
    "alpha": [np.pi/2, 0, 0, np.pi/2, -np.pi/2, 0],
    "m": [3.7, 8.393, 2.275, 1.219, 1.219, 0.1879],
    "c": [(0, 0, 0), (0.145, 0, 0.13585), (0.14225, 0, 0.01615), (0, -0.093, 0), (0, 0.09465, 0),
          (0, 0, -0.0823)],
    "I": [(0.010267496, 0.00666, 0.010267496), (0.0151074, 0.226890676, 0.226890676),
          (0.004095, 0.049443314, 0.049443314), (0.111172756, 0.111172756, 0.21942),
          (0.111172756, 0.21942, 0.111172756), (0.017136473, 0.033822, 0.017136473)],
}

def row(k, t):
    a, d, al = (ARM[name][k] for name in ("a", "d", "alpha"))
    ct, st, ca, sa = np.cos(t), np.sin(t), np.cos(al), np.sin(al)
    return np.array([[ct, -st*ca, st*sa, a*ct], [st, ct*ca, -ct*sa, a*st], [0, sa, ca, d],
                     [0, 0, 0, 1]])

def f(q):
    frames = [np.eye(4)]
    for k in range(6):
        frames.append(frames[k] @ row(k, q[k]))
    M = np.zeros((6, 6))
    for k in range(6):
        R = frames[k+1][:3, :3]
        centre = frames[k+1][:3, 3] + R @ np.array(ARM["c"][k])
        Jv, Jw = np.zeros((3, 6)), np.zeros((3, 6))
        for j in range(k + 1):
            axis = frames[j][:3, 2]
            Jv[:, j] = np.cross(axis, centre - frames[j][:3, 3])
            Jw[:, j] = axis
        tensor = R @ np.diag(ARM["I"][k]) @ R.T
        M += ARM["m"][k]*Jv.T @ Jv + Jw.T @ tensor @ Jw
    return M
"""
SHIFTS = """
import numpy as np

DH = {"a": [0, 0.4318, 0.0203, 0, 0, 0], "d": [0, 0, 0.15005, 0.4318, 0, 0]}
TWIST = np.deg2rad([90, 0, -90, 90, -90, 0])

def about(t, x, y):
    R = np.eye(4)
    R[[x, x, y, y], [x, y, x, y]] = np.cos(t), -np.sin(t), np.sin(t), np.cos(t)
    return R

def shift(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T

def f(q):
    T = np.eye(4)
    for k in range(6):
        T = T @ about(q[k], 0, 1) @ shift(0, 0, DH["d"][k]) @ shift(DH["a"][k], 0, 0)
        T = T @ about(TWIST[k], 1, 2)
    return T
"""
RODS = """
import numpy as np

class Arm:
    def __init__(self):
        self.m1, self.m2, self.l1, self.l2 = 2.0, 1.5, 0.5, 0.4
        self.lc1, self.lc2 = self.l1/2, self.l2/2

        self.I1, self.I2 = self.m1*self.l1**2/12, self.m2*self.l2**2/12

    def masses(self, c2):
        m22 = self.I2 + self.m2*self.lc2**2
        m12 = m22 + self.m2*self.l1*self.lc2*c2
        m11 = self.I1 + self.m1*self.lc1**2 + self.m2*self.l1**2 + 2*m12 - m22
        return np.array([[m11, m12], [m12, m22]])

    def speeds(self, s2, v):
        h = self.m2*self.l1*self.lc2*s2
        return np.array([-h*(2*v[0]*v[1] + v[1]**2), h*v[0]**2])

    def weights(self, q):
        one, two = np.cos(q[0]), np.cos(q[0] + q[1])
        g2 = 9.81*self.m2*self.lc2*two
        return np.array([9.81*(self.m1*self.lc1 + self.m2*self.l1)*one + g2, g2])

def f(q, v, a):
    arm = Arm()
    return arm.masses(np.cos(q[1])) @ a + arm.speeds(np.sin(q[1]), v) + arm.weights(q)
"""
RIGHT = {
    "statics": (STATICS, "ur10", "statics_tool"),
    "masses": (MASSES, "ur5", "mass_matrix"),
    "shifts": (SHIFTS, "puma560", "fk"),
    "rods": (RODS, "planar2r_rods", "inverse_dynamics"),
}


@pytest.mark.parametrize("name", RIGHT)
def test_the_programs_are_right(name) -> None:
    text, robot, quantity = RIGHT[name]
    assert kl.compare(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips"),
    [
        pytest.param("statics", [("0.163941", "0.136941"), ("R @ force", "R.T @ force")],
                     id="digits of a column, and a transpose"),
        pytest.param("statics", [("1, -1, 0])*np.pi", "1, 1, 0])*np.pi"), ("A[k]*s, D", "A[k]*c, D"),
                                 ("= moment[2]", "= force[2]")],
                     id="the sign of a quarter turn, and two more"),
        pytest.param("statics", [("-0.5723", "-0.5273"), ("0.1157", "0.1517"),
                                 ("np.cross(p, force)", "np.cross(force, p)")],
                     id="two numbers, and an order"),
        pytest.param("shifts", [("0.15005", "0.15050"), ("-np.sin(t), np.sin(t)", "np.sin(t), -np.sin(t)")],
                     id="a number of a dictionary, and a sign"),
        pytest.param("masses", [("ca, sa = ", "sa, ca = "), ("frames[j][:3, 3]", "frames[k][:3, 3]"),
                                ("R @ np.diag(ARM[\"I\"][k]) @ R.T", "np.diag(ARM[\"I\"][k])")],
                     id="three that are wrong in the axes of a base that is turned"),
        pytest.param("rods", [("self.lc2*s2", "self.l2*s2")], id="a length for a centre"),
        pytest.param("shifts", [("shift(DH[\"a\"][k], 0, 0)", "shift(0, DH[\"a\"][k], 0)")],
                     id="what a translation is given"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told(name, slips) -> None:
    text, robot, quantity = RIGHT[name]
    wrong = with_slips(text, slips)
    found = kl.diagnose(robot, quantity, written(wrong))
    assert not found.agrees and found.causes, str(found)
    said = found.causes[0].sentence
    places = {
        k
        for k, (a, b) in enumerate(zip(text.split("\n"), wrong.split("\n"), strict=True), 1)
        if a != b
    }
    assert len(found.causes[0].kinds) == len(slips), said
    assert any(kl.compare(robot, quantity, one["f"]).agrees for one in repaired(wrong, said)), said
    if name != "masses":  # of a tensor that is not turned, where it is used does as well
        assert {*lines_named(said)} == places or "A[" in said or "D[" in said or "DH[" in said, said


def test_the_centre_is_that_of_the_mass_beside_it() -> None:
    text, robot, quantity = RIGHT["rods"]
    found = kl.diagnose(robot, quantity, written(with_slips(text, [("self.lc2*s2", "self.l2*s2")])))
    assert "self.l1*self.lc2" in found.causes[0].sentence.split("should be")[1]


@pytest.mark.parametrize(
    ("typed", "meant", "slip"),
    [
        (0.136941, 0.163941, True), (0.15050, 0.15005, True), (0.203, 0.0203, True), (-0.4, 0.4, True),
        (0.0, 0.4318, False), (-1.0, 0.07, False), (0.25, 0.5, False), (0.170, 0.107, True),
        (0.3, 0.005, False), (0.4318, 0.15005, False), (1.0, 0.001, False), (413.8, 0.4128, False),
        (413.8, 431.8, True), (1e-05, 4e-05, False),
    ],
)  # fmt: skip
def test_which_numbers_are_a_slip_of_the_pen(typed, meant, slip) -> None:
    assert is_slip(typed, meant) is slip


def test_what_rounding_leaves_of_a_zero_is_nothing() -> None:
    assert zeros_and_ones(np.array([6.1e-17, -1.0, 1.0 - 1e-16]))
    assert not zeros_and_ones(np.array([1e-9, 1.0]))


def test_a_profile_of_the_user_s_goes_on() -> None:
    """The calls of a program are counted in a thread of their own."""
    text, robot, quantity = RIGHT["rods"]
    wrong = written(with_slips(text, [("v[1]**2", "v[1]")]))

    def seen(*_event: object) -> None:
        return None

    sys.setprofile(seen)
    try:
        found = kl.diagnose(robot, quantity, wrong)
        assert sys.getprofile() is seen
    finally:
        sys.setprofile(None)
    assert found.causes
    with cProfile.Profile() as profile:
        assert kl.diagnose(robot, quantity, wrong).causes == found.causes
    assert profile.getstats()
