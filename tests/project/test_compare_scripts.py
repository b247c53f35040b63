"""The scripts that tell one note's story each: they run on their own and print numbers."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "scripts" / "compare"


@pytest.mark.parametrize(
    ("name", "agreements"),
    [("kinematics", 2), ("statics", 2), ("newton_euler", 1), ("lagrange", 2)],
)
def test_script_runs_and_agrees(name, agreements, capsys):
    runpy.run_path(str(FOLDER / f"compare_{name}.py"), run_name="__main__")
    said = capsys.readouterr().out
    assert said.count(" agrees with ") == agreements and "DIFFERS" not in said


def test_the_action_changes_by_eps_squared():
    story = runpy.run_path(str(FOLDER / "compare_lagrange.py"))
    ratios = [change / eps**2 for eps, change in story["action_changes"]()]
    assert ratios[1] == pytest.approx(ratios[2], rel=2e-3)
