"""A reading: one thing that people take differently, and what the engine says if one does.

A reading changes one of four things on the way to an answer: the robot (a table read in the
other convention), the arguments (degrees), the engine's question (another frame), or the answer
(transposed). Two readings in different places, or two robots' changes, can be combined.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.check.quantities.quantity import Quantity
from kinlab.fivebar import FiveBar
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

Mechanism = Robot | FiveBar
"""What formulas are of."""

Stage = Literal["robot", "arguments", "engine", "answer"]
Arguments = dict[str, Array]
Engine = Callable[[Robot, Arguments], Array]

ANGLES = ("fivebar_angles", "fivebar_leg_angles", "planar_angle")
"""Quantities that are angles, of which a whole turn more is the same."""
ANY_ZERO = ("potential_energy", "lagrangian")
"""Quantities of which a constant more or less is no slip."""


def less_turns(angles: Array, right: Array) -> Array:
    """Angles without the whole turns by which they are off, (..., N)."""
    with np.errstate(invalid="ignore"):
        return np.asarray(angles - 2 * np.pi * np.rint((angles - right) / (2 * np.pi)))


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
        return self.read_as(self.asked(readings), readings)

    def asked(self, readings: tuple[Confusion, ...]) -> Array:
        """What the engine is made to say by the readings that come before its answer."""
        robot, arguments, engine = self.robot, self.arguments, self.engine
        for reading in readings:
            if reading.stage == "robot":
                robot = reading.apply(robot)
            elif reading.stage == "arguments":
                arguments = reading.apply(arguments)
            elif reading.stage == "engine":
                engine = reading.apply(engine)
        return engine(robot, arguments)

    def read_as(self, values: Array, readings: tuple[Confusion, ...]) -> Array:
        """The engine's answer under the readings of an answer; entries outside the index go."""
        for reading in readings:
            if reading.stage == "answer":
                values = reading.apply(values)
        return values[(slice(None), *self.index)]


def table_of(mechanism: Any) -> DHTable | None:
    """The DH table of an arm that has one; a linkage has none."""
    table: DHTable | None = getattr(mechanism, "table", None)
    return table


# -------- The single entries of an answer, with the index they have in the whole quantity


@dataclass(frozen=True, eq=False)
class AnswerEntry:
    """One number of an answer over all states.

    Attributes:
        label: ``"inverse_dynamics[0]"``.
        index: place in the whole quantity. local: place in the hand formula's answer.
        hand, engine: (N,).
        scale: what errors are relative to: the size of the whole answer, (N,).
    """

    label: str
    index: tuple[int, ...]
    local: tuple[int, ...]
    hand: Array
    engine: Array
    scale: Array

    @property
    def agrees(self) -> bool:
        """Whether this entry is right, to rounding."""
        return self.error(self.hand, self.engine) <= TOLERANCES.formula_agrees

    def error(self, one: Array, two: Array) -> float:
        """Largest difference relative to the size of the answer."""
        gap = np.abs(one - two)
        return float(np.max(np.where(np.isfinite(gap), gap, np.inf) / self.scale))


def entries(case: Case, engine: Array) -> Iterator[AnswerEntry]:
    """Each entry of the case's answer."""
    name = case.quantity.name
    whole = case.engine(case.robot, {k: v[:1] for k, v in case.arguments.items()}).shape[1:]
    places = np.empty(whole, dtype=object)
    for index in np.ndindex(whole):
        places[index] = index
    chosen: Any = places[case.index] if case.index else places
    scale = error_sizes(engine)
    if engine.ndim == 1:
        index = chosen if isinstance(chosen, tuple) else ()
        yield AnswerEntry(label_of(name, index), index, (), case.hand, engine, scale)
        return
    for local in np.ndindex(engine.shape[1:]):
        at = (slice(None), *local)
        index = chosen[local]
        yield AnswerEntry(label_of(name, index), index, local, case.hand[at], engine[at], scale)


def label_of(name: str, index: Iterable[Any]) -> str:
    """``mass_matrix[0,1]``; the name alone where the index is empty."""
    places = ",".join(map(str, index))
    return f"{name}[{places}]" if places else name
