"""Slips of the pen in the entries that are off, alone or after a reading of the whole answer."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from functools import cache, partial
from itertools import product

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import relative_errors
from kinlab.check.diagnosis import Cause
from kinlab.doctor.changes import AnswerEntry, Case, Confusion, entries, table_of
from kinlab.doctor.confusions.centres import FreeCentres, apart, by_equal_numbers, stands_so
from kinlab.doctor.derived import Derivation, searchable
from kinlab.doctor.entries import terms
from kinlab.doctor.entries.definitions import Definitions
from kinlab.doctor.entries.terms import Slip
from kinlab.doctor.linkages.looked_up import Reference, reference_of
from kinlab.doctor.text.habits import as_text
from kinlab.doctor.text.line import Line
from kinlab.doctor.text.meanings import Meanings
from kinlab.doctor.text.written import Written
from kinlab.doctor.verdicts import numbers_at
from kinlab.errors import KinlabError
from kinlab.formulas import tree
from kinlab.formulas.text import canonical, parse, words_in
from kinlab.host.language import _
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

RIVALS = 2
"""Entries that differ up to which slips are looked for beside a reading that explains them."""
LIST = 3
"""Slips in one cause above which a reading with fewer slips is looked for too."""
_PATIENCE = 2
"""Entries without an explanation after which the rest are not tried."""
_PAIR = 2
"""Slips of a formula itself beside which none is looked for in definitions."""
_NO_DOUBT = 0.45
"""What two slips must cost less of which one is in a definition, for two of the formula itself."""
_FLOOD = 8
"""Slips in all entries together above which a list of them is no diagnosis."""
_TIED = 5
"""Slips of one entry that are kept as alternatives."""
_TURNS, _SHARE = 6, 0.01
"""Steps in which a number is found, and the share by which it is moved for its slope."""
_LOST, _MISSING, _FACTOR = "missing factor", "missing term", "factor"
_NUMBER = re.compile(r"(?<![\w.])\d[\d.]*(?![\w.])")
_HALF = re.compile(r"/ *2\b|\b0?\.5\b")
_RATE = re.compile(r"qd{1,2}\d+")
_FUNCTIONS = {"sin", "cos", "tan"}
_UNDONE = {"sign", "transposed", "row order", "inverse", "rotation transposed", "joint order"}
_UNDONE |= {"row sign", "column sign", "rows swapped"}
"""Readings of the answer that are their own inverse."""


def slips_in(
    case: Case, off: list[AnswerEntry], written: dict[str, Written]
) -> tuple[list[Cause], tuple[str, ...]]:
    """Causes that are slips of the pen in the entries that are off, or what is known of some."""
    defined: list[Slip] = []
    every = off
    if (mistyped := _mistyped(case, off, written) or _misnamed(case, off, written)) is not None:
        defined.append(mistyped)
        written = _defined_otherwise(case, written, mistyped)
        off = _still_off(case, every, written)
    some = [*_definitions(case, every, off, written)]
    while len(defined) < LIST and (one := _defined(case, every, off, some, written)) is not None:
        defined.append(one)
        written = _defined_otherwise(case, written, one)
        off = _still_off(case, every, written)
        some = [*_definitions(case, every, off, written)]
    some = [] if defined else some
    asked = {entry.label: entry for entry, _one in some}
    own = {x: of_entry(case, one, written[x], _PAIR) for x, one in asked.items()}
    few = {x for x, found in own.items() if not found}
    open_ = [(entry, one) for entry, one in some if entry.label in few]
    several = _with_more(case, every, open_, written, Definitions.with_one_more)
    if len(off) == len(own) == 1 and not few:  # is one of the two likelier in a definition?
        below = min(slip.cost for slip in own[off[0].label]) - _NO_DOUBT
        likelier = partial(Definitions.with_one_more, below=below)
        either = _with_more(case, every, some, written, likelier)
        several = either if sum(found[0].cost for found in either) < below else []
    per_entry = several or [*([one] for one in defined), *_per_entry(case, off, written, few)]
    if not all(per_entry) and isinstance(reference_of(case), Derivation):
        per_entry = _with_more(case, every, open_, written, Definitions.with_two_more) or per_entry
    if not all(per_entry):
        return [], tuple(found[0].sentence for found in per_entry if found)
    # alternatives are told for one entry at a time; all of all would be a flood
    if sum(len(found[0].kinds) for found in per_entry) > _FLOOD:
        return [], tuple(found[0].sentence for found in per_entry)
    sets = product(*per_entry) if len(per_entry) == 1 else [tuple(f[0] for f in per_entry)]
    return [slip_cause(chosen) for chosen in sets], ()


def _mistyped(case: Case, off: list[AnswerEntry], written: dict[str, Written]) -> Slip | None:
    """A number of the writer's that none of the arm's is, with one of which more is right.

    ``b = 0.6`` beside l1 = 0.5; of an arm's numbers and what is made of them.
    """
    if any(entry.label not in written for entry in off):
        return None
    texts = [written[entry.label] for entry in off]
    given = {x: meant for text in texts for x, meant in text.symbols.items() if x not in text.known}
    typed = {name: value for name, meant in given.items() if (value := _as_number(meant))}
    if not typed:
        return None
    here = _numbers_here(case)
    known, found = Meanings.at(here), list[tuple[int, str, float]]()
    for name, value in typed.items():
        if known.parameter(abs(value)) is not None:
            continue  # a number of the arm's, though it may be another that is meant
        solved = (_solved(one, written[one.label], name, value, here) for one in off[:_PATIENCE])
        for number in dict.fromkeys(solved):
            own = known.parameter(abs(number)) is not None
            several = len(off) > 1 or not known.product(abs(value))
            made_of = known.product(abs(number)) and several
            if number * value > 0 and (own or made_of):
                left = len(_still_off(case, off, _with_number(written, name, number)))
                found += [(left, name, number)] if left < len(off) else []
    left, name, number = min(found, default=(0, "", 0.0))
    if sum(one[0] == left for one in found) != 1:
        return None
    values = _with_number(written, name, number)[off[0].label].values(here)
    error = off[0].error(values, off[0].engine) if not left else 0.0
    return _of_name(name, given[name], f"{number:.10g}", "number", values, error)


def _of_name(name: str, old: str, new: str, kind: str, values: Array, error: float) -> Slip:
    """A slip in what a name is set to."""
    told = _("{old} should be {new}").format(old=old, new=new)
    said = _("{entry}: {slip} ({kind})").format(entry=name, slip=told, kind=_(kind))
    return Slip(name, (kind,), said, new, 1.0, values, True, error=error, defined=(name, new))


def _misnamed(case: Case, off: list[AnswerEntry], written: dict[str, Written]) -> Slip | None:
    """A name that is set to another of the arm's than it is called: ``lc3 = l3``, l2 = 0.325 where
    that is l1, and the rate of a link that is a joint's alone, ``omega = qd2``."""
    if any(entry.label not in written for entry in off):
        return None
    here = _numbers_here(case)
    for name, (old, new, kind) in _called_otherwise(case, off, written).items():
        put = {label: _renamed(text, name, new) for label, text in written.items()}
        if not _still_off(case, off, put):
            values = put[off[0].label].values(here)
            return _of_name(name, old, new, kind, values, off[0].error(values, off[0].engine))
    return None


