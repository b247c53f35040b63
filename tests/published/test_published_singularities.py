"""Singularities and inverse solutions of the literature."""

from __future__ import annotations

import numpy as np
import pytest
from literature_arms import (
    HALF,
    anthropomorphic,
    distinct_solutions,
    hand_jacobian,
    manseur_doty,
    orthogonal,
    planar,
    ratio,
    spherical_arm,
    spherical_wrist,
    srs,
    wrap,
)  # fmt: skip

import kinlab as kl


def moves_on_the_set(robot: kl.Robot, family: object, rows: list[int], count: int = 80) -> bool:
    """Whether a family's free joints, moved far and together, stay on sigma_min = 0."""
    rng = np.random.default_rng(11)
    names = list(robot.model.names)[1:]
    deciding = [names.index(d) for d in family.deciding]  # type: ignore[attr-defined]
    free = [j for j in range(robot.n) if j not in deciding]
    if not deciding:
        return False
    for member in list(family.members)[:3]:  # type: ignore[attr-defined]
        for _ in range(count):
            q = np.array(member.q, float)
            q[free] = rng.uniform(robot.lower[free], robot.upper[free])
            if ratio(hand_jacobian(robot, q)[rows]) > 1e-8:
                return False
    return True


def deciding_sets(found: object, robot: kl.Robot) -> set[tuple[int, ...]]:
    """Deciding joints of every family, numbered from 1."""
    names = list(robot.model.names)[1:]
    return {tuple(sorted(names.index(d) + 1 for d in f.deciding)) for f in found.families}  # type: ignore[attr-defined]


# ---------------------------------------------------------------- determinants
def test_craig_two_link_determinant() -> None:
    """Craig, Introduction to Robotics, section 5.8 (example 5.4): det J = l1 l2 s2, zero at 0 and 180 deg."""
    l1, l2 = 0.5, 0.3
    robot = planar(l1, l2)
    for q2 in (-2.0, -0.5, 0.1, 1.0, 3.0):
        J = kl.jacobian(robot, [0.4, q2])[:2]
        assert np.linalg.det(J) == pytest.approx(l1 * l2 * np.sin(q2), abs=1e-14)
    found = kl.find_singularities(robot, "xy")
    values = {round(abs(float(f.pinned[0])), 6) for f in found.families}
    assert values == {0.0, round(np.pi, 6)}
    assert deciding_sets(found, robot) == {(2,)}


def test_siciliano_anthropomorphic_determinant() -> None:
    """Siciliano et al., Robotics: Modelling, Planning and Control, section 3.3.2 (arm singularities):
    det J_P = -a2 a3 s3 (a2 c2 + a3 c23); elbow singularity s3 = 0, shoulder singularity
    a2 c2 + a3 c23 = 0.
    """
    a2, a3 = 0.5, 0.4
    robot = anthropomorphic(a2, a3)
    rng = np.random.default_rng(0)
    for q in rng.uniform(-np.pi, np.pi, (20, 3)):
        want = -a2 * a3 * np.sin(q[2]) * (a2 * np.cos(q[1]) + a3 * np.cos(q[1] + q[2]))
        assert np.linalg.det(kl.jacobian(robot, q)[:3]) == pytest.approx(want, abs=1e-13)
    found = kl.find_singularities(robot, "position")
    assert deciding_sets(found, robot) == {(3,), (2, 3)}
    assert all(moves_on_the_set(robot, f, [0, 1, 2]) for f in found.families)


def test_siciliano_spherical_arm_determinant() -> None:
    """Siciliano et al., section 3.3 with the spherical arm of 2.9.3: det J_P = +-d3^2 s2 whatever d2."""
    for d2 in (0.0, 0.15):
        robot = spherical_arm(d2)
        rng = np.random.default_rng(1)
        for q in rng.uniform(robot.lower, robot.upper, (20, 3)):
            det = np.linalg.det(kl.jacobian(robot, q)[:3])
            assert abs(det) == pytest.approx(q[2] ** 2 * abs(np.sin(q[1])), abs=1e-13)
    found = kl.find_singularities(spherical_arm(), "position")
    assert {(2,), (3,)} <= deciding_sets(found, spherical_arm())
    assert all(moves_on_the_set(spherical_arm(), f, [0, 1, 2]) for f in found.families)


def test_siciliano_wrist_singularity() -> None:
    """Siciliano et al., section 3.3.1: a spherical wrist is singular where theta5 = 0 or pi."""
    found = kl.find_singularities(spherical_wrist(), "orientation")
    assert deciding_sets(found, spherical_wrist()) == {(2,)}
    assert {round(abs(float(f.pinned[0])), 6) for f in found.families} == {0.0, round(np.pi, 6)}


