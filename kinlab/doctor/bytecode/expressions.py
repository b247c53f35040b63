"""Byte code without jumps as expressions and simple statements, by a stack of syntax trees.

What the interpreter would put on its stack as a value stands here as the tree that makes it. Some
entries are no expression by themselves (a half-read import, a function not yet named, a code
object); they are the small classes at the top.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from dataclasses import dataclass, field
from types import CodeType
from typing import TypeVar

from kinlab.doctor.bytecode.instructions import CodeStep, Span, UnreadError


class Blank:
    """An entry that only holds a place."""


NULL, SELF, SAVED, ELEMENT = Blank(), Blank(), Blank(), Blank()
"""Under a function called; the self of a method; a variable put aside while a comprehension uses
its name; what a loop gives at each turn, not yet stored."""


@dataclass(eq=False)
class Iterated:
    """What a loop goes through."""

    over: ast.expr


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
    defaults: list[ast.expr] = field(default_factory=list)
    keywords: dict[str, ast.expr] = field(default_factory=dict)
    notes: dict[str, ast.expr] = field(default_factory=dict)
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
    """Where the reader is: the stack, what is being stored, and the statements so far.

    Attributes:
        finish: A function just made as an expression: a lambda, or a comprehension over what is
            given.
    """

    stack: list[object]
    finish: Callable[[Made, ast.expr | None, Span | None], ast.expr]
    out: list[ast.stmt] = field(default_factory=list)
    stored: list[tuple[object, ast.expr]] = field(default_factory=list)
    keywords: tuple[str, ...] = ()

    def pop(self) -> object:
        if not self.stack:
            raise UnreadError("an empty stack")
        return self.stack.pop()

    def under(self, depth: int) -> object:
        """The entry at a depth from the top, 1 being the top."""
        if not 1 <= depth <= len(self.stack):
            raise UnreadError("an empty stack")
        return self.stack[-depth]

    def push(self, node: ast.expr, step: CodeStep) -> None:
        """Put a value on the stack that a step has made."""
        setattr(node, "turn", step.index)  # noqa: B010
        self.stack.append(at(node, step.span))

    def expr(self) -> ast.expr:
        return self.as_expr(self.pop())

    def many(self, count: int) -> list[ast.expr]:
        """So many values, the lowest first."""
        return [self.expr() for _ in range(count)][::-1]

    def as_expr(self, value: object) -> ast.expr:
        """An entry as an expression; a copy of it stored before makes it ``(name := value)``."""
        if isinstance(value, Made):
            return self.finish(value, None, None)
        value = needed(value, ast.expr)
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
                starred = ast.Starred(elements[star], ast.Store())
                elements[star] = at(starred, span_of(elements[star]))
            target = at(ast.Tuple(elements, ast.Store()), span_of(elements[0]))
            value = value.whole.value
        if isinstance(value, Imported) and value.module.names and isinstance(target, ast.Name):
            alias = None if value.name == target.id else target.id
            value.module.aliases.append(ast.alias(value.name, alias))
        elif value is not SAVED:
            self.stored.append((value, target))


K = TypeVar("K")


def needed(entry: object, kind: type[K]) -> K:
    """An entry that must be of a kind."""
    if not isinstance(entry, kind):
        raise UnreadError(f"{type(entry).__name__} is no {kind.__name__}")
    return entry


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
    if isinstance(value, slice):  # 3.14
        return at(limits(*(literal(v, span) for v in (value.start, value.stop, value.step))), span)
    negative = isinstance(value, (int, float)) and repr(value)[0] == "-"
    turned = isinstance(value, complex) and repr(value)[:4] == "(-0-"  # what -1j comes to
    if negative or turned:
        assert isinstance(value, (int, float, complex))
        return at(ast.UnaryOp(ast.USub(), at(ast.Constant(-value), span)), span)
    return at(ast.Constant(value), span)  # type: ignore[arg-type]


def limits(*parts: ast.expr) -> ast.Slice:
    """The limits of a slice, those that are None left out."""
    return ast.Slice(*(None if is_none(part) else part for part in parts))


def is_none(node: ast.expr | None) -> bool:
    return node is None or (isinstance(node, ast.Constant) and node.value is None)
