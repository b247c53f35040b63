"""Energy and power of a five-bar in closed form.

Source: note 003 (003.P) for the power; the energies are those of :mod:`kinlab.fivebar.dynamics`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.fivebar.dynamics import joint_mass, torques
from kinlab.fivebar.geometry import rate_matrix
from kinlab.fivebar.linkage import Linkage
from kinlab.fivebar.pose import HANGING, Mode, read_vectors, solve_pose
from kinlab.fivebar.rods import rod_model


def kinetic_energy(
    linkage: Linkage, xy: ArrayLike, v: ArrayLike, mode: Mode = HANGING, model: str = "exact"
) -> Array:
    """Rotors included, () or (N,), J; arguments and errors as :func:`inverse_dynamics`."""
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, regular="I II")
    velocity = read_vectors(v, pose, f"{linkage.name}: v")
    rate = np.einsum("nij,nj->ni", rate_matrix(linkage, pose), velocity)
    mass = joint_mass(linkage, pose, rods)
    return pose.give(0.5 * np.einsum("ni,nij,nj->n", rate, mass, rate))


def potential_energy(
    linkage: Linkage, xy: ArrayLike, mode: Mode = HANGING, model: str = "exact"
) -> Array:
    """Zero where all mass would lie at the origin, between the base pins; () or (N,), J.

    Arguments as :func:`mass_matrix`; exists at every reachable pose.

    Raises:
        UnreachableError: a point out of reach.
    """
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode)
    moment = np.asarray(linkage.crank_mass) * np.asarray(linkage.crank_com)
    moment = moment + rods.elbow_weight * np.asarray(linkage.l1)
    base = np.stack([linkage.base_x, np.zeros(2)], axis=1)
    anchored = (np.asarray(linkage.crank_mass) + rods.elbow_weight) @ base
    first: Array = np.einsum("i,nij->nj", moment, pose.u) + anchored
    first = first + (linkage.payload + rods.tool_weight.sum()) * pose.xy
    energy: Array = -np.einsum("nj,j->n", first, np.asarray(linkage.gravity))
    return pose.give(energy)


def joint_power(
    linkage: Linkage,
    xy: ArrayLike,
    v: ArrayLike,
    a: ArrayLike,
    mode: Mode = HANGING,
    model: str = "exact",
) -> Array:
    """P_i = tau_i theta_dot_i, (2,) or (N, 2), W; as :func:`inverse_dynamics` (003.P)."""
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, regular="I II")
    velocity = read_vectors(v, pose, f"{linkage.name}: v")
    acceleration = read_vectors(a, pose, f"{linkage.name}: a")
    rate = np.einsum("nij,nj->ni", rate_matrix(linkage, pose), velocity)
    return pose.give(rate * torques(linkage, pose, velocity, acceleration, rods))
