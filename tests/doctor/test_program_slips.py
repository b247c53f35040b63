"""Slips that are more than one sign or one name: what is said of each makes the program right.

Every program is right before the slip, which its verdict tells first.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import asked, repaired, searched, written

import kinlab as kl
from kinlab.doctor.program.grounds.dimensions import Dimensions

MOTION = """
import numpy as np

def dh(a, alpha, d, theta):
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])

rows = [(0.5, 0.0, 0.0), (0.4, 0.0, 0.0)]
mass = [2.0, 1.5]
coms = [np.array([-0.25, 0, 0]), np.array([-0.2, 0, 0])]
tensors = [np.diag([0, 2.0*0.5**2/12, 2.0*0.5**2/12]), np.diag([0, 1.5*0.4**2/12, 1.5*0.4**2/12])]

def f(q, qd):
    w, v, z = np.zeros(3), np.zeros(3), np.array([0.0, 0.0, 1.0])
    energy = 0.0
    for i in range(2):
        a, alpha, d = rows[i]
        T = dh(a, alpha, d, q[i])
        R, p = T[:3, :3], T[:3, 3]
        w = w + z*qd[i]
        v = v + np.cross(w, p)
        w, v = R.T @ w, R.T @ v
        vc = v + np.cross(w, coms[i])
        energy += 0.5*mass[i]*vc @ vc + 0.5*w @ tensors[i] @ w
    return energy
"""
CLOSED = """
import numpy as np

def f(q, v, a):
    m1, m2, l1, c1, c2, g = 2.0, 1.5, 0.5, 0.25, 0.2, 9.81
    I1, I2 = 2.0*0.5**2/12, 1.5*0.4**2/12
    h = m2*l1*c2
    J2 = I2 + m2*c2**2
    tip = m2*g*c2*np.cos(q[0] + q[1])
    t1 = (I1 + m1*c1**2 + m2*l1**2 + J2 + 2*h*np.cos(q[1]))*a[0] + (J2 + h*np.cos(q[1]))*a[1]
    t1 = t1 - h*np.sin(q[1])*(2*v[0]*v[1] + v[1]**2) + (m1*c1 + m2*l1)*g*np.cos(q[0]) + tip
    t2 = (J2 + h*np.cos(q[1]))*a[0] + J2*a[1] + h*np.sin(q[1])*v[0]**2 + tip
    return np.array([t1, t2])
"""
TYPED = """
import numpy as np

def trans(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T

def rotz(t):
    T = np.eye(4)
    T[:2, :2] = [[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]]
    return T

def f(q):
    return rotz(q[0]) @ trans(0.5, 0, 0) @ rotz(q[1]) @ trans(0.4, 0, 0)
"""
BODIES = """
import numpy as np

m, l, c, g = [2.0, 1.5], [0.5, 0.4], [0.25, 0.2], 9.81

def f(q):
    angles = np.cumsum(q)
    load = m[0] + m[1]
    inner = g*(load*l[0] - m[0]*c[0])*np.cos(angles[0])
    outer = g*m[1]*c[1]*np.cos(angles[1])
    return np.array([inner + outer, outer])
"""
DEGREES = """
import numpy as np

twists = np.radians([90, 0, -90, 90, -90, 0])
a = [0, 0.4318, 0.0203, 0, 0, 0]
d = [0, 0, 0.15005, 0.4318, 0, 0]

def f(q):
    T = np.eye(4)
    for i in range(6):
        c, s, ca, sa = np.cos(q[i]), np.sin(q[i]), np.cos(twists[i]), np.sin(twists[i])
        T = T @ np.array([[c, -s*ca, s*sa, a[i]*c], [s, c*ca, -c*sa, a[i]*s],
                          [0, sa, ca, d[i]], [0, 0, 0, 1]])
    return T
"""
NEWTON = """
import numpy as np

m = [3.0, 2.0, 1.2]
com = np.array([[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]])
inertia = [np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045]),
           np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]])]
