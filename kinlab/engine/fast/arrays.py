"""A robot's chain as plain arrays for the compiled kernels; without numba itself."""

from __future__ import annotations

from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.errors import StructureError
from kinlab.model.robot import Robot


class ChainArrays(NamedTuple):
    """A serial chain in which every joint moves about or along its own z axis.

    Attributes:
        fixed: (k + 1, 12), the transform in front of each joint, rows of [R | p]; last the tool's.
        prismatic: (k,), bool.
    """

    fixed: Array
    prismatic: Any


_CHAINS: WeakKeyDictionary[Robot, ChainArrays] = WeakKeyDictionary()


def chain(robot: Robot) -> ChainArrays:
    """Reads the chain from base to tool out of a robot's ``pin.Model``; kept for the next call.

    A joint about an axis a becomes one about z by putting a rotation A with A z = a in front and
    its inverse behind: Rot(a, q) = A Rot(z, q) A^T.

    Args:
        robot: the robot. Joints behind its tool are left out.

    Returns:
        The arrays; do not write to them.

    Raises:
        StructureError: a joint that neither turns about nor slides along one axis.
    """
    found = _CHAINS.get(robot)
    if found is None:
        found = _CHAINS[robot] = _read(robot)
    return found


def _read(robot: Robot) -> ChainArrays:
    model = robot.model
    tool = model.frames[robot.tool]
    k = int(tool.parentJoint)
    data = model.createData()
    pin.computeJointJacobians(model, data, np.zeros(model.nq))
    fixed = np.empty((k + 1, 12))
    prismatic = np.zeros(k, dtype=np.bool_)
    behind = np.eye(4)
    for i in range(1, k + 1):
        jac = pin.getJointJacobian(model, data, i, pin.ReferenceFrame.LOCAL)
        local = jac.reshape(6, -1)[:, i - 1]  # Pinocchio gives (6,) where there is one joint
        slides = bool(np.any(local[:3]))
        if slides and np.any(local[3:]):
            raise StructureError(
                f"robot {robot.name!r}: joint {model.names[i]!r} is {model.joints[i].shortname()}; "
                "it must turn about or slide along one axis"
            )
        prismatic[i - 1] = slides
        onto_z = np.eye(4)
        onto_z[:3, :3] = _z_onto(local[:3] if slides else local[3:])
        here = behind @ np.asarray(model.jointPlacements[i].homogeneous) @ onto_z
        fixed[i - 1] = here[:3].ravel()
        behind = onto_z.T  # no translation, so the transpose is the inverse
    fixed[k] = (behind @ np.asarray(tool.placement.homogeneous))[:3].ravel()
    return ChainArrays(fixed, prismatic)


def _z_onto(axis: Array) -> Array:
    """A rotation that takes z onto the unit vector ``axis``; exact for the coordinate axes."""
    z = axis / np.linalg.norm(axis)
    helper = np.eye(3)[int(np.argmin(np.abs(z)))]
    x = np.cross(helper, z)
    if z[2] > 0.5:  # keep the frame of an ordinary z joint as it is
        x = np.cross(np.array([0.0, 1.0, 0.0]), z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])
