"""Dynamics by Pinocchio: M, C, g, inverse and forward dynamics, energies, of any number of states.

tau = M(q) qddot + C(q, qdot) qdot + g(q): the equation of the notes. Armatures are part of M. The
joints' own friction, B qdot + tau_c sign(qdot) with sign(0) = 0, is a term beside it that counts
where it is asked for: ``friction=True``. :mod:`kinlab.engine.fast.stacks` has a faster road for
long stacks.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array, truth
from kinlab.engine.kinematics import each_call, each_state, statics
from kinlab.engine.states import finite_answer, joint_vector, joint_vectors, plain
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot, require_inertia, scratch


class Roads(NamedTuple):
    """What works stacks of states out: inverse and forward dynamics, and J^T F."""

    inverse: Callable[..., Array]
    forward: Callable[..., Array]
    statics: Callable[..., Array]


ROADS = Roads(each_call, each_call, statics)
"""Pinocchio, one state after the other."""


def mass_matrix(robot: ArmLike, q: ArrayLike) -> Array:
    """Joint-space inertia matrix M(q), symmetric positive definite (note 002, 002.M).

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n).

    Returns:
        (n, n) or (N, n, n), kg m² (kg for prismatic joints).

    Raises:
        StateError: q of the wrong shape or type, or not finite.
        InertiaError: a joint moves no inertia.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    require_inertia(robot)
    q = joint_vector(robot, q, "q")
    return _mass_matrix(robot, q) if q.ndim == 1 else each_call(robot, pin.crba, q)


def coriolis_matrix(robot: ArmLike, q: ArrayLike, v: ArrayLike) -> Array:
    """Christoffel's C(q, qdot): C_ij = ½ Σ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) qdot_k.

    With it Mdot - 2C is skew (note 002, 002.C corrected and 002.skew).

    Args:
        robot: the robot.
        q, v: joint positions and velocities, (n,) or (N, n).

    Returns:
        (n, n) or (N, n, n).

    Raises:
        StateError, InertiaError: as :func:`mass_matrix`.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    require_inertia(robot)
    q, v = joint_vectors(robot, q=q, v=v)
    return (
        _coriolis(robot, q, v) if q.ndim == 1 else each_call(robot, pin.computeCoriolisMatrix, q, v)
    )


def gravity_torques(robot: ArmLike, q: ArrayLike) -> Array:
    """Joint torques g(q) that hold the arm against gravity: g = dV/dq (note 002, 002.G).

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n).

    Returns:
        (n,) or (N, n), N m or N.

    Raises:
        StateError, InertiaError: as :func:`mass_matrix`.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    require_inertia(robot)
    return each_state(robot, gravity, joint_vector(robot, q, "q"))


def friction_torques(robot: ArmLike, v: ArrayLike) -> Array:
    """Joint torques that move the joints against their own friction: B qdot + tau_c sign(qdot).

    Viscous and Coulomb friction of each joint as its DH row or its URDF's ``<dynamics>`` states
    them (Siciliano et al., *Robotics*, section 7.1; the term F_v qdot + F_s sgn(qdot)). sign(0) is
    0: a joint at rest has no friction here, so one that would stick is not held.

    Args:
        robot: the robot.
        v: joint velocities, (n,) or (N, n).

    Returns:
        (n,) or (N, n), N m or N; zero for a robot whose friction nobody stated.

    Raises:
        StateError: v of the wrong shape or type, or not finite.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    v = joint_vector(robot, v, "v")
    lost: Array = robot.model.damping * v + robot.model.friction * np.sign(v)
    return lost


def inverse_dynamics(
    robot: ArmLike,
    q: ArrayLike,
    v: ArrayLike,
    a: ArrayLike,
    wrench: ArrayLike | None = None,
    friction: bool = False,
    _roads: Roads = ROADS,
) -> Array:
    """Joint torques of a motion, by recursive Newton-Euler (note 000, 000.ne).

    tau = M(q) qddot + C(q, qdot) qdot + g(q), and J^T F and :func:`friction_torques` where they
    are asked for. A tool that holds 2 kg at rest pushes them up, so that its wrench on the
    environment is 19.62 N along z::

        >>> import kinlab as kl
        >>> robot, q, rest = kl.load("ur5"), [0.0, -1.0, 1.2, 0.3, 0.5, 0.0], [0.0] * 6
        >>> held = kl.inverse_dynamics(robot, q, rest, rest, wrench=[0, 0, 2 * 9.81, 0, 0, 0])
        >>> loaded = kl.gravity_torques(kl.with_payload(robot, 2.0), q)  # the same, as a mass
        >>> bool(abs(held - loaded).max() < 1e-9)
        True

    Args:
        robot: the robot.
        q, v, a: joint positions, velocities and accelerations, (n,) or (N, n).
        wrench: (f, n) that the tool exerts on the environment, in base axes at the tool origin,
            (6,) or (N, 6); adds J^T F.
        friction: whether the joints' own friction counts, as :func:`friction_torques` gives it.
            Not by default: so tau is that of the equation above and of most formulas.

    Returns:
        tau, (n,) or (N, n), N m or N.

    Raises:
        StateError, InertiaError: as :func:`mass_matrix`.
        OptionError: friction is neither true nor false.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    require_inertia(robot)
    if wrench is None and friction is False and plain(robot, q, v, a):
        tau: Array = pin.rnea(robot.model, scratch(robot), q, v, a)
        if isfinite(sum(tau.tolist())):  # one sum sees NaN or infinity in any of q, v, a
            return tau
    q, v, a = joint_vectors(robot, q=q, v=v, a=a)
    tau = _inverse(robot, q, v, a) if q.ndim == 1 else _roads.inverse(robot, pin.rnea, q, v, a)
    tau = _with_loads(robot, tau, 1.0, q, v, wrench, friction, _roads)
    return finite_answer(robot, tau, "inverse_dynamics")


