"""The functions that a formula is made of, as syntax trees, and the data they use."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.recover import recovered

_MOST = 40
"""Functions of one program that are read."""
_ARITHMETIC = frozenset(
    [
        "builtins",
        "types",
        "math",
        "cmath",
        "numpy",
        "itertools",
        "functools",
        "operator",
        "collections",
        "fractions",
        "dataclasses",
        "typing",
        "__future__",
    ]
)
"""Modules that a program may use if it is to be tried with edits in it."""
_REACHING_OUT = frozenset(
    [
        "open",
        "exec",
        "eval",
        "compile",
        "input",
        "exit",
        "quit",
        "breakpoint",
        "__import__",
        "globals",
        "locals",
        "vars",
        "setattr",
        "delattr",
    ]
)
"""Functions that reach beyond arithmetic."""


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
    if not all(_harmless(one, function.__module__) for one in bound):
        return None
    space = dict(function.__globals__)
    parts: dict[str, Part] = {}
    data: list[str] = []
    waiting = [(function.__name__, function)]
    while waiting:
        name, one = waiting.pop(0)
        tree = tree_of(one)
        if tree is None or len(parts) == _MOST or not _plain(tree):
            return None
        parts[name] = Part(name, tree, one)
        free = _free(one)
        for label, value in free.items():
            if label in space and space[label] is not value and label not in parts:
                return None  # one name for two things
            space[label] = value
        for label in _used(one.__code__):
            value = free.get(label, function.__globals__.get(label))
            if not _harmless(value, function.__module__):
                return None
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
    tree = ast.increment_lineno(found[0], first - 1)
    tree.decorator_list = []
    return tree


def _plain(tree: ast.FunctionDef) -> bool:
    """Whether a definition asks for nothing but arithmetic."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Nonlocal | ast.Global | ast.Yield | ast.Await | ast.With | ast.Try):
            return False
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        if any(name.partition(".")[0] not in _ARITHMETIC for name in names):
            return False
        if isinstance(node, ast.Name) and node.id in _REACHING_OUT:
            return False
    return True


def _harmless(value: Any, module: str | None, depth: int = 3) -> bool:
    """Whether an edited program may be given a value: what is only arithmetic cannot be hurt.

    Code in C that is called with a wrong index may end the process; files, processes and whatever
    else a program may reach are not to be tried in vain.
    """
    if isinstance(value, ModuleType):
        return value.__name__.partition(".")[0] in _ARITHMETIC
    if isinstance(value, list | tuple | set | frozenset | dict):
        inner = [*value.values()] if isinstance(value, dict) else [*value]
        return depth > 0 and all(_harmless(one, module, depth - 1) for one in inner[:_MOST])
    if isinstance(value, FunctionType | BuiltinFunctionType | type):
        of = value.__module__ or ""
        return of == module or of.partition(".")[0] in _ARITHMETIC
    home = type(value).__module__ or ""
    if home == module:
        held = [*getattr(value, "__dict__", {}).values()]
        for method in vars(type(value)).values():
            if isinstance(method, FunctionType):
                held += [method.__globals__.get(name) for name in _used(method.__code__)]
        return depth > 0 and all(_harmless(one, module, depth - 1) for one in held)
    return home.partition(".")[0] in _ARITHMETIC


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
