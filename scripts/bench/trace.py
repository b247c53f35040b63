"""How often one warm call changes file: what a reader who follows it has to turn to.

    python scripts/bench/trace.py                  # this checkout
    python scripts/bench/trace.py --files ik       # and the files of one of them, in order

Counts, of kinlab's own Python functions only, how many are entered, how many different ones, how
many files they stand in, and how often control passes from one file to another (there and back
counts twice). Compiled code is not seen. Everything is called twice first, so that imports,
caches and compiled kernels are there.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np

import kinlab as kl

PACKAGE = Path(kl.__file__).resolve().parent


@dataclass
class Trace:
    """What :func:`trace` counted."""

    calls: int = 0
    functions: set[tuple[str, str, int]] = field(default_factory=set)
    changes: int = 0
    way: list[str] = field(default_factory=list)


def trace(call: Callable[[], Any]) -> Trace:
    """Follows one call through kinlab's own files."""
    seen = Trace()
    stack: list[str] = []

    def move(file: str) -> None:
        if not seen.way or seen.way[-1] != file:
            seen.changes += bool(seen.way)
            seen.way.append(file)

    def watch(frame: FrameType, event: str, _: Any) -> None:
        code = frame.f_code
        if event not in ("call", "return") or not code.co_filename.startswith(str(PACKAGE)):
            return
        file = code.co_filename[len(str(PACKAGE)) + 1 :]
        if event == "call":
            stack.append(file)
            seen.calls += 1
            seen.functions.add((file, code.co_qualname, code.co_firstlineno))
            move(file)
        elif stack:
            stack.pop()
            if stack:
                move(stack[-1])

    sys.setprofile(watch)
    try:
        call()
    finally:
        sys.setprofile(None)
    return seen


def subjects() -> dict[str, Callable[[], Any]]:
    """The calls that are followed."""
    from kinlab.cli import main

    puma = kl.load("puma560")
    table = puma.table
    assert table is not None
    stack = np.random.default_rng(0).uniform(-1.0, 1.0, (300, puma.n))
    start = np.full(puma.n, 0.3)
    goal = kl.fk(puma, start + 0.05)

    def check() -> None:
        arguments = sys.argv
        sys.argv = ["kinlab", "check", "planar2r"]
        try:
            with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
                main()
        finally:
            sys.argv = arguments

    return {
        "kl.ik": lambda: kl.ik(puma, goal, start),
        "Robot.from_dh": lambda: kl.Robot.from_dh(table),
        "kl.jacobian, one state": lambda: kl.jacobian(puma, start),
        "kl.jacobian, 300 rows": lambda: kl.jacobian(puma, stack),
        "kinlab check planar2r": check,
    }


def main() -> None:
    """Prints one line for each subject."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--files", help="also print the files of the subject with this in its name")
    wanted = parser.parse_args().files
    print(f"{'call':24}  changes of file  functions  files  calls")
    for name, call in subjects().items():
        call()
        call()
        seen = trace(call)
        files = {file for file, _, _ in seen.functions}
        print(
            f"{name:24}  {seen.changes:15}  {len(seen.functions):9}  {len(files):5}  {seen.calls:5}"
        )
        if wanted and wanted in name:
            print("\n".join(f"    {file}" for file in seen.way))
            print("\n".join(f"  {one[0]}: {one[1]}" for one in sorted(seen.functions)))


if __name__ == "__main__":
    main()
