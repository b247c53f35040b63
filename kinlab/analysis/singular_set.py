"""The singular set as a smooth system of equations, and where to start solving it.

det J = 0 has no useful form for redundant arms, and sigma_min is not differentiable at zero. The
set is the shadow of the smooth system

    J(q)^T u = 0,   u^T u = 1        (left null vector; J v = 0 where the arm has fewer joints
                                      than task rows)

in (q, u). Sheets of the set that cross in q (wrist and elbow, say) do not cross in (q, u), for
their null vectors differ. Newton on it converges quadratically wherever d sigma_min/dq != 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinlab.analysis.derivatives import jacobian_derivative
from kinlab.analysis.solver import solve
from kinlab.arrays import Array
from kinlab.fast.stacks import jacobian
from kinlab.structure.task_space import TaskSpace, search_box, wrap

CONVERGED = 1e-12
"""Norm of the residual, in the arm's own length unit, below which a solution is accepted; far
above rounding (1e-15), far below the 1e-10 that is promised for sigma_min / sigma_max."""


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


def whole(space: TaskSpace) -> SingularSystem:
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
        inside = np.all((states >= lower - ROUNDING) & (states <= upper + ROUNDING), axis=1)
        done = inside & (norm <= CONVERGED)
        x[todo[done]], good[todo[done]] = solved[done], True
        todo, states = todo[~done], states[~done]
        if not len(todo):
            break
        x[todo] = system.start(np.clip(states, lower, upper))
    return x, good


ROUNDING = 1e-12
"""rad or m by which a solution may miss a limit through rounding alone."""


def seeds(system: SingularSystem, rng: np.random.Generator, points: int, steps: int = 36) -> Array:
    """Where to start: least sigma along lines parallel to every joint axis, and random points.

    Every factor of a determinant depends on some joint, so the line along that joint through a
    point in general position crosses its zeros: scanning all joints from a few points meets
    each factor by construction, where random projection meets the nearest one only.

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
        matrix = system.space.jacobian(line, system.space.scale)
        least = np.linalg.svd(matrix, compute_uv=False)[:, -1].reshape(points, steps)
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
