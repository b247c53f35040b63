"""Note 000, sections 5, 6 and IK: singular and isotropic poses, Newton, gradient."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from kinlab.formulas.record import Printed, formula
from kinlab.notes.arm import (
    Arm,
    Array,
    apply,
    columns,
    geometric_jacobian,
    lengths,
    matrix,
    tool_pose,
    transpose,
    vector,
)
from kinlab.notes.note000_kinematics import linear_jacobian, planar_3r_jacobian

# -------- Note 000, sections 5 and 6: singular and isotropic poses of planar arms


@formula(
    "000.sing",
    part="3R",
    source="note 000, section 5",
    quantity="planar_determinant",
    robots="planar3r",
    latex=r"\det J = l_1 l_2 s_2",
    remark="a determinant needs a square J; rank and the smallest singular value serve any shape",
)
def planar_3r_determinant(arm: Arm, q: Array) -> Any:
    """det J of the planar 3R arm: singular where it is stretched or folded."""
    l1, l2, _ = lengths(arm)
    return l1 * l2 * np.sin(columns(q)[1])


@formula(
    "000.sing",
    part="2R",
    source="note 000, section 5",
    quantity="planar_position_determinant",
    robots=("planar2r", "planar2r_rods"),
    latex=r"\det J_{xy} = l_1 l_2 s_2",
)
def planar_2r_determinant(arm: Arm, q: Array) -> Any:
    """det J of the planar 2R arm, the tool's angle left out."""
    l1, l2 = lengths(arm)
    return l1 * l2 * np.sin(columns(q)[1])


def tip_jacobian(arm: Arm, q: Array) -> Array:
    """^3J of the planar 2R arm, (..., 2, 2)."""
    l1, l2 = lengths(arm)
    q2 = columns(q)[1]
    return matrix([l1 * np.sin(q2), 0.0], [l1 * np.cos(q2) + l2, l2])


def _defect(products: Array) -> Array:
    """Square of how far a matrix of products is from a multiple of 1, over that multiple."""
    size = products.shape[-1]
    mean = np.trace(products, axis1=-2, axis2=-1)[..., None, None] / size
    defect: Array = np.sum((products / mean - np.eye(size)) ** 2, axis=(-2, -1))
    return defect


def _of_columns(arm: Arm, q: Array) -> Array:
    jacobian = linear_jacobian(arm, q)[..., :2, :]
    return _defect(transpose(jacobian) @ jacobian)


@formula(
    "000.iso",
    source="note 000, section 6",
    quantity="isotropy_defect",
    robots=("planar2r", "planar2r_rods", "planar3r"),
    latex=r"\fixed{\text{rows}} \text{ orthogonal and of equal length: } J J^T = a I",
    printed=Printed(
        _of_columns,
        "J J^T = a I is right, its words are not: they speak of columns, which are orthogonal too "
        "for a square J only (n columns of m < n entries never are: shown on the 3R arm in x, y)",
        r"\wrong{\text{columns}} \text{ orthogonal and of equal length: } J J^T = a I",
        robots=("planar3r",),
    ),
)
def isotropy_defect(arm: Arm, q: Array) -> Array:
    """How far J is from isotropic: its rows orthogonal and equally long."""
    jacobian = linear_jacobian(arm, q)[..., :2, :]
    return _defect(jacobian @ transpose(jacobian))


_isotropic_2r = partial(
    formula, "000.iso2r", source="note 000, section 6", robots=("planar2r", "planar2r_rods")
)


@_isotropic_2r(
    part="3J",
    quantity="jacobian_tool[:2]",
    latex=r"{}^3J = \begin{pmatrix} l_1 s_2 & 0 \\ l_1 c_2 + l_2 & l_2 \end{pmatrix}",
)
def planar_2r_tip_jacobian(arm: Arm, q: Array) -> Array:
    """Jacobian of the planar 2R arm in the tip's axes."""
    return tip_jacobian(arm, q)


@_isotropic_2r(
    part="orthogonal",
    source="note 000, section 6.1",
    quantity="orthogonal_columns_cosine",
    latex=r"c_2 = -\frac{l_2}{l_1}",
)
def orthogonal_cosine(arm: Arm, q: Array) -> Array:
    """cos theta2 where the columns are orthogonal."""
    l1, l2 = lengths(arm)
    return np.full(np.shape(q)[:-1], -l2 / l1)


@_isotropic_2r(
    part="equal",
    source="note 000, section 6.2",
    quantity="equal_columns_cosine",
    latex=r"c_2 = -\frac{l_1}{2 l_2}",
)
def equal_cosine(arm: Arm, q: Array) -> Array:
    """cos theta2 where the columns are equally long."""
    l1, l2 = lengths(arm)
    return np.full(np.shape(q)[:-1], -l1 / (2.0 * l2))


def _one_angle(arm: Arm, q: Array) -> Array:
    _, l2 = lengths(arm)
    known = np.sin(columns(q)[1]) > 0.0
    return np.where(known[..., None, None], l2 * np.eye(2), np.nan)


