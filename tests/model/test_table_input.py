"""Bad DH tables: the message names the place and the remedy."""

from __future__ import annotations

import math

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import ExpressionError, FileError, StateError, TableError
from kinlab.formulas.numbers import parse_angle, parse_number

GOOD = """
name = "arm"
convention = "standard"
[[links]]
joint = "revolute"
a = 0.3
alpha = "pi/2"
d = 0
theta = "-90 deg"
mass = 1.0
inertia = {{ ixx = 0.1, iyy = 0.1, izz = 0.1 }}
{more}
"""


def load(tmp_path, text):
    file = tmp_path / "arm.toml"
    file.write_text(text, encoding="utf-8")
    return kl.DHTable.load(file)


def test_angles_as_text(tmp_path):
    link = load(tmp_path, GOOD.format(more="")).links[0]
    assert link.alpha == math.pi / 2
    assert link.theta == pytest.approx(-math.pi / 2, abs=1e-16)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('convention = "standard"', "", r"table 'arm': convention is missing; choose \"standard\""),
        ('"standard"', '"classic"', r"table 'arm': convention 'classic' is unknown; choose"),
        ("a = 0.3", "", r"table 'arm', link 1: column 'a' is missing"),
        ("a = 0.3", "A = 0.3", r"table 'arm', link 1: column 'A' is unknown; did you mean 'a'|choose"),
        ("mass = 1.0", "weight = 1.0", r"link 1: column 'weight' is unknown"),
        ('"revolute"', '"helical"', r"link 1: joint type 'helical'; choose \"revolute\" or"),
        ("a = 0.3", "a = nan", r"link 1: a: nan is not finite"),
        ("a = 0.3", "a = inf", r"link 1: a: inf is not finite"),
        ("a = 0.3", 'a = "0.3 m"', r"link 1: a: cannot read '0.3 m'"),
        ("a = 0.3", "a = true", r"link 1: a: True is not a number"),
        ('"pi/2"', '"__import__(\'os\')"', r"link 1: alpha: cannot read"),
        ('"pi/2"', '"9**9**9"', r"link 1: alpha: cannot read"),
        ("mass = 1.0", "mass = -1.0", r"table 'arm', link 1: mass is -1; it must be >= 0"),
        ("mass = 1.0", "lower = 1\nupper = -1", r"link 1: lower 1 is above upper -1"),
        ("izz = 0.1", "izz = 0.3", r"link 1: inertia breaks the triangle inequality"),
        ("izz = 0.1", "izz = -0.3", r"link 1: inertia is not positive"),
        ("izz = 0.1", "ixy = [1]", r"link 1: inertia: \[1\] is not a number"),
        ("{ ixx = 0.1, iyy = 0.1, izz = 0.1 }", "[[1,0.2,0],[0,1,0],[0,0,1]]", "not symmetric"),
        ("{ ixx = 0.1, iyy = 0.1, izz = 0.1 }", "[[1,0],[0,1]]", r"shape \(2, 2\); expected \(3, 3\)"),
        ("{ ixx = 0.1, iyy = 0.1, izz = 0.1 }", "[[1,0],[0]]", "rows of unequal length"),
        ("mass = 1.0", "com = [1, 2]", r"link 1: com: shape \(2,\); expected \(3,\)"),
        ("mass = 1.0", "flip = 1", r"link 1: flip is 1; it must be true or false"),
        ("[[links]]", "base = [[1,0,0,0],[0,1,0,0],[0,0,1.1,0],[0,0,0,1]]\n[[links]]",
         r"table 'arm': base: the rotation is not orthonormal, R\^T R misses 1 by 0.21"),
        ("[[links]]", "tool = [[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]\n[[links]]", "mirror"),
        ("[[links]]", "tool = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]\n[[links]]", "last row"),
        ("[[links]]", "tool = { xyz = [1, 2] }\n[[links]]", r"tool.xyz: 2 numbers; expected 3"),
        ("[[links]]", "gravity = [0, 0]\n[[links]]", r"gravity: shape \(2,\); expected \(3,\)"),
        ("[[links]]", "grvity = [0, 0, 1]\n[[links]]", r"'grvity' is unknown; did you mean 'gravity'"),
        ('name = "arm"', "", r"arm.toml: name is missing"),
        ('name = "arm"', 'name = "arm', r"arm.toml: not TOML"),
    ],
)  # fmt: skip
def test_bad_toml(tmp_path, old, new, message):
    text = GOOD.format(more="")
    assert old in text
    with pytest.raises(TableError, match=message):
        load(tmp_path, text.replace(old, new, 1))


