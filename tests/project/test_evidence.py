"""Results of searches say what they rest on: what was searched, what is proved, what is found."""

from __future__ import annotations

import functools

import numpy as np
import pytest

import kinlab as kl
from kinlab.fivebar.design.front import DesignFront
from kinlab.fivebar.design.problem import read_problem
from kinlab.fivebar.design.synthesis import solve

PUMA = [0.3, -0.5, 0.6, 0.4, 0.9, -0.3]


def pose(name="puma560", q=PUMA):
    return kl.fk(name, q)


def motion(name="planar2r"):
    return kl.motion.joint(name, [[0.2, 0.6], [0.9, 1.1]], acceleration=3)


def far():
    target = pose()
    target[:3, 3] = 9.0
    return target


@functools.cache
def design():
    problem = read_problem((-0.1, 0.1, 0.4, 0.6), "condition", *[None] * 4, {}, None, None)
    return solve(problem, 0, generations=2)


RESULTS = {
    "nearest": lambda: kl.nearest_singularity("planar2r", [0.2, 0.6]),
    "describe": lambda: kl.describe_singularity("scara", [0.1, 0.0, 0.1, 0.2]),
    "named": lambda: kl.describe_singularity("puma560", [0.1, 0.2, 0.3, 0.4, 0.0, 0.5]),
    "families": lambda: kl.find_singularities("planar2r"),
    "loci": lambda: kl.singular_loci("planar3r", (1, 2)),
    "isotropy": lambda: kl.find_isotropic("planar2r", seeds=20),
    "design": lambda: kl.design_isotropic("planar2r", ["a2", "tool.x"], seeds=20),
    "det": lambda: kl.factored_determinant("planar2r"),
    "redundancy": lambda: kl.redundancy("panda", np.full(7, 0.3)),
    "boundary": lambda: kl.planar_boundary("planar2r"),
    "map": lambda: kl.sample_workspace("planar2r", samples=64),
    "ik": lambda: kl.ik("puma560", pose()),
    "ik fails": lambda: kl.ik("puma560", far()),
    "ik branch": lambda: kl.ik("puma560", pose(), branch="elbow up"),
    "ik batch": lambda: kl.ik_batch("puma560", np.stack([pose(), far()])),
    "path": lambda: kl.ik_path("puma560", np.stack([pose(), pose()]), PUMA),
    "branches": lambda: kl.ik_branches("puma560", pose()),
    "branches batch": lambda: kl.ik_branches("puma560", np.stack([pose(), pose()])),
    "count": lambda: kl.solution_count("puma560", pose()),
    "aspects": lambda: kl.aspects("planar2r"),
    "cuspidal": lambda: kl.is_cuspidal("planar2r", poses=4, nodes=20),
    "check": lambda: kl.motion.check("planar2r", motion()),
    "drives": lambda: kl.size_servos("planar2r", motion()),
    "five-bar": design,
    "front": lambda: DesignFront(("condition", "size"), (design(),)),
}


@pytest.mark.parametrize("what", RESULTS)
def test_every_search_says_what_it_rests_on(what):
    told = str(RESULTS[what]().evidence)
    assert len(told) > 20
    if "searched" in told:
        assert "proved: " in told


def test_a_failed_search_proves_nothing_but_its_error():
    answer = kl.ik("puma560", far())
    assert not answer.success
    assert "out of reach" in answer.evidence.found
    assert "out of reach" not in answer.evidence.proved
    batch = kl.ik_batch("puma560", np.stack([pose(), far()])).evidence
    assert batch.proved.startswith("1 poses") and "other 1" in batch.found


def test_the_kind_of_a_singularity_carries_its_evidence():
    """The stretched SCARA turns back: proved nearby, and found elsewhere."""
    stretched = kl.describe_singularity("scara", [0.1, 0.0, 0.1, 0.2])
    assert stretched.kind == "boundary"
    assert "no other branch" in stretched.evidence.found
    wrist = kl.find_singularities("puma560").families[-1]
    assert wrist.kind == "wrist" and wrist.beyond is True
    assert "passes on" in wrist.evidence.proved


def test_a_design_does_not_call_its_lengths_proved():
    evidence = design().evidence
    assert "no other lengths" in evidence.found
    assert "lengths" not in evidence.proved


def test_an_edge_is_not_decided_by_one_form_where_limits_take_more_rank():
    """A joint on its limit takes a second direction away: the form of one direction is silent."""
    from kinlab.analysis.singularities.edge import second_order_form
    from kinlab.analysis.structure.task_space import read_task

    links = [kl.DHLink(a=0.5, lower=-0.5 * k, upper=0.5 * k, mass=1.0) for k in (6, 1, 6, 6)]
    robot = kl.Robot.from_dh(kl.DHTable(name="four", convention="standard", links=links))
    space = read_task(robot, "xytheta")
    inside = np.array([0.1, 0.0, 0.0, 0.0])
    lost = np.linalg.svd(space.jacobian(inside, space.scale))[0][:, -1]
    assert second_order_form(space, inside, lost) != (0.0, 0.0)
    shut = [kl.DHLink(a=0.5, lower=0.0, upper=1.0, mass=1.0) for _ in range(4)]
    robot = kl.Robot.from_dh(kl.DHTable(name="shut", convention="standard", links=shut))
    space = read_task(robot, "xytheta")
    corner = np.array([0.3, 0.0, 0.0, 0.0])
    assert second_order_form(space, corner, lost) == (0.0, 0.0)
