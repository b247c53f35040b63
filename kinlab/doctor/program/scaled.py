"""Another arm, on which what is one by the numbers alone is two things.

Where l1 is 0.5, a lost l1 and a lost half are one; on an arm with all lengths longer and all masses
heavier, with the program's own numbers changed alike, they are not.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.changes import table_of
from kinlab.doctor.program.edits.data import numbers
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit
from kinlab.doctor.program.trial import Trial
from kinlab.errors import KinlabError, already_said
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_LONGER, _HEAVIER = 1.25, 1.375
"""How much; no product of few of them is 1."""


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
