"""Answers introduce themselves: verdict first, escaped, short; rows go out with every digit."""

from __future__ import annotations

import csv
import dataclasses
import sys
from functools import cache
from html.parser import HTMLParser

import numpy as np
import pytest

import kinlab as kl
from kinlab.errors import FileError, MissingExtraError
from kinlab.host.introductions import MOST_ROWS, Introduction, Rows, numbered

EVIL = "<script>alert(1)</script>&"
ARM = kl.load("puma560")
POSE = kl.fk(ARM, [0.3, -0.4, 0.5, 0.2, 0.7, 0.1])


def evil_table() -> kl.DHTable:
    rod = kl.DHLink(a=0.5, mass=1.0, com=(-0.2, 0, 0), inertia=0.01 * np.eye(3))
    names = {"source": EVIL, "tool_name": EVIL}
    return kl.DHTable(
        EVIL,
        "standard",
        [dataclasses.replace(rod, name=EVIL + "1"), rod],
        gravity=(0, -9.81, 0),
        **names,
    )


def evil(q):
    return -kl.gravity_torques(evil_table(), q)


evil.__name__ = EVIL


@cache
def answers():
    """One of each, with markup in every name that a user gives, and words of its verdict."""
    table = evil_table()
    robot = kl.Robot.from_dh(table)
    other = kl.DHTable(EVIL, "standard", [kl.DHLink(a=0.4), table.links[1]])
    light = kl.FiveBar(0.25, 0.3, 0.1, payload=1.0, name=EVIL)
    box = (-0.05, 0.05, -0.4, -0.3)
    with pytest.warns(kl.errors.KinlabWarning, match="NO MASS"):
        sizing = light.size_servo(box, 1.0, 10.0, motor="SGMAH-08A", gear_ratio=20.0, massless=True)
    # the task that suits a planar arm; T is within its reach
    T = kl.fk(robot, [0.4, 0.9])
    singular = kl.find_singularities(robot, points=20)
    near_the_end = kl.fk(robot, np.linspace([0.4, 0.9], [0.4, 0.0], 4))
    design = kl.design_isotropic(kl.load("planar2r").table, free=["a2", "tool.x"])[0]
    return {
        "Comparison": (kl.compare(robot, "gravity_torques", evil, 20), "DIFFERS"),
        "Diagnosis": (kl.diagnose(robot, "gravity_torques", evil), "differs"),
        "DHTable": (table, "standard convention: 2 joints"),
        "Robot": (robot, "2 joints, tool frame"),
        "IKResult": (kl.ik(robot, T, task="xy"), "solved"),
        "IKBatch": (kl.ik_batch(robot, np.stack([T, T]), task="xy"), "2 of 2 poses solved"),
        "IKBranches": (kl.ik_branches(robot, T), "2 solutions"),
        "SingularitySearch": (singular, "families of singular"),
        "IsotropySearch": (kl.find_isotropic(robot, seeds=40), "no isotropic configuration found"),
        "ServoSizing": (sizing, "FOR THE PAYLOAD ALONE"),
        "SweepResult": (kl.sweep(robot, ("position", "yoshikawa"), 500, workers=1), "500 states"),
        "Singularity": (singular[0], "rank 1"),
        "SingularFamily": (singular.families[0], "held by"),
        "IsotropicDesign": (design, "a2 = 0.527208"),
        "PlanarBoundary": (kl.planar_boundary(robot), "workspace in its plane"),
        "Dexterity": (kl.dexterity(robot, [0.4, 0.0]), "singular, rank 1"),
        "Ellipsoid": (kl.ellipsoid(robot, [0.4, 0.9]), "velocity ellipsoid, task xy (chosen"),
        "WorkspaceMap": (kl.sample_workspace(robot, samples=50), "50 tool positions"),
        "IKPath": (kl.ik_path(robot, near_the_end, [0.4, 0.9]), "4 of 4 poses solved"),
        "SolutionCount": (kl.solution_count(robot, T), "2 solutions, 2 within the limits, all"),
        "SolutionCounts": (kl.solution_count(robot, np.stack([T, T])), "2 poses: 2 with all"),
        "SolutionMap": (kl.solution_map(robot, cells=12), "at most 2 solutions"),
        "TableDiagnosis": (kl.diagnose_table(other, table), "differs"),
    }


NAMES = (
    "Comparison", "Diagnosis", "DHTable", "Robot", "IKResult", "IKBatch", "IKBranches",
    "SingularitySearch", "IsotropySearch", "ServoSizing", "SweepResult", "Singularity",
    "SingularFamily", "IsotropicDesign", "PlanarBoundary", "Dexterity", "Ellipsoid",
    "WorkspaceMap", "IKPath", "SolutionCount", "SolutionCounts", "SolutionMap", "TableDiagnosis",
)  # fmt: skip
"""The answers' names, so that collecting the tests computes none."""
ROWS = (
    "Comparison", "DHTable", "IKBatch", "IKBranches", "SingularitySearch", "IsotropySearch",
    "ServoSizing", "SweepResult", "WorkspaceMap", "IKPath", "SolutionCounts", "TableDiagnosis",
)  # fmt: skip


