"""How many solutions, where: against the quartic by hand and the published classes of 3R arms."""

import numpy as np
import pytest
from regional_arms import orthogonal, position, quartic_roots, surfaces

import kinlab as kl

WENGER = (1.0, 2.0, 1.5, 1.0)


@pytest.fixture(scope="module")
def chart():
    return kl.solution_map(orthogonal(*WENGER), cells=60)


def pose_at(rho, z):
    pose = np.eye(4)
    pose[[0, 2], 3] = rho, z
    return pose


def test_position_by_hand_is_the_arm():
    q = np.random.default_rng(1).uniform(-3, 3, (20, 3))
    here = kl.fk(orthogonal(*WENGER), q)[:, :3, 3]
    np.testing.assert_allclose(here, position(*WENGER, q), atol=1e-12)


def test_counts_are_those_of_the_quartic():
    rng = np.random.default_rng(2)
    points = np.column_stack([rng.uniform(0.05, 4.5, 300), rng.uniform(-3.4, 3.4, 300)])
    poses = np.array([pose_at(*p) for p in points])
    counts = kl.solution_count(orthogonal(*WENGER), poses)
    expected = [len(quartic_roots(*WENGER, *p)) for p in points]
    assert counts.count.tolist() == expected
    assert set(expected) == {0, 2, 4}
    assert counts.complete.all()
    assert len(counts) == 300


def test_one_pose_and_a_stack_agree():
    robot = kl.load("puma560")
    poses = kl.fk(robot, np.random.default_rng(3).uniform(-1, 1, (5, 6)))
    stack = kl.solution_count(robot, poses)
    for row, pose in enumerate(poses):
        one = kl.solution_count(robot, pose)
        assert int(one) == one.count == stack.count[row] == stack[row].count
        assert one.within_limits == stack.within_limits[row]
    assert (stack.within_limits <= stack.count).all()


def test_a_singular_pose_says_its_family():
    robot = kl.load("puma560")
    found = kl.solution_count(robot, kl.fk(robot, [0.3, 0.4, -1.0, 0.2, 0.0, 0.5]))
    assert not found.complete
    assert found.families


def test_bad_pose_is_refused():
    with pytest.raises(kl.KinlabError):
        kl.solution_count(kl.load("puma560"), np.diag([1.0, 1.0, -1.0, 1.0]))


def test_map_of_wengers_arm(chart):
    assert chart.kind == "quaternary"
    assert chart.generic is True
    assert len(chart.cusps) == 4
    assert len(chart.nodes) == 0
    assert set(np.unique(chart.count)) == {0, 2, 4}
    picked = np.random.default_rng(4).integers(0, chart.count.size, 200)
    for i, j in zip(*np.unravel_index(picked, chart.count.shape), strict=True):
        assert chart.count[i, j] == len(quartic_roots(*WENGER, chart.u[i], chart.v[j]))


def test_cusps_are_triple_roots(chart):
    """f, f' and f'' of the equation in q3 vanish together, f''' does not."""
    d2, d3, d4, r2 = WENGER
    for rho, z in chart.cusps:
        w = (rho**2 + z**2 - d2**2 - d3**2 - d4**2 - r2**2) / (2 * d2)
        m, n = d3 * d4 / d2, r2 * d4 / d2
        # coefficients of 1, cos, sin, cos 2x, sin 2x of the equation
        terms = [
            d3**2 - z**2 - w**2 + (d4**2 - m**2 - n**2) / 2, 2 * d3 * d4 + 2 * w * m, 2 * w * n,
            (d4**2 - m**2 + n**2) / 2, -m * n,
        ]  # fmt: skip

        def derivative(order, x, terms=terms):
            shift = order * np.pi / 2
            return (
                (terms[0] if order == 0 else 0.0)
                + terms[1] * np.cos(x + shift) + terms[2] * np.sin(x + shift)
                + 2**order * (terms[3] * np.cos(2 * x + shift) + terms[4] * np.sin(2 * x + shift))
            )  # fmt: skip

        x = np.linspace(-np.pi, np.pi, 20001)
        # the zero of f'' nearest to being one of f and f' too, by bisection
        second = derivative(2, x)
        best = np.inf
        for i in np.flatnonzero(np.sign(second[:-1]) != np.sign(second[1:])):
            low, high = x[i], x[i + 1]
            for _ in range(60):
                middle = 0.5 * (low + high)
                same = np.sign(derivative(2, middle)) == np.sign(derivative(2, low))
                low, high = (middle, high) if same else (low, middle)
            best = min(best, abs(derivative(0, low)) + abs(derivative(1, low)))
        assert best < 1e-9


@pytest.mark.parametrize(
    ("d3", "r2", "cusps"), [(2.0, 1.0, (0, 4, 2, 4)), (0.5, 0.3, (0, 4, 2, 0)),
                            (1.5, 0.5, (0, 4, 2, 4))]
)  # fmt: skip
def test_cusps_of_the_five_domains(d3, r2, cusps):
    """Baili, Wenger & Chablat: 0, 4, 2 cusps, then 4 for d3 > 1 and 0 for d3 < 1."""
    edges = surfaces(d3, r2)
    tried = [
        (0.98 * edges[0], 0), (1.02 * edges[0], 1), (0.98 * edges[1], 1), (1.02 * edges[1], 2),
        (0.98 * edges[2], 2), (1.02 * edges[2], 3),
    ]  # fmt: skip
    for d4, domain in tried:
        chart = kl.solution_map(orthogonal(1.0, d3, d4, r2), cells=4)
        assert len(chart.cusps) == cusps[domain], (d4, domain)


def test_a_binary_arm():
    chart = kl.solution_map(orthogonal(1.0, 2.0, 0.15, 1.0), cells=60)
    assert chart.kind == "binary"
    assert chart.count.max() == 2
    assert len(chart.cusps) == 0


def test_arms_whose_axes_cross_have_no_false_nodes():
    """r2 = 0: the images of two curves lie on one another, which is no node."""
    chart = kl.solution_map(orthogonal(1.0, 2.0, 1.5, 0.0), cells=4)
    assert len(chart.nodes) < 10
    assert chart.generic is False


def test_planar_maps_are_rings():
    robot = kl.load("planar2r")
    chart = kl.solution_map(robot, cells=50)
    ends = kl.fk(robot, np.array([[0.0, 0.0], [0.0, np.pi]]))[:, :2, 3]
    outer, inner = np.linalg.norm(ends, axis=1)
    x, y = np.meshgrid(chart.u, chart.v, indexing="ij")
    radius = np.hypot(x, y)
    clear = (np.abs(radius - outer) > 1e-9) & (np.abs(radius - inner) > 1e-9)
    expected = np.where((radius < outer) & (radius > inner), 2, 0)
    assert (chart.count == expected)[clear].all()


def test_other_arms_have_no_map():
    with pytest.raises(kl.KinlabError, match="solution_count"):
        kl.solution_map(kl.load("puma560"))
