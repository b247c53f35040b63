"""A formula beside the sheet's own model answer, where no engine knows the quantity."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes, relative_errors
from kinlab.check.diagnosis import not_judged
from kinlab.doctor.entries import search
from kinlab.doctor.entries.terms import rods_following
from kinlab.doctor.excuses import only_for
from kinlab.doctor.file import words_unread
from kinlab.doctor.linkages.named_numbers import named_numbers
from kinlab.doctor.marking.marks import Outcome, points_left, right_outcome, wrong_outcome
from kinlab.doctor.marking.sheet import Question, Sheet, SheetError
from kinlab.doctor.marking.variation import robot_for
from kinlab.doctor.text.line import Names
from kinlab.doctor.text.stand_ins import bare_number, stand_ins
from kinlab.doctor.text.written import Written
from kinlab.doctor.verdicts import holds_with_other_numbers
from kinlab.errors import ExpressionError, KinlabError
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.files import FormulaFile, formula_file
from kinlab.formulas.signs.refusals import near_names
from kinlab.formulas.text import canonical
from kinlab.formulas.tree import Node
from kinlab.formulas.typeset import equation
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

_STATES, _NEAR = 60, TOLERANCES.bare_number
_NUMBERS = range(1, 10)
"""What joints are counted with."""
_TYPESET = re.compile(r"[\\_{}]")
_WORD = re.compile(r"[A-Za-z][A-Za-z0-9]*")


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
    only: set[str] = set()
    for name, right in model.formulas.items():
        beside = _Beside(file, model, name, words, question.tolerance)
        kinds, kept = beside.judged()
        place = name if len(model.formulas) > 1 else _("the formula as a whole")
        if kinds == ("unknown",) and (found := beside.slips()) != kinds:
            kinds, place = found, name
        forms.update(kinds)
        only.update(kept)
        if kinds not in ((), ("rounded",)):
            if name in file.unread:
                raise ExpressionError(not_judged(name, words_unread(file.unread[name].words)))
            points, right_one = points_left(question, kinds), (f"{name} = {right}",)
            return wrong_outcome(question, points, kinds, place, right_one, formulas)
    numbers = [f"{name} = {words[name]:.7g}" for name in sorted(only)]
    return right_outcome(question, forms, formulas, _("; ").join(only_for(numbers)))


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
        SheetError: one cannot be read, has no value, or has a name that is neither the robot's nor
            in the question's text: no student could know it.
    """
    words = named_numbers(sheet.robot)
    joints = range(1, 3 if isinstance(sheet.robot, FiveBar) else sheet.robot.n + 1)
    own = {*words, *(f"{q}{k}" for q in ("q", "qd", "qdd") for k in joints)}
    for question in sheet.questions:
        if not question.answer:
            continue
        model, told = _model(sheet, question), {*_WORD.findall(_plain(question.text))}
        for entry, node in model.formulas.items():
            place, opened = f"{sheet.place}: {question.id}: answer", _opened(node, model, entry)
            for name in sorted(tree.names(opened) - own):
                if _plain(name) not in told:
                    said = _(
                        "{robot} has no {name}; {choices} (a name of the question's own must stand "
                        "in its text)"
                    )
                    fields = {"robot": sheet.robot.name, "name": repr(name)}
                    choices = near_names(name, sorted(own))
                    raise SheetError(f"{place}: {said.format(**fields, choices=choices)}")
            if not np.isfinite(_values(opened, _states(tree.names(opened), words))).any():
                said = _("{entry} = {formula} is no number at any state")
                raise SheetError(f"{place}: {said.format(entry=entry, formula=node)}")


def _plain(text: str) -> str:
    """A text with its names as in formulas: x1 for x_1 and x_{1}."""
    return _TYPESET.sub("", text)


