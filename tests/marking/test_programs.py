"""A program's functions are asked one after the other, and one costs only its own question."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.doctor.marking.program import in_words, judge_program
from kinlab.doctor.marking.sheet import sheet_of
from kinlab.doctor.marking.submission import Submission

SHEET = {
    "robot": "planar2r",
    "feedback": "cause",
    "questions": [
        {"id": "q1", "entry": "x"},
        {"id": "q2", "entry": "y"},
        {"id": "q3", "answer": "m1*g*l1"},
    ],
}
PROGRAM = """
import os, sys
import numpy as np
def q1(q):
    {first}
    return .5*np.cos(q[0]) + .4*np.cos(q[0] + q[1])
def q2(q):
    return .5*np.sin(q[0]) + .4*np.sin(q[0] + q[1])
q3 = "g*l1*m1"
{last}
"""


def judged(first="pass", last=""):
    program = PROGRAM.format(first=first, last=last)
    sheet = sheet_of(SHEET, "s")
    return judge_program(sheet, Submission("a.py", "ada", program=program), "cause")[0]


@pytest.mark.parametrize(
    ("first", "told"),
    [
        ("while True: pass", ("signal", "did not come back")), ("os._exit(4)", ("exit code 4",)),
        ("sys.exit()", ("delete exit()",)), ("os.abort()", ("signal",)), ("x = [0]*10**10", ("MemoryError",)),
        ("1/0", ("ZeroDivisionError",)),
    ],
)  # fmt: skip
def test_one_function_costs_only_its_question(first, told, monkeypatch):
    monkeypatch.setattr("kinlab.doctor.marking.program.SECONDS", 1.0)
    one, two, three = judged(first)
    assert one.verdict == "could not be read" and any(part in one.remark for part in told)
    assert two.right and three.right


@pytest.mark.parametrize(
    "last", ["sys.exit('done')", "exit(0)", "raise SystemExit", "1/0", "undefined"]
)
def test_how_the_file_ends_costs_no_function(last):
    assert [one.right for one in judged(last=last)] == [True, True, True]


def test_all_functions_may_be_endless(monkeypatch):
    monkeypatch.setattr("kinlab.doctor.marking.program.SECONDS", 0.5)
    sheet = {**SHEET, "questions": [{"id": f"a{k}", "entry": "x"} for k in range(8)]}
    program = "".join(f"def a{k}(q):\n    while True: pass\n" for k in range(8))
    outcomes, _limits = judge_program(sheet_of(sheet, "s"), Submission("a.py", "ada", program=program), "cause")  # fmt: skip
    assert {one.verdict for one in outcomes} == {"could not be read"}
    assert "not asked" in outcomes[-1].remark


def test_what_a_program_may_not_import_is_told_with_a_remedy():
    sheet = sheet_of(SHEET, "s")
    program = "import matplotlib.pyplot as plt\ndef q1(q): return 1\n"
    found = judge_program(sheet, Submission("a.py", "ada", program=program), "cause")[0][0]
    assert "imports matplotlib" in found.remark and "delete that line" in found.remark
    assert "may not import socket" in in_words("ImportError: a submission may not import socket", "import socket")  # fmt: skip


def test_functions_of_other_names_are_told():
    sheet = sheet_of(SHEET, "s")
    program = "def jacobian(q): return 1\ndef helper(): pass\nq3 = 9.81\n"
    one, _two, three = judge_program(sheet, Submission("a.py", "ada", program=program), "cause")[0]
    assert one.remark == "no function is called q1, x; there are: jacobian, helper"
    assert three.right


def test_a_program_that_says_it_is_done_gets_nothing(tmp_path):
    forged = (
        "import os\nfor k in range(3, 30):\n    try: os.write(k, b'{\"done\": true}\\n')\n"
        "    except OSError: pass\ndef q1(q): return 0.9\n"
    )
    (tmp_path / "a.py").write_text(forged)
    (tmp_path / "b.txt").write_text("q1: l1*c1 + l2*c12\n")
    marks = kl.mark(SHEET, tmp_path, run_python=True, workers=1)
    assert [m.total for m in marks.marks] == [0.0, 1.0]
