"""What a derivation of several steps comes to: the entry's own equations, and what explains them.

``T = ..., V = ...; d/dt(dT/dqd1) = ...; hence tau1 = ... = ...``: for a text that cannot be read as
it is. All else in it is left out; which of its words may mean something is told by
:mod:`kinlab.formulas.language.prose`, as beside any formula.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from itertools import pairwise

from kinlab.errors import ExpressionError
from kinlab.formulas.language.prose import is_condition
from kinlab.formulas.language.sentences import is_word
from kinlab.formulas.language.vocabulary import ASIDE, CHINESE, LATIN, is_linking, is_listed
from kinlab.formulas.typed import (
    begins_with,
    is_name_of,
    is_sister,
    own_name,
    says_what_it_is,
    stands_in,
)

_PROGRAM = re.compile(
    r"\bdef\b|\blambda\b|\breturn\b|\[\[|\w\s?[-+*/]=|(?<!\w)([A-Za-z]\w*)\s?=\s?\1\s?[-+]"
)
_GRID = re.compile(r"\\begin\{(\w*(?:matrix|array|cases)\*?)\}.{0,2000}?\\end\{\1\}", re.DOTALL)
"""A matrix, which is no entry."""
_A_GRID = "\0"
_NAMES_ALONE = re.compile(
    r"(?:\s|&|\\\\|\\(?:begin|end)\{[\w*]+\}(?:\{[lcr| ]*\})?|\\?[A-Za-z]+(?:_\{?\w+\}?|\d+)?)*"
)
_NAMES_LISTED = re.compile(r"\s*\[(?:[\s,;]|[A-Za-z]\w*)*\]\s*")
"""A matrix of names, which others explain."""
_LINES = re.compile(
    r"\\\\(?:\[[\w. ]{0,9}\])?|\\(?:begin|end)\{[a-z]+\*?\}|\\[\[\]()]|\$+|&|\\q?quad(?![A-Za-z])"
    r"|\\(?:Rightarrow|Longrightarrow|implies|therefore|Leftrightarrow|iff)(?![A-Za-z])"
    r"|(?<![<>=])=>|[⇒⟹→⟶∴⇔]|\\text\w*\s*\{[^{}]*\}"
    r"|(?<=[\w)}\]])\s{1,4}\((?=(?:and|und|et|where|with|和|且)[\s\\$]|\w{1,6}\s?=)"
    rf"|{ASIDE}"
)
"""Where one step ends and another begins; words in LaTeX."""
_GAPS = re.compile(r"(?<!\\)\\[,;:! ]")
_LETTER = r"(?:\\?[A-Za-z]{1,16}|[α-ωΑ-Ω𝜃𝜏])"
_INDEX = r"(?:_?\d{1,3}(?:,\d)?[a-z]{0,3}|[₀-₉]{1,3}|_?\{[^{}=\n]{1,12}\}|_[A-Za-z]\d?)"
_NAMED = re.compile(
    rf"(?<![\w\\}}\])])(?P<name>(?:\\d?dot\s*\{{?\s*)?{_LETTER}[̇̈]?\}}?{_INDEX}?"
    r"(?:\[[\d,: ]{1,9}\]|\(\s?\d\s?,\s?\d\s?\))?(?:\^\{?2\}?|²|\*\*2)?)"
    r"(?:\((?:[\s,;]|\\?(?:d?dot|theta|boldsymbol|mathbf)(?![a-z])|[qθ]|[{}_\d]|qd{1,2}|th|[̇̈])+\))?"
    r"\s*:?=(?!=)"
)
_OPERATORS = tuple("*/+-^·×=−(")
_WORD = re.compile(rf"(?<![\\\w])(?P<latin>[{LATIN}]{{2,}})$|[{CHINESE}]$")
_END = re.compile(
    rf"[;；。，、]|#|//|(?<!\\)%|,(?!\d)|\.(?=\s|$)|:(?!=)|[{CHINESE}]|(?<![\\\w])(?P<word>[{LATIN}]{{2,}})(?![\w(])"
    r"|\n(?!\s*(?:[=+*/·]|[-−]\s|\\cdot))"
)
"""What ends a formula, outside of brackets; a word where it is none of a formula."""
_OF_A_LINE = ("\n", "#", "//", "%")
"""What ends a formula whatever is behind it: a line's end, a comment."""
_SQUARE = re.compile(r"(?:\^\{?2\}?|²|\*\*2)$")
_NUMBER = re.compile(r"[\d₀-₉]")
_OF_LETTERS = re.compile(
    r"[^\W\d_]{1,8}_?\{?\d.*[^\W\d_]|[*/^+]|\\frac|sin|cos|^[lmIg]_?c?\d"
    r"|^\[.*[,;]"
)
_STEPS, _LONGEST = 6, 8000
_TWO = 2
_BLANKS = re.compile(r"(?<!\s)\s*\n\s*")


