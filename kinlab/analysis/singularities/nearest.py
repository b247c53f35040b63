"""How far a configuration is from the nearest singular one, where that is, and what is proved.

The minors of J are trigonometric polynomials (:mod:`kinlab.analysis.singularities.minors`); the
singular set is a union of their factors' zeros, each a problem in a few joints that branch and
bound solves with a lower bound (:mod:`kinlab.analysis.singularities.certified`). Where the
polynomials would be too large, points of the set slide towards q from many starts, and the bound is
Weyl's: sigma_min(J(q')) >= sigma_min(J(q)) - K |q' - q| with K a bound of J's slope from the
lengths of the arm.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.metrics import counting, singular_values
from kinlab.analysis.singularities import singular_set as sets
from kinlab.analysis.singularities.certified import nearest_zero
from kinlab.analysis.singularities.factor import Factor
from kinlab.analysis.singularities.minors import factors
from kinlab.analysis.singularities.singularity import Singularity, describe_singularity
from kinlab.analysis.solver import solve
from kinlab.analysis.structure.task_space import (
    TaskSpace,
    mask_of,
    one_state,
    read_reachable_task,
    revolute,
)
from kinlab.arrays import Array, between, seed_of, whole
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction
from kinlab.host.progress import pulse, takes_long
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES

_SLIDERS = 96
"""Solutions, nearest first, that slide towards q; each sheet has dozens among them."""


@dataclass(frozen=True, repr=False)
class NearestSingularity(Answer):
    """Answer of :func:`nearest_singularity`.

    Attributes:
        distance: Euclidean distance in joint space, rad (and m for prismatic joints), to the
            nearest singular configuration found; infinity where none was found within the limits.
        bound: no singular configuration within the limits is nearer than this: proved, up to
            rounding. Infinity: there is none at all.
        meets: distance and bound agree to 2e-6: the distance is proved.
        singularity: the configuration there, or ``None``.
        sigma: singular values at the q that was asked about, descending, entries in metres over
            ``length``. length: metres.
        evidence: what was searched, and what is proved.
    """

    distance: float
    bound: float
    meets: bool
    singularity: Singularity | None
    sigma: Array
    length: float
    evidence: Evidence = field(repr=False)

    def introduction(self) -> Introduction:
        """How far the nearest singularity is, and how sure that is."""
        if self.singularity is None:
            sure = "none within the limits" if np.isinf(self.bound) else "none found"
            return Introduction(f"nearest singularity: {sure}", (str(self.evidence),))
        sure = "proved" if self.meets else f"found; proved: none nearer than {self.bound:.6g}"
        at = ", ".join(f"{value:.5g}" for value in self.singularity.q)
        return Introduction(
            f"nearest singularity: {self.distance:.6g} away in joint space (rad, m), {sure}",
            (f"{self.singularity.kind} at q = [{at}]", str(self.evidence)),
        )


@takes_long("nearest singularity")
def nearest_singularity(
    robot: ArmLike,
    q: ArrayLike,
    task: Any = "auto",
    *,
    boxes: int = 12_000,
    points: int = 8,
    seed: int = 0,
) -> NearestSingularity:
    """The singular configuration nearest to q in joint space, within the limits.

    Args:
        robot: the robot.
        q: joint positions, (n,).
        task: as in :func:`kinlab.find_singularities`.
        boxes: most boxes of joint space that the proof may look at; more only narrow what is
            between ``bound`` and ``distance``.
        points: base points of the search from many starts, which takes the place of the proof
            where the minors of J are too large to be written out (the evidence says which way
            was taken).
        seed: of those starts; the other way draws nothing anew.

    Raises:
        StateError, NameUnknownError, OptionError: as :func:`kinlab.find_singularities`.
    """
    robot = as_robot(robot)
    boxes, points, seed = whole(boxes, "boxes"), whole(points, "points"), seed_of(seed)
    space = read_reachable_task(robot, task)
    here = one_state(robot, q)
    sigma = singular_values(space.jacobian(here, space.scale))
    parts = factors(space)
    if parts is None:
        state, bound, searched = _from_many_starts(space, here, points, seed)
    else:
        state, bound, searched = _factor_by_factor(space, parts, here, boxes)
    distance = np.inf if state is None else float(np.linalg.norm(state - here))
    bound = float(np.clip(bound, 0.0, distance))
    meets = bool(bound >= distance - 2.0 * TOLERANCES.distance_gap)
    found = None if state is None else describe_singularity(robot, state, mask_of(space.rows))
    return NearestSingularity(
        distance,
        bound,
        meets,
        found,
        sigma,
        space.scale,
        _evidence(searched, distance, bound, meets),
    )


def _evidence(searched: str, distance: float, bound: float, meets: bool) -> Evidence:
    if np.isinf(bound):
        return Evidence(searched, proved="no configuration within the limits is singular")
    proved = f"no singular configuration within the limits is nearer than {bound:.6g}"
    if meets:
        return Evidence(searched, proved=proved)
    found = f"the distance {distance:.6g}" if np.isfinite(distance) else "no singularity at all"
    return Evidence(searched, proved=proved if bound > 0.0 else "", found=found)


def _factor_by_factor(
    space: TaskSpace, parts: tuple[Factor, ...], here: Array, boxes: int
) -> tuple[Array | None, float, str]:
    robot = space.robot
    held = np.clip(here, robot.lower, robot.upper)
    best: Array | None = None
    nearest, bound, looked = np.inf, np.inf, 0
    for factor in sorted(parts, key=lambda f: len(f.joints)):
        joints = list(factor.joints)
        rest = np.delete(held - here, joints)
        aside = float(rest @ rest)  # joints outside their limits have a way to go in any case
        cut = np.sqrt(max(nearest**2 - aside, 0.0)) if np.isfinite(nearest) else np.inf
        lower = robot.lower[joints] - TOLERANCES.limit_digits
        upper = robot.upper[joints] + TOLERANCES.limit_digits
        zero = nearest_zero(factor, here[joints], lower, upper, cut, boxes)
        looked += zero.boxes
        bound = min(bound, float(np.sqrt(max(zero.bound, 0.0) ** 2 + aside)))
        if zero.x is None:
            continue
        guess = held.copy()
        guess[joints] = zero.x
        state = _polished(space, guess, joints)
        if state is None:
            continue
        distance = float(np.linalg.norm(state - here))
        if distance < nearest:
            nearest, best = distance, state
    names = [" and ".join(robot.joint_names[i] for i in f.joints) for f in parts]
    searched = f"{looked} boxes of joint space, for {'; '.join(names) or 'no joint'}"
    return best, bound, searched


def _polished(space: TaskSpace, guess: Array, joints: list[int]) -> Array | None:
    """The guess solved to rounding, joints on a limit staying there; ``None`` where it is none."""
    robot = space.robot
    guess = np.clip(guess, robot.lower, robot.upper)
    on_limit = (guess <= robot.lower) | (guess >= robot.upper)
    tries = [tuple(i for i in joints if not on_limit[i]), tuple(joints)]
    for moving in tries:
        system = sets.SingularSystem(space, moving, guess)
        x, _ = solve(system, system.start(guess[np.newaxis]))
        state: Array = np.clip(system.states(x)[0], robot.lower, robot.upper)
        values = space.sigma(state)
        if not counting(values)[-1] and np.linalg.norm(state - guess) < 1e-4:
            return state
    return None


def _from_many_starts(
    space: TaskSpace, here: Array, points: int, seed: int
) -> tuple[Array | None, float, str]:
    """The nearest of many local solutions, and Weyl's bound."""
    robot = space.robot
    system = sets.whole_system(space)
    rng = np.random.default_rng(seed)
    starts = np.concatenate([here[np.newaxis], sets.seeds(system, rng, points)])
    x, good = sets.project(system, starts)
    x = x[good]
    x[:, : robot.n] = _turned(robot, x[:, : robot.n], here)
    first = np.argsort(np.linalg.norm(x[:, : robot.n] - here, axis=1), kind="stable")
    x = _slide(system, x[first[:_SLIDERS]], here)
    least = singular_values(space.jacobian(here, space.scale))[-1]
    bound = float(least) / slope_bound(space)
    searched = f"{len(starts)} starts (seed {seed}); J's slope from the lengths of the arm"
    distance = np.linalg.norm(x[:, : robot.n] - here, axis=1)
    for number in np.argsort(distance, kind="stable"):
        state = x[number, : robot.n]
        values = space.sigma(state)
        if not counting(values)[-1]:
            return state, bound, searched
    return None, bound, searched


