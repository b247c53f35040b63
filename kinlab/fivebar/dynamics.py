"""Dynamics of a five-bar in closed form: rods of mass, torque, mass matrix, energy and power."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, shown
from kinlab.errors import InertiaError, OptionError, near
from kinlab.fivebar.arguments import HANGING, Mode, OnUnreachable, perpendicular, read_vectors
from kinlab.fivebar.geometry import Pose, rate_bias, rate_matrix, solve_pose
from kinlab.tolerances import TOLERANCES

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

# -------- What the mass of a rod does at its two ends: exact, left out, or lumped
# A rod moves as the straight line between its elbow B and the tool P, so its kinetic energy is
# ½ (alpha_B |v_B|² + 2 kappa v_B·v_P + alpha_C |v_P|²) with the three coefficients below, and its
# weight acts as (1 - rho) of the rod at B and rho at P. Every rod model is one such row of
# coefficients; only the exact one keeps kappa, the coupling that two point masses cannot have.
#
# Source: derived here by the kinetic energy of a rigid bar; ``massless`` is Huang et al. 2005.


@dataclass(frozen=True)
class RodModel:
    """What a rod's mass does at its two ends; each entry is a pair over the legs, kg.

    Attributes:
        elbow: alpha_B, inertia of the elbow's motion.
        coupling: kappa, inertia shared by elbow and tool.
        tool: alpha_C, inertia of the tool's motion.
        elbow_weight: mass whose weight acts at the elbow.
        tool_weight: mass whose weight acts at the tool.
    """

    elbow: Array
    coupling: Array
    tool: Array
    elbow_weight: Array
    tool_weight: Array


def exact_rods(linkage: FiveBar) -> RodModel:
    """alpha_B = m(1-rho)² + I/l2², alpha_C = m rho² + I/l2², kappa = m rho(1-rho) - I/l2²."""
    mass, rho = linkage.rod_mass, _fraction(linkage)
    inertia = linkage.rod_inertia / linkage.l2**2
    return RodModel(
        elbow=mass * (1.0 - rho) ** 2 + inertia,
        coupling=mass * rho * (1.0 - rho) - inertia,
        tool=mass * rho**2 + inertia,
        elbow_weight=mass * (1.0 - rho),
        tool_weight=mass * rho,
    )


def _fraction(linkage: FiveBar) -> Array:
    return linkage.rod_com / linkage.l2


def _two_masses(linkage: FiveBar, at_tool: ArrayLike) -> RodModel:
    mass = linkage.rod_mass
    tool = mass * np.asarray(at_tool)
    return RodModel(mass - tool, np.zeros(2), tool, mass - tool, tool)


ROD_MODELS: dict[str, Callable[[FiveBar], RodModel]] = {
    "exact": exact_rods,
    "massless": lambda linkage: RodModel(*np.zeros((5, 2))),
    "half": lambda linkage: _two_masses(linkage, 0.5),
    "third": lambda linkage: _two_masses(linkage, 1.0 / 3.0),
    "static": lambda linkage: _two_masses(linkage, _fraction(linkage)),
}
"""Models of the rods by name.

