"""Entries of arrays and lists otherwise: another index, other rows, what is written elsewhere."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from itertools import permutations
from typing import Any

from kinlab.doctor.bytecode.syntax import copied, names, nodes, text_of
from kinlab.doctor.program.edits.scope.forms import statement_of
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.edits.single.rows import swapped_in
from kinlab.doctor.program.edits.single.whole import plus, shifted, value_of, whole_constant
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import Here, ProgramEdit, called_with, number

_PICKED, _LESS = 1.1, 0.02
"""Cost of one of several indices that are picked out; how much less of the one beside it."""
_IDLE, _FEW = 1.0, 8
"""Cost of a key that the program never asks for; keys among which a wrong one is looked for early.
"""
_LONGEST = 6
"""Entries of a list of which any two may have been exchanged."""
_THREE = 3
"""Indices of which any order is tried."""
_COUNTED = 1.09
"""Cost of an index by which entries of other rows are taken."""
_SET_ANEW, _WITH_A_NAME = 1.06, 1.14
"""Cost of what a statement sets, for a part of something; of another vector with a name."""
_OWN = 1.1
"""Cost of the entry of another list by the counter itself, for one more or one less."""
_OF_BOTH = 1.12
"""Cost of the larger, or smaller, of two counters for one: ``o[max(j, k)]``."""
_BESIDE = 1.06
"""Cost of an index that another row has in the same line."""


_OF_THE_SUM = 1.06
"""Cost of a row that is a sum, for the number in it."""
_INDICES = 1.06
"""Cost of another order of three indices: of Christoffel's symbols."""


def of_subscript(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    node = here.node
    shape = observed.shape(node.value)
    if isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, str):
        yield from _of_key(here, node.slice, scope)
        if shape is None and observed.shape(node) == ():
            yield from _with_keys(here, node.slice, scope)
        return
    if is_joined(node):
        if isinstance(node.slice, ast.Tuple) and len(node.slice.elts) <= _LONGEST:
            yield from swapped_in(here, node.slice, observed)
        return
    keys = keys_of(node)
    if isinstance(node.slice, ast.Slice) and isinstance(node.ctx, ast.Load):
        yield here.instead(node.value, "index", 1.1)
    if isinstance(node.ctx, ast.Load):
        yield from _named(here, scope, observed)
    yield from of_keys(here, node, 1.1)
    yield from _other_slices(here)
    yield from _in_another_order(here)
    for name in sorted(scope.unused) if isinstance(node.ctx, ast.Load) else ():
        if scope.shapes.get(name) == observed.shape(node):
            yield here.instead(ast.Name(name, ast.Load()), "name", 1.05)
    for name in scope.sums_with.get(text_of(node), ()):
        if scope.shapes.get(name) not in (None, observed.shape(node)):  # one number for a row
            yield here.instead(ast.Name(name, ast.Load()), "name", _OF_THE_SUM)
    beside = _keys_beside(here)
    for k, (holder, field, key) in enumerate(keys):
        size = shape[k] if shape is not None and k < len(shape) else 0
        if isinstance(key, ast.List) and all(map(whole_constant, key.elts)):
            for n, one in enumerate(key.elts):  # which are taken: wrench[[0, 1, 5]]
                for other in {*range(size)} - {*map(value_of, key.elts)}:
                    near = abs(other - value_of(one)) == 1
                    cost = _PICKED - _LESS * near
                    yield here.within(key.elts, n, number(other), "index", cost)
        if whole_constant(key):
            alike = _places_beside(here, observed) if len(keys) == 1 else set()
            for other in range(-1, max(size, 4 if not size else 0)):
                if other != value_of(key) and not (other == -1 and size):
                    near = other in alike or abs(other - value_of(key)) == 1
                    yield here.within(holder, field, number(other), "index", 1.05 if near else 1.1)
            for name in scope.whole:
                cost = _by_counter(name, node, scope, beside)
                yield here.within(holder, field, ast.Name(name, ast.Load()), "index", cost)
        elif not isinstance(key, ast.Constant | ast.Slice):
            for text, index in beside.items():
                if text not in _near(key) and not is_of_three(here, text):
                    yield here.within(holder, field, copied(index), "index", 1.08)
                both = [key, index]
                if text != text_of(key) and all(isinstance(one, ast.Name) for one in both):
                    for name in ("max", "min") if isinstance(node.ctx, ast.Load) else ():
                        farther = called_with(name, *map(copied, both))
                        yield here.within(holder, field, farther, "index", _OF_BOTH)
    _holder, _field, key = keys[0]
    single = len(keys) == 1 and not isinstance(node.slice, ast.Tuple)
    if single and isinstance(key, ast.BinOp) and isinstance(node.ctx, ast.Load):
        yield from _own_of_another(here, key, scope, observed)
    elif single and isinstance(key, ast.Name) and isinstance(node.ctx, ast.Load):
        yield from _next_of_another(here, key, scope, observed)
    if single and shape is not None and len(shape) == 2 and not isinstance(key, ast.Slice):
        column = ast.Tuple([ast.Slice(None, None, None), key], ast.Load())
        yield here.within(node, "slice", column, "transposed", 1.15)


