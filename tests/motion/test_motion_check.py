"""What a motion meets on its way, beside what is known of the arm by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import OptionError, StructureError
from kinlab.motion.limits import read_limits

ELBOW = kl.load("planar2r")
PUMA = kl.load("puma560")


def test_a_free_motion_is_shown_to_be_free():
    """sigma_min of the two-link arm over a dense grid of times is above the bound."""
    motion = kl.motion.joint(ELBOW, [[0.4, 0.9], [1.0, 1.8]], acceleration=8)
    found = kl.motion.check(ELBOW, motion)
    assert found.ok and found.branches == ("elbow left", "elbow left")
    jac = kl.jacobian(ELBOW, motion.sampled(1e-4).q)[:, :2]
    length = np.sqrt(np.mean(jac**2))
    least = np.linalg.svd(jac, compute_uv=False)[:, -1].min()
    assert 0.1 * least / length < found.sigma < 10 * least / length
    assert "no singularity on the way" in str(found)


def test_a_crossing_is_found_when_and_where():
    """The two-link arm is singular where q2 = 0 only."""
    motion = kl.motion.joint(ELBOW, [[0.4, 0.9], [1.0, -0.6]], acceleration=8)
    found = kl.motion.check(ELBOW, motion)
    singular, branch = found.findings
    assert (singular.kind, branch.kind) == ("singularity", "branch")
    q = motion.at(singular.t)[0]
    assert abs(q[1]) < 1e-9 and not found.ok and found.sigma is None
    np.testing.assert_allclose(singular.tool, kl.fk(ELBOW, q)[:3, 3], atol=1e-12)
    assert found.branches == ("elbow left", "elbow right")
    assert "'elbow left' to 'elbow right' through the singularity" in branch.sentence


def test_the_wrist_and_the_elbow_of_the_puma():
    wrist = kl.motion.joint(
        PUMA, [[0, 0, 0, 0, 0.5, 0], [1, 0.5, -1, 0.3, -0.5, 0.2]], acceleration=8
    )
    found = kl.motion.check(PUMA, wrist)
    (at,) = [one.t for one in found.findings if one.kind == "singularity"]
    assert abs(wrist.at(at)[0][4]) < 1e-9
    assert "wrist flip" in found.branches[0] and "wrist no flip" in found.branches[1]
    free = kl.motion.joint(
        PUMA, [[0, 0, 0, 0, 0.5, 0], [1, 0.5, -1, 0.3, 0.5, 0.2]], acceleration=8
    )
    assert kl.motion.check(PUMA, free).ok


def test_a_touched_singularity_is_not_called_a_crossing():
    """q2 comes to 0 and goes back: det J does not change its sign."""
    motion = kl.motion.joint(ELBOW, [[0.4, 0.9], [0.7, 0.0], [1.0, 0.5]], acceleration=8)
    found = kl.motion.check(ELBOW, motion)
    (near,) = found.findings
    assert near.kind == "near singularity" and "undecided" in near.sentence
    assert near.t == pytest.approx(motion.knots[1], abs=1e-2)


def test_limits_that_are_broken_are_named():
    fast = kl.motion.joint(ELBOW, [[0.4, 0.9], [1.0, 1.8]], velocity=50, duration=0.1)
    kinds = {one.kind: one for one in kl.motion.check(ELBOW, fast, acceleration=100).findings}
    assert {"velocity", "acceleration", "effort"} <= set(kinds)
    peak = fast.peak_velocity
    assert (
        kinds["velocity"].t == pytest.approx(0.05)
        and f"{peak.value[1]:.6g}" in kinds["velocity"].sentence
    )
    t = np.linspace(0, 4, 81)
    q = np.column_stack([3.5 * np.sin(np.pi * t / 4), 1.0 + 0.1 * t])
    wild = kl.motion.from_samples(ELBOW, t, q)
    (position,) = [x for x in kl.motion.check(ELBOW, wild).findings if x.kind == "position"]
    assert position.t == pytest.approx(2.0, abs=1e-4) and "joint_1" in position.sentence
    assert read_limits(ELBOW).velocity.tolist() == [6.0, 6.0]


def test_a_motion_of_another_arm_is_refused():
    motion = kl.motion.joint(ELBOW, [[0.4, 0.9], [1.0, 1.8]], acceleration=8)
    with pytest.raises(StructureError, match="6 joints; the motion has 2"):
        kl.motion.check(PUMA, motion)


HOME = [0.3, -1.0, 1.2, 0.3, 0.8, 0.2]


@pytest.mark.parametrize(
    ("start", "end", "changes"),
    [
        (1.2, [-1.2, 0.8], [("elbow up", "elbow down")]),
        (-0.3, [-1.2, 0.8], []),  # its name changes, no singularity is met
        (1.2, [-0.9, -0.8], [("wrist flip", "wrist no flip"), ("elbow up", "elbow down")]),
    ],
)
def test_branches_change_at_singularities_and_nowhere_else(start, end, changes):
    """The oracle is the sign of q3 and of sin q5: the elbow and the wrist of the UR5."""
    points = [HOME.copy(), HOME.copy()]
    points[0][2] = start
    points[1][2], points[1][4] = end
    motion = kl.motion.joint("ur5", points, acceleration=3.0)
    found = [one for one in kl.motion.check("ur5", motion).findings if one.kind == "branch"]
    assert len(found) == len(changes)
    for one, (before, after) in zip(found, changes, strict=True):
        assert before in one.sentence.split(" to ")[0] and after in one.sentence.split(" to ")[1]
        q = motion.at(one.t)[0]
        assert min(abs(q[2]), abs(np.sin(q[4]))) < 1e-6


@pytest.mark.parametrize("law", ["trapezoid", "optimal"])
def test_a_law_that_jumps_holds_no_jerk(law):
    with pytest.raises(OptionError, match="holds no limit of jerk"):
        kl.motion.joint("planar2r", [[0, 0], [1, 1]], law, acceleration=3.0, jerk=3.0)


def test_efforts_are_not_judged_by_the_samples_of_the_motion():
    """Two samples, both at the ends: what the joints need in the middle is seen all the same."""
    table = kl.load("planar2r").table
    points = [[-1.2, 0.9], [1.2, 0.9]]
    fine = kl.motion.joint(table, points, duration=0.9, step=1e-3)
    tau = np.abs(kl.inverse_dynamics(table, fine.q, fine.v, fine.a))
    limits = 0.5 * (tau.max(axis=0) + np.maximum(tau[0], tau[-1]))
    links = [replace(k, effort=float(x)) for k, x in zip(table.links, limits, strict=True)]
    weak = replace(table, links=links)
    for step in (0.9, 1e-3):
        found = kl.motion.check(weak, kl.motion.joint(weak, points, duration=0.9, step=step))
        assert not found.ok and {one.kind for one in found.findings} == {"effort"}
        assert found.instants > 100
    plenty = kl.motion.check(table, fine)
    assert plenty.ok and f"efforts compared at {plenty.instants:,} instants" in str(plenty)
