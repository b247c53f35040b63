"""Slips that are more than one sign or one name: what is said of each makes the program right.

Every program is right before the slip, which its verdict tells first.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import asked, searched, written

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
PROGRAMS = {
    "motion": ("planar2r_rods", "kinetic_energy", MOTION),
    "closed": ("planar2r_rods", "inverse_dynamics", CLOSED),
    "typed": ("planar2r", "fk", TYPED),
    "bodies": ("planar2r_rods", "gravity_torques", BODIES),
    "degrees": ("puma560", "fk", DEGREES),
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
]  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.parametrize(("name", "old", "new"), [x[:3] for x in SLIPS], ids=[x[3] for x in SLIPS])
def test_a_slip_is_told(name, old, new) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert text.count(old) == 1
    found, good = asked(text.replace(old, new), robot, quantity)
    assert good, str(found)


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("motion", "v = v + np.cross(w, p)", "v = v", "should be `v = v + np.cross(w, p)`"),
        ("motion", "w + z*qd[i]", "w + z", "the factor qd"),
        ("degrees", "np.radians([90, 0, -90, 90, -90, 0])", "np.array([90, 0, -90, 90, -90, 0])",
         "twists, degrees are taken for radians"),
        ("degrees", "a = [0, 0.4318, 0.0203, 0, 0, 0]", "a = [0, 0, 0, 0.0203, 0.4318, 0]",
         "a, the numbers stand in the reverse order"),
    ],
    ids=["a cross product", "a vector without its factor", "a row in degrees", "a row in reverse"],
)  # fmt: skip
def test_a_slip_is_told_in_these_words(name, old, new, said) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert text.count(old) == 1
    wrong = written(text.replace(old, new))
    assert said in str(kl.diagnose(robot, quantity, wrong, samples=20))


@pytest.mark.parametrize(
    ("name", "slips"),
    [
        pytest.param("closed", [("J2 = I2 + m2*c2**2", "J2 = I2"), ("h*np.sin(q[1])*v[0]**2", "-h*np.sin(q[1])*v[0]**2")], id="an axis and a sign"),
        pytest.param("typed", [("trans(0.5, 0, 0)", "trans(0.7, 0, 0)"), ("@ trans(0.4, 0, 0)", "@ trans(0, 0.4, 0)")], id="a number and an order"),
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
                              search.states, alike=True)  # fmt: skip


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
