"""Functions that are right to their digits, numbers of the robot, and what can be proved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kinlab as kl
from kinlab.check.quantities.registry import quantities

ARM = kl.load("spatial3r")


def turned(rows, q, pi=np.pi):
    """The pose of a modified table's last frame, with another pi in its angles."""
    pose = np.eye(4)
    for row, x in zip(rows, q, strict=True):
        ct, st = np.cos(row.theta * pi / np.pi + x), np.sin(row.theta * pi / np.pi + x)
        ca, sa = np.cos(row.alpha * pi / np.pi), np.sin(row.alpha * pi / np.pi)
        pose = pose @ np.array([[ct, -st, 0, row.a], [st * ca, ct * ca, -sa, -sa * row.d],
                                [st * sa, ct * sa, ca, ca * row.d], [0, 0, 0, 1]])  # fmt: skip
    return pose @ np.asarray(ARM.table.tool)


def by_differences(step, central):
    def jacobian(q):
        here = turned(ARM.table.links, q)
        columns = []
        for unit in np.eye(3):
            behind = turned(ARM.table.links, q - step * unit) if central else here
            rate = (turned(ARM.table.links, q + step * unit) - behind) / (
                (2 if central else 1) * step
            )
            spin = rate[:3, :3] @ here[:3, :3].T
            columns.append([*rate[:3, 3], spin[2, 1], spin[0, 2], spin[1, 0]])
        return np.array(columns).T

    return jacobian


@pytest.mark.parametrize(("step", "central"), [(1e-5, False), (1e-8, False), (1e-4, True)])
def test_finite_differences_are_right_to_their_digits(step, central) -> None:
    found = kl.diagnose(ARM, "jacobian", by_differences(step, central), samples=20)
    assert found.agrees
    assert found.error_before > 1e-9
    assert found.grade == "right to its digits"
    assert "digits" in found.sentence


def test_a_slip_is_named_through_finite_differences() -> None:
    right = by_differences(1e-6, False)
    signs = np.array([[-1], [-1], [-1], [1], [1], [1]])
    found = kl.diagnose(ARM, "jacobian", lambda q: signs * right(q), samples=20)
    assert not found.agrees
    assert "sign" in found.sentence
    assert "finite differences" in found.sentence


@pytest.mark.parametrize("pi", [3.14, 3.1416])
def test_a_rounded_pi_in_the_angles(pi) -> None:
    found = kl.diagnose(ARM, "fk", lambda q: turned(ARM.table.links, q, pi), samples=20)
    assert found.grade == "right with rounded numbers"
    assert str(pi) in found.sentence


def test_rounded_thirds_inside_a_function_are_right_to_their_digits() -> None:
    arm = kl.load("planar2r_rods")
    (l1, l2), (m1, m2) = ([getattr(k, x) for k in arm.table.links] for x in ("a", "mass"))

    def mass(q, third=0.3333):
        c2 = np.cos(q[1])
        m12 = m2 * (third * l2**2 + 0.5 * l1 * l2 * c2)
        m11 = third * m1 * l1**2 + m2 * (l1**2 + third * l2**2 + l1 * l2 * c2)
        return np.array([[m11, m12], [m12, third * m2 * l2**2]])

    found = kl.diagnose(arm, "mass_matrix", mass, samples=20)
    assert found.agrees
    assert "0.3333 stands for 1/3" in found.remarks
    # 0.4 is no third
    assert not kl.diagnose(arm, "mass_matrix", lambda q: mass(q, 0.4), samples=20).agrees


def test_a_small_slip_that_is_no_rounding_is_not_called_right() -> None:
    def torques(q, v, a):
        return kl.inverse_dynamics(ARM, q, v, a) + 5e-4 * np.abs(a) ** 0.5

    found = kl.diagnose(ARM, "inverse_dynamics", torques, samples=20)
    assert not found.agrees
    assert found.grade in ("wrong", "not sure")


@pytest.mark.parametrize("factor", [1.001, 0.9995])
def test_a_small_factor_is_neither_right_nor_named(factor) -> None:
    arm = kl.load("planar2r")
    found = kl.diagnose(arm, "gravity_torques", lambda q: factor * kl.gravity_torques(arm, q),
                        samples=20)  # fmt: skip
    assert not found.agrees
    assert found.grade == "not sure"
    assert found.verdict == "nearly agrees, cause unknown"
    assert "digits only" in found.sentence


def with_row(**columns):
    from dataclasses import replace

    rows = list(ARM.table.links)
    rows[1] = replace(rows[1], **columns)
    return kl.Robot.from_dh(replace(ARM.table, links=rows))


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"a": 0.77}, "takes 0.77 for a of link 2"),
        ({"mass": 3.3}, "takes 3.3 for the mass of link 2"),
    ],
)
def test_a_number_of_the_robot_is_another(columns, words) -> None:
    other = with_row(**columns)
    found = kl.diagnose(
        ARM, "mass_matrix", lambda q: np.asarray(kl.mass_matrix(other, q)), samples=20
    )
    assert words in found.sentence


@pytest.mark.usefixtures("without_lines")
def test_statics_from_link_to_link() -> None:
    rows, tool = ARM.table.links, np.asarray(ARM.table.tool)

    def torques(q, wrench, lever=1.0):
        ways = [turned([row], [x]) @ np.linalg.inv(tool) for row, x in zip(rows, q, strict=True)]
        last = ways[0] @ ways[1] @ ways[2]
        force = last[:3, :3].T @ wrench[:3]
        moment = last[:3, :3].T @ wrench[3:] + np.cross(tool[:3, 3], force)
        out = np.zeros(3)
        for i in (2, 1, 0):
            out[i] = moment[2]
            turn, place = ways[i][:3, :3], ways[i][:3, 3]
            force = turn @ force
            moment = turn @ moment + lever * np.cross(place, force)
        return out

    assert kl.diagnose(ARM, "statics", torques, samples=20).agrees
    found = kl.diagnose(ARM, "statics", lambda q, w: torques(q, w, 0.0), samples=20)
    assert "leaves P x f out in the moment n" in found.sentence
    found = kl.diagnose(ARM, "statics", lambda q, w: torques(q, w, -1.0), samples=20)
    assert "sign" in found.sentence


