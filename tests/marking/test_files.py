"""Encodings, files of other kinds, several files of one student."""

from __future__ import annotations

import csv
import io

import pytest
from typer.testing import CliRunner

import kinlab as kl
from kinlab.cli import app
from kinlab.doctor.marking.reading.encodings import decoded
from kinlab.doctor.marking.results import as_csv
from kinlab.errors import FileError

SHEET = {
    "robot": "planar2r",
    "feedback": "cause",
    "questions": [
        {"id": "q1", "entry": "x", "points": 2},
        {"id": "q2", "entry": "g2", "points": 3},
        {"id": "q3", "answer": "m1*g*l1", "points": 1},
    ],
}
X, G2 = "l1*c1 + l2*c12", "m2*g*l2*c12"


@pytest.mark.parametrize(
    ("who", "encoding", "told"),
    [
        ("李雷", "gb18030", "GB18030"), ("王芳", "gbk", "GB18030"), ("Søren Ångström", "cp1252", "Windows-1252"),
        ("Jürgen Müller", "latin-1", "Windows-1252"), ("Müller", "utf-16", "UTF-16"), ("李雷", "utf-16", "UTF-16"),
        ("Größe", "cp1252", "Windows-1252"), ("Zoë", "utf-8-sig", ""), ("李四", "utf-8", ""), ("Éloïse Gagné", "latin-1", "Windows-1252"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("kind", ["txt", "tex", "md", "toml"])
def test_encodings_are_told_from_the_bytes(who, encoding, told, kind, tmp_path):
    text = {
        "toml": f'student = "{who}"\nq1 = "{X}"\n',
        "tex": f"% student: {who}\n\\begin{{document}}$x = {X.replace('*', ' ')}$\\end{{document}}",
    }.get(kind, f"student: {who}\nq1: x = {X}\r\n")
    (tmp_path / f"a.{kind}").write_bytes(text.encode(encoding))
    (found,) = kl.mark(SHEET, tmp_path, workers=1).marks
    assert (found.student, found["q1"].right) == (who, True), found
    assert found.aside == (f"read as {told}" if told else "")


def test_a_chinese_text_and_a_program_that_says_its_encoding():
    text = "学生：李四\n第1题：由几何关系得 x = l1*c1，其中角度为弧度。\n"
    assert decoded(text.encode("gbk"), "a") == (text, "GB18030")
    program = "# -*- coding: latin-1 -*-\n# é\n"
    assert decoded(program.encode("latin-1"), "a") == (program, "Windows-1252")
    assert decoded("½ m² – “so”".encode("cp1252"), "a")[0] == "½ m² – “so”"


@pytest.mark.parametrize(
    "data",
    [b"q1: \x81\x8d\n", b"\xff\xfe\x00q1", b"\x89PNG\r\n\x1a\n\x00\x00", bytes(range(128, 256))],
)
def test_what_is_no_text_is_refused_once(data, tmp_path):
    with pytest.raises(FileError, match="a: "):
        decoded(data, "a")
    (tmp_path / "a.txt").write_bytes(data)
    out = tmp_path / "out"
    marks = kl.mark(SHEET, tmp_path, out, workers=1)
    (found,) = marks.marks
    assert found.total == 0 and found.unread.startswith("a.txt: ")
    assert "could not be read" not in marks.summary and marks.said() == [found.unread]
    (page,) = (out / "students").iterdir()
    assert page.read_text(encoding="utf-8").count(found.unread) == 1
    assert found.unread in (out / "class.html").read_text(encoding="utf-8")
    assert found.unread in (out / "marks.csv").read_text(encoding="utf-8-sig")


def test_files_of_other_kinds_are_told(tmp_path):
    folder, out = tmp_path / "in", tmp_path / "out"
    (folder / "eve_12").mkdir(parents=True)
    (folder / "ada.txt").write_text(f"student: ada\nq1: {X}\n")
    (folder / "eve_12" / "a.txt").write_text(f"q1: {X}\n")
    for name in ("ada.pdf", "sam.docx", "eve_12/photo.jpg", ".hidden", "Thumbs.db"):
        (folder / name).write_bytes(b"%PDF")
    marks = kl.mark(SHEET, folder, out, workers=1)
    assert marks.not_read == ("ada.pdf", "eve_12/photo.jpg", "sam.docx")
    assert marks["ada"].note == "not read: ada.pdf"
    assert "not read: eve_12/photo.jpg" in marks["eve_12"].note
    page = (out / "class.html").read_text(encoding="utf-8")
    assert "sam.docx" in page and "Thumbs" not in page
    rows = csv.DictReader(io.StringIO(as_csv(marks)))
    assert {row["student"]: "not read" in row["note"] for row in rows} == {
        "ada": True,
        "eve_12": True,
    }
    sheet = tmp_path / "s.toml"
    sheet.write_text('robot = "planar2r"\n[[questions]]\nid = "q1"\nentry = "x"\n')
    told = CliRunner().invoke(app, ["mark", str(sheet), str(folder), "-o", str(tmp_path / "o2")])
    assert "not read: ada.pdf, eve_12/photo.jpg, sam.docx" in told.output


def test_marks_are_read_by_a_spreadsheet_and_by_python(tmp_path):
    (tmp_path / "a.txt").write_text(f"student: 李雷\nq1: {X}\n", encoding="utf-8")
    kl.mark(SHEET, tmp_path, tmp_path / "out", workers=1)
    data = (tmp_path / "out" / "marks.csv").read_bytes()
    assert data.startswith(b"\xef\xbb\xbf") and data.count(b"\xef\xbb\xbf") == 1
    (row,) = csv.DictReader(io.StringIO(data.decode("utf-8-sig")))
    assert row["student"] == "李雷"


PROGRAM = """
student = "ada"
import numpy as np
def x(q):
    return .5*np.cos(q[0]) + .4*np.cos(q[0] + q[1])
"""


def test_two_files_of_a_student_are_one_submission(tmp_path):
    (tmp_path / "a.py").write_text(PROGRAM)
    (tmp_path / "a.txt").write_text(f"student: Ada\nq2: {G2}\nq3: m1*g*l1\n")
    (tmp_path / "b.txt").write_text(f"student: bob\nq1: {X}\n")
    marks = kl.mark(SHEET, tmp_path, tmp_path / "out", run_python=True, workers=1)
    assert [(m.student, m.file, m.total) for m in marks.marks] == [("ada", "a.py, a.txt", 6.0), ("bob", "b.txt", 2.0)]  # fmt: skip
    assert "2 submissions, mean 4.00 of 6 points" in str(marks)
    assert marks["ada"].note == "handed in 2 times: a.py, a.txt"
    assert len(list((tmp_path / "out" / "students").iterdir())) == 2
    (again,) = (m for m in kl.mark(SHEET, tmp_path, run_python=True, workers=2).marks if m.student == "ada")  # fmt: skip
    assert again.total == 6.0
    unrun = kl.mark(SHEET, tmp_path, workers=1)["ada"]
    assert (unrun.total, unrun.unread) == (4.0, "")
    assert "run only with --run-python" in unrun["q1"].remark


def test_of_two_answers_the_later_by_name_counts_and_it_is_said(tmp_path):
    (tmp_path / "hans.toml").write_text(f"student = 'hans'\nq1 = 'l1*c1'\nq2 = '{G2}'\n")
    (tmp_path / "hans_final(2).toml").write_text(f"student = 'hans'\nq1 = '{X}'\nq2 = 'l1*('\n")
    (tmp_path / "hans_z.txt").write_bytes(b"student: hans\nq1: \x81")
    (found, other) = kl.mark(SHEET, tmp_path, workers=1).marks
    assert (found.total, other.student) == (5.0, "hans_z")
    assert (
        "q1 is answered in hans.toml, hans_final(2).toml; hans_final(2).toml counts" in found.note
    )
    assert "q2 is answered in hans.toml, hans_final(2).toml; hans.toml counts" in found.note
