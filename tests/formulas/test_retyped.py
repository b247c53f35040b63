r"""A correction is the writer's own line: LaTeX in his macros, MATLAB with q(2), Python with q[1]."""

from __future__ import annotations

import numpy as np
import pytest

from kinlab.doctor.report import of_document
from kinlab.formulas.evaluate import plain_values
from kinlab.formulas.text import tidied
from kinlab.formulas.typed import hand, plain_formula


def told(entry, text, robot="planar2r", **more):
    (found, *_), unread = of_document({"robot": robot, "formulas": {entry: text, **more}}, "f", 40)
    assert not unread
    assert not found.agrees
    return found.causes[0]


LINES = [
    (
        "tau2",
        r"$\tau_2 = m_2 l_1 l_2 c_2 \ddot\theta_1 + m_2 l_1 l_2 s_2 \dot\theta_1"
        r" + m_2 l_2 g c_{12} + m_2 l_2^2 (\ddot\theta_1 + \ddot\theta_2)$",
        (r"\dot\theta_1 +", r"\dot\theta_1^2 +"),
    ),
    ("M12", r"m_2 l_2^2 + m_2 l_1 l_2 \sin\theta_2", (r"\sin", r"\cos")),
    ("M11", r"\left(m_1+m_2\right) l_1 + m_2 l_2^{2} + 2 m_2 l_1 l_2 c_2", ("l_1 +", "l_1^2 +")),
    ("M11", r"(m_1+m_2)\,l_1^2 + m_2 l_2^2 + m_2 l_1 l_2 \cos\theta_2", ("+ m_2 l_1", "+ 2 m_2 l_1")),
    ("V", r"m_1 g l_1 \sin q_1 + m_2 g ( l_1 \sin q_1 + l_2 \sin q_2 )", (r"\sin q_2", r"\sin(q_1 + q_2)")),
    (
        "T",
        r"\frac12 (m_1+m_2) l_1^2 \dot{q}_1 + \frac{1}{2} m_2 l_2^2 (\dot{q}_1+\dot{q}_2)^2"
        r" + m_2 l_1 l_2 \cos(q_2) \dot{q}_1 (\dot{q}_1+\dot{q}_2)",
        (r"\dot{q}_1 + \frac", r"\dot{q}_1^2 + \frac"),
    ),
    ("M11", "m1*l1^2 + m2*(l1^2 + l2^2 + l1*l2*cos(q(2)))", ("+ l1*l2", "+ 2*l1*l2")),
    ("J11", "-l1*sin(q(1)) - l2*sin(q(2))", ("sin(q(2))", "sin(q(1) + q(2))")),
    ("J11", "-l1*np.sin(q[0]) - l2*np.sin(q[1])", ("np.sin(q[1])", "np.sin(q[0] + q[1])")),
    ("C11", "m2*l1*l2*np.sin(q[1])*qd[0]*-1", ("qd[0]", "qd[1]")),
    ("M12", "m₂l₂² + m₂ l₁ l₂ sin θ₂", ("sin", "cos")),
    ("M22", "m₂ l₂", ("l₂", "l₂²")),
    ("V", "-(m1+m2)*g*l1*s1 - m2*g*l2*s12", ("-(m1+m2)*g*l1*s1 - ", "(m1+m2)*g*l1*s1 + ")),
    ("g2", "-m2*g*l2*cos(q1+q2)", ("-m2", "m2")),
    ("g2", "m2*9.8*l2*c2", ("c2", "c12")),
    ("J11", "-l1*s1-l2*s12-l2*s2", ("-l2*s2", "")),
    ("M22", "m2*l2**2/2", ("/2", "")),
    ("M22", "2*m2*l2**2", ("2*m2", "m2")),
]  # fmt: skip


@pytest.mark.parametrize(("entry", "text", "change"), LINES)
def test_the_line_is_the_writers_with_the_least_edit(entry, text, change):
    cause = told(entry, text)
    line = text.strip("$").rpartition(r"\tau_2 =")[2].strip()
    at = line.rindex(change[0])
    assert cause.shown[entry] == line[:at] + change[1] + line[at + len(change[0]) :]
    assert not any(sign in cause.shown[entry] for sign in ("--", "-(-", "*1*"))


@pytest.mark.parametrize(("entry", "text", "change"), LINES[:12])
def test_the_line_reads_as_the_corrected_formula(entry, text, change):
    """By the readers, not by the doctor: the values of the line at any numbers."""
    cause = told(entry, text)

    def values(line):
        read = tidied(plain_formula(line, entry, hand([text, line])))
        names = lambda name: np.random.default_rng([ord(c) for c in name]).uniform(1, 2, 5)  # noqa: E731
        return plain_values(read, names, 5)

    assert np.allclose(values(cause.shown[entry]), values(cause.corrected[entry]), rtol=1e-12)


def test_the_sentence_speaks_the_writers_language():
    cause = told("M12", r"m_2 l_2^2 + m_2 l_1 l_2 \sin\theta_2")
    assert r"\sin\theta_2 should be \cos\theta_2 in m_2 l_1 l_2 \sin\theta_2" in cause.sentence
    cause = told("J11", "-l1*sin(q(1)) + l2*sin(q(1)+q(2))")
    assert "+ l2*sin(q(1)+q(2)) should be - l2*sin(q(1)+q(2))" in cause.sentence


def test_a_matrix_of_latex_is_corrected_by_entry():
    grid = (
        r"\begin{bmatrix} (m_1+m_2) l_1^2 + m_2 l_2^2 + 2 m_2 l_1 l_2 c_2 &"
        r" m_2 l_2^2 + m_2 l_1 l_2 s_2 \\ m_2 l_2^2 + m_2 l_1 l_2 c_2 & m_2 l_2^2 \end{bmatrix}"
    )
    assert told("M", grid).shown == {"M12": "m_2 l_2^2 + m_2 l_1 l_2 c_2"}


def test_a_factor_is_put_in_front_as_the_writer_types_products():
    for text in ("(m1+m2)*l1^2 + m2*l2^2 + m2*l1*l2*c2", "(m1 + m2) l1^2 + m2 l2^2 + m2 l1 l2 c2"):
        document = {"robot": "planar2r", "formulas": {"M11": text}}
        (found,), _unread = of_document(document, "f.toml")
        right = text.replace("+ m2*l1", "+ 2*m2*l1").replace("+ m2 l1", "+ 2 m2 l1")
        assert found.causes[0].shown == {"M11": right}


def test_plain_products_stay_plain():
    text = "l_1 sin(theta_1) + l_2 cos(theta_1 + theta_2)"
    document = {"robot": "planar2r", "formulas": {"y": text, "g2": "m_2 g l_2 s_12"}}
    found, _unread = of_document(document, "f.toml")
    assert found[0].causes[0].shown == {"y": text.replace("cos", "sin")}
    assert found[1].causes[0].shown == {"g2": "m_2 g l_2 c_12"}
