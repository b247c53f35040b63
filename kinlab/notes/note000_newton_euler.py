"""Note 000, dynamics 1 and 2: Newton-Euler outward and inward, the MVG form.

Gravity is not in the note's formulas: it enters as an acceleration of the base, v_dot_0 = -g.
The rotors' inertia (armature) adds armature * qddot to each joint's torque.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinlab.formula import Printed, formula
from kinlab.notes.arm import Arm, Array, Z, apply, cross, turn
from kinlab.notes.frames import craig, link_transforms
from kinlab.notes.note000_statics import tip_wrench


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
        down, p = turn(steps[..., i, :3, :3]), steps[..., i, :3, 3]
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


@formula(
    "000.ne.out",
    source="note 000, dynamics 1",
    quantity="link_accelerations",
    robots="serial",
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


@formula(
    "000.ne.com",
    source="note 000, dynamics 1",
    quantity="com_accelerations",
    robots="serial",
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
    spin = apply(arm.inertia, motion.omega)
    return force, apply(arm.inertia, motion.omega_dot) + cross(motion.omega, spin)


@formula(
    "000.ne.FN",
    source="note 000, dynamics 1",
    quantity="inertial_wrenches",
    robots="serial",
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
            rotation, place = steps[..., i + 1, :3, :3], steps[..., i + 1, :3, 3]
            force = apply(rotation, force)
            moment = apply(rotation, moment) + cross(place, force)
        moment = moment + moments[..., i, :] + cross(last.com[i], forces[..., i, :])
        force = force + forces[..., i, :]
        result.append(np.concatenate([force, moment], axis=-1))
    return np.stack(result[::-1], axis=-2)


@formula(
    "000.ne.in",
    source="note 000, dynamics 1",
    quantity="joint_wrenches",
    robots="serial",
    latex=r"f_i = {}^i_{i+1}R f_{i+1} + F_i,\quad n_i = {}^i_{i+1}R n_{i+1}"
    r" + P_{i+1} \times {}^i_{i+1}R f_{i+1} + N_i + P_{C_i} \times F_i",
    remark="an index of R is lost in f_i; gravity enters as v_dot_0 = -g, which is not said",
)
def joint_wrenches(arm: Arm, q: Array, v: Array, a: Array, wrench: Array) -> Array:
    """Inward recursion of forces and moments, passive components included."""
    return inward(arm, q, v, a, wrench, arm.gravity)


def torques(arm: Arm, q: Array, v: Array, a: Array, wrench: Array | None, gravity: Array) -> Array:
    """tau_i = n_i·Z or f_i·Z, and the rotor's share, (..., n), under a gravity (3,)."""
    wrenches = inward(arm, q, v, a, wrench, gravity)
    share = np.where(arm.prismatic, wrenches[..., 2], wrenches[..., 5])
    return arm.sign * share + arm.armature * a


@formula(
    "000.ne.in",
    part="tau",
    source="note 000, dynamics 1",
    quantity="inverse_dynamics_loaded",
    robots="serial",
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
