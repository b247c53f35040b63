"""The numbers of a program: those in its text, and those in the data that it uses."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np

from kinlab.doctor.program.observed import Observed
from kinlab.doctor.program.places import DATA, ProgramEdit, places
from kinlab.doctor.program.trial import FieldChange, Trial, is_data

_RIGHT_ANGLES = (0.0, pi / 2, -pi / 2)
_TABLE = 60
"""Numbers of an array of which any may be wrong."""


def of_data(trial: Trial) -> Iterator[ProgramEdit]:
    """Every number of the data with another sign, doubled, halved, or taken for degrees."""
    for leaf in _leaves(trial):
        if leaf.value:
            yield leaf.edit(-leaf.value, "sign", 1.05)
            yield leaf.edit(2 * leaf.value, "factor", 1.2)
            yield leaf.edit(leaf.value / 2, "factor", 1.2)
            yield leaf.edit(leaf.value * pi / 180, "degrees", 1.15)
        if leaf.value in _RIGHT_ANGLES:
            for other in _RIGHT_ANGLES:
                if other != leaf.value:
                    yield leaf.edit(other, "number", 1.12)
    for name in trial.program.data:
        value = trial.space[name]
        for new, kind in _whole(value):
            yield ProgramEdit(DATA, (FieldChange(trial.space, name, new),), kind, 1.1, name)


def _whole(value: Any) -> Iterator[tuple[Any, str]]:
    """All of a table otherwise."""
    if isinstance(value, np.ndarray) and value.dtype.kind == "f" and value.size:
        yield -value, "sign"
        yield np.radians(value), "degrees"
        if value.ndim == 2:
            yield value.T, "transposed"
    elif isinstance(value, list | tuple) and all(type(one) in (int, float) for one in value):
        yield type(value)(one * pi / 180 for one in value), "degrees"


@dataclass(frozen=True, eq=False)
class NumberPlace:
    """A number in the text of a program, or in its data.

    Attributes:
        value: what it is.
        part: of the program; :data:`DATA` for the data.
        holder, field: where it is kept.
        node: of the text; of data the name.
        place: the keys down to it.
        inner: of these, those within a tuple, which is made anew as a whole.
    """

    value: float
    part: int
    holder: Any
    field: Any
    node: Any
    place: tuple[Any, ...] = ()
    inner: tuple[int, ...] = ()

    def edit(self, value: float, kind: str = "number", cost: float = 1.15) -> ProgramEdit:
        """Another number there."""
        change = FieldChange(self.holder, self.field, value)
        if self.inner:
            change = replace(change, new=_rebuilt(change.now, self.inner, value))
        both = (float(self.value), float(value))
        return ProgramEdit(self.part, (change,), kind, cost, self.node, self.place, both)


def numbers(trial: Trial, observed: Observed) -> Iterator[NumberPlace]:
    """Numbers that are no index."""
    for part, tree in enumerate(trial.trees):
        for here in places(part, tree):
            node = here.node
            if not isinstance(node, ast.Constant) or observed.of(node) is None:
                continue
            counts = type(node.value) is int and isinstance(here.parent, ast.BinOp)
            if isinstance(node.value, int | float) and (counts or isinstance(node.value, float)):
                yield NumberPlace(node.value, part, node, "value", node)
    yield from _leaves(trial)


def _leaves(trial: Trial) -> Iterator[NumberPlace]:
    for name in trial.program.data:
        yield from _within(trial.space, name, trial.space[name], name, (), ())


def _within(
    holder: Any, key: Any, value: Any, name: str, place: tuple[Any, ...], inner: tuple[int, ...]
) -> Iterator[NumberPlace]:
    if isinstance(value, float | int) and not isinstance(value, bool):
        yield NumberPlace(value, DATA, holder, key, name, place, inner)
    elif isinstance(value, tuple):
        for k, one in enumerate(value):
            if is_data(one):
                yield from _below(one, name, (*place, k))
            else:
                yield from _within(holder, key, one, name, (*place, k), (*inner, k))
    elif not inner:
        yield from _below(value, name, place)


def _below(value: Any, name: str, place: tuple[Any, ...]) -> Iterator[NumberPlace]:
    """The numbers in a list, a dictionary, an array, an object."""
    if isinstance(value, dict | list):
        for k, one in value.items() if isinstance(value, dict) else enumerate(value):
            yield from _within(value, k, one, name, (*place, k), ())
    elif isinstance(value, np.ndarray):
        if value.dtype.kind == "f" and value.size <= _TABLE:
            for index in np.ndindex(value.shape):
                entry = (*place, *index)
                yield NumberPlace(float(value[index]), DATA, value, index, name, entry)
    elif hasattr(value, "__dict__"):
        for k, one in vars(value).items():
            if not k.startswith("__") and not callable(one):
                yield from _within(value, k, one, name, (*place, f".{k}"), ())


def _rebuilt(old: Any, path: tuple[int, ...], new: float) -> Any:
    """A tuple with another number in it."""
    if not path:
        return new
    parts = [*old]
    parts[path[0]] = _rebuilt(parts[path[0]], path[1:], new)
    return tuple(parts)
