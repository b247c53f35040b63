"""Note 000, sections 3 and 4: link transforms, forward kinematics, the Jacobian."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.notes.arm import (
    Arm,
    Array,
    Z,
    apply,
    axes,
    columns,
    craig,
    cross,
    frames,
    geometric_jacobian,
    joint_columns,
    lengths,
    link_transforms,
    matrix,
    modified_transform,
    tool_pose,
    transpose,
    vector,
)

# -------- Note 000, section 3 (kinematics): rotations, Craig's link transform, the chain,
#          planar 3R


_rotation = partial(formula, "000.R", source="note 000, section 2", robots="identity")


@_rotation(part="inverse", quantity="rotation_inverse", latex=r"R^{-1} = R^T,\quad \det R = 1")
def rotation_inverse(_: None, rotation: Array) -> Array:
    """Rows of R are unit vectors and orthogonal: its inverse is its transpose."""
    return transpose(rotation)


@_rotation(
    part="length",
    quantity="rotated_length",
    latex=r"\lVert {}^1p \rVert = \lVert R\,{}^0p \rVert = \lVert {}^0p \rVert",
)
def rotated_length(_: None, rotation: Array, point: Array) -> Any:
    """A rotation keeps the length of a vector."""
    del rotation
    return np.linalg.norm(point, axis=-1)


@_rotation(
    part="determinant",
    quantity="rotation_determinant",
    latex=r"\det R = 1",
    remark="rows orthogonal and of unit length allow det R = -1 too: the three are those "
    "of a rotation, not of any orthogonal matrix",
)
def rotation_determinant(_: None, rotation: Array) -> Array:
    """The determinant of a rotation is 1."""
    return np.ones(rotation.shape[:-2])


def _clockwise(arm: Arm, q: Array) -> Array:
    theta, d = joint_columns(arm, q)
    return modified_transform(arm.a, arm.alpha, d, -theta)


_DH = (
    r"{}^{i-1}_iT = \begin{pmatrix} c_i & -s_i & 0 & a_{i-1} \\"
    r" s_i c\alpha_{i-1} & c_i c\alpha_{i-1} & -s\alpha_{i-1} & -s\alpha_{i-1} d_i \\"
    r" s_i s\alpha_{i-1} & c_i s\alpha_{i-1} & c\alpha_{i-1} & c\alpha_{i-1} d_i \\"
    r" 0 & 0 & 0 & 1 \end{pmatrix},\quad \theta_i "
)


@formula(
    "000.dh",
    source="note 000, section 3",
    quantity="link_transforms",
    robots="modified",
    latex=_DH + r"\fixed{\text{ counter-clockwise}}",
    printed=Printed(
        _clockwise,
        "theta is said to be positive clockwise; the matrix is right-handed (counter-clockwise)",
        _DH + r"\wrong{\text{ clockwise}}",
    ),
)
def modified_link_transforms(arm: Arm, q: Array) -> Array:
    """Craig's link transform of every row."""
    return link_transforms(arm, q)


@formula(
    "000.chain",
    source="note 000, section 3",
    quantity="fk",
    robots="serial",
    latex=r"{}^0_nT = {}^0_1T\,{}^1_2T \cdots {}^{n-1}_nT",
    remark="base and tool transforms stand before and behind the product",
)
def chain(arm: Arm, q: Array) -> Array:
    """The tool's pose is the product of the link transforms."""
    return frames(arm, q)[..., -1, :, :] @ arm.tool


@formula(
    "000.axes",
    part="intersecting",
    source="note 000, section 3, special cases",
    quantity="common_normals",
    robots=("stanford", "puma560", "puma560_modified", "panda", "ur5", "spatial3r"),
    latex=r"x_{i-1} = \pm\frac{z_{i-1} \times z_i}{\lVert z_{i-1} \times z_i \rVert}",
    remark="the sign is free; a table fixes it. The common normal is z_{i-1} x z_i wherever the "
    "axes are not parallel, whether they meet or not",
)
def common_normals(arm: Arm, q: Array) -> Array:
    """Between axes that are not parallel x lies along z_{i-1} x z_i (projectors, sign-free)."""
    z = frames(craig(arm), q)[..., :3, 2]
    normal = cross(z[..., :-1, :], z[..., 1:, :])
    size = np.linalg.norm(normal, axis=-1, keepdims=True)
    skew = size > 1e-6
    unit = np.where(skew, normal / np.where(skew, size, 1.0), 0.0)
    return unit[..., :, None] * unit[..., None, :]


