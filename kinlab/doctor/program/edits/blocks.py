"""Statements in other places: earlier or later, in a loop or behind it, one that is missing."""

from __future__ import annotations

import ast
from collections.abc import Container, Iterator
from itertools import product

from kinlab.doctor.bytecode.syntax import called, copied, names, nodes
from kinlab.doctor.program.edits.additions import OtherAxis, OtherName
from kinlab.doctor.program.edits.scope.forms import Turned
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import (
    ProgramEdit,
    line_more,
    paired,
    reads,
    root,
    written_into,
)
from kinlab.doctor.program.trial import FieldChange

_FAR = 6
"""Lines over which a statement may have been moved."""
_UPDATED = 1.09
"""Cost of a line right before or behind the one that updates what it uses: it is one too late."""
_NEVER = 1.02
"""Cost of a line that fills what is never filled."""
_LONG, _NAMES = 100, 8
"""Characters of a line of which another is made."""
_ON_THE_REST = 1.04
"""Cost of what is done to some rows of a matrix in place, and not to the others."""
_LEFT_OUT, _VECTORS = 1.1, ((2,), (3,))
"""Cost of a step of a recursion that is left out; shapes of what it carries along."""
_SHORT, _FEW = 30, 3
"""Characters of a term, and rates, of which one is tried."""
_PLAIN = (ast.Assign, ast.AugAssign, ast.Expr)


def of_blocks(
    part: int, tree: ast.FunctionDef, scope: Scope, observed: Observed
) -> Iterator[ProgramEdit]:
    """Statements of one part in other places."""
    empty = _never_filled(tree)
    for node in nodes(tree):
        for name in ("body", "orelse"):
            block = getattr(node, name, None)
            if isinstance(block, list):
                yield from _orders(part, node, name, block)
                yield from _loops(part, node, name, block)
                yield from _twice(part, node, name, block)
                yield from _beside(part, node, name, block, scope)
                yield from _of_twins(part, node, name, block)
                yield from _filling(part, node, name, block, scope, empty)
                yield from _of_unused(part, tree, node, name, block, scope)
        if isinstance(node, ast.For | ast.While):
            yield from _updates(part, tree, node, scope, observed)
            yield from _steps_left_out(part, tree, node, scope)
        if isinstance(node, ast.If) and node.orelse:
            yield from _of_the_other_case(part, node, scope)
            yield from _in_both_cases(part, node)


def _of_the_other_case(part: int, node: ast.If, scope: Scope) -> Iterator[ProgramEdit]:
    """A line as the other case has it, for another number: ``d = d + q`` beside ``th = th + q``."""
    numbers = [name for name, shape in scope.shapes.items() if shape == ()]
    for there, name, block in (
        (node.orelse, "body", node.body),
        (node.body, "orelse", node.orelse),
    ):
        given = {one for line in block for one in _sets(line)}
        for line in there:
            own = [*_sets(line)]
            if len(own) != 1 or own[0] in given or scope.shapes.get(own[0], ()) != ():
                continue
            together = [one for one in numbers if one in scope.beside.get(own[0], ())]
            for other in [*dict.fromkeys((*together, *numbers))][:_NAMES]:
                if other != own[0] and other not in given:
                    new = OtherName(own[0], other).visit(copied(line))
                    yield line_more(part, node, name, block, 0, new, 1.12)


def _in_both_cases(part: int, node: ast.If) -> Iterator[ProgramEdit]:
    """A line that the other case has, too, and that is one too many: of a hinge, for a slide."""
    for name, block, there in (
        ("body", node.body, node.orelse),
        ("orelse", node.orelse, node.body),
    ):
        known = {ast.dump(line) for line in there}
        for k, line in enumerate(block if len(block) > 1 else ()):
            if isinstance(line, _PLAIN) and ast.dump(line) in known:
                change = FieldChange(node, name, [*block[:k], *block[k + 1 :]])
                yield ProgramEdit(part, (change,), "extra statement", 1.04, line)


