"""Singular configurations, determinants, loci, distances."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pinocchio as pin
import pytest

import kinlab as kl
from kinlab.analysis.singularities.determinant import vanishing_factors
from kinlab.analysis.structure.task_space import read_task
from kinlab.errors import NameUnknownError, OptionError

ARMS = ("planar2r", "planar3r", "spatial3r", "scara", "stanford", "puma560", "puma560_modified",
        "ur5", "panda")  # fmt: skip


@cache
def searched(name):
    """The search on a shipped arm, which several tests read."""
    return kl.find_singularities(kl.load(name))


def engine_ratio(robot, q, rows):
    """sigma_min / sigma_max of Pinocchio's own frame Jacobian, in metres and radians."""
    data = robot.model.createData()
    jac = pin.computeFrameJacobian(
        robot.model, data, np.array(q), robot.tool, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    )
    sigma = np.linalg.svd(jac[list(rows)], compute_uv=False)
    return sigma[-1] / sigma[0]


@pytest.mark.parametrize("name", ARMS)
def test_every_configuration_is_singular_by_the_engine(name):
    robot = kl.load(name)
    search = searched(name)
    assert len(search) > 0 and search.suggested
    for found in search:
        assert engine_ratio(robot, found.q, found.rows) <= 1e-10
        assert np.all(found.q >= robot.lower - 1e-9) and np.all(found.q <= robot.upper + 1e-9)
        rows = kl.jacobian(robot, found.q)[list(found.rows)]
        rows[np.array(found.rows) < 3] /= found.length
        turns = np.linalg.norm(kl.jacobian(robot, found.q)[3:], axis=0) > 0.5
        rows[np.ix_(np.array(found.rows) < 3, ~turns)] *= found.length
        assert found.lost.shape == (len(found.rows), len(found.rows) - found.rank)
        assert np.abs(found.lost.T @ rows).max() < 1e-9  # no joint moves along the lost direction
        assert np.abs(rows @ found.internal).max() < 1e-9  # and the internal motion moves nothing


@pytest.mark.parametrize("name", ["planar2r", "planar3r", "scara", "stanford", "puma560",
                                  "puma560_modified", "ur5"])  # fmt: skip
def test_determinant_is_numeric_and_every_factor_is_hit(name):
    robot = kl.load(name)
    found = kl.factored_determinant(robot)
    assert found.complete and found.factors
    rows = list(read_task(robot, "auto").rows)
    q = np.random.default_rng(0).uniform(-3, 3, (1000, robot.n))
    numeric = np.linalg.det(kl.jacobian(robot, q)[:, rows])
    formula = np.array([found.at(state) for state in q])
    assert np.max(np.abs(formula - numeric)) <= 1e-12 * max(1.0, np.max(np.abs(numeric)))
    hit = {
        str(factor.expression)
        for state in searched(name)
        for factor in vanishing_factors(found, robot, state.q)
    }
    assert hit == {str(f.expression) for f in found.factors if f.within_limits}


def test_puma_factors_and_their_meaning():
    robot = kl.load("puma560")
    found = kl.factored_determinant(robot)
    assert {f.meaning: f.joints for f in found.factors} == {
        "shoulder": ("joint_2", "joint_3"), "elbow": ("joint_3",), "wrist": ("joint_5",)
    }  # fmt: skip
    families = searched("puma560").families
    assert {"wrist", "shoulder", "elbow"} <= {f.kind for f in families}
    wrist = next(f for f in families if f.kind == "wrist")
    assert wrist.deciding == ("joint_5",) and abs(wrist.pinned[0]) < 1e-9
    assert set(wrist.representative.joints) == {"joint_4", "joint_6"}
    # elbow, from the geometry: the wrist centre on the line through joints 2 and 3
    a3, d4 = robot.table.links[2].a, robot.table.links[3].d
    elbow = sorted(f.pinned[0] for f in families if f.kind == "elbow")
    assert np.allclose(np.tan(elbow), -d4 / a3, rtol=1e-9)


def test_ur5_has_wrist_shoulder_and_elbow():
    families = searched("ur5").families
    pinned = {(f.kind, round(abs(f.pinned[0]), 6)) for f in families if f.pinned}
    assert pinned == {("elbow", 0.0), ("elbow", 3.141593), ("wrist", 0.0), ("wrist", 3.141593)}
    assert any(f.kind == "shoulder" and not f.pinned for f in families)


