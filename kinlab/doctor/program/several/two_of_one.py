"""Two slips with which a statement gives what a textbook has, looked for in lanes.

Neither alone makes anything right. The program is run only up to where the statement is first
wrong, with many pairs of edits at once; what it gives then is looked up among the things of the
textbooks.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.glossary.textbook import Row
from kinlab.doctor.program.grounds.evidence import zeros_and_ones
from kinlab.doctor.program.grounds.suspects import TERM, OddValue, odd_values
from kinlab.doctor.program.lanes.run import InLanes
from kinlab.doctor.program.places import ProgramEdit
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.doctor.program.several.effects import Way
from kinlab.doctor.program.trial import NoProgramError
from kinlab.tolerances import TOLERANCES

_LIKELY = 200
"""Edits of which any two are tried."""
_VALUES = 2
"""Values of which it is looked for what makes them right."""
_AT_ONCE = 8000
"""Pairs at a time."""
_PASSES = 4
"""Passes that are looked at, from the first on at which the value is wrong."""
_TOLD = 60
"""Pairs that are told of each value, the likeliest."""
_WEAVING = 2_000_000
"""What putting the edits in amounts to."""


class TwoOfOne:
    """Pairs of edits of a wrong program.

    Args:
        search: the program, with what stands in it already.
        some: the edits that may be needed.
        most: operations that may be done.

    Attributes:
        done: operations that were.
    """

    def __init__(self, search: LineSearch, some: Sequence[ProgramEdit], most: int) -> None:
        self.search, self.most, self.done = search, most, 0
        fit = [edit for edit in some if edit.kind != "extra term"]  # a term alone is known, too
        self.likely = sorted(fit, key=search.likely)[:_LIKELY]

    def pairs(self) -> Iterator[list[Way]]:
        """Of each value that is wrong by what it is made of the pairs that may make it right."""
        search = self.search
        odd = odd_values(search.trial, search.observed, search.known)
        for one in odd[:_VALUES]:
            if self.done < self.most:
                yield self._of(one)

    def _of(self, odd: OddValue) -> list[Way]:
        search = self.search
        shape = search.observed.shape(odd.value)
        seen = search.observed.of(odd.value)
        if shape is None or seen is None or shape not in search.known[0].things:
            return []
        things = _Quantities(*search.known[0].things[shape])
        alike = [[edit] for edit in self.likely]
        states = search.asked.states[:1]
        self.done += _WEAVING
        try:
            lanes = InLanes(search.trial, search.observed, alike, states, True, odd.value)
        except NoProgramError:
            return []
        usable = [k for k in range(len(alike)) if k in lanes.placed]
        within = lanes.woven.inside()
        every = [(i, j) for j in usable for i in usable if i < j and not within[i, j]]
        every.sort(key=lambda two: (two[0] + 1) * (two[1] + 1))
        passes = -(-seen.count // len(search.known))
        count = min(passes, odd.turn + _PASSES)
        found: list[tuple[int, int, Way]] = []
        for start in range(0, len(every), _AT_ONCE):
            chosen, left = np.array(every[start : start + _AT_ONCE]), self.most - self.done
            before = lanes.work
            met = lanes.met(chosen, count, left) if left > 0 else []
            self.done += lanes.work - before
            if len(met) <= odd.turn or met[0].shape[1] != int(np.prod(shape, initial=1)):
                break
            told = np.array([things.known(values) for values in met])
            good = told.sum(axis=0)
            for k in np.flatnonzero(told[odd.turn]).tolist():
                i, j = every[start + k]
                found.append((-int(good[k]), start + k, (self.likely[i], self.likely[j])))
        found.sort(key=lambda one: one[:2])
        return [way for *_rank, way in found[:_TOLD]]


class _Quantities:
    """The quantities of a textbook of one shape: no terms of these alone.

    Args:
        rows, things: what they are, and their values, stacked.
    """

    def __init__(self, rows: Sequence[Row], things: Array) -> None:
        own = [k for k, (rank, _sense) in enumerate(rows) if rank < TERM]
        self.values = things[own].reshape(len(own), things[0].size)
        self.weights = np.random.default_rng(5).uniform(0.5, 1.5, things[0].size)
        marks = self.values @ self.weights
        self.marks = np.sort(np.concatenate([marks, -marks]))

    def known(self, values: Array) -> Any:
        """Which of some values are one of them, or minus one, (C,)."""
        if not len(self.marks):
            return np.zeros(len(values), dtype=bool)
        known = np.isfinite(values).all(axis=1)
        size = np.abs(values).max(axis=1, initial=0.0, where=np.isfinite(values))
        near = TOLERANCES.same_relation * size
        mark, wide = values @ self.weights, near * float(self.weights.sum())
        low = np.searchsorted(self.marks, mark - wide)
        known &= low < len(self.marks)
        known &= self.marks[np.minimum(low, len(self.marks) - 1)] <= mark + wide
        for k in np.flatnonzero(known):  # one number of each has told most
            known[k] = not zeros_and_ones(values[k]) and any(
                np.abs(self.values - x).max(axis=1).min() <= near[k]
                for x in (values[k], -values[k])
            )
        return known
