"""One answer judged: verdict, points, and as much of the reason as the sheet's feedback allows."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

from kinlab.arrays import Array
from kinlab.check.diagnosis import ENTRY_LETTERS, Cause, Diagnosis, shown_entry
from kinlab.check.quantities.registry import split_name
from kinlab.doctor.changes import Mechanism, label_of
from kinlab.doctor.derivations.words import together
from kinlab.doctor.examine import examine, prepare
from kinlab.doctor.excuses import only_for
from kinlab.doctor.file import as_judged, examine_formulas, refuse_unjudged, with_names
from kinlab.doctor.glossary.facts import holding
from kinlab.doctor.linkages import five_bar
from kinlab.doctor.linkages.named_numbers import named_numbers
from kinlab.doctor.marking.marks import (
    Outcome,
    failed,
    lost,
    missing,
    points_left,
    right_outcome,
    wrong_outcome,
)
from kinlab.doctor.marking.own_answer import with_answer
from kinlab.doctor.marking.reading.pieces import is_no_answer
from kinlab.doctor.marking.reading.questions import as_entries
from kinlab.doctor.marking.sheet import FEEDBACK, Question, Sheet
from kinlab.doctor.marking.submission import Submission
from kinlab.doctor.marking.variation import robot_for
from kinlab.doctor.marking.words import for_student
from kinlab.doctor.program.words import WrongLines
from kinlab.doctor.shapes import in_full
from kinlab.doctor.text.claims import claimed_of
from kinlab.doctor.text.own_names import in_robot_names
from kinlab.errors import ExpressionError, KinlabError
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.files import FormulaFile, formula_file
from kinlab.formulas.marks import differences
from kinlab.formulas.text import parse
from kinlab.formulas.tree import Node
from kinlab.formulas.typeset import Marks, equation
from kinlab.host.language import N_, _

_WRITTEN = 400
_DECIMALS = re.compile(r"(?<![\w.])\d+\.\d+")


def judge(sheet: Sheet, submission: Submission, feedback: str | None = None) -> list[Outcome]:
    """The outcome of every question of a sheet.

    Args:
        sheet: the sheet.
        submission: what was handed in; a program's answers are judged elsewhere.
        feedback: how much is told; the sheet's own where None.
    """
    level = feedback or sheet.feedback
    return [
        _told(_one(sheet, question, submission), level, _secrets(sheet, question))
        for question in sheet.questions
    ]


def of_values(
    sheet: Sheet,
    question: Question,
    student: str,
    values: Array,
    level: str,
    lines: Callable[..., Iterator[WrongLines]] | None = None,
) -> Outcome:
    """The outcome of a question that a function answered.

    Args:
        sheet, question: what was asked.
        student: whose numbers the robot has.
        values: the function's answers at :func:`states_of`.
        level: of feedback.
        lines: looks for the function's wrong lines, as :class:`kinlab.doctor.changes.Case` has it.
    """
    plain, index = split_name(question.quantity)
    robot = robot_for(sheet, student)
    case, engine = prepare(robot, plain, index, sheet.samples, sheet.seed)
    case = replace(case, lines=lines)
    found = examine(case, values, engine, question.quantity, question.id, {})
    outcome = _of_diagnoses(question, [found], None, robot)
    if values.shape != engine.shape:
        said = _("the answer has the shape {has}, asked is {asked}")
        shapes = {"has": values.shape[1:], "asked": engine.shape[1:]}
        outcome = replace(outcome, remark=said.format(**shapes))
    return _told(outcome, level, _secrets(sheet, question))


def states_of(sheet: Sheet, question: Question, student: str) -> dict[str, Array]:
    """The arguments at which a function is asked, (N, n) each."""
    plain, index = split_name(question.quantity)
    case, _ = prepare(robot_for(sheet, student), plain, index, sheet.samples, sheet.seed)
    return dict(case.arguments)


def _one(sheet: Sheet, question: Question, submission: Submission) -> Outcome:
    given = submission.answers.get(question.id)
    written = tuple(
        (f"{name} = {text}" if name and "=" not in text else text)[:_WRITTEN]
        for name, text in (given or {}).items()
    )
    if question.id in submission.problems:
        return lost(question, submission.problems[question.id], written)
    if not given or all(map(is_no_answer, given.values())):
        return missing(question)
    try:
        entries = as_entries(question, given, sheet)
        document = {"robot": "the sheet's", "symbols": submission.symbols, "formulas": entries}
        holds = holding(robot_for(sheet, submission.student))
        file = formula_file(document, question.id, submission.writing, holds)
        if question.quantity:
            outcome = _with_engine(sheet, question, submission.student, file)
        else:
            outcome = with_answer(sheet, question, submission.student, file)
    except KinlabError as problem:
        return lost(question, _in_own_names(str(problem), given, submission), written)
    except Exception as problem:  # noqa: BLE001  whatever happens costs one answer, not a class
        return failed(question, problem, written)
    return replace(outcome, written=written)


_UNKNOWN = re.compile(r"'([A-Za-z]\w*)'")


def _in_own_names(problem: str, given: Mapping[str, str], submission: Submission) -> str:
    """A problem for its writer; none that begins with a name that nobody typed."""
    own = submission.symbols
    typed = " ".join([*given, *given.values(), *own, *map(str, own.values())])
    plain, named = re.sub(r"[\s_{}\\]", "", typed), _UNKNOWN.search(problem)
    if named and typed.isascii() and named[1].replace("_", "") not in plain:
        return _("it could not be judged; mark it by hand")
    return for_student(problem)


# -------- Beside the engine


def _with_engine(sheet: Sheet, question: Question, student: str, file: FormulaFile) -> Outcome:
    file, own = as_judged(file, sheet.robot), robot_for(sheet, student)
    robot = sheet.robot if own is not sheet.robot and _free_of_numbers(file, sheet, own) else own
    found = _diagnosed(_Key(robot, file), sheet.samples, sheet.seed)
    if robot is not own and all(one.agrees for one in found):
        robot = own  # names only, so it is right with every number; these say so too
        found = _diagnosed(_Key(own, file), sheet.samples, sheet.seed)
    return _of_diagnoses(question, found, file, robot)


def _free_of_numbers(file: FormulaFile, sheet: Sheet, own: Mechanism) -> bool:
    """Whether no number in the formulas could be one of the robot's."""
    values: set[float] = set()
    for robot in (sheet.robot, own):
        values |= {abs(float(value)) for value in named_numbers(robot).values()}
    for node in [*file.formulas.values(), *file.symbols.values()]:
        for _path, part in tree.nodes(node):
            if part.op == "num" and (
                part.value.denominator > 4 or abs(float(part.value)) in values
            ):
                return False
    return True


