"""Closed-form kinematics of the five-bar against geometry, differences and its own inverse."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle

import numpy as np
import pytest
from fivebars import MODES, bars, random_fivebar, random_state

import kinlab as kl
from kinlab.errors import MechanismError, OptionError, SingularError, StateError, UnreachableError

ISOTROPIC = kl.FiveBar.load("isotropic")


@pytest.fixture
def rng():
    return np.random.default_rng(20260101)


def test_ik_closes_the_loop_in_the_mode_asked_for(rng):
    for _ in range(200):
        fivebar = random_fivebar(rng)
        xy, mode, _ = random_state(fivebar, rng)
        theta = fivebar.ik(xy, mode)
        elbow = np.array([fivebar.e, -fivebar.e]) + fivebar.l1 * np.exp(1j * theta)
        np.testing.assert_allclose(abs(complex(*xy) - elbow), fivebar.l2, rtol=0, atol=1e-14)
        assert tuple(np.sign(bars(fivebar, theta, xy)[0])) == mode
        assert np.all((theta > -np.pi) & (theta <= np.pi))


def test_round_trip_of_all_modes_on_a_million_points():
    """1e-12 m where the rods are not nearly in line; the error grows as 1/|w1 x w2| there."""
    rng = np.random.default_rng(1)
    points = rng.uniform([-0.7, -0.85], [0.7, 0.85], (2_000_000, 2))
    points = points[ISOTROPIC.reachable(points)][:1_000_000]
    assert len(points) == 1_000_000
    for mode in MODES:
        theta = ISOTROPIC.ik(points, mode)
        rods = _rods(ISOTROPIC, theta, points)
        back = np.where(
            (rods > 0)[:, None], ISOTROPIC.fk(theta, 1), ISOTROPIC.fk(theta, -1)
        )  # fmt: skip
        error = np.abs(back - points).max(axis=1)
        clear = np.abs(rods) > 1e-3
        assert clear.mean() > 0.998
        assert error[clear].max() < 1e-12
        # rounding of theta moves the elbows by 1e-16 m; the tool by that over |w1 x w2|
        assert np.max(error * np.maximum(np.abs(rods), 1e-8)) < 2e-15


def _rods(fivebar, theta, points):
    elbow = np.array([fivebar.e, -fivebar.e]) + fivebar.l1 * np.exp(1j * theta)
    w = (points[:, :1] + 1j * points[:, 1:] - elbow) / fivebar.l2
    return (np.conj(w[:, 0]) * w[:, 1]).imag


def test_fk_gives_both_assemblies(rng):
    for _ in range(100):
        fivebar = random_fivebar(rng)
        xy, mode, assembly = random_state(fivebar, rng)
        theta = fivebar.ik(xy, mode)
        np.testing.assert_allclose(fivebar.fk(theta, assembly), xy, rtol=0, atol=1e-13)
        other = fivebar.fk(theta, -assembly)
        assert np.sign(bars(fivebar, theta, other)[1]) == -assembly
        elbow = np.array([fivebar.e, -fivebar.e]) + fivebar.l1 * np.exp(1j * theta)
        np.testing.assert_allclose(abs(complex(*other) - elbow), fivebar.l2, atol=1e-13)
        assert fivebar.mode_of(theta, xy) == mode


def test_a_plus_c_equal_to_zero_is_an_ordinary_point():
    """Where the half-tangent form is 0/0 (theta = pi): crank 2 points along -x."""
    fivebar = kl.FiveBar(0.3, 0.5, 0.1)
    for s in (1, -1):
        rod = np.exp(1j * (np.pi + s * 2.5))
        tool = -0.1 - 0.3 + 0.5 * rod
        theta = fivebar.ik([tool.real, tool.imag], (1, s))
        assert abs(abs(theta[1]) - np.pi) < 1e-14


@pytest.mark.parametrize("leg", [0, 1])
@pytest.mark.parametrize("edge", ["outer", "inner"])
def test_the_edge_of_reach_on_both_sides(leg, edge, rng):
    fivebar = kl.FiveBar((0.30, 0.25), (0.50, 0.55), 0.1)
    base = np.array([[0.1, 0.0], [-0.1, 0.0]])[leg]
    l1, l2 = fivebar.l1[leg], fivebar.l2[leg]
    radius, outward = (l1 + l2, 1.0) if edge == "outer" else (abs(l1 - l2), -1.0)
    found = 0
    for angle in rng.uniform(-np.pi, np.pi, 400):
        way = np.array([np.cos(angle), np.sin(angle)])
        inside = base + (radius - outward * 1e-9) * way
        outside = base + (radius + outward * 1e-9) * way
        other = np.linalg.norm(inside + base)  # distance to the other base pin
        if not abs(fivebar.l1 - fivebar.l2)[1 - leg] + 1e-6 < other < 0.8 - 1e-6:
            continue
        found += 1
        assert fivebar.reachable(inside) and not fivebar.reachable(outside)
        with pytest.raises(UnreachableError, match="too (far|near) for leg"):
            fivebar.ik(outside)
        theta = fivebar.ik(inside)
        elbow = base[0] + l1 * np.exp(1j * theta[leg])
        assert abs(abs(complex(*inside) - elbow) - l2) < 1e-14
        assert tuple(np.sign(bars(fivebar, theta, inside)[0])) == (-1, 1)
    assert found > 50


def test_jacobian_and_bias_are_the_derivatives_of_ik(rng):
    for _ in range(100):
        fivebar = random_fivebar(rng)
        xy, mode, _ = random_state(fivebar, rng, clear=0.2)
        v, a = rng.uniform(-1, 1, 2), rng.uniform(-5, 5, 2)
        h = 1e-5
        angles = [fivebar.ik(xy + v * t + 0.5 * a * t * t, mode) for t in (-h, 0.0, h)]
        angles = np.unwrap(angles, axis=0)
        rate = (angles[2] - angles[0]) / (2 * h)
        turn = (angles[2] - 2 * angles[1] + angles[0]) / h**2
        scale = np.abs(rate).max() + 1.0
        np.testing.assert_allclose(fivebar.jacobian(xy, mode) @ v, rate, atol=1e-7 * scale**3)
        np.testing.assert_allclose(fivebar.joint_rates(xy, v, mode), rate, atol=1e-7 * scale**3)
        exact = fivebar.jacobian(xy, mode) @ a + fivebar.acceleration_bias(xy, v, mode)
        np.testing.assert_allclose(exact, turn, atol=2e-5 * scale**4)
        np.testing.assert_allclose(
            fivebar.joint_accelerations(xy, v, a, mode), exact, rtol=1e-13, atol=1e-13
        )


def test_isotropic_preset():
    xy = np.array([0.0, -0.8 / np.sqrt(2.0)])
    assert abs(ISOTROPIC.e - 0.2 / np.sqrt(2.0)) < 1e-16
    assert abs(np.linalg.cond(ISOTROPIC.jacobian(xy)) - 1.0) < 1e-12
    assert abs(ISOTROPIC.condition_number(xy) - 1.0) < 1e-12
    theta = ISOTROPIC.ik(xy)
    np.testing.assert_allclose(theta, [-np.pi / 4, -3 * np.pi / 4], atol=1e-15)
    np.testing.assert_allclose(np.abs(bars(ISOTROPIC, theta, xy)[0]), 1.0, atol=1e-15)


def test_one_point_and_many_give_the_same(rng):
    fivebar = random_fivebar(rng)
    mode = (-1, 1)
    points, count = [], 0
    while count < 40:
        xy, found, _ = random_state(fivebar, rng)
        if found == mode:
            points.append(xy)
            count += 1
    points = np.array(points)
    v, a = rng.uniform(-1, 1, (2, 40, 2))
    calls = {
        "ik": lambda p, v, a: fivebar.ik(p, mode),
        "jacobian": lambda p, v, a: fivebar.jacobian(p, mode),
        "bias": lambda p, v, a: fivebar.acceleration_bias(p, v, mode),
        "inverse": lambda p, v, a: fivebar.inverse_dynamics(p, v, a, mode),
        "mass": lambda p, v, a: fivebar.mass_matrix(p, mode),
        "forward": lambda p, v, a: fivebar.forward_dynamics(p, v, a, mode),
        "condition": lambda p, v, a: fivebar.condition_number(p, mode),
    }
    for name, call in calls.items():
        many = call(points, v, a)
        one = np.array([call(*row) for row in zip(points, v, a, strict=True)])
        assert many.shape == one.shape, name
        np.testing.assert_allclose(many, one, rtol=1e-12, atol=1e-12, err_msg=name)
    theta = fivebar.ik(points, mode)
    np.testing.assert_array_equal(fivebar.fk(theta)[3], fivebar.fk(theta[3]))
    assert fivebar.ik(np.empty((0, 2))).shape == (0, 2)


def test_masked_rows_are_the_unreachable_and_the_singular():
    points = np.array([[0.0, -0.5], [0.0, -3.0], [0.0, -0.6]])
    theta = ISOTROPIC.ik(points, on_unreachable="mask")
    assert isinstance(theta, np.ma.MaskedArray)
    assert theta.mask.all(axis=1).tolist() == [False, True, False]
    np.testing.assert_array_equal(theta[2], ISOTROPIC.ik(points[2]))
    assert np.isfinite(theta.data).all()
    edge = np.array([[ISOTROPIC.e + 0.8 * np.cos(-1.9), 0.8 * np.sin(-1.9)], [0.0, -0.5]])
    jacobian = ISOTROPIC.jacobian(edge, on_unreachable="mask")
    assert jacobian.mask[0].all() and not jacobian.mask[1].any()
    open_loop = ISOTROPIC.fk([[0.0, np.pi], [-0.5, -2.5]], on_unreachable="mask")
    assert open_loop.mask[:, 0].tolist() == [False, False]
    wide = kl.FiveBar(0.3, 0.3, 0.2)
    assert wide.fk([[0.0, np.pi]], on_unreachable="mask").mask.all()


def test_type_one_refuses_rates_and_names_the_leg():
    edge = [ISOTROPIC.e + 0.8 * np.cos(-1.9), 0.8 * np.sin(-1.9)]
    with pytest.raises(SingularError, match=r"type I\).*leg 1"):
        ISOTROPIC.jacobian(edge)
    assert np.isfinite(ISOTROPIC.ik(edge)).all()
    assert np.isfinite(ISOTROPIC.mass_matrix(edge)).all()


def test_type_two_refuses_torques():
    fivebar = kl.FiveBar(0.09, 0.09, 0.059, payload=1.0)
    tool = [0.0, np.sqrt(0.09**2 - (0.09 - 0.059) ** 2)]  # both rods along x, stretched
    with pytest.raises(SingularError, match="type II"):
        fivebar.inverse_dynamics(tool, [0, 0], [0, 0], (1, -1))
    assert np.isfinite(fivebar.jacobian(tool, (1, -1))).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"l1": 0.0}, "l1 of leg 1 is 0; it must be positive"),
        ({"l2": (0.5, -0.1)}, "l2 of leg 2 is -0.1"),
        ({"l1": (0.3, 0.3, 0.3)}, "one number or a pair"),
        ({"e": -0.1}, "e is -0.1; it must be >= 0"),
        ({"e": np.nan}, "e: nan"),
        ({"e": 0.9}, "cannot close and move: base 2e is 1.8 m long"),
        ({"l1": (2.0, 0.3)}, "cannot close and move: crank 1"),
        ({"crank_mass": (1.0, -1.0)}, "crank_mass of leg 2 is -1; it must be >= 0"),
        ({"rod_inertia": -1e-9}, "rod_inertia of leg 1"),
        ({"payload": -1}, "payload is -1"),
        ({"gear_ratio": 0}, "gear_ratio of leg 1 is 0; it must be positive"),
        ({"gravity": (0, 0, -9.81)}, "gravity: shape"),
        ({"rod_com": "half"}, "rod_com: dtype"),
    ],
)
def test_impossible_linkages_are_refused(change, message):
    with pytest.raises(MechanismError, match=message.replace("(", r"\(")):
        kl.FiveBar(**{"l1": 0.3, "l2": 0.5, "e": 0.1, **change})


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda f: f.ik([0, -2.0]), UnreachableError, "point 0 at .*too far for leg 1"),
        (lambda f: f.ik([[0, -0.5], [0.1, 0]]), UnreachableError, "1 of 2 points"),
        (lambda f: f.fk([0.0, np.pi, 1.0]), StateError, "theta has shape"),
        (lambda f: f.ik([0, -0.5], (1, 0)), OptionError, r"mode \(1, 0\) does not exist"),
        (lambda f: f.ik([0, -0.5], 1), OptionError, "mode 1 does not exist"),
        (lambda f: f.fk([0, 1], 2), OptionError, "assembly 2 does not exist"),
        (lambda f: f.ik([np.nan, 0]), StateError, "must be finite"),
        (lambda f: f.ik([[1, 2, 3]]), StateError, r"expected \(2,\) or \(N, 2\)"),
        (lambda f: f.ik([0, -0.5], on_unreachable="nan"), OptionError, "on_unreachable"),
        (lambda f: f.acceleration_bias([[0, -0.5]] * 3, [[1, 0]] * 2), StateError, "2 rows"),
        (lambda f: f.inverse_dynamics([0, -0.5], [0, 0], [0, 0], model="exct"), OptionError,
         "did you mean 'exact'"),
    ],
)  # fmt: skip
def test_bad_input_is_named(call, error, message):
    with pytest.raises(error, match=message):
        call(ISOTROPIC)


def test_elbows_in_one_place_leave_the_tool_undetermined():
    coaxial = kl.FiveBar(0.1, 0.2, 0.0)
    with pytest.raises(UnreachableError, match="elbows coincide"):
        coaxial.fk([0.3, 0.3])


def test_base_pin_of_equal_bars_is_not_a_pose():
    fivebar = kl.FiveBar(0.09, 0.09, 0.03)
    assert not fivebar.reachable([0.03, 0.0])
    with pytest.raises(UnreachableError, match="base pin of leg 1"):
        fivebar.ik([0.03, 0.0])


def test_frozen_and_comparable():
    one, two = kl.FiveBar(0.3, 0.5, 0.1), kl.FiveBar((0.3, 0.3), 0.5, 0.1)
    assert one == two and hash(one) == hash(two) and one != kl.FiveBar(0.3, 0.5, 0.11)
    with pytest.raises(AttributeError):
        one.e = 0.2
    with pytest.raises(ValueError, match="read-only"):
        one.l1[0] = 1.0


def test_methods_are_the_documented_functions():
    """Every public method has its docstring with its arguments' names, in help() and in dir()."""
    methods = [
        n
        for n in dir(kl.FiveBar)
        if not n.startswith("_") and callable(getattr(kl.FiveBar, n, None))
    ]
    fixed = "ik fk jacobian acceleration_bias inverse_dynamics mass_matrix closed_chain size_servo load save"
    assert set(fixed.split()) < set(methods)
    for name in methods:
        assert inspect.getdoc(getattr(kl.FiveBar, name)), name
    assert list(inspect.signature(ISOTROPIC.ik).parameters) == ["xy", "mode", "on_unreachable"]
    given = inspect.signature(kl.FiveBar).parameters
    needed = [name for name, parameter in given.items() if parameter.default is parameter.empty]
    assert needed == ["l1", "l2", "e"] and given["gear_ratio"].default == 1.0
    with pytest.raises(TypeError, match="e"):
        kl.FiveBar(0.3, 0.5)


