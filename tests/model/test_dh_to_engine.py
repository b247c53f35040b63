"""Random tables: hand product, own Newton-Euler and yourdfpy against the URDF in Pinocchio."""

from __future__ import annotations

import io
from collections import Counter

import numpy as np
import pytest
import yourdfpy
from hypothesis import given, settings
from hypothesis import strategies as st
from newton_euler import mass_matrix, torques
from random_tables import random_table, tables

import kinlab as kl
from kinlab.errors import UrdfError

POSE = 1e-12
DYNAMICS = 1e-10


def states(table: kl.DHTable, count: int = 3) -> np.ndarray:
    rng = np.random.default_rng(table.n)
    return rng.uniform(-3.0, 3.0, (3, count, table.n))


def relative(one: np.ndarray, two: np.ndarray) -> float:
    return float(np.max(np.abs(one - two)) / max(1.0, np.max(np.abs(two))))


@settings(max_examples=150)
@given(tables)
def test_tool_pose_is_the_hand_product(table):
    robot = kl.Robot.from_dh(table)
    q = states(table)[0]
    assert np.max(np.abs(table.fk(q)[:, -1] - kl.fk(robot, q))) <= POSE


@settings(max_examples=100)
@given(tables)
def test_m_g_and_tau_are_newton_eulers(table):
    robot = kl.Robot.from_dh(table)
    for q, v, a in zip(*states(table), strict=True):
        zero = np.zeros(table.n)
        tau = torques(table, q, v, a)
        assert relative(kl.inverse_dynamics(robot, q, v, a), tau) <= DYNAMICS
        assert relative(kl.gravity_torques(robot, q), torques(table, q, zero, zero)) <= DYNAMICS
        assert relative(kl.mass_matrix(robot, q), mass_matrix(table, q)) <= DYNAMICS


@settings(max_examples=40)
@given(tables)
def test_yourdfpy_reads_the_same_arm(table):
    arm = yourdfpy.URDF.load(io.BytesIO(kl.to_urdf(table).encode()), load_meshes=False)
    for q in states(table, 2)[0]:
        arm.update_cfg(dict(zip(table.joint_names, q, strict=True)))
        pose = arm.get_transform("tool", "base_link")
        assert np.max(np.abs(pose - table.fk(q)[-1])) <= POSE


@settings(max_examples=60)
@given(tables)
def test_dh_frames_are_in_the_urdf(table):
    import pinocchio as pin

    robot = kl.Robot.from_dh(table)
    prefix = "dh_" if table.convention == "standard" else "link_"
    q = states(table, 1)[0, 0]
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    for i, frame in enumerate(table.frames(q), 1):
        index = robot.model.getFrameId(f"{prefix}{i}", pin.FrameType.BODY)
        assert np.max(np.abs(data.oMf[index].homogeneous - frame)) <= POSE


@settings(max_examples=60)
@given(tables)
def test_there_and_back_again(table):
    robot = kl.Robot.from_dh(table)
    back = kl.to_dh(robot)
    again = kl.Robot.from_dh(back)
    q, v, a = states(table)
    assert np.max(np.abs(kl.fk(again, q) - kl.fk(robot, q))) <= 1e-10
    for function in (kl.mass_matrix, kl.gravity_torques):
        assert relative(function(again, q), function(robot, q)) <= 1e-10
    tau = kl.inverse_dynamics(robot, q, v, a)
    assert relative(kl.inverse_dynamics(again, q, v, a), tau) <= 1e-10
    assert np.array_equal(again.lower, robot.lower)
    assert np.array_equal(again.upper, robot.upper)


@settings(max_examples=60)
@given(tables)
def test_save_and_load_is_the_identity(tmp_path_factory, table):
    file = tmp_path_factory.mktemp("tables") / "arm.toml"
    table.save(file)
    assert kl.DHTable.load(file) == table


def test_random_tables_cover_every_case():
    """Coverage apart from accuracy: each case stands in at least ten of 200 tables."""
    seen: Counter[str] = Counter()
    for seed in range(200):
        n, convention = seed % 8 + 1, ("standard", "modified")[seed // 8 % 2]
        cases = {f"n {n}", convention}
        for link in random_table(seed, n, convention).links:
            cases |= {link.joint, f"flip {link.flip}", f"theta {link.theta != 0.0}"}
            if np.isclose(np.abs([link.alpha, link.theta]), np.pi / 2).all():
                cases.add("gimbal lock")
        seen.update(cases)
    wanted = {"revolute", "prismatic", "flip True", "flip False", "theta True", "theta False",
              "gimbal lock", "standard", "modified", *(f"n {k}" for k in range(1, 9))}  # fmt: skip
    assert {case for case in wanted if seen[case] < 10} == set()


@pytest.mark.parametrize("convention", ["standard", "modified"])
@given(
    alpha=st.sampled_from([np.pi / 2, -np.pi / 2]), theta=st.sampled_from([np.pi / 2, -np.pi / 2])
)
@settings(max_examples=4)
def test_gimbal_lock_loses_nothing(convention, alpha, theta):
    rows = [kl.DHLink(a=0.3, alpha=alpha, d=0.2, theta=theta, mass=1.0, inertia=np.eye(3))] * 4
    rows = [kl.DHLink(**{**vars(r), "name": f"j{i}"}) for i, r in enumerate(rows)]
    table = kl.DHTable("gimbal", convention, rows)
    q = states(table, 20)[0]
    assert np.max(np.abs(kl.fk(kl.Robot.from_dh(table), q) - table.fk(q)[:, -1])) <= 1e-14


@settings(max_examples=40)
@given(tables)
def test_the_records_of_a_table_are_what_its_urdf_reads_as(table):
    """What is built without reading the text back is what a reader of the text gets."""
    one, two = kl.Robot.from_dh(table).model, kl.Robot.from_urdf(kl.to_urdf(table), "tool").model
    assert list(one.names) == list(two.names)
    for i in range(1, one.njoints):
        assert np.array_equal(
            one.jointPlacements[i].homogeneous, two.jointPlacements[i].homogeneous
        )
        assert np.array_equal(one.inertias[i].matrix(), two.inertias[i].matrix())
    for name in ("lowerPositionLimit", "upperPositionLimit", "armature", "damping", "friction"):
        assert np.array_equal(getattr(one, name), getattr(two, name))


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ({"a": 4e9}, "'dh_joint_1': origin xyz: 4e\\+09 is beyond 1e\\+09"),
        ({"mass": 4e9}, "link 'link_1': inertial: 4e\\+09 is beyond"),
        ({"upper": 1e18}, "joint 'joint_1': limits: 1e\\+18 is beyond 1e\\+17"),
        ({"name": " shoulder"}, "begin or end with a blank"),
        ({"name": "tool_joint"}, "joint 'tool_joint' is defined twice"),
    ],
)
def test_tables_that_no_urdf_can_hold_are_named(row, message):
    table = kl.DHTable("odd", "standard", [kl.DHLink(**row)])
    with pytest.raises(UrdfError, match=f"table 'odd': .*{message}"):
        kl.Robot.from_dh(table)
