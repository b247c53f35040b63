"""A value is put right where it is worked out rather than where it is used, and what an arm's own
numbers rule out is not told."""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import asked, with_slips, written

import kinlab as kl

POLAR = """
import numpy as np
m1, m2, I1, I2, lc, b, g = 3.0, 1.4, 0.2, 0.06, 0.25, 0.12, 9.81

def f(q, v, a):
    r = q[1] - b
    inertia = m1*lc**2 + I1 + I2 + m2*r**2
    change = 2*m2*r
    momentum = inertia*a[0] + change*v[1]*v[0]
    pull = 0.5*change*v[0]**2
    turn = (m1*lc + m2*r)*g*np.cos(q[0])
    lift = m2*g*np.sin(q[0])
    return [momentum + turn, m2*a[1] - pull + lift]
"""
STATICS = """
import numpy as np
L = [0.5, 0.4, 0.25]

def jacobian(q):
    phi = np.cumsum(q)
    x, y = [L[k]*np.cos(phi[k]) for k in range(3)], [L[k]*np.sin(phi[k]) for k in range(3)]
    J = np.ones((3, 3))
    for j in range(3):
        J[0, j] = -sum(y[j:])
        J[1, j] = sum(x[j:])
    return J

def f(q, wrench):
    J = jacobian(q)
    return np.array([J[0, j]*wrench[0] + J[1, j]*wrench[1] + J[2, j]*wrench[5] for j in range(3)])
"""
BENT = """
import numpy as np

class Arm:
    masses = [8.0, 5.0, 2.0]
    centres = np.array([[0, 0.02, -0.12], [0.05, 0.1, 0.0], [0.03, 0, -0.2]])
    tensors = [np.diag([0.2, 0.18, 0.09]), np.diag([0.04, 0.31, 0.27]), np.diag([0.26, 0.25, 0.03])]

    def __init__(self, q):
        c, s = np.cos(q[0]), np.sin(q[0])
        turned = np.array([[c, 0, -s], [s, 0, c], [0, -1, 0]])
        self.R = [np.eye(3), np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]), turned, turned]
        at = np.array([0, 0, 0.3 + q[1]])
        self.o = [np.zeros(3), np.array([0, 0, 0.3]), at, at + (q[2] + 0.25)*np.array([-s, c, 0])]

def f(q):
    arm, M = Arm(q), np.zeros((3, 3))
    for k in range(3):
        Jv, Jw = np.zeros((3, 3)), np.zeros((3, 3))
        p = arm.o[k + 1] + arm.R[k + 1] @ arm.centres[k]
        for j in range(k + 1):
            z = arm.R[j][:, 2]
            if j == 0:
                Jv[:, j], Jw[:, j] = np.cross(z, p - arm.o[j]), z
            else:
                Jv[:, j] = z
        R = arm.R[k + 1]
        M += arm.masses[k]*Jv.T @ Jv + Jw.T @ R @ arm.tensors[k] @ R.T @ Jw
    return M
"""
WRIST = """
import numpy as np

class Link:
    def __init__(self, d, alpha, m, c, inertia):
        self.d, self.alpha, self.m, self.c, self.inertia = d, alpha, m, c, inertia

LINKS = [Link(0.2, -np.pi/2, 1.5, (0, 0.06, 0.01), (0.008, 0.004, 0.007)),
         Link(0.0, np.pi/2, 1.0, (0.01, 0, 0.05), (0.005, 0.006, 0.002)),
         Link(0.12, 0.0, 0.8, (0.03, 0.02, -0.04), (0.003, 0.0045, 0.0025))]

def turn(theta, alpha):
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[ct, -st*ca, st*sa], [st, ct*ca, -ct*sa], [0, sa, ca]])

def f(q, v):
    R, omega, speed, T = np.eye(3), np.zeros(3), np.zeros(3), 0.0
    for link, th, rate in zip(LINKS, q, v):
        z = R[:, 2]
        omega = omega + rate*z
        speed = speed + np.cross(omega, link.d*z)
        R = R @ turn(th, link.alpha)
        own = speed + np.cross(omega, R @ np.array(link.c))
        body = R.T @ omega
        T += 0.5*link.m*own @ own
        T += 0.5*body @ (np.array(link.inertia)*body)
    return T
"""
FLAT = """
import numpy as np
m, l, r = np.array([3.0, 2.0, 1.0]), np.array([0.5, 0.4, 0.25]), np.array([0.25, 0.2, 0.125])

def f(q):
    phi = np.cumsum(q)
    u = np.stack([-np.sin(phi), np.cos(phi)])
    Jv = np.zeros((3, 2, 3))
    for i in range(3):
        for k in range(i + 1):
            arm = r[k] if k == i else l[k]
            Jv[i, :, :k + 1] += arm*u[:, k][:, None]
    return np.einsum("i,ixj,ixk->jk", m, Jv, Jv)
"""


