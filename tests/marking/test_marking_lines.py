"""The wrong line of a student's program: told as far as the feedback goes, and never forged."""

from __future__ import annotations

import json

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.marking.confined.arithmetic import space_of
from kinlab.doctor.marking.program import judge_program
from kinlab.doctor.marking.results import gradescope
from kinlab.doctor.marking.sheet import sheet_of
from kinlab.doctor.marking.submission import Submission
from kinlab.doctor.marking.words import KINDS, told
from kinlab.doctor.program.words import _WHAT

SHEET = {
    "title": "Homework",
    "robot": "planar2r",
    "feedback": "cause",
    "slips": {"sin/cos": 0.25},
    "questions": [{"id": "g", "quantity": "gravity_torques", "points": 4}],
}
PROGRAM = """
import numpy as np
from math import cos, sin
l1, l2, m1, m2, g0 = 0.5, 0.4, 2, 1.5, 9.81
def weight(m, x):
    return m*g0*x
def g(q):
    inner = l1*cos(q[0])
    outer = l2*{wave}(q[0] + q[1])
    total = weight(m1, inner) + weight(m2, inner + outer)
    return np.array([total, weight(m2, outer)])
"""
RIGHT, WRONG = PROGRAM.format(wave="cos"), PROGRAM.format(wave="sin")


def judged(program, level="cause"):
    return judge_program(sheet_of(SHEET, "s"), Submission("a.py", "ada", program=program), level)[
        0
    ][0]


def test_line_and_kind_are_told_as_far_as_the_feedback_goes():
    one = judged(WRONG, "answer")
    assert (one.points, one.kinds, one.place) == (3.0, ("sin/cos",), "line 9")
    assert one.cause == told(["sin/cos"]) and "should be `outer = l2*cos(" in one.answer[0]
    one = judged(WRONG, "verdict")
    assert (one.points, one.place, one.cause, one.answer) == (3.0, "", "", ())


def test_an_answer_of_another_shape_says_so():
    one = judged(WRONG.replace("return np.array([total, weight(m2, outer)])", "return [total]"))
    assert one.verdict == "wrong" and one.points == 0.0
    assert one.remark == "the answer has the shape (1,), asked is (2,)"
    assert judged(WRONG).remark == ""


@pytest.mark.parametrize("level", ["place", "cause"])
def test_no_output_holds_a_corrected_line(level, tmp_path):
    """Nothing of the program stands in any output, so that nothing of its correction does."""
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "ada.py").write_text(WRONG, encoding="utf-8")
    out = tmp_path / "out"
    marks = kl.mark(SHEET, tmp_path / "in", out, feedback=level, run_python=True, workers=1)
    texts = [path.read_text(encoding="utf-8") for path in out.rglob("*") if path.is_file()]
    texts += [str(marks["ada"]) + json.dumps(gradescope(marks, marks["ada"]))]
    assert len(texts) > 4 and marks["ada"]["g"].place == "line 9"
    for piece in ("should be", "l2*", "outer", "cos(", "g0"):
        assert not any(piece in text for text in texts), piece
    assert any("line 9" in text for text in texts)
    cause = told(["sin/cos"])
    assert any(cause in text for text in texts if "class" not in text) == (level == "cause")


FORGED = """
import json, os, sys
import numpy as np
said = {"sentence": "", "kinds": ["sin/cos"], "places": [], "error_after": 0.0, "cost": 1.0}
if "kinlab" in sys.modules:
    for k in range(3, 30):
        try:
            os.write(k, (json.dumps({"causes": [said], "written_out": True}) + "\\n").encode())
        except OSError:
            pass
def g(q):
    return np.tanh(q)
"""


def test_a_program_cannot_say_itself_what_is_wrong_with_it():
    one = judged(FORGED)
    assert (one.verdict, one.points, one.kinds) == ("wrong", 0.0, ("unknown",))


@pytest.mark.parametrize(
    "line",
    [
        "import os", "import numpy.f2py", "from numpy import load", "from numpy import *",
        "import kinlab", "x = np.f2py.os", "np.cos = np.sin", "x = ().__class__", "open('a')",
        "x = getattr(np, 'load')", "x = __builtins__", "exec('1')", "@print\ndef f(): pass",
        "x = '{0.T}'.format(np)", "class A: pass", "def f():\n    import math", "x = np.fromfile('a')",
        "del np.cos", "np.cos: int = 3", "with x: pass", "x = _see", "global x", "x = np.ndarray(3)",
    ],
)  # fmt: skip
def test_what_is_more_than_arithmetic_is_not_tried(line):
    with pytest.raises((ValueError, SyntaxError, NameError)):
        space_of("import numpy as np\n" + line, "a.py")


def test_arithmetic_is_run():
    space = space_of(
        "import numpy.linalg as la\nfrom math import *\nimport math\nimport numpy as np\n" + RIGHT
        + "table = {'a': [l1, l2]}\ndef f(x):\n    for k, a in enumerate(table['a']):\n"
        "        x += la.norm(np.array([[a]]).T) * pi * math.e\n    return x if x else sum([x])\n",
        "a.py",
    )  # fmt: skip
    assert space["f"](0.0) == pytest.approx(0.9 * np.pi * np.e)
    assert space["g"]([0.0, 0.0]) == pytest.approx(
        [3.5 * 9.81 * 0.5 + 1.5 * 9.81 * 0.4, 1.5 * 9.81 * 0.4]
    )


def test_a_sheet_can_price_every_slip_of_a_program():
    assert {*_WHAT} <= {*KINDS}
    assert sheet_of({**SHEET, "slips": dict.fromkeys(_WHAT, 0.5)}, "s").questions[0].slips
