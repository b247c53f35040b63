"""The picture that teaches DH: frames, z axes, and each row's a, alpha, d, theta on the arm.

What stands still in a link (triads, z axes, a, alpha) is drawn here; d and theta move with the
joints and are drawn by the page. Lengths and angles along x are red, along z blue.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.model.dh import DHTable
from kinlab.model.link import Convention
from kinlab.model.robot import Robot
from kinlab.viewer.drawing import shapes
from kinlab.viewer.drawing.arm import joint_paths, reach
from kinlab.viewer.drawing.shapes import Label


@dataclass
class DHPicture:
    """What the page needs to know of a drawn DH table.

    Attributes:
        rows: one mapping per DH row, for the page's table and its moving parts.
        groups: names of what is shown together, with the node paths in it.
        labels: texts.
        convention: of the table.
    """

    rows: list[dict[str, Any]] = field(default_factory=list)
    groups: dict[str, list[str]] = field(default_factory=lambda: {"frames": []})
    labels: list[Label] = field(default_factory=list)
    convention: str = ""


def draw_dh(scene: Any, robot: Robot, table: DHTable) -> DHPicture:
    """Draws the frames and rows of a robot's DH table, all hidden until the page shows them.

    Args:
        scene: a ``meshcat.Visualizer`` in which the arm is drawn.
        robot: the arm.
        table: a table of the same arm: the one it was made from, or one read off it.

    Returns:
        What the page needs.
    """
    picture = DHPicture(convention=str(table.convention))
    modified = table.convention is Convention.MODIFIED
    size = reach(robot)
    carriers = Carriers(robot)
    frames = [np.asarray(table.base), *table.frames(np.zeros(table.n))]
    for i, frame in enumerate(frames):
        _frame(scene, carriers, picture, i, frame, size)
    tool = carriers.place(scene, "tool_frame", table.n, frames[-1] @ np.asarray(table.tool))
    shapes.triad(scene[tool], 0.09 * size)
    picture.groups["frames"].append(tool)
    picture.labels.append(Label(tool, (0, 0, 0), "tool", "frames"))
    for i, link in enumerate(table.links, 1):
        before = frames[i - 1]
        foot = before @ _x_screw(link.a, link.alpha) if modified else before
        path = carriers.place(scene, f"dh_row_{i}", i - 1, foot)
        # a and alpha stand in front of the joint (modified) or behind it (standard)
        x_holder, x_frame = i - 1, before
        if not modified:
            x_holder, x_frame = i, frames[i] @ _x_screw(-link.a, -link.alpha)
        x_path = carriers.place(scene, f"dh_x_{i}", x_holder, x_frame)
        number = i - 1 if modified else i
        group = f"dh{i - 1}"
        _common_normal(scene, picture, x_path, link.a, link.alpha, number, group, size)
        shapes.rod(
            scene[f"{path}/d/rod"],
            np.zeros(3),
            np.array([0.0, 0.0, 1.0]),
            0.005 * size,
            shapes.flat(shapes.BLUE),
        )
        around = [
            carriers.axes[i - 1],
            carriers.axes[i],
            carriers.triads[i - 1],
            carriers.triads[i],
        ]
        picture.groups[group] = [path, x_path, *around]
        picture.rows.append(
            {
                "path": path,
                "name": str(i),
                "joint": i - 1,
                "revolute": link.joint == "revolute",
                "sign": -1.0 if link.flip else 1.0,
                "a": float(link.a),
                "alpha": float(link.alpha),
                "d": float(link.d),
                "theta": float(link.theta),
                "radius": 0.07 * size,
                "color": shapes.BLUE,
            }
        )
    return picture


def frames_only(scene: Any, robot: Robot) -> DHPicture:
    """For an arm without a DH table: a triad in each joint frame of its URDF, and at the tool."""
    picture = DHPicture()
    size = 0.09 * reach(robot)
    for i, path in enumerate(joint_paths(robot.model)):
        shapes.triad(scene[f"{path}/frame"], size)
        picture.groups["frames"].append(f"{path}/frame")
        picture.labels.append(Label(f"{path}/frame", (0, 0, 0), f"{{{i}}}", "frames"))
    tool = f"{joint_paths(robot.model)[-1]}/tool_frame"
    shapes.triad(scene[tool], size)
    scene[tool].set_transform(robot.model.frames[robot.tool].placement.homogeneous)
    picture.groups["frames"].append(tool)
    picture.labels.append(Label(tool, (0, 0, 0), "tool", "frames"))
    return picture


def columns(convention: str) -> list[str]:
    """Headings of a, alpha, d, theta as the convention counts them."""
    behind = "<sub>i-1</sub>" if convention == Convention.MODIFIED else "<sub>i</sub>"
    return [f"a{behind}", f"α{behind}", "d<sub>i</sub>", "θ<sub>i</sub>"]


class Carriers:
    """Hangs frames given in the world at q = 0 below the joint that carries them."""

    def __init__(self, robot: Robot) -> None:
        data = robot.model.createData()
        pin.forwardKinematics(robot.model, data, np.zeros(robot.n))
        self._joints = [placement.homogeneous for placement in data.oMi]
        self._paths = joint_paths(robot.model)
        self.axes: dict[int, str] = {}
        self.triads: dict[int, str] = {}

    def place(self, scene: Any, name: str, joint: int, world: Array) -> str:
        """A node below joint ``joint`` (0: the base) that stands at ``world`` when q = 0."""
        path = f"{self._paths[joint]}/dh/{name}"
        scene[path].set_transform(np.linalg.solve(self._joints[joint], world))
        return path


def _frame(
    scene: Any, carriers: Carriers, picture: DHPicture, i: int, frame: Array, size: float
) -> None:
    """Triad i, and its z axis drawn long, each in a node of its own."""
    triad = carriers.place(scene, f"frame_{i}", i, frame)
    shapes.triad(scene[triad], 0.09 * size)
    picture.groups["frames"].append(triad)
    carriers.triads[i] = triad
    shown = " ".join(f"dh{k}" for k in (i - 1, i) if k >= 0)
    picture.labels.append(Label(triad, (0, 0, 0), f"{{{i}}}", "frames"))
    tips = (("x", (0.1 * size, 0, 0)), ("z", (0, 0, 0.22 * size)))
    for name, at in tips:
        text = f'<span class="{name}">{name}<sub>{i}</sub></span>'
        picture.labels.append(Label(triad, at, text, shown))
    axis = carriers.place(scene, f"axis_{i}", i, frame)
    ends = np.array([[0, 0, -0.15 * size], [0, 0, 0.22 * size]])
    shapes.arrow(scene[axis], ends[0], ends[1], 0.0025 * size, shapes.flat(0x64B5F6))
    carriers.axes[i] = axis


def _common_normal(
    scene: Any,
    picture: DHPicture,
    path: str,
    a: float,
    alpha: float,
    number: int,
    group: str,
    size: float,
) -> None:
    """a as a rod along x, alpha as an arc about x from the one z axis to the next."""
    red = shapes.flat(shapes.RED)
    end = np.array([a, 0.0, 0.0])
    shapes.rod(scene[f"{path}/a"], np.zeros(3), end, 0.005 * size, red)
    if abs(a) > 5e-7:
        text = f'<b class="x">a<sub>{number}</sub> = {shapes.short_number(a, 6)}</b>'
        picture.labels.append(Label(path, 0.5 * end, text, group))
    if abs(alpha) > 1e-6:
        radius = 0.08 * size
        turn = _z_to_x(a, np.sign(alpha))
        scene[f"{path}/alpha"].set_object(shapes.Torus(radius, radius / 36, abs(alpha)), red)
        scene[f"{path}/alpha"].set_transform(turn)
        middle = (turn @ [radius * np.cos(alpha / 2), radius * np.sin(abs(alpha) / 2), 0, 1])[:3]
        degrees = shapes.short_number(np.degrees(alpha), 3)
        text = f'<b class="x">α<sub>{number}</sub> = {degrees}°</b>'
        picture.labels.append(Label(path, middle, text, group))


def _z_to_x(a: float, sign: float) -> Array:
    """Frame at (a, 0, 0) whose x is z and whose z is ±x: an arc from z about x, either way."""
    return np.array(
        [[0.0, 0.0, sign, a], [0.0, -sign, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    )


def _x_screw(a: float, alpha: float) -> Array:
    c, s = np.cos(alpha), np.sin(alpha)
    return np.array([[1.0, 0, 0, a], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])
