"""From records to the engine, and back again to see that nothing changed on the way.

The engine gets a document that is written here: every number with all its digits, every default
written out, joints beside the chain as fixed ones. Then the loaded model is compared with the
records, placement by placement and inertia by inertia.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.errors import StructureError, UrdfError
from kinlab.model.urdf_records import EXTENSION, TENSOR, Inertial, JointRecord, UrdfTree
from kinlab.tolerances import TOLERANCES

MOST_JOINTS = 100
"""Most moving joints of a chain: the engine's memory grows with the cube, 70 MB at 100."""


def document(tree: UrdfTree, chain: Collection[str]) -> Any:
    """The records as a URDF without pictures: the lxml element ``<robot>``.

    Args:
        tree: the records.
        chain: names of the joints that move; all others are written as fixed.

    Returns:
        Numbers stand as ``repr`` prints them, so that reading them gives the same bits.
    """
    from lxml import etree

    root = etree.Element("robot", name=tree.name or "robot")
    for link in tree.links.values():
        element = etree.SubElement(root, "link", name=link.name)
        if link.inertial is not None:
            write_inertial(element, link.inertial)
    for joint in tree.joints.values():
        kind = "prismatic" if joint.kind == "prismatic" else "revolute"
        moves = joint.name in chain
        element = etree.SubElement(root, "joint", name=joint.name, type=kind if moves else "fixed")
        etree.SubElement(element, "parent", link=joint.parent)
        etree.SubElement(element, "child", link=joint.child)
        write_origin(element, joint.placement[:3, 3], joint.rpy)
        if moves:
            etree.SubElement(element, "axis", xyz=joined(joint.axis))
            _write_amounts(element, "limit", joint, ("effort", "velocity", "lower", "upper"))
            if joint.damping or joint.friction:
                _write_amounts(element, "dynamics", joint, ("damping", "friction"))
    extension = etree.SubElement(root, EXTENSION, gravity=joined(tree.gravity))
    if tree.unphysical:
        extension.set("unphysical", "true")
    for name, armature in tree.armature.items():
        etree.SubElement(extension, "joint", name=name, armature=repr(float(armature)))
    return root


def write_origin(element: Any, xyz: Array, rpy: Array) -> None:
    """Adds an ``<origin>`` to an lxml element."""
    from lxml import etree

    etree.SubElement(element, "origin", xyz=joined(xyz), rpy=joined(rpy))


def write_inertial(link: Any, inertial: Inertial) -> None:
    """Adds an ``<inertial>`` to an lxml element ``<link>``."""
    from lxml import etree

    element = etree.SubElement(link, "inertial")
    write_origin(element, inertial.com, inertial.rpy)
    etree.SubElement(element, "mass", value=_digits(inertial.mass))
    entries = inertial.inertia[np.triu_indices(3)]
    etree.SubElement(element, "inertia", dict(zip(TENSOR, map(_digits, entries), strict=True)))


def _write_amounts(element: Any, tag: str, joint: JointRecord, names: tuple[str, ...]) -> None:
    from lxml import etree

    etree.SubElement(element, tag, {name: _digits(getattr(joint, name)) for name in names})


def joined(values: Array) -> str:
    """Numbers as they stand in an attribute."""
    return " ".join(map(_digits, values))


def _digits(value: float) -> str:
    """All digits; what is too small for a C++ stream to read is 0."""
    return repr(float(value)) if abs(value) > TOLERANCES.subnormal else "0.0"


def build(text: str, tree: UrdfTree, chain: list[str], place: str) -> Any:
    """The ``pin.Model`` of a chain, equal to the records.

    Args:
        text: the records as a URDF, as :func:`document` writes them.
        tree: the records.
        chain: names of the moving joints from root to tool.
        place: what to call the file in messages.

    Raises:
        StructureError: more joints than the engine can hold.
        UrdfError: the engine refuses the document, or made something else of it.
    """
    if len(chain) > MOST_JOINTS:
        raise StructureError(
            f"{place}: {len(chain)} moving joints on the way to the tool; at most {MOST_JOINTS}"
        )
    try:
        model = pin.buildModelFromXML(text)
    except (ValueError, RuntimeError, IndexError) as problem:
        reason = " ".join(str(problem).split())[:200]
        raise UrdfError(f"{place}: Pinocchio cannot read it: {reason}") from None
    model.gravity.linear = tree.gravity
    _compare(model, tree, chain, place)
    model.armature = np.array([tree.armature.get(name, 0.0) for name in chain])
    model.lowerPositionLimit = np.array([tree.joints[name].lower for name in chain])
    model.upperPositionLimit = np.array([tree.joints[name].upper for name in chain])
    return model


