"""What a program's data hold, so that what an edited run writes into them is put back."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

_LARGE = 10_000
"""Entries of one list, dictionary or array that are not copied before each trial."""


class Contents:
    """The lists, dictionaries, arrays and objects that can be reached from values.

    Args:
        values: the data; copies of the user's own.
    """

    def __init__(self, values: Iterable[Any]) -> None:
        self._holders: dict[int, Any] = {}
        for value in values:
            self._gather(value)

    def _gather(self, value: Any) -> None:
        if isinstance(value, tuple):
            for one in value:
                self._gather(one)
        if id(value) in self._holders or isinstance(value, type):
            return
        if not isinstance(value, list | dict | np.ndarray):
            value = None if callable(value) else getattr(value, "__dict__", None)
            if not isinstance(value, dict):
                return
        if isinstance(value, np.ndarray):
            inside: list[Any] = []
            size = value.size
        else:
            inside = [*value.values()] if isinstance(value, dict) else value
            size = len(inside)
        if size <= _LARGE:
            self._holders[id(value)] = value
            for one in inside:
                self._gather(one)

    def now(self) -> list[tuple[Any, Any]]:
        """Each of them with a copy of what it holds."""
        return [(one, one.copy()) for one in self._holders.values()]

    @staticmethod
    def put_back(before: list[tuple[Any, Any]]) -> bool:
        """Puts back what was held when :meth:`now` was asked; whether anything was not so."""
        spoilt = [(one, copy) for one, copy in before if not _same(one, copy)]
        for one, copy in spoilt:
            if isinstance(one, dict):
                one.clear()
                one.update(copy)
            else:
                one[... if isinstance(one, np.ndarray) else slice(None)] = copy
        return bool(spoilt)


def _same(one: Any, copy: Any) -> bool:
    if isinstance(one, np.ndarray):
        return bool(one.tobytes() == copy.tobytes())
    if isinstance(one, dict):
        return one.keys() == copy.keys() and all(one[key] is copy[key] for key in copy)
    return len(one) == len(copy) and all(a is b for a, b in zip(one, copy, strict=True))
