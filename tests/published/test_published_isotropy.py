"""Isotropic designs of the literature."""

from __future__ import annotations

import numpy as np
import pytest
from literature_arms import (
    HALF,
    arm,
    condition,
    diestro,
    equilateral,
    finger,
    hand_jacobian,
    planar,
    spherical_wrist,
    wrap,
)  # fmt: skip

import kinlab as kl


def test_diestro_is_isotropic_at_its_published_posture() -> None:
    """Williams, Angeles and Bulca 1993 (Design and philosophy of an isotropic six-axis serial
    manipulator, Robotics and Computer-Integrated Manufacturing 10): a = b = 50 mm, twists 90 deg in
    turn; posture (any, 90, -90, 90, -90, 180) deg. Table from memory; the posture is checked here.
    """
    robot = diestro()
    for first in (0.0, 0.7, -2.0):
        q = np.array([first, HALF, -HALF, HALF, -HALF, np.pi])
        J = hand_jacobian(robot, q)
        J[:3] /= 0.05
        assert condition(J) == pytest.approx(1.0, abs=1e-12)
        assert np.allclose(J @ J.T, 2.0 * np.eye(6), atol=1e-12)
        assert kl.manipulability(robot, q, "inverse_condition", length=0.05) == pytest.approx(
            1.0, abs=1e-12
        )
        assert kl.characteristic_length(robot, q).length == pytest.approx(0.05, rel=1e-6)


def test_diestro_is_found() -> None:
    """The search meets it, with the length of 50 mm, as a family of joint 1 alone."""
    found = kl.find_isotropic(diestro(), "pose")
    assert found.best_condition == pytest.approx(1.0, abs=1e-7)
    assert len(found.configurations) >= 1
    for conf in found.configurations:
        J = hand_jacobian(diestro(), conf.q)
        J[:3] /= conf.length
        assert condition(J) == pytest.approx(1.0, abs=1e-6)
    hits = [
        c for c in found.configurations
        if np.allclose(np.cos(c.q[1:]), np.cos([HALF, -HALF, HALF, -HALF, np.pi]), atol=1e-5)
        and np.allclose(np.sin(c.q[1:]), np.sin([HALF, -HALF, HALF, -HALF, np.pi]), atol=1e-5)
    ]  # fmt: skip
    assert len(hits) == 1
    assert hits[0].length == pytest.approx(0.05, rel=1e-6)
    assert hits[0].freedom == 1


def test_salisbury_and_craig_planar_two_link() -> None:
    """Salisbury and Craig 1982 (Articulated hands: force control and kinematic issues, IJRR 1(1)):
    two links are isotropic where l1 = sqrt(2) l2 and the second joint stands at 135 deg.
    """
    found = kl.find_isotropic(planar(np.sqrt(2.0), 1.0), "xy")
    angles = sorted(abs(float(wrap(c.q)[1])) for c in found.configurations)
    assert angles == pytest.approx([3 * np.pi / 4] * 2, abs=1e-7)
    assert all(c.freedom == 1 for c in found.configurations)
    assert kl.find_isotropic(planar(1.0, 1.0), "xy").best_condition > 1.3


@pytest.mark.parametrize("ratio", [1.0, 1.2, 1.5, 2.0])
def test_two_link_least_condition_number(ratio: float) -> None:
    """Least condition number of two links l1 = ratio l2, from the closed form: with r = l1, l2 = 1,
    kappa + 1/kappa = tr(J J^T) / |det J| = (r^2 + 2 + 2 r c) / (r |s|), least where
    c = -2 r / (r^2 + 2), so that it is sqrt((r^2 + 2)^2 - 4 r^2) / r = sqrt(r^4 + 4) / r.
    (The measure is Salisbury and Craig's; the formula is derived here.)
    """
    best = kl.find_isotropic(planar(ratio, 1.0), "xy").best_condition
    assert best + 1 / best == pytest.approx(np.sqrt(ratio**4 + 4) / ratio, rel=1e-9)


@pytest.mark.parametrize("l2", [1.0, 0.3])
def test_finger_with_crossing_base_stands_alone(l2: float) -> None:
    """Salisbury and Craig's finger, a1 = 0: two links as above, and the tip, at distance l2 from the
    base's axis, as high as the base. The radius is stationary there: a first order tangent sees
    one freedom too many, and only the first joint is free.
    """
    found = kl.find_isotropic(finger(0.0, np.sqrt(2.0) * l2, l2), "position")
    assert found.best_condition == pytest.approx(1.0, abs=1e-7)
    assert len(found.configurations) == 4  # two elbows, tip on either side of the axis
    for c in found.configurations:
        assert abs(float(wrap(c.q)[2])) == pytest.approx(3 * np.pi / 4, abs=1e-4)
        assert condition(
            hand_jacobian(finger(0.0, np.sqrt(2.0) * l2, l2), c.q)[:3]
        ) == pytest.approx(1.0, abs=1e-6)
        assert c.freedom == 1


def test_equilateral_planar_arm() -> None:
    """Angeles, Fundamentals of Robotic Mechanical Systems (section on kinetostatic performance
    indices): joints at the corners of an equilateral triangle, tip at its centre;
    characteristic length sqrt(6)/6 a. Number from memory, and it follows from
    sum r r^T = 3/2 r^2 1 with r = a/sqrt(3): 3/2 r^2 / L^2 = 3.
    """
    robot = equilateral()
    q = np.deg2rad([20.0, 120.0, 150.0])
    J = hand_jacobian(robot, q)[[0, 1, 5]]
    L = np.sqrt(6.0) / 6.0
    J[:2] /= L
    assert condition(J) == pytest.approx(1.0, abs=1e-12)
    assert kl.characteristic_length(robot, q, "xytheta").length == pytest.approx(L, rel=1e-6)
    found = kl.find_isotropic(robot, "xytheta")
    assert len(found.configurations) == 2  # the triangle and its mirror image
    for c in found.configurations:
        assert np.allclose(np.abs(wrap(c.q)[1:]), np.deg2rad([120.0, 150.0]), atol=1e-6)
        assert c.length == pytest.approx(L, rel=1e-6)
        assert c.freedom == 1


