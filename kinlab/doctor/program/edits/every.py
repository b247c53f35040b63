"""What could stand in a place of a program instead.

Each kind of edit undoes one kind of slip: a sign, an index, another name, a transpose, a factor,
a term too many. An edit costs what it is far-fetched; nothing that never ran is edited.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import pi

import numpy as np

from kinlab.doctor.bytecode.syntax import called, copied, factors, names, nodes, text_of
from kinlab.doctor.program.edits import exchanges
from kinlab.doctor.program.edits.additions import as_a_term
from kinlab.doctor.program.edits.blocks import of_blocks
from kinlab.doctor.program.edits.chains import SUMS
from kinlab.doctor.program.edits.composites import of_composites
from kinlab.doctor.program.edits.counterparts import of_counterparts
from kinlab.doctor.program.edits.elsewhere import Elsewhere
from kinlab.doctor.program.edits.forgotten import (
    across,
    along_a_list,
    less_a_row,
    of_forgotten,
    of_kinds_of_joints,
    with_slices,
)
from kinlab.doctor.program.edits.frames import (
    along_its_own_axis,
    columns_of,
    of_columns,
    of_links,
    of_origins,
)
from kinlab.doctor.program.edits.guards import choices, masks, of_guards
from kinlab.doctor.program.edits.numbers.data import of_data
from kinlab.doctor.program.edits.numbers.kinds import (
    of_kinds_held,
    of_kinds_typed,
    words_of_kinds,
)
from kinlab.doctor.program.edits.scope.forms import statement_of, summands
from kinlab.doctor.program.edits.scope.part import Scope
from kinlab.doctor.program.edits.single.calls import begun_as_a_copy, of_call
from kinlab.doctor.program.edits.single.comparisons import (
    is_equality,
    is_switch,
    negated,
    of_comparison,
    of_comparisons,
    of_its_number,
)
from kinlab.doctor.program.edits.single.constants import of_constant, of_degrees, of_rods
from kinlab.doctor.program.edits.single.entries import is_joined, keys_of, of_keys, of_subscript
from kinlab.doctor.program.edits.single.names import of_attribute, of_name
from kinlab.doctor.program.edits.single.operators import is_diagonal, of_operator
from kinlab.doctor.program.edits.single.rows import of_letters, of_sequence
from kinlab.doctor.program.edits.single.whole import plus, shifted, value_of, whole_constant
from kinlab.doctor.program.edits.subscripts import of_subscripts
from kinlab.doctor.program.observed import Observed, Seen
from kinlab.doctor.program.places import Here, ProgramEdit, follow, number, paired, places
from kinlab.doctor.program.trial import Trial
from kinlab.tolerances import TOLERANCES

_TWIST = 6
"""Numbers of a twist, or of a wrench."""
_UNCHANGED = 0.3
"""What it costs more to give a name its own value: the line would do nothing."""
_ALONG = ("transpose", "moveaxis")
"""What is given numbers of axes."""
_WRITTEN = 1.15
"""Cost of another index of where a value is written: slips are made rather where it is read."""
_IN_EVERY_TURN = 1.08
"""Cost of a counter for a number by which the same entry is set in every turn."""
_COUNTED = 1.13
"""Cost of another counter where a value is written."""
_GATHERED = 1.0
"""What it is to set anew in a loop what was begun before it."""
_BOTH = 1.14
"""What an inverse's transpose for a transpose is far-fetched."""
_TWICE = 0.1
"""What a term costs more that makes another one double."""
_SUMMED = 0.06
"""What a sign or factor costs more in a sum of names, each of which has a line of its own."""
_ENTRIES = ast.Name | ast.Subscript | ast.Attribute
"""What a term more may be, of which one more is rather a factor 2."""
_TWO = 2
"""Names in a sum that are a formula of their own."""
_GIVEN = 0.04
"""What another argument costs more where one joint's follows on another's."""
_FILLED = 1.04
"""Cost of another array that is filled, too."""
_SUMMED_UP = 1.03
"""The same where a sum is worked out in a loop inside another: the inner one's counter."""
_ENTRIES_OF_A_ROW, _ONE_OF_ALL = 7, 1.08
"""Entries of a row to one of which something is added, and cost of one for all of them."""
_ALONG_ANOTHER = 1.09
"""Cost of a key at another place: ``A[:, :, 1]`` for ``A[1]``."""
_ALL_BEFORE = 1.14
"""Cost of all entries up to the one that a value is put into."""
_MISCALLED = 0.06
"""What it costs more that a cosine is called a sine."""
_ROWS = 6
"""Rows of as many joints of which any may share out what is added to one entry."""


