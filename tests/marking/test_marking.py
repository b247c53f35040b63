"""A class marked: verdicts and points, hostile submissions, order, resumption, no leaks."""

from __future__ import annotations

import csv
import io
import json
import os
import random
import re

import pytest
import sympy

import kinlab as kl
from kinlab.doctor.marking import run
from kinlab.doctor.marking.marks import slug_of
from kinlab.doctor.marking.program import judge_program
from kinlab.doctor.marking.results import as_csv, gradescope
from kinlab.doctor.marking.sheet import sheet_of
from kinlab.doctor.marking.submission import Submission, read_submission
from kinlab.errors import FileError

G1 = "(m1+m2)*g*l1*c1 + m2*g*l2*c12"
M = "[(m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*c2, m2*l2^2 + m2*l1*l2*c2; m2*l2^2 + m2*l1*l2*c2, m2*l2^2]"
SHEET = {
    "title": "Homework",
    "robot": "planar2r",
    "feedback": "cause",
    "slips": {"sign": 0.25},
    "questions": [
        {"id": "q1", "entry": "x", "points": 2},
        {"id": "q2", "entry": "g1", "points": 4, "slips": {"index": 0.5}},
        {"id": "q3", "quantity": "mass_matrix", "points": 3},
        {"id": "q4", "answer": "m1*g*l1*sin(q1)", "points": 1},
    ],
}
RIGHT = {"q1": "l1*c1 + l2*c12", "q2": G1, "q3": M, "q4": "g*sin(q1)*m1*l1"}


def marked(answers, feedback=None, **changes):
    return kl.mark({**SHEET, **changes}, {"ada": answers}, feedback=feedback)["ada"]


def test_right_answers_get_all_points():
    found = marked(RIGHT)
    assert [one.verdict for one in found.outcomes] == ["right"] * 4
    assert found.total == found.of == 10.0


@pytest.mark.parametrize(
    ("question", "answer", "verdict", "points", "place", "cause"),
    [
        ("q1", "l1*c1 - l2*c12", "wrong", 1.5, "x: look at -l2*c12", "a sign is the other way"),
        ("q2", "(m1+m2)*g*l1*c1 + m2*g*l1*c12", "wrong", 2.0, "g1: look at l1", "an index is off"),
        ("q2", "(m1+m2)*g*l1*c1", "wrong", 0.0, "g1", "a term is missing"),
        ("q4", "-m1*g*l1*sin(q1)", "wrong", 0.75, "the formula as a whole", "a sign is the other way"),
        ("q4", "m1*g*l1", "wrong", 0.0, "q4", "a factor is missing"),
        ("q1", "l1*c1 + l2*c_{12", "could not be read", 0.0, "", ""), ("q1", "", "no answer", 0.0, "", ""),
        ("q1", "y = l1*c1", "could not be read", 0.0, "", ""), ("q3", "M11 = m2", "wrong", 0.0, None, None),
        ("q2", r"$g_1 = (m_1+m_2) g l_1 \cos\theta_1 + m_2 g l_2 \cos(\theta_1+\theta_2)$", "right", 4.0, "", ""),
        ("q1", "x = l1*np.cos(q[0]) + l2*np.cos(q[0]+q[1])", "right", 2.0, "", ""),
    ],
)  # fmt: skip
def test_points_place_and_cause(question, answer, verdict, points, place, cause):
    found = marked({question: answer})[question]
    assert (found.verdict, found.points) == (verdict, points)
    if place is not None:
        assert (found.place, found.cause) == (place, cause)


@pytest.mark.parametrize(
    ("robot", "entry", "text", "verdict", "place"),
    [
        ("planar2r_rods", "g2", "m2*g*l2*c12", "wrong", "g2"),  # the right one has a name of its own
        ("planar2r_rods", "g2", "m2*g*lc2*s12", "wrong", "g2: look at s12"),
        ("scara", "T34", "d1 + d3", "wrong", "T34: look at d3"),
        ("scara", "J", "[-a1*s1-a2*s12, -a2*s12, 0, 0; a1*c1+a2*c12, a2*c12, 0, 0; 0, 0, -1, 0; 1, 1, 0, -1]", "right", ""),
        ("scara", "J", "[-a1*s1-a2*s12, -a2*s12, 0, 0; a1*c1+a2*c12, a2*c12, 0, 0; 0, 0, 1, 0; 1, 1, 0, -1]", "wrong", "J33"),
        ("planar2r", "g", f"g1 = {G1} and g2 = m2*g*l2*c12", "right", ""),
    ],
)  # fmt: skip
def test_other_names_and_shapes(robot, entry, text, verdict, place):
    sheet = {"title": "t", "robot": robot, "feedback": "cause", "questions": [{"id": "k", "entry": entry}]}  # fmt: skip
    found = kl.mark(sheet, {"ada": {"k": text}})["ada"]["k"]
    assert (found.verdict, found.place) == (verdict, place), found.remark


