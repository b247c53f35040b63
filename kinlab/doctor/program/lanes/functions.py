"""What a program calls of numpy and the standard library, for numbers with lanes."""

from __future__ import annotations

import cmath
import functools
import math
from collections.abc import Callable
from contextlib import suppress
from types import ModuleType
from typing import Any

import numpy as np

from kinlab.doctor.program.lanes.numbers import Laned, Lanes, values_in
from kinlab.doctor.program.own.calls import QUICK, REAL, product

_OF_ONE = (
    *("sin", "cos", "tan", "arcsin", "arccos", "arctan"),
    *("sinh", "cosh", "tanh", "arcsinh", "arccosh", "arctanh", "exp", "log", "sqrt", "cbrt"),
    *("square", "sign", "conj", "conjugate", "real", "imag", "angle", "abs", "absolute", "fabs"),
    *("deg2rad", "radians", "rad2deg", "degrees"),
)
_OF_TWO = (
    *("minimum", "maximum", "fmin", "fmax", "arctan2", "hypot", "copysign"),
    *("power", "float_power", "divide", "true_divide", "mod"),
)
_MATH = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "phase": "angle"}
_MATH_OF_TWO = {
    "atan2": "arctan2",
    "hypot": "hypot",
    "pow": "power",
    "fmod": "fmod",
    "copysign": "copysign",
}
_MADE = (
    *("zeros", "ones", "empty", "zeros_like", "ones_like", "empty_like"),
    *("eye", "identity", "full", "full_like"),
)
_ARRAYS = ("array", "asarray", "ascontiguousarray", "asanyarray")
PARTS = ("real", "imag")
"""Parts of complex numbers."""
_AS_FLOAT = (float, np.float64, "float", "float64", "d", complex, "complex")


def with_lanes(space: dict[str, Any]) -> dict[str, Any]:
    """What the names of a program stand for where its numbers have lanes.

    Args:
        space: what they stand for now.
    """
    library = _module(QUICK, _NUMPY | {"linalg": _module(np.linalg, _LINEAR)})
    known: dict[int, Any] = {id(QUICK): library, id(np): library}
    known[id(np.linalg)] = library.linalg
    known[id(math)] = known[id(REAL)] = _module(REAL, _OF_MATH)
    known[id(cmath)] = _module(cmath, _OF_COMPLEX)
    made: list[tuple[ModuleType, dict[str, Any]]]
    made = [(np, _NUMPY), (QUICK, _NUMPY), (np.linalg, _LINEAR)]
    made += [(math, _OF_MATH), (REAL, _OF_MATH), (cmath, _OF_COMPLEX)]
    for module, own in made:
        known |= {id(getattr(module, name)): new for name, new in own.items()
                  if hasattr(module, name)}  # fmt: skip
    new = {name: known[id(value)] for name, value in space.items() if id(value) in known}
    own = {"float": _Float, "complex": _Complex, "min": _LEAST, "max": _MOST}
    return {name: one for name, one in own.items() if name not in space} | new


def part_of(value: Any, name: str) -> Any:
    """What ``value.imag`` is, of an array of numbers with lanes, too."""
    laned = isinstance(value, np.ndarray) and value.dtype == object
    return _NUMPY[name](value) if laned else getattr(value, name)


def room_for(array: Any, value: Any) -> Any:
    """An array of numbers, as one that takes numbers with lanes where such are put into it."""
    plain = isinstance(array, np.ndarray) and array.dtype.kind in "fc"
    return array.astype(object) if plain and _laned(value) else array


class _Number(type):
    """What stands for a type of numbers: one with lanes is of it already."""

    plain: type

    def __call__(cls, *given: Any) -> Any:
        if any(isinstance(one, Laned) for one in given):
            return given[0] if len(given) == 1 else given[0] + 1j * given[1]
        return cls.plain(*given)

    def __instancecheck__(cls, value: object) -> bool:
        return isinstance(value, cls.plain)


class _Float(metaclass=_Number):
    plain = float


class _Complex(metaclass=_Number):
    plain = complex


def _module(old: ModuleType, own: dict[str, Any]) -> Any:
    new = ModuleType(old.__name__)
    new.__dict__.update(vars(old), **own)
    return new


def _laned(value: Any) -> bool:
    """Whether a value holds objects, as numbers with lanes are."""
    if isinstance(value, np.ndarray):
        return bool(value.dtype == object)
    if isinstance(value, list | tuple):
        return any(map(_laned, value))
    return isinstance(value, Laned)


