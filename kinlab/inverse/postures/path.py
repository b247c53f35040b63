"""Inverse kinematics along a path: stay on one branch, and say where that was not possible."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, number, seed_of
from kinlab.engine.fast.stacks import jacobian
from kinlab.errors import NameUnknownError
from kinlab.host.evidence import Evidence
from kinlab.host.introductions import Introduction, Rows, brief, counted, numbered
from kinlab.inverse.postures.posture_change import PostureChange, posture_changes
from kinlab.inverse.request import read_guess, read_targets
from kinlab.inverse.result import BRANCH, IKResult, IKStatus
from kinlab.inverse.search import ik
from kinlab.inverse.setup import setup
from kinlab.model.library import ArmLike, as_robot

NEAR_SINGULAR = 1e-2
"""sigma_min / sigma_max of J, metres over the arm's length, below which a pose is reported."""


@dataclass(frozen=True, eq=False, repr=False)
class IKPath(Rows):
    """Joint positions along a path.

    Attributes:
        q: (N, n). success: (N,), bool. status: (N,), text.
        position_error, rotation_error: (N,), by Pinocchio, metres and radians.
        jumps: rows whose q lies farther from the row before than ``max_step``, integers.
        singular: rows at or near a singularity of the task's Jacobian, integers.
        conditioning: sigma_min / sigma_max of that Jacobian, (N,), 0 at a singularity.
        remarks: what was done to the input.
        posture_changes: where the path comes back to a pose with another posture, and whether
            the way there is shown to meet no singularity.
        task: the coordinates of each pose that were asked for, by name.
    """

    q: Array
    success: Any
    status: Any
    position_error: Array
    rotation_error: Array
    jumps: Any
    singular: Any
    conditioning: Array
    remarks: tuple[str, ...] = ()
    posture_changes: tuple[PostureChange, ...] = ()
    task: str = "pose"

    def columns(self) -> dict[str, Any]:
        """Pose by pose: joints, success and status, errors, conditioning."""
        return {
            **numbered("q", self.q),
            "success": self.success,
            "status": self.status,
            "position_error": self.position_error,
            "rotation_error": self.rotation_error,
            "conditioning": self.conditioning,
        }

    def introduction(self) -> Introduction:
        """How many poses were followed, and where the path jumps or is near a singularity."""
        solved = int(np.sum(self.success))
        smooth = "without a jump" if not len(self.jumps) else counted(len(self.jumps), "jump")
        lines = [
            f"worst error {self.position_error.max(initial=0.0):.2g} m, "
            f"{self.rotation_error.max(initial=0.0):.2g} rad",
            f"least sigma_min/sigma_max {self.conditioning.min(initial=np.inf):.3g}",
        ]
        for what, where in (("jumps", self.jumps), ("at or near a singularity", self.singular)):
            if len(where):
                lines.append(f"{what}: rows {brief(', '.join(str(int(row)) for row in where), 80)}")
        failed = np.flatnonzero(~np.asarray(self.success, bool))
        if len(failed):
            lines.append(f"first that failed: row {failed[0]}, {self.status[failed[0]]}")
        lines += [
            f"rows {change.first} and {change.last}: one pose, two postures; the change is "
            + ("shown to meet" if change.nonsingular else "not shown to meet")
            + " no singularity"
            for change in self.posture_changes
        ]
        lines += self.remarks
        return Introduction(
            f"path, task {self.task}: {solved} of {counted(len(self), 'pose')} solved, {smooth}",
            tuple(lines),
            mood="good" if solved == len(self) and not len(self.jumps) else "bad",
        )

    def __len__(self) -> int:
        return len(self.q)

    @property
    def evidence(self) -> Evidence:
        """What is measured at the poses, and what is not looked at between them."""
        met = int(np.sum(self.success))
        return Evidence(
            f"{len(self)} poses, each from the answer before",
            met,
            len(self),
            "every pose marked as met is met at its q, within tolerance and limits",
            "that jumps and singularities stand where they are listed: nothing is looked at "
            "between two poses",
        )


