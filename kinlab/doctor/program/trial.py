"""A program run with edits in it."""

from __future__ import annotations

import ast
import copy
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import copied, names, nodes
from kinlab.doctor.program.kept import Contents
from kinlab.doctor.program.read import OwnFunction, OwnProgram, written


class NoProgramError(Exception):
    """What an edit makes of a program is none."""


_REMEMBERED = 20_000
"""Answers of one part that are kept."""
_TURNS = 2_000
"""Turns that all ``while`` loops of one call may take."""


@dataclass(frozen=True, eq=False)
class FieldChange:
    """Another value in one field of a syntax tree, or in one place of the data.

    Attributes:
        holder: the node, object, list, dictionary or array.
        field: the name of the field or attribute, or the key or index.
        new: what it gets.
    """

    holder: Any
    field: Any
    new: Any

    @property
    def now(self) -> Any:
        """What is there."""
        if is_data(self.holder):
            return self.holder[self.field]
        return getattr(self.holder, self.field)

    def put(self, value: Any) -> None:
        """Puts something there."""
        if is_data(self.holder):
            self.holder[self.field] = value
        else:
            setattr(self.holder, self.field, value)


class Trial:
    """A program that can be run with changes in it; nothing of the user's own is touched.

    Args:
        program: what was read.
    """

    def __init__(self, program: OwnProgram) -> None:
        self.program = program
        self.space = dict(program.space)
        owners = dict.fromkeys(part.owner for part in program.parts if part.owner is not None)
        owners |= dict.fromkeys(map(_class_of, (program.space[name] for name in program.data)))
        self._copies: dict[int, Any] = {}
        module = program.parts[0].function.__module__
        self.classes = {one: _copied(one) for one in owners if written(one, module)}
        for name in program.data:
            self.space[name] = self._own(program.space[name])
        self.bound = tuple(self._own(one) for one in program.bound)
        owned = [value for one in self.classes.values() for value in vars(one).values()]
        held = [self.space[name] for name in program.data]
        self._contents = Contents([*held, *self.bound, *owned])
        for name, value in self.space.items():
            if value is np or value is np.cross:
                self.space[name] = _QUICK if value is np else _cross
        self.trees = [_bounded(part.tree) for part in program.parts]
        self.space |= {"_turn": self._turn, "_edit": 0}
        self._turns = 0
        self.above = _callers(program)
        self._touched: set[int] = set()
        self._made = [self._compiled(k) for k in range(len(self.trees))]
        self._remembering = [_remembering(one) for one in self._made]
        for k, one in enumerate(self._made):
            self.place(k, one)

    def _own(self, value: Any) -> Any:
        """A copy of data; of a class, and of an object of it, one whose methods can be changed."""
        if isinstance(value, type):
            return self.classes.get(value, value)
        if id(value) in self._copies:
            return self._copies[id(value)]
        if type(value) in (list, tuple, dict) and not _numbers_only(value):
            return self._own_list(value)
        if type(value) not in self.classes:
            return copy.deepcopy(value)
        new: Any = object.__new__(self.classes[type(value)])
        self._copies[id(value)] = new
        new.__dict__.update({k: self._own(v) for k, v in getattr(value, "__dict__", {}).items()})
        return new

    def _own_list(self, value: Any) -> Any:
        """A list, tuple or dictionary in which objects may be kept."""
        if isinstance(value, tuple):
            parts = [self._own(one) for one in value]
            return type(value)(parts)
        new: Any = {} if isinstance(value, dict) else []
        self._copies[id(value)] = new
        if isinstance(value, dict):
            new.update({key: self._own(one) for key, one in value.items()})
        else:
            new += [self._own(one) for one in value]
        return new

    def _compiled(self, k: int) -> FunctionType:
        """One part as its tree stands now."""
        return made(self.trees[k], self.program.parts[k], self.space)

    def placed(self, k: int) -> Any:
        """The function that stands for a part now."""
        part = self.program.parts[k]
        if part.owner is None:
            return self.space[part.name]
        return vars(self.classes[part.owner])[part.name]

    def place(self, k: int, function: Any) -> None:
        """Puts a function where the program looks for a part."""
        part = self.program.parts[k]
        if part.owner is None:
            self.space[part.name] = function
        else:
            setattr(self.classes[part.owner], part.name, function)

    @contextmanager
    def changed(
        self,
        parts: set[int],
        changes: Sequence[FieldChange],
        compiled: tuple[int, FunctionType] | None = None,
    ) -> Iterator[None]:
        """The program with changes in it, beside those that stand already.

        Args:
            parts: where the changes are; -1 stands for the data.
            changes: what is put where.
            compiled: the number of the changes in a function that has them, where it is made.
        """
        old = [(change, change.now) for change in changes]
        every = range(len(self.trees))
        outer, before, kept = self._touched, [*self._made], [self.placed(k) for k in every]
        held = self._contents.now()
        self._touched = outer | {k for part in parts for k in self.above[part]}
        try:
            for change in changes:
                if compiled is None:
                    _located(change.new)
                change.put(change.new)
            for k in every:
                if k in parts and compiled is not None:
                    self.space["_edit"], self._made[k] = compiled
                elif k in parts:
                    self._made[k] = self._compiled(k)
                # only of what no change reaches, this one's or one that stands, answers are kept
                self.place(k, self._made[k] if k in self._touched else self._remembering[k])
            yield
        finally:
            for change, value in reversed(old):
                change.put(value)
            if self._contents.put_back(held):  # answers may rest on what was written
                self._forget()
            self._touched, self._made = outer, before
            self.space["_edit"] = 0
            for k in every:
                self.place(k, kept[k])

    def _forget(self) -> None:
        for one in self._remembering:
            one.known.clear()

    def function(self, *state: Any) -> Any:
        """The program at one state."""
        self._turns = 0
        try:
            return self.placed(0)(*self.bound, *state)
        except SystemExit as end:  # an edit led to where the user's program ends itself
            raise RuntimeError("the program ended itself") from end

    def _turn(self) -> bool:
        self._turns += 1
        if self._turns > _TURNS:
            raise RuntimeError("a loop without end")
        return True


