"""The dimensions of a program's expressions: nobody adds a length to a moment.

A program is run a second time with all lengths, masses and times measured in other units, and its
own numbers changed alike. By how much a value changes tells its dimension; where a number of the
program may be several things, nothing is told.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import called, nodes, text_of
from kinlab.doctor.changes import table_of
from kinlab.doctor.program.edits.numbers.data import NumberPlace, leaves_of, numbers, together
from kinlab.doctor.program.edits.numbers.own_numbers import (
    among,
    may_be_gravity,
    sizes_of,
    sizes_of_legs,
)
from kinlab.doctor.program.edits.scope.functions import ARCS
from kinlab.doctor.program.edits.single.whole import SIZES
from kinlab.doctor.program.grounds.called import kinds_called
from kinlab.doctor.program.grounds.scaled import unused
from kinlab.doctor.program.observed import Observed, Seen
from kinlab.doctor.program.places import (
    ANGLES,
    DATA,
    Here,
    ProgramEdit,
    paired,
    places,
    with_other,
)
from kinlab.doctor.program.trial import FailedError, NoProgramError, Trial
from kinlab.fivebar import FiveBar
from kinlab.model.dh import DHTable
from kinlab.tolerances import TOLERANCES

_LENGTH, _MASS, _RATE = 1.37, 1.73, 1.19
"""By how much lengths, masses and rates grow; no product of few of them is another."""
_BY = {
    "length": _LENGTH,
    "mass": _MASS,
    "moment": _MASS * _LENGTH**2,
    "gravity": _LENGTH * _RATE**2,
    "none": 1.0,
}
_UNITS_OF_LEGS: Mapping[str, Any] = {
    "xy": _LENGTH,
    "v": _LENGTH * _RATE,
    "a": _LENGTH * _RATE**2,
    "mode": 1.0,
    "theta": 1.0,
    "s": 1.0,
}
"""By how much a five-bar's arguments grow in other units."""
_MEANT = {"length": "length", "centre": "length", "mass": "mass", "moment": "moment",
          "kept": "gravity"}  # fmt: skip
"""What a number is that is called so."""
_PARTS = 12
"""Denominator of fractions that have no dimension."""
_SAME = ("abs", "array", "asarray", "float", "sum", "negative", "copy", "ravel", "diag")
_STATEMENTS = ast.Assign | ast.AugAssign | ast.Return | ast.Expr
_FAR, LIKE = 1.2, 0.12
"""What it costs less to take a name for a far one of the same dimension."""
_DUE = 0.15
"""What it costs less where sums that use what is set become sound with it."""
_APART, _CHANGED = 0.12, 0.1
"""What an edit costs more that adds what is of different dimensions, or that changes one."""


