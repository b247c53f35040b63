"""Ordinary differential equations in time, by scipy's DOP853, with stops and projections.

Dormand and Prince's method of order 8 with adaptive steps and a dense output of order 7; see
Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, section II.5.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from kinlab.arrays import Array
from kinlab.errors import OptionError
from kinlab.tolerances import TOLERANCES

Slope = Callable[[float, Array], Array]
MOST_STEPS = 200_000
_LOOKS = 9
"""Times inside a step at which a stop is looked for."""


class Stretch(NamedTuple):
    """An integration up to its last time, or to where it was stopped.

    Attributes:
        rows: states at the times that were passed, (K, m); the first is the start.
        t: where it ended. state: there, (m,).
        stopped: whether ``stop`` ended it.
    """

    rows: Array
    t: float
    state: Array
    stopped: bool


def integrate(
    slope: Slope,
    start: Array,
    times: Array,
    *,
    rtol: float = TOLERANCES.integrator_relative,
    atol: float = TOLERANCES.integrator_absolute,
    settle: Callable[[Array], Array] | None = None,
    stop: Callable[[float, Array], float] | None = None,
) -> Stretch:
    """Integrates y' = slope(t, y) from times[0] on and answers at the times.

    Args:
        slope: the derivative. start: y at times[0], (m,).
        times: (K,), growing, K at least 2.
        rtol, atol: bounds of the error of one step.
        settle: puts a state back onto what it must obey; after each step and at each answer.
        stop: ends the integration where it becomes negative.

    Raises:
        OptionError: more than 200,000 steps, or a step that would become too small: the slope
            is stiff, or jumps too often.
    """
    solver = DOP853(slope, float(times[0]), start, float(times[-1]), rtol=rtol, atol=atol)
    rows, passed = [start], 1
    for _ in range(MOST_STEPS):
        solver.step()
        if solver.status == "failed":
            break
        inside = solver.dense_output()
        reached = float(solver.t)
        ends = None if stop is None else _first_negative(stop, inside, solver.t_old, reached)
        reached = reached if ends is None else ends
        upto = int(np.searchsorted(times, reached, "right"))
        here = [np.asarray(inside(t)) for t in times[passed:upto]]
        rows.extend(here if settle is None else [settle(y) for y in here])
        passed = max(passed, upto)
        if ends is not None:
            return Stretch(np.array(rows), reached, np.asarray(inside(reached)), True)
        if settle is not None:
            solver.y = settle(solver.y)
            solver.f = slope(solver.t, solver.y)
        if solver.status == "finished":
            return Stretch(np.array(rows), reached, np.asarray(solver.y), False)
    raise OptionError(
        f"the integration does not get past t = {solver.t:.6g} s: the torque is too stiff, or "
        "jumps too often, for an explicit method; soften its gains, or shorten the duration"
    )


def _first_negative(
    stop: Callable[[float, Array], float], inside: Callable[[float], Array], low: float, high: float
) -> float | None:
    """The first time in a step at which ``stop`` falls below zero, by bisection."""
    before = low
    for t in np.linspace(low, high, _LOOKS)[1:]:
        if stop(t, inside(t)) < 0.0:
            if stop(before, inside(before)) <= 0.0:
                return float(before if before > low else t)
            return float(brentq(lambda s: stop(s, inside(s)), before, t, xtol=1e-14, rtol=1e-14))
        before = t
    return None
