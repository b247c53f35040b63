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
import re
import select
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import IO, Any

import numpy as np

from kinlab.check.diagnosis import Cause
from kinlab.check.quantities.registry import quantity as find_quantity
from kinlab.check.quantities.registry import split_name
from kinlab.doctor.marking.judge import judge, of_values, states_of
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
_STARTS, _LATE = 12, 3
"""Processes of one program, and how many of them may take all of their time."""
_QUOTED = r"(?:[rR]?([\"'])([^\"'\n]+)\1|(-?[\d.]+))"
_DONE = b'{"done": true}\n'
_LARGEST = 8 << 20


def judge_program(sheet: Sheet, submission: Submission, level: str) -> tuple[list[Outcome], str]:
    """The outcomes of a Python file, and what the system enforced while it ran.

    A question is answered by the function called as its id or its entry, which takes one state:
    the quantity's arguments in order. One with an answer of the sheet's own has none. The functions
    are asked one after the other; one that does not come back, or ends the process, costs its own
    question, and the others are asked in a new process.

    Args:
        sheet: what is asked.
        submission: with the program.
        level: of feedback.
    """
    asked = [question for question in sheet.questions if question.quantity]
    states = {q.id: states_of(sheet, q, submission.student) for q in asked}
    wanted = [
        [q.id, [q.id, q.entry], list(find_quantity(split_name(q.quantity)[0]).arguments)]
        for q in asked
    ]
    arguments = {k: {n: v.tolist() for n, v in s.items()} for k, s in states.items()}
    ran = _run(submission.program, wanted, arguments)
    outcomes = []
    for question in sheet.questions:
        found = ran.answers.get(question.id, {})
        if question.answer:
            outcomes.append(_as_text(sheet, question, submission, level))
        elif "error" in found or (ran.error and "values" not in found):
            error = found.get("error", ran.error)
            said = in_words(str(error), submission.program)
            outcomes.append(lost(question, f"{question.id}: {said}" if found else said))
        elif "values" not in found:
            outcomes.append(replace(missing(question), remark=_no_function(question, ran)))
        else:
            outcomes.append(_of(sheet, question, submission, found, level))
    limits = _("run with limits of: {limits}").format(limits=ran.enforced or _("time"))
    return outcomes, limits


def _as_text(sheet: Sheet, question: Question, submission: Submission, level: str) -> Outcome:
    """The outcome of a question that no function answers: by a line such as q3 = "-k*q1".

    The line is read and not run.
    """
    line = rf"^{re.escape(question.id)}[ \t]*=[ \t]*{_QUOTED}[ \t]*(?:#.*)?$"
    found = re.search(line, submission.program, re.MULTILINE)
    if found is not None:
        answers = {question.id: {"": found[2] or found[3]}}
        alone = replace(sheet, questions=(question,))
        return judge(alone, replace(submission, answers=answers), level)[0]
    said = _(
        'no function is asked for this; write a line {question} = "formula", or hand in a second '
        "file, such as {file}, with the line {question}: formula"
    )
    said = said.format(question=question.id, file=f"{Path(submission.file).stem}.txt")
    return replace(missing(question), remark=said)


def _no_function(question: Question, ran: _Ran) -> str:
    """Which functions there are, where the one for a question is not among them."""
    if not ran.functions:
        return ""
    names = ", ".join(dict.fromkeys((question.id, question.entry)))
    said = _("no function is called {names}; there are: {functions}")
    return said.format(names=names, functions=", ".join(ran.functions[:6]))


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
        values = np.array(found["values"], dtype=float).reshape([int(k) for k in found["shape"]])
        asked = partial(_ask, submission.program, [question.id, question.entry])
        lines = partial(lines_elsewhere, asked)
        return of_values(sheet, question, submission.student, values, level, lines)
    except (KinlabError, TypeError, ValueError, KeyError) as problem:
        return lost(question, f"{question.id}: {str(problem)[:200]}")


@dataclass
class _Ran:
    """What came of a program.

    Attributes:
        answers: question to values and shape, or to an error; empty where there is no function.
        functions: that it defines.
        error: how its lines outside of functions ended, where too soon.
        enforced: what the system limited.
    """

    answers: dict[str, dict[str, Any]] = field(default_factory=dict)
    functions: list[str] = field(default_factory=list)
    error: str = ""
    enforced: str = ""