def test_gravity_in_every_column_of_unit_accelerations() -> None:
    def mass(q):
        still = np.zeros(3)
        return np.stack([kl.inverse_dynamics(ARM, q, still, unit) for unit in np.eye(3)], axis=1)

    found = kl.diagnose(ARM, "mass_matrix", mass, samples=20)
    assert "has the gravity torques in it" in found.sentence


def test_the_rotors_are_left_out() -> None:
    arm = kl.load("puma560")
    rotors = np.asarray(arm.model.armature)
    found = kl.diagnose(
        arm, "mass_matrix", lambda q: kl.mass_matrix(arm, q) - np.diag(rotors), samples=20
    )
    assert "leaves out the rotors' inertia (armature)" in found.sentence


def test_what_can_be_proved_by_kind_of_term() -> None:
    arm = kl.load("planar2r")

    def torques(q, v, a):
        return kl.inverse_dynamics(arm, q, v, a) + 0.3 * np.abs(np.sin(3 * q)) ** 1.5

    found = kl.diagnose(arm, "inverse_dynamics", torques, samples=20)
    assert not found.causes
    said = "the terms in the velocities and the terms in the accelerations: right; "
    assert said + "the gravity terms: wrong" in found.sentence
    assert said + "the gravity terms: wrong" in found.as_dict()["proved"]


def test_what_can_be_proved_by_entries() -> None:
    def jacobian(q):
        out = np.array(kl.jacobian(ARM, q))
        out[:, 1] += np.sin(q[0]) ** 3
        return out

    found = kl.diagnose(ARM, "jacobian", jacobian, samples=20)
    assert not found.causes
    assert "columns 1 and 3: right" in found.sentence


def _by_numbers(constant: float):
    def mass(q):
        c = 0.3 * np.cos(q[1])
        return np.array([[constant + 2 * c, 0.24 + c], [0.24 + c, 0.24]])

    return mass


def test_a_function_whose_coefficients_are_right_to_two_decimals() -> None:
    """1.12 is 1.115 rounded, as a text is; 1.13 is not."""
    assert kl.diagnose("planar2r", "mass_matrix", _by_numbers(1.115)).form == ""
    rounded = kl.diagnose("planar2r", "mass_matrix", _by_numbers(1.12))
    assert rounded.agrees and rounded.form == "rounded"
    assert kl.diagnose("planar2r", "mass_matrix", _by_numbers(1.13)).grade == "wrong"


def test_a_slip_in_a_small_inertia_is_not_called_right() -> None:
    puma = kl.load("puma560")
    *links, last = puma.table.links
    heavier = replace(last, inertia=1.1 * np.asarray(last.inertia))
    other = kl.Robot.from_dh(replace(puma.table, links=[*links, heavier]))
    found = kl.diagnose(puma, "mass_matrix", lambda q: kl.mass_matrix(other, q), samples=20)
    assert found.error_before < 1e-5
    assert not found.agrees and found.grade == "not sure"


def test_the_noise_of_differences_is_told_from_a_small_slip() -> None:
    """Both are off by 1e-5; one of them has the rounding of what it subtracts."""
    arm = kl.load("planar2r")

    def slip(q):
        return kl.gravity_torques(arm, q) + np.array([2e-4 * q[0], 0.0])

    def forward(q):
        step, energy = 1e-5 * np.eye(2), kl.potential_energy(arm, q)
        return np.array([(kl.potential_energy(arm, q + e) - energy) / 1e-5 for e in step])

    assert not kl.diagnose(arm, "gravity_torques", slip).agrees
    found = kl.diagnose(arm, "gravity_torques", forward)
    assert found.error_before > 1e-6
    assert (found.agrees, found.grade) == (True, "right to its digits")


def test_the_opposite_of_a_sum_is_written_without_a_sign_before_its_sign() -> None:
    def jacobian(q):
        rows = kl.jacobian(kl.load("planar2r"), q).copy()
        rows[0, 0] *= -1
        return rows

    said = kl.diagnose("planar2r", "jacobian", jacobian).causes[0].sentence
    assert "it has l1*sin(q1) + l2*sin(q1 + q2) where the engine has -l1*sin(q1) - l2*" in said


_ARMS = {"serial": "planar3r", "fivebar": "isotropic"}
_OF_TWO = (
    "planar_position_determinant", "orthogonal_columns_cosine", "equal_columns_cosine",
    "isotropic_jacobian",
)  # fmt: skip


@pytest.mark.parametrize(
    "name",
    [
        n
        for n, one in quantities().items()
        if one.domain.name in _ARMS and one.read is None and not n.startswith("action")
    ],
)
def test_a_wrong_function_of_any_quantity_is_no_error(name) -> None:
    quantity = quantities()[name]
    robot = "planar2r" if name in _OF_TWO else _ARMS[quantity.domain.name]
    robot = "single_link" if name == "excess_action_sign" else robot
    mechanism = quantity.domain.load(robot)

    def wrong(*state):
        right = quantity.engine(mechanism, *(np.asarray(one)[None] for one in state))[0]
        return 0.83 * np.asarray(right) + np.cos(np.arange(np.size(right))).reshape(np.shape(right))

    assert not kl.diagnose(robot, name, wrong, samples=10).agrees
