"""kinlab check on the user's own formulas: diagnosis, JSON, report, mixed arguments, exit codes."""

from __future__ import annotations

import json

import pytest
from console import kinlab
from lxml import etree
from typer.testing import CliRunner

from kinlab.cli import app
from kinlab.formulas.marks import differences
from kinlab.formulas.text import parse
from kinlab.formulas.typeset import Marks, equation, latex, mathml, symbol

RIGHT = 'robot = "planar2r"\n[formulas]\nx = "l1*c1 + l2*c12"\nM12 = "m2*l2**2 + m2*l1*l2*c2"\n'
WRONG = RIGHT.replace("l1*l2*c2", "l1*l2*s2")
TORQUE = """
robot = "planar2r"
[symbols]
L = 0.5
[formulas]
tau2 = "(m2*l2**2 + m2*L*l2*c2)*qdd1 + m2*l2**2*qdd2 + m2*L*l2*s2*qd1**2 + m2*g*l2*cos(q2)"
"""
FUNCTIONS = '''
import numpy as np
import kinlab as kl

@kl.hand_formula("gravity_torques", robot="planar2r")
def weight(q):
    """Weight."""
    second = 1.5 * 9.81 * 0.4 * np.cos(q[0] + q[1])
    return np.array([3.5 * 9.81 * 0.5 * np.cos(q[0]) + second, SIGN * second])
'''
TRANSPOSED = """
import numpy as np
import kinlab as kl

@kl.hand_formula("planar_jacobian", robot="planar2r")
def J(q):
    s1, c1, s, c = np.sin(q[0]), np.cos(q[0]), np.sin(q.sum()), np.cos(q.sum())
    return np.array([[-.5*s1 - .4*s, -.4*s], [.5*c1 + .4*c, .4*c], [1, 1]]).T
"""
FIVEBAR = """
import numpy as np
import kinlab as kl

@kl.hand_formula("{quantity}", robot="{robot}")
def mine({arguments}):
    return 2 * {first}
"""


def run(*arguments):
    return CliRunner().invoke(app, ["check", *map(str, arguments)])


def write(folder, name, text):
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def test_exit_codes_of_formula_files(tmp_path):
    codes = {}
    for name, text in (("right", RIGHT), ("wrong", WRONG), ("bad", RIGHT.replace("c12", "frob"))):
        file = write(tmp_path, f"{name}.toml", text)
        done = kinlab("check", file)
        codes[name] = done.returncode
        assert "Traceback" not in done.stdout + done.stderr
    assert codes == {"right": 0, "wrong": 1, "bad": 2}
    assert all(line.startswith("kinlab: not judged: ") for line in done.stderr.splitlines())
    assert "'frob' is unknown" in done.stderr and "x:" in done.stderr


def test_a_marked_function_that_differs_is_diagnosed(tmp_path):
    file = write(tmp_path, "f.py", FUNCTIONS.replace("SIGN", "-1"))
    result = run(file)
    assert result.exit_code == 1, result.output
    assert "weight: weight DIFFERS with gravity_torques of planar2r" in result.output
    lines = [line for line in result.output.splitlines() if line.startswith("diagnosis: ")]
    assert len(lines) == 1 and "diagnosis: line 9, the sign is wrong" in lines[0]
    assert "relative error before" in result.output and "after" in result.output
    row = json.loads(run(file, "--json").output)["rows"][0]
    assert not row["ok"] and row["diagnosis"]["verdict"] == "differs"
    assert row["diagnosis"]["causes"][0]["error_after"] <= 1e-9
    assert row["diagnosis"]["file"] == str(file)


def test_a_marked_function_that_agrees_is_left_alone(tmp_path):
    file = write(tmp_path, "f.py", FUNCTIONS.replace("SIGN", "1"))
    found = json.loads(run(file, "--json").output)
    assert found["ok"] and found["rows"][0]["diagnosis"] is None and found["formulas"] == []
    assert run(file).exit_code == 0 and "diagnosis" not in run(file).output


