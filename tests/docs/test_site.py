"""The site's pages: what must be there is there, and every public name has its entry."""

from __future__ import annotations

import inspect
import re
import sys
from collections import Counter

import pages
import pytest

import kinlab as kl

sys.path.insert(0, str(pages.DOCS / "_ext"))

import command_pages
import note_pages
import reference_pages
from made_pages import write_if_changed

SOURCES = sorted(
    page
    for page in pages.DOCS.rglob("*.md")
    if not {"_build", "generated"} & set(page.relative_to(pages.DOCS).parts)
)
NAMES = sorted(reference_pages.public_names())


def test_every_public_name_has_one_entry():
    entries = Counter(name for topic in reference_pages.TOPICS for name in topic.names)
    assert set(entries) == set(NAMES), "mend TOPICS in docs/_ext/reference_pages.py"
    assert set(entries.values()) == {1}
    # not what the page says of itself: what the package offers
    offered = {name for name in kl.__all__ if not inspect.ismodule(getattr(kl, name))}
    assert offered - {"__version__"} <= set(entries)


@pytest.mark.parametrize("name", NAMES)
def test_public_name_says_what_it_is(name):
    thing = reference_pages.found(name)
    if not (inspect.isclass(thing) or inspect.isfunction(thing)):
        return
    assert inspect.getdoc(thing)
    members = vars(thing).items() if inspect.isclass(thing) else ()
    silent = [
        key
        for key, member in members
        if not key.startswith("_")
        and (
            isinstance(member, (property, classmethod, staticmethod)) or inspect.isfunction(member)
        )
        and not inspect.getdoc(member)
    ]
    assert silent == []


def test_reference_is_written_with_the_records_that_answer(tmp_path):
    reference_pages.write(tmp_path)
    written = {page.stem: page.read_text() for page in (tmp_path / "reference").rglob("*.rst")}
    everything = "\n".join(written.values())
    for name in NAMES:
        kind = "autoexception|autoclass|autofunction|autodata"
        assert (
            len(re.findall(rf"^\.\. (?:{kind}):: kinlab\.{re.escape(name)}$", everything, re.M))
            == 1
        )
    for record in ("IKResult", "IKBranches", "SingularitySearch", "Evidence", "MotorFit"):
        assert (
            len(re.findall(rf"^\.\. autoclass:: kinlab\.[\w.]+\.{record}$", everything, re.M)) == 1
        )
    listed = (pages.DOCS / "reference" / "index.md").read_text()
    assert set(re.findall(r"^generated/(\w+)$", listed, re.M)) == {*written, "commands"}


def test_every_command_has_its_place_with_its_options():
    text = command_pages.page()
    named = re.findall(r"^## `kinlab ([^`]+)`$", text, re.MULTILINE)
    assert {"check", "list", "view", "fivebar size"} <= set(named)
    assert len(named) == len(set(named))
    for option in ("--against", "--report", "--json", "--lang"):
        assert f"`{option}`" in text


def test_page_that_stands_already_is_left_alone(tmp_path):
    page = tmp_path / "folder" / "page.md"
    write_if_changed(page, "one")
    before = page.stat().st_mtime_ns
    write_if_changed(page, "one")
    assert page.stat().st_mtime_ns == before
    write_if_changed(page, "two")
    assert page.read_text() == "two"


@pytest.mark.parametrize("page", SOURCES, ids=lambda page: str(page.relative_to(pages.DOCS)))
def test_links_between_sources_lead_somewhere(page):
    text = re.sub(r"```.*?```|`[^`]*`", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    links = re.findall(r"\]\(<?([^)\s>]+)>?\)", text)
    for link in links:
        path = link.partition("#")[0]
        if not path or "://" in path or path.startswith("mailto:") or "generated/" in path:
            continue
        assert (page.parent / path).exists(), link


def test_sources_have_one_title_and_no_place_of_a_machine():
    for page in SOURCES:
        text = page.read_text(encoding="utf-8")
        bare = re.sub(r"^(`{3,}).*?^\1", "", text, flags=re.DOTALL | re.MULTILINE)
        assert len(re.findall(r"^# ", bare, re.MULTILINE)) == 1, page
        assert not re.search(r"/(?:home|root|Users|work)/", text), page


def test_note_page_shows_each_formula_with_its_verdict():
    from kinlab.check.catalogue import catalogue, plan, run
    from kinlab.check.report.summary import grouped

    formulas = [one for one in catalogue() if one.note == "001"]
    groups = grouped(run(plan(formulas, lambda name: name in ("planar2r", "puma560")), samples=20))
    english, chinese = note_pages.languages()
    text = note_pages.page("001", groups, english)
    shown = re.findall(r"^### `([^`]+)`", text, re.MULTILINE)
    assert sorted(shown) == sorted(one.key for one in formulas)
    wrong = {one.key for one in formulas if one.printed is not None}
    assert {"001.tau1", "001.L"} <= wrong
    listed = text.partition("## Misprints of this note")[2].partition("\n## ")[0]
    assert set(re.findall(r"\[`([^`]+)`\]", listed)) == wrong
    assert text.count("**Misprint") == len(wrong)
    assert text.count("**Agrees.**") == len(formulas) - len(wrong)
    assert text.count('class="form printed') == len(wrong)
    with chinese:
        other = note_pages.page("001", groups, chinese)
    labels = [set(re.findall(r"^\((.*)\)=$", one, re.MULTILINE)) for one in (text, other)]
    assert len(labels[0]) == len(labels[1]) == len(formulas)
    assert not labels[0] & labels[1]  # one label names one place of the whole site
    assert other.count("**笔误") == len(wrong)
    assert not re.search(r"Misprint|Agrees|Largest", other)
