"""The notes' misprints, given to the doctor as plain functions: it is not told what is wrong."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import kinlab as kl
from kinlab.check.catalogue import catalogue
from kinlab.check.quantities.fivebar import FIVEBAR
from kinlab.check.quantities.fivebar import numbers as fivebar_numbers
from kinlab.check.quantities.serial import numbers
from kinlab.doctor.file import examine_formulas, robot_of
from kinlab.formulas.files import formula_file
from kinlab.notes.loop import S

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
    ("000.vel", "stanford", ["leaves qd*z out in the velocity v of the link's origin"]),
    ("000.omega:last frame", "puma560", ["R^T for R (transposed) in the Jacobian's column"]),
    ("000.ne.out", "puma560", ["rotated after the cross product"]),
    ("000.pinv:redundant", "panda", ["rounding alone", "J^T (J J^T)^-1 is meant"]),
    ("002.T2r:T_02", "planar2r_rods", ["cos(q1) + q2 where the engine has cos(q1 + q2)"]),
    ("002.C:gradient", "planar2r", ["one number for the whole vector"]),
]  # fmt: skip


@pytest.mark.many
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


RODS = [
    ({"rod": 0.0, "rod_inertia": 0.0}, "(the rods' force on the tool) out"),
    ({"rod_inertia": 0.0}, "leaves Id*alpha*K out"),
    ({"rod_com": 0.0}, "the rods' centres at the elbows"),
    ({"payload": 2.0}, "counts m*(a + g*E2) twice"),
]


@pytest.mark.parametrize(("spoilt", "words"), RODS)
def test_rods_with_mass(spoilt: dict[str, float], words: str) -> None:
    """The exact torque of note 003's robot, with the numbers of its rods taken otherwise."""
    row = next(f for f in catalogue() if f.key == "003.vw:rods")
    loop = fivebar_numbers(FIVEBAR.load("unequal"))
    other = replace(loop, **{name: factor * getattr(loop, name) for name, factor in spoilt.items()})
    found = kl.diagnose("unequal", row.quantity, lambda *s: row.function(other, *s), samples=20)
    assert not found.agrees
    assert words in found.sentence
    assert kl.diagnose(
        "unequal", row.quantity, lambda *s: row.function(loop, *s), samples=20
    ).agrees


def test_the_loop_with_the_other_leg() -> None:
    loop = fivebar_numbers(FIVEBAR.load("unequal"))

    def length(theta: Any, xy: Any, side: float) -> Any:
        along = side * S * loop.e + loop.l1 * np.cos(theta) - xy[0]
        return np.hypot(along, loop.l1 * np.sin(theta) - xy[1])

    name = "fivebar_rod_length"
    assert kl.diagnose("unequal", name, lambda t, xy: length(t, xy, 1.0), samples=20).agrees
    found = kl.diagnose("unequal", name, lambda t, xy: length(t, xy, -1.0), samples=20)
    assert "s*e with the opposite sign" in found.sentence


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("orthogonal_columns_cosine", "-l2/l1", "is orthogonal_columns_cosine"),
        ("orthogonal_columns_cosine", "-l1/l2", "l1 and l2 exchanged"),
        ("equal_columns_cosine", "-l1/l2", "l2 for 2*l2"),
    ],
)
def test_isotropic_poses_as_text(name: str, text: str, words: str) -> None:
    assert words in kl.diagnose("planar2r", name, text).sentence


def test_isotropy_is_of_the_rows() -> None:
    robot = kl.load("planar2r")

    def conditions(q: Any, turned: bool) -> Any:
        j = kl.jacobian(robot, q)[:2]
        products = j.T @ j if turned else j @ j.T
        return [products[0, 0] - products[1, 1], products[0, 1]]

    name = "isotropy_conditions"
    assert kl.diagnose(robot, name, lambda q: conditions(q, False), samples=20).agrees
    found = kl.diagnose(robot, name, lambda q: conditions(q, True), samples=20)
    assert "J^T J for J J^T" in found.sentence


STATICS = [
    ("-fx*(l1*s1+l2*s12)+fy*(l1*c1+l2*c12)", "-fx*l2*s12+fy*l2*c12", "is statics of planar2r"),
    (
        "-F_x*(l1*s1+l2*s12)+F_y*(l1*c1+l2*c12)+M_z",
        "-F_x*l2*s12+F_y*l2*c12+M_z",
        "is statics of planar2r",
    ),
    ("l1*s2*fx+(l2+l1*c2)*fy", "l2*fy", "the wrench is read in tool axes"),
    ("fx*(l1*s1+l2*s12)-fy*(l1*c1+l2*c12)", "fx*l2*s12-fy*l2*c12", "passive sign"),
    ("-fx*(l1*s1+l2*s12)+fy*(l1*c1+l2*c12)", "-fx*l2*s2+fy*l2*c2", "c2 should be c12 in fy*l2*c2"),
    ("-fx*(l1*s1+l2*s12)+fy*(l1*c1+l2*c12)", "-fx*q1**3+fy*q2*s1*c2", "tau1: right"),
]


