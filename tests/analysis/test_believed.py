"""Searches that are global, and answers that say what they rest on."""

from __future__ import annotations

from functools import cache

import numpy as np
import pinocchio as pin
import pytest

import kinlab as kl
from kinlab.analysis.singularities import minors
from kinlab.analysis.singularities.certified import nearest_zero
from kinlab.analysis.singularities.factor import Factor
from kinlab.analysis.singularities.nearest import slope_bound
from kinlab.analysis.structure.task_space import read_task

PI = np.pi


def arm(name, rows, lower=-PI, upper=PI, convention="standard", tool=None):
    links = [
        kl.DHLink("revolute", a=a, alpha=alpha, d=d, lower=lower, upper=upper)
        for a, alpha, d in rows
    ]
    frame = np.eye(4) if tool is None else tool
    return kl.Robot.from_dh(kl.DHTable(name, convention, links, tool=frame))


def wenger(r2=1.0, l2=2.0, l3=1.5):
    """Wenger's orthogonal 3R arm (d2 = 1)."""
    tool = np.eye(4)
    tool[0, 3] = l3
    rows = [(0.0, 0.0, 0.0), (1.0, -PI / 2, r2), (l2, PI / 2, 0.0)]
    return arm("wenger", rows, convention="modified", tool=tool)


def general_6r(seed):
    rng = np.random.default_rng(seed)
    rows = [
        (rng.uniform(0.05, 0.5), rng.uniform(0.3, 2.8), rng.uniform(-0.4, 0.4)) for _ in range(6)
    ]
    return arm(f"general{seed}", rows, -2.6, 2.6)


def srs(d=(0.36, 0.42, 0.40, 0.126)):
    h = PI / 2
    rows = [
        (0, -h, d[0]),
        (0, h, 0),
        (0, h, d[1]),
        (0, -h, 0),
        (0, -h, d[2]),
        (0, h, 0),
        (0, 0, d[3]),
    ]
    return arm("srs", rows, -2.6, 2.6)


def named(name):
    return {"wenger": wenger, "srs": srs}[name]() if name in ("wenger", "srs") else kl.load(name)


@cache
def searched(name):
    """The search on such an arm, which several tests read."""
    return kl.find_singularities(named(name))


def engine_ratio(robot, q, rows):
    data = robot.model.createData()
    jac = pin.computeFrameJacobian(
        robot.model, data, np.array(q), robot.tool, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    )
    sigma = np.linalg.svd(jac[list(rows)], compute_uv=False)
    return sigma[-1] / sigma[0]


# ---- nearest singularity


@pytest.mark.parametrize(
    ("name", "q", "truth"),
    [
        ("puma560", (-1.7708, 3.7527, -0.1528, 0.432, 1.0944, 0.955), 0.2643),
        ("ur5", (2.6191, 3.6336, 1.8799, -2.2332, 3.7277, -3.4516), 0.1205),
    ],
)
def test_poses_where_a_local_search_fails(name, q, truth):
    robot = kl.load(name)
    q = np.clip(q, robot.lower, robot.upper) if name == "ur5" else np.array(q)
    near = kl.nearest_singularity(robot, q)
    assert near.distance <= truth + 5e-5 and near.meets
    assert engine_ratio(robot, near.singularity.q, range(6)) <= 1e-10
    assert "proved" in str(near.evidence)


@pytest.mark.parametrize("seed", [1, 2])
def test_no_zero_of_the_determinant_inside_the_bound(seed):
    robot = general_6r(seed)
    rng = np.random.default_rng(seed)
    for q in rng.uniform(-2.5, 2.5, (3, 6)):
        near = kl.nearest_singularity(robot, q)
        assert near.bound <= near.distance and near.meets
        assert engine_ratio(robot, near.singularity.q, range(6)) <= 1e-10
        assert near.distance == pytest.approx(np.linalg.norm(near.singularity.q - q), abs=1e-12)
        # det J keeps its sign in the whole ball: independent of polynomials and boxes
        way = rng.normal(size=(4000, 6))
        way *= rng.uniform(0.0, 0.999, (4000, 1)) ** (1 / 4) / np.linalg.norm(way, axis=1)[:, None]
        ball = np.clip(q + near.bound * way, robot.lower, robot.upper)
        det = np.linalg.det(kl.jacobian(robot, np.vstack([q, ball])))
        assert np.all(det * det[0] > 0.0)


