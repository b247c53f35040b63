"""Cases run in worker processes: a crash or a hang costs one case, not the campaign.

A judge is a function of one picklable case that answers ``(outcome, detail)``. The outcomes are
``right``, ``refused`` (a KinlabError), ``wrong`` (an answer that the oracle denies), ``raw`` (any
other exception), and what only the pool can see: ``crash`` and ``hang``.
"""

from __future__ import annotations

import atexit
import contextlib
import functools
import json
import os
import pickle
import random
import resource
import select
import struct
import subprocess
import sys
import threading
import time
import traceback
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
LONG = os.environ.get("KINLAB_FUZZ", "") == "long"
SEED = int(os.environ.get("KINLAB_FUZZ_SEED", "0"))
SCALE = float(os.environ.get("KINLAB_FUZZ_SCALE", "50" if LONG else "1"))
WORKERS = int(
    os.environ.get("KINLAB_FUZZ_WORKERS", "1" if "PYTEST_XDIST_WORKER" in os.environ else "2")
)
MEMORY = 6 << 30
PATIENCE = 6.0
"""Times its processor seconds that a case may last by the clock: what waits for ever hangs too."""
BAD = ("wrong", "raw", "crash", "hang")

Outcome = tuple[str, str]


def count(short: int) -> int:
    """How many cases a campaign runs: ``short`` in the short mode, more in the long one."""
    return max(1, round(short * SCALE))