def test_copies_and_changes():
    changed = dataclasses.replace(ISOTROPIC, payload=2, rod_mass=(0.1, 0.2))
    assert changed.payload == 2.0 and changed.rod_mass.tolist() == [0.1, 0.2]
    np.testing.assert_array_equal(changed.l1, ISOTROPIC.l1)
    for same in (pickle.loads(pickle.dumps(ISOTROPIC)), copy.deepcopy(ISOTROPIC)):
        assert same == ISOTROPIC
        np.testing.assert_array_equal(same.ik([0.1, -0.5]), ISOTROPIC.ik([0.1, -0.5]))


def test_a_five_bar_introduces_itself():
    bar = kl.FiveBar((0.3, 0.26), 0.5, 0.1, crank_mass=1.0, name="mine")
    first, second = str(bar).splitlines()
    assert first == "five-bar mine: cranks 0.3 and 0.26 m, rods 0.5 m, base pins at x = ±0.1 m"
    assert second == "  cranks 1 kg, gravity [0, -9.81] m/s²"
    assert repr(bar) == "<FiveBar 'mine': l1 0.3 and 0.26, l2 0.5, e 0.1 m>"
    assert "rods 0.5 m" in bar._repr_html_()
    assert "no masses given" in str(kl.FiveBar(0.3, 0.5, 0.0))
