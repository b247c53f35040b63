"""Motors behind gearboxes that can be bought: by hand, by a dense integral, and files of one's own."""

from __future__ import annotations

import numpy as np
import pytest

from kinlab.drives.demand import Demand
from kinlab.drives.fitting import Duty, fit_drives
from kinlab.drives.gears import Drive, Gearbox, find_gear, gears_of, read_gears
from kinlab.drives.motors import Motor, find_motor, motors_of, read_motors
from kinlab.errors import FileError, MotorError, NameUnknownError, OptionError

MOTOR = Motor("M", rated_torque=1.0, peak_torque=3.0, max_speed=3000, rotor_inertia=1e-4)
GEAR = Gearbox("G", 10.0, 0.8, 2e-5, nominal_torque=12.0, peak_torque=30.0, max_speed=4000,
               rated_speed=2500, back_efficiency=0.6)  # fmt: skip


def ride(samples=4001, weight=4.0, swing=7.0):
    """A joint that swings sinusoidally, with a weight that always pulls one way."""
    t = np.linspace(0.0, 2.0, samples)[:, None]
    w = np.pi
    q, v, a = np.sin(w * t), w * np.cos(w * t), -(w**2) * np.sin(w * t)
    return Demand(t[:, 0], q, v, a, weight + swing / w**2 * a + 0.3 * v, np.zeros(1))


def by_hand(t):
    """The shaft's torque of the same ride from the formulas, at any instant."""
    w = np.pi
    v, a = w * np.cos(w * t), -(w**2) * np.sin(w * t)
    load = 4.0 + 7.0 / w**2 * a + 0.3 * v
    return np.where(load * v > 0, load / 0.8, load * 0.6) / 10.0 + 1.2e-4 * 10.0 * a


def test_shaft_torque_goes_by_the_direction_of_power():
    cycle, drive = ride(), Drive(MOTOR, GEAR)
    at = np.abs(cycle.v[:, 0]) > 1e-6
    found = cycle.at_shaft(drive)[at, 0]
    np.testing.assert_allclose(found, by_hand(cycle.t[at]), rtol=0, atol=1e-12)
    assert np.all(np.abs(cycle.at_shaft(drive)) <= np.abs(cycle.bound_at(drive)) + 1e-12)
    assert drive.reflected_inertia == pytest.approx(100 * 1.2e-4)


def test_rms_at_the_shaft_is_that_of_a_dense_integral():
    """The load's share jumps where the joint turns back, at 0.5 and 1.5 s, between two samples."""
    t = (np.arange(2_000_000) + 0.5) * 1e-6
    dense = np.sqrt(np.mean(by_hand(t) ** 2))
    for samples in (4000, 4001):
        (found,) = ride(samples).rms_at_shaft(Drive(MOTOR, GEAR))
        assert found == pytest.approx(dense, rel=1e-6)


def test_every_limit_of_the_pair_is_judged():
    cycle = ride()
    duty = Duty.of_cycle(cycle.axis(0), load_inertia=0.7)
    (fit,) = fit_drives(duty, [MOTOR], [GEAR])
    t = (np.arange(200_000) + 0.5) * 1e-5
    v, a = np.pi * np.cos(np.pi * t), -(np.pi**2) * np.sin(np.pi * t)
    load = np.abs(4.0 + 7.0 / np.pi**2 * a + 0.3 * v)
    cubic = (np.sum(abs(v) * load**3) / np.sum(abs(v))) ** (1 / 3)
    expected = {
        "max speed": (np.pi * 10 * 30 / np.pi, 3000),
        "gear peak torque": (load.max(), 30),
        "gear mean torque": (max(cubic, np.sqrt(np.mean(load**2))), 12),
        "gear max speed": (np.pi * 10 * 30 / np.pi, 4000),
        "gear mean speed": (2.0 * 10 * 30 / np.pi, 2500),
    }
    checks = {check.name: check for check in fit.checks}
    for name, (asked, allowed) in expected.items():
        assert checks[name].asked == pytest.approx(asked, rel=1e-4), name
        assert checks[name].allowed == allowed
    assert fit.inertia_ratio == pytest.approx(0.7 / 100 / 1.2e-4)
    assert fit.fits and not fit.failed and not fit.unstated


def test_a_pair_that_fails_says_by_which_limit():
    duty = Duty.of_cycle(ride(), load_inertia=0.7)
    weak = Gearbox("weak", 10.0, 0.8, peak_torque=8.0, max_speed=200.0)
    slow = Motor("slow", rated_torque=1.0, peak_torque=3.0, max_speed=100, rotor_inertia=1e-4)
    fits = fit_drives(duty, [slow, MOTOR], [weak, GEAR])
    assert [(f.motor.name, f.gear.name) for f in fits if f.fits] == [("M", "G")]
    margins = [f.margin for f in fits[1:]]
    assert margins == sorted(margins, reverse=True)
    failed = {(f.motor.name, f.gear.name): [c.name for c in f.failed] for f in fits}
    assert failed["M", "weak"] == ["gear max speed", "gear peak torque"]
    assert failed["slow", "G"] == ["max speed"]
    assert "gear peak torque 11.1 of 8 N m" in [str(c) for c in fits[-1].failed + fits[1].failed]
    assert fits[1].unstated == ("nominal_torque", "rated_speed")


