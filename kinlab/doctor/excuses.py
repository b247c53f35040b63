"""Right all the same, or right here only: what a difference, or none, is before it is a slip."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import relative_errors
from kinlab.check.diagnosis import Cause
from kinlab.doctor import rounding, verdicts
from kinlab.doctor.changes import AnswerEntry, Arguments, Case, entries, table_of
from kinlab.doctor.derivations.words import together
from kinlab.doctor.derived import derivation
from kinlab.doctor.slips import of_entry, slip_cause
from kinlab.doctor.terms import Slip
from kinlab.doctor.text.stand_ins import rounding_remarks, stand_ins
from kinlab.doctor.text.written import Written
from kinlab.doctor.verdicts import Excuse
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

_WHOLE_TERMS = {"extra term", "missing term"}


def excused(case: Case, engine: Array, written: dict[str, Written]) -> tuple[Case, Excuse | None]:
    """Why answers that are not the engine's are right, if they are.

    Beside others that are wrong, texts that are right with rounded numbers answer as the engine
    does: nothing is to be explained in them.
    """
    odd = verdicts.unusual(case, engine, 0.0 if written else TOLERANCES.finite_differences)
    if odd is not None:
        return case, odd
    if not written and (digits := verdicts.by_differences(case, engine)) is not None:
        return case, digits
    for said_of_all in rounding.roundings(case, engine, not written):
        return case, Excuse("rounded", said_of_all)
    if not written:
        return case, verdicts.of_coefficients(case, engine)
    remarks: list[str] = []
    settled, right = np.array(case.hand), True
    for entry in entries(case, engine):
        if entry.agrees:
            continue
        said = _rounded(case, entry, written.get(entry.label))
        right = right and said is not None
        if said is not None:
            remarks += said
            place: Any = (slice(None), *entry.local)
            settled[place] = entry.engine
    if right and remarks:
        return case, Excuse("rounded", tuple(dict.fromkeys(remarks)))
    if not right and (weighed := rounding.gravity_rounded(case, engine, False)) is not None:
        return case, Excuse("rounded", weighed)  # 5.88 for m2*g*l2: it was worked out with 9.8
    return replace(case, hand=settled), None


def _rounded(case: Case, entry: AnswerEntry, text: Written | None) -> list[str] | None:
    """Which rounded numbers make a text right, in words; None where it is not, so."""
    if text is None:
        return None
    at = verdicts.numbers_at(case)
    changed = stand_ins(text, at, entry.engine, entry.scale)
    if changed is not None:
        return [*text.rounded, *rounding_remarks(changed, at)]
    table = table_of(case.robot)
    derived = derivation(table, case.quantity.name) if table is not None else None
    said = verdicts.of_data(text, entry, derived, case) if derived is not None else None
    return [said] if said is not None else None


def covered_up(
    case: Case, engine: Array, written: dict[str, Written]
) -> tuple[list[Cause], float, list[str]]:
    """Slips of a text that only the robot's numbers cover up (l1/2 for l1**2 where l1 is 0.5).

    Numbers that stand for the robot's, as in (m1 + m2)*0.25, are none, but a remark.
    """
    table = table_of(case.robot)
    derived = derivation(table, case.quantity.name) if written and table is not None else None
    if derived is None:
        return [], 0.0, []
    slips: list[Slip] = []
    only: list[str] = []
    largest = 0.0
    for entry in entries(case, engine):
        poly = derived.polys[entry.index] if entry.index else derived.polys.item()
        text = written.get(entry.label)
        if text is None:
            continue
        kept, plain = verdicts.elsewhere(text, derived, poly, case.quantity.arguments)
        only += [name for name in kept if name not in only]
        gap = plain if not kept else 0.0
        if gap > TOLERANCES.formula_agrees:
            # a term put in for another of the same value is no slip, but another form
            told = [s for s in of_entry(case, entry, text) if not {*s.kinds} & _WHOLE_TERMS]
            slips += told[:1]
            largest = max(largest, gap) if told else largest
    said = together(f"{name} = {derived.arm.values[name]:.7g}" for name in only)
    remarks = [_("but it holds only for {numbers}").format(numbers=said)] if only else []
    return ([slip_cause(tuple(slips))] if slips else []), largest, remarks


def texts_again(
    case: Case, engine: Array, written: dict[str, Written]
) -> Callable[[Arguments], Array] | None:
    """The values of texts at other states, where every entry is a text."""
    if not written:
        return None
    every = entries(replace(case, hand=engine), engine)
    texts = [(entry.local, written.get(entry.label)) for entry in every]

    def again(states: Arguments) -> Array:
        at = verdicts.numbers_at(replace(case, arguments=states))
        out = np.empty((len(next(iter(states.values()))), *engine.shape[1:]))
        for local, text in texts:
            assert text is not None
            place: Any = (slice(None), *local)
            out[place] = text.values(at)
        return out

    return again if all(text is not None for _local, text in texts) else None


def without_value(case: Case, engine: Array) -> Cause | None:
    """A formula that is no number at some states, and right at all the others; or zero at all."""
    count = len(case.hand)
    whole_: Any = np.asarray(np.isfinite(case.hand).reshape(count, -1).all(axis=1))
    missing = int(np.sum(~whole_))
    if not missing:
        said = _("the formula gives zero at every state")
        most = TOLERANCES.formula_agrees * float(np.max(np.abs(engine)))
        some = bool(np.any(np.abs(case.hand) > most))  # else what differences leave of nothing
        return None if some else Cause(said, ("no value",), ("",), 0.0, 1.0)
    if missing == count:
        said = _("the formula gives no number at any state")
        return Cause(said, ("no value",), ("",), 0.0, 1.0)
    error = float(np.max(relative_errors(case.hand[whole_], engine[whole_])))
    if error > TOLERANCES.formula_agrees:
        return None
    told = _(
        "the formula gives no number at {missing} of {count} states; elsewhere it is right"
    ).format(missing=missing, count=count)
    return Cause(told, ("no value",), ("",), error, 1.0)


def rounding_alone(case: Case) -> Cause | None:
    """A function that inverts what has no inverse."""
    said = verdicts.erratic(case)
    return Cause(said, ("singular matrix",), ("",), 0.0, 1.0) if said else None
