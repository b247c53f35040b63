"""Words that say nothing of what a formula claims: ``by the chain rule we find that``.

They stand in ``vocabulary.toml``. A word in no list there may change what is claimed: *upright*,
*massless*, *elbow*.
"""

from __future__ import annotations

import re
import tomllib
from functools import cache
from importlib import resources
from typing import Any

CHINESE = "\u4e00-\u9fff\u3040-\u30fa\u30fc-\u30ff"
CYRILLIC = "\u0400-\u04ff"
LATIN = f"A-Za-zÀ-ÖÙ-öù-ÿąčćďěęłńňřšśťůžźőűİıŞşĞğ{CYRILLIC}"
"""Letters of words, for patterns; without those that are signs of mathematics (ø, ż)."""
ASIDE = (
    rf"(?<=[\w)}}\]])\s{{1,4}}\((?:[{LATIN}]{{2,20}}[ ,]{{1,2}}){{2,8}}(?:[{LATIN}]{{2,20}}|\d)\)"
)
"""Words in parentheses behind a formula, for patterns: ``(reach beyond joint 2)``."""
_A_WORD = re.compile(rf"[{LATIN}]{{2,}}|[{CHINESE}]+")
BEHIND = "behind"
"""In an entry's place: what is said of the names in a formula."""
STEPS = "steps"
"""The same: what is said in other sentences of a derivation than that of the entry."""

_LONGEST = 8
"""Signs of the longest Chinese word."""


def words_of(text: str) -> list[str]:
    """The words of a text, of two letters at least, and its runs of Chinese."""
    return _A_WORD.findall(text)


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
    return _not_made_of(text, _known(entry, "chinese"))


def _not_made_of(text: str, told: frozenset[str]) -> str:
    """What of a run of Chinese no words of a list make up; empty where they do."""
    reach = [True] + [False] * len(text)
    for end in range(1, len(text) + 1):
        begins = range(max(0, end - _LONGEST), end)
        reach[end] = any(reach[start] and text[start:end] in told for start in begins)
    return "" if reach[-1] else text[max(k for k, one in enumerate(reach) if one) :]


def is_linking(word: str) -> bool:
    """Whether a word stands between two sides of one equation: ``a, that is = b``."""
    return _is_one_of(word, _linking())


def _is_one_of(word: str, told: frozenset[str]) -> bool:
    """Whether a word, or a run of Chinese, is made of what a list has."""
    return word.lower().strip(".") in told or not _not_made_of(word, told)


def leads_over(word: str) -> bool:
    """Whether a word leads from one equation to the next, and says nothing of what they are."""
    return is_program(word) or _is_one_of(word, _leading())


def is_of_a_part(word: str) -> bool:
    """Whether a word says, with others such, of which part of the arm an equation is."""
    return _is_one_of(word, _parts().union(_lists()["parts"]["alone"].split()))


def names_a_part(word: str) -> bool:
    """Whether a word names, with others such, a part of the arm: not that it stands alone."""
    return _is_one_of(word, _parts())


def is_listed(word: str) -> bool:
    """Whether a word is in one of the lists, whatever the entry."""
    return word.lower() in _every()


def is_program(word: str) -> bool:
    """Whether a word is none of a sentence but of a formula or a program: sin, theta, np."""
    return word.lower() in _programs()


@cache
def _every() -> frozenset[str]:
    lists = _lists()
    told = [lists["anywhere"][key] for key in ("english", "german", "romance")]
    return frozenset(" ".join([*told, *(one["words"] for one in lists["of"])]).split())


@cache
def _linking() -> frozenset[str]:
    return frozenset(_lists()["anywhere"]["linking"].split())


@cache
def _leading() -> frozenset[str]:
    return _linking().union(_lists()["anywhere"]["leading"].split())


@cache
def _parts() -> frozenset[str]:
    parts = _lists()["parts"]
    return frozenset(f"{parts['words']} {parts['chinese']}".split())


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
    of_entry += [*_lists()["of"], _lists()["steps"]] if entry == STEPS else []
    return frozenset(" ".join([*lists, *(one[script] for one in of_entry)]).split())
