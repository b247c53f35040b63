"""Slips in what a writer's own names stand for: ``h = m2*l1*l2*sin(q2)``; alone or with one more.

A definition may be used at several places, and within roots: what each change of it makes of the
whole formula is worked out, at numbers that are not the robot's.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.entries.terms import Slip, slip_of
from kinlab.doctor.text.alternatives import study, study_definition
from kinlab.doctor.text.line import Change, Line
from kinlab.doctor.text.mend import Mended, rewritten, right_with_two
from kinlab.doctor.text.written import Written
from kinlab.errors import KinlabError
from kinlab.formulas import tree
from kinlab.formulas.text import canonical, words_in
from kinlab.tolerances import TOLERANCES

_MOST = 300
"""Changes of one text that are tried with those of another, the likeliest."""
_TRIED = 12_000
"""Changes that are tried in all of two texts, half of them in the formula; eight names have all."""
_NOTED = 30_000
"""Changes that may be noted where two more are looked for."""
_FEW = 5
"""Points at which they are tried first."""
_ADDED, _FOREIGN = ("missing term", "missing factor"), 0.3
"""What it costs more to add to a definition what it has no name of."""
_AWAY = 0.1
"""What it costs more where a slip of the formula itself would do."""
_NAMED = 3
"""Pairs that are kept."""


@dataclass(frozen=True, eq=False)
class _Part:
    """A formula, or what a name in it stands for, with what may stand there instead.

    Attributes:
        name: the name; empty of the formula itself.
        changes: what may be changed, the likeliest first.
        texts: the text after each change.
        values: what it is then, (R, N).
    """

    name: str
    changes: Sequence[Change]
    texts: Sequence[str]
    values: Array


def _part(line: Line, name: str) -> _Part:
    """A text of a line, and the likeliest changes of it."""
    own, made = line, set[str]()
    if name:
        text = line.text.definition(name)
        made = line.text.symbols.keys() - text.symbols.keys()
        own = Line(text, line.names, line.at, text.values(line.at), line.forms)
    study(own)
    if name:
        study_definition(own)
    kept: list[tuple[bool, Change, str, Array]] = []
    for one, row in zip(own.changes, own.rows, strict=True):
        new = rewritten(own.source, (one,)) if not one.everywhere else None
        if new is None or not made.isdisjoint(words_in(new)):
            continue
        added = one.kind in _ADDED and one.new.strip("+ ") not in own.text.symbols
        foreign = bool(name) and added and not {*words_in(new)} <= {*words_in(own.source)}
        likely = replace(one, cost=one.cost + _FOREIGN * foreign)
        # there are thousands of terms and factors that may be added somewhere
        kept.append((added and one.start == one.end, likely, new, row))
    kept.sort(key=lambda x: (x[0], x[1].cost))
    rows = np.array([row for *_, row in kept]).reshape(len(kept), own.count)
    texts = [new for *_, new, _row in kept]
    return _Part(name, [one for _last, one, _new, _row in kept], texts, own.root.value + rows)


def _put(text: Written, part: str, new: str) -> Written:
    """A text with another formula, or another definition of one of its names."""
    if not part:
        return replace(text, text=new)
    return replace(text, symbols={**text.symbols, part: new})


class _Instead:
    """A formula in which a name has other values.

    Args:
        name: the name.
        values: what it is instead, (R, N).
        at: values of the robot's names, (N,) each.
    """

    def __init__(self, name: str, values: Array, at: Mapping[str, Array]) -> None:
        self.name, self.shape = name, values.shape
        self.at = {n: np.tile(x, len(values)) for n, x in at.items()} | {name: values.ravel()}

    def of(self, text: Written) -> Array:
        """What a text is then, (R, N)."""
        rest = {name: meant for name, meant in text.symbols.items() if name != self.name}
        found: Array = replace(text, symbols=rest).values(self.at).reshape(self.shape)
        return found


class Definitions:
    """A formula with names of its writer's own, beside what it should be.

    Args:
        line: the formula.
        told: the same as it is told.
        here: values of the robot's names at the states of the comparison.
        names: those of the writer's names that may be wrong.
    """

    def __init__(
        self, line: Line, told: Written, here: dict[str, Array], names: Sequence[str]
    ) -> None:
        self.line, self.told, self.here, self.names = line, told, here, names
        self.allowed = TOLERANCES.effect_matches * line.scale

    @cached_property
    def parts(self) -> list[_Part]:
        """What may be changed in the definitions; ``c3 = cos(q3)`` is as it is called."""
        return [_part(self.line, name) for name in self.names if not self._is_as_called(name)]

    def _is_as_called(self, name: str) -> bool:
        """Whether a name is defined as what everybody calls so."""
        meant = canonical(name)
        if meant.op == "sym":
            return False
        try:
            own = self.told.definition(name).values(self.here)
            there = tree.evaluate(meant, dict(self.here))
        except (KinlabError, KeyError):
            return False
        return bool(np.max(np.abs(own - there)) <= TOLERANCES.formula_agrees)

    @cached_property
    def formula(self) -> _Part:
        """What may be changed in the formula itself."""
        return _part(self.line, "")

    def single(self) -> Iterator[Slip]:
        """Changes of one definition with which the formula is right."""
        for part in self.parts:
            whole = _Instead(part.name, part.values, self.line.at).of(self.line.text)
            for k in self._right(whole, self.line.target):
                yield self._slip(part, int(k), _put(self.told, part.name, part.texts[k]))

    def with_one_more(self, below: float = math.inf) -> list[tuple[Slip, ...]]:
        """Changes of a definition, and perhaps of another one, beside which one more is right.

        Args:
            below: what the two must cost less than.

        Returns:
            The likeliest first; what is to be changed in the formula itself is left out.
        """
        few = {name: x[:_FEW] for name, x in self.line.at.items()}
        found: list[tuple[float, int, tuple[Slip, ...]]] = []
        count = len(self.parts)
        of_formula = min(_MOST, _TRIED // 2 // max(count, 1))
        of_others = min(_MOST, _TRIED // max(count * (count - 1), 1))
        for n, part in enumerate(self.parts):
            instead = _Instead(part.name, part.values[:_MOST, :_FEW], few)
            least = min((one.cost for one in part.changes), default=0.0)
            for other in (self.formula, *self.parts[n + 1 :]):
                most = of_others if other.name else of_formula
                for k, new in enumerate(other.texts[:most]):
                    if least + other.changes[k].cost >= below:
                        continue
                    whole = instead.of(_put(self.line.text, other.name, new))
                    for j in map(int, self._right(whole, self.line.target[:_FEW])):
                        both = self._both(part, j, other, k)
                        cost = part.changes[j].cost + other.changes[k].cost
                        cost += _AWAY * bool(other.name)
                        found += [(cost, len(found), both)] if both else []
        return [both for _cost, _turn, both in sorted(found, key=lambda x: x[:2])[:_NAMED]]

    def with_two_more(self) -> Iterator[tuple[Slip, ...]]:
        """Changes of a definition beside which two of what stands in the formula are right."""
        plain = sum(one.kind not in _ADDED for one in self.formula.changes)
        most = _NOTED // max(plain, 1) // max(len(self.parts), 1)
        for part in self.parts:
            for k, new in enumerate(part.texts[:most]):
                text = _put(self.line.text, part.name, new)
                then = replace(self.line, text=text, places=[], changes=[], rows=[])
                if part.changes[k].kind not in _ADDED and right_with_two(then):
                    yield (self._slip(part, k, _put(self.told, part.name, new)),)

    def _right(self, whole: Array, target: Array) -> Any:
        """Which of several answers are what they should be."""
        with np.errstate(invalid="ignore"):
            return np.flatnonzero((np.abs(whole - target) <= self.allowed).all(axis=1))

    def _both(self, part: _Part, j: int, other: _Part, k: int) -> tuple[Slip, ...]:
        """The slips of two changes that are right at every point; none of others."""
        if part.name in words_in(other.texts[k]) and other.name in words_in(part.texts[j]):
            return ()
        new = _put(_put(self.line.text, other.name, other.texts[k]), part.name, part.texts[j])
        if not len(self._right(new.values(self.line.at)[None], self.line.target)):
            return ()
        changed = _put(self.told, part.name, part.texts[j])
        slips: tuple[Slip, ...] = (self._slip(part, j, changed),)
        if other.name:
            slips += (self._slip(other, k, _put(changed, other.name, other.texts[k])),)
        return slips

    def _slip(self, part: _Part, k: int, whole: Written) -> Slip:
        """A change of a definition as a slip, after which the formula is another."""
        own, new = self.told.definition(part.name), part.texts[k]
        found = Mended((part.changes[k],), new, part.changes[k].cost)
        slip = replace(slip_of(own, found, self.here), values=whole.values(self.here))
        return replace(slip, defined=(part.name, new))
