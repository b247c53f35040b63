"""All branches: each measured by Pinocchio, and none missing that a search can find."""

import math
from dataclasses import replace

import numpy as np
import pytest
from arms import random_arm

import kinlab as kl
from kinlab.errors import StateError, StructureError
from kinlab.inverse.branches import equations

HALF = math.pi / 2


def endless(table):
    """The same arm without limits that matter."""
    links = [
        replace(link, lower=-math.pi, upper=math.pi) if link.joint == "revolute"
        else replace(link, lower=-3.0, upper=3.0) for link in table.links
    ]  # fmt: skip
    return kl.Robot.from_dh(replace(table, links=links))


def wrist_arm(seed, convention, third="revolute", kind="general"):
    """A random arm whose last three axes meet; kind says how axes 1 and 2 lie."""
    rng = np.random.default_rng(seed)
    alpha = {"general": rng.uniform(0.4, 1.2), "parallel": 0.0, "intersecting": HALF}[kind]
    a1 = 0.0 if kind == "intersecting" else rng.uniform(0.2, 0.5)
    length = rng.uniform(0.2, 0.6, 4)
    rows = [
        (a1, alpha),
        (length[0], 0.7 if kind == "parallel" else rng.choice([0.0, 0.7])),
        (length[1], HALF),
    ]
    bend = HALF if seed % 2 else 1.2  # an oblique wrist cannot turn everywhere
    wrist = [(0.0, -bend), (0.0, bend + 0.1 * (bend < HALF)), (0.0, 0.0)]
    shifts = [length[2], rng.uniform(-0.2, 0.2), 0.1, length[3], 0.0, 0.08]
    if convention == "modified":  # there a and alpha stand in front of the joint
        rows = [(0.0, 0.0), *rows]
        wrist = wrist[:2]
    links = []
    for i, (a, twist) in enumerate([*rows, *wrist]):
        slide = i == 2 and third == "prismatic"
        links.append(
            kl.DHLink(joint="prismatic" if slide else "revolute", a=a, alpha=twist, d=shifts[i],
                      theta=rng.uniform(-1, 1), flip=bool(rng.random() < 0.3))
        )  # fmt: skip
    return kl.Robot.from_dh(kl.DHTable(f"wrist{seed}", convention, links))


def contains(branches, q, slides=()):
    gap = branches.q - q
    turned = gap - 2 * np.pi * np.round(gap / (2 * np.pi))
    turned[:, list(slides)] = gap[:, list(slides)]
    return bool((np.abs(turned).max(axis=1) < 1e-4).any())


ROBOTS = [
    "puma560", "puma560_modified", "stanford",
    *[(s, c, t, k) for s, (c, t, k) in enumerate(
        (c, t, k) for c in ("standard", "modified") for t in ("revolute", "prismatic")
        for k in ("general", "parallel", "intersecting"))],
]  # fmt: skip


@pytest.mark.parametrize("which", ROBOTS, ids=str)
def test_spherical_wrists(which):
    robot = endless(kl.load(which).table) if isinstance(which, str) else wrist_arm(*which)
    slides = [i for i in range(6) if robot.table.links[i].joint == "prismatic"]
    rng = np.random.default_rng(1)
    for _ in range(8):
        q = rng.uniform(robot.lower, robot.upper)
        T = kl.fk(robot, q)
        found = kl.ik_branches(robot, T)
        assert found.method == "spherical wrist" and found.complete
        assert len(found) in (2, 4, 6, 8) and contains(found, q, slides)
        np.testing.assert_allclose(kl.fk(robot, found.q), np.tile(T, (len(found), 1, 1)), atol=1e-8)
        assert max(found.position_error.max(), found.rotation_error.max()) < 1e-8
        # a search from anywhere ends in one of them
        for start in rng.uniform(robot.lower, robot.upper, (10, 6)):
            answer = kl.ik(robot, T, start, restarts=0, tol_position=1e-10, tol_rotation=1e-10)
            assert not answer.success or contains(found, answer.q, slides)


