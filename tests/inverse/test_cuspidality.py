"""Cuspidality: published verdicts; paths looked at densely with another Jacobian."""

import numpy as np
import pinocchio as pin
import pytest
from arms import crx10ia, jaco2, xarm6
from regional_arms import orthogonal

import kinlab as kl
from kinlab.inverse.postures.cuspidality import changes_without_singularity
from kinlab.inverse.postures.posture_change import posture_changes


def jacobian_by_pinocchio(robot, q, length, rows):
    """(rows, n), entries in metres over a length; Pinocchio's own J at the tool."""
    data = robot.model.createData()
    full = pin.computeFrameJacobian(
        robot.model, data, q, robot.tool, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    )
    full = full.copy()
    full[:3] /= length
    return full[rows]


def assert_path(robot, found, rows):
    path = found.path
    assert found.verdict == "cuspidal"
    ends = kl.fk(robot, path.q[[0, -1]])
    if len(rows) == 6:
        np.testing.assert_allclose(ends[1], ends[0], atol=1e-8)
        np.testing.assert_allclose(found.pose, ends[0], atol=1e-12)
    else:
        np.testing.assert_allclose(ends[1, :3, 3], ends[0, :3, 3], atol=1e-8)
    gap = path.q[-1] - path.q[0]
    assert np.abs(gap - 2 * np.pi * np.round(gap / (2 * np.pi))).max() > 1e-2
    assert (path.q >= robot.lower).all()
    assert (path.q <= robot.upper).all()
    dense = path.points(0.002)
    least = min(
        np.linalg.svd(jacobian_by_pinocchio(robot, q, path.length, rows), compute_uv=False)[-1]
        for q in dense
    )
    assert path.sigma > 0
    assert least >= path.sigma


@pytest.mark.parametrize("arm", [jaco2, xarm6, crx10ia])
def test_cuspidal_six_joint_arms(arm):
    """arXiv 2210.05204 and 2501.18505."""
    robot = arm()
    assert_path(robot, kl.is_cuspidal(robot, poses=60), [0, 1, 2, 3, 4, 5])


@pytest.mark.parametrize(
    "lengths", [(1, 2, 1.5, 1), (1, 2, 2.5, 1), (1, 0.5, 0.47, 0.3), (1, 2, 4, 1)]
)
def test_three_joints_with_cusps_are_cuspidal(lengths):
    """Wenger 2004; El Omri & Wenger 1995: a cusp means a change of posture."""
    robot = orthogonal(*lengths)
    assert_path(robot, kl.is_cuspidal(robot, limits=True), [0, 1, 2])


@pytest.mark.parametrize("lengths", [(1, 2, 0.15, 1), (1, 0.5, 1.0, 0.3)])
def test_three_joints_without_cusps_are_not(lengths):
    found = kl.is_cuspidal(orthogonal(*lengths), limits=False, poses=60, nodes=300)
    assert found.verdict == "none found"
    assert found.path is None


@pytest.mark.parametrize("name", ["puma560", "ur5", "ur10", "stanford", "planar2r", "planar3r"])
@pytest.mark.parametrize("limits", [True, False])
def test_industrial_arms_are_not(name, limits):
    """Noncuspidal in the literature: one solution on each side of every factor of det J."""
    found = kl.is_cuspidal(kl.load(name), limits=limits)
    assert found.verdict == "none found"
    assert found.pairs == 0
    assert found.poses == 200
    assert "200 random poses" in str(found.evidence)


def test_same_seed_same_answer():
    robot = orthogonal(1, 2, 1.5, 1)
    one, two = (kl.is_cuspidal(robot, seed=5, poses=40) for _ in range(2))
    np.testing.assert_array_equal(one.path.q, two.path.q)


