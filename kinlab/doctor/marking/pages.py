"""The pages: one for each student, one of the class. No script, nothing fetched."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment
from lxml import etree
from markupsafe import Markup, escape

from kinlab.check.report import html as report
from kinlab.doctor.marking.marks import MISSING, UNREAD, WRONG, Mark, Marks
from kinlab.doctor.marking.words import told
from kinlab.errors import KinlabError
from kinlab.formulas.text import parse
from kinlab.formulas.typeset import equation, mathml
from kinlab.host.language import N_, _
from kinlab.host.version import __version__
from kinlab.host.web import page_text, policy, templates

_FOLDER = Path(__file__).parent
_REPORT = Path(report.__file__).parent
_BINS = 10


_LEVELS = {
    "verdict": N_("verdict"),
    "place": N_("place"),
    "cause": N_("cause"),
    "answer": N_("answer"),
}
_TONES = (
    ("is-right", N_("right")),
    ("is-wrong", N_("wrong")),
    ("is-unread", N_("not read")),
    ("is-none", N_("no answer")),
)


def student_page(marks: Marks, mark: Mark) -> str:
    """What one student sees."""
    rows = [
        {
            "question": question,
            "outcome": outcome,
            "tone": _tone(outcome),
            "pictures": [Markup(text) for text in (mark.pictures or {}).get(question.id, ())],
            "answer": _answer(outcome.answer),
            "remark": "" if mark.unread else outcome.remark,
        }
        for question, outcome in zip(marks.sheet.questions, mark.outcomes, strict=True)
    ]
    compared = any(outcome.verdict not in (MISSING, UNREAD) for outcome in mark.outcomes)
    said = _("Compared at {states} random states with Pinocchio; kinlab {version}.")
    fields = {"states": marks.sheet.samples, "version": __version__}
    return _render(
        "student.html.j2",
        title=marks.sheet.title,
        lead=_("{points:g} of {of:g} points").format(points=mark.total, of=mark.of),
        mark=mark,
        rows=rows,
        footer=said.format(**fields) if compared else f"kinlab {__version__}",
    )


def class_page(marks: Marks) -> str:
    """What the teacher sees: marks, which slips, how often, who."""
    who: dict[tuple[str, str], list[Mark]] = {}
    lost: dict[tuple[str, str], list[Mark]] = {}
    asides: dict[str, list[Mark]] = {}
    for mark in marks.marks:
        if mark.aside:
            asides.setdefault(mark.aside, []).append(mark)
        for outcome in mark.outcomes:
            if outcome.verdict == UNREAD and not mark.unread:
                lost.setdefault((outcome.question, outcome.remark), []).append(mark)
            elif not outcome.right and outcome.verdict != UNREAD:
                for kind in dict.fromkeys(outcome.kinds):
                    who.setdefault((outcome.question, kind), []).append(mark)
    questions = []
    for k, question in enumerate(marks.sheet.questions):
        verdicts = Counter(_tone(mark.outcomes[k]) for mark in marks.marks)
        questions.append({"question": question, "verdicts": verdicts})
    odd = [mark for mark in marks.marks if mark.note or mark.unread]
    return _render(
        "class.html.j2",
        title=marks.sheet.title,
        lead=marks.summary,
        marks=marks,
        slips=[_slip(*one, len(marks.marks)) for one in sorted(who.items(), key=_often)],
        lost=[(*key, found) for key, found in sorted(lost.items())],
        asides=sorted(asides.items()),
        questions=questions,
        tones=_TONES,
        bins=_histogram(marks),
        odd=sorted(odd, key=lambda mark: not mark.unread),  # stable
        named=any(mark.name for mark in marks.marks),
        footer=_("Feedback to students: {feedback}. kinlab {version}.").format(
            feedback=_(_LEVELS[marks.feedback]), version=__version__
        ),
    )


def _often(slip: tuple[tuple[str, str], list[Mark]]) -> Any:
    """The order of slips: those that are known first, the most frequent of them first."""
    (question, kind), found = slip
    return kind == "unknown", -len(found), question, kind


def _slip(slip: tuple[str, str], found: list[Mark], count: int) -> dict[str, Any]:
    share = 100.0 * len(found) / count
    return {"question": slip[0], "told": told((slip[1],)), "marks": found, "share": share}


# -------- Formulas

_ENTRY = re.compile(r"(.+)_\{(\d)(\d)\}")
_WIDEST = 300
"""Characters of LaTeX in a row of a matrix, above which its entries stand below each other."""
_CODE, _LATEX = re.compile(r"`([^`]*)`"), re.compile(r"\\|[_^]\{")


def pictures_of(formulas: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    """Formulas as MathML; the entries of a whole matrix in its rows.

    Args:
        formulas: names and formulas, both as LaTeX.
    """
    return tuple(_picture(f"{name} = {latex}") for name, latex in _in_rows([*formulas]))


def _picture(latex: str) -> str:
    """MathML; an exponent stands behind an index, since few machines have a font to stack them."""
    text = mathml(latex)
    if "msubsup" not in text:
        return text
    root = etree.fromstring(text)
    for element in [*root.iter("{*}msubsup")]:
        space = etree.QName(element).namespace
        base, below, above = element
        inner = etree.Element(f"{{{space}}}msub")
        inner.extend([base, below])
        element.tag = f"{{{space}}}msup"
        element[:] = [inner, above]
    return str(etree.tostring(root, encoding="unicode"))


def _in_rows(formulas: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """The entries of one matrix as one formula, where all are there and none is long."""
    found = [_ENTRY.fullmatch(name) for name, _latex in formulas]
    if len(formulas) < 4 or not all(found):
        return formulas
    heads = {one[1] for one in found if one}
    places = [(int(one[2]), int(one[3])) for one in found if one]
    cells = dict(zip(places, (latex for _name, latex in formulas), strict=True))
    rows, columns = (max(place) for place in zip(*cells, strict=True))
    whole = {(i, k) for i in range(1, rows + 1) for k in range(1, columns + 1)}
    lines = [[cells.get((i, k), "") for k in range(1, columns + 1)] for i in range(1, rows + 1)]
    broken = any("array" in text for text in cells.values())
    if len(heads) > 1 or cells.keys() != whole or broken:
        return formulas
    if max(sum(map(len, line)) for line in lines) > _WIDEST:
        return formulas
    inside = r" \\ ".join(" & ".join(line) for line in lines)
    return [(heads.pop(), rf"\left[\begin{{matrix}} {inside} \end{{matrix}}\right]")]


def _answer(texts: Iterable[str]) -> list[Markup]:
    """The doctor's sentence, and the right formulas set as the others are.

    A sentence about pieces of LaTeX says what the formulas below it show.
    """
    shown = [(text, _typeset(text)) for text in texts]
    some = any(picture for _text, picture in shown)
    return [
        Markup(picture or _CODE.sub(r"<code>\1</code>", str(escape(text))))
        for text, picture in shown
        if picture or not (some and _LATEX.search(text))
    ]


def _typeset(text: str) -> str:
    """MathML of ``name = formula``; nothing of a sentence."""
    name, sign, formula = text.partition(" = ")
    if not sign or not re.fullmatch(r"[\w\[\],' ]{1,40}", name):
        return ""
    try:
        return _picture(" = ".join(equation(name, parse(formula))))
    except KinlabError:
        return ""


# -------- The rest


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
            "low": f"{most * k / _BINS:g}",
            "high": f"{most * (k + 1) / _BINS:g}",
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