def test_table_without_links(tmp_path):
    with pytest.raises(TableError, match="table 'arm': it has no links"):
        load(tmp_path, 'name = "arm"\nconvention = "modified"\n')


def test_names_used_twice():
    with pytest.raises(TableError, match="link 2: the name 'elbow' is used twice"):
        kl.DHTable("arm", "standard", [kl.DHLink(name="elbow"), kl.DHLink(name="elbow")])


@pytest.mark.parametrize(
    ("names", "message"),
    [
        ({"name": "  "}, "table: name is '  '; it must be printable text"),
        ({"name": "a\x00"}, "it must be printable text"),
        ({"name": 5}, "table: name is 5"),
        ({"name": "arm", "tool_name": "link_2"}, "tool_name 'link_2' is the name of a link"),
        ({"name": "arm", "tool_name": ""}, "table 'arm': tool_name is ''"),
    ],
)
def test_bad_names(names, message):
    with pytest.raises(TableError, match=message):
        kl.DHTable(convention="standard", links=[kl.DHLink()], **names)
    with pytest.raises(TableError, match="name is 7"):
        kl.DHLink(name=7)


def test_any_source_makes_a_sound_urdf():
    table = kl.DHTable("arm", "standard", [kl.DHLink(a=1.0)], source="a--b <&> -->\n\x01 ü -")
    assert kl.Robot.from_dh(table).n == 1


CSV = """joint, a, alpha, d, theta, mass, com_x, ixx, iyy, izz, convention
revolute, 0.3, pi/2, 0, 0, 1.5, 0.1, 0.1, 0.1, 0.1, modified
prismatic, 0.2, -90 deg, 0.1, 0, 2, 0, 0.1, 0.1, 0.1, modified
"""


def csv(tmp_path, text):
    file = tmp_path / "arm.csv"
    file.write_text(text, encoding="utf-8")
    return file


def test_csv(tmp_path):
    table = kl.DHTable.load(csv(tmp_path, CSV))
    assert table.convention == "modified"
    assert table.links[1] == kl.DHLink(
        "prismatic", 0.2, parse_angle("-90 deg"), 0.1, 0.0, mass=2.0, inertia=0.1 * np.eye(3)
    )
    assert tuple(table.links[0].com) == (0.1, 0.0, 0.0)


def test_csv_with_the_convention_given_by_the_caller(tmp_path):
    text = "\n".join(line.rsplit(",", 1)[0] for line in CSV.splitlines())
    assert kl.DHTable.load(csv(tmp_path, text), "standard").convention == "standard"
    with pytest.raises(TableError, match="table 'arm': convention is missing"):
        kl.DHTable.load(csv(tmp_path, text))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("0.1, 0.1, 0.1, modified\np", "0.1, 0.1, 0.1,\np",
         r"table 'arm', link 1: convention is missing; choose \"standard\" or \"modified\""),
        ("0.1, modified\n", "0.1, standard\n", r"link 2: convention 'modified' differs"),
        ("a, alpha", "a, twist", r"table 'arm': column 'twist' is unknown"),
        ("joint, a,", "joint, alpha,", r"column 'alpha' stands twice"),
        ("prismatic, 0.2,", "prismatic, ,", r"link 2: column 'a' is empty"),
        ("0.3,", "0.3, 7,", r"link 1: the row does not have 11 cells"),
        ("0.3", "abc", r"link 1: a: cannot read 'abc'"),
    ],
)  # fmt: skip
def test_bad_csv(tmp_path, old, new, message):
    assert old in CSV
    with pytest.raises(TableError, match=message):
        kl.DHTable.load(csv(tmp_path, CSV.replace(old, new, 1)))


