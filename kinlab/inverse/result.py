"""What inverse kinematics answers: always a status and errors measured by Pinocchio."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from kinlab.arrays import Array


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


@dataclass(frozen=True, eq=False)
class IKResult:
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


@dataclass(frozen=True, eq=False)
class IKBatch:
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
