"""Loci, workspace, free room, isotropy and stiffness of the five-bar."""

from __future__ import annotations

import numpy as np
import pytest
from fivebars import MODES, bars, random_fivebar, random_state
from hypothesis import given
from hypothesis import strategies as st

import kinlab as kl
from kinlab.errors import MechanismError, OptionError, StructureError
from kinlab.fivebar.workspace import Rectangle

LINKAGES = {
    "isotropic": kl.FiveBar.load("isotropic"),
    "unequal": kl.FiveBar.load("unequal"),
    "equal_links": kl.FiveBar.load("equal_links"),
    "coaxial": kl.FiveBar((0.10, 0.12), (0.20, 0.17), 0.0),
    "wide": kl.FiveBar((0.2, 0.3), (0.3, 0.25), 0.3),
}


def legs_and_rods(fivebar, xy, mode):
    return bars(fivebar, fivebar.ik(xy, mode), xy)


def test_metrics_against_svd_and_plain_geometry():
    rng = np.random.default_rng(0)
    for _ in range(100):
        fivebar = random_fivebar(rng)
        xy, mode, _ = random_state(fivebar, rng)
        jac = fivebar.jacobian(xy, mode)
        sigma = np.linalg.svd(jac, compute_uv=False)
        np.testing.assert_allclose(fivebar.singular_values(xy, mode), sigma, rtol=1e-12)
        np.testing.assert_allclose(
            fivebar.condition_number(xy, mode), sigma[0] / sigma[1], rtol=1e-11
        )
        np.testing.assert_allclose(fivebar.determinant(xy, mode), np.linalg.det(jac), rtol=1e-11)
        legs, rods = legs_and_rods(fivebar, xy, mode)
        psi = fivebar.passive_angles(xy, mode)
        np.testing.assert_allclose(np.sin(psi), legs, atol=1e-13)
        np.testing.assert_allclose(np.cos(fivebar.pressure_angles(xy, mode)), abs(legs), atol=1e-9)
        gamma = fivebar.transmission_angle(xy, mode)
        assert 0 <= gamma <= np.pi and abs(np.sin(gamma) - abs(rods)) < 1e-12
        k = rng.uniform(1, 10, 2)
        np.testing.assert_allclose(
            fivebar.stiffness(xy, k, mode), jac.T @ np.diag(k) @ jac, rtol=1e-12, atol=1e-12
        )


def test_condition_on_the_axis_follows_from_the_transmission_angle():
    fivebar = LINKAGES["isotropic"]
    xy = np.array([[0.0, -0.45], [0.0, -0.6], [0.0, -0.7]])
    half = 0.5 * fivebar.transmission_angle(xy)
    expected = np.maximum(np.tan(half), 1 / np.tan(half))
    np.testing.assert_allclose(fivebar.condition_number(xy), expected, rtol=1e-12)


