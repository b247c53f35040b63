"""A damaged or full cache of kernels costs time, not the run (tests/fuzz truncates a real one)."""

from __future__ import annotations

import errno
import pickle

import pytest

from kinlab.engine.fast.compiled import ForgivingCache


class Cache:
    def __init__(self, problem: Exception) -> None:
        self.problem, self.flushed = problem, False

    def load_overload(self, *arguments):
        raise self.problem

    def save_overload(self, *arguments):
        raise self.problem

    def flush(self):
        self.flushed = True
        raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize(
    "problem", [EOFError(), pickle.UnpicklingError(), OSError(errno.ENOSPC, "full")], ids=repr
)
def test_neither_reading_nor_writing_it_raises(problem):
    inner = Cache(problem)
    cache = ForgivingCache(inner)
    assert cache.load_overload("sig", None) is None
    assert inner.flushed
    cache.save_overload("sig", None)
