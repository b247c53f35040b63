"""Pairs of effects that make up a difference, found without trying each with each."""

from __future__ import annotations

import numpy as np

from kinlab.arrays import Array
from kinlab.tolerances import TOLERANCES

_DENSE = 50
"""Changes with equal effects that are tried as partners of one change."""


def pairs_adding_up(rows: Array, goal: Array, allowance: float) -> list[tuple[int, int]]:
    """Pairs of rows that add up to the goal, by sorting one projection."""
    weights = np.random.default_rng(5).uniform(0.5, 1.5, rows.shape[1])
    line = rows @ weights
    order = np.argsort(line, kind="stable")
    line = line[order]
    wide = allowance * rows.shape[1]
    low = np.searchsorted(line, goal @ weights - line - wide)
    high = np.searchsorted(line, goal @ weights - line + wide)
    # rows with equal projections stand in the order of the list, and are taken or left together
    group = np.concatenate([[0], np.cumsum(np.diff(line) > wide)])
    order = order[np.lexsort((order, group))]
    pairs = []
    for i in np.flatnonzero(high > low):
        first = np.searchsorted(group, group[low[i]])
        last = np.searchsorted(group, group[high[i] - 1], side="right")
        for j in range(first, min(last, first + _DENSE)):
            one, two = int(order[i]), int(order[j])
            if one < two and np.max(np.abs(rows[one] + rows[two] - goal)) <= allowance:
                pairs.append((one, two))
    return pairs


def pairs_in_product(effects: Array, wanted: Array, own: Array) -> list[tuple[int, int]]:
    """Pairs of changes of one product: their ratios multiply, so the logarithms add up.

    Args:
        effects: what each adds to the product, (E, P).
        wanted: what is missing, (P,).
        own: the product's value, (P,).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        goal, logs = _log_size(1 + wanted / own), _log_size(1 + effects / own)
    usable = np.flatnonzero(np.isfinite(logs).all(axis=1))
    if not len(usable) or not np.isfinite(goal).all():
        return []
    pairs = pairs_adding_up(logs[usable], goal, 1e-8)
    return [(int(usable[one]), int(usable[two])) for one, two in pairs]


def _log_size(ratio: Array) -> Array:
    """log|ratio|; minus infinity where the ratio is rounding about zero."""
    size = np.abs(ratio)
    logs: Array = np.log(np.where(size > TOLERANCES.no_effect, size, 0.0))
    return logs
