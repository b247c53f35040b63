"""Note 000, statics and dynamics: forces along the chain, Newton-Euler, MVG, Lagrange."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.host.answers import once
from kinlab.notes import arm as mass
from kinlab.notes.arm import (
    Arm,
    Array,
    Z,
    apply,
    craig,
    cross,
    geometric_jacobian,
    link_transforms,
    tool_pose,
    transpose,
)
from kinlab.notes.note000_kinematics import tool_jacobian, turn_rows

# -------- Note 000, statics: force and moment propagation, joint torques, tau = J^T F
# Throughout (f, n) is the wrench that the tool exerts on the environment.


def tip_wrench(arm: Arm, q: Array, wrench: Array) -> tuple[Array, Array]:
    """(f, n) of frame n: the tool's wrench turned into its axes and moved to its origin."""
    last = craig(arm)
    up = last.tool[:3, :3] @ transpose(tool_pose(arm, q)[..., :3, :3])
    force = apply(up, wrench[..., :3])
    return force, apply(up, wrench[..., 3:]) + cross(last.tool[:3, 3], force)


_statics = partial(formula, source="note 000, statics", robots="serial")


@_statics(
    "000.force",
    quantity="static_wrenches",
    latex=r"{}^if_i = {}^i_{i+1}R\,{}^{i+1}f_{i+1},\quad"
    r" {}^in_i = {}^i_{i+1}R\,{}^{i+1}n_{i+1} + {}^iP_{i+1} \times {}^if_i",
)
def static_wrenches(arm: Arm, q: Array, wrench: Array) -> Array:
    """Forces and moments from the tool to the base, passive components included."""
    steps = link_transforms(craig(arm), q)
    force, moment = tip_wrench(arm, q, wrench)
    result = [np.concatenate([force, moment], axis=-1)]
    for i in reversed(range(arm.n - 1)):
        rotation, position = steps[..., i + 1, :3, :3], steps[..., i + 1, :3, 3]
        force = apply(rotation, force)
        moment = apply(rotation, moment) + cross(position, force)
        result.append(np.concatenate([force, moment], axis=-1))
    return np.stack(result[::-1], axis=-2)


@_statics(
    "000.tau",
    quantity="statics",
    latex=r"\tau_i = {}^in_i \cdot \hat Z \ \text{(revolute)},\quad"
    r" \tau_i = {}^if_i \cdot \hat Z \ \text{(prismatic)}",
)
def joint_torques(arm: Arm, q: Array, wrench: Array) -> Array:
    """Joint torques are the z components of moment or force."""
    wrenches = static_wrenches(arm, q, wrench)
    return arm.sign * np.where(arm.prismatic, wrenches[..., 2], wrenches[..., 5])


@_statics("000.JTF", part="tool", quantity="statics_tool", latex=r"\tau = {}^nJ^T\,{}^nF")
def tool_statics(arm: Arm, q: Array, wrench: Array) -> Array:
    """tau = J^T F with both in tool axes."""
    return apply(transpose(tool_jacobian(arm, q)), wrench)


def _base_jacobian(arm: Arm, q: Array) -> Array:
    return geometric_jacobian(arm, q, tool_pose(arm, q)[..., :3, 3])


def _force_only(arm: Arm, q: Array, wrench: Array) -> Array:
    force = apply(tool_pose(arm, q)[..., :3, :3], wrench[..., :3])
    turned = np.concatenate([force, wrench[..., 3:]], axis=-1)
    return apply(transpose(_base_jacobian(arm, q)), turned)


