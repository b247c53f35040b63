"""Whether a repair holds for other arms than the one whose numbers stand in the program."""

from __future__ import annotations

import ast
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.changes import table_of
from kinlab.doctor.program.grounds.apart import arm_apart, works_out
from kinlab.doctor.program.grounds.scaled import (
    OtherArm,
    is_free,
    is_own,
    other_arm,
    parallel_arm,
)
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ROUNDING, ProgramEdit, changed
from kinlab.doctor.program.search.asked import Asked
from kinlab.doctor.program.search.work import Work
from kinlab.doctor.program.trial import FailedError, quietly
from kinlab.errors import KinlabError

_ARMS = 600_000
"""What it amounts to to find other arms."""
_KINEMATIC = (
    *("fk", "planar_pose", "link_poses", "link_transforms", "dh_poses", "link_velocities"),
    *("jacobian", "planar_jacobian", "jacobian_tool", "jacobian_spatial", "jacobian_dot"),
    *("planar_determinant", "jacobian_determinant", "isotropy_conditions", "tip_speed_squared"),
    *("statics", "statics_tool", "static_wrenches", "least_rates"),
    *("newton_step", "gradient_step", "loss", "loss_gradient"),
)
"""Quantities that no mass has a part in."""

_MOVING = ("entries swapped", "rows swapped", "columns swapped", "reversed", "shifted")
"""Kinds of edits that put what stands in rows into other places."""

Pair = tuple[OtherArm | None, OtherArm | None]


def _arms(asked: Asked, observed: Observed) -> Pair:
    """An arm whose numbers are unrelated, and one that is larger as a whole.

    A program that rounds need not be right for any other.
    """
    trial, case = asked.trial, asked.case
    every = (node for tree in trial.trees for node in nodes(tree))
    if any(isinstance(node, ast.Call) and called(node) in ROUNDING for node in every):
        return None, None
    given = case.robot, trial, observed, case.quantity.name not in _KINEMATIC
    apart, table = arm_apart(*given), table_of(case.robot)
    if apart is not None and table is not None:
        apart = works_out(apart, table, trial, observed, asked.states[:1])
    return apart, other_arm(*given)


def other_arms_of(asked: Asked, observed: Observed, work: Work) -> OtherArms:
    """The other arms for which a program may be right, as it is."""
    every = (node for tree in asked.trial.trees for node in nodes(tree))
    whole = frozenset(id(node) for node in every if type(getattr(node, "value", None)) is int)
    return OtherArms(asked, observed, work, _arms(asked, observed), whole, {})


