"""The nearest common zero of a few functions, by branch and bound: a point, and a proved bound.

Boxes of joint space are kept by the least distance that a zero in them can have. In a box each
function is its linear part and a rest that is bounded
(:meth:`kinlab.analysis.singularities.factor.Factor.enclosures`), so that a zero lies in a slab; box
and slab give the distance (a quadratic program with one constraint, bounded from below by its
dual), and the slab cuts the box down. The box with the least distance is split next, hence the
bound grows, and the search stops where it meets the best zero found. What the local searches draw
is fixed: the same call, the same answer.

Neumaier, "Complete search in continuous global optimization and constraint satisfaction", Acta
Numerica 13, 2004, sections 11 and 14.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from kinlab.analysis.singularities.factor import Enclosures, Factor
from kinlab.arrays import Array
from kinlab.host.progress import pulse
from kinlab.tolerances import TOLERANCES

_BATCH = 192
"""Boxes split at a time."""
_SHARES = (*[1.0] * 8, *[0.5, 0.25] * 6, *[0.1] * 3)
"""Shares of the way towards the point that the steps of a local search take: whole ones are fast
where the zero set bends little, small ones converge where it bends away from the point."""
_STARTS = 48
"""Local searches before the first box is split."""


@dataclass(frozen=True)
class NearestZero:
    """Answer of :func:`nearest_zero`.

    Attributes:
        x: the best zero found, (d,), or ``None``.
        distance: its distance, infinity without one.
        bound: no zero in the box is nearer than this; infinity: there is none.
        boxes: how many boxes were bounded.
    """

    x: Array | None
    distance: float
    bound: float
    boxes: int


def nearest_zero(
    factor: Factor, here: Array, lower: Array, upper: Array, cut: float, most: int
) -> NearestZero:
    """The zero of all functions of a factor within limits that is nearest to a point.

    Args:
        factor: the functions.
        here: (d,). lower, upper: limits, (d,).
        cut: zeros farther than this are of no interest; infinity for all.
        most: boxes after which the search stops, its bound standing.

    Returns:
        The zero and the bound; both at least ``cut`` where nothing nearer is there.
    """
    search = _Search(factor, here, lower, upper, cut)
    search.try_points(search.starts())
    # nothing farther than the best zero is of interest
    reach = search.reach()
    low, high = np.maximum(lower, here - reach), np.minimum(upper, here + reach)
    if np.any(low > high):
        return NearestZero(search.best, search.distance, np.inf, 0)
    centre, half = 0.5 * (low + high)[np.newaxis], 0.5 * (high - low)[np.newaxis]
    bound, centre, half = search.bounds(centre, half)
    boxes = 1
    while len(bound) and boxes < most:
        pulse()
        order = np.argsort(bound, kind="stable")
        bound, centre, half = bound[order], centre[order], half[order]
        if bound[0] > search.reach() - TOLERANCES.distance_gap:
            break
        count = min(_BATCH, len(bound))
        more, placed, sizes = search.bounds(*_split(centre[:count], half[:count]))
        boxes += 2 * count
        if len(more):
            search.try_points(placed[np.argsort(more, kind="stable")[:4]])
        bound = np.concatenate([bound[count:], more])
        centre = np.concatenate([centre[count:], placed])
        half = np.concatenate([half[count:], sizes])
        kept = bound <= search.reach() - TOLERANCES.distance_gap
        bound, centre, half = bound[kept], centre[kept], half[kept]
    least = float(bound.min()) if len(bound) else np.inf
    return NearestZero(
        search.best, search.distance, min(least, search.reach() - TOLERANCES.distance_gap), boxes
    )


class _Search:
    """The best zero so far, and how boxes are bounded."""

    def __init__(self, factor: Factor, here: Array, lower: Array, upper: Array, cut: float) -> None:
        self.factor, self.here, self.lower, self.upper, self.cut = factor, here, lower, upper, cut
        self.best: Array | None = None
        self.distance = np.inf

    def reach(self) -> float:
        """Beyond this distance nothing is of interest."""
        return min(self.distance, self.cut)

    def starts(self) -> Array:
        """The point itself and others within the limits, half of them close by."""
        rng = np.random.default_rng(0)
        span = np.minimum(self.upper - self.lower, 2.0 * np.pi)
        near = self.here + span * (rng.random((_STARTS, len(self.here))) - 0.5)
        near[: _STARTS // 2] = self.here + 0.3 * (near[: _STARTS // 2] - self.here)
        near[0] = self.here
        return np.clip(near, self.lower, self.upper)

    def try_points(self, x: Array) -> None:
        """Local searches from x (N, d): steps to the nearest point of the linearised zero set."""
        for share in _SHARES:
            x = self._nearest_linear(x, share)
        for _ in range(4):
            x = self._nearest_linear(x, 0.0)
        values, _ = self.factor.values(x)
        good = np.abs(values).max(axis=1) <= 1e-11 + 10.0 * self.factor.slack
        if not good.any():
            return
        apart = np.linalg.norm(x[good] - self.here, axis=1)
        least = int(np.argmin(apart))
        if apart[least] < self.distance:
            self.best, self.distance = x[good][least].copy(), float(apart[least])

    def _nearest_linear(self, x: Array, share: float) -> Array:
        values, gradient = self.factor.values(x)
        towards = share * (self.here - x)
        step = np.zeros_like(x)
        fixed = np.zeros(x.shape, dtype=bool)
        for _ in range(x.shape[1]):  # joints that would leave the limits stay on them
            free = np.where(fixed[:, np.newaxis, :], 0.0, gradient)
            held = np.where(fixed, step, 0.0)
            miss = values + np.einsum("nkd,nd->nk", gradient, held)
            wanted = np.where(fixed, 0.0, towards)
            inverse = _truncated_inverse(free, self.factor.codimension)
            gap = miss + np.einsum("nkd,nd->nk", free, wanted)
            step = held + wanted - np.einsum("ndk,nk->nd", inverse, gap)
            outside = (x + step < self.lower) | (x + step > self.upper)
            new = outside & ~fixed
            if not new.any():
                break
            fixed |= new
            step = np.where(fixed, np.clip(x + step, self.lower, self.upper) - x, step)
        size = np.linalg.norm(step, axis=1, keepdims=True)
        step *= np.minimum(1.0, 0.7 / np.maximum(size, 1e-300))
        return np.clip(x + step, self.lower, self.upper)

    def bounds(self, centre: Array, half: Array) -> tuple[Array, Array, Array]:
        """Least distance (N,) of a zero in each box, and the boxes cut down; only those that may
        hold a zero of interest."""
        over = self.factor.enclosures(centre, half)
        value, gradient, rest = over.value, over.gradient, over.rest
        low, high = -half.copy(), half.copy()
        possible = np.ones(len(centre), dtype=bool)
        functions = range(value.shape[1])
        for _ in range(2):
            for k in functions:
                low, high, some = _cut_by_slab(value[:, k], gradient[:, k], rest[:, k], low, high)
                possible &= some
        apart = self.here - centre
        bound = np.linalg.norm(apart - np.clip(apart, low, high), axis=1)
        for k in functions:
            side = np.sign(value[:, k])[:, np.newaxis]
            inset = np.abs(value[:, k]) - rest[:, k]
            bound = np.maximum(
                bound, _slab_distance(apart, side * gradient[:, k], inset, low, high)
            )
        bound = np.maximum(bound, _by_curvature(over, apart, low, high, self.factor.codimension))
        kept = possible & (bound <= self.reach() - TOLERANCES.distance_gap)
        low, high, centre = low[kept], high[kept], centre[kept]
        return bound[kept], centre + 0.5 * (low + high), 0.5 * (high - low)


def _split(centre: Array, half: Array) -> tuple[Array, Array]:
    """Each box in two, across its longest side."""
    rows, side = np.arange(len(centre)), np.argmax(half, axis=1)
    size = half.copy()
    size[rows, side] *= 0.5
    left, right = centre.copy(), centre.copy()
    left[rows, side] -= size[rows, side]
    right[rows, side] += size[rows, side]
    return np.concatenate([left, right]), np.concatenate([size, size])


def _cut_by_slab(
    value: Array, gradient: Array, rest: Array, low: Array, high: Array
) -> tuple[Array, Array, Array]:
    """What of the boxes low <= x <= high has |value + gradient . x| <= rest, and where any has."""
    least = np.minimum(gradient * low, gradient * high)
    most = np.maximum(gradient * low, gradient * high)
    floor, ceiling = (-value - rest)[:, np.newaxis], (-value + rest)[:, np.newaxis]
    others_least = least.sum(axis=1, keepdims=True) - least
    others_most = most.sum(axis=1, keepdims=True) - most
    with np.errstate(divide="ignore", invalid="ignore"):
        one = (floor - others_most) / gradient
        two = (ceiling - others_least) / gradient
    flat = gradient == 0.0
    # a relative slack that rounding cannot cross
    give = 1e-12 * (1.0 + np.abs(high - low))
    new_low = np.where(flat, low, np.maximum(low, np.minimum(one, two) - give))
    new_high = np.where(flat, high, np.minimum(high, np.maximum(one, two) + give))
    inside = (least.sum(axis=1) <= ceiling[:, 0]) & (most.sum(axis=1) >= floor[:, 0])
    possible = inside & np.all(new_low <= new_high, axis=1)
    return np.minimum(new_low, new_high), np.maximum(new_low, new_high), possible


def _slab_distance(apart: Array, gradient: Array, inset: Array, low: Array, high: Array) -> Array:
    """Least |x - apart| with low <= x <= high and gradient . x <= -inset; at least from the dual.

    For every multiplier the Lagrangian is a lower bound; bisection finds a good one.
    """
    bound = np.zeros(len(apart))
    near = np.clip(apart, low, high)
    active = (inset > 0.0) & (np.einsum("nd,nd->n", gradient, near) + inset > 0.0)
    if not active.any():
        return bound
    p, g, c = apart[active], gradient[active], inset[active]
    lo, hi = low[active], high[active]
    small, large = np.zeros(len(p)), np.full(len(p), 1e-3)
    for _ in range(40):  # a multiplier that is large enough, or as large as helps
        x = np.clip(p - large[:, np.newaxis] * g, lo, hi)
        short = np.einsum("nd,nd->n", g, x) + c > 0.0
        if not short.any():
            break
        large = np.where(short, 2.0 * large, large)
    for _ in range(24):
        middle = 0.5 * (small + large)
        x = np.clip(p - middle[:, np.newaxis] * g, lo, hi)
        short = np.einsum("nd,nd->n", g, x) + c > 0.0
        small, large = np.where(short, middle, small), np.where(short, large, middle)
    x = np.clip(p - small[:, np.newaxis] * g, lo, hi)
    value = np.einsum("nd,nd->n", x - p, x - p) + 2.0 * small * (np.einsum("nd,nd->n", g, x) + c)
    bound[active] = np.sqrt(np.maximum(value, 0.0)) * (1.0 - 1e-12)
    return bound


def _by_curvature(
    over: Enclosures, apart: Array, low: Array, high: Array, codimension: int
) -> Array:
    """Least distance from the Lagrangian |x - apart|^2 + lambda . f, to second order.

    On zeros of f it is the squared distance whatever lambda is; where its quadratic part is convex
    the least value is known, and what is left out is of third order.
    """
    d = apart.shape[1]
    wanted = np.einsum("nkd,nd->nk", over.gradient, apart) + over.value
    inverse = _truncated_inverse(over.gradient, codimension)
    multiplier = 2.0 * np.einsum("ndk,ndl,nl->nk", inverse, inverse, wanted)
    derivative = np.einsum("nk,nkd->nd", multiplier, over.gradient) - 2.0 * apart
    curve = 2.0 * np.eye(d) + np.einsum("nk,nkde->nde", multiplier, over.hessian)
    constant = (
        np.einsum("nd,nd->n", apart, apart)
        + np.einsum("nk,nk->n", multiplier, over.value)
        - np.einsum("nk,nk->n", np.abs(multiplier), over.second)
    )
    least = np.linalg.eigvalsh(curve)[:, 0]
    convex = least > 1e-3
    safe = np.where(convex[:, np.newaxis, np.newaxis], curve, np.eye(d))
    free = -0.5 * np.einsum(
        "nd,nd->n", derivative, np.linalg.solve(safe, derivative[..., np.newaxis])[..., 0]
    )
    # joint by joint, with the least curvature for all: better where the limits hold the point
    mu = np.where(convex, least, 1.0)[:, np.newaxis]
    x = np.clip(-derivative / mu, low, high)
    boxed = np.sum(derivative * x + 0.5 * mu * x**2, axis=1)
    value = constant + np.maximum(free, boxed)
    value -= 1e-13 * (
        np.abs(constant) + np.einsum("nk,nk->n", np.abs(multiplier), np.abs(over.value))
    )
    return np.sqrt(np.where(convex, np.maximum(value, 0.0), 0.0)) * (1.0 - 1e-12)


def _truncated_inverse(gradient: Array, rank: int) -> Array:
    """Pseudo-inverses (N, d, k) of gradients (N, k, d), at most of the given rank."""
    if gradient.shape[1] == 1:
        size = np.maximum(np.einsum("nkd,nkd->n", gradient, gradient), 1e-300)
        alone: Array = gradient.swapaxes(1, 2) / size[:, np.newaxis, np.newaxis]
        return alone
    left, sizes, right = np.linalg.svd(gradient, full_matrices=False)
    kept = sizes > 1e-9 * np.maximum(sizes[:, :1], 1e-300)
    kept[:, rank:] = False
    inverse = np.divide(1.0, sizes, out=np.zeros_like(sizes), where=kept)
    out: Array = np.einsum("nrd,nr,nkr->ndk", right, inverse, left)
    return out