def test_a_path_through_a_singularity_is_never_shown():
    robot = kl.load("planar2r")
    assert changes_without_singularity(robot, np.array([[0.0, 1.0], [0.0, -1.0]])) is None
    # a corner of 1e-4 beside the singularity, never on it: shown, with a bound as small
    path = changes_without_singularity(robot, np.array([[0.0, 1.0], [0.0, 0.01], [1.0, 0.5]]))
    assert path is not None
    least = np.linalg.svd(
        jacobian_by_pinocchio(robot, np.array([0.0, 0.01]), path.length, [0, 1]), compute_uv=False
    )[-1]
    assert 0 < path.sigma <= least


def test_a_crossing_between_samples_is_not_missed():
    """Sixty samples of det J along this line have one sign; it meets the singularity twice."""
    robot = kl.load("planar2r")
    corners = np.array([[0.0, 0.8], [0.0, -0.001], [0.0, 0.8]])
    samples = np.concatenate([np.linspace(corners[0], corners[1], 30)[:-1],
                              np.linspace(corners[1], corners[2], 31)[1:]])  # fmt: skip
    assert (np.sin(samples[:, 1]) > 0).all()
    assert changes_without_singularity(robot, corners) is None


def test_posture_path_between_given_solutions():
    robot = orthogonal(1, 2, 1.5, 1)
    found = kl.is_cuspidal(robot, poses=40)
    path = kl.posture_path(robot, found.path.q[0], found.path.q[-1])
    assert path is not None
    np.testing.assert_allclose(path.q[0], found.path.q[0])
    planar = kl.load("planar2r")
    assert kl.posture_path(planar, [0.0, 1.0], [0.9, -1.0]) is None
    with pytest.raises(kl.KinlabError, match="limits"):
        kl.posture_path(planar, [0.0, 1.0], [0.0, 9.0])


def test_refusals():
    with pytest.raises(kl.KinlabError, match="joints"):
        kl.is_cuspidal(kl.load("panda"))
    with pytest.raises(kl.KinlabError):
        kl.is_cuspidal(kl.load("planar2r"), poses=0)
    with pytest.raises(TypeError):
        bool(kl.is_cuspidal(kl.load("planar2r"), poses=5))


def test_ik_path_says_a_change_of_posture_without_a_singularity():
    """The tool goes along the poses of a shown path: it comes back with another posture."""
    robot = orthogonal(1, 2, 1.5, 1)
    found = kl.is_cuspidal(robot, poses=40)
    q = found.path.points(0.02)
    way = kl.ik_path(robot, kl.fk(robot, q), q[0], 1e-9, 1e-9, task="position")
    assert way.success.all()
    np.testing.assert_allclose(way.q[-1], q[-1], atol=1e-6)
    change = next(c for c in way.posture_changes if (c.first, c.last) == (0, len(q) - 1))
    assert change.nonsingular
    assert change.path.sigma > 0


def test_ik_path_that_only_comes_back_changes_nothing():
    robot = kl.load("puma560")
    q = np.linspace([0.1, 0.5, -1.0, 0.2, 0.8, 0.3], [0.4, 0.7, -0.8, 0.1, 0.9, 0.2], 12)
    way = kl.ik_path(robot, kl.fk(robot, np.vstack([q, q[::-1]])), q[0])
    assert way.success.all()
    assert way.posture_changes == ()


def test_a_change_through_a_singularity_is_not_called_nonsingular():
    robot = kl.load("planar2r")
    goal = kl.fk(robot, np.array([0.0, 1.0]))[:2, 3]
    # the mirrored posture of the same point, by the law of cosines
    radius = np.linalg.norm(goal)
    reach = np.linalg.norm(kl.fk(robot, np.array([0.0, -1.0]))[:2, 3])
    assert abs(radius - reach) < 1e-12
    turn = np.arctan2(*goal[::-1]) - np.arctan2(*kl.fk(robot, np.array([0.0, -1.0]))[:2, 3][::-1])
    q = np.linspace([0.0, 1.0], [turn, -1.0], 40)
    (change,) = posture_changes(robot, q)
    assert (change.first, change.last) == (0, 39)
    assert not change.nonsingular
