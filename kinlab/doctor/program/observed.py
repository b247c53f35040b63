"""What every expression of a program was when it ran: its values, their shapes."""

from __future__ import annotations

import ast
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from types import FrameType
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import copied, located, nodes
from kinlab.doctor.program.trial import FieldChange, Trial, quietly
from kinlab.tolerances import TOLERANCES

_KEPT = 64
"""Values of one expression that are kept."""
_OF_ARRAYS = 60
"""What an operation of arrays amounts to, beside one of numbers."""
_CALL = 3
"""What a call amounts to, those that a call of numpy makes among them."""
_OWN_CALL = 200
"""What a call of an own function amounts to, whose answer may be known: it is looked up."""

Shape = tuple[int, ...]


@dataclass
class Seen:
    """What one expression was.

    Attributes:
        count: how often it was evaluated.
        values: the first of its values, where they are real numbers.
        whole: whether all of them are whole numbers, as an index is.
        shape: of all of them; None where they are no numbers, or change their shape.
        entries: of a list that grows, the shape of its entries.
    """

    count: int = 0
    values: list[Array] = field(default_factory=list)
    whole: bool = True
    shape: Shape | None = None
    entries: Shape | None = None

    @property
    def only(self) -> float | None:
        """The one number that it was; None where it was several, or none."""
        if self.shape != () or len({*map(float, self.values)}) != 1:
            return None
        return float(self.values[0])

    @property
    def nothing(self) -> bool:
        """Whether it was zero, or zeros, but for rounding, whenever it was seen."""
        floor = TOLERANCES.rounding_leaves
        return bool(self.values) and all(np.all(np.abs(x) <= floor) for x in self.values)


class Observed:
    """The expressions of a program by their nodes in the trees of a trial.

    Attributes:
        given: the shapes of its arguments.
    """

    def __init__(self, trial: Trial, states: Sequence[tuple[Any, ...]]) -> None:
        self._seen: dict[int, Seen] = {}
        given = [_numbers(one) for one in states[0]] if states else []
        self.given = [None if one is None else one.shape for one in given]
        parts = trial.program.parts
        originals = [trial.placed(k) for k in range(len(parts))]
        self._by_number = [dict(enumerate(nodes(tree))) for tree in trial.trees]
        trial.space["_see"] = self._see
        try:
            for k, tree in enumerate(trial.trees):
                trial.place(k, trial.made(_watched(tree, k), k))
            with quietly(), trial.as_loaded():
                for state in states:
                    trial.load()
                    trial.function(*state)
        finally:
            for k, function in enumerate(originals):
                trial.place(k, function)

    def of(self, node: ast.AST) -> Seen | None:
        """What a node of a trial's trees was; None where it was never evaluated."""
        return self._seen.get(id(node))

    def shape(self, node: ast.AST) -> Shape | None:
        """The shape of a node's values; None where they are no numbers."""
        seen = self._seen.get(id(node))
        return None if seen is None else seen.shape

    def numbers(self, states: int) -> Array:
        """All the numbers at the first of so many states, sorted."""
        found = [
            np.ravel(value).astype(float)
            for seen in self._seen.values()
            for value in seen.values[: -(-seen.count // states)]
        ]
        return np.unique(np.concatenate([*found, np.empty(0)]))

    def values(self, states: int) -> dict[Shape, Array]:
        """All values at the first of so many states, by their shape, each as a row."""
        found: dict[Shape, list[Array]] = {}
        for seen in self._seen.values():
            for value in seen.values[: -(-seen.count // states)]:
                found.setdefault(value.shape, []).append(np.ravel(value).astype(float))
        return {shape: np.stack(rows) for shape, rows in found.items()}

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
        if len(seen.values) < _KEPT and numbers.dtype.kind != "c":
            seen.values.append(numbers.copy())
        return value


def amounts(trial: Trial, observed: Observed, states: Sequence[tuple[Any, ...]]) -> dict[int, int]:
    """What running at all the states what depends on a part amounts to, by its number.

    Args:
        trial: a program in which no edit stands.
        observed: its expressions at these states.
        states: one tuple of arguments for each.
    """
    own = _calls(trial, states)
    for k, tree in enumerate(trial.trees):
        own[k] += sum(_amount(observed.of(node), node) for node in nodes(tree))
    return {k: sum(own[j] for j in above) for k, above in trial.above.items()}


def _amount(seen: Seen | None, node: ast.AST) -> int:
    """What evaluating an expression as often as it was amounts to."""
    if seen is None:
        return 0
    arrays = isinstance(node, ast.BinOp) and seen.shape != ()
    return seen.count * (_OF_ARRAYS if arrays else 1)


def _calls(trial: Trial, states: Sequence[tuple[Any, ...]]) -> list[int]:
    """What the calls that each part makes amount to: they are counted while it runs."""
    codes = {trial.placed(k).__code__: k for k in range(len(trial.trees))}
    found, running = [0] * len(trial.trees), [0]

    def count(frame: FrameType, event: str, _argument: Any) -> None:
        if event in ("call", "c_call"):
            part = codes.get(frame.f_code) if event == "call" else None
            found[running[-1]] += _CALL if part is None else _OWN_CALL
            if part is not None:
                running.append(part)
        elif event == "return" and frame.f_code in codes and len(running) > 1:
            running.pop()

    def run() -> None:
        sys.setprofile(count)  # of this thread alone: whoever measures the program's keeps his
        with quietly(), trial.as_loaded():
            for state in states:
                trial.load()
                trial.function(*state)

    with ThreadPoolExecutor(1) as beside:
        beside.submit(run).result()
    return found


def _numbers(value: Any) -> Array | None:
    if isinstance(value, bool | str) or value is None:
        return None
    if isinstance(value, int | float | complex | np.number | list | tuple):
        try:
            value = np.asarray(value)
        except ValueError:
            return None
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiuc":
        return np.asarray(value)  # of a matrix, which has rules of its own, its numbers
    return None


def _watched(tree: ast.FunctionDef, part: int) -> ast.FunctionDef:
    """A copy in which every expression tells its value."""
    own = copied(tree)
    numbers = {id(node): number for number, node in enumerate(nodes(own))}
    kept = {id(x) for node in nodes(own) if isinstance(node, ast.pattern) for x in nodes(node)}
    for parent in [node for node in nodes(own) if id(node) not in kept]:
        for name, value in ast.iter_fields(parent):
            holder, keys = (
                (value, range(len(value))) if isinstance(value, list) else (parent, [name])
            )
            for key in keys:
                change = FieldChange(holder, key, None)
                node = change.now
                if isinstance(node, ast.expr) and _watchable(parent, name, node):
                    where: list[ast.expr] = [ast.Constant(part), ast.Constant(numbers[id(node)])]
                    change.put(ast.Call(ast.Name("_see", ast.Load()), [*where, node], []))
    return located(own)


def _watchable(parent: ast.AST, name: str, node: ast.expr) -> bool:
    if isinstance(getattr(node, "ctx", None), ast.Store | ast.Del):
        return False
    if isinstance(node, ast.Slice | ast.Starred | ast.JoinedStr | ast.FormattedValue | ast.Lambda):
        return False
    if isinstance(parent, ast.Call) and name == "func":
        return False
    if isinstance(parent, ast.Subscript) and name == "slice" and isinstance(node, ast.Tuple):
        return False
    if isinstance(parent, ast.JoinedStr | ast.FormattedValue | ast.arg):
        return False
    return not (isinstance(node, ast.Constant) and isinstance(node.value, str))
