"""A robot's chain and inertias as plain arrays for the compiled kernels; without numba itself."""

from __future__ import annotations

from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.errors import StructureError
from kinlab.model.robot import Robot

# -------- A robot's chain as plain arrays, for the compiled kernels; without numba itself


class Chain(NamedTuple):
    """A serial chain in which every joint moves about or along its own z axis.

    Attributes:
        fixed: (k + 1, 12), the transform in front of each joint, rows of [R | p]; last the tool's.
        prismatic: (k,), bool.
    """

    fixed: Array
    prismatic: Any


_CHAINS: WeakKeyDictionary[Robot, Chain] = WeakKeyDictionary()


def chain(robot: Robot) -> Chain:
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


def _read(robot: Robot) -> Chain:
    tool = robot.model.frames[robot.tool]
    k = int(tool.parentJoint)
    joints, prismatic, turns = joints_about_z(robot, k)
    last = np.asarray(tool.placement.homogeneous)[:3].copy()
    if k:
        last = turns[-1].T @ last
    return Chain(np.vstack([joints, last.reshape(1, 12)]), prismatic)


def joints_about_z(robot: Robot, k: int) -> tuple[Array, Any, Array]:
    """The first k joints, each with its frame turned so that it moves about or along z.

    Args:
        robot: the robot.
        k: how many joints.

    Returns:
        The transforms in front of each joint (k, 12), rows of [R | p]; where it slides (k,),
        bool; and the rotations A from each turned frame to Pinocchio's joint frame (k, 3, 3).

    Raises:
        StructureError: as :func:`chain`.
    """
    model = robot.model
    data = model.createData()
    pin.computeJointJacobians(model, data, np.zeros(model.nq))
    fixed = np.empty((k, 12))
    prismatic = np.zeros(k, dtype=np.bool_)
    turns = np.empty((k, 3, 3))
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
        turn = np.eye(4)
        turn[:3, :3] = turns[i - 1] = _z_onto(local[:3] if slides else local[3:])
        here = behind @ np.asarray(model.jointPlacements[i].homogeneous) @ turn
        fixed[i - 1] = here[:3].ravel()
        behind = turn.T  # no translation, so the transpose is the inverse
    return fixed, prismatic, turns


def _z_onto(axis: Array) -> Array:
    """A rotation that takes z onto the unit vector ``axis``; exact for the coordinate axes."""
    z = axis / np.linalg.norm(axis)
    helper = np.eye(3)[int(np.argmin(np.abs(z)))]
    x = np.cross(helper, z)
    if z[2] > 0.5:  # keep the frame of an ordinary z joint as it is
        x = np.cross(np.array([0.0, 1.0, 0.0]), z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


# -------- A robot's inertias as plain arrays, for the compiled kernels; without numba
#          itself


class InertialChain(NamedTuple):
    """All joints of an arm, those behind the tool too, with what each carries.

    Every vector and tensor is in its joint's frame, turned so that the joint moves about or
    along z.

    Attributes:
        fixed: (n, 12), the transform in front of each joint, rows of [R | p].
        prismatic: (n,), bool.
        mass: (n,), kg.
        com: (n, 3), centre of mass, m.
        second: (n, 3, 3), Σ m r r^T about the centre of mass, kg m²: tr(I)/2 1 - I.
    """

    fixed: Array
    prismatic: Any
    mass: Array
    com: Array
    second: Array


_INERTIAS: WeakKeyDictionary[Robot, InertialChain] = WeakKeyDictionary()


def inertial_chain(robot: Robot) -> InertialChain:
    """Reads joints and inertias out of a robot's ``pin.Model``; kept for the next call.

    Args:
        robot: the robot.

    Returns:
        The arrays; do not write to them.

    Raises:
        StructureError: a joint that neither turns about nor slides along one axis.
    """
    found = _INERTIAS.get(robot)
    if found is None:
        found = _INERTIAS[robot] = _read_inertias(robot)
    return found


def _read_inertias(robot: Robot) -> InertialChain:
    fixed, prismatic, turns = joints_about_z(robot, robot.n)
    bodies = list(robot.model.inertias)[1:]
    mass = np.array([body.mass for body in bodies])
    lever = np.array([body.lever for body in bodies])
    tensor = np.array([body.inertia for body in bodies])
    tensor = np.swapaxes(turns, 1, 2) @ tensor @ turns
    half_trace = 0.5 * np.trace(tensor, axis1=1, axis2=2)
    return InertialChain(
        fixed,
        prismatic,
        mass,
        np.einsum("iba,ib->ia", turns, lever),
        half_trace[:, None, None] * np.eye(3) - tensor,
    )
