"""What is no arithmetic is refused with what is likely to be missing."""

from __future__ import annotations

import re

import pytest

import kinlab as kl
from kinlab.errors import ExpressionError
from kinlab.formulas.lines import read_lines
from kinlab.formulas.text import parse
from kinlab.host.language import speaking


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("m1*(l1 + l2*c2", "a bracket is not closed"),
        ("m1*l1 + l2)*c2", "a bracket is closed too often"),
        ("l1 s1 + l2 s12", "write * between factors"),
        ("l1*s1 +", None),
        ("l1*", "something is missing at the end: l1*"),
    ],
)
def test_no_arithmetic(text, remedy):
    with pytest.raises(ExpressionError, match="no arithmetic") as caught:
        parse(text, "x")
    said = str(caught.value)
    assert said.endswith(remedy) if remedy else ";" not in said


def test_a_power_is_quoted_as_it_was_typed():
    with pytest.raises(ExpressionError, match=r"m1\*\(l1\^2; a bracket is not closed"):
        parse("m1*(l1^2", "x")


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ("m2*g*l2*cos(q1+q2", "列附近不是算式"),
        ("m2*g*l2*", "末尾缺了什么：m2*g*l2*"),
        ("m2*g*l2*c12 = tau2 = 3", "有 2 个等号"),
        (r"\frac{m_2", "这里应当是"),
        ("m2*g*l2*c12*w", "'w' 未知；可选："),
        ("m2*g*l2*C12*qd1", "余弦请写 c12"),
    ],
)
def test_what_cannot_be_read_is_told_in_the_readers_language(typed, said):
    with speaking("zh"), pytest.raises(ExpressionError, match=re.escape(said)):
        kl.diagnose("planar2r", "g2", typed)


def test_lines_of_a_file_are_told_in_the_readers_language():
    with speaking("zh"):
        found = read_lines("robot = 'planar2r'\ntau1 = m1*g\ntau2 = 'x", "a.toml")
    assert [str(problem) for _key, problem in found.problems] == [
        'a.toml：第 2 行: tau1: 公式要放在引号里：tau1 = "m1*g"',
        "a.toml：第 3 行: tau2: 引号没有闭合，或引号后面还有内容",
    ]
