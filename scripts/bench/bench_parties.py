"""The parties of the benchmark: kinlab's public functions and what each peer calls instead.

Each function takes a robot and the states and answers ``{operation: call without arguments}``.
A peer that is not installed answers nothing.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Callable

import numpy as np
import pinocchio as pin

import kinlab as kl

Calls = dict[str, Callable[[], np.ndarray]]

SINGLE = (
    "fk", "jacobian", "jacobian_dot", "mass_matrix", "coriolis_matrix", "gravity_torques",
    "inverse_dynamics", "forward_dynamics",
)  # fmt: skip


def kinlab_single(robot: kl.Robot, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Calls:
    """The public functions; also what a batch calls, with stacks."""
    return {
        "fk": lambda: kl.fk(robot, q),
        "jacobian": lambda: kl.jacobian(robot, q),
        "jacobian_dot": lambda: kl.jacobian_dot(robot, q, v),
        "mass_matrix": lambda: kl.mass_matrix(robot, q),
        "coriolis_matrix": lambda: kl.coriolis_matrix(robot, q, v),
        "gravity_torques": lambda: kl.gravity_torques(robot, q),
        "inverse_dynamics": lambda: kl.inverse_dynamics(robot, q, v, a),
        "forward_dynamics": lambda: kl.forward_dynamics(robot, q, v, a),
    }


def pinocchio_single(robot: kl.Robot, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Calls:
    """The one to three Pinocchio calls that give the same answer, copied out of its data."""
    model, tool, axes = robot.model, robot.tool, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    data = model.createData()

    def fk() -> np.ndarray:
        pin.forwardKinematics(model, data, q)
        return pin.updateFramePlacement(model, data, tool).homogeneous

    def jacobian() -> np.ndarray:
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacement(model, data, tool)
        return pin.getFrameJacobian(model, data, tool, axes)

    def jacobian_dot() -> np.ndarray:
        pin.computeJointJacobiansTimeVariation(model, data, q, v)
        pin.updateFramePlacement(model, data, tool)
        return pin.getFrameJacobianTimeVariation(model, data, tool, axes)

    return {
        "fk": fk,
        "jacobian": jacobian,
        "jacobian_dot": jacobian_dot,
        "mass_matrix": lambda: pin.crba(model, data, q).copy(),
        "coriolis_matrix": lambda: pin.computeCoriolisMatrix(model, data, q, v).copy(),
        "gravity_torques": lambda: pin.computeGeneralizedGravity(model, data, q).copy(),
        "inverse_dynamics": lambda: pin.rnea(model, data, q, v, a).copy(),
        "forward_dynamics": lambda: pin.aba(model, data, q, v, a).copy(),
    }


def pinocchio_batch(
    robot: kl.Robot, q: np.ndarray, v: np.ndarray, a: np.ndarray, threads: int
) -> Calls:
    """Pinocchio's own parallel calls, where it has them; else a Python loop over its calls."""
    model = robot.model
    pool, data = pin.ModelPool(model, threads), model.createData()

    def loop(call: Callable[..., np.ndarray], *stacks: np.ndarray) -> np.ndarray:
        return np.array([call(model, data, *row) for row in zip(*stacks, strict=True)])

    return {
        "mass_matrix": lambda: loop(pin.crba, q),
        "coriolis_matrix": lambda: loop(pin.computeCoriolisMatrix, q, v),
        "gravity_torques": lambda: loop(pin.computeGeneralizedGravity, q),
        "inverse_dynamics": lambda: pin.rneaInParallel(threads, pool, q.T, v.T, a.T).T,
        "forward_dynamics": lambda: pin.abaInParallel(threads, pool, q.T, v.T, a.T).T,
    }


