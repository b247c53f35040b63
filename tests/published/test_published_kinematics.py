"""Worked examples with numbers: kinematics, statics, dynamics."""

from __future__ import annotations

import numpy as np
import pytest
from literature_arms import HALF, arm, planar

import kinlab as kl


def with_bodies(
    lengths: tuple[float, float], coms: tuple[float, float], masses: tuple[float, float],
    inertias: tuple[float, float],
) -> kl.Robot:  # fmt: skip
    """Planar 2R in a vertical plane (y up); coms from the joint along the link."""
    links = []
    for l, c, m, i in zip(lengths, coms, masses, inertias, strict=True):
        tensor = np.diag([i / 2, i / 2, i])
        links.append(kl.DHLink(a=l, mass=m, com=(c - l, 0, 0), inertia=tensor))
    return kl.Robot.from_dh(
        kl.DHTable(name="two_links", convention="standard", links=links, gravity=(0, -9.81, 0))
    )


def test_spong_two_link_dynamics() -> None:
    """Spong, Hutchinson and Vidyasagar, Robot Modeling and Control, section 7.3.2 (planar elbow
    manipulator; 6.4.2 in the first printing).
    """
    l1, l2, c1, c2, m1, m2, I1, I2, g = 0.9, 0.7, 0.4, 0.3, 3.0, 2.0, 0.25, 0.11, 9.81
    robot = with_bodies((l1, l2), (c1, c2), (m1, m2), (I1, I2))
    rng = np.random.default_rng(0)
    for q, v in zip(rng.uniform(-3, 3, (10, 2)), rng.uniform(-2, 2, (10, 2)), strict=True):
        d11 = m1 * c1**2 + m2 * (l1**2 + c2**2 + 2 * l1 * c2 * np.cos(q[1])) + I1 + I2
        d12 = m2 * (c2**2 + l1 * c2 * np.cos(q[1])) + I2
        d22 = m2 * c2**2 + I2
        h = -m2 * l1 * c2 * np.sin(q[1])
        assert np.allclose(kl.mass_matrix(robot, q), [[d11, d12], [d12, d22]], atol=1e-12)
        assert np.allclose(
            kl.coriolis_matrix(robot, q, v),
            [[h * v[1], h * (v[0] + v[1])], [-h * v[0], 0]],
            atol=1e-12,
        )
        g1 = (m1 * c1 + m2 * l1) * g * np.cos(q[0]) + m2 * c2 * g * np.cos(q[0] + q[1])
        g2 = m2 * c2 * g * np.cos(q[0] + q[1])
        assert np.allclose(kl.gravity_torques(robot, q), [g1, g2], atol=1e-12)


def test_craig_two_link_dynamics() -> None:
    """Craig, Introduction to Robotics, section 6.7, equation (6.58): two links, masses at their ends."""
    l1, l2, m1, m2, g = 0.5, 0.4, 2.0, 1.0, 9.81
    links = [kl.DHLink(a=l1, mass=m1), kl.DHLink(a=l2, mass=m2)]
    robot = kl.Robot.from_dh(
        kl.DHTable(name="craig", convention="standard", links=links, gravity=(0, -g, 0))
    )
    rng = np.random.default_rng(1)
    for q, v, a in rng.uniform(-2, 2, (10, 3, 2)):
        c2, s2, c1, c12 = np.cos(q[1]), np.sin(q[1]), np.cos(q[0]), np.cos(q[0] + q[1])
        t1 = (
            m2 * l2**2 * (a[0] + a[1]) + m2 * l1 * l2 * c2 * (2 * a[0] + a[1])
            + (m1 + m2) * l1**2 * a[0] - m2 * l1 * l2 * s2 * v[1] ** 2
            - 2 * m2 * l1 * l2 * s2 * v[0] * v[1] + m2 * l2 * g * c12 + (m1 + m2) * l1 * g * c1
        )  # fmt: skip
        t2 = (
            m2 * l1 * l2 * c2 * a[0]
            + m2 * l1 * l2 * s2 * v[0] ** 2
            + m2 * l2 * g * c12
            + m2 * l2**2 * (a[0] + a[1])
        )
        assert np.allclose(kl.inverse_dynamics(robot, q, v, a), [t1, t2], atol=1e-12)


