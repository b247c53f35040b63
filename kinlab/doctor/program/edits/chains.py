"""Sums and products of a program otherwise: their parentheses, a factor of another term."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Sequence
from itertools import combinations

SUMS = (ast.Add, ast.Sub)
PRODUCTS = (ast.Mult, ast.Div, ast.MatMult)
_NAMES = (ast.Name, ast.Subscript, ast.Attribute)

Others = Sequence[tuple[ast.operator, ast.expr]]
"""Terms or factors, each with the operator before it."""
Chain = tuple[ast.expr, Others]
"""A sum or product: its first member, and the others."""


def chain(node: ast.expr, ops: tuple[type[ast.operator], ...]) -> Chain:
    """A sum or product as its first member and the others."""
    others: list[tuple[ast.operator, ast.expr]] = []
    while isinstance(node, ast.BinOp) and isinstance(node.op, ops):
        others.insert(0, (node.op, node.right))
        node = node.left
    return node, others


def members(of: Chain) -> list[ast.expr]:
    """Its terms or factors without their operators."""
    return [of[0], *(member for _op, member in of[1])]


def joined(first: ast.expr, others: Others) -> ast.expr:
    """The expression of a chain."""
    for op, member in others:
        first = ast.BinOp(first, op, member)
    return first


def opposite(node: ast.expr) -> ast.expr:
    """With the other sign: ``b - a`` of ``a - b``, ``-a*b`` of ``a*b``, else ``-(a + b)``."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
        first, factors = chain(node, (ast.Mult, ast.Div))
        return joined(ast.UnaryOp(ast.USub(), first), factors)
    if isinstance(node, ast.IfExp):
        one, other = ast.unparse(node.body), ast.unparse(node.orelse)
        if other == f"-{one}" or one == f"-{other}":
            return ast.IfExp(node.test, node.orelse, node.body)
    first, terms = chain(node, SUMS)
    taken = [term for op, term in terms if isinstance(op, ast.Sub)]
    if not taken or isinstance(first, ast.UnaryOp):
        return ast.UnaryOp(ast.USub(), node)
    added = [first, *(term for op, term in terms if isinstance(op, ast.Add))]
    more = [(ast.Add(), term) for term in taken[1:]]
    return joined(taken[0], [*more, *((ast.Sub(), term) for term in added)])


def signs_exchanged(node: ast.BinOp) -> Iterator[ast.expr]:
    """A sum with the signs of two of its terms for one another: ``a + b - c`` of ``a - b + c``."""
    first, terms = chain(node, SUMS)
    for i, j in combinations(range(len(terms)), 2):
        (one, term), (other, last) = terms[i], terms[j]
        if type(one) is not type(other):
            new = [*terms]
            new[i], new[j] = (other, term), (one, last)
            yield joined(first, new)


def sides_exchanged(node: ast.BinOp) -> Iterator[ast.expr]:
    """The law of cosines with a side for another: ``a*a + c*c - b*b`` of ``b*b + c*c - a*a``."""
    first, terms = chain(node, SUMS)
    for k, (op, term) in enumerate(terms if len(terms) > 1 else ()):
        if isinstance(op, ast.Sub) and _is_square(first) and _is_square(term):
            yield joined(term, [*terms[:k], (op, first), *terms[k + 1 :]])


def _is_square(node: ast.expr) -> bool:
    """Whether it is something times itself."""
    if not isinstance(node, ast.BinOp):
        return False
    if isinstance(node.op, ast.Pow):
        return getattr(node.right, "value", 0) == 2
    return isinstance(node.op, ast.Mult) and ast.dump(node.left) == ast.dump(node.right)


