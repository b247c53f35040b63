"""What a file says is shown on the terminal, never obeyed."""

from __future__ import annotations

import pytest
from console import kinlab

from kinlab.cli.screen import visible

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
