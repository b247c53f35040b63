"""``--tool`` names the tool wherever a command names an arm; ``--tip`` is its older name."""

from __future__ import annotations

import numpy as np
import pytest
from typer.testing import CliRunner

import kinlab as kl
from kinlab.cli import app
from kinlab.errors import KinlabError, NameUnknownError

COMMANDS = ("check", "ik", "view", "singular", "isotropy", "workspace", "derive", "info", "dh", "urdf", "motion")  # fmt: skip

MORE = {"ik": ["--xyz", "0.3", "0.2", "0.1"], "motion": ["0,0", "1,1"]}


def run(*words: str):
    return CliRunner(env={"COLUMNS": "200"}).invoke(app, list(words))


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_with_an_arm_knows_the_tool(command):
    told = run(command, "--help").output
    assert "--tool" in told and "--tip" not in told
    for option in ("--tool", "--tip"):  # read before anything is worked out
        found = run(command, "ur5", *MORE.get(command, []), option, "ee_link")
        assert isinstance(found.exception, NameUnknownError)
        said = str(found.exception)
        assert "one tool, here 'tool0'" in said and "'erd:ur5'" in said and "'ee_link'" in said


@pytest.mark.parametrize("command", ["info", "ik", "singular", "derive", "dh"])
def test_a_five_bar_and_a_file_nearly_named(command):
    found = run(command, "isotropic", *MORE.get(command, []))
    assert "five-bar" in str(found.exception)
    assert "kinlab fivebar analyse isotropic" in str(found.exception)
    found = run(command, "my_arm.tml", *MORE.get(command, []))
    assert isinstance(found.exception, KinlabError)
    assert "did you mean 'my_arm.toml'" in str(found.exception)


def test_check_of_a_urdf_that_is_a_tree():
    found = run("check", "erd:panda")
    assert "name the tool" in str(found.exception) and "--tool" in str(found.exception)
    found = run("check", "erd:panda", "--tool", "panda_link8", "--samples", "3")
    assert found.exit_code == 0, found.output
    assert "8 formulas, 8 rows: 8 agree" in found.output


@pytest.mark.parametrize("what", ["001", "001.tau1", "isotropic", "mine.py"])
def test_check_refuses_a_tool_of_what_has_none(what):
    found = run("check", what, "--tool", "hand")
    assert found.exit_code != 0
    assert "leave --tool hand out" in str(found.exception) + found.output


def test_a_shipped_arm_stays_the_arm_that_it_is():
    table, urdf = kl.load("ur5"), kl.load("erd:ur5", tool="ee_link")
    assert kl.load("ur5", tool="tool0").table == table.table
    assert urdf.tool_name == "ee_link"
    with pytest.raises(NameUnknownError, match="'erd:ur5'"):
        kl.load("ur5", tool="ee_link")
    q = np.linspace(0.1, 0.6, 6)
    there = kl.fk(urdf, q, at="tool0")  # the frame that the table's tool is
    assert np.allclose(there, kl.fk(kl.load("erd:ur5", tool="tool0"), q), rtol=0, atol=1e-14)
    assert np.allclose(there, kl.fk(table, q), rtol=0, atol=1e-6)  # the URDF's printed digits
