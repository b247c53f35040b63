"""Clauses that say of a name what it means on every arm: ``q2 is the angle of link 2 relative to
link 1``.

Such a clause changes nothing and is left out. One that goes on, as ``in degrees`` does, or that has
another number in it, is none of these and stays where it is.
"""

from __future__ import annotations

import re

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
