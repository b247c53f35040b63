"""kinlab derive as a user types it."""

from __future__ import annotations

import runpy

import numpy as np
import pytest
from console import kinlab
from typer.testing import CliRunner

import kinlab as kl
from kinlab.cli import app
from kinlab.errors import KinlabError
from kinlab.symbolic.derive import WHAT


def run(*arguments):
    return CliRunner().invoke(app, ["derive", *map(str, arguments)])


def function(folder, text, name):
    file = folder / f"{name}.py"
    file.write_text(text, encoding="utf-8")
    return runpy.run_path(str(file))[name]


@pytest.mark.parametrize("options", [(), ("--numbers",)])
@pytest.mark.parametrize("robot", ["planar2r", "planar2r_rods", "single_link"])
def test_the_python_text_is_the_engine(tmp_path, robot, options):
    arm = kl.load(robot)
    rng = np.random.default_rng(0)
    q, v, a = rng.standard_normal((3, arm.n))
    text = run(robot, "--what", "tau", "--format", "python", *options).output
    assert "np.float64" not in text
    tau = function(tmp_path, text, "tau")(q, v, a)
    np.testing.assert_allclose(tau, kl.inverse_dynamics(arm, q, v, a), rtol=1e-10, atol=1e-10)
    text = run(robot, "--what", "M", "--format", "python", *options).output
    mass = np.reshape(function(tmp_path, text, "M")(q), (arm.n, arm.n))
    np.testing.assert_allclose(mass, kl.mass_matrix(arm, q), rtol=1e-10)


def test_text_names_every_entry_and_says_what_the_names_are():
    lines = run("planar2r", "--what", "M").output.splitlines()
    assert [line.split(" = ")[0] for line in lines[:-1]] == ["M11", "M12", "M21", "M22"]
    assert lines[-1].startswith("where l1 = 0.5, l2 = 0.4, m1 = 2, m2 = 1.5")
    lines = run("planar2r", "--what", "D").output.splitlines()
    assert [line[:4] for line in lines[:-1]] == [
        "D111", "D112", "D121", "D122", "D211", "D212", "D221", "D222",
    ]  # fmt: skip
    assert run("single_link", "--what", "D").output.startswith("D111 = 0")
    assert "qdd1*(l1**2*m1" in run("planar2r").output


def test_numbers_are_decimals():
    text = run("planar2r", "--numbers").output
    assert "17.1675*cos(q1)" in text and "/" not in text and "where" not in text
    assert "m1/8" in run("planar2r_rods", "--what", "T").output


def test_latex_is_balanced_and_dotted():
    text = run("planar2r", "--format", "latex").output
    assert r"\ddot{q}_{1}" in text and r"\dot{q}_{2}^{2}" in text
    assert text.count("{") == text.count("}")
    assert run("planar2r", "--what", "det", "--format", "latex").output.strip() == (
        r"l_{1} l_{2} \sin{\left(q_{2} \right)}"
    )


@pytest.mark.parametrize("what", sorted(WHAT))
@pytest.mark.parametrize("form", ["text", "latex", "python"])
def test_everything_is_offered_in_every_form(what, form):
    result = run("planar2r", "--what", what, "--format", form)
    assert result.exit_code == 0 and result.output.strip(), result.exception


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("planar2",), "did you mean 'planar2r'"),
        (("planar2r", "--what", "torque"), "'torque' is unknown; choose one of 'fk', 'J'"),
        (("planar2r", "--format", "tex"), "did you mean 'text', 'latex'"),
        (("ur5", "--what", "tau"), "offered up to 4 joints"),
        (("nothing.toml",), "no such file"),
    ],
)
def test_what_cannot_be_derived_is_told(arguments, message):
    result = run(*arguments)
    assert isinstance(result.exception, KinlabError)
    assert message in str(result.exception)


def test_from_another_folder_to_a_file(tmp_path):
    done = kinlab(
        "derive", "planar2r", "--what", "tau", "--format", "latex", "-o", "tau.tex", cwd=tmp_path
    )
    assert (done.returncode, done.stdout) == (0, "wrote tau.tex\n"), done.stderr
    assert (tmp_path / "tau.tex").read_text(encoding="utf-8").startswith(r"\left[\begin{matrix}")
    done = kinlab("derive", "planar2", cwd=tmp_path)
    assert done.returncode == 2 and len(done.stderr.strip().splitlines()) == 1
