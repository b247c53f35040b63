"""Arms of the literature as DH tables, and a Jacobian that shares no code with the project.

The Jacobian is a product of DH transforms in plain numpy, so that a published value, this file and
the library are three parties.
"""

from __future__ import annotations

import numpy as np

import kinlab as kl

HALF = np.pi / 2


def arm(
    name: str,
    rows: list[tuple[str, float, float, float, float]],
    convention: str = "standard",
    tool: float = 0.0,
    limits: list[tuple[float, float]] | None = None,
) -> kl.Robot:
    """A robot from rows (joint, a, alpha, d, theta); ``tool`` is a step along the last x axis."""
    T = np.eye(4)
    T[0, 3] = tool
    links = []
    for i, (joint, a, alpha, d, theta) in enumerate(rows):
        lower, upper = limits[i] if limits else ((-np.pi, np.pi) if joint == "R" else (-1.0, 1.0))
        links.append(
            kl.DHLink(
                joint="revolute" if joint == "R" else "prismatic",
                a=a, alpha=alpha, d=d, theta=theta, lower=lower, upper=upper,
                mass=1.0, inertia=0.01 * np.eye(3),
            )
        )  # fmt: skip
    return kl.Robot.from_dh(kl.DHTable(name=name, convention=convention, links=links, tool=T))


def hand_jacobian(robot: kl.Robot, q: np.ndarray) -> np.ndarray:
    """(6, n), linear rows first, about the tool, axes of the base; standard or modified DH."""
    table = robot.table
    assert table is not None
    T = np.array(table.base, float)
    axes, origins, slides = [], [], []
    for link, x in zip(table.links, q, strict=True):
        x = -x if link.flip else x
        theta = link.theta + (x if link.joint == "revolute" else 0.0)
        d = link.d + (x if link.joint == "prismatic" else 0.0)
        rz = np.eye(4)
        rz[:2, :2] = [[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]]
        rz[2, 3] = d
        rx = np.eye(4)
        rx[1:3, 1:3] = [
            [np.cos(link.alpha), -np.sin(link.alpha)],
            [np.sin(link.alpha), np.cos(link.alpha)],
        ]
        rx[0, 3] = link.a
        if str(table.convention).endswith("modified"):
            T = T @ rx
            axes.append(T[:3, 2])
            origins.append(T[:3, 3])
            T = T @ rz
        else:
            axes.append(T[:3, 2])
            origins.append(T[:3, 3])
            T = T @ rz @ rx
        slides.append(link.joint == "prismatic")
    tip = (T @ np.array(table.tool, float))[:3, 3]
    columns = [
        np.concatenate([z, np.zeros(3)]) if s else np.concatenate([np.cross(z, tip - o), z])
        for z, o, s in zip(axes, origins, slides, strict=True)
    ]
    return np.array(columns).T


def condition(J: np.ndarray) -> float:
    """Largest over smallest singular value."""
    s = np.linalg.svd(J, compute_uv=False)
    return float(s[0] / s[-1])


def ratio(J: np.ndarray) -> float:
    """Smallest over largest singular value."""
    s = np.linalg.svd(J, compute_uv=False)
    return float(s[-1] / s[0])


def wrap(q: np.ndarray) -> np.ndarray:
    """Angles into (-pi, pi]."""
    return np.asarray(-((-np.asarray(q) + np.pi) % (2 * np.pi) - np.pi))


def distinct_solutions(
    robot: kl.Robot, T: np.ndarray, task: str, starts: int, seed: int = 0
) -> list[np.ndarray]:
    """Different solutions modulo 2 pi that kl.ik meets from many random starts."""
    rng = np.random.default_rng(seed)
    found: list[np.ndarray] = []
    for q0 in rng.uniform(robot.lower, robot.upper, (starts, robot.n)):
        answer = kl.ik(robot, T, q0, task=task, restarts=0, tol_position=1e-10, tol_rotation=1e-10)
        if answer.success:
            q = wrap(answer.q)
            if all(np.abs(wrap(q - f)).max() > 1e-3 for f in found):
                found.append(q)
    return found


