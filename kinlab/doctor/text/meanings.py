"""What a number in a formula may stand for: the robot's, products and sums of these, constants."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations, combinations_with_replacement

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.derived import WRENCH
from kinlab.doctor.text.written import Literal, literal
from kinlab.formulas import tree
from kinlab.formulas.tree import Node
from kinlab.host.language import _
from kinlab.tolerances import TOLERANCES

CLOSE = 0.025
"""Relative change up to which one digit is a rounding."""
_SIMPLE = 12
_UNITS = {"": 1.0, "pi": math.pi, "sqrt(2)": math.sqrt(2), "sqrt(3)": math.sqrt(3)}
_FRACTIONS = tuple(k / n for n in range(1, _SIMPLE + 1) for k in range(1, 2 * _SIMPLE + 1))
_SHARES = tuple(k / n for n in (1, 2, 3, 4, 6, 12) for k in range(1, 6))
_PARTS = (1.0, 2.0, 4.0, 1 / 2, 1 / 3, 2 / 3, 4 / 3, 1 / 4, 3 / 4, 3 / 2, 1 / 6, 1 / 8, 1 / 12)
"""Numbers in front of products of the robot's: m l²/3, m l²/12."""
_ADDED = 6
"""Terms in front of one joint function of which some are added."""
RODS = tuple(k / n for n in (3, 6, 12, 24) for k in (1, 2, 4, 7))
"""Numbers in front of m l² of rods, which nobody writes in full."""


@dataclass(frozen=True, eq=False)
class Meanings:
    """What the numbers in formulas of one robot may stand for.

    Attributes:
        own: the robot's numbers by name.
    """

    own: Mapping[str, float]

    @classmethod
    def at(cls, values: Mapping[str, Array]) -> Meanings:
        """From the values of all names at some states."""
        still = (name for name in values if name[0] != "q" and name not in WRENCH)
        own = (name for name in still if np.all(values[name] == values[name][0]))
        return cls({name: float(values[name][0]) for name in own})

    @cached_property
    def products(self) -> Array:
        """Masses times lengths, squares and g, moments of inertia, and sums of like ones."""
        kinds: dict[str, list[float]] = {"m": [], "I": [], "g": [], "": []}
        for name, value in self.own.items():
            kinds[name[0] if name[0] in kinds else ""].append(abs(value))
        lengths = kinds[""]
        heavy = [1.0, *map(sum, _subsets(kinds["m"]))]
        squares = [a * b for a, b in combinations_with_replacement(lengths, 2)]
        sums = [a + b for like in (lengths, squares) for a, b in combinations(like[:20], 2)]
        parts = [1.0, *lengths, *squares]
        extents = [*np.multiply.outer(parts, _PARTS).ravel(), *sums]
        made = np.multiply.outer(heavy, np.multiply.outer(extents, [1.0, *kinds["g"]]))
        return np.unique([*made.ravel(), *map(sum, _subsets(kinds["I"]))])

    @cached_property
    def values(self) -> Array:
        """All of them, in ascending order."""
        irrational = np.multiply.outer(_SHARES, list(_UNITS.values())).ravel()
        return np.unique([*_FRACTIONS, *irrational, *self.products])

    @cached_property
    def rods(self) -> list[float]:
        """m l² of links that are rods by their I = m l²/12, and sums of these."""
        found = []
        for name, inertia in self.own.items():
            m, length = self.own.get(f"m{name[1:]}", 0.0), self.own.get(f"l{name[1:]}", 0.0)
            rod = m * length * length
            if name[0] == "I" and rod and abs(12 * inertia - rod) <= TOLERANCES.same_length * rod:
                found.append(rod)
        return [*map(sum, _subsets(found)), *(a + b for a, b in combinations(found, 2))]

    def _without(self, name: str) -> Meanings:
        return Meanings({other: x for other, x in self.own.items() if other != name})

    def product(self, value: float) -> bool:
        """Whether a value is a product or sum of the robot's numbers: 0.0625 may be no I1."""
        return bool(np.any(np.abs(self.products - value) <= TOLERANCES.same_relation * value))

    def holds(self, value: float) -> bool:
        """Whether a value is one of them, or zero."""
        size = abs(value)
        k = int(np.searchsorted(self.values, size))
        near = self.values[max(k - 1, 0) : k + 1]
        return size == 0 or bool(np.any(np.abs(near - size) <= TOLERANCES.same_relation * size))

    def around(self, one: Literal) -> list[float]:
        """Those that a number may be rounded from: the robot's own first, then the nearest."""
        reach = one.reach * (1 + TOLERANCES.same_relation)  # 0.303 may be 0.3025
        low, high = np.searchsorted(self.values, (one.value - reach, one.value + reach))
        found = [float(x) for x in self.values[low:high]]
        return sorted(found, key=lambda x: (self.parameter(x) is None, abs(x - one.value)))

    def parameter(self, value: float) -> str | None:
        """The robot's number of that value."""
        near = TOLERANCES.same_relation * abs(value)
        return next((name for name, x in self.own.items() if abs(x - value) <= near), None)

    def named(self, value: float) -> str:
        """A number as one would write it exactly: g = 9.81, 1/3, pi/2, sqrt(2)/2."""
        name = self.parameter(value)
        if name is not None and (name == "g" or not self._without(name).product(value)):
            return f"{name} = {self.own[name]:.10g}"
        for word, unit in _UNITS.items():
            found = Fraction(value / unit).limit_denominator(_SIMPLE)
            if found and abs(float(found) * unit - value) <= TOLERANCES.same_relation * abs(value):
                above = word or str(found.numerator)
                above = f"{found.numerator}*{word}" if word and found.numerator != 1 else above
                return above if found.denominator == 1 else f"{above}/{found.denominator}"
        return f"{value:.7g}"

    def credible(self, one: Literal, value: float, digits: int = 3) -> bool:
        """Whether so few digits are a rounding at all: 0.33 may be 1/3, but 0.3 is not.

        Args:
            one: what is written.
            value: what it may stand for.
            digits: how many of them a whole number has that is no other number of the robot.
        """
        name = self.parameter(value)
        if one.whole and not (one.half and one.digits >= digits):
            return name is not None
        gap = abs(value - one.value)
        weight = name is not None and name[0] == "g"  # the textbooks' 10, and 9.80665
        if gap > one.half * (1 + TOLERANCES.same_relation):
            return weight
        constant = self.holds(value) and not self.product(value)
        near = TOLERANCES.typed_rounding if constant else CLOSE
        return weight or gap <= near * abs(value) or (one.digits > 1 and not constant)


