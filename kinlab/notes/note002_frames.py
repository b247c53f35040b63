"""Note 002, section 1: standard DH frames, centres of mass, the two-link example."""

from __future__ import annotations

from functools import partial

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.notes import arm as mass
from kinlab.notes.arm import (
    Arm,
    Array,
    columns,
    frames,
    joint_columns,
    lengths,
    link_transforms,
    matrix,
    modified_transform,
    standard_transform,
    vector,
)

_SECTION = "note 002, section 1"


def _before_z(arm: Arm, q: Array) -> Array:
    theta, d = joint_columns(arm, q)
    return modified_transform(arm.a, arm.alpha, d, theta)


@formula(
    "002.dhdef",
    source=_SECTION,
    quantity="link_transforms",
    robots="standard",
    latex=r"a_i, \alpha_i \text{ along and about } \fixed{x_i},\ d_i, \theta_i"
    r" \text{ along and about } \fixed{z_{i-1}}:\quad"
    r" T_i = R_z(\theta_i)\,T_z(d_i)\,T_x(a_i)\,R_x(\alpha_i)",
    printed=Printed(
        _before_z,
        "a, alpha are said to belong to x_{i-1} and d, theta to z_i: that is Craig's table; the "
        "product is standard DH, where a, alpha belong to x_i and d, theta to z_{i-1}",
        r"a_i, \alpha_i \text{ along and about } \wrong{x_{i-1}},\ d_i, \theta_i"
        r" \text{ along and about } \wrong{z_i}:\quad"
        r" T_i = R_z(\theta_i)\,T_z(d_i)\,T_x(a_i)\,R_x(\alpha_i)",
    ),
)
def standard_link_transforms(arm: Arm, q: Array) -> Array:
    """Standard link transform of every row."""
    theta, d = joint_columns(arm, q)
    return standard_transform(arm.a, arm.alpha, d, theta)


def _matrices(theta: Array, d: Array, a: Array, last: Array) -> Array:
    c, s = np.cos(theta), np.sin(theta)
    turned = matrix([c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1])
    raised = matrix([1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, d], [0, 0, 0, 1])
    moved = matrix([1, 0, 0, a], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1])
    return np.stack(np.broadcast_arrays(turned, raised, moved, last), axis=-3)


def _last_labelled_tz(_: None, theta: Array, d: Array, a: Array, alpha: Array) -> Array:
    del alpha
    raised = matrix([1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, d], [0, 0, 0, 1])
    return _matrices(theta, d, a, raised)


_RX = (
    r" = \begin{pmatrix} 1 & 0 & 0 & 0 \\ 0 & c\alpha & -s\alpha & 0 \\"
    r" 0 & s\alpha & c\alpha & 0 \\ 0 & 0 & 0 & 1 \end{pmatrix}"
)


@formula(
    "002.elem",
    source=_SECTION,
    quantity="elementary",
    robots="identity",
    latex=r"R_z(\theta),\ T_z(d),\ T_x(a),\ \fixed{R_x(\alpha)}" + _RX,
    printed=Printed(
        _last_labelled_tz,
        "the last matrix is labelled T_z(d); what stands there is R_x(alpha) (shown: the label)",
        r"R_z(\theta),\ T_z(d),\ T_x(a),\ \wrong{T_z(d)}" + _RX,
    ),
)
def elementary(_: None, theta: Array, d: Array, a: Array, alpha: Array) -> Array:
    """The four elementary matrices."""
    c, s = np.cos(alpha), np.sin(alpha)
    tilted = matrix([1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1])
    return _matrices(theta, d, a, tilted)


_frames = partial(formula, source=_SECTION, robots="serial")


@_frames("002.T", part="T_0i", quantity="dh_poses", latex=r"T_{0i}(q) = \prod_{k=1}^{i} T_k(q_k)")
def poses(arm: Arm, q: Array) -> Array:
    """Pose of every DH frame in the base."""
    return frames(arm, q)[..., 1:, :, :]


@_frames(
    "002.T", part="R_i", quantity="dh_poses[:, :3, :3]", latex=r"R_i(q) = [T_{0i}(q)]_{1..3,\,1..3}"
)
def rotations(arm: Arm, q: Array) -> Array:
    """Rotation of every DH frame: the product of the links' own rotations."""
    steps = link_transforms(arm, q)[..., :3, :3]
    turned = [arm.base[:3, :3]]
    for i in range(arm.n):
        turned.append(turned[-1] @ steps[..., i, :, :])
    return np.stack(turned[1:], axis=-3)


@_frames(
    "002.com",
    part="general",
    quantity="com_positions",
    latex=r"r_i = T_{0i} \begin{pmatrix} r_{i,local} \\ 1 \end{pmatrix}"
    r" = p_{0i} + R_i\,r_{i,local}",
)
def centres(arm: Arm, q: Array) -> Array:
    """Centre of mass of every link in the base."""
    return mass.centres(arm, q)


