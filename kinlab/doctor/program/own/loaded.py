"""The lines of a module that run when it is loaded: ``I1 = m1*l1**2/12``, ``M = [M1, M2]``.

They can be run again with an edit in them, in a space of their own, if they do nothing but compute:
what draws, prints, reads a file or draws lots is left as it is, and so is what it sets. Numbers
that are written down as they are (``L = [0.5, 0.4]``) are no such lines: they are the data.
"""

from __future__ import annotations

import ast
import builtins
import functools
import inspect
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from types import BuiltinMethodType, FunctionType, MethodType, ModuleType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import called, names, nodes

_GROWING = frozenset(["append", "extend", "insert", "update", "add", "setdefault", "fill"])
"""Methods that write into what they belong to."""
_FELT = frozenset(
    [
        "print",
        "display",
        "random",
        "default_rng",
        "shuffle",
        "seed",
        "seterr",
        "set_printoptions",
        "setbufsize",
        "next",
        "show",
        "load",
        "loadtxt",
        "genfromtxt",
    ]
)
"""Functions whose being called a second time is felt."""
_PI = ("pi", "np.pi", "numpy.pi", "math.pi")
_TABLES = frozenset(
    [
        "dict",
        "list",
        "tuple",
        "float",
        "array",
        "asarray",
        "float64",
        "diag",
        "eye",
        "zeros",
        "ones",
        "radians",
        "deg2rad",
    ]
)
"""What makes a table of numbers that are written down."""


@dataclass(frozen=True, eq=False)
class _Line:
    """One statement: the names that it sets or writes into, and those that it uses."""

    node: ast.stmt
    sets: frozenset[str]
    uses: frozenset[str]
    written_down: bool


@dataclass(frozen=True, eq=False)
class ModuleLines:
    """The statements of a module that compute.

    Attributes:
        lines: in the order of the file.
        others: the names that other statements set.
        space: what names stand for, now that the module is loaded.
    """

    lines: tuple[_Line, ...]
    others: frozenset[str]
    space: dict[str, Any]

    @property
    def begun(self) -> frozenset[str]:
        """Names of lists and dictionaries that only functions fill: what they remember."""
        empty = [one for one in self.lines if _is_empty(getattr(one.node, "value", None))]
        others = [one for one in self.lines if one not in empty]
        filled = self.others.union(*(one.sets for one in others))
        names_ = [name for one in empty for name in one.sets]
        return frozenset(x for x in names_ if x not in filled and names_.count(x) == 1)

    def needed(
        self,
        used: Iterable[str],
        harmless: Callable[[Any], bool],
        plain: Callable[[ast.AST], bool],
    ) -> ast.FunctionDef | None:
        """The lines on which what is used depends, as the body of a function; None without any.

        Args:
            used: names that the program uses.
            harmless: whether a value may be given to edited lines.
            plain: whether a statement asks for nothing but arithmetic.
        """
        alone = {
            name
            for line in self.lines
            if line.written_down
            for name in line.sets
            if sum(name in one.sets for one in self.lines) == 1
        }
        lines = [one for one in self.lines if not (one.written_down and one.sets <= alone)]
        barred, made = {*self.others}, {name for one in lines for name in one.sets}
        while True:
            held = [
                one
                for one in lines
                if barred.isdisjoint(one.sets)
                and plain(one.node)
                and self._runs(one, made, harmless)
            ]
            if len(held) == len(lines):
                break
            barred |= {name for one in lines if one not in held for name in one.sets}
            lines = held
        wanted, kept = {*used}, list[_Line]()
        while True:
            found = [one for one in lines if one not in kept and not wanted.isdisjoint(one.sets)]
            if not found:
                break
            kept += found
            wanted = wanted.union(*(one.uses for one in found))
        kept += [one for one in lines if one not in kept and self._is_idle(one, wanted | alone)]
        if not kept:
            return None
        body = [one.node for one in lines if one in kept]
        tree = ast.FunctionDef("module", _NO_ARGUMENTS, body, [])
        tree.lineno = tree.end_lineno = body[0].lineno
        tree.col_offset = tree.end_col_offset = 0
        return tree

    def _is_idle(self, line: _Line, known: set[str]) -> bool:
        """Whether a line makes numbers of known ones that nothing uses: a slip may have lost them.

        Only what is made of the numbers that the program has.
        """
        if not isinstance(line.node, ast.Assign):
            return False
        used = {name for name in line.uses - line.sets if not callable(self.space.get(name))}
        used = {name for name in used if not isinstance(self.space.get(name), ModuleType)}
        numbers = (self.space.get(name) for name in line.sets)
        others = (one for one in self.lines if one is not line)
        alone = all(line.sets.isdisjoint(one.uses | one.sets) for one in others)
        return alone and bool(used) and used <= known and all(map(_is_number, numbers))

    def _runs(self, line: _Line, made: set[str], harmless: Callable[[Any], bool]) -> bool:
        """Whether nothing but arithmetic happens when it is run again, on copies of the data."""
        if felt(line.node):
            return False
        known = {**vars(builtins), **self.space}
        kinds: tuple[type, ...] = (ModuleType, FunctionType)
        kinds += () if isinstance(line.node, ast.ClassDef) else (type,)
        if any(isinstance(known.get(name), kinds) for name in line.sets):
            return False
        used = {name: known.get(name) for name in line.uses | line.sets}
        if any(isinstance(x, _HELD) for name, x in used.items() if name not in made):
            return False
        return all(harmless(x) and not drawing(x) and _small(x) for x in used.values())


