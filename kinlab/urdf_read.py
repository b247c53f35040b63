"""Reading a URDF: everything that Pinocchio would accept without a word is refused here.

Pinocchio takes NaN, zero axes, negative masses, impossible inertias, reversed limits and links
with two parents silently, and reports anything else as one generic error. Each is caught here
by name, before the engine sees the file.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from kinlab.arrays import Array
from kinlab.errors import UrdfError, near
from kinlab.files import read_text
from kinlab.inertia import check_inertia

MOVING = ("revolute", "continuous", "prismatic")
_MULTI = ("floating", "planar", "spherical")
_KNOWN = (*MOVING, *_MULTI, "fixed")
_TENSOR = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
WIDE_TURN = 2.0 * math.pi
"""Limit given to a continuous joint, either way, so that it is an ordinary revolute one."""


def parse(text: str, place: str) -> Any:
    """Parses URDF text without ever fetching or expanding anything.

    Args:
        text: the XML.
        place: what to call it in messages.

    Returns:
        The lxml root element, comments dropped.

    Raises:
        UrdfError: not XML, a document type or entity declaration, or the root is not <robot>.
    """
    from lxml import etree

    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise UrdfError(
            f"{place}: document type and entity declarations are not accepted; remove <!DOCTYPE>"
        )
    parser = etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        remove_comments=True,
        remove_pis=True,
    )
    try:
        root = etree.fromstring(text.encode("utf-8"), parser)
    except etree.XMLSyntaxError as problem:
        raise UrdfError(f"{place}: not XML: {problem.msg}") from None
    if root.tag != "robot":
        raise UrdfError(f"{place}: the root element is <{root.tag}>; a URDF starts with <robot>")
    return root


def load_source(path_or_xml: str | Path) -> tuple[str, Path | None]:
    """URDF text and, where it came from a file, that file.

    Raises:
        FileError: the file cannot be read.
    """
    if isinstance(path_or_xml, str) and path_or_xml.lstrip("\ufeff \t\r\n").startswith("<"):
        return path_or_xml, None
    file = Path(path_or_xml)
    return read_text(file), file


def check(root: Any, place: str) -> str:
    """Checks a URDF's links, joints and tree.

    Args:
        root: the element from :func:`parse`.
        place: what to call the file in messages.

    Returns:
        The name of the root link.

    Raises:
        UrdfError: what is wrong, with the link or joint it is wrong in.
    """
    links = _names(root, "link", place)
    _names(root, "joint", place)
    for link in root.findall("link"):
        inertial = link.find("inertial")
        if inertial is not None:
            _check_inertial(inertial, f"{place}: link {link.get('name')!r}")
    parents: dict[str, str] = {}
    for joint in root.findall("joint"):
        name = joint.get("name")
        where = f"{place}: joint {name!r}"
        ends = []
        for tag in ("parent", "child"):
            element = joint.find(tag)
            link = None if element is None else element.get("link")
            if not link:
                raise UrdfError(f"{where}: <{tag} link=...> is missing")
            if link not in links:
                raise UrdfError(f"{where}: {tag} link {link!r} does not exist; {near(link, links)}")
            ends.append(link)
        if ends[1] in parents:
            raise UrdfError(f"{place}: link {ends[1]!r} has two parents (second joint {name!r})")
        parents[ends[1]] = ends[0]
        _check_joint(joint, where)
    return _root_link(links, parents, place)


def _names(root: Any, tag: str, place: str) -> list[str]:
    names: list[str] = []
    for element in root.findall(tag):
        name = element.get("name")
        if not name:
            raise UrdfError(f"{place}: a <{tag}> has no name")
        if name in names:
            raise UrdfError(f"{place}: {tag} {name!r} is defined twice")
        names.append(name)
    if not names and tag == "link":
        raise UrdfError(f"{place}: it has no links")
    return names


def _root_link(links: list[str], parents: dict[str, str], place: str) -> str:
    for link in links:
        seen = [link]
        while seen[-1] in parents:
            up = parents[seen[-1]]
            if up in seen:
                ring = " -> ".join([*seen[seen.index(up) :], up])
                raise UrdfError(f"{place}: the links form a loop: {ring}; a URDF must be a tree")
            seen.append(up)
    roots = [link for link in links if link not in parents]
    if len(roots) > 1:
        raise UrdfError(f"{place}: it has {len(roots)} roots: {', '.join(roots)}; join them")
    return roots[0]


def numbers(text: str | None, count: int, default: tuple[float, ...], where: str) -> Array:
    """Reads ``count`` finite numbers from an attribute.

    Raises:
        UrdfError: another count, not numbers, NaN or infinity.
    """
    if text is None:
        return np.array(default)
    try:
        values = np.array([float(word) for word in text.split()])
    except ValueError:
        raise UrdfError(f"{where}: {text!r} are not numbers") from None
    if values.shape != (count,):
        raise UrdfError(f"{where}: {len(values)} numbers; expected {count}")
    if not np.isfinite(values).all():
        raise UrdfError(f"{where}: {text!r}; every number must be finite")
    return values


def _check_origin(element: Any, where: str) -> None:
    origin = element.find("origin")
    if origin is not None:
        for key in ("xyz", "rpy"):
            numbers(origin.get(key), 3, (0.0, 0.0, 0.0), f"{where}: origin {key}")


def _check_inertial(inertial: Any, where: str) -> None:
    _check_origin(inertial, where)
    mass = inertial.find("mass")
    if mass is None:
        raise UrdfError(f"{where}: <inertial> has no <mass>")
    value = numbers(mass.get("value"), 1, (math.nan,), f"{where}: mass")[0]
    if math.isnan(value):
        raise UrdfError(f"{where}: <mass> has no value")
    if value < 0:
        raise UrdfError(f"{where}: mass is {value:g}; it must be >= 0")
    tensor = inertial.find("inertia")
    if tensor is None:
        raise UrdfError(f"{where}: <inertial> has no <inertia>")
    for key in _TENSOR:
        numbers(tensor.get(key), 1, (0.0,), f"{where}: {key}")


def check_moved_inertias(root: Any, links: set[str], place: str) -> None:
    """Refuses tensors that no mass can have, in the links that the arm moves.

    Published robot files are full of such tensors in links that stand on the floor, where no
    computation sees them.

    Raises:
        UrdfError: naming the link.
    """
    for link in root.findall("link"):
        inertial = link.find("inertial")
        if inertial is not None and link.get("name") in links:
            tensor = inertial.find("inertia")
            xx, xy, xz, yy, yz, zz = (float(tensor.get(key) or 0.0) for key in _TENSOR)
            inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
            check_inertia(inertia, f"{place}: link {link.get('name')!r}", UrdfError)


def _check_joint(joint: Any, where: str) -> None:
    kind = joint.get("type")
    if kind not in _KNOWN:
        raise UrdfError(f"{where}: type {kind!r} is unknown; {near(str(kind), _KNOWN)}")
    _check_origin(joint, where)
    if kind not in MOVING:
        return
    axis = joint.find("axis")
    text = None if axis is None else axis.get("xyz")
    direction = numbers(text, 3, (1.0, 0.0, 0.0), f"{where}: axis")
    if not direction.any():
        raise UrdfError(f"{where}: axis is 0 0 0; it must have a direction")
    limit = joint.find("limit")
    if kind == "continuous":
        return
    if limit is None:
        raise UrdfError(f"{where}: <limit> is missing; a {kind} joint must have one")
    lower, upper = (
        numbers(limit.get(k), 1, (0.0,), f"{where}: limit {k}")[0] for k in ("lower", "upper")
    )
    if lower > upper:
        raise UrdfError(f"{where}: lower {lower:g} is above upper {upper:g}")
    for key in ("velocity", "effort"):
        if numbers(limit.get(key), 1, (0.0,), f"{where}: limit {key}")[0] < 0:
            raise UrdfError(f"{where}: limit {key} is negative")


def children(root: Any) -> dict[str, list[Any]]:
    """Joints of a checked URDF by parent link."""
    below: dict[str, list[Any]] = defaultdict(list)
    for joint in root.findall("joint"):
        below[joint.find("parent").get("link")].append(joint)
    return below


def links_behind(root: Any, link: str) -> list[str]:
    """A link and all links behind it."""
    below = children(root)
    found = [link]
    for name in found:
        found += [joint.find("child").get("link") for joint in below[name]]
    return found


def missing_meshes(root: Any, folders: list[Path]) -> Iterator[str]:
    """One line for each mesh that is not on the disk.

    Args:
        root: the URDF.
        folders: where ``package://`` and relative names may start.

    Yields:
        ``link 'x': mesh 'y' is missing``.
    """
    for link in root.findall("link"):
        for mesh in link.iter("mesh"):
            name = mesh.get("filename") or ""
            if mesh_file(name, folders) is None:
                yield f"link {link.get('name')!r}: mesh {name!r} is missing"


def mesh_file(name: str, folders: list[Path]) -> Path | None:
    """The file a URDF's mesh name stands for, or None where it does not exist."""
    plain = name.removeprefix("package://").removeprefix("model://").removeprefix("file://")
    if Path(plain).is_absolute():
        return Path(plain) if Path(plain).is_file() else None
    for folder in folders:
        if plain and (folder / plain).is_file():
            return folder / plain
    return None
