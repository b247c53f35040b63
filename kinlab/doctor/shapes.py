"""Matrices and their entries: of fewer rows than the engine's (a planar arm's 3 x 3 pose, a SCARA's
4 x 4 Jacobian), and one entry that is asked for of a whole that is given (M12 of ``M = ...``).
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.check.quantities.registry import split_name
from kinlab.check.quantities.special import square_rows
from kinlab.doctor.changes import Mechanism
from kinlab.doctor.text.claims import claimed_of
from kinlab.errors import ExpressionError, KinlabError, StructureError
from kinlab.fivebar import FiveBar
from kinlab.formulas import tree
from kinlab.formulas.files import FormulaFile, PartsOf
from kinlab.formulas.grids import Grid
from kinlab.formulas.signs.named import LastJoint
from kinlab.host.language import _
from kinlab.model.link import Convention
from kinlab.model.robot import Robot
from kinlab.symbolic.vocabulary import is_planar

_POSES, _JACOBIANS = ("T", "A", "H", "fk"), ("J", "jacobian")
_PLACE = re.compile(r"([A-Za-z_]+)(?:([1-9])([1-9])|\[(\d),(\d)\])")
_HOMOGENEOUS = (0, 1, 3)
"""Which rows and columns of a pose those of a planar one are."""
_RATES = ("vx", "vy", "vz", "wx", "wy", "wz")


def last_joint(robot: Mechanism) -> LastJoint | None:
    """An arm's last joint, by its table; None of a five-bar."""
    if not isinstance(robot, Robot):
        return None
    table = robot.table
    beyond = (
        table is not None
        and table.convention is Convention.MODIFIED
        and not np.array_equal(table.tool, np.eye(4))
    )
    return LastJoint(robot.n, not beyond)


def parts_of(robot: Mechanism) -> PartsOf:
    """The entries of rows, columns and blocks of a quantity: of ``fk[:3,3]``, ``jacobian[0]``.

    Args:
        robot: whose they are.
    """

    def of(entry: str) -> Grid | None:
        if "[" not in entry:
            return None
        try:
            plain, index = split_name(entry)
            found = find_quantity(plain)
            if found.read is not None:
                return None
            arm = found.domain.load(robot)
            shape = np.shape(found.engine(arm, *found.states(arm, 1, 0)))[1:]
            numbers = np.arange(int(np.prod(shape))).reshape(shape)[index]
        except (KinlabError, IndexError):
            return None  # told where it is judged
        if not 1 <= numbers.ndim <= 2 or not numbers.size:
            return None
        rows = numbers if numbers.ndim == 2 else numbers[:, None]
        return [
            [f"{plain}[{','.join(map(str, np.unravel_index(k, shape)))}]" for k in row]
            for row in rows
        ]

    return of


def in_full(file: FormulaFile, robot: Mechanism) -> tuple[FormulaFile, str]:
    """The formulas of such a matrix by their places in the engine's, and what is said of it.

    Args:
        file: the formulas.
        robot: whose they are.

    Returns:
        The same file, and ``""``, where no matrix is such.
    """
    if isinstance(robot, FiveBar) or robot.table is None:
        return file, ""
    for head in (*_POSES, *_JACOBIANS, _OF_THE_TOOL):
        places = {place: entry for entry in file.formulas if (place := _place(entry, head))}
        planar = head in _SIX_ROWS and not file.parts and is_planar(robot.table)
        if planar and _turns(file, places, robot.n):
            rates = ", ".join(_RATES[k] for k in _IN_THE_PLANE)
            told = _("its rows are read as {rows}").format(rows=rates)
            return _renamed(file, places, head, _IN_THE_PLANE, range(robot.n)), told
        every = {(i, j) for i in range(len(_RATES)) for j in range(robot.n)}
        if head == "J" and is_planar(robot.table) and {*places} == every:
            told = _("its rows are read as {rows}").format(rows=", ".join(_RATES))
            return _renamed(file, places, "jacobian", range(6), range(robot.n)), told
        size = max((k + 1 for place in places for k in place), default=0)
        if size < 3 or len(places) != size * size:
            continue
        if head not in _POSES:
            rows = _square(robot, size)
            if rows != [*range(size)]:
                told = _("its rows are read as {rows}").format(
                    rows=", ".join(_RATES[k] for k in rows)
                )
                return _renamed(file, places, head, rows, range(size)), told
        elif is_planar(robot.table) and _is_pose(file, places, size):
            told = _("it is read as the pose in the plane")
            return _renamed(file, places, head, _HOMOGENEOUS, _HOMOGENEOUS), told
    return file, ""


def _place(entry: str, head: str) -> tuple[int, int] | None:
    """Row and column of an entry of a matrix, from 0."""
    found = _PLACE.fullmatch(entry)
    if found is None or found[1] != head:
        return None
    if found[2]:
        return int(found[2]) - 1, int(found[3]) - 1
    return int(found[4]), int(found[5])


