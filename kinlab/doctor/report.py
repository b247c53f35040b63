"""Diagnoses by every door: of a function, a text, a file, a row of a report, typeset and marked."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from kinlab.arrays import Array, seed_of, whole
from kinlab.check.catalogue import Row
from kinlab.check.compare import need_function
from kinlab.check.diagnosis import ENTRY_LETTERS, Cause, Diagnosis, Typeset, shown_entry
from kinlab.check.guest import GuestFunction
from kinlab.check.quantities.identity import IDENTITY
from kinlab.check.quantities.registry import quantities, split_name
from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.check.targets import PlannedRow
from kinlab.check.unread import Unread
from kinlab.doctor.changes import Case, Mechanism, label_of
from kinlab.doctor.derived import derivation
from kinlab.doctor.examine import examine, prepare, real
from kinlab.doctor.file import (
    as_judged,
    examine_formulas,
    of_robot,
    read_formulas,
    refuse_unjudged,
    require_sound,
    require_whole,
    robot_of,
    twice,
)
from kinlab.doctor.linkages.as_right import times
from kinlab.doctor.linkages.mechanisms import mechanism
from kinlab.doctor.program.elsewhere import lines_elsewhere
from kinlab.doctor.program.words import lines
from kinlab.doctor.text.claims import VECTORS, claimed_of, whole_of
from kinlab.doctor.text.claims import alone as alone_of
from kinlab.errors import ExpressionError, KinlabError
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.files import FormulaFile, alone, entries_of, with_entries
from kinlab.formulas.marks import differences
from kinlab.formulas.record import AnswerShapeError, function_name, state_by_state
from kinlab.formulas.text import SHORTHAND, joint_spelling, parse, respelled
from kinlab.formulas.tree import Node
from kinlab.formulas.tree import Path as Way
from kinlab.formulas.typeset import Marks, equation
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

FEWEST = 10
"""States that a diagnosis needs at least."""
_NONE: frozenset[Way] = frozenset()
_SHORT = 40
"""Terms up to which a derived formula is worth showing."""


def diagnose(
    robot: Any, quantity: str, function: Callable[..., Any] | str, samples: int = 200, seed: int = 0
) -> Diagnosis:
    """Says whether a hand-derived formula is what it claims to be, and if not, what is wrong.

    Args:
        robot: a Robot, DHTable, FiveBar, name or path.
        quantity: what the formula claims to be, such as ``"inverse_dynamics"``, or a book's name of
            an entry, ``"tau2"``; an index picks entries: ``"inverse_dynamics[0]"``.
        function: a function of one state, the quantity's arguments in order: ``f(q, v, a)``; or the
            formula as text, LaTeX, MATLAB or Python.
        samples: how many random states must be explained.
        seed: the same seed gives the same states.

    Returns:
        The diagnosis. A cause is named only if it accounts for every state to 1e-9, or to what the
        finite differences of a function leave.

    Raises:
        NameUnknownError: no such robot or quantity.
        OptionError: samples below 10.
        ExpressionError: a text that is no formula.
        FormulaError: the function failed.
    """
    if isinstance(function, str):
        arm = mechanism(robot)
        document = {"robot": arm.name, "formulas": {_asked_of(arm, quantity): function}}
        file = of_robot(document, "formula", arm)
        require_whole(as_judged(file, arm), arm)
        judged = examine_formulas(file, arm, whole(samples, "samples", FEWEST), seed_of(seed))
        refuse_unjudged(judged)
        wrong = [one for one in judged if not one.agrees]
        found = _of_all(wrong) if wrong else _all_right(judged)
        lacking = _not_given(arm, quantity, file)
        said = _("not given, and not judged: {entries}").format(entries=", ".join(lacking))
        return replace(found, remarks=(*found.remarks, said)) if lacking else found
    need_function(function)
    plain, index = split_name(quantity if "[" in quantity else _in_full(quantity, robot))
    case, engine = prepare(robot, plain, index, samples, seed)
    stacked = state_by_state(case.quantity.asked(case.robot, function))
    case = replace(
        case,
        again=lambda states: real(stacked(None, *states.values())),
        lines=partial(lines, function),
    )
    hand = np.asarray(stacked(None, *case.arguments.values()))
    return _of_answers(case, hand, engine, quantity, function_name(function))


def _not_given(arm: Mechanism, quantity: str, file: FormulaFile) -> list[str]:
    """The entries of a whole that its formulas, which are named one by one, do not give.

    What is zero everywhere need not be given, nor of M what stands across the diagonal.
    """
    if isinstance(arm, FiveBar) or file.matrices:
        return []
    wanted = quantity if quantity in quantities() else whole_of(quantity, arm.table)
    try:
        places = [split_name(claimed_of(entry, arm)) for entry in file.formulas]
    except ExpressionError:
        return []
    given = {index for plain, index in places if plain == wanted and index}
    if not given or len(given) < len(places):
        return []
    engine = prepare(arm, wanted, (), FEWEST, 0)[1]
    there = {
        (*map(int, place),)
        for place in np.argwhere(np.max(np.abs(engine), axis=0) > TOLERANCES.vanishes)
    }
    across = {place[::-1] for place in given} if wanted == "mass_matrix" else set()
    left = sorted(there - given - across)
    return [shown_entry(f"{wanted}[{','.join(map(str, place))}]") for place in left]


def _of_answers(case: Case, hand: Array, engine: Array, quantity: str, name: str) -> Diagnosis:
    """A function, judged by its answers; a five-bar's equation may be multiplied by a factor."""
    same = times(case, hand, engine) if isinstance(case.robot, FiveBar) else None
    if same is None:
        return examine(case, hand, engine, quantity, name, {})
    found = examine(case, same[0], engine, quantity, name, {})
    return replace(found, form="unusual", remarks=(*found.remarks, same[1]))


