"""Motions on the page, on the command line, in pictures and in the tour's controllers."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest
from console import kinlab as run
from scenes import told

import kinlab as kl
from kinlab.errors import KinlabError, OptionError
from kinlab.plots.canvas import save
from kinlab.plots.drives import torque_speed
from kinlab.viewer import show
from kinlab.viewer.scene import Scene

ELBOW = kl.load("planar2r")
MOTION = kl.motion.joint(ELBOW, [[0.4, 0.9], [1.0, -0.6]], acceleration=8)


def test_the_page_plays_a_motion_and_marks_what_it_meets(monkeypatch):
    monkeypatch.setattr(show, "in_notebook", lambda: True)  # no server
    scene = kl.view(ELBOW, motion=MOTION)
    shown = told(scene)["animation"]
    assert np.array_equal(shown["q"], MOTION.q) and np.array_equal(shown["times"], MOTION.t)
    assert shown["name"] == "Motion: quintic" and scene.q.tolist() == [0.4, 0.9]
    assert "singularity, t = 0.576 s" in str(told(scene)["labels"])
    ran = kl.simulate(ELBOW, [0.1, 0.2], duration=0.1)
    assert told(kl.view("planar2r", motion=ran))["animation"]["name"] == "Simulated motion"
    with pytest.raises(OptionError, match="one arm"):
        kl.view(kl.FiveBar.load("isotropic"), motion=MOTION)
    with pytest.raises(KinlabError, match="expected"):
        Scene(kl.load("ur5")).play(MOTION)


def test_the_command_plans_checks_and_writes(tmp_path):
    file = tmp_path / "m.csv"
    done = run(
        "motion",
        "planar2r",
        "0.4, 0.9",
        "1, -0.6",
        "--acceleration",
        "8",
        "-o",
        str(file),
        "--servos",
    )
    assert done.returncode == 0, done.stderr
    assert "t = 0.576144 s" in done.stdout and "'elbow left' to 'elbow right'" in done.stdout
    assert "a drive fits every joint, for a motion of 1.04 s" in done.stdout
    assert np.array_equal(kl.motion.read_motion(ELBOW, file).q, MOTION.q)
    page = tmp_path / "page.html"
    shown = run("view", "planar2r", "--animate", str(file), "--save", str(page))
    assert shown.returncode == 0 and "singularity, t = 0.576 s" in page.read_text()
    line = run(
        "motion", "scara", "0.4, 0.8, 0.1, 0.3", "0.5, 0.9, 0.05, 0.3", "--line", "--duration", "2"
    )
    assert line.returncode == 0 and "no singularity on the way" in line.stdout


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (("0.4, 0.9", "1, 4", "--acceleration", "8"), "the nearest that works is 3.14159"),
        (("0.4, 0.9", "1, 1"), "give acceleration="),
        (("0.4, 0.9", "1"), "different numbers"),
        (("0, 1", "1, 1", "--line", "--jerk", "3", "--duration", "1"), "no jerk limit"),
    ],
)
def test_bad_lines(words, says):
    done = run("motion", "planar2r", *words)
    assert done.returncode == 2 and says in done.stderr and done.stderr.count("\n") == 1


def test_the_picture_frames_what_fails(tmp_path):
    weak = kl.size_servos(ELBOW, MOTION, "SGMAH-A3A", gear_ratio=3.0)
    axes = torque_speed(weak)
    assert "fails: rated torque" in axes.get_title() or "fails: peak torque" in axes.get_title()
    strong = torque_speed(kl.size_servos(ELBOW, MOTION))
    assert "least margin" in strong.get_title()
    assert save(strong, tmp_path / "drives.png").stat().st_size > 10_000


def test_the_controllers_of_the_tour(tmp_path, monkeypatch, capsys):
    """Computed torque against (1 + 10 t) e^-10t, and the way that 20 N push 500 N/m: 40 mm."""
    path = Path(__file__).resolve().parents[2] / "scripts" / "tour" / "drive_an_arm.py"
    spec = importlib.util.spec_from_file_location("drive_an_arm", path)
    tour = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tour)
    monkeypatch.setattr("sys.argv", ["drive_an_arm.py", "--output", str(tmp_path / "c.png")])
    tour.main()
    said = capsys.readouterr().out
    assert float(re.search(r"damped law by (\S+)", said).group(1)) < 1e-8
    assert float(re.search(r"gravity: (\S+) rad", said).group(1)) < 1e-6
    gives = np.array(re.search(r"give \[(.*)\] mm", said).group(1).split(), dtype=float)
    np.testing.assert_allclose(gives, [0, 40, 0], atol=0.02)
    assert (tmp_path / "c.png").stat().st_size > 3000
