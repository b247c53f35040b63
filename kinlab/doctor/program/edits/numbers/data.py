"""The numbers of a program: those in its text, and those in the data that it uses."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from math import pi
from typing import Any, TypeGuard

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import names
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.own.plain import made_like
from kinlab.doctor.program.places import DATA, Here, ProgramEdit, places
from kinlab.doctor.program.trial import FieldChange, Trial, is_data

_RIGHT_ANGLES = (0.0, pi / 2, -pi / 2)
_TABLE = 100
"""Numbers of an array of which any may be wrong."""
_ROWS = 8
"""Rows of a table, and numbers of a row, of which any two may have been exchanged."""
_AXIS = 1.06
"""Cost of another direction for an axis: no row of lengths has but one of them."""
_TURNED = 1.03
"""Cost of a quarter turn the other way."""
_PAIR = 2
"""Numbers that are reversed where they are exchanged."""
_DIGITS = 10
"""Significant digits that somebody types at most."""
GRAVITY = re.compile(r"_*(?:g(?:_?(?:vec|0))?$|grav)", re.IGNORECASE)
"""What the acceleration of gravity is called."""
_OF_BEFORE, _BEFORE = re.compile(r"(?:_?prev|_?im1|_?minus1?)$", re.IGNORECASE), 1.04
"""How a row of what belongs to the frame before is called; cost of such a row one place on."""
_NAMES = 12
"""Names of numbers of which any two may have been exchanged."""


def is_gravity(node: Any, place: Sequence[Any]) -> bool:
    """Whether a number of the data is gravity's, by its name or that of the row it is in."""
    told = [one.removeprefix(".") for one in place if isinstance(one, str)]
    return bool(GRAVITY.match((told or [str(node)])[-1]))


def of_data(trial: Trial) -> Iterator[ProgramEdit]:
    """Every number of the data with another sign, doubled, halved, or taken for degrees."""
    for leaf in leaves(trial):
        if leaf.value:
            # a name for a negative number: lengths and masses are none
            negative = leaf.value < 0 and not leaf.place
            down = leaf.place and is_gravity(leaf.node, leaf.place)  # up or down
            yield leaf.edit(-leaf.value, "sign", 0.99 if negative or down else 1.05)
            yield leaf.edit(2 * leaf.value, "factor", 1.2)
            yield leaf.edit(leaf.value / 2, "factor", 1.2)
            yield leaf.edit(leaf.value * pi / 180, "degrees", 1.15)
        if leaf.value in _RIGHT_ANGLES or abs(leaf.value) in (pi, 2 * pi):
            for other in _RIGHT_ANGLES:
                if other != leaf.value:
                    yield leaf.edit(other, "number", 1.12)
    for leaf in _whole_entries(trial):
        yield leaf.edit(-leaf.value, "sign", 1.05)
    for name in trial.program.data:
        value = trial.space[name]
        for new, kind in _whole(value):
            cost = _TURNED if _is_quarter_turn(value) else 1.1
            yield ProgramEdit(DATA, (FieldChange(trial.space, name, new),), kind, cost, name)
        for key, row in value.items() if isinstance(value, dict) else ():
            for new, kind in _whole(row):
                change = FieldChange(value, key, new)
                yield ProgramEdit(DATA, (change,), kind, 1.1, name, (key,))
        yield from _exchanged(name, value, (), trial.space, name)
    yield from _kinds_of_joints(trial)
    for held in trial.bound:
        yield from _exchanged("self", held, ())
    for kept in trial.classes.values():
        yield from _exchanged(kept.__name__, kept, ())
    yield from _names_exchanged(trial)


def _is_quarter_turn(value: Any) -> bool:
    """Whether it turns vectors of the plane by a right angle."""
    square = isinstance(value, np.ndarray) and value.shape == (_PAIR, _PAIR)
    return square and np.array_equal(abs(value), [[0, 1], [1, 0]]) and not (value + value.T).any()


