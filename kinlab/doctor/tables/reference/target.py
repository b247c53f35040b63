"""What a table is held against: poses at states, and how near to them is the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.tables.chain import Chain, stacked_frames, tool_poses

SEARCHED = 10
"""States on which causes are looked for; all states are used to confirm one."""


@dataclass(frozen=True, eq=False)
class Target:
    """Tool poses of the reference.

    Attributes:
        q: joint positions, (N, n).
        poses: (N, 4, 4).
        tolerance: largest difference of an entry that is rounding, relative to the arm's size
            (1 m at least).
    """

    q: Array
    poses: Array
    tolerance: float = 1e-9

    @property
    def few(self) -> Target:
        """The first states, on which causes are looked for."""
        return Target(self.q[:SEARCHED], self.poses[:SEARCHED], self.tolerance)

    @property
    def size(self) -> float:
        """The larger of 1 m and the farthest coordinate of the tool."""
        return max(1.0, float(np.max(np.abs(self.poses[:, :3, 3]))))

    @property
    def steady(self) -> float:
        """Spread over the states below which a difference counts as constant; a candidate only."""
        return 10.0 * self.tolerance

    @property
    def slack(self) -> float:
        """How far solved numbers may be off; nothing where the poses are exact."""
        return 0.0 if self.tolerance <= 1e-9 else 5.0 * self.tolerance

    def miss(self, poses: Array) -> Array:
        """Largest difference per state, lengths over :attr:`size`, (..., N) for (..., N, 4, 4)."""
        gap = np.abs(poses - self.poses)
        gap[..., :3, 3] /= self.size
        out: Array = np.max(gap, axis=(-2, -1))
        return out

    def error(self, chain: Chain) -> float:
        """Largest difference of a chain over all states."""
        if chain.n != self.q.shape[1]:
            return float("inf")
        return float(np.max(self.miss(tool_poses(chain, self.q))))

    def met(self, chain: Chain) -> bool:
        """Whether a chain gives the poses at every state."""
        return self.error(chain) <= self.tolerance

    def met_by(self, chains: Sequence[Chain], states: int = 2) -> list[int]:
        """Which of many chains give the poses: thinned out on a few states, then on all."""
        if not chains:
            return []
        q = self.q[:states]
        poses = stacked_frames(chains, q)[:, :, -1]
        near = Target(q, self.poses[:states], self.tolerance).miss(poses)
        found = np.flatnonzero(np.max(near, axis=1) <= 10.0 * self.tolerance * self.size)
        return [int(k) for k in found if self.met(chains[int(k)])]