def test_nothing_is_guessed_about_a_function(tmp_path):
    file = write(tmp_path, "f.py", FUNCTIONS.replace("SIGN * second", "np.tanh(q[1])"))
    result = run(file)
    assert result.exit_code == 1 and "no known slip explains it" in result.output
    row = json.loads(run(file, "--json").output)["rows"][0]
    assert row["diagnosis"]["verdict"] == "differs, cause unknown"
    assert row["diagnosis"]["causes"] == []


def test_an_answer_of_the_wrong_shape_is_explained_or_refused(tmp_path):
    file = write(tmp_path, "f.py", TRANSPOSED)
    result = run(file, "--report", tmp_path / "f.html")
    assert result.exit_code == 1, result.exception
    assert "the formula is transposed" in result.output
    found = json.loads(run(file, "--json").output)
    assert not found["ok"] and found["formulas"][0]["error_before"] is None
    page = (tmp_path / "f.html").read_text(encoding="utf-8")
    assert "The answer has another shape" in page
    other = write(tmp_path, "g.py", TRANSPOSED.replace(".T", "[:1]"))
    refused = run(other)
    assert refused.exit_code == 1 and "answered with shape" in str(refused.exception)


def test_a_five_bar_gets_its_diagnosis_too(tmp_path):
    from kinlab.check.catalogue import catalogue, plan
    from kinlab.check.quantities.registry import quantity
    from kinlab.check.quantities.serial import SERIAL

    pairs = [(f, n) for f, n in plan(catalogue()) if quantity(f.quantity).domain.name == "fivebar"]
    record, name = pairs[0]
    found = quantity(record.quantity)
    assert found.domain is not SERIAL
    shape = found.answers(found.domain.load(name), 2, 0).shape[1:]
    text = FIVEBAR.format(quantity=record.quantity, robot=name, first=f"np.ones({shape})",
                          arguments=", ".join(found.arguments))  # fmt: skip
    file = write(tmp_path, "f.py", text)
    result = run(file, "--samples", 5)
    assert result.exit_code == 1, result.exception
    assert "DIFFERS" in result.output and "no known slip explains it" in result.output
    rows = json.loads(run(file, "--samples", 5, "--json").output)["rows"]
    assert not rows[0]["diagnosis"]["ok"]


def test_json_of_a_formula_file(tmp_path):
    file = write(tmp_path, "f.toml", WRONG)
    result = run(file, "--json")
    assert result.exit_code == 1
    found = json.loads(result.output)
    assert not found["ok"] and found["rows"] == []
    by_name = {one["function"]: one for one in found["formulas"]}
    assert by_name["x"]["verdict"] == "agrees" and by_name["x"]["ok"]
    cause = by_name["M12"]["causes"][0]
    assert cause["kinds"] == ["sin/cos"] and cause["error_after"] <= 1e-9
    assert by_name["M12"]["error_before"] > 1e-3


def test_arguments_of_all_kinds_go_together(tmp_path):
    text = write(tmp_path, "f.toml", TORQUE)
    code = write(tmp_path, "f.py", FUNCTIONS.replace("SIGN", "1"))
    result = run("001.tau2", code, text, "--samples", 20, "--report", tmp_path / "r.html",
                 "--report", tmp_path / "r.md", "--json")  # fmt: skip
    assert result.exit_code == 1, result.exception
    found = json.loads(result.stdout)
    assert [row["id"] for row in found["rows"]] == ["001.tau2", "weight"]
    assert [one["function"] for one in found["formulas"]] == ["tau2"]
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "Note 001" in page and "Your formulas" in page and "f.toml: your formulas" in page


