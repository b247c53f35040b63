"""How many threads a batch may use.

A batch splits its states over the processor's cores. Inside the worker of a sweep it must not:
the workers fill the cores already, so a block of a sweep runs under :func:`one_thread`. Nor may
it in a process made by ``fork``: the threads of the parent's pools are not there, and those who
wait for them (OpenMP's too) wait for ever.
"""

from __future__ import annotations

import os
import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from kinlab.errors import OptionError

VARIABLE = "KINLAB_THREADS"
"""Environment variable that limits the threads of a batch."""

_NUMBER = re.compile("[0-9]{1,4}")

_STATES_PER_THREAD = 2048
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
    most = max(1, states // _STATES_PER_THREAD)
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


def cores() -> int:
    """Cores this process may run on."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
