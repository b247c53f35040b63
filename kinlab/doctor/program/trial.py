"""A program run with edits in it."""

from __future__ import annotations

import ast
import copy
import functools
import inspect
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import CodeType, FrameType, FunctionType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import names, nodes
from kinlab.doctor.program.kept import Contents
from kinlab.doctor.program.own.calls import CALLS, PRODUCTS, REAL_CALLS, bounded_range
from kinlab.doctor.program.own.definitions import (
    DEFAULT,
    FIELDS,
    META,
    ClassBody,
    bounded,
    class_like,
    names_by_class,
    with_defaults,
    with_products,
)
from kinlab.doctor.program.own.plain import (
    alike,
    attributes,
    closed,
    functions_in,
    made_like,
    written,
)
from kinlab.doctor.program.read import MAKING, OwnProgram, implied


class NoProgramError(Exception):
    """What an edit makes of a program is none."""


class FailedError(Exception):
    """A program ended with an error of its own."""


_DEEPEST = 2
"""Lists in lists of which it is told whether they are the same."""
_REMEMBERED = 20_000
"""Answers of one part that are kept."""
TURNS = 2_000
"""Turns that all ``while`` loops of one call may take."""
_LINES = 20_000
"""Lines that may run before the function is asked, if they are to be run again for each edit."""


@dataclass(eq=False)  # never changed; frozen ones take five times as long to make
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
        elif isinstance(self.holder, type):
            setattr(self.holder, self.field, value)
        else:  # a frozen object, too: it is a copy of the user's
            object.__setattr__(self.holder, self.field, value)


