"""The singular set as a smooth system of equations, and where to start solving it.

det J = 0 has no useful form for redundant arms, and sigma_min is not differentiable at zero. The
set is the shadow of the smooth system

    J(q)^T u = 0,   u^T u = 1        (left null vector; J v = 0 where the arm has fewer joints
                                      than task rows)

in (q, u). Sheets of the set that cross in q (wrist and elbow, say) do not cross in (q, u), for
their null vectors differ. Newton on it converges quadratically wherever d sigma_min/dq != 0.

Which joints hold a singularity: the fewest whose values keep the arm singular whatever the
others do.

A first-order tangent cannot say so (at an extremum of a sheet it calls a joint free that is not).
Here the other joints are moved, far and at random within their limits, and sigma_min is looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from kinlab.analysis.solver import jacobian_derivative, solve
from kinlab.analysis.structure.task_space import TaskSpace, revolute, search_box, wrap
from kinlab.arrays import Array, between
from kinlab.engine.fast.stacks import jacobian
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True)
class SingularSystem:
    """The equations for one task, over all joints or over a few with the rest held.

    Attributes:
        space: the task.
        moving: indices of the joints that are unknown.
        held: (n,), values of the others.
    """

    space: TaskSpace
    moving: tuple[int, ...]
    held: Array

    @property
    def codimension(self) -> int:
        """How many equations in q a rank drop is: |m - n| + 1."""
        return abs(self.space.m - self.space.robot.n) + 1

    def states(self, x: Array) -> Array:
        """Full joint vectors (N, n) of the unknowns (N, k)."""
        q = np.repeat(self.held[np.newaxis], len(x), axis=0)
        q[:, list(self.moving)] = x[:, : len(self.moving)]
        return q

    def start(self, q: Array) -> Array:
        """Unknowns (N, k) at q (N, n): u is the null vector that fits best."""
        matrix = self.space.jacobian(q, self.space.scale)
        left, _, right = np.linalg.svd(matrix)
        wide = self.space.m <= self.space.robot.n
        u = left[:, :, -1] if wide else right[:, -1, :]
        return np.concatenate([q[:, list(self.moving)], u], axis=1)

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Residuals (N, p) and their derivatives (N, p, k)."""
        count, free = len(x), len(self.moving)
        u = x[:, free:]
        full = jacobian(self.space.robot, self.states(x))
        matrix = self.space.select(full, self.space.scale)
        change = jacobian_derivative(full)[:, list(self.moving)]
        derivative = self.space.select(change, self.space.scale)  # (N, free, m, n)
        if self.space.m <= self.space.robot.n:
            null, slope = matrix.swapaxes(1, 2), np.einsum("njmi,nm->nij", derivative, u)
        else:
            null, slope = matrix, np.einsum("njmi,ni->nmj", derivative, u)
        equations = null.shape[1]
        residual = np.empty((count, equations + 1))
        residual[:, :equations] = np.einsum("nij,nj->ni", null, u)
        residual[:, equations] = 0.5 * (np.einsum("ni,ni->n", u, u) - 1.0)
        jac = np.zeros((count, equations + 1, x.shape[1]))
        jac[:, :equations, :free] = slope
        jac[:, :equations, free:] = null
        jac[:, equations, free:] = u
        return residual, jac


def whole_system(space: TaskSpace) -> SingularSystem:
    """The system with every joint unknown."""
    n = space.robot.n
    return SingularSystem(space, tuple(range(n)), np.zeros(n))


def project(system: SingularSystem, q: Array, rounds: int = 4) -> tuple[Array, Array]:
    """Newton from each q to the singular set, kept inside the joint limits.

    Args:
        system: the equations.
        q: (N, n).
        rounds: how often a solution outside the limits is put back on them and solved again.

    Returns:
        Unknowns (N, k), revolute joints wrapped by whole turns, and for each row whether it
        satisfies the equations within the limits; rows that do not are not solutions.
    """
    robot = system.space.robot
    lower, upper = search_box(robot)
    x = system.start(q)
    good = np.zeros(len(x), dtype=bool)
    todo = np.arange(len(x))
    for _ in range(rounds):
        solved, norm = solve(system, x[todo])
        states = wrap(robot, system.states(solved))
        solved[:, : len(system.moving)] = states[:, list(system.moving)]
        inside = between(states, lower, upper, TOLERANCES.limit_rounding)
        done = inside.all(axis=1) & (norm <= TOLERANCES.on_singular_set)
        x[todo[done]], good[todo[done]] = solved[done], True
        todo, states = todo[~done], states[~done]
        if not len(todo):
            break
        x[todo] = system.start(np.clip(states, lower, upper))
    return x, good


