"""The edits that make a program right: one, or several together.

Each edit is tried at a few states; what is right there is tried at all of them. The work is
counted in what its operations amount to, not in seconds, so that the answer is the same on every
machine.
"""

from __future__ import annotations

import ast
import copy
import math
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from fractions import Fraction
from types import FunctionType
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes, relative_errors
from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.changes import ANY_ZERO, Case, table_of
from kinlab.doctor.glossary.linkage import linkage_meanings
from kinlab.doctor.glossary.textbook import Glossary, meanings
from kinlab.doctor.program.edits.every import edits
from kinlab.doctor.program.edits.numbers.as_the_arm import as_it_is, of_table
from kinlab.doctor.program.edits.numbers.data import NumberPlace, numbers
from kinlab.doctor.program.edits.numbers.own_numbers import of_own_numbers
from kinlab.doctor.program.edits.scope import Scope
from kinlab.doctor.program.grounds.apart import arm_apart
from kinlab.doctor.program.grounds.dimensions import LIKE, Dimensions
from kinlab.doctor.program.grounds.evidence import Grounds
from kinlab.doctor.program.grounds.products import missing_products
from kinlab.doctor.program.grounds.scaled import (
    OtherArm,
    numbers_of,
    other_arm,
    own_numbers,
    own_rows,
)
from kinlab.doctor.program.grounds.suspects import suspects
from kinlab.doctor.program.grounds.terms import missing_terms
from kinlab.doctor.program.lanes.run import InLanes
from kinlab.doctor.program.observed import Observed, amounts
from kinlab.doctor.program.places import DATA, ROUNDING, ProgramEdit, called, row_of
from kinlab.doctor.program.read import OwnProgram
from kinlab.doctor.program.trial import FailedError, NoProgramError, Trial, named_in, quietly
from kinlab.doctor.program.variants import Variants
from kinlab.errors import KinlabError
from kinlab.fivebar.linkage import FiveBar
from kinlab.formulas.record import state_by_state
from kinlab.tolerances import TOLERANCES

_WORK = 45_000_000
"""Operations of numbers, or what amounts to them, of which all searches have their share."""
_ALONE = 50_000_000
"""What may be done for single edits beside which none stands."""
_FURTHER = 6000
"""Edits that are run all at once where there is no time to run each."""
_QUICK = 1300
"""Edits that have been run alone by then, of programs of which lanes are worth the time."""
_MORE_WORK, _WOVEN = 70_000_000, 5000
"""Work that may be done for them; what putting one in amounts to."""
_AT_ONCE = 400
"""How many of them at a time."""
_WEIGHED = 9000
"""Edits that are weighed, and may be tried."""
_NODE = 30
"""What compiling one node amounts to."""
_ENDING, _LONGER = ast.While | ast.Break, 6
"""What ends when it is near enough, and how much longer it runs with an edit in it."""
_SHARE = 6
"""Of that work, the part of each search beside edits that stand already."""
_NUMBERS = 4
"""Numbers of the answer at which an edit is tried first."""
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
_SAME = 0.011
"""Costs that are one."""
_ARMS = 600_000
"""What it amounts to to find other arms."""
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
_KINEMATIC = ("fk", "jacobian", "planar_jacobian", "jacobian_tool", "jacobian_spatial", "statics")
"""Quantities that no mass has a part in."""
_MORE = 6
"""States at which what is right at the first ones is tried before all of them."""
_SIMPLE = 12
"""Denominator up to which a fraction may be meant."""
_CLEARLY = 0.5
"""Share of a program's largest error that shows it to be wrong at a state."""
_WATCHED = 2
"""States at which a program is watched."""
_DEAR = 0.06
"""What an edit waits longer for ten times the work."""
_SUSPECTED = 2
"""Of so much work one part goes first to statements that are wrong though their parts are right."""
_NUMBER = 1.15
"""Cost of an edit above which it is rather a wrong number that explains the program."""
_ANGLES = 12
"""Into how many parts of pi a number may fall."""
_MULTIPLES = (0.5, 2.0, 0.1, 10.0)
"""Times a number that somebody types for it."""
_SOLVED = 1_200_000
"""Work beyond that for single edits in which wrong numbers are solved for."""
_STRANGE = 4
"""Numbers of the data that are none of the robot's of which each is solved for."""
_STANDING = 2
"""Edits beside which some number would do too easily."""
_TURNS = 8
"""Steps in which a wrong number is solved for."""
_MADE = 0.97
"""Cost of an exchange after which a row is the robot's."""
_ROW = 3
"""Numbers of a row that tell whose it is."""
_DIGITS = 6
"""Digits of a number that somebody may have typed."""
_WHOLE = 3
"""Digits of a number that may stand for a whole one."""


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