class Dimensions:
    """The dimensions of the expressions of a wrong program, as far as they are known.

    Args:
        trial: the program.
        observed: its expressions.
        robot: the arm.
        names: of the arguments.
        states: at which it was observed.
        alike: whether the entries of an answer are of one dimension, of an arm that only turns.
    """

    def __init__(
        self,
        trial: Trial,
        observed: Observed,
        robot: Any,
        names: Sequence[str],
        states: Sequence[tuple[Any, ...]],
        alike: bool,
    ) -> None:
        self.trial = trial
        self._known: dict[int, float] = {}
        self._seen: dict[int, tuple[Seen, Seen]] = {}
        table = table_of(robot)
        turns = table is not None and all(link.joint == "revolute" for link in table.links)
        self._alike = alike and turns
        if isinstance(robot, FiveBar):
            by, kinds, angles = _UNITS_OF_LEGS, sizes_of_legs(robot), set[float]()
        elif table is not None:
            by, kinds, angles = _units(table), sizes_of(table), _angles(table)
        else:
            return
        larger = _larger(by, names, states)
        put = None if larger is None else _in_other_units(trial, observed, kinds, angles)
        if larger is None or put is None:
            return
        parts = {edit.part for edit in put}
        changes = [change for edit in put for change in edit.changes]
        try:
            with trial.changed(parts, changes):
                there = Observed(trial, larger)
        except (NoProgramError, FailedError):
            return
        for tree in trial.trees:
            for node in nodes(tree):
                one, other = observed.of(node), there.of(node)
                if one is not None and other is not None:
                    self._seen[id(node)] = one, other
                    ratio = _ratio(one, other)
                    if ratio is not None:
                        self._known[id(node)] = ratio

    def of(self, node: ast.AST) -> float | None:
        """The dimension of an expression of the program as the logarithm of a factor."""
        return self._known.get(id(node))

    def of_made(self, node: ast.expr) -> float | None:
        """The same of an expression made of those of the program."""
        try:
            return self._of_new(node)
        except _ApartError:
            return None

    def of_entries(self, node: ast.expr) -> Array | None:
        """The dimensions of a vector's or matrix's entries, nan where nothing is told.

        Of names and entries of the program, of what is transposed, and of products of these.
        """
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
            one, other = self.of_entries(node.left), self.of_entries(node.right)
            return None if one is None or other is None else _of_product(one, other)
        if isinstance(node, ast.Attribute) and node.attr == "T":
            inner = self.of_entries(node.value)
            return None if inner is None else inner.T
        own = self._seen.get(id(node))
        if own is not None:
            return _each_ratio(*own)
        return self._entries_of_text(text_of(node))

    def _entries_of_text(self, text: str) -> Array | None:
        if text not in self._by_text:
            every = [_each_ratio(*self._seen[one]) for one in self._nodes_of.get(text, ())]
            told = [one for one in every if one is not None]
            alike = len(told) == len(every) > 0 and len({one.shape for one in told}) == 1
            self._by_text[text] = _only(np.stack(told)) if alike else None
        return self._by_text[text]

    def of_text(self, text: str) -> float | None:
        """The same of a name or an entry, by what it is as text."""
        return self._texts.get(text)

    @cached_property
    def consistent(self) -> bool:
        """Whether nothing in the program adds what cannot be added."""
        return bool(self._known) and not self.apart

    @cached_property
    def apart(self) -> set[int]:
        """The nodes of statements that add what cannot be added, by identity."""
        found: set[int] = set()
        for tree in self.trial.trees:
            for statement in nodes(tree):
                inside = nodes(statement) if isinstance(statement, _STATEMENTS) else []
                if not all(map(self._sound, inside)):
                    found |= {id(node) for node in inside}
        return found

    def _sound(self, node: ast.AST) -> bool:
        if isinstance(node, ast.Call) and called(node) in ANGLES and node.args:
            return _alike(self.of(node.args[0]), 0.0)
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
            return _alike(self.of(node.left), self.of(node.right))
        if isinstance(node, ast.Return) and self._alike:
            inner = _listed(node.value)
            if isinstance(inner, ast.List | ast.Tuple):
                told = [x for x in map(self.of, inner.elts) if x is not None]
                return all(_alike(told[0], x) for x in told)
        return True

    def against(self, edit: ProgramEdit) -> float:
        """What an edit costs more for its dimensions."""
        if not self._known or edit.part == DATA or len(edit.changes) != 1:
            return 0.0
        (change,) = edit.changes
        if isinstance(getattr(change.holder, "ctx", None), ast.Store):
            return 0.0  # where a value is put, which has a dimension of its own
        old, new = change.now, change.new
        if not isinstance(old, ast.expr) or not isinstance(new, ast.expr):
            if not isinstance(change.holder, ast.expr) or isinstance(change.field, int):
                return 0.0
            old = change.holder
            if change.field == "value" and isinstance(new, int | float) and not new:
                return 0.0  # nothing is of any dimension
            new = with_other(old, change.field, None, new)
        try:
            found = self._of_new(new)
        except _ApartError:
            return _APART
        was = self.of(old)
        if found is None or was is None:
            return 0.0
        if not _alike(was, found):
            due = self._due.get(id(old))
            if due is not None and abs(found - was - due) <= TOLERANCES.tried_further:
                return -_DUE
            return _CHANGED if self.consistent else 0.0
        return -LIKE if edit.kind == "name" and edit.cost > _FAR and was else 0.0

    @cached_property
    def _due(self) -> dict[int, float]:
        """By how much the factors of what is set should change, for sums that use it to be sound.

        Of names beside what has another dimension than they.
        """
        asked: dict[str, float] = {}
        every = [node for tree in self.trial.trees for node in nodes(tree)]
        for node in every:
            if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub):
                for one, other in ((node.left, node.right), (node.right, node.left)):
                    own, beside = self.of(one), self.of(other)
                    if isinstance(one, ast.Name) and own is not None and beside is not None:
                        asked |= {} if _alike(own, beside) else {one.id: beside - own}
        lines = [node for node in every if isinstance(node, ast.Assign)]
        found: dict[int, float] = {}
        for line in lines if asked else ():
            for target, value in paired(line.targets[0], line.value):
                if isinstance(target, ast.Name) and target.id in asked:
                    found |= {id(one): asked[target.id] for one in _factors_of(value)}
        return found

    def _of_new(self, node: Any) -> float | None:
        """The dimension of an expression that is put in."""
        known = self._known.get(id(node))
        if known is not None:
            return known
        if isinstance(node, ast.Constant):
            return 0.0 if isinstance(node.value, int | float) else None
        if isinstance(node, ast.UnaryOp):
            return self._of_new(node.operand)
        if isinstance(node, ast.BinOp):
            return self._of_operation(node)
        if isinstance(node, ast.List | ast.Tuple):
            told = [self._of_new(x) for x in node.elts if getattr(x, "value", 1)]
            return told[0] if told and all(_alike(told[0], x) for x in told) else None
        if isinstance(node, ast.Call):
            return self._of_call(node)
        if isinstance(node, ast.Attribute) and node.attr == "T":
            return self._of_new(node.value)
        if isinstance(node, ast.Name | ast.Subscript | ast.Attribute):
            known = self._texts.get(text_of(node))
            return self._of_entry(node) if known is None else known
        return None

    def _of_operation(self, node: ast.BinOp) -> float | None:
        one, other = self._of_new(node.left), self._of_new(node.right)
        if isinstance(node.op, ast.Add | ast.Sub):
            if isinstance(node.right, ast.Constant):  # of what dimension is not told
                return one
            if not isinstance(node.left, ast.Constant) and not _alike(one, other):
                raise _ApartError
            return one if other is None else other
        if isinstance(node.op, ast.Pow):
            power = getattr(node.right, "value", None)
            return power * one if one is not None and isinstance(power, int | float) else None
        if one is None or other is None:
            return None
        if isinstance(node.op, ast.Mult | ast.MatMult):
            return one + other
        return one - other if isinstance(node.op, ast.Div) else None

    def _of_call(self, node: ast.Call) -> float | None:
        name = called(node)
        given = [self._of_new(one) for one in node.args]
        if name in ANGLES and given and not _alike(given[0], 0.0):
            raise _ApartError
        if name in (*ANGLES, *ARCS):
            return 0.0
        if name in ("cross", "dot", "outer") and len(given) == 2:
            return None if None in given else sum(x for x in given if x is not None)
        return given[0] if name in _SAME and len(given) == 1 else None

    @cached_property
    def _by_text(self) -> dict[str, Array | None]:
        """What was asked for already of the entries of names, by their text."""
        return {}

    @cached_property
    def _nodes_of(self) -> dict[str, list[int]]:
        """The nodes of names and entries that were seen, by their text."""
        found: dict[str, list[int]] = {}
        for tree in self.trial.trees:
            for node in nodes(tree):
                if isinstance(node, ast.Name | ast.Subscript) and id(node) in self._seen:
                    found.setdefault(text_of(node), []).append(id(node))
        return found

    def _of_entry(self, node: ast.expr) -> float | None:
        """The dimension of an entry of a row that the program uses others of."""
        key = node.slice if isinstance(node, ast.Subscript) else None
        k = getattr(key, "value", None)
        if not isinstance(node, ast.Subscript) or type(k) is not int:
            return None
        row = self.of_entries(node.value)
        if row is None or row.ndim != 1 or k >= len(row) or not np.isfinite(row[k]):
            return None
        return float(row[k])

    @cached_property
    def _texts(self) -> dict[str, float]:
        """The dimensions of names and entries by what they are as text."""
        found: dict[str, float] = {}
        twice: set[str] = set()
        for tree in self.trial.trees:
            for node in nodes(tree):
                known = self._known.get(id(node))
                if known is not None and isinstance(node, ast.Name | ast.Subscript | ast.Attribute):
                    text = text_of(node)
                    if not _alike(found.setdefault(text, known), known):
                        twice.add(text)
        return {text: known for text, known in found.items() if text not in twice}


