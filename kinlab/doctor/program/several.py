"""Two or three edits that together make a program right.

Those whose effects on the answer add up to what is missing are found without trying each with
each; others one after the other, where the first makes entries of the answer right.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.program.places import DATA, ProgramEdit
from kinlab.doctor.program.repair import LineSearch, ProgramRepair, changed
from kinlab.doctor.program.trial import NoProgramError, quietly
from kinlab.doctor.text.pairs import pairs_adding_up
from kinlab.tolerances import TOLERANCES

_VERIFIED = 60
"""Combinations that are tried in the program, the likeliest first."""
_STEPS = 4
"""Edits that make entries right from which is gone on."""
_TRIPLES = 250
"""Edits of which any three are added up."""
_PLAIN = 1.06
"""Cost of edits that are tried first with each other."""
_EXCHANGED = 0.5
"""What it costs to take a term out and put another in."""
_DEEPEST = 2
"""Edits that may stand already when more are looked for."""

Tried = list[tuple[ProgramEdit, Array]]
"""Edits, each with the answers at the first states."""


def several(search: LineSearch) -> list[ProgramRepair]:
    """Two edits, or else three, that make the program right; the likeliest first.

    Args:
        search: whose single edits were tried already.
    """
    if not search.tried:
        return []
    with quietly():
        return _found(search, (), search.tried)


def _found(search: LineSearch, stand: tuple[ProgramEdit, ...], tried: Tried) -> list[ProgramRepair]:
    """Repairs of which some edits stand already."""
    found = [*_adding_up(search, stand, tried, 2)]
    if not found and len(stand) < _DEEPEST:
        found = [*_one_after_another(search, stand, tried)]
    if not found and not stand:
        found = [*_adding_up(search, stand, tried, 3)] or [*_each_with_each(search, tried)]
    return sorted(found, key=lambda repair: repair.cost)


def _adding_up(
    search: LineSearch, stand: tuple[ProgramEdit, ...], tried: Tried, count: int
) -> Iterator[ProgramRepair]:
    wanted = search.wanted[search.first]
    sizes = search.sizes[search.first].reshape(-1, *[1] * (wanted.ndim - 1))
    own = search.values(search.first)
    if own is None or not np.isfinite(own).all():
        return
    goal = ((wanted - own) / sizes).ravel()
    edits_, rows = _distinct(tried, own, sizes)
    if len(rows) < 2:
        return
    both: list[tuple[ProgramEdit, ...]]
    if count == 2:
        pairs = pairs_adding_up(rows, goal, TOLERANCES.effects_add_up)
        both = [(edits_[one], edits_[two]) for one, two in pairs]
    else:
        most = min(_TRIPLES, len(rows))
        both = [
            (edits_[k], edits_[one], edits_[two])
            for k in range(2, most)
            for one, two in pairs_adding_up(rows[:k], goal - rows[k], TOLERANCES.effects_add_up)
        ]
    both.sort(key=_cost)
    yield from _verified(search, (stand + one for one in both[:_VERIFIED]))


def _distinct(tried: Tried, own: Array, sizes: Array) -> tuple[list[ProgramEdit], Array]:
    """Of edits with one effect the likeliest; those without are left out."""
    kept: dict[bytes, tuple[ProgramEdit, Array]] = {}
    for edit, values in tried:
        effect = ((values - own) / sizes).ravel()
        if not np.isfinite(effect).all() or np.max(np.abs(effect)) < TOLERANCES.effects_add_up:
            continue
        key = (np.round(effect, 7) + 0.0).tobytes()
        if key not in kept or edit.cost < kept[key][0].cost:
            kept[key] = (edit, effect)
    one = sorted(kept.values(), key=lambda pair: pair[0].cost)
    return [edit for edit, _effect in one], np.array([effect for _edit, effect in one])


def _one_after_another(
    search: LineSearch, stand: tuple[ProgramEdit, ...], tried: Tried
) -> Iterator[ProgramRepair]:
    """Edits that make entries right and spoil none, and then what is left."""
    own = search.values(search.first)
    if own is None:
        return
    before = search.right(own)
    gains: list[tuple[int, float, int, ProgramEdit]] = []
    for edit, values in tried:
        after = search.right(values)
        if np.all(after >= before) and after.sum() > before.sum():
            gains.append((-int(after.sum()), edit.cost, len(gains), edit))
    seen: set[bytes] = set()
    for *_gain, edit in sorted(gains)[: 4 * _STEPS]:
        with changed(search.trial, (edit,)):
            there = search.values(search.first)
            key = b"" if there is None else np.round(there, 7).tobytes()
            if not key or key in seen or len(seen) == _STEPS:
                continue
            seen.add(key)
            here = search.beside((*stand, edit))
            found = here.singles()
            more = found or _found(here, (*stand, edit), here.tried)
        if more:
            yield from more
            return


def _each_with_each(search: LineSearch, tried: Tried) -> Iterator[ProgramRepair]:
    """The likeliest in pairs, as many as so much work allows: factors of one product, say."""
    own = search.values(search.first)
    if own is None:
        return
    wanted = search.wanted[search.first]
    sizes = search.sizes[search.first].reshape(-1, *[1] * (wanted.ndim - 1))
    likely, _rows = _distinct(tried, own, sizes)
    plain = [edit for edit in likely if edit.cost <= _PLAIN]
    work = 0
    for several_ in (plain, [edit for edit in likely if edit.part == DATA], likely):
        for k, last in enumerate(several_):
            for first in several_[:k]:
                work += max(search.cost_of(first), search.cost_of(last))
                if work > search.most // 3:
                    return
                found = [*_verified(search, iter([(first, last)]))]
                if found:
                    yield from found
                    return


def _verified(
    search: LineSearch, ways: Iterator[tuple[ProgramEdit, ...]]
) -> Iterator[ProgramRepair]:
    found = 0
    for way in ways:
        fresh = [edit for edit in way if edit not in search.stand]
        try:
            with changed(search.trial, tuple(fresh)):
                repair = search.verdict(way)
        except NoProgramError:
            continue
        if repair is not None:
            yield repair
            found += 1
            if found == 3:
                return


def _cost(way: tuple[ProgramEdit, ...]) -> float:
    kinds = {edit.kind for edit in way}
    swapped = _EXCHANGED if {"extra term", "missing term"} <= kinds else 0.0
    return sum(edit.cost for edit in way) + swapped
