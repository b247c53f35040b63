"""The doctor in Chinese: the same diagnoses, and no English sentence in what is said."""

from __future__ import annotations

import ast
import math
import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest
import sentences

import kinlab as kl
from kinlab.check.diagnosis import shown_entry
from kinlab.doctor.confusions.known import readings
from kinlab.doctor.derivations.books.lines import LINES as BOOKS
from kinlab.doctor.derivations.roads import roads
from kinlab.doctor.derivations.steps import steps
from kinlab.doctor.examine import prepare
from kinlab.doctor.marking.handout import handout
from kinlab.doctor.marking.sheet import read_sheet, sheet_of
from kinlab.doctor.marking.words import KINDS, OTHERS
from kinlab.doctor.report import of_document
from kinlab.doctor.solutions.closed_forms import LINES as CLOSED
from kinlab.doctor.tables.report import page, text
from kinlab.doctor.text.line import brief
from kinlab.host.language import _, language, speaking

LINES = (*BOOKS, *CLOSED)
PUMA, PANDA = kl.load("puma560").table, kl.load("panda").table

ENGLISH = re.compile(
    r"(?<![\w.\[(*/+-])(?:[A-Za-z]{2,}[,:;.]? +[A-Za-z]{3,}|[A-Za-z]{3,}[,:;.]? +[A-Za-z]{2,})"
)
"""Two English words beside each other, not both of two letters (Jw Jw) nor in a formula."""
CHINESE = re.compile("[\u4e00-\u9fff]")


def english(said):
    """The lines with words of English; quoted names and what a table of the user holds left out."""
    said = re.sub(r"```toml.*?```", "", said, flags=re.DOTALL)
    return [line for line in re.sub(r"'[^'\n]*'", "''", said).splitlines() if ENGLISH.search(line)]


def row(table, i, **cells):
    links = list(table.links)
    links[i - 1] = replace(links[i - 1], **cells)
    return replace(table, links=links)


def judged(robot, **formulas):
    found, unread = of_document({"robot": robot, "formulas": formulas}, "f.toml")
    assert not unread
    return found


def diagnosed(robot, quantity, function):
    return [kl.diagnose(robot, quantity, function, samples=20)]


def tables(mine, against):
    return [kl.diagnose_table(mine, against)]


