"""Two or three edits that change the same numbers of an answer, tried in lanes.

Where edits change the same numbers, what they do together cannot be told from what each does
alone. Pairs are run all together, each in a lane; three of which no more than two act on one
another are told from their pairs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from itertools import combinations, islice
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.changes import ANY_ZERO
from kinlab.doctor.program.lanes.numbers import lanes_within, operation
from kinlab.doctor.program.lanes.run import InLanes
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.doctor.program.several.effects import Chosen, Effects, as_bits, possible
from kinlab.doctor.program.trial import NoProgramError
from kinlab.doctor.text.pairs import pairs_adding_up

_BLOCK = 120
"""Edits of which each is run with each of as many others at a time."""
_EDITS = 2400
"""Edits of which any two are run together."""
_AT_ONCE, _FOLLOWED = 400, 5
"""Of how many it is looked at a time; of all work the part after which no more are."""
_WIDE, _DOUBTED, _SPARED, _LOT = 600, 10, 0.45, 150
"""Edits of which any two may be run where not all of the likeliest can; how much later those come
that something speaks against; the share of the work for such a run, and pairs of the shortest: an
edit that none of these has costs nothing."""
_LITTLE = 8
"""Of what is left the part that is little."""
_FIRST = 2
"""Products of the ranks of two such blocks up to which any two of their edits are run first."""
_SOUND = 0.6
"""Share of the edits that lanes must follow, for what they tell to be of use."""
_WATCHED = 1
"""States at which that is looked at."""
_WITHIN = 200
"""Edits of which one may be in the other."""
_THREE, _KEPT = 600, 6_000_000
"""Edits of which any three may go together, fewer where their pairs have more numbers."""
_TRIED = 2000
"""Threes that are run, of each way to tell them."""
_ALL, _LEAST = 180_000_000, 90_000_000
"""Work that may be done for single edits and those tried together; the least for these."""
_ALONE, _UNFORESEEN = 150, 300
"""Edits of which any two are run alone where lanes cannot follow them; and pairs of which nothing
says that they may do."""
_LIKELY, _PRODUCT = 300, 600_000
"""Edits of which any three are run together, the product of whose ranks is no larger."""
_SOONEST = 60
"""Edits of which any three are run, whatever speaks against them."""
_GAINING = 30
"""Edits that make numbers right, with which any other is run."""
_BEYOND = 10_000_000
"""What one run may take beyond what is left."""
_ONE_RUN = 45_000_000
"""What one run may take at all: more is a recursion with edits in each call."""
_NUMBERS = 2
"""Numbers of answers that amount to one operation."""
_TO_READ = 200
"""Work of finding where the tool is for an answer's joint positions."""
_FOR_THREES = 2
"""Of the work the part that pairs leave to threes."""
_NONE = -1
"""In place of an edit's number."""


