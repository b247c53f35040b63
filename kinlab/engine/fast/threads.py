"""How many threads a batch may use, and handing its rows to them; without numba.

A batch splits its states over the processor's cores. Inside the worker of a sweep it must not:
the workers fill the cores already, so a block of a sweep runs under :func:`one_thread`. Nor may
it in a process made by ``fork``: the threads of the parent's pools are not there, and those who
wait for them (OpenMP's too) wait for ever.

Threads are Python's: kernels release the GIL and each works on a range of rows. numba's own
parallel loops would abort the process when two Python threads enter them at once, and compile
for several seconds more.
"""

from __future__ import annotations

import os
import re
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, partial
from typing import Any

from kinlab.arrays import whole
from kinlab.errors import OptionError
from kinlab.host.processes import cores
from kinlab.host.progress import pulse

VARIABLE = "KINLAB_THREADS"
"""Environment variable that limits the threads of a batch."""

_NUMBER = re.compile("[0-9]{1,4}")

STATES_PER_THREAD = 2048
"""A thread that gets fewer states than this, about a millisecond of work, costs more than it
saves: on a busy machine a batch waits for its last thread to get a core."""

_local = threading.local()


@dataclass
class _Process:
    """What is known of this process.

    Attributes:
        forked: whether ``fork`` made it out of one that had kinlab.
    """

    forked: bool = False


_PROCESS = _Process()


def _after_fork() -> None:
    _PROCESS.forked = True


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


def thread_count(states: int) -> int:
    """Number of threads for a batch of so many states.

    Args:
        states: N.

    Returns:
        At least 1; at most the cores this process may use, or ``KINLAB_THREADS``.

    Raises:
        OptionError: ``KINLAB_THREADS`` is not a whole number above zero.
    """
    most = max(1, states // STATES_PER_THREAD)
    return 1 if most == 1 else min(most, available())


@contextmanager
def one_thread() -> Iterator[None]:
    """Keeps every batch of the calling thread on that thread."""
    before = getattr(_local, "limit", None)
    _local.limit = 1
    try:
        yield
    finally:
        _local.limit = before


def available() -> int:
    """Number of threads a batch of this thread may use, however long it is; 1 after a fork.

    Raises:
        OptionError: as :func:`thread_count`.
    """
    limit = getattr(_local, "limit", None)
    if limit is not None:
        return int(limit)
    text = os.environ.get(VARIABLE)
    if text is not None and not (_NUMBER.fullmatch(text) and int(text) > 0):
        raise OptionError(
            f"{VARIABLE} is {text!r}; it must be a whole number above zero, up to 9999"
        )
    if _PROCESS.forked:
        return 1
    return cores() if text is None else int(text)


def wanted_threads(threads: int | None) -> int:
    """The number of threads to use: what was asked for, or all this process may use.

    Raises:
        OptionError: not a positive whole number.
    """
    if threads is None:
        return available()
    return whole(threads, "threads")


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
        OptionError: as :func:`wanted_threads`.
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
        pulse()
        if then is not None:
            then(*each)


@cache
def _pool(threads: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(threads, thread_name_prefix="kinlab")


if hasattr(os, "register_at_fork"):  # a child has none of its parent's threads
    os.register_at_fork(after_in_child=_pool.cache_clear)
