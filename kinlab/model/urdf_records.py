"""A URDF as plain records: every number read strictly, every default written out.

What is ambiguous is refused: programs differ in what they make of an element given twice, of an
attribute with a typing error, or of ``<axis/>`` without its direction.
"""

from __future__ import annotations

import difflib
import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import UrdfError, near
from kinlab.model.link import check_inertia
from kinlab.model.rotations import rpy_matrix
from kinlab.model.strict_numbers import strict_numbers

MOVING = ("revolute", "continuous", "prismatic")
_MULTI = ("floating", "planar", "spherical")
_KNOWN = (*MOVING, *_MULTI, "fixed")
TENSOR = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
WIDE_TURN = 2.0 * math.pi
"""Limit given to a continuous joint, either way, so that it is an ordinary revolute one."""

EXTENSION = "kinlab"
"""Element that carries what URDF has no place for: gravity, armature, and inertias that no body can
have but are meant."""

_WAY_OUT = f'correct it, or put <{EXTENSION} unphysical="true"/> into <robot> to use it as it is'

MOST_ELEMENTS = 1000
"""Most joints of a file; a humanoid with hands has 150."""

_MOST = 1e9
"""Largest length, angle, mass or moment: beyond it, products of them lose all digits."""

_LIMITLESS = 1e17
"""Largest joint limit; some files write 1e16 for none."""

_ELEMENTS = {
    "robot": ("link", "joint", "material", "transmission", "gazebo", EXTENSION),
    "link": ("inertial", "visual", "collision"),
    "joint": ("parent", "child", "origin", "axis", "limit", "dynamics", "mimic"),
    "inertial": ("origin", "mass", "inertia"),
}
"""Children whose misspelling would silently change the robot."""

_STRICT = {
    "origin": ("xyz", "rpy"),
    "axis": ("xyz",),
    "mass": ("value",),
    "inertia": TENSOR,
}
"""Elements with these attributes and no others."""

_LOOSE = {
    "limit": ("lower", "upper", "effort", "velocity"),
    "dynamics": ("damping", "friction"),
    "mimic": ("joint", "multiplier", "offset"),
}
"""Elements to which dialects add attributes of their own."""

_LIKENESS = 0.8


@dataclass(frozen=True, eq=False)
class Inertial:
    """Mass of a link.

    Attributes:
        mass: kg.
        com: centre of mass in the link's frame, (3,), m.
        rotation: axes of ``inertia`` in the link's frame, (3, 3).
        inertia: about the centre of mass, (3, 3), kg m².
        rpy: the angles of ``rotation``, (3,), rad.
    """

    mass: float
    com: Array
    rpy: Array
    rotation: Array
    inertia: Array


@dataclass(frozen=True, eq=False)
class LinkRecord:
    """One link: its name and mass, if any."""

    name: str
    inertial: Inertial | None


@dataclass(frozen=True, eq=False)
class JointRecord:
    """One joint.

    Attributes:
        name, kind, parent, child: as the file has them.
        rpy: turn in the parent link at q = 0, (3,), rad.
        placement: pose in the parent link at q = 0, (4, 4).
        axis: unit direction in the joint's frame, (3,).
        lower, upper: limits, rad or m.
        velocity, effort: limits, SI.
        damping, friction: N m s/rad and N m, or N s/m and N.
        mimics: whether it follows another joint.
    """

    name: str
    kind: str
    parent: str
    child: str
    rpy: Array
    placement: Array
    axis: Array = field(default_factory=lambda: np.array([1.0, 0.0, 0.0]))
    lower: float = 0.0
    upper: float = 0.0
    velocity: float = 0.0
    effort: float = 0.0
    damping: float = 0.0
    friction: float = 0.0
    mimics: bool = False


@dataclass(frozen=True, eq=False)
class UrdfTree:
    """All that kinlab takes from a URDF.

    Attributes:
        name: of the robot.
        links: by name, in the order of the file.
        joints: by name, in the order of the file.
        root: name of the link that has no parent.
        gravity: (3,), m/s².
        armature: by joint, kg m² or kg.
        unphysical: whether the file says that inertias that no body can have are meant.
    """

    name: str
    links: dict[str, LinkRecord]
    joints: dict[str, JointRecord]
    root: str
    gravity: Array
    armature: dict[str, float]
    unphysical: bool

    def below(self) -> dict[str, list[JointRecord]]:
        """Joints by parent link."""
        found: dict[str, list[JointRecord]] = defaultdict(list)
        for joint in self.joints.values():
            found[joint.parent].append(joint)
        return found

    def above(self) -> dict[str, JointRecord]:
        """The joint that carries each link but the root."""
        return {joint.child: joint for joint in self.joints.values()}

    def links_behind(self, link: str) -> list[str]:
        """A link and all links behind it, breadth first."""
        below = self.below()
        found = [link]
        for name in found:
            found += [joint.child for joint in below[name]]
        return found


