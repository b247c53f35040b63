"""Every page with code runs as it is printed: no error, nothing on stderr, nothing left behind."""

from __future__ import annotations

import os
import re
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
    assert all(len(pages.cells(page)) >= 2 for page in ENGLISH)


def code_only(code: str) -> str:
    """Code without its comments and the words in its strings."""
    code = re.sub(r"#.*", "", code)
    return re.sub(r"\s+", "", re.sub(r"([\"'])(?:(?!\1).)*\1", "''", code))


@pytest.mark.parametrize("page", pages.tutorials("zh"), ids=lambda page: page.stem)
def test_chinese_page_has_the_code_of_the_english_one(page):
    english = pages.DOCS / page.relative_to(pages.DOCS / "zh")
    mine, theirs = ([code_only(code) for code in pages.cells(one)] for one in (page, english))
    assert mine == theirs
