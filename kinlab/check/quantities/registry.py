"""The engine's quantities by name, with an index where only some entries are meant."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from typing import Any

from kinlab.arrays import shown
from kinlab.check.quantities import (
    action,
    fivebar,
    identity,
    inverse,
    links,
    serial,
    special,
    table,
)
from kinlab.check.quantities.quantity import Quantity
from kinlab.errors import NameUnknownError, near

_MODULES = (serial, links, special, inverse, action, table, identity, fivebar)
"""Modules whose ``QUANTITIES`` belong to the list."""

_INDEXED = re.compile(r"(\w+)\[([\d:,\s-]+)\]")
_ENTRY = re.compile(r"(-?\d+)|(-?\d+)?:(-?\d+)?")


@cache
def quantities() -> dict[str, Quantity]:
    """Every quantity by name."""
    found: dict[str, Quantity] = {}
    for module in _MODULES:
        for one in module.QUANTITIES:
            if one.name in found:
                raise AssertionError(f"two quantities are named {one.name!r}")
            found[one.name] = one
    return found


def quantity(name: str) -> Quantity:
    """The quantity of a name such as ``"fk"``, ``"inverse_dynamics[0]"`` or ``"fk[:3,3]"``.

    Raises:
        NameUnknownError: no such quantity, or an index that cannot be read.
    """
    split_name(name)  # refuses what cannot be read
    return _quantity(name)


def split_name(name: str) -> tuple[str, tuple[int | slice, ...]]:
    """``"fk[:3,3]"`` as ``("fk", (slice(None, 3), 3))``.

    Raises:
        NameUnknownError: no such quantity, or an index that cannot be read.
    """
    if not isinstance(name, str):
        raise NameUnknownError(f"quantity {shown(name)} is unknown; give a name, as text")
    known = quantities()
    if name in known:
        return name, ()
    indexed = _INDEXED.fullmatch(name.strip())
    plain = indexed.group(1) if indexed else name
    if indexed is None or plain not in known:
        raise NameUnknownError(f"quantity {name!r} is unknown; {near(plain, known)}")
    return plain, tuple(_entry(text.strip(), name) for text in indexed.group(2).split(","))


@cache
def _quantity(name: str) -> Quantity:
    plain, index = split_name(name)
    whole = quantities()[plain]
    if not index:
        return whole

    def engine(mechanism: Any, *stacks: Any) -> Any:
        answer = whole.engine(mechanism, *stacks)
        try:
            return answer[(slice(None), *index)]
        except IndexError:
            raise NameUnknownError(
                f"quantity {name!r}: the index does not fit the shape {answer.shape[1:]} of "
                f"{whole.name!r}"
            ) from None

    return replace(whole, name=name, engine=engine)


def _entry(text: str, name: str) -> int | slice:
    read = _ENTRY.fullmatch(text)
    if read is None:
        raise NameUnknownError(f"quantity {name!r}: index {text!r} is no number or range")
    if read.group(1) is not None:
        return int(read.group(1))
    start, stop = (None if part is None else int(part) for part in read.groups()[1:])
    return slice(start, stop)
