"""Terms with what a program holds and never reads: a rotor's inertia times an acceleration.

A column of its table, a key of its records or a name that nothing asks for was mostly meant for a
term that has been forgotten.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import names, nodes, text_of
from kinlab.doctor.program.edits.scope.part import Scope, standing
from kinlab.doctor.program.grounds.dimensions import Dimensions
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import Here, ProgramEdit
from kinlab.doctor.program.trial import Trial
from kinlab.tolerances import TOLERANCES

_FITTING, _MOVING, _BESIDE = 1.02, 1.05, 0.03
"""Cost of a term of the sum's dimension; of one with an acceleration, of which none is known; what
a further factor adds."""
_VECTOR, _ORIGIN = (3,), 3
"""Shape of a point; the column of a frame's transform in which it stands."""
_AT_HAND, _MOST = 24, 40
"""Numbers, or vectors, by which it may be multiplied; terms of one place."""
_ACCELERATIONS = re.compile(
    r"\w*dd\d*|\w*ddot\d*|dd\w+|\w*acc\w*|\w*alpha\w*|a\d*|al\d*|dw\d*|wd\d*|domega|omegad|\w+pp",
    re.IGNORECASE,
)
_SET = ast.Assign | ast.AugAssign | ast.Return


def unread_terms(
    trial: Trial, observed: Observed, scopes: Sequence[Scope], known: Dimensions
) -> Iterator[ProgramEdit]:
    """Products with what nothing reads, which a sum may lack.

    Args:
        trial: a program.
        observed: its expressions.
        scopes: those of its parts.
        known: their dimensions.
    """
    unread = [[*_unread(trial, part)] for part in range(len(trial.trees))]
    for here, scope in standing(trial, scopes, _is_sum):
        shape = observed.shape(here.node)
        idle = [*unread[here.part], *_names(scope)]
        own, size = text_of(here.node), known.of(here.node)
        if shape is None or len(shape) > 1 or not idle or not (size or _is_summed(here, own)):
            continue
        found: list[tuple[float, ast.expr]] = []
        beside = [*_axes_beside(here.node, scope)] if shape == _VECTOR else []
        for term, factors in _products(scope, [*_each(scope, idle)], shape, beside):
            made = known.of_made(term)
            gap = None if size is None or made is None else abs(made - size)
            if text_of(term) in own or (gap is not None and gap > TOLERANCES.tried_further):
                continue
            moving = any(map(_is_acceleration, factors))
            axis = any(one is other for one in factors for other in beside)
            lost = gap is None and any(one in scope.unused for one in names(term))
            if gap is not None or moving or axis or lost:
                more = _BESIDE * (len(factors) - 1)
                sure = axis or (gap is not None and moving)
                found.append(((_FITTING if sure else _MOVING) + more, term))
        found.sort(key=lambda one: one[0])
        for cost, term in found[:_MOST]:
            yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", cost)


def _is_sum(here: Here) -> bool:
    """Whether it is all that is set or returned, and no number or list as it is typed."""
    literal = isinstance(here.node, ast.Constant | ast.List | ast.Tuple)
    return isinstance(here.node, ast.expr) and isinstance(here.parent, _SET) and not literal


def _is_summed(here: Here, own: str) -> bool:
    """Whether it is added to what was there before, returned, or put into a row."""
    targets = here.parent.targets if isinstance(here.parent, ast.Assign) else []
    row = any(isinstance(one, ast.Subscript) for one in targets)
    return row or not targets or own.startswith(tuple(f"{text_of(one)} + " for one in targets))


def _names(scope: Scope) -> Iterator[tuple[ast.expr, Shape]]:
    """Numbers and rows that have a name, and entries and attributes of what nothing uses."""
    for shape, pieces in scope.pieces.items():
        for text in pieces if len(shape) < 2 else ():
            one = scope.pieces_here(shape).get(text)
            if isinstance(one, ast.Name | ast.Subscript | ast.Attribute) and scope.uses_idle(one):
                yield one, shape


def _unread(trial: Trial, part: int) -> Iterator[tuple[ast.expr, Shape]]:
    """Entries like others of a part, with a key that no part asks for: ``P[i, 10]``, ``I``."""
    asked: dict[str, set[Any]] = {}
    for node in (node for tree in trial.trees for node in nodes(tree)):
        asked.setdefault(_base(node), set()).update(_key(node))
    found: dict[str, tuple[ast.expr, Shape]] = {}
    for node in nodes(trial.trees[part]):
        if isinstance(node, ast.Subscript) and _key(node):
            for key, shape in _held(trial, node).items():
                if key not in asked[_base(node)]:
                    new = _with_key(node, key)
                    found.setdefault(text_of(new), (new, shape))
    yield from found.values()


def _each(scope: Scope, idle: Sequence[tuple[ast.expr, Shape]]) -> Iterator[tuple[ast.expr, Shape]]:
    """These, and of rows the entry of each counter."""
    for one, shape in idle:
        entries = sorted(scope.counting) if len(shape) == 1 else []
        for counter in entries:
            yield ast.Subscript(one, ast.Name(counter, ast.Load()), ast.Load()), ()
        if not entries:
            yield one, shape