LIFT = """
import numpy as np
m1, m2, r, inertia = 6.0, 2.0, 0.3, 0.1

def f(q, v, a):
    lifted = m1 + m2
    return [lifted*(a[0] + 9.81), (inertia + m2*r**2)*a[1]]
"""
CHAIN = """
import numpy as np

def rx(al, a):
    c, s = np.cos(al), np.sin(al)
    return np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])

def rz(th, d):
    c, s = np.cos(th), np.sin(th)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, d], [0, 0, 0, 1]])

def f(q):
    T01 = rx(0, 0) @ rz(q[0], 0.25)
    T12 = rx(np.pi/2, 0.06) @ rz(q[1], 0)
    T23 = rx(0, 0.4) @ rz(q[2], 0)
    T34 = rx(np.pi/2, 0.07) @ rz(0, 0.15 + q[3])
    T02 = T01 @ T12
    T03 = T02 @ T23
    T04 = T03 @ T34
    weights = [(T01, 4.0, [0.01, 0, 0.09]), (T02, 3.0, [0.18, 0, 0.02]), (T03, 2.0, [0.14, 0.03, 0]),
               (T04, 0.8, [0, 0, -0.05])]
    return sum(m*9.81*(T @ [*c, 1.0])[2] for T, m, c in weights)
"""
YIELDED = """
import numpy as np
L, R = [0.5, 0.4, 0.25], [0.25, 0.2, 0.125]

def links(q):
    at, phi = np.zeros(2), 0.0
    for k in range(3):
        before, phi = at, phi + q[k]
        u = np.array([np.cos(phi), np.sin(phi)])
        at = at + L[k]*u
        yield before, at, u

def f(q):
    J, through = np.zeros((6, 3)), []
    for k, (before, at, u) in enumerate(links(q)):
        through.append(before)
        tip = at
    for k, point in enumerate(through):
        J[:2, k] = -(tip - point)[1], (tip - point)[0]
        J[5, k] = 1
    return J
"""
POLAR_ARM = kl.DHTable(
    name="polar", convention="standard", gravity=[0, -9.81, 0],
    links=[
        kl.DHLink("revolute", theta=np.pi / 2, alpha=np.pi / 2, mass=3.0, com=[0, 0, 0.25],
                  inertia=np.diag([0.15, 0.2, 0.1])),
        kl.DHLink("prismatic", lower=0.4, upper=1.2, mass=1.4, com=[0, 0, -0.12],
                  inertia=np.diag([0.04, 0.06, 0.03])),
    ],
)  # fmt: skip
BENT_ARM = kl.DHTable(
    name="bent", convention="standard",
    links=[
        kl.DHLink("revolute", d=0.3, mass=8.0, com=[0, 0.02, -0.12],
                  inertia=np.diag([0.2, 0.18, 0.09])),
        kl.DHLink("prismatic", alpha=-np.pi / 2, lower=0.1, upper=0.6, mass=5.0,
                  com=[0.05, 0.1, 0.0], inertia=np.diag([0.04, 0.31, 0.27])),
        kl.DHLink("prismatic", d=0.25, lower=0.0, upper=0.5, mass=2.0, com=[0.03, 0, -0.2],
                  inertia=np.diag([0.26, 0.25, 0.03])),
    ],
)  # fmt: skip
WRIST_ARM = kl.DHTable(
    name="wrist", convention="standard",
    links=[
        kl.DHLink("revolute", d=0.2, alpha=-np.pi / 2, mass=1.5, com=[0, 0.06, 0.01],
                  inertia=np.diag([0.008, 0.004, 0.007])),
        kl.DHLink("revolute", alpha=np.pi / 2, mass=1.0, com=[0.01, 0, 0.05],
                  inertia=np.diag([0.005, 0.006, 0.002])),
        kl.DHLink("revolute", d=0.12, mass=0.8, com=[0.03, 0.02, -0.04],
                  inertia=np.diag([0.003, 0.0045, 0.0025])),
    ],
)  # fmt: skip
SIZES = ((3.0, 0.5, 0.25), (2.0, 0.4, 0.2), (1.0, 0.25, 0.125))
FLAT_ARM = kl.DHTable(
    name="flat",
    convention="standard",
    links=[
        kl.DHLink("revolute", a=length, mass=mass, com=[centre - length, 0, 0])
        for mass, length, centre in SIZES
    ],
)
PICKER = kl.DHTable(
    name="picker", convention="modified",
    links=[
        kl.DHLink("revolute", d=0.25, mass=4.0, com=[0.01, 0, 0.09]),
        kl.DHLink("revolute", alpha=np.pi / 2, a=0.06, mass=3.0, com=[0.18, 0, 0.02]),
        kl.DHLink("revolute", a=0.4, mass=2.0, com=[0.14, 0.03, 0]),
        kl.DHLink("prismatic", alpha=np.pi / 2, a=0.07, d=0.15, lower=0.0, upper=0.4, mass=0.8,
                  com=[0, 0, -0.05]),
    ],
)  # fmt: skip
LIFT_ARM = kl.DHTable(
    name="lift", convention="standard",
    links=[
        kl.DHLink("prismatic", lower=0.1, upper=0.8, mass=6.0),
        kl.DHLink("revolute", a=0.5, mass=2.0, com=[-0.2, 0, 0], inertia=np.diag([0.1, 0.1, 0.1])),
    ],
)  # fmt: skip

