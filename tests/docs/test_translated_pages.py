"""The Chinese pages run the code of the English ones: only comments and texts differ."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGES = sorted(page.relative_to(DOCS / "zh") for page in (DOCS / "zh").rglob("*.md"))
CELL = re.compile(r"^```\{code-cell\}[^\n]*\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def cells(page: Path) -> list[str]:
    """The code of each cell, without its options."""
    found = CELL.findall(page.read_text(encoding="utf-8"))
    return [re.sub(r"^:[a-z-]+:.*\n", "", cell, flags=re.MULTILINE) for cell in found]


def shape(code: str) -> list[str]:
    """The statements of a cell without the texts in them and what only asks for Chinese."""
    kept = []
    for statement in ast.parse(code).body:
        if "KINLAB_LANG" in ast.unparse(statement) or ast.unparse(statement) == "import os":
            continue
        for node in ast.walk(statement):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                node.value = ""
        kept.append(ast.dump(statement))
    return kept


def executed() -> list[Path]:
    return [page for page in PAGES if cells(DOCS / "zh" / page)]


def test_what_is_promised_in_chinese_is_there():
    named = {page.as_posix() for page in executed()}
    assert {"quickstart.md"} | {
        f"tutorials/{name}.md"
        for name in ("a_table_to_arm", "b_doctor", "c_singular", "e_five_bar")
    } <= named


@pytest.mark.parametrize("page", executed(), ids=str)
def test_a_chinese_page_runs_the_same_code(page):
    ours, theirs = (cells(DOCS / folder / page) for folder in ("zh", "."))
    assert len(ours) == len(theirs)
    for mine, other in zip(ours, theirs, strict=True):
        assert shape(mine) == shape(other)


@pytest.mark.parametrize("page", executed(), ids=str)
def test_prose_and_comments_are_chinese(page):
    text = (DOCS / "zh" / page).read_text(encoding="utf-8")
    comments = re.findall(r"(?<=  # ).*", "\n".join(cells(DOCS / "zh" / page)))
    assert comments
    for comment in comments:  # or names and shapes only
        assert re.search(r"[一-鿿]", comment) or not re.search(r"\b[a-z]{4,}\b", comment), comment
    paragraphs = [p for p in CELL.sub("", text).split("\n\n") if re.match(r"[^\s|`:$#-]", p)]
    for paragraph in paragraphs:
        assert re.search(r"[一-鿿]", paragraph), paragraph[:60]
