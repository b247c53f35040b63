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


@pytest.mark.many
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


LIFTED = """
import numpy as np

def f(q):
    m3 = 1.2
    c = (0.12, 0.03, 0.01)
    dh = c[0]*np.cos(q[2]) - c[1]*np.sin(q[2])
    return np.array([0.0, 0.0, m3*9.81*dh])
"""


def test_coordinates_that_stand_together_are_those_of_one_centre():
    """The 0.03 is link 3's across, and not link 2's along its axis, nor link 2's because second."""
    told_in_its_line("spatial3r", "gravity_torques", LIFTED, "- c[1]", "+ c[1]")


KANE = """
import numpy as np

L  = [0.5, 0.4, 0.25]
LC = [0.25, 0.2, 0.125]
MB = [3.0, 2.0, 1.0]
IB = [MB[k]*L[k]**2/12 for k in range(3)]

def f(q, u, udot):
    th, om, al = np.cumsum(q), np.cumsum(u), np.cumsum(udot)
    e = [np.array([np.cos(t), np.sin(t)]) for t in th]
    n = [np.array([-np.sin(t), np.cos(t)]) for t in th]
    tau = np.zeros(3)
    for b in range(3):
        acc = LC[b]*(al[b]*n[b] - om[b]**2*e[b])
        for k in range(b):
            acc = acc + L[k]*(al[k]*n[k] - om[k]**2*e[k])
        for r in range(b + 1):
            vr = LC[b]*n[b]
            for k in range(r, b):
                vr = vr + L[k]*n[k]
            tau[r] += MB[b]*9.81*vr[1] + MB[b]*(acc @ vr) + IB[b]*al[b]
    return tau
"""


def test_beside_a_number_that_is_none_of_the_arm_s_others_are_looked_for_as_widely():
    slips = [
        ("[0.5, 0.4, 0.25]", "[0.5, 0.45, 0.25]"),
        ("LC[b]*(al[b]*n[b] - om[b]**2", "LC[b]*(al[b]*n[b] - om[b]"),
        ("IB[b]*al[b]", "IB[b]*udot[b]"),
    ]
    found, _good = asked(with_slips(KANE, slips), "planar3r", "inverse_dynamics")
    (cause,) = found.causes
    for told in ("0.45 should be 0.4", "om[b]**2*e[b])`", "IB[b]*al[b]`"):
        assert told in cause.sentence


REACHED = """
import numpy as np

a2, a3, lt = 0.45, 0.35, 0.30

def f(x, y, z):
    found = []
    s3 = np.clip(z/lt, -1, 1)
    for c3 in (np.sqrt(1 - s3**2), -np.sqrt(1 - s3**2)):
        q3 = np.arctan2(s3, c3)
        k = a3 + lt*c3
        D = (x*x + y*y - a2*a2 - k*k)/(2*a2*k)
        if abs(D) > 1 + 1e-9:
            continue
        for elbow in (1, -1):
            q2 = elbow*np.arccos(np.clip(D, -1, 1))
            q1 = np.arctan2(y, x) - np.arctan2(k*np.sin(q2), a2 + k*np.cos(q2))
            found.append(((q1 + np.pi) % (2*np.pi) - np.pi, q2, q3))
    return np.array(found) if found else np.zeros((1, 3))
"""


def test_lengths_of_terms_with_more_factors_are_exchanged():
    exchanged = ("a2 + k*np.cos(q2)", "k + a2*np.cos(q2)")
    told_in_its_line("spatial3r", "inverse_kinematics_xyz", REACHED, *exchanged)


COMPOSITE = """
import numpy as np

def sk(x):
    return np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]], float)

class Body:
    def __init__(self, a, alpha, d, m, com, ixx, iyy, izz):
        self.a, self.alpha, self.d = a, alpha, d
        c = sk(com)
        self.I = np.zeros((6, 6))
        self.I[:3, :3] = np.diag([ixx, iyy, izz]) + m * c @ c.T
        self.I[:3, 3:] = m * c
        self.I[3:, :3] = m * c.T
        self.I[3:, 3:] = m * np.eye(3)

    def X(self, q):
        Rz = np.array([[np.cos(q), -np.sin(q), 0], [np.sin(q), np.cos(q), 0], [0, 0, 1]])
        ca, sa = np.cos(self.alpha), np.sin(self.alpha)
        R = Rz @ np.array([[1, 0, 0], [0, ca, -sa], [0, sa, ca]])
        p = Rz @ np.array([self.a, 0, self.d])
        return np.block([[R.T, np.zeros((3, 3))], [-R.T @ sk(p), R.T]])

h = np.pi / 2
arm = [Body(0.0, h, 0.1273, 7.778, (0, 0, 0), 0.031474313, 0.021875625, 0.031474313),
       Body(-0.612, 0, 0.0, 12.93, (0.306, 0, 0.220941), 0.036365625, 0.421753804, 0.421753804),
       Body(-0.5723, 0, 0.0, 3.87, (0.28615, 0, 0.049041), 0.010884375, 0.111069694, 0.111069694),
       Body(0.0, h, 0.163941, 1.96, (0, -0.1149, 0), 0.005108248, 0.005108248, 0.0055125),
       Body(0.0, -h, 0.1157, 1.96, (0, 0.1157, 0), 0.005108248, 0.0055125, 0.005108248),
       Body(0.0, 0, 0.0922, 0.202, (0, 0, -0.0922), 0.000526462, 0.000568125, 0.000526462)]

def f(q):
    n = len(arm)
    X = [b.X(t) for b, t in zip(arm, q)]
    S = [x[:, 2] for x in X]
    Ic = [b.I.copy() for b in arm]
    H = np.zeros((n, n))
    for i in range(n - 1, -1, -1):
        if i:
            Ic[i - 1] += X[i].T @ Ic[i] @ X[i]
        F = Ic[i] @ S[i]
        H[i, i] = S[i] @ F
        j = i
        while j > 0:
            F = X[j].T @ F
            j -= 1
            H[i, j] = H[j, i] = F @ S[j]
    return H
"""


