"""Singular configurations: found from many seeds, grouped into families, each with its meaning."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis import singular_set as sets
from kinlab.analysis.metrics import SINGULAR
from kinlab.analysis.reach import passes_beyond
from kinlab.analysis.structure import name_singularity, structure
from kinlab.analysis.task_space import TaskSpace, read_reachable_task
from kinlab.arrays import Array, frozen
from kinlab.errors import OptionError
from kinlab.options import seed_of, whole
from kinlab.robot import Robot
from kinlab.states import joint_vector
from kinlab.tasks import COORDINATES

_SAME_ANGLE = 1e-6
"""rad or m: two values of a pinned joint closer than this are one. Solutions agree to 1e-9."""
_INVOLVED = 1e-6
"""Share of a unit vector below which a joint takes no part."""


@dataclass(frozen=True)
class Singularity:
    """One singular configuration.

    Attributes:
        q: joint positions, (n,).
        ratio: sigma_min / sigma_max in the arm's own length unit.
        rank: rank of the task's J.
        lost: task directions that no joint motion gives (left singular vectors), (m, m - rank),
            in ``rows`` order; entries in metres are divided by ``length``.
        internal: joint motions that do not move the task (right singular vectors), (n, n - rank).
        joints: names of the joints in the motion that became internal here.
        deciding: names of the joints whose change leaves the singular set; the others may move
            freely on it, to first order.
        pinned: values of the deciding joints where each is fixed on its own; else empty.
        kind: ``wrist``, ``shoulder``, ``elbow`` where the structure gives a name, otherwise
            ``boundary`` (the tool cannot pass on in the lost direction) or ``interior``.
        task: the task. rows: its rows. length: metres, see :mod:`kinlab.analysis.task_space`.
    """

    q: Array
    ratio: float
    rank: int
    lost: Array = field(repr=False)
    internal: Array = field(repr=False)
    joints: tuple[str, ...]
    deciding: tuple[str, ...]
    pinned: tuple[float, ...]
    kind: str
    task: str
    rows: tuple[int, ...] = field(repr=False)
    length: float = field(repr=False)

    @property
    def lost_direction(self) -> str:
        """The first lost direction in words, its main coordinate first."""
        column = self.lost[:, 0]
        order = np.argsort(-np.abs(column))
        parts = [
            f"{column[i]:+.3g} {COORDINATES[self.rows[i]]}"
            for i in order
            if abs(column[i]) > _INVOLVED
        ]
        return ", ".join(parts)


@dataclass(frozen=True)
class SingularFamily:
    """Configurations on one sheet of the singular set.

    Attributes:
        kind: class of its members; ``boundary/interior`` where they differ.
        deciding: names of the joints that decide; the others are free.
        pinned: values of the deciding joints where each is fixed on this sheet; empty where
            they vary together along a curve or surface.
        beyond: whether the tool can pass on in the lost direction at the representative:
            ``False`` on the boundary of the workspace, ``None`` where it was not tried.
        members: found configurations, the representative first.
    """

    kind: str
    deciding: tuple[str, ...]
    pinned: tuple[float, ...]
    beyond: bool | None
    members: tuple[Singularity, ...] = field(repr=False)

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


@dataclass(frozen=True)
class SingularitySearch(Sequence[Singularity]):
    """Answer of :func:`find_singularities`: a sequence of configurations, grouped in families.

    Attributes:
        robot: its name. task: the task. suggested: kinlab chose the task.
        families: sheets of the singular set. Empty: none was found within the joint limits.
        effort: seeds and convergence.
    """

    robot: str
    task: str
    suggested: bool
    families: tuple[SingularFamily, ...]
    effort: Effort

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


def find_singularities(
    robot: Robot, task: Any = "auto", *, points: int = 8, seed: int = 0, keep: int = 12
) -> SingularitySearch:
    """Configurations on the singular set within the joint limits, sheet by sheet.

    Starts are the dips of sigma_min along the line of every joint through several points, so
    that each sheet is met by construction; each is solved to rounding by Newton on the bordered
    system of :mod:`kinlab.analysis.singular_set`. A redundant arm is singular where its rank
    drops below the number of task rows.

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
    points, keep, seed = whole(points, "points"), whole(keep, "keep"), seed_of(seed)
    space = read_reachable_task(robot, task)
    system = sets.whole(space)
    starts = sets.seeds(system, np.random.default_rng(seed), points)
    x, good = sets.project(system, starts)
    kind = structure(robot)
    groups: dict[tuple[Any, ...], list[Singularity]] = {}
    last_new = 0
    for number in np.flatnonzero(good):
        found = _describe(system, x[number], kind)
        if found is None:
            continue
        key = _family_key(found, groups)
        if key not in groups:
            last_new = int(number) + 1
        members = groups.setdefault(key, [])
        if len(members) < keep and not any(_close(found.q, other.q) for other in members):
            members.append(found)
    families = [_family(space, key, tuple(m)) for key, m in groups.items()]
    families.sort(key=lambda f: (f.kind, len(f.deciding), f.deciding, f.pinned))
    effort = Effort(len(starts), int(good.sum()), last_new, seed)
    return SingularitySearch(robot.name, space.name, space.suggested, tuple(families), effort)


