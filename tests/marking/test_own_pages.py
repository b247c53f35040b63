"""Each student is told of his own answer, in units that it has, and nobody's page outlives him."""

from __future__ import annotations

import json

import pytest

import kinlab as kl
from kinlab.doctor.marking import judge
from kinlab.doctor.marking.results import as_csv
from kinlab.doctor.marking.sheet import SheetError, sheet_of

SHEET = {
    "title": "Homework",
    "robot": "planar2r",
    "feedback": "answer",
    "questions": [
        {"id": "a", "entry": "x", "points": 2},
        {"id": "b", "text": "t", "answer": "(m1 + m2)*g*l1 + m2*g*l2"},
        {"id": "c", "text": "t", "answer": "pi/2"},
        {"id": "d", "text": "t", "answer": "l1 + l2"},
        {"id": "e", "text": "of a spring k", "answer": "k*l1"},
    ],
}
X = "l1*c1 + l2*c12"


def outcome(question, answer):
    return kl.mark(SHEET, {"ada": {question: answer}})["ada"][question]


@pytest.mark.parametrize("turned", [False, True])
def test_the_words_of_one_are_told_to_no_other(turned):
    own = {
        "ada": f"{X}, my own secret remark 0176",
        "bob": X,
        "cem": f"{X} maybe",
        "dan": f"{X} or not",
    }
    names = [*own][::-1] if turned else [*own]
    marks = kl.mark(SHEET, {who: {"a": own[who]} for who in names})
    told = {who: marks[who]["a"].remark for who in names}
    assert told["bob"] == ""
    assert "secret" in told["ada"] and "maybe" in told["cem"] and "or not" in told["dan"]
    assert not any("secret" in told[who] for who in ("bob", "cem", "dan"))


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("b", "23.0535 N m"), ("b", "23.05Nm"), ("b", "23,05 Nm"), ("b", "≈23.1 N·m"), ("b", "23.05 N⋅m"),
        ("b", "23053.5 Nmm"), ("b", "0.0230535 kN m"), ("b", "23.05 N-m"), ("b", "23.05 牛·米"),
        ("b", "23.05 Nm (rounded)"), ("b", "23.05 newton metres"), ("b", "23.05 J"), ("b", "23.0535 [Nm]"),
        ("b", r"$23.05\,\mathrm{N\,m}$"), ("b", "tau_{1,max} = 23.05 Nm"), ("b", "23.0535"),
        ("c", "90°"), ("c", "90 degrees"), ("c", "π/2 rad"), ("c", "1.57 rad"), ("c", "pi/2"),
        ("b", "23.0535 kg*m**2/s**2"), ("b", "23.0535 kg m^2/s^2"), ("d", "0.9 m"), ("d", "90 cm"), ("d", "l1 + l2 = 0.9 m"), ("e", "k*l1"),
    ],
)  # fmt: skip
def test_a_number_in_its_unit_is_right(question, answer):
    found = outcome(question, answer)
    assert found.right, found


@pytest.mark.parametrize(
    ("question", "answer", "said"),
    [
        ("b", "23.0535 kg", "'kg' is no unit"), ("b", "23.0535 m", "'m' is no unit"),
        ("b", "23.05 rad", "'rad' is no unit"), ("b", "23.05 N", "'N' is no unit"),
        ("b", "23.05 J/s", "'J/s' is no unit"), ("d", "0.9 kg", "'kg' is no unit"),
        ("c", "1.5708°", ""), ("d", "0.9 cm", ""), ("b", "23.0535 kN m", ""),
    ],
)  # fmt: skip
def test_a_number_in_another_unit_is_not(question, answer, said):
    found = outcome(question, answer)
    assert not found.right and said in found.remark, found


@pytest.mark.parametrize("answer", ["24", "4*10*0.6", "2.4*9.81", "10*2.35", "23.2"])
def test_a_number_is_no_nearer_for_being_written_as_a_product(answer):
    assert outcome("b", answer).verdict == "wrong"


