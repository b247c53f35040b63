"""Seeded confusions of whole answers, made from kinlab's public functions and Pinocchio.

Each makes the function that somebody who is confused would write, or ``None`` where the robot
does not have what is confused. Nothing of the doctor's readings is used.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pinocchio as pin

import kinlab as kl

Made = tuple[str, Callable[..., Any]] | None
"""Quantity, and the mistaken function of one state."""

DYNAMIC = ("inverse_dynamics", "mass_matrix", "gravity_torques", "coriolis_matrix")


def plain(quantity: str) -> Callable[..., Any]:
    """The right answer by name."""
    if quantity == "coriolis_torques":
        return lambda robot, q, v: kl.coriolis_matrix(robot, q, v) @ v
    if quantity == "statics":
        return lambda robot, q, w: kl.jacobian(robot, q).T @ w
    return getattr(kl, quantity)


def _on(robot: Any, quantity: str) -> Made:
    function = plain(quantity)
    return quantity, lambda *state: function(robot, *state)


def _after(robot: Any, quantity: str, change: Callable[..., Any]) -> Made:
    function = plain(quantity)
    return quantity, lambda *state: change(np.asarray(function(robot, *state)))


def _before(robot: Any, quantity: str, change: Callable[..., Any]) -> Made:
    function = plain(quantity)
    return quantity, lambda *state: function(robot, *(change(x) for x in state))


def _table(robot: Any, quantity: str, **columns: Any) -> Made:
    return _on(kl.Robot.from_dh(replace(robot.table, **columns)), quantity)


def _rows(robot: Any, quantity: str, change: Callable[[int, Any], dict[str, Any]]) -> Made:
    links = [replace(link, **change(k, link)) for k, link in enumerate(robot.table.links)]
    return _table(robot, quantity, links=links)


def frame(robot: Any, rng: random.Random) -> Made:
    """The Jacobian of another frame."""
    asked, given = rng.sample(["base", "tool", "spatial"], 2)
    name = "jacobian" if asked == "base" else f"jacobian_{asked}"
    return name, lambda q: kl.jacobian(robot, q, given)


def angular_first(robot: Any, rng: random.Random) -> Made:
    """Angular rows first."""
    return _after(robot, "jacobian", lambda jac: np.vstack([jac[3:], jac[:3]]))


def transposed(robot: Any, rng: random.Random) -> Made:
    """A transposed answer."""
    return _after(robot, rng.choice(["jacobian", "fk", "coriolis_matrix"]), np.transpose)


def inverted(robot: Any, rng: random.Random) -> Made:
    """The base in the tool."""
    return _after(robot, "fk", np.linalg.inv)


def degrees(robot: Any, rng: random.Random) -> Made:
    """Angles taken as degrees."""
    return _before(robot, rng.choice(["fk", "jacobian", "gravity_torques"]), np.deg2rad)


def convention(robot: Any, rng: random.Random) -> Made:
    """Standard for modified and back."""
    other = "standard" if str(robot.table.convention) == "modified" else "modified"
    return _table(robot, rng.choice(["fk", "jacobian", "gravity_torques"]),
                  convention=kl.Convention(other))  # fmt: skip


def _forgotten(column: str) -> Callable[[Any, random.Random], Made]:
    def make(robot: Any, rng: random.Random) -> Made:
        has = [k for k, link in enumerate(robot.table.links) if getattr(link, column)]
        if not has:
            return None
        at = rng.choice(has)
        zero = {column: 0.0}
        return _rows(robot, rng.choice(["fk", "jacobian"]), lambda k, _: zero if k == at else {})

    return make


def _left_out(which: str) -> Callable[[Any, random.Random], Made]:
    def make(robot: Any, rng: random.Random) -> Made:
        return _table(robot, rng.choice(["fk", "jacobian"]), **{which: np.eye(4)})

    return make


def gravity_sign(robot: Any, rng: random.Random) -> Made:
    """Gravity upwards."""
    return _table(robot, rng.choice(["gravity_torques", "inverse_dynamics"]),
                  gravity=-np.asarray(robot.table.gravity))  # fmt: skip


def gravity_axis(robot: Any, rng: random.Random) -> Made:
    """Gravity along another axis."""
    old = np.asarray(robot.table.gravity)
    return _table(robot, rng.choice(["gravity_torques", "inverse_dynamics"]),
                  gravity=np.roll(old, rng.choice([1, 2])))  # fmt: skip


def joint_order(robot: Any, rng: random.Random) -> Made:
    """Joints counted from the tool."""
    quantity = rng.choice(["fk", "jacobian", "gravity_torques", "inverse_dynamics"])
    return _before(robot, quantity, lambda x: x[::-1])


def passive(robot: Any, rng: random.Random) -> Made:
    """The wrench that acts on the tool."""
    return _after(robot, "statics", np.negative)


def _pinned(robot: Any, change: Callable[[Any, int], Any]) -> Any:
    model = pin.Model(robot.model)
    for k in range(1, model.njoints):
        body = pin.Inertia.Zero()
        body.mass, body.lever = model.inertias[k].mass, model.inertias[k].lever
        body.inertia = change(model.inertias[k], k)
        model.inertias[k] = body
    return model


def _by_pinocchio(model: Any, quantity: str) -> Made:
    data = model.createData()

    def mass(q: Any) -> Any:
        upper = np.triu(pin.crba(model, data, np.array(q))).copy()
        return upper + np.triu(upper, 1).T

    def torque(q: Any, v: Any, a: Any) -> Any:
        return pin.rnea(model, data, np.array(q), np.array(v), np.array(a))

    if quantity == "mass_matrix":
        return quantity, mass
    return quantity, torque


def inertia_point(robot: Any, rng: random.Random) -> Made:
    """Inertias about the joint for those about the centre, and back."""
    way = rng.choice([1, -1])

    def change(body: Any, k: int) -> Any:
        c = np.array(body.lever)
        return body.inertia + way * body.mass * (c @ c * np.eye(3) - np.outer(c, c))

    return _by_pinocchio(_pinned(robot, change), rng.choice(["mass_matrix", "inverse_dynamics"]))


def inertia_frame(robot: Any, rng: random.Random) -> Made:
    """M = sum m J^T J + Jw^T I Jw with I in link axes and Jw in the base."""
    model = pin.Model(robot.model)
    data = model.createData()

    def wrong(q: Any) -> Any:
        out = np.diag(np.array(model.armature))
        pin.computeJointJacobians(model, data, np.array(q))
        for k in range(1, model.njoints):
            jac = pin.getJointJacobian(model, data, k, pin.LOCAL_WORLD_ALIGNED).reshape(6, -1)
            body = model.inertias[k]
            arm = data.oMi[k].rotation @ body.lever
            centre = jac[:3] + np.cross(jac[3:].T, arm).T
            out = out + body.mass * centre.T @ centre + jac[3:].T @ body.inertia @ jac[3:]
        return out

    return "mass_matrix", wrong


def symmetric(robot: Any, rng: random.Random) -> Made:
    """Note 002's C, by central differences refined until rounding (Richardson)."""

    def slope(q: Any) -> Any:
        def half(k: int, h: float) -> Any:
            step = h * np.eye(len(q))[k]
            return (kl.mass_matrix(robot, q + step) - kl.mass_matrix(robot, q - step)) / (2 * h)

        def refined(k: int) -> Any:
            rows = [half(k, 0.4 / 2**i) for i in range(6)]
            for order in range(1, 6):
                pairs = itertools.pairwise(rows)
                rows = [(4**order * b - a) / (4**order - 1) for a, b in pairs]
            return rows[0]

        return np.stack([refined(k) for k in range(len(q))], axis=-1)

    def matrix(q: Any, v: Any) -> Any:
        d = slope(np.asarray(q, dtype=float))
        return 0.5 * (np.einsum("ikj,k->ij", d, v) + np.einsum("jki,k->ij", d, v))

    if rng.random() < 0.5:
        return "coriolis_matrix", matrix
    return "coriolis_torques", lambda q, v: matrix(q, v) @ v


