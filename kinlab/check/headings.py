"""Words that the page and the Markdown report share."""

from __future__ import annotations

from collections.abc import Sequence

from kinlab.check.summary import Group

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


def counts(groups: Sequence[Group]) -> str:
    """How many formulas, rows, misprints and failures, in one sentence."""
    rows = [row for group in groups for row in group.rows]
    states = sum(row.corrected.samples for row in rows)
    misprints = sum(group.printed_error is not None for group in groups)
    wrong = sum(not group.ok for group in groups)
    text = (
        f"{len(groups)} formulas on {len({row.robot for row in rows})} mechanisms, {len(rows)} "
        f"rows, {states} random states; {misprints} misprints shown; "
    )
    return text + (f"{wrong} formulas FAIL." if wrong else "every corrected form agrees.")
