"""Another arm, on which what is one by the numbers alone is two things.

Where l1 is 0.5, a lost l1 and a lost half are one; on an arm with all lengths longer and all masses
heavier, with the program's own numbers changed alike, they are not.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.bytecode.syntax import nodes
from kinlab.doctor.changes import table_of
from kinlab.doctor.program.edits.data import NumberPlace, numbers, together
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit
from kinlab.doctor.program.trial import Trial
from kinlab.errors import KinlabError, already_said
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_LONGER, _HEAVIER = 1.25, 1.375
"""How much; no product of few of them is 1."""
_TWISTED = 0.8
"""How much the axes are turned towards each other: no sine or cosine of that is 0 or 1."""
_PARTS = 12
"""Denominator up to which a fraction, or one of pi, is nobody's length or mass."""


@dataclass(frozen=True, eq=False)
class OtherArm:
    """A larger arm, and the program's numbers changed alike.

    Attributes:
        robot: the arm.
        edits: what is put into the program.
        whole: whether nothing else of the program can be the first arm's own, so that a program
            that is right is right for this one, too.
    """

    robot: Robot
    edits: tuple[ProgramEdit, ...]
    whole: bool


def other_arm(robot: Robot, trial: Trial, observed: Observed) -> OtherArm | None:
    """An arm with longer and heavier links, and other twists where the program's numbers hold them.

    None where one of the program's numbers may be several things, and of a robot without a table.
    """
    table = table_of(robot)
    if table is None:
        return None
    places = [*numbers(trial, observed)]
    plain = {id(node) for tree in trial.trees for node in _alone(tree)}
    free = [place for place in places if place.part == DATA or id(place.node) in plain]
    twists = [link.alpha for link in table.links if link.alpha]
    held = np.array([float(place.value) for place in free])
    turned = bool(twists) and all(_among(x, held) for x in twists)
    for twisted in (_TWISTED, 1.0) if turned else (1.0,):
        kinds = _kinds(robot, table, twisted)
        factors = _alike(places, [_factors(kinds, place.value) for place in places])
        known = {id(place) for place in free}
        if any(len(some) > 1 for some, p in zip(factors, places, strict=True) if id(p) in known):
            continue
        changed: list[tuple[NumberPlace, float]] = []
        whole = True
        for place, some in zip(places, factors, strict=True):
            if id(place) in known and some:
                changed += [(place, factor * place.value) for factor in some - {1.0}]
            elif some != {1.0} and (some or _of_one_arm(float(place.value))):
                whole = False
        larger = _scaled(table, twisted) if changed else None
        if larger is not None:
            return OtherArm(larger, tuple(together(changed)), whole)
    return None


def _scaled(table: DHTable, twisted: float) -> Robot | None:
    """The arm with all its lengths and masses larger; None where that is none."""
    links = [
        replace(
            link,
            a=_LONGER * link.a,
            alpha=twisted * link.alpha,
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


Kinds = Sequence[tuple[float, Array]]
"""What numbers of the first arm are multiplied by, and which."""


def _kinds(robot: Robot, table: DHTable, twisted: float) -> Kinds:
    links = table.links
    lengths = [x for k in links for x in (k.a, k.d, *np.ravel(k.com))]
    lengths += [*np.ravel(np.asarray(table.tool)[:3, 3]), *np.ravel(np.asarray(table.base)[:3, 3])]
    kept = [x for k in links for x in (k.theta, k.armature)]
    kept += [*np.ravel(np.asarray(table.tool)[:3, :3]), *np.ravel(np.asarray(table.base)[:3, :3])]
    kinds = (
        (_LONGER, lengths),
        (_HEAVIER, [k.mass for k in links]),
        (_HEAVIER * _LONGER**2, [x for k in links for x in np.ravel(k.inertia)]),
        (twisted, [k.alpha for k in links]),
        (1.0, [*kept, np.linalg.norm(robot.model.gravity.linear)]),
    )
    return [(factor, np.array(known, dtype=float)) for factor, known in kinds]


def _factors(kinds: Kinds, value: float) -> set[float]:
    """What a number of the first arm is multiplied by: several where it may be several things."""
    return {factor for factor, known in kinds if value and _among(value, known)}


def _alike(places: Sequence[NumberPlace], factors: list[set[float]]) -> list[set[float]]:
    """What is common to the numbers of one list, or of one column of it, where anything is."""
    common: dict[Any, set[float]] = {}
    for place, some in zip(places, factors, strict=True):
        for key in _groups(place) if place.value else ():
            common[key] = common.get(key, some) & some
    return [
        next((common[key] for key in _groups(place) if common.get(key)), some)
        for place, some in zip(places, factors, strict=True)
    ]


def _groups(place: NumberPlace) -> list[Any]:
    return [place.node, (place.node, *place.place[-1:])] if place.part == DATA else []


def _of_one_arm(value: float) -> bool:
    """Whether a number that stays in a program may be made of the first arm's numbers."""
    parts = _PARTS * value, _PARTS * value / np.pi
    plain = any(abs(x - round(x)) <= TOLERANCES.same_relation * abs(x) for x in parts)
    return abs(value) > TOLERANCES.may_be_step and not plain


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
