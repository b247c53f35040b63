"""Each student's sheet: the questions, and the robot's numbers that are this student's."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from pathlib import Path

from kinlab.doctor.marking.marks import slug_of
from kinlab.doctor.marking.own_answer import check_answers
from kinlab.doctor.marking.sheet import Sheet
from kinlab.doctor.marking.variation import numbers_for
from kinlab.errors import FileError
from kinlab.host.files import read_text, write_text
from kinlab.host.language import _

_STUDENTS = 5000


def students_of(path: str | Path) -> list[str]:
    """Ids, one on each line; what stands behind a comma is left out.

    Raises:
        FileError: the file cannot be read, or names nobody or one student twice.
    """
    lines = read_text(path, limit=1 << 20).splitlines()
    ids = [line.partition(",")[0].strip().strip("\"'") for line in lines]
    ids = [who for who in ids if who and not who.startswith("#")]
    if ids and ids[0].lower() in ("student", "id", "student id"):
        ids = ids[1:]
    if not ids:
        raise FileError(f"{path}: names no student; write one id on each line")
    if len(ids) > _STUDENTS:
        raise FileError(f"{path}: {len(ids)} students; at most {_STUDENTS}")
    seen: set[str] = set()
    for who in ids:
        if who.casefold() in seen:
            raise FileError(f"{path}: {who!r} stands there twice; give each student an id")
        seen.add(who.casefold())
    return ids


def handout(sheet: Sheet, student: str) -> str:
    """One student's sheet as a TOML file to be filled in: numbers as comments, empty answers."""
    lines = [f"# {_line(sheet.title)}", "#"]
    numbers = numbers_for(sheet, student)
    if numbers:
        said = _("The robot's numbers for {student} (SI units):")
        lines.append(f"# {said.format(student=_line(student))}")
        lines += [f"#   {name} = {value:g}" for name, value in numbers.items()]
        lines.append("#")
    how = _(
        "Write formulas as text (m1*l1^2*qdd1), LaTeX, MATLAB or Python, in the names above;\n"
        "joints: q1, q2, ..., rates qd1, ..., accelerations qdd1, ...; c12 is cos(q1 + q2)."
    )
    lines += [
        *(f"# {line}" for line in how.splitlines()),
        "",
        f"student = {_quoted(student)}",
        "",
        "[answers]",
    ]
    for question in sheet.questions:
        asked = _("{points:g} points: {question}").format(
            points=question.points, question=_line(question.text)
        )
        lines.append(f"# {asked}")
        lines.append(f"{question.id} = ''")
    text = "\n".join(lines) + "\n"
    tomllib.loads(text)  # what we hand out can be read
    return text


def write_handouts(sheet: Sheet, students: Iterable[str], folder: str | Path) -> int:
    """Writes every student's sheet; how many.

    Raises:
        SheetError: one of the sheet's own answers cannot be used.
        FileError: the folder cannot be written.
    """
    check_answers(sheet)
    root = Path(folder)
    try:
        root.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise FileError(f"{root}: cannot be written ({problem.strerror})") from None
    count = 0
    for student in students:
        write_text(root / f"{slug_of(student)}.toml", handout(sheet, student))
        count += 1
    return count


def _line(text: str) -> str:
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def _quoted(text: str) -> str:
    plain = _line(text)
    return '"' + plain.replace("\\", "\\\\").replace('"', '\\"') + '"'
