"""Slips of one part of an answer after another: at rest, without speeds, the last rows alone.

An answer has parts in which less of a program has a share: the torques at rest, the torques of
accelerations alone, the last row of a mass matrix, the rotation in a transform. Of several slips
few show in such a part, one or two, which are found there; beside them the others are looked for.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.derivations.parts import MOVING
from kinlab.doctor.program.places import changed
from kinlab.doctor.program.search.asked import Asked
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.doctor.program.several.effects import Effects, Way, as_bits, possible
from kinlab.doctor.program.several.rest import moving_alone
from kinlab.doctor.program.several.together import TriedTogether
from kinlab.doctor.program.trial import NoProgramError
from kinlab.errors import KinlabError

_STATES = 2
"""States of each part."""
_AT_ONCE, _PAIRS = 400, 6000
"""Edits, and pairs of them, that are run at a time."""
_DISTINCT = 700
"""Edits of different effects in a part of which any two are tried."""
_WAYS = 3
"""Ways to make a part right from which is gone on, where none makes the next right as well."""
_DEEPEST, _KEPT, _SIBLINGS = 3, 300, 30
"""Edits that may stand; ways that are kept; edits of one effect of which each is tried."""
_TRUSTED = 0.2
"""What it speaks for an edit that a search has gone on from it."""
_FEW = 400
"""Edits of which those that lanes cannot follow are run alone."""

Chosen = tuple[int, ...]
"""Edits by their numbers."""


@dataclass(frozen=True, eq=False)
class _Part:
    """A part of an answer.

    Attributes:
        asked: the program at states of its own.
        mask: which of the answer's numbers it is of.
    """

    asked: Asked
    mask: Any


class InStages:
    """The search for one slip after another in the parts of an answer.

    Args:
        search: whose program is wrong.
        known: what single edits do.
        together: the program in lanes with these.
        before: edits from which a search went on that found nothing: they are likelier.
        most: operations that may be done.

    Attributes:
        reached: edits with which some parts are right, where none were found for all.
    """

    def __init__(
        self,
        search: LineSearch,
        known: Effects,
        together: TriedTogether,
        before: Sequence[Way],
        most: int,
    ) -> None:
        self.search, self.known, self.together = search, known, together
        self.left, self.seen = most, dict[Any, Array]()
        trusted = {id(edit) for way in before for edit in way}
        likelier = [any(id(edit) in trusted for edit in alike) for alike in known.alike]
        self.costs = known.costs - _TRUSTED * np.array(likelier, dtype=float)
        usable = together.usable and most > 0
        self.parts = [*_parts(search)] if usable else []
        self.states = together.lanes.states if usable else []
        self.reached: list[Way] = []

    def ways(self, two: bool) -> list[Way]:
        """Edits with which all parts are right, and the whole, the likeliest first.

        Args:
            two: whether two of one part are looked for, where one does not do.
        """
        self.reached = []
        if not self.parts:
            return []
        lanes, work = self.together.lanes, self.together.lanes.work
        ways: list[Chosen] = [()]
        first: _Part | None = None
        try:
            for part in self.parts:
                more = self._with_part(part, ways, two)
                if not more:
                    begun = [] if ways == [()] else [*map(self._way, ways)][:_WAYS]
                    self.reached = self._alone(first or part)[:_WAYS] + begun
                    return []
                first = first or (part if more != [()] else None)
                ways = more
        finally:
            lanes.states = self.states
            self.search.work.done += lanes.work - work
        return [*map(self._way, ways)]

    def _way(self, chosen: Chosen) -> Way:
        return tuple(self.known.alike[k][0] for k in chosen)

    def _with_part(self, part: _Part, ways: list[Chosen], two: bool) -> list[Chosen]:
        """Ways that make one more part right: as they are, or with one or two edits more."""
        wide = max(map(len, ways))
        padded = np.array([way + (-1,) * (max(wide, 1) - len(way)) for way in ways])
        rows = self._rows(part, padded)
        if rows is None:
            return []
        right = [way for way, fits in zip(ways, self._right(rows), strict=True) if fits]
        if right:
            return right
        more = {
            (*stand, k)
            for stand in ways[:_WAYS]
            if len(stand) < _DEEPEST
            for k in self._singles(part, stand)
        }
        for stand in ways[:_WAYS] if two and not more else ():
            if len(stand) + 2 <= _DEEPEST:
                more |= {(*stand, *pair) for pair in self._pairs(part, stand)}
        return sorted(more, key=lambda way: float(self.costs[[*way]].sum()))[:_KEPT]

    def _singles(self, part: _Part, stand: Chosen) -> list[int]:
        """Single edits beside those that stand with which a part is right."""
        rows = self._each(part, stand)
        if rows is None:
            return []
        some = self.together.sound[self._right(rows)][:, None]
        return [int(k) for k in self._sure(part, stand, some)[:, 0]]

    def _alone(self, part: _Part) -> list[Way]:
        """Single edits that lanes cannot follow with which a part is right, the likeliest first."""
        found: list[Way] = []
        unfollowed = set(range(min(_FEW, len(self.costs)))) - {*map(int, self.together.sound)}
        for k in sorted(unfollowed):
            way = self._way((k,))
            self.left -= self.search.work.of(way[0])
            try:
                with changed(self.search.trial, way):
                    values = part.asked.values(part.asked.first)
            except NoProgramError:
                continue
            if values is not None and self._right(self._gaps(part, values[None])).all():
                found.append(way)
        return found

    def _sure(self, part: _Part, stand: Chosen, some: Any) -> Any:
        """Those of some edits, (C, E), with which a part is right at all its states."""
        rows = self._rows(part, _beside(stand, some)) if len(some) else None
        return some[:0] if rows is None else some[self._right(rows)]

    def _each(self, part: _Part, stand: Chosen) -> Array | None:
        """What is missing in a part at its first state with each edit beside those that stand."""
        key = self.parts.index(part), stand
        if key not in self.seen:
            found: list[Array] = []
            for start in range(0, len(self.together.sound), _AT_ONCE):
                some = self.together.sound[start : start + _AT_ONCE]
                rows = self._rows(part, _beside(stand, some), 1)
                if rows is None:
                    return None
                found.append(rows)
            self.seen[key] = np.concatenate(found)
        return self.seen[key]

    def _pairs(self, part: _Part, stand: Chosen) -> list[Chosen]:
        """Two edits beside those that stand with which a part is right.

        Of edits with one effect on it one is tried, and the others once it is one of two.
        """
        sound = self.together.sound
        own = self._rows(part, np.array([stand or (-1,)]), 1)
        each = self._each(part, stand)
        if own is None or each is None:
            return []
        alike: dict[bytes, list[int]] = {}
        effects = np.round(each - own[0], 7) + 0.0
        for k in np.flatnonzero(np.isfinite(effects).all(axis=1) & effects.any(axis=1)):
            alike.setdefault(effects[k].tobytes(), []).append(int(sound[k]))
        groups = [*alike.values()][:_DISTINCT]
        if len(groups) < 2:
            return []
        firsts = np.array([group[0] for group in groups])
        of = {group[0]: sorted(group, key=lambda k: float(self.costs[k])) for group in groups}
        pairs = self._possible(firsts, each[np.searchsorted(sound, firsts)], own[0])
        found: list[Chosen] = []
        for start in range(0, len(pairs), _PAIRS):
            some = pairs[start : start + _PAIRS]
            values = self._rows(part, _beside(stand, some), 1)
            if values is None or self.left <= 0:
                break
            for i, j in some[self._right(values)][:_WAYS].tolist():
                both = np.array([*product(of[i][:_SIBLINGS], of[j][:_SIBLINGS])])
                found += [(int(one), int(other)) for one, other in self._sure(part, stand, both)]
            if found:
                break
        return found

    def _possible(self, numbers: Any, rows: Array, own: Array) -> Any:
        """Pairs that may make a part right as far as can be foreseen, the likeliest first."""
        near = self.known.near
        moved, right = as_bits(np.abs(rows - own) > near), as_bits(np.abs(rows) <= near)
        one, other = np.triu_indices(len(numbers), 1)
        fits = possible(moved, moved & ~right, as_bits(np.abs(own) > near), one, other)
        fits &= ~self.together.within[np.ix_(numbers, numbers)][one, other]
        order = np.argsort(((one + 1) * (other + 1))[fits], kind="stable")
        return np.column_stack([numbers[one[fits][order]], numbers[other[fits][order]]])

    def _rows(self, part: _Part, chosen: Any, count: int | None = None) -> Array | None:
        """What is missing in a part with some edits, relative to its size, (C, P)."""
        lanes = self.together.lanes
        lanes.states = part.asked.states_at(part.asked.first)
        before = lanes.work
        found = lanes.answers(chosen, count, max(self.left, 1))
        self.left -= lanes.work - before
        values = None if found is None else part.asked.of_lanes(found)
        if values is None:
            return None
        return self._gaps(part, values)

    @staticmethod
    def _gaps(part: _Part, values: Array) -> Array:
        """What is missing in answers, (C, S, ...)."""
        wanted = part.asked.wanted[part.asked.first][: values.shape[1]]
        gap = (values - wanted) / part.asked.scale[: values.shape[1]]
        return np.asarray(gap[:, :, part.mask].reshape(len(values), -1))

    def _right(self, rows: Array) -> Any:
        """Which rows have nothing missing."""
        return (np.abs(rows) <= self.known.near).all(axis=1)


def _beside(stand: Chosen, some: Any) -> Any:
    """Edits, or several at a time, (C,) or (C, E), each with those that stand."""
    standing = np.broadcast_to(np.array(stand, dtype=int), (len(some), len(stand)))
    return np.column_stack([standing, some])


def _parts(search: LineSearch) -> Iterator[_Part]:
    """The parts of what is asked, those first in which least of a program has a share."""
    case, asked = search.case, search.asked
    if case.quantity.read is not None:
        return
    few = {name: stack[:_STATES] for name, stack in case.arguments.items()}
    moving = [name for name in few if name in MOVING]
    shape = asked.wanted.shape[1:]
    whole = np.ones(shape, dtype=bool)
    for stacks in _silent(few, moving):
        there = replace(case, arguments=stacks)
        try:
            with np.errstate(all="ignore"):
                wanted = np.asarray(there.answer(()), dtype=float)
        except (KinlabError, np.linalg.LinAlgError, ValueError):
            return
        if np.isfinite(wanted).all() and wanted.any():
            yield _Part(asked.at(there, wanted), whole)
    if not moving:
        there = replace(case, arguments=few)
        part = asked.at(there, asked.wanted[:_STATES])
        for mask in _masks(case.quantity.name, shape, getattr(case.robot, "n", 0)):
            yield _Part(part, mask)
    yield _Part(asked, whole)


def _silent(few: dict[str, Array], moving: list[str]) -> Iterator[dict[str, Array]]:
    """States at which some of the arguments are zero."""
    if not moving:
        return
    if moving == ["wrench"]:
        force = np.array(few["wrench"])
        force[:, :3] = 0.0
        yield {**few, "wrench": force}
        return
    if moving == ["v"]:
        for count in range(1, few["v"].shape[1]):
            last = np.array(few["v"])
            last[:, :-count] = 0.0
            yield {**few, "v": last}
        return
    slow = [name for name in moving if name != "v"]
    groups = [[], *([name] for name in slow), *([slow] if len(slow) > 1 else [])]
    if "v" not in moving:
        groups = groups[:-1]
    for group in groups:
        yield moving_alone(few, group)


def _masks(quantity: str, shape: tuple[int, ...], joints: int) -> Iterator[Any]:
    """Which numbers of an answer are a part of it."""
    every = np.zeros(shape, dtype=bool)
    if shape == (4, 4):
        every[:3, :3] = True
        yield every
    elif shape[:1] == (6,) and "jacobian" in quantity:
        every[3:] = True
        yield every
    elif shape == (joints, joints):
        for count in range(1, joints):
            block = every.copy()
            block[-count:, -count:] = True
            yield block
    elif shape == (joints,):
        for count in range(1, joints):
            last = every.copy()
            last[-count:] = True
            yield last
