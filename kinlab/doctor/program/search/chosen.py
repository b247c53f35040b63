"""Which edits of a program are tried, and what they cost."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache, partial
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import nodes, text_of
from kinlab.doctor.changes import table_of
from kinlab.doctor.glossary.textbook import Glossary
from kinlab.doctor.linkages.five_bar import numbers_of
from kinlab.doctor.program.edits.every import edits
from kinlab.doctor.program.edits.numbers.as_the_arm import as_it_is, of_table, with_other_signs
from kinlab.doctor.program.edits.numbers.data import is_gravity
from kinlab.doctor.program.edits.numbers.own_numbers import of_own_numbers
from kinlab.doctor.program.edits.scope.forms import summands
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.grounds.as_called import of_centres
from kinlab.doctor.program.grounds.called import kinds_called
from kinlab.doctor.program.grounds.dimensions import LIKE, Dimensions
from kinlab.doctor.program.grounds.lacking import lacking_terms
from kinlab.doctor.program.grounds.products import missing_products
from kinlab.doctor.program.grounds.scaled import is_free, is_own, own_rows
from kinlab.doctor.program.grounds.terms import missing_terms
from kinlab.doctor.program.grounds.unread import unread_terms
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit
from kinlab.doctor.program.search.asked import Asked
from kinlab.doctor.program.trial import Trial
from kinlab.fivebar import FiveBar
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

_MADE = 0.86
"""Cost of an exchange after which a row is the robot's."""
_AGAIN = 0.08
"""What a term costs more that a sum has already."""
_MISNAMED = 0.1
"""What it costs more that names that have the robot's numbers are given each other's."""
_OF_SUM = 0.02
"""What the other sign of a sum costs more, of which each term has its own."""
_TURNED = 0.05
"""What the sign of a length in a row costs more."""
_UPWARDS, _DOWNWARDS = 0.05, 0.01
"""What gravity's sign costs more where it falls, and less where it rises."""
_DECIMALS = 12
"""Decimals of a length."""
_OWN = 0.97
"""Cost of the other sign of a number that is the robot's then."""
_ROW = 3
"""Numbers of a row that tell whose it is."""


def chosen(
    asked: Asked,
    observed: Observed,
    known: Sequence[Glossary],
    dimensions: Dimensions,
    below: float,
    most: int,
) -> list[ProgramEdit]:
    """The likeliest edits, with what their dimensions add to what they cost.

    Args:
        asked: the program, and what it should answer.
        observed: what its expressions were.
        known: the textbook's things at the states at which it is watched.
        dimensions: of its expressions.
        below: what an edit costs at most.
        most: how many.
    """
    trial, robot = asked.trial, asked.case.robot
    scopes = [Scope(trial, observed, k) for k in range(len(trial.trees))]
    every = edits(trial, observed, scopes)
    every += of_table(trial, observed, robot)
    every += with_other_signs(trial, observed, cache(partial(_is_turned, robot)))
    every += of_centres(trial, observed, robot)
    every += of_own_numbers(trial, observed, robot, *map(asked.watched_of, ("q", "a")))
    every += missing_products(trial, observed, scopes, dimensions)
    every += missing_terms(trial, observed, scopes, dimensions)
    every += unread_terms(trial, observed, scopes, dimensions)
    every += lacking_terms(trial, observed, scopes, known)
    sure = as_it_is(trial, observed, robot)
    mirrors, rows = _mirroring(asked, observed), own_rows(robot)
    every = [
        edit
        for edit in every
        if edit.cost < below and (_moves_to_one_of(rows, edit) or not sure(edit))
        if not (mirrors(edit) or _moves_one_of(rows, edit) or _of_a_step(edit, trial, observed))
    ]
    every = [replace(x, cost=_MADE) if _makes_one_of(rows, x) else x for x in every]
    signs = ((x, _of_sign(x, observed, robot)) for x in every)
    every = [x if cost == x.cost else replace(x, cost=cost) for x, cost in signs]
    every = [replace(x, cost=x.cost + _AGAIN) if _adds_again(x) else x for x in every]
    named = _values_of_names(robot)
    lines = _with_names(trial, named)
    every = [replace(x, cost=x.cost + _MISNAMED) if _takes(x, named, lines) else x for x in every]
    every = sorted(every, key=_at_best)[:most]
    weigh = dimensions.against
    return [replace(x, cost=x.cost + more) if (more := weigh(x)) else x for x in every]


def _adds_again(edit: ProgramEdit) -> bool:
    """Whether an edit adds a term that stands in the sum already: that is a factor of it."""
    new = edit.changes[0].new
    if edit.kind != "missing term" or not isinstance(new, ast.BinOp):
        return False
    return text_of(new.right) in map(text_of, summands(new.left))


def _values_of_names(robot: Any) -> Mapping[str, float]:
    """What the robot's numbers are, by the names that they have in formulas."""
    if isinstance(robot, FiveBar):
        return numbers_of(robot)
    table = table_of(robot)
    return {} if table is None else vocabulary(table).values


