"""One slip of the pen, two or three: the changes that make a line right, and the line then."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.text.alternatives import study
from kinlab.doctor.text.line import Change, Line, inside_call, is_sum, is_term, words_in
from kinlab.doctor.text.pairs import pairs_adding_up, pairs_in_product
from kinlab.tolerances import TOLERANCES

_TRIED = 60
_LONG = 8
"""Names in a formula from which on three slips are looked for."""
_EXCHANGED = 0.6
"""What it costs to exchange a whole term beside mending it."""
_TERMS = {"extra term", "missing term"}


@dataclass(frozen=True)
class Mended:
    """A text with its slips mended.

    Attributes:
        changes: one to three.
        text: the formula after them.
        cost: the sum of theirs.
    """

    changes: tuple[Change, ...]
    text: str
    cost: float


def mended(line: Line, most: int = 3) -> list[Mended]:
    """The fewest changes that make the text right, the likeliest first; empty where none do."""
    if not line.source.isascii():
        return []  # places are counted in bytes
    study(line)
    wanted = line.target - line.root.value
    if not line.rows:
        return []
    effects = np.array(line.rows)
    allowed = TOLERANCES.effect_matches * line.scale
    gaps = np.max(np.abs(effects - wanted), axis=1)
    found: list[tuple[int, ...]] = [(int(k),) for k in np.flatnonzero(gaps <= allowed)]
    for more in (_pairs, _covers)[: most - 1]:
        good = list(_checked(line, found))
        if good:
            return sorted(good, key=lambda m: m.cost)
        found = more(line, effects, wanted, allowed)
    return sorted(_checked(line, found), key=lambda m: m.cost)


def _pairs(line: Line, effects: Array, wanted: Array, allowed: float) -> list[tuple[int, ...]]:
    found = [tuple(pair) for pair in pairs_adding_up(effects, wanted, allowed)]
    value = line.root.value
    for place in line.places:
        if not is_term(place) or inside_call(place) or is_sum(place.node):
            continue
        start, end = place.span
        inside = [
            k
            for k, c in enumerate(line.changes)
            if start <= c.start and c.end <= end and not c.everywhere and c.kind != "missing term"
        ]
        if len(inside) < 2:
            continue
        slope = line.climbed(place, np.zeros(line.count))
        own = value - slope  # the share of this term in the whole
        pairs = pairs_in_product(effects[inside], wanted, own)
        found += [(inside[a], inside[b]) for a, b in pairs]
    return _cheapest(line, found)


def _cheapest(line: Line, found: list[tuple[int, ...]]) -> list[tuple[int, ...]]:
    ranked = sorted(set(found), key=lambda way: (_cost([line.changes[k] for k in way]), way))
    return ranked[:_TRIED]


def _cost(changes: Sequence[Change]) -> float:
    """How far-fetched several changes are together."""
    terms = {c.kind for c in changes} >= _TERMS
    return sum(c.cost for c in changes) + 0.4 * (len(changes) - 1) + _EXCHANGED * terms


def _covers(line: Line, effects: Array, wanted: Array, allowed: float) -> list[tuple[int, ...]]:
    """Three changes: one of them leaves what two others add up to.

    Only changes that take a whole term of the difference away are tried as the first.
    """
    rest = np.sum((wanted[:, None] - effects.T) ** 2, axis=0)
    order = np.argsort(rest + 1e-9 * np.array([c.cost for c in line.changes]), kind="stable")
    found: list[tuple[int, ...]] = []
    for first in order[:_TRIED]:
        pairs = pairs_adding_up(effects, wanted - effects[first], allowed)
        found += [tuple(sorted((int(first), *pair))) for pair in pairs if first not in pair]
    return _cheapest(line, found)


def together(line: Line, changes: tuple[Change, ...]) -> list[Mended]:
    """Changes that were found one by one, as one repair, if they are."""
    line.changes += changes
    behind = len(line.changes)
    found = [tuple(range(behind - len(changes), behind))]
    done = list(_checked(line, found))
    del line.changes[behind - len(changes) :]
    return done


def _checked(line: Line, found: list[tuple[int, ...]]) -> Iterator[Mended]:
    """Those that really give the values wanted once they are written down."""
    seen: set[str] = set()
    for way in found:
        changes = tuple(sorted((line.changes[k] for k in way), key=lambda c: (c.start, c.end)))
        if any(a.end > b.start or a.everywhere or b.everywhere for a, b in pairwise(changes)):
            continue
        text = rewritten(line.source, changes)
        if text is None or text in seen:
            continue
        seen.add(text)
        if (len(changes) > 2 and len(words_in(line.source)) < _LONG) or not _same_formula(changes):
            continue
        values = replace(line.text, text=text).values(line.at)
        with np.errstate(all="ignore"):
            gap = np.max(np.abs(values - line.target))
        if gap <= TOLERANCES.effect_matches * line.scale:
            yield Mended(changes, text, _cost(changes))


def _same_formula(changes: tuple[Change, ...]) -> bool:
    """Whether something of the formula is left: terms out and other terms in make any other."""
    return sum(c.kind in _TERMS for c in changes) < 3


def rewritten(source: str, changes: tuple[Change, ...]) -> str | None:
    """The text with the changes in place; None where it is no formula any more."""
    text = source
    for change in sorted(changes, key=lambda c: -c.start):
        text = text[: change.start] + change.new + text[change.end :]
    text = re.sub(r"^\s*\+\s*", "", text.strip())
    text = re.sub(r"\(\s*\+\s*", "(", text)
    text = re.sub(r"(^|\()\s*-\s+", r"\1-", re.sub(r"  +", " ", text))
    try:
        ast.parse(text, mode="eval")
    except SyntaxError:
        return None
    return text