def read_tree(root: Any, place: str) -> UrdfTree:
    """Reads the records and checks that they are one tree.

    Args:
        root: the lxml element ``<robot>``.
        place: what to call the file in messages.

    Raises:
        UrdfError: what is wrong, with the link or joint it is wrong in.
    """
    _check_spelling(root, place)
    counted = len(root.findall("joint"))
    if counted > MOST_ELEMENTS:
        raise UrdfError(f"{place}: {counted} joints; at most {MOST_ELEMENTS} are read")
    links = {
        element.get("name"): _link(element, f"{place}: link {element.get('name')!r}")
        for element in _named(root, "link", place)
    }
    joints: dict[str, JointRecord] = {}
    parents: dict[str, str] = {}
    for element in _named(root, "joint", place):
        joint = _joint(element, links, f"{place}: joint {element.get('name')!r}")
        if joint.child in parents:
            raise UrdfError(
                f"{place}: link {joint.child!r} has two parents (second joint {joint.name!r})"
            )
        parents[joint.child] = joint.parent
        joints[joint.name] = joint
    extension = _extension(root, joints, place)
    base = _root_link(list(links), parents, place)
    return UrdfTree(root.get("name") or "", links, joints, base, *extension)


def check_moved_inertias(tree: UrdfTree, links: set[str], place: str) -> None:
    """Refuses tensors that no mass can have, in the links that the arm moves.

    Published robot files are full of such tensors in links that stand on the floor, where no
    computation sees them.

    Raises:
        UrdfError: naming the link.

    Warns:
        KinlabWarning: a tensor that only rounding keeps from being a body's.
    """
    if tree.unphysical:
        return
    for name, link in tree.links.items():
        if link.inertial is not None and name in links:
            where = f"{place}: link {name!r}"
            check_inertia(link.inertial.inertia, where, UrdfError, _WAY_OUT)


def read_origin(element: Any, where: str) -> tuple[Array, Array]:
    """xyz and rpy of an element's ``<origin>``, zero where it has none.

    Raises:
        UrdfError: given twice, or not three finite numbers each.
    """
    origin = _only(element, "origin", where)
    if origin is None:
        return np.zeros(3), np.zeros(3)
    xyz, rpy = (
        read_numbers(origin.get(key), 3, (0.0, 0.0, 0.0), f"{where}: origin {key}")
        for key in ("xyz", "rpy")
    )
    return xyz, rpy


def read_numbers(
    text: str | None, count: int, default: tuple[float, ...], where: str, most: float = _MOST
) -> Array:
    """Reads ``count`` finite numbers from an attribute, (count,).

    Raises:
        UrdfError: another count, not numbers, NaN, infinity, or beyond ``most``.
    """
    if text is None:
        return np.array(default, dtype=float)
    values = strict_numbers(text, count, where, UrdfError)
    _check_size(values, where, most)
    return values


def check_sizes(tree: UrdfTree, place: str) -> None:
    """Refuses records with numbers that no arm has: what the reader asks of each number it reads.

    Raises:
        UrdfError: naming the link or joint.
    """
    for name, link in tree.links.items():
        if link.inertial is not None:
            body = link.inertial
            values = np.array([body.mass, *body.com, *body.inertia.ravel()])
            _check_size(values, f"{place}: link {name!r}: inertial")
    for name, joint in tree.joints.items():
        _check_size(joint.placement, f"{place}: joint {name!r}: origin xyz")
        limits = np.array([joint.lower, joint.upper])
        _check_size(limits, f"{place}: joint {name!r}: limits", _LIMITLESS)
    _check_size(tree.gravity, f"{place}: gravity")


def _check_size(values: Array, where: str, most: float = _MOST) -> None:
    largest = float(np.max(np.abs(values)))
    if largest > most:
        raise UrdfError(f"{where}: {largest:g} is beyond {most:g}, more than any arm has")


