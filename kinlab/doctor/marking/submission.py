"""What a student hands in: TOML, LaTeX or text, read so that one file harms only itself.

Text and LaTeX name the student in a line such as ``student: ada`` (``% student: ada``), and each
answer by the question's id or by the left side of the formula::

    student: ada
    q1: (m_1 + m_2)*l_1**2*qdd1 + ...
    x = l1*c1 + l2*c12
"""

from __future__ import annotations

import re
import stat
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from kinlab.check.diagnosis import ENTRY_LETTERS, shown_entry
from kinlab.check.quantities.registry import split_name
from kinlab.doctor.linkages.named_numbers import named_numbers
from kinlab.doctor.marking.sheet import Question, Sheet
from kinlab.doctor.text.claims import claimed_of, whole_claimed
from kinlab.errors import ExpressionError, FileError, KinlabError
from kinlab.formulas.lines import read_lines
from kinlab.formulas.typed import (
    Hand,
    bare,
    claims,
    entry_name,
    explained,
    hand,
    named_in,
    plain_formula,
    sides,
)
from kinlab.host.files import read_text
from kinlab.host.language import _

LARGEST = 256 * 1024
"""Bytes of a submission above which it is not read."""

KINDS = (".toml", ".tex", ".txt", ".md", ".py")
_WORD = re.compile(r"[A-Za-z]\w*")
_ID = 64
_LINES = 2000
_MOST = 400
_WORDS = ("student", "id", "name", "matriculation", "student_id", "student id")


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
        note: what a person should know.
        program: the text of a Python file, which is not run here.
    """

    file: str
    student: str
    name: str = ""
    answers: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    symbols: Mapping[str, Any] = field(default_factory=dict)
    problems: Mapping[str, str] = field(default_factory=dict)
    note: str = ""
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
    stem = path.parent.name if root is not None and path.parent != root else path.stem
    about = path.lstat()
    if stat.S_ISLNK(about.st_mode):
        raise FileError(f"{shown}: " + _("is a link; hand in the file itself"))
    try:
        text = read_text(path, limit=LARGEST)
    except FileError as problem:  # a student need not know where the class's folder is
        raise FileError(str(problem).replace(str(path), shown, 1)) from None
    if "\x00" in text:
        raise FileError(f"{shown}: " + _("not text"))
    suffix = path.suffix.lower()
    if suffix == ".toml":
        read = read_lines(text, shown)
        return of_document(read.document, sheet, shown, stem, read.problems)
    if suffix == ".py":
        student, name = _people(_lines(text, "#"))
        return Submission(shown, student or _safe(stem), name, note=_note(student), program=text)
    lines = list(_lines(text, "%" if suffix == ".tex" else ""))
    student, name = _people(lines)
    pieces = _of_latex(text) if suffix == ".tex" else _of_text(lines, sheet)
    answers, problems, unasked, own = _sorted(pieces, sheet)
    who = student or _safe(stem)
    return Submission(shown, who, name, answers, own, problems, _note(student, unasked))


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
    given: list[tuple[str, Any]] = []
    for key, value in rest.items():
        if key in ("answers", "formulas", "latex") and isinstance(value, dict):
            dollars = key == "latex"
            given += [
                (k, f"${v}$" if dollars and isinstance(v, str) else v) for k, v in value.items()
            ]
        else:
            given.append((key, value))
    answers, problems, unasked, own = _sorted(given, sheet)
    lost: list[str] = []
    for key, problem in broken:
        told = str(problem).removeprefix(f"{shown}: ")
        question = _question(key, sheet, hand([]))[0]
        if question is None:
            lost.append(told)
        else:
            problems.setdefault(question.id, told)
    if broken and not answers and not problems:
        raise broken[0][1]
    if isinstance(student, bool) or not isinstance(student, (str, int)):
        student = ""
    known = _safe(str(student))
    who = known or _safe(stem)
    called = _safe(name) if isinstance(name, str) else ""
    note = _("; ").join(filter(None, (_note(known, unasked), *lost)))
    return Submission(shown, who, called, answers, own | symbols, problems, note)


def _note(student: str, unasked: Sequence[str] = ()) -> str:
    notes = [] if student else [_("no student id in the file; its name is taken")]
    if unasked:
        said = _("lines that answer no question: {names}")
        notes.append(said.format(names=_(", ").join(unasked[:3])))
    return _("; ").join(notes)


def _safe(text: str) -> str:
    """One line of bounded length."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())[:_ID]


# -------- Text and LaTeX

_FIELD = re.compile(rf"\s*({'|'.join(_WORDS)})\s*[:=]\s*(\S.*)", re.IGNORECASE)


def _lines(text: str, comment: str) -> Iterator[str]:
    for line in text.splitlines()[:_LINES]:
        stripped = line.lstrip()
        if comment and stripped.startswith(comment):
            stripped = stripped.lstrip(comment)
        yield stripped.rstrip()


def _people(lines: Sequence[str] | Iterator[str]) -> tuple[str, str]:
    """The student's id and name."""
    student = name = ""
    for line in lines:
        found = _FIELD.fullmatch(line)
        if found is None:
            continue
        if found[1].lower() == "name":
            name = name or _safe(found[2])
        else:
            student = student or _safe(found[2].strip("\"'"))
    return student, name


def _of_text(lines: Sequence[str], sheet: Sheet) -> list[tuple[str, Any]]:
    pieces: list[tuple[str, Any]] = []
    for line in lines:
        if not line or line.startswith("#") or _FIELD.fullmatch(line):
            continue
        before, colon, after = line.partition(":")
        if colon and before.strip().lower() in {q.id.lower() for q in sheet.questions}:
            pieces.append((before.strip(), after.strip()))
        elif "=" in line:
            pieces.append(("", line))
        elif pieces and (
            line[0] in "+-*/" or str(pieces[-1][1]).rstrip()[-1:] in ("+", "-", "*", "")
        ):
            key, value = pieces[-1]
            pieces[-1] = (key, f"{value} {line}")
    return pieces


