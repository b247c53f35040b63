"""Of repairs by name of one line that nothing tells apart, which has company in the program."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Protocol, TypeVar

from kinlab.doctor.bytecode.syntax import copied, factors, nodes
from kinlab.doctor.program.edits.chains import chain, joined, members
from kinlab.doctor.program.places import DATA, ProgramEdit, changed, row_of
from kinlab.doctor.program.trial import Trial


class _Repair(Protocol):
    @property
    def edits(self) -> tuple[ProgramEdit, ...]:
        """What it changes."""

    @property
    def rivals(self) -> tuple[object, ...]:
        """What explains as much."""


AnyRepair = TypeVar("AnyRepair", bound=_Repair)

_NEAR = 0.02
"""How much farther an edit may be whose product has more company."""
_NAMES = ("name", "index")
"""Kinds of edits that put another name, or one of another number."""


def in_company(
    found: Sequence[AnyRepair],
    likely: Callable[[ProgramEdit], float],
    same: float,
    trial: Trial,
    beside: Callable[[AnyRepair, AnyRepair], AnyRepair],
) -> list[AnyRepair]:
    """Repairs, the first of them with its like in the same line: ``l1*lc2``, or else ``lc1*l2``.

    That comes first whose product stands elsewhere in the program.

    Args:
        found: single edits that make the program right, the likeliest first.
        likely: how far-fetched an edit is.
        same: how far apart that may be of what nothing tells apart.
        trial: the program.
        beside: makes a repair with another one as its rival.
    """
    first = found[0].edits[-1] if found else None
    if first is None or not _is_plain(first, trial) or found[0].rivals:
        return [*found]
    alike = {_written(first, trial): found[0]}
    for repair in found[1:]:
        edit = repair.edits[-1]
        one = edit.part == first.part and _is_plain(edit, trial) and row_of(edit) == row_of(first)
        apart = edit.changes[0].holder is not first.changes[0].holder
        apart = apart or edit.changes[0].field != first.changes[0].field
        if one and apart and likely(edit) <= likely(first) + same + _NEAR:
            alike.setdefault(_written(edit, trial), repair)
    some = [*alike.values()]
    if len(some) < 2:
        return [*found]
    others = Counter(_products(trial.trees[first.part]))
    company = {id(one): _company(one.edits[-1], others, trial) for one in some}
    some.sort(key=lambda repair: company[id(repair)], reverse=True)
    some = [x for x in some if likely(x.edits[-1]) <= likely(some[0].edits[-1]) + same]
    if len(some) < 2:
        return [some[0], *(one for one in found if one is not some[0])]
    return [beside(some[0], some[1]), *(one for one in found if one is not some[0])]


def _is_plain(edit: ProgramEdit, trial: Trial) -> bool:
    """Whether another name is put in one place, and in no index."""
    new = edit.changes[0].new if len(edit.changes) == 1 else None
    if edit.part == DATA or edit.kind not in _NAMES or not isinstance(new, ast.Name):
        return False
    with changed(trial, (edit,)):
        every = nodes(trial.trees[edit.part])
        keys = (one.slice for one in every if isinstance(one, ast.Subscript))
        return not any(new is inner for key in keys for inner in nodes(key))


def _written(edit: ProgramEdit, trial: Trial) -> str:
    """The part with an edit in it, whatever the order of its factors and terms."""
    with changed(trial, (edit,)):
        return ast.unparse(_Sorted().visit(copied(trial.trees[edit.part])))


class _Sorted(ast.NodeTransformer):
    """The factors of each product, and the terms of each sum, in the order of the alphabet."""

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        if not isinstance(node.op, ast.Mult | ast.Add):
            return node
        first, others = chain(node, (type(node.op),))
        parts = sorted(members((first, others)), key=ast.unparse)
        return joined(parts[0], [(node.op, one) for one in parts[1:]])


def _company(edit: ProgramEdit, others: Counter[tuple[str, ...]], trial: Trial) -> tuple[int, int]:
    """How often the product that an edit makes stands in the program as it is.

    And how often the name that it puts there is multiplied by one of the others of that product.
    """
    with changed(trial, (edit,)):
        new = Counter(_products(trial.trees[edit.part])) - others
    own = ast.unparse(edit.changes[0].new)
    beside = {x for one in new if own in one for x in one} - {own}
    pairs = sum(count * len(beside & {*one}) for one, count in others.items() if own in one)
    return max((others[one] for one in new), default=0), pairs


def _products(tree: ast.AST) -> Iterator[tuple[str, ...]]:
    """The factors of each product, sorted, without its numbers."""
    every = [one for one in nodes(tree) if isinstance(one, ast.BinOp)]
    products = [one for one in every if isinstance(one.op, ast.Mult)]
    inner = {id(one.left) for one in products} | {id(one.right) for one in products}
    for one in products:
        if id(one) not in inner:
            parts = (x for x in factors(one) if not isinstance(x, ast.Constant))
            yield tuple(sorted(map(ast.unparse, parts)))
