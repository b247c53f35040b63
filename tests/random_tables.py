"""Random DH tables for property tests."""

from __future__ import annotations

import numpy as np
from hypothesis import strategies as st

import kinlab as kl


def random_rotation(rng: np.random.Generator) -> np.ndarray:
    """Uniform over rotations, by QR with the signs fixed."""
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else q[:, [1, 0, 2]]


def random_pose(rng: np.random.Generator) -> np.ndarray:
    """A rigid transform of metre size."""
    out = np.eye(4)
    out[:3, :3] = random_rotation(rng)
    out[:3, 3] = rng.uniform(-1, 1, 3)
    return out


def random_inertia(rng: np.random.Generator) -> np.ndarray:
    """A tensor that a body can have: from a positive density matrix, then turned."""
    spread = rng.uniform(0.001, 0.3, 3)
    principal = np.sum(spread) - spread
    turn = random_rotation(rng)
    tensor = turn @ np.diag(principal) @ turn.T
    return 0.5 * (tensor + tensor.T)


def random_table(
    seed: int, n: int, convention: str, *, prismatic: float = 0.3, name: str = "random"
) -> kl.DHTable:
    """A table with special angles (0, ±90°, 180°) as often as general ones."""
    rng = np.random.default_rng(seed)

    def angle() -> float:
        if rng.random() < 0.5:
            return float(rng.choice([0.0, np.pi / 2, -np.pi / 2, np.pi]))
        return float(rng.uniform(-np.pi, np.pi))

    def length() -> float:
        return 0.0 if rng.random() < 0.3 else float(rng.uniform(-0.8, 0.8))

    links = [
        kl.DHLink(
            joint="prismatic" if rng.random() < prismatic else "revolute",
            a=length(),
            alpha=angle(),
            d=length(),
            theta=angle(),
            flip=bool(rng.random() < 0.3),
            lower=-2.5,
            upper=2.0,
            mass=float(rng.uniform(0.1, 8.0)),
            com=rng.uniform(-0.4, 0.4, 3),
            inertia=random_inertia(rng),
            armature=float(rng.choice([0.0, rng.uniform(0.0, 2.0)])),
        )
        for _ in range(n)
    ]
    return kl.DHTable(
        name, convention, links, base=random_pose(rng), tool=random_pose(rng),
        gravity=rng.uniform(-10, 10, 3), source="random",
    )  # fmt: skip


tables = st.builds(
    random_table,
    seed=st.integers(0, 2**32 - 1),
    n=st.integers(1, 8),
    convention=st.sampled_from(["standard", "modified"]),
)
"""Tables of 1 to 8 joints in both conventions, with prismatic, flipped and offset joints."""
