"""What the catalogue says of a formula, and where it stands in its note: heading, number, lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import resources

from kinlab.formulas.record import Formula
from kinlab.host.language import _, speaking


@dataclass(frozen=True)
class Passage:
    """A passage of a note.

    Attributes:
        note: its number.
        heading: the heading it stands under, as the note has it.
        formulas: which of the displayed formulas under that heading, first and last; ``6.4`` is
            the fourth equation of the sixth. Empty where it stands in the text.
        first, last: lines of the note's text, from 1.
        ids: the formulas of the catalogue that hold it.
    """

    note: str
    heading: str
    formulas: tuple[str, ...]
    first: int
    last: int
    ids: tuple[str, ...]


@cache
def places() -> tuple[Passage, ...]:
    """Every passage of every note, in order; the ledger is ``kinlab/notes/lines.tsv``."""
    text = (resources.files("kinlab.notes") / "lines.tsv").read_text(encoding="utf-8")
    found = []
    for line in text.splitlines():
        if not line.startswith("#"):
            note, span, ids, _words, heading, formulas = line.split("\t")
            first, _dash, last = span.partition("-")
            found.append(
                Passage(
                    note,
                    heading,
                    tuple(formulas.split("-")) if formulas != "-" else (),
                    int(first),
                    int(last or first),
                    tuple(ids.split()) if ids != "-" else (),
                )
            )
    return tuple(found)


def place_in_note(record: Formula) -> str:
    """Where a formula stands in its note, in words; empty for one of no note."""
    told = []
    mine = _mine(record)
    for heading in dict.fromkeys(one.heading for one in mine):
        here = [one for one in mine if one.heading == heading]
        lines = _ranges(here)
        numbers = _numbers(here)
        if numbers:
            text = _("“{heading}”, formula {numbers}, lines {lines}")
        else:
            text = _("“{heading}”, in the text, lines {lines}")
        told.append(text.format(heading=heading, numbers=numbers, lines=lines))
    return _("; ").join(told)


def short_place(record: Formula) -> str:
    """As :func:`place_in_note`, without a heading that stands alone: the source says it."""
    mine = _mine(record)
    if len({one.heading for one in mine}) != 1:
        return place_in_note(record)
    lines, numbers = _ranges(mine), _numbers(mine)
    text = _("formula {numbers}, lines {lines}") if numbers else _("in the text, lines {lines}")
    return text.format(numbers=numbers, lines=lines)


def _mine(record: Formula) -> list[Passage]:
    return [one for one in places() if record.note == one.note and record.id in one.ids]


def _ranges(passages: list[Passage]) -> str:
    """Lines as ``54–61, 68–77``; passages that touch are one."""
    joined: list[list[int]] = []
    for one in passages:
        if joined and one.first == joined[-1][1] + 1:
            joined[-1][1] = one.last
        else:
            joined.append([one.first, one.last])
    return ", ".join(f"{a}" if a == b else f"{a}–{b}" for a, b in joined)


def _numbers(passages: list[Passage]) -> str:
    """Numbers as ``1, 4–6`` or ``6.1–6.3``; those that follow each other are one range."""
    joined: list[list[str]] = []
    for first, last in ((one.formulas[0], one.formulas[-1]) for one in passages if one.formulas):
        if joined and _meets(joined[-1][1], first):
            joined[-1][1] = last
        else:
            joined.append([first, last])
    return ", ".join(a if a == b else f"{a}–{b}" for a, b in joined)


def _meets(one: str, other: str) -> bool:
    """Whether two numbers are the same, or the second is the next: 4 and 5, 6.1 and 6.2."""
    (outer, _dot, inner), (outer2, _dot, inner2) = one.rpartition("."), other.rpartition(".")
    return one == other or (outer == outer2 and int(inner) + 1 == int(inner2))


def told_of(record: Formula, lang: str | None = None) -> dict[str, str]:
    """What the catalogue says of a formula, in a language.

    Args:
        record: from :func:`kinlab.check.catalogue.catalogue`.
        lang: the language, such as ``"zh"``; None for the one that is spoken.

    Returns:
        ``title``, ``source``, ``place``, ``misprint`` and ``remark``; empty where there is none.

    Raises:
        OptionError: a language that kinlab does not speak.
    """
    with speaking(lang):
        return {
            "title": _(record.title),
            "source": _(record.source),
            "place": place_in_note(record),
            "misprint": _(record.printed.misprint) if record.printed else "",
            "remark": _(record.remark),
        }