_BODY = re.compile(r"\\begin\{document\}(.*?)(?:\\end\{document\}|\Z)", re.DOTALL)
_SHOWN = re.compile(
    r"\\\[(?P<a>.*?)\\\]|\$\$(?P<b>.*?)\$\$"
    r"|\\begin\{(?P<env>(?:equation|align|gather|multline)\*?)\}(?P<c>.*?)\\end\{(?P=env)\}"
    r"|\\\((?P<d>.*?)\\\)|(?<!\\)\$(?P<e>[^$]*)\$",
    re.DOTALL,
)
_COMMENT = re.compile(r"(?<!\\)%.*")
_INSIDE = re.compile(r"\\begin\{(\w*matrix|array|aligned|split)\}.*?\\end\{\1\}", re.DOTALL)


def _of_latex(text: str) -> list[tuple[str, Any]]:
    text = _COMMENT.sub("", text)
    if text.count(r"\begin") > _MOST or text.count("$") > 4 * _MOST or text.count(r"\[") > _MOST:
        raise FileError(_("more than {most} formulas in one file").format(most=_MOST))
    body = _BODY.search(text)
    text = body[1] if body else text
    shown = [
        next(v for k, v in m.groupdict().items() if k != "env" and v is not None)
        for m in _SHOWN.finditer(text)
    ]
    if not shown:  # bare lines, as a fragment may be
        shown = [line for line in text.splitlines() if "=" in line]
    pieces: list[tuple[str, Any]] = []
    for formula in shown:
        for line in _rows(formula):
            if "=" in line:
                pieces.append(("", f"${bare(line)}$"))
    return pieces


def _rows(formula: str) -> list[str]:
    r"""The lines of an ``align``; what is broken inside a matrix stays whole."""
    matrices = [m[0] for m in _INSIDE.finditer(formula)]
    held = formula
    for k, matrix in enumerate(matrices):
        held = held.replace(matrix, f"\x01{k}\x01", 1)
    lines: list[str] = []
    for part in re.split(r"\\\\(?:\[[^\]]*\])?", held):
        line = part.replace("&", " ").strip()
        if lines and line and "=" not in line:  # a sum goes on
            lines[-1] += f" {line}"
        elif line:
            lines.append(line)
    return [re.sub("\x01(\\d+)\x01", lambda m: matrices[int(m[1])], line) for line in lines]


# -------- Which formula answers which question


def _sorted(
    pieces: Sequence[tuple[str, Any]], sheet: Sheet
) -> tuple[dict[str, dict[str, str]], dict[str, str], list[str], dict[str, str]]:
    """Formulas by question (by its id, or by the name on the left side), and what is wrong.

    The third are left sides of no question; they are told where a question has no answer. The last
    are the writer's own names.
    """
    unasked: list[str] = []
    others: list[tuple[str, str]] = []
    answers: dict[str, dict[str, str]] = {}
    problems: dict[str, str] = {}
    writing = hand(str(value) for _, value in pieces)
    for key, value in pieces:
        lefts = [key] if key or not isinstance(value, str) else named_in(value) or [""]
        asked = (_question(left, sheet, writing) for left in lefts)
        question, name = next((one for one in asked if one[0] is not None), (None, ""))
        if question is None:
            unasked.append(_safe(lefts[0] or str(value))[:20])
            if isinstance(value, str):
                others.append((lefts[0], value))
            continue
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            value = repr(value)
        if isinstance(value, dict) and all(isinstance(v, str) for v in value.values()):
            answers.setdefault(question.id, {}).update(value)
        elif not isinstance(value, str):
            said = _("{type}; write the formula as text")
            problems[question.id] = said.format(type=type(value).__name__)
        elif name in answers.get(question.id, {}):
            said = _("{entry} is given twice; keep the last line only")
            problems[question.id] = said.format(entry=name or question.id)
        else:
            answers.setdefault(question.id, {})[name] = value
    whole = len({*answers, *problems}) == len(sheet.questions)
    return answers, problems, [] if whole else unasked, _own_names(others, answers, sheet)


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


_OWN = re.compile(r"(?!(?:q|qd|qdd|th|theta|[cs])\d)[A-Za-z]\w*")


def _words(text: str) -> list[str]:
    """The names in a formula; none of what cannot be read."""
    try:
        return _WORD.findall(plain_formula(sides(explained(text)[1])[1]))
    except ExpressionError:
        return []


def _question(left: str, sheet: Sheet, writing: Hand) -> tuple[Question | None, str]:
    """The question by its id, or by the left side of its answer, whose plain name comes too."""
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
    for question in sheet.questions:
        if name in (question.entry, question.id, shown_entry(question.quantity), *question.answer):
            return question, name
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
        said = claims(text, name or default) or name
        if said in ("", question.id, question.entry, default, shown, _head(question)):
            named[default] = text
            continue
        found, _name = _asked(said, sheet, hand([]))
        if said not in question.answer and (found is None or found.id != question.id):
            if not _names(question, said, sheet):
                other = _("the line begins with {name} =, and the question asks for {entry}")
                raise ExpressionError(other.format(name=said, entry=shown))
            said = default
        named[said] = text
    return named


def _names(question: Question, said: str, sheet: Sheet) -> bool:
    """Whether a name is the question's, as books have it or by its only joint: tau of tau1."""
    robot = sheet.robot
    with suppress(ExpressionError):
        return question.quantity in (whole_claimed(said, robot) or claimed_of(said, robot), said)
    return False
