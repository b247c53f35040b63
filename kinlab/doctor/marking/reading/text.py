"""The pieces of a text or Markdown: lines with a label in front, below a label, or with a name."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from kinlab.doctor.marking.reading.labels import SheetLabels
from kinlab.doctor.marking.reading.pieces import Piece, is_formula, is_no_answer
from kinlab.formulas.handed.code import without_code
from kinlab.formulas.handed.displays import shown_apart

_SPAN = re.compile(
    r"(?<![\\$])\$(?!\$)([^$\n]+)\$(?!\$)|\$\$([^$]+)\$\$|\\\((.*?)\\\)|\\\[(.*?)\\\]"
)
_CODE = re.compile(r"`([^`]+)`")
_STRUCK = re.compile(r"~~.*?~~")
_RULE = re.compile(r"\s*(?:```.*|~~~.*|[-=*_\s]{3,}|\|?[\s:|-]+\|[\s:|-]*)")
_ITEM = re.compile(r"\s*(?:[*•·]\s+|[-+–—]\s+(?=[^=]{1,40}=))")
_FENCE, _DEFINES = re.compile(r"\s*(?:```|~~~)"), re.compile(r"\s*def\s+\w+\s*\(")
_GOES_ON = re.compile(r"(?:\.{3}|(?<!\\)\\)[ \t]*$")
"""The end of a line that goes on in the next one, in MATLAB and in Python."""
_SIGN = re.compile(r"[*/^+=]")
_BAR = re.compile(r"(?<!\\)\|")
_MOST = 200
"""Lines that one formula may go over."""


def pieces_of_text(lines: Sequence[str], labels: SheetLabels) -> tuple[list[Piece], int]:
    """The pieces, and how many lines are words alone.

    Args:
        lines: of the file, without those that name the student.
        labels: of the sheet.
    """
    pieces: list[Piece] = []
    under, words, goes_on = "", 0, False
    for line in _whole(lines):
        if "\n" in line:  # a function
            pieces.append(Piece(without_code(line, True), "", under))
            continue
        if not line or _RULE.fullmatch(line[:_MOST]):
            continue
        line = _STRUCK.sub(" ", line) if "~~" in line else line
        line = _row(line)
        found = labels.of(line)
        heading = line.startswith("#")
        if found is not None:
            rest = (
                "" if heading and not ("=" in found.rest or is_formula(found.rest)) else found.rest
            )
            if rest or not found.sure:
                pieces.append(Piece(_core(rest), found.question.id, sure=found.sure))
            under = found.question.id if found.sure else under
            goes_on = bool(rest)
        elif heading:
            under = "" if re.search(r"\d", line) else under
        elif goes_on and pieces and _continues(str(pieces[-1].text), line):
            last = pieces[-1]
            pieces[-1] = Piece(f"{last.text} {line}", last.key, last.under, last.sure)
        elif "=" in line or is_formula(line) or _SPAN.search(line) or is_no_answer(line):
            every = [one for x in _formulas(line, bool(under)) for one in shown_apart(x)]
            pieces += [Piece(formula, "", under) for formula in every]
            goes_on = True
        else:
            words += 1
            goes_on = False
    return pieces, words


def _whole(lines: Sequence[str]) -> Iterator[str]:
    """The lines, a formula that goes over several as one."""
    k = 0
    while k < len(lines):
        line, end = lines[k], k
        last = _function_from(lines, k)
        if last:
            yield "\n".join(lines[k + 1 : last])
            k = last + 1
            continue
        if _is_open(line):
            held = line
            for end in range(k + 1, min(k + _MOST, len(lines))):
                held = f"{_GOES_ON.sub('', held)} {lines[end]}"
                if not _is_open(held):
                    break
            line, end = (line, k) if _is_open(held) else (held, end)
        yield line
        k = end + 1


def _function_from(lines: Sequence[str], k: int) -> int:
    """Where the fence closes that opens on a line, if a function of Python's is inside; else 0."""
    if not _FENCE.match(lines[k]):
        return 0
    for end in range(k + 1, min(k + _MOST, len(lines))):
        if _FENCE.match(lines[end]):
            inside = lines[k + 1 : end]
            return end if any(_DEFINES.match(line) for line in inside) else 0
    return 0


def _is_open(text: str) -> bool:
    if _GOES_ON.search(text) and _SIGN.search(text):
        return True
    begins, ends = text.count("\\begin{"), text.count("\\end{")
    return bool(text.count("$$") % 2 or begins > ends or text.count("\\[") > text.count("\\]"))


def _row(line: str) -> str:
    """A table's row as its label and what stands in the other cells."""
    if not line.startswith("|") or len(_BAR.findall(line)) < 3:
        return line
    cells = [cell.strip().replace("\\|", "|") for cell in _BAR.split(line.strip().strip("|"))]
    behind = " ".join(cell for cell in cells[1:] if cell)
    return f"{cells[0].rstrip(':')}: {behind}"


def _continues(before: str, line: str) -> bool:
    """Whether a line goes on with the formula on the one before."""
    opened = sum(before.count(c) for c in "([{") > sum(before.count(c) for c in ")]}")
    ends = before.rstrip()[-1:]
    return opened or ("=" not in line and (line[0] in "+-*/" or ends in ("+", "-", "*", "/", "=")))


def _core(text: str) -> str:
    """A formula without the words and signs of a text around it."""
    text = text.strip()
    code = _CODE.findall(text)
    if len(code) == 1 and not re.search(r"[=\d]", _CODE.sub(" ", text)):
        return str(code[0]).strip()
    spans = [found[0] for found in _SPAN.finditer(text)]
    if spans and not re.search(r"[-=+*/^\d]", _SPAN.sub(" ", text)):
        equations = [span for span in spans if "=" in span] or spans
        if len(equations) == 1:
            return equations[0]
    return text


def _formulas(line: str, labelled: bool) -> list[str]:
    """The formulas of a line without a label: what stands in dollars, or all of it."""
    spans = [found[0] for found in _SPAN.finditer(line)]
    equations = [span for span in spans if "=" in span]
    around = _SPAN.sub(" ", line)
    if equations and "=" not in around:
        return equations
    if spans and "=" not in around:
        return [span for span in spans if is_formula(span)] if labelled else [line]
    return [_core(_ITEM.sub("", line, count=1))]