def edits(trial: Trial, observed: Observed, scopes: Sequence[Scope]) -> list[ProgramEdit]:
    """Every single edit of a program, of whose parts these are the scopes; the likeliest first."""
    found: list[ProgramEdit] = []
    elsewhere = Elsewhere(trial, observed)
    own_parts = {one.name for one in trial.program.parts}
    compared = words_of_kinds(trial)
    for part, tree in enumerate(trial.trees):
        scope, by = scopes[part], (masks(tree), choices(tree))
        columns = columns_of(tree, observed)
        for here in places(part, tree):
            node = here.node
            scope.stand((*here.above, node))
            if isinstance(node, ast.expr):
                if observed.of(node) is not None:
                    every = (*_expression(here, scope, observed),)
                    every += (*elsewhere.edits(here, scope, observed),)
                    every += (*of_guards(here, scope, observed, *by),)
                    every += (*of_columns(here, columns, scope, observed),)
                    if _sums_names(here, scope):
                        every = (*(_dearer(x, _SUMMED) for x in every),)
                    if _is_given_in_order(here, own_parts):
                        every = (*(replace(x, cost=x.cost + _GIVEN) for x in every),)
                    own = _set_here(here) if isinstance(node, ast.Name) else []
                    if own:
                        every = (*(_unchanged(x, own) for x in every),)
                    if _is_as_called(here):
                        every = (*(_not_as_called(x) for x in every),)
                    if _says_where(here):
                        every = (*(replace(x, cost=max(x.cost, _WRITTEN)) for x in every),)
                    beside = _rotations_beside(here, observed)
                    added = any(x.kind == "missing term" for x in every)
                    terms = _terms_beside(here) if added else set()
                    product = _products_beside(here) if added else ([], [])
                    if product[1]:
                        every = (*(_doubling(x, *product) for x in every),)
                    found += [
                        _in_order(x)
                        for x in every
                        if not (beside and _undoes(x, beside)) and not _once_more(x, terms)
                    ]
                elif isinstance(node, ast.Constant) and isinstance(node.value, str):
                    found += of_letters(here)
                    found += of_kinds_typed(here, compared)
                    found += of_subscripts(here, observed, scope)
            elif isinstance(node, ast.stmt):
                found += _statement(here, scope, observed)
        found += of_blocks(part, tree, scope, observed)
        found += of_counterparts(part, tree)
    found += of_data(trial)
    found += of_kinds_held(trial, compared)
    # of equal ones the later line: what is set there is used more rarely
    return sorted(found, key=lambda edit: (edit.cost, edit.part, -_line(edit)))


def _set_here(here: Here) -> list[str]:
    """The names to which the statement gives an expression as it is: ``o`` of ``o = p``."""
    line = statement_of(here.above)
    if not isinstance(line, ast.Assign):
        return []
    pairs = (pair for target in line.targets for pair in paired(target, line.value))
    return [one.id for one, what in pairs if what is here.node and isinstance(one, ast.Name)]


def _is_as_called(here: Here) -> bool:
    """Whether a name that is called so is set to a sine, or a cosine: ``c2 = cos(q2)``."""
    function = called(here.node) if isinstance(here.node, ast.Call) else ""
    return function in ("sin", "cos") and any(
        one[0].lower() == function[0] and _WAVE.fullmatch(one) for one in _set_here(here)
    )


_WAVE = re.compile(r"(?:cos|sin|[cs])_?(?:\d{1,4}|[a-z]{1,2}\d?)", re.IGNORECASE)
"""What sines and cosines are called: c2, s23, ca, sin_t."""


def _not_as_called(edit: ProgramEdit) -> ProgramEdit:
    """An edit after which a cosine is called a sine, which is dearer."""
    return replace(edit, cost=edit.cost + _MISCALLED) if edit.kind == "sin/cos" else edit


def _terms_beside(here: Here) -> set[str]:
    """The terms of the sum in which an expression is one, itself among them."""
    whole: ast.AST = here.node
    for above in reversed(here.above):
        if not isinstance(above, ast.BinOp) or not isinstance(above.op, ast.Add | ast.Sub):
            break
        whole = above
    return {text_of(one) for one in summands(whole)} if isinstance(whole, ast.expr) else set()