@_statics(
    "000.JTF",
    part="base",
    source="note 000, statics 2",
    quantity="statics_tool",
    latex=r"\tau = {}^0J^T\,{}^0F,\quad {}^0F ="
    r" \fixed{\begin{pmatrix} {}^0_nR & 0 \\ 0 & {}^0_nR \end{pmatrix}} {}^nF",
    printed=Printed(
        _force_only,
        "a 3x3 R cannot turn the 6-vector F: it is blkdiag(R, R) (shown: R on the force alone)",
        r"\tau = {}^0J^T\,{}^0F,\quad {}^0F = \wrong{{}^0_nR}\,{}^nF",
        robots=("spatial",),
    ),
    remark="the columns of ^0_nR are (X_n Y_n Z_n); the note writes (X_4 Y_4 Z_4) beside ^0_nR",
)
def base_statics(arm: Arm, q: Array, wrench: Array) -> Array:
    """tau = J^T F in base axes, the wrench given in tool axes."""
    rotation = tool_pose(arm, q)[..., :3, :3]
    turned = turn_rows(rotation, wrench[..., None])[..., 0]
    return apply(transpose(_base_jacobian(arm, q)), turned)


# -------- Note 000, dynamics 1 and 2: Newton-Euler outward and inward, the MVG form
# Gravity is not in the note's formulas: it enters as an acceleration of the base, v_dot_0 = -g.
# The rotors' inertia (armature) adds armature * qddot to each joint's torque.


class Motion(NamedTuple):
    """Velocity and acceleration of every link in its own axes, each (..., n, 3)."""

    omega: Array
    omega_dot: Array
    v_dot: Array


def turn_then_cross(down: Array, omega: Array, rate: Array) -> Array:
    """(R omega_i) x (theta_dot Z), in frame i+1."""
    return cross(apply(down, omega), rate)


def _cross_then_turn(down: Array, omega: Array, rate: Array) -> Array:
    return apply(down, cross(omega, rate))


def outward(
    arm: Arm,
    q: Array,
    v: Array,
    a: Array,
    lift: Array | float = 0.0,
    swing: Callable[..., Array] = turn_then_cross,
) -> Motion:
    """Velocities and accelerations from the base to the tool.

    Args:
        arm: the arm, in Craig's convention.
        q, v, a: (..., n).
        lift: acceleration of the base in its own axes, -g where gravity acts, (3,).
        swing: the omega_dot term that the turning of frame i gives, from R, omega_i and rate.
    """
    steps = link_transforms(arm, q)
    rates, pulls = (arm.sign * v)[..., None] * Z, (arm.sign * a)[..., None] * Z
    still = np.zeros((*np.shape(q)[:-1], 3))
    omega, omega_dot, v_dot = still, still, still + lift
    result = []
    for i in range(arm.n):
        down, p = transpose(steps[..., i, :3, :3]), steps[..., i, :3, 3]
        rate, pull = rates[..., i, :], pulls[..., i, :]
        v_dot = apply(down, v_dot + cross(omega_dot, p) + cross(omega, cross(omega, p)))
        turned, omega_dot = apply(down, omega), apply(down, omega_dot)
        if arm.prismatic[i]:
            v_dot = v_dot + 2.0 * cross(turned, rate) + pull
            omega = turned
        else:
            omega_dot = omega_dot + pull + swing(down, omega, rate)
            omega = turned + rate
        result.append((omega, omega_dot, v_dot))
    return Motion(*(np.stack(parts, axis=-2) for parts in zip(*result, strict=True)))


