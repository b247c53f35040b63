"""Redundant arms: motions that the task does not see, and the inverse that suits them.

Note 000 gives (J^T J)^-1 J^T for n > m. That is the *left* inverse, for fewer joints than task
rows. With more joints than rows J^T J is n x n of rank m < n, hence singular: the inverse does
not exist at any q. The right inverse J^T (J J^T)^-1 exists wherever J has full rank, satisfies
J J^+ = 1, and gives the smallest joint speed (Siciliano et al., *Robotics*, section 3.5.1). Both
products square the condition number; here it is computed from singular values.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.metrics import regular
from kinlab.analysis.structure.task_space import one_state, read_task
from kinlab.arrays import Array, frozen
from kinlab.host.evidence import Evidence
from kinlab.model.library import ArmLike, as_robot
from kinlab.tolerances import TOLERANCES


@dataclass(frozen=True)
class Redundancy:
    """Answer of :func:`redundancy`.

    Attributes:
        task: the task. suggested: kinlab chose it.
        rank: rank of the task's J. null_space: orthonormal motions with J v = 0, (n, n - rank).
        inverse: J^T (J J^T)^-1, (n, m), SI units; ``None`` where the rank is below the number of
            rows and it does not exist.
        why: in words, why this inverse and not another.
        evidence: what the rank rests on.
    """

    task: str
    suggested: bool
    rank: int
    null_space: Array
    inverse: Array | None
    why: str
    evidence: Evidence


def redundancy(robot: ArmLike, q: ArrayLike, task: Any = "auto") -> Redundancy:
    """Null space and right pseudo-inverse of the task's J at one q.

    Args:
        robot: the robot.
        q: joint positions, (n,).
        task: as in :func:`kinlab.manipulability`, or ``"auto"``.

    Raises:
        StateError, NameUnknownError, OptionError: bad q, unknown task.
    """
    robot = as_robot(robot)
    space = read_task(robot, task)
    state = one_state(robot, q)
    left, sigma, right = np.linalg.svd(space.jacobian(state))
    rank = int(np.sum(regular(sigma)))
    inverse = None
    if rank == space.m:
        inverse = frozen(right[: space.m].T / sigma @ left.T)
    return Redundancy(
        space.name,
        space.suggested,
        rank,
        frozen(right[rank:].T),
        inverse,
        _why(space.m, robot.n, rank),
        Evidence(
            "the singular values of J at this q; nothing else",
            proved=f"rank {rank}: singular values above {TOLERANCES.singular:g} of the largest",
        ),
    )


def _why(m: int, n: int, rank: int) -> str:
    if rank < m:
        return (
            f"J is {m} x {n} with rank {rank}: no right inverse exists here; damped least squares "
            "J^T (J J^T + lambda 1)^-1 trades accuracy for bounded joint speeds"
        )
    if n > m:
        return (
            f"J is {m} x {n}: J^T (J J^T)^-1 is its right inverse; (J^T J)^-1 J^T needs the {n} x "
            f"{n} matrix J^T J of rank {m} inverted, which is singular at every q"
        )
    return f"J is {m} x {n}: square and regular, every inverse is J^-1"