def test_pages_of_who_is_gone_are_removed(tmp_path):
    folder, out = tmp_path / "in", tmp_path / "out"
    folder.mkdir()
    for name in ("ada", "bob"):
        (folder / f"{name}.txt").write_text(f"student: {name}\na: l1*c1 + l2*c2\nb: 20\n")
    assert kl.mark(SHEET, folder, out, workers=1).withdrawn == 0
    (out / "students" / "mine.html").write_text("a teacher's own file")
    assert any("should be" in p.read_text() for p in out.rglob("*.json"))
    (folder / "ada.txt").rename(folder / "ada_2.txt")
    (folder / "bob.txt").unlink()
    marks = kl.mark(SHEET, folder, out, feedback="verdict", workers=1)
    assert marks.withdrawn == 2 and "2 earlier submissions" in " ".join(marks.said())
    left = [p for p in out.rglob("*") if p.is_file() and p.name != "mine.html"]
    assert not any("should be" in p.read_text() or "bob" in p.name for p in left)
    assert len([*(out / "students").iterdir()]) == 2 and (out / "students" / "mine.html").exists()


def test_a_fault_of_our_own_is_loud_and_not_kept(tmp_path, monkeypatch):
    folder, out = tmp_path / "in", tmp_path / "out"
    folder.mkdir()
    (folder / "ada.txt").write_text(f"student: ada\na: {X}\nd: 0.9 m\n")

    def breaks(*_given):
        raise NameError("a fault")

    with monkeypatch.context() as patch:
        patch.setattr(judge, "with_answer", breaks)
        marks = kl.mark(SHEET, folder, out, workers=1)
    assert marks["ada"].failed and "kinlab itself failed" in " ".join(marks.said())
    assert "NameError" in marks["ada"]["d"].remark
    again = kl.mark(SHEET, folder, out, workers=1)
    assert not again["ada"].failed and again["ada"]["d"].right


def test_nobody_answers_for_another_whose_folder_is_his(tmp_path):
    for folder, x in (("ada", X), ("zed", "l1*c1")):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "hw.txt").write_text(f"student: ada\na: {x}\n")
    marks = kl.mark(SHEET, tmp_path, workers=1)
    assert marks["ada"]["a"].right and not marks["zed"]["a"].right
    assert "the file says ada" in marks["zed"].note


@pytest.mark.parametrize(
    ("question", "said"),
    [
        ({"entry": "M01"}, "counted from 1"), ({"entry": "q2"}, "judged together"),
        ({"quantity": "mass_matrix[-1,-1]"}, "counted from 1"),
        ({"entry": "x", "tolerance": 0.1}, "tolerance goes with an answer of your own"),
    ],
)  # fmt: skip
def test_what_no_student_could_answer_is_refused_at_the_door(question, said):
    sheet = {"title": "t", "robot": "planar2r", "questions": [{"id": "k1", **question}]}
    with pytest.raises(SheetError, match=said):
        sheet_of(sheet, "sheet", json.dumps(sheet))


def test_both_joints_are_one_question(tmp_path):
    q2 = "acos((x^2+y^2-l1^2-l2^2)/(2*l1*l2))"
    q1 = "atan2(y,x) - atan2(l2*sin(q2), l1+l2*cos(q2))"
    sheet = {
        "title": "t",
        "robot": "planar2r",
        "questions": [{"id": "ik", "quantity": "inverse_kinematics_xy"}],
    }
    (tmp_path / "ada.txt").write_text(f"student: ada\nik:\nq2 = {q2}\nq1 = {q1}\n")
    (tmp_path / "bob.txt").write_text(
        f"student: bob\nik:\nq2 = {q2}\nq1 = {q1.replace(' - ', ' + ')}\n"
    )
    marks = kl.mark(sheet, tmp_path, workers=1)
    assert marks["ada"]["ik"].right and marks["bob"]["ik"].verdict == "wrong"
    assert as_csv(marks).count("\n") == 3


@pytest.mark.parametrize("text", ["a: l1*c1 + ...\n   l2*c12", "a: l1*c1 + \\\n  l2*c12", f"x_E = {X}",
                                  f"x_{{TCP}} = {X}", f"x_tool = {X}", f"x_ee = {X}"])  # fmt: skip