def _kinds_of_joints(trial: Trial) -> Iterator[ProgramEdit]:
    """Names for the kinds of the joints: ``"RRPR"``, ``["R", "R", "P", "R"]``."""
    used = {name for tree in trial.trees for name in names(tree)}
    for name in sorted(used & trial.space.keys()):
        value = trial.space[name]
        listed = isinstance(value, list | tuple) and {type(x) for x in value} == {str}
        if not listed and not isinstance(value, str):
            continue
        word = "".join(one[:1] for one in value)
        whole = {one[:1]: one for one in value}
        for new, kind, cost in other_words(word):
            other: Any = type(value)(whole[x] for x in new) if listed else new
            change = FieldChange(trial.space, name, other)
            told = (repr(value), repr(other))
            yield ProgramEdit(DATA, (change,), kind, cost, name, exchanged=told)


def other_words(word: str) -> Iterator[tuple[str, str, float]]:
    """A word of two letters with two of its letters for one another, or one for the other."""
    if not 1 < len(word) <= _ROWS or len({*word}) != _PAIR or not word.isalpha():
        return
    for i, j in combinations(range(len(word)), 2):
        if word[i] != word[j]:
            letters = [*word]
            letters[i], letters[j] = letters[j], letters[i]
            yield "".join(letters), "entries swapped", 1.04
    for i, letter in enumerate(word):
        (other,) = {*word} - {letter}
        yield word[:i] + other + word[i + 1 :], "condition", 1.08


def _whole_entries(trial: Trial) -> Iterator[NumberPlace]:
    """Entries of arrays of whole numbers, such as axes: none of an arm's numbers."""
    for name in trial.program.data:
        value = trial.space[name]
        listed = enumerate(value) if isinstance(value, list | tuple) else [(None, value)]
        for k, one in listed:
            if not isinstance(one, np.ndarray) or one.dtype.kind != "i" or one.size > _TABLE:
                continue
            for index in np.ndindex(one.shape if one.flags.writeable else (0,)):
                if one[index]:
                    place = index if k is None else (k, *index)
                    yield NumberPlace(int(one[index]), DATA, one, index, name, place)


def _names_exchanged(trial: Trial) -> Iterator[ProgramEdit]:
    """Two names that were given each other's numbers: ``m2, l2 = 0.4, 1.5``."""
    plain = [n for n in trial.program.data if is_number(trial.space[n])]
    for one, other in combinations(plain[:_NAMES], 2):
        first, last = trial.space[one], trial.space[other]
        if first != last:
            changes = (FieldChange(trial.space, one, last), FieldChange(trial.space, other, first))
            told = (f"{one} = {shown(first)}, {other} = {shown(last)}",
                    f"{one} = {shown(last)}, {other} = {shown(first)}")  # fmt: skip
            yield ProgramEdit(DATA, changes, "entries swapped", 1.12, one, exchanged=told)


