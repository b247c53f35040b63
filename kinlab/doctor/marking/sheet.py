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
    ids = "ids.txt"               # the students' ids, beside the sheet: a mistyped one is told

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
from kinlab.errors import FileError, KinlabError
from kinlab.fivebar import FiveBar
from kinlab.formulas.signs.refusals import near_names
from kinlab.formulas.typed import entry_name
from kinlab.host.files import read_text, read_toml
from kinlab.host.language import _

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
        ids: a file of the students' ids, by which a mistyped one is seen; empty: none is named.
    """

    seed: int
    names: tuple[str, ...] = ()
    spread: float = 0.2
    ids: str = ""


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


def _refused(place: str, sentence: str, **fields: Any) -> SheetError:
    return SheetError(f"{place}: {sentence.format(**fields)}")


def _typed(value: Any) -> str:
    """What stands in the sheet, for people: as TOML has it."""
    if value is None:
        return _("missing")
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value)[:40]


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
        said = _("feedback is {value}; {choices}")
        choices = near_names(str(feedback), FEEDBACK)
        raise _refused(place, said, value=repr(feedback), choices=choices)
    slips = _slips(document.get("slips", {}), f"{place}: [slips]")
    rows = document.get("questions")
    if not isinstance(rows, list) or not rows or not all(isinstance(row, dict) for row in rows):
        raise _refused(place, _("questions are missing; write [[questions]] for each"))
    if len(rows) > _QUESTIONS:
        said = _("{count} questions; at most {most}")
        raise _refused(place, said, count=len(rows), most=_QUESTIONS)
    questions = tuple(
        _question(row, robot, slips, f"{place}: " + _("question {number}").format(number=k))
        for k, row in enumerate(rows, 1)
    )
    taken: set[str] = set()
    for question in questions:
        if question.id.lower() in taken:
            said = _("two questions have the id {id}; give each its own")
            raise _refused(place, said, id=repr(question.id))
        taken.add(question.id.lower())
    title = _text(document, "title", place) or "Marks"
    return Sheet(
        place,
        title,
        robot,
        feedback,
        questions,
        _variation(document.get("variation"), robot, f"{place}: [variation]", Path(place).parent),
        _whole(document, "samples", 60, 10, 1000, place),
        _whole(document, "seed", 0, 0, 2**31, place),
        text,
    )


def _robot(document: Mapping[str, Any], place: str) -> Mechanism:
    name = document.get("robot")
    if not isinstance(name, str) or not name:
        raise _refused(place, _('robot is missing; write robot = "planar2r" or a path'))
    try:
        return mechanism_beside(name, place)
    except KinlabError as problem:
        raise _refused(place, _("robot: {problem}"), problem=problem) from None


def _question(
    row: Mapping[str, Any], robot: Mechanism, common: Mapping[str, float], place: str
) -> Question:
    _refuse_unknown(row, _QUESTION, place)
    name = row.get("id")
    if not isinstance(name, str) or not _ID.fullmatch(name):
        said = _(
            'id is {value}; write id = "q1": a letter, then letters, digits, _ and -, 32 at most'
        )
        raise _refused(place, said, value=_typed(name))
    place = f"{place} ({name})"
    given = [key for key in ("quantity", "answer") if key in row]
    if len(given) == 2:
        raise _refused(place, _("quantity and answer are both given; keep one"))
    entry = _text(row, "entry", place)
    if not given and not entry:
        raise _refused(place, _('what is asked? write entry = "tau1", quantity or answer'))
    try:
        entry = entry_name(entry, place) if entry else entry
        if given == ["answer"]:
            quantity = ""
            _require_own(entry, robot, place)
        else:
            quantity = _asked(row, entry, robot, place)
    except KinlabError as problem:
        raise SheetError(str(problem) if place in str(problem) else f"{place}: {problem}") from None
    if "tolerance" in row and given != ["answer"]:
        said = _("tolerance goes with an answer of your own; an entry is compared with the engine")
        raise _refused(place, said)
    points = _number(row, "points", 1.0, place)
    if points > 1e4:
        raise _refused(place, _("points is {value:g}; at most 10000"), value=points)
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
        said = _(
            "entry {entry} is {known}, which is compared with the engine, and answer is given too; "
            "keep one (with an answer, entry is a name of its own, such as F)"
        )
        raise _refused(place, said, entry=repr(entry), known=known)


def _asked(row: Mapping[str, Any], entry: str, robot: Mechanism, place: str) -> str:
    quantity = _text(row, "quantity", place)
    if not quantity:
        quantity = whole_claimed(entry, robot) or claimed_of(entry, robot)
    plain, index = split_name(quantity)
    kind = find_quantity(plain)
    if kind.read is not None and index:
        said = _(
            "{entry}: joint positions are judged together, by where they put the tool; write "
            "quantity = {quantity}, without entry"
        )
        raise _refused(place, said, entry=repr(entry or quantity), quantity=f'"{plain}"')
    if any(isinstance(k, int) and k < 0 for k in index):
        said = _("there is no {entry}: entries of matrices are counted from 1")
        raise _refused(place, said, entry=repr(entry or quantity))
    if any(isinstance(k, slice) for k in index):
        said = _("{quantity} is a range; ask for one entry, or for all")
        raise _refused(place, said, quantity=quantity)
    if kind.domain is not domain_of(robot):
        said = _("{quantity} is no quantity of {robot}; give an answer")
        raise _refused(place, said, quantity=plain, robot=robot.name)
    try:
        prepare(robot, plain, index, 10, 0)
    except IndexError:
        asked = entry or quantity
        if isinstance(robot, FiveBar):
            said = _("{robot} has no {entry}").format(robot=robot.name, entry=asked)
        else:
            said = _("{robot} of {count} joints has no {entry}")
            said = said.format(robot=robot.name, count=robot.n, entry=asked)
        raise SheetError(f"{place}: {said}") from None
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
    said = _("answer is {value}; write the formula as text")
    raise _refused(place, said, value=_typed(value))


def _slips(value: Any, place: str) -> dict[str, float]:
    if not isinstance(value, dict):
        raise _refused(place, _("write kinds of slips and shares: sign = 0.25"))
    costs: dict[str, float] = {}
    for kind, cost in value.items():
        if kind not in KINDS:
            said, choices = _("{kind} is no kind of slip; {choices}"), near_names(kind, KINDS)
            raise _refused(place, said, kind=repr(kind), choices=choices)
        if isinstance(cost, bool) or not isinstance(cost, (int, float)) or not 0 <= cost <= 1:
            said = _("{kind} = {value}; a share of the points, from 0 to 1")
            raise _refused(place, said, kind=kind, value=repr(cost))
        costs[kind] = float(cost)
    return costs


def _variation(value: Any, robot: Mechanism, place: str, beside: Path) -> Variation | None:
    if value is None:
        return None
    if not isinstance(value, dict):
        raise _refused(place, _("write seed and spread"))
    _refuse_unknown(value, ("seed", "names", "spread", "ids"), place)
    if isinstance(robot, FiveBar) or robot.table is None:
        said = _("{robot} has no DH table; only such a robot can be varied")
        raise _refused(place, said, robot=robot.name)
    names = value.get("names", [])
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise _refused(place, _('names; write a list such as ["l1", "m2"]'))
    from kinlab.symbolic.vocabulary import vocabulary

    words = vocabulary(robot.table).values
    for name in names:
        if name not in words:
            said, choices = _("names: {robot} has no {name}; {choices}"), near_names(name, words)
            raise _refused(place, said, robot=robot.name, name=repr(name), choices=choices)
    spread = _number(value, "spread", 0.2, place)
    if not 0 < spread <= 0.9:
        said = _("spread is {value:g}; a share above 0 and up to 0.9")
        raise _refused(place, said, value=spread)
    ids = _text(value, "ids", place)
    seed = _whole(value, "seed", 0, 0, 2**31, place)
    return Variation(seed, tuple(names), spread, str(beside / ids) if ids else "")


def _refuse_unknown(table: Mapping[str, Any], known: tuple[str, ...], place: str) -> None:
    for key in table:
        if key not in known:
            said, choices = _("key {key} is unknown; {choices}"), near_names(str(key), known)
            raise _refused(place, said, key=repr(key), choices=choices)


def _text(table: Mapping[str, Any], key: str, place: str) -> str:
    value = table.get(key, "")
    if not isinstance(value, str):
        said = _("{key} is {value}; write text in quotes")
        raise _refused(place, said, key=key, value=_typed(value))
    return value.strip()


def _number(table: Mapping[str, Any], key: str, default: float, place: str) -> float:
    value = table.get(key, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        said = _("{key} is {value}; write a number")
        raise _refused(place, said, key=key, value=_typed(value))
    if not (math.isfinite(value) and value >= 0):
        said = _("{key} is {value}; write a number from 0 up")
        raise _refused(place, said, key=key, value=value)
    return float(value)


def _whole(
    table: Mapping[str, Any], key: str, default: int, least: int, most: int, place: str
) -> int:
    value = table.get(key, default)
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        said = _("{key} is {value}; a whole number from {least} to {most}")
        raise _refused(place, said, key=key, value=_typed(value), least=least, most=most)
    return value
