"""Run by path in an interpreter of its own: the wrong lines of a student's function, in words.

Unlike ``child.py`` this process knows kinlab and the right answers, and what it says is worth
points. So a program is run here only if it is plain arithmetic, of which ``arithmetic.py`` is the
judge, and within the same limits. Read from stdin: the request; written to the descriptor it was
given: a line of JSON for each step of the search, the next one when a line is asked for.
"""

import contextlib
import json
import linecache
import os
import pickle
import sys
from dataclasses import asdict
from pathlib import Path
from typing import Any

_KNOWN = ("kinlab", "pinocchio")


def main() -> None:
    """Reads the request, sets the limits, looks for lines."""
    root = Path(__file__).resolve().parents[4]
    sys.path.insert(0, str(root))
    import numpy as np

    from kinlab.doctor.marking.confined.arithmetic import space_of
    from kinlab.doctor.marking.confined.child import MODULES, confined, limited, offline, refuse
    from kinlab.formulas.record import state_by_state

    program, names, seconds, megabytes, work, arguments = pickle.load(sys.stdin.buffer)
    channel = os.fdopen(int(sys.argv[1]), "w", encoding="utf-8")
    roots = {
        os.path.realpath(path) + os.sep
        for path in (sys.prefix, sys.base_prefix, np.__path__[0], root / "kinlab")
    }
    offline()
    confined([*roots, "/lib", "/lib64", "/usr/lib"])
    limited(seconds, megabytes)
    modules = tuple(name for name in MODULES if name not in _KNOWN)
    refuse(tuple(sorted(roots)), modules, ("sys._getframe", "sys.setprofile"))
    with contextlib.suppress(Exception):
        space = space_of(program, "submission.py")
        function: Any = next(space[name] for name in names if callable(space.get(name)))
        lines = program.splitlines(keepends=True)
        linecache.cache["submission.py"] = (len(program), None, lines, "submission.py")
        for found in work(state_by_state(function), *arguments):
            told = [asdict(cause) for cause in found.causes]
            for one in told:
                del one["corrected"], one["typed"]
            reply = {
                "causes": told,
                "written_out": found.written_out,
                "numbers": found.numbers.tolist(),
            }
            channel.write(json.dumps(reply) + "\n")
            channel.flush()
            if not sys.stdin.buffer.readline():
                break
    os._exit(0)


if __name__ == "__main__":
    main()
