"""Every page with code runs as it is printed: no error, nothing on stderr, nothing left behind."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pages
import pytest

ENGLISH = pages.tutorials()


@pytest.mark.parametrize("page", ENGLISH, ids=[page.stem for page in ENGLISH])
def test_page_runs(page, tmp_path):
    surroundings = {**os.environ, "MPLBACKEND": "agg", "IPYTHONDIR": str(tmp_path / "ipython")}
    folder = tmp_path / "work"
    folder.mkdir()
    ran = subprocess.run(
        [sys.executable, str(Path(pages.__file__)), str(page)],
        cwd=folder,
        env=surroundings,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert ran.returncode == 0, ran.stdout[-3000:] + ran.stderr[-3000:]
    assert ran.stderr == ""


def test_pages_have_cells():
    assert {page.stem for page in ENGLISH} >= {"conventions"}
    assert all(pages.cells(page) for page in ENGLISH)
