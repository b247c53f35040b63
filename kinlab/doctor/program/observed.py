"""What every expression of a program was when it ran: its values, their shapes."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.program.trial import Trial, made, quietly

_KEPT = 64
"""Values of one expression that are kept."""

Shape = tuple[int, ...]


@dataclass
class Seen:
    """What one expression was.

    Attributes:
        count: how often it was evaluated.
        values: the first of its values, where they are numbers.
        whole: whether all of them are whole numbers, as an index is.
        shape: of all of them; None where they are no numbers, or change their shape.
        entries: of a list that grows, the shape of its entries.
    """

    count: int = 0
    values: list[Array] = field(default_factory=list)
    whole: bool = True
    shape: Shape | None = None
    entries: Shape | None = None


class Observed:
    """The expressions of a program by their nodes in the trees of a trial."""

    def __init__(self, trial: Trial, states: Sequence[tuple[Any, ...]]) -> None:
        self._seen: dict[int, Seen] = {}
        self.places: dict[str, tuple[int, ...]] = {}
        nodes = [_watched(tree) for tree in trial.trees]
        parts = trial.program.parts
        originals = [trial.placed(k) for k in range(len(parts))]
        self._by_number = [dict(enumerate(ast.walk(tree))) for tree in trial.trees]
        trial.space["_see"] = self._see
        self.work: dict[int, int] = {}
        """Expressions evaluated at all the states by what depends on a part, by its number."""
        try:
            for k, (tree, part) in enumerate(zip(nodes, parts, strict=True)):
                self._name_part(tree, k)
                trial.place(k, made(tree, part, trial.space))
            with quietly():
                for state in states:
                    trial.function(*state)
        finally:
            for k, function in enumerate(originals):
                trial.place(k, function)
        own = [
            sum(self._seen[id(node)].count for node in ast.walk(tree) if id(node) in self._seen)
            for tree in trial.trees
        ]
        self.work = {k: sum(own[j] for j in trial.above[k]) for k in trial.above}

    @staticmethod
    def _name_part(tree: ast.AST, k: int) -> None:
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "_see":
                node.args[0] = ast.copy_location(ast.Constant(k), node.args[0])

    def of(self, node: ast.AST) -> Seen | None:
        """What a node of a trial's trees was; None where it was never evaluated."""
        return self._seen.get(id(node))

    def shape(self, node: ast.AST) -> Shape | None:
        """The shape of a node's values; None where they are no numbers."""
        seen = self._seen.get(id(node))
        return None if seen is None else seen.shape

    def _see(self, k: int, number: int, value: Any) -> Any:
        node = self._by_number[k][number]
        seen = self._seen.setdefault(id(node), Seen())
        seen.count += 1
        numbers = _numbers(value) if seen.count == 1 or seen.shape is not None else None
        if isinstance(value, list) and value and (one := _numbers(value[0])) is not None:
            seen.entries = one.shape
        if numbers is None or (seen.count > 1 and numbers.shape != seen.shape):
            seen.shape = None
            return value
        seen.shape = numbers.shape
        seen.whole = seen.whole and numbers.dtype.kind in "iu"
        if len(seen.values) < _KEPT:
            seen.values.append(numbers.copy())
        return value


def _numbers(value: Any) -> Array | None:
    if isinstance(value, bool | str) or value is None:
        return None
    if isinstance(value, int | float | np.number):
        return np.asarray(value)
    if isinstance(value, list | tuple):
        try:
            value = np.asarray(value)
        except ValueError:
            return None
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiu":
        return value
    return None


def _watched(tree: ast.FunctionDef) -> ast.FunctionDef:
    """A copy in which every expression tells its value."""
    own = copy.deepcopy(tree)
    numbers = {id(node): number for number, node in enumerate(ast.walk(own))}
    for parent in list(ast.walk(own)):
        for holder, place, node in _expressions(parent):
            told = ast.Call(
                ast.Name("_see", ast.Load()),
                [ast.Constant(0), ast.Constant(numbers[id(node)]), node],
                [],
            )
            holder[place] = told
        for name, value in ast.iter_fields(parent):
            node = value
            if isinstance(node, ast.expr) and _watchable(parent, name, node):
                told = ast.Call(
                    ast.Name("_see", ast.Load()),
                    [ast.Constant(0), ast.Constant(numbers[id(node)]), node],
                    [],
                )
                setattr(parent, name, told)
    return ast.fix_missing_locations(own)


def _expressions(parent: ast.AST) -> Iterator[tuple[list[Any], int, ast.expr]]:
    for name, value in ast.iter_fields(parent):
        if isinstance(value, list):
            for place, node in enumerate(value):
                if isinstance(node, ast.expr) and _watchable(parent, name, node):
                    yield value, place, node


def _watchable(parent: ast.AST, name: str, node: ast.expr) -> bool:
    if isinstance(getattr(node, "ctx", None), ast.Store | ast.Del):
        return False
    if isinstance(node, ast.Slice | ast.Starred | ast.JoinedStr | ast.FormattedValue | ast.Lambda):
        return False
    if isinstance(parent, ast.Call) and name == "func":
        return False
    if isinstance(parent, ast.Subscript) and name == "slice" and isinstance(node, ast.Tuple):
        return False
    if isinstance(parent, ast.JoinedStr | ast.FormattedValue | ast.arguments | ast.arg):
        return False
    return not (isinstance(node, ast.Constant) and isinstance(node.value, str))