def _orders(part: int, node: ast.AST, name: str, block: list[ast.stmt]) -> Iterator[ProgramEdit]:
    """Two statements in the other order, where one uses what the other sets."""
    for i in range(len(block)):
        for j in range(i + 1, min(i + _FAR, len(block))):
            moved = block[i]
            if isinstance(block[j], ast.Return):
                continue
            if not (_fills(moved) & reads(block[j]) or reads(moved) & _fills(block[j])):
                continue
            later = [*block[:i], *block[i + 1 : j + 1], moved, *block[j + 1 :]]
            change = FieldChange(node, name, later)
            updated = j == i + 1 and (
                _updates_for(moved, block[j]) or _updates_for(block[j], moved)
            )
            cost = _UPDATED if updated else 1.15
            yield ProgramEdit(part, (change,), "order of lines", cost, moved)
            if j > i + 1:
                early = [*block[:i], block[j], *block[i:j], *block[j + 1 :]]
                change = FieldChange(node, name, early)
                yield ProgramEdit(part, (change,), "order of lines", 1.16, block[j])


def _updates_for(line: ast.stmt, user: ast.stmt) -> bool:
    """Whether a line makes of a name's value its next one, which another uses: ``w = R @ w``."""
    plain = isinstance(line, ast.Assign) and isinstance(user, ast.Assign | ast.AugAssign)
    return plain and bool(_sets(line) & reads(line) & reads(user))


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
        if isinstance(after, _PLAIN) and _uses(after) & _fills(loop):
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
    turned = {*names(loop.target)} if isinstance(loop, ast.For) else set[str]()
    scope.stand([one for one in nodes(tree) if loop in nodes(one)])
    used = _uses(tree)
    before = {name for one in nodes(tree) if isinstance(one, ast.Assign) for name in _sets(one)}
    for name in sorted((used & before) - inside - counted):
        shape = scope.shapes.get(name)
        if shape is None:
            continue
        for text, piece in scope.pieces_here(shape).items():
            given = {*names(piece)}
            if text != name and given & turned and not shape:
                yield _added(part, loop, 0, name, piece, 1.12)
            if text == name or not given & inside:
                continue
            fresh = given & scope.unused
            after = [k for k, one in enumerate(loop.body) if fresh & _sets(one)]
            if after and after[-1] + 1 < len(loop.body):
                yield _added(part, loop, after[-1] + 1, name, piece, 1.06)
            own = ast.Name(name, ast.Load())
            ways: list[ast.expr] = [ast.BinOp(own, ast.Add(), piece)]
            if len(shape) == 2:
                ways.insert(0, ast.BinOp(own, ast.MatMult(), piece))
            if isinstance(piece, ast.Name):
                ways.append(piece)
            for new in ways:
                line = ast.Assign([ast.Name(name, ast.Store())], new)
                block = [*loop.body]
                yield line_more(
                    part, loop, "body", block, len(block), line, 1.05 if fresh else 1.18
                )


def _steps_left_out(
    part: int, tree: ast.FunctionDef, loop: ast.For | ast.While, scope: Scope
) -> Iterator[ProgramEdit]:
    """What a recursion adds to a vector at each turn: ``v = v + cross(w, r)``, ``v += qd[i]*z``."""
    inside = {id(one) for one in nodes(loop)}
    outside = [x for x in nodes(tree) if isinstance(x, ast.Assign) and id(x) not in inside]
    carried = {name for one in outside for name in _sets(one)} & _uses(loop)
    scope.stand([one for one in nodes(tree) if loop in nodes(one)])
    blocks: list[tuple[ast.stmt, str, list[ast.stmt]]] = [(loop, "body", loop.body)]
    for case in (one for one in loop.body if isinstance(one, ast.If)):
        blocks += [(case, "body", case.body), (case, "orelse", case.orelse)]
    for name in sorted(carried):
        shape = scope.shapes.get(name)
        if shape not in _VECTORS:
            continue
        for piece in _terms_of_steps(name, shape, scope):
            given = {*names(piece)}
            for node, field, block in blocks:
                last = [k for k, one in enumerate(block) if given & _sets(one)]
                at = last[-1] + 1 if last else len(block) if node is not loop else 0
                if block and at:
                    term = ast.BinOp(ast.Name(name, ast.Load()), ast.Add(), copied(piece))
                    line = ast.Assign([ast.Name(name, ast.Store())], term)
                    yield line_more(part, node, field, block, at, line, _LEFT_OUT)


