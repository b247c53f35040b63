"""Rows of many tasks together: each mechanism's states solved once, on all cores.

Tasks of one mechanism share its states and what is asked of them, so they run in one process, one
after the other; mechanisms are dealt out, those of many rows first. What a row says does not
depend on who ran it. Only what ships is handed over, by name; a user's own things stay here.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

from kinlab.host.answers import answers_kept
from kinlab.host.processes import cores, end_with_parent

if TYPE_CHECKING:
    from kinlab.check.catalogue import Row
    from kinlab.check.targets import PlannedRow

ENOUGH = 150
"""Rows from which further processes are worth their start."""

Answers = list[tuple[Any, ...]] | None
"""What a helper says about a mechanism: the parts of its rows, or None where it failed."""


class Helpers:
    """Further processes that run rows of what ships, until the block ends.

    They import what they need while the caller does the same. None of them is relied on: what one
    does not answer, the caller runs.

    Args:
        count: how many; by default one for each core but the caller's own.
    """

    def __init__(self, count: int | None = None) -> None:
        context = multiprocessing.get_context("spawn")  # not fork: the caller may have threads
        self._started: list[tuple[Any, Any]] = []
        for _ in range(cores() - 1 if count is None else count):
            mine, other = context.Pipe()
            process = context.Process(target=_serve, args=(other,), daemon=True)
            process.start()
            other.close()
            self._started.append((process, mine))

    def __enter__(self) -> Helpers:
        return self

    def __exit__(self, *problem: object) -> None:
        for process, _ in self._started:
            process.kill()
        for process, pipe in self._started:
            process.join()
            pipe.close()

    def take(
        self, names: deque[str], question: Callable[[str], Any], told: Callable[..., None]
    ) -> int:
        """Lets each process take names off the line and answer; the caller may do so beside them.

        Args:
            names: the line; the first is the next.
            question: what to ask about a name.
            told: called with a name and its answers, and without any when a process is done.

        Returns:
            How many processes there are: so often ``told`` is called without anything.
        """

        def feed(pipe: Any) -> None:
            answers: Answers = []
            while answers is not None:
                try:
                    name = names.popleft()
                except IndexError:
                    break
                try:
                    pipe.send(question(name))
                    answers = pipe.recv()
                except (EOFError, OSError):
                    answers = None
                told(name, answers)
            told()

        for _, pipe in self._started:
            threading.Thread(target=feed, args=(pipe,), daemon=True).start()
        return len(self._started)


def run_together(
    todo: Sequence[PlannedRow],
    one: Callable[[PlannedRow], Any],
    samples: int,
    seed: int,
    helpers: Helpers | None = None,
) -> Iterator[tuple[int, Any]]:
    """Runs tasks, mechanism by mechanism.

    Args:
        todo: the tasks.
        one: runs a task here.
        samples, seed: the states of those that run elsewhere, as ``one`` draws them.
        helpers: processes that take some of them, or none.

    Yields:
        The place of each task in ``todo`` and its result, in the order in which they finish.
    """
    places: dict[str, list[int]] = {}
    own: list[int] = []
    for k, task in enumerate(todo):
        places.setdefault(task.name, []).append(k) if task.ships else own.append(k)
    line = deque(sorted(places, key=lambda name: -len(places[name])))
    replies: SimpleQueue[tuple[Any, ...]] = SimpleQueue()
    busy = 0
    if helpers is not None:

        def question(name: str) -> Any:
            return name, [todo[k].record.key for k in places[name]], samples, seed

        busy = helpers.take(line, question, lambda *told: replies.put(told))

    def here(numbers: list[int]) -> Iterator[tuple[int, Any]]:
        with answers_kept():
            for k in numbers:
                yield k, one(todo[k])

    while line or busy:
        while busy and not (line and replies.empty()):
            told = replies.get()
            if not told:
                busy -= 1
            elif told[1] is None:
                yield from here(places[told[0]])
            else:
                for k, parts in zip(places[told[0]], told[1], strict=True):
                    yield k, _row(todo[k], parts)
        try:
            name = line.popleft()
        except IndexError:
            continue
        yield from here(places[name])
    yield from here(own)


def _row(task: PlannedRow, parts: tuple[Any, ...]) -> Row:
    from kinlab.check.catalogue import Row

    return Row(task.record, *parts)


def _serve(pipe: Any) -> None:
    """A helper: answers questions about mechanisms until its parent has gone."""
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent ends it
    from kinlab.check.catalogue import catalogue, run_one
    from kinlab.check.table_check import DYNAMIC, KINEMATIC

    records = {record.key: record for record in (*catalogue(), *KINEMATIC, *DYNAMIC)}
    while True:
        try:
            name, keys, samples, seed = pipe.recv()
        except EOFError:
            os._exit(0)
        answers: Answers
        try:
            with answers_kept():
                rows = [run_one(records[key], name, samples, seed) for key in keys]
            answers = [(row.robot, row.corrected, row.printed) for row in rows]
        except Exception:  # noqa: BLE001  the parent runs it again and says what is wrong
            answers = None
        pipe.send(answers)
