"""kl.compare: the measure, the registry, and what a user's function may do wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kinlab as kl
from kinlab.check.compare import relative_errors
from kinlab.check.quantities.registry import quantities
from kinlab.errors import NameUnknownError, OptionError, StructureError
from kinlab.formulas.record import FormulaError


def gravity(q):
    return np.array([2.5 * 9.81 * 0.3 * np.cos(q[0])])


def test_right_formula_agrees():
    found = kl.compare("single_link", "gravity_torques", gravity)
    assert found.agrees and found.max_error < 1e-14
    assert (found.samples, found.seed, found.robot) == (200, 0, "single_link")
    assert found.hand.shape == found.engine.shape == (200, 1)
    assert found.arguments["q"].shape == (200, 1)
    assert "agrees" in str(found)


def test_wrong_formula_differs_and_names_the_worst_state():
    found = kl.compare("single_link", "gravity_torques", lambda q: 1.1 * gravity(q))
    assert not found.agrees
    assert found.max_error == pytest.approx(0.1, rel=1e-6)
    assert "worst at q =" in str(found) and "DIFFERS" in str(found)


def test_same_seed_same_states_bit_for_bit():
    one, two, other = (kl.compare("ur5", "fk", lambda q: np.eye(4), seed=s) for s in (3, 3, 4))
    assert np.array_equal(one.arguments["q"], two.arguments["q"])
    assert not np.array_equal(one.arguments["q"], other.arguments["q"])
    assert np.array_equal(one.errors, two.errors)


def test_states_keep_the_joint_limits():
    robot = kl.load("panda")
    q = kl.compare(robot, "fk", lambda q: np.eye(4), samples=500).arguments["q"]
    assert (q >= robot.lower).all() and (q <= robot.upper).all()
    assert np.ptp(q, axis=0) == pytest.approx(robot.upper - robot.lower, rel=0.05)


def test_index_picks_entries():
    found = kl.compare("single_link", "inverse_dynamics[0]", lambda q, v, a: 0.0, samples=5)
    whole = kl.compare("single_link", "inverse_dynamics", lambda q, v, a: np.zeros(1), samples=5)
    assert np.array_equal(found.engine, whole.engine[:, 0])
    position = kl.compare("ur5", "fk[:3, 3]", lambda q: np.zeros(3), samples=5)
    assert np.array_equal(position.engine, kl.fk(kl.load("ur5"), position.arguments["q"])[:, :3, 3])


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_not_a_number_never_agrees(bad):
    def sometimes(q):
        return np.array([bad]) if q[0] > 0 else gravity(q)

    found = kl.compare("single_link", "gravity_torques", sometimes)
    assert found.max_error == np.inf and not found.agrees
    assert np.isinf(found.errors[found.arguments["q"][:, 0] > 0]).all()


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (lambda q: np.zeros(2), r"shape \(2,\); 'gravity_torques' has shape \(1,\)"),
        (lambda q: 0.0, r"shape \(\); 'gravity_torques' has shape \(1,\)"),
        (lambda q: np.array([1j]), "dtype complex128; 'gravity_torques' is real numbers"),
        (lambda q: None, "gives nothing back"),
        (lambda q: np.array([1 / 0]), "failed at state 0: ZeroDivisionError: division by zero"),
        (lambda q, v: q, "failed at state 0: TypeError"),
        (lambda q: np.zeros(1 + (q[0] > 0)), r"shape \(\d,\) at state \d+, with \(\d,\) before"),
    ],
)
def test_a_function_that_fails_is_told_where(function, message):
    with pytest.raises(FormulaError, match=message):
        kl.compare("single_link", "gravity_torques", function)


def test_unknown_names_list_the_near_ones():
    with pytest.raises(NameUnknownError, match="did you mean 'gravity_torques'"):
        kl.compare("single_link", "gravity_torque", gravity)
    with pytest.raises(NameUnknownError, match="single_link"):
        kl.compare("single_lnk", "gravity_torques", gravity)
    with pytest.raises(NameUnknownError, match="index does not fit the shape"):
        kl.compare("single_link", "gravity_torques[3]", gravity)
    with pytest.raises(NameUnknownError, match="no number or range"):
        kl.compare("single_link", "gravity_torques[1-]", gravity)
    with pytest.raises(StructureError, match="int is no serial arm; give a Robot"):
        kl.compare(3, "gravity_torques", gravity)


def test_samples_and_function_are_checked():
    for bad in (0, -1, 2.5, True):
        with pytest.raises(OptionError, match="samples is"):
            kl.compare("single_link", "gravity_torques", gravity, samples=bad)
    with pytest.raises(OptionError, match="str cannot be called"):
        kl.compare("single_link", "gravity_torques", "g")


def test_a_file_that_changed_is_read_again(tmp_path):
    path = tmp_path / "arm.toml"
    table = kl.load("single_link").table
    table.save(path)
    assert kl.compare(path, "gravity_torques", gravity).agrees
    heavy = replace(table, links=[replace(table.links[0], mass=5.0)])
    heavy.save(path)
    assert not kl.compare(path, "gravity_torques", gravity).agrees
    assert kl.compare(str(path), "gravity_torques", lambda q: 2.0 * gravity(q)).agrees


def test_a_function_cannot_change_the_states():
    def spoils(q):
        answer = gravity(q)
        q[:] = 0.0
        return answer

    assert kl.compare("single_link", "gravity_torques", spoils).agrees


def test_measure_is_relative_to_the_state_or_to_the_typical_one():
    engine = np.array([[1.0, 0.0], [10.0, 0.0], [0.0, 0.0]])
    hand = engine + np.array([[0.1, 0.0], [0.1, 0.0], [0.0, 0.1]])
    assert relative_errors(hand, engine) == pytest.approx([0.1, 0.01, 0.1])
    zero = np.zeros((2, 3))
    assert relative_errors(zero + 0.5, zero) == pytest.approx([0.5, 0.5])


def test_every_quantity_answers_with_one_entry_per_state():
    special = {"planar_determinant": "planar3r", "planar_position_determinant": "planar2r",
               "orthogonal_columns_cosine": "planar2r", "equal_columns_cosine": "planar2r",
               "isotropic_jacobian": "planar2r", "excess_action_sign": "single_link",
               "inverse_kinematics_xy": "planar2r", "inverse_kinematics_xyz": "spatial3r",
               "inverse_kinematics_xyzphi": "scara"}  # fmt: skip
    for name, quantity in quantities().items():
        if quantity.domain.name not in ("serial", "identity"):
            continue
        robot = special.get(name, "planar3r" if quantity.domain.name == "serial" else "identity")
        mechanism = quantity.domain.load(robot)
        answer = quantity.engine(mechanism, *quantity.states(mechanism, 3, 0))
        assert len(answer) == 3 and np.isfinite(answer).all(), name


def test_every_quantity_refuses_an_arm_it_is_not_for_or_answers():
    """No numpy or Pinocchio error reaches the user, whatever robot a quantity is asked of."""
    for name, quantity in quantities().items():
        if quantity.domain.name != "serial":
            continue
        for robot in ("single_link", "planar2r", "panda", "stanford", "kinova"):
            try:
                found = kl.compare(robot, name, lambda *state: 0.0, samples=2)
            except (FormulaError, StructureError) as problem:
                told = "has shape" in str(problem) or "is for" in str(problem)
                assert told, (name, robot, problem)
            else:
                assert found.engine.shape == (2,), (name, robot)


def test_a_quantity_for_two_joints_says_so():
    with pytest.raises(StructureError, match="is for 2 joints; 'panda' has 7"):
        kl.compare("panda", "planar_position_determinant", lambda q: 0.0)
