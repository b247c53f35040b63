"""Byte code without jumps as expressions and simple statements, by a stack of syntax trees.

What the interpreter would put on its stack as a value stands here as the tree that makes it. Some
entries are no expression by themselves (a half-read import, a function not yet named); they are
the small classes at the top.
"""

from __future__ import annotations

import ast
from dataclasses import dataclass, field
from types import CodeType
from typing import TypeVar

from kinlab.doctor.bytecode.instructions import Span, UnreadError


class Blank:
    """An entry that only holds a place: under a function called, or the self of a method."""


NULL, SELF = Blank(), Blank()


@dataclass(eq=False)
class Iterated:
    """What a loop goes through."""

    over: ast.expr


@dataclass(eq=False)
class Saved:
    """A variable put aside while a comprehension uses its name."""


@dataclass(eq=False)
class Element:
    """What a loop gives at each turn, not yet stored."""


@dataclass(eq=False)
class Raw:
    """A constant as it stands in the byte code: a code object, or the names of keywords."""

    value: object


@dataclass(eq=False)
class Module:
    """An import half read."""

    name: str
    level: int
    names: object
    aliases: list[ast.alias] = field(default_factory=list)


@dataclass(eq=False)
class Imported:
    """A name from a module being imported."""

    module: Module
    name: str


@dataclass(eq=False)
class Changed:
    """The value of an augmented assignment, before it is stored."""

    target: ast.expr
    op: ast.operator
    by: ast.expr


@dataclass(eq=False)
class Made:
    """A function just made, not yet named."""

    code: CodeType
    defaults: list[ast.expr]
    keywords: dict[str, ast.expr]
    notes: dict[str, ast.expr]
    decorators: list[ast.expr] = field(default_factory=list)


@dataclass(eq=False)
class Unpacked:
    """A value taken apart; ``holes`` are filled by the targets as they are stored."""

    value: object
    holes: list[ast.expr | None]
    star: int | None


@dataclass(eq=False)
class Hole:
    """One part of a value taken apart."""

    whole: Unpacked
    place: int


@dataclass
class CodeHand:
    """Where the reader is: the stack, what is being stored, and the statements so far."""

    stack: list[object]
    stored: list[tuple[object, ast.expr]] = field(default_factory=list)
    out: list[ast.stmt] = field(default_factory=list)
    keywords: tuple[str, ...] = ()

    def pop(self) -> object:
        if not self.stack:
            raise UnreadError("an empty stack")
        return self.stack.pop()

    def expr(self) -> ast.expr:
        return self.as_expr(self.pop())

    def as_expr(self, value: object) -> ast.expr:
        """An entry as an expression; a copy of it stored before makes it ``(name := value)``."""
        if not isinstance(value, ast.expr):
            raise UnreadError(f"{type(value).__name__} is no value")
        held = [n for n, (stored, _) in enumerate(self.stored) if stored is value]
        if not held:
            return value
        _, target = self.stored.pop(held[0])
        if len(held) > 1 or not isinstance(target, ast.Name):
            raise UnreadError("stored in between")
        return at(ast.NamedExpr(target, value), span_of(value))

    def store(self, value: object, target: ast.expr) -> None:
        """Fill a target; of values taken apart, once all their parts have theirs."""
        while isinstance(value, Hole):
            value.whole.holes[value.place] = target
            holes = value.whole.holes
            if value.place != len(holes) - 1:
                return
            elements = [hole for hole in holes if hole is not None]
            if len(elements) != len(holes):
                raise UnreadError("a part without a target")
            if (star := value.whole.star) is not None:
                elements[star] = at(
                    ast.Starred(elements[star], ast.Store()), span_of(elements[star])
                )
            target = at(ast.Tuple(elements, ast.Store()), span_of(elements[0]))
            value = value.whole.value
        if isinstance(value, Imported) and value.module.names and isinstance(target, ast.Name):
            alias = None if value.name == target.id else target.id
            value.module.aliases.append(ast.alias(value.name, alias))
        elif not isinstance(value, Saved):
            self.stored.append((value, target))


N = TypeVar("N", bound=ast.AST)


def at(node: N, span: Span | None) -> N:
    """The node, at its place in the source."""
    if span is not None:
        for name, number in zip(PLACES, span, strict=True):
            setattr(node, name, number)
    return node


PLACES = ("lineno", "end_lineno", "col_offset", "end_col_offset")


def span_of(node: ast.AST) -> Span | None:
    line, end, column, last = (getattr(node, name, None) for name in PLACES)
    if line is None or end is None or column is None or last is None:
        return None
    return (line, end, column, last)


def literal(value: object, span: Span | None) -> ast.expr:
    """A constant as one would write it: tuples element by element, a minus before its number."""
    if isinstance(value, tuple):
        return at(ast.Tuple([literal(v, span) for v in value], ast.Load()), span)
    if isinstance(value, frozenset):
        return at(ast.Set([literal(v, span) for v in value]), span)
    if isinstance(value, (int, float)) and not isinstance(value, bool) and repr(value)[0] == "-":
        return at(ast.UnaryOp(ast.USub(), at(ast.Constant(-value), span)), span)
    if isinstance(value, CodeType):
        raise UnreadError("a code object is no value")
    return at(ast.Constant(value), span)  # type: ignore[arg-type]


BINARY: tuple[type[ast.operator], ...] = (
    ast.Add,
    ast.BitAnd,
    ast.FloorDiv,
    ast.LShift,
    ast.MatMult,
    ast.Mult,
    ast.Mod,
    ast.BitOr,
    ast.Pow,
    ast.RShift,
    ast.Sub,
    ast.Div,
    ast.BitXor,
)
"""In the order of BINARY_OP's argument; behind them stand the augmented ones, then ``[]``."""

UNARY: dict[str, type[ast.unaryop]] = {
    "UNARY_NEGATIVE": ast.USub,
    "UNARY_POSITIVE": ast.UAdd,
    "UNARY_INVERT": ast.Invert,
    "UNARY_NOT": ast.Not,
}
COMPARE: dict[str, type[ast.cmpop]] = {
    "<": ast.Lt,
    "<=": ast.LtE,
    "==": ast.Eq,
    "!=": ast.NotEq,
    ">": ast.Gt,
    ">=": ast.GtE,
}
COMPARES = {"COMPARE_OP", "IS_OP", "CONTAINS_OP"}