p = [np.zeros(3), np.array([0.45, 0, 0]), np.array([0.35, 0, 0])]
tilt = [0, 0, np.pi/2]

def turned(alpha, t):
    ca, sa = np.cos(alpha), np.sin(alpha)
    return np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t)*ca, np.cos(t)*ca, -sa],
                     [np.sin(t)*sa, np.cos(t)*sa, ca]])

def f(q, qd, qdd):
    z = np.array([0, 0, 1.0])
    R = [turned(tilt[i], q[i]) for i in range(3)]
    w, dw, dv = np.zeros(3), np.zeros(3), np.array([0, 0, 9.81])
    F, N = [], []
    for i in range(3):
        dv = R[i].T @ (dv + np.cross(dw, p[i]) + np.cross(w, np.cross(w, p[i])))
        w = R[i].T @ w
        dw = R[i].T @ dw + qdd[i]*z + np.cross(w, qd[i]*z)
        w = w + qd[i]*z
        F.append(m[i]*(dv + np.cross(dw, com[i]) + np.cross(w, np.cross(w, com[i]))))
        N.append(inertia[i] @ dw + np.cross(w, inertia[i] @ w))
    force, moment, tau = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in (2, 1, 0):
        moment = N[i] + moment + np.cross(com[i], F[i])
        force = force + F[i]
        tau[i] = moment @ z
        moment = R[i] @ moment + np.cross(p[i], R[i] @ force)
        force = R[i] @ force
    return tau
"""
CHRISTOFFEL = """
import numpy as np

def M(q):
    h = 1.5*0.5*0.2*np.cos(q[1])
    J = 1.5*0.4**2/3
    return np.array([[2.0*0.5**2/3 + 1.5*0.5**2 + J + 2*h, J + h], [J + h, J]])

def f(q, v):
    e = 1e-6
    D = [(M(q + e*x) - M(q - e*x))/(2*e) for x in np.eye(2)]
    C = np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            for k in range(2):
                C[i, j] += 0.5*(D[k][i, j] + D[j][i, k] - D[i][j, k])*v[k]
    return C
"""
ROUNDS = """
import numpy as np

l, shift, lift = [0.4318, 0.0203], 0.15005, 0.4318

def joint(t, d, a, alpha):
    ca, sa = round(np.cos(alpha)), round(np.sin(alpha))
    return np.array([[np.cos(t), -np.sin(t)*ca, np.sin(t)*sa, a*np.cos(t)],
                     [np.sin(t), np.cos(t)*ca, -np.cos(t)*sa, a*np.sin(t)],
                     [0, sa, ca, d], [0, 0, 0, 1]])

def f(q):
    h = np.pi/2
    rows = [(0, 0, h), (0, l[0], 0), (shift, l[1], -h), (lift, 0, h), (0, 0, -h), (0, 0, 0)]
    T = np.eye(4)
    for t, row in zip(q, rows):
        T = T @ joint(t, *row)
    return T
"""
ENTRIES = """
import numpy as np

def f(q):
    m1, m2, l1, c1, c2 = 2.0, 1.5, 0.5, 0.25, 0.2
    I1, I2 = 2.0*0.5**2/12, 1.5*0.4**2/12
    h, k = m2*l1*c2*np.cos(q[1]), I2 + m2*c2**2
    m22 = k
    m12 = m22 + h
    m11 = I1 + m1*c1**2 + m2*l1**2 + m22 + 2*h
    return np.array([[m11, m12], [m12, m22]])
"""
OBJECTS = """
from math import cos

class Link:
    def __init__(self, m, l, r):
        self.m, self.l, self.r = m, l, r

A, B = Link(m=2.0, l=0.5, r=0.5), Link(m=1.5, l=0.4, r=0.4)

def f(q):
    outer = B.m*9.81*B.r*cos(q[0] + q[1])
    return [(A.m*A.r + B.m*A.l)*9.81*cos(q[0]) + outer, outer]
