"""The pages: one for each student, one of the class. No script, nothing fetched."""

from __future__ import annotations

from collections import Counter
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment
from markupsafe import Markup

from kinlab.check.report import html as report
from kinlab.doctor.marking.marks import MISSING, WRONG, Mark, Marks
from kinlab.doctor.marking.words import told
from kinlab.host.language import _
from kinlab.host.version import __version__
from kinlab.host.web import page_text, policy, templates

_FOLDER = Path(__file__).parent
_REPORT = Path(report.__file__).parent
_BINS = 10


def student_page(marks: Marks, mark: Mark) -> str:
    """What one student sees."""
    rows = [
        {
            "question": question,
            "outcome": outcome,
            "tone": _tone(outcome),
            "pictures": [Markup(text) for text in (mark.pictures or {}).get(question.id, ())],
        }
        for question, outcome in zip(marks.sheet.questions, mark.outcomes, strict=True)
    ]
    return _render(
        "student.html.j2",
        title=marks.sheet.title,
        lead=_("{points:g} of {of:g} points").format(points=mark.total, of=mark.of),
        mark=mark,
        rows=rows,
        footer=_("Compared at {states} random states with Pinocchio; kinlab {version}.").format(
            states=marks.sheet.samples, version=__version__
        ),
    )


def class_page(marks: Marks) -> str:
    """What the teacher sees: marks, which slips, how often, who."""
    who: dict[tuple[str, str], list[Mark]] = {}
    for mark in marks.marks:
        for outcome in mark.outcomes:
            for kind in () if outcome.right else dict.fromkeys(outcome.kinds):
                who.setdefault((outcome.question, kind), []).append(mark)
    slips = [
        {
            "question": question,
            "kind": kind,
            "told": told((kind,)),
            "marks": found,
            "share": 100.0 * len(found) / len(marks.marks),
        }
        for (question, kind), found in sorted(who.items(), key=lambda i: (-len(i[1]), i[0]))
    ]
    questions = []
    for k, question in enumerate(marks.sheet.questions):
        verdicts = Counter(_tone(mark.outcomes[k]) for mark in marks.marks)
        questions.append({"question": question, "verdicts": verdicts})
    return _render(
        "class.html.j2",
        title=marks.sheet.title,
        lead=marks.summary,
        marks=marks,
        slips=slips,
        questions=questions,
        bins=_histogram(marks),
        odd=[mark for mark in marks.marks if mark.note],
        footer=_("Feedback to students: {feedback}. kinlab {version}.").format(
            feedback=marks.feedback, version=__version__
        ),
    )


def _tone(outcome: Any) -> str:
    if outcome.right:
        return "is-right"
    return {WRONG: "is-wrong", MISSING: "is-none"}.get(outcome.verdict, "is-unread")


def _histogram(marks: Marks) -> list[dict[str, Any]]:
    """How many submissions have how many points."""
    most = marks.sheet.points or 1.0
    counts = [0] * _BINS
    for mark in marks.marks:
        counts[min(_BINS - 1, int(_BINS * mark.total / most))] += 1
    highest = max([*counts, 1])
    return [
        {
            "from": f"{most * k / _BINS:g}",
            "to": f"{most * (k + 1) / _BINS:g}",
            "count": count,
            "height": 7.0 * count / highest,
        }
        for k, count in enumerate(counts)
    ]


def _render(template: str, **values: Any) -> str:
    style = (_REPORT / "report.css").read_text(encoding="utf-8")
    style += (_FOLDER / "marking.css").read_text(encoding="utf-8")
    values |= {"policy": Markup(policy()), "style": Markup(style)}
    return page_text(_environment().get_template(template).render(values))


@cache
def _environment() -> Environment:
    made = templates(_FOLDER, _REPORT)
    made.globals |= {"tone": _tone}
    return made
