"""How far a configuration is from the nearest singular one, and where that is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis import singular_set as sets
from kinlab.analysis.metrics import SINGULAR, singular_values
from kinlab.analysis.singularity import Singularity, describe_singularity
from kinlab.analysis.solver import solve
from kinlab.analysis.task_space import read_reachable_task, revolute
from kinlab.arrays import Array
from kinlab.errors import OptionError
from kinlab.options import seed_of, whole
from kinlab.robot import Robot
from kinlab.states import joint_vector

_SLIDERS = 96
"""Solutions, nearest first, that slide towards q; each sheet has dozens among them."""


@dataclass(frozen=True)
class NearestSingularity:
    """Answer of :func:`nearest_singularity`.

    Attributes:
        distance: Euclidean distance in joint space, rad (and m for prismatic joints); infinity
            where no singular configuration was found within the limits.
        singularity: the configuration there, or ``None``.
        sigma: singular values at the q that was asked about, descending, entries in metres over
            ``length``. length: metres.
        starts: how many starts the search used.
    """

    distance: float
    singularity: Singularity | None
    sigma: Array
    length: float
    starts: int


def nearest_singularity(
    robot: Robot, q: ArrayLike, task: Any = "auto", *, points: int = 4, seed: int = 0
) -> NearestSingularity:
    """The singular configuration nearest to q in joint space, within the limits.

    Each start is a point of the singular set; it slides along the set towards q (Gauss-Newton
    on the constraint, the rest of the way along its tangent) until the way to q is normal to it.

    Args:
        robot: the robot.
        q: joint positions, (n,).
        task: as in :func:`kinlab.find_singularities`.
        points: base points of the search besides q itself.
        seed: of the base points.

    Raises:
        StateError, NameUnknownError, OptionError: as :func:`kinlab.find_singularities`.
    """
    space, points = read_reachable_task(robot, task), whole(points, "points")
    here = joint_vector(robot, q, "q")
    if here.ndim != 1:
        raise OptionError(f"robot {robot.name!r}: q has shape {here.shape}; give one state")
    sigma = singular_values(space.jacobian(here, space.scale))
    system = sets.whole(space)
    starts = np.concatenate(
        [here[np.newaxis], sets.seeds(system, np.random.default_rng(seed_of(seed)), points)]
    )
    x, good = sets.project(system, starts)
    x = x[good]
    x[:, : robot.n] = _turned(robot, x[:, : robot.n], here)
    first = np.argsort(np.linalg.norm(x[:, : robot.n] - here, axis=1), kind="stable")
    x = _slide(system, x[first[:_SLIDERS]], here)
    if not len(x):
        return NearestSingularity(np.inf, None, sigma, space.scale, len(starts))
    distance = np.linalg.norm(x[:, : robot.n] - here, axis=1)
    for number in np.argsort(distance, kind="stable"):
        state = x[number, : robot.n]
        values = np.linalg.svd(space.jacobian(state, space.scale), compute_uv=False)
        if values[-1] <= SINGULAR * values[0]:
            found = describe_singularity(robot, state, space_mask(space.rows))
            return NearestSingularity(
                float(distance[number]), found, sigma, space.scale, len(starts)
            )
    return NearestSingularity(np.inf, None, sigma, space.scale, len(starts))


def space_mask(rows: tuple[int, ...]) -> tuple[bool, ...]:
    """The mask of six booleans of these rows."""
    return tuple(i in rows for i in range(6))


def _slide(system: sets.SingularSystem, x: Array, here: Array, steps: int = 120) -> Array:
    """Moves each solution (N, k) along the set towards ``here``; returns those that stay valid."""
    robot = system.space.robot
    n = robot.n
    lower, upper = robot.lower, robot.upper
    best = x.copy()
    size = np.ones(len(x))
    for _ in range(steps):
        active = np.flatnonzero(size > 1e-9)
        if not len(active):
            break
        _, slope = system(best[active])
        wanted = np.zeros((len(active), best.shape[1]))
        wanted[:, :n] = here - best[active, :n]
        # tangential part in q: leave out what the constraint forbids, u follows along
        step = wanted - _normal_part(slope, wanted, n)
        trial = best[active] + size[active, np.newaxis] * step
        trial[:, :n] = np.clip(trial[:, :n], lower, upper)
        trial, valid = _restore(system, trial)
        before = np.linalg.norm(best[active, :n] - here, axis=1)
        after = np.linalg.norm(trial[:, :n] - here, axis=1)
        won = valid & (after < before)
        best[active[won]] = trial[won]
        settled = won & (before - after < 1e-14 * np.maximum(before, 1.0))
        size[active[won]] = np.minimum(1.0, 2.0 * size[active[won]])
        size[active[~won]] *= 0.25
        size[active[settled]] = 0.0
    return best


def _turned(robot: Robot, q: Array, here: Array) -> Array:
    """Revolute joints of q (N, n) by whole turns as near to ``here`` as the limits allow."""
    turns = 2.0 * np.pi * np.arange(-2.0, 3.0)[:, np.newaxis, np.newaxis] * revolute(robot)
    shifted = q + turns
    outside = (shifted < robot.lower - sets.ROUNDING) | (shifted > robot.upper + sets.ROUNDING)
    apart = np.where(outside, np.inf, np.abs(shifted - here))
    chosen: Array = np.take_along_axis(shifted, apart.argmin(axis=0)[np.newaxis], axis=0)[0]
    return chosen


def _normal_part(slope: Array, wanted: Array, n: int) -> Array:
    """What to take from ``wanted`` so that the constraint keeps its value; u moves at no cost.

    Minimises |dq - wanted_q|^2 + (1e-3)^2 |du|^2 with slope (dq, du) = 0.
    """
    weight = np.ones(slope.shape[2])
    weight[n:] = 1e3  # per unit of the scaled unknown du / weight
    scaled = slope * weight
    inverse = np.linalg.pinv(scaled, rcond=1e-9)
    value = np.einsum("nij,nj->ni", slope, wanted)
    part: Array = weight * np.einsum("nij,nj->ni", inverse, value)
    return part


def _restore(system: sets.SingularSystem, x: Array) -> tuple[Array, Array]:
    robot = system.space.robot
    solved, norm = solve(system, x, iterations=25)
    q = solved[:, : robot.n]
    inside = np.all((q >= robot.lower - sets.ROUNDING) & (q <= robot.upper + sets.ROUNDING), axis=1)
    return solved, inside & (norm <= sets.CONVERGED)
