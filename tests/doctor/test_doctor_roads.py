"""Other roads to the same quantities, with one step otherwise. The code here is the oracle."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl

pytestmark = pytest.mark.usefixtures("without_lines")
ARM = kl.load("spatial3r")
LINKS = ARM.table.links

_FRAMES = """
def link(i, q):
    row = LINKS[i]
    ct, st = np.cos(row.theta + q[i]), np.sin(row.theta + q[i])
    ca, sa = np.cos(row.alpha), np.sin(row.alpha)
    return np.array([[ct, -st, 0, row.a], [st*ca, ct*ca, -sa, -sa*row.d],
                     [st*sa, ct*sa, ca, ca*row.d], [0, 0, 0, 1]])

def frames(q):
    T = [np.eye(4)]
    for i in range(n):
        T.append(T[i] @ link(i, q))
    return T

def skew(u):
    return np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
"""

COMPOSITE = """
def f(q):
    X, Ic = [], []
    for i in range(n):
        A = link(i, q)
        R, P = A[:3, :3], A[:3, 3]
        X.append(np.block([[R.T, -R.T @ skew(P)], [np.zeros((3, 3)), R.T]]))
        s = skew(com[i])
        Ic.append(np.block([[m[i]*np.eye(3), -m[i]*s], [m[i]*s, I[i] - m[i]*s @ s]]))
    for i in range(n - 1, 0, -1):
        Ic[i-1] = Ic[i-1] + X[i].T @ Ic[i] @ X[i]
    M = np.zeros((n, n))
    for i in range(n):
        F = Ic[i][:, 5]
        M[i, i] = F[5]
        for j in range(i, 0, -1):
            F = X[j].T @ F
            M[i, j-1] = M[j-1, i] = F[5]
    return M
"""

ENERGY = """
def f(q, qd):
    w, v, E = np.zeros(3), np.zeros(3), 0.0
    for i in range(n):
        A = link(i, q)
        R, P = A[:3, :3], A[:3, 3]
        v = R.T @ (v + np.cross(w, P))
        w = R.T @ w + np.array([0, 0, qd[i]])
        vc = v + np.cross(w, com[i])
        E += 0.5*m[i]*vc @ vc + 0.5*w @ I[i] @ w
    return E
"""

RATES = """
def f(q, qd):
    T = frames(q)
    p = (T[n] @ tool)[:3, 3]
    w, u, ws, us = np.zeros(3), np.zeros(3), [], []
    for i in range(n):
        if i > 0:
            u = u + np.cross(w, T[i+1][:3, 3] - T[i][:3, 3])
        w = w + qd[i]*T[i+1][:3, 2]
        ws.append(w); us.append(u)
    dp = u + np.cross(w, p - T[n][:3, 3])
    J = np.zeros((6, n))
    for i in range(n):
        z, o = T[i+1][:3, 2], T[i+1][:3, 3]
        dz = np.cross(ws[i], z)
        J[:, i] = np.r_[np.cross(dz, p - o) + np.cross(z, dp - us[i]), dz]
    return J
"""

INWARD = """
def f(q):
    U, J = tool, np.zeros((6, n))
    for i in range(n - 1, -1, -1):
        R, p = U[:3, :3], U[:3, 3]
        J[:3, i] = R.T @ np.cross([0, 0, 1], p)
        J[3:, i] = R.T @ np.array([0, 0, 1.0])
        U = link(i, q) @ U
    return J
"""

EXPONENTIALS = """
def f(q):
    rest, T = frames(np.zeros(n)), np.eye(4)
    for i in range(n):
        K, o = skew(rest[i+1][:3, 2]), rest[i+1][:3, 3]
        R = np.eye(3) + np.sin(q[i])*K + (1 - np.cos(q[i]))*K @ K
        E = np.eye(4)
        E[:3, :3], E[:3, 3] = R, (np.eye(3) - R) @ o
        T = T @ E
    return T @ rest[n] @ tool
"""

POTENTIAL = """
def f(q):
    T = frames(q)
    return sum(m[i]*9.81*(T[i+1] @ np.r_[com[i], 1])[2] for i in range(n))
"""

STATICS = """
def f(q, w):
    T = frames(q)
    p, J = (T[n] @ tool)[:3, 3], np.zeros((6, n))
    for i in range(n):
        z, o = T[i+1][:3, 2], T[i+1][:3, 3]
        J[:, i] = np.r_[np.cross(z, p - o), z]
    return J.T @ w
