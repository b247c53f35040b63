"""Matrices of frames otherwise: the factors of a link's transform in another order, a row for the
column of one name."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, factors, nodes
from kinlab.doctor.program.edits import chains
from kinlab.doctor.program.edits.scope.forms import entry, named, statement_of
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.edits.single.whole import value_of, whole_constant
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Here, ProgramEdit, array_of, number, paired
from kinlab.tolerances import TOLERANCES

_LINK = 4
"""Factors of a link's transform: about z and along z, along x and about x."""
_STANDARD = (("turn", 2), ("shift", 2), ("shift", 0), ("turn", 0))
_MODIFIED = (("turn", 0), ("shift", 0), ("turn", 2), ("shift", 2))
"""Their orders."""
_OTHER_TABLE, _IN_TURN = 1.03, 1.1
"""Cost of the order of the other convention, and of another one."""
_TURNED_BACK, _ALIKE = 1.07, 0.01
"""Cost of the way to a frame in its own axes; what the other convention's costs more."""
_ACROSS = 1.06
"""Cost of a row for a column, or of a column for a row."""
_LEAST = 3
"""Factors beside the one that stays of which there may be another order."""
_AXES, _PAIR = 3, 2
"""Columns of a rotation; factors of a length along an axis."""

# -------- The factors of a link's transform


def of_links(here: Here, observed: Observed) -> Iterator[ProgramEdit]:
    """A product of matrices as the other convention has it; one of what a loop adds, in turn.

    Args:
        here: the product.
        observed: what its factors were.
    """
    parent = here.parent
    if isinstance(parent, ast.BinOp) and isinstance(parent.op, ast.MatMult):
        return
    every = chains.members(chains.chain(here.node, (ast.MatMult,)))
    before, inner, behind = _without_what_is_set(here, every)
    for order in _as_of_the_other_table(inner, observed):
        yield _in_order(here, [*before, *order, *behind], _OTHER_TABLE)
    if len(inner) >= _LEAST and len(inner) < len(every):  # of a whole one others do this
        for k in range(1, len(inner)):
            yield _in_order(here, [*before, *inner[k:], *inner[:k], *behind], _IN_TURN)
        yield _in_order(here, [*before, *inner[::-1], *behind], _IN_TURN)


def _in_order(here: Here, order: Sequence[ast.expr], cost: float) -> ProgramEdit:
    by = [(ast.MatMult(), one) for one in order[1:]]
    return here.instead(chains.joined(order[0], by), "order", cost)


def _without_what_is_set(
    here: Here, every: list[ast.expr]
) -> tuple[list[ast.expr], list[ast.expr], list[ast.expr]]:
    """The factors without the one that a statement multiplies: ``T`` of ``T = T @ A @ B``."""
    line = statement_of(here.above)
    targets = line.targets if isinstance(line, ast.Assign) else []
    own = [ast.unparse(one) for one in targets]
    if ast.unparse(every[0]) in own:
        return every[:1], every[1:], []
    if ast.unparse(every[-1]) in own:
        return [], every[:-1], every[-1:]
    return [], every, []


def _as_of_the_other_table(inner: list[ast.expr], observed: Observed) -> Iterator[list[ast.expr]]:
    """Turns and shifts about and along x and z in the order of the convention that it is not."""
    if len(inner) != _LINK:
        return
    found = {_what_it_does(one, observed): one for one in inner}
    if set(found) != set(_STANDARD):
        return
    own = [*found]
    first = {axis for _what, axis in (one for one in own[:2] if one is not None)}
    for order, axis in ((_STANDARD, 2), (_MODIFIED, 0)):
        if first != {axis}:
            yield [found[one] for one in order]


def _what_it_does(node: ast.expr, observed: Observed) -> tuple[str, int] | None:
    """Whether a matrix turns or shifts, and about or along which axis; None of another."""
    seen = observed.of(node)
    if seen is None or seen.shape != (4, 4) or not seen.values:
        return None
    moves = [("shift", axis) for axis in range(3) if _shifts(seen.values, axis)]
    moves += [("turn", axis) for axis in range(3) if _turns(seen.values, axis)]
    return moves[0] if len(moves) == 1 else None