def diestro() -> kl.Robot:
    """Williams, Angeles and Bulca 1993: all lengths 50 mm, all twists +-90 deg."""
    return arm("diestro", [("R", 0.05, s * HALF, 0.05, 0.0) for s in (1, -1, 1, -1, 1, -1)])


def finger(a1: float = 0.0, l1: float = np.sqrt(2.0), l2: float = 1.0) -> kl.Robot:
    """Salisbury and Craig's finger: a base joint across two parallel ones."""
    return arm("finger", [("R", a1, HALF, 0, 0), ("R", l1, 0, 0, 0), ("R", l2, 0, 0, 0)])


def planar(*lengths: float) -> kl.Robot:
    """A planar arm."""
    return arm(f"planar{len(lengths)}r", [("R", l, 0, 0, 0) for l in lengths])


def equilateral(a: float = 1.0) -> kl.Robot:
    """Planar 3R, two links of a and a third of a/sqrt(3)."""
    return planar(a, a, a / np.sqrt(3.0))


def spherical_wrist(twist: float = HALF) -> kl.Robot:
    """Three axes through one point, neighbours at the angle ``twist``."""
    return arm("wrist", [("R", 0, -twist, 0, 0), ("R", 0, twist, 0, 0), ("R", 0, 0, 0.1, 0)])


def orthogonal(d2: float, d3: float, d4: float, r2: float, r3: float) -> kl.Robot:
    """Wenger's orthogonal 3R arms in his letters (modified DH): alpha2 = -90, alpha3 = 90 deg."""
    return arm(
        "orthogonal3r",
        [("R", 0, 0, 0, 0), ("R", d2, -HALF, r2, 0), ("R", d3, HALF, r3, 0)],
        "modified",
        d4,
    )


def manseur_doty() -> kl.Robot:
    """Manseur and Doty 1989, table as in Manocha and Canny 1994: twists 90, 1, 90, 1, 90, 1 deg."""
    one = np.deg2rad(1.0)
    return arm(
        "manseur_doty",
        [
            ("R", 0.3, HALF, 0, 0), ("R", 1.0, one, 0, 0), ("R", 0, HALF, 0.2, 0),
            ("R", 1.5, one, 0, 0), ("R", 0, HALF, 0, 0), ("R", 0, one, 0, 0),
        ],
    )  # fmt: skip


def srs(bs: float = 0.36, se: float = 0.42, ew: float = 0.4, wf: float = 0.126) -> kl.Robot:
    """Seven revolute joints: spherical shoulder, elbow, spherical wrist (LBR iiwa 14's lengths)."""
    limits = [(-np.deg2rad(x), np.deg2rad(x)) for x in (170, 120, 170, 120, 170, 120, 175)]
    return arm(
        "srs",
        [
            ("R", 0, -HALF, bs, 0), ("R", 0, HALF, 0, 0), ("R", 0, HALF, se, 0),
            ("R", 0, -HALF, 0, 0), ("R", 0, -HALF, ew, 0), ("R", 0, HALF, 0, 0),
            ("R", 0, 0, wf, 0),
        ],
        limits=limits,
    )  # fmt: skip


def anthropomorphic(a2: float = 0.5, a3: float = 0.4, d1: float = 0.0) -> kl.Robot:
    """Siciliano's anthropomorphic arm (section 2.9.4)."""
    return arm("anthropomorphic", [("R", 0, HALF, d1, 0), ("R", a2, 0, 0, 0), ("R", a3, 0, 0, 0)])


def spherical_arm(d2: float = 0.15) -> kl.Robot:
    """Siciliano's spherical arm (section 2.9.3): two crossing axes and a slide."""
    return arm(
        "spherical",
        [("R", 0, -HALF, 0, 0), ("R", 0, HALF, d2, 0), ("P", 0, 0, 0, 0)],
        limits=[(-3.0, 3.0), (-2.8, 2.8), (-0.5, 1.0)],
    )
