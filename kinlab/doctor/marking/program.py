"""A submission in Python: run in a process of its own, only where the teacher asks for it.

The process starts afresh (it shares no memory with the marks) and gets limits of the system on
time, memory, files written and processes, on Linux a network of its own with nothing on it and no
files to read but the libraries', and an audit hook against all of these. The hook is Python's own
and can be beaten by one who tries hard; what the system enforces cannot, and the note beside the
marks says what that was. For work by strangers run all of it in a container.
"""

from __future__ import annotations

import json
import os
import pickle
import select
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import IO, Any

import numpy as np

from kinlab.check.diagnosis import Cause
from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.check.quantities.registry import split_name
from kinlab.doctor.marking.judge import of_values, states_of
from kinlab.doctor.marking.marks import Outcome, lost, missing
from kinlab.doctor.marking.sheet import Question, Sheet
from kinlab.doctor.marking.submission import Submission
from kinlab.doctor.program.elsewhere import lines_elsewhere
from kinlab.doctor.program.words import WrongLines
from kinlab.errors import KinlabError
from kinlab.host.language import N_, _

SECONDS = 10.0
"""Processor and clock time of one program."""

MEGABYTES = 1024
_LARGEST = 8 << 20


def judge_program(sheet: Sheet, submission: Submission, level: str) -> tuple[list[Outcome], str]:
    """The outcomes of a Python file, and what the system enforced while it ran.

    A question is answered by the function called as its id or its entry, which takes one state:
    the quantity's arguments in order. One with an answer of the sheet's own has none.
    """
    asked = [question for question in sheet.questions if question.quantity]
    states = {q.id: states_of(sheet, q, submission.student) for q in asked}
    wanted = [
        [q.id, [q.id, q.entry], list(find_quantity(split_name(q.quantity)[0]).arguments)]
        for q in asked
    ]
    request = {
        "program": submission.program,
        "wanted": wanted,
        "arguments": {k: {n: v.tolist() for n, v in s.items()} for k, s in states.items()},
        "seconds": SECONDS,
        "megabytes": MEGABYTES,
    }
    reply, enforced = _run(json.dumps(request))
    found = reply.get("answers")
    outcomes = []
    for question in sheet.questions:
        if not isinstance(found, dict):
            outcomes.append(lost(question, str(reply.get("error", _("no answer")))[:200]))
        elif question.answer:
            said = _("a program is not asked for this; hand in the formula in a text file")
            outcomes.append(replace(missing(question), remark=said))
        elif question.id not in found:
            outcomes.append(missing(question))
        else:
            outcomes.append(_of(sheet, question, submission, found[question.id], level))
    return outcomes, _("run with limits of: {limits}").format(limits=enforced or _("time"))


_LIMITS = (
    N_("network"),
    N_("files read"),
    N_("processor time"),
    N_("memory"),
    N_("files written"),
    N_("open files"),
    N_("processes"),
    N_("core dumps"),
)
"""What the process says that the system limits."""


def _of(
    sheet: Sheet, question: Question, submission: Submission, found: Any, level: str
) -> Outcome:
    try:
        if "error" in found:
            return lost(question, f"{question.id}: {str(found['error'])[:200]}")
        values = np.array(found["values"], dtype=float).reshape([int(k) for k in found["shape"]])
        asked = partial(_ask, submission.program, [question.id, question.entry])
        lines = partial(lines_elsewhere, asked)
        return of_values(sheet, question, submission.student, values, level, lines)
    except (KinlabError, TypeError, ValueError, KeyError) as problem:
        return lost(question, f"{question.id}: {str(problem)[:200]}")


def _run(request: str) -> tuple[dict[str, Any], str]:
    """What the process answered, or how it ended, and what the system enforced."""
    with _confined("child.py") as (process, requests, reading):
        try:
            requests.write(request.encode() + b"\n")
            requests.close()
        except BrokenPipeError:
            return {"error": _("its process did not start")}, ""
        content, ending = _received(reading, process, 2)
    first, _newline, rest = content.decode("utf-8", "replace").partition("\n")
    limits, reply = _line(first), _line(rest)
    known = [part for part in limits if part in _LIMITS] if isinstance(limits, list) else []
    enforced = _(", ").join(_(limit) for limit in known)
    if ending or not isinstance(reply, dict):
        reply = {"error": ending or _("no answer")}
    return reply, enforced


def _ask(
    program: str, names: list[str], work: Callable[..., Iterator[WrongLines]], *arguments: Any
) -> Iterator[WrongLines]:
    """What some work on one function yields in a process of its own; only text comes back.

    That process knows kinlab and the right answers, and says which slips it finds, which cost
    more or less: a program is run there only where it is plain arithmetic.
    """
    request = pickle.dumps((program, names, SECONDS, MEGABYTES, work, arguments))
    with _confined("lines.py") as (process, requests, reading):
        try:
            while True:
                requests.write(request)
                requests.flush()
                content, ending = _received(reading, process, 1)
                told = _line(content.decode("utf-8", "replace"))
                if ending or not told:
                    return
                yield WrongLines(
                    [_cause(**one) for one in told["causes"]],
                    bool(told["written_out"]),
                    np.array(told["numbers"], dtype=float),
                )
                request = b"\n"
        except (OSError, TypeError, ValueError, KeyError):
            return


def _cause(sentence: str, kinds: Any, places: Any, error_after: float, cost: float) -> Cause:
    names = tuple(map(str, kinds)), tuple(map(str, places))
    return Cause(str(sentence), *names, float(error_after), float(cost))


@contextmanager
def _confined(file: str) -> Iterator[tuple[subprocess.Popen[bytes], IO[bytes], int]]:
    """A process that runs a file of that room: where it is asked, and where it answers."""
    here = Path(__file__).with_name("confined") / file
    reading, writing = os.pipe()
    environment = {"PATH": os.defpath, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryDirectory(prefix="kinlab-mark-") as folder:
        process = subprocess.Popen(
            [sys.executable, "-I", "-B", str(here), str(writing)],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=(writing,),
            cwd=folder,
            env=environment,
            start_new_session=True,
        )
        os.close(writing)
        try:
            assert process.stdin is not None
            yield process, process.stdin, reading
        finally:
            process.kill()
            process.wait()
            os.close(reading)


def _line(text: str) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return None


def _received(reading: int, process: subprocess.Popen[bytes], lines: int) -> tuple[bytes, str]:
    """What came, and how it ended where that was too soon or too late."""
    until = time.monotonic() + SECONDS + 5.0
    content = b""
    while content.count(b"\n") < lines:
        left = until - time.monotonic()
        if left <= 0 or not select.select([reading], [], [], left)[0]:
            late = _("did not come back within {seconds:g} s")
            return content, late.format(seconds=SECONDS)
        part = os.read(reading, 1 << 16)
        if not part:
            process.wait(5.0)
            if process.returncode < 0:
                ended = _("ended its process by signal {number} (its limits)")
                return content, ended.format(number=-process.returncode)
            ended = _("ended its process with exit code {number}")
            return content, ended.format(number=process.returncode)
        content += part
        if len(content) > _LARGEST:
            return content, _("answered with more than 8 MB")
    return content, ""