class Trial:
    """A program that can be run with changes in it; nothing of the user's own is touched.

    Args:
        program: what was read.
    """

    def __init__(self, program: OwnProgram) -> None:
        while program.plain is not None:
            try:
                self._prepare(program)
                same = self._loads_the_same()
            except Exception:  # noqa: BLE001  what does not run alone is left as it is
                same = False
            if same:
                self._keep()  # the lines of the module have made what they set anew
                return
            program = program.plain
        self._prepare(program)

    def _prepare(self, program: OwnProgram) -> None:
        self.program = program
        self.space = dict(program.space)
        self.sets = [name for part in program.parts for name in sorted(part.sets)]
        held = [*program.data, *sorted(program.held.difference(program.data))]
        owners = dict.fromkeys(part.owner for part in program.parts if part.owner is not None)
        owners |= dict.fromkeys(map(_class_of, (program.space[name] for name in held)))
        self._copies: dict[int, Any] = {}
        self._at = {id(part.function): k for k, part in enumerate(program.parts) if not part.sets}
        self.classes = {
            one: class_like(one)
            for one in owners
            if written(one, program.modules) and not issubclass(one, tuple)
        }
        for name in held:
            self.space[name] = self._own(program.space[name])
        begun = (self.space[name] for name in held if name in program.begun)
        self._filled = [one for one in begun if isinstance(one, list | dict)]
        self.bound = tuple(self._own(one) for one in program.bound)
        self._keep()
        calls = CALLS if _catches(program) else CALLS | REAL_CALLS
        for name, value in self.space.items():
            self.space[name] = calls.get(id(value), value)
        self.trees = [
            bounded(part.tree, None if part.sets else part.function) for part in program.parts
        ]
        self.space |= {"_turn": self._turn, "_edit": 0, "range": bounded_range, DEFAULT: DEFAULT}
        self.space |= PRODUCTS
        self.space["KeyboardInterrupt"] = SystemExit  # the program's own is no hand at the keyboard
        self._turns, self.longest, self.most_turns = 0, 0, TURNS
        self._loads = [k for k, part in enumerate(program.parts) if part.sets]
        self._bodies = names_by_class(self.trees[k] for k in self._loads)
        for label in self._bodies:
            self.space[META + label] = ClassBody(self.space[label])
        self._fields = [one for one in self.classes.values() if FIELDS in vars(one)]
        self._stale = False
        self.above = _callers(program)
        self._touched: set[int] = set()
        self._made = [self._compiled(k) for k in range(len(self.trees))]
        self._placed: list[Any] = [*self._made]
        self._remembering = [_remembering(one) for one in self._made]
        for k, one in enumerate(self._made):
            self.place(k, one)

    def _keep(self) -> None:
        """Keeps hold of the data that edited runs may write into."""
        names = [*self.program.data, *sorted(self.program.held), *self.sets]
        names += [name for name, x in self.space.items() if isinstance(x, np.ndarray)]  # idle ones
        held = [self.space[name] for name in dict.fromkeys(names) if name in self.space]
        owned = [value for one in self.classes.values() for value in vars(one).values()]
        self._contents = Contents([*held, *self.bound, *owned])

    def _loads_the_same(self) -> bool:
        """Whether what runs before the function is asked, run again, gives what is there."""
        with quietly(), _at_most(_LINES):
            self.load()
            entry = self._entry()
        held = closed(entry) if isinstance(entry, FunctionType) else {}
        was, making = self.program.space, self.program.making
        later = self._set_later()
        same = all(alike(self.space.get(x), was[x], without=later) for x in self.sets)
        before = {} if making is None else making.closed
        return same and all(name in held and alike(held[name], x) for name, x in before.items())

    def _set_later(self) -> set[str]:
        """The attributes that objects are given when the function is asked, and not when made."""
        asked = zip(self.program.parts, self.trees, strict=True)
        inner = (x for part, tree in asked if part.name not in MAKING and not part.sets
                 for x in nodes(tree))  # fmt: skip
        return {
            x.attr for x in inner if isinstance(x, ast.Attribute) and isinstance(x.ctx, ast.Store)
        }

    def _entry(self) -> Any:
        """The function that is asked: the first part, or what that makes."""
        making = self.program.making
        if making is None:
            return self.placed(0)
        found = self.placed(0)(*(self.space[name] for name in making.given))
        return next(one for one in functions_in([found]) if one.__name__ == making.name)

    def _own(self, value: Any) -> Any:
        """A copy of data; of a class, and of an object of it, one whose methods can be changed."""
        if isinstance(value, type):
            return self.classes.get(value, value)
        if id(value) in self._copies:
            return self._copies[id(value)]
        if id(value) in self._at:
            return self._asking(self._at[id(value)])
        if isinstance(value, functools.partial):
            given = {k: self._own(v) for k, v in value.keywords.items()}
            return functools.partial(self._own(value.func), *map(self._own, value.args), **given)
        if type(value) in (list, tuple, dict) and not _numbers_only(value):
            return self._own_list(value)
        if type(value) not in self.classes:
            try:
                self._copies[id(value)] = copy.deepcopy(value)
            except TypeError:  # a module, an iterator: nothing that a program writes into
                return value
            return self._copies[id(value)]
        new: Any = object.__new__(self.classes[type(value)])
        self._copies[id(value)] = new
        for name, held in attributes(value).items():
            object.__setattr__(new, name, self._own(held))
        return new

    def _asking(self, k: int) -> Any:
        """A part as it is placed when it is called: in a list of functions."""
        return lambda *given, **named: self._placed[k](*given, **named)

    def _own_list(self, value: Any) -> Any:
        """A list, tuple or dictionary in which objects may be kept."""
        if isinstance(value, tuple):
            parts = [self._own(one) for one in value]
            return made_like(value, parts)
        new: Any = {} if isinstance(value, dict) else []
        self._copies[id(value)] = new
        if isinstance(value, dict):
            new.update({key: self._own(one) for key, one in value.items()})
        else:
            new += [self._own(one) for one in value]
        return new

    def made(self, tree: ast.FunctionDef, k: int) -> FunctionType:
        """A function of a definition, with the defaults that the user's own part has.

        Raises:
            NoProgramError: it cannot be compiled.
        """
        part, space = self.program.parts[k], self.space
        module = ast.Module(tree.body if part.sets else [tree], [])
        try:
            with with_products(module):
                code = compile(module, "<formula>", "exec")
        except (SyntaxError, ValueError, TypeError, RecursionError) as problem:
            raise NoProgramError(str(problem)) from problem
        if part.sets:
            return FunctionType(code, space)
        defaults, keywords = part.function.__defaults__, part.function.__kwdefaults__
        defaults = None if defaults is None else tuple(map(self._own, defaults))
        keywords = keywords and {name: self._own(x) for name, x in keywords.items()}
        if not tree.args.defaults and not any(tree.args.kw_defaults):
            own = next(one for one in code.co_consts if isinstance(one, CodeType))
            function = FunctionType(own, space, part.name, defaults)
            function.__kwdefaults__ = keywords
            return function
        defined: dict[str, Any] = {}
        try:
            exec(code, space, defined)  # noqa: S102  a definition with numbers for its defaults
        except Exception as problem:
            raise NoProgramError(str(problem)) from problem
        function = defined[tree.name]
        assert isinstance(function, FunctionType)
        function.__defaults__ = _filled(function.__defaults__, defaults)
        named, old = function.__kwdefaults__ or {}, keywords or {}
        function.__kwdefaults__ = {
            name: _or(named.get(name, ...), x) for name, x in old.items()
        } or None
        return function

    def _compiled(self, k: int) -> FunctionType:
        """One part as its tree stands now."""
        return self.made(self.trees[k], k)

    def placed(self, k: int) -> Any:
        """The function that stands for a part now."""
        return self._placed[k]

    def place(self, k: int, function: Any) -> None:
        """Puts a function where the program looks for a part."""
        part = self.program.parts[k]
        self._placed[k] = function
        for owner, name in part.spots:
            if owner is None:
                self.space[name] = function
            else:
                held = function if part.kept is FunctionType else part.kept(function)
                setattr(self.classes[owner], name, held)

    def load(self) -> None:
        """Runs the lines of the module.

        Raises:
            FailedError: they end with an error.
        """
        self._stale, self._turns = False, 0
        for name in self.sets:
            if name not in self._bodies:
                self.space.pop(name, None)
        for one in self._fields:
            with_defaults(one)
        with _its_own_errors():
            for k in self._loads:
                self._placed[k]()

    def stale(self) -> None:
        """Sees to it that the lines of the module run again before the function is asked."""
        self._stale = bool(self._loads)

    @contextmanager
    def as_loaded(self) -> Iterator[None]:
        """Puts back afterwards what the lines of the module set."""
        before = [(name, self.space[name]) for name in self.sets if name in self.space]
        owned = [(self.space[label], vars(self.space[label]).copy()) for label in self._bodies]
        inits = [(one, vars(one)["__init__"]) for one in self._fields]
        stale = self._stale
        try:
            yield
        finally:
            self.space.update(before)
            for owner, held in owned:
                for name in self._bodies[owner.__name__] & held.keys():
                    setattr(owner, name, held[name])
            for one, init in inits:
                setattr(one, "__init__", init)  # noqa: B010
            self._stale = stale

    @contextmanager
    def as_held(self) -> Iterator[None]:
        """Puts back afterwards what edited runs have written into the data."""
        held = self._contents.now()
        try:
            yield
        finally:
            if self._contents.put_back(held):  # answers may rest on what was written
                for one in self._remembering:
                    getattr(one, "known", {}).clear()

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
        moved: list[tuple[FieldChange, Any]] = []
        every = range(len(self.trees))
        outer, before, kept = self._touched, [*self._made], [self.placed(k) for k in every]
        edit = self.space["_edit"]
        reached = {k for part in parts for k in self.above[part]}
        self._touched = outer | reached
        with self.as_loaded(), self.as_held():
            try:
                again = not reached.isdisjoint(self._loads) or (-1 in parts and bool(self._fields))
                self._stale = self._stale or again
                for change in changes:
                    if compiled is None:
                        _located(change.new)
                    change.put(change.new)
                moved = [*_in_new_blocks(old)]
                for change, _value in moved:
                    change.put(change.new)
                for k in every:
                    if k in parts and compiled is not None:
                        self.space["_edit"], self._made[k] = compiled
                    elif k in parts:
                        self._made[k] = self._compiled(k)
                    # answers are kept of what no change reaches, this one's or one that stands
                    self.place(k, self._made[k] if k in self._touched else self._remembering[k])
                yield
            finally:
                for change, value in reversed([*old, *moved]):
                    change.put(value)
                self._touched, self._made = outer, before
                self.space["_edit"] = edit
                for k in every:
                    self.place(k, kept[k])

    def function(self, *state: Any) -> Any:
        """The program at one state.

        Raises:
            FailedError: it ends with an error, or ends itself.
        """
        self.longest = max(self.longest, self._turns)
        with self._ready():
            return self._entry()(*self.bound, *state)

    def part(self, k: int, given: Sequence[Any], named: Mapping[str, Any]) -> Any:
        """What one part of the program answers, asked alone.

        Raises:
            FailedError: it ends with an error, or ends itself.
        """
        with self._ready():
            return self._placed[k](*given, **named)

    @contextmanager
    def _ready(self) -> Iterator[None]:
        """Sees to what was asked before, and to how the program ends; no frame stands below it."""
        self._turns = 0
        with _its_own_errors():
            try:
                if self._stale:
                    self.load()
                for filled in self._filled:
                    filled.clear()
                yield
            except SystemExit as end:  # an edit led to where the program ends itself
                self._stale = self._stale or bool(self._loads)
                raise FailedError from end

    def _turn(self) -> bool:
        self._turns += 1
        if self._turns > self.most_turns:
            raise RuntimeError("a loop without end")
        return True


