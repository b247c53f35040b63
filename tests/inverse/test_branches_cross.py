"""Closed forms against continuation, which knows nothing of intersecting or parallel axes, and
the Stanford arm against a scan of its own."""

import math

import numpy as np
import pytest
from arms import HALF, random_arm, table

import kinlab as kl
from kinlab.engine.fast.arrays import chain
from kinlab.inverse.branches.continuation import generic_solutions
from kinlab.inverse.branches.rows import all_branches
from kinlab.inverse.branches.structures import GENERAL, known_form


def shoulder_arm(seed):
    """Axes 1, 2 and 3 meet in a point; the rest lies anyhow."""
    rng = np.random.default_rng(seed)
    rows = [(0, -HALF, 0, 0.2), (0, 1.1, 0, -0.4), (0.2, 0.9, 0.5, 0.3)]
    rows += [(*rng.uniform(0.1, 0.5, 2), *rng.uniform(-0.4, 0.4, 2)) for _ in range(3)]
    return table("shoulder", "standard", rows)


def triple_arm(first, seed=1):
    """Axes first to first + 2 parallel (counted from 1), the rest anyhow."""
    rng = np.random.default_rng(seed)
    rows = []
    for joint in range(1, 7):
        alpha = 0.0 if joint in (first, first + 1) else rng.uniform(0.4, 1.3)
        rows.append((rng.uniform(0.1, 0.5), alpha, *rng.uniform(-0.3, 0.3, 2)))
    return table(f"triple{first}", "standard", rows)


ARMS = {
    "puma560": ("spherical wrist", 8), "stanford": ("spherical wrist", 8),
    "erd:kinova": ("spherical wrist", 8), "ur5": ("three parallel axes", 8),
    "shoulder": ("spherical wrist", 8), "triple 2": ("three parallel axes", 8),
    "triple 3": ("three parallel axes", 8), "triple 1": ("continuation", None),
    "triple 4": ("continuation", None),
}  # fmt: skip


def arm(name):
    if name == "shoulder":
        return shoulder_arm(2)
    return triple_arm(int(name[-1])) if name.startswith("triple") else kl.load(name)


@pytest.mark.parametrize("name", ARMS)
def test_closed_forms_find_what_continuation_finds(name):
    robot = arm(name)
    known = known_form(robot)
    method, most = ARMS[name]
    assert known.method == method
    generic = generic_solutions(*chain(robot))
    assert most is None or generic.q.shape[1] == most
    general = known.form._replace(
        family=GENERAL, poses=generic.poses, starts=generic.q, length=generic.length
    )
    rng = np.random.default_rng(3)
    q = rng.uniform(-2.5, 2.5, (40, 6))
    poses = kl.fk(robot, q)
    swapped = poses[rng.permutation(40), :3, :3]
    poses[20:, :3, :3] = swapped[20:]  # half of them perhaps out of reach
    flat = np.ascontiguousarray(poses[:, :3]).reshape(40, 12)
    limits = (robot.lower.copy(), robot.upper.copy(), np.clip(0.0, robot.lower, robot.upper))
    one, other = all_branches(known.form, limits, flat), all_branches(general, limits, flat)
    assert not one.states.any() and not other.states.any()
    np.testing.assert_array_equal(one.counts, other.counts)
    slides = [i for i, kind in enumerate(known.form.prismatic) if kind]
    for i, count in enumerate(one.counts):
        for solution in one.q[i, :count]:
            gap = other.q[i, :count] - solution
            turned = (gap + np.pi) % (2 * np.pi) - np.pi
            turned[:, slides] = gap[:, slides]
            assert np.abs(turned).max(axis=1).min() < 1e-7


def test_stanford_against_a_scan():
    """q1 and d3 follow from q2 by hand; q2 is scanned for the distance that is left over."""
    robot = kl.load("stanford")
    d1, d2, a3, d6 = 0.412, 0.154, 0.0203, 0.263
    grid = np.linspace(-math.pi, math.pi, 20001)

    def left_over(q2, radius2, height):
        # the slide leans q2 from the vertical; a3 lies along -y2, against d2
        return (height * np.sin(q2)) ** 2 + ((d2 - a3) ** 2 - radius2) * np.cos(q2) ** 2

    for q in np.random.default_rng(4).uniform(robot.lower, robot.upper, (10, 6)):
        T = kl.fk(robot, q)
        centre = T[:3, 3] - d6 * T[:3, 2]
        values = left_over(grid, float(centre[:2] @ centre[:2]), centre[2] - d1)
        roots = np.sum(values[:-1] * values[1:] < 0)
        found = kl.ik_branches(robot, T)
        # each root is one (q2, d3) with one q1, and each of these has two wrists
        assert found.complete and len(found) == 2 * roots


def test_parallel_axes_and_wrists_of_random_arms_keep_to_the_chain():
    for seed in range(3):
        robot = random_arm(seed, 5)
        for q in np.random.default_rng(seed).uniform(-3, 3, (3, 5)):
            found = kl.ik_branches(robot, kl.fk(robot, q))
            assert found.complete and len(found) >= 1
