"""Whether a program is right to the digits that its numbers are written with."""

from __future__ import annotations

import math

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import relative_errors
from kinlab.doctor.program.edits.data import NumberPlace, numbers
from kinlab.doctor.program.repair import LineSearch, changed
from kinlab.doctor.program.trial import quietly
from kinlab.doctor.text.meanings import stands_for
from kinlab.doctor.text.written import literal
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

_WORK = 15_000_000
"""Operations of numbers, or what amounts to them, that may be done."""
_FEWEST = 3
"""Digits from which on a number may be another one rounded."""
_MOST = 7
"""Digits from which on it is not."""
_PARTS = 1000
"""A number is moved by one part in so many to see what it does."""
_ENDLESS = (1 / 3, 2 / 3, 1 / 6, 1 / 12, math.pi, math.pi / 2, math.sqrt(2), math.sqrt(0.5))
"""Numbers that nobody can type in full."""
_TOLD = 3
"""Numbers that are told."""
_TURNS = 4
"""Steps in which the numbers are solved for."""
_OVER = 3
"""Equations asked for each number that is solved for."""


def nearly(hand: Array, wanted: Array) -> bool:
    """Whether answers differ by so little that rounded numbers may be all of it."""
    if hand.shape != wanted.shape:
        return False
    return bool(np.max(relative_errors(hand, wanted)) <= TOLERANCES.may_be_rounded)


def to_the_digits(search: LineSearch) -> tuple[str, ...]:
    """What rounded numbers of a program stand for, where they are all that is wrong, in words.

    Each number may move by half of its last digit; with all of them so the program must be right
    at every state.
    """
    places = [place for place in numbers(search.trial, search.observed) if _typed(place)]
    size = int(np.prod(search.wanted.shape[1:], initial=1))
    count = min(len(search.wanted), -(-_OVER * len(places) // size) + 1)
    run = max(search.amounts.values()) // len(search.watched)
    if not places or len(places) * count * run > _WORK:
        return ()
    with quietly():
        return _solved(search, places, range(count))


def _typed(place: NumberPlace) -> bool:
    """Whether a number may be another one rounded."""
    if not isinstance(place.value, float):
        return False
    one = literal(f"{abs(place.value):.15g}")
    endless = any(0 < abs(one.value - x) <= 1.0001 * one.half for x in _ENDLESS)
    return _FEWEST <= one.digits < _MOST or (endless and one.digits >= _FEWEST)


def _stands(value: float, meant: float) -> bool:
    """Whether one number is another to its digits, or was multiplied by one that is: ``0.333``."""
    one = literal(f"{abs(value):.15g}")
    if abs(meant - value) <= one.half * (1 + TOLERANCES.same_relation):
        return True
    ratios = (exact / round(exact, digits) for exact in _ENDLESS for digits in range(3, _MOST))
    return any(abs(meant / value - x) <= TOLERANCES.same_relation * abs(x - 1) for x in ratios)


def _solved(search: LineSearch, places: list[NumberPlace], which: range) -> tuple[str, ...]:
    units = [abs(place.value) / _PARTS for place in places]
    reach = np.array([literal(f"{abs(place.value):.15g}").half for place in places]) / units
    own = search.values(which)
    if own is None:
        return ()
    columns: list[Array] = []
    for place, unit in zip(places, units, strict=True):
        with changed(search.trial, (place.edit(place.value + unit),)):
            there = search.values(which)
        if there is None:
            return ()
        columns.append((there - own).ravel())
    matrix, wanted = np.array(columns).T, search.wanted[list(which)].ravel()
    moved, now = np.zeros(len(places)), own.ravel()
    for _turn in range(_TURNS):
        # what cannot be told apart is laid into the roughest number
        step, *_rest = np.linalg.lstsq(matrix * reach, wanted - now, rcond=1e-9)
        moved = moved + reach * step
        meant = [
            place.value + unit * x
            for place, unit, x in zip(places, units, moved.tolist(), strict=True)
        ]
        edits = tuple(place.edit(value) for place, value in zip(places, meant, strict=True))
        with changed(search.trial, edits):
            there = search.values(which)
            if there is not None and search.error_of(there, which) <= TOLERANCES.formula_agrees:
                good = search.error(range(len(search.wanted))) <= TOLERANCES.formula_agrees
                return _told(places, meant, matrix) if good else ()
        if there is None:
            return ()
        now = there.ravel()
    return ()


def _told(places: list[NumberPlace], meant: list[float], matrix: Array) -> tuple[str, ...]:
    pairs = [(float(place.value), value) for place, value in zip(places, meant, strict=True)]
    if not all(_stands(*pair) for pair in pairs):
        return ()
    far = sorted(pairs, key=lambda pair: -abs(pair[1] / pair[0] - 1))
    off = [p for p in far if abs(p[1] - p[0]) > TOLERANCES.same_relation * abs(p[0])][:_TOLD]
    if not off or np.linalg.matrix_rank(matrix) < len(places):
        return (_("the program's numbers are right to the digits that they are written with"),)
    told = (stands_for(f"{abs(old):.15g}", f"{abs(new):.7g}") for old, new in off)
    return tuple(dict.fromkeys(told))
