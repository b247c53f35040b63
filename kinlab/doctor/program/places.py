"""The places of a program, and what is put there instead."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

from kinlab.doctor.bytecode.syntax import nodes, shallow
from kinlab.doctor.program.own.definitions import ByDefault
from kinlab.doctor.program.trial import FieldChange, Trial

DATA = -1
"""In place of a part's number: an edit of the program's data."""


@dataclass(eq=False)  # never changed; frozen ones take five times as long to make
class ProgramEdit:
    """Something else in one place of a program.

    Attributes:
        part: which function; :data:`DATA` for the data.
        changes: what is put where.
        kind: ``"sign"``, ``"index"``, ``"transposed"``, ...
        cost: how far-fetched it is.
        node: what is changed: an expression or a statement; of data its name.
        place: the keys down to a number of the data.
        numbers: that number, and what it should be.
        exchanged: of an exchange in the data, what stands there and what should; of whole rows
            and columns, which two.
        of_the_arm: whether a number of the arm's own is put in.
    """

    part: int
    changes: tuple[FieldChange, ...]
    kind: str
    cost: float
    node: Any
    place: tuple[Any, ...] = ()
    numbers: tuple[float, float] | None = None
    exchanged: tuple[str, str] | None = None
    of_the_arm: bool = False


def changed(trial: Trial, several: tuple[ProgramEdit, ...]) -> AbstractContextManager[None]:
    """The program with edits in it."""
    parts = {edit.part for edit in several}
    return trial.changed(parts, [change for edit in several for change in edit.changes])


@dataclass(eq=False)  # never changed; frozen ones take five times as long to make
class Here:
    """A node and where it hangs."""

    part: int
    node: Any
    parent: ast.AST
    holder: Any
    field: Any
    above: tuple[ast.AST, ...]

    def instead(self, new: Any, kind: str, cost: float) -> ProgramEdit:
        return self.within(self.holder, self.field, new, kind, cost)

    def within(self, holder: Any, field: Any, new: Any, kind: str, cost: float) -> ProgramEdit:
        return ProgramEdit(self.part, (FieldChange(holder, field, new),), kind, cost, self.node)


def places(part: int, tree: ast.AST, above: tuple[ast.AST, ...] = ()) -> Iterator[Here]:
    inside = (*above, tree)
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "decorator_list", "pattern"):
            continue
        if isinstance(value, list):
            for k, node in enumerate(value):
                if isinstance(node, ByDefault):
                    yield from _of_default(part, node, inside)
                elif isinstance(node, ast.AST):
                    yield Here(part, node, tree, value, k, inside)
                    yield from places(part, node, inside)
        elif isinstance(value, ast.AST):
            yield Here(part, value, tree, tree, name, inside)
            yield from places(part, value, inside)


def _of_default(part: int, given: ByDefault, above: tuple[ast.AST, ...]) -> Iterator[Here]:
    """The places of what an argument is by default."""
    choice: Any = given.value
    inside = (*above, given, choice)
    yield Here(part, choice.body, choice, choice, "body", inside)
    yield from places(part, choice.body, inside)


BLOCKS = ("body", "orelse", "cases", "handlers", "finalbody")
"""Fields in which a statement keeps others."""
Spot = tuple[ast.AST, str, int | None]
"""Where a node hangs: in which, in which field, at which place of a list there."""


def hanging(tree: ast.AST) -> tuple[dict[int, Spot], dict[int, tuple[ast.AST, str]]]:
    """Where the nodes of a tree hang, and where its lists do, by what they are."""
    above: dict[int, Spot] = {}
    lists: dict[int, tuple[ast.AST, str]] = {}
    for node in nodes(tree):
        for name, value in ast.iter_fields(node):
            if isinstance(value, list):
                lists[id(value)] = (node, name)
                for k, one in enumerate(value):
                    if isinstance(one, ast.AST):
                        above[id(one)] = (node, name, k)
            elif isinstance(value, ast.AST):
                above[id(value)] = (node, name, None)
    return above, lists


def with_other(node: Any, field: str, k: int | None, new: Any) -> Any:
    """A copy of a node with something else in one field, or at one place of a list there."""
    if k is not None:
        entries = [*getattr(node, field)]
        entries[k] = new
        new = entries
    other = shallow(node)
    setattr(other, field, new)
    return other


def paired(target: ast.expr, value: ast.expr) -> Iterator[tuple[ast.expr, ast.expr]]:
    """What an assignment sets, each with its value: ``a, b = 1, 2`` sets two."""
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        for one, part in zip(target.elts, value.elts, strict=False):
            yield from paired(one, part)
    else:
        yield target, value


_NUMBERED = re.compile(r"([^\W\d]+)(\d+)")


def numbered(node: ast.AST) -> tuple[str, int] | None:
    """The letters and the number of a name: of ``m3``."""
    found = _NUMBERED.fullmatch(node.id) if isinstance(node, ast.Name) else None
    return None if found is None else (found[1], int(found[2]))


def are_counted(entries: Sequence[ast.expr]) -> bool:
    """Whether a row is of what was worked out before: ``[q1, q2, q3]``, or of calls with these."""
    parts = [one.args[0] if isinstance(one, ast.Call) and len(one.args) == 1 else one
             for one in entries]  # fmt: skip
    known = [found[1] for one in parts if (found := numbered(one)) is not None]
    return len(known) == len(parts) > 1 and known == [*range(known[0], known[0] + len(known))]


def follow(one: ast.expr, other: ast.expr) -> bool:
    """Whether two follow on one another: ``q[0]`` and ``q[1]``, th1 and th2."""
    at: list[Any] = []
    if isinstance(one, ast.Name) and isinstance(other, ast.Name):
        found = [x for x in map(numbered, (one, other)) if x is not None]
        at = [number_ for _letters, number_ in found]
        same = len({letters for letters, _number in found}) == 1
    elif isinstance(one, ast.Subscript) and isinstance(other, ast.Subscript):
        at = [getattr(x.slice, "value", None) for x in (one, other)]
        same = ast.dump(one.value) == ast.dump(other.value)
    if len(at) < 2 or not all(type(x) is int for x in at):
        return False
    return same and abs(at[0] - at[1]) == 1


def root(piece: ast.AST) -> str:
    """The name that an entry or attribute is of: ``N`` of ``N[k]``; empty where there is none."""
    while isinstance(piece, ast.Subscript | ast.Attribute):
        piece = piece.value
    return piece.id if isinstance(piece, ast.Name) else ""


def reads(node: ast.AST) -> set[str]:
    """The names that are used for more than to write into what they stand for."""
    filled = {id(one) for one in written_into(node)}
    found = [one for one in nodes(node) if isinstance(one, ast.Name) and id(one) not in filled]
    return {one.id for one in found if isinstance(one.ctx, ast.Load)}


def written_into(node: ast.AST) -> Iterator[ast.Name]:
    """The names of what is written into: of ``S`` in ``S[:3, 3] = v``."""
    for one in nodes(node):
        inner: ast.AST = one
        while isinstance(inner, ast.Subscript):
            inner = inner.value
        stored = inner is not one and isinstance(getattr(one, "ctx", None), ast.Store)
        if stored and isinstance(inner, ast.Name):
            yield inner


ANGLES = ("sin", "cos", "tan")
"""Functions of angles."""
ROUNDING = ("round", "around", "round_", "rint", "trunc", "fix")
"""Functions that round."""


def array_of(entries: Sequence[ast.expr]) -> ast.Call:
    """Numpy's array of what it is made of: ``np.array([a, b])``."""
    array = ast.Attribute(ast.Name("np", ast.Load()), "array", ast.Load())
    return ast.Call(array, [ast.List([*entries], ast.Load())], [])


