"""Checks of arrays at the door: shape, type, finiteness, orthonormality."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinlab.errors import KinlabError, StateError
from kinlab.tolerances import TOLERANCES

Array = NDArray[np.float64]

LARGEST = 1e100
"""Largest number that is read: the products of three of them still have a value."""


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
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
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
    with np.errstate(over="ignore"):
        result: Array = np.asarray(array, dtype=np.float64)
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


TIE = 1e-9
"""Numbers that differ by less than this share of the largest of the list are a tie: rounding,
which differs from processor to processor, must not decide which of them comes first."""


def first_largest(values: ArrayLike) -> int:
    """Index of the largest number; of several that are equal to :data:`TIE`, the first.

    Args:
        values: (N,), not empty; infinities may be among them.
    """
    array = np.asarray(values, dtype=np.float64)
    return int(np.argmax(array >= np.max(array) - _slack(array)))


def first_smallest(values: ArrayLike) -> int:
    """Index of the smallest number; ties as in :func:`first_largest`."""
    return first_largest(-np.asarray(values, dtype=np.float64))


def largest_first(values: ArrayLike) -> list[int]:
    """Indices in falling order; neighbours that are equal to :data:`TIE` keep their own order.

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
    return TIE * float(np.max(np.abs(array), where=np.isfinite(array), initial=0.0))


def frozen(array: Array) -> Array:
    """A private copy that nobody can write to."""
    copy = np.array(array, dtype=np.float64)
    copy.flags.writeable = False
    return copy
