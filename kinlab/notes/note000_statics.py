"""Note 000, statics: force and moment propagation, joint torques, tau = J^T F.

Throughout (f, n) is the wrench that the tool exerts on the environment.
"""

from __future__ import annotations

import numpy as np

from kinlab.formula import Printed, formula
from kinlab.notes.arm import Arm, Array, apply, cross, turn
from kinlab.notes.frames import craig, geometric_jacobian, link_transforms, tool_pose
from kinlab.notes.note000_jacobian import tool_jacobian, turn_rows


def tip_wrench(arm: Arm, q: Array, wrench: Array) -> tuple[Array, Array]:
    """(f, n) of frame n: the tool's wrench turned into its axes and moved to its origin."""
    last = craig(arm)
    up = last.tool[:3, :3] @ turn(tool_pose(arm, q)[..., :3, :3])
    force = apply(up, wrench[..., :3])
    return force, apply(up, wrench[..., 3:]) + cross(last.tool[:3, 3], force)


@formula(
    "000.force",
    source="note 000, statics",
    quantity="static_wrenches",
    robots="serial",
    latex=r"{}^if_i = {}^i_{i+1}R\,{}^{i+1}f_{i+1},\quad"
    r" {}^in_i = {}^i_{i+1}R\,{}^{i+1}n_{i+1} + {}^iP_{i+1} \times {}^if_i",
)
def static_wrenches(arm: Arm, q: Array, wrench: Array) -> Array:
    """Forces and moments from the tool to the base, passive components included."""
    steps = link_transforms(craig(arm), q)
    force, moment = tip_wrench(arm, q, wrench)
    result = [np.concatenate([force, moment], axis=-1)]
    for i in reversed(range(arm.n - 1)):
        rotation, place = steps[..., i + 1, :3, :3], steps[..., i + 1, :3, 3]
        force = apply(rotation, force)
        moment = apply(rotation, moment) + cross(place, force)
        result.append(np.concatenate([force, moment], axis=-1))
    return np.stack(result[::-1], axis=-2)


@formula(
    "000.tau",
    source="note 000, statics",
    quantity="statics",
    robots="serial",
    latex=r"\tau_i = {}^in_i \cdot \hat Z \ \text{(revolute)},\quad"
    r" \tau_i = {}^if_i \cdot \hat Z \ \text{(prismatic)}",
)
def joint_torques(arm: Arm, q: Array, wrench: Array) -> Array:
    """Joint torques are the z components of moment or force."""
    wrenches = static_wrenches(arm, q, wrench)
    return arm.sign * np.where(arm.prismatic, wrenches[..., 2], wrenches[..., 5])


@formula(
    "000.JTF",
    part="tool",
    source="note 000, statics",
    quantity="statics_tool",
    robots="serial",
    latex=r"\tau = {}^nJ^T\,{}^nF",
)
def tool_statics(arm: Arm, q: Array, wrench: Array) -> Array:
    """tau = J^T F with both in tool axes."""
    return apply(turn(tool_jacobian(arm, q)), wrench)


def _base_jacobian(arm: Arm, q: Array) -> Array:
    return geometric_jacobian(arm, q, tool_pose(arm, q)[..., :3, 3])


def _force_only(arm: Arm, q: Array, wrench: Array) -> Array:
    force = apply(tool_pose(arm, q)[..., :3, :3], wrench[..., :3])
    turned = np.concatenate([force, wrench[..., 3:]], axis=-1)
    return apply(turn(_base_jacobian(arm, q)), turned)


@formula(
    "000.JTF",
    part="base",
    source="note 000, statics 2",
    quantity="statics_tool",
    robots="serial",
    latex=r"\tau = {}^0J^T\,{}^0F,\quad {}^0F ="
    r" \fixed{\begin{pmatrix} {}^0_nR & 0 \\ 0 & {}^0_nR \end{pmatrix}} {}^nF",
    printed=Printed(
        _force_only,
        "a 3x3 R cannot turn the 6-vector F: it is blkdiag(R, R) (shown: R on the force alone)",
        r"\tau = {}^0J^T\,{}^0F,\quad {}^0F = \wrong{{}^0_nR}\,{}^nF",
        robots=("spatial",),
    ),
    remark="the columns of ^0_nR are (X_n Y_n Z_n); the note writes (X_4 Y_4 Z_4) beside ^0_nR",
)
def base_statics(arm: Arm, q: Array, wrench: Array) -> Array:
    """tau = J^T F in base axes, the wrench given in tool axes."""
    rotation = tool_pose(arm, q)[..., :3, :3]
    turned = turn_rows(rotation, wrench[..., None])[..., 0]
    return apply(turn(_base_jacobian(arm, q)), turned)
