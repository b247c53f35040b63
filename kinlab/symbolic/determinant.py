"""det J in factors: each factor that can vanish is one family of singularities.

The determinant does not depend on the frame or the reference point, so it is expanded where the
Jacobian has most zeros (for a spherical wrist: at the wrist centre, where it falls into an arm
and a wrist block). Each block is factored after tan(q/2) has turned it into a polynomial, where
factors are unique, and the factors are turned back.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from typing import Any

import sympy
from sympy.polys.rings import ring

from kinlab.errors import OptionError, StructureError
from kinlab.symbolic import kinematics
from kinlab.symbolic.arm import SymbolicArm
from kinlab.symbolic.kinematics import Grid
from kinlab.symbolic.trig import Poly, symbol

_LARGEST = 4000
_LARGEST_LONG = 60
"""Terms above which a block of the determinant is left unfactored: factoring would take minutes.
The second holds where coefficients have many digits (the cosine of an angle that is not right)."""
_LONG = 10**8


@dataclass(frozen=True)
class Determinant:
    """det J as a product.

    Attributes:
        constant: the number in front.
        factors: each factor with its power; those without a joint variable come first.
        rows: which rows of the Jacobian it is the determinant of (0 to 5, linear first).
        complete: False where a block was too large to be factored.
    """

    constant: sympy.Rational
    factors: tuple[tuple[sympy.Expr, int], ...]
    rows: tuple[int, ...]
    complete: bool = True

    @property
    def expression(self) -> sympy.Expr:
        """The product."""
        return self.constant * sympy.Mul(*(factor**power for factor, power in self.factors))

    @property
    def singular_factors(self) -> tuple[sympy.Expr, ...]:
        """The factors that depend on a joint variable: the arm is singular where one is zero."""
        joints = {
            s
            for factor, _ in self.factors
            for s in factor.free_symbols
            if s.name[0] == "q" and s.name[1:].isdigit()
        }
        return tuple(f for f, _ in self.factors if f.free_symbols & joints)


def det_jacobian(arm: SymbolicArm, rows: tuple[int, ...] | None = None) -> Determinant:
    """det J in the base frame, factored.

    Args:
        arm: the arm.
        rows: rows of the Jacobian that make it square (0 to 5, linear first). Left out: the
            rows that are not zero everywhere, and of them the first n.

    Returns:
        The determinant; its value is that of the base-frame Jacobian's rows.

    Raises:
        StructureError: more joints than rows: J J^T would be needed, and no product is known.
        OptionError: ``rows`` are not n different numbers from 0 to 5.
    """
    chosen = _read_rows(arm, rows)
    grid = _sparsest(arm, chosen)
    constant, complete = sympy.Rational(1), True
    factors: dict[sympy.Expr, int] = {}
    sign, blocks = _blocks(grid)
    for block in blocks:
        poly = _determinant(arm, block)
        if not poly:
            return Determinant(sympy.Rational(0), (), chosen)
        number, parts, whole = _factor(arm, poly)
        constant, complete = constant * number, complete and whole
        for part, power in parts:
            factors[part] = factors.get(part, 0) + power
    joints = set(arm.q)
    ordered = sorted(factors.items(), key=lambda f: (bool(f[0].free_symbols & joints), str(f[0])))
    return Determinant(sign * constant, tuple(ordered), chosen, complete)


def det_poly(arm: SymbolicArm, rows: tuple[int, ...] | None = None) -> Poly:
    """As :func:`det_jacobian`, multiplied out."""
    sign, blocks = _blocks(_sparsest(arm, _read_rows(arm, rows)))
    total = sign * arm.trig.ring.one
    for block in blocks:
        total = arm.trig.reduce(total * _determinant(arm, block))
    return total


def _read_rows(arm: SymbolicArm, rows: tuple[int, ...] | None) -> tuple[int, ...]:
    if rows is not None:
        if (
            sorted(set(rows)) != sorted(rows)
            or len(rows) != arm.n
            or not set(rows) <= set(range(6))
        ):
            raise OptionError(f"rows {rows}: name {arm.n} different rows from 0 to 5")
        return tuple(rows)
    grid = _base_grid(arm)
    moving = tuple(r for r in range(6) if any(grid[r]))
    if len(moving) < arm.n:
        raise StructureError(
            f"table {arm.table.name!r}: {arm.n} joints move {len(moving)} rows of the Jacobian; "
            "it is not square. Name a smaller arm, or use manipulability for redundant arms"
        )
    return moving[: arm.n]


@lru_cache(maxsize=32)
def _base_grid(arm: SymbolicArm) -> Grid:
    point = kinematics.column(kinematics.tool_frame(arm), 3)
    return kinematics.jacobian_at(arm, point)


def _sparsest(arm: SymbolicArm, rows: tuple[int, ...]) -> Grid:
    """The Jacobian's rows where they have fewest terms and the same determinant."""
    linear, angular = set(rows) >= {0, 1, 2}, set(rows) >= {3, 4, 5}
    base = _base_grid(arm)
    if not linear or (set(rows) & {3, 4, 5} and not angular):
        return [base[r] for r in rows]
    placed = kinematics.link_frames(arm)
    points = [None, *range(1, arm.n + 1)] if angular else [None]  # v alone moves with the point
    best: tuple[int, Grid] | None = None
    for at in points:
        moved = (
            base if at is None else kinematics.jacobian_at(arm, kinematics.column(placed[at], 3))
        )
        for frame in placed:
            to_frame = [[frame[c][r] for c in range(3)] for r in range(3)]
            grid = kinematics.product(arm, to_frame, moved[:3])
            if angular:
                grid = [*grid, *kinematics.product(arm, to_frame, moved[3:])]
            size = sum(len(entry) for row in grid for entry in row)
            if best is None or size < best[0]:
                best = size, grid
    assert best is not None
    order = sorted(rows)
    swap = _parity([order.index(r) for r in rows])
    grid = best[1]
    return [[-x for x in grid[0]], *grid[1:]] if swap < 0 else grid