def _square(robot: Robot, size: int) -> list[int]:
    """The rows of J that a square matrix of an arm that is not planar has."""
    if size != robot.n or robot.table is None or is_planar(robot.table):
        return [*range(size)]
    try:
        return square_rows(robot)
    except StructureError:
        return [*range(size)]


_OF_THE_TOOL = "jacobian_tool"
_SIX_ROWS = ("jacobian", _OF_THE_TOOL)  # J is the planar one of a planar arm
_IN_THE_PLANE = [0, 1, 5]
"""The rows of J that a planar arm's have, where the third is no velocity along z."""


def _turns(file: FormulaFile, places: dict[tuple[int, int], str], joints: int) -> bool:
    """Whether three rows are given, and the third is one of numbers that are not all nothing."""
    if {*places} != {(i, j) for i in range(3) for j in range(joints)}:
        return False
    last = [file.formulas[places[2, j]] for j in range(joints)]
    return all(one.op == "num" for one in last) and any(one.value for one in last)


def _is_pose(file: FormulaFile, places: dict[tuple[int, int], str], size: int) -> bool:
    """Whether a 3 x 3 matrix has a place in its last column, and 0 0 1 in its last row."""
    if size != len(_HOMOGENEOUS):
        return False
    last = [file.formulas[places[2, j]] for j in range(size)]
    moves = any(tree.names(file.formulas[places[i, 2]]) for i in range(2))
    return moves and last == [tree.num(0), tree.num(0), tree.num(1)]


def _renamed(
    file: FormulaFile,
    places: dict[tuple[int, int], str],
    head: str,
    rows: Sequence[int],
    columns: Sequence[int],
) -> FormulaFile:
    """The file with each entry named by its row and column in the engine's matrix."""
    names = {}
    for (i, j), entry in places.items():
        row, column = rows[i], columns[j]
        indexed = "[" in entry or not entry.startswith(head)
        names[entry] = f"{head}[{row},{column}]" if indexed else f"{head}{row + 1}{column + 1}"
    return replace(
        file,
        formulas={names.get(entry, entry): node for entry, node in file.formulas.items()},
        texts={names.get(entry, entry): text for entry, text in file.texts.items()},
        as_typed={names.get(entry, entry): text for entry, text in file.as_typed.items()},
        matrices={},
    )


# -------- One entry of a whole

_OF_A_POINT = ("fk[:2,3]", "fk[:3,3]", "planar_pose")
"""The columns that a coordinate of the tool may stand in; without a name they say nothing."""


_NAMED = re.compile(r"=[^=]*(?:\[|\\begin|diag|array|Matrix)")
"""A matrix behind a sign of equality: a list without a name may be a formula and a remark."""


def wholes_of(entry: str, text: str, robot: Mechanism) -> Iterator[str]:
    """The quantities, whole or a column of one, of which an entry may be given.

    Args:
        entry: what is asked for: ``M12``, ``fk[0,3]``.
        text: what is given, as typed.
        robot: whose it is.
    """
    if isinstance(robot, FiveBar) or not _NAMED.search(text):
        return
    with suppress(ExpressionError):
        plain, bracket, place = claimed_of(entry, robot).partition("[")
        if bracket and ":" not in place:
            if plain == "fk" and place.endswith(",3]"):
                yield from _OF_A_POINT
            yield plain


def entry_of(file: FormulaFile, entry: str, robot: Mechanism) -> FormulaFile:
    """A file of a whole with one of its entries alone.

    Args:
        file: as it was read.
        entry: what was asked for.
        robot: whose formulas they are.

    Raises:
        ExpressionError: the file has no such entry.
    """
    wanted = claimed_of(entry, robot)
    shown = f"{entry}: " if entry not in file.formulas else ""
    of = next((one for one in file.formulas if claimed_of(one, robot) == wanted), None)
    if of is None or len(file.formulas) == 1:
        raise ExpressionError(f"{file.path}: {shown}" + _("it is no entry of what is given"))
    said = _("of the whole that is given {entry} alone is judged").format(entry=entry)
    remark = "; ".join(filter(None, (said, file.remarks.get(of))))
    alone = _alone(file, of, entry)
    others = tuple(_alone(one, of, entry) for one in file.others if of in one.formulas)
    return replace(alone, others=others, remarks={entry: remark})


def _alone(file: FormulaFile, of: str, entry: str) -> FormulaFile:
    def one(table: Mapping[str, Any]) -> dict[str, Any]:
        return {entry: table[of]} if of in table else {}

    return replace(
        file,
        formulas=one(file.formulas),
        texts=one(file.texts),
        as_typed=one(file.as_typed),
        unread=one(file.unread),
        parts={},
        matrices={},
    )
