"""The table of known confusions: every reading that makes sense for a quantity."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.doctor.changes import Arguments, Case, Engine, Reading
from kinlab.doctor.robot_readings import gravity_readings, inertia_readings, table_readings
from kinlab.engine.dynamics import coriolis_matrix
from kinlab.engine.kinematics import fk, jacobian, statics
from kinlab.engine.lagrange import christoffel
from kinlab.model.link import Convention
from kinlab.model.robot import Robot, scratch

_FRAMES = {"jacobian": "base", "jacobian_tool": "tool", "jacobian_spatial": "spatial"}
_STATICS = {"statics": "base", "statics_tool": "tool"}
_KINEMATIC = {
    "fk",
    "planar_pose",
    "planar_jacobian",
    "jacobian_dot",
    "tip_speed_squared",
    *_FRAMES,
    *_STATICS,
}
_WEIGHED = {
    "gravity_torques",
    "inverse_dynamics",
    "inverse_dynamics_loaded",
    "potential_energy",
    "forward_dynamics",
    "lagrangian",
    "lagrangian_gradient",
    "link_potential_energies",
}
"""What depends on gravity."""


def readings(case: Case) -> list[Reading]:
    """Every reading for the case's quantity and robot."""
    name = case.quantity.name
    found = [*table_readings(case.robot)]
    if name not in _KINEMATIC:
        found += inertia_readings(case.robot)
        if name in _WEIGHED:
            found += gravity_readings(case.robot)
    return [*found, *_arguments(case), *_engines(case), *_answers(case)]


def _arguments(case: Case) -> Iterator[Reading]:
    have = case.arguments
    motion = [name for name in ("q", "v", "a") if name in have]
    if "q" in have:
        yield _argument("degrees", "takes q in degrees", ("q",), np.deg2rad)
        if len(motion) > 1:
            yield _argument("degrees", "takes q and its rates in degrees", motion, np.deg2rad)
        yield _argument("degrees", "turns q into degrees first", ("q",), np.rad2deg, 1.2)
        yield _argument(
            "turning sense", "counts every joint the other way", motion, np.negative, 1.2
        )
        if case.robot.n > 1:
            yield _argument("joint order", "takes the joints from tool to base", motion, _backwards)
            yield _argument(
                "absolute angles", "takes every angle from the base", motion, _relative, 1.2
            )
            yield _argument("absolute angles", "adds up angles that are from the base already",
                            motion, _absolute, 1.3)  # fmt: skip
    for name, words in (("v", "velocity"), ("a", "acceleration")):
        if name in have:
            yield _argument(
                f"{words} left out", f"leaves the {words} terms out", (name,), np.zeros_like, 1.1
            )
            yield _argument(
                f"{words} sign",
                f"has the {words} with the opposite sign",
                (name,),
                np.negative,
                1.3,
            )
    if "wrench" in have:
        yield _argument("wrench sign", "takes the wrench that acts on the tool (passive sign)",
                        ("wrench",), np.negative)  # fmt: skip
        yield _argument(
            "wrench order", "takes the moment first in the wrench", ("wrench",), _halves
        )
        yield _argument(
            "moment left out", "leaves the moment of the wrench out", ("wrench",), _force, 1.2
        )
        yield _argument(
            "force left out", "leaves the force of the wrench out", ("wrench",), _moment, 1.3
        )


