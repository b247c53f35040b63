"""The sweep itself: plan the missing chunks, run them, keep them, hand out the answers."""

from __future__ import annotations

import hashlib
import pickle
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.engine.fast.threads import available
from kinlab.errors import NameUnknownError, OptionError, near
from kinlab.host.introductions import MOST_ROWS, Introduction, Rows, counted, numbered
from kinlab.host.progress import progress as line
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot
from kinlab.sweeps.measures import Measure, describe, read_measure
from kinlab.sweeps.parts import Columns, Folder, Memory, Parts, Run
from kinlab.sweeps.pools import Pool, run_chunk, same_columns, serial, spread
from kinlab.sweeps.samples import BLOCK, Samples, read_samples


@dataclass(frozen=True, eq=False, repr=False)
class SweepResult(Rows):
    """The answers of a sweep. States are drawn again when asked for, not stored.

    Attributes:
        names: names of the columns.
        samples: where the states come from.
        parts: where the answers are.
    """

    names: tuple[str, ...]
    samples: Samples
    parts: Parts

    def __len__(self) -> int:
        return self.samples.count

    def keys(self) -> tuple[str, ...]:
        """Names of the columns, so that ``dict(result)`` holds them all."""
        return self.names

    def columns(self) -> dict[str, Any]:
        """State by state: q, and every column, those with several numbers entry by entry."""
        out = numbered("q", self.states)
        for name in self.names:
            out |= numbered(name, self[name])
        return out

    def introduction(self) -> Introduction:
        """How many states, and the range of each column."""
        rows: list[tuple[str, ...]] = []
        if len(self) <= _READ_AT_ONCE:
            for name in self.names:
                for part, values in list(numbered(name, self[name]).items())[:MOST_ROWS]:
                    rows.append((part, *_range(values)))
        heads = ("column", "least", "median", "largest") if rows else ()
        names = ", ".join(self.names)
        return Introduction(
            f"sweep of {counted(len(self), 'state')}: {names}", (), heads, tuple(rows)
        )

    def __getitem__(self, name: str) -> Array:
        """One column whole, (N, ...).

        Raises:
            NameUnknownError: no column of that name.
        """
        self._require(name)
        out: Array | None = None
        for run in self.parts.runs():
            part = self.parts.read(run)[name]
            if out is None:
                out = np.empty((len(self), *part.shape[1:]), part.dtype)
            out[run[0] * BLOCK : run[0] * BLOCK + len(part)] = part
        assert out is not None  # a sweep has at least one block
        return out

    @property
    def states(self) -> Array:
        """All states, (N, n)."""
        blocks = -(-len(self) // BLOCK)
        return np.concatenate([self.samples.block(i) for i in range(blocks)])

    def chunks(self) -> Iterator[tuple[Array, Columns]]:
        """States and columns of one finished run after the other, in order; memory of one."""
        for run in self.parts.runs():
            yield np.concatenate([self.samples.block(i) for i in range(*run)]), self.parts.read(run)

    def best(self, name: str, count: int = 1, *, largest: bool = False) -> tuple[Array, Array]:
        """The states with the least (or largest) values of a column of numbers.

        Args:
            name: a column with one number a state. NaN counts as worst.
            count: how many.
            largest: look for the largest.

        Returns:
            The states (count, n), best first, and their values (count,). Of equal values the
            one drawn first comes first.

        Raises:
            NameUnknownError: no column of that name.
            OptionError: count < 1, or a column with several numbers a state.
        """
        self._require(name)
        if count < 1:
            raise OptionError(f"sweep: count is {count}; at least 1")
        states, values = np.empty((0, 0)), np.empty(0)
        for q, columns in self.chunks():
            if columns[name].ndim != 1:
                raise OptionError(
                    f"sweep: column {name!r} has rows of shape {columns[name].shape[1:]}; best "
                    "needs one number a state"
                )
            states = np.concatenate([states.reshape(-1, q.shape[1]), q])
            values = np.concatenate([values, columns[name]])
            order = np.argsort(-values if largest else values, kind="stable")[:count]
            states, values = states[order], values[order]
        return states, values

    def _require(self, name: str) -> None:
        if name not in self.names:
            raise NameUnknownError(f"sweep: no column {name!r}; {near(str(name), self.names)}")


_READ_AT_ONCE = 2_000_000
"""States up to which the columns are read in order to say their range."""


def _range(values: Any) -> tuple[str, str, str]:
    """Least, median and largest of a column; empty where it holds no numbers."""
    array = np.asarray(values)
    if array.dtype.kind not in "buif":
        return ("", "", "")
    finite = array[np.isfinite(array)]
    if not len(finite):
        return ("-", "-", "-")
    low, middle, high = (float(f(finite)) for f in (np.min, np.median, np.max))
    return f"{low:.5g}", f"{middle:.5g}", f"{high:.5g}"


def sweep(
    robot: Any,
    measure: str | Iterable[str] | Measure,
    samples: int | ArrayLike = 100_000,
    *,
    seed: int = 0,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int = 4 * BLOCK,
    folder: str | Path | None = None,
    progress: bool | None = None,
) -> SweepResult:
    """Evaluates a measure over very many states or designs.

    The same seed gives the same answer bit for bit, whatever ``executor``, ``workers`` and
    ``chunk`` are: states are drawn, and the measure is called, in fixed blocks of 4096.

    Args:
        robot: what the measure is of: anything that names an arm or a five-bar, or any object
            that can be pickled (text and paths always name a mechanism).
        measure: a name or names (``"pose"``, ``"position"``, ``"jacobian"``,
            ``"singular_values"``, ``"condition"``, ``"yoshikawa"``, ``"inverse_condition"``,
            ``"min_singular"``, ``"isotropy"``; the values from ``"singular_values"`` on are of the
            task that suits the arm, as ``"auto"`` elsewhere, in SI units), or a
            function f(robot, q) that takes states (m, n) and answers an array with m rows, or a
            dict of such arrays. For worker processes it stands at the top of a module.
        samples: how many states to draw uniformly between ``lower`` and ``upper``, or the
            states themselves, (N, n).
        seed: of the drawing.
        lower, upper: corners of the box, (n,); left out, the robot's limits.
        executor: any ``concurrent.futures.Executor``, such as a Dask client's
            ``client.get_executor()``; left out, a process pool of its own.
        workers: processes of that pool; left out, as many as there are cores. 1 stays in this
            process, as does a sweep of a single chunk.
        chunk: states handed to a worker at once, rounded up to whole blocks.
        folder: keep finished chunks there as ``.npz`` parts. A sweep that was stopped goes on
            from them; memory is then bounded by the chunks in flight.
        progress: a line on stderr that says how far it is; left out, on a terminal and in a
            notebook, after two seconds.

    Returns:
        The answers by name (``result["condition"]``; a plain array is named ``"value"``).

    Raises:
        OptionError: an argument out of range, a measure that cannot be sent to workers or
            answers something unfit, or a folder that holds another sweep.
        NameUnknownError: a measure's name that is none.
        SweepError: workers keep dying.
        FileError: the folder cannot be written.
    """
    work = plan(
        robot,
        measure,
        samples,
        seed=seed,
        lower=lower,
        upper=upper,
        executor=executor,
        workers=workers,
        chunk=chunk,
        folder=folder,
    )
    with line("sweep", work.samples.count, progress, unit="states") as tell:
        for done in work.steps:
            tell(done)
    runs = work.parts.runs()
    assert runs and not missing(runs, runs[-1][1], runs[-1][1])
    return SweepResult(tuple(work.parts.read(runs[0])), work.samples, work.parts)


@dataclass(frozen=True, eq=False)
class Plan:
    """A sweep that is about to run.

    Attributes:
        samples: where the states come from.
        parts: where the answers are kept; what is finished is there at any time.
        steps: runs the sweep as it is iterated; after each chunk, how many states are done.
    """

    samples: Samples
    parts: Parts
    steps: Iterator[int]


def plan(
    robot: Any,
    measure: str | Iterable[str] | Measure,
    samples: int | ArrayLike = 100_000,
    *,
    seed: int = 0,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int = BLOCK,
    folder: str | Path | None = None,
) -> Plan:
    """As :func:`sweep`, but hands out the sweep before it runs, for those who may stop it."""
    function = read_measure(measure)
    if isinstance(robot, (str, Path, DHTable, pin.Model)):
        from kinlab.fivebar.linkage import as_mechanism  # its rooms take a while to import

        robot = as_mechanism(robot)
    source = read_samples(robot, samples, seed, lower, upper)
    blocks = -(-source.count // BLOCK)
    size = _whole(chunk, "chunk", BLOCK)
    count = available() if workers is None else _whole(workers, "workers", 1)
    parts = _parts(folder, robot, function, source, blocks)
    answers = _answers(
        robot, function, source, missing(parts.runs(), blocks, size), executor, count
    )
    return Plan(source, parts, _steps(parts, answers, source.count))


def _steps(parts: Parts, answers: Iterator[tuple[Run, Columns]], count: int) -> Iterator[int]:
    done = sum(_rows(run, count) for run in parts.runs())
    first: Columns | None = next((parts.read(run) for run in parts.runs()), None)
    yield done
    for run, columns in answers:
        if first is not None:
            same_columns(first, columns)
        first = {name: column[:1] for name, column in columns.items()}
        parts.write(run, columns)
        done += _rows(run, count)
        yield done


def missing(done: list[Run], blocks: int, size: int) -> list[Run]:
    """Runs of at most ``size`` blocks that fill what ``done`` leaves out of 0 to blocks - 1."""
    gaps, at = [], 0
    for first, last in [*done, (blocks, blocks)]:
        gaps += [(i, min(i + size, first)) for i in range(at, first, size)]
        at = last
    return gaps


def _answers(
    robot: Any,
    measure: Measure,
    samples: Samples,
    runs: list[Run],
    executor: Executor | None,
    workers: int,
) -> Iterator[tuple[Run, Columns]]:
    packed = _packed(robot, "the robot")

    def arguments(run: Run) -> tuple[Any, ...]:
        return packed, measure, samples.portion(*run), run

    if executor is None and (workers == 1 or len(runs) <= 1):
        return serial(lambda run: run_chunk(*arguments(run)), runs)
    if executor is None or isinstance(executor, ProcessPoolExecutor):
        _require_importable(measure)
    return spread(arguments, runs, Pool(executor, min(workers, len(runs))))


def _packed(value: Any, what: str) -> bytes:
    try:
        return pickle.dumps(value)
    except (pickle.PicklingError, AttributeError, TypeError) as problem:
        raise OptionError(
            f"sweep: {what} cannot be sent to worker processes ({problem}); define functions and "
            "classes at the top of a module, or use workers=1"
        ) from None


def _require_importable(measure: Measure) -> None:
    _packed(measure, "the measure")
    main = sys.modules.get("__main__")
    if getattr(measure, "__module__", "") == "__main__" and not hasattr(main, "__file__"):
        raise OptionError(
            "sweep: the measure was typed in, and worker processes cannot import it; put it into "
            "a module, or use workers=1"
        )


def _parts(
    folder: str | Path | None, robot: Any, measure: Measure, samples: Samples, blocks: int
) -> Parts:
    if folder is None:
        return Memory()
    fingerprint = {
        "robot": _identity(robot),
        "measure": describe(measure),
        "block": BLOCK,
        **samples.fingerprint(),
    }
    return Folder(folder, fingerprint, blocks)


def _identity(subject: Any) -> str:
    """Text that differs where two subjects do, and stays the same from run to run."""
    if isinstance(subject, Robot):
        text = f"{subject.name}|{subject.tool}|{subject.model.saveToString()}"
        return f"{subject.name}#{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    return repr(subject) if is_dataclass(subject) else type(subject).__qualname__


def _whole(value: int, what: str, unit: int) -> int:
    """A whole number above zero, in units rounded up."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 1:
        raise OptionError(f"sweep: {what} is {value!r}; it must be a whole number above zero")
    return -(-int(value) // unit)


def _rows(run: Run, count: int) -> int:
    return min(run[1] * BLOCK, count) - run[0] * BLOCK