class _Key:
    """A robot and formulas; equal where all that a diagnosis may quote is, so that a class's same
    answers are one.

    Of two that differ in the words beside a formula each is told his own.
    """

    def __init__(self, robot: Mechanism, file: FormulaFile) -> None:
        self.robot, self.file = robot, file
        self.texts = (id(robot), *map(_all_of, (file, *file.others)))

    def __hash__(self) -> int:
        return hash(self.texts)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and self.texts == other.texts


def _all_of(file: FormulaFile) -> tuple[Any, ...]:
    """What was typed, how it was read, and what was said beside it."""
    read = (
        (name, str(one)) for some in (file.formulas, file.symbols) for name, one in some.items()
    )
    typed = (file.as_typed, file.symbol_texts, file.symbols_typed, file.remarks, file.unread)
    return (*read, *(item for some in typed for item in some.items()))


@lru_cache(maxsize=4096)
def _diagnosed(key: _Key, samples: int, seed: int) -> tuple[Diagnosis, ...]:
    return tuple(examine_formulas(key.file, key.robot, samples, seed))


def _of_diagnoses(
    question: Question, found: Any, file: FormulaFile | None, robot: Mechanism
) -> Outcome:
    asked = [one for one in found if split_name(one.quantity)[0] == question.plain]
    if not asked:
        said = _("{question}: none of the formulas is {entry}")
        raise ExpressionError(said.format(question=question.id, entry=question.entry))
    refuse_unjudged(replace(one, remarks=one.remarks[:1]) for one in asked)  # not what it would be
    whole = "[" not in question.quantity
    if whole and any("[" in one.quantity for one in asked) and not _all_given(asked, file, robot):
        return _in_part(question, asked, file, robot)
    if all(one.agrees for one in asked):
        return _right(question, asked, file)
    return _wrong(question, [one for one in asked if not one.agrees], file, robot)


