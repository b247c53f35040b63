"""Joint friction: by hand, there and back through files, and beside MuJoCo's damping and loss."""

from __future__ import annotations

import dataclasses
import doctest
import pickle

import mujoco
import numpy as np
import pytest
from random_tables import random_table

import kinlab as kl
from kinlab.engine import dynamics
from kinlab.errors import OptionError, TableError


def rough(seed: int, n: int = 5, coulomb: bool = True) -> kl.DHTable:
    """A random table with friction in every joint but the second."""
    table = random_table(seed, n, ("standard", "modified")[seed % 2])
    drawn = np.random.default_rng(seed + 100).uniform(0.1, 3.0, (2, n))
    drawn[:, 1] = 0.0
    links = [
        dataclasses.replace(link, viscous_friction=b, coulomb_friction=c if coulomb else 0.0)
        for link, b, c in zip(table.links, *drawn, strict=True)
    ]
    return dataclasses.replace(table, links=links)


def states(n: int, rows: int = 3) -> np.ndarray:
    """q, v, a with speeds of at least 0.3 either way."""
    rng = np.random.default_rng(n)
    q, v, a = rng.uniform(-1.5, 1.5, (3, rows, n))
    return np.stack([q, np.sign(v) * (0.3 + np.abs(v)), a])


@pytest.mark.parametrize("rows", [0, 1, 40])
def test_torques_and_accelerations_with_friction(rows):
    table = rough(3)
    robot = kl.Robot.from_dh(table)
    q, v, a = states(5, max(rows, 1))
    v[0, 0] = 0.0  # sign(0) = 0
    if rows == 0:
        q, v, a = q[0], v[0], a[0]
    lost = np.array([
        [link.viscous_friction * x + link.coulomb_friction * np.sign(x) for link, x in
         zip(table.links, row, strict=True)] for row in np.atleast_2d(v)
    ]).reshape(v.shape)  # fmt: skip
    assert np.allclose(kl.friction_torques(robot, v), lost, rtol=0, atol=1e-14)
    wrench = [1.0, -2.0, 3.0, 0.1, 0.2, 0.3]
    for load in (None, wrench):
        bare = kl.inverse_dynamics(robot, q, v, a, load)
        tau = kl.inverse_dynamics(robot, q, v, a, load, friction=True)
        assert np.allclose(tau - bare, lost, rtol=0, atol=1e-11)
        assert np.allclose(kl.forward_dynamics(robot, q, v, tau, load, friction=True), a, atol=1e-8)
        assert np.allclose(dynamics.inverse_dynamics(robot, q, v, a, load, True), tau, atol=1e-11)
        assert np.allclose(kl.forward_dynamics(robot, q, v, bare, load), a, atol=1e-8)


def test_friction_counts_only_where_it_is_asked_for():
    smooth, table = random_table(3, 5, "modified"), rough(3)
    q, v, a = states(5)
    one, two = kl.Robot.from_dh(smooth), kl.Robot.from_dh(table)
    assert np.array_equal(kl.inverse_dynamics(one, q, v, a), kl.inverse_dynamics(two, q, v, a))
    assert np.array_equal(kl.forward_dynamics(one, q, v, a), kl.forward_dynamics(two, q, v, a))
    assert kl.compare(two, "inverse_dynamics", lambda *s: kl.inverse_dynamics(one, *s), 5).agrees
    for call in (kl.inverse_dynamics, kl.forward_dynamics):
        for rows in (q, q[0], np.zeros((40, 5))):
            with pytest.raises(OptionError, match="friction is 'yes'; give True or False"):
                call(two, rows, rows, rows, friction="yes")


def test_friction_goes_through_every_file(tmp_path):
    table = rough(4)
    friction = [(link.viscous_friction, link.coulomb_friction) for link in table.links]
    table.save(tmp_path / "arm.toml")
    assert kl.DHTable.load(tmp_path / "arm.toml") == table
    robot = kl.Robot.from_dh(table)
    for arm in (robot, kl.Robot.from_urdf(robot.urdf), pickle.loads(pickle.dumps(robot))):
        assert [*zip(arm.model.damping, arm.model.friction, strict=True)] == friction
        back = kl.to_dh(arm)
        assert [(k.viscous_friction, k.coulomb_friction) for k in back.links] == friction
    assert '<dynamics damping="' in robot.urdf
    assert "<dynamics" not in kl.to_urdf(random_table(4, 5, "standard"))
    file = tmp_path / "arm.csv"
    head = "joint,a,alpha,d,theta,viscous_friction,coulomb_friction,convention\n"
    file.write_text(head + "revolute,1,0,0,0,1/8,,standard\nprismatic,0,0,0,0,,0.5,standard\n")
    rows = kl.DHTable.load(file).links
    assert [(k.viscous_friction, k.coulomb_friction) for k in rows] == [(0.125, 0), (0, 0.5)]
    with pytest.raises(TableError, match="coulomb_friction is -1; it must be >= 0"):
        kl.DHLink(coulomb_friction=-1)


def mujoco_of(table: kl.DHTable):
    model = mujoco.MjModel.from_xml_string(kl.to_urdf(table))
    model.opt.gravity[:] = table.gravity
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    model.dof_armature[:] = [link.armature for link in table.links]
    return model, mujoco.MjData(model)


@pytest.mark.parametrize("seed", range(4))
def test_beside_mujoco(seed):
    """Its Coulomb friction is a constraint with a bound: away from rest the bound is reached."""
    table = rough(seed)
    robot = kl.Robot.from_dh(table)
    model, data = mujoco_of(table)
    assert np.array_equal(model.dof_damping, [k.viscous_friction for k in table.links])
    assert np.array_equal(model.dof_frictionloss, [k.coulomb_friction for k in table.links])
    for q, v, a in zip(*states(5), strict=True):
        data.qpos[:], data.qvel[:], data.qacc[:] = q, v, a
        mujoco.mj_inverse(model, data)
        ours = kl.inverse_dynamics(robot, q, v, a, friction=True)
        assert np.max(np.abs(data.qfrc_inverse - ours)) <= 1e-9 * np.max(np.abs(ours))
        assert np.allclose(
            np.sign(data.qfrc_constraint), -np.sign(v) * (model.dof_frictionloss > 0)
        )


@pytest.mark.parametrize("seed", range(4))
def test_accelerations_beside_mujoco(seed):
    """Viscous friction and armature; its Coulomb friction depends on the acceleration sought."""
    table = rough(seed, coulomb=False)
    robot = kl.Robot.from_dh(table)
    model, data = mujoco_of(table)
    for q, v, tau in zip(*states(5), strict=True):
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = q, v, tau
        mujoco.mj_forward(model, data)
        ours = kl.forward_dynamics(robot, q, v, tau, friction=True)
        assert np.max(np.abs(data.qacc - ours)) <= 1e-8 * np.max(np.abs(ours))


def test_the_examples_of_the_docstrings():
    failed, tried = doctest.testmod(dynamics)
    assert (failed, tried) == (0, 5)
