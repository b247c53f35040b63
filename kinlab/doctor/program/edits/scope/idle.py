"""What is set or given and used nowhere: names, entries, joints, rows, functions."""

from __future__ import annotations

import ast
from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from types import FunctionType

from kinlab.doctor.bytecode.syntax import called, copied, names, nodes
from kinlab.doctor.program.edits.scope.forms import Turned, entry, named
from kinlab.doctor.program.edits.scope.pieces import Sized
from kinlab.doctor.program.edits.scope.values import shape_of
from kinlab.doctor.program.observed import Observed, Shape
from kinlab.doctor.program.places import reads
from kinlab.doctor.program.read import read
from kinlab.doctor.program.trial import Trial

JOINTS = 7
"""Entries of a row that nothing uses up to which each is tried."""
_VECTOR, _MATRIX, _TWISTS = (3,), (3, 3), (6, 6)

# -------- Names


def unused_names(
    trial: Trial, tree: ast.AST, local: Container[str], known: Iterable[str]
) -> set[str]:
    """Of known names those that nothing uses: of a part's own it does not, of others no part does.

    Args:
        trial: the program.
        tree: of the part.
        local: the names that are the part's own.
        known: those that are asked for.
    """
    every, here = set[str]().union(*map(_used, trial.trees)), _used(tree)
    return {name for name in known if name not in (here if name in local else every)}


def _used(tree: ast.AST) -> set[str]:
    """The names that are used for more than to be filled: ``J`` in ``J[:, j] = z``."""
    grown = {id(one) for node in nodes(tree) for one in _appended_to(node)}
    kept = (one for one in nodes(tree) if isinstance(one, ast.Name) and id(one) not in grown)
    return {one.id for one in kept if isinstance(one.ctx, ast.Load)} & reads(tree)


def _appended_to(node: ast.AST) -> Iterator[ast.expr]:
    """The list into which a statement only puts an entry more."""
    call = node.value if isinstance(node, ast.Expr) else None
    if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute):
        yield from [call.func.value] * (call.func.attr == "append")


# -------- Entries of rows, and joints


def idle_entries(trial: Trial, shapes: Mapping[str, Shape]) -> set[str]:
    """The entries of rows that the function is given, and of which it uses others alone."""
    tree = trial.trees[0]
    idle = [(name, k) for name in _given(trial) for k in _idle_of(tree, name, shapes.get(name, ()))]
    return {f"{name}[{k}]" for name, k in idle}


def idle_joints(trial: Trial, shapes: Mapping[str, Shape]) -> Iterator[ast.Subscript]:
    """The positions of joints that the function uses nowhere: ``q[1]``."""
    given = _given(trial)
    name = given[0] if given else ""
    rows = (shapes.get(one, ()) for one in given)  # of as many joints
    sizes = next((one for one in rows if len(one) == 1), ())
    for k in _idle_of(trial.trees[0], name, sizes):
        yield entry(named(name), ast.Constant(k))


def unturned(tree: ast.AST, turned: Collection[str]) -> Iterator[ast.Name]:
    """Angles that stand in a row beside ones of which sines are taken, and of which none is."""
    rows = [[*x.elts] for x in nodes(tree) if isinstance(x, ast.List | ast.Tuple)]
    for row in rows:
        every = [x.id for x in row if isinstance(x, ast.Name) and isinstance(x.ctx, ast.Load)]
        if not {*turned}.isdisjoint(every):
            yield from (named(x) for x in every if x not in turned)


def with_its_angle(joint: ast.expr, sine: ast.expr) -> Iterator[ast.expr]:
    """A joint's position, and its sine and cosine."""
    one = ast.Call(copied(sine), [joint], [])
    yield joint
    yield one
    yield Turned().visit(copied(one))


def calls_for(
    joint: ast.Subscript, tree: ast.AST, own: Container[str], observed: Observed
) -> Iterator[Sized]:
    """The calls of the program's own functions, for a joint in place of others."""
    row = ast.unparse(joint.value)
    for call in (x for x in nodes(tree) if isinstance(x, ast.Call) and called(x) in own):
        args = [joint if _is_entry_of(x, row) else x for x in call.args]
        if joint in args:
            yield observed.shape(call) or (), ast.Call(call.func, args, call.keywords)


