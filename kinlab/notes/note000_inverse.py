"""Note 000, inverse kinematics: Newton's step, pseudo-inverses, gradient descent.

Newton and gradient are shown on the planar 3R arm with x = (x, y, theta); the step length alpha
of the gradient is 0.1.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.formula import Printed, formula
from kinlab.notes.arm import Arm, Array, apply, columns, lengths, turn, vector
from kinlab.notes.frames import geometric_jacobian, tool_pose
from kinlab.notes.note000_jacobian import planar_3r_jacobian


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
    across = turn(jacobian)
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
    across = turn(jacobian)
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


@formula(
    "000.grad",
    part="loss",
    source="note 000, inverse kinematics 2",
    quantity="loss",
    robots="planar3r",
    latex=r"g(q) = \tfrac12 \lVert x_d - f(q) \rVert^2",
)
def loss(arm: Arm, q: Array, target: Array) -> Any:
    """The loss that gradient descent lowers."""
    miss = _miss(arm, q, target)
    return 0.5 * np.sum(miss * miss, axis=-1)


@formula(
    "000.grad",
    part="gradient",
    source="note 000, inverse kinematics 2",
    quantity="loss_gradient",
    robots="planar3r",
    latex=r"\nabla g = -J^T [x_d - f(q)]",
    remark="the brace under (df/dq)^T is labelled J; it is J^T",
)
def loss_gradient(arm: Arm, q: Array, target: Array) -> Array:
    """Gradient of the loss."""
    return -apply(turn(planar_3r_jacobian(arm, q)), _miss(arm, q, target))


@formula(
    "000.grad",
    part="step",
    source="note 000, inverse kinematics 2",
    quantity="gradient_step",
    robots="planar3r",
    latex=r"q_{k+1} = q_k + \alpha J^T [x_d - f(q)]",
)
def gradient_step(arm: Arm, q: Array, target: Array) -> Array:
    """Step of gradient descent."""
    return q - 0.1 * loss_gradient(arm, q, target)
