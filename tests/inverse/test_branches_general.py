"""Branches of arms without a closed form: against many starts, ssik, and the literature."""

from dataclasses import replace

import numpy as np
import pytest
from arms import HALF, built_by_ssik, crx10ia, jaco2, manseur_doty, random_arm, table, xarm6

import kinlab as kl
from kinlab.errors import NameUnknownError, OptionError, StructureError


def gaps(q, others, slides=()):
    """Distance of q to each of others, whole turns of revolute joints aside."""
    gap = np.atleast_2d(others) - q
    turned = (gap + np.pi) % (2 * np.pi) - np.pi
    turned[:, list(slides)] = gap[:, list(slides)]
    return np.abs(turned).max(axis=1)


def starts(robot, T, count, seed, slides=()):
    """Distinct solutions that searches from random states end in, limits not looked at."""
    rng = np.random.default_rng(seed)
    low, high = np.full(robot.n, -np.pi), np.full(robot.n, np.pi)
    low[list(slides)], high[list(slides)] = robot.lower[list(slides)], robot.upper[list(slides)]
    poses = np.tile(T, (count, 1, 1))
    answer = kl.ik_batch(
        robot, poses, rng.uniform(low, high, (count, robot.n)), 1e-11, 1e-11, restarts=0
    )
    seen = []
    for q in answer.q[(answer.position_error < 1e-10) & (answer.rotation_error < 1e-10)]:
        if not seen or gaps(q, seen, slides).min() > 1e-5:
            seen.append(q)
    return seen


def test_manseur_and_doty_has_sixteen():
    robot, pose = manseur_doty()
    found = kl.ik_branches(robot, pose)
    assert found.complete and len(found) == 16 and len(set(found.names)) == 16
    assert max(found.position_error.max(), found.rotation_error.max()) < 1e-9
    seen = starts(robot, pose, 3000, 0)
    assert len(seen) == 16 and all(gaps(q, found.q).min() < 1e-6 for q in seen)


@pytest.mark.parametrize("convention", ["standard", "modified"])
@pytest.mark.parametrize("seed", range(4))
def test_general_arms_against_many_starts(seed, convention):
    robot = random_arm(seed, convention=convention)
    rng = np.random.default_rng(seed)
    for q in rng.uniform(-3, 3, (3, 6)):
        T = kl.fk(robot, q)
        found = kl.ik_branches(robot, T)
        assert found.method == "continuation" and found.complete and len(found) % 2 == 0
        assert gaps(q, found.q).min() < 1e-8
        assert max(found.position_error.max(), found.rotation_error.max()) < 1e-9
        seen = starts(robot, T, 400, seed)
        assert all(gaps(s, found.q).min() < 1e-6 for s in seen)
        assert len(seen) >= len(found) - 1  # 400 starts may pass one by


@pytest.mark.parametrize(
    "slides", [(0,), (1,), (2,), (3,), (5,), (0, 1), (0, 4), (1, 2), (0, 1, 2)]
)
def test_arms_with_slides_against_many_starts(slides):
    robot = random_arm(5, slides=slides)
    rng = np.random.default_rng(1)
    for q in rng.uniform(-2, 2, (4, 6)):
        T = kl.fk(robot, q)
        found = kl.ik_branches(robot, T)
        assert gaps(q, found.q, slides).min() < 1e-7
        assert max(found.position_error.max(), found.rotation_error.max()) < 1e-9
        for s in starts(robot, T, 150, 3, slides):
            assert gaps(s, found.q, slides).min() < 1e-5


@pytest.mark.parametrize("make", [xarm6, crx10ia, jaco2])
def test_collaborative_arms_against_many_starts(make):
    robot = make()
    rng = np.random.default_rng(2)
    for q in rng.uniform(-3, 3, (3, 6)):
        T = kl.fk(robot, q)
        found = kl.ik_branches(robot, T)
        assert found.complete and gaps(q, found.q).min() < 1e-8
        assert len(set(found.names)) == len(found)
        assert all(gaps(s, found.q).min() < 1e-6 for s in starts(robot, T, 400, 4))


