"""What tried edits do to a program's answer, number by number: which of them may go together.

Where an edit changes nothing, the other of a pair must be right alone; where both change
something, their effects may add up, or their ratios multiply. Products of matrices have a rule of
their own: with T the answer, T1 and T2 what it is with one edit each, both make T1 inv(T) T2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.program.places import ProgramEdit
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.doctor.text.pairs import pairs_adding_up
from kinlab.tolerances import TOLERANCES

_TRIPLES = 250
"""Edits of which any three may be in one product."""
_PAIRED = 900
"""Edits of which any two may go together."""
_LEADING = 40
"""Edits that make numbers right, of which any two are joined with a third."""
_THIRDS = 4
"""Edits that are tried as the third of two."""
_ALIKE = 8
"""Edits of one effect that are kept."""
_NOWHERE = 1e3
"""Stands for an answer that is no number, relative to the answer's size."""
_BITS = 63
"""Numbers of an answer by which it is foreseen what edits do together."""
_EXCHANGED = 0.5
"""What it costs to take a term out and put another in."""

Flags = Any
"""An array of truth values."""
Chosen = tuple[int, ...]
"""Effects that together may make a program right."""
Way = tuple[ProgramEdit, ...]
"""Edits that together may make a program right."""
Tried = list[tuple[ProgramEdit, Array]]
"""Edits, each with the answers at the first states."""


