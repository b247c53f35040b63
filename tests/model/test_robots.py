"""Every robot that is shipped, and the arms of example-robot-data."""

from __future__ import annotations

import pickle
import xml.etree.ElementTree as ET

import numpy as np
import pytest

import kinlab as kl
from kinlab.model.library import example_robots, robots_dir, shipped

ARMS = {
    "erd:ur3": None, "erd:ur5": None, "erd:ur10": None, "kinova": None, "erd:panda": "panda_link8",
    "xarm7": None, "z1": None, "talos_arm": None, "baxter": "left_gripper", "bravo7_no_ee": None,
    "tiago": "arm_tool_link",
}  # fmt: skip


@pytest.fixture(params=sorted(shipped()))
def robot(request):
    return kl.load(request.param)


def q_of(robot, count=20):
    return np.random.default_rng(1).uniform(-2.5, 2.5, (count, robot.n))


def test_each_file_loads_and_states_its_source(robot):
    assert robot.table is not None
    assert robot.table.name in shipped()
    assert len(robot.table.source) > 20
    assert robot.singular_mass == ""
    assert robot.model.nq == robot.model.nv == robot.n


def test_hand_product_is_the_engines_pose(robot):
    q = q_of(robot)
    assert np.max(np.abs(robot.table.fk(q)[:, -1] - kl.fk(robot, q))) <= 1e-12


def test_committed_urdf_is_the_generated_one(robot):
    file = robots_dir() / "urdf" / f"{robot.table.name}.urdf"
    assert file.read_text(encoding="utf-8") == kl.to_urdf(robot.table)


def test_every_table_has_its_urdf_and_no_urdf_is_left_over():
    assert {f.stem for f in (robots_dir() / "urdf").glob("*.urdf")} == set(shipped())


def test_committed_urdf_is_the_same_robot(robot):
    again = kl.load(robots_dir() / "urdf" / f"{robot.table.name}.urdf")
    q = q_of(robot)
    for function in (kl.fk, kl.mass_matrix, kl.gravity_torques):
        assert np.array_equal(function(again, q), function(robot, q))


def test_visuals_draw_every_length_once(robot):
    """One cylinder for each non-zero d and a, and a stub for each joint."""
    root = ET.fromstring(robot.urdf)
    stubs = [m for m in root.iter("material") if m.get("name") == "joint_axis"]
    assert len(stubs) == robot.n
    rods = [v for v in root.iter("visual") if v.find("material").get("name") != "joint_axis"]
    assert len(rods) >= sum(1 for link in robot.table.links if abs(link.a) > 0.05)


@pytest.mark.parametrize("function", [kl.fk, kl.mass_matrix, kl.gravity_torques])
def test_puma_is_the_same_arm_in_both_conventions(function):
    standard, modified = kl.load("puma560"), kl.load("puma560_modified")
    q = q_of(standard)
    assert np.max(np.abs(function(standard, q) - function(modified, q))) <= 1e-12


def test_puma_matches_published_values():
    """Corke's Robotics Toolbox: pose of the zero and the ready configuration, p560.fkine."""
    puma = kl.load("puma560")
    zero = kl.fk(puma, np.zeros(6))
    assert zero[:3, 3] == pytest.approx([0.4521, -0.15005, 0.4318], abs=1e-12)
    ready = kl.fk(puma, [0, np.pi / 2, -np.pi / 2, 0, 0, 0])
    assert ready[:3, 3] == pytest.approx([0.0203, -0.15005, 0.8636], abs=1e-12)
    nominal = kl.gravity_torques(puma, [0, np.pi / 4, np.pi, 0, np.pi / 4, 0])
    # gravload(qn) of the Toolbox: 0, 31.6399, 6.0351, 0, 0.0283, 0
    assert nominal == pytest.approx([0, 31.6399, 6.0351, 0, 0.0283, 0], abs=2e-4)


