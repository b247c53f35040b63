"""From records to the engine, and back again to see that nothing changed on the way.

The engine gets a document that is written here: bodies and joints only, every number with all
its digits, every default written out, joints beside the chain as fixed ones. Then the loaded
model is compared with the records, placement by placement and inertia by inertia.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin

from kinlab.arrays import Array
from kinlab.errors import StructureError, UrdfError
from kinlab.model.urdf_records import Inertial, JointRecord, UrdfTree
from kinlab.tolerances import TOLERANCES

MOST_JOINTS = 100
"""Most moving joints of a chain: the engine's memory grows with the cube, 70 MB at 100."""


def document(tree: UrdfTree, chain: list[str]) -> str:
    """Writes the records as a URDF without pictures.

    Args:
        tree: the records.
        chain: names of the joints that move; all others are written as fixed.

    Returns:
        URDF text; numbers as ``repr`` prints them, so that reading them gives the same bits.
    """
    from lxml import etree

    root = etree.Element("robot", name=tree.name or "robot")
    for link in tree.links.values():
        element = etree.SubElement(root, "link", name=link.name)
        if link.inertial is not None:
            write_inertial(element, link.inertial)
    for joint in tree.joints.values():
        _write_joint(root, joint, joint.name in chain)
    text: str = etree.tostring(root, encoding="unicode")
    return text


