"""A finding on the page: the formula as written, what is wrong, how it should be."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from itertools import groupby

from kinlab.check.finding import Finding, Typeset
from kinlab.check.headings import errors, sentence
from kinlab.check.typeset import mathml


def sections(findings: Sequence[Finding]) -> dict[str, str]:
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