@pytest.mark.parametrize(("first", "second", "words"), STATICS)
def test_statics_as_text(first: str, second: str, words: str) -> None:
    entries = {"tau1": first, "tau2": second}
    file = formula_file({"robot": "planar2r", "formulas": entries}, "hand in")
    (found,) = examine_formulas(file, robot_of(file), 40, 0)
    assert words in found.sentence
    assert found.agrees == (not any(word in words for word in ("passive", "right", "should")))


_X, _Y = "(l1*sin(q1) + l2*sin(q1+q2))*Fx", "(l1*cos(q1) + l2*cos(q1+q2))*Fy"
_MOVING = "m2*l2^2*(ddq1+ddq2) + m2*l1*l2*(c2*ddq1+s2*dq1^2) + m2*l2*g*c12"
_WITHOUT = [
    ("planar2r", "statics[0]", f"tau1 = -{_X} + {_Y}", "nz"),
    ("planar2r", "statics[0]", f"tau1 = -{_X} - {_Y}", "nz"),
    ("planar2r", "statics[1]", "tau2 = -l2*sin(q1+q2)*Fx + l2*cos(q1+q2)*Fx", "nz"),
    ("planar2r", "statics[0]", f"tau1 = -{_X} - {_Y} + Mz", ""),
    ("scara", "statics[0]", f"tau1 = -{_X} + {_Y}", "nz"),
    ("scara", "statics[2]", "tau3 = -Fz", ""),
    ("scara", "statics[3]", "tau4 = -Mz", ""),
    ("planar2r", "statics_tool[1]", "tau2 = l2*Fy", "nz"),
    ("planar2r", "inverse_dynamics_loaded[1]", f"tau2 = {_MOVING}", "fx, fy, nz"),
    ("planar2r", "tau2", f"tau2 = {_MOVING} - l2*s12*Fx + l2*c12*Fy", "nz"),
    ("planar2r", "tau2", f"tau2 = {_MOVING} - l2*s12*Fx + l2*c12*Fy + Mz", ""),
    ("planar2r", "inverse_dynamics[1]", f"tau2 = {_MOVING}", ""),
]


@pytest.mark.parametrize(("robot", "quantity", "text", "forces"), _WITHOUT)
def test_a_force_that_its_joint_feels_and_no_line_has_is_said(
    robot: str, quantity: str, text: str, forces: str
) -> None:
    found = kl.diagnose(robot, quantity, text)
    assert found.agrees or found.causes
    said = [remark for remark in found.remarks if "as if there were none" in remark]
    assert said == ([f"it has no {forces} of the tool: as if there were none"] if forces else [])


@pytest.mark.parametrize(
    ("robot", "quantity", "text", "right"),
    [
        ("planar2r", "statics[0]", "tau1 = 0", False),
        ("planar2r", "statics[1]", "tau2 = nz", False),
        ("scara", "statics[3]", "tau4 = 0", False),
        ("scara", "statics[3]", "tau4 = -nz", True),
    ],
)
def test_a_static_torque_that_names_no_force_is_of_all_that_its_joint_feels(
    robot: str, quantity: str, text: str, right: bool
) -> None:
    found = kl.diagnose(robot, quantity, text)
    assert found.agrees == right
    assert not any("as if there were none" in remark for remark in found.remarks)
    put = [new for cause in found.causes for new in cause.corrected.values()]
    assert not any(new.startswith("0") for new in put)


def test_a_torque_of_a_motion_with_a_force_at_the_tool() -> None:
    text = (
        "m2*l2**2*(qdd1+qdd2)+m2*l1*l2*c2*qdd1+m2*l1*l2*s2*qd1**2+m2*l2*g*c12-fx*l2*s12+fy*l2*c12"
    )
    found = kl.diagnose("planar2r", "tau2", text)
    assert found.agrees
    assert found.quantity == "inverse_dynamics_loaded[1]"


def test_the_boundary_term_of_the_action() -> None:
    row = next(f for f in catalogue() if f.key == "002.action:boundary term")
    arm, printed = numbers(kl.load("single_link")), row.printed
    assert printed is not None
    found = kl.diagnose(
        "single_link", row.quantity, lambda *state: printed.function(arm, *state), samples=10
    )
    assert "(the boundary term) with the opposite sign" in found.sentence
    assert "dL/dqd(t2) for dL/dqd(t1)" in found.sentence


def test_what_divides_by_zero_is_rounding() -> None:
    def quotient(q: Any) -> Any:
        nothing = np.cos(q) ** 2 + np.sin(q) ** 2 - 1.0 + 3e-17
        return q * nothing / (nothing + np.roll(nothing, 1))

    found = kl.diagnose("planar2r", "gravity_torques", quotient, samples=20)
    assert "rounding alone: it inverts a singular matrix, or divides by" in found.sentence
    smooth = kl.diagnose("planar2r", "gravity_torques", lambda q: q * np.cosh(q), samples=20)
    assert "rounding alone" not in smooth.sentence


def test_bare_signs_are_no_evidence_for_a_reading() -> None:
    row = next(f for f in catalogue() if f.key == "002.action:least")
    printed = row.printed
    assert printed is not None
    arm = numbers(kl.load("single_link"))
    found = kl.diagnose(
        "single_link", row.quantity, lambda *state: printed.function(arm, *state), samples=20
    )
    assert found.verdict == "differs, cause unknown"
