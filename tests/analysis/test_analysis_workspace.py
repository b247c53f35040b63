"""Workspace maps, planar boundaries, figures and commands."""

from __future__ import annotations

import builtins
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from console import kinlab as run
from console import script

import kinlab as kl
from kinlab.errors import FileError, MissingExtraError, NameUnknownError, OptionError
from kinlab.plots import arms, canvas, curves
from kinlab.plots import maps as pictures
from kinlab.sweeps.samples import BLOCK
from kinlab.sweeps.workspace import binned

PI = np.pi


def two(l1, l2, first=(-PI, PI), second=(-PI, PI)):
    links = [
        kl.DHLink("revolute", a=l1, lower=first[0], upper=first[1]),
        kl.DHLink("revolute", a=l2, lower=second[0], upper=second[1]),
    ]
    return kl.Robot.from_dh(kl.DHTable("two", "standard", links))


def reachable(l1, l2, first, second, points):
    """Whether a 2R arm with limits reaches the points: law of cosines, both elbows."""
    x, y = points.T
    cosine = (x**2 + y**2 - l1**2 - l2**2) / (2 * l1 * l2)
    inside = np.zeros(len(points), dtype=bool)
    for sign in (1.0, -1.0):
        q2 = sign * np.arccos(np.clip(cosine, -1, 1))
        q1 = np.arctan2(y, x) - np.arctan2(l2 * np.sin(q2), l1 + l2 * np.cos(q2))
        for turn in (-2 * PI, 0.0, 2 * PI):
            fits = (q1 + turn >= first[0]) & (q1 + turn <= first[1])
            inside |= fits & (q2 >= second[0]) & (q2 <= second[1]) & (np.abs(cosine) <= 1)
    return inside


@pytest.mark.parametrize(("l1", "l2"), [(1.0, 0.6), (0.5, 0.4), (0.3, 0.9)])
def test_rings_without_limits(l1, l2):
    boundary = kl.planar_boundary(two(l1, l2))
    radii = sorted(arc.radius for arc in boundary.arcs)
    assert radii == pytest.approx([abs(l1 - l2), l1 + l2], abs=1e-12)
    size = np.linalg.norm(boundary.points(), axis=1)
    assert np.min(np.abs(size[:, None] - radii), axis=1).max() < 1e-6
    assert all(
        np.allclose(arc.centre, 0.0) and arc.stop - arc.start == pytest.approx(2 * PI)
        for arc in boundary.arcs
    )


def test_equal_links_have_no_hole():
    assert [arc.radius for arc in kl.planar_boundary(two(0.5, 0.5)).arcs] == pytest.approx([1.0])


@pytest.mark.parametrize(
    ("first", "second"),
    [((-PI, PI), (0.3, 2.0)), ((-1.0, 1.5), (-2.0, 0.5)), ((-1.0, 1.5), (-2.0, 2.0)), ((0.2, 0.9), (0.1, 1.0)),
     ((-2.5, 2.5), (-2.8, 2.8))],
)  # fmt: skip
def test_boundary_with_limits_against_the_law_of_cosines(first, second):
    l1, l2 = 1.0, 0.6
    boundary = kl.planar_boundary(two(l1, l2, first, second))
    if first == (-PI, PI):
        radii = [np.sqrt(l1**2 + l2**2 + 2 * l1 * l2 * np.cos(q2)) for q2 in second]
        assert sorted(a.radius for a in boundary.arcs) == pytest.approx(sorted(radii), abs=1e-12)
    for arc in boundary.arcs:
        angle = np.linspace(arc.start, arc.stop, 25)[1:-1]
        unit = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        out = reachable(l1, l2, first, second, arc.centre + (arc.radius + 1e-6) * unit)
        within = reachable(l1, l2, first, second, arc.centre + (arc.radius - 1e-6) * unit)
        assert np.all(out != within)  # a micrometre decides, on either side
    ends = np.concatenate([arc.points(2) for arc in boundary.arcs])
    if any(arc.stop - arc.start < 2 * PI - 1e-9 for arc in boundary.arcs):
        apart = np.linalg.norm(ends[:, None] - ends[None], axis=2) + 9.0 * np.eye(len(ends))
        assert apart.min(axis=1).max() < 1e-9  # the arcs close up to curves


