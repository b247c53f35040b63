"""Isotropic configurations and designs, with Pinocchio's Jacobian as the judge."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.analysis.isotropy.design_model import open_chain
from kinlab.errors import OptionError


def standard(*lengths, twists=None, offsets=None):
    twists = twists or [0.0] * len(lengths)
    offsets = offsets or [0.0] * len(lengths)
    links = [
        kl.DHLink("revolute", a=a, alpha=np.deg2rad(t), d=d)
        for a, t, d in zip(lengths, twists, offsets, strict=True)
    ]
    return kl.DHTable("arm", "standard", links)


def diestro(size=0.05):
    """DIESTRO, the isotropic 6R arm of Angeles, *Fundamentals of Robotic Mechanical Systems*:
    every length and offset 50 mm, twists ±90°, characteristic length 50 mm."""
    return standard(*[size] * 6, twists=[90, -90, 90, -90, 90, -90], offsets=[size] * 6)


def residual(robot, q, rows, length):
    """How far J J^T is from a multiple of 1, by the engine."""
    jac = kl.jacobian(robot, q)[list(rows)]
    jac[np.array(rows) < 3] /= length or 1.0
    gram = jac @ jac.T
    return np.abs(gram / (np.trace(gram) / len(rows)) - np.eye(len(rows))).max()


def test_the_2r_arm_of_note_000():
    found = kl.find_isotropic(kl.Robot.from_dh(standard(np.sqrt(2.0), 1.0)))
    assert (found.task, found.suggested, found.length) == ("xy", True, "none needed")
    assert np.allclose([np.degrees(c.q[1]) for c in found], [-135.0, 135.0], atol=1e-6)
    assert all(c.free == ("joint_1",) and c.freedom == 1 for c in found)
    for c in found:  # ^3J = l2 I: both singular values are l2
        assert c.condition - 1.0 <= 1e-8
        assert np.allclose(c.jacobian @ c.jacobian.T, np.eye(2), atol=1e-12)


def test_isotropic_planar_3r():
    # axes on a circle about the tool, 120° apart: l1 = l2 = sqrt(3) l3, length l3 / sqrt(2)
    robot = kl.Robot.from_dh(standard(np.sqrt(3.0), np.sqrt(3.0), 1.0))
    found = kl.find_isotropic(robot)
    assert found.length == "optimal" and len(found) == 2
    for c in found:
        assert c.length == pytest.approx(1.0 / np.sqrt(2.0), abs=1e-9)
        assert residual(robot, c.q, (0, 1, 5), c.length) < 1e-9
        assert np.allclose(np.abs(np.degrees(c.q[1:])), [120.0, 150.0], atol=1e-6)


@pytest.mark.parametrize("length", [0.05, "optimal"])
def test_diestro_is_isotropic(length):
    robot = kl.Robot.from_dh(diestro())
    found = kl.find_isotropic(robot, length=length)
    assert found.found and found.converged > 10
    assert all(c.length == pytest.approx(0.05, abs=1e-9) for c in found)
    assert all("joint_1" in c.free and c.condition - 1.0 <= 1e-8 for c in found)
    assert all(residual(robot, c.q, range(6), c.length) < 1e-8 for c in found)
    expected = np.deg2rad([0, 90, -90, 90, -90, 180])
    assert any(np.abs(np.sin(0.5 * (c.q - expected))).max() < 1e-5 for c in found)


def test_diestro_with_another_length_is_not():
    found = kl.find_isotropic(kl.Robot.from_dh(diestro()), length=0.06, seeds=60)
    # its isotropic pose then has singular values 5/6 and 1, and no other does better
    assert not found.found and found.best_condition == pytest.approx(1.2, abs=1e-6)
    assert found.best_length == 0.06 and found.spread[0] >= found.best_condition - 1e-12


def test_best_reachable_condition_number_in_closed_form():
    # planar2r: J = [[-l1 s1 - l2 s12, -l2 s12], ...]; kappa depends on q2 alone
    robot = kl.load("planar2r")
    found = kl.find_isotropic(robot, seeds=60)
    q2 = np.linspace(-np.pi, np.pi, 200_001)
    l1, l2 = robot.table.links[1].a, robot.table.tool[0, 3]
    trace = l1**2 + 2 * l2**2 + 2 * l1 * l2 * np.cos(q2)
    det = np.abs(l1 * l2 * np.sin(q2))
    half = np.sqrt(np.maximum(trace**2 / 4 - det**2, 0.0))
    kappa = np.sqrt((trace / 2 + half) / np.maximum(trace / 2 - half, 1e-300))
    assert found.best_condition == pytest.approx(kappa.min(), rel=1e-8)
    assert not found.found and found.seeds == 60


def test_isotropy_within_limits_only():
    links = [
        kl.DHLink("revolute", a=np.sqrt(2.0)),
        kl.DHLink("revolute", a=1.0, lower=0.0, upper=2.0),
    ]
    found = kl.find_isotropic(kl.Robot.from_dh(kl.DHTable("arm", "standard", links)))
    assert not found.found and found.best_q[1] == pytest.approx(2.0, abs=1e-9)


def test_same_seed_same_answer():
    one, two = (kl.find_isotropic(kl.Robot.from_dh(diestro()), seeds=80, seed=5) for _ in range(2))
    assert len(one) == len(two)
    assert all(np.array_equal(a.q, b.q) for a, b in zip(one, two, strict=True))


@pytest.mark.parametrize(
    ("table", "free", "one", "two"),
    [
        (standard(1.0, 1.0), ["a1", "a2"], "a1", "a2"),
        (kl.load("planar2r").table, ["a2", "tool.x"], "a2", "tool.x"),
        (standard(1.0, 1.0), ["a1"], "a1", None),
    ],
)
def test_design_of_the_2r_arm(table, free, one, two):
    search = kl.design_isotropic(table, free=free)
    assert len(search) == 1
    design = search[0]
    l2 = design.values[two] if two else 1.0
    assert design.values[one] == pytest.approx(np.sqrt(2.0) * l2, rel=1e-9)
    assert np.allclose(
        sorted(np.degrees(c.q[1]) for c in design.configurations), [-135, 135], atol=1e-6
    )
    robot = kl.Robot.from_dh(design.table)
    assert residual(robot, design.q, (0, 1), None) < 1e-9
    if two:  # every length open: the size of the arm is kept
        assert sum(design.values.values()) == pytest.approx(
            2.0 if two == "a2" else table.links[1].a + table.tool[0, 3], rel=1e-12
        )


def test_design_of_the_planar_3r():
    search = kl.design_isotropic(kl.load("planar3r").table, free=["a2", "a3", "tool.x"])
    design = search[0]
    l1, l2, l3 = design.values.values()
    assert (l1 / l3, l2 / l3) == pytest.approx((np.sqrt(3.0), np.sqrt(3.0)), rel=1e-8)
    assert design.length == pytest.approx(l3 / np.sqrt(2.0), rel=1e-8)
    assert design.condition - 1.0 <= 1e-8
    assert residual(kl.Robot.from_dh(design.table), design.q, (0, 1, 5), design.length) < 1e-8


def test_design_of_a_six_joint_arm():
    search = kl.design_isotropic(diestro(0.04), free=[f"{c}{i}" for c in "ad" for i in range(2, 7)])
    assert len(search) > 0
    for design in search:
        assert residual(kl.Robot.from_dh(design.table), design.q, range(6), design.length) < 1e-7


def test_open_chain_is_the_table():
    for name in ("puma560", "puma560_modified", "stanford", "scara"):
        table = kl.load(name).table
        chain = open_chain(table, ["a1", "alpha2", "tool.z"])
        q = np.random.default_rng(0).uniform(-1, 1, (4, table.n))
        x = np.concatenate([q, np.tile([o.value for o in chain.open], (4, 1))], axis=1)
        columns = [chain.order.index(i) for i in range(table.n)]
        expected = kl.jacobian(kl.load(name), q)
        assert np.allclose(chain.jacobian(x)[..., columns], expected, atol=1e-13)


@pytest.mark.parametrize(
    ("free", "words"),
    [
        (["l1"], ["'l1'", "tool.x"]),
        (["a9"], ["rows 1 to 2"]),
        (["theta1"], ["revolute", "searched anyway"]),
        (["a1", "a1"], ["twice"]),
        ([], ["list of numbers"]),
        ("a1", ["list of numbers"]),
    ],
)
def test_design_bad_names(free, words):
    with pytest.raises(OptionError) as caught:
        kl.design_isotropic(standard(1.0, 1.0), free=free)
    for word in words:
        assert word in str(caught.value)