CASES = {
    "a sign": lambda: judged("planar2r", x="l1*cos(q1) - l2*cos(q1 + q2)"),
    "an angle": lambda: judged("planar2r", y="l1*sin(q1) + l2*sin(q2)"),
    "a square": lambda: judged("planar2r", M12="m2*l2 + m2*l1*l2*cos(q2)"),
    "two slips": lambda: judged("planar2r", M11="m1*l1 + m2*(l1**2 + l2**2 + l1*l2*cos(q2))"),
    "unknown": lambda: judged("planar2r", V="m1*exp(q1) + 3*l1"),
    "right, rounded": lambda: judged("planar2r", g2="m2*9.8*l2*cos(q1 + q2)"),
    "right, unusual": lambda: judged(
        "planar2r", V="m1*g*l1*sin(q1) + m2*g*(l1*sin(q1) + l2*sin(q1 + q2)) + 3"
    ),
    "right here only": lambda: judged("planar2r", x="0.5*cos(q1) + l2*cos(q1 + q2)"),
    "degrees": lambda: diagnosed(
        "planar2r", "fk", lambda q: kl.fk(kl.load("planar2r"), np.deg2rad(q))
    ),
    "gravity": lambda: diagnosed(
        "planar2r", "gravity_torques", lambda q: -kl.gravity_torques(kl.load("planar2r"), q)
    ),
    "a frame": lambda: diagnosed(
        "planar2r", "jacobian", lambda q: kl.jacobian(kl.load("planar2r"), q, "tool")
    ),
    "coefficients": lambda: diagnosed(
        "planar2r",
        "gravity_torques",
        lambda q: kl.gravity_torques(kl.load("planar2r"), q) + [0.3 * math.cos(q[0]) + 0.2, 0.0],
    ),
    "a cell": lambda: tables(row(PUMA, 3, alpha=math.pi / 2), PUMA),
    "exchanged": lambda: tables(row(PUMA, 2, a=PUMA.links[1].d, d=PUMA.links[1].a), PUMA),
    "a body": lambda: tables(row(PANDA, 4, com=-np.asarray(PANDA.links[3].com)), PANDA),
    "not the arm": lambda: tables(
        row(row(row(PUMA, 1, alpha=0.3), 2, a=0.77), 3, d=0.9), PUMA
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_diagnosis_is_the_same_in_chinese_and_has_no_english_sentence(name):
    before = CASES[name]()
    with speaking("zh"):
        found = CASES[name]()
        said = [str(one) for one in found]
        said += [line for one in found for line in (one.sentence, *one.evidence)]
    for one in said:
        assert CHINESE.search(one) and not english(one), one
    assert any(ENGLISH.search(str(one)) for one in before)
    for one, two in zip(before, found, strict=True):
        assert one.verdict == two.verdict and one.agrees == two.agrees
        assert _kinds(one) == _kinds(two)
        assert len(one.sentence.splitlines()) == len(two.sentence.splitlines())


def _kinds(found):
    plain = ("kinds", "kind", "places", "row", "column", "corrected")
    return [[getattr(cause, name, None) for name in plain] for cause in found.causes]


def test_reports_of_tables_are_chinese():
    found = tables(row(PUMA, 3, alpha=math.pi / 2), PUMA)
    with speaking("zh"):
        shown = re.sub(r"<style.*?</style>|<pre>.*?</pre>", "", page(found), flags=re.DOTALL)
        pages = [text(found), re.sub(r"<[^>]*>", "\n", shown)]
    for one in pages:
        body = one[: one.rindex("kinlab")].rpartition("\n")[0]  # the footer is of every report
        assert "对照" in body or "对" in body
        assert not [line for line in english(body) if "row 3" not in line]


# -------- every sentence that can be said


def taken_otherwise(robot, *quantities):
    """Every step of the derivations of a robot's quantities, at all joints."""
    for name in quantities:
        case = prepare(robot, name, (), 10, 0)[0].few(2)
        for road in roads(case):
            axes = road.walked([()], case.arguments)[1].axes
            assert {line.about for line in road.of.lines} - {""} <= {*LINES}
            yield from steps(road.of, axes, road.n, False)


_STEPS = [
    lambda: [*taken_otherwise("stanford", "inverse_dynamics")],
    lambda: [*taken_otherwise("planar2r", "inverse_dynamics", "jacobian", "fk", "lagrangian")],
    lambda: [*taken_otherwise("puma560_modified", "fk", "link_velocities")],
    lambda: [*taken_otherwise("doggo_leg", *_FIVE_BAR)],
    lambda: [
        s
        for robot, quantities in _READ.items()
        for name in quantities
        for s in readings(prepare(robot, name, (), 10, 0)[0])
    ],
]
_FIVE_BAR = ("fivebar_torque_massless", "fivebar_rate_per_speed")
_READ = {
    "puma560": ("fk", "jacobian", "statics", "inverse_dynamics"),
    "stanford": ("mass_matrix", "coriolis_matrix", "gravity_torques"),
}


@pytest.mark.parametrize("group", range(len(_STEPS)))
def test_everything_that_may_be_taken_otherwise_is_said_in_chinese(group):
    with speaking("zh"):
        found = _STEPS[group]()
        for one in found:
            assert CHINESE.search(one.sentence) and not english(one.sentence), one.sentence
    assert len(found) > 40


def test_every_kind_of_slip_has_its_name():
    kinds = {one.kind for group in _STEPS for one in group()}
    assert kinds <= {*KINDS, *OTHERS} and not {*KINDS} & {*OTHERS}
    with speaking("zh"):
        for kind in (*KINDS, *OTHERS):
            assert CHINESE.search(_(kind)), kind
        for told in KINDS.values():
            assert CHINESE.search(_(told)) and not english(_(told))


LEFT_ENGLISH = {
    "known.py": (" left out",),
    "words.py": (
        "radians for degrees", "digits exchanged", "the acceleration of the centre of mass",
        "dv dvc", "Jv Jw", "crank rod", "ct st", "sa ca", "qd qdd",
    ),
    "steps.py": (
        "beta psi", "px py", "late early", "later earlier", "dv dvc", "Jv Jw", "crank rod", "ct st", "sa ca", "qd qdd",
        "the acceleration of the centre of mass",
    ),
    "handout.py": ("student id",), "lines.py": ("the angle q",),
    "judge.py": ("the sheet's",), "own_answer.py": ("the sheet's",),
    "submission.py": ("student id", "student number", "student no", "student name", "full name", "matriculation number"),
    "questions.py": ("left side",),
    "child.py": ("processor time", "files read", "files written", "open files", "core dumps"),
    "body_slips.py": ("other end",),
    "rows.py": ("too many", "left out"),
    "readings.py": (
        "metres for millimetres", "radians for degrees", "tool to base", "base to tool",
        "base, tool", "tool, base", "degrees and millimetres", "radians and metres",
    ),
    "against.py": (
        "; of a URDF name the tool where that chain ends", ", and no joint name in common",
        "; compare descriptions of the same joints",
    ),
    "poses.py": (
        "q1 ... qn and then T11 ... T34, or x, y, z, roll, pitch, yaw, or x, y, z, qx, qy, qz, qw",
    ),
}  # fmt: skip
"""Names of cells, units and headings of files, and what errors say."""


_ABOUT = re.compile(r"^ *# (.*)$", re.MULTILINE)


def test_every_sentence_of_the_doctor_is_marked():
    names = {*KINDS, *OTHERS}  # a kind is a name in the code, translated where it is shown
    files = [*(sentences.PACKAGE / "doctor").rglob("*.py")]
    files += [sentences.PACKAGE / part for part in ("check/diagnosis.py", "cli/mark.py")]
    wrong = []
    for file in sorted(files):
        left = {*names, *LEFT_ENGLISH.get(file.name, ())}
        found = sentences.unmarked(ast.parse(file.read_text(encoding="utf-8")))
        inside = file.relative_to(sentences.PACKAGE).as_posix()
        for line, said in found:
            if "\n" in said and (_ABOUT.search(said) or said.startswith("for ")):
                # a derivation: what its lines are called stands in the comments
                assert {about.strip() for about in _ABOUT.findall(said)} <= {*LINES}, inside
            elif said not in left:
                wrong.append(f"{inside}:{line}: {said!r}")
    assert not wrong, "mark it with _ or N_ (kinlab.host.language):\n" + "\n".join(wrong)
    assert len(files) > 40


# -------- marking

SHEET = {
    "title": "作业三", "robot": "planar2r", "feedback": "answer", "slips": {"sign": 0.25},
    "questions": [
        {"id": "q1", "text": "关节 1 的重力矩", "entry": "g1", "points": 4},
        {"id": "q2", "text": "M12", "entry": "M12", "points": 2},
        {"id": "q3", "text": "末端的 x 坐标", "answer": "l1*c1 + l2*c12"},
        {"id": "q4", "text": "雅可比矩阵", "quantity": "planar_jacobian"},
    ],
}  # fmt: skip
CLASS = {
    "ada": {
        "q1": "m1*g*l1*cos(q1) - m2*g*(l1*cos(q1) + l2*cos(q1 + q2))", "q2": "m2*l2**2",
        "q3": "-l1*c1 - l2*c12", "q4": {"J11": "-l1*s1 - l2*s12"},
    },
    "bob": {"q1": "g1 = 2*m1*g", "q3": "tau2 = 3*q1", "q4": {"J11": "l1*s1", "J12": "l2"}},
    "eve": 3,
}  # fmt: skip


def test_marks_and_their_pages_are_chinese(tmp_path):
    before = kl.mark(SHEET, CLASS)
    with speaking("zh"):
        marks = kl.mark(SHEET, CLASS, tmp_path)
        said = [str(marks), *map(str, marks.marks), marks._repr_html_()]
    assert [m.total for m in marks.marks] == [m.total for m in before.marks]
    assert [[o.kinds for o in m.outcomes] for m in marks.marks] == [
        [o.kinds for o in m.outcomes] for m in before.marks
    ]
    for file in [*tmp_path.rglob("*.html")]:
        shown = re.sub(
            r"<(style|math).*?</\1>|<meta[^>]*>", "", file.read_text("utf-8"), flags=re.S
        )
        said.append(re.sub(r"<[^>]*>", "\n", shown))
    assert len(said) > 7
    for one in said:
        assert CHINESE.search(one) and not english(one), english(one)


def test_a_handout_is_chinese_and_can_be_read():
    sheet = sheet_of({**SHEET, "variation": {"seed": 3}}, "sheet")
    with speaking("zh"):
        given = handout(sheet, "小明")
    assert not english(given) and "参数" in given
    assert tomllib.loads(given)["student"] == "小明"


def test_marks_of_another_language_are_made_anew(tmp_path):
    sheet, folder, output = tmp_path / "s.toml", tmp_path / "in", tmp_path / "out"
    sheet.write_text(
        'robot = "planar2r"\nfeedback = "cause"\n[[questions]]\nid = "q1"\nentry = "x"\n', "utf-8"
    )
    folder.mkdir()
    (folder / "ada.txt").write_text("student: ada\nx = l1*c1 - l2*c12\n", "utf-8")
    first = kl.mark(read_sheet(sheet), folder, output, workers=1)
    with speaking("zh"):
        second = kl.mark(read_sheet(sheet), folder, output, workers=1)
    assert english(first["ada"]["q1"].cause) and CHINESE.search(second["ada"]["q1"].cause)
    assert language() == "en"


# -------- how things are named


def test_entries_are_named_as_people_write_them():
    told = {
        "inverse_dynamics[0]": "tau1", "mass_matrix[0,1]": "M12", "fk[1,3]": "T24",
        "christoffel[0,1,2]": "christoffel(1,2,3)", "fk": "fk", "fk[:3,3]": "fk[:3,3]", "x": "x",
    }  # fmt: skip
    assert {label: shown_entry(label) for label in told} == told


def test_no_piece_of_a_formula_is_longer_than_a_line():
    long = " + ".join(f"m{i}*l{i}**2*cos(q{i})*qdd{i}" for i in range(1, 12))
    assert len(brief(long)) <= 90 and brief(long).startswith("m1*l1**2*cos(q1)*qdd1")
    assert brief(long).endswith("qdd11") and " ... " in brief(long)
    assert brief("l1*cos(q1)") == "l1*cos(q1)"
    product = "*".join(f"cos(q{i})" for i in range(30))
    assert len(brief(product)) <= 90


def test_a_constant_that_is_off_is_called_the_constant_term():
    [found] = diagnosed(
        "planar2r", "fk[0,3]", lambda q: kl.fk(kl.load("planar2r"), q)[0, 3] + 0.125
    )
    assert "the constant term is larger than the engine's by 0.125" in found.sentence
    assert found.sentence.startswith("T14: ") and "coefficient of 1" not in str(found)
