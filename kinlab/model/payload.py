"""A load in the tool: the same arm with a heavier last link."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinlab.arrays import Array, number, shaped
from kinlab.errors import InertiaError, OptionError, StructureError, already_said
from kinlab.model import urdf_read
from kinlab.model.dh import DHLink, DHTable, with_links
from kinlab.model.library import ArmLike, as_robot
from kinlab.model.link import check_inertia, steiner
from kinlab.model.robot import Robot
from kinlab.model.urdf_engine import write_inertial
from kinlab.model.urdf_records import Inertial


def with_payload(
    robot: ArmLike,
    mass: float,
    com: ArrayLike = (0.0, 0.0, 0.0),
    inertia: ArrayLike | None = None,
) -> Robot:
    """The robot with a body fixed to its tool.

    A robot with a DH table gets a new table: the load becomes part of the last link, by the
    parallel-axis theorem (Siciliano et al., *Robotics*, appendix B.2). One from a URDF gets a link
    ``payload`` fixed to the tool's. Kinematics, limits and friction stay.

    Args:
        robot: the robot; it is not changed.
        mass: of the load, kg.
        com: its centre of mass in the tool frame, (3,), m.
        inertia: its tensor about that centre, with the axes of the tool frame, (3, 3), kg m². Left
            out: a point mass.

    Returns:
        A new robot of the same name and tool.

    Raises:
        OptionError: a mass that is negative or no number.
        InertiaError: a centre or tensor of the wrong shape, or a tensor that no body can have.
    """
    robot = as_robot(robot)
    load = number(mass, "with_payload: mass")
    if load < 0.0:
        raise OptionError(f"with_payload: mass is {load:g}; it must be >= 0")
    centre = shaped(com, (3,), "with_payload: com", InertiaError)
    given = np.zeros((3, 3)) if inertia is None else inertia
    tensor = shaped(given, (3, 3), "with_payload: inertia", InertiaError)
    check_inertia(tensor, "with_payload", InertiaError)
    with already_said():
        return _loaded(robot, load, centre, tensor)


def _loaded(robot: Robot, load: float, centre: Array, tensor: Array) -> Robot:
    if robot.table is not None:
        return Robot.from_dh(_heavier(robot.table, load, centre, tensor))
    source = f"{robot.source}; with a payload of {load:g} kg"
    if not robot.urdf:
        model = _loaded_model(robot, load, centre, tensor)
        return Robot(robot.name, model, robot.tool, "", None, robot.folder, source)
    text = _loaded_urdf(robot, load, centre, tensor)
    chain = urdf_read.read(text, f"robot {robot.name!r} with a payload", robot.tool_name)
    return Robot(robot.name, chain.model, chain.tool, text, None, robot.folder, source)


def _heavier(table: DHTable, mass: float, com: Array, inertia: Array) -> DHTable:
    """The table with a load, given in its tool frame, in its last link."""
    tool, last = np.asarray(table.tool), table.links[-1]
    turn = tool[:3, :3]
    merged = _merged(last, mass, turn @ com + tool[:3, 3], turn @ inertia @ turn.T)
    source = f"{table.source}; with a payload of {mass:g} kg"
    return replace(with_links(table, [*table.links[:-1], merged]), source=source.removeprefix("; "))


def _merged(link: DHLink, mass: float, com: Array, inertia: Array) -> DHLink:
    """A link and a load in its frame as one body."""
    total = link.mass + mass
    if total == 0.0:
        return replace(link, inertia=np.asarray(link.inertia) + inertia)
    centre = (link.mass * np.asarray(link.com) + mass * com) / total
    tensor = np.asarray(link.inertia) + steiner(link.mass, np.asarray(link.com) - centre)
    tensor = tensor + inertia + steiner(mass, com - centre)
    return replace(link, mass=total, com=centre, inertia=0.5 * (tensor + tensor.T))


def _loaded_urdf(robot: Robot, mass: float, com: Array, inertia: Array) -> str:
    from lxml import etree

    root = urdf_read.parse(robot.urdf, f"robot {robot.name!r}")
    taken = {element.get("name") for tag in ("link", "joint") for element in root.findall(tag)}
    name = "payload"
    while taken & {name, f"{name}_joint"}:
        name += "_"
    link = etree.SubElement(root, "link", name=name)
    write_inertial(link, Inertial(mass, com, np.zeros(3), np.eye(3), inertia))
    joint = etree.SubElement(root, "joint", name=f"{name}_joint", type="fixed")
    etree.SubElement(joint, "parent", link=robot.tool_name)
    etree.SubElement(joint, "child", link=name)
    etree.indent(root, "  ")
    text: str = etree.tostring(root, encoding="unicode", pretty_print=True)
    return text


def _loaded_model(robot: Robot, mass: float, com: Array, inertia: Array) -> Any:
    import pinocchio as pin

    model = robot.model.copy()
    tool = model.frames[robot.tool]
    joint = int(tool.parentJoint)
    if joint == 0:
        raise StructureError(f"robot {robot.name!r}: its tool stands on the floor")
    model.inertias[joint] = model.inertias[joint] + tool.placement.act(
        pin.Inertia(mass, com, inertia)
    )
    return model
