"""The edits that make a program right: one, or several together.

Each edit is tried at a few states; what is right there is tried at all of them. The work is
counted in what its operations amount to, not in seconds, so that the answer is the same on every
machine.
"""

from __future__ import annotations

import ast
import copy
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import beginning, called, copied, nodes, pieces, text_of
from kinlab.doctor.changes import Case, table_of
from kinlab.doctor.glossary.linkage import linkage_meanings
from kinlab.doctor.glossary.textbook import Glossary, meanings, without_base
from kinlab.doctor.program.grounds.dimensions import Dimensions
from kinlab.doctor.program.grounds.evidence import Grounds
from kinlab.doctor.program.grounds.suspects import suspects
from kinlab.doctor.program.lanes.run import InLanes
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit, changed, row_of
from kinlab.doctor.program.read import OwnProgram
from kinlab.doctor.program.search.arms import moves, other_arms_of
from kinlab.doctor.program.search.asked import Asked
from kinlab.doctor.program.search.chosen import chosen
from kinlab.doctor.program.search.company import in_company
from kinlab.doctor.program.search.solved import Solver
from kinlab.doctor.program.search.units import Units
from kinlab.doctor.program.search.work import Work
from kinlab.doctor.program.trial import FailedError, NoProgramError, Trial, quietly
from kinlab.doctor.program.variants import Variants
from kinlab.fivebar.linkage import FiveBar
from kinlab.tolerances import TOLERANCES

_WORK = 45_000_000
"""Operations of numbers, or what amounts to them, of which all searches have their share."""
_ALONE = 50_000_000
"""What may be done for single edits beside which none stands."""
_FURTHER = 6000
"""Edits that are run all at once where there is no time to run each."""
_MORE_WORK, _WOVEN = 70_000_000, 5000
"""Work that may be done for them; what putting one in amounts to."""
_HEAVY, _FIRST, _HEAVY_WORK = 100_000, 150, 200_000_000
"""Work for one edit above which so many are run alone, and the others at once; work for these."""
_AT_ONCE = 400
"""How many of them at a time."""
_FEWEST = 16
"""Of fewer none is looked for that spoils it for the others."""
_RARER = 4
"""To how many of these comes one that is run alone."""
_WEIGHED = 9000
"""Edits that are weighed, and may be tried."""
_SHARE = 6
"""Of that work, the part of each search beside edits that stand already."""
_TIED = 0.06
"""Cost beyond the first repair's up to which others are looked for."""
_DOUBTED = 0.12
"""The same where a factor is found that a name of the program has as its value."""
_ROUGH, _ROUGHER = 0.15, 100.0
"""What a repair costs more that leaves differences; how much more one may leave than another."""
_ALIKE = 0.03
"""Costs that are nothing to go by beside what a repair leaves right."""
_BESIDE = 0.08
"""The same of a missing term beside a factor, where it makes more what a textbook has."""
_SET = 0.1
"""What a sign may cost more where a name is set than one in front of it."""
SAME = 0.011
"""Costs that are one."""
_HELD = 8
"""Repairs of which it is looked whether they hold for other arms."""
_RIVALS = 4
"""Lines of which it is looked what their repairs leave right."""
_TORQUES = (
    "inverse_dynamics",
    "forward_dynamics",
    "gravity_torques",
    "coriolis_torques",
    "lagrange_torques",
)
"""Quantities whose numbers are of one dimension, where all joints turn."""
_MORE = 6
"""States at which what is right at the first ones is tried before all of them."""
_DEAR = 0.06
"""What an edit waits longer for ten times the work."""
_SUSPECTED = 2
"""Of so much work one part goes first to statements that are wrong though their parts are right."""
_NUMBER = 1.15
"""Cost of an edit above which it is rather a wrong number that explains the program."""
_SOLVED = 20_000_000
"""Work beyond that for single edits in which wrong numbers are solved for."""
_UNITS = 2
"""Of the work for single edits the part for functions that are asked alone."""
_STANDING = 2
"""Edits beside which some number would do too easily."""


