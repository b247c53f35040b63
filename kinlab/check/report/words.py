"""What the page and the Markdown report share: headings, words, small pictures of errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from kinlab.arrays import Array
from kinlab.check.diagnosis import Diagnosis
from kinlab.check.report.summary import NO_ROBOT, Group, size
from kinlab.check.unread import Unread
from kinlab.host.language import N_, _, ngettext
from kinlab.tolerances import TOLERANCES

# -------- Words that the page and the Markdown report share

NOTES = {
    "000": N_("Note 000: kinematics, Jacobian, inverse kinematics, statics, dynamics"),
    "001": N_("Note 001: Lagrange, the planar 2R arm with point masses"),
    "002": N_("Note 002: Lagrange in general, standard DH"),
    "003": N_("Note 003: the two-degree-of-freedom parallel robot"),
    "table": N_("Arms: the DH table by hand beside the engines"),
}
"""Section titles by note number; ``table`` for the checks of single arms."""

YOURS = N_("Your formulas")
"""The section of a user's own functions."""

TITLE = N_("Hand formulas beside the engine")

HOW = N_(
    "Each formula is evaluated by hand and by the engine (Pinocchio) at random states. The error "
    "of a state is the largest difference of an entry over the largest entry of the engine's "
    "answer. A corrected form must stay below 1e-9; a misprint must show above 1e-3."
)


TAKEN_APART = N_(
    "Where a formula of yours differs, the doctor looks for what is wrong in it. It names a cause "
    "only if repairing it leaves less than 1e-9 at every state."
)


def section(group: Group) -> str:
    """The section that a formula stands in."""
    return _(NOTES.get(group.formula.note or group.formula.id, YOURS))


def lead(
    groups: Sequence[Group], judged: Sequence[Diagnosis], unread: Sequence[Unread] = ()
) -> str:
    """What was found, in a sentence or two; what could not be judged comes first."""
    parts = []
    if unread:
        names = _(", ").join(one.what for one in unread)
        parts.append(_("NOT JUDGED: {names}.").format(names=names))
    if groups or not (judged or unread):
        parts.append(counts(groups))
    if judged:
        right = sum(one.agrees for one in judged)
        named = sum(one.known and not one.agrees for one in judged)
        unknown = len(judged) - right - named
        if named and unknown:
            told = _(
                "Formulas in files: {right} of {all} right, what is wrong is known of {named}, "
                "unknown of {unknown}."
            )
        elif named:
            told = _(
                "Formulas in files: {right} of {all} right, what is wrong is known of {named}."
            )
        elif unknown:
            told = _("Formulas in files: {right} of {all} right, unknown of {unknown}.")
        else:
            told = _("Formulas in files: {right} of {all} right.")
        parts.append(told.format(right=right, all=len(judged), named=named, unknown=unknown))
    return " ".join(parts)


def errors(found: Diagnosis) -> str:
    """How far off a formula is, and how far once it is repaired."""
    if not math.isfinite(found.error_before):
        text = _("The answer has another shape, or is no number")
    else:
        text = _("Largest relative error {error}").format(error=size(found.error_before))
    if found.error_after is None:
        return text
    return _("{before}; {error} once repaired").format(before=text, error=size(found.error_after))


def at_most(group: Group) -> str:
    """The largest error of the corrected form, and the robots it is of, where there are any."""
    error = size(group.worst.corrected.max_error)
    if group.robots == NO_ROBOT:
        return _("error {error} at most").format(error=error)
    return _("error {error} at most on {robots}").format(error=error, robots=group.robots)


def counts(groups: Sequence[Group]) -> str:
    """How many formulas, rows, misprints and failures, in one sentence."""
    rows = [row for group in groups for row in group.rows]
    states = sum(row.corrected.samples for row in rows)
    misprints = sum(group.printed_error is not None for group in groups)
    wrong = sum(not group.ok for group in groups)
    if wrong:
        told = _("{formulas} on {mechanisms}, {rows}, {states}; {misprints} shown; {wrong} WRONG.")
    else:
        told = _(
            "{formulas} on {mechanisms}, {rows}, {states}; {misprints} shown; every correct form "
            "agrees."
        )
    return told.format(
        formulas=several(len(groups), "formula"),
        mechanisms=several(len({row.robot for row in rows}), "mechanism"),
        rows=several(len(rows), "row"),
        states=several(states, "random state"),
        misprints=several(misprints, "misprint"),
        wrong=several(wrong, "formula"),
    )