def _engines(case: Case) -> Iterator[Reading]:
    name = case.quantity.name
    if name in _FRAMES:
        for frame in ("base", "tool", "spatial"):
            if frame != _FRAMES[name]:
                yield _other("frame", f"is the {frame} Jacobian", _in_frame(frame))
        yield _other("frame", "has the base's axes, but refers to the last DH frame's origin, "
                     "not the tool", _without_tool, 1.4)  # fmt: skip
    if name in _STATICS:
        for frame in ("base", "tool", "spatial"):
            if frame != _STATICS[name]:
                yield _other("frame", f"takes the wrench in the {frame} frame", _wrench_in(frame))
        yield _other("inverse for transpose", "uses the pseudo-inverse of J for its transpose",
                     _pseudo, 1.3)  # fmt: skip
    if name == "coriolis_matrix":
        yield _other("symmetric Coriolis", "uses C_ij = ½ Σ (dM_ik/dq_j + dM_jk/dq_i) qd_k, the "
                     "symmetric form, not Christoffel's", _symmetric)  # fmt: skip
        split = "C_ij = Σ (dM_ij/dq_k - ½ dM_jk/dq_i) qd_k"
        said = f"splits C v otherwise: {split} gives the same torques, but Mdot - 2C is not skew"
        yield _other("Coriolis split", said, _unskewed)
        yield _other("Coriolis split", "is Mdot", _mass_rate, 1.2)
        yield _other("Coriolis split", "is ½ Mdot", _half_rate, 1.2)
    if name in ("coriolis_torques", "inverse_dynamics", "inverse_dynamics_loaded"):
        yield _other("symmetric Coriolis", "uses the symmetric formula for C, not Christoffel's",
                     _added(_symmetric_extra))  # fmt: skip
        yield _other(
            "gyroscopic term", "leaves the gyroscopic terms w x I w out", _added(_gyroscopic)
        )
        yield _other(
            "Coriolis terms", "leaves the products qd_i qd_j out", _added(_products(-1.0)), 1.1
        )
        yield _other("Coriolis terms", "counts each product qd_i qd_j once, not twice",
                     _added(_products(-0.5)), 1.1)  # fmt: skip
        yield _other(
            "centrifugal terms", "leaves the squares qd_i² out", _added(_squares(-1.0)), 1.1
        )
        yield _other("velocity terms sign", "has the velocity terms with the opposite sign",
                     _added(_circling(-2.0)), 1.1)  # fmt: skip
        yield _other(
            "velocity terms factor", "counts the velocity terms twice", _added(_circling(1.0)), 1.2
        )
        yield _other(
            "velocity terms factor", "counts the velocity terms half", _added(_circling(-0.5)), 1.2
        )
        yield _other("Mdot for C", "uses Mdot v for C v", _added(_rate_extra), 1.2)
    if name in ("mass_matrix", "kinetic_energy"):
        said = "takes the inertia tensors in link axes as if in base axes"
        yield _other("inertia frame", said, _unturned(name, _joint_axes))
        table = case.robot.table
        if table is not None and table.convention is Convention.STANDARD:
            yield _other("inertia frame", said, _unturned(name, _table_axes))


def _answers(case: Case) -> Iterator[Reading]:
    name = case.quantity.name
    shape = case.engine(case.robot, {k: v[:1] for k, v in case.arguments.items()}).shape[1:]
    if name in _FRAMES or name == "jacobian_dot":
        yield _answer("row order", "has the angular rows first", lambda x: np.roll(x, 3, axis=1))
    if name == "fk":
        yield _answer("inverse", "is the inverse transform (the base in the tool)", _inverse)
        yield _answer("rotation transposed", "has the rotation transposed", _rotation_transposed)
    if len(shape) == 2 and (shape[0] > 1 or shape[1] > 1):
        yield _answer("transposed", "is transposed", lambda x: np.swapaxes(x, 1, 2))
    yield _answer("sign", "has the opposite sign as a whole", np.negative, 1.1)
    for factor, words in ((2.0, "twice"), (0.5, "half")):
        yield _answer("factor", f"is {words} as large as a whole", _scaled(factor), 1.2)
    yield _answer("degrees", "answers in degrees", np.rad2deg, 1.4)
    if not shape or shape == (1,):
        return
    words = "row" if len(shape) == 2 else "entry"
    yield _answer("joint order", "answers from tool to base", lambda x: x[:, ::-1], 1.2)
    if len(shape) == 2:
        yield _answer(
            "joint order", "has the columns from tool to base", lambda x: x[:, :, ::-1], 1.2
        )
        if shape[0] == shape[1]:
            yield _answer("joint order", "has rows and columns from tool to base",
                          lambda x: x[:, ::-1, ::-1], 1.1)  # fmt: skip
        for k in range(shape[1]):
            for factor, said in _FACTORS:
                yield _answer(f"column {said}", f"has column {k + 1} {_SAID[said]}",
                              _scaled_at(factor, (slice(None), slice(None), k)), 1.5,
                              f"column {k + 1}")  # fmt: skip
    for k in range(shape[0]):
        for factor, said in _FACTORS:
            place = f"{words} {k + 1}"
            yield _answer(f"row {said}", f"has {place} {_SAID[said]}",
                          _scaled_at(factor, (slice(None), k)), 1.4, place)  # fmt: skip
        for j in range(k):
            yield _answer("rows swapped", f"has {words}s {j + 1} and {k + 1} exchanged",
                          _swapped(j, k), 1.5, f"{words}s {j + 1} and {k + 1}")  # fmt: skip


