"""Two or three edits that together make a program right.

What each edit changes is known already. Pairs that nothing there speaks against are tried, those
first that explain most; then what is left is looked for beside an edit that makes numbers right.
"""

from __future__ import annotations

import ast
import copy
from dataclasses import replace
from itertools import chain, combinations
from typing import Any

import numpy as np

from kinlab.doctor.glossary.meaning import meaning_of
from kinlab.doctor.program.edits.numbers.as_the_arm import of_table
from kinlab.doctor.program.places import DATA, ProgramEdit, are_counted, changed, row_of
from kinlab.doctor.program.search.chosen import turns_a_length
from kinlab.doctor.program.search.mistyped import mistyped
from kinlab.doctor.program.search.repair import SAME, LineSearch, ProgramRepair
from kinlab.doctor.program.several.effects import Chosen, Effects, Way, effects_of
from kinlab.doctor.program.several.in_order import InOrder
from kinlab.doctor.program.several.in_stages import InStages
from kinlab.doctor.program.several.rest import AtRest
from kinlab.doctor.program.several.together import TriedTogether
from kinlab.doctor.program.several.witnesses import Witnesses
from kinlab.doctor.program.trial import NoProgramError, quietly
from kinlab.tolerances import TOLERANCES

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
_TIED, _TIED_BESIDE = 0.08, 0.02
"""Of these, costs that are one; where the others are the same edits."""
_NEXT, _GAINED, _LOST = 0.07, 0.06, 0.12
"""What an edit may cost more that leaves more of the program as a textbook has it: at most, and
for each statement; what it must cost less for each that it spoils."""
_COMPARED = 5
"""Single edits in place of one of which that is looked at."""
_PLAIN, _PLAINEST = ("sign", "sin/cos"), 900
"""The plainest edits, of which any two are tried, whatever speaks against them; how many."""
_NAMED = 3
"""Repairs that are kept."""
_STEPS = 3
"""Edits that make numbers right from which is gone on."""
_SHARE = 2
"""Tenths of the work for single edits that may be done for several."""
_LOOKING = 1_500_000
"""What watching a program anew amounts to, beside running it."""
_WATCHING = 5
"""Of the work for single edits, the part for watching statements."""
_IN_ORDER = 30_000_000
"""Work for one slip after another."""
_REACHED = 25_000_000
"""Work for the last one beside those with which a part of the answer is right."""
_IN_STAGES = 100_000_000
"""Work for slips of one part of an answer after another."""
_ALONE, _IN_LANES, _WAYS = 3_000_000, 12_000_000, 2
"""Work for the last one beside them, run alone, and in lanes after that; of how many ways."""
_BESIDE_TWO = 50_000_000
"""The same in lanes beside two edits, each of which has made a statement right."""
_NEARER = 8.0
"""How many times as much was wrong before an edit that is gone on from for that."""
_TURNS = 3
"""Edits of one repair that are exchanged for likelier ones."""
_RESTING = 2
"""And the part for asking it at rest."""
_RIGHT_AT_REST = 3
"""Edits that are right at rest beside which others are looked for."""
_STEPPING = 4
"""And the part for the search beside the likeliest first edit."""
_DEEPEST = 2
"""Edits beside which one more is looked for, and no two."""
_FAR = 1.12
"""Cost of an edit that is far-fetched."""
_FARTHEST = 1.2
"""Cost of one edit in place of which two plain ones are looked for."""
_HEAVIEST = 2_000_000
"""Work for one run of a program beyond which no several edits are looked for."""
_ODD = 2
"""Numbers that are off beside the arm's of which each is mended first."""
_POSE = (4, 4)
"""The shape of an answer that is a product of matrices."""


