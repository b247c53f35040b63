"""A check as one self-contained HTML page: MathML, inline SVG, no network, no script.

What stands where is in the templates beside this file (``check.html.j2`` and what it includes);
they escape every text that is not marked as safe here: MathML, the pictures, the style, the policy.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import groupby
from pathlib import Path
from typing import Any

from jinja2 import Environment
from markupsafe import Markup

from kinlab.check.diagnosis import Diagnosis
from kinlab.check.places import place_in_note, short_place
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
    several,
    svg,
)
from kinlab.check.unread import Unread
from kinlab.formulas.typeset import mathml
from kinlab.host.language import _
from kinlab.host.web import page_text, policy, templates

LONG = 110
"""Characters of LaTeX above which a form gets the whole width."""

NARROW = 120
"""Characters of LaTeX below which two cards stand beside each other on paper."""

_FOLDER = Path(__file__).parent


def page(
    groups: Sequence[Group],
    judged: Sequence[Diagnosis] = (),
    unread: Sequence[Unread] = (),
    *,
    compact: bool = False,
) -> str:
    """The whole page.

    Args:
        groups: from :func:`kinlab.check.report.summary.grouped`.
        judged: formulas that were taken apart.
        unread: what could not be judged.
        compact: one line for a formula that agrees.
    """
    sections: dict[str, list[Group]] = {}
    for group in groups:
        sections.setdefault(section(group), []).append(group)
    apart = judged or any(row.diagnosis for group in groups for row in group.rows)
    return render(
        "check.html.j2",
        title=_(TITLE),
        lead=lead(groups, judged, unread),
        unread=unread,
        how=_(HOW),
        taken_apart=_(TAKEN_APART) if apart else "",
        compact=compact,
        sections=sections,
        files={source: list(found) for source, found in groupby(judged, lambda one: one.source)},
        footer=origin(groups),
    )


def render(template: str, **values: Any) -> str:
    """A page from a template that extends ``base.html.j2``.

    Args:
        template: its file in this folder.
        values: ``title``, ``lead``, ``footer`` and what else the template names; texts are escaped.

    Returns:
        The page, with a policy that fetches nothing and runs no script.
    """
    style = Markup((_FOLDER / "report.css").read_text(encoding="utf-8"))
    values |= {"policy": Markup(policy()), "style": style}
    return page_text(_environment().get_template(template).render(values))


@cache
def _environment() -> Environment:
    made = templates(_FOLDER)
    made.filters |= {
        "told": _told,
        "errors": errors,
        "sentence": sentence,
        "several": several,
        "size": size,
        "place": place_in_note,
        "short_place": short_place,
        "at_most": at_most,
        "mathml": lambda latex: Markup(mathml(latex)),
        "spread": lambda group: Markup(svg(group.errors, group.printed_errors)),
    }
    made.globals |= {
        "wide": LONG,
        "narrow": NARROW,
        "safe": Markup,  # a sentence of ours; what is put into its fields is escaped
        "key": Markup('<span class="key {}">{}</span>').format,
        "code": Markup("<code>{}</code>").format,
    }
    return made


def _told(found: Diagnosis) -> str:
    if found.agrees and not found.remarks:
        told = _("Agrees with {quantity} of {robot}.")
        return told.format(quantity=found.claimed, robot=found.robot)
    # no capital: the sentence may begin with a name
    verdict = sentence(_(found.verdict))[:-1]
    said = _("; ").join(found.remarks) if found.agrees else found.sentence
    return _("{verdict}: {sentence}.").format(verdict=verdict, sentence=said)
