"""Numbers of a text within their digits: what they may stand for, and whether that explains it.

A number stands for anything within half a unit of its last digit. A formula is right with rounded
numbers only if there are numbers within those digits that give the engine's values at every state
to 1e-9, and each of them means something: a number of the robot, a product or sum of these, a
constant such as 1/3; or else it is the only number in its term, so that the engine's own
coefficient is what it stands for. Two numbers in one term that mean nothing excuse nothing: any
error could be laid between them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.text.meanings import CLOSE, Meanings, stands_for
from kinlab.doctor.text.written import Literal, literal
from kinlab.tolerances import TOLERANCES

STEPS, FREE = 12, 120
"""Steps in which the numbers of a formula are fitted, and how many of them at most."""
_ROUGHLY = 2
"""Digits of all a text's numbers where a whole number of one digit may be a rounding, too."""
_WHOLE = 3
"""Digits of a whole number that may be a rounding where it is the whole answer."""
FITS = 200
"""Sets of numbers tried for one formula in which several numbers can share an error."""
_STRAIGHT = 0.1
"""Share of what is off that one number may leave, as if all were straight, to be looked at."""
_DEGREES = ("90", "180", "270", "360")
"""Whole numbers that are none but themselves: near pi in an angle there is always another."""


class Numbered(Protocol):
    """What has values with its numbers as they are written, and with others: a text, a program."""

    @property
    def literals(self) -> tuple[Literal, ...]:
        """Its numbers."""

    def values(self, at: Mapping[str, Array], numbers: Array | None = None) -> Array:
        """Its values where the numbers are others, in the order of the literals."""


@dataclass(frozen=True, eq=False)
class Meant:
    """What numbers stand for.

    Attributes:
        changed: the literals that must be other numbers, each with its number.
        numbers: those of all literals.
    """

    changed: list[tuple[Literal, float]]
    numbers: Array


def stand_ins(
    text: Numbered,
    at: Mapping[str, Array],
    target: Array,
    scale: Array,
    fits: int = FITS,
    alone: bool = True,
) -> Meant | None:
    """Numbers within the digits of those written that give the wanted values at every state.

    Args:
        text: the formula, or several, or a program.
        at: values of the robot's names, (N,) each.
        target: the values wanted, (N,).
        scale: what differences are relative to, (N,).
        fits: sets of numbers that may be tried.
        alone: whether it is the whole answer: one number then is what it says.

    Returns:
        The numbers; None where none will do.
    """
    literals = text.literals
    inexact = [k for k, one in enumerate(literals) if one.half > 0]
    if not inexact or len(inexact) > FREE:
        return None
    whole = _WHOLE if alone and not np.ptp(target) else _ROUGHLY
    search = _Search(text, literals, at, target, scale, Meanings.at(at), whole, fits)
    # numbers that are the robot's in full are exact
    rest = [k for k in inexact if search.meanings.parameter(literals[k].value) is None]
    found = search.among(rest)
    numbers = np.array([one.value for one in literals])
    every = [k for k, one in enumerate(literals) if not one.exponent]
    if found is not None or not told_apart(text, at, numbers, every):
        return found  # a number beside another in its term is what it says
    alike = [k for k in inexact if k in rest or literals[k].digits > 1]
    if len(rest) < len(alike):
        found = search.among(alike)
    if found is None and max(literals[k].seen for k in inexact) <= _ROUGHLY:
        rough = tuple(map(roughly, literals))  # 2 beside 35 and 13 may be 1.962
        search = _Search(text, rough, at, target, scale, search.meanings, whole, fits)
        more = [k for k, one in enumerate(rough) if one.half > 0 and not literals[k].half]
        found = search.among(sorted({*alike, *more}))
        shown = dict(zip(map(id, rough), literals, strict=True))
        return found and Meant([(shown[id(one)], x) for one, x in found.changed], found.numbers)
    return found


def bare_number(text: Numbered, at: Mapping[str, Array], target: Array) -> bool | None:
    """Whether a text that is one bare number is the number wanted, to the digits written.

    These must be within half a percent, as three digits are by themselves: of pi/2 1.57 is right
    and 1.6 is not. None where the text is more than a number, or what is wanted is no number.
    """
    if len(text.literals) != 1 or np.ptp(target):
        return None
    [one], values = text.literals, text.values(at)
    if np.ptp(values) or abs(values[0]) != one.value:
        return None
    digits = (one.half or 0.5) * (1 + TOLERANCES.same_relation)
    reach = min(digits, TOLERANCES.bare_number * abs(float(target[0])))
    return bool(np.max(np.abs(values - target)) <= reach)


def roughly(one: Literal) -> Literal:
    """A whole number as one of two digits: 2 as 2.0, and nothing but places behind 25 in 250."""
    if one.exponent or not one.whole or one.text in _DEGREES:
        return one
    if not one.half:
        return literal(f"{one.text}.0") if one.value > 1 else one
    return replace(one, half=0.5 * 10.0 ** (one.digits - max(one.seen, _ROUGHLY)))


