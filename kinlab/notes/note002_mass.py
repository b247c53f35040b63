"""Note 002, sections 2 and 3: kinetic energy, the inertia tensor, M, the gravity vector."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.notes import arm as mass
from kinlab.notes.arm import Arm, Array, apply, columns, dot, lengths

_TURNING = "note 002, section 2.1"
_MAPPING = "note 002, section 2.2 and 2.3"
_GRAVITY = "note 002, section 3"


def _tensor(points: Array, masses: Array) -> Array:
    x, y, z = np.moveaxis(points, -1, 0)

    def total(values: Array) -> Any:
        return np.sum(masses * values, axis=-1)

    xx, yy, zz = total(y**2 + z**2), total(x**2 + z**2), total(x**2 + y**2)
    xy, xz, yz = total(x * y), total(x * z), total(y * z)
    rows = [[xx, -xy, -xz], [-xy, yy, -yz], [-xz, -yz, zz]]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


_rotation = partial(formula, "002.rot", source=_TURNING, robots="identity")


@_rotation(
    part="tensor",
    quantity="point_inertia",
    latex=r"I_{xx} = \sum m(y^2 + z^2),\ I_{xy} = \sum m x y,\quad I = \begin{pmatrix}"
    r" I_{xx} & -I_{xy} & -I_{xz} \\ -I_{xy} & I_{yy} & -I_{yz} \\ -I_{xz} & -I_{yz} & I_{zz}"
    r" \end{pmatrix}",
)
def inertia_tensor(_: None, points: Array, masses: Array) -> Array:
    """Inertia tensor of point masses."""
    return _tensor(points, masses)


@_rotation(
    part="energy", quantity="turning_energy", latex=r"T_{rot} = \tfrac12\,\omega^T I\,\omega"
)
def turning_energy(_: None, points: Array, masses: Array, omega: Array) -> Any:
    """Kinetic energy of a turning body by its tensor."""
    return 0.5 * dot(omega, apply(_tensor(points, masses), omega))


@_rotation(
    part="cross product",
    quantity="cross_norm_squared",
    latex=r"\lVert a \times b \rVert^2 = \lVert a \rVert^2 \lVert b \rVert^2 - (a \cdot b)^2",
)
def cross_norm_squared(_: None, point: Array, other: Array) -> Any:
    """Squared length of a cross product."""
    return dot(point, point) * dot(other, other) - dot(point, other) ** 2


_mapping = partial(formula, "002.M", source=_MAPPING, robots="serial")


@_mapping(
    part="J",
    quantity="com_jacobians",
    latex=r"\dot r_i = J_i(q)\,\dot q,\quad \omega_i = J_{\omega i}(q)\,\dot q",
)
def link_jacobians(arm: Arm, q: Array) -> Array:
    """Jacobians of the centres of mass and of the links' angular velocities."""
    body = mass.links(arm, q)
    return np.swapaxes(np.concatenate([body.linear, body.angular], axis=-1), -1, -2)


def _own_axes(arm: Arm, q: Array) -> Array:
    body = mass.links(arm, q)
    total: Array = np.einsum("l,...lic,...ljc->...ij", arm.mass, body.linear, body.linear)
    turning: Array = np.einsum("...lia,lab,...ljb->...ij", body.angular, arm.inertia, body.angular)
    return total + turning + np.diag(arm.armature)


@_mapping(
    part="M",
    quantity="mass_matrix",
    latex=r"M = \sum_i \left( m_i J_i^T J_i + J_{\omega i}^T \fixed{R_i I_i R_i^T} J_{\omega i}"
    r" \right)",
    printed=Printed(
        _own_axes,
        "the axes of I_i are not stated: with J_omega in the base it must be R I R^T about the "
        "centre of mass (shown: the constant tensor of the link's own axes)",
        r"M = \sum_i \left( m_i J_i^T J_i + J_{\omega i}^T \wrong{I_i} J_{\omega i} \right)",
        robots=("puma560", "puma560_modified", "panda", "stanford", "ur5", "ur10", "spatial3r"),
    ),
    remark="rotors add their inertia at the joint to the diagonal",
)
def mass_matrix(arm: Arm, q: Array) -> Array:
    """Mass matrix from the link Jacobians."""
    return mass.mass_matrix(arm, q)


@_mapping(part="T", quantity="kinetic_energy", latex=r"T = \tfrac12\,\dot q^T M(q)\,\dot q")
def kinetic_energy(arm: Arm, q: Array, v: Array) -> Any:
    """Kinetic energy by the mass matrix."""
    return 0.5 * dot(v, apply(mass.mass_matrix(arm, q), v))


def _along_z(arm: Arm, q: Array) -> Array:
    g = np.linalg.norm(arm.gravity)
    slope = mass.links(arm, q).linear[..., 2]
    torque: Array = g * np.einsum("l,...lj->...j", arm.mass, slope)
    return torque


_gravity = partial(formula, "002.G", source=_GRAVITY, robots="serial")


@_gravity(
    part="general",
    quantity="gravity_torques",
    latex=r"G_j = \frac{\partial V}{\partial q_j} = \sum_i m_i g"
    r" \frac{\partial \fixed{h_i}}{\partial q_j},\quad \fixed{h_i = -\hat g^T r_i}",
    printed=Printed(
        _along_z,
        "the height is the base's z coordinate only where z is vertical; the note's own planar "
        "examples have y up, where z never changes",
        r"G_j = \frac{\partial V}{\partial q_j} = \sum_i m_i g"
        r" \frac{\partial \wrong{z_i}}{\partial q_j}",
        robots=("planar2r", "planar2r_rods", "planar3r", "single_link"),
    ),
)
def gravity_vector(arm: Arm, q: Array) -> Array:
    """Gravity torques from the heights of the centres."""
    return mass.gravity_torques(arm, q)


@_gravity(part="V", quantity="potential_energy", latex=r"V = \sum_i m_i g h_i")
def potential_energy(arm: Arm, q: Array) -> Any:
    """Potential energy, zero at the base origin."""
    return mass.potential(arm, q)


@_gravity(
    part="single link",
    source=_GRAVITY + ", example",
    quantity="gravity_torques[0]",
    robots="single_link",
    latex=r"G_1 = m_1 g \frac{l}{2} \cos q_1",
)
def single_link_gravity(arm: Arm, q: Array) -> Any:
    """Gravity torque of the single uniform link."""
    (l,) = lengths(arm)
    return arm.mass[0] * -arm.gravity[1] * l / 2 * np.cos(columns(q)[0])
