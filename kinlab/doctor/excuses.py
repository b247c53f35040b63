"""Right all the same, or right here only: what a difference, or none, is before it is a slip."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import relative_errors
from kinlab.check.diagnosis import Cause
from kinlab.doctor import rounding, verdicts
from kinlab.doctor.changes import ANGLES, AnswerEntry, Arguments, Case, entries, table_of
from kinlab.doctor.confusions.centres import as_there, centres_elsewhere
from kinlab.doctor.derivations.words import together
from kinlab.doctor.derived import Derivation, derivation_of, searchable
from kinlab.doctor.entries.terms import Slip
from kinlab.doctor.linkages.looked_up import Reference, reference_of
from kinlab.doctor.slips import of_entry, slip_cause
from kinlab.doctor.text.habits import NOTHING
from kinlab.doctor.text.stand_ins import bare_number, rounding_remarks, stand_ins
from kinlab.doctor.text.written import Together, Written
from kinlab.doctor.verdicts import Excuse
from kinlab.errors import KinlabError, already_said
from kinlab.formulas.text import canonical, parse, words_in
from kinlab.formulas.tree import Node, evaluate, names, renamed
from kinlab.host.language import _
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

_ELSEWHERE = 10
"""Seed of the numbers at which names are moved."""
_WHOLE_TERMS = {"extra term", "missing term"}


def excused(case: Case, engine: Array, written: dict[str, Written]) -> tuple[Case, Excuse | None]:
    """Why answers that are not the engine's are right, if they are.

    Beside others that are wrong, texts that are right with rounded numbers answer as the engine
    does: nothing is to be explained in them.
    """
    odd = verdicts.unusual(case, engine, 0.0 if written else TOLERANCES.finite_differences)
    if odd is not None:
        return case, _with_numbers(odd, case, engine, written)
    case, turned = (case, ()) if written else verdicts.without_turns(case, engine)
    if turned:
        case, found = excused(case, engine, written)
        return case, found and replace(found, remarks=(*turned, *found.remarks))
    for rounded in (verdicts.answers_rounded, verdicts.answers_to_digits):
        if not written and (cut := rounded(case, engine)) is not None:
            return case, cut
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
        found = Excuse("rounded", tuple(dict.fromkeys(remarks)))
        return case, _with_numbers(found, case, engine, written)
    odd = None if right else verdicts.weighed_otherwise(case, engine)
    odd = odd or (None if right else _unusual_and_rounded(case, engine, written))
    if odd is not None:
        return case, _with_numbers(odd, case, engine, written)
    if not right and (weighed := rounding.gravity_rounded(case, engine, False)) is not None:
        return case, Excuse("rounded", weighed)  # 5.88 for m2*g*l2: it was worked out with 9.8
    return replace(case, hand=settled), None


def _unusual_and_rounded(case: Case, engine: Array, written: dict[str, Written]) -> Excuse | None:
    """A potential's other zero, or another valid C, row by row, with rounded numbers in it."""
    every = entries(replace(case, hand=engine), engine)
    texts = {entry.local: written.get(entry.label) for entry in every}
    if not verdicts.any_other(case):
        return None
    if case.quantity.name in verdicts.ENERGIES or case.index:
        return _by_digits(case, engine, [*texts.values()])
    remarks: list[str] = []
    for i in range(engine.shape[1]):
        row = replace(case, index=(i,), hand=case.hand[:, i])
        if verdicts.largest_share(row, engine[:, i]) > TOLERANCES.formula_agrees:
            found = _by_digits(row, engine[:, i], [x for at, x in texts.items() if at[0] == i])
            if found is None:
                return None
            remarks += found.remarks
    said = verdicts.other_form(replace(case, index=(0,)), engine, 0.0)
    return Excuse("unusual", tuple(dict.fromkeys((said, *remarks))))


def _by_digits(case: Case, engine: Array, texts: list[Written | None]) -> Excuse | None:
    """The same of the texts of one answer, or of one row, together."""
    known = tuple(text for text in texts if text is not None)
    if len(known) < len(texts):
        return None
    whole = Together(known, engine.shape[1:], lambda x: verdicts.essential(case, x))
    return verdicts.by_digits(whole, case, engine)


def _rounded(case: Case, entry: AnswerEntry, text: Written | None) -> list[str] | None:
    """Which rounded numbers make a text right, in words; None where it is not, so."""
    if text is None:
        return None
    at, alone = verdicts.numbers_at(case), case.hand.ndim == 1
    if alone and bare_number(text, at, entry.engine) is False:
        return None
    found = stand_ins(text, at, entry.engine, entry.scale, alone=alone)
    if found is not None:
        return [*text.rounded, *rounding_remarks(found.changed, at)]
    derived = derivation_of(case)
    if derived is None:
        return None
    said = verdicts.of_data(text, entry, derived, case)
    if said is not None:
        return [said]
    return verdicts.of_bare_numbers(text, entry, derived, case)


