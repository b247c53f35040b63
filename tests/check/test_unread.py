"""One of many that cannot be read is listed with its reason; the others are judged."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

import kinlab as kl
from kinlab.cli import app

GOOD = (
    '@kl.hand_formula("gravity_torques", robot="single_link")\ndef {name}(q):\n    return {value}\n'
)
RIGHT = "np.array([2.5 * 9.81 * 0.3 * np.cos(q[0])])"
HEAD = "import numpy as np\nimport kinlab as kl\n\n"


def run(*arguments):
    return CliRunner().invoke(app, ["check", *map(str, arguments), "--samples", "12"])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    kl.load("planar2r").table.save(tmp_path / "a.toml")
    (tmp_path / "b.toml").write_text('name = "b"\nlinks = [{ a = }]\n')
    kl.load("single_link").table.save(tmp_path / "c.toml")
    functions = [("first", RIGHT), ("second", "q[7]"), ("third", RIGHT)]
    (tmp_path / "d.py").write_text(
        HEAD + "\n".join(GOOD.format(name=n, value=v) for n, v in functions)
    )
    return tmp_path


def test_every_file_that_can_be_read_is_judged(folder):
    result = run("a.toml", "b.toml", "c.toml", "d.py", "nowhere.toml", "--report", "all.html",
                 "--report", "all.md", "--json")  # fmt: skip
    assert result.exit_code == 2, result.output
    found = json.loads(result.stdout)
    assert not found["ok"]
    assert {row["robot"] for row in found["rows"]} == {"planar2r", "single_link"}
    assert [r["id"] for r in found["rows"] if not r["part"]] == ["first", "third"]
    assert all(row["ok"] for row in found["rows"])
    missed = {one["what"]: one["reason"] for one in found["unread"]}
    assert list(missed) == ["b.toml", "d.py: second", "nowhere.toml"]
    assert "line 2" in missed["b.toml"] and "no such file" in missed["nowhere.toml"]
    assert "IndexError" in missed["d.py: second"]
    for report in ("all.html", "all.md"):
        text = (folder / report).read_text(encoding="utf-8")
        assert "Not judged" in text and "NOT JUDGED" in text
        for part in ("d.py: second", "no such file", "IndexError", "first", "third"):
            assert part.lower() in text.lower(), (report, part)


def test_the_terminal_lists_them_too(folder):
    result = run("a.toml", "b.toml", "d.py")
    assert result.exit_code == 2
    told = [line for line in result.stderr.splitlines() if line]
    assert told[0].startswith("kinlab: not judged: b.toml: ")
    assert told[1].startswith("kinlab: not judged: d.py: second: ") and len(told) == 2
    assert "first" in result.stdout and "table:fk" in result.stdout


def test_a_bad_function_names_its_quantity_and_leaves_the_others(folder):
    text = (folder / "d.py").read_text().replace("gravity_torques", "gravity", 1)
    (folder / "d.py").write_text(text)
    found = json.loads(run("d.py", "--json").stdout)
    assert [one["what"] for one in found["unread"]] == ["d.py: first", "d.py: second"]
    assert "gravity_torques" in found["unread"][0]["reason"]
    assert [row["id"] for row in found["rows"]] == ["third"]


ENTRIES = """robot = "single_link"
[formulas]
"gravity_torques[0]" = "m1*g*c1*0.3"
V = "sin("
tau9 = "q1"
g2 = "nothing*q1"
"""


def test_bad_entries_of_a_formula_file_leave_the_others(folder):
    (folder / "f.toml").write_text(ENTRIES)
    result = run("f.toml", "--json")
    assert result.exit_code == 2
    found = json.loads(result.stdout)
    assert [one["function"] for one in found["formulas"]] == ["gravity_torques[0]"]
    missed = {one["what"]: one["reason"] for one in found["unread"]}
    assert list(missed) == ["f.toml: V", "f.toml: tau9", "f.toml: g2"]
    assert "no arithmetic" in missed["f.toml: V"]
    assert "does not exist" in missed["f.toml: tau9"]


def test_a_formula_file_without_its_robot_is_one_thing_that_cannot_be_read(folder):
    (folder / "f.toml").write_text(ENTRIES.replace("single_link", "singl_link"))
    found = json.loads(run("f.toml", "a.toml", "--json").stdout)
    assert [one["what"] for one in found["unread"]] == ["f.toml"]
    assert "'single_link'" in found["unread"][0]["reason"]


def test_one_argument_alone_that_cannot_be_read_is_an_error_as_ever(folder):
    result = run("b.toml")
    assert isinstance(result.exception, kl.KinlabError)
    assert not result.stdout