"""
VECTORS = """
import numpy as np

def f(q):
    s1, c1 = np.sin(q[0]), np.cos(q[0])
    s12, c12 = np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    J = np.zeros((6, 2))
    J[:2, 1] = [-0.4*s12, 0.4*c12]
    J[:2, 0] = [-0.5*s1 - 0.4*s12, 0.5*c1 + 0.4*c12]
    J[5, :] = 1
    return J
"""
CARRIED = """
import numpy as np

m = [3.0, 2.0, 1.0]
L = [0.5, 0.4, 0.25]

def f(q):
    t = np.cumsum(q)
    lever = [(sum(m[i:]) - m[i]/2)*L[i] for i in range(3)]
    each = [9.81*lever[i]*np.cos(t[i]) for i in range(3)]
    return np.array([sum(each[i:]) for i in range(3)])
"""
ENERGIES = """
import numpy as np
m, l, c = (2.0, 1.5), (0.5, 0.4), (0.25, 0.2)

def f(q, qd):
    w2 = qd[0] + qd[1]
    vx = -l[0]*np.sin(q[0])*qd[0] - c[1]*np.sin(q[0] + q[1])*w2
    vy = l[0]*np.cos(q[0])*qd[0] + c[1]*np.cos(q[0] + q[1])*w2
    first = (m[0]*c[0]**2 + m[0]*l[0]**2/12)*qd[0]**2
    return 0.5*(first + m[1]*(vx**2 + vy**2) + m[1]*l[1]**2/12*w2**2)
"""
ROWS = """
import numpy as np
L = np.array([0.5, 0.4, 0.25])

def f(q):
    phi = np.cumsum(q)
    J = np.ones((3, 3))
    for j in range(3):
        J[0, j] = -np.sum(L[j:]*np.sin(phi[j:]))
        J[1, j] = np.sum(L[j:]*np.cos(phi[j:]))
    return J
"""
SCREWS = """
import numpy as np
AXES = [np.array([0, 0, 1]), np.array([0, 0, 1]), np.array([0, 0, 1])]
POINTS = [np.zeros(3), np.array([0.5, 0, 0]), np.array([0.9, 0, 0])]
TOOL = np.array([1.15, 0, 0])

def f(q):
    R, p, J = np.eye(3), np.zeros(3), np.zeros((6, 3))
    axes, points = [], []
    for w, r, t in zip(AXES, POINTS, q):
        K = np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])
        turn = np.eye(3) + np.sin(t)*K + (1 - np.cos(t))*K @ K
        axes.append(R @ w)
        points.append(R @ r + p)
        p = R @ ((np.eye(3) - turn) @ r) + p
        R = R @ turn
    x = R @ TOOL + p
    for k in range(3):
        J[:3, k], J[3:, k] = np.cross(axes[k], x - points[k]), axes[k]
    return J
"""
LOOPS = """
import numpy as np

class Link:
    def __init__(self, length, mass, centre):
        self.length, self.mass, self.centre = length, mass, centre

ARM = [Link(0.5, 2.0, 0.25), Link(0.4, 1.5, 0.2)]
G = 9.81

def f(q):
    tau = np.zeros(2)
    for j in range(2):
        for k in range(j, 2):
            arm = 0.0
            for i in range(j, k):
                arm += ARM[i].length*np.cos(sum(q[:i + 1]))
            arm += ARM[k].centre*np.cos(sum(q[:k + 1]))
            tau[j] += ARM[k].mass*G*arm
    return tau
"""
WEIGHTS = """
import numpy as np
m1, m2, l1, c1, c2, g = 2.0, 1.5, 0.5, 0.25, 0.2, 9.81

def f(q):
    c12 = np.cos(q[0] + q[1])
    first = (m1*c1 + m2*l1)*g*np.cos(q[0]) + m2*g*c2*c12
    return np.array([first, m2*g*c2*c12])
