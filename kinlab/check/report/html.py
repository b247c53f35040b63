"""A check as one self-contained HTML page: MathML, inline SVG, no network, no script."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from itertools import groupby
from pathlib import Path

from kinlab.check.finding import Finding, Typeset
from kinlab.check.report import words as histogram
from kinlab.check.report.summary import Group, size
from kinlab.check.report.words import (
    HOW,
    NOTES,
    TAKEN_APART,
    errors,
    lead,
    origin,
    sentence,
    several,
)
from kinlab.formulas.typeset import mathml
from kinlab.host.web import page_text, policy

# -------- A finding on the page: the formula as written, what is wrong, how it should be


def finding_sections(findings: Sequence[Finding]) -> dict[str, str]:
    """Cards by file, as titles and HTML."""
    return {
        f"{source}: your formulas": "\n".join(_card(finding) for finding in members)
        for source, members in groupby(findings, key=lambda one: one.source)
    }


def diagnosis(finding: Finding) -> str:
    """The verdict with its evidence and the corrected formula."""
    parts = [f'<p class="verdict">{escape(_told(finding))}</p>']
    parts.append(f'<p class="evidence">{errors(finding)}.</p>')
    parts += [f'<p class="evidence">{escape(text)}</p>' for text in finding.evidence]
    if finding.others:
        listed = "".join(f"<li>{escape(text)}</li>" for text in finding.others)
        parts.append(f'<div class="evidence">Explains it as well:<ul>{listed}</ul></div>')
    return "\n".join(parts)


def corrected(finding: Finding) -> str:
    """The corrected formulas, where they are known."""
    return _forms("should be", "corrected", finding.corrected)


def _card(finding: Finding) -> str:
    state = "agrees" if finding.agrees else "differs"
    caption = "" if finding.agrees else "as written"
    forms = _forms(caption, "printed" if caption else "only", finding.given) + corrected(finding)
    return f"""<article class="{state}">
<h3><code>{escape(finding.title)}</code></h3>
<p class="source">engine: <code>{escape(finding.quantity)}</code> of {escape(finding.robot)}</p>
<div class="forms stacked">{forms}</div>
{diagnosis(finding)}
</article>"""


def _told(finding: Finding) -> str:
    if finding.agrees:
        return f"Agrees with {finding.quantity} of {finding.robot}."
    # no capital: the sentence may begin with a name
    return f"{sentence(finding.verdict)[:-1]}: {finding.sentence}."


def _forms(caption: str, name: str, forms: Sequence[Typeset]) -> str:
    if not forms:
        return ""
    title = f"<figcaption>{caption}</figcaption>" if caption else ""
    rows = "".join(mathml(f"{left} = {right}") for left, right in forms)
    return f'<figure class="{name}">{title}{rows}</figure>'


# -------- A check as one self-contained HTML page: MathML, inline SVG, no network, no
#          script

LONG = 110
"""Characters of LaTeX above which a form gets the whole width."""

_STYLE = Path(__file__).with_name("report.css")


def page(groups: Sequence[Group], findings: Sequence[Finding] = ()) -> str:
    """The whole page.

    Args:
        groups: from :func:`kinlab.check.report.summary.grouped`.
        findings: formulas that were taken apart.
    """
    sections: dict[str, list[Group]] = {}
    for group in groups:
        name = NOTES.get(group.formula.note or group.formula.id, "Your formulas")
        sections.setdefault(name, []).append(group)
    style = _STYLE.read_text(encoding="utf-8")
    cards = [
        (name, _tally(members), "\n".join(_row_card(group) for group in members))
        for name, members in sections.items()
    ]
    cards += [(name, "", text) for name, text in finding_sections(findings).items()]
    body = "\n".join(
        f'<section id="s{k}"><h2>{escape(name)}</h2>\n{text}\n</section>'
        for k, (name, _, text) in enumerate(cards)
    )
    links = "".join(
        f'<li><a href="#s{k}">{escape(name)}</a> {tally}</li>'
        for k, (name, tally, _) in enumerate(cards)
    )
    return page_text(f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
{policy()}
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Hand formulas beside the engine</title>
<style>
{style}
</style>
</head>
<body>
<header>
<h1>Hand formulas beside the engine</h1>
<p class="lead">{escape(lead(groups, findings))}</p>
<p>{escape(HOW)} {_legend(groups, findings)}</p>
<nav><ul>{links}</ul></nav>
</header>
<main>
{body}
</main>
<footer>{escape(origin(groups))}</footer>
</body>
</html>
""")


