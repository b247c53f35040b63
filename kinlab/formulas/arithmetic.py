"""The one walk over Python's syntax tree of arithmetic: a whitelist, whatever the signs mean.

Numbers (:mod:`kinlab.formulas.numbers`), trees (:mod:`kinlab.formulas.text`) and plain values
(:mod:`kinlab.formulas.evaluate`) each say what a sign means to them. Nothing is ever evaluated as
code.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

T = TypeVar("T")


@dataclass(frozen=True)
class Meaning(Generic[T]):
    """What the parts of an expression mean.

    Attributes:
        number: of a literal.
        name: of a name.
        negative: of a minus sign in front.
        binary: of an operator between two values.
        call: of a function by name, with its arguments.
        admit: called with each node and its depth before anything in it is read; raises what
            the node may not be.
    """

    number: Callable[[int | float], T]
    name: Callable[[str], T]
    negative: Callable[[T], T]
    binary: Callable[[ast.operator, T, T], T]
    call: Callable[[str, list[T]], T]
    admit: Callable[[ast.expr, int], None]


OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow)


def is_arithmetic(node: ast.expr) -> bool:
    """Whether a node is a number, a name, a sign, an operator or a plain call."""
    match node:
        case ast.Constant(value=int() | float() as number):
            return not isinstance(number, bool)
        case ast.UnaryOp(op=op):
            return isinstance(op, (ast.UAdd, ast.USub))
        case ast.BinOp(op=op):
            return isinstance(op, OPERATORS)
        case ast.Call(func=ast.Name(), keywords=[]):
            return True
    return isinstance(node, ast.Name)


def read(node: ast.expr, meaning: Meaning[T], depth: int = 0) -> T:
    """What an expression means.

    Args:
        node: the body of what ``ast.parse(text, mode="eval")`` gave.
        meaning: of its parts.
        depth: of the node.

    Raises:
        KinlabError: what ``meaning`` refuses.
    """
    meaning.admit(node, depth)
    match node:
        case ast.Constant(value=int() | float() as number):
            return meaning.number(number)
        case ast.Name(id=name):
            return meaning.name(name)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return meaning.negative(read(operand, meaning, depth + 1))
        case ast.UnaryOp(operand=operand):
            return read(operand, meaning, depth + 1)
        case ast.BinOp(left=left, op=op, right=right):
            first = read(left, meaning, depth + 1)
            return meaning.binary(op, first, read(right, meaning, depth + 1))
        case ast.Call(func=ast.Name(id=name), args=args):
            return meaning.call(name, [read(part, meaning, depth + 1) for part in args])
    raise AssertionError(f"{type(node).__name__} was let through")  # pragma: no cover