"""
PROGRAMS = {
    "motion": ("planar2r_rods", "kinetic_energy", MOTION),
    "closed": ("planar2r_rods", "inverse_dynamics", CLOSED),
    "typed": ("planar2r", "fk", TYPED),
    "bodies": ("planar2r_rods", "gravity_torques", BODIES),
    "degrees": ("puma560", "fk", DEGREES),
    "newton": ("spatial3r", "inverse_dynamics", NEWTON),
    "christoffel": ("planar2r_rods", "coriolis_matrix", CHRISTOFFEL),
    "rounds": ("puma560", "fk", ROUNDS),
    "entries": ("planar2r_rods", "mass_matrix", ENTRIES),
    "objects": ("planar2r", "gravity_torques", OBJECTS),
    "vectors": ("planar2r", "jacobian", VECTORS),
    "carried": ("planar3r", "gravity_torques", CARRIED),
    "energies": ("planar2r_rods", "kinetic_energy", ENERGIES),
    "rows": ("planar3r", "planar_jacobian", ROWS),
    "screws": ("planar3r", "jacobian", SCREWS),
    "loops": ("planar2r_rods", "gravity_torques", LOOPS),
    "weights": ("planar2r_rods", "gravity_torques", WEIGHTS),
}
SLIPS = [
    ("motion", "np.cross(w, coms[i])", "np.cross(v, coms[i])", "another vector in a product"),
    ("motion", "mass = [2.0, 1.5]", "mass = [1.5, 2.0]", "two numbers of a list"),
    ("closed", "J2 = I2 + m2*c2**2", "J2 = I2", "a moment about the wrong axis"),
    ("closed", "2*v[0]*v[1] + v[1]**2", "2*v[0]*v[0] + v[1]**2", "an index of a factor"),
    ("closed", "m1*c1 + m2*l1)*g", "m1*l1 + m2*c1)*g", "factors crosswise"),
    ("typed", "rotz(q[1]) @ trans(0.4, 0, 0)", "rotz(q[1]) @ trans(0, 0, 0.4)", "far arguments"),
    ("typed", "trans(0.5, 0, 0)", "trans(0.4, 0, 0)", "another of the arm's lengths"),
    ("typed", "trans(0.5, 0, 0)", "trans(0.7, 0, 0)", "a length of nobody's"),
    ("bodies", "load = m[0] + m[1]", "load = m[1]", "the entry before as well"),
    ("typed", "rotz(q[0]) @ trans", "rotz(q[1]) @ trans", "an index"),
    ("typed", "trans(0.5, 0, 0)", "trans(0, 0, 0)", "a length that is left out"),
    ("newton", " + np.cross(w, qd[i]*z)", "", "the velocity's part of an acceleration"),
    ("newton", " + np.cross(w, inertia[i] @ w)", "", "the gyroscopic moment"),
    ("christoffel", "D[i][j, k]", "D[j][i, k]", "indices in another order"),
    ("rounds", "(lift, 0, h)", "(shift, 0, h)", "a name in a program that rounds"),
    ("entries", "m12 = m22 + h", "m12 = m22", "a term that stands in the next line"),
    ("objects", "B.m*A.l", "B.m*B.r", "a field of another object"),
    ("vectors", "[-0.4*s12, 0.4*c12]", "[0.4*s12, -0.4*c12]", "a vector with the other sign"),
    ("vectors", "[-0.4*s12, 0.4*c12]", "[-0.4*c12, 0.4*s12]", "sines and cosines of a line"),
    ("carried", "(sum(m[i:]) - ", "(m[i] - ", "the load from a joint on"),
    ("energies", "(vx**2 + vy**2)", "vx**2", "the square of another coordinate"),
    ("energies", " + c[1]*np.cos(q[0] + q[1])*w2", "", "of y what is there of x"),
    ("energies", "l[0]*np.cos(q[0])*qd[0]", "l[0]*qd[0]", "a cosine where there is a sine"),
    ("closed", "2*v[0]*v[1] + v[1]**2", "2*v[0] + v[1]**2", "another entry of a row"),
    ("rows", "-np.sum(L[j:]*", "-np.sum(L[:3 - j]*", "another part of a row"),
    ("screws", "[0, 0, 1])]\nPOINTS", "[0, 0, -1])]\nPOINTS", "an axis of whole numbers"),
    ("screws", "(np.eye(3) - turn) @ r", "turn @ r", "the unit matrix"),
    ("loops", "arm += ARM[i].length*np", "arm += np", "an attribute of a link"),
    ("weights", "(m1*c1 + m2*l1)*g", "(m1 + m2)*l1*g", "a factor of one term"),
    ("weights", "[first, m2*g*c2*c12]", "[first, 0.0*g]", "a term of three names and a cosine"),
    ("newton", "moment = R[i] @ moment + np", "moment = np", "what comes from the link before"),
]  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(("name", "old", "new"), [x[:3] for x in SLIPS], ids=[x[3] for x in SLIPS])
def test_a_slip_is_told(name, old, new) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert text.count(old) == 1
    found, good = asked(text.replace(old, new), robot, quantity)
    assert good, str(found)


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("motion", "v = v + np.cross(w, p)", "v = v", "should be `v = v + np.cross(w, p)`"),
        ("motion", "w + z*qd[i]", "w + z", "the factor qd"),
        ("degrees", "np.radians([90, 0, -90, 90, -90, 0])", "np.array([90, 0, -90, 90, -90, 0])",
         "twists, degrees are taken for radians"),
        ("degrees", "a = [0, 0.4318, 0.0203, 0, 0, 0]", "a = [0, 0, 0, 0.0203, 0.4318, 0]",
         "a, the numbers stand in the reverse order"),
        ("degrees", "a = [0, 0.4318, 0.0203, 0, 0, 0]", "a = [0.4318, 0.0203, 0, 0, 0, 0]",
         "a, the numbers stand one place on"),
        ("energies", "(0.25, 0.2)", "(0.2, 0.25)", "c, two entries are exchanged: `0.2, 0.25`"),
    ],
    ids=["a cross product", "a vector without its factor", "a row in degrees", "a row in reverse",
         "a row moved on", "two numbers of a tuple"],
)  # fmt: skip
def test_a_slip_is_told_in_these_words(name, old, new, said) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert text.count(old) == 1
    wrong = written(text.replace(old, new))
    assert said in str(kl.diagnose(robot, quantity, wrong, samples=20))


@pytest.mark.many
@pytest.mark.parametrize(
    ("name", "slips"),
    [
        pytest.param("closed", [("J2 = I2 + m2*c2**2", "J2 = I2"), ("h*np.sin(q[1])*v[0]**2", "-h*np.sin(q[1])*v[0]**2")], id="an axis and a sign"),
        pytest.param("typed", [("trans(0.5, 0, 0)", "trans(0.7, 0, 0)"), ("@ trans(0.4, 0, 0)", "@ trans(0, 0.4, 0)")], id="a number and an order"),
        pytest.param("newton", [(" + np.cross(w, qd[i]*z)", ""), ("moment = R[i] @ moment + np", "moment = R[i].T @ moment + np")], id="two of Newton and Euler"),
        pytest.param("rounds", [("(0, l[0], 0)", "(0, -l[0], 0)"), ("[0, sa, ca, d]", "[0, -sa, ca, d]")], id="in a program that rounds"),
        pytest.param("loops", [("range(j, 2)", "range(j + 1, 2)"), ("ARM[k].centre*np", "ARM[k].length*np")], id="a loop and an attribute"),
        pytest.param("screws", [("(np.eye(3) - turn) @ r", "turn @ r"), ("x - points[k]", "x + points[k]")], id="the unit matrix and a sign"),
        pytest.param("bodies", [("load = m[0] + m[1]", "load = m[1]"), ("g*m[1]*c[1]*np.cos", "g*m[1]*c[1]*np.sin")], id="an entry and a function"),
    ],
)  # fmt: skip
def test_two_slips_are_told(name, slips) -> None:
    robot, quantity, text = PROGRAMS[name]
    for old, new in slips:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    found, good = asked(text, robot, quantity)
    assert good, str(found)


def dimensions(text):
    search = searched("planar2r_rods", "inverse_dynamics", text)
    names = [*search.case.arguments]
    return search, Dimensions(search.trial, search.observed, search.case.robot, names,
                              search.asked.states, alike=True)  # fmt: skip


def test_dimensions_of_a_right_program_are_consistent() -> None:
    search, known = dimensions(CLOSED)
    tree = search.trial.trees[0]
    assert known.consistent
    length, mass, rate = np.log(1.37), np.log(1.73), np.log(1.19)
    expected = {"h": mass + 2*length, "tip": mass + 2*length + 2*rate, "J2": mass + 2*length}  # fmt: skip
    seen = {
        node.targets[0].id: known.of(node.value)
        for node in tree.body
        if hasattr(node, "targets") and getattr(node.targets[0], "id", "") in expected
    }
    assert seen == pytest.approx(expected)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("I2 + m2*c2**2", "I2 + m2*c2"),
        ("h = m2*l1*c2", "h = m2*l1"),
        ("m1*c1 + m2*l1", "c1 + l1*m2"),
    ],
)
def test_a_lost_factor_makes_them_inconsistent(old, new) -> None:
    assert CLOSED.count(old) == 1
    _search, known = dimensions(CLOSED.replace(old, new))
    assert not known.consistent
    assert known.apart


def test_numbers_that_may_be_several_things_tell_nothing() -> None:
    """0.5 in the middle of a formula is a half or a length."""
    _search, known = dimensions(
        CLOSED.replace("2*h*np.cos(q[1]))*a[0]", "4*0.5*h*np.cos(q[1]))*a[0]")
    )
    assert not known.consistent
    assert not known.apart


# -------- Inverse kinematics

TRIANGLE = """
import math

