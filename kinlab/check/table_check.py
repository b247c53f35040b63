"""Checks of one arm: its DH table by hand beside Pinocchio and yourdfpy.

They are formula records like those of the notes, on the one robot given, so that they run and
print the same way. For a robot from a URDF the table is the extracted one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab import dynamics, mass_derivatives, urdf_read
from kinlab.arrays import Array
from kinlab.check.catalogue import Row, run_one
from kinlab.check.quantity import Quantity
from kinlab.check.serial import SERIAL
from kinlab.formula import Formula, Function, first_line
from kinlab.model.urdf_engine import document
from kinlab.model.urdf_records import read_tree
from kinlab.notes import mass
from kinlab.notes.arm import Arm
from kinlab.notes.frames import tool_pose
from kinlab.notes.note000_newton_euler import torques
from kinlab.robot import Robot

_STEP = 2e-2
_STENCIL = ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))
"""Central differences of order 6: their error is about _STEP^6 / 140."""


def yourdfpy_pose(robot: Robot, q: Any) -> Array:
    """Pose of the tool by yourdfpy's own forward kinematics of the URDF without its pictures."""
    import io

    import yourdfpy

    place = f"robot {robot.name!r}"
    tree = read_tree(urdf_read.parse(robot.urdf, place), place)
    text = document(tree, list(robot.joint_names))
    urdf = yourdfpy.URDF.load(io.BytesIO(text.encode()), load_meshes=False, build_scene_graph=True)
    mine = list(urdf.actuated_joint_names)
    rest = np.zeros(len(mine))
    poses = []
    for one in q:
        rest[[mine.index(name) for name in robot.joint_names]] = one
        urdf.update_cfg(rest)
        poses.append(np.array(urdf.get_transform(robot.tool_name)))
    return np.stack(poses)


def terms(robot: Robot, q: Any, v: Any, a: Any) -> Array:
    """M a + C v + g, each from its own algorithm."""
    inertia = np.einsum("aij,aj->ai", dynamics.mass_matrix(robot, q), a)
    velocity = np.einsum("aij,aj->ai", dynamics.coriolis_matrix(robot, q, v), v)
    total: Array = inertia + velocity + dynamics.gravity_torques(robot, q)
    return total


def definite(robot: Robot, q: Any) -> Array:
    """1 where M is symmetric and positive definite, 0 elsewhere."""
    matrix = dynamics.mass_matrix(robot, q)
    symmetric = np.max(np.abs(matrix - np.swapaxes(matrix, -1, -2)), axis=(1, 2)) == 0.0
    sound: Array = (symmetric & (np.linalg.eigvalsh(matrix)[:, 0] > 0.0)).astype(float)
    return sound


def skew_residue(robot: Robot, q: Any, v: Any) -> Array:
    """Symmetric part of Mdot - 2C over the size of M times that of the motion, (n, n).

    Not over the size of Mdot, which is rounding where M does not depend on q.
    """
    rate = mass_derivatives.mass_matrix_dot(robot, q, v)
    twice = 2.0 * dynamics.coriolis_matrix(robot, q, v)
    size = np.max(np.abs(dynamics.mass_matrix(robot, q)), axis=(1, 2)) * np.max(np.abs(v), axis=1)
    part = (rate - twice) + np.swapaxes(rate - twice, -1, -2)
    share: Array = part / size[:, None, None]
    return share


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
        slope = np.zeros((len(q), 4, 4))
        for k, weight in _STENCIL:
            ahead, behind = (tool_pose(arm, q + sign * k * _STEP * unit) for sign in (1, -1))
            slope += weight / _STEP * (ahead - behind)
        spin = slope[:, :3, :3] @ np.swapaxes(here, -1, -2)
        omega = [spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]]
        columns.append(np.concatenate([slope[:, :3, 3], np.stack(omega, axis=-1)], axis=-1))
    return np.stack(columns, axis=-1)


_QUANTITIES: dict[str, tuple[str, Function, float]] = {
    "fk_yourdfpy": ("q", yourdfpy_pose, 0.0),
    "terms": ("q v a", terms, 0.0),
    "mass_matrix_definite": ("q", definite, 0.0),
    "skew_residue": ("q v", skew_residue, 1.0),
}

QUANTITIES = tuple(
    Quantity(name, tuple(arguments.split()), engine, first_line(engine), SERIAL, scale=scale)
    for name, (arguments, engine, scale) in _QUANTITIES.items()
)


def _record(part: str, title: str, quantity: str, function: Function, latex: str) -> Formula:
    return Formula("table", title, "one arm", quantity, (), function, latex, part=part)


KINEMATIC = (
    _record("fk", "hand FK beside Pinocchio", "fk", tool_pose, r"\prod_i {}^{i-1}_iT"),
    _record(
        "fk, yourdfpy", "hand FK beside yourdfpy", "fk_yourdfpy", tool_pose,
        r"\prod_i {}^{i-1}_iT",
    ),
    _record(
        "J", "finite differences of the hand FK beside J", "jacobian", finite_differences,
        r"J \approx \frac{\Delta f}{\Delta q}",
    ),
)  # fmt: skip

DYNAMIC = (
    _record("M", "M of the link Jacobians beside crba", "mass_matrix", mass.mass_matrix,
            r"M = \sum_i m_i J_i^T J_i + J_{\omega i}^T R_i I_i R_i^T J_{\omega i}"),
    _record("tau", "hand Newton-Euler beside rnea", "inverse_dynamics", _newton_euler,
            r"\tau_i = n_i \cdot \hat Z"),
    _record("M a + C v + g", "hand Newton-Euler beside the sum of the terms", "terms",
            _newton_euler, r"\tau = M \ddot q + C \dot q + g"),
    _record("M > 0", "M symmetric and positive definite", "mass_matrix_definite", _ones,
            r"M = M^T > 0"),
    _record("Mdot - 2C", "Mdot - 2C is skew", "skew_residue", _no_symmetric_part,
            r"(\dot M - 2C)^T = -(\dot M - 2C)"),
)  # fmt: skip


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
