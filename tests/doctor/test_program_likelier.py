"""Of what makes a program right, the likelier slip is told: where a value is read, not written."""

from __future__ import annotations

import pytest
from hand_programs import written

import kinlab as kl

STANFORD = """
import numpy as np
pi = np.pi
alpha = [None, -pi/2, pi/2, 0, -pi/2, pi/2, 0]
a = [None, 0, 0, 0.0203, 0, 0, 0]
d = [None, 0.412, 0.154, 0, 0, 0, 0.263]
theta = [None, 0, 0, -pi/2, 0, 0, 0]
sigma = [None, 0, 0, 1, 0, 0, 0]

def f(q):
    n = 6
    qq = np.zeros(n + 1)
    qq[1:] = q
    T = np.eye(4)
    z, p = np.zeros((3, n + 2)), np.zeros((3, n + 2))
    z[:, 1] = [0, 0, 1]
    for i in range(1, n + 1):
        if sigma[i] == 0:
            th = theta[i] + qq[i]
            di = d[i]
        else:
            th = theta[i]
            di = d[i] + qq[i]
        c, s, ca, sa = np.cos(th), np.sin(th), np.cos(alpha[i]), np.sin(alpha[i])
        A = np.array([[c, -s*ca, s*sa, a[i]*c], [s, c*ca, -c*sa, a[i]*s], [0, sa, ca, di],
                      [0, 0, 0, 1]])
        T = T @ A
        z[:, i + 1] = T[0:3, 2]
        p[:, i + 1] = T[0:3, 3]
    J = np.zeros((6, n))
    for i in range(1, n + 1):
        if sigma[i] == 0:
            J[0:3, i - 1] = np.cross(z[:, i], p[:, n + 1] - p[:, i])
            J[3:6, i - 1] = z[:, i]
        else:
            J[0:3, i - 1] = z[:, i]
    return J
"""
SCARA_JACOBIAN = """
import numpy as np
A1, A2, D1 = 0.325, 0.275, 0.387

def dh(a, alpha, d, theta):
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    return np.array([[ct, -st*ca, st*sa, a*ct], [st, ct*ca, -ct*sa, a*st], [0.0, sa, ca, d],
                     [0.0, 0.0, 0.0, 1.0]])

def f(q):
    rows = [(A1, 0.0, D1, q[0]), (A2, np.pi, 0.0, q[1]), (0.0, 0.0, q[2], 0.0),
            (0.0, 0.0, 0.0, q[3])]
    kinds = "RRPR"
    T = np.eye(4)
    z, o = [T[:3, 2]], [T[:3, 3]]
    for row in rows:
        T = T @ dh(*row)
        z.append(T[:3, 2])
        o.append(T[:3, 3])
    J = np.zeros((6, 4))
    for i in range(4):
        if kinds[i] == "R":
            J[:3, i] = np.cross(z[i], o[-1] - o[i])
            J[3:, i] = z[i]
        else:
            J[:3, i] = z[i]
    return J
"""
SCARA = """
import numpy as np
a = np.array([0.325, 0.275, 0, 0])
alpha, d = np.array([0, np.pi, 0, 0]), np.array([0.387, 0, 0, 0])
m = np.array([7.0, 5.0, 1.2, 0.4])
c = np.array([[-0.16, 0, 0.02], [-0.13, 0.005, -0.03], [0, 0, -0.05], [0.01, 0, -0.01]])
inertia = np.stack([np.diag(t) for t in ([0.03, 0.09, 0.1], [0.02, 0.05, 0.055],
                                         [0.004, 0.004, 0.0008], [0.0004, 0.0005, 0.0006])])
rev = np.array([1, 1, 0, 1])

def frames(q):
    T = np.zeros((5, 4, 4))
    T[0] = np.eye(4)
    for i in range(4):
        th, di = q[i]*rev[i], d[i] + q[i]*(1 - rev[i])
        Rz = np.array([[np.cos(th), -np.sin(th), 0], [np.sin(th), np.cos(th), 0], [0, 0, 1]])
        ca, sa = np.cos(alpha[i]), np.sin(alpha[i])
        Rx = np.array([[1, 0, 0], [0, ca, -sa], [0, sa, ca]])
        A = np.eye(4)
        A[:3, :3] = Rz @ Rx
        A[:3, 3] = Rz @ [a[i], 0, 0] + [0, 0, di]
        T[i + 1] = T[i] @ A
    return T

def M(q):
    T = frames(q)
    R = T[1:, :3, :3]
    pc = np.einsum('iab,ib->ia', R, c) + T[1:, :3, 3]
    Iw = np.einsum('iab,ibc,idc->iad', R, inertia, R)
    z, o = T[:4, :3, 2], T[:4, :3, 3]
    chain = np.tril(np.ones((4, 4)))
    Jw = z[None]*(rev*chain)[:, :, None]
    lever = pc[:, None, :] - o[None]
    Jv = np.cross(z[None], lever)*(rev*chain)[:, :, None]
    Jv = Jv + z[None]*((1 - rev)*chain)[:, :, None]
    return np.einsum('i,ija,ika->jk', m, Jv, Jv) + np.einsum('ija,iab,ikb->jk', Jw, Iw, Jw)

def f(q, v):
    eps = 1e-5
    dM = np.stack([(M(q + eps*e) - M(q - eps*e))/(2*eps) for e in np.eye(4)], axis=-1)
    gamma = 0.5*(dM + dM.transpose(0, 2, 1) - dM.transpose(2, 1, 0))
    return np.einsum('ijk,k->ij', gamma, v)
"""
UP = """
import numpy as np
L, PARENT = [0.5, 0.4, 0.25], [-1, 0, 1]

def f(q):
    phi = np.cumsum(q)
    S = [L[i]*np.array([np.cos(phi[i]), np.sin(phi[i])]) for i in range(3)]
    J = np.zeros((6, 3))
    J[5] = 1
    j = 2
    r = S[j]
    J[0, j], J[1, j] = -r[1], r[0]
    while PARENT[j] > -1:
        j = PARENT[j]
        r = r + S[j]
        J[0, j], J[1, j] = -r[1], r[0]
    return J
"""
BASED = """
import numpy as np
DH = [(0.0, 0.089159, np.pi/2), (-0.425, 0.0, 0.0), (-0.39225, 0.0, 0.0), (0.0, 0.10915, np.pi/2),
      (0.0, 0.09465, -np.pi/2), (0.0, 0.0823, 0.0)]
BASE = np.diag([-1.0, -1.0, 1.0, 1.0])

def rotz(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])

def rotx(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])

def trans(x, y, z):
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T

def f(q):
    T = BASE
    for th, (a, d, al) in zip(q, DH):
        T = T @ rotz(th) @ trans(0, 0, d) @ trans(a, 0, 0) @ rotx(al)
    return T
"""
KEPT = """
import numpy as np

class Link:
    def __init__(self, m, l, I):
        self.m = m
        self.l = l
        self.I = I

LINKS = [Link(3.0, 0.5, 0.0625), Link(2.0, 0.4, 0.08/3), Link(1.0, 0.25, 0.0625/12)]

def f(q, v):
    p, th, w, K = np.zeros(2), 0.0, 0.0, 0.0
    for k, link in enumerate(LINKS):
        th, w = th + q[k], w + v[k]
        u = np.array([-np.sin(th), np.cos(th)])
        vc = p + 0.5*link.l*w*u
        p = p + link.l*w*u
        K += 0.5*link.m*vc @ vc
        K += 0.5*link.I*w**2
    return K
"""
CHRISTOFFEL = """
import numpy as np
L, m = np.array([0.5, 0.4, 0.25]), np.array([3.0, 2.0, 1.0])

def parts(q, k, p):
    phi = np.cumsum(q)
    J, D = np.zeros((2, 3)), np.zeros((2, 3))
    for j in range(k + 1):
        r = L[j]/2 if j == k else L[j]
        for i in range(j + 1):
            J[0, i] -= r*np.sin(phi[j])
            J[1, i] += r*np.cos(phi[j])
            if p <= j:
                D[0, i] -= r*np.cos(phi[j])
                D[1, i] -= r*np.sin(phi[j])
    return J, D

def dM(q, p):
    out = np.zeros((3, 3))
    for k in range(3):
        J, D = parts(q, k, p)
        out += m[k]*(D.T @ J + J.T @ D)
    return out

def f(q, v):
    dMdq = np.array([dM(q, p) for p in range(3)])
    C = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                C[i, j] += 0.5*(dMdq[k, i, j] + dMdq[j, i, k] - dMdq[i, j, k])*v[k]
    return C
"""