CASES = {
    "a factor of a value is lost where it is worked out": (
        POLAR, POLAR_ARM, "inverse_dynamics", [("pull = 0.5*change", "pull = change")],
        "`pull = change*v[0]**2` should be `pull = 0.5*change*v[0]**2`",
    ),
    "absolute angles have their sign": (
        STATICS, "planar3r", "statics", [("J[0, j] = -sum", "J[0, j] = sum")],
        "`J[0, j] = sum(y[j:])` should be `J[0, j] = -sum(y[j:])`",
    ),
    "what a function takes for q is q": (
        STATICS, "planar3r", "statics", [("phi = np.cumsum(q)", "phi = q")],
        "`phi = q` should be `phi = np.cumsum(q)`",
    ),
    "the part of a coordinate that does not move": (
        BENT, BENT_ARM, "mass_matrix", [("(q[2] + 0.25)", "q[2]")], "(q[2] + 0.25)",
    ),
    "two that turn vectors, of which an energy tells one only": (
        WRIST, WRIST_ARM, "kinetic_energy",
        [("omega = omega + rate*z", "omega = rate*z"), ("R @ np.array(link.c)", "np.array(link.c)")],
        "`own = speed + np.cross(omega, np.array(link.c))` should be "
        "`own = speed + np.cross(omega, R @ np.array(link.c))`",
    ),
    "gravity beside a slide's acceleration": (
        LIFT, LIFT_ARM, "inverse_dynamics", [("lifted*(a[0] + 9.81)", "lifted*a[0]")],
        "should be `return [lifted*(a[0] + 9.81), ",
    ),
    "transforms that do not follow on one another": (
        CHAIN, PICKER, "potential_energy", [("T03 = T02 @", "T03 = T01 @")],
        "`T03 = T01 @ T23` should be `T03 = T02 @ T23`",
    ),
    "what a function yields": (
        YIELDED, "planar3r", "jacobian", [("tip = at", "tip = before")],
        "`tip = before` should be `tip = at`",
    ),
    "an array that a sum of products lacks": (
        FLAT, FLAT_ARM, "mass_matrix", [('"i,ixj,ixk->jk", m, Jv', '"ixj,ixk->jk", Jv')],
        "should be `return np.einsum('i,ixj,ixk->jk', m, Jv, Jv)`",
    ),
}  # fmt: skip


@pytest.mark.many
@pytest.mark.parametrize("case", CASES)
def test_it_is_put_right_where_it_is_worked_out(case) -> None:
    text, robot, quantity, slips, told = CASES[case]
    assert kl.diagnose(robot, quantity, written(text)).agrees
    found, good = asked(with_slips(text, slips), robot, quantity)
    assert good, str(found)
    first = found.causes[0].sentence
    assert told in first
    assert "or else" not in first
    assert first.count("should be") == len(slips)
