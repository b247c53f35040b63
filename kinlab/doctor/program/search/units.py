"""Functions of a program, each asked alone some of what it was asked.

A helper that is asked many times, at states beside or for one link after another, is run once to
see what an edit makes of it: the mass matrix is right or wrong whatever is done with it.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from types import FunctionType
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.program.grounds.evidence import Grounds
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit
from kinlab.doctor.program.search.asked import Asked
from kinlab.doctor.program.search.recognised import QUANTITY, Recognised, as_numbers
from kinlab.doctor.program.search.work import Work
from kinlab.doctor.program.trial import FailedError, NoProgramError, Trial, quietly
from kinlab.doctor.program.variants import Variants
from kinlab.engine import dynamics
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_OFTEN = 2
"""Calls of a function from which on it is worth while to ask it alone."""
_HEARD = 12
"""Calls of a function of which it is kept what it was asked."""
_LONGEST = 12
"""Values of one answer that are looked at."""
_STEP = 0.02
"""How far from the state itself, of its size or of 1, the states of a difference are."""

Ranks = list[int | None]


@dataclass(frozen=True, eq=False)
class Unit:
    """A function of a program, and something that it was asked.

    Attributes:
        part: its number.
        given: by position.
        named: by name.
        calls: how often it is asked at one state.
    """

    part: int
    given: tuple[Any, ...]
    named: dict[str, Any]
    calls: int


class Units:
    """The functions of a wrong program that do not answer what a textbook has.

    Args:
        asked: the program, and what it should answer.
        observed: its expressions.
        evidence: what is right in it.
        work: what trying edits amounts to.
    """

    def __init__(self, asked: Asked, observed: Observed, evidence: Grounds, work: Work) -> None:
        self.trial, self.work = asked.trial, work
        self.robot = asked.case.robot
        self.known = Recognised(evidence)
        self.wrong: dict[int, Unit] = {}
        self.there: dict[Unit, list[Array]] = {}
        self.before: dict[int, Ranks] = {}
        if not self.known.anything or len(self.trial.trees) == 1:
            return
        for k, units in _asked_often(self.trial, asked.states[0]).items():
            for unit in units:
                ranks = self._ranks(unit)
                if 0 in ranks:
                    self.wrong[k], self.before[k] = unit, ranks
                    break
        self.known.beside(observed.values(len(asked.watched)))

    def repairs(self, edits: Sequence[ProgramEdit], most: int) -> list[ProgramEdit]:
        """Those of some edits with which one of the functions answers what a textbook has.

        Args:
            edits: the likeliest first.
            most: operations that may be done.
        """
        some = [edit for edit in edits if edit.part != DATA and [*self._of(edit)]]
        variants, found, done = Variants(self.trial, some), [], 0
        for edit in some:
            units = [*self._of(edit)]
            done += sum(self.work.of_one_call(edit, unit.calls) for unit in units)
            if done > most:
                break
            try:
                with self.trial.changed({edit.part}, edit.changes, variants.of(edit)):
                    if any(map(self._is_right, units)):
                        found.append(edit)
            except NoProgramError:
                continue
        return found

    def _of(self, edit: ProgramEdit) -> Iterator[Unit]:
        """The wrong functions that an edit reaches."""
        return (unit for k, unit in self.wrong.items() if k in self.trial.above[edit.part])

    def _is_right(self, unit: Unit) -> bool:
        """Whether more of what a function answers is a textbook's now, and as much as was."""
        before, now = self.before[unit.part], self._ranks(unit)
        if len(now) != len(before):
            return False
        pairs = [*zip(before, now, strict=True)]
        return (0, QUANTITY) in pairs and not any(old and new == 0 for old, new in pairs)

    def _ranks(self, unit: Unit) -> Ranks:
        """What the values of a function's answer are; none where it fails."""
        try:
            answer = self.trial.part(unit.part, *copy.deepcopy((unit.given, unit.named)))
        except FailedError:
            return []
        apart = isinstance(answer, tuple | list) and as_numbers(answer) is None
        if not apart and self._is_the_engines(unit, answer):
            return [QUANTITY]
        return [self.known.rank(one) for one in (answer if apart else [answer])[:_LONGEST]]

    def _is_the_engines(self, unit: Unit, answer: Any) -> bool:
        """Whether a function of states answers what the engine has for those that it was given.

        The columns of M are torques for accelerations of 1, its entries energies for rates of 1.
        """
        if unit not in self.there:
            self.there[unit] = _of_the_engine(self.robot, [*unit.given, *unit.named.values()])
        value = as_numbers(answer)
        near = TOLERANCES.same_relation
        return value is not None and any(
            value.shape == one.shape and bool(np.abs(value - one).max() <= near * np.abs(one).max())
            for one in self.there[unit]
        )


