"""Potentials and Lagrangians of another zero, with g rounded, and what is said of them."""

from __future__ import annotations

import re

import numpy as np
import pytest

import kinlab as kl


def planar(seed: int) -> tuple[kl.DHTable, float, float]:
    """An arm of two point masses, and the moments of mass that g multiplies."""
    rng = np.random.default_rng(seed)
    a, mass = np.round(rng.uniform(0.3, 0.7, 2), 2), np.round(rng.uniform(1, 4, 2), 1)
    links = [kl.DHLink("revolute", a=x, mass=m) for x, m in zip(a, mass, strict=True)]
    table = kl.DHTable("arm", "standard", links, gravity=(0, -9.81, 0))
    return table, a[0] * (mass[0] + mass[1]), a[1] * mass[1]


@pytest.mark.parametrize("seed", range(6))
def test_g_rounded_in_the_coefficients_of_a_potential_with_another_zero(seed: int) -> None:
    arm, one, two = planar(seed)
    for g in ("9.8", "9.80"):
        first, last = float(f"{float(g) * one:.8g}"), float(f"{float(g) * two:.8g}")
        for shape, off in (
            (f"{first}*(1 + s1) + {last}*(1 + s12)", first + last),
            (f"{first}*sin(q1) + {last}*sin(q1 + q2) + {seed + 1}.5", seed + 1.5),
        ):
            found = kl.diagnose(arm, "V", shape)
            assert found.agrees and found.form == "unusual", shape
            (size,) = re.findall(r"the difference is (\S+) J", found.remarks[0])
            assert float(size) == pytest.approx(off, rel=1e-5)
            assert "g = 9.8 stands for 9.81" in found.remarks
            assert "g = 9.81" not in found.remarks[-1]
    for wrong in (
        f"{9.8 * one}*(1 + s1) + {9.8 * two}*(1 + c12)",
        f"{9.8 * one}*(1 + s1) + {9.7 * two}*(1 + s12)",
        f"{9.7 * one}*(1 + s1) + {9.7 * two}*(1 + s12)",
        f"{9.8 * one}*(1 - s1) + {9.8 * two}*(1 - s12)",
    ):
        assert not kl.diagnose(arm, "V", wrong).agrees, wrong


@pytest.mark.parametrize("seed", range(3))
def test_the_same_of_a_lagrangian(seed: int) -> None:
    arm, one, two = planar(seed)
    energy = "m1*l1^2*qd1^2/2 + m2*(l1^2*qd1^2 + l2^2*(qd1 + qd2)^2)/2"
    energy += " + m2*l1*l2*c2*qd1*(qd1 + qd2)"
    right = f"{energy} - {9.8 * one:.8g}*(1 + s1) - {9.8 * two:.8g}*(1 + s12)"
    found = kl.diagnose(arm, "L", right)
    assert found.agrees and "g = 9.8 stands for 9.81" in found.remarks
    assert not kl.diagnose(arm, "L", right.replace("c2*", "s2*")).agrees


@pytest.mark.parametrize("seed", range(3))
def test_what_holds_for_every_arm_is_not_said_to_hold_for_one(seed: int) -> None:
    arm, *_moments = planar(seed)
    other = "[0, -m2*l1*l2*sin(q2)*(2*qd1 + qd2); m2*l1*l2*sin(q2)*qd1, 0]"
    found = kl.diagnose(arm, "C", other)
    assert found.agrees and not any("holds only" in one for one in found.remarks)
    slide = kl.diagnose("scara", "V", "-(m3+m4)*g*q3")
    assert slide.agrees and not any("holds only" in one for one in slide.remarks)
