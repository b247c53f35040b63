"""The catalogue: every id there, every corrected form agrees, every misprint shows."""

from __future__ import annotations

import ast
import inspect
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import kinlab as kl
import kinlab.notes
from kinlab.check.catalogue import catalogue, plan, run, run_one
from kinlab.check.quantities.registry import quantity
from kinlab.check.quantities.serial import members
from kinlab.check.report.summary import grouped
from kinlab.formulas.record import Printed, formula, formulas_in
from kinlab.model.library import shipped

IDS = [
    "000.R",
    "000.dh",
    "000.chain",
    "000.axes",
    "000.fk3r",
    "000.J",
    "000.J3r",
    "000.Jv",
    "000.vel",
    "000.omega",
    "000.Jw3",
    "000.Jframe",
    "000.sing",
    "000.iso",
    "000.iso2r",
    "000.newton",
    "000.pinv",
    "000.grad",
    "000.force",
    "000.tau",
    "000.JTF",
    "000.ne.out",
    "000.ne.com",
    "000.ne.FN",
    "000.ne.in",
    "000.MVG",
    "000.lag",
    "001.eom",
    "001.v2",
    "001.L",
    "001.dLdd1",
    "001.ddt1",
    "001.dLdt1",
    "001.tau1",
    "001.dLdd2",
    "001.ddt2",
    "001.dLdt2",
    "001.tau2",
    "001.D",
    "002.action",
    "002.el",
    "002.dhdef",
    "002.elem",
    "002.T",
    "002.com",
    "002.T2r",
    "002.rot",
    "002.M",
    "002.G",
    "002.Mdot",
    "002.C",
    "002.skew",
    "002.eomC",
    "002.pend",
    "003.loop",
    "003.ABC",
    "003.tan",
    "003.w",
    "003.J",
    "003.acc",
    "003.vw",
    "003.G",
    "003.P",
    "003.speed",
    "003.IM",
    "003.Tmax",
]

MISPRINTED = [
    "000.dh",
    "000.Jv",
    "000.vel",
    "000.omega",
    "000.Jframe",
    "000.iso",
    "000.iso2r",
    "000.pinv",
    "000.JTF",
    "000.ne.out",
    "000.ne.in",
    "000.lag",
    "001.eom",
    "001.v2",
    "001.L",
    "001.ddt1",
    "001.tau1",
    "001.D",
    "002.action",
    "002.el",
    "002.dhdef",
    "002.elem",
    "002.com",
    "002.T2r",
    "002.M",
    "002.G",
    "002.C",
    "002.skew",
    "002.pend",
    "003.ABC",
]

GENERAL = [
    "000.chain",
    "000.J",
    "000.vel",
    "000.omega",
    "000.Jframe",
    "000.force",
    "000.tau",
    "000.JTF",
    "000.ne.out",
    "000.ne.com",
    "000.ne.FN",
    "000.ne.in",
    "000.MVG",
    "000.lag",
    "001.eom",
    "002.el",
    "002.T",
    "002.com",
    "002.M",
    "002.G",
    "002.Mdot",
    "002.eomC",
]


@cache
def rows():
    return tuple(run(plan(catalogue())))


def test_every_id_is_there():
    assert set(IDS) <= {record.id for record in catalogue()}


def test_keys_are_unique():
    keys = [record.key for record in catalogue()]
    assert len(keys) == len(set(keys))


def test_every_corrected_form_agrees():
    wrong = [
        (r.formula.key, r.robot, r.corrected.max_error) for r in rows() if not r.corrected.agrees
    ]
    assert wrong == []


def test_every_misprint_shows_on_each_of_its_robots():
    hidden = [
        (r.formula.key, r.robot, r.printed.max_error)
        for r in rows()
        if r.printed is not None and not r.printed.max_error > 1e-3
    ]
    assert hidden == []
    shown = {r.formula.id for r in rows() if r.printed is not None}
    assert set(MISPRINTED) <= shown


def test_misprinted_rows_say_what_is_wrong():
    for record in catalogue():
        if record.printed is not None:
            assert 20 < len(record.printed.misprint) < 200 and "\n" not in record.printed.misprint
            assert r"\wrong{" in record.printed.latex, record.key
    for row in rows():
        if row.printed is not None:
            assert row.verdict == f"misprint: {row.formula.printed.misprint}"


def test_general_formulas_run_on_every_serial_robot():
    assert {"stanford", "panda", "scara", "puma560", "single_link"} <= set(shipped())
    for identity in GENERAL:
        ran = {r.robot for r in rows() if r.formula.id == identity}
        assert set(shipped()) <= ran, identity


