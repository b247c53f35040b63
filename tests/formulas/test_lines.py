"""One broken line of a file of formulas costs that line; the message names it and the remedy."""

from __future__ import annotations

import pytest

from kinlab.doctor.file import formula_document
from kinlab.doctor.report import of_document

RIGHT = {"M22": '"m2*l2**2"', "g2": '"m2*g*l2*c12"'}


def judged(tmp_path, *lines):
    file = tmp_path / "f.toml"
    head = ['robot = "planar2r"', "[formulas]", *(f"{k} = {v}" for k, v in RIGHT.items())]
    file.write_text("\n".join([*head, *lines]) + "\n", encoding="utf-8")
    read = formula_document(file)
    found, unread = of_document(read.document, "f.toml", 20, 0, read.problems)
    return {one.function: one.agrees for one in found}, [str(one.problem) for one in unread]


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        (('M12 = "1"', 'M12 = "2"'), "M12 is given twice, in lines 5 and 6; keep one"),
        (('M12 = "1"', "", 'M12 = "2"', 'M12="3"'), "M12 is given twice, in lines 5, 7, 8; keep"),
        (("M12 = m2*l2**2",), 'line 5: M12: the formula stands in quotes: M12 = "m2*l2**2"'),
        (('M12 = "m2*l2**2',), "line 5: M12: the quotes are not closed"),
        (("M12 =",), "line 5: M12: nothing stands behind ="),
        (("M12 = “m2*l2**2”",), "line 5: M12: write the quotes"),
        (('M12 ＝ "m2*l2**2"',), "line 5: M12: write the signs ="),
        (("so tau is easy",), "line 5: 'so tau is easy' is no entry"),
    ],
)
def test_a_broken_line_costs_itself(tmp_path, lines, told):
    right, problems = judged(tmp_path, *lines)
    assert right == dict.fromkeys(RIGHT, True)
    assert len(problems) == 1
    assert told in problems[0]


@pytest.mark.parametrize(
    ("line", "entry"),
    [
        (r'tau2 = "\tau_2 = m_2 l_2^2 (\ddot\theta_1 + \ddot\theta_2) + m_2 l_1 l_2 \cos\theta_2'
         r' \ddot\theta_1 + m_2 l_1 l_2 \sin\theta_2 \dot\theta_1^2 + m_2 g l_2 c_{12}"', "tau2"),
        (r'x = "l_1 \cos\theta_1 + l_2 \cos\left(\theta_1+\theta_2\right)"', "x"),
        ('M_{12} = "m2*l2**2 + m2*l1*l2*cos(q2)"', "M12"),
        ('τ₂ = "m2*l1*l2*c2*qdd1 + m2*l1*l2*s2*qd1**2 + m2*l2*g*c12 + m2*l2**2*(qdd1+qdd2)"', "tau2"),
        ('M12\t=\t"m2*l2**2\t+ m2*l1*l2*c2"', "M12"),
        ('M12 = "m2*l2**2＋m2*l1*l2*cos（q2）"', "M12"),
        ('M12 = "1。0*m2*l2**2 + m2*l1*l2*cos(q２)。"', "M12"),
        ('M12 = """m2*l2**2 +\n   m2*l1*l2*c2"""', "M12"),
    ],
)  # fmt: skip
def test_what_is_sure_is_read_whatever_toml_says(tmp_path, line, entry):
    right, problems = judged(tmp_path, line)
    assert problems == []
    assert right == {**dict.fromkeys(RIGHT, True), entry: True}


def test_latex_in_double_quotes_is_no_escape(tmp_path):
    wrong, problems = judged(tmp_path, r'M12 = "m_2 l_2^2 + m_2 l_1 l_2 \sin\theta_2"', 'x = "')
    assert wrong["M12"] is False
    assert len(problems) == 1
    assert "line 6: x" in problems[0]


def test_a_double_key_beside_a_broken_line(tmp_path):
    right, problems = judged(tmp_path, 'M12 = "1"', "M11 = (", 'M12 = "2"')
    assert right == dict.fromkeys(RIGHT, True)
    assert [p.split(": ", 1)[1] for p in problems] == [
        'line 6: M11: the formula stands in quotes: M11 = "("',
        "M12 is given twice, in lines 5 and 7; keep one",
    ]


def test_without_a_robot_the_reason_is_told(tmp_path):
    file = tmp_path / "f.toml"
    file.write_text('robot = planar2r\n[formulas]\nM22 = "m2*l2**2"\n')
    read = formula_document(file)
    found, unread = of_document(read.document, "f.toml", 20, 0, read.problems)
    assert found == []
    assert [
        "line 1: robot: the formula stands in quotes" in str(one.problem) for one in unread
    ] == [True]