def build(tree: UrdfTree, chain: list[str], place: str) -> Any:
    """The ``pin.Model`` of a chain, equal to the records.

    Args:
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
        model = pin.buildModelFromXML(document(tree, chain))
    except (ValueError, RuntimeError, IndexError) as problem:
        reason = " ".join(str(problem).split())[:200]
        raise UrdfError(f"{place}: Pinocchio cannot read it: {reason}") from None
    model.gravity.linear = tree.gravity
    armature = np.array([tree.armature.get(name, 0.0) for name in chain])
    _compare(model, tree, chain, place)
    model.armature = armature
    for key, name in (("lower", "lowerPositionLimit"), ("upper", "upperPositionLimit")):
        setattr(model, name, np.array([getattr(tree.joints[joint], key) for joint in chain]))
    return model


def spatial_inertia(inertial: Inertial) -> Array:
    """Mass of a link about its own frame, (6, 6), linear first."""
    c = inertial.com
    cross = np.array([[0.0, -c[2], c[1]], [c[2], 0.0, -c[0]], [-c[1], c[0], 0.0]])
    result = np.zeros((6, 6))
    result[:3, :3] = inertial.mass * np.eye(3)
    result[:3, 3:] = -inertial.mass * cross
    result[3:, :3] = inertial.mass * cross
    turned = inertial.rotation @ inertial.inertia @ inertial.rotation.T
    result[3:, 3:] = turned - inertial.mass * cross @ cross
    return result


def write_inertial(link: Any, inertial: Inertial) -> None:
    """Adds an ``<inertial>`` to an lxml element ``<link>``."""
    from lxml import etree

    element = etree.SubElement(link, "inertial")
    etree.SubElement(element, "origin", xyz=_text(inertial.com), rpy=_text(inertial.rpy))
    etree.SubElement(element, "mass", value=_digits(inertial.mass))
    i = inertial.inertia
    entries = {
        "ixx": i[0, 0],
        "ixy": i[0, 1],
        "ixz": i[0, 2],
        "iyy": i[1, 1],
        "iyz": i[1, 2],
        "izz": i[2, 2],
    }
    etree.SubElement(element, "inertia", {key: _digits(x) for key, x in entries.items()})


def _write_joint(root: Any, joint: JointRecord, moves: bool) -> None:
    from lxml import etree

    kind = "prismatic" if joint.kind == "prismatic" else "revolute"
    element = etree.SubElement(root, "joint", name=joint.name, type=kind if moves else "fixed")
    etree.SubElement(element, "parent", link=joint.parent)
    etree.SubElement(element, "child", link=joint.child)
    etree.SubElement(element, "origin", xyz=_text(joint.xyz), rpy=_text(joint.rpy))
    if moves:
        etree.SubElement(element, "axis", xyz=_text(joint.axis))
        limits = ("lower", "upper", "effort", "velocity")
        etree.SubElement(element, "limit", {key: _digits(getattr(joint, key)) for key in limits})
        losses = ("damping", "friction")
        etree.SubElement(element, "dynamics", {key: _digits(getattr(joint, key)) for key in losses})


def _text(values: Array) -> str:
    return " ".join(_digits(value) for value in values)


def _digits(value: float) -> str:
    """All digits; what is too small for a C++ stream to read is 0."""
    return repr(float(value)) if abs(value) > TOLERANCES.subnormal else "0.0"


def _compare(model: Any, tree: UrdfTree, chain: list[str], place: str) -> None:
    """Refuses a model that is not what the records say.

    Raises:
        UrdfError: naming the joint or link.
    """
    if [str(name) for name in model.names][1:] != chain or model.nq != len(chain):
        raise UrdfError(f"{place}: Pinocchio read other joints than {', '.join(chain)}")
    carrier, poses = _bodies(tree, chain)
    inertias = {name: np.zeros((6, 6)) for name in ("", *chain)}
    sizes = {name: np.zeros((6, 6)) for name in ("", *chain)}
    frames = {str(frame.name): frame for frame in model.frames if frame.type == pin.FrameType.BODY}
    for name, link in tree.links.items():
        frame = frames.get(name)
        joint = carrier[name]
        index = chain.index(joint) + 1 if joint else 0
        if frame is None or int(frame.parentJoint) != index:
            raise UrdfError(f"{place}: Pinocchio placed link {name!r} elsewhere")
        _same(frame.placement.homogeneous, poses[name], f"{place}: placement of link {name!r}")
        if link.inertial is not None:
            own, twist = spatial_inertia(link.inertial), _twist(poses[name])
            inertias[joint] += twist.T @ own @ twist
            # what the sums are made of, so that what cancels is not asked for to the last digit
            sizes[joint] += np.abs(twist).T @ _blocks(np.abs(own)) @ np.abs(twist)
    for index, name in enumerate(chain, 1):
        joint_record = tree.joints[name]
        where = f"{place}: joint {name!r}"
        parent = poses[joint_record.parent] @ joint_record.placement
        _same(model.jointPlacements[index].homogeneous, parent, f"{where}: placement")
        _same(_direction(model, index), _subspace(joint_record), f"{where}: axis")
        miss = np.abs(model.inertias[index].matrix() - inertias[name])
        if np.any(miss > TOLERANCES.urdf_echo * np.maximum(_blocks(sizes[name]), 1e-300)):
            raise UrdfError(f"{where}: Pinocchio read another mass, centre or inertia behind it")
        for key, vector in (
            ("lower", model.lowerPositionLimit),
            ("upper", model.upperPositionLimit),
            ("velocity", model.upperVelocityLimit),
            ("effort", model.upperEffortLimit),
            ("damping", model.damping),
            ("friction", model.friction),
        ):
            if float(vector[index - 1]) != float(_digits(getattr(joint_record, key))):
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


def _twist(pose: Array) -> Array:
    """Takes a twist of the carrying frame to the frame that has this pose in it, (6, 6)."""
    rotation, p = pose[:3, :3], pose[:3, 3]
    cross = np.array([[0.0, -p[2], p[1]], [p[2], 0.0, -p[0]], [-p[1], p[0], 0.0]])
    twist = np.zeros((6, 6))
    twist[:3, :3], twist[3:, 3:] = rotation.T, rotation.T
    twist[:3, 3:] = -rotation.T @ cross
    return twist


def _blocks(sizes: Array) -> Array:
    """Size of each 3 by 3 block, spread over it."""
    return np.kron(sizes.reshape(2, 3, 2, 3).max(axis=(1, 3)), np.ones((3, 3)))


def _direction(model: Any, index: int) -> Array:
    record = model.joints[index]
    data = record.createData()
    record.calc(data, np.zeros(model.nq))
    return np.asarray(data.S, dtype=float).reshape(6)


def _subspace(joint: JointRecord) -> Array:
    zero = np.zeros(3)
    slides = joint.kind == "prismatic"
    return np.concatenate([joint.axis, zero] if slides else [zero, joint.axis])


def _same(read: Array, meant: Array, where: str) -> None:
    if not np.all(
        np.abs(read - meant) <= TOLERANCES.urdf_echo * max(1.0, float(np.max(np.abs(meant))))
    ):
        raise UrdfError(f"{where}: Pinocchio read something else than the file says")
