"""Answers of another shape or kind: what is meant is told where it is right, else refused."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl


@pytest.mark.parametrize("name", ["planar2r", "planar3r", "single_link"])
def test_the_quantity_that_is_meant_is_told_where_it_agrees(name: str) -> None:
    arm = kl.load(name)
    rows = [0, 1, 5]
    for quantity, function, meant in (
        ("jacobian", lambda q: kl.jacobian(arm, q)[rows], "planar_jacobian"),
        ("jacobian", lambda q: kl.jacobian(arm, q)[:2], "planar_jacobian[:2]"),
        ("fk", lambda q: kl.fk(arm, q)[:3], "fk[:3]"),
        ("fk", lambda q: kl.fk(arm, q)[:3, 3], "fk[:3,3]"),
    ):
        found = kl.diagnose(arm, quantity, function, samples=20)
        assert not found.agrees
        assert f"right if '{meant}' is meant" in " ".join(found.partial)
        assert kl.diagnose(arm, meant, function, samples=20).agrees
    wrong = kl.diagnose(arm, "jacobian", lambda q: 1.01 * kl.jacobian(arm, q)[rows], samples=20)
    assert not wrong.agrees and "is meant" not in " ".join(wrong.partial)


def test_kinds_of_answers() -> None:
    arm = kl.load("planar2r")

    def weight(q):
        return kl.gravity_torques(arm, q)

    assert kl.diagnose(arm, "gravity_torques", lambda q: weight(q) + 0j).agrees
    assert not kl.diagnose(arm, "gravity_torques", lambda q: 1.1 * weight(q) + 0j).agrees
    for function, what in (
        (lambda q: dict(enumerate(weight(q))), "a dict"),
        (lambda q: map(float, weight(q)), "a map"),
        (lambda q: (x for x in weight(q)), "a generator"),
    ):
        with pytest.raises(kl.KinlabError, match=f"answered with {what}; .* 2 real numbers"):
            kl.diagnose(arm, "gravity_torques", function)


@pytest.mark.parametrize("name", ["puma560", "scara"])
def test_differences_are_no_rounding_to_decimals(name: str) -> None:
    arm = kl.load(name)
    noise = np.random.default_rng(3)

    def shaken(q):
        return kl.gravity_torques(arm, q) + 4e-9 * noise.uniform(-1, 1, arm.n)

    found = kl.diagnose(arm, "gravity_torques", shaken, samples=20)
    assert "decimals" not in " ".join(found.remarks)


@pytest.mark.parametrize("seed", range(3))
def test_solutions_that_are_near_are_told_how_near(seed: int) -> None:
    arm = kl.load("planar2r")
    a, b = 0.5, 0.4
    rng = np.random.default_rng(seed)

    def elbow(x, y):
        q2 = np.arccos((x * x + y * y - a * a - b * b) / (2 * a * b))
        q1 = np.arctan2(y, x) - np.arctan2(b * np.sin(q2), a + b * np.cos(q2))
        return np.array([q1, q2]) + 3e-5 * rng.uniform(0.5, 1, 2)

    found = kl.diagnose(arm, "inverse_kinematics_xy", elbow)
    if not found.agrees:
        assert found.form == "near" and "of the target, relative" in found.proved[0]
