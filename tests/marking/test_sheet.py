"""The sheet: what it may hold, and errors at the door; numbers for each student; handouts."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

import kinlab as kl
from kinlab.doctor.marking.handout import handout, students_of, write_handouts
from kinlab.doctor.marking.sheet import SheetError, read_sheet, sheet_of
from kinlab.doctor.marking.variation import numbers_for, robot_for
from kinlab.errors import FileError

ASKED = {"id": "q1", "entry": "tau1", "points": 4}


def sheet(**changes):
    return sheet_of({"robot": "planar2r", "questions": [ASKED], **changes}, "s.toml")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"robot": None}, "s.toml: robot is missing"), ({"robot": "planar3x"}, "s.toml: robot: .*unknown"),
        ({"feedbck": "place"}, "key 'feedbck' is unknown; did you mean 'feedback'"),
        ({"feedback": "all"}, "feedback is 'all'; choose one of 'verdict'"), ({"questions": []}, "questions are missing"),
        ({"slips": {"sgn": 0.5}}, "'sgn' is no kind of slip; did you mean 'sign'"),
        ({"slips": {"sign": 2}}, "sign = 2; a share of the points"), ({"samples": 3}, "samples is 3; a whole number from 10"),
        ({"questions": [ASKED, ASKED]}, "two questions have the id 'q1'"),
        ({"questions": [{"id": "q 1"}]}, "question 1: id is 'q 1'"), ({"questions": [{"id": "q1"}]}, r"question 1 \(q1\): what is asked"),
        ({"questions": [{"id": "q1", "entry": "foo7"}]}, r"\(q1\): 'foo7' names no quantity"),
        ({"questions": [{"id": "q1", "quantity": "mass_matrx"}]}, "did you mean 'mass_matrix'"),
        ({"questions": [{"id": "q1", "quantity": "fk[:3,3]"}]}, "is a range"),
        ({"questions": [{"id": "q1", "quantity": "fk", "answer": "1"}]}, "quantity and answer are both given"),
        ({"questions": [{"id": "q1", "entry": "tau1", "points": -1}]}, "points is -1"),
        ({"questions": [{"id": "q1", "entry": "tau1", "points": "4"}]}, "points is '4'; write a number"),
        ({"questions": [{"id": "q1", "quantity": "fivebar_rods"}]}, "fivebar_rods is no quantity of planar2r"),
        ({"variation": {"names": ["l9"]}}, r"\[variation\]: names: planar2r has no 'l9'"), ({"variation": {"spread": 2}}, "spread is 2"),
        ({"title": 3}, "title is 3; write text"),
        ({"questions": [{"id": "q1", "entry": "tau9"}]}, r"\(q1\): planar2r of 2 joints has no tau9"),
        ({"questions": [{"id": "q1", "quantity": "mass_matrix[0,5]"}]}, r"has no mass_matrix\[0,5\]"),
    ],
)  # fmt: skip
def test_errors_at_the_door(changes, message):
    with pytest.raises(SheetError, match=message):
        sheet(**changes)


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        ("l1*", "s.toml: q1: answer"), ("m1*g + m7*l1", "answer: planar2r has no 'm7'; did you mean 'm"),
        ("l1*cos(q3)", "has no 'q3'"), ("l1*c23", "has no 'q3'"),
        ("m1*gg*l1", r"q1: answer: planar2r has no 'gg'; did you mean 'g'\? \(a name of the question's own"),
        ("l1 + zz", "has no 'zz'; choose one of 'g', 'l1'"), ("l1*L", "has no 'L'"),
        ("sqrt(-1)", "is no number at any state"), ("l1*log(q1 - q1)", "is no number at any state"),
    ],
)  # fmt: skip
def test_a_bad_model_answer_is_found_before_anything_is_marked(answer, message):
    asked = {"id": "q1", "answer": answer}
    with pytest.raises(SheetError, match=message):
        kl.mark(
            sheet_of({"robot": "planar2r", "questions": [asked]}, "s.toml"), {"ada": {"q1": "1"}}
        )


@pytest.mark.parametrize("answer", ["k*x1 + l1*cos(q1)", "k*x_1 + l1*c1 + 0*k*qd2"])
def test_a_model_answer_may_have_names_of_its_own(answer):
    text = "A spring of stiffness $k$ is longer by $x_1$."
    asked = {"id": "q1", "text": text, "answer": answer}
    marks = kl.mark({"robot": "planar2r", "questions": [asked]}, {"ada": {"q1": "l1*c1 + x1*k"}})
    assert marks["ada"]["q1"].right


def test_a_sheet_whose_answer_is_refused_is_not_handed_out(tmp_path):
    asked = {"id": "q1", "answer": "m1*gg*l1"}
    with pytest.raises(SheetError, match="no 'gg'"):
        write_handouts(sheet(questions=[asked]), ["ada"], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_an_entry_beside_an_answer_is_a_name_of_its_own():
    """With x for its name the answer would not be compared with the engine's x."""
    both = {"id": "q1", "entry": "x", "answer": "l1"}
    with pytest.raises(SheetError, match=r"\(q1\): entry 'x' is fk\[0,3\].*keep one"):
        sheet(questions=[both])
    marks = kl.mark(sheet(questions=[{**both, "entry": "F"}]), {"ada": {"q1": "F = l1"}})
    assert marks["ada"]["q1"].right


def test_a_file_that_is_no_sheet(tmp_path):
    file = tmp_path / "s.toml"
    file.write_text("title = [")
    with pytest.raises(SheetError, match=r"s.toml: not TOML"):
        read_sheet(file)
    with pytest.raises(FileError, match="no such file"):
        read_sheet(tmp_path / "t.toml")


