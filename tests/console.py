"""The command line and the scripts run in this process: a new one costs seconds for its imports.

That ``kinlab`` also starts as a process of its own is tested once, in cli/test_cli.py; that a
script does, in analysis/test_analysis_workspace.py.
"""

from __future__ import annotations

import contextlib
import io
import os
import runpy
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
    return _said(main, ["kinlab", *map(str, arguments)], cwd, columns)


def script(path, *arguments, cwd=None):
    """Runs ``python PATH ARGUMENTS`` in a folder."""
    return _said(
        lambda: runpy.run_path(str(path), run_name="__main__"),
        [str(path), *map(str, arguments)],
        cwd,
        80,
    )


def _said(run, words, cwd, columns):
    environment = {"COLUMNS": str(columns), "NO_COLOR": "1"}
    out, err, code = io.StringIO(), io.StringIO(), 0
    before = Path.cwd()
    os.chdir(cwd or before)
    try:
        with (
            mock.patch.dict(os.environ, environment),
            mock.patch.object(sys, "argv", words),
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
        ):
            try:
                run()
            except SystemExit as left:
                code = left.code or 0
    finally:
        os.chdir(before)
    return Said(code, out.getvalue(), err.getvalue())