def _exchanged(
    name: str, value: Any, place: tuple[Any, ...], holder: Any = None, field: Any = None
) -> Iterator[ProgramEdit]:
    """Two numbers of a row, two rows, or two columns of a table for one another."""
    for key, one in _members(value):
        inner = key if isinstance(value, dict | list) else key[1:]
        yield from _exchanged(name, one, (*place, key), value, inner)
    if type(value) is tuple and holder is not None:
        yield from _of_tuple(name, value, place, holder, field)
    if isinstance(value, dict) or not is_data(value) or not 1 < len(value) <= _ROWS:
        return
    if isinstance(value, np.ndarray) and value.ndim > 1 and value.shape[0] == value.shape[1]:
        yield from _of_diagonal(name, value, place)
    if all(_is_plain(one) for one in value):
        for i, j in combinations(range(len(value)), 2):
            if value[i] != value[j]:
                both = (FieldChange(value, i, value[j]), FieldChange(value, j, value[i]))
                told = (_row(value), _row(_swapped(value, i, j)))
                edit = _swap(both, "entries swapped", name, place, told)
                yield replace(edit, cost=_AXIS) if np.count_nonzero(value) == 1 else edit
        if len(value) > _PAIR:
            back = [*value][::-1]
            turned = tuple(FieldChange(value, k, x) for k, x in enumerate(back) if value[k] != x)
            if len(turned) > _PAIR:
                yield _swap(turned, "reversed", name, place, (_row(value), _row(back)))
            for moved in moved_on(value):
                turned = tuple(FieldChange(value, k, x) for k, x in enumerate(moved))
                edit = _swap(turned, "shifted", name, place, (_row(value), _row(moved)))
                yield replace(edit, cost=_BEFORE) if _OF_BEFORE.search(name) else edit
        return
    rows = [one for one in value if isinstance(one, list | tuple | np.ndarray)]
    flat = all(_is_plain(x) for one in rows for x in one)
    if len(rows) < len(value) or not flat or len({len(one) for one in rows}) > 1:
        held = value if isinstance(value, list) else None  # of (m, (x, y, z)) the inner row
        for k, one in enumerate(value):
            if isinstance(one, list | tuple | np.ndarray):
                yield from _exchanged(name, one, (*place, k), held, k)
        return
    count = range(len(rows[0]))
    if len(count) <= _ROWS:
        for i, j in combinations(count, 2):
            off = [k for k, one in enumerate(rows) if one[i] != one[j]]
            for k in off:
                told = (_row(rows[k]), _row(_swapped(rows[k], i, j)))
                yield _swap(_of_row(value, k, i, j), "entries swapped", name, (*place, k), told)
            if len(off) > 1:
                changes = tuple(one for k in off for one in _of_row(value, k, i, j))
                yield _swap(changes, "columns swapped", name, place, (f"[:, {i}]", f"[:, {j}]"))
    for i, j in combinations(range(len(rows)), 2):
        for k in range(len(rows[0]) if len(count) <= _ROWS else 0):
            if rows[i][k] != rows[j][k]:
                one, other = (
                    _with_entry(rows[i], k, rows[j][k]),
                    _with_entry(rows[j], k, rows[i][k]),
                )
                changes = (*_row_put(value, i, one), *_row_put(value, j, other))
                told = (f"[{i}][{k}]", f"[{j}][{k}]")
                yield _swap(changes, "entries swapped", name, place, told)
        if not np.array_equal(rows[i], rows[j]):
            changes = (*_row_put(value, i, rows[j]), *_row_put(value, j, rows[i]))
            yield _swap(changes, "rows swapped", name, place, (f"[{i}]", f"[{j}]"))


def _of_diagonal(name: str, value: Array, place: tuple[Any, ...]) -> Iterator[ProgramEdit]:
    """Two numbers of a matrix's diagonal for one another: the moments about two axes."""
    diagonal = [value[k, k] for k in range(len(value))] if value.ndim == _PAIR else []
    for i, j in combinations(range(len(diagonal)), 2):
        if diagonal[i] != diagonal[j]:
            both = (
                FieldChange(value, (i, i), diagonal[j]),
                FieldChange(value, (j, j), diagonal[i]),
            )
            told = (_row(diagonal), _row(_swapped(diagonal, i, j)))
            edit = _swap(both, "entries swapped", name, place, told)
            yield replace(edit, cost=_AXIS) if {*np.abs(diagonal)} == {1.0} else edit


def _of_tuple(
    name: str, value: tuple[Any, ...], place: tuple[Any, ...], holder: Any, field: Any
) -> Iterator[ProgramEdit]:
    """The same of a tuple, which is made anew."""
    rows = [*value]
    for edit in _exchanged(name, rows, place):
        new = [*rows]
        for change in edit.changes:
            if change.holder is rows:
                new[change.field] = change.new
        if any(change.holder is rows for change in edit.changes):
            edit = replace(edit, changes=(FieldChange(holder, field, tuple(new)),))
        yield edit


def moved_on(row: Any) -> list[list[Any]]:
    """A row one place on, either way: the numbers of the frame before, or behind."""
    return [[*row[-on:], *row[:-on]] for on in (1, -1)]


def _members(value: Any) -> list[tuple[Any, Any]]:
    """What a dictionary or an object holds, by key or by name; of a list the objects in it."""
    if isinstance(value, dict):
        return [*value.items()]
    if isinstance(value, list):
        return [(k, x) for k, x in enumerate(value) if isinstance(x, dict) or is_object(x)]
    if not is_object(value):
        return []
    return [(f".{k}", x) for k, x in vars(value).items() if not k.startswith("__")]


def is_object(value: Any) -> bool:
    plain = isinstance(value, np.ndarray | list | tuple | str) or callable(value)
    return hasattr(value, "__dict__") and not (plain and not isinstance(value, type))


