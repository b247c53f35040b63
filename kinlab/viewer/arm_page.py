"""What the page must know to move an arm without a server, as plain JSON values."""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab.analysis.structure.axes import frame_origins
from kinlab.analysis.structure.tasks import TASKS, generic_rank
from kinlab.arrays import Array
from kinlab.engine.fast.stacks import jacobian
from kinlab.errors import StructureError
from kinlab.host.language import N_, _
from kinlab.model.extract import as_table
from kinlab.model.robot import Robot
from kinlab.tolerances import TOLERANCES
from kinlab.viewer.drawing.arm import draw_arm, joint_paths, motion_subspace, reach
from kinlab.viewer.drawing.dh_picture import columns, draw_dh, frames_only
from kinlab.viewer.drawing.shapes import add_ellipsoids, empty_spec, look_at, set_stage

DIRECTION = np.array([1.0, -1.3, 0.7])
"""From an arm towards the camera."""

MARGIN = 0.2
"""What is seen around the joints, over the arm's reach."""

_TASKS = {
    "pose": N_("pose"),
    "position": N_("position"),
    "orientation": N_("orientation"),
    "xy": N_("xy"),
    "xytheta": N_("xytheta"),
}
_CONVENTIONS = (N_("standard"), N_("modified"))

_ROWS = ("x", "y", "z", "ωx", "ωy", "ωz")


def draw_page(vis: Any, robot: Robot, q: Array, *, meshes: bool) -> dict[str, Any]:
    """Draws an arm with its DH picture and ellipsoids.

    Args:
        vis: an empty ``meshcat.Visualizer``.
        robot: the arm.
        q: what the sliders start at, (n,).
        meshes: draw the URDF's meshes.

    Returns:
        What ``start`` in page.js takes.
    """
    size = reach(robot)
    set_stage(vis, size)
    camera = look_at(frame_origins(robot, q), DIRECTION, MARGIN * size)
    spec = empty_spec(
        robot.name, _("{n} joints. {source}").format(n=robot.n, source=robot.source).strip(), camera
    )
    spec["notes"] += draw_arm(vis, robot, q, meshes=meshes)
    try:
        picture = draw_dh(vis, robot, as_table(robot))
    except StructureError as problem:  # an arm that DH parameters cannot hold
        picture = frames_only(vis, robot)
        spec["notes"].append(_("no DH table: {reason}").format(reason=problem))
    rows, task = judged_rows(robot)
    model = robot.model
    spec |= {
        "kind": "arm",
        "joints": [joint_json(robot, i) for i in range(1, model.njoints)],
        "tool": _flat(model.frames[robot.tool].placement.homogeneous),
        "rows": rows,
        "task": task,
        "q": [float(x) for x in q],
        "poses": _poses(robot),
        "body": joint_paths(model)[0],
        "dh": picture.rows,
        "dh_convention": _(picture.convention),
        "dh_columns": columns(picture.convention),
        "labels": [label.as_json() for label in picture.labels],
    }
    spec["groups"] |= picture.groups
    spec["shown"].append("frames")
    spec["checks"].insert(0, ["frames", _("frames")])
    add_ellipsoids(vis, spec, size, linear_rank(robot))
    return spec


def judged_rows(robot: Robot) -> tuple[list[int], str]:
    """The rows of J that the read-out judges, and their name.

    Rows that the arm can never move (out of a planar arm's plane) are left out; of what
    remains, everything if there are joints enough, else the position alone.
    """
    rng = np.random.default_rng(0)
    stack = jacobian(robot, rng.uniform(-1.0, 1.0, (20, robot.n)))
    moving = [r for r in range(6) if np.abs(stack[:, r]).max() > TOLERANCES.row_stands_still]
    linear = [r for r in moving if r < 3]
    if len(moving) > robot.n and 0 < len(linear) <= robot.n:
        moving = linear
    names = {rows: name for name, rows in TASKS.items()}
    coordinates = ", ".join(_ROWS[r] for r in moving)
    task = _(_TASKS.get(names.get(tuple(moving), ""), coordinates))
    return moving, _("task {task}").format(task=task)


def linear_rank(robot: Robot) -> int:
    """Number of directions in which the tool's origin can move, 1 to 3, away from singularity."""
    rng = np.random.default_rng(1)
    stack = jacobian(robot, rng.uniform(-1.0, 1.0, (5, robot.n)))
    return max(1, generic_rank(stack, TASKS["position"]))


def joint_json(robot: Robot, i: int) -> dict[str, Any]:
    subspace = motion_subspace(robot.model, i)
    revolute = bool(subspace[3:].any())
    kind = "revolute" if revolute else "prismatic"
    name = robot.joint_names[i - 1]
    plain = "" if name == f"joint_{i}" else name
    return {
        "name": name,
        "label": f"{'θ' if revolute else 'd'}{i} {plain}".strip(),
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
    return {_("Zero"): zero.tolist(), _("Middle"): middle.tolist()}


def _flat(matrix: Array) -> list[float]:
    return [float(x) for x in np.asarray(matrix).reshape(-1)]
