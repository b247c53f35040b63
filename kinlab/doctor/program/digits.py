"""Whether a program is right to the digits that its numbers are written with."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.program.edits.numbers.as_the_arm import columns_as_meant, key_of
from kinlab.doctor.program.edits.numbers.data import NumberPlace, numbers, together
from kinlab.doctor.program.grounds.scaled import own_numbers
from kinlab.doctor.program.places import ProgramEdit, changed, places
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.doctor.program.trial import quietly
from kinlab.doctor.text.meanings import CLOSE, stands_for
from kinlab.doctor.text.stand_ins import roughly, rounding_remarks
from kinlab.doctor.text.written import Literal, beneath, inside, literal, operands
from kinlab.doctor.verdicts import Excuse, by_digits, essential, numbers_at, rounded_otherwise
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

_WORK = 15_000_000
"""Operations of numbers, or what amounts to them, that may be done."""
_COMPILING = 30
"""What compiling one node amounts to."""
_FEWEST = 3
"""Digits from which on a number may be another one rounded, though others make up for it."""
_OF_THE_ROBOT = 2
"""Digits from which on a number that the robot has is that one: 0.16 beside 0.165."""
_CUT = 4
"""Digits from which on a number may end where the next digit would."""
_MOST = 7
"""Digits from which on it is not."""
_PARTS = 1000
"""A number is moved by one part in so many to see what it does."""
_ENDLESS = (1 / 3, 2 / 3, 1 / 6, 1 / 12, math.pi, math.pi / 2, math.sqrt(2), math.sqrt(0.5))
"""Numbers that nobody can type in full."""
_TOLD = 3
"""Numbers that are told."""
_LIMITING = ("min", "max", "clip", "minimum", "maximum", "isclose", "allclose")
"""Functions to which limits are given."""
_SIDES = (ast.List, ast.Tuple, ast.Assign, ast.Return, ast.UnaryOp)
"""Around a whole number that is one, and no index or size."""
_FARTHEST, _BEYOND = 0.25, 1.2
"""Share of the largest answer, and times what numbers reach within their digits, that may be off:
at first sight."""
_TURNS = 4
"""Steps in which the numbers are solved for."""
_OVER = 3
"""Equations asked for each number that is solved for."""


@dataclass(eq=False)
class _Numbers:
    """A program by its numbers, as a text is by its own.

    Attributes:
        search: the program, and what it should answer.
        places: where the numbers are.
        literals: what is written there, without signs.
        which: the states at which it is asked.
    """

    search: LineSearch
    places: list[NumberPlace]
    literals: tuple[Literal, ...]
    which: range

    def edits(self, numbers: Array) -> tuple[ProgramEdit, ...]:
        """Other numbers put into the program."""
        changed_ = [
            (place, math.copysign(value, place.value))
            for place, one, value in zip(self.places, self.literals, numbers.tolist(), strict=True)
            if value != one.value
        ]
        return tuple(together(changed_))

    def values(self, at: Mapping[str, Array], numbers: Array | None = None) -> Array:
        """What is essential of its answers; NaN where it has none."""
        found = self._asked(self.which, numbers)
        return essential(self.search.case, found, self.which).ravel()

    def answers(self, at: Mapping[str, Array], numbers: Array | None = None) -> Array:
        """Its answers at all states; NaN where it has none."""
        return self._asked(range(len(self.search.asked.wanted)), numbers)

    def _asked(self, which: range, numbers: Array | None) -> Array:
        with changed(self.search.trial, () if numbers is None else self.edits(numbers)):
            found = self.search.asked.answers(which)
        wanted = self.search.asked.wanted[list(which)]
        return np.full_like(wanted, np.nan) if found is None else found

    @property
    def near(self) -> bool:
        """Whether all numbers together, each within its digits, may change the answers so much."""
        target = essential(self.search.case, self.search.asked.wanted[list(self.which)], self.which)
        now, numbers_ = self.values({}), np.array([one.value for one in self.literals])
        reach = np.zeros(len(now))
        for one, step in zip(self.literals, np.diag(numbers_ / _PARTS), strict=True):
            most = max(one.reach, roughly(one).half)
            if most:
                moved = np.abs(self.values({}, numbers_ + step) - now) / np.max(step)
                reach += most * np.where(np.isfinite(moved), moved, 0.0)
        gap = np.abs(now - target.ravel())
        size = TOLERANCES.formula_agrees * np.max(np.abs(target))
        return bool((gap <= _BEYOND * reach + size).all())


def of_rounded_numbers(search: LineSearch) -> Excuse | None:
    """Why a program is right, if rounded numbers are all that is off in it."""
    case, wanted = search.case, search.asked.wanted
    if case.hand.shape != wanted.shape:
        return None
    gap = np.abs(essential(case, case.hand) - essential(case, wanted))
    if not np.max(gap) <= _FARTHEST * np.max(np.abs(essential(case, wanted))):
        return None
    with quietly():
        known = _of_the_robot(search)
    if known is not None:
        return known
    own_values = np.abs(own_numbers(case.robot))
    every = [pair for pair in _literals(search) if not _is_exact(pair[1], own_values)]
    size = int(np.prod(wanted.shape[1:], initial=1))
    which = range(min(len(wanted), -(-_OVER * len(every) // size) + 2))
    run = max(search.work.amounts.values()) * len(which) // len(search.asked.watched)
    trees = sum(search.work.nodes)
    turn = (run + _COMPILING * trees) * (len(every) + 1)
    if not every or turn > _WORK:
        return None
    with quietly():
        places, literals = zip(*every, strict=True)
        own = _Numbers(search, list(places), literals, which)
        if not own.near:
            return None
        found = by_digits(own, case, wanted, which, _WORK // turn)
        if found is not None:
            return found
        typed = [pair for pair in every if _typed(pair[1])]
        if not typed:
            return None
        places, literals = zip(*typed, strict=True)
        return _laid(_Numbers(search, list(places), literals, which))


def _of_the_robot(search: LineSearch) -> Excuse | None:
    """Why a program is right, if its numbers are the robot's own to the digits written."""
    case = search.case
    at = numbers_at(case)
    constant = (abs(x.flat[0]) for x in at.values() if x.size and np.ptp(x) == 0)
    own = np.unique([*np.abs(own_numbers(case.robot)), *constant, *_ENDLESS])
    held = own[~np.isin(own, _ENDLESS)]
    columns = columns_as_meant(search.trial, search.observed, case.robot, _may_stand)
    meant: list[tuple[NumberPlace, Literal, float]] = []
    limits = _limits(search)
    for place, one in _written(search):
        if limits & {id(place.node), place.node}:
            continue
        column = columns.get(key_of(place))
        exact = abs(column or float(own[np.argmin(np.abs(own - one.value))]))
        near = CLOSE if exact in held else TOLERANCES.typed_rounding  # 1.6 is no pi/2
        few = column is None and (one.digits == 1 or exact not in held)
        few = few and abs(exact - one.value) > near * exact
        if one.value and exact != one.value and not few and _is_rounded(one, exact):
            meant.append((place, one, exact))
    plain = [one for one in meant if not (4 * one[1].value).is_integer()]
    for some in (plain, meant) if len(plain) < len(meant) else (meant,):
        found = _if_meant(search, some, at)
        if found is not None:
            return found
    return None