def _centres_on_x(arm: Arm, q: Array, share: float) -> Array:
    """r_i = T_0i [share * l_i, 0, 0, 1]."""
    poses = frames(arm, q)[..., 1:, :, :]
    offset = share * np.array(lengths(arm))
    return poses[..., :3, 3] + offset[:, None] * poses[..., :3, 0]


_example = partial(formula, source=_SECTION + ", two-link example", robots="planar2r_rods")


@_example(
    "002.com",
    part="example",
    quantity="com_positions",
    latex=r"r_i = T_{0i}\,[\fixed{-l_i/2}, 0, 0, 1]^T",
    printed=Printed(
        lambda arm, q: _centres_on_x(arm, q, 0.5),
        "in standard DH frame i sits at the far end of link i: the example's centres at l/2 need "
        "c_i = -l_i/2",
        r"r_i = T_{0i}\,[\wrong{l_i/2}, 0, 0, 1]^T",
    ),
)
def rod_centres(arm: Arm, q: Array) -> Array:
    """Centres of the example's rods by T_0i."""
    return _centres_on_x(arm, q, -0.5)


@_example(
    "002.T2r",
    part="T_1, T_2",
    quantity="link_transforms",
    latex=r"T_i = R_z(q_i)\,T_x(l_i) = \begin{pmatrix} c_i & -s_i & 0 & l_i c_i \\"
    r" s_i & c_i & 0 & l_i s_i \\ 0 & 0 & 1 & 0 \\ 0 & 0 & 0 & 1 \end{pmatrix}",
)
def two_link_steps(arm: Arm, q: Array) -> Array:
    """Link transforms of the two-link example."""
    c, s, l = np.cos(q), np.sin(q), np.array(lengths(arm))
    return matrix([c, -s, 0, l * c], [s, c, 0, l * s], [0, 0, 1, 0], [0, 0, 0, 1])


def _two_link_printed(arm: Arm, q: Array) -> Array:
    l1, l2 = lengths(arm)
    q1, q2 = columns(q)
    c, s = np.cos(q1) + q2, np.sin(q1) + q2
    x = l1 * np.cos(q1) + l2 * np.cos(q1 + q2)
    y = l1 * np.sin(q1) + l2 * np.sin(q1 + q2)
    return matrix([c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1])


_P2 = r" & 0 & l_1 c_1 + l_2 \cos(q_1 + q_2) \\ "
_P2Y = r" & 0 & l_1 s_1 + l_2 \sin(q_1 + q_2) \\ 0 & 0 & 1 & 0 \\ 0 & 0 & 0 & 1 \end{pmatrix}"


@_example(
    "002.T2r",
    part="T_02",
    quantity="dh_poses[1]",
    latex=r"T_{02} = \begin{pmatrix} \fixed{\cos(q_1 + q_2)} & -\fixed{\sin(q_1 + q_2)}"
    + _P2
    + r"\fixed{\sin(q_1 + q_2)} & \fixed{\cos(q_1 + q_2)}"
    + _P2Y,
    printed=Printed(
        _two_link_printed,
        "parentheses lost: cos q1 + q2 for cos(q1 + q2), in R_2 too (read literally)",
        r"T_{02} = \begin{pmatrix} \wrong{\cos q_1 + q_2} & -\wrong{\sin q_1 + q_2}"
        + _P2
        + r"\wrong{\sin q_1 + q_2} & \wrong{\cos q_1 + q_2}"
        + _P2Y,
    ),
)
def two_link_pose(arm: Arm, q: Array) -> Array:
    """Pose of frame 2 of the two-link example."""
    l1, l2 = lengths(arm)
    q1, q2 = columns(q)
    c, s = np.cos(q1 + q2), np.sin(q1 + q2)
    x = l1 * np.cos(q1) + l2 * np.cos(q1 + q2)
    y = l1 * np.sin(q1) + l2 * np.sin(q1 + q2)
    return matrix([c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1])


@_example(
    "002.T2r",
    part="r_1, r_2",
    quantity="com_positions",
    latex=r"r_1 = \begin{pmatrix} \frac{l_1}{2} c_1 \\ \frac{l_1}{2} s_1 \\ 0 \end{pmatrix},\quad"
    r" r_2 = \begin{pmatrix} l_1 c_1 + \frac{l_2}{2} c_{12} \\ l_1 s_1 + \frac{l_2}{2} s_{12}"
    r" \\ 0 \end{pmatrix}",
)
def two_link_centres(arm: Arm, q: Array) -> Array:
    """Centres of the two-link example, written out."""
    l1, l2 = lengths(arm)
    q1, q2 = columns(q)
    first = vector(l1 / 2 * np.cos(q1), l1 / 2 * np.sin(q1), 0.0)
    second = vector(
        l1 * np.cos(q1) + l2 / 2 * np.cos(q1 + q2), l1 * np.sin(q1) + l2 / 2 * np.sin(q1 + q2), 0.0
    )
    return np.stack([first, second], axis=-2)
