"""A check written down: one self-contained HTML page, or Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from kinlab.check.catalogue import Row
from kinlab.check.diagnosis import Diagnosis
from kinlab.check.report import html as report_html
from kinlab.check.report import markdown as report_md
from kinlab.check.report.summary import grouped
from kinlab.errors import FileError
from kinlab.host.files import write_text

_WRITERS = {".html": report_html.page, ".md": report_md.text}


def check_report_path(path: str | Path) -> None:
    """Refuses a report that could not be written, before any work is done.

    Raises:
        FileError: another kind of file, or a folder that does not exist.
    """
    file = Path(path)
    if file.suffix.lower() not in _WRITERS:
        raise FileError(f"{file}: a report ends in {' or '.join(_WRITERS)}")
    if not file.parent.is_dir():
        raise FileError(f"{file}: the folder {str(file.parent)!r} does not exist")


def write_report(path: str | Path, rows: Sequence[Row], judged: Sequence[Diagnosis] = ()) -> None:
    """Writes a report.

    Args:
        path: ends in .html or .md.
        rows: what :func:`kinlab.check.catalogue.run` gave.
        judged: formulas that were taken apart, from :mod:`kinlab.doctor.report`.

    Raises:
        FileError: another kind of file, or it cannot be written; an old one stays whole.
    """
    check_report_path(path)
    write_text(path, _WRITERS[Path(path).suffix.lower()](grouped(rows), judged))