class _ApartError(Exception):
    """Things of different dimensions are added."""


def _alike(one: float | None, other: float | None) -> bool:
    """Whether two dimensions may be one."""
    return one is None or other is None or abs(one - other) <= TOLERANCES.tried_further


def _listed(node: Any) -> Any:
    """What an array is made of; of anything else itself."""
    array = isinstance(node, ast.Call) and called(node) in ("array", "asarray") and node.args
    return node.args[0] if array else node


def _ratio(one: Seen, other: Seen) -> float | None:
    """By how much all the values of an expression grow, as a logarithm; None where they differ."""
    if not one.values or len(one.values) != len(other.values) or one.shape != other.shape:
        return None
    before, after = np.concatenate([np.ravel(x) for x in one.values]), other.values
    later: Array = np.concatenate([np.ravel(x) for x in after])
    if before.shape != later.shape:
        return None
    told = np.abs(before) > TOLERANCES.tried_further
    if not told.any() or (later[told] / before[told] <= 0.0).any():
        return None
    logs = np.log(later[told] / before[told])
    if float(np.ptp(logs)) > TOLERANCES.tried_further:
        return None
    return float(logs[0])


def _each_ratio(one: Seen, other: Seen) -> Array | None:
    """By how much each entry of what an expression was grows, as a logarithm.

    nan where it is zero all the time; None where an entry does not grow alike.
    """
    if not one.values or len(one.values) != len(other.values) or one.shape is None:
        return None
    if one.shape != other.shape:
        return None
    before, after = np.stack(one.values).astype(float), np.stack(other.values).astype(float)
    told = np.abs(before) > TOLERANCES.tried_further
    ratio = np.divide(after, before, out=np.full(before.shape, np.nan), where=told)
    if (ratio[told] <= 0.0).any():
        return None
    return _only(np.log(ratio))


