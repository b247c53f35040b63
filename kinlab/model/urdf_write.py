"""DH table to URDF: where its joints and links stand, what the arm looks like, and the text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.link import Convention
from kinlab.model.rotations import matrices_rpy
from kinlab.model.urdf_records import EXTENSION

# -------- Where the joints and links of a DH table stand in URDF's terms
# With Tail = Tx(a) Rx(alpha) of a row (the part of its transform behind the joint):
#
# - modified: the row's Tail stands in front of its joint, origin_i = Tail_i Rz(theta) Tz(d), and
#   the URDF link frame is DH frame i;
# - standard: the Tail of row i stands behind joint i, so origin_i = Tail_{i-1} Rz(theta) Tz(d),
#   and DH frame i is a fixed frame behind the joint.
#
# A standard table gives centre and inertia in DH frame i, at the *far* end of the link, so the
# inertial origin in the URDF link frame is Tail_i [1 | com]. Leaving that Tail out changes no
# frame, only M, g and tau.


@dataclass(frozen=True)
class LinkPlacement:
    """Where a DH row's joint and link stand in URDF's terms.

    Attributes:
        origin: the joint in the parent's link frame, at q = 0, (4, 4).
        tail: what stands between this link frame and DH frame i, (4, 4).
    """

    origin: Array
    tail: Array


def placements(table: DHTable) -> list[LinkPlacement]:
    """The joint origins and tails of every row, by the recipe above."""
    result = []
    behind = np.asarray(table.base)
    for link in table.links:
        tail = _tail(link)
        joint = _screw_z(link.d, link.theta)
        if table.convention is Convention.MODIFIED:
            result.append(LinkPlacement(behind @ tail @ joint, np.eye(4)))
            behind = np.eye(4)
        else:
            result.append(LinkPlacement(behind @ joint, tail))
            behind = tail
    return result


def _tail(link: DHLink) -> Array:
    c, s = np.cos(link.alpha), np.sin(link.alpha)
    return np.array(
        [[1.0, 0.0, 0.0, link.a], [0.0, c, -s, 0.0], [0.0, s, c, 0.0], [0.0, 0.0, 0.0, 1.0]]
    )


def _screw_z(d: float, theta: float) -> Array:
    c, s = np.cos(theta), np.sin(theta)
    return np.array([[c, -s, 0.0, 0.0], [s, c, 0.0, 0.0], [0.0, 0.0, 1.0, d], [0.0, 0.0, 0.0, 1.0]])


# -------- What a DH arm looks like: a cylinder for each d, one for each a, a stub for each
#          joint axis

_THICKNESS = 0.018
"""Radius of the rods over the arm's stretched length: a Puma gets 25 mm."""


@dataclass(frozen=True)
class Shape:
    """A cylinder along its own z (or a box), placed in a link frame; metres."""

    origin: Array
    radius: float = 0.0
    length: float = 0.0
    box: tuple[float, float, float] | None = None
    stub: bool = False


def stretched_length(table: DHTable) -> float:
    """Sum of all lengths and strokes of an arm, metres: the scale for drawing it."""
    total = float(np.linalg.norm(np.asarray(table.tool)[:3, 3]))
    for link in table.links:
        total += abs(link.a) + abs(link.d if link.joint == "revolute" else _far_end(link))
    return total or 1.0


def visuals(table: DHTable, places: list[LinkPlacement]) -> list[list[Shape]]:
    """The shapes of the base link and of links 1 to n, each in its URDF link frame.

    Zero lengths draw nothing; signed lengths are drawn on the side they point to.
    """
    radius = _THICKNESS * stretched_length(table)
    n = table.n
    shapes: list[list[Shape]] = [[] for _ in range(n + 1)]
    for i, (link, place) in enumerate(zip(table.links, places, strict=True), 1):
        foot = place.origin @ _shift_z(-link.d)
        if link.joint == "revolute":
            shapes[i - 1].append(Shape(foot, 1.7 * radius, 4.0 * radius, stub=True))
            shapes[i] += _segment(np.array([0.0, 0.0, -link.d]), np.zeros(3), radius)
        else:
            size = (3.4 * radius, 3.4 * radius, 4.0 * radius)
            shapes[i - 1].append(Shape(foot, box=size, stub=True))
            # the rod must reach the joint at the far end of its stroke
            shapes[i] += _segment(np.array([0.0, 0.0, -_far_end(link)]), np.zeros(3), 0.8 * radius)
        # the common normal a lies behind the joint (standard) or in front of the next (modified)
        end = places[i].origin if i < n else place.tail @ np.asarray(table.tool)
        corner = end @ _shift_z(-table.links[i].d) if i < n else end
        shapes[i] += _segment(np.zeros(3), corner[:3, 3], radius)
    first = places[0].origin @ _shift_z(-table.links[0].d)
    shapes[0] += _segment(np.asarray(table.base)[:3, 3], first[:3, 3], radius)
    return shapes