def describe_singularity(robot: Robot, q: ArrayLike, task: Any = "auto") -> Singularity:
    """The lost direction, joints, rank and class of a configuration that is singular.

    Raises:
        OptionError: q is not singular (says how far from it), or is a stack.
        StateError, NameUnknownError: bad q, unknown task.
    """
    space = read_reachable_task(robot, task)
    state = joint_vector(robot, q, "q")
    if state.ndim != 1:
        raise OptionError(f"robot {robot.name!r}: q has shape {state.shape}; give one state")
    system = sets.whole(space)
    found = _describe(system, system.start(state[np.newaxis])[0], structure(robot))
    if found is None:
        values = np.linalg.svd(space.jacobian(state, space.scale), compute_uv=False)
        raise OptionError(
            f"robot {robot.name!r}: q is not singular for task {space.name}: sigma_min/sigma_max "
            f"is {values[-1] / values[0]:.3g} (at most {SINGULAR:g}); see nearest_singularity"
        )
    if found.kind:
        return found
    return _with_kind(found, _place(passes_beyond(space, found.q, found.lost[:, 0])))


def _describe(system: sets.SingularSystem, x: Array, kind: str) -> Singularity | None:
    space, robot = system.space, system.space.robot
    q = system.states(x[np.newaxis])[0]
    left, sigma, right = np.linalg.svd(space.jacobian(q, space.scale))
    if sigma[-1] > SINGULAR * sigma[0]:
        return None
    rank = int(np.sum(sigma > SINGULAR * sigma[0]))
    projector, codimension = sets.normal_projector(system, x)
    deciding = [i for i in range(robot.n) if projector[i, i] > _INVOLVED]
    internal = right[rank:].T
    taking_part = np.linalg.norm(internal, axis=1) > _INVOLVED
    names = robot.joint_names
    fixed = codimension == len(deciding)
    return Singularity(
        q=frozen(q),
        ratio=float(sigma[-1] / sigma[0]),
        rank=rank,
        lost=frozen(left[:, rank:]),
        internal=frozen(internal),
        joints=tuple(name for name, part in zip(names, taking_part, strict=True) if part),
        deciding=tuple(names[i] for i in deciding),
        pinned=tuple(float(q[i]) for i in deciding) if fixed else (),
        kind=name_singularity(space, kind, q),
        task=space.name,
        rows=space.rows,
        length=space.scale,
    )


def _family_key(
    found: Singularity, groups: dict[tuple[Any, ...], list[Singularity]]
) -> tuple[Any, ...]:
    """(kind, rank, deciding joints, pinned values): that of a family that exists, if one fits."""
    for key in groups:
        same = key[:3] == (found.kind, found.rank, found.deciding)
        if same and len(key[3]) == len(found.pinned):
            apart = np.sin(0.5 * (np.asarray(key[3]) - np.asarray(found.pinned)))
            if np.all(np.abs(apart) < _SAME_ANGLE):
                return key
    return found.kind, found.rank, found.deciding, found.pinned


def _family(
    space: TaskSpace, key: tuple[Any, ...], members: tuple[Singularity, ...]
) -> SingularFamily:
    first = members[0]
    beyond = passes_beyond(space, first.q, first.lost[:, 0])
    if key[0]:
        return SingularFamily(str(key[0]), key[2], key[3], beyond, members)
    placed = [_with_kind(first, _place(beyond))]
    placed += [_with_kind(m, _place(passes_beyond(space, m.q, m.lost[:, 0]))) for m in members[1:]]
    kind = "/".join(sorted({m.kind for m in placed}))
    return SingularFamily(kind, key[2], key[3], beyond, tuple(placed))


def _place(beyond: bool | None) -> str:
    return "boundary" if beyond is False else "interior"


def _with_kind(found: Singularity, kind: str) -> Singularity:
    return Singularity(**{**found.__dict__, "kind": kind})


def _close(one: Array, two: Array) -> bool:
    return bool(np.max(np.abs(one - two)) < _SAME_ANGLE)
