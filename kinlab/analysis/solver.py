"""A batched Levenberg-Marquardt for many small systems at once, square or not.

Damping in proportion to the residual (Fan & Yuan, Computing 74, 2005) keeps the convergence
quadratic on solutions that are not isolated, as curves and surfaces of singularities are. Steps
are the shortest ones, by singular values.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kinlab.arrays import Array
from kinlab.host.progress import pulse

System = Callable[[Array], tuple[Array, Array]]
"""x (N, k) to residuals (N, p) and their derivatives (N, p, k)."""


def solve(
    system: System, start: Array, *, iterations: int = 60, goal: float = 1e-15
) -> tuple[Array, Array]:
    """Reduces each row's residual as far as it goes.

    Args:
        system: residuals and derivatives, both of order one.
        start: (N, k).
        iterations: most steps.
        goal: norm of the residual at which a row is left alone.

    Returns:
        x (N, k) and the norms (N,) reached.
    """
    x = np.array(start, dtype=np.float64)
    if not len(x):
        return x, np.empty(0)
    residual, derivative = system(x)
    norm = np.linalg.norm(residual, axis=1)
    damping = np.full(len(x), 1e-2)
    stalled = np.zeros(len(x), dtype=np.int64)
    for _ in range(iterations):
        pulse()
        active = np.flatnonzero((norm > goal) & (stalled < 8))
        if not len(active):
            break
        step = _step(residual[active], derivative[active], damping[active] * norm[active])
        trial = x[active] + step
        trial_residual, trial_slope = system(trial)
        trial_norm = np.linalg.norm(trial_residual, axis=1)
        better = trial_norm < norm[active]
        accepted, lost = active[better], active[~better]
        x[accepted], residual[accepted], derivative[accepted] = (
            trial[better],
            trial_residual[better],
            trial_slope[better],
        )
        norm[accepted] = trial_norm[better]
        damping[accepted] *= 0.2
        damping[lost] *= 6.0
        stalled[accepted] = 0
        stalled[lost] += 1
    return x, norm


def _step(residual: Array, derivative: Array, damping: Array) -> Array:
    left, values, right = np.linalg.svd(derivative, full_matrices=False)
    # the floor only keeps 0/0 away; values this small carry no direction
    floor = 1e-15 * np.maximum(values[:, :1], 1e-300)
    gain = values / (values**2 + damping[:, np.newaxis] + floor**2)
    projected = np.einsum("npi,np->ni", left, residual)
    step: Array = -np.einsum("nik,ni->nk", right, gain * projected)
    return step


def jacobian_derivative(full: Array) -> Array:
    """Partial derivatives of a base-frame Jacobian, from the Jacobian alone.

    With column i = (v_i, w_i): for j <= i, d(v_i, w_i)/dq_j = (w_j x v_i, w_j x w_i); for
    j > i, d v_i/dq_j = w_i x v_j and d w_i/dq_j = 0. Holds for prismatic columns too (w = 0).
    Haviland & Corke, "Manipulator differential kinematics, part 2", IEEE RAM 2023, section II.

    Args:
        full: (..., 6, n), ``frame="base"``.

    Returns:
        (..., n, 6, n): entry [..., j, :, i] is d J[:, i] / d q_j.
    """
    v, w = np.swapaxes(full[..., :3, :], -1, -2), np.swapaxes(full[..., 3:, :], -1, -2)
    n = full.shape[-1]
    j, i = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    behind = (j <= i)[..., np.newaxis]
    turned = np.cross(w[..., :, np.newaxis, :], v[..., np.newaxis, :, :])  # [j, i] = w_j x v_i
    linear = np.where(behind, turned, np.swapaxes(turned, -3, -2))
    angular = np.cross(w[..., :, np.newaxis, :], w[..., np.newaxis, :, :]) * behind
    return np.swapaxes(np.concatenate([linear, angular], axis=-1), -1, -2)
