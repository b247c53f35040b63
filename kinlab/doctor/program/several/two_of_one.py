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
            good = sum(self._known(values, shape).astype(int) for values in met)
            good = np.where(self._known(met[odd.turn], shape), good, 0)
            for k in np.flatnonzero(good).tolist():
                i, j = every[start + k]
                found.append((-int(good[k]), start + k, (self.likely[i], self.likely[j])))
        found.sort(key=lambda one: one[:2])
        return [way for *_rank, way in found[:_TOLD]]

    def _known(self, values: Array, shape: tuple[int, ...]) -> Any:
        """Which of some values are a textbook's quantities, and no terms of these alone, (C,)."""
        rows, things = self.search.known[0].things[shape]
        own = [k for k, (rank, _sense) in enumerate(rows) if rank < TERM]
        flat = things[own].reshape(len(own), -1)
        if not own:
            return np.zeros(len(values), dtype=bool)
        weights = np.random.default_rng(5).uniform(0.5, 1.5, flat.shape[1])
        marks = np.sort(np.concatenate([flat @ weights, -(flat @ weights)]))
        known = np.isfinite(values).all(axis=1)
        size = np.abs(values).max(axis=1, initial=0.0, where=np.isfinite(values))
        near = TOLERANCES.same_relation * size
        mark, wide = values @ weights, near * float(weights.sum())
        low = np.searchsorted(marks, mark - wide)
        known &= low < len(marks)
        known &= marks[np.minimum(low, len(marks) - 1)] <= mark + wide
        for k in np.flatnonzero(known):
            known[k] = not zeros_and_ones(values[k]) and self._is_one(values[k], flat, near[k])
        return known

    @staticmethod
    def _is_one(value: Array, flat: Array, near: float) -> bool:
        gaps = np.minimum(np.abs(flat - value).max(axis=1), np.abs(flat + value).max(axis=1))
        return bool(gaps.min() <= near)
