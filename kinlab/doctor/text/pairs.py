"""Pairs of effects that make up a difference, found without trying each with each."""

from __future__ import annotations

import numpy as np

from kinlab.arrays import Array

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
