"""The functions that a formula is made of, as syntax trees, and the data they use."""

from __future__ import annotations

import ast
import copy
import functools
import inspect
import sys
import textwrap
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import dropwhile
from pathlib import Path
from types import FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.recover import recovered
from kinlab.doctor.bytecode.syntax import names
from kinlab.doctor.program.own.definitions import ByDefault, with_defaults_inside
from kinlab.doctor.program.own.loaded import drawing, felt, of_module, setting
from kinlab.doctor.program.own.plain import (
    CACHE,
    closed,
    functions_in,
    harmless,
    is_plain,
    owners_in,
    plain_function,
    remembers,
    used_in,
    written,
)

_MOST = 40
"""Functions of one program that are read."""
_LOADED = "module"
"""What the lines outside all functions are called."""
MAKING = ("__new__", "__init__", "__post_init__")
"""Methods that run when an object is made."""
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
        held: these names, and those of other lists and dictionaries that the parts use.
        modules: those whose functions and classes are the program's own.
        through: for names of what holds functions (a list, a partial), the functions' names.
        plain: the same program without what runs before the function is asked, if that is read:
            the lines of its module, the function that makes it.
        making: of a function that another one makes, which is the first part: how.
        begun: names of lists and dictionaries that only the parts fill: they begin empty.
    """

    parts: tuple[OwnFunction, ...]
    bound: tuple[Any, ...]
    space: dict[str, Any]
    data: tuple[str, ...]
    held: frozenset[str]
    modules: frozenset[str | None]
    through: dict[str, set[str]]
    plain: OwnProgram | None = None
    making: Making | None = None
    begun: frozenset[str] = frozenset()


def read(function: Callable[..., Any]) -> OwnProgram | None:
    """The program behind a function; None where its source cannot be had for certain."""
    bound, function = _given(function)
    if not isinstance(function, FunctionType) or function.__code__.co_flags & inspect.CO_GENERATOR:
        return None
    modules = _own_modules(function)
    if not all(harmless(one, modules) for one in bound):
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


def _given(function: Any) -> tuple[tuple[Any, ...], Any]:
    """What is given to a function before the state, and the function itself.

    Of a method, of an object that is called, of a partial whose keywords become defaults.
    """
    bound: tuple[Any, ...] = ()
    while not isinstance(function, FunctionType):
        if isinstance(function, MethodType):
            bound, function = (function.__self__, *bound), function.__func__
        elif isinstance(function, functools.partial):
            bound, function = (*function.args, *bound), _by_default(function)
        elif isinstance(called := getattr(type(function), "__call__", None), FunctionType):  # noqa: B004
            bound, function = (function, *bound), called
        elif (inner := plain_function(function)) is not function:
            function = inner
        else:
            return bound, None
    return bound, function


def _by_default(given: functools.partial[Any]) -> Any:
    """The function of a partial, with what that gives it by name as defaults."""
    inner: Any = given.func
    if not given.keywords or not isinstance(inner, FunctionType):
        return inner
    asked = [*inspect.signature(inner).parameters.values()]
    plain = [p for p in asked if p.kind is p.POSITIONAL_OR_KEYWORD]
    values = {p.name: given.keywords.get(p.name, p.default) for p in asked}
    last = [*dropwhile(lambda p: values[p.name] is inspect.Parameter.empty, plain)]
    if any(values[p.name] is inspect.Parameter.empty for p in last):
        return None
    defaults = tuple(values[p.name] for p in last)
    other = FunctionType(
        inner.__code__, inner.__globals__, inner.__name__, defaults, inner.__closure__
    )
    named = [p.name for p in asked if p.kind is p.KEYWORD_ONLY]
    only = {name: values[name] for name in named if values[name] is not inspect.Parameter.empty}
    other.__kwdefaults__, other.__module__ = only or None, inner.__module__
    return other


@dataclass(frozen=True, eq=False)
class _Reading:
    """What is to be read: a function, its modules, what it is bound to, what it will be given."""

    function: FunctionType
    modules: frozenset[str | None]
    bound: tuple[Any, ...]
    given: dict[str, Any] = field(default_factory=dict)
    lines: ast.FunctionDef | None = None
    begun: frozenset[str] = frozenset()


def _with_lines(asked: _Reading) -> OwnProgram | None:
    """A program with the lines of its module, if it has any that can be read."""
    module = of_module(asked.function)
    asked = replace(asked, begun=frozenset() if module is None else module.begun)
    plain = _Reader(asked).program()
    if plain is None or module is None:
        return plain
    used = {name for part in plain.parts for name in used_in(part.function.__code__)}
    lines = module.needed(
        used,
        lambda value: harmless(value, asked.modules),
        lambda node: is_plain(node, asked.function),
    )
    whole = None if lines is None else _Reader(replace(asked, lines=lines)).program()
    known = {part.function for part in plain.parts}
    if whole is None or any(_is_felt(x) for x in whole.parts if x.function not in known):
        return plain
    return replace(whole, plain=plain) if _all_read(whole) else plain


def _is_felt(part: OwnFunction) -> bool:
    space, used = part.function.__globals__, used_in(part.function.__code__)
    return felt(part.tree) or any(drawing(space.get(name)) for name in used)


def _all_read(program: OwnProgram) -> bool:
    """Whether all of the program's own that makes objects is read: else what is the user's runs."""
    read = {part.function for part in program.parts}
    held = (*program.bound, *(program.space[name] for name in program.data))
    own = {one for value in held for one in owners_in(value, program.modules)}
    for owner in own:
        for base in owner.__mro__:
            if written(base, program.modules) and base not in own:
                return False
        fields = getattr(owner, "__dataclass_fields__", {}).values()
        if any(isinstance(one.default_factory, FunctionType) for one in fields):
            return False
        for name in MAKING:
            kept = vars(owner).get(name)
            method = getattr(kept, "__func__", kept)
            written_ = isinstance(method, FunctionType) and not generated(method)
            if written_ and method not in read:
                return False
    return True


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
    folder = Path(function.__code__.co_filename).parent
    values = function.__globals__.values() if folder.is_absolute() else ()
    for value in values:
        module = value if isinstance(value, ModuleType) else sys.modules.get(_home(value) or "")
        file = getattr(module, "__file__", None) or ""
        if module is not None and Path(file).parent == folder and "." not in module.__name__:
            own.add(module.__name__)
    return frozenset(own)


def _home(value: Any) -> str | None:
    known = isinstance(value, FunctionType | type | CACHE)
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
        first = name if name.isidentifier() else "function"
        owner, kept = _owner(self.function, bound)
        self.waiting.append((owner, first, self.function, kept))
        sets: frozenset[str] = frozenset()
        for label, value in self.asked.given.items():
            if self.space.setdefault(label, value) is not value or not self._value(label, value):
                return None
        if self.lines is not None:
            sets = setting(self.lines)
            code = compile(ast.Module(self.lines.body, []), "<lines>", "exec")
            if not self._names_of(self.function, [*used_in(code)]):
                return None
        while self.waiting:
            owner, name, one, kept = self.waiting.pop(0)
            if one in self.parts:
                self._wait(owner, name, one, kept)
                continue
            tree = tree_of(one)
            if tree is None or not is_plain(tree, one) or remembers(tree, one, self.asked.begun):
                if self._may_stay(name, owner):
                    continue
                return None
            if len(self.parts) == _MOST:
                return None
            if self._may_stay(name, owner) and not self._harmless_all(one):
                continue
            tree = with_defaults_inside(_with_given(tree, one), one)
            self.parts[one] = OwnFunction(name, tree, one, owner, [(owner, name)], kept)
            given = [line for line in tree.body if isinstance(line, ByDefault)]
            used = {*names(ast.Module([*given], []), ast.Load)} & one.__globals__.keys()
            if not self._names_of(one, [*used_in(one.__code__), *sorted(used)]):
                return None
        parts = [*self.parts.values()]
        if self.lines is not None:
            parts.append(OwnFunction(_LOADED, self.lines, self.function, sets=sets))
        data = [label for label in self.data if label not in sets or _is_class(self.space[label])]
        begun = self.asked.begun
        data = [x for x in data if x not in begun and not _is_record(self.space[x])]
        held = {*self.used, *self.asked.given} & {
            label for label, value in self.space.items() if isinstance(value, list | dict | set)
        }
        held |= {*self.data, *sets}
        space = {
            label: value if label in held else _out_of_reach(value)
            for label, value in self.space.items()
        }
        copied = frozenset(held)
        known = (tuple(parts), bound, space, tuple(data), copied, self.modules, self.through)
        return OwnProgram(*known, begun=begun)

    @staticmethod
    def _may_stay(name: str, owner: type | None) -> bool:
        """Whether a method need not be read: it is the user's own wherever objects are made."""
        return owner is not None and implied(name) and name != "__call__"

    def _harmless_all(self, one: FunctionType) -> bool:
        values = (one.__globals__.get(label) for label in used_in(one.__code__))
        return all(harmless(value, self.modules) for value in values)

    def _names_of(self, one: FunctionType, used: list[str]) -> bool:
        for label, value in closed(one).items():
            if self.space.get(label, value) is not value:
                return False  # one name for two things
            self.space[label] = value
        for label in used:
            value = closed(one).get(label, one.__globals__.get(label))
            if label in one.__globals__ and self.space.setdefault(label, value) is not value:
                return False
            if not self._value(label, plain_function(value)):
                return False
        self.owners |= {part.owner: None for part in self.parts.values() if part.owner}
        self.used |= {*used}
        for owner in self.owners:
            for name, held in vars(owner).items():
                method, kept = _unwrapped(held)
                if method is None or generated(method):
                    continue
                if name in self.used or _implied(name, method):
                    self._wait(owner, name, method, kept)
        return True

    def _value(self, label: str, value: Any) -> bool:
        """Takes what a name stands for; False where it may not be given to edited lines."""
        if not harmless(value, self.modules):
            return False
        if isinstance(value, FunctionType):
            self._wait(None, label, value)
        elif _numeric(value) and label not in self.data:
            self.data.append(label)
        found = dict.fromkeys(owners_in(value, self.modules))
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


