"""How far a long calculation is: one line on a terminal or in a notebook, nothing elsewhere.

The line comes after two seconds, so that what is quick says nothing; a pipe, a log or a test never
sees it. It is written to stderr, over itself, and wiped at the end.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

DELAY = 2.0
"""Seconds until the line appears."""

_PAUSE = 0.2
"""Seconds between two lines."""

_WIDTH = 79

Tell = Callable[..., None]
Step = TypeVar("Step")


class _Line:
    """One calculation's line; the outermost of a thread's calculations has it."""

    busy = threading.Lock()

    def __init__(self, what: str, total: int, delay: float) -> None:
        self._what, self._total = what, total
        self._begun = time.monotonic()
        self._next = self._begun + delay
        self._drawn = 0

    def __call__(self, done: int, note: str = "") -> None:
        """Says that ``done`` of the steps are done; cheap where it is not yet time for a line."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + _PAUSE
        text = self._what if not self._total else f"{self._what}: {done} of {self._total}"
        spent = now - self._begun
        if 0 < done < self._total:
            text += f", {spent * (self._total - done) / done:.0f} s left"
        else:
            text += f", {spent:.0f} s"
        self._write(f"{text}  {note}".rstrip()[:_WIDTH])

    def close(self) -> None:
        """Wipes the line."""
        if self._drawn:
            self._write("")
            sys.stderr.write("\r")
            sys.stderr.flush()

    def _write(self, text: str) -> None:
        sys.stderr.write("\r" + text + " " * max(0, self._drawn - len(text)))
        sys.stderr.flush()
        self._drawn = len(text)


@contextmanager
def progress(what: str, total: int = 0, show: bool | None = None) -> Iterator[Tell]:
    """Shows how far a calculation is while the block lasts.

    Args:
        what: what is being done, in a word or two.
        total: how many steps there are; 0 where that is not known.
        show: True shows from the start, wherever stderr goes; False never; None after
            :data:`DELAY` on a terminal or in a notebook.

    Yields:
        ``tell(done, note="")``.
    """
    wanted = watched() if show is None else show
    if not wanted or not _Line.busy.acquire(blocking=False):
        yield _silent
        return
    line = _Line(what, total, 0.0 if show else DELAY)
    try:
        yield line
    finally:
        line.close()
        _Line.busy.release()


def counted(steps: Iterable[Step], what: str, total: int = 0) -> Iterator[Step]:
    """The steps of a loop, with :func:`progress`."""
    with progress(what, total) as tell:
        for done, step in enumerate(steps):
            tell(done)
            yield step


def watched() -> bool:
    """Whether somebody looks on: stderr is a terminal, or this is a notebook's main thread."""
    if threading.current_thread() is not threading.main_thread():
        return False
    if sys.stderr is None or not hasattr(sys.stderr, "isatty"):
        return False
    return sys.stderr.isatty() or _notebook()


def _notebook() -> bool:
    shell: Any = sys.modules.get("IPython")
    if shell is None:
        return False
    running = shell.get_ipython()
    return type(running).__name__ == "ZMQInteractiveShell"


def _silent(done: int, note: str = "") -> None:
    """Nobody looks on."""
