"""The code in CONTRIBUTING.md runs as printed, one worked example a section."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

TEXT = (Path(__file__).resolve().parents[2] / "CONTRIBUTING.md").read_text(encoding="utf-8")
SECTIONS = dict(re.findall(r"^## (.+?)$(.*?)(?=^## |\Z)", TEXT, re.DOTALL | re.MULTILINE))


def test_every_kind_of_addition_has_its_section():
    assert list(SECTIONS) == [
        "A note's formula",
        "A quantity",
        "A robot",
        "A confusion of the doctor",
        "A closed form of the inverse kinematics",
        "A sentence",
    ]


@pytest.mark.parametrize("title", SECTIONS)
def test_the_worked_example_runs(title, tmp_path, monkeypatch):
    (block,) = re.findall(r"```python\n(.*?)```", SECTIONS[title], re.DOTALL)
    assert "assert " in block
    monkeypatch.chdir(tmp_path)
    exec(compile(block, f"CONTRIBUTING.md, {title}", "exec"), {})  # noqa: S102


@pytest.mark.parametrize("path", re.findall(r"`((?:kinlab|robots|tests)/[\w./]*)`", TEXT))
def test_the_places_it_names_exist(path):
    assert (Path(__file__).resolve().parents[2] / path).exists(), path