def test_words_that_were_not_read_cost_no_point_as_a_slip():
    found = marked({"q1": "for the stretched arm: x = l1 + l2", "q2": f"Hence g1 = {G1}"})
    assert found["q1"].verdict == "could not be read" and "stretched arm" in found["q1"].remark
    assert found["q2"].verdict == "right"
    assert "has a slip" not in found["q1"].remark  # nor what it would be without them
    lost = marked({"q2": "Model solution, exercise 4.2: g1 = (m1+m2)*g*l1*c1"}, "place")["q2"]
    assert lost.verdict == "could not be read" and "l2" not in lost.remark, lost.remark
    own = marked({"q4": "for the stretched arm q4 = m1*g*l1"})["q4"]
    assert own.verdict == "could not be read" and "stretched arm" in own.remark


def test_levels_of_feedback():
    slip = {"q1": "l1*c1 - l2*c12"}
    told = {level: marked(slip, level)["q1"] for level in ("verdict", "place", "cause", "answer")}
    assert not told["verdict"].place and not told["verdict"].cause
    assert r"\wrong" not in str(told["verdict"].formulas)
    assert told["place"].place and not told["place"].cause
    assert told["cause"].cause and not told["cause"].answer
    assert any("l2*c12" in text or "l2*cos(q1 + q2)" in text for text in told["answer"].answer)
    assert len({one.points for one in told.values()}) == 1


def test_numbers_of_each_student():
    sheet = sheet_of({**SHEET, "variation": {"seed": 1, "names": ["l1", "l2"]}}, "s")
    from kinlab.doctor.marking.variation import numbers_for

    ada, bob = numbers_for(sheet, "ada"), numbers_for(sheet, "bob")
    own = {"q1": f"{ada['l1']}*c1 + {ada['l2']}*c12"}
    marks = kl.mark(sheet, {"ada": own, "bob": own, "eve": {"q1": "l1*c1 + l2*c12"}})
    assert ada["l1"] != bob["l1"]
    assert [marks[who]["q1"].right for who in ("ada", "bob", "eve")] == [True, False, True]


TEX = r"""\documentclass{article}
% student: bob
\begin{document}
The tool is at $x = l_1 c_1 + l_2 c_{12}$, and
\begin{align}
 g_1 &= (m_1 + m_2) g l_1 \cos\theta_1 \\  % two lines
     &+ m_2 g l_2 \cos(\theta_1 + \theta_2) \\
 M_{11} &= (m_1 + m_2) l_1^2 + m_2 l_2^2 + 2 m_2 l_1 l_2 c_2
\end{align}
\[ M_{12} = m_2 l_2^2 + m_2 l_1 l_2 c_2, \] \[ M_{22} = m_2 l_2^2. \]
\end{document}
"""


def test_latex_and_text(tmp_path):
    sheet = sheet_of(SHEET, "s")
    (tmp_path / "a.tex").write_text(TEX)
    (tmp_path / "b.txt").write_text(
        f"student: eve\nname: Eve\n\nx = l1*c1\n + l2*c12\nq2: {G1}\nM = {M}\n"
    )
    marks = kl.mark(sheet, tmp_path, workers=1)
    assert [(m.student, m.total) for m in marks.marks] == [("bob", 9.0), ("eve", 9.0)]
    assert marks["eve"].name == "Eve"
    assert marks["bob"]["q3"].right
    twice = tmp_path / "c.txt"
    twice.write_text("x = l1\nx = l2\n")
    assert "twice" in read_submission(twice, sheet).problems["q1"]


def test_a_broken_line_of_a_submission_costs_itself(tmp_path):
    sheet = sheet_of(SHEET, "s")
    lines = ['student = "eve"', 'q1 = "l1"', 'q1 = "l1*c1 + l2*c12"', f'q2 = "{G1}"', "so easy"]
    (tmp_path / "a.toml").write_text("\n".join(lines))
    found = read_submission(tmp_path / "a.toml", sheet)
    assert (found.student, set(found.answers)) == ("eve", {"q2"})
    assert found.problems == {"q1": "q1 is given twice, in lines 2 and 3; keep one"}
    assert "line 5: 'so easy' is no entry" in found.note
    assert kl.mark(sheet, tmp_path, workers=1)["eve"]["q2"].right
    (tmp_path / "a.toml").write_text("so easy\n")
    with pytest.raises(FileError, match="line 1: 'so easy' is no entry"):
        read_submission(tmp_path / "a.toml", sheet)


HOSTILE = {
    "bomb.toml": 'student = "bomb"\nq1 = "9**9**9**9"\nq2 = "9**(9**(9**9))"\n', "deep.txt": "q1: " + "(" * 90_000,
    "open.toml": "q1 = " + "[" * 50_000, "binary.txt": b"\xff\xfe\x00q1", "huge.txt": b"a" * 400_000,
    "<img src=x onerror=alert(1)>.txt": "q1: l1*c1 + l2*c12", "empty.txt": "", "loop.py": "while True: pass",
    "name.toml": 'student = "=cmd|calc"\nname = "<script>alert(1)</script>"\nq1 = "<b>l1</b>"\n',
    "expo.toml": 'student = "expo"\nq1 = "a0"\n[symbols]\n' + "".join(f'a{i} = "a{i+1}*a{i+1}"\n' for i in range(60)) + 'a60 = "q1"\n',
    "round.toml": 'student = "round"\nq4 = "a"\n[symbols]\na = "b"\nb = "a"\n', "odd.toml": "student = true\nq1 = [1, 2]\nq2 = 3\nq3 = 1979-05-27\n",
    "same.txt": "student: GOOD\nq1: l1*c1 + l2*c12", "long.txt": "q1: " + "+".join(["cos(q1)"] * 1500),
    "tex.tex": r"\begin{align}" * 3000 + "$" * 3001 + "q_1 = " + r"\sqrt" * 5000,
}  # fmt: skip


