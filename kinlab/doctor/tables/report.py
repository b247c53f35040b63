"""Diagnoses of tables written down: one self-contained HTML page, or Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from kinlab.check.report.html import render
from kinlab.check.report.markdown_text import block, code, words
from kinlab.check.report.words import origin
from kinlab.check.report.write import check_report_path
from kinlab.doctor.tables.result import TableDiagnosis
from kinlab.host.files import write_text

_TITLE = "DH tables beside another description of the arm"
_HOW = (
    "The tool's pose (and where both sides have masses the bodies) of a table are compared with "
    "those of the reference at the same joint positions. A cause is named only if taking it back "
    "gives the reference's pose at every state."
)


def write_table_report(path: str | Path, found: Sequence[TableDiagnosis]) -> None:
    """Writes a report.

    Args:
        path: ends in .html or .md.
        found: the diagnoses.

    Raises:
        FileError: another kind of file, or it cannot be written; an old one stays whole.
    """
    check_report_path(path)
    writer = page if Path(path).suffix.lower() == ".html" else text
    write_text(path, writer(found))


def page(found: Sequence[TableDiagnosis]) -> str:
    """The whole page."""
    return render(
        "table.html.j2", title=_TITLE, lead=_lead(found), how=_HOW, found=found, footer=origin(())
    )


def text(found: Sequence[TableDiagnosis]) -> str:
    """The report as Markdown."""
    lines = [f"# {_TITLE}", "", _lead(found), "", _HOW, ""]
    for one in found:
        lines += [f"## {code(one.name)} against {code(one.reference)}", ""]
        lines += [f"**{one.verdict.capitalize()}**: {words(one.sentence)}.", ""]
        lines += [*(f"- {words(line)}" for line in one.told), ""]
        if one.repaired is not None and one.causes:
            lines += ["The repaired table:", "", block(one.repaired.to_toml(), "toml"), ""]
    return "\n".join([*lines, origin(())]) + "\n"


def _lead(found: Sequence[TableDiagnosis]) -> str:
    right = sum(one.agrees for one in found)
    named = sum(not one.agrees and bool(one.causes) for one in found)
    unknown = len(found) - right - named
    said = f"{right} of {len(found)} agree"
    said += f", what is wrong is known of {named}" if named else ""
    return said + (f", unknown of {unknown}." if unknown else ".")