l1, l2 = 0.5, 0.4

def corner(a, b, c):
    return math.acos((a*a + b*b - c*c)/(2*a*b))

def f(x, y):
    r = math.hypot(x, y)
    inner, elbow = corner(r, l1, l2), corner(l1, l2, r)
    out = []
    for side in (1, -1):
        first = math.atan2(y, x) - side*inner
        second = side*(math.pi - elbow)
        out.append((first, second))
    return out
"""


@pytest.mark.parametrize(
    "slips",
    [
        pytest.param([("+ b*b - c*c", "+ b*b + c*c")], id="no value anywhere"),
        pytest.param([("(math.pi - elbow)", "elbow")], id="the other angle"),
        pytest.param([("/(2*a*b)", "/(a*b)"), ("atan2(y, x)", "atan2(x, y)")], id="no value, and an order"),
        pytest.param([("/(2*a*b)", "/(2*a)"), ("side*(math.pi - elbow)", "side*elbow")], id="a factor, and the other angle"),
    ],
)  # fmt: skip
def test_slips_of_inverse_kinematics_are_told(slips) -> None:
    assert kl.diagnose("planar2r", "inverse_kinematics_xy", written(TRIANGLE)).agrees
    text = TRIANGLE
    for right, wrong in slips:
        assert text.count(right) == 1
        text = text.replace(right, wrong)
    found = kl.diagnose("planar2r", "inverse_kinematics_xy", written(text), samples=40)
    assert found.causes, str(found)
    mended = [after["f"] for after in repaired(text, found.causes[0].sentence)]
    assert any(kl.diagnose("planar2r", "inverse_kinematics_xy", f).agrees for f in mended), str(
        found
    )