def test_planar_arms_in_closed_form():
    two = searched("planar2r")
    assert sorted(round(abs(f.pinned[0]), 9) for f in two.families) == [0.0, round(np.pi, 9)]
    assert all(f.kind == "elbow" and f.beyond is False for f in two.families)
    radial = two.families[0].representative
    tip = kl.fk(kl.load("planar2r"), radial.q)[:2, 3]
    assert abs(radial.lost[:, 0] @ tip) == pytest.approx(np.linalg.norm(tip), rel=1e-12)
    redundant = kl.find_singularities(kl.load("planar3r"), "xy")
    values = {tuple(np.round(np.abs(f.pinned), 6)) for f in redundant.families}
    assert values == {(0.0, 0.0), (0.0, 3.141593), (3.141593, 0.0), (3.141593, 3.141593)}
    outer = next(f for f in redundant.families if np.allclose(f.pinned, 0.0))
    assert outer.kind == "boundary"
    assert {f.kind for f in redundant.families if f is not outer} == {"interior"}


def test_double_root_is_found():
    # Stanford's det J has the factor q3^2, where sigma_min touches zero without crossing it
    table = kl.load("stanford").table
    links = [
        replace(link, lower=-1.0, upper=1.0) if i == 2 else link
        for i, link in enumerate(table.links)
    ]
    robot = kl.Robot.from_dh(replace(table, links=tuple(links)))
    search = kl.find_singularities(robot)
    assert any(
        abs(found.q[2]) < 1e-5 and engine_ratio(robot, found.q, found.rows) <= 1e-10
        for found in search
    )


def test_same_seed_same_answer():
    robot = kl.load("puma560")
    one, two = (kl.find_singularities(robot, seed=3) for _ in range(2))
    assert len(one) == len(two)
    assert all(np.array_equal(a.q, b.q) for a, b in zip(one, two, strict=True))
    assert one.effort == two.effort and one.effort.last_new < one.effort.seeds


def test_describe_names_a_given_configuration():
    found = kl.describe_singularity(kl.load("puma560"), [0.3, -0.4, 0.5, 0.2, 0.0, 0.1])
    assert found.kind == "wrist" and found.rank == 5
    assert found.joints == ("joint_4", "joint_6")
    assert "rotation" in found.lost_direction


def test_nearest_on_arms_where_it_is_known():
    for name in ("planar2r", "planar3r"):
        robot = kl.load(name)
        q = np.array([0.4, -1.1, 0.6])[: robot.n]
        near = kl.nearest_singularity(robot, q)
        assert near.distance == pytest.approx(1.1, abs=1e-9)  # |q2| to sin q2 = 0
        assert np.allclose(near.singularity.q, np.where(np.arange(robot.n) == 1, 0.0, q), atol=1e-9)
    redundant = kl.nearest_singularity(kl.load("planar3r"), [0.4, -0.9, 0.5], "xy")
    assert redundant.distance == pytest.approx(np.hypot(0.9, 0.5), abs=1e-9)


def test_nearest_counts_turns_of_a_wide_joint():
    links = [kl.DHLink("revolute", a=a, lower=-7.0, upper=7.0) for a in (0.5, 0.4)]
    near = kl.nearest_singularity(
        kl.Robot.from_dh(kl.DHTable("two", "standard", links)), [0.3, 6.0]
    )
    assert near.distance == pytest.approx(2 * np.pi - 6.0, abs=1e-9)
    assert np.allclose(near.singularity.q, [0.3, 2 * np.pi], atol=1e-9)


def test_nearest_is_no_farther_than_a_dense_scan_of_the_factors():
    robot = kl.load("puma560")
    q = np.array([-0.21, 0.26, 0.714, 1.369, -0.647, 0.446])
    near = kl.nearest_singularity(robot, q)
    a2, a3 = robot.table.links[1].a, robot.table.links[2].a
    d4 = robot.table.links[3].d
    q2, q3 = np.meshgrid(np.linspace(-1.9, 1.9, 2001), np.linspace(-2.3, 2.3, 2001))
    shoulder = np.abs(a2 * np.cos(q2) + a3 * np.cos(q2 + q3) - d4 * np.sin(q2 + q3))
    scan = np.hypot(q2 - q[1], q3 - q[2])[shoulder < 1e-3].min()
    elbow = np.abs(np.arctan(-d4 / a3) + np.array([0.0, np.pi]) - q[2]).min()
    assert near.distance == pytest.approx(min(scan, elbow, abs(q[4])), abs=5e-3)
    assert engine_ratio(robot, near.singularity.q, range(6)) <= 1e-10


