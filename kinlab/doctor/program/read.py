"""The functions that a formula is made of, as syntax trees, and the data they use."""

from __future__ import annotations

import ast
import copy
import functools
import inspect
import itertools
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.recover import recovered
from kinlab.doctor.bytecode.syntax import names, nodes

_Cache = type(functools.lru_cache(len))
_HEAP = 1 << 9
_DEEP = 6
"""Lists in lists, dictionaries and objects down to which data are looked at."""
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
        "save",
        "savez",
        "savetxt",
        "savez_compressed",
        "tofile",
        "dump",
        "memmap",
        "fromfile",
        "ctypeslib",
    ]
)
"""Functions that reach beyond arithmetic."""
_ENDLESS = ("itertools.count", "itertools.cycle", "itertools.repeat")
"""Iterators that only a condition of the program ends."""
_KEEPING = frozenset(
    ["append", "extend", "insert", "pop", "remove", "clear", "update", "add", "setdefault"]
)
"""Methods with which a program may remember what it was asked before."""


@dataclass(frozen=True, eq=False)
class OwnFunction:
    """One function of a program.

    Attributes:
        name: what the program calls it.
        owner: the class whose method it is.
        tree: its definition; line numbers are those of its file, or of the text it was made from.
        function: the function itself.
    """

    name: str
    tree: ast.FunctionDef
    function: FunctionType
    owner: type | None = None


@dataclass(frozen=True, eq=False)
class OwnProgram:
    """A function and the functions of the same module that it calls.

    Attributes:
        parts: the function itself first.
        bound: what is given to it before the state: the object of a method.
        space: what every name outside the functions stands for.
        data: names of numbers, and of lists, tables and arrays of numbers, that the parts use.
    """

    parts: tuple[OwnFunction, ...]
    bound: tuple[Any, ...]
    space: dict[str, Any]
    data: tuple[str, ...]


def read(function: Callable[..., Any]) -> OwnProgram | None:
    """The program behind a function; None where its source cannot be had for certain."""
    bound: tuple[Any, ...] = ()
    if isinstance(function, MethodType):
        bound, function = (function.__self__,), function.__func__
    if not isinstance(function, FunctionType):
        return None
    if not all(_harmless(one, function.__module__) for one in bound):
        return None
    return _Reader(function).program(bound)


class _Reader:
    """The functions of a program while they are found."""

    def __init__(self, function: FunctionType) -> None:
        self.function = function
        self.space = dict(function.__globals__)
        self.parts: dict[tuple[type | None, str], OwnFunction] = {}
        self.data: list[str] = []
        self.owners: dict[type, None] = {}
        self.waiting: list[tuple[type | None, str, FunctionType]] = []

    def program(self, bound: tuple[Any, ...]) -> OwnProgram | None:
        """All of it; None where something cannot be read, or may not be tried."""
        name = self.function.__name__
        owner = type(bound[0]) if bound else None
        self.waiting.append((owner, name if name.isidentifier() else "function", self.function))
        while self.waiting:
            owner, name, one = self.waiting.pop(0)
            tree = tree_of(one)
            if tree is None or len(self.parts) == _MOST or not _plain(tree):
                return None
            if _remembers(tree, one):
                return None
            self.parts[owner, name] = OwnFunction(name, tree, one, owner)
            if not self._names_of(one):
                return None
        space = {
            label: value if label in self.data else _out_of_reach(value)
            for label, value in self.space.items()
        }
        return OwnProgram(tuple(self.parts.values()), bound, space, tuple(self.data))

    def _names_of(self, one: FunctionType) -> bool:
        free = _free(one)
        for label, value in free.items():
            if self.space.get(label, value) is not value:
                return False  # one name for two things
            self.space[label] = value
        used = [*_used(one.__code__)]
        for label in used:
            value = free.get(label, self.function.__globals__.get(label))
            if not _harmless(value, self.function.__module__):
                return False
            if isinstance(value, FunctionType):
                self._wait(None, label, value)
            elif _numeric(value) and label not in self.data:
                self.data.append(label)
            found = dict.fromkeys(_owners(value, self.function.__module__))
            if found and label not in self.data:
                self.data.append(label)
            self.owners |= found
        self.owners |= {part.owner: None for part in self.parts.values() if part.owner}
        for owner in self.owners:
            for name, method in vars(owner).items():
                if isinstance(method, FunctionType) and (name in used or name == "__call__"):
                    self._wait(owner, name, method)
        return True

    def _wait(self, owner: type | None, name: str, function: FunctionType) -> None:
        known = (owner, name) in self.parts or (owner, name) in [w[:2] for w in self.waiting]
        own = function.__module__ == self.function.__module__
        if own and not known and function.__globals__ is self.function.__globals__:
            self.waiting.append((owner, name, function))


def tree_of(function: FunctionType) -> ast.FunctionDef | None:
    """The definition of a function, from its source or else from its byte code."""
    return _from_source(function) or recovered(function)


