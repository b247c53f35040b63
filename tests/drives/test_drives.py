"""Motors, cycles, demand and fitting for any machine: written cases, a serial arm, plain sums."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.drives.cycles import pick_and_place
from kinlab.drives.demand import Demand
from kinlab.drives.fitting import Duty, fit_motor, fit_motors, stretch_to_motor
from kinlab.drives.motors import Motor, catalogue
from kinlab.errors import MotorError, OptionError, StateError

MOTOR = Motor("test", rated_torque=1.0, peak_torque=3.0, max_speed=3000, rotor_inertia=1e-4)


def demand(v, a, tau, rotor=0.0):
    """One joint, an instant a second."""
    v, a, tau = (np.array(x, dtype=float)[:, None] for x in (v, a, tau))
    return Demand(np.arange(len(v), dtype=float), 0 * v, v, a, tau, np.array([rotor]))


def test_shaft_torque_by_hand():
    """Gear 10, efficiency 0.5: 20 N m driven is 4 N m, and 1 N m when the load drives."""
    still = demand([1, 1], [0, 0], [20, -20]).at_motor(MOTOR, 10.0, 0.5)
    np.testing.assert_allclose(still[:, 0], [4.0, -4.0])
    # lowering: the weight of 20 N m is held by the losses while the rotor is sped up downward
    lowering = demand([-1, -1], [-5000, -5000], [20, 20])
    shaft = lowering.at_motor(MOTOR, 10.0, 0.5)[:, 0]
    np.testing.assert_allclose(shaft, 0.5 * 20 / 10 - 1e-4 * 10 * 5000)
    assert abs(shaft[0]) > abs(20 / 10 / 0.5 - 5.0)  # paying the losses would ask less
    inside = demand([1], [3], [20.6], rotor=0.2).at_motor(MOTOR, 10.0, 1.0)
    np.testing.assert_allclose(inside, (20.6 - 0.2 * 3) / 10 + 1e-4 * 10 * 3)


def test_no_direction_of_power_asks_more_than_the_bound():
    rng = np.random.default_rng(0)
    v, a, tau = rng.normal(size=(3, 5000)) * np.array([[3.0], [900.0], [20.0]])
    load, rotor = tau / 10, 1e-4 * 10 * a
    true = np.where(load * v > 0, load / 0.7, load * 0.7) + rotor
    bound = np.abs(demand(v, a, tau).at_motor(MOTOR, 10.0, 0.7)[:, 0])
    assert np.all(np.abs(true) <= bound * (1 + 1e-12))
    assert np.any(np.abs(true) > np.abs(load / 0.7 + rotor) * 1.01)  # the simple rule is no bound
    assert np.isclose(np.abs(true), bound).mean() > 0.5


def test_peaks_and_root_mean_squares():
    t = np.linspace(0.0, 2.0 * np.pi, 20001)[:, None]
    ride = Demand(t[:, 0], np.sin(t), np.cos(t), -np.sin(t), 3.0 * np.cos(t), np.zeros(1))
    np.testing.assert_allclose(ride.peak_torque, 3.0)
    np.testing.assert_allclose(ride.rms_torque, 3.0 / np.sqrt(2.0), rtol=1e-7)
    np.testing.assert_allclose(ride.peak_rate, 1.0)
    np.testing.assert_allclose(ride.peak_power, 3.0)
    np.testing.assert_allclose(ride.rms_power, 3.0 * np.sqrt(3.0 / 8.0), rtol=1e-7)


def arm_cycle(robot, time=1.0):
    """A smooth motion of all joints with the torques that Pinocchio gives it."""
    t = np.linspace(0.0, time, 801)
    w = 2.0 * np.pi / time
    size = np.linspace(0.2, 0.6, robot.n)
    q, v, a = (
        np.outer(f, size) for f in (np.sin(w * t), w * np.cos(w * t), -(w**2) * np.sin(w * t))
    )
    return Demand(t, q, v, a, kl.inverse_dynamics(robot, q, v, a), np.zeros(robot.n))


def test_a_motor_for_a_serial_arm():
    cycle = arm_cycle(kl.load("planar2r"))
    duty = Duty.of_cycle(cycle, load_inertia=1.0, efficiency=0.8)
    fit = fit_motor(duty, catalogue()["SGMAH-08A"])
    shaft = cycle.at_motor(fit.motor, fit.gear_ratio, 0.8)
    assert fit.peak == np.abs(shaft).max()
    assert fit.speed == pytest.approx(fit.gear_ratio * np.abs(cycle.v).max() * 30 / np.pi)
    mean = np.sqrt(np.mean(shaft[:-1] ** 2, axis=0)).max()  # a whole period
    assert fit.rms == pytest.approx(mean, rel=1e-3)
    for other in np.geomspace(0.3, 1.0, 40) * fit.gear_ratio_bound:
        assert fit_motor(duty, fit.motor, other).margin <= fit.margin * 1.001
    fits = fit_motors(duty, list(catalogue().values()))
    assert [f.fits for f in fits] == sorted((f.fits for f in fits), reverse=True)


def test_a_serial_arm_as_fast_as_its_motor():
    robot, motor = (
        kl.load("planar2r"),
        Motor("m", peak_torque=80.0, max_speed=6000, rotor_inertia=1e-3),
    )
    moving = arm_cycle(robot)
    still = np.zeros_like(moving.q)
    held = Demand(
        moving.t, moving.q, still, still, kl.gravity_torques(robot, moving.q), np.zeros(robot.n)
    )
    factor = stretch_to_motor(moving, held, motor, 2.0, 0.8, "arm")
    again = arm_cycle(robot, factor)  # the same places, later
    use = max(
        np.abs(again.at_motor(motor, 2.0, 0.8)).max() / 80.0,
        2.0 * again.peak_rate.max() * 30 / np.pi / 6000,
    )
    assert use == pytest.approx(1.0, abs=1e-9)
    with pytest.raises(MotorError, match="cannot hold arm"):
        stretch_to_motor(moving, held, Motor("w", peak_torque=1e-3, max_speed=1, rotor_inertia=1e-3),
                         2.0, 0.8, "arm")  # fmt: skip


def test_the_cycle_in_space_is_the_one_of_the_plane():
    flat = pick_and_place([0.1, 0.2], 2.0, 30.0, samples=501)
    across, up = np.array([0.6, 0.8, 0.0]), np.array([0.0, 0.0, 1.0])
    centre = np.array([0.3, 0.1, 0.5])
    path = pick_and_place(centre, 2.0, 30.0, samples=501, across=across, up=up)
    np.testing.assert_allclose(path.t, flat.t)
    for mine, plane in (
        (path.points - centre, flat.points - [0.1, 0.2]),
        (path.v, flat.v),
        (path.a, flat.a),
    ):
        np.testing.assert_allclose(mine @ across, plane[:, 0], atol=1e-12)
        np.testing.assert_allclose(mine @ up, plane[:, 1], atol=1e-12)
        np.testing.assert_allclose(mine @ np.cross(across, up), 0.0, atol=1e-12)
    with pytest.raises(OptionError, match="right angles"):
        pick_and_place(centre, 2.0, 30.0, across=(1, 0, 0), up=(1, 0, 0))
    with pytest.raises(StateError, match="centre"):
        pick_and_place([0.0, 0.0], 2.0, 30.0, across=across, up=up)
    held = path.held
    assert not held.v.any() and not held.a.any()
    np.testing.assert_array_equal(held.points, path.points)
