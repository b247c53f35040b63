"""Scene: an arm on the page, and what a script adds to it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.errors import StateError
from kinlab.files import write_text
from kinlab.kinematics import fk
from kinlab.robot import Robot
from kinlab.states import joint_vector
from kinlab.viewer import shapes
from kinlab.viewer.arm import draw_arm, reach
from kinlab.viewer.dh_picture import DHPicture, draw_dh
from kinlab.viewer.framing import look_at, round_step
from kinlab.viewer.page_spec import arm_spec, linear_rank
from kinlab.viewer.recorder import new_scene
from kinlab.viewer.static_page import page_html


class Scene:
    def __init__(self, robot: Robot, q: ArrayLike | None = None, *, meshes: bool = True) -> None:
        self.robot = robot
        start = np.clip(np.zeros(robot.n), robot.lower, robot.upper)
        q = start if q is None else joint_vector(robot, q, "q")
        self._vis, self.recorder = new_scene()
        size = reach(robot)
        notes = draw_arm(self._vis, robot, q, meshes=meshes)
        picture = DHPicture() if robot.table is None else draw_dh(self._vis, robot, robot.table)
        self._vis["/Grid"].delete()
        self._vis["/Axes"].delete()
        shapes.floor(self._vis["/meshcat/floor"], 1.2 * size, round_step(size))
        self._vis["/Background"].set_property("top_color", [1.0, 1.0, 1.0])
        self._vis["/Background"].set_property("bottom_color", [0.86, 0.9, 0.94])
        points = _joint_origins(robot, q)
        camera = look_at(points, np.array([1.0, -1.3, 0.7]), 0.3 * size)
        self.spec = arm_spec(robot, q, picture, camera, notes)
        for kind, color in (("velocity", 0x00897B), ("force", 0xEF6C00)):
            path = f"/meshcat/ellipsoids/{kind}"
            shapes.ball(self._vis[path], 1.0, shapes.paint(color, 0.4))
            self.spec["ellipsoids"].append(
                {"kind": kind, "path": path, "size": 0.2 * size, "rank": linear_rank(robot)}
            )
            self.spec["groups"][kind] = [path]
            self.spec["checks"].append([kind, f"{kind} ellipsoid"])
        self.spec["trace"] = "/meshcat/trace"
        self.spec["groups"]["trace"] = ["/meshcat/trace"]
        self.spec["checks"].append(["trace", "tool trace"])

    def html(self) -> str:
        return page_html(self.spec, self.recorder.commands())

    def save(self, path: str | Path) -> None:
        write_text(path, self.html())


def _joint_origins(robot: Robot, q):
    import pinocchio as pin
    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, q)
    return np.array([np.zeros(3), *(m.translation for m in list(data.oMi)[1:]), fk(robot, q)[:3, 3]])
