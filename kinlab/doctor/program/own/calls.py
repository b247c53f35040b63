"""What a program calls of others, as it is run here: quicker, and without end nowhere."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

_LARGEST = 100_000
"""Numbers that an array, or an outer product, may have."""
_OBJECT = np.dtype(object)
_LONGEST = 5_000
"""Turns that a loop over numbers may have."""


def _cross(one: Any, other: Any, *rest: Any, **options: Any) -> Any:
    """numpy's cross product; of two vectors of three numbers ten times as fast."""
    if not rest and not options:
        a, b = np.asarray(one), np.asarray(other)
        if a.shape == b.shape == (3,):
            (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
            return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])
        if a.shape == b.shape == (2,) and _OBJECT in (a.dtype, b.dtype):  # numpy works in place
            return a[0] * b[1] - a[1] * b[0]
    return np.cross(one, other, *rest, **options)


def bounded_range(*bounds: int) -> range:
    """A range, but none that an edit made of so many turns: of 200 its square."""
    found = range(*bounds)
    if len(found) > _LONGEST:
        raise ValueError("a range of so many numbers")
    return found


def _outer(one: Any, other: Any, *rest: Any) -> Any:
    """numpy's outer product, but none that grows without end where an edit made it of a dot."""
    if np.size(one) * np.size(other) > _LARGEST:
        raise ValueError("an outer product of so many numbers")
    return np.outer(one, other, *rest)


def _array(*given: Any, **named: Any) -> Any:
    """numpy's array, but none that grows without end where an edit puts rows for numbers."""
    found = np.array(*given, **named)
    if found.size > _LARGEST:
        raise ValueError("an array of so many numbers")
    return found


def product(one: Any, other: Any, *rest: Any, **options: Any) -> Any:
    """numpy's product of matrices; of objects by functions that fail without harm.

    Where two of these cannot be multiplied, as a number and None, ``@`` gives one object back to
    the memory twice, and the process may end much later.
    """
    if rest or options:
        return np.matmul(one, other, *rest, **options)
    if getattr(one, "dtype", None) is not _OBJECT and getattr(other, "dtype", None) is not _OBJECT:
        return one @ other
    one, other = np.asarray(one), np.asarray(other)
    if not one.ndim or not other.ndim:
        raise ValueError("a product of matrices with a number")
    first = one if one.ndim > 1 else one[None, :]
    last = other if other.ndim > 1 else other[:, None]
    if first.shape[-1] != last.shape[-2]:
        raise ValueError("a product of matrices of other sizes")
    found = (first[..., :, :, None] * last[..., None, :, :]).sum(axis=-2)
    found = found if one.ndim > 1 else found[..., 0, :]
    return found if other.ndim > 1 else found[..., 0][()]


def multiplied(one: Any, other: Any) -> Any:
    """The same in place, as ``@=`` has it."""
    if isinstance(one, np.ndarray):
        one[...] = product(one, other)
        return one
    return product(one, other)


PRODUCTS = {"_product": product, "_multiplied": multiplied}
"""What stands for ``@`` and ``@=``, by the names under which compiled programs have it."""

QUICK = ModuleType("numpy")
QUICK.__dict__.update(np.__dict__, cross=_cross, outer=_outer, array=_array, matmul=product)


def _or_none(function: Callable[..., float]) -> Callable[..., float]:
    """One of the standard library's functions, NaN where it raises as it has no value there."""

    def asked(*given: Any) -> float:
        try:
            return function(*given)
        except ValueError:
            return math.nan

    return asked


_ROOTS = {name: _or_none(getattr(math, name)) for name in ("acos", "asin", "sqrt")}
REAL = ModuleType("math")
REAL.__dict__.update(vars(math), **_ROOTS)

CALLS: dict[int, Any] = {id(np): QUICK, id(np.cross): _cross}
CALLS |= dict.fromkeys((id(np.matmul), id(operator.matmul)), product)
"""What stands for modules and functions, by their identity."""
REAL_CALLS: dict[int, Any] = {id(math): REAL}
REAL_CALLS |= {id(getattr(math, name)): new for name, new in _ROOTS.items()}
"""The same for programs that do not catch errors themselves."""