class _Worker:
    def __init__(self, judge: str) -> None:
        environment = os.environ | {"KINLAB_THREADS": "1", "PYTHONWARNINGS": "ignore"}
        self._process = subprocess.Popen(
            [sys.executable, str(HERE / "fuzz_pool.py"), judge],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=environment,
        )

    def ask(self, case: Any, seconds: float) -> Outcome | None:
        """The outcome, or None where the worker is gone."""
        data = pickle.dumps(case)
        assert self._process.stdin is not None and self._process.stdout is not None
        try:
            self._process.stdin.write(struct.pack("<I", len(data)) + data)
            self._process.stdin.flush()
        except BrokenPipeError:
            return self._gone()
        begun, end, got = self._worked(), time.monotonic() + PATIENCE * seconds, b""
        number = self._process.stdout.fileno()
        while not got.endswith(b"\n"):
            ready, _, _ = select.select([number], [], [], 1.0)
            if not ready:
                if self._worked() - begun < seconds and time.monotonic() < end:
                    continue
                self.close()
                return "hang", f"no answer in {seconds:g} s"
            part = os.read(number, 1 << 16)
            if not part:
                return self._gone()
            got += part
        kind, detail = json.loads(got)
        return kind, detail

    def _worked(self) -> float:
        """Processor seconds of the worker: on a busy machine a case takes longer, not more."""
        try:
            fields = Path(f"/proc/{self._process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            return 0.0
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def _gone(self) -> Outcome:
        code = self._process.wait()
        return "crash", f"the process ended with {code}"

    def alive(self) -> bool:
        return self._process.poll() is None

    def close(self) -> None:
        self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                with contextlib.suppress(BrokenPipeError):
                    stream.close()


def run(
    judge: str, cases: Sequence[Any], *, seconds: float = 30.0, workers: int = WORKERS
) -> list[Outcome]:
    """Judges every case.

    Args:
        judge: ``"module:function"``, the module being in this folder.
        cases: what the function is called with.
        seconds: processor time that one case may take.
        workers: processes.

    Returns:
        One outcome per case.
    """
    outcomes: list[Outcome] = [("hang", "not run")] * len(cases)
    queue = iter(range(len(cases)))
    lock = threading.Lock()

    def serve() -> None:
        worker = _Worker(judge)
        try:
            while True:
                with lock:
                    index = next(queue, None)
                if index is None:
                    return
                if not worker.alive():
                    worker.close()
                    worker = _Worker(judge)
                answer = worker.ask(cases[index], seconds)
                assert answer is not None
                outcomes[index] = answer
        finally:
            worker.close()

    threads = [threading.Thread(target=serve) for _ in range(max(1, min(workers, len(cases))))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return outcomes


def tally(outcomes: Iterable[Outcome]) -> Counter[str]:
    """How many cases had each outcome."""
    return Counter(kind for kind, _ in outcomes)


def shown(
    labels: Sequence[str], outcomes: Sequence[Outcome], bad: Sequence[str] = BAD, limit: int = 12
) -> str:
    """The bad cases for people: grouped by what happened, with one label each."""
    groups: dict[str, list[str]] = defaultdict(list)
    for label, (kind, detail) in zip(labels, outcomes, strict=True):
        if kind in bad:
            groups[f"{kind}: {detail[:160]}"].append(label)
    lines = [f"seed {SEED}; outcomes {dict(tally(outcomes))}"]
    for what, where in sorted(groups.items(), key=lambda item: -len(item[1]))[:limit]:
        lines.append(f"  {len(where):4d} x {what}\n         e.g. {where[0][:300]}")
    if len(groups) > limit:
        lines.append(f"  and {len(groups) - limit} more kinds")
    report = os.environ.get("KINLAB_FUZZ_REPORT")
    if report and groups:
        with Path(report).open("a") as file:
            for label, (kind, detail) in zip(labels, outcomes, strict=True):
                if kind in bad:
                    file.write(json.dumps({"case": label, "outcome": kind, "why": detail}) + "\n")
    return "\n".join(lines)


def demand(
    judge: str,
    cases: Sequence[tuple[str, Any]],
    bad: Sequence[str] = BAD,
    *,
    seconds: float = 30.0,
) -> Counter[str]:
    """Judges labelled cases and fails with a table of the bad ones.

    Returns:
        How many cases had each outcome.

    Raises:
        AssertionError: an outcome is among the bad ones.
    """
    labels = [label for label, _ in cases]
    outcomes = run(judge, [case for _, case in cases], seconds=seconds)
    if any(kind in bad for kind, _ in outcomes):
        raise AssertionError(shown(labels, outcomes, bad))
    return tally(outcomes)


def some(jobs: dict[str, Any], short: int, always: Sequence[str] = ()) -> dict[str, Any]:
    """The jobs of a run: all in the long mode, else the ones named and others drawn by the seed."""
    rest = [name for name in jobs if name not in always]
    drawn = random.Random(SEED).sample(rest, min(len(rest), count(short)))
    return {name: job for name, job in jobs.items() if name in always or name in drawn}


@functools.cache
def _kept(judge: str) -> list[_Worker]:
    return []


def demand_one(judge: str, label: str, case: Any, *, seconds: float = 30.0) -> str:
    """Judges one case, for Hypothesis; the worker is kept for the next one.

    Returns:
        The outcome.

    Raises:
        AssertionError: it is a bad one.
    """
    kept = _kept(judge)
    if not kept or not kept[0].alive():
        kept[:] = [_Worker(judge)]
        atexit.register(kept[0].close)
    kind, detail = kept[0].ask(case, seconds) or ("crash", "")
    if kind in BAD:
        raise AssertionError(f"KINLAB_FUZZ_SEED={SEED}; {label[:300]}\n{kind}: {detail}")
    return kind


def seeded(seed: int) -> int:
    """A case's seed within this run's."""
    return (SEED << 32) + seed


def last_line() -> str:
    """The exception now handled, with the innermost line of kinlab in it."""
    kind, value, trace = sys.exc_info()
    place = ""
    for frame in traceback.extract_tb(trace):
        if "/kinlab/" in frame.filename.replace(os.sep, "/"):
            place = f" at {Path(frame.filename).name}:{frame.lineno}"
    text = " ".join(str(value).split())
    return f"{getattr(kind, '__name__', kind)}: {text[:200]}{place}"


def _serve(judge: str) -> None:
    """The worker's side; what a case prints goes nowhere."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    answer = os.fdopen(os.dup(1), "w")
    nowhere = os.open(os.devnull, os.O_RDWR)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    source = os.fdopen(os.dup(0), "rb")
    os.dup2(nowhere, 0)
    sys.path.insert(0, str(HERE))
    module, name = judge.split(":")
    function: Callable[[Any], Outcome] = getattr(__import__(module), name)
    from kinlab import KinlabError

    while head := source.read(4):
        case = pickle.loads(source.read(struct.unpack("<I", head)[0]))
        try:
            outcome = function(case)
        except KinlabError as problem:
            message = str(problem)
            outcome = ("refused", message) if message.strip() else ("raw", "an empty KinlabError")
        except BaseException:  # noqa: BLE001  what escapes is the finding
            outcome = ("raw", last_line())
        answer.write(json.dumps(outcome) + "\n")
        answer.flush()


if __name__ == "__main__":
    _serve(sys.argv[1])
