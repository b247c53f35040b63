"""Chunks of a sweep on an executor: few in flight, repeated when a worker dies."""

from __future__ import annotations

import multiprocessing
import pickle
import signal
import sys
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import (
    ALL_COMPLETED,
    FIRST_COMPLETED,
    BrokenExecutor,
    Executor,
    Future,
    ProcessPoolExecutor,
    wait,
)
from contextlib import contextmanager
from functools import lru_cache
from multiprocessing import resource_tracker
from typing import Any

import numpy as np

from kinlab.engine.fast.threads import one_thread
from kinlab.errors import OptionError, SweepError
from kinlab.host.processes import end_with_parent
from kinlab.sweeps.measures import Measure, evaluate
from kinlab.sweeps.parts import Columns, Run
from kinlab.sweeps.samples import Samples

_TRIES = 3
"""Times in a row that the workers may die before a chunk is finished."""

_PARTING = 5.0
"""Seconds for which the executor's own thread is waited for, once its processes have ended."""
_IN_FLIGHT = 64
"""Chunks handed to an executor that does not tell how many workers it has."""


def run_chunk(packed: bytes, measure: Measure, samples: Samples, run: Run) -> Columns:
    """What a worker does: every block of one run, each by one call of the measure.

    Args:
        packed: the pickled subject; kept by the worker for its next chunks.
        measure: f(subject, q).
        samples: a portion that holds the run.
        run: blocks first to last - 1.

    Returns:
        The columns of the run.

    Raises:
        OptionError: the measure answers something unfit, or not the same columns every time.
    """
    subject = _unpacked(packed)
    with one_thread():  # the workers are the parallelism
        blocks = [evaluate(measure, subject, samples.block(i)) for i in range(*run)]
    for block in blocks[1:]:
        same_columns(blocks[0], block)
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


@lru_cache(maxsize=4)
def _unpacked(packed: bytes) -> Any:
    return pickle.loads(packed)


def same_columns(one: Columns, two: Columns) -> None:
    """Refuses a measure whose answers change their names, types or row shapes on the way."""
    first, second = (
        {name: (str(c.dtype), c.shape[1:]) for name, c in sorted(columns.items())}
        for columns in (one, two)
    )
    if first != second:
        raise OptionError(f"sweep: the measure answered {first} for one block and {second} later")


def serial(task: Callable[[Run], Columns], runs: list[Run]) -> Iterator[tuple[Run, Columns]]:
    """One run after the other, in this process."""
    for run in runs:
        yield run, task(run)


def spread(
    arguments: Callable[[Run], tuple[Any, ...]], runs: list[Run], pool: Pool
) -> Iterator[tuple[Run, Columns]]:
    """Runs on a pool's workers, in the order in which they finish.

    Args:
        arguments: what :func:`run_chunk` needs for a run.
        runs: the runs.
        pool: where.

    Raises:
        SweepError: workers died several times without finishing a chunk, or the caller's
            executor broke.
        Exception: what the measure raised, of the first run of which it did.
    """
    waiting = deque(runs)
    running: dict[Future[Columns], Run] = {}
    crashes = 0
    try:
        while waiting or running:
            broken = False
            try:
                while waiting and len(running) < pool.in_flight:
                    running[pool.submit(*arguments(waiting[0]))] = waiting[0]
                    waiting.popleft()
            except BrokenExecutor:
                broken = True
            # a broken pool ends all its futures at once: collect them before it is renewed
            for future in wait(running, None, ALL_COMPLETED if broken else FIRST_COMPLETED).done:
                run = running.pop(future)
                error = future.exception()
                if error is None:
                    crashes = 0
                    yield run, future.result()
                elif isinstance(error, BrokenExecutor):
                    broken = True
                    waiting.appendleft(run)
                else:
                    raise _first_error(run, error, running)
            if broken and not running:
                crashes += 1
                pool.renew(crashes, sorted(waiting))
    finally:
        for future in running:
            future.cancel()
        pool.close()


def _first_error(
    run: Run, error: BaseException, running: dict[Future[Columns], Run]
) -> BaseException:
    """The error of the first run that has one, whichever worker is faster."""
    earlier = [
        future for future in sorted(running, key=running.__getitem__) if running[future] < run
    ]
    errors = [future.exception() for future in earlier]
    return next((e for e in errors if e and not isinstance(e, BrokenExecutor)), error)


class Pool:
    """An executor, and what may be done to it: ours is renewed and ended, the caller's is not.

    Args:
        executor: the caller's, or ``None`` for a process pool of our own.
        workers: processes of our own pool.

    Raises:
        OptionError: not an executor.
    """

    def __init__(self, executor: Executor | None, workers: int) -> None:
        if executor is not None and not isinstance(executor, Executor):
            raise OptionError(
                f"sweep: executor is a {type(executor).__name__}; give a "
                "concurrent.futures.Executor (of a Dask client: client.get_executor())"
            )
        self._own = executor is None
        self._workers = workers
        self.executor: Executor = _process_pool(workers) if executor is None else executor
        known = getattr(self.executor, "_max_workers", None)
        # two for each worker: one at work, one ready
        self.in_flight = 2 * known if isinstance(known, int) else _IN_FLIGHT

    def submit(self, *arguments: Any) -> Future[Columns]:
        """Hands :func:`run_chunk` to the executor; a pool of ours may begin a process for it."""
        with _interrupts_held(self._own):
            return self.executor.submit(run_chunk, *arguments)

    def renew(self, crashes: int, runs: list[Run]) -> None:
        """Replaces a pool of ours whose worker died.

        Raises:
            SweepError: the executor is the caller's, or they keep dying.
        """
        where = ", ".join(f"{first} to {last - 1}" for first, last in runs[:4])
        if not self._own:
            raise SweepError(
                f"sweep: a worker of the executor died (at work: blocks {where}); give a fresh "
                "executor and the same folder= to go on from what is finished"
            )
        if crashes >= _TRIES:
            raise SweepError(
                f"sweep: workers died {crashes} times in a row (next: blocks {where}). In a "
                "script, call sweep under `if __name__ == '__main__':`; to see the measure fail, "
                "use workers=1"
            )
        self.close()
        self.executor = _process_pool(self._workers)

    def close(self) -> None:
        """Ends the processes of a pool of ours, idle or not."""
        if not self._own:
            return
        # Executor.kill_workers comes with Python 3.14; until then the processes are private
        processes = list((getattr(self.executor, "_processes", None) or {}).values())
        manager = getattr(self.executor, "_executor_manager_thread", None)
        self.executor.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.terminate()
        for process in processes:
            process.join()
        if manager is not None:  # at the interpreter's end it may close what is written to
            manager.join(_PARTING)


@contextmanager
def _interrupts_held(own: bool) -> Iterator[None]:
    """Ctrl-C waits here, and in a process that begins meanwhile: it is deaf while it imports."""
    if not own or sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _process_pool(workers: int) -> ProcessPoolExecutor:
    resource_tracker.ensure_running()  # to begin it later would let Ctrl-C through
    # not fork: threads of numba's and Pinocchio's callers do not survive it
    return ProcessPoolExecutor(
        workers, mp_context=multiprocessing.get_context("spawn"), initializer=_begin
    )


def _begin() -> None:
    """Ctrl-C reaches the whole group; the parent ends the workers, without their tracebacks.

    Where the parent is killed, they end with it.
    """
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