def hostile(folder):
    for name, content in HOSTILE.items():
        data = content if isinstance(content, bytes) else content.encode()
        (folder / name).write_bytes(data)
    (folder / "link.txt").symlink_to("/etc/hostname")
    (folder / "ring").symlink_to(folder)
    os.mkfifo(folder / "pipe.txt")
    good = "".join(f"{key} = '{value}'\n" for key, value in RIGHT.items())
    (folder / "good.toml").write_text(f"student = 'good'\n{good}")


def test_one_hostile_submission_costs_only_itself(tmp_path):
    folder, out = tmp_path / "in", tmp_path / "out"
    folder.mkdir()
    hostile(folder)
    marks = kl.mark(SHEET, folder, out, workers=1)
    assert len(marks) == len(HOSTILE) + 2
    by_file = {m.file: m for m in marks.marks}
    assert by_file["good.toml, same.txt"].total == 10.0
    assert by_file["<img src=x onerror=alert(1)>.txt"].total == 2.0
    others = [m for f, m in by_file.items() if f != "good.toml, same.txt" and "img" not in f]
    assert all(m.total == 0 for m in others)
    note = by_file["good.toml, same.txt"].note
    assert "handed in 2 times: good.toml, same.txt; q1 is answered in good" in note
    assert "link" in by_file["link.txt"]["q1"].remark
    assert "run only with --run-python" in by_file["loop.py"]["q1"].remark
    for page in out.rglob("*.html"):
        text = page.read_text()
        assert "<script" not in text and "<img" not in text and "<b>l1" not in text
    rows = list(csv.reader(io.StringIO((out / "marks.csv").read_text(encoding="utf-8-sig"))))
    assert not any(cell.startswith(("=", "+", "-", "@")) for row in rows for cell in row)
    assert len(list((out / "results").iterdir())) == len(marks)


def test_any_order_and_any_number_of_workers(tmp_path):
    folder = tmp_path / "in"
    folder.mkdir()
    hostile(folder)
    one = kl.mark(SHEET, folder, workers=1)
    paths = [path for path in folder.iterdir() if path.suffix]
    random.Random(4).shuffle(paths)
    two = kl.mark(SHEET, paths, workers=2)
    assert as_csv(one) == as_csv(two)


def test_a_worker_that_dies_or_hangs_loses_one_submission(tmp_path, monkeypatch):
    for who in ("a", "b", "c", "d"):
        (tmp_path / f"{who}.txt").write_text(f"student: {who}\nq1: l1*c1 + l2*c12\n")
    real = run.read_submission

    def read(path, *rest):
        if path.stem == "b":
            os._exit(7)
        while path.stem == "c":
            pass
        return real(path, *rest)

    monkeypatch.setattr(run, "read_submission", read)
    monkeypatch.setattr(run, "SECONDS", 1.0)
    marks = kl.mark(SHEET, tmp_path, workers=2)
    assert [m.total for m in marks.marks] == [2.0, 0.0, 0.0, 2.0]
    assert "ended the process" in marks["b"]["q1"].remark
    assert "took longer than 1 s" in marks["c"]["q1"].remark


def test_a_run_that_was_stopped_goes_on(tmp_path, monkeypatch):
    folder, out = tmp_path / "in", tmp_path / "out"
    folder.mkdir()
    for k in range(4):
        (folder / f"s{k}.txt").write_text(f"q1: {k}*l1*c1 + l2*c12\n")

    def stop(done, total, name):
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        kl.mark(SHEET, folder, out, workers=1, progress=stop)
    assert not (out / "marks.csv").exists()
    (folder / "s0.txt").write_text("q1: l1*c1 + l2*c12\n")  # handed in anew
    seen = []
    again = kl.mark(
        SHEET, folder, out, workers=1, progress=lambda done, total, name: seen.append(name)
    )
    assert seen == ["s0.txt", "s2.txt", "s3.txt"]
    assert as_csv(again) == as_csv(kl.mark(SHEET, folder, workers=1))
    changed = {**SHEET, "slips": {"factor": 0.1}}
    assert as_csv(kl.mark(changed, folder, out, workers=1)) == as_csv(
        kl.mark(changed, folder, workers=1)
    )


