"""Which words beside a formula may change what it claims: ``in the upright pose``, ``elbow``.

Whether such words change anything is not known. A formula beside them that holds at every state
is right all the same; one that does not is not judged.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from kinlab.formulas.handed.vocabulary import BEHIND, chinese_left, says_nothing

_CHINESE = "\u4e00-\u9fff"
_LATIN = r"A-Za-zÄÖÜäöüßéè"
_FONT = re.compile(r"\\(?:text|textrm|textit|textbf|mbox|textnormal|mathrm|rm|hbox)\s*\{([^{}]*)\}")
_BELOW = re.compile(rf"_\s*(?:\{{[^{{}}]*(?:\{{[^{{}}]*\}})?[^{{}}]*\}}|[{_LATIN}]+|\w)")
_AROUND = re.compile(r"\\(?:begin|end|label|tag|ref|color|textcolor|operatorname)\*?\s*\{[^{}]*\}")
_COMMAND = re.compile(r"\\(?:[A-Za-z]+\*?|.)")
_MATHS = re.compile(r"\$\$[^$]*\$\$|\$[^$]*\$|\\\(.*?\\\)|\\\[.*?\\\]", re.DOTALL)
_WHERE = re.compile(
    r"\b(?:where|in which|with|wobei|mit|dabei|hierbei|here)\b|其中|式中|这里", re.IGNORECASE
)


def _words(least: int) -> re.Pattern[str]:
    beside = rf"(?<![\w.{{\[*/^+])(?P<latin>[{_LATIN}]{{{least},}}(?:['’-][{_LATIN}]{{2,}})*)"
    latin = rf"{beside}(?![\w(\[*/^+]|\s*&?\s*:?=)"
    return re.compile(rf"{latin}|(?P<chinese>[{_CHINESE}]+)")


_WORDS = {typeset: _words(least) for typeset, least in ((False, 2), (True, 4))}
"""In LaTeX a few letters side by side are a product."""
_PHRASE = re.compile(rf"[{_LATIN}{_CHINESE}\d'’ ,.;:-]*")
_FRAME = re.compile(
    r"\bpart \(?[a-h1-9]\b|\b(?:base|world|inertial|fixed|reference)[ -](?:frame|system|coordinates?)\b"
    r"|\b(?:basis|welt|inertial)(?:koordinaten)?system\b|基坐标系|世界坐标系|固定坐标系",
    re.IGNORECASE,
)
_ORDER = {"first": 1, "second": 2, "third": 3, "fourth": 4, "ersten": 1, "zweiten": 2, "dritten": 3}
_ORDER |= {"一": 1, "二": 2, "三": 3, "四": 4}
_PART = re.compile(
    r"(?:\b(?P<order>first|second|third|fourth|ersten|zweiten|dritten)\s+)?"
    r"\b(?:joints?|links?|axis|axes|motors?|actuators?|bod(?:y|ies)|gelenks?|glied(?:e?s)?|legs?|arms?|rods?)\b"
    r"(?:\s*(?:no\.?|nr\.?|number|#)?\s*(?P<number>[1-9]))?"
    r"|(?:第(?P<chinese>[一二三四1-9])个?)?(?:关节|连杆|杆|支链|杆件)(?P<behind>[1-9])?",
    re.IGNORECASE,
)
_MOST = 60


def doubtful(text: str, entry: str) -> list[tuple[str, str]]:
    """Words in a text that are in no list of what says nothing, each with the words around it.

    Args:
        text: as typed.
        entry: what the formula is asked for.
    """
    found: list[tuple[str, str]] = []
    for prose, typeset in _proses(text):
        front, behind = _cut(_FRAME.sub(" ", prose))
        found += _of(front, entry, typeset) + _parts(front, entry) + _of(behind, BEHIND, typeset)
    return found


def left_over(found: Iterable[tuple[str, str]], names: Iterable[str]) -> str:
    """The first words that are no names of the formula's; empty where there are none."""
    known = {name.lower() for name in names}
    return next((phrase for word, phrase in found if word.lower() not in known), "")


def _proses(text: str) -> list[tuple[str, bool]]:
    """The pieces of a text in which words may stand, and whether letters may be products there."""
    left = text.partition("=")[0] if "=" in text else ""
    below = " ".join(_FONT.sub(r" \1 ", one[0].lstrip("_")) for one in _BELOW.finditer(left))
    said = [(re.sub(r"[{}\\]", " ", below), False)]
    text = _BELOW.sub("_0", text)
    said += [(one[1], False) for one in _FONT.finditer(text)]
    outside = _FONT.sub(" ; ", _AROUND.sub(" ", text))
    typeset = "\\" in outside
    if _MATHS.search(outside):
        outside, typeset = _MATHS.sub(" ; ", outside), False
    return [*said, (_COMMAND.sub(" ; ", outside), typeset)]


def _cut(prose: str) -> tuple[str, str]:
    """What is said of the formula, and what of the names behind it."""
    found = _WHERE.search(prose)
    if found is None or "=" not in prose[: found.start()]:
        return prose, ""
    return prose[: found.start()], prose[found.end() :]


def _of(prose: str, entry: str, typeset: bool) -> list[tuple[str, str]]:
    found = []
    for one in _WORDS[typeset].finditer(prose):
        word = one["latin"] or chinese_left(one["chinese"], entry)
        if word and not (one["latin"] and says_nothing(word, entry)):
            found.append((word, _around(prose, one.start(), one.end())))
    return found


def _around(prose: str, start: int, end: int) -> str:
    """The words on both sides of one."""
    behind = _PHRASE.match(prose, end)
    front = _PHRASE.match(prose[:start][::-1])
    end += len(behind[0]) if behind else 0
    said = prose[start - len(front[0] if front else "") : end].strip(" ,.;:-")
    if prose[end : end + 1] in ("=", "_") and " " in said:
        said = said.rpartition(" ")[0]  # the name of the formula
    return said.strip(" ,.;:-")[:_MOST]


def _parts(prose: str, entry: str) -> list[tuple[str, str]]:
    """Links and joints by their number that are not the entry's own: joint 2 of x, or of tau1."""
    own = set(re.findall(r"\d", entry))
    found = []
    for one in _PART.finditer(prose):
        told = one["order"] or one["chinese"]
        number = one["number"] or one["behind"] or (told and str(_ORDER.get(told.lower(), told)))
        if number and number not in own:
            found.append((one[0], _around(prose, *one.span())))
    return found
