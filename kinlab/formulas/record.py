"""The record of one hand formula, and the decorators that make it.

A record joins what a note writes (its id, its place, the typeset form, the function) with the
name of the engine quantity it claims to be. The catalogue runs records, the report prints them,
the doctor takes them apart. Nothing here knows an engine.

Calling convention of ``Formula.function``: ``function(numbers, *stacks)``. ``numbers`` is the
plain record of the mechanism (:class:`kinlab.notes.arm.Arm` for a serial arm, the record of its
own for another mechanism), ``stacks`` are the quantity's arguments, each with the same leading
axis of states, and the answer has that leading axis too. The functions of the notes index from
the end (``q[..., 0]``), so that they take a single state as well.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from kinlab.errors import KinlabError, OptionError

Function = Callable[..., Any]
Marked = TypeVar("Marked", bound=Function)

_ID = re.compile(r"\d{3}\.[A-Za-z0-9.]+")


class FormulaError(KinlabError, ValueError):
    """A hand formula failed, or answered with another shape or type than its quantity has."""


class AnswerShapeError(FormulaError):
    """A hand formula answered with another shape than its quantity has."""


@dataclass(frozen=True)
class Printed:
    """The form a note prints, where it is wrong.

    Attributes:
        function: the printed form; called as ``Formula.function`` is.
        misprint: what is wrong, in one line.
        latex: the printed form, typeset. The wrong piece stands in ``\\wrong{...}``.
        robots: where it shows, if not on all robots of the formula.
    """

    function: Function
    misprint: str
    latex: str
    robots: tuple[str, ...] = ()


@dataclass(frozen=True)
class Formula:
    """One hand formula beside one engine quantity.

    Attributes:
        id: ``"001.tau1"``: the note and the name in it. A user's own formula has its function's
            name.
        part: tells the rows of one id apart; empty where there is one.
        title: one line, from the function's docstring.
        source: where it stands, such as ``"note 001, section 2"``.
        quantity: name of the engine quantity (see ``kinlab.check.quantities``), with an
            index where only some entries are meant: ``"inverse_dynamics[0]"``.
        robots: names of mechanisms, or of groups (``"serial"``: every one shipped).
        function: the corrected form; see the module's docstring for how it is called.
        latex: the corrected form, typeset. What was corrected stands in ``\\fixed{...}``.
        printed: the note's own form where that is wrong.
        remark: what the note leaves unsaid, or says wrongly in words only.
    """

    id: str
    title: str
    source: str
    quantity: str
    robots: tuple[str, ...]
    function: Function = field(repr=False)
    latex: str = field(default="", repr=False)
    printed: Printed | None = field(default=None, repr=False)
    part: str = ""
    remark: str = ""

    @property
    def key(self) -> str:
        """Unique name: the id, and the part behind a colon."""
        return f"{self.id}:{self.part}" if self.part else self.id

    @property
    def note(self) -> str:
        """The number of the note, or ``""`` for a user's formula."""
        return self.id[:3] if _ID.fullmatch(self.id) else ""


def formula(
    id: str,
    *,
    source: str,
    quantity: str,
    robots: str | Iterable[str],
    latex: str,
    printed: Printed | None = None,
    part: str = "",
    remark: str = "",
) -> Callable[[Marked], Marked]:
    """Marks a function of the notes as a hand formula; the arguments are those of Formula.

    The function stays the plain function it is; the record is its ``formulas`` attribute.
    """

    def mark(function: Marked) -> Marked:
        record = Formula(
            id=id,
            title=first_line(function),
            source=source,
            quantity=quantity,
            robots=names(robots),
            function=function,
            latex=latex,
            printed=printed,
            part=part,
            remark=remark,
        )
        return attach(function, record)

    return mark


def hand_formula(
    quantity: str, robot: str | Iterable[str], *, latex: str = "", source: str = ""
) -> Callable[[Marked], Marked]:
    """Marks a function in a user's file for ``kinlab check my_formulas.py``.

    The function takes one state, the quantity's arguments in order, and returns what the
    quantity has::

        @kl.hand_formula("gravity_torques", robot="single_link")
        def g(q):
            return np.array([2.5 * 9.81 * 0.3 * np.cos(q[0])])

    Args:
        quantity: name of the engine quantity; ``kinlab check --quantities`` lists them.
        robot: a name or path for ``kl.load``, or several.
        latex: the formula, typeset, for the report.
        source: where it comes from.

    Returns:
        The decorator. The function stays as it is.
    """
    robots = names(robot)
    if not robots:
        raise OptionError("hand_formula: no robot named; give a name or path, or several")

    def mark(function: Marked) -> Marked:
        record = Formula(
            id=function_name(function),
            title=first_line(function),
            source=source,
            quantity=quantity,
            robots=robots,
            function=state_by_state(function),
            latex=latex,
        )
        return attach(function, record)

    return mark


