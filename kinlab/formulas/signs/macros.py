r"""Commands of LaTeX that a writer has made: ``\newcommand{\q}{\theta}``, ``\def\m{m_2}``."""

from __future__ import annotations

import re
from functools import partial

from kinlab.formulas.signs.brackets import closes
from kinlab.formulas.signs.refusals import refused
from kinlab.host.language import N_

_MADE = re.compile(
    r"\\(?:(?:re|provide)?newcommand\*?\s{0,9}(?:\{\s{0,9}\\(?P<a>[A-Za-z]+)\s{0,9}\}|\\(?P<b>[A-Za-z]+))"
    r"\s{0,9}(?:\[\s{0,9}(?P<count>[1-9])\s{0,9}\])?"
    r"|def\s{0,9}\\(?P<c>[A-Za-z]+)(?P<places>(?:\s{0,9}#[1-9]){0,9})"
    r"|DeclareMathOperator\*?\s{0,9}\{\s{0,9}\\(?P<operator>[A-Za-z]+)\s{0,9}\})\s{0,9}(?=\{)"
)
_PLACE = re.compile(r"#([1-9])")
_BRACES = ("{", "}")
_MOST, _LONGEST = 200, 20_000
"""Uses that are written out; signs that a formula has then."""


def written_out(text: str, place: str) -> str:
    """The text with what its writer's own commands stand for.

    Args:
        text: as typed.
        place: what to put in front of a message.

    Raises:
        ExpressionError: commands that stand for one another, or too many.
    """
    made: dict[str, tuple[int, str]] = {}
    while found := _MADE.search(text):
        end = closes(text, found.end(), _BRACES)
        name = found["a"] or found["b"] or found["c"] or found["operator"]
        if end < 0:
            return text
        body = text[found.end() + 1 : end]
        body = rf"\operatorname{{{body}}}" if found["operator"] else body
        made[name] = (int(found["count"] or (found["places"] or "").count("#")), body)
        text = text[: found.start()] + text[end + 1 :]
    if not made:
        return text
    used = re.compile(rf"\\({'|'.join(map(re.escape, made))})(?![A-Za-z])")
    for _use in range(_MOST):
        found = used.search(text)
        if found is None:
            return text.strip()
        count, body = made[found[1]]
        given, end = _arguments(text, found.end(), count)
        body = _PLACE.sub(partial(_given, given), body)
        behind = " " if body[-1:].isalpha() and text[end : end + 1].isalpha() else ""
        text = f"{text[: found.start()]}{body}{behind}{text[end:]}"
        if len(text) > _LONGEST:
            break
    said = N_(
        "the commands made with \\newcommand cannot be written out; write the formula without"
    )
    raise refused(place, said)


def _given(arguments: list[str], place: re.Match[str]) -> str:
    """What is given for ``#1``; the sign itself where nothing is."""
    number = int(place[1])
    return arguments[number - 1] if number <= len(arguments) else place[0]


def _arguments(text: str, start: int, count: int) -> tuple[list[str], int]:
    """What stands behind a command: groups in braces, or one sign each; and where that ends."""
    given: list[str] = []
    for _place in range(count):
        while text[start : start + 1].isspace():
            start += 1
        end = closes(text, start, _BRACES) if text[start : start + 1] == "{" else -1
        if end > 0:
            given.append(text[start + 1 : end])
        else:
            sign = re.compile(r"\\[A-Za-z]+|.?", re.DOTALL).match(text, start)
            end = (sign.end() if sign else start) - 1
            given.append(text[start : end + 1])
        start = end + 1
    return given, start
