"""A reading: one thing that people take differently, and what the engine says if one does.

A reading changes one of four things on the way to an answer: the robot (a table read in the
other convention), the arguments (degrees), the engine's question (another frame), or the answer
(transposed). Two readings in different places, or two robots' changes, can be combined.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal

from kinlab.arrays import Array
from kinlab.check.quantities.quantity import Quantity
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

Stage = Literal["robot", "arguments", "engine", "answer"]
Arguments = dict[str, Array]
Engine = Callable[[Robot, Arguments], Array]


@dataclass(frozen=True)
class Confusion:
    """One known confusion.

    Attributes:
        kind: its name in the table of readings: ``"degrees"``, ``"frame"``, ...
        sentence: what the formula does, in plain words, to follow "the formula ".
        stage: what it changes.
        apply: by stage: Robot -> Robot; arguments -> arguments; engine -> engine;
            answer -> answer (both with the leading axis of states).
        cost: how far-fetched it is.
        place: the link, joint or row it is about; ``""`` for the whole.
    """

    kind: str
    sentence: str
    stage: Stage
    apply: Callable[[Any], Any]
    cost: float = 1.0
    place: str = ""


@dataclass(frozen=True, eq=False)
class Case:
    """What readings need to know of a comparison.

    Attributes:
        robot: the robot.
        quantity: the whole quantity, without an index.
        arguments: the states, by name, (N, ...).
        hand: the hand formula's answers, (N, ...).
        index: which entries of the quantity the hand formula is.
        lines: looks for lines that are wrong, where the hand formula is a function that can be
            read: (case, right answers, allowed error) to what
            :func:`kinlab.doctor.program.words.lines` yields.
        slack: relative error up to which an explanation fits.
        again: the hand formula's answers at other states, (N, ...), where it can be asked.
    """

    robot: Robot
    quantity: Quantity
    arguments: Arguments
    hand: Array
    index: tuple[Any, ...] = ()
    again: Callable[[Arguments], Any] | None = None
    lines: Callable[..., Iterator[Any]] | None = None
    slack: float = TOLERANCES.formula_agrees

    def engine(self, robot: Robot, arguments: Arguments) -> Array:
        """The engine's whole answer."""
        answer: Array = self.quantity.engine(robot, *arguments.values())
        return answer

    def looked_through(self, wanted: Array, allowed: float) -> Iterator[Any]:
        """What ``lines`` yields; nothing where there is no function to look through."""
        return self.lines(self, wanted, allowed) if self.lines else iter(())

    def few(self, count: int) -> Case:
        """The first states only."""
        short = {name: stack[:count] for name, stack in self.arguments.items()}
        return replace(self, arguments=short, hand=self.hand[:count])

    def answer(self, readings: tuple[Confusion, ...]) -> Array:
        """What the engine says under the readings; entries outside the index are cut away."""
        robot, arguments, engine = self.robot, self.arguments, self.engine
        for reading in readings:
            if reading.stage == "robot":
                robot = reading.apply(robot)
            elif reading.stage == "arguments":
                arguments = reading.apply(arguments)
            elif reading.stage == "engine":
                engine = reading.apply(engine)
        values = engine(robot, arguments)
        for reading in readings:
            if reading.stage == "answer":
                values = reading.apply(values)
        return values[(slice(None), *self.index)]


def table_of(mechanism: Any) -> DHTable | None:
    """The DH table of an arm that has one; a linkage has none."""
    table: DHTable | None = getattr(mechanism, "table", None)
    return table
