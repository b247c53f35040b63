"""Checks of one arm: its DH table by hand beside Pinocchio and yourdfpy.

They are formula records like those of the notes, on the one robot given, so that they run and
print the same way. For a robot from a URDF the table is the extracted one.
"""

from __future__ import annotations

import numpy as np

from kinlab.arrays import Array
from kinlab.check.catalogue import Row, run_one
from kinlab.formulas.record import Formula, Function
from kinlab.model.robot import Robot
from kinlab.notes import arm as mass
from kinlab.notes.arm import Arm, tool_pose
from kinlab.notes.note000_dynamics import torques

_STEP = 2e-2
_STENCIL = ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))
"""Central differences of order 6: their error is about _STEP^6 / 140."""


def _ones(arm: Arm, q: Array) -> Array:
    del arm
    return np.ones(len(q))


def _no_symmetric_part(arm: Arm, q: Array, v: Array) -> Array:
    del v
    return np.zeros((len(q), arm.n, arm.n))


def _newton_euler(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    return torques(arm, q, v, a, None, arm.gravity)


def finite_differences(arm: Arm, q: Array) -> Array:
    """Jacobian of the hand product by central differences of order 6, (N, 6, n)."""
    here = tool_pose(arm, q)[..., :3, :3]
    columns = []
    for unit in np.eye(arm.n):
        derivative = np.zeros((len(q), 4, 4))
        for k, weight in _STENCIL:
            ahead, behind = (tool_pose(arm, q + sign * k * _STEP * unit) for sign in (1, -1))
            derivative += weight / _STEP * (ahead - behind)
        rate = derivative[:, :3, :3] @ np.swapaxes(here, -1, -2)
        omega = [rate[:, 2, 1], rate[:, 0, 2], rate[:, 1, 0]]
        columns.append(np.concatenate([derivative[:, :3, 3], np.stack(omega, axis=-1)], axis=-1))
    return np.stack(columns, axis=-1)


def _record(part: str, title: str, quantity: str, function: Function, latex: str) -> Formula:
    return Formula("table", title, "one arm", quantity, (), function, latex, part=part)


KINEMATIC = (
    _record("fk", "hand FK beside Pinocchio", "fk", tool_pose, r"\prod_i {}^{i-1}_iT"),
    _record(
        "fk, yourdfpy", "hand FK beside yourdfpy", "fk_yourdfpy", tool_pose, r"\prod_i {}^{i-1}_iT"
    ),
    _record(
        "J",
        "finite differences of the hand FK beside J",
        "jacobian",
        finite_differences,
        r"J \approx \frac{\Delta f}{\Delta q}",
    ),
)

DYNAMIC = (
    _record(
        "M",
        "M of the link Jacobians beside crba",
        "mass_matrix",
        mass.mass_matrix,
        r"M = \sum_i m_i J_i^T J_i + J_{\omega i}^T R_i I_i R_i^T J_{\omega i}",
    ),
    _record(
        "tau",
        "hand Newton-Euler beside rnea",
        "inverse_dynamics",
        _newton_euler,
        r"\tau_i = n_i \cdot \hat Z",
    ),
    _record(
        "M a + C v + g",
        "hand Newton-Euler beside the sum of the terms",
        "terms",
        _newton_euler,
        r"\tau = M \ddot q + C \dot q + g",
    ),
    _record(
        "M > 0", "M symmetric and positive definite", "mass_matrix_definite", _ones, r"M = M^T > 0"
    ),
    _record(
        "Mdot - 2C",
        "Mdot - 2C is skew",
        "skew_residue",
        _no_symmetric_part,
        r"(\dot M - 2C)^T = -(\dot M - 2C)",
    ),
)


def table_rows(robot: Robot, samples: int = 200, seed: int = 0) -> list[Row]:
    """Checks one arm, kinematics only where its mass matrix is singular.

    Args:
        robot: from a table or a URDF.
        samples, seed: as for :func:`kinlab.compare`.

    Returns:
        One row per check.
    """
    return [run_one(record, robot, samples, seed) for record in checks_of(robot)]


def checks_of(robot: Robot) -> tuple[Formula, ...]:
    """The checks that apply to a robot."""
    return KINEMATIC if robot.singular_mass else KINEMATIC + DYNAMIC
