"""An own reading of a URDF: expat, plain numpy, no part of kinlab and no engine.

Defaults are those of the URDF specification: an origin not given is none, an axis not given is
x, a product of inertia not given is zero, the first of several like elements counts. Angles are
fixed-axis roll, pitch, yaw. Joints beside the way to the tool stand at zero.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass, field

import numpy as np

MOVING = ("revolute", "continuous", "prismatic")
XML_SPACE = " \t\r\n"


class Unreadable(Exception):
    """The document has no evident meaning: whoever accepts it answers something invented."""


@dataclass
class Joint:
    name: str
    kind: str
    parent: str
    child: str
    place: np.ndarray
    axis: np.ndarray
    lower: float
    upper: float
    mimic: bool


@dataclass
class Body:
    mass: float
    com: np.ndarray
    inertia: np.ndarray


@dataclass
class Tree:
    joints: list[Joint]
    bodies: dict[str, Body]
    links: list[str]
    gravity: np.ndarray
    armature: dict[str, float] = field(default_factory=dict)


def number(text: str) -> float:
    """A number's evident value: what Python reads, never NaN, infinity or beyond a double."""
    try:
        value = float(text)
    except ValueError:
        raise Unreadable(f"{text!r} is no number") from None
    if not math.isfinite(value):
        raise Unreadable(f"{text!r} is not finite")
    return value


def numbers(text: str | None, size: int, default: tuple[float, ...] | None) -> np.ndarray:
    if text is None:
        if default is None:
            raise Unreadable("a number is missing")
        return np.array(default, dtype=float)
    words = text.split()
    if len(words) != size:
        raise Unreadable(f"{text!r}: {len(words)} numbers, not {size}")
    return np.array([number(word) for word in words])


def rotation(roll: float, pitch: float, yaw: float) -> np.ndarray:
    a, b, c = math.cos(roll), math.cos(pitch), math.cos(yaw)
    d, e, f = math.sin(roll), math.sin(pitch), math.sin(yaw)
    return np.array(
        [
            [b * c, d * e * c - a * f, a * e * c + d * f],
            [b * f, d * e * f + a * c, a * e * f - d * c],
            [-e, d * b, a * b],
        ]
    )


def _place(element: ET.Element) -> np.ndarray:
    out = np.eye(4)
    origin = element.find("origin")
    if origin is not None:
        out[:3, 3] = numbers(origin.get("xyz"), 3, (0, 0, 0))
        out[:3, :3] = rotation(*numbers(origin.get("rpy"), 3, (0, 0, 0)))
    return out


def read(text: str) -> Tree:
    """The tree that the text describes.

    Raises:
        Unreadable: it describes none.
    """
    try:
        root = ET.fromstring(text.encode("utf-8", "surrogatepass"))
    except (ET.ParseError, ValueError) as problem:
        raise Unreadable(f"not XML: {problem}") from None
    if root.tag != "robot":
        raise Unreadable("no <robot>")
    links, bodies = [], {}
    for link in root.findall("link"):
        name = link.get("name")
        if not name or name in links:
            raise Unreadable("a link without a name, or two of one name")
        links.append(name)
        inertial = link.find("inertial")
        if inertial is None:
            continue
        mass, tensor = inertial.find("mass"), inertial.find("inertia")
        if mass is None or tensor is None:
            raise Unreadable("an inertial without mass or inertia")
        m = float(numbers(mass.get("value"), 1, None)[0])
        if m < 0:
            raise Unreadable("a negative mass")
        place = _place(inertial)
        xx, xy, xz, yy, yz, zz = (
            float(numbers(tensor.get(key), 1, (0.0,))[0])
            for key in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
        )
        local = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        turn = place[:3, :3]
        bodies[name] = Body(m, place[:3, 3], turn @ local @ turn.T)
    joints: list[Joint] = []
    for element in root.findall("joint"):
        name, kind = element.get("name"), element.get("type")
        if not name or any(joint.name == name for joint in joints):
            raise Unreadable("a joint without a name, or two of one name")
        ends = []
        for tag in ("parent", "child"):
            end = element.find(tag)
            if end is None or end.get("link") not in links:
                raise Unreadable("a joint without a parent or child")
            ends.append(str(end.get("link")))
        axis, lower, upper = np.array([1.0, 0.0, 0.0]), -math.inf, math.inf
        if kind in MOVING:
            given = element.find("axis")
            raw = numbers(None if given is None else given.get("xyz"), 3, (1, 0, 0))
            size = float(np.max(np.abs(raw)))
            if size == 0:
                raise Unreadable("an axis without a direction")
            raw = raw / size
            axis = raw / math.sqrt(float(raw @ raw))
            if kind != "continuous":
                limit = element.find("limit")
                if limit is None:
                    raise Unreadable("no limit")
                lower, upper = (
                    float(numbers(limit.get(key), 1, (0.0,))[0]) for key in ("lower", "upper")
                )
                if lower > upper:
                    raise Unreadable("lower above upper")
        elif kind not in ("fixed", "floating", "planar", "spherical"):
            raise Unreadable(f"type {kind!r}")
        joints.append(
            Joint(name, str(kind), *ends, _place(element), axis, lower, upper,
                  element.find("mimic") is not None)
        )  # fmt: skip
    children = [joint.child for joint in joints]
    if len(set(children)) != len(children):
        raise Unreadable("two parents")
    if len([link for link in links if link not in children]) != 1:
        raise Unreadable("not one root")
    gravity, armature = np.array([0.0, 0.0, -9.81]), {}
    own = root.find("kinlab")
    if own is not None:
        gravity = numbers(own.get("gravity"), 3, (0, 0, -9.81))
        for element in own.findall("joint"):
            armature[str(element.get("name"))] = float(
                numbers(element.get("armature"), 1, (0.0,))[0]
            )
    return Tree(joints, bodies, links, gravity, armature)