def test_every_answer_is_named():
    assert list(answers()) == list(NAMES)
    assert [name for name, (answer, _) in answers().items() if isinstance(answer, Rows)] == [*ROWS]


class Tags(HTMLParser):
    def __init__(self):
        super().__init__()
        self.seen, self.open, self.text = set(), [], ""

    def handle_starttag(self, tag, attrs):
        self.seen.add(tag)
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


@pytest.mark.parametrize("name", NAMES)
def test_the_verdict_comes_first_and_everything_is_escaped(name):
    answer, verdict = answers()[name]
    assert type(answer).__name__ == name
    lines = str(answer).splitlines()
    assert verdict in lines[0]
    assert len(lines) <= MOST_ROWS + 12
    assert len(repr(answer).splitlines()) == (1 if name in ("DHTable", "Robot") else len(lines))
    page = Tags()
    page.feed(answer._repr_html_())
    assert page.open == []
    assert page.seen <= {"div", "b", "table", "tr", "th", "td", "del"}
    assert verdict in page.text.split("\n")[0]
    if EVIL in str(answer):
        assert EVIL in page.text


@pytest.mark.parametrize("name", ROWS)
def test_rows_go_out_whole(name, tmp_path):
    answer, _ = answers()[name]
    answer.to_csv(tmp_path / "rows.csv")
    with (tmp_path / "rows.csv").open(newline="") as file:
        head, *rows = csv.reader(file)
    columns = answer.columns()
    assert head == list(columns)
    assert len(rows) == len(next(iter(columns.values())))
    for k, column in enumerate(columns.values()):
        for row, value in zip(rows, column, strict=True):
            if isinstance(value, (float, np.floating)) and not np.isnan(value):
                assert float(row[k]) == value  # every digit
            else:
                assert row[k] == str(value)
    frame = answer.to_dataframe()
    assert list(frame.columns) == head
    assert len(frame) == len(rows)


def test_the_csv_of_a_table_is_the_table(tmp_path):
    for name in ("puma560", "stanford", "panda", "planar2r"):
        table = kl.load(name).table
        table.to_csv(tmp_path / "arm.csv")
        again = kl.DHTable.load(tmp_path / "arm.csv")
        assert again.convention == table.convention
        assert kl.to_urdf(again).split("<link", 1)[1].count("joint") > 0
        q = np.random.default_rng(1).uniform(-1, 1, (3, table.n))
        assert np.array_equal(again.link_transforms(q), table.link_transforms(q))
        assert all(
            np.array_equal(a.inertia, b.inertia)
            for a, b in zip(again.links, table.links, strict=True)
        )
        assert [k.armature for k in again.links] == [k.armature for k in table.links]


def test_the_columns_of_a_comparison_hold_the_state_of_the_largest_error():
    found = kl.compare(ARM, "gravity_torques", lambda q: np.zeros(6), 30)
    columns = found.columns()
    worst = int(np.argmax(columns["error"]))
    q = np.array([columns[f"q{k}"][worst] for k in range(1, 7)])
    engine = [columns[f"engine{k}"][worst] for k in range(1, 7)]
    assert np.allclose(kl.gravity_torques(ARM, q), engine, rtol=1e-12)
    assert numbered("J", np.arange(6.0).reshape(1, 2, 3)).keys() == {
        "J11", "J12", "J13", "J21", "J22", "J23"
    }  # fmt: skip


def test_a_sweep_is_a_dict():
    result, _ = answers()["SweepResult"]
    held = dict(result)
    assert list(held) == ["position", "yoshikawa"]
    assert np.array_equal(
        held["position"], kl.fk(kl.Robot.from_dh(evil_table()), result.states)[:, :3, 3]
    )


def test_what_failed_is_not_called_solved():
    far = np.array(POSE)
    far[0, 3] = 9.0
    assert str(kl.ik(ARM, far)).startswith("inverse kinematics, task pose: NOT solved")
    assert "these are all" in str(kl.ik_branches(ARM, POSE)).splitlines()[0]
    seven = kl.load("panda")
    assert "there may be MORE" in str(
        kl.ik_branches(seven, kl.fk(seven, np.full(7, 0.2)), samples=2)
    )


def test_long_tables_are_counted():
    text = Introduction("x", (), ("n",), tuple((str(k),) for k in range(30)), 100).text()
    assert text.endswith("... and 88 more")
    assert len(text.splitlines()) == MOST_ROWS + 3


def test_without_pandas_the_message_says_how(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(MissingExtraError, match=r"kinlab\[dataframes\]"):
        answers()["IKBranches"][0].to_dataframe()
    with pytest.raises(FileError, match="cannot be written"):
        answers()["IKBranches"][0].to_csv(tmp_path / "no" / "rows.csv")


def test_what_says_itself_is_shown_in_notebooks_too():
    motion = kl.motion.joint(ARM, [[0.0] * 6, [0.2] * 6], duration=1.0)
    checked = kl.motion.check(ARM, motion)
    moved = kl.simulate("planar2r", [0.1, 0.2], duration=0.05)
    for answer in (checked, moved):
        page = Tags()
        page.feed(answer._repr_html_())
        assert page.text.startswith(str(answer).splitlines()[0])
