"""How J changes with the joints."""

from __future__ import annotations

import numpy as np

from kinlab.arrays import Array


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