@pytest.mark.parametrize("joints", [[1, 2], [2, 4]])
def test_puma_loci_are_complete_and_exact(joints):
    robot = kl.load("puma560")
    held = np.array([0.3, 0.2, 0.4, 0.5, 0.6, 0.1])
    loci = kl.singular_loci(robot, joints, held)
    for curve in loci.curves:
        for q in curve.q[:: max(1, len(curve.q) // 40)]:
            assert engine_ratio(robot, q, range(6)) <= 1e-10
        assert np.all(curve.q[:, joints] >= robot.lower[joints] - 1e-9)
        assert np.all(curve.q[:, joints] <= robot.upper[joints] + 1e-9)
    # wherever the determinant changes sign along a grid line there is a curve close by
    points = np.concatenate([curve.q[:, joints] for curve in loci.curves])
    lines = [np.linspace(robot.lower[j], robot.upper[j], 61) for j in joints]
    grid = np.repeat(held[None], 61 * 61, axis=0)
    grid[:, joints] = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 2)
    sign = np.sign(np.linalg.det(kl.jacobian(robot, grid))).reshape(61, 61)
    crossings = np.argwhere(sign[:-1] * sign[1:] < 0)
    assert len(crossings) > 50
    for i, j in crossings:
        middle = np.array([0.5 * (lines[0][i] + lines[0][i + 1]), lines[1][j]])
        assert np.linalg.norm(points - middle, axis=1).min() < 0.08


def test_two_sheets_side_by_side_stay_two():
    # Puma, arm folded: a2 and hypot(a3, d4) differ by 2 mm, elbow and shoulder run 0.004 rad apart
    table = kl.load("puma560").table
    wide = [replace(link, lower=-1.95, upper=1.95) for link in table.links]
    wide[2] = replace(wide[2], lower=-2.3, upper=2.3)
    robot = kl.Robot.from_dh(replace(table, links=wide))
    loci = kl.singular_loci(robot, [1, 2], np.array([0.3, 0.2, 0.4, 0.5, 0.6, 0.1]))
    elbow = [c for c in loci.curves if np.ptp(c.q[:, 2]) < 1e-9]
    assert len(elbow) == 2
    assert all(np.ptp(c.q[:, 1]) > 3.8 for c in elbow)


def test_loci_of_a_redundant_arm_and_of_levels():
    three = kl.singular_loci(kl.load("planar3r"), [0, 1, 2], task="xy")
    assert len(three.curves) == 4 and all(c.closed for c in three.curves)
    assert all(np.abs(np.sin(c.q[:, 1:])).max() < 1e-9 for c in three.curves)
    levels = kl.singular_loci(kl.load("puma560"), ["joint_2", "joint_3", "joint_5"], levels=3)
    assert {round(float(c.q[0, 4]), 6) for c in levels.curves} == {-1.745329, 1.745329}


@pytest.mark.parametrize(
    ("joints", "error", "words"),
    [
        (["elbow", 1], NameUnknownError, ["'elbow'", "joint_1"]),
        ([0, 0], OptionError, ["named twice"]),
        ([0, 9], OptionError, ["0 to 5"]),
        ([0], OptionError, ["slices of 2"]),
        ("joint_1", OptionError, ["list"]),
    ],
)
def test_loci_bad_joints(joints, error, words):
    with pytest.raises(error) as caught:
        kl.singular_loci(kl.load("puma560"), joints)
    for word in words:
        assert word in str(caught.value)


def test_a_slice_that_is_all_singular_is_refused():
    with pytest.raises(OptionError, match="every configuration of the slice"):
        kl.singular_loci(kl.load("puma560"), [1, 2], np.zeros(6))


def test_links_of_one_length_have_a_sheet_that_is_a_double_zero():
    """det J = l^3 sin q3 (cos q2 + cos(q2 + q3)): at q3 = pi both factors vanish whatever q2 is."""
    half = np.pi / 2
    links = [kl.DHLink(alpha=half), kl.DHLink(a=0.16), kl.DHLink(a=0.16)]
    robot = kl.Robot.from_dh(kl.DHTable(name="equal", convention="standard", links=links))
    families = kl.find_singularities(robot, "position").families
    sheets = {f.deciding: [] for f in families}
    for f in families:
        sheets[f.deciding] += list(f.pinned)
    np.testing.assert_allclose(sorted(sheets[("joint_3",)]), [0.0, np.pi], atol=1e-9)
    assert sheets[("joint_2", "joint_3")] == []
    for q3, there in ((np.pi, 0.0), (3.0, np.pi - 3.0), (-3.0, np.pi - 3.0)):
        near = kl.nearest_singularity(robot, [0.3, 0.7, q3], "position")
        assert near.distance <= there + 1e-9 and near.bound <= near.distance


def test_limits_at_a_double_zero():
    """The limit -3.14159265 is 4e-9 short of the double zero at -pi: singular to every digit there,
    and no state a millionth away is taken for one."""
    robot = kl.load("erd:finger_edu")
    members = list(kl.find_singularities(robot))
    middle, last = robot.joint_names[1:]
    assert {s.deciding for s in members} == {(last,), (middle, last)}
    for s in members:
        assert s.ratio <= 1e-10
        assert np.all((s.q >= robot.lower) & (s.q <= robot.upper))
        if s.deciding == (last,):
            assert min(abs(s.q[2]), np.pi - abs(s.q[2])) < 1e-7
