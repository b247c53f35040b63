"""A class marked: worker processes, one submission at a time each; resumable, in any order."""

from __future__ import annotations

import contextlib
import hashlib
import json
import multiprocessing
import os
import signal
import sys
import time
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

from kinlab.arrays import shown, whole, word
from kinlab.doctor.marking.handout import students_of
from kinlab.doctor.marking.judge import judge
from kinlab.doctor.marking.marks import Mark, Marks, Outcome, failed, lost, slug_of
from kinlab.doctor.marking.own_answer import check_answers
from kinlab.doctor.marking.pages import pictures_of
from kinlab.doctor.marking.program import judge_program
from kinlab.doctor.marking.results import RECORDS, withdraw, write_marks
from kinlab.doctor.marking.sheet import FEEDBACK, Sheet, SheetError, read_sheet, sheet_of
from kinlab.doctor.marking.students import by_student, not_read, with_not_read, with_strangers
from kinlab.doctor.marking.submission import (
    Submission,
    found_in,
    joined,
    of_document,
    read_submission,
    safe,
    student_of,
)
from kinlab.errors import FileError, KinlabError
from kinlab.fivebar import FiveBar
from kinlab.host.files import write_text
from kinlab.host.language import _, language
from kinlab.host.processes import end_with_parent
from kinlab.host.version import __version__ as VERSION

SECONDS = 90.0
"""Clock time of one submission, after which it is given up."""

_MEMORY = 6 << 30
_FORM = 2
"""Of what is kept of a run; one in another form is not gone on with."""


def mark(
    sheet: str | Path | Mapping[str, Any] | Sheet,
    submissions: str | Path | Mapping[str, Mapping[str, Any]] | Sequence[str | Path],
    output: str | Path | None = None,
    *,
    feedback: str | None = None,
    run_python: bool = False,
    workers: int | None = None,
    progress: Callable[[int, int, str], None] | None = None,
) -> Marks:
    """Marks submissions against a sheet.

    Args:
        sheet: a path, what the file would hold, or from ``read_sheet``.
        submissions: a folder, files, or student's id to answers by question's id.
        output: a folder for marks.csv, pages and results; a run that was stopped goes on there.
        feedback: ``"verdict"``, ``"place"``, ``"cause"`` or ``"answer"``; the sheet's own if None.
        run_python: whether files in Python are run, each in a process of its own with limits.
        workers: processes; None: as many as there are processors. 1 marks in this process, where
            no submission can be given up for taking too long.
        progress: called with how many are done, of how many, and which was the last.

    Returns:
        The marks; the same whatever the order and the number of workers.

    Raises:
        SheetError: the sheet cannot be used.
        FileError: no submissions, or the output cannot be written.
        NameUnknownError: no such feedback.
        OptionError: workers below 1.
    """
    read = _sheet(sheet)
    check_answers(read)
    known = students_of(read.variation.ids) if read.variation and read.variation.ids else []
    level = read.feedback if feedback is None else word(feedback, FEEDBACK, "feedback")
    if output is not None and not isinstance(output, (str, Path)):
        raise FileError(f"output is {shown(output)}; give a folder")
    count = whole(workers, "workers") if workers is not None else (os.cpu_count() or 1)
    if isinstance(submissions, Mapping):
        done = [_of_mapping(read, who, given, level) for who, given in submissions.items()]
    else:
        done = _of_files(read, submissions, output, level, run_python, count, progress)
    others = not_read(submissions) if isinstance(submissions, (str, Path)) else []
    students = with_strangers(with_not_read(by_student(done), others), known)
    marks = Marks(read, tuple(students), level, tuple(others))
    if output is None:
        return marks
    marks = replace(marks, withdrawn=withdraw(Path(output), {one.slug for one in done}))
    write_marks(marks, Path(output))
    return marks


def _sheet(sheet: str | Path | Mapping[str, Any] | Sheet) -> Sheet:
    if isinstance(sheet, Sheet):
        return sheet
    if isinstance(sheet, Mapping):
        return sheet_of(sheet, "sheet", json.dumps(sheet, sort_keys=True, default=str))
    if not isinstance(sheet, (str, Path)):
        raise SheetError(f"sheet is {shown(sheet)}; give a path, or what its file would hold")
    return read_sheet(sheet)


