"""Aspects: numbers of the literature, and a grid of signs."""

import numpy as np
import pytest
from arms import jaco2
from regional_arms import orthogonal, position
from scipy.ndimage import label

import kinlab as kl

WENGER = (1.0, 2.0, 1.5, 1.0)


def det_by_hand(q, h=1e-6):
    """det of the position's J by central differences of the formula by hand."""
    columns = []
    for j in range(3):
        move = np.zeros(3)
        move[j] = h
        columns.append((position(*WENGER, q + move) - position(*WENGER, q - move)) / (2 * h))
    return np.linalg.det(np.stack(columns, axis=-1))


@pytest.mark.parametrize(
    ("name", "count"), [("planar2r", 2), ("puma560", 8), ("ur5", 8), ("stanford", 4)]
)
def test_numbers_without_limits(name, count):
    """Two for an elbow; 2^3 for shoulder, elbow and wrist; a slide that stays on one side: 2^2."""
    found = kl.aspects(kl.load(name), limits=False)
    assert found.count == count
    assert all(group.separate for group in found.groups)


def test_wengers_arm_has_two_aspects_for_four_solutions():
    found = kl.aspects(orthogonal(*WENGER), limits=False)
    assert found.count == 2
    assert sorted(a.signs for a in found.groups[0].aspects) == [(-1,), (1,)]


def test_within_limits_as_a_grid_of_signs():
    robot = orthogonal(*WENGER)
    found = kl.aspects(robot)
    line = np.linspace(-np.pi, np.pi, 401)
    q = np.stack([0 * line[:, None] + 0 * line, *np.meshgrid(line, line, indexing="ij")], axis=-1)
    sign = det_by_hand(q.reshape(-1, 3)).reshape(401, 401) > 0
    expected = sum(label(sign == side)[1] for side in (True, False))
    assert found.count == expected
    parts = {side: label(sign == side)[0] for side in (True, False)}
    seen = {}
    for i, j in np.random.default_rng(0).integers(0, 401, (400, 2)):
        aspect = found.at(q[i, j])
        if aspect is not None:
            part = (bool(sign[i, j]), int(parts[bool(sign[i, j])][i, j]))
            assert seen.setdefault(aspect, part) == part
    assert len(set(seen.values())) == len(seen)


def test_shares_and_examples():
    found = kl.aspects(orthogonal(*WENGER))
    (group,) = found.groups
    assert sum(a.share for a in group.aspects) + group.undecided == pytest.approx(1.0)
    for number, aspect in enumerate(group.aspects):
        assert found.at(aspect.q) == (number,)
        assert abs(det_by_hand(aspect.q)) > 1e-3


def test_puma_within_limits_asks_for_every_factor():
    robot = kl.load("puma560")
    found = kl.aspects(robot)
    q = np.array([0.1, 0.5, -1.0, 0.2, 0.8, 0.3])
    other = q * [1, 1, 1, 1, -1, 1]
    assert found.at(q) != found.at(other)
    assert found.at(q) == found.at(q + [0.5, 0, 0, 0.5, 0.01, -0.3])


def test_outside_the_limits_and_on_a_singularity_there_is_none():
    found = kl.aspects(kl.load("planar2r"))
    assert found.at([0.0, 0.0]) is None
    assert found.at([0.0, 3.5]) is None
    with pytest.raises(kl.KinlabError):
        found.at([0.0, np.nan])


def test_too_many_deciding_joints_is_said():
    found = kl.aspects(jaco2())
    assert found.count is None
    assert "too many joints" in str(found.evidence)


def test_a_redundant_arm_is_refused():
    with pytest.raises(kl.KinlabError, match="joints"):
        kl.aspects(kl.load("panda"))