class TriedTogether:
    """The effects of edits of a wrong program, tried together.

    Args:
        search: whose program is wrong.
        known: the effects of single edits.

    Attributes:
        left: work that may still be done.
        each: how many operations a run takes.
        usable: whether lanes can follow the program.
        thorough: whether a run is so cheap that any two of the likeliest edits are run together.
    """

    def __init__(self, search: LineSearch, known: Effects) -> None:
        self.search, self.known = search, known
        self.left = max(_LEAST, _ALL - search.work.done) if search.wide else search.most
        self.count = 1 + (search.case.quantity.name in ANY_ZERO)
        self.sound = np.empty(0, dtype=int)
        self.usable, self.thorough, self.each = False, False, 0.0
        states = search.asked.states_at(search.asked.first)
        edits = known.alike[:_EDITS]
        for counts in (True, False):  # whole numbers may be what something is counted by
            try:
                self.lanes = InLanes(search.trial, search.observed, edits, states, counts)
            except NoProgramError:
                return
            self.usable = self._follows(len(edits)) and self.left > 0
            if self.usable or not self.lanes.counts or self.left <= 0:
                break
        likeliest = min(_BLOCK, len(self.sound)) ** 2 // 2
        self.thorough = self.usable and self._within(_SPARED * self.left) >= likeliest
        size = known.rows.shape[1] * self.count // len(search.asked.first)
        self.weights = np.random.default_rng(5).uniform(0.5, 1.5, size)
        self.three = min(_THREE, math.isqrt(_KEPT // max(size, 1)))
        self.both = np.full((self.three, self.three, size), np.nan)
        self.chosen: list[Any] = []
        self.marks: list[Array] = []

    def _follows(self, count: int) -> bool:
        """Whether most edits do in lanes what they do alone: others are left out."""
        before, reached = self.left, 0
        sound: list[Array] = []
        while reached < count and before - self.left < max(before // _FOLLOWED, 1):
            some = np.arange(reached, min(reached + _AT_ONCE, count))
            alone = np.concatenate([[_NONE], some])[:, None]
            done = self.lanes.work
            rows = self._rows(alone, max(self.count, _WATCHED), _BEYOND + self.left)
            if rows is None or not np.abs(rows[0]).max() <= self.known.near:
                return False
            self.each = max(self.each, (self.lanes.work - done) / operation(len(alone)))
            known = self.known.rows[some, : rows.shape[1]]
            gap = np.abs(rows[1:] - known).max(axis=1)
            size = np.maximum(1.0, np.abs(known).max(axis=1))
            placed = np.isin(some, [*self.lanes.placed])
            sound.append(some[(gap <= self.known.near * size) & placed])
            reached += len(some)
        self.sound = np.concatenate(sound)
        self.within = self.lanes.woven.inside()
        return len(self.sound) >= _SOUND * reached

    def _rows(self, chosen: Any, count: int | None, most: int = _ONE_RUN) -> Array | None:
        """What edits change together, relative to the answer's size, (C, P)."""
        before = self.lanes.work
        most = min(_BEYOND + max(self.left, 0), most)
        found = self.lanes.answers(chosen, count, most)
        self.left -= self.lanes.work - before
        values = None if found is None else self.search.asked.of_lanes(found)
        if values is None:
            return None
        if self.search.case.quantity.read is not None:
            self.left -= _TO_READ * values.shape[0] * values.shape[1]
        rows: Array = (values / self.search.asked.scale[: values.shape[1]]).reshape(len(chosen), -1)
        self.left -= rows.size // _NUMBERS
        return self.known.known(rows) - self.known.own[: rows.shape[1]]

    def _right(self, chosen: Any) -> tuple[Any, Array | None]:
        """Which of some combinations make the program right; and what all do at first."""
        rows = self._rows(chosen, self.count)
        right = chosen[self._fits(rows)] if rows is not None else chosen[:0]
        if len(right) and self.count < len(self.search.asked.first):
            whole = self._rows(right, None)
            right = right[self._fits(whole)] if whole is not None else right[:0]
        return right, rows

    def _fits(self, rows: Array) -> Any:
        """Which effects make the first numbers right."""
        gap = np.abs(rows - self.known.goal[: rows.shape[1]])
        return np.flatnonzero((gap <= self.known.near).all(axis=1))

    # -------- Two

    def pairs(self) -> Iterator[list[Chosen]]:
        """Any two edits that make the program right, some at a time, the likeliest first."""
        found: list[Chosen] = []
        before, kept = 0, self.left // _FOR_THREES if self.search.wide else 0
        for rank, chosen in self._in_turn() if self.usable else ():
            if rank != before and found:
                yield sorted(found, key=self.known.cost)
                found = []
            if rank != before and self.left <= kept:
                break
            before = rank
            right, rows = self._right(chosen)
            if rows is None:
                continue
            found += [(int(i), int(j)) for i, j in right]
            self._keep(chosen, rows)
        if found:
            yield sorted(found, key=self.known.cost)

    def beside_lanes(self) -> list[Chosen]:
        """Pairs of the likeliest that lanes cannot follow, the likeliest first.

        Of those that cannot be foreseen, as one leaves what the other puts elsewhere, some.
        """
        few = np.arange(min(_ALONE, len(self.known.alike)))
        first, last = np.triu_indices(len(few), 1)
        followed = np.isin(few, self.sound)
        some = ~(followed[first] & followed[last])
        pairs = np.stack([first[some], last[some]], axis=1)
        order = np.lexsort(((pairs + 1).prod(axis=1), ~self._possible_of(pairs)))
        foreseen = int(self._possible_of(pairs).sum())
        return [(int(i), int(j)) for i, j in pairs[order[: foreseen + _UNFORESEEN]]]

    def _in_turn(self) -> Iterator[tuple[int, Any]]:
        """Pairs with their rank: of the likeliest all, then what is possible, then all others."""
        likely = True
        if not self.thorough:
            yield from enumerate(self._lots(self._few()), 1)
            return
        for rank, one, other in self._blocks():
            if likely and rank > _FIRST:
                likely = False
                yield from self._possible_pairs()
                yield from self._beside_gains()
            chosen = self._apart(one, other)
            if not likely:
                chosen = chosen[~self._possible_of(chosen)]
            if len(chosen):
                yield rank, chosen

    def _lots(self, chosen: Any) -> Iterator[Any]:
        """Combinations as many at a time as the work that is left allows, the likeliest first.

        The likeliest have few edits, and edits that none has cost nothing: a lot is twice as long
        as the one before that took little of it.
        """
        start, size = 0, min(max(self._within(_SPARED * self.left), _LOT), _BLOCK**2)
        while start < len(chosen) and self.left > 0:
            before = self.left
            yield chosen[start : start + size]
            start += size
            little = (before - self.left) * _LITTLE <= self.left
            size = min(2 * size if little else max(size // 2, _LOT), _BLOCK**2)

    def _within(self, work: float) -> int:
        """How many pairs may be run at once with so much work."""
        return lanes_within(work / self.each) if self.each else _BLOCK**2

    def _few(self) -> Any:
        """Any two of the likeliest edits, the likeliest first; later what something is against."""
        some = self.sound[:_WIDE]
        pairs = self._apart(some, some)
        far = (pairs + 1).prod(axis=1) * np.where(self._possible_of(pairs), 1, _DOUBTED)
        return pairs[np.argsort(far, kind="stable")]

    def _possible_pairs(self) -> Iterator[tuple[int, Any]]:
        """Pairs of which nothing speaks against them, beyond the likeliest; the likeliest first.

        Those of a block stay together: a run of few edits takes less than one of many.
        """
        every = [self._apart(one, other) for rank, one, other in self._blocks() if rank > _FIRST]
        if not every:
            return
        pairs = np.concatenate(every)
        pairs = pairs[self._possible_of(pairs)]
        for start in range(0, len(pairs), _BLOCK**2):
            yield _FIRST + 1 + start, pairs[start : start + _BLOCK**2]

    def _beside_gains(self) -> Iterator[tuple[int, Any]]:
        """What makes most numbers right alone, with any other that was not tried with it."""
        first = _FIRST * _BLOCK
        for turn, gain in enumerate(self.known.gaining[:_GAINING]):
            if gain in self.sound:
                others = self.sound[self.sound != gain]
                others = others[first:] if gain < _BLOCK else others
                pairs = self._apart(np.array([gain]), others)
                pairs = pairs[~self._possible_of(pairs)]
                if len(pairs):
                    yield -1 - turn, pairs

    def _possible_of(self, pairs: Any) -> Any:
        """Which pairs may make the program right as far as can be foreseen."""
        return possible(*self._bits, *pairs.T)

    @cached_property
    def _bits(self) -> tuple[Any, Any, Any]:
        """As bits the numbers that each edit changes, those it makes wrong, and what is wrong."""
        moved, right = as_bits(~self.known.still), as_bits(self.known.right)
        return moved, moved & ~right, as_bits(self.known.wrong)

    def _blocks(self) -> Iterator[tuple[int, Any, Any]]:
        """Some edits and others, the likeliest first: of two slips one is mostly a likely one."""
        blocks = [self.sound[k : k + _BLOCK] for k in range(0, len(self.sound), _BLOCK)]
        each = range(len(blocks))
        ranked = sorted(((i + 1) * (j + 1), i, j) for i in each for j in each if i <= j)
        for rank, i, j in ranked:
            yield rank, blocks[i], blocks[j]

    def _apart(self, one: Any, other: Any) -> Any:
        """Each of some edits with each of others; within one another only the likeliest."""
        usable = ~self.within[np.ix_(one, other)]
        usable |= (one < _WITHIN)[:, None] & (other < _WITHIN)
        first, last = np.nonzero(np.triu(usable, 1) if one is other else usable)
        return np.stack([one[first], other[last]], axis=1)

    # -------- Three

    def _keep(self, chosen: Any, rows: Array) -> None:
        """What pairs do, for threes: of the likeliest all, of others one number."""
        self.chosen.append(chosen)
        self.marks.append(rows @ self.weights)
        few = np.flatnonzero((chosen < self.three).all(axis=1))
        one, other = chosen[few].T
        self.both[one, other] = self.both[other, one] = rows[few]

    def threes(self) -> list[Chosen]:
        """Any three edits that make the program right as far as their pairs tell, likeliest first.

        Of three, two act on one another and the third beside them; or one acts on both others; or
        each two do, and not all.
        """
        if not self.usable or not self.chosen:
            return []
        with np.errstate(all="ignore"):
            ways = (self._beside_pairs(), self._beside_one(), self._of_pairs())
            found = {three for way in ways for three in islice(way, _TRIED)}
        ranked = sorted(found, key=self.known.cost)
        right, _rows = self._right(np.array(ranked)) if ranked else ((), None)
        return [tuple(map(int, one)) for one in right]

    def any_three(self) -> list[Chosen]:
        """Any three of the likeliest edits that nothing speaks against, tried themselves."""
        if not self.usable:
            return []
        possible = self._possible()
        for threes in (possible, self._likeliest_threes(possible)):
            for some in self._lots(threes):
                right, _rows = self._right(some)
                if len(right):
                    return sorted((tuple(map(int, one)) for one in right), key=self.known.cost)
        return []

    def _likeliest_threes(self, possible: Any) -> Any:
        """Any three of the very likeliest: what is zero as it is may change with two of them."""
        few = self.sound[:_SOONEST]
        every = np.array([*combinations(range(len(few)), 3)], dtype=int).reshape(-1, 3)
        every = every[np.argsort((every + 1).prod(axis=1), kind="stable")]
        known = {*map(tuple, np.sort(possible, axis=1).tolist())}
        fresh = [k for k, one in enumerate(few[every].tolist()) if tuple(sorted(one)) not in known]
        return few[every[fresh]]

    def _possible(self) -> Any:
        """Threes of which each number that only one of them changes is made right by it.

        None may leave a wrong number as it is; the likeliest first.
        """
        few = self.sound[:_LIKELY]
        moved, spoilt, wrong = self._bits
        moved, spoilt, found = moved[few], spoilt[few], []
        ranks = np.arange(1, len(few) + 1)
        first, second = np.triu_indices(len(few), 1)
        within = self.within[np.ix_(few, few)]
        within[np.ix_(few < _WITHIN, few < _WITHIN)] = False
        apart = ~within[first, second]
        first, second = first[apart], second[apart]
        either = moved[first] | moved[second]
        spoilt_alone = (spoilt[first] & ~moved[second]) | (spoilt[second] & ~moved[first])
        for k in range(2, len(few)):
            ahead = (second < k) & (ranks[first] * ranks[second] * ranks[k] <= _PRODUCT)
            fits = ahead & (spoilt_alone & ~moved[k] == 0) & (wrong & ~(either | moved[k]) == 0)
            fits &= spoilt[k] & ~either == 0
            at = np.flatnonzero(fits)
            at = at[~(within[first[at], k] | within[second[at], k])]
            found.append(np.stack([first[at], second[at], np.full(len(at), k)], axis=1))
        every = np.concatenate(found) if found else np.empty((0, 3), dtype=int)
        # three of the likeliest, and two of these with any, in turn
        places = np.arange(len(every))
        turns = np.empty((2, len(every)), dtype=int)
        turns[0, np.argsort((every + 1).prod(axis=1), kind="stable")] = places
        turns[1, np.argsort(every.max(axis=1, initial=0), kind="stable")] = places
        return few[every[np.argsort(turns.min(axis=0), kind="stable")]]

    def _beside_pairs(self) -> Iterator[Chosen]:
        """A pair, and an edit whose effect adds up with the pair's."""
        chosen, marks = np.concatenate(self.chosen), np.concatenate(self.marks)
        order = np.argsort(marks, kind="stable")
        marks = marks[order]
        size = len(self.weights)
        sought = (self.known.goal[:size] - self.known.rows[self.sound, :size]) @ self.weights
        wide = self.known.near * float(self.weights.sum())
        low, high = np.searchsorted(marks, sought - wide), np.searchsorted(marks, sought + wide)
        for n in np.flatnonzero(high > low):
            for i, j in chosen[order[low[n] : high[n]]].tolist():
                k = int(self.sound[n])
                if k not in (i, j):
                    yield tuple(sorted((i, j, k)))

    def _beside_one(self) -> Iterator[Chosen]:
        """Two edits whose effects add up once a third stands, beside which both were tried."""
        size = len(self.weights)
        for first in self.sound[self.sound < self.three][:_BLOCK].tolist():
            others = np.flatnonzero(np.isfinite(self.both[first, :, 0]))
            alone = self.known.rows[first, :size]
            rows, goal = self.both[first, others] - alone, self.known.goal[:size] - alone
            for i, j in pairs_adding_up(rows, goal, self.known.near) if len(others) > 1 else ():
                yield tuple(sorted((first, int(others[i]), int(others[j]))))

    def _of_pairs(self) -> Iterator[Chosen]:
        """Three of the likeliest of which each two may act on one another."""
        few = self.sound[self.sound < self.three]
        size = len(self.weights)
        both, each = self.both[np.ix_(few, few)], self.known.rows[few, :size]
        goal = self.known.goal[:size]
        told = int(np.argmax(np.abs(goal)))
        left = goal[told] - (both[..., told] - each[:, None, told] - each[None, :, told])
        for n in range(2, len(few)):
            # what n does beside i, and beside j
            inner = both[n, :n, told]
            fits = left[:n, :n] - inner[:, None]
            fits -= inner
            fits += each[n, told]
            ends = np.argwhere(np.abs(fits, out=fits) <= self.known.near)
            ends = ends[ends[:, 0] < ends[:, 1]]
            whole = both[n, ends].sum(axis=1) + both[ends[:, 0], ends[:, 1]]
            whole -= each[ends].sum(axis=1) + each[n]
            for i, j in ends[(np.abs(whole - goal) <= self.known.near).all(axis=1)].tolist():
                yield tuple(int(few[k]) for k in (i, j, n))