``exact``: rigid rods. ``massless``: Huang's form, rods left out. The lumpings put two point
masses in the rod's place: ``half`` ½ at the elbow and ½ at the tool, ``third`` ⅔ and ⅓ (usual
for Delta robots), ``static`` so that weight and centre are right and only inertia is not.
"""


def rod_model(linkage: FiveBar, model: str) -> RodModel:
    """The coefficients of a named model.

    Raises:
        OptionError: no model of that name.
    """
    if not isinstance(model, str) or model not in ROD_MODELS:
        choices = near(model if isinstance(model, str) else "", ROD_MODELS)
        raise OptionError(f"rod model {shown(model)} does not exist; {choices}")
    return ROD_MODELS[model](linkage)


# -------- Torque, mass matrix and acceleration
# The formulas are the same for all rod models.
#
# Sources: note 003 (003.vw, 003.G, 003.P); Huang et al. 2005, doi 10.1115/1.1898343, whose rods
# have no mass; the exact form is derived by virtual work and tested against a Lagrangian.


def crank_inertia(linkage: FiveBar, rods: RodModel) -> Array:
    """I_A* = I_1 + m_1 c_1² + j² I_M + alpha_B l1², about the base pins, (2,), kg m²."""
    own = linkage.crank_inertia + linkage.crank_mass * np.square(linkage.crank_com)
    return own + linkage.reflected_inertia + rods.elbow * np.square(linkage.l1)


def _bars(linkage: FiveBar, *, mass: bool) -> list[str]:
    """The kinds of bars without inertia, with mass or without it."""
    kinds = [bar for bar in ("crank", "rod") if not np.any(getattr(linkage, f"{bar}_inertia"))]
    return [bar for bar in kinds if np.any(getattr(linkage, f"{bar}_mass")) == mass]


def bars_as_points(linkage: FiveBar) -> str:
    """Says which bars have mass and no inertia about their centres, or nothing."""
    points = _bars(linkage, mass=True)
    if not points:
        return ""
    bars = " and ".join(f"{bar}s" for bar in points)
    return f"the {bars} have mass without inertia: they count as points at their centres"


def bars_without_mass(linkage: FiveBar) -> str:
    """Says which bars have neither mass nor inertia, or nothing where all have one."""
    bare = _bars(linkage, mass=False)
    if not bare:
        return ""
    keys = ", ".join(f"{bar}_mass, {bar}_inertia" for bar in bare)
    return (
        f"the {' and '.join(f'{bar}s' for bar in bare)} have NO MASS: torques and power move the "
        f"rest alone, and real bars can ask for several times as much; give {keys}"
    )


def inverse_dynamics(
    linkage: FiveBar,
    xy: ArrayLike,
    v: ArrayLike,
    a: ArrayLike,
    mode: Mode = HANGING,
    model: str = "exact",
    on_unreachable: OnUnreachable = "raise",
) -> Array:
    """Crank torques for a motion of the tool (003.vw, and with rods of mass).

    tau_i = I_A*_i theta_ddot_i + kappa_i l1_i n_i·a - (m_1 c_1 + m_B l1)_i n_i·g
            + [J^-T ((m + sum alpha_C) a + sum kappa_i a_Bi - (m + sum m_P) g)]_i

    with n_i = k x u_i, g the vector of gravity, m_B and m_P the rods' weight at elbow and tool.

    Args:
        linkage: the five-bar.
        xy: tool, (2,) or (N, 2), m.
        v: tool velocity, m/s. a: tool acceleration, m/s².
        mode: signs of u_i x w_i.
        model: ``"exact"``, ``"massless"``, ``"half"``, ``"third"`` or ``"static"``.
        on_unreachable: ``"raise"`` or ``"mask"``.

    Returns:
        Torques at the crank side of the gears, (2,) or (N, 2), N m.

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type I (infinite rates) or type II (infinite torques).
        OptionError: no such mode or model.
    """
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, on_unreachable, regular="I II")
    velocity = read_vectors(v, len(pose.xy), f"{linkage.name}: v")
    acceleration = read_vectors(a, len(pose.xy), f"{linkage.name}: a")
    return pose.restore(torques(linkage, pose, velocity, acceleration, rods))


def torques(linkage: FiveBar, pose: Pose, v: Array, a: Array, rods: RodModel) -> Array:
    """The formula of :func:`inverse_dynamics` for solved poses, (N, 2)."""
    l1 = linkage.l1
    jac = rate_matrix(linkage, pose)
    rate = np.einsum("nij,nj->ni", jac, v)
    theta_ddot = np.einsum("nij,nj->ni", jac, a) + rate_bias(linkage, pose, v)
    normal = perpendicular(pose.u)
    elbow = l1[:, None] * (theta_ddot[..., None] * normal - (rate**2)[..., None] * pose.u)
    force = (linkage.payload + rods.tool.sum()) * a
    force = force + np.einsum("i,nij->nj", rods.coupling, elbow)
    force = force - (linkage.payload + rods.tool_weight.sum()) * linkage.gravity
    shared = rods.coupling * l1 * np.einsum("nij,nj->ni", normal, a)
    tau: Array = (
        crank_inertia(linkage, rods) * theta_ddot
        + shared
        + crank_gravity(linkage, pose, rods)
        + tool_force(linkage, pose, force)
    )
    return tau


def crank_gravity(linkage: FiveBar, pose: Pose, rods: RodModel) -> Array:
    """tau_Ag: what holds the weight of the cranks and of the rods' share at the elbows, (N, 2)."""
    moment = linkage.crank_mass * linkage.crank_com
    moment = moment + rods.elbow_weight * linkage.l1
    return -moment * (perpendicular(pose.u) @ linkage.gravity)


