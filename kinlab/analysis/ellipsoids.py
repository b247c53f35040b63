"""Velocity, force and dynamic ellipsoids: principal axes and lengths from singular values.

* velocity: tool velocities of joint speeds with |qdot| <= 1; semi-axes sigma_i (Yoshikawa, IJRR
  4(2), 1985).
* force: tool forces held by joint torques with |tau| <= 1; the same axes, semi-axes 1 / sigma_i.
* dynamic: tool accelerations from rest, without gravity, of joint torques with |tau| <= 1;
  singular values of J M^-1 (Yoshikawa, "Dynamic manipulability of robot manipulators", 1985).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.metrics import of_task, regular, singular_values
from kinlab.analysis.structure.task_space import one_state, read_length, read_task
from kinlab.arrays import Array, frozen, word
from kinlab.engine.dynamics import mass_matrix
from kinlab.host.introductions import Answer, Introduction, vector
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import require_inertia

ELLIPSOIDS = ("velocity", "force", "dynamic")


@dataclass(frozen=True, repr=False)
class Ellipsoid(Answer):
    """An ellipsoid in task coordinates.

    Attributes:
        kind: ``velocity``, ``force`` or ``dynamic``.
        task: the task. suggested: kinlab chose it.
        length: characteristic length, or ``None`` where the task needs none.
        axes: unit principal axes as columns, (m, m).
        lengths: semi-axes, descending, (m,). Zero: flat in that direction. Infinity (force
            only): a force in that direction needs no torque, as at a singularity.
    """

    kind: str
    task: str
    suggested: bool
    length: float | None
    axes: Array
    lengths: Array

    def introduction(self) -> Introduction:
        """Its semi-axes, the longest first, each with its direction."""
        flat = bool(self.lengths[-1] == 0.0)
        state = "flat: the arm is singular here" if flat else f"semi-axes {vector(self.lengths)}"
        rows = tuple(
            (f"{size:.5g}", vector(axis, 4))
            for size, axis in zip(self.lengths, self.axes.T, strict=True)
        )
        return Introduction(
            f"{self.kind} ellipsoid, {of_task(self.task, self.suggested, self.length)}: {state}",
            (),
            ("semi-axis", "direction"),
            rows,
        )


def ellipsoid(
    robot: ArmLike, q: ArrayLike, kind: str = "velocity", task: Any = "auto", length: float = 1.0
) -> Ellipsoid:
    """An ellipsoid at one q; the three kinds are defined at the top of this module.

    Args:
        robot: the robot.
        q: joint positions, (n,).
        kind: ``"velocity"``, ``"force"`` or ``"dynamic"``.
        task, length: as in :func:`kinlab.manipulability`, or ``"auto"``.

    Raises:
        StateError, NameUnknownError, OptionError: bad q, unknown kind or task, length <= 0.
        InertiaError: ``"dynamic"`` of a robot with a singular mass matrix.
    """
    robot = as_robot(robot)
    kind = word(kind, ELLIPSOIDS, "ellipsoid")
    space, size = read_task(robot, task), read_length(length)
    state = one_state(robot, q)
    matrix = space.jacobian(state, size)
    if kind == "dynamic":
        require_inertia(robot)
        matrix = np.asarray(np.linalg.solve(mass_matrix(robot, state), matrix.T).T, np.float64)
    left: Array = np.linalg.svd(matrix)[0]
    sigma: Array = singular_values(matrix)
    if kind == "force":
        inverse: Array = np.divide(
            1.0, sigma, out=np.full_like(sigma, np.inf), where=regular(sigma)
        )
        left, sigma = left[:, ::-1], inverse[::-1]
    return Ellipsoid(
        kind,
        space.name,
        space.suggested,
        size if space.mixed else None,
        frozen(left),
        frozen(sigma),
    )
