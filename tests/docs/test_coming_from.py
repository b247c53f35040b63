"""The page for those who come from other toolboxes: every line of its tables is run.

The right column always; the Toolbox for Python where it is installed, and then both agree to the
digits the row names.
"""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs/tutorials/f_coming_from.md"
TEXT = PAGE.read_text(encoding="utf-8")
CELLS = re.findall(r"```\{code-cell\} ipython3\n(.*?)```", TEXT, re.DOTALL)
OTHERS = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)


def rows(head: str) -> list[list[str]]:
    """The rows of all tables whose heading begins so, code without its marks."""
    out = []
    for table in re.findall(r"(?:^\|.*\|\n)+", TEXT, re.MULTILINE):
        first, _, *lines = table.splitlines()
        if first.startswith(f"| {head} "):
            out += [[cell.strip().strip("`") for cell in x.split("|")[1:-1]] for x in lines]
    return out


PAIRS = rows("Robotics Toolbox for Python")
MATLAB = rows("Robotics System Toolbox")


@pytest.fixture(scope="module")
def names() -> dict[str, Any]:
    """What the page's cells define; the last, a picture, is left to the build."""
    space: dict[str, Any] = {}
    for cell in CELLS[:-1]:
        exec(compile(cell, str(PAGE), "exec"), space)  # noqa: S102
    return space


@pytest.fixture(scope="module")
def others(names: dict[str, Any]) -> dict[str, Any]:
    """The page's blocks of the Toolbox, beside the same states."""
    if importlib.util.find_spec("roboticstoolbox") is None:
        pytest.skip("roboticstoolbox-python is not installed (extra: bench)")
    space = {**names}
    for block in OTHERS:
        exec(compile(block, str(PAGE), "exec"), space)  # noqa: S102
    return space


def test_the_tables_are_read():
    assert len(PAIRS) >= 28 and len(MATLAB) >= 16
    assert all(len(row) == 3 for row in PAIRS + MATLAB)
    assert {code for _, code, _ in PAIRS} >= {"kl.fk(robot, q)", "kl.mass_matrix(robot, q)"}


@pytest.mark.parametrize("code", [row[1] for row in PAIRS] + [row[2] for row in MATLAB])
def test_a_line_of_kinlab_runs(names, code):
    if code == "print(robot)":
        assert "3 joints" in str(names["robot"])
        return
    answer = eval(code, dict(names))  # noqa: S307
    found = getattr(answer, "q", answer) if not hasattr(answer, "model") else answer.lower
    assert np.isfinite(np.asarray(found, float)).all()


@pytest.mark.parametrize(("theirs", "ours", "digits"), PAIRS)
def test_a_line_of_the_toolbox_gives_the_same(others, theirs, ours, digits):
    one = np.asarray(eval(theirs, dict(others)), float)  # noqa: S307
    two = np.asarray(eval(ours, dict(others)), float)  # noqa: S307
    assert one.shape == two.shape
    assert np.abs(one - two).max() <= float(digits)
