"""What the numbers of a program are called, and at which place of a list they stand."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from typing import Any

from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.program.edits.numbers.data import NumberPlace
from kinlab.doctor.program.grounds.called import kinds_called, stem
from kinlab.doctor.program.places import DATA, paired
from kinlab.doctor.program.trial import Trial

Label = tuple[str, int | None, tuple[int, ...]]
"""The name of a number without its digits, these, and its place in a list, counted from 0."""
_Written = tuple[list[str], list[int]]


class Labels:
    """What the numbers of a program are called, with their places in lists.

    Args:
        trial: the program.
        count: of the arm's links; a list that is one longer and begins with nothing counts from 1.
    """

    def __init__(self, trial: Trial, count: int) -> None:
        self._space, self._count = trial.space, count
        self._own = {part.name for part in trial.program.parts}
        self._text: dict[int, _Written] = {}
        for tree in trial.trees:
            for name, value in _named(tree):
                self._put(value, [name], [])

    def of(self, place: NumberPlace) -> Label:
        """What a number is called."""
        names, at = self._written(place)
        told = names[-1:] if at else names  # a list's own name: the arm's may be UR5
        digits = [x for name in told for x in re.findall(r"\d+", name)]
        return stem(names[-1]), int(digits[-1]) if digits else None, tuple(at)

    def owner(self, place: NumberPlace) -> str:
        """The object or dictionary that a number is in."""
        if place.part == DATA:
            return str(place.node) if any(isinstance(key, str) for key in place.place) else ""
        names, _at = self._written(place)
        return names[0] if len(names) > 1 else ""

    def _written(self, place: NumberPlace) -> _Written:
        if place.part != DATA:
            return self._text.get(id(place.node), ([""], []))
        names, at, value = [str(place.node)], [], self._space.get(place.node)
        for key in place.place:
            if isinstance(key, str):
                names.append(key.lstrip("."))
            elif (fields := getattr(value, "_fields", None)) is not None:
                names.append(fields[key])
            elif type(key) is int:
                at.append(key - self._first(value))
            value = _inside(value, key)
        return names, at

    def _first(self, value: Any) -> int:
        """What the first link's number is counted as, in a list or a dictionary."""
        if isinstance(value, dict):
            return min((key for key in value if type(key) is int), default=0)
        if isinstance(value, list | tuple) and len(value) == self._count + 1:
            return int(not _holds_something(value[0]))
        return 0

    def _put(self, value: Any, names: list[str], at: list[int]) -> None:
        if isinstance(value, ast.Constant):
            self._text[id(value)] = names, at
        elif isinstance(value, ast.UnaryOp):
            self._put(value.operand, names, at)
        elif isinstance(value, ast.BinOp):  # of pi/2
            self._put(value.right, names, at)
        elif isinstance(value, ast.Subscript):  # of ``a = [0, 0.4318][i]``
            self._put(value.value, names, at)
        elif isinstance(value, ast.ListComp):  # the same of all links
            self._put(value.elt, names, at)
        elif isinstance(value, ast.Call):
            called_so = _parameters(self._space.get(called(value)))
            tensor = called(value) in self._own and kinds_called(stem(names[-1])) == ("moment",)
            for k, one in enumerate(value.args if called_so or tensor else value.args[:1]):
                self._put(one, [*names, *called_so[k : k + 1]], at)
            for keyword in value.keywords:
                self._put(keyword.value, names if tensor else [*names, keyword.arg or ""], at)
        elif isinstance(value, ast.List | ast.Tuple):
            padded = len(value.elts) == self._count + 1 and _is_nothing(value.elts[0])
            for k, one in enumerate(value.elts):
                self._put(one, names, [*at, k - padded])
        elif isinstance(value, ast.Dict):
            keys = [getattr(key, "value", "") for key in value.keys]
            first = min((key for key in keys if type(key) is int), default=0)
            for key, one in zip(keys, value.values, strict=True):
                if type(key) is int:
                    self._put(one, names, [*at, key - first])
                else:
                    self._put(one, [*names, str(key)], at)


def _named(tree: ast.AST) -> Iterator[tuple[str, ast.expr]]:
    """What names are set to in a program's text, and arguments are by default."""
    for node in nodes(tree):
        if isinstance(node, ast.arguments):
            given = [*reversed(node.posonlyargs + node.args)]
            for argument, value in zip(given, reversed(node.defaults), strict=False):
                yield argument.arg, value
            for argument, default in zip(node.kwonlyargs, node.kw_defaults, strict=True):
                if default is not None:
                    yield argument.arg, default
        elif isinstance(node, ast.Assign):
            for target in node.targets:
                for one, value in paired(target, node.value):
                    yield getattr(one, "id", getattr(one, "attr", "")), value


def _parameters(of: Any) -> list[str]:
    """What a class of the program calls what it is given."""
    if not isinstance(of, type) or of.__module__ in ("builtins", "numpy"):
        return []
    try:
        return [*inspect.signature(of).parameters]
    except (TypeError, ValueError):
        return []


def _inside(value: Any, key: Any) -> Any:
    """What is at a key of a place."""
    if isinstance(key, str) and key.startswith("."):
        return getattr(value, key[1:], None)
    try:
        return value[key]
    except (TypeError, KeyError, IndexError):
        return None


def _holds_something(value: Any) -> bool:
    return value is not None and not (isinstance(value, int | float) and value == 0)


def _is_nothing(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and not _holds_something(node.value)
