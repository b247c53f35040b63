"""What is told of a program is of that program: its ways, its numbers, its lines."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest
from hand_programs import searched, written

import kinlab as kl
from kinlab.doctor.program.grounds.scaled import is_own
from kinlab.doctor.program.read import read
from kinlab.doctor.program.trial import FailedError, Trial

ENERGY = """
import numpy as np
m, L, g = [3.0, 2.0, 1.0], [0.5, 0.4, 0.25], 9.81

def V(q):
    y, th, total = 0.0, 0.0, 0.0
    for i in range(3):
        th += q[i]
        total += m[i]*g*(y + L[i]/2*np.sin(th))
        y += L[i]*np.sin(th)
    return total

def f(q):
    eps, out = 1e-6, []
    for k in range(3):
        dq = np.zeros(3)
        dq[k] = eps
        out.append((V(q + dq) - V(q - dq))/(2*eps))
    return np.array(out)
"""
COMPLEX = """
import numpy as np
l1, l2 = 0.5, 0.4

def f(q):
    e1, e12 = np.exp(1j*q[0]), np.exp(1j*(q[0] + q[1]))
    p = l1*e1 + l2*e12
    T = np.eye(4)
    T[0, 0], T[0, 1] = e12.real, -e12.imag
    T[1, 0], T[1, 1] = e12.imag, e12.real
    T[0, 3], T[1, 3] = p.real, p.imag
    return T
"""
CLOSED = """
import numpy as np
m1, m2, l1, l2, g = 2.0, 1.5, 0.5, 0.4, 9.81

def f(q):
    g2 = m2*g*l2*np.cos(q[0] + q[1])
    g1 = (m1*l1 + m2*l1)*g*np.cos(q[0]) + g2
    return np.array([g1, g2])
"""
LINKS = """
import numpy as np
ROWS = [(0.0, 0.0), (0.45, 0.0), (0.35, np.pi/2)]

def link(th, a, alpha):
    c, s, ca, sa = np.cos(th), np.sin(th), np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s, 0, a], [s*ca, c*ca, -sa, 0], [s*sa, c*sa, ca, 0], [0, 0, 0, 1]])

def f(q):
    T = np.eye(4)
    for th, (a, alpha) in zip(q, ROWS):
        T = T @ link(th, a=a, alpha=alpha)
    T[:3, 3] += 0.3*T[:3, 0]
    return T
"""
UPPER = """
import numpy as np
m, L = [3.0, 2.0, 1.0], [0.5, 0.4, 0.25]

def column(q, k, i):
    th, out = np.cumsum(q), np.zeros(2)
    for j in range(i, k + 1):
        part = L[j]/2 if j == k else L[j]
        out += part*np.array([-np.sin(th[j]), np.cos(th[j])])
    return out

def f(q):
    A = np.zeros((3, 3))
    for i in range(3):
        for j in range(i, 3):
            for k in range(j, 3):
                A[i, j] += m[k]*column(q, k, i) @ column(q, k, j) + m[k]*L[k]**2/12
    return A + A.T - np.diag(np.diag(A))
