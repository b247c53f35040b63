"""``kl.design_fivebar``: the lengths of a five-bar for a rectangle, with the proof of its worst."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, seed_of
from kinlab.errors import UnreachableError
from kinlab.fivebar.arguments import Mode
from kinlab.fivebar.design.goals import GOALS
from kinlab.fivebar.design.problem import Problem, Range, read_problem
from kinlab.fivebar.design.search import Progress, evolve, exchange, search_points
from kinlab.fivebar.linkage import FiveBar
from kinlab.fivebar.workspace import Rectangle
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Told
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True)
class Proved:
    """One goal of a design, over the whole rectangle.

    Attributes:
        value: the worst that is reached. bound: the worst that can be, at most.
        unit: of both.
    """

    value: float
    bound: float
    unit: str


def _is_proved(goal: Proved) -> bool:
    """Whether value and bound are one, but for a thousandth."""
    return bool(
        abs(goal.bound - goal.value) <= TOLERANCES.goal_proved * max(abs(goal.value), 1e-300)
    )


@dataclass(frozen=True, repr=False)
class FiveBarDesign(Told):
    """A five-bar for a rectangle.

    Attributes:
        fivebar: the linkage; without masses.
        workspace: the rectangle, at the height that was found where it is free, m.
        mode: working mode.
        goals: all goals by name, weighed or not, with value and bound over the whole rectangle.
        weights: what was made least.
        limits: what was asked.
        at_limit: lengths and limits at which the design lies; the goal would gain beyond them.
        seed: of the search.
    """

    fivebar: FiveBar
    workspace: Rectangle
    mode: tuple[int, int]
    goals: dict[str, Proved]
    weights: dict[str, float]
    limits: dict[str, float]
    at_limit: tuple[str, ...]
    seed: int

    @property
    def lengths(self) -> tuple[float, float, float]:
        """l1, l2, e, m."""
        return float(self.fivebar.l1[0]), float(self.fivebar.l2[0]), self.fivebar.e

    @property
    def evidence(self) -> Evidence:
        """The worst over the rectangle is proved; that no other lengths do better is found."""
        unproved = [name for name, goal in self.goals.items() if not _is_proved(goal)]
        proved = "no pose of the rectangle is worse than the bound of each goal"
        if unproved:
            proved += f" (far from what was found for {', '.join(unproved)})"
        return Evidence(
            f"lengths by differential evolution (seed {self.seed}) and SLSQP",
            proved=proved,
            found="that no other lengths do better",
        )

    @property
    def gap(self) -> float:
        """Largest of bound less value over the goals, in parts of the value."""
        return max(abs(g.bound - g.value) / max(abs(g.value), 1e-300) for g in self.goals.values())

    @property
    def remarks(self) -> tuple[str, ...]:
        """Which goals are not proved: their bound is far from the value reached, or infinite."""
        return tuple(
            f"{GOALS[name].words}: NOT proved; {goal.value:.5g} {goal.unit} is what was found, and "
            f"the bound is {goal.bound:.5g}: the design comes near a singularity; a limit such as "
            "condition=10 keeps it away"
            for name, goal in self.goals.items()
            if not _is_proved(goal) and (name in self.weights or name in self.limits)
        )

    @property
    def sentence(self) -> str:
        """The verdict in a line."""
        l1, l2, e = self.lengths
        aims = ", ".join(
            f"{GOALS[goal].words} {self.goals[goal].value:.5g} {GOALS[goal].unit}".rstrip()
            for goal in self.weights
        )
        return f"l1 {l1:.6g}, l2 {l2:.6g}, e {e:.6g} m: {aims}"

    def __str__(self) -> str:
        box = self.workspace
        lines = [
            self.sentence,
            f"over x {box.x_min:.6g} to {box.x_max:.6g}, y {box.y_min:.6g} to {box.y_max:.6g} m, "
            f"working mode ({self.mode[0]:+d}, {self.mode[1]:+d})",
            *(
                f"  {GOALS[name].words}: {_bounded(goal)}"
                for name, goal in self.goals.items()
                if name in self.weights or name in self.limits or goal.value or goal.bound
            ),
        ]
        lines += self.remarks
        if self.at_limit:
            lines.append(f"at the limit of {', '.join(self.at_limit)}: beyond it there is more")
        return "\n".join(lines)


def _bounded(goal: Proved) -> str:
    """A goal's value, and the bound that is proved of it."""
    if not np.isfinite(goal.bound):
        return f"{goal.value:.6g} {goal.unit}".rstrip() + ", found; no bound"
    return f"{goal.value:.6g}, proved to {goal.bound:.6g} {goal.unit}".rstrip()


