"""Values of modules and objects: which are numbers, and of which shapes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from kinlab.doctor.program.observed import Shape


def is_number(value: object) -> bool:
    """Whether it is a number, or may be numbers."""
    return isinstance(value, int | float | list | tuple | np.ndarray)


def shape_of(value: object) -> Shape | None:
    """The shape of numbers; None of what is none."""
    if isinstance(value, bool):
        return None
    try:
        numbers = np.asarray(value)
    except ValueError:
        return None
    return numbers.shape if numbers.dtype.kind in "fi" else None


def named_numbers(space: dict[str, Any]) -> Iterator[tuple[str, Shape]]:
    """A module's numbers by their names, each with its shape; a number for each joint is a row."""
    for name, value in space.items():
        if any(vars(module).get(name) is value for module in (math, np)):
            continue  # of ``from math import *``
        of_each = isinstance(value, dict) and all(type(key) is int for key in value)
        if name[:1] != "_" and (is_number(value) or of_each):
            known = shape_of([*value.values()] if isinstance(value, dict) else value)
            if known is not None:
                yield name, known
