"""What inverse kinematics answers: always a status and errors measured by Pinocchio."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Answer, Introduction, Rows, counted, numbered, vector


class IKStatus(StrEnum):
    """How a search ended. Only ``CONVERGED`` is a success."""

    CONVERGED = "converged"
    """Both errors within tolerance, q within the limits."""

    OUTSIDE_LIMITS = "converged_outside_limits"
    """The pose can be had, but every q found for it breaks a limit."""

    SINGULARITY = "stalled_at_singularity"
    """No more progress, at a state where the Jacobian has lost rank."""

    LOCAL_MINIMUM = "local_minimum"
    """No more progress from the few starts allowed; more restarts may find it."""

    UNREACHABLE = "unreachable_suspected"
    """Farther than the arm is long, or many searches all came to rest above the tolerance."""

    ITERATION_LIMIT = "iteration_limit"
    """Still coming closer when the iterations ran out."""


_WHY = {
    IKStatus.CONVERGED: "within the tolerances and the limits",
    IKStatus.OUTSIDE_LIMITS: "the pose can be had, but every q found for it breaks a joint limit",
    IKStatus.SINGULARITY: "the search came to rest at a singular posture",
    IKStatus.LOCAL_MINIMUM: "no more progress; more restarts may find it",
    IKStatus.UNREACHABLE: "the pose seems out of reach",
    IKStatus.ITERATION_LIMIT: "still coming closer when the iterations ran out",
}

_SUSPECTED = {
    IKStatus.OUTSIDE_LIMITS: "that no solution is within the limits",
    IKStatus.UNREACHABLE: "that the pose is out of reach",
}
"""What a failure is taken for, and does not prove."""

BRANCH = "branch"
"""The task where a branch was asked for: what :func:`kinlab.ik_branches` asks of such an arm."""


@dataclass(frozen=True, eq=False)
class IKHistory:
    """What happened in each iteration.

    Attributes:
        q: joint positions before the step, (m, n).
        position_error: metres, (m,).
        rotation_error: radians, (m,).
        search: which start the iteration belongs to, (m,), from 0.
    """

    q: Array
    position_error: Array
    rotation_error: Array
    search: Any


@dataclass(frozen=True, eq=False, repr=False)
class IKResult(Answer):
    """The answer for one pose.

    Attributes:
        q: the solution; without success the closest found, (n,), rad or m.
        success: both errors within tolerance and q within the limits.
        status: how it ended.
        position_error: of the task's coordinates, by Pinocchio at this q, metres.
        rotation_error: of the task's coordinates, by Pinocchio at this q, radians.
        iterations: steps of all searches together.
        restarts: searches after the first.
        remarks: what was done to the input, such as a q0 put back onto its limits.
        history: every iteration, when asked for.
        task: the coordinates of T that were asked for, by name; :data:`BRANCH` where a branch was.
    """

    q: Array
    success: bool
    status: IKStatus
    position_error: float
    rotation_error: float
    iterations: int
    restarts: int
    remarks: tuple[str, ...] = ()
    history: IKHistory | None = None
    task: str = "pose"

    @property
    def evidence(self) -> Evidence:
        """What was searched; a success is measured, a failure is never a proof."""
        if self.task == BRANCH:
            searched = "the branches of the pose"
        else:
            searched = f"{1 + self.restarts} searches, {self.iterations} iterations together"
        measured = (
            f"at q the tool is {self.position_error:.3g} m and {self.rotation_error:.3g} rad off"
        )
        if self.success:
            return Evidence(searched, proved=f"{measured}, within the limits")
        return Evidence(searched, proved=measured, found=_SUSPECTED.get(self.status, ""))

    def introduction(self) -> Introduction:
        """How it ended, how far off the tool is, and where the joints are."""
        ended = "solved" if self.success else f"NOT solved: {_WHY[self.status]}"
        searches = counted(1 + self.restarts, "search").replace("searchs", "searches")
        return Introduction(
            f"inverse kinematics, task {self.task}: {ended}",
            (
                f"q = {vector(self.q, 8)}",
                f"position error {1e3 * self.position_error:.3g} mm, rotation error "
                f"{math.degrees(self.rotation_error):.3g}°, measured by forward kinematics",
                f"{counted(int(self.iterations), 'iteration')} of {searches}; status {self.status}",
                *self.remarks,
            ),
            mood="good" if self.success else "bad",
        )


@dataclass(frozen=True, eq=False, repr=False)
class IKBatch(Rows):
    """The answers for many poses; the attributes of :class:`IKResult` with a leading axis N.

    Attributes:
        q: (N, n). success: (N,), bool. status: (N,), text. position_error, rotation_error: (N,).
        iterations, restarts: (N,), integers. remarks: what was done to the input.
        task: the coordinates that were asked for, of all poses.
    """

    q: Array
    success: Any
    status: Any
    position_error: Array
    rotation_error: Array
    iterations: Any
    restarts: Any
    remarks: tuple[str, ...] = ()
    task: str = "pose"

    def __len__(self) -> int:
        return len(self.q)

    @property
    def evidence(self) -> Evidence:
        """What was searched for all poses together, and what is measured."""
        solved = int(np.sum(self.success))
        return Evidence(
            f"{len(self) + int(np.sum(self.restarts))} searches for {len(self)} poses",
            proved=f"{solved} poses are met within tolerance and limits",
            found="" if solved == len(self) else f"why the other {len(self) - solved} are not",
        )

    def columns(self) -> dict[str, Any]:
        """Pose by pose: joints, how the search ended, and the errors."""
        return {
            **numbered("q", self.q),
            "success": self.success,
            "status": [str(status) for status in self.status],
            "position_error": self.position_error,
            "rotation_error": self.rotation_error,
            "iterations": self.iterations,
            "restarts": self.restarts,
        }

    def introduction(self) -> Introduction:
        """How many poses were solved, and how the others ended."""
        solved = int(np.sum(self.success))
        ends = Counter(
            str(s) for s, good in zip(self.status, self.success, strict=True) if not good
        )
        lines = [
            f"{count} {status}: {_WHY[IKStatus(status)]}" for status, count in ends.most_common()
        ]
        if solved:
            position, rotation = (
                float(np.max(errors[self.success]))
                for errors in (self.position_error, self.rotation_error)
            )
            lines.insert(
                0,
                f"largest errors of the solved: {1e3 * position:.3g} mm, "
                f"{math.degrees(rotation):.3g}°",
            )
        return Introduction(
            f"inverse kinematics, task {self.task}: {solved} of {len(self)} poses solved",
            (*lines, *self.remarks),
            mood="good" if solved == len(self) else "bad",
        )
