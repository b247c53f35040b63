"""Numbers over a whole cell of the plane: value at its centre, slope, and a bound of the rest.

An :class:`Enclosed` stands for every value that a quantity takes over a cell:

    mid + slope_x s + slope_y t + rest [-1, 1]   for all s, t in [-1, 1]

(a Taylor model of first order). It takes part in numpy's arithmetic, so the formulas of this room
run on it unchanged: what holds for the numbers of a point holds for those of a cell. The rest
shrinks with the square of the cell, so that branch and bound closes its gap in a few halvings.
Rounding (1e-16 of the numbers) is not enclosed; who uses a bound widens it.

Source: Makino & Berz, "Taylor models and other validated functional inclusion methods", 2003.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from kinlab.arrays import Array
from kinlab.fivebar.arguments import cross, perpendicular
from kinlab.fivebar.geometry import Pose

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar


class Enclosed(np.lib.mixins.NDArrayOperatorsMixin):
    """An array of quantities over a cell each, or over one cell.

    Attributes:
        mid: values at the centres, (...).
        slope: change to the cell's edge in x and in y, (2, ...).
        rest: bound of what is left, (...); infinite where nothing can be said.
    """

    def __init__(self, mid: Array, slope: Array, rest: Array) -> None:
        self.mid, self.slope, self.rest = mid, slope, np.where(np.isnan(rest), np.inf, rest)

    @property
    def radius(self) -> Array:
        """How far a value may be from :attr:`mid`."""
        return np.asarray(np.abs(self.slope).sum(axis=0) + self.rest)

    @property
    def high(self) -> Array:
        """Upper bound over the cell; infinite where there is none."""
        with np.errstate(invalid="ignore", over="ignore"):  # no bound: said by infinity
            top = self.mid + self.radius
        return np.where(np.isnan(top), np.inf, top)

    @property
    def low(self) -> Array:
        """Lower bound over the cell."""
        return -(-self).high  # type: ignore[no-any-return]

    @property
    def shape(self) -> tuple[int, ...]:
        """Of :attr:`mid`."""
        return self.mid.shape

    def __getitem__(self, key: Any) -> Enclosed:
        keys = key if isinstance(key, tuple) else (key,)
        return Enclosed(self.mid[keys], self.slope[(slice(None), *keys)], self.rest[keys])

    def swapaxes(self, one: int, other: int) -> Enclosed:
        """As for arrays; axes from 0 up."""
        slope = self.slope.swapaxes(one + 1, other + 1)
        return Enclosed(self.mid.swapaxes(one, other), slope, self.rest.swapaxes(one, other))

    def reshape(self, *shape: int) -> Enclosed:
        """As for arrays."""
        slope = self.slope.reshape(2, *shape)
        return Enclosed(self.mid.reshape(shape), slope, self.rest.reshape(shape))

    def __array__(self, *args: Any, **kwargs: Any) -> Any:
        raise TypeError("a quantity over a cell is no array of numbers")

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **kwargs: Any) -> Any:
        if method != "__call__" or kwargs or ufunc not in _UFUNCS:
            return NotImplemented
        return _UFUNCS[ufunc](*inputs)

    def __array_function__(self, func: Any, types: Any, args: Any, kwargs: Any) -> Any:
        del types
        return _FUNCTIONS[func](*args, **kwargs) if func in _FUNCTIONS else NotImplemented


def _enclosed(value: Any) -> Enclosed:
    if isinstance(value, Enclosed):
        return value
    mid = np.asarray(value, dtype=np.float64)
    return Enclosed(mid, np.zeros((2, *mid.shape)), np.zeros_like(mid))


def _aligned(*values: Any) -> list[Enclosed]:
    """All with as many axes, so that the slopes broadcast as the values do."""
    each = [_enclosed(value) for value in values]
    most = max(one.mid.ndim for one in each)
    return [one.reshape(*(1,) * (most - one.mid.ndim), *one.shape) for one in each]


def _add(a: Any, b: Any) -> Enclosed:
    a, b = _aligned(a, b)
    return Enclosed(a.mid + b.mid, a.slope + b.slope, a.rest + b.rest)


def _negative(a: Enclosed) -> Enclosed:
    return Enclosed(-a.mid, -a.slope, a.rest)


def _multiply(a: Any, b: Any) -> Enclosed:
    if not isinstance(a, Enclosed):
        a, b = b, a
    if not isinstance(b, Enclosed):  # a plain factor
        (a, factor) = _aligned(a, b)
        by = factor.mid
        return Enclosed(a.mid * by, a.slope * by, a.rest * np.abs(by))
    a, b = _aligned(a, b)
    rest = np.abs(a.mid) * b.rest + np.abs(b.mid) * a.rest + a.radius * b.radius
    return Enclosed(a.mid * b.mid, a.mid * b.slope + b.mid * a.slope, rest)


def _smooth(a: Enclosed, value: Array, slope: Array, bend: Array) -> Enclosed:
    """f(a) from f and f' at the centre and a bound of |f''| over the cell."""
    rest = np.abs(slope) * a.rest + 0.5 * bend * np.square(a.radius)
    return Enclosed(value, slope * a.slope, rest)


