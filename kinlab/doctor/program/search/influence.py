"""Which expressions may be at fault, by the entries of the answer that they have a part in.

A slip spoils what follows from it, and nothing else. Every value is made another, and it is looked
which entries change: where one that is wrong does not, the slip is elsewhere, or not the only one;
where a number has a part in one that is right, too, it is right itself.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

import numpy as np

from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import ProgramEdit, changed
from kinlab.doctor.program.search.asked import Asked
from kinlab.doctor.program.search.work import Work
from kinlab.doctor.program.trial import FieldChange, NoProgramError, quietly

_TIMES, _MORE = 1.37, 0.0731
"""By what a value is multiplied, and what is added then."""
_STATEMENTS = ast.Assign | ast.AugAssign | ast.Return
_ROWS = ast.List | ast.Tuple

Spot = tuple[object, str | int, ast.expr]
"""Where an expression hangs: in which node or list, in which field or at which place."""


def beside_the_fault(asked: Asked, observed: Observed, work: Work) -> set[int]:
    """The nodes, by identity, that have no part in all that is wrong, or one in what is right.

    No single edit of one of these makes the program right.

    Args:
        asked: the program, and what it should answer.
        observed: what its expressions were.
        work: what has been done.
    """
    own = asked.values(asked.first)
    if own is None or asked.case.quantity.read is not None:
        return set()
    right = asked.right(own)
    if not right.any() or right.all():
        return set()
    found: set[int] = set()
    for part, tree in enumerate(asked.trial.trees):
        for holder, field, value in _values(tree):
            if isinstance(value, ast.Constant):
                continue
            other = ast.BinOp(
                ast.BinOp(value, ast.Mult(), ast.Constant(_TIMES)), ast.Add(), ast.Constant(_MORE)
            )
            edit = ProgramEdit(part, (FieldChange(holder, field, other),), "", 0.0, value)
            work.done += work.of(edit)
            try:
                with quietly(), changed(asked.trial, (edit,)):
                    values = asked.values(asked.first)
            except NoProgramError:
                continue
            if values is None or values.shape != own.shape:
                continue
            seen = observed.of(value)
            once = seen is not None and seen.shape == () and seen.count == len(asked.watched)
            apart = np.any((values != own) & ~(np.isnan(values) & np.isnan(own)), axis=0).ravel()
            if not apart[~right].all() or (once and asked.apart(values, own)[right].any()):
                found |= {id(inner) for inner in nodes(value)}
    return found


def _values(tree: ast.AST) -> Iterator[Spot]:
    """The expressions that a part's statements set or return; of rows their entries."""
    for node in nodes(tree):
        if isinstance(node, _STATEMENTS) and node.value is not None:
            yield from _entries(node, "value", node.value)


def _entries(holder: object, field: str | int, value: ast.expr) -> Iterator[Spot]:
    row = value
    if isinstance(value, ast.Call) and value.args and isinstance(value.args[0], _ROWS):
        row = value.args[0]
    if not isinstance(row, _ROWS):
        yield holder, field, value
        return
    for k, one in enumerate(row.elts):
        yield from _entries(row.elts, k, one)
