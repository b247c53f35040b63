"""The marks of one answer, of a submission and of a class, as a program and a terminal see them."""

from __future__ import annotations

import hashlib
import html
import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, TypeVar

from kinlab.doctor.marking.sheet import Question, Sheet
from kinlab.doctor.marking.words import told
from kinlab.errors import NameUnknownError, near
from kinlab.host.introductions import Told
from kinlab.host.language import N_, _, ngettext

RIGHT = N_("right")
WRONG = N_("wrong")
UNREAD = N_("could not be read")
MISSING = N_("no answer")
FAULT = "fault"
"""The kind of an outcome that is no student's."""
_GRADES = {
    "": RIGHT,
    "rounded": N_("right with rounded numbers"),
    "unusual": N_("right but written unusually"),
}


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


def right_outcome(
    question: Question, forms: set[str], formulas: tuple[tuple[str, str], ...], remark: str = ""
) -> Outcome:
    """A right answer: as the sheet has it, or right in another way, which may cost something."""
    kind = next((form for form in ("unusual", "rounded") if form in forms), "")
    share = question.slips.get(kind, 0.0) if kind else 0.0
    got, most = round(question.points * (1.0 - share), 6), question.points
    about: dict[str, Any] = {"kinds": (kind,) if kind else (), "formulas": formulas}
    return Outcome(question.id, _GRADES[kind], got, most, remark=remark, **about)


def wrong_outcome(
    question: Question,
    points: float,
    kinds: tuple[str, ...],
    place: str,
    answer: tuple[str, ...] = (),
    formulas: tuple[tuple[str, str], ...] = (),
) -> Outcome:
    """A wrong answer: what is left of its points, and all that can be told of it."""
    said = told(kinds)
    most = question.points
    return Outcome(question.id, WRONG, points, most, kinds, (), place, said, answer, formulas)


def points_left(question: Question, kinds: Iterable[str]) -> float:
    """What is left of a question's points after slips of these kinds."""
    cost = math.fsum(question.slips.get(kind, question.slips.get("other", 1.0)) for kind in kinds)
    return round(question.points * max(0.0, 1.0 - cost), 6)


def lost(question: Question, remark: str, written: tuple[str, ...] = ()) -> Outcome:
    """An answer that could not be read."""
    return Outcome(question.id, UNREAD, 0.0, question.points, ("unread",), written, remark=remark)


def failed(question: Question, problem: Exception, written: tuple[str, ...] = ()) -> Outcome:
    """An answer on which kinlab itself failed: nobody's slip, and not kept for the next run."""
    said = _("kinlab itself failed on this answer ({error}); mark it by hand, and tell us")
    remark = said.format(error=type(problem).__name__)
    return replace(lost(question, remark, written), kinds=(FAULT,))


def missing(question: Question) -> Outcome:
    """No answer."""
    return Outcome(question.id, MISSING, 0.0, question.points)


@dataclass(frozen=True, repr=False)
class Mark(Told):
    """One submission, marked.

    Attributes:
        file: its name in the folder.
        student, name: who, as far as it says so.
        outcomes: question by question, in the order of the sheet.
        note: what a person should look at.
        slug: what its page and results are called.
        pictures: question id to its formulas as MathML, for the page.
        aside: what is said of how it was read and run; nobody has to look at it.
        unread: why nothing of it could be read.
        stranger: that its student is in no list of ids, where there is one.
    """

    file: str
    student: str
    name: str
    outcomes: tuple[Outcome, ...]
    note: str = ""
    slug: str = ""
    pictures: Mapping[str, tuple[str, ...]] | None = None
    aside: str = ""
    unread: str = ""
    stranger: str = ""

    @property
    def total(self) -> float:
        """All points."""
        return round(math.fsum(outcome.points for outcome in self.outcomes), 6)

    @property
    def failed(self) -> bool:
        """Whether kinlab itself failed on any of its answers."""
        return any(FAULT in outcome.kinds for outcome in self.outcomes)

    @property
    def of(self) -> float:
        """The points of a submission with everything right."""
        return round(math.fsum(outcome.of for outcome in self.outcomes), 6)

    def __getitem__(self, question: str) -> Outcome:
        return _called("question", question, {one.question: one for one in self.outcomes})

    def __str__(self) -> str:
        said = _("{student}: {points:g} of {of:g} points")
        lines = [said.format(student=self.student, points=self.total, of=self.of)]
        for one in self.outcomes:
            told = (one.place, one.cause, *one.answer, one.remark)
            reason = _("; ").join(text for text in told if text)
            said = _("  {question}: {verdict}, {points:g} of {of:g}")
            if reason:
                said = _("  {question}: {verdict}, {points:g} of {of:g}: {reason}")
            fields = {"question": one.question, "verdict": _(one.verdict), "reason": reason}
            lines.append(said.format(points=one.points, of=one.of, **fields))
        return "\n".join(lines)