def _reciprocal(a: Enclosed) -> Enclosed:
    near = np.abs(a.mid) - a.radius  # of the number of least size in the cell
    safe = np.where(near > 0.0, a.mid, 1.0)
    bend = np.where(near > 0.0, 2.0 / np.where(near > 0.0, near, 1.0) ** 3, np.inf)
    return _smooth(a, 1.0 / safe, -1.0 / np.square(safe), bend)


def _divide(a: Any, b: Any) -> Enclosed:
    return _multiply(a, _reciprocal(b) if isinstance(b, Enclosed) else 1.0 / np.asarray(b))


def _square(a: Enclosed) -> Enclosed:
    half = 0.5 * np.square(a.radius)  # the square of what is left lies between 0 and twice this
    return Enclosed(
        np.square(a.mid) + half, 2.0 * a.mid * a.slope, 2.0 * np.abs(a.mid) * a.rest + half
    )


def _power(a: Enclosed, exponent: int) -> Enclosed:
    return _square(a) if exponent == 2 else _multiply(a, _power(a, exponent - 1))


def _sqrt(a: Enclosed) -> Enclosed:
    low = a.mid - a.radius
    ok = low > 0.0
    root = np.sqrt(np.where(ok, a.mid, 1.0))
    bend = np.where(ok, 0.25 / np.where(ok, low, 1.0) ** 1.5, np.inf)
    return _smooth(a, root, 0.5 / root, bend)


def _hypot(a: Any, b: Any) -> Enclosed:
    """Length of (a, b): its second derivative is at most 1 / length, and its slope at most 1."""
    a, b = _aligned(a, b)
    size, reach = np.hypot(a.mid, b.mid), np.hypot(a.radius, b.radius)
    near = size - reach
    ok = near > 0.0
    over = np.where(ok, size, 1.0)
    slope = (a.mid * a.slope + b.mid * b.slope) / over
    rest = (np.abs(a.mid) * a.rest + np.abs(b.mid) * b.rest) / over
    rest = rest + 0.5 * np.square(reach) / np.where(ok, near, 1.0)
    better = ok & (rest < reach)
    zero = np.zeros_like(slope)
    return Enclosed(size, np.where(better, slope, zero), np.where(better, rest, reach))


def _maximum(a: Any, b: Any) -> Enclosed:
    """The one that is larger at the centre, plus at most what the other has over it."""
    a, b = _aligned(a, b)
    more = np.maximum(_add(b, _negative(a)).high, 0.0)
    less = np.maximum(_add(a, _negative(b)).high, 0.0)
    first = np.broadcast_to(a.mid >= b.mid, np.broadcast_shapes(a.shape, b.shape))
    excess = 0.5 * np.where(first, more, less)
    mid, rest = (np.where(first, one, other) for one, other in ((a.mid, b.mid), (a.rest, b.rest)))
    return Enclosed(mid + excess, np.where(first, a.slope, b.slope), rest + excess)


