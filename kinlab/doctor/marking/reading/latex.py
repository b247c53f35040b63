r"""The pieces of a LaTeX file: its formulas, each under the label that stands before it.

A label is a section's title (``\section*{q3}``), bold type, an item's mark, or the beginning of a
line. Where a list has as many items as the sheet has questions, they are the questions.
"""

from __future__ import annotations

import re

from kinlab.doctor.marking.reading.labels import SheetLabels
from kinlab.doctor.marking.reading.pieces import Piece, is_formula
from kinlab.doctor.marking.reading.text import pieces_of_text
from kinlab.doctor.marking.sheet import Sheet
from kinlab.errors import FileError
from kinlab.formulas.handed.displays import rows_of
from kinlab.formulas.typed import bare
from kinlab.host.language import _

_MOST = 400
_ENV = r"(?:equation|align|gather|multline|eqnarray|flalign|displaymath)\*?"
_BODY = re.compile(r"\\begin\{document\}(.*?)(?:\\end\{document\}|\Z)", re.DOTALL)
_SHOWN = re.compile(
    r"\\\[(?P<a>.*?)\\\]|\$\$(?P<b>.*?)\$\$"
    rf"|\\begin\{{(?P<env>{_ENV})\}}(?P<c>(?:(?!\\begin\{{{_ENV}\}}).)*?)\\end\{{(?P=env)\}}"
    rf"|\\begin\{{{_ENV}\}}(?P<f>[^\n]*)"
    r"|\\\((?P<d>.*?)\\\)|(?<!\\)\$(?P<e>[^$]*)\$",
    re.DOTALL,
)
_COMMENT = re.compile(r"(?<!\\)%.*")
_OWN = re.compile(
    r"\\(?:(?:re)?newcommand\*?|def)\s*\{?\s*(\\[A-Za-z]{1,20})\s*\}?\s*"
    r"\{((?:[^{}\n]|\{[^{}\n]*\}){0,200})\}"
)
_COMMANDS, _LARGEST = 40, 1 << 19
_TITLE = re.compile(
    r"\\(?:(?:sub){0,2}section|(?:sub)?paragraph|chapter|part|subsubsection)\*?\s*\{([^{}\n]*)\}"
)
_FONT = re.compile(r"\\(?:textbf|textit|emph|underline|textsc|text|mbox)\s*\{([^{}\n]*)\}")
_ITEM = re.compile(r"\\item\s*(?:\[([^\]\n]*)\])?")
_LEFT_OUT = re.compile(
    r"\\(?:begin|end)\{[^{}\n]*\}(?:\[[^\]\n]*\])?|\\(?:noindent|maketitle|newpage|quad|qquad|bigskip"
    r"|medskip|smallskip|hfill|centering|bfseries|itshape)(?![A-Za-z])|[{}~]"
)


def pieces_of_latex(text: str, labels: SheetLabels, sheet: Sheet) -> tuple[list[Piece], int]:
    """The pieces, and how many lines of a file without formulas are words alone.

    Args:
        text: of the file.
        labels: of the sheet.
        sheet: whose questions they may answer.

    Raises:
        FileError: more formulas than any homework has.
    """
    text = _expanded(_COMMENT.sub("", text))
    if text.count(r"\begin") > _MOST or text.count("$") > 4 * _MOST or text.count(r"\[") > _MOST:
        raise FileError(_("more than {most} formulas in one file").format(most=_MOST))
    body = _BODY.search(text)
    text = _with_items(body[1] if body else text, sheet)
    shown = list(_SHOWN.finditer(text))
    if not shown:  # bare lines, as a fragment may be
        return pieces_of_text([line.strip() for line in _lines(text)], labels)
    pieces: list[Piece] = []
    under, end = "", 0
    for found in shown:
        under, written = _between(text[end : found.start()], labels, under)
        pieces += written
        end = found.end()
        formula = next(v for k, v in found.groupdict().items() if k != "env" and v is not None)
        for row in rows_of(formula):
            if "=" in row or (under and is_formula(row)):
                pieces.append(Piece(f"${bare(row)}$", "", under))
    return [*pieces, *_between(text[end:], labels, under)[1]], 0


def _expanded(text: str) -> str:
    r"""The text with the writer's own commands written out, those without arguments: ``\dd``."""
    own = dict(_OWN.findall(text)[:_COMMANDS])
    text = _OWN.sub(" ", text)
    for _round in range(2):
        for name, meaning in own.items():
            if len(text) + text.count(name) * len(meaning) > _LARGEST:
                return text
            put = meaning.replace("\\", r"\\")
            text = re.sub(rf"{re.escape(name)}(?![A-Za-z])", put, text)
    return text


def _with_items(text: str, sheet: Sheet) -> str:
    """The text with the questions' ids for the items of a list that has as many."""
    items = _ITEM.findall(text)
    if len(items) != len(sheet.questions) or any(items):
        return text
    ids = iter(sheet.questions)
    return _ITEM.sub(lambda _found: f"\n{next(ids).id}: ", text)


def _lines(text: str) -> list[str]:
    """What stands between formulas, in lines, without commands."""
    text = _ITEM.sub(lambda found: f"\n{found[1] or ''} ", _TITLE.sub(r"\n# \1\n", text))
    for _depth in range(3):
        text = _FONT.sub(r"\1", text)
    return re.split(r"\n|\\\\|\\par(?![A-Za-z])", _LEFT_OUT.sub(" ", text))


def _between(text: str, labels: SheetLabels, under: str) -> tuple[str, list[Piece]]:
    """The label before the next formula, and answers without a dollar."""
    pieces: list[Piece] = []
    for line in _lines(text):
        line = line.strip()
        found = labels.of(line) if line else None
        if found is not None and found.sure:
            under = found.question.id
            if found.rest and "\\" not in found.rest and is_formula(found.rest):
                pieces.append(Piece(found.rest, under))
        elif line.startswith("#") and re.search(r"\d", line):
            under = ""
    return under, pieces
