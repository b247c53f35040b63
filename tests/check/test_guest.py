"""A .py file of formulas cannot end the check, whatever it does."""

from __future__ import annotations

import subprocess
import sys

import pytest

FILE = """
import os, sys
import numpy as np
import kinlab as kl
print("printed by the file")
{top}

@kl.hand_formula("gravity_torques", robot="single_link")
def bad(q):
    {inside}
    return np.array([2.5 * 9.81 * 0.3 * np.cos(q[0])])

@kl.hand_formula("gravity_torques", robot="single_link")
def good(q):
    return np.array([2.5 * 9.81 * 0.3 * np.cos(q[0])])
"""


def check(folder, top="", inside="pass", *more):
    file = folder / "mine.py"
    file.write_text(FILE.format(top=top, inside=inside), encoding="utf-8")
    return subprocess.run(
        [sys.executable, "-m", "kinlab", "check", str(file), "--samples", "20", *more],
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("exit()", "ended its process with exit code 0"),
        ("os._exit(0)", "ended its process with exit code 0"),
        ("import ctypes; ctypes.string_at(0)", "ended its process by signal SIGSEGV"),
        ("while True: pass", "did not come back within 2 s"),
    ],
)
def test_a_function_that_ends_its_process_has_failed(tmp_path, monkeypatch, line, why):
    if line.startswith("while"):
        monkeypatch.setenv("KINLAB_CHECK_SECONDS", "2")
    done = check(tmp_path, inside=line)
    assert done.returncode == 1
    assert f"FAILED: function 'bad' {why}" in " ".join(done.stdout.split())
    assert [row for row in done.stdout.splitlines() if row.startswith("good") and "agrees" in row]


@pytest.mark.parametrize("line", ["exit()", "os._exit(0)", "raise SystemExit", "os.abort()"])
def test_a_file_that_ends_its_process_is_refused(tmp_path, line):
    done = check(tmp_path, top=line)
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1].startswith("kinlab: ")
    assert "ended its process" in done.stderr


def test_what_the_file_prints_does_not_stand_in_the_json(tmp_path):
    import json

    done = check(tmp_path, "", "pass", "--json")
    assert json.loads(done.stdout)["ok"] is True
    assert "printed by the file" in done.stderr


def test_the_help_says_that_the_file_is_run():
    done = subprocess.run(
        [sys.executable, "-m", "kinlab", "check", "--help"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert "A .py file is run" in done.stdout
