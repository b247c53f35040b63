"""Options at the door: whole numbers, seeds, plain numbers, words."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable
from typing import Any

import numpy as np

from kinlab.arrays import real_array
from kinlab.errors import NameUnknownError, OptionError, near

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
    if isinstance(value, float) and not math.isfinite(value):
        raise OptionError(f"{what} is {value}; give a finite number")
    array = real_array(value, what, OptionError)
    if array.shape != ():
        raise OptionError(f"{what} has shape {array.shape}; give one number")
    found = float(array)
    if above is not None and not found > above:
        raise OptionError(f"{what} is {found:g}; it must be above {above:g}")
    return found


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
