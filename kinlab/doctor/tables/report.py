"""Diagnoses of tables written down: one self-contained HTML page, or Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path

from kinlab.check import report
from kinlab.check.report.write import check_report_path
from kinlab.doctor.tables.result import TableDiagnosis
from kinlab.host.files import write_text
from kinlab.host.version import __version__

_STYLE = Path(report.__file__).with_name("report.css")
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
    cards = "\n".join(_card(one) for one in found)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(_TITLE)}</title>
<style>
{_STYLE.read_text(encoding="utf-8")}
td del {{ color: #c62828; }} td b {{ color: #2e7d32; }} pre {{ overflow-x: auto; }}
</style>
</head>
<body>
<header>
<h1>{escape(_TITLE)}</h1>
<p class="lead">{escape(_lead(found))}</p>
<p>{escape(_HOW)}</p>
</header>
<main>
<section>
{cards}
</section>
</main>
<footer>Made by kinlab {__version__}: the same seed gives the same states.</footer>
</body>
</html>
"""


def _card(one: TableDiagnosis) -> str:
    name = one.mine.name if one.mine is not None else "table"
    lines = "\n".join(f'<p class="evidence">{escape(line)}</p>' for line in one.told)
    repaired = ""
    if one.repaired is not None and one.causes:
        toml = escape(one.repaired.to_toml())
        repaired = f"<details><summary>the repaired table</summary><pre>{toml}</pre></details>"
    return f"""<article class="{"agrees" if one.agrees else "differs"}">
<h3><code>{escape(name)}</code> against <code>{escape(one.reference)}</code></h3>
<p class="verdict">{escape(one.verdict.capitalize())}: {escape(one.sentence)}.</p>
{lines}
{one.rows_html()}
{repaired}
</article>"""


def text(found: Sequence[TableDiagnosis]) -> str:
    """The report as Markdown."""
    lines = [f"# {_TITLE}", "", _lead(found), "", _HOW, ""]
    for one in found:
        name = one.mine.name if one.mine is not None else "table"
        lines += [f"## `{name}` against `{one.reference}`", ""]
        lines += [f"**{one.verdict.capitalize()}**: {one.sentence}.", ""]
        lines += [*(f"- {line}" for line in one.told), ""]
        if one.repaired is not None and one.causes:
            lines += ["The repaired table:", "", "```toml", one.repaired.to_toml(), "```", ""]
    return "\n".join([*lines, f"Made by kinlab {__version__}."]) + "\n"


def _lead(found: Sequence[TableDiagnosis]) -> str:
    right = sum(one.agrees for one in found)
    named = sum(not one.agrees and bool(one.causes) for one in found)
    unknown = len(found) - right - named
    said = f"{right} of {len(found)} agree"
    said += f", what is wrong is known of {named}" if named else ""
    return said + (f", unknown of {unknown}." if unknown else ".")
