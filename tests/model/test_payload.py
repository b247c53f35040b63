"""A payload: the composite body beside a parallel-axis sum, a wrench at rest, and MuJoCo."""

from __future__ import annotations

import mujoco
import numpy as np
import pinocchio as pin
import pytest
from random_tables import random_inertia, random_rotation, random_table

import kinlab as kl
from kinlab.errors import InertiaError, OptionError

MASS, COM = 2.5, np.array([0.05, -0.02, 0.11])
TENSOR = random_inertia(np.random.default_rng(1)) * 0.1


def body(mass, com, inertia, pose):
    """Mass, first moment and second moments about the origin, after moving: all additive."""
    centre = pose[:3, :3] @ com + pose[:3, 3]
    turned = pose[:3, :3] @ inertia @ pose[:3, :3].T
    spread = 0.5 * np.trace(turned) * np.eye(3) - turned
    return mass, mass * centre, spread + mass * np.outer(centre, centre)


@pytest.mark.parametrize("convention", ["standard", "modified"])
def test_last_link_is_the_sum_of_two_bodies(convention):
    table = random_table(8, 4, convention)
    last = table.links[-1]
    loaded = kl.with_payload(kl.Robot.from_dh(table), MASS, COM, TENSOR).table
    assert loaded.links[:-1] == table.links[:-1]
    merged = loaded.links[-1]
    own = body(last.mass, last.com, last.inertia, np.eye(4))
    load = body(MASS, COM, TENSOR, np.asarray(table.tool))
    for found, one, two in zip(
        body(merged.mass, merged.com, merged.inertia, np.eye(4)), own, load, strict=True
    ):
        assert np.allclose(found, one + two, rtol=0, atol=1e-12)


def ways(table: kl.DHTable) -> list[kl.Robot]:
    """The same arm from its table, from its URDF and as a bare model."""
    robot = kl.Robot.from_dh(table)
    bare = kl.Robot.from_model(robot.model, robot.tool_name)
    return [robot, kl.Robot.from_urdf(robot.urdf, table.tool_name), bare]


def test_every_kind_of_robot_carries_the_same():
    table = random_table(9, 5, "standard")
    q, v, a = np.random.default_rng(2).uniform(-2, 2, (3, 4, 5))
    first, *others = (kl.with_payload(robot, MASS, COM, TENSOR) for robot in ways(table))
    for robot in others:
        assert np.allclose(kl.fk(robot, q), kl.fk(first, q), rtol=0, atol=1e-12)
        tau = kl.inverse_dynamics(first, q, v, a)
        assert np.allclose(kl.inverse_dynamics(robot, q, v, a), tau, rtol=0, atol=1e-9)
    twice = kl.with_payload(others[0], 1.0)  # the name of the first load is taken
    by_table = kl.with_payload(first, 1.0)
    assert np.allclose(kl.mass_matrix(twice, q), kl.mass_matrix(by_table, q), rtol=0, atol=1e-10)


def test_at_rest_it_is_a_wrench_at_the_tool():
    for robot in ways(random_table(10, 5, "modified")):
        q = np.random.default_rng(3).uniform(-2, 2, (4, 5))
        gravity = np.asarray(robot.model.gravity.linear)
        arms = kl.fk(robot, q)[:, :3, :3] @ COM
        force = -MASS * gravity
        wrench = np.concatenate([np.tile(force, (4, 1)), np.cross(arms, force)], axis=1)
        loaded = kl.gravity_torques(kl.with_payload(robot, MASS, COM, TENSOR), q)
        rest = np.zeros_like(q)
        assert np.allclose(kl.inverse_dynamics(robot, q, rest, rest, wrench), loaded, atol=1e-10)


@pytest.mark.parametrize("seed", range(3))
def test_beside_mujoco(seed):
    """MuJoCo gets the load as a body of its own, welded to the tool's."""
    table = random_table(seed + 20, 4, ("standard", "modified")[seed % 2])
    robot = kl.Robot.from_dh(table)
    turn = random_rotation(np.random.default_rng(seed))
    centre, inertia = COM + 0.1 * seed, turn @ TENSOR @ turn.T
    full = [inertia[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, np.zeros(4))
    link = data.oMf[robot.model.getFrameId("link_4", pin.FrameType.BODY)].homogeneous
    placed = np.linalg.inv(link) @ kl.fk(robot, np.zeros(4))
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, placed[:3, :3].ravel())
    spec = mujoco.MjSpec.from_string(robot.urdf)
    carried = spec.body("link_4").add_body(name="load", pos=placed[:3, 3], quat=quat)
    carried.mass, carried.ipos, carried.fullinertia = MASS, centre, full
    carried.explicitinertial = True
    model = spec.compile()
    model.opt.gravity[:] = table.gravity
    model.dof_armature[:] = [one.armature for one in table.links]
    state = mujoco.MjData(model)
    loaded = kl.with_payload(robot, MASS, centre, inertia)
    for q in np.random.default_rng(seed).uniform(-1.5, 1.5, (4, 4)):
        state.qpos[:] = q
        mujoco.mj_forward(model, state)
        mass = np.zeros((4, 4))
        mujoco.mj_fullM(model, state, mass)
        ours = kl.mass_matrix(loaded, q)
        assert np.max(np.abs(mass - ours)) <= 1e-9 * np.max(np.abs(ours))
        assert np.allclose(state.qfrc_bias, kl.gravity_torques(loaded, q), atol=1e-9)


def test_loads_that_are_none():
    arm = kl.load("planar2r")
    same = kl.mass_matrix(kl.with_payload(arm, 0.0), [0.1, 0.2])
    assert np.allclose(same, kl.mass_matrix(arm, [0.1, 0.2]), rtol=1e-14, atol=0)
    with pytest.raises(OptionError, match="mass is -1; it must be >= 0"):
        kl.with_payload(arm, -1.0)
    with pytest.raises(InertiaError, match=r"com: shape \(2,\)"):
        kl.with_payload(arm, 1.0, [0, 1])
    with pytest.raises(InertiaError, match="with_payload: inertia breaks the triangle"):
        kl.with_payload(arm, 1.0, [0, 0, 0], np.diag([0, 0, 1.0]))
