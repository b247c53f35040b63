"""Whether a program is plain arithmetic, and may be run with edits in it, again and again."""

from __future__ import annotations

import ast
import enum
import functools
import inspect
import itertools
from collections.abc import Container, Iterable, Iterator
from contextlib import suppress
from types import (
    BuiltinFunctionType,
    CodeType,
    FunctionType,
    MemberDescriptorType,
    MethodType,
    ModuleType,
)
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import names, nodes
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.robot import Robot

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
        "abc",
        "argparse",
        "contextlib",
        "copy",
        "enum",
        "logging",
        "numbers",
        "time",
        "warnings",
    ]
)
"""Modules that a program may use if it is to be tried with edits in it."""
_LINEAR = ("scipy", "scipy.linalg", "scipy.spatial", "scipy.spatial.transform", "scipy.constants")
"""Of a large package the modules of which the same is true."""
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
        "io",
        "sleep",
        "view",
        "basicConfig",
        "parse_args",
        "parse_known_args",
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
    set_ = {*names(tree, ast.Store)}
    catches = any(isinstance(node, ast.Try) for node in nodes(tree))
    for node in nodes(tree):
        if isinstance(node, _BEYOND):
            return False
        if isinstance(node, ast.While) and catches:
            return False  # it might catch what ends it
        if isinstance(node, ast.With) and not all(map(_settles, node.items)):
            return False
        kept = set_.intersection(node.names) if isinstance(node, ast.Global) else ()
        if not all(_counts_calls(tree, name) and not _reads(function, name) for name in kept):
            return False  # it keeps something from one call to the next
        if isinstance(node, ast.Nonlocal) and not {*node.names}.isdisjoint(
            function.__code__.co_freevars
        ):
            return False  # it keeps something from one call to the next
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        modules += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        if not all(map(_arithmetic, modules)):
            return False
        if isinstance(node, ast.Name) and node.id in _REACHING_OUT:
            return False
        if isinstance(node, ast.Attribute) and node.attr in _REACHING_OUT:
            return False
        if isinstance(node, ast.Attribute) and ast.unparse(node) in _ENDLESS:
            return False
    return True


def _counts_calls(tree: ast.AST, name: str) -> bool:
    """Whether a global is a counter of calls, which nothing here reads: ``calls += 1``."""
    lines = [x for x in nodes(tree) if isinstance(x, ast.AugAssign)]
    lines = [x for x in lines if getattr(x.target, "id", "") == name]
    counting = [x for x in lines if isinstance(x.value, ast.Constant)]
    return len(counting) == sum(one == name for one in names(tree))


def _reads(function: FunctionType, name: str) -> bool:
    """Whether anything else beside a function, or a class's method, has a global's name."""
    beside = [*function.__globals__.values()]
    beside += [one for x in beside if isinstance(x, type) for one in vars(x).values()]
    codes = (x.__code__ for x in beside if isinstance(x, FunctionType))
    return any(name in used_in(code) for code in codes if code is not function.__code__)


def _arithmetic(module: str) -> bool:
    """Whether all that a module holds is arithmetic."""
    public = module.partition("._")[0]  # scipy.linalg._matfuncs
    return module.partition(".")[0] in _ARITHMETIC or public in _LINEAR


def _settles(item: ast.withitem) -> bool:
    """Whether what stands behind ``with`` only settles how numbers are reckoned, or told."""
    node = item.context_expr
    return isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] in _SETTLING


_SETTLING = ("errstate", "printoptions", "catch_warnings", "suppress")
_BEYOND = (
    ast.Await,
    ast.AsyncWith,
    ast.TryStar,
)
"""What a program of plain arithmetic has not."""


def remembers(tree: ast.FunctionDef, function: FunctionType, begun: frozenset[str]) -> bool:
    """Whether a function keeps something from one call to the next: a list of what it was asked.

    What is known to have ``begun`` with nothing in it does not matter: it can begin so again.
    """
    known = {**function.__globals__, **closed(function)}
    named = inspect.signature(function, follow_wrapped=False).parameters.values()
    kept = {p.name for p in named if isinstance(p.default, list | dict | set)}
    own = {*names(tree, ast.Store)}
    own |= {n.arg for n in nodes(tree) if isinstance(n, ast.arg)} - kept
    for node in nodes(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            root = _root(node.func.value)
            held = None if root is None or root in own | begun else known.get(root, ())
            if node.func.attr in _KEEPING and not isinstance(held, ModuleType | None):
                return True
        if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store):
            root = _root(node.value)
            held = None if root is None or root in begun else known.get(root)
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
_BEFORE = ("__init__", "__post_init__")
"""Methods that have run when there is an object."""
_STANDARD = ("abc", "enum", "typing", "dataclasses")


