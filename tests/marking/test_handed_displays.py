"""Submissions whose definitions stand in displays, and functions between fences of Markdown."""

from __future__ import annotations

import csv

import pytest

import kinlab as kl

SHEET = """
title = "Homework"
robot = "planar2r_rods"
feedback = "cause"
questions = [
  {id = "a1", entry = "M11"},
  {id = "a2", entry = "g1"},
  {id = "a3", entry = "L"},
]
"""
A, B, D = (
    r"a &= \tfrac13 m_1 l_1^2 + m_2 l_1^2",
    r"b &= \tfrac13 m_2 l_2^2",
    r"d &= \tfrac12 m_2 l_1 l_2",
)
T = (
    r"T &= \frac16 m_1 l_1^2 \dot q_1^2 + \frac12 m_2 l_1^2 \dot q_1^2"
    r" + \frac16 m_2 l_2^2 (\dot q_1+\dot q_2)^2"
    r" + \frac12 m_2 l_1 l_2 \cos q_2\,\dot q_1(\dot q_1+\dot q_2)"
)
V = (
    r"V &= \frac12 m_1 g l_1\sin q_1"
    r" + m_2 g\left(l_1\sin q_1 + \frac12 l_2\sin(q_1+q_2)\right)"
)
LATEX = rf"""\documentclass{{article}}
\begin{{document}}
\section*{{a1}}
We find $M_{{11}} = a + b + 2 d \cos q_2$ with
\begin{{align}}
 {A} \\
 {B} \\
 {D}
\end{{align}}
\section*{{a2}}
\begin{{align}}
 g_1 &= {{}} \left(\tfrac12 m_1 + m_2\right) g l_1 \cos q_1 \\
 &\quad + \tfrac12 m_2 g l_2 \cos(q_1+q_2)
\end{{align}}
\section*{{a3}}
The Lagrangian is $L = T - V$ where
\begin{{align*}}
{T}, \\
{V}.
\end{{align*}}
\end{{document}}
"""
MARKDOWN = rf"""## a1
$M_{{11}} = a + b + 2 d \cos q_2$ mit

$$\begin{{aligned}} {A} \\ {B} \\ {D} \end{{aligned}}$$

## a2
```python
def hold(q):
    q1, q2 = q
    out = (m1/2 + m2)*g*l1*np.cos(q1) + m2*g*l2/2*np.cos(q1 + q2)
    return out
```

## a3
$L = T - V$

$$\begin{{aligned}} {T} \\ {V} \end{{aligned}}$$
"""


@pytest.mark.parametrize(("name", "text"), [("ann.tex", LATEX), ("cy.md", MARKDOWN)])
@pytest.mark.parametrize("wrong", [False, True], ids=["right", "wrong"])
def test_displays_and_fences_are_read(name, text, wrong, tmp_path):
    if wrong:
        for old, new in (
            (r"\tfrac13 m_2 l_2^2", r"\tfrac13 m_2 l_1^2"),
            (r"\cos q_1 \\", r"\sin q_1 \\"),
            ("np.cos(q1) +", "np.sin(q1) +"),
            (r"\frac16 m_2", r"\frac12 m_2"),
        ):
            text = text.replace(old, new)
    sheet, folder = tmp_path / "sheet.toml", tmp_path / "handed"
    sheet.write_text(SHEET)
    folder.mkdir()
    who = "% student: ann\n" if name.endswith("tex") else "student: cy\n\n"
    (folder / name).write_text(who + text, encoding="utf-8")
    kl.mark(sheet, folder, tmp_path / "marks")
    with (tmp_path / "marks" / "marks.csv").open(encoding="utf-8-sig", newline="") as file:
        (row,) = csv.DictReader(file)
    asked = ("a1", "a2", "a3")
    assert [row[f"{one} verdict"] for one in asked] == ["wrong" if wrong else "right"] * 3, row
    assert row["note"] == "", row
