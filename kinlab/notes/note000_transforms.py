"""Note 000, section 3 (kinematics): rotations, Craig's link transform, the chain, planar 3R."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.formula import Printed, formula
from kinlab.notes.arm import Arm, Array, columns, cross, lengths, turn, vector
from kinlab.notes.frames import (
    craig,
    frames,
    joint_columns,
    link_transforms,
    modified_transform,
)


@formula(
    "000.R",
    part="inverse",
    source="note 000, section 2",
    quantity="rotation_inverse",
    robots="identity",
    latex=r"R^{-1} = R^T,\quad \det R = 1",
)
def rotation_inverse(_: None, rotation: Array) -> Array:
    """Rows of R are unit vectors and orthogonal: its inverse is its transpose."""
    return turn(rotation)


@formula(
    "000.R",
    part="length",
    source="note 000, section 2",
    quantity="rotated_length",
    robots="identity",
    latex=r"\lVert {}^1p \rVert = \lVert R\,{}^0p \rVert = \lVert {}^0p \rVert",
)
def rotated_length(_: None, rotation: Array, point: Array) -> Any:
    """A rotation keeps the length of a vector."""
    del rotation
    return np.linalg.norm(point, axis=-1)


@formula(
    "000.R",
    part="determinant",
    source="note 000, section 2",
    quantity="rotation_determinant",
    robots="identity",
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
