"""Forms of expressions and statements: a sum's terms, rows' entries, sine for cosine."""

from __future__ import annotations

import ast
from collections.abc import Container, Iterator, Sequence

from kinlab.doctor.bytecode.syntax import called


def named(name: str) -> ast.Name:
    """A name as it is read."""
    return ast.Name(name, ast.Load())


def entry(of: ast.expr, key: ast.expr) -> ast.Subscript:
    """An entry as it is read: ``q[i]``."""
    return ast.Subscript(of, key, ast.Load())


def member(of: ast.expr, name: str) -> ast.Attribute:
    """What an object has, as it is read: ``link.mass``."""
    return ast.Attribute(of, name, ast.Load())


def entries(value: ast.expr) -> Iterator[ast.expr]:
    """The entries of what is written as rows: ``np.array([[a, b], [c, d]])``."""
    inner = value.args[:1] if isinstance(value, ast.Call) else getattr(value, "elts", None)
    if inner is None:
        yield value
    for one in inner or ():
        yield from entries(one) if isinstance(one, ast.List | ast.Tuple) else (one,)


def summands(node: ast.expr) -> Iterator[ast.expr]:
    """The terms of a sum, without their signs; what is none is its own."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
        yield from summands(node.left)
        yield from summands(node.right)
    else:
        yield node


_WAVES = {"s": "c", "c": "s", "S": "C", "C": "S"}
"""How names of sines and cosines begin."""


class Turned(ast.NodeTransformer):
    """Sine for cosine and cosine for sine.

    Args:
        known: names; ``c12`` is taken for ``s12`` where both are among them.
    """

    def __init__(self, known: Container[str] = ()) -> None:
        self.known = known

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        other = {"sin": "cos", "cos": "sin"}.get(called(node))
        if other is not None:
            if isinstance(node.func, ast.Attribute):
                node.func.attr = other
            else:
                node.func = named(other)
        return node

    def visit_Name(self, node: ast.Name) -> ast.Name:
        other = _WAVES.get(node.id[:1], "") + node.id[1:]
        both = node.id in self.known and other in self.known
        return ast.Name(other, node.ctx) if both else node


def block_of(above: Sequence[ast.AST]) -> tuple[list[ast.stmt], int]:
    """The block in which a statement stands, and where in it; none of a place outside of any."""
    line = statement_of(above)
    for one in reversed(above):
        for name in ("body", "orelse"):
            found = getattr(one, name, None)
            block: list[ast.stmt] = found if isinstance(found, list) else []
            for k, other in enumerate(block):
                if other is line:
                    return block, k
    return [], 0


def statement_of(above: Sequence[ast.AST]) -> ast.stmt:
    """The innermost statement."""
    return next(one for one in reversed(above) if isinstance(one, ast.stmt))


def stem_of(above: Sequence[ast.AST]) -> str:
    """What a statement sets, without its number or indices: ``m`` of ``m12``, ``M`` of an entry."""
    statement = statement_of(above)
    if not isinstance(statement, ast.Assign | ast.AugAssign):
        return ""
    target = statement.target if isinstance(statement, ast.AugAssign) else statement.targets[0]
    return ast.unparse(target).split("[")[0].rstrip("0123456789")
