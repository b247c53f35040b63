"""Whole numbers in the text of a program, and what is counted by them."""

from __future__ import annotations

import ast

from kinlab.doctor.program.places import number

SIZES = ("eye", "zeros", "ones", "range", "sin", "cos", "tan", "full", "reshape", "identity")
"""Functions whose numbers are no quantities."""


def plus(node: ast.expr, step: int) -> ast.expr:
    """A whole number more: ``i + 1`` of ``i``, and ``i`` of ``i - 1``."""
    if isinstance(node, ast.Constant) and isinstance(node.value, int):
        return number(node.value + step)
    if isinstance(node, ast.BinOp) and shifted(node) and whole_constant(node.right):
        sign = 1 if isinstance(node.op, ast.Add) else -1
        total = sign * value_of(node.right) + step
        return node.left if total == 0 else plus(node.left, total)
    return ast.BinOp(node, ast.Add() if step > 0 else ast.Sub(), number(abs(step)))


def whole_constant(node: ast.AST) -> bool:
    """Whether a node is a whole number as it is written."""
    inner = node.operand if isinstance(node, ast.UnaryOp) else node
    return isinstance(inner, ast.Constant) and type(inner.value) is int


def value_of(node: ast.expr) -> int:
    """A whole number as it is written."""
    return int(ast.literal_eval(node))


def shifted(node: ast.expr) -> bool:
    """Whether a number is added to something."""
    return (
        isinstance(node, ast.BinOp)
        and isinstance(node.op, ast.Add | ast.Sub)
        and isinstance(node.right, ast.Constant)
    )