def test_orthogonal_wrist() -> None:
    """Angeles, Fundamentals: a three-axis spherical wrist is isotropic where its axes are mutually
    orthogonal; with twists other than 90 deg it cannot be.
    """
    found = kl.find_isotropic(spherical_wrist(), "orientation")
    assert sorted(abs(float(wrap(c.q)[1])) for c in found.configurations) == pytest.approx(
        [HALF, HALF], abs=1e-7
    )
    assert all(c.freedom == 2 for c in found.configurations)
    skew = kl.find_isotropic(spherical_wrist(np.deg2rad(70)), "orientation")
    assert not skew.configurations
    assert skew.best_condition > 1.1


@pytest.mark.parametrize("n", [3, 4, 5, 7])
def test_axes_evenly_on_a_cone(n: int) -> None:
    """Klein and Miklos 1991 (Spatial robotic isotropy, IJRR 10(4)) call an arm isotropic where J J^T
    of the rows in question is a multiple of 1. For n axes through one point, evenly around a cone,
    that holds at the half angle acos(1/sqrt(3)) = 54.74 deg (a unit-norm tight frame; construction
    ours, criterion theirs, from memory).
    """
    half = np.arccos(1 / np.sqrt(3.0))
    turns = 2 * np.pi * np.arange(n) / n
    axes = np.array(
        [np.sin(half) * np.cos(turns), np.sin(half) * np.sin(turns), np.full(n, np.cos(half))]
    )
    # all neighbours at the same angle, all dihedral angles equal: twist t, theta constant
    c = float(axes[:, 0] @ axes[:, 1])
    twist = np.arccos(c)
    u, v = (
        np.cross(axes[:, 0], axes[:, 1]),
        np.cross(axes[:, 1], axes[:, 2] if n > 2 else axes[:, 0]),
    )
    turn = np.arctan2(np.cross(u, v) @ axes[:, 1], u @ v)
    robot = arm("cone", [("R", 0, twist, 0, 0)] * (n - 1) + [("R", 0, 0, 0.1, 0)])
    q = np.concatenate([[0.3], np.full(n - 1, turn)])
    q[-1] = 0.4
    assert condition(hand_jacobian(robot, q)[3:]) == pytest.approx(1.0, abs=1e-12)
    assert kl.manipulability(robot, q, "inverse_condition", "orientation") == pytest.approx(
        1.0, abs=1e-12
    )


@pytest.mark.parametrize("lengths", [(1, 1, 1, 1), (0.4, 0.3, 0.2, 0.1), (0.3, 0.5, 0.4, 0.35)])
def test_planar_four_link_is_a_surface(lengths: tuple[float, ...]) -> None:
    """J J^T = a 1 of two rows is two equations; a planar 4R has four joints: freedom 2 (joint 1 and
    one curve), as the count of Klein and Miklos 1991 has it for redundant arms.
    """
    found = kl.find_isotropic(planar(*lengths), "xy")
    assert found.configurations
    assert {c.freedom for c in found.configurations} == {2}


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_puma_least_condition_number(seed: int) -> None:
    """Not a paper's number: an own search (pool of 20,000, Nelder-Mead) gives 3.16444, L = 0.2832 m."""
    found = kl.find_isotropic(kl.load("puma560"), "pose", seed=seed)
    J = hand_jacobian(kl.load("puma560"), found.best_q)
    J[:3] /= found.best_length
    assert condition(J) == pytest.approx(found.best_condition, rel=1e-9)
    assert found.best_condition == pytest.approx(3.16444, abs=2e-5)
    assert found.best_length == pytest.approx(0.2832, abs=2e-4)


def test_huang_five_bar() -> None:
    """Huang, Li, Li, Chetwynd and Gosselin 2005 (Conceptual design and dimensional synthesis of a
    novel 2-DOF translational parallel robot, J. Mech. Des. 127, doi 10.1115/1.1898343): isotropic
    where e = (l2 - l1)/sqrt(2), at (0, -(l1 + l2)/sqrt(2)).
    """
    for l1, l2 in ((0.3, 0.5), (0.25, 0.75), (1.0, 1.4)):
        robot = kl.FiveBar(l1, l2, (l2 - l1) / np.sqrt(2.0))
        xy = np.array([0.0, -(l1 + l2) / np.sqrt(2.0)])
        J = robot.jacobian(xy)
        assert condition(J) == pytest.approx(1.0, abs=1e-12)
        assert robot.condition_number(xy) == pytest.approx(1.0, abs=1e-12)
        # rods at right angles to each other, each in line with its crank
        theta = robot.ik(xy)
        tips = np.array(
            [[robot.base_x[i] + l1 * np.cos(theta[i]), l1 * np.sin(theta[i])] for i in range(2)]
        )
        w = xy - tips
        assert w[0] @ w[1] == pytest.approx(0.0, abs=1e-12)
        other = kl.FiveBar(l1, l2, 1.1 * (l2 - l1) / np.sqrt(2.0))
        assert other.condition_number(xy) > 1.001