@dataclass(frozen=True, eq=False)
class Effects:
    """What edits change, each effect once.

    Attributes:
        alike: for each effect the edits that have it, the likeliest first.
        rows: the effects, (E, P), relative to the answer's size.
        own, goal: the answer as it is, and what is missing, (P,).
        near: what may be left of it.
        likely: how far-fetched an edit is.
    """

    alike: list[list[ProgramEdit]]
    rows: Array
    own: Array
    goal: Array
    near: float
    likely: Callable[[ProgramEdit], float]

    def known(self, rows: Array) -> Array:
        """Answers, (C, P), with what stands for none where the program has none either."""
        none = (self.own[: rows.shape[1]] == _NOWHERE) & ~np.isfinite(rows)
        return np.where(none, _NOWHERE, rows)

    def beside(self, other: Effects) -> Effects:
        """More numbers of the same answers, for those edits of which they are known."""
        known = {id(edits[0]): k for k, edits in enumerate(other.alike)}
        both = [(k, known[id(edits[0])]) for k, edits in enumerate(self.alike)
                if id(edits[0]) in known]  # fmt: skip
        here, there = [k for k, _ in both], [k for _, k in both]
        return Effects(
            [self.alike[k] for k in here],
            np.hstack([self.rows[here], other.rows[there]]),
            np.concatenate([self.own, other.own]),
            np.concatenate([self.goal, other.goal]),
            self.near,
            self.likely,
        )

    @cached_property
    def costs(self) -> Array:
        return np.array([self.likely(edits[0]) for edits in self.alike])

    @property
    def right(self) -> Flags:
        """Which numbers an edit alone makes, or leaves, right, (E, P)."""
        return np.asarray(np.abs(self.rows - self.goal) <= self.near)

    @property
    def still(self) -> Flags:
        """Which numbers an edit leaves as they are, (E, P)."""
        return np.asarray(np.abs(self.rows) <= self.near)

    @property
    def wrong(self) -> Flags:
        """Which numbers are not right, (P,)."""
        return np.asarray(np.abs(self.goal) > self.near)

    @property
    def gaining(self) -> list[int]:
        """Effects that make numbers right and spoil none; those that make most first."""
        harmless = (self.right | self.wrong).all(axis=1)
        gains = (self.right & self.wrong).sum(axis=1)
        some = np.flatnonzero(harmless & (gains > 0))
        return [int(k) for k in some[np.lexsort((self.costs[some], -gains[some]))]]

    def edits(self, chosen: Chosen, most: int) -> Iterator[Way]:
        """The likeliest edits of these effects, and then the others of the same effects."""
        ways = product(*(self.alike[k][:most] for k in chosen))
        yield from (way for way in ways if len({*map(id, way)}) == len(way))

    def cost(self, chosen: Chosen) -> float:
        """How far-fetched the likeliest edits of these effects are together."""
        swapped = {"extra term", "missing term"} <= {self.alike[k][0].kind for k in chosen}
        return float(self.costs[[*chosen]].sum()) + (_EXCHANGED if swapped else 0.0)

    def adding_up(self, count: int) -> list[Chosen]:
        """Two or three edits whose effects add up to what is missing, the likeliest first."""
        allowance = TOLERANCES.effects_add_up
        if count == 2:
            found: list[Chosen] = [*pairs_adding_up(self.rows, self.goal, allowance)]
            twice = np.abs(2 * self.rows - self.goal).max(axis=1) <= allowance
            found += [(int(k),) * 2 for k in np.flatnonzero(twice) if len(self.alike[k]) > 1]
        else:
            found = self._threes(allowance)
        return sorted(found, key=self.cost)

    def multiplying(self) -> list[Chosen]:
        """Two edits that each multiply the whole answer, and together make it right."""
        size = float(self.own @ self.own)
        if not size or not np.isfinite(size):
            return []
        every = np.vstack([self.goal, self.rows])
        ratios = 1.0 + every @ self.own / size
        off = np.abs(self.own + every - ratios[:, None] * self.own).max(axis=1)
        whole = (off <= self.near) & (np.abs(ratios) > self.near)
        if not whole[0]:
            return []
        some = np.flatnonzero(whole[1:])
        sizes = ratios[1:][some]
        meets = np.abs(sizes[:, None] * sizes - ratios[0]) <= self.near * abs(ratios[0])
        one, two = np.nonzero(np.triu(meets))
        pairs = ((int(some[i]), int(some[j])) for i, j in zip(one, two, strict=True))
        found = [(i, j) for i, j in pairs if i != j or len(self.alike[i]) > 1]
        return sorted(found, key=self.cost)

    def _threes(self, allowance: float) -> list[Chosen]:
        """Three effects that add up to what is missing."""
        weights = np.random.default_rng(5).uniform(0.5, 1.5, len(self.goal))
        marks, goal = self.rows @ weights, float(self.goal @ weights)
        order = np.argsort(marks, kind="stable")
        line, wide = marks[order], allowance * len(weights)
        down = order[::-1]  # what is sought ascends, and is found sooner
        found: list[Chosen] = []
        for k in range(len(marks) - 2):
            later = down[down > k]
            sought = goal - marks[k] - marks[later]
            low = np.searchsorted(line, sought - wide)
            hits = np.flatnonzero(line[np.minimum(low, len(line) - 1)] - sought <= wide)
            hits = hits[low[hits] < len(line)]
            for i in hits[np.argsort(later[hits])]:
                one, last = int(later[i]), int(np.searchsorted(line, sought[i] + wide, "right"))
                for other in order[low[i] : last]:
                    total = self.rows[[k, one, other]].sum(axis=0)
                    if other > one and np.max(np.abs(total - self.goal)) <= allowance:
                        found.append((k, one, int(other)))
        return found

    def in_a_row(self, count: int, shape: tuple[int, int]) -> list[Chosen]:
        """Edits of factors of one product of matrices, as the answer is."""
        own = self.own.reshape(-1, *shape)
        wanted = own + self.goal.reshape(own.shape)
        each = own + self.rows.reshape(-1, *own.shape)
        with np.errstate(all="ignore"):
            sound = np.linalg.cond(own).max() < 1 / self.near
            sound = sound and np.isfinite(each).all()
            usable = np.flatnonzero(np.linalg.cond(each).max(axis=1) < 1 / self.near)
        if not sound or not len(usable):
            return []
        usable = usable[: _TRIPLES if count == 3 else _PAIRED]
        each = each[usable]
        # T1 inv(T) T2 = W where T2 = (T inv(T1)) W
        undone = own @ np.linalg.inv(each)
        found: list[Chosen] = []
        firsts = (
            [((), wanted)] if count == 2 else [((k,), undone[k] @ wanted) for k in range(len(each))]
        )
        for before, goal in firsts:
            found += [(*before, i, j) for i, j in _meeting(undone @ goal, each, self.near)]
        apart = [
            tuple(int(usable[k]) for k in chosen) for chosen in found if len({*chosen}) == count
        ]
        return sorted(apart, key=self.cost)

    def pairs(self) -> list[Chosen]:
        """Pairs that nothing speaks against, those first that explain most of the numbers."""
        some = slice(0, _PAIRED)
        right, still, rows = self.right[some], self.still[some], self.rows[some]
        against: Any = still.astype(np.float32) @ (~right).astype(np.float32).T
        one, two = np.nonzero(np.triu(against + against.T == 0, 1))
        told = np.zeros(len(one))
        for k in range(len(self.goal)):
            told += self._explained(k, still, rows, one, two)
        costs = self.costs[one] + self.costs[two]
        order = np.lexsort((costs, -told))
        return [(int(one[k]), int(two[k])) for k in order]

    def _explained(self, k: int, still: Flags, rows: Array, one: Any, two: Any) -> Array:
        """Whether a pair makes one number right, as far as can be foreseen."""
        first, last, own, goal = rows[one, k], rows[two, k], self.own[k], self.goal[k]
        sums = np.abs(first + last - goal) <= self.near
        size = max(abs(own), abs(own + goal))
        products = np.abs((own + first) * (own + last) - own * (own + goal)) <= self.near * size
        alone = still[one, k] | still[two, k]
        return np.asarray(np.where(alone, self.wrong[k], sums | products), dtype=float)

    def triples(self) -> list[Chosen]:
        """Two that make numbers right, with a third that nothing speaks against."""
        costs = self.costs
        leading = [k for k in self.gaining if k < _PAIRED][:_LEADING]
        right, still = self.right[:_PAIRED], self.still[:_PAIRED]
        found: list[tuple[float, float, tuple[int, ...]]] = []
        for n, i in enumerate(leading):
            for j in leading[:n]:
                # what only one of the three changes, that one must make right
                fits = ~np.any(~right & still[i] & still[j], axis=1)
                fits &= ~np.any(still & still[j] & ~right[i] | still & still[i] & ~right[j], axis=1)
                fits[[i, j]] = False
                thirds = np.flatnonzero(fits)
                told = (self.wrong & (right[i] | right[j] | right[thirds])).sum(axis=1)
                best = np.lexsort((costs[thirds], -told))[:_THIRDS]
                found += [
                    (-float(told[k]), float(costs[[i, j, thirds[k]]].sum()), (j, i, int(thirds[k])))
                    for k in best
                ]
        return [chosen for *_, chosen in sorted(found)]