"""

CODE = {
    "mass_matrix": COMPOSITE,
    "kinetic_energy": ENERGY,
    "jacobian_dot": RATES,
    "jacobian_tool": INWARD,
    "fk": EXPONENTIALS,
    "potential_energy": POTENTIAL,
    "statics": STATICS,
}


LINKWISE = """
def parts(q):
    T = frames(q)
    return ([t[:3, 2] for t in T[1:]], [t[:3, 3] for t in T[1:]],
            [(T[i+1] @ np.r_[com[i], 1])[:3] for i in range(n)], [t[:3, :3] for t in T[1:]])

def body(k, q):
    z, o, p, R = parts(q)
    J = np.zeros((6, n))
    for j in range(k + 1):
        J[:, j] = np.r_[np.cross(z[j], p[k] - o[j]), z[j]]
    return J

def mass_matrix(q):
    R, M = parts(q)[3], np.zeros((n, n))
    for k in range(n):
        J = body(k, q)
        M += m[k]*J[:3].T @ J[:3] + J[3:].T @ R[k] @ I[k] @ R[k].T @ J[3:]
    return M

def momentum(q, qd):
    z, o, p, R = parts(q)
    out = np.zeros(n)
    for j in range(n):
        for k in range(j, n):
            v, w = np.split(body(k, q) @ qd, 2)
            out[j] += m[k]*np.cross(z[j], p[k] - o[j]) @ v + z[j] @ R[k] @ I[k] @ R[k].T @ w
    return out

def link_kinetic_energies(q, qd):
    R, out = parts(q)[3], np.zeros(n)
    for k in range(n):
        v, w = np.split(body(k, q) @ qd, 2)
        out[k] = 0.5*m[k]*v @ v + 0.5*w @ R[k] @ I[k] @ R[k].T @ w
    return out

def composite_mass(q):
    z, o, p, R = parts(q)
    S = [np.r_[np.cross(o[i], z[i]), z[i]] for i in range(n)]
    M, C = np.zeros((n, n)), np.zeros((6, 6))
    for k in range(n - 1, -1, -1):
        a = R[k] @ I[k] @ R[k].T + m[k]*(p[k] @ p[k]*np.eye(3) - np.outer(p[k], p[k]))
        C += np.block([[m[k]*np.eye(3), -m[k]*skew(p[k])], [m[k]*skew(p[k]), a]])
        for j in range(k + 1):
            M[j, k] = M[k, j] = S[j] @ C @ S[k]
    return M

def static_wrenches(q, w):
    T, out = frames(q), []
    for i in range(1, n + 1):
        R, r = T[i][:3, :3], (T[n] @ tool)[:3, 3] - T[i][:3, 3]
        out.append(np.r_[R.T @ w[:3], R.T @ (w[3:] + np.cross(r, w[:3]))])
    return np.array(out)

def angular_jacobian_last(q):
    J, R = np.zeros((3, n)), np.eye(3)
    for i in range(n - 1, -1, -1):
        J[:, i] = R.T @ [0, 0, 1]
        R = link(i, q)[:3, :3] @ R
    return J
