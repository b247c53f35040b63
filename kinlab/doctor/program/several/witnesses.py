"""What the statements of a program give while edits are tried: which are a textbook's.

In a recursion two slips multiply, and neither edit alone makes a number of the answer right. But
the angular velocity of a link, the axis of a joint, a force are right or wrong by themselves: an
edit with which a statement gives what a textbook has, where it did not before, is a first step.
"""

from __future__ import annotations

import ast
import copy
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, copied, nodes
from kinlab.doctor.glossary.textbook import Glossary
from kinlab.doctor.program.grounds.evidence import zeros_and_ones
from kinlab.doctor.program.grounds.suspects import TERM
from kinlab.doctor.program.places import ProgramEdit, changed
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.doctor.program.several.effects import Way
from kinlab.doctor.program.trial import FieldChange, NoProgramError
from kinlab.doctor.program.variants import Variants
from kinlab.tolerances import TOLERANCES

_FIRST = 1
"""States at which statements are watched."""
_GIVEN = ("q", "qd", "qdd", "positions", "velocities", "accelerations", "load")
"""What a program is given, and needs not find."""
_SHAPES = ((), (2,), (3,), (6,), (3, 3), (4, 4), (6, 6))
"""Shapes of most values."""
_STATEMENT, _MANY = 0.04, 5
"""What each statement that it makes right speaks for an edit, and how many do."""
_FRUITLESS = 2
"""The part of the work after which no step is looked for where there is none yet."""
_WEIGHTS = np.random.default_rng(5).uniform(0.5, 1.5, 36)


@dataclass(frozen=True)
class FirstStep:
    """Edits with which statements give what a textbook has.

    Attributes:
        edits: one, or two where neither does alone.
        cost: how far-fetched they are, less what speaks for them.
        whole: whether a statement is right each time that it runs, not some times more alone.
    """

    edits: tuple[ProgramEdit, ...]
    cost: float
    whole: bool = True


@dataclass
class Watched:
    """What is told of a statement.

    Attributes:
        count: how often it ran.
        good: what all that it gave is: 2 of a textbook's quantities, 1 some terms of these as well,
            0 nothing known; None where anything could be that.
        fine: how often it was one of a textbook's quantities.
    """

    count: int = 0
    good: int | None = None
    fine: int = 0


_NEVER = Watched()
_QUANTITY = 2
"""What is a textbook's, and no term alone."""