def toolbox_single(table: kl.DHTable, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Calls:
    """Robotics Toolbox for Python, its DHRobot built from the same table."""
    if importlib.util.find_spec("roboticstoolbox") is None:
        return {}
    import roboticstoolbox as rtb
    from spatialmath import SE3

    standard = str(table.convention) == "standard"
    kinds = {
        "revolute": rtb.RevoluteDH if standard else rtb.RevoluteMDH,
        "prismatic": rtb.PrismaticDH if standard else rtb.PrismaticMDH,
    }
    links = []
    for link in table.links:
        constant = {"d": link.d} if link.joint == "revolute" else {"theta": link.theta}
        offset = link.theta if link.joint == "revolute" else link.d
        links.append(
            kinds[link.joint](
                a=link.a,
                alpha=link.alpha,
                offset=offset,
                flip=link.flip,
                m=link.mass,
                r=np.array(link.com),
                I=np.array(link.inertia),
                Jm=link.armature,
                G=1,
                B=0,
                Tc=[0, 0],
                **constant,
            )
        )
    base, tool = SE3(np.array(table.base)), SE3(np.array(table.tool))
    arm = rtb.DHRobot(links, gravity=np.array(table.gravity), base=base, tool=tool)
    return {
        "fk": lambda: arm.fkine(q).A,
        "jacobian": lambda: arm.jacob0(q),
        "mass_matrix": lambda: arm.inertia(q),
        "coriolis_matrix": lambda: arm.coriolis(q, v),
        "gravity_torques": lambda: arm.gravload(q),
        "inverse_dynamics": lambda: arm.rne(q, v, a),
        "forward_dynamics": lambda: arm.accel(q, v, a),
    }


def mujoco_single(robot: kl.Robot, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> Calls:
    """MuJoCo on the same URDF. Each call sets the state, runs the stages it needs, and copies.

    It refuses massless links, such as the first of puma560. Its frames are those of the last
    body, not of the tool: the same work, another number.
    """
    massless = any(body.mass <= 0 for body in list(robot.model.inertias)[1:])
    if massless or importlib.util.find_spec("mujoco") is None:
        return {}
    import mujoco

    model = mujoco.MjModel.from_xml_string(robot.urdf)
    model.opt.gravity[:] = robot.model.gravity.linear
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
    model.dof_armature[:] = robot.model.armature
    data, n, last = mujoco.MjData(model), robot.n, model.nbody - 1

    def place() -> None:
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)

    def fk() -> np.ndarray:
        place()
        out = np.eye(4)
        out[:3, :3], out[:3, 3] = data.xmat[last].reshape(3, 3), data.xpos[last]
        return out

    def jacobian() -> np.ndarray:
        place()
        mujoco.mj_comPos(model, data)
        out = np.empty((6, n))
        mujoco.mj_jacBody(model, data, out[:3], out[3:], last)
        return out

    def mass_matrix() -> np.ndarray:
        place()
        mujoco.mj_comPos(model, data)
        mujoco.mj_crb(model, data)
        out = np.empty((n, n))
        mujoco.mj_fullM(model, data, out)
        return out

    def inverse_dynamics() -> np.ndarray:
        data.qpos[:], data.qvel[:], data.qacc[:] = q, v, a
        mujoco.mj_inverse(model, data)
        return data.qfrc_inverse.copy()

    def forward_dynamics() -> np.ndarray:
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = q, v, a
        mujoco.mj_forward(model, data)
        return data.qacc.copy()

    return {
        "fk": fk,
        "jacobian": jacobian,
        "mass_matrix": mass_matrix,
        "inverse_dynamics": inverse_dynamics,
        "forward_dynamics": forward_dynamics,
    }


def random_table(n: int, seed: int = 0) -> kl.DHTable:
    """n revolute joints with random twists, lengths and sound inertias, 2 m long in all."""
    rng = np.random.default_rng((seed, n))
    links = []
    for _ in range(n):
        spread = rng.uniform(0.001, 0.02, 3)
        links.append(
            kl.DHLink(
                a=rng.uniform(0.2, 1.0) * 2 / n,
                alpha=rng.choice([0.0, 1.0, -1.0]) * np.pi / 2,
                d=rng.uniform(-0.2, 0.2) * 2 / n,
                theta=rng.uniform(-1, 1),
                mass=rng.uniform(0.5, 3.0),
                com=rng.uniform(-0.1, 0.1, 3),
                inertia=np.diag(spread.sum() - spread),
            )
        )
    return kl.DHTable(f"random{n}", "standard", links)