def test_the_distance_of_a_redundant_arm():
    robot = kl.load("panda")
    q = np.array([0.2, -0.6, 0.4, -1.9, 0.5, 1.4, 0.3])
    near = kl.nearest_singularity(robot, q, boxes=4000)
    assert 0.0 < near.bound <= near.distance
    search = searched("panda")
    assert near.distance <= min(np.linalg.norm(s.q - q) for s in search) + 1e-9


def test_an_arm_without_singularities_is_told():
    # a 2R arm that can neither stretch nor fold
    links = [kl.DHLink("revolute", a=1.0), kl.DHLink("revolute", a=0.7, lower=0.5, upper=2.5)]
    near = kl.nearest_singularity(
        kl.Robot.from_dh(kl.DHTable("bent", "standard", links)), [0.0, 1.0]
    )
    assert near.singularity is None and np.isinf(near.distance) and np.isinf(near.bound)
    assert "no configuration within the limits is singular" in near.evidence.proved


def test_few_boxes_give_a_weaker_bound_and_say_so():
    robot, q = general_6r(1), np.array([0.3, -0.4, 0.9, 1.3, -0.7, 0.2])
    little, much = (kl.nearest_singularity(robot, q, boxes=b) for b in (1, 12_000))
    assert little.bound <= much.bound <= much.distance <= little.distance + 1e-12
    assert much.meets


@pytest.mark.parametrize("robot", [general_6r(3), kl.load("stanford"), kl.load("panda"), wenger()])
def test_minors_are_enclosed_in_boxes(robot):
    space = read_task(robot, "auto")
    rng = np.random.default_rng(0)
    for factor in minors.factors(space):
        d = len(factor.joints)
        centre, half = rng.uniform(-2, 2, (60, d)), rng.uniform(0, 0.5, (60, d))
        over = factor.enclosures(centre, half)
        x = rng.uniform(-1, 1, (60, d)) * half
        value, _ = factor.values(centre + x)
        linear = over.value + np.einsum("nkd,nd->nk", over.gradient, x)
        square = linear + 0.5 * np.einsum("nkde,nd,ne->nk", over.hessian, x, x)
        assert np.all(np.abs(value - linear) <= over.rest)
        assert np.all(np.abs(value - square) <= over.second)


def test_factors_are_the_determinant():
    for name in ("puma560", "ur5", "stanford", "scara"):
        robot = kl.load(name)
        space = read_task(robot, "auto")
        q = np.random.default_rng(0).uniform(robot.lower, robot.upper, (50, robot.n))
        det = np.linalg.det(space.jacobian(q, space.scale))
        product = np.ones(len(q))
        for factor in minors.factors(space):
            assert factor.coefficients.shape[-1] == 1
            product *= factor.values(q[:, list(factor.joints)])[0][:, 0]
        ratio = det / product
        assert np.ptp(ratio) <= 1e-9 * np.abs(ratio).max()


def test_nearest_zero_of_a_known_function():
    # cos x + cos y - 1 = 0 from the origin: symmetric, at cos x = 1/2 on the diagonal
    coefficients = np.zeros((3, 3, 1))
    coefficients[1, 0], coefficients[0, 1], coefficients[0, 0] = 1.0, 1.0, -1.0
    factor = Factor((0, 1), (1, 1), (True, True), coefficients, 1)
    low, high = np.full(2, -PI), np.full(2, PI)
    zero = nearest_zero(factor, np.zeros(2), low, high, np.inf, 5000)
    angle = np.linspace(0.0, 0.5 * PI, 100_001)
    radius = np.linspace(1.4, 1.6, 4001)
    truth = np.sqrt(2.0) * PI / 3.0
    assert zero.distance == pytest.approx(truth, abs=1e-9) or zero.distance < truth
    on_axis = PI / 2.0  # cos y = 1: x = 90 degrees
    assert zero.distance <= min(truth, on_axis) + 1e-9
    far = zero.bound * 0.999
    assert np.all(np.cos(far * np.cos(angle)) + np.cos(far * np.sin(angle)) - 1.0 > 0.0)
    assert radius[0] < zero.distance < radius[-1]


def test_slope_bound_holds():
    rng = np.random.default_rng(2)
    for name in ("puma560", "stanford", "panda"):
        robot = kl.load(name)
        space = read_task(robot, "pose")
        q = rng.uniform(robot.lower, robot.upper, (300, robot.n))
        step = 1e-5 * rng.normal(size=q.shape)
        change = space.jacobian(q + step, space.scale) - space.jacobian(q, space.scale)
        size = np.linalg.norm(change, ord=2, axis=(1, 2)) / np.linalg.norm(step, axis=1)
        assert size.max() <= slope_bound(space)


