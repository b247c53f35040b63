"""Pose, Jacobian and its rate of any frame of a robot, by Pinocchio's own calls and differences."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

import kinlab as kl
from kinlab.errors import NameUnknownError

URDF = """<robot name="seeing">
<link name="base"/><link name="upper"/><link name="fore"/><link name="camera_link"/>
<link name="hand"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="upper"/>
  <origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
  <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="mount" type="fixed"><parent link="upper"/><child link="camera_link"/>
  <origin xyz="0.1 0.05 0.2" rpy="0.3 -0.2 0.7"/></joint>
<joint name="j2" type="revolute"><parent link="upper"/><child link="fore"/>
  <origin xyz="0.4 0 0" rpy="0.1 0 0"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="wrist" type="fixed"><parent link="fore"/><child link="hand"/>
  <origin xyz="0.3 0 0.1" rpy="0 0.4 0"/></joint>
</robot>"""

ROBOT = kl.Robot.from_urdf(URDF)
Q = np.random.default_rng(4).uniform(-2.0, 2.0, (300, 2))  # long enough for the compiled road
V = np.random.default_rng(5).standard_normal((300, 2))
FRAMES = ("camera_link", "hand", "fore", "upper")


@pytest.mark.parametrize("at", FRAMES)
def test_the_pose_is_pinocchios(at):
    poses = kl.fk(ROBOT, Q, at=at)
    data = ROBOT.model.createData()
    for q, pose in zip(Q[:20], poses, strict=False):
        pin.framesForwardKinematics(ROBOT.model, data, q)
        want = data.oMf[ROBOT.model.getFrameId(at, pin.FrameType.BODY)].homogeneous
        assert np.allclose(pose, want, rtol=0, atol=1e-14)
        assert np.allclose(kl.fk(ROBOT, q, at=at), pose, rtol=0, atol=1e-14)
    elsewhere = kl.Robot.from_urdf(URDF, tool=at)  # the arm whose tool it is, where it is one
    first = Q[:, : elsewhere.n]
    assert np.allclose(kl.fk(elsewhere, first), poses, rtol=0, atol=1e-13)


@pytest.mark.parametrize("frame", ["base", "tool", "spatial"])
@pytest.mark.parametrize("at", FRAMES)
def test_the_jacobian_is_the_poses_difference(at, frame):
    whole = kl.jacobian(ROBOT, Q, frame, at=at)
    assert whole.shape == (300, 6, 2)
    for q, found in zip(Q[:5], whole, strict=False):
        want, here = np.empty((6, 2)), pin.SE3(kl.fk(ROBOT, q, at=at))
        for i, step in enumerate(1e-5 * np.eye(2)):
            ahead, behind = (pin.SE3(kl.fk(ROBOT, q + s * step, at=at)) for s in (1, -1))
            body = (pin.log6(here.actInv(ahead)) - pin.log6(here.actInv(behind))).vector / 2e-5
            turned = np.kron(np.eye(2), here.rotation) @ body
            want[:, i] = {"tool": body, "base": turned, "spatial": here.action @ body}[frame]
        assert np.allclose(found, want, rtol=0, atol=1e-9)
        assert np.allclose(kl.jacobian(ROBOT, q, frame, at), found, rtol=0, atol=1e-14)


@pytest.mark.parametrize("frame", ["base", "tool", "spatial"])
@pytest.mark.parametrize("at", FRAMES)
def test_the_rate_is_the_jacobians_difference(at, frame):
    rates = kl.jacobian_dot(ROBOT, Q[:20], V[:20], frame, at=at)
    ahead, behind = (kl.jacobian(ROBOT, Q[:20] + s * 1e-5 * V[:20], frame, at=at) for s in (1, -1))
    assert np.allclose(rates, (ahead - behind) / 2e-5, rtol=0, atol=1e-8)


def test_the_tool_is_meant_where_nothing_is_named():
    for function in (kl.fk, kl.jacobian):
        named = function(ROBOT, Q, at="hand")
        assert np.array_equal(named, function(ROBOT, Q))
    assert np.array_equal(kl.jacobian_dot(ROBOT, Q, V), kl.jacobian_dot(ROBOT, Q, V, at="hand"))


@pytest.mark.parametrize("at", ["camera_lnk", "", 5, b"hand", ["hand"], np.zeros(3)])
def test_a_frame_that_does_not_exist(at):
    for call in (
        lambda: kl.fk(ROBOT, Q, at=at),
        lambda: kl.jacobian(ROBOT, Q[0], at=at),
        lambda: kl.jacobian_dot(ROBOT, Q, V, at=at),
    ):
        with pytest.raises(NameUnknownError, match=r"frame .* does not exist; .*camera_link"):
            call()