def _own_of_another(
    here: Here, key: ast.BinOp, scope: Scope, observed: Observed
) -> Iterator[ProgramEdit]:
    """A link's own vector in another list, for the next one's: ``PC[i]`` for ``P[i + 1]``."""
    shape = observed.shape(here.node)
    for counter in (one for one in (key.left, key.right) if isinstance(one, ast.Name)):
        for other, entries in scope.lists.items() if shape and counter.id in scope.counting else ():
            if entries == shape and other != getattr(here.node.value, "id", ""):
                own = ast.Subscript(ast.Name(other, ast.Load()), copied(counter), ast.Load())
                yield here.instead(own, "name", _OWN)


def _next_of_another(
    here: Here, key: ast.Name, scope: Scope, observed: Observed
) -> Iterator[ProgramEdit]:
    """The other way round: the way to the next joint for a link's own vector."""
    shape = observed.shape(here.node)
    lists = [one for one, entries in scope.lists.items() if shape and entries == shape]
    others = [one for one in lists if one != getattr(here.node.value, "id", "")]
    if not others or key.id not in scope.counting:
        return
    every = (one.slice for one in nodes(here.above[0]) if isinstance(one, ast.Subscript))
    keys = {text_of(one): one for one in every if isinstance(one, ast.BinOp)}
    for index in (one for one in keys.values() if key.id in names(one)):
        for other in others:
            new = ast.Subscript(ast.Name(other, ast.Load()), copied(index), ast.Load())
            yield here.instead(new, "name", _OWN)