def _terms_of_steps(name: str, shape: Shape, scope: Scope) -> Iterator[ast.expr]:
    """What may be added: products with a vector that stand elsewhere, and a rate's with an arm."""
    known = scope.pieces_here(shape)
    for piece in known.values():
        times = isinstance(piece, ast.BinOp) and isinstance(piece.op, ast.Mult)
        if times and name not in names(piece) and len(ast.unparse(piece)) <= _SHORT:
            yield piece
    if scope.cross is not None and shape == _VECTORS[1]:
        plain = [x for x in known.values() if isinstance(x, ast.Name)]
        rates = [x for x in plain if x.id[:1] in "woWO" and x.id != name]
        arms = [x for x in plain if x.id[:1] in "prcPlLdsC" and x.id != name]
        for rate, arm in product(rates[:_FEW], arms[:_NAMES]):
            yield ast.Call(scope.cross, [rate, arm], [])


def _added(
    part: int, loop: ast.For | ast.While, at: int, name: str, piece: ast.expr, cost: float
) -> ProgramEdit:
    """``angle += q[i]`` in a loop."""
    line = ast.AugAssign(ast.Name(name, ast.Store()), ast.Add(), piece)
    return line_more(part, loop, "body", loop.body, at, line, cost)


def _beside(
    part: int, node: ast.AST, name: str, block: list[ast.stmt], scope: Scope
) -> Iterator[ProgramEdit]:
    """The line of the other axis, or of the entry beside: ``fy += Fy`` behind ``fx += Fx``."""
    targets = {ast.unparse(one) for line in block for one in _targets(line)}
    for at, line in enumerate(block):
        target = next(iter(_targets(line)), None)
        if target is None or len(ast.unparse(line)) > _LONG:
            continue
        others = [OtherAxis(scope.shapes).visit(copied(line))]
        if isinstance(target, ast.Subscript):
            if (mirror := _mirrored(target)) is not None:
                yield line_more(part, node, name, block, at + 1, mirror, 1.08)
            for rest in _on_the_rest(line, scope):
                yield line_more(part, node, name, block, at + 1, rest, _ON_THE_REST)
            others += [*_of_other_entries(line, scope)]
            others += [_Stepped(step, scope.shapes).visit(copied(line)) for step in (1, -1)]
        for other in others:
            own = next(iter(_targets(other)))
            text = ast.unparse(own)
            if text in targets or (isinstance(own, ast.Name) and text not in scope.shapes):
                continue
            yield line_more(part, node, name, block, at + 1, other, 1.15)
            if isinstance(own, ast.Subscript):
                turned = copied(other)
                turned.value = ast.UnaryOp(ast.USub(), turned.value)
                yield line_more(part, node, name, block, at + 1, turned, 1.16)


def _never_filled(tree: ast.FunctionDef) -> list[str]:
    """The names of what is made as zeros and never filled."""
    filled = {one.id for one in written_into(tree)}
    made = {
        one.id
        for line in nodes(tree)
        if isinstance(line, ast.Assign)
        for target in line.targets
        for one, value in paired(target, line.value)
        if isinstance(one, ast.Name) and isinstance(value, ast.Call) and called(value) == "zeros"
    }
    return sorted(made - filled)


