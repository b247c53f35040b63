"""The code in the READMEs runs as printed, and what they say of it is so."""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

import pytest
from console import kinlab

ROOT = Path(__file__).resolve().parents[2]
README, CHINESE = (
    (ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "README.zh.md")
)


def blocks(text: str, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


BLOCKS = blocks(README, "python")


@pytest.mark.parametrize("block", BLOCKS, ids=range(len(BLOCKS)))
def test_python_block(block, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    exec(compile(block, "README.md", "exec"), {})  # noqa: S102
    printed = capsys.readouterr().out
    if promised := re.search(r"print\(.*\n# (.*)", block):
        digits = re.compile(r"[\d.]+e-\d+")  # rounding differs between processors
        assert digits.sub("", printed).strip() == digits.sub("", promised.group(1)).strip()


def test_there_are_blocks_and_the_two_commands():
    assert len(BLOCKS) >= 2
    commands = [line for line in README.splitlines() if line.startswith("python3 -m venv ")]
    assert "kinlab check" in commands[0]
    assert "pytest" in commands[1]
    assert len(README.splitlines()) <= 150


def test_the_formula_file_is_answered_as_the_readme_says(tmp_path):
    (text,) = blocks(README, "toml")
    assert tomllib.loads(text)
    (tmp_path / "my_formulas.toml").write_text(text, encoding="utf-8")
    done = kinlab("check", "my_formulas.toml", cwd=tmp_path)
    assert done.returncode == 1
    assert "cos(q2) should be cos(q1 + q2)" in done.stdout


def test_the_chinese_readme_holds_the_same_code():
    theirs = blocks(CHINESE, "python")
    assert [ast.dump(ast.parse(one)) for one in theirs] == [
        ast.dump(ast.parse(one)) for one in BLOCKS
    ]
    assert blocks(CHINESE, "toml") == blocks(README, "toml")
    shell = [
        [re.sub(r"\s*#.*", "", line).replace(" --lang zh", "") for line in one.splitlines()]
        for one in blocks(CHINESE, "sh")
    ]
    assert shell == [
        [re.sub(r"\s*#.*", "", line) for line in one.splitlines()] for one in blocks(README, "sh")
    ]


@pytest.mark.parametrize("text", [README, CHINESE], ids=["en", "zh"])
def test_its_links_lead_somewhere(text):
    targets = re.findall(r"\]\((?!https?:)([^)#]+)", text)
    assert len(targets) > 10
    assert [target for target in targets if not (ROOT / target).exists()] == []
