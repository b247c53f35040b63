"""The URDFs in another engine: MuJoCo's pose, M and gravity beside ours."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from random_tables import random_table

import kinlab as kl


def beside(robot: kl.Robot, table: kl.DHTable) -> None:
    model = mujoco.MjModel.from_xml_string(robot.urdf)
    model.opt.gravity[:] = table.gravity
    data = mujoco.MjData(model)
    armature = np.diag([link.armature for link in table.links])
    assert model.nq == table.n
    for q in np.random.default_rng(3).uniform(-1.5, 1.5, (10, table.n)):
        data.qpos[:] = q
        mujoco.mj_forward(model, data)
        mass = np.zeros((table.n, table.n))
        mujoco.mj_fullM(model, data, mass)
        ours = kl.mass_matrix(robot, q)
        assert np.max(np.abs(mass + armature - ours)) <= 1e-10 * np.max(np.abs(ours))
        gravity = kl.gravity_torques(robot, q)
        assert np.max(np.abs(data.qfrc_bias - gravity)) <= 1e-10 * max(1, np.max(np.abs(gravity)))


@pytest.mark.parametrize("name", ["stanford", "scara", "panda", "ur5", "spatial3r"])
def test_shipped_robots(name):
    robot = kl.load(name)
    beside(robot, robot.table)


@pytest.mark.parametrize("seed", range(20))
def test_random_tables(seed):
    table = random_table(seed, seed % 7 + 2, ("standard", "modified")[seed % 2])
    beside(kl.Robot.from_dh(table), table)