def test_three_joint_boundary_encloses_every_sample():
    links = [
        kl.DHLink("revolute", a=a, lower=lo, upper=up)
        for a, lo, up in ((0.5, -1.0, 1.2), (0.4, -1.5, 1.5), (0.25, -1.0, 2.0))
    ]
    robot = kl.Robot.from_dh(kl.DHTable("three", "standard", links))
    boundary = kl.planar_boundary(robot)
    rng = np.random.default_rng(0)
    q = rng.uniform(robot.lower, robot.upper, (200_000, 3))
    snapped = rng.random(q.shape) < 0.4  # limits matter: put many joints on them
    q = np.where(snapped, np.where(rng.random(q.shape) < 0.5, robot.lower, robot.upper), q)
    tips = kl.fk(robot, q)[:, :2, 3]
    line = boundary.points(0.002)
    for angle in np.linspace(0, 2 * PI, 24, endpoint=False):  # support in every direction agrees
        way = np.array([np.cos(angle), np.sin(angle)])
        assert (line @ way).max() >= (tips @ way).max() - 3e-6  # sag of the chords
        assert (line @ way).max() <= (tips @ way).max() + 5e-3
    for arc in boundary.arcs:  # one side out of reach, by a scan of q1 and the law of cosines
        middle = 0.5 * (arc.start + arc.stop)
        unit = np.array([np.cos(middle), np.sin(middle)])
        seen = []
        for side in (3e-3, -3e-3):
            point = arc.centre + (arc.radius + side) * unit
            q1 = np.linspace(-1.0, 1.2, 4001)
            rest = point - 0.5 * np.stack([np.cos(q1), np.sin(q1)], axis=1)
            turned = np.stack([
                np.cos(q1) * rest[:, 0] + np.sin(q1) * rest[:, 1],
                np.cos(q1) * rest[:, 1] - np.sin(q1) * rest[:, 0],
            ], axis=1)  # fmt: skip
            seen.append(bool(reachable(0.4, 0.25, (-1.5, 1.5), (-1.0, 2.0), turned).any()))
        assert seen[0] != seen[1]
    free = kl.planar_boundary(kl.load("planar3r"))
    assert [a.radius for a in free.arcs] == pytest.approx([1.15], abs=1e-12)


def test_boundary_refuses_other_arms():
    with pytest.raises(OptionError, match="puma560"):
        kl.planar_boundary(kl.load("puma560"))


def test_map_values_are_the_metric_and_points_the_tool():
    robot = kl.load("planar2r")
    chart = kl.sample_workspace(robot, samples=2000, seed=4)
    assert "2,000 random states within the joint limits, seed 4" in chart.evidence.searched
    q = np.random.default_rng(4).uniform(-PI, PI, (2000, 2))
    assert np.allclose(chart.points, kl.fk(robot, q)[:, :3, 3], atol=0)
    assert np.allclose(chart.values, kl.manipulability(robot, q, "inverse_condition", "xy"), atol=0)
    assert chart.complete and chart.planar and chart.task == "xy"
    radius = np.linalg.norm(chart.points[:, :2], axis=1)
    assert radius.min() >= 0.1 - 1e-12 and radius.max() <= 0.9 + 1e-12
    flat = binned(chart, cells=30)
    assert flat.count.sum() == 2000 and flat.best.max() == chart.values.max()
    assert np.all(flat.mean <= flat.best) and np.isfinite(flat.mean).all()


def test_grid_includes_the_limits():
    chart = kl.sample_workspace(two(1.0, 0.6, (0.0, 1.0), (0.5, 1.5)), samples=100, sampling="grid")
    assert len(chart.values) == 100
    corner = kl.fk(two(1.0, 0.6), [1.0, 1.5])[:3, 3]
    assert np.linalg.norm(chart.points - corner, axis=1).min() < 1e-15


def test_map_is_saved_and_reloaded(tmp_path):
    chart = kl.sample_workspace(kl.load("puma560"), "position", "asada", samples=500)
    chart.save(tmp_path / "map.npz")
    again = kl.WorkspaceMap.load(tmp_path / "map.npz")
    assert np.array_equal(again.points, chart.points) and np.array_equal(again.values, chart.values)
    assert {k: v for k, v in vars(again).items() if k not in ("points", "values")} == {
        k: v for k, v in vars(chart).items() if k not in ("points", "values")
    }
    (tmp_path / "bad.npz").write_text("no archive")
    np.savez(tmp_path / "other.npz", a=1)
    for name in ("bad.npz", "other.npz", "missing.npz"):
        with pytest.raises(FileError, match=name):
            kl.WorkspaceMap.load(tmp_path / name)


def test_stopping_keeps_what_was_computed():
    def stop(done, total):
        if done >= BLOCK:
            raise KeyboardInterrupt

    robot = kl.load("planar3r")
    part = kl.sample_workspace(robot, samples=3 * BLOCK, progress=stop)
    assert "stopped before its end" in part.evidence.searched
    assert not part.complete and len(part.values) == BLOCK
    whole = kl.sample_workspace(robot, samples=3 * BLOCK)
    assert np.array_equal(part.values, whole.values[:BLOCK])