@pytest.fixture
def said(tmp_path):
    """What is told of a text with slips in it."""

    def tell(text, robot, quantity, *slips):
        for old, new in slips:
            assert text.count(old) == 1
            text = text.replace(old, new)
        path = tmp_path / "hand.py"
        path.write_text(text)
        return str(kl.diagnose(robot, quantity, written(text, path)))

    return tell


def test_an_index_is_wrong_rather_where_a_value_is_read(said) -> None:
    told = said(STANFORD, "stanford", "jacobian", ("p[:, n + 1] - p", "p[:, n] - p"))
    assert "p[:, n + 1] - p[:, i]" in told
    assert "p[:, i] = T" not in told


@pytest.mark.parametrize("more", ["z[i]", "z[i - 1]"])
def test_a_line_that_would_write_where_it_does_nothing_is_one_too_many(more, said) -> None:
    both = "        else:\n            J[:3, i] = z[i]\n"
    slip = (both, f"{both}            J[3:, i] = {more}\n")
    told = said(SCARA_JACOBIAN, "scara", "jacobian", slip)
    assert f"`J[3:, i] = {more}`: the line is one too many" in told
    assert "i + 1" not in told


def test_a_zero_is_what_the_other_case_has_there(said) -> None:
    told = said(STANFORD, "stanford", "jacobian", ("th = theta[i]\n", "th = 0\n"))
    assert "`th = 0` should be `th = theta[i]`" in told


