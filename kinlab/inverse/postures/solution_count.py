"""How many solutions a pose has, and how many each point of a section of the workspace has."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import real_array, whole
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction, Rows, counted
from kinlab.host.progress import takes_long
from kinlab.inverse.branches.families import IKFamily
from kinlab.inverse.branches.solutions import IKBranches, ik_branches
from kinlab.model.library import ArmLike, as_robot


@dataclass(frozen=True, eq=False, repr=False)
class SolutionCount(Answer):
    """How many solutions one pose has.

    Attributes:
        count: how many isolated ones, whole turns of a joint not counted.
        within_limits: how many of them the joint limits allow.
        complete: whether these are all.
        families: infinite sets of solutions through some of them.
        method: as in :class:`kinlab.inverse.branches.solutions.IKBranches`.
        evidence: what was solved, and what is known of it.
    """

    count: int
    within_limits: int
    complete: bool
    families: tuple[IKFamily, ...]
    method: str
    evidence: Evidence = field(repr=False)

    def introduction(self) -> Introduction:
        """How many solutions there are, and whether these are all."""
        sure = "all there are" if self.complete else "there may be more"
        lines = [f"by {self.method}", str(self.evidence)]
        if self.families:
            lines.insert(0, f"and {counted(len(self.families), 'infinite set')} of solutions")
        return Introduction(
            f"{counted(self.count, 'solution')}, {self.within_limits} within the limits, {sure}",
            tuple(lines),
        )

    def __int__(self) -> int:
        return self.count


@dataclass(frozen=True, eq=False, repr=False)
class SolutionCounts(Rows):
    """How many solutions each of N poses has; ``counts[i]`` is the answer for pose i alone.

    Attributes:
        count: (N,), integers. within_limits: (N,), integers.
        complete: (N,), bool.
        method: as in :class:`kinlab.inverse.branches.solutions.IKBranches`.
        evidence: of the stack.
    """

    count: Any
    within_limits: Any
    complete: Any
    method: str
    evidence: Evidence = field(repr=False)
    _batch: Any = field(repr=False)

    def columns(self) -> dict[str, Any]:
        """Pose by pose: the counts, and whether they are of all there are."""
        return {
            "count": self.count,
            "within_limits": self.within_limits,
            "complete": self.complete,
        }

    def introduction(self) -> Introduction:
        """How many poses have how many solutions."""
        values, times = np.unique(self.count, return_counts=True)
        rows = tuple((str(v), str(t)) for v, t in zip(values, times, strict=True))
        whole_ones = int(np.sum(self.complete))
        return Introduction(
            f"{counted(len(self), 'pose')}: {whole_ones} with all their solutions counted",
            (f"by {self.method}", str(self.evidence)),
            ("solutions", "poses") if rows else (),
            rows,
        )

    def __len__(self) -> int:
        return len(self.count)

    def __getitem__(self, row: int) -> SolutionCount:
        return _of_one(self._batch[row])


@takes_long("solutions")
def solution_count(robot: ArmLike, T: ArrayLike, *, threads: int | None = None) -> Any:
    """How many joint positions bring the tool to T.

    What of T counts is as in :func:`kinlab.ik_branches`: all of it for six joints, the position
    for three in space, and so on. Solutions that run together in one are counted once.

    Args:
        robot: the robot, of at most six joints that move the tool.
        T: target of the tool in the base, (4, 4), or a stack (N, 4, 4).
        threads: for a stack; left out, as many as there are processors.

    Returns:
        :class:`SolutionCount`, or :class:`SolutionCounts` for a stack.

    Raises:
        StateError, StructureError: as :func:`kinlab.ik_branches`. OptionError: bad threads.
    """
    robot = as_robot(robot)
    poses = real_array(T, f"robot {robot.name!r}: T")
    workers = None if threads is None else whole(threads, "threads")
    found = ik_branches(robot, poses, threads=workers)
    if isinstance(found, IKBranches):
        return _of_one(found)
    inside = np.asarray(found.within_limits).sum(axis=1)
    every = bool(np.all(found.complete))
    searched = f"{len(found)} poses by {found.method}"
    some = f"the counts of {int(np.sum(found.complete))} poses marked as complete"
    evidence = Evidence(
        searched,
        proved="each counted solution meets its pose to 1e-9 m and rad",
        found=("that there is no other, at every pose" if every else f"as all there are: {some}"),
    )
    return SolutionCounts(found.counts, inside, found.complete, found.method, evidence, found)


def _of_one(found: IKBranches) -> SolutionCount:
    other = "that there is no other" if found.complete else ""
    evidence = Evidence(
        found.evidence or found.method,
        proved="each counted solution meets the pose to 1e-9 m and rad",
        found=other,
    )
    return SolutionCount(
        len(found),
        int(np.sum(found.within_limits)),
        found.complete,
        found.families,
        found.method,
        evidence,
    )
