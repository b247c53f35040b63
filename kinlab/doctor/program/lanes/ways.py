"""Loops that turn more or less often, and conditions that are others, for some lanes.

The body of such a loop runs once for the lanes of each edit, and then for those without. Whatever
it sets stays, in the other lanes, what it was.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.program.lanes.numbers import Laned, LaneGroup, Lanes, is_number
from kinlab.doctor.program.own.plain import made_like

_BODY = ast.Assign | ast.AugAssign | ast.If | ast.For | ast.Pass
"""Statements that may run for some lanes alone."""
_LOST = ast.Yield | ast.YieldFrom | ast.NamedExpr | ast.Lambda
WRITES = ("append", "extend", "insert", "pop", "update", "add", "remove", "setdefault", "clear")
"""Calls that change what they are called on, for all lanes."""


def may_run_apart(statement: ast.AST) -> bool:
    """Whether a loop, or a condition, may run for some lanes alone."""
    if not isinstance(statement, ast.For | ast.If):
        return False
    for node in nodes(statement):
        if isinstance(node, ast.stmt) and not isinstance(node, _BODY):
            return False
        if isinstance(node, ast.AugAssign) and not isinstance(node.op, ast.Add | ast.Sub):
            return False
        if isinstance(node, _LOST):
            return False
        if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in WRITES:
            return False
    return True


def apart(statement: Any, value: ast.expr) -> ast.expr:
    """What a statement sets, where it may run for some lanes alone."""
    given: list[ast.expr] = [function_of(value)]
    if isinstance(statement, ast.Assign):
        given.append(function_of(loaded(statement.targets[0])))
    return ast.Call(ast.Name("_kept", ast.Load()), given, [])


def loaded(target: ast.expr) -> ast.expr:
    """What is set, to be read."""
    return ast.parse(ast.unparse(target), mode="eval").body


def function_of(body: ast.expr, names: tuple[str, ...] = ()) -> ast.Lambda:
    """A function that gives an expression."""
    given = [ast.arg(name) for name in names]
    return ast.Lambda(ast.arguments([], given, None, [], [], None, []), body)


class Ways:
    """The ways that lanes take through a program.

    Args:
        lanes: all of them.
    """

    def __init__(self, lanes: Lanes) -> None:
        self.lanes = lanes
        self.only: LaneGroup | None = None

    def turns(
        self,
        edits: Sequence[int],
        old: Callable[[], Any],
        new: Callable[[int], Any],
        counter: Callable[[], Any],
    ) -> Iterator[Any]:
        """What a loop runs over: in the lanes of each edit, and in all others.

        Where it does not turn for these, its counter is afterwards what it was.
        """
        outer = self.only
        try:
            before = [counter()]
        except NameError:
            before = []
        only, last = outer, before
        for given in self._each(edits, old, new):
            values = [*given]
            yield from values
            only, last = self.only, values
        if before and not last and only is not outer:
            self.only = LaneGroup(None, np.empty(0, dtype=int))
            yield before[0]
            self.only = outer

    def sides(
        self, edits: Sequence[int], old: Callable[[], Any], new: Callable[[int], Any]
    ) -> Iterator[bool]:
        """Whether a condition holds: in the lanes of each edit, and in all others."""
        for value in self._each(edits, old, new):
            yield bool(value)

    def _each(
        self, edits: Sequence[int], old: Callable[[], Any], new: Callable[[int], Any]
    ) -> Iterator[Any]:
        """What the lanes of each edit have, and those without any, while they run alone."""
        outer = self.only
        here = outer or self.lanes.here
        known = [edit for edit in edits if edit in here.edits]
        rest = here.without(known) if known else outer
        try:
            for edit in known:
                self.only = here.inner(edit)
                try:
                    value = new(edit)
                except Exception:  # noqa: BLE001  what edited programs may raise
                    self.lanes.lose(self.only)
                    continue
                yield value
            self.only = rest  # the last one, whose counter may be used behind a loop
            if rest is None or rest.size:
                yield old()
        finally:
            self.only = outer

    def kept(self, new: Callable[[], Any], old: Callable[[], Any] | None = None) -> Any:
        """What a statement sets: in lanes that take no part what was there, or nothing more."""
        lanes, only = self.lanes, self.only
        if only is None:
            return new()
        if not only.size:
            return 0.0 if old is None else old()
        here, lanes.here, self.only = lanes.here, only, None
        try:
            value = new()
        finally:
            lanes.here, self.only = here, only
        if not isinstance(value, list | tuple | np.ndarray) and not is_number(value):
            return value  # a link of several: who takes part next sets its own
        try:
            before = _nothing_of(value) if old is None else old()
        except (NameError, KeyError, IndexError, AttributeError):
            before = _nothing_of(value)  # it was nothing before, and is read by nobody
        if type(before) is tuple and isinstance(value, list | np.ndarray):
            value = tuple(value)  # names that are set to the entries of a row
        return lanes.joined(before, [(only, value)])


def _nothing_of(value: Any) -> Any:
    """Zeros of the form of a value."""
    if isinstance(value, np.ndarray):
        return np.zeros(value.shape)
    if isinstance(value, list | tuple):
        return made_like(value, map(_nothing_of, value))
    return 0.0 if isinstance(value, Laned | int | float | complex | np.number) else value
