"""The search of one design: differential evolution, an exact polish, and the proof of the worst.

Three steps. Differential evolution (Storn & Price 1997) on a lattice of points finds the basin; its
random numbers follow from seed and generation alone, so a search that was stopped goes on from its
file to the very same answer, which scipy's own does not. Then the minimax problem over the points,
min t with every piece below its t, is smooth, and SLSQP solves it to rounding. Then branch and
bound looks for the worst place of the whole rectangle; the places that it finds join the points and
the polish is repeated (exchange method of semi-infinite programming: Hettich & Kortanek 1993).
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import FileError
from kinlab.fivebar.design.problem import Problem, size_of
from kinlab.host.files import read_text, write_text
from kinlab.tolerances import TOLERANCES

Progress = Callable[[int, int, float], None]
"""Told generation, generations and the best cost so far."""

_MEMBERS, _GENERATIONS = 36, 90
_SIDE = 9
"""Points a side of the lattice of the search."""

_ROUNDS = 6
"""How often the worst places join the points; the part of the cost below which they need not."""

_ACTIVE = 60
"""Points of each quantity that the polish looks at: those with the least slack at its start."""

_WEIGHT, _CROSSOVER = 0.6, 0.85


def search_points() -> Array:
    """The points of the search over the unit square, (K, 2): its edges are drawn finer."""
    inner, edge = np.linspace(0.0, 1.0, _SIDE), np.linspace(0.0, 1.0, 4 * _SIDE - 3)
    square = np.stack(np.meshgrid(inner, inner), axis=-1).reshape(-1, 2)
    sides = [np.stack([edge, np.full_like(edge, side)], axis=1) for side in (0.0, 1.0)]
    return np.unique(np.concatenate([square, *sides, *(s[:, ::-1] for s in sides)]), axis=0)


def evolve(
    problem: Problem,
    seed: int,
    starts: Array | None = None,
    progress: Progress | None = None,
    file: Path | None = None,
    generations: int = _GENERATIONS,
) -> Array:
    """The best candidate on the lattice, (variables,).

    Args:
        problem: what is asked.
        seed: the same seed gives the same answer.
        starts: candidates (S, variables) that take the first places of the population.
        progress: told after each generation.
        file: kept up to date after each generation, and gone on from.
        generations: how many.

    Raises:
        FileError: the file is of another problem or seed, or no such file at all.
    """
    points, low, high = search_points(), problem.low, problem.high
    first = np.random.default_rng([seed, 0])
    x = low + (high - low) * first.uniform(size=(_MEMBERS, len(low)))
    if starts is not None and len(starts):
        x[: len(starts)] = np.clip(starts, low, high)
    cost, begin = problem.cost(x, points), 1
    key = f"{problem.key()}-{seed}-{generations}"
    if file is not None and file.exists():
        begin, x, cost = _read(file, key)
    for generation in range(begin, generations + 1):
        rng = np.random.default_rng([seed, generation])
        one, other = (rng.permutation(_MEMBERS) for _ in range(2))
        best = x[int(np.argmin(cost))]
        attraction = rng.uniform(0.3, 1.0, size=(_MEMBERS, 1))
        trial = x + attraction * (best - x) + _WEIGHT * (x[one] - x[other])
        trial = np.where(trial < low, 2.0 * low - trial, trial)
        trial = np.where(trial > high, 2.0 * high - trial, trial)
        keep = rng.uniform(size=trial.shape) > _CROSSOVER
        trial = np.clip(np.where(keep, x, trial), low, high)
        found = problem.cost(trial, points)
        better = found < cost
        x, cost = np.where(better[:, None], trial, x), np.where(better, found, cost)
        if file is not None:
            state = {
                "problem": key,
                "generation": generation,
                "x": x.tolist(),
                "cost": cost.tolist(),
            }
            write_text(file, json.dumps(state))
        if progress is not None:
            progress(generation, generations, float(cost.min()))
    return np.asarray(x[int(np.argmin(cost))])


def _read(file: Path, key: str) -> tuple[int, Array, Array]:
    try:
        state = json.loads(read_text(file))
        found, begin = state["problem"], int(state["generation"]) + 1
        x, cost = np.array(state["x"], dtype=float), np.array(state["cost"], dtype=float)
    except (ValueError, KeyError, TypeError):
        raise FileError(f"{file}: no state of a design search; name another file") from None
    if found != key or x.shape[0] != _MEMBERS or cost.shape != (_MEMBERS,):
        raise FileError(
            f"{file}: the state of another design search; name another file, or delete this one"
        )
    return begin, x, cost


def polish(problem: Problem, x: Array, points: Array) -> Array:
    """min of the weighed goals with every piece below its goal, by SLSQP; x where that fails."""
    from scipy.optimize import minimize

    goals = list(problem.weights)
    share = np.array([problem.weights[goal] / problem.unit(goal) for goal in goals])
    start = problem.pieces(x[None], points)
    worst = np.array([v[0] for v in problem.values(x[None], start).values()])
    if not np.all(np.isfinite(worst)):
        return x
    scale = np.maximum(np.abs(worst), 1e-9)
    span = problem.high - problem.low

    def rows(z: Array) -> list[Array]:
        at = (problem.low + span * z[: len(x)])[None]
        pieces = problem.pieces(at, points)
        out = [-values.ravel() for values in problem.excess(at, pieces).values()]
        for k, goal in enumerate(goals):
            values = pieces[goal].ravel() if goal in pieces else size_of(at)
            out.append(z[len(x) + k] - values / scale[k])
        return out

    def slack(z: Array) -> Array:
        kept = [row[place] for row, place in zip(rows(z), active, strict=True)]
        return np.nan_to_num(np.concatenate(kept), nan=-1.0, posinf=1e6, neginf=-1e6)

    z = np.concatenate([(x - problem.low) / np.where(span > 0, span, 1.0), worst / scale])
    weight = np.concatenate([np.zeros(len(x)), share * scale])
    active = [np.argsort(row, kind="stable")[:_ACTIVE] for row in rows(z)]
    done = minimize(
        lambda z: float(weight @ z),
        z,
        jac=lambda z: weight,
        method="SLSQP",
        bounds=[(0.0, 1.0)] * len(x) + [(None, None)] * len(goals),
        constraints={"type": "ineq", "fun": slack},
        options={"maxiter": 60, "ftol": 1e-12},
    )
    found = np.clip(problem.low + span * done.x[: len(x)], problem.low, problem.high)
    before, after = problem.cost(np.stack([x, found]), points)
    return found if after < before else x


def exchange(problem: Problem, x: Array) -> Array:
    """Polishes until the worst places of the whole rectangle are among the points."""
    points = search_points()
    for _ in range(_ROUNDS):
        x = polish(problem, x, points)
        _, places = problem.proved(x)
        box = problem.box_of(x)
        size = np.array([box.x_max - box.x_min, box.y_max - box.y_min])
        more = (places - np.array([box.x_min, box.y_min])) / size
        both = np.concatenate([points, more])
        on_points, with_places = (float(problem.cost(x[None], p)[0]) for p in (points, both))
        if with_places <= on_points + TOLERANCES.worst_places * abs(on_points):
            break
        points = both
    return x
