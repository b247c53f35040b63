"""Symbolic M, C, g, tau and energies against the engine and against note 001."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

import kinlab as kl
from kinlab import symbolic

WHOLE = ("single_link", "planar2r", "planar2r_rods", "planar3r", "spatial3r", "scara")
TABLES = {name: kl.load(name).table for name in WHOLE}
for _name in ("stanford", "puma560", "puma560_modified"):
    _table = kl.load(_name).table
    TABLES[f"{_name}, first three"] = dataclasses.replace(
        _table, links=_table.links[:3], tool=np.eye(4)
    )
WHAT = {
    "mass_matrix": 1, "coriolis_matrix": 2, "gravity_torques": 1, "inverse_dynamics": 3,
    "kinetic_energy": 2, "potential_energy": 1,
}  # fmt: skip


def compare(table: kl.DHTable, symbols: str, tolerance: float) -> None:
    robot = kl.Robot.from_dh(table)
    arm = symbolic.arm(table, symbols)
    states = np.random.default_rng(4).uniform(-3, 3, (4, 3, table.n))
    for what, count in WHAT.items():
        function = symbolic.to_function(arm, sympy.sympify(getattr(symbolic, what)(arm)))
        for state in states:
            expected = getattr(kl, what)(robot, *state[:count])
            found = function(*state[:count]).reshape(np.shape(expected))
            np.testing.assert_allclose(found, expected, atol=tolerance)


@pytest.mark.parametrize("symbols", ["all", "none"])
@pytest.mark.parametrize("name", TABLES)
def test_dynamics_equal_the_engine(name: str, symbols: str) -> None:
    compare(TABLES[name], symbols, 1e-10)


@st.composite
def massive_tables(draw: st.DrawFn) -> kl.DHTable:
    seed = draw(st.integers(0, 10_000))
    rng = np.random.default_rng(seed)
    links = []
    for _ in range(draw(st.integers(1, 3))):
        points = rng.uniform(-0.3, 0.3, (5, 3)).round(2)
        points -= points.mean(axis=0)
        links.append(
            kl.DHLink(
                joint=draw(st.sampled_from(["revolute", "prismatic"])),
                a=draw(st.sampled_from([0.0, 0.3])),
                alpha=draw(st.sampled_from([0.0, np.pi / 2, -np.pi / 2, np.pi, 0.7])),
                d=draw(st.sampled_from([0.0, -0.2])),
                theta=draw(st.sampled_from([0.0, np.pi / 2])),
                flip=draw(st.booleans()),
                mass=1.5,
                com=rng.uniform(-0.2, 0.2, 3).round(2),
                inertia=sum(np.dot(p, p) * np.eye(3) - np.outer(p, p) for p in points),
                armature=draw(st.sampled_from([0.0, 0.1])) + 0.01,
            )
        )
    convention = draw(st.sampled_from(["standard", "modified"]))
    return kl.DHTable("random", convention, links, gravity=rng.uniform(-9, 9, 3).round(1))


@settings(max_examples=20, deadline=None)
@given(massive_tables())
def test_random_tables(table: kl.DHTable) -> None:
    compare(table, "none", 1e-9)


def test_note_001_closed_form() -> None:
    arm = symbolic.arm(TABLES["planar2r"])
    l1, l2, m1, m2, g = (sympy.Symbol(x, real=True) for x in ("l1", "l2", "m1", "m2", "g"))
    (q1, q2), (d1, d2), (a1, a2) = arm.q, arm.qd, arm.qdd
    tau1 = (
        ((m1 + m2) * l1**2 + m2 * l2**2 + 2 * m2 * l1 * l2 * sympy.cos(q2)) * a1
        + (m2 * l2**2 + m2 * l1 * l2 * sympy.cos(q2)) * a2
        - m2 * l1 * l2 * sympy.sin(q2) * (2 * d1 * d2 + d2**2)
        + (m1 + m2) * g * l1 * sympy.cos(q1)
        + m2 * g * l2 * sympy.cos(q1 + q2)
    )
    tau = symbolic.inverse_dynamics(arm)
    assert sympy.expand(tau[0] - tau1) == 0
    d = symbolic.christoffel(arm)
    bend = m2 * l1 * l2 * sympy.sin(q2)
    assert d[0][1][1] == d[0][0][1] == d[0][1][0] == -bend
    assert d[1][0][0] == bend
    assert d[0][0][0] == d[1][1][1] == d[1][0][1] == d[1][1][0] == 0


def test_mdot_minus_2c_is_skew() -> None:
    arm = symbolic.arm(TABLES["spatial3r"])
    mass, coriolis = symbolic.mass_matrix(arm), symbolic.coriolis_matrix(arm)
    m_dot = sum((mass.diff(q) * v for q, v in zip(arm.q, arm.qd, strict=True)),
                sympy.zeros(3, 3))  # fmt: skip
    skew = symbolic.to_function(arm, m_dot - 2 * coriolis)([0.3, -1.0, 0.8], [1.0, -2.0, 0.5])
    np.testing.assert_allclose(skew, -skew.T, atol=1e-13)