def test_yoshikawa_manipulability_of_two_links() -> None:
    """Yoshikawa 1985 (Manipulability of robotic mechanisms, IJRR 4(2)): w = l1 l2 |s2|, greatest at
    +-90 deg whatever l1 and l2; for a given l1 + l2 at l1 = l2.
    """
    l1, l2 = 0.5, 0.3
    robot = planar(l1, l2)
    q2 = np.linspace(-3, 3, 61)
    q = np.stack([np.full_like(q2, 0.7), q2], axis=1)
    w = kl.manipulability(robot, q, "yoshikawa", "xy")
    assert np.allclose(w, l1 * l2 * np.abs(np.sin(q2)), atol=1e-14)
    best = kl.manipulability(robot, [0.0, HALF], "yoshikawa", "xy")
    assert best == pytest.approx(l1 * l2, abs=1e-14)
    assert best >= w.max()
    tries = [
        kl.manipulability(planar(x, 1 - x), [0.0, HALF], "yoshikawa", "xy")
        for x in (0.3, 0.4, 0.5, 0.6)
    ]
    assert int(np.argmax(tries)) == 2


def test_wenger_determinant() -> None:
    """Wenger, Chablat and Baili 2005 (J. Mech. Des. 127, pp. 150-155), r3 = 0:
    det J = d4 (d3 + c3 d4)(s3 d2 + c2 (s3 d3 - c3 r2)).
    """
    d2, d3, d4, r2 = 1.0, 2.0, 1.5, 1.0
    robot = orthogonal(d2, d3, d4, r2, 0.0)
    rng = np.random.default_rng(2)
    for q in rng.uniform(-np.pi, np.pi, (30, 3)):
        (s3, c3), c2 = (np.sin(q[2]), np.cos(q[2])), np.cos(q[1])
        want = d4 * (d3 + c3 * d4) * (s3 * d2 + c2 * (s3 * d3 - c3 * r2))
        assert np.linalg.det(kl.jacobian(robot, q)[:3]) == pytest.approx(want, abs=1e-12)


# ---------------------------------------------------------------- Wenger's arms
def test_wenger_four_solutions() -> None:
    """The cuspidal arm d2 = 1, d3 = 2, d4 = 1.5, r2 = 1, r3 = 0 at (2.5, 0, 0.5) has the four
    solutions (-1.8, -2.8, 1.9), (-0.9, -0.7, 2.5), (-2.9, -3, -0.2), (0.2, -0.3, -1.9)
    (Wenger 2007, Cuspidal and noncuspidal robot manipulators, Robotica 25; figures from memory,
    they are printed with one decimal).
    """
    robot = orthogonal(1.0, 2.0, 1.5, 1.0, 0.0)
    T = np.eye(4)
    T[:3, 3] = [2.5, 0, 0.5]
    found = distinct_solutions(robot, T, "position", 120)
    assert len(found) == 4
    for printed in ([-1.8, -2.8, 1.9], [-0.9, -0.7, 2.5], [-2.9, -3.0, -0.2], [0.2, -0.3, -1.9]):
        assert min(np.abs(wrap(np.array(printed) - f)).max() for f in found) < 0.07
    # cuspidal: two solutions in one aspect (same signs of both factors)
    sign = [np.sign(np.linalg.det(hand_jacobian(robot, q)[:3])) for q in found]
    assert sorted(sign) == [-1, -1, 1, 1]


def quadruple_length(d3: float, r2: float) -> float:
    """Least d4 (d2 = 1, r3 = 0) with four solutions: Wenger, Chablat and Baili 2005, their condition."""
    A, B = np.hypot(d3 + 1, r2), np.hypot(d3 - 1, r2)
    s = d3**2 + r2**2
    return float(np.sqrt(0.5 * (s - (s**2 - d3**2 + r2**2) / (A * B))))


@pytest.mark.parametrize(("d3", "r2"), [(2.0, 1.0), (1.0, 0.5), (0.7, 0.4)])
def test_wenger_condition_of_four_solutions(d3: float, r2: float) -> None:
    """Above that length some point has four solutions, below it none has; kl.ik meets all four."""
    limit = quadruple_length(d3, r2)
    assert most_solutions(1.0, d3, 0.9 * limit, r2)[0] == 2
    count, rho, z = most_solutions(1.0, d3, 2.5 * limit, r2)
    assert count == 4
    robot = orthogonal(1.0, d3, 2.5 * limit, r2, 0.0)
    T = np.eye(4)
    T[:3, 3] = [rho, 0.0, z]
    assert len(distinct_solutions(robot, T, "position", 200)) == 4