def test_results_as_gradescope_reads_them():
    marks = kl.mark(SHEET, {"ada": {**RIGHT, "q1": "l1*c1 - l2*c12"}})
    result = json.loads(json.dumps(gradescope(marks, marks["ada"])))
    assert result["score"] == 9.5 == sum(test["score"] for test in result["tests"])
    assert [test["max_score"] for test in result["tests"]] == [2, 4, 3, 1]
    assert [test["status"] for test in result["tests"]] == ["failed", "passed", "passed", "passed"]
    assert result["tests"][0]["output"].startswith("Wrong.\nPlace: x: look at -l2*c12.")
    assert {"name", "number", "output_format", "visibility"} <= result["tests"][0].keys()


@pytest.mark.parametrize(
    "start", ["=", "+", "-", "@", "|", "%", "＝", "＋", "－", "＠", " =", "\t="]
)
def test_no_cell_begins_as_a_formula(start):
    marks = kl.mark(SHEET, {f"{start}1+1": {}})
    assert list(csv.reader(io.StringIO(as_csv(marks))))[1][0][0] == "'"


def test_names_of_files():
    names = ["a.toml", "a.txt", "A b.toml", "a/b.toml", "a-b.toml", "ä.toml", "..toml", "x" * 300]
    slugs = [slug_of(name) for name in names]
    assert len({slug.casefold() for slug in slugs}) == len(names)
    assert all(re.fullmatch(r"[A-Za-z0-9_-]{1,64}", slug) for slug in slugs)


# -------- Leaks


def mutated(rng, formula: str) -> str:
    """A formula with one to three slips of the pen, by text: none of them from the doctor."""
    swaps = [
        ("+", "-"),
        ("-", "+"),
        ("c12", "c1"),
        ("c1", "s1"),
        ("l2", "l1"),
        ("m2", "m1"),
        ("^2", ""),
        ("2*", ""),
        ("g*", ""),
    ]
    for _ in range(rng.randrange(1, 4)):
        old, new = rng.choice(swaps)
        found = [m.start() for m in re.finditer(re.escape(old), formula)]
        if found:
            at = rng.choice(found)
            formula = formula[:at] + new + formula[at + len(old) :]
    return formula


def forms_of(right: str) -> set[str]:
    """How a right formula may stand somewhere: as typed, and as the engine and sympy write it."""
    names = {n: sympy.Symbol(n) for n in "m1 m2 l1 l2 g q1 q2".split()}
    long = re.sub(
        r"\b([cs])(\d+)",
        lambda m: f"{'cos' if m[1] == 'c' else 'sin'}({'+'.join('q' + d for d in m[2])})",
        right,
    )
    value = sympy.sympify(long.replace("^", "**"), locals=names)
    texts = {
        right,
        long,
        str(value),
        str(sympy.expand(value)),
        sympy.latex(value),
        sympy.latex(sympy.expand(value)),
    }
    return {bare(text) for text in texts}


def bare(text: str) -> str:
    return re.sub(r"[\s{}\\]|left|right", "", text).replace("**", "^")


def leaks(level: str, runs: int, seed: int, folder) -> int:
    """How many of the runs wrote the right formula somewhere that the student did not write."""
    rng = random.Random(seed)
    truths = {k: v for k, v in RIGHT.items() if k != "q3"}
    secrets = {key: forms_of(value) for key, value in truths.items()}
    found = 0
    submissions = {
        f"s{k}": {key: mutated(rng, value) for key, value in truths.items()} for k in range(runs)
    }
    marks = kl.mark(SHEET, submissions, folder, feedback=level)
    common = [bare((folder / name).read_text()) for name in ("marks.csv", "class.html")]
    for who, given in submissions.items():
        mark = marks[who]
        outputs = [p.read_text() for p in folder.rglob(f"{mark.slug}.*")]
        outputs = [
            bare(text) for text in (*outputs, str(mark), json.dumps(gradescope(marks, mark)))
        ]
        for key, forms in secrets.items():
            if mark[key].right:
                continue
            own = bare(given[key])
            hidden = [form for form in forms if form not in own]
            found += any(form in text for form in hidden for text in (*outputs, *common))
    return found


@pytest.mark.parametrize("level", ["place", "cause"])
def test_no_right_formula_leaks(level, tmp_path):
    assert leaks(level, 8, 5, tmp_path) == 0


@pytest.mark.campaign
@pytest.mark.parametrize("level", ["place", "cause"])
def test_no_right_formula_leaks_in_a_thousand_runs(level, tmp_path):
    assert leaks(level, 500, 6, tmp_path) == 0


def test_the_leak_is_seen_where_answers_are_told(tmp_path):
    assert leaks("answer", 4, 5, tmp_path) > 0


# -------- Programs

PROGRAM = """
import numpy as np
l1, l2, m1, m2, g = 0.5, 0.4, 2, 1.5, 9.81
def q1(q):
    return l1*np.cos(q[0]) + l2*np.cos(q[0] + q[1])
def g1(q):
    return -(m1+m2)*g*l1*np.cos(q[0]) - m2*g*l2*np.cos(q[0] + q[1])
"""


