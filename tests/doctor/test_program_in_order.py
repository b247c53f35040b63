"""Several slips of one recursion, each told: the one shows where the next is.

The programs are right before the slips; what is said makes them right again.
"""

from __future__ import annotations

import numpy as np
import pytest
from hand_programs import PROGRAMS, asked, searched, with_slips, written

import kinlab as kl
from kinlab.doctor.program.several.witnesses import Witnesses

ROWS = [("R", 0.0, np.pi / 2, 0.31), ("P", 0.12, -np.pi / 2, 0.22), ("R", 0.29, 0.4, 0.07)]
MASSES, CENTRES = (4.1, 2.7, 1.3), ((0.02, -0.09, 0.03), (-0.17, 0.02, 0.05), (-0.12, 0.01, -0.02))
TENSORS = ((0.05, 0.03, 0.04), (0.01, 0.06, 0.07), (0.004, 0.02, 0.022))
KINDS = {"R": "revolute", "P": "prismatic"}
ARM = kl.DHTable(
    "arm",
    "modified",
    [
        kl.DHLink(joint=KINDS[k], a=a, alpha=al, d=d, mass=m, com=c, inertia=np.diag(i))
        for (k, a, al, d), m, c, i in zip(ROWS, MASSES, CENTRES, TENSORS, strict=True)
    ],
)
NUMBERS = f"""
import numpy as np
from math import cos, sin

ROWS = {ROWS}
m = {MASSES}
c = np.array({CENTRES})
I = [np.diag(x) for x in {TENSORS}]

def link(i, x):
    kind, a, al, d = ROWS[i]
    t, d = (x, d) if kind == "R" else (0.0, d + x)
    ct, st, ca, sa = cos(t), sin(t), cos(al), sin(al)
    R = np.array([[ct, -st, 0], [st*ca, ct*ca, -sa], [st*sa, ct*sa, ca]])
    return R, np.array([a, -sa*d, ca*d])
"""
LINKS = (
    NUMBERS
    + """
def f(q, qd, qdd):
    z = np.array([0.0, 0.0, 1.0])
    turns, arms = zip(*(link(i, q[i]) for i in range(3)))
    w, dw, dv = np.zeros(3), np.zeros(3), np.array([0, 0, 9.81])
    F, N = [], []
    for i in range(3):
        Rt, p = turns[i].T, arms[i]
        dv = Rt @ (dv + np.cross(dw, p) + np.cross(w, np.cross(w, p)))
        w_in = Rt @ w
        if ROWS[i][0] == "R":
            dw = Rt @ dw + np.cross(w_in, qd[i]*z) + qdd[i]*z
            w = w_in + qd[i]*z
        else:
            dw, w = Rt @ dw, w_in
            dv = dv + 2*np.cross(w, qd[i]*z) + qdd[i]*z
        dvc = dv + np.cross(dw, c[i]) + np.cross(w, np.cross(w, c[i]))
        F.append(m[i]*dvc)
        N.append(I[i] @ dw + np.cross(w, I[i] @ w))
    force, moment, tau = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in (2, 1, 0):
        if i < 2:
            moment = turns[i + 1] @ moment + np.cross(arms[i + 1], turns[i + 1] @ force)
            force = turns[i + 1] @ force
        moment = moment + N[i] + np.cross(c[i], F[i])
        force = force + F[i]
        tau[i] = moment[2] if ROWS[i][0] == "R" else force[2]
    return tau
"""
)
TWISTS = (
    NUMBERS
    + """
def hat(r):
    return np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])

def carry(R, p):
    E = R.T
    return np.block([[E, np.zeros((3, 3))], [-E @ hat(p), E]])

def crm(v):
    return np.block([[hat(v[:3]), np.zeros((3, 3))], [hat(v[3:]), hat(v[:3])]])

def crf(v):
    return -crm(v).T

def inertia(m, c, I):
    C = hat(c)
    return np.block([[I + m*C @ C.T, m*C], [m*C.T, m*np.eye(3)]])

def f(q, qd, qdd):
    v, a = np.zeros(6), np.array([0, 0, 0, 0, 0, 9.81])
    X, S, wrench = [], [], []
    for i in range(3):
        Xi = carry(*link(i, q[i]))
        s = np.array([0, 0, 1, 0, 0, 0]) if ROWS[i][0] == "R" else np.array([0, 0, 0, 0, 0, 1])
        v = Xi @ v + s*qd[i]
        a = Xi @ a + s*qdd[i] + crm(v) @ s*qd[i]
        Ii = inertia(m[i], c[i], I[i])
        wrench.append(Ii @ a + crf(v) @ Ii @ v)
        X.append(Xi)
        S.append(s)
    tau = np.zeros(3)
    for i in (2, 1, 0):
        tau[i] = S[i] @ wrench[i]
        if i > 0:
            wrench[i - 1] = wrench[i - 1] + X[i].T @ wrench[i]
    return tau
"""
)


@pytest.mark.parametrize("text", [LINKS, TWISTS], ids=["vectors", "twists"])
def test_the_programs_are_right(text) -> None:
    assert kl.diagnose(ARM, "inverse_dynamics", written(text)).agrees


