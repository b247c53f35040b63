"""The reports: self-contained, every formula typeset, the difference marked, nothing escaped."""

from __future__ import annotations

import re
from html.parser import HTMLParser

import numpy as np
import pytest
from lxml import etree

import kinlab as kl
from kinlab.check.catalogue import catalogue, plan, run
from kinlab.check.report.words import HIGH, LOW, decades, svg
from kinlab.check.report.write import check_report_path, write_report
from kinlab.errors import FileError
from kinlab.formulas.typeset import mathml, plain


@pytest.fixture(scope="module")
def rows():
    wanted = ("000.dh", "000.Jframe", "001.tau1", "001.tau2", "002.C", "000.R")
    formulas = [f for f in catalogue() if f.id in wanted]
    return list(run(plan(formulas), samples=10))


def test_page_is_whole_and_needs_no_network(rows, tmp_path):
    write_report(tmp_path / "check.html", rows)
    page = (tmp_path / "check.html").read_text(encoding="utf-8")
    assert page.startswith("<!DOCTYPE html>") and page.rstrip().endswith("</html>")
    policy = re.findall(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', page)
    assert len(policy) == 1
    assert "default-src 'none'" in policy[0]
    assert "script-src 'none'" in policy[0]
    page = page.replace(policy[0], "")
    links = re.findall(r"""(?:src|href|url\()\s*=?\s*["']?([^"')\s>]+)""", page)
    assert all(link.startswith("#") for link in links), links
    outside = set(re.findall(r"https?://[^\s\"<]+", page))
    assert outside == {"http://www.w3.org/1998/Math/MathML"}
    assert "<script" not in page

    class Balance(HTMLParser):
        open: list[str] = []  # noqa: RUF012

        def handle_starttag(self, tag, attrs):
            if tag not in ("meta",):
                self.open.append(tag)

        def handle_startendtag(self, tag, attrs):
            pass

        def handle_endtag(self, tag):
            assert self.open.pop() == tag

    parser = Balance()
    parser.feed(page)
    assert parser.open == []


def test_page_shows_both_forms_marked_and_the_verdict(rows, tmp_path):
    write_report(tmp_path / "check.html", rows)
    page = (tmp_path / "check.html").read_text(encoding="utf-8")
    card = page.split('id="001.tau1"')[1].split("</article>")[0]
    assert card.count("<math") == 2
    assert card.index("printed</figcaption>") < card.index("corrected</figcaption>")
    assert 'class="wrong"' in card and 'class="fixed"' in card
    assert "m2 l2² is counted twice" in card and "<svg" in card
    plain_card = page.split('id="001.tau2"')[1].split("</article>")[0]
    assert plain_card.count("<math") == 1 and "Agrees." in plain_card
    assert "no value" in page.split('id="000.Jframe:singular"')[1].split("</article>")[0]


def test_markdown_has_every_formula_and_every_robot(rows, tmp_path):
    write_report(tmp_path / "check.md", rows)
    text = (tmp_path / "check.md").read_text(encoding="utf-8")
    for row in rows:
        assert f"### `{row.formula.key}`" in text and f"| {row.robot} |" in text
    assert r"\textcolor{red}{m_2 l_2^2 + m_2 l_2^2}" in text
    assert r"\wrong" not in text and r"\fixed" not in text
    assert text.count("$$") % 2 == 0


def test_every_formula_is_typeset_to_sound_mathml():
    for record in catalogue():
        for latex in (record.latex, record.printed.latex if record.printed else "x"):
            text = mathml(latex)
            root = etree.fromstring(text.encode())
            assert etree.QName(root).localname == "math"
            assert not [e for e in root.iter() if e.text and "\\" in e.text], (record.key, latex)
            marks = latex.count(r"\wrong{") + latex.count(r"\fixed{")
            found = [e for e in root.iter() if e.get("class") in ("wrong", "fixed")]
            assert len(found) == marks, record.key


def test_latex_that_cannot_be_read_is_shown_as_written():
    assert mathml(r"\frac{1}{") == r"<code>\frac{1}{</code>"
    assert plain(r"\wrong{x} \fixed{y}") == r"\textcolor{red}{x} \textcolor{green}{y}"


def test_histogram_counts_every_state():
    errors = np.array([0.0, 1e-20, 3e-16, 2e-9, 0.5, 7.0, np.inf])
    counts = decades(errors)
    assert counts.sum() == len(errors) and len(counts) == HIGH - LOW
    assert counts[0] == 2 and counts[-16 - LOW] == 1 and counts[-9 - LOW] == 1
    assert counts[-1] == 1
    picture = etree.fromstring(svg(errors[:3], errors[4:]))
    kinds = [e.get("class") for e in picture.iter("rect")]
    assert kinds.count("good") == 2 and kinds.count("bad") == 3


def test_a_users_text_is_escaped(tmp_path):
    @kl.hand_formula("gravity_torques", robot="single_link", source="<b>&</b>")
    def weight(q):
        """<script>alert(1)</script>."""
        return q

    write_report(tmp_path / "a.html", list(run(plan(weight.formulas), samples=3)))
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "<script>" not in page and "&lt;script&gt;" in page and "&lt;b&gt;&amp;" in page
    assert "Your formulas" in page and 'class="fails"' in page


def test_a_report_that_cannot_be_written_is_refused_before_the_work(tmp_path):
    with pytest.raises(FileError, match=r"a report ends in \.html or \.md"):
        check_report_path(tmp_path / "check.pdf")
    with pytest.raises(FileError, match="does not exist"):
        check_report_path(tmp_path / "nowhere" / "check.html")
    (tmp_path / "old.html").mkdir()
    with pytest.raises(FileError, match="is a folder"):
        write_report(tmp_path / "old.html", [])