def _einsum(subscripts: str, *operands: Any) -> Enclosed:
    if len(operands) == 1:
        (a,) = operands
        slope = np.stack([np.einsum(subscripts, s) for s in a.slope])
        return Enclosed(np.einsum(subscripts, a.mid), slope, np.einsum(subscripts, a.rest))
    a, b = (_enclosed(operand) for operand in operands)

    def of(one: Array, other: Array) -> Array:
        return np.asarray(np.einsum(subscripts, one, other))

    slope = np.stack([of(a.mid, t) + of(s, b.mid) for s, t in zip(a.slope, b.slope, strict=True)])
    rest = of(np.abs(a.mid), b.rest) + of(a.rest, np.abs(b.mid)) + of(a.radius, b.radius)
    return Enclosed(of(a.mid, b.mid), slope, rest)


def _matmul(a: Any, b: Any) -> Enclosed:
    flat = len(b.shape) == 1
    return _einsum("...ij,j->...i" if flat else "...ij,...jk->...ik", a, b)


def _stack(arrays: Any, axis: int = 0) -> Enclosed:
    each = [_enclosed(array) for array in arrays]
    behind = axis if axis < 0 else axis + 1
    return Enclosed(
        np.stack([one.mid for one in each], axis=axis),
        np.stack([one.slope for one in each], axis=behind),
        np.stack([one.rest for one in each], axis=axis),
    )


def _norm(a: Enclosed, axis: int) -> Enclosed:
    """Length along the last axis, which holds two."""
    del axis
    return _hypot(a[..., 0], a[..., 1])


_UFUNCS: dict[Any, Callable[..., Enclosed]] = {
    np.add: _add,
    np.subtract: lambda a, b: _add(a, _negative(b) if isinstance(b, Enclosed) else -np.asarray(b)),
    np.negative: _negative,
    np.multiply: _multiply,
    np.divide: _divide,
    np.square: _square,
    np.power: _power,
    np.sqrt: _sqrt,
    np.hypot: _hypot,
    np.maximum: _maximum,
    np.minimum: lambda a, b: _negative(_maximum(-a, -b)),
    np.absolute: lambda a: _maximum(a, _negative(a)),
    np.matmul: _matmul,
}
_FUNCTIONS: dict[Any, Callable[..., Enclosed]] = {
    np.einsum: _einsum,
    np.stack: _stack,
    np.linalg.norm: _norm,
}


def pose_over(linkage: FiveBar, low: Array, high: Array, signs: Array) -> Pose:
    """The poses over cells, in one working mode: a :class:`Pose` of :class:`Enclosed`.

    Args:
        linkage: the five-bar.
        low, high: corners of the cells, (N, 2), m.
        signs: s_1, s_2.
    """
    half = 0.5 * (high - low)
    none = np.zeros(len(low))
    x = Enclosed(0.5 * (low + high)[:, 0], np.stack([half[:, 0], none]), none)
    y = Enclosed(0.5 * (low + high)[:, 1], np.stack([none, half[:, 1]]), none)
    return smooth_pose(linkage, np.stack([x, y], axis=1), signs)


def smooth_pose(linkage: Any, xy: Any, signs: Array) -> Pose:
    """The poses of one working mode by formulas that run on cells, and on one linkage per point.

    With c = cos psi = (d² - l1² - l2²) / (2 l1 l2) of the angle from crank to rod, the leg is
    r = (l1 + l2 c) u + l2 sin psi (k x u), which gives u; nothing but the square root of 1 - c²
    has an edge. Out of reach the numbers are NaN, and a cell's rest infinite.
    :func:`kinlab.fivebar.geometry.solve_pose` holds to rounding at the edges too.

    Args:
        linkage: l1 and l2, (2,) or (N, 2), and base_x.
        xy: places, (N, 2), m.
        signs: s_1, s_2.
    """
    l1, l2, base_x = linkage.l1, linkage.l2, linkage.base_x
    base = np.stack([base_x, np.zeros_like(base_x)], axis=-1)
    arm = xy[:, None, :] - base
    square = arm[..., 0] ** 2 + arm[..., 1] ** 2
    cosine = (square - (l1**2 + l2**2)) / (2.0 * l1 * l2)
    sine = signs * np.sqrt(1.0 - cosine**2)
    along, across = (l1 + l2 * cosine) / square, l2 * sine / square
    u = along[..., None] * arm - across[..., None] * perpendicular(arm)
    w = (arm - l1[..., None] * u) / l2[..., None]
    every = np.ones(xy.shape[0], dtype=np.bool_)
    return Pose(xy, u, w, sine, cross(w[:, 0], w[:, 1]), every, single=False, masked=False)
