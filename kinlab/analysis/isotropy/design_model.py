"""A DH table with some of its numbers open: its Jacobian and how it changes with them.

An open number is a joint that the arm does not drive: an open ``a`` slides along x, an open
``alpha`` turns about x. So the chain with open numbers is a longer chain, and the derivative of
J by an open number is that of a Jacobian by a joint.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from kinlab.arrays import Array, shown
from kinlab.errors import OptionError
from kinlab.model.dh import DHTable, with_links
from kinlab.model.rotations import about_axis

_AXES = {"x": 0, "y": 1, "z": 2}
_LENGTHS = ("a", "d")


@dataclass(frozen=True)
class Open:
    """One open number of a table.

    Attributes:
        name: as the caller wrote it: ``"a2"``, ``"alpha1"``, ``"d4"``, ``"tool.x"``.
        row: index of the link, or ``None`` for the tool.
        column: ``a``, ``alpha``, ``d``, ``theta``, or ``x``, ``y``, ``z`` of the tool.
        value: what the table holds, metres or radians.
    """

    name: str
    row: int | None
    column: str
    value: float

    @property
    def is_length(self) -> bool:
        """Whether it is in metres."""
        return self.row is None or self.column in _LENGTHS


@dataclass(frozen=True)
class _Element:
    """One elementary motion of the chain: a turn or a slide along a local axis."""

    turns: bool
    axis: int
    constant: float = 0.0
    variable: int | None = None  # column among (q, open numbers)
    sign: float = 1.0


@dataclass(frozen=True)
class OpenChain:
    """The table as a product of elementary motions, driven or open.

    Attributes:
        table: the table.
        open: its open numbers.
        elements: motions from base to tool. Variable i < n is joint i, n + j is open number j.
    """

    table: DHTable
    open: tuple[Open, ...]
    elements: tuple[_Element, ...]

    def jacobian(self, x: Array) -> Array:
        """Base-frame Jacobians by every variable, in chain order.

        Args:
            x: joints and open numbers, (N, n + k).

        Returns:
            (N, 6, n + k); see :attr:`order` for which column is which variable.
        """
        count = len(x)
        base = np.asarray(self.table.base)
        rotation = np.repeat(base[np.newaxis, :3, :3], count, axis=0)
        point = np.repeat(base[np.newaxis, :3, 3], count, axis=0)
        columns = []
        for element in self.elements:
            axis = rotation[:, :, element.axis]
            value = np.full(count, element.constant)
            if element.variable is not None:
                value = value + element.sign * x[:, element.variable]
                columns.append((element, element.sign * axis, point))
            if element.turns:
                rotation = rotation @ about_axis(element.axis, value)
            else:
                point = point + axis * value[:, np.newaxis]
        out = np.zeros((count, 6, len(columns)))
        for i, (element, axis, at) in enumerate(columns):
            if element.turns:
                out[:, :3, i] = np.cross(axis, point - at)
                out[:, 3:, i] = axis
            else:
                out[:, :3, i] = axis
        return out

    @property
    def order(self) -> list[int]:
        """Variable of each column of :meth:`jacobian`."""
        return [e.variable for e in self.elements if e.variable is not None]

    def with_values(self, values: Sequence[float]) -> DHTable:
        """The table with these numbers in place of the open ones."""
        links = list(self.table.links)
        tool = np.array(self.table.tool)
        for entry, value in zip(self.open, values, strict=True):
            if entry.row is None:
                tool[_AXES[entry.column], 3] = value
            else:
                changed: dict[str, Any] = {entry.column: float(value)}
                links[entry.row] = replace(links[entry.row], **changed)
        return with_links(replace(self.table, tool=tool), links)


def open_chain(table: DHTable, free: Sequence[str]) -> OpenChain:
    """Opens numbers of a table.

    Args:
        table: the table.
        free: names: a column and the number of its row (from 1), as ``"a2"``, ``"d1"``,
            ``"alpha3"``, or ``"tool.x"``, ``"tool.y"``, ``"tool.z"``.

    Raises:
        OptionError: no names, a name that is none, a row that does not exist, a name twice, or
            the number that a joint adds to its q anyway.
    """
    if isinstance(free, (str, bytes)) or not isinstance(free, Sequence) or not free:
        raise OptionError(
            f"free {shown(free)}; give a list of numbers to open, as ['a1', 'tool.x']"
        )
    opened = tuple(_read_open(table, name) for name in free)
    if len({(o.row, o.column) for o in opened}) < len(opened):
        raise OptionError(f"free {list(free)}: a number is named twice")
    place = {(o.row, o.column): table.n + i for i, o in enumerate(opened)}
    elements: list[_Element] = []
    for i, link in enumerate(table.links):

        def element(
            turns: bool, axis: int, column: str, row: int = i, link: Any = link
        ) -> _Element:
            driven = column == ("theta" if link.joint == "revolute" else "d")
            if driven:
                sign = -1.0 if link.flip else 1.0
                return _Element(turns, axis, getattr(link, column), row, sign)
            if (row, column) in place:
                return _Element(turns, axis, 0.0, place[row, column])
            return _Element(turns, axis, getattr(link, column))

        along_z = [element(True, 2, "theta"), element(False, 2, "d")]
        if str(table.convention) == "modified":
            elements += [element(True, 0, "alpha"), element(False, 0, "a"), *along_z]
        else:
            elements += [*along_z, element(False, 0, "a"), element(True, 0, "alpha")]
    tool = np.asarray(table.tool)
    for name, axis in _AXES.items():
        at = place.get((None, name))
        elements.append(_Element(False, axis, 0.0 if at is not None else tool[axis, 3], at))
    return OpenChain(table, opened, tuple(elements))


def _read_open(table: DHTable, name: Any) -> Open:
    valid = "give a column and its row, as 'a2', 'd1', 'alpha3', or 'tool.x', 'tool.y', 'tool.z'"
    where = f"table {table.name!r}: free {name!r}"
    if isinstance(name, str) and (match := re.fullmatch(r"tool\.([xyz])", name)):
        column = match[1]
        return Open(name, None, column, float(np.asarray(table.tool)[_AXES[column], 3]))
    match = re.fullmatch(r"(a|alpha|d|theta)([1-9]\d*)", name) if isinstance(name, str) else None
    if match is None:
        raise OptionError(f"{where} is no number of a table; {valid}")
    column, row = match[1], int(match[2]) - 1
    if row >= table.n:
        raise OptionError(f"{where}: the table has rows 1 to {table.n}; {valid}")
    link = table.links[row]
    if column == ("theta" if link.joint == "revolute" else "d"):
        raise OptionError(
            f"{where}: joint {row + 1} is {link.joint} and adds it to q, which is searched anyway"
        )
    return Open(name, row, column, float(getattr(link, column)))
