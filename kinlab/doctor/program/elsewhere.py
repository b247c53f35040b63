"""The lines of a function that lives in another process: looked for there, told here."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from kinlab.arrays import Array
from kinlab.check.quantities.registry import quantity
from kinlab.doctor.changes import Arguments, Case
from kinlab.doctor.program.words import WrongLines, lines
from kinlab.errors import KinlabError
from kinlab.host.language import language, speaking


def lines_elsewhere(
    ask: Callable[..., Iterator[WrongLines]], case: Case, wanted: Array, allowed: float
) -> Iterator[WrongLines]:
    """As :func:`kinlab.doctor.program.words.lines`; a process that is lost costs only the lines.

    Args:
        ask: has a generator run where the function is: (generator, its arguments after the
            function) to what it yields; see :meth:`kinlab.check.guest.Guest.ask`.
        case, wanted, allowed: as there.
    """
    known = (case.robot, case.quantity.name, case.index, case.arguments, case.hand)
    try:
        yield from ask(_there, language(), *known, wanted, allowed)
    except KinlabError:
        return


def _there(
    function: Any,
    spoken: str,
    robot: Any,
    name: str,
    index: tuple[Any, ...],
    arguments: Arguments,
    hand: Array,
    wanted: Array,
    allowed: float,
) -> Iterator[WrongLines]:
    """Of a function of stacks that is made of one of states."""
    case = Case(robot, quantity(name), arguments, hand, index)
    with speaking(spoken):
        yield from lines(function.__wrapped__, case, wanted, allowed)