def forward_dynamics(
    robot: ArmLike,
    q: ArrayLike,
    v: ArrayLike,
    tau: ArrayLike,
    wrench: ArrayLike | None = None,
    friction: bool = False,
    _roads: Roads = ROADS,
) -> Array:
    """Joint accelerations under joint torques, by the articulated-body algorithm.

    M(q) qddot = tau - C(q, qdot) qdot - g(q), less J^T F and :func:`friction_torques` where they
    are asked for.

    Args:
        robot: the robot.
        q, v, tau: joint positions, velocities and torques, (n,) or (N, n).
        wrench, friction: as in :func:`inverse_dynamics`. Coulomb friction jumps where a joint
            turns round, and does not hold a joint at rest: sign(0) is 0.

    Returns:
        qddot, (n,) or (N, n), rad/s² or m/s².

    Raises:
        StateError, InertiaError, OptionError: as :func:`inverse_dynamics`.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    require_inertia(robot)
    if wrench is None and friction is False and plain(robot, q, v, tau):
        a: Array = pin.aba(robot.model, scratch(robot), q, v, tau)
        if isfinite(sum(a.tolist())):
            return a
    q, v, tau = joint_vectors(robot, q=q, v=v, tau=tau)
    tau = _with_loads(robot, tau, -1.0, q, v, wrench, friction, _roads)
    a = _forward(robot, q, v, tau) if q.ndim == 1 else _roads.forward(robot, pin.aba, q, v, tau)
    return finite_answer(robot, a, "forward_dynamics")


def _with_loads(
    robot: Robot,
    tau: Array,
    sign: float,
    q: Array,
    v: Array,
    wrench: ArrayLike | None,
    friction: bool,
    roads: Roads,
) -> Array:
    """tau with the torques of a wrench at the tool and of the joints' friction, times a sign."""
    if wrench is not None:
        tau = tau + sign * roads.statics(robot, q, wrench)
    if truth(friction, "friction"):
        tau = tau + sign * friction_torques(robot, v)
    return tau


def kinetic_energy(robot: ArmLike, q: ArrayLike, v: ArrayLike) -> Array | float:
    """T = ½ qdot^T M qdot, armatures included (note 002).

    Args:
        robot: the robot.
        q, v: joint positions and velocities, (n,) or (N, n).

    Returns:
        Joule: a float, or (N,).

    Raises:
        StateError, InertiaError: as :func:`mass_matrix`.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    require_inertia(robot)
    q, v = joint_vectors(robot, q=q, v=v)
    # pin.computeKineticEnergy leaves out the armature of a joint whose axis is not x, y or z
    return moving(robot, mass_matrix(robot, q), v)


def moving(robot: Robot, inertia: Array, v: Array) -> Array | float:
    """½ v^T M v of (n, n) and (n,), or of stacks of them.

    Raises:
        StateError: the answer overflows.
    """
    if v.ndim == 1:
        return float(finite_answer(robot, np.float64(0.5 * v @ inertia @ v), "kinetic_energy"))
    energy: Array = 0.5 * np.einsum("ij,ijk,ik->i", v, inertia, v)
    return finite_answer(robot, energy, "kinetic_energy")


def potential_energy(robot: ArmLike, q: ArrayLike) -> Array | float:
    """V = -Σ m g^T p_C, zero at the base origin (note 000, 000.lag).

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n).

    Returns:
        Joule: a float, or (N,).

    Raises:
        StateError, InertiaError: as :func:`mass_matrix`.
    """
    if type(robot) is not Robot:
        robot = as_robot(robot)
    require_inertia(robot)
    return each_state(robot, _potential, joint_vector(robot, q, "q"))


# Pinocchio's bindings return these by value, so nothing here needs copying out of the scratch data.


def _mass_matrix(robot: Robot, q: Array) -> Array:
    full: Array = pin.crba(robot.model, scratch(robot), q)  # both triangles, from Python
    return full


def _coriolis(robot: Robot, q: Array, v: Array) -> Array:
    matrix: Array = pin.computeCoriolisMatrix(robot.model, scratch(robot), q, v)
    return matrix


def _inverse(robot: Robot, q: Array, v: Array, a: Array) -> Array:
    tau: Array = pin.rnea(robot.model, scratch(robot), q, v, a)
    return tau


def _forward(robot: Robot, q: Array, v: Array, tau: Array) -> Array:
    a: Array = pin.aba(robot.model, scratch(robot), q, v, tau)
    return a


def gravity(robot: Robot, q: Array) -> Array:
    """:func:`gravity_torques` of one state that has been checked."""
    torques: Array = pin.computeGeneralizedGravity(robot.model, scratch(robot), q)
    return torques


def _potential(robot: Robot, q: Array) -> float:
    return float(pin.computePotentialEnergy(robot.model, scratch(robot), q))
