"""What a program has elsewhere in the same company, or in the line of another link.

Who writes ``T[j][:3, 3] + R @ c`` in one function means it in the other; of ``v2 = ...`` and
``v3 = ...`` one tells what the other should be.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import product
from types import FunctionType
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, copied, names, nodes, targets_of, text_of
from kinlab.doctor.program.edits.scope.forms import statement_of
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import (
    Here,
    ProgramEdit,
    called_with,
    is_nothing,
    paired,
    with_other,
)
from kinlab.doctor.program.trial import FailedError, Trial

_GIVEN, _ASKED = 1.06, 1.13
"""Cost of what a function makes of a vector, where its line asks it, and where it does not."""
_VECTOR, _ROTATION, _POSE = (3,), (3, 3), (4, 4)
_THIRD, _LAST = 2, 3
"""Columns of a pose: the axis, the point."""
_MATRIX, _TWO = 2, 2
"""Axes of a matrix, what is multiplied."""
_MULTIPLY = ("mul", "matmul", "mat_mul", "mm", "dot", "prod", "matprod")
"""How functions that multiply matrices begin."""
_ALIKE = 12
"""Lines of one name that are held beside one another."""
_LETTERS = 200
"""Letters of a line that is."""
_NUMBERED = re.compile(r"([A-Za-z_]+?)_?(\d)")


@dataclass(frozen=True, eq=False)
class _Company:
    """An expression in a larger one.

    Attributes:
        whole: the larger one.
        field, at: where in it the expression is.
    """

    whole: ast.expr
    field: str
    at: int | None = None


_ACROSS = 0.99
"""Cost of the entry across the diagonal, where all others of a matrix are as those."""
_SUMMED = 1.03
"""Cost of the sum of a part of a row for its entry, where the program has such a sum."""
_CARRIED = 1.06
"""Cost of what a loop carries on for the factor or the term that it gets at each turn."""
_NOTHING = 1.05
"""Cost of zeros for what is given beside them."""


def _sums_of_rows(tree: ast.AST) -> Iterator[tuple[str, str, ast.Call]]:
    """The sums of parts of rows: the row, the counter at which the part ends, the call."""
    for call in nodes(tree):
        if not isinstance(call, ast.Call) or called(call) != "sum":
            continue
        part = call.args[0] if call.args else getattr(call.func, "value", None)
        if isinstance(part, ast.Subscript) and isinstance(part.slice, ast.Slice):
            ends = {*names(part.slice)}
            if len(ends) == 1:
                yield text_of(part.value), ends.pop(), call


def _is_set_around(name: str, here: Here) -> bool:
    """Whether the statement around sets what is called so."""
    lines = [one for one in here.above if isinstance(one, ast.Assign | ast.AugAssign)]
    return any(name in names(target) for one in lines for target in targets_of(one))


def _carried_on(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """What a loop puts to what it carries on, and its name: ``u *= np.exp(1j*angle)``."""
    for node in nodes(tree):
        name: ast.expr
        if isinstance(node, ast.AugAssign):
            name, more, op = node.target, node.value, node.op
        elif isinstance(node, ast.Assign) and isinstance(node.value, ast.BinOp):
            name, more, op = node.targets[0], node.value.right, node.value.op
            if text_of(node.value.left) != text_of(name):
                continue
        else:
            continue
        kinds = (ast.Call, ast.BinOp, ast.Subscript) if isinstance(op, ast.Add) else (ast.Call,)
        put = isinstance(op, ast.Add | ast.Mult | ast.MatMult) and isinstance(more, kinds)
        if isinstance(name, ast.Name) and put:
            yield text_of(more), name.id


class Elsewhere:
    """What the expressions of a program stand together with, and the lines of the same names.

    Args:
        trial: the program.
        observed: its expressions.
    """

    def __init__(self, trial: Trial, observed: Observed) -> None:
        self._company: dict[str, list[_Company]] = defaultdict(list)
        self._lines: dict[int, list[ast.expr]] = defaultdict(list)
        own = {part.name for part in trial.program.parts}
        self._given: dict[tuple[str, int], dict[str, ast.expr]] = defaultdict(dict)
        for tree in trial.trees:
            for node in nodes(tree):
                if isinstance(node, ast.expr):
                    for one, of in _operands(node, own, observed):
                        self._company[_bare(one)].append(of)
                if isinstance(node, ast.Call) and called(node) in own:
                    for k, one in enumerate(node.args):
                        self._given[called(node), k].setdefault(text_of(one), one)
            self._of_lines(tree)
        self._carried = {x: y for tree in trial.trees for x, y in _carried_on(tree)}
        self._sums = [one for tree in trial.trees for one in _sums_of_rows(tree)]
        self._products = _products(trial, observed)
        self._roles = _roles(trial, observed)
        self._within = _within(trial, observed)

    def edits(self, here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
        """What an expression should be as it is elsewhere."""
        node = here.node
        shape = observed.shape(node)
        if isinstance(node, ast.Call) and called(node) == "range":
            yield from _other_ranges(here, scope)
        for new in self._lines.get(id(node), ()):
            if _known(new, scope):
                table = isinstance(node, ast.List) and any(
                    isinstance(one, ast.List) for one in node.elts[:1]
                )
                yield here.instead(new, _kind(node, new), 1.14 if table else 1.06)
        if isinstance(here.parent, ast.Call) and here.holder is here.parent.args:
            mine = text_of(node)
            for text, one in self._given.get((called(here.parent), here.field), {}).items():
                if text != mine and observed.shape(one) == (shape or ()) and _known(one, scope):
                    yield here.instead(one, "name", 1.05 if is_nothing(node) else 1.1)
        if isinstance(here.parent, ast.Call) and here.holder is here.parent.args and shape:
            for one in here.parent.args:  # the mass matrix's columns: no rates, no gravity
                beside = observed.of(one) if isinstance(one, ast.Name) and one is not node else None
                if beside and beside.shape == shape and beside.nothing:
                    yield here.instead(one, "name", _NOTHING)
        may = bool(self._carried) and isinstance(node, ast.Call | ast.BinOp | ast.Subscript)
        name = self._carried.get(text_of(node)) if may else None
        if name and not _is_set_around(name, here):
            yield here.instead(ast.Name(name, ast.Load()), "name", _CARRIED)
        if is_nothing(node) and isinstance(here.parent, ast.Assign):
            yield from _of_the_mirror(here)
        for new in _across(here):
            if _known(new, scope):
                yield here.instead(new, _kind(node, new), _ACROSS)
        if shape == () and isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Name):
            yield from self._summed(here, node, node.slice.id)
        if shape is None or isinstance(node, ast.Constant | ast.List | ast.Tuple):
            return
        if shape and self._within and isinstance(node, ast.Name | ast.Subscript | ast.Call):
            yield from self._given_to_own(here, shape)
        if self._roles and shape in (_VECTOR, _ROTATION, _POSE):
            yield from self._by_own_functions(here, scope, shape)
        named = isinstance(node, ast.Name) and isinstance(here.parent, ast.Assign)
        given = isinstance(here.parent, ast.Call) and called(here.parent) in scope.functions
        if given and isinstance(node, ast.Name) and len(shape) == 1 and scope.has_numpy:
            function = ast.Attribute(ast.Name("np", ast.Load()), "zeros", ast.Load())
            nothing = ast.Call(function, [ast.Constant(shape[0])], [])
            yield here.instead(nothing, "extra term", 1.13)
        if shape == _VECTOR and named:
            zeros = ast.List([ast.Constant(0)] * 3, ast.Load())
            yield here.instead(zeros, "extra term", 1.15)
        if scope.crosses(here.parent) and shape == _VECTOR and here.field == 1:
            yield from _from_the_axis(here, scope)
        if len(shape) == _MATRIX and isinstance(here.parent, ast.Assign):
            yield from self._multiplied(here, scope, shape)
        seen = {text_of(node), text_of(here.parent)}
        for of in self._company.get(_bare(node), ()):
            larger = _renamed(of, node)
            text = "" if larger is None else text_of(larger)
            if larger is None or text in seen or not _known(larger, scope):
                continue
            seen.add(text)
            if observed.shape(of.whole) == shape or isinstance(here.parent, ast.Assign):
                cost = 1.1 if isinstance(node, ast.Name) else 1.06
                yield here.instead(larger, _kind(node, larger), cost)

    def _summed(self, here: Here, node: ast.Subscript, counter: str) -> Iterator[ProgramEdit]:
        """A part of a row summed up, as it is elsewhere: ``sum(q[: j + 1])`` for ``q[j]``."""
        for row, other, whole in self._sums:
            if row == text_of(node.value):
                new = _OtherCounter(other, counter).visit(copied(whole))
                yield here.instead(new, "missing term", _SUMMED)

    def _given_to_own(self, here: Here, shape: Shape) -> Iterator[ProgramEdit]:
        """What a function of the program's makes of a vector: ``perp(w)`` for ``w``."""
        line = statement_of(here.above)
        beside = {called(x) for x in nodes(line) if isinstance(x, ast.Call)}
        outer = called(here.parent) if isinstance(here.parent, ast.Call) else ""
        own = called(here.node) if isinstance(here.node, ast.Call) else ""
        for name, asked in self._within.items():
            if asked == shape and name not in (own, outer):
                call = called_with(name, here.node)
                yield here.instead(call, "function", _GIVEN if name in beside else _ASKED)

    def _by_own_functions(self, here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
        """What the program's own functions of vectors and matrices make of an expression."""
        node = here.node
        own = self._roles.get(called(node), "") if isinstance(node, ast.Call) else ""
        if own in ("transposed", "inverse"):
            yield here.instead(node.args[0], own, 1.02)
        elif own in ("turned", "times"):
            yield here.instead(node.args[1], "extra factor", 1.08)
        for name, role in self._roles.items():
            function = ast.Name(name, ast.Load())
            if shape in (_ROTATION, _POSE):
                if role == ("transposed" if shape == _ROTATION else "inverse") and own != role:
                    yield here.instead(ast.Call(function, [node], []), role, 1.04)
                continue
            if role == "turned":
                for text, angle in scope.simple(()):
                    cost = 1.06 if text in scope.unused else 1.16
                    yield here.instead(
                        ast.Call(function, [angle, node], []), "missing matrix", cost
                    )
            elif role == "times":
                for _text, matrix in scope.simple(_ROTATION):
                    for turned in (matrix, *self._transposed(matrix)):
                        new = ast.Call(function, [turned, node], [])
                        yield here.instead(new, "missing matrix", 1.1)
            elif role == "sum" and isinstance(here.parent, ast.Assign | ast.Return | ast.Call):
                yield from self._added(here, scope, function)

    def _transposed(self, matrix: ast.expr) -> Iterator[ast.expr]:
        for name, role in self._roles.items():
            if role == "transposed":
                yield called_with(name, matrix)

    def _added(self, here: Here, scope: Scope, function: ast.expr) -> Iterator[ProgramEdit]:
        """A vector more, or a moment, by the program's own sum."""
        vectors = [one for _text, one in scope.simple(_VECTOR)]
        crosses = [name for name, role in self._roles.items() if role == "cross"]
        for one in vectors:
            yield here.instead(ast.Call(function, [here.node, one], []), "missing term", 1.12)
        for name in crosses:
            for one in vectors:
                for other in vectors if one is not here.node else ():
                    if one is not other:
                        product = ast.Call(ast.Name(name, ast.Load()), [one, other], [])
                        new = ast.Call(function, [here.node, product], [])
                        yield here.instead(new, "missing term", 1.14)

    def _multiplied(self, here: Here, scope: Scope, shape: Shape) -> Iterator[ProgramEdit]:
        """A matrix times another one, by the program's own function: ``T = mul(T, step(i))``."""
        if isinstance(here.node, ast.Call) and called(here.node) in self._products:
            return
        for name in self._products:
            for _text, matrix in scope.simple(shape):
                function = ast.Name(name, ast.Load())
                for both in ([matrix, here.node], [here.node, matrix]):
                    yield here.instead(ast.Call(function, both, []), "missing matrix", 1.1)

    def _of_lines(self, tree: ast.AST) -> None:
        """Lines that set the same of other links: ``v2 = ...`` beside ``v3 = ...``."""
        alike: dict[str, list[tuple[list[int], ast.expr]]] = defaultdict(list)
        for line in nodes(tree):
            if isinstance(line, ast.Assign) and len(line.targets) == 1:
                for target, value in paired(line.targets[0], line.value):
                    text = text_of(target)
                    numbers = [int(x) for x in re.findall(r"\d", text)]
                    if numbers and len(text_of(value)) <= _LETTERS:
                        alike[re.sub(r"\d", "#", text)].append((numbers, value))
        for some in alike.values():
            for here, value in some[:_ALIKE]:
                for there, other in some[:_ALIKE]:
                    steps = {a - b for a, b in zip(here, there, strict=True)} - {0}
                    if value is not other and len(steps) == 1:
                        self._beside(value, _Shifted(*steps).visit(copied(other)))

    def _beside(self, value: ast.expr, other: ast.expr) -> None:
        """Notes what of a line should be, if it is as another one."""
        if ast.dump(value) == ast.dump(other):
            return
        while (inner := _only_difference(value, other)) is not None:
            value, other = inner
        if isinstance(other, ast.expr) and isinstance(value, ast.expr):
            self._lines[id(value)].append(other)


class _Shifted(ast.NodeTransformer):
    """Names and entries of other links, by a step: ``w2`` and ``q[1]`` for ``w1`` and ``q[0]``."""

    def __init__(self, step: int) -> None:
        self.step = step

    def visit_Name(self, node: ast.Name) -> ast.expr:
        found = _NUMBERED.fullmatch(node.id)
        if found is None:
            return node
        number = int(found[2]) + self.step
        return ast.Name(f"{node.id[:-1]}{max(number, 0)}", node.ctx)

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        node.value = self.visit(node.value)
        key = node.slice
        if isinstance(key, ast.Constant) and type(key.value) is int:
            node.slice = ast.Constant(max(key.value + self.step, 0))
        elif isinstance(key, ast.Name):
            node.slice = self.visit(key)
        return node


def _products(trial: Trial, observed: Observed) -> list[str]:
    """Functions of the program's own that multiply two matrices, as far as can be seen."""
    calls = [x for tree in trial.trees for x in nodes(tree) if isinstance(x, ast.Call)]
    found: list[str] = []
    for part in trial.program.parts[1:]:
        own = [x for x in calls if called(x) == part.name and len(x.args) == _TWO]
        sizes = {observed.shape(x) for call in own for x in (call, *call.args)}
        alike = len(sizes) == 1 and len(next(iter(sizes)) or ()) == _MATRIX
        found += [part.name] if alike else []
    own_names = trial.program.space
    uncalled = {*own_names} - {called(x) for x in calls}
    found += sorted(name for name in uncalled if _is_product(own_names[name]))
    return found


def _roles(trial: Trial, observed: Observed) -> dict[str, str]:
    """What functions of the program's own do with vectors and matrices, as far as is seen."""
    own = {part.name for part in trial.program.parts[1:]}
    found: dict[str, str] = {}
    for tree in trial.trees:
        for call in nodes(tree):
            if isinstance(call, ast.Call) and called(call) in own - found.keys():
                seen = [observed.of(one) for one in (*call.args, call)]
                values = [one.values[0] for one in seen if one is not None and one.values]
                role = _role(*values) if 1 < len(values) == len(seen) else ""
                found |= {called(call): role} if role else {}
    return found | _inverses(trial, observed)


def _inverses(trial: Trial, observed: Observed) -> dict[str, str]:
    """Functions that nothing asks any more, and that invert a pose."""
    asked = {called(x) for tree in trial.trees for x in nodes(tree) if isinstance(x, ast.Call)}
    idle = [
        (k, part.name)
        for k, part in enumerate(trial.program.parts)
        if k and part.owner is None and not part.sets and part.name not in asked
        if len(part.tree.args.args) == 1
    ]
    seen = (observed.of(x) for tree in trial.trees for x in nodes(tree)) if idle else ()
    poses = (one.values[0] for one in seen if one is not None and one.shape == _POSE and one.values)
    some = [one for one in poses if not np.allclose(one @ one, np.eye(4))][:1]
    found: dict[str, str] = {}
    for pose, (k, name) in product(some, idle):
        with suppress(FailedError, TypeError, ValueError):
            answer: Array = np.asarray(trial.part(k, [pose.copy()], {}), dtype=np.float64)
            found |= {name: "inverse"} if _role(pose, answer) == "inverse" else {}
    return found


def _within(trial: Trial, observed: Observed) -> dict[str, Shape]:
    """The functions of the program's that make a vector of a vector of as many numbers."""
    own = {part.name for part in trial.program.parts[1:] if part.owner is None and not part.sets}
    found: dict[str, Shape] = {}
    for call in (x for tree in trial.trees for x in nodes(tree) if isinstance(x, ast.Call)):
        if called(call) in own and isinstance(call.func, ast.Name) and len(call.args) == 1:
            shape = observed.shape(call)
            if shape and len(shape) == 1 and observed.shape(call.args[0]) == shape:
                found[called(call)] = shape
    return found


def _role(*values: Array) -> str:
    """What makes the last of some numbers of the others."""
    *given, answer = values
    shapes = [one.shape for one in given]
    if not answer.any():
        return ""
    if shapes == [_ROTATION] and answer.shape == _ROTATION:
        plain = np.allclose(given[0], given[0].T)
        return "transposed" if np.allclose(answer, given[0].T) and not plain else ""
    if shapes == [_POSE] and answer.shape == _POSE:
        plain = np.allclose(answer, given[0])
        return "inverse" if np.allclose(answer @ given[0], np.eye(4)) and not plain else ""
    if shapes == [_VECTOR, _VECTOR] and answer.shape == _VECTOR:
        if np.allclose(answer, given[0] + given[1]) and given[0].any() and given[1].any():
            return "sum"
        return "cross" if np.allclose(answer, np.cross(given[0], given[1])) else ""
    if shapes == [_ROTATION, _VECTOR] and answer.shape == _VECTOR:
        return "times" if np.allclose(answer, given[0] @ given[1]) else ""
    if shapes == [(), _VECTOR] and answer.shape == _VECTOR:
        same = np.isclose(np.linalg.norm(answer), np.linalg.norm(given[1]))
        return "turned" if same and given[0] else ""
    return ""


def _of_the_mirror(here: Here) -> Iterator[ProgramEdit]:
    """The entry on the other side of the diagonal, for a zero: ``M[1, 0] = M[0, 1]``."""
    assert isinstance(here.parent, ast.Assign)
    target = here.parent.targets[0]
    keys = getattr(getattr(target, "slice", None), "elts", [])
    if isinstance(target, ast.Subscript) and len(keys) == _TWO and here.field == "value":
        key = ast.Tuple([*map(copied, reversed(keys))], ast.Load())
        other = ast.Subscript(copied(target.value), key, ast.Load())
        yield here.instead(other, "name", 1.1)


def _across(here: Here) -> Iterator[ast.expr]:
    """What stands across the diagonal of a matrix that is symmetric as it is typed but for this."""
    table = here.above[-2] if len(here.above) > 1 else None
    rows = table.elts if isinstance(table, ast.List) else []
    lists = [row.elts for row in rows if isinstance(row, ast.List) and len(row.elts) == len(rows)]
    i = next((k for k, row in enumerate(rows) if row is here.parent), None)
    if i is None or len(lists) < len(rows):
        return
    j = here.field
    places_ = [(k, m) for k in range(len(rows)) for m in range(k)]
    unlike = [(k, m) for k, m in places_ if text_of(lists[k][m]) != text_of(lists[m][k])]
    if unlike == [(max(i, j), min(i, j))]:
        other = lists[j][i]
        turned = any(isinstance(x, ast.UnaryOp) for x in (other, here.node))
        if len(rows) > _TWO or not turned:  # of a rotation in the plane one is the opposite
            yield copied(other)


def _is_product(value: Any) -> bool:
    """Whether a function that nothing calls any more is called as one that multiplies."""
    return isinstance(value, FunctionType) and value.__name__.lower().startswith(_MULTIPLY)


def _operands(
    node: ast.expr, own: set[str], observed: Observed
) -> Iterator[tuple[ast.expr, _Company]]:
    """The operands of a sum or a product, and what a function of the program's own is given."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub | ast.MatMult):
        yield node.left, _Company(node, "left")
        if not isinstance(node.op, ast.Sub):
            yield node.right, _Company(node, "right")
    elif isinstance(node, ast.Call) and called(node) in own and len(node.args) > 1:
        whole = observed.shape(node)
        for k, one in enumerate(node.args):
            if whole and observed.shape(one) == whole:
                yield one, _Company(node, "args", k)


def _bare(node: ast.expr) -> str:
    """An expression without the names of its indices: ``T[#][:3, 3]`` of ``T[i + 1][:3, 3]``."""
    if isinstance(node, ast.Name):
        return node.id
    return re.sub(r"\[(?:[a-z](?: [-+] 1)?|\d)\]", "[#]", text_of(node))


def _renamed(of: _Company, node: ast.expr) -> ast.expr | None:
    """The larger expression with another one in it, and that one's index throughout."""
    inner: ast.expr = getattr(of.whole, of.field)
    if of.at is not None:
        inner = getattr(of.whole, of.field)[of.at]
    if inner is node:
        return None
    new = copied(with_other(of.whole, of.field, of.at, ast.Name("_here", ast.Load())))
    before, now = _index(inner), _index(node)
    if before is not None and now is not None and ast.dump(before) != ast.dump(now):
        new = _OtherIndex(before, now).visit(new)
    return _InPlace(node).visit(new)  # type: ignore[no-any-return]


def _index(node: ast.expr) -> ast.expr | None:
    """The innermost index of an expression: ``i + 1`` of ``T[i + 1][:3, 3]``."""
    found = None
    while isinstance(node, ast.Subscript | ast.Attribute):
        if isinstance(node, ast.Subscript):
            found = node.slice
        node = node.value
    return found


class _OtherIndex(ast.NodeTransformer):
    """One index for another: of ``T[i + 1]`` and ``c[i]``, both by ``j``."""

    def __init__(self, before: ast.expr, now: ast.expr) -> None:
        self.before, self.now = ast.dump(before), now
        self.counter = before.id if isinstance(before, ast.Name) else ""

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        self.generic_visit(node)
        if ast.dump(node.slice) == self.before:
            return ast.Subscript(node.value, copied(self.now), node.ctx)
        return node


class _InPlace(ast.NodeTransformer):
    """An expression where the other one was."""

    def __init__(self, node: ast.expr) -> None:
        self.node = node

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return self.node if node.id == "_here" else node


def _from_the_axis(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A point as seen from the axis: ``p - T[j][:3, 3]`` where that is ``T[j][:3, 2]``."""
    if isinstance(here.node, ast.BinOp) and isinstance(here.node.op, ast.Sub):
        return
    assert isinstance(here.parent, ast.Call)
    axis: ast.expr | None = here.parent.args[0]
    if isinstance(axis, ast.Name):
        # of z2 it is o2, or p2
        label = re.fullmatch(r"[A-Za-z_]+(\d+)", axis.id)
        for name, shape in scope.shapes.items() if label else ():
            if label and shape == _VECTOR and re.fullmatch(rf"[oOpP]_?{label[1]}", name):
                own = ast.BinOp(here.node, ast.Sub(), ast.Name(name, ast.Load()))
                yield here.instead(own, "missing term", 1.04)
        axis = _set_to(axis.id, here.above)
    if isinstance(axis, ast.Subscript) and isinstance(axis.slice, ast.Tuple):
        rows, column = axis.slice.elts[0], axis.slice.elts[-1]
        if isinstance(column, ast.Constant) and column.value == _THIRD:
            key = ast.Tuple([copied(rows), ast.Constant(_LAST)], ast.Load())
            point = ast.Subscript(copied(axis.value), key, ast.Load())
            yield here.instead(ast.BinOp(here.node, ast.Sub(), point), "missing term", 1.04)
    elif isinstance(axis, ast.Subscript):
        for name, shape in scope.lists.items():
            if shape == _VECTOR:
                point = ast.Subscript(ast.Name(name, ast.Load()), axis.slice, ast.Load())
                yield here.instead(ast.BinOp(here.node, ast.Sub(), point), "missing term", 1.08)


def _set_to(name: str, above: Sequence[ast.AST]) -> ast.expr | None:
    """What a name was set to last in the blocks around a place."""
    bodies = [getattr(outer, "body", ()) for outer in above]  # a lambda's is no block
    lines = [line for body in bodies if isinstance(body, list) for line in body]
    for line in reversed(lines if all(isinstance(x, ast.stmt) for x in lines) else []):
        if isinstance(line, ast.Assign) and len(line.targets) == 1:
            for target, value in paired(line.targets[0], line.value):
                if isinstance(target, ast.Name) and target.id == name:
                    return value
    return None


def _other_ranges(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """What other loops run through, with this one's outer counter: ``range(i, 3)``."""
    counters = [x.target.id for x in here.above
                if isinstance(x, ast.For) and isinstance(x.target, ast.Name)]  # fmt: skip
    own = {*names(here.node)}
    for one in scope.ranges:
        for name in dict.fromkeys(names(one)):
            for counter in counters if name in scope.counters else ():
                if counter not in (name, getattr(here.parent, "target", None)):
                    new = _OtherCounter(name, counter).visit(copied(one))
                    cost = 1.12 if counter in own else 1.16
                    yield here.instead(new, "loop", cost)


class _OtherCounter(ast.NodeTransformer):
    """One counter for another."""

    def __init__(self, name: str, other: str) -> None:
        self.name, self.other = name, other

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return ast.Name(self.other, node.ctx) if node.id == self.name else node


def _only_difference(one: ast.AST, other: ast.AST) -> tuple[ast.expr, ast.expr] | None:
    """The only expressions in which two of one kind differ; None where there are more."""
    if type(one) is not type(other):
        return None
    found: list[tuple[ast.expr, ast.expr]] = []
    for (_name, mine), (_same, theirs) in zip(
        ast.iter_fields(one), ast.iter_fields(other), strict=True
    ):
        pairs = [(mine, theirs)]
        if isinstance(mine, list):
            if len(mine) != len(theirs):
                return None
            pairs = [*zip(mine, theirs, strict=True)]
        for a, b in pairs:
            if not isinstance(a, ast.AST) or not isinstance(b, ast.AST):
                if a != b:  # x[:j] beside x[j:] has a limit where that has none
                    return None
            elif ast.dump(a) != ast.dump(b):
                if not isinstance(a, ast.expr) or not isinstance(b, ast.expr):
                    return None
                found.append((a, b))
    return found[0] if len(found) == 1 else None


def _known(new: ast.expr, scope: Scope) -> bool:
    """Whether a part has all the names of an expression."""
    here = {*scope.shapes, *scope.lists, *scope.counters, *scope.whole, *scope.present}
    return all(name in here or name in scope.space for name in names(new))


def _kind(old: ast.expr, new: ast.expr) -> str:
    """What is wrong where one stands for the other."""
    before, after = text_of(old), text_of(new)
    larger, smaller = (new, old) if before in after else (old, new)
    if text_of(smaller) not in text_of(larger):
        return "name"
    told = "missing" if larger is new else "extra"
    if isinstance(larger, ast.BinOp) and isinstance(larger.op, ast.Add | ast.Sub):
        return f"{told} term"
    product = isinstance(larger, ast.Call) or (
        isinstance(larger, ast.BinOp) and isinstance(larger.op, ast.MatMult)
    )
    return "missing matrix" if product and told == "missing" else f"{told} factor"
