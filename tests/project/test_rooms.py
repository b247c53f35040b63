"""The house: few things at the top, no crowded room, and each room's table lists its files."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "kinlab"
ROOMS = sorted(file.parent for file in PACKAGE.rglob("__init__.py") if file.parent != PACKAGE)
MARKERS = {"__init__.py", "__init__.pyi", "__main__.py", "py.typed", "__pycache__", "robots"}
"""What Python (and a wheel) asks for at the top, beside the house itself."""

MOST = 13
TABLE = re.compile(r"^=+  =+$\n^\w+ +.*$\n^=+  =+$\n(.*?)^=+  =+$", re.DOTALL | re.MULTILINE)


def names_in(docstring: str) -> dict[str, str]:
    """File names in the table of a room's docstring, each with what stands beside it."""
    rows: dict[str, str] = {}
    (body,) = TABLE.findall(docstring)
    for line in body.splitlines():
        if match := re.match(r"``([\w/]+)``\s+(.*)", line):
            rows[(last := match.group(1))] = match.group(2)
        else:
            rows[last] += " " + line.strip()
    return rows


def docstring(file: Path) -> str:
    return ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: room.relative_to(PACKAGE).as_posix())
def test_the_table_of_a_room_is_its_files(room):
    files = {file.stem: file for file in room.glob("*.py") if file.stem != "__init__"}
    rooms = {f"{file.parent.name}/" for file in room.glob("*/__init__.py")}
    rows = names_in(docstring(room / "__init__.py"))
    assert set(rows) == {*files, *rooms}
    for name, file in files.items():
        assert rows[name], name
        assert docstring(file), f"{file}: no docstring"
    assert len(files) <= MOST


def test_few_things_stand_at_the_top():
    top = {entry.name for entry in PACKAGE.iterdir()} - MARKERS
    assert len(top) <= 20, sorted(top)
    assert {"model", "engine", "notes", "check", "doctor", "errors.py"} <= top


def test_names_in_reads_a_table():
    text = "Head.\n\n====  ====\nfile  what\n====  ====\n``a``   one\n        two\n``b/``  x\n====  ====\n"
    assert names_in(text) == {"a": "one two", "b/": "x"}