def _limits(search: LineSearch) -> set[Any]:
    """What stands in comparisons, and where something is cut off: limits, which none rounds.

    Nodes of the text by what they are, and names.
    """
    every = (node for tree in search.trial.trees for node in nodes(tree))
    inner = [x for node in every if _is_limited(node) for x in nodes(node)]
    return {id(x) for x in inner} | {x.id for x in inner if isinstance(x, ast.Name)}


def _is_limited(node: ast.AST) -> bool:
    call = isinstance(node, ast.Call) and called(node) in _LIMITING
    return call or isinstance(node, ast.Compare)


def _if_meant(
    search: LineSearch,
    meant: Sequence[tuple[NumberPlace, Literal, float]],
    at: Mapping[str, Array],
) -> Excuse | None:
    """The excuse of numbers that stand for others, if all is right with these."""
    if not meant:
        return None
    places, literals, numbers_ = zip(*meant, strict=True)
    whole = _Numbers(search, [*places], literals, range(0))
    answers = whole.answers({}, np.array(numbers_))
    far = sorted(meant, key=lambda one: -abs(one[2] / one[1].value - 1))
    told = rounding_remarks([(one, exact) for _place, one, exact in far], at)
    if len(told) > _TOLD:
        more = _("{count} more numbers are rounded, too").format(count=len(told) - _TOLD)
        told = [*told[:_TOLD], more]
    slack = TOLERANCES.finite_differences if search.asked.differences else 0.0
    return rounded_otherwise(
        replace(search.case, hand=answers), search.asked.wanted, told, slack, search.case
    )


def _is_rounded(one: Literal, exact: float) -> bool:
    """Whether a number is another to its digits, or of many cut off."""
    cut = one.digits >= _CUT and one.value < exact
    reach = max(one.reach, 2 * one.half * cut)
    return abs(exact - one.value) <= reach * (1 + TOLERANCES.same_relation)


def _may_stand(value: float, exact: float) -> bool:
    """The same of a number of a program, with its sign."""
    return value * exact > 0 and _is_rounded(literal(repr(abs(value))), abs(exact))


