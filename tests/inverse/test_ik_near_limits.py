"""Reachable poses near limits and at singularities, which a search meets outside the limits first.

Found by tests/fuzz/ik_reach.py; reachable by construction (Pinocchio's pose of joint positions
within the limits), and the answers are measured by Pinocchio.
"""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl

# arm, seed of the search that missed the pose, joint positions of the pose
MISSED: list[tuple[str, int, list[float]]] = [
    ("erd:bravo7_no_ee", 0, [-3.977656, 2.707354, 3.077275, 3.330841, 0.3305, 4.08553]),
    ("erd:bravo7_no_ee", 0, [-5.382759, 0.0, 0.446861, -6.283182, 0.143939, -1.638628]),
    ("erd:bravo7_no_ee", 0, [-4.285206, 2.130347, 3.277528, -2.582363, 0.166791, 3.514448]),
    ("erd:bravo7_no_ee", 1, [3.921142, 0.528622, 0.215718, -6.283185, 0.0, -3.647628]),
    ("erd:bravo7_no_ee", 2, [6.277021, 3.5, 2.631714, -1.175799, 3.498921, 1.640113]),
    ("erd:bravo7_no_ee", 2, [1.121008, 0.977312, 0.082613, -0.140239, 0.068238, 1.309346]),
    ("erd:bravo7_no_ee", 3, [-0.565847, 2.332086, 0.057115, -6.280133, 0.238903, 3.496538]),
    ("erd:bravo7_no_ee", 3, [-6.219414, 3.102407, 3.5, 1.363699, 3.467652, 6.27184]),
    ("erd:so100", 0, [-1.015967, 0.0, -2.813266, -2.499997, -1.793695, 0.650083]),
    ("erd:so100", 1, [1.694817, 3.13563, -3.025561, -2.397423, -1.676141, -0.182159]),
    ("erd:so100", 1, [1.929632, 0.163315, -3.141555, 0.780088, -1.636888, -0.199946]),
    ("erd:so100", 1, [0.271818, 3.499993, -0.279161, -2.499999, 3.141571, 2.0]),
    ("erd:so100", 1, [-2.0, 3.271317, -3.141554, -1.774175, 3.14158, 1.98846]),
    ("erd:so100", 2, [-1.01781, 0.233674, -3.006749, -2.395058, 2.098279, -0.19874]),
    ("erd:so100", 2, [-1.570796, 0.0, -3.003242, 0.000724, 0.0, 1.524412]),
    ("erd:so100", 3, [-1.694509, 3.494358, 0.0, 1.199965, 2.196993, 1.977878]),
    ("erd:z1", 2, [-2.617982, 0.084603, -2.879793, -0.535562, 0.144695, 0.600982, 0.0]),
    ("erd:z1", 4, [2.617991, 0.027867, -2.879793, -1.518436, 0.690576, 2.792523, -0.000233]),
    ("erd:z1", 5, [2.617993, 0.007643, -2.879793, -1.057248, 1.343903, -2.792134, -0.45827]),
    ("puma560", 6, [-2.792525, -0.763994, -3.384729, -0.048838, -1.745329, -4.078046]),
]


@pytest.mark.parametrize("arm", sorted({arm for arm, _, _ in MISSED}))
def test_poses_near_limits_are_met_within_them(arm):
    robot = kl.load(arm)
    for _, seed, q in (case for case in MISSED if case[0] == arm):
        assert np.all(robot.lower <= q) and np.all(np.asarray(q) <= robot.upper)
        T = kl.fk(robot, q)
        answer = kl.ik(robot, T, seed=seed)
        assert answer.success, (arm, seed, q, answer.status)
        assert np.all(robot.lower <= answer.q) and np.all(answer.q <= robot.upper)
        assert np.allclose(kl.fk(robot, answer.q), T, rtol=0.0, atol=2e-6)
        batch = kl.ik_batch(robot, [T, T], seed=seed)
        assert np.array_equal(batch.q, [answer.q, answer.q])


@pytest.mark.parametrize("arm", ["puma560", "panda"])
def test_poses_that_only_limits_forbid_are_said_to_be_outside(arm):
    robot = kl.load(arm)
    rng = np.random.default_rng(4)
    q = rng.uniform(robot.lower, robot.upper, (20, robot.n))
    T = kl.fk(robot, q)
    T[:, :3, 3] *= 4.0 / np.linalg.norm(T[:, :3, 3], axis=1, keepdims=True)
    far = kl.ik_batch(robot, T)
    assert not far.success.any()
    assert np.all(far.restarts == 0)  # beyond reach: one search is enough
    narrow = kl.ik(robot, kl.fk(robot, q[0]), restarts=3)
    assert narrow.restarts <= 3