_HELD = (MethodType, functools.partial)
"""What holds objects of the user's own that are not copied."""


def _small(value: Any) -> bool:
    """Whether making a value again for each edit takes little."""
    if isinstance(value, np.ndarray):
        return value.size <= _SMALL
    return not isinstance(value, list | tuple | dict | set) or len(value) <= _SMALL


_SMALL = 2000
"""Entries of a list or an array that lines make."""


def drawing(value: Any) -> bool:
    """Whether asking a value changes it: an iterator, a source of random numbers."""
    source = value.__self__ if isinstance(value, MethodType | BuiltinMethodType) else value
    kinds = (value, source, type(source))
    homes = (getattr(one, "__module__", None) or "" for one in kinds)
    return isinstance(value, Iterator) or any(str(x).startswith("numpy.random") for x in homes)


def _is_number(value: Any) -> bool:
    return isinstance(value, float | np.ndarray)


_NO_ARGUMENTS = ast.arguments([], [], None, [], [], None, [])


def of_module(function: FunctionType) -> ModuleLines | None:
    """The lines of the file that a function stands in; None where it has none."""
    try:
        text, _first = inspect.findsource(function)
        module = ast.parse("".join(text))
    except (OSError, TypeError, SyntaxError, ValueError, IndexError):
        return None
    lines: list[_Line] = []
    others: set[str] = set()
    for node in module.body:
        if isinstance(node, ast.Import | ast.ImportFrom | ast.FunctionDef | ast.Pass):
            continue
        line = _line(node, function.__globals__)
        if line is None:
            others |= _set_by(node)
        else:
            lines.append(line)
    return ModuleLines(tuple(lines), frozenset(others), function.__globals__)


def felt(tree: ast.AST) -> bool:
    """Whether it is felt when something is run a second time: what it draws, prints, reads."""
    words = {node.attr for node in nodes(tree) if isinstance(node, ast.Attribute)}
    return not _FELT.isdisjoint(words.union(names(tree)))


def setting(tree: ast.AST) -> frozenset[str]:
    """The names that lines set; of a class the class."""
    return frozenset(_set_by(tree))


def _line(node: ast.stmt, space: dict[str, Any]) -> _Line | None:
    """A statement as a line; None if it is not one that only computes."""
    if isinstance(node, ast.ClassDef):
        return _of_class(node, space)
    if not _computes(node) or _of_text(node, space):
        return None
    down = isinstance(node, ast.Assign | ast.AnnAssign) and _written_down(node.value, space)
    return _Line(node, frozenset(_set_by(node)), frozenset(names(node)), down)


def _of_text(node: ast.stmt, space: dict[str, Any]) -> bool:
    """Whether numbers are read from a text: what they are is then looked at, and not the text."""
    known = {*names(node)}
    return "float" in known and any(isinstance(space.get(name), str) for name in known)


