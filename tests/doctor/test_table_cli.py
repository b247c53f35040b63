"""kinlab check --against, its report and JSON; kl.view and kinlab view --against; bad input."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from browser import chromium, open_file, tab, world  # noqa: F401  fixtures
from scenes import paths, told
from typer.testing import CliRunner

import kinlab as kl
from kinlab.cli import app
from kinlab.viewer.against import against_scene

PANDA = kl.load("panda").table


def row(table, i, **cells):
    links = list(table.links)
    links[i - 1] = replace(links[i - 1], **cells)
    return replace(table, links=links)


MINE = replace(row(PANDA, 3, alpha=-PANDA.links[2].alpha), name="mine")


def run(*arguments):
    return CliRunner().invoke(app, list(map(str, arguments)), catch_exceptions=True)


@pytest.fixture
def files(tmp_path):
    MINE.save(tmp_path / "mine.toml")
    (tmp_path / "panda.urdf").write_text(kl.to_urdf(PANDA), encoding="utf-8")
    return tmp_path


def test_the_terminal_names_the_cell(files):
    result = run("check", files / "mine.toml", "--against", files / "panda.urdf")
    assert result.exit_code == 1
    lines = result.output.splitlines()
    assert lines[0] == "mine: differs (against panda)"
    assert lines[1] == "  row 3: alpha has the wrong sign: -90 deg written, 90 deg meant"
    assert run("check", files / "mine.toml", "--against", files / "mine.toml").exit_code == 0


def test_json_and_reports(files):
    reports = [option for kind in ("html", "md") for option in ("--report", files / f"r.{kind}")]
    result = CliRunner().invoke(
        app, [str(x) for x in ("check", files / "mine.toml", "--against", "panda", "--json",
                               *reports)])  # fmt: skip
    data = json.loads(result.stdout)
    assert result.exit_code == 1 and data["ok"] is False
    [one] = data["tables"]
    assert one["causes"][0] == {
        "row": 3, "column": "alpha", "written": -np.pi / 2, "meant": np.pi / 2, "kind": "sign",
        "sentence": "row 3: alpha has the wrong sign: -90 deg written, 90 deg meant",
    }  # fmt: skip
    page = (files / "r.html").read_text(encoding="utf-8")
    assert "<del>-90 deg</del> <b>90 deg</b>" in page and "Differs: row 3" in page
    assert "**Differs**: row 3" in (files / "r.md").read_text(encoding="utf-8")
    assert "http://" not in page and "https://" not in page


def test_the_notebook_says_the_verdict_first():
    found = kl.diagnose_table(MINE, PANDA)
    html = found._repr_html_()
    assert html.index("differs") < html.index("row 3") < html.index("<table>")
    assert str(found).splitlines()[0].startswith("mine: differs")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("puma560", "panda"), "table 'puma560' has 6 joints, 'panda' has 7"),
        (("panda", "erd:ur10"), "no joint name in common; compare descriptions of the same joints"),
        (("panda", "tiago"), "name the tool"),
        (("panda", "nobody"), "robot 'nobody' is unknown"),
        (("nobody.toml", "panda"), "nobody.toml: no such file"),
        (("here.urdf", "panda"), "the table to judge is a .toml or .csv file"),
    ],
)
def test_bad_input_is_one_line_with_the_remedy(arguments, said):
    mine, against = arguments
    with pytest.raises(kl.KinlabError) as caught:
        kl.diagnose_table(mine, against)
    assert said in str(caught.value) and "\n" not in str(caught.value)


def test_neither_or_both_references_are_refused():
    with pytest.raises(kl.KinlabError, match="either against= or poses="):
        kl.diagnose_table(MINE)
    with pytest.raises(kl.KinlabError, match="nothing to compare a table with"):
        kl.diagnose_table(MINE, 7)


def test_joint_names_without_one_in_common_are_noted():
    mine = replace(MINE, links=[replace(k, name=f"axis{i}") for i, k in enumerate(MINE.links)])
    found = kl.diagnose_table(mine, PANDA)
    assert any("no joint name in common" in note for note in found.notes)


def test_the_scene_lights_the_wrong_row_and_draws_the_other_arm():
    scene = against_scene(MINE, kl.to_urdf(PANDA))
    assert any(path.endswith("lit_3/rod") for path in paths(scene))
    assert not any("lit_4" in path for path in paths(scene))
    spec = told(scene)
    assert len(spec["followers"]) == 7 and "reference" in spec["shown"] and "wrong" in spec["shown"]
    assert "row 3: alpha has the wrong sign" in spec["notes"][0]
    agreeing = against_scene(PANDA, kl.to_urdf(PANDA))
    assert "wrong" not in told(agreeing)["shown"] and "agrees" in told(agreeing)["notes"][0]


def test_poses_are_drawn_with_the_repaired_arm():
    q = np.random.default_rng(0).uniform(-1, 1, (20, 7))
    scene = against_scene(MINE, (q, PANDA.fk(q)[:, -1]))
    assert any(path.endswith("/poses") for path in paths(scene))
    assert len(told(scene)["followers"]) == 7


def test_the_command_view_writes_the_page(files):
    result = run("view", files / "mine.toml", "--against", files / "panda.urdf", "--save",
                 files / "page.html")  # fmt: skip
    assert result.exit_code == 0, result.output
    assert (files / "page.html").stat().st_size > 1e5


def test_both_arms_follow_the_sliders_in_a_browser(tab, tmp_path):  # noqa: F811
    scene = against_scene(MINE, PANDA)
    page = open_file(tab, scene, tmp_path)
    q = np.array([0.3, -0.4, 0.5, -1.2, 0.2, 1.1, 0.4])
    page.evaluate("q => page.setJoints(q)", q.tolist())
    robot = kl.Robot.from_dh(PANDA)
    path = told(scene)["followers"][-1]["path"]
    import pinocchio as pin

    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, q)
    np.testing.assert_allclose(world(page, path), data.oMi[7].homogeneous, atol=1e-5)
