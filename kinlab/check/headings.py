"""Words that the page and the Markdown report share."""

from __future__ import annotations

import math
from collections.abc import Sequence

from kinlab.check.finding import Finding
from kinlab.check.summary import Group, size

NOTES = {
    "000": "Note 000: kinematics, Jacobian, inverse kinematics, statics, dynamics",
    "001": "Note 001: Lagrange, the planar 2R arm with point masses",
    "002": "Note 002: Lagrange in general, standard DH",
    "003": "Note 003: the two-degree-of-freedom parallel robot",
    "table": "Arms: the DH table by hand beside the engines",
}
"""Section titles by note number; ``table`` for the checks of single arms."""

HOW = (
    "Each formula is evaluated by hand and by the engine (Pinocchio) at random states. The error "
    "of a state is the largest difference of an entry over the largest entry of the engine's "
    "answer. A corrected form must stay below 1e-9; a misprint must show above 1e-3."
)


TAKEN_APART = (
    "Where a formula of yours differs, the doctor looks for what is wrong in it. It names a cause "
    "only if repairing it leaves less than 1e-9 at every state."
)


def lead(groups: Sequence[Group], findings: Sequence[Finding]) -> str:
    """What was found, in a sentence or two."""
    parts = [counts(groups)] if groups or not findings else []
    if findings:
        right = sum(one.agrees for one in findings)
        named = sum(one.known and not one.agrees for one in findings)
        told = f"Formulas in files: {right} of {len(findings)} right"
        told += f", what is wrong is known of {named}" if named else ""
        unknown = len(findings) - right - named
        parts.append(told + (f", unknown of {unknown}." if unknown else "."))
    return " ".join(parts)


def errors(finding: Finding) -> str:
    """How far off a formula is, and how far once it is repaired."""
    if not math.isfinite(finding.error_before):
        text = "The answer has another shape, or is no number"
    else:
        text = f"Largest relative error {size(finding.error_before)}"
    if finding.error_after is None:
        return text
    return f"{text}; {size(finding.error_after)} once repaired"


def counts(groups: Sequence[Group]) -> str:
    """How many formulas, rows, misprints and failures, in one sentence."""
    rows = [row for group in groups for row in group.rows]
    states = sum(row.corrected.samples for row in rows)
    misprints = sum(group.printed_error is not None for group in groups)
    wrong = sum(not group.ok for group in groups)
    text = (
        f"{several(len(groups), 'formula')} on "
        f"{several(len({row.robot for row in rows}), 'mechanism')}, {several(len(rows), 'row')}, "
        f"{several(states, 'random state')}; {several(misprints, 'misprint')} shown; "
    )
    return text + (f"{several(wrong, 'formula')} WRONG." if wrong else "every correct form agrees.")


def several(count: int, word: str) -> str:
    """A number with its noun."""
    return f"{count} {word}" if count == 1 else f"{count} {word}s"


def origin(groups: Sequence[Group]) -> str:
    """What it takes to get the same report again."""
    from kinlab import __version__

    first = groups[0].rows[0].corrected if groups else None
    seed = f", seed {first.seed}" if first is not None else ""
    return f"Made by kinlab {__version__}{seed}: the same seed gives the same states."


def sentence(text: str) -> str:
    """A line as a sentence: capital at the front, full stop at the end."""
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")