def _products_beside(here: Here) -> tuple[list[str], list[list[str]]]:
    """The factors beside an expression in its product, and those of the other terms of the sum."""
    whole: ast.AST = here.node
    above = [*here.above]
    while above and isinstance(above[-1], ast.BinOp) and isinstance(above[-1].op, ast.Mult):
        whole = above.pop()
    sums = whole
    while above and isinstance(above[-1], ast.BinOp) and isinstance(above[-1].op, ast.Add):
        sums = above.pop()
    if whole is here.node or sums is whole:
        return [], []
    assert isinstance(whole, ast.expr) and isinstance(sums, ast.expr)
    own = [text_of(one) for one in factors(whole) if one is not here.node]
    others = [sorted(map(text_of, factors(x))) for x in summands(sums) if x is not whole]
    return own, others


def _doubling(edit: ProgramEdit, own: list[str], others: list[list[str]]) -> ProgramEdit:
    """The edit, dearer where a term that it adds to a factor is there: ``(a + b)*r + b*r``."""
    new = edit.changes[0].new
    if edit.kind != "missing term" or not isinstance(new, ast.BinOp):
        return edit
    put = [one for one in (new.left, new.right) if text_of(one) != text_of(edit.node)]
    twice = len(put) == 1 and sorted([*own, text_of(put[0])]) in others
    return replace(edit, cost=edit.cost + _TWICE) if twice else edit


def _once_more(edit: ProgramEdit, terms: set[str]) -> bool:
    """Whether an edit puts a term into a sum that is there: it has a factor 2, or is left out."""
    new = edit.changes[0].new
    if edit.kind != "missing term" or not isinstance(new, ast.BinOp):
        return False
    put = [one for one in (new.left, new.right) if one is not edit.node]
    return len(put) == 1 and isinstance(put[0], _ENTRIES) and text_of(put[0]) in terms


def _in_order(edit: ProgramEdit) -> ProgramEdit:
    """An edit with the first of two names in front: ``w1 + w2`` for ``w2``."""
    new = edit.changes[0].new
    if edit.kind != "missing term" or not isinstance(new, ast.BinOp):
        return edit
    turned = isinstance(new.op, ast.Add) and follow(new.left, new.right)
    if not turned or text_of(new.left) < text_of(new.right):
        return edit
    change = replace(edit.changes[0], new=ast.BinOp(new.right, new.op, new.left))
    return replace(edit, changes=(change, *edit.changes[1:]))


def _unchanged(edit: ProgramEdit, own: list[str]) -> ProgramEdit:
    """An edit, dearer where it gives a name its own value."""
    same = getattr(edit.changes[0].new, "id", None) in own
    return replace(edit, cost=edit.cost + _UNCHANGED) if same else edit


def _dearer(edit: ProgramEdit, more: float) -> ProgramEdit:
    return replace(edit, cost=edit.cost + more) if edit.kind in ("sign", "factor") else edit


def _sums_names(here: Here, scope: Scope) -> bool:
    """Whether it is of a sum of nothing but names, which are set before: ``m + c + g``.

    Two of them may be one formula where a name is set to them: ``q1 = beta - psi``.
    """
    statement = statement_of(here.above)
    value = getattr(statement, "value", None)
    terms = [*summands(value)] if isinstance(value, ast.BinOp) else []
    known = [isinstance(x, ast.Name) and x.id in scope.set_at for x in terms]
    target = statement.targets[0] if isinstance(statement, ast.Assign) else None
    own = target is not None and {*names(target)}.isdisjoint(map(text_of, terms))
    return len(known) > (_TWO if own else 1) and all(known)


def _is_given_in_order(here: Here, own: set[str]) -> bool:
    """Whether a function of the program's own is given one joint's after another's.

    As in ``gravity(q[0], q[1])``: what it makes of these is rather wrong than these.
    """
    call = here.parent
    if not isinstance(call, ast.Call) or called(call) not in own:
        return False
    beside = call.args[max(here.field - 1, 0) : here.field + 2] if here.holder is call.args else []
    return any(follow(one, here.node) for one in beside if one is not here.node)