def design_fivebar(
    workspace: ArrayLike,
    goal: str | Mapping[str, float] = "condition",
    *,
    l1: Range = None,
    l2: Range = None,
    e: Range = None,
    height: Range = None,
    limits: Mapping[str, float] | None = None,
    payload: float | None = None,
    mode: Mode | None = None,
    seed: int = 0,
    progress: Progress | None = None,
    resume: str | Path | None = None,
) -> FiveBarDesign:
    """Searches l1, l2 and e of a symmetric five-bar that suit a rectangle.

    The worst over the rectangle is what counts, and it is proved: a bound by branch and bound, no
    maximum over grid points. That no other lengths do better is found by search, not proved. The
    base pins lie on y = 0 at (±e, 0). Where the rectangle's height is free, a larger machine is
    better conditioned without end: give the lengths a range, a limit of size, or a mix of goals.

    Args:
        workspace: (x_min, x_max, y_min, y_max), m.
        goal: ``"condition"``, ``"size"``, ``"torque"``, ``"clearance"`` or ``"transmission"``, or
            several with weights: the sum of weight · value is made least, lengths in parts of the
            rectangle's diagonal and torque of the payload's weight times the diagonal; clearance
            counts negative, and transmission as the cosine of its angle.
        l1, l2, e: (least, largest) of each, m, or one number that is kept; none: 0.02 to 2.5
            times the farthest corner's distance (of the rectangle's diagonal where it may move;
            e from 0).
        height: (least, largest) of the rectangle's lower edge, m: y_max - y_min is kept and y is
            found. None leaves the rectangle where it is.
        limits: what a goal may not exceed, or for clearance (m) and transmission (degrees) fall
            below, as in ``{"transmission": 40, "size": 1.2}``.
        payload: kg; the goal torque is the worst crank torque that holds its weight, its force
            taken in any direction.
        mode: signs of u_i x w_i; none: elbows outward, the tool on the side of the rectangle.
        seed: the same seed gives the same answer.
        progress: called with generation, generations and the best cost so far.
        resume: a file that holds the state of the search: it is kept up to date, and a search that
            was stopped goes on from it to the same answer.

    Returns:
        The design with every goal's value and bound.

    Raises:
        UnreachableError: no linkage within the limits; names the nearest and what it misses.
        OptionError: an impossible rectangle, range, goal, limit or weight.
        FileError: ``resume`` is the state of another search.
    """
    problem = read_problem(workspace, goal, l1, l2, e, height, limits, payload, mode)
    file = None if resume is None else Path(resume)
    return solve(problem, seed_of(seed, "design_fivebar: seed"), None, progress, file)


def solve(
    problem: Problem,
    seed: int,
    starts: Array | None = None,
    progress: Progress | None = None,
    file: Path | None = None,
    generations: int | None = None,
) -> FiveBarDesign:
    """The search of one problem; as :func:`design_fivebar`."""
    some = {} if generations is None else {"generations": generations}
    x = evolve(problem, seed, starts, progress, file, **some)
    require_feasible(problem, x)
    return finish(problem, _onto_bounds(problem, exchange(problem, x)), seed)


def _onto_bounds(problem: Problem, x: Array) -> Array:
    """Lengths that differ from a bound by rounding, on it: e is 0, not 1e-15 m."""
    near = 1e-9 * (problem.high - problem.low)
    x = np.where(x - problem.low < near, problem.low, x)
    return np.where(problem.high - x < near, problem.high, x)