def _named(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """A vector or a matrix that has a name, for a part of another: ``z`` for ``R[:, 2]``.

    Soonest what the statement sets, which is then set anew from what it was.
    """
    shape = observed.shape(here.node)
    parent = here.parent
    of_another = isinstance(parent, ast.Attribute) and parent.attr not in ("T", "dot")
    if not shape or of_another or isinstance(parent, ast.Subscript):
        return
    line = statement_of(here.above)
    targets = line.targets if isinstance(line, ast.Assign) else []
    own = {one.id for one in targets if isinstance(one, ast.Name)}
    for name, known in scope.shapes.items():
        if known == shape and name not in scope.counters and name not in scope.unused:
            cost = _SET_ANEW if name in own else _WITH_A_NAME
            yield here.instead(ast.Name(name, ast.Load()), "name", cost)


def _by_counter(
    name: str, node: ast.Subscript, scope: Scope, beside: Mapping[str, ast.expr]
) -> float:
    """Cost of a counter for a number, less where entries are taken by it in other places."""
    if name in beside or name in scope.indices.get(text_of(node.value), ()):
        return _BESIDE
    return _COUNTED if any(name in one for one in scope.indices.values()) else 1.13


def is_of_three(here: Here, other: str) -> bool:
    """Whether it stands in ``D[i, j, k]``, or is one of its indices, and another is the other."""
    chain = [one for one in (*here.above, here.node) if isinstance(one, ast.Subscript)]
    keys = {text_of(key) for one in chain for *_place, key in keys_of(one)}
    return len(keys) >= _THREE and other in keys


def _other_slices(here: Here) -> Iterator[ProgramEdit]:
    """The part of a row that is taken of another one in the same line."""
    line = next(one for one in reversed(here.above) if isinstance(one, ast.stmt))
    known = {ast.dump(one): one for one in nodes(line) if isinstance(one, ast.Slice)}
    for holder, field, key in keys_of(here.node):
        for text, other in known.items() if isinstance(key, ast.Slice) else ():
            if text != ast.dump(key):
                yield here.within(holder, field, copied(other), "index", 1.09)


def _keys_beside(here: Here) -> dict[str, ast.expr]:
    """The indices that rows have in the same line, and that are counted: ``i``, ``j + 1``."""
    line = nodes(statement_of(here.above))
    rows = [one for one in line if isinstance(one, ast.Subscript) and not is_joined(one)]
    keys = [key for one in rows for _holder, _field, key in keys_of(one)]
    return {ast.unparse(one): one for one in keys if isinstance(one, ast.Name) or shifted(one)}


def _places_beside(here: Here, observed: Observed) -> set[int]:
    """The places of which other rows of the same length are asked in the same line."""
    line, own = nodes(statement_of(here.above)), observed.shape(here.node.value)
    rows = [one for one in line if isinstance(one, ast.Subscript) and one is not here.node]
    return {
        value_of(one.slice)
        for one in rows
        if whole_constant(one.slice) and own is not None and observed.shape(one.value) == own
    }


def is_joined(node: ast.Subscript) -> bool:
    """Whether it is ``np.r_[a, b]``, whose entries are no indices."""
    return getattr(node.value, "attr", "") in ("r_", "c_")


def _near(key: ast.expr) -> set[str]:
    """What is tried in place of an index all the same: itself, one more, one less."""
    return {ast.unparse(one) for one in (key, plus(key, 1), plus(key, -1))}


def _in_another_order(here: Here) -> Iterator[ProgramEdit]:
    """The indices of ``D[k][i, j]``, and of ``D[k][i][j]``, in another order."""
    chain = [here.node]
    while isinstance(chain[0].value, ast.Subscript):
        chain.insert(0, chain[0].value)
    if len(chain) < 2 or isinstance(here.parent, ast.Subscript):
        return
    keys = [key for one in chain for _holder, _field, key in keys_of(one)]
    plain = all(isinstance(key, ast.Name) or whole_constant(key) for key in keys)
    if not plain or len(keys) > _THREE:
        return
    for order in [*permutations(keys)][1:]:
        if [*map(ast.dump, order)] != [*map(ast.dump, keys)]:
            new, left = chain[0].value, [*order]
            for one in chain:
                count = len(keys_of(one))
                new, left = ast.Subscript(new, _key(left[:count]), one.ctx), left[count:]
            yield here.instead(new, "index", 1.12)


def _key(keys: Sequence[ast.expr]) -> ast.expr:
    return keys[0] if len(keys) == 1 else ast.Tuple([*keys], ast.Load())


def _of_key(here: Here, key: ast.Constant, scope: Scope) -> Iterator[ProgramEdit]:
    """Another key of a dictionary: ``arm["r"]`` for ``arm["l"]``."""
    own, cost = str(key.value), 1.05 if len(scope.keys) <= _FEW else 1.15
    for other, shape in scope.keys.items():
        if other != own and shape == scope.keys.get(own):
            less = _IDLE if other in scope.idle_keys else cost
            yield here.within(key, "value", other, "name", less)


def _with_keys(here: Here, key: ast.Constant, scope: Scope) -> Iterator[ProgramEdit]:
    """What another key has beside it: ``M["arm"] + M["hand"]`` for ``M["arm"]``."""
    for other in scope.keys if isinstance(here.node.ctx, ast.Load) else ():
        if other != key.value:
            term = ast.Subscript(here.node.value, ast.Constant(other), ast.Load())
            yield here.instead(ast.BinOp(here.node, ast.Add(), term), "missing term", 1.14)


def keys_of(node: ast.Subscript) -> list[tuple[Any, Any, ast.expr]]:
    """The indices of an entry, each with where it hangs."""
    if isinstance(node.slice, ast.Tuple):
        return [(node.slice.elts, k, key) for k, key in enumerate(node.slice.elts)]
    return [(node, "slice", node.slice)]


def _moved(here: Here, holder: Any, field: Any, key: ast.Slice) -> Iterator[ProgramEdit]:
    """All but the first for all but the last, and the other way round."""
    if key.upper is None and key.lower is not None and ast.unparse(key.lower) == "1":
        yield here.within(holder, field, ast.Slice(None, number(-1), None), "index", 1.08)
    elif (moved := without_the_first(key)) is not None:
        yield here.within(holder, field, moved, "index", 1.08)


def without_the_first(key: ast.Slice) -> ast.Slice | None:
    """All but the first for all but the last: ``1:`` for ``:-1``, or for ``:6`` of seven."""
    if key.lower is not None or key.upper is None:
        return None
    last = ast.unparse(key.upper)
    more = last == "-1" or (last.isdigit() and int(last) > 1)
    return ast.Slice(number(1), None, None) if more else None


def _beside(key: ast.Slice) -> ast.Slice | None:
    """As many rows above, or below the first ones: ``0:3`` for ``3:6``."""
    if key.lower is None or key.upper is None:
        return None
    if not whole_constant(key.lower) or not whole_constant(key.upper):
        return None
    first, behind = value_of(key.lower), value_of(key.upper)
    other = behind if first == 0 else 2 * first - behind
    return ast.Slice(number(other), number(other + behind - first), None) if other >= 0 else None


def of_keys(here: Here, node: ast.Subscript, cost: float) -> Iterator[ProgramEdit]:
    """Other rows, and indices in another order: of what is read, or where a value is put."""
    for holder, field, key in keys_of(node):
        if isinstance(key, ast.Slice) and key.step is None:
            if key.lower is None and key.upper is not None:
                yield here.within(holder, field, ast.Slice(key.upper, None, None), "rows", cost)
            elif key.upper is None and key.lower is not None:
                yield here.within(holder, field, ast.Slice(None, key.lower, None), "rows", cost)
            elif (moved := _beside(key)) is not None:
                yield here.within(holder, field, moved, "rows", cost)
            ends = (key.lower, key.upper)
            yield from _moved(here, holder, field, key)
            if ends[0] is None and ends[1] is not None and shifted(ends[1]):
                above = ast.Slice(plus(ends[1], -1), None, None)
                yield here.within(holder, field, above, "index", 1.15)
            elif ends[1] is None and isinstance(ends[0], ast.Name):
                below = ast.Slice(None, plus(ends[0], 1), None)
                yield here.within(holder, field, below, "index", 1.15)
    keys = node.slice.elts if isinstance(node.slice, ast.Tuple) else []
    if len(keys) == 2:
        swapped = ast.Tuple([keys[1], keys[0]], ast.Load())
        yield here.within(node, "slice", swapped, "transposed", cost)
    if len(keys) == _THREE and len({ast.dump(key) for key in keys}) > 1:
        counted = all(isinstance(key, ast.Name) for key in keys)  # one index for another
        cost = _INDICES if counted else 1.12
        for order in [*permutations(range(_THREE))][1:]:
            other = ast.Tuple([keys[k] for k in order], ast.Load())
            if ast.dump(other) != ast.dump(node.slice):
                yield here.within(node, "slice", other, "index", cost)