def _swap(
    changes: tuple[FieldChange, ...],
    kind: str,
    name: str,
    place: tuple[Any, ...],
    told: tuple[str, str],
) -> ProgramEdit:
    return ProgramEdit(DATA, changes, kind, 1.13, name, place, exchanged=told)


def _of_row(table: Any, k: int, i: int, j: int) -> tuple[FieldChange, ...]:
    return _row_put(table, k, _swapped(table[k], i, j))


def _row_put(table: Any, k: int, row: Any) -> tuple[FieldChange, ...]:
    """A row put into a table; of an array number by number: its rows are no values of their own."""
    if isinstance(table, np.ndarray):
        return tuple(FieldChange(table, (k, i), float(x)) for i, x in enumerate(row))
    return (FieldChange(table, k, row),)


def _with_entry(row: Any, k: int, value: Any) -> Any:
    new = [*row]
    new[k] = value
    return np.array(new) if isinstance(row, np.ndarray) else made_like(row, new)


def _swapped(row: Any, i: int, j: int) -> Any:
    order = [*range(len(row))]
    order[i], order[j] = j, i
    return row[order] if isinstance(row, np.ndarray) else made_like(row, [row[k] for k in order])


def _row(row: Any) -> str:
    return ", ".join(shown(x) if _is_plain(x) else "..." for x in row)


def shown(value: float) -> str:
    """A number with all the digits with which somebody typed it; of others the first ones."""
    typed = f"{value:.{_DIGITS}g}"
    return typed if float(typed) == value else f"{value:.6g}"


def _is_plain(value: Any) -> bool:
    return isinstance(value, np.number) or is_number(value)


def _whole(value: Any) -> Iterator[tuple[Any, str]]:
    """All of a table otherwise."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "fi" and value.size:
        if not (value > 0).all():  # lengths and masses
            yield -value, "sign"
        yield np.radians(value), "degrees"
        if value.ndim == _PAIR:
            yield value.T, "transposed"
            if np.array_equal(value, value.T) and value.any():
                yield 2 * np.diag(np.diagonal(value)) - value, "products' signs"
    elif isinstance(value, list | tuple) and all(map(is_number, value)):
        yield made_like(value, [one * pi / 180 for one in value]), "degrees"


@dataclass(frozen=True, eq=False)
class NumberPlace:
    """A number in the text of a program, or in its data.

    Attributes:
        value: what it is.
        part: of the program; :data:`DATA` for the data.
        holder, field: where it is kept.
        node: of the text; of data the name.
        place: the keys down to it.
        inner: of these, those within a tuple, which is made anew as a whole.
    """

    value: float
    part: int
    holder: Any
    field: Any
    node: Any
    place: tuple[Any, ...] = ()
    inner: tuple[int, ...] = ()

    def edit(self, value: float, kind: str = "number", cost: float = 1.15) -> ProgramEdit:
        """Another number there."""
        change = FieldChange(self.holder, self.field, value)
        if self.inner:
            change = replace(change, new=_rebuilt(change.now, self.inner, value))
        both = (float(self.value), float(value))
        return ProgramEdit(self.part, (change,), kind, cost, self.node, self.place, both)


def together(several: Sequence[tuple[NumberPlace, float]]) -> list[ProgramEdit]:
    """Other numbers in several places; in a tuple, which is made anew, all at once."""
    found: dict[Any, ProgramEdit] = {}
    for place, value in several:
        key = (id(place.holder), repr(place.field), place.inner == ())
        edit = place.edit(value)
        if place.inner and key in found:
            (change,) = found[key].changes
            new = _rebuilt(change.new, place.inner, value)
            edit = replace(found[key], changes=(replace(change, new=new),))
        found[key if place.inner else len(found)] = edit
    return [*found.values()]


def numbers(trial: Trial, observed: Observed) -> Iterator[NumberPlace]:
    """Numbers that are no index."""
    for part, tree in enumerate(trial.trees):
        for here in places(part, tree):
            node = here.node
            if not isinstance(node, ast.Constant) or observed.of(node) is None:
                continue
            counts = type(node.value) is int and (
                isinstance(here.parent, ast.BinOp) or measured(here.parent) or _is_of_a_link(here)
            )
            if is_number(node.value) and (counts or isinstance(node.value, float)):
                yield NumberPlace(node.value, part, node, "value", node)
    yield from leaves(trial)


_OF_A_LINK = re.compile(r"(?:m|l|lc|a|d|r|i|j|I|J|L|M|mass|len|length)_?[1-9]")
"""Names of the numbers of one link."""


def _is_of_a_link(here: Here) -> bool:
    """Whether a whole number is set to a name of a link's: ``m1, m2 = 3, 2``."""
    line = here.above[-1] if here.above else None
    row = here.parent if isinstance(here.parent, ast.Tuple) else None
    line = here.above[-2] if row is not None and len(here.above) > 1 else line
    if not isinstance(line, ast.Assign):
        return False
    (target, *_others) = line.targets
    if row is not None and isinstance(target, ast.Tuple) and len(target.elts) == len(row.elts):
        target = next(to for to, one in zip(target.elts, row.elts, strict=True) if one is here.node)
    return isinstance(target, ast.Name) and bool(_OF_A_LINK.fullmatch(target.id))


