"""A number with a wrong digit, or a point in the wrong place: it is told, whatever else is costly."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

import kinlab as kl

LOOP = """
def f(xy, v, a, mode):
    X, Y = xy[0] - e, xy[1]
    A, B, C = 2*l1*X, 2*l1*Y, X**2 + Y**2 + l1**2 - l2**2
    t = 2*np.arctan2(B - mode*np.sqrt(A**2 + B**2 - C**2), A + C)
    u = np.array([np.cos(t), np.sin(t)])
    w = (np.array([X, Y*np.ones(2)]) - l1*u)/l2
    S = u[0]*w[1] - u[1]*w[0]
    J = (w/(l1*S)).T
"""
TORQUE = (
    """
import numpy as np

l1, l2 = np.array([0.30, 0.26]), np.array([0.50, 0.54])
e = np.array([0.12, -0.12])
mass, com = np.array([1.0, 0.8]), np.array([0.12, 0.15])
I = np.array([0.0075, 0.0060]) + mass*com**2 + np.array([1e-5*10**2, 1.2e-5*12**2])
m, g = 1.5, 9.81
"""
    + LOOP
    + """\
    tdd = J @ a + ((v @ w)**2*np.sum(u*w, axis=0)/l1 + (v @ u)**2/l2)/(l1*S**3)
    return I*tdd + mass*g*com*u[0] + m*np.linalg.solve(J.T, a + np.array([0, g]))
"""
)
RATES = """
import numpy as np

l1, l2, e = [0.30, 0.26], [0.50, 0.54], 0.12

def f(xy, v, mode):
    out = []
    for k, side in enumerate((1, -1)):
        x, y = xy[0] - side*e, xy[1]
        A, B, C = -2*l1[k]*x, -2*l1[k]*y, x*x + y*y + l1[k]**2 - l2[k]**2
        t = np.arctan2(B, A) + mode[k]*np.arccos(-C/np.hypot(A, B))
        r = np.array([x - l1[k]*np.cos(t), y - l1[k]*np.sin(t)])
        out.append(r @ v/(l1[k]*(r[1]*np.cos(t) - r[0]*np.sin(t))))
    return np.array(out)
"""
RODS = """
import numpy as np

class Arm:
    def __init__(self, a1, a2, m1, m2, g=9.81):
        self.a1, self.a2, self.m1, self.m2, self.g = a1, a2, m1, m2, g
        self.l1, self.l2 = a1/2, a2/2
        self.I1, self.I2 = m1*a1**2/12, m2*a2**2/12

    def B(self, q):
        c2 = np.cos(q[1])
        b22 = self.I2 + self.m2*self.l2**2
        b12 = b22 + self.m2*self.a1*self.l2*c2
        b11 = self.I1 + self.m1*self.l1**2 + self.m2*self.a1**2 - b22 + 2*b12
        return np.array([[b11, b12], [b12, b22]])

    def n(self, q, dq):
        h = self.m2*self.a1*self.l2*np.sin(q[1])
        g2 = self.m2*self.l2*self.g*np.cos(q[0] + q[1])
        g1 = (self.m1*self.l1 + self.m2*self.a1)*self.g*np.cos(q[0]) + g2
        return np.array([-h*(2*dq[0]*dq[1] + dq[1]**2) + g1, h*dq[0]**2 + g2])

    def accelerate(self, q, dq, tau):
        return np.linalg.solve(self.B(q), tau - self.n(q, dq))

ARM = Arm(0.5, 0.4, 2.0, 1.5)

def f(q, dq, tau):
    return ARM.accelerate(q, dq, tau)
"""
TWISTS = """
import numpy as np

A2, A3, D3, D4 = 0.4318, 0.0203, 0.15005, 0.4318
W = np.array([[0, 0, 1], [0, -1, 0], [0, -1, 0], [0, 0, 1], [0, -1, 0], [0, 0, 1]], float)
Q = np.array([[0, 0, 0], [0, 0, 0], [A2, 0, 0],
              [A2 + A3, -D3, 0], [A2 + A3, -D3, D4], [A2 + A3, -D3, D4]])

def f(q):
    R, p, J = np.eye(3), np.zeros(3), []
    for w, at, t in zip(W, Q, q):
        axis = R @ w
        J.append(np.r_[np.cross(p + R @ at, axis), axis])
        K = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        turn = np.eye(3) + np.sin(t)*K + (1 - np.cos(t))*K @ K
        p = p + R @ (at - turn @ at)
        R = R @ turn
    return np.array(J).T
"""


def module(path: Path, text: str):
    path.write_text(text)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found.f


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right", "wrong"),
    [
        ("unequal", "fivebar_torque_massless", TORQUE, "0.0075", "0.075"),
        ("unequal", "fivebar_torque_massless", TORQUE, "[1.0, 0.8]", "[0.1, 0.8]"),
        ("unequal", "fivebar_rates", RATES, "e = [0.30, 0.26], [0.50, 0.54], 0.12", "e = [0.30, 0.26], [0.50, 0.54], 0.14"),
        ("planar2r_rods", "forward_dynamics", RODS, "0.4, 2.0", "0.4, 0.2"),
        ("puma560", "jacobian_spatial", TWISTS, "D4 = 0.4318", "D4 = 0.4311"),
        ("puma560", "jacobian_spatial", TWISTS, "D3, D4 = 0.4318, 0.0203, 0.15005", "D3, D4 = 0.4318, 0.0203, 0.15050"),
    ],
    ids=["a point", "a mass", "no answer", "a mass of rods", "a digit, nearly right", "digits exchanged"],
)  # fmt: skip
def test_it_is_told(tmp_path, robot, quantity, text, right, wrong) -> None:
    assert text.count(right) == 1
    assert kl.diagnose(robot, quantity, module(tmp_path / "typed_right.py", text)).agrees
    told = kl.diagnose(
        robot, quantity, module(tmp_path / "mistyped.py", text.replace(right, wrong))
    )
    (number,) = {*numbers(right)} - {*numbers(wrong)}
    assert told.causes and number in numbers(told.causes[0].sentence.partition("should be")[2]), (
        str(told)
    )


def numbers(text: str) -> list[float]:
    return [
        float(word)
        for word in "".join(c if c in "0123456789." else " " for c in text).split()
        if word != "."
    ]


BY_RATES = (
    """
import numpy as np

l1, l2, e = 0.3, 0.5, np.array([1, -1])*0.2/np.sqrt(2)
mass, com, load, g = 1.0, 0.15, 1.0, 9.81
I = mass*l1**2/12 + mass*com**2
"""
    + LOOP
    + """\
    td, rod = J @ v, (v @ u)/(l2*S)
    tdd = J @ a + (l1*td**2*np.sum(u*w, axis=0) + l2*rod**2)/(l1*S)
    return I*tdd + mass*g*com*u[0] + load*np.linalg.solve(J.T, a + np.array([0, g]))
"""
)


def test_a_name_comes_before_the_number_that_it_has(tmp_path) -> None:
    """Half or l2, which is 0.5: nothing tells them apart, and a length is rather forgotten."""
    asked = "isotropic", "fivebar_torque_massless"
    assert kl.diagnose(*asked, module(tmp_path / "typed_right.py", BY_RATES)).agrees
    text = BY_RATES.replace("l2*rod**2", "rod**2")
    told = kl.diagnose(*asked, module(tmp_path / "lost.py", text)).causes[0].sentence
    assert (
        "l2*rod**2" in told.partition("or else")[0] and "0.5*rod**2" in told.partition("or else")[2]
    )
