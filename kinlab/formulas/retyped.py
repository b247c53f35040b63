r"""A corrected formula in its writer's own typing: LaTeX stays LaTeX, ``q(2)`` stays ``q(2)``.

The doctor corrects the plain text of a formula. Here the same change is made in what was typed:
its leaves (names, numbers, functions, signs) are laid beside those of the plain text, and what
the two plain texts differ in is put where it belongs. A line is taken only if, read again, it has
the values of the corrected formula; otherwise the whole is typeset anew, in the writer's names.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from difflib import SequenceMatcher
from functools import cached_property

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import KinlabError
from kinlab.formulas import typeset
from kinlab.formulas.evaluate import plain_values
from kinlab.formulas.signs.latex import Leaf
from kinlab.formulas.text import parse, tidied
from kinlab.formulas.typed import is_latex
from kinlab.tolerances import TOLERANCES

_TOKEN = re.compile(r"[A-Za-z_]\w*|\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+|\*\*|[-+*/(),]")
_LEAF = re.compile(r"[\w.]+|[-+]")
_OPENING = re.compile(r"(?:\\left|\\[bB]igg?l?)?\s*[(\[{]\s*$")
_CLOSING = re.compile(r"\s*(?:(?:\\right|\\[bB]igg?r?)?\s*[)\]]|\})")
_BETWEEN = re.compile(r"\s*(?:\\cdot(?![A-Za-z])|\\times(?![A-Za-z])|\\,|\.?\*|·|×|⋅)\s*|\s+")
_FRACTION = re.compile(r"\\[dt]?frac\s*$")
_BRACED = re.compile(r"_\{(\w)\}")
_BARE = re.compile(r"\\(?:sin|cos|tan)(\s*)(?:\\[a-z]+|[A-Za-z])")
_SINGLE = re.compile(r"(\\(?:sin|cos|tan))\(((?:\\[a-z]+|[A-Za-z])(?:_\w|_\{\w+\})?)\)")
_PLAIN_WAVE = re.compile(r"(?<![\\A-Za-z])(?:sin|cos|tan|sqrt)(?![A-Za-z])")
"""A function without a backslash."""
_MACRO = "\\"
_HALF = re.compile(r"\(\((\w+)\)/\((\w+)\)\)")
_BELOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_ABOVE = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
_RAISED = re.compile(r"(?:\^|\*\*)(\d)")
_SAMPLES = 4
_DEEP = 4
"""Brackets around a place, so many or fewer, that something may be put outside of."""


@dataclass(frozen=True, eq=False)
class Typing:
    """One formula as it was typed.

    Attributes:
        typed: what the writer typed, without dollars and without a left side.
        plain: what that was read as.
        leaves: the leaves of ``typed``.
        reads: the reader, for what is typed anew.
    """

    typed: str
    plain: str
    leaves: tuple[Leaf, ...]
    reads: Callable[[str], str]

    # -------- The whole line

    def corrected(self, text: str) -> str:
        """The line with what was corrected in its plain text.

        Args:
            text: the plain text, corrected.
        """
        if self._same_text:
            return text
        goal = _values(text)
        whole = [self._retold(text), self._anew(text)]
        if r"\frac" in self.typed and ")/(" in whole[0]:  # in his fractions
            whole.reverse()
        lines = (*map(_rooted, self._lines(text)), *whole)
        return next((line for line in lines if self._reads_as(line, goal)), text)

    def piece(self, text: str) -> str:
        """A piece of the plain text, or of what comes instead, as the writer types it."""
        if self._same_text or not text:
            return text
        sign = re.match(r"[-+]?\s*", text)
        head, body = (sign.group(), text[sign.end() :]) if sign else ("", text)
        bare = [t for t, _, _ in _tokens(body)]
        whole = [t for t, _, _ in self._plain]
        goal = _values(body)
        for tokens in (bare, ["(", *bare, ")"]):  # a fraction is read with parentheses around it
            for k in range(len(whole) - len(tokens) + 1):
                met = whole[k : k + len(tokens)] == tokens
                span = self._span(k, k + len(tokens)) if met else None
                shown = self.typed[slice(*span)].strip() if span else ""
                if shown and self._reads_as(shown, goal):
                    return head + shown
        ways = [self._retold(body), self._anew(body)]
        share = re.fullmatch(r"(.*)/(\d+)", body)
        if share and r"\frac" in self.typed:
            ways.insert(0, rf"\frac{{1}}{{{share[2]}}} {self.piece(share[1])}")
        return head + next((one for one in ways if self._reads_as(one, goal)), body)

    @cached_property
    def _same_text(self) -> bool:
        return re.sub(r"\s", "", self.typed) == re.sub(r"\s", "", self.plain)

    def _reads_as(self, line: str, goal: Array | None) -> bool:
        try:
            found = _values(self.reads(line))
        except KinlabError:
            return False
        if goal is None or found is None:
            return False
        size = np.max(np.abs(goal)) or 1.0
        return bool(np.max(np.abs(found - goal)) <= TOLERANCES.effect_matches * size)

    # -------- Where the plain text's tokens were typed

    @cached_property
    def _plain(self) -> list[tuple[str, int, int]]:
        return _tokens(self.plain)

    @cached_property
    def _typed_at(self) -> dict[int, Leaf]:
        """The leaf that each token of the plain text was, where one was."""
        places = [k for k, (token, _, _) in enumerate(self._plain) if _LEAF.fullmatch(token)]
        ours, theirs = [self._plain[k][0] for k in places], [leaf.plain for leaf in self.leaves]
        found = {}
        for a, b, size in SequenceMatcher(None, ours, theirs, False).get_matching_blocks():
            found.update({places[a + k]: self.leaves[b + k] for k in range(size)})
        return found

    def _span(self, first: int, behind: int) -> tuple[int, int] | None:
        """Where the tokens from ``first`` to before ``behind`` were typed, in whole brackets."""
        leaves = [self._typed_at.get(k) for k in range(first, behind)]
        met = [leaf for leaf in leaves if leaf is not None]
        if not met or any(
            leaf is None and _LEAF.fullmatch(self._plain[first + k][0])
            for k, leaf in enumerate(leaves)
        ):
            return None
        start, end = met[0].start, met[-1].end
        if self._plain[first][0] == "(" and (opening := _OPENING.search(self.typed[:start])):
            start = opening.start()
        start, end = _balanced(self.typed, start, end)
        if [token for token, _, _ in self._plain[first : first + 2]] == ["(", "("]:
            fraction = _FRACTION.search(self.typed[:start])
            start = fraction.start() if fraction else start
        return start, end

    # -------- The line with a change

    def _lines(self, text: str) -> Iterator[str]:
        """Ways of typing the corrected formula, the nearest to what was typed first."""
        new = [token for token, _, _ in _tokens(text)]
        old = [token for token, _, _ in self._plain]
        steps = SequenceMatcher(None, old, new, False).get_opcodes()
        plain = [step[1:] for step in steps if step[0] != "equal"]
        told = [one for i, j, k, m in plain for one in _shares_apart(i, j, new[k:m])]
        whole = [(i, j, new[k:m]) for i, j, k, m in _whole(plain, old, new)]
        ways = [*((told, deep) for deep in range(_DEEP)), (whole, 0)]
        if self._latex:
            shares = sorted((_in_front(old, change) for change in told), key=lambda c: c[:2])
            ways = [*((shares, k) for k in range(_DEEP)), *ways] if shares != told else ways
        for changes, deep in ways:
            line = self.typed
            for i, j, tokens in reversed(changes):
                span = self._place(i, j, tokens, deep)
                if span is None:
                    break
                start, end = span
                shown = self._written(tokens, i == 0 or old[i - 1] == "(")
                if {*old[i:j], *tokens} == {"+", "-"} and i < j and tokens:
                    shown = shown.strip()  # a sign for a sign, in the same place
                line = _joined(line[:start], shown, line[end:])
            else:
                yield line

    def _place(self, i: int, j: int, new: list[str], deep: int) -> tuple[int, int] | None:
        """Where tokens i to before j are typed, or where between two others new ones belong."""
        before, after = self._nearest(i - 1, -1), self._nearest(j, 1)
        if i == j:
            leads = new == ["-"] and (i == 0 or self._plain[i - 1][0] == "(")
            binds = new[0] in ("*", "**", "/", "+", "-", ")") and not leads
            if binds:
                at = before.end if before else 0
                for _ in range(deep):
                    closing = _CLOSING.match(self.typed, at)
                    at = closing.end() if closing else at
            else:
                at = after.start if after else len(self.typed)
                for _ in range(deep):
                    opening = _OPENING.search(self.typed[:at])
                    at = opening.start() if opening else at
                    fraction = _FRACTION.search(self.typed[:at])
                    at = fraction.start() if fraction else at
            return at, at
        gone = [token for token, _, _ in self._plain[i:j]]
        span = self._span(i, j)
        if span is None:
            return None
        start, end = span
        if not new and gone[0] in ("*", "**", "/") and before:
            start = before.end
            for _ in range(deep):
                closing = _CLOSING.match(self.typed, start)
                start = closing.end() if closing else start
        elif not new and gone[-1] == "*" and after:
            end = after.start
        return _balanced(self.typed, start, end)

    def _nearest(self, k: int, step: int) -> Leaf | None:
        while 0 <= k < len(self._plain):
            if k in self._typed_at:
                return self._typed_at[k]
            k += step
        return None

    # -------- Tokens as the writer types them

    @cached_property
    def _latex(self) -> bool:
        plain = re.search(r"[A-Za-z]{3,}_?\d|cos\(|sin\(", self.typed)  # theta_1, sin(q1)
        beside = re.search(r"_\w|[A-Za-z]\s+[A-Za-z]", self.typed)
        return is_latex(self.typed) or bool(beside and not plain and "*" not in self.typed)

    @cached_property
    def _times(self) -> str:
        """What the writer puts between factors."""
        met = []
        for one, two in zip(self.leaves, self.leaves[1:], strict=False):
            between = self.typed[one.end : two.start]
            signs = {one.plain, two.plain} & {"+", "-"}
            if not signs and (not between or _BETWEEN.fullmatch(between)):
                met.append(between)
        usual = max(met, key=met.count) if met else " " if self._latex else "*"
        return usual or " "

    def _shown(self, tokens: list[str], first: bool = True) -> Iterator[str]:
        """Tokens as the writer types them; ``first`` where a sign is none between two terms."""
        wide = " " if self._latex or re.search(r"\s[-+]\s", self.typed) else ""
        tight = re.search(r"[({][^()\s]*\S[-+]\S", self.typed)  # in a sine's argument
        depth = 0
        for k, token in enumerate(tokens):
            before = tokens[k - 1] if k else "(" if first else ""
            depth += (token == "(") - (token == ")")
            apart = "" if tight and depth > 0 else wide
            if token == "*":
                yield self._times
            elif token == "**":
                yield "^" if self._latex or "^" in self.typed else "**"
            elif token in ("+", "-"):
                yield token if before in ("(", "*", "/", ",") else f"{apart}{token}{apart}"
            else:
                yield self._name(token) if token[0].isalpha() else token

    def _raised(self, text: str) -> str:
        """Powers as raised digits where the writer has them."""
        raised = re.search("[⁰¹²³⁴-⁹₀-₉]", self.typed)
        return _RAISED.sub(lambda m: m[1].translate(_ABOVE), text) if raised else text

    def _written(self, tokens: list[str], first: bool = True) -> str:
        """Tokens as one piece, sines with parentheses only where the writer has them."""
        shown = self._raised("".join(self._shown(tokens, first)))
        if self._latex and (bare := _BARE.search(self.typed)):
            apart = " " if bare[1] else ""
            shown = _SINGLE.sub(
                lambda m: f"{m[1]}{apart if m[2][0] == _MACRO else ' '}{m[2]}", shown
            )
        return shown

    def _retold(self, text: str) -> str:
        """A formula that the writer has not, as he would type it."""
        shown = _rooted(self._written([token for token, _, _ in _tokens(text)]))
        return _HALF.sub(r"\\frac{\1}{\2}", shown).strip() if self._latex else shown

    @cached_property
    def _names(self) -> dict[str, str]:
        shown = ((leaf.plain, self.typed[leaf.start : leaf.end]) for leaf in self.leaves)
        return {plain: text for plain, text in shown if "^" not in text}

    @cached_property
    def _prefix(self) -> str:
        """What the writer has in front of functions: np. in np.sin."""
        found = re.search(r"\b(\w+\.)(?:sin|cos|tan|sqrt)\b", self.typed)
        return found[1] if found else ""

    def _name(self, name: str) -> str:
        """A name in the writer's typing: his own, one like his, or the usual one."""
        known = self._names
        if name in known:
            return known[name]
        if name in ("sin", "cos", "tan", "sqrt"):
            macro = self._latex and not _PLAIN_WAVE.search(self.typed)
            return rf"\{name}" if macro else f"{self._prefix}{name}"
        head, digits = re.fullmatch(r"(.*?)(\d*)", name).groups()  # type: ignore[union-attr]
        numbered = [(re.fullmatch(r"(.*?)_?(\d+)", like), x) for like, x in known.items()]
        for found, shown in numbered:
            wave = found and {found[1], head} == {"s", "c"} and found[2] == digits
            if found and wave and shown.count(found[1]) == 1:  # c_12 where he has s_12
                return shown.replace(found[1], head)
        for found, shown in numbered:
            if not found or not digits or found[1] != head:
                continue
            if (zero := f"[{int(found[2]) - 1}]") in shown:
                return shown.replace(zero, f"[{int(digits) - 1}]")
            below = found[2].translate(_BELOW)
            if below in shown:
                return shown.replace(below, digits.translate(_BELOW))
            if shown.count(found[2]) == 1:
                if self._latex and len(digits) > 1 and f"{{{found[2]}}}" not in shown:
                    digits = f"{{{digits}}}"
                return shown.replace(found[2], digits)
        if not self._latex:
            below = any(sign in self.typed for sign in "₀₁₂₃₄₅₆₇₈₉")
            return head + digits.translate(_BELOW) if below else name
        braced = re.search(r"_\{\w\}", self.typed)
        return typeset.symbol(name) if braced else _BRACED.sub(r"_\1", typeset.symbol(name))

    def _anew(self, text: str) -> str:
        """A formula typeset from its tree."""
        if not self._latex:
            return text
        try:
            return typeset.latex(parse(text))
        except KinlabError:
            return text


