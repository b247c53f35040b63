"""The arm itself: Pinocchio's MeshcatVisualizer, with the links nested joint in joint.

Pinocchio places each body in the world; a page without a server needs each body in its joint,
so that moving one joint node carries along everything behind it.
"""

from __future__ import annotations

import sys
import threading
from importlib.abc import MetaPathFinder
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.model.library import example_robots
from kinlab.model.robot import Robot
from kinlab.viewer.drawing import shapes
from kinlab.viewer.drawing.bodies import DrawnBodies

ROOT = "/meshcat/robot"
_STAND_IN = (0.57, 0.64, 0.68, 1.0)
_GHOSTLY = 0.3
"""Opacity of a ghost."""


class _Withheld(MetaPathFinder):
    """One module that this thread does not find."""

    def __init__(self, name: str) -> None:
        self.name, self.thread = name, threading.get_ident()

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> None:
        """Nothing but for the one name."""
        if name == self.name and threading.get_ident() == self.thread:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)


def _visualizer() -> Any:
    """Pinocchio's MeshcatVisualizer, without what its package loads for a viewer that is not there.

    The package's viewer by way of viser loads trimesh, which takes longer than all else of a first
    view, and only then finds that viser is not installed. Without trimesh it goes on alike.
    """
    withheld = [] if find_spec("viser") else [_Withheld("trimesh")]
    sys.meta_path[:0] = withheld
    try:
        from pinocchio.visualize import MeshcatVisualizer
    finally:
        for finder in withheld:
            sys.meta_path.remove(finder)
    return MeshcatVisualizer


class NestedVisualizer(_visualizer()):  # type: ignore[misc]
    """Pinocchio's visualizer, drawing each body below the node of the joint that carries it."""

    def __init__(self, model: Any, visuals: Any, root: str) -> None:
        super().__init__(model, visual_model=visuals)
        self.paths = joint_paths(model, root)

    def getViewerNodeName(self, geometry_object: Any, geometry_type: Any) -> str:
        """Node of a body: its joint's node, then ``visuals``."""
        path = self.paths[geometry_object.parentJoint]
        return f"{path}/visuals/{_node_name(geometry_object.name)}"

    def updatePlacements(self, geometry_type: Any) -> None:
        """Places every body in its joint; this does not depend on q."""
        for body in self.visual_model.geometryObjects:
            local = body.placement.homogeneous @ np.diag([*body.meshScale, 1.0])
            self.viewer[self.getViewerNodeName(body, geometry_type)].set_transform(local)

    def display(self, q: Array) -> None:
        """Moves the joint nodes to q, (n,)."""
        pin.forwardKinematics(self.model, self.data, q)
        for joint, path in enumerate(self.paths):
            if joint:
                parent = self.data.oMi[self.model.parents[joint]]
                self.viewer[path].set_transform(parent.actInv(self.data.oMi[joint]).homogeneous)


def joint_paths(model: Any, root: str = ROOT) -> list[str]:
    """Node path of each joint of a model, the base first."""
    paths = [root]
    for joint in range(1, model.njoints):
        paths.append(f"{paths[model.parents[joint]]}/{_node_name(model.names[joint])}")
    return paths


def draw_arm(scene: Any, robot: Robot, q: Array, *, meshes: bool = True) -> list[str]:
    """Draws a robot's links in a scene.

    Args:
        scene: a ``meshcat.Visualizer``.
        robot: the robot.
        q: joint positions, (n,).
        meshes: draw the URDF's meshes; otherwise a rod from joint to joint in their place.

    Returns:
        One line for each mesh that is missing or of a kind that no browser can show.
    """
    visuals, bare, notes = _visual_model(robot, meshes)
    _draw(scene, robot, q, visuals, bare, ROOT, None)
    return notes


def draw_ghost(scene: Any, robot: Robot, q: Array, root: str, color: int) -> None:
    """Draws a robot see-through and without meshes, in one colour, below node ``root``."""
    visuals, bare, _ = _visual_model(robot, False)
    rgba = [*shapes.rgb(color), _GHOSTLY]
    _draw(scene, robot, q, visuals, bare, root, rgba)


def _draw(
    scene: Any,
    robot: Robot,
    q: Array,
    visuals: Any,
    bare: set[int],
    root: str,
    rgba: list[float] | None,
) -> None:
    pictured = NestedVisualizer(robot.model, visuals, root)
    pictured.initViewer(viewer=scene)
    pictured.loadViewerModel(rootNodeName=root, visual_color=rgba)
    pictured.display(q)
    radius = 0.02 * reach(robot)
    red, green, blue, opacity = rgba or _STAND_IN
    material = shapes.paint(shapes.hexadecimal((red, green, blue)), opacity)
    for joint in sorted(bare):
        end = (
            robot.model.jointPlacements[joint + 1].translation
            if joint < robot.n
            else robot.model.frames[robot.tool].placement.translation
        )
        node = scene[f"{pictured.paths[joint]}/visuals/stand_in"]
        shapes.rod(node["rod"], np.zeros(3), end, radius, material)
        shapes.ball(node["ball"], 1.3 * radius, material)


def reach(robot: Robot) -> float:
    """Sum of the distances between successive joints and of all strokes, metres."""
    total = float(np.linalg.norm(robot.model.frames[robot.tool].placement.translation))
    for joint in range(2, robot.model.njoints):
        total += float(np.linalg.norm(robot.model.jointPlacements[joint].translation))
    for joint, (low, high) in enumerate(zip(robot.lower, robot.upper, strict=True), 1):
        if not motion_subspace(robot.model, joint)[3:].any():
            total += max(abs(low), abs(high))
    return total or 1.0


def motion_subspace(model: Any, joint: int) -> Array:
    """Twist of joint ``joint`` per unit rate in its own frame, linear first, (6,)."""
    record = model.joints[joint]
    data = record.createData()
    record.calc(data, np.zeros(model.nq))
    return np.asarray(data.S).reshape(6)


def _visual_model(robot: Robot, meshes: bool) -> tuple[Any, set[int], list[str]]:
    """The bodies that can be drawn, the joints left without any, and what is missing."""
    if not robot.urdf:
        return pin.GeometryModel(), set(range(1, robot.model.njoints)), []
    bodies = DrawnBodies(robot, _mesh_folders(robot), meshes)
    return bodies.visuals, bodies.bare - {0}, bodies.notes


def _mesh_folders(robot: Robot) -> list[Path]:
    """Where mesh names may start: the robot's folder, those above it, and example-robot-data."""
    folders = []
    if robot.folder is not None:
        folders += [robot.folder, *robot.folder.parents]
    known = example_robots()
    if known:
        # package:// names of example-robot-data start above its folder
        path = next(iter(known.values())).path.resolve()
        share = next(p for p in path.parents if p.name == "share")
        folders.append(share)
    return folders


def _node_name(name: str) -> str:
    plain = str(name).replace("/", "_")
    return "visuals_" if plain == "visuals" else plain
