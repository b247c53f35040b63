"""LaTeX formulas: read as the textbooks write them, and nothing else."""

from __future__ import annotations

import time

import numpy as np
import pytest

from kinlab.doctor.file import examine_file
from kinlab.errors import ExpressionError, FileError
from kinlab.formulas import tree
from kinlab.formulas.signs.latex import expression
from kinlab.formulas.text import canonical, parse


@pytest.mark.parametrize(
    ("latex", "text"),
    [
        (r"m_1 l_1^2 \ddot{q}_1", "m1*l1**2*qdd1"),
        (r"m_1l^2_1\ddot\theta_1", "m1*l1**2*qdd1"),
        (r"\dot{\theta_1}\dot q_2^2", "qd1*qd2**2"),
        (r"\frac12 m_1 l_1^{2} - \frac{a b}{2}", "m1*l1**2/2 - a*b/2"),
        (r"\left[a + b\right] \cdot c / d", "(a + b)*c/d"),
        (r"\cos q_2 \sin q_1", "cos(q2)*sin(q1)"),
        (r"\sin^2\theta_1 + \cos 2q_1", "sin(q1)**2 + cos(2*q1)"),
        (r"-g\,l_{c1}\cos(q_1 + q_2) c_{12}", "-g*lc1*cos(q1 + q2)*cos(q1 + q2)"),
        (r"\sqrt{a^2 + b^2}", "sqrt(a**2 + b**2)"),
        (r"9.81 m_2 (a)(b)", "9.81*m2*a*b"),
        (r"2^{-1} a", "a/2"),
    ],
)
def test_means_the_same_as_the_text(latex, text):
    one, other = parse(expression(latex)), parse(text)
    rng = np.random.default_rng(1)
    names = set()
    for side in (one, other):
        names |= tree.names(side)
    meaning = {name: canonical(name) for name in names}
    one, other = tree.renamed(one, meaning), tree.renamed(other, meaning)
    assert tree.names(one) == tree.names(other)
    at = {name: rng.uniform(0.5, 2.0, 20) for name in sorted(tree.names(one))}
    np.testing.assert_allclose(tree.evaluate(one, at), tree.evaluate(other, at), rtol=1e-14)


@pytest.mark.parametrize(
    ("latex", "message"),
    [
        (r"\input{/etc/passwd}", "input' cannot be read"), (r"\dot m_1", "a dot over m"),
        ("a = b", "'='"), ("a +", "the end"), ("", "the end"), (")", "'\\)'"), ("é", "'é'"),
        (r"q_{\alpha}", "subscript"), ("a^b^c", "'\\^'"), (r"\sin", "the end"), ("(a", "expected"),
        ("9^{9^{9^{9}}}", "the power"), ("{" * 9000, "nested deeper"), ("x" * 20_001, "at most"),
        (r"\sqrt" * 3000, "nested deeper"), (r"\frac" * 3000, "nested deeper"),
        (r"\operatorname{x}", "cannot be read"), (r"\frac{a}", "the end"), ("x_{", "the end"),
    ],
)  # fmt: skip
def test_anything_else_is_refused_at_once(latex, message):
    start = time.process_time()
    with pytest.raises(ExpressionError, match=message):
        parse(expression(latex, "here"), "here")
    assert time.process_time() - start < 1.0


def test_in_a_file(tmp_path):
    file = tmp_path / "f.toml"
    text = "robot = 'planar2r'\n[latex]\ng2 = 'm_2 g l_2 \\cos(\\theta_1 + \\theta_2)'\n"
    file.write_text(text)
    assert examine_file(file)[0].agrees
    file.write_text(text.replace(r" + \theta_2", ""))
    found = examine_file(file)[0]
    assert r"\cos(\theta_1) should be \cos(\theta_1 + \theta_2)" in found.sentence  # the writer's
    file.write_text(text + "[formulas]\ng2 = 'm2'\n")
    with pytest.raises(FileError, match="'g2' is given twice"):
        examine_file(file)
    file.write_text(text.replace("'m_2 g", "'\\\\foo m_2 g"))
    with pytest.raises(ExpressionError, match="f.toml: g2: "):
        examine_file(file)
