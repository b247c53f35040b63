"""Textbook code with one line written otherwise: the step is named. The code here is the oracle."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.derivations.roads import roads
from kinlab.doctor.examine import prepare

ARM = kl.load("spatial3r")
LINKS = ARM.table.links

NEWTON_EULER = """
def f(q, v, acc):
    z = np.array([0, 0, 1.0])
    w, dw, dv = np.zeros(3), np.zeros(3), np.array([0, 0, 9.81])
    R, P, F, N = [], [], [], []
    for i in range(n):
        A = link(i, q)
        R.append(A[:3, :3]); P.append(A[:3, 3])
        Rt = R[i].T
        dv = Rt @ (np.cross(dw, P[i]) + np.cross(w, np.cross(w, P[i])) + dv)
        dw = Rt @ dw + np.cross(Rt @ w, z * v[i]) + z * acc[i]
        w = Rt @ w + z * v[i]
        dvc = np.cross(dw, com[i]) + np.cross(w, np.cross(w, com[i])) + dv
        F.append(m[i] * dvc)
        N.append(I[i] @ dw + np.cross(w, I[i] @ w))
    fo, no, tau = np.zeros(3), np.zeros(3), np.zeros(n)
    R.append(np.eye(3)); P.append(np.zeros(3))
    for i in range(n - 1, -1, -1):
        fn = R[i + 1] @ fo
        no = N[i] + R[i + 1] @ no + np.cross(com[i], F[i]) + np.cross(P[i + 1], fn)
        fo = fn + F[i]
        tau[i] = no @ z
    return tau
"""

COLUMNS = """
def f(q):
    T = [np.eye(4)]
    for i in range(n):
        T.append(T[-1] @ link(i, q))
    p = (T[-1] @ np.asarray(ARM.table.tool))[:3, 3]
    J = np.zeros((6, n))
    for i in range(n):
        z, o = T[i + 1][:3, 2], T[i + 1][:3, 3]
        J[:3, i] = np.cross(z, p - o)
        J[3:, i] = z
    return J
"""

MASSES = """
def f(q):
    T = [np.eye(4)]
    for i in range(n):
        T.append(T[-1] @ link(i, q))
    M = np.zeros((n, n))
    for k in range(n):
        R, c = T[k + 1][:3, :3], T[k + 1][:3, 3] + T[k + 1][:3, :3] @ com[k]
        Jv, Jw = np.zeros((3, n)), np.zeros((3, n))
        for i in range(k + 1):
            z, o = T[i + 1][:3, 2], T[i + 1][:3, 3]
            Jv[:, i], Jw[:, i] = np.cross(z, c - o), z
        M += m[k] * Jv.T @ Jv + Jw.T @ R @ I[k] @ R.T @ Jw
    return M