def _run(program: str, wanted: list[Any], arguments: dict[str, Any]) -> _Ran:
    """What the processes answered: one, and another after each that came to an early end."""
    ran, waiting, late = _Ran(), list(wanted), 0
    request = {"program": program, "seconds": SECONDS, "megabytes": MEGABYTES}
    for _start in range(_STARTS):
        begun = time.monotonic()
        names = [question for question, *_rest in waiting]
        asked = {k: v for k, v in arguments.items() if k in names}
        lines, ending = _told(json.dumps({**request, "wanted": waiting, "arguments": asked}))
        late += time.monotonic() - begun > SECONDS / 2
        limits = lines.pop(0) if lines else []
        known = [part for part in limits if part in _LIMITS] if isinstance(limits, list) else []
        ran.enforced = _(", ").join(_(limit) for limit in known) or ran.enforced
        said = lines.pop(0) if lines else None
        if not isinstance(said, dict) or not isinstance(said.get("functions"), list):
            ran.error = ran.error or ending or _("no answer")
            return ran
        ran.functions = [str(name)[:40] for name in said["functions"][:20]]
        ran.error = str(said.get("error", ""))[:200]
        for one in lines:
            if isinstance(one, dict) and waiting and one.get("question") == waiting[0][0]:
                ran.answers[waiting.pop(0)[0]] = one
        if not waiting or not ending:
            break
        ran.answers[waiting.pop(0)[0]] = {"error": ending}
        if late >= _LATE:
            break
    for question, *_rest in waiting:
        ran.answers.setdefault(question, {"error": _("not asked: the program used up its time")})
    return ran


def _told(request: str) -> tuple[list[Any], str]:
    """The lines that a process wrote, and how it ended where that was too soon or too late."""
    with _confined("child.py") as (process, requests, reading):
        try:
            requests.write(request.encode() + b"\n")
            requests.close()
        except BrokenPipeError:
            return [], _("its process did not start")
        content, ending = _received(reading, process, None)
    whole = content.decode("utf-8", "replace").split("\n")[:-1]
    return [_line(line) for line in whole], ending


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


def _received(
    reading: int, process: subprocess.Popen[bytes], lines: int | None
) -> tuple[bytes, str]:
    """What came, and how it ended where that was too soon or too late.

    Args:
        reading: the descriptor.
        process: that writes.
        lines: how many are awaited; None: until it says that it is done.
    """
    until = time.monotonic() + SECONDS + 5.0
    content = b""
    while content.count(b"\n") < lines if lines else not content.endswith(_DONE):
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


# -------- What went wrong, in words

_REFUSED = (
    N_("a submission may not import {name}"),
    N_("a submission may not read folders"),
    N_("a submission may not read files"),
    N_("a submission may not write files"),
    N_("a submission may not use {name}"),
    N_("the answer is too large"),
)
"""What the process says in English."""
_ENDED = N_("SystemExit: it ends the program; delete exit() or sys.exit()")
_IMPORT = re.compile(r"^[ \t]*(?:import|from)[ \t]+([A-Za-z_]\w*)", re.MULTILINE)


def in_words(error: str, program: str) -> str:
    """What a program's error is, and what its writer should do.

    Args:
        error: as the process told it.
        program: the text.
    """
    if error.startswith(("ImportError", "ModuleNotFoundError", "PermissionError")):
        known = {*sys.stdlib_module_names, "numpy"}
        others = [name for name in _IMPORT.findall(program) if name not in known]
        if others and others[0] != "kinlab":
            said = _(
                "the program imports {module}, and only numpy and the standard library are here; "
                "delete that line and what uses it, such as figures, and hand the file in again"
            )
            return said.format(module=others[0][:40])
    for sentence in _REFUSED:
        front, name, behind = sentence.partition("{name}")
        found = re.search(re.escape(front) + (r"([\w.]+)" if name else "") + behind, error)
        if found:
            return _(sentence).format(name=found[1] if name else "")
    return _(_ENDED) if "SystemExit" in error else error[:200]