def attach(function: Marked, record: Formula) -> Marked:
    """Adds a record to a function; one function may carry several."""
    known = getattr(function, "formulas", ())
    function.formulas = (*known, record)  # type: ignore[attr-defined]
    return function


def formulas_in(module: Any) -> list[Formula]:
    """The records of a module's own marked functions, in the order of the file."""
    found: dict[int, Formula] = {}
    for value in vars(module).values():
        if inspect.isfunction(value) and value.__module__ == module.__name__:
            for record in reversed(getattr(value, "formulas", ())):
                found.setdefault(id(record), record)
    return list(found.values())


def state_by_state(function: Function) -> Function:
    """Gives a function of one state the calling convention of ``Formula.function``.

    It gets copies, so that it cannot change the states of the comparison, and its answers are
    copied, so that one that fills the same array at every state is not told its last answer for
    all. One that asks for one argument more, of a name in :data:`SIDES` such as ``elbow``, gets +1
    and then -1 for it, and answers with a row for each. The function itself stays its
    ``__wrapped__``.

    Raises:
        FormulaError: (when called) the function raised, or answered with changing shapes.
    """

    known: dict[int, Any] = {}

    def stacked(numbers: Any, *stacks: Any) -> Any:
        del numbers
        answers = []
        count = len(stacks)
        sides = known[count] if count in known else known.setdefault(count, _sides(function, count))
        for k, state in enumerate(zip(*stacks, strict=True)):
            try:
                rows = [
                    _numbers(function(*(np.array(x) for x in state), *side), function)
                    for side in sides
                ]
                answers.append(
                    rows[0]
                    if len(rows) == 1
                    else np.concatenate([np.atleast_2d(row) for row in rows])
                )
            except KinlabError:
                raise
            except Exception as problem:  # whatever a user's function may raise
                raise FormulaError(
                    f"function {function_name(function)!r} failed at state {k}: "
                    f"{type(problem).__name__}: {problem}"
                ) from problem
            if answers[-1].shape != answers[0].shape:
                raise FormulaError(
                    f"function {function_name(function)!r} answered with shape "
                    f"{answers[-1].shape} at state {k}, with {answers[0].shape} before"
                )
        return np.stack(answers)

    stacked.__name__ = function_name(function)  # what messages call it
    stacked.__wrapped__ = function  # type: ignore[attr-defined]
    return stacked


def _numbers(answer: Any, function: Function) -> Any:
    """An answer as an array of its own; numbers of sympy or fractions become floats.

    What is masked is no number.
    """
    if answer is None:
        raise FormulaError(
            f"function {function_name(function)!r} gives nothing back (None): is a return missing?"
        )
    if isinstance(answer, np.ma.MaskedArray) and np.ma.is_masked(answer):
        return np.ma.filled(answer.astype(float), np.nan)
    found = np.array(answer)
    if found.dtype == object and all(hasattr(x, "__float__") for x in found.flat):
        try:
            return found.astype(float)
        except (TypeError, ValueError):  # a formula with letters left in it
            return found
    return found


SIDES = ("elbow", "branch", "sign", "mode", "side")
"""Names for +1 and -1: which of two solutions."""


def _sides(function: Function, count: int) -> tuple[tuple[float, ...], ...]:
    """What a function gets behind a state: +1 and then -1, if its last argument asks for one."""
    try:
        known = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return ((),)
    asked = [p.name for p in known if p.default is p.empty and p.kind is p.POSITIONAL_OR_KEYWORD]
    asks = len(asked) == count + 1 and asked[-1] in SIDES
    return ((1.0,), (-1.0,)) if asks else ((),)


def names(value: str | Iterable[str]) -> tuple[str, ...]:
    """One name or several, as a tuple."""
    return (value,) if isinstance(value, str) else tuple(value)


def first_line(function: Function) -> str:
    """First line of the docstring, without its full stop, or the function's name."""
    text = (inspect.getdoc(function) or function_name(function)).strip()
    return text.splitlines()[0].rstrip(".")


def function_name(function: Function) -> str:
    """What to call a function in a message."""
    return str(getattr(function, "__name__", None) or type(function).__name__)
