"""Cycles of one's own: the motion, the drives that do it, and the time that a drive takes."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

import kinlab as kl
from kinlab.cli import main
from kinlab.drives.cycles import pick_and_place
from kinlab.drives.gears import Gearbox
from kinlab.drives.motors import Motor, catalogue
from kinlab.drives.waypoints import Cycle, Waypoint, adept, read_cycle
from kinlab.errors import (
    InertiaError,
    KinlabWarning,
    MotorError,
    NameUnknownError,
    OptionError,
    SingularError,
    UnreachableError,
)

ISOTROPIC, UNEQUAL = kl.FiveBar.load("isotropic"), kl.FiveBar.load("unequal")
GEAR = Gearbox("G", 30.0, 0.9, 1e-5, nominal_torque=25.0, peak_torque=45.0, max_speed=6000)
CYCLE = Cycle(
    (
        Waypoint((-0.15, -0.62), dwell=0.1, payload=0.5),
        Waypoint((-0.15, -0.57)),
        Waypoint((0.15, -0.57), speed=1.2),
        Waypoint((0.15, -0.62), dwell=0.05, payload=-0.5),
        Waypoint((0.0, -0.55)),
    ),
    v_max=2.0,
    a_max=30.0,
)
TOML = """
v_max = 2.0
a_max = 30
[[points]]
at = [-0.15, -0.62]
dwell = 0.1
payload = 0.5
[[points]]
at = ["-0.15", -0.57]
[[points]]
at = [0.15, -0.57]
speed = 1.2
[[points]]
at = [0.15, -0.62]
dwell = 0.05
payload = -0.5
[[points]]
at = [0.0, -0.55]
"""
CSV = """x,y,dwell,speed,payload
-0.15,-0.62,0.1,,0.5
-0.15,-0.57,,,
0.15,-0.57,,1.2,
0.15,-0.62,0.05,,-0.5
0,-0.55,,,
"""


def test_adept_is_the_pick_and_place_cycle():
    mine = adept((0.02, -0.6), 2.0, 30.0).path()
    theirs = pick_and_place([0.02, -0.6], 2.0, 30.0, samples=20001)
    assert mine.duration == pytest.approx(theirs.duration, rel=1e-5)
    for column in (0, 1):
        at = np.interp(theirs.t / theirs.duration, mine.t / mine.duration, mine.points[:, column])
        np.testing.assert_allclose(at, theirs.points[:, column], atol=1e-6)


def test_the_motion_keeps_its_limits_and_visits_its_points():
    path = CYCLE.path()
    t, speed, push = path.t, *(np.linalg.norm(x, axis=1) for x in (path.v, path.a))
    assert speed.max() <= 2.0 * (1 + 1e-9) and push.max() == pytest.approx(30.0, rel=1e-4)
    np.testing.assert_allclose(path.points[[0, -1]], [[-0.15, -0.62]] * 2, atol=1e-12)
    # rate and acceleration are the slopes, by differences on a dense interpolation of the points
    smooth = np.diff(t) > 0
    slope = np.diff(path.points, axis=0)[smooth] / np.diff(t)[smooth, None]
    middle = 0.5 * (path.v[1:] + path.v[:-1])[smooth]
    np.testing.assert_allclose(slope, middle, atol=2e-4 * speed.max())
    rest = (t >= 0.0) & (t <= 0.1 - 1e-9)
    assert not path.v[rest].any() and not path.carried[rest].any()
    lifted = path.carried == 0.5
    assert lifted.any() and path.points[lifted][-1] == pytest.approx([0.15, -0.62])
    slow = CYCLE.path(3.0)
    assert slow.duration == pytest.approx(0.15 + 3.0 * (path.duration - 0.15), rel=1e-9)
    assert np.linalg.norm(slow.v, axis=1).max() == pytest.approx(speed.max() / 3, rel=1e-6)


def test_what_is_carried_weighs():
    """The torque with 0.5 kg carried is that of a linkage whose payload is 0.5 kg more."""
    path = CYCLE.path()
    demand = UNEQUAL.follow(path)
    heavy = replace(UNEQUAL, payload=UNEQUAL.payload + 0.5)
    for five, with_it in ((UNEQUAL, path.carried == 0.0), (heavy, path.carried == 0.5)):
        expected = five.inverse_dynamics(path.points, path.v, path.a)[with_it]
        np.testing.assert_allclose(demand.tau[with_it], expected, atol=1e-11)


@pytest.mark.parametrize("v_max", [1.0, 3.0])
def test_rms_is_that_of_an_own_dense_integral(v_max):
    """Torque and power at 200,001 instants of the fifth-degree law, summed by hand, to 1e-6."""
    cycle = Cycle((Waypoint((-0.15, -0.6)), Waypoint((0.1, -0.52), dwell=0.1)), v_max, 40.0)
    way = np.array([0.25, 0.08])
    length = np.hypot(*way)
    span = max(1.875 * length / v_max, np.sqrt(10 / np.sqrt(3) * length / 40.0))
    tau = (np.arange(100_000) + 0.5)[:, None] / 100_000
    s, s1, s2 = (
        tau**3 * (10 - 15 * tau + 6 * tau**2), 30 * tau**2 * (1 - tau) ** 2 / span,
        60 * tau * (1 - tau) * (1 - 2 * tau) / span**2,
    )  # fmt: skip
    places = np.array([-0.15, -0.6]) + s * way
    torque = UNEQUAL.inverse_dynamics(places, s1 * way, s2 * way)
    back = UNEQUAL.inverse_dynamics(places, -s1 * way, s2 * way)
    rate = UNEQUAL.joint_rates(places, s1 * way)
    hold = UNEQUAL.gravity_torques([0.1, -0.52])
    whole = 2 * span + 0.1
    mean = span * (np.mean(torque**2, axis=0) + np.mean(back**2, axis=0)) + 0.1 * hold**2
    power = span * (np.mean((torque * rate) ** 2, axis=0) + np.mean((back * rate) ** 2, axis=0))
    demand = UNEQUAL.follow(cycle.path())
    assert demand.t[-1] == pytest.approx(whole, rel=1e-7)
    np.testing.assert_allclose(demand.rms_torque, np.sqrt(mean / whole), rtol=1e-6)
    np.testing.assert_allclose(demand.rms_power, np.sqrt(power / whole), rtol=1e-6)


def test_a_motor_for_a_time_and_the_time_of_a_motor():
    motor = catalogue()["SGMAH-01A"]
    fast = replace_limits(CYCLE, 8.0, 200.0)
    found = UNEQUAL.fastest_cycle(fast, motor, GEAR)
    (fit,) = found.fits
    assert fit.fits and fit.margin == pytest.approx(1.0, abs=1e-5) and found.slower > 1.0
    (slower,) = UNEQUAL.size_cycle(fast, found.time * 1.01, motors=motor, gears=GEAR).fits
    (faster,) = UNEQUAL.size_cycle(fast, found.time * 0.99, motors=motor, gears=GEAR).fits
    assert slower.fits and not faster.fits and faster.failed
    for time in (1.5, 3.0):
        sized = UNEQUAL.size_cycle(CYCLE, time, motors=motor, gears=GEAR)
        assert sized.time == pytest.approx(time, rel=1e-12)
        shaft = sized.demand.at_shaft(type_of_drive(motor))
        assert sized.fits[0].rms == pytest.approx(
            np.sqrt(np.trapezoid(shaft**2, sized.path.t, axis=0) / time).max(), rel=1e-3
        )
    strong = Motor("S", rated_torque=50, peak_torque=150, max_speed=9000, rotor_inertia=1e-5)
    free = UNEQUAL.fastest_cycle(CYCLE, strong, 10.0)
    assert free.slower == 1.0 and free.fits[0].fits
    assert UNEQUAL.size_cycle(CYCLE).short_list


def replace_limits(cycle, v_max, a_max):
    points = tuple(replace(point, speed=None) for point in cycle.points)
    return replace(cycle, points=points, v_max=v_max, a_max=a_max)


def type_of_drive(motor):
    from kinlab.drives.gears import Drive

    return Drive(motor, GEAR)


def test_files_of_cycles(tmp_path):
    (tmp_path / "c.toml").write_text(TOML, encoding="utf-8")
    (tmp_path / "c.csv").write_text(CSV, encoding="utf-8")
    toml = read_cycle(tmp_path / "c.toml")
    assert toml == replace(CYCLE, name="c") == read_cycle(tmp_path / "c.csv", 2.0, 30.0)
    assert read_cycle(tmp_path / "c.toml", v_max=1.0).v_max == 1.0
    for name, text, message in [
        ("a.csv", CSV, "v_max is missing"),
        ("a.csv", "x,dwell\n1,2", "column 'y' is missing"),
        ("a.csv", "x,y,dwel\n1,2,3", "did you mean 'dwell'"),
        ("a.csv", "x,y\n1,2,3", "line 2: 3 cells"),
        ("a.toml", "v_max = 1\na_max = 1", r"no \[\[points\]\]"),
        ("a.toml", "vmax = 1", "did you mean 'v_max'"),
        ("a.toml", TOML.replace("at = [0.0, -0.55]", "at = 3"), "point 5: at is 3"),
        ("a.toml", TOML.replace("0.05", "'soon'"), "point 4: dwell: cannot read 'soon'"),
        ("a.toml", TOML.replace("payload = -0.5", "payload = -0.7"), "0.2 more than is carried"),
        ("a.toml", TOML.replace("payload = -0.5", ""), "0.5 kg are picked and not dropped again"),
        ("a.toml", TOML.replace("dwell = 0.05", "blend = 0.4"), "blend must be 0"),
        ("a.toml", TOML.replace("[0.0, -0.55]", "[0.15, -0.62]"), "move 4 ends where it starts"),
        ("a.toml", TOML + "blend = 2", "blend is 2.0; it must lie"),
    ]:
        (tmp_path / name).write_text(text, encoding="utf-8")
        with pytest.raises(OptionError, match=message):
            read_cycle(tmp_path / name)


def test_a_cycle_that_cannot_be_done_says_where_when_and_what_would_work():
    def moved(x, y):
        shifted = (replace(p, at=(p.at[0] + x, p.at[1] + y)) for p in CYCLE.points)
        return replace(CYCLE, points=tuple(shifted))

    with pytest.raises(UnreachableError, match=r"t = 0 s, .* leaves .* moved as a whole by") as far:
        ISOTROPIC.size_cycle(moved(0.0, -0.2))
    x, y = map(float, str(far.value).split("moved as a whole by (")[1].split(")")[0].split(","))
    ISOTROPIC.size_cycle(moved(x * 1.01, -0.2 + y * 1.01))
    with pytest.raises(
        (SingularError, UnreachableError), match="moved as a whole|there is no place"
    ):
        ISOTROPIC.size_cycle(moved(0.0, 0.55))
    with pytest.raises(OptionError, match="takes at least .* s within its limits"):
        ISOTROPIC.size_cycle(CYCLE, 0.3)
    with pytest.raises(OptionError, match="points in space"):
        space = (Waypoint((0.0, -0.5, 0.0)), Waypoint((0.0, -0.5, 0.1)))
        ISOTROPIC.size_cycle(Cycle(space, 1.0, 1.0))
    with pytest.raises(MotorError, match="even 64 times slower: rated torque"):
        weak = Motor("W", rated_torque=0.01, peak_torque=0.1, max_speed=3000, rotor_inertia=1e-6)
        ISOTROPIC.fastest_cycle(CYCLE, weak, GEAR)


def test_bars_without_mass_are_asked_for():
    bare = kl.FiveBar(0.3, 0.5, 0.14, payload=1.0)
    for call in (
        lambda five, **how: five.size_cycle(CYCLE, **how),
        lambda five, **how: five.size_servo((-0.1, 0.1, -0.6, -0.5), 1, 5, "SGMAH-08A", 20, **how),
    ):
        with pytest.raises(InertiaError, match=r"cranks and rods have NO MASS.*massless=True"):
            call(bare)
        with pytest.raises(InertiaError, match="the rods have NO MASS.*give rod_mass"):
            call(bare.with_masses(crank=1.0))
        with pytest.warns(KinlabWarning, match="NO MASS"):
            assert call(bare, massless=True).fits
        assert call(bare.with_masses(1.0, 0.4)).fits
    uniform = bare.with_masses(crank=1.0, rod=0.4)
    assert uniform.rod_com.tolist() == [0.25, 0.25]
    assert uniform.rod_inertia[0] == pytest.approx(0.4 * 0.25 / 12)
    assert bare.with_masses(payload=2.0).payload == 2.0


def test_the_command_with_own_motors_gears_and_cycle(monkeypatch, capsys, tmp_path):
    def kinlab(*arguments):
        monkeypatch.setenv("COLUMNS", "160")
        monkeypatch.setattr(sys, "argv", ["kinlab", "fivebar", "size", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            main()
        said = capsys.readouterr()
        return left.value.code, said.out, said.err

    cycle, motors, gears = (tmp_path / name for name in ("c.toml", "m.csv", "g.toml"))
    cycle.write_text(TOML, encoding="utf-8")
    motors.write_text("name,rated_torque,peak_torque,max_speed,rotor_inertia\n"
                      "mine,0.6,1.9,5000,1e-5\nweak,0.01,0.03,5000,1e-6\n", encoding="utf-8")  # fmt: skip
    gears.write_text("[[gears]]\nname = 'box'\nratio = 30\nefficiency = 0.9\ninertia = 1e-5\n"
                     "nominal_torque = 25\npeak_torque = 45\nmax_speed = 6000\n", encoding="utf-8")  # fmt: skip
    code, out, _ = kinlab("isotropic", "--cycle", cycle, "--motors", motors, "--gears", gears,
                          "--picture", tmp_path / "c.svg")  # fmt: skip
    assert code == 0 and "mine" in out and "box" in out and "fails: peak torque" in out
    assert (tmp_path / "c.svg").stat().st_size > 10_000
    code, out, _ = kinlab("isotropic", "--cycle", cycle, "--motors", motors, "--gears", gears,
                          "--motor", "mine", "--gear", "box")  # fmt: skip
    assert code == 0 and "the fastest cycle of this drive" in out
    code, out, _ = kinlab("doggo_leg", "--cycle", "adept", "--v-max", 1, "--a-max", 10, "--payload",
                          0.1, "--massless", "--motor", "SGMAH-01A", "--gear-ratio", 5)  # fmt: skip
    assert code == 0 and "cycle adept" in out
    for arguments, error, message in [
        (("doggo_leg", "--cycle", "adept", "--v-max", 1, "--a-max", 1, "--payload", 1), InertiaError,
         "have NO MASS"),
        (("isotropic", "--cycle", "adapt"), NameUnknownError, "no cycle 'adapt'"),
        (("isotropic", "--cycle", "adept"), OptionError, "give --v-max and --a-max"),
        (("isotropic",), OptionError, "give --v-max and --a-max"),
        (("isotropic", "--cycle", cycle, "--time", 0.1), OptionError, "takes at least"),
        (("isotropic", "--cycle", cycle, "--gear", "box"), NameUnknownError, "name a file of them"),
        (("isotropic", "--cycle", cycle, "--motors", motors, "--motor", "X"), NameUnknownError,
         "no motor 'X'; choose one of 'mine', 'weak'"),
    ]:  # fmt: skip
        code, _, err = kinlab(*arguments)
        assert code == 2 and message in err and len(err.strip().splitlines()) == 1, error
