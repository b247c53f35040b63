"""The one reader of plain numbers in files: what it accepts, every other program reads alike.

Python's ``float`` accepts ``5_0``, Arabic digits and no-break spaces, where C++ streams read a
part or nothing; a file that passes here means the same number everywhere.
"""

from __future__ import annotations

import re

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import KinlabError

_BLANKS = " \t\r\n"
"""XML's white space; a no-break space is none."""

_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?", re.ASCII)
_LONGEST = 400


def strict_numbers(text: str, count: int, where: str, error: type[KinlabError]) -> Array:
    """Reads ``count`` finite numbers in ASCII digits that stand between XML's white space.

    Args:
        text: such as ``" 0 0.5 -1e-3 "``.
        count: how many.
        where: what to put in front of a message.
        error: the class to raise.

    Returns:
        (count,).

    Raises:
        KinlabError: (the class given) another count, or a word that is not a number in ASCII
            digits, too long, or not finite.
    """
    words = [word for word in re.split(f"[{_BLANKS}]+", text) if word]
    if len(words) != count:
        raise error(f"{where}: {len(words)} numbers; expected {count}")
    shown = text.strip(_BLANKS)[:_LONGEST]
    for word in words:
        if len(word) > _LONGEST:
            raise error(f"{where}: a number of {len(word)} characters; at most {_LONGEST}")
        if word.lstrip("+-").lower() in ("nan", "inf", "infinity"):
            raise error(f"{where}: {shown!r}; every number must be finite")
        if not _NUMBER.fullmatch(word):
            kind = "is not a number" if shown == word else "are not numbers"
            raise error(f"{where}: {shown!r} {kind}; write 0.5 or 5e-1")
    values = np.array([float(word) for word in words])
    if not np.isfinite(values).all():
        raise error(f"{where}: {shown!r}; every number must be finite")
    return values