def _owner(function: FunctionType, bound: tuple[Any, ...]) -> tuple[type | None, type]:
    """The class that a function is a method of, if it is one's, and what it is wrapped in there."""
    first = bound[0] if bound else None
    owner = first if isinstance(first, type) else type(first)
    for held in (x for one in owner.__mro__ for x in vars(one).values()):
        method, kept = _unwrapped(held)
        if method is function:
            return owner, kept
    return None, FunctionType


def _is_record(value: Any) -> bool:
    """A tuple whose entries have names: it is made otherwise than a tuple."""
    return isinstance(value, tuple) and type(value) is not tuple


def _is_class(value: Any) -> bool:
    return isinstance(value, type)


def _with_given(tree: ast.FunctionDef, function: FunctionType) -> ast.FunctionDef:
    """A definition with what a partial gives it by name, where that has a name in the module."""
    values, asked = function.__defaults__ or (), [*tree.args.posonlyargs, *tree.args.args]
    if len(values) <= len(tree.args.defaults) or len(values) > len(asked):
        return tree
    known = {id(value): name for name, value in function.__globals__.items()}
    if any(not isinstance(x, int | float) and id(x) not in known for x in values):
        return tree
    own = copy.copy(tree)
    own.args = copy.copy(tree.args)
    own.args.defaults = [
        ast.copy_location(ast.Constant(x), tree)
        if isinstance(x, int | float)
        else ast.copy_location(ast.Name(known[id(x)], ast.Load()), tree)
        for x in values
    ]
    return own