def tool_force(linkage: FiveBar, pose: Pose, force: Array) -> Array:
    """J^-T F: the crank torques that apply the force F at the tool, (N, 2).

    From F = lambda_1 w_1 + lambda_2 w_2: tau_i = l1_i (u_i x w_i) lambda_i.
    """
    w1, w2 = pose.w[:, 0], pose.w[:, 1]
    first = (force[:, 0] * w2[:, 1] - force[:, 1] * w2[:, 0]) / pose.rods
    second = (w1[:, 0] * force[:, 1] - w1[:, 1] * force[:, 0]) / pose.rods
    along = np.stack([first, second], axis=1)
    return linkage.l1 * pose.sine * along


def velocity_matrix(linkage: FiveBar, pose: Pose) -> Array:
    """J^-1 of v = J^-1 theta_dot for solved poses, (N, 2, 2)."""
    columns = np.stack([-perpendicular(pose.w[:, 1]), perpendicular(pose.w[:, 0])], axis=2)
    return columns * (linkage.l1 * pose.sine)[:, None, :] / pose.rods[:, None, None]


def mass_matrix(
    linkage: FiveBar,
    xy: ArrayLike,
    mode: Mode = HANGING,
    model: str = "exact",
    on_unreachable: OnUnreachable = "raise",
) -> Array:
    """M in the actuated joints: tau = M theta_ddot + h(theta, theta_dot).

    M = diag(I_A*) + K J^-1 + J^-T K^T + (m + sum alpha_C) J^-T J^-1, row i of K being
    kappa_i l1_i n_i^T. :func:`task_mass_matrix` is J^T M J, which multiplies the tool's
    acceleration.

    Args:
        linkage: the five-bar.
        xy: tool, (2,) or (N, 2), m.
        mode: signs of u_i x w_i.
        model: a rod model, see :data:`ROD_MODELS`.
        on_unreachable: ``"raise"`` or ``"mask"``.

    Returns:
        (2, 2) or (N, 2, 2), symmetric, kg m².

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type II, where the cranks do not determine the tool.
    """
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, on_unreachable, regular="II")
    return pose.restore(joint_mass(linkage, pose, rods))


def joint_mass(linkage: FiveBar, pose: Pose, rods: RodModel) -> Array:
    """The formula of :func:`mass_matrix` for solved poses, (N, 2, 2)."""
    inverse = velocity_matrix(linkage, pose)
    shared = (rods.coupling * linkage.l1)[:, None] * perpendicular(pose.u) @ inverse
    mass: Array = (
        np.diag(crank_inertia(linkage, rods))
        + shared
        + shared.swapaxes(1, 2)
        + (linkage.payload + rods.tool.sum()) * inverse.swapaxes(1, 2) @ inverse
    )
    return mass


def task_mass_matrix(
    linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING, model: str = "exact"
) -> Array:
    """Lambda = J^T M J, the inertia felt at the tool: J^T tau = Lambda a + ...

    Arguments as :func:`mass_matrix`.

    Returns:
        (2, 2) or (N, 2, 2), symmetric, kg.

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type I or type II.
    """
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, regular="I II")
    jac = rate_matrix(linkage, pose)
    return pose.restore(jac.swapaxes(1, 2) @ joint_mass(linkage, pose, rods) @ jac)


def gravity_torques(
    linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING, model: str = "exact"
) -> Array:
    """Crank torques that hold the linkage still, (2,) or (N, 2), N m.

    Arguments as :func:`mass_matrix`; exists at type I too, where the cranks carry no tool force.

    Raises:
        UnreachableError: a point out of reach.
        SingularError: type II.
    """
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, regular="II")
    weight = -(linkage.payload + rods.tool_weight.sum()) * linkage.gravity
    held = tool_force(linkage, pose, np.broadcast_to(weight, pose.xy.shape))
    return pose.restore(crank_gravity(linkage, pose, rods) + held)


def bias_torques(
    linkage: FiveBar, xy: ArrayLike, v: ArrayLike, mode: Mode = HANGING, model: str = "exact"
) -> Array:
    """h of tau = M theta_ddot + h: gravity and velocity terms, (2,) or (N, 2), N m.

    Arguments and errors as :func:`inverse_dynamics`.
    """
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, regular="I II")
    velocity = read_vectors(v, len(pose.xy), f"{linkage.name}: v")
    return pose.restore(_bias(linkage, pose, velocity, rods))


