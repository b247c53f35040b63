"""Vectors and matrices that a sum may lack, made of what is at hand and of the sum's dimension."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from itertools import combinations
from typing import TypeGuard

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, copied, names, nodes, targets_of, text_of
from kinlab.doctor.program.edits.additions import OtherName
from kinlab.doctor.program.edits.scope.forms import statement_of, summands
from kinlab.doctor.program.edits.scope.part import Scope, standing
from kinlab.doctor.program.grounds.dimensions import Dimensions
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import Here, ProgramEdit
from kinlab.doctor.program.trial import Trial
from kinlab.tolerances import TOLERANCES

_VECTOR = (3,)
_VECTORS, _SCALARS, _MADE, _FACTORS = 10, 10, 4, 24
"""Names and numbers of which a term may be, things that are made of several; factors of squares."""
_MOST, _FEW = 40, 12
"""Terms that may be missing in one place; of a dimension that is not known."""
_IDLE, _USED = 1.06, 1.17
"""What a term is far-fetched with a name that is used nowhere else, and without one."""
_CROSSED = 1.1
"""The same of a product of two vectors with such a name, of which no dimension is known."""
_TRANSPORTED = 1.08
"""The same of a cross product with a rate about an axis, where the axis stands in the sum."""
_CARRIED = 1.04
"""The same of a moment about another point, where one of these stands in the sum."""
_HIDDEN = 0.12
"""What that costs less where a unit vector for qdd hides the dimension of the sum."""
_COPIED = 0.02
"""What it is likelier beside what is only another name for something: ``n3 = ni``."""
_NEXT = 0.98
"""What one is with which each of the arm's links has its own."""
_OF_SEVERAL, _OF_IDLE, _FITTING = 1.0, 1.05, 1.08
"""The same of products of matrices: of several such names, of one; that fit a twist's entries."""
_NEAR, _JUST_SET = 2, 1.05
"""Lines above in which a matrix is set, and what one with a vector is far-fetched then."""
_SET = ast.Assign | ast.AugAssign | ast.Return


def missing_terms(
    trial: Trial, observed: Observed, scopes: Sequence[Scope], known: Dimensions
) -> Iterator[ProgramEdit]:
    """The term of another link; a vector times a number, a product of two vectors.

    Args:
        trial: a program.
        observed: its expressions.
        scopes: those of its parts.
        known: their dimensions.
    """
    beside: set[str] = set()
    for here, scope in standing(trial, scopes, _is_whole):
        if observed.shape(here.node) is not None:
            for new, cost in _of_other_links(here, scope):
                beside.add(text_of(new))
                yield here.instead(ast.BinOp(here.node, ast.Add(), new), "missing term", cost)
    for here, scope in standing(trial, scopes, _is_whole):
        shape = observed.shape(here.node)
        if shape is not None:
            yield from _of_matrices(here, scope, known, shape, beside)
        if shape is not None and len(shape) == 1:
            yield from _of_dimension(here, scope, known, shape)


def _is_whole(here: Here) -> bool:
    """Whether it is an expression that is all that is set, or that is put into a list."""
    if not isinstance(here.node, ast.expr):
        return False
    kept = isinstance(here.parent, ast.Call) and called(here.parent) == "append"
    literal = isinstance(here.node, ast.Constant | ast.List | ast.Tuple)
    return (kept or isinstance(here.parent, _SET)) and not literal


def _of_other_links(here: Here, scope: Scope) -> Iterator[tuple[ast.expr, float]]:
    """``I2*Jw2.T @ Jw2`` beside ``I1*Jw1.T @ Jw1``: each of its names is the other link's."""
    terms = [*summands(here.node)]
    own = {text_of(one) for one in terms}
    for term in terms:
        digits = {name[-1] for name in names(term) if name[-1:].isdigit()}
        for digit in sorted(digits) if len(digits) == 1 else ():
            for other in (str(int(digit) + step) for step in (1, -1)):
                new: ast.AST = copied(term)
                numbered = {name for name in names(term) if name.endswith(digit)}
                others = {name: name[:-1] + other for name in sorted(numbered)}
                if not {*others.values()} <= scope.shapes.keys():
                    continue
                for name, instead in others.items():
                    new = OtherName(name, instead).visit(new)
                if isinstance(new, ast.expr) and text_of(new) not in own:
                    idle = not scope.unused.isdisjoint(others.values())
                    yield new, _NEXT if idle else _USED


