"""The wrong line of a function in a user's file is found in the file's own process."""

from __future__ import annotations

import json
import time

import pytest
from console import kinlab

import kinlab as kl
from kinlab.check.guest import FunctionLostError, Guest
from kinlab.check.targets import tasks
from kinlab.doctor.report import of_task
from kinlab.formulas.record import FormulaError
from kinlab.host.language import _, speaking

FILE = """\
import time; import numpy as np
import kinlab as kl

m1, g0, lc1 = 2.5, 9.81, 0.3

@kl.hand_formula("gravity_torques", robot="planar2r")
def sign(q):
    outer = 1.5 * g0 * 0.4 * np.cos(q[0] - q[1])
    return np.array([3.5 * g0 * 0.5 * np.cos(q[0]) + outer, outer])

@kl.hand_formula("gravity_torques", robot="single_link")
def trap(q):
    if q[0] > 100.0:
        np.f2py.os.write(2, b"trapped")
        np.f2py.os._exit(3)
    return np.array([np.tanh(q[0])])

@kl.hand_formula("gravity_torques", robot="single_link")
def wave(q):
    return np.array([m1 * g0 * lc1 * np.sin(q[0])])
"""
ENDLESS = """
@kl.hand_formula("gravity_torques", robot="single_link")
def endless(q):
    time.sleep(60)
"""
SIGN = "line 8, the sign is wrong: `outer = 1.5*g0*0.4*np.cos(q[0] - q[1])` should be "
WAVE = "line 20, sine and cosine are exchanged"


@pytest.fixture
def file(tmp_path):
    (tmp_path / "mine.py").write_text(FILE, encoding="utf-8")
    return tmp_path / "mine.py"


def test_lines_are_told_and_a_lost_process_costs_its_own_only(file, capfd):
    done = kinlab("check", file, "--samples", "10", "--json", cwd="/")
    rows = {row["id"]: row["diagnosis"] for row in json.loads(done.stdout)["rows"]}
    assert rows["sign"]["causes"][0]["sentence"].startswith(SIGN)
    assert rows["sign"]["causes"][0]["places"] == ["line 8"]
    assert "trapped" in capfd.readouterr().err  # an edit led there
    assert rows["trap"]["verdict"] == "differs, cause unknown"
    assert rows["wave"]["causes"][0]["sentence"].startswith(WAVE)


def test_a_function_without_end_is_not_asked_for_its_lines(file, monkeypatch):
    monkeypatch.setenv("KINLAB_CHECK_SECONDS", "2")
    file.write_text(FILE.split("@kl")[0] + ENDLESS, encoding="utf-8")
    done = kinlab("check", file, "--samples", "10", "--json", cwd="/")
    (row,) = json.loads(done.stdout)["rows"]
    assert "did not come back within 2 s" in str(row) and row["diagnosis"] is None


def test_the_sentences_are_in_the_language_of_the_asker(file):
    task = next(one for one in tasks([str(file)]) if one.record.id == "wave")
    with speaking("zh"):
        asked = _("sine and cosine are exchanged")
        told = of_task(task, 20).diagnosis.sentence
    assert asked in told and "sine and" not in told
    assert of_task(task, 20).diagnosis.sentence.startswith(WAVE)


def test_the_same_as_where_the_function_is_at_hand(file):
    task = next(one for one in tasks([str(file)]) if one.record.id == "sign")
    space = {"__name__": "mine"}
    exec(compile(FILE, str(file), "exec"), space)  # noqa: S102
    here = kl.diagnose("planar2r", "gravity_torques", space["sign"], samples=20)
    there = of_task(task, 20).diagnosis
    assert there.causes == here.causes and there.known


def counted(function, upto):
    yield from range(upto)
    yield function.__wrapped__.__name__


def stuck(function):
    time.sleep(60)
    yield function


def test_what_is_asked_comes_one_by_one(file, monkeypatch):
    monkeypatch.setenv("KINLAB_CHECK_SECONDS", "4")
    function = Guest(str(file)).formulas[0].function
    assert [*function.ask(counted, 2)] == [0, 1, "sign"]
    first = function.ask(counted, 2)
    assert next(first) == 0
    with pytest.raises(FunctionLostError, match="did not come back"):
        next(function.ask(stuck))
    with pytest.raises(FormulaError):  # what had been begun is lost
        next(first)
    assert [*function.ask(counted, 0)] == ["sign"]
