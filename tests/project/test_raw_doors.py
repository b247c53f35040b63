"""Arguments that once ended in an error of Python or numpy: each is refused in words."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl

ROBOT = kl.load("planar2r")
T = kl.fk(ROBOT, [0.3, -0.7])
FIVE = kl.FiveBar.load("isotropic")
ARRAY = np.arange(3.0)


class Raises:
    def __array__(self, *args, **rest):
        raise RuntimeError("boom")

    def __len__(self):
        return 2

    def __getitem__(self, i):
        raise ZeroDivisionError("boom")


CALLS = {
    "method": lambda: kl.ik(ROBOT, T, method=ARRAY),
    "history": lambda: kl.ik(ROBOT, T, history=ARRAY),
    "seed": lambda: kl.ik_path(ROBOT, [T, T], [0.3, -0.7], seed=[1]),
    "branches of no array": lambda: kl.ik_branches(ROBOT, Raises()),
    "branches of ragged rows": lambda: kl.ik_branches(ROBOT, [[1.0, 2.0], [1.0]]),
    "kind": lambda: kl.ellipsoid(ROBOT, [0.3, -0.7], ARRAY),
    "links": lambda: kl.DHTable("t", "standard", 5),
    "a link for links": lambda: kl.DHTable("t", "standard", kl.DHLink()),
    "convention": lambda: kl.DHTable("t", ARRAY, [kl.DHLink()]),
    "assembly": lambda: FIVE.fk(FIVE.ik([0.1, -0.5]), ARRAY),
    "angles beyond use": lambda: FIVE.closed_chain().assemble([1e17, 1e17], 1),
}


@pytest.mark.parametrize("name", CALLS)
def test_it_is_refused_in_words(name):
    with pytest.raises(kl.KinlabError) as problem:
        CALLS[name]()
    assert str(problem.value).strip()
