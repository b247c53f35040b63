"""The one reader of plain numbers in files: what it accepts, every other program reads alike.

Python's ``float`` accepts ``5_0``, Arabic digits and no-break spaces, where C++ streams read a
part or nothing; a file that passes here means the same number everywhere.
"""

from __future__ import annotations

import math
import re

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import KinlabError

BLANKS = " \t\r\n"
"""XML's white space; a no-break space is none."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?", re.ASCII)
_LONGEST = 400


def strict_number(
    word: str, where: str, error: type[KinlabError], shown: str | None = None
) -> float:
    """Reads one finite number in ASCII digits.

    Args:
        word: such as ``"-1.5e-3"``, without white space.
        where: what to put in front of a message.
        error: the class to raise.
        shown: what to show in a message; left out, the word.

    Raises:
        KinlabError: (the class given) not a number in ASCII digits, too long, or not finite.
    """
    if len(word) > _LONGEST:
        raise error(f"{where}: a number of {len(word)} characters; at most {_LONGEST}")
    shown = word if shown is None else shown[:_LONGEST]
    if word.lstrip("+-").lower() in ("nan", "inf", "infinity"):
        raise error(f"{where}: {shown!r}; every number must be finite")
    if not _NUMBER.fullmatch(word):
        kind = "is not a number" if shown == word else "are not numbers"
        raise error(f"{where}: {shown!r} {kind}; write 0.5 or 5e-1")
    value = float(word)
    if not math.isfinite(value):
        raise error(f"{where}: {shown!r}; every number must be finite")
    return value


def strict_numbers(
    text: str, count: int, where: str, error: type[KinlabError], most: float = math.inf
) -> Array:
    """Reads ``count`` numbers that stand between XML's white space.

    Args:
        text: such as ``" 0 0.5 1e-3 "``.
        count: how many.
        where, error: as for :func:`strict_number`.
        most: largest size allowed.

    Returns:
        (count,).

    Raises:
        KinlabError: (the class given) another count, or as :func:`strict_number`.
    """
    words = [word for word in re.split(f"[{BLANKS}]+", text) if word]
    if len(words) != count:
        raise error(f"{where}: {len(words)} numbers; expected {count}")
    values = np.array([strict_number(word, where, error, text.strip(BLANKS)) for word in words])
    if np.any(np.abs(values) > most):
        raise error(f"{where}: {text.strip()!r} is beyond {most:g}, more than any arm has")
    return values
