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


def in_frame(frame: str) -> Callable[[Engine], Engine]:
    def changed(robot: Robot, x: Arguments) -> Array:
        return jacobian(robot, x["q"], frame)

    return lambda engine: changed


def without_tool(engine: Engine) -> Engine:
    def changed(robot: Robot, x: Arguments) -> Array:
        jac = jacobian(robot, x["q"])
        if robot.table is None:
            return jac
        arm = robot.table.frames(x["q"])[:, -1, :3, 3] - fk(robot, x["q"])[:, :3, 3]
        jac[:, :3] += np.cross(jac[:, 3:], arm[:, :, None], axis=1)
        return jac

    return changed


def wrench_in(frame: str) -> Callable[[Engine], Engine]:
    def changed(robot: Robot, x: Arguments) -> Array:
        return statics(robot, x["q"], x["wrench"], frame)

    return lambda engine: changed


def pseudo_inverse(engine: Engine) -> Engine:
    def changed(robot: Robot, x: Arguments) -> Array:
        out: Array = np.einsum("nij,nj->ni", np.linalg.pinv(jacobian(robot, x["q"])), x["wrench"])
        return out

    return changed


def with_gravity_torques(engine: Engine) -> Engine:
    """The recursion asked without setting gravity to zero: g in the torques, or in each column."""

    def changed(robot: Robot, x: Arguments) -> Array:
        out = engine(robot, x)
        weight: Array = gravity_torques(robot, x["q"])
        return out + (weight if out.ndim == 2 else weight[:, :, None])

    return changed


def mass_slope(robot: Robot, q: Array) -> Array:
    """dM_ij/dq_k at [:, i, j, k]: Mdot = C + C^T for each unit velocity."""
    c = christoffel(robot, q)
    return c + np.swapaxes(c, 1, 2)


def _from_slope(form: Callable[[Array], Array]) -> Callable[[Engine], Engine]:
    def apply(engine: Engine) -> Engine:
        def changed(robot: Robot, x: Arguments) -> Array:
            out: Array = np.einsum("nijk,nk->nij", form(mass_slope(robot, x["q"])), x["v"])
            return out

        return changed

    return apply


def _symmetric_form(slope: Array) -> Array:
    """½ (dM_ik/dq_j + dM_jk/dq_i) at [i, j, k]."""
    form: Array = 0.5 * (np.einsum("nikj->nijk", slope) + np.einsum("njki->nijk", slope))
    return form


symmetric = _from_slope(_symmetric_form)
unskewed = _from_slope(lambda slope: slope - 0.5 * np.einsum("njki->nijk", slope))
mass_rate = _from_slope(lambda slope: slope)
half_mass_rate = _from_slope(lambda slope: 0.5 * slope)

Extra = Callable[[Robot, Array, Array], Array]


def added(extra: Extra) -> Callable[[Engine], Engine]:
    def apply(engine: Engine) -> Engine:
        return lambda robot, x: engine(robot, x) + extra(robot, x["q"], x["v"])

    return apply


def symmetric_extra(robot: Robot, q: Array, v: Array) -> Array:
    form = _symmetric_form(mass_slope(robot, q)) - christoffel(robot, q)
    out: Array = np.einsum("nijk,nj,nk->ni", form, v, v)
    return out


def mass_rate_extra(robot: Robot, q: Array, v: Array) -> Array:
    form = mass_slope(robot, q) - christoffel(robot, q)
    out: Array = np.einsum("nijk,nj,nk->ni", form, v, v)
    return out


def centrifugal(factor: float) -> Extra:
    def extra(robot: Robot, q: Array, v: Array) -> Array:
        out: Array = factor * np.einsum("nijj,nj->ni", christoffel(robot, q), v**2)
        return out

    return extra


def coriolis_share(factor: float) -> Extra:
    def extra(robot: Robot, q: Array, v: Array) -> Array:
        out: Array = factor * np.einsum("nij,nj->ni", coriolis_matrix(robot, q, v), v)
        return out

    return extra


def joint_products(factor: float) -> Extra:
    def extra(robot: Robot, q: Array, v: Array) -> Array:
        return coriolis_share(factor)(robot, q, v) - centrifugal(factor)(robot, q, v)

    return extra


def in_absolute_angles(q_too: bool) -> Callable[[Engine], Engine]:
    """M for angles that are counted from the base: S^T M S, with S their differences."""

    def apply(engine: Engine) -> Engine:
        def changed(robot: Robot, x: Arguments) -> Array:
            n = robot.n
            steps = np.eye(n) - np.eye(n, k=-1)
            q = x["q"] @ steps.T if q_too else x["q"]
            out: Array = steps.T @ engine(robot, {**x, "q": q}) @ steps
            return out

        return changed

    return apply


def jacobian_itself(engine: Engine) -> Engine:
    """J F for J^T F; of an arm with six joints only."""

    def changed(robot: Robot, x: Arguments) -> Array:
        jac = jacobian(robot, x["q"])
        if jac.shape[1] != jac.shape[2]:
            return np.full_like(x["q"], np.nan)
        out: Array = np.einsum("nij,nj->ni", jac, x["wrench"])
        return out

    return changed


def summed_with_rates(engine: Engine) -> Engine:
    """The entries added up, each times its velocity: one number for the whole vector."""

    def changed(robot: Robot, x: Arguments) -> Array:
        out = engine(robot, x)
        power = np.einsum("ni,ni->n", out, x["v"])
        return np.broadcast_to(power[:, None], out.shape)

    return changed
