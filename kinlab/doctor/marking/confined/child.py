"""Run by path in an interpreter of its own: a student's Python file, with limits set first.

It knows numpy and the standard library, not kinlab. Read from stdin: one line of JSON (the
program, what to call, the states); written to the descriptor it was given: a line of JSON with
what the system enforces, one with the functions that the program defines, one for each question
as soon as it is answered, and one that it is done. So whoever reads knows which question it was
that ended the process.
"""

import contextlib
import json
import math
import os
import sys
from collections.abc import Iterator
from typing import Any

Reply = dict[str, Any]

_BLOCKED: tuple[str, ...] = ("socket.", "subprocess.", "shutil.", "ctypes.", "pty.", "mmap.")
_BLOCKED += ("signal.", "gc.", "ftplib.", "urllib.", "http.", "smtplib.", "webbrowser.")
_BLOCKED += ("os.exec", "os.fork", "os.posix_spawn", "os.spawn", "os.system", "os.kill")
_BLOCKED += ("os.killpg", "os.remove", "os.rename", "os.rmdir", "os.mkdir", "os.symlink")
_BLOCKED += ("os.link", "os.chmod", "os.chown", "os.truncate", "os.putenv")
_BLOCKED += ("sys._getframe", "sys.setprofile", "sys.settrace")
"""How the names of events begin that are refused."""
MODULES: tuple[str, ...] = ("kinlab", "pinocchio", "ctypes", "_ctypes", "cffi", "resource")
MODULES += ("socket", "_socket", "subprocess", "_posixsubprocess", "multiprocessing")
_MOST = 100_000
"""Numbers in one answer."""


def limited(seconds: float, megabytes: int) -> list[str]:
    """Sets what the system enforces; says what it does."""
    enforced: list[str] = []
    try:
        import resource
    except ImportError:  # not a POSIX system
        return enforced
    bounds = {
        "processor time": (resource.RLIMIT_CPU, math.ceil(seconds)),
        "memory": (resource.RLIMIT_AS, megabytes << 20),
        "files written": (resource.RLIMIT_FSIZE, 0),
        "open files": (resource.RLIMIT_NOFILE, 32),
        "processes": (resource.RLIMIT_NPROC, 0),
        "core dumps": (resource.RLIMIT_CORE, 0),
    }
    for name, (which, value) in bounds.items():
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(which, (value, value))
            enforced.append(name)
    with contextlib.suppress(OSError):  # the system lets its administrator start more
        child = os.fork()
        if child == 0:
            os._exit(0)
        os.waitpid(child, 0)
        return [name for name in enforced if name != "processes"]
    return enforced


def confined(folders: list[str]) -> bool:
    """Whether the system now lets this process open files below these folders only, to read."""
    if not sys.platform.startswith("linux"):
        return False
    import ctypes
    import struct

    create, add, restrict = 444, 445, 446  # Landlock: the same numbers on every processor
    read = 0b1101  # to execute, to read a file, to read a folder
    libc = ctypes.CDLL(None, use_errno=True)
    rules = libc.syscall(create, struct.pack("Q", (1 << 13) - 1), 8, 0)
    if rules < 0:
        return False
    for folder in folders:
        with contextlib.suppress(OSError):
            libc.syscall(add, rules, 1, struct.pack("=Qi", read, os.open(folder, os.O_PATH)), 0)
    libc.prctl(38, 1, 0, 0, 0)  # gains no rights by starting a program
    return bool(libc.syscall(restrict, rules, 0) == 0)


def offline() -> bool:
    """Whether the process now has a network of its own, with nothing on it."""
    if not sys.platform.startswith("linux"):
        return False
    import ctypes

    new_user, new_network = 0x10000000, 0x40000000
    with contextlib.suppress(OSError, AttributeError):
        libc = ctypes.CDLL(None, use_errno=True)
        libc.prctl(1, 9)  # ends with the process that started it
        return bool(libc.unshare(new_user | new_network) == 0)
    return False


