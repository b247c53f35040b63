"""Processes of ours end with the process that started them, however that one ends."""

from __future__ import annotations

import multiprocessing
import os
import threading
from multiprocessing.connection import wait

_ORPHANED = 70
"""Exit code of a worker whose parent has gone."""


def cores() -> int:
    """Cores this process may run on."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def end_with_parent() -> None:
    """Called first in a worker: ends it as soon as its parent is gone, killed or not.

    The parent's end closes a pipe, which a thread waits for. Nothing happens in a process that
    ``multiprocessing`` did not start.
    """
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def watch() -> None:
        wait([parent.sentinel])
        os._exit(_ORPHANED)

    threading.Thread(target=watch, name="kinlab parent watch", daemon=True).start()