def _base(node: ast.AST) -> str:
    """The name of a table, of which an entry is read."""
    while isinstance(node, ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def _key(node: ast.AST) -> set[Any]:
    """The columns that ``P[i, 3]`` and ``P[i, 4:7]`` read, the key of ``ROD["m"]``."""
    if not isinstance(node, ast.Subscript) or not isinstance(node.value, ast.Name):
        return set()
    key: Any = node.slice
    if isinstance(key, ast.Tuple) and len(key.elts) > 1:
        key = key.elts[1]
        if isinstance(key, ast.Slice):
            first, last = (getattr(one, "value", None) for one in (key.lower, key.upper))
            return {*range(first, last)} if type(first) is type(last) is int else set()
        return {key.value} if type(getattr(key, "value", None)) is int else set()
    return {key.value} if isinstance(getattr(key, "value", None), str) else set()


def _held(trial: Trial, node: ast.Subscript) -> dict[Any, Shape]:
    """The keys, or columns, that a table of the module has, and the shapes of what they hold."""
    table = trial.space.get(_base(node))
    by_key = isinstance(node.slice, ast.Constant)
    if isinstance(table, dict) and by_key:
        return {key: shape for key, x in table.items() if (shape := _shape(x)) is not None}
    if isinstance(table, np.ndarray) and table.ndim == 2 and not by_key:
        return {k: () for k in range(table.shape[1]) if table[:, k].any()}
    return {}


def _shape(value: Any) -> Shape | None:
    """Of a number, or a row of numbers."""
    try:
        shape = np.asarray(value, dtype=float).shape
    except (TypeError, ValueError):
        return None
    return shape if len(shape) < 2 else None


def _with_key(node: ast.Subscript, key: Any) -> ast.Subscript:
    own = node.slice
    other: ast.expr = ast.Constant(key)
    if isinstance(own, ast.Tuple):
        other = ast.Tuple([own.elts[0], other], ast.Load())
    return ast.Subscript(node.value, other, ast.Load())


def _products(
    scope: Scope,
    idle: Sequence[tuple[ast.expr, Shape]],
    shape: Shape,
    beside: Sequence[ast.expr],
) -> Iterator[tuple[ast.expr, list[ast.expr]]]:
    """What is unread times a number, or a row; of a number also times both, each with these."""
    numbers, rows = ([*_worked_out(scope, size)][:_AT_HAND] for size in ((), shape))
    rows = [*beside, *rows]
    lists = [(x, size) for size in scope.pieces if len(size) == 1 for x in _worked_out(scope, size)]
    entries = _each(scope, [x for x in lists if _is_acceleration(x[0])])
    told = {*map(text_of, numbers)}
    numbers += [one for one, size in entries if size == () and text_of(one) not in told]
    moving = [*filter(_is_acceleration, numbers)]
    for entry, size in idle:
        if size == shape:
            some = [*filter(_is_acceleration, rows)] if shape else []
            yield from ((_times(entry, one), [one]) for one in (*numbers, *some))
        elif size == ():
            yield from ((_times(entry, row), [row]) for row in rows)
            yield from ((_times(_times(entry, x), row), [x, row]) for x in moving for row in rows)


def _axes_beside(node: ast.expr, scope: Scope) -> Iterator[ast.expr]:
    """Axes of the frame of an origin: ``z[6]`` of ``p[6]``, ``T[:3, 2]`` of ``T[:3, 3]``."""
    key = node.slice if isinstance(node, ast.Subscript) else None
    if not isinstance(node, ast.Subscript) or key is None:
        return
    if isinstance(key, ast.Tuple):
        if getattr(key.elts[-1], "value", None) == _ORIGIN:
            for k in reversed(range(_ORIGIN)):
                column = ast.Tuple([*key.elts[:-1], ast.Constant(k)], ast.Load())
                yield ast.Subscript(node.value, column, ast.Load())
        return
    own, of = text_of(node.value), scope.observed.shape(node.value)
    for name, shape in scope.shapes.items():
        if name != own and (shape == of or (of is None and name in scope.lists)):
            yield ast.Subscript(ast.Name(name, ast.Load()), key, ast.Load())


def _worked_out(scope: Scope, shape: Shape) -> Iterator[ast.expr]:
    """What is given to the part, or worked out in it: no number of the module's own."""
    for text, one in scope.simple(shape):
        own = {*names(one)} - {*scope.counters}
        if text not in scope.counters and own and own.isdisjoint(scope.space):
            yield one


def _times(one: ast.expr, other: ast.expr) -> ast.expr:
    return ast.BinOp(one, ast.Mult(), other)


def _is_acceleration(node: ast.expr) -> bool:
    """Whether a name, or what an entry is of, is called as an acceleration is."""
    inside = names(node)
    return bool(inside) and _ACCELERATIONS.fullmatch(next(iter(inside))) is not None
