"""Answers kept for a while: one question about the same numbers is answered once.

Many formulas ask for the same thing at the same states (dM/dq, a Jacobian). Whoever puts many of
them beside the engine opens :func:`answers_kept`; outside of it nothing is kept.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np


class _Kept(threading.local):
    """The answers of this thread by question, or None where none are kept."""

    answers: dict[tuple[Any, ...], Any] | None = None


_kept = _Kept()


@contextmanager
def answers_kept() -> Iterator[None]:
    """Within it, :func:`once` answers a question of this thread once; all is dropped at its end."""
    before, _kept.answers = _kept.answers, {}
    try:
        yield
    finally:
        _kept.answers = before


def once(function: Callable[..., Any], *arguments: Any) -> Any:
    """``function(*arguments)``, or a copy of the answer it gave to the same arguments.

    Args:
        function: answers with an array that hangs on its arguments alone.
        arguments: arrays, told apart by their numbers, and what has a hash.

    Returns:
        What the function returns; the caller may write into it.
    """
    answers = _kept.answers
    if answers is None:
        return function(*arguments)
    asked = [(a.shape, a.tobytes()) if isinstance(a, np.ndarray) else a for a in arguments]
    question = (function, *asked)
    if question not in answers:
        answers[question] = function(*arguments)
    return answers[question].copy()
