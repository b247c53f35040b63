"""Singular configurations of an arm: found from many seeds, grouped into families."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, overload

import numpy as np

from kinlab.analysis.metrics import counting
from kinlab.analysis.singularities import singular_set as sets
from kinlab.analysis.singularities.edge import edge
from kinlab.analysis.singularities.minors import factors
from kinlab.analysis.singularities.singular_set import holds, pinned, pinned_pairs, supports
from kinlab.analysis.singularities.singularity import Singularity, describe, held_by, placed
from kinlab.analysis.structure.task_space import (
    TaskSpace,
    read_reachable_task,
    revolute,
    search_box,
    wrap,
)
from kinlab.arrays import Array, between, seed_of, whole
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction, Rows, counted, numbered, vector
from kinlab.host.progress import pulse, takes_long
from kinlab.model.library import ArmLike, as_robot
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True, repr=False)
class SingularFamily(Answer):
    """Configurations on one sheet of the singular set.

    Attributes:
        kind: class of its members; ``boundary/interior`` where they differ.
        deciding: names of the joints that decide; the others are free.
        pinned: values of the deciding joints where each is fixed on this sheet; empty where
            they vary together along a curve or surface.
        beyond: whether the tool passes on in the lost direction at the representative, see
            :mod:`kinlab.analysis.singularities.edge`: ``True`` is proved; ``False``, on the edge of
            the workspace, is found; ``None`` is undecided.
        members: found configurations, the representative first.
        evidence: how the free joints were moved, and what the edge rests on.
    """

    kind: str
    deciding: tuple[str, ...]
    pinned: tuple[float, ...]
    beyond: bool | None
    members: tuple[Singularity, ...] = field(repr=False)
    evidence: Evidence = field(repr=False)

    def introduction(self) -> Introduction:
        """What holds the family, and whether the tool passes on."""
        beyond = {
            True: "the tool can pass on",
            False: "an edge of the workspace",
            None: "undecided",
        }
        return Introduction(
            f"family of {self.kind} singularities, {held_by(self.deciding, self.pinned)}",
            (
                f"in the lost direction ({self.representative.lost_direction}): "
                f"{beyond[self.beyond]}",
                str(self.evidence),
            ),
        )

    @property
    def representative(self) -> Singularity:
        """One configuration of the family."""
        return self.members[0]


@dataclass(frozen=True)
class Effort:
    """What a search did: the proof that it looked.

    Attributes:
        seeds: starting points. converged: those that reached a solution within the limits.
        last_new: number of the seed that showed the last new family; far below ``seeds`` means
            that going on would most likely show no more.
        seed: of the random numbers.
    """

    seeds: int
    converged: int
    last_new: int
    seed: int


@dataclass(frozen=True, repr=False)
class SingularitySearch(Rows, Sequence[Singularity]):
    """Answer of :func:`find_singularities`: a sequence of configurations, grouped in families.

    Attributes:
        robot: its name. task: the task. suggested: kinlab chose the task.
        families: sheets of the singular set. Empty: none was found within the joint limits.
        effort: seeds and convergence.
        evidence: what was searched, and what is proved of it.
    """

    robot: str
    task: str
    suggested: bool
    families: tuple[SingularFamily, ...]
    effort: Effort
    evidence: Evidence = field(repr=False)

    def columns(self) -> dict[str, Any]:
        """Configuration by configuration, with the family it belongs to."""
        members = [(k, s) for k, family in enumerate(self.families, 1) for s in family.members]
        return {
            "family": [k for k, _ in members],
            "kind": [s.kind for _, s in members],
            **(numbered("q", [s.q for _, s in members]) if members else {}),
            "ratio": [s.ratio for _, s in members],
            "rank": [s.rank for _, s in members],
            "deciding": [" ".join(s.deciding) for _, s in members],
            "lost": [s.lost_direction for _, s in members],
        }

    def introduction(self) -> Introduction:
        """How many families there are, what decides each, and what the search rests on."""
        kinds = counted(len(self.families), "family") + " of singular configurations"
        chosen = " (chosen for this arm)" if self.suggested else ""
        rows = tuple(
            (
                family.kind,
                ", ".join(family.deciding),
                vector(family.pinned, 6) if family.pinned else "together",
                family.representative.lost_direction,
            )
            for family in self.families
        )
        return Introduction(
            f"{self.robot}, task {self.task}{chosen}: {kinds} within the joint limits",
            (str(self.evidence),),
            ("kind", "decided by", "at, rad or m", "lost direction") if rows else (),
            rows,
        )

    @property
    def configurations(self) -> tuple[Singularity, ...]:
        """All configurations, family by family."""
        return tuple(s for family in self.families for s in family.members)

    def __len__(self) -> int:
        return len(self.configurations)

    @overload
    def __getitem__(self, index: int) -> Singularity: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Singularity, ...]: ...
    def __getitem__(self, index: int | slice) -> Singularity | tuple[Singularity, ...]:
        return self.configurations[index]

    def __iter__(self) -> Iterator[Singularity]:
        return iter(self.configurations)


@takes_long("singularities")
def find_singularities(
    robot: ArmLike, task: Any = "auto", *, points: int = 8, seed: int = 0, keep: int = 12
) -> SingularitySearch:
    """Configurations on the singular set within the joint limits, sheet by sheet.

    A sheet is told by the joints that hold it
    (:func:`kinlab.analysis.singularities.singular_set.supports`): its free joints were moved, far,
    and the arm stayed singular. Points where two sheets cross, and extrema of one, are members of a
    sheet and no families. Starts are the dips of sigma_min along the line of every joint through
    several points, each solved to rounding by Newton on the bordered system of
    :mod:`kinlab.analysis.singularities.singular_set`; zeros of factors of one joint are exact, and
    of a redundant arm every pair of joints is scanned for values that suffice alone. Such an arm is
    singular where its rank drops below the number of task rows.

    Args:
        robot: the robot.
        task: a name, a mask of six booleans, or ``"auto"``; the answer states it.
        points: base points of the search; n lines and one projection start from each.
        seed: of the base points; the same seed gives the same answer.
        keep: most members listed of one family.

    Returns:
        The families and their members, each with sigma_min / sigma_max <= 1e-10.

    Raises:
        NameUnknownError, OptionError: an unknown task, or one whose coordinates the arm can
            never move independently (every configuration is singular).
    """
    robot = as_robot(robot)
    points, keep, seed = whole(points, "points"), whole(keep, "keep"), seed_of(seed)
    space = read_reachable_task(robot, task)
    system = sets.whole_system(space)
    starts = sets.seeds(system, np.random.default_rng(seed), points)
    x, good = sets.project(system, starts)
    known: list[_Sheet] = []
    last_new = 0
    states = [*_exact(space), *(state for _, state in _pairs(space))]
    exact = len(states)
    states += list(system.states(x[good]))
    numbers = [0] * exact + [int(k) + 1 for k in np.flatnonzero(good)]
    for number, state in zip(numbers, states, strict=True):
        pulse()
        if not _lost(space, state):
            continue  # solved, but not to the digits that are promised
        sheet = next((one for one in known if one.has(space, state)), None)
        if sheet is None:
            held = supports(space, state)[0]
            sheet = _Sheet(held, pinned(space, state, held), state, [])
            known.append(sheet)
            last_new = number
        if len(sheet.members) < keep and not any(_close(state, q) for q in sheet.members):
            sheet.members.append(state)
    families = [_family(space, sheet) for sheet in known]
    families.sort(key=lambda f: (f.kind, len(f.deciding), f.deciding, _rounded(f.pinned)))
    effort = Effort(len(starts), int(good.sum()), last_new, seed)
    return SingularitySearch(
        robot.name,
        space.name,
        space.suggested,
        tuple(families),
        effort,
        _evidence(space, effort, exact),
    )


@dataclass
class _Sheet:
    """A sheet while it is being filled: the joints that hold it, and its states."""

    held: tuple[int, ...]
    pinned: bool
    first: Array
    members: list[Array]

    def has(self, space: TaskSpace, q: Array) -> bool:
        """Whether q lies on it."""
        if self.pinned:
            turns = revolute(space.robot)[list(self.held)]
            apart = q[list(self.held)] - self.first[list(self.held)]
            apart = np.where(turns, 2.0 * np.sin(0.5 * apart), apart)
            return bool(np.abs(apart).max() < TOLERANCES.same_pinned_value)
        return holds(space, q, self.held)


def _exact(space: TaskSpace) -> Iterator[Array]:
    """A state on every zero, within the limits, of the factors of one revolute joint."""
    lower, upper = search_box(space.robot)
    for factor in factors(space) or ():
        if len(factor.joints) == 1 and factor.turns[0] and factor.degrees[0] == 1:
            joint = factor.joints[0]
            a, c, s = factor.coefficients[:, 0]
            middle, cosine = np.arctan2(s, c), np.clip(-a / np.hypot(c, s), -1.0, 1.0)
            # two zeros that fell together are known to half the digits: the middle is tried too
            near = np.round(cosine) if abs(cosine) > 1.0 - TOLERANCES.zeros_together else cosine
            halves = np.arccos([cosine, near])
            for value in sorted({float(middle + h) for h in (*halves, *-halves)}):
                state = np.random.default_rng(10).uniform(lower, upper)
                state[joint] = value
                state = wrap(space.robot, state)
                inside = between(state[joint], lower[joint], upper[joint], TOLERANCES.limit_digits)
                if inside and holds(space, state, (joint,)) and _lost(space, state):
                    yield np.clip(state, lower, upper)


def _lost(space: TaskSpace, q: Array) -> bool:
    """Whether rank is lost at q to the digits that are promised."""
    sigma = np.linalg.svd(space.jacobian(q, space.scale), compute_uv=False)
    return not counting(sigma).all()


def _pairs(space: TaskSpace) -> Iterator[tuple[tuple[int, int], Array]]:
    """Of a redundant arm, one state on each pair of values that suffices and is no less."""
    if space.m == space.robot.n:
        return
    seen: list[_Sheet] = []
    for pair, state in pinned_pairs(space):
        if any(holds(space, state, (i,)) for i in pair):
            continue  # one of the two suffices
        if not any(one.held == pair and one.has(space, state) for one in seen):
            seen.append(_Sheet(pair, pinned(space, state, pair), state, []))
            yield pair, state


def _evidence(space: TaskSpace, effort: Effort, exact: int) -> Evidence:
    searched = f"{effort.seeds} starts along every joint's line (seed {effort.seed})"
    if space.m < space.robot.n:
        searched += ", and the plane of every pair of joints"
    return Evidence(
        searched,
        effort.converged,
        effort.seeds,
        "every listed configuration is singular",
        "that it stays so wherever its family's free joints are (tried at random states), and that "
        "there is no other family"
        + ("" if not exact else f"; the last new one came with start {effort.last_new}"),
    )


def _family(space: TaskSpace, sheet: _Sheet) -> SingularFamily:
    """The family of a sheet, the members in general position on it first."""
    found = [describe(space, q, sheet.held, sheet.pinned) for q in sheet.members]
    sound = [s for s in found if s is not None]
    # where sheets cross the rank is lower: such members come last
    sound.sort(key=lambda s: -s.rank)
    first = sound[0]
    kinds = {s.kind for s in sound if s.rank == first.rank}
    judged = edge(space, first.q, first.lost)
    if first.kind:
        kind = min(kinds, key=len)
    else:
        sound = [placed(space, first, judged), *(placed(space, s) for s in sound[1:])]
        kind = "/".join(sorted({s.kind for s in sound}))
    free = space.robot.n - len(sheet.held)
    evidence = Evidence(
        f"{free} free joints moved far, at random within their limits; {judged.evidence.searched}",
        len(sound),
        None,
        "; ".join(filter(None, ["singular at every state tried", judged.evidence.proved])),
        judged.evidence.found,
    )
    return SingularFamily(kind, first.deciding, first.pinned, judged.beyond, tuple(sound), evidence)


def _rounded(pinned: tuple[float, ...]) -> tuple[float, ...]:
    """Pinned values to the digits in which two families differ."""
    unit = TOLERANCES.same_pinned_value
    return tuple(round(value / unit) * unit for value in pinned)


def _close(one: Array, two: Array) -> bool:
    return bool(np.max(np.abs(one - two)) < TOLERANCES.same_pinned_value)