_FACTORS = ((-1.0, "sign"), (2.0, "twice"), (0.5, "half"), (0.0, "zero"))
_SAID = {"sign": "with the opposite sign", "twice": "twice as large", "half": "half as large",
         "zero": "zero"}  # fmt: skip


def _argument(
    kind: str, sentence: str, names: Any, change: Callable[[Array], Array], cost: float = 1.0
) -> Reading:
    chosen = tuple(names)

    def apply(arguments: Arguments) -> Arguments:
        return {k: change(v) if k in chosen else v for k, v in arguments.items()}

    return Reading(kind, sentence, "arguments", apply, cost)


def _other(
    kind: str, sentence: str, apply: Callable[[Engine], Engine], cost: float = 1.0
) -> Reading:
    return Reading(kind, sentence, "engine", apply, cost)


def _answer(
    kind: str, sentence: str, apply: Callable[[Array], Array], cost: float = 1.0, place: str = ""
) -> Reading:
    return Reading(kind, sentence, "answer", apply, cost, place)


def _backwards(x: Array) -> Array:
    return x[:, ::-1]


def _relative(x: Array) -> Array:
    steps: Array = np.diff(x, axis=1, prepend=0.0)
    return steps


def _absolute(x: Array) -> Array:
    total: Array = np.cumsum(x, axis=1)
    return total


def _halves(x: Array) -> Array:
    return np.roll(x, 3, axis=1)


def _force(x: Array) -> Array:
    kept: Array = np.where(np.arange(6) < 3, x, 0.0)
    return kept


def _moment(x: Array) -> Array:
    kept: Array = np.where(np.arange(6) >= 3, x, 0.0)
    return kept


def _inverse(x: Array) -> Array:
    return np.asarray(np.linalg.inv(x), dtype=float)


def _rotation_transposed(x: Array) -> Array:
    out = x.copy()
    out[:, :3, :3] = np.swapaxes(x[:, :3, :3], 1, 2)
    return out


def _scaled(factor: float) -> Callable[[Array], Array]:
    return lambda x: factor * x


def _scaled_at(factor: float, place: tuple[Any, ...]) -> Callable[[Array], Array]:
    def apply(x: Array) -> Array:
        out = x.copy()
        out[place] *= factor
        return out

    return apply


def _swapped(j: int, k: int) -> Callable[[Array], Array]:
    def apply(x: Array) -> Array:
        out = x.copy()
        out[:, [j, k]] = x[:, [k, j]]
        return out

    return apply


def _in_frame(frame: str) -> Callable[[Engine], Engine]:
    def changed(robot: Robot, x: Arguments) -> Array:
        return jacobian(robot, x["q"], frame)

    return lambda engine: changed


def _without_tool(engine: Engine) -> Engine:
    def changed(robot: Robot, x: Arguments) -> Array:
        jac = jacobian(robot, x["q"])
        if robot.table is None:
            return jac
        arm = robot.table.frames(x["q"])[:, -1, :3, 3] - fk(robot, x["q"])[:, :3, 3]
        jac[:, :3] += np.cross(jac[:, 3:], arm[:, :, None], axis=1)
        return jac

    return changed


def _wrench_in(frame: str) -> Callable[[Engine], Engine]:
    def changed(robot: Robot, x: Arguments) -> Array:
        return statics(robot, x["q"], x["wrench"], frame)

    return lambda engine: changed


def _pseudo(engine: Engine) -> Engine:
    def changed(robot: Robot, x: Arguments) -> Array:
        out: Array = np.einsum("nij,nj->ni", np.linalg.pinv(jacobian(robot, x["q"])), x["wrench"])
        return out

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