@dataclass(frozen=True, eq=False)
class ProgramRepair:
    """Edits that make a program right.

    Attributes:
        edits: one or several.
        error: the relative error that is left.
        cost: how far-fetched they are.
        rivals: repairs of other lines that nothing tells from this one.
    """

    edits: tuple[ProgramEdit, ...]
    error: float
    cost: float
    rivals: tuple[ProgramRepair, ...] = ()


def _beside(one: ProgramRepair, other: ProgramRepair) -> ProgramRepair:
    return replace(one, rivals=(other,))


class LineSearch:
    """A wrong program beside what it should answer.

    Args:
        program: what was read of it.
        case: the states, and the program's own answers.
        wanted: the right answers, (N, ...).
        allowed: the relative error that may be left.
    """

    def __init__(self, program: OwnProgram, case: Case, wanted: Array, allowed: float) -> None:
        self.stand: tuple[ProgramEdit, ...] = ()
        self.tried: list[tuple[ProgramEdit, Array]] = []
        self._alone: list[ProgramRepair] | None = None
        self.parallel: list[ProgramRepair] = []
        self.here: list[ProgramRepair] = []
        self.ahead: list[ProgramEdit] = []
        self.most, self.thorough, self.wide = _WORK, True, True
        self.rows: frozenset[tuple[int, int]] = frozenset()
        self.trial, self.case = Trial(program), case
        self.asked = Asked(self.trial, case, wanted, allowed)
        states = [
            {name: stack[k] for name, stack in case.arguments.items()} for k in self.asked.watched
        ]
        self.things: list[list[Glossary]] = [[]]
        if isinstance(case.robot, FiveBar):
            self.things = [[linkage_meanings(case.robot, state) for state in states]]
        elif table_of(case.robot) is not None:
            arms = [case.robot, without_base(case.robot)]
            self.things = [[meanings(x, state) for state in states] for x in arms if x is not None]
        self.observed = Observed(self.trial, self.asked.states)
        self.work = Work(self.asked, self.observed)
        self.heavy = self.work.of_all(self.work.first) > _HEAVY
        self.in_lanes = _HEAVY_WORK if self.heavy else _ALONE + _MORE_WORK
        self.evidence = self._grounds()
        self.arms = other_arms_of(self.asked, self.observed, self.work)
        given, alike = [*case.arguments], case.quantity.name in _TORQUES
        self.dimensions = Dimensions(
            self.trial, self.observed, case.robot, given, self.asked.states, alike
        )
        self.suspected = suspects(self.trial, self.observed, self.known)
        self.suspected |= self.dimensions.apart

    @property
    def known(self) -> list[Glossary]:
        """The textbook's things at the states at which the program is watched."""
        return self.evidence.known

    def _grounds(self) -> Grounds:
        """What is right in the program, in the axes of the base in which more of it is."""
        given, stepping = (self.trial, self.observed), self.asked.differences
        robot = self.case.robot
        every = [Grounds(*given, known, stepping, robot) for known in self.things]
        return max(every, key=lambda one: one.count(self.observed)) if len(every) > 1 else every[0]

    @property
    def written_out(self) -> bool:
        """Whether it is a formula written out: no loops, no products of matrices."""
        return not any(
            isinstance(node, ast.For | ast.While | ast.comprehension | ast.MatMult)
            or (isinstance(node, ast.Call) and called(node) in ("cross", "dot"))
            for part in self.trial.program.parts
            for node in nodes(part.tree)
        )

    def beside(self, stand: tuple[ProgramEdit, ...], thorough: bool = False) -> LineSearch:
        """The search for more, while edits stand in the program.

        Args:
            stand: the edits.
            thorough: whether as much is done as if nothing stood; else a part of it.
        """
        other = copy.copy(self)
        other.stand, other.tried, other.thorough, other.wide = stand, [], thorough, False
        other._alone, other.ahead, other.here = None, [], []
        if not thorough:
            other.most, other.in_lanes, other.heavy = self.most // _SHARE, 0, False
        other.work = copy.copy(self.work)
        other.work.done = 0
        other.arms = replace(self.arms, work=other.work)
        return other

    def look_again(self) -> None:
        """Watches the program as it stands now: what is right in it may be more than before.

        A program that fails at one of its states then is as it was seen last.
        """
        with suppress(FailedError):
            self.observed = Observed(self.trial, self.asked.states)
        self.arms = replace(self.arms, observed=self.observed)
        self.evidence = self._grounds()

    def singles(self, below: float = np.inf) -> list[ProgramRepair]:
        """Single edits that make the program right, the likeliest first.

        Args:
            below: what they cost at most; of any cost they are looked for once.
        """
        if below < np.inf:
            return self._singles(below)
        if self._alone is None:
            self._alone = self._singles(below)
        return self._alone

    def _singles(self, below: float) -> list[ProgramRepair]:
        found: list[ProgramRepair] = []
        self.parallel, self.here = [], []
        best, doubted = np.inf, False
        limit = _ALONE if self.thorough else self.most
        with quietly():
            most = _WEIGHED if self.thorough or self.rows else _WEIGHED // 3
            every = chosen(self.asked, self.observed, self.known, self.dimensions, below, most)
            if self.rows:
                every = [x for x in every if x.part != DATA and (x.part, row_of(x)) in self.rows]
            every = [edit for edit in every if not self.evidence.spoils_a_helper(edit)]
            more = self._waits()
            likely = {edit: self.likely(edit) for edit in every}
            dear = {edit: cost + more[edit.part] for edit, cost in likely.items()}
            tried = self._in_turn(sorted(every, key=dear.__getitem__))
            if sum(map(self.work.of, tried)) > limit:
                self.ahead = self._ahead(tried, limit // _UNITS)
                tried = [*dict.fromkeys([*self.ahead, *tried])]
            variants = Variants(self.trial, tried)
            for turn, edit in enumerate(tried):
                farthest = best + (_DOUBTED if doubted else _TIED)
                if found and likely[edit] > farthest:
                    continue
                self.work.done += self.work.of(edit)
                if self.work.done > limit or (self.heavy and turn == _FIRST and not found):
                    found = found or self._in_lanes(tried[turn:][:_FURTHER])
                    break
                try:
                    with self.trial.changed({edit.part}, edit.changes, variants.of(edit)):
                        values = self.asked.values(self.asked.first)
                        if values is None:
                            continue
                        self.tried.append((edit, values))
                        repair = self.verdict((*self.stand, edit), values)
                except NoProgramError:
                    continue
                if repair is not None:
                    found.append(repair)
                    rough = repair.error > TOLERANCES.formula_agrees
                    best = min(best, likely[edit] + _ROUGH * rough)
                    doubted = doubted or self.evidence.coincident(edit)
            found = found or ([] if self.stand else self.parallel[:1])
            found = self._by_name(self._by_evidence(found))
            found = self.as_named(found)
            if not self.stand or below < np.inf:
                found = in_company(found, self.likely, SAME, self.trial, _beside)
            found = self._beside_data(self._or_transposed(found, tried))
            if below < np.inf:
                return found
            if len(self.stand) < _STANDING and (not found or best > _NUMBER):
                found = self._numbers() + found
            elif not self.stand and (found[0].edits[-1].part != DATA or moves(found[0].edits[-1])):
                found = self._numbers(strange=True) + found
        return found

    def _ahead(self, tried: list[ProgramEdit], most: int) -> list[ProgramEdit]:
        """The edits with which a function, asked alone, answers what a textbook has."""
        units = Units(self.asked, self.observed, self.evidence, self.work)
        return units.repairs(tried, most)

    def _in_lanes(self, rest: list[ProgramEdit]) -> list[ProgramRepair]:
        """Those of further edits that make the program right: they are run all at once.

        One that calls a function of the program's would run it for its own lane alone: these are
        run one by one, in turn with the others.
        """
        own = self.asked.values(self.asked.first)
        if own is None:
            return []
        found: list[ProgramRepair] = []
        parts = {part.name for part in self.trial.program.parts}
        calling: list[ProgramEdit] = []
        others: list[ProgramEdit] = []
        for edit in rest:
            (calling if _calls(edit, parts) else others).append(edit)
        variants = Variants(self.trial, calling)
        for k in range(0, len(rest), _AT_ONCE):
            if self.work.done > self.in_lanes:
                break
            some, n = others[k : k + _AT_ONCE], k // _RARER
            told = self._run_in_parts(some, own) if some else []
            told += self._run_alone(calling[n : n + _AT_ONCE // _RARER], variants)
            for edit, values in told:
                self.tried.append((edit, values))
                if self.asked.right(values).all():
                    with changed(self.trial, (edit,)):
                        repair = self.verdict((*self.stand, edit))
                    found += [] if repair is None else [repair]
        return found

    def _run_alone(
        self, some: list[ProgramEdit], variants: Variants
    ) -> list[tuple[ProgramEdit, Array]]:
        """What edits make of the program, each run by itself."""
        found: list[tuple[ProgramEdit, Array]] = []
        for edit in some:
            self.work.done += self.work.of(edit)
            if self.work.done > self.in_lanes:
                break
            try:
                with self.trial.changed({edit.part}, edit.changes, variants.of(edit)):
                    values = self.asked.values(self.asked.first)
            except NoProgramError:
                continue
            found += [] if values is None else [(edit, values)]
        return found

    def _run_in_parts(self, some: list[ProgramEdit], own: Array) -> list[tuple[ProgramEdit, Array]]:
        """The same in halves where one that lanes cannot follow spoils it for the others."""
        found = self._run_at_once(some, own)
        if found or len(some) < _FEWEST or self.work.done > self.in_lanes:
            return found
        half = len(some) // 2
        return [*self._run_in_parts(some[:half], own), *self._run_in_parts(some[half:], own)]

    def _run_at_once(self, some: list[ProgramEdit], own: Array) -> list[tuple[ProgramEdit, Array]]:
        """What edits make of the program, as far as lanes can follow it."""
        states, left = self.asked.states_at(self.asked.first), self.in_lanes - self.work.done
        try:
            lanes = InLanes(self.trial, self.observed, [[one] for one in some], states, False)
        except NoProgramError:
            return []
        none, each = np.array([[-1]]), np.arange(len(some))[:, None]
        answers = [lanes.answers(which, None, left) for which in (none, each)]
        self.work.done += lanes.work + _WOVEN * len(some)
        as_it_is, values = (None if one is None else self.asked.of_lanes(one) for one in answers)
        if as_it_is is None or values is None or not self.asked.same(as_it_is[0], own):
            return []
        placed = [k for k in sorted(lanes.placed) if np.isfinite(values[k]).all()]
        return [(some[k], values[k]) for k in placed]

    def _by_evidence(self, found: list[ProgramRepair]) -> list[ProgramRepair]:
        """The likeliest first; of repairs of several lines the one that leaves more of them right.

        What nothing tells apart is marked as tied.
        """
        least = max(TOLERANCES.formula_agrees, _ROUGHER * min([x.error for x in found], default=0))
        found = [repair for repair in found if repair.error <= least]
        found.sort(key=lambda repair: self.likely(repair.edits[-1]))
        if len(found) < 2 or not self.evidence.known:
            return found
        found = self.of_any_arm(found)
        first = self._where_it_is_set(found[0], found)
        found = [first, *(one for one in found if one is not first)]
        best = first.edits[-1]
        likeliest = self.likely(best)
        lines: dict[Any, ProgramRepair] = {}
        others: dict[Any, ProgramRepair] = {}
        for repair in found:
            edit = repair.edits[-1]
            cost = self.likely(edit)
            if edit.part == DATA or cost > likeliest + _BESIDE:
                continue
            row, near = row_of(edit), cost <= likeliest + _ALIKE
            if row not in lines and near:
                lines[row] = repair
            elif near or _more_than(best, edit):
                others.setdefault((row, edit.kind), repair)
        lines |= others
        if len(lines) < 2:
            return found
        rights = {id(one): self.left_right(one.edits[-1:]) for one in [*lines.values()][:_RIVALS]}
        most = max(rights.values())
        ahead = [one for one in lines.values() if rights.get(id(one)) == most]
        first = ahead[0]
        row = row_of(first.edits[-1])
        least = self.likely(first.edits[-1]) + SAME
        same = [
            one
            for one in ahead
            if one is first or row_of(one.edits[-1]) != row
            if (abs(one.cost - first.cost) <= SAME and self.likely(one.edits[-1]) <= least)
            or _turns_the_product(first.edits[-1], one.edits[-1])
        ]
        rivals = [one for one in same[1:2] if not _add_the_same(first.edits[-1], one.edits[-1])]
        first = replace(first, rivals=tuple(rivals))
        return [first, *(one for one in found if one.edits != first.edits)]

    def _or_transposed(
        self, found: list[ProgramRepair], tried: list[ProgramEdit]
    ) -> list[ProgramRepair]:
        """The first, of another sign, with the transpose in its line that does as well beside it.

        ``-T[0, 1]`` or ``T[1, 0]`` of a turn in the plane, ``-C @ C`` or ``C @ C.T`` of what is
        skew. Of several it is the one that is written shortest.
        """
        first = found[0].edits[-1] if found and not (found[0].rivals or self.stand) else None
        if first is None or first.kind != "sign" or first.part == DATA:
            return found
        turned = (x for x in tried if (x.kind, x.part) == ("transposed", first.part))
        others: dict[int, ProgramRepair] = {}
        for edit in turned:
            if row_of(edit) == row_of(first):
                self.work.done += self.work.of(edit)
                with suppress(NoProgramError), self.trial.changed({edit.part}, edit.changes):
                    repair = self.verdict((edit,))
                    if repair is not None:
                        length = sum(len(ast.unparse(one)) for one in self.trial.trees)
                        others[length] = repair
        return [_beside(found[0], others[min(others)]), *found[1:]] if others else found

    def _beside_data(self, found: list[ProgramRepair]) -> list[ProgramRepair]:
        """The first with a rival in the data, or in a line if it is of the data, as likely as it.

        ``G = -9.81`` above, or a minus where G is used.
        """
        first = found[0].edits[-1] if found and not found[0].rivals else None
        if first is None or first.kind != "sign":
            return found
        for one in found[1:]:
            edit = one.edits[-1]
            apart = (edit.part == DATA) != (first.part == DATA) and edit.kind == first.kind
            near = apart and abs(self.likely(edit) - self.likely(first)) <= SAME
            if near and self.left_right((edit,)) == self.left_right((first,)):
                return [_beside(found[0], one), *found[1:]]
        return found

    def _where_it_is_set(self, first: ProgramRepair, found: list[ProgramRepair]) -> ProgramRepair:
        """Of a sign in front of a name the one where the name is set, if it is right so.

        And of a term that a name lacks where it is used.
        """
        edit = first.edits[-1]
        added = edit.kind == "missing term"
        used = edit.node if added else getattr(edit.node, "right", None)
        name = getattr(used, "id", None)
        if edit.kind not in ("sign", "missing term") or edit.part == DATA or name is None:
            return first
        right = self.left_right(first.edits[-1:]) - added
        lines = (x for x in nodes(self.trial.trees[edit.part]) if isinstance(x, ast.Assign))
        values = {id(x.value) for x in lines if getattr(x.targets[0], "id", "") == name}
        for other in found:
            one = other.edits[-1]
            near = one.kind == edit.kind and self.likely(one) <= self.likely(edit) + _SET
            if near and id(one.node) in values and self.left_right(other.edits[-1:]) > right:
                return other
        return first

    def as_named(self, found: list[ProgramRepair]) -> list[ProgramRepair]:
        """The first with the names to which what is put in was set before: ``Ia`` for its sum."""
        return [self._as_named(one) for one in found[:1]] + found[1:]

    def _as_named(self, repair: ProgramRepair) -> ProgramRepair:
        own = repair.edits[len(self.stand) :]
        for k, edit in enumerate(own):
            other = self._named(edit)
            if other is None:
                continue
            several = (*own[:k], other, *own[k + 1 :])
            with changed(self.trial, several):
                named = self.verdict((*self.stand, *several))
            if named is not None:
                return self._as_named(replace(named, rivals=repair.rivals))
        return repair

    def _named(self, edit: ProgramEdit) -> ProgramEdit | None:
        """The edit that puts a name in for a sum, or a product, to which it was set above."""
        new = edit.changes[0].new if len(edit.changes) == 1 else None
        if edit.part == DATA or not isinstance(new, ast.BinOp):
            return None
        every = nodes(self.trial.trees[edit.part])
        for line in (x for x in every if isinstance(x, ast.Assign)):
            to, before = line.targets[0], line.lineno < getattr(edit.node, "lineno", 0)
            if before and isinstance(to, ast.Name) and text_of(line.value) == text_of(new):
                put = (replace(edit.changes[0], new=ast.Name(to.id, ast.Load())),)
                return replace(edit, changes=put, kind="name")
        return None

    def _by_name(self, found: list[ProgramRepair]) -> list[ProgramRepair]:
        """The name for a factor that it has as its value, where no other arm tells them apart."""
        if not found or any(self.arms.before) or not self.evidence.coincident(found[0].edits[-1]):
            return found
        edit, space = found[0].edits[-1], self.trial.space
        change = edit.changes[0]
        first = copied(change.new) if isinstance(change.new, ast.BinOp) else None
        below = beginning(first) if first is not None else None
        value = getattr(getattr(below, "left", None), "value", None)
        for name in (*self.trial.program.data, *self.trial.sets):
            own = space.get(name)
            if type(own) is not float or own != value or not isinstance(below, ast.BinOp):
                continue
            below.left = ast.Name(name, ast.Load())
            put = (replace(change, new=first),)
            other = replace(edit, changes=put, kind="missing factor")
            with changed(self.trial, (other,)):
                repair = self.verdict((*self.stand, other))
            if repair is not None:
                return [_beside(repair, found[0]), *found]
        return found

    def of_any_arm(self, found: list[ProgramRepair]) -> list[ProgramRepair]:
        """Of repairs those that hold for other arms too, where some do and some do not."""
        for kind, _arm in enumerate(self.arms.before):
            held: list[ProgramRepair] = []
            for repair in found[:_HELD]:
                with changed(self.trial, repair.edits[len(self.stand) :]):
                    other = self.arms.of(repair.edits)[kind]
                    held += [repair] if other is not None and self.arms.hold_for(other) else []
            if held:
                return [*held, *(one for one in found[_HELD:])]
        return found

    def _numbers(self, strange: bool = False) -> list[ProgramRepair]:
        """The single number, of the text or the data, with which the program is right.

        Of several the one that is typed with the fewest digits: others only make up for it.

        Args:
            strange: only those of the data that are none of the robot's, and become one.
        """
        found: list[tuple[float, int, ProgramRepair]] = []
        solver = Solver(self.asked, self.observed, self.evidence, self.work)
        most = (max(_ALONE, self.work.done) if self.thorough else self.most) + _SOLVED
        for value, edit in solver.edits(most, strange):
            with changed(self.trial, (edit,)):
                repair = self.verdict((*self.stand, edit))
            if repair is not None:
                found.append((self.evidence.against(edit), len(f"{value:.12g}"), repair))
        return [min(found, key=lambda one: one[:2])[2]] if found else []

    def left_right(self, several: tuple[ProgramEdit, ...]) -> int:
        """How many statements are what a textbook has, once edits stand."""
        with changed(self.trial, several):
            try:
                return self.evidence.count(Observed(self.trial, self.asked.states))
            except FailedError:  # what cannot be watched tells nothing
                return 0

    def likely(self, edit: ProgramEdit) -> float:
        """Its cost, and what speaks against it."""
        return edit.cost + self.evidence.against(edit)

    def _waits(self) -> dict[int, float]:
        """What an edit of each part costs more where much has to be run anew."""
        runs, whole = self.work.amounts, max(1, self.work.amounts[0])
        return {part: _DEAR * float(np.log10(max(1, run) / whole)) for part, run in runs.items()}

    def _in_turn(self, ranked: list[ProgramEdit]) -> list[ProgramEdit]:
        """The likeliest first, and in turn with them those of suspected statements."""
        turn: dict[ProgramEdit, float] = {}
        every = among = 0
        for edit in ranked:
            every += self.work.of(edit)
            turn[edit] = every
            if id(edit.node) in self.suspected:
                among += self.work.of(edit)
                turn[edit] = min(every, _SUSPECTED * among)
        return sorted(ranked, key=lambda edit: turn[edit])

    def verdict(
        self, several: tuple[ProgramEdit, ...], values: Array | None = None
    ) -> ProgramRepair | None:
        """The repair, if the program as it stands now is right at every state."""
        values = self.asked.values(self.asked.first) if values is None else values
        if values is None or not self.asked.right(values).all():
            return None
        error = 0.0
        for count in (min(_MORE, len(self.asked.wanted)), len(self.asked.wanted)):
            self.work.done += self.work.of_all(count)
            error = self.asked.error(range(count))
            if not error <= self.asked.allowed:
                return None
        repair = ProgramRepair(several, error, sum(edit.cost for edit in several))
        if not self.arms.only_here(several):
            return repair
        if not self.stand and len(several) == 1 and self.arms.holds_for_parallel_axes():
            self.parallel.append(repair)
        self.here += [repair] if len(several) == 1 else []
        return None


def _turns_the_product(sign: ProgramEdit, other: ProgramEdit) -> bool:
    """Whether a cross product the other way round does what a name's other sign does."""
    node = other.node
    crossed = isinstance(node, ast.Call) and called(node) == "cross" and other.kind == "order"
    return sign.kind == "sign" and isinstance(sign.node, ast.Name) and crossed


def _add_the_same(one: ProgramEdit, other: ProgramEdit) -> bool:
    """Whether two edits add one term, in two lines of one sum: ``Q = Q + a`` and ``Q = Q + b``."""
    put = [edit.changes[0] for edit in (one, other) if edit.kind == "missing term"]
    lines = [(x.holder, x.new) for x in put if isinstance(x.holder, ast.Assign)]
    added = [
        (ast.dump(line.targets[0]), ast.dump(new.right))
        for line, new in lines
        if isinstance(new, ast.BinOp)
    ]
    return len(added) > 1 and added[0] == added[1]


def _calls(edit: ProgramEdit, functions: set[str]) -> bool:
    """Whether an edit puts a call of one of some functions in."""
    inner = (x for c in edit.changes if isinstance(c.new, ast.expr) for x in pieces(c.new))
    put = sum(called(x) in functions for x in inner if isinstance(x, ast.Call))
    if not put or edit.part == DATA:
        return put > 0
    old = (x for x in pieces(edit.node) if isinstance(x, ast.Call))
    return put > sum(called(x) in functions for x in old)


def _more_than(factor: ProgramEdit, edit: ProgramEdit) -> bool:
    """Whether an edit adds a term to what another one only multiplies, in one line."""
    same = factor.part == edit.part != DATA and row_of(factor) == row_of(edit)
    return same and (factor.kind, edit.kind) == ("factor", "missing term")
