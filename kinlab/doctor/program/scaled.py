"""Whether a repair is believed: it holds for another arm too, and hides no other slip.

Where l1 is 0.5, a lost l1 and a lost half are one; on an arm with all lengths longer and all masses
heavier, with the program's own numbers changed alike, they are not. A test that is changed until it
never holds says only that its branch is wrong; the robot's own g is not to be another; decimals of
a rounding and the step of a difference are no formula.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.changes import table_of
from kinlab.doctor.program.edits.data import numbers
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit, called
from kinlab.doctor.program.trial import FieldChange, NoProgramError, Trial, quietly
from kinlab.errors import KinlabError, already_said
from kinlab.model.robot import Robot
from kinlab.symbolic.vocabulary import vocabulary
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.doctor.program.repair import LineSearch, ProgramRepair

_LONGER, _HEAVIER = 1.25, 1.375
"""How much; no product of few of them is 1."""
_ROUNDINGS = ("round", "around", "round_")
_STEP = 1e-2
"""Share of a number below which another one is rather the step of a difference."""


def scaled(robot: Robot) -> Robot | None:
    """The arm with all its lengths and masses larger; None of one without a table."""
    table = table_of(robot)
    if table is None:
        return None
    links = [
        replace(
            link,
            a=_LONGER * link.a,
            d=_LONGER * link.d,
            mass=_HEAVIER * float(link.mass),
            com=_LONGER * np.asarray(link.com),
            inertia=_HEAVIER * _LONGER**2 * np.asarray(link.inertia),
        )
        for link in table.links
    ]
    tool, base = np.array(table.tool, dtype=float), np.array(table.base, dtype=float)
    tool[:3, 3] *= _LONGER
    base[:3, 3] *= _LONGER
    try:
        with already_said():
            return Robot.from_dh(replace(table, links=links, tool=tool, base=base))
    except (KinlabError, TypeError, ValueError):
        return None


def larger(robot: Robot, trial: Trial, observed: Observed) -> tuple[ProgramEdit, ...] | None:
    """The program's numbers changed alike; None where one of them may be several things."""
    table = table_of(robot)
    assert table is not None
    lengths = [x for k in table.links for x in (k.a, k.d, *np.ravel(k.com))]
    lengths += [*np.ravel(np.asarray(table.tool)[:3, 3]), *np.ravel(np.asarray(table.base)[:3, 3])]
    kinds = (
        (_LONGER, np.array(lengths, dtype=float)),
        (_HEAVIER, np.array([float(k.mass) for k in table.links])),
        (_HEAVIER * _LONGER**2, np.array([x for k in table.links for x in np.ravel(k.inertia)])),
    )
    plain = {id(node) for tree in trial.trees for node in _alone(tree)}
    edits: list[ProgramEdit] = []
    for place in numbers(trial, observed):
        if not place.value or (place.part != DATA and id(place.node) not in plain):
            continue
        factors = [factor for factor, known in kinds if _among(place.value, known)]
        if len(factors) > 1:
            return None
        edits += [place.edit(factor * place.value) for factor in factors]
    return tuple(edits)


def _among(value: float, known: Array) -> bool:
    close = TOLERANCES.same_relation * abs(value)
    return bool(np.any(np.abs(np.abs(known) - abs(value)) <= close))


def _alone(tree: ast.AST) -> Iterator[ast.AST]:
    """The numbers that names are set to as they are, or that stand in lists."""
    for node in nodes(tree):
        waiting: list[Any] = [node.value] if isinstance(node, ast.Assign) else []
        while waiting:
            one = waiting.pop()
            if isinstance(one, ast.Constant):
                yield one
            elif isinstance(one, ast.Tuple | ast.List):
                waiting += one.elts
            elif isinstance(one, ast.UnaryOp):
                waiting.append(one.operand)


def believed(repair: ProgramRepair, search: LineSearch) -> ProgramRepair | None:
    """A repair as it may be told; None where it hides the slip."""
    edits = []
    for edit in repair.edits:
        if _robots_own(edit, search) or _of_rounding(edit, search) or _a_step(edit, repair):
            return None
        edits.append(_branch(edit, repair, search) or edit)
    rivals = [believed(one, search) for one in repair.rivals]
    return replace(repair, edits=tuple(edits), rivals=tuple(one for one in rivals if one))


def _robots_own(edit: ProgramEdit, search: LineSearch) -> bool:
    """Whether the number that should be another is the robot's own, of the same name."""
    table = table_of(search.case.robot)
    if edit.part != DATA or edit.place or edit.numbers is None or table is None:
        return False
    own = vocabulary(table).values.get(edit.node)
    return own is not None and float(own) == edit.numbers[0]


def _of_rounding(edit: ProgramEdit, search: LineSearch) -> bool:
    """Whether the edit is in the decimals of ``np.round``."""
    if edit.part == DATA:
        return False
    for node in nodes(search.trial.trees[edit.part]):
        if isinstance(node, ast.Call) and called(node) in _ROUNDINGS:
            decimals = [*node.args[1:], *(word.value for word in node.keywords)]
            if any(_inside(edit.node, one) for one in decimals):
                return True
    return False


def _a_step(edit: ProgramEdit, repair: ProgramRepair) -> bool:
    """Whether a number is made small until only the noise of differences is left."""
    if edit.numbers is None or repair.error <= TOLERANCES.formula_agrees:
        return False
    old, new = map(abs, edit.numbers)
    return bool(0 < new < _STEP * old)


def _branch(edit: ProgramEdit, repair: ProgramRepair, search: LineSearch) -> ProgramEdit | None:
    """The whole test, where the program is right too if it never holds, or always."""
    if edit.part == DATA or edit.kind == "condition":
        return None
    for node in nodes(search.trial.trees[edit.part]):
        if isinstance(node, ast.If | ast.IfExp) and _inside(edit.node, node.test):
            for always in (False, True):
                change = FieldChange(node, "test", ast.Constant(always))
                other = ProgramEdit(edit.part, (change,), "condition", edit.cost, node.test)
                whole = tuple(other if one is edit else one for one in repair.edits)
                if _right(whole, search):
                    return other
    return None


def _inside(node: object, of: ast.AST) -> bool:
    return any(one is node for one in ast.walk(of))


def _right(edits: tuple[ProgramEdit, ...], search: LineSearch) -> bool:
    parts, changes = {one.part for one in edits}, [x for one in edits for x in one.changes]
    try:
        with quietly(), search.trial.changed(parts, changes):
            values = search.values(range(len(search.wanted)))
    except NoProgramError:
        return False
    if values is None:
        return False
    gaps = np.abs(values - search.wanted).reshape(len(values), -1)
    return bool(
        np.all(
            np.max(gaps, axis=1) <= max(search.allowed, TOLERANCES.formula_agrees) * search.sizes
        )
    )