@pytest.mark.parametrize(("name", "tip"), [("ur5", None), ("ur10", None), ("panda", "panda_link8")])
def test_shipped_table_is_the_published_urdf(name, tip):
    """Limits of accuracy: the URDF prints pi/2 with nine digits, the table rounds to 1e-9."""
    ours, theirs = kl.load(name), kl.load(f"erd:{name}", tool=tip)
    q = q_of(ours)
    assert np.max(np.abs(kl.fk(ours, q) - kl.fk(theirs, q))) <= 1e-10
    assert np.max(np.abs(kl.mass_matrix(ours, q) - kl.mass_matrix(theirs, q))) <= 2e-8
    assert np.max(np.abs(kl.gravity_torques(ours, q) - kl.gravity_torques(theirs, q))) <= 2e-7
    assert np.max(np.abs(ours.lower - theirs.lower)) <= 1e-8
    assert ours.joint_names == theirs.joint_names


def test_spatial3r_has_the_notes_angular_jacobian():
    q = np.array([0.3, 0.8, -1.1])
    s, c = np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
    expected = [[0, 0, s], [0, 0, -c], [1, 1, 0]]
    assert kl.jacobian(kl.load("spatial3r"), q)[3:] == pytest.approx(np.array(expected), abs=1e-15)


@pytest.mark.parametrize("name", [*ARMS, "puma560", "stanford"])
def test_urdf_to_dh_to_urdf(name):
    robot = kl.load(name, tool=ARMS.get(name))
    back = kl.Robot.from_dh(kl.to_dh(robot))
    q = q_of(robot)
    assert np.max(np.abs(kl.fk(back, q) - kl.fk(robot, q))) <= 1e-10
    for function in (kl.mass_matrix, kl.gravity_torques):
        scale = max(1.0, np.max(np.abs(function(robot, q))))
        assert np.max(np.abs(function(back, q) - function(robot, q))) / scale <= 1e-10
    assert back.joint_names == robot.joint_names
    assert np.array_equal(back.lower, robot.lower)


def test_to_dh_reads_a_bare_pinocchio_model():
    robot = kl.load("stanford")
    table = kl.to_dh(robot.model)
    q = q_of(robot)
    assert np.max(np.abs(table.fk(q)[:, -1] - kl.fk(robot, q))) <= 1e-10
    assert [link.joint for link in table.links] == [link.joint for link in robot.table.links]


def test_parallel_axes_get_d_zero_and_intersecting_ones_the_cross_product():
    """Note 000, the two special cases, on UR5: axes 2, 3, 4 parallel; 1 and 2 intersect."""
    table = kl.to_dh(kl.load("erd:ur5"))
    assert table.links[2].d == table.links[1].d == 0.0
    assert table.links[2].alpha == table.links[3].alpha == 0.0
    frames = np.concatenate([np.asarray(table.base)[None], table.frames(np.zeros(6))])
    cross = np.cross(frames[1][:3, 2], frames[2][:3, 2])
    assert frames[1][:3, 0] == pytest.approx(cross / np.linalg.norm(cross), abs=1e-9)


def test_nearly_parallel_axes_are_refused_or_exact():
    def arm(skew):
        links = [kl.DHLink(a=0.5, alpha=skew, mass=1.0, name=f"j{i}") for i in range(3)]
        return kl.Robot.from_dh(kl.DHTable("skewed", "modified", links, tool_name="tcp"))

    for skew in (1e-12, 1e-9, 1e-6, 1e-3):
        robot = arm(skew)
        q = q_of(robot)
        miss = np.max(np.abs(kl.to_dh(robot).fk(q)[:, -1] - kl.fk(robot, q)))
        assert miss <= 3e-8


def test_every_example_robot_loads_or_says_why():
    loaded = 0
    for name in example_robots():
        try:
            robot = kl.load(f"erd:{name}")
        except kl.KinlabError as problem:
            assert "urdf" in str(problem)
        else:
            loaded += 1
            assert robot.n >= 2
    assert loaded >= 20


def test_robot_survives_pickling():
    robot = kl.load("scara")
    copy = pickle.loads(pickle.dumps(robot))
    q = q_of(robot)
    assert np.array_equal(kl.fk(copy, q), kl.fk(robot, q))
    assert copy.table == robot.table
