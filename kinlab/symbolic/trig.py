"""Exact arithmetic in cos q_i and sin q_i: sparse polynomials with s_i² = 1 - c_i².

With sin q_i at most to the first power a polynomial has one form only, so two expressions are
the same function exactly when their difference is the zero polynomial.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import sympy
from sympy.polys.rings import ring

from kinlab.arrays import set_fields

Poly = Any
"""A ``sympy.polys.rings.PolyElement``."""


@dataclass(frozen=True, eq=False)
class TrigRing:
    """The ring all formulas of one arm live in.

    Attributes:
        parameters: names of symbolic parameters.
        angles: numbers (from 0) of the joints that turn.
        n: number of joints.
        ring: the sympy ring; generators: parameters, q of sliding joints, c_i, s_i, qd_i, qdd_i.
    """

    parameters: tuple[str, ...]
    angles: tuple[int, ...]
    n: int
    ring: Any = field(init=False)
    q: tuple[sympy.Symbol, ...] = field(init=False)
    qd: tuple[sympy.Symbol, ...] = field(init=False)
    qdd: tuple[sympy.Symbol, ...] = field(init=False)
    gens: dict[str, Poly] = field(init=False)
    index: dict[str, int] = field(init=False)

    def __post_init__(self) -> None:
        slides = [i for i in range(self.n) if i not in self.angles]
        names = [
            *self.parameters,
            *(f"q{i + 1}" for i in slides),
            *(f"cos q{i + 1}" for i in self.angles),
            *(f"sin q{i + 1}" for i in self.angles),
            *(f"qd{i + 1}" for i in range(self.n)),
            *(f"qdd{i + 1}" for i in range(self.n)),
        ]
        symbols = [sympy.Symbol(name, real=True) for name in names]
        made, *gens = ring(symbols, sympy.QQ)
        numbered = {
            letter: tuple(symbol(f"{letter}{i + 1}") for i in range(self.n))
            for letter in ("q", "qd", "qdd")
        }
        index = {name: k for k, name in enumerate(names)}
        gens_by_name = dict(zip(names, gens, strict=True))
        set_fields(self, ring=made, gens=gens_by_name, index=index, **numbered)

    def number(self, value: Any) -> Poly:
        """A rational number as a polynomial."""
        return self.ring.ground_new(sympy.QQ(value.numerator, value.denominator))

    def reduce(self, poly: Poly) -> Poly:
        """Brings every sin q_i to the first power at most."""
        for i in self.angles:
            c, s = self.index[f"cos q{i + 1}"], self.index[f"sin q{i + 1}"]
            if any(powers[s] > 1 for powers in poly):
                poly = self._reduce_one(poly, c, s)
        return poly

    def _reduce_one(self, poly: Poly, c: int, s: int) -> Poly:
        groups: dict[int, dict[tuple[int, ...], Any]] = {}
        for powers, factor in poly.items():
            half, rest = divmod(powers[s], 2)
            key = (*powers[:s], rest, *powers[s + 1 :])
            group = groups.setdefault(half, {})
            group[key] = group.get(key, 0) + factor
        square = 1 - self.ring.gens[c] ** 2
        total = self.ring.zero
        for half, terms in groups.items():
            part = self.ring.from_dict({k: v for k, v in terms.items() if v})
            total += part * square**half
        return total

    def mul(self, one: Poly, two: Poly) -> Poly:
        """The reduced product."""
        if not one or not two:
            return self.ring.zero
        return self.reduce(one * two)

    def by_joint(self, poly: Poly, i: int) -> Poly:
        """The partial derivative by q_i (i from 0)."""
        if i not in self.angles:
            return poly.diff(self.gens[f"q{i + 1}"])
        c, s = self.gens[f"cos q{i + 1}"], self.gens[f"sin q{i + 1}"]
        return self.reduce(poly.diff(s) * c - poly.diff(c) * s)


def symbol(name: str) -> sympy.Symbol:
    """The symbol of that name; every symbol of kinlab is real."""
    return sympy.Symbol(name, real=True)