def _all_right(judged: list[Diagnosis]) -> Diagnosis:
    """Entries that are right, judged each for itself, told together: as the least right of them."""
    first = max(judged, key=lambda one: (bool(one.form), one.error_before))
    if len(judged) == 1:
        return first
    return replace(
        first,
        function=", ".join(one.function for one in judged),
        quantity=split_name(first.quantity)[0],
        remarks=tuple(dict.fromkeys(said for one in judged for said in one.remarks)),
    )


def _of_all(wrong: list[Diagnosis]) -> Diagnosis:
    """What is wrong in entries that are judged each for itself, told together."""
    unknown = [one for one in wrong if not one.causes]
    first = (unknown or wrong)[0]
    if len(wrong) == 1:
        return first
    told = [one.causes[0] for one in wrong if one.causes]
    sentence = _("; ").join(dict.fromkeys(cause.sentence for cause in told))
    both = replace(
        first,
        function=", ".join(one.function for one in wrong),
        quantity=split_name(first.quantity)[0],
        error_before=max(one.error_before for one in wrong),
    )
    if unknown:
        return replace(both, partial=(*first.partial, *([sentence] if told else [])))
    cause = Cause(
        sentence,
        tuple(kind for one in told for kind in one.kinds),
        tuple(place for one in told for place in one.places),
        max(one.error_after for one in told),
        sum(one.cost for one in told),
        {name: text for one in told for name, text in one.corrected.items()},
        {name: text for one in told for name, text in one.typed.items()},
    )
    return replace(both, causes=(cause,))


def _asked_of(arm: Any, quantity: str) -> str:
    """What is asked of an arm of one joint: of a vector, and of the centres, its only one."""
    if isinstance(arm, FiveBar) or arm.n != 1:
        return quantity
    if quantity in VECTORS:
        return alone_of(quantity)
    if quantity == "com_positions":
        return f"{quantity}[0]"
    matrix = quantity.endswith("_matrix[0,0]")  # M = ... is its only entry
    return quantity.partition("[")[0] if matrix else quantity


def _in_full(quantity: str, robot: Any) -> str:
    """The quantity that a book's name stands for: ``tau2`` is ``inverse_dynamics[1]``."""
    if quantity in quantities():
        return quantity
    try:
        return claimed_of(quantity, mechanism(robot))
    except ExpressionError:
        return quantity  # refused with the names that there are


