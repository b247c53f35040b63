"""The comparison of a hand formula with the engine over seeded random states.

The error of a state is max|hand - engine| / max(max|engine|, typical), over the entries of the
answer; typical is the median over the states of max|engine|, so that a state where the quantity
happens to vanish does not divide by nothing. Where the quantity vanishes in most states, it is
its largest value, where it vanishes in all (below ``TOLERANCES.vanishes``) 1, and never less than
the quantity's own ``scale``. A NaN or infinity of the hand formula counts as an infinite error.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinlab.arrays import Array, first_largest, seed_of, whole
from kinlab.check.quantities.quantity import Quantity
from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.errors import OptionError
from kinlab.formulas.record import AnswerShapeError, FormulaError, function_name, state_by_state
from kinlab.host.introductions import Introduction, Rows, numbered
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Rows):
    """A hand formula beside the engine.

    Attributes:
        quantity: the engine quantity's name.
        robot: the mechanism's name.
        function: the hand function's name.
        samples, seed: how many random states, drawn with which seed.
        arguments: the states, by argument name, (samples, ...).
        hand, engine: both answers, (samples, ...).
        errors: relative error of each state, (samples,); see the module's docstring.
    """

    quantity: str
    robot: str
    function: str
    samples: int
    seed: int
    arguments: dict[str, Array] = field(repr=False)
    hand: Array = field(repr=False)
    engine: Array = field(repr=False)
    errors: NDArray[np.float64] = field(repr=False)

    @property
    def max_error(self) -> float:
        """Largest relative error over the states; infinite where the formula gave NaN."""
        return float(np.max(self.errors))

    @property
    def worst(self) -> int:
        """Index of the state with the largest error; of equal ones, the first."""
        return first_largest(self.errors)

    @property
    def agrees(self) -> bool:
        """Whether the two answer alike, to rounding, at every state that was drawn."""
        return self.max_error <= TOLERANCES.formula_agrees

    def columns(self) -> dict[str, Any]:
        """State by state: the arguments, both answers and the relative error."""
        out: dict[str, Any] = {}
        for name, values in (*self.arguments.items(), ("hand", self.hand), ("engine", self.engine)):
            out |= numbered(name, values)
        return out | {"error": self.errors}

    def introduction(self) -> Introduction:
        """Whether they are the same formula, and where they are furthest apart."""
        if self.agrees:
            told = _(
                "{function} agrees with {quantity} of {robot}: largest relative error {error} over "
                "{samples} states"
            )
        else:
            told = _(
                "{function} DIFFERS with {quantity} of {robot}: largest relative error {error} "
                "over {samples} states"
            )
        text = told.format(
            function=self.function,
            quantity=self.quantity,
            robot=self.robot,
            error=f"{self.max_error:.2g}",
            samples=self.samples,
        )
        if self.agrees:
            return Introduction(text, mood="good")
        k = self.worst
        with np.printoptions(precision=6, suppress=True, linewidth=100):
            state = ", ".join(f"{name} = {value[k]}" for name, value in self.arguments.items())
            worst = _("worst at {state}").format(state=state)
            hand = _("hand   {values}").format(values=self.hand[k])
            engine = _("engine {values}").format(values=self.engine[k])
        return Introduction(text, (worst, hand, engine), mood="bad")


def need_function(function: object) -> None:
    """Refuses what is no function, formulas as text above all, with where they go.

    Raises:
        OptionError: it cannot be called.
    """
    if not callable(function):
        raise OptionError(
            f"function: {type(function).__name__} cannot be called; a formula as text goes into a "
            'file (robot = "planar2r", below [formulas] tau2 = "..."), read by kinlab check FILE'
        )


def compare(
    robot: Any, quantity: str, function: Callable[..., Any], samples: int = 200, seed: int = 0
) -> Comparison:
    """Puts a function beside the engine over random states.

    Args:
        robot: a Robot, DHTable, name or path (for a quantity of another kind of mechanism: that
            mechanism or its name).
        quantity: what the function claims to be, such as ``"inverse_dynamics"``; an index picks
            entries: ``"inverse_dynamics[0]"``. ``kinlab check --quantities`` lists all.
        function: takes one state, the quantity's arguments in order: ``f(q, v, a)``.
        samples: how many random states.
        seed: the same seed gives the same states.

    Returns:
        The comparison, with the states and both answers.

    Raises:
        NameUnknownError: no such robot or quantity.
        OptionError: samples below 1.
        FormulaError: the function failed or answered with another shape or type.
    """
    found = find_quantity(quantity)
    mechanism = found.domain.load(robot)
    need_function(function)
    stacked = state_by_state(found.asked(mechanism, function))
    return compare_stacked(mechanism, found, stacked, function_name(function), None, samples, seed)


def compare_stacked(
    mechanism: Any,
    quantity: Quantity,
    function: Callable[..., Any],
    name: str,
    numbers: Any,
    samples: int,
    seed: int,
) -> Comparison:
    """As :func:`compare`, for a function called as ``Formula.function`` is."""
    samples, seed = whole(samples, "samples"), seed_of(seed)
    states = quantity.states(mechanism, int(samples), seed)
    engine = quantity.answers(mechanism, int(samples), seed)
    answers = function(numbers, *(np.array(s) for s in states))
    if quantity.read is not None:
        answers = quantity.read(mechanism, answers, engine)
    hand = _read(answers, engine, name, quantity)
    return Comparison(
        quantity=quantity.name,
        robot=quantity.domain.label(mechanism),
        function=name,
        samples=int(samples),
        seed=seed,
        arguments=dict(zip(quantity.arguments, states, strict=True)),
        hand=hand,
        engine=engine,
        errors=relative_errors(hand, engine, quantity.scale),
    )


def relative_errors(hand: Array, engine: Array, scale: float = 0.0) -> Array:
    """Error of each state, by the measure of the module's docstring.

    Args:
        hand, engine: (N, ...), of one shape.
        scale: natural size of a quantity that is zero by nature.

    Returns:
        (N,).
    """
    gap = np.max(np.abs((hand - engine).reshape(len(engine), -1)), axis=1, initial=0.0)
    return np.where(np.isfinite(gap), gap, np.inf) / error_sizes(engine, scale)


def error_sizes(engine: Array, scale: float = 0.0) -> Array:
    """What the error of each state is relative to, by the measure of the module's docstring.

    Args:
        engine: (N, ...).
        scale: natural size of a quantity that is zero by nature.

    Returns:
        (N,).
    """
    size = np.max(np.abs(engine.reshape(len(engine), -1)), axis=1, initial=0.0)
    typical = next(
        (x for x in (float(np.median(size)), float(np.max(size))) if x > TOLERANCES.vanishes), 1.0
    )
    sizes: Array = np.maximum(size, max(typical, scale))
    return sizes


def rows_alone(has: tuple[int, ...], wants: tuple[int, ...], name: str) -> tuple[str, str] | None:
    """What to ask for instead, where answers (N, ...) hold the first or the last rows."""
    if len(has) != len(wants) or len(has) < 2 or has[2:] != wants[2:] or "[" in name:
        return None
    rows, of = has[1], wants[1]
    return (f"{name}[:{rows}]", f"{name}[{of - rows}:]") if 0 < rows < of else None


def _some_rows(has: tuple[int, ...], wants: tuple[int, ...], name: str) -> str:
    alone = rows_alone(has, wants, name)
    if alone is None:
        return ""
    (first, last), rows, of = alone, has[1], wants[1]
    return f"the first {rows} of its {of} rows are the quantity {first!r}, the last {last!r}"


def _read(answer: Any, engine: Array, name: str, quantity: Quantity) -> Array:
    values = np.asarray(answer)
    if values.dtype.kind not in "iuf":
        raise FormulaError(
            f"function {name!r} answered with dtype {values.dtype}; {quantity.name!r} is real "
            "numbers" + ("; give their real part: .real" if values.dtype.kind == "c" else "")
        )
    if values.shape != engine.shape:
        meant = _some_rows(values.shape, engine.shape, quantity.name)
        raise AnswerShapeError(
            f"function {name!r} answered with shape {values.shape[1:]}; {quantity.name!r} has "
            f"shape {engine.shape[1:]} ({quantity.about}){meant and '; '}{meant}"
        )
    return values.astype(float)
