"""Two or three edits that together make a program right.

What each edit changes is known already. Pairs that nothing there speaks against are tried, those
first that explain most; then what is left is looked for beside an edit that makes numbers right.
"""

from __future__ import annotations

import numpy as np

from kinlab.doctor.glossary.meaning import meaning_of
from kinlab.doctor.program.places import DATA, ProgramEdit
from kinlab.doctor.program.repair import LineSearch, ProgramRepair, changed
from kinlab.doctor.program.several.effects import Chosen, Effects, Way, effects_of
from kinlab.doctor.program.several.rest import AtRest
from kinlab.doctor.program.several.witnesses import Witnesses
from kinlab.doctor.program.trial import NoProgramError, quietly

_VERIFIED = 60
"""Combinations of which edits of the same effects are tried, too."""
_SIBLINGS, _EVERY = 3, 8
"""Edits of one effect that are tried with others: at first, and of a pair that is right."""
_FURTHER = 40
"""Combinations that are tried once one has made the program right."""
_RIVALS = 6
"""Repairs of which it is looked what they leave right."""
_ALIKE = 0.15
"""Cost beyond the first's of repairs that nothing else tells from it."""
_NAMED = 3
"""Repairs that are kept."""
_STEPS = 3
"""Edits that make numbers right from which is gone on."""
_WATCHING = 4
"""Of the work for single edits, the part for watching statements."""
_DEEPEST = 2
"""Edits beside which one more is looked for, and no two."""
_POSE = (4, 4)
"""The shape of an answer that is a product of matrices."""


def several(search: LineSearch) -> list[ProgramRepair]:
    """Two edits, or else three, that make the program right; the likeliest first.

    Args:
        search: whose single edits were tried already.
    """
    with quietly():
        return _found(search)


def _found(search: LineSearch) -> list[ProgramRepair]:
    known = effects_of(search, search.tried)
    if known is None or not known.alike:
        return []
    pose = search.wanted.shape[1:] == _POSE
    tried = _Tried(search)
    found = tried.likeliest(known, known.adding_up(2))
    if not found and pose:
        found = tried.likeliest(known, known.in_a_row(2, _POSE))
    if found:
        return found
    found = _from_steps(search, known)
    if found:
        return found
    wider = None if search.stand else AtRest(search).effects(known, search.most // 2)
    joined = known if wider is None else known.beside(wider)
    found = tried.likeliest(joined, joined.pairs())
    found = found or _one_after_another(search, joined)
    if not found and not search.stand:
        found = tried.likeliest(known, known.adding_up(3))
        if not found and pose:
            found = tried.likeliest(known, known.in_a_row(3, _POSE))
        found = found or tried.likeliest(joined, joined.triples())
    return found


def _from_steps(search: LineSearch, known: Effects) -> list[ProgramRepair]:
    """Edits with which statements are a textbook's, and then what is left."""
    steps = Witnesses(search).steps(known, search.most // _WATCHING)
    return _after(search, [step.edit for step in steps[:_STEPS]])


def _one_after_another(search: LineSearch, known: Effects) -> list[ProgramRepair]:
    """Edits that make numbers right and spoil none, and then what is left."""
    return _after(search, [known.alike[k][0] for k in known.gaining[:_STEPS]])


def _after(search: LineSearch, firsts: list[ProgramEdit]) -> list[ProgramRepair]:
    """What is left once an edit stands, of several the first with which anything is found."""
    for edit in firsts:
        try:
            with changed(search.trial, (edit,)):
                here = search.beside((*search.stand, edit))
                here.most = max(here.most, (search.most - search.work) // _STEPS)
                here.look_again()
                found = here.singles()
                if not found and len(here.stand) < _DEEPEST:
                    found = _found(here)
        except NoProgramError:
            continue
        if found:
            return found
    return []


class _Tried:
    """Combinations of edits, tried in the program."""

    def __init__(self, search: LineSearch) -> None:
        self.search = search

    def likeliest(self, known: Effects, ranked: list[Chosen]) -> list[ProgramRepair]:
        """What combinations make of it, as many as some work allows.

        Beside one that makes it right others are looked at: what has the same effects, what comes
        next, and pairs that explain as much.
        """
        most = self.search.most // 4
        fitting: list[Way] = []
        for turn, chosen in enumerate(ranked):
            for way in known.edits(chosen, _SIBLINGS if turn < _VERIFIED else 1):
                most -= self._cost(way)
                if self._repair(way) is not None:
                    fitting = [way]
                    break
            if fitting or most < 0:
                break
        if not fitting:
            return []
        further = [*ranked[turn + 1 : turn + 1 + _FURTHER], *known.pairs()[:_FURTHER]]
        rivals = [*known.edits(chosen, _EVERY)]
        rivals += [way for one in dict.fromkeys(further) for way in known.edits(one, _SIBLINGS)]
        for way in dict.fromkeys(rivals):
            most -= self._cost(way)
            if most < -self.search.most // 8:
                break
            if way != fitting[0] and self._fits(way):
                fitting.append(way)
        return self._ranked(fitting)

    def _cost(self, way: Way) -> int:
        return max(self.search.cost_of(edit) for edit in way)

    def _repair(self, way: Way) -> ProgramRepair | None:
        """The repair, if edits make the program right."""
        try:
            with changed(self.search.trial, way):
                return self.search.verdict((*self.search.stand, *way))
        except NoProgramError:
            return None

    def _fits(self, way: Way) -> bool:
        """Whether edits make the program right at the first states."""
        try:
            with changed(self.search.trial, way):
                values = self.search.values(self.search.first)
        except NoProgramError:
            return False
        return values is not None and bool(self.search.right(values).all())

    def _ranked(self, ways: list[Way]) -> list[ProgramRepair]:
        """Those first that leave most of the program as a textbook has it."""
        search = self.search
        costs = {way: sum(map(search.likely, way)) for way in ways}
        ranked = sorted(costs, key=lambda way: costs[way])
        near = [way for way in ranked if costs[way] <= costs[ranked[0]] + _ALIKE][:_RIVALS]
        if len(near) > 1 and search.evidence.known:
            rights = {way: search.left_right(way) + sum(map(self._own, way)) for way in near}
            near.sort(key=lambda way: (-rights[way], costs[way]))
        found: list[ProgramRepair] = []
        for way in [*near, *(way for way in ranked if way not in near)]:
            repair = self._repair(way)
            found += [] if repair is None else [repair]
            if len(found) == _NAMED:
                break
        return found

    def _own(self, edit: ProgramEdit) -> bool:
        """Whether a number that is nothing of the arm's becomes one of its own."""
        known = self.search.evidence.known
        if edit.part != DATA or edit.numbers is None:
            return False
        old, new = (meaning_of(known, [np.array(x)] * len(known)) for x in edit.numbers)
        return (old is None or bool(old.form)) and new is not None and not new.form