def test_craig_two_link_jacobian_and_statics() -> None:
    """Craig, examples 5.3 and 5.7: in frame 3, v = (l1 s2 qd1, l1 c2 qd1 + l2 (qd1 + qd2)) and
    tau = (l1 s2 fx + (l2 + l1 c2) fy, l2 fy).
    """
    l1, l2 = 0.5, 0.3
    robot = planar(l1, l2)
    for q in ([0.3, 0.9], [-1.0, 2.0], [2.0, -0.4]):
        s2, c2 = np.sin(q[1]), np.cos(q[1])
        J3 = kl.jacobian(robot, q, frame="tool")[:2]
        assert np.allclose(J3, [[l1 * s2, 0], [l1 * c2 + l2, l2]], atol=1e-14)
        fx, fy = 3.0, -2.0
        tau = kl.statics(robot, q, [fx, fy, 0, 0, 0, 0], frame="tool")
        assert np.allclose(tau, [l1 * s2 * fx + (l2 + l1 * c2) * fy, l2 * fy], atol=1e-13)


def test_craig_planar_rrr() -> None:
    """Craig, section 3.6 (example 3.3, the planar RRR arm), tool at the end of link 3."""
    l = (0.4, 0.3, 0.2)
    robot = planar(*l)
    q = np.deg2rad([10.0, 20.0, 30.0])
    s = np.cumsum(q)
    T = kl.fk(robot, q)
    assert np.allclose(T[:2, 3], [np.dot(l, np.cos(s)), np.dot(l, np.sin(s))], atol=1e-14)
    assert np.allclose(T[:2, :2], [[0.5, -np.sqrt(3) / 2], [np.sqrt(3) / 2, 0.5]], atol=1e-14)


def lynch_park_ur5() -> kl.Robot:
    """UR5 with the lengths of Lynch and Park, example 4.5, base turned so that x points along the arm."""
    rows = [
        ("R", 0, HALF, 0.089, 0), ("R", -0.425, 0, 0, 0), ("R", -0.392, 0, 0, 0),
        ("R", 0, HALF, 0.109, 0), ("R", 0, -HALF, 0.095, 0), ("R", 0, 0, 0.082, 0),
    ]  # fmt: skip
    links = [
        kl.DHLink(a=a, alpha=al, d=d, mass=1.0, inertia=0.01 * np.eye(3)) for _, a, al, d, _ in rows
    ]
    return kl.Robot.from_dh(
        kl.DHTable(
            name="lp_ur5", convention="standard", links=links, base=np.diag([-1.0, -1, 1, 1])
        )
    )


def test_lynch_park_ur5() -> None:
    """Lynch and Park, Modern Robotics, example 4.5: M and T(0, -pi/2, 0, 0, pi/2, 0), three decimals."""
    robot = lynch_park_ur5()
    M = [[-1, 0, 0, 0.817], [0, 0, 1, 0.191], [0, 1, 0, -0.006], [0, 0, 0, 1]]
    assert np.allclose(kl.fk(robot, np.zeros(6)), M, atol=1e-12)
    T = [[0, -1, 0, 0.095], [1, 0, 0, 0.109], [0, 0, 1, 0.988], [0, 0, 0, 1]]
    assert np.allclose(kl.fk(robot, [0, -HALF, 0, 0, HALF, 0]), T, atol=6e-4)
    # their screw axes (omega, v) at home
    J = kl.jacobian(robot, np.zeros(6), frame="spatial")
    W1, W2, L1, L2, H1, H2 = 0.109, 0.082, 0.425, 0.392, 0.089, 0.095
    screws = [
        [0, 0, 1, 0, 0, 0], [0, 1, 0, -H1, 0, 0], [0, 1, 0, -H1, 0, L1], [0, 1, 0, -H1, 0, L1 + L2],
        [0, 0, -1, -W1, L1 + L2, 0], [0, 1, 0, H2 - H1, 0, L1 + L2],
    ]  # fmt: skip
    assert W2 > 0
    assert np.allclose(np.vstack([J[3:], J[:3]]).T, screws, atol=1e-12)


