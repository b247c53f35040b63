"""Every page with code runs as it is printed: no error, nothing on stderr, nothing left behind."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pages
import pytest

# the tables of idioms run in test_coming_from, how-to pages in test_howto; Chinese pages hold the
# code of the English ones, which test_translated_pages looks at
ENGLISH = [
    page
    for page in pages.tutorials()
    if page.parent.name != "howto" and page.stem != "f_coming_from"
]


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
    named = {page.stem for page in ENGLISH}
    assert {"quickstart", "conventions", "not_here", "a_table_to_arm", "g_million"} <= named
    assert all(pages.cells(page) for page in ENGLISH)