def fitted(
    text: Numbered,
    at: Mapping[str, Array],
    target: Array,
    free: list[int],
    start: Array | None = None,
) -> Array | None:
    """All literals' numbers where some are free to be anything, or None where none will do.

    Args:
        text: the formula.
        at: values of the names, (N,) each.
        target: the values wanted, (N,).
        free: the literals that may be anything.
        start: the numbers at first; what is written where it is None.
    """
    numbers = np.array([one.value for one in text.literals]) if start is None else start
    scale = float(np.max(np.abs(target))) or 1.0
    for _step in range(2 * STEPS):
        values = text.values(at, numbers)
        rest = (target - values) / scale
        if not np.isfinite(rest).all():
            return None
        if np.max(np.abs(rest)) <= TOLERANCES.formula_agrees:
            return numbers
        if not free:
            return None
        slopes = []
        for k in free:
            step = 1e-5 * max(1.0, abs(numbers[k]))
            other = numbers.copy()
            other[k] += step
            slopes.append((text.values(at, other) - values) / (step * scale))
        turned = np.array(slopes).T
        if not np.isfinite(turned).all():
            return None
        numbers[free] += np.linalg.lstsq(turned, rest, rcond=1e-9)[0]
    return None


_Fit = tuple[Array, list[int] | None]
"""The numbers of all literals, and a group that the values leave undecided."""


