"""Products that may be missing in a sum, as far as the dimensions of their factors tell."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import reduce
from itertools import combinations, islice, permutations

from kinlab.doctor.bytecode.syntax import called, text_of
from kinlab.doctor.program.edits.scope.part import Scope, standing
from kinlab.doctor.program.grounds.dimensions import Dimensions
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Here, ProgramEdit, number
from kinlab.doctor.program.trial import Trial
from kinlab.tolerances import TOLERANCES

_MOST, _LONGER, _FACTORS = 30, 60, 24
"""Products that may be missing in one place, and longer ones; names that may be factors."""
_TURNED = 8
"""Sines and cosines that may be one."""
_OF_MORE = 0.04
"""What a longer product costs more."""
_THREE = 3
_UNUSED, _USED = 1.14, 1.22
"""What a product is far-fetched with a name that is used nowhere else, and without one."""


def missing_products(
    trial: Trial, observed: Observed, scopes: Sequence[Scope], known: Dimensions
) -> Iterator[ProgramEdit]:
    """A product of two names, of three, with a sine or cosine, that a sum may lack.

    Args:
        trial: a program.
        observed: its expressions.
        scopes: those of its parts.
        known: their dimensions.
    """
    for here, scope in standing(trial, scopes, _may_lack_one):
        size = known.of(here.node)
        if size and observed.shape(here.node) == ():
            yield from _missing(here, scope, known, size)


def _may_lack_one(here: Here) -> bool:
    """Whether it is all that is set, or a sum in brackets: ``(a*x + b*y)/c``."""
    inside = isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, ast.Mult | ast.Div)
    sum_ = isinstance(here.node, ast.BinOp) and isinstance(here.node.op, ast.Add | ast.Sub)
    return is_whole(here) or (inside and sum_)


def is_whole(here: Here) -> bool:
    """Whether an expression is all that is set, or an entry of it."""
    whole = isinstance(here.parent, ast.Assign | ast.AugAssign | ast.Return | ast.List | ast.Tuple)
    return whole and not isinstance(here.node, ast.Constant | ast.List | ast.Tuple)


def _missing(here: Here, scope: Scope, known: Dimensions, size: float) -> Iterator[ProgramEdit]:
    own = text_of(here.node)
    for products, most in ((_products, _MOST), (_longer, _LONGER)):
        new = (one for one in products(scope, known, size) if text_of(one[0]) not in own)
        for product, used in islice(new, most):
            idle = not scope.unused.isdisjoint(used) or scope.uses_idle(product)
            cost = _UNUSED if idle else _USED
            for op in (ast.Add(), ast.Sub()):
                more = _OF_MORE * (products is _longer)
                new_ = ast.BinOp(here.node, op, product)
                yield here.instead(new_, "missing term", cost + more)


def _factors(scope: Scope, known: Dimensions) -> list[tuple[str, ast.expr, float]]:
    """What has a dimension, and what that is."""
    every = ((text, node, known.of_text(text)) for text, node in scope.simple(()))
    sized = (
        (text, node, each)
        for text, node, each in every
        if each is not None and abs(each) > TOLERANCES.tried_further
    )
    return [*islice(sized, _FACTORS)]


def _products(
    scope: Scope, known: Dimensions, size: float
) -> Iterator[tuple[ast.expr, tuple[str, ...]]]:
    """Two names, or one and another's square."""
    factors = _factors(scope, known)
    for (text, one, first), (beside, other, last) in combinations(factors, 2):
        if abs(first + last - size) <= TOLERANCES.tried_further:
            yield ast.BinOp(one, ast.Mult(), other), (text, beside)
    for (text, one, first), (beside, other, last) in permutations(factors, 2):
        if abs(first + 2 * last - size) <= TOLERANCES.tried_further:
            square = ast.BinOp(other, ast.Pow(), number(2))
            yield ast.BinOp(one, ast.Mult(), square), (text, beside)


def _longer(
    scope: Scope, known: Dimensions, size: float
) -> Iterator[tuple[ast.expr, tuple[str, ...]]]:
    """Two or three names with a sine or cosine, or three without: ``m*g*lc*c1``."""
    factors = _factors(scope, known)
    pieces = scope.pieces_here(()).items()
    turned = [(text, one) for text, one in pieces if _is_turned(text, one, scope)][:_TURNED]
    for count in (2, _THREE):
        for some in combinations(factors, count):
            if abs(sum(each for _text, _one, each in some) - size) > TOLERANCES.tried_further:
                continue
            names_ = tuple(text for text, _one, _each in some)
            product = reduce(_times, (one for _text, one, _each in some))
            for text, one in turned:
                yield _times(product, one), (*names_, text)
            if count == _THREE:
                yield product, names_


def _is_turned(text: str, node: ast.expr, scope: Scope) -> bool:
    """Whether it is a sine or cosine, or a name for one."""
    if isinstance(node, ast.Call):
        return called(node) in ("sin", "cos")
    return isinstance(node, ast.Name) and text in scope.sines


def _times(one: ast.expr, other: ast.expr) -> ast.expr:
    return ast.BinOp(one, ast.Mult(), other)