def test_a_program_is_judged():
    sheet = sheet_of(SHEET, "s")
    outcomes, enforced = judge_program(sheet, Submission("a.py", "ada", program=PROGRAM), "cause")
    assert [one.verdict for one in outcomes] == ["right", "wrong", "no answer", "no answer"]
    assert "sign" in outcomes[1].cause
    assert [one.remark for one in outcomes[2:]] == [
        "no function is called q3, mass_matrix; there are: q1, g1",
        'no function is asked for this; write a line q4 = "formula", or hand in a second file, '
        "such as a.txt, with the line q4: formula",
    ]
    assert "memory" in enforced and "processor time" in enforced


@pytest.mark.parametrize(
    ("program", "message"),
    [
        ("open('/etc/passwd').read()", "may not read files"), ("open('x', 'w').write('a')", "may not write files"),
        ("import socket", "may not import socket"), ("import kinlab", "may not import kinlab"),
        ("import os\nos.fork()", "may not use os.fork"), ("x = [0]*10**10", "MemoryError"), ("import os\nos._exit(3)", "exit code 3"),
        ("def q1(:", "SyntaxError"), ("raise SystemExit", "SystemExit"),
    ],
)  # fmt: skip
def test_a_hostile_program_costs_only_itself(program, message):
    sheet = sheet_of(SHEET, "s")
    outcomes, _ = judge_program(sheet, Submission("a.py", "ada", program=program), "cause")
    assert message in outcomes[0].remark
    assert all(one.points == 0 for one in outcomes)


def test_an_endless_program_is_ended(monkeypatch):
    monkeypatch.setattr("kinlab.doctor.marking.program.SECONDS", 1.0)
    sheet = sheet_of(SHEET, "s")
    outcomes, enforced = judge_program(
        sheet, Submission("a.py", "ada", program="while 1: pass"), "cause"
    )
    assert "signal" in outcomes[0].remark or "did not come back" in outcomes[0].remark
    assert "processor time" in enforced


READS = """
import readline
readline.read_history_file({path!r})
raise ValueError(readline.get_history_item(1))
"""
LIBRARY = "import xml.etree.ElementTree\nimport math\ndef q1(q): return .5*math.cos(q[0]) + .4*math.cos(q[0] + q[1])"


def test_what_a_program_reads_is_bounded_by_the_system(tmp_path):
    """The audit hook does not see what a library in C opens."""
    other = tmp_path / "other.txt"
    other.write_text("q1: l1*c1\n")
    sheet = sheet_of(SHEET, "s")
    program = Submission("a.py", "ada", program=READS.format(path=str(other)))
    outcomes, enforced = judge_program(sheet, program, "cause")
    assert outcomes[0].verdict == "could not be read"
    assert "Permission denied" in outcomes[0].remark or "files read" not in enforced
    found, _ = judge_program(sheet, Submission("b.py", "bob", program=LIBRARY), "cause")
    assert found[0].right


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [
        ("g*((m1 + m2)*l1 + m2*l2)", "right"), ("23.0535", "right"), ("23.05", "right with rounded numbers"),
        ("9.8*((m1 + m2)*l1 + m2*l2)", "right with rounded numbers"), ("23.06", "wrong"), ("24", "wrong"),
        ("23.1", "right with rounded numbers"), ("23", "right with rounded numbers"), ("23.0", "wrong"),
        ("9.7*((m1 + m2)*l1 + m2*l2)", "wrong"), ("(2.1 + m2)*g*l1 + m2*g*l2", "wrong"),
    ],
)  # fmt: skip
def test_an_own_model_answer_is_met_to_the_digits_written(answer, verdict):
    question = {
        "id": "q1",
        "entry": "F",
        "answer": "(m1 + m2)*g*l1 + m2*g*l2",
        "slips": {"factor": 1},
    }
    found = marked({"q1": answer}, questions=[question], slips={"rounded": 0.25})["q1"]
    assert (found.verdict, found.points) == (
        verdict,
        {"right": 1.0, "wrong": 0.0}.get(verdict, 0.75),
    )
    assert "23.0535" not in found.remark


def test_an_entry_may_be_called_by_its_letter():
    question = {"id": "q1", "quantity": "jacobian[0,0]"}
    assert marked({"q1": "J11 = -l1*s1 - l2*s12"}, questions=[question])["q1"].right
    assert (
        "asks for J11" in marked({"q1": "J21 = -l1*s1 - l2*s12"}, questions=[question])["q1"].remark
    )


@pytest.mark.parametrize(
    ("answer", "kind"),
    [
        ("-(m1 + m2)*g*l1 - m2*g*l2", "sign"),
        ("2*((m1 + m2)*g*l1 + m2*g*l2)", "factor"),
        ("46.107", "factor"),
        ("-23.0535", "sign"),
        ("40", "unknown"),
        ("17 + 6", "unknown"),
        # a term is lost: no factor, though every number is a multiple
        ("(m1 + m2)*g*l1", "missing term"),
        ("m1*g*l1 + m2*g*l2", "missing term"),
    ],
)
def test_a_number_is_not_called_a_multiple_of_the_right_one(answer, kind):
    question = {"id": "q1", "answer": "(m1 + m2)*g*l1 + m2*g*l2", "points": 4}
    found = marked({"q1": answer}, questions=[question], slips={"factor": 0.25, "sign": 0.5})["q1"]
    assert (found.kinds, found.points) == ((kind,), {"factor": 3.0, "sign": 2.0}.get(kind, 0.0))