def _filling(
    part: int, node: ast.AST, name: str, block: list[ast.stmt], scope: Scope, empty: list[str]
) -> Iterator[ProgramEdit]:
    """A line that fills what nothing fills: ``Jw[:, j] = z`` behind ``Jv[:, j] = ...``."""
    for at, line in enumerate(block):
        target = next(iter(_targets(line)), None)
        if not isinstance(target, ast.Subscript) or not isinstance(target.value, ast.Name):
            continue
        shape = scope.shapes.get(target.value.id)
        for other in empty:
            if shape is None or len(shape) != 2 or scope.shapes.get(other) != shape:
                continue
            for _text, vector in scope.simple(shape[:1]):
                own = copied(target)
                own.value = ast.Name(other, ast.Load())
                new = ast.Assign([own], copied(vector))
                yield line_more(part, node, name, block, at + 1, new, _NEVER)


def _of_twins(part: int, node: ast.AST, name: str, block: list[ast.stmt]) -> Iterator[ProgramEdit]:
    """What is done to one of two things that begin alike, to the other: ``low[i] -= h``."""
    begun: dict[str, list[str]] = {}
    for line in block:
        for target in line.targets if isinstance(line, ast.Assign) else ():
            assert isinstance(line, ast.Assign)
            for one, value in paired(target, line.value):
                if isinstance(one, ast.Name) and not isinstance(value, ast.Constant):
                    begun.setdefault(ast.unparse(value), []).append(one.id)
    added = [(at, one) for at, one in enumerate(block) if isinstance(one, ast.AugAssign)]
    moved = {root(line.target) for _at, line in added}
    for at, line in added:
        own = root(line.target)
        for alike in begun.values():
            for other in alike if own in alike else ():
                if other not in moved:
                    new = OtherName(own, other).visit(copied(line))
                    new.op = ast.Sub() if isinstance(line.op, ast.Add) else ast.Add()
                    yield line_more(part, node, name, block, at + 1, new, 1.05)


def _of_unused(
    part: int,
    tree: ast.FunctionDef,
    node: ast.AST,
    name: str,
    block: list[ast.stmt],
    scope: Scope,
) -> Iterator[ProgramEdit]:
    """The last column of a transform, of what nothing else uses: ``T[:3, 3] = x, y, z``."""
    known = scope.shapes
    idle = [one for one in known if one in scope.unused]
    given = [one.arg for one in tree.args.args if one.arg not in _uses(tree)]
    scalars: list[ast.expr] = [ast.Name(x, ast.Load()) for x in given if known.get(x, ()) == ()]
    columns: list[ast.expr] = []
    if len(scalars) == _COLUMN[0]:
        columns.append(ast.Tuple(scalars, ast.Load()))
    for one in idle:
        if known[one] == _COLUMN:
            vector = ast.Name(one, ast.Load())
            columns.append(vector)
            for other in (x for x in known if known[x] == _COLUMN and x != one):
                if scope.cross is not None:
                    for both in ((one, other), (other, one)):
                        args: list[ast.expr] = [ast.Name(x, ast.Load()) for x in both]
                        columns.append(ast.Call(scope.cross, args, []))
    for at, line in enumerate(block) if columns else ():
        target = next(iter(_targets(line)), None)
        if isinstance(target, ast.Name) and known.get(target.id) == _POSE:
            where = ast.parse(f"{target.id}[:3, 3] = 0").body[0]
            assert isinstance(where, ast.Assign)
            for column in columns:
                new = copied(where)
                new.value = column
                yield line_more(part, node, name, block, at + 1, new, 1.1)


_COLUMN, _POSE = (3,), (4, 4)


class _Stepped(ast.NodeTransformer):
    """Of a joint, or a link, what is there of the next one, or of the one before."""

    def __init__(self, step: int, known: Container[str]) -> None:
        self.step, self.known = step, known

    def visit_Name(self, node: ast.Name) -> ast.expr:
        stem = node.id.rstrip("0123456789")
        digits = node.id[len(stem) :]
        name = f"{stem}{int(digits) + self.step}" if digits else ""
        return ast.Name(name, node.ctx) if name in self.known else node

    def visit_Subscript(self, node: ast.Subscript) -> ast.expr:
        node.value = self.visit(node.value)
        keys = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        for key in keys:
            if isinstance(key, ast.Constant) and type(key.value) is int:
                key.value = max(key.value + self.step, 0)
        return node


