"""The report on paper: where a formula stands in its note, short cards, few pages."""

from __future__ import annotations

import html
import re

import pytest
from browser import chromium  # noqa: F401
from console import kinlab

from kinlab.check.catalogue import catalogue, plan, run
from kinlab.check.places import place_in_note, places, told_of
from kinlab.check.report.write import write_report
from kinlab.doctor.file import formula_document
from kinlab.doctor.report import of_document

MOST_PAGES = 12


@pytest.fixture(scope="module")
def rows():
    """Every formula of the notes, on one robot each: those that show a misprint if there is one."""
    first: dict[int, tuple] = {}
    for record, name in plan(catalogue()):
        shows = record.printed is not None and name in record.printed.robots
        if shows or id(record) not in first:
            first[id(record)] = (record, name)
    return list(run(first.values(), samples=2))


@pytest.mark.parametrize(
    ("key", "told"),
    [
        # counted by hand in the notes
        ("000.MVG:B", "“二、MVG形式”, formula 1, lines 235–238"),
        ("000.J3r", "“1. 定义”, formula 2, lines 62–67; “2. 速度推导”, in the text, lines 106–111"),
        ("001.tau1", "“2. 拉格朗日方程(Lagrange Method)”, formula 6.4, lines 133–139"),
        ("002.eomC", "“6. 构造科里奥利矩阵 C 以简化拉格朗日方程”, formula 19, lines 855–861"),
        ("003.ABC", "“Inverse Kinematics”, formula 1.2–1.3, lines 9–10"),
    ],
)
def test_a_formula_is_found_on_paper(key, told):
    assert place_in_note(next(r for r in catalogue() if key in (r.key, r.id))) == told


def test_every_formula_of_a_note_has_its_place():
    without = [r.key for r in catalogue() if not place_in_note(r)]
    assert without == []
    for one in places():
        assert one.heading and one.first <= one.last
        assert all(re.fullmatch(r"\d+(\.\d+)?", number) for number in one.formulas)


def test_the_compact_report_has_a_line_for_what_agrees(rows, tmp_path):
    for name in ("a.html", "a.md"):
        write_report(tmp_path / name, rows, compact=True)
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    line = re.search(r'<p class="line" id="001.tau2">.*?</p>', page, re.DOTALL)[0]
    assert "<math" not in line and "formula 7.4, lines 156–161" in line and "agrees" in line
    card = page.split('id="001.tau1"')[1].split("</article>")[0]
    assert card.count("<math") == 2 and "formula 6.4, lines 133–139" in card
    agree = {row.formula.key for row in rows if row.printed is None}
    lines = set(re.findall(r'<p class="line" id="([^"]*)">', page))
    assert lines == agree
    text = (tmp_path / "a.md").read_text(encoding="utf-8")
    (told,) = [line for line in text.splitlines() if line.startswith("`001.tau2`")]
    assert "lines 156–161; agrees: " in told and "### `001.tau2`" not in text


def test_the_four_notes_fit_on_twelve_pages(rows, chromium, tmp_path):  # noqa: F811
    """All of it: what is compact has a line where this has a card."""
    file = tmp_path / "notes.html"
    write_report(file, rows)
    page = chromium.new_page(viewport={"width": 718, "height": 1040})
    page.goto(file.as_uri())
    pdf = page.pdf(prefer_css_page_size=True)
    pages = len(re.findall(rb"/Type\s*/Page[^s]", pdf))
    assert 3 < pages <= MOST_PAGES
    page.emulate_media(media="print")
    cut = "e => e.scrollWidth > e.clientWidth + 1"
    cards = f"[...document.querySelectorAll('figure')].filter({cut})"
    assert page.evaluate(f"{cards}.map(e => e.closest('article').id)") == []
    page.close()


def test_only_misprints(tmp_path):
    done = kinlab(
        "check", "001", "--only", "misprints", "--samples", "5", "--report", "a.md", "--compact",
        cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0
    heads = re.findall("^### `(.*?)`", (tmp_path / "a.md").read_text(encoding="utf-8"), re.M)
    wanted = [r.key for r in catalogue() if r.note == "001" and r.printed is not None]
    assert heads == wanted and len(wanted) >= 3


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("001", "--only", "errors"), "only 'misprints'"),
        (("001", "--compact"), "name one with --report"),
        (("001.tau2", "--only", "misprints"), "there is none"),
        (("puma560", "--against", "puma560", "--only", "misprints"), "judges tables"),
    ],
)
def test_what_would_not_be_obeyed_is_refused(words, told):
    done = kinlab("check", *words)
    assert done.returncode == 2 and told in done.stderr


@pytest.mark.parametrize(
    ("written", "wanted", "other"),
    [
        ("m2*l1**2*c1**3 + s12*m1 + l1**3", r"c_{2}", r"\cos"),
        ("m2*l1**2*cos(th1)**3 + sin(th2)*m1 + l1**3", r"\cos(\theta_{2})", "q_"),
    ],
)
def test_what_should_be_keeps_the_notation(tmp_path, written, wanted, other):
    """A derived formula, where no slip explains the written one."""
    file = tmp_path / "mine.toml"
    file.write_text(f'robot = "planar2r"\n[formulas]\nM12 = "{written}"\n', encoding="utf-8")
    (found,), unread = of_document(formula_document(str(file)).document, str(file))
    assert not unread and not found.known
    ((_name, right),) = found.corrected
    assert wanted in right and other not in right


def test_a_formula_is_told_of_in_either_language():
    record = next(r for r in catalogue() if r.key == "001.v2")
    english, chinese = told_of(record), told_of(record, "zh")
    assert english["title"] == record.title == "Squared speed of the second mass"
    assert chinese["title"] == "第二个质点速度的平方" and chinese["source"] == "笔记 001，第 2 节"
    assert chinese["misprint"] == "2 d1 d2 误写成 2 d1 + d2"
    assert "第 4.1–4.3 式，第 71–94 行" in chinese["place"]
    assert set(english) == set(chinese) and bool(english["remark"]) == bool(chinese["remark"])


def test_the_chinese_report_says_nothing_in_english(rows, tmp_path):
    write_report(tmp_path / "a.html", rows, lang="zh")
    write_report(tmp_path / "b.html", rows)
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert '<html lang="zh-CN">' in page and "119 个公式" in page and "misprint:" not in page
    body = re.sub(r"<(math|code|svg)\b.*?</\1>", " ", page.split("<body>")[1], flags=re.DOTALL)
    text = html.unescape(re.sub("<[^>]*>", "\n", body))
    text = re.sub("“[^”]*”", "", text)  # the note's own heading
    # a name or two of formulas may stand beside each other, as in "d/dt dL"
    assert re.findall(r"[A-Za-z]{2,}(?: [A-Za-z]{2,}){2,}", text) == []
    english = (tmp_path / "b.html").read_text(encoding="utf-8")
    assert '<html lang="en">' in english and "every correct form agrees." in english
    assert not re.search("[一-鿿]", re.sub("“[^”]*”", "", english.split("<body>")[1]))