def refuse(
    allowed: tuple[str, ...],
    modules: tuple[str, ...] = MODULES,
    events: tuple[str, ...] = ("sys._getframe",),
) -> None:
    """An audit hook: no sockets, no processes, no files but the libraries'.

    Args:
        allowed: folders that may be read.
        modules: what may not be imported.
        events: of those that are refused by their beginning, what passes.
    """

    def below(path: Any) -> bool:
        return (os.path.realpath(os.fsdecode(path)) + os.sep).startswith(allowed)

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        if event in ("os.listdir", "os.scandir"):  # as an import does
            if isinstance(arguments[0], int) or not below(arguments[0] or "."):
                raise PermissionError("a submission may not read folders")
        elif event == "open":
            path, mode = arguments[0], arguments[1]
            writes = isinstance(mode, str) and any(c in mode for c in "wax+")
            flags = arguments[2] if len(arguments) > 2 and isinstance(arguments[2], int) else 0
            if isinstance(path, int) or writes or flags & (os.O_WRONLY | os.O_RDWR):
                raise PermissionError("a submission may not write files")
            if not below(path):
                raise PermissionError("a submission may not read files")
        elif event == "import" and arguments[0].partition(".")[0] in modules:
            raise ImportError(f"a submission may not import {arguments[0]}")
        elif event.startswith(_BLOCKED) and event not in events:
            raise PermissionError(f"a submission may not use {event}")

    sys.addaudithook(hook)


def loaded(program: str) -> tuple[Reply, Reply]:
    """What a program defines, as far as it came, and its functions' names with how it ended."""
    space: Reply = {"__name__": "submission", "__builtins__": __builtins__}
    error: Reply = {}
    try:
        exec(compile(program, "submission.py", "exec"), space)  # noqa: S102
    except (Exception, SystemExit) as problem:  # noqa: BLE001
        error["error"] = f"{type(problem).__name__}: {problem}"[:200]
    codes = ((name, getattr(value, "__code__", None)) for name, value in [*space.items()])
    own = [name for name, code in codes if getattr(code, "co_filename", "") == "submission.py"]
    return space, error | {"functions": [name[:40] for name in own[:20]]}


def answers(space: Reply, wanted: list[Any], arguments: Reply) -> Iterator[Reply]:
    """The values of every function that is there, or what it did instead."""
    import numpy as np

    for question, names, order in wanted:
        function = next((space[name] for name in names if callable(space.get(name))), None)
        if function is None:
            yield {"question": question}
            continue
        stacks = [np.array(arguments[question][name]) for name in order]
        try:
            values = [
                np.asarray(function(*state), dtype=float) for state in zip(*stacks, strict=True)
            ]
            stacked = np.stack(values)
            if stacked.size > _MOST:
                raise ValueError("the answer is too large")
            found: Reply = {"shape": list(stacked.shape), "values": stacked.ravel().tolist()}
        except (Exception, SystemExit) as problem:  # noqa: BLE001  whatever a program may raise
            found = {"error": f"{type(problem).__name__}: {problem}"[:200]}
        yield {"question": question, **found}


def _lines(said: Reply, space: Reply, request: Reply) -> Iterator[Reply]:
    yield said
    yield from answers(space, request["wanted"], request["arguments"])
    yield {"done": True}


def main() -> None:
    """Reads the request, sets the limits, runs the program, writes the answer."""
    request = json.loads(sys.stdin.readline())
    channel = os.fdopen(int(sys.argv[1]), "w", encoding="utf-8")
    import numpy as np  # before the limits, with all that it opens

    np.linalg.norm(np.random.default_rng(0).normal(size=3))
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 1)
    os.dup2(quiet, 2)
    roots = {os.path.realpath(p) + os.sep for p in (sys.prefix, sys.base_prefix, np.__path__[0])}
    walls = {
        "network": offline(),
        "files read": confined([*roots, "/lib", "/lib64", "/usr/lib"]),
    }
    enforced = [name for name, stands in walls.items() if stands]
    enforced += limited(request["seconds"], request["megabytes"])
    channel.write(json.dumps(enforced) + "\n")
    channel.flush()
    refuse(tuple(sorted(roots)))
    space, said = loaded(request["program"])
    for line in _lines(said, space, request):
        channel.write(json.dumps(line) + "\n")
        channel.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
