"""A robot's inertias as plain arrays, for the compiled kernels; without numba itself."""

from __future__ import annotations

from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from kinlab.arrays import Array
from kinlab.chain_arrays import joints_about_z
from kinlab.robot import Robot


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


_CHAINS: WeakKeyDictionary[Robot, InertialChain] = WeakKeyDictionary()


def inertial_chain(robot: Robot) -> InertialChain:
    """Reads joints and inertias out of a robot's ``pin.Model``; kept for the next call.

    Args:
        robot: the robot.

    Returns:
        The arrays; do not write to them.

    Raises:
        StructureError: a joint that neither turns about nor slides along one axis.
    """
    found = _CHAINS.get(robot)
    if found is None:
        found = _CHAINS[robot] = _read(robot)
    return found


def _read(robot: Robot) -> InertialChain:
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
