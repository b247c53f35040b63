"""A user's file of marked functions, in a process of its own with a limit of time.

What such a file does to its process (``exit()``, ``os._exit``, a crash in C, an endless loop) is
a failure of its function, and never the end of the check. What it prints goes to stderr.
"""

from __future__ import annotations

import importlib.util
import multiprocessing
import os
import signal
import sys
import warnings
import weakref
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import islice
from pathlib import Path
from types import ModuleType
from typing import Any

from kinlab import errors
from kinlab.arrays import Array
from kinlab.errors import FileError, KinlabError, OptionError
from kinlab.formulas.record import AnswerShapeError, Formula, FormulaError, formulas_in
from kinlab.host.processes import end_with_parent

VARIABLE = "KINLAB_CHECK_SECONDS"
"""Environment variable: seconds that a file may take to load, and a function for all states."""

_SECONDS = 15.0


class FunctionLostError(FormulaError):
    """A marked function ended its process, or did not come back."""


class Guest:
    """One user's file, loaded in a process of its own, started again after it was lost.

    Args:
        path: the file.

    Raises:
        FileError: no such file, or not a Python file.
        FormulaError: loading it raised, ended the process, or took too long.
    """

    def __init__(self, path: str) -> None:
        self._path = path
        self._seconds = _limit()
        self._asked = 0
        self._process: Any = None
        self._pipe: Any = None
        if not Path(path).is_file():
            raise FileError(f"{path}: no such file")
        self._records = self._start()

    @property
    def formulas(self) -> list[Formula]:
        """The marked functions; the process ends when neither they nor this are in use."""
        return [
            replace(record, function=GuestFunction(self, k, record.id))
            for k, record in enumerate(self._records)
        ]

    def ask(
        self, index: int, name: str, work: Callable[..., Iterator[Any]], *arguments: Any
    ) -> Iterator[Any]:
        """What some work on one function yields there, each when it is asked for.

        Args:
            index, name: which function, and what to call it.
            work: ``work(function, *arguments)``, a generator that a module has; it travels as a
                name, its arguments as values.

        Raises:
            FormulaError: what it raised.
            FunctionLostError: it ended its process, or took too long.
        """
        what = f"function {name!r}"
        self._asked += 1
        request: tuple[Any, ...] = (self._asked, index, work, arguments)
        while True:
            if self._process is None:
                self._start()
            try:
                self._pipe.send(request)
            except OSError:
                self._lost(what)
            answer = self._answer(what)
            if not answer:
                return
            yield answer[0]
            request = request[:1]

    def _start(self) -> list[Formula]:
        # a forked child has everything imported already; elsewhere fork is not to be trusted
        method = "fork" if sys.platform == "linux" else "spawn"
        context: Any = multiprocessing.get_context(method)
        self._pipe, other = context.Pipe()
        process = context.Process(
            target=_serve,
            args=(other, self._pipe if method == "fork" else None, self._path),
            daemon=True,
            name="kinlab check",
        )
        sys.stdout.flush()
        sys.stderr.flush()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # fork beside a progress bar
            process.start()
        other.close()
        self._process = process
        weakref.finalize(self, process.kill)
        records: list[Formula] = self._answer(self._path, load=True)
        return records

    def _answer(self, what: str, *, load: bool = False) -> Any:
        if not self._pipe.poll(self._seconds):
            self._end()
            error = FormulaError if load else FunctionLostError
            late = f"{what} did not come back within {self._seconds:g} s"
            raise error(f"{late} ({VARIABLE} allows more)")
        try:
            kind, content = self._pipe.recv()
        except (EOFError, OSError):
            self._lost(what, load=load)
        if kind == "good":
            return content
        raise _ERRORS.get(kind, FormulaError)(content)

    def _lost(self, what: str, *, load: bool = False) -> None:
        self._process.join(self._seconds)
        code = self._process.exitcode
        self._end()
        how = f"ended its process with exit code {code}"
        if code is not None and code < 0:
            how = f"ended its process by signal {signal.Signals(-code).name}"
        raise (FormulaError if load else FunctionLostError)(f"{what} {how}")

    def _end(self) -> None:
        self._process.kill()
        self._process.join()
        self._pipe.close()
        self._process = self._pipe = None


class GuestFunction:
    """Stands for a function of the file: called as ``Formula.function`` is."""

    def __init__(self, guest: Guest, index: int, name: str) -> None:
        self._guest, self._index = guest, index
        self.__name__ = name

    def __call__(self, numbers: Any, *stacks: Array) -> Any:
        del numbers
        return next(self.ask(_answers, *stacks))

    def ask(self, work: Callable[..., Iterator[Any]], *arguments: Any) -> Iterator[Any]:
        """What ``work(function, *arguments)`` yields in its process; see :meth:`Guest.ask`."""
        return self._guest.ask(self._index, self.__name__, work, *arguments)


def _answers(function: Any, *stacks: Array) -> Iterator[Any]:
    """Of all states."""
    yield function(None, *stacks)


_ERRORS: dict[str, type[KinlabError]] = {
    name: value
    for name, value in {
        **vars(errors),
        "FormulaError": FormulaError,
        "AnswerShapeError": AnswerShapeError,
    }.items()
    if isinstance(value, type) and issubclass(value, KinlabError)
}


def _limit() -> float:
    text = os.environ.get(VARIABLE)
    if text is None:
        return _SECONDS
    try:
        seconds = float(text)
    except ValueError:
        seconds = -1.0
    if not 0.0 < seconds < 1e6:
        raise OptionError(f"{VARIABLE} is {text!r}; give a number of seconds above zero")
    return seconds


def _serve(pipe: Any, others: Any, path: str) -> None:
    """The child: loads the file, then does what it is asked until the parent has gone."""
    if others is not None:
        others.close()
    end_with_parent()
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent ends it
    os.dup2(2, 1)  # what the file prints must not stand among the rows, or in the JSON
    functions: list[Any] = []

    def load() -> list[Formula]:
        records = formulas_in(_module(Path(path)))
        functions.extend(record.function for record in records)
        return [replace(record, function=_without_answer) for record in records]

    _reply(pipe, load, f"{path}: ")
    going: dict[int, Iterator[Any]] = {}
    while True:
        try:
            number, *fresh = pipe.recv()
        except EOFError:
            os._exit(0)
        if fresh:
            index, work, arguments = fresh
            going = {number: work(functions[index], *arguments)}
        _reply(pipe, lambda g=going, k=number: tuple(islice(g[k], 1)), "")


def _reply(pipe: Any, work: Any, place: str) -> None:
    try:
        message = ("good", work())
    except KinlabError as problem:
        message = (type(problem).__name__, str(problem))
    except SystemExit as end:
        pipe.close()
        os._exit(end.code if isinstance(end.code, int) else 0 if end.code is None else 1)
    except BaseException as problem:  # noqa: BLE001  whatever a user's file may raise
        message = ("FormulaError", f"{place}{type(problem).__name__}: {problem}")
    try:
        pipe.send(message)
    except Exception as problem:  # noqa: BLE001  an answer that cannot be sent
        pipe.send(("FormulaError", f"{place}the answer cannot be read: {problem}"))


def _without_answer(*anything: Any) -> None:
    """Stands for a function while its record travels."""


def _module(path: Path) -> ModuleType:
    name = f"_kinlab_check_{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise FileError(f"{path}: not a Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # and stays: the child has no other use
    spec.loader.exec_module(module)
    return module