def _bias(linkage: FiveBar, pose: Pose, v: Array, rods: RodModel) -> Array:
    inverse = velocity_matrix(linkage, pose)
    steady = -np.einsum("nij,nj->ni", inverse, rate_bias(linkage, pose, v))  # theta_ddot = 0
    return torques(linkage, pose, v, steady, rods)


def forward_dynamics(
    linkage: FiveBar,
    xy: ArrayLike,
    v: ArrayLike,
    tau: ArrayLike,
    mode: Mode = HANGING,
    model: str = "exact",
) -> Array:
    """Crank accelerations under given torques: theta_ddot = M^-1 (tau - h).

    Args:
        linkage: the five-bar.
        xy: tool, (2,) or (N, 2), m. v: its velocity, m/s.
        tau: crank torques, (2,) or (N, 2), N m.
        mode: signs of u_i x w_i.
        model: a rod model, see :data:`ROD_MODELS`.

    Returns:
        (2,) or (N, 2), rad/s².

    Raises:
        InertiaError: no mass where the motion needs one.
        UnreachableError, SingularError: as :func:`inverse_dynamics`.
    """
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, regular="I II")
    velocity = read_vectors(v, len(pose.xy), f"{linkage.name}: v")
    torque = read_vectors(tau, len(pose.xy), f"{linkage.name}: tau")
    mass = joint_mass(linkage, pose, rods)
    least = np.linalg.eigvalsh(mass)
    if np.any(least[:, 0] <= TOLERANCES.massless * np.abs(least[:, 1])):
        raise InertiaError(
            f"{linkage.name}: the mass matrix is singular, so torques do not determine the "
            "acceleration; give the cranks an inertia, or the tool a payload and the rods a mass"
        )
    force = torque - _bias(linkage, pose, velocity, rods)
    return pose.restore(np.asarray(np.linalg.solve(mass, force[..., None])[..., 0], np.float64))


# -------- Energy and power
# Source: note 003 (003.P) for the power.


def kinetic_energy(
    linkage: FiveBar, xy: ArrayLike, v: ArrayLike, mode: Mode = HANGING, model: str = "exact"
) -> Array:
    """Rotors included, () or (N,), J; arguments and errors as :func:`inverse_dynamics`."""
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, regular="I II")
    velocity = read_vectors(v, len(pose.xy), f"{linkage.name}: v")
    rate = np.einsum("nij,nj->ni", rate_matrix(linkage, pose), velocity)
    mass = joint_mass(linkage, pose, rods)
    return pose.restore(0.5 * np.einsum("ni,nij,nj->n", rate, mass, rate))


def potential_energy(
    linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING, model: str = "exact"
) -> Array:
    """Zero where all mass would lie at the origin, between the base pins; () or (N,), J.

    Arguments as :func:`mass_matrix`; exists at every reachable pose.

    Raises:
        UnreachableError: a point out of reach.
    """
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode)
    moment = linkage.crank_mass * linkage.crank_com
    moment = moment + rods.elbow_weight * linkage.l1
    base = np.stack([linkage.base_x, np.zeros(2)], axis=1)
    anchored = (linkage.crank_mass + rods.elbow_weight) @ base
    first: Array = np.einsum("i,nij->nj", moment, pose.u) + anchored
    first = first + (linkage.payload + rods.tool_weight.sum()) * pose.xy
    energy: Array = -np.einsum("nj,j->n", first, linkage.gravity)
    return pose.restore(energy)


def joint_power(
    linkage: FiveBar,
    xy: ArrayLike,
    v: ArrayLike,
    a: ArrayLike,
    mode: Mode = HANGING,
    model: str = "exact",
) -> Array:
    """P_i = tau_i theta_dot_i, (2,) or (N, 2), W; as :func:`inverse_dynamics` (003.P)."""
    rods = rod_model(linkage, model)
    pose = solve_pose(linkage, xy, mode, regular="I II")
    velocity = read_vectors(v, len(pose.xy), f"{linkage.name}: v")
    acceleration = read_vectors(a, len(pose.xy), f"{linkage.name}: a")
    rate = np.einsum("nij,nj->ni", rate_matrix(linkage, pose), velocity)
    return pose.restore(rate * torques(linkage, pose, velocity, acceleration, rods))
