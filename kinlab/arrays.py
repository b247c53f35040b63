"""Checks at the door: arrays by shape, type and finiteness; options by type and range."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinlab.errors import KinlabError, NameUnknownError, OptionError, StateError, near
from kinlab.tolerances import TOLERANCES

# -------- Checks of arrays at the door: shape, type, finiteness, orthonormality

Array = NDArray[np.float64]

LARGEST = 1e100
"""Largest number that is read: the products of three of them still have a value."""

_BLOCK = 8192
"""Numbers up to which BLAS stays on the calling thread."""


def sum_of_squares(array: Array) -> float:
    """The sum of the squares of all entries; NaN or infinite where one is.

    Block by block: for more than 10,000 numbers BLAS starts threads of its own, and where another
    thread forks in the middle of that, parent and child wait for ever.

    Args:
        array: of any shape.
    """
    flat = array.reshape(-1)
    if len(flat) <= _BLOCK:
        return float(np.vdot(flat, flat))
    blocks = (flat[first : first + _BLOCK] for first in range(0, len(flat), _BLOCK))
    return float(sum(np.vdot(block, block) for block in blocks))


def real_array(value: ArrayLike, what: str, error: type[KinlabError] = StateError) -> Array:
    """Reads real numbers as float64 and refuses everything else, NaN and infinity included.

    Args:
        value: anything numpy reads as an array of real numbers.
        what: how to name it in a message, such as ``"robot 'ur5': q"``.
        error: the class to raise.

    Returns:
        A float64 array (the same object where nothing had to change).

    Raises:
        KinlabError: (the class given) complex, boolean, text, ragged or masked input, NaN,
            infinity, or a number beyond :data:`LARGEST`.
    """
    masked = type(value) is not np.ndarray and isinstance(value, np.ma.MaskedArray)
    if masked and np.ma.is_masked(value):
        raise error(f"{what}: masked entries have no value; fill them in")
    try:
        array = np.asarray(value)
    except ValueError as problem:
        raise error(f"{what}: rows of unequal length ({problem})") from None
    except Exception as problem:  # noqa: BLE001  whatever an object's own __array__ raises
        why = f"{type(value).__name__} cannot be read as numbers ({type(problem).__name__})"
        raise error(f"{what}: {why}") from None
    if array.dtype.kind not in "iuf":
        raise error(f"{what}: dtype {array.dtype} is not real numbers")
    if array.dtype.itemsize <= 8:
        result: Array = np.asarray(array, dtype=np.float64)
    else:  # of longer floats, the largest are infinite here
        with np.errstate(over="ignore"):
            result = np.asarray(array, dtype=np.float64)
    if sum_of_squares(result) <= LARGEST:  # then every |x| is; half the cost of comparing each
        return result
    fine = np.abs(result) <= LARGEST  # false for NaN
    if not fine.all():
        place = tuple(int(i) for i in np.argwhere(~fine)[0])
        where = f" at index {place[0] if len(place) == 1 else place}" if place else ""
        rule = "every entry must be finite"
        if np.isfinite(result[place]):
            rule = f"beyond {LARGEST:g} products overflow"
        raise error(f"{what}: {array[place]}{where}; {rule}")
    return result


def shaped(
    value: ArrayLike,
    shape: tuple[int, ...],
    what: str,
    error: type[KinlabError] = StateError,
) -> Array:
    """As :func:`real_array`, and the shape must be the one given."""
    array = real_array(value, what, error)
    if array.shape != shape:
        raise error(f"{what}: shape {array.shape}; expected {shape}")
    return array


def rigid_transform(value: ArrayLike, what: str, error: type[KinlabError] = StateError) -> Array:
    """Reads homogeneous transforms of shape (..., 4, 4) and checks that they are rigid.

    Args:
        value: the transform or transforms.
        what: how to name it in a message.
        error: the class to raise.

    Returns:
        float64 array of the same shape.

    Raises:
        KinlabError: (the class given) wrong shape, last row not 0 0 0 1, rotation not
            orthonormal (says by how much), or a mirror (determinant -1).
    """
    array = real_array(value, what, error)
    if array.ndim < 2 or array.shape[-2:] != (4, 4):
        raise error(f"{what}: shape {array.shape}; expected (4, 4)")
    if not np.array_equal(
        array[..., 3, :], np.broadcast_to([0.0, 0.0, 0.0, 1.0], array[..., 3, :].shape)
    ):
        raise error(f"{what}: the last row must be 0 0 0 1")
    rotation = array[..., :3, :3]
    miss = float(np.max(np.abs(np.swapaxes(rotation, -1, -2) @ rotation - np.eye(3)), initial=0.0))
    if miss > TOLERANCES.orthonormal:
        raise error(
            f"{what}: the rotation is not orthonormal, R^T R misses 1 by {miss:.3g} "
            f"(at most {TOLERANCES.orthonormal:g})"
        )
    if np.any(np.linalg.det(rotation) < 0):
        raise error(f"{what}: the rotation is a mirror (determinant -1); it must be +1")
    return array


def first_largest(values: ArrayLike) -> int:
    """Index of the largest number; of several within ``TOLERANCES.tie``, the first.

    Args:
        values: (N,), not empty; infinities may be among them.
    """
    array = np.asarray(values, dtype=np.float64)
    return int(np.argmax(array >= np.max(array) - _slack(array)))


def first_smallest(values: ArrayLike) -> int:
    """Index of the smallest number; ties as in :func:`first_largest`."""
    return first_largest(-np.asarray(values, dtype=np.float64))


def largest_first(values: ArrayLike) -> list[int]:
    """Indices in falling order; neighbours within ``TOLERANCES.tie`` keep their own order.

    Args:
        values: (N,), finite.
    """
    array = np.asarray(values, dtype=np.float64)
    order = np.argsort(-array, kind="stable")
    group = np.cumsum(-np.diff(array[order], prepend=np.inf) > _slack(array))
    return [int(k) for k in order[np.lexsort((order, group))]]


def smallest_first(values: ArrayLike) -> list[int]:
    """Indices in rising order; ties as in :func:`largest_first`."""
    return largest_first(-np.asarray(values, dtype=np.float64))


def _slack(array: Array) -> float:
    return TOLERANCES.tie * float(np.max(np.abs(array), where=np.isfinite(array), initial=0.0))


def between(x: ArrayLike, low: ArrayLike, high: ArrayLike, slack: ArrayLike = 0.0) -> Any:
    """Whether each number lies between its bounds, widened by ``slack``; shaped as they are."""
    return (np.subtract(low, slack) <= x) & (x <= np.add(high, slack))


def set_fields(record: object, **values: Any) -> None:
    """Sets fields of a frozen dataclass while it is being made: for ``__post_init__`` only.

    What was given is replaced by what was read from it (a list by a frozen array, an int by a
    float), and fields that follow from the others are filled in.
    """
    for name, value in values.items():
        object.__setattr__(record, name, value)


def frozen(array: Array) -> Array:
    """A private copy that nobody can write to."""
    copy = np.array(array, dtype=np.float64)
    copy.flags.writeable = False
    return copy


# -------- Options at the door: whole numbers, seeds, plain numbers, words

MOST = 10**9
"""Largest count; no search or sample of this package could use more."""


def shown(value: object, longest: int = 60) -> str:
    """How to show any object in a message, even one that cannot show itself."""
    try:
        text = repr(value)
    except Exception:  # noqa: BLE001  whatever an object's own __repr__ raises
        text = f"<{type(value).__name__}>"
    return text if len(text) <= longest else f"{text[:longest]}..."


def whole(value: Any, what: str, least: int = 1, most: int = MOST) -> int:
    """Reads a whole number.

    Args:
        value: an int, or a numpy integer.
        what: how to name it in a message.
        least, most: its range.

    Raises:
        OptionError: of another type, or out of range.
    """
    number: int | None = None
    if not isinstance(value, (bool, np.bool_)):
        try:
            number = operator.index(value)
        except Exception:  # noqa: BLE001  whatever an object's own __index__ raises
            number = None
    if number is None or not least <= number <= most:
        raise OptionError(
            f"{what} is {shown(value)}; give a whole number from {least}"
            + (f" to {most}" if most != MOST else " up")
        )
    return number


def seed_of(value: Any, what: str = "seed") -> int:
    """Reads a seed: a whole number from 0 up, of any size.

    Raises:
        OptionError: anything else, None included: the same seed must give the same answer.
    """
    return whole(value, what, 0, 1 << 256)


def number(value: Any, what: str, *, above: float | None = None) -> float:
    """Reads one finite real number as a plain float.

    Args:
        value: the number.
        what: how to name it in a message.
        above: it must be larger than this.

    Raises:
        OptionError: not one real number, not finite, or not above.
    """
    if type(value) is float and math.isfinite(value) and (above is None or value > above):
        return value
    if isinstance(value, float) and not math.isfinite(value):
        raise OptionError(f"{what} is {value}; give a finite number")
    array = real_array(value, what, OptionError)
    if array.shape != ():
        raise OptionError(f"{what} has shape {array.shape}; give one number")
    found = float(array)
    if above is not None and not found > above:
        raise OptionError(f"{what} is {found}; it must be above {above:g}")
    return found


def truth(value: Any, what: str, error: type[KinlabError] = OptionError) -> bool:
    """Reads true or false.

    Raises:
        KinlabError: (the class given) anything else.
    """
    if not isinstance(value, (bool, np.bool_)):
        raise error(f"{what} is {shown(value)}; give True or False")
    return bool(value)


def word(value: Any, valid: Iterable[str], what: str) -> str:
    """Reads a name out of several.

    Raises:
        NameUnknownError: no such name; near ones are listed.
    """
    names = list(valid)
    if not isinstance(value, str) or value not in names:
        near_ones = near(value, names) if isinstance(value, str) else near("", names)
        raise NameUnknownError(f"{what} {shown(value)} is unknown; {near_ones}")
    return value
