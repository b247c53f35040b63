"""A roadmap within one side of det J: sampled joint positions, lines between neighbours.

Kavraki, Svestka, Latombe & Overmars, "Probabilistic roadmaps for path planning in
high-dimensional configuration spaces", IEEE Trans. Robotics and Automation 12(4), 1996. Its lines
are sieved by signs at samples; a path is returned only when all of it is shown to be free.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import pairwise
from typing import Any

import numpy as np

from kinlab.analysis.structure.task_space import TaskSpace, revolute
from kinlab.arrays import Array
from kinlab.inverse.postures.nonsingular import NonsingularPath, same_sign, show_nonsingular

_NEIGHBOURS = 12
_SAMPLES = 16
"""Of a line between neighbours, in the sieve."""
_TRIES = 12
"""Paths through the map for one pair; after each that fails, its worst line is taken out."""
_FREE = 0.02
"""sigma_min, as a share of the best sample's, below which no node is put."""


@dataclass(eq=False)
class Roadmap:
    """Nodes and the lines between them.

    Attributes:
        space: the task. q: (N, n), the given positions first.
        lines: for each node, its neighbours and what the way costs.
    """

    space: TaskSpace
    q: Array
    lines: list[dict[int, float]]

    @classmethod
    def sample(
        cls,
        space: TaskSpace,
        inside: Callable[[Array], Any],
        given: Array,
        low: Array,
        high: Array,
        nodes: int,
        rng: np.random.Generator,
    ) -> Roadmap:
        """A map of given positions (M, n) and samples on their side of det J.

        Args:
            space: the task. inside: which of (N, n) positions lie on that side.
            given: start and goals. low, high: limits; infinite: a turn around what is given.
            nodes: how many samples. rng: where they come from.
        """
        turn = np.where(revolute(space.robot), np.pi, 0.0)
        least, most = given.min(axis=0) - turn, given.max(axis=0) + turn
        least, most = np.maximum(low, least), np.minimum(high, most)
        kept: list[Array] = []
        for _ in range(40):
            drawn = rng.uniform(least, most, (nodes, space.robot.n))
            kept.append(drawn[inside(drawn)])
            if sum(map(len, kept)) >= 2 * nodes:
                break
        drawn = np.concatenate(kept)
        sigma = _sigma(space, drawn)
        if len(drawn):
            good = sigma > _FREE * sigma.max()
            drawn = drawn[good][:nodes]
        q = np.concatenate([given, drawn])
        return cls(space, q, _lines(space, q))

    def path(self, start: int, goal: int) -> NonsingularPath | None:
        """A path between two nodes that is shown to be free, or ``None``."""
        for _ in range(_TRIES):
            rows = self._shortest(start, goal)
            if rows is None:
                return None
            path = show_nonsingular(self.space, self.q[rows])
            if path is not None:
                return self._shorter(path)
            for one, two in pairwise(rows):
                if show_nonsingular(self.space, self.q[[one, two]]) is None:
                    del self.lines[one][two], self.lines[two][one]
        return None

    def _shorter(self, path: NonsingularPath) -> NonsingularPath:
        """Corners left out where the path stays shown."""
        corners = list(path.q)
        i = 1
        while i < len(corners) - 1:
            fewer = np.array([*corners[:i], *corners[i + 1 :]])
            if bool(same_sign(self.space, fewer[i - 1 : i], fewer[i : i + 1])[0]):
                other = show_nonsingular(self.space, fewer)
                if other is not None and other.sigma >= 0.5 * path.sigma:
                    del corners[i]
                    path = other
                    continue
            i += 1
        return path

    def _shortest(self, start: int, goal: int) -> list[int] | None:
        """Dijkstra."""
        cost, before = {start: 0.0}, {start: -1}
        heap = [(0.0, start)]
        while heap:
            spent, node = heappop(heap)
            if node == goal:
                rows = [node]
                while before[rows[-1]] >= 0:
                    rows.append(before[rows[-1]])
                return rows[::-1]
            if spent > cost[node]:
                continue
            for other, length in self.lines[node].items():
                total = spent + length
                if total < cost.get(other, np.inf):
                    cost[other], before[other] = total, node
                    heappush(heap, (total, other))
        return None


def _sigma(space: TaskSpace, q: Array) -> Array:
    if not len(q):
        return np.zeros(0)
    values = space.sigma(q)
    return np.asarray(values[:, -1], dtype=np.float64)


def _lines(space: TaskSpace, q: Array) -> list[dict[int, float]]:
    from scipy.spatial import cKDTree  # `import kinlab` does not wait for scipy

    apart, near = cKDTree(q).query(q, k=min(_NEIGHBOURS + 1, len(q)))
    one = np.repeat(np.arange(len(q)), near.shape[1] - 1)
    two, length = near[:, 1:].ravel(), apart[:, 1:].ravel()
    sigma = _sigma(space, q)
    free = np.concatenate(
        [
            same_sign(space, q[one[i : i + 2048]], q[two[i : i + 2048]], _SAMPLES)
            for i in range(0, len(one), 2048)
        ]
    )
    lines: list[dict[int, float]] = [{} for _ in q]
    for i, j, way in zip(one[free], two[free], length[free], strict=True):
        # far from singularities a line is cheap
        cost = float(way / min(sigma[i], sigma[j]))
        lines[i][int(j)] = lines[j][int(i)] = cost
    return lines
