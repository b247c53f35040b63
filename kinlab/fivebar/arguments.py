"""What the functions of a five-bar are given: points of the plane, modes, how to refuse."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinlab.arrays import Array, real_array, shown
from kinlab.errors import OptionError, StateError

Mode = Sequence[int] | Array
OnUnreachable = Literal["raise", "mask"]
Mask = NDArray[np.bool_]

HANGING: Mode = (-1, 1)
"""The default working mode: elbows outward with the tool below the base, as Huang's robot."""

MODES: tuple[tuple[int, int], ...] = ((1, 1), (1, -1), (-1, 1), (-1, -1))


JOINTS = ("crank_1", "elbow_1", "crank_2", "elbow_2")
"""Names of the four joints of the tree that the loop is cut into."""


def restore_shape(result: Array, ok: Mask, *, single: bool, masked: bool) -> Array:
    """Masks the rows that are not ok if the caller wants that, and drops the axis of one point."""
    if masked:
        hidden = ~ok.reshape((-1,) + (1,) * (result.ndim - 1))
        result = np.ma.masked_array(result, np.broadcast_to(hidden, result.shape).copy())
    return result[0] if single else result


def read_points(value: ArrayLike, what: str) -> tuple[Array, bool]:
    """Reads (2,) or (N, 2) as (N, 2), and says whether it was one point.

    Raises:
        StateError: another shape, not numbers, not finite.
    """
    points = real_array(value, what)
    if points.ndim not in (1, 2) or points.shape[-1] != 2:
        raise StateError(f"{what} has shape {points.shape}; expected (2,) or (N, 2)")
    return np.atleast_2d(points), points.ndim == 1


def read_vectors(value: ArrayLike, count: int, what: str) -> Array:
    """Reads ``count`` vectors of the plane; a single (2,) serves for all of them.

    Raises:
        StateError: another shape, not numbers, not finite.
    """
    vectors, _ = read_points(value, what)
    if len(vectors) not in (1, count):
        raise StateError(f"{what} has {len(vectors)} rows; there are {count} points")
    return np.broadcast_to(vectors, (count, 2))


def read_mode(mode: Mode) -> Array:
    """Reads a working mode as two signs.

    Raises:
        OptionError: not a pair of +1 and -1.
    """
    try:
        signs = np.asarray(mode)
    except Exception:  # noqa: BLE001  whatever an object's own __array__ raises
        signs = np.empty(0)
    if signs.shape != (2,) or signs.dtype.kind not in "if" or not np.all(np.abs(signs) == 1):
        raise OptionError(
            f"mode {shown(mode)} does not exist; choose one of {', '.join(map(str, MODES))}: "
            "the signs of u_1 x w_1 and u_2 x w_2"
        )
    return signs.astype(np.float64)


def read_assembly(assembly: int) -> int:
    """Reads an assembly mode, the sign of w_1 x w_2.

    Raises:
        OptionError: not +1 or -1.
    """
    if not isinstance(assembly, (int, np.integer)) or assembly not in (1, -1) or assembly is True:
        raise OptionError(f"assembly {shown(assembly)} does not exist; choose +1 or -1")
    return int(assembly)


def read_signs(mode: str) -> tuple[int, int]:
    """Reads ``-+`` and the like.

    Raises:
        OptionError: anything but two signs.
    """
    if len(mode) != 2 or set(mode) - {"+", "-"}:
        raise OptionError(f"mode {mode!r} does not exist; choose one of ++, +-, -+, --")
    first, second = (1 if sign == "+" else -1 for sign in mode)
    return first, second


def read_on_unreachable(choice: str) -> bool:
    """True for ``"mask"``, false for ``"raise"``.

    Raises:
        OptionError: anything else.
    """
    if not isinstance(choice, str) or choice not in ("raise", "mask"):
        raise OptionError(f'on_unreachable is {shown(choice)}; choose "raise" or "mask"')
    return choice == "mask"


def cross(a: Array, b: Array) -> Array:
    """k · (a x b) of plane vectors along the last axis."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def perpendicular(a: Array) -> Array:
    """k x a: plane vectors along the last axis, turned by +90 degrees."""
    return np.stack([-a[..., 1], a[..., 0]], axis=-1)
