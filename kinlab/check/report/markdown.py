"""A check as Markdown with LaTeX formulas."""

from __future__ import annotations

from collections.abc import Sequence

from kinlab.check.diagnosis import Diagnosis
from kinlab.check.report.markdown_text import code, formula, words
from kinlab.check.report.summary import Group, size
from kinlab.check.report.words import HOW, NOTES, TAKEN_APART, errors, lead, origin, sentence
from kinlab.check.unread import Unread


def text(
    groups: Sequence[Group], judged: Sequence[Diagnosis] = (), unread: Sequence[Unread] = ()
) -> str:
    """The whole report.

    Args:
        groups: from :func:`kinlab.check.report.summary.grouped`.
        judged: formulas that were taken apart.
        unread: what could not be judged.
    """
    how = f"{HOW} {TAKEN_APART}" if judged else HOW
    lines = ["# Hand formulas beside the engine", "", lead(groups, judged, unread), "", how, ""]
    if unread:
        lines += ["## Not judged", ""]
        lines += [f"- {code(one.what)}: {words(one.reason)}" for one in unread] + [""]
    section = None
    for group in groups:
        name = NOTES.get(group.formula.note or group.formula.id, "Your formulas")
        if name != section:
            lines += [f"## {words(name)}", ""]
            section = name
        lines += _formula(group)
    for found in judged:
        if found.source != section:
            lines += [f"## {words(found.source)}: your formulas", ""]
            section = found.source
        lines += _entry(found)
    return "\n".join([*lines, origin(groups)]) + "\n"


def _formula(group: Group) -> list[str]:
    record = group.formula
    mark = "" if group.ok else " **FAILS**"
    source = f"{words(record.source)}; " if record.source else ""
    lines = [f"### {code(record.key)} {words(record.title)}{mark}", ""]
    lines += [f"{source}{code(record.quantity)}", ""]
    if group.printed_error is not None and record.printed is not None:
        lines += ["Printed:", "", formula(record.printed.latex), "", "Corrected:", ""]
    if record.latex:
        lines += [formula(record.latex), ""]
    lines += [f"**{words(sentence(group.verdict))}**", ""]
    if record.remark:
        lines += [f"Remark: {words(sentence(record.remark))}", ""]
    lines += ["| robot | states | error | printed form |", "|---|---:|---:|---:|"]
    for row in group.rows:
        printed = size(row.printed.max_error) if row.printed is not None else ""
        error = size(row.corrected.max_error)
        lines.append(f"| {words(row.robot)} | {row.corrected.samples} | {error} | {printed} |")
    lines.append("")
    for row in group.rows:
        if row.diagnosis is not None:
            lines += [f"On {words(row.robot)}:", "", *_diagnosis(row.diagnosis)]
    return lines


def _entry(found: Diagnosis) -> list[str]:
    mark = "" if found.agrees else " **DIFFERS**"
    lines = [f"### {code(found.function)}{mark}", ""]
    lines += [f"{code(found.quantity)} of {words(found.robot)}", ""]
    for left, right in found.given:
        lines += [formula(f"{left} = {right}"), ""]
    return lines + _diagnosis(found)


def _diagnosis(found: Diagnosis) -> list[str]:
    lines = [f"**{found.verdict.capitalize()}**: {words(found.sentence)}. {errors(found)}.", ""]
    for text in found.evidence:
        lines += [f"{words(text)}.", ""]
    lines += [f"- or: {words(text)}" for text in found.others] + ([""] if found.others else [])
    if found.corrected:
        lines += ["Should be:", ""]
    for left, right in found.corrected:
        lines += [formula(f"{left} = {right}"), ""]
    return lines
