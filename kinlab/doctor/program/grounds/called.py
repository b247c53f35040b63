"""What the numbers of an arm are called: a length l1, a mass m2, a moment of inertia Izz."""

from __future__ import annotations

import re

_CALLED = (
    (re.compile(r"(lc|lg|ac|com|cm|cen|rc)|(c|s)[xyz]?$"), ("centre",)),
    (re.compile(r"(i|j)[xyz]{0,2}(c|g|cm|com)?$|inert|moment|tens"), ("moment",)),
    (re.compile(r"m$|mass|payload"), ("mass",)),
    (re.compile(r"al|twist"), ("twist",)),
    (re.compile(r"[la]$|len|linkl"), ("length",)),
    (re.compile(r"[rd]$"), ("length", "centre")),
    (re.compile(r"g$|grav"), ("kept",)),
)
"""How names begin, and what is called so; the first that fits."""
_LENGTHS = {"length", "centre"}


def stem(name: str) -> str:
    """A name without its digits: ``lc`` of ``lc_2``."""
    return re.sub(r"[\d_]+", "", name).lower()


def kinds_called(name: str) -> tuple[str, ...]:
    """What may be called so; nothing where that cannot be told."""
    found: tuple[str, ...] = next(
        (kinds for begin, kinds in _CALLED if begin.match(stem(name))), ()
    )
    words = name.strip("_").split("_")
    for word in (words[0], words[-1]):  # ``A_PREV``, ``dh_d``
        found = found or (kinds_called(word) if word != name else ())
    return found


def unlike(one: str, other: str) -> bool:
    """Whether names are those of different kinds of numbers, which have no sum."""
    first, last = set(kinds_called(one)), set(kinds_called(other))
    return bool(first and last) and first.isdisjoint(last) and not first | last <= _LENGTHS
