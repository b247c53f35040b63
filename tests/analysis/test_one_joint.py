"""An arm whose task is one number: where J is zero altogether, the whole of it is rounding."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl


def test_a_rod_is_singular_where_it_points_along_the_axis_of_its_task():
    found = kl.find_singularities("single_link")  # x = l cos q, so dx/dq = 0 at 0 and pi
    assert sorted(f.pinned[0] for f in found.families) == pytest.approx([0.0, np.pi], abs=1e-8)
    assert [s.rank for s in found] == [0, 0]
    assert all(s.ratio == 0.0 for s in found)
    assert {f.kind for f in found.families} == {"boundary"}  # |x| is at its most there


@pytest.mark.parametrize(("q", "distance"), [(1.0, 1.0), (2.0, np.pi - 2.0), (-0.25, 0.25)])
def test_its_nearest_singularity(q, distance):
    near = kl.nearest_singularity("single_link", [q])
    assert near.distance == pytest.approx(distance, abs=1e-6)
    assert near.bound <= distance
