"""What is written of a class: marks.csv, a page for each student and one of the class, results.

::

    marks/marks.csv            one row for each student; UTF-8 with a mark in front, for Excel
    marks/class.html           for the teacher: which slips, how often, who
    marks/students/ada.html    for the student
    marks/results/ada.json     the same as Gradescope reads it (results.json of an autograder)
    marks/.records/            what a run that was stopped goes on from
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Container
from pathlib import Path
from typing import Any

from kinlab.doctor.marking.marks import Mark, Marks, Outcome
from kinlab.doctor.marking.pages import class_page, student_page
from kinlab.doctor.marking.submission import joined
from kinlab.errors import FileError
from kinlab.host.files import write_text
from kinlab.host.language import _

RECORDS = ".records"
"""The folder of what a run that was stopped goes on from, beside the pages."""
_FORMULA = (*"=+-@\t\r\n|%＝＋－＠",)
"""What a spreadsheet would take for the beginning of a formula or a command, in any width."""


def withdraw(folder: Path, here: Container[str]) -> int:
    """Removes what an earlier run wrote of submissions that are no longer there; counts them.

    Args:
        folder: of the marks.
        here: what the pages of this run's submissions are called.

    Raises:
        FileError: a file cannot be removed.
    """
    gone = [one for one in (folder / RECORDS).glob("*.json") if one.stem not in here]
    try:
        for record in gone:
            (folder / "students" / f"{record.stem}.html").unlink(missing_ok=True)
            (folder / "results" / record.name).unlink(missing_ok=True)
            record.unlink()
    except OSError as problem:
        raise FileError(f"{folder}: cannot be written ({problem.strerror})") from None
    return len(gone)


def write_marks(marks: Marks, folder: Path) -> None:
    """Writes all files of a class.

    Raises:
        FileError: the folder cannot be written.
    """
    try:
        for name in ("students", "results"):
            (folder / name).mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise FileError(f"{folder}: cannot be written ({problem.strerror})") from None
    for mark in marks.marks:
        write_text(folder / "students" / f"{mark.slug}.html", student_page(marks, mark))
        text = json.dumps(gradescope(marks, mark), indent=1, ensure_ascii=False, allow_nan=False)
        write_text(folder / "results" / f"{mark.slug}.json", text + "\n")
    write_text(folder / "marks.csv", "\ufeff" + as_csv(marks))  # by which Excel knows UTF-8
    write_text(folder / "class.html", class_page(marks))


def as_csv(marks: Marks) -> str:
    """One row for each student; no cell that a spreadsheet would run."""
    ids = [question.id for question in marks.sheet.questions]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(
        ["student", "name", "file", "points", "of", *ids, *(f"{k} verdict" for k in ids), "note"]
    )
    for mark in marks.marks:
        row: list[Any] = [_cell(mark.student), _cell(mark.name), _cell(mark.file)]
        row += [f"{mark.total:g}", f"{mark.of:g}"]
        row += [f"{outcome.points:g}" for outcome in mark.outcomes]
        row += [outcome.verdict for outcome in mark.outcomes]
        writer.writerow([*row, _cell(joined(mark.note, mark.unread, mark.aside))])
    return stream.getvalue()


def _cell(text: str) -> str:
    text = "".join(c if c.isprintable() else " " for c in text)
    return f"'{text}" if text.startswith(_FORMULA) else text


def gradescope(marks: Marks, mark: Mark) -> dict[str, Any]:
    """A student's results as Gradescope's autograder reads them."""
    pairs = zip(marks.sheet.questions, mark.outcomes, strict=True)
    tests = [
        {
            "number": str(number),
            "name": f"{question.id}: {question.text}",
            "score": outcome.points,
            "max_score": outcome.of,
            "status": "passed" if outcome.right else "failed",
            "output": told(outcome, bool(mark.unread)),
            "output_format": "text",
            "visibility": "visible",
        }
        for number, (question, outcome) in enumerate(pairs, 1)
    ]
    return {
        "score": mark.total,
        "output": joined(mark.note, mark.unread),
        "output_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": tests,
    }


def told(outcome: Outcome, unread: bool = False) -> str:
    """An outcome in a few lines, as much as its feedback lets through.

    Args:
        outcome: of one question.
        unread: whether the whole file could not be read, which is said once, of the file.
    """
    verdict = _(outcome.verdict)
    lines = [_("{verdict}.").format(verdict=verdict[:1].upper() + verdict[1:])]
    if outcome.place:
        lines.append(_("Place: {place}.").format(place=outcome.place))
    if outcome.cause:
        lines.append(_("Kind: {kind}.").format(kind=outcome.cause))
    lines += [*outcome.answer, "" if unread else outcome.remark]
    return "\n".join(line for line in lines if line)