def _compare(model: Any, tree: UrdfTree, chain: list[str], place: str) -> None:
    """Refuses a model that is not what the records say.

    Raises:
        UrdfError: naming the joint or link.
    """
    if [str(name) for name in model.names][1:] != chain or model.nq != len(chain):
        raise UrdfError(f"{place}: Pinocchio read other joints than {', '.join(chain)}")
    index = {name: i for i, name in enumerate(["", *chain])}
    carrier, poses = _bodies(tree, chain)
    inertias = np.zeros((len(index), 6, 6))
    # what the sums are made of, so that what cancels is not asked for to the last digit
    sizes = np.full((len(index), 2, 2), 1e-300)
    frames = {str(frame.name): frame for frame in model.frames if frame.type == pin.FrameType.BODY}
    for name, link in tree.links.items():
        frame, i, pose = frames.get(name), index[carrier[name]], poses[name]
        if frame is None or int(frame.parentJoint) != i:
            raise UrdfError(f"{place}: Pinocchio placed link {name!r} elsewhere")
        _same(frame.placement.homogeneous, pose, f"{place}: placement of link {name!r}")
        body = link.inertial
        if body is not None:
            lever = float(np.linalg.norm(body.com) + np.linalg.norm(pose[:3, 3]))
            tensor = np.max(np.abs(body.inertia)) + body.mass * lever**2
            inertias[i] += _spatial_inertia(body, pose)
            sizes[i] += [[body.mass, body.mass * lever], [body.mass * lever, tensor]]
    for i, name in enumerate(chain, 1):
        joint = tree.joints[name]
        where = f"{place}: joint {name!r}"
        parent = poses[joint.parent] @ joint.placement
        _same(model.jointPlacements[i].homogeneous, parent, f"{where}: placement")
        slides = joint.kind == "prismatic"
        subspace = np.concatenate([slides * joint.axis, (not slides) * joint.axis])
        _same(_direction(model, i), subspace, f"{where}: axis")
        miss = np.abs(model.inertias[i].matrix() - inertias[i]).reshape(2, 3, 2, 3)
        if np.any(miss.max(axis=(1, 3)) > TOLERANCES.urdf_echo * sizes[i]):
            raise UrdfError(f"{where}: Pinocchio read another mass, centre or inertia behind it")
        for key, vector in (
            ("lower", model.lowerPositionLimit),
            ("upper", model.upperPositionLimit),
            ("velocity", model.upperVelocityLimit),
            ("effort", model.upperEffortLimit),
            ("damping", model.damping),
            ("friction", model.friction),
        ):
            if float(vector[i - 1]) != float(_digits(getattr(joint, key))):
                raise UrdfError(f"{where}: Pinocchio read another {key}")


def _bodies(tree: UrdfTree, chain: list[str]) -> tuple[dict[str, str], dict[str, Array]]:
    """The joint that carries each link ("" for the floor), and the link's pose in its frame."""
    below = tree.below()
    carrier, poses = {tree.root: ""}, {tree.root: np.eye(4)}
    order = [tree.root]
    moves = set(chain)
    for link in order:
        for joint in below[link]:
            order.append(joint.child)
            if joint.name in moves:
                carrier[joint.child], poses[joint.child] = joint.name, np.eye(4)
            else:
                carrier[joint.child] = carrier[link]
                poses[joint.child] = poses[link] @ joint.placement
    return carrier, poses


def _spatial_inertia(body: Inertial, pose: Array) -> Array:
    """Mass of a link about the frame that its own has this pose in, (6, 6), linear first."""
    turned = pose[:3, :3] @ body.rotation
    x, y, z = pose[:3, :3] @ body.com + pose[:3, 3]
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    first = body.mass * cross
    about = turned @ body.inertia @ turned.T - first @ cross
    return np.block([[body.mass * np.eye(3), -first], [first, about]])


def _direction(model: Any, index: int) -> Array:
    record = model.joints[index]
    data = record.createData()
    record.calc(data, np.zeros(model.nq))
    return np.asarray(data.S, dtype=float).reshape(6)


def _same(read: Array, meant: Array, where: str) -> None:
    if not np.all(
        np.abs(read - meant) <= TOLERANCES.urdf_echo * max(1.0, float(np.max(np.abs(meant))))
    ):
        raise UrdfError(f"{where}: Pinocchio read something else than the file says")