def _of_dimension(
    here: Here, scope: Scope, known: Dimensions, shape: Shape
) -> Iterator[ProgramEdit]:
    size, own = known.of(here.node), text_of(here.node)
    seen = scope.observed.of(here.node)  # nothing but zeros has no dimension
    zeros = seen is not None and not any(map(np.any, seen.values))
    found: list[tuple[float, ast.expr]] = []
    carried = {text_of(one): one for one in _carried(here.node, scope)}
    for term in (*carried.values(), *_terms(scope, shape)):
        made, idle = known.of_made(term), scope.uses_idle(term)
        told = None if size is None or made is None else abs(made - size)
        transported = _is_transported(term, here)
        if (told is None and not idle and not transported) or text_of(term) in own:
            continue
        if told is not None and told <= TOLERANCES.tried_further and text_of(term) in carried:
            found.append((_CARRIED, term))
            continue
        if told is None or told <= TOLERANCES.tried_further or transported:
            sure, crossed = told is not None or zeros, isinstance(term, ast.Call)
            cost = _IDLE if idle and sure else _CROSSED if idle and crossed else _USED
            if transported:
                hidden = told is not None and told > TOLERANCES.tried_further
                cost = _TRANSPORTED - _HIDDEN * hidden
            cost -= _COPIED * (crossed and isinstance(here.node, ast.Name))
            found.append((cost, term))
    found.sort(key=lambda one: one[0])
    for cost, term in found[: _MOST if size is not None or zeros else _FEW]:
        yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", cost)


def _carried(node: ast.expr, scope: Scope) -> Iterator[ast.expr]:
    """``cross(p - pb, f)`` beside ``cross(c - pb, m*g)``: other vectors about the same point."""
    crossed = (x for x in summands(node) if isinstance(x, ast.Call) and called(x) == "cross")
    for term in crossed:
        arm = term.args[0]
        if not isinstance(arm, ast.BinOp) or not isinstance(arm.op, ast.Sub):
            continue
        kept = {text_of(arm.left), text_of(arm.right)}
        vectors = [(text, one) for text, one in scope.simple(_VECTOR) if text not in kept]
        for text, point in vectors[:_VECTORS]:
            for other, vector in vectors[:_VECTORS]:
                if other != text:
                    away = ast.BinOp(point, ast.Sub(), arm.right)
                    yield ast.Call(term.func, [away, vector], [])


def _is_transported(term: ast.expr, here: Here) -> bool:
    """Whether a term is ``cross(w, qd*z)``, the sum has ``qdd*z``, and w a line with ``qd*z``.

    The sum may be asked of a unit vector for qdd, which has no dimension.
    """
    if not isinstance(term, ast.Call) or not _is_scaled(term.args[-1]):
        return False
    turning, rate = map(text_of, term.args)
    axes = [text_of(one.right) for one in summands(here.node) if _is_scaled(one)]
    if text_of(term.args[-1].right) not in axes:
        return False
    lines = [one for one in nodes(here.above[0]) if isinstance(one, ast.Assign | ast.AugAssign)]
    sums = (one.value for one in lines if turning in map(text_of, targets_of(one)))
    return any(rate in map(text_of, summands(one)) for one in sums)


def _is_scaled(node: ast.expr) -> TypeGuard[ast.BinOp]:
    """Whether it is a number times a vector: ``qd[i]*z``."""
    return (
        isinstance(node, ast.BinOp)
        and isinstance(node.op, ast.Mult)
        and isinstance(node.left, ast.Name | ast.Subscript | ast.Attribute)
        and isinstance(node.right, ast.Name | ast.Subscript | ast.Attribute)
    )


def _of_matrices(
    here: Here, scope: Scope, known: Dimensions, shape: Shape, beside: AbstractSet[str]
) -> Iterator[ProgramEdit]:
    """Products of matrices: of what is set and used nowhere, and what only fits by dimensions.

    But none that another link's stands beside in some line.
    """
    size = known.of_entries(here.node)
    own = {*beside, *map(text_of, summands(here.node))}
    line = statement_of(here.above).lineno
    found: list[tuple[float, int, ast.expr]] = []
    just_set: list[tuple[float, int, ast.expr]] = []
    for term in _matrix_products(scope, shape):
        if text_of(term) in own or any(scope.set_at.get(x, 0) > line for x in names(term)):
            continue
        made = known.of_entries(term)
        told = size is not None and made is not None and _compared(size, made)
        used = len({*names(term)} - scope.unused)
        if told and size is not None and made is not None and not _fits(size, made):
            continue
        if scope.uses_idle(term):
            several = len(scope.unused.intersection(names(term))) > 1
            found.append((_OF_SEVERAL if several else _OF_IDLE, used, term))
        elif told and size is not None and _varies(size):
            found.append((_FITTING, used, term))
        elif not told and len(shape) == 1 and 0 < line - scope.set_at.get(_front(term), 0) <= _NEAR:
            just_set.append((_JUST_SET, used, term))
    found.sort(key=lambda one: one[:2])
    for cost, _used, term in (*found[:_FEW], *just_set[:_FEW]):
        yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", cost)


