"""Programs of which the doctor read something as what it is not: every one is right before its slip."""

from __future__ import annotations

import pytest
from hand_programs import asked, told_in_its_line, with_slips

BLOCKS = """
import numpy as np

def R(t):
    return np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]])

def f(q, v, a):
    L1, L2 = 0.5, 0.4
    P1, P2 = np.array([L1, 0.0]), np.array([L2, 0.0])
    C1, C2, C3 = np.array([0.25, 0.0]), np.array([0.2, 0.0]), np.array([0.125, 0.0])
    m1, m2, m3 = 3.0, 2.0, 1.0
    I1, I2, I3 = 0.0625, 0.4**2*m2/12, 0.25**2*m3/12
    X = np.array([[0.0, -1.0], [1.0, 0.0]])
    w1 = v[0]
    d1 = a[0]
    a1 = R(q[0]).T @ np.array([0.0, 9.81])
    F1 = m1*(a1 + d1*X @ C1 - w1**2*C1)
    w2 = w1 + v[1]
    d2 = d1 + a[1]
    a2 = R(q[1]).T @ (a1 + d1*X @ P1 - w1**2*P1)
    F2 = m2*(a2 + d2*X @ C2 - w2**2*C2)
    w3 = w2 + v[2]
    d3 = d2 + a[2]
    a3 = R(q[2]).T @ (a2 + d2*X @ P2 - w2**2*P2)
    F3 = m3*(a3 + d3*X @ C3 - w3**2*C3)
    n3 = I3*d3 + C3[0]*F3[1]
    g2 = R(q[2]) @ F3
    n2 = I2*d2 + n3 + C2[0]*F2[1] + P2[0]*g2[1]
    g1 = R(q[1]) @ (g2 + F2)
    n1 = I1*d1 + n2 + C1[0]*F1[1] + P1[0]*g1[1]
    return np.array([n1, n2, n3])
"""


@pytest.mark.parametrize(
    ("right", "slip"),
    [
        ("(a2 + d2*X @ P2 - w2**2*P2)", "(a2 + d2*X @ P2 - w1**2*P2)"),
        ("g1 = R(q[1]) @", "g1 = R(q[1]).T @"),
        ("d3 = d2 + a[2]", "d3 = d1 + a[2]"),
    ],
)
def test_moments_that_are_worked_out_are_a_rods(right, slip):
    """The 0.25 of ``0.25**2*m3/12`` is a length, and not the first centre's distance."""
    told_in_its_line("planar3r", "inverse_dynamics", BLOCKS, right, slip)


COLUMNS = """
import numpy as np

l1, l2 = 0.5, 0.4

def f(q):
    z1 = z2 = np.array([0.0, 0.0, 1.0])
    a, b = q[0], q[0] + q[1]
    o1 = np.zeros(3)
    o2 = np.array([l1*np.cos(a), l1*np.sin(a), 0.0])
    tool = o2 + np.array([l2*np.cos(b), l2*np.sin(b), 0.0])
    x2 = np.cross(z2, tool - o2)
    x1 = np.cross(z1, tool - o1)
    J1 = np.r_[x1, z1]
    J2 = np.r_[x2, z2]
    return np.c_[J1, J2]
"""


@pytest.mark.parametrize(
    ("right", "slip"), [("np.r_[x2, z2]", "np.r_[x1, z2]"), ("np.c_[J1, J2]", "np.c_[J1, J1]")]
)
def test_what_is_joined_is_no_index(right, slip):
    told_in_its_line("planar2r", "jacobian", COLUMNS, right, slip)


UNIT_VECTORS = """
import numpy as np

a, m = [0.5, 0.4], [2.0, 1.5]

def newton(q, v, acc, g):
    angle, turn, w, lin = 0.0, 0.0, 0.0, np.array([0.0, g])
    at, ends, forces = np.zeros(2), [], []
    points = []
    for i in range(2):
        points.append(at)
        angle = angle + q[i]
        w, turn = w + v[i], turn + acc[i]
        r = a[i]*np.array([np.cos(angle), np.sin(angle)])
        lin = lin + turn*np.array([-r[1], r[0]]) - w**2*r
        at = at + r
        ends.append(at)
        forces.append(m[i]*lin)
    tau = np.zeros(2)
    for j in range(2):
        for i in range(j, 2):
            arm = ends[i] - points[j]
            tau[j] += arm[0]*forces[i][1] - arm[1]*forces[i][0]
    return tau

def f(q, v, tau):
    rest = np.zeros(2)
    bias = newton(q, v, rest, 9.81)
    M = np.column_stack([newton(q, rest, e, 0.0) for e in np.eye(2)])
    return np.linalg.solve(M, tau - bias)
"""


def test_a_function_asked_alone_is_asked_what_may_be_right_of_it():
    """The bias, which is asked for first, stays wrong with the other slip."""
    slips = [("ends[i] - points[j]", "ends[i] - points[i]"), ("rest, 9.81", "rest, -9.81")]
    found, good = asked(with_slips(UNIT_VECTORS, slips), "planar2r", "forward_dynamics")
    assert good, str(found)
    assert "points[j]" in found.sentence and "9.81" in found.sentence


TWICE = """
import numpy as np

L, m = np.array([0.5, 0.4]), np.array([2.0, 1.5])

def cross(r, F):
    return r[0]*F[1] - r[1]*F[0]

def f(q):
    angle = np.cumsum(q)
    arms = [l*np.array([np.cos(t), np.sin(t)]) for l, t in zip(L, angle)]
    F, n = np.zeros(2), 0.0
    out = []
    for i in (1, 0):
        own = np.array([0.0, 9.81*m[i]])
        n = n + cross(arms[i], own) + cross(arms[i], F)
        F = F + own
        out.append(n)
    return np.array(out[::-1])
"""


def test_nobody_adds_a_force_to_itself():
    slip = "cross(arms[i], own) + cross(arms[i]/2, F)"
    right = "cross(arms[i], own) + cross(arms[i], F)"
    found, good = asked(with_slips(TWICE, [(right, slip)]), "planar2r", "gravity_torques")
    assert good and "own + own" not in found.sentence, str(found)


LIGHT = """
import numpy as np

kin = {"first": (0.0, 0.5), "second": (0.0, 0.4)}
dyn = {"first": (2.0, (0.5, 0.0, 0.0)), "second": (1.5, (0.4, 0.0, 0.0))}

def turn(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])

def moved(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T

def f(q):
    T, V = np.eye(4), 0.0
    for (name, (off, a)), t in zip(kin.items(), q):
        T = T @ turn(t + off)
        m, c = dyn[name]
        V += 9.81*m*(T @ np.append(c, 1))[1]
        T = T @ moved(a, 0, 0)
    return V
"""


def test_a_vector_that_should_be_a_point():
    """``append(r, 0)`` is the vector from the joint, which is right of something else."""
    right, slip = "np.append(c, 1)", "np.append(c, 0)"
    told_in_its_line("planar2r", "potential_energy", LIGHT, right, slip)


def test_two_entries_inside_of_a_row_are_exchanged(tmp_path):
    wrong = with_slips(LIGHT, [("(1.5, (0.4, 0.0, 0.0))", "(1.5, (0.0, 0.4, 0.0))")])
    found, _good = asked(wrong, "planar2r", "potential_energy", tmp_path / "own.py")
    (cause,) = found.causes
    assert cause.kinds == ("entries swapped",) and cause.error_after < 1e-9
    assert "line 5, dyn['second'][1]" in cause.sentence
    assert "`0, 0.4, 0` should be `0.4, 0, 0`" in cause.sentence
