"""SymbolicArm: a DH table with names for its numbers, ready to derive from."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Literal

import sympy

from kinlab.errors import NameUnknownError, OptionError, near
from kinlab.model.dh import DHTable
from kinlab.model.link import Convention
from kinlab.symbolic.trig import Poly, TrigRing, symbol
from kinlab.symbolic.vocabulary import Vocabulary, exact, vocabulary
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True, eq=False)
class SymbolicArm:
    """A DH table whose numbers have names.

    Attributes:
        table: the table.
        values: the number each parameter name stands for, SI units.
        trig: the ring the formulas live in.
        groups: runs of two or more neighbouring joints that turn about parallel axes, from 0.
    """

    table: DHTable
    values: dict[str, float]
    trig: TrigRing
    words: Vocabulary = field(repr=False)
    groups: tuple[tuple[int, ...], ...] = ()

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.table.n

    @property
    def q(self) -> tuple[sympy.Symbol, ...]:
        """Joint positions q1 ... qn."""
        return self.trig.q

    @property
    def qd(self) -> tuple[sympy.Symbol, ...]:
        """Joint velocities qd1 ... qdn."""
        return self.trig.qd

    @property
    def qdd(self) -> tuple[sympy.Symbol, ...]:
        """Joint accelerations qdd1 ... qddn."""
        return self.trig.qdd

    @property
    def parameters(self) -> dict[sympy.Symbol, float]:
        """The parameter symbols with the numbers they stand for."""
        return {symbol(name): self.values[name] for name in self.trig.parameters}

    def entry(self, name: str) -> Poly:
        """One entry of the table (see :mod:`kinlab.symbolic.vocabulary`) as a polynomial."""
        total = self.trig.ring.zero
        for factor, word in self.words.entries[name]:
            if word in self.trig.gens:
                total += self.trig.gens[word] * self.trig.number(factor)
            else:
                value = exact(self.values[word]) if word else Fraction(1)
                total += self.trig.number(factor * value)
        return total

    def expression(self, poly: Poly) -> sympy.Expr:
        """A polynomial of this arm's ring as a sympy expression."""
        from kinlab.symbolic.fourier import to_expression

        return to_expression(self.trig, poly, self.groups)


def arm(table: DHTable, symbols: Literal["all", "none"] | Collection[str] = "all") -> SymbolicArm:
    """Names the numbers of a table (:mod:`kinlab.symbolic.vocabulary` says how).

    Args:
        table: the DH table.
        symbols: ``"all"``: every number that is not zero gets a symbol; ``"none"``: numbers
            stay numbers (exact decimals); or the names that become symbols, such as
            ``("l1", "m1")``. Angles stay numbers always; right angles are exact.

    Returns:
        The arm.

    Raises:
        OptionError: ``symbols`` is another word.
        NameUnknownError: the table has no number of that name.
    """
    words = vocabulary(table)
    if isinstance(symbols, str):
        if symbols not in ("all", "none"):
            raise OptionError(f'symbols is {symbols!r}; choose "all", "none" or a list of names')
        names = tuple(words.values) if symbols == "all" else ()
    else:
        for name in symbols:
            if name not in words.values:
                where = f"table {table.name!r}: it has no number called {name!r}"
                raise NameUnknownError(f"{where}; {near(name, words.values)}")
        names = tuple(name for name in words.values if name in symbols)
    angles = tuple(i for i, link in enumerate(table.links) if link.joint == "revolute")
    trig = TrigRing(names, angles, table.n)
    return SymbolicArm(table, dict(words.values), trig, words, _parallel(table))


def values_at(arm: SymbolicArm, changed: Mapping[str, float]) -> dict[sympy.Symbol, float]:
    """The parameters' numbers with some of them changed.

    Raises:
        NameUnknownError: no parameter of that name.
    """
    for name in changed:
        if name not in arm.trig.parameters:
            raise NameUnknownError(
                f"parameter {name!r} is unknown; {near(name, arm.trig.parameters)}"
            )
    return {s: float(changed.get(s.name, value)) for s, value in arm.parameters.items()}


def cos_sin(angle: float) -> tuple[Fraction, Fraction]:
    """cos and sin as rationals: exact at right angles, the decimal of the float elsewhere."""
    c, s = snapped(math.cos(angle)), snapped(math.sin(angle))
    return exact(c), exact(s)


def snapped(value: float) -> float:
    """0 and ±1 where rounding of a right angle left a residue."""
    nearest = round(value)
    return float(nearest) if abs(value - nearest) <= TOLERANCES.right_angle else value


def _parallel(table: DHTable) -> tuple[tuple[int, ...], ...]:
    # a modified row's alpha lies in front of its joint, a standard row's behind
    shift = 0 if table.convention is Convention.MODIFIED else 1
    runs: list[list[int]] = [[]]
    for i, link in enumerate(table.links):
        twist = table.links[i - shift].alpha if i else 0.0
        if abs(math.sin(twist)) > TOLERANCES.right_angle or link.joint != "revolute":
            runs.append([])
        if link.joint == "revolute":
            runs[-1].append(i)
    return tuple(tuple(run) for run in runs if len(run) > 1)
