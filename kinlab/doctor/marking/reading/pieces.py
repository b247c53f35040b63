"""Pieces of a submission: formulas, each with what names it, before they go to their questions."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from kinlab.formulas.language.vocabulary import is_program

_NOTHING = (
    r"(?:i\s*(?:do\s*not|don'?t|don’t)\s*know(?:\s*(?:it|this|how|that))?|i\s*have\s*no\s*idea|no\s*idea|idk|n\.?\s?/?\s?a\.?"
    r"|to\s*do|tbd|none|nothing|no\s*(?:answer|solution)|not\s*(?:done|solved|answered)|skipped?|sorry|unknown"
    r"|(?:das\s*)?(?:weiß|weiss)\s*(?:ich\s*)?(?:es\s*)?nicht|keine\s*(?:ahnung|antwort|lösung)|ohne\s*(?:antwort|lösung)"
    r"|je\s*ne\s*sais\s*pas|no\s*(?:lo\s*)?s[eé]|não\s*sei|non\s*(?:lo\s*)?so|не\s*знаю"
    r"|(?:我)?不(?:会做?|知道|懂|清楚)|没(?:有)?(?:做|写|答案)|未(?:做|答)|略|无|空)"
)
_NO_ANSWER = re.compile(
    rf"[\s\"'“”$(\[*_~`]*(?:{_NOTHING}|[-–—?？.…/\s_*]*)[\s\"'“”$)\].!。！?？…*_~`]*", re.I
)
_LONGEST = 60

_COMMAND = re.compile(r"\\[A-Za-z]+\*?(?:\{[a-z]*matrix\*?\}|\{array\}(?:\{\w*\})?)?")
_LETTERS = re.compile(r"[^\W\d_]+")
_SIGNS = re.compile(r"[-+*/^=\d(\\]")


@dataclass(frozen=True)
class Piece:
    """What may answer a question.

    Attributes:
        text: as typed; of TOML any value.
        key: what names it: a question's id from a label, or a key of TOML.
        under: the id of the question under whose label it stands, on a line of its own.
        sure: whether the label can be nothing else.
    """

    text: Any
    key: str = ""
    under: str = ""
    sure: bool = True


def is_no_answer(text: str) -> bool:
    """Whether a text says that there is none: ``I don't know``, ``?``, ``TODO``, ``不会``, nothing.

    Args:
        text: the whole answer, as typed.
    """
    return len(text) <= _LONGEST and bool(_NO_ANSWER.fullmatch(text.strip()))


def is_formula(text: str) -> bool:
    """Whether a line without a sign of equality is a formula, and no sentence.

    Args:
        text: without its label.
    """
    plain = _COMMAND.sub(" ", text[:4000])
    words = [word for word in _LETTERS.findall(plain) if len(word) > 1]
    words = [word for word in words if len(word) > 3 or not word.isascii()]
    sentence = any(not is_program(word) and word.lower() != "where" for word in words)
    return bool(_SIGNS.search(text)) and not sentence
