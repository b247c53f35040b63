"""Statements in other places: earlier or later, in a loop or behind it, one that is missing."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from kinlab.doctor.bytecode.syntax import names, nodes
from kinlab.doctor.program.edits.additions import Scope
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import ProgramEdit
from kinlab.doctor.program.trial import FieldChange

_FAR = 6
"""Lines over which a statement may have been moved."""
_PLAIN = (ast.Assign, ast.AugAssign, ast.Expr)


def of_blocks(
    part: int, tree: ast.FunctionDef, scope: Scope, observed: Observed
) -> Iterator[ProgramEdit]:
    """Statements of one part in other places."""
    for node in nodes(tree):
        for name in ("body", "orelse"):
            block = getattr(node, name, None)
            if isinstance(block, list):
                yield from _orders(part, node, name, block)
                yield from _loops(part, node, name, block)
                yield from _twice(part, node, name, block)
        if isinstance(node, ast.For | ast.While):
            yield from _updates(part, tree, node, scope, observed)


def _orders(part: int, node: ast.AST, name: str, block: list[ast.stmt]) -> Iterator[ProgramEdit]:
    """Two statements in the other order, where one uses what the other sets."""
    for i in range(len(block)):
        for j in range(i + 1, min(i + _FAR, len(block))):
            moved = block[i]
            if isinstance(block[j], ast.Return):
                continue
            if not (_sets(moved) & _uses(block[j]) or _uses(moved) & _sets(block[j])):
                continue
            later = [*block[:i], *block[i + 1 : j + 1], moved, *block[j + 1 :]]
            change = FieldChange(node, name, later)
            yield ProgramEdit(part, (change,), "order of lines", 1.15, moved)
            if j > i + 1:
                early = [*block[:i], block[j], *block[i:j], *block[j + 1 :]]
                change = FieldChange(node, name, early)
                yield ProgramEdit(part, (change,), "order of lines", 1.16, block[j])


def _loops(part: int, node: ast.AST, name: str, block: list[ast.stmt]) -> Iterator[ProgramEdit]:
    """A statement that stands in a loop for one before or behind it, and the other way round."""
    for k, loop in enumerate(block):
        if not isinstance(loop, ast.For | ast.While | ast.If):
            continue
        loops = not isinstance(loop, ast.If)
        first, last = loop.body[0], loop.body[-1]
        outside: list[tuple[ast.stmt, list[ast.stmt], int, str, float]] = []
        if len(loop.body) > 1 and (
            isinstance(last, ast.Return if loops else ast.Assign | ast.AugAssign)
        ):
            outside.append((last, loop.body[:-1], k + 1, "too deep", 1.0 if loops else 1.16))
        if len(loop.body) > 1 and loops and isinstance(last, _PLAIN):
            outside.append((last, loop.body[:-1], k + 1, "too deep", 1.16))
        if len(loop.body) > 1 and loops and isinstance(first, ast.Assign):
            outside.append((first, loop.body[1:], k, "in the loop", 1.14))
        for moved, rest, at, kind, cost in outside:
            changes = (
                FieldChange(loop, "body", rest),
                FieldChange(node, name, [*block[:at], moved, *block[at:]]),
            )
            yield ProgramEdit(part, changes, kind, cost, moved)
        after = block[k + 1] if k + 1 < len(block) else None
        before = block[k - 1] if k else None
        if isinstance(after, _PLAIN) and _uses(after) & _sets(loop):
            changes = (
                FieldChange(loop, "body", [*loop.body, after]),
                FieldChange(node, name, [*block[: k + 1], *block[k + 2 :]]),
            )
            yield ProgramEdit(part, changes, "not deep enough", 1.14, after)
        if loops and isinstance(before, ast.Assign) and _sets(before) & _uses(loop):
            changes = (
                FieldChange(loop, "body", [before, *loop.body]),
                FieldChange(node, name, [*block[: k - 1], *block[k:]]),
            )
            yield ProgramEdit(part, changes, "before the loop", 1.14, before)


def _twice(part: int, node: ast.AST, name: str, block: list[ast.stmt]) -> Iterator[ProgramEdit]:
    """A line that stands there twice."""
    for k in range(1, len(block)):
        if isinstance(block[k], _PLAIN) and ast.dump(block[k]) == ast.dump(block[k - 1]):
            change = FieldChange(node, name, [*block[:k], *block[k + 1 :]])
            yield ProgramEdit(part, (change,), "extra statement", 0.95, block[k])


def _updates(
    part: int, tree: ast.FunctionDef, loop: ast.For | ast.While, scope: Scope, observed: Observed
) -> Iterator[ProgramEdit]:
    """What a loop uses, and does not set anew: ``T = T @ A``, ``p = p + R @ d``, ``w = w_next``."""
    inside = {name for one in loop.body for name in _sets(one)}
    counted = {*names(loop)} & {*scope.counters}
    scope.stand([one for one in nodes(tree) if loop in nodes(one)])
    used = _uses(tree)
    before = {name for one in nodes(tree) if isinstance(one, ast.Assign) for name in _sets(one)}
    for name in sorted((used & before) - inside - counted):
        shape = scope.shapes.get(name)
        if shape is None:
            continue
        for text, piece in scope.pieces_here(shape).items():
            given = {*names(piece)}
            if text == name or not given & inside:
                continue
            own = ast.Name(name, ast.Load())
            fresh = bool(given & scope.unused)
            ways: list[ast.expr] = [ast.BinOp(own, ast.Add(), piece)]
            if len(shape) == 2:
                ways.insert(0, ast.BinOp(own, ast.MatMult(), piece))
            if isinstance(piece, ast.Name):
                ways.append(piece)
            for new in ways:
                line = ast.Assign([ast.Name(name, ast.Store())], new)
                line.lineno = line.end_lineno = loop.body[-1].end_lineno or loop.lineno
                line.col_offset = line.end_col_offset = 0
                change = FieldChange(loop, "body", [*loop.body, line])
                cost = 1.05 if fresh else 1.18
                yield ProgramEdit(part, (change,), "missing statement", cost, line)


def _sets(node: ast.AST) -> set[str]:
    return {*names(node, ast.Store)}


def _uses(node: ast.AST) -> set[str]:
    return {*names(node, ast.Load)}
