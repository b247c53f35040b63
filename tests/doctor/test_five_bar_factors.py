"""A five-bar's equation as a function: right with any factor on both of its sides."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import kinlab as kl
from kinlab.check.quantities.registry import quantity as find_quantity

FACTORS = {
    "minus": lambda arm, x, y: -1.0,
    "half": lambda arm, x, y: 0.5,
    "by 2 l1": lambda arm, x, y: 1 / (2 * arm.l1[0]),
    "of the place": lambda arm, x, y: -1.0 / (x * x + y * y + 0.3),
}


def legs(arm: kl.FiveBar, xy: np.ndarray) -> np.ndarray:
    """A, B, C of both legs, by hand."""
    x, y = xy
    found = []
    for s in (1, -1):
        k = 0 if s == 1 else 1
        l1, l2, e = arm.l1[k], arm.l2[k], arm.e
        found.append([2 * (s * e - x) * l1, -2 * y * l1, l2**2 - l1**2 - (x - s * e) ** 2 - y**2])
    return np.array(found)


@pytest.mark.parametrize("name", ["isotropic", "unequal"])
@pytest.mark.parametrize("factor", FACTORS)
def test_a_common_factor_of_an_equation_is_right(name: str, factor: str) -> None:
    arm, by = kl.FiveBar.load(name), FACTORS[factor]

    def whole(xy):
        return by(arm, *xy) * legs(arm, xy)

    def leg(xy, s):
        return by(arm, *xy) * legs(arm, xy)[0 if s > 0 else 1]

    def apart(xy):
        return np.array([[by(arm, *xy)], [-2.0]]) * legs(arm, xy)

    def a_alone(xy):
        return legs(arm, xy) * [by(arm, *xy), 1, 1]

    def off(xy):
        return by(arm, *xy) * (legs(arm, xy) + [0, 0, 1e-3])

    for quantity, function in (
        ("fivebar_equation", whole),
        ("fivebar_equation", apart),
        ("fivebar_leg_equation", leg),
        ("fivebar_equation[0]", lambda xy: whole(xy)[0]),
    ):
        found = kl.diagnose(arm, quantity, function, samples=40)
        assert found.agrees and found.form == "unusual", quantity
        assert "A, B and C of a leg share" in found.remarks[-1]
    for function in (a_alone, off):
        assert not kl.diagnose(arm, "fivebar_equation", function, samples=40).agrees
    one = kl.diagnose(arm, "fivebar_equation[0,0]", lambda xy: whole(xy)[0, 0])
    known = factor in ("minus", "half", "by 2 l1")  # as a text by that factor is
    assert one.agrees == known and (not known or "if A, B and C all are" in one.remarks[-1])


@pytest.mark.parametrize("factor", [-1.0, 0.5, -2.0])
def test_the_loop_by_a_constant(factor: float) -> None:
    arm = kl.FiveBar.load("isotropic")

    def gap(theta, xy, power=2):
        pins = np.array([[arm.e, 0.0], [-arm.e, 0.0]])
        elbows = pins + np.array(
            [[l1 * np.cos(t), l1 * np.sin(t)] for l1, t in zip(arm.l1, theta, strict=True)]
        )
        return np.array([np.hypot(*(xy - x)) ** power - l2**power for x, l2 in zip(elbows, arm.l2, strict=True)])  # fmt: skip

    found = kl.diagnose(arm, "fivebar_loop", lambda t, xy: factor * gap(t, xy), samples=40)
    assert found.agrees and "same equation" in found.remarks[-1]
    assert kl.diagnose(arm, "fivebar_loop", lambda t, xy: gap(t, xy, 1), samples=40).agrees
    wrong = kl.diagnose(arm, "fivebar_loop", lambda t, xy: gap(t, xy) * (1 + t[0] ** 2), samples=40)
    assert not wrong.agrees


@pytest.mark.parametrize("name", ["isotropic", "unequal"])
@pytest.mark.parametrize("g", [9.8, 9.79, 9.5])
def test_g_rounded_in_a_torque_is_what_it_is_of_a_text(name: str, g: float) -> None:
    arm = kl.FiveBar.load(name)
    other, torque = replace(arm, gravity=(0.0, -g)), find_quantity("fivebar_torque_massless")

    def by_hand(*state):
        return torque.engine(other, *(np.asarray(x)[None] for x in state))[0]

    found = kl.diagnose(arm, "fivebar_torque_massless", by_hand, samples=40)
    assert found.agrees == (g == 9.8)
    assert not found.agrees or found.remarks == ("g = 9.8 stands for 9.81",)
