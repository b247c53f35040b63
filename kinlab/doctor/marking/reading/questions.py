"""Which formula answers which question: by a label, by the question's id, by its left side."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from kinlab.check.diagnosis import ENTRY_LETTERS, shown_entry
from kinlab.check.quantities.registry import split_name
from kinlab.doctor.linkages.named_numbers import named_numbers
from kinlab.doctor.marking.reading.labels import SheetLabels
from kinlab.doctor.marking.reading.measured import without_unit
from kinlab.doctor.marking.reading.pieces import Piece, is_no_answer
from kinlab.doctor.marking.sheet import Question, Sheet
from kinlab.doctor.text.claims import claimed_of, whole_claimed
from kinlab.errors import ExpressionError, KinlabError
from kinlab.formulas.language.sentences import without_sentences
from kinlab.formulas.typed import (
    Hand,
    claims,
    entry_name,
    explained,
    hand,
    is_name,
    named_in,
    plain_formula,
    several,
    sides,
)
from kinlab.host.language import _

_WORD = re.compile(r"[A-Za-z]\w*")
_OWN = re.compile(r"(?!(?:q|qd|qdd|th|theta|[cs])\d)[A-Za-z]\w*")
_JOINT = re.compile(r"(?:q|qd|qdd|th|theta)_?\d", re.IGNORECASE)
_OF_TOOL = re.compile(r"([xyz])_?(?:e|ee|eff|tcp|tool|tip|p|t|h|end|hand|gripper)", re.IGNORECASE)
"""A coordinate with what says of which point it is."""
_LONGEST = 24
"""Characters of a line that is told."""


@dataclass
class Answers:
    """What a submission answers.

    Attributes:
        given: question id to formulas by name; the name is empty where none is written.
        problems: question id to what cannot be used.
        astray: beginnings of lines that answer no question and explain no name.
        own: the writer's own names.
        notes: what was decided, for people.
    """

    given: dict[str, dict[str, str]] = field(default_factory=dict)
    problems: dict[str, str] = field(default_factory=dict)
    astray: list[str] = field(default_factory=list)
    own: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def answered(self, question: str) -> bool:
        """Whether anything stands for a question."""
        return question in self.given or question in self.problems

    def add(self, question: str, name: str, value: Any) -> None:
        """Takes an answer, or says why it cannot be used."""
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            value = repr(value)
        mine = self.given.get(question, {})
        if isinstance(value, dict) and all(isinstance(v, str) for v in value.values()):
            self.given.setdefault(question, {}).update(value)
        elif not isinstance(value, str):
            said = _("{type}; write the formula as text")
            self.problems[question] = said.format(type=type(value).__name__)
        elif mine.get(name, value).strip() != value.strip():
            said = _("{entry} is given twice; keep the last line only")
            self.problems[question] = said.format(entry=name or question)
        else:
            self.given.setdefault(question, {})[name] = value


def sort_pieces(
    pieces: Sequence[Piece], sheet: Sheet, labels: SheetLabels | None = None
) -> Answers:
    """The answers in the pieces of a submission.

    What has a label on its line comes first; what names a question by its left side is taken where
    no label gave another answer; below a label, what has neither is the label's. ``q1 = ...``,
    which may be about joint 1, comes last.

    Args:
        pieces: of one submission.
        sheet: what is asked.
        labels: of the sheet, where they are at hand.
    """
    labels = labels or SheetLabels(sheet)
    writing = hand(str(one.text) for one in pieces)
    found = Answers()
    rest: list[tuple[Piece, list[str], Question, str]] = []
    late: list[tuple[Piece, list[str], Question]] = []
    below: dict[str, list[tuple[Piece, str]]] = {}
    others: list[tuple[Piece, str]] = []
    for one in pieces:
        lefts = named_in(one.text) if isinstance(one.text, str) else []
        asked = (question_of(left, sheet, writing) for left in lefts)
        by_left, name = next((pair for pair in asked if pair[0] is not None), (None, ""))
        if one.key:
            question = labels.named(one.key) or question_of(one.key, sheet, writing)[0]
            if question is None:
                others.append((one, one.key))
            elif not one.sure and _may_be_joint(question, ""):
                late.append((one, lefts, question))
            else:
                same = by_left is question and isinstance(one.text, str)
                alone = question_of(one.key, sheet, writing)[1]
                found.add(question.id, alone or (name if same else ""), one.text)
        elif by_left is not None and _may_be_joint(by_left, name):
            late.append((one, lefts, by_left))
        elif by_left is not None:
            rest.append((one, lefts, by_left, name))
        elif one.under:
            below.setdefault(one.under, []).append((one, lefts[0] if lefts else ""))
        else:
            others.append((one, lefts[0] if lefts else ""))
    labelled = {key: {*names} for key, names in found.given.items()}
    here = {q.id for one, _lefts, q, _name in rest if one.under in ("", q.id)}
    for one, lefts, question, name in rest:
        taken = labelled.get(question.id, set())
        elsewhere = one.under not in ("", question.id)
        if "" in taken or name in taken or (elsewhere and (taken or question.id in here)):
            others.append((one, lefts[0]))
        else:
            found.add(question.id, name, one.text)
    _take_below(found, below, others, sheet)
    _take_late(found, late, others)
    order = {id(one): k for k, one in enumerate(pieces)}
    _explain(found, sorted(others, key=lambda pair: order[id(pair[0])]), sheet)
    return found


def _take_below(
    found: Answers,
    below: Mapping[str, Sequence[tuple[Piece, str]]],
    others: list[tuple[Piece, str]],
    sheet: Sheet,
) -> None:
    """What stands below a label and names no question."""
    known = {*named_numbers(sheet.robot)}
    for question, lines in below.items():
        fits = [
            pair
            for pair in lines
            if not is_no_answer(str(pair[0].text)) and not _is_remark(pair[1], known)
        ] or list(lines)
        if found.answered(question):
            others += lines
            continue
        chosen = fits[-1]
        found.add(question, "", chosen[0].text)
        others += [pair for pair in lines if pair is not chosen]
        if len(fits) > 1:
            said = _("{count} formulas stand below {question}; the last is taken")
            found.notes.append(said.format(count=len(fits), question=question))


def _may_be_joint(question: Question, name: str) -> bool:
    """Whether a line was given to a question by its id alone, which is a joint's name too."""
    by_id = name in ("", question.id) and question.id != question.entry
    return by_id and bool(_JOINT.fullmatch(question.id))


