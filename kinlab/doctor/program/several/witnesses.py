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
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.glossary.textbook import Glossary
from kinlab.doctor.program.grounds.evidence import zeros_and_ones
from kinlab.doctor.program.places import ProgramEdit, called
from kinlab.doctor.program.repair import LineSearch
from kinlab.doctor.program.several.effects import Effects
from kinlab.doctor.program.trial import FieldChange, NoProgramError
from kinlab.doctor.program.variants import Variants

_FIRST = 1
"""States at which statements are watched."""
_GIVEN = ("q", "qd", "qdd", "positions", "velocities", "accelerations", "load")
"""What a program is given, and needs not find."""
_SHAPES = ((), (2,), (3,), (6,), (3, 3), (4, 4))
"""Shapes of most values."""
_STATEMENT, _MANY = 0.04, 5
"""What each statement that it makes right speaks for an edit, and how many do."""
_WEIGHTS = np.random.default_rng(5).uniform(0.5, 1.5, 16)


@dataclass(frozen=True)
class FirstStep:
    """An edit with which statements give what a textbook has.

    Attributes:
        edit: the edit.
        cost: how far-fetched it is, less what speaks for it.
    """

    edit: ProgramEdit
    cost: float


@dataclass
class Watched:
    """What is told of a statement.

    Attributes:
        count: how often it ran.
        good: whether all it gave is a textbook's; None where anything could be that.
    """

    count: int = 0
    good: bool | None = None


_NEVER = Watched()


class Witnesses:
    """The statements of a wrong program, watched while edits are tried.

    Args:
        search: whose program is wrong.
    """

    def __init__(self, search: LineSearch) -> None:
        self.search = search
        self.grounds = copy.copy(search.evidence)
        self.grounds.known = search.evidence.known[:_FIRST]
        self.known: dict[tuple[Any, bytes], bool | None] = {}
        self.told: dict[int, Watched] = {}
        self.marks = {shape: _marks(self.grounds.known, shape) for shape in _SHAPES}
        self.places = [place for tree in search.trial.trees for place in _places(tree)]

    def steps(self, known: Effects, most: int) -> list[FirstStep]:
        """The edits that make statements right and spoil none, as many as some work allows.

        The likeliest come first, those with which more is right as if they were likelier.
        """
        trial = self.search.trial
        if not self.grounds.known or not self.places:
            return []
        found: list[FirstStep] = []
        with trial.changed({*range(len(trial.trees))}, self._saws()):
            before = self._right()
            numbers = {(id(holder), field): n for n, (holder, field) in enumerate(self.places)}
            watched = [_watched(edits[0], numbers) for edits in known.alike]
            variants = Variants(trial, watched)
            for edits, edit in zip(known.alike, watched, strict=True):
                most -= self.cost_of(edit)
                if most < 0:
                    break
                try:
                    with trial.changed({edit.part}, edit.changes, variants.of(edit)):
                        after = self._right()
                except NoProgramError:
                    continue
                gained = min(_gained(before, after), _MANY)
                if gained:
                    cost = known.likely(edits[0]) - _STATEMENT * gained
                    found.append(FirstStep(edits[0], cost))
        return sorted(found, key=lambda step: step.cost)

    def cost_of(self, edit: ProgramEdit) -> int:
        """What watching the program with an edit amounts to."""
        own = len(self.search.first)
        return self.search.cost_of(edit) * _FIRST // own if own else 0

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
            for state in search.states[:_FIRST]:
                search.trial.function(*(x.copy() for x in state))
        except Exception:  # noqa: BLE001  what edited programs may raise
            return {}
        return self.told

    def _see(self, n: int, value: Any) -> Any:
        told = self.told.setdefault(n, Watched())
        told.count += 1
        if told.good is not False and (good := self._textbook(value)) is not None:
            told.good = good
        return value

    def _textbook(self, value: Any) -> bool | None:
        """Whether it is what a textbook has; None of numbers that anything could be."""
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

    def _looked_up(self, array: Array) -> bool | None:
        flat = array.ravel()
        if not np.isfinite(flat).all():
            return False
        if zeros_and_ones(flat):
            return None
        marks = self.marks.get(array.shape)
        if marks is not None:  # most are nothing known, which one number of each tells
            weights = _WEIGHTS[: flat.size]
            mark, wide = float(flat @ weights), 1e-6 * float(np.abs(flat) @ weights)
            k = bisect_left(marks, mark - wide)
            if k == len(marks) or marks[k] > mark + wide:
                return False
        sense = self.grounds.thing([array])
        return None if sense is not None and sense.what in _GIVEN else sense is not None


def _gained(before: dict[int, Watched], after: dict[int, Watched]) -> int:
    """How many statements an edit makes right; 0 where it spoils any."""
    gained = 0
    for n, now in after.items():
        old = before.get(n, _NEVER)
        if old.good is True and now.good is False:
            return 0
        gained += old.good is False and now.good is True and now.count >= old.count
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
    at = [numbers.get((id(c.holder), c.field)) for c in edit.changes]
    if all(n is None for n in at):
        return edit
    changes = [
        c if n is None or not isinstance(c.new, ast.expr) else replace(c, new=_saw(n, c.new))
        for c, n in zip(edit.changes, at, strict=True)
    ]
    return replace(edit, changes=tuple(changes))


def _saw(n: int, value: Any) -> ast.expr:
    """A value that is told of."""
    return ast.Call(ast.Name("_saw", ast.Load()), [ast.Constant(n), value], [])


def _places(tree: ast.AST) -> Iterator[tuple[Any, Any]]:
    """Where the values of statements hang: what is set, returned, or put into a list.

    Of what is given as a row of entries each entry is one.
    """
    for node in nodes(tree):
        if isinstance(node, ast.Assign | ast.Return) and isinstance(node.value, _COMPUTED):
            yield node, "value"
        elif isinstance(node, ast.Call) and called(node) == "append" and len(node.args) == 1:
            yield node.args, 0
        if isinstance(node, ast.List | ast.Tuple) and isinstance(node.ctx, ast.Load):
            yield from (
                (node.elts, k) for k, one in enumerate(node.elts) if isinstance(one, _COMPUTED)
            )


_COMPUTED = ast.BinOp | ast.UnaryOp | ast.Call | ast.Subscript | ast.ListComp
"""What a statement may give that is not somebody else's value under another name."""
