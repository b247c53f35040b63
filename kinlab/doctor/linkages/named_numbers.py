"""The robot's numbers by the names that they have in formulas, an arm's or a five-bar's."""

from __future__ import annotations

from kinlab.check.quantities.registry import split_name
from kinlab.doctor.changes import Mechanism
from kinlab.doctor.linkages import five_bar
from kinlab.fivebar import FiveBar
from kinlab.symbolic.vocabulary import vocabulary


def named_numbers(robot: Mechanism, entry: str = "") -> dict[str, float]:
    """What each name stands for; empty of an arm without a DH table.

    Args:
        robot: whose numbers.
        entry: of a five-bar whose legs differ, the formula whose leg is meant; empty for leg 1.
    """
    if isinstance(robot, FiveBar):
        index = split_name(five_bar.claimed(entry))[1] if entry else ()
        leg = int(index[0]) if index and not five_bar.is_either(five_bar.claimed(entry)) else 0  # type: ignore[arg-type]
        return five_bar.numbers_of(robot, min(max(leg, 0), 1))
    return dict(vocabulary(robot.table).values) if robot.table is not None else {}
