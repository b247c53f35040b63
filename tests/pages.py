"""The pages of the site as text: their cells of code, their titles, their links.

Run as a program it executes the cells of one page, in order, as a notebook would.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1] / "docs"
_CELL = re.compile(r"^(`{3,}|:{3,})\{code-cell\}[^\n]*\n(.*?)^\1\s*$", re.DOTALL | re.MULTILINE)
_OPTIONS = re.compile(r"\A(?:---\n.*?^---\n|(?::[\w-]+:[^\n]*\n)+)", re.DOTALL | re.MULTILINE)


def cells(page: Path) -> list[str]:
    """The code of a page's cells, without their options."""
    text = page.read_text(encoding="utf-8")
    return [_OPTIONS.sub("", body) for _, body in _CELL.findall(text)]


def tutorials(folder: str = "") -> list[Path]:
    """The pages with cells: English, or those below a folder such as ``zh``."""
    found = sorted((DOCS / folder).glob("*.md")) + sorted((DOCS / folder).glob("[th]*/*.md"))
    return [page for page in found if cells(page)]


def run(page: Path) -> None:
    """Executes a page's cells one after the other; what a cell ends in shows itself."""
    from IPython.core.interactiveshell import InteractiveShell

    shell = InteractiveShell.instance()
    shell.kernel = object()  # what tells kinlab that pages are shown inline, not served
    for code in cells(page):
        shell.run_cell(code).raise_error()


if __name__ == "__main__":
    run(Path(sys.argv[1]))