def test_the_report_shows_the_formula_the_diagnosis_and_the_repair(tmp_path):
    file = write(tmp_path, "f.toml", TORQUE + 'x = "l1*c1 + l2*c12"\ny = "l1*tanh(q1)"\n'.replace(
        "tanh", "exp"))  # fmt: skip
    result = run(file, "--report", tmp_path / "r.html", "--report", tmp_path / "r.md")
    assert result.exit_code == 1 and "wrote" in result.output
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "1 of 3 right, what is wrong is known of 1, unknown of 1" in page
    tau, x, y = page.split("<article")[1:]
    assert tau.count("<math") == 2
    for text in ("as written", "should be", 'class="wrong"', 'class="fixed"',
                 "cos(q2) should be cos(q1 + q2)", "once repaired"):  # fmt: skip
        assert text in tau, text
    assert x.count("<math") == 1 and "Agrees with entry (1, 4) of fk of planar2r" in x
    assert "fk[0,3]" not in page and "inverse_dynamics[1]" not in page
    assert "Differs, cause unknown" in y and "Worst entry y at q = " in y
    assert "should be" in y and 'class="wrong"' not in y  # derived, and nothing is pointed at
    text = (tmp_path / "r.md").read_text(encoding="utf-8")
    assert r"\textcolor{red}{q_{2}}" in text and r"\textcolor{green}{q_{1} + q_{2}}" in text
    assert text.count("$$") % 2 == 0


def test_a_report_path_is_refused_before_the_work(tmp_path):
    result = run(write(tmp_path, "f.toml", RIGHT), "--report", tmp_path / "r.pdf")
    assert "a report ends in" in str(result.exception)


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("qdd1", r"\ddot{q}_{1}"), ("dth2", r"\dot{\theta}_{2}"), ("th1", r"\theta_{1}"),
        ("theta_dot_1", r"\dot{\theta}_{1}"), ("c12", "c_{12}"), ("lc1", "l_{c1}"), ("g", "g"),
        ("Ixx1", "I_{xx1}"), ("tau1", r"\tau_{1}"), ("m_load", "m_{load}"), ("M12", "M_{12}"),
    ],
)  # fmt: skip
def test_names(name, wanted):
    assert symbol(name) == wanted


@pytest.mark.parametrize(
    "text",
    ["a - b", "-a*b/(2*c) + 1/d", "sqrt(a + b)*sin(q1)**2", "-(a + b)**2", "2*q1**-2", "0.05*a/3",
     "atan2(a, b) - 1e-7", "(a/b)**3*(-2)*c", "abs(a)*sign(b)*exp(c)", "fk_x - a*(-b)"],
)  # fmt: skip
def test_typeset_formulas_are_sound_and_whole(text):
    node = parse(text)
    root = etree.fromstring(mathml(latex(node)).encode())
    assert etree.QName(root).localname == "math"
    assert latex(node).count("{") == latex(node).count("}")
    assert not [e for e in root.iter() if e.text and "\\" in e.text]


def test_long_sums_are_broken_into_lines():
    _, text = equation("tau1", parse(" + ".join(f"m1*l{k}*sin(q1)*qdd1**2" for k in range(1, 10))))
    lines = text.removeprefix(r"\begin{array}{l}").split(r"\\")
    assert [line.count("sin") for line in lines] == [5, 4]
    assert lines[1].strip().startswith("{} + m_{1}")


@pytest.mark.parametrize(
    ("hand", "right", "wrong", "fixed"),
    [
        ("m*g*cos(q2) + a", "m*g*cos(q1 + q2) + a", r"\wrong{q_{2}}", r"\fixed{q_{1} + q_{2}}"),
        ("a + b*c", "a - b*c", r"\wrong{+ b", r"\fixed{- b"),
        ("a*b + c", "a*b**2 + c", r"\wrong{b}", r"\fixed{b^{2}}"),
        ("a + b", "a + b + g*c", None, r"\fixed{+ g"),
        ("a*c1 + b", "a*cos(q1) + b", None, None),
    ],
)
def test_the_difference_is_marked(hand, right, wrong, fixed):
    meaning = {"c1": parse("cos(q1)")}
    ours, theirs = differences(parse(hand), parse(right), meaning)
    shown = latex(parse(hand), Marks("wrong", ours)), latex(parse(right), Marks("fixed", theirs))
    for text, wanted, command in zip(shown, (wrong, fixed), (r"\wrong", r"\fixed"), strict=True):
        assert (wanted in text) if wanted else command not in text, text
