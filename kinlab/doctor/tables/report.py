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
from kinlab.host.language import N_, _

_TITLE = N_("DH tables beside another description of the arm")
_HOW = N_(
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
        "table.html.j2",
        title=_(_TITLE),
        lead=_summary(found),
        how=_(_HOW),
        found=found,
        footer=origin(()),
    )


def text(found: Sequence[TableDiagnosis]) -> str:
    """The report as Markdown."""
    lines = [f"# {_(_TITLE)}", "", _summary(found), "", _(_HOW), ""]
    against, said = _("{table} against {reference}"), _("{verdict}: {sentence}.")
    for one in found:
        pair = against.format(table=code(one.name), reference=code(one.reference))
        verdict = _(one.verdict).capitalize()
        lines += [f"## {pair}", ""]
        lines += [said.format(verdict=f"**{verdict}**", sentence=words(one.sentence)), ""]
        lines += [*(f"- {words(line)}" for line in one.told), ""]
        if one.repaired is not None and one.causes:
            lines += [_("The repaired table:"), "", block(one.repaired.to_toml(), "toml"), ""]
    return "\n".join([*lines, origin(())]) + "\n"


def _summary(found: Sequence[TableDiagnosis]) -> str:
    right = sum(one.agrees for one in found)
    named = sum(not one.agrees and bool(one.causes) for one in found)
    unknown = len(found) - right - named
    if named and unknown:
        said = _("{right} of {all} agree, what is wrong is known of {named}, unknown of {unknown}.")
    elif named:
        said = _("{right} of {all} agree, what is wrong is known of {named}.")
    elif unknown:
        said = _("{right} of {all} agree, unknown of {unknown}.")
    else:
        said = _("{right} of {all} agree.")
    return said.format(right=right, all=len(found), named=named, unknown=unknown)
