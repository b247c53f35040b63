"""The search for kinematic slips: one, then two, the simplest first."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.tables.cells import one_change, two_cells
from kinlab.doctor.tables.chain import Chain
from kinlab.doctor.tables.readings import Reading, readings
from kinlab.doctor.tables.reference.target import Target
from kinlab.doctor.tables.rows import inserted, removed
from kinlab.doctor.tables.words import SIX


def explain(
    chain: Chain, target: Target, base: list[Array], tool: list[Array], slips: Sequence[int]
) -> list[Reading]:
    """The fewest slips that, taken back, give the target's poses at every state.

    Args:
        chain: the user's table.
        target: the reference's poses.
        base, tool: frames that the reference is known to have.
        slips: numbers of slips that are looked for, of 1 and 2 in this order.

    Returns:
        All explanations of the least of these numbers, the likeliest first; none where none of
        them suffices. Where base or tool with six unknown numbers is all there is, more slips
        of known kinds are listed before it.
    """
    found: list[Reading] = []
    stages = _stages(chain, target, base, tool)
    for count in slips:
        found = _distinct([*found, *stages[count - 1]()])
        if found and found[0].cost < SIX:
            break
    return found


def _stages(
    chain: Chain, target: Target, base: list[Array], tool: list[Array]
) -> Sequence[Callable[[], list[Reading]]]:
    more = target.q.shape[1] - chain.n
    if more:
        return (
            lambda: _other_count(chain, target, more),
            lambda: _other_count_and_one(chain, target, more, base, tool),
        )
    first = readings(chain, base, tool)

    def one() -> list[Reading]:
        met = target.met_by([reading.chain for reading in first])
        solved = one_change([Reading(chain)], target)
        return [first[k] for k in met] + [r for r in solved if len(r.causes) == 1]

    def two() -> list[Reading]:
        solved = one_change([Reading(chain), *first], target) + two_cells(chain, target)
        found = [r for r in solved if len(r.causes) == 2]
        return found + _two_readings(
            first, target, base, tool, any(r.cost < SIX + 0.8 for r in found)
        )

    return one, two


def _two_readings(
    first: list[Reading], target: Target, base: list[Array], tool: list[Array], found: bool
) -> list[Reading]:
    """Two readings after one another, in one order: sorts of readings commute, up to a row's
    number."""
    if found:
        return []
    both = [
        second.after(one) for one in first for second in readings(one.chain, base, tool, one.maker)
    ]
    kept = []
    for start in range(0, len(both), 2048):
        part = both[start : start + 2048]
        kept += [part[k] for k in target.met_by([one.chain for one in part])]
    return kept


def _other_count(chain: Chain, target: Target, more: int) -> list[Reading]:
    if more == 1:
        return inserted(chain, target)
    if more == -1:
        shorter = removed(chain)
        return [shorter[k] for k in target.met_by([one.chain for one in shorter])]
    return []


def _other_count_and_one(
    chain: Chain, target: Target, more: int, base: list[Array], tool: list[Array]
) -> list[Reading]:
    if more == 1:
        found = []
        for one in readings(chain, base, tool):
            found += [r.after(one) for r in inserted(one.chain, target)]
        return found
    if more == -1:
        shorter = removed(chain)
        found = [r for r in one_change(shorter, target) if len(r.causes) == 2]
        both = [two.after(one) for one in shorter for two in readings(one.chain, base, tool)]
        return found + [both[k] for k in target.met_by([one.chain for one in both])]
    return []


def _distinct(found: list[Reading]) -> list[Reading]:
    """Without repetitions of the same repaired table, the likeliest telling of each."""
    ordered = sorted(found, key=lambda one: (round(one.cost, 6), _order(one)))
    kept: list[Reading] = []
    for one in ordered:
        if not any(_same(one.chain, other.chain) for other in kept):
            kept.append(one)
    return kept


def _order(one: Reading) -> tuple[tuple[tuple[int, ...], str, str], ...]:
    return tuple((cause.rows, cause.column, cause.kind) for cause in one.causes)


def _same(one: Chain, two: Chain) -> bool:
    if one.modified != two.modified or one.source != two.source:
        return False
    angles = np.exp(1j * one.cells[:, [1, 3]]) - np.exp(1j * two.cells[:, [1, 3]])
    return (
        bool(np.max(np.abs(angles)) < 1e-8)
        and bool(np.max(np.abs(one.cells[:, [0, 2]] - two.cells[:, [0, 2]])) < 1e-8)
        and np.array_equal(one.prismatic, two.prismatic)
        and np.array_equal(one.sign, two.sign)
        and bool(np.max(np.abs(one.base - two.base)) < 1e-8)
        and bool(np.max(np.abs(one.tool - two.tool)) < 1e-8)
    )
