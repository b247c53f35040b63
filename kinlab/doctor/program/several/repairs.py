"""Two or three edits that together make a program right.

What each edit changes is known already. Pairs that nothing there speaks against are tried, those
first that explain most; then what is left is looked for beside an edit that makes numbers right.
"""

from __future__ import annotations

from collections.abc import Iterable

from kinlab.doctor.program.repair import LineSearch, ProgramRepair, changed
from kinlab.doctor.program.several.effects import Effects, Way, effects_of, way_cost
from kinlab.doctor.program.several.rest import AtRest
from kinlab.doctor.program.trial import NoProgramError, quietly

_VERIFIED = 60
"""Combinations that are tried in the program, the likeliest first."""
_KNOWN = 3
"""Repairs from which the likeliest is taken."""
_FURTHER = 40
"""Combinations that are tried once one has made the program right."""
_STEPS = 4
"""Edits that make numbers right from which is gone on."""
_DEEPEST = 2
"""Edits that may stand already when more are looked for."""
_POSE = (4, 4)
"""The shape of an answer that is a product of matrices."""


def several(search: LineSearch) -> list[ProgramRepair]:
    """Two edits, or else three, that make the program right; the likeliest first.

    Args:
        search: whose single edits were tried already.
    """
    with quietly():
        return sorted(_found(search), key=lambda repair: way_cost(repair.edits))


def _found(search: LineSearch) -> list[ProgramRepair]:
    known = effects_of(search, search.tried)
    if known is None or not known.alike:
        return []
    tried = _Tried(search)
    found = tried.first(known.adding_up(2)) or tried.first(_in_a_row(search, known, 2))
    if found:
        return found
    wider = None if search.stand else AtRest(search).effects(known, search.most // 2)
    joined = known if wider is None else known.beside(wider)
    found = tried.dear(joined, joined.pairs(), search.most // 3)
    if not found and len(search.stand) < _DEEPEST:
        found = _one_after_another(search, joined)
    if not found and not search.stand:
        found = tried.first(known.adding_up(3)) or tried.first(_in_a_row(search, known, 3))
        found = found or tried.dear(joined, joined.triples(), search.most // 6)
    return found


def _in_a_row(search: LineSearch, known: Effects, count: int) -> list[Way]:
    return known.in_a_row(count, _POSE) if search.wanted.shape[1:] == _POSE else []


def _one_after_another(search: LineSearch, known: Effects) -> list[ProgramRepair]:
    """Edits that make numbers right and spoil none, and then what is left."""
    for k in known.gaining[:_STEPS]:
        edit = known.alike[k][0]
        try:
            with changed(search.trial, (edit,)):
                here = search.beside((*search.stand, edit))
                found = here.singles() or _found(here)
        except NoProgramError:
            continue
        if found:
            return found
    return []


class _Tried:
    """Combinations of edits, tried in the program."""

    def __init__(self, search: LineSearch) -> None:
        self.search = search

    def first(self, ways: Iterable[Way]) -> list[ProgramRepair]:
        """What the likeliest of a few combinations make of the program."""
        found: list[ProgramRepair] = []
        for _turn, way in zip(range(_VERIFIED), ways, strict=False):
            found += self._verified(way)
            if len(found) == _KNOWN:
                break
        return found

    def dear(self, known: Effects, ranked: list[tuple[int, ...]], most: int) -> list[ProgramRepair]:
        """What many make of it, as many as so much work allows."""
        found: list[ProgramRepair] = []
        left, work = len(ranked), 0
        for turn, chosen in enumerate(ranked):
            for way in known.edits(chosen) if turn < _VERIFIED else [known.likeliest(chosen)]:
                work += max(self.search.cost_of(edit) for edit in way)
                found += self._verified(way)
                if found:
                    break
            if found and left == len(ranked):
                left = turn + _FURTHER
            if work > most or turn >= left or len(found) >= _KNOWN:
                break
        return found

    def _verified(self, way: Way) -> list[ProgramRepair]:
        try:
            with changed(self.search.trial, way):
                repair = self.search.verdict((*self.search.stand, *way))
        except NoProgramError:
            return []
        return [] if repair is None else [repair]
