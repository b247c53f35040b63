"""DH table to URDF: where its joints and links stand, what the arm looks like, and the text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.model.dh import DHLink, DHTable
from kinlab.model.link import Convention
from kinlab.model.rotations import matrices_rpy
from kinlab.model.urdf_engine import document, joined, write_origin
from kinlab.model.urdf_records import (
    Inertial,
    JointRecord,
    LinkRecord,
    UrdfTree,
    check_names,
    check_sizes,
)

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


# -------- DH table to records and URDF text

BASE_LINK = "base_link"

_MATERIALS = {
    "even_link": "0.33 0.47 0.6 1.0",
    "odd_link": "0.86 0.47 0.2 1.0",
    "joint_axis": "0.2 0.22 0.25 1.0",
}


def written(table: DHTable) -> str:
    """Writes a DH table as URDF.

    Links are named ``base_link``, ``link_1`` ... ``link_n`` and the tool; joints as the table
    names them. A standard table also gets its DH frames, ``dh_1`` ... ``dh_n``, as fixed links.
    Numbers are printed with every digit, so that reading the file back loses nothing.

    Args:
        table: the DH table.

    Returns:
        URDF text. Gravity, armatures, and that inertias are meant which no body can have, stand in
        a ``<kinlab>`` element, which other tools ignore.

    Raises:
        UrdfError: as :func:`records`.
    """
    return text_of(table, records(table))


def records(table: DHTable) -> UrdfTree:
    """A DH table as the records that reading its URDF gives.

    Raises:
        UrdfError: names that a URDF cannot hold, or numbers that no arm has.
    """
    where, n = f"table {table.name!r}", table.n
    places = placements(table)
    poses = [place.origin for place in places] + [place.tail for place in places]
    poses.append(places[-1].tail @ np.asarray(table.tool))
    rpy = np.array(matrices_rpy([pose[:3, :3] for pose in poses])) + 0.0
    links = [LinkRecord(BASE_LINK, None)]
    joints: list[JointRecord] = []
    armature = {}

    def add(link: LinkRecord, joint: str, kind: str, parent: str, k: int, **moves: Any) -> None:
        links.append(link)
        joints.append(JointRecord(joint, kind, parent, link.name, rpy[k], poses[k], **moves))

    parent = BASE_LINK
    for i, (row, name) in enumerate(zip(table.links, table.joint_names, strict=True)):
        moves = {key: getattr(row, key) for key in ("lower", "upper", "velocity", "effort")}
        moves |= {"damping": row.viscous_friction, "friction": row.coulomb_friction}
        axis = np.array([0.0, 0.0, -1.0 if row.flip else 1.0])
        link = LinkRecord(f"link_{i + 1}", _inertial(row, poses[n + i], rpy[n + i]))
        add(link, name, row.joint, parent, i, axis=axis, **moves)
        if row.armature:
            armature[name] = row.armature
        parent = link.name
        if table.convention is Convention.STANDARD:
            frame = LinkRecord(f"dh_{i + 1}", None)
            add(frame, f"dh_joint_{i + 1}", "fixed", parent, n + i)
    add(LinkRecord(table.tool_name, None), f"{table.tool_name}_joint", "fixed", parent, -1)
    tree = UrdfTree(
        table.name,
        {link.name: link for link in links},
        {joint.name: joint for joint in joints},
        BASE_LINK,
        np.asarray(table.gravity),
        armature,
        table.unphysical,
    )
    check_names("link", [link.name for link in links], where)
    check_names("joint", [joint.name for joint in joints], where)
    check_sizes(tree, where)
    return tree


def _inertial(row: DHLink, tail: Array, rpy: Array) -> Inertial | None:
    inertia = np.asarray(row.inertia)
    if row.mass == 0.0 and not inertia.any():
        return None
    upper = np.triu(inertia)  # as a URDF has it
    centre = np.eye(4)
    centre[:3, 3] = row.com
    com = (tail @ centre)[:3, 3]
    return Inertial(row.mass, com, rpy, tail[:3, :3], upper + np.triu(inertia, 1).T)


def text_of(table: DHTable, tree: UrdfTree) -> str:
    """The text that :func:`written` gives, from the table's records."""
    from lxml import etree

    root = document(tree, table.joint_names)
    about = f"DH table {table.name!r}, {table.convention} convention. {table.source}"
    about = "".join(c for c in " ".join(about.split()) if c.isprintable())
    root.insert(0, etree.Comment(f" {about.replace('-', '‐' if '--' in about else '-')} "))
    links = {element.get("name"): element for element in root.findall("link")}
    shapes = visuals(table, placements(table))
    angles = iter(matrices_rpy([shape.origin[:3, :3] for drawn in shapes for shape in drawn]))
    for i, drawn in enumerate(shapes):
        for shape in drawn:
            visual = etree.SubElement(links[f"link_{i}" if i else BASE_LINK], "visual")
            geometry = etree.SubElement(visual, "geometry")
            if shape.box is not None:
                etree.SubElement(geometry, "box", size=joined(np.array(shape.box)))
            else:
                sizes = {"radius": repr(shape.radius), "length": repr(shape.length)}
                etree.SubElement(geometry, "cylinder", sizes)
            write_origin(visual, shape.origin[:3, 3], np.array(next(angles)) + 0.0)
            name = "joint_axis" if shape.stub else "odd_link" if i % 2 else "even_link"
            material = etree.SubElement(visual, "material", name=name)
            etree.SubElement(material, "color", rgba=_MATERIALS[name])
    etree.indent(root, "  ")
    text: str = etree.tostring(root, encoding="unicode", pretty_print=True)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + text