@pytest.mark.parametrize(
    ("name", "count"),
    [("puma560_ik", 300), ("ur5_ik", 300), ("ur10e_ik", 300), ("j2s6s300_ik", 300),
     ("xarm6_ik", 60), ("jaco2_ik", 60), ("fanuc_crx10ia_ik", 60), ("gp8_ik", 100)],
)  # fmt: skip
def test_the_same_sets_as_ssik(name, count):
    robot, arm, solve = built_by_ssik(name)
    q = np.random.default_rng(6).uniform(-np.pi, np.pi, (count, 6))
    np.testing.assert_allclose(kl.fk(robot, q[0]), arm.fk(q[0]), atol=1e-12)
    poses = kl.fk(robot, q)
    batch = kl.ik_branches(robot, poses)
    for i, found in enumerate(batch):
        assert found.complete and gaps(q[i], found.q).min() < 1e-6
        for s in solve(poses[i]):
            sound = np.abs(kl.fk(robot, s) - poses[i]).max() < 1e-8
            assert not sound or gaps(s, found.q).min() < 1e-4


def test_a_stack_is_its_poses_one_by_one():
    for robot in (kl.load("puma560"), kl.load("ur5"), random_arm(1), random_arm(2, 3)):
        q = np.random.default_rng(7).uniform(-2, 2, (12, robot.n))
        poses = kl.fk(robot, q)
        stack = kl.ik_branches(robot, poses)
        alone = kl.ik_branches(robot, poses, threads=1)
        assert len(stack) == 12 and np.array_equal(stack.q, alone.q, equal_nan=True)
        for i in range(12):
            one = kl.ik_branches(robot, poses[i])
            assert one.names == stack[i].names and one.complete == stack.complete[i]
            assert stack.counts[i] == len(one)
            np.testing.assert_array_equal(one.q, stack.q[i, : len(one)])
            np.testing.assert_array_equal(one.within_limits, stack.within_limits[i, : len(one)])
            assert np.isnan(stack.q[i, len(one) :]).all()
    empty = kl.ik_branches(kl.load("ur5"), np.empty((0, 4, 4)))
    assert len(empty) == 0 and empty.q.shape == (0, 0, 6)


@pytest.mark.parametrize("n", [1, 2, 4, 5])
def test_arms_of_few_joints(n):
    robot = random_arm(1, n)
    for q in np.random.default_rng(8).uniform(-3, 3, (4, n)):
        T = kl.fk(robot, q)
        found = kl.ik_branches(robot, T)
        assert gaps(q, found.q).min() < 1e-8
        poses = kl.fk(robot, found.q)
        np.testing.assert_allclose(poses[:, :3, 3], np.tile(T[:3, 3], (len(found), 1)), atol=1e-9)
        np.testing.assert_allclose(poses[:, :3, 2], np.tile(T[:3, 2], (len(found), 1)), atol=1e-9)
        if n < 5:
            np.testing.assert_allclose(poses, np.tile(T, (len(found), 1, 1)), atol=1e-9)
            T[0, 3] += 0.01  # off the arm's own way
            assert len(kl.ik_branches(robot, T)) == 0


@pytest.mark.parametrize("slides", [(0, 1, 2), (1, 2), (0,), (1,)])
def test_three_joints_with_slides(slides):
    robot = random_arm(3, 3, slides)
    for q in np.random.default_rng(9).uniform(-2, 2, (5, 3)):
        found = kl.ik_branches(robot, kl.fk(robot, q))
        assert gaps(q, found.q, slides).min() < 1e-7 and found.position_error.max() < 1e-9


def test_seven_joints():
    robot = kl.load("panda")
    q = 0.5 * (robot.lower + robot.upper) + 0.3
    T = kl.fk(robot, q)
    sample = kl.ik_branches(robot, T)
    assert not sample.complete and "held at 16 values" in sample.evidence and len(sample) > 2
    held = kl.ik_branches(robot, T, given={robot.joint_names[6]: q[6]})
    assert held.complete and gaps(q, held.q).min() < 1e-8 and set(held.q[:, 6]) == {q[6]}
    general = kl.ik_branches(robot, T, given={3: q[3]})
    assert gaps(q, general.q).min() < 1e-8
    with pytest.raises(NameUnknownError, match="panda_joint6"):
        kl.ik_branches(robot, T, given={"panda_joint66": 0.0})
    with pytest.raises(OptionError, match="finite"):
        kl.ik_branches(robot, T, given={6: np.nan})