def test_puma_has_eight_named_branches():
    robot = kl.load("puma560")
    T = kl.fk(robot, [0.3, -0.5, 0.6, 0.4, 0.9, -0.3])
    found = kl.ik_branches(robot, T)
    assert len(found) == 8 and len(set(found.names)) == 8
    assert {n.split(", ")[0] for n in found.names} == {"shoulder left", "shoulder right"}
    assert {n.split(", ")[1] for n in found.names} == {"elbow up", "elbow down"}
    for q, inside in zip(found, found.within_limits, strict=True):
        assert inside == bool(np.all((q >= robot.lower) & (q <= robot.upper)))


def test_puma_in_both_conventions_agrees():
    one, two = kl.load("puma560"), kl.load("puma560_modified")
    T = kl.fk(one, [0.3, -0.5, 0.6, 0.4, 0.9, -0.3])
    first, second = kl.ik_branches(one, T), kl.ik_branches(two, T)
    assert len(first) == len(second) == 8 and first.names == second.names


def test_singular_wrist_is_not_called_complete():
    robot = kl.load("puma560")
    T = kl.fk(robot, [0.3, -0.5, 0.6, 0.4, 0.0, -0.3])
    found = kl.ik_branches(robot, T)
    assert len(found) and not found.complete
    assert any("wrist aligned" in name for name in found.names)


@pytest.mark.parametrize("name", ["planar2r", "planar3r"])
def test_planar_arms_have_two(name):
    robot = endless(kl.load(name).table)
    rng = np.random.default_rng(2)
    for q in rng.uniform(-3, 3, (20, robot.n)):
        T = kl.fk(robot, q)
        found = kl.ik_branches(robot, T)
        assert len(found) == 2 and set(found.names) == {"elbow left", "elbow right"}
        assert contains(found, q) and found.position_error.max() < 1e-12
        poses = kl.fk(robot, found.q)
        np.testing.assert_allclose(poses[:, :3, 3], np.tile(T[:3, 3], (2, 1)), atol=1e-12)
        if robot.n == 3:
            np.testing.assert_allclose(poses, np.tile(T, (2, 1, 1)), atol=1e-12)


def test_planar_against_the_cosine_rule():
    robot = endless(kl.load("planar2r").table)
    l1 = np.linalg.norm(robot.table.fk([0.0, 0.0])[1:3, :3, 3], axis=1)
    T = kl.fk(robot, [0.4, 1.1])
    r2 = float(T[0, 3] ** 2 + T[1, 3] ** 2)
    a = float(np.linalg.norm(kl.jacobian(robot, [0.0, 0.0])[:2, 0]))
    b = float(np.linalg.norm(kl.jacobian(robot, [0.0, 0.0])[:2, 1]))
    inner = math.acos((r2 - (a - b) ** 2 - b**2) / (2 * (a - b) * b))
    assert sorted(kl.ik_branches(robot, T).q[:, 1]) == pytest.approx([-inner, inner])
    assert l1.size == 2


def test_flipped_and_moved_planar_arms():
    base = np.array([[0.0, 0, 1, 0.3], [1, 0, 0, -0.2], [0, 1, 0, 0.5], [0, 0, 0, 1]])
    tool = np.eye(4)
    tool[:3, 3] = [0.2, 0.1, 0.05]
    links = [
        kl.DHLink(a=0.5, d=0.1), kl.DHLink(a=0.4, alpha=math.pi, d=-0.05),
        kl.DHLink(a=0.1, theta=0.3, flip=True),
    ]  # fmt: skip
    robot = kl.Robot.from_dh(kl.DHTable("bent", "standard", links, base=base, tool=tool))
    for q in np.random.default_rng(3).uniform(-3, 3, (20, 3)):
        T = kl.fk(robot, q)
        found = kl.ik_branches(robot, T)
        assert found.method == "planar" and len(found) == 2 and contains(found, q)
        np.testing.assert_allclose(kl.fk(robot, found.q), np.tile(T, (2, 1, 1)), atol=1e-10)


@pytest.mark.parametrize("name", ["planar2r", "planar3r", "puma560", "stanford"])
def test_out_of_reach_has_none(name):
    T = np.eye(4)
    T[:3, 3] = [30.0, 0.0, 0.0]
    found = kl.ik_branches(kl.load(name), T)
    if name == "stanford":  # its slide would have to be 30 m long
        assert len(found) and not found.within_limits.any()
    else:
        assert len(found) == 0 and found.q.shape == (0, kl.load(name).n)


