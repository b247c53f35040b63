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
    def put_back(before: list[tuple[Any, Any]]) -> None:
        """What was held when :meth:`now` was asked, wherever something was written."""
        for one, copy in before:
            if isinstance(one, np.ndarray):
                if one.tobytes() != copy.tobytes():
                    one[...] = copy
            elif isinstance(one, list):
                if len(one) != len(copy) or any(a is not b for a, b in zip(one, copy, strict=True)):
                    one[:] = copy
            elif one.keys() != copy.keys() or any(one[key] is not copy[key] for key in copy):
                one.clear()
                one.update(copy)
