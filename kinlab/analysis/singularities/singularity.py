"""One singular configuration: what is lost there, which joints hold the arm, and its class."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.metrics import counting
from kinlab.analysis.singularities.edge import Edge, edge
from kinlab.analysis.singularities.singular_set import pinned, supports
from kinlab.analysis.structure.axes import name_singularity, structure
from kinlab.analysis.structure.task_space import TaskSpace, one_state, read_reachable_task, revolute
from kinlab.analysis.structure.tasks import COORDINATES
from kinlab.arrays import Array, frozen, largest_first
from kinlab.errors import OptionError
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction, vector
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True, repr=False)
class Singularity(Answer):
    """One singular configuration.

    Attributes:
        q: joint positions, (n,).
        ratio: sigma_min / sigma_max in the arm's own length unit.
        rank: rank of the task's J.
        lost: task directions that no joint motion gives (left singular vectors), (m, m - rank),
            in ``rows`` order; entries in metres are divided by ``length``.
        internal: joint motions that do not move the task (right singular vectors), (n, n - rank).
        joints: names of the joints in the motion that became internal here.
        deciding: names of the fewest joints that hold the arm singular: with these where they are
            the others may take any value. All joints where nothing less does.
        pinned: values of the deciding joints where they are isolated; else empty. A half turn is
            pi, not -pi, where the limits admit both.
        kind: ``wrist``, ``shoulder``, ``elbow`` where the structure gives a name, otherwise
            ``boundary`` (here the tool turns back, and no other branch was found that passes on
            in the lost direction), ``interior`` (it passes on) or ``undecided``.
        task: the task. rows: its rows.
        length: metres, see :mod:`kinlab.analysis.structure.task_space`.
        evidence: what ``kind`` rests on.
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
    evidence: Evidence | None = field(default=None, repr=False)

    def introduction(self) -> Introduction:
        """What is lost here, and which joints hold the arm singular."""
        return Introduction(
            f"{self.kind} singularity, task {self.task}: rank {self.rank}, sigma_min/sigma_max "
            f"{self.ratio:.2g}",
            (
                f"q = {vector(self.q)}",
                f"lost direction: {self.lost_direction}",
                held_by(self.deciding, self.pinned),
            ),
        )

    @property
    def lost_direction(self) -> str:
        """The first lost direction in words, its main coordinate first."""
        column = self.lost[:, 0]
        order = largest_first(np.abs(column))
        parts = [
            f"{column[i]:+.3g} {COORDINATES[self.rows[i]]}"
            for i in order
            if abs(column[i]) > TOLERANCES.takes_part
        ]
        return ", ".join(parts)


def held_by(deciding: tuple[str, ...], pinned: tuple[float, ...]) -> str:
    """The joints that hold an arm singular, in words."""
    at = f" at {vector(pinned, 6)} (rad or m)" if pinned else ""
    return f"held by {', '.join(deciding)}{at}"


def describe_singularity(robot: ArmLike, q: ArrayLike, task: Any = "auto") -> Singularity:
    """The lost direction, joints, rank and class of a configuration that is singular.

    Raises:
        OptionError: q is not singular (says how far from it), or is a stack.
        StateError, NameUnknownError: bad q, unknown task.
    """
    robot = as_robot(robot)
    space = read_reachable_task(robot, task)
    state = one_state(robot, q)
    found = describe(space, state)
    if found is None:
        values = space.sigma(state)
        raise OptionError(
            f"robot {robot.name!r}: q is not singular for task {space.name}: sigma_min/sigma_max "
            f"is {values[-1] / values[0]:.3g} (at most {TOLERANCES.singular:g}); see "
            "nearest_singularity"
        )
    return placed(space, found)


def describe(
    space: TaskSpace, q: Array, held: tuple[int, ...] | None = None, fixed: bool | None = None
) -> Singularity | None:
    robot = space.robot
    left, sigma, right = np.linalg.svd(space.jacobian(q, space.scale))
    counts = counting(sigma)
    if counts[-1]:
        return None
    rank = int(np.sum(counts))
    held = supports(space, q)[0] if held is None else held
    fixed = pinned(space, q, held) if fixed is None else fixed
    internal = right[rank:].T
    taking_part = np.linalg.norm(internal, axis=1) > TOLERANCES.takes_part
    names = robot.joint_names
    kind = structure(robot)
    named = space.m == robot.n or (space.m == 6 and kind == "anthropomorphic-7")
    return Singularity(
        q=frozen(q),
        ratio=float(sigma[-1] / sigma[0]) if rank else 0.0,
        rank=rank,
        lost=frozen(left[:, rank:]),
        internal=frozen(internal),
        joints=tuple(name for name, part in zip(names, taking_part, strict=True) if part),
        deciding=tuple(names[i] for i in held),
        pinned=tuple(float(_half_turn(robot, q)[i]) for i in held) if fixed else (),
        kind=name_singularity(robot, kind, q, held) if named else "",
        task=space.name,
        rows=space.rows,
        length=space.scale,
        evidence=Evidence("the joint axes as they lie here", proved="which of them are dependent"),
    )


def placed(space: TaskSpace, found: Singularity, known: Edge | None = None) -> Singularity:
    """With the place in the workspace where the structure has no name."""
    if found.kind:
        return found
    judged = edge(space, found.q, found.lost) if known is None else known
    kind = {True: "interior", False: "boundary", None: "undecided"}[judged.beyond]
    return replace(found, kind=kind, evidence=judged.evidence)


def _half_turn(robot: Robot, q: Array) -> Array:
    """q with -pi written as pi where the limits admit it: rounding must not choose between them."""
    there = revolute(robot) & (np.abs(q + np.pi) < TOLERANCES.same_pinned_value)
    there &= robot.upper >= np.pi - TOLERANCES.same_pinned_value
    return np.where(there, q + 2.0 * np.pi, q)
