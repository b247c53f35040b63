"""Terms like those of a sum with other names throughout: ``l2*w2**2*e2`` beside ``l1*w1**2*e1``.

What is whose counterpart is told by what stands side by side in one form: two entries of a row, two
statements, the names to which one call's answers are given.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from itertools import pairwise

from kinlab.doctor.bytecode.syntax import nodes, text_of
from kinlab.doctor.derivations.words import minus
from kinlab.doctor.program.edits.exchanges import Renamed
from kinlab.doctor.program.edits.scope.forms import summands
from kinlab.doctor.program.places import ProgramEdit
from kinlab.doctor.program.trial import FieldChange

_COST = 1.07
"""Cost of a term that is as another one of the sum, with counterparts for its names."""
_BESIDE = 4
"""Entries of a row, or terms of a sum, of which any two are compared."""
_WAYS = 12
"""How many sets of counterparts are tried."""
_LEAST = 2
"""Names of a term that must have counterparts: one name for another is tried elsewhere."""

Names = dict[str, str]


def of_counterparts(part: int, tree: ast.AST) -> Iterator[ProgramEdit]:
    """The sums of a part with a term more that is as one of theirs."""
    ways = [*_ways(tree)]
    for line in nodes(tree) if ways else ():
        if not isinstance(line, ast.Assign | ast.Return) or line.value is None:
            continue
        known = {text_of(term) for term in summands(line.value)}
        for term in summands(line.value):
            for way in ways:
                other = _renamed(term, way)
                if other is not None and text_of(other) not in known:
                    known.add(text_of(other))
                    new = _with(line.value, term, other)
                    change = FieldChange(line, "value", new)
                    yield ProgramEdit(part, (change,), "missing term", _COST, line.value)


def _with(value: ast.expr, term: ast.expr, other: ast.expr) -> ast.expr:
    """A sum with another term, which has the sign of the one that it is like."""
    taken = any(
        isinstance(node, ast.BinOp) and isinstance(node.op, ast.Sub) and node.right is term
        for node in nodes(value)
    )
    opposite = minus(other)
    if not taken and len(text_of(opposite)) < len(text_of(other)):  # it begins with a minus
        taken, other = True, opposite
    return ast.BinOp(value, ast.Sub() if taken else ast.Add(), other)


def _renamed(term: ast.expr, way: Names) -> ast.expr | None:
    """A term with the counterparts of its names; None where too few have one."""
    pieces = (text_of(one) for one in nodes(term) if isinstance(one, _PIECES))
    others = {x: ast.parse(way[x], mode="eval").body for x in pieces if x in way}
    return Renamed(others).of(term) if len(others) >= _LEAST else None


def _ways(tree: ast.AST) -> Iterator[Names]:
    """Sets of counterparts, each also the other way round."""
    following: Names = {}
    for row in nodes(tree):
        if isinstance(row, ast.Tuple) and isinstance(row.ctx, ast.Store):
            told = [one.id for one in row.elts if isinstance(one, ast.Name)]
            following |= dict(pairwise(told)) if len(told) == len(row.elts) else {}
    known: list[Names] = []
    for one, other in _beside(tree):
        way = _counterparts(one, other)
        if way and way not in known:
            known.append(way)
    preceding = {last: first for first, last in following.items()}
    for way in known[:_WAYS]:
        back = {last: first for first, last in way.items()}
        for each, more in ((way, following), (back, preceding)):
            taken = {*each, *each.values()}
            yield each | {x: y for x, y in more.items() if not {x, y} & taken}


def _beside(tree: ast.AST) -> Iterator[tuple[ast.AST, ast.AST]]:
    """What stands side by side: entries of rows, terms of sums, statements that set names."""
    for node in nodes(tree):
        groups: list[Sequence[ast.AST]] = []
        if isinstance(node, ast.List | ast.Tuple) and isinstance(node.ctx, ast.Load):
            groups = [node.elts]
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            groups = [[*summands(node)]]
        for field in ("body", "orelse"):
            block = getattr(node, field, None)
            if isinstance(block, list):
                lines = [one for one in block if isinstance(one, ast.Assign)]
                yield from pairwise(lines)
        for group in groups:
            if len(group) <= _BESIDE:
                yield from ((x, y) for k, x in enumerate(group) for y in group[k + 1 :])


def _counterparts(one: ast.AST, other: ast.AST) -> Names:
    """The names of two pieces of one form that are not the same; none where the form is not.

    A name may have an entry of a list for its counterpart: ``m*c`` and ``mass[j]*ci``.
    """
    found: Names = {}
    waiting = [(one, other)]
    while waiting:
        x, y = waiting.pop()
        if isinstance(x, ast.Name) or (isinstance(y, ast.Name) and isinstance(x, _PIECES)):
            if not isinstance(y, _PIECES) or found.setdefault(text_of(x), text_of(y)) != text_of(y):
                return {}
            continue
        if type(x) is not type(y):
            return {}
        if isinstance(x, ast.Constant) and isinstance(y, ast.Constant) and x.value != y.value:
            return {}
        if isinstance(x, ast.Attribute) and isinstance(y, ast.Attribute) and x.attr != y.attr:
            return {}
        inside = [[*ast.iter_child_nodes(node)] for node in (x, y)]
        if len(inside[0]) != len(inside[1]):
            return {}
        waiting += zip(*inside, strict=True)
    found = {x: y for x, y in found.items() if x != y}
    return found if len({*found.values()}) == len(found) else {}


_PIECES = (ast.Name, ast.Subscript)
