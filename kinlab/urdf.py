"""DH table to URDF text, through yourdfpy's own classes.

The recipe for origins and inertias is in :mod:`kinlab.placements`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from kinlab import urdf_shapes
from kinlab.arrays import Array
from kinlab.convention import Convention
from kinlab.dh import DHLink, DHTable
from kinlab.errors import TableError
from kinlab.model.urdf_records import EXTENSION
from kinlab.placements import LinkPlacement, placements
from kinlab.rotations import matrix_rpy

BASE_LINK = "base_link"

_MATERIALS = {
    "even_link": (0.33, 0.47, 0.60, 1.0),
    "odd_link": (0.86, 0.47, 0.20, 1.0),
    "joint_axis": (0.20, 0.22, 0.25, 1.0),
}


def to_urdf(table: DHTable) -> str:
    """Writes a DH table as URDF.

    Links are named ``base_link``, ``link_1`` ... ``link_n`` and the tool; joints as the table
    names them. A standard table also gets its DH frames, ``dh_1`` ... ``dh_n``, as fixed links.
    Numbers are printed with every digit, so that reading the file back loses nothing.

    Args:
        table: the DH table.

    Returns:
        URDF text. Gravity other than standard and armatures stand in a ``<kinlab>`` element,
        which other tools ignore.
    """
    if not isinstance(table, DHTable):
        raise TableError(f"to_urdf: {type(table).__name__} is no DHTable; kl.to_dh makes one")
    from yourdfpy import urdf as y  # half a second to import

    places = placements(table)
    shapes = urdf_shapes.visuals(table, places)
    links = [y.Link(name=BASE_LINK, visuals=_visuals(shapes[0], "even_link", y))]
    joints = []
    parent = BASE_LINK
    for i, (link, place) in enumerate(zip(table.links, places, strict=True), 1):
        name = f"link_{i}"
        links.append(
            y.Link(
                name=name,
                inertial=_inertial(link, place, y),
                visuals=_visuals(shapes[i], "odd_link" if i % 2 else "even_link", y),
            )
        )
        joints.append(
            y.Joint(
                name=table.joint_names[i - 1],
                type=link.joint,
                parent=parent,
                child=name,
                origin=place.origin,
                axis=np.array([0.0, 0.0, -1.0 if link.flip else 1.0]),
                limit=y.Limit(
                    effort=link.effort, velocity=link.velocity, lower=link.lower, upper=link.upper
                ),
            )
        )
        parent = name
        if table.convention is Convention.STANDARD:
            _fixed(f"dh_{i}", f"dh_joint_{i}", name, place.tail, links, joints, y)
    tool = places[-1].tail @ np.asarray(table.tool)
    _fixed(table.tool_name, f"{table.tool_name}_joint", parent, tool, links, joints, y)
    return _text(y.URDF(y.Robot(table.name, links, joints), build_scene_graph=False), table)


def _inertial(link: DHLink, place: LinkPlacement, y: Any) -> Any:
    inertia = np.asarray(link.inertia)
    if link.mass == 0.0 and not inertia.any():
        return None
    centre = np.eye(4)
    centre[:3, 3] = link.com
    return y.Inertial(origin=place.tail @ centre, mass=link.mass, inertia=inertia)


def _fixed(
    name: str, joint: str, parent: str, origin: Array, links: list[Any], joints: list[Any], y: Any
) -> None:
    links.append(y.Link(name=name))
    joints.append(y.Joint(name=joint, type="fixed", parent=parent, child=name, origin=origin))


def _visuals(shapes: list[urdf_shapes.Shape], material: str, y: Any) -> list[Any]:
    drawn = []
    for shape in shapes:
        name = "joint_axis" if shape.stub else material
        paint = y.Material(name=name, color=y.Color(rgba=np.array(_MATERIALS[name])))
        if shape.box is not None:
            geometry = y.Geometry(box=y.Box(size=np.array(shape.box)))
        else:
            geometry = y.Geometry(cylinder=y.Cylinder(radius=shape.radius, length=shape.length))
        drawn.append(y.Visual(origin=shape.origin, geometry=geometry, material=paint))
    return drawn


def _text(urdf: Any, table: DHTable) -> str:
    from lxml import etree

    root = urdf.write_xml().getroot()
    _write_rotations(root, urdf.robot)
    about = f"DH table {table.name!r}, {table.convention} convention. {table.source}"
    about = "".join(c for c in " ".join(about.split()) if c.isprintable())
    root.insert(0, etree.Comment(f" {about.replace('-', '‐' if '--' in about else '-')} "))
    armatures = {
        name: link.armature
        for name, link in zip(table.joint_names, table.links, strict=True)
        if link.armature
    }
    extension = etree.SubElement(
        root, EXTENSION, gravity=" ".join(repr(float(g)) for g in np.asarray(table.gravity))
    )
    for name, armature in armatures.items():
        etree.SubElement(extension, "joint", name=name, armature=repr(armature))
    etree.indent(root, "  ")
    text: str = etree.tostring(root, encoding="unicode", pretty_print=True)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + text


def _write_rotations(root: Any, robot: Any) -> None:
    """Writes the angles anew: yourdfpy's come from a formula that fails in gimbal lock."""
    pairs = []
    for element, link in zip(root.findall("link"), robot.links, strict=True):
        if link.inertial is not None:
            pairs.append((element.find("inertial"), link.inertial))
        pairs.extend(zip(element.findall("visual"), link.visuals, strict=True))
    pairs.extend(zip(root.findall("joint"), robot.joints, strict=True))
    for element, record in pairs:
        angles = matrix_rpy(record.origin[:3, :3])
        element.find("origin").set("rpy", " ".join(repr(angle + 0.0) for angle in angles))