def test_a_map_on_workers_goes_on_where_it_was_stopped(tmp_path):
    robot = kl.load("planar3r")
    whole = kl.sample_workspace(robot, "xy", samples=4 * BLOCK)

    def stop(done, total):
        if done >= 2 * BLOCK:
            raise KeyboardInterrupt

    part = kl.sample_workspace(robot, "xy", samples=4 * BLOCK, folder=tmp_path, progress=stop)
    assert not part.complete and len(part.values) == 2 * BLOCK
    told = []
    again = kl.sample_workspace(
        robot, "xy", samples=4 * BLOCK, folder=tmp_path, workers=2,
        progress=lambda done, total: told.append(done),
    )  # fmt: skip
    assert told[0] == 2 * BLOCK and told[-1] == 4 * BLOCK
    assert again.complete
    assert np.array_equal(again.points, whole.points)
    assert np.array_equal(again.values, whole.values)


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"metric": "fast"}, NameUnknownError, ["'fast'", "yoshikawa"]),
        ({"sampling": "sobol"}, NameUnknownError, ["'sobol'", "grid"]),
        ({"samples": 0}, OptionError, ["samples is 0"]),
        ({"length": -2}, OptionError, ["-2 m"]),
        ({"task": [True]}, OptionError, ["(6,)"]),
    ],
)
def test_map_bad_input(arguments, error, words):
    with pytest.raises(error) as caught:
        kl.sample_workspace(kl.load("planar2r"), **arguments)
    for word in words:
        assert word in str(caught.value)


def test_figures_are_written(tmp_path):
    robot = kl.load("planar2r")
    chart = kl.sample_workspace(robot, samples=3000)
    loci = kl.singular_loci(robot, [0, 1])
    drawn = {
        "ellipse.png": arms.ellipses(robot, [0.3, 1.2], ("velocity", "force")),
        "flat.svg": arms.ellipses(robot, [0.3, 0.0], ("velocity", "force")),
        "map.pdf": pictures.workspace_map(chart, boundary=kl.planar_boundary(robot)),
        "cloud.png": pictures.workspace_cloud(kl.sample_workspace(kl.load("puma560"), samples=500)),
        "loci.png": curves.singular_loci(robot, loci),
        "path.png": curves.singular_values(robot, np.linspace([0, -2], [1, 2], 50)),
    }
    for name, axes in drawn.items():
        assert canvas.save(axes, tmp_path / name).stat().st_size > 3000
    with pytest.raises(FileError, match=".gif"):
        canvas.save(drawn["loci.png"], tmp_path / "loci.gif")


def test_figures_without_matplotlib_name_the_extra(monkeypatch):
    real = builtins.__import__

    def without(name, *rest, **more):
        if name.startswith("matplotlib"):
            raise ImportError(name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(MissingExtraError, match=r"kinlab\[plots\]"):
        canvas.new_axes()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["singular", "puma560", "--slice", "2,3"], ["elbow", "shoulder", "wrist", "det J = a2*", "joint_5 = 0"]),
        (["isotropy", "planar2r", "--free", "a2,tool.x"], ["0.527207794", "0.372792206", "135", "joint_1"]),
        (["workspace", "planar2r", "-n", "5000", "--save", "map.npz"], ["inverse_condition", "x (m)", "task xy"]),
    ],
)  # fmt: skip
def test_commands(arguments, words, tmp_path):
    result = run(*arguments, "-o", "picture.png", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    for word in words:
        assert word in result.stdout
    assert (tmp_path / "picture.png").read_bytes()[:4] == b"\x89PNG"
    if "--save" in arguments:
        assert len(kl.WorkspaceMap.load(tmp_path / "map.npz").values) == 5000


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["singular", "planar2r", "--task", "pose"], "use task 'xy'"),
        (["isotropy", "planar2r", "--length", "long"], "metres or optimal"),
        (["workspace", "planar2r", "--metric", "fast"], "'fast'"),
        (["singular", "planar2r", "--at", "1"], "2 joints"),
    ],
)
def test_commands_bad_input_is_one_line(arguments, word, tmp_path):
    result = run(*arguments, cwd=tmp_path)
    assert result.returncode == 2
    assert word in result.stderr and len(result.stderr.strip().splitlines()) == 1


TOUR = Path(__file__).resolve().parents[2] / "scripts" / "tour"


@pytest.mark.parametrize(
    ("name", "more", "word"),
    [
        ("find_singularities.py", [], "elbow"),
        ("find_isotropy.py", [], "1.414213562"),
        ("map_workspace.py", ["--samples", "5000"], "radius 1.150000"),
    ],
)
def test_the_scripts_run(name, more, word, tmp_path):
    result = script(TOUR / name, *more, "--output", "picture.png", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert word in result.stdout and (tmp_path / "picture.png").stat().st_size > 3000


def test_a_script_runs_by_a_process_of_its_own(tmp_path):
    result = subprocess.run(
        [sys.executable, str(TOUR / "watch_manipulability.py"), "--output", "picture.png"],
        capture_output=True, text=True, cwd=tmp_path, check=False,
        env={**os.environ, "PYTHONPATH": str(TOUR.parents[1])},
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    assert "characteristic length" in result.stdout
    assert (tmp_path / "picture.png").stat().st_size > 3000
