"""What was printed or scanned: exponents on the line above, rows of a matrix by lines alone.

And decimal commas, where no number has a point.
"""

from __future__ import annotations

import re
import unicodedata
from itertools import pairwise

from kinlab.formulas.signs.brackets import parts_at

_RAISED = re.compile(r"[ \t]*\d(?:[ \t]|\d)*")
_BASE = re.compile(r"[^\W_]|[)\]₀-₉⎠]")
_DRAWN = re.compile(r"\[([^\[\],;&=\n]*(?:\n[^\[\],;&=\n]*){1,20})\]")
_APART = re.compile(r"[ \t]{2,}")
_SCANNED = re.compile(r"(?<![^\W_])([^\W\d_]|lc)((?: \d)+)(?![\d.,]|[ ]?[.,]\d)")
_HIGH = str.maketrans("⎛⎞⎝⎠", "    ")
_LOW = str.maketrans("⎛⎝⎞⎠", "(())")
_ASKED = re.compile(r"^[ \t]*>>> ?(?:sp\.|sympy\.)?pprint\([^()\n]*\)[ \t]*\n")
_WITH_COMMA = re.compile(
    r"(?<![\w.,_{\[])(?<![ijk]=)(?<![ijk] = )(?<![^\W\d_]{3} )(\d+),(\d+)(?![\w.,]|[)\]}])"
)
_WITH_POINT = re.compile(r"\d\.\d|,\s+\d+,\d")
"""What says that a comma may set two numbers apart."""
_TABLE = re.compile(r"(?m)^[ \t]*\|(?P<name>[^|\n]+)\|(?P<value>[^|\n]+)\|[ \t]*$")
_RULE = re.compile(r"[-: ]+")
_TALL = re.compile(r"(?:^|\n)(?P<front>[^\n⎡]*)⎡(?P<rows>[^⎦⎡]*)⎦", re.DOTALL)
_ROWS = re.compile(r"(?:^|\n)[ \t]*\([^()\n]*(?:\([^()\n]*\)[^()\n]*)*\)[ \t]*(?=\n|$)")
_BRACKETED_ROWS = re.compile(
    r"(?P<front>=[ \t]*)(?P<rows>(?:\n[ \t]*\[[^\[\]\n=;]{1,300}\][ \t]*){2,8})(?=\n|$)"
)
_BARE_ROWS = re.compile(
    r"(?P<front>=[ \t]*)(?P<rows>(?:\n(?=[^\n]*,)[^\n=\[\];:&\\]{3,300}){2,8})(?=\n|$)"
)
"""Rows below ``J =``, each in brackets of its own or in none."""
_GLUED = re.compile(r"[^\W_]\d|\d[^\W\d_]|[^\W\d_]_")
_FEWEST = 4
"""Names with digits apart, of which one reads a scan."""


def as_typed(text: str) -> str:
    """The text as it would be typed in one line, where it was printed over several, or scanned.

    Args:
        text: as handed in, with all its blanks.
    """
    text = _in_brackets(_of_table(text.replace("⟨", "[").replace("⟩", "]")))
    text = _DRAWN.sub(_with_signs, _on_one_line(_ASKED.sub("", text)))
    text = text if _WITH_POINT.search(text) else _WITH_COMMA.sub(r"\1.\2", text)
    return _scanned(text)


def _of_table(text: str) -> str:
    """``M11 = ...`` of the rows of a table of Markdown's, of a name and what it is."""
    if len(_TABLE.findall(text)) < len("ab"):
        return text

    def row(found: re.Match[str]) -> str:
        name, value = found["name"].strip(), found["value"].strip()
        if _RULE.fullmatch(value) or not re.search(r"\d", name):
            return ""
        return "\n".join(f"{one.strip()} = {value}" for one in name.split("="))

    return re.sub(r"\n{2,}", "\n", _TABLE.sub(row, text)).strip()


def _in_brackets(text: str) -> str:
    """``[a, b; c, d]`` of a matrix drawn with tall brackets, or row by row in parentheses."""

    def drawn(found: re.Match[str]) -> str:
        lines = re.sub(r"[⎢⎥⎣⎤]", " ", found["rows"]).split("\n")
        inside = _on_one_line("\n".join(line for line in lines if line.strip()))
        return f"{found['front']}[{inside}\n]"

    text = _BARE_ROWS.sub(_bracketed, _BRACKETED_ROWS.sub(_bracketed, _TALL.sub(drawn, text)))
    rows = [*_ROWS.finditer(text)]
    together = all(one.end() == other.start() for one, other in pairwise(rows))
    if len(rows) < len("ab") or not together:
        return text
    inside = "\n".join(one[0].strip()[1:-1] for one in rows)
    return f"{text[: rows[0].start()]} [{inside}\n]{text[rows[-1].end() :]}"


def _bracketed(found: re.Match[str]) -> str:
    """Rows on lines of their own as one matrix, where all have as many entries."""
    lines = [line.strip().strip("[],;").strip() for line in found["rows"].strip().split("\n")]
    commas = all("," in line for line in lines)
    rows = [parts_at(line, ",") if commas else _APART.split(line) for line in lines]
    if len({len(row) for row in rows}) > 1 or len(rows[0]) < len("ab"):
        return found[0]
    return f"{found['front']}[{'; '.join(', '.join(row) for row in rows)}]"


def _on_one_line(text: str) -> str:
    """Exponents behind what they stand above: ``l1**2`` of sympy's ``pprint``."""
    lines = text.split("\n")
    found: list[str] = []
    k = 0
    while k < len(lines):
        below = lines[k + 1] if k + 1 < len(lines) else ""
        above = lines[k].translate(_HIGH)
        new = _with_raised(above, below) if _RAISED.fullmatch(above) else None
        found.append(lines[k] if new is None else new.translate(_LOW))
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
