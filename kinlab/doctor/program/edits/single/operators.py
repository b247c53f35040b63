"""Sums, products and signs of a program otherwise."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import permutations

from kinlab.doctor.bytecode.syntax import called, names, nodes, text_of
from kinlab.doctor.program.edits import chains
from kinlab.doctor.program.edits.scope.forms import statement_of
from kinlab.doctor.program.edits.single.constants import OF_A_NUMBER, POWER
from kinlab.doctor.program.edits.single.rows import FLAT
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Here, ProgramEdit, number

_THREE = 3
"""Factors from which on the rest of a product stays."""
_PAIR = 2
"""Sides of a matrix, factors that change places, arguments with a diagonal."""
_CONGRUENT = 0.97
"""Cost of a tensor that is turned the other way: sooner than its matrix is set up so."""
_ROWS = 1.12
"""Cost of a row times a matrix for the matrix times a column."""
_HALVES, _TYPED = (2, 0.5), 1.045
"""Factors that stand in front, and the cost of one that does not belong there."""
_TAKEN = 1.04
"""Cost of taking away a cross product that is added: its vectors are rather exchanged."""
_BOTH_SIGNS = 1.06
"""Cost of the signs of two terms for one another."""
_SIDES = 1.04
"""Cost of a side for another in the law of cosines."""
_TURNED = 1.01
"""Cost of parentheses behind a matrix: ``R.T @ (v + w)`` for ``R.T @ v + w``."""
_COMMUTATOR = 1.1
"""Cost of the second half of a commutator, or of a symmetric part, that is not there."""
_UNTURNED = 1.09
"""Cost of a vector that is turned too many."""
_BY_ITSELF = 1.01
"""Cost of ``A.T @ A`` for ``A @ A.T``."""
_GIVEN = 1.1
"""Cost of terms behind a call for terms of what it is given."""
_MIXED = 1.05
"""Cost of the terms of a quadratic form that are no squares."""
_DIVIDED = 1.2
"""Cost of a quotient for a product, or a product for a quotient."""
DIAGONALS = ("tril", "triu", "eye", "diag")
"""Functions whose last argument is the number of a diagonal."""


def _is_by_its_transpose(node: ast.BinOp) -> bool:
    """Whether a matrix is multiplied by its own transpose, easily the wrong one of two."""
    last = chains.members(chains.chain(node.left, chains.PRODUCTS))[-1]
    one, other = text_of(last), text_of(node.right)
    return f"{one}.T" == other or one == f"{other}.T"


def _into_the_last_argument(here: Here) -> Iterator[ProgramEdit]:
    """Terms behind a call as terms of what it is given: ``solve(M, tau - h)`` of ``.. - h``."""
    head, terms = chains.chain(here.node, chains.SUMS)
    if isinstance(head, ast.Call) and len(head.args) > 1 and not head.keywords:
        into = [*head.args[:-1], chains.joined(head.args[-1], terms)]
        yield here.instead(ast.Call(head.func, into, []), "parentheses", _GIVEN)


def of_operator(here: Here, observed: Observed, index: bool) -> Iterator[ProgramEdit]:
    node = here.node
    left, right, op = node.left, node.right, node.op
    if isinstance(op, ast.Add | ast.Sub):
        other = ast.Sub() if isinstance(op, ast.Add) else ast.Add()
        kind = "index" if index else "sign"
        taken = isinstance(op, ast.Add) and _is_cross(right) and not _leads_elsewhere(here, right)
        yield here.within(node, "op", other, kind, 1.1 if index else _TAKEN if taken else 0.98)
        extra = "index" if index else "extra term"
        yield here.instead(left, extra, 1.08)
        alone = right if isinstance(op, ast.Add) else ast.UnaryOp(ast.USub(), right)
        yield here.instead(alone, extra, 1.1)
        if index:
            return
        listed = any(isinstance(x, ast.List | ast.Tuple) for x in (left, right))
        if listed and isinstance(op, ast.Add):
            yield here.instead(ast.BinOp(right, op, left), "order", 1.05)
        for new in chains.together(node):
            turned = isinstance(getattr(new, "op", None), ast.MatMult)
            yield here.instead(new, "parentheses", _TURNED if turned else 1.07)
        for new in chains.multiplied(node):
            yield here.instead(new, "operator", 1.12)
        if all(len(observed.shape(side) or ()) == 2 for side in (left, right)):
            yield here.within(node, "op", ast.MatMult(), "operator", 1.12)
        for new in chains.squared(node):
            yield here.instead(new, "parentheses", 1.13)
        factor = isinstance(here.parent, ast.BinOp) and not isinstance(here.parent.op, ast.Pow)
        if factor and observed.shape(node) == ():
            yield here.instead(ast.BinOp(node, ast.Pow(), number(2)), "power", 1.12)
        if not (isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, chains.SUMS)):
            for new in chains.signs_exchanged(node):
                yield here.instead(new, "sign", _BOTH_SIGNS)
            for new in chains.sides_exchanged(node):
                yield here.instead(new, "names exchanged", _SIDES)
        for new in chains.crosswise(node):
            yield here.instead(new, "names exchanged", 1.13)
        for new in chains.crossed(node):
            yield here.instead(new, "cross product", 1.13)
        for new in chains.called_once(node):
            yield here.instead(new, "parentheses", 1.14)
        for side, inner in (("left", left), ("right", right)):
            if isinstance(inner, ast.Call) and side == "left" and len(inner.args) == 1:
                into = ast.Call(inner.func, [ast.BinOp(inner.args[0], op, right)], inner.keywords)
                yield here.instead(into, "parentheses", 1.15)
        yield from _into_the_last_argument(here)
        if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Sub) and isinstance(op, ast.Add):
            # a - b + c for a - (b + c)
            rest = ast.BinOp(left.right, op, right)
            yield here.instead(ast.BinOp(left.left, left.op, rest), "parentheses", 1.2)
    elif isinstance(op, chains.PRODUCTS):
        whole_form = _with_mixed_terms(node)
        if whole_form is not None:
            yield here.instead(whole_form, "missing term", _MIXED)
        for outer, sum_, name in ((left, right, "right"), (right, left, "left")):
            if isinstance(sum_, ast.BinOp) and isinstance(sum_.op, ast.Add | ast.Sub):
                # a*(b + c) for a*b + c
                one, last = sum_.left, sum_.right
                if name == "right":
                    opened = ast.BinOp(ast.BinOp(outer, op, one), sum_.op, last)
                else:
                    opened = ast.BinOp(one, sum_.op, ast.BinOp(last, op, outer))
                yield here.instead(opened, "parentheses", 1.15)
        matrices = [observed.shape(side) for side in (left, right)]
        for kept, left_out, cost in ((left, matrices[1], 1.15), (right, matrices[0], 1.17)):
            alone = observed.shape(kept) == () and bool(left_out)
            undone = kept is right and _turns_back(left, right)
            cost = 1.02 if undone else cost + FLAT * alone
            if kept is right and isinstance(op, ast.MatMult) and len(matrices[1] or ()) == 1:
                cost = min(cost, _UNTURNED)
            typed = kept is right and getattr(left, "value", 0) in _HALVES
            typed = typed or (kept is left and isinstance(op, ast.Div) and chains.is_two(right))
            yield here.instead(kept, "extra factor", _TYPED if typed else cost)
        if isinstance(op, ast.MatMult):
            swapped = chains.exchanged(node, lambda one: observed.shape(one) == ())
            upright = len(matrices[1] or ()) == 1 < len(matrices[0] or ())  # whose R.T is meant
            cost = _ROWS if upright else _BY_ITSELF if _is_by_its_transpose(node) else 1.06
            yield here.instead(swapped, "order", cost)
            sizes = observed.shape(node) or (0,)
            twice = _halved(node) if len(sizes) == _PAIR and sizes[0] == sizes[1] else None
            if twice is not None:  # A + A.T for 2*A
                both = ast.BinOp(twice, ast.Add(), ast.Attribute(twice, "T", ast.Load()))
                yield here.instead(both, "transposed", 1.0)
            if len(sizes) == _PAIR and sizes[0] == sizes[1] and _is_all(here):
                back = ast.BinOp(right, op, left)  # A @ B - B @ A for A @ B
                yield here.instead(ast.BinOp(node, ast.Sub(), back), "missing term", _COMMUTATOR)
                across = ast.Attribute(node, "T", ast.Load())
                yield here.instead(ast.BinOp(node, ast.Add(), across), "missing term", _COMMUTATOR)
            yield from _in_turn(here)
            if isinstance(left, ast.BinOp) and isinstance(left.op, ast.MatMult):
                last = ast.BinOp(ast.BinOp(left.left, op, right), left.op, left.right)
                yield here.instead(last, "order", 1.07)
            yield from _turned(here)
            inner = left.args[0] if isinstance(left, ast.Call) and len(left.args) == 1 else None
            if inner is not None and observed.shape(inner) == matrices[1] is not None:
                crossed = ast.Call(left.func, [right], left.keywords)  # skew(a) @ b
                yield here.instead(ast.BinOp(crossed, op, inner), "order", 1.03)
        elif isinstance(op, ast.Mult):
            if isinstance(right, ast.BinOp) and isinstance(right.op, ast.Pow):
                squared = ast.BinOp(ast.BinOp(left, op, right.left), right.op, right.right)
                yield here.instead(squared, "parentheses", 1.12)
            yield here.within(node, "op", ast.Div(), "factor", _DIVIDED)
            if all(shape for shape in matrices):
                yield here.within(node, "op", ast.MatMult(), "product", 1.1)
            if matrices[0] == matrices[1] and matrices[0]:
                for other in (ast.Add(), ast.Sub()):
                    yield here.within(node, "op", other, "operator", 1.16)
            square = matrices[1] is not None and len(matrices[1]) == 2
            others = chains.without_two(left) if square else None
            if square and (others is not None or chains.is_two(left)):
                both = ast.BinOp(right, ast.Add(), ast.Attribute(right, "T", ast.Load()))
                both = both if others is None else ast.BinOp(others, ast.Mult(), both)
                yield here.instead(both, "transposed", 1.08)
            if not (
                isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, chains.PRODUCTS)
            ):
                for new in chains.added(node):
                    yield here.instead(new, "operator", 1.16)
            if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Div):
                below = ast.BinOp(left.right, ast.Mult(), right)
                yield here.instead(ast.BinOp(left.left, ast.Div(), below), "parentheses", 1.2)
        else:
            yield here.within(node, "op", ast.Mult(), "factor", _DIVIDED)
            yield here.instead(ast.BinOp(right, ast.Div(), left), "order", 1.3)
            if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add | ast.Sub):
                # (a + b)/c for a + b/c
                tail = ast.BinOp(left.right, ast.Div(), right)
                yield here.instead(ast.BinOp(left.left, left.op, tail), "parentheses", 1.25)
    elif isinstance(op, ast.Pow):
        cost = OF_A_NUMBER if isinstance(left, ast.Constant) else POWER
        yield here.instead(left, "power", cost)
        if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Add):
            each = [ast.BinOp(one, op, right) for one in (left.left, left.right)]
            yield here.instead(ast.BinOp(each[0], left.op, each[1]), "parentheses", 1.15)
        if isinstance(left, ast.BinOp) and isinstance(left.op, ast.Mult):
            last = ast.BinOp(left.right, op, right)
            yield here.instead(ast.BinOp(left.left, left.op, last), "parentheses", 1.12)


def _with_mixed_terms(product: ast.BinOp) -> ast.expr | None:
    """A quadratic form of which the squares alone stand: ``v @ M @ v`` of ``diag(M) @ v**2``."""
    squared = product.right
    if not isinstance(squared, ast.BinOp) or not isinstance(squared.op, ast.Pow):
        return None
    first, others = chains.chain(product.left, (ast.Mult,))
    members = [first, *(member for _op, member in others)]
    diagonals = [(k, of) for k, x in enumerate(members) if (of := _of_diagonal(x)) is not None]
    if not chains.is_two(squared.right) or len(diagonals) != 1:
        return None
    ((at, matrix),), rate = diagonals, squared.left
    sides = (rate, matrix) if isinstance(product.op, ast.MatMult) else (matrix, rate)
    members[at] = ast.BinOp(sides[0], ast.MatMult(), sides[1])
    scaled = chains.joined(members[0], [(ast.Mult(), one) for one in members[1:]])
    return ast.BinOp(scaled, product.op, rate)


def _of_diagonal(node: ast.expr) -> ast.expr | None:
    """The matrix of ``diag(M)`` and ``M.diagonal()``; None of anything else."""
    if not isinstance(node, ast.Call) or called(node) not in ("diag", "diagonal"):
        return None
    if node.args:
        return node.args[0]
    return node.func.value if isinstance(node.func, ast.Attribute) else None


def _is_all(here: Here) -> bool:
    """Whether it is all that is set, or a term of that."""
    outer = here.parent
    if isinstance(outer, ast.BinOp) and isinstance(outer.op, ast.Add | ast.Sub):
        return True
    return isinstance(outer, ast.Assign | ast.AugAssign | ast.Return)


def _is_cross(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and called(node) == "cross" and len(node.args) == _PAIR


def _leads_elsewhere(here: Here, cross: ast.Call) -> bool:
    """Whether another cross product of the line has the same first vector: it stands there."""
    line = statement_of(here.above)
    own, within = _vectors(cross.args[0]), {id(one) for one in nodes(cross)}
    others = [x for x in nodes(line) if _is_cross(x) and id(x) not in within] if line else []
    return any(not own.isdisjoint(_vectors(x.args[0])) for x in others if isinstance(x, ast.Call))


def _vectors(node: ast.expr) -> set[str]:
    """The names and entries in an expression, without what counts."""
    inner = [one for one in nodes(node) if isinstance(one, ast.Subscript)]
    counting = {name for one in inner for name in names(one.slice)}
    return {*map(ast.unparse, inner), *names(node)} - counting


def _halved(product: ast.expr) -> ast.expr | None:
    """A product of matrices without the 2 that it begins with: ``A @ B`` of ``2*A @ B``."""
    if not isinstance(product, ast.BinOp):
        return None
    if isinstance(product.op, ast.Mult):
        return product.right if getattr(product.left, "value", 0) == 2 else None
    rest = _halved(product.left) if isinstance(product.op, ast.MatMult) else None
    return None if rest is None else ast.BinOp(rest, product.op, product.right)


def _turns_back(matrix: ast.expr, product: ast.expr) -> bool:
    """Whether a matrix stands before its own transpose: ``R.T @ (R @ v)``."""
    while isinstance(product, ast.BinOp) and isinstance(product.op, ast.MatMult):
        product = product.left
    one, other = ast.unparse(matrix), ast.unparse(product)
    return one == f"{other}.T" or other == f"{one}.T"


def _in_turn(here: Here) -> Iterator[ProgramEdit]:
    """A product of several matrices from another one on, from the last to the first, or with one
    of them further on or further back."""
    parent = here.parent
    if isinstance(parent, ast.BinOp) and isinstance(parent.op, ast.MatMult):
        return
    every = chains.members(chains.chain(here.node, (ast.MatMult,)))
    if len(every) > _PAIR:
        orders = [[*every[k:], *every[:k]] for k in range(1, len(every))]
        for k, to in permutations(range(len(every)), _PAIR):
            if 1 < abs(k - to) < len(every) - 1:  # others are of those above
                rest = [*every[:k], *every[k + 1 :]]
                orders.append([*rest[:to], every[k], *rest[to:]])
        for first, *others in (*orders, every[::-1]):
            by = [(ast.MatMult(), one) for one in others]
            yield here.instead(chains.joined(first, by), "order", 1.1)


def _turned(here: Here) -> Iterator[ProgramEdit]:
    """R I R.T for R.T I R."""
    parent = here.parent
    if (
        isinstance(parent, ast.BinOp)
        and isinstance(parent.op, ast.MatMult)
        and here.field == "left"
    ):
        return
    every = chains.members(chains.chain(here.node, (ast.MatMult,)))
    for k in range(len(every) - _PAIR):
        first, last = every[k], every[k + _PAIR]
        if f"{ast.unparse(first)}.T" == ast.unparse(last) or _is_turned_into(last, first):
            new = [*every[:k], last, every[k + 1], first, *every[k + _THREE :]]
            by = [(ast.MatMult(), other) for other in new[1:]]
            yield here.instead(chains.joined(new[0], by), "transposed", _CONGRUENT)


def _is_turned_into(one: ast.expr, other: ast.expr) -> bool:
    """Whether one of two matrices is the transpose of the first."""
    return f"{ast.unparse(one)}.T" == ast.unparse(other)


def is_diagonal(here: Here) -> bool:
    """Whether an argument is the number of a diagonal."""
    call = here.parent
    if not isinstance(call, ast.Call) or called(call) not in DIAGONALS or len(call.args) < _PAIR:
        return False
    return here.node is call.args[-1]