"""


@pytest.fixture
def said(tmp_path):
    """What is told of a text with a slip in it."""

    def tell(text, old, new, robot="planar3r", quantity="gravity_torques"):
        assert text.count(old) == 1
        path = tmp_path / "hand.py"
        path.write_text(text.replace(old, new))
        found = kl.diagnose(robot, quantity, written(path.read_text(), path))
        assert not found.agrees
        return str(found)

    return tell


def test_what_a_program_does_not_go_through_is_not_told_of_it(said) -> None:
    """Torques by differences have no force of a link, though leaving one out fits the numbers."""
    told = said(ENERGY, "y += L[i]", "y = L[i]")
    assert "line 10 (in V), the sum forgets" in told
    assert "force" not in told


def test_a_closed_formula_is_told_its_term(said) -> None:
    told = said(CLOSED, " + m2*l1)*g", ")*g", "planar2r")
    assert "m2" in told
    assert "moment n" not in told


def test_answers_that_are_next_to_nothing_fit_no_reading(said) -> None:
    assert "leaves" not in said(ENERGY, "/(2*eps)", "/2")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("V(q - dq)", "V(q)", "`V(q + dq) - V(q)` should be `V(q + dq) - V(q - dq)`"),
        ("V(q + dq) -", "V(q) -", "(V(q + dq) - V(q - dq))"),
        ("m[i]*g", "m[0]*g", "m[i]*g*(y + L[i]/2*np.sin(th))`"),
    ],
)
def test_a_rough_repair_gives_way_to_an_exact_one(old, new, told, said) -> None:
    found = said(ENERGY, old, new)
    assert "2*dq" not in found
    assert told.split("` should be `")[-1].rstrip("`") in found


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("l2*e12", "l2*e1", "`p = l1*e1 + l2*e12`"),
        ("p.real, p.imag", "p.imag, p.real", "line 11, the order is exchanged"),
        ("-e12.imag", "e12.imag", "-e12.imag"),
    ],
)
def test_complex_numbers_are_looked_through(old, new, told, said) -> None:
    assert told in said(COMPLEX, old, new, "planar2r", "fk")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("(0.35, np.pi/2)", "(0.45, 0.0)", "0.45, 0` should be `0.35, 1.5708"),
        ("(0.35, np.pi/2)", "(0.35, -np.pi/2)", "line 3, the sign is wrong"),
        ("-s, 0, a]", "-s, 0, a + c]", "a + c"),
    ],
)
def test_the_rows_of_a_table_are_held_against_the_arms(old, new, told, said) -> None:
    """Also of functions that are called with their arguments by name."""
    assert told in said(LINKS, old, new, "spatial3r", "fk")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("A + A.T -", "2*A -", "`return A + A.T - np.diag(np.diag(A))`"),
        ("np.diag(np.diag(A))", "np.diag(A)", "`return A + A.T - np.diag(np.diag(A))`"),
        ("m[k]*L[k]**2/12", "(m[k]*L[k])**2/12", "m[k]*L[k]**2/12"),
        ("part*np.array", "part + np.array", "`out += part*np.array"),
    ],
)
def test_slips_that_were_unknown(old, new, told, said) -> None:
    assert told in said(UPPER, old, new, quantity="mass_matrix")


@pytest.mark.parametrize(
    ("text", "robot", "quantity"),
    [
        (ENERGY, "planar3r", "gravity_torques"),
        (COMPLEX, "planar2r", "fk"),
        (CLOSED, "planar2r", "gravity_torques"),
        (LINKS, "spatial3r", "fk"),
        (UPPER, "planar3r", "mass_matrix"),
    ],
)
def test_what_is_right_is_right_for_another_arm(text, robot, quantity) -> None:
    search = searched(robot, quantity, text, 0.0)
    assert all(other.whole and search.arms.hold_for(other) for other in search.arms.before)


def test_the_arms_own_number_is_not_the_slip() -> None:
    search = searched("planar2r", "gravity_torques", CLOSED, 0.0)
    assert is_own(search.case.robot, 1.5)
    assert not is_own(search.case.robot, -1.5)


def test_a_programs_own_error_is_told_from_ours() -> None:
    short = written("def f(q):\n    return q[7]")
    with pytest.raises(FailedError, match="IndexError"):
        Trial(read(short)).function(np.zeros(2))


def test_a_name_that_a_slip_has_left_unused_is_moved_with_the_other_arm(said) -> None:
    """l2 is used once; without it nothing else of the program says that it is the arm's."""
    assert "`g2 = m2*g*l2*np.cos(q[0] + q[1])`" in said(CLOSED, "g*l2", "g*l1", "planar2r")


def test_a_program_that_gives_a_matrix_of_numpys_own() -> None:
    """``np.matrix`` has rules of its own, which nothing of the doctor may trip over."""
    text = """
import numpy as np

def f(q):
    b = 1.5*0.5*0.4*np.cos(q[1])
    d = 2.0*0.4**2
    return np.matrix([[(2.0 + 1.5)*0.5**2 + 1.5*0.4**2 + 2*b, 1.5*0.4**2 + b],
                      [1.5*0.4**2 + b, d]])
"""
    found = kl.diagnose("planar2r", "mass_matrix", written(text), samples=20)
    assert not found.agrees
    assert "line 6" in found.sentence


def test_one_number_for_a_twist_and_for_an_angle() -> None:
    """``H`` is the arm's twist, its opposite, and the angle of its slide: signs are told all the
    same, though another arm's would need two numbers."""
    text = """
import numpy as np

def A(th, d, a, al):
    return np.array([
        [np.cos(th), -np.sin(th)*np.cos(al), np.sin(th)*np.sin(al), a*np.cos(th)],
        [np.sin(th), np.cos(th)*np.cos(al), -np.cos(th)*np.sin(al), a*np.sin(th)],
        [0, np.sin(al), np.cos(al), d],
        [0, 0, 0, 1]])

def f(q):
    H = np.pi/2
    first = A(q[0], 0.412, 0, -H) @ A(q[1], 0.154, 0, -H) @ A(-H, q[2], 0.0203, 0)
    return first @ A(q[3], 0, 0, -H) @ A(q[4], 0, 0, -H) @ A(q[5], 0.263, 0, 0)
"""
    found = kl.diagnose("stanford", "fk", written(text), samples=20)
    assert found.causes and {"line 13", "line 14"} <= {*found.causes[0].places}, str(found)


