"""What stands in front of an answer in a text, and what of a text answers nothing."""

from __future__ import annotations

import pytest

import kinlab as kl
from kinlab.doctor.marking.reading.labels import SheetLabels
from kinlab.doctor.marking.reading.pieces import is_formula, is_no_answer
from kinlab.doctor.marking.sheet import sheet_of
from kinlab.doctor.marking.submission import read_submission

SHEET = {
    "robot": "planar2r",
    "feedback": "cause",
    "questions": [
        {"id": "q1", "entry": "x"},
        {"id": "q2", "entry": "g2"},
        {"id": "q3a", "entry": "M11"},
        {"id": "q3b", "answer": "-k*q1", "text": "A spring of stiffness k at joint 1."},
    ],
}
F = "l1*c1 + l2*c12"


def handed_in(folder, text, name="a.txt", sheet=SHEET):
    path = folder / name
    path.write_text(f"student: ada\n{text}\n", encoding="utf-8")
    return read_submission(path, sheet_of(sheet, "s"))


def marked(folder, text, name="a.txt", sheet=SHEET):
    (folder / name).write_text(f"student: ada\n{text}\n", encoding="utf-8")
    return kl.mark(sheet, folder, workers=1)["ada"]


@pytest.mark.parametrize(
    "label",
    [
        "q1: F", "Q1: F", "q1: x = F", "1: x = F", "1. x = F", "1) F", "q1) F", "q1. F", "(q1) F", "[q1] F",
        "q 1: F", "q01: F", "- q1: F", "* q1: F", "**q1**: F", "**q1:** $F$", "**q1** F", "q1:\nF", "q1\nF",
        "q1:\n\nx = F", "## q1\nF", "## q1\n$$x = F$$", "## Question 1\n$x = F$", "## Question 1 (2 points)\nx = F",
        "Question 1: x = F", "Aufgabe 1: x = F", "The answer to q1 is x = F", "q1：x = F", "题1：x = F", "第1题：x = F",
        "第一题：x = F", "（1）x = F", "1、x = F", "q1 -> F", "q1\tF", "`q1`: `F`", "| question | answer |\n|---|---|\n| q1 | F |",
        "| q1 | $x = F$ |", "q1: ~~l1*c1~~ F", "x = F", "**q1**\n\n- x = F", "## q1\n```\nF\n```", "q1: l1*c1\n + l2*c12",
    ],
)  # fmt: skip
def test_labels_in_front_of_an_answer(label, tmp_path):
    name = "a.md" if "#" in label or "|" in label or "`" in label else "a.txt"
    found = marked(tmp_path, label.replace("F", F), name)
    assert found["q1"].right, (found["q1"], found.note)
    assert "no question" not in found.note


@pytest.mark.parametrize(
    "line",
    [
        "(1)*l1", "0.4*c1", "1.5*c1", "2*l1", "q1*l1", "q12: F", "q1 + q2", "- q1 - l1", "Exercise 5", "1",
        "q1 is the angle", "Question 1 asks for x", "q1/2", "q1^2 + 3", "(q1)*l2",
    ],
)  # fmt: skip
def test_what_is_no_label(line):
    assert SheetLabels(sheet_of(SHEET, "s")).of(line) is None


def test_a_label_takes_nothing_of_the_formula():
    labels = SheetLabels(sheet_of(SHEET, "s"))
    for line in ("q1: - l1*s1", "(1) - l1*s1", "**q1**: - l1*s1", "1) - l1*s1"):
        assert labels.of(line).rest == "- l1*s1", line


def test_a_number_is_the_ids_or_the_place_on_the_sheet():
    labels = SheetLabels(sheet_of(SHEET, "s"))
    assert [labels.named(key).id for key in ("3a", "3B", "Exercise 3b", "2.")] == ["q3a", "q3b", "q3b", "q2"]  # fmt: skip
    assert labels.named("3") is None
    named = {**SHEET, "questions": [{"id": "reach", "entry": "x"}, {"id": "torque", "entry": "g2"}]}
    labels = SheetLabels(sheet_of(named, "s"))
    assert [labels.named(key).id for key in ("1", "第二题", "Torque")] == [
        "reach",
        "torque",
        "torque",
    ]


@pytest.mark.parametrize("line", [f"q1 = {F}", f"q1 - {F.replace('+', '+')}", f"$q_1 = {F}$"])
def test_q1_equals_is_the_label_where_nothing_else_answers(line, tmp_path):
    found = marked(tmp_path, line)
    assert found["q1"].right and "q1 = ... was taken as the answer to q1" in found.note
    found = marked(tmp_path, f"q1 = 0\nx = {F}")
    assert found["q1"].right and "1 line answers no question: q1" in found.note


def test_what_stands_below_a_label_is_the_labels(tmp_path):
    text = (
        "## 3b\nThe spring turns back.\n$\\tau = -k \\theta_1$\n"
        f"## 1\nx = {F}\n## 2\nx = 3\n## Notes 7\nl1*c1\n"
    )
    found = marked(tmp_path, text, "a.md")
    assert found["q3b"].right and found["q1"].right
    assert found["q2"].verdict == "no answer"
    assert "2 lines answer no question: x, l1*c1" in found.note
    assert found.aside == "1 line of words"
    found = marked(tmp_path, "## 1\nh = l1*c1\nh + l2*c12\n## 2\ng1 = 3\nm2*g*l2*c12\n", "a.md")
    assert found["q1"].right and found["q2"].right, found