def _of_mapping(sheet: Sheet, student: Any, given: Mapping[str, Any], level: str) -> Mark:
    who = str(student)
    try:
        if not isinstance(given, Mapping):
            said = _("{student}: {type}; give answers by question's id")
            raise FileError(said.format(student=who, type=type(given).__name__))
        submission = of_document({**given, "student": who}, sheet, who, who)
    except KinlabError as problem:
        return _unread(sheet, who, who, str(problem), slug_of(who))
    outcomes = tuple(judge(sheet, submission, level))
    return _finished(who, submission, outcomes, slug_of(who))


def _paths(submissions: Any) -> list[Path]:
    try:
        if not isinstance(submissions, (bytes, bytearray)):
            return [Path(path) for path in submissions]
    except TypeError:
        pass
    raise FileError(
        f"submissions is {shown(submissions)}; give a folder, paths, or answers by student"
    )


def _of_files(
    sheet: Sheet,
    submissions: str | Path | Sequence[str | Path],
    output: str | Path | None,
    level: str,
    run_python: bool,
    workers: int,
    progress: Callable[[int, int, str], None] | None,
) -> list[Mark]:
    if isinstance(submissions, (str, Path)):
        root: Path | None = Path(submissions)
        paths = found_in(submissions)
    else:
        root, paths = None, _paths(submissions)
    records = Path(output) / RECORDS if output is not None else None
    if records is not None:
        try:
            records.mkdir(parents=True, exist_ok=True)
        except OSError as problem:
            raise FileError(f"{output}: cannot be written ({problem.strerror})") from None
    work = _Work(sheet, root, level, run_python)
    done: dict[Path, Mark] = {}
    prints = {path: work.fingerprint(path) for path in paths}
    for path in paths:
        kept = _recorded(records, work.slug(path), prints[path])
        if kept is not None:
            done[path] = kept
    left = [path for path in paths if path not in done]
    for path, mark_ in _worked(work, left, workers):
        done[path] = mark_
        if records is not None and not mark_.failed:
            record = {"print": prints[path], "mark": _as_record(mark_)}
            write_text(records / f"{mark_.slug}.json", json.dumps(record, ensure_ascii=False))
        if progress is not None:
            progress(len(done), len(paths), mark_.file)
    return [done[path] for path in paths]


class _Work:
    """What a worker needs to mark any submission of a class."""

    def __init__(self, sheet: Sheet, root: Path | None, level: str, run_python: bool) -> None:
        self.sheet, self.root, self.level, self.run_python = sheet, root, level, run_python

    def shown(self, path: Path) -> str:
        return str(path.relative_to(self.root)) if self.root is not None else path.name

    def slug(self, path: Path) -> str:
        return slug_of(self.shown(path))

    def fingerprint(self, path: Path) -> str:
        digest = hashlib.sha256()
        settings = (self.level, self.run_python, language())
        robot = self.sheet.robot
        numbers = robot.values() if isinstance(robot, FiveBar) else robot.urdf
        parts = (VERSION, _FORM, self.sheet.text, str(numbers), *settings)
        digest.update(repr(parts).encode())
        with contextlib.suppress(OSError):
            if path.is_file() and not path.is_symlink() and path.stat().st_size < 1 << 20:
                digest.update(path.read_bytes())
        return digest.hexdigest()

    def mark(self, path: Path) -> Mark:
        """Marks one; whatever is wrong with it is in its mark."""
        shown, slug = self.shown(path), self.slug(path)
        who = student_of(path, self.root)
        try:
            submission = read_submission(path, self.sheet, self.root)
            who = submission.student
            if not submission.program:
                outcomes = judge(self.sheet, submission, self.level)
            elif self.run_python:
                outcomes, limits = judge_program(self.sheet, submission, self.level)
                submission = replace(submission, aside=joined(submission.aside, limits))
            else:
                said = _("{file}: a Python file; it is run only with --run-python")
                raise FileError(said.format(file=shown))
            return _finished(shown, submission, tuple(outcomes), slug)
        except KinlabError as problem:
            return _unread(self.sheet, shown, who, str(problem), slug)
        except Exception as problem:  # noqa: BLE001  as in judge
            outcomes = [failed(question, problem) for question in self.sheet.questions]
            return Mark(shown, safe(who), "", tuple(outcomes), outcomes[0].remark, slug)


def _finished(file: str, submission: Submission, outcomes: tuple[Outcome, ...], slug: str) -> Mark:
    pictures = {one.question: pictures_of(one.formulas) for one in outcomes}
    who, notes = (submission.student, submission.name), (submission.note, submission.aside)
    return Mark(file, *who, outcomes, notes[0], slug, pictures, notes[1])