def _renamed(text: Written, name: str, new: str) -> Written:
    """A text with another meaning of one of its names, which is no number's of the arm any more."""
    known = {word: node for word, node in text.known.items() if word != name}
    return replace(text, symbols={**text.symbols, name: new}, known=known)


def _called_otherwise(
    case: Case, off: list[AnswerEntry], written: dict[str, Written]
) -> dict[str, tuple[str, str, str]]:
    """Names, each with what it is set to, what it is rather, and what kind of slip that is."""
    found: dict[str, tuple[str, str, str]] = {}
    for text in (written[entry.label] for entry in off[:_PATIENCE]):
        for name, meant in text.symbols.items():
            alone = str(canonical(meant).value) if meant.isidentifier() else ""
            own, other = _number_of(case, name), _as_number(meant) or _number_of(case, meant)
            if own and other and abs(own - other) > TOLERANCES.formula_agrees * abs(own):
                half = alone and other == 2 * own
                new = f"{meant}/2" if half else f"{own:.10g}" if _as_number(meant) else name
                found[name] = (meant, new, "factor" if half else "number")
            elif rate := re.fullmatch(r"qd(\d+)", alone):
                others = [meant.replace(rate[1], str(k + 1)) for k in range(int(rate[1]))]
                found[name] = (meant, " + ".join(others), "missing term")
    return {name: one for name, one in found.items() if one[1] not in (name, one[0])}


