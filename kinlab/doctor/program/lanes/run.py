"""A program run in lanes, and what it answers in each."""

from __future__ import annotations

import ast
import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.program.lanes.functions import part_of, room_for, with_lanes
from kinlab.doctor.program.lanes.numbers import Laned, Lanes, TooMuchError
from kinlab.doctor.program.lanes.ways import Ways
from kinlab.doctor.program.lanes.woven import Edits, Woven
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.trial import FailedError, FieldChange, Trial

_MOST = 60_000_000
"""Work of one run."""
_FEWEST = 2
"""Lanes of which no half is run alone."""
_HALVED = 80
"""Times that lanes of one question are halved."""


class _MetError(BaseException):
    """What is watched was met: no handler of the program's is to take it for an error."""


class InLanes:
    """A program with many edits, of which each lane has its own.

    Args:
        trial: the program.
        observed: its expressions as it is.
        edits: of each effect those that have it; their numbers are their places.
        states: at which it is asked.
        counts: whether edits of whole numbers of the data are among them.
        watched: an expression of which :meth:`met` tells what it is.

    Attributes:
        placed: the numbers of the edits that lanes can follow.
        counts: whether whole numbers of the data are among them.

    Raises:
        NoProgramError: it cannot be written with them.
    """

    def __init__(
        self,
        trial: Trial,
        observed: Observed,
        edits: Edits,
        states: Sequence[tuple[Any, ...]],
        counts: bool,
        watched: ast.expr | None = None,
    ) -> None:
        self.trial, self.states = trial, states
        self.woven = Woven(trial, observed, edits, watched)
        whole = {n for n, change in self.woven.data if isinstance(change.now, int)}
        self.counts = counts and bool(whole)
        self.placed = self.woven.placed - (set() if counts else whole)
        self._functions = [
            trial.made(self.woven.tree(tree), k) for k, tree in enumerate(trial.trees)
        ]
        data = [one for one in self.woven.data if one[0] in self.placed]
        data.sort(key=lambda one: _depth(one[1].now))  # a row is made anew with what is in it
        self._alone = {number: (number,) for number, _change in data}
        self._wide, self._data = _of_objects(trial, data)
        self.work = self._left = 0

    def answers(self, chosen: Any, count: int | None = None, most: int = _MOST) -> Array | None:
        """The numbers of the answers with these edits, (C, S, P); NaN where a lane was lost.

        Where one of them makes the program do what lanes cannot follow, each half is run alone.
        None where that is of no use, or more work than may be done.

        Args:
            chosen: the numbers of the edits of each lane, (C, most); -1 for none.
            count: how many of the states are asked; None for all.
            most: work that may be done.
        """
        self._left = _HALVED
        return self._in_halves(chosen, count, most)

    def met(self, chosen: Any, count: int, most: int = _MOST) -> list[Array]:
        """The numbers of what is watched, each time that it is met at the first state, (C, P) each.

        NaN where a lane was lost; fewer where it is met less often, and none where the program
        does what lanes cannot follow, or more work than may be done.

        Args:
            chosen: the numbers of the edits of each lane, (C, most); -1 for none.
            count: how many times at most.
            most: work that may be done.
        """
        lanes, before = Lanes(chosen, most), self.work
        met: list[Any] = []

        def meet(value: Any) -> Any:
            if lanes.here is lanes.all:
                met.append(value)
                if len(met) == count:
                    raise _MetError
            return value

        try:
            with self._placed(lanes, meet):
                self.trial.function(*(x.copy() for x in self.states[0]))
        except _MetError:
            pass
        except (FailedError, TooMuchError, TypeError, ValueError):
            return []
        finally:
            self.work = before + lanes.work
        found: list[Array] = []
        for value in met:
            entries = np.array(value, dtype=object).ravel()
            try:
                rows = np.array([_full(entry, lanes) for entry in entries]).T
            except (TypeError, ValueError):
                return []
            rows[lanes.lost] = np.nan
            found.append(rows)
        return found

    def _in_halves(self, chosen: Any, count: int | None, most: int) -> Array | None:
        """The same; where it fails each half alone, as often as that may be done."""
        before = self.work
        try:
            return self._answered(chosen, count, most)
        except TooMuchError:
            return None
        except (FailedError, TypeError, ValueError):
            self._left -= 1
            if len(chosen) <= _FEWEST or self._left < 0:
                return None
        halves = np.array_split(chosen, 2)
        found = []
        for half in halves:
            left = most - (self.work - before)
            found.append(self._in_halves(half, count, left) if left > 0 else None)
        size = next((one.shape[1:] for one in found if one is not None), None)
        if size is None or any(one is not None and one.shape[1:] != size for one in found):
            return None
        both = zip(halves, found, strict=True)
        lost = [np.full((len(x), *size), np.nan) if one is None else one for x, one in both]
        return np.concatenate(lost)

    def _answered(self, chosen: Any, count: int | None, most: int) -> Array:
        """The same, all run together.

        Raises:
            FailedError: the program does something that lanes cannot follow.
            TooMuchError: it is more work than may be done.
        """
        lanes = Lanes(chosen, most)
        stacks: list[Any] = []
        try:
            with self._placed(lanes):
                for state in self.states[:count]:
                    answer = self.trial.function(*(x.copy() for x in state))
                    entries = np.array(answer, dtype=object).ravel()
                    stacks.append([_full(entry, lanes) for entry in entries])
                found = np.array(stacks)
        finally:
            self.work += lanes.work
        found = found.transpose(2, 0, 1)
        found[lanes.lost] = np.nan
        return found

    @contextmanager
    def _placed(self, lanes: Lanes, meet: Callable[[Any], Any] | None = None) -> Iterator[None]:
        """The program with its numbers in lanes; ``meet`` is given what is watched."""
        trial = self.trial
        every = range(len(self._functions))
        kept, space = [trial.placed(k) for k in every], dict(trial.space)
        changes = [(change, change.now) for change in self._wide]
        changes += [(change, change.now) for _number, change in self._data]
        try:
            with trial.as_loaded(), trial.as_held():
                for change in self._wide:
                    change.put(change.new)
                trial.space.update(with_lanes(trial.space))
                ways = Ways(lanes)
                trial.space |= {"_pick": lanes.pick, "_there": lanes.there, "_kept": ways.kept}
                trial.space |= {"_turns": ways.turns, "_sides": ways.sides}
                trial.space |= {"_met": meet, "_part": part_of, "_room": room_for}
                for k in every:
                    trial.place(k, self._functions[k])
                trial.stale()
                for number, change in self._loaded():
                    self._put(lanes, number, change)
                yield
        finally:
            for change, value in reversed(changes):
                change.put(value)
            trial.space.clear()
            trial.space.update(space)
            for k in every:
                trial.place(k, kept[k])

    def _loaded(self) -> list[tuple[int, FieldChange]]:
        """The changes in the data, in what the lines of the module have made of it anew."""
        trial = self.trial
        if not trial.sets or not self._data:
            return self._data
        kept = {id(trial.space): trial.space}
        before = [trial.space.get(name) for name in trial.sets]
        trial.load()
        for name, old in zip(trial.sets, before, strict=True):
            kept |= _counterparts(old, trial.space.get(name))
        return [
            (number, replace(change, holder=kept.get(id(change.holder), change.holder)))
            for number, change in self._data
        ]

    def _put(self, lanes: Lanes, number: int, change: FieldChange) -> None:
        """One number of the data that an edit changes."""
        before = change.now
        change.put(lanes.pick(self._alone[number], lambda: before, lambda _number: change.new))


