"""Programs that are right up to a small number of theirs: where they stop, or what they damp."""

from __future__ import annotations

import math
from collections.abc import Sequence

from kinlab.doctor.program.edits.numbers.data import NumberPlace, numbers, together
from kinlab.doctor.program.grounds.scaled import is_own
from kinlab.doctor.program.places import changed
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.doctor.program.trial import NoProgramError, quietly
from kinlab.doctor.verdicts import Excuse
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

_PARTS = 1000
"""What small numbers are divided by."""
_LESS = 0.03
"""What must be left of the error then, at most."""
_EACH = 6
"""Small numbers of which each is tried alone."""
_WORK = 60_000_000
"""Work that may be done for them."""


def of_small_numbers(search: LineSearch) -> Excuse | None:
    """Why a program is right, if it is the righter the smaller numbers of its own are.

    An iteration stops where its step is below one, an inverse is damped with one: with a thousandth
    of that hardly anything is left of the error.
    """
    count = len(search.asked.wanted)
    before = search.asked.off
    if not TOLERANCES.formula_agrees < before <= TOLERANCES.may_be_rounded:
        return None
    small = [place for place in numbers(search.trial, search.observed) if _is_small(place, search)]
    each = [[place] for place in small[:_EACH]] if len(small) > 1 else []
    left = _WORK
    for some in ([small] if small else []) + each:
        left -= search.work.longer * search.work.of_all(count)
        if left < 0:
            break
        after = _error_with(search, some, count)
        if after <= max(TOLERANCES.formula_agrees, _LESS * before):
            return Excuse("digits", (_told(some, before, after),))
    return None


def _is_small(place: NumberPlace, search: LineSearch) -> bool:
    value = abs(float(place.value))
    own = is_own(search.case.robot, value) or is_own(search.case.robot, -value)
    return isinstance(place.value, float) and 0.0 < value <= TOLERANCES.is_small and not own


def _error_with(search: LineSearch, some: Sequence[NumberPlace], count: int) -> float:
    """The error that is left with smaller numbers."""
    edits = tuple(together([(place, float(place.value) / _PARTS) for place in some]))
    try:
        with quietly(), changed(search.trial, edits):
            return search.asked.error(range(count))
    except NoProgramError:
        return float("inf")


def _told(some: Sequence[NumberPlace], before: float, after: float) -> str:
    said = _(
        "it agrees to {digits} digits; what is off is that of {numbers} in the program: with a "
        "thousandth of that the error is {after:.0e}"
    )
    typed = dict.fromkeys(f"{abs(float(place.value)):g}" for place in some)
    digits = max(1, math.floor(-math.log10(2 * before)))
    return said.format(numbers=_(" and ").join(typed), digits=digits, after=max(after, 1e-16))
