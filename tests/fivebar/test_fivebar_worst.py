"""Bounds over cells and rectangles: no point of them exceeds one, on linkages of every kind."""

from __future__ import annotations

import numpy as np
import pytest
from fivebars import random_fivebar, random_state

import kinlab as kl
from kinlab.fivebar.bounds.enclosure import Enclosed, pose_over
from kinlab.fivebar.bounds.worst import acceleration_forms, bound_over, torque_forms
from kinlab.fivebar.dynamics import joint_mass, rod_model
from kinlab.fivebar.geometry import rate_bias, rate_matrix, solve_pose
from kinlab.fivebar.metrics import sigma
from kinlab.fivebar.workspace import Rectangle

ISOTROPIC, UNEQUAL = kl.FiveBar.load("isotropic"), kl.FiveBar.load("unequal")
BOX = Rectangle(-0.2, 0.15, -0.65, -0.5)


def everything(fivebar, pose):
    rods = rod_model(fivebar, "exact")
    load, turn = torque_forms(fivebar, pose, rods), acceleration_forms(fivebar, pose)
    return [
        pose.u, pose.w, pose.sine, pose.rods, rate_matrix(fivebar, pose), sigma(fivebar, pose),
        rate_bias(fivebar, pose, np.broadcast_to([0.7, -1.3], pose.xy.shape)),
        joint_mass(fivebar, pose, rods), load.linear, load.quadratic, load.constant,
        load.peak(2.0, 30.0), load.with_rotors(turn, np.array([0.1, 0.2])).peak(2.0, 30.0),
        load.behind_gears(turn, np.array([0.1, 0.05]), np.array([1e-3, 2e-3])).peak(2.0, 30.0),
    ]  # fmt: skip


def test_no_point_of_a_cell_leaves_its_enclosure():
    """Every formula on 40 random cells, wide to narrow, and the bound is not a wide guess."""
    rng = np.random.default_rng(0)
    compared = 0
    for k in range(40):
        fivebar = random_fivebar(rng)
        at, mode, _ = random_state(fivebar, rng)
        half = 10.0 ** rng.uniform(-5, -2, 2)
        low, high = at - half, at + half
        points = np.concatenate(
            [rng.uniform(low, high, (300, 2)), [low, high, [low[0], high[1]], [high[0], low[1]]]]
        )
        if not fivebar.reachable(points).all():
            continue
        compared += 1
        with np.errstate(all="ignore"):
            cell = everything(fivebar, pose_over(fivebar, low[None], high[None], np.array(mode)))
        real = everything(fivebar, solve_pose(fivebar, points, mode))
        for number, (over, values) in enumerate(zip(cell, real, strict=True)):
            slack = 1e-10 * (1.0 + np.abs(values).max())
            assert np.all(values <= over.high[0] + slack), (k, number)
            assert np.all(values >= over.low[0] - slack), (k, number)
            spread = np.ptp(values, axis=0)
            if half.max() < 1e-4:  # where the cell is small the slope says nearly all
                excess = (over.high[0] - values.max(axis=0)) + (values.min(axis=0) - over.low[0])
                assert np.all(excess <= 0.5 * spread + 1e-3 * np.abs(values).max()), (k, number)
    assert compared >= 30


def test_arithmetic_over_a_cell_by_hand():
    """x in [1, 3], y in [-1, 1]: each rule against the range that it must hold."""
    x = Enclosed(np.array([2.0]), np.array([[1.0], [0.0]]), np.zeros(1))
    y = Enclosed(np.array([0.0]), np.array([[0.0], [1.0]]), np.zeros(1))
    ranges = {
        "x - x": (x - x, 0, 0), "x * y": (x * y, -3, 3), "x²": (x**2, 1, 9), "1/x": (1 / x, 1 / 3, 1),
        "sqrt": (np.sqrt(x), 1, 3**0.5), "|y|": (np.abs(y), 0, 1), "max": (np.maximum(x, 2.0), 2, 3),
        "hypot": (np.hypot(x, y), 1, 10**0.5), "3 - x": (3.0 - x, 0, 2), "min": (np.minimum(x, y), -1, 1),
    }  # fmt: skip
    for name, (over, low, high) in ranges.items():
        assert over.low[0] <= low and high <= over.high[0], name
    assert (x - x).radius[0] == 0  # slopes are kept, so what cancels does
    assert np.isinf((1 / y).high[0]) and np.isinf(np.sqrt(y - 0.5).high[0])
    with pytest.raises(TypeError, match="no array of numbers"):
        np.asarray(x)


@pytest.mark.parametrize("fivebar", [ISOTROPIC, UNEQUAL], ids=["isotropic", "unequal"])
def test_the_bound_holds_and_the_gap_is_closed(fivebar):
    """Dense points and their best refined by a simplex search: never above the bound."""
    from scipy.optimize import minimize

    sizing = fivebar.size_servo(BOX, 3.0, 60.0, "SGMAH-08A", 20.0)
    bare, rods = (
        kl.FiveBar(**{**fivebar.values(), "rotor_inertia": 0.0}),
        rod_model(fivebar, "exact"),
    )
    kinds = {
        "rate": lambda xy: 3.0 * np.linalg.norm(fivebar.jacobian(xy), axis=2),
        "load_inertia": lambda xy: np.einsum("nii->ni", bare.mass_matrix(xy)),
        "torque": lambda xy: torque_forms(fivebar, solve_pose(fivebar, xy), rods).peak(3.0, 60.0),
    }  # fmt: skip
    x, y = np.meshgrid(np.linspace(*BOX[:2], 101), np.linspace(*BOX[2:], 51))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    low, high = np.array(BOX[::2]), np.array(BOX[1::2])
    for name, of in kinds.items():
        found = getattr(sizing, name)
        values = of(points)
        assert np.all(values <= found.bound), name
        assert np.all(found.value <= found.bound) and found.gap < 2e-7, name
        for crank in range(2):
            start = points[values[:, crank].argmax()]
            best = minimize(lambda p, c=crank, f=of: -f(np.clip(p, low, high)[None])[0, c], start,
                            method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-7, "maxfev": 120})  # fmt: skip
            assert -best.fun <= found.bound[crank]
            assert -best.fun == pytest.approx(found.value[crank], rel=1e-6), name
            np.testing.assert_allclose(of(found.place[crank][None])[0, crank], found.value[crank])


def test_a_spike_between_the_points_of_a_grid_is_found():
    """A quantity that is large in a spot of 1 mm only: a grid of 33 x 33 passes it by."""
    spot = np.array([-0.0613, -0.5557])

    def spike(pose):
        near = (pose.xy[:, :1] - spot[0]) ** 2 + (pose.xy[:, 1:] - spot[1]) ** 2
        return 1.0 / (near + 1e-6)

    x, y = np.meshgrid(np.linspace(*BOX[:2], 33), np.linspace(*BOX[2:], 33))
    assert np.max(1.0 / ((x - spot[0]) ** 2 + (y - spot[1]) ** 2 + 1e-6)) < 0.8e6
    value, place, bound = bound_over(ISOTROPIC, BOX, (-1, 1), spike)
    assert value[0] == pytest.approx(1e6, rel=1e-6) and value[0] <= bound[0] <= 1e6 * (1 + 1e-6)
    np.testing.assert_allclose(place[0], spot, atol=1e-6)