def _solved(
    entry: AnswerEntry, text: Written, name: str, value: float, here: dict[str, Array]
) -> float:
    """The number with which a text is right at the state at which it does most; 0 of none."""
    number = value
    for _turn in range(_TURNS):
        at = [
            _with_number({"": text}, name, x)[""].values(here)
            for x in (number, number * (1 + _SHARE))
        ]
        slope = (at[1] - at[0]) / (number * _SHARE)
        k = int(np.argmax(np.abs(slope)))
        if not np.isfinite(slope[k]) or not slope[k]:
            return 0.0
        number += float((entry.engine[k] - at[0][k]) / slope[k])
        if not number or not np.isfinite(number):
            return 0.0
    return float(f"{number:.10g}")


def _with_number(written: dict[str, Written], name: str, number: float) -> dict[str, Written]:
    """The texts with another number for one of the writer's names."""
    return {label: _renamed(text, name, repr(number)) for label, text in written.items()}


def _as_number(text: str) -> float:
    """The number that a text is; 0 of what is none."""
    try:
        return float(text)
    except ValueError:
        return 0.0


def _per_entry(
    case: Case,
    off: list[AnswerEntry],
    written: dict[str, Written],
    tried: Collection[str] = (),
) -> list[list[Slip]]:
    """What explains each entry, as long as most are explained.

    Args:
        case: the states.
        off: the entries.
        written: the texts.
        tried: entries that one or two slips of their own do not explain.
    """
    per_entry: list[list[Slip]] = []
    seen: list[Written] = []
    for entry in off:
        text = written.get(entry.label)
        if text is not None:
            if any(text is other for other in seen):
                continue  # the mirror image of an entry that is given once
            seen.append(text)
        found = of_entry(case, entry, text, least=1 + _PAIR * (entry.label in tried))
        if not found and text is not None and (opened := text.opened()) is not text:
            found = of_entry(case, entry, opened)
        # all repairs of a text give one formula: the likeliest is told
        per_entry.append(_varied(found)[: 1 if text is not None else _TIED])
        told = sum(len(found[0].kinds) for found in per_entry if found)
        missed = sum(not found for found in per_entry)
        if missed >= _PATIENCE or (not written and (missed or told > _FLOOD)):
            break
    return per_entry


def _defined(
    case: Case,
    every: list[AnswerEntry],
    off: list[AnswerEntry],
    definitions: list[tuple[AnswerEntry, Definitions]],
    written: dict[str, Written],
) -> Slip | None:
    """A slip in a definition that makes more right than one in a formula would.

    None that a right formula uses, and none that makes wrong what another one has made right:
    ``every`` are the entries that were off at first.
    """
    found: list[tuple[int, Slip]] = []
    told = set[str]()

    @cache
    def alone(entry: AnswerEntry) -> list[Slip]:
        return of_entry(case, entry, written[entry.label], 1)

    for entry, some in definitions:
        for slip in some.single() if entry.label not in told else ():
            left = _still_off(case, every, _defined_otherwise(case, written, slip))
            if len(left) >= len(off):
                continue
            # of what is right by one change of a definition, only one of the formula is as simple
            simpler = len(left) < len(off) - 1 or _is_simpler(slip, alone(entry), some.line)
            if simpler or _means_the_arm_s(case, entry, written, slip):
                slip = slip.with_error(entry.error(slip.values, entry.engine))
                found.append((len(left), slip))
                told.add(entry.label)
    return (
        min(found, key=lambda one: (one[0], not _as_called(one[1]), one[1].cost))[1]
        if found
        else None
    )


def _as_called(slip: Slip) -> bool:
    """Whether a name becomes what it is called: c12 the cosine of q1 + q2."""
    assert slip.defined is not None
    name, new = slip.defined
    called = canonical(name)
    return called.op in ("sin", "cos") and parse(new) == called


