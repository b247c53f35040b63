"""Angles in degrees: ``90°``, ``deg2rad(90)``, ``cosd(rad2deg(q1))``, as angles in radians.

``cosd(q1)`` stays, for joints are in radians.
"""

from __future__ import annotations

import re

from kinlab.formulas.signs.brackets import closes, parts_at

_SIGN = re.compile(r"(?<![\w.])(\d+(?:\.\d+)?)\s*[°º]")
_PREFIX = r"(?<![\w.])(?:(?:np|numpy|math|sp|sympy)\.)?"
_CALLS = (
    (re.compile(rf"{_PREFIX}(?:deg2rad|radians)\s*(?=\()"), "({inside}*{pi}/180)"),
    (re.compile(rf"{_PREFIX}(?:rad2deg|degrees)\s*(?=\()"), "({inside}*180/{pi})"),
)
_WAVE = re.compile(rf"{_PREFIX}(sin|cos|tan)d\s*(?=\()")
_FACTOR = r"\(?180\s*/\s*(?:(?:np|math)\.)?(?:pi|π)\)?"
_ONE = r"(?:[^\W\d]\w*(?:\[\d\]|\(\d\))?|\(([^()]|\([^()]*\))*\))"
_DEGREES = re.compile(
    rf"\d+(?:\.\d+)?|{_PREFIX}(?:rad2deg|degrees)\s*{_ONE}|{_ONE}\s*\*\s*{_FACTOR}"
    rf"|{_FACTOR}\s*\*\s*{_ONE}"
)
"""A term that is an angle in degrees whatever its names are: a number, ``(q1 + q2)*180/pi``."""
_MOST = 50
_PARENTHESES = ("(", ")")


def in_radians(text: str, pi: str, calls: bool = True) -> str:
    """The text with angles in radians.

    Args:
        text: as typed.
        pi: the number pi as it is written there.
        calls: whether functions have their names in plain text.
    """
    text = _SIGN.sub(rf"(\1*{pi}/180)", text)
    if not calls:
        return text
    start = 0
    for _ in range(_MOST):
        found = _WAVE.search(text, start)
        if found is None:
            break
        start = found.end()
        end = closes(text, start, _PARENTHESES) + 1
        if end and _in_degrees(text[start + 1 : end - 1]):
            text = f"{text[: found.start()]}{found[1]}({text[start:end]}*{pi}/180){text[end:]}"
            start = found.start() + 1
    for called, instead in _CALLS:
        for _ in range(_MOST):
            found = called.search(text)
            end = closes(text, found.end(), _PARENTHESES) + 1 if found else 0
            if found is None or not end:
                break
            inside = instead.format(inside=text[found.end() : end], pi=pi)
            text = f"{text[: found.start()]}{inside}{text[end:]}"
    return text


def _in_degrees(angle: str) -> bool:
    """Whether each term of an angle is surely in degrees."""
    terms = parts_at(angle.strip().removeprefix("-"), "+-")
    return all(_DEGREES.fullmatch(term) for term in terms)