def _right(question: Question, asked: list[Diagnosis], file: FormulaFile | None) -> Outcome:
    remarks = [told for one in asked for remark in one.remarks if (told := _used(remark, file))]
    remark = _("; ").join(dict.fromkeys(remarks))
    formulas = _as_read(file) if file else ()
    return right_outcome(question, {one.form for one in asked}, formulas, remark)


_NUMBERS = re.compile(r"([A-Za-z]\w*) = (-?\d[\d.e+-]*)")
_MOVES = re.compile(r"(?:q|qd|qdd|th|theta|[cs])\d+")


def _used(remark: str, file: FormulaFile | None) -> str:
    """A remark on numbers of the arm, without those that a formula in names has not."""
    pairs = _NUMBERS.findall(remark)
    if file is None or only_for([f"{name} = {value}" for name, value in pairs]) != [remark]:
        return remark
    whole = [*file.formulas.values(), *file.symbols.values()]
    nodes = [part for node in whole for _path, part in tree.nodes(node)]
    numbers = [abs(float(part.value)) for part in nodes if part.op == "num"]
    names = {str(part.value) for part in nodes if part.op == "sym"}
    if all(_MOVES.fullmatch(name) for name in names):
        return remark
    near = [(n, v) for n, v in pairs if any(abs(x - float(v)) <= 1e-3 * x for x in numbers)]
    return "".join(only_for([f"{name} = {value}" for name, value in near]))


def _as_read(file: FormulaFile) -> tuple[tuple[str, str], ...]:
    return tuple(equation(_named(name), formula) for name, formula in file.formulas.items())


def _all_given(asked: list[Diagnosis], file: FormulaFile | None, robot: Mechanism) -> bool:
    """Whether the entries that are judged one by one are the whole.

    They are of a five-bar where each is there, and of an arm in a matrix that leaves out rows of
    zeros: four rows of a SCARA's Jacobian, a pose in the plane.
    """
    if isinstance(robot, FiveBar):
        return len(asked) == five_bar.entry_count(split_name(asked[0].quantity)[0])
    return file is not None and bool(in_full(file, robot)[1])


def _in_part(
    question: Question, asked: list[Diagnosis], file: FormulaFile | None, robot: Mechanism
) -> Outcome:
    """Some entries of a whole: the rest is no answer."""
    names = ", ".join(one.function for one in asked if one.agrees)
    rest = _("the other entries are not given")
    place = _("{entries}: right; {rest}").format(entries=names, rest=rest) if names else rest
    wrong = [one for one in asked if not one.agrees]
    if not wrong:
        return wrong_outcome(question, 0.0, ("missing entries",), place)
    found = _wrong(question, wrong, file, robot)
    kinds = (*found.kinds, "missing entries")
    outcome = wrong_outcome(question, 0.0, kinds, f"{found.place}{_('; ')}{place}", found.answer)
    return replace(outcome, formulas=found.formulas, remark=found.remark)


def _wrong(
    question: Question, wrong: list[Diagnosis], file: FormulaFile | None, robot: Mechanism
) -> Outcome:
    """Entries that are judged each for itself cost what the slips of each do."""
    kinds: list[str] = []
    places: list[str] = []
    answer: list[str] = []
    marked: dict[str, str] = {}
    for found in wrong:
        best = found.causes[0] if found.causes else None
        kinds += best.kinds if best is not None else ("unknown",)
        where, formulas = _places(found, best, file, robot)
        places += where
        for name, latex in formulas:
            if name not in marked or r"\wrong{" in latex:
                marked[name] = latex
        if best is not None:
            answer += [found.sentence, *(f"{_named(k)} = {v}" for k, v in best.corrected.items())]
    points, place = points_left(question, kinds), _("; ").join(dict.fromkeys(places))
    read = tuple(marked.items())
    outcome = wrong_outcome(question, points, tuple(kinds), place, tuple(answer), read)
    if all(found.form != "near" for found in wrong):
        return outcome
    return replace(outcome, remark=_("nearly right, and nobody can tell why: mark it by hand"))