@formula(
    "000.axes",
    part="parallel",
    source="note 000, section 3, special cases",
    quantity="link_transforms",
    robots=("planar2r", "planar3r"),
    latex=r"z_{i-1} \parallel z_i:\quad d_i = 0",
)
def parallel_transforms(arm: Arm, q: Array) -> Array:
    """Between parallel axes x may be chosen so that d = 0."""
    theta, _ = joint_columns(arm, q)
    return modified_transform(arm.a, arm.alpha, 0.0, theta)


@formula(
    "000.fk3r",
    source="note 000, planar robots",
    quantity="planar_pose",
    robots="planar3r",
    latex=r"\begin{pmatrix} x \\ y \\ \theta \end{pmatrix} = \begin{pmatrix}"
    r" l_1 c_1 + l_2 c_{12} + l_3 c_{123} \\ l_1 s_1 + l_2 s_{12} + l_3 s_{123} \\"
    r" \theta_1 + \theta_2 + \theta_3 \end{pmatrix}",
)
def planar_3r(arm: Arm, q: Array) -> Array:
    """Position and angle of the planar 3R arm (the angle as its cosine and sine)."""
    l1, l2, l3 = lengths(arm)
    q1, q2, q3 = columns(q)
    x = l1 * np.cos(q1) + l2 * np.cos(q1 + q2) + l3 * np.cos(q1 + q2 + q3)
    y = l1 * np.sin(q1) + l2 * np.sin(q1 + q2) + l3 * np.sin(q1 + q2 + q3)
    return vector(x, y, np.cos(q1 + q2 + q3), np.sin(q1 + q2 + q3))


# -------- Note 000, section 4: the Jacobian, by differentiation, by velocities, between
#          frames


@formula(
    "000.J",
    source="note 000, section 4.1",
    quantity="jacobian",
    robots="serial",
    latex=r"J = \left[\frac{\partial f_i}{\partial q_j}\right]",
    remark="the note loses the ∂ in front of q in some entries; in space the rows of omega are "
    "derivatives of no coordinates",
)
def jacobian_by_differentiation(arm: Arm, q: Array) -> Array:
    """J = df/dq: the chain product differentiated factor by factor."""
    arm = craig(arm)
    steps = link_transforms(arm, q)
    poses = frames(arm, q)
    tool = poses[..., -1, :, :] @ arm.tool
    behind = np.broadcast_to(arm.tool, tool.shape)
    result = []
    for i in reversed(range(arm.n)):
        # T_i ends in Rz Tz, so its derivative is T_i times the generator of that motion
        generator = np.zeros((4, 4))
        if arm.prismatic[i]:
            generator[2, 3] = arm.sign[i]
        else:
            generator[0, 1], generator[1, 0] = -arm.sign[i], arm.sign[i]
        slope = poses[..., i + 1, :, :] @ generator @ behind
        spin = slope[..., :3, :3] @ transpose(tool[..., :3, :3])
        omega = np.stack([spin[..., 2, 1], spin[..., 0, 2], spin[..., 1, 0]], axis=-1)
        result.append(np.concatenate([slope[..., :3, 3], omega], axis=-1))
        behind = steps[..., i, :, :] @ behind
    return np.stack(result[::-1], axis=-1)


@formula(
    "000.J3r",
    source="note 000, section 4.1",
    quantity="planar_jacobian",
    robots="planar3r",
    latex=r"{}^0J = \begin{pmatrix} -l_3 s_{123} - l_2 s_{12} - l_1 s_1 & -l_3 s_{123} - l_2 s_{12}"
    r" & -l_3 s_{123} \\ l_3 c_{123} + l_2 c_{12} + l_1 c_1 & l_3 c_{123} + l_2 c_{12} &"
    r" l_3 c_{123} \\ 1 & 1 & 1 \end{pmatrix}",
)
def planar_3r_jacobian(arm: Arm, q: Array) -> Array:
    """Jacobian of the planar 3R arm in frame 0."""
    l1, l2, l3 = lengths(arm)
    q1, q2, q3 = columns(q)
    s1, s12, s123 = np.sin(q1), np.sin(q1 + q2), np.sin(q1 + q2 + q3)
    c1, c12, c123 = np.cos(q1), np.cos(q1 + q2), np.cos(q1 + q2 + q3)
    return matrix(
        [-l3 * s123 - l2 * s12 - l1 * s1, -l3 * s123 - l2 * s12, -l3 * s123],
        [l3 * c123 + l2 * c12 + l1 * c1, l3 * c123 + l2 * c12, l3 * c123],
        [1.0, 1.0, 1.0],
    )