def _of_one(function: Callable[[Any], Any], plain: Callable[..., Any]) -> Any:
    """A function of each number; of those without lanes what it is anyway."""

    def each(value: Any) -> Any:
        return value.of(function) if isinstance(value, Laned) else function(value)

    def asked(value: Any, *rest: Any, **named: Any) -> Any:
        if isinstance(value, Laned):
            return value.of(function)
        if _laned(value):
            return np.frompyfunc(each, 1, 1)(np.array(value, dtype=object))
        return plain(value, *rest, **named)

    return asked


def _of_two(function: Callable[[Any, Any], Any], plain: Callable[..., Any]) -> Any:
    def each(one: Any, other: Any) -> Any:
        laned = one if isinstance(one, Laned) else other
        if not isinstance(laned, Laned):
            return function(one, other)
        lanes = laned.lanes
        lanes.work += lanes.here.size // 8
        values = function(values_in(one, lanes.here), values_in(other, lanes.here))
        return Laned(values, lanes, lanes.here)

    def asked(one: Any, other: Any, *rest: Any, **named: Any) -> Any:
        if isinstance(one, Laned) or isinstance(other, Laned):
            if not (isinstance(one, np.ndarray | list) or isinstance(other, np.ndarray | list)):
                return each(one, other)
        elif not (_laned(one) or _laned(other)):
            return plain(one, other, *rest, **named)
        entries = (np.array(x, dtype=object) for x in (one, other))
        return np.frompyfunc(each, 2, 1)(*entries)

    return asked


def _extreme(function: Callable[[Any, Any], Any], plain: Callable[..., Any]) -> Any:
    """The least, or the most, of several numbers, in each lane."""
    two = _of_two(function, plain)

    def asked(*given: Any, **named: Any) -> Any:
        several = given[0] if len(given) == 1 else given
        several = [*several] if isinstance(several, np.ndarray | list | tuple) else several
        if named or not isinstance(several, list | tuple) or not _laned(several):
            return plain(*given, **named)
        return functools.reduce(two, several)

    return asked


def _where(which: Any, *rest: Any) -> Any:
    """numpy's choice by a condition, in each lane."""
    if len(rest) < 2 or not any(map(_laned, (which, *rest))):
        return np.where(which, *rest)

    def each(yes: Any, one: Any, other: Any) -> Any:
        lanes = _lanes_of(yes, one, other)
        if lanes is None:
            return one if yes else other
        here = lanes.here
        lanes.work += here.size // 8
        values = np.where(*(values_in(x, here) for x in (yes, one, other)))
        return Laned(values, lanes, here) if values.ndim else values[()]

    entries = [np.array(x, dtype=object) for x in (which, *rest)]
    return np.frompyfunc(each, 3, 1)(*entries)


def _clip(value: Any, least: Any = None, most: Any = None, *rest: Any, **named: Any) -> Any:
    """numpy's clip, in each lane."""
    if rest or named or not any(map(_laned, (value, least, most))):
        return np.clip(value, least, most, *rest, **named)
    value = value if least is None else _NUMPY["maximum"](value, least)
    return value if most is None else _NUMPY["minimum"](value, most)


def _type(value: Any) -> Any:
    return value.plain if isinstance(value, _Number) else value


def _object(plain: Callable[..., Any]) -> Any:
    """A new array that takes numbers with lanes."""

    def asked(*given: Any, **named: Any) -> Any:
        given = tuple(map(_type, given))
        found = plain(*given, **{name: _type(value) for name, value in named.items()})
        return found.astype(object) if found.dtype.kind in "fc" else found

    return asked


def _array(plain: Callable[..., Any]) -> Any:
    """An array of what may have lanes."""

    def asked(value: Any, *rest: Any, **named: Any) -> Any:
        rest = tuple(map(_type, rest))
        named = {name: _type(one) for name, one in named.items()}
        if not _laned(value):
            return plain(value, *rest, **named)
        kind = rest[0] if rest else named.pop("dtype", float)
        if kind is not None and kind is not object and kind not in _AS_FLOAT:
            raise TypeError("numbers with lanes are of no other type")
        return np.array(value, dtype=object, **named)

    return asked


def _stacked(lanes: Lanes, value: Any) -> Any:
    """An array with the lanes in front."""
    here = lanes.here
    array = np.array(value, dtype=object)
    found = np.empty((here.size, array.size))
    for k, entry in enumerate(array.ravel()):
        found[:, k] = values_in(entry, here)
    lanes.work += found.size // 4
    return found.reshape(here.size, *array.shape)


def _apart(lanes: Lanes, stack: Any) -> Any:
    """An array of numbers with lanes, of one with the lanes in front."""
    flat = stack.reshape(len(stack), -1).T
    found = np.empty(len(flat), dtype=object)
    for k, values in enumerate(flat):
        found[k] = Laned(np.ascontiguousarray(values), lanes, lanes.here)
    return found.reshape(stack.shape[1:]) if stack.ndim > 1 else found[0]


