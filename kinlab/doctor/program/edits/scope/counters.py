"""What counts in a part: counters of loops, whole numbers, conditions on them."""

from __future__ import annotations

import ast
from collections.abc import Container, Iterator, Sequence

from kinlab.doctor.bytecode.syntax import called, copied, names, nodes, text_of
from kinlab.doctor.program.edits.scope.forms import entry, named
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Here
from kinlab.doctor.program.trial import Trial


def while_counters(tree: ast.FunctionDef, observed: Observed) -> Iterator[str]:
    """The names of whole numbers that a ``while`` loop counts on."""
    for loop in (node for node in nodes(tree) if isinstance(node, ast.While)):
        for node in (one for line in loop.body for one in nodes(line)):
            target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", 0)
            if isinstance(node, ast.Assign | ast.AugAssign) and isinstance(target, ast.Name):
                uses = (x for x in nodes(loop) if isinstance(x, ast.Name) and x.id == target.id)
                seen = next((y for y in map(observed.of, uses) if y is not None), None)
                if seen is not None and seen.whole and seen.shape == ():
                    yield target.id


def counters_around(here: Here, counting: Container[str]) -> list[str]:
    """What the loops around a place count with, of what counts: the innermost last."""
    loops = [x.target for x in here.above if isinstance(x, ast.For)]
    return [x.id for x in loops if isinstance(x, ast.Name) and x.id in counting]


def things(tree: ast.AST) -> set[str]:
    """The names of what is asked for members or keys: ``link.m``, ``link["m"]``."""
    every = nodes(tree)
    owners = [one.value for one in every if isinstance(one, ast.Attribute)]
    entries = [one for one in every if isinstance(one, ast.Subscript)]
    owners += [one.value for one in entries if isinstance(getattr(one.slice, "value", 0), str)]
    return {one.id for one in owners if isinstance(one, ast.Name)}


def counts(tree: ast.FunctionDef, observed: Observed, known: list[str]) -> list[str]:
    """Names of whole numbers that a part is given, and that are no counters of its own."""
    given = {one.arg for one in tree.args.args}
    found: list[str] = []
    for node in nodes(tree):
        if isinstance(node, ast.Name) and node.id in given and node.id not in (*known, *found):
            seen = observed.of(node)
            if seen is not None and seen.whole and seen.shape == ():
                found.append(node.id)
    return found


_SHAPED = ("range", "zeros", "eye", "ones", "empty", "full", "arange", "linspace", "reshape")


def measures(trial: Trial) -> set[str]:
    """The names of whole numbers of the user's data that count nothing: 90 of a length in mm."""
    found = {name for name in trial.program.data if type(trial.space.get(name)) is int}
    if not found:
        return found
    for node in (one for tree in trial.trees for one in nodes(tree)):
        shaped = isinstance(node, ast.Call) and called(node) in _SHAPED
        if isinstance(node, ast.Compare) or shaped:
            found -= {*names(node)}
        elif isinstance(node, ast.Subscript):
            found -= {*names(node.slice)}
    return found


def indices(tree: ast.AST) -> dict[str, set[str]]:
    """The names by which entries of a row are taken, by the row's text."""
    found: dict[str, set[str]] = {}
    for node in nodes(tree):
        if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Name):
            found.setdefault(text_of(node.value), set()).add(node.slice.id)
    return found


def tests(tree: ast.AST, trial: Trial, counters: Sequence[str]) -> dict[str, ast.expr]:
    """Conditions on what a counter counts, by their text; of kinds that nothing asks, too."""
    every = [node for one in trial.trees for node in nodes(one)]
    asked = [node.test for node in every if isinstance(node, ast.If | ast.IfExp)]
    here = {*names(tree), *counters}
    found = [one for one in asked if not {*counters}.isdisjoint(names(one))]
    found = [one for one in found if here.union(trial.space) >= {*names(one)}]
    # no first or last joint, but the joint's kind: kind == "R"
    found = [one for one in found if not {*names(one)} <= {*counters} or _is_of_letters(one)]
    found += _of_kinds(trial, counters)
    return {ast.unparse(one): copied(one) for one in found}


def _is_of_letters(test: ast.expr) -> bool:
    """Whether a condition compares with a text."""
    return any(isinstance(getattr(one, "value", None), str) for one in nodes(test))


def _of_kinds(trial: Trial, counters: Sequence[str]) -> Iterator[ast.expr]:
    """Whether a joint is of the one of two kinds, by a list of them that nothing uses."""
    used = {name for one in trial.trees for name in names(one)}
    for name, value in trial.space.items():
        listed = isinstance(value, str | list | tuple) and name not in used
        if not listed or not all(isinstance(one, str | bool) for one in value):
            continue
        kinds = {*value}
        if len(kinds) != 2:
            continue
        for counter in counters:
            own, kind = entry(named(name), named(counter)), sorted(kinds)[0]
            equal = ast.Compare(own, [ast.Eq()], [ast.Constant(kind)])
            yield own if isinstance(kind, bool) else equal