def beside(model, answer, robot="planar2r"):
    asked = [{"id": "q1", "answer": model}]
    return marked({"q1": answer}, questions=asked, robot=robot, slips={})["q1"]


@pytest.mark.parametrize(
    ("model", "answer", "verdict", "kinds"),
    [
        ("pi/2", "pi/2", "right", ()), ("pi/2", "asin(1)", "right", ()),
        ("pi/2", "1.5708", "right with rounded numbers", ("rounded",)),
        ("pi/2", "1.57", "right with rounded numbers", ("rounded",)),
        ("pi/2", "3.14/2", "right with rounded numbers", ("rounded",)),
        ("pi/2", "1.6", "wrong", ("unknown",)), ("pi/2", "90", "wrong", ("degrees",)),
        ("2*pi/3", "120", "wrong", ("degrees",)), ("-pi/4", "-0.785", "right with rounded numbers", ("rounded",)),
        ("sqrt(2)", "1.41", "right with rounded numbers", ("rounded",)), ("sqrt(2)", "1.42", "wrong", ("unknown",)),
        ("q1", "180*q1/pi", "wrong", ("degrees",)),
        (2, "2.001", "wrong", ("unknown",)), (0, "0.001", "wrong", ("unknown",)), (0, "q1 - q1", "right", ()),
        (23.05, "(m1 + m2)*g*l1 + m2*g*l2", "right with rounded numbers", ("rounded",)), (23.05, "23.06", "wrong", ("unknown",)),
    ],
)  # fmt: skip
def test_a_model_answer_may_be_a_constant(model, answer, verdict, kinds):
    found = beside(model, answer)
    assert (found.verdict, found.kinds) == (verdict, kinds)


@pytest.mark.parametrize("asked", [{"entry": "M33"}, {"answer": "1/48"}])
def test_a_bare_number_is_judged_by_one_rule_beside_the_engine_too(asked):
    """1/48 = 0.0208333: three digits are right, two are 0.8 % off."""
    for answer, right in (("0.02083", True), ("0.0208", True), ("0.021", False), ("0.0209", False)):
        found = marked({"q1": answer}, questions=[{"id": "q1", **asked}], robot="planar3r")["q1"]
        assert found.right is right, answer


@pytest.mark.parametrize(
    ("model", "answer", "verdict", "remark"),
    [
        ("pi/2", "l1*pi", "right", "but it holds only for l1 = 0.5"),
        ("m1*g*l1", "m1*g*0.5", "right", "but it holds only for l1 = 0.5"),
        ("m1*g*l1", "g", "right", "but it holds only for l1 = 0.5 and m1 = 2"),
        ("m1*g*l1", "2*m1*g*l1^2", "wrong", ""), ("m1*g*l1", "9.81", "right", ""),
        ("m1*9.81*l1", "m1*g*l1", "right", ""), ("23.0535", "(m1 + m2)*g*l1 + m2*g*l2", "right", ""),
        ("l1*cos(q1)", "0.5*cos(q1)", "right", "but it holds only for l1 = 0.5"),
    ],
)  # fmt: skip
def test_what_holds_at_this_robots_numbers_only_says_so(model, answer, verdict, remark):
    found = beside(model, answer)
    assert (found.verdict, found.remark) == (verdict, remark)


def test_the_moment_of_a_rod_is_that_of_its_mass_and_length():
    """No number of the robot stands for another here: I1 is m1*l1**2/12 of every rod."""
    found = beside("m1*l1^2/3", "I1 + m1*l1^2/4", "planar2r_rods")
    assert (found.verdict, found.remark) == ("right", "")
    assert beside("m1*l1^2/3", "I1 + m1*l1^3/2", "planar2r_rods").verdict == "wrong"


@pytest.mark.parametrize("asked", [{"answer": "l1*sin(q1)"}, {"entry": "x"}, {"entry": "g2"}])
def test_an_answer_without_a_value_is_wrong_and_warns_of_nothing(asked, recwarn):
    odd = ["log(0)", "sqrt(-1)", "l1/(q1-q1)", "exp(9e9) - exp(9e9)", "q1^0.5", "tan(pi/2)"]
    found = [marked({"q1": answer}, questions=[{"id": "q1", **asked}])["q1"] for answer in odd]
    assert {one.verdict for one in found} == {"wrong"}
    assert {one.kinds for one in found[:4]} == {("no value",)}
    assert [str(one.message) for one in recwarn] == []


@pytest.mark.parametrize(
    ("answer", "verdict"),
    [("m1 + 0*qd1", "right"), ("2.01 - 0*qd1*l2", "wrong"), ("2.0*m2/1.5 + 0*qdd2", "right"), ("m1 + 0*zz", "could not be read")],
)  # fmt: skip
def test_what_is_multiplied_by_zero_stops_no_class(answer, verdict):
    found = beside("m1", answer)
    assert found.verdict == verdict
    assert ("'zz' is unknown" in found.remark) is ("zz" in answer)


