"""One answer judged: verdict, points, and as much of the reason as the sheet's feedback allows."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes, relative_errors
from kinlab.check.diagnosis import ENTRY_LETTERS, Cause, Diagnosis, shown_entry
from kinlab.doctor.examine import examine, prepare
from kinlab.doctor.file import examine_formulas
from kinlab.doctor.marking.sheet import FEEDBACK, Question, Sheet, SheetError
from kinlab.doctor.marking.submission import Submission, as_entries
from kinlab.doctor.marking.variation import robot_for
from kinlab.doctor.marking.words import told
from kinlab.doctor.terms import split_name
from kinlab.doctor.text.claims import quantity_of
from kinlab.doctor.text.own_names import in_robot_names
from kinlab.doctor.text.stand_ins import stand_ins
from kinlab.doctor.text.written import Written
from kinlab.doctor.verdicts import together
from kinlab.errors import ExpressionError, KinlabError, near
from kinlab.formulas import tree
from kinlab.formulas.marks import differences
from kinlab.formulas.text import FormulaFile, canonical, formula_file, parse
from kinlab.formulas.tree import Node
from kinlab.formulas.typeset import Marks, equation
from kinlab.host.language import N_, _
from kinlab.model.robot import Robot
from kinlab.symbolic.vocabulary import vocabulary

RIGHT = N_("right")
WRONG = N_("wrong")
UNREAD = N_("could not be read")
MISSING = N_("no answer")
_GRADES = {
    "": RIGHT,
    "rounded": N_("right with rounded numbers"),
    "unusual": N_("right but written unusually"),
}
_WRITTEN = 400
_DIGITS = "0123456789"
_STATES = 60


@dataclass(frozen=True)
class Outcome:
    """One question of one student.

    Attributes:
        question: its id.
        verdict: ``"right"`` (or which kind of right), ``"wrong"``, ``"could not be read"``,
            ``"no answer"``.
        points, of: what it got, and what a right answer gets.
        kinds: of the slips, from ``place`` on told to the teacher only, from ``cause`` on to all.
        written: as it was typed.
        place: where to look, in the student's own symbols.
        cause: what kind of slip it is, without the right formula.
        answer: the doctor's sentence and the right formulas; at ``answer`` only.
        formulas: as they were read, for a page: names and LaTeX, the place marked.
        remark: why it could not be read, or what holds for these numbers only.
    """

    question: str
    verdict: str
    points: float
    of: float
    kinds: tuple[str, ...] = ()
    written: tuple[str, ...] = ()
    place: str = ""
    cause: str = ""
    answer: tuple[str, ...] = ()
    formulas: tuple[tuple[str, str], ...] = ()
    remark: str = ""

    @property
    def right(self) -> bool:
        """Whether the formula is right, however it is written."""
        return self.verdict.startswith(RIGHT)

    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return asdict(self)


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


def of_values(sheet: Sheet, question: Question, student: str, values: Array, level: str) -> Outcome:
    """The outcome of a question that a function answered.

    Args:
        sheet, question: what was asked.
        student: whose numbers the robot has.
        values: the function's answers at :func:`states_of`.
        level: of feedback.
    """
    plain, index = split_name(question.quantity)
    robot = robot_for(sheet, student)
    case, engine = prepare(robot, plain, index, sheet.samples, sheet.seed)
    found = examine(case, values, engine, question.quantity, question.id, {})
    outcome = _of_diagnoses(question, [found], None, robot)
    return _told(outcome, level, _secrets(sheet, question))


def states_of(sheet: Sheet, question: Question, student: str) -> dict[str, Array]:
    """The arguments at which a function is asked, (N, n) each."""
    plain, index = split_name(question.quantity)
    case, _ = prepare(robot_for(sheet, student), plain, index, sheet.samples, sheet.seed)
    return dict(case.arguments)


def lost(question: Question, remark: str, written: tuple[str, ...] = ()) -> Outcome:
    """An answer that could not be read."""
    return Outcome(question.id, UNREAD, 0.0, question.points, ("unread",), written, remark=remark)


def missing(question: Question) -> Outcome:
    """No answer."""
    return Outcome(question.id, MISSING, 0.0, question.points)


def _one(sheet: Sheet, question: Question, submission: Submission) -> Outcome:
    given = submission.answers.get(question.id)
    written = tuple(
        (f"{name} = {text}" if name and "=" not in text else text)[:_WRITTEN]
        for name, text in (given or {}).items()
    )
    if question.id in submission.problems:
        return lost(question, submission.problems[question.id], written)
    if not given or not any(text.strip(" $") for text in given.values()):
        return missing(question)
    try:
        entries = as_entries(question, given, sheet)
        document = {"robot": "the sheet's", "symbols": submission.symbols, "formulas": entries}
        file = formula_file(document, question.id, submission.writing)
        if question.quantity:
            outcome = _with_engine(sheet, question, submission.student, file)
        else:
            outcome = _with_answer(sheet, question, submission.student, file)
    except KinlabError as problem:
        return lost(question, str(problem), written)
    except (RecursionError, MemoryError, OverflowError, ArithmeticError, ValueError) as problem:
        return lost(question, f"{question.id}: {type(problem).__name__}", written)
    return replace(outcome, written=written)


# -------- Beside the engine


def _with_engine(sheet: Sheet, question: Question, student: str, file: FormulaFile) -> Outcome:
    own = robot_for(sheet, student)
    robot = sheet.robot if own is not sheet.robot and _free_of_numbers(file, sheet, own) else own
    found = _diagnosed(_Key(robot, file), sheet.samples, sheet.seed)
    if robot is not own and all(one.agrees for one in found):
        robot = own  # names only, so it is right with every number; these say so too
        found = _diagnosed(_Key(own, file), sheet.samples, sheet.seed)
    return _of_diagnoses(question, found, file, robot)


def _free_of_numbers(file: FormulaFile, sheet: Sheet, own: Robot) -> bool:
    """Whether no number in the formulas could be one of the robot's."""
    values: set[float] = set()
    for robot in (sheet.robot, own):
        if robot.table is not None:
            values |= {abs(float(value)) for value in vocabulary(robot.table).values.values()}
    for node in [*file.formulas.values(), *file.symbols.values()]:
        for _path, part in tree.nodes(node):
            if part.op == "num" and (
                part.value.denominator > 4 or abs(float(part.value)) in values
            ):
                return False
    return True


