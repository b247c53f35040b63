"""From the text of a URDF to a Pinocchio model of the joints between its root and a tool."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab import urdf_read
from kinlab.errors import NameUnknownError, StructureError, UrdfError, near
from kinlab.urdf import EXTENSION

_TOOL_NAMES = ("tool", "tool0", "tcp", "end_effector", "ee_link", "eef", "ee", "flange", "hand")
"""Ends of link names that mean a tool, the best first."""


@dataclass(frozen=True)
class Chain:
    """A serial chain read from a URDF.

    Attributes:
        name: the robot's name in the file.
        model: the ``pin.Model`` of the chain.
        tool: index of the tool frame in ``model.frames``.
    """

    name: str
    model: Any
    tool: int


def read(text: str, file: str | None, tool: str | None) -> Chain:
    """Checks a URDF and builds the chain from its root to a tool.

    Args:
        text: the URDF.
        file: what to call it in messages; None calls it by its robot's name.
        tool: the tool link; None picks one where all moving joints lie on one chain.

    Returns:
        The chain; joints beside it are locked at zero.

    Raises:
        UrdfError, StructureError, NameUnknownError: as :meth:`kinlab.robot.Robot.from_urdf`.
    """
    root = urdf_read.parse(text, file or "urdf")
    place = file or f"urdf {root.get('name')!r}"
    base = urdf_read.check(root, place)
    joints, tip = _chain(root, base, tool, place)
    first = next(j for j in root.findall("joint") if j.get("name") == joints[0])
    moved = set(urdf_read.links_behind(root, first.find("child").get("link")))
    urdf_read.check_moved_inertias(root, moved, place)
    model = _build(root, joints, place)
    if not model.existFrame(tip, pin.FrameType.BODY):
        raise UrdfError(f"{place}: Pinocchio made no frame for link {tip!r}")
    return Chain(root.get("name") or "", model, int(model.getFrameId(tip, pin.FrameType.BODY)))


def _chain(root: Any, base: str, tool: str | None, place: str) -> tuple[list[str], str]:
    """Names of the moving joints from root to tool, and the tool link."""
    above = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
    links = [link.get("name") for link in root.findall("link")]
    if tool is None:
        tool = _default_tool(root, base, place)
    elif tool not in links:
        raise NameUnknownError(f"{place}: link {tool!r} does not exist; {near(tool, links)}")
    chain = []
    link = tool
    while link in above:
        joint = above[link]
        kind = joint.get("type")
        if kind != "fixed":
            if kind not in urdf_read.MOVING:
                raise StructureError(
                    f"{place}: joint {joint.get('name')!r} is {kind}; joints with several degrees "
                    "of freedom are not accepted between root and tool"
                )
            if joint.find("mimic") is not None:
                raise StructureError(
                    f"{place}: joint {joint.get('name')!r} mimics another joint and lies between "
                    f"root and tool {tool!r}; name a tool in front of it"
                )
            chain.append(joint.get("name"))
        link = joint.find("parent").get("link")
    if not chain:
        raise StructureError(f"{place}: no moving joint between {base!r} and tool {tool!r}")
    return chain[::-1], tool


def _default_tool(root: Any, base: str, place: str) -> str:
    below = urdf_read.children(root)

    def moving_below(link: str) -> list[Any]:
        found = []
        for joint in below[link]:
            if joint.get("type") == "fixed":
                found += moving_below(joint.find("child").get("link"))
            else:
                found.append(joint)
        return found

    link = base
    while moving := moving_below(link):
        if len(moving) > 1:
            raise StructureError(
                f"{place}: a tree: after link {link!r} branch the joints "
                f"{', '.join(repr(j.get('name')) for j in moving[:6])}; name the tool, one of "
                + ", ".join(repr(tip) for tip in _tips(below, base)[:12])
            )
        link = moving[0].find("child").get("link")
    rigid = urdf_read.links_behind(root, link)
    for end in _TOOL_NAMES:
        for name in rigid:
            if name == end or name.endswith(f"_{end}"):
                return name
    return rigid[-1]


def _tips(below: dict[str, list[Any]], link: str) -> list[str]:
    """Links with nothing behind them, depth first."""
    if not below[link]:
        return [link]
    return [t for j in below[link] for t in _tips(below, j.find("child").get("link"))]


def _build(root: Any, chain: list[str], place: str) -> Any:
    from lxml import etree

    extension = root.find(EXTENSION)
    for joint in root.findall("joint"):
        if joint.get("type") == "continuous":
            joint.set("type", "revolute")
            limit = joint.find("limit")
            if limit is None:
                limit = etree.SubElement(joint, "limit", effort="1000.0", velocity="10.0")
            limit.set("lower", repr(-urdf_read.WIDE_TURN))
            limit.set("upper", repr(urdf_read.WIDE_TURN))
        mimic = joint.find("mimic")
        if mimic is not None:
            joint.remove(mimic)
    if extension is not None:
        root.remove(extension)
    try:
        model = pin.buildModelFromXML(etree.tostring(root, encoding="unicode"))
    except (ValueError, RuntimeError) as problem:
        raise UrdfError(f"{place}: Pinocchio cannot read it: {problem}") from None
    locked = [j for j in range(1, model.njoints) if str(model.names[j]) not in chain]
    if locked:
        model = pin.buildReducedModel(model, locked, pin.neutral(model))
    if extension is not None:
        _apply_extension(model, extension, place)
    return model


def _apply_extension(model: Any, extension: Any, place: str) -> None:
    where = f"{place}: <{EXTENSION}>"
    gravity = urdf_read.numbers(extension.get("gravity"), 3, (0, 0, -9.81), f"{where} gravity")
    model.gravity.linear = gravity
    armature = np.zeros(model.nv)
    for element in extension.findall("joint"):
        if model.existJointName(element.get("name") or ""):
            joint = model.joints[model.getJointId(element.get("name"))]
            value = urdf_read.numbers(element.get("armature"), 1, (0.0,), f"{where} armature")
            armature[joint.idx_v] = value[0]
    model.armature = armature