def gyroscopic(robot: Any, rng: random.Random) -> Made:
    """Newton-Euler without w x I w, in base axes."""
    model = pin.Model(robot.model)
    data = model.createData()

    def wrong(q: Any, v: Any, a: Any) -> Any:
        tau = np.array(kl.inverse_dynamics(robot, q, v, a))
        pin.computeJointJacobians(model, data, np.array(q))
        for k in range(1, model.njoints):
            jac = pin.getJointJacobian(model, data, k, pin.LOCAL_WORLD_ALIGNED).reshape(6, -1)[3:]
            turn = data.oMi[k].rotation
            tensor = turn @ model.inertias[k].inertia @ turn.T
            tau -= jac.T @ np.cross(jac @ v, tensor @ (jac @ v))
        return tau

    return "inverse_dynamics", wrong


def rotor(robot: Any, rng: random.Random) -> Made:
    """No rotor inertia."""
    return _rows(robot, rng.choice(["mass_matrix", "inverse_dynamics"]),
                 lambda *_: {"armature": 0.0})  # fmt: skip


def row_sign(robot: Any, rng: random.Random) -> Made:
    """One row with the opposite sign."""
    at = rng.randrange(robot.n)

    def change(x: Any) -> Any:
        out = np.array(x)
        out[at] *= -1
        return out

    return _after(robot, rng.choice(["jacobian", "gravity_torques", "inverse_dynamics"]), change)