@dataclass(frozen=True)
class OtherArms:
    """The other arms for which a program may be right.

    Attributes:
        asked: the program, and what it should answer.
        observed: what its expressions were.
        work: what has been done.
        before: the arms for the program as it was.
        whole: which of its nodes were whole numbers, by their identities.
        there: what is right of them, as far as it was asked for.
    """

    asked: Asked
    observed: Observed
    work: Work
    before: Pair
    whole: frozenset[int]
    there: dict[OtherArm, Asked | None]

    def of(self, several: tuple[ProgramEdit, ...]) -> Pair:
        """The other arms for the program as it stands now, with these edits in it."""
        told = [one for one in several if not self._counts(one)]
        sets = any(one.part == DATA or one.of_the_arm or one.numbers is not None for one in told)
        sets = sets or any(map(_moves_numbers, told))  # which is whose is told from its place, too
        if not sets or not any(self.before):
            return self.before
        self.work.done += _ARMS
        try:  # a number that was put in is one of the program's
            return _arms(self.asked, Observed(self.asked.trial, self.asked.states))
        except FailedError:
            return _arms(self.asked, self.observed)

    def hold_for(self, other: OtherArm) -> bool:
        """Whether the program as it stands now is right for another arm."""
        there = self.at(other)
        if there is None:
            return False
        for edits_ in other.ways:
            self.work.done += self.work.longer * self.work.of_all(len(there.first))
            with changed(self.asked.trial, edits_):
                values = there.values(there.first)
            if values is not None and there.right(values).all():
                return True
        return False

    def holds_elsewhere(self, several: tuple[ProgramEdit, ...]) -> bool:
        """Whether edits make it right for another arm, too, for which it is understood wholly."""
        with quietly(), changed(self.asked.trial, several):
            known = [arm for arm in self.of(several) if arm is not None and arm.whole]
            return any(self.at(arm) is not None and self.hold_for(arm) for arm in known)

    @cached_property
    def _parallel(self) -> OtherArm | None:
        case = self.asked.case
        masses = case.quantity.name not in _KINEMATIC
        return parallel_arm(case.robot, self.asked.trial, self.observed, masses)

    def holds_for_parallel_axes(self) -> bool:
        """Whether the program as it stands now is right for another arm with parallel axes."""
        other = self._parallel
        if other is None or not other.whole or self.at(other) is None:
            return False
        return self.hold_for(other)

    def only_here(self, several: tuple[ProgramEdit, ...]) -> bool:
        """Whether edits hold for this arm alone, where a program that is right holds for others."""
        if self.asked.case.quantity.read is not None:
            # one solution is left out, another given twice
            return self.asked.distinct() < self.asked.several
        (before, _), (apart, larger) = self.before, self.of(several)
        if before is not None and apart is not None:
            odd = apart.odd and len(several) > 1 and not self.hold_for(apart)
            own = [edit for edit in several if self._sets_own(edit)]
            put = {(x.node if x.part == DATA else id(x.node), x.place) for x in own}
            put |= (
                self._replaced(before)
                if any(x.of_the_arm and x.part != DATA for x in own)
                else set()
            )
            if odd or before.fitting - apart.fitting - apart.noughts - put:
                return True  # a name has a number that none has of those that are called so
            if apart.whole and self.at(apart) is not None:
                return not self.hold_for(apart)
        if any(map(self._sets_a_number, several)):
            return False
        whole = larger is not None and larger.whole and self.at(larger) is not None
        free = any(edit.numbers is not None and is_free(edit.numbers[1]) for edit in several)
        if not (whole or free) or (larger is not None and self.hold_for(larger)):
            return False  # nor is it where it holds for unrelated numbers, understood wholly or not
        return apart is None or self.at(apart) is None or not self.hold_for(apart)

    def _replaced(self, before: OtherArm) -> set[Any]:
        """The numbers of the text that are in it no more, of a row of which several were others."""
        there = {id(node) for tree in self.asked.trial.trees for node in nodes(tree)}
        return {one for one in before.fitting if isinstance(one[0], int) and one[0] not in there}

    def _counts(self, edit: ProgramEdit) -> bool:
        """Whether an edit is of a whole number in the text, a factor: of none of the arm's."""
        return id(edit.node) in self.whole and not edit.of_the_arm

    def _sets_a_number(self, edit: ProgramEdit) -> bool:
        """Whether an edit gives the program a number that may be this arm's."""
        return edit.part == DATA or self._sets_own(edit)

    def _sets_own(self, edit: ProgramEdit) -> bool:
        """Whether an edit puts a number of this arm's in."""
        if edit.numbers is None or self._counts(edit):
            return edit.of_the_arm
        return edit.of_the_arm or is_own(self.asked.case.robot, edit.numbers[1])

    def at(self, other: OtherArm) -> Asked | None:
        """What is right of another arm, worked out when it is first asked for."""
        if other not in self.there:
            self.there[other] = self._of_arm(other)
        return self.there[other]

    def _of_arm(self, other: OtherArm) -> Asked | None:
        if other.robot is None:
            return None
        case, first = self.asked.case, self.asked.first
        some = {name: stack[first] for name, stack in case.arguments.items()}
        case = replace(case, robot=other.robot, arguments=some, hand=case.hand[first])
        try:
            with np.errstate(all="ignore"):
                return self.asked.at(case, np.asarray(case.answer(()), dtype=float))
        except (KinlabError, np.linalg.LinAlgError):
            return None


def moves(edit: ProgramEdit) -> bool:
    """Whether an edit puts what stands in rows into other places."""
    return edit.kind in _MOVING


def _moves_numbers(edit: ProgramEdit) -> bool:
    """Whether an edit puts typed numbers into other places of a row, or of a table."""
    if not moves(edit):
        return False
    put = [x for c in edit.changes for x in (c.new if isinstance(c.new, list) else [c.new])]
    inner = (node for one in put if isinstance(one, ast.AST) for node in nodes(one))
    return any(isinstance(getattr(node, "value", None), float) for node in inner)
