r"""A file of formulas, line by line: one line that is no TOML costs that line and not the file.

A backslash in ``"..."`` is LaTeX's, not an escape: ``"\tau"`` is tau and no tabulator. A name that
TOML wants in quotes (``M_{12}``, ``τ1``) is read without. A key given twice, a value without
quotes, a quote that is not closed: each is told with its line and what to write instead.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, field
from typing import Any

from kinlab.errors import FileError
from kinlab.host.files import read_toml
from kinlab.host.language import _

_FULL = {
    ord("“"): '"',
    ord("”"): '"',
    ord("‘"): "'",
    ord("’"): "'",
    ord("＝"): "=",
    ord("【"): "[",
    ord("】"): "]",
    ord("［"): "[",
    ord("］"): "]",
    0x3000: " ",
}
"""Signs of a Chinese keyboard, and those that TOML has."""
_HEADER = re.compile(r"\s*\[+\s*([\w. ]+?)\s*(\]*)\s*(?:#.*)?")
_ENTRY = re.compile(r"\s*(\"[^\"]*\"|'[^']*'|[^=\"'#\[][^=\"']*?)\s*=(?!=)\s*(.*)", re.DOTALL)
_ON_ONE_LINE = re.compile(r"(?:\"(?!\"\")([^\"]*)\"|'(?!'')([^']*)')\s*(?:#.*)?", re.DOTALL)
_BLANK = re.compile(r"\s*(?:#.*)?")
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")
_LATEX = re.compile(r"(?<!\\)(?:\\\\)*\\[A-Za-z]")
_LONG = ('"""', "'''")


@dataclass
class Lines:
    """A file of formulas, as far as it can be read.

    Attributes:
        document: as TOML has it.
        problems: what could not be read: the entry, or ``""`` for a line without one, and why.
    """

    document: dict[str, Any] = field(default_factory=dict)
    problems: list[tuple[str, FileError]] = field(default_factory=list)


def read_lines(text: str, place: str) -> Lines:
    """Reads a file of formulas; what is sound TOML is read as TOML.

    Args:
        text: the file.
        place: what to put in front of a message.
    """
    found = Lines()
    whole = _with_latex(text)
    try:
        found.document = read_toml(whole, place, FileError)
    except FileError:
        _read(whole, place, found)
    return found


def _with_latex(text: str) -> str:
    """The text with LaTeX out of ``"..."`` put into ``'...'``, where nothing is an escape."""
    out = []
    for line in text.split("\n"):
        entry = _ENTRY.fullmatch(line)
        value = _ON_ONE_LINE.fullmatch(entry[2]) if entry else None
        if entry and value and value[1] and "'" not in value[1] and _LATEX.search(value[1]):
            start = entry.start(2)
            line = f"{line[:start]}'{value[1]}'"
        out.append(line)
    return "\n".join(out)


def _read(text: str, place: str, found: Lines) -> None:
    table, header = found.document, ""
    seen: dict[tuple[str, str], list[int]] = {}
    for number, piece in _pieces(text):
        told = _HEADER.fullmatch(piece.translate(_FULL))
        if told and not _ENTRY.fullmatch(piece):
            header = told[1]
            table = found.document.setdefault(header, {})
            if not told[2] or piece.translate(_FULL) != piece:
                problem = f"{_at(place, number)}: " + _("write [{header}]").format(header=header)
                found.problems.append(("", FileError(problem)))
            continue
        if _BLANK.fullmatch(piece):
            continue
        key, value, remedy = _entry(piece)
        if remedy:
            shown = f"{_at(place, number)}: " + (f"{key}: " if key else "")
            found.problems.append((key, FileError(shown + remedy)))
            continue
        lines = seen.setdefault((header, key), [])
        lines.append(number)
        if len(lines) == 1:
            table[key] = value
    for (header, key), lines in seen.items():
        if len(lines) > 1:
            table = found.document[header] if header else found.document
            del table[key]
            numbers = (_(" and ") if len(lines) == 2 else _(", ")).join(map(str, lines))
            twice = _("{name} is given twice, in lines {numbers}; keep one")
            problem = f"{place}: {twice.format(name=key, numbers=numbers)}"
            found.problems.append((key, FileError(problem)))


def _at(place: str, number: int) -> str:
    return _("{place}: line {number}").format(place=place, number=number)


def _pieces(text: str) -> list[tuple[int, str]]:
    """The lines with their numbers; one that opens a long text or a list, up to where it ends."""
    lines = text.splitlines()
    found: list[tuple[int, str]] = []
    k = 0
    while k < len(lines):
        start, piece = k, lines[k]
        mark = next((m for m in _LONG if piece.count(m) == 1), "")
        ends = [j for j in range(k + 1, len(lines)) if mark and mark in lines[j]]
        if ends:
            k = ends[0]
            piece = "\n".join(lines[start : k + 1])
        elif re.search(r"=\s*\[[^\]]*$", piece):
            while k + 1 < len(lines) and not _ENTRY.fullmatch(lines[k + 1]) and "]" not in lines[k]:
                k += 1
            piece = "\n".join(lines[start : k + 1])
        found.append((start + 1, piece))
        k += 1
    return found


def _entry(piece: str) -> tuple[str, Any, str]:
    """Key and value of a line; or the key, nothing, and what to write instead."""
    try:
        ((key, value),) = tomllib.loads(piece).items()
    except (ValueError, RecursionError):
        pass
    else:
        return key, value, ""
    entry = _ENTRY.fullmatch(piece)
    plain = piece.translate(_FULL)
    if entry is None:
        changed = _ENTRY.fullmatch(plain)
        name = changed[1].strip("\"' ") if changed else ""
        if changed and plain != piece:
            return name, None, _('write the signs = and " of an English keyboard')
        said = _('{text!r} is no entry; write name = "formula"')
        return "", None, said.format(text=piece.strip()[:40])
    name, value = entry[1].strip("\"' "), entry[2].strip()
    inside = _ON_ONE_LINE.fullmatch(value)
    if inside and not (_BARE_KEY.fullmatch(name) and inside[1] and "\\" in inside[1]):
        return name, inside[1] if inside[1] is not None else inside[2], ""
    if not value:
        said = _('nothing stands behind =; write {name} = "formula"')
        return name, None, said.format(name=name[:30])
    if value[0] in "\"'":
        return name, None, _("the quotes are not closed, or more stands behind them")
    if plain != piece and value.translate(_FULL)[0] in "\"'":
        said = _('write the quotes " of an English keyboard, not {sign}')
        return name, None, said.format(sign=value[0])
    said = _('the formula stands in quotes: {name} = "{formula}"')
    return name, None, said.format(name=name[:30], formula=value[:40])
