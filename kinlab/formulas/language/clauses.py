"""Clauses that say of an arm, or of a name, what may be true: ``gravity acts along -y``.

What they claim is read here, with the words of ``clauses.toml``; whether it is so is known to who
knows the arm. A true clause changes nothing of what a formula claims and is taken out; beside one
that is not so nobody can tell what the formula is meant to be.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any

from kinlab.formulas.signs.letters import BELOW
from kinlab.formulas.signs.refusals import refused
from kinlab.host.language import N_

_HAN = "\u4e00-\u9fff"
_UNSEEN = re.compile(
    r"\\(?:text|textrm|textit|textbf|mbox|mathrm|mathit|mathbf|boldsymbol|rm|left|right|var)"
    r"(?![A-Za-z])|\\[,;:! ]|\\q?quad|[_{}$\\]"
)
"""What LaTeX has around names and words."""
_TOKEN = re.compile(
    r"(?P<unit>(?:(?:rad|m|kg)/s(?:\^?2|²)?|kg\s?m(?:\^?2|²)|N\s?m)(?![A-Za-z]))|"
    r"(?P<signed>\b(?:minus|plus|negative|positive)[ ]signs?\b)|"
    rf"(?P<half>[la]\d\s*/\s*2(?![\w*/^]))|(?P<number>\d+(?:\.\d+)?(?![A-Za-df-z]))|(?P<word>[A-Za-zÄÖÜäöüßθϑ\u0307\u0308]+\d*)"
    rf"|(?P<han>[{_HAN}]+)|(?P<mark>[,;:，；：、。()（）#%\n]|\.(?!\d))|(?P<sign>[^\s])"
)
_DOTS = re.compile("[\u0307\u0308]")
_HYPHEN = re.compile(r"(?<=[xyz])-(?=[A-Za-z]{4})|(?<=[A-Za-z]{3})-(?=[a-z]{3})")
_AXIS = re.compile("[xyz]")
_NAMED = {"half": "half-length", "unit": "si-unit", "signed": "signed"}
"""What pieces with signs in them are called among words."""
_COMMAS = (",", "，", "、")
_TURNED = {"negative", "minus", "negativer", "negativen", "负"}
_STRAIGHT = {"positive", "plus", "positiver", "positiven", "正"}
_LONGEST, _LENGTH, _SHORTEST, _MOST = 28, 8, 2, 600
"""Words of a clause at most; signs of a Chinese word; words of a clause at least, and of a text."""


@dataclass(frozen=True)
class Claim:
    """What a clause says.

    Attributes:
        kind: which of the kinds of ``clauses.toml``.
        names: of what, in the order of the text: ``q2``, ``lc1``.
        refs: joints, links and frames by their numbers, in that order; "" where no kind is said.
        axes: axes with their signs: ``-y``.
        words: all words of it.
    """

    kind: str
    names: tuple[str, ...] = ()
    refs: tuple[tuple[str, int], ...] = ()
    axes: tuple[str, ...] = ()
    words: frozenset[str] = field(default=frozenset())


Holds = Callable[[Claim], bool | None]
"""Whether a claim is true; None where that is not known."""


def without_clauses(text: str, place: str, holds: Holds) -> str:
    """The text without clauses that are true.

    Args:
        text: as typed.
        place: what to put in front of a message.
        holds: what is known of the arm.

    Raises:
        ExpressionError: a clause that is not so.
    """
    _refuse_another_arm(text, place, holds)
    text = _without_singular(text, place, holds)
    told = list(_told(text, place, holds))
    if not told:
        return text
    for start, end in reversed(told):
        text = f"{text[:start]}{_GAP}{text[end:]}"
    return _tidied(text)


_ARM = re.compile(r"stanford|puma|scara|panda|ur10|ur5", re.IGNORECASE)


def arms_named(text: str) -> frozenset[str]:
    """The arms of those that have a name that a text names."""
    return frozenset(map(str.lower, _ARM.findall(text)))


def _refuse_another_arm(text: str, place: str, holds: Holds) -> None:
    """Refuses a formula of which it is said that it is another arm's.

    Raises:
        ExpressionError: with the arm's name.
    """
    found = _ARM.search(text)
    if found is not None and holds(Claim("arm", words=arms_named(text))) is False:
        said = N_("{words!r} beside the formula is not what it is asked for; leave it out")
        raise refused(place, said, words=found[0])


_VALUE = (
    r"[-±]?\s?(?:\\pm\s?)?(?:\d+(?:\.\d+)?\s?(?:°|\^\{?\\circ\}?)"
    r"|(?:\d+|[kn])?\s?\*?\s?(?:\\?pi(?![A-Za-z])|π)(?:\s?/\s?\d)?|0)"
)
_ANGLE_IS = rf"\$?\\?(?:theta|θ|ϑ|vartheta|th|q)\s?_?\{{?[\d₀-₉]\}}?\s?=\s?{_VALUE}\$?"
_OR = r"\s?(?:,|、|\b(?:and|or|und|oder|bzw\.)|和|或|与)\s?"
_SINGULAR = re.compile(
    r"(?:[,;.，；。]\s?)(?:(?:so|thus|hence|therefore|and|also|daher|somit|因此|所以|故|从而)[\s,，]{0,2}){0,2}"
    r"(?:(?:that\s)?(?:the\s(?:arm|robot|manipulator|jacobian|matrix)|it|J|which|der\s(?:arm|roboter)|er)\s)?"
    r"(?:(?:is|becomes|ist|wird)\s)?(?:"
    rf"singul(?:ar|är)\s(?:at|for|when|where|if|für|bei|wenn|in)\s(?P<where>(?:{_OR}|{_ANGLE_IS}|\$?{_VALUE}\$?){{1,12}}+)"
    rf"|(?:在|当|机械臂在)?\s?(?P<there>(?:{_OR}|{_ANGLE_IS}|\$?{_VALUE}\$?){{1,12}}+)\s?(?:时|处)?\s?(?:机械臂|机器人)?(?:奇异|为奇异|处于奇异位形))"
    r"\s?[.。]?\s*$",
    re.IGNORECASE,
)
"""What follows from a determinant: ``so the arm is singular at q2 = 0 and q2 = pi``."""


def _without_singular(text: str, place: str, holds: Holds) -> str:
    """The text without where the arm is singular, if it is so.

    Raises:
        ExpressionError: it is not singular there.
    """
    found = _SINGULAR.search(text)
    if found is None:
        return text
    name, known = "", True
    for one in re.finditer(rf"{_ANGLE_IS}|{_VALUE}", (found["where"] or found["there"])):
        left, sign, value = one[0].rpartition("=")
        digit = re.search(r"[\d₀-₉]", left.translate(BELOW)) if sign else None
        name = f"q{digit[0]}" if digit else name
        told = holds(Claim("singular", (name,), words=frozenset({value.strip(" $")})))
        if told is False:
            said = N_("{words!r} beside the formula is not so of this robot; leave it out")
            raise refused(place, said, words=found[0].strip(" ,.;")[:80])
        known = known and bool(told)
    return text[: found.start()] if known else text


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    start: int
    end: int


@dataclass(frozen=True)
class _Concept:
    """A kind of clause, as ``clauses.toml`` has it."""

    kind: str
    names: re.Pattern[str] | None
    needs: tuple[frozenset[str], ...]
    words: frozenset[str]
    axes: bool
    kinds: frozenset[str]
    nameless: bool
    double: bool
    commas: bool


def _told(text: str, place: str, holds: Holds) -> Iterator[tuple[int, int]]:
    """Where true clauses stand."""
    tokens = _tokens(text)
    begin = 0 if len(tokens) <= _MOST else len(tokens)
    while begin < len(tokens):
        subject = _subject(tokens, begin)
        end = begin
        first = tokens[begin]
        words = first.kind in ("word", "han", "number") and not (
            _is_opener(first) or _is_joint(first)
        )
        if words and subject is not None:
            end = _clause_from(tokens, begin, subject, text, place, holds)
        if end > begin:
            yield tokens[begin].start, tokens[end - 1].end
        begin = max(end, begin + 1)


def _clause_from(
    tokens: list[_Token], begin: int, subject: str, text: str, place: str, holds: Holds
) -> int:
    """Where the longest true clause that begins somewhere ends; there again where none does."""
    last = min(len(tokens), begin + _LONGEST)
    for end in range(last, begin + _SHORTEST - 1, -1):
        if not _ends(tokens, end) or any(one.kind == "sign" for one in tokens[begin:end]):
            continue
        for concept in _concepts():
            claim = _claim(concept, tokens[begin:end], subject)
            known = None if claim is None else holds(claim)
            if known:
                return end
            if known is False:
                said = N_("{words!r} beside the formula is not so of this robot; leave it out")
                words = text[tokens[begin].start : tokens[end - 1].end]
                raise refused(place, said, words=f"{subject} {words}".strip()[:80])
    return begin


def _tokens(text: str) -> list[_Token]:
    """The words, names, numbers and signs of a text, with where they stand in it."""
    flat = list(text.translate(BELOW))
    for found in _UNSEEN.finditer(text):
        blank = " " if found[0][0] == "\\" and len(found[0]) > 1 else "\0"
        flat[found.start() : found.end()] = [blank] * len(found[0])
    places = [k for k, sign in enumerate(flat) if sign != "\0"]
    plain = _HYPHEN.sub(" ", "".join(flat[k] for k in places))
    tokens: list[_Token] = []
    for found in _TOKEN.finditer(plain):
        kind = str(found.lastgroup)
        pieces = _segmented(found[0]) if kind == "han" else [found[0]]
        at = found.start()
        if kind in _NAMED:
            where = places[at], places[at + len(found[0]) - 1] + 1
            tokens.append(_Token("word", _NAMED[kind], *where))
            continue
        for piece in pieces:
            start, end = places[at], places[at + len(piece) - 1] + 1
            piece_ = re.sub("[θϑ]|vartheta", "theta", _DOTS.sub("", piece))
            tokens.append(_Token(kind, piece_, start, end))
            at += len(piece)
    return _with_signs(tokens)


def _with_signs(tokens: list[_Token]) -> list[_Token]:
    """The same with ``-y`` as one, where no formula is."""
    found: list[_Token] = []
    for one in tokens:
        last = found[-1] if found else None
        before = found[-2] if len(found) > 1 else None
        axis = one.kind == "word" and _AXIS.fullmatch(one.text)
        if axis and last is not None and last.kind == "sign" and last.text in "-−+":
            words = before is not None and before.kind in ("word", "han")
            free = before is None or (words and (before.kind == "han" or len(before.text) > 1))
            if (free or (before and before.kind == "mark")) and last.end == one.start:
                sign = "" if last.text == "+" else "-"
                found[-1] = _Token("word", f"{sign}{one.text}", last.start, one.end)
                continue
        found.append(one)
    return found


def _segmented(run: str) -> list[str]:
    """Chinese words; what is in no list stays a piece."""
    known = _chinese()
    pieces: list[str] = []
    while run:
        sizes = range(min(_LENGTH, len(run)), 0, -1)
        size = next((n for n in sizes if run[:n] in known), 1)
        pieces.append(run[:size])
        run = run[size:]
    return pieces


_FACTOR = re.compile(r"[^\W\d_]|[^\W\d_]+\d+")
"""What stands behind a bracket as a factor: g, qd2, l1."""


def _subject(tokens: list[_Token], begin: int) -> str | None:
    """The name of a definition behind which a clause begins; "" of no such; None where none may."""
    if begin == 0:
        return ""
    before = tokens[begin - 1]
    if before.text in (")", "）") and _FACTOR.fullmatch(tokens[begin].text):
        return None  # sin(q2) qd2 in SI units
    if before.kind == "mark" or _is_opener(before) or _is_joint(before):
        return ""
    start = begin
    while start and tokens[start - 1].kind not in ("mark",) and not _is_opener(tokens[start - 1]):
        start -= 1
    piece = tokens[start:begin]
    signs = [one.text for one in piece]
    if signs.count("=") == 1 and signs.index("=") == 1 and piece[0].kind == "word":
        return piece[0].text
    return None


def _ends(tokens: list[_Token], end: int) -> bool:
    """Whether a clause may end there."""
    if _is_joint(tokens[end - 1]) or _is_opener(tokens[end - 1]):
        return False
    if end == len(tokens):
        return True
    behind, *more = tokens[end : end + 2]
    if more and more[0].text == "=" and behind.kind == "word":
        return True  # the formula itself
    return behind.kind == "mark" or _is_joint(behind) or _is_opener(behind)


def _is_opener(token: _Token) -> bool:
    return token.text.lower() in _lists()["openers"]


def _is_joint(token: _Token) -> bool:
    return token.text.lower() in _lists()["joints"]


def _claim(concept: _Concept, tokens: list[_Token], subject: str) -> Claim | None:
    """What some words say, if all of them are of one kind of clause."""
    lists = _lists()
    names = [subject] if subject else []
    refs: list[tuple[str, int]] = []
    axes: list[str] = []
    words: set[str] = set()
    if subject and (concept.names is None or not concept.names.fullmatch(subject)):
        return None
    k = 0
    while k < len(tokens):
        one, word = tokens[k], tokens[k].text.lower()
        behind = tokens[k + 1] if k + 1 < len(tokens) else None
        if one.kind == "mark" and one.text == ":" and k == 1 and names:
            pass  # a legend: l1: length of link 1
        elif one.kind == "mark":
            if one.text not in _COMMAS or not (0 < k < len(tokens) - 1):
                return None
            goes_on = concept.commas and tokens[k + 1].text.lower() in concept.words
            if not (goes_on or _both_names(concept, tokens[k - 1], tokens[k + 1])):
                return None
        elif one.kind == "number":
            if not (concept.double and one.text == "2" and behind and behind.text == "e"):
                return None
            words.add("2")
        elif concept.names is not None and concept.names.fullmatch(one.text):
            names.append(one.text)
        elif concept.axes and _AXIS.fullmatch(word.lstrip("-")):
            axes.append(word)
            words.add(word.lstrip("-"))
        elif word in lists["ordinals"]:
            number = lists["ordinals"][word]
            kind = lists["kinds"].get(behind.text.lower(), "") if behind else ""
            refs.append((kind, number))
            k += bool(kind)
        elif word in lists["kinds"] and behind is not None and behind.kind == "number":
            refs.append((lists["kinds"][word], int(float(behind.text))))
            k += 1
        elif (
            word in concept.words
            or lists["kinds"].get(word) in concept.kinds
            or word in lists["fillers"]
            or word in lists["joints"]
            or (concept.axes and word in _TURNED | _STRAIGHT)
        ):
            words.add(word)
        else:
            return None
        k += 1
    if not all(words & need or need.intersection(names) for need in concept.needs):
        return None
    if concept.names is not None and not names and not concept.nameless:
        return None
    if any(not concept.kinds or (kind and kind not in concept.kinds) for kind, _n in refs):
        return None
    if words & _TURNED:
        axes = [one[1:] if one[0] == "-" else f"-{one}" for one in axes]
    return Claim(concept.kind, tuple(names), tuple(refs), tuple(axes), frozenset(words))


def _both_names(concept: _Concept, one: _Token, other: _Token) -> bool:
    return concept.names is not None and all(
        concept.names.fullmatch(token.text) for token in (one, other)
    )


@cache
def _concepts() -> tuple[_Concept, ...]:
    found = []
    for one in _lists()["clauses"]:
        needs = tuple(frozenset(need.split()) for need in one.get("needs", ()))
        words = frozenset(one.get("words", "").split()).union(*needs)
        pattern = re.compile(one["names"]) if "names" in one else None
        found.append(
            _Concept(
                one["kind"],
                pattern,
                needs,
                words,
                bool(one.get("axes")),
                frozenset(one.get("kinds", "").split()),
                bool(one.get("nameless")),
                bool(one.get("double")),
                bool(one.get("commas")),
            )
        )
    return tuple(found)


@cache
def _lists() -> dict[str, Any]:
    text = (resources.files(__package__) / "clauses.toml").read_text(encoding="utf-8")
    given = tomllib.loads(text)
    kinds = {word: kind for kind, words in given["kinds"].items() for word in words.split()}
    ordinals = {word: int(k) for k, words in given["ordinals"].items() for word in words.split()}
    return {
        "fillers": frozenset(given["fillers"].split()),
        "openers": frozenset(given["openers"].split()),
        "joints": frozenset(given["joints"].split()),
        "kinds": kinds,
        "ordinals": ordinals,
        "clauses": given["clause"],
    }


@cache
def _chinese() -> frozenset[str]:
    lists = _lists()
    every = {*lists["fillers"], *lists["openers"], *lists["joints"], *lists["kinds"]}
    every |= {*lists["ordinals"], *_TURNED, *_STRAIGHT}
    every = every.union(*(one.words for one in _concepts()))
    return frozenset(word for word in every if re.match(f"[{_HAN}]", word))


# -------- What is left without them

_GAP = "\0"


def _tidied(text: str) -> str:
    """A text without what opened or joined clauses that are gone: ``where  and``, ``( )``."""
    opens, joins = (_any_of(_lists()[key]) for key in ("openers", "joints"))
    text = re.sub(rf"\$?{_GAP}\$?", _GAP, text)
    then = rf"(?:\s*[,;，；、]\s*(?:{joins}\s*)?|\s*{joins}\s*)"
    before = None
    while before != text:
        before = text
        text = re.sub(rf"{_GAP}{then}{_GAP}", _GAP, text)
        text = re.sub(rf"({opens})\s*{_GAP}{then}(?=[^\s{_GAP}])", r"\1 ", text)
    text = re.sub(rf"(?:{opens}|{joins})\s*{_GAP}", _GAP, text)
    text = re.sub(rf"(?:[(（#]|//|(?<!\\)%)\s*{_GAP}(?:\s*[)）])?", _GAP, text)
    text = re.sub(rf"^\s*{_GAP}\s*[,;:.，；：。]?", "", text)
    text = re.sub(rf"([.。])\s*{_GAP}\s*[.。]", r"\1", text)  # of a sentence nothing is left
    # of signs on both sides the one behind stays: it cuts what comes from what was before
    text = re.sub(rf"[,;，；、]?\s*{_GAP}(?=\s*[,;，；.。)）\n]|\s*$)", "", text)
    text = re.sub(rf"{_GAP}\s*[:：]", "", text)
    text = re.sub(r"(?<=\$)\s*[.。]\s*$", "", text)
    return text.replace(_GAP, " ")


def _any_of(words: frozenset[str]) -> str:
    listed = "|".join(sorted(words, key=len, reverse=True))
    return rf"(?:(?<![A-Za-z])(?:{listed})(?![A-Za-z]))"