def _with_numbers(found: Excuse, case: Case, engine: Array, written: dict[str, Written]) -> Excuse:
    """An excuse with what the texts have numbers for and no name, but for those told: g = 9.81."""
    derived = reference_of(case) if written else None
    if derived is None:
        return found
    right: set[str] = set()
    if found.form == "unusual" and isinstance(derived, Derivation) and verdicts.any_other(case):
        right = _held_in_essence(case, engine, derived, written)
    else:
        for entry in entries(replace(case, hand=engine), engine):
            poly = derived.entry(entry.index)
            right |= verdicts.unnamed(written.get(entry.label), derived, poly)
    own = (f"{name} = {derived.values[name]:.7g}" for name in sorted(right))
    only = [one for one in own if not any(_tells(remark, one) for remark in found.remarks)]
    return replace(found, remarks=(*found.remarks, *only_for(only)))


def _tells(remark: str, one: str) -> bool:
    """Whether a remark has a number, or says what the writer has in its place: g = 9.8."""
    return one in remark or remark.startswith(one.partition(" = ")[0] + " = ")


def _held_in_essence(
    case: Case, engine: Array, derived: Derivation, written: dict[str, Written]
) -> set[str]:
    """Names that texts lack on which what is the same of all valid formulas depends.

    Of a potential that is what it changes by, of a C a row of C qd: a name in a constant, or in
    one entry of a row whose others have it, is none of them.
    """
    at = derived.another(_ELSEWHERE)
    energies = case.quantity.name in verdicts.ENERGIES
    rows: dict[tuple[int, ...], list[tuple[Node, AnswerEntry]]] = {}
    named: dict[tuple[int, ...], set[str]] = {}
    for entry in entries(replace(case, hand=engine), engine):
        poly, text = derived.entry(entry.index), written.get(entry.label)
        if not searchable(poly) or text is None:
            return set()
        row = entry.index if energies else entry.index[:-1]
        rows.setdefault(row, []).append((derived.tree(poly), entry))
        named.setdefault(row, set()).update(names(text.node))
    found: set[str] = set()
    for row, parts in rows.items():

        def essence(there: Mapping[str, Array], parts: list[Any] = parts) -> Array:
            values = [np.asarray(evaluate(one, dict(there))) for one, _entry in parts]
            if energies:
                return np.asarray(values[0] - np.mean(values[0]))
            rates = [there[f"qd{entry.index[-1] + 1}"] for _one, entry in parts]
            return np.asarray(sum(x * rate for x, rate in zip(values, rates, strict=True)))

        here = essence(at)
        size = TOLERANCES.formula_agrees * float(np.max(np.abs(here), initial=0.0))
        for name in set[str]().union(*(names(one) for one, _entry in parts)) - named[row]:
            moved = essence(derived.but_for(name, at)) if name in derived.parameters else here
            found |= {name} if np.max(np.abs(moved - here)) > size else set()
    return found


def only_for(numbers: Sequence[str]) -> list[str]:
    """What is told of a formula that has numbers of the robot for their names."""
    said = together(numbers)
    return [_("but it holds only for {numbers}").format(numbers=said)] if numbers else []


_TRIED = 6
"""States at which a repaired text is compared with what it was."""


def covered_up(
    case: Case, engine: Array, written: dict[str, Written]
) -> tuple[list[Cause], float, list[str]]:
    """Slips of a text that only the robot's numbers cover up (l1/2 for l1**2 where l1 is 0.5).

    Numbers that stand for the robot's, as in (m1 + m2)*0.25, are none, but a remark.

    Returns:
        What explains it; how far off it is elsewhere, more than nothing also where no single slip
        explains it and no number in the text can stand for one of the robot's; and remarks.
    """
    derived = reference_of(case) if written else None
    if derived is None:
        return [], 0.0, []
    slips: list[Slip] = []
    only: list[str] = []
    nothing: list[str] = []
    largest = 0.0
    for entry in entries(case, engine):
        poly = derived.entry(entry.index)
        text = written.get(entry.label)
        if text is None:
            continue
        turns = case.quantity.name in ANGLES
        kept, gap = verdicts.elsewhere(text, derived, poly, case.quantity.arguments, turns)
        zero = (
            name for name in dict.fromkeys(words_in(text.text)) if text.symbols.get(name) == NOTHING
        )
        nothing += [name for name in zero if name not in nothing]
        if gap > TOLERANCES.formula_agrees:
            # a term put in for another of the same value is no slip, but another form
            every = of_entry(case, entry, text) if _names_numbers(text, derived) else []
            told = [s for s in every if not {*s.kinds} & _WHOLE_TERMS and not _as_before(s, text)]
            slips += told[:1]
            wrong = bool(told) or not _may_stand(text, derived)
            largest = max(largest, gap) if wrong else largest
            kept = [] if told else kept
        only += [name for name in kept if name not in only]
    remarks = only_for([f"{name} = {derived.values[name]:.7g}" for name in only])
    if nothing:
        zeros = together(f"{name} = 0" for name in nothing)
        remarks.append(
            _("of this robot {names}: what stands with it is not judged").format(names=zeros)
        )
    return ([slip_cause(tuple(slips))] if slips else []), largest, remarks


