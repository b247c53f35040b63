"""Compiled kernels: one decorator, a word when compilation takes time, and threads.

Importing this module imports numba; import it inside the function that needs it.

Kernels are cached on disk: beside the source where that folder is writable, else in the user's
cache folder (numba's own order; the environment variable ``NUMBA_CACHE_DIR`` overrides both).
Where no folder at all is writable they are compiled anew in each process.

Threads are Python's: kernels release the GIL and each works on a range of rows. numba's own
parallel loops would abort the process when two Python threads enter them at once, and compile
for several seconds more.
"""

from __future__ import annotations

import logging
import os
import pickle
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from functools import cache, partial
from typing import Any

import numba
from numba.core import event

from kinlab.errors import OptionError
from kinlab.fast.threads import available

LOGGER = logging.getLogger("kinlab.fast.compiled")
"""Says at level INFO when kernels are being compiled (once per machine, then cached)."""

_OPTIONS: dict[str, Any] = {
    "nogil": True,
    "error_model": "numpy",  # no test for zero in front of each division
    # fused multiply-add and signed zeros only: NaN must stay visible and the order of sums fixed
    "fastmath": {"contract", "nsz"},
}


def kernel(function: Callable[..., Any]) -> Any:
    """Compiles a function on first call, with the machine code cached on disk.

    numba looks at the date of the file that holds the function, not at those of the kernels it
    calls: touch a file after changing a kernel that its own kernels use.
    """
    try:
        made = numba.njit(cache=True, **_OPTIONS)(function)
    except RuntimeError:  # "no locator available": neither the source's folder nor a home
        return numba.njit(**_OPTIONS)(function)
    made._cache = _Forgiving(made._cache)
    return made


class _Forgiving:
    """numba's cache of one kernel, where a damaged or full one costs time and not the run."""

    def __init__(self, cache: Any) -> None:
        self._cache = cache

    def __getattr__(self, name: str) -> Any:
        return getattr(self._cache, name)

    def load_overload(self, *arguments: Any) -> Any:
        """Machine code from the disk; None, and a clean cache, where it cannot be read."""
        try:
            return self._cache.load_overload(*arguments)
        except Exception:  # noqa: BLE001  whatever a damaged pickle raises
            LOGGER.info("a cached kernel is damaged and is compiled again")
            with suppress(OSError):
                self._cache.flush()
            return None

    def save_overload(self, *arguments: Any) -> None:
        """Machine code to the disk, if it can be written there."""
        try:
            self._cache.save_overload(*arguments)
        except (OSError, EOFError, ValueError, pickle.UnpicklingError) as problem:
            LOGGER.info("a compiled kernel could not be kept (%s)", problem)


class _Announcer(event.Listener):  # type: ignore[misc]
    """Logs the first compilation of the process; reading from the cache is silent."""

    said = False

    def on_start(self, event: Any) -> None:
        if not self.said and LOGGER.isEnabledFor(logging.INFO):
            self.said = True
            LOGGER.info("compiling kernels, once per machine; this takes some seconds")

    def on_end(self, event: Any) -> None:
        """Nothing to say at the end."""


event_announcer = _Announcer()
event.register("numba:compile", event_announcer)


def wanted_threads(threads: int | None) -> int:
    """The number of threads to use: what was asked for, or all this process may use.

    Raises:
        OptionError: not a positive whole number.
    """
    if threads is None:
        return available()
    if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
        raise OptionError(f"threads is {threads!r}; give a whole number of at least 1")
    return threads


def over_rows(
    function: Any,
    rows: int,
    *arguments: Any,
    threads: int | None = None,
    grain: int = 64,
    then: Callable[[int, int], None] | None = None,
) -> None:
    """Calls ``function(*arguments, first, last)`` on ranges of rows, on several threads.

    Args:
        function: a kernel that writes rows first to last - 1 of its output arrays and nothing
            else, so that the answer cannot depend on the number of threads.
        rows: how many rows there are.
        arguments: passed on.
        threads: how many; ``None`` for all processors.
        grain: fewest rows worth handing over.
        then: called here with (first, last) of each range that is finished, while others run.

    Raises:
        OptionError: as :func:`thread_count`.
    """
    threads = wanted_threads(threads)
    if threads == 1 or rows < 2 * grain:
        function(*arguments, 0, rows)
        if then is not None:
            then(0, rows)
        return
    size = max(grain, -(-rows // (threads * 8)))  # several ranges a thread: rows differ in cost
    ranges = [(first, min(first + size, rows)) for first in range(0, rows, size)]
    pool = _pool(threads)
    waiting = [pool.submit(partial(function, *arguments, *each)) for each in ranges]
    for each, future in zip(ranges, waiting, strict=True):
        future.result()
        if then is not None:
            then(*each)


@cache
def _pool(threads: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(threads, thread_name_prefix="kinlab")


if hasattr(os, "register_at_fork"):  # a child has none of its parent's threads
    os.register_at_fork(after_in_child=_pool.cache_clear)
