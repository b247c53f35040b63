"""Every named tolerance stands in kinlab/tolerances.py, says why, and is asked for somewhere."""

from __future__ import annotations

import ast
import dataclasses
import re
from collections.abc import Iterator
from pathlib import Path

import kinlab as kl

PACKAGE = Path(kl.__file__).parent
SMALL = 1e-2
"""A named number below this says how near is near enough."""


def named_numbers(tree: ast.Module) -> Iterator[tuple[str, float]]:
    """Names at the top of a file that are bound to a plain float, alone or in a tuple of names."""
    for node in tree.body:
        if isinstance(node, ast.AnnAssign) and node.value is not None:
            pairs = [(node.target, node.value)]
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Tuple):
            if not isinstance(node.value, ast.Tuple):
                continue
            pairs = list(zip(node.targets[0].elts, node.value.elts, strict=True))
        elif isinstance(node, ast.Assign):
            pairs = [(node.targets[0], node.value)]
        else:
            continue
        for name, value in pairs:
            if isinstance(value, ast.UnaryOp):
                value = value.operand
            if isinstance(value, ast.Constant) and isinstance(value.value, float):
                yield ast.unparse(name), value.value


def has_kernels(tree: ast.Module) -> bool:
    """Whether a function of the file is compiled: its cache knows this file only."""
    return any(
        isinstance(node, ast.FunctionDef)
        and any(ast.unparse(d).split("(")[0] in ("kernel", "compiled") for d in node.decorator_list)
        for node in ast.walk(tree)
    )


def strays(tree: ast.Module) -> list[str]:
    if has_kernels(tree):
        return []
    return [f"{name} = {value:g}" for name, value in named_numbers(tree) if 0 < value < SMALL]


def test_named_tolerances_stand_in_one_file():
    found = {
        file.relative_to(PACKAGE).as_posix(): names
        for file in PACKAGE.rglob("*.py")
        if file != PACKAGE / "tolerances.py"
        and (names := strays(ast.parse(file.read_text(encoding="utf-8"))))
    }
    assert not found, "these belong in kinlab/tolerances.py (CONTRIBUTING.md says which)"


def test_each_tolerance_has_a_reason_and_a_use():
    fields = [field.name for field in dataclasses.fields(kl.tolerances.Tolerances)]
    (record,) = (
        node
        for node in ast.parse((PACKAGE / "tolerances.py").read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef)
    )
    reasons = {
        name.target.id
        for name, reason in zip(record.body, record.body[1:], strict=False)
        if isinstance(name, ast.AnnAssign) and isinstance(reason, ast.Expr)
    }
    assert reasons == set(fields)
    code = "\n".join(
        file.read_text(encoding="utf-8")
        for file in PACKAGE.rglob("*.py")
        if file != PACKAGE / "tolerances.py"
    )
    used = set(re.findall(r"\bTOLERANCES\.(\w+)", code))
    assert set(fields) - used == set()
    assert used - set(fields) == set()


def test_the_rule_sees_what_it_should():
    text = "NEAR = 1e-9\nA, B = 3, 1e-5\nHALF: float = 0.5\nSHARE = 0.01\nMANY = 7\nBACK = -1e-4\n"
    assert strays(ast.parse(text)) == ["NEAR = 1e-09", "B = 1e-05", "BACK = 0.0001"]
    assert strays(ast.parse(text + "@kernel\ndef f(x):\n    return x\n")) == []
