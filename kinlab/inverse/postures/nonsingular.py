"""Paths that meet no singularity, shown between the samples too.

sigma_min(J) changes by at most K |q' - q| from q to q', K a bound of J's slope from the lengths of
the arm (Weyl's inequality; :func:`kinlab.analysis.singularities.nearest.slope_bound`). A piece of a
straight line in joint space is free of singularities where sigma_min at its middle exceeds K times
half its length; a piece where it does not is cut in two and tried again.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from kinlab.analysis.singularities.nearest import slope_bound
from kinlab.analysis.structure.task_space import TaskSpace
from kinlab.arrays import Array, frozen
from kinlab.host.evidence import Evidence
from kinlab.tolerances import TOLERANCES

_SHARE = 0.5
"""Of sigma_min in the middle of a piece that is left for certain at its ends."""
_MOST = 200_000
"""Pieces looked at before a line is given up."""


@dataclass(frozen=True, eq=False)
class NonsingularPath:
    """A path of straight lines in joint space along which J never loses rank.

    Attributes:
        q: its corners, (K, n), rad or m.
        sigma: sigma_min of the task's J is above this all along, between the samples too; entries
            in metres are divided by ``length``.
        length: metres.
        slope: the bound K of J's slope that this rests on, per rad or m.
        pieces: pieces in whose middles J was evaluated.
        evidence: the same in words.
    """

    q: Array
    sigma: float
    length: float
    slope: float
    pieces: int
    evidence: Evidence = field(repr=False)

    def __len__(self) -> int:
        return len(self.q)

    def points(self, spacing: float = 0.05) -> Array:
        """Points along the path, corners included, at most ``spacing`` apart, (M, n)."""
        rows = [self.q[:1]]
        for one, two in zip(self.q[:-1], self.q[1:], strict=True):
            count = 1 + int(np.linalg.norm(two - one) / spacing)
            share = np.arange(1, count + 1)[:, np.newaxis] / count
            rows.append(one + share * (two - one))
        return np.concatenate(rows)


def show_nonsingular(space: TaskSpace, corners: Array) -> NonsingularPath | None:
    """The path through corners (K, n), if it can be shown to meet no singularity.

    Args:
        space: the task, square or wide; J's entries in metres are divided by its scale.
        corners: K >= 2 joint positions, joined by straight lines.

    Returns:
        The path with its bound, or ``None``: sigma_min falls below 1e-6 at some sample, or the
        pieces would become too many. ``None`` proves nothing.
    """
    slope = slope_bound(space)
    one, two = corners[:-1], corners[1:]
    centre, half = 0.5 * (one + two), 0.5 * (two - one)
    bound, looked = np.inf, 0
    while len(centre):
        looked += len(centre)
        if looked > _MOST:
            return None
        values = space.sigma(centre)
        least = values[:, -1] - TOLERANCES.singular_value_rounding * values[:, 0]
        if not np.all(least > TOLERANCES.path_singular):
            return None
        reach = slope * np.linalg.norm(half, axis=1)
        good = reach <= (1.0 - _SHARE) * least
        if good.any():
            bound = min(bound, float((least - reach)[good].min()))
        centre, half = centre[~good], 0.5 * half[~good]
        centre, half = np.concatenate([centre - half, centre + half]), np.concatenate([half, half])
    evidence = Evidence(
        f"{looked} pieces of {len(one)} straight lines in joint space",
        proved=f"sigma_min of J (task {space.name}, metres over {space.scale:.6g} m) is above "
        f"{bound:.3g} all along: it changes by at most {slope:.4g} per rad or m",
    )
    return NonsingularPath(frozen(corners), bound, space.scale, slope, looked, evidence)


def same_sign(space: TaskSpace, one: Array, two: Array, most: int = 64) -> Array:
    """Which lines from one to two, both (N, n), keep the sign of det J at samples: a first sieve.

    Args:
        space: a square task. most: samples of a line.

    Returns:
        (N,) of booleans. True shows nothing by itself.
    """
    share = np.linspace(0.0, 1.0, most)[:, np.newaxis]
    states = one[:, np.newaxis] + share * (two - one)[:, np.newaxis]
    flat = states.reshape(-1, one.shape[1])
    signs = np.sign(np.linalg.det(space.jacobian(flat, space.scale))).reshape(len(one), most)
    kept: Array = np.all(signs == signs[:, :1], axis=1) & (signs[:, 0] != 0.0)
    return kept