def _from_source(function: FunctionType) -> ast.FunctionDef | None:
    if hasattr(function, "__wrapped__"):
        return None  # the source would be that of what it wraps
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
    for node in nodes(tree):
        if isinstance(node, _BEYOND):
            return False
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        if any(name.partition(".")[0] not in _ARITHMETIC for name in names):
            return False
        if isinstance(node, ast.Name) and node.id in _REACHING_OUT:
            return False
        if isinstance(node, ast.Attribute) and node.attr in _REACHING_OUT:
            return False
        if isinstance(node, ast.Attribute) and ast.unparse(node) in _ENDLESS:
            return False
    return True


_BEYOND = (
    ast.Nonlocal,
    ast.Global,
    ast.Yield,
    ast.YieldFrom,
    ast.Await,
    ast.With,
    ast.Try,
    ast.TryStar,
)
"""What a program of plain arithmetic has not."""


def _remembers(tree: ast.FunctionDef, function: FunctionType) -> bool:
    """Whether a function keeps something from one call to the next: a list of what it was asked."""
    known = {**function.__globals__, **_free(function)}
    named = inspect.signature(function, follow_wrapped=False).parameters.values()
    kept = {p.name for p in named if isinstance(p.default, list | dict | set)}
    own = {*names(tree, ast.Store)}
    own |= {n.arg for n in nodes(tree) if isinstance(n, ast.arg)} - kept
    for node in nodes(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            root = _root(node.func.value)
            held = None if root is None or root in own else known.get(root, ())
            if node.func.attr in _KEEPING and not isinstance(held, ModuleType | None):
                return True
        if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store):
            root = _root(node.value)
            held = None if root is None else known.get(root)
            if root in kept or (root not in own and isinstance(held, dict)):
                return True
    return False


def _root(node: ast.AST) -> str | None:
    """The name that an expression begins with."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else None


def written(owner: type, module: str | None) -> bool:
    """Whether a class is the program's own."""
    made = bool(owner.__flags__ & _HEAP)  # by a class statement
    return made and owner.__module__ == (module or "builtins")  # so exec has it without a name


def _owners(value: Any, module: str | None, depth: int = _DEEP) -> Iterator[type]:
    """The program's own classes of which objects are kept in a value: in lists, in one another."""
    owner = value if isinstance(value, type) else type(value)
    inner: list[Any] = []
    if written(owner, module):
        yield owner
        inner = [] if isinstance(value, type) else [*getattr(value, "__dict__", {}).values()]
    elif isinstance(value, list | tuple | dict):
        inner = [*value.values()] if isinstance(value, dict) else [*value]
    for one in inner[:_MOST] if depth else ():
        yield from _owners(one, module, depth - 1)


def _harmless(value: Any, module: str | None, depth: int = _DEEP) -> bool:
    """Whether an edited program may be given a value: what is only arithmetic cannot be hurt.

    Code in C that is called with a wrong index may end the process; files, processes and whatever
    else a program may reach are not to be tried in vain.
    """
    if isinstance(value, ModuleType):
        return value.__name__.partition(".")[0] in _ARITHMETIC
    if isinstance(value, MethodType | functools.partial):
        inside = (
            (value.__self__, value.__func__)
            if isinstance(value, MethodType)
            else (value.func, *value.args, *value.keywords.values())
        )
        return depth > 0 and all(_harmless(one, module, depth - 1) for one in inside)
    if isinstance(value, BuiltinFunctionType) and isinstance(value.__self__, ModuleType):
        return _harmless(value.__self__, module) and value.__name__ not in _REACHING_OUT
    if any(value is one for one in (itertools.count, itertools.cycle, itertools.repeat)):
        return False
    if isinstance(value, _Cache):
        return False  # what it answers does not change with the program
    if isinstance(value, list | tuple | set | frozenset | dict):
        inner = [*value.values()] if isinstance(value, dict) else [*value]
        return depth > 0 and all(_harmless(one, module, depth - 1) for one in inner[:_MOST])
    if isinstance(value, BuiltinFunctionType):
        return (value.__module__ or "").partition(".")[0] in _ARITHMETIC
    if isinstance(value, FunctionType | type):
        of = value.__module__
        return of == module or (of or "").partition(".")[0] in _ARITHMETIC
    home = type(value).__module__ or ""
    if written(type(value), module):
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


def _out_of_reach(value: Any) -> Any:
    """Data of the module that the program does not use: an edit that names them changes nothing."""
    if isinstance(value, np.ndarray):
        view = value.view()
        view.flags.writeable = False
        return view
    return copy.deepcopy(value) if isinstance(value, list | dict) and _numbers(value) else value


def _numbers(value: Any) -> bool:
    """Whether there is nothing but numbers in it."""
    if isinstance(value, dict):
        value = [*value.values()]
    if isinstance(value, list | tuple):
        return all(_numbers(one) for one in value)
    return isinstance(value, int | float | np.ndarray)


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