def _computes(node: ast.stmt) -> bool:
    if isinstance(node, ast.Assign | ast.AugAssign):
        return True
    if isinstance(node, ast.AnnAssign):
        return node.value is not None
    if isinstance(node, ast.Expr):
        call = node.value
        if isinstance(call, ast.Constant):
            return False
        return (
            isinstance(call, ast.Call)
            and isinstance(call.func, ast.Attribute)
            and call.func.attr in _GROWING
            and _root(call.func.value) is not None
        )
    if isinstance(node, ast.For | ast.If):
        return all(_computes(one) for one in (*node.body, *node.orelse))
    return False


def _of_class(node: ast.ClassDef, space: dict[str, Any]) -> _Line | None:
    """The lines of a class that compute what its objects share, alone in its body."""
    own = [one for one in node.body if _computes(one)]
    down = [
        isinstance(one, ast.Assign | ast.AnnAssign) and _written_down(one.value, space)
        for one in own
    ]
    body = [one for one, written in zip(own, down, strict=True) if not written]
    if not body or not isinstance(space.get(node.name), type):
        return None
    alone = ast.ClassDef(node.name, [], [], body, [])
    ast.copy_location(alone, node)
    inside = {name for one in own for name in _set_by(one)}
    used = {name for one in body for name in names(one, ast.Load)} - inside
    return _Line(alone, frozenset([node.name]), frozenset(used), written_down=False)


def _set_by(tree: ast.AST) -> set[str]:
    """The names that are set in a tree, and those of what is written into."""
    if isinstance(tree, ast.ClassDef):
        return {tree.name}
    found: set[str] = set()
    if isinstance(tree, ast.comprehension | ast.Lambda):
        return found
    root: str | None = None
    if isinstance(getattr(tree, "ctx", None), ast.Store | ast.Del):
        root = _root(tree)
    elif isinstance(tree, ast.Call) and isinstance(tree.func, ast.Attribute):
        root = _root(tree.func.value) if tree.func.attr in _GROWING else None
    found |= {root} if root is not None else set()
    return found.union(*map(_set_by, ast.iter_child_nodes(tree)))


def _is_empty(node: ast.AST | None) -> bool:
    """Whether it is a list or a dictionary with nothing in it: ``{}``, ``dict()``."""
    if isinstance(node, ast.Call):
        bare = isinstance(node.func, ast.Name) and node.func.id in ("dict", "list")
        return bare and not node.args and not node.keywords
    if isinstance(node, ast.Dict):
        return not node.keys
    return isinstance(node, ast.List) and not node.elts


def _root(node: ast.AST) -> str | None:
    """The name that an expression begins with."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else None


def _written_down(node: ast.AST | None, space: dict[str, Any]) -> bool:
    """Whether it is made of numbers as they are, and of right angles."""
    if isinstance(node, ast.Constant):
        return True
    if isinstance(node, ast.UnaryOp):
        return _written_down(node.operand, space)
    if isinstance(node, ast.List | ast.Tuple | ast.Set):
        return all(_written_down(one, space) for one in node.elts)
    if isinstance(node, ast.Dict):
        return all(_written_down(one, space) for one in node.values)
    if isinstance(node, ast.Name | ast.Attribute):
        return ast.unparse(node) in _PI or _is_type(ast.unparse(node))
    if isinstance(node, ast.BinOp):
        both = (node.left, node.right)
        pi = any(isinstance(one, ast.Name | ast.Attribute) for one in both)
        return pi and all(_written_down(one, space) for one in both)
    if isinstance(node, ast.Call):
        target, last = node.func, called(node)
        own = isinstance(space.get(last), FunctionType) and not isinstance(target, ast.Attribute)
        root = _root(target)
        library = isinstance(target, ast.Name) or isinstance(space.get(root or ""), ModuleType)
        given = [*node.args, *(word.value for word in node.keywords)]
        known = last in _TABLES and library and not own
        return known and all(_written_down(one, space) for one in given)
    return False


def _is_type(text: str) -> bool:
    return text in ("float", "int", "np.float64")