def _only(element: Any, tag: str, where: str) -> Any:
    """The one child of that tag, its attributes checked, or None."""
    found = element.findall(tag)
    if len(found) > 1:
        raise UrdfError(f"{where}: <{tag}> is given {len(found)} times; keep one")
    if not found:
        return None
    known = _STRICT.get(tag, _LOOSE.get(tag, ()))
    for key in found[0].attrib:
        if not known or key in known:
            continue
        if tag in _STRICT or difflib.get_close_matches(key, known, 1, _LIKENESS):
            choices = near(key, known)
            raise UrdfError(f"{where}: <{tag}> has an unknown attribute {key!r}; {choices}")
    return found[0]


def _check_spelling(root: Any, place: str) -> None:
    if any("xacro" in element.tag for element in root.iter()):
        raise UrdfError(f"{place}: it holds xacro macros; run xacro on it first")
    for element in (root, *root.findall("link"), *root.findall("joint"), *root.iter("inertial")):
        known = _ELEMENTS[element.tag]
        for child in element:
            if child.tag in known:
                continue
            like = difflib.get_close_matches(child.tag, known, 1, _LIKENESS)
            if like:
                within = f"<{element.tag}> {element.get('name') or ''}".strip()
                raise UrdfError(
                    f"{place}: {within}: unknown element <{child.tag}>; did you mean <{like[0]}>?"
                )


def _named(root: Any, tag: str, place: str) -> list[Any]:
    elements = root.findall(tag)
    check_names(tag, [element.get("name") for element in elements], place)
    if not elements and tag == "link":
        raise UrdfError(f"{place}: it has no links")
    return list(elements)


def check_names(tag: str, names: Iterable[str | None], place: str) -> None:
    """Refuses names of links or joints that programs read differently, or that stand twice.

    Raises:
        UrdfError: naming the first.
    """
    seen: set[str] = set()
    for name in names:
        if not name:
            raise UrdfError(f"{place}: a <{tag}> has no name")
        if not name.isprintable() or name != name.strip():
            raise UrdfError(
                f"{place}: {tag} {name!r}: a name must not hold control characters or begin or "
                "end with a blank"
            )
        if name in seen:
            raise UrdfError(f"{place}: {tag} {name!r} is defined twice")
        seen.add(name)


def _root_link(links: list[str], parents: dict[str, str], place: str) -> str:
    sound: set[str] = set()
    for link in links:
        way: list[str] = []
        on_way: set[str] = set()
        here = link
        while here in parents and here not in sound:
            way.append(here)
            on_way.add(here)
            here = parents[here]
            if here in on_way:
                ring = " -> ".join([*way[way.index(here) :], here])
                raise UrdfError(f"{place}: the links form a loop: {ring}; a URDF must be a tree")
        sound.update(way)
    roots = [link for link in links if link not in parents]
    if len(roots) > 1:
        shown = ", ".join(roots[:12]) + (" ..." if len(roots) > 12 else "")
        raise UrdfError(f"{place}: it has {len(roots)} roots: {shown}; join them")
    return roots[0]


def _link(element: Any, where: str) -> LinkRecord:
    inertial = _only(element, "inertial", where)
    return LinkRecord(element.get("name"), None if inertial is None else _inertial(inertial, where))


def _inertial(inertial: Any, where: str) -> Inertial:
    xyz, rpy = read_origin(inertial, where)
    mass = _only(inertial, "mass", where)
    if mass is None:
        raise UrdfError(f"{where}: <inertial> has no <mass>")
    if mass.get("value") is None:
        raise UrdfError(f"{where}: <mass> has no value")
    value = float(read_numbers(mass.get("value"), 1, (), f"{where}: mass")[0])
    if value < 0:
        raise UrdfError(f"{where}: mass is {value:g}; it must be >= 0")
    tensor = _only(inertial, "inertia", where)
    if tensor is None:
        raise UrdfError(f"{where}: <inertial> has no <inertia>")
    xx, xy, xz, yy, yz, zz = (
        float(read_numbers(tensor.get(key), 1, (0.0,), f"{where}: {key}")[0]) for key in TENSOR
    )
    moments = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return Inertial(value, xyz, rpy, rpy_matrix(*rpy), moments)


