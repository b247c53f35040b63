"""Lines that put numbers into an array, for numbers with lanes, which need an array of objects.

``tau += J.T @ f`` becomes ``_value = J.T @ f``, ``tau = _room(tau, _value)``, ``tau += _value``.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from kinlab.doctor.bytecode.syntax import shallow
from kinlab.doctor.program.places import BLOCKS, root

_VALUE = "_value"
_OWN = ast.FunctionDef | ast.ClassDef | ast.Lambda
"""What has names of its own."""


def with_room(tree: Any) -> Any:
    """A function, or the lines of a module, each of whose own arrays takes what is put into it.

    Args:
        tree: its definition, which stays as it is.
    """
    return _in_blocks(tree, _own_names(tree))


def _in_blocks(node: Any, own: set[str]) -> Any:
    other = shallow(node)
    for name in BLOCKS:
        block = getattr(node, name, None)
        if isinstance(block, list):
            setattr(other, name, [new for line in block for new in _lines(line, own)])
    return other


def _lines(line: Any, own: set[str]) -> Iterator[Any]:
    """A line, with room made in front of it."""
    if isinstance(line, _OWN):
        yield _in_blocks(line, _own_names(line)) if isinstance(line, ast.FunctionDef) else line
    elif isinstance(line, ast.AugAssign | ast.Assign):
        target = line.target if isinstance(line, ast.AugAssign) else line.targets[0]
        inside = isinstance(target, ast.Subscript) or isinstance(line, ast.AugAssign)
        single = isinstance(line, ast.AugAssign) or len(line.targets) == 1
        name = root(target) if inside and single else ""
        if not name or name not in own or not _is_of_subscripts(target):
            yield line
            return
        value = ast.Name(_VALUE, ast.Load())
        room = ast.Call(ast.Name("_room", ast.Load()), [ast.Name(name, ast.Load()), value], [])
        other = shallow(line)
        other.value = value
        yield ast.Assign([ast.Name(_VALUE, ast.Store())], line.value)
        yield ast.Assign([ast.Name(name, ast.Store())], room)
        yield other
    elif any(isinstance(getattr(line, name, None), list) for name in BLOCKS):
        yield _in_blocks(line, own)
    else:
        yield line


def _is_of_subscripts(target: ast.expr) -> bool:
    """Whether a target is a name, or entries of one: no member of an object."""
    while isinstance(target, ast.Subscript):
        target = target.value
    return isinstance(target, ast.Name)


def _own_names(tree: Any) -> set[str]:
    """The names that are set in a function, but for those that are others'."""
    given = getattr(tree, "args", None)
    every = [*given.posonlyargs, *given.args, *given.kwonlyargs] if given is not None else []
    own = {one.arg for one in every}
    others: set[str] = set()
    waiting = [*tree.body]
    while waiting:
        node = waiting.pop()
        if isinstance(node, _OWN):
            continue
        if isinstance(node, ast.Global | ast.Nonlocal):
            others |= {*node.names}
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            own.add(node.id)
        waiting += ast.iter_child_nodes(node)
    return own - others