@pytest.mark.parametrize("name", ["planar2r", "planar3r"])
def test_stretched_planar_arm_has_one(name):
    robot = endless(kl.load(name).table)
    found = kl.ik_branches(robot, kl.fk(robot, np.zeros(robot.n)))
    assert len(found) == 1 and found.names == ("elbow straight",)


@pytest.mark.parametrize("name", ["ur5", "ur10", "erd:ur3"])
def test_three_parallel_axes(name):
    robot = kl.load(name)
    rng = np.random.default_rng(4)
    for q in rng.uniform(-3, 3, (20, 6)):
        T = kl.fk(robot, q)
        found = kl.ik_branches(robot, T)
        assert found.method == "three parallel axes" and found.complete
        assert len(found) in (2, 4, 6, 8) and contains(found, q)
        assert len(set(found.names)) == len(found)
        assert max(found.position_error.max(), found.rotation_error.max()) < 1e-9
        for start in rng.uniform(robot.lower, robot.upper, (6, 6)):
            answer = kl.ik(robot, T, start, restarts=0, tol_position=1e-10, tol_rotation=1e-10)
            assert not answer.success or contains(found, answer.q)


def test_ur_branches_have_the_eight_names():
    robot = kl.load("ur5")
    found = kl.ik_branches(robot, kl.fk(robot, [0.3, -1.2, 1.4, -0.6, 0.9, 0.2]))
    parts = [name.split(", ") for name in found.names]
    assert len(found) == 8 and len(set(found.names)) == 8
    assert {p[0] for p in parts} == {"shoulder left", "shoulder right"}
    assert {p[1] for p in parts} == {"elbow up", "elbow down"}
    assert {p[2] for p in parts} == {"wrist flip", "wrist no flip"}


def test_improper_poses():
    robot = kl.load("puma560")
    with pytest.raises(StateError, match="mirror"):
        kl.ik_branches(robot, np.diag([1.0, 1.0, -1.0, 1.0]))
    bad = np.eye(4)
    bad[0, 3] = np.nan
    with pytest.raises(StateError, match="finite"):
        kl.ik_branches(robot, bad)
    with pytest.raises(StateError, match=r"Ts\[1\]"):
        kl.ik_branches(robot, np.array([np.eye(4), np.diag([1.0, 1.0, -1.0, 1.0])]))


def test_a_wrist_that_three_parallel_axes_cannot_lift():
    links = [kl.DHLink(a=0.4), kl.DHLink(a=0.3), kl.DHLink(a=0.2, alpha=HALF),
             kl.DHLink(alpha=-HALF), kl.DHLink(alpha=HALF), kl.DHLink()]  # fmt: skip
    robot = kl.Robot.from_dh(kl.DHTable("flat", "standard", links))
    with pytest.raises(StructureError, match="J singular everywhere"):
        kl.ik_branches(robot, kl.fk(robot, np.full(6, 0.3)))


def test_linear_trig():
    out = np.empty(2)
    for a, b, c in ((1.0, 2.0, 0.5), (0.0, -1.0, 0.3), (3.0, 4.0, 5.0)):
        assert equations.linear_trig(a, b, c, out) == 2
        for x in out:
            assert a * math.cos(x) + b * math.sin(x) == pytest.approx(c)
    assert equations.linear_trig(0.0, 0.0, 0.0, out) == 0
    assert equations.linear_trig(1.0, 0.0, 1.1, out) == 0


