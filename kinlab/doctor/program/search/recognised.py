"""Single values that a textbook has, told quickly: most are nothing known.

One number of each thing is kept in order; a value whose number is not among them is none of them.
"""

from __future__ import annotations

import copy
from bisect import bisect_left
from collections.abc import Sequence
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.glossary.textbook import Glossary
from kinlab.doctor.program.grounds.evidence import Grounds, zeros_and_ones
from kinlab.doctor.program.grounds.suspects import TERM
from kinlab.doctor.program.observed import Shape
from kinlab.tolerances import TOLERANCES

QUANTITY = 2
"""What is a textbook's, and no term alone."""
_FIRST = 1
"""States at which values are told."""
_GIVEN = ("q", "qd", "qdd", "positions", "velocities", "accelerations", "load")
"""What a program is given, and needs not find."""
_SHAPES = ((), (2,), (3,), (6,), (3, 3), (4, 4), (6, 6))
"""Shapes of most values."""
_WEIGHTS = np.random.default_rng(5).uniform(0.5, 1.5, 36)


class Recognised:
    """What a textbook has at the first state at which a program is watched.

    Args:
        evidence: what is right in the program as it is.
    """

    def __init__(self, evidence: Grounds) -> None:
        self.grounds = copy.copy(evidence)
        self.grounds.known = evidence.known[:_FIRST]
        self.anything = bool(self.grounds.known)
        every = (
            row for one in self.grounds.known for rows, _ in one.things.values() for row in rows
        )
        ranks = sorted(every, key=lambda row: -row[0])
        self.terms = {what for what, rank in {x.what: k for k, x in ranks}.items() if rank >= TERM}
        self.marks = {shape: _marks(self.grounds.known, shape) for shape in _SHAPES}
        self.there: dict[Shape, Array] = {}
        self.told: dict[tuple[Shape, bytes], int | None] = {}

    def beside(self, there: dict[Shape, Array]) -> None:
        """Takes values from now on for another's that were there before there was an edit.

        Args:
            there: by their shapes, each as a row.
        """
        self.there, self.told = there, {}

    def rank(self, value: Any) -> int | None:
        """2 of what a textbook has, 1 of a term, 0 of what it has not; None of what anything is."""
        if isinstance(value, list | tuple):
            value = as_numbers(value)
        array = np.asarray(value)
        if array.dtype != float or not array.size:
            return None
        key = (array.shape, array.tobytes())
        if key not in self.told:
            self.told[key] = self._looked_up(array)
        return self.told[key]

    def _looked_up(self, array: Array) -> int | None:
        flat = array.ravel()
        if not np.isfinite(flat).all():
            return 0
        if zeros_and_ones(flat):
            return None
        marks = self.marks.get(array.shape)
        if marks is not None:
            weights, near = _WEIGHTS[: flat.size], self.grounds.near
            mark, wide = float(flat @ weights), 10 * near * float(np.abs(flat) @ weights)
            k = bisect_left(marks, mark - wide)
            if k == len(marks) or marks[k] > mark + wide:
                return 0
        if self._is_there(array):
            return None  # another's value, which what was left out leaves
        sense = self.grounds.thing([array])
        if sense is None:
            return 0
        return None if sense.what in _GIVEN else 1 if sense.what in self.terms else QUANTITY

    def _is_there(self, value: Array) -> bool:
        """Whether an expression had a value before there was an edit."""
        near = TOLERANCES.same_relation * float(np.abs(value).max())
        some = self.there.get(value.shape)
        return some is not None and bool((np.abs(some - value.ravel()).max(axis=1) <= near).any())


def as_numbers(value: Any) -> Array | None:
    """A row, or rows, as an array; None of what are no numbers."""
    try:
        return np.array(value, dtype=float)
    except (ValueError, TypeError):
        return None


def _marks(known: Sequence[Glossary], shape: Shape) -> list[float]:
    """One number of each thing of a shape, sorted; of plane vectors, too, what is left of them."""
    if not known:
        return []
    size = int(np.prod(shape, initial=1))
    _rows, things = known[0].things.get(shape, ((), np.empty((0, size))))
    found = [*(things.reshape(len(things), size) @ _WEIGHTS[:size])]
    if known[0].plane and shape in ((), (2,)):
        _rows, vectors = known[0].things.get((3,), ((), np.empty((0, 3))))
        found += [*(vectors[:, 2:] if shape == () else vectors[:, :2]) @ _WEIGHTS[:size]]
    return sorted(map(float, found))
