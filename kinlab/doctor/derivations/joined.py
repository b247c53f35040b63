"""The textbooks' derivations walked with one step, then two or three, taken otherwise."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from math import comb

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.doctor.changes import Case
from kinlab.doctor.derivations.parts import Apart, joined, spoils
from kinlab.doctor.derivations.roads import Road, Ways, roads, through_links
from kinlab.doctor.derivations.steps import steps
from kinlab.doctor.derivations.walk import Step
from kinlab.doctor.text.pairs import pairs_adding_up
from kinlab.tolerances import TOLERANCES

_LIKELY = 1.215
"""Cost up to which a step is tried together with others."""
_WAYS = 12_000
"""Combinations of steps that are tried, the likeliest first."""
_HEAVY = 1_000
"""Assignments of one walk above which a derivation is left to lighter ones where the links are
placed otherwise."""
_WORK = 1_200_000
"""Assignments that all derivations of a formula together may cost in one attempt: counted, and no
clock, so that the answer is the same on every machine."""
_PLAIN = 1.04
"""Cost up to which steps are walked before all others, where the likeliest is asked for."""
_FEW = 80
"""Steps up to which all are joined, also those that change what is right."""
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
        road: the derivation.
    """

    steps: tuple[Step, ...]
    error: float
    cost: float
    road: Road


Shapes = dict[int, tuple[int, ...]]
Ready = list[tuple[Road, Shapes]]


def ready(case: Case) -> Ready:
    """The derivations that give the engine's answer, with the shapes of their expressions."""
    return _ready(case, roads(case))


def _ready(case: Case, tried: Iterable[Road]) -> Ready:
    return [(road, shapes) for road in tried if (shapes := _sound(case, road)) is not None]


def taken_otherwise(case: Case, ways: Ready) -> list[Found]:
    """What explains the hand formula by one step, at all joints."""
    return [found for road, shapes in ways for found in _by_one(case, road, shapes, False)]


def likeliest(case: Case, ways: Ready, most: float) -> list[Found]:
    """Of what :func:`taken_otherwise` finds the likeliest, and nothing of more than a cost.

    Steps that are far-fetched are walked only where no plain one explains the formula.
    """
    found: list[Found] = []
    above = 0.0
    for limit in (_PLAIN, np.inf):
        for road, shapes in ways:
            every = steps(road.of, shapes, road.n, False)
            some = [step for step in every if above < step.cost <= min(limit, most)]
            found += _tried(case, road, [(step,) for step in some])
            exact = [one.cost for one in found if one.error <= TOLERANCES.formula_agrees]
            most = min([most, *exact])
        above = limit
    return found


def taken_at_one_joint(case: Case, ways: Ready) -> list[Found]:
    """What explains the hand formula by one step at one joint, or by one in the links' matrices."""
    found = [x for road, shapes in ways if road.singly for x in _by_one(case, road, shapes, True)]
    if any(one.error <= TOLERANCES.formula_agrees for one in found):
        return found
    through = _ready(case, through_links(case))
    least = min((road.work for road, _shapes in through), default=0)
    for road, shapes in through:
        if road.work <= max(_HEAVY, least):
            more = [*_by_one(case, road, shapes, False)]
            if any(one.error <= TOLERANCES.formula_agrees for one in more):
                return more
            found += more
    return found


def _by_one(case: Case, road: Road, shapes: Shapes, singly: bool) -> Iterator[Found]:
    tried = steps(road.of, shapes, road.n, singly)
    yield from _tried(case, road, [(step,) for step in tried])


def with_these(known: list[Found], case: Case) -> list[Found]:
    """Which steps that explain another answer explain this one too."""
    ways: Ways = [one.steps for one in known]
    return [found for road in roads(case) for found in _tried(case, road, ways)]


def one_for_each_kind(case: Case, ways: Ready, split: Apart | None) -> list[Found]:
    """What explains the hand formula by one step for each kind of term that is wrong."""
    if split is None or np.sum(~split.right) < 2:
        return []
    found: list[Found] = []
    for road, shapes in ways:
        singles = steps(road.of, shapes, road.n, False)
        if len(singles) * len(split.stacks["q"]) * road.work > _WORK:
            continue
        values = _walked(road, [(), *((step,) for step in singles)], split.stacks, case)
        both = [way for way in joined(split, values, singles) if _compatible(way)]
        found += _tried(case, road, both)
    return found


