"""Words that say nothing of what a formula claims: ``by the chain rule we find that``.

They stand in ``vocabulary.toml``. A word in no list there may change what is claimed: *upright*,
*massless*, *elbow*. Nor does a clause that says of a name what it means on every arm (``q2 is the
angle of link 2 relative to link 1``), and that does not go on: ``in degrees``.
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib import resources
from typing import Any

CHINESE = "\u4e00-\u9fff"
LATIN = "A-Za-zÄÖÜäöüßéèš"
"""Letters of words, for patterns."""
BEHIND = "behind"
"""In an entry's place: what is said of the names in a formula."""

_LONGEST = 8
"""Signs of the longest Chinese word."""


def says_nothing(word: str, entry: str) -> bool:
    """Whether a word of a Latin script is only how people introduce a formula of this entry.

    Args:
        word: as typed.
        entry: what the formula is asked for.
    """
    plain = word.lower().replace("’", "'").strip(".'-")
    told = _known(entry, "words")
    return all(one in told for one in (*plain.split("-"),)) or plain in told


def chinese_left(text: str, entry: str) -> str:
    """What of a run of Chinese is in no list; empty where all is."""
    told = _known(entry, "chinese")
    reach = [True] + [False] * len(text)
    for end in range(1, len(text) + 1):
        begins = range(max(0, end - _LONGEST), end)
        reach[end] = any(reach[start] and text[start:end] in told for start in begins)
    return "" if reach[-1] else text[max(k for k, one in enumerate(reach) if one) :]


def is_listed(word: str) -> bool:
    """Whether a word is in one of the lists, whatever the entry."""
    return word.lower() in _every()


def is_program(word: str) -> bool:
    """Whether a word is none of a sentence but of a formula or a program: sin, theta, np."""
    return word.lower() in _programs()


@cache
def _every() -> frozenset[str]:
    lists = _lists()
    told = [lists["anywhere"][key] for key in ("english", "german")]
    return frozenset(" ".join([*told, *(one["words"] for one in lists["of"])]).split())


@cache
def _programs() -> frozenset[str]:
    return frozenset(_lists()["anywhere"]["programs"].split())