def test_degrees_of_a_name_are_told_as_they_are_mended() -> None:
    text = """
import numpy as np

L = [0.5, 0.4, 0.25]

def f(q):
    J = np.zeros((3, 3))
    for j in range(3):
        for k in range(j, 3):
            th = np.degrees(np.sum(q[:k + 1]))
            J[0, j] -= L[k]*np.sin(th)
            J[1, j] += L[k]*np.cos(th)
        J[2, j] = 1.0
    return J
"""
    found = kl.diagnose("planar3r", "planar_jacobian", written(text), samples=20)
    assert "line 10" in found.sentence
    assert "if True" not in found.sentence


def test_a_field_that_is_used_nowhere_else(tmp_path) -> None:
    two = kl.DHTable(
        "two",
        "standard",
        [kl.DHLink("revolute", a=0.41, mass=3.8, com=(-0.22, 0, 0)),
         kl.DHLink("revolute", a=0.37, mass=1.6, com=(-0.23, 0, 0))],
        gravity=(0, -9.81, 0),
    )  # fmt: skip
    text = """
import numpy as np

class Arm:
    g = 9.81

    def __init__(self, l1, c1, c2, m1, m2):
        self.l1, self.c1, self.c2, self.m1, self.m2 = l1, c1, c2, m1, m2

    def first(self, q):
        return (self.m1*self.c1 + self.m2*self.c1)*self.g*np.cos(q[0]) + self.second(q)

    def second(self, q):
        return self.m2*self.g*self.c2*np.cos(q[0] + q[1])

arm = Arm(0.41, 0.19, 0.14, 3.8, 1.6)

def f(q):
    return np.array([arm.first(q), arm.second(q)])
"""
    (tmp_path / "weights.py").write_text(text)
    spec = importlib.util.spec_from_file_location("weights", tmp_path / "weights.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    found = kl.diagnose(two, "gravity_torques", module.f, samples=20)
    assert "self.m1*self.c1 + self.m2*self.l1" in found.sentence


def test_numbers_that_stand_as_the_arm_has_them_are_not_exchanged() -> None:
    """`Ixx` and `Izz` change places in the line: the tensor above is the arm's."""
    tensor = (0.026, 0.017, 0.033)
    arm = kl.DHTable(
        "arm",
        "standard",
        [kl.DHLink("revolute", alpha=np.pi / 2, mass=2.0, inertia=np.diag([0.03, 0.04, 0.03])),
         kl.DHLink("revolute", a=0.4, mass=1.5, com=(-0.15, 0, 0), inertia=np.diag(tensor))],
        gravity=(0, 0, -9.81),
    )  # fmt: skip
    text = """
import numpy as np

def f(q):
    J2 = [0.026, 0.017, 0.033]
    c, s = np.cos(q[1]), np.sin(q[1])
    return np.array([[0.04 + J2[{0}]*s**2 + J2[{1}]*c**2 + 1.5*(0.25*c)**2, 0.0],
                     [0.0, J2[2] + {2}]])
"""
    right, wrong = text.format(0, 1, "1.5*0.25**2"), text.format(1, 0, "1.5*0.25")
    assert kl.diagnose(arm, "mass_matrix", written(right), samples=20).agrees
    found = kl.diagnose(arm, "mass_matrix", written(wrong), samples=20)
    assert found.causes
    assert "line 5" not in found.causes[0].places, found.sentence


COUPLED = """
import numpy as np

def f(q, v):
    h = 1.5*0.5*0.4*np.sin(q[1])
    return np.array([-2*h*v[0]*v[1] - h*v[1]**2, h*v[0]**2])
"""


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("-2*h*v[0]*v[1] -", "-h*v[0]*v[1] -", "[-2*h*v[0]*v[1] - h*v[1]**2"),
        ("h*v[0]**2]", "-h*v[0]**2]", "h*v[0]**2])`"),
    ],
)
def test_signs_and_factors_of_products_are_typed_without_parentheses(old, new, told, said) -> None:
    sentence = said(COUPLED, old, new, "planar2r", "coriolis_torques")
    right = sentence.partition("should be `")[2].partition("`")[0] + "`"
    assert told in right and "(-" not in right and "*(" not in right