"""

CODE = {"inverse_dynamics": NEWTON_EULER, "jacobian": COLUMNS, "mass_matrix": MASSES}


def link(i, q):
    row = LINKS[i]
    ct, st = np.cos(row.theta + q[i]), np.sin(row.theta + q[i])
    ca, sa = np.cos(row.alpha), np.sin(row.alpha)
    return np.array([[ct, -st, 0, row.a], [st * ca, ct * ca, -sa, -sa * row.d],
                     [st * sa, ct * sa, ca, ca * row.d], [0, 0, 0, 1]])  # fmt: skip


def written(quantity, *changes):
    code = CODE[quantity]
    for old, new in changes:
        assert old in code
        code = code.replace(old, new)
    names = {"np": np, "n": 3, "link": link, "ARM": ARM, "m": [row.mass for row in LINKS],
             "com": [np.array(row.com) for row in LINKS],
             "I": [np.array(row.inertia) for row in LINKS]}  # fmt: skip
    exec(code, names)  # noqa: S102 - the text above
    return kl.diagnose(ARM, quantity, names["f"], samples=20)


@pytest.mark.parametrize("quantity", CODE)
def test_the_textbook_is_right(quantity) -> None:
    assert written(quantity).agrees


@pytest.mark.parametrize(
    ("quantity", "old", "new", "words"),
    [
        ("inverse_dynamics", "np.cross(Rt @ w, z * v[i])", "np.zeros(3)", "omega_dot"),
        ("inverse_dynamics", "np.cross(w, np.cross(w, P[i]))", "np.zeros(3)", "w x (w x P)"),
        ("inverse_dynamics", " + np.cross(w, I[i] @ w)", "", "gyroscopic"),
        ("inverse_dynamics", "np.cross(dw, com[i]) + np.cross(w, np.cross(w, com[i])) + dv", "dv",
         "origin for that of the centre of mass"),
        ("inverse_dynamics", "np.cross(P[i + 1], fn)", "np.cross(P[i + 1], F[i])",
         "the link's own force"),
        ("inverse_dynamics", "np.cross(P[i + 1], fn)", "np.cross(P[i + 1], fo)", "not rotate"),
        ("inverse_dynamics", "+ np.cross(com[i], F[i]) ", "", "moment of F"),
        ("inverse_dynamics", "w = Rt @ w + z * v[i]", "w = Rt @ (w + z * v[i])", "R^T"),
        ("inverse_dynamics", "dv = Rt @ (np.cross(dw, P[i]) + np.cross(w, np.cross(w, P[i])) + dv)",
         "dv = Rt @ dv + np.cross(dw, P[i]) + np.cross(w, np.cross(w, P[i]))", "parentheses"),
        ("inverse_dynamics", "com[i]", "com[i - 1]", "in every line"),
        ("inverse_dynamics", "np.array([0, 0, 9.81])", "np.array([0, 0, -9.81])", "gravity"),
        ("jacobian", "        J[3:, i] = z\n", "", "the angular part"),
        ("jacobian", "np.asarray(ARM.table.tool)", "np.eye(4)", "tool"),
        ("jacobian", "J[:3, i] = np.cross(z, p - o)\n        J[3:, i] = z",
         "J[3:, i] = np.cross(z, p - o)\n        J[:3, i] = z", "angular rows first"),
        ("mass_matrix", "R @ I[k] @ R.T", "I[k]", "inertia tensor"),
        ("mass_matrix", "R @ I[k] @ R.T", "R.T @ I[k] @ R", "R^T I R"),
        ("mass_matrix", "range(k + 1)", "range(k)", "own joint"),
        ("jacobian", "z, o = T[i + 1][:3, 2]", "z, o = T[i][:3, 2]", "axis z of the joint before"),
        ("jacobian", "T[i + 1][:3, 3]", "T[i][:3, 3]", "origin o of the frame before"),
        ("jacobian", "np.cross(z, p - o)", "np.cross(p - o, z)", "order exchanged"),
    ],
)  # fmt: skip
def test_a_step_taken_otherwise_is_named(quantity, old, new, words) -> None:
    found = written(quantity, (old, new))
    assert not found.agrees
    assert any(words in cause.sentence for cause in found.causes[:2]), found
    assert found.causes[0].error_after <= 1e-9


def test_two_steps_at_once() -> None:
    found = written("jacobian", ("z, o = T[i + 1][:3, 2]", "z, o = T[i][:3, 2]"),
                    ("T[i + 1][:3, 3]", "T[i][:3, 3]"))  # fmt: skip
    assert "axis" in found.causes[0].sentence
    assert "origin" in found.causes[0].sentence


@pytest.mark.usefixtures("without_lines")
def test_an_entry_of_the_links_matrix() -> None:
    def pose(q):
        T = np.eye(4)
        for i in range(3):
            A = link(i, q)
            A[1, 2] = -A[1, 2]
            T = T @ A
        return T @ np.asarray(ARM.table.tool)

    found = kl.diagnose(ARM, "fk", pose, samples=20)
    assert "opposite sign in entry (2, 3)" in found.causes[0].sentence


def test_christoffels_terms() -> None:
    def other(q, v):
        slope = np.stack([(kl.mass_matrix(ARM, q + 1e-4 * e) - kl.mass_matrix(ARM, q - 1e-4 * e))
                          / 2e-4 for e in np.eye(3)], axis=2)  # fmt: skip
        c = 0.5 * (slope + np.swapaxes(slope, 1, 2) + np.transpose(slope, (2, 0, 1)))
        return c @ v

    # differences leave 1e-8: what explains all but that is named, and what is left is said
    found = kl.diagnose(ARM, "coriolis_matrix", other, samples=20)
    assert found.grade == "wrong"
    assert "Christoffel" in " ".join((*found.causes[0].kinds, found.sentence))
    assert "finite differences" in found.sentence
    assert 1e-9 < found.causes[0].error_after < 1e-6


@pytest.mark.parametrize(
    "name", ["jacobian", "inverse_dynamics", "gravity_torques", "link_velocities", "statics"]
)
def test_the_derivations_hold_of_an_arm_without_a_table(name: str) -> None:
    """An arm from a URDF file, with joints about axes of their own: Pinocchio's answer each time."""
    case, engine = prepare(kl.load("kinova"), name, (), 10, 0)
    ways = [road.walked([()], case.arguments)[0][0] for road in roads(case)]
    assert ways
    size = np.max(np.abs(engine))
    for answer in ways:
        assert np.max(np.abs(answer - engine)) <= 1e-9 * size