def _legend(groups: Sequence[Group], findings: Sequence[Finding]) -> str:
    """What the pictures, colours and diagnoses on this page mean."""
    text = ""
    if groups:
        text += """In the pictures <span class="key good">corrected</span> and
<span class="key bad">printed</span> errors are spread over the decades; the dashed line is 1e-9.
"""
    if findings or any(row.finding for group in groups for row in group.rows):
        text += escape(TAKEN_APART)
    return f"""{text} In the formulas <span class="key wrong">what is wrong</span> stands beside
<span class="key fixed">what it should be</span>."""


def _tally(members: Sequence[Group]) -> str:
    misprints = sum(group.printed_error is not None for group in members)
    text = several(len(members), "formula")
    text += f", {several(misprints, 'misprint')}" if misprints else ""
    return f'<span class="tally">{text}</span>'


def _row_card(group: Group) -> str:
    record = group.formula
    misprinted = record.printed is not None and group.printed_error is not None
    state = "fails" if not group.ok else "misprint" if misprinted else "agrees"
    forms = ""
    if misprinted and record.printed is not None:
        forms += _form("printed", record.printed.latex)
    if record.latex:
        forms += _form("corrected" if misprinted else "", record.latex)
    found = "".join(
        (f"<h4>{escape(row.robot)}</h4>" if len(group.rows) > 1 else "")
        + diagnosis(row.finding)
        + f'<div class="forms">{corrected(row.finding)}</div>'
        for row in group.rows
        if row.finding is not None
    )
    source = f"{escape(record.source)} · " if record.source else ""
    told = found and len(group.rows) == 1  # the diagnosis begins with the verdict
    verdict = "" if told else f'<p class="verdict">{escape(sentence(group.verdict))}</p>'
    remark = f'<p class="remark">{escape(sentence(record.remark))}</p>' if record.remark else ""
    return f"""<article class="{state}" id="{escape(record.key)}">
<h3><code>{escape(record.key)}</code> {escape(record.title)}</h3>
<p class="source">{source}engine: <code>{escape(record.quantity)}</code></p>
<div class="forms">{forms}</div>
{verdict}{remark}
{found}
<div class="measured">{histogram.svg(group.errors, group.printed_errors)}{_robots(group)}</div>
</article>"""


def _form(name: str, latex: str) -> str:
    caption = f"<figcaption>{name}</figcaption>" if name else ""
    width = " long" if len(latex) > LONG else ""
    return f'<figure class="{name or "only"}{width}">{caption}{mathml(latex)}</figure>'


def _robots(group: Group) -> str:
    printed = group.printed_error is not None
    head = "<th>robot</th><th>states</th><th>error</th>" + ("<th>printed</th>" if printed else "")
    lines = []
    for row in group.rows:
        last = size(row.printed.max_error if row.printed is not None else None)
        lines.append(
            f"<tr><td>{escape(row.robot)}</td><td>{row.corrected.samples}</td>"
            f"<td>{size(row.corrected.max_error)}</td>"
            + (f'<td class="bad">{last}</td>' if printed else "")
            + "</tr>"
        )
    table = f"<table><tr>{head}</tr>{''.join(lines)}</table>"
    if len(group.rows) <= 3:
        return table
    worst = group.worst
    summary = (
        f"{len(group.rows)} robots; largest error {size(worst.corrected.max_error)} "
        f"({escape(worst.robot)})"
    )
    if printed:
        summary += f"; printed form off by {size(group.printed_error)} or more"
    return f"<details><summary>{summary}</summary>{table}</details>"
