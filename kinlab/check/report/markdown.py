"""A check as Markdown with LaTeX formulas."""

from __future__ import annotations

from collections.abc import Sequence

from kinlab.check.diagnosis import Diagnosis
from kinlab.check.places import place_in_note, short_place
from kinlab.check.report.markdown_text import code, formula, words
from kinlab.check.report.summary import Group, size
from kinlab.check.report.words import (
    HOW,
    TAKEN_APART,
    TITLE,
    at_most,
    errors,
    lead,
    origin,
    section,
    sentence,
)
from kinlab.check.unread import Unread
from kinlab.host.language import _


def text(
    groups: Sequence[Group],
    judged: Sequence[Diagnosis] = (),
    unread: Sequence[Unread] = (),
    *,
    compact: bool = False,
) -> str:
    """The whole report.

    Args:
        groups: from :func:`kinlab.check.report.summary.grouped`.
        judged: formulas that were taken apart.
        unread: what could not be judged.
        compact: one line for a formula that agrees.
    """
    how = f"{_(HOW)} {_(TAKEN_APART)}" if judged else _(HOW)
    lines = [f"# {_(TITLE)}", "", lead(groups, judged, unread), "", how, ""]
    if unread:
        lines += [f"## {_('Not judged')}", ""]
        lines += [f"- {code(one.what)}: {words(one.reason)}" for one in unread] + [""]
    now = None
    for group in groups:
        if section(group) != now:
            now = section(group)
            lines += [f"## {words(now)}", ""]
        lines += [_line(group), ""] if compact and group.quiet else _formula(group)
    for found in judged:
        if found.source != now:
            now = found.source
            lines += [f"## {_('{file}: your formulas').format(file=words(now))}", ""]
        lines += _entry(found)
    return "\n".join([*lines, origin(groups)]) + "\n"


def _line(group: Group) -> str:
    """A formula that agrees, in one line."""
    record = group.formula
    parts = [
        f"{code(record.key)} {words(_(record.title))}",
        *map(words, filter(None, (_(record.source), short_place(record)))),
        words(_("agrees: {error}").format(error=at_most(group))),
    ]
    return "; ".join(parts)


def _formula(group: Group) -> list[str]:
    record = group.formula
    mark = "" if group.ok else f" **{_('FAILS')}**"
    source = "".join(f"{words(one)}; " for one in (_(record.source), place_in_note(record)) if one)
    lines = [f"### {code(record.key)} {words(_(record.title))}{mark}", ""]
    lines += [f"{source}{code(record.quantity)}", ""]
    if group.printed_error is not None and record.printed is not None:
        printed, corrected = _("Printed:"), _("Corrected:")
        lines += [printed, "", formula(record.printed.latex), "", corrected, ""]
    if record.latex:
        lines += [formula(record.latex), ""]
    lines += [f"**{words(sentence(group.verdict))}**", ""]
    if record.remark:
        remark = words(sentence(_(record.remark)))
        lines += [_("Remark: {remark}").format(remark=remark), ""]
    heads = (_("robot"), _("states"), _("error"), _("printed form"))
    lines += [f"| {' | '.join(heads)} |", "|---|---:|---:|---:|"]
    for row in group.rows:
        printed = size(row.printed.max_error) if row.printed is not None else ""
        error = size(row.corrected.max_error)
        lines.append(f"| {words(row.robot)} | {row.corrected.samples} | {error} | {printed} |")
    lines.append("")
    for row in group.rows:
        if row.diagnosis is not None:
            on = _("On {robot}:").format(robot=words(row.robot))
            lines += [on, "", *_diagnosis(row.diagnosis)]
    return lines


def _entry(found: Diagnosis) -> list[str]:
    mark = "" if found.agrees else f" **{_('DIFFERS')}**"
    lines = [f"### {code(found.title)}{mark}", ""]
    of = _("{quantity} of {robot}")
    lines += [of.format(quantity=words(found.claimed), robot=words(found.robot)), ""]
    for left, right in found.given:
        lines += [formula(f"{left} = {right}"), ""]
    return lines + _diagnosis(found)


def _diagnosis(found: Diagnosis) -> list[str]:
    told = _("**{verdict}**: {sentence}. {errors}.").format(
        verdict=_(found.verdict).capitalize(),
        sentence=words(found.sentence),
        errors=errors(found),
    )
    lines = [told, ""]
    for text in found.evidence:
        lines += [sentence(words(text)), ""]
    lines += ["- " + _("or: {slip}").format(slip=words(text)) for text in found.others]
    lines += [""] if found.others else []
    if found.corrected:
        lines += [_("Should be:"), ""]
    for left, right in found.corrected:
        lines += [formula(f"{left} = {right}"), ""]
    return lines
