"""How a program may call what is not its own: pi, the sine, roots, products of vectors."""

from __future__ import annotations

import ast
from itertools import accumulate
from math import pi
from types import FunctionType, ModuleType
from typing import Any

import numpy as np

from kinlab.doctor.bytecode.syntax import called, nodes
from kinlab.doctor.program.edits.scope.forms import member, named
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.trial import Trial

ARCS = ("arccos", "acos", "arcsin", "asin", "arctan2", "atan2", "arctan", "atan")
PI = member(named("np"), "pi")


def accumulating(space: dict[str, Any]) -> str:
    """What the program calls :func:`itertools.accumulate`; empty where it does not."""
    return next((name for name, held in space.items() if held is accumulate), "")


def has_numpy(space: dict[str, Any]) -> bool:
    """Whether numpy is called ``np``."""
    return isinstance(space.get("np"), ModuleType)


def pi_of(space: dict[str, Any]) -> ast.expr | None:
    """How a program may write pi; None where it cannot."""
    if has_numpy(space):
        return PI
    for name, value in space.items():
        if isinstance(value, float) and value == pi:
            return named(name)
        if isinstance(value, ModuleType) and getattr(value, "pi", None) == pi:
            return member(named(name), "pi")
    return None


def sine_of(space: dict[str, Any]) -> ast.expr | None:
    """How a program may call the sine; None where it cannot."""
    if callable(space.get("sin")) and callable(space.get("cos")):
        return named("sin")
    known = [name for name, x in space.items() if isinstance(x, ModuleType) and hasattr(x, "sin")]
    name = "np" if "np" in known else next(iter(known), None)
    return None if name is None else member(named(name), "sin")


def root_of(calls: list[ast.Call], space: dict[str, Any]) -> ast.expr | None:
    """The function with which a part takes roots, or with which it may."""
    own = next((call.func for call in calls if called(call) == "sqrt"), None)
    if own is not None or "sqrt" in space:
        return own or named("sqrt")
    for name, value in space.items():
        if isinstance(value, ModuleType) and hasattr(value, "sqrt"):
            return member(named(name), "sqrt")
    return None


def cross_of(calls: list[ast.Call], observed: Observed, space: dict[str, Any]) -> ast.expr | None:
    """The function with which a part takes products of vectors; without one numpy's."""
    for call in calls:
        seen = [observed.of(one) for one in (*call.args, call)]
        rows = [one.values[:1] for one in seen if one is not None and one.shape == (3,)]
        if len(call.args) == 2 and len(rows) == len(seen) and all(rows):
            (one,), (other,), (found,) = rows
            if found.any() and np.allclose(found, np.cross(one, other)):
                return call.func
    return member(named("np"), "cross") if has_numpy(space) else None


def crossing_of(trial: Trial, observed: Observed) -> list[str]:
    """The program's own functions that make a matrix of a twist, as to cross others with it."""
    own = {part.name for part in trial.program.parts}
    found: list[str] = []
    for node in (node for tree in trial.trees for node in nodes(tree)):
        alone = isinstance(node, ast.Call) and len(node.args) == 1 and called(node) in own
        if alone and isinstance(node, ast.Call) and observed.shape(node) == (6, 6):
            found += [called(node)] * (observed.shape(node.args[0]) == (6,))
    return [*dict.fromkeys(found)]


def methods_of(trial: Trial) -> dict[str, int]:
    """The methods of a program's classes, each with how many arguments it asks for, self too."""
    found: dict[str, int] = {}
    for one in trial.classes:
        for name, held in vars(one).items():
            function = getattr(held, "__func__", held)
            if isinstance(function, FunctionType) and not name.startswith("__"):
                found[name] = function.__code__.co_argcount
    return found
