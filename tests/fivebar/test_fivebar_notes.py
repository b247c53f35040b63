"""Note 003 as written, corrected, and beside the closed chain and the package's closed form."""

from __future__ import annotations

import importlib

import numpy as np
import pytest

import kinlab as kl
from kinlab.check.compare import compare_stacked
from kinlab.check.quantities.fivebar import numbers, sample
from kinlab.check.quantities.registry import quantity
from kinlab.errors import MechanismError, NameUnknownError
from kinlab.formulas.record import formulas_in
from kinlab.notes import note003_kinematics as note

NOTES = ("kinlab.notes.note003_kinematics", "kinlab.notes.note003_dynamics")
ROWS = [f for name in NOTES for f in formulas_in(importlib.import_module(name))]


def run(row, robot, function, samples=25):
    found = quantity(row.quantity)
    mechanism = found.domain.load(robot)
    return compare_stacked(
        mechanism, found, function, row.key, found.domain.numbers(mechanism), samples, 4
    )


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.key)
def test_row(row):
    robots = [r for name in row.robots for r in quantity(row.quantity).domain.members(name)]
    for robot in robots:
        assert run(row, robot, row.function).max_error < 1e-11, robot
        if row.printed and robot in row.printed.robots:
            assert run(row, robot, row.printed.function).max_error > 0.05, robot


def test_every_row_of_the_audit_is_there():
    ids = {row.id for row in ROWS}
    names = ("loop", "ABC", "tan", "w", "J", "acc", "vw", "G", "P", "speed", "IM", "Tmax")
    assert ids == {f"003.{name}" for name in names}


def test_the_printed_equation_misses_by_a_tenth_of_a_radian():
    """One example: e = .1, l1 = .3, l2 = .8; the two equations differ in theta."""
    fivebar = kl.FiveBar(0.3, 0.8, 0.1)
    xy = np.array([0.2, -0.7])
    loop = numbers(fivebar)
    theta = fivebar.ik(xy)
    x, y = xy
    s = np.array([1.0, -1.0])
    a, b = 2 * (s * 0.1 - x) * 0.3, -2 * y * 0.3
    gaps = []
    (right_side,) = note.right_side.formulas
    for form in (right_side.function, right_side.printed.function):
        c = form(loop, theta, xy)
        both = [np.arctan2(b, a) + k * np.arccos(c / np.hypot(a, b)) for k in (1, -1)]
        gaps.append(np.min([np.abs(np.exp(1j * t) - np.exp(1j * theta)) for t in both], axis=0))
    assert gaps[0].max() < 1e-14
    assert gaps[1].min() > 0.05 and gaps[1].max() < 0.3


def test_half_tangent_agrees_with_the_triangles_on_a_grid():
    fivebar = kl.FiveBar.load("unequal")
    points = np.random.default_rng(2).uniform(-0.8, 0.8, (2000, 2))
    points = points[fivebar.reachable(points)]
    for mode in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        u = note.cranks(numbers(fivebar), points, np.array(mode, dtype=float))
        theta = fivebar.ik(points, mode)
        np.testing.assert_allclose(u[..., 0], np.cos(theta), atol=1e-7)
        np.testing.assert_allclose(u[..., 1], np.sin(theta), atol=1e-7)


def test_compare_takes_a_users_function():
    fivebar = kl.FiveBar.load("isotropic")

    def half(xy, v, a, mode):
        return fivebar.jacobian(xy, mode) @ a

    def whole(xy, v, a, mode):
        return half(xy, v, a, mode) + fivebar.acceleration_bias(xy, v, mode)

    assert not kl.compare(fivebar, "fivebar_turn", half, samples=10).agrees
    assert kl.compare("isotropic", "fivebar_turn", whole, samples=10).agrees


def test_states_and_names():
    fivebar = kl.FiveBar.load("unequal")
    one = sample(fivebar, ("theta", "xy", "mode"), 5, np.random.default_rng(1))
    two = sample(fivebar, ("theta", "xy", "mode"), 5, np.random.default_rng(1))
    for a, b in zip(one, two, strict=True):
        np.testing.assert_array_equal(a, b)
    with pytest.raises(NameUnknownError, match="argument 'q'"):
        sample(fivebar, ("q",), 1, np.random.default_rng(0))
    with pytest.raises(MechanismError, match="gravity along -y"):
        numbers(kl.FiveBar(0.3, 0.5, 0.1, gravity=(1.0, -9.81)))