@pytest.mark.many
@pytest.mark.parametrize(
    ("text", "slips"),
    [
        pytest.param(LINKS, [
            (" + np.cross(w, np.cross(w, p))", ""),
            ("I[i] @ dw + np.cross(w, I[i] @ w)", "I[i] @ dw"),
            ("np.cross(arms[i + 1], turns[i + 1] @ force)", "np.cross(arms[i + 1], force)"),
        ], id="three of Newton and Euler"),
        pytest.param(LINKS, [
            ("Rt @ dw + np.cross(w_in, qd[i]*z)", "Rt @ dw + np.cross(qd[i]*z, w_in)"),
            ("dv + 2*np.cross(w, qd[i]*z)", "dv + np.cross(w, qd[i]*z)"),
            ("N[i] + np.cross(c[i], F[i])", "N[i] + np.cross(F[i], c[i])"),
        ], id="three products of vectors"),
        pytest.param(TWISTS, [
            ("[-E @ hat(p), E]", "[-hat(p) @ E, E]"),
            (" + crm(v) @ s*qd[i]", ""),
        ], id="a transform of twists and their product"),
        pytest.param(TWISTS, [
            ("s*qdd[i] + crm(v)", "s*qdd[i] - crm(v)"),
            ("wrench[i - 1] + X[i].T @ wrench[i]", "X[i].T @ wrench[i]"),
        ], id="a sign, and a sum that forgets"),
        pytest.param(TWISTS, [
            ("[-E @ hat(p), E]", "[-hat(p) @ E, E]"),
            ("m*C], [m*C.T", "m*C], [m*C"),
            ("wrench[i - 1] + X[i].T @ wrench[i]", "wrench[i - 1] + X[i] @ wrench[i]"),
        ], id="three of twists"),
    ],
)  # fmt: skip
def test_all_slips_are_told(text, slips) -> None:
    found, good = asked(with_slips(text, slips), ARM, "inverse_dynamics")
    assert good, str(found)
    assert len(found.causes[0].kinds) == len(slips)


@pytest.mark.parametrize(
    ("right", "wrong", "where"),
    [
        ("return -crm(v).T", "return crm(v).T", "(in crf), the sign is wrong"),
        ("I + m*C @ C.T", "I", "(in inertia), a term is missing"),
    ],
)
def test_a_slip_in_a_function_of_the_textbooks_is_told_there(right, wrong, where) -> None:
    found, good = asked(with_slips(TWISTS, [(right, wrong)]), ARM, "inverse_dynamics")
    assert good, str(found)
    assert where in found.causes[0].sentence


def test_a_rotation_too_many_is_not_undone_by_another() -> None:
    slips = [("np.cross(arms[i + 1], turns[i + 1] @ force)",
              "np.cross(arms[i + 1], turns[i + 1].T @ (turns[i + 1] @ force))")]  # fmt: skip
    found, good = asked(with_slips(LINKS, slips), ARM, "inverse_dynamics")
    assert good, str(found)
    assert ".T @ (" not in str(found).split("should be")[1]


MASSES_OF = (
    NUMBERS
    + """
def f(q):
    T, points = np.eye(3), [np.zeros(3)]
    turns = []
    for i in range(3):
        R, p = link(i, q[i])
        points.append(points[-1] + T @ p)
        T = T @ R
        turns.append(T)
    M = np.zeros((3, 3))
    for k in range(3):
        centre = points[k + 1] + turns[k] @ c[k]
        J = np.zeros((6, 3))
        for j in range(k + 1):
            axis = turns[j][:, 2]
            if ROWS[j][0] == "R":
                J[:3, j], J[3:, j] = np.cross(axis, centre - points[j + 1]), axis
            else:
                J[:3, j] = axis
        tensor = turns[k] @ I[k] @ turns[k].T
        for a in range(3):
            for b in range(a, 3):
                M[a, b] += m[k]*J[:3, a] @ J[:3, b] + J[3:, a] @ tensor @ J[3:, b]
                M[b, a] = M[a, b]
    return M
"""
)


def test_the_mirror_line_is_missing() -> None:
    assert kl.diagnose(ARM, "mass_matrix", written(MASSES_OF)).agrees
    slips = [("                M[b, a] = M[a, b]\n", ""), ("turns[k] @ c[k]", "c[k]")]
    found, good = asked(with_slips(MASSES_OF, slips), ARM, "mass_matrix")
    assert good, str(found)
    assert "a line is missing" in str(found)


def test_an_edit_deep_in_a_statement_is_watched_as_any_other() -> None:
    """Edits are compiled together: each must tell of its own statement what it does alone."""
    ne = PROGRAMS["newton-euler"]
    slips = [("np.cross(r, fi)", "np.cross(fi, r)"), ("9.81, 0])", "-9.81, 0])")]
    search = searched(ne.robot, ne.quantity, with_slips(ne.text, slips), beside=0.0)
    search.singles()
    every = (edit for edit, _values in search.tried if id(edit.node) in search.suspected)
    some = [edit for edit in every if edit.kind in ("extra term", "operator")]
    together = Witnesses(search).steps([(edit,) for edit in some], 10**9)
    alone = [step for edit in some for step in Witnesses(search).steps([(edit,)], 10**9)]
    assert alone
    assert {step.edits for step in together} == {step.edits for step in alone}
