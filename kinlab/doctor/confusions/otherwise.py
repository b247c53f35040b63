"""What the engine says if asked otherwise: another frame, another split of C, terms left out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kinlab.arrays import Array
from kinlab.doctor.changes import Arguments, Engine
from kinlab.engine.dynamics import coriolis_matrix, gravity_torques
from kinlab.engine.kinematics import fk, jacobian, statics
from kinlab.engine.lagrange import christoffel
from kinlab.model.robot import Robot

Asked = Callable[[Engine, Robot, Arguments], Array]
"""An answer by the engine's own, the robot and the arguments."""
Rates = Callable[[Robot, Array, Array], Array]
"""What is added to a vector at (q, v)."""


def in_frame(frame: str) -> Asked:
    return lambda engine, robot, x: jacobian(robot, x["q"], frame)


def without_tool(engine: Engine, robot: Robot, x: Arguments) -> Array:
    jac = jacobian(robot, x["q"])
    if robot.table is None:
        return jac
    arm = robot.table.frames(x["q"])[:, -1, :3, 3] - fk(robot, x["q"])[:, :3, 3]
    jac[:, :3] += np.cross(jac[:, 3:], arm[:, :, None], axis=1)
    return jac


def wrench_in(frame: str) -> Asked:
    return lambda engine, robot, x: statics(robot, x["q"], x["wrench"], frame)


def pseudo_inverse(engine: Engine, robot: Robot, x: Arguments) -> Array:
    out: Array = np.einsum("nij,nj->ni", np.linalg.pinv(jacobian(robot, x["q"])), x["wrench"])
    return out


def jacobian_itself(engine: Engine, robot: Robot, x: Arguments) -> Array:
    """J F for J^T F; of an arm with six joints only."""
    jac = jacobian(robot, x["q"])
    if jac.shape[1] != jac.shape[2]:
        return np.full_like(x["q"], np.nan)
    out: Array = np.einsum("nij,nj->ni", jac, x["wrench"])
    return out


def with_gravity_torques(engine: Engine, robot: Robot, x: Arguments) -> Array:
    """The recursion asked without setting gravity to zero: g in the torques, or in each column."""
    out = engine(robot, x)
    weight: Array = gravity_torques(robot, x["q"])
    return out + (weight if out.ndim == 2 else weight[:, :, None])


def in_absolute_angles(q_too: bool) -> Asked:
    """M for angles that are counted from the base: S^T M S, with S their differences."""

    def asked(engine: Engine, robot: Robot, x: Arguments) -> Array:
        steps = np.eye(robot.n) - np.eye(robot.n, k=-1)
        q = x["q"] @ steps.T if q_too else x["q"]
        out: Array = steps.T @ engine(robot, {**x, "q": q}) @ steps
        return out

    return asked


def summed_with_rates(engine: Engine, robot: Robot, x: Arguments) -> Array:
    """The entries added up, each times its velocity: one number for the whole vector."""
    out = engine(robot, x)
    power = np.einsum("ni,ni->n", out, x["v"])
    return np.broadcast_to(power[:, None], out.shape)


# C by other sums of the slopes of M: dM_ij/dq_k at [:, i, j, k], as Mdot = C + C^T


def mass_slope(robot: Robot, q: Array) -> Array:
    c = christoffel(robot, q)
    return c + np.swapaxes(c, 1, 2)


def symmetric(slope: Array) -> Array:
    """½ (dM_ik/dq_j + dM_jk/dq_i) at [i, j, k]."""
    form: Array = 0.5 * (np.einsum("nikj->nijk", slope) + np.einsum("njki->nijk", slope))
    return form


def unskewed(slope: Array) -> Array:
    out: Array = slope - 0.5 * np.einsum("njki->nijk", slope)
    return out


def mass_rate(slope: Array) -> Array:
    return slope


def split(form: Callable[[Array], Array]) -> Asked:
    """The matrix C by another sum."""

    def asked(engine: Engine, robot: Robot, x: Arguments) -> Array:
        out: Array = np.einsum("nijk,nk->nij", form(mass_slope(robot, x["q"])), x["v"])
        return out

    return asked


def added(factor: float, extra: Rates) -> Asked:
    return lambda engine, robot, x: engine(robot, x) + factor * extra(robot, x["q"], x["v"])


def torques_by(form: Callable[[Array], Array]) -> Asked:
    """C v by another sum."""

    def extra(robot: Robot, q: Array, v: Array) -> Array:
        gap = form(mass_slope(robot, q)) - christoffel(robot, q)
        out: Array = np.einsum("nijk,nj,nk->ni", gap, v, v)
        return out

    return added(1.0, extra)


def squares(robot: Robot, q: Array, v: Array) -> Array:
    """The terms of C v in qd_i²."""
    out: Array = np.einsum("nijj,nj->ni", christoffel(robot, q), v**2)
    return out


def products(robot: Robot, q: Array, v: Array) -> Array:
    """The terms of C v in qd_i qd_j."""
    both: Array = np.einsum("nij,nj->ni", coriolis_matrix(robot, q, v), v)
    return both - squares(robot, q, v)