_symmetric = _from_slope(_symmetric_form)
_unskewed = _from_slope(lambda slope: slope - 0.5 * np.einsum("njki->nijk", slope))
_mass_rate = _from_slope(lambda slope: slope)
_half_rate = _from_slope(lambda slope: 0.5 * slope)

Extra = Callable[[Robot, Array, Array], Array]


def _added(extra: Extra) -> Callable[[Engine], Engine]:
    def apply(engine: Engine) -> Engine:
        return lambda robot, x: engine(robot, x) + extra(robot, x["q"], x["v"])

    return apply


def _symmetric_extra(robot: Robot, q: Array, v: Array) -> Array:
    form = _symmetric_form(mass_slope(robot, q)) - christoffel(robot, q)
    out: Array = np.einsum("nijk,nj,nk->ni", form, v, v)
    return out


def _rate_extra(robot: Robot, q: Array, v: Array) -> Array:
    form = mass_slope(robot, q) - christoffel(robot, q)
    out: Array = np.einsum("nijk,nj,nk->ni", form, v, v)
    return out


def _squares(factor: float) -> Extra:
    def extra(robot: Robot, q: Array, v: Array) -> Array:
        out: Array = factor * np.einsum("nijj,nj->ni", christoffel(robot, q), v**2)
        return out

    return extra


def _circling(factor: float) -> Extra:
    def extra(robot: Robot, q: Array, v: Array) -> Array:
        out: Array = factor * np.einsum("nij,nj->ni", coriolis_matrix(robot, q, v), v)
        return out

    return extra


def _products(factor: float) -> Extra:
    def extra(robot: Robot, q: Array, v: Array) -> Array:
        return _circling(factor)(robot, q, v) - _squares(factor)(robot, q, v)

    return extra


def _gyroscopic(robot: Robot, q: Array, v: Array) -> Array:
    """-sum Jw^T (w x I w), each link in its own axes."""
    out = np.zeros_like(q)
    data = scratch(robot)
    for row, (position, speed) in enumerate(zip(q, v, strict=True)):
        pin.computeJointJacobians(robot.model, data, position)
        for i in range(1, robot.model.njoints):
            jac = pin.getJointJacobian(robot.model, data, i, pin.ReferenceFrame.LOCAL)
            turning = jac.reshape(6, -1)[3:]  # one column comes flat
            spin = turning @ speed
            out[row] -= turning.T @ np.cross(spin, robot.model.inertias[i].inertia @ spin)
    return out


Tensors = Callable[[Robot, Array, int], tuple[Array, Array]]
"""Robot, one q and a link from 0: the tensor, and the rotation of its axes in the base."""


def _joint_axes(robot: Robot, q: Array, i: int) -> tuple[Array, Array]:
    data = scratch(robot)
    return robot.model.inertias[i + 1].inertia, data.oMi[i + 1].rotation


def _table_axes(robot: Robot, q: Array, i: int) -> tuple[Array, Array]:
    """A standard table's frame i is turned against the joint's by alpha."""
    assert robot.table is not None
    frame = robot.table.frames(q[None])[0, i, :3, :3]
    return np.asarray(robot.table.links[i].inertia), frame


def _unturned(name: str, axes: Tensors) -> Callable[[Engine], Engine]:
    def extra(robot: Robot, q: Array) -> Array:
        """sum Jw^T (I - R I R^T) Jw with Jw in base axes."""
        out = np.zeros((len(q), robot.n, robot.n))
        data = scratch(robot)
        for row, position in enumerate(q):
            pin.computeJointJacobians(robot.model, data, position)
            for i in range(robot.n):
                turning = pin.getJointJacobian(
                    robot.model, data, i + 1, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
                ).reshape(6, -1)[3:]
                tensor, turn = axes(robot, position, i)
                out[row] += turning.T @ (tensor - turn @ tensor @ turn.T) @ turning
        return out

    def apply(engine: Engine) -> Engine:
        if name == "mass_matrix":
            return lambda robot, x: engine(robot, x) + extra(robot, x["q"])
        return lambda robot, x: (
            engine(robot, x) + 0.5 * np.einsum("ni,nij,nj->n", x["v"], extra(robot, x["q"]), x["v"])
        )

    return apply
