"""Whether a program is plain arithmetic, and may be run with edits in it, again and again."""

from __future__ import annotations

import ast
import enum
import functools
import inspect
import itertools
from collections.abc import Iterator
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType
from typing import Any

from kinlab.doctor.bytecode.syntax import names, nodes

CACHE = type(functools.lru_cache(len))
_HEAP = 1 << 9
_DEEP = 6
"""Lists in lists, dictionaries and objects down to which data are looked at."""
_MOST = 40
"""Entries of a list that are looked at."""
_ARITHMETIC = frozenset(
    [
        "builtins",
        "types",
        "math",
        "cmath",
        "numpy",
        "itertools",
        "functools",
        "_functools",
        "operator",
        "_operator",
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


def is_plain(tree: ast.AST, function: FunctionType) -> bool:
    """Whether a definition asks for nothing but arithmetic."""
    for node in nodes(tree):
        if isinstance(node, _BEYOND):
            return False
        if isinstance(node, ast.Nonlocal) and not {*node.names}.isdisjoint(
            function.__code__.co_freevars
        ):
            return False  # it keeps something from one call to the next
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
    ast.Global,
    ast.Await,
    ast.With,
    ast.Try,
    ast.TryStar,
)
"""What a program of plain arithmetic has not."""


def remembers(tree: ast.FunctionDef, function: FunctionType) -> bool:
    """Whether a function keeps something from one call to the next: a list of what it was asked."""
    known = {**function.__globals__, **closed(function)}
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


def written(owner: type, modules: frozenset[str | None]) -> bool:
    """Whether a class is the program's own."""
    made = bool(owner.__flags__ & _HEAP)  # by a class statement
    own = owner.__module__ in modules
    return made and (own or (None in modules and owner.__module__ == "builtins"))  # so exec has it


def registers(owner: type) -> bool:
    """Whether something happens when a class like it is made."""
    held = (getattr(owner, "__init_subclass__", None), *map(vars(type(owner)).get, _MAKING))
    made = [getattr(one, "__func__", one) for one in held]
    return any(isinstance(f, FunctionType) and f.__module__ not in _STANDARD for f in made)


_MAKING = ("__new__", "__init__", "__prepare__")
_STANDARD = ("abc", "enum", "typing", "dataclasses")


def owners_in(value: Any, modules: frozenset[str | None], depth: int = _DEEP) -> Iterator[type]:
    """The program's own classes of which objects are kept in a value: in lists, in one another."""
    owner = value if isinstance(value, type) else type(value)
    inner: list[Any] = []
    if written(owner, modules) and not issubclass(owner, tuple | enum.Enum):
        yield owner
        inner = [] if isinstance(value, type) else [*getattr(value, "__dict__", {}).values()]
    elif isinstance(value, list | tuple | dict):
        inner = [*value.values()] if isinstance(value, dict) else [*value]
    for one in inner[:_MOST] if depth else ():
        yield from owners_in(one, modules, depth - 1)


def harmless(value: Any, modules: frozenset[str | None], depth: int = _DEEP) -> bool:
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
        return depth > 0 and all(harmless(one, modules, depth - 1) for one in inside)
    if isinstance(value, BuiltinFunctionType) and isinstance(value.__self__, ModuleType):
        return harmless(value.__self__, modules) and value.__name__ not in _REACHING_OUT
    if any(value is one for one in (itertools.count, itertools.cycle, itertools.repeat)):
        return False
    if isinstance(value, CACHE):  # what it answers does not change with the program
        return False
    if isinstance(value, list | tuple | set | frozenset | dict):
        inner = [*value.values()] if isinstance(value, dict) else [*value]
        return depth > 0 and all(harmless(one, modules, depth - 1) for one in inner[:_MOST])
    if isinstance(value, BuiltinFunctionType):
        return (value.__module__ or "").partition(".")[0] in _ARITHMETIC
    if registers(value if isinstance(value, type) else type(value)):
        return False  # a copy of the class would be felt
    if isinstance(value, FunctionType | type):
        of = value.__module__
        return of in modules or (of or "").partition(".")[0] in _ARITHMETIC
    home = type(value).__module__ or ""
    if written(type(value), modules):
        held = [*getattr(value, "__dict__", {}).values()]
        for method in vars(type(value)).values():
            if not isinstance(method, FunctionType):
                continue
            space = method.__globals__
            if space.get("__name__") != "dataclasses":  # with what one prints itself
                held += [space.get(name) for name in used_in(method.__code__)]
        return depth > 0 and all(harmless(one, modules, depth - 1) for one in held)
    return home.partition(".")[0] in _ARITHMETIC


def closed(function: FunctionType) -> dict[str, Any]:
    """What a closure holds."""
    cells = function.__closure__ or ()
    out: dict[str, Any] = {}
    for name, cell in zip(function.__code__.co_freevars, cells, strict=True):
        try:
            out[name] = cell.cell_contents
        except ValueError:  # not filled yet
            continue
    return out


def used_in(code: CodeType) -> Iterator[str]:
    """Names of globals and of free variables, in the order of the code."""
    yield from dict.fromkeys((*code.co_names, *code.co_freevars))
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from used_in(constant)


def functions_in(value: Any, depth: int = _DEEP) -> Iterator[FunctionType]:
    """The functions kept in a value: in a list, in what gives some of a function's arguments."""
    inner: list[Any] = []
    if isinstance(value, functools.partial):
        inner = [value.func, *value.args, *value.keywords.values()]
    elif isinstance(value, list | tuple | dict):
        inner = [*value.values()] if isinstance(value, dict) else [*value]
    for one in inner[:_MOST] if depth else ():
        if isinstance(one, FunctionType):
            yield one
        yield from functions_in(one, depth - 1)