def test_other_files(tmp_path):
    with pytest.raises(FileError, match="no such file"):
        kl.DHTable.load(tmp_path / "none.toml")
    with pytest.raises(FileError, match="a DH table is a .toml or .csv file"):
        kl.DHTable.load(tmp_path / "arm.yaml")
    (tmp_path / "bin.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(FileError, match="not UTF-8"):
        kl.DHTable.load(tmp_path / "bin.toml")


def test_unwritable_output_leaves_the_old_file_whole(tmp_path, monkeypatch):
    table = kl.DHTable("arm", "standard", [kl.DHLink(a=0.3)])
    file = tmp_path / "arm.toml"
    file.write_text("old", encoding="utf-8")

    def no_space(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", no_space)
    with pytest.raises(FileError, match=r"arm.toml: cannot be written \(No space left"):
        table.save(file)
    assert file.read_text(encoding="utf-8") == "old"
    assert [f.name for f in tmp_path.iterdir()] == ["arm.toml"]
    monkeypatch.undo()
    with pytest.raises(FileError, match="cannot be written"):
        table.save(tmp_path / "no" / "such" / "folder.toml")
    with pytest.raises(FileError, match="is a folder"):
        table.save(tmp_path)


@pytest.mark.parametrize(
    ("text", "value"),
    [("pi/2", math.pi / 2), ("-pi", -math.pi), ("2*pi/3 + 1", 2 * math.pi / 3 + 1), ("1e-3", 1e-3),
     ("90 deg", math.pi / 2), ("45°", math.pi / 4), ("sqrt(2)/2", math.sqrt(2) / 2), (" 3 ", 3.0),
     ("1.5 rad", 1.5), ("(1+2)*3", 9.0)],
)  # fmt: skip
def test_expressions(text, value):
    assert parse_angle(text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    "text",
    ["", "pi/0", "a", "x()", "[1]", "1 if 1 else 2", "1;2", "lambda: 1", "1**2", "sqrt(-1)", "(" * 99,
     "1" * 300, "nan", "1e999", "pi.real", "sqrt(1, 2)", "'1'", "1_0j", "tan", "\x00", "-" * 190 + "1"],
)  # fmt: skip
def test_bad_expressions(text):
    if text == "-" * 190 + "1":  # long but sound
        assert parse_number(text) == 1.0
        return
    with pytest.raises(ExpressionError):
        parse_number(text)


@pytest.mark.parametrize(
    ("q", "message"),
    [
        ([0.0], r"table 'arm': q has shape \(1,\); expected \(2,\) or \(N, 2\)"),
        ([0.0, math.nan], "q: nan at index 1; every entry must be finite"),
        (["a", "b"], "dtype <U1 is not real numbers"),
        ([1j, 0], "dtype complex128"),
        ([True, False], "dtype bool"),
        ([[[0.0, 0.0]]], r"shape \(1, 1, 2\)"),
        ([[0.0], [0.0, 1.0]], "unequal length"),
    ],
)
def test_bad_q(q, message):
    table = kl.DHTable("arm", "standard", [kl.DHLink(a=1.0), kl.DHLink(a=1.0)])
    with pytest.raises(StateError, match=message):
        table.fk(q)
    with pytest.raises(StateError, match=message.replace("table", "robot")):
        kl.fk(kl.Robot.from_dh(table), q)


def test_tables_are_frozen():
    table = kl.load("scara").table
    for attempt in (
        lambda: setattr(table, "name", "other"),
        lambda: setattr(table.links[0], "a", 1.0),
        lambda: table.base.__setitem__((0, 0), 2.0),
        lambda: table.links[0].com.__setitem__(0, 2.0),
    ):
        with pytest.raises((AttributeError, ValueError)):
            attempt()