@cache
def _lists() -> dict[str, Any]:
    text = (resources.files(__package__) / "vocabulary.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


@cache
def _known(entry: str, script: str) -> frozenset[str]:
    """The words that say nothing beside an entry, of one script."""
    anywhere = _lists()["anywhere"]
    lists = [anywhere[key] for key in anywhere if (key == "chinese") == (script == "chinese")]
    of_entry = [one for one in _lists()["of"] if re.match(rf"(?:{one['entries']})(?![a-z])", entry)]
    of_entry += [_lists()["behind"]] if entry == BEHIND else []
    return frozenset(" ".join([*lists, *(one[script] for one in of_entry)]).split())


# -------- Clauses that say of a name what it means anyway

_INDEX = r"_?\{?(?P<i>[1-9i])\}?\$?"
_ANGLE = rf"\$?\\?(?:var)?(?:theta|θ|ϑ|q|th){_INDEX}"
_CENTRE = r"\$?[lard]_?\{?[cCgG]_?\{?(?P<i>[1-9i])\}?\}?\$?"
_INERTIA = rf"\$?I{_INDEX}"
_IS = r"\s*(?:is|are|denotes?|being|represents?|ist|sei|bezeichnet|是|为|表示|:)?\s*"
_THE = r"(?:(?:the|its|der|die|das|den|dem|des|vom|zum)\s+)?"
_LINK = r"(?:link|body|rod|glied(?:es|s)?|stab(?:es|s)?)\s*"
_MASS = r"(?:cent(?:re|er) of (?:mass|gravity)|mass cent(?:re|er)|com)(?: of (?:the )?link (?P=i))?"
_SCHWERPUNKT = (
    rf"(?:schwerpunkt(?:es|s)?|massenmittelpunkt(?:es|s)?)(?: (?:von )?{_THE}{_LINK}(?P=i))?"
)
_BEFORE = rf"{_THE}{_LINK}(?P<j>[1-9])"
_TURNS = r"(?:relative |joint )?(?:angle|rotation)"
_GELENK, _STANGE = r"(?:relative )?(?:dreh|gelenk)?winkel", r"(?:连杆|杆)\s*"
_CLAUSES = (
    rf"{_ANGLE}{_IS}{_THE}{_TURNS} of {_LINK}(?P=i)\s*"
    rf"(?:relative to|with respect to|measured (?:from|relative to)|from|against) {_BEFORE}",
    rf"{_ANGLE}{_IS}{_THE}{_TURNS} between {_BEFORE} and {_LINK}(?P=i)",
    rf"{_ANGLE}{_IS}{_THE}{_GELENK} (?:von )?{_THE}{_LINK}(?P=i)\s*"
    rf"(?:relativ zu[mr]?|gegenüber|gegen|zu) {_BEFORE}",
    rf"{_ANGLE}{_IS}{_STANGE}(?P=i)\s*相对于?{_STANGE}(?P<j>[1-9])\s*的(?:关节)?(?:转角|夹角|角度|角)",
    rf"{_CENTRE}{_IS}{_THE}distance (?:from|between) {_THE}joint (?P=i) (?:to|and) {_THE}{_MASS}",
    rf"{_CENTRE}{_IS}{_THE}distance (?:from|of|between) {_THE}{_MASS} (?:from|to|and) "
    rf"{_THE}joint (?P=i)",
    rf"{_CENTRE}{_IS}{_THE}abstand {_THE}{_SCHWERPUNKT} (?:von )?{_THE}gelenk (?P=i)",
    rf"{_CENTRE}{_IS}从?关节\s*(?P=i)\s*[到至与](?:{_STANGE}(?P=i)\s*)?的?质心的?距离",
    rf"{_INERTIA}{_IS}(?:taken )?(?:about|around) {_THE}{_MASS}",
    rf"{_INERTIA}{_IS}(?:um den|bezüglich des|bezogen auf den) {_SCHWERPUNKT}",
)
"""Each with the number of what the name is of, and where there is one that of the link before."""
_OPENING = r"where|with|wobei|mit|其中|式中|这里"
_NEXT = r"(?=\s*(?:[,;，；、]|[.。](?!\d)|$|\band\b|\bund\b|和|且))"
_EVERY = [
    re.compile(
        rf"(?P<before>\b(?:{_OPENING})\b\s*|(?:{_OPENING})\s*|[,;，；、]\s*(?:and|und)?\s+|\b(?:and|und)\s+)"
        rf"{clause}{_NEXT}",
        re.IGNORECASE,
    )
    for clause in _CLAUSES
]
_WORD = re.compile(rf"(?:{_OPENING})", re.IGNORECASE)
_EMPTY = re.compile(
    rf"[,;，；]?\s*(?:\b(?:{_OPENING})\b|其中|式中|这里)\s*(?=[.。]?\s*$)", re.IGNORECASE
)
_RESTED = re.compile(
    rf"((?:\b(?:{_OPENING})\b|其中|式中|这里))\s*(?:[,;，；、]|\band\b|\bund\b|和|且)\s*",
    re.IGNORECASE,
)


def without_glosses(text: str) -> str:
    """The text without clauses behind a formula that say what its names mean anyway.

    Args:
        text: as typed.
    """
    told = text
    for clause in _EVERY:
        told = clause.sub(_left, told)
    if told == text:
        return text
    told = _RESTED.sub(r"\1 ", told)
    return _EMPTY.sub("", told)


def _left(found: re.Match[str]) -> str:
    """What stays of a clause: the word that opens it; all of one with another number in it."""
    groups = found.groupdict()
    last = groups.get("j")
    if last and (groups["i"] == "i" or int(last) != int(groups["i"]) - 1):
        return found[0]
    if "=" not in found.string[: found.start()]:
        return found[0]
    return found["before"] if _WORD.match(found["before"]) else ""
