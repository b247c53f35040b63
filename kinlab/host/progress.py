"""How far a long calculation is: one line on a terminal or in a notebook, nothing elsewhere.

The line comes after two seconds, so that what is quick says nothing; a pipe, a log or a test never
sees it, and ``KINLAB_PROGRESS=0`` silences it where a notebook is run to be printed. It is written
to stderr, over itself, and wiped at the end. Whatever runs inside a calculation only moves its line
on.
"""

from __future__ import annotations

import functools
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, ParamSpec, TypeVar

DELAY = 2.0
"""Seconds until the line appears."""

_PAUSE = 0.2
"""Seconds between two lines."""

_WIDTH = 79

Tell = Callable[..., None]
P = ParamSpec("P")
R = TypeVar("R")


class _Line:
    """The line of one calculation."""

    now: _Line | None = None
    """The line that stands at present: that of the outermost calculation."""

    def __init__(self, what: str, total: int, delay: float, unit: str) -> None:
        self._what, self._total, self._unit = what, total, f" {unit}".rstrip()
        self._to_the_end = not delay
        self._begun = time.monotonic()
        self._next = self._begun + delay
        self._told = self._drawn = 0
        self._note = ""

    def tell(self, done: int, note: str = "") -> None:
        """Says that ``done`` of the steps are done."""
        self._told, self._note = done, note
        self.move()

    def move(self) -> None:
        """Draws the line anew where it is time to: otherwise it costs a look at the clock."""
        now = time.monotonic()
        last = self._to_the_end and self._told == self._total > 0
        if now < self._next and not last:
            return
        self._next = now + _PAUSE
        spent = now - self._begun
        text = f"{self._what}, {spent:.0f} s"
        if self._total:
            left = ""
            if 0.05 * self._total < self._told < self._total:  # before that nobody knows
                left = f", {spent * (self._total - self._told) / self._told:.0f} s left"
            text = f"{self._what}: {self._told}/{self._total}{self._unit}{left}"
        self._write(f"{text}  {self._note}".rstrip()[:_WIDTH])

    def wipe(self) -> None:
        """Leaves nothing behind."""
        if self._drawn:
            self._write("")
            sys.stderr.write("\r")
            sys.stderr.flush()

    def _write(self, text: str) -> None:
        sys.stderr.write("\r" + text + " " * max(0, self._drawn - len(text)))
        sys.stderr.flush()
        self._drawn = len(text)


@contextmanager
def progress(
    what: str, total: int = 0, show: bool | None = None, *, unit: str = ""
) -> Iterator[Tell]:
    """Shows how far a calculation is while the block lasts.

    Args:
        what: what is being done, in a word or two.
        total: how many steps there are; 0 where that is not known.
        show: True shows from the start, wherever stderr goes; False never; None after
            :data:`DELAY` on a terminal or in a notebook.
        unit: what the steps are, in the plural.

    Yields:
        ``tell(done, note="")``.
    """
    if _Line.now is not None or not (watched() if show is None else show):
        yield _inside
        return
    line = _Line.now = _Line(what, total, 0.0 if show else DELAY, unit)
    try:
        yield line.tell
    finally:
        _Line.now = None
        line.wipe()


def takes_long(what: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Marks a function that may take long: a call of it has a line with the seconds spent.

    What it runs calls :func:`pulse` now and then.
    """

    def mark(function: Callable[P, R]) -> Callable[P, R]:
        @functools.wraps(function)
        def with_line(*args: P.args, **kwargs: P.kwargs) -> R:
            with progress(what):
                return function(*args, **kwargs)

        return with_line

    return mark


def pulse() -> None:
    """Moves the line on, if there is one."""
    line = _Line.now
    if line is not None and threading.current_thread() is threading.main_thread():
        line.move()


def watched() -> bool:
    """Whether somebody looks on: stderr is a terminal or a notebook's, in the main thread."""
    if os.environ.get("KINLAB_PROGRESS") == "0":
        return False
    if threading.current_thread() is not threading.main_thread():
        return False
    look: Any = getattr(sys.stderr, "isatty", None)
    return (look is not None and bool(look())) or _notebook()


def _notebook() -> bool:
    shell: Any = getattr(sys.modules.get("IPython"), "get_ipython", None)
    return shell is not None and type(shell()).__name__ == "ZMQInteractiveShell"


def _inside(done: int, note: str = "") -> None:
    """A calculation within another, or one that nobody looks at."""
    pulse()
