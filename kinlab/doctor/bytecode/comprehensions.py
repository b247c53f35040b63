"""Loops that gather their elements as comprehensions, and lines that only return as expressions."""

from __future__ import annotations

import ast

from kinlab.doctor.bytecode.expressions import SAVED
from kinlab.doctor.bytecode.instructions import UnreadError


def gathers(stack: list[object]) -> bool:
    """Whether a loop gathers its elements for a comprehension."""
    return (
        len(stack) > 2
        and isinstance(stack[-2], (ast.List, ast.Set, ast.Dict))
        and stack[-3] is SAVED
    )


def comprehension(lines: list[ast.stmt], made: object, over: ast.expr) -> ast.expr:
    """A comprehension from its loops, what they fill, and what the first is over."""
    generators: list[ast.comprehension] = []
    while lines and isinstance(loop := lines[0], ast.For):
        source = loop.iter if generators else over
        generators.append(ast.comprehension(loop.target, source, [], 0))
        lines = loop.body
        while isinstance(inner := lines[0], ast.If) and not inner.orelse and len(lines) == 1:
            generators[-1].ifs.append(inner.test)
            lines = inner.body
    if not generators or len(lines) != 1:
        raise UnreadError("no comprehension")
    given = lines[0].value if isinstance(lines[0], ast.Expr) else None
    match made:
        case ast.Dict(keys=[ast.expr() as key], values=[value]):
            return ast.DictComp(key, value, generators)
        case ast.List(elts=[element]):
            return ast.ListComp(element, generators)
        case ast.Set(elts=[element]):
            return ast.SetComp(element, generators)
        case None if isinstance(given, ast.Yield) and given.value is not None:
            return ast.GeneratorExp(given.value, generators)
    raise UnreadError("no comprehension")


def only_value(lines: list[ast.stmt]) -> ast.expr:
    """Statements that only return, as one expression."""
    line = lines[0] if lines else None
    if isinstance(line, ast.Return) and line.value is not None:
        return line.value
    if isinstance(line, ast.If):
        return ast.IfExp(line.test, only_value(line.body), only_value(line.orelse or lines[1:]))
    raise UnreadError("a lambda that does more than return")
