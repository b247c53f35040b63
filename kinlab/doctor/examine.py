"""The examination: compare, try the readings, look for slips in the entries, rank what explains.

Nothing is named that does not account for every state to 1e-9; what accounts equally well is
named too, the simplest first.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from itertools import combinations, product
from typing import Any

import numpy as np

from kinlab.arrays import Array, first_largest, seed_of, whole
from kinlab.check.compare import relative_errors, some_rows
from kinlab.check.diagnosis import Cause, Diagnosis
from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.doctor import rounding, terms, verdicts
from kinlab.doctor.changes import Arguments, Case, Confusion, table_of
from kinlab.doctor.confusions.known import readings
from kinlab.doctor.derivations.joined import (
    Found,
    Ready,
    one_for_each_kind,
    ready,
    several_taken_otherwise,
    taken_at_one_joint,
    taken_otherwise,
)
from kinlab.doctor.derivations.parts import Apart, apart, proved
from kinlab.doctor.derivations.words import together
from kinlab.doctor.derived import derivation
from kinlab.doctor.numbers import other_numbers
from kinlab.doctor.program.words import WrongLines, meant
from kinlab.doctor.solutions.verdict import judged
from kinlab.doctor.terms import AnswerEntry, Slip, entries
from kinlab.doctor.text.stand_ins import rounding_remarks, stand_ins
from kinlab.doctor.text.written import Written
from kinlab.doctor.verdicts import Excuse
from kinlab.errors import KinlabError, OptionError
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

_SCREEN = 3
"""States on which a reading is tried first."""
_NAMED = 8
"""Causes that are kept."""
_FAR = 0.15
"""Cost beyond the likeliest cause's from which another of the same evidence is not told."""
_FETCHED = 1.35
"""Cost above which what explains a formula does not keep from looking at single joints."""
_RIVALS = 2
"""Entries that differ up to which slips are looked for beside a reading that explains them."""
_PATIENCE = 2
"""Entries without an explanation after which the rest are not tried."""
_WHOLE_ONLY = 3
"""Joints above which pairs of readings of single links are not tried: there are too many."""
_PLAIN = 1.1
"""Cost up to which one reading is likelier than two slips in a text."""
_FLOOD = 8
"""Slips in all entries together above which a list of them is no diagnosis."""
_LIST = 3
"""Slips in one cause above which a reading with fewer slips is looked for too."""
_WHOLE_TERMS = {"extra term", "missing term"}
_TIED = 5
"""Slips of one entry that are kept as alternatives."""


def examine(
    case: Case, hand: Any, engine: Array, quantity: str, name: str, written: dict[str, Written]
) -> Diagnosis:
    """Judges answers that are known already; ``written`` holds entries given as text.

    Raises:
        OptionError: the answers are not real numbers.
    """
    if case.quantity.read is not None:
        return judged(case, hand, engine, quantity, name, written)
    values = _read(hand, engine, name, quantity)
    case = replace(case, hand=values, again=case.again or _texts_again(case, engine, written))
    same = values.shape == engine.shape
    errors = relative_errors(values, engine) if same else np.full(len(values), np.inf)
    worst = float(np.max(errors))
    label = case.quantity.domain.label(case.robot)
    if worst <= TOLERANCES.formula_agrees:
        hidden, gap, remarks = _hidden(case, engine, written)
        right = Diagnosis(quantity, label, name, not hidden, max(worst, gap), tuple(hidden))
        rounded = tuple(dict.fromkeys(note for text in written.values() for note in text.rounded))
        form = "rounded" if rounded and not hidden else ""
        return replace(right, remarks=() if hidden else (*rounded, *remarks), form=form)
    case, excuse = _excuse(case, engine, written) if same else (case, None)
    near = excuse is not None and excuse.form == "near"
    if same and excuse is None:
        values, errors = case.hand, relative_errors(case.hand, engine)
        worst = float(np.max(errors))
    causes: list[Cause] = []
    partial: tuple[str, ...] = ()
    split: Apart | None = None
    if excuse is None:
        causes, partial, excuse, split = _explained(case, engine, written, worst)
    if excuse is not None and not near:
        right = Diagnosis(quantity, label, name, True, worst)
        return replace(right, form=excuse.form, remarks=excuse.remarks)
    if not same and (meant := some_rows(values.shape, engine.shape, quantity)):
        partial = (meant,)
    ranked = _ranked(causes)
    right_parts = proved(case, engine, split) if same and not ranked else ()
    close = not ranked and not written and (near or (same and worst <= TOLERANCES.nearly_agrees))
    k = first_largest(errors)
    where, furthest = _worst(values, engine, k, case) if same else ("shape", ())
    return Diagnosis(
        quantity,
        label,
        name,
        False,
        worst,
        tuple(ranked),
        partial if not ranked else (),
        where,
        {n: stack[k] for n, stack in case.arguments.items()},
        values[(k, *furthest)],
        engine[(k, *furthest)],
        "near" if close else "",
        proved=right_parts,
    )


