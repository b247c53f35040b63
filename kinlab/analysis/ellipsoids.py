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

from kinlab.analysis.metrics import SINGULAR, singular_values
from kinlab.arrays import Array, frozen
from kinlab.engine.dynamics import mass_matrix
from kinlab.engine.states import joint_vector
from kinlab.errors import NameUnknownError, OptionError, near
from kinlab.model.robot import Robot, require_inertia
from kinlab.structure.task_space import read_length, read_task

ELLIPSOIDS = ("velocity", "force", "dynamic")


@dataclass(frozen=True)
class Ellipsoid:
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


def ellipsoid(
    robot: Robot, q: ArrayLike, kind: str = "velocity", task: Any = "auto", length: float = 1.0
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
    if kind not in ELLIPSOIDS:
        raise NameUnknownError(f"ellipsoid {kind!r} is unknown; {near(str(kind), ELLIPSOIDS)}")
    space, size = read_task(robot, task), read_length(length)
    state = joint_vector(robot, q, "q")
    if state.ndim != 1:
        raise OptionError(f"robot {robot.name!r}: q has shape {state.shape}; give one state")
    matrix = space.jacobian(state, size)
    if kind == "dynamic":
        require_inertia(robot)
        matrix = np.asarray(np.linalg.solve(mass_matrix(robot, state), matrix.T).T, np.float64)
    left: Array = np.linalg.svd(matrix)[0]
    sigma: Array = singular_values(matrix)
    if kind == "force":
        flat = sigma <= SINGULAR * max(float(sigma[0]), np.finfo(float).tiny)
        inverse: Array = np.divide(1.0, sigma, out=np.full_like(sigma, np.inf), where=~flat)
        left, sigma = left[:, ::-1], inverse[::-1]
    return Ellipsoid(
        kind, space.name, space.suggested, size if space.mixed else None, frozen(left),
        frozen(sigma),
    )  # fmt: skip
