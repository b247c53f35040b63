"""The functions that a formula is made of, as syntax trees, and the data they use."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import CodeType, FunctionType, MethodType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.recover import recovered

_MOST = 40
"""Functions of one program that are read."""


@dataclass(frozen=True, eq=False)
class Part:
    """One function of a program.

    Attributes:
        name: what the program calls it.
        tree: its definition; line numbers are those of its file, or of the text it was made from.
        function: the function itself.
    """

    name: str
    tree: ast.FunctionDef
    function: FunctionType


@dataclass(frozen=True, eq=False)
class Program:
    """A function and the functions of the same module that it calls.

    Attributes:
        parts: the function itself first.
        bound: what is given to it before the state: the object of a method.
        space: what every name outside the functions stands for.
        data: names of numbers, and of lists, tables and arrays of numbers, that the parts use.
    """

    parts: tuple[Part, ...]
    bound: tuple[Any, ...]
    space: dict[str, Any]
    data: tuple[str, ...]


def read(function: Callable[..., Any]) -> Program | None:
    """The program behind a function; None where its source cannot be had for certain."""
    bound: tuple[Any, ...] = ()
    if isinstance(function, MethodType):
        bound, function = (function.__self__,), function.__func__
    if not isinstance(function, FunctionType):
        return None
    space = dict(function.__globals__)
    parts: dict[str, Part] = {}
    data: list[str] = []
    waiting = [(function.__name__, function)]
    while waiting:
        name, one = waiting.pop(0)
        tree = tree_of(one)
        if tree is None or len(parts) == _MOST:
            if not parts:
                return None
            continue  # stays as it is
        parts[name] = Part(name, tree, one)
        free = _free(one)
        for label, value in free.items():
            if label in space and space[label] is not value and label not in parts:
                return None  # one name for two things
            space[label] = value
        for label in _used(one.__code__):
            value = free.get(label, function.__globals__.get(label))
            if isinstance(value, FunctionType) and value.__module__ == function.__module__:
                known = label in parts or any(label == other for other, _ in waiting)
                if not known and value.__globals__ is function.__globals__:
                    waiting.append((label, value))
            elif _numeric(value) and label not in data:
                data.append(label)
    return Program(tuple(parts.values()), bound, space, tuple(data))


def tree_of(function: FunctionType) -> ast.FunctionDef | None:
    """The definition of a function, from its source or else from its byte code."""
    return _from_source(function) or recovered(function)


def _from_source(function: FunctionType) -> ast.FunctionDef | None:
    try:
        lines, first = inspect.getsourcelines(function)
        module = ast.parse(textwrap.dedent("".join(lines)))
    except (OSError, TypeError, SyntaxError, ValueError):
        return None
    found = [node for node in module.body if isinstance(node, ast.FunctionDef)]
    if len(found) != 1 or found[0].name != function.__name__:
        return None
    if any(isinstance(node, ast.Nonlocal | ast.Yield | ast.Await) for node in ast.walk(found[0])):
        return None
    tree = ast.increment_lineno(found[0], first - 1)
    tree.decorator_list = []
    return tree


def _free(function: FunctionType) -> dict[str, Any]:
    """What a closure holds."""
    cells = function.__closure__ or ()
    out: dict[str, Any] = {}
    for name, cell in zip(function.__code__.co_freevars, cells, strict=True):
        try:
            out[name] = cell.cell_contents
        except ValueError:  # not filled yet
            continue
    return out


def _used(code: CodeType) -> Iterator[str]:
    """Names of globals and of free variables, in the order of the code."""
    yield from dict.fromkeys((*code.co_names, *code.co_freevars))
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _used(constant)


def _numeric(value: Any) -> bool:
    """Numbers, and lists, tables and arrays of them."""
    if isinstance(value, bool):
        return False
    if isinstance(value, int | float):
        return True
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "fi" and value.size <= 400
    if isinstance(value, dict):
        return any(_numeric(one) for one in value.values())
    return isinstance(value, list | tuple) and any(_numeric(one) for one in value)
