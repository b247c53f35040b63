"""The single number with which a program is right: what it should be is solved for."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.program.edits.numbers.as_the_arm import as_it_is
from kinlab.doctor.program.edits.numbers.data import NumberPlace, numbers
from kinlab.doctor.program.grounds.evidence import Grounds
from kinlab.doctor.program.grounds.scaled import is_free, is_own, numbers_of, own_numbers
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit, changed
from kinlab.doctor.program.search.asked import Asked
from kinlab.doctor.program.search.work import Work
from kinlab.tolerances import TOLERANCES

_ANGLES = 12
"""Into how many parts of pi a number may fall."""
_MULTIPLES = (0.5, 2.0, 0.1, 10.0)
"""Times a number that somebody types for it."""
_NEAREST = 8
"""Numbers of the robot's that are tried for one of which nothing can be solved."""
_STRANGE = 4
"""Numbers of the data that are none of the robot's of which each is solved for."""
_TURNS = 8
"""Steps in which a wrong number is solved for."""
_DIGITS = 6
"""Digits of a number that somebody may have typed."""
_WHOLE = 3
"""Digits of a number that may stand for a whole one."""


@dataclass(frozen=True)
class Solver:
    """A wrong program whose numbers are solved for.

    Attributes:
        asked: the program, and what it should answer.
        observed: what its expressions were.
        evidence: what speaks against an edit.
        work: what has been done.
    """

    asked: Asked
    observed: Observed
    evidence: Grounds
    work: Work

    def edits(self, most: int, strange: bool) -> Iterator[tuple[float, ProgramEdit]]:
        """Numbers with which the first states are right, each with what it should be.

        Args:
            most: the work after which none is looked for any more.
            strange: only those of the data that are none of the robot's, and become one.
        """
        trial, robot = self.asked.trial, self.asked.case.robot
        against = self.evidence.against
        sure = as_it_is(trial, self.observed, robot)
        every = [p for p in numbers(trial, self.observed) if not sure(p.edit(p.value))]
        if strange:
            own = len(own_numbers(robot)) > 0
            every = [p for p in every if own and p.part == DATA and self._is_strange(p)][:_STRANGE]
        every.sort(key=lambda place: (not place.value, against(place.edit(place.value))))
        alone = {id(x.place.node) for x in numbers_of(trial, self.observed) if x.alone}
        for place in every:
            if self.work.done > most:
                break
            value = self._solved(place)
            if value is not None and not is_own(robot, value):
                named = place.part == DATA or id(place.node) in alone
                if strange or (named and is_own(robot, float(place.value))):
                    continue  # a number with a name would be nobody's
            if value is not None and not makes_up(robot, float(place.value), value):
                yield value, place.edit(value)

    def _is_strange(self, place: NumberPlace) -> bool:
        """Whether a number of the data is none of the robot's, and none that anything may have."""
        value, robot = abs(float(place.value)), self.asked.case.robot
        plain = value in (0.0, 1.0, 2.0) or value <= TOLERANCES.is_step
        return not plain and not (is_own(robot, value) or is_own(robot, -value))

    def _solved(self, place: NumberPlace) -> float | None:
        """The number with which the first states are right, if it is one of few digits."""
        old = float(place.value)
        found = self._by_secants(place)
        most = _DIGITS if isinstance(place.value, float) else _WHOLE
        tries = [] if found is None else [float(f"{found:.{k}e}") for k in range(most - 1)]
        if found is not None and 1 / _ANGLES < abs(found) < 2 * np.pi:
            tries.insert(0, round(found * _ANGLES / np.pi) * np.pi / _ANGLES)
        for value in tries or [*(k * old for k in _MULTIPLES), *self._own_beside(old)]:
            values = self._with(place, value)
            if value != old and values is not None and self.asked.right(values).all():
                return value
        return None

    def _own_beside(self, old: float) -> list[float]:
        """Numbers of the robot's with the digits of another one, and those near it."""
        own = own_numbers(self.asked.case.robot)
        same = [float(x) for x in own[own * old > 0] if x != old]
        same.sort(key=lambda x: (_digits(x) != _digits(old), abs(math.log(x / old))))
        return same[:_NEAREST]

    def _by_secants(self, place: NumberPlace) -> float | None:
        """The number with which the first states come nearest, where that is found."""
        wanted, old = self.asked.wanted[self.asked.first], float(place.value)
        own = self.asked.values(self.asked.first)
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
        self.work.done += self.work.of(edit)
        with changed(self.asked.trial, (edit,)):
            return self.asked.values(self.asked.first)


def _digits(value: float) -> list[str]:
    """The digits of a number, in no order, without zeros."""
    return sorted(f"{value:g}".replace(".", "").replace("0", ""))


def makes_up(robot: Any, old: float, new: float) -> bool:
    """Whether a number of the robot's own would become one of nobody's."""
    if not is_own(robot, old) or is_own(robot, new):
        return False
    return new == -old or is_free(new)