def _of_objects(
    trial: Trial, data: Sequence[tuple[int, FieldChange]]
) -> tuple[list[FieldChange], list[tuple[int, FieldChange]]]:
    """Arrays that take numbers with lanes, where the data has others; and its changes in them."""
    arrays = {id(change.holder) for _number, change in data if _narrow(change.holder)}
    wide: list[FieldChange] = []
    new: dict[int, Any] = {}
    holders: list[Any] = [trial.space]
    holders += [x for x in trial.space.values() if isinstance(x, dict | list)]
    for holder in holders:
        for key in [*holder] if isinstance(holder, dict) else range(len(holder)):
            value = holder[key]
            if id(value) in arrays:
                new.setdefault(id(value), value.astype(object))
                wide.append(FieldChange(holder, key, new[id(value)]))
    kept: list[tuple[int, FieldChange]] = []
    for number, change in data:
        holder = new.get(id(change.holder), change.holder)
        if not _narrow(holder):
            kept.append((number, replace(change, holder=holder)))
    return wide, kept


def _counterparts(old: Any, new: Any, met: dict[int, Any] | None = None) -> dict[int, Any]:
    """For what holds numbers, by identity, what stands for it where it was made anew.

    Args:
        old: what there was.
        new: what stands for it.
        met: what is known already: a logger, and what holds itself, leads back to it.
    """
    found = {} if met is None else met
    if type(old) is not type(new) or isinstance(old, int | float | str | type) or callable(old):
        return found
    if id(old) in found or isinstance(old, logging.Logger):
        return found
    found[id(old)] = new
    if isinstance(old, list | tuple):
        for one, other in zip(old, new, strict=False):
            _counterparts(one, other, found)
    elif isinstance(old, dict):
        for key in old.keys() & new.keys():
            _counterparts(old[key], new[key], found)
    elif hasattr(old, "__dict__"):
        _counterparts(vars(old), vars(new), found)
    return found


def _depth(value: Any) -> int:
    """How deep numbers are in it: 0 of a number, 2 of a table."""
    if isinstance(value, np.ndarray):
        return value.ndim
    inner = value.values() if isinstance(value, dict) else value
    return 1 + max(map(_depth, inner), default=0) if isinstance(value, list | tuple | dict) else 0


def _narrow(value: Any) -> bool:
    return isinstance(value, np.ndarray) and value.dtype != object


def _full(entry: Any, lanes: Lanes) -> Array:
    values = entry.within(lanes.all) if isinstance(entry, Laned) else complex(entry)
    full: Array = np.full(lanes.all.size, np.real(values), dtype=float)
    lanes.lost |= np.imag(values) != 0.0
    return full
