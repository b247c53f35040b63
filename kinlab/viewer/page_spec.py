"""What the page must know to move an arm without a server, as plain JSON values."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.kinematics import jacobian
from kinlab.robot import Robot
from kinlab.viewer import dh_picture
from kinlab.viewer.arm import joint_paths, motion_subspace, reach
from kinlab.viewer.framing import Camera

_ROWS = ("x", "y", "z", "ωx", "ωy", "ωz")
_STILL = 1e-9
"""A row of J whose entries stay below this over random poses cannot be moved by the arm."""


def arm_spec(
    robot: Robot, q: Array, picture: dh_picture.DHPicture, camera: Camera, notes: list[str]
) -> dict[str, Any]:
    """Kinematics, labels and camera of an arm.

    Args:
        robot: the arm.
        q: what the sliders start at, (n,).
        picture: the DH picture; an empty one where the arm has no table.
        camera: where to look from.
        notes: lines to show under the title.

    Returns:
        What ``start`` in page.js takes.
    """
    model = robot.model
    rows, task = task_rows(robot)
    return {
        "kind": "arm",
        "title": robot.name,
        "subtitle": f"{robot.n} joints. {robot.source}".strip(),
        "notes": notes,
        "joints": [_joint(robot, i) for i in range(1, model.njoints)],
        "tool": _flat(model.frames[robot.tool].placement.homogeneous),
        "rows": rows,
        "task": task,
        "q": [float(x) for x in q],
        "poses": _poses(robot),
        "camera": camera.as_json(),
        "body": joint_paths(model)[0],
        "dh": picture.rows,
        "dh_convention": picture.convention,
        "dh_columns": dh_picture.columns(picture.convention),
        "groups": picture.groups,
        "labels": [label.as_json() for label in picture.labels],
        "shown": ["frames"],
        "checks": [["frames", "frames"]],
        "ellipsoids": [],
        "animation": None,
        "live": False,
    }


def task_rows(robot: Robot) -> tuple[list[int], str]:
    """The rows of J that the read-out judges, and their name.

    Rows that the arm can never move (out of a planar arm's plane) are left out; of what
    remains, everything if there are joints enough, else the position alone.
    """
    rng = np.random.default_rng(0)
    stack = jacobian(robot, rng.uniform(-1.0, 1.0, (20, robot.n)))
    moving = [r for r in range(6) if np.abs(stack[:, r]).max() > _STILL]
    linear = [r for r in moving if r < 3]
    if len(moving) > robot.n and 0 < len(linear) <= robot.n:
        moving = linear
    if moving == [0, 1, 2, 3, 4, 5]:
        return moving, "pose"
    if moving == [0, 1, 2]:
        return moving, "position"
    return moving, ", ".join(_ROWS[r] for r in moving)


def linear_rank(robot: Robot) -> int:
    """Number of directions in which the tool's origin can move, 1 to 3, away from singularity."""
    rng = np.random.default_rng(1)
    stack = jacobian(robot, rng.uniform(-1.0, 1.0, (5, robot.n)))[:, :3]
    sigma = np.linalg.svd(stack, compute_uv=False)
    ranks = (sigma > 1e-6 * np.maximum(sigma[:, :1], _STILL)).sum(axis=1)
    return max(1, int(ranks.max()))


def _joint(robot: Robot, i: int) -> dict[str, Any]:
    subspace = motion_subspace(robot.model, i)
    revolute = bool(subspace[3:].any())
    kind = "revolute" if revolute else "prismatic"
    return {
        "name": robot.joint_names[i - 1],
        "label": f"{'θ' if revolute else 'd'}{i}  {robot.joint_names[i - 1]}",
        "type": kind,
        "axis": [float(x) for x in (subspace[3:] if revolute else subspace[:3])],
        "placement": _flat(robot.model.jointPlacements[i].homogeneous),
        "lower": float(robot.lower[i - 1]),
        "upper": float(robot.upper[i - 1]),
        "path": joint_paths(robot.model)[i],
    }


def _poses(robot: Robot) -> dict[str, list[float]]:
    """Named poses for the page's buttons, within the limits."""
    middle = 0.5 * (robot.lower + robot.upper)
    zero = np.clip(np.zeros(robot.n), robot.lower, robot.upper)
    return {"Zero": zero.tolist(), "Middle": middle.tolist()}


def _flat(matrix: Array) -> list[float]:
    return [float(x) for x in np.asarray(matrix).reshape(-1)]
