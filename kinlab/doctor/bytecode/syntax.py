"""The nodes, names and text of syntax trees: as the standard library has them, but faster."""

from __future__ import annotations

import ast
from typing import TypeVar

Tree = TypeVar("Tree", bound=ast.AST)


def nodes(tree: ast.AST) -> list[ast.AST]:
    """What :func:`ast.walk` gives, in its order; in a third of its time."""
    found = [tree]
    for node in found:
        inside = node.__dict__
        for name in node._fields:
            value = inside.get(name)
            if type(value) is list:
                found += [one for one in value if isinstance(one, ast.AST)]
            elif isinstance(value, ast.AST):
                found.append(value)
    return found


def names(tree: ast.AST, context: type[ast.expr_context] = ast.expr_context) -> list[str]:
    """The names in a tree, in the order of :func:`nodes`: all, or those that are read, or set."""
    found = [node for node in nodes(tree) if isinstance(node, ast.Name)]
    return [node.id for node in found if isinstance(node.ctx, context)]


def called(node: ast.Call) -> str:
    """The last name of what is called: ``cross`` of ``np.cross``."""
    target = node.func
    return target.attr if isinstance(target, ast.Attribute) else getattr(target, "id", "")


def factors(node: ast.expr) -> list[ast.expr]:
    """Those of a product, from the left; what is none is its own."""
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        return [*factors(node.left), *factors(node.right)]
    return [node]


def copied(tree: Tree) -> Tree:
    """What :func:`copy.deepcopy` gives of a tree; what holds nothing stays."""
    other = type(tree)()
    inside = other.__dict__
    for name, value in tree.__dict__.items():
        if isinstance(value, list):
            value = [copied(one) if isinstance(one, ast.AST) else one for one in value]
        elif isinstance(value, ast.AST) and value._fields:
            value = copied(value)
        inside[name] = value
    return other


def shallow(node: Tree) -> Tree:
    """A copy of a node that holds the same pieces."""
    other = type(node)()
    other.__dict__.update(node.__dict__)
    return other


def text_of(node: ast.AST) -> str:
    """What :func:`ast.unparse` gives; of names, entries and indices without its machinery."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name):
        if not isinstance(node.slice, ast.Tuple | ast.Slice):
            return f"{node.value.id}[{text_of(node.slice)}]"
    elif isinstance(node, ast.BinOp) and isinstance(node.left, ast.Name):
        sign = {ast.Add: "+", ast.Sub: "-"}.get(type(node.op))
        if sign is not None and isinstance(node.right, ast.Name | ast.Constant):
            return f"{node.left.id} {sign} {ast.unparse(node.right)}"
    return ast.unparse(node)
