"""Factors side by side in plain text, as in a book: ``2 l1 c12``, ``m2(a + b)``.

What two people would read differently is refused: ``g (q1)``, ``a/b c``, ``cos q1 + q2``.
"""

from __future__ import annotations

import re

from kinlab.errors import ExpressionError
from kinlab.formulas.signs.refusals import refused
from kinlab.host.language import N_, _

_TOKEN = re.compile(
    r"\s*(?:(?P<number>\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+)|(?P<name>[A-Za-z_]\w*)"
    r"|(?P<sign>\*\*|[-+*/^(),]))"
)
_ANGLE = re.compile(r"(?:q|th|theta)(?:_?[1-9]\d?)?")
_WAVES = {"sin", "cos", "tan"}
_FOLLOWING = re.compile(r"\s*[-+]\s*(?:q|th|theta)_?\d")
_WHOLE = re.compile(r"\d+")
_Token = tuple[str, str, int, int]
"""What kind it is, itself, and where it stands."""


def with_products(text: str, functions: set[str], place: str) -> str:
    """The text with ``*`` between factors that stand side by side.

    Args:
        text: plain text without indices in brackets.
        functions: names that are called.
        place: what to put in front of a message.

    Raises:
        ExpressionError: what can be read in two ways.
    """
    tokens = _tokens(text)
    if tokens is None:
        return text
    out: list[str] = []
    behind, k, below = 0, 0, [""]
    while k < len(tokens):
        kind, token, start, _end = tokens[k]
        last, before = tokens[k - 1][:2] if k else ("", "")
        gap = text[behind:start]
        ends = last in ("number", "name") or before == ")"
        begins = kind in ("number", "name") or token == "("
        if ends and begins and not (token == "(" and before in functions):
            if _is_no_product(tokens, k, gap):
                return text
            if below[-1] and not (gap and last == "number"):
                under = below[-1]
                what = _("{factor} behind .../{under}").format(factor=token, under=under)
                remedy = _("a/({under}*b) or (a/b)*c").format(under=under)
                raise _unsure(place, what, remedy)
            _refuse_call(tokens, k, place)
            gap = "*"
        if token in ("+", "-", "*", ",") or before == "/":
            half = kind == "number" and k > 1 and tokens[k - 2][0] == "number"  # 1/2 m v^2
            below[-1] = token if before == "/" and not half else ""
        below = [*below, ""] if token == "(" else below[:-1] if token == ")" else below
        if not below:
            return text
        piece, used = _wave(tokens, k, text, place) if token in _WAVES else ("", 0)
        out += [gap, piece or token]
        k += used or 1
        behind = tokens[k - 1][3]
    return "".join(out) + text[behind:]


def _tokens(text: str) -> list[_Token] | None:
    found, at = [], 0
    while at < len(text.rstrip()):
        match = _TOKEN.match(text, at)
        if match is None or match.lastgroup is None:
            return None
        kind = match.lastgroup
        found.append((kind, match[kind], match.start(kind), match.end()))
        at = match.end()
    return found or None


def _unsure(place: str, what: str, remedy: str) -> ExpressionError:
    return refused(
        place, N_("{what} can be read in two ways; write {remedy}"), what=what, remedy=remedy
    )


def _is_no_product(tokens: list[_Token], k: int, gap: str) -> bool:
    """Two numbers, a name before a number, a name glued to a bracket: left as it is."""
    kind, token = tokens[k][:2]
    last, before = tokens[k - 1][:2]
    called = last == "name" and token == "(" and not gap
    return kind == "number" or (called and not before[-1].isdigit())


def _refuse_call(tokens: list[_Token], k: int, place: str) -> None:
    """``g2(q1)`` may be g2 times q1, or g2 of q1."""
    if tokens[k][1] != "(" or tokens[k - 1][0] != "name":
        return
    inside = [token for _kind, token, _start, _end in tokens[k + 1 : k + 3]]
    if len(inside) == 2 and inside[1] in (")", ",") and _ANGLE.fullmatch(inside[0]):
        name = tokens[k - 1][1]
        remedy = _("{product} for a product").format(product=f"{name}*{inside[0]}")
        raise _unsure(place, f"{name}({inside[0]}", remedy)


def _wave(tokens: list[_Token], k: int, text: str, place: str) -> tuple[str, int]:
    """``cos q1`` and ``cos^2(q1 + q2)`` as calls, with how many tokens they were."""
    name, at, power = tokens[k][1], k + 1, ""
    if (
        at + 1 < len(tokens)
        and tokens[at][1] in ("^", "**")
        and _WHOLE.fullmatch(tokens[at + 1][1])
    ):
        power, at = f"**{tokens[at + 1][1]}", at + 2
    if at >= len(tokens):
        return "", 0
    kind, token, start, end = tokens[at]
    if kind == "name" and token not in _WAVES:
        if not _ANGLE.fullmatch(token) or _FOLLOWING.match(text, end):
            remedy = _("{call}, with parentheses").format(call=f"{name}({token})")
            raise _unsure(place, f"{name} {token}", remedy)
        if text[end:].lstrip()[:1] in ("^", "/") or text[end:].lstrip()[:2] == "**":
            before = _("{function} before a sign").format(function=f"{name} {token}")
            raise _unsure(place, before, f"{name}({token})")
        return f"{name}({token}){power}", at + 1 - k
    if token == "(" and power:
        depth = 0
        for j in range(at, len(tokens)):
            depth += (tokens[j][1] == "(") - (tokens[j][1] == ")")
            if not depth:
                return f"{name}{text[start : tokens[j][3]]}{power}", j + 1 - k
    return "", 0
