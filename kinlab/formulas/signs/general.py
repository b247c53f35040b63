r"""What is explained for every joint at once: ``c_i = \cos\theta_i`` as ``c_1 = \cos\theta_1``.

``x = l1*c1 + l2*c12 (ci = cos qi, cij = cos(qi + qj))`` explains c1 and c12; nothing is taken for
granted of such a definition, so that ``c_i = \sin\theta_i`` is not what everybody calls so.
"""

from __future__ import annotations

import re
import unicodedata
from functools import partial

_GENERAL = re.compile(
    r"(?<![\w\\}])(?:(?P<name>\\?[A-Za-z]{1,6}|[α-ω])_\s?"
    r"(?:\{\s?(?P<c>[cC]?)\s?(?P<braced>[ijk]{1,3})\s?\}|(?P<below>[ijk]{1,3}))"
    r"|(?P<short>[csCSlmI]|lc)(?P<glued>[ijk]{1,3}))"
    r"\s*(?::\s?=|=|≡|\\equiv(?![A-Za-z]))\s*(?=\S)"
)
"""A name with letters below, and the sign of equality behind it."""
_END = re.compile(r"[,;\n$]|\s(?:and|und|et|y|e)\s|和|\.(?=\s|$)|\\q?quad|\\\\")
_SUBSCRIPT = (
    r"(?:(?<=[A-Za-zθ])_\s?\{{?\s?(?P<below>[c]?){0}\s?\}}?(?![A-Za-z])"
    r"|(?<![A-Za-z\\])(?P<head>[A-Za-zθ]|lc){0}(?![A-Za-z]))"
)
_FOR_ALL = re.compile(
    r"\s*(?:\bfor\s+)?\(?\s*(?<![\w*/^+-])[ijk]\s*=\s*1\s*,\s*(?:2|\\l?dots|\.{2,3}|…)"
    r"(?:[\s,.\dn…]|\\l?dots){0,12}\)?"
)
"""Which joints there are: ``i = 1, ..., n``."""


_INDEX = r"(?:_\{?[ijk]\}?)?"
_POSITIONS = rf"(?:\\(?:mathbf|boldsymbol|bm|vec)\s?\{{?\s?)?\\?(?:theta|q|θ)\s?\}}?{_INDEX}"
_RATES = re.compile(
    rf"(?<![\w\\}}])(?P<name>[A-Za-zα-ω]|\\[a-z]{{2,6}}){_INDEX}\s?=\s?(?:"
    rf"(?P<once>d{_POSITIONS}/dt|\\dot\s?\{{?\s?{_POSITIONS}\s?\}}?{_INDEX}|[qθ]\u0307{_INDEX}"
    rf"|(?:qd|dq){_INDEX}(?!\w))"
    rf"|(?:d(?:\^\{{?2\}}?|²){_POSITIONS}/dt(?:\^\{{?2\}}?|²)"
    rf"|\\ddot\s?\{{?\s?{_POSITIONS}\s?\}}?{_INDEX}|[qθ]\u0308{_INDEX}"
    rf"|(?:qdd|ddq){_INDEX}(?!\w)))(?![\w_₁-₉])"
)
"""A vector that is that of all rates: ``v = dq/dt``, ``\\alpha = \\ddot\\theta``."""


_SO_ON = r"(?:\\[lc]?dots|\.{2,3}|…)"
_ANY_SUM = re.compile(
    rf"(?P<name>[csCS])_?\{{?[ijk]{{1,3}},?\s?{_SO_ON}[ijkn]?\}}?"
    r"\s?=\s?(?P<call>\\?(?:sin|cos))\s?"
    rf"(?:\\left)?\(\s?(?P<angle>\\?(?:theta|q|θ))_?\{{?[ijk]\}}?"
    rf"(?:\s?\+\s?(?P=angle)_?\{{?[ijk]\}}?)*\s?\+\s?{_SO_ON}"
    rf"(?:\s?\+\s?(?P=angle)_?\{{?[ijkn]\}}?)?\s?(?:\\right)?\)"
)
"""``s_{ij\\ldots} = \\sin(q_i + q_j + \\ldots)``: of as many joints as a name has."""


