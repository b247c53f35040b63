"""The doctor's bench: its own formulas are right, it knows none of the doctor's lists, it goes on."""

from __future__ import annotations

import ast
import sys
from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest

import kinlab as kl

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts" / "bench"
DOORS = {"kinlab.doctor.file"}
"""What a user calls with a file of formulas; ``kl.diagnose`` is the other door."""


@pytest.fixture(scope="module")
def bench():
    sys.path.insert(0, str(SCRIPTS))
    try:
        import bench_doctor as module
        import bench_doctor_books
        import bench_doctor_cases

        module.books, module.cases = bench_doctor_books, bench_doctor_cases
        yield module
    finally:
        sys.path.remove(str(SCRIPTS))


def test_the_bench_knows_none_of_the_doctors_lists():
    for name in ("bench_doctor", "bench_doctor_cases", "bench_doctor_books", "bench_doctor_class",
                 "mutants", "confusions"):  # fmt: skip
        root = ast.parse((SCRIPTS / f"{name}.py").read_text(encoding="utf-8"))
        met = {node.module for node in ast.walk(root) if isinstance(node, ast.ImportFrom)}
        met |= {
            a.name for node in ast.walk(root) if isinstance(node, ast.Import) for a in node.names
        }
        assert {m for m in met if (m or "").startswith("kinlab.doctor")} <= DOORS


@pytest.mark.parametrize("robot", ["planar2r", "panda", "stanford"])
def test_the_derivations_by_hand_are_right_where_nothing_is_spoiled(bench, robot):
    arm = kl.load(robot)
    q, v, a = np.random.default_rng(1).uniform(-1, 1, (3, arm.n))
    books = bench.books
    for make, state in ((books.newton_euler, (q, v, a)), (books.jacobian, (q,)), (books.mass, (q,)),
                        (books.kinetic, (q, v)), (books.gravity, (q,))):  # fmt: skip
        name, function = make(arm, "nothing")
        right = getattr(kl, name)(arm, *state)
        assert np.allclose(function(*state), right, rtol=1e-9, atol=1e-9)


def test_the_fivebars_formulas_are_right_where_nothing_is_spoiled(bench):
    for quantity in {one[0] for one in bench.books.FIVEBAR}:
        function = bench.books.fivebar("unequal", quantity, bench.books.right_of(quantity))
        assert kl.compare("unequal", quantity, function, samples=20).agrees


def test_every_misprint_of_the_notes_is_in_the_bench(bench):
    from kinlab.check.catalogue import catalogue

    assert {f.key for f in catalogue() if f.printed is not None} == {*bench.cases.MISPRINTS}


def test_a_run_that_was_stopped_goes_on_and_says_the_same(bench, tmp_path, monkeypatch):
    maker = bench.cases.of_the_fivebar
    monkeypatch.setattr(bench, "classes", lambda: {"a": {"5": maker(5), "9": maker(9)}})
    whole = Namespace(count=1, right=0, seed=5, part=tmp_path / "whole.jsonl")
    first = bench.run(whole)
    lines = whole.part.read_text().splitlines(keepends=True)
    stopped = Namespace(count=1, right=0, seed=5, part=tmp_path / "part.jsonl")
    stopped.part.write_text(lines[0])
    asked = []
    record = bench.record
    monkeypatch.setattr(bench, "record", lambda *given: asked.append(given) or record(*given))
    again = bench.run(stopped)
    assert len(lines) == 2 and len(asked) == 1
    assert [one["verdict"] for one in again] == [one["verdict"] for one in first]
    assert [one["verdict"] for one in first] == ["first", "first"]


def test_one_case_of_every_kind_of_typing_can_be_read(bench):
    text = "m1*l1**2*qdd1 + m2*l1*l2*cos(q2)*qd1"
    formula = bench.cases.Formula("planar2r", "coriolis_torques", (0,), text, [], {}, [])
    for hand in bench.cases.HANDS.values():
        shown = hand("-m2*l1*l2*sin(q2)*(2*qd1*qd2 + qd2**2)")
        assert bench.cases.by_text(formula, shown).agrees