@dataclass(frozen=True, eq=False)
class _Beside:
    """A student's formula beside the model's.

    Attributes:
        file, model: both files.
        name: of the formula in them.
        words: the robot's numbers.
        tolerance: relative error up to which the model is met.
    """

    file: FormulaFile
    model: FormulaFile
    name: str
    words: Mapping[str, float]
    tolerance: float

    @cached_property
    def mine(self) -> Node:
        """The student's, with what its names stand for."""
        return _opened(self.file.formulas[self.name], self.file, self.name)

    @cached_property
    def theirs(self) -> Node:
        """The model's."""
        return _opened(self.model.formulas[self.name], self.model, self.name)

    @cached_property
    def text(self) -> Written:
        """The student's, as it is written."""
        return _written(self.file, self.name, self.mine)

    @cached_property
    def model_text(self) -> Written:
        """The model's."""
        return _written(self.model, self.name, self.theirs)

    @cached_property
    def names(self) -> set[str]:
        """All names that have values: of the student's formula, and in the model's text."""
        inside = [canonical(name) for name in self.model_text.foreign(set())]
        return set().union(*(tree.names(x) for x in (self.mine, self.theirs, *inside)))

    def judged(self) -> tuple[tuple[str, ...], set[str]]:
        """What is off, ``("rounded",)`` or nothing; and the robot's names that it has numbers for.

        Joints stand on both sides of zero: |q1| is not q1. States at which the model itself has no
        value (a root of a negative number) say nothing.
        """
        at = _states(self.names, self.words)
        known = tree.names(self.theirs) | {*self.words} | _joints()
        # what is multiplied by zero is in the text alone
        strange = sorted(tree.names(self.mine) - known) or self.text.foreign(known)
        if strange:
            said = _("{entry}: {name!r} is unknown; explain it on a line of its own")
            raise ExpressionError(said.format(entry=self.name, name=strange[0][:40]))
        with np.errstate(all="ignore"):
            there = np.isfinite(_values(self.theirs, at))
            if not there.any():
                said = _("{entry}: the sheet's own answer has no value at any state")
                raise SheetError(said.format(entry=self.name))
            at = {one: stack[there] for one, stack in at.items()}
            hand, truth = _values(self.mine, at), _values(self.theirs, at)
            if float(np.max(relative_errors(hand, truth))) <= self.tolerance:
                return self._elsewhere(at)
            if not np.isfinite(hand).any():
                return ("no value",), set()
            if self._to_digits(hand, truth, at):
                return ("rounded",), set()
            return _multiple(self.mine, self.theirs, at, self.words), set()

    def slips(self) -> tuple[str, ...]:
        """The kinds of one slip, or of two, without which it would be the model's.

        What undoes them must hold with any numbers of the arm that it has names for; of bare
        numbers each is some factor, or power, of any other.
        """
        if not tree.names(self.mine):
            return ("unknown",)
        at, mine, theirs = _states(self.names, self.words), self.mine, self.theirs
        used = tree.names(mine) | tree.names(theirs)
        numbers = tuple(sorted(used & {*self.words}))
        letters = tuple(x for x in ("q", "qd", "qdd") if any(f"{x}{k}" in used for k in _NUMBERS))
        joints = max((k for k in _NUMBERS for x in letters if f"{x}{k}" in used), default=0)
        rng = np.random.default_rng(11)
        there = {
            k: v * rng.uniform(0.7, 1.4, v.shape) if k in numbers else v for k, v in at.items()
        }
        truth = _values(theirs, there)
        if not np.isfinite(truth).all() or not np.isfinite(_values(mine, there)).all():
            return ("unknown",)
        names = Names(numbers, joints, letters)
        case = search.study(mine, truth, there, names, [*_terms(theirs)])
        for found in (search.single, search.double, search.double_in_term):
            repairs = found(case)
            if repairs:
                return tuple(edit.kind for edit in repairs[0].edits)
        return ("unknown",)

    def _to_digits(self, hand: Array, truth: Array, at: Mapping[str, Array]) -> bool:
        """Whether it is right with rounded numbers, its own or those of the model."""
        text, model = self.text, self.model_text
        if not tree.names(self.mine) and np.max(relative_errors(hand, truth)) > _NEAR:
            return False  # of factors, too: 4*10*0.6 is one number
        if not any(one.whole for one in model.literals) and bare_number(model, at, hand):
            return True
        met = bare_number(text, at, truth)
        return (
            met if met is not None else stand_ins(text, at, truth, error_sizes(truth)) is not None
        )

    def _elsewhere(self, at: Mapping[str, Array]) -> tuple[tuple[str, ...], set[str]]:
        """The same of a formula that is met, once the robot has other numbers.

        A formula may have numbers for names, as the model may. One in the model's own names that
        is met at this robot's numbers only is a slip that they cover up: 2*l1**2 for l1.
        """
        mine, theirs = (tree.names(node) & {*self.words} for node in (self.mine, self.theirs))
        if not mine and tree.names(self.mine) <= {*self.words}:
            return (), set()  # a bare number is none for any other arm
        both = mine & theirs

        def moved(names: Iterable[str], by: Callable[[Array], Array]) -> dict[str, Array]:
            other = {**at, **{name: by(at[name]) for name in sorted(names)}}
            return rods_following(other, self.words, both)

        def others() -> Iterator[dict[str, Array]]:
            rng = np.random.default_rng(11)
            while True:
                yield moved(self.words, lambda x: x * rng.uniform(0.8, 1.25))

        if not self._differs(next(others())):
            return (), set()
        own = {name: float(self.words[name]) for name in mine | theirs}
        if mine - theirs and holds_with_other_numbers(
            self.model_text, partial(_values, self.mine), others(), own
        ):
            return (), set()
        apart = {x for x in mine ^ theirs if moved([x], _another)[x][0] == _another(at[x][0])}
        if apart or holds_with_other_numbers(
            self.text, partial(_values, self.theirs), others(), own
        ):
            kept = {x for x in own if self._differs(moved([x], _another))}
            return (), kept
        return _multiple(self.mine, self.theirs, at, self.words), set()

    def _differs(self, at: Mapping[str, Array]) -> bool:
        """Whether both have values somewhere, and not the same."""
        hand, truth = _values(self.mine, at), _values(self.theirs, at)
        there = np.isfinite(hand) & np.isfinite(truth)
        most = max(self.tolerance, TOLERANCES.formula_agrees)
        return bool(there.any() and np.max(relative_errors(hand[there], truth[there])) > most)


