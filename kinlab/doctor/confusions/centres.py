"""Centres of mass apart from the lengths: an arm of which lc1 is a number of its own, not l1/2.

Of uniform rods ``l1*l2*c2`` is ``2*l1*lc2*c2``, and many a wrong repair is right. Who writes lc2
means the centre, wherever it is: what is said of such a formula must hold where it is elsewhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache

import numpy as np

from kinlab.doctor.changes import AnswerEntry, Case, table_of
from kinlab.doctor.derived import Derivation, derivation
from kinlab.doctor.text.habits import as_text, in_books
from kinlab.doctor.text.written import Written
from kinlab.errors import KinlabError, already_said
from kinlab.formulas import tree
from kinlab.formulas.text import canonical, parse, words_in
from kinlab.formulas.tree import Node
from kinlab.model.dh import DHTable
from kinlab.symbolic.trig import Poly
from kinlab.symbolic.vocabulary import Vocabulary, vocabulary

_CENTRE = re.compile(r"(?:lc|r)(\d*)")
_ELSEWHERE = 0.93
"""What a centre's distance from its joint is multiplied by: it is no simple part of l then."""


@dataclass(frozen=True, eq=False)
class FreeCentres:
    """A text, and what it should be, of an arm with its centres elsewhere.

    Attributes:
        text: the text, in which lc1 is a name of its own.
        here: the same text where lc1 is l1/2, as is each centre that may come into it.
        named: whether the text names a centre.
        derived, poly: the derivation and the entry's polynomial.
    """

    text: Written
    here: Written
    named: bool
    derived: Derivation
    poly: Poly


def apart(case: Case, entry: AnswerEntry, text: Written, poly: Poly) -> FreeCentres | None:
    """The text of an arm with its centres elsewhere; None where no centre comes into it."""
    table = table_of(case.robot)
    other = None if table is None else centres_elsewhere(table, [text])
    derived = None if other is None else derivation(other, case.quantity.name)
    if table is None or other is None or derived is None:
        return None
    there = derived.entry(entry.index)
    if _letters(there) <= _letters(poly):
        return None
    meant = {name: as_text(total) for name, total in vocabulary(table).others.items() if total}
    own = {name: written for name, written in meant.items() if written != name}
    here = replace(text, symbols={**own, **text.symbols})
    return FreeCentres(
        as_there(text, table, other), here, bool(_named(text, table)), derived, there
    )


def _letters(poly: Poly) -> set[str]:
    """The names in a polynomial."""
    return {str(name) for name in poly.as_expr().free_symbols}


def centres_elsewhere(
    table: DHTable, texts: Iterable[Written], rods: bool = True
) -> DHTable | None:
    """The arm with other centres: those that texts name, and if asked, of ``rods`` all."""
    links = {k for text in texts for k in _named(text, table).values()}
    if rods:
        links |= {k for k in range(1, table.n + 1) if _share(table, k) == Fraction(1, 2)}
    return _moved(table, tuple(sorted(k for k in links if _share(table, k))))


def as_there(text: Written, table: DHTable, other: DHTable) -> Written:
    """A text of one arm as one of another, in which its names of centres are other ones."""
    words, symbols = vocabulary(other), dict(text.symbols)
    for name, k in _centres(text, table).items():
        symbols[name] = as_text(words.others[f"lc{k}"])
        if symbols[name] == name:
            del symbols[name]
    there = replace(text, symbols=symbols)
    return replace(there, node=_in_names(there, parse(there.text)))


def _in_names(text: Written, node: Node) -> Node:
    """A piece of a text in the robot's names."""
    meant: dict[str, Node] = {}
    for name in tree.names(node):
        if name in text.known:
            meant[name] = text.known[name]
        elif name in text.symbols:
            meant[name] = _in_names(text, parse(text.symbols[name]))
        else:
            meant[name] = canonical(name)
    return tree.renamed(node, meant)


def by_equal_numbers(text: Written, derived: Derivation, poly: Poly) -> Written:
    """A text that has an equal number of the arm's by its name: of a pole's tool for its centre."""
    own, right = tree.names(text.node), _letters(poly)
    values, symbols = derived.values, dict(text.symbols)
    for name in sorted(own - right):
        alike = [other for other in sorted(right - own) if values.get(other) == values.get(name)]
        if name in values and len(alike) == 1 and name not in symbols:
            symbols[name] = alike[0]
    if symbols == text.symbols:
        return text
    there = replace(text, symbols=symbols)
    return replace(there, node=_in_names(there, parse(there.text)))


def stands_so(text: Written, name: str, words: Vocabulary) -> bool:
    """Whether a writer's name stands for what books call so: lc2 for l2/2 of a rod."""
    meant = words.others.get(in_books(name)) or words.others.get(f"{in_books(name)}1")
    return bool(meant) and parse(text.symbols[name]) == parse(as_text(meant or ()))


def _centres(text: Written, table: DHTable) -> dict[str, int]:
    """A writer's names of centres that are parts of a length, and their links."""
    words = vocabulary(table)
    names = {name: _CENTRE.fullmatch(in_books(name)) for name in text.symbols}
    links = {name: int(one[1] or 1) for name, one in names.items() if one}
    return {name: k for name, k in links.items() if stands_so(text, name, words)}


def _named(text: Written, table: DHTable) -> dict[str, int]:
    """Those of them that stand in it."""
    met = {*words_in(text.text), *text.definitions}
    return {name: k for name, k in _centres(text, table).items() if name in met}


@lru_cache(maxsize=64)
def _share(table: DHTable, k: int) -> Fraction:
    """Which part of a length of its link a centre's distance from its joint is, or 0."""
    words = vocabulary(table)
    meant = words.others.get(f"lc{k}", ())
    if len(meant) != 1 or _CENTRE.fullmatch(meant[0][1]) or meant[0][1][0] == "c":
        return Fraction(0)
    return Fraction(0) if np.any(np.asarray(table.links[k - 1].com)[1:]) else meant[0][0]


@lru_cache(maxsize=64)
def _moved(table: DHTable, links: tuple[int, ...]) -> DHTable | None:
    """The arm with the centres of some links elsewhere on them; None of no links."""
    words, rows = vocabulary(table), list(table.links)
    for k in links:
        ((share, name),) = words.others[f"lc{k}"]
        centre = float(share) * words.values[name]
        along, *beside = map(float, np.asarray(rows[k - 1].com))
        com = np.array([along + (_ELSEWHERE - 1.0) * centre, *beside])
        rows[k - 1] = replace(rows[k - 1], com=com)
    try:
        with already_said():
            return replace(table, links=rows) if links else None
    except KinlabError:
        return None
