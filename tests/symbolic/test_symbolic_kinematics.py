"""Symbolic FK, Jacobian and det J against the engine and against published factors."""

from __future__ import annotations

import runpy
from pathlib import Path

import numpy as np
import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

import kinlab as kl
from kinlab import symbolic
from kinlab.errors import NameUnknownError, OptionError, StructureError

NAMES = ("planar2r", "planar2r_rods", "planar3r", "spatial3r", "scara", "stanford", "puma560",
         "puma560_modified", "ur5", "panda", "single_link")  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_fk_and_jacobians_equal_the_engine(name: str) -> None:
    robot = kl.load(name)
    arm = symbolic.arm(robot.table)
    pose = symbolic.to_function(arm, symbolic.fk(arm))
    jacobians = {
        frame: symbolic.to_function(arm, symbolic.jacobian(arm, frame))
        for frame in ("base", "tool", "spatial")
    }
    for q in np.random.default_rng(1).uniform(-3, 3, (5, robot.n)):
        np.testing.assert_allclose(pose(q), kl.fk(robot, q), atol=1e-12)
        for frame, function in jacobians.items():
            expected = kl.jacobian(robot, q, frame)
            np.testing.assert_allclose(function(q).reshape(6, -1), expected, atol=1e-12)


angles = st.sampled_from([0.0, np.pi / 2, -np.pi / 2, np.pi, 0.3, -1.1])
lengths = st.sampled_from([0.0, 0.4, -0.25, 1.0])


@st.composite
def tables(draw: st.DrawFn) -> kl.DHTable:
    links = [
        kl.DHLink(
            joint=draw(st.sampled_from(["revolute", "prismatic"])),
            a=draw(lengths),
            alpha=draw(angles),
            d=draw(lengths),
            theta=draw(angles),
            flip=draw(st.booleans()),
        )
        for _ in range(draw(st.integers(1, 4)))
    ]
    tool = np.eye(4)
    tool[:3, 3] = [draw(lengths) for _ in range(3)]
    tool[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    convention = draw(st.sampled_from(["standard", "modified"]))
    return kl.DHTable("random", convention, links, tool=tool, base=tool)


@settings(max_examples=40, deadline=None)
@given(tables(), st.integers(0, 1000))
def test_random_tables(table: kl.DHTable, seed: int) -> None:
    arm = symbolic.arm(table)
    q = np.random.default_rng(seed).uniform(-3, 3, table.n)
    pose = symbolic.to_function(arm, symbolic.fk(arm))
    np.testing.assert_allclose(pose(q), table.fk(q)[-1], atol=1e-9)
    for frame, placed in zip(symbolic.frames(arm), table.frames(q), strict=True):
        np.testing.assert_allclose(symbolic.to_function(arm, frame)(q), placed, atol=1e-9)


def s(text: str) -> sympy.Expr:
    names = "a1 a2 a3 d4 d5 l1 l2 xt q1 q2 q3 q4 q5"
    return sympy.sympify(text, {n: sympy.Symbol(n, real=True) for n in names.split()})


# Published: planar arms in every textbook; SCARA and Stanford: Siciliano et al. 3.3; Puma's
# elbow, shoulder and wrist factors: Spong, Hutchinson, Vidyasagar 4.9; UR5: Hawkins 2013.
FACTORS = {
    "planar2r": ["sin(q2)"],
    "planar3r": ["sin(q2)"],
    "scara": ["sin(q2)"],
    "stanford": ["q3", "sin(q2)", "sin(q5)"],
    "puma560_modified": [
        "a2*cos(q2) + a3*cos(q2 + q3) - d4*sin(q2 + q3)", "a3*sin(q3) + d4*cos(q3)", "sin(q5)",
    ],
    "ur5": ["a2*cos(q2) + a3*cos(q2 + q3) + d5*sin(q2 + q3 + q4)", "sin(q3)", "sin(q5)"],
}  # fmt: skip


@pytest.mark.parametrize("name", FACTORS)
def test_determinant_has_the_published_factors(name: str) -> None:
    robot = kl.load(name)
    arm = symbolic.arm(robot.table)
    found = symbolic.det_jacobian(arm)
    assert found.complete
    assert set(found.singular_factors) == {s(text) for text in FACTORS[name]}
    value = symbolic.to_function(arm, found.expression)
    for q in np.random.default_rng(2).uniform(-3, 3, (10, robot.n)):
        expected = np.linalg.det(kl.jacobian(robot, q)[list(found.rows)])
        assert float(value(q)) == pytest.approx(expected, abs=1e-12)


@settings(max_examples=25, deadline=None)
@given(tables(), st.integers(0, 1000))
def test_determinant_of_random_tables(table: kl.DHTable, seed: int) -> None:
    arm = symbolic.arm(table, symbols="none")
    rows = tuple(range(table.n))
    q = np.random.default_rng(seed).uniform(-3, 3, table.n)
    jac = symbolic.to_function(arm, symbolic.jacobian(arm))(q).reshape(6, table.n)
    found = symbolic.det_jacobian(arm, rows)
    value = float(symbolic.to_function(arm, sympy.sympify(found.expression))(q))
    assert value == pytest.approx(np.linalg.det(jac[: table.n]), abs=1e-8)


def test_planar_names_are_the_textbooks() -> None:
    arm = symbolic.arm(kl.load("planar2r").table)
    assert arm.values == {"l1": 0.5, "l2": 0.4, "m1": 2.0, "m2": 1.5, "g": 9.81}
    x = symbolic.fk(arm)[0, 3]
    assert x == s("l1*cos(q1) + l2*cos(q1 + q2)")


def test_some_numbers_can_stay_numbers() -> None:
    arm = symbolic.arm(kl.load("planar2r").table, symbols=["l1"])
    assert symbolic.det_jacobian(arm).expression == s("2*l1*sin(q2)/5")


def test_python_and_latex_output(tmp_path: Path) -> None:
    robot = kl.load("planar3r")
    arm = symbolic.arm(robot.table)
    source = tmp_path / "jac.py"
    source.write_text(symbolic.to_python(arm, symbolic.jacobian(arm), "jac"))
    namespace = runpy.run_path(str(source))
    q = np.array([0.1, 0.7, -0.4])
    np.testing.assert_allclose(namespace["jac"](q), kl.jacobian(robot, q), atol=1e-14)
    assert symbolic.to_latex(s("l1*sin(q2)")) == r"l_{1} \sin{\left(q_{2} \right)}"


def test_other_numbers_can_be_put_in() -> None:
    arm = symbolic.arm(kl.load("planar2r").table)
    function = symbolic.to_function(arm, symbolic.fk(arm), {"l1": 2.0})
    assert function([0.0, 0.0])[0, 3] == pytest.approx(2.4)


def test_messages() -> None:
    table = kl.load("planar2r").table
    with pytest.raises(NameUnknownError, match=r"no number called 'l9'.*'l1'"):
        symbolic.arm(table, symbols=["l9"])
    with pytest.raises(OptionError, match='choose "all", "none"'):
        symbolic.arm(table, symbols="some")
    arm = symbolic.arm(table)
    with pytest.raises(NameUnknownError, match="frame 'world'"):
        symbolic.jacobian(arm, "world")
    with pytest.raises(OptionError, match="2 different rows"):
        symbolic.det_jacobian(arm, (0, 0))
    with pytest.raises(StructureError, match="not square"):
        symbolic.det_jacobian(symbolic.arm(kl.load("panda").table))
    with pytest.raises(NameUnknownError, match="parameter 'l7'"):
        symbolic.to_function(arm, symbolic.fk(arm), {"l7": 1.0})