def _with_more(
    case: Case,
    every: list[AnswerEntry],
    off: list[tuple[AnswerEntry, Definitions]],
    written: dict[str, Written],
    looked_for: Callable[[Definitions], Iterable[tuple[Slip, ...]]],
) -> list[list[Slip]]:
    """Slips in definitions with which few more explain each entry; none if there are none.

    Args:
        case: the states.
        every: the entries that were off at first.
        off: those that one or two slips of their own do not explain, with their definitions.
        written: the texts.
        looked_for: how the slips in definitions are found.
    """
    for entry, some in off:
        for slips in looked_for(some):
            changed = written
            for slip in slips:
                changed = _defined_otherwise(case, changed, slip)
            left, further = _still_off(case, every, changed), list[list[Slip]]()
            while left and len(further) < LIST:
                again = [*_definitions(case, every, left, changed)]
                one = _defined(case, every, left, again, changed)
                if one is None:
                    break
                further.append([one])
                changed = _defined_otherwise(case, changed, one)
                left = _still_off(case, every, changed)
            more = [*further, *_per_entry(case, left, changed)]
            if all(more):
                told = [slip.with_error(0.0) for slip in slips[:-1]]
                last = slips[-1]
                known = not left and not further
                error = entry.error(last.values, entry.engine) if known else 0.0
                return [*([one] for one in told), [last.with_error(error)], *more]
    return []


def _definitions(
    case: Case, every: list[AnswerEntry], off: list[AnswerEntry], written: dict[str, Written]
) -> Iterator[tuple[AnswerEntry, Definitions]]:
    """The names of a writer's in what is off, of a few entries, those with the fewest names first.

    Without names that a right formula uses, and those that stand for what books call so.
    """
    derived = reference_of(case)
    if derived is None or any(entry.label not in written for entry in off):
        return
    wrong = {entry.label for entry in every}
    named = isinstance(derived, Derivation) and any(x.definitions for x in written.values())
    whole = case.engine(case.robot, case.arguments) if named else np.zeros(0)
    sound = {x for label, text in written.items() if label not in wrong for x in text.definitions}
    plainest = sorted(off, key=lambda entry: len(written[entry.label].definitions))
    for entry in plainest[:_PATIENCE]:
        text, elsewhere = _as_read(case, entry, written[entry.label], derived)
        of = (derived, derived.entry(entry.index), case.quantity.arguments, case.arguments)
        here = derived.environment(case.arguments)
        for line, told in terms.lines_apart(text, *of, elsewhere) if text.definitions else ():
            names = [name for name in line.text.definitions if name not in sound]
            if isinstance(derived, Derivation):
                names = [x for x in names if not stands_so(line.text, x, derived.arm.words)]
                names = [x for x in names if not _is_a_moment_so(case, told, x)]
                names = [x for x in names if not _is_an_entry(case, told, x, whole)]
            if names:
                yield entry, Definitions(line, told, here, names)


def _is_a_moment_so(case: Case, text: Written, name: str) -> bool:
    """Whether a moment of inertia is the arm's as it is explained: I of ``I = m*l^2/12``."""
    number = _number_of(case, name) or _number_of(case, f"{name}1")
    if name[0] != "I" or not number:
        return False
    try:
        value = text.definition(name).values(_numbers_here(case))
    except (KinlabError, KeyError):
        return False
    return bool(np.max(np.abs(value - number)) <= TOLERANCES.formula_agrees * abs(number))


def _is_an_entry(case: Case, text: Written, name: str, whole: Array) -> bool:
    """Whether a name is explained as what some entry is: M22 of ``M12 = M22 + ...``.

    A number of the arm's is none: ``I2 = m2*l2^2/3`` is a slip, though M22 is that.
    """
    if _number_of(case, name):
        return False
    entries = whole.reshape(len(whole), -1).T
    try:
        value = np.broadcast_to(text.definition(name).values(_numbers_here(case)), len(whole))
    except (KinlabError, KeyError):
        return False
    near = TOLERANCES.formula_agrees * np.abs(entries).max(axis=1, initial=0.0)
    return bool(np.any((np.abs(entries - value).max(axis=1, initial=0.0) <= near) & (near > 0)))


def _as_read(
    case: Case, entry: AnswerEntry, text: Written, derived: Reference
) -> tuple[Written, FreeCentres | None]:
    """A text with equal numbers of the arm's by their names, and the same of free centres."""
    poly = derived.entry(entry.index)
    if not isinstance(derived, Derivation) or not searchable(poly):
        return text, None
    text = by_equal_numbers(text, derived, poly)
    return text, apart(case, entry, text, poly)