def several_taken_otherwise(case: Case, ways: Ready, split: Apart | None) -> list[Found]:
    """What explains the hand formula by two steps, by three, or by four whose effects add up.

    Steps that leave what is right as it is are joined first; then, where there are few, all of
    them, since two may make up for each other.
    """
    ready = []
    for road, shapes in ways:
        if road.pairs:
            every = sorted(steps(road.of, shapes, road.n, False), key=lambda s: s.cost)
            ready.append(
                (road, *_apart(case, road, [s for s in every if s.cost <= _LIKELY], split))
            )
    share = _WORK // max(1, len(ready))
    found = [f for road, kept, _ in ready for f in _joined(case, road, kept, 2, share)]
    if not found and not _planar(case):
        # in the plane too many triples come to the same
        found = [f for road, kept, _ in ready for f in _joined(case, road, kept, 3, share)]
    if not found:
        for road, kept, every in ready:
            if len(kept) < len(every) <= _FEW:
                found += _joined(case, road, every, 2, share)
                if not found and not _planar(case):
                    found += _joined(case, road, every, 3, share)
    if not found and not _planar(case):
        for road, kept, _ in ready:
            one: Ways = [(step,) for step in kept]
            pairs: Ways = [*combinations(_most(kept, 2, share // (_ADDED * road.work)), 2)]
            found += _adding_up(case, road, [*one, *filter(_compatible, pairs)])
    return found


def _joined(case: Case, road: Road, tried: list[Step], count: int, share: int) -> Iterator[Found]:
    """Ways of so many steps together, of as many of the likeliest as so much work allows."""
    ways: Ways = [*combinations(_most(tried, count, share // road.work), count)]
    yield from _tried(case, road, [way for way in ways if _compatible(way)])


def _most(tried: list[Step], count: int, ways: int) -> list[Step]:
    kept = list(tried)
    while comb(len(kept), count) > min(_WAYS, ways):
        kept.pop()
    return kept


def _planar(case: Case) -> bool:
    """Whether all axes of an arm are parallel."""
    table = getattr(case.robot, "table", None)
    return table is not None and all(
        abs(np.sin(link.alpha)) <= TOLERANCES.parallel_axes for link in table.links
    )


def _walked(road: Road, ways: Ways, stacks: dict[str, Array], case: Case) -> Array:
    """The ways' answers, (B, N, ...), of the entries that the case is about."""
    return road.walked(ways, stacks)[0][(slice(None), slice(None), *case.index)]


def _adding_up(case: Case, road: Road, ways: Ways) -> Iterator[Found]:
    """Two ways whose effects add up to what is off: three steps, or four."""
    few = case.few(_ADDED)
    blocks = [_walked(road, [()], few.arguments, case)]
    for start in range(0, len(ways), _CHUNK):
        blocks.append(_walked(road, ways[start : start + _CHUNK], few.arguments, case))
    flat = np.concatenate([block.reshape(len(block), -1) for block in blocks])
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


def _sound(case: Case, road: Road) -> Shapes | None:
    """The shapes of a derivation's expressions, if it is the engine's answer at all."""
    few = case.few(2)
    values, walk = road.walked([()], few.arguments)
    right = few.answer(())
    mine = values[(slice(None), slice(None), *case.index)][0]
    if mine.shape != right.shape or mine.shape != few.hand.shape:
        return None
    error = _errors(values, replace(few, hand=right), error_sizes(right))[0]
    return walk.axes if error <= TOLERANCES.formula_agrees else None


def _apart(
    case: Case, road: Road, tried: list[Step], split: Apart | None
) -> tuple[list[Step], list[Step]]:
    """The steps that change the answer, each effect once, the likeliest first.

    Returns:
        Those that change no entry and no kind of term that is right; and all.
    """
    if not tried:
        return [], []
    ways: Ways = [(), *((step,) for step in tried)]
    few = case.few(1)
    chosen = _walked(road, ways, few.arguments, case).reshape(len(ways), -1)
    size = float(np.max(np.abs(chosen[0]))) or 1.0
    slack = TOLERANCES.formula_agrees * size
    right = np.abs(few.hand.ravel() - chosen[0]) <= slack
    with np.errstate(invalid="ignore"):
        spoilt = np.any(right & ~(np.abs(chosen - chosen[0]) <= slack), axis=1)
    if split is not None and split.right.any():
        spoilt |= spoils(split, _walked(road, ways, split.stacks, case))
    seen = {tuple(np.round(chosen[0] / size, 9))}
    kept, every = [], []
    for step, row, bad in zip(tried, chosen[1:], spoilt[1:], strict=True):
        key = tuple(np.round(row / size, 9))
        if np.isfinite(row).all() and key not in seen:
            seen.add(key)
            every.append(step)
            kept += [] if bad else [step]
    return kept, every


def _tried(case: Case, road: Road, ways: Ways) -> Iterator[Found]:
    """The ways that give the hand formula: at one state first, then at all."""
    if not ways:
        return
    size = error_sizes(np.asarray(case.answer(())))
    few = case.few(1)
    near = []
    for start in range(0, len(ways), _CHUNK):
        part = ways[start : start + _CHUNK]
        errors = _errors(road.walked(part, few.arguments)[0], few, size[:1])
        near += [way for way, error in zip(part, errors, strict=True) if error <= case.slack]
    if not near:
        return
    errors = _errors(road.walked(near, case.arguments)[0], case, size)
    for way, error in zip(near, errors, strict=True):
        if error <= case.slack:
            cost = sum(s.cost for s in way) + _JOINED * (len(way) - 1)
            yield Found(way, float(error), cost, road)


def _errors(values: Array, case: Case, size: Array) -> Array:
    """The largest relative error of each way, (B,)."""
    chosen = values[(slice(None), slice(None), *case.index)]
    gap = np.abs(chosen - case.hand).reshape(len(chosen), len(case.hand), -1)
    worst = np.max(gap, axis=2, initial=0.0) / size
    return np.asarray(np.max(np.where(np.isfinite(worst), worst, np.inf), axis=1))