def _of_product(one: Array, other: Array) -> Array | None:
    """The dimensions of a matrix product's entries; None where it adds what has no sum."""
    if one.ndim not in (1, 2) or other.ndim not in (1, 2) or one.shape[-1] != len(other):
        return None
    columns = other if other.ndim == 2 else other[:, None]
    rows = one if one.ndim == 2 else one[None]
    found = _only(np.moveaxis(rows[:, :, None] + columns[None], 1, 0))
    if found is None:
        return None
    return found.reshape((*one.shape[:-1], *other.shape[1:]))


def _only(every: Array) -> Array | None:
    """Of each column the one number that it has beside nan; None where one has several."""
    least, most = np.fmin.reduce(every), np.fmax.reduce(every)
    apart = (most - least) > TOLERANCES.tried_further
    return None if apart.any() else np.asarray(least)


def _factors_of(node: ast.expr) -> Iterator[ast.expr]:
    """What multiplies in a product, itself included."""
    yield node
    if isinstance(node, ast.UnaryOp):
        yield from _factors_of(node.operand)
    elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
        yield from _factors_of(node.left)
        yield from _factors_of(node.right) if isinstance(node.op, ast.Mult) else ()


def _units(table: DHTable) -> Mapping[str, Any]:
    """By how much an arm's arguments grow in other units."""
    slides = np.array([link.joint == "prismatic" for link in table.links])
    along = np.where(slides, _LENGTH, 1.0)
    force = _MASS * _LENGTH**2 * _RATE**2 / along
    return {
        "q": along,
        "v": along * _RATE,
        "a": along * _RATE**2,
        "tau": force,
        "x": _LENGTH,
        "y": _LENGTH,
        "z": _LENGTH,
        "phi": 1.0,
    }


