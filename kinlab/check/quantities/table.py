"""Engine quantities that an arm's own checks need: yourdfpy's pose, and what holds M, C and g
together."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.serial import SERIAL
from kinlab.engine import dynamics, lagrange
from kinlab.formulas.record import Function, first_line
from kinlab.model import urdf_read
from kinlab.model.robot import Robot
from kinlab.model.urdf_engine import document
from kinlab.model.urdf_records import read_tree


def yourdfpy_pose(robot: Robot, q: Any) -> Array:
    """Pose of the tool by yourdfpy's own forward kinematics of the URDF without its pictures."""
    import io

    import yourdfpy
    from lxml import etree

    place = f"robot {robot.name!r}"
    tree = read_tree(urdf_read.parse(robot.urdf, place), place)
    text = etree.tostring(document(tree, robot.joint_names))
    urdf = yourdfpy.URDF.load(io.BytesIO(text), load_meshes=False, build_scene_graph=True)
    mine = list(urdf.actuated_joint_names)
    rest = np.zeros(len(mine))
    poses = []
    for one in q:
        rest[[mine.index(name) for name in robot.joint_names]] = one
        urdf.update_cfg(rest)
        poses.append(np.array(urdf.get_transform(robot.tool_name)))
    return np.stack(poses)


def terms(robot: Robot, q: Any, v: Any, a: Any) -> Any:
    """M a + C v + g, each from its own algorithm."""
    inertia = np.einsum("aij,aj->ai", dynamics.mass_matrix(robot, q), a)
    velocity = np.einsum("aij,aj->ai", dynamics.coriolis_matrix(robot, q, v), v)
    return inertia + velocity + dynamics.gravity_torques(robot, q)


def definite(robot: Robot, q: Any) -> Any:
    """1 where M is symmetric and positive definite, 0 elsewhere."""
    matrix = dynamics.mass_matrix(robot, q)
    symmetric = np.max(np.abs(matrix - np.swapaxes(matrix, -1, -2)), axis=(1, 2)) == 0.0
    return (symmetric & (np.linalg.eigvalsh(matrix)[:, 0] > 0.0)).astype(float)


def skew_residue(robot: Robot, q: Any, v: Any) -> Any:
    """Symmetric part of Mdot - 2C over the size of M times that of the motion, (n, n).

    Not over the size of Mdot, which is rounding where M does not depend on q.
    """
    rate = lagrange.mass_matrix_dot(robot, q, v)
    twice = 2.0 * dynamics.coriolis_matrix(robot, q, v)
    size = np.max(np.abs(dynamics.mass_matrix(robot, q)), axis=(1, 2)) * np.max(np.abs(v), axis=1)
    part = (rate - twice) + np.swapaxes(rate - twice, -1, -2)
    return part / size[:, None, None]


_ROWS: tuple[tuple[str, str, Function, float], ...] = (
    ("fk_yourdfpy", "q", yourdfpy_pose, 0.0),
    ("terms", "q v a", terms, 0.0),
    ("mass_matrix_definite", "q", definite, 0.0),
    ("skew_residue", "q v", skew_residue, 1.0),
)

QUANTITIES = tuple(
    SERIAL.quantity(name, arguments, engine, first_line(engine), scale=scale)
    for name, arguments, engine, scale in _ROWS
)