def test_a_line_is_too_late_that_uses_what_the_one_before_has_updated(said) -> None:
    right = "        j = PARENT[j]\n        r = r + S[j]\n"
    slip = (right, "        r = r + S[j]\n        j = PARENT[j]\n")
    told = said(UP, "planar3r", "jacobian", slip)
    assert "what the line uses is updated too early, or too late" in told
    assert "j - 1" not in told


def test_a_factor_of_a_product_is_further_on(said) -> None:
    rest = "rotz(th) @ trans(0, 0, d) @ trans(a, 0, 0)"
    told = said(BASED, "ur5", "fk", (f"{rest} @ rotx(al)", f"rotx(al) @ {rest}"))
    assert "line 23, the order is exchanged" in told
    assert "should be `T = T @ rotz(th) @ trans(0, 0, d) @ " in told


def test_the_base_is_told_and_no_signs_of_a_whole_table(said) -> None:
    slips = (("np.diag([-1.0, -1.0, 1.0, 1.0])", "np.eye(4)"), ("0.0823", "0.823"))
    told = said(BASED, "ur5", "fk", *slips)
    assert "BASE, a number is wrong: `diag(1, 1, 1, 1)` should be `diag(-1, -1, 1, 1)`" in told
    assert "`(0.0, 0.823, 0.0)` should be `(0.0, 0.0823, 0.0)`" in told


def test_what_an_object_keeps_is_not_the_place_of_a_factor(said) -> None:
    told = said(KEPT, "planar3r", "kinetic_energy", ("0.5*link.I*w", "link.I*w"))
    assert "line 20, a factor is wrong" in told
    assert "self.I = " not in told


def test_the_number_of_a_diagonal_is_rather_left_out_than_of_the_other_sign(said) -> None:
    told = said(SCARA, "scara", "coriolis_matrix", ("np.ones((4, 4)))", "np.ones((4, 4)), -1)"))
    assert "should be `chain = np.tril(np.ones((4, 4)), 0)`" in told
    assert "np.ones((4, 4)), 1)" not in told


