"""What sweeps are for: maps, searches, benchmarks of solvers, scans of designs."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl


def solved(robot, q):
    """IK on the poses of random states: success and how far the answer's pose is off."""
    targets = kl.fk(robot, q)
    answer = kl.ik_batch(robot, targets)
    return {"success": answer.success, "off": answer.position_error}


def crank(_, x):
    """Designs (l1, l2, e) of a five-bar: condition of its Jacobian at one point of the plane."""
    point = np.array([0.0, -0.7])
    out = np.full(len(x), np.inf)
    for i, (l1, l2, e) in enumerate(x):
        if abs(l1 - l2) < np.hypot(e, 0.7) < l1 + l2:  # both legs reach the point
            out[i] = np.linalg.cond(kl.FiveBar(l1, l2, e).jacobian(point))
    return {"condition": out}


def test_a_map_is_the_union_of_its_parts():
    robot = kl.Robot.from_dh(kl.DHTable("2R", "standard", [kl.DHLink(a=0.6), kl.DHLink(a=0.4)]))
    result = kl.sweep(robot, ("position", "singular_values"), 20_000, workers=1)
    reach = np.linalg.norm(result["position"], axis=1)
    assert reach.min() == pytest.approx(0.2, abs=1e-4)  # l1 - l2
    assert reach.max() == pytest.approx(1.0, abs=1e-4)
    parts = [columns["position"] for _, columns in result.chunks()]
    assert np.array_equal(np.concatenate(parts), result["position"])


def test_a_singularity_search_ends_at_the_wrist_or_the_elbow():
    """Of 20,000 random states of a Puma the least singular one has sin(q5) or its elbow near 0."""
    robot = kl.load("puma560")
    q, values = kl.sweep(robot, "min_singular", 20_000, workers=1).best("min_singular", 3)
    assert (np.diff(values) >= 0).all() and values[0] < 1e-3
    sigma = np.linalg.svd(kl.jacobian(robot, q), compute_uv=False)
    assert sigma[:, -1] == pytest.approx(values, abs=1e-12)


def test_an_isotropy_search_comes_near_the_textbook_pose():
    """2R with l1 = sqrt(2) l2 is isotropic at q2 = +-135 degrees (note 000, 000.iso2r)."""
    links = [kl.DHLink(a=np.sqrt(2.0)), kl.DHLink(a=1.0)]
    robot = kl.Robot.from_dh(kl.DHTable("isotropic", "standard", links))
    result = kl.sweep(robot, plane_condition, 50_000, workers=1)
    (best,), (value,) = result.best("value")
    assert value < 1.001
    assert abs(best[1]) == pytest.approx(np.deg2rad(135), abs=1e-2)


def plane_condition(robot, q):
    """Condition of the rows of x and y."""
    return np.linalg.cond(kl.jacobian(robot, q)[:, :2])


def test_a_benchmark_of_inverse_kinematics():
    result = kl.sweep(kl.load("ur5"), solved, 2000, workers=1)
    assert result["success"].mean() >= 0.999
    assert result["off"][result["success"]].max() <= 1e-6


def test_a_scan_of_five_bar_designs_finds_the_isotropic_family():
    """On the axis at y the pose is isotropic where the rods are square and cranks fit them."""
    low, high = [0.2, 0.4, 0.01], [0.5, 0.9, 0.3]
    result = kl.sweep(None, crank, 3000, lower=low, upper=high, workers=1)
    designs, values = result.best("condition", 5)
    assert values[0] < 1.05
    for (l1, l2, e), value in zip(designs, values, strict=True):
        rods = rod_angle(l1, l2, e)
        assert value == pytest.approx(max(np.tan(rods / 2), 1 / np.tan(rods / 2)), rel=1e-9)


def rod_angle(l1, l2, e):
    """Angle between the rods at (0, -0.7), from the drawing: elbows by intersecting circles."""
    across = np.hypot(e, 0.7)
    along = (l1**2 - l2**2 + across**2) / (2 * across)
    out = np.sqrt(l1**2 - along**2)
    way = np.array([-e, -0.7]) / across  # from the right pin to the point
    arms = [np.array([e, 0]) + along * way + s * out * np.array([-way[1], way[0]]) for s in (1, -1)]
    elbow = max(arms, key=lambda p: p[0])  # both elbows outward
    return 2 * np.arctan2(elbow[0], elbow[1] + 0.7)


@pytest.mark.parametrize("name", ["planar2r", "spatial3r", "ur5"])
def test_named_measures_are_of_the_task_that_suits_the_arm(name):
    result = kl.sweep(name, ("condition", "min_singular"), 30, workers=1, progress=False)
    for q, condition, least in zip(
        result.states, result["condition"], result["min_singular"], strict=True
    ):
        found = kl.dexterity(name, q)
        assert condition == pytest.approx(found.condition, rel=1e-9)
        assert least == pytest.approx(found.min_singular, rel=1e-9)