def _outward_printed(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    motion = outward(craig(arm), q, v, a, swing=_cross_then_turn)
    return np.concatenate([motion.v_dot, motion.omega_dot], axis=-1)


_OMEGA_DOT = (
    r"{}^{i+1}\dot\omega_{i+1} = {}^{i+1}_iR\,{}^i\dot\omega_i"
    r" + \ddot\theta_{i+1}\,{}^{i+1}\hat Z_{i+1} + "
)


_newton_euler = partial(formula, source="note 000, dynamics 1", robots="serial")


@_newton_euler(
    "000.ne.out",
    quantity="link_accelerations",
    latex=_OMEGA_DOT + r"\fixed{({}^{i+1}_iR\,{}^i\omega_i) \times \dot\theta_{i+1}"
    r"\,{}^{i+1}\hat Z_{i+1}}",
    printed=Printed(
        _outward_printed,
        "the cross term is (R omega_i) x (theta_dot Z): omega must be turned into frame i+1 "
        "before the product (read literally: cross in frame i, then turn)",
        _OMEGA_DOT + r"\wrong{{}^{i+1}_iR\,[{}^i\omega_i \times \dot\theta_{i+1}]"
        r" \cdot {}^{i+1}\hat Z_{i+1}}",
        robots=("spatial",),
    ),
)
def accelerations(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Outward recursion of the accelerations, revolute and prismatic."""
    motion = outward(craig(arm), q, v, a)
    return np.concatenate([motion.v_dot, motion.omega_dot], axis=-1)


def centre_accelerations(arm: Arm, motion: Motion) -> Array:
    """v_dot_C of every link in its own axes, (..., n, 3)."""
    swing = cross(motion.omega, cross(motion.omega, arm.com))
    return motion.v_dot + cross(motion.omega_dot, arm.com) + swing


@_newton_euler(
    "000.ne.com",
    quantity="com_accelerations",
    latex=r"{}^i\dot v_{C_i} = {}^i\dot v_i + {}^i\dot\omega_i \times {}^ip_{C_i}"
    r" + {}^i\omega_i \times ({}^i\omega_i \times {}^ip_{C_i})",
    remark="the heading says velocity; it is the acceleration",
)
def com_accelerations(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Acceleration of the centres of mass."""
    arm = craig(arm)
    return centre_accelerations(arm, outward(arm, q, v, a))


def inertial(arm: Arm, motion: Motion) -> tuple[Array, Array]:
    """F and N of every link, each (..., n, 3)."""
    force = arm.mass[:, None] * centre_accelerations(arm, motion)
    momentum = apply(arm.inertia, motion.omega)
    return force, apply(arm.inertia, motion.omega_dot) + cross(motion.omega, momentum)


@_newton_euler(
    "000.ne.FN",
    quantity="inertial_wrenches",
    latex=r"F_i = m_i \dot v_{C_i},\quad N_i = {}^{C_i}I_i\,\dot\omega_i"
    r" + \omega_i \times {}^{C_i}I_i\,\omega_i",
    remark="the second term is Euler's gyroscopic term, not the parallel-axis theorem; the "
    "note's N = I alpha holds with I about a fixed axis only",
)
def inertial_wrenches(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Force and moment that move each link, about its centre of mass."""
    arm = craig(arm)
    return np.concatenate(inertial(arm, outward(arm, q, v, a)), axis=-1)


def inward(arm: Arm, q: Array, v: Array, a: Array, wrench: Array | None, gravity: Array) -> Array:
    """Wrenches (f_i, n_i) from the tool to the base, (..., n, 6), under a gravity (3,)."""
    last = craig(arm)
    lift = -(arm.base[:3, :3].T @ gravity)
    steps = link_transforms(last, q)
    forces, moments = inertial(last, outward(last, q, v, a, lift))
    load = np.zeros((*np.shape(q)[:-1], 6)) if wrench is None else wrench
    force, moment = tip_wrench(arm, q, load)
    result = []
    for i in reversed(range(arm.n)):
        if i < arm.n - 1:
            rotation, position = steps[..., i + 1, :3, :3], steps[..., i + 1, :3, 3]
            force = apply(rotation, force)
            moment = apply(rotation, moment) + cross(position, force)
        moment = moment + moments[..., i, :] + cross(last.com[i], forces[..., i, :])
        force = force + forces[..., i, :]
        result.append(np.concatenate([force, moment], axis=-1))
    return np.stack(result[::-1], axis=-2)


@_newton_euler(
    "000.ne.in",
    quantity="joint_wrenches",
    latex=r"f_i = {}^i_{i+1}R f_{i+1} + F_i,\quad n_i = {}^i_{i+1}R n_{i+1}"
    r" + P_{i+1} \times {}^i_{i+1}R f_{i+1} + N_i + P_{C_i} \times F_i",
    remark="an index of R is lost in f_i; gravity enters as v_dot_0 = -g, which is not said",
)
def joint_wrenches(arm: Arm, q: Array, v: Array, a: Array, wrench: Array) -> Array:
    """Inward recursion of forces and moments, passive components included."""
    return inward(arm, q, v, a, wrench, arm.gravity)


def torques(arm: Arm, q: Array, v: Array, a: Array, wrench: Array | None, gravity: Array) -> Array:
    """tau_i = n_i·Z or f_i·Z, and the rotor's share, (..., n), under a gravity (3,)."""
    tau: Array = once(_torques, arm, q, v, a, wrench, gravity)
    return tau


def _torques(arm: Arm, q: Array, v: Array, a: Array, wrench: Array | None, gravity: Array) -> Array:
    wrenches = inward(arm, q, v, a, wrench, gravity)
    share = np.where(arm.prismatic, wrenches[..., 2], wrenches[..., 5])
    return arm.sign * share + arm.armature * a


@_newton_euler(
    "000.ne.in",
    part="tau",
    quantity="inverse_dynamics_loaded",
    latex=r"\tau_i = n_i \cdot \hat Z \ \text{or}\ f_i \cdot \hat Z,\quad"
    r" \fixed{\dot v_0 = -g}",
    printed=Printed(
        lambda arm, q, v, a, wrench: torques(arm, q, v, a, wrench, np.zeros(3)),
        "gravity is nowhere in the recursion: without v_dot_0 = -g the arm weighs nothing",
        r"\tau_i = n_i \cdot \hat Z \ \text{or}\ f_i \cdot \hat Z,\quad"
        r" \wrong{\dot v_0 = 0}",
    ),
)
def newton_euler_torques(arm: Arm, q: Array, v: Array, a: Array, wrench: Array) -> Array:
    """Joint torques by Newton-Euler, gravity as the base's acceleration -g."""
    return torques(arm, q, v, a, wrench, arm.gravity)


# -------- Note 000, dynamics 2 and 3: the MVG form and the energies of the links


def _motion_torques(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Newton-Euler without gravity, v and a the same at every state."""
    shape = np.shape(q)
    return torques(arm, q, np.broadcast_to(v, shape), np.broadcast_to(a, shape), None, np.zeros(3))


_mvg = partial(formula, "000.MVG", source="note 000, dynamics 2", robots="serial")


@_mvg(part="M", quantity="mass_matrix", latex=r"M e_j = \tau(q, 0, e_j) - G")
def mvg_mass(arm: Arm, q: Array) -> Array:
    """M read off Newton-Euler at unit accelerations."""
    still = np.zeros(arm.n)
    return np.stack([_motion_torques(arm, q, still, e) for e in np.eye(arm.n)], axis=-1)


@_mvg(
    part="B",
    quantity="coriolis_coefficients",
    robots=("planar2r", "planar3r", "spatial3r", "scara", "stanford", "puma560", "panda", "ur5"),
    latex=r"V = \underbrace{B(\theta)}_{n \times \binom n2} [\dot\theta_i \dot\theta_j]_{i<j}"
    r" + C(\theta)[\dot\theta^2]",
)
def mvg_products(arm: Arm, q: Array) -> Array:
    """B read off Newton-Euler at pairs of unit velocities."""
    units, still = np.eye(arm.n), np.zeros(arm.n)
    squares = mvg_squares(arm, q)
    pairs = zip(*np.triu_indices(arm.n, 1), strict=True)
    return np.stack(
        [
            _motion_torques(arm, q, units[j] + units[k], still) - squares[..., j] - squares[..., k]
            for j, k in pairs
        ],
        axis=-1,
    )


@_mvg(
    part="C",
    quantity="centrifugal_coefficients",
    latex=r"V = B(\theta)[\dot\theta_i \dot\theta_j] + C(\theta)[\dot\theta^2]",
)
def mvg_squares(arm: Arm, q: Array) -> Array:
    """C read off Newton-Euler at unit velocities."""
    still = np.zeros(arm.n)
    return np.stack([_motion_torques(arm, q, e, still) for e in np.eye(arm.n)], axis=-1)


@_mvg(part="G", quantity="gravity_torques", latex=r"G = \tau(q, 0, 0)")
def mvg_gravity(arm: Arm, q: Array) -> Array:
    """G is the torque at rest."""
    still = np.zeros(np.shape(q))
    return torques(arm, q, still, still, None, arm.gravity)


@_mvg(
    part="tau",
    quantity="inverse_dynamics",
    latex=r"\tau = M \ddot\theta + B[\dot\theta_i\dot\theta_j] + C[\dot\theta^2] + G",
)
def mvg_torques(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """The four terms together, M, B and C from the link Jacobians."""
    symbols = mass.christoffel(arm, q)
    j, k = np.triu_indices(arm.n, 1)
    products: Array = np.einsum("...ip,...p->...i", 2.0 * symbols[..., j, k], v[..., j] * v[..., k])
    squares: Array = np.einsum("...ijj,...j->...i", symbols, v * v)
    inertia = apply(mass.mass_matrix(arm, q), a)
    return inertia + products + squares + mass.gravity_torques(arm, q)


_lagrange = partial(formula, "000.lag", source="note 000, dynamics 3", robots="serial")


@_lagrange(
    part="k",
    quantity="link_kinetic_energies",
    latex=r"k_i = \tfrac12 m_i \lVert \vec v_{C_i} \rVert^2 + \tfrac12 \omega_i^T I_i\,\omega_i",
)
def kinetic_energies(arm: Arm, q: Array, v: Array) -> Any:
    """Kinetic energy of every link, v_C = d/dt P_C in the base."""
    body = mass.links(arm, q)
    linear = np.einsum("...ljc,...j->...lc", body.linear, v)
    omega = np.einsum("...ljc,...j->...lc", body.angular, v)
    turning = np.einsum("...la,...lab,...lb->...l", omega, body.inertias, omega)
    return 0.5 * arm.mass * np.sum(linear * linear, axis=-1) + 0.5 * turning


def _u_printed(arm: Arm, q: Array) -> Any:
    up = -arm.gravity / np.linalg.norm(arm.gravity)
    height = mass.centres(arm, q) @ up
    return -arm.mass * np.linalg.norm(arm.gravity) * height


@_lagrange(
    part="u",
    quantity="link_potential_energies",
    latex=r"u_i = \fixed{+m_i g h_i} = -m_i\, \vec g^T \vec P_{C_i}",
    printed=Printed(
        _u_printed,
        "u = -mgh has the wrong sign: with the vector g pointing down, -m g^T P is +mgh",
        r"u_i = \wrong{-m_i g h_i} = -m_i\, \vec g^T \vec P_{C_i}",
    ),
)
def potential_energies(arm: Arm, q: Array) -> Any:
    """Potential energy of every link."""
    return -arm.mass * (mass.centres(arm, q) @ arm.gravity)


@_lagrange(
    part="tau",
    quantity="inverse_dynamics",
    latex=r"\tau_i = \frac{d}{dt}\frac{\partial k}{\partial \dot\theta_i}"
    r" - \frac{\partial k}{\partial \theta_i} + \frac{\partial u}{\partial \theta_i}",
)
def lagrange_torques(arm: Arm, q: Array, v: Array, a: Array) -> Array:
    """Joint torques by differentiation of the energies, exactly."""
    derivative = mass.mass_derivatives(arm, q)
    turning: Array = np.einsum("...ijk,...k,...j->...i", derivative, v, v)
    rate = turning + apply(mass.mass_matrix(arm, q), a)
    gradient: Array = 0.5 * np.einsum("...ijk,...i,...j->...k", derivative, v, v)
    return rate - gradient + mass.gravity_torques(arm, q)
