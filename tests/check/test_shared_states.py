"""Quantities of a five-bar share states and poses; neither may differ from drawing them alone."""

from __future__ import annotations

import numpy as np
import pytest

from kinlab.check.quantities.fivebar import FIVEBAR
from kinlab.check.quantities.registry import quantity


@pytest.mark.parametrize("name", ["fivebar_rod_length", "fivebar_torque", "fivebar_jacobian"])
def test_shared_states_are_those_drawn_alone(name):
    found = quantity(name)
    fivebar = FIVEBAR.load("unequal")
    alone = FIVEBAR.sample(fivebar, found.arguments, 5, np.random.default_rng(3))
    for shared, drawn in zip(found.states(fivebar, 5, 3), alone, strict=True):
        np.testing.assert_array_equal(shared, drawn)


def test_massless_rods_have_the_poses_of_the_five_bar_but_not_its_torques():
    fivebar = FIVEBAR.load("unequal")
    heavy, light = quantity("fivebar_torque"), quantity("fivebar_torque_massless")
    states = heavy.states(fivebar, 5, 0)
    assert not np.allclose(heavy.engine(fivebar, *states), light.engine(fivebar, *states))
    chain = fivebar.closed_chain()
    for xy, mode in zip(states[0], states[-1], strict=True):
        ends = quantity("fivebar_rods").engine(fivebar, xy[None], mode[None])[0]
        cranks = quantity("fivebar_cranks").engine(fivebar, xy[None], mode[None])[0]
        bases = np.array([[fivebar.e, 0.0], [-fivebar.e, 0.0]])
        for leg in range(2):
            tool = bases[leg] + np.asarray(fivebar.l1)[leg] * cranks[leg]
            np.testing.assert_allclose(
                tool + np.asarray(fivebar.l2)[leg] * ends[leg], xy, atol=1e-9
            )
        np.testing.assert_allclose(chain.fk(chain.at(xy, mode)), xy, atol=1e-9)
