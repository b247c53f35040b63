"""A DH table's arm and another description of it, over each other, with what is wrong lit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.analysis.structure.axes import frame_origins
from kinlab.arrays import Array
from kinlab.doctor.tables.diagnosis import diagnose_table
from kinlab.doctor.tables.reference.against import poses_of, read_mine, reference_robot
from kinlab.doctor.tables.result import TableDiagnosis
from kinlab.host.language import _
from kinlab.model.dh import DHTable
from kinlab.model.robot import Robot
from kinlab.viewer.arm_page import DIRECTION, MARGIN, joint_json
from kinlab.viewer.drawing import shapes
from kinlab.viewer.drawing.arm import draw_ghost, joint_paths, reach
from kinlab.viewer.drawing.dh_picture import Carriers
from kinlab.viewer.drawing.shapes import look_at
from kinlab.viewer.scene import Scene

_GHOST = 0x00897B
_LIT = 0xD50000


def against_scene(
    mine: Robot | DHTable | str | Path,
    against: Any,
    q: ArrayLike | None = None,
    *,
    tool: str | None = None,
) -> Scene:
    """Draws a table's arm, the reference see-through over it, and the diagnosis.

    Args:
        mine: the table, as for :func:`kinlab.diagnose_table`.
        against: the other description.
        q: joint positions at the start, (n,).
        tool: for a URDF: the link that is the tool.

    Returns:
        The scene. The sliders move both arms; the rows that are wrong are lit red. Where the
        reference is poses, these are drawn, and the repaired arm over the table's.

    Raises:
        KinlabError: as :func:`kinlab.diagnose_table`.
    """
    table = read_mine(mine)
    found = diagnose_table(table, against, tool=tool)
    robot = Robot.from_dh(table)
    scene = Scene(robot, q, meshes=False)
    other = _reference(scene, against, found, tool)
    if other is not None:
        _draw_over(scene, other, _("the repaired table") if other.table is found.repaired else "")
    for part in _wrong(found):
        _highlight(scene, robot, table, part)
    first = _("{verdict} (against {reference}): {sentence}").format(
        verdict=_(found.verdict), reference=found.reference, sentence=found.sentence
    )
    said = [first, *found.told]
    scene._spec["notes"] = [*said, *scene._spec["notes"]]

    return scene


def _reference(scene: Scene, against: Any, found: TableDiagnosis, tool: str | None) -> Robot | None:
    """The arm to draw over the table's; poses are drawn as such."""
    assert found.mine is not None
    poses = poses_of(against, found.mine.n)
    if poses is None:
        other = reference_robot(against, tool)
        return Robot.from_dh(other) if isinstance(other, DHTable) else other
    T = np.asarray(poses[1], dtype=float)
    scene.points("poses", T[:, :3, 3], size=0.03 * reach(scene.robot))
    return Robot.from_dh(found.repaired) if found.repaired is not None else None


def _draw_over(scene: Scene, other: Robot, name: str) -> None:
    """The other arm as a ghost that follows the sliders, where it has as many joints."""
    root = scene._node("reference")
    follows = other.n == scene.robot.n
    draw_ghost(scene._vis, other, scene.q if follows else np.zeros(other.n), root, _GHOST)
    if follows:
        paths = joint_paths(other.model, root)
        scene._spec["followers"] = [
            {**joint_json(other, i), "path": paths[i], "joint": i - 1}
            for i in range(1, other.model.njoints)
        ]
    seen = [frame_origins(scene.robot, scene.q)]
    seen += [frame_origins(other, scene.q)] if follows else []
    camera = look_at(np.concatenate(seen), DIRECTION, MARGIN * reach(scene.robot))
    scene._spec["camera"] = camera.as_json()
    scene._spec["groups"]["reference"] = [root]
    told = _("the other description ({name})").format(name=other.name)
    scene._spec["shown"].append("reference")
    scene._spec["checks"].insert(0, ["reference", name or told])


def _wrong(found: TableDiagnosis) -> list[int | str]:
    """What is to be lit: rows (1-based), ``"base"`` or ``"tool"``."""
    parts: list[int | str] = []
    for cause in found.causes:
        ends: list[int | str] = [end for end in ("base", "tool") if end in cause.column]
        rows: list[int | str] = list(cause.rows)
        if not rows and not ends and cause.column in ("convention", "order", "units"):
            rows = list(found.rows_in_question) or list(range(1, _n(found) + 1))
        parts += [part for part in [*ends, *rows] if part not in parts]
    if not found.causes and not found.agrees:
        parts += list(found.rows_in_question)
    return [part for part in parts if isinstance(part, str) or part <= _n(found)]


def _n(found: TableDiagnosis) -> int:
    assert found.mine is not None
    return found.mine.n


def _highlight(scene: Scene, robot: Robot, table: DHTable, part: int | str) -> None:
    """A red rod from frame to frame over the segment of a row, the base or the tool."""
    frames = [np.asarray(table.base), *table.frames(np.zeros(table.n))]
    size = reach(robot)
    if part == "base":
        joint, start, end = 0, np.eye(4), frames[0]
    elif part == "tool":
        joint, start, end = table.n, frames[-1], frames[-1] @ np.asarray(table.tool)
    else:
        row = int(part)
        # o_{i-1} lies on the axis of joint i (standard), o_i does (modified): the segment is
        # part of link i or i - 1
        joint = row - 1 if table.convention == "modified" else row
        start, end = frames[row - 1], frames[row]
    path = Carriers(robot).place(scene._vis, f"lit_{part}", joint, np.eye(4))
    paint = shapes.paint(_LIT, 0.75)
    ends: list[Array] = [np.array(start[:3, 3]), np.array(end[:3, 3])]
    shapes.rod(scene._vis[f"{path}/rod"], ends[0], ends[1], 0.03 * size, paint)
    for k, place in enumerate(ends):
        node = scene._vis[f"{path}/end{k}"]
        shapes.ball(node, 0.036 * size, paint)
        where = np.eye(4)
        where[:3, 3] = place
        node.set_transform(where)
    groups = scene._spec["groups"]
    groups.setdefault("wrong", []).append(path)
    if len(groups["wrong"]) == 1:
        scene._spec["shown"].append("wrong")
        scene._spec["checks"].insert(0, ["wrong", _("what is wrong")])
    if isinstance(part, int):
        scene._spec["shown"].append(f"dh{part - 1}")
