"""The code in README.md runs as printed."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

README = (Path(__file__).resolve().parents[2] / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```python\n(.*?)```", README, re.DOTALL)


@pytest.mark.parametrize("block", BLOCKS, ids=range(len(BLOCKS)))
def test_python_block(block, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    exec(compile(block, "README.md", "exec"), {})  # noqa: S102


def test_there_are_blocks_and_the_two_commands():
    assert len(BLOCKS) >= 2
    commands = [line for line in README.splitlines() if line.startswith("python3 -m venv ")]
    assert "kinlab check" in commands[0]
    assert "pytest" in commands[1]
