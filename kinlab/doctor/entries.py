"""The single entries of an answer, with the index they have in the whole quantity."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.compare import error_sizes
from kinlab.check.quantities import quantity as find_quantity
from kinlab.doctor.changes import Case
from kinlab.tolerances import TOLERANCES

_INDEX = re.compile(r"(\w+)\[([\d:,\s-]+)\]")


@dataclass(frozen=True, eq=False)
class Entry:
    """One number of an answer over all states.

    Attributes:
        label: ``"inverse_dynamics[0]"``.
        index: place in the whole quantity. local: place in the hand formula's answer.
        hand, engine: (N,).
        scale: what errors are relative to: the size of the whole answer, (N,).
    """

    label: str
    index: tuple[int, ...]
    local: tuple[int, ...]
    hand: Array
    engine: Array
    scale: Array

    @property
    def agrees(self) -> bool:
        """Whether this entry is right, to rounding."""
        return self.error(self.hand, self.engine) <= TOLERANCES.formula_agrees

    def error(self, one: Array, two: Array) -> float:
        """Largest difference relative to the size of the answer."""
        gap = np.abs(one - two)
        return float(np.max(np.where(np.isfinite(gap), gap, np.inf) / self.scale))


def split_name(name: str) -> tuple[str, tuple[Any, ...]]:
    """``"fk[:3,3]"`` as ``("fk", (slice(None, 3), 3))``.

    Raises:
        NameUnknownError: no such quantity, or an index that cannot be read.
    """
    find_quantity(name)  # refuses what cannot be read
    found = _INDEX.fullmatch(name.strip())
    if found is None:
        return name, ()
    return found.group(1), tuple(_one(text.strip()) for text in found.group(2).split(","))


def _one(text: str) -> int | slice:
    if ":" not in text:
        return int(text)
    start, stop = (int(part) if part.strip() else None for part in text.split(":"))
    return slice(start, stop)


def entries(case: Case, engine: Array) -> Iterator[Entry]:
    """Each entry of the case's answer."""
    name = case.quantity.name
    whole = case.engine(case.robot, {k: v[:1] for k, v in case.arguments.items()}).shape[1:]
    places = np.empty(whole, dtype=object)
    for index in np.ndindex(whole):
        places[index] = index
    chosen: Any = places[case.index] if case.index else places
    scale = error_sizes(engine)
    if engine.ndim == 1:
        index = chosen if isinstance(chosen, tuple) else ()
        yield Entry(_label(name, index), index, (), case.hand, engine, scale)
        return
    for local in np.ndindex(engine.shape[1:]):
        at = (slice(None), *local)
        index = chosen[local]
        yield Entry(_label(name, index), index, local, case.hand[at], engine[at], scale)


def _label(name: str, index: tuple[int, ...]) -> str:
    return f"{name}[{','.join(map(str, index))}]" if index else name
