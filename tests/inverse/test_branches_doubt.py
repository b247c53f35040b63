"""Where branches may be lost the answer does not call itself complete.

Each pose is the forward kinematics of a joint position, so that this position is a solution: it is
among the branches, or ``complete`` is false.
"""

import numpy as np
import pytest

import kinlab as kl

KR6 = [
    (0.025, -90, 0.4, 0), (0.455, 0, 0, 0), (0.035, -90, 0, -90),
    (0, 90, 0.42, 0), (0, -90, 0, 0), (0, 0, 0.08, 0),
]  # fmt: skip
"""Rows a, alpha, d, theta of an arm like a KUKA KR 6, metres and degrees."""


def arm(rows, name):
    wide = {"lower": -3.2, "upper": 3.2}
    links = [
        kl.DHLink(a=a, alpha=np.radians(alpha), d=d, theta=np.radians(theta), **wide)
        for a, alpha, d, theta in rows
    ]
    return kl.Robot.from_dh(kl.DHTable(name=name, convention="standard", links=links))


def offset(column, value):
    rows = [list(row) for row in KR6]
    rows[4]["a alpha d".split().index(column)] = value
    return arm(rows, "offset_wrist")


def is_among(robot, q, found):
    if not len(found):
        return False
    apart = (found.q - q + np.pi) % (2 * np.pi) - np.pi
    return float(np.abs(apart).max(axis=1).min()) < 1e-4


@pytest.mark.parametrize("column", ["a", "d"])
@pytest.mark.parametrize("value", [1e-4, 1e-6, 1e-8, 1e-9])
def test_a_nearly_spherical_wrist_at_its_singular_pose(column, value):
    robot, rng = offset(column, value), np.random.default_rng(3)
    for factor in (0.0, 0.3, 2.0):
        for _ in range(3):
            q = rng.uniform(-1.5, 1.5, 6)
            q[4] = factor * value
            found = kl.ik_branches(robot, kl.fk(robot, q))
            assert is_among(robot, q, found) or not found.complete, (q, found.evidence)


@pytest.mark.parametrize("away", [1e-9, 1e-8, 3e-8, 1e-7])
def test_a_wrist_centre_beside_the_first_axis(away):
    robot, rng = arm(KR6, "kr6"), np.random.default_rng(4)
    tried = 0
    for _ in range(200):
        q = rng.uniform(-1.5, 1.5, 6)
        line = np.linspace(-3.0, 3.0, 400)
        states = np.tile(q, (len(line), 1))
        states[:, 2] = line
        reach = [radius(robot, state) for state in states]
        change = np.flatnonzero(np.diff(np.sign(reach)))
        if not len(change):
            continue
        low, high = line[change[0]], line[change[0] + 1]
        for _ in range(80):
            q[2] = 0.5 * (low + high)
            states[0, :] = q
            states[0, 2] = low
            if radius(robot, q) * radius(robot, states[0]) <= 0:
                high = q[2]
            else:
                low = q[2]
        q[2] += away
        found = kl.ik_branches(robot, kl.fk(robot, q))
        assert is_among(robot, q, found) or not found.complete, (q, found.evidence)
        tried += 1
        if tried == 8:
            break
    assert tried == 8


def radius(robot, q):
    """Signed distance of the wrist centre from the first axis, in the arm's plane."""
    pose = kl.fk(robot, q)
    centre = pose[:3, 3] - 0.08 * pose[:3, 2]
    return float(centre @ np.array([np.cos(q[0]), np.sin(q[0]), 0.0]))


def test_a_multiple_root_of_five_joints():
    def row(a, alpha, d, theta, joint="revolute", flip=False):
        return kl.DHLink(
            joint=joint, a=a, alpha=alpha, d=d, theta=theta, flip=flip, lower=-3.2, upper=3.2
        )

    links = [
        row(0.5, 0.7, 0.2, 0),
        row(0.5, np.pi / 4, 0.2, 0, "prismatic", flip=True),
        row(0.3, np.pi, 0.3, np.pi / 2),
        row(0.5, 0, 0, 0),
        row(0.3, 0.7, 0, np.pi / 2, flip=True),
    ]
    robot = kl.Robot.from_dh(kl.DHTable(name="rprrr", convention="standard", links=links))
    q = np.array([-np.pi, 0.0, -np.pi / 2, np.pi, -np.pi / 2])
    found = kl.ik_branches(robot, kl.fk(robot, q))
    assert is_among(robot, q, found) or not found.complete


def test_an_exact_wrist_is_still_complete():
    robot, rng = arm(KR6, "kr6"), np.random.default_rng(5)
    for _ in range(10):
        q = rng.uniform(-1.2, 1.2, 6)
        q[4] = 0.5
        found = kl.ik_branches(robot, kl.fk(robot, q))
        assert found.complete and is_among(robot, q, found)