CONFUSIONS: dict[str, tuple[Callable[[Any, random.Random], Made], tuple[str, ...]]] = {
    "Jacobian of another frame": (frame, ("frame",)),
    "angular rows first": (angular_first, ("row order",)),
    "transposed": (transposed, ("transposed",)),
    "inverted transform": (inverted, ("inverse",)),
    "degrees": (degrees, ("degrees",)),
    "standard/modified": (convention, ("convention",)),
    "theta offset forgotten": (_forgotten("theta"), ("offset",)),
    "d offset forgotten": (_forgotten("d"), ("offset",)),
    "base left out": (_left_out("base"), ("base",)),
    "tool left out": (_left_out("tool"), ("tool",)),
    "gravity sign": (gravity_sign, ("gravity sign",)),
    "gravity axis": (gravity_axis, ("gravity axis",)),
    "joint order": (joint_order, ("joint order",)),
    "passive wrench sign": (passive, ("wrench sign",)),
    "inertia about the joint": (inertia_point, ("inertia point",)),
    "inertia in link axes": (inertia_frame, ("inertia frame", "tensor not rotated")),
    "symmetric Coriolis": (symmetric, ("symmetric Coriolis",)),
    "gyroscopic term": (gyroscopic, ("gyroscopic term",)),
    "rotor inertia left out": (rotor, ("rotor inertia",)),
    "single row sign": (row_sign, ("row sign", "sign")),
}
"""Class: how it is made, and the kinds that name it."""


def random_arm(rng: random.Random, joints: int) -> Any:
    """An arm with a random table: right-angled and skew twists, offsets, base, tool, rotors."""
    draw = np.random.default_rng(rng.randrange(1 << 30))
    links = []
    for _ in range(joints):
        mixed = draw.normal(size=(3, 3)) * 0.1
        links.append(kl.DHLink(
            a=draw.uniform(0.1, 0.6), alpha=rng.choice([0.0, np.pi / 2, -np.pi / 2, 0.7]),
            d=rng.choice([0.0, draw.uniform(0.05, 0.4)]), theta=rng.choice([0.0, np.pi / 2, 0.3]),
            mass=draw.uniform(0.5, 8.0), com=draw.uniform(-0.2, 0.2, 3),
            inertia=np.trace(mixed @ mixed.T) * np.eye(3) - mixed @ mixed.T,
            armature=draw.uniform(0.01, 0.5),
        ))  # fmt: skip
    base, tool = np.eye(4), np.eye(4)
    turn = pin.rpy.rpyToMatrix(draw.uniform(-1, 1, 3))
    base[:3, :3], base[:3, 3] = turn, draw.uniform(-0.5, 0.5, 3)
    tool[:3, 3] = draw.uniform(-0.2, 0.2, 3)
    named = kl.Convention(rng.choice(["standard", "modified"]))
    return kl.Robot.from_dh(kl.DHTable(
        name=f"random{joints}r", convention=named, links=links, base=base, tool=tool,
    ))  # fmt: skip
