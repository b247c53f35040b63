"""From polynomials in c_i, s_i to readable expressions: cos(q1 + q2) instead of c1 c2 - s1 s2.

Joints that turn about parallel axes enter robot formulas through sums of their angles. For such
a group the polynomial is rewritten in the basis cos(k·q), sin(k·q), which is as unique as the
powers are; where that makes a formula longer (a spherical wrist) the powers stay.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import sympy

from kinlab.symbolic.trig import Poly, TrigRing, symbol

Harmonics = dict[tuple[tuple[int, ...], bool], Any]
"""Sum of factor * cos(k·q) (False) or sin(k·q) (True); the first non-zero k is positive."""


def to_expression(trig: TrigRing, poly: Poly, groups: tuple[tuple[int, ...], ...]) -> sympy.Expr:
    """The shorter of the two forms of a polynomial, as a sympy expression."""
    if not poly:
        return sympy.Integer(0)
    plain = terms(trig, poly, ())
    merged = terms(trig, poly, groups) if groups else plain
    chosen = merged if len(merged) <= len(plain) else plain
    return sympy.Add(*(term * factor for term, factor in chosen.items()))


def terms(
    trig: TrigRing, poly: Poly, groups: tuple[tuple[int, ...], ...]
) -> dict[sympy.Expr, sympy.Rational]:
    """The polynomial as a sum of rational multiples of products that are linearly independent.

    Args:
        trig: the ring.
        poly: a reduced polynomial.
        groups: joints whose angles are combined.

    Returns:
        Product (such as ``m2*l1*l2*cos(q1 + q2)``) to rational factor.
    """
    grouped = {i for group in groups for i in group}
    circles = [(trig.index[f"cos q{i + 1}"], trig.index[f"sin q{i + 1}"]) for i in sorted(grouped)]
    where = dict(zip(sorted(grouped), circles, strict=True))
    total: dict[sympy.Expr, Any] = {}
    for powers, factor in poly.items():
        outside = list(powers)
        for c, s in circles:
            outside[c] = outside[s] = 0
        product: dict[sympy.Expr, Any] = {_monomial(trig, tuple(outside)): factor}
        for group in groups:
            exponents = tuple((powers[where[i][0]], powers[where[i][1]]) for i in group)
            if any(c or s for c, s in exponents):
                waves = [
                    (_harmonic(trig, group, k, odd), f)
                    for (k, odd), f in _harmonics(exponents).items()
                ]
                product = {p * w: x * f for p, x in product.items() for w, f in waves}
        for expression, x in product.items():
            total[expression] = total.get(expression, 0) + x
    return {key: sympy.Rational(x.numerator, x.denominator) for key, x in total.items() if x}


def _monomial(trig: TrigRing, powers: tuple[int, ...]) -> sympy.Expr:
    factors = [atom**power for atom, power in zip(_atoms(trig), powers, strict=True) if power]
    return sympy.Mul(*factors)


@cache
def _atoms(trig: TrigRing) -> tuple[sympy.Expr, ...]:
    atoms: list[sympy.Expr] = []
    for name in trig.index:
        head, _, joint = name.partition(" ")
        function = {"cos": sympy.cos, "sin": sympy.sin}.get(head) if joint else None
        atoms.append(function(symbol(joint)) if function else symbol(name))
    return tuple(atoms)


def _harmonic(trig: TrigRing, group: tuple[int, ...], k: tuple[int, ...], odd: bool) -> sympy.Expr:
    angle = sympy.Add(*(m * trig.q[i] for m, i in zip(k, group, strict=True)))
    return sympy.sin(angle) if odd else sympy.cos(angle)


@cache
def _harmonics(exponents: tuple[tuple[int, int], ...]) -> Harmonics:
    """Product of c_i^a s_i^b over a group as harmonics, by product-to-sum formulas."""
    zero = (0,) * len(exponents)
    waves: Harmonics = {(zero, False): sympy.QQ(1)}
    for place, (c, s) in enumerate(exponents):
        unit = tuple(int(k == place) for k in range(len(exponents)))
        for odd in (*(False,) * c, *(True,) * s):
            waves = _times(waves, unit, odd)
    return waves


def _times(waves: Harmonics, unit: tuple[int, ...], odd: bool) -> Harmonics:
    half = sympy.QQ(1, 2)
    out: Harmonics = {}
    for (k, was_odd), factor in waves.items():
        more = tuple(a + b for a, b in zip(k, unit, strict=True))
        less = tuple(a - b for a, b in zip(k, unit, strict=True))
        if was_odd and odd:
            pieces = ((less, False, 1), (more, False, -1))
        elif was_odd:
            pieces = ((more, True, 1), (less, True, 1))
        elif odd:
            pieces = ((more, True, 1), (less, True, -1))
        else:
            pieces = ((more, False, 1), (less, False, 1))
        for wave, sine, sign in pieces:
            _put(out, wave, sine, factor * half * sign)
    return {key: factor for key, factor in out.items() if factor}


def _put(out: Harmonics, k: tuple[int, ...], odd: bool, factor: Any) -> None:
    first = next((m for m in k if m), 0)
    if first < 0:
        k, factor = tuple(-m for m in k), (-factor if odd else factor)
    if first == 0 and odd:
        return
    out[k, odd] = out.get((k, odd), sympy.QQ(0)) + factor
