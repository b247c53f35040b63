"""kinlab check: what it runs, what it prints, its exit code, the user's own files."""

from __future__ import annotations

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import kinlab as kl
from kinlab.check.targets import tasks
from kinlab.cli import app
from kinlab.errors import FileError, KinlabError, NameUnknownError
from kinlab.formulas.record import FormulaError

GOOD = '''
import numpy as np
import kinlab as kl

@kl.hand_formula("gravity_torques", robot="single_link", latex=r"g = m g l/2 \\\\cos q")
def weight(q):
    """Weight of the rod."""
    return np.array([2.5 * 9.81 * 0.3 * np.cos(q[0])])
'''


def run(*arguments):
    return CliRunner().invoke(app, ["check", *map(str, arguments)], catch_exceptions=True)


def arm(**changes):
    rod = {"a": 0.4, "alpha": 0.3, "mass": 2.0, "com": (-0.2, 0.01, 0.0),
           "inertia": np.diag([0.01, 0.03, 0.03])}  # fmt: skip
    links = [kl.DHLink(**rod), kl.DHLink(**{**rod, "joint": "prismatic", "flip": True, **changes})]
    return kl.DHTable("my_arm", "standard", links, gravity=(1.0, -2.0, -9.0))


def test_a_shipped_robot_runs_its_rows_and_its_table_checks():
    result = run("planar2r", "--samples", 20, "--rows")
    assert result.exit_code == 0, result.output
    for text in ("001.tau1", "table:fk, yourdfpy", "misprint: m2 l2² is counted twice"):
        assert text in result.output
    assert "stanford" not in result.output


def test_a_users_table_is_checked_against_both_engines(tmp_path):
    arm().save(tmp_path / "my_arm.toml")
    result = run(tmp_path / "my_arm.toml", "--json")
    assert result.exit_code == 0, result.output
    found = json.loads(result.output)
    assert found["ok"] and {row["robot"] for row in found["rows"]} == {"my_arm"}
    assert {row["part"] for row in found["rows"]} == {
        "fk", "fk, yourdfpy", "J", "M", "tau", "M a + C v + g", "M > 0", "Mdot - 2C",
    }  # fmt: skip
    assert all(row["max_error"] < 1e-9 and row["samples"] == 200 for row in found["rows"])


def test_a_urdf_is_checked_by_its_extracted_table(tmp_path):
    (tmp_path / "my_arm.urdf").write_text(kl.to_urdf(arm()), encoding="utf-8")
    result = run(tmp_path / "my_arm.urdf", "--json", "--samples", 20)
    assert result.exit_code == 0, result.output
    assert len(json.loads(result.output)["rows"]) == 8


def test_a_massless_table_is_checked_for_its_kinematics(tmp_path):
    links = [kl.DHLink(a=0.4), kl.DHLink(a=0.3, alpha=1.0)]
    kl.DHTable("light", "modified", links).save(tmp_path / "light.toml")
    found = json.loads(run(tmp_path / "light.toml", "--json").output)
    assert [row["part"] for row in found["rows"]] == ["fk", "fk, yourdfpy", "J"]
    assert found["ok"]


def test_a_users_formula_that_agrees(tmp_path):
    (tmp_path / "mine.py").write_text(GOOD, encoding="utf-8")
    result = run(tmp_path / "mine.py")
    assert result.exit_code == 0, result.output
    assert "Weight of the rod" in result.output and "agrees" in result.output


def test_a_users_formula_that_differs_exits_with_1_and_shows_the_worst_state(tmp_path):
    (tmp_path / "mine.py").write_text(GOOD.replace("0.3 *", "0.6 *"), encoding="utf-8")
    result = run(tmp_path / "mine.py")
    assert result.exit_code == 1
    assert "DIFFERS" in result.output and "worst at q =" in result.output
    assert "1 WRONG" in result.output


def test_a_users_nan_is_no_agreement_and_valid_json(tmp_path):
    (tmp_path / "mine.py").write_text(GOOD.replace("0.3 *", "np.nan *"), encoding="utf-8")
    result = run(tmp_path / "mine.py", "--json")
    assert result.exit_code == 1
    assert json.loads(result.output)["rows"][0]["max_error"] is None


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("x = 1\n", FileError, "no function is marked"),
        ("x = 1 / 0\n", FormulaError, "mine.py: ZeroDivisionError: division by zero"),
        ("def f(:\n", FormulaError, "mine.py: SyntaxError"),
        (GOOD.replace("single_link", "singl_link"), NameUnknownError, "'single_link'"),
        (GOOD.replace("gravity_torques", "gravity"), NameUnknownError, "'gravity_torques'"),
        (GOOD.replace("q[0]", "q[7]"), FormulaError, "'weight' failed at state 0: IndexError"),
    ],
)
def test_a_users_file_that_cannot_run_is_told_why(tmp_path, text, error, message):
    (tmp_path / "mine.py").write_text(text, encoding="utf-8")
    result = run(tmp_path / "mine.py")
    assert isinstance(result.exception, error), result.exception
    assert message in str(result.exception)
    assert isinstance(result.exception, KinlabError)


