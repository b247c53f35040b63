"""Metrics, ellipsoids, characteristic length, redundancy, task spaces."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st
from random_tables import random_table

import kinlab as kl
from kinlab.analysis import metrics
from kinlab.analysis.solver import jacobian_derivative
from kinlab.analysis.structure.task_space import read_task
from kinlab.errors import NameUnknownError, OptionError, StateError

KINDS = ("yoshikawa", "inverse_condition", "min_singular", "asada", "isotropy")


def test_exactly_singular_matrices_have_finite_and_right_measures():
    rng = np.random.default_rng(0)
    for _ in range(10_000):
        m, n = rng.integers(2, 7), rng.integers(2, 8)
        rank = int(rng.integers(0, min(m, n)))
        matrix = rng.integers(-3, 4, (m, rank)) @ rng.integers(-3, 4, (rank, n))  # exact integers
        sigma = metrics.singular_values(matrix)
        scale = max(float(sigma[0]), 1.0)
        assert sigma.shape == (m,)
        for kind in metrics.KINDS:
            value = float(metrics.KINDS[kind](sigma))
            assert np.isfinite(value) and value >= 0.0
        assert metrics.yoshikawa(sigma) <= 1e-13 * scale**m
        assert metrics.inverse_condition(sigma) <= 1e-14
        assert metrics.min_singular(sigma) <= 1e-13 * scale
        assert metrics.condition_number(sigma) > 1e13


def test_measures_against_eigenvalues_and_products():
    robot = kl.load("ur5")
    q = np.random.default_rng(1).uniform(-2, 2, (50, 6))
    jac, mass = kl.jacobian(robot, q), kl.mass_matrix(robot, q)
    eigen = np.linalg.eigvalsh(jac @ jac.swapaxes(1, 2))
    assert np.allclose(kl.manipulability(robot, q), np.abs(np.linalg.det(jac)), rtol=1e-10)
    assert np.allclose(
        kl.manipulability(robot, q, "inverse_condition") ** 2, eigen[:, 0] / eigen[:, -1], rtol=1e-8
    )
    assert np.allclose(kl.manipulability(robot, q, "min_singular") ** 2, eigen[:, 0], rtol=1e-8)
    lam = np.linalg.inv(jac @ np.linalg.inv(mass) @ jac.swapaxes(1, 2))
    inertia = np.linalg.eigvalsh(0.5 * (lam + lam.swapaxes(1, 2)))
    assert np.allclose(
        kl.manipulability(robot, q, "asada"), inertia[:, 0] / inertia[:, -1], rtol=1e-7
    )
    means = np.prod(eigen, axis=1) ** (1 / 6) / eigen.mean(axis=1)
    assert np.allclose(kl.manipulability(robot, q, "isotropy"), means, rtol=1e-8)


def test_planar_arm_closed_forms():
    robot = kl.load("planar2r")
    l1, l2 = robot.table.links[1].a, robot.table.tool[0, 3]
    q = np.random.default_rng(2).uniform(-3, 3, (20, 2))
    value = kl.manipulability(robot, q, task="xy")
    assert np.allclose(value, l1 * l2 * np.abs(np.sin(q[:, 1])), atol=1e-15)
    assert isinstance(kl.manipulability(robot, q[0], task="xy"), float)
    assert kl.manipulability(robot, [0.3, 0.0], task="xy") <= 1e-16
    assert (
        kl.manipulability(robot, q[0], task="pose") == 0.0
    )  # a 2R arm spans two of six coordinates
    report = kl.dexterity(robot, q[0])
    assert (report.task, report.suggested, report.length, report.rank) == ("xy", True, None, 2)


@pytest.mark.parametrize(
    ("name", "task"),
    [("planar2r", "xy"), ("planar3r", "xytheta"), ("spatial3r", "position"), ("puma560", "pose"),
     ("panda", "pose"), ("scara", "(x, y, z, rotation about z)")],
)  # fmt: skip
def test_suggested_task(name, task):
    space = read_task(kl.load(name), "auto")
    assert space.name == task and space.suggested


@given(
    seed=st.integers(0, 10_000),
    n=st.integers(1, 7),
    convention=st.sampled_from(["standard", "modified"]),
)
def test_jacobian_derivative_is_pinocchios_hessian(seed, n, convention):
    robot = kl.Robot.from_dh(random_table(seed, n, convention))
    rng = np.random.default_rng(seed)
    q, v = rng.uniform(-2, 2, n), rng.normal(size=n)
    derivative = jacobian_derivative(kl.jacobian(robot, q))
    # J_dot = sum_k dJ/dq_k v_k, by Pinocchio's own recursion
    assert np.allclose(
        np.einsum("k,kij->ij", v, derivative), kl.jacobian_dot(robot, q, v), atol=1e-12
    )


def test_ellipsoids_against_samples():
    robot = kl.load("planar2r_rods")
    q = np.array([0.4, 1.1])
    rng = np.random.default_rng(3)
    ball = rng.normal(size=(2, 20_000))
    ball /= np.linalg.norm(ball, axis=0)
    jac = kl.jacobian(robot, q)[:2]
    for kind, image in (
        ("velocity", jac @ ball),
        ("force", np.linalg.solve(jac.T, ball)),
        ("dynamic", jac @ np.linalg.solve(kl.mass_matrix(robot, q), ball)),
    ):
        shape = kl.ellipsoid(robot, q, kind)
        size = np.linalg.norm(image, axis=0)
        assert shape.lengths[0] == pytest.approx(size.max(), rel=1e-5)
        assert shape.lengths[1] == pytest.approx(size.min(), rel=1e-5)
        on_it = np.sum((shape.axes.T @ image / shape.lengths[:, None]) ** 2, axis=0)
        assert np.allclose(on_it, 1.0, atol=1e-9)


def test_force_ellipsoid_at_a_singularity_says_infinity():
    robot = kl.load("planar2r")
    shape = kl.ellipsoid(robot, [0.3, 0.0], "force")
    assert np.isinf(shape.lengths[0]) and np.isfinite(shape.lengths[1])
    outward = np.array([np.cos(0.3), np.sin(0.3)])
    assert abs(shape.axes[:, 0] @ outward) == pytest.approx(1.0, abs=1e-12)


def test_characteristic_length_minimises_the_condition_number():
    robot = kl.load("puma560")
    q = np.random.default_rng(4).uniform(-1.2, 1.2, 6)
    best = kl.characteristic_length(robot, q)
    assert best.how == "optimal"
    jac = kl.jacobian(robot, q)
    lengths = best.length * np.exp(np.linspace(-3, 3, 2001))
    others = [np.linalg.cond(np.vstack([jac[:3] / L, jac[3:]])) for L in lengths]
    assert best.condition <= min(others) * (1 + 1e-9)
    assert kl.characteristic_length(robot, q, length=0.2).condition == pytest.approx(
        np.linalg.cond(np.vstack([jac[:3] / 0.2, jac[3:]])), rel=1e-12
    )
    assert kl.characteristic_length(robot, q, "position").how == "none needed"


def test_redundant_arm_takes_the_right_inverse():
    robot = kl.load("panda")
    q = np.array([0.1, 0.4, -0.3, -1.8, 0.2, 1.5, 0.5])
    found, jac = kl.redundancy(robot, q), kl.jacobian(robot, q)
    assert found.rank == 6 and found.null_space.shape == (7, 1)
    assert np.allclose(jac @ found.null_space, 0.0, atol=1e-14)
    assert np.allclose(jac @ found.inverse, np.eye(6), atol=1e-12)
    assert np.allclose(found.inverse, jac.T @ np.linalg.inv(jac @ jac.T), atol=1e-9)
    # the note's form: J^T J is singular, so that its inverse is no inverse
    assert np.linalg.matrix_rank(jac.T @ jac) == 6
    assert "singular at every q" in found.why
    assert kl.redundancy(kl.load("puma560"), np.zeros(6)).inverse is None


def test_dynamic_weights_use_the_engine_of_pinocchio():
    robot = kl.load("puma560")
    q = np.random.default_rng(5).uniform(-1, 1, 6)
    data = robot.model.createData()
    half = pin.computeMinverse(robot.model, data, q)
    half = np.triu(half) + np.triu(half, 1).T
    jac = kl.jacobian(robot, q)
    eigen = np.linalg.eigvalsh(jac @ half @ jac.T)
    assert kl.manipulability(robot, q, "asada") == pytest.approx(eigen[0] / eigen[-1], rel=1e-8)


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda r: kl.manipulability(r, [0, 0], "yoshi"), NameUnknownError, ["'yoshi'", "'yoshikawa'"]),
        (lambda r: kl.manipulability(r, [0, 0], "speed"), NameUnknownError, list(KINDS)),
        (lambda r: kl.manipulability(r, [0, 0], task="planar"), NameUnknownError, ["'planar'", "mask"]),
        (lambda r: kl.manipulability(r, [0, 0], task=[1, 0, 1]), OptionError, ["(3,)", "(6,)"]),
        (lambda r: kl.manipulability(r, [0, 0], task="xy", length=0), OptionError, ["0 m", "above 0"]),
        (lambda r: kl.manipulability(r, [0, 0], length=float("nan")), OptionError, ["finite"]),
        (lambda r: kl.manipulability(r, [0, 0, 0]), StateError, ["(2,)"]),
        (lambda r: kl.manipulability(r, [0, np.nan]), StateError, ["finite"]),
        (lambda r: kl.ellipsoid(r, [0, 0], "speed"), NameUnknownError, ["velocity"]),
        (lambda r: kl.ellipsoid(r, [[0, 0]]), OptionError, ["one state"]),
        (lambda r: kl.characteristic_length(r, [0, 1], length="best"), NameUnknownError, ["optimal"]),
        (lambda r: kl.find_isotropic(r, length=-1.0), OptionError, ["-1 m"]),
        (lambda r: kl.find_isotropic(r, task="pose"), OptionError, ["'pose'", "'xy'"]),
        (lambda r: kl.find_singularities(r, task="pose"), OptionError, ["'planar2r'", "use task 'xy'"]),
        (lambda r: kl.factored_determinant(r, task="position"), OptionError, ["square", "3 rows", "2 joints"]),
        (lambda r: kl.describe_singularity(r, [0.1, 0.5]), OptionError, ["not singular", "1e-10"]),
    ],
)  # fmt: skip
def test_bad_input_is_named(call, error, words):
    with pytest.raises(error) as caught:
        call(kl.load("planar2r"))
    for word in words:
        assert word in str(caught.value)


def test_a_singular_q_has_no_best_length():
    robot = kl.load("planar3r")
    with pytest.raises(OptionError, match="singular"):
        kl.characteristic_length(robot, [0.1, 0.0, 0.2])