_GOES_ON = re.compile(r"[ \t]*(?:[(\[+*/^=−-]|\\(?!text)|\d)")
"""What a formula goes on with, behind what ends one."""


class _UnsureError(Exception):
    """Where a formula ends is not sure."""


@dataclass(frozen=True)
class _Equation:
    name: str
    right: str

    @property
    def text(self) -> str:
        return f"{self.name} = {self.right}"

    @property
    def is_state(self) -> bool:
        """Whether it says when something holds: ``q2 = 0``."""
        return is_condition(self.text)


def conclusion(text: str, entry: str, last: bool = False) -> str:
    """The equations of the entry in a text of several steps, and what explains them.

    Args:
        text: as typed.
        entry: what it is asked for.
        last: whether the last of them is taken alone.

    Returns:
        Empty where there is no other equation, or none of the entry.
    """
    found = _told(text)
    own = [one for one in found if begins_with(f"{one.name} = 0", entry)]
    own = own or [one for one in found if _may_be(one.name) and is_name_of(one.name, entry)]
    if own and len(own) < _times_given(text, entry):
        return ""  # one of them was not seen
    special = [one for before, one in pairwise(found) if before.is_state]
    own = [one for one in own if one not in special] or own
    own = own[-1:] if last else own
    formulas = [right for one in own[:-1] if (right := _formula(one.right))]
    formulas += [_formula(one.right, True) for one in own[-1:]]
    if not formulas or text.count("=") < 2 + own[-1].right.count("=") or len(formulas) > _STEPS:
        return ""
    name, steps = own[-1].name, [*dict.fromkeys(formulas)]
    others = {_key(one.name): one for one in found if one.name != name and not one.is_state}
    chain = " = ".join([name, *steps])
    kept = [one.text for one in _explaining(chain, others)]
    if any(_SQUARE.search(one.name) and f"{one.name} =" not in "".join(kept) for one in found):
        return ""  # what is explained is a square, and none stands in the formula
    named = begins_with(f"{name} = 0", entry)
    lines = [f"{name} = {one}" for one in steps] if named else [chain]
    told = "; ".join([*kept, *lines])
    told = f"${told}$" if "\\" in told else told
    return "" if _A_GRID in told else told


def _key(name: str) -> str:
    """A name by which it may be used; as typed where no formula can have it: a dot over p."""
    with suppress(ExpressionError):
        return own_name(name)
    return name


def _times_given(text: str, entry: str) -> int:
    """How often the entry's name stands in front of a sign of equality."""
    names = (one["name"] for one in _NAMED.finditer(_in_lines(text)))
    return sum(begins_with(f"{name} = 0", entry) for name in names)


def _may_be(name: str) -> bool:
    """Whether a name may be the entry's: one with a number, or an arm's only torque."""
    return bool(_NUMBER.search(name)) or name.strip("\\ ") in ("tau", "τ")


def steps_beside(text: str, entry: str) -> list[str]:
    """The names, as typed, to which other equations give a name of the arm's, or a formula.

    Args:
        text: as typed.
        entry: what it is asked for.
    """
    return [
        one.name
        for one in _told(text)
        if _OF_LETTERS.search(one.right)
        and not _NAMES_LISTED.fullmatch(one.right)
        and not is_name_of(one.name, entry)
        and not begins_with(f"{one.name} = 0", entry)  # x is an entry of T, and no name of it
        and not is_sister(one.name, entry)
        and not (len(one.name) > 1 and is_linking(one.name))
    ]


