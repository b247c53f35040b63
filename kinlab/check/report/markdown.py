"""A check as Markdown with LaTeX formulas."""

from __future__ import annotations

from collections.abc import Sequence

from kinlab.check.finding import Finding
from kinlab.check.report.summary import Group, size
from kinlab.check.report.words import HOW, NOTES, TAKEN_APART, errors, lead, origin, sentence
from kinlab.formulas.typeset import plain


def text(groups: Sequence[Group], findings: Sequence[Finding] = ()) -> str:
    """The whole report.

    Args:
        groups: from :func:`kinlab.check.report.summary.grouped`.
        findings: formulas that were taken apart.
    """
    how = f"{HOW} {TAKEN_APART}" if findings else HOW
    lines = ["# Hand formulas beside the engine", "", lead(groups, findings), "", how, ""]
    section = None
    for group in groups:
        name = NOTES.get(group.formula.note or group.formula.id, "Your formulas")
        if name != section:
            lines += [f"## {name}", ""]
            section = name
        lines += _formula(group)
    for finding in findings:
        if finding.source != section:
            lines += [f"## {finding.source}: your formulas", ""]
            section = finding.source
        lines += _entry(finding)
    return "\n".join([*lines, origin(groups)]) + "\n"


def _formula(group: Group) -> list[str]:
    record = group.formula
    mark = "" if group.ok else " **FAILS**"
    source = f"{record.source}; " if record.source else ""
    lines = [f"### `{record.key}` {record.title}{mark}", "", f"{source}`{record.quantity}`", ""]
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
    lines.append("")
    for row in group.rows:
        if row.finding is not None:
            lines += [f"On {row.robot}:", "", *_diagnosis(row.finding)]
    return lines


def _entry(finding: Finding) -> list[str]:
    mark = "" if finding.agrees else " **DIFFERS**"
    lines = [f"### `{finding.title}`{mark}", "", f"`{finding.quantity}` of {finding.robot}", ""]
    for left, right in finding.given:
        lines += [f"$${plain(f'{left} = {right}')}$$", ""]
    return lines + _diagnosis(finding)


def _diagnosis(finding: Finding) -> list[str]:
    lines = [f"**{finding.verdict.capitalize()}**: {finding.sentence}. {errors(finding)}.", ""]
    for text in finding.evidence:
        lines += [f"{text}.", ""]
    lines += [f"- or: {text}" for text in finding.others] + ([""] if finding.others else [])
    if finding.corrected:
        lines += ["Should be:", ""]
    for left, right in finding.corrected:
        lines += [f"$${plain(f'{left} = {right}')}$$", ""]
    return lines