# ---- families


@pytest.mark.parametrize("name", ["wenger", "ur5", "panda", "srs", "stanford"])
def test_families_stay_singular_when_their_free_joints_move_far(name):
    robot, search = named(name), searched(name)
    rng = np.random.default_rng(5)
    for family in search.families:
        first = family.representative
        free = [i for i, n in enumerate(robot.joint_names) if n not in family.deciding]
        q = np.repeat(first.q[None], 40, axis=0)
        q[:, free] = rng.uniform(robot.lower[free], robot.upper[free], (40, len(free)))
        assert max(engine_ratio(robot, one, first.rows) for one in q) < 1e-8
        assert family.evidence.proved and str(search.evidence).startswith("searched")


def test_one_sheet_is_one_family():
    families = searched("wenger").families
    assert [(f.deciding, f.pinned) for f in families] == [(("joint_2", "joint_3"), ())]
    shoulders = [f for f in searched("ur5").families if f.kind == "shoulder"]
    assert len(shoulders) == 1 and len(shoulders[0].deciding) == 3


def test_an_arm_with_spherical_shoulder_and_wrist():
    found = {
        (f.kind, f.deciding, tuple(np.round(np.abs(f.pinned), 6) + 0.0))
        for f in searched("srs").families
    }
    half = round(PI / 2, 6)
    assert found == {
        ("elbow", ("joint_4",), (0.0,)),
        ("shoulder", ("joint_2", "joint_3"), (0.0, half)),
        ("shoulder + wrist", ("joint_2", "joint_6"), (0.0, 0.0)),
        ("wrist", ("joint_5", "joint_6"), (half, 0.0)),
    }


# ---- the edge


def test_a_wrist_is_no_edge():
    for name in ("stanford", "puma560", "ur5"):
        wrists = [f for f in searched(name).families if f.kind == "wrist"]
        assert wrists and all(f.beyond is True for f in wrists)


def test_edges_that_are_known():
    three = kl.find_singularities(wenger(), "position")
    kinds = {m.kind for f in three.families for m in f.members}
    assert kinds == {"boundary", "interior"}  # outer boundary, and the curve with cusps inside
    stretched = searched("puma560").families
    assert {f.kind: f.beyond for f in stretched} == {
        "elbow": False, "shoulder": False, "wrist": True
    }  # fmt: skip
    assert all("second order" in str(f.evidence) for f in stretched if f.beyond is False)


# ---- isotropy


def test_the_best_pose_of_the_puma_does_not_hang_on_the_seed():
    robot = kl.load("puma560")
    found = [kl.find_isotropic(robot, seed=seed, seeds=200) for seed in (0, 1)]
    for one in found:
        # 3.16444 at L = 0.2832: from independent searches over q and L
        assert one.best_condition == pytest.approx(3.16444, abs=1e-5)
        assert one.best_length == pytest.approx(0.2832, abs=1e-4)
        assert one.evidence.met >= 5 and "95 % sure" in one.evidence.found


def test_more_effort_is_never_worse():
    robot = kl.load("ur5")
    few, more = (kl.find_isotropic(robot, seeds=n) for n in (20, 60))
    assert more.best_condition <= few.best_condition * (1.0 + 1e-12)


def test_dimension_of_a_family():
    planar = arm("planar4", [(a, 0.0, 0.0) for a in (0.3, 0.5, 0.4, 0.35)])
    assert {c.freedom for c in kl.find_isotropic(planar, "xy", seeds=120)} == {2}
    finger = arm("finger", [(0.0, PI / 2, 0.0), (0.4, 0.0, 0.0), (0.4 / np.sqrt(2), 0.0, 0.0)])
    found = kl.find_isotropic(finger, "position", seeds=120)
    assert len(found) == 4 and {c.freedom for c in found} == {1}


# ---- evidence everywhere


def test_every_search_says_what_it_rests_on():
    robot = kl.load("planar2r")
    answers = [
        kl.find_singularities(robot), kl.nearest_singularity(robot, [0.1, 1.0]),
        kl.find_isotropic(robot, seeds=40), kl.singular_loci(robot, [0, 1]),
        kl.planar_boundary(robot), kl.redundancy(robot, [0.1, 1.0]), kl.factored_determinant(robot),
        kl.design_isotropic(robot.table, free=["a2"], seeds=40),
    ]  # fmt: skip
    for answer in answers:
        sentence = str(answer.evidence)
        assert sentence.startswith("searched: ") and "proved: " in sentence
        assert sentence.endswith(".")
