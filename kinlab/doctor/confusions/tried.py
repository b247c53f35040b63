"""A known confusion, or two at once, held against the answers: which explain every state."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import relative_errors
from kinlab.check.diagnosis import Cause
from kinlab.doctor.changes import Case, Confusion
from kinlab.errors import KinlabError
from kinlab.host.language import _

_SCREEN = 3
"""States on which a reading is tried first."""
_WHOLE_ONLY = 3
"""Joints above which pairs of readings of single links are not tried: there are too many."""


def singly(case: Case, tried: list[Confusion]) -> Iterator[Cause]:
    few = case.few(_SCREEN)
    for reading in tried:
        if _matches(few, (reading,)) is not None:
            error = _matches(case, (reading,))
            if error is not None:
                yield _as_cause((reading,), error)


def in_pairs(case: Case, tried: list[Confusion]) -> Iterator[Cause]:
    few = case.few(_SCREEN)
    if case.arguments and getattr(case.robot, "n", 0) > _WHOLE_ONLY:
        tried = [reading for reading in tried if not reading.place]
    known: Known = {}
    answers = [r for r in tried if r.stage == "answer"]
    before = [r for r in tried if r.stage != "answer"]
    yield from _found(
        case,
        (
            (one, two)
            for one, two in combinations(answers, 2)
            if _apart(one, two) and _seems(few, (one, two), known)
        ),
    )
    for k, first in enumerate(before):
        changed, rest = _begun(few, first)
        if changed is None:
            continue
        partners = [r for r in (*before[k + 1 :], *answers) if _apart(first, r)]
        if first.place:  # two links at once: that is another arm
            partners = [r for r in partners if not (r.stage == "robot" and r.place)]
        known = {}
        chosen = [(first, second) for second in partners if _seems(changed, (*rest, second), known)]
        yield from _found(case, chosen)


def _begun(few: Case, first: Confusion) -> tuple[Case | None, tuple[Confusion, ...]]:
    """A case with the robot changed already, so that it is built once for all partners."""
    if first.stage != "robot":
        return few, (first,)
    try:
        return replace(few, robot=first.apply(few.robot)), ()
    except KinlabError:
        return None, ()


Known = dict[tuple[Confusion, ...], Array]
"""The engine's answers of one case, by the readings that come before them."""


def _seems(few: Case, chosen: tuple[Confusion, ...], known: Known) -> bool:
    return _matches(few, chosen, known) is not None


def _apart(one: Confusion, two: Confusion) -> bool:
    return (one.kind, one.place) != (two.kind, two.place)


def _found(case: Case, chosen: Iterable[tuple[Confusion, ...]]) -> Iterator[Cause]:
    for readings_ in chosen:
        error = _matches(case, readings_)
        if error is not None:
            yield _as_cause(readings_, error)


def _matches(case: Case, chosen: tuple[Confusion, ...], known: Known | None = None) -> float | None:
    """The error that is left under the readings, or None where they do not apply."""
    before = tuple(reading for reading in chosen if reading.stage != "answer")
    try:
        with np.errstate(all="ignore"):
            if known is None:
                answer = case.answer(chosen)
            else:
                if before not in known:
                    known[before] = case.asked(before)
                answer = case.read_as(known[before].copy(), chosen)
    except (KinlabError, np.linalg.LinAlgError, IndexError):
        return None  # no such robot, no inertia, or no such entry (6 by n transposed)
    if answer.shape != case.hand.shape:
        return None
    error = float(np.max(relative_errors(case.hand, answer)))
    return error if error <= case.slack else None


def _as_cause(chosen: tuple[Confusion, ...], error: float) -> Cause:
    return Cause(
        the_formula(r.sentence for r in chosen),
        tuple(r.kind for r in chosen),
        tuple(r.place for r in chosen),
        error,
        sum(r.cost for r in chosen),
    )


def the_formula(does: Iterable[str]) -> str:
    return _("the formula {does}").format(does=_(" and ").join(does))