def _of_the_engine(robot: Any, given: Sequence[Any]) -> list[Array]:
    """Energies, or torques, for the positions, rates and accelerations that a function is given."""
    states = [one for one in map(as_numbers, given) if one is not None and one.ndim]
    if not isinstance(robot, Robot) or any(one.shape != (robot.n,) for one in states):
        return []
    if len(states) == len(("q", "v")):
        energy = np.asarray(dynamics.kinetic_energy(robot, *states))
        return [energy, 2 * energy]
    if len(states) == len(("q", "v", "a")):
        q, v, a = states
        torques = np.asarray(dynamics.inverse_dynamics(robot, q, v, a))
        return [torques, torques - np.asarray(dynamics.gravity_torques(robot, states[0]))]
    return []


def _asked_often(trial: Trial, state: tuple[Any, ...]) -> dict[int, list[Unit]]:
    """The functions that are asked often at one state, by their numbers, with what they are asked.

    What one is asked in between comes first: Newton-Euler for the columns of M is asked for the
    bias as well, where more may be wrong.
    """
    heard: dict[int, list[tuple[tuple[Any, ...], dict[str, Any]]]] = {}
    counts: dict[int, int] = {}
    originals = [trial.placed(k) for k in range(len(trial.trees))]

    def listening(k: int, function: Callable[..., Any]) -> Callable[..., Any]:
        def listened(*given: Any, **named: Any) -> Any:
            counts[k] = counts.get(k, 0) + 1
            if counts[k] <= _HEARD:
                with suppress(Exception):  # what cannot be copied is not asked alone
                    heard.setdefault(k, []).append(copy.deepcopy((given, named)))
            return function(*given, **named)

        return listened

    try:
        for k, part in enumerate(trial.program.parts):
            if k and not part.sets and part.kept is FunctionType:
                trial.place(k, listening(k, originals[k]))
        with quietly(), trial.as_loaded():
            trial.function(*(x.copy() for x in state))
    except FailedError:
        return {}
    finally:
        for k, function in enumerate(originals):
            trial.place(k, function)
    found: dict[int, list[Unit]] = {}
    for k, calls in heard.items():
        if calls and counts[k] >= _OFTEN:
            between = calls.pop(len(calls) // 2)
            asked = [_at_the_state(*one, state) for one in (between, *calls)]
            found[k] = [Unit(k, *one, counts[k]) for one in asked]
    return found


def _at_the_state(
    given: tuple[Any, ...], named: dict[str, Any], state: tuple[Any, ...]
) -> tuple[tuple[Any, ...], dict[str, Any]]:
    """What a function was asked beside a state, for a difference, at that state itself.

    What a textbook has is known there.
    """
    own = [np.asarray(one, dtype=float) for one in state]

    def itself(value: Any) -> Any:
        array = as_numbers(value) if isinstance(value, list | tuple | np.ndarray) else None
        if array is None or not array.size:
            return value
        for one in own:
            reach = _STEP * max(1.0, float(np.abs(one).max(initial=0.0)))
            if one.shape == array.shape and float(np.abs(array - one).max()) <= reach:
                return one.copy() if isinstance(value, np.ndarray) else [*map(float, one)]
        return value

    return tuple(map(itself, given)), {name: itself(one) for name, one in named.items()}
