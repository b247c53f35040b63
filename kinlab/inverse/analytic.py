"""All branches of other six- and seven-joint arms, by the optional package ssik.

ssik (Srinivasa, BSD-3-Clause) is given the axes and offsets of the arm; nothing is read from
files. Of a seven-joint arm it samples the redundancy, so its answer is a selection.
"""

from __future__ import annotations

from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from kinlab.arrays import Array
from kinlab.chain_arrays import Chain
from kinlab.errors import MissingExtraError, StructureError
from kinlab.robot import Robot

_ARMS: WeakKeyDictionary[Robot, tuple[Any, Array]] = WeakKeyDictionary()


def solve(robot: Robot, chain: Chain, target: Array) -> list[Array]:
    """All q that ssik finds, (n,) each, limits not looked at.

    Raises:
        StructureError: not six or seven revolute joints.
        MissingExtraError: ssik is not installed.
    """
    if len(chain.prismatic) not in (6, 7) or chain.prismatic.any():
        raise StructureError(
            f"robot {robot.name!r}: no closed form for {len(chain.prismatic)} joints of this "
            "kind: branches are known for planar arms of two or three joints, six-joint arms "
            "with a spherical wrist, and (extra kinlab[analytic]) six or seven revolute joints; "
            "use kl.ik with several q0 or seeds"
        )
    found = _ARMS.get(robot)
    if found is None:
        found = _ARMS[robot] = _build(robot, chain)
    arm, back = found
    solutions = arm.solve(target @ back, respect_limits=False, enumerate_windings=False)
    return [np.array(s.q, dtype=np.float64) for s in solutions]


def _build(robot: Robot, chain: Chain) -> tuple[Any, Array]:
    try:
        from ssik import Manipulator
    except ImportError:
        raise MissingExtraError(
            f"robot {robot.name!r}: its last three axes do not meet in one point, and the closed "
            "form of such an arm comes from the optional package ssik: pip install "
            "'kinlab[analytic]'; or use kl.ik with several q0 or seeds"
        ) from None
    frames = []
    pose = np.eye(4)
    for row in chain.fixed:
        step = np.eye(4)
        step[:3] = row.reshape(3, 4)
        pose = pose @ step
        frames.append(pose)
    points = np.array([f[:3, 3] for f in frames])
    offsets = np.diff(points, axis=0, prepend=np.zeros((1, 3)))
    arm = Manipulator.from_axes(np.array([f[:3, 2] for f in frames[:-1]]), offsets)
    back = np.eye(4)
    back[:3, :3] = pose[:3, :3].T  # at q = 0 its tool has the axes of the base
    return arm, back
