"""Products that may be missing in a sum, as far as the dimensions of their factors tell."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from itertools import combinations, permutations
from typing import Any

from kinlab.doctor.program.edits.additions import Scope
from kinlab.doctor.program.grounds.dimensions import Dimensions
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Here, ProgramEdit, number, places
from kinlab.doctor.program.trial import Trial
from kinlab.tolerances import TOLERANCES

_MOST, _FACTORS = 30, 24
"""Products that may be missing in one place; names of a part that may be factors."""
_UNUSED, _USED = 1.14, 1.22
"""What a product is far-fetched with a name that is used nowhere else, and without one."""


def missing_products(
    trial: Trial, observed: Observed, scopes: Sequence[Scope], known: Dimensions
) -> Iterator[ProgramEdit]:
    """A product of two names, or of one and another's square, that a sum may lack.

    Args:
        trial: a program.
        observed: its expressions.
        scopes: those of its parts.
        known: their dimensions.
    """
    for part, tree in enumerate(trial.trees):
        scope = scopes[part]
        for here in places(part, tree):
            size = known.of(here.node) if _is_whole(here) else None
            if size and observed.shape(here.node) == ():
                scope.stand((*here.above, here.node))
                yield from _missing(here, scope, known, size)


def _is_whole(here: Here) -> bool:
    """Whether an expression is all that is set, or an entry of it."""
    whole = isinstance(here.parent, ast.Assign | ast.AugAssign | ast.Return | ast.List | ast.Tuple)
    return whole and not isinstance(here.node, ast.Constant | ast.List | ast.Tuple)


def _missing(here: Here, scope: Scope, known: Dimensions, size: float) -> Iterator[ProgramEdit]:
    own, count = ast.unparse(here.node), 0
    for product, names in _products(scope, known, size):
        if count == _MOST:
            return
        if ast.unparse(product) not in own:
            count += 1
            cost = _USED if scope.unused.isdisjoint(names) else _UNUSED
            for op in (ast.Add(), ast.Sub()):
                new = ast.BinOp(here.node, op, product)
                yield here.instead(new, "missing term", cost)


def _products(
    scope: Scope, known: Dimensions, size: float
) -> Iterator[tuple[ast.expr, tuple[str, str]]]:
    factors: list[tuple[str, Any, float]] = []
    for text, node in scope.simple(()):
        each = known.of_text(text)
        if each:
            factors.append((text, node, each))
    factors = factors[:_FACTORS]
    for (text, one, first), (beside, other, last) in combinations(factors, 2):
        if abs(first + last - size) <= TOLERANCES.tried_further:
            yield ast.BinOp(one, ast.Mult(), other), (text, beside)
    for (text, one, first), (beside, other, last) in permutations(factors, 2):
        if abs(first + 2 * last - size) <= TOLERANCES.tried_further:
            square = ast.BinOp(other, ast.Pow(), number(2))
            yield ast.BinOp(one, ast.Mult(), square), (text, beside)