def _explained(
    case: Case, engine: Array, written: dict[str, Written], worst: float
) -> tuple[list[Cause], tuple[str, ...], Excuse | None, Apart | None]:
    """What explains the difference, what is known of some entries, or why it is none.

    Returns:
        Causes; sentences on single entries; an excuse; and, where nothing explains the formula by
        one step, its kinds of term.
    """
    same = case.hand.shape == engine.shape
    silent = (_without_value(case, engine) or _rounding_alone(case)) if same else None
    tried = readings(case)
    signs = _bare_signs(case.hand)
    if signs:
        # bare signs agree by accident: no evidence for anything about the robot
        tried = [reading for reading in tried if reading.stage == "answer"]
    partial: tuple[str, ...] = ()
    off = [e for e in entries(case, engine) if not e.agrees] if same else []
    causes: list[Cause] = [silent] if silent is not None else []
    if written and off and silent is None:
        causes, partial = _slips(case, off, written)
    visible = bool(causes) and len(causes[0].kinds) <= 1
    read = same and not written and (silent is not None or not signs)
    looking = case.looked_through(engine, _left(worst)) if read else iter(())
    program: WrongLines | None = next(looking, None)
    edited = _exactly(program.causes, worst) if program else []
    rough: list[Cause] = []
    ways: Ready = []
    if edited and silent is not None:
        return edited[:1], (), None, None
    if not visible:
        # a slip that stands in the text comes before any step of a derivation
        loose = case if written else replace(case, slack=_left(worst))
        ways = [] if (written and causes) or signs else ready(case)
        every = [*_singly(loose, tried), *map(_as_steps, taken_otherwise(loose, ways))]
        exact = [c for c in every if c.error_after <= TOLERANCES.formula_agrees]
        if ways and program is None and all(cause.cost > _FETCHED for cause in exact):
            every += map(_as_steps, taken_at_one_joint(loose, ways))
            exact = [c for c in every if c.error_after <= TOLERANCES.formula_agrees]
        rough = [] if exact else _roughly(every, worst)
        if program is not None and not edited:
            limit = _PLAIN if program.written_out else _FETCHED
            if all(cause.cost > limit for cause in exact or rough):
                edited = [c for more in looking for c in _exactly(more.causes, worst)]
        if program is not None and edited:
            read_so = [] if program.written_out else exact or rough
            known = [cause for cause in read_so if cause.cost <= _FETCHED]
            return meant(edited, known), (), None, None
        causes = _outranked(causes, exact)
        if not written and off and (not causes or len(off) <= _RIVALS):
            found, partial = _slips(case, off, written)
            causes += found
    listed = all({*c.kinds} == {"coefficient"} for c in causes)
    if listed and same and not written and not signs:
        changed = list(other_numbers(case))
        causes = [*_singly(case, changed)] or rough or causes
        near = None if causes else verdicts.to_digits(case, engine)
        if near is not None:
            return [], (), near, None
    split: Apart | None = None
    if not causes and not signs:
        split = apart(case)
        few = case if written else replace(case, slack=min(_left(worst), TOLERANCES.slips_leave))
        found_ = one_for_each_kind(few, ways, split) or several_taken_otherwise(few, ways, split)
        causes = _exactly([_as_steps(found) for found in found_], worst)
        if not causes:
            causes = _exactly([*_in_pairs(few, tried)], worst)
    if not causes and signs:
        causes = [*_in_pairs(case, tried)]
    if same and all(len(cause.kinds) > _LIST for cause in causes):
        # beside a list of slips only the likeliest reading: each costs a search of its own
        likely = [r for r in tried if r.kind == "sign"] if causes else tried
        causes += _reading_and_slips(case, likely, engine)
    return causes, partial, None, split


