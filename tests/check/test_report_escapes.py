"""Text of files in reports: Markdown shows its characters, pages have a policy. Judge: a CommonMark
reader that lets HTML through, and an HTML parser."""

from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from fivebars import random_fivebar
from hypothesis import given
from hypothesis import strategies as st
from markdown_it import MarkdownIt

import kinlab as kl
from kinlab.check.catalogue import plan, run
from kinlab.check.report.markdown_text import block, code, formula, words
from kinlab.check.report.write import write_report
from kinlab.doctor.tables.report import write_table_report
from kinlab.viewer.against import against_scene
from kinlab.viewer.scene import FiveBarScene, Scene

READER = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])
HOSTILE = [
    "</h1><script>alert(1)</script>", "<img src=x onerror=alert(1)>", "[x](javascript:alert(1))",
    "![x](http://evil.example/x.png)", "`</code><script>alert(1)</script>", "a | b\n# c", "&lt;b&gt;",
    "```\n<script>alert(1)</script>", "*a* __b__ ~~c~~ $d$", "\\<b>", "1. x", "1) x", "- x", "---",
    "x\n===", "<!-- x", "<javascript:alert(1)>", "\x1b[31mred", "_a_ b_c", "> x", "\u202e x", "``x`",
]  # fmt: skip
ANY = (
    st.text(st.sampled_from("ab 1.)#+-=*_`[]()!<>&|~$\\\n\t:/é\x1b\u00a0"), max_size=30) | st.text()
)


