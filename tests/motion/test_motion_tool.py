"""Motions of the tool: other interpolations, differences, limits; what is said where they end."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation, Slerp

import kinlab as kl
from kinlab.drives.laws import quintic
from kinlab.errors import KinlabError, LimitError, OptionError, SingularError, UnreachableError
from kinlab.motion.paths import TimedPath, read_legs

STARTS = {
    "puma560": [0.3, 0.5, -1, 0.3, 0.8, 0.2],
    "ur5": [0.3, -1.0, 1.2, 0.3, 0.8, 0.2],
    "panda": [0.1, -0.4, 0.2, -1.9, 0.1, 1.6, 0.4],
    "planar2r": [0.4, 0.9],
    "scara": [0.4, 0.8, 0.1, 0.3],
}
TURN = Rotation.from_rotvec([0.3, -0.2, 0.5]).as_matrix()


def corners(name):
    """Three poses round the start: all rows that the arm can hold change."""
    robot = kl.load(name)
    first = kl.fk(robot, STARTS[name])
    second, third = first.copy(), first.copy()
    flat = name == "planar2r"
    second[:3, 3] += [-0.1, 0.05, 0.0 if flat else 0.02]
    third[:3, 3] += [-0.06, -0.05, 0.0]
    other = Rotation.from_rotvec([-0.1, 0.4, 0.2]).as_matrix()  # about another axis
    if robot.n >= 6:
        second[:3, :3] = first[:3, :3] @ TURN
        third[:3, :3] = second[:3, :3] @ other
    return robot, [first, second, third]


def moved(name, **options):
    robot, poses = corners(name)
    given = {"q0": STARTS[name], "velocity": 0.2, "acceleration": 0.6}
    return robot, poses, kl.motion.cartesian(robot, poses, **(given | options))


@pytest.mark.parametrize("name", STARTS)
@pytest.mark.parametrize(("law", "blend"), [("quintic", 0.5), ("trapezoid", 0.0)])
def test_the_joints_move_as_their_derivatives_say_and_the_tool_as_asked(name, law, blend):
    robot, _, motion = moved(name, law=law, blend=blend)
    h = 1e-4
    t = np.random.default_rng(1).uniform(2 * h, motion.duration - 2 * h, 200)
    t = t[np.abs(t[:, None] - motion.knots).min(axis=1) > h]
    (before, vb, _), (_, v, a), (after, va, _) = (motion.at(x) for x in (t - h, t, t + h))
    np.testing.assert_allclose((after - before) / (2 * h), v, rtol=0, atol=1e-6)
    np.testing.assert_allclose((va - vb) / (2 * h), a, rtol=0, atol=1e-4)
    rows = 6 if robot.n >= 6 else 2
    here = kl.fk(robot, motion.q)
    assert np.abs(here[:, :3, 3] - motion.poses[:, :3, 3])[:, :rows].max() < 1e-7
    if robot.n >= 6:
        assert np.abs(here[:, :3, :3] - motion.poses[:, :3, :3]).max() < 1e-7
    speed = np.linalg.norm(
        np.einsum("nij,nj->ni", kl.jacobian(robot, motion.q), motion.v)[:, :3], axis=1
    )
    assert speed.max() <= 0.2 * (1 + 1e-4)
    assert np.abs(motion.v[[0, -1]]).max() < 1e-6


@pytest.mark.parametrize("name", STARTS)
def test_velocities_and_accelerations_belong_to_the_positions_far_apart(name):
    """Differences over 50 ms, five times the distance of the samples that the curve runs through.

    Inside one interval the curve agrees with itself, whatever the samples say.
    """
    robot, poses = corners(name)
    motion = kl.motion.cartesian(robot, poses[:2], q0=STARTS[name], duration=4.0)
    assert len(motion.knots) == 401
    h, t = 0.0125, np.random.default_rng(2).uniform(0.1, 3.9, 200)
    beside = [motion.at(t + k * h) for k in (-2, -1, 1, 2)]
    for order in (0, 1):
        low, near, up, far = (x[order] for x in beside)
        slope = (low - far + 8 * (up - near)) / (12 * h)  # error h⁴ times the fifth derivative / 30
        np.testing.assert_allclose(slope, motion.at(t)[order + 1], rtol=0, atol=1e-5)


def test_a_straight_leg_is_a_line_with_slerp():
    """Beside scipy's Slerp and Pinocchio's interpolation of the rotation."""
    robot, poses = corners("puma560")
    motion = kl.motion.cartesian(robot, poses[:2], q0=STARTS["puma560"], duration=2.0)
    law = quintic(1.875 / 2.0, 1e9)
    s = np.asarray(law(motion.t))
    slerp = Slerp([0, 1], Rotation.from_matrix([p[:3, :3] for p in poses[:2]]))(s).as_matrix()
    place = poses[0][:3, 3] + s[:, None] * (poses[1][:3, 3] - poses[0][:3, 3])
    here = kl.fk(robot, motion.q)
    np.testing.assert_allclose(here[:, :3, :3], slerp, rtol=0, atol=1e-8)
    np.testing.assert_allclose(here[:, :3, 3], place, rtol=0, atol=1e-8)
    spin = pin.SE3(poses[0][:3, :3], np.zeros(3)), pin.SE3(poses[1][:3, :3], np.zeros(3))
    for k in range(0, len(s), 20):
        mid = pin.SE3.Interpolate(*spin, float(s[k]))
        np.testing.assert_allclose(here[k, :3, :3], mid.rotation, rtol=0, atol=1e-8)


@pytest.mark.parametrize("overlap", [0.0, 0.3])
def test_twists_are_the_derivatives_of_the_poses(overlap):
    """Lines and an arc with turns, overlapping in time: central differences of log3."""
    _, poses = corners("ur5")
    via = 0.5 * (poses[1][:3, 3] + poses[2][:3, 3]) + [0.01, 0.02, 0.03]
    start, legs = read_legs("ur5", [poses[0], poses[1], kl.motion.Arc(via, poses[2])])
    law = quintic(1.875, 1e9)  # one second
    way = TimedPath(start, legs, (law, law), np.array([0.0, 1.0 - overlap]))
    h, t = 1e-5, np.linspace(0.01, way.duration - 0.01, 57)
    t = t[np.abs(t[:, None] - way.knots).min(axis=1) > h]
    (before, tb, _), (here, twist, change), (after, ta, _) = (way.at(x) for x in (t - h, t, t + h))
    np.testing.assert_allclose((after - before)[:, :3, 3] / (2 * h), twist[:, :3], atol=1e-8)
    spin = [r @ pin.log3(r.T @ b) - r @ pin.log3(r.T @ a) for r, a, b in
            zip(here[:, :3, :3], before[:, :3, :3], after[:, :3, :3], strict=True)]  # fmt: skip
    np.testing.assert_allclose(np.array(spin) / (2 * h), twist[:, 3:], atol=1e-8)
    np.testing.assert_allclose((ta - tb) / (2 * h), change, atol=1e-7)
    end = way.at(np.array([way.duration]))[0][0]
    np.testing.assert_allclose(end, poses[2], atol=1e-12)


def test_an_arc_lies_on_its_circle_and_passes_its_point():
    robot, poses = corners("puma560")
    via = 0.5 * (poses[0][:3, 3] + poses[1][:3, 3]) - [0.03, 0.0, 0.04]
    motion = kl.motion.cartesian(
        robot, [poses[0], kl.motion.Arc(via, poses[1])], q0=STARTS["puma560"], velocity=0.1,
        acceleration=0.3)  # fmt: skip
    place = kl.fk(robot, motion.sampled(1e-3).q)[:, :3, 3]
    assert np.linalg.norm(place - via, axis=1).min() < 1e-4
    # the circle through three points, by the equations of equal distance
    a, b, c = poses[0][:3, 3], via, poses[1][:3, 3]
    rows = np.array([2 * (b - a), 2 * (c - a), np.cross(b - a, c - a)])
    centre = np.linalg.solve(rows, [b @ b - a @ a, c @ c - a @ a, np.cross(b - a, c - a) @ a])
    radius = np.linalg.norm(a - centre)
    np.testing.assert_allclose(np.linalg.norm(place - centre, axis=1), radius, atol=1e-7)
    assert np.linalg.norm(np.diff(place, axis=0), axis=1).max() / 1e-3 <= 0.1 * 1.001
    hard = np.linalg.norm(np.diff(place, 2, axis=0), axis=1) / 1e-6
    assert 0.5 * 0.3 < hard.max() <= 0.3 * 1.001


def test_a_blend_rounds_the_corner_and_is_faster():
    robot, poses, stop = moved("puma560")
    _, _, through = moved("puma560", blend=0.8)
    assert through.duration < stop.duration
    near = [
        np.linalg.norm(kl.fk(robot, m.sampled(1e-3).q)[:, :3, 3] - poses[1][:3, 3], axis=1).min()
        for m in (stop, through)
    ]
    assert near[0] < 1e-5 < 1e-3 < near[1]
    np.testing.assert_allclose(kl.fk(robot, through.q[-1]), poses[2], atol=1e-8)


def test_a_way_that_leaves_the_reach_says_when_and_where():
    robot = kl.load("puma560")
    first = kl.fk(robot, STARTS["puma560"])
    last = first.copy()
    last[:3, 3] += [1.0, 0, 0]
    with pytest.raises(
        KinlabError, match=r"at t = .* s, tool at .*can be had until t = "
    ) as refused:
        kl.motion.cartesian(robot, [first, last], q0=STARTS["puma560"], duration=2.0)
    assert isinstance(refused.value, (UnreachableError, SingularError))
    x = float(str(refused.value).split("until t = ")[1].split("(")[1].split(",")[0])
    last[0, 3] = x - 0.01  # what it says can be had, can
    short = kl.motion.cartesian(robot, [first, last], q0=STARTS["puma560"], duration=20.0)
    np.testing.assert_allclose(kl.fk(robot, short.q[-1]), last, atol=1e-7)


def test_a_way_through_a_singularity_says_when_and_where():
    """The wrist of the Puma stretched on the way: q5 = 0 in the middle of a straight line."""
    robot = kl.load("puma560")
    middle = kl.fk(robot, [0.3, 0.5, -1, 0.3, 0.0, 0.2])
    first, last = middle.copy(), middle.copy()
    q5 = kl.fk(robot, [0.3, 0.5, -1, 0.3, 0.4, 0.2])
    first[:3, :3], last[:3, :3] = q5[:3, :3], middle[:3, :3] @ q5[:3, :3].T @ middle[:3, :3]
    with pytest.raises((SingularError, LimitError, UnreachableError), match=r"at t = ") as refused:
        kl.motion.cartesian(robot, [first, last], q0=[0.3, 0.5, -1, 0.3, 0.4, 0.2], duration=2.0)
    assert isinstance(refused.value, SingularError), refused.value
    assert "t = 1" in str(refused.value) or "t = 0.9" in str(refused.value)


def test_too_fast_for_the_joints_says_the_duration_that_works():
    robot, poses = corners("ur5")
    with pytest.raises(LimitError, match="same way holds it in") as refused:
        kl.motion.cartesian(robot, poses, q0=STARTS["ur5"], duration=0.1)
    least = float(str(refused.value).split("holds it in ")[1].split(" s")[0])
    motion = kl.motion.cartesian(robot, poses, q0=STARTS["ur5"], duration=least)
    assert np.all(motion.peak_velocity.value <= robot.model.upperVelocityLimit * (1 + 1e-6))


def half_turn(pose):
    out = pose.copy()
    out[:3, :3] = pose[:3, :3] @ np.diag([-1.0, -1, 1])
    return out


@pytest.mark.parametrize(
    ("change", "options", "says"),
    [
        (lambda p: p[:1], {}, "at least two poses"),
        (lambda p: [p[0], p[0]], {}, "pose 2 is the pose before"),
        (lambda p: [p[0], half_turn(p[0])], {}, "half turn"),
        (lambda p: [p[0], kl.motion.Arc(0.5 * (p[0] + p[1])[:3, 3], p[1])], {}, "one line"),
        (lambda p: [kl.motion.Arc([0, 0, 0], p[0]), p[1]], {}, "first is the pose"),
        (lambda p: p, {"duration": None}, "how fast"),
        (lambda p: p, {"blend": 1.5}, "blend"),
        (lambda p: p, {"law": "cubic"}, "quintic"),
        (lambda p: p, {"velocity": -1.0}, "velocity"),
        (lambda p: [p[0], np.eye(3)], {}, "pose 2"),
    ],
)
def test_bad_input(change, options, says):
    robot, poses = corners("puma560")
    with pytest.raises(KinlabError, match=says):
        kl.motion.cartesian(
            robot, change(poses), **({"q0": STARTS["puma560"], "duration": 2.0} | options)
        )
    assert issubclass(OptionError, KinlabError)