def test_nearly_intersecting_axes_are_not_taken_for_intersecting():
    links = list(kl.load("puma560").table.links)
    for shift in (1e-4, 1e-6):
        moved = [replace(links[3], a=shift) if i == 3 else link for i, link in enumerate(links)]
        table = replace(kl.load("puma560").table, links=moved)
        robot = kl.Robot.from_dh(table)
        for q in np.random.default_rng(3).uniform(-2, 2, (4, 6)):
            found = kl.ik_branches(robot, kl.fk(robot, q))
            assert found.method != "spherical wrist" and gaps(q, found.q).min() < 1e-6
            assert max(found.position_error.max(), found.rotation_error.max()) < 1e-9


def test_named_branches_of_a_search_and_a_path():
    robot = kl.load("puma560")
    q = np.array([0.3, -0.5, 0.2, 0.4, 0.9, -0.3])
    T = kl.fk(robot, q)
    found = kl.ik_branches(robot, T)
    for row, name in enumerate(found.names):
        answer = kl.ik(robot, T, branch=name)
        assert gaps(answer.q, found.q)[row] < 1e-12
        assert answer.success == found.within_limits[row]
    own = found.names[int(np.argmin(gaps(q, found.q)))]
    assert np.allclose(kl.ik(robot, T, q, branch=own.split(", ")[0]).q, q)
    with pytest.raises(NameUnknownError, match="shoulder left, elbow up, wrist flip"):
        kl.ik(robot, T, branch="knee up")
    path = np.linspace(q, q + 0.2, 12)
    held = kl.ik_path(robot, kl.fk(robot, path), found.q[0], branch=own)
    assert held.success.all() and not len(held.jumps)
    np.testing.assert_allclose(held.q, path, atol=1e-9)


def test_no_finite_answer():
    links = [kl.DHLink(a=0.3) for _ in range(4)] + [kl.DHLink(a=0.2, alpha=1.0), kl.DHLink()]
    robot = kl.Robot.from_dh(kl.DHTable("flat", "standard", links))
    with pytest.raises(StructureError, match="J singular everywhere"):
        kl.ik_branches(robot, np.eye(4))
    eight = random_arm(0, 8)
    with pytest.raises(StructureError, match="hold some with given"):
        kl.ik_branches(eight, np.eye(4))


@pytest.mark.parametrize("rows", [
    [(0.3, 0.0, 0, 0), (0.0, 0.0, 0, 0), (0.2, 0.0, 0, 0)],  # axes 2 and 3 are one
    [(0, HALF, 0.2, 0), (0.3, 0, 0, 0), (0.3, 0, 0, 0), (0, 0, 0.1, 0), (0, 0, 0.1, 0), (0, 0, 0, 0)],
    [(0.3, HALF, 0, 0), (0.3, HALF, 0, 0), (0.1, 0, 0, 0), (0, HALF, 0, 0), (0, -HALF, 0, 0),
     (0, -HALF, 0, 0)],
])  # fmt: skip
def test_joints_that_do_the_same_are_refused_or_regular(rows):
    """Never no solution and complete at a pose that the arm takes."""
    robot = table("idle", "standard", rows)
    q = np.linspace(0.3, 0.9, len(rows))
    largest = max(
        np.linalg.svd(kl.jacobian(robot, s))[1][len(rows) - 1]
        for s in np.random.default_rng(0).uniform(-2, 2, (5, len(rows)))
    )
    if largest < 1e-9:
        with pytest.raises(StructureError, match="J singular everywhere"):
            kl.ik_branches(robot, kl.fk(robot, q))
    else:
        found = kl.ik_branches(robot, kl.fk(robot, q))
        assert gaps(q, found.q).min() < 1e-6