@_isotropic_2r(
    part="135 degrees",
    quantity="isotropic_jacobian",
    robots="planar2r_isotropic",
    latex=r"l_1 = \sqrt2\, l_2,\ \theta_2 = \fixed{\pm} 135^\circ \Rightarrow"
    r" {}^3J = \begin{pmatrix} \fixed{\pm} l_2 & 0 \\ 0 & l_2 \end{pmatrix}",
    printed=Printed(
        _one_angle,
        "theta2 = -135° is isotropic too and not mentioned (there the printed form gives nothing)",
        r"l_1 = \sqrt2\, l_2,\ \theta_2 = \wrong{135^\circ} \Rightarrow"
        r" {}^3J = \begin{pmatrix} l_2 & 0 \\ 0 & l_2 \end{pmatrix}",
    ),
)
def isotropic_jacobian(arm: Arm, q: Array) -> Array:
    """The isotropic 2R arm: l1 = √2 l2 and theta2 = ±135°."""
    _, l2 = lengths(arm)
    side = np.sign(np.sin(columns(q)[1]))
    return matrix([side * l2, 0.0], [0.0, l2])


# -------- Note 000, inverse kinematics: Newton's step, pseudo-inverses, gradient descent
# Newton and gradient are shown on the planar 3R arm with x = (x, y, theta); the step length alpha
# of the gradient is 0.1.


def _miss(arm: Arm, q: Array, target: Array) -> Array:
    """x_d - f(q)."""
    l1, l2, l3 = lengths(arm)
    q1, q2, q3 = columns(q)
    x = l1 * np.cos(q1) + l2 * np.cos(q1 + q2) + l3 * np.cos(q1 + q2 + q3)
    y = l1 * np.sin(q1) + l2 * np.sin(q1 + q2) + l3 * np.sin(q1 + q2 + q3)
    return target - vector(x, y, q1 + q2 + q3)


@formula(
    "000.newton",
    source="note 000, inverse kinematics 1",
    quantity="newton_step",
    robots="planar3r",
    latex=r"q_{k+1} = q_k + J^{-1}(q_k)\,[x_d - f(q_k)]",
)
def newton_step(arm: Arm, q: Array, target: Array) -> Array:
    """Newton's step."""
    inverse = np.linalg.inv(planar_3r_jacobian(arm, q))
    return q + apply(inverse, _miss(arm, q, target))


@formula(
    "000.newton",
    part="stop",
    source="note 000, inverse kinematics 1",
    quantity="newton_stops",
    robots="planar3r",
    latex=r"\lVert x_d - f(q) \rVert < \varepsilon \ \text{ or }\ "
    r"\lVert q_{k+1} - q_k \rVert < \varepsilon",
)
def newton_stops(arm: Arm, q: Array, target: Array) -> Array:
    """What the two stopping rules look at."""
    step = newton_step(arm, q, target) - q
    return vector(np.linalg.norm(_miss(arm, q, target), axis=-1), np.linalg.norm(step, axis=-1))


def _tool_columns(arm: Arm, q: Array) -> Array:
    return geometric_jacobian(arm, q, tool_pose(arm, q)[..., :3, 3])


def _left(arm: Arm, q: Array, twist: Array) -> Array:
    jacobian = _tool_columns(arm, q)
    across = transpose(jacobian)
    try:
        inverse = np.linalg.inv(across @ jacobian)
    except np.linalg.LinAlgError:  # exactly singular: the printed form has no value
        return np.full((*np.shape(q)[:-1], arm.n), np.nan)
    return apply(inverse @ across, twist)


@formula(
    "000.pinv",
    part="redundant",
    source="note 000, inverse kinematics 1",
    quantity="least_rates",
    robots="panda",
    latex=r"\dot q = \fixed{J^T (J J^T)^{-1}}\, \dot x",
    printed=Printed(
        _left,
        "(J^T J)^-1 J^T is the left inverse, for fewer joints than coordinates; with more joints "
        "J^T J is singular and J^T (J J^T)^-1 is meant",
        r"\dot q = \wrong{(J^T J)^{-1} J^T}\, \dot x",
    ),
)
def right_inverse(arm: Arm, q: Array, twist: Array) -> Array:
    """Shortest joint rates of a redundant arm."""
    jacobian = _tool_columns(arm, q)
    across = transpose(jacobian)
    return apply(across @ np.linalg.inv(jacobian @ across), twist)


@formula(
    "000.pinv",
    part="too few joints",
    source="note 000, inverse kinematics 1",
    quantity="least_rates",
    robots=("spatial3r", "planar3r"),
    remark="normal equations square the condition number: shown away from singular poses",
    latex=r"\dot q = (J^T J)^{-1} J^T \dot x",
)
def left_inverse(arm: Arm, q: Array, twist: Array) -> Array:
    """Joint rates of least error where the arm has fewer joints than the task."""
    return _left(arm, q, twist)


_gradient = partial(formula, "000.grad", source="note 000, inverse kinematics 2", robots="planar3r")


@_gradient(part="loss", quantity="loss", latex=r"g(q) = \tfrac12 \lVert x_d - f(q) \rVert^2")
def loss(arm: Arm, q: Array, target: Array) -> Any:
    """The loss that gradient descent lowers."""
    miss = _miss(arm, q, target)
    return 0.5 * np.sum(miss * miss, axis=-1)


@_gradient(
    part="gradient",
    quantity="loss_gradient",
    latex=r"\nabla g = -J^T [x_d - f(q)]",
    remark="the brace under (df/dq)^T is labelled J; it is J^T",
)
def loss_gradient(arm: Arm, q: Array, target: Array) -> Array:
    """Gradient of the loss."""
    return -apply(transpose(planar_3r_jacobian(arm, q)), _miss(arm, q, target))


@_gradient(part="step", quantity="gradient_step", latex=r"q_{k+1} = q_k + \alpha J^T [x_d - f(q)]")
def gradient_step(arm: Arm, q: Array, target: Array) -> Array:
    """Step of gradient descent."""
    return q - 0.1 * loss_gradient(arm, q, target)
