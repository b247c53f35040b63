"""One name, one thing: no two records of the package bear the same name."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2] / "kinlab"

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
