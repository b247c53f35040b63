"""The formula doctor: misprints and confusions are named, right formulas are left alone."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.file import examine_file
from kinlab.errors import ExpressionError, FileError, OptionError
from kinlab.formulas.text import parse

TAU1 = (
    "((m1+m2)*l1**2 + m2*l2**2 + 2*m2*l1*l2*c2)*qdd1 + (m2*l2**2 + m2*l1*l2*c2)*qdd2"
    " - 2*m2*l1*l2*s2*qd1*qd2 - m2*l1*l2*s2*qd2**2 + (m1+m2)*g*l1*c1 + m2*g*l2*c12"
)


def one(tmp_path: Path, text: str, entry: str = "tau1"):
    file = tmp_path / "f.toml"
    file.write_text(f'robot = "planar2r"\n[formulas]\n"{entry}" = "{text}"\n')
    return examine_file(file)[0]


def test_right_formulas_agree_in_any_form(tmp_path: Path) -> None:
    assert one(tmp_path, TAU1).agrees
    assert one(tmp_path, TAU1.replace("c12", "(c1*c2 - s1*s2)")).agrees
    assert one(tmp_path, TAU1.replace("c2)*qdd2", "(1 - 2*sin(q2/2)**2))*qdd2")).agrees


@pytest.mark.parametrize(
    ("right", "wrong", "kind"),
    [
        ("- 2*m2*l1", "+ 2*m2*l1", "sign"),
        ("*l2*c2)*qdd2", "*l2*s2)*qdd2", "sin/cos"),
        ("g*l2*c12", "g*l2*c2", "argument"),
        ("qd2**2", "qd2", "power"),
        ("qd1*qd2", "qdd1*qd2", "velocity for acceleration"),
        ("- 2*m2*l1", "- m2*l1", "factor"),
        (" + m2*g*l2*c12", "", "missing term"),
        ("(m1+m2)*g", "(m1+m1)*g", "index"),
        ("m2*g*l2*c12", "g*l2*c12", "missing factor"),
    ],
)
def test_single_slips_in_a_text(tmp_path: Path, right: str, wrong: str, kind: str) -> None:
    assert right in TAU1
    found = one(tmp_path, TAU1.replace(right, wrong))
    assert not found.agrees
    assert kind in {k for cause in found.causes[:2] for k in cause.kinds}
    assert found.causes[0].error_after <= 1e-9


def test_the_printed_torque_of_note_001(tmp_path: Path) -> None:
    printed = TAU1.replace("m2*l2**2 + 2*", "m2*l2**2 + m2*l2**2 + 2*").replace(
        "qdd2 -", "qdd2**2 -"
    )
    found = one(tmp_path, printed)
    assert "qdd2**2 should be qdd2" in found.sentence
    assert "m2*l2**2 does not belong" in found.sentence


PUMA = kl.load("puma560")


@pytest.mark.parametrize(
    ("quantity", "function", "words"),
    [
        ("jacobian", lambda q: kl.jacobian(PUMA, q, "tool"), "is the tool Jacobian"),
        ("jacobian", lambda q: np.roll(kl.jacobian(PUMA, q), 3, axis=0), "angular rows first"),
        ("jacobian", lambda q: kl.jacobian(PUMA, q).T, "is transposed"),
        ("fk", lambda q: np.linalg.inv(kl.fk(PUMA, q)), "inverse transform"),
        ("gravity_torques", lambda q: kl.gravity_torques(PUMA, np.deg2rad(q)), "degrees"),
        ("statics", lambda q, w: -kl.statics(PUMA, q, w), "passive sign"),
    ],
)
def test_readings(quantity: str, function: object, words: str) -> None:
    found = kl.diagnose(PUMA, quantity, function, samples=40)
    assert not found.agrees
    assert any(words in c.sentence for c in found.causes)
    assert all(c.error_after <= 1e-9 for c in found.causes)


def test_a_function_with_a_term_twice() -> None:
    robot = kl.load("planar2r")

    def tau(q, v, a):
        out = kl.inverse_dynamics(robot, q, v, a)
        out[0] += 1.5 * 0.4**2 * a[0]
        return out

    found = kl.diagnose(robot, "inverse_dynamics", tau)
    assert "m2*l2**2*qdd1 is there twice" in found.sentence


def test_nothing_is_guessed() -> None:
    robot = kl.load("planar2r")
    found = kl.diagnose(
        robot, "gravity_torques", lambda q: kl.gravity_torques(robot, q) + np.tanh(q)
    )
    assert found.verdict == "differs, cause unknown"
    assert not found.causes


@pytest.mark.parametrize(
    "text",
    ["__import__('os')", "9**9**9**9", "q1.x", "(" * 9000 + "1" + ")" * 9000, "-" * 9000 + "1",
     "1e400", "[1]", "lambda: 1", "1/0", "'a'", "True", "sin(q1", "foo(q1)", "1+" * 3000 + "1",
     "((((9**6)**6)**6)**6)**6"],
)  # fmt: skip
def test_hostile_text_is_refused_at_once(text: str) -> None:
    start = time.process_time()
    with pytest.raises(ExpressionError):
        parse(text)
    assert time.process_time() - start < 1.0


def test_hostile_files_and_messages(tmp_path: Path) -> None:
    file = tmp_path / "f.toml"
    file.write_text("x = " + "1" * 10_000_000)
    with pytest.raises(FileError, match="at most"):
        examine_file(file)
    file.write_text("x = " + "[" * 10_000)
    with pytest.raises(FileError):
        examine_file(file)
    with pytest.raises(ExpressionError, match="'zz9' is unknown"):
        one(tmp_path, "zz9")
    with pytest.raises(ExpressionError, match="names no quantity"):
        one(tmp_path, "q1", "frob")
    with pytest.raises(OptionError, match="samples"):
        kl.diagnose(PUMA, "fk", lambda q: q, samples=1)


def test_one_entry_of_a_matrix_alone(tmp_path: Path) -> None:
    assert one(tmp_path, "m2*l2**2 + m2*l1*l2*c2", "M12").agrees
    found = one(tmp_path, "cos(q1)", "jacobian[5,1]")
    assert not found.agrees


def test_one_joint() -> None:
    robot = kl.load("single_link")
    found = kl.diagnose(
        robot, "inverse_dynamics", lambda q, v, a: -kl.inverse_dynamics(robot, q, v, a)
    )
    assert found.causes[0].kinds in (("sign",), ("row sign",))


_TAU1 = (
    "m2*l2**2*(qdd1+qdd2)+m2*l1*l2*c2*(2*qdd1+qdd2)+(m1+m2)*l1**2*qdd1-m2*l1*l2*s2*qd2**2"
    "-2*m2*l1*l2*s2*qd1*qd2+m2*l2*g*c12+(m1+m2)*l1*g*c1"
)


@pytest.mark.parametrize(
    "slips",
    [
        (("l1**2*qdd1", "l1*qdd1"), ("g*c12", "g*c2"), ("s2*qd2**2", "c2*qd2**2")),
        (("l1**2*qdd1", "l1*qdd1"), ("-2*m2", "+2*m2"), ("s2*qd2**2", "c2*qd2**2"), ("g*c12", "g*c2")),
        (("c2*(2", "s2*(2"), ("-2*m2", "+2*m2"), ("s2*qd2**2", "c2*qd2**2"), ("l1*g*c1", "l1*g*s1")),
    ],
)  # fmt: skip
def test_slips_in_several_parts_are_found_part_by_part(slips):
    text = _TAU1
    for right, wrong in slips:
        text = text.replace(right, wrong)
    found = kl.diagnose("planar2r", "tau1", text, samples=30)
    assert list(found.causes[0].shown.values()) == [_TAU1]
    assert len(found.causes[0].kinds) == len(slips)


def test_what_is_right_is_said_where_no_slip_explains_the_rest():
    text = _TAU1.replace("m2*l2*g*c12", "(m1 + 5*l2)*g*sin(q1)**3*cos(q2 - 3*q1) + g*l1**3")
    found = kl.diagnose("planar2r", "tau1", text, samples=30)
    assert not found.causes
    assert found.proved == (
        "the terms in the velocities and the terms in the accelerations: right; "
        "the gravity terms: wrong",
    )