def _with_names(trial: Trial, named: Mapping[str, float]) -> set[int]:
    """The two sides of statements in which names are given what the robot has by them."""
    found: set[int] = set()
    for node in (x for tree in trial.trees for x in nodes(tree) if isinstance(x, ast.Assign)):
        left, right = node.targets[0], node.value
        if isinstance(left, ast.Tuple) and isinstance(right, ast.Tuple):
            pairs = zip(left.elts, right.elts, strict=False)
            told = [(named.get(text_of(x)), getattr(y, "value", None)) for x, y in pairs]
            known = [own == value for own, value in told if own is not None and value is not None]
            found |= {id(left), id(right)} if len(known) > 1 and all(known) else set()
    return found


def _takes(edit: ProgramEdit, named: Mapping[str, float], lines: set[int]) -> bool:
    """Whether names that have the robot's numbers would be given each other's: l1, l2."""
    first = edit.changes[0]
    if edit.kind not in ("entries swapped", "order") or edit.place:
        return False
    if edit.part != DATA:
        return id(first.holder) in lines
    fields = [one.field for one in edit.changes if isinstance(one.holder, dict)]
    held = [(named.get(field), first.holder.get(field)) for field in fields]
    return bool(held) and all(own is not None and own == value for own, value in held)


def turns_a_length(edit: ProgramEdit, observed: Observed, robot: Any) -> bool:
    """Whether an entry of a row would get a minus that is a length or offset of the arm's."""
    if edit.kind != "sign" or edit.part == DATA or not isinstance(edit.changes[0].holder, list):
        return False
    table, seen = table_of(robot), observed.of(edit.node)
    product = isinstance(edit.node, ast.BinOp)  # d*sin(alpha), whose minus is forgotten
    if table is None or seen is None or seen.shape != () or product:
        return False
    lengths = {_size(x) for link in table.links for x in (link.a, link.d)}
    values = {_size(x) for x in seen.values} - {0.0}
    return bool(values) and values <= lengths


def _size(value: Any) -> float:
    """How large a number is, without its last digits: a cosine's nought is none."""
    return round(abs(float(value)), _DECIMALS)


def _of_a_step(edit: ProgramEdit, trial: Trial, observed: Observed) -> bool:
    """Whether the step of a difference is multiplied, which makes up for a factor elsewhere."""
    if edit.kind != "factor" or edit.part == DATA:
        return False
    inside = [getattr(node, "value", None) for node in nodes(edit.node)]
    seen = observed.of(edit.node)
    if isinstance(edit.node, ast.Name) and seen is not None and seen.values:
        every = nodes(trial.trees[edit.part])
        below = (x.right for x in every if isinstance(x, ast.BinOp) and isinstance(x.op, ast.Div))
        if not any(node is edit.node for one in below for node in nodes(one)):
            inside += [float(np.abs(value).max(initial=0.0)) for value in seen.values[:1]]
    return any(isinstance(x, float) and 0 < abs(x) <= TOLERANCES.is_step for x in inside)


def _mirroring(asked: Asked, observed: Observed) -> Callable[[ProgramEdit], bool]:
    """Whether a number that has a name, and is the robot's, would have the other sign."""
    named, robot = _named_numbers(asked.trial), asked.case.robot
    parts = asked.trial.program.parts

    def mirrors(edit: ProgramEdit) -> bool:
        if edit.kind != "sign" or edit.changes[0].field == "op":  # a sum for a difference
            return False
        if edit.part != DATA and (row := _row_that_is_set(edit, observed)) is not None:
            positive = not any(is_own(robot, -x) for x in row) or _is_distance(edit)
            return positive and all(is_own(robot, x) for x in row)
        if edit.part == DATA and edit.numbers and not edit.place:
            old: Any = edit.numbers[0]
        elif isinstance(edit.node, ast.Constant) and id(edit.changes[0].holder) in named:
            old = edit.node.value
        elif edit.part != DATA and (
            (parts[edit.part].sets and not _is_entry(edit)) or _is_named_share(edit, named)
        ):
            seen = observed.of(edit.node)  # worked out as the module is loaded, or of numbers
            old = float(seen.values[0]) if seen and seen.shape == () and seen.values else None
        else:
            return False
        if not isinstance(old, int | float) or not is_own(robot, old):
            return False
        return not is_own(robot, -old) or (old > 0 and _is_distance(edit))

    return mirrors


def _is_entry(edit: ProgramEdit) -> bool:
    """Whether it is of an entry of a row: of a point, or an axis, that has signs of its own."""
    holder = edit.changes[0].holder
    return isinstance(holder, list) and isinstance(edit.node, ast.Name | ast.Attribute)


def _row_that_is_set(edit: ProgramEdit, observed: Observed) -> list[float] | None:
    """The numbers of a row to which a name is set, which no state changes: ``lc = l/2``."""
    holder, seen = edit.changes[0].holder, observed.of(edit.node)
    if not isinstance(holder, ast.Assign) or holder.value is not edit.node or seen is None:
        return None
    if seen.shape is None or len(seen.shape) != 1 or not seen.values:
        return None
    first, *others = seen.values
    if not (first > 0).all() or any(not np.array_equal(first, one) for one in others):
        return None
    return [*map(float, first)]