def _rooted(text: str) -> str:
    r"""Roots with braces, as LaTeX has them: ``\sqrt{x}`` for ``\sqrt(x)``."""
    while (found := text.find(r"\sqrt(")) >= 0:
        opened = found + len(r"\sqrt")
        depth, closed = 0, len(text)
        for k in range(opened, len(text)):
            depth += (text[k] == "(") - (text[k] == ")")
            if not depth:
                closed = k
                break
        text = f"{text[:opened]}{{{text[opened + 1 : closed]}}}{text[closed + 1 :]}"
    return text


def _tokens(text: str) -> list[tuple[str, int, int]]:
    return [(found.group(), *found.span()) for found in _TOKEN.finditer(text)]


_Edit = tuple[int, int, list[str]]
"""The tokens that go, from the first to behind the last, and those that come."""


def _shares_apart(i: int, j: int, new: list[str]) -> list[_Edit]:
    """A division by a number, and what comes behind it, as two changes."""
    if len(new) > 2 and new[0] == "/" and new[1].isdigit():
        return [(i, i, new[:2]), (i, j, new[2:])]
    return [(i, j, new)]


def _in_front(tokens: list[str], change: _Edit) -> _Edit:
    """A fraction in front of a term for a division behind it: half of it, a third."""
    i, j, new = change
    if i != j or len(new) != 2 or new[0] != "/" or not new[1].isdigit():
        return change
    depth = 0
    for start in range(i, 0, -1):
        before = tokens[start - 1]
        depth += (before == ")") - (before == "(")
        if depth < 0 or (not depth and before in ("+", "-", ",")):
            return start, start, [rf"\frac{{1}}{{{new[1]}}} "]
    return 0, 0, [rf"\frac{{1}}{{{new[1]}}} "]


