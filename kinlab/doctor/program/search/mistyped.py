"""Numbers of a program that are the arm's with a slip of the pen.

What is so near a number of the table's, and is in its place or none of the table's, is wrong
whatever else is.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from kinlab.doctor.changes import table_of
from kinlab.doctor.program.edits.numbers.as_the_arm import of_other_rows, of_table
from kinlab.doctor.program.edits.numbers.data import numbers
from kinlab.doctor.program.grounds.apart import home_of
from kinlab.doctor.program.grounds.scaled import is_own, own_numbers
from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import ProgramEdit
from kinlab.doctor.program.trial import Trial

_COST = 0.97
"""Cost of the arm's number for one that is in no column of its table."""
_SIZE = 1.5
"""Of two numbers that may be one, how many times as large the one is."""
_DIGITS = 3
"""Digits of a number that tell whose it is wherever it stands."""
_DECIMALS = 12
"""Decimals of a coordinate that are no rounding."""
_POINT = 1.5
"""Powers of ten by which a point is put wrong; 1 for 0.001 is another number."""


def mistyped(trial: Trial, observed: Observed, robot: Any) -> Iterator[ProgramEdit]:
    """The arm's numbers for such as are typed wrong, of columns first.

    Its numbers are those of its table, and where the frames are while all joints are at zero: the
    points of screw axes.
    """
    home = _home(robot)
    known = {abs(x) for x in (*own_numbers(robot).tolist(), *home)}  # -0.425 is typed 0.425, too
    for edit in of_table(trial, observed, robot):
        number = edit.numbers
        if edit.kind == "entries swapped" or (
            number and (_is_sure(robot, *number) or _is_near_none(robot, *number))
        ):
            yield edit
    yield from of_other_rows(trial, observed, robot)
    for place in numbers(trial, observed):
        value = place.value
        if isinstance(value, float) and _is_strange(robot, value) and abs(value) not in home:
            meant = {float(np.copysign(x, value)) for x in known if is_slip(value, x)}
            if len(meant) == 1 and max(map(len, map(_digits, (value, *meant)))) >= _DIGITS:
                yield place.edit(meant.pop(), "number", _COST)


def _is_sure(robot: Any, typed: float, meant: float) -> bool:
    """Whether a number of a column is wrong whatever else is: a slip, or a length for its half.

    One of the other sign is not, if another row has it so: whose row it is may be told wrongly.
    """
    if typed == -meant and is_own(robot, typed):
        return False
    return is_slip(typed, meant) or typed == 2 * meant


def _is_near_none(robot: Any, typed: float, meant: float) -> bool:
    """Whether a number of a column is none of the arm's, and of the size of the one that is."""
    near = typed != round(typed) and meant != 0 and 1 / _SIZE <= typed / meant <= _SIZE
    return near and _is_strange(robot, typed)


def _home(robot: Any) -> set[float]:
    """The sizes of the coordinates of an arm's frames while all its joints are at zero."""
    table = table_of(robot)
    if table is None:
        return set()
    return {*np.abs(np.round(home_of(table), _DECIMALS)).tolist()} - {0.0}


def is_slip(typed: float, meant: float) -> bool:
    """Whether a number is another with a slip: its sign, the point, digits exchanged, or one."""
    if not (typed and meant) or abs(np.log10(abs(typed / meant))) > _POINT:
        return False
    old, new = _digits(typed), _digits(meant)
    if abs(typed) == abs(meant) or sorted(old) == sorted(new):
        return True
    short, long = sorted((old, new), key=len)
    if len(short) == len(long) > 1:
        return sum(map(str.__ne__, short, long)) == 1
    return len(short) > 1 and any(long[:k] + long[k + 1 :] == short for k in range(len(long)))


def _digits(value: float) -> str:
    return f"{abs(value):.11e}".partition("e")[0].replace(".", "").rstrip("0")


def _is_strange(robot: Any, value: float) -> bool:
    return not (is_own(robot, value) or is_own(robot, -value))