def of_file(file: FormulaFile, samples: int = 200, seed: int = 0) -> list[Diagnosis]:
    """Judges a file of formulas; see :func:`kinlab.doctor.file.examine_formulas`.

    Args:
        file: the formulas.
        samples, seed: the states; at least :data:`FEWEST` are taken.

    Raises:
        FileError, ExpressionError, NameUnknownError: what cannot be used, with its place.
    """
    robot = robot_of(file)
    file = as_judged(file, robot)
    require_whole(file, robot)
    judged = examine_formulas(file, robot, max(samples, FEWEST), seed)
    return [_of_text(diagnosis, file, robot) for diagnosis in judged]


def of_document(
    document: Mapping[str, Any],
    path: str,
    samples: int = 200,
    seed: int = 0,
    problems: Sequence[tuple[str, KinlabError]] = (),
) -> tuple[list[Diagnosis], list[Unread]]:
    """Judges a TOML document of formulas, and goes on without the entries that cannot be read.

    Args:
        document: as :func:`kinlab.formulas.files.formula_file` has it.
        path: the file.
        samples, seed: as for :func:`of_file`.
        problems: lines that could not be read, from :func:`kinlab.formulas.lines.read_lines`.

    Returns:
        The diagnoses; and the entries, or the file, that could not be judged.
    """
    unread = [Unread(f"{path}: {key}" if key else path, problem) for key, problem in problems]
    judged: list[Diagnosis] = []
    if not unread or (entries_of(document) and "robot" in document):
        judged, more = _of_sound(document, path, samples, seed)
        unread += more
    return judged, unread


def _of_sound(
    document: Mapping[str, Any], path: str, samples: int, seed: int
) -> tuple[list[Diagnosis], list[Unread]]:
    try:
        return _judged(of_file(read_formulas(document, path), samples, seed), path)
    except KinlabError as problem:
        lost = Unread(path, problem)
    bad: list[Unread] = []
    judged: list[Diagnosis] = []
    left = document
    claimed: dict[str, str] = {}
    for entry in entries_of(document):
        try:
            one = read_formulas(alone(document, entry), path)
            try:
                robot = robot_of(one)
            except KinlabError as missing:
                return [], [Unread(path, missing)]
            places = require_sound(one, robot)
            again = [label for label, name in places.items() if claimed.get(label, name) != name]
            if again:
                said = twice(places[again[0]], claimed[again[0]])
                raise ExpressionError(f"{path}: {said}")
            claimed |= places
            if not one.whole:
                continue
            some, more = _judged(of_file(one, samples, seed), path)
            judged += some
            bad += more
        except KinlabError as problem:
            bad.append(Unread(f"{path}: {entry}", problem))
        left = with_entries(left, set(entries_of(left)) - {entry})
    if not entries_of(left):
        return judged, bad if judged or len(bad) > 1 else [lost]
    if left is document:
        return [], [lost]
    try:
        others, more = _judged(of_file(read_formulas(left, path), samples, seed), path)
        return [*judged, *others], [*bad, *more]
    except KinlabError as problem:
        return judged, [*bad, Unread(path, problem)]


def _judged(found: list[Diagnosis], path: str) -> tuple[list[Diagnosis], list[Unread]]:
    """What was judged, and what was not for the words beside it."""
    unread = [one for one in found if one.form == "words"]
    lost = [Unread(f"{path}: {one.function}", ExpressionError(one.reason)) for one in unread]
    return [one for one in found if one.form != "words"], lost


def of_task(task: PlannedRow, samples: int = 200, seed: int = 0) -> Row | Diagnosis:
    """Runs one row, and looks for what is wrong where it is a user's formula that differs.

    Args:
        task: from :func:`kinlab.check.targets.tasks`.
        samples, seed: the states.

    Returns:
        The row, with its diagnosis; the diagnosis alone where the answer has the wrong shape, so
        that nothing can be compared, and the doctor knows why.

    Raises:
        KinlabError: as :func:`kinlab.compare`.
    """
    asked = find_quantity(task.record.quantity).domain is not IDENTITY
    try:
        row = task.run(samples, seed)
    except AnswerShapeError:
        found = _of_function(task, samples, seed) if task.file and asked else None
        if found is None or not found.known:
            raise
        return found
    if row.corrected.agrees or row.failure or not task.file or not asked:
        return row
    return Row(
        row.formula, row.robot, row.corrected, row.printed, _of_function(task, samples, seed)
    )


