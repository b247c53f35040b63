"""The text of pieces of programs is Python's own."""

from __future__ import annotations

import ast
from pathlib import Path

from kinlab.doctor.bytecode.syntax import text_of

SOURCES = sorted((Path(__file__).resolve().parents[2] / "kinlab" / "notes").rglob("*.py"))


def test_text_is_what_python_writes():
    told = 0
    for source in SOURCES:
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
            if isinstance(node, ast.expr):
                assert text_of(node) == ast.unparse(node)
                told += 1
    assert told > 10_000


def test_text_keeps_brackets_and_signs():
    for text in (
        "a - (b - c)", "(a + b)*c", "-(a + b)", "(-a)**2", "-a**2", "a**-b", "(a**b)**c", "a[i, :2]", "a[i:]",
        "f(a, b)(c)", "(a, b)", "a if b else c", "1.5e-07*x", "2j*x", "x.T @ (y @ z)", "a/(b*c)", "a*(b/c)", "(1).real",
    ):  # fmt: skip
        tree = ast.parse(text, mode="eval").body
        assert text_of(tree) == ast.unparse(tree)
