"""The how-to pages do as printed: files are written, commands and Python run, in the page's order.

- A block of ``toml``, ``tex`` or ``text`` whose first line is a comment with a file's name is
  written there; a block of ``python`` that begins so is written too, and run.
- A block of ``python`` is run; the blocks of a page share their names, as a reader's session would.
- Each line of ``sh`` that begins with ``kinlab`` is run in this process; it ends with exit code 0, or
  with the one that a comment behind it says.
- A block of ``text`` without a file's name is what the command before it printed.
"""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from console import kinlab

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "howto"
PAGES = sorted(FOLDER.glob("*.md"))
BLOCK = re.compile(r"^```(python|sh|toml|tex|text)\n(.*?)^```", re.DOTALL | re.MULTILINE)
NAME = re.compile(r"[#%] (\S+\.(?:toml|csv|tex|txt|py))\n")


def written(text: str) -> bool:
    """Writes a block that names its file."""
    named = NAME.match(text)
    if named is None:
        return False
    file = Path(named.group(1))
    file.parent.mkdir(parents=True, exist_ok=True)
    keep = file.suffix in (".csv", ".txt")  # no comments in these
    file.write_text(text[named.end() :] if keep else text, encoding="utf-8")
    return True


def command(line: str) -> str:
    """Runs one line of a shell; returns what it printed."""
    line, _, remark = line.partition("  #") if "  #" in line else line.partition(" # ")
    words = shlex.split(line)
    assert words[0] == "kinlab", line
    expected = re.search(r"exit code (\d)", remark)
    said = kinlab(*words[1:])
    assert said.returncode == int(expected.group(1) if expected else 0), said.stdout + said.stderr
    assert "Traceback" not in said.stderr
    return said.stdout


@pytest.mark.parametrize("page", PAGES, ids=[page.stem for page in PAGES])
def test_a_page_does_as_printed(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    printed = ""
    for kind, text in BLOCK.findall(page.read_text(encoding="utf-8")):
        named = written(text)
        if kind == "python":
            exec(compile(text, page.name, "exec"), names)  # noqa: S102
        elif kind == "sh":
            printed = "".join(command(line) for line in text.splitlines() if line.strip())
        elif kind == "text" and not named:
            assert " ".join(text.split()) in " ".join(printed.split())


def test_every_page_is_found_and_listed():
    listed = re.findall(r"\]\((\w+)\.md\)", (FOLDER / "index.md").read_text(encoding="utf-8"))
    assert sorted(listed) == sorted(page.stem for page in PAGES if page.stem != "index")
    assert len(PAGES) >= 13


def test_no_block_is_of_a_kind_that_is_not_run():
    kinds = {
        kind
        for page in PAGES
        for kind in re.findall(r"^ *```(\w+)$", page.read_text(encoding="utf-8"), re.M)
    }
    assert kinds <= {"python", "sh", "toml", "tex", "text", "html"}