def _targets(line: ast.stmt) -> list[ast.expr]:
    if isinstance(line, ast.Assign) and len(line.targets) == 1:
        return line.targets
    return [line.target] if isinstance(line, ast.AugAssign) else []


def _mirrored(target: ast.Subscript) -> ast.stmt | None:
    """The entry on the other side of the diagonal: ``M[j, i] = M[i, j]``."""
    keys = _keys(target)
    if len(keys) != 2 or any(isinstance(one, ast.Slice) for one in keys):
        return None
    if ast.unparse(keys[0]) == ast.unparse(keys[1]):
        return None
    other = copied(target)
    other.slice = ast.Tuple([keys[1], keys[0]], ast.Load())
    value = copied(target)
    value.ctx = ast.Load()
    return ast.Assign([other], value)


def _of_other_entries(line: ast.stmt, scope: Scope) -> Iterator[ast.stmt]:
    """Lines that set an entry beside, as the line's turned value, or the entries left."""
    target = _entry_of(line)
    assert isinstance(line, ast.Assign | ast.AugAssign)
    keys = _keys(target)
    sizes = scope.observed.shape(target.value) or ()
    for k, key in enumerate(keys):
        if isinstance(key, ast.Constant) and type(key.value) is int:
            for step in (1, -1):
                if key.value + step >= 0:
                    other = Turned(scope.shapes).visit(copied(line))
                    _put(_entry_of(other), k, ast.Constant(key.value + step))
                    yield other
        elif isinstance(key, ast.Slice):
            shape = scope.observed.shape(line.value) or ()
            rest = _complement(key, sizes[k]) if k < len(sizes) else None
            if isinstance(rest, ast.Constant):
                shape = shape[:-1]
            if rest is None or not shape:
                continue
            for _text, piece in scope.simple(shape):
                other = copied(line)
                _put(_entry_of(other), k, rest)
                other.value = piece
                yield other


def _on_the_rest(line: ast.stmt, scope: Scope) -> Iterator[ast.stmt]:
    """What is done to some rows in place, to the others: ``J[3:] = R @ J[3:]``."""
    target = _entry_of(line)
    sizes, own = scope.observed.shape(target.value) or (), ast.unparse(target)
    for k, key in enumerate(_keys(target)[: len(sizes)]):
        rest = _complement(key, sizes[k]) if isinstance(key, ast.Slice) else None
        if isinstance(rest, ast.Slice):
            other = copied(line)
            same = [x for x in nodes(other) if isinstance(x, ast.Subscript)]
            same = [x for x in same if ast.unparse(x) == own]
            for one in same:
                _put(one, k, copied(rest))
            if len(same) > 1:  # it is set, and used
                yield other


def _entry_of(line: ast.stmt) -> ast.Subscript:
    """What a line sets, of one that sets an entry."""
    target = _targets(line)[0]
    assert isinstance(target, ast.Subscript)
    return target


def _keys(entry: ast.Subscript) -> list[ast.expr]:
    return entry.slice.elts if isinstance(entry.slice, ast.Tuple) else [entry.slice]


def _put(entry: ast.Subscript, k: int, key: ast.expr) -> None:
    if isinstance(entry.slice, ast.Tuple):
        entry.slice.elts[k] = key
    else:
        entry.slice = key


def _complement(key: ast.Slice, size: int) -> ast.expr | None:
    """The entries that a slice from, or up to, a place leaves."""
    if key.step is not None or (key.lower is None) == (key.upper is None):
        return None
    if key.upper is not None and ast.unparse(key.upper) == str(size - 1):
        return key.upper
    return ast.Slice(key.upper, key.lower, None)


def _sets(node: ast.AST) -> set[str]:
    return {*names(node, ast.Store)}


def _uses(node: ast.AST) -> set[str]:
    return {*names(node, ast.Load)}


def _fills(node: ast.AST) -> set[str]:
    """The names that are set, and those of what is written into: ``S[:3, 3] = v``."""
    return _sets(node) | {one.id for one in written_into(node)}
