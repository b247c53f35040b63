"""What was printed or scanned: exponents on the line above, rows of a matrix by lines alone."""

from __future__ import annotations

import re
import unicodedata

_RAISED = re.compile(r"[ \t]*\d(?:[ \t]|\d)*")
_BASE = re.compile(r"[^\W_]|[)\]₀-₉]")
_DRAWN = re.compile(r"\[([^\[\],;&=]*\n[^\[\],;&=]*)\]")
_APART = re.compile(r"[ \t]{2,}")
_SCANNED = re.compile(r"(?<![^\W_])([^\W\d_]|lc)((?: \d)+)(?![\d.,]|[ ]?[.,]\d)")
_GLUED = re.compile(r"[^\W_]\d|\d[^\W\d_]|[^\W\d_]_")
_FEWEST = 4
"""Names with digits apart, of which one reads a scan."""


def as_typed(text: str) -> str:
    """The text as it would be typed in one line, where it was printed over several, or scanned.

    Args:
        text: as handed in, with all its blanks.
    """
    return _scanned(_DRAWN.sub(_with_signs, _on_one_line(text)))


def _on_one_line(text: str) -> str:
    """Exponents behind what they stand above: ``l1**2`` of sympy's ``pprint``."""
    lines = text.split("\n")
    found: list[str] = []
    k = 0
    while k < len(lines):
        below = lines[k + 1] if k + 1 < len(lines) else ""
        new = _with_raised(lines[k], below) if _RAISED.fullmatch(lines[k]) else None
        found.append(lines[k] if new is None else new)
        k += 1 if new is None else 2
    return "\n".join(found)


def _with_raised(above: str, below: str) -> str | None:
    """A line with what stands above it as exponents; None where that stands above no blank."""
    at = [k for k, letter in enumerate(below) if not unicodedata.combining(letter)]
    for number in reversed([*re.finditer(r"\d+", above)]):
        first, last = number.span()
        begin = at[first] if first < len(at) else len(below)
        end = at[last] if last < len(at) else len(below)
        if (
            first > len(at)
            or below[begin:end].strip()
            or not _BASE.fullmatch(below[begin - 1 : begin])
        ):
            return None
        below = f"{below[:begin]}**{number[0]}{below[end:]}"
    return below


def _with_signs(found: re.Match[str]) -> str:
    """``[a, b; c, d]`` of rows on lines of their own, whose entries stand apart."""
    lines = (line.strip() for line in found[1].split("\n"))
    rows = [_APART.split(line) for line in lines if line]
    if len({len(row) for row in rows}) > 1:
        return found[0]
    return f"[{'; '.join(', '.join(row) for row in rows)}]"


def _scanned(text: str) -> str:
    """``m1*l1`` of ``m 1 * l 1``, where no name has its digit beside it."""
    if _GLUED.search(text) or len(_SCANNED.findall(text)) < _FEWEST:
        return text
    return _SCANNED.sub(lambda found: found[1] + found[2].replace(" ", ""), text)