def _terms(node: Node) -> Iterator[Node]:
    """The terms of a sum, and of the sums that are factors in one of these."""
    for term in node.args if node.op == "add" else (node,):
        yield term
        sums = [one for one in term.args if one.op == "add"] if term.op == "mul" else []
        for one in sums[:1]:
            others = [factor for factor in term.args if factor is not one]
            yield from (tree.mul(*others, inner) for inner in one.args)


def _another(value: Any) -> Any:
    """Another number for a name."""
    return 1.37 * value + 0.1


def _states(names: Iterable[str], words: Mapping[str, float]) -> dict[str, Array]:
    """Values of the robot's names, the joints' and others, (N,) each: random but for the first."""
    rng = np.random.default_rng(7)
    at: dict[str, Array] = {}
    for one in sorted({*names, *words, *_joints()}):
        at[one] = np.full(_STATES, words[one]) if one in words else rng.uniform(0.3, 1.7, _STATES)
        if one in _joints():
            at[one] = at[one] * rng.choice([-1.0, 1.0], _STATES)
    return at


def _written(file: FormulaFile, name: str, node: Node) -> Written:
    return Written(name, file.texts[name], node, file.symbol_texts)


def _multiple(
    mine: Node, theirs: Node, at: Mapping[str, Array], words: Mapping[str, float]
) -> tuple[str, ...]:
    """Whether a formula is the other with a sign or a factor, or is an angle in degrees.

    One in names must be so with any numbers of the arm, or a lost term would be a factor. One in
    bare numbers is told a factor only where it is 2 or 1/2: of two numbers each is a multiple of
    the other.
    """
    named = tree.names(mine) & {*words}
    rng = np.random.default_rng(11)
    if named:
        at = {k: v * rng.uniform(0.7, 1.4, v.shape) if k in words else v for k, v in at.items()}
    truth = _values(theirs, at)
    there = np.isfinite(truth)
    ratio = _values(mine, at)[there] / truth[there]
    steady = ratio.size and np.all(np.isfinite(ratio)) and np.ptp(ratio) <= 1e-9 * abs(ratio[0])
    if not steady or not ratio[0]:
        return ("unknown",)
    if abs(ratio[0] + 1.0) <= 1e-9:
        return ("sign",)
    if any(abs(ratio[0] / turn - 1.0) <= 1e-9 for turn in (np.rad2deg(1.0), np.deg2rad(1.0))):
        return ("degrees",)
    plain = min(abs(abs(ratio[0]) - factor) for factor in (2.0, 0.5)) <= 1e-9
    return ("factor",) if named or plain else ("unknown",)


def _values(node: Node, at: Mapping[str, Array]) -> Array:
    with np.errstate(all="ignore"):
        found = tree.evaluate(node, dict(at))
    return np.array(np.broadcast_to(found, np.shape(next(iter(at.values())))), dtype=float)


def _joints() -> set[str]:
    return {f"{letter}{k}" for letter in ("q", "qd", "qdd") for k in _NUMBERS}


def _opened(node: Node, file: FormulaFile, entry: str, depth: int = 0) -> Node:
    if depth > 20:
        said = _("{entry}: its symbols explain each other")
        raise ExpressionError(said.format(entry=entry))
    mapping = {}
    for name in tree.names(node):
        given = file.symbols.get(name)
        mapping[name] = canonical(name) if given is None else _opened(given, file, entry, depth + 1)
    return tree.renamed(node, mapping)