def _is_remark(left: str, known: Iterable[str]) -> bool:
    """Whether a left side gives a number of the robot, or a joint, a value."""
    with suppress(ExpressionError):
        name = entry_name(left) if left else ""
        return name in known or bool(_JOINT.fullmatch(name))
    return False


def _take_late(
    found: Answers,
    late: Sequence[tuple[Piece, list[str], Question]],
    others: list[tuple[Piece, str]],
) -> None:
    """``q1 = ...`` as the answer to q1 where nothing else is one."""
    answered = {question.id for _one, _lefts, question in late if found.answered(question.id)}
    for one, lefts, question in late:
        alone = sum(other is question for _one, _lefts, other in late) == 1
        if question.id in answered or not alone:
            others.append((one, lefts[0] if lefts else question.id))
            continue
        text = str(one.text)
        if not one.key:  # the left side is the label
            before, _sign, behind = text.partition("=")
            text = "$" * ("$" in before) + behind
        found.add(question.id, "", text)
        said = _("{question} = ... was taken as the answer to {question}, not as a joint's value")
        found.notes.append(said.format(question=question.id))


def _explain(found: Answers, others: Sequence[tuple[Piece, str]], sheet: Sheet) -> None:
    """The writer's own names among what answers no question, and what is left of it."""
    texts = [(left, one.text) for one, left in others if isinstance(one.text, str)]
    found.own = _own_names(texts, found.given, sheet)
    for one, left in others:
        with suppress(ExpressionError):
            if left and entry_name(left) in found.own:
                continue
        text = left or " ".join(str(one.text).split())
        if not is_no_answer(str(one.text)):
            found.astray.append(text if len(text) <= _LONGEST else f"{text[:_LONGEST]}...")


def _own_names(
    others: Sequence[tuple[str, str]], answers: Mapping[str, Mapping[str, str]], sheet: Sheet
) -> dict[str, str]:
    """Lines of no question that explain a name in the answers: ``h = m2*l1*l2*s2``.

    A line for one of the robot's numbers, or for a joint, is a remark.
    """
    known = {*named_numbers(sheet.robot)}
    found: dict[str, str] = {}
    texts = [text for given in answers.values() for text in given.values()]
    while texts:
        used = {word for text in texts for word in _words(text)}
        texts = []
        for left, value in others:
            with suppress(ExpressionError):
                name, right = entry_name(left), sides(value)[1]
                if name in used - known - {*found} and _OWN.fullmatch(name) and _words(right):
                    found[name] = right
                    texts.append(right)
    return found


