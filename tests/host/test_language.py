"""The languages: which one is spoken, and that no sentence lacks its translation."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
import threading

import pytest
import sentences

from kinlab.errors import KinlabError, OptionError
from kinlab.host import language
from kinlab.host.language import _, all_speaking, ngettext, one_of_ours, read_catalogue, speaking

FOLDERS = [folder for folder in language.LANGUAGES.values() if folder]
LOCALES = ("KINLAB_LANG", "LC_ALL", "LC_MESSAGES", "LANG")

COVERED = (
    "check/catalogue.py",
    "check/compare.py",
    "check/diagnosis.py",
    "check/places.py",
    "check/report",
    "check/unread.py",
    "cli/__init__.py",
    "cli/against.py",
    "cli/analysis.py",
    "cli/analysis_tables.py",
    "cli/check.py",
    "cli/derive.py",
    "cli/fivebar",
    "cli/ik.py",
    "cli/mark.py",
    "cli/motion.py",
    "cli/robots.py",
    "cli/screen.py",
    "cli/view.py",
    "viewer",
)
"""Files and folders in which every sentence is marked."""

LEFT_ENGLISH: dict[str, tuple[str, ...]] = {
    # remedies at the end of errors
    "check/compare.py": ("the first ", " of its ", " rows are the quantity ", ", the last "),
    "check/report/words.py": ("random state",),
    "cli/analysis_tables.py": ("none needed",),
    "cli/check.py": ("bold red",),
    "cli/fivebar/design.py": ("LEAST LARGEST", "GOAL GOAL"),
    "cli/fivebar/sizing.py": ("bold yellow",),
    "cli/ik.py": ("kinlab ik",),
    # the page's own script
    "viewer/page/static_page.py": ("\nconst viewer = ",),
    # a name, by which it is drawn again; a warning
    "viewer/scene.py": ("the tool's way", ": the cranks stand at ", " rad: degrees?"),
}
"""Pieces of text with words in them that nobody reads as a sentence, by file."""


@pytest.fixture(scope="module")
def said():
    return sentences.sentences()


# -------- which language


@pytest.mark.parametrize(
    ("set_to", "spoken"),
    [
        ({}, "en"),
        ({"LANG": "zh_CN.UTF-8"}, "zh"),
        ({"LANG": "zh_CN.UTF-8", "LC_MESSAGES": "de_DE.UTF-8"}, "en"),
        ({"LANG": "en_GB.UTF-8", "LC_ALL": "zh_TW"}, "zh"),
        ({"LANG": "zh_CN.UTF-8", "LC_ALL": "C"}, "en"),
        ({"LANG": "zh_CN.UTF-8", "LC_ALL": ""}, "zh"),
        ({"LANG": "C.UTF-8", "KINLAB_LANG": "zh"}, "zh"),
        ({"LANG": "zh_CN.UTF-8", "KINLAB_LANG": "en"}, "en"),
        ({"LANG": "zh_CN.UTF-8", "KINLAB_LANG": "fr"}, "en"),
        ({"KINLAB_LANG": "zh-Hans"}, "zh"),
    ],
)
def test_the_language_is_ours_or_the_locale_s(monkeypatch, set_to, spoken):
    for name in LOCALES:
        monkeypatch.delenv(name, raising=False)
    for name, value in set_to.items():
        monkeypatch.setenv(name, value)
    assert language.language() == spoken
    assert language.language_tag() == {"en": "en", "zh": "zh-CN"}[spoken]


def test_the_suite_speaks_english_whatever_the_locale():
    assert os.environ["KINLAB_LANG"] == "en" and language.language() == "en"


def test_a_language_is_spoken_within_its_block_only(monkeypatch):
    monkeypatch.setattr(language, "_sentences", lambda folder: {"yes": "是"} if folder else {})
    with speaking("zh"):
        assert _("yes") == "是" and _("no catalogue knows this") == "no catalogue knows this"
        with speaking("en"):
            assert _("yes") == "yes"
        with speaking(None):
            assert _("yes") == "是"
        other = []
        thread = threading.Thread(target=lambda: other.append(_("yes")))
        thread.start()
        thread.join()
        assert other == ["yes"]
    assert _("yes") == "yes"
    with all_speaking("zh"):
        thread = threading.Thread(target=lambda: other.append(_("yes")))
        thread.start()
        thread.join()
        assert other == ["yes", "是"] and os.environ["KINLAB_LANG"] == "zh"
    assert os.environ["KINLAB_LANG"] == "en"


def test_a_number_chooses_its_sentence(monkeypatch):
    told = "{count} row", "{count} rows"
    assert [ngettext(*told, n).format(count=n) for n in (0, 1, 2)] == ["0 rows", "1 row", "2 rows"]
    monkeypatch.setattr(language, "_sentences", lambda folder: {"{count} row": "{count} 行"})
    assert [ngettext(*told, n).format(count=n) for n in (1, 2)] == ["1 行", "2 行"]


def test_a_language_that_we_do_not_speak_is_refused_at_the_door():
    assert one_of_ours("zh_CN.UTF-8") == "zh" and one_of_ours(" EN ") == "en"
    for name in ("fr", "", "chinese"):
        with pytest.raises(OptionError, match="language"):
            one_of_ours(name)
    with pytest.raises(KinlabError, match="klingon"), speaking("klingon"):
        pass


def test_a_catalogue_is_read_as_gettext_writes_it():
    text = (
        '# a comment\nmsgid ""\nmsgstr ""\n"Language: zh_CN\\n"\n\n#: file.py:3\nmsgid "one"\n'
        'msgstr "一"\n\nmsgid "{n} row"\nmsgid_plural "{n} rows"\nmsgstr[0] "{n} 行"\n\n'
        'msgid ""\n"two \\"quoted\\" \\\\ and\\n"\n"a line"\nmsgstr ""\n"两"\n"行"\n#~ msgid "old"\n'
    )
    assert read_catalogue(text) == [
        {"msgid": "", "msgstr": "Language: zh_CN\n"},
        {"msgid": "one", "msgstr": "一"},
        {"msgid": "{n} row", "msgid_plural": "{n} rows", "msgstr": "{n} 行"},
        {"msgid": 'two "quoted" \\ and\na line', "msgstr": "两行"},
    ]


@pytest.mark.parametrize(("name", "folder"), language.LANGUAGES.items())
def test_a_language_reads_its_own_catalogues_and_english_reads_none(name, folder):
    code = (
        "import sys; read = []; from pathlib import Path;"
        "sys.addaudithook(lambda event, told: event == 'open' and read.append(str(told[0])));"
        "import kinlab as kl; from kinlab.host.language import _;"
        "print(kl.fk(kl.load('planar2r'), [0, 0])[0, 3], file=sys.stderr); _('joint');"
        "print(*{Path(name).parts[-3] for name in read if name.endswith('.po')})"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "KINLAB_LANG": name},
    )
    assert done.stdout == f"{folder}\n"


# -------- every sentence is translated


@pytest.mark.parametrize("folder", FOLDERS)
def test_every_sentence_has_its_translation_and_every_translation_its_sentence(said, folder):
    held: dict[str, str] = {}
    wrong = []
    for file in sentences.catalogue_files(folder):
        head, *_rest = read_catalogue(file.read_text(encoding="utf-8"))
        assert "nplurals=1;" in head["msgstr"] and f"Language: {folder}\n" in head["msgstr"]
        assert "#, fuzzy" not in file.read_text(encoding="utf-8")
        for entry in sentences.entries(file):
            text, name = entry["msgid"], file.name
            if text in held:
                wrong.append(f"{name}: twice: {text!r}")
            held[text] = entry["msgstr"]
            if text not in said:
                wrong.append(f"{name}: nobody says {text!r}")
                continue
            if file.stem not in said[text].rooms:
                wrong.append(f"{name}: said in {said[text].rooms}: {text!r}")
            if entry.get("msgid_plural", "") != said[text].more:
                wrong.append(f"{name}: another plural: {text!r}")
            wanted = sentences.fields(text) | sentences.fields(said[text].more)
            if entry["msgstr"] and sentences.fields(entry["msgstr"]) != wanted:
                wrong.append(f"{name}: other fields than {sorted(wanted)}: {entry['msgstr']!r}")
    wrong += [
        f"no translation: {text!r} ({one.places[0]})"
        for text, one in said.items()
        if not held.get(text)
    ]
    assert not wrong, "\n".join(["python tests/sentences.py writes the catalogues anew", *wrong])


def test_every_sentence_of_the_covered_files_is_marked():
    wrong = []
    for name in COVERED:
        place = sentences.PACKAGE / name
        for file in sorted(place.rglob("*.py")) if place.is_dir() else [place]:
            inside = file.relative_to(sentences.PACKAGE).as_posix()
            left = LEFT_ENGLISH.get(inside, ())  # how they begin
            found = sentences.unmarked(ast.parse(file.read_text(encoding="utf-8")))
            wrong += [
                f"{inside}:{line}: {text!r}" for line, text in found if not text.startswith(left)
            ]
    assert not wrong, "\n".join(wrong)


def test_every_sentence_of_the_page_s_script_is_marked():
    script = (sentences.PACKAGE / "viewer" / "page" / "page.js").read_text(encoding="utf-8")
    script = re.sub(r"(?<!:)//.*", "", script)
    marked = {text for text, _more, _line in sentences.marked_in_text(script)}
    assert len(marked) >= 15 and "Draw all rows" in marked
    quoted = re.findall(r'"([^"\n]*)"|`([^`]*)`', script)
    texts = {re.sub(r"<[^>]*>|\$\{[^}]*\}", "", one or other) for one, other in quoted}
    told = {text for text in texts if sentences.WORDS.search(text)}
    code = {"use strict", "line legend", "translate(px, px)", "R = Rz(yaw) Ry(pitch) Rx(roll)"}
    assert told - marked <= code


def test_an_unmarked_sentence_is_found():
    code = (
        '"""A docstring of words."""\n'
        'x = _("well said")\n'
        'y = N_("also well said")\n'
        'z = f"{x} badly said indeed"\n'
        'echo("badly said")\n'
        'raise OptionError("errors are English")\n'
        'k = "one_name"\n'
    )
    found = sentences.unmarked(ast.parse(code))
    assert [line for line, _text in found] == [4, 5]
    with pytest.raises(sentences.NotPlain):
        sentences.marked_in_python(ast.parse('_(f"{x} agrees")'), "x.py")
    with pytest.raises(sentences.NotPlain):
        sentences.marked_in_python(ast.parse('_("{} agrees".format(x))'), "x.py")
    script = 'a(_("One \\"two\\""), ngettext("{n} x", "{n} xs", n)); b._("no")'
    assert [found[:2] for found in sentences.marked_in_text(script)] == [
        ('One "two"', ""),
        ("{n} x", "{n} xs"),
    ]