class _Key:
    """A robot and formulas; equal where the texts are, so that a class's same answers are one."""

    def __init__(self, robot: Robot, file: FormulaFile) -> None:
        self.robot, self.file = robot, file
        self.texts = (id(robot), *file.as_typed.items(), *file.symbol_texts.items())

    def __hash__(self) -> int:
        return hash(self.texts)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and self.texts == other.texts


@lru_cache(maxsize=4096)
def _diagnosed(key: _Key, samples: int, seed: int) -> tuple[Diagnosis, ...]:
    return tuple(examine_formulas(key.file, key.robot, samples, seed))


def _of_diagnoses(
    question: Question, found: Any, file: FormulaFile | None, robot: Robot
) -> Outcome:
    asked = [one for one in found if split_name(one.quantity)[0] == question.plain]
    if not asked:
        said = _("{question}: none of the formulas is {entry}")
        raise ExpressionError(said.format(question=question.id, entry=question.entry))
    if "[" not in question.quantity and any("[" in one.quantity for one in asked):
        return _in_part(question, asked, file, robot)
    if all(one.agrees for one in asked):
        return _right(question, asked, file)
    wrong = next(one for one in asked if not one.agrees)
    outcome = _wrong(question, wrong, file, robot)
    if wrong.form != "near":
        return outcome
    return replace(outcome, remark=_("nearly right, and nobody can tell why: mark it by hand"))


def _right(question: Question, asked: list[Diagnosis], file: FormulaFile | None) -> Outcome:
    remarks = [remark for one in asked for remark in one.remarks]
    remark = _("; ").join(dict.fromkeys(remarks))
    return _graded(question, {one.form for one in asked}, _as_read(file) if file else (), remark)


def _graded(
    question: Question, forms: set[str], formulas: tuple[tuple[str, str], ...], remark: str = ""
) -> Outcome:
    """A right answer: as the sheet has it, or right in another way, which may cost something."""
    kind = next((form for form in ("unusual", "rounded") if form in forms), "")
    share = question.slips.get(kind, 0.0) if kind else 0.0
    points, kinds = round(question.points * (1.0 - share), 6), (kind,) if kind else ()
    got = (question.id, _GRADES[kind], points, question.points, kinds)
    return Outcome(*got, formulas=formulas, remark=remark)


def _as_read(file: FormulaFile) -> tuple[tuple[str, str], ...]:
    return tuple(equation(_named(name), formula) for name, formula in file.formulas.items())


