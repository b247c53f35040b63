"""Changes of posture along a path of joint positions, and whether each meets no singularity."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from kinlab.arrays import Array
from kinlab.engine.fast.stacks import fk
from kinlab.errors import OptionError
from kinlab.inverse.postures.cuspidality import differ, square_task
from kinlab.inverse.postures.nonsingular import NonsingularPath, show_nonsingular
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True, eq=False)
class PostureChange:
    """A pose that a path passes twice, with two postures.

    Attributes:
        first, last: rows of the path.
        path: the way between them, where it is shown to meet no singularity; ``None``: not shown.
    """

    first: int
    last: int
    path: NonsingularPath | None = field(repr=False)

    @property
    def nonsingular(self) -> bool:
        """Whether the change is shown to meet no singularity."""
        return self.path is not None


def posture_changes(robot: Robot, q: Array) -> tuple[PostureChange, ...]:
    """Where a path comes back to a pose with other joint positions, whole turns left out.

    Between rows the joints move along straight lines.

    Args:
        robot: the robot.
        q: joint positions in order, (N, n).

    Returns:
        For each row that comes back to the pose of an earlier one with another posture, the
        change since the latest such row. Empty also where the arm's task leaves joints free.
    """
    try:
        space = square_task(robot)
    except OptionError:
        return ()
    poses = fk(robot, q)[:, :3]
    # what the task does not hold may differ: compare what it does
    held = poses[:, :, 3] if max(space.rows) < 3 else poses.reshape(len(q), 12)
    found: list[PostureChange] = []
    order = np.argsort(held[:, 0], kind="stable")
    sorted_ = held[order, 0]
    for last in range(1, len(q)):
        low, high = np.searchsorted(
            sorted_, held[last, 0] + TOLERANCES.same_pose * np.array([-1.0, 1.0])
        )
        near = np.sort(order[low:high])
        for first in near[near < last][::-1]:
            apart = np.abs(held[first] - held[last]).max()
            if apart < TOLERANCES.same_pose and differ(robot, q[first], q[last]):
                shown = show_nonsingular(space, q[first : last + 1])
                found.append(PostureChange(int(first), last, shown))
                break
    return tuple(found)
