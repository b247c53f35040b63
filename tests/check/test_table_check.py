"""`kinlab check my_arm.toml` on tables whose quantities vanish or stay constant."""

from __future__ import annotations

import numpy as np
import pytest
from random_tables import random_table

import kinlab as kl
from kinlab.check.quantities.table import skew_residue

BODY = {"mass": 3.0, "com": (0.1, 0.2, 0.3), "inertia": 0.1 * np.eye(3)}
CONSTANT = {
    "one joint": [kl.DHLink(a=0.3, **BODY)],
    "gantry": [kl.DHLink("prismatic", alpha=np.pi / 2, theta=np.pi / 2, **BODY)] * 3,
}


@pytest.mark.parametrize("name", CONSTANT)
def test_a_constant_mass_matrix_is_no_disagreement(name):
    robot = kl.Robot.from_dh(kl.DHTable(name, "modified", CONSTANT[name]))
    q, v = np.random.default_rng(0).uniform(-2, 2, (2, 50, robot.n))
    assert np.max(np.abs(skew_residue(robot, q, v))) <= 1e-14


def test_a_wrong_coriolis_matrix_is_seen(monkeypatch):
    from kinlab.engine import dynamics

    robot = kl.Robot.from_dh(random_table(5, 4, "standard"))
    q, v = np.random.default_rng(0).uniform(-2, 2, (2, 50, robot.n))
    assert np.max(np.abs(skew_residue(robot, q, v))) <= 1e-12
    true = dynamics.coriolis_matrix
    monkeypatch.setattr(dynamics, "coriolis_matrix", lambda *state: 1.01 * true(*state))
    assert np.max(np.abs(skew_residue(robot, q, v))) > 1e-4


def test_gravity_of_a_horizontal_arm_is_zero_not_noise():
    links = [kl.DHLink(a=0.5, alpha=np.pi, theta=0.3, **BODY)] * 3
    table = kl.DHTable("flat", "standard", links)
    assert kl.compare(table, "gravity_torques", lambda q: np.zeros(3)).agrees
    assert not kl.compare(table, "gravity_torques", lambda q: np.full(3, 1e-6)).agrees