def test_a_number_that_a_wrong_frame_hides_is_told_beside_it(said) -> None:
    """With the origins of the next frames a centre's second coordinate does nothing."""
    slips = (("T[:4, :3, 3]\n", "T[1:, :3, 3]\n"), ("-0.13, 0.005", "-0.13, -0.005"))
    told = said(SCARA, "scara", "coriolis_matrix", *slips)
    assert "should be `z, o = (T[:4, :3, 2], T[:-1, :3, 3])`" in told
    assert "c[1][1], the sign is wrong: -0.005 should be 0.005" in told


def test_twice_a_product_stands_for_it_and_its_transpose(said) -> None:
    slip = ("(D.T @ J + J.T @ D)", "(2*D.T @ J)")
    told = said(CHRISTOFFEL, "planar3r", "coriolis_matrix", slip)
    assert "(D.T @ J + (D.T @ J).T)" in told
    assert "C.T" not in told


def test_of_a_long_table_its_wrong_rows_are_shown(said) -> None:
    told = said(BASED, "ur5", "fk", ("0.0823", "0.823"), ("0.0, 0.10915", "0.0, 0.1915"))
    assert "`(0.0, 0.1915, np.pi/2)` should be `(0.0, 0.10915, np.pi/2)`" in told
    assert "`(0.0, 0.823, 0.0)` should be `(0.0, 0.0823, 0.0)`" in told


BY_NAMES = """
import numpy as np
A, ALPHA, D = (0.0, 0.3, 0.2), (0.3, -0.7, 0.4), (0.2, 0.1, 0.15)

def turn(angle, k):
    i, j = [n for n in range(3) if n != k]
    T = np.eye(4)
    T[i, i] = T[j, j] = np.cos(angle)
    T[j, i] = np.sin(angle) * (-1) ** k
    T[i, j] = -T[j, i]
    return T

def move(length, k):
    T = np.eye(4)
    T[k, 3] = length
    return T

def f(q):
    T = np.eye(4)
    for i in range(3):
        steps = {"Rx": turn(ALPHA[i], 0), "Tx": move(A[i], 0)}
        steps |= {"Rz": turn(q[i], 2), "Tz": move(D[i], 2)}
        for name in "Rz Tz Tx Rx".split():
            T = T @ steps[name]
    return T
"""


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_of_what_no_line_does_it_is_said_that_something_may_amount_to_it(
    convention, tmp_path
) -> None:
    """The order stands in a word, in which nothing is edited."""
    rows = zip((0.0, 0.3, 0.2), (0.3, -0.7, 0.4), (0.2, 0.1, 0.15), strict=True)
    links = [kl.DHLink(a=a, alpha=alpha, d=d) for a, alpha, d in rows]
    path = tmp_path / "hand.py"
    path.write_text(BY_NAMES)
    hand = written(BY_NAMES, path)
    found = kl.diagnose(kl.DHTable("own", convention, links), "fk", hand)
    assert found.agrees == (convention == "standard")
    if not found.agrees:
        assert found.causes[0].sentence.startswith(
            "the formula reads the modified table as standard"
        )
        assert "or does what amounts to that: no line was found" in found.causes[0].sentence