def _of_function(task: PlannedRow, samples: int, seed: int) -> Diagnosis:
    record = task.record
    plain, index = split_name(record.quantity)
    case, engine = prepare(task.robot, plain, index, max(samples, FEWEST), seed)
    numbers = case.quantity.domain.numbers(case.robot)
    hand = record.function(numbers, *(np.array(s) for s in case.arguments.values()))
    if isinstance(record.function, GuestFunction):
        case = replace(case, lines=partial(lines_elsewhere, record.function.ask))
    found = _of_answers(case, hand, engine, record.quantity, record.id)
    right = _corrected(found)
    corrected = tuple(equation(_name(label), parse(text)) for label, text in right.items())
    return replace(found, source=task.file, corrected=corrected)


def _of_text(found: Diagnosis, file: FormulaFile, robot: Mechanism) -> Diagnosis:
    pointed = _corrected(found)
    right = pointed or _derived(found, robot)
    given: list[Typeset] = []
    corrected: list[Typeset] = []
    for entry, label in _entries(found, file, robot):
        written = file.formulas[entry]
        text = right.get(entry) or right.get(label)
        if text is None:
            given.append(equation(entry, written))
            continue
        formula = parse(text) if pointed else _as_written(parse(text), file, robot)
        wrong, fixed = differences(written, formula, {}) if pointed else (_NONE, _NONE)
        given.append(equation(entry, written, Marks("wrong", wrong)))
        corrected.append(equation(entry, formula, Marks("fixed", fixed)))
    return replace(found, source=file.path, given=tuple(given), corrected=tuple(corrected))


def _as_written(formula: Node, file: FormulaFile, robot: Mechanism) -> Node:
    """A derived formula in the notation of the file: c12 where it has c12, th1 where th1."""
    nodes = [one for written in file.formulas.values() for _, one in tree.nodes(written)]
    words = [str(one.value) for one in nodes if one.op == "sym"]
    waves = any(one.op in ("sin", "cos") for one in nodes)
    count = 2 if isinstance(robot, FiveBar) else robot.n
    short = not waves and any(SHORTHAND.fullmatch(word) for word in words)
    return respelled(formula, joint_spelling(words, count), short)


def _corrected(found: Diagnosis) -> dict[str, str]:
    """The right formulas of the first cause that has them: all causes mean the same formula."""
    return next((cause.corrected for cause in found.causes if cause.corrected), {})


def _derived(found: Diagnosis, robot: Mechanism) -> dict[str, str]:
    """The derived formulas, where no cause points at single terms."""
    if found.agrees or isinstance(robot, FiveBar) or robot.table is None:
        return {}
    plain, index = split_name(found.quantity)
    derived = derivation(robot.table, plain)
    if derived is None:
        return {}
    shape = np.shape(derived.polys)
    places = [tuple(index)] if index or not shape else list(np.ndindex(shape))
    right = {}
    for place in places:
        poly = derived.entry(place)
        if len(poly) <= _SHORT:
            right[label_of(plain, place)] = str(derived.collected(poly))
    return right


def _entries(found: Diagnosis, file: FormulaFile, robot: Mechanism) -> Iterator[tuple[str, str]]:
    """The file's entries that a diagnosis is about, with the places they claim."""
    for entry in file.formulas:
        plain, index = split_name(claimed_of(entry, robot))
        label = label_of(plain, index)
        if found.quantity in (plain, label):
            yield entry, label


def _name(label: str) -> str:
    """What an entry is called where the user gave no name, as one letter with its places."""
    return ENTRY_LETTERS.get(label, shown_entry(label))
