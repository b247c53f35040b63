"""One name, one thing: no two records of the package, and no two pieces of a file, bear one."""

from __future__ import annotations

import ast
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "kinlab"

TWICE = {
    "Cause": {"check/diagnosis.py", "doctor/tables/words.py"},
    "Marks": {"doctor/marking/marks.py", "formulas/typeset.py"},
    "Motion": {"motion/record.py", "notes/note000_dynamics.py"},
}
"""Names that two files give to things of their own; none may come, and each may go."""


def test_no_two_records_bear_one_name():
    found: dict[str, set[str]] = defaultdict(set)
    for file in PACKAGE.rglob("*.py"):
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                found[node.name].add(file.relative_to(PACKAGE).as_posix())
    assert len(found) > 200
    assert {name: files for name, files in found.items() if len(files) > 1} == TWICE


def _set_at_the_top(file: Path) -> Iterator[str]:
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            pieces = [x for one in targets for x in getattr(one, "elts", [one])]
            yield from (one.id for one in pieces if isinstance(one, ast.Name))


def test_no_name_of_a_file_is_set_twice():
    """What a constant is tuned for is not silently another constant's value."""
    twice = {
        f"{file.relative_to(ROOT)}: {name}"
        for folder in ("kinlab", "tests", "scripts")
        for file in (ROOT / folder).rglob("*.py")
        for name, count in Counter(_set_at_the_top(file)).items()
        if count > 1
    }
    assert twice == set()