def as_bits(flags: Flags) -> Any:
    """Truth values of the first numbers, (..., P), as the bits of one, (...,)."""
    bits = 1 << np.arange(min(_BITS, flags.shape[-1]), dtype=np.uint64)
    return np.where(flags[..., : len(bits)], bits, np.uint64(0)).sum(axis=-1, dtype=np.uint64)


def possible(moved: Any, spoilt: Any, wrong: Any, one: Any, other: Any) -> Any:
    """Of which pairs each number that one of them changes alone is made right by it.

    None may leave a wrong number as it is.

    Args:
        moved, spoilt: as bits what each edit changes, and makes or leaves wrong.
        wrong: as bits what is wrong as it is.
        one, other: the edits of each pair.
    """
    alone = (spoilt[one] & ~moved[other]) | (spoilt[other] & ~moved[one])
    return (alone == 0) & (wrong & ~(moved[one] | moved[other]) == 0)


def _meeting(sought: Array, each: Array, near: float) -> list[tuple[int, int]]:
    """Which of the sought matrices are which of the others."""
    flat, others = sought.reshape(len(sought), -1), each.reshape(len(each), -1)
    weights = np.random.default_rng(5).uniform(0.5, 1.5, flat.shape[1])
    line, along = flat @ weights, others @ weights
    order = np.argsort(along, kind="stable")
    along = along[order]
    wide = 10 * near * flat.shape[1]
    low, high = np.searchsorted(along, line - wide), np.searchsorted(along, line + wide)
    return [
        (int(i), int(j))
        for i in np.flatnonzero(high > low)
        for j in order[low[i] : high[i]]
        if i != j and np.max(np.abs(flat[i] - others[j])) <= 10 * near
    ]


def effects_of(search: LineSearch, tried: Tried) -> Effects | None:
    """The effects of edits that were tried; None where the program has no answer."""
    values = search.asked.values(search.asked.first)
    if values is None:
        return None
    scale = search.asked.scale
    own = (values / scale).ravel()
    lost = ~np.isfinite(own)
    own[lost] = _NOWHERE
    kept: dict[Any, tuple[list[ProgramEdit], Array]] = {}
    # vectors that are turned have the same energy: only alone
    norm = search.asked.wanted[0].size == 1
    for edit, values in tried:
        row = (values / scale).ravel()
        effect = np.where(lost & ~np.isfinite(row), _NOWHERE, row) - own
        if not np.isfinite(effect).all():
            continue
        key: Any = (np.round(effect, 7) + 0.0).tobytes()
        key = (key, edit.node) if norm else key
        if np.max(np.abs(effect)) < TOLERANCES.effects_add_up:
            if not lost.any():
                continue
            key = id(edit)  # what it does to an answer that is none is not known
        kept.setdefault(key, ([], effect))[0].append(edit)
    alike = [(sorted(edits, key=search.likely)[:_ALIKE], row) for edits, row in kept.values()]
    alike.sort(key=lambda pair: search.likely(pair[0][0]))
    return Effects(
        [edits for edits, _row in alike],
        np.array([row for _edits, row in alike]).reshape(len(alike), own.size),
        own,
        (search.asked.wanted[search.asked.first] / scale).ravel() - own,
        max(TOLERANCES.tried_further, search.asked.allowed),
        search.likely,
    )
