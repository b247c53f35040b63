"""Servo sizing, motors and the pick-and-place cycle against brute force and plain integrals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kinlab as kl
from kinlab.drives.cycles import pick_and_place
from kinlab.drives.gears import Gearbox
from kinlab.drives.motors import Motor, catalogue, read_motors
from kinlab.errors import (
    FileError,
    MotorError,
    NameUnknownError,
    OptionError,
    SingularError,
    UnreachableError,
)

ISOTROPIC = kl.FiveBar.load("isotropic")
UNEQUAL = kl.FiveBar.load("unequal")
BOX = (-0.2, 0.15, -0.65, -0.5)
SPEED, ACCELERATION = 3.0, 60.0


def rim(rng, count, size):
    phi = rng.uniform(-np.pi, np.pi, count)
    return size * np.stack([np.cos(phi), np.sin(phi)], axis=1)


def brute(fivebar, quantity, count=200_000):
    """Largest |quantity(xy, v, a)| over random places and directions, v inside the disc too."""
    rng = np.random.default_rng(0)
    xy = np.stack([rng.uniform(*BOX[:2], count), rng.uniform(*BOX[2:], count)], axis=1)
    corners = rng.integers(0, 2, (count, 2))
    sides = np.array([BOX[:2], BOX[2:]])
    push = rng.uniform(0, 1, (count, 2)) < 0.6  # the worst place is mostly at a corner or an edge
    xy = np.where(push, sides[[0, 1], corners], xy)
    v = rim(rng, count, SPEED) * rng.integers(0, 2, count)[:, None]
    return np.abs(quantity(xy, v, rim(rng, count, ACCELERATION))).max(axis=0)


@pytest.mark.parametrize("fivebar", [ISOTROPIC, UNEQUAL], ids=["isotropic", "unequal"])
def test_worst_case_is_an_upper_bound_that_is_reached(fivebar):
    """No random motion exceeds it, and the worst of 200,000 comes within 2 %."""
    sizing = fivebar.size_servo(BOX, SPEED, ACCELERATION, motor="SGMAH-08A", efficiency=1.0)
    rotorless = replace(fivebar, rotor_inertia=0.0)
    pairs = {
        "rate": (sizing.rate.value, lambda xy, v, a: fivebar.joint_rates(xy, v)),
        "torque": (sizing.torque.value, fivebar.inverse_dynamics),
        "note": (
            sizing.torque_note.value,
            lambda xy, v, a: (
                rotorless.inverse_dynamics(xy, 0 * v, a, model="massless")
                - rotorless.inverse_dynamics(xy, 0 * v, 0 * a, model="massless")
            ),
        ),
    }
    for name, (found, quantity) in pairs.items():
        worst = brute(fivebar, quantity)
        assert np.all(worst <= found * (1 + 1e-12)), name
        assert np.all(worst >= 0.98 * found), name
    inertia = np.diagonal(rotorless.mass_matrix(np.array(sizing.load_inertia.place)), axis1=1,
                          axis2=2)  # fmt: skip
    np.testing.assert_allclose(np.diag(inertia), sizing.load_inertia.value, rtol=1e-12)


def test_motor_torque_has_rotor_and_efficiency():
    sizing = UNEQUAL.size_servo(BOX, SPEED, ACCELERATION, "SGMAH-08A", gear_ratio=20.0)
    (fit,) = sizing.fits
    rotorless = replace(UNEQUAL, rotor_inertia=0.0)

    def at_motor(xy, v, a):
        turn = UNEQUAL.joint_accelerations(xy, v, a)
        return rotorless.inverse_dynamics(xy, v, a) / (20 * 0.9) + 0.672e-4 * 20 * turn

    worst = brute(UNEQUAL, at_motor).max()
    assert 0.98 * fit.peak <= worst <= fit.peak * (1 + 1e-12)
    assert fit.speed == pytest.approx(20 * sizing.rate.largest * 30 / np.pi)
    assert fit.gear_ratio_bound == pytest.approx(np.pi * 5000 / (30 * sizing.rate.largest))
    assert fit.inertia_range[1] == pytest.approx(sizing.load_inertia.largest / 400)
    assert fit.inertia_range[0] == pytest.approx(fit.inertia_range[1] / 3)
    assert fit.margins["peak torque"] == pytest.approx(7.16 / fit.peak)
    assert fit.limit == min(fit.margins, key=fit.margins.get) and fit.limits == (fit.limit,)


def test_torque_at_the_shaft_along_a_cycle():
    """The load through the gear, paying the losses or held by them, and the rotor beside it."""
    motor = catalogue()["SGMAH-08A"]
    path = pick_and_place([0.0, -0.6], 2.0, 30.0)
    cycle = UNEQUAL.follow(path)
    load = replace(UNEQUAL, rotor_inertia=0.0).inverse_dynamics(path.points, path.v, path.a) / 20.0
    rotor = 0.672e-4 * 20.0 * UNEQUAL.joint_accelerations(path.points, path.v, path.a)
    driving, driven = load / 0.8 + rotor, load * 0.8 + rotor
    expected = np.where(abs(driving) >= abs(driven), driving, driven)
    found = cycle.at_motor(motor, 20.0, 0.8)
    np.testing.assert_allclose(found, expected, atol=1e-12)
    np.testing.assert_allclose(cycle.at_motor(motor, 20.0, 1.0), load + rotor, atol=1e-12)
    (fit,) = UNEQUAL.size_servo(BOX, 2.0, 30.0, motor, 20.0, efficiency=0.8).fits
    assert fit.rms < fit.peak


@pytest.mark.parametrize("efficiency", [0.9, 0.6])
def test_no_direction_of_power_exceeds_the_peak(efficiency):
    """The gear divides the load by its efficiency where the motor drives, else multiplies it."""
    (fit,) = UNEQUAL.size_servo(
        BOX, SPEED, ACCELERATION, "SGMAH-08A", 20.0, (-1, 1), efficiency
    ).fits
    rotorless = replace(UNEQUAL, rotor_inertia=0.0)

    def at_motor(xy, v, a):
        load = rotorless.inverse_dynamics(xy, v, a)
        drives = load * UNEQUAL.joint_rates(xy, v) > 0
        share = np.where(drives, 1.0 / efficiency, efficiency)
        return share * load / 20 + 0.672e-4 * 20 * UNEQUAL.joint_accelerations(xy, v, a)

    worst = brute(UNEQUAL, at_motor).max()
    assert 0.95 * fit.peak <= worst <= fit.peak * (1 + 1e-12)


def test_fits_are_ordered_as_documented():
    """Those that fit by their peak torque, the smallest first; then the nearest to fitting."""
    fits = ISOTROPIC.size_servo(BOX, SPEED, ACCELERATION).fits
    good = [fit for fit in fits if fit.fits]
    assert good and list(fits[: len(good)]) == good
    sizes = [fit.motor.peak_torque for fit in good]
    margins = [fit.margin for fit in fits[len(good) :]]
    assert sizes == sorted(sizes) and margins == sorted(margins, reverse=True)
    assert len(margins) > 1


def test_the_ratio_has_the_largest_least_margin_not_the_least_torque():
    """What is maximised, on a scan of ratios; the ratio of least peak torque is another one."""
    (fit,) = ISOTROPIC.size_servo(BOX, SPEED, ACCELERATION, "SGMAH-08A").fits
    ratios = np.geomspace(0.25, 1.0, 25) * fit.gear_ratio_bound
    gears = [Gearbox(f"j = {j:.4g}", float(j), efficiency=0.9) for j in ratios]
    scan = ISOTROPIC.size_servo(BOX, SPEED, ACCELERATION, "SGMAH-08A", gears=gears).fits
    assert len(scan) == 25
    assert max(each.margin for each in scan) <= fit.margin * 1.001
    least = min(scan, key=lambda each: each.peak)
    assert least.peak < 0.99 * fit.peak and least.margin < 0.99 * fit.margin


def test_the_notes_torque_is_too_small():
    sizing = ISOTROPIC.size_servo(BOX, SPEED, ACCELERATION, motor="SGMAH-08A")
    assert sizing.torque_note.largest < 0.75 * sizing.torque.largest


def test_eta_is_the_payload_over_the_arm_and_places_the_best_sigma():
    sizing = ISOTROPIC.size_servo(BOX, SPEED, ACCELERATION, motor="SGMAH-08A")
    arm = 1.0 * 0.3**2 / 12 + 1.0 * 0.15**2
    np.testing.assert_allclose(sizing.eta, 1.0 / arm)
    sigma = np.linspace(0.1, 20, 20001)
    best = sigma[np.argmin(arm * sigma + 1.0 / sigma)]
    assert abs(best - np.sqrt(sizing.eta[0])) < 1e-3
    assert sizing.sigma[0] <= 10 / 3 <= sizing.sigma[1]


def test_catalogue_and_short_list():
    motors = catalogue()
    assert len(motors) >= 10
    for motor in motors.values():
        assert motor.maker and motor.data_sheet
        # a sheet's figures hang together: rated power is rated torque times rated speed
        power = motor.rated_torque * motor.rated_speed * np.pi / 30
        assert abs(power / motor.rated_power - 1) < 0.06, motor.name
        assert motor.peak_torque > motor.rated_torque and motor.max_speed >= motor.rated_speed
    sizing = ISOTROPIC.size_servo(BOX, SPEED, ACCELERATION)
    assert len(sizing.fits) == len(motors)
    assert 0 < len(sizing.short_list) < len(motors)
    for fit in sizing.fits:
        assert fit.fits == (min(fit.margins.values()) >= 1)
        assert fit.gear_ratio <= fit.gear_ratio_bound * (1 + 1e-12)
        # the ratio taken is the best: neighbours have a smaller least margin
        for other in (0.8, 1.25):
            near = ISOTROPIC.size_servo(
                BOX, SPEED, ACCELERATION, fit.motor, gear_ratio=other * fit.gear_ratio
            )
            assert near.fits[0].margin < fit.margin * 1.001
        if len(sizing.fits) > 4 and fit is sizing.fits[2]:
            break


def test_cycle_goes_where_it_should_within_its_limits():
    path = pick_and_place([0.02, -0.6], 2.0, 30.0, samples=20001)
    xy = path.points
    np.testing.assert_allclose(xy[0], [0.02 - 0.1525, -0.6])
    np.testing.assert_allclose(xy[-1], xy[0], atol=1e-15)
    np.testing.assert_allclose(xy[10000], [0.02 + 0.1525, -0.6], atol=1e-12)
    np.testing.assert_allclose(np.ptp(xy, axis=0), [0.305, 0.025], atol=1e-9)
    speed, push = (np.linalg.norm(x, axis=1).max() for x in (path.v, path.a))
    assert max(speed / 2.0, push / 30.0) == pytest.approx(1.0, abs=1e-4)
    h = path.t[1]
    for value, rate in ((xy, path.v), (path.v, path.a)):
        slope = (value[2:] - value[:-2]) / (2 * h)
        # a difference across a jump of the jerk is off by half of it times h
        np.testing.assert_allclose(slope, rate[1:-1], atol=4e-3 * np.abs(rate).max())
    for k in (0, 10000, 20000):
        assert np.all(np.abs(path.v[k]) < 1e-9) and np.all(np.abs(path.a[k]) < 1e-6)


def test_blending_rounds_corners_and_saves_time():
    sharp, round_ = (pick_and_place([0, -0.6], 2.0, 30.0, blend=b) for b in (0.0, 0.8))
    assert round_.duration < sharp.duration

    def corner(path):
        return np.min(np.linalg.norm(path.points - [-0.1525, -0.575], axis=1))

    assert corner(sharp) < 1e-8 < 1e-3 < corner(round_)


def test_power_integrates_to_nothing_over_a_cycle():
    """There and back to rest: the motors' work is zero without friction."""
    cycle = UNEQUAL.follow(pick_and_place([0.0, -0.6], 2.0, 30.0))
    work = np.trapezoid(cycle.power.sum(axis=1), cycle.t)
    through = np.trapezoid(np.abs(cycle.power).sum(axis=1), cycle.t)
    assert abs(work) < 1e-6 * through
    assert np.all(cycle.rms_torque <= cycle.peak_torque)
    np.testing.assert_allclose(cycle.power, cycle.tau * cycle.v)
    h = cycle.t[1]
    slope = (cycle.q[2:] - cycle.q[:-2]) / (2 * h)
    np.testing.assert_allclose(slope, cycle.v[1:-1], atol=2e-3)


