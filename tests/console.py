"""The command line run in this process: a new one costs a second and a half for its imports.

That ``kinlab`` also starts as a process of its own is tested once, in cli/test_cli.py.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

from kinlab.cli import main


@dataclass(frozen=True)
class Said:
    """What a command left: its exit code, and what it printed."""

    returncode: int
    stdout: str
    stderr: str


def kinlab(*arguments, cwd=None, columns=160):
    """Runs ``kinlab ARGUMENTS`` in a folder, in a terminal so many columns wide."""
    environment = {"COLUMNS": str(columns), "NO_COLOR": "1"}
    out, err, code = io.StringIO(), io.StringIO(), 0
    before = Path.cwd()
    os.chdir(cwd or before)
    try:
        with (
            mock.patch.dict(os.environ, environment),
            mock.patch.object(sys, "argv", ["kinlab", *map(str, arguments)]),
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
        ):
            try:
                main()
            except SystemExit as left:
                code = left.code or 0
    finally:
        os.chdir(before)
    return Said(code, out.getvalue(), err.getvalue())