@dataclass(eq=False)
class _Search:
    """Looks for numbers that explain a text's difference."""

    text: Numbered
    literals: tuple[Literal, ...]
    at: Mapping[str, Array]
    target: Array
    scale: Array
    meanings: Meanings
    whole: int
    left: int

    def among(self, rest: list[int]) -> Meant | None:
        """The same where those numbers may be others, alike ones together or each by itself."""
        groups: dict[str, list[int]] = {}
        for k in rest:
            groups.setdefault(self.literals[k].text, []).append(k)
        singly = [self.explained([one]) for one in groups.values() if self._may_do(one)]
        found = [way for way in singly if way]
        if found:
            return min(found, key=lambda way: self.oddness(*way.changed[0]))
        for ways in (list(groups.values()), [[k] for k in rest]):
            together = self.explained(ways) if len(ways) > 1 else None
            if together is not None:
                return together
        return None

    def oddness(self, one: Literal, value: float) -> tuple[bool, int]:
        """Of several numbers that would do, the one that means something, and the roughest."""
        return self.meanings.named(value) == f"{value:.7g}", one.digits

    def explained(self, ways: list[list[int]]) -> Meant | None:
        """The literals that change, where each group moves as one within its digits, or None."""
        first = self._fitted(ways, {}) if self.left > 0 else None
        self.left -= 1
        if first is None:
            return None
        found = self._settled(ways, {}, False, first)
        return found if found is not None else self._settled(ways, {}, True, first)

    def _may_do(self, members: list[int]) -> bool:
        """Whether what is off goes with what some literals change together."""
        numbers = np.array([one.value for one in self.literals])
        rest = (self.target - self.text.values(self.at, numbers)) / self.scale
        numbers[members] += _step(self.literals[members[0]])
        slope = (self.target - self.text.values(self.at, numbers)) / self.scale - rest
        length = float(slope @ slope)
        if not np.isfinite(length) or not length:
            return False
        left = rest - (slope @ rest) / length * slope
        return bool(left @ left <= _STRAIGHT * (rest @ rest))

    def _settled(
        self, ways: list[list[int]], fixed: Mapping[int, float], own: bool, fitted: _Fit
    ) -> Meant | None:
        """The same with the values of some groups settled, by their first member.

        An error that could lie in either of two numbers is laid into neither unless all of them
        mean something, or the one is the robot's ``own`` number and the other its coefficient.
        """
        numbers, loose = fitted
        if loose is None:
            return self._sound(ways, numbers, own or not fixed)
        one = self.literals[loose[0]]
        for value in (one.value, *self.meanings.around(one)):
            if not own or value == one.value or self.meanings.parameter(value) is not None:
                more = {**fixed, loose[0]: value}
                again = self._fitted(ways, more) if self.left > 0 else None
                self.left -= 1
                found = self._settled(ways, more, own, again) if again is not None else None
                if found is not None:
                    return found
        return None

    def _fitted(self, ways: list[list[int]], fixed: Mapping[int, float]) -> _Fit | None:
        """All literals' numbers, and a group that the values leave undecided."""
        literals = self.literals
        start = np.array([one.value for one in literals])
        for members in ways:
            start[members] = fixed.get(members[0], literals[members[0]].value)
        free = [members for members in ways if members[0] not in fixed]
        reach = np.array([literals[members[0]].reach for members in free])
        moved = np.zeros(len(free))
        turned = np.zeros((len(self.target), len(free)))

        def numbers(share: Array) -> Array:
            out = start.copy()
            for members, size, part in zip(free, reach, share, strict=True):
                out[members] += size * part
            return out

        steps = np.diag([_step(literals[members[0]]) for members in free] / reach)
        for _turn in range(STEPS):
            values = self.text.values(self.at, numbers(moved))
            rest = (self.target - values) / self.scale
            if not np.isfinite(rest).all():
                return None
            slopes = [
                (self.text.values(self.at, numbers(moved + one)) - values)
                / (float(np.max(one)) * self.scale)
                for one in steps
            ]
            turned = np.array(slopes).reshape(len(free), -1).T
            if not np.isfinite(turned).all():
                return None
            if not free or np.max(np.abs(rest)) <= 0.01 * TOLERANCES.formula_agrees:
                break
            step = np.linalg.lstsq(turned, rest, rcond=1e-10)[0]
            moved = moved + step
            if np.max(np.abs(moved)) > 10.0:
                return None
            if np.max(np.abs(step)) <= TOLERANCES.same_number:  # of their digits
                break
        final = numbers(moved)
        gap = np.abs(self.target - self.text.values(self.at, final)) / self.scale
        fits = np.isfinite(gap).all() and float(np.max(gap)) <= TOLERANCES.formula_agrees
        within = not free or np.max(np.abs(moved)) <= 1.0 + TOLERANCES.same_relation
        if not fits or not within:
            return None
        return final, self._loose(free, turned)

    def _loose(self, free: list[list[int]], turned: Array) -> list[int] | None:
        """The group that can move most while others make up for it."""
        if len(free) < 2:
            return None
        _u, sizes, axes = np.linalg.svd(turned, full_matrices=True)
        rank = int(np.sum(sizes > TOLERANCES.same_relation * sizes[0])) if sizes[0] else 0
        share = np.sum(axes[rank:] ** 2, axis=0)
        # what changes nothing at all is no matter
        felt = np.max(np.abs(turned), axis=0) > TOLERANCES.no_effect
        share = np.where(felt, share, 0.0)
        k = int(np.argmax(np.round(share, 6)))
        return free[k] if share[k] > TOLERANCES.same_relation else None

    def _sound(self, ways: list[list[int]], numbers: Array, alone: bool) -> Meant | None:
        """What changes, if every number means something or, as is allowed, is alone in its term."""
        literals = self.literals
        changed = [
            (literals[k], float(numbers[k]))
            for k in (members[0] for members in ways)
            if abs(numbers[k] - literals[k].value)
            > TOLERANCES.formula_agrees * abs(literals[k].value)
        ]
        few = min((one.digits for one, _x in changed if not one.whole), default=self.whole)
        if not changed or not all(self._credible(*pair, max(2, few)) for pair in changed):
            return None
        bare = [
            k
            for k, one in enumerate(literals)
            if one.half > 0
            and not self.meanings.holds(float(numbers[k]))
            and self._felt(k, numbers)
        ]
        if bare and not (alone and told_apart(self.text, self.at, numbers, bare)):
            return None
        return Meant(changed, numbers)

    def _credible(self, one: Literal, value: float, digits: int) -> bool:
        """Whether a number may be rounded: a whole one nearly, or not to fewer digits than others.

        What is the whole answer is what it says.
        """
        near = self.whole < _WHOLE and abs(value - one.value) <= CLOSE * abs(value)
        return self.meanings.credible(one, value, self.whole if near else digits)

    def _felt(self, k: int, numbers: Array) -> bool:
        """Whether a number changes anything: the zero of a potential does not."""
        moved = numbers.copy()
        moved[k] += _step(self.literals[k])
        gap = self.text.values(self.at, moved) - self.text.values(self.at, numbers)
        return not np.max(np.abs(gap) / self.scale) <= TOLERANCES.no_effect


def told_apart(text: Numbered, at: Mapping[str, Array], numbers: Array, free: list[int]) -> bool:
    """Whether no error of one number could be another's: not of one term or one coefficient.

    Args:
        text: the formula.
        at: values of the names.
        numbers: what the literals stand for.
        free: the literals that are asked about.
    """
    if len(free) < 2:
        return True
    here = text.values(at, numbers)
    columns = []
    for k in free:
        moved = numbers.copy()
        moved[k] += _step(text.literals[k])
        column = text.values(at, moved) - here
        size = float(np.linalg.norm(column))
        if not np.isfinite(size):
            return False
        if size:  # what changes nothing is no matter
            columns.append(column / size)
    rank = np.linalg.matrix_rank(np.array(columns), TOLERANCES.same_relation) if columns else 0
    return bool(rank == len(columns))


def _step(one: Literal) -> float:
    """A change of a number far above the rounding of what it is multiplied with."""
    return 1e-3 * max(abs(one.value), one.reach)


def rounding_remarks(changed: list[tuple[Literal, float]], at: Mapping[str, Array]) -> list[str]:
    """Each rounded number once: ``9.8 stands for g = 9.81``."""
    meanings = Meanings.at(at)
    return list(dict.fromkeys(stands_for(one.text, meanings.named(x)) for one, x in changed))
