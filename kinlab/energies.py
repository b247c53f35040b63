"""Lagrange's equation by differentiation of the energies, exactly (notes 000, 001 and 002).

L = T - V with T = ½ qdot^T M qdot and V as ``kl.potential_energy``. M comes from the composite
bodies, dM/dq from analytic derivatives; no Newton-Euler recursion and no finite difference.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.dynamics import gravity_torques, kinetic_energy, mass_matrix, potential_energy
from kinlab.errors import StateError
from kinlab.mass_derivatives import mass_matrix_derivatives, mass_matrix_dot
from kinlab.robot import Robot
from kinlab.states import joint_vectors


def lagrangian(robot: Robot, q: ArrayLike, v: ArrayLike) -> Array | float:
    """L = T - V.

    Args:
        robot: the robot.
        q, v: joint positions and velocities, (n,) or (N, n).

    Returns:
        Joule: a float, or (N,).

    Raises:
        StateError: an argument of the wrong shape or type, or not finite.
        InertiaError: a joint moves no inertia.
    """
    q, v = joint_vectors(robot, q=q, v=v)
    return kinetic_energy(robot, q, v) - potential_energy(robot, q)


def momentum(robot: Robot, q: ArrayLike, v: ArrayLike) -> Array:
    """dL/dqdot = M qdot, the generalized momentum.

    Args, Raises: as :func:`lagrangian`.

    Returns:
        (n,) or (N, n), kg m²/s (kg m/s for prismatic joints).
    """
    q, v = joint_vectors(robot, q=q, v=v)
    return _times(mass_matrix(robot, q), v)


def momentum_rate(robot: Robot, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
    """d/dt dL/dqdot = Mdot qdot + M qddot (002.Mdot).

    Args:
        robot: the robot.
        q, v, a: joint positions, velocities and accelerations, (n,) or (N, n).

    Returns:
        (n,) or (N, n), N m.

    Raises:
        StateError, InertiaError: as :func:`lagrangian`.
    """
    q, v, a = joint_vectors(robot, q=q, v=v, a=a)
    return _times(mass_matrix_dot(robot, q, v), v) + _times(mass_matrix(robot, q), a)


def lagrangian_gradient(robot: Robot, q: ArrayLike, v: ArrayLike) -> Array:
    """dL/dq = ½ qdot^T dM/dq qdot - g (002.Mdot).

    Args, Raises: as :func:`lagrangian`.

    Returns:
        (n,) or (N, n), N m.
    """
    q, v = joint_vectors(robot, q=q, v=v)
    slope = mass_matrix_derivatives(robot, q)
    half: Array = 0.5 * np.einsum("...i,...ijk,...j->...k", v, slope, v)
    return half - gravity_torques(robot, q)


def lagrange_torques(robot: Robot, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
    """tau = d/dt dL/dqdot - dL/dq (002.el).

    Args, Returns, Raises: as :func:`momentum_rate`.
    """
    return momentum_rate(robot, q, v, a) - lagrangian_gradient(robot, q, v)


def action(robot: Robot, q: ArrayLike, v: ArrayLike, weights: ArrayLike) -> float:
    """S = ∫ L dt of a motion given at the nodes of a quadrature rule (002.action).

    Args:
        robot: the robot.
        q, v: joint positions and velocities at the nodes, (N, n).
        weights: the rule's weights, (N,), s; their sum is the duration.

    Returns:
        The action, J s.

    Raises:
        StateError: an argument of the wrong shape or type, or not finite.
        InertiaError: as :func:`lagrangian`.
    """
    share = real_array(weights, "weights")
    values = np.asarray(lagrangian(robot, q, v))
    if share.ndim != 1 or values.shape != share.shape:
        raise StateError(
            f"robot {robot.name!r}: weights has shape {share.shape}; expected one for each of "
            f"the states (N, {robot.n})"
        )
    return float(share @ values)


def _times(matrix: Array, vector: Array) -> Array:
    product: Array = np.einsum("...ij,...j->...i", matrix, vector)
    return product
