"""Rates as programs of algebra name them: ``diff(q1(t), t, 2)``, ``q1''[t]``, ``q1pp``.

They become ``qd1`` and ``qdd1``; a name that the writer explains stays.
"""

from __future__ import annotations

import re
from functools import partial

_JOINT = r"(?P<head>q|th|theta|\\theta|θ)_?\{?(?P<k>\d{1,2}|[₁-₉])\}?"
_OF_TIME = r"\s*(?:\(\s*t\s*\)|\[\s*t\s*\])?"
_MODULE = r"(?<![\w.\\])(?:(?:sp|sympy|sym)\.)?"
_T = r"\s*,\s*"
_ONCE = rf"{_T}(?:t|\(\s*t\s*{_T}1\s*\)|\{{\s*t\s*{_T}1\s*\}})"
_TWICE = rf"{_T}(?:t{_T}(?:t|2)|\(\s*t{_T}2\s*\)|\{{\s*t{_T}2\s*\}})"
_D = r"(?:d|\\mathrm\s*\{\s*d\s*\}|\\mathrm\s+d)"
_SQUARED = r"(?:\^\s*2|\^\s*\{\s*2\s*\}|²|\*\*2)"
_SPACE = r"\s*(?:\\[,;:!]\s*)?"

_WAYS = tuple(
    (re.compile(pattern), order)
    for pattern, order in (
        (rf"{_MODULE}(?:diff|Derivative)\(\s*{_JOINT}{_OF_TIME}{_TWICE}\s*\)", 2),
        (rf"{_MODULE}(?:diff|Derivative)\(\s*{_JOINT}{_OF_TIME}{_ONCE}\s*\)", 1),
        (rf"(?<![\w.\\])D\[\s*{_JOINT}{_OF_TIME}{_TWICE}\s*\]", 2),
        (rf"(?<![\w.\\])D\[\s*{_JOINT}{_OF_TIME}{_ONCE}\s*\]", 1),
        (rf"(?<![\w.\\]){_JOINT}{_OF_TIME}\.diff\(\s*t{_T}(?:t|2)\s*\)", 2),
        (rf"(?<![\w.\\]){_JOINT}{_OF_TIME}\.diff\(\s*t\s*\)", 1),
        (rf"(?<![\w.\\]){_JOINT}\s?(?:''|′′|″)\s*(?:\[\s*t\s*\]|\(\s*t\s*\))", 2),
        (rf"(?<![\w.\\]){_JOINT}\s?['′]\s*(?:\[\s*t\s*\]|\(\s*t\s*\))", 1),
        (rf"(?<![\w.\\]){_JOINT}\[\s*t\s*\]", 0),
        (rf"\\[dt]?frac\s*\{{\s*{_D}{_SQUARED}{_SPACE}{_JOINT}\s*\}}\s*"
         rf"\{{\s*{_D}{_SPACE}t\s*{_SQUARED}\s*\}}", 2),
        (rf"\\[dt]?frac\s*\{{\s*{_D}{_SPACE}{_JOINT}\s*\}}\s*\{{\s*{_D}{_SPACE}t\s*\}}", 1),
        (rf"(?<![\w.\\])d{_SQUARED}\s?{_JOINT}\s?/\s?dt{_SQUARED}", 2),
        (rf"(?<![\w.\\])d{_JOINT}\s?/\s?dt(?!\w)", 1),
    )
)  # fmt: skip
_POINTS = re.compile(r"(?<![\w.\\])(q|th|theta)_?(?:(\d)_?(p{1,2})|(p{1,2})_?(\d))(?!\w)")
_PRIMES = re.compile(r"(?<![\w.\\])(q|th|theta|θ)\s?(''|′′|″|['′])(?![\w'′″])")
_CALLED = re.compile(r"(?<![\w.\\])(d{1,2})ot\(\s*(q|th|theta|θ)_?(\d?)\s*\)")
"""Of an arm's only joint too: ``theta''``, ``ddot(theta)``."""
_POINT_IN_WAVE = re.compile(r"(?:sin|cos|tan)\([^()]*(?:q|th|theta)_?\d_?p{1,2}(?!\w)")
"""q1p in a cosine is an angle."""
MOVING = re.compile(
    r"(?<!c)dot|d{1,2}_?(?:q|th)|(?:q|th|theta)_?d{1,2}|[\u0307\u0308]|diff|Derivative|''"
)
"""What says that something moves, as it is typed."""
_ORDERS = re.compile(r"(?<![\w.\\])D([12]?)(q|th|theta)_?(\d)(?!\w)")
_EXPLAINED = re.compile(r"(?<![\w.\\])(\w+)\s*:?=(?!=)")
_TIME = re.compile(r"(?<![A-Za-z])(?:t|dt)(?![A-Za-z])")
_ANGLES = re.compile(r"(?<![A-Za-z])(?:sin|cos)\(\s*t_?\d")
_OF_ANGLES = re.compile(r"(?<![\w.\\])(d{1,2})t_?(\d)(?!\w)")
_TIMES = re.compile(r"(?<![\w.])(?:dt|t)(?!\w)")
_DIGITS = str.maketrans("₁₂₃₄₅₆₇₈₉", "123456789")
_DOTS = ("", r"\dot", r"\ddot")