PLANAR_RECURSION = """
import numpy as np
L, M, G = [0.5, 0.4], [2.0, 1.5], 9.81
P = [np.zeros(3), np.array([L[0], 0, 0]), np.array([L[1], 0, 0])]
PC = [np.array([L[0], 0, 0]), np.array([L[1], 0, 0])]

def rot(t):
    c, s = np.cos(t), np.sin(t)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])

def f(q, v, a):
    R = [rot(q[0]), rot(q[1]), np.eye(3)]
    z = np.array([0, 0, 1.0])
    w, wd = np.zeros(3), np.zeros(3)
    vd = np.array([0, G, 0])
    F = []
    for i in range(2):
        Rt = R[i].T
        vd = Rt @ (np.cross(wd, P[i]) + np.cross(w, np.cross(w, P[i])) + vd)
        w, wd = Rt @ w + v[i]*z, Rt @ wd + a[i]*z
        at = np.cross(wd, PC[i]) + np.cross(w, np.cross(w, PC[i])) + vd
        F.append(M[i]*at)
    fi, ni = np.zeros(3), np.zeros(3)
    tau = np.zeros(2)
    for i in (1, 0):
        ahead = R[i + 1] @ fi
        ni = R[i + 1] @ ni + np.cross(PC[i], F[i]) + np.cross(P[i + 1], ahead)
        fi = ahead + F[i]
        tau[i] = ni[2]
    return tau
"""


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        ("[0, G, 0]", "[0, -G, 0]", "should be `vd = np.array([0, G, 0])`"),
        ("ahead = R[i + 1] @ fi", "ahead = fi", "R[i + 1] @"),
    ],
)
def test_a_rotation_gets_no_sign_and_a_list_of_vectors_no_rotation(right, wrong, told, tmp_path):
    """Of the lines that come to the same the one is told in which nobody would mean another."""
    path = tmp_path / "hand.py"
    assert kl.diagnose("planar2r", "inverse_dynamics", written(PLANAR_RECURSION, path)).agrees
    slipped = PLANAR_RECURSION.replace(right, wrong)
    found = kl.diagnose("planar2r", "inverse_dynamics", written(slipped, tmp_path / "slip.py"))
    sentence = found.causes[0].sentence
    assert told in sentence and "-rot(" not in sentence and "(P @" not in sentence, str(found)


HALVES = """
import numpy as np
from math import cos
m1, m2, l1, l2 = 2.0, 1.5, 0.5, 0.4
lc1, lc2 = l1/2, l2/2
J1, J2 = m1*l1**2/12, m2*l2**2/12

def f(q):
    b = m2*(lc2**2 + l1*lc2*cos(q[1])) + J2
    I = J1 + J2
    a = I + m1*lc1**2 + m2*(l1**2 + lc2**2 + 2*l1*lc2*cos(q[1]))
    return np.array([[a, b], [b, J2 + m2*lc2**2]])
"""


def _told_of_halves(right, wrong, path):
    path.write_text(HALVES.replace(right, wrong))
    return kl.diagnose("planar2r_rods", "mass_matrix", written(path.read_text(), path))


def test_of_two_names_that_come_to_the_same_the_one_of_the_mass_beside_it_is_told(tmp_path):
    """With centres in the middle l1*lc2 is lc1*l2, but lc1 is the centre of m1, and never of m2."""
    assert _told_of_halves("", "", tmp_path / "right.py").agrees
    found = _told_of_halves("2*l1*lc2", "2*l1*l2", tmp_path / "slip.py").causes[0].sentence
    assert "2*l1*lc2*cos(q[1])" in found.split("should be")[1] and " or " not in found


@pytest.mark.parametrize(
    ("right", "wrong", "name"),
    [("+ l1*lc2*cos", "+ l1*l1*cos", "lc2"), ("I = J1 + J2", "I = J1 + J1", "J2")],
)
def test_a_product_or_a_sum_in_another_order_is_told_once(right, wrong, name, tmp_path):
    found = _told_of_halves(right, wrong, tmp_path / "slip.py").causes[0].sentence
    assert name in found.split("should be")[1] and " or " not in found


DERIVATIVES = """
import numpy as np
a1, lc2, m2 = 0.5, 0.2, 1.5

def f(q, v):
    h = -m2*a1*lc2*np.sin(q[1])
    D = np.zeros((2, 2, 2))
    D[0, 0, 1] = 2*h
    D[0, 1, 1] = D[1, 0, 1] = h
    C = np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            for k in range(2):
                C[i, j] += 0.5*(D[i, j, k] + D[i, k, j] - D[j, k, i])*v[k]
    return C
"""


def test_of_indices_only_one_other_is_told():
    """Which of two indices is another is not asked: many come to the same on so small an arm."""
    assert kl.diagnose("planar2r_rods", "coriolis_matrix", written(DERIVATIVES)).agrees
    wrong = DERIVATIVES.replace("D[i, j, k] +", "D[j, j, k] +")
    told = kl.diagnose("planar2r_rods", "coriolis_matrix", written(wrong)).causes[0].sentence
    assert "D[i, j, k] +" in told.split("should be")[1] and "` or `" not in told