def _numbers_only(value: Any) -> bool:
    """Whether a list holds numbers alone."""
    inner = value.values() if isinstance(value, dict) else value
    return all(isinstance(one, int | float) for one in inner)


def is_data(value: Any) -> bool:
    """Whether numbers are kept in it by keys or indices, and others can be put there."""
    read_only = isinstance(value, np.ndarray) and not value.flags.writeable
    return isinstance(value, list | dict | np.ndarray) and not read_only


@contextmanager
def _at_most(lines: int) -> Iterator[None]:
    """Ends what runs too many lines."""
    left = [lines]

    def count(_frame: FrameType, event: str, _argument: Any) -> Any:
        left[0] -= event == "line"
        if left[0] < 0:
            raise RuntimeError("too long")
        return count

    before = sys.gettrace()
    sys.settrace(count)
    try:
        yield
    finally:
        sys.settrace(before)


@contextmanager
def _its_own_errors() -> Iterator[None]:
    """What a program raises, which may be anything, as one error."""
    try:
        yield
    except FailedError:
        raise
    except Exception as problem:
        raise FailedError(f"{type(problem).__name__}: {problem}") from problem


@contextmanager
def quietly() -> Iterator[None]:
    """What edited programs warn of is nobody's concern."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        yield


def _filled(new: tuple[Any, ...] | None, own: tuple[Any, ...] | None) -> tuple[Any, ...] | None:
    return tuple(map(_or, new, own)) if new and own else own


def _or(new: Any, own: Any) -> Any:
    return own if new is ... else new


def _catches(program: OwnProgram) -> bool:
    """Whether a program answers errors itself."""
    return any(isinstance(node, ast.Try) for part in program.parts for node in nodes(part.tree))


def _callers(program: OwnProgram) -> dict[int, set[int]]:
    """For each part those whose answers depend on it, itself among them; -1 for the data.

    What is called without its name (``__init__``) may be called by all.
    """
    every = range(len(program.parts))
    named = [named_in(part.tree) for part in program.parts]
    named = [one.union(*(program.through.get(label, ()) for label in one)) for one in named]
    gives = [part.sets or {name for _owner, name in part.spots} for part in program.parts]
    own = [part.owner is not None and implied(part.name) for part in program.parts]
    calls = [{k for k in every if own[k] or not gives[k].isdisjoint(inside)} for inside in named]
    above = {k: {k} for k in every}
    for _round in every:
        for k in every:
            above[k] |= {j for j in every if calls[j] & above[k]}
    data = {k for k in every if named[k] & {*program.data} or program.parts[k].sets}
    owned = {k for k in every if program.parts[k].owner is not None}
    return {**above, -1: {j for k in data | owned for j in above[k] | {k}}}


def named_in(tree: ast.AST) -> set[str]:
    """The names in a tree, and those of the attributes in it."""
    attributes = {node.attr for node in nodes(tree) if isinstance(node, ast.Attribute)}
    return attributes | {*names(tree)}


def _class_of(value: Any) -> type:
    return value if isinstance(value, type) else type(value)


def _remembering(function: FunctionType) -> Any:
    """A part that no edit reaches: its answers are kept, by what it was asked.

    What fills its arguments, itself or by what it calls, is run each time: ``C[4*i + j] = acc``.
    """
    known: dict[Any, Any] = {}
    fills = False
    if function.__code__.co_flags & inspect.CO_GENERATOR or function.__code__.co_name == "<module>":
        return function  # what it gives is used up; what it does is done each time

    def remembered(*asked: Any, **named: Any) -> Any:
        nonlocal fills
        key = None if fills else _keys(asked, named)
        if key is None:
            return function(*asked, **named)
        if key not in known:
            if len(known) >= _REMEMBERED:
                known.clear()
            answer = function(*asked, **named)
            fills = fills or _keys(asked, named) != key
            if fills or isinstance(answer, Iterator):
                return answer
            known[key] = answer
        return _again(known[key])

    remembered.known = known  # type: ignore[attr-defined]
    remembered.__wrapped__ = function  # type: ignore[attr-defined]  # what it is asked is called so
    return remembered


def _again(value: Any) -> Any:
    """A copy of an answer."""
    if isinstance(value, np.ndarray) and value.dtype.kind != "O":
        return value.copy()
    if type(value) in (float, np.float64, int):
        return value
    if type(value) in (tuple, list):
        return made_like(value, map(_again, value))
    return copy.deepcopy(value)


def _keys(asked: Sequence[Any], named: Mapping[str, Any]) -> tuple[Any, ...] | None:
    """What a part was asked; None where nothing is kept of it."""
    try:
        key = (*map(_key, asked), *((name, _key(one)) for name, one in named.items()))
        hash(key)
    except TypeError:
        return None
    return key


def _key(value: Any, deep: int = 0) -> Any:
    """What a part was asked, for keeping its answer; of functions and objects nothing is kept.

    Nor of lists of matrices that are lists: to tell these apart takes longer than most answers.
    """
    if isinstance(value, np.ndarray) and value.dtype.kind != "O":
        return (value.shape, value.dtype.str, value.tobytes())
    if isinstance(value, list | tuple):
        if deep == _DEEPEST:
            raise TypeError("a list of matrices")
        return (type(value).__name__, *(_key(one, deep + 1) for one in value))
    if value is None or isinstance(value, str | int | float | complex | np.number):
        return (type(value).__name__, value)
    raise TypeError(type(value).__name__)


def _in_new_blocks(
    changes: Sequence[tuple[FieldChange, Any]],
) -> Iterator[tuple[FieldChange, Any]]:
    """Changes of single statements in blocks that others replace, there; and what stands there."""
    blocks = {id(old): one.new for one, old in changes if isinstance(old, list)}
    for change, old in changes:
        block = blocks.get(id(change.holder))
        for k, statement in enumerate(block if isinstance(block, list) else ()):
            if statement is old and isinstance(old, ast.stmt):
                yield FieldChange(block, k, change.new), old


def _located(new: Any) -> None:
    """Gives new nodes a line, which compiling asks for."""
    for one in new if isinstance(new, list) else [new]:
        if isinstance(one, ast.AST):
            for node in nodes(one):
                if "lineno" in node._attributes and not hasattr(node, "lineno"):
                    node.lineno = node.end_lineno = 1  # type: ignore[attr-defined]
                    node.col_offset = node.end_col_offset = 0  # type: ignore[attr-defined]
