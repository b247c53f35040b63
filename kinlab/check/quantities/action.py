"""Engine quantities about the action S = ∫ L dt and its first variation (note 002).

Paths are q(t) = q + v t + ½ a t² over :data:`DURATION`, varied by dq times a shape in time.
Integrals are Gauss-Legendre sums; the integrands are analytic, and with :data:`NODES` nodes the
sums are exact to rounding. The energies are differentiated exactly (:mod:`kinlab.engine.lagrange`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.check.quantities.serial import SERIAL
from kinlab.engine import dynamics, lagrange
from kinlab.model.robot import Robot

DURATION = 0.4
NODES = 24
_FALL = 0.1
_STEPS = 4


def _rule(duration: float) -> tuple[Array, Array]:
    """Nodes and weights on [0, duration]."""
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    return 0.5 * duration * (nodes + 1.0), 0.5 * duration * weights


def variation_between_fixed_ends(robot: Robot, q: Any, v: Any, a: Any, dq: Any) -> Array:
    """dS/d(eps) along dq sin²(pi t / T): both ends stay."""
    t, _ = _rule(DURATION)
    phase = np.pi / DURATION
    return _variation(robot, q, v, a, dq, np.sin(phase * t) ** 2, phase * np.sin(2.0 * phase * t))


def variation_with_free_ends(robot: Robot, q: Any, v: Any, a: Any, dq: Any) -> Array:
    """dS/d(eps) along dq (1 + 2 t/T): both ends move, by different amounts."""
    t, _ = _rule(DURATION)
    return _variation(robot, q, v, a, dq, 1.0 + 2.0 * t / DURATION, np.full_like(t, 2.0 / DURATION))


def _variation(robot: Robot, q: Any, v: Any, a: Any, dq: Any, shape: Array, rate: Array) -> Array:
    t, weights = _rule(DURATION)
    total = np.zeros(len(q))
    for time, weight, share, speed in zip(t, weights, shape, rate, strict=True):
        here, moving = q + v * time + 0.5 * a * time**2, v + a * time
        slope = lagrange.lagrangian_gradient(robot, here, moving)
        momentum = lagrange.momentum(robot, here, moving)
        total += weight * np.sum((slope * share + momentum * speed) * dq, axis=1)
    return total


def variation_of_true_motion(robot: Robot, q: Any, v: Any, dq: Any) -> Array:
    """dS/d(eps) of a simulated free motion, over the sum of its parts' sizes: 0 to rounding.

    The motion starts at (q, v) without torques and lasts 0.1 s, by Runge-Kutta steps below 1 ms,
    extrapolated; the ends stay. A path that is no motion gives a number of order 1.
    """
    t, weights = _rule(_FALL)
    phase = np.pi / _FALL
    total, size, time = np.zeros(len(q)), np.zeros(len(q)), 0.0
    here, moving = q, v
    for node, weight in zip(t, weights, strict=True):
        here, moving = _extrapolated(robot, here, moving, node - time)
        time = node
        slope = lagrange.lagrangian_gradient(robot, here, moving) * np.sin(phase * node) ** 2
        momentum = lagrange.momentum(robot, here, moving) * phase * np.sin(2.0 * phase * node)
        total += weight * np.sum((slope + momentum) * dq, axis=1)
        size += weight * np.sum((np.abs(slope) + np.abs(momentum)) * np.abs(dq), axis=1)
    return total / size


def _extrapolated(robot: Robot, q: Array, v: Array, duration: float) -> tuple[Array, Array]:
    """Free motion: Runge-Kutta at one and at half the step, the leading error taken out."""
    coarse, fine = (np.stack(_move_freely(robot, q, v, duration, k * _STEPS)) for k in (1, 2))
    better = fine + (fine - coarse) / 15.0
    return better[0], better[1]


def _move_freely(
    robot: Robot, q: Array, v: Array, duration: float, steps: int
) -> tuple[Array, Array]:
    """Free motion by Runge-Kutta of order 4."""
    h = duration / steps
    still = np.zeros(robot.n)

    def pull(q: Array, v: Array) -> Array:
        return dynamics.forward_dynamics(robot, q, v, still)

    for _ in range(steps):
        a1 = pull(q, v)
        v2 = v + 0.5 * h * a1
        a2 = pull(q + 0.5 * h * v, v2)
        v3 = v + 0.5 * h * a2
        a3 = pull(q + 0.5 * h * v2, v3)
        v4 = v + h * a3
        a4 = pull(q + h * v3, v4)
        q = q + h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4)
        v = v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
    return q, v


def excess_action_sign(robot: Robot, duration: Any) -> Array:
    """Sign of S(varied) - S(true) for an arm that hangs still, varied by 0.02 sin(pi t / T)."""
    still = _hanging(robot)
    signs = []
    for span in duration[:, 0]:
        t, weights = _rule(float(span))
        phase = np.pi / span
        here = still + 0.02 * np.sin(phase * t)[:, None]
        moving = 0.02 * phase * np.cos(phase * t)[:, None]
        varied = lagrange.action(robot, here, moving, weights)
        rest = np.broadcast_to(still, here.shape)
        signs.append(np.sign(varied - lagrange.action(robot, rest, np.zeros_like(rest), weights)))
    return np.array(signs)


def _hanging(robot: Robot) -> Any:
    """The pose of a one-joint arm in which it hangs still: of the two that balance, the lower."""
    angles = np.linspace(-np.pi, np.pi, 721)[:, None]
    energy = np.asarray(dynamics.potential_energy(robot, angles))
    return angles[int(np.argmin(energy))]


def _around_half_a_swing(
    robot: Robot, arguments: Any, count: int, rng: np.random.Generator
) -> tuple[Array, ...]:
    """Durations on both sides of half the period of small swings, which divides the signs."""
    del arguments
    still, step = _hanging(robot), 1e-4
    rise = dynamics.gravity_torques(robot, still + step) - dynamics.gravity_torques(
        robot, still - step
    )
    stiffness = float(rise[0]) / (2.0 * step)
    half = np.pi * np.sqrt(float(dynamics.mass_matrix(robot, still)[0, 0]) / stiffness)
    short, long = rng.uniform(0.3, 0.9, count), rng.uniform(1.1, 1.8, count)
    return (half * np.where(np.arange(count) % 2, short, long)[:, None],)


QUANTITIES = (
    SERIAL.quantity(
        "action_variation",
        "q v a dq",
        variation_between_fixed_ends,
        "dS/d(eps) of q + v t + ½ a t² under dq sin²(pi t/T), T = 0.4 s, J s, a number",
    ),
    SERIAL.quantity(
        "action_variation_free_ends",
        "q v a dq",
        variation_with_free_ends,
        "the same under dq (1 + 2 t/T), J s, a number",
    ),
    SERIAL.quantity(
        "action_variation_of_motion",
        "q v dq",
        variation_of_true_motion,
        "dS/d(eps) of a simulated free motion, relative to its parts, a number",
        scale=1.0,
    ),
    SERIAL.quantity(
        "excess_action_sign",
        "duration",
        excess_action_sign,
        "sign of S(varied) - S(true) of a hanging one-joint arm, +1 or -1",
        sample=_around_half_a_swing,
        joints=1,
    ),
)
