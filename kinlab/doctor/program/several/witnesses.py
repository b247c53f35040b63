"""What the statements of a program give while edits are tried: which are a textbook's.

In a recursion two slips multiply, and neither edit alone makes a number of the answer right. But
the angular velocity of a link, the axis of a joint, a force are right or wrong by themselves: an
edit with which a statement gives what a textbook has, where it did not before, is a first step.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from typing import Any

from kinlab.doctor.bytecode.syntax import called, copied, nodes
from kinlab.doctor.program.places import ProgramEdit, changed
from kinlab.doctor.program.search.recognised import QUANTITY, Recognised
from kinlab.doctor.program.search.repair import LineSearch
from kinlab.doctor.program.several.effects import Way
from kinlab.doctor.program.trial import FieldChange, NoProgramError
from kinlab.doctor.program.variants import Variants

_FIRST = 1
"""States at which statements are watched."""
_STATEMENT, _MANY = 0.04, 5
"""What each statement that it makes right speaks for an edit, and how many do."""
_FRUITLESS = 2
"""The part of the work after which no step is looked for where there is none yet."""


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


class Witnesses:
    """The statements of a wrong program, watched while edits are tried.

    Args:
        search: whose program is wrong.

    Attributes:
        done: operations that were.
    """

    def __init__(self, search: LineSearch) -> None:
        self.search = search
        self.done = 0
        self.known = Recognised(search.evidence)
        self.told: dict[int, Watched] = {}
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
        if not self.known.anything or not self.places:
            return []
        found: list[FirstStep] = []
        with trial.changed({*range(len(trial.trees))}, self._saws()):
            before = self._right()
            self.known.beside(self.search.observed.values(len(self.search.asked.watched)))
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
        if (good := self.known.rank(value)) is not None:
            told.good = good if told.good is None else min(good, told.good)
            told.fine += good == QUANTITY
        return value


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