@dataclass(frozen=True, eq=False)
class Marks:
    """A class, marked.

    Attributes:
        sheet: with which it was marked.
        marks: one for each student, in the order of their ids.
        feedback: how much is told.
        not_read: files beside the submissions that are of another kind.
        withdrawn: of how many earlier submissions that are no longer there the pages were removed.
    """

    sheet: Sheet
    marks: tuple[Mark, ...]
    feedback: str
    not_read: tuple[str, ...] = ()
    withdrawn: int = 0

    def __getitem__(self, student: str) -> Mark:
        return _called("student", student, {mark.student: mark for mark in self.marks[::-1]})

    def __len__(self) -> int:
        return len(self.marks)

    def slips(self) -> Counter[tuple[str, str]]:
        """How often each kind of slip was made, by question."""
        return Counter(
            (outcome.question, kind)
            for mark in self.marks
            for outcome in mark.outcomes
            if not outcome.right and outcome.verdict != UNREAD
            for kind in dict.fromkeys(outcome.kinds)
        )

    def said(self) -> list[str]:
        """What a teacher should hear at once: files that are not read, and why."""
        lines = [mark.stranger for mark in self.marks if mark.stranger]
        lines += [mark.unread for mark in self.marks if mark.unread]
        for mark in self.marks:
            if mark.failed and not mark.unread:
                said = _("{file}: kinlab itself failed on an answer; mark it by hand, and tell us")
                lines.insert(0, said.format(file=mark.file))
        if self.withdrawn:
            said = ngettext(
                "the page of {count} earlier submission that is no longer there was removed",
                "the pages of {count} earlier submissions that are no longer there were removed",
                self.withdrawn,
            )
            lines.append(said.format(count=self.withdrawn))
        if self.not_read:
            said = _("not read: {names}").format(names=several(self.not_read))
            lines.insert(0, said)
        return lines

    def __str__(self) -> str:
        return _("{title}: {summary}").format(title=self.sheet.title, summary=self.summary)

    @property
    def summary(self) -> str:
        """How many there are, and how they did."""
        if not self.marks:
            return _("no submissions")
        mean = math.fsum(mark.total for mark in self.marks) / len(self.marks)
        unread = sum(
            one.verdict == UNREAD for m in self.marks if not m.unread for one in m.outcomes
        )
        text = ngettext(
            "{count} submission, mean {mean:.2f} of {of:g} points",
            "{count} submissions, mean {mean:.2f} of {of:g} points",
            len(self.marks),
        ).format(count=len(self.marks), mean=mean, of=self.sheet.points)
        if not unread:
            return text
        return ngettext(
            "{told}; {count} answer could not be read",
            "{told}; {count} answers could not be read",
            unread,
        ).format(told=text, count=unread)

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{html.escape(m.student)}</td><td>{points(m.total, m.of)}</td></tr>"
            for m in self.marks
        )
        return f"<p><b>{html.escape(str(self))}</b></p><table>{rows}</table>"


def several(names: Sequence[str], most: int = 20) -> str:
    """Names in a line, and how many more there are.

    Args:
        names: to be told.
        most: how many are.
    """
    told = _(", ").join(names[:most])
    left = len(names) - most
    if left <= 0:
        return told
    return ngettext("{names} and {count} more", "{names} and {count} more", left).format(
        names=told, count=left
    )


T = TypeVar("T")


def _called(what: str, name: str, known: Mapping[str, T]) -> T:
    if name not in list(known):  # a list asks for no hash
        raise NameUnknownError(f"{what} {name!r} is unknown; {near(name, known)}")
    return known[name]


def points(got: float, of: float) -> str:
    """``3 of 4``."""
    return _("{points:g} of {of:g}").format(points=got, of=of)


def slug_of(shown: str) -> str:
    """A name for files that is safe everywhere, and different for different submissions."""
    stem = shown.removesuffix(".toml")
    clean = re.sub(r"[^A-Za-z0-9_-]", "-", stem).strip("-")[:48]
    if clean and clean == stem:
        return clean
    digest = hashlib.sha256(shown.encode("utf-8", "replace")).hexdigest()
    return f"{clean or 'submission'}-{digest[:8]}"
