"""The command ``kinlab mark`` and the examples for notebooks."""

from __future__ import annotations

import csv
import doctest
import runpy
from pathlib import Path

from typer.testing import CliRunner

from kinlab.cli import app

EXAMPLES = Path(__file__).parents[2] / "scripts" / "marking"


def test_the_example_from_a_shell(tmp_path):
    out = tmp_path / "marks"
    sheet, folder = str(EXAMPLES / "sheet.toml"), str(EXAMPLES / "submissions")
    done = CliRunner().invoke(app, ["mark", sheet, folder, "-o", str(out), "--workers", "1"])
    assert done.exit_code == 0, done.output
    assert "2 submissions, mean 7.50 of 10 points" in done.output
    with (out / "marks.csv").open(encoding="utf-8-sig") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    assert [rows["ada"][k] for k in ("q1", "q2", "q3", "q4")] == ["2", "2", "3", "1"]
    assert [rows["bob"][k] for k in ("q1", "q2", "q3", "q4")] == ["2", "2", "3", "0"]
    assert len(list((out / "students").glob("*.html"))) == 2
    assert "a sign is the other way" in (out / "class.html").read_text()


def test_handouts_from_a_shell(tmp_path):
    ids = tmp_path / "ids.txt"
    ids.write_text("ada\nbob\n")
    sheet = str(EXAMPLES / "sheet.toml")
    done = CliRunner().invoke(
        app, ["mark", sheet, "--handout", str(ids), "-o", str(tmp_path / "h")]
    )
    assert done.exit_code == 0, done.output
    assert {p.name for p in (tmp_path / "h").iterdir()} == {"ada.toml", "bob.toml"}


def test_what_is_missing_is_said(tmp_path):
    sheet = str(EXAMPLES / "sheet.toml")
    assert "name their folder" in str(CliRunner().invoke(app, ["mark", sheet]).exception)
    empty = CliRunner().invoke(app, ["mark", sheet, str(tmp_path)])
    assert "no submissions" in str(empty.exception)


def test_the_example_for_otter(monkeypatch):
    monkeypatch.chdir(EXAMPLES)
    case = runpy.run_path("otter_q1.py")["test"]["suites"][0]["cases"][0]["code"]
    for x, failures in (("l1*c1 + l2*c12", 0), ("l1*c1 - l2*c12", 1)):
        test = doctest.DocTestParser().get_doctest(case, {"x": x}, "q1", None, 0)
        assert (
            doctest.DocTestRunner(verbose=False).run(test, out=lambda text: None).failed == failures
        )


def test_the_example_for_nbgrader(monkeypatch):
    monkeypatch.chdir(EXAMPLES)
    tau2 = "m2*l2^2*(qdd1+qdd2) + m2*l1*l2*c2*qdd1 - m2*l1*l2*s2*qd1^2 + m2*g*l2*c12"
    found = runpy.run_path("nbgrader_q2.py", {"tau2": tau2})["found"]
    assert (found.points, found.of) == (2.0, 4.0)
    assert found.cause == "a sign is the other way"