def _places(
    found: Diagnosis, best: Cause | None, file: FormulaFile | None, robot: Mechanism
) -> tuple[list[str], tuple[tuple[str, str], ...]]:
    """Where to look, in the student's own words, and the formulas with those pieces marked."""
    places: list[str] = []
    formulas: list[tuple[str, str]] = []
    if file is None:
        labels = [_named(place) for place in dict.fromkeys(best.places if best else ()) if place]
        return [label for label in labels if _is_place(label)], ()
    for entry, written in file.formulas.items():
        plain, index = split_name(claimed_of(entry, robot))
        label = label_of(plain, index)
        right = best.corrected.get(entry, best.corrected.get(label)) if best else None
        paths: frozenset[Any] = frozenset()
        if right:
            formula = parse(right)  # in the writer's names or in the robot's
            alike = tree.names(written) & tree.names(formula)
            meaning = _meanings(formula, file, robot, entry)
            meaning |= _meanings(written, file, robot, entry)
            meaning = {name: meant for name, meant in meaning.items() if name not in alike}
            paths, _marks = differences(written, tree.renamed(formula, meaning), meaning)
            typed = file.as_typed.get(entry, "")
            pieces = [_piece(tree.at_path(written, path), typed) for path in sorted(paths)]
            shown = _named(entry)
            look = _("{entry}: look at {pieces}").format(entry=shown, pieces=together(pieces))
            places.append(look if pieces else shown)
        formulas.append(equation(_named(entry), written, Marks("wrong", paths)))
    if best and not places:
        places = [_named(place) for place in dict.fromkeys(best.places) if _is_place(place)]
    if not best and found.worst_entry and len(file.formulas) > 1:
        places = [_named(found.worst_entry)]
    return places or [_("the formula as a whole")], tuple(formulas)


def _piece(node: Node, typed: str) -> str:
    """A piece of a formula; what was typed as a decimal is no fraction: 0.2 for 1/5."""
    digits = {*_DECIMALS.findall(typed)}
    for path, part in [*tree.nodes(node)]:
        if part.op == "num" and f"{abs(float(part.value)):.12g}" in digits:
            node = tree.replaced(node, path, tree.sym(f"{float(part.value):.12g}"))
    return str(node).replace("**", "^")


def _is_place(text: str) -> bool:
    return 0 < len(text) <= 40 and "=" not in text


def _meanings(formula: Node, file: FormulaFile, robot: Mechanism, entry: str) -> dict[str, Node]:
    """What the names of a formula stand for; its own may be others than those of the file."""
    named = with_names(replace(file, formulas={entry: formula}), robot)
    return {n: in_robot_names(tree.sym(n), named, robot, entry) for n in tree.names(formula)}


_PLACE = re.compile(r"(line|link|joint|row|rows|entry|entries|column) (\d+)(?: and (\d+))?")
_PLACES = {
    "line": N_("line {number}"),
    "link": N_("link {number}"),
    "joint": N_("joint {number}"),
    "row": N_("row {number}"),
    "entry": N_("entry {number}"),
    "column": N_("column {number}"),
    "rows": N_("rows {number} and {other}"),
    "entries": N_("entries {number} and {other}"),
}


def _named(label: str) -> str:
    """``mass_matrix[0,1]`` as M12; ``row 2`` in words."""
    found = _PLACE.fullmatch(label)
    if found is not None:
        return _(_PLACES[found[1]]).format(number=found[2], other=found[3])
    return ENTRY_LETTERS.get(label, shown_entry(label))


# -------- How much is told


def _told(outcome: Outcome, level: str, secrets: tuple[str, ...]) -> Outcome:
    """What a level of feedback lets through; nothing below ``answer`` holds the right formula."""
    rank = FEEDBACK.index(level)
    kept = outcome
    if rank < 3:
        kept = replace(kept, answer=())
    if rank < 2:
        kept = replace(kept, cause="")
    if rank < 1:
        plain = tuple((name, latex.replace(r"\wrong{", "{")) for name, latex in kept.formulas)
        kept = replace(kept, place="", formulas=plain)
    hidden = {*secrets, *(_bare(text.partition(" = ")[2]) for text in outcome.answer)} - {""}
    said = _bare(json.dumps([kept.place, kept.cause, kept.remark]))
    if rank < 3 and any(secret in said for secret in hidden if len(secret) > 3):
        kept = replace(kept, place="", cause="", remark="")
    return kept


def _secrets(sheet: Sheet, question: Question) -> tuple[str, ...]:
    return tuple(_bare(text) for text in question.answer.values())


def _bare(text: str) -> str:
    return "".join(text.split()).replace("**", "^")
