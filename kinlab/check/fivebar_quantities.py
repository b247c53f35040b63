"""Engine quantities of a five-bar: Pinocchio's closed chain, state by state."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.check.fivebar import FIVEBAR
from kinlab.check.quantity import Quantity
from kinlab.fivebar import FiveBar
from kinlab.fivebar.closed_chain import CRANKS, PASSIVE, ClosedChain

Answer = Callable[..., Any]


def _engine(answer: Answer, *, rods: bool) -> Answer:
    """Runs ``answer(chain, *one state)`` over the states; without the rods' mass if asked."""

    def engine(fivebar: FiveBar, *stacks: Any) -> Array:
        light = fivebar if rods else replace(fivebar, rod_mass=0.0, rod_inertia=0.0)
        chain = light.closed_chain()
        return np.array([answer(chain, *state) for state in zip(*stacks, strict=True)])

    return engine


def _bars(chain: ClosedChain, q: Array, joints: tuple[int, ...]) -> Array:
    """Directions of the x axes of two joints, (2, 2)."""
    data = chain.model.createData()
    pin.forwardKinematics(chain.model, data, q)
    return np.array([data.oMi[joint + 1].rotation[:2, 0] for joint in joints])


def _pins(chain: ClosedChain, theta: Array) -> tuple[Array, Array]:
    """Base pins and elbows, each (2, 2), m."""
    q = np.zeros(4)
    q[[*CRANKS]] = theta
    data = chain.model.createData()
    pin.forwardKinematics(chain.model, data, q)
    places = np.array([placement.translation[:2] for placement in data.oMi])
    return places[[1, 3]], places[[2, 4]]


def _rod_length(chain: ClosedChain, theta: Array, xy: Array) -> Any:
    return np.linalg.norm(xy - _pins(chain, theta)[1], axis=1)


def _projection(chain: ClosedChain, theta: Array, xy: Array) -> Any:
    base, elbow = _pins(chain, theta)
    return 2.0 * np.sum((base - xy) * (elbow - base), axis=1)


def _torque(chain: ClosedChain, xy: Array, v: Array, a: Array, mode: Array) -> Array:
    q = chain.at(xy, mode)
    qd = chain.joint_rates(q, v)
    return chain.inverse_dynamics(q, qd, chain.joint_accelerations(q, qd, a))


def _turn(chain: ClosedChain, xy: Array, v: Array, a: Array, mode: Array) -> Any:
    q = chain.at(xy, mode)
    return chain.joint_accelerations(q, chain.joint_rates(q, v), a)[[*CRANKS]]


def _power(chain: ClosedChain, xy: Array, v: Array, a: Array, mode: Array) -> Any:
    rate = chain.joint_rates(chain.at(xy, mode), v)[[*CRANKS]]
    return _torque(chain, xy, v, a, mode) * rate


def _per_acceleration(chain: ClosedChain, xy: Array, mode: Array) -> Any:
    still = np.zeros(2)
    held = _torque(chain, xy, still, still, mode)
    columns = [_torque(chain, xy, still, unit, mode) - held for unit in np.eye(2)]
    return np.stack(columns, axis=1)


def _load(chain: ClosedChain, xy: Array, mode: Array) -> Any:
    return np.diag(chain.mass_matrix(chain.at(xy, mode)))


def _quantity(
    name: str, arguments: str, answer: Answer, about: str, *, rods: bool = True
) -> Quantity:
    return Quantity(name, tuple(arguments.split()), _engine(answer, rods=rods), about, FIVEBAR)


QUANTITIES = (
    _quantity("fivebar_rod_length", "theta xy", _rod_length, "elbow to tool, m, (2,)"),
    _quantity(
        "fivebar_projection", "theta xy",
        _projection, "2 (A - P)·(B - A) = A cos theta + B sin theta, m², (2,)",
    ),
    _quantity(
        "fivebar_cranks", "xy mode",
        lambda c, xy, mode: _bars(c, c.at(xy, mode), CRANKS), "u_1, u_2, (2, 2)",
    ),
    _quantity(
        "fivebar_rods", "xy mode",
        lambda c, xy, mode: _bars(c, c.at(xy, mode), PASSIVE), "w_1, w_2, (2, 2)",
    ),
    _quantity(
        "fivebar_jacobian", "xy mode",
        lambda c, xy, mode: c.jacobian(c.at(xy, mode)), "J of theta_dot = J v, rad/m, (2, 2)",
    ),
    _quantity("fivebar_turn", "xy v a mode", _turn, "theta_ddot, rad/s², (2,)"),
    _quantity("fivebar_torque", "xy v a mode", _torque, "crank torques, N m, (2,)"),
    _quantity(
        "fivebar_torque_massless", "xy v a mode",
        _torque, "crank torques with massless rods, N m, (2,)", rods=False,
    ),
    _quantity(
        "fivebar_torque_per_acceleration", "xy mode",
        _per_acceleration, "G with massless rods, kg m, (2, 2)", rods=False,
    ),
    _quantity(
        "fivebar_torque_gains", "xy mode",
        lambda c, xy, mode: np.linalg.svd(_per_acceleration(c, xy, mode), compute_uv=False),
        "singular values of G with massless rods, largest first, kg m, (2,)", rods=False,
    ),
    _quantity(
        "fivebar_power_massless", "xy v a mode",
        _power, "power of each crank with massless rods, W, (2,)", rods=False,
    ),
    _quantity(
        "fivebar_rate_per_speed", "xy mode",
        lambda c, xy, mode: np.linalg.norm(c.jacobian(c.at(xy, mode)), axis=1),
        "worst theta_dot per |v|, rad/m, (2,)",
    ),
    _quantity(
        "fivebar_load_inertia_massless", "xy mode",
        _load, "diagonal of the crank-side mass matrix with massless rods, kg m², (2,)",
        rods=False,
    ),
    _quantity(
        "fivebar_torque_per_acceleration_worst", "xy mode",
        lambda c, xy, mode: np.linalg.norm(_per_acceleration(c, xy, mode), axis=1),
        "worst torque per |a| with massless rods, kg m, (2,)", rods=False,
    ),
)  # fmt: skip