def _is_simpler(slip: Slip, others: list[Slip], line: Line) -> bool:
    """Whether a slip in a definition says in fewer words what is wrong than others of the line.

    Of as many words the likelier; a factor that a name lacks was lost where the name was set, and
    what would come instead of its sine, or of itself, is what it should be. A formula that is only
    a name lacks nothing itself; a half is lost where the numbers of the arm stand: in h, and not
    in ``h*(qd1 + qd2)``.
    """
    assert slip.defined is not None
    name, new = slip.defined
    lost = {*words_in(new)} - {*words_in(line.text.symbols[name])}
    of_name = not any(map(line.turns, lost))
    whole = line.text.text == name
    lacks = slip.kinds == (_MISSING,) and _lacks(slip, line)
    halved = slip.kinds == (_FACTOR,) and _numbers(new) > _numbers(line.text.symbols[name])
    typed = _numbers(line.text.text)

    def beaten(one: Slip) -> bool:
        if len(slip.kinds) == len(one.kinds):
            if lacks and one.kinds == (_MISSING,):
                return True
            if whole and one.kinds in (("missing term",), (_FACTOR,)):
                return True
            old = {*words_in(one.replaced[0])} - _FUNCTIONS if one.replaced else set()
            if halved and one.kinds in ((_FACTOR,), ("extra factor",)):
                left = _numbers(one.corrected)
                if left < typed:
                    return False  # of -2*h the 2 that does not belong, and not h/2
                half = _HALF.search(new) and not _HALF.search(line.text.symbols[name])
                if half and left > typed and name in old:
                    return old.isdisjoint(line.names.parameters) or slip.cost < one.cost
            both = slip.kinds == one.kinds == (_LOST,) and of_name
            itself = old == {name} and one.kinds != ("sign",)
            return both or itself or slip.cost < one.cost
        return len(slip.kinds) < len(one.kinds)

    return all(map(beaten, others))


def _numbers(text: str) -> int:
    """How many numbers are typed in a formula."""
    return len(_NUMBER.findall(text))


def _lacks(slip: Slip, line: Line) -> bool:
    """Whether a term that is missing is a name's: I1 of d11, which is multiplied by qdd1.

    Of a name that stands alone its terms have something in common, and so has the missing one: g.
    """
    assert slip.defined is not None
    name, new = slip.defined
    old = parse(line.text.symbols[name]).terms
    beside = [x.factors for x in parse(line.text.text).terms if name in tree.names(x)]
    if len(beside) != 1:
        return False
    others = {word for one in beside[0] for word in tree.names(one)} - {name}
    moving = {word for one in others for word in tree.names(line.meaning(one))}
    if any(map(_RATE.fullmatch, moving)):
        return True
    common = set[str].intersection(*({*tree.names(one)} for one in old))
    added = [one for one in parse(new).terms if one not in old]
    return bool(common) and any(common <= {*tree.names(one)} for one in added)


def _means_the_arm_s(
    case: Case, entry: AnswerEntry, written: dict[str, Written], slip: Slip
) -> bool:
    """Whether a definition of a name of the arm's, I3, is the arm's only with a slip repaired."""
    assert slip.defined is not None
    name = slip.defined[0]
    own = _number_of(case, name)
    if not own:
        return False
    here = _numbers_here(case)
    texts = (written, _defined_otherwise(case, written, slip))
    try:
        old, new = (one[entry.label].definition(name).values(here) for one in texts)
    except (KinlabError, KeyError):
        return False
    near = TOLERANCES.formula_agrees * abs(own)
    return bool(np.max(np.abs(new - own)) <= near < np.max(np.abs(old - own)))


def _number_of(case: Case, name: str) -> float:
    """The number of the arm's by its name, or by one that books have for it: lc2; else 0."""
    derived, table = reference_of(case), table_of(case.robot)
    values = {} if derived is None else derived.values
    if name not in values and table is not None:
        words = vocabulary(table)
        return float(sum(x * words.values[word] for x, word in words.others.get(name, ())))
    return float(values.get(name, 0.0))


def _defined_otherwise(case: Case, written: dict[str, Written], slip: Slip) -> dict[str, Written]:
    """The texts with another definition of one of the writer's names.

    With it come the names that books have for what is in it: lc3 for l3/2.
    """
    assert slip.defined is not None
    name, new = slip.defined
    table = table_of(case.robot)
    meant = {} if table is None else vocabulary(table).others
    books = {word: as_text(total) for word in words_in(new) if (total := meant.get(word))}
    more = {word: told for word, told in books.items() if told != word}
    return {
        label: replace(_renamed(text, name, new), symbols={**more, **text.symbols, name: new})
        for label, text in written.items()
    }