"""
LINK_SLIPS = [
    ("mass_matrix", "mass_matrix", "p[k] - o[j]", "p[k] - o[0]", "adds up all links"),
    ("mass_matrix", "mass_matrix", "range(k + 1)", "range(n)", "every joint a column"),
    ("mass_matrix", "mass_matrix", "J[:3].T", "(J[:3]*[[1], [0], [1]]).T", "the y components"),
    ("mass_matrix", "composite_mass", "- np.outer", "+ np.outer", "parallel-axis term"),
    ("mass_matrix", "composite_mass", " - np.outer(p[k], p[k])", "", "parallel-axis term"),
    ("momentum", "momentum", "range(j, n)", "[j]", "carries nothing inward"),
    ("link_kinetic_energies", "link_kinetic_energies", "out[k] = 0", "out[k] = out[k-1] + 0",
     "each entry has those before"),
    ("static_wrenches", "static_wrenches", "R.T @", "1.0 *", "answers in base axes"),
    ("angular_jacobian_last", "angular_jacobian_last", "R.T @ [", "(link(i, q)[:3, :3] @ R).T @ [",
     "of the frame before"),
]  # fmt: skip


@pytest.mark.parametrize(("quantity", "name", "old", "new", "words"), LINK_SLIPS)
def test_a_slip_over_the_links_is_named(quantity, name, old, new, words) -> None:
    assert old in LINKWISE
    right, wrong = (
        function_of(quantity, f"{_FRAMES}{code}\nf = {name}")
        for code in (LINKWISE, LINKWISE.replace(old, new))
    )
    assert right.agrees
    assert not wrong.agrees
    assert any(words in cause.sentence for cause in wrong.causes), wrong
    assert wrong.causes[0].error_after <= 1e-9


def function(quantity, *changes):
    code = _FRAMES + CODE[quantity]
    for old, new in changes:
        assert old in code
        code = code.replace(old, new)
    return function_of(quantity, code)


def function_of(quantity, code):
    names = {"np": np, "n": 3, "LINKS": LINKS, "m": [row.mass for row in LINKS],
             "com": [np.array(row.com) for row in LINKS],
             "I": [np.array(row.inertia) for row in LINKS],
             "tool": np.asarray(ARM.table.tool)}  # fmt: skip
    exec(code, names)  # noqa: S102 - the text above
    return kl.diagnose(ARM, quantity, names["f"], samples=10)


@pytest.mark.parametrize("quantity", CODE)
def test_each_road_is_right(quantity) -> None:
    assert function(quantity).agrees


@pytest.mark.parametrize(
    ("quantity", "old", "new", "words"),
    [
        ("mass_matrix", "range(n - 1, 0, -1)", "range(n - 2, 0, -1)", "one link too late"),
        ("mass_matrix", "range(n - 1, 0, -1)", "range(n - 1, 1, -1)", "one link too early"),
        ("mass_matrix", "I[i] - m[i]*s @ s", "I[i] + m[i]*s @ s", "parallel-axis"),
        ("mass_matrix", "F = X[j].T @ F", "F = X[j] @ F", "not transposed"),
        ("kinetic_energy", "vc = v + np.cross(w, com[i])", "vc = v", "centre of mass"),
        ("kinetic_energy", "w = R.T @ w +", "w = w +", "does not rotate w"),
        ("jacobian_dot", " + np.cross(w, p - T[n][:3, 3])", "", "velocity of the tool's point"),
        ("jacobian_dot", "np.cross(z, dp - us[i])", "np.cross(z, dp)", "o_dot"),
        ("jacobian_tool", "-sa, -sa*row.d", "sa, -sa*row.d", "opposite sign in entry (2, 3)"),
        ("fk", "(1 - np.cos(q[i]))", "np.cos(q[i])", "cos(q) for 1 - cos(q)"),
        ("fk", "(np.eye(3) - R) @ o", "(R + np.eye(3)) @ o", "opposite sign"),
        ("statics", "[st*ca, ct*ca", "[st*ca, -ct*ca", "(2, 2)"),
        ("statics", "J.T @ w", "J.T @ np.r_[w[:3], 0, 0, 0]", "the wrench's moment"),
        ("statics", "z, o = T[i+1][:3, 2], T[i+1][:3, 3]", "z, o = T[i][:3, 2], T[i][:3, 3]",
         "axis z and the origin o of the frame before"),
        ("statics", "T[i+1][:3, 2]", "T[i+1][:3, 0]", "axis x for the joint's axis z"),
    ],
)  # fmt: skip
def test_a_step_of_another_road_is_named(quantity, old, new, words) -> None:
    found = function(quantity, (old, new))
    assert not found.agrees
    assert words in found.causes[0].sentence, found
    assert len(found.causes[0].kinds) == 1
    assert found.causes[0].error_after <= 1e-9


def _put(value):
    def change(M):
        M[3, 5] = M[5, 3] = value(M)

    return change


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (_put(lambda _M: 0.0), "entry (4, 6) and (6, 4) zero"),
        (_put(lambda M: M[2, 4]), "entry (3, 5) for entry (4, 6) and (6, 4)"),
    ],
)
def test_one_entry_of_a_large_matrix(change, words) -> None:
    arm = kl.load("puma560")

    def masses(q):
        M = np.array(kl.mass_matrix(arm, q))
        change(M)
        return M

    found = kl.diagnose(arm, "mass_matrix", masses, samples=10)
    assert words in found.causes[0].sentence
    assert len(found.causes) == 1


def test_rates_in_degrees_and_columns_exchanged() -> None:
    slow = kl.diagnose(ARM, "kinetic_energy",
                       lambda q, v: kl.kinetic_energy(ARM, q, np.deg2rad(v)), samples=10)  # fmt: skip
    assert "rates in degrees" in slow.causes[0].sentence
    other = kl.diagnose(ARM, "jacobian", lambda q: kl.jacobian(ARM, q)[:, [1, 0, 2]], samples=10)
    assert "columns 1 and 2 exchanged" in other.causes[0].sentence