def test_nothing_but_zero_is_no_known_confusion():
    found = marked({"q1": "0"}, "cause")["q1"]
    assert (found.kinds, found.cause) == (("no value",), "it gives zero everywhere, or no number")


def test_a_line_that_answers_no_question_is_told(tmp_path):
    sheet = sheet_of(SHEET, "s")
    (tmp_path / "a.txt").write_text("student: ada\nx = l1*c1 + l2*c12\ntau7 = 3\n")
    (tmp_path / "b.txt").write_text(
        "student: bob\n" + "".join(f"{k}: {v}\n" for k, v in RIGHT.items()) + "a = 3\n"
    )
    marks = kl.mark(sheet, tmp_path, workers=1)
    assert marks["ada"].note == "1 line answers no question: tau7"
    assert marks["bob"].note == ""  # every question has an answer, so nobody must look at the rest
    assert marks["bob"].aside == "1 line answers no question: a"


def test_a_student_is_not_told_where_the_class_is_kept(tmp_path):
    (tmp_path / "a.txt").write_bytes(b"q1: l1 \x81\n")
    (tmp_path / "b.txt").write_text("a" * 300_000)
    marks = kl.mark(SHEET, tmp_path, workers=1)
    told = [one.remark for mark in marks.marks for one in mark.outcomes]
    assert len(told) == 8 and all(text.startswith(("a.txt: ", "b.txt: ")) for text in told)


@pytest.mark.parametrize(
    "answer",
    ["m1*g*l1*abs(sin(q1))", "m1*g*l1*sqrt(sin(q1)**2)", "m1*g*l1*sin(abs(q1))",
     "m1*g*l1*sin(q1) + 0*log(q1)"],
)  # fmt: skip
def test_a_formula_that_is_right_for_positive_angles_only_is_wrong(answer):
    """The sheet's own answer is m1*g*l1*sin(q1); no engine stands beside it."""
    found = marked({**RIGHT, "q4": answer})
    assert [one.verdict for one in found.outcomes] == ["right", "right", "right", "wrong"]


NEARLY = """
import numpy as np
def q3(q):
    c = 0.3 * np.cos(q[1])
    return np.array([[{first} + 2 * c, 0.24 + c], [0.24 + c, 0.24]])
"""


@pytest.mark.parametrize(
    ("first", "told"),
    [
        ("1.115", ""),
        ("1.12", "right to 2 decimals"),
        ("TABLE", "mark it by hand"),
        ("2", ""),
    ],
)
def test_what_is_nearly_right_is_left_to_the_teacher(first, told):
    """1.12 is 1.115 rounded, as every number there is; a cosine out of a table is nearly one."""
    text = NEARLY.format(first="1.115" if first == "TABLE" else first)
    if first == "TABLE":
        text = text.replace("np.cos(q[1])", "np.interp(q[1], GRID, np.cos(GRID))")
        text = text.replace("def q3", "GRID = np.linspace(-4, 4, 300)\ndef q3")
    program = Submission("a.py", "ada", program=text)
    outcomes, _ = judge_program(sheet_of(SHEET, "s"), program, "cause")
    assert outcomes[2].right == (first in ("1.115", "1.12"))
    assert told in outcomes[2].remark and bool(told) == bool(outcomes[2].remark)


TAU2 = "m2*l2^2*(qdd1+qdd2) + h*c2*qdd1 + h*s2*qd1^2 + m2*g*l2*c12"
G = "[(m1+m2)*g*l1*c1 + m2*g*l2*c12; m2*g*l2*c12]"


def asked_alone(entry, answer, robot="planar2r", level="answer"):
    """The outcome of a sheet with one question."""
    question = entry if isinstance(entry, dict) else {"entry": entry}
    sheet = {"robot": robot, "feedback": level, "questions": [{"id": "a", "points": 1, **question}]}
    given = answer if isinstance(answer, dict) else {"a": answer}
    (found,) = kl.mark(sheet, {"ada": given})["ada"].outcomes
    return found


@pytest.mark.parametrize(
    ("entry", "answer", "robot"),
    [
        ("tau2", f"h = m2*l1*l2; tau2 = {TAU2}", "planar2r"),
        ("tau2", {"h": "m2*l1*l2", "tau2": TAU2}, "planar2r"),
        ("tau2", f"{TAU2} where h = m2*l1*l2", "planar2r"),
        ("g2", "g1 = (m1+m2)*g*l1*c1 + m2*g*l2*c12; g2 = m2*g*l2*c12", "planar2r"),
        ("g2", r"$m_2 l_2 g c_{12} = g_2$", "planar2r"),
        ("g2", "m2*g*l2*c12 = g2", "planar2r"),
        ("M", M, "planar2r"),
        ("M", f"D = {M}", "planar2r"),
        ("D", f"M = {M}", "planar2r"),
        ({"quantity": "mass_matrix"}, f"D = {M}", "planar2r"),
        ("g", f"G = {G}", "planar2r"),
        ("J", "[-l1*s1-l2*s12, -l2*s12; l1*c1+l2*c12, l2*c12; 1, 1]", "planar2r"),
        ("V", "V = m1*g*l1*s1 + m2*g*(l1*s1+l2*s12)", "planar2r"),
        (
            "tau1",
            r"$\tau = (\frac14 m l^2 + I) \ddot\theta + \frac12 m g l \cos\theta$",
            "single_link",
        ),
        ("tau", "tau = m1*l1^2*qdd1/4 + I1*qdd1 + m1*g*l1*c1/2", "single_link"),
        ({"quantity": "gravity_torques"}, "m1*g*l1*c1/2", "single_link"),
    ],
)
def test_a_class_is_read_as_one_formula_is(entry, answer, robot):
    found = asked_alone(entry, answer, robot)
    assert (found.verdict, found.points) == ("right", 1.0), found.remark