def _front(term: ast.expr) -> str:
    """The name of the matrix in front of a product."""
    return term.left.id if isinstance(term, ast.BinOp) and isinstance(term.left, ast.Name) else ""


def _compared(size: Array, made: Array) -> bool:
    """Whether at least half of what is known of the sum's entries is known of a term's."""
    both = np.isfinite(size) & np.isfinite(made)
    return bool(2 * np.count_nonzero(both) >= np.count_nonzero(np.isfinite(size)) > 0)


def _fits(size: Array, made: Array) -> bool:
    """Whether the entries of a term are of the dimensions of the sum's, where both are known."""
    apart = np.abs(size - made) > TOLERANCES.tried_further
    return not apart.any()


def _varies(size: Array) -> bool:
    """Whether the entries are of several dimensions, as those of a twist: little fits by chance."""
    return bool(np.nanmax(size) - np.nanmin(size) > TOLERANCES.tried_further)


def _matrix_products(scope: Scope, shape: Shape) -> Iterator[ast.expr]:
    """``J.T @ I @ J`` and ``m*J.T @ J`` as a matrix, ``A @ v`` as a vector, ``f @ v`` alone."""
    every = {size: [one for _text, one in scope.simple(size)] for size in scope.pieces if size}
    for some in every.values():
        some.sort(key=lambda one: not scope.uses_idle(one))
    simple = {size: some[:_VECTORS] for size, some in every.items()}
    matrices = [(size, one) for size, some in simple.items() if len(size) == 2 for one in some]
    if shape == ():
        rows = [some for size, some in simple.items() if len(size) == 1 < size[0]]
        for left, right in (both for some in rows for both in combinations(some, 2)):
            if scope.uses_idle(left) or scope.uses_idle(right):
                yield _times(left, right)
    for (height, width), matrix in matrices:
        across = ast.Attribute(matrix, "T", ast.Load())
        if shape == (height,):
            yield from (_times(matrix, vector) for vector in simple.get((width,), ()))
        if shape == (width,):
            yield from (_times(across, vector) for vector in simple.get((height,), ()))
        if shape == (width, width):
            yield from _squares(scope, matrix, simple.get((height, height), []))


def _squares(scope: Scope, matrix: ast.expr, inner: Sequence[ast.expr]) -> Iterator[ast.expr]:
    """``J.T @ I @ J``, where either is used nowhere, and such a matrix's own, times a number."""
    across, idle = ast.Attribute(matrix, "T", ast.Load()), scope.uses_idle(matrix)
    for one in inner:
        if one is not matrix and (idle or scope.uses_idle(one)):
            yield _times(_times(across, one), matrix)
    if idle:
        yield _times(across, matrix)
        for scalar in [one for _text, one in scope.simple(())][:_FACTORS]:
            yield _times(ast.BinOp(scalar, ast.Mult(), across), matrix)


def _times(one: ast.expr, other: ast.expr) -> ast.expr:
    return ast.BinOp(one, ast.MatMult(), other)


def _terms(scope: Scope, shape: Shape) -> Iterator[ast.expr]:
    """A vector times a number, and of vectors in space the products of two."""
    pieces = scope.pieces_here(shape)
    numbers = [one for text, one in scope.simple(()) if text not in scope.counters]
    numbers.sort(key=lambda one: not scope.uses_idle(one))
    rows = {text_of(one.value) for one in numbers if isinstance(one, ast.Subscript)}
    idle = scope.unused  # what is set and used nowhere is meant as a whole
    vectors = [one for text, one in scope.simple(shape) if text in idle or text not in rows]
    vectors = sorted(vectors, key=lambda one: not scope.uses_idle(one))[:_VECTORS]
    typed = [one for one in pieces.values() if _is_typed(one)][:_MADE]
    for vector in (*vectors, *typed):
        for scalar in numbers[:_SCALARS]:
            yield ast.BinOp(scalar, ast.Mult(), vector)
    if shape == _VECTOR and scope.cross is not None:
        turned = [one for one in pieces.values() if _is_turned(one)][:_MADE]
        turned += [one for one in pieces.values() if _is_scaled(one)][:_MADE]
        for arm in (*vectors, *typed):
            for other in (*vectors, *turned):
                if other is not arm:
                    yield ast.Call(scope.cross, [arm, other], [])


def _is_typed(node: ast.expr) -> bool:
    """Whether a vector is typed with names in it: ``np.array([lc[i], 0, 0])``."""
    return isinstance(node, ast.Call) and called(node) == "array" and bool(names(node.args[0]))


def _is_turned(node: ast.expr) -> bool:
    """Whether it is a vector in other axes: ``R @ f``."""
    return (
        isinstance(node, ast.BinOp)
        and isinstance(node.op, ast.MatMult)
        and isinstance(node.right, ast.Name | ast.Subscript)
    )
