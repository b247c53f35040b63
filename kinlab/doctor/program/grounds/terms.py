"""Vectors and matrices that a sum may lack, made of what is at hand and of the sum's dimension."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

import numpy as np

from kinlab.doctor.bytecode.syntax import copied, names
from kinlab.doctor.program.edits.additions import OtherName
from kinlab.doctor.program.edits.scope import Scope, summands
from kinlab.doctor.program.grounds.dimensions import Dimensions
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import Here, ProgramEdit, called, places
from kinlab.doctor.program.trial import Trial
from kinlab.tolerances import TOLERANCES

_VECTOR = (3,)
_VECTORS, _SCALARS, _MADE = 10, 10, 4
"""Names and numbers of which a term may be, and things that are made of several."""
_MOST, _FEW = 40, 12
"""Terms that may be missing in one place; of a dimension that is not known."""
_IDLE, _USED = 1.08, 1.17
"""What a term is far-fetched with a name that is used nowhere else, and without one."""
_NEXT = 1.05
"""What one is with which each of the arm's links has its own."""
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
    for part, tree in enumerate(trial.trees):
        scope = scopes[part]
        for here in places(part, tree):
            if isinstance(here.node, ast.expr) and _is_whole(here):
                shape = observed.shape(here.node)
                if shape is not None:
                    scope.stand((*here.above, here.node))
                    yield from _of_other_links(here, scope)
                if shape is not None and len(shape) == 1:
                    yield from _of_dimension(here, scope, known, shape)


def _is_whole(here: Here) -> bool:
    """Whether an expression is all that is set, or that is put into a list."""
    kept = isinstance(here.parent, ast.Call) and called(here.parent) == "append"
    literal = isinstance(here.node, ast.Constant | ast.List | ast.Tuple)
    return (kept or isinstance(here.parent, _SET)) and not literal


def _of_other_links(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """``I2*Jw2.T @ Jw2`` beside ``I1*Jw1.T @ Jw1``: each of its names is the other link's."""
    terms = [*summands(here.node)]
    own = {ast.unparse(one) for one in terms}
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
                if isinstance(new, ast.expr) and ast.unparse(new) not in own:
                    idle = not scope.unused.isdisjoint(others.values())
                    cost = _NEXT if idle else _USED
                    yield here.instead(ast.BinOp(here.node, ast.Add(), new), "missing term", cost)


def _of_dimension(
    here: Here, scope: Scope, known: Dimensions, shape: Shape
) -> Iterator[ProgramEdit]:
    size, own = known.of(here.node), ast.unparse(here.node)
    seen = scope.observed.of(here.node)  # nothing but zeros has no dimension
    zeros = seen is not None and not any(map(np.any, seen.values))
    found: list[tuple[float, ast.expr]] = []
    for term in _terms(scope, shape):
        made, idle = known.of_made(term), not scope.unused.isdisjoint(names(term))
        told = None if size is None or made is None else abs(made - size)
        if (told is None and not idle) or ast.unparse(term) in own:
            continue
        if told is None or told <= TOLERANCES.tried_further:
            sure = told is not None or zeros
            found.append((_IDLE if idle and sure else _USED, term))
    found.sort(key=lambda one: one[0])
    for cost, term in found[: _MOST if size is not None or zeros else _FEW]:
        yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", cost)


def _terms(scope: Scope, shape: Shape) -> Iterator[ast.expr]:
    """A vector times a number, and of vectors in space the products of two."""
    pieces = scope.pieces_here(shape)
    numbers = [one for text, one in scope.simple(()) if text not in scope.counters]
    numbers.sort(key=lambda one: scope.unused.isdisjoint(names(one)))
    rows = {ast.unparse(one.value) for one in numbers if isinstance(one, ast.Subscript)}
    vectors = [one for text, one in scope.simple(shape) if text not in rows][:_VECTORS]
    typed = [one for one in pieces.values() if _is_typed(one)][:_MADE]
    for vector in (*vectors, *typed):
        for scalar in numbers[:_SCALARS]:
            yield ast.BinOp(scalar, ast.Mult(), vector)
    if shape == _VECTOR and scope.cross is not None:
        turned = [one for one in pieces.values() if _is_turned(one)][:_MADE]
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
