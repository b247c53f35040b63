"""The kinds of joints in the rows of a table: ``("R", 0, pi/2)`` of what is ``("P", 0, pi/2)``."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.program.own.plain import made_like
from kinlab.doctor.program.places import DATA, Here, ProgramEdit
from kinlab.doctor.program.trial import FieldChange, Trial

_COST = 1.08
"""As for one kind for another in a word, ``"RRPR"``."""
_KINDS = 3
"""How many kinds a table may have."""
_TABLES = (ast.List, ast.Tuple, ast.Call, ast.keyword, ast.Dict)


def words_of_kinds(trial: Trial) -> frozenset[str]:
    """The words with which a program compares: ``kind == "P"``."""
    found = (
        one.value
        for tree in trial.trees
        for node in nodes(tree)
        if isinstance(node, ast.Compare)
        for side in (node.left, *node.comparators)
        for one in (side, *getattr(side, "elts", ()))
        if isinstance(one, ast.Constant) and isinstance(one.value, str)
    )
    return frozenset(word for word in found if word.isalpha())


def of_kinds_typed(here: Here, compared: frozenset[str]) -> Iterator[ProgramEdit]:
    """Another kind where one is typed in a row."""
    if isinstance(here.parent, _TABLES):
        for other in _others(here.node.value, compared, _beside(here)):
            yield here.within(here.node, "value", other, "condition", _COST)


def _beside(here: Here) -> set[str]:
    """The words that stand where this one does in the rows beside it."""
    rows = [row for row in here.above if isinstance(row, ast.List | ast.Tuple)]
    return {
        one.value
        for row in rows
        for one in nodes(row)
        if isinstance(one, ast.Constant) and isinstance(one.value, str)
    }


def of_kinds_held(trial: Trial, compared: frozenset[str]) -> Iterator[ProgramEdit]:
    """Another kind for one of those in a table of the data."""
    for name in trial.program.data if compared else ():
        rows = trial.space[name]
        if not isinstance(rows, list):
            continue
        for k, row in enumerate(rows):
            if isinstance(row, tuple | list):
                for at, word in enumerate(row):
                    alike = (x[at] for x in rows if isinstance(x, type(row)) and len(x) > at)
                    column = {one for one in alike if isinstance(one, str)}
                    for other in _others(word, compared, column):
                        parts = [*row[:at], other, *row[at + 1 :]]
                        yield _held(name, (k, at), rows, made_like(row, parts), (word, other))


def _held(
    name: str, place: tuple[int, int], rows: list[Any], new: Any, both: tuple[str, str]
) -> ProgramEdit:
    change, told = FieldChange(rows, place[0], new), (repr(both[0]), repr(both[1]))
    return ProgramEdit(DATA, (change,), "condition", _COST, name, place, exchanged=told)


def _others(word: Any, compared: frozenset[str], column: set[str]) -> list[str]:
    """The kinds that it may be instead."""
    if not isinstance(word, str) or not word.isalpha():
        return []
    column = {one for one in column if one.isalpha()}
    known = compared | column
    if not compared & column and not (column == {word} and len(compared) == 1):
        return []
    return sorted(known - {word}) if len(known) <= _KINDS else []