def ik_path(
    robot: ArmLike,
    Ts: ArrayLike,
    q0: ArrayLike,
    tol_position: float = 1e-6,
    tol_rotation: float = 1e-6,
    seed: int = 0,
    *,
    task: Any = "auto",
    max_step: float = 0.5,
    branch: str | None = None,
) -> IKPath:
    """Follows poses one after the other, each search starting at the answer before.

    Only where that single search fails, or lands farther than ``max_step`` away, are other
    starts tried; of both answers the nearer one is kept. A step farther than ``max_step``
    remains a jump and is reported as such.

    Args:
        robot: the robot.
        Ts: poses in order, (N, 4, 4), close enough together for ``max_step``.
        q0: where the arm is, (n,); it chooses the branch.
        tol_position, tol_rotation, seed, task: as in :func:`kinlab.ik`.
        max_step: largest change of a joint between poses that is still following, rad or m.
        branch: stay on the branch of this name (:func:`kinlab.ik`), whatever q0 lies on; a pose
            that does not have it is marked as failed.

    Returns:
        The path. A pose that cannot be had is marked, its closest q kept, and the path goes on.

    Raises:
        StateError, OptionError, NameUnknownError, StructureError: as :func:`kinlab.ik_batch`;
            NameUnknownError also where the first pose has no such branch.
    """
    robot = as_robot(robot)
    targets = read_targets(robot, Ts)
    here, remarks = read_guess(robot, q0)
    largest = number(max_step, "max_step", above=0.0)
    seed = seed_of(seed)
    arm = setup(robot, task, seed)
    solve = partial(ik, robot, tol_position=tol_position, tol_rotation=tol_rotation)
    answers: list[IKResult] = []
    jumps = []
    for row, target in enumerate(targets):
        if branch is not None:
            answer = _on_branch(solve, target, branch, here, row)
        else:
            answer = solve(target, here, seed=seed, task=task, restarts=0)
            if not answer.success or _step(answer, here) > largest:
                other = solve(target, here, seed=seed, task=task)
                answer = min(answer, other, key=lambda a: (not a.success, _step(a, here)))
        if _step(answer, here) > largest and (row or branch is None):
            jumps.append(row)
        answers.append(answer)
        here = answer.q
    q = np.array([a.q for a in answers]).reshape(-1, robot.n)
    conditioning = np.empty(0)
    if len(q):
        rows = list(arm.rows)
        scaled = np.sqrt(arm.search.weight[rows])[:, None] * jacobian(robot, q)[:, rows]
        values = np.linalg.svd(scaled, compute_uv=False)
        conditioning = values[:, -1] / values[:, 0]
    return IKPath(
        q,
        np.array([a.success for a in answers], dtype=np.bool_),
        np.array([a.status.value for a in answers], dtype="<U24"),
        np.array([a.position_error for a in answers]),
        np.array([a.rotation_error for a in answers]),
        np.array(jumps, dtype=np.int64),
        np.flatnonzero(conditioning < NEAR_SINGULAR),
        conditioning,
        tuple(remarks),
        posture_changes(robot, q) if len(q) else (),
        arm.task if branch is None else BRANCH,
    )


def _step(answer: IKResult, here: Array) -> float:
    return float(np.abs(answer.q - here).max())


def _on_branch(
    solve: Callable[..., IKResult], target: Array, branch: str, here: Array, row: int
) -> IKResult:
    """The answer on a named branch; where a later pose lacks it, a failure at the q before."""
    try:
        return solve(target, here, branch=branch)
    except NameUnknownError:
        if row == 0:
            raise
    stay = solve(target, here, restarts=0, max_iterations=1)
    return IKResult(
        here.copy(), False, IKStatus.UNREACHABLE, stay.position_error, stay.rotation_error, 0, 0
    )
