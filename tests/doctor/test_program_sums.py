"""What goes wrong in sums of products: their subscripts, halves, indices; terms and divisors lost.

Every program is right before the slip, which its verdict tells first.
"""

from __future__ import annotations

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
PROGRAMS = {
    "subscripts": ("planar2r_rods", "mass_matrix", SUBSCRIPTS),
    "recursion": ("spatial3r", "inverse_dynamics", RECURSION),
}
SLIPS = [
    ("subscripts", "'i,ija,ika->jk'", "'j,ija,ika->jk'", "a letter of another axis"),
    ("subscripts", "'i,ij,ik->jk'", "'i,ji,ik->jk'", "two letters of one array"),
]
SEVERAL = [
    ("recursion", [("np.r_[[0, 0, 0], [0, 0, 9.81]]", "np.r_[[0, 0, 9.81], [0, 0, 0]]"), ("F = X[i].T @ F", "F = X[i] @ F"), ("[0.35, 0, 0]", "[0, 0.35, 0]")], "the halves of a twist"),
]  # fmt: skip


@pytest.mark.parametrize("name", PROGRAMS)
def test_the_programs_are_right(name) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert kl.diagnose(robot, quantity, written(text)).agrees


@pytest.mark.parametrize(("name", "old", "new"), [x[:3] for x in SLIPS], ids=[x[3] for x in SLIPS])
def test_a_slip_in_a_sum_of_products_is_told(name, old, new) -> None:
    robot, quantity, text = PROGRAMS[name]
    assert text.count(old) == 1
    found, good = asked(text.replace(old, new), robot, quantity)
    assert good, str(found)


@pytest.mark.parametrize(("name", "slips"), [x[:2] for x in SEVERAL], ids=[x[2] for x in SEVERAL])
def test_it_is_told_beside_other_slips(name, slips) -> None:
    robot, quantity, text = PROGRAMS[name]
    found, _good = asked(with_slips(text, slips), robot, quantity)
    for right, _wrong in slips:
        assert right in found.causes[0].sentence or right[1:-1] in found.causes[0].sentence