def _says_where(here: Here) -> bool:
    """Whether an expression is in the index of where a value is written, or says along what."""
    for one, below in zip(here.above, (*here.above[1:], here.node), strict=True):
        along = isinstance(one, ast.Call) and called(one) in _ALONG and isinstance(below, ast.Tuple)
        if along or (isinstance(one, ast.keyword) and one.arg == "axis"):
            return True
    targets = (one for one in here.above if isinstance(one, ast.Subscript))
    return any(isinstance(one.ctx, ast.Store) for one in targets)


def _rotations_beside(here: Here, observed: Observed) -> set[str]:
    """The rotation matrices that one more would stand beside in a product."""
    node: ast.AST = here.node
    found: list[ast.AST] = [node]
    while isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
        found.append(node.right)
        node = node.left
    found.append(node)
    inner: ast.AST = here.node
    for above in reversed(here.above):
        if not isinstance(above, ast.BinOp) or not isinstance(above.op, ast.MatMult):
            break
        found.append(above.right if above.left is inner else above.left)
        inner = above
    return {text_of(one) for one in found if _is_rotation(observed.of(one))}


def _is_rotation(seen: Seen | None) -> bool:
    if seen is None or not seen.values or seen.shape not in ((2, 2), (3, 3)):
        return False
    one = seen.values[0]
    return bool(np.allclose(one @ one.T, np.eye(len(one)), rtol=0, atol=TOLERANCES.same_relation))


def _undoes(edit: ProgramEdit, beside: set[str]) -> bool:
    """Whether a rotation stands beside its own transpose: ``R.T @ (R @ v)`` is plainly ``v``."""
    new = edit.changes[0].new
    if edit.kind != "missing matrix" or not isinstance(new, ast.BinOp):
        return False
    put = [text_of(one) for one in (new.left, new.right)]
    return any(one + ".T" in beside or one.removesuffix(".T") in beside - {one} for one in put)


def _line(edit: ProgramEdit) -> int:
    return getattr(edit.node, "lineno", 0)


# -------- Expressions


def _counts_in(here: Here) -> bool:
    """Whether a quotient without remainder counts something: ``range(n//2)``, ``rows[n//2]``."""
    above = [x for x in here.above if isinstance(x, ast.Call | ast.Subscript)]
    return any(isinstance(x, ast.Subscript) or called(x) in ("range", "arange") for x in above)


def _is_an_index(here: Here) -> bool:
    """Whether it is an index, or one of several; what ``np.r_[a, b]`` joins is none."""
    if isinstance(here.parent, ast.Slice):
        return True
    if isinstance(here.parent, ast.Tuple):
        of = here.above[-2]
        return isinstance(of, ast.Subscript) and of.slice is here.parent and not is_joined(of)
    return isinstance(here.parent, ast.Subscript) and here.field == "slice"


