"""What was forgotten in a program: a term, a factor, a line; what is said of it makes it right.

Every program is right before the slip, which its verdict tells first.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import asked, with_slips, written
from test_program_slips import CHRISTOFFEL, ROWS

import kinlab as kl

PLANE = """
import numpy as np
from math import cos, sin

L, C, M = [0.5, 0.4], [0.25, 0.2], [2.0, 1.5]
I = [2.0*0.5**2/12, 1.5*0.4**2/12]

def f(q, v, a):
    angle = rate = turn = 0.0
    ax, ay = 0.0, 9.81
    seen = []
    for k in range(2):
        angle += q[k]
        rate += v[k]
        turn += a[k]
        s, c = sin(angle), cos(angle)
        fx = M[k]*(ax - C[k]*(turn*s + rate**2*c))
        fy = M[k]*(ay + C[k]*(turn*c - rate**2*s))
        ax -= L[k]*(turn*s + rate**2*c)
        ay += L[k]*(turn*c - rate**2*s)
        seen.append((k, s, c, turn, fx, fy))
    X = Y = n = 0.0
    tau = np.zeros(2)
    for k, s, c, turn, fx, fy in reversed(seen):
        n += L[k]*(c*Y - s*X) + C[k]*(c*fy - s*fx) + I[k]*turn
        X += fx
        Y += fy
        tau[k] = n
    return tau
"""
SPACE = """
import numpy as np

m = [3.0, 2.0, 1.2]
com = np.array([[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]])
inertia = [np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045]),
           np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]])]
p = [np.zeros(3), np.array([0.45, 0, 0]), np.array([0.35, 0, 0])]
tilt = [0, 0, np.pi/2]
z = np.array([0, 0, 1.0])

def turned(alpha, t):
    ca, sa = np.cos(alpha), np.sin(alpha)
    return np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t)*ca, np.cos(t)*ca, -sa],
                     [np.sin(t)*sa, np.cos(t)*sa, ca]])

def f(q, qd, qdd):
    w, dw, dv = np.zeros(3), np.zeros(3), np.array([0, 0, 9.81])
    R, F, N = [], [], []
    for i in range(3):
        A = turned(tilt[i], q[i])
        dv = A.T @ (dv + np.cross(dw, p[i]) + np.cross(w, np.cross(w, p[i])))
        dw = A.T @ dw + np.cross(A.T @ w, qd[i]*z) + qdd[i]*z
        w = A.T @ w + qd[i]*z
        R.append(A)
        F.append(m[i]*(dv + np.cross(dw, com[i]) + np.cross(w, np.cross(w, com[i]))))
        N.append(inertia[i] @ dw + np.cross(w, inertia[i] @ w))
    force, moment, tau = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in (2, 1, 0):
        if i < 2:
            moment = R[i + 1] @ moment + np.cross(p[i + 1], R[i + 1] @ force)
            force = R[i + 1] @ force
        moment = moment + N[i] + np.cross(com[i], F[i])
        force = force + F[i]
        tau[i] = moment @ z
    return tau
"""
TURNS = """
import numpy as np

def rot(axis, t):
    K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(t)*K + (1 - np.cos(t))*K @ K

def shift(length):
    return np.array([length, 0.0, 0.0])

def f(q):
    J = np.zeros((6, 3))
    z = np.array([0.0, 0.0, 1.0])
    R1 = rot(z, q[0])
    R2 = R1 @ rot(z, q[1])
    R3 = R2 @ rot(z, q[2])
    o1 = R1 @ shift(0.5)
    o2 = o1 + R2 @ shift(0.4)
    tip = o2 + R3 @ shift(0.25)
    for k, o in enumerate((np.zeros(3), o1, o2)):
        J[:3, k] = np.cross(z, tip - o)
        J[3:, k] = z
    return J
"""
ENTRIES = """
import numpy as np
m1, m2, l1, c1, c2 = 2.0, 1.5, 0.5, 0.25, 0.2
I1, I2 = 2.0*0.5**2/12, 1.5*0.4**2/12

def f(q, v, a):
    h = m2*l1*c2
    J2 = I2 + m2*c2**2
    m12 = J2 + h*np.cos(q[1])
    t1 = (I1 + m1*c1**2 + m2*l1**2 + J2 + 2*h*np.cos(q[1]))*a[0] + m12*a[1]
    t2 = m12*a[0] + J2*a[1] + h*np.sin(q[1])*v[0]**2 + m2*c2*9.81*np.cos(q[0] + q[1])
    t1 = t1 - h*np.sin(q[1])*(2*v[0]*v[1] + v[1]**2) + m2*c2*9.81*np.cos(q[0] + q[1])
    return np.array([t1 + (m1*c1 + m2*l1)*9.81*np.cos(q[0]), t2])
"""
CROSS = """
import numpy as np
from math import cos, sin

L = (0.5, 0.4)

def moment(r, f):
    return r[0]*f[1] - r[1]*f[0]

def f(q, wrench):
    forearm = np.array([L[1]*cos(q[0] + q[1]), L[1]*sin(q[0] + q[1])])
    arm = forearm + np.array([L[0]*cos(q[0]), L[0]*sin(q[0])])
    return np.array([moment(arm, wrench) + wrench[5], moment(forearm, wrench) + wrench[5]])