def test_trigonometric_quartics_against_numpy():
    rng = np.random.default_rng(5)
    out = np.empty(4)
    for f in rng.normal(size=(200, 5)):
        z = np.roots([
            complex(f[3], -f[4]), complex(f[1], -f[2]), 2 * f[0], complex(f[1], f[2]),
            complex(f[3], f[4]),
        ])  # fmt: skip
        expected = np.sort(np.angle(z[np.abs(np.abs(z) - 1) < 1e-7]))
        count = equations.trig_quartic(f, out)
        np.testing.assert_allclose(np.sort(out[:count]), expected, atol=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_points_of_three_joints_against_brute_force(seed):
    """q1 drops out of height and distance; q3 is scanned for the two that are left."""
    robot = random_arm(seed, 3)
    for q in np.random.default_rng(seed).uniform(-3, 3, (4, 3)):
        T = kl.fk(robot, q)
        found = kl.ik_branches(robot, T)
        assert found.complete and len(found) in (2, 4) and contains(found, q)
        seen = []
        for start in np.random.default_rng(9).uniform(-3.1, 3.1, (60, 3)):
            answer = kl.ik(
                robot, T, start, restarts=0, task="position", tol_position=1e-11, tol_rotation=1.0
            )
            if answer.position_error < 1e-10 and not any(np.allclose(answer.q, s) for s in seen):
                seen.append(answer.q)
                assert contains(found, answer.q)
        assert len(seen) == len(found)  # 60 starts find each of two or four


def test_scara():
    robot = kl.load("scara")
    for q in np.random.default_rng(2).uniform(robot.lower, robot.upper, (20, 4)):
        found = kl.ik_branches(robot, kl.fk(robot, q))
        assert found.complete and len(found) == 2 and contains(found, q, [2])
        assert set(found.names) == {"elbow left", "elbow right"}
        poses = kl.fk(robot, found.q)
        np.testing.assert_allclose(poses, np.tile(kl.fk(robot, q), (2, 1, 1)), atol=1e-12)


@pytest.mark.parametrize("gap", [1e-2, 1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("what", ["puma wrist", "puma elbow", "ur wrist", "ur elbow"])
def test_near_singular_poses_keep_their_branches(what, gap):
    arm, part = what.split()
    robot = kl.load("puma560" if arm == "puma" else "ur5")
    if part == "wrist":
        joint, value = 4, 0.0
    else:
        joint, value = 2, 0.0 if arm == "ur" else math.atan2(-0.4318, 0.0203)
    for q in np.random.default_rng(3).uniform(-2, 2, (20, 6)):
        q[joint] = value
        assert abs(np.linalg.det(kl.jacobian(robot, q))) < 1e-9
        at = q.copy()
        at[joint] += gap
        found = kl.ik_branches(robot, kl.fk(robot, at))
        assert found.complete and len(found) % 2 == 0 and (arm == "ur" or len(found) == 8)
        distance = np.abs((found.q - at + math.pi) % (2 * math.pi) - math.pi).max(axis=1)
        assert np.sum(distance < 1e-3 * gap) == 1
        assert np.diff(np.sort(distance))[0] > 0.5 * gap


def test_families_are_said():
    robot = kl.load("puma560")
    q = np.array([0.3, -0.5, 0.6, 0.4, 0.0, -0.3])
    found = kl.ik_branches(robot, kl.fk(robot, q))
    assert not found.complete and "joint_4 is free" in found.evidence
    (family,) = found.families
    assert family.linear and family.joints == ("joint_4", "joint_6")
    for t in (-1.0, 0.4, 2.0):
        moved = kl.fk(robot, found.q[family.branch] + t * family.direction)
        np.testing.assert_allclose(moved, kl.fk(robot, q), atol=1e-9)


@pytest.mark.parametrize("name", ["puma560", "stanford", "erd:kinova"])
def test_the_status_of_a_search_is_what_the_closed_form_says(name):
    """Random poses, reachable or not: success, only outside the limits, or not at all."""
    robot = kl.load(name)
    rng = np.random.default_rng(16)
    T = kl.fk(robot, rng.uniform(robot.lower, robot.upper, (150, 6)))
    T[:, :3, :3] = T[rng.permutation(150), :3, :3]  # each position with another orientation
    answer = kl.ik_batch(robot, T)
    seen = set()
    for pose, success, status in zip(T, answer.success, answer.status, strict=True):
        found = kl.ik_branches(robot, pose)
        if found.within_limits.any():
            expected = "converged"
        else:
            expected = "converged_outside_limits" if len(found) else "unreachable_suspected"
        seen.add(expected)
        assert status == expected and success == (expected == "converged")
    assert {"converged", "converged_outside_limits"} <= seen