def _texts_again(
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


def _without_value(case: Case, engine: Array) -> Cause | None:
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


def _rounding_alone(case: Case) -> Cause | None:
    """A function that inverts what has no inverse."""
    said = verdicts.erratic(case)
    return Cause(said, ("singular matrix",), ("",), 0.0, 1.0) if said else None


def _left(worst: float) -> float:
    """The relative error that finite differences may leave once a slip of that size is undone."""
    most = min(TOLERANCES.finite_differences, TOLERANCES.left_of_slip * worst)
    return max(TOLERANCES.formula_agrees, most)


def _exactly(causes: list[Cause], worst: float) -> list[Cause]:
    """Explanations that leave nothing; where there are none, those that leave differences."""
    exact = [cause for cause in causes if cause.error_after <= TOLERANCES.formula_agrees]
    return exact or _roughly(causes, worst)


def _roughly(causes: list[Cause], worst: float) -> list[Cause]:
    """Explanations that leave what finite differences leave, and far less than was off."""
    near = [cause for cause in causes if cause.error_after <= _left(worst)]
    least = min((cause.error_after for cause in near), default=0.0)
    said = _("{slip} (what is left, {left:.0e}, is that of finite differences)")
    return [
        replace(cause, sentence=said.format(slip=cause.sentence, left=cause.error_after))
        for cause in near
        if cause.error_after <= 10 * least
    ]


def _ranked(causes: list[Cause]) -> list[Cause]:
    """The likeliest first, of each kind one; what is clearly more far-fetched is not told."""
    kinds: dict[tuple[str, ...], Cause] = {}
    for cause in sorted(causes, key=lambda c: c.cost):
        kinds.setdefault(cause.kinds, cause)
    kept = list(kinds.values())
    return [cause for cause in kept if cause.cost <= kept[0].cost + _FAR][:_NAMED]


def _the_formula(does: Iterable[str]) -> str:
    return _("the formula {does}").format(does=_(" and ").join(does))


def _as_steps(found: Found) -> Cause:
    return Cause(
        _the_formula(step.sentence for step in found.steps),
        tuple(step.kind for step in found.steps),
        tuple("" if step.joint is None else f"joint {step.joint}" for step in found.steps),
        found.error,
        found.cost,
    )


def _outranked(slips: list[Cause], whole_: list[Cause]) -> list[Cause]:
    """Slips in the writer's line before a far-fetched reading; a plain one before many slips."""
    if not slips:
        return whole_
    plain = [cause for cause in whole_ if cause.cost <= _PLAIN and len(slips[0].kinds) > 1]
    return plain or slips


def _hidden(
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
            told = [s for s in _of_entry(case, entry, text) if not {*s.kinds} & _WHOLE_TERMS]
            slips += told[:1]
            largest = max(largest, gap) if told else largest
    said = together(f"{name} = {derived.arm.values[name]:.7g}" for name in only)
    remarks = [_("but it holds only for {numbers}").format(numbers=said)] if only else []
    return ([_slip_cause(tuple(slips))] if slips else []), largest, remarks


def _excuse(case: Case, engine: Array, written: dict[str, Written]) -> tuple[Case, Excuse | None]:
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


def prepare(
    robot: Any, plain: str, index: tuple[Any, ...], samples: int, seed: int
) -> tuple[Case, Array]:
    """The case of a comparison, without an answer yet, and what the engine says.

    Raises:
        NameUnknownError, OptionError: as :func:`kinlab.diagnose`.
    """
    samples, seed = whole(samples, "samples", 10), seed_of(seed)
    found = find_quantity(plain)
    mechanism = found.domain.load(robot)
    states = found.states(mechanism, int(samples), seed)
    arguments = dict(zip(found.arguments, states, strict=True))
    case = Case(mechanism, found, arguments, np.empty(0), index)
    return case, np.asarray(case.answer(()), dtype=float)


def _bare_signs(values: Array) -> bool:
    """Whether every number is -1, 0 or 1, to rounding."""
    signs = np.clip(np.nan_to_num(np.rint(values)), -1.0, 1.0)
    return bool(np.all(np.abs(values - signs) <= TOLERANCES.formula_agrees))


def _read(hand: Any, engine: Array, name: str, quantity: str) -> Array:
    values = np.asarray(hand)
    if values.dtype.kind not in "iuf":
        raise OptionError(f"{name}: answered with dtype {values.dtype}; {quantity!r} is numbers")
    values = values.astype(float)
    if values.shape != engine.shape and values.size == engine.size:
        squeezed = [s for s in values.shape[1:] if s != 1]
        if squeezed == [s for s in engine.shape[1:] if s != 1]:
            return values.reshape(engine.shape)
    return values


def _matches(case: Case, chosen: tuple[Confusion, ...]) -> float | None:
    """The error that is left under the readings, or None where they do not apply."""
    try:
        with np.errstate(all="ignore"):
            answer = case.answer(chosen)
    except (KinlabError, np.linalg.LinAlgError, IndexError):
        return None  # no such robot, no inertia, or no such entry (6 by n transposed)
    if answer.shape != case.hand.shape:
        return None
    error = float(np.max(relative_errors(case.hand, answer)))
    return error if error <= case.slack else None


def _singly(case: Case, tried: list[Confusion]) -> Iterator[Cause]:
    few = case.few(_SCREEN)
    for reading in tried:
        if _matches(few, (reading,)) is not None:
            error = _matches(case, (reading,))
            if error is not None:
                yield _as_cause((reading,), error)


def _in_pairs(case: Case, tried: list[Confusion]) -> Iterator[Cause]:
    few = case.few(_SCREEN)
    if case.arguments and getattr(case.robot, "n", 0) > _WHOLE_ONLY:
        tried = [reading for reading in tried if not reading.place]
    answers = [r for r in tried if r.stage == "answer"]
    before = [r for r in tried if r.stage != "answer"]
    yield from _found(
        case,
        (
            (one, two)
            for one, two in combinations(answers, 2)
            if _apart(one, two) and _seems(few, (one, two))
        ),
    )
    for k, first in enumerate(before):
        changed, rest = _begun(few, first)
        if changed is None:
            continue
        partners = [r for r in (*before[k + 1 :], *answers) if _apart(first, r)]
        if first.place:  # two links at once: that is another arm
            partners = [r for r in partners if not (r.stage == "robot" and r.place)]
        chosen = ((first, second) for second in partners if _seems(changed, (*rest, second)))
        yield from _found(case, chosen)


def _begun(few: Case, first: Confusion) -> tuple[Case | None, tuple[Confusion, ...]]:
    """A case with the robot changed already, so that it is built once for all partners."""
    if first.stage != "robot":
        return few, (first,)
    try:
        return replace(few, robot=first.apply(few.robot)), ()
    except KinlabError:
        return None, ()


def _seems(few: Case, chosen: tuple[Confusion, ...]) -> bool:
    return _matches(few, chosen) is not None


def _apart(one: Confusion, two: Confusion) -> bool:
    return (one.kind, one.place) != (two.kind, two.place)


def _found(case: Case, chosen: Iterable[tuple[Confusion, ...]]) -> Iterator[Cause]:
    for readings_ in chosen:
        error = _matches(case, readings_)
        if error is not None:
            yield _as_cause(readings_, error)


def _as_cause(chosen: tuple[Confusion, ...], error: float) -> Cause:
    return Cause(
        _the_formula(r.sentence for r in chosen),
        tuple(r.kind for r in chosen),
        tuple(r.place for r in chosen),
        error,
        sum(r.cost for r in chosen),
    )


def _slips(
    case: Case, off: list[AnswerEntry], written: dict[str, Written]
) -> tuple[list[Cause], tuple[str, ...]]:
    """Causes that are slips of the pen in the entries that are off, or what is known of some."""
    per_entry: list[list[Slip]] = []
    seen: list[Written] = []
    for entry in off:
        text = written.get(entry.label)
        if text is not None:
            if any(text is other for other in seen):
                continue  # the mirror image of an entry that is given once
            seen.append(text)
        found = _of_entry(case, entry, text)
        # all repairs of a text give one formula: the likeliest is told
        per_entry.append(_varied(found)[: 1 if text is not None else _TIED])
        told = sum(len(found[0].kinds) for found in per_entry if found)
        if sum(not found for found in per_entry) >= _PATIENCE or (not written and told > _FLOOD):
            break
    if not all(per_entry):
        return [], tuple(found[0].sentence for found in per_entry if found)
    # alternatives are told for one entry at a time; all of all would be a flood
    if sum(len(found[0].kinds) for found in per_entry) > _FLOOD:
        return [], tuple(found[0].sentence for found in per_entry)
    sets = product(*per_entry) if len(per_entry) == 1 else [tuple(f[0] for f in per_entry)]
    return [_slip_cause(chosen) for chosen in sets], ()


def _varied(found: list[Slip]) -> list[Slip]:
    """The cheapest of each combination of kinds: places that are equal by value say no more."""
    kinds: dict[tuple[str, ...], Slip] = {}
    for slip in sorted(found, key=lambda s: s.cost):
        kinds.setdefault(tuple(sorted(slip.kinds)), slip)
    return list(kinds.values())[:_TIED]


def _slip_cause(slips: tuple[Slip, ...]) -> Cause:
    return Cause(
        _("; ").join(s.sentence for s in slips),
        tuple(k for s in slips for k in s.kinds),
        tuple(s.entry for s in slips),
        max(s.error for s in slips),
        sum(s.cost for s in slips),
        {s.entry: s.corrected for s in slips if s.corrected},
        {s.entry: s.typed for s in slips if s.typed},
    )


def _of_entry(case: Case, entry: AnswerEntry, text: Written | None) -> list[Slip]:
    table = table_of(case.robot)
    derived = derivation(table, case.quantity.name) if table is not None else None
    if derived is None:
        return []
    poly = derived.polys[entry.index] if entry.index else derived.polys.item()
    arguments = case.quantity.arguments
    if text is not None:
        found = terms.in_text(entry.label, text, derived, poly, arguments, case.arguments)
    else:
        others = [derived.tree(p) for p in derived.polys.flat if len(p) < 200]
        found = terms.in_function(
            entry.label,
            entry.hand,
            entry.engine,
            derived,
            poly,
            arguments,
            case.arguments,
            others[:12],
        )
    good = []
    for slip in found:
        left = entry.engine if slip.repaired else entry.hand
        error = entry.error(slip.values, left)
        if error <= TOLERANCES.formula_agrees:
            good.append(slip.with_error(error))
    return good


def _reading_and_slips(case: Case, tried: list[Confusion], engine: Array) -> Iterator[Cause]:
    """A whole-answer reading undone, and slips in what is left."""
    before = sum(not e.agrees for e in entries(case, engine))
    for reading in tried:
        if reading.stage != "answer" or reading.kind not in _UNDONE or case.index:
            continue
        undone = reading.apply(case.hand)
        if undone.shape != engine.shape:
            continue
        if reading.kind == "factor":
            undone = case.hand * (case.hand / np.where(undone, undone, 1.0))
        changed = replace(case, hand=undone, again=None)
        off = [e for e in entries(changed, engine) if not e.agrees]
        if len(off) >= max(before, 2) or len(off) > _RIVALS:
            continue
        if np.max(relative_errors(undone, engine)) >= np.max(relative_errors(case.hand, engine)):
            continue  # what undoes a slip brings the answer nearer
        for cause in _slips(changed, off, {})[0]:
            if len(cause.kinds) > _LIST:
                continue  # what leaves so much is not undone
            yield Cause(
                _("the formula {does}, and then {slips}").format(
                    does=reading.sentence, slips=cause.sentence
                ),
                (reading.kind, *cause.kinds),
                (reading.place, *cause.places),
                cause.error_after,
                reading.cost + cause.cost,
                cause.corrected,
            )


_UNDONE = {
    "sign",
    "transposed",
    "row order",
    "inverse",
    "rotation transposed",
    "joint order",
    "row sign",
    "column sign",
    "rows swapped",
}
"""Readings of the answer that are their own inverse."""


def _worst(hand: Array, engine: Array, k: int, case: Case) -> tuple[str, tuple[int, ...]]:
    gap = np.abs(hand[k] - engine[k])
    gap = np.where(np.isfinite(gap), gap, np.inf)
    place = tuple(int(i) for i in np.unravel_index(first_largest(np.ravel(gap)), gap.shape))
    labels = {e.local: e.label for e in entries(case, engine)}
    return labels[place], place
