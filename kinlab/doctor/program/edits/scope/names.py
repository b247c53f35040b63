"""The names of a part: what loops, calls and assignments set them to, with their shapes."""

from __future__ import annotations

import ast
from collections.abc import Container, Iterator

import numpy as np

from kinlab.doctor.bytecode.syntax import called, names, nodes
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import paired
from kinlab.doctor.program.trial import Trial

# -------- What loops set


def of_loop(
    loop: ast.For | ast.comprehension, trial: Trial, observed: Observed
) -> dict[str, Shape]:
    """The names that a loop sets to entries of tables and lists, each with its shape."""
    return dict(_passed(loop.target, _as_rows(loop.iter, trial), observed))


def _as_rows(over: ast.expr, trial: Trial) -> ast.expr:
    """What a loop goes over, with what a function of the program's yields in its place, or what is
    appended to a list.
    """
    if isinstance(over, ast.Name):
        calls = (one for tree in trial.trees for one in nodes(tree) if isinstance(one, ast.Call))
        rows = [one.args[0] for one in calls if _appends(one, over.id)]
        return ast.List(rows[-1:], ast.Load()) if rows else over
    if not isinstance(over, ast.Call):
        return over
    for part, tree in zip(trial.program.parts, trial.trees, strict=True):
        given = [one.value for one in nodes(tree) if isinstance(one, ast.Yield) and one.value]
        if part.name == called(over) and given:
            return ast.List(given[-1:], ast.Load())
    return ast.Call(over.func, [_as_rows(one, trial) for one in over.args], over.keywords)


def _appends(call: ast.Call, name: str) -> bool:
    """Whether a call appends several things together to a list: ``stack.append((R, p))``."""
    to = call.func.value if isinstance(call.func, ast.Attribute) else None
    own = isinstance(to, ast.Name) and to.id == name and called(call) == "append"
    return own and bool(call.args) and isinstance(call.args[0], ast.Tuple)


def _passed(target: ast.expr, over: ast.expr, observed: Observed) -> Iterator[tuple[str, Shape]]:
    inner = over.args if isinstance(over, ast.Call) else []
    parts = target.elts if isinstance(target, ast.Tuple) else []
    if isinstance(over, ast.Call) and called(over) == "zip" and len(inner) == len(parts):
        for one, own in zip(parts, inner, strict=True):
            yield from _passed(one, own, observed)
        return
    if isinstance(over, ast.Call) and called(over) == "enumerate" and inner and len(parts) == 2:
        yield from _passed(parts[1], inner[0], observed)
        return
    rows = over.elts if isinstance(over, ast.List | ast.Tuple) else []
    first = rows[0] if rows else None
    if parts and isinstance(first, ast.Tuple):
        for one, entry in zip(parts, first.elts, strict=False):
            known = observed.shape(entry)
            if isinstance(one, ast.Name) and known is not None and not _whole(entry, observed):
                yield one.id, known
        return
    shape = observed.shape(over)
    if not shape or (isinstance(over, ast.Call) and called(over) in ("range", "reversed")):
        return
    if isinstance(target, ast.Name) and (shape[1:] or not _counts(over, observed)):
        yield target.id, shape[1:]
    for one in parts if len(shape) > 1 else ():
        if isinstance(one, ast.Name):
            yield one.id, shape[2:]


def _counts(node: ast.AST, observed: Observed) -> bool:
    """Whether entries are whole numbers, and no signs: ``for i, side in enumerate([1, -1])``."""
    seen = observed.of(node)
    values = {float(x) for one in seen.values for x in np.ravel(one)} if seen is not None else set()
    return _whole(node, observed) and not (values and values <= {1.0, -1.0})


def _whole(node: ast.AST, observed: Observed) -> bool:
    seen = observed.of(node)
    return seen is not None and seen.whole


# -------- What calls give