def test_a_line_that_goes_on_and_a_point_with_a_name(text, tmp_path):
    (tmp_path / "ada.txt").write_text(f"student: ada\n{text}\n")
    found = kl.mark(SHEET, tmp_path, workers=1)["ada"]["a"]
    assert found.right, found


def test_a_place_is_quoted_as_it_was_typed():
    found = outcome("a", "0.5*c1 - 0.4*c12")
    assert found.place == "x: look at -0.4*c12"


def test_an_entry_that_is_not_there_is_counted_from_one():
    sheet = {
        "title": "t",
        "robot": "planar2r",
        "questions": [{"id": "j", "quantity": "planar_jacobian"}],
    }
    found = kl.mark(sheet, {"ada": {"j": {"J13": "l1"}}})["ada"]["j"]
    assert "(1, 3)" in found.remark and "3 x 2" in found.remark, found


def test_a_name_of_the_sheets_own_is_no_coordinate(tmp_path):
    questions = [
        {"id": "a", "entry": "x"},
        {"id": "b", "text": "t", "entry": "x_e", "answer": "l1"},
    ]
    sheet = {"title": "t", "robot": "planar2r", "questions": questions}
    (tmp_path / "ada.txt").write_text(f"student: ada\nx_e = l1\nx_tool = {X}\n")
    marks = kl.mark(sheet, tmp_path, workers=1)["ada"]
    assert marks["a"].right and marks["b"].right, marks


@pytest.mark.parametrize("model", ["(m1 + m2)*9.81*l1 + m2*9.81*l2", "23.0535", "10*2.30535*m1/2"])
def test_where_a_number_may_have_a_unit_none_is_refused(model):
    sheet = {
        "title": "t",
        "robot": "planar2r",
        "questions": [{"id": "b", "text": "t", "answer": model}],
    }
    assert kl.mark(sheet, {"ada": {"b": "23.0535 N m"}})["ada"]["b"].right


WHOLE = {
    "M": "[[(m1+m2)*l1^2 + m2*l2^2 + 2*m2*l1*l2*c2, m2*l2^2 + m2*l1*l2*c2]]",
    "J": "[[-l1*s1 - l2*s12, -l2*s12], [l1*c1 + l2*c12, l2*c12]]",
}


@pytest.mark.parametrize("entry", WHOLE)
def test_what_is_wrong_and_lacks_entries_has_no_more_than_what_is_right_and_lacks_them(entry):
    sheet = {
        "title": "t",
        "robot": "planar2r",
        "slips": {"sign": 0.25},
        "questions": [{"id": "a", "entry": entry, "points": 4}],
    }
    right = WHOLE[entry]
    answers = {
        "ada": {"a": right},
        "bob": {"a": right.replace("+ 2*", "- 2*").replace("c1 +", "c1 -")},
    }
    marks = kl.mark(sheet, answers)
    ada, bob = marks["ada"]["a"], marks["bob"]["a"]
    assert ada.points == bob.points == 0.0
    assert ada.kinds == ("missing entries",) and bob.kinds == ("sign", "missing entries")
    assert "not given" in ada.place and "look at" in bob.place


def test_every_entry_that_is_wrong_costs_something():
    sheet = {
        "title": "t",
        "robot": "isotropic",
        "slips": {"sign": 0.25, "other": 0.25},
        "questions": [{"id": "a", "entry": "fivebar_jacobian", "points": 4}],
    }
    right = {f"J{i}{k}": f"w{i}{x}/(l1*uHw{i})" for i in (1, 2) for k, x in ((1, "x"), (2, "y"))}
    assert kl.mark(sheet, {"ada": {"a": right}})["ada"]["a"].points == 4
    wrong = {**right, "J11": f"-{right['J11']}", "J22": f"-{right['J22']}"}
    found = kl.mark(sheet, {"bob": {"a": wrong}})["bob"]["a"]
    assert found.points == 2 and found.kinds == ("sign", "sign"), found
