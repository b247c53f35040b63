"""What a student hands in: TOML, LaTeX or text, read so that one file harms only itself.

Text and LaTeX name the student in a line such as ``student: ada`` (``% student: ada``), and each
answer by a label (:mod:`kinlab.doctor.marking.reading.labels`) or by the left side of the formula::

    student: ada
    q1: (m_1 + m_2)*l_1**2*qdd1 + ...
    x = l1*c1 + l2*c12
"""

from __future__ import annotations

import re
import stat
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from kinlab.doctor.marking.reading.encodings import decoded
from kinlab.doctor.marking.reading.labels import SheetLabels
from kinlab.doctor.marking.reading.latex import pieces_of_latex
from kinlab.doctor.marking.reading.pieces import Piece
from kinlab.doctor.marking.reading.questions import Answers, question_of, sort_pieces
from kinlab.doctor.marking.reading.text import pieces_of_text
from kinlab.doctor.marking.sheet import Sheet
from kinlab.errors import FileError
from kinlab.formulas.lines import read_lines
from kinlab.formulas.typed import Hand, hand
from kinlab.host.language import _, ngettext

LARGEST = 256 * 1024
"""Bytes of a submission above which it is not read."""

KINDS = (".toml", ".tex", ".txt", ".md", ".py")
_ID = 64
_LINES = 2000
_WIDEST = 200
_TOLD = 6
"""Lines that a note names."""
_IDS: tuple[str, ...] = (
    "student_id",
    "student id",
    "student number",
    "student no",
    "student",
    "id",
)
_IDS += ("matriculation number", "matriculation", "matrikelnummer", "学生", "学号")
_NAMES = ("student name", "full name", "name", "姓名", "名字")


@dataclass(frozen=True)
class Submission:
    """One submission, taken apart.

    Attributes:
        file: its name.
        student: the id; the file's name where none stands in it.
        name: the student's name, where it is given.
        answers: question id to formulas by name; the name is empty where none is written.
        symbols: the student's own names.
        problems: question id to what cannot be used.
        note: what a person should look at.
        aside: what is said beside it and needs nobody.
        program: the text of a Python file, which is not run here.
    """

    file: str
    student: str
    name: str = ""
    answers: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    symbols: Mapping[str, Any] = field(default_factory=dict)
    problems: Mapping[str, str] = field(default_factory=dict)
    note: str = ""
    aside: str = ""
    program: str = ""

    @property
    def writing(self) -> Hand:
        """What all formulas together say about the writing."""
        texts = [text for given in self.answers.values() for text in given.values()]
        return hand(
            [*texts, *(s for s in self.symbols.values() if isinstance(s, str))], self.symbols
        )


def found_in(folder: str | Path) -> list[Path]:
    """The submissions of a folder, in the order of their names; folders are looked into once.

    Raises:
        FileError: no such folder, or nothing in it that could be a submission.
    """
    root = Path(folder)
    try:
        exists = root.is_dir()
    except (OSError, ValueError):  # no name of a file
        exists = False
    if not exists:
        raise FileError(f"{str(folder)!r}: no such folder of submissions")
    files = []
    for path in sorted(root.iterdir(), key=lambda p: p.name):
        if path.name.startswith("."):
            continue
        if path.is_dir() and not path.is_symlink():
            inside = sorted(path.iterdir(), key=lambda p: p.name)
            files += [p for p in inside if p.suffix.lower() in KINDS]
        elif path.suffix.lower() in KINDS:
            files.append(path)
    if not files:
        raise FileError(f"{root}: no submissions; files end in {', '.join(KINDS)}")
    return files


def read_submission(path: Path, sheet: Sheet, root: Path | None = None) -> Submission:
    """Reads one file.

    Raises:
        KinlabError: it cannot be read; the message says why.
    """
    shown = str(path.relative_to(root)) if root is not None else path.name
    stem = student_of(path, root)
    text, encoding = decoded(_content(path, shown), shown)
    aside = _("read as {encoding}").format(encoding=encoding) if encoding else ""
    suffix = path.suffix.lower()
    if suffix == ".toml":
        read = read_lines(text, shown)
        found = of_document(read.document, sheet, shown, stem, read.problems)
        return replace(found, aside=joined(aside, found.aside))
    all_lines = text.splitlines()
    if len(all_lines) > _LINES:
        said = _("only the first {count} lines are read").format(count=_LINES)
        aside = joined(aside, "" if suffix == ".py" else said)
    lines = list(_lines(all_lines, {".py": "#", ".tex": "%"}.get(suffix, "")))
    student, name = _people(lines)
    who, note = student or safe(stem), _note(student)
    if suffix == ".py":
        return Submission(shown, who, name, note=note, aside=aside, program=text)
    labels = SheetLabels(sheet)
    if suffix == ".tex":
        author = _AUTHOR.search(text)
        name = name or (safe(author[1]) if author else "")
        pieces, words = pieces_of_latex(text, labels, sheet)
    else:
        lines = [line for line in lines if not _field(line)]
        pieces, words = pieces_of_text(lines, labels)
    if words:
        said = ngettext("{count} line of words", "{count} lines of words", words)
        aside = joined(aside, said.format(count=words))
    read_ = Submission(shown, who, name, note=note, aside=aside)
    return _with_answers(read_, sort_pieces(pieces, sheet, labels), sheet)


def student_of(path: Path, root: Path | None = None) -> str:
    """Who handed a file in, as far as its name says: its folder's below the class's, or its own.

    Args:
        path: of the file.
        root: the class's folder.
    """
    return path.parent.name if root is not None and path.parent != root else path.stem


