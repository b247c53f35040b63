"""What a file says is shown on the terminal, never obeyed."""

from __future__ import annotations

import io
from copy import deepcopy

import pytest
from console import kinlab
from rich.table import Table

from kinlab.cli.screen import screen, visible

TABLE = """
name = "[/bold]{x}"
convention = "standard"
source = "from \\u001b[31mred\\u009b2J [left] page"
[[links]]
joint = "revolute"
a = 1
alpha = 0
d = 0
theta = 0
name = "[left]"
"""


def test_codes_become_visible():
    assert visible("a\x1b[31mb\x07\x9b\u202e\ud800") == "a\\x1b[31mb\\x07\\x9b\\u202e\\ud800"
    assert visible("tau²\n\tq̈ = 1\u00a0m") == "tau²\n\tq̈ = 1\u00a0m"


@pytest.mark.parametrize("command", ["info", "dh"])
def test_names_and_sources_stand_as_they_are(tmp_path, command):
    file = tmp_path / "t.toml"
    file.write_text(TABLE, encoding="utf-8")
    done = kinlab(command, str(file), columns=80)
    assert done.returncode == 0, done.stderr[-500:]
    assert "\x1b" not in done.stdout
    assert "\x9b" not in done.stdout
    if command == "info":
        assert "[/bold]{x}: 1 joints" in done.stdout
        assert "[left] page" in done.stdout
        assert "\\x1b[31mred" in done.stdout


def test_an_error_is_one_short_line(tmp_path):
    file = tmp_path / "t.toml"
    file.write_text(TABLE.replace("a = 1", 'a = "\\u001b[31m' + "x" * 150 + '"'), encoding="utf-8")
    done = kinlab("info", str(file), columns=80)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert "\x1b" not in done.stderr


@pytest.mark.parametrize(
    "words",
    [
        ("list",), ("check", "--quantities"), ("fivebar", "list"),
        ("info", "erd:ur5"), ("info", "panda"), ("info", "stanford"),
    ],
    ids=" ".join,
)  # fmt: skip
def test_no_table_cuts_a_name_at_80_columns(words, monkeypatch):
    wide, narrow = (kinlab(*words, columns=columns) for columns in (400, 80))
    assert wide.returncode == narrow.returncode == 0
    assert "…" not in narrow.stdout
    assert max(len(line) for line in narrow.stdout.splitlines()) <= 80
    assert letters(narrow.stdout) == letters(wide.stdout)  # all of it, on more lines


def letters(text):
    return sorted(c for c in text if not c.isspace() and c not in "─")


def test_a_table_is_broken_between_words_then_in_names_then_anywhere():
    table = Table(box=None, pad_edge=False)
    for name in ("joint", "size", "about"):
        table.add_column(name, no_wrap=True, justify="right" if name == "size" else "left")
    table.add_row("shoulder_pan_joint", "1.234e-05", "turns the whole arm about the vertical")
    seen = {}
    for width in (70, 40, 32, 12):
        out = io.StringIO()
        table = deepcopy(table)
        screen(file=out, width=width).print(deepcopy(table))
        seen[width] = out.getvalue()
        assert "…" not in seen[width]
        assert letters(seen[width]) == letters(
            "joint size about shoulder_pan_joint 1.234e-05 turns the whole arm about the vertical"
        )
    assert "shoulder_pan_joint" in seen[40] and "1.234e-05" in seen[40]
    assert "shoulder_" in seen[32].split() and "1.234e-05" in seen[32]
