"""Serial arms as a domain, and the engine's quantities of their kinematics and dynamics."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, lru_cache
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.quantity import Domain
from kinlab.engine import dynamics, kinematics
from kinlab.errors import NameUnknownError, near
from kinlab.model import library
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.extract import as_table
from kinlab.model.library import as_robot
from kinlab.model.link import Convention
from kinlab.model.robot import Robot
from kinlab.notes.arm import Arm

# -------- Serial arms as a domain: names and groups, the plain numbers, random states

REACH = float(np.pi)
"""Joint positions are drawn from the joint's range, from ± this about its middle at most."""


def arm_of(table: DHTable) -> Arm:
    """The plain numbers of a DH table."""
    links = table.links

    def column(name: str) -> Array:
        return np.array([getattr(link, name) for link in links], dtype=float)

    return Arm(
        name=table.name,
        convention=str(table.convention),
        prismatic=np.array([link.joint == "prismatic" for link in links]),
        a=column("a"),
        alpha=column("alpha"),
        d=column("d"),
        theta=column("theta"),
        sign=np.where([link.flip for link in links], -1.0, 1.0),
        mass=column("mass"),
        com=column("com"),
        inertia=column("inertia"),
        armature=column("armature"),
        base=np.asarray(table.base),
        tool=np.asarray(table.tool),
        gravity=np.asarray(table.gravity),
    )


@lru_cache(maxsize=64)
def numbers(robot: Robot) -> Arm:
    """The plain numbers of a robot's DH table, extracted where it comes from a URDF."""
    return arm_of(as_table(robot))


def load(robot: Any) -> Robot:
    """The arm of anything that names one, those that only a formula asks for included."""
    special = isinstance(robot, str) and robot in SPECIAL
    return _special(robot) if special else as_robot(robot)


@cache
def _special(name: str) -> Robot:
    return Robot.from_dh(SPECIAL[name]())


def _isotropic_2r() -> DHTable:
    second = 0.4
    first = float(np.sqrt(2.0)) * second
    rods = (
        DHLink(a=0.0, mass=1.0, com=(0.2, 0.0, 0.0)),
        DHLink(a=first, mass=1.0, com=(0.1, 0, 0)),
    )
    tool = np.eye(4)
    tool[0, 3] = second
    return DHTable("planar2r_isotropic", "modified", rods, tool=tool, gravity=(0.0, -9.81, 0.0))


SPECIAL = {"planar2r_isotropic": _isotropic_2r}
"""Arms that only a formula of the notes asks for."""


@cache
def members(name: str) -> tuple[str, ...]:
    """Names of the robots in a group; another name stands for itself."""
    rule = GROUPS.get(name)
    if rule is None:
        return (name,)
    return tuple(one for one in library.shipped() if rule(_table(one)))


@cache
def _table(name: str) -> DHTable:
    return DHTable.load(library.shipped()[name].path)


GROUPS: dict[str, Callable[[DHTable], bool]] = {
    "serial": lambda table: True,
    "standard": lambda table: table.convention is Convention.STANDARD,
    "modified": lambda table: table.convention is Convention.MODIFIED,
    "sliding": lambda table: any(link.joint == "prismatic" for link in table.links),
    "spatial": lambda table: any(abs(math.sin(link.alpha)) > 1e-6 for link in table.links),
}
"""Groups of shipped robots, by a rule on the table."""


def sample(
    robot: Robot, arguments: tuple[str, ...], count: int, rng: np.random.Generator
) -> tuple[Array, ...]:
    """Random states over the joint ranges; see :data:`DRAWS`.

    Raises:
        NameUnknownError: an argument that cannot be drawn.
    """
    for name in arguments:
        if name not in DRAWS:
            raise NameUnknownError(f"argument {name!r} cannot be drawn; {near(name, DRAWS)}")
    return tuple(DRAWS[name](robot, count, rng) for name in arguments)


def positions(robot: Robot, count: int, rng: np.random.Generator) -> Array:
    """Uniform over each joint's range, of which no more than one turn about its middle."""
    half = np.minimum(0.5 * (robot.upper - robot.lower), REACH)
    middle = 0.5 * (robot.upper + robot.lower)
    return rng.uniform(middle - half, middle + half, (count, robot.n))


def _normal(scale: float) -> Callable[[Robot, int, np.random.Generator], Array]:
    return lambda robot, count, rng: scale * rng.standard_normal((count, robot.n))


def _wrench(robot: Robot, count: int, rng: np.random.Generator) -> Array:
    del robot
    return rng.standard_normal((count, 6)) * [20.0, 20.0, 20.0, 5.0, 5.0, 5.0]


def _twist(robot: Robot, count: int, rng: np.random.Generator) -> Array:
    del robot
    return rng.standard_normal((count, 6))