def _expression(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    node = here.node
    shape = observed.shape(node)
    seen = observed.of(node)
    index = _is_an_index(here)
    whole = seen is not None and seen.whole and shape == ()
    whole = whole and not (isinstance(node, ast.Name) and node.id in scope.measures)
    if isinstance(node, ast.BinOp):
        yield from of_operator(here, observed, index or whole)
        if isinstance(node.op, ast.FloorDiv) and not _counts_in(here):
            yield here.within(node, "op", ast.Div(), "whole division", 0.97)
        yield from exchanges.of_owners(here) if shape else ()
        yield from exchanges.of_terms(here, observed)
        yield from exchanges.of_the_row_above(here, scope) if isinstance(node.op, SUMS) else ()
        yield from of_links(here, observed) if isinstance(node.op, ast.MatMult) else ()
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        if not is_diagonal(here):
            yield here.instead(node.operand, "sign", 0.97)
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd):
        yield here.instead(ast.UnaryOp(ast.USub(), node.operand), "sign", 1.0)
    elif isinstance(node, ast.Call):
        yield from of_call(here, scope, observed)
    elif isinstance(node, ast.Subscript):
        yield from of_subscript(here, scope, observed)
        yield from less_a_row(here, scope)
    elif isinstance(node, ast.Name):
        product = isinstance(here.parent, ast.BinOp) and isinstance(here.parent.op, ast.Mult)
        yield from of_name(here, scope, observed, index or (whole and not product))
    elif isinstance(node, ast.Attribute):
        if node.attr == "T":
            yield here.instead(node.value, "transposed", 1.02)
            if scope.has_numpy:
                linear = ast.Attribute(ast.Name("np", ast.Load()), "linalg", ast.Load())
                for name in ("inv", "pinv"):
                    call = ast.Call(ast.Attribute(linear, name, ast.Load()), [node.value], [])
                    yield here.instead(call, "inverse", 1.12)
                    turned = ast.Attribute(call, "T", ast.Load())
                    yield here.instead(turned, "inverse", _BOTH)
        else:
            yield from of_attribute(here, scope, observed)
    elif isinstance(node, ast.Constant):
        yield from of_constant(here, index, scope)
    elif isinstance(node, ast.List | ast.Tuple):
        yield from of_sequence(here, observed)
        yield from exchanges.of_row(here, scope, observed)
        yield from of_rods(here)
        yield from of_origins(here, scope)
    elif isinstance(node, ast.IfExp) and not is_switch(node.test):
        yield here.within(node, "test", negated(node.test), "condition", 1.3)
    elif isinstance(node, ast.Compare):
        yield from of_comparison(here)
    elif isinstance(node, ast.BoolOp):
        yield from of_comparisons(here)
    counts = whole and isinstance(node, ast.Name | ast.BinOp)
    if index or counts:
        inner = isinstance(here.parent, ast.BinOp) and shifted(here.parent)
        if not isinstance(node, ast.Constant | ast.Slice | ast.Tuple) and not inner:
            limits = isinstance(here.parent, ast.Compare) and not is_equality(here.parent)
            for step in (1, -1):
                yield here.instead(plus(node, step), "index", 1.25 if limits else 1.1)
        if not index and isinstance(here.parent, ast.Call):
            yield from of_degrees(here, scope, seen)
        return
    if isinstance(node, ast.Call | ast.Subscript):
        yield from with_slices(here, scope)
    if whole and isinstance(node, ast.Subscript) and isinstance(here.parent, ast.Call):
        yield from of_degrees(here, scope, seen)
    if shape is not None and not isinstance(here.parent, ast.Compare | ast.If):
        yield from as_a_term(here, scope, shape)
        yield from of_composites(here, scope, shape)
        yield from of_forgotten(here, scope, shape)
        yield from exchanges.of_repeated(here, scope, observed)


# -------- Statements