def test_lynch_park_shipped_ur5_is_close() -> None:
    """The shipped UR5 has the maker's longer decimals: within a millimetre or two of the book's."""
    T = kl.fk(kl.load("ur5"), [0, -HALF, 0, 0, HALF, 0])
    assert np.allclose(T[:3, 3], [0.095, 0.109, 0.988], atol=3e-3)
    assert np.allclose(T[:3, :3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-9)


def test_lynch_park_rrrp_space_jacobian() -> None:
    """Lynch and Park, example 5.2 (RRRP): columns of the space Jacobian, (omega, v)."""
    L1, L2 = 0.5, 0.35
    robot = arm(
        "rrrp", [("R", L1, 0, 0, 0), ("R", L2, 0, 0, 0), ("R", 0, 0, 0, 0), ("P", 0, 0, 0, 0)]
    )
    for q in ([0.2, 0.5, -0.3, 0.1], [-1.0, 2.0, 0.4, -0.5]):
        s1, c1, s12, c12 = np.sin(q[0]), np.cos(q[0]), np.sin(q[0] + q[1]), np.cos(q[0] + q[1])
        want = [
            [0, 0, 1, 0, 0, 0], [0, 0, 1, L1 * s1, -L1 * c1, 0],
            [0, 0, 1, L1 * s1 + L2 * s12, -L1 * c1 - L2 * c12, 0], [0, 0, 0, 0, 0, 1],
        ]  # fmt: skip
        J = kl.jacobian(robot, q, frame="spatial")
        assert np.allclose(np.vstack([J[3:], J[:3]]).T, want, atol=1e-13)


PUMA = {
    "qz": ((0, 0, 0, 0, 0, 0), (0.4521, -0.1500, 0.4318)),
    "qr": ((0, HALF, -HALF, 0, 0, 0), (0.0203, -0.1500, 0.8636)),
    "qs": ((0, 0, -HALF, 0, 0, 0), (0.8636, -0.1500, -0.0203)),
    "qn": ((0, np.pi / 4, np.pi, 0, np.pi / 4, 0), (0.5963, -0.1501, -0.01435)),
}


@pytest.mark.parametrize("pose", list(PUMA))
def test_corke_puma_positions(pose: str) -> None:
    """Corke, Robotics, Vision and Control, section 7.2 (Puma 560 of the Robotics Toolbox)."""
    q, p = PUMA[pose]
    assert np.allclose(kl.fk(kl.load("puma560"), q)[:3, 3], p, atol=6e-5)


@pytest.mark.parametrize(
    ("pose", "load"),
    [
        ("qn", (0.0, 31.6399, 6.0351, 0.0, 0.0283, 0.0)),  # also in the toolbox's unit tests of rne
        ("qz", (0.0, 37.4837, 0.2489, 0.0, 0.0, 0.0)),
        ("qr", (0.0, -0.7752, 0.2489, 0.0, 0.0, 0.0)),
    ],
)
def test_corke_puma_gravload(pose: str, load: tuple[float, ...]) -> None:
    """Corke, Robotics, Vision and Control, section 9.1.2 (gravload of the Robotics Toolbox), four
    decimals: qn stands in the toolbox's unit tests, qz and qr are from memory.
    """
    assert np.allclose(kl.gravity_torques(kl.load("puma560"), PUMA[pose][0]), load, atol=6e-5)


def test_corke_puma_manipulability() -> None:
    """Corke, Robotics, Vision and Control, section 8.2.2: 0.0786 at qn; 0 at the ready pose qr."""
    puma = kl.load("puma560")
    assert kl.manipulability(puma, PUMA["qn"][0]) == pytest.approx(0.0786, abs=6e-5)
    assert kl.manipulability(puma, PUMA["qr"][0]) == pytest.approx(0.0, abs=1e-12)