"""
PROGRAMS = {
    "plane": ("planar2r_rods", "inverse_dynamics", PLANE),
    "space": ("spatial3r", "inverse_dynamics", SPACE),
    "turns": ("planar3r", "jacobian", TURNS),
    "entries": ("planar2r_rods", "inverse_dynamics", ENTRIES),
    "slices": ("planar3r", "planar_jacobian", ROWS),
    "rates": ("planar2r_rods", "coriolis_matrix", CHRISTOFFEL),
    "cross": ("planar2r", "statics", CROSS),
}
FORGOTTEN = [
    ("plane", "        angle += q[k]\n", "", "a line at the beginning of a loop"),
    ("plane", "        Y += fy\n", "", "the line of the other axis"),
    ("plane", "ay += L[k]*(turn*c - rate**2*s)", "ay += L[k]*(turn*c)", "a term in parentheses"),
    ("plane", "fx = M[k]*(ax - C[k]*(turn*s + rate**2*c))", "fx = M[k]*(ax - C[k]*(rate**2*c))",
     "a turn in parentheses"),
    ("space", " + np.cross(com[i], F[i])", "", "the moment of a force"),
    ("space", "qd[i]*z) + qdd[i]*z", "qd[i]*z) + qdd[i]", "the axis behind its acceleration"),
    ("turns", "np.sin(t)*K + ", "", "a term of Rodrigues' formula"),
    ("turns", "np.sin(t)*K", "np.sin(t)", "its matrix"),
    ("turns", "        J[3:, k] = z\n", "", "the rows of the angular velocity"),
    ("turns", "R2 @ rot(z, q[2])", "R2", "the rotation of a joint"),
    ("entries", " + h*np.sin(q[1])*v[0]**2", " + h*np.sin(q[1])", "the square of a rate"),
    ("entries", "2*h*np.cos(q[1]))*a[0]", "2*h*np.cos(q[1]))", "a factor of parentheses"),
    ("slices", "L[j:]*np.sin(phi[j:])", "np.sin(phi[j:])", "lengths from a place on"),
    ("slices", "np.sum(L[j:]*np.cos(phi[j:]))", "np.sum(L[j:])", "cosines from a place on"),
    ("slices", "        J[0, j] = -np.sum(L[j:]*np.sin(phi[j:]))\n", "", "the row of x"),
    ("cross", " - r[1]*f[0]", "", "one half of a cross product"),
    ("cross", "r[0]*f[1] - r", "-r", "its other half"),
    ("rates", "*v[k]", "", "the rate of a Christoffel symbol"),
]  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "old", "new"), [x[:3] for x in FORGOTTEN], ids=[x[3] for x in FORGOTTEN]
)
def test_what_is_forgotten_is_told(name, old, new) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert text.count(old) == 1
    found, good = asked(text.replace(old, new), robot, quantity)
    assert good, str(found)


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips"),
    [
        pytest.param("plane", [("        Y += fy\n", ""), ("sin(angle), cos", "cos(angle), cos")], id="a line and a function"),
        pytest.param("space", [(" + np.cross(com[i], F[i])", ""), ("qd[i]*z) + qdd", "qd[i - 1]*z) + qdd")], id="a moment and an index"),
        pytest.param("turns", [("np.sin(t)*K + ", ""), ("tip - o)", "tip + o)")], id="a term and a sign"),
        pytest.param("entries", [(" + h*np.sin(q[1])*v[0]**2", " + h*np.sin(q[1])"), ("J2 = I2 + m2*c2**2", "J2 = I2")], id="a factor and an axis"),
        pytest.param("slices", [("L[j:]*np.sin(phi[j:])", "np.sin(phi[j:])"), ("L[j:]*np.cos(phi[j:])", "L[j:]*np.cos(q[j:])")], id="a factor and a name"),
    ],
)  # fmt: skip
def test_what_is_forgotten_beside_another_slip_is_told(name, slips) -> None:
    robot, quantity, text = PROGRAMS[name]
    found, good = asked(with_slips(text, slips), robot, quantity)
    assert good, str(found)


CALLED = """
import numpy as np

def rx(t):
    return np.array([[1, 0, 0], [0, np.cos(t), -np.sin(t)], [0, np.sin(t), np.cos(t)]])

def rz(t):
    return np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])

def f(q):
    p, R, J = np.zeros(3), np.eye(3), np.zeros((6, 3))
    ends, axes = [], []
    for t, alpha, a in zip(q, (0.0, np.pi/2, 0.0), (0.45, 0.35, 0.3)):
        R = R @ rz(t)
        ends.append(p)
        axes.append(R[:, 2])
        p = p + R @ np.array([a, 0, 0])
        R = R @ rx(alpha)
    for k in range(3):
        J[:, k] = np.r_[np.cross(axes[k], p - ends[k]), axes[k]]
    return J
"""


def test_a_function_that_nothing_calls_any_more_is_told() -> None:
    twists = (0.0, np.pi / 2, 0.0)
    links = [kl.DHLink(a=a, alpha=t) for a, t in zip((0.45, 0.35, 0.3), twists, strict=True)]
    arm = kl.Robot.from_dh(kl.DHTable("arm", "standard", links))
    assert kl.diagnose(arm, "jacobian", written(CALLED)).agrees
    found, good = asked(CALLED.replace("R = R @ rx(alpha)", "R = R"), arm, "jacobian")
    assert good, str(found)
