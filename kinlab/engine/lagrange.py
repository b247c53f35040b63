"""What Lagrange's equation is made of: exact derivatives of M, the energies and the action."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from kinlab.arrays import Array, real_array
from kinlab.engine.dynamics import gravity_torques, kinetic_energy, mass_matrix, potential_energy
from kinlab.engine.kinematics import each_state
from kinlab.engine.states import joint_vector, joint_vectors
from kinlab.errors import StateError
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.robot import Robot, require_inertia, scratch

# -------- How the mass matrix changes with q, exactly, by Pinocchio: D_ijk, dM/dq, the B
#          and C split
# Nothing here is a finite difference. Pinocchio's Coriolis matrix is linear in the velocity, so its
# values at the unit velocities are the Christoffel symbols. dM/dq comes by another way, from the
# analytic derivatives of the inverse dynamics.


def christoffel(robot: ArmLike, q: ArrayLike) -> Array:
    """D_ijk = ½ (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i): tau_i = Σ_jk D_ijk qdot_j qdot_k.

    Note 001, 001.D: D_ijj is the centripetal coefficient of joint j on joint i, D_ijk the
    Coriolis coefficient; D_ij is ``kl.mass_matrix`` and D_i is ``kl.gravity_torques``.

    Args:
        robot: the robot.
        q: joint positions, (n,) or (N, n).

    Returns:
        (n, n, n) or (N, n, n, n), symmetric in the last two indices.

    Raises:
        StateError: q of the wrong shape or type, or not finite.
        InertiaError: a joint moves no inertia.
    """
    robot = as_robot(robot)
    require_inertia(robot)
    return each_state(robot, _christoffel, joint_vector(robot, q, "q"))


def mass_matrix_derivatives(robot: ArmLike, q: ArrayLike) -> Array:
    """dM_ij/dq_k, exactly (note 002, 002.Mdot).

    Args, Raises: as :func:`christoffel`.

    Returns:
        (n, n, n) or (N, n, n, n), indices i, j, k.
    """
    robot = as_robot(robot)
    require_inertia(robot)
    return each_state(robot, _derivatives, joint_vector(robot, q, "q"))


def mass_matrix_dot(robot: ArmLike, q: ArrayLike, v: ArrayLike) -> Array:
    """Mdot = Σ_k dM/dq_k qdot_k along the motion v = qdot (002.Mdot).

    Args:
        robot: the robot.
        q, v: joint positions and velocities, (n,) or (N, n).

    Returns:
        (n, n) or (N, n, n).

    Raises:
        StateError, InertiaError: as :func:`christoffel`.
    """
    robot = as_robot(robot)
    require_inertia(robot)
    q, v = joint_vectors(robot, q=q, v=v)
    rate: Array = np.einsum("...ijk,...k->...ij", mass_matrix_derivatives(robot, q), v)
    return rate


def coriolis_coefficients(robot: ArmLike, q: ArrayLike) -> Array:
    """B(q) of the MVG form: V = B [qdot_j qdot_k]_(j<k) + C [qdot²] (note 000, 000.MVG).

    Args, Raises: as :func:`christoffel`.

    Returns:
        (n, n(n-1)/2) or (N, n, n(n-1)/2); the columns are the pairs (1,2), (1,3), ... (n-1,n).
    """
    robot = as_robot(robot)
    symbols = christoffel(robot, q)
    j, k = np.triu_indices(robot.n, 1)
    products: Array = 2.0 * symbols[..., j, k]
    return products


def centrifugal_coefficients(robot: ArmLike, q: ArrayLike) -> Array:
    """C(q) of the MVG form: what multiplies [qdot_j²] (note 000, 000.MVG).

    Not the Coriolis matrix C(q, qdot) of ``kl.coriolis_matrix``.

    Args, Raises: as :func:`christoffel`.

    Returns:
        (n, n) or (N, n, n): entry (i, j) is D_ijj.
    """
    robot = as_robot(robot)
    squares: Array = np.einsum("...ijj->...ij", christoffel(robot, q))
    return squares.copy()


def _christoffel(robot: Robot, q: Array) -> Array:
    data = scratch(robot)
    return np.stack(
        [np.array(pin.computeCoriolisMatrix(robot.model, data, q, e)) for e in np.eye(robot.n)],
        axis=-1,
    )


def _derivatives(robot: Robot, q: Array) -> Array:
    data, still = scratch(robot), np.zeros(robot.n)

    def slope(a: Array) -> Array:
        return np.array(pin.computeRNEADerivatives(robot.model, data, q, still, a)[0])

    weight = slope(still)  # d(tau)/dq at rest; the rest of it is M a differentiated
    return np.stack([slope(e) - weight for e in np.eye(robot.n)], axis=1)


# -------- Lagrange's equation by differentiation of the energies, exactly (notes 000, 001
#          and 002)
# L = T - V with T = ½ qdot^T M qdot and V as ``kl.potential_energy``. M comes from the composite
# bodies, dM/dq from analytic derivatives; no Newton-Euler recursion and no finite difference.


def lagrangian(robot: ArmLike, q: ArrayLike, v: ArrayLike) -> Array | float:
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
    robot = as_robot(robot)
    q, v = joint_vectors(robot, q=q, v=v)
    return kinetic_energy(robot, q, v) - potential_energy(robot, q)


def momentum(robot: ArmLike, q: ArrayLike, v: ArrayLike) -> Array:
    """dL/dqdot = M qdot, the generalized momentum.

    Args, Raises: as :func:`lagrangian`.

    Returns:
        (n,) or (N, n), kg m²/s (kg m/s for prismatic joints).
    """
    robot = as_robot(robot)
    q, v = joint_vectors(robot, q=q, v=v)
    return _times(mass_matrix(robot, q), v)


def momentum_rate(robot: ArmLike, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
    """d/dt dL/dqdot = Mdot qdot + M qddot (002.Mdot).

    Args:
        robot: the robot.
        q, v, a: joint positions, velocities and accelerations, (n,) or (N, n).

    Returns:
        (n,) or (N, n), N m.

    Raises:
        StateError, InertiaError: as :func:`lagrangian`.
    """
    robot = as_robot(robot)
    q, v, a = joint_vectors(robot, q=q, v=v, a=a)
    return _times(mass_matrix_dot(robot, q, v), v) + _times(mass_matrix(robot, q), a)


def lagrangian_gradient(robot: ArmLike, q: ArrayLike, v: ArrayLike) -> Array:
    """dL/dq = ½ qdot^T dM/dq qdot - g (002.Mdot).

    Args, Raises: as :func:`lagrangian`.

    Returns:
        (n,) or (N, n), N m.
    """
    robot = as_robot(robot)
    q, v = joint_vectors(robot, q=q, v=v)
    slope = mass_matrix_derivatives(robot, q)
    half: Array = 0.5 * np.einsum("...i,...ijk,...j->...k", v, slope, v)
    return half - gravity_torques(robot, q)


def lagrange_torques(robot: ArmLike, q: ArrayLike, v: ArrayLike, a: ArrayLike) -> Array:
    """tau = d/dt dL/dqdot - dL/dq (002.el).

    Args, Returns, Raises: as :func:`momentum_rate`.
    """
    robot = as_robot(robot)
    return momentum_rate(robot, q, v, a) - lagrangian_gradient(robot, q, v)


def action(robot: ArmLike, q: ArrayLike, v: ArrayLike, weights: ArrayLike) -> float:
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
    robot = as_robot(robot)
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
