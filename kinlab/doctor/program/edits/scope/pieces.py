"""Expressions that may stand somewhere, by their shapes and their text."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence

from kinlab.doctor.bytecode.syntax import copied, nodes, text_of
from kinlab.doctor.program.edits.scope.forms import entry, named, summands
from kinlab.doctor.program.observed import Observed, Shape

Pieces = dict[Shape, dict[str, ast.expr]]
Sized = tuple[Shape, ast.expr]
"""An expression, and its shape."""
_SQUARES = {(2, 2), (3, 3), (4, 4)}
"""Shapes of matrices to which the unit matrix may be added."""
_SHORT = 7
"""Entries of a row of which any may be meant."""


def put(pieces: Pieces, shape: Shape, piece: ast.expr) -> None:
    """Adds an expression to those of its shape, if none of them reads like it."""
    pieces.setdefault(shape, {}).setdefault(ast.unparse(piece), piece)


def others_of_the_row(node: ast.expr, observed: Observed) -> Iterator[ast.expr]:
    """The other entries of a row of which one is used, the other columns: ``T[:3, 3]``."""
    if not isinstance(node, ast.Subscript):
        return
    sizes = observed.shape(node.value) or ()
    key = node.slice
    if isinstance(key, ast.Constant) and type(key.value) is int:
        for k in range(sizes[0] if len(sizes) == 1 and sizes[0] <= _SHORT else 0):
            yield entry(copied(node.value), ast.Constant(k))
    elif isinstance(key, ast.Tuple) and isinstance(key.elts[0], ast.Slice) and sizes == (4, 4):
        column = key.elts[-1]
        if isinstance(column, ast.Constant) and type(column.value) is int:
            for k in range(sizes[1]):
                other = ast.Tuple([copied(key.elts[0]), ast.Constant(k)], ast.Load())
                yield entry(copied(node.value), other)


def unit_matrices(pieces: Pieces) -> Iterator[Sized]:
    """The unit matrices of the sizes of the matrices that occur."""
    for size in _SQUARES & pieces.keys():
        yield size, ast.parse(f"np.eye({size[0]})", mode="eval").body


def summed_from(tree: ast.AST) -> dict[str, list[ast.expr]]:
    """The entries of which names are the sums."""
    found: dict[str, list[ast.expr]] = {}
    for line in nodes(tree):
        if not isinstance(line, ast.Assign) or not isinstance(line.value, ast.BinOp):
            continue
        name, terms = line.targets[0], summands(line.value)
        entries: list[ast.expr] = [one for one in terms if isinstance(one, ast.Subscript)]
        if isinstance(name, ast.Name) and len(entries) > 1:
            found[name.id] = entries
    return found


def sums_with(tree: ast.AST) -> dict[str, list[str]]:
    """The names that are set to sums with an entry in them, by its text: ``px = r[0] - s*e``."""
    found: dict[str, list[str]] = {}
    for line in nodes(tree):
        if isinstance(line, ast.Assign) and isinstance(line.value, ast.BinOp):
            terms = [*summands(line.value)]
            entries = [one for one in terms if isinstance(one, ast.Subscript)]
            for one in entries if len(terms) > 1 else ():
                own = [x.id for x in line.targets if isinstance(x, ast.Name)]
                found.setdefault(text_of(one), []).extend(own)
    return found


def counted(lists: Mapping[str, Shape], counters: Sequence[str]) -> Iterator[Sized]:
    """The entries of lists that counters count: ``m[i]``."""
    for name, shape in lists.items():
        for counter in counters:
            yield shape, entry(named(name), named(counter))


def read_from(tree: ast.AST) -> set[str]:
    """The names of lists of which an entry is read."""
    every = (node for node in nodes(tree) if isinstance(node, ast.Subscript))
    loads = [one for one in every if isinstance(one.ctx, ast.Load)]
    return {one.value.id for one in loads if isinstance(one.value, ast.Name)}


def of_the_next(
    pieces: Pieces, lists: Mapping[str, Shape], unread: Sequence[str]
) -> Iterator[Sized]:
    """The entries of lists that nothing reads, where others are asked for: ``P[i + 1]``."""
    every = [x for some in pieces.values() for x in some.values() if isinstance(x, ast.Subscript)]
    keys = {ast.unparse(x.slice): x.slice for x in every if isinstance(x.slice, ast.BinOp)}
    for name in unread:
        for key in keys.values() if lists.get(name) else ():
            yield lists[name], ast.Subscript(named(name), key, ast.Load())