def propagate(arm: Arm, q: Array, v: Array, slide: Array = Z) -> Array:
    """Velocities (v, omega) from link to link, (..., n, 6); a slide adds d_dot times ``slide``."""
    arm = craig(arm)
    steps = link_transforms(arm, q)
    rates = arm.sign * np.asarray(v)
    omega = linear = np.zeros((*np.shape(q)[:-1], 3))
    result = []
    for i in range(arm.n):
        down = transpose(steps[..., i, :3, :3])
        p = steps[..., i, :3, 3]
        linear = apply(down, linear + cross(omega, p))
        omega = apply(down, omega)
        if arm.prismatic[i]:
            linear = linear + rates[..., i, None] * slide
        else:
            omega = omega + rates[..., i, None] * Z
        result.append(np.concatenate([linear, omega], axis=-1))
    return np.stack(result, axis=-2)


_VELOCITY = (
    r"{}^{i+1}\omega_{i+1} = {}^{i+1}_iR\,{}^i\omega_i"
    r" + \dot\theta_{i+1}\,{}^{i+1}\hat Z_{i+1},\quad"
    r" {}^{i+1}v_{i+1} = {}^{i+1}_iR({}^iv_i + {}^i\omega_i \times {}^ip_{i+1})"
)


_jacobian_rows = partial(formula, source="note 000, section 4.2", robots="serial")


@_jacobian_rows(
    "000.Jv",
    quantity="jacobian[:3]",
    latex=r"\fixed{{}^0J_v = ({}^0\hat Z_1 \times ({}^0p_e - {}^0p_1)\ \cdots"
    r"\ {}^0\hat Z_n \times ({}^0p_e - {}^0p_n))}",
    printed=Printed(
        lambda arm, q: np.full((*np.shape(q)[:-1], 3, arm.n), np.nan),
        "the linear velocity is said to have no general formula; it has one, for any arm (shown: "
        "the printed form gives nothing)",
        r"{}^0J_v:\ \wrong{\text{no general formula}}",
    ),
    remark="the column of a prismatic joint is its axis",
)
def linear_jacobian(arm: Arm, q: Array) -> Array:
    """The linear rows of J: each axis crossed with the way from it to the tool."""
    return geometric_jacobian(arm, q, tool_pose(arm, q)[..., :3, 3])[..., :3, :]


@_jacobian_rows(
    "000.vel",
    quantity="link_velocities",
    latex=_VELOCITY + r"\fixed{ + \dot d_{i+1}\,{}^{i+1}\hat Z_{i+1}}",
    printed=Printed(
        lambda arm, q, v: propagate(arm, q, v, slide=0.0 * Z),
        "written for revolute joints only: at a slide v gains d_dot Z and omega gains nothing",
        _VELOCITY + r"\wrong{\text{ (revolute only)}}",
        robots=("sliding",),
    ),
    remark="^iZ_n is the direction of Z_n in frame {i}; the note's words say frame {1}",
)
def velocities(arm: Arm, q: Array, v: Array) -> Array:
    """Velocity propagation from link to link, revolute and prismatic."""
    return propagate(arm, q, v)


@_jacobian_rows(
    "000.omega",
    part="base",
    quantity="jacobian[3:]",
    latex=r"{}^0J_\omega = ({}^0\hat Z_1\ \ {}^0\hat Z_2\ \cdots\ {}^0\hat Z_n)",
    remark="the column of a prismatic joint is zero",
)
def angular_jacobian(arm: Arm, q: Array) -> Array:
    """The angular rows of J are the joint axes."""
    z, _ = axes(arm, q)
    return transpose(np.where(arm.prismatic[:, None], 0.0, z))


def _omega_printed(arm: Arm, q: Array) -> Array:
    arm = craig(arm)
    rotations = frames(arm, q)[..., 1:, :3, :3]
    back = transpose(rotations) @ rotations[..., -1:, :, :]  # ^i_n R
    return transpose(np.where(arm.prismatic[:, None], 0.0, arm.sign[:, None] * back[..., :, 2]))