def test_catalogues_in_toml_and_csv_are_the_same(tmp_path):
    toml, motors, gears = tmp_path / "own.toml", tmp_path / "m.csv", tmp_path / "g.csv"
    toml.write_text(
        "[[motors]]\nname = 'A'\nrated_torque = 1.3\npeak_torque = 3.8\nmax_speed = 5000\n"
        "rotor_inertia = '0.375e-4'\n"
        "[[gears]]\nname = 'G10'\nratio = 10\nefficiency = 0.94\ninertia = 1e-5\n"
        "nominal_torque = 20\npeak_torque = 40\nmax_speed = 6000\n",
        encoding="utf-8",
    )
    motors.write_text(
        "name; rated_torque; peak_torque; max_speed; rotor_inertia; maker\n"
        "A; 1.3; 3.8; 5000; 0.375e-4;\n\n", encoding="utf-8",
    )  # fmt: skip
    gears.write_text(
        "\ufeffname,ratio,efficiency,inertia,nominal_torque,peak_torque,max_speed\r\n"
        "G10,10,0.94,1e-5,20,40,6000\r\n", encoding="utf-8",
    )  # fmt: skip
    assert read_motors(toml) == read_motors(motors) == {
        "A": Motor("A", rated_torque=1.3, peak_torque=3.8, max_speed=5000, rotor_inertia=0.375e-4)
    }  # fmt: skip
    assert read_gears(toml) == read_gears(gears)
    assert read_gears(gears)["G10"].shares == (1 / 0.94, 0.94)
    assert motors_of(toml)[0] is not None and gears_of(gears)[0].ratio == 10
    assert find_gear("G10", gears_of(toml)).ratio == 10
    assert find_motor("A", read_motors(toml)).max_speed == 5000


GOOD = "name,ratio,efficiency,inertia,nominal_torque,peak_torque,max_speed\n"


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("g.csv", GOOD + "A,10,1.4,0,1,2,3", "efficiency is 1.4; it is a part"),
        ("g.csv", GOOD + "A,-10,0.9,0,1,2,3", "ratio is -10.0; it must be a positive"),
        ("g.csv", GOOD + "A,ten,0.9,0,1,2,3", r"gear 1 \(A\): ratio: cannot read 'ten'"),
        ("g.csv", GOOD + "A,10,0.9,0,9,2,3", "nominal_torque is 9 and peak_torque 2"),
        ("g.csv", GOOD + "A,10,0.9,0,1,2,3\nA,10,0.9,0,1,2,3", "gear 2: the name 'A' is used twice"),
        ("g.csv", GOOD + "A,10,0.9,0,1,2", "line 2: 6 cells; the first line has 7"),
        ("g.csv", GOOD + "A,10,0.9,,1,2,3", r"gear 1 \(A\): inertia is missing"),
        ("g.csv", GOOD, "no rows in it"),
        ("g.csv", "name,ratio,ratio\nA,1,2", "column 'ratio' stands twice"),
        ("g.csv", "name,ration\nA,1", "did you mean 'ratio'"),
        ("g.toml", "gears = [3]", r"no \[\[gears\]\]"),
        ("g.toml", "[[gear]]\nname = 'A'", "did you mean 'gears'"),
        ("g.toml", "[[gears]]\nname = 'A'\nratio = 3", r"gear 1 \(A\): efficiency is missing"),
        ("g.toml", "[[gears]]\nname = 'A'\nratio = 3\nefficiency = true\ninertia = 0\n"
         "nominal_torque = 1\npeak_torque = 2\nmax_speed = 3", "efficiency is True"),
    ],
)  # fmt: skip
def test_a_bad_catalogue_of_gears_is_refused_with_its_row(tmp_path, name, text, message):
    (tmp_path / name).write_text(text, encoding="utf-8")
    with pytest.raises(MotorError, match=message):
        read_gears(tmp_path / name)


def test_bad_motors_and_names():
    with pytest.raises(MotorError, match="rated torque and speed give 314.2 W; torques are in N m"):
        Motor("slip", rated_power=3.0, rated_torque=1.0, rated_speed=3000)
    with pytest.raises(MotorError, match="peak_torque must not be the smaller one"):
        Motor("slip", rated_torque=2.0, peak_torque=1.0)
    with pytest.raises(MotorError, match="maker is 3; it must be text"):
        Motor("slip", maker=3)
    with pytest.raises(NameUnknownError, match="no gearbox 'H'; choose one of 'G'"):
        find_gear("H", [GEAR])
    with pytest.raises(OptionError, match="motors: give a .toml"):
        motors_of([GEAR])
    with pytest.raises(FileError, match="no such file"):
        gears_of("nowhere.csv")
    with pytest.raises(OptionError, match="gears: give a .toml"):
        gears_of([])
