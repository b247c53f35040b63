"""The sheet: title, robot, questions, points, what each kind of slip costs, how much is told.

A sheet is a TOML file::

    title = "Homework 3"
    robot = "planar2r"            # a name, or a path beside the sheet
    feedback = "place"            # verdict, place, cause or answer

    [slips]                       # shares of a question's points; what is not named costs all
    sign = 0.25

    [variation]                   # every student gets numbers of his own
    seed = 3
    spread = 0.2                  # up to 20 % up and down

    [[questions]]
    id = "q1"
    text = "The torque of joint 1."
    entry = "tau1"                # or quantity = "mass_matrix", or answer = "l1*c1 + l2*c12"
    points = 4
    slips = { sign = 0.5 }

Beside an answer of the sheet's own an entry is only what the formula is called. Names in it that
the robot does not have stand in the question's text, from which students know them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.check.quantities.registry import split_name
from kinlab.doctor.changes import Mechanism
from kinlab.doctor.examine import prepare
from kinlab.doctor.linkages.mechanisms import domain_of, mechanism_beside
from kinlab.doctor.marking.words import KINDS
from kinlab.doctor.text.claims import claimed_of, whole_claimed
from kinlab.errors import FileError, KinlabError, near
from kinlab.fivebar import FiveBar
from kinlab.formulas.typed import entry_name
from kinlab.host.files import read_text, read_toml

FEEDBACK = ("verdict", "place", "cause", "answer")
"""How much a student is told, from little to all."""

_LIMIT = 1 << 20
_QUESTIONS = 100
_ID = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,31}")
_SHEET = ("title", "robot", "feedback", "samples", "seed", "slips", "variation", "questions")
_QUESTION = ("id", "text", "title", "entry", "quantity", "answer", "points", "slips", "tolerance")


class SheetError(FileError):
    """A sheet that cannot be used: which key, where, and what would be right."""


@dataclass(frozen=True)
class Question:
    """One question.

    Attributes:
        id: what a submission calls it.
        text: for people.
        quantity: what the engine is asked, such as ``"inverse_dynamics[0]"``; empty where the
            sheet has a model answer of its own.
        entry: what the formula is called: ``"tau1"``.
        answer: the sheet's own model answer, by entry; empty where the engine knows.
        points: for a right answer.
        slips: what a kind of slip costs, a share of the points.
        tolerance: relative error up to which an own model answer is met.
    """

    id: str
    text: str
    quantity: str
    entry: str
    answer: Mapping[str, str]
    points: float
    slips: Mapping[str, float]
    tolerance: float = 1e-6

    @property
    def plain(self) -> str:
        """The whole quantity that the question is about."""
        return split_name(self.quantity)[0] if self.quantity else ""


@dataclass(frozen=True)
class Variation:
    """Numbers of the robot that differ from student to student.

    Attributes:
        seed: with the student's id it gives the numbers.
        names: which ones, such as ``l1``; empty: all but gravity.
        spread: share by which they go up or down.
    """

    seed: int
    names: tuple[str, ...] = ()
    spread: float = 0.2


@dataclass(frozen=True, eq=False)
class Sheet:
    """Questions about one robot; see the module's docstring for the file.

    Attributes:
        place: the file, for messages.
        title, robot, feedback, questions: as in the file.
        variation: None where all students have the same numbers.
        samples, seed: the states at which formulas are compared.
        text: of the file, for the fingerprint of what was marked with it.
    """

    place: str
    title: str
    robot: Mechanism
    feedback: str
    questions: tuple[Question, ...]
    variation: Variation | None = None
    samples: int = 60
    seed: int = 0
    text: str = field(default="", repr=False)

    @property
    def points(self) -> float:
        """Of all questions together."""
        return math.fsum(question.points for question in self.questions)


def read_sheet(path: str | Path) -> Sheet:
    """Reads a sheet.

    Raises:
        SheetError: a key that is missing, unknown or of the wrong kind; the message has the key,
            its place and what would be right.
        FileError: the file cannot be read.
    """
    text = read_text(path, limit=_LIMIT)
    return sheet_of(read_toml(text, str(path), SheetError), str(path), text)


def sheet_of(document: Mapping[str, Any], place: str, text: str = "") -> Sheet:
    """A sheet from what its file holds; see :func:`read_sheet`."""
    _refuse_unknown(document, _SHEET, place)
    robot = _robot(document, place)
    feedback = document.get("feedback", "place")
    if not isinstance(feedback, str) or feedback not in FEEDBACK:
        raise SheetError(f"{place}: feedback is {feedback!r}; {near(str(feedback), FEEDBACK)}")
    slips = _slips(document.get("slips", {}), f"{place}: [slips]")
    rows = document.get("questions")
    if not isinstance(rows, list) or not rows or not all(isinstance(row, dict) for row in rows):
        raise SheetError(f"{place}: questions are missing; write [[questions]] for each")
    if len(rows) > _QUESTIONS:
        raise SheetError(f"{place}: {len(rows)} questions; at most {_QUESTIONS}")
    questions = tuple(
        _question(row, robot, slips, f"{place}: question {k}") for k, row in enumerate(rows, 1)
    )
    taken: set[str] = set()
    for question in questions:
        if question.id.lower() in taken:
            raise SheetError(
                f"{place}: two questions have the id {question.id!r}; give each its own"
            )
        taken.add(question.id.lower())
    title = _text(document, "title", place) or "Marks"
    return Sheet(
        place,
        title,
        robot,
        feedback,
        questions,
        _variation(document.get("variation"), robot, f"{place}: [variation]"),
        _whole(document, "samples", 60, 10, 1000, place),
        _whole(document, "seed", 0, 0, 2**31, place),
        text,
    )


def _robot(document: Mapping[str, Any], place: str) -> Mechanism:
    name = document.get("robot")
    if not isinstance(name, str) or not name:
        raise SheetError(f'{place}: robot is missing; write robot = "planar2r" or a path')
    try:
        return mechanism_beside(name, place)
    except KinlabError as problem:
        raise SheetError(f"{place}: robot: {problem}") from None


def _question(
    row: Mapping[str, Any], robot: Mechanism, common: Mapping[str, float], place: str
) -> Question:
    _refuse_unknown(row, _QUESTION, place)
    name = row.get("id")
    if not isinstance(name, str) or not _ID.fullmatch(name):
        raise SheetError(f'{place}: id is {name!r}; write a short word such as id = "q1"')
    place = f"{place} ({name})"
    given = [key for key in ("quantity", "answer") if key in row]
    if len(given) == 2:
        raise SheetError(f"{place}: quantity and answer are both given; keep one")
    entry = _text(row, "entry", place)
    if not given and not entry:
        raise SheetError(f'{place}: what is asked? write entry = "tau1", quantity or answer')
    try:
        entry = entry_name(entry, place) if entry else entry
        if given == ["answer"]:
            quantity = ""
            _require_own(entry, robot, place)
        else:
            quantity = _asked(row, entry, robot, place)
    except KinlabError as problem:
        raise SheetError(str(problem) if place in str(problem) else f"{place}: {problem}") from None
    points = _number(row, "points", 1.0, place)
    if points > 1e4:
        raise SheetError(f"{place}: points is {points:g}; at most 10000")
    return Question(
        name,
        _text(row, "text", place) or _text(row, "title", place) or entry or quantity,
        quantity,
        entry or quantity or name,
        _answers(row.get("answer"), entry or name, place),
        points,
        {**common, **_slips(row.get("slips", {}), f"{place}: slips")},
        _number(row, "tolerance", 1e-6, place),
    )


def _require_own(entry: str, robot: Mechanism, place: str) -> None:
    """Refuses a name for an own answer that asks the engine, which would go unheard."""
    try:
        known = whole_claimed(entry, robot) or claimed_of(entry, robot) if entry else ""
    except KinlabError:
        return
    if known:
        raise SheetError(
            f"{place}: entry {entry!r} is {known}, which is compared with the engine, and answer "
            f"is given too; keep one (with an answer, entry is a name of its own, such as F)"
        )


def _asked(row: Mapping[str, Any], entry: str, robot: Mechanism, place: str) -> str:
    quantity = _text(row, "quantity", place)
    if not quantity:
        quantity = whole_claimed(entry, robot) or claimed_of(entry, robot)
    plain, index = split_name(quantity)
    if any(isinstance(k, slice) for k in index):
        raise SheetError(f"{place}: {quantity} is a range; ask for one entry, or for all")
    if find_quantity(plain).domain is not domain_of(robot):
        raise SheetError(f"{place}: {plain} is no quantity of {robot.name}; give an answer")
    try:
        prepare(robot, plain, index, 10, 0)
    except IndexError:
        kind = "" if isinstance(robot, FiveBar) else f" of {robot.n} joints"
        raise SheetError(f"{place}: {robot.name}{kind} has no {entry or quantity}") from None
    return quantity


def _answers(value: Any, entry: str, place: str) -> dict[str, str]:
    if value is None:
        return {}
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        value = repr(value)
    if isinstance(value, str):
        return {entry: value}
    if isinstance(value, dict) and value and all(isinstance(v, str) for v in value.values()):
        return dict(value)
    raise SheetError(f"{place}: answer is {type(value).__name__}; write the formula as text")


def _slips(value: Any, place: str) -> dict[str, float]:
    if not isinstance(value, dict):
        raise SheetError(f"{place}: {type(value).__name__}; write kinds and shares: sign = 0.25")
    costs: dict[str, float] = {}
    for kind, cost in value.items():
        if kind not in KINDS:
            raise SheetError(f"{place}: {kind!r} is no kind of slip; {near(kind, KINDS)}")
        if isinstance(cost, bool) or not isinstance(cost, (int, float)) or not 0 <= cost <= 1:
            raise SheetError(f"{place}: {kind} = {cost!r}; a share of the points, from 0 to 1")
        costs[kind] = float(cost)
    return costs


def _variation(value: Any, robot: Mechanism, place: str) -> Variation | None:
    if value is None:
        return None
    if not isinstance(value, dict):
        raise SheetError(f"{place}: {type(value).__name__}; write seed and spread")
    _refuse_unknown(value, ("seed", "names", "spread"), place)
    if isinstance(robot, FiveBar) or robot.table is None:
        raise SheetError(f"{place}: {robot.name} has no DH table; only such a robot can be varied")
    names = value.get("names", [])
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise SheetError(f'{place}: names; write a list such as ["l1", "m2"]')
    from kinlab.symbolic.vocabulary import vocabulary

    words = vocabulary(robot.table).values
    for name in names:
        if name not in words:
            raise SheetError(f"{place}: names: {robot.name} has no {name!r}; {near(name, words)}")
    spread = _number(value, "spread", 0.2, place)
    if not 0 < spread <= 0.9:
        raise SheetError(f"{place}: spread is {spread:g}; a share above 0 and up to 0.9")
    return Variation(_whole(value, "seed", 0, 0, 2**31, place), tuple(names), spread)


def _refuse_unknown(table: Mapping[str, Any], known: tuple[str, ...], place: str) -> None:
    for key in table:
        if key not in known:
            raise SheetError(f"{place}: key {key!r} is unknown; {near(str(key), known)}")


def _text(table: Mapping[str, Any], key: str, place: str) -> str:
    value = table.get(key, "")
    if not isinstance(value, str):
        raise SheetError(f"{place}: {key} is {type(value).__name__}; write text in quotes")
    return value.strip()


def _number(table: Mapping[str, Any], key: str, default: float, place: str) -> float:
    value = table.get(key, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise SheetError(f"{place}: {key} is {type(value).__name__}; write a number")
    if not (math.isfinite(value) and value >= 0):
        raise SheetError(f"{place}: {key} is {value}; write a number from 0 up")
    return float(value)


def _whole(
    table: Mapping[str, Any], key: str, default: int, least: int, most: int, place: str
) -> int:
    value = table.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise SheetError(f"{place}: {key} is {value!r}; a whole number from {least} to {most}")
    return value
