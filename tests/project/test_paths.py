"""Every module path that a reader meets, in the papers and in the code, leads somewhere."""

from __future__ import annotations

import ast
import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAPERS = [
    *("README.md", "README.zh.md", "CONTRIBUTING.md", "CHANGELOG.md"),
    *sorted(
        page.relative_to(ROOT).as_posix()
        for page in (ROOT / "docs").rglob("*.md")
        if not {"_build", "generated"} & set(page.relative_to(ROOT).parts)
    ),
]
DOTTED = re.compile(r"(?<![\w./])kinlab(?:\.[A-Za-z_]\w*)+")
SLASHED = re.compile(r"(?<![\w./])(?:kinlab|tests|scripts|robots)(?:/[\w.-]+)+")


def resolves(name: str) -> bool:
    """Whether a dotted name is a module, or is reached from one by attributes."""
    parts = name.split(".")
    for cut in range(len(parts), 0, -1):
        try:
            found = importlib.import_module(".".join(parts[:cut]))
        except ModuleNotFoundError:
            continue
        for attribute in parts[cut:]:
            if not hasattr(found, attribute):
                return False
            found = getattr(found, attribute)
        return True
    return False


def in_docstrings() -> dict[str, str]:
    """Dotted names in the docstrings of the package, each with one file that has it."""
    names: dict[str, str] = {}
    kinds = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
    for file in sorted((ROOT / "kinlab").rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, kinds):
                for name in DOTTED.findall(ast.get_docstring(node) or ""):
                    names[name] = file.relative_to(ROOT).as_posix()
    return names


def test_the_judge_knows_a_path_that_leads_nowhere():
    assert resolves("kinlab.engine.kinematics.fk")
    assert resolves("kinlab.fk")
    assert not resolves("kinlab.engine.kinematics.no_such_name")
    assert not resolves("kinlab.no_such_room.fk")


@pytest.mark.parametrize("paper", PAPERS)
def test_paths_in_the_papers_lead_somewhere(paper):
    text = (ROOT / paper).read_text(encoding="utf-8")
    assert [name for name in sorted(set(DOTTED.findall(text))) if not resolves(name)] == []
    files = {name.rstrip(".") for name in SLASHED.findall(text)}
    nearby = (
        ROOT / paper
    ).parent  # a table of contents names pages beside it, without their ending
    lost = [n for n in files if not (ROOT / n).exists() and not (nearby / f"{n}.md").exists()]
    assert sorted(lost) == []


def test_paths_in_docstrings_lead_somewhere():
    names = in_docstrings()
    assert len(names) > 50
    assert {name: file for name, file in names.items() if not resolves(name)} == {}


def test_the_architecture_names_every_room():
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1] for line in text.splitlines() if line.startswith("| `")]
    named = {name.rstrip("/") for row in rows for name in re.findall(r"`([\w/]+)`", row)}
    rooms = {f.parent.name for f in (ROOT / "kinlab").glob("*/__init__.py")}
    files = {f.stem for f in (ROOT / "kinlab").glob("*.py") if not f.stem.startswith("__")}
    assert named == rooms | files
