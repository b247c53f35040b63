"""What stands in front of an answer: ``q1:``, ``1)``, ``**q1**:``, ``Aufgabe 1:``, ``第1题：``.

A label is a question's id, its number (the id without its letters: 1a of q1a; the place on the
sheet where no id has a number), or a word such as Question or 题 with that number. Behind it
stands a colon, a bracket, a point, an arrow, a tabulator, or nothing: then the answer is on the
lines below. Around it there may be a list's dash, a heading's signs, or those of bold type.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from kinlab.doctor.marking.sheet import Question, Sheet

_WIDE = str.maketrans(
    "：（）［］【】．。、＝　０１２３４５６７８９＊＃｜", ":()[][]...= 0123456789*#|"
)
_WORDS = (
    "question|problem|exercise|task|part|item|aufgabe|frage|teilaufgabe|teil|übung|exercice"
    "|ejercicio|problema|pregunta|exercício|questão|questao|esercizio|domanda|opgave|vraag"
    "|问题|题目|习题|小题|题|问"
)
_ANSWER = (
    r"(?:(?:the\s+)?(?:answer|solution|result|antwort|lösung|réponse|respuesta)\s*"
    r"(?:(?:to|of|for|zu|auf)\s+)?|(?:答案?|解)\s*)"
)
_LONGEST = 160
"""Characters of a line in which a label is looked for."""
_CHINESE = {c: k for k, c in enumerate("一二三四五六七八九十", 1)}
_NUMBER = r"\d{1,3}\s?[A-Za-z]?(?![A-Za-z0-9])"
_FRONT = (
    r"\s*(?:>\s*)*(?P<heading>#{1,6}\s*)?(?P<item>[-*+•·–]\s+)?(?P<bold>\*\*|__|`|\*(?=\S)|~~)?\s*"
)
_OPEN, _CLOSE = r"(?P<open>[(\[{])?\s*", r"\s*(?P<close>[)\]}])?"
_SIGN = (
    r"\s*(?P<sign>[:)\].]|-+>|=>|→|⇒|\t|=(?!=)|(?(close)(?!)|[-–—](?=\s))|is\b|lautet\b|为|是|$)"
)
_SAYS = ("is", "lautet", "为", "是")
"""What joins a label to its answer in a sentence only."""
_BRACKETS = {"(": ")", "[": "]", "{": "}"}
_UNSURE = (*"=-–—",)
_OPERATORS = (*"*/^+-=,;.",)


@dataclass(frozen=True)
class SheetLabel:
    """A label at the beginning of a line.

    Attributes:
        question: whose answer follows.
        rest: what stands behind it on the line; empty where the answer is below.
        sure: whether it can be nothing else: ``q1 = F`` and ``q1 - F`` may be about joint 1.
    """

    question: Question
    rest: str
    sure: bool = True


class SheetLabels:
    """The labels of a sheet's questions.

    Args:
        sheet: whose questions they are.
    """

    def __init__(self, sheet: Sheet) -> None:
        self._ids = {_squeezed(q.id): q for q in sheet.questions}
        numbers: dict[str, list[Question]] = {}
        for question in sheet.questions:
            number = re.sub(r"^[^\d]*0*(?=\d)", "", _squeezed(question.id))
            if number[:1].isdigit():
                numbers.setdefault(number, []).append(question)
        if not any(any(c.isdigit() for c in q.id) for q in sheet.questions):
            numbers = {str(k): [q] for k, q in enumerate(sheet.questions, 1)}
        self._numbers = {key: found[0] for key, found in numbers.items() if len(found) == 1}
        known = "|".join(map(_loosely, sorted((q.id for q in sheet.questions), key=len)[::-1]))
        core = (
            rf"(?:(?P<word>{_ANSWER})?(?:(?:{_WORDS})\s*(?:no\.?|nr\.?|number|#)?\s*(?P<told>{_NUMBER})"
            rf"|第\s*(?P<nth>\d{{1,3}}[a-z]?|[一二三四五六七八九十]{{1,2}})\s*(?:小?题|问|部分|道题?)"
            rf"|(?P<id>{known})(?![A-Za-z0-9^/+(\[]|\*(?!\*)|_(?!_))|(?P<bare>{_NUMBER})))"
        )
        closed = r"\*\*|__|`|\*|~~"
        bold, late = rf"\s*(?(bold)(?P<shut>{closed})?)", rf"\s*(?(bold)(?(shut)|(?:{closed})?))"
        self._line = re.compile(
            rf"{_FRONT}{_OPEN}{core}{_CLOSE}{bold}{_SIGN}{late}\s*(?P<rest>.*)",
            re.IGNORECASE | re.DOTALL,
        )
        self._closed = re.compile(
            rf"{_FRONT}{_OPEN}{core}{_CLOSE}{bold}(?P<sign>)\s*(?P<rest>.*)",
            re.IGNORECASE | re.DOTALL,
        )

    def of(self, line: str) -> SheetLabel | None:
        """The label at the beginning of a line.

        Args:
            line: of a text, or what stands between formulas of LaTeX.
        """
        line = line.lstrip()
        plain = line[:_LONGEST].translate(_WIDE)
        found = self._line.fullmatch(plain) or self._closed.fullmatch(plain)
        if found is None or not _stands(found):
            return None
        question = self._named(found)
        if question is None:
            return None
        rest = line[found.start("rest") :].strip()
        sure = any(found[name] for name in ("word", "close", "told", "nth", "bare"))
        return SheetLabel(question, rest, sure or found["sign"] not in _UNSURE)

    def named(self, key: str) -> Question | None:
        """The question that a whole text names: ``1A``, ``Aufgabe 3``, ``2.``.

        Args:
            key: such as that of an entry in TOML.
        """
        found = self.of(key.strip(" .:)]") + ":")
        return found.question if found is not None and not found.rest else None

    def _named(self, found: re.Match[str]) -> Question | None:
        if found["id"]:
            return self._ids.get(_squeezed(found["id"]))
        number = _squeezed(found["told"] or found["nth"] or found["bare"]).lstrip("0")
        if number and number[0] in _CHINESE:
            tens, ones = _CHINESE[number[0]], _CHINESE.get(number[1:], 0)
            number = str(tens + ones if tens == 10 or not ones else tens * 10)
        return self._numbers.get(number)


def _stands(found: re.Match[str]) -> bool:
    """Whether it is a label, and not the beginning of a formula or of a sentence."""
    sign, rest = found["sign"], found["rest"]
    bracket = found["close"] or (sign if sign in (")", "]") else "")
    if found["open"] and _BRACKETS[found["open"]] != bracket:
        return False
    if sign in _SAYS:
        return bool(found["word"])
    behind = found.string[found.end("sign") :][:1]
    if found["open"] and found["sign"] in ("", ")", "]"):  # (1)*l1 is a product
        behind = found.string[found.end("close" if found["close"] else "sign") :][:1]
        return behind not in _OPERATORS if behind else True
    if sign in _UNSURE:
        told = found["id"] or (found["bare"] and sign == "=")
        return bool(found["told"] or found["nth"] or (told and not found["item"]))
    if sign:
        return not (sign == "." and behind.isdigit()) and not (sign == "\t" and found["bare"])
    if found["bold"] or found["heading"]:
        return True
    if found["nth"] and found.string[found.end("nth") :].find(" ") >= 0:
        return True
    return not rest and not found["bare"]


def _squeezed(text: str) -> str:
    """An id without what people leave out or put in: capitals, blanks, ``_``, a zero in front."""
    plain = re.sub(r"[\s_]", "", text).lower()
    return re.sub(r"(?<!\d)0+(?=\d)", "", plain)


def _loosely(name: str) -> str:
    """An id as a pattern: ``q1`` is met by ``Q 1``, ``q_1`` and ``q01`` too."""
    parts = re.findall(r"[A-Za-z]+|\d+|[_-]", name)
    shown = [re.escape(p) if not p.isdigit() else rf"0{{0,2}}{int(p)}" for p in parts]
    return r"[\s_]?".join(shown)
