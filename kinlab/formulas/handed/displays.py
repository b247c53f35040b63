r"""Equations that LaTeX sets in lines of their own: ``\begin{align} a &= ... \\ b &= ...``."""

from __future__ import annotations

import re

_DISPLAY = re.compile(
    r"(?:\\\[|\$\$|\\begin\{equation\*?\})\s{0,9}\\begin\{(?P<in>aligned|gathered|split)\}(?:\[\w\])?"
    r"(?P<inner>.*?)\\end\{(?P=in)\}[\s.,;]{0,9}(?:\\\]|\$\$|\\end\{equation\*?\})"
    r"|\\begin\{(?P<of>(?:equation|align|alignat|gather|eqnarray|flalign|multline)\*?)\}(?:\{\d\})?"
    r"(?P<rows>.*?)\\end\{(?P=of)\}",
    re.DOTALL,
)
_INSIDE = re.compile(r"\\begin\{(\w*matrix|array|aligned|split)\}.*?\\end\{\1\}", re.DOTALL)
_BREAK = re.compile(r"\\\\(?:\[[^\]]*\])?")
_LABEL = re.compile(r"\\(?:label|tag\*?)\{[^{}]*\}|\\(?:nonumber|notag)\b")
_NAMED = re.compile(r"\s*(?!\\[dt]?frac|\\partial)\\?[A-Za-z][\w\\{}^,.() ]{0,24}:?=(?!=)")
"""A name and its sign of equality."""


def rows_of(display: str) -> list[str]:
    """The equations of a display, in its order; what is broken inside a matrix stays whole.

    A row without a sign of equality goes on with the sum above it. Of ``a &= x, & b &= y`` each is
    one of its own.

    Args:
        display: what stands in it.
    """
    matrices = [m[0] for m in _INSIDE.finditer(display)]
    held = display
    for k, matrix in enumerate(matrices):
        held = held.replace(matrix, f"\x01{k}\x01", 1)
    rows: list[str] = []
    for part in _BREAK.split(held):
        for one in _side_by_side(part):
            line = one.replace("&", " ").strip()
            if rows and line and "=" not in line:
                rows[-1] += f" {line}"
            elif line:
                rows.append(line)
    return [re.sub("\x01(\\d+)\x01", lambda m: matrices[int(m[1])], row) for row in rows]


def _side_by_side(row: str) -> list[str]:
    """The equations of a row with several columns of them."""
    cells = row.split("&")
    pairs = [*zip(cells[::2], cells[1::2], strict=False)]
    alike = len(cells) % 2 == 0 and len(pairs) > 1
    if not alike or not all(_NAMED.match(f"{one}{other.lstrip()}") for one, other in pairs):
        return [row]
    return [f"{one}{other}".strip().rstrip(",;") for one, other in pairs]


def shown_apart(display: str) -> list[str]:
    """The equations of a display between dollars, if each is a name's; else the display itself."""
    found = _DISPLAY.fullmatch(display.strip())
    rows = _inline(found).split("\n") if found else []
    return [row.rstrip(",") for row in rows if row] if len(rows) > 1 else [display]


def in_lines(text: str) -> str:
    """A text whose displayed equations stand between dollars, whatever is around them."""
    return _DISPLAY.sub(_inline, text)


def with_displays_inline(text: str) -> str:
    """A text whose displayed equations stand between dollars, one to a line, beside another one.

    Only those of which each is a name's: ``$M = a + b$ with \\begin{align} a &= ...``.
    """
    rest, count = _DISPLAY.subn("", text)
    return in_lines(text) if "=" in rest or count > 1 else text


def _inline(found: re.Match[str]) -> str:
    rows: list[str] = []
    for row in rows_of(_LABEL.sub("", found["rows"] or found["inner"])):
        if row.startswith("=") and rows:
            rows[-1] += f" {row}"
        else:
            rows.append(row)
    if not rows or not all(map(_NAMED.match, rows)):
        return found[0]
    bare = (row.strip().rstrip(",;.") for row in rows)
    return "\n" + ",\n".join(f"${row}$" for row in bare) + "\n"
