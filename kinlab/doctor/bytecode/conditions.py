"""Conditions: the tests and jumps of one expression taken together."""

from __future__ import annotations

import ast
from collections import Counter
from dataclasses import dataclass

from kinlab.doctor.bytecode.expressions import at, is_none, span_of
from kinlab.doctor.bytecode.instructions import CodeStep, Span


@dataclass
class Decision:
    """A condition read so far: where its paths lead, and how many of them.

    Attributes:
        test: The expression.
        yes, no: The next step where it holds and where not; the same for a value.
        value: The expression's value is what counts, and lies on the stack.
        falls: Which step stands next in the byte code.
        paths: How many jumps of the condition lead to each step.
        span: Where its first jump stands.
    """

    test: ast.expr
    yes: CodeStep
    no: CodeStep
    value: bool
    falls: CodeStep | None
    paths: Counter[CodeStep]
    span: Span | None

    @property
    def leads(self) -> tuple[CodeStep, CodeStep, bool]:
        """Where it ends: what two ways to one value share."""
        return self.yes, self.no, self.value


def joined(one: Decision, two: Decision, falls: CodeStep, other: CodeStep) -> Decision | None:
    """Two decisions as one ``and`` or ``or``, the second asked where the first falls through."""
    holds = falls is one.yes
    if other not in (two.yes, two.no):
        return None
    first, second, yes, no = one.test, two.test, two.yes, two.no
    plain = two.value or (other is two.no) == holds
    if not plain and two.falls is two.no:  # what goes on, goes on where the whole holds
        second, yes, no = negated(second), no, yes
    elif not plain:
        first, holds = negated(first), not holds
    op = ast.And() if holds else ast.Or()
    values: list[ast.expr] = []
    for node in (first, second):
        same = isinstance(node, ast.BoolOp) and type(node.op) is type(op)
        values.extend(node.values if same and isinstance(node, ast.BoolOp) else [node])
    paths = one.paths + two.paths
    del paths[falls]
    node = ast.BoolOp(op, values)
    place(node)
    span = two.span if one.span is None or _holds(two.span, one.span) else one.span
    return Decision(node, yes, no, two.value, two.falls, paths, span)


def together(one: Decision, two: Decision) -> bool:
    """Whether two conditions may stand in one expression: not those of nested statements."""
    if two.value or one.span is None or two.span is None or one.span == two.span:
        return True
    return not _holds(one.span, two.span) or span_of(two.test) == two.span


def _holds(outer: Span | None, inner: Span) -> bool:
    """Whether a part of the source has another in it."""
    if outer is None:
        return False
    begins = (outer[0], outer[2]) <= (inner[0], inner[2])
    return begins and (inner[1], inner[3]) <= (outer[1], outer[3])


def negated(test: ast.expr) -> ast.expr:
    """The opposite of a test."""
    if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
        return test.operand
    if isinstance(test, ast.Compare) and len(test.ops) == 1:
        none = isinstance(test.ops[0], ast.Is) and is_none(test.comparators[0])
        if none:
            return at(ast.Compare(test.left, [ast.IsNot()], test.comparators), span_of(test))
    return at(ast.UnaryOp(ast.Not(), test), span_of(test))


def place(node: ast.AST) -> None:
    """Give a statement without a place that of what is in it."""
    for child in ast.iter_child_nodes(node):
        place(child)
    if isinstance(node, (ast.stmt, ast.expr)) and not isinstance(node, ast.FunctionDef):
        spans = [
            span for n in [node, *ast.iter_child_nodes(node)] if (span := span_of(n)) is not None
        ]
        if spans:
            first = min((s[0], s[2]) for s in spans)
            last = max((s[1], s[3]) for s in spans)
            at(node, (first[0], last[0], first[1], last[1]))