def _numbers_only(value: Any) -> bool:
    """Whether a list holds numbers alone."""
    inner = value.values() if isinstance(value, dict) else value
    return all(isinstance(one, int | float) for one in inner)


def is_data(value: Any) -> bool:
    """Whether numbers are kept in it by keys or indices."""
    return isinstance(value, list | dict | np.ndarray)


@contextmanager
def quietly() -> Iterator[None]:
    """What edited programs warn of is nobody's concern."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        yield


def _cross(one: Any, other: Any, *rest: Any, **options: Any) -> Any:
    """numpy's cross product; of two vectors of three numbers ten times as fast."""
    if not rest and not options:
        a, b = np.asarray(one), np.asarray(other)
        if a.shape == b.shape == (3,):
            (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
            return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
    return np.cross(one, other, *rest, **options)


_QUICK = ModuleType("numpy")
_QUICK.__dict__.update(np.__dict__, cross=_cross)


def made(tree: ast.FunctionDef, part: OwnFunction, space: dict[str, Any]) -> FunctionType:
    """A function of a definition, with the defaults that the user's own has."""
    module = ast.Module([tree], [])
    try:
        code = compile(module, "<formula>", "exec")
    except (SyntaxError, ValueError, TypeError) as problem:
        raise NoProgramError(str(problem)) from problem
    own = next(one for one in code.co_consts if isinstance(one, CodeType))
    function = FunctionType(own, space, part.name, part.function.__defaults__)
    function.__kwdefaults__ = part.function.__kwdefaults__
    return function


def _callers(program: OwnProgram) -> dict[int, set[int]]:
    """For each part those whose answers depend on it, itself among them; -1 for the data."""
    every = range(len(program.parts))
    named = [named_in(part.tree) for part in program.parts]
    calls = [{k for k in every if program.parts[k].name in inside} for inside in named]
    above = {k: {k} for k in every}
    for _round in every:
        for k in every:
            above[k] |= {j for j in every if calls[j] & above[k]}
    data = {k for k in every if named[k] & {*program.data}}
    owned = {k for k in every if program.parts[k].owner is not None}
    return {**above, -1: {j for k in data | owned for j in above[k] | {k}}}


def named_in(tree: ast.AST) -> set[str]:
    """The names in a tree, and those of the attributes in it."""
    attributes = {node.attr for node in nodes(tree) if isinstance(node, ast.Attribute)}
    return attributes | {*names(tree)}


def _class_of(value: Any) -> type:
    return value if isinstance(value, type) else type(value)


def _copied(owner: type) -> type:
    """A class like another, whose methods can be changed."""
    own = {
        name: copy.deepcopy(value) if is_data(value) else value
        for name, value in vars(owner).items()
        if name not in ("__dict__", "__weakref__")
    }
    return type(owner.__name__, owner.__bases__, own)


def _remembering(function: FunctionType) -> Any:
    """A part that no edit reaches: its answers are kept, by what it was asked."""
    known: dict[Any, Any] = {}

    def remembered(*asked: Any) -> Any:
        try:
            key = tuple(_key(one) for one in asked)
            hash(key)
        except TypeError:
            return function(*asked)
        if key not in known:
            if len(known) >= _REMEMBERED:
                known.clear()
            known[key] = function(*asked)
        return _again(known[key])

    remembered.known = known  # type: ignore[attr-defined]
    return remembered


def _again(value: Any) -> Any:
    """A copy of an answer."""
    if isinstance(value, np.ndarray) and value.dtype.kind != "O":
        return value.copy()
    if type(value) in (float, np.float64, int):
        return value
    if type(value) in (tuple, list):
        return type(value)(map(_again, value))
    return copy.deepcopy(value)


def _key(value: Any) -> Any:
    """What a part was asked, for keeping its answer; of functions and objects nothing is kept."""
    if isinstance(value, np.ndarray) and value.dtype.kind != "O":
        return (value.shape, value.dtype.str, value.tobytes())
    if isinstance(value, list | tuple):
        return (type(value).__name__, *map(_key, value))
    if value is None or isinstance(value, str | int | float | complex | np.number):
        return (type(value).__name__, value)
    raise TypeError(type(value).__name__)


def _bounded(tree: ast.FunctionDef) -> ast.FunctionDef:
    """A copy that prints nothing and whose loops end."""
    own = copied(tree)
    own.returns, own.args.defaults = None, []
    own.args.kw_defaults = [None] * len(own.args.kwonlyargs)
    for name in (*own.args.posonlyargs, *own.args.args, *own.args.kwonlyargs):
        name.annotation = None
    _Quiet().visit(own)
    return ast.fix_missing_locations(own)


class _Quiet(ast.NodeTransformer):
    def visit_Expr(self, node: ast.Expr) -> ast.stmt:
        called = node.value.func if isinstance(node.value, ast.Call) else None
        silent = isinstance(called, ast.Name) and called.id in ("print", "display")
        return ast.copy_location(ast.Pass(), node) if silent else node

    def visit_While(self, node: ast.While) -> ast.While:
        self.generic_visit(node)
        turn = ast.Call(ast.Name("_turn", ast.Load()), [], [])
        node.test = ast.BoolOp(ast.And(), [turn, node.test])
        return node


def _located(new: Any) -> None:
    """Gives new nodes a line, which compiling asks for."""
    for one in new if isinstance(new, list) else [new]:
        if isinstance(one, ast.AST):
            for node in nodes(one):
                if "lineno" in node._attributes and not hasattr(node, "lineno"):
                    node.lineno = node.end_lineno = 1  # type: ignore[attr-defined]
                    node.col_offset = node.end_col_offset = 0  # type: ignore[attr-defined]