def _angles(table: DHTable) -> set[float]:
    """The sizes of the angles of a table."""
    return {abs(x) for link in table.links for x in (link.alpha, link.theta)}


def _larger(
    by: Mapping[str, Any], names: Sequence[str], states: Sequence[tuple[Any, ...]]
) -> list[tuple[Any, ...]] | None:
    """The states in other units; None where an argument is none that has one."""
    if not all(name in by for name in names):
        return None
    return [
        tuple(value * by[name] for name, value in zip(names, state, strict=True))
        for state in states
    ]


def _in_other_units(
    trial: Trial, observed: Observed, kinds: Mapping[str, list[float]], angles: set[float]
) -> list[ProgramEdit] | None:
    """The program's numbers in other units; None where one of them may be several things."""
    put: list[tuple[NumberPlace, float]] = []
    named, axes, counting = _named(trial), _axes(trial), _counting(trial)
    every = [*numbers(trial, observed), *_unused(trial)]
    told = [
        "none"
        if id(one.node) in axes or _is_count(one, named, counting)
        else _kind(one, kinds, angles, named)
        for one in every
    ]
    typed, columns = _typed_columns(trial), dict[Any, set[str]]()
    for place, kind in zip(every, told, strict=True):
        if kind not in (None, "none"):
            columns.setdefault(_column(place, typed, not angles), set()).add(str(kind))
    for place, kind in zip(every, told, strict=True):
        alike = columns.get(_column(place, typed, not angles), set())
        if kind is None and len(alike) == 1:
            (kind,) = alike  # a column of a table is of one kind
        if kind is None:
            return None
        if kind != "none":
            put.append((place, float(place.value) * _BY[kind]))
    return together(put)


def _column(place: NumberPlace, typed: Mapping[int, Any], legs: bool) -> Any:
    """What tells the column of a table in which a number is; itself of any other.

    Of a five-bar's legs two numbers of one name are one.
    """
    if place.part != DATA:
        return typed.get(id(place.node), id(place.node))
    if legs and len(place.place) == 1 and place.place[0] in (0, 1):
        return place.node
    return (place.node, place.place[-1]) if len(place.place) > 1 else id(place)


def _typed_columns(trial: Trial) -> dict[int, Any]:
    """The columns of numbers in tables whose rows are typed: ``[Row(0.1, 0.3), Row(0.2, 0.4)]``."""
    found: dict[int, Any] = {}
    for line in (node for tree in trial.trees for node in nodes(tree)):
        rows = getattr(line, "value", None) if isinstance(line, ast.Assign) else None
        for row in rows.elts if isinstance(rows, ast.List | ast.Tuple) else ():
            given = row.args if isinstance(row, ast.Call) else getattr(row, "elts", ())
            for k, one in enumerate(given):
                found |= {id(x): (id(line), k) for x in _alone(one)}
    return found


def _unused(trial: Trial) -> Iterator[NumberPlace]:
    """Numbers of the module that nothing uses: an edit may."""
    for name in unused(trial):
        if type(trial.space[name]) in (int, float):
            yield from leaves_of(trial, name)


def _named(trial: Trial) -> dict[int, str]:
    """The names that numbers of the text are given, by the number's node."""
    found: dict[int, str] = {}
    for tree in trial.trees:
        for node in nodes(tree):
            if isinstance(node, ast.Assign):
                for target, value in paired(node.targets[0], node.value):
                    name = getattr(target, "id", getattr(target, "attr", None))
                    over = value.generators[0].iter if isinstance(value, ast.ListComp) else value
                    found |= {id(one): name for one in _alone(over) if name is not None}
            elif isinstance(node, ast.keyword) and node.arg is not None:  # dict(l1=0.3)
                found |= dict.fromkeys(map(id, _alone(node.value)), node.arg)
            elif isinstance(node, ast.Dict):
                for key, value in zip(node.keys, node.values, strict=True):
                    if isinstance(key, ast.Constant) and isinstance(key.value, str):
                        found |= dict.fromkeys(map(id, _alone(value)), key.value)
    return found


