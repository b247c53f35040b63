"""Time-optimal motions along a path in joint space by toppra (the optional extra ``motion``).

Source: Pham and Pham, *A New Approach to Time-Optimal Path Parameterization Based on Reachability
Analysis*, IEEE T-RO 2018. Toppra answers with the squared speed at a grid of path positions and
the path acceleration between them; the curve in time follows from those in closed form. Limits
hold at the grid; between its points the curve may pass them by little, so it is slowed down as a
whole until they hold at all times.
"""

from __future__ import annotations

import logging
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from kinlab.arrays import Array
from kinlab.errors import MissingExtraError, OptionError
from kinlab.motion.limits import Limits, within_time_limits
from kinlab.motion.record import hermite

GRID = 800
"""Path positions of the grid, points of the path included beside them."""


def plan(rows: Array, limits: Limits) -> Any:
    """The fastest curve, on a grid, along the cubic spline through (K, n), from rest to rest.

    Raises:
        MissingExtraError: toppra is not installed. OptionError: it finds no motion.
    """
    try:
        import toppra
        from toppra import algorithm, constraint
    except ImportError:
        raise MissingExtraError(
            "time-optimal motions need toppra: install it with pip install 'kinlab[motion]'"
        ) from None
    logging.getLogger("toppra").setLevel(logging.ERROR)
    progress = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(rows, axis=0), axis=1))])
    progress /= progress[-1]
    path = CubicSpline(progress, rows, bc_type=path_ends(rows))
    grid = np.unique(np.concatenate([np.linspace(0.0, 1.0, GRID + 1), progress]))
    grid = grid[np.concatenate([[True], np.diff(grid) > 1e-9])]
    bounds = [
        constraint.JointVelocityConstraint(np.stack([-limits.velocity, limits.velocity], axis=1)),
        constraint.JointAccelerationConstraint(
            np.stack([-limits.acceleration, limits.acceleration], axis=1),
            discretization_scheme=constraint.DiscretizationType.Interpolation,
        ),
    ]
    solver = algorithm.TOPPRA(
        bounds, toppra.SplineInterpolator(progress, rows, bc_type=path_ends(rows)), gridpoints=grid
    )
    _, speeds, _ = solver.compute_parameterization(0.0, 0.0)
    if speeds is None or not np.isfinite(speeds).all():
        raise OptionError("time-optimal motion: toppra finds no speed that holds the limits")
    return within_time_limits(_in_time(path, grid, np.asarray(speeds)), limits)


def path_ends(rows: Array) -> str:
    """How the spline ends: without curvature, or for two points as the line they give."""
    return "natural" if len(rows) > 2 else "not-a-knot"


def _in_time(path: Any, grid: Array, speeds: Array) -> Any:
    """q(s(t)) with constant path acceleration between grid points, as pieces of fifth degree."""
    steps = 2.0 * np.diff(grid) / (speeds[:-1] + speeds[1:])
    times = np.concatenate([[0.0], np.cumsum(steps)])
    gains = np.diff(speeds**2) / (2.0 * np.diff(grid))  # consistent with the speeds to rounding
    q, tangent, bend = (np.asarray(path(grid, order)) for order in range(3))
    v = tangent * speeds[:, np.newaxis]
    curved = bend * speeds[:, np.newaxis] ** 2
    after = (
        np.concatenate([tangent[:-1] * gains[:, np.newaxis], np.zeros((1, q.shape[1]))]) + curved
    )
    before = (
        np.concatenate([np.zeros((1, q.shape[1])), tangent[1:] * gains[:, np.newaxis]]) + curved
    )
    return hermite(times, q, v, before, after)
