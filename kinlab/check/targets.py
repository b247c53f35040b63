"""What the arguments of ``kinlab check`` mean: robots, files, notes, ids, a user's formulas."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from kinlab.check.catalogue import Row, catalogue, failed_row, plan, run_one
from kinlab.check.guest import FunctionLostError, Guest
from kinlab.check.quantities.serial import SERIAL
from kinlab.check.table_check import checks_of
from kinlab.check.unread import Unread
from kinlab.errors import FileError, KinlabError, NameUnknownError, OptionError, near
from kinlab.formulas.record import Formula
from kinlab.model.library import load, shipped

_ID = re.compile(r"[0-9]{3}\.[A-Za-z][A-Za-z0-9]*(\.[A-Za-z0-9]+)?")
"""What is written like the id of a note's formula."""


@dataclass(frozen=True)
class PlannedRow:
    """One row to come.

    Attributes:
        record: the formula.
        robot: the mechanism, or its name.
        name: what to call the mechanism.
        file: the user's file that the formula is from; empty for what ships.
    """

    record: Formula
    robot: Any
    name: str
    file: str = ""

    @property
    def ships(self) -> bool:
        """Whether formula and mechanism come with kinlab, so that names say all."""
        if self.file:
            return False
        # a robot of a shipped name may be another one, such as the same arm with another tool
        return isinstance(self.robot, str) or (
            self.name in shipped() and self.robot is SERIAL.load(self.name)
        )

    @property
    def label(self) -> str:
        """What a progress bar shows."""
        return f"{self.record.key} {self.name}"

    def run(self, samples: int, seed: int) -> Row:
        """Puts the formula beside the engine; one that ended its process has failed."""
        try:
            return run_one(self.record, self.robot, samples, seed)
        except FunctionLostError as problem:
            return failed_row(self.record, self.robot, samples, seed, str(problem))


def tasks(arguments: Iterable[str], tool: str | None = None) -> list[PlannedRow]:
    """The rows that the arguments ask for.

    Args:
        arguments: each a robot's name, a .toml, .csv or .urdf file, a .py file of marked
            functions (it is run, in a process of its own), a note's number ("001") or a
            formula's id ("002.C"). None: everything.
        tool: the tool of the robots among them, as for :func:`kinlab.load`.

    Returns:
        What is to run, in order.

    Raises:
        NameUnknownError: no such robot, note or id; the near names are listed.
        FileError: a file that cannot be read, or a .py file without a marked function.
        FormulaError: a .py file that raises, ends its process or does not come back.
        OptionError: a tool, and no robot whose it could be.
    """
    found, unread = read_tasks(arguments, tool)
    if unread:
        raise unread[0].problem
    return found


def read_tasks(
    arguments: Iterable[str], tool: str | None = None
) -> tuple[list[PlannedRow], list[Unread]]:
    """As :func:`tasks`, for those who go on without what cannot be read.

    Returns:
        What is to run, in order; and the arguments, or the functions of a file, that cannot.

    Raises:
        OptionError: a tool, and no robot at all.
    """
    wanted = list(arguments)
    if tool is not None and not wanted:
        raise OptionError(f"check: tool {tool!r} is named, but no robot with it")
    if not wanted:
        pairs = plan(catalogue())
        return [_one(record, name) for record, name in pairs] + [
            task for name in shipped() for task in _table(name)
        ], []
    found: list[PlannedRow] = []
    unread: list[Unread] = []
    for text in wanted:
        try:
            if text.endswith(".py"):
                _refuse_tool(text, tool)
                _read_functions(text, found, unread)
            else:
                found += _tasks_of(text, tool)
        except KinlabError as problem:
            unread.append(Unread(text, problem))
    return found, unread


def _read_functions(path: str, found: list[PlannedRow], unread: list[Unread]) -> None:
    for record in _user_formulas(path):
        try:
            found += [PlannedRow(record, name, name, path) for _, name in plan([record])]
        except KinlabError as problem:
            unread.append(Unread(f"{path}: {record.key}", problem))


def _tasks_of(text: str, tool: str | None) -> list[PlannedRow]:
    by_id = [f for f in catalogue() if text in (f.note, f.id, f.key)]
    if by_id:
        _refuse_tool(text, tool)
        return [_one(record, name) for record, name in plan(by_id)]
    on_robot = [_one(record, name) for record, name in plan(catalogue(), lambda n: n == text)]
    if on_robot and text not in shipped():
        _refuse_tool(text, tool)
        return on_robot  # a mechanism that only the catalogue knows
    try:
        if _ID.fullmatch(text):  # what follows the point is no ending of a file
            raise NameUnknownError(f"{text} is unknown")
        return on_robot + _table(text, tool)
    except NameUnknownError as problem:
        if "is unknown" not in str(problem):
            raise  # it is of the tool
        names = {name for _, name in plan(catalogue())} | {f.id for f in catalogue()}
        raise NameUnknownError(
            f"{text!r} is no robot, file, note or formula; {near(text, sorted(names))} "
            "(kinlab list shows the robots)"
        ) from None


def _refuse_tool(text: str, tool: str | None) -> None:
    """Only a robot has a tool that can be named.

    Raises:
        OptionError: something else was given with one.
    """
    if tool is not None:
        raise OptionError(f"check {text}: it is no robot; leave --tool {tool} out")


def _one(record: Formula, name: str) -> PlannedRow:
    return PlannedRow(record, name, name)


def _table(name: str, tool: str | None = None) -> list[PlannedRow]:
    robot = SERIAL.load(name) if tool is None else load(name, tool)
    return [PlannedRow(record, robot, name) for record in checks_of(robot)]


def _user_formulas(path: str) -> list[Formula]:
    found = Guest(path).formulas
    if not found:
        raise FileError(
            f"{path}: no function is marked; put "
            '@kl.hand_formula("gravity_torques", robot="planar2r") before it'
        )
    return found
