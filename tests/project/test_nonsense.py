"""Nothing nonsensical passes in silence: a question at the door, once, and never on the way."""

from __future__ import annotations

import subprocess
import sys
import warnings

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import KinlabWarning, already_said, warn

ARM = kl.load("puma560")
TABLE = """name = "arm"
convention = "standard"
[[links]]
joint = "revolute"
a = 0.3
alpha = 90
d = 0
theta = 0
mass = 1
"""


def silent(call):
    with warnings.catch_warnings():
        warnings.simplefilter("error", KinlabWarning)
        return call()


@pytest.mark.parametrize(("column", "value"), [("alpha", 90.0), ("theta", -45.0), ("alpha", 6.3)])
def test_angles_of_more_than_a_turn(column, value):
    links = [kl.DHLink(a=0.1), kl.DHLink(a=0.2, name="elbow", **{column: value})]
    with pytest.warns(KinlabWarning, match=f"link 2 'elbow': {column} is {value:g} rad.*degrees?"):
        table = kl.DHTable("arm", "modified", links)
    robot = silent(lambda: kl.Robot.from_dh(table))  # it has been said
    assert np.allclose(kl.fk(robot, [0.1, 0.2]), table.fk([0.1, 0.2])[-1])
    silent(lambda: kl.DHTable("arm", "modified", [kl.DHLink(alpha=2 * np.pi, theta=-2 * np.pi)]))


@pytest.mark.parametrize(
    "q", [[30, 45, 60, 0, 0, 0], (0.0, 0.0, 0.0, -90.0, 0.0, 0.0), [[0.0] * 6, [0, 20] + [0] * 4]]
)
def test_joint_positions_that_look_like_degrees(q):
    for call in (kl.fk, kl.jacobian, kl.gravity_torques):
        with pytest.warns(
            KinlabWarning, match=r"q = \S+ rad of joint .* is far outside .*degrees\?"
        ):
            answer = call(ARM, q)
        assert np.array_equal(answer, silent(lambda call=call: call(ARM, np.array(q, float))))


@pytest.mark.parametrize("name", ["puma560", "stanford", "scara", "planar2r", "ur5", "panda"])
def test_what_is_sound_is_never_asked_about(name):
    robot = kl.load(name)
    for q in (robot.lower, robot.upper, robot.upper + 0.99 * robot.slack, 0 * robot.lower):
        silent(lambda q=q: kl.fk(robot, q.tolist()))
    v = [50.0] * robot.n  # speeds may be large
    silent(lambda: kl.inverse_dynamics(robot, [0.1] * robot.n, v, v))
    for joint in range(robot.n):
        q = robot.upper.copy()
        q[joint] += 1.01 * robot.slack[joint]
        with pytest.warns(KinlabWarning, match=f"joint {robot.joint_names[joint]!r} is far"):
            kl.fk(robot, q.tolist())


def test_a_slide_in_millimetres():
    with pytest.warns(KinlabWarning, match=r"q = 250 m of joint 'joint_3' .*: millimetres\?"):
        kl.fk(kl.load("stanford"), [0, 0, 250, 0, 0, 0])


def test_other_doors_where_people_type_q():
    target = kl.fk(ARM, np.zeros(6))
    with pytest.warns(KinlabWarning, match=r"q0 = 90 rad .*degrees\?"):
        kl.ik(ARM, target, q0=np.array([90.0, 0, 0, 0, 0, 0]))
    silent(lambda: kl.ik(ARM, target, q0=np.full(6, 4.0)))
    with pytest.warns(KinlabWarning, match="degrees"):
        kl.viewer.Scene(kl.load("planar2r"), np.array([45.0, 30.0]))


def test_five_bars_without_masses_say_so_loudly():
    light = kl.FiveBar(0.25, 0.3, 0.1, payload=1.0)
    box = light.largest_rectangle(max_condition=4)
    with pytest.warns(KinlabWarning, match="cranks and rods have NO MASS"):
        sizing = light.size_servo(box, 1.0, 10.0, motor="SGMAH-08A", gear_ratio=20.0, massless=True)
    assert "NO MASS" in sizing.remarks[0]
    bars = {"crank_mass": 1.0, "crank_com": 0.1, "crank_inertia": 0.005, "rod_mass": 0.8}
    heavy = kl.FiveBar(0.25, 0.3, 0.1, payload=1.0, rod_inertia=0.006, **bars)
    full = silent(lambda: heavy.size_servo(box, 1.0, 10.0, motor="SGMAH-08A", gear_ratio=20.0))
    assert full.remarks == ()
    assert full.torque.largest > 1.5 * sizing.torque.largest  # why it has to be said


def test_the_warning_points_to_the_callers_line():
    with pytest.warns(KinlabWarning) as caught:
        kl.fk(ARM, [90, 0, 0, 0, 0, 0])
    assert [record.filename for record in caught] == [__file__]
    with already_said():
        silent(lambda: warn("x"))


def test_the_command_line_gives_one_line(tmp_path):
    (tmp_path / "arm.toml").write_text(TABLE)

    def run(*words):
        done = subprocess.run(
            [sys.executable, "-m", "kinlab", *words],
            cwd=tmp_path, capture_output=True, text=True, timeout=120, check=True,
        )  # fmt: skip
        return done.stderr.splitlines()

    (line,) = run("info", "arm.toml")
    assert line.startswith(
        "kinlab: warning: table 'arm', link 1: alpha is 90 rad, 14.3 turns: degrees?"
    )
    (line,) = run("view", "planar3r", "-q", "30,45,60", "--save", "x.html")
    assert line.startswith("kinlab: warning: robot 'planar3r': q = 30 rad of joint")
    assert "degrees?" in line
    assert run("view", "planar3r", "-q", "30 deg, 0.5, pi/3", "--save", "x.html") == []
