"""A check written down: one self-contained HTML page, or Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from kinlab.check.catalogue import Row
from kinlab.check.diagnosis import Diagnosis
from kinlab.check.report.summary import grouped
from kinlab.check.unread import Unread
from kinlab.errors import FileError
from kinlab.host.files import write_text
from kinlab.host.language import speaking

_ENDINGS = (".html", ".md")


def check_report_path(path: str | Path) -> None:
    """Refuses a report that could not be written, before any work is done.

    Raises:
        FileError: another kind of file, or a folder that does not exist.
    """
    file = Path(path)
    if file.suffix.lower() not in _ENDINGS:
        raise FileError(f"{file}: a report ends in {' or '.join(_ENDINGS)}")
    if not file.parent.is_dir():
        raise FileError(f"{file}: the folder {str(file.parent)!r} does not exist")


def write_report(
    path: str | Path,
    rows: Sequence[Row],
    judged: Sequence[Diagnosis] = (),
    unread: Sequence[Unread] = (),
    *,
    compact: bool = False,
    lang: str | None = None,
) -> None:
    """Writes a report.

    Args:
        path: ends in .html or .md.
        rows: what :func:`kinlab.check.catalogue.run` gave.
        judged: formulas that were taken apart, from :mod:`kinlab.doctor.report`.
        unread: what could not be judged.
        compact: one line for a formula that agrees.
        lang: the language, such as ``"zh"``; None for the one that is spoken.

    Raises:
        OptionError: a language that kinlab does not speak.
        FileError: another kind of file, or it cannot be written; an old one stays whole.
    """
    check_report_path(path)
    # imported here: typesetting takes as long to import as a small check to run
    if Path(path).suffix.lower() == ".html":
        from kinlab.check.report.html import page as made
    else:
        from kinlab.check.report.markdown import text as made
    with speaking(lang):
        text = made(grouped(rows), judged, unread, compact=compact)
    write_text(path, text)
