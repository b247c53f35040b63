"""Many rows together: what a row says does not depend on who ran it, or on what was kept."""

from __future__ import annotations

import json
import multiprocessing
import subprocess
import sys
from collections import deque
from queue import SimpleQueue

import numpy as np
import pinocchio as pin
import pytest

import kinlab as kl
from kinlab.check.targets import PlannedRow, tasks
from kinlab.check.together import Helpers, run_together
from kinlab.host.answers import answers_kept, once

SAMPLES, SEED = 7, 3


def some():
    """Rows of arms, of a five-bar and of an identity, and a table's checks."""
    return tasks(["002.C:C", "003.loop", "000.R", "single_link"])


def told(row):
    """What a row says, to the last bit."""
    forms = [form for form in (row.corrected, row.printed) if form is not None]
    numbers = [x.tobytes() for f in forms for x in (f.hand, f.engine, *f.arguments.values())]
    return row.formula.key, row.robot, row.verdict, numbers


def alone(task):
    return task.run(SAMPLES, SEED)


@pytest.fixture(scope="module")
def separately():
    return [told(alone(task)) for task in some()]


def test_rows_are_the_same_with_what_was_kept(separately):
    together = dict(run_together(some(), alone, SAMPLES, SEED))
    assert [told(together[k]) for k in range(len(separately))] == separately


def test_rows_are_the_same_from_a_process(separately):
    here = []

    def one(task):
        here.append(task)
        return alone(task)

    todo = some()
    with Helpers(1) as helpers:
        # the caller waits until the process has taken its first name, then they share the rest
        taken = deque(["-"])
        question = ("single_link", ["table:fk"], 2, 0)
        answers = SimpleQueue()
        helpers.take(taken, lambda name: question, lambda *said: answers.put(said))
        assert len(answers.get(timeout=100)[1]) == 1
        assert answers.get(timeout=100) == ()
        together = dict(run_together(todo, one, SAMPLES, SEED, helpers))
    assert len(here) < len(todo), "the process took nothing"
    assert [told(together[k]) for k in range(len(todo))] == separately


def test_a_process_that_dies_is_not_missed(separately):
    before = set(multiprocessing.active_children())
    with Helpers(1) as helpers:
        for process in set(multiprocessing.active_children()) - before:
            process.kill()
            process.join()
        together = dict(run_together(some(), alone, SAMPLES, SEED, helpers))
    assert [told(together[k]) for k in range(len(separately))] == separately


def test_a_users_own_table_is_never_handed_over(tmp_path):
    kl.load("planar2r").table.save(tmp_path / "panda.toml")
    mine, shipped = tasks([str(tmp_path / "panda.toml")]), tasks(["panda"])
    assert not any(task.ships for task in mine)
    assert all(task.ships for task in shipped)
    other = kl.with_payload(kl.load("panda"), 1.0)
    assert not any(PlannedRow(task.record, other, "panda").ships for task in shipped)


def test_what_is_kept_is_a_copy_and_ends_with_the_block():
    calls = []

    def squares(x):
        calls.append(x.copy())
        return x**2

    x = np.arange(3.0)
    with answers_kept():
        first = once(squares, x)
        first[:] = -1.0
        assert np.array_equal(once(squares, x), [0.0, 1.0, 4.0])
        assert len(calls) == 1
        once(squares, x + 1.0)
        once(squares, x[None])
        assert len(calls) == 3
    once(squares, x)
    assert len(calls) == 4


def test_the_engine_is_asked_once_within_the_block(monkeypatch):
    robot, asked = kl.load("planar2r"), []
    original = pin.computeRNEADerivatives

    def counted(model, data, q, *motion):
        asked.append(q)
        return original(model, data, q, *motion)

    monkeypatch.setattr(pin, "computeRNEADerivatives", counted)
    q = np.random.default_rng(0).standard_normal((4, 2))
    with answers_kept():
        one = kl.lagrangian_gradient(robot, q, q)
        two = kl.mass_matrix_dot(robot, q, q)
    assert len(asked) == 4 * (1 + robot.n)  # the weight, and each column of M
    assert np.array_equal(one, kl.lagrangian_gradient(robot, q, q))
    assert np.array_equal(two, kl.mass_matrix_dot(robot, q, q))


def test_a_package_import_stays_light():
    """Neither the engine nor the command line's tables come with ``import kinlab``."""
    code = "import sys, kinlab; print([m for m in sys.modules if m.split('.')[0] in heavy])"
    code = "heavy = {'pinocchio', 'numpy', 'scipy', 'sympy', 'rich', 'trimesh', 'numba'};" + code
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout.replace("'", '"')) == []