def test_every_row_has_200_states():
    assert {row.corrected.samples for row in rows()} == {200}


def test_states_are_wide_and_never_special():
    for row in rows():
        q = row.corrected.arguments.get("q")
        if q is None or row.formula.key in ("000.Jframe:singular", "000.iso2r:135 degrees"):
            continue
        first = q[:, 0]
        special = np.min(np.abs(first[:, None] - np.pi / 2 * np.arange(-4, 5)), axis=1)
        assert np.max(special) > 0.1, row.formula.key


def test_verdict_of_a_broken_formula():
    record = next(f for f in catalogue() if f.key == "001.tau2")
    broken = replace(record, function=lambda *state: 0.5 * record.function(*state))
    row = run_one(broken, "planar2r")
    assert not row.ok and row.verdict == "DIFFERS from the engine"
    assert grouped([row])[0].verdict == row.verdict
    unshown = replace(record, printed=Printed(record.function, "nothing", "x"))
    row = run_one(unshown, "planar2r")
    assert not row.ok and "does NOT show" in row.verdict


def test_groups_name_the_robots_they_say():
    assert members("serial") == tuple(shipped())
    assert set(members("standard")) | set(members("modified")) == set(members("serial"))
    assert "stanford" in members("sliding") and "puma560" not in members("sliding")
    assert "planar3r" not in members("spatial") and "spatial3r" in members("spatial")
    assert members("puma560") == ("puma560",)


def test_001_tau1_is_off_by_the_stated_amount():
    """printed - true = m2 l2 (l2 a1 + (l2 + l1 c2)(a2² - a2)), in numbers of the table."""
    row = next(r for r in rows() if r.formula.key == "001.tau1")
    m2, l1, l2 = 1.5, 0.5, 0.4
    q, a = row.printed.arguments["q"], row.printed.arguments["a"]
    stated = m2 * l2 * (l2 * a[:, 0] + (l2 + l1 * np.cos(q[:, 1])) * (a[:, 1] ** 2 - a[:, 1]))
    assert row.printed.hand - row.printed.engine == pytest.approx(stated, abs=1e-10)


def test_002_c_is_off_by_the_stated_amount_on_the_2r_arm():
    row = next(r for r in rows() if r.formula.key == "002.C:torque" and r.robot == "planar2r")
    h = 1.5 * 0.5 * 0.4 * np.sin(row.printed.arguments["q"][:, 1])
    d1, d2 = row.printed.arguments["v"].T
    stated = np.stack([h * d2 * (2 * d1 + d2) / 2, -h * d1 * (4 * d1 + 3 * d2) / 2], axis=1)
    assert row.printed.hand - row.printed.engine == pytest.approx(stated, abs=1e-12)


def test_notes_import_numpy_and_each_other_only():
    allowed = ("numpy", "typing", "dataclasses", "collections", "functools", "__future__", "math", "kinlab.host.answers",
               "kinlab.formulas.record", "kinlab.notes")  # fmt: skip
    for file in Path(kinlab.notes.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names = (
                [alias.name for alias in node.names]
                if isinstance(node, ast.Import)
                else [node.module]
                if isinstance(node, ast.ImportFrom)
                else []
            )
            for name in names:
                assert name.startswith(allowed), f"{file.name} imports {name}"


def test_every_formula_is_documented_and_typeset():
    for record in catalogue():
        assert inspect.getdoc(record.function), record.key
        assert record.title and record.latex and "note" in record.source, record.key
        assert quantity(record.quantity).about


def test_one_function_may_carry_several_records():
    @formula("000.x", source="note 000", quantity="fk", robots="panda", latex="x")
    @formula("000.x", part="b", source="note 000", quantity="fk", robots="panda", latex="x")
    def hand(arm, q):
        """Both."""

    module = ModuleType(__name__)
    module.hand = hand
    assert [record.key for record in formulas_in(module)] == ["000.x", "000.x:b"]


def test_seeds_other_than_zero_agree_too():
    for record, name in plan(catalogue(), lambda n: n in ("stanford", "planar2r", "spatial3r")):
        row = run_one(record, name, samples=20, seed=7)
        assert row.corrected.agrees, (record.key, name, row.corrected.max_error)


def test_kl_compare_takes_the_catalogue_functions_arms():
    table = kl.load("planar2r").table
    assert kl.compare(table, "fk", table_fk(table)).agrees


def table_fk(table):
    return lambda q: table.fk(q)[-1]