def slope_bound(space: TaskSpace) -> float:
    """K with |J(q') - J(q)| <= K |q' - q| in the spectral norm, entries in metres over the scale.

    d J_i / d q_j is a cross product of a unit axis with a column (or zero), so that its length is
    at most that of the column: the way from axis i to the tool, and one.
    """
    robot = space.robot
    turns = revolute(robot)
    steps = [float(np.linalg.norm(p.translation)) for p in list(robot.model.jointPlacements)[1:]]
    steps.append(float(np.linalg.norm(robot.model.frames[robot.tool].placement.translation)))
    travel = np.where(turns, 0.0, np.maximum(np.abs(robot.lower), np.abs(robot.upper)))
    reach = np.array([sum(steps[i + 1 :]) + float(travel[i:].sum()) for i in range(robot.n)])
    column = np.where(turns, (reach / space.scale) ** 2 + 1.0, 1.0)
    # joint j turns every column, those before it by at most their length as seen from j
    squares = [
        float(column[j:].sum() + j * (reach[j] / space.scale) ** 2)
        if turns[j]
        else float(j) / space.scale**2
        for j in range(robot.n)
    ]
    return float(np.sqrt(sum(squares)))


def _slide(system: sets.SingularSystem, x: Array, here: Array, steps: int = 120) -> Array:
    """Moves each solution (N, k) along the set towards ``here``; returns those that stay valid."""
    robot = system.space.robot
    n = robot.n
    lower, upper = robot.lower, robot.upper
    best = x.copy()
    size = np.ones(len(x))
    for _ in range(steps):
        pulse()
        active = np.flatnonzero(size > 1e-9)
        if not len(active):
            break
        _, derivative = system(best[active])
        wanted = np.zeros((len(active), best.shape[1]))
        wanted[:, :n] = here - best[active, :n]
        # tangential part in q: leave out what the constraint forbids, u follows along
        step = wanted - _normal_part(derivative, wanted, n)
        trial = best[active] + size[active, np.newaxis] * step
        trial[:, :n] = np.clip(trial[:, :n], lower, upper)
        trial, valid = _restore(system, trial)
        before = np.linalg.norm(best[active, :n] - here, axis=1)
        after = np.linalg.norm(trial[:, :n] - here, axis=1)
        accepted = valid & (after < before)
        best[active[accepted]] = trial[accepted]
        settled = accepted & (before - after < 1e-14 * np.maximum(before, 1.0))
        size[active[accepted]] = np.minimum(1.0, 2.0 * size[active[accepted]])
        size[active[~accepted]] *= 0.25
        size[active[settled]] = 0.0
    return best


