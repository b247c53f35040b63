"""All branches: each measured by Pinocchio, and none missing that a search can find."""

import importlib.util
import math
from dataclasses import replace

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import MissingExtraError, StateError, StructureError
from kinlab.inverse.planar import linear_trig

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


@pytest.mark.parametrize("name", ["ur5", "panda"])
def test_other_arms_need_the_extra(name):
    robot = kl.load(name)
    q = 0.5 * (robot.lower + robot.upper) + 0.3
    T = kl.fk(robot, q)
    if importlib.util.find_spec("ssik") is None:
        with pytest.raises(MissingExtraError, match=r"kinlab\[analytic\]"):
            kl.ik_branches(robot, T)
        return
    found = kl.ik_branches(robot, T)
    assert found.method == "ssik" and len(found) >= 2
    np.testing.assert_allclose(kl.fk(robot, found.q), np.tile(T, (len(found), 1, 1)), atol=1e-8)
    assert found.complete == (robot.n == 6)


def test_arms_without_a_closed_form():
    with pytest.raises(StructureError, match="no closed form for 4 joints"):
        kl.ik_branches(kl.load("scara"), np.eye(4))
    with pytest.raises(StateError, match="mirror"):
        kl.ik_branches(kl.load("puma560"), np.diag([1.0, 1.0, -1.0, 1.0]))


def test_a_wrist_that_three_parallel_axes_cannot_lift():
    links = [kl.DHLink(a=0.4), kl.DHLink(a=0.3), kl.DHLink(a=0.2, alpha=HALF),
             kl.DHLink(alpha=-HALF), kl.DHLink(alpha=HALF), kl.DHLink()]  # fmt: skip
    robot = kl.Robot.from_dh(kl.DHTable("flat", "standard", links))
    with pytest.raises(StructureError, match="joint 3 does not change"):
        kl.ik_branches(robot, kl.fk(robot, np.full(6, 0.3)))


def test_linear_trig():
    for a, b, c in ((1.0, 2.0, 0.5), (0.0, -1.0, 0.3), (3.0, 4.0, 5.0)):
        for x in linear_trig(a, b, c):
            assert a * math.cos(x) + b * math.sin(x) == pytest.approx(c)
    assert len(linear_trig(3.0, 4.0, 5.0)) == 1 and linear_trig(0.0, 0.0, 0.0) == []
    assert linear_trig(1.0, 0.0, 1.1) == []


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
