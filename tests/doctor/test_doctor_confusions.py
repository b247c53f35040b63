"""Confusions made with Pinocchio and changed tables, two at a time, and slips that hide."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import kinlab as kl
from kinlab.doctor.file import examine_file

PUMA = kl.load("puma560")
ARM = kl.load("planar2r")


def first(quantity: str, function: object, robot: object = PUMA) -> tuple[str, ...]:
    found = kl.diagnose(robot, quantity, function, samples=40)
    assert not found.agrees
    assert found.causes, found
    assert found.causes[0].error_after <= 1e-9
    return found.causes[0].kinds


def of_file(tmp_path: Path, **formulas: str) -> list:
    lines = [f'{name} = "{text}"' for name, text in formulas.items()]
    file = tmp_path / "f.toml"
    file.write_text("\n".join(['robot = "planar2r"', "[formulas]", *lines]) + "\n")
    return examine_file(file, samples=40)


def test_the_other_convention() -> None:
    other = "standard" if str(PUMA.table.convention) == "modified" else "modified"
    read = kl.Robot.from_dh(replace(PUMA.table, convention=kl.Convention(other)))
    assert first("fk", lambda q: kl.fk(read, q)) == ("convention",)


def test_no_gyroscopic_term() -> None:
    model, data = PUMA.model, PUMA.model.createData()

    def wrong(q, v, a):
        tau = np.array(kl.inverse_dynamics(PUMA, q, v, a))
        pin.computeJointJacobians(model, data, np.array(q))
        for k in range(1, model.njoints):
            jac = pin.getJointJacobian(model, data, k, pin.LOCAL_WORLD_ALIGNED)[3:]
            turn = data.oMi[k].rotation
            spin = turn @ model.inertias[k].inertia @ turn.T @ jac @ v
            tau -= jac.T @ np.cross(jac @ v, spin)
        return tau

    assert first("inverse_dynamics", wrong) == ("gyroscopic term",)


def test_inertias_about_the_joint() -> None:
    model = pin.Model(PUMA.model)
    for k in range(1, model.njoints):
        old = PUMA.model.inertias[k]
        shift = pin.Inertia(old.mass, old.lever, np.zeros((3, 3))).matrix()[3:, 3:]
        model.inertias[k] = pin.Inertia(old.mass, old.lever, old.inertia + shift)
    data = model.createData()

    def wrong(q, v, a):
        return pin.rnea(model, data, np.array(q), np.array(v), np.array(a))

    assert first("inverse_dynamics", wrong) == ("inertia point",)


def test_no_rotor_inertia() -> None:
    scara = kl.load("scara")
    links = [replace(link, armature=0.0) for link in scara.table.links]
    bare = kl.Robot.from_dh(replace(scara.table, links=links))
    assert first("mass_matrix", lambda q: kl.mass_matrix(bare, q), scara) == ("rotor inertia",)


def test_two_confusions_at_once() -> None:
    kinds = first("jacobian", lambda q: np.roll(kl.jacobian(PUMA, q, "tool"), 3, axis=0))
    assert set(kinds) == {"frame", "row order"}


def test_a_confusion_and_a_slip() -> None:
    def wrong(q, v, a):
        tau = kl.inverse_dynamics(ARM, q, v, a)
        return np.array([-tau[0], -tau[1] + 0.7 * v[0] * v[1] * np.sin(q[1])])

    kinds = first("inverse_dynamics", wrong, ARM)
    assert "sign" in kinds
    assert len(kinds) <= 3


def test_what_fits_most_states_only_is_no_finding() -> None:
    calls = []

    def wrong(q):
        calls.append(q)
        torques = kl.gravity_torques(ARM, q)
        torques[0] *= 2.0 if len(calls) <= 35 else 2.1
        return torques

    found = kl.diagnose(ARM, "gravity_torques", wrong, samples=40)
    assert found.verdict == "differs, cause unknown"


def test_a_slip_that_only_the_numbers_hide(tmp_path: Path) -> None:
    assert of_file(tmp_path, M22="m2*l2**2")[0].agrees
    right = "(m1 + m2)*l1**2 + m2*l2**2 + 2*m2*l1*l2*cos(q2)"
    hidden = right.replace("l1**2", "l1/2")  # l1 is 0.5
    assert of_file(tmp_path, M11=right)[0].agrees
    assert not of_file(tmp_path, M11=hidden)[0].agrees


def test_a_factor_and_an_argument_in_one_term(tmp_path: Path) -> None:
    wrong = "(m1 + m2)*g*l1*cos(q1) + 2*m2*g*l2*cos(q2)"
    found = of_file(tmp_path, g1=wrong)[0]
    assert sorted(found.causes[0].kinds) == ["argument", "factor"]


def test_half_a_symmetric_matrix_is_the_whole(tmp_path: Path) -> None:
    found = of_file(
        tmp_path, M11="(m1 + m2)*l1**2 + m2*l2**2 + 2*m2*l1*l2*c2",
        M12="m2*l2**2 + m2*l1*l2*c2", M22="m2*l2**2",
    )  # fmt: skip
    assert len(found) == 1
    assert found[0].agrees


@pytest.mark.parametrize(
    ("entry", "text"),
    [("J12", "-l2*s12"), ("J21", "l1*c1 + l2*c12"), ("J31", "1"), ("C12", "-m2*l1*l2*s2*(qd1+qd2)")],
)  # fmt: skip
def test_rows_come_before_columns(tmp_path: Path, entry: str, text: str) -> None:
    assert of_file(tmp_path, **{entry: text})[0].agrees


def test_a_factor_and_an_argument_in_one_term_of_a_function() -> None:
    def wrong(q):
        weight = 1.5 * 9.81 * 0.4  # m2 g l2
        torques = kl.gravity_torques(ARM, q)
        torques[0] += weight * (3 * np.cos(q[1]) - np.cos(q[0] + q[1]))
        return torques

    assert sorted(first("gravity_torques", wrong, ARM)) == ["argument", "factor"]


def test_a_factor_of_the_whole_sum_left_out(tmp_path: Path) -> None:
    found = of_file(tmp_path, V="(m1 + m2)*l1*sin(q1) + m2*l2*sin(q1 + q2)")[0]
    assert found.causes[0].kinds == ("missing factor",)