@pytest.mark.parametrize(
    ("entry", "answer", "place", "cause"),
    [
        ("M", M.replace("2*m2", "m2"), "M11: look at m2*l1*l2*c2", "a numerical factor is off"),
        ("g", G.replace(" + m2*g*l2*c12", ""), "g1", "a term is missing"),
        ("tau2", "h = m2*l1*l2; tau2 = " + TAU2.replace("+ h*s2", "- h*s2"),
         "tau2: look at -h*s2*qd1^2", "a sign is the other way"),
    ],
)  # fmt: skip
def test_what_is_wrong_keeps_its_place_and_cause(entry, answer, place, cause):
    found = asked_alone(entry, answer)
    assert (found.verdict, found.place, found.cause) == ("wrong", place, cause)
    assert asked_alone(entry, answer, level="verdict").place == ""


def test_a_line_for_a_joint_or_for_a_number_of_the_arm_explains_nothing():
    given = {"q1": "0", "m2": "7", "x": "9", "g2": "m2*g*l2*cos(q1+q2)"}
    found = asked_alone("g2", given)
    assert (found.verdict, found.remark) == ("right", "")


def test_another_entrys_line_is_refused():
    found = asked_alone("g2", "tau2 = m2*g*l2*c12")
    assert found.remark == "the line begins with tau2 =, and the question asks for g2"


def test_names_of_a_students_own_stand_on_lines_of_their_own(tmp_path):
    path = tmp_path / "ada.tex"
    path.write_text(
        "% student: ada\n\\begin{align} h &= m_2 l_1 l_2 s_2 \\\\ \n"
        "k &= 2 h \\\\ C_{12} &= -h \\dot\\theta_1 - \\frac{k}{2} \\dot\\theta_2 \\end{align}"
    )
    sheet = {"robot": "planar2r", "questions": [{"id": "a", "entry": "C12"}]}
    (found,) = kl.mark(sheet, tmp_path)["ada"].outcomes
    assert found.verdict == "right", found.remark


def test_a_fault_of_our_own_costs_one_answer_and_no_class(monkeypatch) -> None:
    """Whatever judging one answer raises, the others have their marks."""
    from kinlab.doctor.marking import judge

    def breaks(sheet, question, student, file):
        if student == "eve":
            raise KeyError("a fault")
        return with_answer(sheet, question, student, file)

    with_answer = judge.with_answer
    monkeypatch.setattr(judge, "with_answer", breaks)
    marks = kl.mark(SHEET, {"ada": RIGHT, "eve": RIGHT}, workers=1)
    assert marks["ada"].total == 10.0
    assert [one.verdict for one in marks["eve"].outcomes] == ["right"] * 3 + ["could not be read"]


@pytest.mark.parametrize(
    ("right", "wrong", "kinds"),
    [
        ("- l2*sin(q1 + q2)*qd2", "+ l2*sin(q1 + q2)*qd2", ("sign",)),
        ("l1*sin(q1)", "l1*cos(q1)", ("sin/cos",)),
        ("l2*sin(q1 + q2))", "l2*sin(q2))", ("argument",)),
        ("+ l2*sin(q1 + q2))", ")", ("missing term",)),
        ("*qd2", "*qd1", ("index",)),
        ("l1*sin(q1)", "sin(q1)", ("missing factor",)),
    ],
)
def test_slips_beside_an_own_answer_are_told_by_kind(right, wrong, kinds):
    """No engine knows the velocity of the tool along x by itself."""
    model = "-(l1*sin(q1) + l2*sin(q1 + q2))*qd1 - l2*sin(q1 + q2)*qd2"
    question = {"id": "q1", "entry": "v", "answer": model, "points": 4}
    slips = {kinds[0]: 0.25}
    found = marked({"q1": model.replace(right, wrong)}, questions=[question], slips=slips)["q1"]
    assert (found.kinds, found.points, found.place) == (kinds, 3.0, "v")


@pytest.mark.parametrize("answer", ["4", "48", "sqrt(4)", "5 - 11", "0"])
def test_of_bare_numbers_beside_an_own_answer_no_slip_is_told(answer):
    """4 is the root of 16, a quarter of it, and 16 with a term left out: nothing tells which."""
    question = {"id": "q1", "answer": "16", "points": 4}
    assert marked({"q1": answer}, questions=[question], slips={"factor": 0.25})["q1"].kinds == (
        "unknown",
    )
