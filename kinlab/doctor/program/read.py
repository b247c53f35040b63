"""The functions that a formula is made of, as syntax trees, and the data they use."""

from __future__ import annotations

import ast
import copy
import functools
import inspect
import itertools
import os
import sys
import textwrap
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.recover import recovered
from kinlab.doctor.bytecode.syntax import names, nodes
from kinlab.doctor.program.loaded import felt, of_module, setting

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
_LOADED = "<module>"
"""What Python calls the lines outside all functions."""
_GENERATED = "__create_fn__"
"""In which a dataclass makes its methods."""


@dataclass(frozen=True, eq=False)
class OwnFunction:
    """One function of a program, or the lines that run when its module is loaded.

    Attributes:
        name: what the program calls it.
        owner: the class whose method it is.
        tree: its definition; line numbers are those of its file, or of the text it was made from.
        function: the function itself; of a module's lines the one that they are for.
        spots: where it is kept besides: in which class, or None, under which name.
        kept: what it is wrapped in there: a property, a static method.
        sets: the names that the lines of a module set; of a function none.
    """

    name: str
    tree: ast.FunctionDef
    function: FunctionType
    owner: type | None = None
    spots: list[tuple[type | None, str]] = field(default_factory=list)
    kept: type = FunctionType
    sets: frozenset[str] = frozenset()


@dataclass(frozen=True, eq=False)
class Making:
    """How a function was made by another.

    Attributes:
        name: of the function.
        given: the names of what the other one is given.
        closed: what the function holds of it.
    """

    name: str
    given: tuple[str, ...]
    closed: dict[str, Any]


@dataclass(frozen=True, eq=False)
class OwnProgram:
    """A function and the functions of the same module that it calls.

    Attributes:
        parts: the function itself first.
        bound: what is given to it before the state: the object of a method.
        space: what every name outside the functions stands for.
        data: names of numbers, and of lists, tables and arrays of numbers, that the parts use.
        modules: those whose functions and classes are the program's own.
        through: for names of what holds functions (a list, a partial), the functions' names.
        plain: the same program without what runs before the function is asked, if that is read:
            the lines of its module, the function that makes it.
        making: of a function that another one makes, which is the first part: how.
    """

    parts: tuple[OwnFunction, ...]
    bound: tuple[Any, ...]
    space: dict[str, Any]
    data: tuple[str, ...]
    modules: frozenset[str | None]
    through: dict[str, set[str]]
    plain: OwnProgram | None = None
    making: Making | None = None


def read(function: Callable[..., Any]) -> OwnProgram | None:
    """The program behind a function; None where its source cannot be had for certain."""
    bound: tuple[Any, ...] = ()
    if isinstance(function, MethodType):
        bound, function = (function.__self__,), function.__func__
    if not isinstance(function, FunctionType) or function.__code__.co_flags & inspect.CO_GENERATOR:
        return None
    modules = _own_modules(function)
    if not all(_harmless(one, modules) for one in bound):
        return None
    program = _with_lines(_Reading(function, modules, bound))
    maker = _maker(function) if program is not None and not bound else None
    if program is None or maker is None:
        return program
    whole = _with_lines(_Reading(maker[0], modules, (), maker[1]))
    if whole is None:
        return program
    held = {name: value for name, value in closed(function).items() if not callable(value)}
    made = Making(function.__name__, tuple(maker[1]), held)
    before = program
    if whole.plain is not None:
        before = replace(whole.plain, plain=program, making=made)
    return replace(whole, plain=before, making=made)


@dataclass(frozen=True, eq=False)
class _Reading:
    """What is to be read: a function, its modules, what it is bound to, what it will be given."""

    function: FunctionType
    modules: frozenset[str | None]
    bound: tuple[Any, ...]
    given: dict[str, Any] = field(default_factory=dict)
    lines: ast.FunctionDef | None = None


def _with_lines(asked: _Reading) -> OwnProgram | None:
    """A program with the lines of its module, if it has any that can be read."""
    plain = _Reader(asked).program()
    module = of_module(asked.function) if plain is not None else None
    if plain is None or module is None:
        return plain
    used = {name for part in plain.parts for name in _used(part.function.__code__)}
    lines = module.needed(
        used,
        lambda value: _harmless(value, asked.modules),
        lambda node: _plain(node, asked.function),
    )
    whole = None if lines is None else _Reader(replace(asked, lines=lines)).program()
    known = {part.function for part in plain.parts}
    if whole is None or any(felt(x.tree) for x in whole.parts if x.function not in known):
        return plain
    return replace(whole, plain=plain)


