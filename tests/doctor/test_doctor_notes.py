"""The notes' misprints, given to the doctor as plain functions: it is not told what is wrong."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.check.catalogue import catalogue
from kinlab.check.quantities.serial import numbers

NAMED = [
    ("001.tau1", "planar2r", ["qdd2**2 where the engine has qdd2", "m2*l2**2 is there twice"]),
    ("001.v2", "planar2r", ["qd1*qd2 is smaller than the engine's by 2*l2**2",
                            "qd1 is larger than the engine's by 2*l2**2",
                            "qd2 is larger than the engine's by l2**2"]),
    ("001.L", "planar2r", ["qd1*qd2 is smaller than the engine's by m2*l2**2",
                           "qd2 is larger than the engine's by m2*l2**2/2"]),
    ("001.ddt1", "planar2r", ["sin(q2)*qd1*qd2 is larger than the engine's by 2*m2*l1*l2",
                              "sin(q2)*qdd1*qdd2 is smaller than the engine's by 2*m2*l1*l2",
                              "sin(q2)*qdd2**2"]),
    ("001.D:tau", "planar2r", ["qd2 where the engine has qd2**2",
                               "qd1 where the engine has qd1**2"]),
    ("002.C:C", "planar2r", ["the symmetric form, not Christoffel's"]),
    ("002.C:C", "puma560", ["the symmetric form, not Christoffel's"]),
    ("002.C:torque", "spatial3r", ["the symmetric formula for C, not Christoffel's"]),
    ("002.pend:torque", "single_link", ["gravity with the opposite sign"]),
    ("002.pend:L", "single_link", ["gravity with the opposite sign"]),
    ("002.M:M", "puma560", ["not rotated: I for R I R^T"]),
    ("002.el", "spatial3r", ["the opposite sign as a whole"]),
    ("000.lag:u", "spatial3r", ["gravity with the opposite sign"]),
    ("000.ne.in:tau", "spatial3r", ["leaves gravity out"]),
]  # fmt: skip


@pytest.mark.parametrize(("key", "robot", "words"), NAMED)
def test_a_misprint_is_named(key: str, robot: str, words: list[str]) -> None:
    row = next(f for f in catalogue() if f.key == key)
    arm, printed = numbers(kl.load(robot)), row.printed
    assert printed is not None
    found = kl.diagnose(
        robot, row.quantity, lambda *state: printed.function(arm, *state), samples=60
    )
    assert not found.agrees
    for said in words:
        assert said in found.sentence
    assert found.causes[0].error_after <= 1e-9


@pytest.mark.parametrize(("key", "robot"), sorted({(k, r) for k, r, _ in NAMED}))
def test_the_corrected_form_agrees(key: str, robot: str) -> None:
    row = next(f for f in catalogue() if f.key == key)
    arm = numbers(kl.load(robot))
    assert kl.diagnose(
        robot, row.quantity, lambda *state: row.function(arm, *state), samples=60
    ).agrees


def test_bare_signs_are_no_evidence_for_a_reading() -> None:
    row = next(f for f in catalogue() if f.key == "002.action:least")
    printed = row.printed
    assert printed is not None
    arm = numbers(kl.load("single_link"))
    found = kl.diagnose(
        "single_link", row.quantity, lambda *state: printed.function(arm, *state), samples=20
    )
    assert found.verdict == "differs, cause unknown"