def _unread(sheet: Sheet, file: str, student: str, reason: str, slug: str) -> Mark:
    outcomes = tuple(lost(question, reason) for question in sheet.questions)
    note = _("the submission could not be read")
    return Mark(file, safe(student), "", outcomes, note, slug, unread=reason)


# -------- What is kept of a run


def _as_record(mark_: Mark) -> dict[str, Any]:
    pictures = {k: list(v) for k, v in (mark_.pictures or {}).items()}
    return {
        "file": mark_.file,
        "student": mark_.student,
        "name": mark_.name,
        "note": mark_.note,
        "slug": mark_.slug,
        "pictures": pictures,
        "aside": mark_.aside,
        "unread": mark_.unread,
        "outcomes": [outcome.as_dict() for outcome in mark_.outcomes],
    }


def _recorded(folder: Path | None, slug: str, fingerprint: str) -> Mark | None:
    """What an earlier run found, where nothing has changed since."""
    if folder is None:
        return None
    try:
        record = json.loads((folder / f"{slug}.json").read_text(encoding="utf-8"))
        if record["print"] != fingerprint:
            return None
        kept = record["mark"]
        outcomes = tuple(Outcome(**_tuples(one)) for one in kept.pop("outcomes"))
        pictures = {k: tuple(v) for k, v in kept.pop("pictures").items()}
        return Mark(**kept, outcomes=outcomes, pictures=pictures)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


def _tuples(values: dict[str, Any]) -> dict[str, Any]:
    made = {k: tuple(v) if isinstance(v, list) else v for k, v in values.items()}
    made["formulas"] = tuple((name, latex) for name, latex in values["formulas"])
    return made


# -------- Workers


def _worked(work: _Work, paths: Sequence[Path], workers: int) -> Iterable[tuple[Path, Mark]]:
    """Each submission with its mark, as they are finished."""
    if workers == 1 or len(paths) == 1:
        for path in paths:
            yield path, work.mark(path)
        return
    queue = list(reversed(paths))
    crew = [_Worker(work) for _ in range(min(workers, len(paths)))]
    try:
        for worker in crew:
            if queue:
                worker.give(queue.pop())
        while any(worker.path is not None for worker in crew):
            for worker in _ready(crew):
                finished = worker.path
                assert finished is not None
                yield finished, worker.take()
                if queue:
                    worker.give(queue.pop())
    finally:
        for worker in crew:
            worker.end()


def _ready(crew: Sequence[_Worker]) -> list[_Worker]:
    """The workers that have finished, or died, or are late."""
    busy = {worker.pipe: worker for worker in crew if worker.path is not None}
    until = min(worker.until for worker in busy.values())
    found = wait(list(busy), timeout=max(0.05, until - time.monotonic()))
    if found:
        return [busy[pipe] for pipe in found]
    return [worker for worker in busy.values() if worker.until <= time.monotonic()]


class _Worker:
    """One process; a new one takes its place when a submission has cost it its life."""

    def __init__(self, work: _Work) -> None:
        self._work = work
        self.path: Path | None = None
        self.until = 0.0
        self._start()

    def _start(self) -> None:
        # a forked child has everything imported already; elsewhere fork is not to be trusted
        context: Any = multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")
        self.pipe, other = context.Pipe()
        self._process = context.Process(target=_serve, args=(other, self._work), daemon=True)
        sys.stdout.flush()
        sys.stderr.flush()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)
            self._process.start()
        other.close()

    def give(self, path: Path) -> None:
        self.path, self.until = path, time.monotonic() + SECONDS
        with contextlib.suppress(OSError):
            self.pipe.send(path)

    def take(self) -> Mark:
        path = self.path
        assert path is not None
        self.path = None
        try:
            if self.pipe.poll(0):
                mark_: Mark = self.pipe.recv()
                return mark_
            reason = _("{file}: took longer than {seconds:g} s")
        except (EOFError, OSError):
            reason = _("{file}: ended the process that marked it")
        self.end()
        self._start()
        shown = self._work.shown(path)
        slug = self._work.slug(path)
        reason = reason.format(file=shown, seconds=SECONDS)
        who = student_of(path, self._work.root)
        return _unread(self._work.sheet, shown, who, reason, slug)

    def end(self) -> None:
        self._process.kill()
        self._process.join()
        self.pipe.close()


def _serve(pipe: Any, work: _Work) -> None:
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent ends it
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
    while True:
        try:
            path = pipe.recv()
        except EOFError:
            os._exit(0)
        pipe.send(work.mark(path))