def _maker(function: FunctionType) -> tuple[FunctionType, dict[str, Any]] | None:
    """The function that made a closure, and what it was given, as far as the closure holds it."""
    if not function.__closure__:
        return None
    code, held = function.__code__, closed(function)
    for one in function.__globals__.values():
        if isinstance(one, FunctionType) and code in one.__code__.co_consts:
            try:
                asked = inspect.signature(one).parameters.values()
            except (TypeError, ValueError):
                return None
            plain = all(p.kind is p.POSITIONAL_OR_KEYWORD for p in asked)
            given = {p.name: held.get(p.name, p.default) for p in asked}
            known = not any(x is inspect.Parameter.empty or callable(x) for x in given.values())
            tree = tree_of(one) if plain and known else None
            return None if tree is None or felt(tree) else (one, given)
    return None


def _own_modules(function: FunctionType) -> frozenset[str | None]:
    """The function's module, and those in the same folder that it uses."""
    own: set[str | None] = {function.__module__}
    folder = os.path.dirname(function.__code__.co_filename)
    values = function.__globals__.values() if os.path.isabs(folder) else ()
    for value in values:
        module = value if isinstance(value, ModuleType) else sys.modules.get(_home(value) or "")
        file = getattr(module, "__file__", None) or ""
        if os.path.dirname(file) == folder and module is not None and "." not in module.__name__:
            own.add(module.__name__)
    return frozenset(own)


def _home(value: Any) -> str | None:
    known = isinstance(value, FunctionType | type | _Cache)
    return value.__module__ if known and isinstance(value.__module__, str) else None


class _Reader:
    """The functions of a program while they are found."""

    def __init__(self, asked: _Reading) -> None:
        self.asked, self.function, self.modules = asked, asked.function, asked.modules
        self.lines = asked.lines
        self.space = dict(self.function.__globals__)
        self.used: set[str] = set()
        self.parts: dict[FunctionType, OwnFunction] = {}
        self.data: list[str] = []
        self.owners: dict[type, None] = {}
        self.through: dict[str, set[str]] = {}
        self.waiting: list[tuple[type | None, str, FunctionType, type]] = []

    def program(self) -> OwnProgram | None:
        """All of it; None where something cannot be read, or may not be tried."""
        name, bound = self.function.__name__, self.asked.bound
        owner = type(bound[0]) if bound else None
        first = name if name.isidentifier() else "function"
        self.waiting.append((owner, first, self.function, FunctionType))
        sets: frozenset[str] = frozenset()
        for label, value in self.asked.given.items():
            if self.space.setdefault(label, value) is not value or not self._value(label, value):
                return None
        if self.lines is not None:
            sets = setting(self.lines)
            code = compile(ast.Module(self.lines.body, []), "<lines>", "exec")
            if not self._names_of(self.function, [*_used(code)]):
                return None
        while self.waiting:
            owner, name, one, kept = self.waiting.pop(0)
            if one in self.parts:
                self._wait(owner, name, one, kept)
                continue
            tree = tree_of(one)
            if tree is None or not _plain(tree, one) or _remembers(tree, one):
                if self._may_stay(name, owner):
                    continue
                return None
            if len(self.parts) == _MOST:
                return None
            if self._may_stay(name, owner) and not self._harmless_all(one):
                continue
            self.parts[one] = OwnFunction(name, tree, one, owner, [(owner, name)], kept)
            if not self._names_of(one, [*_used(one.__code__)]):
                return None
        parts = [*self.parts.values()]
        if self.lines is not None:
            parts.append(OwnFunction(_LOADED, self.lines, self.function, sets=sets))
        held = [label for label in self.data if label not in sets or _is_class(self.space[label])]
        space = {
            label: value if label in (*held, *sets) else _out_of_reach(value)
            for label, value in self.space.items()
        }
        return OwnProgram(tuple(parts), bound, space, tuple(held), self.modules, self.through)

    @staticmethod
    def _may_stay(name: str, owner: type | None) -> bool:
        """Whether a method need not be read: it is the user's own wherever objects are made."""
        return owner is not None and implied(name) and name != "__call__"

    def _harmless_all(self, one: FunctionType) -> bool:
        values = (one.__globals__.get(label) for label in _used(one.__code__))
        return all(_harmless(value, self.modules) for value in values)

    def _names_of(self, one: FunctionType, used: list[str]) -> bool:
        for label, value in closed(one).items():
            if self.space.get(label, value) is not value:
                return False  # one name for two things
            self.space[label] = value
        for label in used:
            value = closed(one).get(label, one.__globals__.get(label))
            if label in one.__globals__ and self.space.setdefault(label, value) is not value:
                return False
            if isinstance(value, _Cache) and isinstance(value.__wrapped__, FunctionType):
                value = value.__wrapped__
            if not self._value(label, value):
                return False
        self.owners |= {part.owner: None for part in self.parts.values() if part.owner}
        self.used |= {*used}
        for owner in self.owners:
            for name, held in vars(owner).items():
                method, kept = _unwrapped(held)
                if method is not None and (name in self.used or _implied(name, method)):
                    self._wait(owner, name, method, kept)
        return True

    def _value(self, label: str, value: Any) -> bool:
        """Takes what a name stands for; False where it may not be given to edited lines."""
        if not _harmless(value, self.modules):
            return False
        if isinstance(value, FunctionType):
            self._wait(None, label, value)
        elif _numeric(value) and label not in self.data:
            self.data.append(label)
        found = dict.fromkeys(_owners(value, self.modules))
        inner = [f for f in functions_in(value) if self.space.get(f.__name__) is f]
        if inner:
            self.through[label] = {f.__name__ for f in inner}
        for f in inner:
            self._wait(None, f.__name__, f)
        if (found or inner) and label not in self.data:
            self.data.append(label)
        self.owners |= found
        return True

    def _wait(
        self, owner: type | None, name: str, function: FunctionType, kept: type = FunctionType
    ) -> None:
        if function.__module__ not in self.modules:
            return
        spot = (owner, name)
        known = self.parts.get(function)
        if known is not None:
            if spot not in known.spots and (owner is None or kept is known.kept):
                known.spots.append(spot)
        elif all(spot != one[:2] for one in self.waiting):
            self.waiting.append((owner, name, function, kept))