def home(value: Any) -> str:
    """The package that a value comes from, or what made it."""
    if isinstance(value, ModuleType):
        return value.__name__.partition(".")[0]
    owner = value if isinstance(value, FunctionType | type) else type(value)
    return (owner.__module__ or "").partition(".")[0]


def plain_function(value: Any) -> Any:
    """The function behind one that remembers its answers, or that is compiled; others as they are.

    What is compiled by numba is the same arithmetic.
    """
    inner = value.__wrapped__ if isinstance(value, CACHE) else None
    if home(value) == "numba":
        inner = getattr(value, "py_func", None)
    return inner if isinstance(inner, FunctionType) else value


def attributes(value: Any) -> dict[str, Any]:
    """What an object keeps, by name; what it has no slot filled for is not there."""
    kept: dict[str, Any] = {}
    for kind in type(value).__mro__:
        for name, slot in vars(kind).items():
            if isinstance(slot, MemberDescriptorType) and name[:2] != "__":
                with suppress(AttributeError):
                    kept[name] = slot.__get__(value)
    return {**kept, **getattr(value, "__dict__", {})}


def alike(one: Any, other: Any, depth: int = 6, without: Container[str] = ()) -> bool:
    """Whether what a line gives anew is what is there; of functions nothing is asked.

    Args:
        one: what is given anew.
        other: what is there.
        depth: of what is in one another.
        without: attributes that are set later, of which nothing is asked.
    """
    if depth == 0 or callable(one):
        return callable(one) == callable(other)
    if isinstance(one, int | float | complex | np.ndarray | np.number):
        try:
            close = np.allclose(one, other, rtol=1e-12, atol=0.0, equal_nan=True)
        except OverflowError:  # a whole number beyond any float
            return bool(one == other)
        except (TypeError, ValueError):
            return False
        return bool(close) and np.shape(one) == np.shape(other)
    if isinstance(one, list | tuple):
        same = isinstance(other, list | tuple) and len(one) == len(other)
        pairs = zip(one, other, strict=True) if same else ()
        return same and all(alike(a, b, depth - 1, without) for a, b in pairs)
    if not isinstance(one, dict):
        if type(one).__name__ != type(other).__name__:
            return False
        if not attributes(one):
            plain = getattr(type(one), "__eq__", None) is object.__eq__
            return plain or bool(one == other)
        one, other = (
            {name: x for name, x in attributes(of).items() if name not in without}
            for of in (one, other)
        )
    if not isinstance(other, dict) or one.keys() != other.keys():
        return False
    return all(alike(value, other[key], depth - 1, without) for key, value in one.items())


def owners_in(value: Any, modules: frozenset[str | None], depth: int = _DEEP) -> Iterator[type]:
    """The program's own classes of which objects are kept in a value: in lists, in one another."""
    owner = value if isinstance(value, type) else type(value)
    inner: list[Any] = []
    if written(owner, modules) and not issubclass(owner, tuple | enum.Enum):
        yield owner
        inner = [] if isinstance(value, type) else [*attributes(value).values()]
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
        return _arithmetic(value.__name__)
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
        return _arithmetic(value.__module__ or "")
    if registers(value if isinstance(value, type) else type(value)):
        return False  # a copy of the class would be felt
    if isinstance(value, FunctionType | type):
        of = value.__module__
        return of in modules or _arithmetic(of or "")
    if written(type(value), modules):
        held = [*attributes(value).values()]
        for name, method in vars(type(value)).items():
            if not isinstance(method, FunctionType) or name[:2] != "__" or name in _BEFORE:
                continue  # the object is made; other methods are asked for where they are called
            space = method.__globals__
            if space.get("__name__") != "dataclasses":  # with what one prints itself
                held += [space.get(used) for used in used_in(method.__code__)]
        return depth > 0 and all(harmless(one, modules, depth - 1) for one in held)
    described = isinstance(value, Robot | DHTable | DHLink)  # asked for its numbers
    return described or _arithmetic(type(value).__module__ or "")


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


def made_like(row: Any, entries: Iterable[Any]) -> Any:
    """A list or a tuple of the same kind with other entries; of a named one, too."""
    return row._make(entries) if hasattr(row, "_make") else type(row)(entries)