def _turned(robot: Robot, q: Array, here: Array) -> Array:
    """Revolute joints of q (N, n) by whole turns as near to ``here`` as the limits allow."""
    turns = 2.0 * np.pi * np.arange(-2.0, 3.0)[:, np.newaxis, np.newaxis] * revolute(robot)
    shifted = q + turns
    inside = between(shifted, robot.lower, robot.upper, TOLERANCES.limit_rounding)
    apart = np.where(inside, np.abs(shifted - here), np.inf)
    chosen: Array = np.take_along_axis(shifted, apart.argmin(axis=0)[np.newaxis], axis=0)[0]
    return chosen


def _normal_part(derivative: Array, wanted: Array, n: int) -> Array:
    """What to take from ``wanted`` so that the constraint keeps its value; u moves at no cost.

    Minimises |dq - wanted_q|^2 + (1e-3)^2 |du|^2 with slope (dq, du) = 0.
    """
    weight = np.ones(derivative.shape[2])
    weight[n:] = 1e3  # per unit of the scaled unknown du / weight
    scaled = derivative * weight
    inverse = np.linalg.pinv(scaled, rcond=1e-9)
    value = np.einsum("nij,nj->ni", derivative, wanted)
    part: Array = weight * np.einsum("nij,nj->ni", inverse, value)
    return part


def _restore(system: sets.SingularSystem, x: Array) -> tuple[Array, Array]:
    robot = system.space.robot
    solved, norm = solve(system, x, iterations=25)
    q = solved[:, : robot.n]
    inside = between(q, robot.lower, robot.upper, TOLERANCES.limit_rounding)
    return solved, inside.all(axis=1) & (norm <= TOLERANCES.on_singular_set)