class LineSearch:
    """A wrong program beside what it should answer.

    Args:
        program: what was read of it.
        case: the states, and the program's own answers.
        wanted: the right answers, (N, ...).
        allowed: the relative error that may be left.
    """

    def __init__(self, program: OwnProgram, case: Case, wanted: Array, allowed: float) -> None:
        self.program = program
        self.case, self.wanted = case, wanted
        self.stand: tuple[ProgramEdit, ...] = ()
        self.tried: list[tuple[ProgramEdit, Array]] = []
        self.work, self.most = 0, _WORK
        self.in_lanes = _ALONE + _MORE_WORK
        self.trial = Trial(self.program)
        every = (node for tree in self.trial.trees for node in nodes(tree))
        self._whole = {id(node) for node in every if type(getattr(node, "value", None)) is int}
        size = int(np.prod(wanted.shape[1:], initial=1))
        self.first = list(range(max(1, -(-_NUMBERS // size))))
        self.watched = [*self.first, len(self.first)][:_WATCHED]
        self._add_a_wrong_one()
        self.differences = self._differences()
        self.allowed = allowed if self.differences else TOLERANCES.formula_agrees
        self._ask()
        self._prepare()

    def _ask(self) -> None:
        """What is asked of the program at the first states, and what it should answer."""
        asked = self.case.quantity.asked(self.case.robot, self.trial.function)
        self.sizes = error_sizes(self.wanted)
        self._asked = state_by_state(asked)
        self._few = self._at(self.first)
        self._several = self._distinct() if self.case.quantity.read is not None else 1
        self._near = max(TOLERANCES.tried_further, self.allowed) * self.scale

    def _differences(self) -> bool:
        """Whether a number of the program may be the step of a difference."""
        inner = (node for tree in self.trial.trees for node in nodes(tree))
        values = [getattr(node, "value", None) for node in inner]
        values += [self.trial.space[name] for name in self.program.data]
        values += [value for part in self.program.parts for value in _defaults(part.function)]
        words = {word for tree in self.trial.trees for word in named_in(tree)}
        steps = (isinstance(x, float) and 0 < abs(x) <= TOLERANCES.may_be_step for x in values)
        return any(steps) or any("eps" in word or word == "finfo" for word in words)

    def _add_a_wrong_one(self) -> None:
        """Sees to it that the program as it is fails at the first states, if it does anywhere."""
        if self.case.hand.shape != self.wanted.shape:
            return
        errors = relative_errors(self.case.hand, self.wanted)
        clearly = errors > _CLEARLY * np.max(errors)
        if clearly.any() and not clearly[self.first].any():
            self.first.append(int(np.argmax(clearly)))

    def _at(self, which: Sequence[int]) -> tuple[list[Array], Array]:
        """The arguments and the right answers at some states."""
        chosen = list(which)
        return [stack[chosen] for stack in self.case.arguments.values()], self.wanted[chosen]

    def states_at(self, which: Sequence[int]) -> list[tuple[Array, ...]]:
        """Some states, each as the arguments of one call."""
        stacks = self.case.arguments.values()
        return [tuple(stack[k].copy() for stack in stacks) for k in which]

    def from_right_zero(self, values: Array, wanted: Array) -> Array:
        """A potential's answers moved to the right zero; others as they are.

        Args:
            values: at some states, or stacks of these.
            wanted: what is right there.
        """
        if self.case.quantity.name not in ANY_ZERO:
            return values
        firsts = np.take(values, [0], axis=values.ndim - wanted.ndim)
        return np.asarray(values + (wanted[:1] - firsts))

    def of_lanes(self, found: Array) -> Array | None:
        """What is compared of answers in lanes; None of answers of another size.

        Args:
            found: all the numbers of the answers at the first states, or some of these, (C, S, P).
        """
        wanted = self._few[1][: found.shape[1]]
        shape = (len(found), *wanted.shape)
        read, robot = self.case.quantity.read, self.case.robot
        if read is None:
            if found.size != np.prod(shape):
                return None
            return self.from_right_zero(found.reshape(shape), wanted)
        if found.shape[2] % robot.n:
            return None
        solutions = found.reshape(len(found) * len(wanted), -1, robot.n)
        every = np.broadcast_to(wanted, shape).reshape(len(solutions), *wanted.shape[1:])
        return np.asarray(read(robot, solutions, every)).reshape(shape)

    def _prepare(self) -> None:
        self.states = self.states_at(self.watched)
        given, robot = self.case.arguments.items(), self.case.robot
        states = ({name: stack[k] for name, stack in given} for k in self.watched)
        self.known: list[Glossary] = []
        if isinstance(robot, FiveBar):
            self.known = [linkage_meanings(robot, state) for state in states]
        elif table_of(robot) is not None:
            self.known = [meanings(robot, state) for state in states]
        self.observed = Observed(self.trial, self.states)
        self.amounts = amounts(self.trial, self.observed, self.states)
        self.nodes = [len(nodes(tree)) for tree in self.trial.trees]
        ending = (isinstance(one, _ENDING) for tree in self.trial.trees for one in nodes(tree))
        self.longer = _LONGER if any(ending) else 1
        self.evidence = Grounds(self.trial, self.observed, self.known)
        self._others = self._other_arms(self.observed)
        self._there: dict[OtherArm, LineSearch | None] = {}
        alike = self.case.quantity.name in _TORQUES
        self.dimensions = Dimensions(
            self.trial, self.observed, self.case.robot, [*self.case.arguments], self.states, alike
        )
        self.suspected = suspects(self.trial, self.observed, self.known)
        self.suspected |= self.dimensions.apart

    def _watched_at(self, asked: str) -> list[Array]:
        """One of the arguments at the watched states, where the quantity has it."""
        given = self.case.arguments
        return [given[asked][k] for k in self.watched] if asked in given else []

    @property
    def scale(self) -> Array:
        """What differences at the first states are relative to, beside the answers there."""
        sizes = self.sizes[self.first]
        return sizes.reshape(-1, *[1] * (self.wanted.ndim - 1))

    @property
    def faithful(self) -> bool:
        """Whether the program as it was read answers what the user's own function did."""
        with quietly():
            own, hand = self.values(self.watched), self.case.hand[self.watched]
        if own is None or own.shape != hand.shape:
            return False
        hand = self.from_right_zero(hand, self.wanted)
        known = np.abs(hand[np.isfinite(hand)])
        size = max(float(np.max(known, initial=0.0)), float(np.max(self.sizes)))
        return bool(np.allclose(own, hand, rtol=1e-9, atol=1e-9 * size, equal_nan=True))

    @property
    def written_out(self) -> bool:
        """Whether it is a formula written out: no loops, no products of matrices."""
        return not any(
            isinstance(node, ast.For | ast.While | ast.comprehension | ast.MatMult)
            or (isinstance(node, ast.Call) and called(node) in ("cross", "dot"))
            for part in self.program.parts
            for node in nodes(part.tree)
        )

    def at(self, case: Case, wanted: Array) -> LineSearch:
        """The same program asked at other states, all of which are its first."""
        other = copy.copy(self)
        other.case, other.wanted, other.first = case, wanted, list(range(len(wanted)))
        other._others = None, None
        other._ask()
        return other

    def beside(self, stand: tuple[ProgramEdit, ...]) -> LineSearch:
        """The search for more, while edits stand in the program."""
        other = copy.copy(self)
        other.stand, other.tried, other.work, other.most = stand, [], 0, self.most // _SHARE
        other.in_lanes = 0
        return other

    def look_again(self) -> None:
        """Watches the program as it stands now: what is right in it may be more than before."""
        self.observed = Observed(self.trial, self.states)
        self.evidence = Grounds(self.trial, self.observed, self.known)

    def singles(self, below: float = np.inf) -> list[ProgramRepair]:
        """Single edits that make the program right, the likeliest first.

        Args:
            below: what they cost at most.
        """
        found: list[ProgramRepair] = []
        best, doubted = np.inf, False
        limit = self.most if self.stand else _ALONE
        with quietly():
            tried = self._weighed(below)
            variants = Variants(self.trial, tried)
            for turn, edit in enumerate(tried):
                farthest = best + (_DOUBTED if doubted else _TIED)
                if found and self.likely(edit) > farthest:
                    continue
                self.work += self.cost_of(edit)
                if self.work > limit and not (found or self.stand) and turn <= _QUICK:
                    limit = _ALONE + _MORE_WORK  # lanes would take as long
                if self.work > limit:
                    found = found or self._in_lanes(tried[turn:][:_FURTHER])
                    break
                try:
                    with self.trial.changed({edit.part}, edit.changes, variants.of(edit)):
                        values = self.values(self.first)
                        if values is None:
                            continue
                        self.tried.append((edit, values))
                        repair = self.verdict((*self.stand, edit), values)
                except NoProgramError:
                    continue
                if repair is not None:
                    found.append(repair)
                    rough = repair.error > TOLERANCES.formula_agrees
                    best = min(best, self.likely(edit) + _ROUGH * rough)
                    doubted = doubted or self.evidence.coincident(edit)
            found = self._by_evidence(found)
            if below < np.inf:
                return found
            if len(self.stand) < _STANDING and (not found or best > _NUMBER):
                found = self._numbers() + found
            elif not self.stand and found[0].edits[-1].part != DATA:
                found = self._numbers(strange=True) + found
        return found

    def _weighed(self, below: float) -> list[ProgramEdit]:
        """Every edit in the order in which it is tried."""
        scopes = [Scope(self.trial, self.observed, k) for k in range(len(self.trial.trees))]
        every = edits(self.trial, self.observed, scopes)
        every += of_table(self.trial, self.observed, self.case.robot)
        moving = [self._watched_at("q"), self._watched_at("a")]
        every += of_own_numbers(self.trial, self.observed, self.case.robot, *moving)
        every += missing_products(self.trial, self.observed, scopes, self.dimensions)
        every += missing_terms(self.trial, self.observed, scopes, self.dimensions)
        sure = as_it_is(self.trial, self.observed, self.case.robot)
        every = [edit for edit in every if not sure(edit)]
        named, rows = _named_numbers(self.trial), own_rows(self.case.robot)
        every = [
            edit
            for edit in every
            if edit.cost < below and not (self._mirrors(edit, named) or _moves_one_of(rows, edit))
        ]
        most = _WEIGHED // 3 if self.stand else _WEIGHED
        every = [replace(x, cost=_MADE) if _makes_one_of(rows, x) else x for x in every]
        every = sorted(every, key=_at_best)[:most]
        weigh = self.dimensions.against
        every = [replace(x, cost=x.cost + more) if (more := weigh(x)) else x for x in every]
        return self._in_turn(sorted(every, key=self._dear))

    def _in_lanes(self, rest: list[ProgramEdit]) -> list[ProgramRepair]:
        """Those of further edits that make the program right: they are run all at once."""
        own = self.values(self.first)
        if own is None:
            return []
        found: list[ProgramRepair] = []
        for k in range(0, len(rest), _AT_ONCE):
            if self.work > self.in_lanes:
                break
            for edit, values in self._run_at_once(rest[k : k + _AT_ONCE], own):
                self.tried.append((edit, values))
                if self.right(values).all():
                    with changed(self.trial, (edit,)):
                        repair = self.verdict((*self.stand, edit))
                    found += [] if repair is None else [repair]
        return found

    def _run_at_once(self, some: list[ProgramEdit], own: Array) -> list[tuple[ProgramEdit, Array]]:
        """What edits make of the program, as far as lanes can follow it."""
        states, left = self.states_at(self.first), self.in_lanes - self.work
        try:
            lanes = InLanes(self.trial, self.observed, [[one] for one in some], states, False)
        except NoProgramError:
            return []
        none, each = np.array([[-1]]), np.arange(len(some))[:, None]
        answers = [lanes.answers(which, None, left) for which in (none, each)]
        self.work += lanes.work + _WOVEN * len(some)
        as_it_is, values = (None if one is None else self.of_lanes(one) for one in answers)
        if as_it_is is None or values is None or not self.same(as_it_is[0], own):
            return []
        placed = [k for k in sorted(lanes.placed) if np.isfinite(values[k]).all()]
        return [(some[k], values[k]) for k in placed]

    def same(self, values: Array, own: Array) -> bool:
        """Whether answers at the first states are the same, as those of a lane without an edit."""
        none = ~np.isfinite(values) & ~np.isfinite(own)
        return bool((none | (np.abs(values - own) <= self._near)).all())

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
        best = found[0].edits[-1]
        likeliest = self.likely(best)
        lines: dict[Any, ProgramRepair] = {}
        for repair in found:
            edit = repair.edits[-1]
            if edit.part == DATA:
                continue
            if self.likely(edit) <= likeliest + _ALIKE:
                lines.setdefault(row_of(edit), repair)
            elif self.likely(edit) <= likeliest + _BESIDE and _more_than(best, edit):
                lines.setdefault((row_of(edit), edit.kind), repair)
        if len(lines) < 2:
            return found
        rights = {id(one): self.left_right(one.edits[-1:]) for one in [*lines.values()][:_RIVALS]}
        most = max(rights.values())
        ahead = [one for one in lines.values() if rights.get(id(one)) == most]
        first = ahead[0]
        least = self.likely(first.edits[-1]) + _SAME
        same = [
            one
            for one in ahead
            if abs(one.cost - first.cost) <= _SAME and self.likely(one.edits[-1]) <= least
        ]
        first = replace(first, rivals=tuple(same[1:2]))
        return [first, *(one for one in found if one.edits != first.edits)]

    def of_any_arm(self, found: list[ProgramRepair]) -> list[ProgramRepair]:
        """Of repairs those that hold for other arms too, where some do and some do not."""
        for kind, _arm in enumerate(self._others):
            held: list[ProgramRepair] = []
            for repair in found[:_HELD]:
                own = repair.edits[len(self.stand) :]
                with changed(self.trial, own):
                    other = self._arms(own)[kind]
                    held += [repair] if other is not None and self._holds(other) else []
            if held:
                return [*held, *(one for one in found[_HELD:])]
        return found

    def _other_arms(self, observed: Observed) -> tuple[OtherArm | None, OtherArm | None]:
        """An arm whose numbers are unrelated, and one that is larger as a whole.

        A program that rounds need not be right for any other.
        """
        every = (node for tree in self.trial.trees for node in nodes(tree))
        if any(isinstance(node, ast.Call) and called(node) in ROUNDING for node in every):
            return None, None
        masses = self.case.quantity.name not in _KINEMATIC
        asked = self.case.robot, self.trial, observed, masses
        return arm_apart(*asked), other_arm(*asked)

    def _arms(self, several: tuple[ProgramEdit, ...]) -> tuple[OtherArm | None, OtherArm | None]:
        """The same for the program as it stands now, with these edits in it."""
        told = [one for one in (*self.stand, *several) if not self._counts(one)]
        sets = any(one.part == DATA or one.of_the_arm or one.numbers is not None for one in told)
        if not sets or not any(self._others):
            return self._others
        self.work += _ARMS
        try:  # a number that was put in is one of the program's
            return self._other_arms(Observed(self.trial, self.states))
        except FailedError:
            return self._other_arms(self.observed)

    def _holds(self, other: OtherArm) -> bool:
        """Whether the program as it stands now is right for another arm."""
        there = self._at_arm(other)
        if there is None:
            return False
        for edits_ in other.ways:
            self.work += self.longer * self.amounts[0] * len(there.first) // len(self.watched)
            with changed(self.trial, edits_):
                values = there.values(there.first)
            if values is not None and there.right(values).all():
                return True
        return False

    def fits(self, several: tuple[ProgramEdit, ...]) -> bool:
        """Whether edits make the program right at every state, be it for this arm alone."""
        try:
            with quietly(), changed(self.trial, several):
                return self.error(range(len(self.wanted))) <= self.allowed
        except NoProgramError:
            return False

    def holds_elsewhere(self, several: tuple[ProgramEdit, ...]) -> bool:
        """Whether edits make it right for another arm, too, for which it is understood wholly."""
        with quietly(), changed(self.trial, several):
            known = [arm for arm in self._arms(several) if arm is not None and arm.whole]
            return any(self._at_arm(arm) is not None and self._holds(arm) for arm in known)

    def _only_here(self, several: tuple[ProgramEdit, ...]) -> bool:
        """Whether edits hold for this arm alone, where a program that is right holds for others."""
        if self.case.quantity.read is not None:
            return self._distinct() < self._several  # one solution is left out, another given twice
        (before, _), (apart, larger) = self._others, self._arms(several)
        if before is not None and apart is not None:
            odd = apart.odd and len(several) > 1 and not self._holds(apart)
            put = {(edit.node, edit.place) for edit in several if edit.of_the_arm}
            if odd or before.fitting - apart.fitting - put:
                return True  # a name has a number that none has of those that are called so
            if apart.whole and self._at_arm(apart) is not None:
                return not self._holds(apart)
        if any(map(self._sets_a_number, several)):
            return False
        whole = larger is not None and larger.whole and self._at_arm(larger) is not None
        free = any(edit.numbers is not None and _is_free(edit.numbers[1]) for edit in several)
        return (whole or free) and not (larger is not None and self._holds(larger))

    def _counts(self, edit: ProgramEdit) -> bool:
        """Whether an edit is of a whole number in the text, a factor: of none of the arm's."""
        return id(edit.node) in self._whole and not edit.of_the_arm

    def _sets_a_number(self, edit: ProgramEdit) -> bool:
        """Whether an edit gives the program a number that may be this arm's."""
        if edit.part == DATA or edit.of_the_arm:
            return True
        return edit.numbers is not None and not self._counts(edit) and self.is_own(edit.numbers[1])

    def _at_arm(self, other: OtherArm) -> LineSearch | None:
        """The search for what is right of another arm, made when it is first asked for."""
        if other not in self._there:
            self._there[other] = self._of_arm(other)
        return self._there[other]

    def _of_arm(self, other: OtherArm) -> LineSearch | None:
        if other.robot is None:
            return None
        some = {name: stack[self.first] for name, stack in self.case.arguments.items()}
        hand = self.case.hand[self.first]
        case = replace(self.case, robot=other.robot, arguments=some, hand=hand)
        try:
            with np.errstate(all="ignore"):
                return self.at(case, np.asarray(case.answer(()), dtype=float))
        except (KinlabError, np.linalg.LinAlgError):
            return None

    def left_right(self, several: tuple[ProgramEdit, ...]) -> int:
        """How many statements are what a textbook has, once edits stand."""
        with changed(self.trial, several):
            try:
                return self.evidence.count(Observed(self.trial, self.states))
            except FailedError:  # what cannot be watched tells nothing
                return 0

    def likely(self, edit: ProgramEdit) -> float:
        """Its cost, and what speaks against it."""
        return edit.cost + self.evidence.against(edit)

    def cost_of(self, edit: ProgramEdit) -> int:
        """What running and compiling the program amounts to, to try an edit."""
        run = self.longer * self.amounts[edit.part] * len(self.first) // len(self.watched)
        return run + (_NODE * self.nodes[edit.part] if edit.part >= 0 else 0)

    def _dear(self, edit: ProgramEdit) -> float:
        """Its cost, a little more where much has to be run anew."""
        run, whole = max(1, self.amounts[edit.part]), max(1, self.amounts[0])
        return self.likely(edit) + _DEAR * float(np.log10(run / whole))

    def _in_turn(self, ranked: list[ProgramEdit]) -> list[ProgramEdit]:
        """The likeliest first, and in turn with them those of suspected statements."""
        turn: dict[ProgramEdit, float] = {}
        every = among = 0
        for edit in ranked:
            every += self.cost_of(edit)
            turn[edit] = every
            if id(edit.node) in self.suspected:
                among += self.cost_of(edit)
                turn[edit] = min(every, _SUSPECTED * among)
        return sorted(ranked, key=lambda edit: turn[edit])

    def _numbers(self, strange: bool = False) -> list[ProgramRepair]:
        """The single number, of the text or the data, with which the program is right.

        Of several the one that is typed with the fewest digits: others only make up for it.

        Args:
            strange: only those of the data that are none of the robot's, and become one.
        """
        found: list[tuple[float, int, ProgramRepair]] = []
        against = self.evidence.against
        sure = as_it_is(self.trial, self.observed, self.case.robot)
        every = [*numbers(self.trial, self.observed)]
        every = [p for p in every if not sure(p.edit(p.value))]
        if strange:
            own = len(own_numbers(self.case.robot)) > 0
            every = [p for p in every if own and p.part == DATA and self._is_strange(p)][:_STRANGE]
        every.sort(key=lambda place: (not place.value, against(place.edit(place.value))))
        alone = {id(x.place.node) for x in numbers_of(self.trial, self.observed) if x.alone}
        for place in every:
            if self.work > (self.most if self.stand else _ALONE) + _SOLVED:
                break
            value = self._solved(place)
            if value is not None and not self.is_own(value):
                named = place.part == DATA or id(place.node) in alone
                if strange or (named and self.is_own(float(place.value))):
                    continue  # a number with a name would be nobody's
            if value is not None and not self.makes_up(float(place.value), value):
                edit = place.edit(value)
                with changed(self.trial, (edit,)):
                    repair = self.verdict((*self.stand, edit))
                if repair is not None:
                    found.append((against(edit), len(f"{value:.12g}"), repair))
        return [min(found, key=lambda one: one[:2])[2]] if found else []

    def makes_up(self, old: float, new: float) -> bool:
        """Whether a number of the robot's own would become one of nobody's."""
        if not self.is_own(old) or self.is_own(new):
            return False
        return new == -old or _is_free(new)

    def _mirrors(self, edit: ProgramEdit, named: set[int]) -> bool:
        """Whether a number that has a name, and is the robot's, would have the other sign."""
        if edit.kind != "sign":
            return False
        if edit.part == DATA and edit.numbers and not edit.place:
            old: Any = edit.numbers[0]
        elif isinstance(edit.node, ast.Constant) and id(edit.changes[0].holder) in named:
            old = edit.node.value
        elif edit.part != DATA and self.program.parts[edit.part].sets:
            seen = self.observed.of(edit.node)  # worked out as the module is loaded
            old = float(seen.values[0]) if seen and seen.shape == () and seen.values else None
        else:
            return False
        return isinstance(old, int | float) and self.is_own(old) and not self.is_own(-old)

    def _is_strange(self, place: NumberPlace) -> bool:
        """Whether a number of the data is none of the robot's, and none that anything may have."""
        value = abs(float(place.value))
        plain = value in (0.0, 1.0, 2.0) or value <= TOLERANCES.is_step
        return not plain and not (self.is_own(value) or self.is_own(-value))

    def is_own(self, value: float) -> bool:
        """Whether the robot has a number, with its sign."""
        own = own_numbers(self.case.robot)
        return bool(np.isclose(own, value, rtol=TOLERANCES.same_number, atol=0).any())

    def _solved(self, place: NumberPlace) -> float | None:
        """The number with which the first states are right, if it is one of few digits."""
        old = float(place.value)
        found = self._by_secants(place)
        most = _DIGITS if isinstance(place.value, float) else _WHOLE
        tries = [] if found is None else [float(f"{found:.{k}e}") for k in range(most - 1)]
        if found is not None and 1 / _ANGLES < abs(found) < 2 * np.pi:
            tries.insert(0, round(found * _ANGLES / np.pi) * np.pi / _ANGLES)
        for value in tries or [k * old for k in _MULTIPLES]:
            values = self._with(place, value)
            if value != old and values is not None and self.right(values).all():
                return value
        return None

    def _by_secants(self, place: NumberPlace) -> float | None:
        """The number with which the first states come nearest, where that is found."""
        wanted, old, own = self.wanted[self.first], float(place.value), self.values(self.first)
        if own is None:
            return None
        at, before, step = old, (own - wanted).ravel(), 0.1 * abs(old) or 0.1
        least, worse = np.inf, 0
        for _turn in range(_TURNS):
            values = self._with(place, at + step)
            if values is None or not np.isfinite(values).all():
                return None
            after = (values - wanted).ravel()
            slope = (after - before) / step
            flat = float(slope @ slope)
            worse = 0 if (size := float(after @ after)) < least else worse + 1
            least = min(least, size)
            if not flat > 0.0 or worse > 1:
                return None
            at, before, step = at + step, after, -float(after @ slope) / flat
            if abs(step) <= 1e-9 * max(abs(at), 1e-3):
                break
        found = float(at + step)
        return 0.0 if abs(found) <= 1e-9 * max(abs(old), 1e-3) else found

    def _with(self, place: NumberPlace, value: float) -> Array | None:
        """The answers at the first states with another number."""
        edit = place.edit(value)
        self.work += self.cost_of(edit)
        with changed(self.trial, (edit,)):
            return self.values(self.first)

    def right(self, values: Array) -> Any:
        """Which entries of answers at the first states are right."""
        gap = np.abs(values - self._few[1])
        return (gap <= self._near).all(axis=0).ravel()

    def verdict(
        self, several: tuple[ProgramEdit, ...], values: Array | None = None
    ) -> ProgramRepair | None:
        """The repair, if the program as it stands now is right at every state."""
        values = self.values(self.first) if values is None else values
        if values is None or not self.right(values).all():
            return None
        error = 0.0
        for count in (min(_MORE, len(self.wanted)), len(self.wanted)):
            self.work += self.amounts[0] * count // len(self.watched)
            error = self.error(range(count))
            if not error <= self.allowed:
                return None
        if self._only_here(several):
            return None
        return ProgramRepair(several, error, sum(edit.cost for edit in several))

    def error(self, which: range) -> float:
        """The largest relative error at some states of the program as it stands now."""
        values = self.values(which)
        return np.inf if values is None else self.error_of(values, which)

    def error_of(self, values: Array, which: range) -> float:
        """The largest relative error of answers at some states."""
        gap = np.abs(values - self.wanted[list(which)]).reshape(len(which), -1)
        return float(np.max(gap.max(axis=1, initial=0.0) / self.sizes[list(which)]))

    def _distinct(self) -> int:
        """How many different answers there are at the first states; solutions are several."""
        try:
            answers = np.asarray(self._asked(None, *self._few[0]), dtype=float)
        except (KinlabError, TypeError, ValueError):
            return 0
        rows = answers.reshape(len(answers), -1, answers.shape[-1]) if answers.ndim > 1 else answers
        return sum(len(np.unique(np.round(one, 9), axis=0)) for one in rows)

    def values(self, which: Sequence[int]) -> Array | None:
        """The answers of the program as it stands now, None where it has none.

        A potential's are moved to the right zero.
        """
        values = self.answers(which)
        if values is None:
            return None
        _stacks, wanted = self._few if which is self.first else self._at(which)
        return self.from_right_zero(values, wanted)

    def answers(self, which: Sequence[int]) -> Array | None:
        """The same as they are."""
        quantity, robot = self.case.quantity, self.case.robot
        stacks, wanted = self._few if which is self.first else self._at(which)
        try:
            answers = np.asarray(self._asked(None, *stacks))
            if np.iscomplexobj(answers):
                if answers.imag.any():
                    return None
                answers = answers.real
            values = np.asarray(answers, dtype=float)
            if quantity.read is not None:
                values = np.asarray(quantity.read(robot, values, wanted))
        except (KinlabError, TypeError, ValueError):
            return None
        return values if values.shape == wanted.shape else None


def _more_than(factor: ProgramEdit, edit: ProgramEdit) -> bool:
    """Whether an edit adds a term to what another one only multiplies, in one line."""
    same = factor.part == edit.part != DATA and row_of(factor) == row_of(edit)
    return same and (factor.kind, edit.kind) == ("factor", "missing term")


def _at_best(edit: ProgramEdit) -> float:
    """What an edit costs if nothing speaks against it."""
    return edit.cost - LIKE * (edit.kind == "name")


def _makes_one_of(rows: list[Array], edit: ProgramEdit) -> bool:
    """Whether numbers that are exchanged stand then as the robot has them in a row."""
    if edit.kind != "entries swapped" or _moves_one_of(rows, edit):
        return False
    first, row = edit.changes[0], getattr(edit.node, "elts", None)
    if edit.part != DATA:
        values = [getattr(one, "value", None) for one in first.new] if row else []
    elif isinstance(first.holder, list):
        values = [*first.holder]
        for change in edit.changes:
            if change.holder is first.holder and isinstance(change.field, int):
                values[change.field] = change.new
    else:
        values = [*first.new] if isinstance(first.new, tuple) else []
    if len(values) < _ROW or not all(isinstance(x, int | float) for x in values):
        return False
    new = np.array(values, dtype=float)
    return any(own.shape == new.shape and np.allclose(own, new) for own in rows)


def _moves_one_of(rows: list[Array], edit: ProgramEdit) -> bool:
    """Whether numbers that stand as the robot has them would be exchanged in their row."""
    row = edit.node
    if edit.kind not in ("entries swapped", "reversed", "shifted") or edit.of_the_arm:
        return False
    if edit.part == DATA:
        values = edit.changes[0].holder if isinstance(edit.changes[0].holder, list) else []
    else:
        values = [getattr(one, "value", None) for one in getattr(row, "elts", ())]
    if len(values) < _ROW or not all(isinstance(x, int | float) for x in values):
        return False
    written = np.array(values, dtype=float)
    return any(own.shape == written.shape and np.allclose(own, written) for own in rows)


def _named_numbers(trial: Trial) -> set[int]:
    """Where numbers hang that statements give names to."""
    found: set[int] = set()
    for tree in trial.trees:
        for node in nodes(tree):
            if isinstance(node, ast.Assign):
                found.add(id(node))
                if isinstance(node.value, ast.Tuple) and isinstance(node.targets[0], ast.Tuple):
                    found.add(id(node.value.elts))
    return found


def _is_free(value: float) -> bool:
    """Whether a number is neither whole, nor half of one, nor a simple part of it or of pi."""
    simple = (Fraction(x).limit_denominator(_SIMPLE) for x in (value, value / np.pi))
    return not any(
        math.isclose(x, float(part), rel_tol=TOLERANCES.same_number)
        for x, part in zip((value, value / np.pi), simple, strict=True)
    )


def changed(trial: Trial, several: tuple[ProgramEdit, ...]) -> AbstractContextManager[None]:
    """The program with edits in it."""
    parts = {edit.part for edit in several}
    return trial.changed(parts, [change for edit in several for change in edit.changes])


def _defaults(function: FunctionType) -> list[Any]:
    return [*(function.__defaults__ or ()), *(function.__kwdefaults__ or {}).values()]
