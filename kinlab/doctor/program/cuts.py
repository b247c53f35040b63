"""Where a program rounds by itself: ``round``, single precision, whole numbers."""

from __future__ import annotations

import ast
from types import ModuleType
from typing import Any

from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.program.places import ROUNDING, Here, ProgramEdit, places
from kinlab.doctor.program.search.repair import LineSearch

_SHORT = ("float16", "half", "float32", "single", "f2", "f4", "int16", "int32", "int64", "int")
"""Kinds of numbers with fewer digits than a float's."""


def cuts(search: LineSearch) -> tuple[ProgramEdit, ...]:
    """What leaves all rounding out of a program."""
    found: list[ProgramEdit] = []
    done: set[int] = set()
    for part, tree in enumerate(search.trial.trees):
        for here in places(part, tree):
            node, new = here.node, here.node
            if id(node) in done or _index(here):
                continue
            while (inner := _rounded(new, search)) is not None:
                done.add(id(new))
                new = inner
            if new is not node:
                found.append(here.instead(new, "extra factor", 1.0))
            elif isinstance(node, ast.keyword) and _name(node.value) in _SHORT:
                found.append(here.within(node, "value", ast.Name("float", ast.Load()), "name", 1.0))
    return tuple(found)


def _rounded(node: Any, search: LineSearch) -> ast.expr | None:
    """What is rounded, where a node rounds it."""
    if not isinstance(node, ast.Call) or any(isinstance(one, ast.Starred) for one in node.args):
        return None
    name, function = called(node), node.func
    base = function.value if isinstance(function, ast.Attribute) else None
    module = getattr(base, "id", "")
    if base is None or isinstance(search.trial.space.get(module), ModuleType):
        return node.args[0] if name in (*ROUNDING, *_SHORT) and node.args else None
    if name == "astype":
        return base if any(_name(one) in _SHORT for one in node.args) else None
    return base if name == "round" else None


def _name(node: Any) -> str:
    """The last name of a kind of number: ``float32`` of ``np.float32``."""
    return str(getattr(node, "attr", getattr(node, "id", getattr(node, "value", ""))))


def _index(here: Here) -> bool:
    """Whether a node stands in an index, which is a whole number."""
    inside = (one.slice for one in here.above if isinstance(one, ast.Subscript))
    return any(one is here.node for part in inside for one in nodes(part))