def times(number: ast.expr, node: ast.expr) -> ast.BinOp:
    """A number times something: of a product of vectors in front, ``0.5*w @ I @ w``."""
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):  # -2*h of -h
        return times(ast.UnaryOp(ast.USub(), number), node.operand)
    first, factors = chain(node, (ast.MatMult,))
    front, rest = chain(first, (ast.Mult,))
    if not factors or not isinstance(front, _NAMES):
        return ast.BinOp(number, ast.Mult(), node)
    first = joined(ast.BinOp(number, ast.Mult(), front), rest)
    more: ast.expr = joined(first, factors)
    assert isinstance(more, ast.BinOp)
    return more


def without_two(node: ast.expr) -> ast.expr | None:
    """A product without its factor 2: ``rate*grad`` of ``rate*2*grad``; None where it has none."""
    first, factors = chain(node, (ast.Mult, ast.Div))
    at = next(
        (k for k, (op, x) in enumerate(factors) if isinstance(op, ast.Mult) and is_two(x)), -1
    )
    if factors and at < 0 and is_two(first) and isinstance(factors[0][0], ast.Mult):
        return joined(factors[0][1], factors[1:])
    return None if at < 0 else joined(first, [*factors[:at], *factors[at + 1 :]])


def is_two(node: ast.expr) -> bool:
    """Whether it is a 2 as it is written."""
    return isinstance(node, ast.Constant) and node.value == 2


def part_of(node: ast.expr, count: int) -> ast.BinOp | None:
    """A quotient by a whole number more: ``a/(2*b)`` of ``a/b``; None of what is none."""
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Div):
        return None
    below, factors = chain(node.right, (ast.Mult,))
    more = joined(ast.Constant(count), [(ast.Mult(), below), *factors])
    return ast.BinOp(node.left, ast.Div(), more)


def exchanged(node: ast.BinOp, plain: Callable[[ast.expr], bool]) -> ast.expr:
    """The sides of a matrix product for one another; numbers in front stay: ``m*B @ A``.

    Args:
        node: the product.
        plain: whether something is a single number.
    """
    first, others = chain(node.left, (ast.MatMult,))
    *front, last = members(chain(first, (ast.Mult,)))
    if not front or not all(map(plain, front)) or plain(last):
        return ast.BinOp(node.right, node.op, node.left)
    numbers = joined(front[0], [(ast.Mult(), one) for one in front[1:]])
    return joined(ast.BinOp(numbers, ast.Mult(), node.right), [(node.op, last), *others])


def together(node: ast.BinOp) -> Iterator[ast.expr]:
    """``a*(b + c)`` and ``(a + b)*c`` of sums in which the parentheses are left out."""
    head, terms = chain(node, SUMS)
    for i in range(len(terms)):
        # of the terms from the i-th to the last, a factor of the first belongs to all
        first, factors = chain(terms[i - 1][1] if i else head, PRODUCTS)
        for k, (by, factor) in enumerate(factors):
            if isinstance(by, ast.Mult | ast.MatMult):
                inner = joined(joined(factor, factors[k + 1 :]), terms[i:])
                whole = ast.BinOp(joined(first, factors[:k]), by, inner)
                yield _with((head, terms[:i]), i, whole)
    op, last = terms[-1]
    first, factors = chain(last, PRODUCTS)
    for k in range(len(factors)):
        before, after = joined(first, factors[:k]), factors[k:]
        yield joined(ast.BinOp(node.left, op, before), after)
        if len(terms) > 1:
            inner = joined(ast.BinOp(terms[-2][1], op, before), after)
            yield _with((head, terms[:-1]), len(terms) - 1, inner)


def multiplied(node: ast.BinOp) -> Iterator[ast.expr]:
    """Two terms of a sum as a product: ``a + b*c`` for ``a + b + c``."""
    head, terms = chain(node, SUMS)
    for k, (before, (_op, term)) in enumerate(zip(members((head, terms)), terms, strict=False)):
        factor, rest = chain(term, PRODUCTS)
        whole = joined(ast.BinOp(before, ast.Mult(), factor), rest)
        yield _with((head, [*terms[:k], *terms[k + 1 :]]), k, whole)


