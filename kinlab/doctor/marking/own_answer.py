"""A formula beside the sheet's own model answer, where no engine knows the quantity."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes, relative_errors
from kinlab.doctor.linkages.named_numbers import named_numbers
from kinlab.doctor.marking.marks import Outcome, points_left, right_outcome, wrong_outcome
from kinlab.doctor.marking.sheet import Question, Sheet, SheetError
from kinlab.doctor.marking.variation import robot_for
from kinlab.doctor.text.stand_ins import stand_ins
from kinlab.doctor.text.written import Written
from kinlab.errors import ExpressionError, KinlabError, near
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.text import FormulaFile, canonical, formula_file
from kinlab.formulas.tree import Node
from kinlab.formulas.typeset import equation
from kinlab.host.language import _

_DIGITS = "0123456789"
_STATES = 60


def with_answer(sheet: Sheet, question: Question, student: str, file: FormulaFile) -> Outcome:
    model = _model(sheet, question)
    robot = robot_for(sheet, student)
    words = named_numbers(robot)
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
            points, right_one = points_left(question, kinds), (f"{name} = {right}",)
            return wrong_outcome(question, points, kinds, place, right_one, formulas)
    return right_outcome(question, forms, formulas)


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
    words = named_numbers(sheet.robot)
    joints = range(1, 3 if isinstance(sheet.robot, FiveBar) else sheet.robot.n + 1)
    own = {*words, *(f"{q}{k}" for q in ("q", "qd", "qdd") for k in joints)}
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
    at: dict[str, Array] = {}
    for one in sorted(tree.names(mine) | tree.names(theirs)):
        at[one] = np.full(_STATES, words[one]) if one in words else rng.uniform(0.3, 1.7, _STATES)
        if one in _joints():
            at[one] = at[one] * rng.choice([-1.0, 1.0], _STATES)
    with np.errstate(all="ignore"):
        hand, truth = _values(mine, at, _STATES), _values(theirs, at, _STATES)
        there = np.isfinite(truth)
        if not there.any():
            raise SheetError(f"{name}: the sheet's own answer has no value at any state")
        hand, truth = hand[there], truth[there]
        error = float(np.max(relative_errors(hand, truth)))
        at = {one: stack[there] for one, stack in at.items()}
        written = Written(name, file.texts[name], mine, file.symbol_texts)
        if error and stand_ins(written, at, truth, error_sizes(truth)) is not None:
            return error, ("rounded",)
        return error, _multiple(mine, theirs, at, words)


def _multiple(
    mine: Node, theirs: Node, at: Mapping[str, Array], words: Mapping[str, float]
) -> tuple[str, ...]:
    """Whether a formula is the other with a sign or a factor.

    One in names must be so with any numbers of the arm, or a lost term would be a factor. One in
    bare numbers is told a factor only where it is 2 or 1/2: of two numbers each is a multiple of
    the other.
    """
    named = tree.names(mine) & {*words}
    rng = np.random.default_rng(11)
    if named:
        at = {k: v * rng.uniform(0.7, 1.4, v.shape) if k in words else v for k, v in at.items()}
    count = max((len(stack) for stack in at.values()), default=1)
    truth = _values(theirs, at, count)
    there = np.isfinite(truth)
    ratio = _values(mine, at, count)[there] / truth[there]
    steady = ratio.size and np.all(np.isfinite(ratio)) and np.ptp(ratio) <= 1e-9 * abs(ratio[0])
    if not steady or not ratio[0]:
        return ("unknown",)
    if abs(ratio[0] + 1.0) <= 1e-9:
        return ("sign",)
    plain = min(abs(abs(ratio[0]) - factor) for factor in (2.0, 0.5)) <= 1e-9
    return ("factor",) if named or plain else ("unknown",)


def _values(node: Node, at: Mapping[str, Array], count: int) -> Array:
    return np.array(np.broadcast_to(tree.evaluate(node, at), count), dtype=float)


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