def idle_rows(trial: Trial, tree: ast.AST, observed: Observed) -> Iterator[Sized]:
    """Entries that nothing uses of a list whose others are used one by one: ``P[2]``."""
    lines = (node for node in nodes(tree) if isinstance(node, ast.Assign))
    rows = {
        line.targets[0].id: [observed.shape(one) for one in line.value.elts]
        for line in lines
        if isinstance(line.targets[0], ast.Name) and isinstance(line.value, ast.List)
    }
    within: dict[str, Sequence[ast.AST]] = {name: [tree] for name in rows}
    for name in trial.program.data:
        value = trial.space[name]
        if isinstance(value, list | tuple) and name not in rows:
            rows[name], within[name] = [shape_of(one) for one in value], trial.trees
    for name, shapes in rows.items():
        idle = [_idle_of(one, name, (len(shapes),)) for one in within[name]]
        for k in set(idle[0]).intersection(*idle) if len(shapes) <= JOINTS else ():
            if (shape := shapes[k]) is not None:
                yield shape, entry(named(name), ast.Constant(k))


def _given(trial: Trial) -> list[str]:
    """The names of what the function is given."""
    return [one.arg for one in trial.trees[0].args.args][len(trial.bound) :]


def _idle_of(tree: ast.AST, name: str, sizes: Shape) -> list[int]:
    """The entries of a row that nothing uses, where single ones are used alone."""
    entries = [x for x in nodes(tree) if isinstance(x, ast.Subscript)]
    used = [k for k in (_entry_of(x, name) for x in entries) if k is not None]
    loads = [x for x in names(tree, ast.Load) if x == name]
    alone = len(loads) == len(used) and len(sizes) == 1
    return sorted({*range(sizes[0])}.difference(used)) if alone else []


def _entry_of(node: ast.Subscript, name: str) -> int | None:
    """Which entry of a row it is; None where it is none."""
    own = isinstance(node.value, ast.Name) and node.value.id == name
    index = node.slice.value if own and isinstance(node.slice, ast.Constant) else None
    return index if type(index) is int else None


def _is_entry_of(node: ast.expr, name: str) -> bool:
    return isinstance(node, ast.Subscript) and _entry_of(node, name) is not None


# -------- Functions


def uncalled(
    trial: Trial,
    observed: Observed,
    own: Container[str],
    names: Sequence[str],
    at_hand: Sequence[str],
) -> Iterator[Sized]:
    """Calls of the module's functions that nothing calls, with what is at hand.

    Args:
        trial: the program.
        observed: what its expressions were.
        own: the names of its functions.
        names: those of the functions that nothing calls.
        at_hand: names that may be given to them.
    """
    known = {observed.shape(x) for x in _calls(trial) if called(x) in own}
    shapes = {_VECTOR, _MATRIX, _TWISTS, *(one for one in known if one)}
    for name in names:
        for given in at_hand:
            call = ast.Call(named(name), [named(given)], [])
            for shape in sorted(shapes):
                yield shape, call


def calls_with_idle(
    trial: Trial,
    observed: Observed,
    own: Mapping[str, int],
    rows: Sequence[str],
    counters: Sequence[str],
) -> Iterator[Sized]:
    """Calls of the program's functions with an entry of a row that nothing uses.

    Args:
        trial: the program.
        observed: what its expressions were.
        own: its functions, each with how many arguments it asks for.
        rows: the rows that nothing uses.
        counters: names that count.
    """
    every, by = _calls(trial), [named(one) for one in counters]
    entries = [entry(named(row), counter) for row in rows for counter in by]
    for name, count in own.items() if entries else ():
        calls = (x for x in every if called(x) == name)
        shape = next(map(observed.shape, calls), None) or _MATRIX
        for k in range(count if len(shape) == 2 else 0):
            for one in entries:
                args: list[ast.expr] = [ast.Constant(0)] * k
                args += [one, *[ast.Constant(0)] * (count - k - 1)]
                yield shape, ast.Call(named(name), args, [])


def _calls(trial: Trial) -> list[ast.Call]:
    return [x for one in trial.trees for x in nodes(one) if isinstance(x, ast.Call)]


def not_called(trial: Trial) -> Iterator[str]:
    """The module's functions of one argument that the program does not call, and could."""
    program, known_ = trial.program, {called(x) for x in _calls(trial)}
    for name, value in program.space.items():
        if name in known_ or not isinstance(value, FunctionType):
            continue
        own = value.__module__ in program.modules and value.__name__ == name
        known = {part.name for part in program.parts}
        alone = value.__code__.co_argcount == 1 and name not in known
        if own and alone and _is_readable(value):
            yield name


@lru_cache(maxsize=64)
def _is_readable(function: FunctionType) -> bool:
    return read(function) is not None