def squared(node: ast.BinOp) -> Iterator[ast.expr]:
    """Two squares of a sum as the square of one: ``(a + b)**2`` for ``a**2 + b**2``."""
    head, terms = chain(node, SUMS)
    for k, (before, (op, term)) in enumerate(zip(members((head, terms)), terms, strict=False)):
        one, other = (x if isinstance(x, ast.BinOp) else None for x in (before, term))
        if one and other and isinstance(one.op, ast.Pow) and isinstance(other.op, ast.Pow):
            whole = ast.BinOp(ast.BinOp(one.left, op, other.left), other.op, other.right)
            yield _with((head, [*terms[:k], *terms[k + 1 :]]), k, whole)


def crosswise(node: ast.BinOp) -> Iterator[ast.expr]:
    """One factor each of the last two terms for one another: ``a*d + c*b`` for ``a*b + c*d``.

    Of terms with as many factors those in one place; of others those of which one is a name.
    """
    head, terms = chain(node, SUMS)
    *_, before, last = members((head, terms))
    one, other = chain(before, PRODUCTS), chain(last, PRODUCTS)
    alike = len(one[1]) == len(other[1])
    for j, factor in enumerate(members(one)):
        for k, instead in enumerate(members(other)):
            names = sum(isinstance(x, _NAMES) for x in (factor, instead))
            fits = j == k and bool(one[1]) if alike else names > 0
            if fits and ast.dump(factor) != ast.dump(instead):
                tail = (terms[-1][0], _with(other, k, factor))
                yield _with((head, [*terms[:-1], tail]), len(terms) - 1, _with(one, j, instead))


def crossed(node: ast.BinOp) -> Iterator[ast.expr]:
    """A product of two vectors in components for the other: ``u[0]*w[1] - u[1]*w[0]`` of
    ``u[0]*w[0] + u[1]*w[1]``."""
    sides = node.left, node.right
    if all(isinstance(x, ast.BinOp) and isinstance(x.op, ast.Mult) for x in sides):
        other = ast.Sub() if isinstance(node.op, ast.Add) else ast.Add()
        for new in crosswise(node):
            if isinstance(new, ast.BinOp):
                yield ast.BinOp(new.left, other, new.right)


def called_once(node: ast.BinOp) -> Iterator[ast.expr]:
    """A function of a sum for a sum of it: ``cos(a + b)`` for ``cos(a) + cos(b)``."""
    left, right = node.left, node.right
    if isinstance(left, ast.Call) and isinstance(right, ast.Call):
        same = ast.dump(left.func) == ast.dump(right.func)
        if same and len(left.args) == len(right.args) == 1:
            whole = ast.BinOp(left.args[0], node.op, right.args[0])
            yield ast.Call(left.func, [whole], left.keywords)


def added(node: ast.BinOp) -> Iterator[ast.expr]:
    """A product as a sum of two: ``a + b*c`` for ``a*b*c``."""
    head, factors = chain(node, PRODUCTS)
    for k, (op, factor) in enumerate(factors):
        if isinstance(op, ast.Mult):
            last = joined(factor, factors[k + 1 :])
            yield ast.BinOp(joined(head, factors[:k]), ast.Add(), last)


def without_numbers(node: ast.expr) -> ast.expr | None:
    """A product without the numbers in it: ``h*c`` of ``2*h*c``; None where it has none."""
    factors = members(chain(node, (ast.Mult,)))
    rest = [one for one in factors if not isinstance(one, ast.Constant)]
    if len(rest) == len(factors) or len(rest) < 2:
        return None
    return joined(rest[0], [(ast.Mult(), one) for one in rest[1:]])


def _with(of: Chain, k: int, new: ast.expr) -> ast.expr:
    """A chain with something else as its k-th member."""
    first, others = of
    if not k:
        return joined(new, others)
    return joined(first, [*others[: k - 1], (others[k - 1][0], new), *others[k:]])