def _lanes_of(*values: Any) -> Lanes | None:
    for value in values:
        if isinstance(value, Laned):
            return value.lanes
        if isinstance(value, np.ndarray | list | tuple):
            entries = value.ravel() if isinstance(value, np.ndarray) else value
            found = _lanes_of(*entries) if _laned(value) else None
            if found is not None:
                return found
    return None


def _linear(plain: Callable[..., Any]) -> Any:
    """A function of matrices, of each lane's."""

    def asked(*given: Any, **named: Any) -> Any:
        lanes = _lanes_of(*given)
        if lanes is None:
            numbers = [np.array(x, dtype=float) if _laned(x) else x for x in given]
            return plain(*numbers, **named)
        stacks = [_stacked(lanes, x) for x in given]
        vectors = len(stacks) == 2 and stacks[1].ndim == 2
        if vectors:
            stacks[1] = stacks[1][..., None]
        try:
            found = plain(*stacks, **named)
        except np.linalg.LinAlgError:
            found = _one_by_one(lanes, plain, stacks, named)
        if isinstance(found, tuple):
            return tuple(_apart(lanes, one) for one in found)
        return _apart(lanes, found[..., 0] if vectors else found)

    return asked


def _one_by_one(
    lanes: Lanes, plain: Callable[..., Any], stacks: list[Any], named: dict[str, Any]
) -> Any:
    """The same where the matrix of some lane is singular: this lane is lost.

    Raises:
        LinAlgError: it is so in every lane.
    """
    found: dict[int, Any] = {}
    for k, given in enumerate(zip(*stacks, strict=True)):
        with suppress(np.linalg.LinAlgError):
            found[k] = plain(*given, **named)
    if not found:
        raise np.linalg.LinAlgError
    lanes.work += 10 * len(stacks[0])
    lost = np.ones(len(stacks[0]), dtype=bool)
    lost[[*found]] = False
    lanes.lose(lanes.here, lost)
    some = next(iter(found.values()))
    if isinstance(some, tuple):
        every = [found.get(k, some) for k in range(len(lost))]
        return tuple(np.stack(one) for one in zip(*every, strict=True))
    return np.stack([found.get(k, some) for k in range(len(lost))])


def _norm(value: Any, *rest: Any, **named: Any) -> Any:
    axis = named.get("axis")
    if not _laned(value) or rest or {*named} - {"axis"} or isinstance(axis, tuple):
        return np.linalg.norm(value, *rest, **named)
    array = np.array(value, dtype=object)
    squares = np.frompyfunc(lambda x: abs(x) ** 2, 1, 1)(array)
    return _NUMPY["sqrt"](sum(squares.ravel()) if axis is None else squares.sum(axis=axis))


def _power(matrix: Any, count: int) -> Any:
    if not _laned(matrix) or count < 1:
        return np.linalg.matrix_power(matrix, count)
    return _dot_of_all([matrix] * count)


def _dot_of_all(matrices: Any) -> Any:
    return functools.reduce(product, map(np.asarray, matrices))


def _with_float(plain: Callable[..., Any]) -> Any:
    return lambda value, *rest: value if isinstance(value, Laned) else plain(value, *rest)


_NUMPY: dict[str, Any] = {
    **{name: _of_one(getattr(np, name), getattr(np, name)) for name in _OF_ONE},
    **{name: _of_two(getattr(np, name), getattr(np, name)) for name in _OF_TWO},
    **{name: _object(getattr(np, name)) for name in _MADE},
    **{name: _array(getattr(np, name)) for name in _ARRAYS},
    "float64": _with_float(np.float64),
    "clip": _clip,
    "where": _where,
}
_LEAST, _MOST = _extreme(np.minimum, min), _extreme(np.maximum, max)
_OF_COMPLEX: dict[str, Any] = {
    name: _of_one(getattr(np, _MATH.get(name, name)), getattr(cmath, name))
    for name in (*_OF_ONE, *_MATH)
    if hasattr(cmath, name)
}
_OF_MATH: dict[str, Any] = {
    **_OF_COMPLEX,
    **{
        name: _of_one(getattr(np, _MATH.get(name, name)), getattr(REAL, name))
        for name in (*_OF_ONE, *_MATH)
        if hasattr(REAL, name)
    },
    **{name: _of_two(getattr(np, own), getattr(math, name)) for name, own in _MATH_OF_TWO.items()},
}
_OF_MATRICES = ("inv", "solve", "pinv", "det", "svd", "eig", "eigh", "eigvals", "eigvalsh", "qr")
_LINEAR: dict[str, Any] = {
    **{name: _linear(getattr(np.linalg, name)) for name in _OF_MATRICES},
    "norm": _norm,
    "matrix_power": _power,
    "multi_dot": _dot_of_all,
}
