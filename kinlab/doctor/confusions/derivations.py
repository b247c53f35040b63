"""The textbooks' derivations walked with one step, then two or three, taken otherwise."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from math import comb

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.doctor.changes import Case
from kinlab.doctor.confusions.roads import Road, Ways, roads
from kinlab.doctor.confusions.steps import steps
from kinlab.doctor.confusions.walk import Step
from kinlab.doctor.search import pairs_adding_up
from kinlab.tolerances import TOLERANCES

_LIKELY = 1.2
"""Cost up to which a step is tried together with others."""
_WAYS = 20_000
"""Combinations of steps that are tried, the likeliest first."""
_CHUNK = 5_000
_ADDED = 3
"""States at which effects are added up."""
_JOINED = 0.4
"""What a second step costs beside its own."""


@dataclass(frozen=True)
class Found:
    """Steps of a derivation that, taken otherwise, give the hand formula at every state.

    Attributes:
        steps: one, two or three.
        error: the relative error that is left.
        cost: how far-fetched they are.
    """

    steps: tuple[Step, ...]
    error: float
    cost: float


def taken_otherwise(case: Case) -> list[Found]:
    """What explains the hand formula by one step; nothing where none does."""
    ready = [(road, shapes) for road in roads(case) if (shapes := _sound(case, road)) is not None]
    for singly in (False, True):
        found: list[Found] = []
        for road, shapes in ready:
            if singly and not road.pairs:
                continue
            tried = steps(road.of, shapes, road.n, singly)
            found += _tried(case, road, [(step,) for step in tried])
        if found:
            return found
    return []


def several_taken_otherwise(case: Case) -> list[Found]:
    """What explains the hand formula by two steps, by three, or by four whose effects add up."""
    ready = []
    for road in roads(case):
        shapes = _sound(case, road) if road.pairs else None
        if shapes is not None:
            every = sorted(steps(road.of, shapes, road.n, False), key=lambda s: s.cost)
            likely = _apart(case, road, [s for s in every if s.cost <= _LIKELY])
            while comb(len(likely), 2) > _WAYS:
                likely.pop()
            pairs: Ways = [way for way in combinations(likely, 2) if _compatible(way)]
            ready.append((road, [(step,) for step in likely], pairs))
    found = [f for road, _, pairs in ready for f in _tried(case, road, pairs)]
    if not found:
        for road, one, _ in ready:
            few = [way[0] for way in one]
            while comb(len(few), 3) > _WAYS:
                few.pop()
            triples: Ways = [way for way in combinations(few, 3) if _compatible(way)]
            found += _tried(case, road, triples)
    if not found:
        found = [f for road, one, two in ready for f in _adding_up(case, road, [*one, *two])]
    return found


def _adding_up(case: Case, road: Road, ways: Ways) -> Iterator[Found]:
    """Two ways whose effects add up to what is off: three steps, or four."""
    few = case.few(_ADDED)
    blocks = [road.walked([()], few.arguments)[0]]
    for start in range(0, len(ways), _CHUNK):
        blocks.append(road.walked(ways[start : start + _CHUNK], few.arguments)[0])
    rows = np.concatenate(blocks)[(slice(None), slice(None), *case.index)]
    flat = rows.reshape(len(rows), -1)
    good = np.flatnonzero(np.isfinite(flat).all(axis=1))
    effects, goal = flat[good[1:]] - flat[0], few.hand.reshape(-1) - flat[0]
    if not len(effects) or not np.isfinite(goal).all():
        return
    size = float(np.max(np.abs(flat[0]))) or 1.0
    pairs = pairs_adding_up(effects, goal, TOLERANCES.effect_matches * size)
    joined = [(*ways[good[i + 1] - 1], *ways[good[j + 1] - 1]) for i, j in pairs]
    yield from _tried(case, road, [way for way in joined if _compatible(way)][:_CHUNK])


def _compatible(way: tuple[Step, ...]) -> bool:
    """Whether no place is changed twice."""
    places = [id(old) for step in way for old, _ in step.edits]
    return len(set(places)) == len(places)


def _sound(case: Case, road: Road) -> dict[int, tuple[int, ...]] | None:
    """The shapes of a derivation's expressions, if it is the engine's answer at all."""
    few = case.few(2)
    values, walk = road.walked([()], few.arguments)
    right = few.answer(())
    mine = values[(slice(None), slice(None), *case.index)][0]
    if mine.shape != right.shape or mine.shape != few.hand.shape:
        return None
    error = _errors(values, replace(few, hand=right), error_sizes(right))[0]
    return walk.axes if error <= TOLERANCES.formula_agrees else None


def _apart(case: Case, road: Road, tried: list[Step]) -> list[Step]:
    """The steps that change the answer, each effect once, the likeliest first."""
    if not tried:
        return []
    values, _ = road.walked([(), *((step,) for step in tried)], case.few(1).arguments)
    chosen = values[(slice(None), slice(None), *case.index)].reshape(len(values), -1)
    size = float(np.max(np.abs(chosen[0]))) or 1.0
    seen = {tuple(np.round(chosen[0] / size, 9))}
    kept = []
    for step, row in zip(tried, chosen[1:], strict=True):
        key = tuple(np.round(row / size, 9))
        if np.isfinite(row).all() and key not in seen:
            seen.add(key)
            kept.append(step)
    return kept


def _tried(case: Case, road: Road, ways: Ways) -> Iterator[Found]:
    """The ways that give the hand formula: at one state first, then at all."""
    size = error_sizes(np.asarray(case.answer(())))
    few = case.few(1)
    near = []
    for start in range(0, len(ways), _CHUNK):
        part = ways[start : start + _CHUNK]
        errors = _errors(road.walked(part, few.arguments)[0], few, size[:1])
        near += [
            way
            for way, error in zip(part, errors, strict=True)
            if error <= TOLERANCES.formula_agrees
        ]
    if not near:
        return
    errors = _errors(road.walked(near, case.arguments)[0], case, size)
    for way, error in zip(near, errors, strict=True):
        if error <= TOLERANCES.formula_agrees:
            yield Found(way, float(error), sum(s.cost for s in way) + _JOINED * (len(way) - 1))


def _errors(values: Array, case: Case, size: Array) -> Array:
    """The largest relative error of each way, (B,)."""
    chosen = values[(slice(None), slice(None), *case.index)]
    gap = np.abs(chosen - case.hand).reshape(len(chosen), len(case.hand), -1)
    worst = np.max(gap, axis=2, initial=0.0) / size
    return np.asarray(np.max(np.where(np.isfinite(worst), worst, np.inf), axis=1))
