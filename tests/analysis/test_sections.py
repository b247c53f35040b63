"""Sections of spatial workspaces, against counts of solutions by brute force."""

from __future__ import annotations

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import OptionError
from kinlab.plots.maps import workspace_map

PI = np.pi


def orthogonal(d2=1.0, d3=2.0, d4=1.5, r2=1.0):
    """Wenger's orthogonal 3R arm; by default the one with four cusps inside."""
    tool = np.eye(4)
    tool[0, 3] = d4
    rows = [(0.0, 0.0, 0.0), (d2, -PI / 2, r2), (d3, PI / 2, 0.0)]
    links = [kl.DHLink("revolute", a=a, alpha=alpha, d=d) for a, alpha, d in rows]
    return kl.Robot.from_dh(kl.DHTable("orthogonal", "modified", links, tool=tool))


def closed_form(q2, q3, d2=1.0, d3=2.0, d4=1.5, r2=1.0):
    """(rho, z) of that arm, written down from its drawing."""
    u = d3 + d4 * np.cos(q3)
    x, y = d2 + u * np.cos(q2), r2 + d4 * np.sin(q3)
    return np.hypot(x, y), -u * np.sin(q2)


def solutions(rho, z, d2=1.0, d3=2.0, d4=1.5, r2=1.0):
    """How many (q2, q3) reach (rho, z): with u cos q2 = w and u sin q2 = -z the distance gives w as
    a function of q3, and w^2 + z^2 = u^2 is left; its sign changes round the circle count."""
    q3 = np.linspace(-PI, PI, 40_001)
    u, y = d3 + d4 * np.cos(q3), r2 + d4 * np.sin(q3)
    w = (rho**2 - y**2 - u**2 + z**2 - d2**2) / (2.0 * d2)
    return int(np.sum(np.diff(np.sign(w**2 + z**2 - u**2)) != 0))


@pytest.fixture(scope="module")
def section():
    return kl.workspace_section(orthogonal())


def test_the_closed_form_of_the_test_is_this_arm(section):
    q = np.random.default_rng(0).uniform(-PI, PI, (50, 3))
    rho, z = closed_form(q[:, 1], q[:, 2])
    points = section.project(kl.fk(orthogonal(), q)[:, :3, 3])
    assert np.allclose(points[:, 0], rho, atol=1e-12)
    assert np.allclose(np.abs(points[:, 1]), np.abs(z), atol=1e-12)


def test_solutions_change_across_every_curve(section):
    assert len(section.curves) == 3 and all(not c.locked for c in section.curves)
    inner = 0
    for curve in section.curves:
        points = curve.points
        assert np.allclose(points, section.project(kl.fk(orthogonal(), curve.q)[:, :3, 3]))
        for k in range(3, len(points) - 3, 7):
            tangent = points[k + 1] - points[k - 1]
            if np.linalg.norm(tangent) < 0.03:  # close to a cusp
                continue
            normal = np.array([-tangent[1], tangent[0]]) / np.linalg.norm(tangent)
            one, two = (solutions(*(points[k] + s * 1e-3 * normal)) for s in (1, -1))
            assert abs(one - two) == 2
            assert curve.edge[k] == (min(one, two) == 0)
            inner += min(one, two) == 2
    assert inner > 10


def test_four_cusps_inside(section):
    inside = [c for c in section.curves if not c.edge.any()]
    assert len(inside) == 1
    step = np.diff(np.vstack([inside[0].points, inside[0].points[1:3]]), axis=0)
    step = step[np.linalg.norm(step, axis=1) > 1e-9]
    step /= np.linalg.norm(step, axis=1)[:, None]
    turned = np.einsum("ki,ki->k", step[:-2], step[2:])  # over one point: a cusp may lie on one
    cusps = np.flatnonzero(turned < -0.5)
    groups = 1 + int(np.sum(np.diff(cusps) > 3))
    assert groups == 4


def test_limits_and_a_void():
    puma = kl.workspace_section(kl.load("puma560"))
    assert puma.joints == ("joint_2", "joint_3")
    assert any(c.locked for c in puma.curves) and any(not c.locked for c in puma.curves)
    d3 = abs(kl.load("puma560").table.links[2].d)
    # the shoulder keeps the wrist centre off axis 1 by d3 wherever the limits let it come there
    least = min(c.points[c.edge, 0].min() for c in puma.curves if c.edge.any())
    assert least == pytest.approx(d3, abs=2e-3)
    q = np.random.default_rng(1).uniform(
        kl.load("puma560").lower, kl.load("puma560").upper, (50_000, 6)
    )
    samples = puma.project(kl.fk(kl.load("puma560"), q)[:, :3, 3])
    edge = np.concatenate([c.points[c.edge] for c in puma.curves])
    assert samples[:, 0].max() <= edge[:, 0].max() + 1e-3
    assert samples[:, 1].max() <= edge[:, 1].max() + 1e-3
    assert "other curve" in str(puma.evidence)


def test_the_picture_has_the_curves(section):
    chart = kl.sample_workspace(orthogonal(), "position", samples=500)
    axes = workspace_map(chart, section=section)
    drawn = [line.get_xydata() for line in axes.get_lines()]
    assert len(drawn) >= 2 * len(section.curves)


@pytest.mark.parametrize(
    ("name", "words"), [("planar2r", "revolute first joint"), ("planar3r", "one line")]
)
def test_other_arms(name, words):
    with pytest.raises(OptionError, match=words):
        kl.workspace_section(kl.load(name))