def _statement(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    node = here.node
    if isinstance(node, ast.AugAssign):
        if isinstance(node.op, ast.Add | ast.Sub):
            other = ast.Sub() if isinstance(node.op, ast.Add) else ast.Add()
            yield here.within(node, "op", other, "sign", 0.98)
    elif isinstance(node, ast.Assign) and len(node.targets) == 1:
        target = node.targets[0]
        if isinstance(target, ast.Name | ast.Subscript) and not isinstance(
            node.value, ast.Constant
        ):
            cost = 1.08 if _overwrites(here, target) else 1.15
            cost = _GATHERED if _is_begun(here, target) else cost
            yield here.instead(ast.AugAssign(target, ast.Add(), node.value), "sum", cost)
        if isinstance(target, ast.Tuple):
            if len(target.elts) == _TWIST:
                halves = [*target.elts[_TWIST // 2 :], *target.elts[: _TWIST // 2]]
                yield here.within(target, "elts", halves, "order", 1.04)
            for k in range(len(target.elts) - 1):
                swapped = [*target.elts]
                swapped[k], swapped[k + 1] = swapped[k + 1], swapped[k]
                yield here.within(target, "elts", swapped, "order", 1.07)
            for one in target.elts:
                if isinstance(one, ast.Subscript):
                    yield from _target(here, one, scope, observed)
        if isinstance(target, ast.Subscript):
            yield from _target(here, target, scope, observed)
            yield from across(here)
    if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Subscript):
        yield from along_its_own_axis(here, node.target, scope)
        yield from _target(here, node.target, scope, observed)
        yield from _for_all_joints(here, scope, observed)
    if isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name):
        yield from _added_to_one(here, scope, observed)
    if isinstance(node, ast.Assign | ast.Return):
        yield from along_a_list(here, scope)
    if isinstance(node, ast.Assign | ast.AugAssign | ast.Return | ast.Expr):
        yield from _counted(here, scope)
        yield from exchanges.of_statement(here, scope, observed)
    if isinstance(node, ast.If):
        if node.orelse and not is_switch(node.test):
            yield here.within(node, "test", negated(node.test), "condition", 1.2)
        yield from of_its_number(here, node.test)
    if isinstance(node, ast.Assign):
        yield from _in_degrees(here, scope, observed)
        yield from of_kinds_of_joints(here, scope)
        yield from begun_as_a_copy(here, observed)
    if isinstance(node, ast.Assign | ast.AugAssign) and isinstance(here.holder, list):
        yield here.instead(ast.Pass(), "extra statement", 1.22)


def _overwrites(here: Here, target: ast.expr) -> bool:
    """Whether a statement may set what something else has set before: a sum may be meant."""
    if isinstance(target, ast.Subscript):
        return any(isinstance(one, ast.For | ast.While) for one in here.above)
    assert isinstance(target, ast.Name)
    every = (one for one in nodes(here.above[0]) if isinstance(one, ast.Assign))
    return sum(target.id in names(to) for one in every for to in one.targets) > 1


def _is_begun(here: Here, target: ast.expr) -> bool:
    """Whether what a loop sets anew, and not from itself, is begun before it: to be added to."""
    loops = [one for one in here.above if isinstance(one, ast.For | ast.While)]
    if not loops or not isinstance(target, ast.Name) or target.id in names(here.node.value):
        return False
    inside = {id(one) for one in nodes(loops[-1])}
    before = (one for one in nodes(here.above[0]) if isinstance(one, ast.Assign))
    outside = [one for one in before if id(one) not in inside and one.lineno < here.node.lineno]
    return any(target.id in names(to) for one in outside for to in one.targets)


def _in_degrees(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """What is set was in degrees, though sines and cosines are taken of it."""
    node = here.node
    alone = isinstance(node.targets[0], ast.Name) and len(node.targets) == 1
    for name in dict.fromkeys(name for one in node.targets for name in names(one)):
        rows = alone and _many_degrees(observed.of(node.value))
        if not rows and (scope.shapes.get(name) != () or name not in scope.turned):
            continue
        if alone and scope.has_numpy:
            radians = ast.Attribute(ast.Name("np", ast.Load()), "radians", ast.Load())
            new = ast.Call(radians, [node.value], [])
            yield here.within(node, "value", new, "degrees", 1.1)
        elif isinstance(here.holder, list):
            load = ast.BinOp(ast.Name(name, ast.Load()), ast.Mult(), number(pi / 180))
            after = ast.Assign([ast.Name(name, ast.Store())], load)
            both = ast.If(ast.Constant(True), [node, after], [])
            yield here.instead(both, "degrees", 1.1)


def _many_degrees(seen: Seen | None) -> bool:
    """Whether a row of numbers is one of angles in degrees."""
    if seen is None or seen.shape is None or len(seen.shape) != 1 or not seen.values:
        return False
    return bool(np.max(np.abs(seen.values[0]), initial=0.0) > 2 * pi)


def _counted(here: Here, scope: Scope) -> Iterator[ProgramEdit]:
    """A counter one more or less wherever a line uses it: ``link(i, q[i])``."""
    value = here.node.value
    used = names(value) if value else []
    for counter in scope.counters:
        if used.count(counter) > 1:
            for step in (1, -1):
                moved = _Moved(counter, step).visit(copied(value))
                yield here.within(here.node, "value", moved, "index", 1.13)


class _Moved(ast.NodeTransformer):
    """A counter one more or less."""

    def __init__(self, counter: str, step: int) -> None:
        self.counter, self.step = counter, step

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        if shifted(node) and isinstance(node.left, ast.Name) and node.left.id == self.counter:
            return plus(node, self.step) if whole_constant(node.right) else node
        self.generic_visit(node)
        return node

    def visit_Name(self, node: ast.Name) -> ast.expr:
        return plus(node, self.step) if node.id == self.counter else node


def _for_all_joints(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """What is added to one entry, where each has a share of it: ``tau += n*Jw`` for ``tau[i]``."""
    node, shape = here.node, observed.shape(here.node.target.value)
    if not isinstance(node.target.slice, ast.Name) or shape is None or len(shape) != 1:
        return
    target, key = copied(node.target.value), node.target.slice
    target.ctx = ast.Store()
    for _text, row in [*scope.simple(shape)][:_ROWS]:
        if text_of(row) != text_of(target):
            new = ast.AugAssign(target, node.op, ast.BinOp(node.value, ast.Mult(), row))
            yield here.instead(new, "missing factor", 1.12)
    slice_ = ast.Slice(None, plus(key, 1), None)
    before = ast.Subscript(copied(node.target.value), slice_, ast.Store())
    yield here.instead(ast.AugAssign(before, node.op, node.value), "index", 1.12)


def _filled_beside(here: Here, target: ast.Subscript, observed: Observed) -> list[str]:
    """Other arrays of one form that the part fills: Jv beside Jw."""
    every = [one for one in nodes(here.above[0]) if isinstance(one, ast.Subscript)]
    filled = [x.value for x in every if isinstance(x.ctx, ast.Store)]
    own = observed.shape(target.value)
    found = [x.id for x in filled if isinstance(x, ast.Name) and observed.shape(x) == own]
    return [x for x in dict.fromkeys(found) if x != getattr(target.value, "id", x)]


def _innermost(here: Here) -> list[str]:
    """What the innermost loop around a statement counts with."""
    loops = [one for one in here.above if isinstance(one, ast.For)]
    return names(loops[-1].target) if loops else []


def _added_to_one(here: Here, scope: Scope, observed: Observed) -> Iterator[ProgramEdit]:
    """A number that is added to all of a row, to one entry of it: ``n[2] += m`` for ``n += m``."""
    name = here.node.target.id
    sizes = scope.shapes.get(name) or ()
    if len(sizes) != 1 or sizes[0] > _ENTRIES_OF_A_ROW or observed.shape(here.node.value) != ():
        return
    keys = [number(k) for k in range(sizes[0])]
    for key in (*keys, *(ast.Name(x, ast.Load()) for x in _innermost(here))):
        one = ast.Subscript(ast.Name(name, ast.Load()), key, ast.Store())
        yield here.within(here.node, "target", one, "index", _ONE_OF_ALL)


def _along_another(keys: Sequence[ast.expr], size: int) -> Iterator[ast.Tuple]:
    """One key at another place of several: ``A[:, :, 1]`` for ``A[1]``."""
    whole = [isinstance(key, ast.Slice) and ast.unparse(key) == ":" for key in keys]
    own = [key for key, every in zip(keys, whole, strict=True) if not every]
    for at in range(size) if len(own) == 1 else ():
        if at >= len(keys) or whole[at]:
            yield ast.Tuple([*(ast.Slice() for _k in range(at)), *own], ast.Load())


def _target(
    here: Here, target: ast.Subscript, scope: Scope, observed: Observed
) -> Iterator[ProgramEdit]:
    """Where the value is put."""
    yield from of_keys(here, target, 1.12)
    sizes = observed.shape(target.value) or ()
    summing = _innermost(here) if isinstance(here.node, ast.AugAssign) else []
    for keys in _along_another([key for *_at, key in keys_of(target)], len(sizes)):
        yield here.within(target, "slice", keys, "index", _ALONG_ANOTHER)
    for name in _filled_beside(here, target, observed):
        yield here.within(target, "value", ast.Name(name, ast.Load()), "name", _FILLED)
    for k, (holder, field, key) in enumerate(keys_of(target)):
        if whole_constant(key):
            for other in range(sizes[k] if k < len(sizes) else value_of(key) + 2):
                if other != value_of(key):
                    cost = 1.15 if abs(other - value_of(key)) == 1 else 1.17
                    yield here.within(holder, field, number(other), "index", cost)
            for other_name in sorted(scope.counting):  # not the same one in every turn
                other_key = ast.Name(other_name, ast.Load())
                yield here.within(holder, field, other_key, "index", _IN_EVERY_TURN)
            if len(sizes) > 1 and isinstance(getattr(here.node, "value", None), ast.Constant):
                yield here.within(holder, field, ast.Slice(), "index", 1.1)  # a whole row of ones
        elif not isinstance(key, ast.Slice):
            for step in (1, -1):
                yield here.within(holder, field, plus(key, step), "index", 1.15)
            for other_name in sorted(scope.counting - {*names(key)}):
                other_key = ast.Name(other_name, ast.Load())
                cost = _SUMMED_UP if other_name in summing else _COUNTED
                yield here.within(holder, field, other_key, "index", cost)
            if isinstance(key, ast.Name):  # the entries of all joints before it, too
                before = ast.Slice(None, plus(key, 1), None)
                yield here.within(holder, field, before, "index", _ALL_BEFORE)
        elif ast.unparse(key) == ":" and observed.shape(here.node.value) == ():
            for other_name in sorted(scope.counting - {*names(target)}):
                other_key = ast.Name(other_name, ast.Load())
                yield here.within(holder, field, other_key, "index", _ONE_OF_ALL)