def _of_any_joints(found: re.Match[str]) -> str:
    """The definitions of all names that have the letter in front."""
    used = rf"(?<![A-Za-z\\]){found['name']}_?(?:\{{\s?([1-9]+)\s?\}}|([1-9]+))"
    made = []
    for one in {x[0]: x for x in re.finditer(used, found.string)}.values():
        angles = "+".join(f"{found['angle']}_{digit}" for digit in one[1] or one[2])
        made.append(f"{one[0]} = {found['call']}({angles})")
    return ", ".join(made) or found[0]


def _with_rates(text: str) -> str:
    """The text with the rates of joints in place of the vector that they are."""
    typeset = "\\" in text

    def each(found: re.Match[str]) -> str:
        name = (
            rf"(?<![A-Za-z\\]){re.escape(found['name'])}_?(?:\{{\s?([1-9])\s?\}}|([1-9₁-₉]))(?!\d)"
        )
        made = []
        for one in {x[0]: x for x in re.finditer(name, text)}.values():
            digit = unicodedata.normalize("NFKC", one[1] or one[2])
            dots = "d" if found["once"] else "dd"
            rate = rf"\{dots}ot{{q}}_{{{digit}}}" if typeset else f"q{dots}{digit}"
            made.append(f"{one[0]} = {rate}")
        return ", ".join(made) or found[0]

    return _RATES.sub(each, text)


def for_each_joint(text: str) -> str:
    """The text with each general definition as those of the names that stand in it.

    Args:
        text: as typed.
    """
    text = _ANY_SUM.sub(_of_any_joints, _with_rates(text))
    found, at = list[tuple[int, int, re.Match[str]]](), 0
    while one := _GENERAL.search(text, at):
        end = at = _end_of(text, one.end())
        if all(_of(letter).search(text[one.end() : end]) for letter in _letters_of(one)):
            found.append((one.start(), end, one))
    rest = text
    for start, end, _one in reversed(found):
        rest = rest[:start] + rest[end:]
    for start, end, one in reversed(found):
        made = _instances(one, text[one.end() : end], rest)
        text = f"{text[:start]}{', '.join(made)}{text[end:]}" if made else text
    return _FOR_ALL.sub("", text) if found else text


def _end_of(text: str, start: int) -> int:
    """Where a formula ends that begins at a place: at a comma or a word outside of brackets."""
    depth = 0
    for k in range(start, len(text)):
        depth += (text[k] in "([{") - (text[k] in ")]}")
        if depth < 0 or (depth == 0 and _END.match(text, k)):
            return k
    return len(text)


def _letters_of(general: re.Match[str]) -> str:
    return general["braced"] or general["below"] or general["glued"]


def _of(letter: str) -> re.Pattern[str]:
    return re.compile(_SUBSCRIPT.format(letter))


def _instances(general: re.Match[str], right: str, text: str) -> list[str]:
    """The definitions of the names that stand in a text."""
    letters = _letters_of(general)
    head = general["name"] or general["short"]
    below = general["c"] or ""
    pattern = (
        rf"(?<![A-Za-z\\]){re.escape(head)}_?\s?\{{?\s?{below}\s?([1-9]{{{len(letters)}}})(?!\d)"
    )
    made = []
    for digits in dict.fromkeys(re.findall(pattern, text)):
        own = right
        for letter, digit in zip(letters, digits, strict=True):
            own = _of(letter).sub(partial(_indexed, digit=digit), own)
        braced = f"_{{{below}{digits}}}" if general["braced"] else f"_{digits}"
        name = f"{head}{digits if general['glued'] else braced}"
        made.append(f"{name} = {own.strip()}")
    return made


def _indexed(found: re.Match[str], digit: str) -> str:
    if found["head"]:
        return f"{found['head']}{digit}"
    return f"_{{{found['below']}{digit}}}" if found["below"] else f"_{digit}"
