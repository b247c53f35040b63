"""Which joints hold a singularity: the fewest whose values keep the arm singular whatever the
others do.

A first-order tangent cannot say so (at an extremum of a sheet it calls a joint free that is not).
Here the other joints are moved, far and at random within their limits, and sigma_min is looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from kinlab.analysis import singular_set as sets
from kinlab.analysis.solver import solve
from kinlab.arrays import Array
from kinlab.structure.task_space import TaskSpace, revolute, search_box, wrap

STAYS = 1e-9
"""sigma_min / sigma_max up to which the arm stayed singular; the held joints are known to 1e-12."""
_ELSEWHERE = 5
"""States of the other joints that are tried: one in general position is enough almost surely."""
_GRID = 25
"""Values of each joint of a pair that are scanned for a pinned pair."""


def elsewhere(space: TaskSpace, q: Array, held: tuple[int, ...], count: int = _ELSEWHERE) -> Array:
    """States (count, n) with the joints ``held`` at q's values, the others anywhere."""
    lower, upper = search_box(space.robot)
    states = np.random.default_rng(11).uniform(lower, upper, (count, space.robot.n))
    states[:, list(held)] = q[list(held)]
    return states


def holds(space: TaskSpace, q: Array, held: tuple[int, ...]) -> bool:
    """Whether the arm stays singular with these joints at q's values and the others anywhere."""
    return _all_singular(space, elsewhere(space, q, held))


def supports(space: TaskSpace, q: Array) -> tuple[tuple[int, ...], ...]:
    """The smallest groups of joints, none within another, each of which holds the singularity.

    Args:
        space: the task.
        q: a singular configuration, (n,).

    Returns:
        Groups of indices, the smaller first; all joints where nothing less does.
    """
    n = space.robot.n
    found: list[tuple[int, ...]] = []
    for size in range(n):
        groups = [
            g for g in combinations(range(n), size) if not any(set(f) <= set(g) for f in found)
        ]
        if not groups:
            break
        states = np.concatenate([elsewhere(space, q, g) for g in groups])
        ratio = _ratio(space, states).reshape(len(groups), _ELSEWHERE)
        found += [g for g, r in zip(groups, ratio, strict=True) if r.max() <= STAYS]
    return tuple(found) or (tuple(range(n)),)


def pinned(space: TaskSpace, q: Array, held: tuple[int, ...]) -> bool:
    """Whether the values of these joints are isolated: no motion of them stays on the set.

    Judged at a state in general position of the others, by the rank of the equations.
    """
    if len(held) == 1:
        return True
    system = sets.whole(space)
    ranks = []
    for state in elsewhere(space, q, held, 3):
        x, norm = solve(system, system.start(state[np.newaxis]), iterations=5)
        if norm[0] <= 1e-9:
            ranks.append(sets.normal_projector(system, x[0])[1])
    return bool(ranks) and max(ranks) >= len(held)


def pinned_pairs(space: TaskSpace) -> Iterator[tuple[tuple[int, int], Array]]:
    """Pairs of joints whose values alone make the arm singular, each with a state (n,).

    A redundant arm has them (s2 = c3 = 0 in an arm with spherical shoulder and wrist), and they
    are too thin for lines and random starts to meet: the plane of every pair is scanned at two
    states of the others, and each dip of the larger sigma_min is solved for both at once.
    """
    robot = space.robot
    lower, upper = search_box(robot)
    turns = revolute(robot)
    others = np.random.default_rng(12).uniform(lower, upper, (2, robot.n))
    for pair in combinations(range(robot.n), 2):
        lines = [np.linspace(lower[i], upper[i], _GRID) for i in pair]
        grid = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 2)
        states = np.repeat(others[:, np.newaxis], len(grid), axis=1)
        states[:, :, list(pair)] = grid
        ratio = _ratio(space, states.reshape(-1, robot.n)).reshape(2, _GRID, _GRID).max(axis=0)
        full = [turns[i] and upper[i] - lower[i] >= 2.0 * np.pi - 1e-9 for i in pair]
        starts = grid[_dips(ratio, full[0], full[1]).ravel()]
        if not len(starts):
            continue
        system = _Twice(space, pair, others)
        x, norm = solve(system, system.start(starts), iterations=40)
        values = wrap(robot, _placed(robot.n, pair, x[:, :2]))[:, list(pair)]
        inside = np.all(
            (values >= lower[list(pair)] - 1e-9) & (values <= upper[list(pair)] + 1e-9), axis=1
        )
        for value in values[inside & (norm <= sets.CONVERGED)]:
            state = others[0].copy()
            state[list(pair)] = np.clip(value, lower[list(pair)], upper[list(pair)])
            if holds(space, state, pair):
                yield pair, state


class _Twice:
    """Singular at two states of the other joints with the same values of a pair."""

    def __init__(self, space: TaskSpace, pair: tuple[int, int], others: Array) -> None:
        self.parts = [sets.SingularSystem(space, pair, state) for state in others]

    def start(self, grid: Array) -> Array:
        """Unknowns (N, 2 + 2 m): the pair and a null vector of each state."""
        full = []
        for part in self.parts:
            states = np.repeat(part.held[np.newaxis], len(grid), axis=0)
            states[:, list(part.moving)] = grid
            full.append(part.start(states)[:, 2:])
        return np.concatenate([grid, *full], axis=1)

    def __call__(self, x: Array) -> tuple[Array, Array]:
        width = (x.shape[1] - 2) // 2
        residuals, slopes = [], []
        for k, part in enumerate(self.parts):
            own = slice(2 + k * width, 2 + (k + 1) * width)
            residual, slope = part(np.concatenate([x[:, :2], x[:, own]], axis=1))
            whole = np.zeros((*slope.shape[:2], x.shape[1]))
            whole[:, :, :2], whole[:, :, own] = slope[:, :, :2], slope[:, :, 2:]
            residuals.append(residual)
            slopes.append(whole)
        return np.concatenate(residuals, axis=1), np.concatenate(slopes, axis=1)


def _placed(n: int, pair: tuple[int, int], values: Array) -> Array:
    states = np.zeros((len(values), n))
    states[:, list(pair)] = values
    return states


def _dips(values: Array, round_one: bool, round_two: bool) -> Array:
    """Where a grid is lowest among its eight neighbours, in the lower half; (a, b) of booleans."""
    padded = np.pad(values, 1, constant_values=np.inf)
    if round_one:
        padded[0, 1:-1], padded[-1, 1:-1] = values[-2], values[1]
    if round_two:
        padded[1:-1, 0], padded[1:-1, -1] = values[:, -2], values[:, 1]
    a, b = values.shape
    near = [padded[1 + i : 1 + i + a, 1 + j : 1 + j + b] for i in (-1, 0, 1) for j in (-1, 0, 1)]
    dip: Array = (values <= np.min(near, axis=0)) & (values < np.median(values))
    return dip


def _all_singular(space: TaskSpace, states: Array) -> bool:
    return bool(_ratio(space, states).max() <= STAYS)


def _ratio(space: TaskSpace, states: Array) -> Array:
    sigma = np.linalg.svd(space.jacobian(states, space.scale), compute_uv=False)
    ratio: Array = sigma[:, -1] / np.maximum(sigma[:, 0], 1e-300)
    return ratio