def _is_class(value: Any) -> bool:
    return isinstance(value, type)


def _unwrapped(held: Any) -> tuple[FunctionType | None, type]:
    """What a class keeps as a function, and what that is wrapped in."""
    kept, inner = type(held), held
    if isinstance(held, property):
        inner = held.fget if held.fset is None else None
    elif isinstance(held, staticmethod | classmethod):
        inner = held.__func__
    elif isinstance(held, _Cache):
        kept, inner = FunctionType, held.__wrapped__
    return (inner, kept) if isinstance(inner, FunctionType) else (None, kept)


def _implied(name: str, method: FunctionType) -> bool:
    """Whether a method is called without its name: to make an object, to multiply two."""
    code = method.__code__
    written = _GENERATED not in code.co_qualname and "__class__" not in code.co_freevars
    return name == "__call__" or (implied(name) and written)


def implied(name: str) -> bool:
    """Whether a method of that name is called without it: ``__init__``."""
    return name[:2] == name[-2:] == "__"


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


def _plain(tree: ast.AST, function: FunctionType) -> bool:
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


def _remembers(tree: ast.FunctionDef, function: FunctionType) -> bool:
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


def _owners(value: Any, modules: frozenset[str | None], depth: int = _DEEP) -> Iterator[type]:
    """The program's own classes of which objects are kept in a value: in lists, in one another."""
    owner = value if isinstance(value, type) else type(value)
    inner: list[Any] = []
    if written(owner, modules):
        yield owner
        inner = [] if isinstance(value, type) else [*getattr(value, "__dict__", {}).values()]
    elif isinstance(value, list | tuple | dict):
        inner = [*value.values()] if isinstance(value, dict) else [*value]
    for one in inner[:_MOST] if depth else ():
        yield from _owners(one, modules, depth - 1)


def _harmless(value: Any, modules: frozenset[str | None], depth: int = _DEEP) -> bool:
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
        return depth > 0 and all(_harmless(one, modules, depth - 1) for one in inside)
    if isinstance(value, BuiltinFunctionType) and isinstance(value.__self__, ModuleType):
        return _harmless(value.__self__, modules) and value.__name__ not in _REACHING_OUT
    if any(value is one for one in (itertools.count, itertools.cycle, itertools.repeat)):
        return False
    if isinstance(value, _Cache):  # what it answers does not change with the program
        return False
    if isinstance(value, list | tuple | set | frozenset | dict):
        inner = [*value.values()] if isinstance(value, dict) else [*value]
        return depth > 0 and all(_harmless(one, modules, depth - 1) for one in inner[:_MOST])
    if isinstance(value, BuiltinFunctionType):
        return (value.__module__ or "").partition(".")[0] in _ARITHMETIC
    if isinstance(value, FunctionType | type):
        of = value.__module__
        return of in modules or (of or "").partition(".")[0] in _ARITHMETIC
    home = type(value).__module__ or ""
    if written(type(value), modules):
        held = [*getattr(value, "__dict__", {}).values()]
        for method in vars(type(value)).values():
            space = method.__globals__ if isinstance(method, FunctionType) else {}
            if space and space.get("__name__") != "dataclasses":  # what a dataclass prints itself with
                held += [space.get(name) for name in _used(method.__code__)]
        return depth > 0 and all(_harmless(one, modules, depth - 1) for one in held)
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
