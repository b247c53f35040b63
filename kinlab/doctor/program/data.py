"""The numbers of a program: those in its text, and those in the data that it uses."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, Edit, places
from kinlab.doctor.program.trial import Change, Trial

_TABLE = 60
"""Numbers of an array of which any may be wrong."""


def of_data(trial: Trial) -> Iterator[Edit]:
    for name in trial.program.data:
        yield from _numbers_in(trial.space, name, name, ())


def _numbers_in(holder: Any, key: Any, name: str, place: tuple[Any, ...]) -> Iterator[Edit]:
    value = holder[key]
    if isinstance(value, bool):
        return
    if isinstance(value, int | float):
        if value:
            for new, kind, cost in (
                (-value, "sign", 1.05),
                (2 * value, "factor", 1.2),
                (value / 2, "factor", 1.2),
                (value * pi / 180, "degrees", 1.15),
            ):
                yield Edit(DATA, (Change(holder, key, new),), kind, cost, name, place)
    elif isinstance(value, dict):
        for k in value:
            yield from _numbers_in(value, k, name, (*place, k))
    elif isinstance(value, list):
        for k in range(len(value)):
            yield from _numbers_in(value, k, name, (*place, k))
    elif isinstance(value, np.ndarray) and value.dtype.kind == "f" and value.size <= _TABLE:
        yield Edit(DATA, (Change(holder, key, -value),), "sign", 1.1, name, place)
        if value.ndim == 2:
            yield Edit(DATA, (Change(holder, key, value.T),), "transposed", 1.1, name, place)
        for index in np.ndindex(value.shape):
            if value[index]:
                change = Change(value, index, -value[index])
                yield Edit(DATA, (change,), "sign", 1.1, name, (*place, *index))


@dataclass(frozen=True, eq=False)
class Place:
    """A number in the text of a program, or in its data."""

    value: float
    part: int
    holder: Any
    field: Any
    node: Any
    place: tuple[Any, ...] = ()

    def edit(self, value: float) -> Edit:
        """Another number there."""
        change = Change(self.holder, self.field, value)
        return Edit(self.part, (change,), "number", 1.15, self.node, self.place)


def numbers(trial: Trial, observed: Observed) -> Iterator[Place]:
    """Numbers that are no index."""
    for part, tree in enumerate(trial.trees):
        for here in places(part, tree):
            node = here.node
            if not isinstance(node, ast.Constant) or observed.of(node) is None:
                continue
            counts = type(node.value) is int and isinstance(here.parent, ast.BinOp)
            if isinstance(node.value, int | float) and (counts or isinstance(node.value, float)):
                yield Place(node.value, part, node, "value", node)
    for name in trial.program.data:
        for holder, key, place in _leaves(trial.space, name, ()):
            yield Place(float(holder[key]), DATA, holder, key, name, place)


def _leaves(holder: Any, key: Any, place: tuple[Any, ...]) -> Iterator[tuple[Any, Any, Any]]:
    value = holder[key]
    if isinstance(value, float | int) and not isinstance(value, bool):
        yield holder, key, place
    elif isinstance(value, dict):
        for k in value:
            yield from _leaves(value, k, (*place, k))
    elif isinstance(value, list):
        for k in range(len(value)):
            yield from _leaves(value, k, (*place, k))
    elif isinstance(value, np.ndarray) and value.dtype.kind == "f" and value.size <= _TABLE:
        for index in np.ndindex(value.shape):
            yield value, index, (*place, *index)