def _shifts(values: Sequence[Array], axis: int) -> bool:
    """Whether matrices do nothing but shift along an axis."""
    rest = [one - np.eye(4) for one in values]
    moved = [one[axis, 3] for one in rest]
    for one in rest:
        one[axis, 3] = 0.0
    return any(moved) and not any(_is_something(one) for one in rest)


def _turns(values: Sequence[Array], axis: int) -> bool:
    """Whether matrices do nothing but turn about an axis."""
    unit = np.eye(4)
    kept = [axis, 3]
    still = all(
        not _is_something(one[:, kept] - unit[:, kept])
        and not _is_something(one[kept] - unit[kept])
        for one in values
    )
    return still and any(_is_something(one - unit) for one in values)


def _is_something(matrix: Array) -> bool:
    return bool(np.max(np.abs(matrix)) > TOLERANCES.same_relation)


# -------- Where a frame is


def of_origins(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """The way to a link's frame in that frame's axes: ``[a, d*sa, d*ca]`` for ``[a, 0, d]``.

    Or ``[a*c, a*s, d]`` for it, in those of the frame before.

    Args:
        here: what is written as a row.
        scope: the sines and cosines that may be the twist's.
    """
    row = here.node.elts
    found = _along_and_up(row) if len(row) == _AXES else None
    if found is None:
        return
    across, up = found
    for sine, cosine in _sines_and_cosines(scope):
        for sign, cost in ((False, _TURNED_BACK), (True, _TURNED_BACK + _ALIKE)):
            aside = chains.opposite(up) if sign else up
            new = [across, ast.BinOp(aside, ast.Mult(), sine), ast.BinOp(up, ast.Mult(), cosine)]
            yield here.within(here.node, "elts", new, "axes", cost)
        if isinstance(row[1], ast.Constant):
            new = [ast.BinOp(across, ast.Mult(), x) for x in (cosine, sine)]
            yield here.within(here.node, "elts", [*new, up], "axes", _TURNED_BACK)


def _along_and_up(row: Sequence[ast.expr]) -> tuple[ast.expr, ast.expr] | None:
    """What is along x, and along z: ``a`` and ``d`` of ``[a, 0, d]`` and ``[a*c, a*s, d]``."""
    if isinstance(row[2], ast.Constant | ast.BinOp):
        return None
    if isinstance(row[1], ast.Constant) and row[1].value == 0:
        return (row[0], row[2]) if not isinstance(row[0], ast.Constant) else None
    one, other = factors(row[0]), factors(row[1])
    texts = [ast.unparse(x) for x in other]
    both = [x for x in one if ast.unparse(x) in texts]
    return (both[0], row[2]) if len(both) == 1 and len(one) == len(other) == _PAIR else None


def _sines_and_cosines(scope: Scope) -> Iterator[tuple[ast.expr, ast.expr]]:
    """The sines and cosines of one angle: names of them first."""
    simple = dict(scope.simple(()))
    named_ = {x.id: x for x in simple.values() if isinstance(x, ast.Name)}
    for name, sine in named_.items():
        for other in {name.replace("s", "c", 1), name.replace("sin", "cos", 1)} - {name}:
            if other in named_:
                yield sine, named_[other]
    calls = [x for x in scope.pieces_here(()).values() if isinstance(x, ast.Call)]
    sines = [x for x in calls if called(x) == "sin"]
    for one in sines:
        for other_ in [x for x in calls if called(x) == "cos"]:
            if ast.dump(one.args[0]) == ast.dump(other_.args[0]):
                yield one, other_
    known = {ast.unparse(x.args[0]) for x in sines}
    for text in [x for x in simple if x.startswith("al") and x not in known]:
        if scope.has_numpy:
            of = [ast.parse(f"np.{name}({text})", mode="eval").body for name in ("sin", "cos")]
            yield of[0], of[1]


def along_its_own_axis(here: Here, target: ast.Subscript, scope: Scope) -> Iterator[ProgramEdit]:
    """A way along a frame's own axis for one of the base's: ``T[:3, 3] += x*T[:3, 2]``.

    Args:
        here: the statement, ``T[2, 3] += x``.
        target: what it writes into.
        scope: what is a pose there.
    """
    key = [getattr(one, "value", None) for one in getattr(target.slice, "elts", ())]
    if len(key) != _PAIR or key[1] != _AXES or key[0] not in range(_AXES):
        return
    if scope.is_pose(target.value):
        above = ast.Slice(None, ast.Constant(_AXES), None)
        origin = ast.Subscript(
            target.value, ast.Tuple([above, ast.Constant(_AXES)], ast.Load()), ast.Store()
        )
        axis = ast.Subscript(
            target.value, ast.Tuple([above, ast.Constant(key[0])], ast.Load()), ast.Load()
        )
        way = ast.BinOp(here.node.value, ast.Mult(), axis)
        yield here.instead(ast.AugAssign(origin, here.node.op, way), "axes", _TURNED_BACK)


# -------- Columns that have names


def columns_of(tree: ast.AST, observed: Observed) -> dict[str, tuple[str, ...]]:
    """By each name those of all the columns, or rows, of its matrix: ``n, o, a`` of a rotation.

    Args:
        tree: a part of a program.
        observed: what its expressions were.
    """
    groups: dict[tuple[str, str], dict[int, str]] = {}
    for node in (one for one in nodes(tree) if isinstance(one, ast.Assign)):
        for target in node.targets:
            for one, value in paired(target, node.value):
                at = _place_of(value)
                if isinstance(one, ast.Name) and at is not None:
                    groups.setdefault(at[0], {})[at[1]] = one.id
            whole = target.elts if isinstance(target, ast.Tuple) else []
            shape = observed.shape(node.value)
            if shape == (len(whole),) * 2 and all(isinstance(x, ast.Name) for x in whole):
                own = (ast.unparse(node.value), "")
                groups[own] = {k: x.id for k, x in enumerate(whole) if isinstance(x, ast.Name)}
    found: dict[str, tuple[str, ...]] = {}
    for group in groups.values():
        if all(k in group for k in range(_AXES)):
            columns = tuple(group[k] for k in range(_AXES))
            found |= dict.fromkeys(columns, columns)
    return found


def _place_of(value: ast.expr) -> tuple[tuple[str, str], int] | None:
    """Of which matrix something is a column or a row, and which: ``T[:3, 2]``, ``R[2]``."""
    if not isinstance(value, ast.Subscript):
        return None
    key = value.slice
    keys = key.elts if isinstance(key, ast.Tuple) else [key]
    at = [one for one in keys if whole_constant(one)]
    slices = [one for one in keys if isinstance(one, ast.Slice)]
    if len(at) != 1 or len(keys) > 2 or len(slices) != len(keys) - 1:
        return None
    rest = ", ".join("" if one is at[0] else ast.unparse(one) for one in keys)
    return (ast.unparse(value.value), rest), value_of(at[0])


def of_columns(
    here: Here, known: dict[str, tuple[str, ...]], scope: Scope, observed: Observed
) -> Iterator[ProgramEdit]:
    """A row for a column of one name, and the other way: ``n[2], o[2], a[2]`` for ``a``.

    Args:
        here: a name, or what is written as a row.
        known: the columns that have names.
        scope: whether numpy can be called.
        observed: the shapes.
    """
    node = here.node
    if isinstance(node, ast.Name) and node.id in known:
        columns = known[node.id]
        inner = isinstance(here.parent, ast.Subscript | ast.Attribute)
        if inner or observed.shape(node) != (len(columns),):
            return
        k = columns.index(node.id)
        row: list[ast.expr] = [entry(named(one), number(k)) for one in columns]
        if isinstance(here.parent, ast.Assign):
            yield here.instead(ast.Tuple(row, ast.Load()), "transposed", _ACROSS)
        elif scope.has_numpy:
            yield here.instead(array_of(row), "transposed", _ACROSS)
    elif isinstance(node, ast.List | ast.Tuple) and isinstance(node.ctx, ast.Load):
        given = [one for one in node.elts if isinstance(one, ast.Subscript)]
        names = tuple(getattr(one.value, "id", "") for one in given)
        columns = known.get(names[0], ()) if names else ()
        if names != columns or len(given) < len(node.elts):
            return
        at = {value_of(one.slice) for one in given if whole_constant(one.slice)}
        for k in at & {*range(len(columns))} if len(at) == 1 else ():
            yield here.instead(named(columns[k]), "transposed", _ACROSS)