def _is_named_share(edit: ProgramEdit, named: set[int]) -> bool:
    """Whether it is of a number over another, to which a name is set: ``lc2 = 0.4/2``."""
    share = isinstance(edit.node, ast.BinOp) and isinstance(edit.node.op, ast.Div)
    plain = all(isinstance(x, ast.Constant | ast.BinOp | ast.operator) for x in nodes(edit.node))
    return share and plain and id(edit.changes[0].holder) in named


def _is_distance(edit: ProgramEdit) -> bool:
    """Whether a name is set to the number that is a distance's: l2, lc2."""
    holder = edit.node if edit.part == DATA else edit.changes[0].holder
    name = holder if isinstance(holder, str) else getattr(holder, "targets", [None])[0]
    text = name if isinstance(name, str) else getattr(name, "id", "")
    return kinds_called(text) in (("length",), ("centre",))


def _at_best(edit: ProgramEdit) -> float:
    """What an edit costs if nothing speaks against it."""
    return edit.cost - LIKE * (edit.kind == "name")


def _moves_to_one_of(rows: list[Array], edit: ProgramEdit) -> bool:
    """Whether a row is the robot's a place further on, as it may be by a convention."""
    return edit.kind == "shifted" and _makes_one_of(rows, edit)


def _makes_one_of(rows: list[Array], edit: ProgramEdit) -> bool:
    """Whether numbers that are exchanged, or moved on, stand then as in a row of the robot's."""
    if edit.kind not in ("entries swapped", "shifted") or _moves_one_of(rows, edit):
        return False
    first, row = edit.changes[0], getattr(edit.node, "elts", None)
    if edit.part != DATA:
        values = [getattr(one, "value", None) for one in first.new] if row else []
    elif isinstance(first.holder, np.ndarray):
        table = first.holder.copy()
        for change in edit.changes:
            if change.holder is first.holder:
                table[change.field] = change.new
        values = table.ravel().tolist()
    elif isinstance(first.holder, list):
        values = [*first.holder]
        for change in edit.changes:
            if change.holder is first.holder and isinstance(change.field, int):
                values[change.field] = change.new
    else:
        values = [*first.new] if isinstance(first.new, tuple) else []
    return _is_one_of(rows, values)


def _of_sign(edit: ProgramEdit, observed: Observed, robot: Any) -> float:
    """What the other sign costs: of a length in a row more, of what is the robot's then less.

    Gravity falls: the other sign of it costs more where it does so as it is, and less where it
    does so then.
    """
    if edit.kind != "sign":
        return edit.cost
    cost = edit.cost + _TURNED * turns_a_length(edit, observed, robot)
    whole = isinstance(edit.node, ast.BinOp) and isinstance(edit.node.op, ast.Add | ast.Sub)
    cost += _OF_SUM * (whole and isinstance(edit.changes[0].new, ast.BinOp))
    if edit.numbers is None:
        return cost
    old, new = edit.numbers
    if edit.place and is_gravity(edit.node, edit.place):
        own = getattr(getattr(robot, "model", None), "gravity", None)
        down = () if own is None else own.linear[own.linear != 0.0]
        falls, will = (bool(np.isclose(down, x).any()) for x in (old, new))
        return cost + _UPWARDS * (falls and not will) - _DOWNWARDS * (will and not falls)
    if cost > _OWN and old == -new and is_own(robot, new) and not is_own(robot, old):
        return _OWN
    return cost


def _is_turned(robot: Any, value: float) -> bool:
    """Whether a number is not the robot's, and its opposite is."""
    return is_own(robot, -value) and not is_own(robot, value) and is_free(value)


def _moves_one_of(rows: list[Array], edit: ProgramEdit) -> bool:
    """Whether numbers that stand as the robot has them would be exchanged in their row."""
    row = edit.node
    if edit.kind not in ("entries swapped", "reversed", "shifted") or edit.of_the_arm:
        return False
    if edit.part == DATA:
        values = edit.changes[0].holder if isinstance(edit.changes[0].holder, list) else []
    else:
        values = [getattr(one, "value", None) for one in getattr(row, "elts", ())]
    return _is_one_of(rows, values)


def _is_one_of(rows: list[Array], values: list[Any]) -> bool:
    if len(values) < _ROW or not all(isinstance(x, int | float) for x in values):
        return False
    typed = np.array(values, dtype=float)
    return any(own.shape == typed.shape and np.allclose(own, typed) for own in rows)


def _named_numbers(trial: Trial) -> set[int]:
    """Where numbers hang that statements give names to."""
    found: set[int] = set()
    for tree in trial.trees:
        for node in nodes(tree):
            if isinstance(node, ast.Assign):
                found.add(id(node))
                if isinstance(node.value, ast.Tuple) and isinstance(node.targets[0], ast.Tuple):
                    found.add(id(node.value.elts))
    return found