def is_number(value: Any) -> TypeGuard[float]:
    """Whether it is a number that may be another: no infinity, and not what is no number."""
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    return abs(value) <= sys.float_info.max  # a whole number may be greater; NaN is never less


def measured(holder: ast.AST) -> bool:
    """A list that holds numbers with a point: a 0 in it is one of them, and no index."""
    return isinstance(holder, ast.List | ast.Tuple) and any(
        isinstance(one, ast.Constant) and isinstance(one.value, float) for one in holder.elts
    )


def holds_more(trial: Trial) -> bool:
    """Whether the data hold an array that is too large for its numbers to be looked at."""
    held = [trial.space[name] for name in trial.program.data]
    held += [one for some in held if isinstance(some, list | tuple) for one in some]
    held += [one for some in held if isinstance(some, dict) for one in some.values()]
    return any(
        isinstance(one, np.ndarray) and one.dtype.kind == "f" and one.size > _TABLE for one in held
    )


def leaves(trial: Trial) -> Iterator[NumberPlace]:
    """The numbers of the data."""
    for name in trial.program.data:
        yield from leaves_of(trial, name)
    for held in trial.bound:
        yield from _below(held, "self", ())
    for owner in trial.classes.values():
        if owner.__name__ not in trial.program.data:
            yield from _below(owner, owner.__name__, ())


def leaves_of(trial: Trial, name: str) -> Iterator[NumberPlace]:
    """The numbers of one name of the module."""
    yield from _within(trial.space, name, trial.space[name], name, (), ())


def _within(
    holder: Any, key: Any, value: Any, name: str, place: tuple[Any, ...], inner: tuple[int, ...]
) -> Iterator[NumberPlace]:
    if is_number(value):
        yield NumberPlace(value, DATA, holder, key, name, place, inner)
    elif isinstance(value, tuple):
        for k, one in enumerate(value):
            if is_data(one):
                yield from _below(one, name, (*place, k))
            else:
                yield from _within(holder, key, one, name, (*place, k), (*inner, k))
    elif not inner:
        yield from _below(value, name, place)


def _below(value: Any, name: str, place: tuple[Any, ...]) -> Iterator[NumberPlace]:
    """The numbers in a list, a dictionary, an array, an object."""
    if isinstance(value, dict | list):
        for k, one in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _within(value, k, one, name, (*place, k), ())
    elif isinstance(value, np.ndarray):
        if value.dtype.kind == "f" and value.size <= _TABLE and value.flags.writeable:
            for index in np.ndindex(value.shape):
                if np.isfinite(value[index]):
                    entry = (*place, *index)
                    yield NumberPlace(float(value[index]), DATA, value, index, name, entry)
    elif hasattr(value, "__dict__"):
        for k, one in vars(value).items():
            if not k.startswith("__") and not callable(one):
                yield from _within(value, k, one, name, (*place, f".{k}"), ())


def _rebuilt(old: Any, path: tuple[int, ...], new: float) -> Any:
    """A tuple with another number in it."""
    if not path:
        return new
    parts = [*old]
    parts[path[0]] = _rebuilt(parts[path[0]], path[1:], new)
    return made_like(old, parts)