def coefficients(right: Node) -> tuple[list[Node], ...]:
    """What stands in front of the joint functions of a formula, parts of that, and their products.

    Sums of the terms in front come before products within one term: 0.438 is (m1 + m2) l1²/2.
    """
    fronts: dict[Node, list[Node]] = {}
    within: list[Node] = []
    for term in right.terms:
        moving = [f for f in term.factors if any(name[0] == "q" for name in tree.names(f))]
        still = [f for f in term.factors if f not in moving]
        fronts.setdefault(tree.mul(tree.num(1), *moving), []).append(tree.mul(tree.num(1), *still))
        for count in range(1, len(still)):
            within += [tree.mul(tree.num(1), *some) for some in combinations(still, count)]
    whole = [tree.add(*terms) for terms in fronts.values()]
    single = [term for terms in fronts.values() for term in terms]
    some = [
        tree.add(*part)
        for terms in fronts.values()
        for count in range(2, len(terms))
        for part in combinations(terms[:_ADDED], count)
    ]
    return tuple(list(dict.fromkeys(circle)) for circle in ([*single, *whole], some, within))


def exact_angle(value: float) -> float | None:
    """The multiple of 15 degrees that an angle is, rounded; None where it is exact or none."""
    one = literal(f"{abs(value):.15g}")
    exact = round(value / (math.pi / 12)) * math.pi / 12
    gap = abs(value - exact)
    if not 0 < one.half <= 0.006 or gap <= 1e-14:
        return None
    return exact if gap <= one.half * (1 + TOLERANCES.same_relation) else None


def stands_for(written: object, meant: str) -> str:
    """``9.8 stands for g = 9.81``."""
    return _("{written} stands for {meant}").format(written=written, meant=meant)


def _subsets(values: list[float]) -> Iterator[tuple[float, ...]]:
    """Neighbours from 1 on, of which sums are taken: m1, m1 + m2, m2 + m3, ..."""
    for i in range(len(values)):
        for j in range(i + 1, len(values) + 1):
            yield tuple(values[i:j])
