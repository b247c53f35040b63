"""A name with dollars or codes in it is a name, in a figure too."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.plots.arms import ellipses
from kinlab.plots.canvas import save


@pytest.mark.parametrize("name", [r"$\frac{", "a$b$", r"{x} \alpha _^"])
def test_a_name_is_drawn_as_it_is(tmp_path, name):
    link = kl.DHLink(a=0.5, mass=1.0, com=(0.2, 0.0, 0.0))
    robot = kl.Robot.from_dh(kl.DHTable(name, "modified", [link, link]))
    save(ellipses(robot, [0.3, 0.5]), tmp_path / "f.svg")
    assert (tmp_path / "f.svg").stat().st_size > 1000