def _content(path: Path, shown: str) -> bytes:
    """The bytes of a file; a student need not know where the class's folder is."""
    try:
        about = path.lstat()
        if stat.S_ISLNK(about.st_mode):
            raise FileError(f"{shown}: " + _("is a link; hand in the file itself"))
        if not stat.S_ISREG(about.st_mode):
            raise FileError(f"{shown}: " + _("is no file"))
        if about.st_size > LARGEST:
            said = _("{size} bytes; at most {most} are read")
            raise FileError(f"{shown}: " + said.format(size=about.st_size, most=LARGEST))
        return path.read_bytes()
    except FileError:
        raise
    except OSError as problem:
        said = _("cannot be read ({reason})").format(reason=problem.strerror)
        raise FileError(f"{shown}: {said}") from None


def _with_answers(read: Submission, found: Answers, sheet: Sheet) -> Submission:
    """A submission with its answers, and with what of it answers nothing.

    Where every question has an answer, the rest is nothing that anybody must look at.
    """
    told = ""
    if found.astray:
        said = ngettext(
            "{count} line answers no question: {names}",
            "{count} lines answer no question: {names}",
            len(found.astray),
        )
        names = [safe(name) for name in found.astray[:_TOLD]]
        names += ["..."] if len(found.astray) > _TOLD else []
        told = said.format(count=len(found.astray), names=_(", ").join(names))
    whole = all(found.answered(question.id) for question in sheet.questions)
    return replace(
        read,
        answers=found.given,
        symbols=found.own | dict(read.symbols),
        problems=found.problems,
        note=joined(read.note, *found.notes, "" if whole else told),
        aside=joined(read.aside, told if whole else ""),
    )


def of_document(
    document: Mapping[str, Any],
    sheet: Sheet,
    shown: str,
    stem: str,
    broken: Sequence[tuple[str, FileError]] = (),
) -> Submission:
    """A submission from a TOML document, or from a mapping in a notebook.

    Args:
        document: as it was read.
        sheet: what is asked.
        shown: the file, for messages.
        stem: the student, where the document names none.
        broken: lines that could not be read, from :func:`kinlab.formulas.lines.read_lines`.

    Raises:
        FileError: symbols that are no table, or broken lines and no answer beside them.
    """
    rest = dict(document)
    student = next((rest.pop(w) for w in ("student", "id", "student_id") if w in rest), "")
    name = rest.pop("name", "")
    symbols = rest.pop("symbols", {})
    rest.pop("robot", None)
    rest.pop("title", None)
    if not isinstance(symbols, dict):
        raise FileError(f"{shown}: [symbols] is {type(symbols).__name__}; it must be a table")
    given: list[Piece] = []
    for key, value in rest.items():
        if key in ("answers", "formulas", "latex") and isinstance(value, dict):
            dollars = key == "latex"
            given += [
                Piece(f"${v}$" if dollars and isinstance(v, str) else v, k)
                for k, v in value.items()
            ]
        else:
            given.append(Piece(value, key))
    labels = SheetLabels(sheet)
    found = sort_pieces(given, sheet, labels)
    lost: list[str] = []
    for key, problem in broken:
        told = str(problem).removeprefix(f"{shown}: ")
        question = labels.named(key) or question_of(key, sheet, hand([]))[0]
        if question is None:
            lost.append(told)
        else:
            found.problems.setdefault(question.id, told)
    if broken and not found.given and not found.problems:
        raise broken[0][1]
    if isinstance(student, bool) or not isinstance(student, (str, int)):
        student = ""
    known = safe(str(student))
    who = known or safe(stem)
    called = safe(name) if isinstance(name, str) else ""
    note = joined(_note(known), *lost)
    read = Submission(shown, who, called, symbols=symbols, note=note)
    return _with_answers(read, found, sheet)


def _note(student: str) -> str:
    return "" if student else _("no student id in the file; its name is taken")


def joined(*notes: str) -> str:
    """Notes as one.

    Args:
        notes: those that are empty are left out.
    """
    return _("; ").join(note for note in notes if note)


def safe(text: str) -> str:
    """One line of bounded length.

    Args:
        text: of a stranger.
    """
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())[:_ID]


# -------- Who it is

_FIELD = re.compile(
    rf"[\s>*_#-]{{0,9}}(?:\\noindent\s*)?({'|'.join((*_IDS, *_NAMES))})"
    r"[*_]{0,2}\s*[:=：][*_]{0,2}\s*(\S.*)",
    re.IGNORECASE,
)
_AUTHOR = re.compile(r"\\author\{([^{}\\]{1,80})\}")
_BEHIND = re.compile(r"\\(?:hfill|quad|qquad|\\).*")


def _lines(lines: Sequence[str], comment: str) -> Iterator[str]:
    for line in lines[:_LINES]:
        stripped = line.lstrip()
        if comment and stripped.startswith(comment):
            stripped = stripped.lstrip(comment)
        yield stripped.rstrip()


def _field(line: str) -> tuple[str, str] | None:
    """What a line says of the student: ``student: ada``, ``**学号**：123``."""
    found = _FIELD.fullmatch(line[:_WIDEST])
    if found is None:
        return None
    value = _BEHIND.sub("", found[2]).strip(" \t\"'*_")
    return (found[1].lower(), safe(value)) if value else None


def _people(lines: Sequence[str]) -> tuple[str, str]:
    """The student's id and name."""
    student = name = ""
    for line in lines:
        found = _field(line)
        if found is None:
            continue
        if found[0] in _NAMES:
            name = name or found[1]
        else:
            student = student or found[1]
    return student, name