def _far_end(link: DHLink) -> float:
    """The d at the end of a prismatic joint's stroke that lies farther from the joint, metres."""
    assert link.lower is not None and link.upper is not None
    sign = -1.0 if link.flip else 1.0
    return max(link.d + sign * link.lower, link.d + sign * link.upper, key=abs)


def _segment(start: Array, end: Array, radius: float) -> list[Shape]:
    """A cylinder from start to end; nothing where they coincide."""
    along = end - start
    length = float(np.linalg.norm(along))
    if length < 0.2 * radius:
        return []
    z = along / length
    other = np.eye(3)[int(np.argmin(np.abs(z)))]
    x = np.cross(other, z)
    x /= np.linalg.norm(x)
    origin = np.eye(4)
    origin[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    origin[:3, 3] = 0.5 * (start + end)
    return [Shape(origin, radius, length)]


def _shift_z(d: float) -> Array:
    out = np.eye(4)
    out[2, 3] = d
    return out


# -------- DH table to URDF text, through yourdfpy's own classes
# The recipe for origins and inertias is the first part.

BASE_LINK = "base_link"

_MATERIALS = {
    "even_link": (0.33, 0.47, 0.60, 1.0),
    "odd_link": (0.86, 0.47, 0.20, 1.0),
    "joint_axis": (0.20, 0.22, 0.25, 1.0),
}


def written(table: DHTable) -> str:
    """Writes a DH table as URDF.

    Links are named ``base_link``, ``link_1`` ... ``link_n`` and the tool; joints as the table
    names them. A standard table also gets its DH frames, ``dh_1`` ... ``dh_n``, as fixed links.
    Numbers are printed with every digit, so that reading the file back loses nothing.

    Args:
        table: the DH table.

    Returns:
        URDF text. Gravity other than standard, armatures, and that inertias are meant which no body
        can have, stand in a ``<kinlab>`` element, which other tools ignore.
    """
    from yourdfpy import urdf as y  # half a second to import

    places = placements(table)
    shapes = visuals(table, places)
    names = table.joint_names
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
                name=names[i - 1],
                type=link.joint,
                parent=parent,
                child=name,
                origin=place.origin,
                axis=np.array([0.0, 0.0, -1.0 if link.flip else 1.0]),
                limit=y.Limit(
                    effort=link.effort, velocity=link.velocity, lower=link.lower, upper=link.upper
                ),
                dynamics=_friction(link, y),
            )
        )
        parent = name
        if table.convention is Convention.STANDARD:
            _fixed(f"dh_{i}", f"dh_joint_{i}", name, place.tail, links, joints, y)
    tool = places[-1].tail @ np.asarray(table.tool)
    _fixed(table.tool_name, f"{table.tool_name}_joint", parent, tool, links, joints, y)
    return _text(y.URDF(y.Robot(table.name, links, joints), build_scene_graph=False), table, names)


def _inertial(link: DHLink, place: LinkPlacement, y: Any) -> Any:
    inertia = np.asarray(link.inertia)
    if link.mass == 0.0 and not inertia.any():
        return None
    centre = np.eye(4)
    centre[:3, 3] = link.com
    return y.Inertial(origin=place.tail @ centre, mass=link.mass, inertia=inertia)


def _friction(link: DHLink, y: Any) -> Any:
    if link.viscous_friction == 0.0 and link.coulomb_friction == 0.0:
        return None
    return y.Dynamics(damping=link.viscous_friction, friction=link.coulomb_friction)


def _fixed(
    name: str, joint: str, parent: str, origin: Array, links: list[Any], joints: list[Any], y: Any
) -> None:
    links.append(y.Link(name=name))
    joints.append(y.Joint(name=joint, type="fixed", parent=parent, child=name, origin=origin))


def _visuals(shapes: list[Shape], material: str, y: Any) -> list[Any]:
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


def _text(urdf: Any, table: DHTable, names: tuple[str, ...]) -> str:
    from lxml import etree

    root = urdf.write_xml().getroot()
    _write_rotations(root, urdf.robot)
    about = f"DH table {table.name!r}, {table.convention} convention. {table.source}"
    about = "".join(c for c in " ".join(about.split()) if c.isprintable())
    root.insert(0, etree.Comment(f" {about.replace('-', '‐' if '--' in about else '-')} "))
    armatures = {
        name: link.armature for name, link in zip(names, table.links, strict=True) if link.armature
    }
    extension = etree.SubElement(
        root, EXTENSION, gravity=" ".join(repr(float(g)) for g in np.asarray(table.gravity))
    )
    if table.unphysical:
        extension.set("unphysical", "true")
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
    angles_of = matrices_rpy([record.origin[:3, :3] for _, record in pairs])
    for (element, _), angles in zip(pairs, angles_of, strict=True):
        element.find("origin").set("rpy", " ".join(repr(angle + 0.0) for angle in angles))
