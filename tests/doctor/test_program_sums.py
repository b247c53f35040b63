"""What goes wrong in sums of products: their subscripts, halves, indices; terms and divisors lost.

Every program is right before the slip, which its verdict tells first.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import asked, with_slips, written

import kinlab as kl

SUBSCRIPTS = """
import numpy as np

L, m = np.array([0.5, 0.4]), np.array([2.0, 1.5])
I = m*L**2/12
moves = np.tril(np.ones((2, 2)))

def f(q):
    angle = np.cumsum(q)
    along = L[:, None]*np.stack([np.cos(angle), np.sin(angle)], axis=1)
    starts = np.cumsum(along, axis=0) - along
    lever = (starts + along/2)[:, None, :] - starts[None]
    J = np.stack([-lever[..., 1], lever[..., 0]], axis=-1)*moves[:, :, None]
    return np.einsum('i,ija,ika->jk', m, J, J) + np.einsum('i,ij,ik->jk', I, moves, moves)
"""
SPATIAL = """
import numpy as np

m = [3.0, 2.0, 1.2]
com = np.array([[0.2, 0.02, -0.01], [0.15, -0.01, 0.03], [0.12, 0.03, 0.01]])
inertia = [np.diag([0.02, 0.08, 0.07]), np.diag([0.01, 0.04, 0.045]),
           np.array([[0.004, 0.001, 0], [0.001, 0.012, 0.0005], [0, 0.0005, 0.014]])]
p = [np.zeros(3), np.array([0.45, 0, 0]), np.array([0.35, 0, 0])]
tilt = [0, 0, np.pi/2]
Z = np.zeros((3, 3))

def skew(u):
    return np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])

def crm(V):
    return np.block([[skew(V[:3]), Z], [skew(V[3:]), skew(V[:3])]])

def motion(i, t):
    ca, sa = np.cos(tilt[i]), np.sin(tilt[i])
    R = np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t)*ca, np.cos(t)*ca, -sa],
                  [np.sin(t)*sa, np.cos(t)*sa, ca]])
    return np.block([[R.T, Z], [-R.T @ skew(p[i]), R.T]])

def body(i):
    C = skew(com[i])
    return np.block([[inertia[i] - m[i]*C @ C, m[i]*C], [-m[i]*C, m[i]*np.eye(3)]])

S = np.repeat([[0.0], [0], [1], [0], [0], [0]], 3, axis=1)
"""
RECURSION = (
    SPATIAL
    + """
def f(q, qd, qdd):
    V, A, X = np.zeros((6, 4)), np.zeros((6, 4)), []
    A[:, 0] = np.r_[[0, 0, 0], [0, 0, 9.81]]
    for i in range(3):
        X.append(motion(i, q[i]))
        V[:, i + 1] = X[i] @ V[:, i] + S[:, i]*qd[i]
        A[:, i + 1] = X[i] @ A[:, i] + S[:, i]*qdd[i] + crm(V[:, i + 1]) @ S[:, i]*qd[i]
    F, tau = np.zeros(6), np.zeros(3)
    for i in (2, 1, 0):
        F = F + body(i) @ A[:, i + 1] - crm(V[:, i + 1]).T @ body(i) @ V[:, i + 1]
        tau[i] = S[:, i] @ F
        F = X[i].T @ F
    return tau
"""
)
ARTICULATED = (
    SPATIAL
    + """
def f(q, qd, tau):
    V, X, c, IA, pA = [], [], [], [], []
    for i in range(3):
        X.append(motion(i, q[i]))
        joint = S[:, i]*qd[i]
        V.append(joint if i == 0 else X[i] @ V[i - 1] + joint)
        c.append(crm(V[i]) @ joint)
        IA.append(body(i))
        pA.append(-crm(V[i]).T @ IA[i] @ V[i])
    U, D, u = [None]*3, np.zeros(3), np.zeros(3)
    for i in (2, 1, 0):
        U[i] = IA[i] @ S[:, i]
        D[i] = S[:, i] @ U[i]
        u[i] = tau[i] - S[:, i] @ pA[i]
        if i > 0:
            Ia = IA[i] - np.outer(U[i], U[i])/D[i]
            pa = pA[i] + Ia @ c[i] + U[i]*(u[i]/D[i])
            IA[i - 1] = IA[i - 1] + X[i].T @ Ia @ X[i]
            pA[i - 1] = pA[i - 1] + X[i].T @ pa
    qdd, A = np.zeros(3), np.array([0, 0, 0, 0, 0, 9.81])
    for i in range(3):
        A = X[i] @ A + c[i]
        qdd[i] = (u[i] - U[i] @ A)/D[i]
        A = A + S[:, i]*qdd[i]
    return qdd
"""
)
UNROLLED = """
import numpy as np

l1, l2, m1, m2 = 0.5, 0.4, 2.0, 1.5
Z, I1, I2 = np.array([0, 0, 1.0]), 2.0*0.5**2/12, 1.5*0.4**2/12

def f(q, v, a):
    s1, c1, s12, c12 = np.sin(q[0]), np.cos(q[0]), np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    r1, r2 = l1*np.array([c1, s1, 0]), l2*np.array([c12, s12, 0])
    w1, dw1 = v[0]*Z, a[0]*Z
    w2 = w1 + v[1]*Z
    dw2 = dw1 + a[1]*Z
    up = np.array([0, 9.81, 0])
    e = up + np.cross(dw1, r1) + np.cross(w1, np.cross(w1, r1))
    F1 = m1*(up + np.cross(dw1, r1/2) + np.cross(w1, np.cross(w1, r1/2)))
    F2 = m2*(e + np.cross(dw2, r2/2) + np.cross(w2, np.cross(w2, r2/2)))
    n2 = I2*dw2 + np.cross(r2/2, F2)
    n1 = I1*dw1 + np.cross(r1/2, F1) + np.cross(r1, F2) + n2
    return np.array([n1 @ Z, n2 @ Z])