def chain_to(tree: Tree, tool: str) -> list[Joint]:
    """All joints from the root to the tool."""
    above = {joint.child: joint for joint in tree.joints}
    out: list[Joint] = []
    while tool in above:
        out.append(above[tool])
        tool = out[-1].parent
        if len(out) > len(tree.joints):
            raise Unreadable("a loop")
    return out[::-1]


def answers(tree: Tree, tool: str, q: np.ndarray) -> dict[str, np.ndarray]:
    """Pose of the tool, mass matrix and gravity torques at q, with the size of their parts."""
    moving = [joint for joint in chain_to(tree, tool) if joint.kind in MOVING]
    value = dict(zip([joint.name for joint in moving], q, strict=True))
    root = next(link for link in tree.links if link not in {j.child for j in tree.joints})
    pose = {root: np.eye(4)}
    behind: dict[str, tuple[int, ...]] = {root: ()}
    origin: dict[str, np.ndarray] = {}
    axis: dict[str, np.ndarray] = {}
    order = {joint.name: i for i, joint in enumerate(moving)}
    todo = [root]
    while todo:
        link = todo.pop()
        for joint in tree.joints:
            if joint.parent != link:
                continue
            at = pose[link] @ joint.place
            x = value.get(joint.name, 0.0)
            step = np.eye(4)
            if joint.kind in ("revolute", "continuous"):
                k = joint.axis
                skew = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
                step[:3, :3] += math.sin(x) * skew + (1 - math.cos(x)) * skew @ skew
            elif joint.kind == "prismatic":
                step[:3, 3] = x * joint.axis
            pose[joint.child] = at @ step
            behind[joint.child] = behind[link]
            if joint.name in order:
                behind[joint.child] += (order[joint.name],)
                origin[joint.name], axis[joint.name] = at[:3, 3], at[:3, :3] @ joint.axis
            todo.append(joint.child)
    n = len(moving)
    mass, gravity = np.zeros((n, n)), np.zeros(n)
    size_mass, size_gravity = np.float64(0.0), np.float64(0.0)
    for link, body in tree.bodies.items():
        if link not in pose or not behind[link]:
            continue
        turn = pose[link][:3, :3]
        centre = pose[link][:3, 3] + turn @ body.com
        linear, angular = np.zeros((3, n)), np.zeros((3, n))
        for i in behind[link]:
            joint = moving[i]
            if joint.kind == "prismatic":
                linear[:, i] = axis[joint.name]
            else:
                angular[:, i] = axis[joint.name]
                linear[:, i] = np.cross(axis[joint.name], centre - origin[joint.name])
        inertia = turn @ body.inertia @ turn.T
        mass += body.mass * linear.T @ linear + angular.T @ inertia @ angular
        gravity -= body.mass * linear.T @ tree.gravity
        arm = (
            1.0
            + np.abs(centre).max()
            + max((float(np.abs(origin[moving[i].name]).max()) for i in behind[link]), default=0.0)
        )
        size_mass += body.mass * arm**2 + float(np.abs(body.inertia).max())
        size_gravity += body.mass * arm * float(np.abs(tree.gravity).max())
    for i, joint in enumerate(moving):
        mass[i, i] += tree.armature.get(joint.name, 0.0)
    far = max(float(np.abs(joint.place[:3, 3]).max()) for joint in tree.joints)
    return {
        "fk": pose[tool],
        "mass_matrix": mass,
        "gravity_torques": gravity,
        "fk size": np.array(max(1.0, far, float(np.abs(q).max()))),
        "mass_matrix size": np.array(max(1.0, size_mass)),
        "gravity_torques size": np.array(max(1.0, size_gravity)),
    }
