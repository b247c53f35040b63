"""The Pareto front of two goals: for each bound on the one, the best found of the other.

The bounds lie between the two ends of the front, so that a front that is not convex is found too
(epsilon-constraint method: Haimes, Lasdon & Wismer 1971); a weighed sum would miss its hollows.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, seed_of, whole, word
from kinlab.errors import FileError, OptionError, UnreachableError
from kinlab.fivebar.arguments import Mode
from kinlab.fivebar.design.goals import GOALS
from kinlab.fivebar.design.problem import Problem, Range, read_problem
from kinlab.fivebar.design.synthesis import FiveBarDesign, finish, solve
from kinlab.host.evidence import Evidence
from kinlab.host.files import read_text, write_text
from kinlab.host.introductions import Told
from kinlab.tolerances import TOLERANCES

_NEXT = 45
"""Generations of a point that starts from its neighbour's design."""

_CONDITION = 10.0
"""Largest condition number where none is asked: the smallest machine ends at a singularity."""


@dataclass(frozen=True, repr=False)
class DesignFront(Told):
    """Designs found of which none is better than another in both goals.

    Attributes:
        goals: the two names.
        designs: from the best found of the first goal to the best found of the second; each
            carries its own evidence.
    """

    goals: tuple[str, str]
    designs: tuple[FiveBarDesign, ...]

    @property
    def evidence(self) -> Evidence:
        """What each design rests on, and what the front as a whole does not show."""
        return Evidence(
            f"{len(self.designs)} searches, as each design's evidence says",
            proved="no pose of the rectangle is worse than the bounds of a design",
            found="that nothing lies beyond the front",
        )

    def values(self, goal: str) -> list[float]:
        """Worst values of one goal along the front."""
        return [design.goals[goal].value for design in self.designs]

    def __str__(self) -> str:
        first, second = self.goals
        lines = [f"{len(self.designs)} designs from the best {first} to the best {second}"]
        for design in self.designs:
            l1, l2, e = design.lengths
            each = ", ".join(f"{g} {design.goals[g].value:.5g} {GOALS[g].unit}" for g in self.goals)
            lines.append(f"  l1 {l1:.5g}, l2 {l2:.5g}, e {e:.5g} m: {each}".rstrip())
        return "\n".join(lines)


def fivebar_front(
    workspace: ArrayLike,
    goals: tuple[str, str] = ("condition", "size"),
    count: int = 9,
    *,
    l1: Range = None,
    l2: Range = None,
    e: Range = None,
    height: Range = None,
    limits: Mapping[str, float] | None = None,
    payload: float | None = None,
    mode: Mode | None = None,
    seed: int = 0,
    progress: Callable[[int, int], None] | None = None,
    resume: str | Path | None = None,
) -> DesignFront:
    """Designs along the Pareto front of two goals over a rectangle, each by its own search.

    Args:
        workspace, l1, l2, e, height, limits, payload, mode, seed: as
            :func:`kinlab.design_fivebar`.
        goals: the two goals. The condition number is limited to 10 where ``limits`` does not
            say otherwise: without it the smallest machine would end at a singularity.
        count: designs looked for, from 3 up; those that another one beats are left out.
        progress: called with the number of designs found and ``count``.
        resume: a file with the designs found so far; a front that was stopped goes on from it.

    Raises:
        UnreachableError, OptionError, FileError: as :func:`kinlab.design_fivebar`.
    """
    if not isinstance(goals, (tuple, list)) or len(goals) != 2 or goals[0] == goals[1]:
        raise OptionError(f"fivebar_front: goals is {goals!r}; give two different names")
    one, other = (word(goal, GOALS, "fivebar_front: goal") for goal in goals)
    number = whole(count, "fivebar_front: count", 3, 200)
    number_of_seed = seed_of(seed, "fivebar_front: seed")
    asked = dict(limits or {})
    if "condition" in (one, other):
        asked.setdefault("condition", _CONDITION)
    payload_given = payload
    if "torque" in (one, other) and payload_given is None:
        raise OptionError("fivebar_front: the goal torque needs the payload, kg; give payload=")
    first = read_problem(workspace, one, l1, l2, e, height, asked, payload, mode)
    second = replace(first, weights={other: 1.0})
    store = _Store(None if resume is None else Path(resume), first, other, number, number_of_seed)
    found: list[FiveBarDesign] = []

    def add(problem: Problem, near: FiveBarDesign | None) -> FiveBarDesign:
        known = store.next()
        if known is not None:
            design = finish(problem, np.array(known), number_of_seed)
        else:
            starts, generations = (None, None) if near is None else (_start(problem, near), _NEXT)
            design = solve(problem, number_of_seed, starts, None, None, generations)
            store.keep(_start(problem, design)[0].tolist())
        found.append(design)
        if progress is not None:
            progress(len(found), number)
        return design

    best_one = add(first, None)
    best_other = add(second, None)
    inner = GOALS[other].inner
    ends = [inner(design.goals[other].value) for design in (best_one, best_other)]
    last = best_one
    for part in np.linspace(0.0, 1.0, number)[1:-1]:
        bound = ends[0] + part * (ends[1] - ends[0])
        bound = bound + TOLERANCES.eased_bound * abs(bound)
        own = min(bound, inner(asked[other])) if other in asked else bound
        problem = replace(first, limits={**asked, other: GOALS[other].shown(float(own))})
        try:
            last = add(problem, last)
        except UnreachableError:  # so near an end that only the end's own search reaches it
            continue
    return DesignFront((one, other), _undominated([*found[:1], *found[2:], found[1]], one, other))


def _start(problem: Problem, near: FiveBarDesign) -> Array:
    x = [*near.lengths, near.workspace.y_min][: len(problem.names)]
    return np.array([x])


def _undominated(designs: list[FiveBarDesign], one: str, other: str) -> tuple[FiveBarDesign, ...]:
    marks = np.array([[GOALS[g].inner(d.goals[g].value) for g in (one, other)] for d in designs])
    slack = 1e-6 * np.abs(marks).max(axis=0)
    kept = [
        k
        for k, mark in enumerate(marks)
        if not any(
            np.all(rival <= mark + slack) and np.any(rival < mark - slack) for rival in marks
        )
    ]
    return tuple(designs[k] for k in sorted(kept, key=lambda k: (marks[k, 0], -marks[k, 1])))


class _Store:
    """The candidates found so far, in a file of one's own."""

    def __init__(
        self, file: Path | None, problem: Problem, other: str, count: int, seed: int
    ) -> None:
        self._file, self._read = file, 0
        self._key = f"{problem.key()}-{other}-{count}-{seed}"
        self._rows: list[list[float]] = []
        if file is not None and file.exists():
            try:
                state = json.loads(read_text(file))
                key = state["front"]
                self._rows = [[float(value) for value in row] for row in state["designs"]]
            except (ValueError, KeyError, TypeError):
                raise FileError(f"{file}: no state of a front; name another file") from None
            if key != self._key or any(len(row) != len(problem.names) for row in self._rows):
                raise FileError(
                    f"{file}: the state of another front; name another file, or delete this one"
                )

    def next(self) -> list[float] | None:
        """The next candidate of the file, or none."""
        if self._read >= len(self._rows):
            return None
        self._read += 1
        return self._rows[self._read - 1]

    def keep(self, x: list[float]) -> None:
        """One more candidate, written at once."""
        self._rows.append(x)
        self._read = len(self._rows)
        if self._file is not None:
            state = {"front": self._key, "designs": self._rows}
            write_text(self._file, json.dumps(state, indent=1))
