"""The door of the Markdown reports: every text from a file passes through here.

A viewer of Markdown lets HTML through and makes links and headings of what looks like them, so a
name such as ``</h1><script>`` must arrive as the characters it is made of.
"""

from __future__ import annotations

import re

from kinlab.formulas.typeset import mathml, plain
from kinlab.host.web import page_text

_ENTITIES = {"&": "&amp;", "<": "&lt;", ">": "&gt;"}
_MARKS = re.compile(r"[\\`*\[\]|~$]|(?<![^\W_])_|_(?![^\W_])")
_AT_THE_FRONT = re.compile(r"([#+=-]|\d+(?=[.)]))(?=\W|$)")


def words(text: str) -> str:
    """A text as one line of Markdown that shows exactly its characters.

    Args:
        text: anything; runs of white space, line ends among them, become one space.
    """
    line = " ".join(page_text(text).split())
    line = _MARKS.sub(lambda found: "\\" + found[0], line)
    line = re.sub("[&<>]", lambda found: _ENTITIES[found[0]], line)
    front = _AT_THE_FRONT.match(line)
    if front is None:
        return line
    end = front.end() if front[1][0].isdigit() else 0
    return f"{line[:end]}\\{line[end:]}"


def code(text: str) -> str:
    """A text as a code span, which ends only at as many back-ticks as it began with."""
    line = " ".join(page_text(text).split())
    fence = "`" * (1 + _longest(line))
    space = " " if line[:1] in ("", "`") or line[-1:] == "`" else ""
    return f"{fence}{space}{line}{space}{fence}"


def formula(latex: str) -> str:
    """LaTeX as a displayed formula; what is no mathematics is shown as it is written.

    Args:
        latex: from a record; the pieces that are marked get a colour.
    """
    if "$" in latex or "`" in latex or not mathml(latex).startswith("<math"):
        return code(latex)
    line = " ".join(page_text(plain(latex)).split())
    line = line.replace("<", r"\lt ").replace(">", r"\gt ").replace("](", "] (")
    return f"$${line}$$"


def block(text: str, language: str) -> str:
    """A text of several lines as a fenced block, as it is.

    Args:
        text: without the characters that no page may hold, see
            :func:`kinlab.host.web.page_text`.
        language: of the text, such as ``"toml"``.
    """
    fence = "`" * max(3, 1 + _longest(text))
    return f"{fence}{language}\n{page_text(text).rstrip()}\n{fence}"


def _longest(text: str) -> int:
    """The longest run of back-ticks."""
    return max(map(len, re.findall("`+", text)), default=0)
