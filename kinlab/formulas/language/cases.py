"""Special cases that are told in front of what holds in general: ``at q2 = 0: g2 = ...``."""

from __future__ import annotations

import re

from kinlab.formulas.language.prose import equations_of, has_condition, say_of_what
from kinlab.formulas.language.vocabulary import CHINESE, LATIN, is_of_a_part, words_of

_MOST = 60
"""Signs of equality of a text that is looked through."""
_ENDS = re.compile(r"\n+|(?<=[\s\w)}\]²³])(?:[;；。]|\.(?=\s))\s*")
_IN_GENERAL = re.compile(
    r"\s*(?:and\s+|but\s+|und\s+)?(?:in\s+general|generally|in\s+the\s+general\s+case|for\s+(?:any|all)\s+(?:other\s+)?"
    r"(?:angles?|states?|q)|otherwise|else|in\s+every\s+other\s+case|(?:im\s+)?allgemein(?:en|er\s+fall)?|sonst|ansonsten"
    r"|en\s+général|en\s+general|in\s+generale|sinon|altrimenti|一般地|一般情况下?|一般来说|通常|否则)"
    r"(?:\s+(?:we\s+have|it\s+is|gilt|ist|wird|on\s+a|有))?\s*[,，:：]?\s*",
    re.IGNORECASE,
)


def without_special_cases(text: str, entry: str) -> tuple[str, list[str]]:
    """The text from where it says what holds in general, where special cases stand in front.

    Args:
        text: as typed.
        entry: what the formula is asked for.

    Returns:
        It; and the special cases, each with a condition and an equation for the entry.
    """
    if not 2 <= text.count("=") <= _MOST:
        return text, []
    pieces, begin = list[tuple[int, int]](), 0
    for end in _ENDS.finditer(text):
        pieces.append((begin, end.start()))
        begin = end.end()
    pieces.append((begin, len(text)))
    own = [(start, end) for start, end in pieces if equations_of(text[start:end], entry)]
    if len(own) < 2:
        return text, []
    *special, last = own
    found = _IN_GENERAL.match(text, last[0])
    cases = [text[start:end].strip() for start, end in special]
    if found is None or not all(map(has_condition, cases)):
        return text, []
    kept = [text[a:b].strip() for a, b in pieces if (a, b) not in special and b <= last[0]]
    return "\n".join([*filter(None, kept), text[found.end() :]]), cases


def without_words_of_parts(text: str, entry: str) -> str:
    """The text without what is said in front of the entry's equations for parts of the arm, where
    the last of its equations has other words in front: ``only link 1: ..., both: ...``.

    Args:
        text: as typed.
        entry: what the formula is asked for.
    """
    if text.count("=") > _MOST:
        return text
    own = equations_of(text, entry)
    if len(own) < 2:
        return text
    fronts = [_FRONT.search(text[: one.start()]) for one in own]
    if fronts[-1] is None or not say_of_what(fronts[-1][0]):
        return text
    of_parts = [x for x in fronts[:-1] if x is not None and all(map(is_of_a_part, words_of(x[0])))]
    for found in reversed(of_parts):
        text = f"{text[: found.start()]}{text[found.end() :]}"
    return text


_FRONT = re.compile(rf"(?:[{LATIN}{CHINESE}\d'’ -]{{2,60}})[:：,，]?\s*$")
"""The words in front of an equation, on its line."""
