"""The language in which kinlab speaks: English in the code, others in catalogues beside this file.

A sentence is English where it stands, marked with ``_``; numbers and names go into named fields,
so that another language can put them elsewhere::

    from kinlab.host.language import N_, _, ngettext

    _("{name} agrees with the engine").format(name=name)
    ngettext("{count} row", "{count} rows", count).format(count=count)
    WORDS = {"good": N_("agrees")}  # marked where it stands, translated where it is shown:
    _(WORDS["good"])

The translations are gettext catalogues, ``locale/<locale>/LC_MESSAGES/<room>.po``, read when the
first sentence of another language is asked for: no step of building, nothing binary that could be
older than its source. ``python tests/sentences.py`` brings them up to date with the code.

The language is, in this order: that of :func:`speaking`, ``KINLAB_LANG``, and the locale
(``LC_ALL``, ``LC_MESSAGES``, ``LANG``); English where it is none of ours. Names, units, numbers,
JSON and tables for machines have no language.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from pathlib import Path

from kinlab.errors import OptionError, near

VARIABLE = "KINLAB_LANG"
"""Environment variable: the language, such as ``zh``."""

LANGUAGES = {"en": "", "zh": "zh_CN"}
"""What kinlab speaks: the language, and the folder of its catalogues."""

_LOCALE = Path(__file__).parent / "locale"
_ASKED: ContextVar[str] = ContextVar("kinlab language", default="")
_LINE = re.compile(r'(?:(msgid_plural|msgid|msgstr(?:\[0\])?) )?(".*")')


def language() -> str:
    """The language of what is said now: ``"en"`` or ``"zh"``."""
    asked = _ASKED.get() or os.environ.get(VARIABLE, "")
    if asked:
        return _known(asked) or "en"
    names = (os.environ.get(name) for name in ("LC_ALL", "LC_MESSAGES", "LANG"))
    return _known(next(filter(None, names), "")) or "en"


def language_tag() -> str:
    """The language for the ``lang`` of a page: ``"en"`` or ``"zh-CN"``."""
    spoken = language()
    return LANGUAGES[spoken].replace("_", "-") or spoken


def one_of_ours(name: str) -> str:
    """The language that a name means: ``"zh"`` of ``"zh"``, ``"zh-CN"`` or ``"zh_CN.UTF-8"``.

    Raises:
        OptionError: kinlab does not speak it.
    """
    found = _known(name)
    if found is None:
        raise OptionError(f"language {name!r}; {near(name, list(LANGUAGES))}")
    return found


@contextmanager
def speaking(name: str | None) -> Iterator[None]:
    """Everything said within it is in this language; None changes nothing.

    Raises:
        OptionError: kinlab does not speak it.
    """
    if name is None:
        yield
        return
    before = _ASKED.set(one_of_ours(name))
    try:
        yield
    finally:
        _ASKED.reset(before)


@contextmanager
def all_speaking(name: str | None) -> Iterator[None]:
    """As :func:`speaking`, also in other threads and in the processes that are started within it.

    Raises:
        OptionError: kinlab does not speak it.
    """
    if name is None:
        yield
        return
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = one_of_ours(name)
    try:
        yield
    finally:
        del os.environ[VARIABLE]
        if before is not None:
            os.environ[VARIABLE] = before


def _(text: str) -> str:
    """A sentence in the language of now; what no catalogue knows stays as it is."""
    return _sentences(LANGUAGES[language()]).get(text, text)


def ngettext(one: str, more: str, count: int) -> str:
    """A sentence with a number: ``one`` where the count is 1, else ``more``, both marked.

    The languages of the catalogues have one form for every number.
    """
    return _sentences(LANGUAGES[language()]).get(one, one if count == 1 else more)


def N_(text: str) -> str:
    """Marks a sentence where it stands; whoever shows it translates it with ``_``."""
    return text


@cache
def _known(name: str) -> str | None:
    """The language of a name or of a locale; None where it is none of ours."""
    short = re.split(r"[-_.@]", name.strip().lower(), maxsplit=1)[0]
    return short if short in LANGUAGES else None


@cache
def _sentences(folder: str) -> dict[str, str]:
    """All catalogues of a language as one; empty for English."""
    if not folder:
        return {}
    found: dict[str, str] = {}
    for file in sorted((_LOCALE / folder / "LC_MESSAGES").glob("*.po")):
        for entry in read_catalogue(file.read_text(encoding="utf-8")):
            if entry["msgid"] and entry["msgstr"]:
                found[entry["msgid"]] = entry["msgstr"]
    return found


def read_catalogue(text: str) -> list[dict[str, str]]:
    """The entries of a catalogue's text, each with ``msgid`` and ``msgstr``.

    Those with a number also have ``msgid_plural``; their ``msgstr`` is the one of every number.
    The head has an empty ``msgid``. Comments are left out.
    """
    entries: list[dict[str, str]] = []
    field = ""
    for line in text.splitlines():
        found = _LINE.fullmatch(line.strip())
        if found is None:
            continue
        if found[1]:
            field = found[1].removesuffix("[0]")
            if field == "msgid":
                entries.append({"msgid": "", "msgstr": ""})
        entries[-1][field] = entries[-1].get(field, "") + json.loads(found[2])
    return entries