def test_a_tensor_s_way_to_another_point_is_found_where_its_parts_stand_in_other_lines(tmp_path):
    slip = "izz]) + m * c @ c.T", "izz])"
    told_in_its_line("ur10", "mass_matrix", COMPOSITE, *slip, tmp_path / "composite.py")


LIFTS = """
import numpy as np

W = 9.81*np.array([7.0, 5.0, 1.2, 0.4])
ROWS = [(0.325, 0.0, 0.387), (0.275, np.pi, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)]
CENTRES = [(-0.16, 0, 0.02), (-0.13, 0.005, -0.03), (0, 0, -0.05), (0.01, 0, -0.01)]

def f(q):
    T, joints, out = np.eye(4), [], np.zeros(4)
    for k, (a, al, d) in enumerate(ROWS):
        th, d = (0.0, q[k]) if k == 2 else (q[k], d)
        joints.append((T[:3, 2].copy(), T[:3, 3].copy(), k == 2))
        c, s, ca, sa = np.cos(th), np.sin(th), np.cos(al), np.sin(al)
        T = T @ np.array([[c, -s*ca, s*sa, a*c], [s, c*ca, -c*sa, a*s], [0, sa, ca, d], [0, 0, 0, 1]])
        pc = T[:3, :3] @ CENTRES[k] + T[:3, 3]
        for j, (z, o, slides) in enumerate(joints):
            lift = z[2] if slides else np.cross(z, pc - o)[2]
            out[j] += W[k]*lift
    return out
"""


def test_a_branch_that_is_nothing():
    told_in_its_line("scara", "gravity_torques", LIFTS, "lift = z[2] if", "lift = 0.0 if")


NODES = """
import numpy as np

def f(q, v):
    L, mass = 0.6, 2.5
    nodes = 0.5*L*(1 + np.array([-1, 1])/np.sqrt(3))
    dm = mass/2
    T = sum(0.5*dm*(s*v[0])**2 for s in nodes)
    V = sum(dm*9.81*s*np.sin(q[0]) for s in nodes)
    return T - V
"""


def test_a_root_that_is_lost():
    told_in_its_line("single_link", "lagrangian", NODES, "/np.sqrt(3)", "/3")


def test_three_edits_of_an_arm_with_two_terms_are_no_proof():
    """Of what no edit undoes nothing is told."""
    found, _good = asked(
        with_slips(NODES, [("/np.sqrt(3)", "/np.log(3)")]), "single_link", "lagrangian"
    )
    assert not found.agrees and all(len(cause.kinds) < 3 for cause in found.causes)


BELOW = """
import numpy as np

DH = np.array([[0, 0.089159, 1], [-0.425, 0, 0], [-0.39225, 0, 0], [0, 0.10915, 1], [0, 0.09465, -1], [0, 0.0823, 0]])
MASS = [3.7, 8.393, 2.275, 1.219, 1.219, 0.1879]
CG = [[0, 0, 0], [0.145, 0, 0.13585], [0.14225, 0, 0.01615], [0, -0.093, 0], [0, 0.09465, 0], [0, 0, -0.0823]]

def f(q):
    def below(i, R, o):
        if i == 6:
            return 0.0, np.zeros(3)
        a, d, k = DH[i]
        c, s = np.cos(q[i]), np.sin(q[i])
        ca, sa = (1, 0) if k == 0 else (0, k)
        o2 = o + R @ [a*c, a*s, d]
        R2 = R @ np.array([[c, -s*ca, s*sa], [s, c*ca, -c*sa], [0, sa, ca]])
        m, S = below(i + 1, R2, o2)
        m, S = m + MASS[i], S + MASS[i]*(o2 + R2 @ CG[i])
        tau[i] = 9.81*np.cross(R[:, 2], S - m*o)[2]
        return m, S
    tau = np.zeros(6)
    below(0, np.diag([-1.0, -1.0, 1.0]), np.zeros(3))
    return tau
"""


def test_an_origin_that_is_left_out_of_what_is_weighed():
    told_in_its_line("ur5", "gravity_torques", BELOW, "*(o2 + R2 @ CG[i])", "*(R2 @ CG[i])")