class Witnesses:
    """The statements of a wrong program, watched while edits are tried.

    Args:
        search: whose program is wrong.

    Attributes:
        done: operations that were.
    """

    def __init__(self, search: LineSearch) -> None:
        self.search = search
        self.done, self.watching = 0, False
        self.grounds = copy.copy(search.evidence)
        self.grounds.known = search.evidence.known[:_FIRST]
        self.known: dict[tuple[Any, bytes], int | None] = {}
        every = (
            row for one in self.grounds.known for rows, _ in one.things.values() for row in rows
        )
        ranks = sorted(every, key=lambda row: -row[0])
        self.terms = {what for what, rank in {x.what: k for k, x in ranks}.items() if rank >= TERM}
        self.told: dict[int, Watched] = {}
        self.marks = {shape: _marks(self.grounds.known, shape) for shape in _SHAPES}
        self.there = search.observed.values(len(search.asked.watched))
        self.places = [place for tree in search.trial.trees for place in _places(tree)]
        self.numbers = {(id(holder), field): n for n, (holder, field) in enumerate(self.places)}
        self.inside = _inside(self.places)

    def steps(self, ways: Sequence[Way], most: int) -> list[FirstStep]:
        """Those that make statements right and spoil none, as many as some work allows.

        The likeliest come first, those with which more is right as if they were likelier.

        Args:
            ways: an edit each, or two.
            most: operations that may be done.
        """
        trial = self.search.trial
        if not self.grounds.known or not self.places:
            return []
        found: list[FirstStep] = []
        with trial.changed({*range(len(trial.trees))}, self._saws()):
            before = self._right()
            self.known, self.watching = {}, True
            watched = [tuple(_watched(edit, self.numbers) for edit in way) for way in ways]
            variants = Variants(trial, [way[0] for way in watched if len(way) == 1])
            for way, own in zip(ways, watched, strict=True):
                self.done += sum(map(self.cost_of, way))
                if self.done > (most if found else most // _FRUITLESS):
                    break
                try:
                    with self._standing(own, variants):
                        after = self._right()
                except NoProgramError:
                    continue
                gained = min(_gained(before, after, self.inside), _MANY)
                some = 0 if gained else min(_gained_sometimes(before, after), _MANY)
                if gained or some:
                    cost = sum(map(self.search.likely, way)) - _STATEMENT * (gained + some)
                    found.append(FirstStep(way, cost, bool(gained)))
        return sorted(found, key=lambda step: (not step.whole, step.cost))

    def _standing(self, way: Way, variants: Variants) -> AbstractContextManager[None]:
        if len(way) > 1:
            return changed(self.search.trial, way)
        (one,) = way
        return self.search.trial.changed({one.part}, one.changes, variants.of(one))

    def cost_of(self, edit: ProgramEdit) -> int:
        """What watching the program with an edit amounts to."""
        own = len(self.search.asked.first)
        return self.search.work.of(edit) * _FIRST // own if own else 0

    def _saws(self) -> list[FieldChange]:
        return [
            FieldChange(holder, field, _saw(n, FieldChange(holder, field, None).now))
            for n, (holder, field) in enumerate(self.places)
        ]

    def _right(self) -> dict[int, Watched]:
        """What is told of each statement that ran."""
        search, self.told = self.search, {}
        search.trial.space["_saw"] = self._see
        try:
            for state in search.asked.states[:_FIRST]:
                search.trial.function(*(x.copy() for x in state))
        except Exception:  # noqa: BLE001  what edited programs may raise
            return {}
        return self.told

    def _see(self, n: int, value: Any) -> Any:
        told = self.told.setdefault(n, Watched())
        told.count += 1
        if (good := self._textbook(value)) is not None:
            told.good = good if told.good is None else min(good, told.good)
            told.fine += good == _QUANTITY
        return value

    def _textbook(self, value: Any) -> int | None:
        """Whether it is what a textbook has, or a term; None of numbers that anything could be."""
        if isinstance(value, list | tuple):
            try:
                value = np.array(value, dtype=float)
            except (ValueError, TypeError):
                return None
        array = np.asarray(value)
        if array.dtype != float or not array.size:
            return None
        key = (array.shape, array.tobytes())
        if key not in self.known:
            self.known[key] = self._looked_up(array)
        return self.known[key]

    def _looked_up(self, array: Array) -> int | None:
        flat = array.ravel()
        if not np.isfinite(flat).all():
            return 0
        if zeros_and_ones(flat):
            return None
        marks = self.marks.get(array.shape)
        if marks is not None:  # most are nothing known, which one number of each tells
            weights, near = _WEIGHTS[: flat.size], self.grounds.near
            mark, wide = float(flat @ weights), 10 * near * float(np.abs(flat) @ weights)
            k = bisect_left(marks, mark - wide)
            if k == len(marks) or marks[k] > mark + wide:
                return 0
        if self.watching and self._is_there(array):
            return None  # another's value, which what was left out leaves
        sense = self.grounds.thing([array])
        if sense is None:
            return 0
        return None if sense.what in _GIVEN else 1 if sense.what in self.terms else 2

    def _is_there(self, value: Array) -> bool:
        """Whether an expression had a value before there was an edit."""
        near = TOLERANCES.same_relation * float(np.abs(value).max())
        some = self.there.get(value.shape)
        return some is not None and bool((np.abs(some - value.ravel()).max(axis=1) <= near).any())


def _gained(before: dict[int, Watched], after: dict[int, Watched], inside: dict[int, int]) -> int:
    """How many statements an edit makes right; 0 where it spoils any.

    An entry of a row that was right by accident is not spoiled where the whole becomes right.
    """
    gained = {n for n, now in after.items() if _is_gained(before.get(n, _NEVER), now)}
    for n, now in after.items():
        if before.get(n, _NEVER).good and now.good == 0 and inside.get(n) not in gained:
            return 0
    return len(gained)


def _is_gained(old: Watched, now: Watched) -> bool:
    return (now.good or 0) > (old.good or 0) and now.count >= old.count > 0


def _inside(places: Sequence[tuple[Any, Any]]) -> dict[int, int]:
    """In which statement the entries of rows are, by their numbers."""
    lists = {
        id(one): n
        for n, (holder, _field) in enumerate(places)
        if isinstance(holder, ast.Assign | ast.Return) and holder.value is not None
        for node in nodes(holder.value)
        if isinstance(node, ast.List | ast.Tuple)
        for one in [node.elts]
    }
    return {
        n: lists[id(holder)] for n, (holder, _field) in enumerate(places) if id(holder) in lists
    }


def _gained_sometimes(before: dict[int, Watched], after: dict[int, Watched]) -> int:
    """How many times more statements are right with an edit; 0 where any is right less often."""
    gained = 0
    for n, now in after.items():
        old = before.get(n, _NEVER)
        if (old.good and now.good == 0) or now.fine < old.fine or now.count != old.count:
            return 0
        gained += now.fine - old.fine
    return gained


def _marks(known: Sequence[Glossary], shape: tuple[int, ...]) -> list[float]:
    """One number of each thing of a shape, sorted; of plane vectors, too, what is left of them."""
    if not known:
        return []
    size = int(np.prod(shape, initial=1))
    _rows, things = known[0].things.get(shape, ((), np.empty((0, size))))
    found = [*(things.reshape(len(things), size) @ _WEIGHTS[:size])]
    if known[0].plane and shape in ((), (2,)):
        _rows, vectors = known[0].things.get((3,), ((), np.empty((0, 3))))
        found += [*(vectors[:, 2:] if shape == () else vectors[:, :2]) @ _WEIGHTS[:size]]
    return sorted(map(float, found))


def _watched(edit: ProgramEdit, numbers: dict[tuple[int, Any], int]) -> ProgramEdit:
    """An edit where the values that it sets are watched, too."""
    changes = tuple(_change(c, edit.node, numbers) for c in edit.changes)
    return edit if changes == edit.changes else replace(edit, changes=changes)


def _change(change: FieldChange, node: Any, numbers: dict[tuple[int, Any], int]) -> FieldChange:
    n, new = numbers.get((id(change.holder), change.field)), change.new
    if n is not None and isinstance(new, ast.expr):
        return replace(change, new=_saw(n, new))
    n = numbers.get((id(node), "value"))
    if n is not None and isinstance(node, ast.Assign) and isinstance(new, ast.AugAssign):
        load = copied(new.target)
        load.ctx = ast.Load()
        whole = _saw(n, ast.BinOp(load, new.op, node.value))
        return replace(change, new=ast.Assign([new.target], whole))
    return change


def _saw(n: int, value: Any) -> ast.expr:
    """A value that is told of."""
    return ast.Call(ast.Name("_saw", ast.Load()), [ast.Constant(n), value], [])


def _places(tree: ast.AST) -> Iterator[tuple[Any, Any]]:
    """Where the values of statements hang: what is set, returned, or put into a list.

    Of what is given as a row of entries each entry is one.
    """
    for node in nodes(tree):
        alone = isinstance(node, ast.Assign) and isinstance(node.value, ast.Name)
        if alone or (
            isinstance(node, ast.Assign | ast.Return) and isinstance(node.value, _COMPUTED)
        ):
            yield node, "value"
        elif isinstance(node, ast.Call) and called(node) == "append" and len(node.args) == 1:
            yield node.args, 0
        if isinstance(node, ast.List | ast.Tuple) and isinstance(node.ctx, ast.Load):
            yield from (
                (node.elts, k) for k, one in enumerate(node.elts) if isinstance(one, _COMPUTED)
            )


_COMPUTED = ast.BinOp | ast.UnaryOp | ast.Call | ast.Subscript | ast.ListComp
"""What a statement may give that is not somebody else's value under another name."""