@_jacobian_rows(
    "000.omega",
    part="last frame",
    quantity="angular_jacobian_last",
    latex=r"{}^n\omega_n = \sum_i \fixed{{}^n_iR} \begin{pmatrix} 0 \\ 0 \\ 1 \end{pmatrix}"
    r" \dot\theta_i",
    printed=Printed(
        _omega_printed,
        "sub- and superscripts of R exchanged in the middle lines: ^i_nR turns the wrong way",
        r"{}^n\omega_n = \sum_i \wrong{{}^i_nR} \begin{pmatrix} 0 \\ 0 \\ 1 \end{pmatrix}"
        r" \dot\theta_i",
        robots=("spatial",),
    ),
)
def angular_jacobian_last(arm: Arm, q: Array) -> Array:
    """The angular rows of J in the last link's own axes."""
    arm = craig(arm)
    rotations = frames(arm, q)[..., 1:, :3, :3]
    down = transpose(rotations[..., -1:, :, :]) @ rotations  # ^n_i R
    return transpose(np.where(arm.prismatic[:, None], 0.0, arm.sign[:, None] * down[..., :, 2]))


@formula(
    "000.Jw3",
    source="note 000, section 4.2, example",
    quantity="jacobian[3:]",
    robots="spatial3r",
    latex=r"{}^0J_\omega = \begin{pmatrix} 0 & 0 & s_{12} \\ 0 & 0 & -c_{12} \\ 1 & 1 & 0"
    r" \end{pmatrix}",
    remark="the table behind it: alpha = 0, 0, +90 degrees in Craig's convention",
)
def spatial_3r_angular(arm: Arm, q: Array) -> Array:
    """Angular Jacobian of the spatial 3R arm."""
    del arm
    q1, q2, _ = columns(q)
    return matrix(
        [0.0, 0.0, np.sin(q1 + q2)],
        [0.0, 0.0, -np.cos(q1 + q2)],
        [1.0, 1.0, 0.0],
    )


def tool_jacobian(arm: Arm, q: Array) -> Array:
    """^nJ in tool axes, by velocity propagation at each unit rate, (..., 6, n)."""
    last = craig(arm)
    turned, place = last.tool[:3, :3], last.tool[:3, 3]
    result = []
    for rate in np.eye(arm.n):
        motion = propagate(last, q, np.broadcast_to(rate, np.shape(q)))[..., -1, :]
        linear = motion[..., :3] + cross(motion[..., 3:], place)
        result.append(np.concatenate([linear @ turned, motion[..., 3:] @ turned], axis=-1))
    return np.stack(result, axis=-1)


def turn_rows(rotation: Array, jacobian: Array) -> Array:
    """blkdiag(R, R) J."""
    return np.concatenate(
        [rotation @ jacobian[..., :3, :], rotation @ jacobian[..., 3:, :]], axis=-2
    )


@formula(
    "000.Jframe",
    source="note 000, section 4.3",
    quantity="jacobian",
    robots="serial",
    latex=r"{}^AJ = \begin{pmatrix} {}^A_BR & 0 \\ 0 & {}^A_BR \end{pmatrix} {}^BJ",
)
def jacobian_between_frames(arm: Arm, q: Array) -> Array:
    """The Jacobian turned from tool axes to base axes."""
    return turn_rows(tool_pose(arm, q)[..., :3, :3], tool_jacobian(arm, q))


def _only_regular(arm: Arm, q: Array) -> Array:
    planar = geometric_jacobian(arm, q, tool_pose(arm, q)[..., :3, 3])[..., [0, 1, 5], :]
    regular = np.abs(np.linalg.det(planar)) > 1e-12
    return np.where(regular[..., None, None], jacobian_between_frames(arm, q), np.nan)


@formula(
    "000.Jframe",
    part="singular",
    source="note 000, section 4.3",
    quantity="singular_jacobian",
    robots="planar3r",
    latex=r"{}^AJ = \mathrm{blkdiag}(R, R)\,{}^BJ \quad \fixed{\text{always}}",
    printed=Printed(
        _only_regular,
        "said to hold only if det J ≠ 0; it always holds (shown at singular poses, where the "
        "printed form gives nothing)",
        r"{}^AJ = \mathrm{blkdiag}(R, R)\,{}^BJ \quad \wrong{\text{only if } \det J \neq 0}",
    ),
)
def jacobian_at_singular_pose(arm: Arm, q: Array) -> Array:
    """The same turn at singular poses."""
    return jacobian_between_frames(arm, q)