class _Read(HTMLParser):
    """The tags and the text of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.text = ""
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        assert not [name for name, _ in attrs if name.startswith("on")]

    def handle_data(self, data):
        self.text += data


def _line(text: str) -> str:
    kept = re.sub("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff]", "\ufffd", text)
    return " ".join(kept.split())


@given(ANY)
def test_words_are_shown_as_they_are(text):
    read = _Read(READER.render(words(text)))
    assert read.text.strip() == _line(text)
    assert set(read.tags) <= {"p"}


@given(ANY)
def test_words_in_a_cell_a_heading_and_bold(text):
    page = f"# a {words(text)} b\n\n**a {words(text)} b**\n\n| x | y |\n|---|---|\n| {words(text)} | z |\n"
    read = _Read(READER.render(page))
    assert read.tags == [
        "h1",
        "p",
        "strong",
        "table",
        "thead",
        "tr",
        "th",
        "th",
        "tbody",
        "tr",
        "td",
        "td",
    ]
    assert read.text.split() == f"a {_line(text)} b a {_line(text)} b x y {_line(text)} z".split()


@given(ANY)
def test_code_is_shown_as_it_is(text):
    read = _Read(READER.render(f"a {code(text)} b"))
    assert read.tags == ["p", "code"]
    assert read.text.split() == f"a {_line(text)} b".split()


@given(ANY)
def test_a_block_ends_where_it_should(text):
    read = _Read(READER.render(block(text, "toml") + "\n\nend"))
    assert read.tags == ["pre", "code", "p"]
    assert read.text.split()[-1] == "end"


@pytest.mark.parametrize(
    "latex",
    [*HOSTILE, r"\text{<script>alert(1)</script>}", r"\href{javascript:alert(1)}{x}", "a$$<script>",
     "a < b > c", "[a](javascript:alert(1))", r"\text{`}"],
)  # fmt: skip
def test_a_formula_is_mathematics_or_shown(latex):
    made = formula(latex)
    read = _Read(READER.render(made))
    assert set(read.tags) <= {"p", "code", "em"}  # a viewer without formulas may slant a * b *
    if made.startswith("$$"):
        assert "href" not in made
        assert made.count("$") == 4


def test_sound_formulas_stay_formulas():
    assert formula(r"\frac{a}{b} < c") == r"$$\frac{a}{b} \lt  c$$"


@pytest.mark.parametrize("text", HOSTILE)
def test_a_check_in_markdown_holds_no_tag_of_the_file(text, tmp_path):
    @kl.hand_formula("gravity_torques", robot="single_link", source=text, latex=text)
    def weight(q):
        return q

    write_report(tmp_path / "a.md", list(run(plan(weight.formulas), samples=3)))
    _harmless(READER.render((tmp_path / "a.md").read_text(encoding="utf-8")))


def _harmless(page: str) -> None:
    read = _Read(page)
    assert not set(read.tags) & {"script", "img", "svg", "iframe", "a", "b"}
    assert "javascript:" not in "".join(re.findall(r"<[^>]*>", page))


@pytest.fixture(scope="module")
def diagnosis():
    table = kl.load("planar2r").table
    assert table is not None
    mine = replace(table, links=[replace(table.links[0], alpha=0.5), *table.links[1:]])
    found = kl.diagnose_table(mine, table)
    assert found.causes and found.repaired is not None
    return found


@pytest.mark.parametrize("text", HOSTILE)
def test_reports_of_tables_hold_no_tag_of_the_file(diagnosis, text, tmp_path):
    mine, repaired = (replace(one, source=text) for one in (diagnosis.mine, diagnosis.repaired))
    told = {"reference": text, "sentence": text, "evidence": (text,), "notes": (text,)}
    found = replace(diagnosis, mine=mine, repaired=repaired, **told)
    for suffix in ("md", "html"):
        write_table_report(tmp_path / f"t.{suffix}", [found])
    _harmless(READER.render((tmp_path / "t.md").read_text(encoding="utf-8")))
    page = (tmp_path / "t.html").read_text(encoding="utf-8")
    _harmless(re.sub(r"<b>[-\d.]+( deg)?</b>", "", page))
    read = _Read(page)
    assert _line(text) in _line(read.text)


def test_every_page_has_one_policy_in_front_of_style_and_script(diagnosis, tmp_path):
    robot = kl.load("planar2r")

    @kl.hand_formula("gravity_torques", robot="single_link")
    def weight(q):
        return q

    write_report(tmp_path / "check.html", list(run(plan(weight.formulas), samples=3)))
    write_table_report(tmp_path / "table.html", [diagnosis])
    Scene(robot).save(tmp_path / "view.html")
    against_scene(diagnosis.mine, robot.table).save(tmp_path / "against.html")
    (tmp_path / "live.html").write_text(Scene(robot).html(live="1"), encoding="utf-8")
    FiveBarScene(random_fivebar(np.random.default_rng(3))).save(tmp_path / "five.html")
    pages = sorted(tmp_path.glob("*.html"))
    assert len(pages) == 6
    for file in pages:
        page = file.read_text(encoding="utf-8")
        [policy] = re.finditer(
            '<meta http-equiv="Content-Security-Policy" content="([^"]*)">', page
        )
        assert "default-src 'none'" in policy[1] and "base-uri 'none'" in policy[1]
        scripts = dict(rule.split(" ", 1) for rule in policy[1].split("; "))["script-src"]
        assert "unsafe" not in scripts and "*" not in scripts, file.name
        assert policy.start() < page.index("<style"), file.name
        assert policy.start() < page.index("<title"), file.name


def test_no_page_is_begun_but_by_the_two_templates():
    """Whatever writes a page begins it with a document type: the places are known."""
    house = Path(kl.__file__).parent
    begun = {
        file.relative_to(house).as_posix()
        for file in house.rglob("*")
        if file.suffix in (".py", ".j2", ".html", ".js")
        and re.search(r"<!doctype html|<html", file.read_text(encoding="utf-8"), re.IGNORECASE)
    }
    assert begun == {"check/report/base.html.j2", "viewer/page/static_page.py"}
    for name in begun:
        assert "{policy}" in (house / name).read_text(encoding="utf-8").replace("{ ", "{").replace(
            " }", "}"
        )