def _words(text: str) -> list[str]:
    """The names in a formula; none of what cannot be read."""
    try:
        return _WORD.findall(plain_formula(sides(explained(text)[1])[1]))
    except ExpressionError:
        return []


def question_of(left: str, sheet: Sheet, writing: Hand) -> tuple[Question | None, str]:
    """The question by its id, or by the left side of its answer, whose plain name comes too.

    Args:
        left: a key, or what stands left of a sign of equality.
        sheet: whose questions they are.
        writing: of the submission.
    """
    ids = {question.id.lower(): question for question in sheet.questions}
    found = ids.get(left.strip().lower())
    return (found, "") if found is not None else _asked(left, sheet, writing)


def _asked(left: str, sheet: Sheet, writing: Hand) -> tuple[Question | None, str]:
    """The question that a left side answers, and the plain name."""
    try:
        name = entry_name(left, "left side", writing) if left else ""
    except ExpressionError:
        return None, ""
    if not name:
        return None, ""
    for one in dict.fromkeys((name, _coordinate(name))):  # a sheet may have an x_e of its own
        for question in sheet.questions:
            if one in (
                question.entry,
                question.id,
                shown_entry(question.quantity),
                *question.answer,
            ):
                return question, one
    name = _coordinate(name)
    try:
        plain, index = split_name(claimed_of(name, sheet.robot))
    except KinlabError:
        return next(
            ((q, name) for q in sheet.questions if q.plain and name == _head(q)), (None, "")
        )
    for question in sheet.questions:
        if question.quantity and question.plain == plain:
            asked = split_name(question.quantity)[1]
            if not asked or asked == index:
                return question, name
    return None, ""


def _coordinate(name: str) -> str:
    """A coordinate without what says of which point it is: x of x_tool; others as they are."""
    found = _OF_TOOL.fullmatch(name)
    return found[1].lower() if found else name


def _head(question: Question) -> str:
    """The letter of a whole vector or matrix: M of mass_matrix."""
    if "[" in question.quantity or question.plain.endswith("energy"):
        return ""
    return ENTRY_LETTERS.get(question.plain, "")


def as_entries(question: Question, given: Mapping[str, str], sheet: Sheet) -> dict[str, str]:
    """The formulas of an answer as they were typed, under names that say what they claim to be.

    Raises:
        ExpressionError: a left side that is another entry's name.
    """
    whole = question.plain and "[" not in question.quantity
    strange = whole and not _names(question, question.entry, sheet)
    default = question.plain if strange else question.entry
    shown = shown_entry(question.entry)
    named: dict[str, str] = {}
    for name, text in given.items():
        text = without_unit(text, question, sheet) if question.answer else text
        if whole and several(text, default):
            named[default] = text
            continue
        said = claims(without_sentences(text, question.entry)[0], name or default) or name
        said = said if said == question.entry else _coordinate(said)
        if said in ("", question.id, question.entry, default, shown, _head(question)):
            named[default] = text
            continue
        if len(question.answer) == 1 and said not in question.answer:
            named[default] = _right_of(text)
            continue
        found, _name = _asked(said, sheet, hand([]))
        if said not in question.answer and (found is None or found.id != question.id):
            if not _names(question, said, sheet):
                other = _("the line begins with {name} =, and the question asks for {entry}")
                raise ExpressionError(other.format(name=said, entry=shown))
            said = default
        named[said] = text
    return named


def _right_of(text: str) -> str:
    """A formula without a name in front, whatever its writer calls it: tau = -k*q1."""
    left, sign, right = text.partition("=")
    if not sign or not is_name(left.strip("$ ")):
        return text
    return "$" * ("$" in left) + right.strip()


def _names(question: Question, said: str, sheet: Sheet) -> bool:
    """Whether a name is the question's, as books have it or by its only joint: tau of tau1."""
    robot = sheet.robot
    with suppress(ExpressionError):
        return question.quantity in (whole_claimed(said, robot) or claimed_of(said, robot), said)
    return False
