"""What students and teachers are told: words they can use, in their language, and no more."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import kinlab as kl
from kinlab.doctor.marking.pages import class_page, pictures_of, student_page
from kinlab.doctor.marking.reading.labels import SheetLabels
from kinlab.doctor.marking.sheet import SheetError, sheet_of
from kinlab.doctor.marking.words import KINDS, for_student
from kinlab.host.language import _, speaking

DOCS = Path(__file__).parents[2] / "docs"


def marked(answers, robot="planar2r", entry="x", **more):
    sheet = {
        "robot": robot,
        "feedback": "cause",
        "questions": [{"id": "q1", "entry": entry}],
        **more,
    }
    return kl.mark(sheet, {"ada": answers})


@pytest.mark.parametrize("language", ["en", "zh"])
@pytest.mark.parametrize(
    ("robot", "entry", "text"),
    [("scara", "x", "a1*c1 + metres*c12"), ("planar2r", "x", "L*c1 + TODOS*c12"), ("puma560", "x", "foo*c1")],
)  # fmt: skip
def test_an_unknown_name_is_told_without_symbols_and_with_six_others(language, robot, entry, text):
    with speaking(language):
        remark = marked({"q1": text}, robot, entry)["ada"]["q1"].remark
    assert "[symbols]" not in remark and remark.count("'") <= 14
    assert ("name = formula" if language == "en" else "名称 = 公式") in remark


def test_lists_and_symbols_are_cut():
    names = ", ".join(f"'n{k}'" for k in range(40))
    said = for_student(f"q1: x: 'a' is unknown; choose one of {names} ...; or give it a meaning in [symbols]")  # fmt: skip
    assert said == (
        "q1: x: 'a' is unknown; choose one of 'n0', 'n1', 'n2', 'n3', 'n4', 'n5' ...; "
        "or explain it on a line of its own: name = formula"
    )
    once = "h is explained twice; keep one, in front of the formula or in [symbols]"
    assert for_student(once) == "h is explained twice; keep one"


def test_no_name_is_told_that_the_student_did_not_type():
    """The half is forgotten; what the doctor makes of it must not be read back to the student."""
    for level in ("verdict", "place", "cause"):
        sheet = {"robot": "planar2r_rods", "questions": [{"id": "q1", "entry": "g2"}]}
        one = kl.mark(sheet, {"ada": {"q1": "m2*g*l2*c12"}}, feedback=level)["ada"]["q1"]
        assert "lc2" not in one.remark + one.place + one.cause


def test_nothing_is_said_of_numbers_that_a_student_has_not():
    rods = marked({"q1": "0.3333*m1*l1^2 + m2*(l1^2 + l2^2/3 + l1*l2*c2)"}, "planar2r_rods", "M11")
    assert rods["ada"]["q1"].right and "I1" not in rods["ada"]["q1"].remark
    assert "l1 = 0.5" in marked({"q1": "0.5*c1 + l2*c12"})["ada"]["q1"].remark
    assert "l1 = 0.5 and l2 = 0.4" in marked({"q1": "0.5*c1 + 0.4*c12"})["ada"]["q1"].remark


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"questions": []}, "缺少 questions"), ({"feedbck": 1}, "feedbck"), ({"questions": [{"id": "1a"}]}, "'1a'"),
        ({"slips": {"sgn": 1}}, "sgn"), ({"questions": [{"id": "q1", "entry": "x", "points": "4"}]}, "points"),
        ({"questions": [{"id": "q1", "entry": "x", "points": -4}]}, "points"), ({"robot": None}, "robot"),
    ],
)  # fmt: skip
def test_errors_of_a_sheet_are_told_in_chinese(changes, message):
    document = {"robot": "planar2r", "questions": [{"id": "q1", "entry": "x"}], **changes}
    with speaking("zh"), pytest.raises(SheetError) as found:
        sheet_of(document, "s.toml")
    said = str(found.value)
    assert message in said and any("\u4e00" <= c <= "\u9fff" for c in said)
    assert "NoneType" not in said and " is str" not in said


# -------- Pages

SHEET = {
    "robot": "scara",
    "feedback": "answer",
    "questions": [
        {"id": "q1", "entry": "J"},
        {"id": "q2", "entry": "det"},
        {"id": "q3", "entry": "x"},
    ],
}
J = "[-a1*s1 - a2*s12, -a2*s12, 0, 0; a1*c1 + a2*c12, a2*c12, 0, 0; 0, 0, -1, 0; 1, 1, 0, 1]"


def test_a_matrix_stands_in_rows_and_what_is_right_is_typeset():
    answers = {"q1": J, "q2": "-a1*a2*s2", "q3": r"$x = a_1 c_1 + a_2 s_{12}$"}
    marks = kl.mark(SHEET, {"ada": answers})
    page = student_page(marks, marks["ada"])
    assert page.count("<mtr>") == 4 and "det" in page
    assert r"\cos" not in page and "s_{12} should" not in page
    assert page.count("<math") == 3 + 3
    shown = page.split("</style>")[1]
    assert "**" not in shown and "((1)" not in shown


def test_exponents_stand_behind_indices():
    (text,) = pictures_of([("M", "l_{1}^{2}")])
    assert "msubsup" not in text and text.count("<msup") == 1 == text.count("<msub")


def test_the_classs_page_keeps_slips_from_what_could_not_be_read(tmp_path):
    given = {
        "ada": {"q3": "a1*c1 - a2*c12"}, "bob": {"q3": "a1*c1 - a2*c12"}, "eve": {"q3": "a1*("},
        "dan": {"q3": "7*a1"}, "fay": {"q3": "a1*("}, "guy": {"q3": "a1*("},
    }  # fmt: skip
    marks = kl.mark({**SHEET, "feedback": "cause"}, given)
    assert {kind for _question, kind in marks.slips()} == {"sign", "unknown"} | {
        kind for _question, kind in marks.slips() if "unread" not in kind
    }
    page = class_page(marks)
    slips, unread = page.index(">Slips<"), page.index(">Could not be read<")
    assert slips < page.index("a sign is the other way") < unread
    assert "legend" in page and "<th>name</th>" not in page
    assert "0–0.3" in page and "2.7–3" in page
    tones = {"is-right", "is-wrong", "is-unread", "is-none"}
    assert all(f'class="{tone}"' in page for tone in tones)
    named = kl.mark(SHEET, {"ada": {"name": "Ada L"}})
    assert "<th>name</th>" in class_page(named)


def test_a_student_without_an_answer_is_not_told_of_random_states():
    marks = kl.mark(SHEET, {"ada": {}, "bob": {"q3": "a1*c1 + a2*c12"}})
    assert "random states" not in student_page(marks, marks["ada"])
    assert "random states" in student_page(marks, marks["bob"])


@pytest.mark.parametrize(("page", "language"), [("howto", "en"), ("zh/howto", "zh")])
def test_the_guide_lists_every_slip_and_every_language_has_one(page, language):
    text = (DOCS / page / "mark_homework.md").read_text(encoding="utf-8")
    with speaking(language):
        missing = [kind for kind, said in KINDS.items() if f"| `{kind}` | {_(said)} |" not in text]
    assert not missing


def test_the_guides_labels_are_read():
    """Each label in the guide's table is one, of the first question or of 1a."""
    text = (DOCS / "howto" / "mark_homework.md").read_text(encoding="utf-8")
    rows = text.split("| label | is read as |")[1].split("\n\n")[0].splitlines()[2:6]
    asked = [{"id": "q1", "entry": "x"}, {"id": "q1a", "entry": "y"}]
    labels = SheetLabels(sheet_of({"robot": "planar2r", "questions": asked}, "s"))
    found = [one for row in rows for one in re.findall(r"`([^`]+)`", row.split(" | ")[0])]
    assert len(found) > 20
    for label in found:
        got = labels.of(f"{label}" if label.startswith("#") else f"{label} x = l1")
        assert got is not None and got.question.id == ("q1a" if "1a" in label else "q1"), label