def several(search: LineSearch) -> list[ProgramRepair]:
    """Two edits, or else three, that make the program right; the likeliest first.

    Args:
        search: whose single edits were tried already.
    """
    if search.work.of_all(search.work.first) > _HEAVIEST:
        return []
    with quietly():
        looking = _Several(_SHARE * search.most // 10)
        found = looking.of_fewer(
            search, [_reduced(repair, search) for repair in looking.found(search)]
        )
        found = search.as_named(found)
    if getattr(search.case.robot, "n", 0) == 1:  # two terms, which any three edits make right
        found = [one for one in found if len(one.edits) <= _DEEPEST]
    return found or _right_here(search)


def _right_here(search: LineSearch) -> list[ProgramRepair]:
    """One plain slip with which all is right of this arm, and of no other as far as it is
    understood which numbers of the program are whose: where nothing else explains the program.
    """
    plain = [x for x in search.here if x.edits[0].numbers is None and _is_plain(x)]
    return sorted(plain, key=lambda one: search.likely(one.edits[0]))


def single(search: LineSearch) -> list[ProgramRepair]:
    """One edit that makes the program right; two plain ones where that one is far-fetched.

    The two are likelier if they leave more of the program as a textbook has it.
    """
    found = search.singles()
    if not found or not _is_doubtful(search, found[0].edits[0]):
        return found
    two = several(_without_right_ones(search))[:1]
    if not two or len(two[0].edits) > _DEEPEST or max(map(search.likely, two[0].edits)) >= _FAR:
        return found
    if any(_Tried(search).fits((edit,)) for edit in two[0].edits):
        return found  # of which one does alone
    more = search.left_right(two[0].edits) - search.left_right(found[0].edits)
    if more > 0:
        return two
    far = search.likely(found[0].edits[0]) >= _FARTHEST
    return found if far or more else [replace(two[0], rivals=(found[0],))]


def _without_right_ones(search: LineSearch) -> LineSearch:
    """The search without the edits that are right alone: for two in place of one, no more."""
    other = copy.copy(search)
    other.wide = False
    right = search.asked.right
    other.tried = [(edit, values) for edit, values in search.tried if not right(values).all()]
    return other


def _is_doubtful(search: LineSearch, edit: ProgramEdit) -> bool:
    """Whether one edit may only make up for two: far-fetched, or a minus for a length as it is."""
    far = search.likely(edit) >= _FARTHEST
    row = edit.changes[0].holder
    far = far or (edit.kind == "sign" and isinstance(row, list) and _are_results(row))
    return far or turns_a_length(edit, search.observed, search.case.robot)


def _are_results(row: list[Any]) -> bool:
    return all(isinstance(one, ast.expr) for one in row) and are_counted(row)


def of_mistyped(search: LineSearch) -> list[ProgramRepair]:
    """Numbers that are mistyped: these alone, or one or two edits more beside them.

    Beside the arm's table they are wrong whatever else is.
    """
    odd = _mistyped(search)
    if not odd:
        return []
    with quietly():
        looking, tried = _Several(search.most), _Tried(search)
        alone = tried.of_ways([way for way in odd if len(way) == 1])
        if alone:
            return alone
        own = of_table(search.trial, search.observed, search.case.robot)
        if any(tried.fits((edit,)) for edit in own):
            return []
        if any(map(_is_plain, search.singles()[:1])):
            return []  # what one edit explains needs no number beside it
        begun = [(way, _beside_a_number(search, way)) for way in odd]
        for wide in (False, True):
            for way, here in begun:
                here.wide = wide
                with changed(search.trial, way):
                    found = here.singles() or looking.found(here)
                if found:
                    found = looking.settled(search, found, 1)
                    return [_reduced(one, search) for one in found]
    return []


def _beside_a_number(search: LineSearch, way: Way) -> LineSearch:
    with changed(search.trial, way):
        return _beside(search, way, thorough=True)


def _reduced(repair: ProgramRepair, search: LineSearch) -> ProgramRepair:
    """A repair without edits that are not needed beside the others."""
    for edit in repair.edits if len(repair.edits) > _DEEPEST else ():
        rest = tuple(one for one in repair.edits if one is not edit)
        try:
            with changed(search.trial, rest):
                smaller = search.verdict(rest)
        except NoProgramError:
            continue
        if smaller is not None:
            return _reduced(smaller, search)
    return repair


class _Several:
    """A search that ends when its work is done.

    Args:
        left: operations that may still be done beside edits that stand.
    """

    def __init__(self, left: int) -> None:
        self.left = left

    def found(self, search: LineSearch) -> list[ProgramRepair]:
        """More than one edit, beside those that stand, that make the program right."""
        known = effects_of(search, search.tried)
        if known is None or not known.alike:
            return []
        pose = search.asked.wanted.shape[1:] == _POSE
        tried = _Tried(search)
        found = tried.likeliest(known, known.multiplying())
        found = found or tried.likeliest(known, known.adding_up(2))
        if not found and pose:
            found = tried.likeliest(known, known.in_a_row(2, _POSE))
        if found and any(
            turns_a_length(x, search.observed, search.case.robot) for x in found[0].edits
        ):
            pairs = (tried.likeliest(known, x) for x in TriedTogether(search, known).pairs())
            found = min(found, next(filter(None, pairs), found), key=lambda some: some[0].cost)
        if found:
            return self.settled(search, found)
        if search.ahead:
            found = self._beside_a_right_function(search)
            if found:
                return self.settled(search, found)
        near = _nearest(search) if search.wide and not search.stand else []
        found = self._one_more(search, near, _REACHED)[0]
        if found:
            return self.settled(search, found, 1)
        in_order = InOrder(search, known, _IN_ORDER if search.wide else 0)
        one_by_one = in_order.found()
        found = [] if one_by_one is None else self._fewer(search, [one_by_one])
        found = found or self._last(search, in_order.reached[:_WAYS])
        together: TriedTogether | None = None
        if found and _is_far(found[0], search.stand):
            together = TriedTogether(search, known)
            pairs = (tried.likeliest(known, some) for some in together.pairs())
            found = next(filter(None, pairs), found)
        if found:
            return self.settled(search, found)
        together = together or TriedTogether(search, known)
        most = _IN_STAGES if search.wide else 0
        stages = InStages(search, known, together, in_order.reached, most)
        found = tried.of_ways(stages.ways(two=False))
        if found:
            return self.settled(search, found)
        for some in together.pairs():  # what holds for this arm alone is not told, others may be
            found = tried.likeliest(known, some)
            if found:
                break
        if not found and search.wide:
            found = tried.likeliest(known, together.beside_lanes())
        if not found and together.usable and search.wide:
            found = self._plain(search, tried)
        if not found and together.usable and search.wide:
            found = tried.likeliest(known, known.adding_up(3) + together.threes())
            found = found or tried.likeliest(known, together.any_three())
        found = found or tried.of_ways(stages.ways(two=True))
        found = found or self._one_more(search, stages.reached[: _WAYS + 1], _REACHED)[0]
        if found:
            return self.settled(search, found)
        wider = self._where_parts_are_silent(search, known)
        if wider is not None and (found := self._beside_what_rests(search, wider[0])):
            return found
        most = 1 if together.thorough else _STEPS - 1
        firsts = in_order.reached[:most]
        if not firsts:
            ways: list[Way] = [(edits[0],) for edits in known.alike]
            steps = Witnesses(search).steps(ways, search.most // _WATCHING)
            firsts = [(edit,) for edit in _apart([step.edits[0] for step in steps])[:most]]
        found = self._after(search, firsts)
        if found:
            return found
        joined = known
        if not together.thorough:
            joined = known if wider is None else known.beside(wider[1])
            found = self.settled(search, tried.likeliest(joined, joined.pairs()))
        if not found:
            most = 1 if together.thorough else _STEPS
            gaining = _apart([joined.alike[k][0] for k in joined.gaining])[:most]
            found = self._after(search, [(x,) for x in gaining if (x,) not in firsts])
        if not found and search.wide:
            if not together.usable:
                found = tried.likeliest(known, known.adding_up(3))
            if not found and pose:
                found = tried.likeliest(known, known.in_a_row(3, _POSE))
            if not found and not together.usable:
                found = tried.likeliest(joined, joined.triples())
            found = self.settled(search, found)
        return found

    @staticmethod
    def _where_parts_are_silent(
        search: LineSearch, known: Effects
    ) -> tuple[list[Way], Effects] | None:
        """The likeliest edits that are right at rest, or with one motion alone; and all effects."""
        resting = AtRest(search)
        there = resting.effects(known, search.most // _RESTING) if search.wide else None
        if there is None:
            return None
        return [(one,) for one in _apart(resting.making_right(there))[:_RIGHT_AT_REST]], there

    def _beside_what_rests(self, search: LineSearch, ways: list[Way]) -> list[ProgramRepair]:
        """What is left beside an edit that is right at rest; of the likeliest one two more."""
        for turn, way in enumerate(ways):
            with changed(search.trial, way):
                here = _beside(search, way, thorough=True)
                found = here.singles()
                if not found and not turn:
                    self.left = max(self.left, search.most)
                    found = self.found(here)
            if found:
                return self.settled(search, found)
        return []

    @staticmethod
    def _plain(search: LineSearch, tried: _Tried) -> list[ProgramRepair]:
        """Two of the plainest slips, whatever speaks against each alone.

        What a coordinate's sign and its torque's make of a program has every textbook's name.
        """
        plain = (one for one in search.tried if one[0].kind in _PLAIN)
        some = sorted(plain, key=lambda one: one[0].cost)[:_PLAINEST]
        known = effects_of(search, some)
        if known is None or not known.alike:
            return []
        pairs = (tried.likeliest(known, x) for x in TriedTogether(search, known).pairs())
        return next(filter(None, pairs), [])

    def _beside_a_right_function(self, search: LineSearch) -> list[ProgramRepair]:
        """What is left beside an edit with which a function is right, asked alone."""
        for one in _apart(search.ahead)[:_WAYS]:
            with changed(search.trial, (one,)):
                here = _beside(search, (one,), thorough=not search.stand)
                found = here.singles()
                if not found and not search.stand:
                    found = self.found(here)
            if found or not search.stand:
                return found
        return []

    def _last(self, search: LineSearch, ways: list[Way]) -> list[ProgramRepair]:
        """The one edit more with which all is right, if there is work left for it."""
        found, done = self._one_more(search, ways if self.left > 0 else [], _ALONE)
        self.left -= done
        return found

    @staticmethod
    def _one_more(
        search: LineSearch, ways: list[Way], alone: int, beside_two: int = _BESIDE_TWO
    ) -> tuple[list[ProgramRepair], int]:
        """The one edit more with which all is right, beside those of one of some ways.

        Args:
            search: the program.
            ways: edits that stand.
            alone: work for those that are run alone, beside which further ones are run in lanes.
            beside_two: work for these beside two edits.

        Returns:
            What was found, and what it counts as work.
        """
        found: list[ProgramRepair] = []
        done = 0
        for way in ways:
            with changed(search.trial, way):
                here = _beside(search, way)
                here.most = alone
                here.in_lanes = min(_IN_LANES, beside_two) if len(way) < _DEEPEST else beside_two
                here.in_lanes = max(here.in_lanes, alone + _IN_LANES if alone > _IN_LANES else 0)
                found = here.singles()
                done += min(here.work.done, _IN_LANES) // _WAYS
            if found:
                break
        return found, done

    def _fewer(self, search: LineSearch, found: list[ProgramRepair]) -> list[ProgramRepair]:
        """A repair of three edits or more, with one for two of them where one does as well."""
        own = found[0].edits[len(search.stand) :]
        for two in combinations(own, 2) if len(own) > _DEEPEST else ():
            rest = tuple(edit for edit in own if edit not in two)
            better = self._last(search, [rest])
            if better:
                return self._fewer(search, better)
        return found

    def of_fewer(self, search: LineSearch, found: list[ProgramRepair]) -> list[ProgramRepair]:
        """The same with one edit for two of three or more, where one does as well.

        Two of one line have more work done for them.
        """
        own = found[0].edits if found and len(found[0].edits) > _DEEPEST else ()
        for two in sorted(combinations(own, 2), key=lambda two: not _of_one_line(*two)):
            rest = tuple(edit for edit in own if edit not in two)
            lanes = _BESIDE_TWO if _of_one_line(*two) else 0
            better = self._in_their_line(search, rest, two[0]) if lanes else []
            if not better:
                better, _done = self._one_more(search, [rest], _ALONE, lanes)
            if better:
                return better
        return found

    @staticmethod
    def _in_their_line(search: LineSearch, rest: Way, one: ProgramEdit) -> list[ProgramRepair]:
        """The one edit in the line of another that does beside the rest."""
        with changed(search.trial, rest):
            here = _beside(search, rest)
            here.rows, here.most = frozenset([(one.part, row_of(one))]), _REACHED
            return here.singles()

    def _after(self, search: LineSearch, firsts: list[Way]) -> list[ProgramRepair]:
        """What is left once edits stand: of several ways the first beside which anything does."""
        for turn, way in enumerate(firsts):
            if self.left <= 0:
                break
            try:
                with changed(search.trial, way):
                    here = _beside(search, way)
                    more = (search.most - search.work.done) // _STEPS
                    likeliest = 0 if turn else search.most // _STEPPING
                    here.most = min(max(here.most, more, likeliest), self.left)
                    found = here.singles()
                    self.left -= here.work.done
                    # two more only beside the likeliest: others gain as much by accident
                    if not found and not turn and len(here.stand) < _DEEPEST:
                        found = self.found(here)
            except NoProgramError:
                continue
            if found:
                return self.settled(search, found, 1)
        return []

    def settled(
        self, search: LineSearch, found: list[ProgramRepair], turns: int = 0
    ) -> list[ProgramRepair]:
        """The first repair with each of its edits the likeliest beside the others.

        What leaves more of the program as a textbook has it is likelier.
        """
        if not found or turns == _TURNS:
            return found
        own = found[0].edits[len(search.stand) :]
        right = search.left_right(own)
        rivals = [*found[0].rivals]
        # the last one was the likeliest beside the others when it was found so
        for edit in own[:-1] if turns else own:
            others = tuple(one for one in own if one is not edit)
            try:
                with changed(search.trial, others):
                    here = _beside(search, others)
                    cost = here.likely(edit)
                    better = here.singles(cost + _NEXT)[:_COMPARED]
            except NoProgramError:
                continue
            if better and any(x.edits[-1].node is edit.node for x in better[0].rivals):
                return self.settled(search, better, turns + 1)  # it has more company
            for k, one in enumerate(better):
                more = search.left_right((*others, one.edits[-1])) - right
                gap = here.likely(one.edits[-1]) - cost
                if not more and abs(gap) <= SAME and _apart([edit, one.edits[-1]])[1:]:
                    rivals.append(one)
                if k and more <= 0:
                    continue  # the first is the likeliest of those that leave no more right
                if gap < (_GAINED if more > 0 else _LOST) * more:
                    return self.settled(search, better[k:], turns + 1)
        return [replace(found[0], rivals=(*rivals[:1],)), *found[1:]]


def _is_plain(repair: ProgramRepair) -> bool:
    """Whether one edit, and no far-fetched one, leaves nothing."""
    return repair.cost < _FAR and repair.error <= TOLERANCES.formula_agrees


def _is_far(repair: ProgramRepair, stand: Way) -> bool:
    """Whether it is of three edits or more, one of them far-fetched: two others may do as well."""
    own = repair.edits[len(stand) :]
    return len(own) > _DEEPEST and max(edit.cost for edit in own) >= _FAR


def _beside(search: LineSearch, edits: Way, thorough: bool = False) -> LineSearch:
    """The search for more while these edits stand, too, with what is right by them."""
    here = search.beside((*search.stand, *edits), thorough)
    here.look_again()
    return here


def _mistyped(search: LineSearch) -> list[Way]:
    """Numbers that are off beside the arm's table, as it has them: all of them, and each alone."""
    odd = _apart([*mistyped(search.trial, search.observed, search.case.robot)])
    each: list[Way] = [(edit,) for edit in odd]
    return [tuple(odd), *each] if 1 < len(odd) <= _DEEPEST else each[:_ODD]


def _of_one_line(one: ProgramEdit, other: ProgramEdit) -> bool:
    return DATA not in (one.part, other.part) and row_of(one) == row_of(other)


def _nearest(search: LineSearch) -> list[Way]:
    """The edits that take most of what is wrong away, far more than any by accident."""
    wanted = search.asked.wanted[search.asked.first]
    own = search.asked.values(search.asked.first)
    if own is None:
        return []
    before = np.linalg.norm(own - wanted)
    left = [(np.linalg.norm(values - wanted), edit) for edit, values in search.tried]
    near = sorted((one for one in left if _NEARER * one[0] <= before), key=lambda one: one[0])
    return [(edit,) for edit in _apart([edit for _left, edit in near])[:_WAYS]]


def _apart(edits: list[ProgramEdit]) -> list[ProgramEdit]:
    """Of edits in one place the first: it is enough to go on from."""
    apart: dict[Any, ProgramEdit] = {}
    for edit in edits:
        apart.setdefault(_place(edit), edit)
    return [*apart.values()]


def _place(edit: ProgramEdit) -> tuple[int, Any, Any]:
    """Where an edit is."""
    return edit.part, getattr(edit.node, "lineno", edit.node), edit.place


class _Tried:
    """Combinations of edits, tried in the program."""

    def __init__(self, search: LineSearch) -> None:
        self.search = search

    def likeliest(self, known: Effects, ranked: list[Chosen]) -> list[ProgramRepair]:
        """What combinations make of it, as many as some work allows.

        Beside one that makes it right others are looked at: what has the same effects, what comes
        next, and pairs that explain as much.
        """
        most, before = self.search.most // 4, self.search.work.done
        fitting: list[Way] = []
        for turn, chosen in enumerate(ranked):
            few = [*known.edits(chosen, _SIBLINGS if turn < _VERIFIED else 1)]
            more = known.edits(chosen, _EVERY) if turn < _VERIFIED else iter(())
            for k, way in enumerate(chain(few, (way for way in more if way not in few))):
                # what is right by this arm's numbers alone may have a sibling that is right
                if k == len(few) and not self.fits(few[0]):
                    break
                most -= self._cost(way)
                if self._repair(way) is not None:
                    fitting = [way]
                    break
            if fitting or most < 0 or self.search.work.done - before > self.search.most:
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
            if way != fitting[0] and self.fits(way):
                fitting.append(way)
        return self._ranked(fitting)

    def of_ways(self, ways: list[Way]) -> list[ProgramRepair]:
        """What combinations that fit at some states make of it, the likeliest first."""
        fitting = [way for way in ways if self.fits(way)]
        return self._ranked(fitting) if fitting else []

    def _cost(self, way: Way) -> int:
        return max(self.search.work.of(edit) for edit in way)

    def _repair(self, way: Way) -> ProgramRepair | None:
        """The repair, if edits make the program right."""
        try:
            with changed(self.search.trial, way):
                return self.search.verdict((*self.search.stand, *way))
        except NoProgramError:
            return None

    def fits(self, way: Way) -> bool:
        """Whether edits make the program right at the first states."""
        try:
            with changed(self.search.trial, way):
                values = self.search.asked.values(self.search.asked.first)
        except NoProgramError:
            return False
        return values is not None and bool(self.search.asked.right(values).all())

    def _ranked(self, ways: list[Way]) -> list[ProgramRepair]:
        """Those first that leave most of the program as a textbook has it."""
        search = self.search
        costs = {way: sum(map(search.likely, way)) for way in ways}
        ranked = sorted(costs, key=lambda way: costs[way])
        near = [way for way in ranked if costs[way] <= costs[ranked[0]] + _ALIKE][:_RIVALS]
        rights = dict.fromkeys(near, 0)
        if len(near) > 1 and search.evidence.known:
            rights = {way: search.left_right(way) + sum(map(self._own, way)) for way in near}
            near.sort(key=lambda way: (-rights[way], costs[way]))
        found: list[ProgramRepair] = []
        for way in [*near, *(way for way in ranked if way not in near)]:
            repair = self._repair(way)
            found += [] if repair is None else [repair]
            if len(found) == _NAMED:
                break
        found = search.of_any_arm(found)
        own = [way for way in near if any(repair.edits[-len(way) :] == way for repair in found)]
        if len(own) > 1 and rights[own[0]] == rights[own[1]] and self._tied(own[0], own[1], costs):
            found[0] = replace(found[0], rivals=(found[1],))
        return found

    def _tied(self, one: Way, other: Way, costs: dict[Way, float]) -> bool:
        """Whether nothing tells which of two repairs of different places it is."""
        apart = {_place(edit) for edit in one} != {_place(edit) for edit in other}
        near = _TIED_BESIDE if {*one} & {*other} else _TIED
        return apart and abs(costs[one] - costs[other]) <= near

    def _own(self, edit: ProgramEdit) -> bool:
        """Whether a number that is nothing of the arm's becomes one of its own."""
        known = self.search.evidence.known
        if edit.part != DATA or edit.numbers is None:
            return False
        old, new = (meaning_of(known, [np.array(x)] * len(known)) for x in edit.numbers)
        return (old is None or bool(old.form)) and new is not None and not new.form