TEX = r"""\documentclass{article}
\author{Eve Adams}
% student: ada
\begin{document}
\section*{Aufgabe 1}
We have $h = l_1 c_1$ and then $x = h + l_2 c_{12}$.
\textbf{q2} \[ m_2 g l_2 c_{12} \]
\paragraph{3b} $\tau_1 = -k\theta_1$
\section*{3a} $q_2 = 0$
\end{document}
"""


def test_labels_in_latex(tmp_path):
    found = marked(tmp_path, TEX, "a.tex")
    assert [found[k].right for k in ("q1", "q2", "q3b")] == [True, True, True], found
    assert found.name == "Eve Adams" and found["q3a"].verdict != "right"
    items = r"\begin{enumerate}\item $x = l_1 c_1 + l_2 c_{12}$ \item $m_2 g l_2 c_{12}$ \item $(m_1+m_2) l_1^2 + m_2 l_2^2 + 2 m_2 l_1 l_2 c_2$ \item $-k q_1$ \end{enumerate}"
    assert marked(tmp_path, items, "a.tex").total == 4.0
    open_ended = "q1: \\begin{align} x &= l_1 c_1 + l_2 c_{12}\nq2: $m_2 g l_2 c_{12}$\n"
    assert marked(tmp_path, open_ended, "a.tex").total == 2.0


def test_keys_of_toml_may_be_labels(tmp_path):
    text = "1 = 'l1*c1 + l2*c12'\n'2.' = 'm2*g*l2*c12'\nAufgabe3b = 'e = -k*q1'\nq9 = '3'\n"
    (tmp_path / "a.toml").write_text(f"student = 'ada'\n{text}")
    found = kl.mark(SHEET, tmp_path, workers=1)["ada"]
    assert [found[k].right for k in ("q1", "q2", "q3b")] == [True, True, True]
    assert found.note == "1 line answers no question: q9"


def test_nothing_is_dropped_without_a_word(tmp_path):
    lines = "".join(f"a{k} = {k}\n" for k in range(9)) + "q9) l1*c1\nsome words here\n"
    found = marked(tmp_path, lines)
    assert found.note == "10 lines answer no question: a0, a1, a2, a3, a4, a5, ..."
    assert found.aside == "1 line of words"
    out = tmp_path / "out"
    kl.mark(SHEET, tmp_path, out, workers=1)
    assert "10 lines answer no question" in (out / "class.html").read_text(encoding="utf-8")
    long = handed_in(tmp_path, "word and word\n" * 3000)
    assert "only the first 2000 lines are read" in long.aside


@pytest.mark.parametrize(
    "text",
    ["I don't know", "i do not know.", "?", "-", "--", "TODO", "weiß nicht", "Weiß ich nicht!", "keine Ahnung",
     "不会", "不知道。", "n/a", "...", "(no answer)", "", "???", "我不会做"],
)  # fmt: skip
def test_what_says_that_there_is_no_answer(text, tmp_path):
    assert is_no_answer(text)
    found = marked(tmp_path, f"q1: {text}\nq2: m2*g*l2*c12")
    assert found["q1"].verdict == "no answer"
    assert "no question" not in found.note


@pytest.mark.parametrize("text", ["0", "-1", "n", "l1", "no*a", "x = ?", "2.5", "I1", "-q1"])
def test_what_is_an_answer(text):
    assert not is_no_answer(text)


def test_formulas_and_sentences():
    assert all(map(is_formula, ["l1*c1 + l2*c12", r"\frac{1}{2} m l^2", "1.15", "-sin(theta1)"]))
    assert not any(map(is_formula, ["see the next page 3", "so it goes", "由上式求导 2", "x"]))


def test_a_student_may_be_named_in_many_ways(tmp_path):
    ways = {
        "学生：李四": "李四",
        "**student**: Rui G": "Rui G",
        "学号: 12": "12",
        "# Student: Eve": "Eve",
    }
    for line, who in ways.items():
        (tmp_path / "b.md").write_text(f"{line}\nq1: {F}\n", encoding="utf-8")
        assert read_submission(tmp_path / "b.md", sheet_of(SHEET, "s")).student == who


@pytest.mark.parametrize("text", [" " * 200_000, "|" * 200_000, "#" * 100_000 + "1", "$" * 90_000,
                                  "- " * 90_000, "(" * 200_000 + "q1", "\\begin{" * 30_000, "`" * 90_000,
                                  "q1: " + "$a" * 60_000, "~~a" * 60_000, "**q1" * 50_000])  # fmt: skip
def test_hostile_texts_take_no_time(text, tmp_path):
    import time

    begun = time.process_time()
    for name in ("a.txt", "a.tex"):
        (tmp_path / name).write_text(text)
        kl.mark(SHEET, tmp_path, workers=1)
        (tmp_path / name).unlink()
    assert time.process_time() - begun < 10.0


def test_own_commands_of_latex_are_written_out(tmp_path):
    text = (
        "\\newcommand{\\dd}{\\ddot\\theta}\n\\def\\la{l_1}\n\\newcommand{\\vect}[1]{\\mathbf{#1}}\n"
        "\\begin{document} q1: $x = \\la c_1 + l_2 c_{12}$ \\lambda \\end{document}"
    )
    assert marked(tmp_path, text, "a.tex")["q1"].right
    bomb = "".join(
        f"\\def\\{a}{{{b * 50}}}\n" for a, b in (("a", "\\b"), ("b", "\\c"), ("c", "\\d"))
    )
    kl.mark(SHEET, [_written(tmp_path / "b.tex", bomb + "\\a " * 2000 + "$x = l_1$")], workers=1)


def _written(path, text):
    path.write_text(text)
    return path