def most_solutions(d2: float, d3: float, d4: float, r2: float) -> tuple[int, float, float]:
    """Most solutions over a grid of points (rho, z), and the middle one of the points that have them.

    Tip: z = -u s2 and rho^2 = (d2 + u c2)^2 + (r2 + d4 s3)^2 with u = d3 + d4 c3; solutions are
    sign changes over q3 on both branches of q2.
    """
    q3 = np.linspace(-np.pi, np.pi, 1501)
    u, v = d3 + d4 * np.cos(q3), d4 * np.sin(q3)
    rho = np.linspace(0.0, d2 + d3 + d4 + r2, 241)
    best, points = 0, []
    for z in np.linspace(0.0, d3 + d4, 61)[:-1]:
        count = np.zeros(len(rho), dtype=int)
        for branch in (1.0, -1.0):
            with np.errstate(invalid="ignore"):
                root = branch * np.sqrt(u**2 - z**2) * np.sign(u)
            f = ((d2 + root) ** 2 + (r2 + v) ** 2)[:, None] - rho**2
            sign = np.sign(f)
            good = np.isfinite(f[:-1]) & np.isfinite(f[1:])
            count += np.sum(good & (sign[:-1] != sign[1:]), axis=0)
        if count.max() > best:
            best, points = int(count.max()), []
        if count.max() == best:
            points += [(float(r), float(z)) for r in rho[count == best]]
    r, z = points[len(points) // 2]
    return best, r, z


@pytest.mark.parametrize(
    ("lengths", "want"),
    [
        ((1.0, 2.0, 1.5, 1.0, 0.0), {(2, 3)}),
        ((1.0, 0.7, 0.3, 0.2, 0.2), {(2, 3)}),
        ((1.0, 1.5, 0.6, 0.0, 0.3), {(2, 3), (3,)}),  # r2 = 0: det J = 0 wherever s3 = 0
    ],
)
def test_wenger_arms_have_no_pinned_sheet(
    lengths: tuple[float, ...], want: set[tuple[int, ...]]
) -> None:
    """The singular set of these arms is curves in (q2, q3); with d3 > d4 and r3 = 0 the factor d3 + c3 d4
    never vanishes, so that no family hangs on joint 3 alone (Wenger, Chablat and Baili 2005);
    with r2 = 0 the other factor has s3 in it, and one does.
    """
    robot = orthogonal(*lengths)
    found = kl.find_singularities(robot, "position")
    assert found.families
    assert deciding_sets(found, robot) == want
    assert all(moves_on_the_set(robot, f, [0, 1, 2]) for f in found.families)


def test_wenger_pinned_sheet_where_d4_exceeds_d3() -> None:
    """With d4 > d3 and r3 = 0 the factor d3 + c3 d4 gives two sheets q3 = +-acos(-d3/d4)."""
    robot = orthogonal(1.0, 0.8, 1.2, 0.3, 0.0)
    found = kl.find_singularities(robot, "position")
    pinned = sorted(float(f.pinned[0]) for f in found.families if len(f.deciding) == 1)
    want = float(np.arccos(-0.8 / 1.2))
    assert pinned == pytest.approx([-want, want], abs=1e-8)
    assert deciding_sets(found, robot) == {(2, 3), (3,)}
    assert all(moves_on_the_set(robot, f, [0, 1, 2]) for f in found.families)


# ---------------------------------------------------------------- six and seven joints
def test_manseur_and_doty_sixteen_solutions() -> None:
    """Manseur and Doty 1989 (A robot manipulator with 16 real inverse kinematic solution sets, IJRR
    8(5)); pose as in Manocha and Canny 1994, six digits (from memory; an own search meets 16).
    """
    robot = manseur_doty()
    T = np.eye(4)
    T[:3] = [
        [-0.760117, -0.641689, 0.102262, -1.140175],
        [0.133333, 0.0, 0.991071, 0.0],
        [-0.635959, 0.766965, 0.085558, 0.0],
    ]
    u, _, v = np.linalg.svd(T[:3, :3])
    T[:3, :3] = u @ v
    found = distinct_solutions(robot, T, "pose", 600)
    assert len(found) == 16
    for q in found:
        assert np.allclose(kl.fk(robot, q), T, atol=1e-8)


SRS_SETS = {(4,): [0.0], (2, 3): [0.0, HALF], (2, 6): [0.0, 0.0], (5, 6): [HALF, 0.0]}


def test_srs_factors_lose_rank() -> None:
    """Singularities of arms with spherical shoulder and wrist, as in Shimizu et al. 2008 (IEEE Trans.
    Robotics 24(5)) and Kreutz-Delgado, Long and Seraji 1992: s4 = 0; s2 = c3 = 0; s2 = s6 = 0;
    c5 = s6 = 0.
    """
    robot = srs()
    rng = np.random.default_rng(4)
    for joints, values in SRS_SETS.items():
        for q in rng.uniform(robot.lower, robot.upper, (20, 7)):
            assert ratio(hand_jacobian(robot, q)) > 1e-5
            q[[j - 1 for j in joints]] = values
            assert ratio(kl.jacobian(robot, q)) < 1e-14


def test_srs_families_are_these_and_no_others() -> None:
    """The same four sets are what find_singularities names, all of them true."""
    robot = srs()
    found = kl.find_singularities(robot, "pose")
    assert deciding_sets(found, robot) == set(SRS_SETS)
    assert all(moves_on_the_set(robot, f, [0, 1, 2, 3, 4, 5]) for f in found.families)


@pytest.mark.parametrize(
    ("name", "want"),
    [
        (
            "puma560",
            {(3,), (5,), (2, 3)},
        ),  # Craig sec. 5.8; Siciliano sec. 3.3: elbow, wrist, shoulder
        (
            "ur5",
            {(3,), (5,), (2, 3, 4)},
        ),  # Villalobos, Sanchez and Martell 2022 (J. Intell. Robot. Syst.)
        ("ur10", {(3,), (5,), (2, 3, 4)}),
        ("stanford", {(2,), (5,)}),  # q3^2 s2 s5; Paul 1981, the slide never closes
        ("scara", {(2,)}),
    ],
)
def test_families_of_known_arms(name: str, want: set[tuple[int, ...]]) -> None:
    """Deciding joints of every factor of det J, and nothing else."""
    robot = kl.load(name)
    found = kl.find_singularities(robot)
    assert deciding_sets(found, robot) == want
    rows = [0, 1, 2, 5] if name == "scara" else [0, 1, 2, 3, 4, 5]
    assert all(moves_on_the_set(robot, f, rows) for f in found.families)


@pytest.mark.parametrize(
    ("name", "q", "truth"),
    [
        # shoulder of the Puma: a2 c2 + a3 c23 - d4 s23 = 0, nearest point (q2, q3) = (5 pi / 4, 0.0459)
        ("puma560", (-1.7708, 3.7527, -0.1528, 0.432, 1.0944, 0.955), 0.2642898970),
        ("puma560", (1.47885, 3.342547, 0.712596, 2.245592, -1.697337, 4.068156), 0.226031),
        # shoulder of the UR5: a2 c2 + a3 c23 + d5 s234 = 0
        ("ur5", (2.6191, 3.6336, 1.8799, -2.2332, 3.7277, -3.4516), 0.1204846204),
        (
            "ur5",
            (1.503528, -1.76714, -2.250835, 1.815847, -5.602262, 1.157828),
            0.680923,
        ),  # q5 at its limit, -2 pi to ten digits
    ],
)
def test_nearest_zero_of_each_factor(name: str, q: tuple[float, ...], truth: float) -> None:
    """Distance to the nearest zero of any factor, by dense sampling of the factors' zero sets."""
    answer = kl.nearest_singularity(kl.load(name), q)
    assert answer.distance == pytest.approx(truth, abs=2e-6)
    assert ratio(hand_jacobian(kl.load(name), answer.singularity.q)) < 1e-9


def test_stanford_wrist_is_no_edge() -> None:
    """A wrist singularity well inside the workspace: the tool passes on in the lost direction (Siciliano
    sec. 3.3.1: wrist singularities are met anywhere inside the reachable workspace).
    """
    robot = kl.load("stanford")
    found = kl.find_singularities(robot)
    wrist = [f for f in found.families if f.deciding == ("joint_5",)]
    assert wrist
    # solutions on both sides, asked of kl.ik for the representative
    for f in wrist:
        m = f.members[0]
        full = np.zeros(6)
        full[list(m.rows)] = m.lost[:, 0]
        both = []
        for s in (1e-3, -1e-3):
            T = kl.fk(robot, m.q)
            T[:3, 3] += s * m.length * full[:3]
            w = s * full[3:]
            angle = np.linalg.norm(w)
            k = w / max(angle, 1e-300)
            K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
            T[:3, :3] = (np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K) @ T[:3, :3]
            both.append(kl.ik(robot, T, restarts=200).success)
        if all(both):
            assert f.beyond is not False