def _still_off(
    case: Case, off: list[AnswerEntry], written: dict[str, Written]
) -> list[AnswerEntry]:
    """The entries that are off all the same."""
    here = _numbers_here(case)
    now = [(one, written[one.label].values(here)) for one in off]
    left = [replace(one, hand=hand) for one, hand in now]
    return [one for one in left if not one.agrees]


def _numbers_here(case: Case) -> dict[str, Array]:
    """What all names stand for at each state, shares of lengths too: lc1 of a rod."""
    here, table = numbers_at(case), table_of(case.robot)
    size = len(next(iter(case.arguments.values())))
    for name in vocabulary(table).others if table is not None else ():
        here.setdefault(name, np.full(size, _number_of(case, name)))
    return here


def _varied(found: list[Slip]) -> list[Slip]:
    """The cheapest of each combination of kinds: places that are equal by value say no more."""
    kinds: dict[tuple[str, ...], Slip] = {}
    for slip in sorted(found, key=lambda s: s.cost):
        kinds.setdefault(tuple(sorted(slip.kinds)), slip)
    return list(kinds.values())[:_TIED]


def slip_cause(slips: tuple[Slip, ...]) -> Cause:
    return Cause(
        _("; ").join(s.sentence for s in slips),
        tuple(k for s in slips for k in s.kinds),
        tuple(s.entry for s in slips),
        max(s.error for s in slips),
        sum(s.cost for s in slips),
        {s.entry: s.corrected for s in slips if s.corrected},
        {s.entry: s.typed for s in slips if s.typed},
    )


def of_entry(
    case: Case, entry: AnswerEntry, text: Written | None, most: int = LIST, least: int = 1
) -> list[Slip]:
    """What explains one entry.

    Args:
        case: the states.
        entry: the entry.
        text: it as it was written, of a text.
        most, least: slips of a text that are looked for.
    """
    derived = reference_of(case)
    if derived is None or (text is None and not isinstance(derived, Derivation)):
        slip = terms.turned(text) if text is not None else None
        error = entry.error(-entry.hand, entry.engine)
        return [slip.with_error(error)] if slip and error <= TOLERANCES.formula_agrees else []
    poly = derived.entry(entry.index)
    arguments = case.quantity.arguments
    if text is not None or not isinstance(derived, Derivation):
        assert text is not None
        text, elsewhere = _as_read(case, entry, text, derived)
        of = (derived, poly, arguments, case.arguments)
        found = terms.in_text(entry.label, text, *of, elsewhere, most, least)
    else:
        others = [derived.tree(p) for p in derived.polys.flat if len(p) < 200]
        of = (derived, poly, arguments, case.arguments)
        found = terms.in_function(entry.label, entry.hand, entry.engine, *of, others[:12])
    good = []
    for slip in found:
        left = entry.engine if slip.repaired else entry.hand
        error = entry.error(slip.values, left)
        if error <= TOLERANCES.formula_agrees:
            good.append(slip.with_error(error))
    if not good and text is not None:
        error = entry.error(np.zeros_like(entry.engine), entry.engine)
        if error <= TOLERANCES.formula_agrees:
            good.append(terms.nothing(text, entry.engine).with_error(error))
    return good


def reading_and_slips(case: Case, tried: list[Confusion], engine: Array) -> Iterator[Cause]:
    """A whole-answer reading undone, and slips in what is left."""
    before = sum(not e.agrees for e in entries(case, engine))
    for reading in tried:
        if reading.stage != "answer" or reading.kind not in _UNDONE or case.index:
            continue
        try:
            undone = reading.apply(case.hand)
        except np.linalg.LinAlgError:
            continue  # an answer without an inverse is no inverse
        if undone.shape != engine.shape:
            continue
        if reading.kind == "factor":
            undone = case.hand * (case.hand / np.where(undone, undone, 1.0))
        changed = replace(case, hand=undone, again=None)
        off = [e for e in entries(changed, engine) if not e.agrees]
        if len(off) >= max(before, 2) or len(off) > RIVALS:
            continue
        if np.max(relative_errors(undone, engine)) >= np.max(relative_errors(case.hand, engine)):
            continue  # what undoes a slip brings the answer nearer
        for cause in slips_in(changed, off, {})[0]:
            if len(cause.kinds) > LIST:
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
