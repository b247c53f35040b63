"""The marks of one submission and of a class, as a program, a terminal and a notebook see them."""

from __future__ import annotations

import hashlib
import html
import math
import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from kinlab.doctor.marking.judge import UNREAD, Outcome
from kinlab.doctor.marking.sheet import Sheet
from kinlab.errors import NameUnknownError, near
from kinlab.host.introductions import Told
from kinlab.host.language import _, ngettext


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
    """

    file: str
    student: str
    name: str
    outcomes: tuple[Outcome, ...]
    note: str = ""
    slug: str = ""
    pictures: Mapping[str, tuple[str, ...]] | None = None

    @property
    def total(self) -> float:
        """All points."""
        return round(math.fsum(outcome.points for outcome in self.outcomes), 6)

    @property
    def of(self) -> float:
        """The points of a submission with everything right."""
        return round(math.fsum(outcome.of for outcome in self.outcomes), 6)

    def __getitem__(self, question: str) -> Outcome:
        for outcome in self.outcomes:
            if outcome.question == question:
                return outcome
        names = [outcome.question for outcome in self.outcomes]
        raise NameUnknownError(f"question {question!r} is unknown; {near(question, names)}")

    def __str__(self) -> str:
        said = _("{student}: {points:g} of {of:g} points")
        lines = [said.format(student=self.student, points=self.total, of=self.of)]
        for one in self.outcomes:
            told = (one.place, one.cause, *one.answer, one.remark)
            reason = _("; ").join(text for text in told if text)
            said = (
                _("  {question}: {verdict}, {points:g} of {of:g}: {reason}")
                if reason
                else _("  {question}: {verdict}, {points:g} of {of:g}")
            )
            verdict = _(one.verdict)
            fields = {"question": one.question, "verdict": verdict, "reason": reason}
            lines.append(said.format(points=one.points, of=one.of, **fields))
        return "\n".join(lines)


@dataclass(frozen=True, eq=False)
class Marks:
    """A class, marked.

    Attributes:
        sheet: with which it was marked.
        marks: one for each submission, in the order of the students' ids.
        feedback: how much is told.
    """

    sheet: Sheet
    marks: tuple[Mark, ...]
    feedback: str

    def __getitem__(self, student: str) -> Mark:
        for mark in self.marks:
            if mark.student == student:
                return mark
        names = [mark.student for mark in self.marks]
        raise NameUnknownError(f"student {student!r} is unknown; {near(student, names)}")

    def __len__(self) -> int:
        return len(self.marks)

    def slips(self) -> Counter[tuple[str, str]]:
        """How often each kind of slip was made, by question."""
        return Counter(
            (outcome.question, kind)
            for mark in self.marks
            for outcome in mark.outcomes
            if not outcome.right
            for kind in dict.fromkeys(outcome.kinds)
        )

    def __str__(self) -> str:
        return _("{title}: {summary}").format(title=self.sheet.title, summary=self.summary)

    @property
    def summary(self) -> str:
        """How many there are, and how they did."""
        if not self.marks:
            return _("no submissions")
        mean = math.fsum(mark.total for mark in self.marks) / len(self.marks)
        unread = sum(one.verdict == UNREAD for m in self.marks for one in m.outcomes)
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
