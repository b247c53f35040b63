"""The benchmark itself: its parties agree, its report and its comparison hold together."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest

import kinlab as kl

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts" / "bench"


@pytest.fixture(scope="module")
def bench():
    sys.path.insert(0, str(SCRIPTS))
    try:
        import bench as module

        yield module
    finally:
        sys.path.remove(str(SCRIPTS))


@pytest.mark.parametrize("name", ["ur5", "puma560"])
def test_every_party_gives_kinlabs_answer(bench, name):
    robot = kl.load(name)
    parties = bench.parties
    q, v, a = bench.states_of(robot, None)
    own = parties.kinlab_single(robot, q, v, a)
    raw = parties.pinocchio_single(robot, q, v, a)
    assert set(own) == set(raw) == set(parties.SINGLE)
    for others in (raw, parties.mujoco_single(robot, q, v, a)):
        for what, call in others.items():
            assert call() == pytest.approx(own[what](), abs=1e-12), what
    stacks = bench.states_of(robot, 20)
    many = parties.kinlab_single(robot, *stacks)
    for what, call in parties.pinocchio_batch(robot, *stacks, 2).items():
        assert call() == pytest.approx(many[what](), abs=1e-11), what


def test_random_tables_are_sound_arms(bench):
    for n in bench.JOINTS:
        robot = kl.Robot.from_dh(bench.parties.random_table(n))
        assert robot.n == n
        assert np.linalg.eigvalsh(kl.mass_matrix(robot, np.full(n, 0.3)))[0] > 0


def test_report_and_comparison(bench, tmp_path, monkeypatch, capsys):
    calls = {"kinlab": lambda: np.ones(2), "other": lambda: np.array([1.0, 1.5])}
    monkeypatch.setitem(
        bench.SECTIONS, "single", lambda: bench.rows("demo", "f", calls, 2, 1, count=3, least=0.0)
    )
    output = tmp_path / "now.json"
    arguments = ["bench.py", "--sections", "single", "--output", str(output)]
    monkeypatch.setattr(sys, "argv", arguments)
    bench.main()
    report = json.loads(output.read_text())
    assert [row["party"] for row in report["rows"]] == ["kinlab", "other"]
    assert report["rows"][0]["ratio"] == 1.0
    assert report["rows"][1]["apart"] == 0.5
    assert "| f | other | 2 | 1 |" in output.with_suffix(".md").read_text()
    old = json.loads(output.read_text())
    for row in old["rows"]:
        row["us"] *= 1e-6  # everything was a million times faster before
    (tmp_path / "old.json").write_text(json.dumps(old))
    monkeypatch.setattr(sys, "argv", [*arguments, "--compare", str(tmp_path / "old.json")])
    capsys.readouterr()
    bench.main()
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("| f |")]
    assert len(lines) == 2
    assert all(float(line.split("|")[-3]) > 1000 for line in lines)