def given(trial: Trial, part: int, observed: Observed) -> dict[str, Shape]:
    """What a part is given, by the names that it has for it."""
    arguments = [one.arg for one in trial.trees[part].args.args]
    owned = trial.program.parts[part].owner is not None
    own = () if part else zip(arguments[len(trial.bound) :], observed.given, strict=False)
    found = {name: shape for name, shape in own if shape is not None}
    for tree in trial.trees if part else ():
        for node in nodes(tree):
            if isinstance(node, ast.Call) and called(node) == trial.program.parts[part].name:
                for name, value in zip(arguments[owned:], node.args, strict=False):
                    seen = observed.of(value)
                    if seen is not None and seen.shape is not None and not seen.whole:
                        found.setdefault(name, seen.shape)
    return found


# -------- What assignments set


def first_lines(tree: ast.AST) -> dict[str, int]:
    """The names that are set, and the lines in which they are set first."""
    every = (one for one in nodes(tree) if isinstance(one, ast.Name))
    stores = (one for one in every if isinstance(one.ctx, ast.Store))
    found: dict[str, int] = {}
    for store in sorted(stores, key=lambda one: one.lineno):
        found.setdefault(store.id, store.lineno)
    return found


def unpacked(
    target: ast.expr, value: ast.expr, trial: Trial, observed: Observed
) -> Iterator[tuple[str, Shape]]:
    """The names that an assignment sets, each with the shape of its value."""
    for name, part in _set(target, value):
        shape = observed.shape(part)
        if shape is not None:
            yield name, shape
    if isinstance(target, ast.Tuple) and not isinstance(value, ast.Tuple):
        shape = observed.shape(value)
        for one in target.elts:
            if isinstance(one, ast.Name) and shape:
                yield one.id, shape[1:]
        given = _given_by(value, trial)
        entries = given.elts if given is not None and len(given.elts) == len(target.elts) else []
        for one, entry in zip(target.elts, entries, strict=False):
            shape = observed.shape(entry)
            if isinstance(one, ast.Name) and shape is not None:
                yield one.id, shape


def _given_by(value: ast.expr, trial: Trial) -> ast.Tuple | None:
    """The entries that a function of the program's gives, where it is called, or that a list of
    which one is taken was filled with."""
    if isinstance(value, ast.Subscript):
        every = (node for tree in trial.trees for node in nodes(tree))
        calls = [x for x in every if isinstance(x, ast.Call) and called(x) == "append" and x.args]
        own = f"{ast.unparse(value.value)}.append"
        kept = [x.args[0] for x in calls if ast.unparse(x.func) == own]
        return kept[0] if kept and isinstance(kept[0], ast.Tuple) else None
    name = called(value) if isinstance(value, ast.Call) else ""
    for part, tree in zip(trial.program.parts, trial.trees, strict=True):
        if name and part.name == name:
            given = [x.value for x in nodes(tree) if isinstance(x, ast.Return)]
            last = given[-1] if given else None
            return last if isinstance(last, ast.Tuple) else None
    return None


def set_by(tree: ast.AST, functions: Container[str]) -> set[str]:
    """The names that are set to what one of some functions gives."""
    lines = [node for node in nodes(tree) if isinstance(node, ast.Assign)]
    pairs = (pair for one in lines for target in one.targets for pair in _set(target, one.value))
    return {name for name, x in pairs if isinstance(x, ast.Call) and called(x) in functions}


def set_together(tree: ast.AST) -> dict[str, set[str]]:
    """Names that are set to the entries of one thing."""
    found: dict[str, set[str]] = {}
    for node in nodes(tree):
        if isinstance(node, ast.Assign) and not isinstance(node.value, ast.Tuple | ast.List):
            for target in node.targets:
                every = names(target) if isinstance(target, ast.Tuple) else []
                for name in every:
                    found.setdefault(name, set()).update(every)
    return found


def _set(target: ast.expr, value: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    """The names that an assignment sets, each with its value."""
    for one, part in paired(target, value):
        if isinstance(one, ast.Name):
            yield one.id, part