def test_cycle_stretched_to_a_motor_reaches_its_limit():
    motor = catalogue()["SGMAH-02A"]
    path = pick_and_place([0.0, -0.6], 4.0, 100.0)
    fitted = ISOTROPIC.fit_to_motor(path, motor, gear_ratio=30.0)
    cycle = ISOTROPIC.follow(fitted)
    torque = np.abs(cycle.at_motor(motor, 30.0, 0.9)).max()
    speed = 30.0 * np.abs(cycle.v).max() * 30 / np.pi
    assert max(torque / motor.peak_torque, speed / motor.max_speed) == pytest.approx(1.0, abs=1e-9)
    assert torque <= motor.peak_torque * (1 + 1e-9) and speed <= motor.max_speed * (1 + 1e-9)
    with pytest.raises(MotorError, match="cannot hold"):
        ISOTROPIC.fit_to_motor(path, catalogue()["SGMAH-A3A"], gear_ratio=2.0)


def test_a_path_that_cannot_be_followed_is_refused_with_its_place():
    with pytest.raises(UnreachableError, match=r"t = .* s, \(.*\) m, leaves the workspace"):
        ISOTROPIC.follow(pick_and_place([0.0, -0.78], 2.0, 30.0))
    with pytest.raises(SingularError, match="type I: .*leg"):
        ISOTROPIC.follow(pick_and_place([0.0, -0.78648], 2.0, 30.0, travel=0.01))
    small = kl.FiveBar.load("equal_links")
    with pytest.raises(SingularError, match="type II"):
        small.follow(pick_and_place([0.0, 0.0745], 1.0, 10.0, lift=0.02, travel=0.02), (1, -1))


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: ISOTROPIC.size_servo((0, 0.1, -0.6), 1, 1), OptionError, "x_min, x_max"),
        (lambda: ISOTROPIC.size_servo((0.1, 0, -0.6, -0.5), 1, 1), OptionError, "is empty"),
        (lambda: ISOTROPIC.size_servo(BOX, 0, 1), OptionError, "v_max is 0"),
        (lambda: ISOTROPIC.size_servo(BOX, 1, np.inf), OptionError, "a_max is inf"),
        (lambda: ISOTROPIC.size_servo(BOX, 1, 1, efficiency=1.2), OptionError, "efficiency"),
        (lambda: ISOTROPIC.size_servo(BOX, 1, 1, gear_ratio=-2), OptionError, "gear_ratio"),
        (lambda: ISOTROPIC.size_servo(BOX, 1, 1, "SGMAH-2A"), NameUnknownError, "SGMAH-02A"),
        (lambda: ISOTROPIC.size_servo((-0.1, 0.1, -0.9, -0.6), 1, 1), UnreachableError, "too far"),
        (lambda: ISOTROPIC.size_servo((-0.1, 0.1, -0.5, 0.5), 1, 1), (SingularError,
         UnreachableError), "isotropic"),
        (lambda: ISOTROPIC.size_servo(BOX, 1, 1, Motor("bare", max_speed=3000)), MotorError,
         "'bare' states no peak_torque"),
        (lambda: Motor("odd", rotor_inertia=-1.0), MotorError, "rotor_inertia is -1.0"),
        (lambda: Motor("odd", max_speed="fast"), MotorError, "max_speed is 'fast'"),
        (lambda: pick_and_place([0, 0], 1, 1, blend=2), OptionError, "blend is 2"),
        (lambda: pick_and_place([0, 0], -1, 1), OptionError, "v_max is -1"),
    ],
)  # fmt: skip
def test_bad_input(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_motor_files(tmp_path):
    file = tmp_path / "motors.toml"
    with pytest.raises(FileError, match="no such file"):
        read_motors(file)
    for text, message in [
        ("motors = 3", r"no \[\[motors\]\]"),
        ("[[motors]]\nmaker = 'A'", "motor 1: name is missing"),
        ("[[motors]]\nname = 'A'\npeak = 3", "did you mean 'peak_torque'"),
        ("[[motors]]\nname = 'A'\n[[motors]]\nname = 'A'", "motor 2: the name 'A' is used twice"),
        ("[[motors", "not TOML"),
    ]:
        file.write_text(text, encoding="utf-8")
        with pytest.raises(MotorError, match=message):
            read_motors(file)


def test_presets_load_and_round_trip(tmp_path):
    from kinlab.errors import MechanismError
    from kinlab.fivebar.files import presets

    names = set(presets())
    assert {"isotropic", "minitaur_leg", "doggo_leg", "plotclock", "equal_links"} <= names
    for name in names:
        fivebar = kl.FiveBar.load(name)
        assert fivebar.source and fivebar.name == name
        fivebar.save(tmp_path / "copy.toml")
        assert kl.FiveBar.load(tmp_path / "copy.toml") == fivebar
    with pytest.raises(NameUnknownError, match="did you mean 'isotropic'"):
        kl.FiveBar.load("isotropc")
    for text, message in [
        ("l1 = 0.3\nl2 = 0.5", "key 'e' is missing"),
        ("l1 = 0.3\nl2 = 0.5\ne = 0.1\nload = 3", "key 'load' is unknown; did you mean 'payload'"),
        ("l1 = 'half'\nl2 = 0.5\ne = 0.1", "l1: cannot read 'half'"),
        ("l1 = [", "not TOML"),
        ("l1 = 0.3\nl2 = 0.5\ne = 0.1\nname = 3", "name must be text"),
        ("l1 = [0.3, -1]\nl2 = 0.5\ne = 0.1", "l1 of leg 2 is -1"),
        ("l1 = [0.3, 0.3, 0.3]\nl2 = 0.5\ne = 0.1", "l1 is a list of 3; a list holds two numbers"),
    ]:
        (tmp_path / "bad.toml").write_text(text, encoding="utf-8")
        with pytest.raises(MechanismError, match=message):
            kl.FiveBar.load(tmp_path / "bad.toml")