def _names_numbers(text: Written, derived: Reference) -> bool:
    """Whether a text has a name for any number of the robot's: others hold for this one alone."""
    return not names(text.node).isdisjoint(derived.parameters)


def _may_stand(text: Written, derived: Reference) -> bool:
    """Whether a number in a text may stand for the robot's, 0.25 for l1**2, or l1 for l2."""
    values = [(name[0], abs(float(x))) for name, x in derived.values.items() if x]
    if not isinstance(derived, Derivation):
        return True
    if not _names_numbers(text, derived) or len({*values}) < len(values):
        return True
    own = {abs(float(x)) for x in derived.values.values()} - {0.0, 1.0}
    meant = own | {x * y for x in own for y in own} | {1.0 / x for x in own}
    literals = [abs(float(n.value)) for n in text.literals if not n.exponent]
    return any(math.isclose(x, y, rel_tol=1e-3) for x in literals for y in meant)


def _as_before(slip: Slip, text: Written) -> bool:
    """Whether a text is the same everywhere with a slip repaired: two signs that cancel."""
    try:
        new = parse(slip.corrected)
    except KinlabError:
        return False
    new = renamed(new, {name: canonical(name) for name in names(new)})
    every = sorted(names(new) | names(text.node))
    rng = np.random.default_rng(7)
    at = {name: rng.uniform(0.3, 1.7, _TRIED) for name in every}
    old, repaired = (evaluate(node, at) for node in (text.node, new))
    return bool(np.allclose(old, repaired, rtol=TOLERANCES.formula_agrees, atol=0.0))


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


_LONGER, _HEAVIER = (1.19, 1.37, 1.29, 1.13), (1.29, 0.77, 1.13, 0.91)
"""What lengths and masses of another arm are multiplied by, link by link."""


def for_another_arm(
    case: Case, engine: Array, written: dict[str, Written]
) -> tuple[Case, Array, dict[str, Written]] | None:
    """The texts for an arm that has other numbers for their names, and what the engine says there.

    The centres that the texts name are no simple parts of its lengths. None where the texts have
    numbers of this arm in them, or names of none.
    """
    if case.again is None or any(map(_has_numbers, written.values())):
        return None
    table = table_of(case.robot)
    moved = None if table is None else centres_elsewhere(table, written.values(), False)
    if table is not None and moved is not None:
        written = {label: as_there(text, table, moved) for label, text in written.items()}
        table = moved
    other = None if table is None else _with_other_numbers(table, written)
    if other is None:
        return None
    try:
        with already_said():
            there = replace(case, robot=Robot.from_dh(other), again=None)
        right = np.asarray(there.answer(()), dtype=float)
        again = texts_again(there, right, written)
        hand = None if again is None else again(there.arguments)
    except (KinlabError, KeyError, TypeError, ValueError):
        return None
    if hand is None or not (np.isfinite(hand).all() and np.isfinite(right).all()):
        return None
    return replace(there, hand=hand, again=again), right, written


def _has_numbers(text: Written) -> bool:
    """Whether a text has a number that is no plain fraction."""
    return any(not n.whole and 12 * n.value % 1 and not n.exponent for n in text.literals)


def _with_other_numbers(table: DHTable, written: dict[str, Written]) -> DHTable | None:
    """The arm with other lengths, masses, centres and moments, where the texts name them."""
    named = set[str]().union(*(names(text.node) for text in written.values()))
    values = {n: abs(float(x)) for n, x in vocabulary(table).values.items() if n in named}
    lengths = {n: x for n, x in values.items() if n[0] not in "mIg" and x}
    longer = {x: _LONGER[k % len(_LONGER)] for k, x in enumerate(dict.fromkeys(lengths.values()))}
    links = []
    for k, link in enumerate(table.links):
        mass = _HEAVIER[k % len(_HEAVIER)] if f"m{k + 1}" in values else 1.0
        own = [longer[x] for n, x in lengths.items() if n[1:] == str(k + 1) and n[0] in "lad"]
        size = own[0] if own else 1.0  # of a link and of what is in it
        com = [x * longer.get(abs(x), size) for x in map(float, np.asarray(link.com))]
        inertia = mass * size**2 * np.asarray(link.inertia)
        a, d = (x * longer.get(abs(x), 1.0) for x in (link.a, link.d))
        links.append(replace(link, a=a, d=d, mass=mass * link.mass, com=com, inertia=inertia))
    if not longer and not any(n[0] == "m" for n in values):
        return None
    tool, base = np.array(table.tool, dtype=float), np.array(table.base, dtype=float)
    for pose in (tool, base):
        pose[:3, 3] = [x * longer.get(abs(x), 1.0) for x in pose[:3, 3]]
    try:
        with already_said():
            return replace(table, links=links, tool=tool, base=base)
    except KinlabError:
        return None


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