def _whole(
    steps: list[tuple[int, int, int, int]], old: list[str], new: list[str]
) -> list[tuple[int, int, int, int]]:
    """Changes within a call as changes of the call: its brackets may not have been typed."""
    found: list[tuple[int, int, int, int]] = []
    for i, j, k, m in steps:
        one, two = _call(old, i), _call(new, k)
        if one is not None and two is not None and j <= one[1] and m <= two[1]:
            i, j, k, m = *one, *two
        if not found or (i, j, k, m) != found[-1]:
            found.append((i, j, k, m))
    return found


def _call(tokens: list[str], k: int) -> tuple[int, int] | None:
    """The call that a place is in: from its name to behind its bracket."""
    depth = 0
    for start in range(k - 1, 0, -1):
        depth += (tokens[start] == ")") - (tokens[start] == "(")
        if depth < 0:
            if not tokens[start - 1][0].isalpha():
                return None
            for end in range(start, len(tokens)):
                depth += (tokens[end] == "(") - (tokens[end] == ")")
                if depth < 0:
                    return start - 1, end + 1
    return None


def _values(text: str) -> Array | None:
    """Values of a plain text where every name is any number, the same wherever it stands."""

    def anything(name: str) -> Array:
        seed = [ord(letter) for letter in name.replace("_", "")]
        return np.random.default_rng(seed).uniform(0.5, 1.5, _SAMPLES)

    try:
        parse(text)
    except KinlabError:
        return None
    values = plain_values(tidied(text), anything, _SAMPLES)
    return values if np.isfinite(values).all() else None


def _balanced(text: str, start: int, end: int) -> tuple[int, int]:
    """A piece with the brackets closed that are opened in it, and the other way round."""
    for _ in range(len(text)):
        depth, lowest = 0, 0
        for character in text[start:end]:
            depth += (character in "([{") - (character in ")]}")
            lowest = min(lowest, depth)
        if lowest < 0 and start > 0:
            start -= 1
        elif depth > 0 and end < len(text):
            end += 1
        else:
            break
    left = re.search(r"\\left\s*$", text[:start])
    return (left.start() if left else start), end


def _joined(left: str, middle: str, right: str) -> str:
    """Three pieces with the blanks that keep commands and names apart."""
    out = left
    for piece in (middle, right):
        apart = re.search(r"(?:\\[A-Za-z]+|[}\d])$", out) and re.match(r"[A-Za-z]", piece)
        out += (" " if apart else "") + piece
    return re.sub(r"  +", " ", out).strip()