"""
JACOBIANS = (
    SPATIAL
    + """
def f(q):
    M, R, o = np.zeros((3, 3)), np.eye(3), np.zeros(3)
    axes, origins = [], []
    for i in range(3):
        o = o + R @ p[i]
        R = R @ motion(i, q[i])[:3, :3].T
        axes.append(R[:, 2])
        origins.append(o)
        Jv, Jw = np.zeros((3, 3)), np.zeros((3, 3))
        for j in range(i + 1):
            Jv[:, j] = np.cross(axes[j], o + R @ com[i] - origins[j])
            Jw[:, j] = axes[j]
        Iw = R @ inertia[i] @ R.T
        M += m[i]*Jv.T @ Jv + Jw.T @ Iw @ Jw
    return M
"""
)
PROGRAMS = {
    "articulated": ("spatial3r", "forward_dynamics", ARTICULATED),
    "unrolled": ("planar2r_rods", "inverse_dynamics", UNROLLED),
    "jacobians": ("spatial3r", "mass_matrix", JACOBIANS),
    "subscripts": ("planar2r_rods", "mass_matrix", SUBSCRIPTS),
    "recursion": ("spatial3r", "inverse_dynamics", RECURSION),
}
SLIPS = [
    ("articulated", " + Ia @ c[i]", "", "a matrix times a vector"),
    ("articulated", "np.outer(U[i], U[i])/D[i]", "np.outer(U[i], U[i])", "a divisor"),
    ("unrolled", " + a[1]*Z", "", "a number that is given, times a vector"),
    ("subscripts", "'i,ija,ika->jk'", "'j,ija,ika->jk'", "a letter of another axis"),
    ("subscripts", "'i,ij,ik->jk'", "'i,ji,ik->jk'", "two letters of one array"),
]
SEVERAL = [
    ("articulated", [("crm(V[i]) @ joint", "crm(joint) @ V[i]"), ("np.outer(U[i], U[i])/D[i]", "np.outer(U[i], U[i])")], "a product's order and a divisor"),
    ("jacobians", [("+ Jw.T @ Iw @ Jw", ""), ("R @ com[i]", "R @ com[i]/2")], "a product of what is used nowhere"),
    ("jacobians", [("m[i]*Jv.T @ Jv + ", ""), ("R @ inertia[i] @ R.T", "R.T @ inertia[i] @ R")], "a square of what is used nowhere"),
    ("recursion", [("np.r_[[0, 0, 0], [0, 0, 9.81]]", "np.r_[[0, 0, 9.81], [0, 0, 0]]"), ("F = X[i].T @ F", "F = X[i] @ F"), ("[0.35, 0, 0]", "[0, 0.35, 0]")], "the halves of a twist"),
]  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(("name", "old", "new"), [x[:3] for x in SLIPS], ids=[x[3] for x in SLIPS])
def test_a_slip_in_a_sum_of_products_is_told(name, old, new) -> None:
    robot, quantity, text = PROGRAMS[name]
    found, good = asked(with_slips(text, [(old, new)]), robot, quantity)
    assert good, str(found)


@pytest.mark.many
@pytest.mark.parametrize(("name", "slips"), [x[:2] for x in SEVERAL], ids=[x[2] for x in SEVERAL])
def test_it_is_told_beside_other_slips(name, slips) -> None:
    robot, quantity, text = PROGRAMS[name]
    found, _good = asked(with_slips(text, slips), robot, quantity)
    assert found.causes[0].error_after < 1e-9
    told = found.causes[0].sentence
    assert all(right.strip(" +") in told or right[1:-1] in told for right, _wrong in slips), told


POLAR = """
import numpy as np

m1, m2, lc1, I1, I2, g = 4.0, 1.8, 0.3, 0.13, 0.035, 9.81

def f(q, v, tau):
    r = 0.2 + q[1]
    turn, slide = v
    inertia = m1*lc1**2 + I1 + m2*r**2 + I2
    h1 = 2*m2*r*turn*slide
    h2 = -m2*r*turn**2
    g1 = (m1*lc1 + m2*r)*g*np.cos(q[0])
    g2 = m2*g*np.sin(q[0])
    return np.array([(tau[0] - h1 - g1)/inertia, (tau[1] - h2 - g2)/m2])
"""


def test_a_lost_square_is_told_where_the_rate_stands() -> None:
    q = np.pi / 2
    rod = {"mass": 4.0, "com": [0, 0.3, 0], "inertia": np.diag([0.12, 0.02, 0.13])}
    slide = {"mass": 1.8, "com": [0, 0, -0.15], "inertia": np.diag([0.03, 0.035, 0.004])}
    links = [
        kl.DHLink(theta=-q, **rod),
        kl.DHLink("prismatic", alpha=-q, d=0.35, lower=0.0, upper=0.6, **slide),
    ]
    arm = kl.DHTable("polar", "modified", links, gravity=[0, -9.81, 0])
    assert kl.diagnose(arm, "forward_dynamics", written(POLAR)).agrees
    slipped = written(POLAR.replace("turn**2", "turn"))
    found = kl.diagnose(arm, "forward_dynamics", slipped)
    assert "`h2 = -m2*r*turn` should be" in found.causes[0].sentence.replace(" * ", "*")