def _in_part(
    question: Question, asked: list[Diagnosis], file: FormulaFile | None, robot: Robot
) -> Outcome:
    """Some entries of a whole: the rest is no answer."""
    wrong = [one for one in asked if not one.agrees]
    if wrong:
        return _wrong(question, wrong[0], file, robot)
    names = ", ".join(one.function for one in asked)
    place = _("{entries}: right; the other entries are not given").format(entries=names)
    return _less(question, 0.0, ("missing entries",), place)


def _less(
    question: Question,
    points: float,
    kinds: tuple[str, ...],
    place: str,
    answer: tuple[str, ...] = (),
    formulas: tuple[tuple[str, str], ...] = (),
) -> Outcome:
    """A wrong answer: what is left of its points, and all that can be told of it."""
    got = (question.id, WRONG, points, question.points, kinds, ())
    return Outcome(*got, place, told(kinds), answer, formulas)


def _wrong(question: Question, found: Diagnosis, file: FormulaFile | None, robot: Robot) -> Outcome:
    best = found.causes[0] if found.causes else None
    kinds = tuple(best.kinds) if best is not None else ("unknown",)
    places, formulas = _places(found, best, file, robot)
    answer: list[str] = []
    if best is not None:
        answer = [found.sentence, *(f"{_named(k)} = {v}" for k, v in best.corrected.items())]
    points, place = _points(question, kinds), _("; ").join(places)
    return _less(question, points, kinds, place, tuple(answer), formulas)


def _points(question: Question, kinds: Iterable[str]) -> float:
    """What is left of a question's points after slips of these kinds."""
    cost = math.fsum(question.slips.get(kind, question.slips.get("other", 1.0)) for kind in kinds)
    return round(question.points * max(0.0, 1.0 - cost), 6)


def _places(
    found: Diagnosis, best: Cause | None, file: FormulaFile | None, robot: Robot
) -> tuple[list[str], tuple[tuple[str, str], ...]]:
    """Where to look, in the student's own words, and the formulas with those pieces marked."""
    places: list[str] = []
    formulas: list[tuple[str, str]] = []
    if file is None:
        labels = [_named(place) for place in dict.fromkeys(best.places if best else ()) if place]
        return [label for label in labels if _is_place(label)], ()
    for entry, written in file.formulas.items():
        plain, index = split_name(quantity_of(entry, robot.table))
        label = f"{plain}[{','.join(map(str, index))}]" if index else plain
        right = best.corrected.get(entry, best.corrected.get(label)) if best else None
        paths: frozenset[Any] = frozenset()
        if right:
            formula = parse(right)  # in the writer's names or in the robot's
            used = tree.names(written) | tree.names(formula)
            meaning = {n: _meaning(n, file, robot, entry) for n in used}
            paths, _marks = differences(written, tree.renamed(formula, meaning), meaning)
            pieces = [_piece(tree.at_path(written, path)) for path in sorted(paths)]
            shown = _named(entry)
            look = _("{entry}: look at {pieces}").format(entry=shown, pieces=together(pieces))
            places.append(look if pieces else shown)
        formulas.append(equation(_named(entry), written, Marks("wrong", paths)))
    if best and not places:
        places = [_named(place) for place in dict.fromkeys(best.places) if _is_place(place)]
    if not best and found.worst_entry and len(file.formulas) > 1:
        places = [_named(found.worst_entry)]
    return places or [_("the formula as a whole")], tuple(formulas)


def _piece(node: Node) -> str:
    return str(node).replace("**", "^")


def _is_place(text: str) -> bool:
    return 0 < len(text) <= 40 and "=" not in text


def _meaning(name: str, file: FormulaFile, robot: Robot, entry: str) -> Node:
    return in_robot_names(tree.sym(name), file, robot, entry)