def _blocks(grid: Grid) -> tuple[int, list[Grid]]:
    """Splits a square matrix into the diagonal blocks of a block-triangular form."""
    n = len(grid)
    for size in range(1, n):
        for rows in combinations(range(n), size):
            used = [k for k in range(n) if any(grid[r][k] for r in rows)]
            if len(used) > size:
                continue
            if len(used) < size:
                return 1, [grid]  # singular everywhere: the determinant says so
            rest_rows = [r for r in range(n) if r not in rows]
            rest = [k for k in range(n) if k not in used]
            sign = _parity([*rows, *rest_rows]) * _parity([*used, *rest])
            one = [[grid[r][k] for k in used] for r in rows]
            sign_rest, others = _blocks([[grid[r][k] for k in rest] for r in rest_rows])
            return sign * sign_rest, [one, *others]
    return 1, [grid]


def _parity(order: list[int]) -> int:
    sign = 1
    for i, j in combinations(range(len(order)), 2):
        sign = -sign if order[i] > order[j] else sign
    return sign


def _determinant(arm: SymbolicArm, grid: Grid) -> Poly:
    """Laplace expansion, each minor of the lower rows computed once."""
    n = len(grid)
    known: dict[tuple[int, ...], Poly] = {(): arm.trig.ring.one}
    for size in range(1, n + 1):
        row = grid[n - size]
        level: dict[tuple[int, ...], Poly] = {}
        for cols in combinations(range(n), size):
            total = arm.trig.ring.zero
            for place, k in enumerate(cols):
                minor = known[(*cols[:place], *cols[place + 1 :])]
                if row[k] and minor:
                    total += row[k] * minor * (-1) ** place
            level[cols] = arm.trig.reduce(total)
        known = level
    return known[tuple(range(n))]


def _factor(arm: SymbolicArm, poly: Poly) -> tuple[Any, list[tuple[sympy.Expr, int]], bool]:
    long = any(factor.denominator > _LONG for factor in poly.values())
    if len(poly) > (_LARGEST_LONG if long else _LARGEST):
        return sympy.Rational(1), [(arm.expression(poly), 1)], False
    if poly.is_ground:
        return arm.expression(poly), [], True
    turned, halves, degrees = _half_angles(arm, poly)
    number, parts = turned.factor_list()
    number = sympy.Rational(number.numerator, number.denominator)
    return _turn_back(arm, number, parts, halves, degrees)


def _half_angles(arm: SymbolicArm, poly: Poly) -> tuple[Poly, dict[int, int], dict[int, int]]:
    """poly * prod (1 + t_i²)^{d_i} as a polynomial in t_i = tan(q_i/2).

    Returns:
        The polynomial, joint -> generator number of its t, joint -> d_i.
    """
    trig = arm.trig
    degrees = {}
    for i in trig.angles:
        c, s = trig.index[f"cos q{i + 1}"], trig.index[f"sin q{i + 1}"]
        degree = max(powers[c] + powers[s] for powers in poly)
        if degree:
            degrees[i] = degree
    circles = {trig.index[f"{f} q{i + 1}"] for i in trig.angles for f in ("cos", "sin")}
    used = [
        k
        for k in range(len(trig.ring.gens))
        if k not in circles and any(powers[k] for powers in poly)
    ]
    symbols = [trig.ring.symbols[k] for k in used]
    made, *gens = ring([*symbols, *(symbol(f"t{i + 1}") for i in degrees)], sympy.QQ)
    halves = {i: len(used) + k for k, i in enumerate(degrees)}
    total = made.zero
    for powers, factor in poly.items():
        term = made.ground_new(factor)
        for place, k in enumerate(used):
            term *= gens[place] ** powers[k]
        for i, degree in degrees.items():
            t = gens[halves[i]]
            c = powers[trig.index[f"cos q{i + 1}"]]
            s = powers[trig.index[f"sin q{i + 1}"]]
            term *= (1 - t**2) ** c * (2 * t) ** s * (1 + t**2) ** (degree - c - s)
        total += term
    return total, halves, degrees