def _joint(element: Any, links: dict[str, LinkRecord], where: str) -> JointRecord:
    ends = []
    for tag in ("parent", "child"):
        end = _only(element, tag, where)
        link = None if end is None else end.get("link")
        if not link:
            raise UrdfError(f"{where}: <{tag} link=...> is missing")
        if link not in links:
            raise UrdfError(f"{where}: {tag} link {link!r} does not exist; {near(link, links)}")
        ends.append(link)
    kind = element.get("type")
    if kind not in _KNOWN:
        raise UrdfError(f"{where}: type {kind!r} is unknown; {near(str(kind), _KNOWN)}")
    xyz, rpy = read_origin(element, where)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rpy_matrix(*rpy), xyz
    mimics = _only(element, "mimic", where) is not None
    moves = _motion(element, kind, where) if kind in MOVING else {}
    return JointRecord(
        element.get("name"), kind, ends[0], ends[1], rpy, pose, mimics=mimics, **moves
    )


def _motion(element: Any, kind: str, where: str) -> dict[str, Any]:
    """What a joint that moves has beside its place: its axis, losses and limits."""
    dynamics, limit = _only(element, "dynamics", where), _only(element, "limit", where)
    found: dict[str, Any] = {"axis": _axis(_only(element, "axis", where), where)}
    for key in ("damping", "friction"):
        found[key] = _amount(dynamics, key, f"{where}: {key}")
    wide = {"lower": -WIDE_TURN, "upper": WIDE_TURN}
    if limit is None:
        if kind != "continuous":
            raise UrdfError(f"{where}: <limit> is missing; a {kind} joint must have one")
        return found | wide | {"velocity": 10.0, "effort": 1000.0}
    for key in ("lower", "upper"):
        read = read_numbers(limit.get(key), 1, (0.0,), f"{where}: limit {key}", _LIMITLESS)
        found[key] = float(read[0])
    if kind == "continuous":
        found |= wide
    if found["lower"] > found["upper"]:
        raise UrdfError(f"{where}: lower {found['lower']:g} is above upper {found['upper']:g}")
    for key in ("velocity", "effort"):
        found[key] = _amount(limit, key, f"{where}: limit {key}")
    for key in ("velocity", "effort"):
        if limit.get(key) is None:
            raise UrdfError(f"{where}: <limit> has no {key}; a {kind} joint must have one")
    return found


def _amount(element: Any, key: str, where: str) -> float:
    """An attribute that is not negative, 0 where it is absent."""
    if element is None:
        return 0.0
    value = float(read_numbers(element.get(key), 1, (0.0,), where, math.inf)[0])
    if value < 0:
        raise UrdfError(f"{where} is negative")
    return value


def _axis(element: Any, where: str) -> Array:
    if element is None:
        return np.array([1.0, 0.0, 0.0])
    if element.get("xyz") is None:
        raise UrdfError(f'{where}: <axis> has no xyz; write xyz="0 0 1"')
    direction = read_numbers(element.get("xyz"), 3, (), f"{where}: axis", math.inf)
    if not direction.any():
        raise UrdfError(f"{where}: axis is 0 0 0; it must have a direction")
    direction = direction / np.max(np.abs(direction))  # first, so that no square overflows
    unit: Array = direction / np.linalg.norm(direction)
    return unit


def _extension(
    root: Any, joints: dict[str, JointRecord], place: str
) -> tuple[Array, dict[str, float], bool]:
    where = f"{place}: <{EXTENSION}>"
    standard = (0.0, 0.0, -9.81)
    extension = _only(root, EXTENSION, place)
    if extension is None:
        return np.array(standard), {}, False
    gravity = read_numbers(extension.get("gravity"), 3, standard, f"{where} gravity")
    armature: dict[str, float] = {}
    for element in extension.findall("joint"):
        name = element.get("name") or ""
        if name not in joints:
            raise UrdfError(f"{where}: joint {name!r} does not exist; {near(name, joints)}")
        if name in armature:
            raise UrdfError(f"{where}: joint {name!r} is given twice")
        armature[name] = _amount(element, "armature", f"{where} armature of {name!r}")
    meant = extension.get("unphysical", "false")
    if meant not in ("true", "false"):
        raise UrdfError(f"{where}: unphysical is {meant!r}; it must be true or false")
    return gravity, armature, meant == "true"