def finish(problem: Problem, x: Array, seed: int) -> FiveBarDesign:
    """The design of one candidate, with the proof of its goals.

    Raises:
        UnreachableError: it breaks a limit.
    """
    require_feasible(problem, x)
    proof, _ = problem.proved(x)
    goals = {}
    for name, one in GOALS.items():
        value, bound = (one.shown(worst) for worst in proof[name])
        goals[name] = Proved(value, bound, one.unit)
    return FiveBarDesign(
        fivebar=problem.linkage(x),
        workspace=problem.box_of(x),
        mode=problem.mode,
        goals=goals,
        weights=dict(problem.weights),
        limits=dict(problem.limits),
        at_limit=_at_limit(problem, x, proof),
        seed=seed,
    )


def _at_limit(problem: Problem, x: Array, proof: dict[str, tuple[float, float]]) -> tuple[str, ...]:
    out = []
    for name, value, low, high in zip(problem.names, x, problem.low, problem.high, strict=True):
        near = TOLERANCES.at_end_of_range * (high - low)
        if high > low and value > high - near:
            out.append(f"{name} ≤ {high:.4g} m")
        if high > low and value < low + near and low > 0.0:
            out.append(f"{name} ≥ {low:.4g} m")
    for name, limit in problem.limits.items():
        allowed = GOALS[name].inner(limit)
        if name not in problem.weights and proof[name][0] > allowed - 1e-3 * abs(allowed):
            sign = "≤" if GOALS[name].most else "≥"
            out.append(f"{name} {sign} {limit:g} {GOALS[name].unit}".rstrip())
    return tuple(out)


def require_feasible(problem: Problem, x: Array) -> None:
    """Refuses the best candidate of a search if it breaks a limit.

    Raises:
        UnreachableError: names the nearest linkage and what it misses.
    """
    points = search_points()
    pieces = problem.pieces(x[None], points)
    breaks = {
        name: float(np.nan_to_num(values, nan=1.0).max())
        for name, values in problem.excess(x[None], pieces).items()
    }
    box = problem.box_of(x)
    place = f"the rectangle x {box.x_min:g} to {box.x_max:g}, y {box.y_min:g} to {box.y_max:g} m"
    near = ", ".join(f"{n} {v:.4g}" for n, v in zip(problem.names, x, strict=True))
    missed = []
    for name, limit in problem.limits.items():
        if breaks[name] > 1e-6:
            values = pieces[name] if name in pieces else np.array([x[:3].sum()])
            worst = float(np.nanmax(values))
            asked = f"{limit:g} {GOALS[name].unit}".rstrip()
            missed.append(f"{name} {GOALS[name].shown(worst):.4g} where {asked} is asked")
    if missed:
        raise UnreachableError(
            f"no linkage meets all limits over {place}; the nearest, {near} m, has "
            f"{', '.join(missed)}"
        )
    if breaks["reach"] > TOLERANCES.design_slack:
        far = np.hypot(max(abs(box.x_min), abs(box.x_max)), max(abs(box.y_min), abs(box.y_max)))
        longest = float(problem.high[0] + problem.high[1])
        why = (
            f"l1 + l2 is at most {longest:.4g} m, and the farthest corner is {far:.4g} m from the "
            f"origin; with e = 0, l1 + l2 above {far:.4g} m would reach it"
            if longest < far
            else "no leg spans its nearest and farthest places from a base pin; move the rectangle "
            "from the pins, or widen the lengths"
        )
        raise UnreachableError(f"{place} is out of reach of every linkage within the limits: {why}")
    if breaks["rods"] > TOLERANCES.design_slack:
        raise UnreachableError(
            f"{place} holds a singularity for every linkage within the limits (the rods get in "
            f"line); the nearest is {near} m; widen the lengths, or move the rectangle from the "
            "base pins"
        )
