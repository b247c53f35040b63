"""Small programs that the process campaign runs in interpreters of their own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def environment(**more: str) -> dict[str, str]:
    """The environment of a child, with this folder importable."""
    path = os.pathsep.join([str(HERE), *filter(None, [os.environ.get("PYTHONPATH", "")])])
    return os.environ | {"PYTHONPATH": path, "PYTHONWARNINGS": "ignore"} | more


def python(code: str, seconds: float, folder: Path | None = None, **more: str) -> tuple[int, str]:
    """Runs a program; -1000 for one that did not end. Its whole process group is ended then."""
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        env=environment(**more), cwd=folder, start_new_session=True,
    )  # fmt: skip
    try:
        return _ended(process, seconds)
    finally:
        kill_group(process.pid)


def kinlab(
    words: list[str], seconds: float, folder: Path | None = None, limit: int = 0, stdin: str = ""
) -> tuple[int, str]:
    """Runs the command; -1000 for one that did not end within the seconds."""

    def bound() -> None:
        import resource

        if limit:
            resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

    process = subprocess.Popen(
        [sys.executable, "-m", "kinlab", *words], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True, env=environment(), cwd=folder, start_new_session=True, preexec_fn=bound,
    )  # fmt: skip
    assert process.stdin is not None
    process.stdin.close()
    process.stdin = None
    try:
        return _ended(process, seconds)
    finally:
        kill_group(process.pid)


def _ended(process: subprocess.Popen[str], seconds: float) -> tuple[int, str]:
    try:
        out, _ = process.communicate(timeout=seconds)
    except subprocess.TimeoutExpired:
        kill_group(process.pid)
        out, _ = process.communicate()
        return -1000, out
    return process.returncode, out


def kill_group(group: int) -> None:
    import contextlib
    import signal

    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(group, signal.SIGKILL)


def slow(robot: object, q: object) -> object:
    """A measure for sweeps: 50 ms a block of states, one number a state."""
    import time

    time.sleep(0.05)
    return q[:, 0]  # type: ignore[index]