_OF_PHI = re.compile(
    r"\\d?dot\s*\{?\s*\\(?:var)?phi(?![A-Za-z])|[φϕ][\u0307\u0308]|(?<![A-Za-z])(?:d{1,2}phi|phid{1,2})(?:_?\d|(?!\w))"
)
_ANGLE = re.compile(
    r"\\(?:var)?theta|[θϑ]|(?<![A-Za-z\\])(?:d{0,2}(?:q|th|theta)|(?:q|th|theta)d{1,2})\}?(?:_|\d)"
)
_PHI = re.compile(
    r"\\(?:var)?phi(?![A-Za-z])|[φϕ]|(?<![A-Za-z])phi(?=[_\d])|(?<=(?<![A-Za-z])d)phi(?=[_\d])|(?<=(?<![A-Za-z])dd)phi(?=[_\d])|(?<![A-Za-z])phi(?=d{1,2}(?:_?\d|(?!\w)))"
    r"|(?<![A-Za-z\\])phi(?!\w)|(?<=(?<![A-Za-z])d)phi(?!\w)|(?<=(?<![A-Za-z])dd)phi(?!\w)"
)
"""The angles of joints as phi, where they have rates, and no other letter stands for them."""


def plain_rates(text: str) -> str:
    """The text with ``qd1`` or ``\\dot{q}_1`` for the rates of joints."""
    if _OF_PHI.search(text) and not _ANGLE.search(text):
        text = _PHI.sub(lambda found: "\\theta" if found[0][0] == "\\" else "theta", text)
    typeset = "\\" in text
    if _TIME.search(text):
        for pattern, order in _WAYS:
            text = pattern.sub(partial(_named, order=order, typeset=typeset), text)
    own = {*_EXPLAINED.findall(text)}
    if not typeset:
        if not _POINT_IN_WAVE.search(text):
            text = _POINTS.sub(lambda found: _of_points(found, own), text)
        text = _PRIMES.sub(_of_primes, text)
        text = _CALLED.sub(lambda found: f"{_plain(found[2])}{found[1]}{found[3]}", text)
        text = _ORDERS.sub(lambda found: _of_orders(found, own), text)
        if _ANGLES.search(text) and not _TIMES.search(text):
            text = _OF_ANGLES.sub(lambda found: _of_letters(found, own), text)
    return text


def _of_primes(found: re.Match[str]) -> str:
    once = found[2] in ("'", "′")
    return _plain(found[1]) + ("d" if once else "dd")


def _plain(head: str) -> str:
    return "theta" if head == "θ" else head


def _of_letters(found: re.Match[str], own: set[str]) -> str:
    return found[0] if found[0] in own else f"q{found[1]}{found[2]}"


def _named(found: re.Match[str], order: int, typeset: bool) -> str:
    head, joint = found["head"], found["k"].translate(_DIGITS)
    if typeset:
        head = head if head in ("q", r"\theta") else r"\theta"
        below = f"_{joint}" if len(joint) == 1 else f"_{{{joint}}}"
        return f"{_DOTS[order]}{{{head}}}{below}" if order else f"{head}{below}"
    return f"{_plain(head)}{'d' * order}{joint}"


def _of_points(found: re.Match[str], own: set[str]) -> str:
    if found[0] in own:
        return found[0]
    return f"{found[1]}{'d' * len(found[3] or found[4])}{found[2] or found[5]}"


def _of_orders(found: re.Match[str], own: set[str]) -> str:
    return found[0] if found[0] in own else f"{found[2]}{'d' * int(found[1] or 1)}{found[3]}"
