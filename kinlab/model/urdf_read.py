"""Reading a URDF: refuses what Pinocchio would accept without a word, and builds its model."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pinocchio as pin

from kinlab.errors import NameUnknownError, StructureError, UrdfError, near
from kinlab.host.files import read_text
from kinlab.model.urdf_engine import build, document
from kinlab.model.urdf_records import MOVING, JointRecord, UrdfTree, check_moved_inertias, read_tree

# -------- URDF text: where it comes from, XML that fetches and expands nothing, and its
#          mesh files


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
    if "\0" in text:
        raise UrdfError(f"{place}: not XML: it holds a null character")
    parser = etree.XMLParser(
        encoding="utf-8",  # what the text was read as, whatever its first line says
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        remove_comments=True,
        remove_pis=True,
    )
    try:
        root = etree.fromstring(text.lstrip("\ufeff \t\r\n").encode("utf-8"), parser)
    except UnicodeEncodeError:
        raise UrdfError(f"{place}: not XML: it holds half a surrogate pair") from None
    except etree.XMLSyntaxError as problem:
        raise UrdfError(f"{place}: not XML: {' '.join(str(problem.msg).split())}") from None
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


# -------- From the text of a URDF to a Pinocchio model of the joints between its root and a
#          tool

_TOOL_NAMES = ("tool", "tool0", "tcp", "end_effector", "ee_link", "eef", "ee", "flange", "hand")
"""Ends of link names that mean a tool, the best first."""


@dataclass(frozen=True)
class URDFChain:
    """A serial chain read from a URDF.

    Attributes:
        name: the robot's name in the file.
        model: the ``pin.Model`` of the chain.
        tool: index of the tool frame in ``model.frames``.
    """

    name: str
    model: Any
    tool: int


def read(text: str, file: str | None, tool: str | None) -> URDFChain:
    """Checks a URDF and builds the chain from its root to a tool.

    Args:
        text: the URDF.
        file: what to call it in messages; None calls it by its robot's name.
        tool: the tool link; None picks one where all moving joints lie on one chain.

    Returns:
        The chain; joints beside it are locked at zero.

    Raises:
        UrdfError, StructureError, NameUnknownError: as :meth:`kinlab.model.robot.Robot.from_urdf`.
    """
    from lxml import etree

    root = parse(text, file or "urdf")
    place = file or f"urdf {root.get('name')!r}"
    tree = read_tree(root, place)
    chain, tip = _chain(tree, tool, place)
    check_moved_inertias(tree, set(tree.links_behind(tree.joints[chain[0]].child)), place)
    text = etree.tostring(document(tree, chain), encoding="unicode")
    model = build(text, tree, chain, place)
    return URDFChain(tree.name, model, int(model.getFrameId(tip, pin.FrameType.BODY)))


def _chain(tree: UrdfTree, tool: str | None, place: str) -> tuple[list[str], str]:
    """Names of the moving joints from root to tool, and the tool link."""
    above = tree.above()
    if tool is None:
        tool = _default_tool(tree, place)
    elif tool not in tree.links:
        raise NameUnknownError(f"{place}: link {tool!r} does not exist; {near(tool, tree.links)}")
    chain = []
    link = tool
    while link in above:
        joint = above[link]
        if joint.kind != "fixed":
            if joint.kind not in MOVING:
                raise StructureError(
                    f"{place}: joint {joint.name!r} is {joint.kind}; joints with several degrees "
                    "of freedom are not accepted between root and tool"
                )
            if joint.mimics:
                raise StructureError(
                    f"{place}: joint {joint.name!r} mimics another joint and lies between "
                    f"root and tool {tool!r}; name a tool in front of it"
                )
            chain.append(joint.name)
        link = joint.parent
    if not chain:
        raise StructureError(f"{place}: no moving joint between {tree.root!r} and tool {tool!r}")
    return chain[::-1], tool


def _default_tool(tree: UrdfTree, place: str) -> str:
    below = tree.below()

    def moving_below(link: str) -> list[JointRecord]:
        found, waiting = [], [link]
        while waiting:
            after = []
            for joint in below[waiting.pop()]:
                if joint.kind == "fixed":
                    after.append(joint.child)
                else:
                    found.append(joint)
            waiting += after[::-1]
        return found

    link = tree.root
    while moving := moving_below(link):
        if len(moving) > 1:
            raise StructureError(
                f"{place}: a tree: after link {link!r} branch the joints "
                f"{', '.join(repr(joint.name) for joint in moving[:6])}; name the tool, one of "
                + ", ".join(repr(tip) for tip in _tips(below, tree.root)[:12])
                + ", or a link on the way (tool=, --tool)"
            )
        link = moving[0].child
    rigid = tree.links_behind(link)
    for end in _TOOL_NAMES:
        for name in rigid:
            if name == end or name.endswith(f"_{end}"):
                return name
    return rigid[-1]


def _tips(below: dict[str, list[JointRecord]], link: str) -> list[str]:
    """Links with nothing behind them, depth first."""
    tips, waiting = [], [link]
    while waiting:
        here = waiting.pop()
        if not below[here]:
            tips.append(here)
        waiting += [joint.child for joint in reversed(below[here])]
    return tips