DRAWS: dict[str, Callable[[Robot, int, np.random.Generator], Array]] = {
    "q": positions,
    "v": _normal(2.0),
    "a": _normal(5.0),
    "tau": _normal(10.0),
    "wrench": _wrench,
    "twist": _twist,
    "dq": _normal(0.3),
}
"""How each argument is drawn: rad, rad/s, rad/s², N m (m, ... for prismatic joints); N and N m."""

SERIAL = Domain("serial", load, lambda robot: str(robot.name), numbers, members, sample)


# -------- Engine quantities of a serial arm: kinematics and dynamics


def planar_pose(robot: Robot, q: Any) -> Array:
    """(x, y, phi) of the tool of an arm in the x-y plane; phi as cos and sin to avoid the wrap."""
    pose = kinematics.fk(robot, q)
    return np.stack([pose[..., 0, 3], pose[..., 1, 3], pose[..., 0, 0], pose[..., 1, 0]], axis=-1)


def planar_jacobian(robot: Robot, q: Any) -> Array:
    """Rows vx, vy, wz of the Jacobian in the base."""
    return kinematics.jacobian(robot, q)[..., [0, 1, 5], :]


def tip_speed_squared(robot: Robot, q: Any, v: Any) -> Any:
    """|J_v qdot|² of the tool origin."""
    speed = np.einsum("aij,aj->ai", kinematics.jacobian(robot, q)[:, :3], v)
    return np.linalg.norm(speed, axis=1) ** 2


def coriolis_torques(robot: Robot, q: Any, v: Any) -> Array:
    """C(q, v) v: what is left of the torque without gravity and acceleration."""
    still = np.zeros_like(np.asarray(q))
    return dynamics.inverse_dynamics(robot, q, v, still) - dynamics.gravity_torques(robot, q)


QUANTITIES = (
    SERIAL.quantity("fk", "q", kinematics.fk, "pose of the tool in the base, (4, 4)"),
    SERIAL.quantity(
        "jacobian", "q", kinematics.jacobian, "twist of the tool per qdot, base axes, (6, n)"
    ),
    SERIAL.quantity(
        "jacobian_tool",
        "q",
        lambda r, q: kinematics.jacobian(r, q, "tool"),
        "twist of the tool per qdot, tool axes, (6, n)",
    ),
    SERIAL.quantity(
        "jacobian_spatial",
        "q",
        lambda r, q: kinematics.jacobian(r, q, "spatial"),
        "spatial Jacobian: base axes, reference point the base origin, (6, n)",
    ),
    SERIAL.quantity(
        "jacobian_dot", "q v", kinematics.jacobian_dot, "its time derivative, base, (6, n)"
    ),
    SERIAL.quantity(
        "planar_pose", "q", planar_pose, "x, y, cos phi, sin phi of a planar arm's tool, (4,)"
    ),
    SERIAL.quantity(
        "planar_jacobian", "q", planar_jacobian, "rows vx, vy, wz of the Jacobian, (3, n)"
    ),
    SERIAL.quantity(
        "tip_speed_squared", "q v", tip_speed_squared, "|v|² of the tool, m²/s², a number"
    ),
    SERIAL.quantity(
        "statics",
        "q wrench",
        kinematics.statics,
        "joint torques J^T F of a wrench (f, n) that the tool exerts, base axes, (n,)",
    ),
    SERIAL.quantity(
        "statics_tool",
        "q wrench",
        lambda r, q, w: kinematics.statics(r, q, w, "tool"),
        "the same, with the wrench in tool axes, (n,)",
    ),
    SERIAL.quantity("mass_matrix", "q", dynamics.mass_matrix, "M, kg m² (kg for a slide), (n, n)"),
    SERIAL.quantity("coriolis_matrix", "q v", dynamics.coriolis_matrix, "Christoffel's C, (n, n)"),
    SERIAL.quantity("coriolis_torques", "q v", coriolis_torques, "C(q, v) v, N m, (n,)"),
    SERIAL.quantity("gravity_torques", "q", dynamics.gravity_torques, "g = dV/dq, N m, (n,)"),
    SERIAL.quantity(
        "inverse_dynamics", "q v a", dynamics.inverse_dynamics, "tau of a motion, N m, (n,)"
    ),
    SERIAL.quantity(
        "inverse_dynamics_loaded",
        "q v a wrench",
        dynamics.inverse_dynamics,
        "tau of a motion while the tool exerts a wrench (f, n), base axes, (n,)",
    ),
    SERIAL.quantity(
        "forward_dynamics", "q v tau", dynamics.forward_dynamics, "qddot, rad/s², (n,)"
    ),
    SERIAL.quantity("kinetic_energy", "q v", dynamics.kinetic_energy, "T, J, a number"),
    SERIAL.quantity("potential_energy", "q", dynamics.potential_energy, "V, J, zero at the origin"),
)
