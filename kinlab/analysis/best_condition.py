"""The least condition number an arm can reach, by smooth minimisation from many starts.

The condition number has kinks where singular values cross, and its minimisers sit on them. The
p-norm condition number (trace (J J^T)^p * trace (J J^T)^-p)^(1/2p) is smooth, bounds it from
above and tends to it as p grows.
"""

from __future__ import annotations

import numpy as np

from kinlab.analysis.derivatives import jacobian_derivative
from kinlab.analysis.metrics import condition_number, singular_values
from kinlab.arrays import Array
from kinlab.kinematics import jacobian
from kinlab.structure.task_space import TaskSpace, search_box

_POWERS = (1.0, 8.0, 64.0, 512.0, 4096.0, 3.2e4, 2.6e5, 2e6, 2e7)
"""Each minimisation starts where the one before ended. At 2e7 the surrogate of six equal
singular values is 1e-7 above the condition number, and its minimiser as near."""
_STARTS = 12
"""The best conditioned seeds that are minimised, of those with different singular values: the
same values mean the same pose up to a symmetry of the arm."""


def lower_condition(
    space: TaskSpace, length: float | None, q: Array, lengths: Array
) -> tuple[Array, Array, Array]:
    """Local minima of the condition number within the limits.

    Args:
        space: the task.
        length: the given characteristic length, or ``None`` to minimise over it too.
        q: starts, (N, n). lengths: their lengths, (N,).

    Returns:
        q (K, n), lengths (K,), condition numbers (K,).
    """
    lower, upper = search_box(space.robot)
    q = np.clip(q, lower, upper)
    sigma = singular_values(space.jacobian(q, lengths))
    condition = condition_number(sigma)
    alike = np.round(sigma / np.maximum(sigma[:, :1], 1e-300), 4)
    _, first = np.unique(alike, axis=0, return_index=True)
    order = first[np.argsort(condition[first], kind="stable")][:_STARTS]
    states, sizes, reached = [], [], []
    for number in order:
        state, size = _descend(space, length, q[number], float(lengths[number]))
        sigma = singular_values(space.jacobian(state, size))
        states.append(state)
        sizes.append(size)
        reached.append(float(condition_number(sigma)))
    return np.array(states), np.array(sizes), np.array(reached)


def _descend(space: TaskSpace, length: float | None, q: Array, start: float) -> tuple[Array, float]:

    from scipy.optimize import minimize  # `import kinlab` does not wait for scipy

    lower, upper = search_box(space.robot)
    open_length = length is None and space.mixed
    x = np.append(q, np.log(start)) if open_length else q
    centre = np.log(space.scale)
    bounds = list(zip(lower, upper, strict=True))
    if open_length:
        bounds.append((centre - 7.0, centre + 7.0))
    for power in _POWERS:
        answer = minimize(
            _surrogate, x, args=(space, power, open_length, start), jac=True,
            method="L-BFGS-B", bounds=bounds, options={"maxiter": 300, "ftol": 1e-15},
        )  # fmt: skip
        x = answer.x
    return x[: space.robot.n], float(np.exp(x[-1])) if open_length else start


def _surrogate(
    x: Array, space: TaskSpace, power: float, open_length: bool, length: float
) -> tuple[float, Array]:
    """ln of the p-norm condition number, and its gradient."""
    q = x[: space.robot.n]
    size = float(np.exp(x[-1])) if open_length else length
    full = jacobian(space.robot, q)
    matrix = space.select(full, size)
    change = space.select(jacobian_derivative(full), size)
    if open_length:
        change = np.concatenate([change, (-matrix * space.metres)[np.newaxis]])
    left, sigma, right = np.linalg.svd(matrix, full_matrices=False)
    if sigma[-1] < 1e-12 * sigma[0]:
        return 60.0, np.zeros(len(x))  # a singular start stays where it is, and is never best
    log = np.log(sigma)
    slope = np.einsum("mi,kmn,in->ki", left, change, right) / sigma  # d ln sigma_i / dx_k
    high, low = 2.0 * power * (log - log[0]), -2.0 * power * (log - log[-1])
    top, bottom = np.exp(high), np.exp(low)
    value = (np.log(top.sum()) + np.log(bottom.sum())) / (2.0 * power) + log[0] - log[-1]
    gradient = slope @ (top / top.sum()) - slope @ (bottom / bottom.sum())
    return float(value), gradient