@pytest.mark.parametrize("robot", ["planar2r", "puma560"])
def test_each_student_has_numbers_of_the_same_kind(robot):
    varied = sheet(robot=robot, variation={"seed": 3, "spread": 0.2})
    plain = numbers_for(sheet(robot=robot), "ada")
    ada, bob = numbers_for(varied, "ada"), numbers_for(varied, "bob")
    assert ada == numbers_for(varied, " Ada") != bob
    assert ada.keys() == plain.keys()
    assert ada["g"] == plain["g"]
    for name, value in ada.items():
        assert 0.79 <= value / plain[name] <= 1.21
    assert numbers_for(sheet(robot=robot, variation={"seed": 4}), "ada") != ada
    robot_ada = robot_for(varied, "ada")
    assert np.all(np.linalg.eigvalsh(kl.mass_matrix(robot_ada, np.zeros(robot_ada.n))) > 0)


def test_the_varied_robot_is_the_one_with_these_numbers():
    varied = sheet(variation={"seed": 3})
    n, robot, q = numbers_for(varied, "ada"), robot_for(varied, "ada"), np.array([0.3, 0.8])
    by_hand = (n["m1"] + n["m2"]) * n["l1"] ** 2 + n["m2"] * n["l2"] ** 2
    by_hand += 2 * n["m2"] * n["l1"] * n["l2"] * np.cos(q[1])
    assert kl.mass_matrix(robot, q)[0, 0] == pytest.approx(by_hand, rel=1e-12)


def test_a_students_numbers_warn_of_nothing(recwarn):
    """A rod's moment across its plane has no name and goes with the one that has."""
    varied = sheet(robot="planar2r_rods", variation={"seed": 3})
    assert len({numbers_for(varied, f"s{k}")["I1"] for k in range(20)}) > 10
    right = {f"s{k}": {"q1": "m1*l1**2/3 + I1 - m1*l1**2/12"} for k in range(20)}
    asked = {"id": "q1", "answer": "I1 + m1*l1**2/4"}
    marks = kl.mark(sheet(robot="planar2r_rods", variation={"seed": 3}, questions=[asked]), right)
    assert {mark["q1"].verdict for mark in marks.marks} == {"right"}
    assert [str(one.message) for one in recwarn] == []


def test_handouts(tmp_path):
    varied = sheet(title='Home"work', variation={"seed": 3, "names": ["l1"]})
    ids = tmp_path / "ids.csv"
    ids.write_text('id,name\nada,Ada\n"=x"y\\,B\n')
    students = students_of(ids)
    assert students == ["ada", '=x"y\\']
    assert write_handouts(varied, students, tmp_path / "out") == 2
    text = (tmp_path / "out" / "ada.toml").read_text()
    assert f"l1 = {numbers_for(varied, 'ada')['l1']:g}" in text
    assert "m1 = 2\n" in text
    read = tomllib.loads(handout(varied, '=x"y\\'))
    assert read == {"student": '=x"y\\', "answers": {"q1": ""}}
    ids.write_text("ada\nADA\n")
    with pytest.raises(FileError, match="'ADA' stands there twice"):
        students_of(ids)


def test_an_id_that_is_in_no_list_is_told(tmp_path):
    (tmp_path / "ids.txt").write_text("ada\nbob\n")
    path = tmp_path / "s.toml"
    path.write_text(
        'robot = "planar2r"\n[variation]\nseed = 3\nids = "ids.txt"\n'
        '[[questions]]\nid = "q1"\nentry = "x"\n'
    )
    answers = {who: {"q1": "l1*c1 + l2*c12"} for who in ("Ada", "bobb", "xerxes")}
    marks = kl.mark(path, answers)
    assert [mark.note for mark in marks.marks] == [
        "",
        marks["bobb"].stranger,
        marks["xerxes"].stranger,
    ]
    assert (
        "bobb is in no line of the ids" in marks["bobb"].note
        and "did you mean bob?" in marks["bobb"].note
    )
    assert "did you mean" not in marks["xerxes"].note
    assert marks.said() == [marks["bobb"].stranger, marks["xerxes"].stranger]
    (tmp_path / "ids.txt").unlink()
    with pytest.raises(FileError, match="ids.txt: no such file"):
        kl.mark(path, answers)


@pytest.mark.parametrize(
    ("answer", "right"),
    [
        ("1.15 m", True), ("115 cm", True), ("r = 1.15 m", True), ("about 1.15 m", True), ("1.15", True), ("1.15 kg", False),
        (r"$1.15\,\mathrm{m}$", True), ("ca. 1.15 m.", True), ("1.5 m", False), ("1.15 m1", False), ("-1.15 m", False),
    ],
)  # fmt: skip
def test_a_number_may_have_its_unit(answer, right):
    asked = {"id": "q1", "answer": "l1 + l2 + l3", "text": "The reach."}
    marks = kl.mark({"robot": "planar3r", "questions": [asked]}, {"ada": {"q1": answer}})
    assert marks["ada"]["q1"].right is right, marks["ada"]


def test_a_letter_that_is_a_name_is_no_unit():
    asked = {"id": "q1", "answer": "2*m", "text": "Twice the mass m."}
    marks = kl.mark({"robot": "planar3r", "questions": [asked]}, {"ada": {"q1": "2 m"}})
    assert marks["ada"]["q1"].right


@pytest.mark.parametrize(
    "answer", ["tau = -k*theta1", r"$\tau_s = -k\theta_1$", "F_s = -k*q1", "-k*theta_1"]
)
def test_an_own_answer_may_be_called_anything(answer):
    asked = {"id": "q1", "answer": "-k*q1", "text": "A spring of stiffness k."}
    marks = kl.mark({"robot": "planar3r", "questions": [asked]}, {"ada": {"q1": answer}})
    assert marks["ada"]["q1"].right, marks["ada"]