def _unwrapped(held: Any) -> tuple[FunctionType | None, type]:
    """What a class keeps as a function, and what that is wrapped in."""
    kept, inner = type(held), held
    if isinstance(held, property):
        inner = held.fget if held.fset is None else None
    elif isinstance(held, staticmethod | classmethod):
        inner = held.__func__
    elif isinstance(held, CACHE):
        kept, inner = FunctionType, held.__wrapped__
    return (inner, kept) if isinstance(inner, FunctionType) else (None, kept)


def _implied(name: str, method: FunctionType) -> bool:
    """Whether a method is called without its name: to make an object, to multiply two."""
    return name == "__call__" or (implied(name) and "__class__" not in method.__code__.co_freevars)


def generated(method: FunctionType) -> bool:
    """Whether a dataclass has written a method itself."""
    return _GENERATED in method.__code__.co_qualname


def implied(name: str) -> bool:
    """Whether a method of that name is called without it: ``__init__``."""
    return name[:2] == name[-2:] == "__"


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


def _out_of_reach(value: Any) -> Any:
    """Data of the module that the program does not use: an edit that names them changes nothing."""
    if isinstance(value, np.ndarray) and _numeric(value):
        return value.copy()
    if isinstance(value, np.ndarray):
        view = value.view()
        view.flags.writeable = False
        return view
    held = isinstance(value, list | tuple | dict) and of_numbers(value)
    return copy.deepcopy(value) if held else value


def of_numbers(value: Any) -> bool:
    """Whether there is nothing but numbers in it."""
    if isinstance(value, dict):
        value = [*value.values()]
    if isinstance(value, list | tuple):
        return all(of_numbers(one) for one in value)
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
