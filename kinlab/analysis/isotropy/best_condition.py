"""The least condition number an arm can reach, by smooth minimisation from many starts.

The condition number has kinks where singular values cross, and its minimisers sit on them. The
p-norm condition number (trace (J J^T)^p * trace (J J^T)^-p)^(1/2p) is smooth, bounds it from
above and tends to it as p grows. Every start is brought down on it (all at once, by BFGS within
the limits), the lowest that differ are followed to the kink.

Starts come in blocks of one sequence, and the search stops after a block once the best was met
often enough. Whatever lies within the p-norm's own error of the lowest end is followed, hence more
starts never give a worse answer, but for the rounding of the last minimisation.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.analysis.isotropy.system import LengthChoice
from kinlab.analysis.metrics import condition_number, singular_values
from kinlab.analysis.solver import jacobian_derivative
from kinlab.analysis.structure.task_space import TaskSpace, search_box
from kinlab.arrays import Array
from kinlab.engine.fast.stacks import jacobian
from kinlab.host.progress import pulse
from kinlab.tolerances import TOLERANCES

_TOGETHER = (1.0, 8.0, 64.0, 512.0)
"""Powers through which all starts go."""
_ROUNDS = 40
"""Steps of each."""
_POWERS = (512.0, 4096.0, 3.2e4, 2.6e5, 2e6, 2e7)
"""Each minimisation starts where the one before ended. At 2e7 the surrogate of six equal
singular values is 1e-7 above the condition number, and its minimiser as near."""
_FOLLOWED = 5
"""The lowest of each block that are followed to the end, of those with different values; more where
they lie so near that p = 512 cannot tell which of them is the least."""
BLOCK = 200
"""Starts of a block."""
ENOUGH = 5
"""The search stops after the block in which the best was met for the fifth time."""


@dataclass(frozen=True)
class LeastCondition:
    """Answer of :func:`least_condition`.

    Attributes:
        q: (n,). length: metres. condition: the condition number there.
        starts: how many were brought down. met: how many of them ended at the best.
        ends: where all of them ended, (starts,), at p = 512.
    """

    q: Array
    length: float
    condition: float
    starts: int
    met: int
    ends: Array


def least_condition(
    space: TaskSpace, length: float | None, rng: np.random.Generator, starts: int
) -> LeastCondition:
    """The least condition number found within the limits.

    Args:
        space: the task.
        length: the given characteristic length, or ``None`` to minimise over it too.
        rng: source of the starts.
        starts: most starts.
    """
    choice = LengthChoice(space, length)
    lower, upper = search_box(space.robot)
    best: tuple[float, Array, float] | None = None
    lowest, ends = np.inf, np.empty(0)
    while len(ends) < starts:
        # a whole block is drawn even if less is used: the sequence is the same for every effort
        drawn = rng.uniform(lower, upper, (BLOCK, space.robot.n))[: starts - len(ends)]
        x = choice.start(drawn)
        for power in _TOGETHER:
            x, value = _descend_together(choice, x, power)
        ends = np.concatenate([ends, np.exp(value)])
        for number in _different(value, np.log(space.m) / _TOGETHER[-1]):
            state, size = _follow(choice, x[number])
            reached = float(condition_number(singular_values(space.jacobian(state, size))))
            if best is None or reached < best[0] * (1.0 - 1e-12):
                if best is None or reached < best[0] * (1.0 - 1e-6):
                    lowest = float(np.exp(value[number]))
                best = reached, state, size
        met = int(np.sum(ends <= lowest * (1.0 + 0.1 * TOLERANCES.same_minimum)))
        if met >= ENOUGH:
            break
    assert best is not None
    return LeastCondition(best[1], best[2], best[0], len(ends), met, ends)


def _box(space: TaskSpace, width: int) -> tuple[Array, Array]:
    lower, upper = search_box(space.robot)
    if width == space.robot.n:
        return lower, upper
    centre = np.log(space.scale)
    return np.append(lower, centre - 7.0), np.append(upper, centre + 7.0)


def _different(value: Array, error: float) -> list[int]:
    """The lowest ends whose values differ: the same value is the same pose up to a symmetry.

    Args:
        value: logarithms of the p-norm condition numbers, (N,).
        error: by how much these may lie above those of the condition number itself.
    """
    chosen: list[int] = []
    for number in np.argsort(value, kind="stable"):
        if len(chosen) >= _FOLLOWED and value[number] > value[chosen[0]] + error:
            break
        if all(abs(value[number] - value[k]) > 0.1 * TOLERANCES.same_minimum for k in chosen):
            chosen.append(int(number))
    return chosen


def _descend_together(choice: LengthChoice, x: Array, power: float) -> tuple[Array, Array]:
    """BFGS within the limits on every row of x (N, k); returns x and the values (N,)."""
    lower, upper = _box(choice.space, x.shape[1])
    x = np.clip(x, lower, upper)
    value, derivative = _surrogate(x, choice, power)
    inverse = np.broadcast_to(np.eye(x.shape[1]), (len(x), *[x.shape[1]] * 2)).copy()
    size = np.full(len(x), 0.3)
    for _ in range(_ROUNDS):
        pulse()
        held = ((x <= lower) & (derivative > 0.0)) | ((x >= upper) & (derivative < 0.0))
        free = np.where(held, 0.0, derivative)
        step = -np.einsum("nij,nj->ni", inverse, free)
        step = np.where(held, 0.0, step)
        ascending = np.einsum("ni,ni->n", step, free) >= 0.0
        inverse[ascending] = np.eye(x.shape[1])
        step = np.where(ascending[:, np.newaxis], -free, step)
        largest = np.abs(step).max(axis=1)
        step *= np.minimum(1.0, size / np.maximum(largest, 1e-300))[:, np.newaxis]
        trial = np.clip(x + step, lower, upper)
        new, new_derivative = _surrogate(trial, choice, power)
        better = new < value
        moved, turned = trial - x, new_derivative - derivative
        inverse = _bfgs(inverse, moved, turned, better)
        size = np.where(better, np.minimum(0.5, 2.0 * size), 0.25 * np.minimum(size, largest))
        x = np.where(better[:, np.newaxis], trial, x)
        value = np.where(better, new, value)
        derivative = np.where(better[:, np.newaxis], new_derivative, derivative)
    return x, value


def _bfgs(inverse: Array, moved: Array, turned: Array, better: Any) -> Array:
    along = np.einsum("ni,ni->n", moved, turned)
    sound = better & (along > 1e-14)
    rho = np.where(sound, 1.0 / np.where(sound, along, 1.0), 0.0)[:, np.newaxis, np.newaxis]
    left = np.eye(moved.shape[1]) - rho * moved[:, :, np.newaxis] * turned[:, np.newaxis, :]
    new = left @ inverse @ left.swapaxes(1, 2)
    new = new + rho * moved[:, :, np.newaxis] * moved[:, np.newaxis, :]
    return np.where(sound[:, np.newaxis, np.newaxis], new, inverse)


def _follow(choice: LengthChoice, x: Array) -> tuple[Array, float]:
    """To the kink, through growing powers: q (n,) and the length."""
    from scipy.optimize import minimize  # `import kinlab` does not wait for scipy

    bounds = list(zip(*_box(choice.space, len(x)), strict=True))

    def cost(y: Array, power: float) -> tuple[float, Array]:
        value, derivative = _surrogate(y[np.newaxis], choice, power)
        return float(value[0]), derivative[0]

    for power in _POWERS:
        answer = minimize(
            cost,
            x,
            args=(power,),
            jac=True,
            method="L-BFGS-B",
            bounds=bounds,
            options={"maxiter": 300, "ftol": 1e-15},
        )
        x = answer.x
    return x[: choice.space.robot.n], float(choice.length(x[np.newaxis])[0])


def _surrogate(x: Array, choice: LengthChoice, power: float) -> tuple[Array, Array]:
    """ln of the p-norm condition number (N,), and its gradient (N, k)."""
    space, size = choice.space, choice.length(x)
    full = jacobian(space.robot, x[:, : space.robot.n])
    matrix = space.select(full, size)
    change = space.select(jacobian_derivative(full), size[:, np.newaxis])
    change = choice.with_length(change, matrix)
    left, sigma, right = np.linalg.svd(matrix, full_matrices=False)
    flat = sigma[:, -1] < 1e-12 * sigma[:, 0]
    sigma = np.where(flat[:, np.newaxis], 1.0, sigma)
    log = np.log(sigma)
    # d ln sigma_i / d x_k
    inner = np.einsum("nmi,nkmj->nkij", left, change)
    derivative = np.einsum("nkij,nij->nki", inner, right) / sigma[:, np.newaxis]
    high, low = 2.0 * power * (log - log[:, :1]), -2.0 * power * (log - log[:, -1:])
    top, bottom = np.exp(high), np.exp(low)
    sums = np.log(top.sum(axis=1)) + np.log(bottom.sum(axis=1))
    value = sums / (2.0 * power) + log[:, 0] - log[:, -1]
    weight = top / top.sum(axis=1, keepdims=True) - bottom / bottom.sum(axis=1, keepdims=True)
    gradient = np.einsum("nki,ni->nk", derivative, weight)
    # a singular start stays where it is, and is never best
    return np.where(flat, 60.0, value), np.where(flat[:, np.newaxis], 0.0, gradient)
