"""What stands in the sums and products of a part: addends, factors, divisors."""

from __future__ import annotations

import ast
import re

from kinlab.doctor.bytecode.syntax import factors, names, nodes, text_of
from kinlab.doctor.program.edits.chains import without_numbers
from kinlab.doctor.program.edits.scope.forms import entries, stem_of, summands
from kinlab.doctor.program.observed import Observed


def divisors_of(tree: ast.AST) -> set[str]:
    """What something is divided by, as text, and the factors of that."""
    below = [x.right for x in _operations(tree, ast.Div)]
    return {text_of(one) for x in below for one in (x, *factors(x))}


def differences_of(tree: ast.AST) -> set[frozenset[str]]:
    """The two sides of each difference, as text."""
    return {frozenset({text_of(x.left), text_of(x.right)}) for x in _operations(tree, ast.Sub)}


def fronts_of(tree: ast.AST) -> set[str]:
    """The names in what stands in front of products of matrices."""
    return {name for x in _operations(tree, ast.MatMult) for name in names(x.left)}


def factors_of(tree: ast.AST) -> dict[int, set[str]]:
    """What stands in front of products of matrices, as text, by the statements' identities."""
    return {
        id(node): {ast.unparse(x.left) for x in _operations(node, ast.MatMult)}
        for node in nodes(tree)
        if isinstance(node, ast.Assign | ast.AugAssign | ast.Return)
    }


def addends_of(tree: ast.AST) -> dict[str, set[str]]:
    """The terms of the sums that are set, without numbers, by what is set, without its number."""
    found: dict[str, set[str]] = {}
    for statement in nodes(tree):
        if not isinstance(statement, ast.Assign | ast.AugAssign):
            continue
        known = found.setdefault(stem_of([statement]), set())
        literal = isinstance(statement.value, ast.List | ast.Tuple | ast.Call)
        for value in entries(statement.value) if literal else (statement.value,):
            if isinstance(value, ast.BinOp | ast.Call):
                known |= {_bare(one) for one in summands(value)}
    return found


def alike_of(tree: ast.AST) -> dict[str, set[str]]:
    """The same terms of any link: with their numbers, and without those of names."""
    found: dict[str, set[str]] = {}
    for statement in nodes(tree):
        if isinstance(statement, ast.Assign) and isinstance(statement.value, ast.BinOp):
            known = found.setdefault(stem_of([statement]), set())
            known |= {of_any_link(one) for one in summands(statement.value)}
    return found


def of_any_link(term: ast.expr) -> str:
    """A term without the numbers of names: ``0.5*m*v`` of ``0.5*m2*v2``."""
    return re.sub(r"(?<=[A-Za-z_])\d+|[ ()]", "", text_of(term))


def inner_terms_of(tree: ast.AST, observed: Observed) -> set[str]:
    """The terms of the sums that are factors, without their numbers."""
    found: set[str] = set()
    for product in _operations(tree, ast.Mult):
        for one in (product.left, product.right):
            terms = [*summands(one)] if observed.shape(one) == () else []
            found |= {_bare(term) for term in terms if len(terms) > 1}
    return found


def _bare(term: ast.expr) -> str:
    """A term without the numbers in it, as text."""
    bare = without_numbers(term)
    return ast.unparse(term if bare is None else bare)


def _operations(tree: ast.AST, kind: type[ast.operator]) -> list[ast.BinOp]:
    every = (node for node in nodes(tree) if isinstance(node, ast.BinOp))
    return [one for one in every if isinstance(one.op, kind)]