@pytest.mark.parametrize("name", LINKAGES)
def test_type_two_curve_by_formula(name):
    """Every point closes with its rods in line, and the sextic of its kind vanishes there."""
    fivebar = LINKAGES[name]
    for locus in fivebar.type_two(samples=200):
        assert np.abs(fivebar.type_two_polynomial(locus.points, locus.kind)).max() < 1e-13
        for mode in MODES:
            ours = np.all(locus.modes == np.array(mode), axis=1)
            points = locus.points[ours & fivebar.reachable(locus.points)]
            for xy in points[:: max(1, len(points) // 20)]:
                legs, rods = legs_and_rods(fivebar, xy, mode)
                if np.abs(legs).min() > 1e-3:
                    assert abs(rods) < 1e-9


def test_type_two_curve_is_complete():
    """Wherever w1 x w2 changes its sign between neighbours of a grid, the curve passes."""
    for name in ("isotropic", "unequal", "equal_links", "wide"):
        fivebar = LINKAGES[name]
        for mode in MODES:
            grid = fivebar.workspace_map(mode, 121)
            step = grid.x[1] - grid.x[0]
            sign = np.sign(np.ma.filled(grid.rods, 0.0))
            changes = np.argwhere(sign[:, 1:] * sign[:, :-1] < 0)
            curve = np.concatenate([l.points for l in fivebar.type_two()])
            for row, column in changes[::7]:
                at = np.array([grid.x[column] + 0.5 * step, grid.y[row]])
                gap = np.linalg.norm(curve - at, axis=1).min()
                assert gap < 1.01 * step, (name, mode, at)


def test_contour_lies_on_the_curve():
    fivebar = LINKAGES["unequal"]
    curve = np.concatenate([locus.points for locus in fivebar.type_two()])
    found = 0
    for mode in MODES:
        for line in fivebar.type_two_contour(mode, 300):
            line = line[fivebar.reachable(line)]
            away = fivebar.singularity_distances(line, mode)
            clear = np.minimum(away.outer, away.inner).min(axis=1) > 0.02
            for point in line[clear][::10]:
                found += 1
                assert np.linalg.norm(curve - point, axis=1).min() < 2e-3
    assert found > 20


def test_type_one_circles_are_the_edges():
    for fivebar in LINKAGES.values():
        for leg, (inner, outer) in enumerate(fivebar.type_one()):
            for circle in (inner, outer):
                phi = np.linspace(0, 2 * np.pi, 400)
                way = np.stack([np.cos(phi), np.sin(phi)], axis=1)
                points = np.array(circle.centre) + circle.radius * way
                for xy in points[fivebar.reachable(points)]:
                    assert abs(legs_and_rods(fivebar, xy, (1, 1))[0][leg]) < 1e-6


@given(st.integers(0, 10**6))
def test_reachable_area_is_that_of_the_points(seed):
    rng = np.random.default_rng(seed)
    fivebar = random_fivebar(rng)
    reach = float(np.max(fivebar.l1 + fivebar.l2) + fivebar.e)
    points = rng.uniform(-reach, reach, (20000, 2))
    share = fivebar.reachable(points).mean()
    noise = np.sqrt(share * (1 - share) / 20000) + 1e-4
    assert abs(share * (2 * reach) ** 2 - fivebar.reachable_area()) < 6 * noise * (2 * reach) ** 2


@pytest.mark.parametrize(("mode", "assembly"), [((-1, 1), 1), ((1, 1), 1), ((-1, -1), -1)])
@pytest.mark.parametrize("name", ["isotropic", "unequal", "equal_links", "wide"])
def test_largest_circle_and_rectangle_are_free_and_large(name, mode, assembly):
    fivebar = LINKAGES[name]
    circle = fivebar.largest_circle(mode, assembly, resolution=61)
    box = fivebar.largest_rectangle(mode, assembly, resolution=61)
    rng = np.random.default_rng(1)
    phi, r = rng.uniform(0, 2 * np.pi, 3000), circle.radius * np.sqrt(rng.uniform(0, 1, 3000))
    disc = np.array(circle.centre) + 0.999 * r[:, None] * np.stack(
        [np.cos(phi), np.sin(phi)], axis=1
    )
    inside = np.stack([rng.uniform(box.x_min, box.x_max, 3000),
                       rng.uniform(box.y_min, box.y_max, 3000)], axis=1)  # fmt: skip
    for points in (disc, inside):
        theta = fivebar.ik(points, mode)
        for k in range(0, 3000, 50):
            legs, rods = bars(fivebar, theta[k], points[k])
            assert np.sign(rods) == assembly and tuple(np.sign(legs)) == mode
    # no random circle of the same room is larger
    free = fivebar.free_region(mode, assembly)
    reach = np.max(fivebar.l1 + fivebar.l2)
    anywhere = free.clearance(rng.uniform(-reach, reach, (4000, 2)))
    assert anywhere.max() <= circle.radius + 1e-6
    assert box.area > 0.5 * 2 * circle.radius**2  # the square in the circle is free as well
    grown = Rectangle(box.x_min - 1e-3, box.x_max + 1e-3, box.y_min - 1e-3, box.y_max + 1e-3)
    assert free.contains_rectangle(box) and not free.contains_rectangle(grown)


def test_rectangle_with_a_bound_on_the_condition_number():
    fivebar = LINKAGES["isotropic"]
    box = fivebar.largest_rectangle(max_condition=2.0)
    x, y = np.meshgrid(np.linspace(*box[:2], 30), np.linspace(*box[2:], 30))
    kappa = fivebar.condition_number(np.stack([x.ravel(), y.ravel()], axis=1))
    assert kappa.max() < 2.02
    assert box.area < fivebar.largest_rectangle().area
    with pytest.raises(StructureError, match="no free place"):
        fivebar.largest_rectangle(max_condition=0.5)


def test_signed_distances():
    fivebar = LINKAGES["equal_links"]
    stretched = np.array([0.0, np.sqrt(0.09**2 - 0.031**2)])  # rods along x
    up = np.array([0.0, 1e-3])
    above, below = stretched + up, stretched - up
    mode = (1, -1)
    far, near = (
        fivebar.singularity_distances(above, mode),
        fivebar.singularity_distances(below, mode),
    )
    assert np.sign(far.rods) == -np.sign(near.rods) != 0
    assert np.sign(far.type_two) == np.sign(far.rods)
    assert abs(abs(far.type_two) - 1e-3) < 1e-4 and abs(abs(near.type_two) - 1e-3) < 1e-4
    d = np.linalg.norm(below - [0.059, 0.0])
    np.testing.assert_allclose(near.outer[0], 0.18 - d, atol=1e-15)
    np.testing.assert_allclose(near.inner[0], d, atol=1e-15)


def test_classify():
    fivebar = LINKAGES["equal_links"]
    stretched = [0.0, np.sqrt(0.09**2 - 0.031**2)]
    edge = [0.059 + 0.18 * np.cos(2.0), 0.18 * np.sin(2.0)]
    kinds = fivebar.classify([stretched, edge, [0.0, 0.1], [0.0, 1.0]], (1, -1))
    assert kinds == ["II", "I", "regular", "out of reach"]
    coaxial = kl.FiveBar(0.1, 0.2, 0.0)
    assert coaxial.classify([0.0, -0.3]) == ["III"]
    with pytest.raises(OptionError, match="sine"):
        fivebar.classify([0, 0.1], sine=2.0)


@pytest.mark.parametrize("size", [(0.3, 0.5), (0.1, 0.35), (0.2, 0.21)])
def test_fully_isotropic_pose(size):
    l1, l2 = size
    fivebar = kl.FiveBar(l1, l2, (l2 - l1) / np.sqrt(2))
    found = [p for p in fivebar.isotropic_poses() if max(p.pressure) < 1e-6]
    assert len(found) == 1
    # not from kappa: it is flat in x here, and its rounding leaves x open by some 1e-6
    assert abs(found[0].xy[0]) < 1e-12
    assert abs(found[0].xy[1] + (l1 + l2) / np.sqrt(2)) < 1e-12
    assert abs(found[0].condition - 1) < 1e-12
    assert abs(found[0].rate - 1 / l1) < 1e-9


def test_isotropic_poses_are_all_found_on_a_fine_map():
    """Every place of a fine map where kappa falls below 1.02 is near a reported pose."""
    for name in ("unequal", "equal_links", "wide"):
        fivebar = LINKAGES[name]
        for mode in MODES:
            found = np.array([p.xy for p in fivebar.isotropic_poses(mode)]).reshape(-1, 2)
            for place in found:
                assert abs(fivebar.condition_number(place, mode) - 1.0) < 1e-9
            grid = fivebar.workspace_map(mode, 201)
            rows = np.argwhere(np.ma.filled(grid.condition, np.inf) < 1.02)
            for row, column in rows:
                at = np.array([grid.x[column], grid.y[row]])
                assert len(found) and np.linalg.norm(found - at, axis=1).min() < 0.05, (name, mode)


def test_isotropic_poses_of_a_coaxial_linkage_are_circles():
    fivebar = kl.FiveBar(0.15, 0.2, 0.0)
    poses = fivebar.isotropic_poses()
    assert len(poses) == 2
    for pose in poses:
        assert pose.xy[0] == 0.0 and pose.xy[1] < 0
        turned = np.hypot(*pose.xy) * np.array([np.cos(0.7), np.sin(0.7)])
        assert abs(fivebar.condition_number(turned) - 1) < 1e-9
    assert kl.FiveBar.load("minitaur_leg").isotropic_poses() == []


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda f: f.type_two_polynomial([0, 0], "flat"), OptionError, "kind 'flat'"),
        (lambda f: f.type_two(2), OptionError, "at least 8"),
        (lambda f: f.workspace_map(resolution=3), OptionError, "at least 8"),
        (lambda f: f.free_region(assembly=0), OptionError, "assembly 0"),
        (lambda f: f.stiffness([0, -0.5], -1.0), OptionError, "positive"),
        (lambda f: kl.FiveBar(0.1, 0.2, 0.0).largest_circle((1, 1)), StructureError, "no free"),
        (lambda f: kl.FiveBar(0.1, 0.1, 0.2), MechanismError, "cannot close"),
    ],
)
def test_bad_input(call, error, message):
    with pytest.raises(error, match=message):
        call(LINKAGES["isotropic"])