_PLACE = re.compile(r"(link|joint|row|rows|entry|entries|column) (\d+)(?: and (\d+))?")
_PLACES = {
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


# -------- Beside an own model answer


def _with_answer(sheet: Sheet, question: Question, student: str, file: FormulaFile) -> Outcome:
    model = _model(sheet, question)
    robot = robot_for(sheet, student)
    words = vocabulary(robot.table).values if robot.table is not None else {}
    for name in model.formulas:
        if name not in file.formulas:
            said = _("{question}: {entry} is not given")
            raise ExpressionError(said.format(question=question.id, entry=name))
    formulas = tuple(equation(name, file.formulas[name]) for name in model.formulas)
    forms: set[str] = set()
    for name, right in model.formulas.items():
        error, kinds = _gap(file, model, name, right, words)
        if error <= question.tolerance:
            continue
        forms.update(kinds)
        if kinds != ("rounded",):
            place = name if len(model.formulas) > 1 else _("the formula as a whole")
            points, right_one = _points(question, kinds), (f"{name} = {right}",)
            return _less(question, points, kinds, place, right_one, formulas)
    return _graded(question, forms, formulas)


def _model(sheet: Sheet, question: Question) -> FormulaFile:
    return _read_model(tuple(question.answer.items()), f"{sheet.place}: {question.id}: answer")


@lru_cache(maxsize=512)
def _read_model(answer: tuple[tuple[str, str], ...], place: str) -> FormulaFile:
    try:
        return formula_file({"robot": "the sheet's", "formulas": dict(answer)}, place)
    except KinlabError as problem:
        said = str(problem)
        raise SheetError(said if place in said else f"{place}: {said}") from None


def check_answers(sheet: Sheet) -> None:
    """Reads the sheet's own model answers.

    Raises:
        SheetError: one cannot be read, or has the third mass of an arm with two.
    """
    words = vocabulary(sheet.robot.table).values if sheet.robot.table is not None else {}
    own = {*words, *(f"{q}{k}" for q in ("q", "qd", "qdd") for k in range(1, sheet.robot.n + 1))}
    letters = {name.rstrip(_DIGITS) for name in own if name[-1] in _DIGITS}
    for question in sheet.questions:
        if not question.answer:
            continue
        model = _model(sheet, question)
        met = {
            n
            for name, node in model.formulas.items()
            for n in tree.names(_opened(node, model, name))
        }
        for name in sorted(met - own):
            if name[-1] in _DIGITS and name.rstrip(_DIGITS) in letters:
                raise SheetError(
                    f"{sheet.place}: {question.id}: answer: {sheet.robot.name} has no {name!r}; "
                    f"{near(name, own)}"
                )


def _gap(
    file: FormulaFile, model: FormulaFile, name: str, right: Node, words: Mapping[str, float]
) -> tuple[float, tuple[str, ...]]:
    """How far a formula is from the model's, and whether rounding, a sign or a factor explains it.

    Joints stand on both sides of zero: |q1| is not q1. States at which the model itself has no
    value (a root of a negative number) say nothing.
    """
    mine, theirs = _opened(file.formulas[name], file, name), _opened(right, model, name)
    strange = tree.names(mine) - tree.names(theirs) - set(words) - _joints()
    if strange:
        said = _("{entry}: {name!r} is unknown; give it a meaning in [symbols]")
        raise ExpressionError(said.format(entry=name, name=sorted(strange)[0][:40]))
    rng = np.random.default_rng(7)
    at = {}
    for one in sorted(tree.names(mine) | tree.names(theirs)):
        at[one] = np.full(_STATES, words[one]) if one in words else rng.uniform(0.3, 1.7, _STATES)
        if one in _joints():
            at[one] = at[one] * rng.choice([-1.0, 1.0], _STATES)
    with np.errstate(all="ignore"):
        hand = np.array(np.broadcast_to(tree.evaluate(mine, at), _STATES), dtype=float)
        truth = np.array(np.broadcast_to(tree.evaluate(theirs, at), _STATES), dtype=float)
        there = np.isfinite(truth)
        if not there.any():
            raise SheetError(f"{name}: the sheet's own answer has no value at any state")
        hand, truth = hand[there], truth[there]
        error = float(np.max(relative_errors(hand, truth)))
        at = {one: stack[there] for one, stack in at.items()}
        written = Written(name, file.texts[name], mine, file.symbol_texts)
        if error and stand_ins(written, at, truth, error_sizes(truth)) is not None:
            return error, ("rounded",)
        ratio = hand / truth
    steady = np.all(np.isfinite(ratio)) and np.ptp(ratio) <= 1e-9 * abs(ratio[0])
    if steady and abs(ratio[0] + 1.0) <= 1e-9:
        return error, ("sign",)
    return error, ("factor",) if steady and ratio[0] else ("unknown",)


def _joints() -> set[str]:
    return {f"{letter}{k}" for letter in ("q", "qd", "qdd") for k in range(1, 10)}


def _opened(node: Node, file: FormulaFile, entry: str, depth: int = 0) -> Node:
    if depth > 20:
        said = _("{entry}: its symbols explain each other")
        raise ExpressionError(said.format(entry=entry))
    mapping = {}
    for name in tree.names(node):
        given = file.symbols.get(name)
        mapping[name] = canonical(name) if given is None else _opened(given, file, entry, depth + 1)
    return tree.renamed(node, mapping)


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
