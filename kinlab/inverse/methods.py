"""One step of each method, and nothing else: J and e in, the change of q out.

Each takes the Jacobian (r, m) of the r coordinates asked for and the m joints that may move,
and the error e (r,) = x_d - f(q). Metres are divided by a length of the arm in both.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from kinlab.arrays import Array, real_array
from kinlab.errors import NameUnknownError, OptionError, near

DAMPING = 0.1
"""mu = DAMPING * E + FLOOR; from 0.03 to 0.3 the number of iterations is flat."""

SETTLE = 100
"""Iterations at most to bring a failed search to rest, for the closest pose."""

FLOOR = 1e-9
"""Keeps J^T J + mu 1 invertible at a singular solution; larger ones slow the last steps there."""

Step = Callable[[Array, Array], Array]


def newton(jac: Array, error: Array) -> Array:
    """dq = J^-1 e; with the right or left inverse where J is not square (note 000, 000.newton).

    A redundant arm (m > r) takes J^T (J J^T)^-1, the smallest dq; one with fewer joints than
    coordinates (m < r) takes (J^T J)^-1 J^T, the least squares. The note prints the second for
    the redundant case (000.pinv).

    Raises:
        numpy.linalg.LinAlgError: J is exactly singular.
    """
    r, m = jac.shape
    if r == m:
        return _solve(jac, error)
    if r < m:
        return jac.T @ _solve(jac @ jac.T, error)
    return _solve(jac.T @ jac, jac.T @ error)


def gradient(jac: Array, error: Array, alpha: float) -> Array:
    """dq = alpha J^T e, the gradient of ||e||^2 / 2 with a fixed step (note 000, 000.grad).

    It descends where alpha < 2 / sigma_max(J)^2.
    """
    return alpha * (jac.T @ error)


def gradient_exact(jac: Array, error: Array) -> Array:
    """dq = alpha J^T e with the alpha that minimises ||e - alpha J J^T e|| along the line.

    alpha = <e, J J^T e> / ||J J^T e||^2 (Buss 2004, "Introduction to inverse kinematics with
    Jacobian transpose, pseudoinverse and damped least squares methods", section 4).
    """
    downhill = jac.T @ error
    motion = jac @ downhill
    square = float(motion @ motion)
    return downhill * (float(error @ motion) / square) if square > 0.0 else downhill


def lm(jac: Array, error: Array) -> Array:
    """(J^T J + mu 1) dq = J^T e with mu = DAMPING ||e||^2 / 2 + FLOOR (Sugihara 2011)."""
    damped = jac.T @ jac
    damped[np.diag_indices_from(damped)] += 0.5 * DAMPING * float(error @ error) + FLOOR
    return _solve(damped, jac.T @ error)


def _solve(matrix: Array, right: Array) -> Array:
    solution: Any = np.linalg.solve(matrix, right)  # numpy's stub loses the float64
    return np.asarray(solution)


METHODS: dict[str, Step] = {"newton": newton, "gradient": gradient_exact, "lm": lm}
"""Name to step; ``gradient`` with a fixed alpha is made by :func:`choose`."""

ITERATIONS = {"newton": 60, "gradient": 5000, "lm": 60}
"""Iterations of one search, where the caller sets none."""

PATIENCE = {"newton": 10, "gradient": 1000, "lm": 5}
"""A search whose squared error has not halved in so many iterations has stalled."""


def choose(method: Any, alpha: Any) -> Step:
    """The step function of a method.

    Args:
        method: ``"lm"``, ``"newton"`` or ``"gradient"``.
        alpha: for the gradient: ``"exact"``, or a fixed positive number.

    Raises:
        NameUnknownError: another method.
        OptionError: an alpha that is neither, or one given to another method.
    """
    if not isinstance(method, str) or method not in METHODS:
        raise NameUnknownError(f"method {method!r} is unknown; {near(str(method), METHODS)}")
    if isinstance(alpha, str) and alpha == "exact":
        return METHODS[method]
    if method != "gradient":
        raise OptionError(f"alpha belongs to method 'gradient'; leave it out for {method!r}")
    if isinstance(alpha, (str, bool)):
        raise OptionError(f"alpha is {alpha!r}; give 'exact' or a positive number")
    value = real_array(alpha, "alpha", OptionError)
    if value.shape != () or not 0.0 < float(value) < math.inf:
        raise OptionError(f"alpha is {alpha!r}; give 'exact' or a positive number")
    return partial(gradient, alpha=float(value))