def values_beside(text: str) -> list[tuple[str, str]]:
    """The names, as typed, to which equations of a text give a number, or another name; lengths in
    metres, masses in kilograms, or without a unit.

    Args:
        text: as typed.
    """
    told = ((one.name, _A_VALUE.fullmatch(one.right)) for one in _told(text))
    return [(name, found["value"]) for name, found in told if found is not None]


_A_VALUE = re.compile(r"(?P<value>\d+(?:\.\d+)?|[lmIg]_?c?\d)\s?(?:m|kg)?[.)]?")
"""A number, and its unit; or a name of the arm's."""


def _told(text: str) -> list[_Equation]:
    """All equations of a text with several; none where it is a program's, or where one ends is not
    sure.
    """
    if text.count("=") < 2 or len(text) > _LONGEST or _PROGRAM.search(text):
        return []
    with suppress(_UnsureError):
        return _all(text)
    return []


def _all(text: str) -> list[_Equation]:
    return [*_equations(_in_lines(_BLANKS.sub("\n", _GRID.sub(_as_a_grid, text))))]


def _as_a_grid(found: re.Match[str]) -> str:
    """A sign for a matrix, with a product where it is of more than names."""
    return _A_GRID if _NAMES_ALONE.fullmatch(found[0]) else f"{_A_GRID}*"


def _in_lines(text: str) -> str:
    """A text with each of its steps on a line of its own."""
    return _LINES.sub("\n", _GAPS.sub(" ", text))


def _formula(right: str, last: bool = False) -> str:
    """What an equation comes to, without definitions of the entry; mostly all of it.

    Args:
        right: its right side.
        last: whether its end is that of the whole, which stays.
    """
    *sides, end = [side.strip() for side in right.split("=")]
    kept = [one for one in sides if not says_what_it_is(one)]
    return " = ".join([*kept, *([end] if last or not says_what_it_is(end) else [])])


def _equations(text: str) -> Iterator[_Equation]:
    """Each name with what it is said to be, in order."""
    last = 0
    for found in _NAMED.finditer(text):
        front = text[: found.start()].rstrip(" \t")
        if found.start() < last or (front.endswith(_OPERATORS) and not front.endswith("==")):
            continue
        if front[-1:] and front[-1] not in "\n,;:.，；：。、）" and not _ends_in_a_word(front):
            continue
        right, last = _right_side(text, found.end())
        if right:
            yield _Equation(found["name"], right)


def _ends_in_a_word(front: str) -> bool:
    """Whether a word stands at the end: of two letters only one of those that are listed."""
    found = _WORD.search(front)
    latin = found["latin"] if found else None
    return found is not None and (latin is None or len(latin) > _TWO or is_listed(latin))


def _right_side(text: str, begin: int) -> tuple[str, int]:
    """A formula from where it begins, and where it ends."""
    end = len(text)
    for one in _END.finditer(text, begin):
        inside = text[begin : one.start()]
        depth = sum(map(inside.count, "([{")) - sum(map(inside.count, ")]}"))
        word = one["word"]
        if depth > 0 or not inside.strip() or (word and not is_word(word, text, one)):
            continue
        end = one.start()
        if _GOES_ON.match(text, one.end()) and one[0] not in _OF_A_LINE and not word:
            raise _UnsureError
        break
    return " ".join(text[begin:end].split()), end


def _explaining(chain: str, others: dict[str, _Equation]) -> list[_Equation]:
    """The equations of names that stand in a formula, those first that others rest on."""
    kept: dict[str, _Equation] = {}
    waiting = [chain.partition("=")[2]]
    while waiting:
        text = waiting.pop()
        for name, one in others.items():
            if stands_in(one.name, text) and name not in kept:
                kept[name] = one
                waiting.append(one.right)
    return [*reversed(kept.values())]