def _axes(trial: Trial) -> set[int]:
    """Each 1 of the text that is the only number of a row but zeros, as an axis has it."""
    found: set[int] = set()
    for node in (node for tree in trial.trees for node in nodes(tree)):
        if isinstance(node, ast.List | ast.Tuple) and len(node.elts) > 1:
            filled = [one for one in node.elts if getattr(one, "value", 1) != 0]
            if len(filled) == 1 and getattr(filled[0], "value", None) == 1:
                found.add(id(filled[0]))
    return found


def _counting(trial: Trial) -> set[str]:
    """Names that only count or tell apart: of how many links, of kinds of joints."""
    used: dict[str, set[bool]] = {}
    for here in (here for k, tree in enumerate(trial.trees) for here in places(k, tree)):
        if isinstance(here.node, ast.Name) and isinstance(here.node.ctx, ast.Load):
            used.setdefault(here.node.id, set()).add(_counts(here))
    return {name for name, ways in used.items() if ways == {True}}


def _is_count(place: NumberPlace, named: Mapping[int, str], counting: set[str]) -> bool:
    """Whether a whole number has a name that only counts, and is that of no size."""
    name = place.node if place.part == DATA else named.get(id(place.node))
    whole = type(place.value) is int and not place.place
    return whole and name in counting and _told_by(str(name)) is None


def _counts(here: Here) -> bool:
    """Whether a name counts where it is used: ``range(n - 1)``, ``[None]*n``, ``kind == SLIDE``."""
    parent = here.parent
    if isinstance(parent, ast.BinOp):
        other = parent.right if parent.left is here.node else parent.left
        step = isinstance(parent.op, ast.Add | ast.Sub) and type(getattr(other, "value", "")) is int
        return step or isinstance(other, ast.List)
    if isinstance(parent, ast.Call):
        return called(parent) in SIZES and called(parent) not in ANGLES
    return isinstance(parent, ast.Compare | ast.Subscript | ast.Tuple | ast.List)


def _alone(value: ast.expr) -> Iterator[ast.expr]:
    """Numbers that stand for themselves: alone, with a sign, in a list."""
    if isinstance(value, ast.UnaryOp):
        yield from _alone(value.operand)
    elif isinstance(value, ast.List | ast.Tuple):
        for one in value.elts:
            yield from _alone(one)
    elif isinstance(value, ast.Constant):
        yield value
    elif _listed(value) is not value:
        yield from _alone(_listed(value))


def _kind(
    place: NumberPlace, kinds: Mapping[str, list[float]], angles: set[float], named: dict[int, str]
) -> str | None:
    """What a number is; ``"none"`` of what has no dimension, None where that is not told."""
    size = abs(float(place.value))
    row = place.holder if isinstance(place.holder, np.ndarray | list) else []
    if isinstance(row, np.ndarray) and isinstance(place.field, tuple):
        row = row[place.field[:-1]]
    if size == 1.0 and all(map(np.isscalar, row)) and sum(map(bool, row)) == 1 < len(row):
        return "none"  # an axis
    may = [kind for kind, known in kinds.items() if among(size, known)]
    may += ["gravity"] if may_be_gravity(size) else []
    name = place.node if place.part == DATA else named.get(id(place.node))
    keys = [key for key in place.place if isinstance(key, str)]
    told = _told_by(keys[-1].lstrip(".") if keys else name or "")
    if not size:
        return "none"
    plain = among(size, sorted(angles)) or _is_simple(size)
    if isinstance(place.value, int) and name is None and not keys:
        return "none"  # in the middle of a formula
    if told in may:
        return told
    if not may:
        return "none" if plain else None
    return may[0] if len(may) == 1 and not plain else None


def _told_by(name: str) -> str | None:
    """What a number is by its name: ``l1``, ``mass``."""
    return next((_MEANT[kind] for kind in kinds_called(name) if kind in _MEANT), None)


def _is_simple(value: float) -> bool:
    """Whether a number is a simple fraction, of pi as well, or a whole number."""
    return any(
        math.isclose(x * _PARTS, round(x * _PARTS), rel_tol=TOLERANCES.same_number)
        for x in (value, value / math.pi)
    )
