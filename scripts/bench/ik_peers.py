"""Other inverse kinematics behind one face, each on the same chain and the same poses.

A peer that is not installed is left out. Each maker takes a robot and answers with a function
``pose -> q or None`` (or, for the analytic ones, all branches).
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

import numpy as np

import kinlab as kl
from kinlab.engine.fast.arrays import chain

Solver = Callable[[np.ndarray], np.ndarray | None]
MIDDLE_SHARE = 0.5
PREBUILT = {"puma560": "puma560", "ur5": "ur5", "panda": "franka_panda", "xarm7": "xarm7"}
"""Arms for which ssik ships a built solver; used after a comparison of the two kinematics."""

RTB_TOLERANCE = 5e-13
"""Robotics Toolbox stops at e^T e / 2 < tol: this is 1e-6 in m and rad."""


def _transforms(robot: kl.Robot) -> tuple[np.ndarray, np.ndarray]:
    fixed, prismatic = chain(robot)
    out = np.tile(np.eye(4), (len(fixed), 1, 1))
    out[:, :3] = fixed.reshape(-1, 3, 4)
    return out, prismatic


def _axes(robot: kl.Robot) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Axes (n, 3) and offsets (n + 1, 3) in the base at q = 0, and the tool's rotation there."""
    fixed, prismatic = _transforms(robot)
    if prismatic.any():
        raise ValueError("revolute joints only")
    frames = [fixed[0]]
    for step in fixed[1:]:
        frames.append(frames[-1] @ step)
    points = np.array([f[:3, 3] for f in frames])
    axes = np.array([f[:3, 2] for f in frames[:-1]])
    return axes, np.diff(points, axis=0, prepend=np.zeros((1, 3))), frames[-1][:3, :3]


def _within(robot: kl.Robot, found: list[np.ndarray]) -> list[np.ndarray]:
    """Angles turned into the limits; what does not fit is dropped."""
    turn = 2 * np.pi
    wrapped = [q - turn * np.ceil((np.asarray(q) - robot.upper) / turn) for q in found]
    return [q for q in wrapped if np.all(q >= robot.lower)]


def rtb_lm(robot: kl.Robot, searches: int) -> Solver:
    """Robotics Toolbox, C++ ``ik_LM`` (Chan), random starts, its limits check."""
    import roboticstoolbox as rtb

    fixed, prismatic = _transforms(robot)
    ets = rtb.ETS()
    for i, slides in enumerate(prismatic):
        limits = [float(robot.lower[i]), float(robot.upper[i])]
        joint = rtb.ET.tz(qlim=limits) if slides else rtb.ET.Rz(qlim=limits)
        ets = ets * rtb.ET.SE3(fixed[i]) * joint
    ets = ets * rtb.ET.SE3(fixed[-1])

    def solve(pose: np.ndarray) -> np.ndarray | None:
        answer = ets.ik_LM(pose, tol=RTB_TOLERANCE, slimit=searches)
        return answer.q if answer.success else None

    return solve


def ssik_all(robot: kl.Robot) -> Callable[[np.ndarray], list[np.ndarray]]:
    """ssik: all branches, one winding each (7 joints: at its redundancy samples).

    Where it ships a solver built for this very arm, that one (its fast way), else one made from
    the axes at run time.
    """
    import ssik

    ready = PREBUILT.get(robot.name)
    arm = ssik.Manipulator.from_prebuilt(ready) if ready else None
    q = np.random.default_rng(0).uniform(-1.0, 1.0, robot.n)
    if arm is not None:
        back = np.linalg.inv(kl.fk(robot, np.zeros(robot.n))) @ arm.fk(np.zeros(robot.n))
        if not np.allclose(kl.fk(robot, q) @ back, arm.fk(q), atol=1e-9):
            arm = None
    if arm is None:
        axes, offsets, turn = _axes(robot)
        arm = ssik.Manipulator.from_axes(axes, offsets)
        arm.prepare()
        back = np.eye(4)
        back[:3, :3] = turn.T

    def solve(pose: np.ndarray) -> list[np.ndarray]:
        found = arm.solve(pose @ back, enumerate_windings=False, respect_limits=False)
        return _within(robot, [s.q for s in found])

    return solve


def eaik_all(robot: kl.Robot) -> Callable[[np.ndarray], list[np.ndarray]]:
    """EAIK: all branches, limits not looked at; angles wrapped here."""
    from eaik.IK_HP import HPRobot

    axes, offsets, turn = _axes(robot)
    arm = HPRobot(axes, offsets)
    if not arm.hasKnownDecomposition():
        raise ValueError("no decomposition known")
    back = np.eye(4)
    back[:3, :3] = turn.T

    def solve(pose: np.ndarray) -> list[np.ndarray]:
        answer = arm.IK(pose @ back)
        return _within(
            robot, [q for q, rough in zip(answer.Q, answer.is_LS, strict=True) if not rough]
        )

    return solve


def modern_robotics_newton(robot: kl.Robot) -> Solver:
    """Modern Robotics ``IKinSpace``: Newton from the middle of the limits, one start."""
    import modern_robotics as mr

    home = kl.fk(robot, np.zeros(robot.n))
    screws = kl.jacobian(robot, np.zeros(robot.n), frame="spatial")
    screws = np.vstack([screws[3:], screws[:3]])  # angular first there
    middle = robot.lower + MIDDLE_SHARE * (robot.upper - robot.lower)

    def solve(pose: np.ndarray) -> np.ndarray | None:
        q, success = mr.IKinSpace(screws, home, pose, middle, 1e-6, 1e-6)
        q = q - 2 * np.pi * np.ceil((q - robot.upper) / (2 * np.pi))
        return q if success else None

    return solve


def ikpy_least_squares(robot: kl.Robot) -> Solver:
    """ikpy: scipy least squares over the URDF's chain, one start."""
    import ikpy.chain

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "arm.urdf"
        file.write_text(robot.urdf)
        base = robot.model.frames[1].name
        arm = ikpy.chain.Chain.from_urdf_file(str(file), base_elements=[str(base)])
    moving = [i for i, link in enumerate(arm.links) if link.joint_type in ("revolute", "prismatic")]
    if len(moving) != robot.n:
        raise ValueError(f"reads {len(moving)} joints of {robot.n}")
    arm.active_links_mask = np.isin(np.arange(len(arm.links)), moving)
    start = np.zeros(len(arm.links))
    start[moving] = robot.lower + MIDDLE_SHARE * (robot.upper - robot.lower)
    home = arm.forward_kinematics(start)
    if not np.allclose(home, kl.fk(robot, start[moving]), atol=1e-6):
        raise ValueError("reads another tool frame")

    def solve(pose: np.ndarray) -> np.ndarray | None:
        q = arm.inverse_kinematics_frame(pose, initial_position=start, orientation_mode="all")
        return np.asarray(q)[moving]

    return solve


def installed(name: str) -> str | None:
    """The version of a peer, or None."""
    try:
        return version(name)
    except ImportError:
        return None
