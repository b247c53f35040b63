"""A check as Markdown with LaTeX formulas."""

from __future__ import annotations

from collections.abc import Sequence

from kinlab.check.headings import HOW, NOTES, counts, origin, sentence
from kinlab.check.summary import Group, size
from kinlab.check.typeset import plain


def text(groups: Sequence[Group]) -> str:
    """The whole report.

    Args:
        groups: from :func:`kinlab.check.summary.grouped`.
    """
    lines = ["# Hand formulas beside the engine", "", counts(groups), "", HOW, ""]
    section = None
    for group in groups:
        name = NOTES.get(group.formula.note or group.formula.id, "Your formulas")
        if name != section:
            lines += [f"## {name}", ""]
            section = name
        lines += _formula(group)
    return "\n".join([*lines, origin(groups)]) + "\n"


def _formula(group: Group) -> list[str]:
    record = group.formula
    mark = "" if group.ok else " **FAILS**"
    lines = [f"### `{record.key}` {record.title}{mark}", "", f"{record.source}; "
             f"`{record.quantity}`", ""]  # fmt: skip
    if group.printed_error is not None and record.printed is not None:
        lines += ["Printed:", "", f"$${plain(record.printed.latex)}$$", "", "Corrected:", ""]
    if record.latex:
        lines += [f"$${plain(record.latex)}$$", ""]
    lines += [f"**{sentence(group.verdict)}**", ""]
    if record.remark:
        lines += [f"Remark: {sentence(record.remark)}", ""]
    lines += ["| robot | states | error | printed form |", "|---|---:|---:|---:|"]
    for row in group.rows:
        printed = size(row.printed.max_error) if row.printed is not None else ""
        error = size(row.corrected.max_error)
        lines.append(f"| {row.robot} | {row.corrected.samples} | {error} | {printed} |")
    return [*lines, ""]