def test_notes_and_ids_can_be_named():
    assert {t.label.split()[0].split(":")[0] for t in tasks(["002.C"])} == {"002.C"}
    assert {t.label[:4] for t in tasks(["001"])} == {"001."}
    assert [t.label for t in tasks(["000.MVG:G", "001.tau2"])][-1] == "001.tau2 planar2r"


def test_everything_is_the_catalogue_and_every_shipped_table():
    labels = [t.label for t in tasks([])]
    assert "table:fk panda" in labels and "000.R:inverse identity" in labels
    assert len(labels) > 600


def test_unknown_names_list_the_near_ones(tmp_path):
    with pytest.raises(NameUnknownError, match="did you mean .*'001.tau1'"):
        tasks(["001.tau"])
    with pytest.raises(NameUnknownError, match="did you mean .*'planar2r'"):
        tasks(["planar2"])
    with pytest.raises(FileError, match=r"nothing\.toml: no such file"):
        tasks([str(tmp_path / "nothing.toml")])
    with pytest.raises(FileError, match=r"nothing\.py: no such file"):
        tasks([str(tmp_path / "nothing.py")])


def test_quantities_are_listed():
    result = run("--quantities")
    assert result.exit_code == 0
    assert "inverse_dynamics" in result.output and "q, v, a" in result.output


def test_it_is_said_which_frames_the_links_have():
    """Those at each link's own joint, also where a standard table has them at the far end."""
    words = " ".join(run("--quantities").stdout.split())
    assert "the frames at each link's own joint, as Craig's" in words
    assert "(v, omega) of the frames of link_poses" in words


def test_bad_options_exit_with_2():
    assert run("planar2r", "--samples", 0).exit_code == 2
    assert run("planar2r", "--seed", -1).exit_code == 2


OTHERWISE = """
import numpy as np
import kinlab as kl

l1, l2, e = 0.3, 0.5, 0.2/np.sqrt(2)

@kl.hand_formula("fivebar_angles", robot="isotropic")
def angles(xy, mode):
    out = []
    for side, sign in zip((e, -e), mode):
        d = xy - np.array([side, 0.0])
        r = np.hypot(*d)
        out.append(np.arctan2(d[1], d[0]) - sign*np.arccos((l1**2 + r**2 - l2**2)/(2*l1*r)))
    return np.array(out)

@kl.hand_formula("potential_energy", robot="planar2r")
def V(q):
    return 2.0*9.81*0.5*np.sin(q[0]) + 1.5*9.81*(0.5*np.sin(q[0]) + 0.4*np.sin(q[0] + q[1])) + 7
"""


def test_a_program_that_is_right_otherwise_is_not_wrong(tmp_path):
    """An angle a whole turn off and a potential with another zero, as `diagnose` has them."""
    file = tmp_path / "otherwise.py"
    file.write_text(OTHERWISE)
    result = run(file)
    assert result.exit_code == 0, result.output
    assert "2 right but written otherwise" in result.output and "WRONG" not in result.output
    assert "another zero" in result.output and "it is the same angle" in result.output
    for suffix in ("html", "md"):
        report = tmp_path / f"otherwise.{suffix}"
        assert run(file, "--report", report).exit_code == 0
        page = report.read_text()
        assert "another zero" in page and "ritten unusually" in page and "FAILS" not in page
    wrong = tmp_path / "wrong.py"
    wrong.write_text(OTHERWISE.replace("- sign*", "+ sign*").replace("+ 7", "+ q[0]"))
    result = run(wrong)
    assert result.exit_code == 1 and "2 WRONG" in result.output
    assert "line 13, the sign is wrong" in result.output


def test_an_inverse_kinematics_without_any_solution_costs_itself_alone(tmp_path):
    file = tmp_path / "none.py"
    file.write_text(
        "import numpy as np\nimport kinlab as kl\n\n"
        '@kl.hand_formula("inverse_kinematics_xy", robot="planar2r")\n'
        "def ik(x, y):\n    return np.zeros((0, 2))\n\n"
        '@kl.hand_formula("planar_angle", robot="planar2r")\n'
        "def phi(q):\n    return q[0] + q[1]\n"
    )
    result = run(file)
    assert result.exit_code == 1 and "1 agree" in result.output and "1 WRONG" in result.output