_SEVERAL: dict[str, Callable[[int], str]] = {
    "formula": lambda n: ngettext("{count} formula", "{count} formulas", n),
    "mechanism": lambda n: ngettext("{count} mechanism", "{count} mechanisms", n),
    "row": lambda n: ngettext("{count} row", "{count} rows", n),
    "random state": lambda n: ngettext("{count} random state", "{count} random states", n),
    "misprint": lambda n: ngettext("{count} misprint", "{count} misprints", n),
}


def several(count: int, word: str) -> str:
    """A number with its noun."""
    return _SEVERAL[word](count).format(count=count)


def origin(groups: Sequence[Group]) -> str:
    """What it takes to get the same report again."""
    from kinlab.host.version import __version__

    if not groups:
        told = _("Made by kinlab {version}: the same seed gives the same states.")
        return told.format(version=__version__)
    told = _("Made by kinlab {version}, seed {seed}: the same seed gives the same states.")
    return told.format(version=__version__, seed=groups[0].rows[0].corrected.seed)


def sentence(text: str) -> str:
    """A line as a sentence: capital at the front, full stop at the end."""
    return text[:1].upper() + text[1:] + ("" if text.endswith((".", "。")) else _("."))


# -------- A small picture of how errors are spread over the states, as SVG text

LOW, HIGH = -17, 2
"""Decades shown; what lies outside falls into the first or last bar."""

_WIDTH, _HEIGHT, _FOOT = 380.0, 64.0, 18.0
_STEP = _WIDTH / (HIGH - LOW)


def decades(errors: Array) -> Array:
    """How many errors fall into each decade; zeros in the first, infinities in the last.

    Returns:
        (HIGH - LOW,) counts; their sum is the number of errors.
    """
    clipped = np.clip(errors, 10.0**LOW, 10.0**HIGH)
    place = np.clip(np.floor(np.log10(clipped)).astype(int) - LOW, 0, HIGH - LOW - 1)
    return np.bincount(place, minlength=HIGH - LOW).astype(float)


def svg(corrected: Array, printed: Array | None) -> str:
    """The two spreads over decades of relative error, with the line of agreement.

    Args:
        corrected: errors of the corrected form.
        printed: errors of the printed form, if there is one.
    """
    series = [("good", corrected)] + ([("bad", printed)] if printed is not None else [])
    parts = [
        f'<svg class="spread" viewBox="0 0 {_WIDTH:g} {_HEIGHT + _FOOT:g}" role="img" '
        f'aria-label="{_label(corrected, printed)}">'
    ]
    for name, errors in series:
        counts = decades(errors)
        for k, share in enumerate(counts / np.max(counts)):
            if share > 0.0:
                tall = max(2.0, share * (_HEIGHT - 4.0))
                parts.append(
                    f'<rect class="{name}" x="{k * _STEP + 1.5:.1f}" y="{_HEIGHT - tall:.1f}" '
                    f'width="{_STEP - 3:.1f}" height="{tall:.1f}" rx="1.5"/>'
                )
    parts.append(f'<path class="axis" d="M0 {_HEIGHT:g}H{_WIDTH:g}"/>')
    limit = (np.log10(TOLERANCES.formula_agrees) - LOW) * _STEP
    parts.append(f'<path class="limit" d="M{limit:.1f} 0V{_HEIGHT:g}"/>')
    for power in range(LOW + 2, HIGH, 3):
        x = (power - LOW) * _STEP
        text = "1" if power == 0 else f"10<tspan dy='-4' font-size='8'>{power}</tspan>"
        parts.append(f'<text x="{x:.1f}" y="{_HEIGHT + 14:g}">{text}</text>')
    return "".join([*parts, "</svg>"])


def _label(corrected: Array, printed: Array | None) -> str:
    if printed is None:
        told = _("relative errors: corrected form at most {error}")
        return told.format(error=f"{np.max(corrected):.1e}")
    told = _("relative errors: corrected form at most {error}, printed form up to {printed}")
    return told.format(error=f"{np.max(corrected):.1e}", printed=f"{np.max(printed):.1e}")