def seeds(system: SingularSystem, rng: np.random.Generator, points: int, steps: int = 36) -> Array:
    """Where to start: least sigma along lines parallel to every joint axis, and random points.

    Every factor of a determinant depends on some joint, and the line along that joint crosses its
    zeros from most points: scanning all joints from a few points meets factors that random
    projection, which runs to the nearest one, leaves out. A factor whose zeros span a small part
    of the other joints' ranges can still be missed.

    Args:
        system: the equations.
        rng: source of the points.
        points: how many; n lines go through each.
        steps: samples along a line.

    Returns:
        (N, n).
    """
    robot = system.space.robot
    lower, upper = search_box(robot)
    # stratified: each joint's range is cut into `points` parts and every part is used once
    strata = np.stack([rng.permutation(points) for _ in range(robot.n)], axis=1)
    drawn = lower + (upper - lower) * (strata + rng.random((points, robot.n))) / points
    base = system.states(drawn[:, list(system.moving)])
    found = [base]
    for j in system.moving:
        grid = np.linspace(lower[j], upper[j], steps)
        line = np.repeat(base, steps, axis=0)
        line[:, j] = np.tile(grid, points)
        least = system.space.sigma(line)[:, -1].reshape(points, steps)
        padded = np.pad(least, ((0, 0), (1, 1)), constant_values=np.inf)
        dip = (least <= padded[:, :-2]) & (least <= padded[:, 2:])
        found.append(line.reshape(points, steps, robot.n)[dip])
    return np.concatenate(found)


def normal_projector(system: SingularSystem, x: Array) -> tuple[Array, int]:
    """Projector onto the directions in q that leave the singular set, and its rank.

    Args:
        system: the equations.
        x: one solution, (k,).

    Returns:
        (free, free) projector over the moving joints, and its rank.
    """
    free = len(system.moving)
    _, slope = system(x[np.newaxis])
    _, values, right = np.linalg.svd(slope[0])
    rank = int(np.sum(values > 1e-7 * values[0]))
    tangent = right[rank:, :free]
    left, sizes, _ = np.linalg.svd(tangent.T, full_matrices=True)
    spanned = int(np.sum(sizes > 1e-7)) if sizes.size else 0
    normal = left[:, spanned:]
    return normal @ normal.T, free - spanned


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
        found += [
            g for g, r in zip(groups, ratio, strict=True) if r.max() <= TOLERANCES.stays_singular
        ]
    return tuple(found) or (tuple(range(n)),)


def pinned(space: TaskSpace, q: Array, held: tuple[int, ...]) -> bool:
    """Whether the values of these joints are isolated: no motion of them stays on the set.

    Judged at a state in general position of the others, by the rank of the equations.
    """
    if len(held) == 1:
        return True
    system = whole_system(space)
    ranks = []
    for state in elsewhere(space, q, held, 3):
        x, norm = solve(system, system.start(state[np.newaxis]), iterations=5)
        if norm[0] <= 1e-9:
            ranks.append(normal_projector(system, x[0])[1])
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
        starts = grid[_local_minima(ratio, full[0], full[1]).ravel()]
        if not len(starts):
            continue
        system = _TwoLost(space, pair, others)
        x, norm = solve(system, system.start(starts), iterations=40)
        values = wrap(robot, _placed(robot.n, pair, x[:, :2]))[:, list(pair)]
        inside = between(values, lower[list(pair)], upper[list(pair)], TOLERANCES.limit_digits)
        for value in values[inside.all(axis=1) & (norm <= TOLERANCES.on_singular_set)]:
            state = others[0].copy()
            state[list(pair)] = np.clip(value, lower[list(pair)], upper[list(pair)])
            if holds(space, state, pair):
                yield pair, state


class _TwoLost:
    """Singular at two states of the other joints with the same values of a pair."""

    def __init__(self, space: TaskSpace, pair: tuple[int, int], others: Array) -> None:
        self.parts = [SingularSystem(space, pair, state) for state in others]

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


def _local_minima(values: Array, round_one: bool, round_two: bool) -> Array:
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
    return bool(_ratio(space, states).max() <= TOLERANCES.stays_singular)


def _ratio(space: TaskSpace, states: Array) -> Array:
    sigma = space.sigma(states)
    return sigma[:, -1] / np.maximum(sigma[:, 0], 1e-300)
