"""Compiled kernels: one decorator, and a word when compilation takes time.

Importing this module imports numba; import it inside the function that needs it.

Kernels are cached on disk: beside the source where that folder is writable, else in the user's
cache folder (numba's own order; the environment variable ``NUMBA_CACHE_DIR`` overrides both).
Where no folder at all is writable they are compiled anew in each process.
"""

from __future__ import annotations

import logging
import pickle
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numba
from numba.core import event

LOGGER = logging.getLogger("kinlab.engine.fast.compiled")
"""Says at level INFO when kernels are being compiled (once per machine, then cached)."""

_OPTIONS: dict[str, Any] = {
    "nogil": True,
    "no_cfunc_wrapper": True,  # nobody calls a kernel from C
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
    made._cache = ForgivingCache(made._cache)
    return made


class ForgivingCache:
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