def _turn_back(
    arm: SymbolicArm,
    number: Any,
    parts: list[tuple[Poly, int]],
    halves: dict[int, int],
    degrees: dict[int, int],
) -> tuple[Any, list[tuple[sympy.Expr, int]], bool]:
    """Factors in t_i, with the denominators (1 + t_i²)^{d_i} dealt out, as trigonometry again."""
    left = dict(degrees)
    pending = [part for part, power in parts for _ in range(power)]
    pending = _cancel_circles(pending, halves, left)
    pending = _join_odd(pending, halves)
    out: dict[sympy.Expr, int] = {}
    for part in pending:
        half = {i: -(-_degree(part, place) // 2) for i, place in halves.items()}
        for i, power in half.items():
            left[i] -= power
        constant, body = _as_trig(arm, part, halves, half)
        number *= constant
        if body != 1:
            out[body] = out.get(body, 0) + 1
    for i, power in left.items():  # 1/(1 + t²) = (1 + cos q)/2
        if power:
            body = 1 + sympy.cos(arm.q[i])
            out[body] = out.get(body, 0) + power
            number *= sympy.Rational(1, 2) ** power
    return number, list(out.items()), True


def _degree(part: Poly, place: int) -> int:
    degree: int = max(powers[place] for powers in part)
    return degree


def _cancel_circles(
    pending: list[Poly], halves: dict[int, int], left: dict[int, int]
) -> list[Poly]:
    """Takes factors 1 + t² out against the denominator."""
    out = []
    for part in pending:
        for i, place in halves.items():
            t = part.ring.gens[place]
            if part == t**2 + 1 and left[i]:
                left[i] -= 1
                break
        else:
            out.append(part)
    return out


def _join_odd(pending: list[Poly], halves: dict[int, int]) -> list[Poly]:
    """Multiplies factors of odd degree in some t together in pairs: (1 - t)(1 + t) is cos q."""
    out: list[Poly] = []
    odd: list[Poly] = []
    for part in pending:
        is_odd = any(_degree(part, place) % 2 for place in halves.values())
        lone_t = len(part) == 1  # t alone is sin q / 2 with one denominator
        (odd if is_odd and not lone_t else out).append(part)
    while odd:
        part = odd.pop()
        shape = [_degree(part, place) % 2 for place in halves.values()]
        other = next(
            (p for p in odd if [_degree(p, k) % 2 for k in halves.values()] == shape), None
        )
        if other is not None:
            odd.remove(other)
            part = part * other
        out.append(part)
    return out


def _as_trig(
    arm: SymbolicArm, part: Poly, halves: dict[int, int], half: dict[int, int]
) -> tuple[Any, sympy.Expr]:
    """A factor over prod (1 + t_i²)^{h_i} as number times expression.

    t^{2m} / (1+t²)^h = (1-c)^m (1+c)^{h-m} / 2^h, and an odd power brings s/2.
    """
    trig = arm.trig
    total = trig.ring.zero
    for powers, factor in part.items():
        term = trig.ring.ground_new(factor)
        for place, s in enumerate(part.ring.symbols):
            if s in trig.ring.symbols and powers[place]:
                term *= trig.ring.gens[trig.ring.symbols.index(s)] ** powers[place]
        for i, place in halves.items():
            c, s = trig.gens[f"cos q{i + 1}"], trig.gens[f"sin q{i + 1}"]
            pairs, odd = divmod(powers[place], 2)
            term *= (1 - c) ** pairs * (1 + c) ** (half[i] - pairs - odd) * s**odd
        total += term
    total = trig.reduce(total)
    content, primitive = total.primitive()
    if primitive.LC < 0:
        content, primitive = -content, -primitive
    scale = sympy.Rational(content.numerator, content.denominator)
    scale /= sympy.Integer(2) ** sum(half.values())
    return scale, arm.expression(primitive)
