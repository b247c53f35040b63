"""Newton's method that stays on one branch of solutions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kinlab.arrays import Array

Residual = Callable[[Array], tuple[Array, Array]]
_STEPS = 30
_LEAST_STRIDE = 1e-6


def lead_to_zero(
    residual: Residual, start: Array, inside: Callable[[Array], bool], tolerance: float
) -> tuple[Array, float]:
    """Leads a residual to zero along a straight line, in one go where Newton manages that.

    Where the Jacobian is regular on the whole branch, the residual can follow any line that the
    branch can reach; a step that Newton cannot make, or that leaves the branch, is halved.

    Args:
        residual: x (n,) to the residual (n,) and its Jacobian (n, n).
        start: a point of the branch, (n,).
        inside: whether a point is on the branch.
        tolerance: norm of the residual that is wanted.

    Returns:
        The point, and the norm of the residual that is left there: above the tolerance where
        the line leaves the branch.
    """
    x, (first, _) = start, residual(start)
    done, stride = 0.0, 1.0
    while done < 1.0 and stride > _LEAST_STRIDE:
        goal = min(1.0, done + stride)
        found = _newton(residual, x, (1.0 - goal) * first, inside, tolerance)
        if found is None:
            stride *= 0.5
        else:
            x, done, stride = found, goal, 2.0 * stride
    return x, float(np.linalg.norm(residual(x)[0]))


def _newton(
    residual: Residual, x: Array, goal: Array, inside: Callable[[Array], bool], tolerance: float
) -> Array | None:
    """Newton until the residual is ``goal``; None if it leaves the branch or does not get there."""
    before = np.inf
    for _ in range(_STEPS):
        value, slope = residual(x)
        left = float(np.linalg.norm(value - goal))
        if left <= 1e-3 * tolerance:
            return x
        if left > 0.5 * before:  # not converging, or as near as rounding lets it
            return x if left <= tolerance else None
        before = left
        x = x - np.linalg.solve(slope, value - goal)
        if not inside(x):
            return None
    return None