def number(value: Any) -> ast.expr:
    """A number as it is written."""
    return ast.UnaryOp(ast.USub(), ast.Constant(-value)) if value < 0 else ast.Constant(value)


def called_with(name: str, *given: ast.expr) -> ast.Call:
    """A call as it is written: ``max(i, j)``."""
    return ast.Call(ast.Name(name, ast.Load()), [*given], [])


def is_nothing(node: ast.AST) -> bool:
    """Whether it is a zero as it is written."""
    return isinstance(node, ast.Constant) and node.value == 0 and node.value is not False


def row_of(edit: ProgramEdit) -> int:
    """The line in which the piece stands; of several lines the operator's, or the first entry's
    that is another."""
    node = edit.node
    if isinstance(node, ast.List | ast.Tuple) and isinstance(new := edit.changes[0].new, list):
        others = (x for x, y in zip(node.elts, new, strict=False) if x is not y)
        return int(next(others, node).lineno)
    if isinstance(node, ast.BinOp):
        change = edit.changes[0]
        if change.field == "op" or change.new is node.left:
            return int(node.right.lineno)
    return int(node.lineno)


def line_more(
    part: int,
    node: ast.AST,
    field: str,
    block: list[ast.stmt],
    at: int,
    line: ast.stmt,
    cost: float,
) -> ProgramEdit:
    """A line more in a block, in front of what stands at a place of it."""
    before = block[at - 1].end_lineno if at else getattr(node, "lineno", 0)
    for one in nodes(line):
        if isinstance(one, ast.stmt | ast.expr):
            one.lineno = one.end_lineno = before or 0
            one.col_offset = one.end_col_offset = 0
    change = FieldChange(node, field, [*block[:at], line, *block[at:]])
    return ProgramEdit(part, (change,), "missing statement", cost, line)