def _written(search: LineSearch) -> Iterator[tuple[NumberPlace, Literal]]:
    """The numbers of a program, and what each is."""
    trial = search.trial
    above: dict[int, str] = {}
    for tree in trial.trees:
        for node in nodes(tree):
            for k, part in enumerate(operands(node) if isinstance(node, ast.expr) else ()):
                above[id(part)] = inside(node, k, above.get(id(node), ""))
    for place in (*numbers(trial, search.observed), *_whole_numbers(search)):
        value = abs(place.value)
        if math.isfinite(value):
            text = repr(float(value)) if isinstance(place.value, float) else str(int(value))
            yield place, beneath(literal(text), above.get(id(place.node), ""))


def _is_exact(one: Literal, own: Array) -> bool:
    """Whether a number is the robot's, with so many digits that it stands for no other."""
    return one.digits >= _OF_THE_ROBOT and bool(
        np.isclose(own, one.value, rtol=TOLERANCES.same_number, atol=0.0).any()
    )


def _literals(search: LineSearch) -> Iterator[tuple[NumberPlace, Literal]]:
    """The numbers of a program that somebody typed, and what each is."""
    for place, one in _written(search):
        endless = _endless(one) if one.digits >= _MOST and not one.exponent else None
        if endless is not None or 0 < one.digits < _MOST:
            yield place, endless or one


def _endless(one: Literal) -> Literal | None:
    """A number that nobody can type in full, as far as it is right; None of any other."""
    for exact in _ENDLESS:
        off = abs(one.value - exact)
        if 0 < off <= TOLERANCES.typed_endless * exact:
            return replace(one, half=max(one.half, off))
    return None


def _whole_numbers(search: LineSearch) -> Iterator[NumberPlace]:
    """Whole numbers that are no index: the entries of ``[0, -64, 0]``, the side of an equation."""
    known = {id(place.node) for place in numbers(search.trial, search.observed)}
    for part, tree in enumerate(search.trial.trees):
        for here in places(part, tree):
            value = getattr(here.node, "value", None)
            if type(value) is not int or id(here.node) in known:
                continue
            index = any(isinstance(one, ast.Subscript | ast.Slice) for one in here.above)
            if isinstance(here.parent, _SIDES) and not index and search.observed.of(here.node):
                yield NumberPlace(value, part, here.node, "value", here.node)


def _typed(one: Literal) -> bool:
    """Whether a number may be rounded where several in one term may be."""
    return one.half > 0 and one.seen >= _FEWEST


def _stands(one: Literal, meant: float) -> bool:
    """Whether one number is another to its digits, or was multiplied by one that is: ``0.333``."""
    if abs(meant - one.value) <= one.half * (1 + TOLERANCES.same_relation):
        return True
    ratios = (exact / round(exact, digits) for exact in _ENDLESS for digits in range(3, _MOST))
    ratio = meant / one.value
    return any(abs(ratio - x) <= TOLERANCES.same_relation * abs(x - 1) for x in ratios)


def _laid(own: _Numbers) -> Excuse | None:
    """The same of numbers of three digits or more, of which one may make up for another."""
    case, wanted = own.search.case, own.search.asked.wanted
    target = essential(case, wanted[list(own.which)], own.which)
    scale = np.repeat(error_sizes(target), target[0].size)
    numbers_ = np.array([one.value for one in own.literals])
    reach = np.array([one.half for one in own.literals])
    now = own.values({}, None)
    steps = np.diag(numbers_ / _PARTS)
    columns = [(own.values({}, numbers_ + step) - now) / np.max(step) for step in steps]
    matrix = np.array(columns).T
    for _turn in range(_TURNS):
        if not (np.isfinite(matrix).all() and np.isfinite(now).all()):
            return None
        # what cannot be told apart is laid into the roughest number
        step, *_rest = np.linalg.lstsq(matrix * reach, target.ravel() - now, rcond=1e-9)
        numbers_ = numbers_ + reach * step
        now = own.values({}, numbers_)
        if np.max(np.abs(now - target.ravel()) / scale) <= TOLERANCES.formula_agrees:
            told = _told(own.literals, numbers_.tolist(), matrix)
            meant = replace(case, hand=own.answers({}, numbers_))
            return rounded_otherwise(meant, wanted, told, own=case) if told else None
    return None


def _told(written: tuple[Literal, ...], meant: list[float], matrix: Array) -> tuple[str, ...]:
    pairs = [*zip(written, meant, strict=True)]
    if not all(_stands(*pair) for pair in pairs):
        return ()
    far = sorted(pairs, key=lambda pair: -abs(pair[1] / pair[0].value - 1))
    off = [p for p in far if abs(p[1] / p[0].value - 1) > TOLERANCES.same_relation][:_TOLD]
    if not off or np.linalg.matrix_rank(matrix) < len(written):
        return (_("the program's numbers are right to the digits that they are written with"),)
    told = (stands_for(old.text, f"{abs(new):.7g}") for old, new in off)
    return tuple(dict.fromkeys(told))
