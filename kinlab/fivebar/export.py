"""A five-bar as files for other programs: MJCF with its loop, or URDF with a loop sidecar.

MJCF holds the loop (``equality/connect``); MuJoCo and Pinocchio's
``buildModelAndConstraintsFromMJCF`` both read what is written here. For that, everything hangs
in one base body without a joint, the anchors are sites, gravity is explicit, and joint zero is
an assembled pose. MuJoCo's loop is a stiff spring (impedance 0.9999, the stiffest it takes), so
its accelerations agree to about 1e-4; Pinocchio's reader ignores gravity: set
``model.gravity.linear`` after reading.

URDF cannot hold a loop: the tree goes into the URDF (zero: all bars along
x), and what it leaves out into a TOML file beside it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np
import tomli_w
from numpy.typing import ArrayLike

from kinlab.arrays import Array
from kinlab.errors import FileError, InertiaError, StateError
from kinlab.fivebar.arguments import HANGING, JOINTS, Mode
from kinlab.fivebar.geometry import solve_pose
from kinlab.host.files import write_text

if TYPE_CHECKING:
    from kinlab.fivebar.linkage import FiveBar

_EFFORT, _VELOCITY, _FULL_TURN = "1000", "100", repr(2.0 * np.pi)
"""URDF demands limits; these do not bind."""

_COLOURS = ("0.33 0.47 0.60 1", "0.86 0.47 0.20 1")


def to_mjcf(linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING) -> str:
    """MJCF text whose joint zero is the pose with the tool at ``xy``.

    Args:
        linkage: the five-bar; every bar needs a mass and an inertia, as MuJoCo demands.
        xy: tool of the reference pose, (2,), m.
        mode: signs of u_i x w_i.

    Raises:
        InertiaError: a bar without mass or inertia, by name.
        UnreachableError: xy is out of reach. StateError: xy is not one point.
    """
    angles = _reference(linkage, xy, mode)
    root = ElementTree.Element("mujoco", model=linkage.name)
    ElementTree.SubElement(root, "compiler", angle="radian")
    gravity = _numbers([*linkage.gravity, 0.0])
    ElementTree.SubElement(root, "option", gravity=gravity, timestep="0.001", integrator="RK4")
    world = ElementTree.SubElement(root, "worldbody")
    base = ElementTree.SubElement(world, "body", name="base")
    for leg in range(2):
        _mjcf_leg(linkage, leg, angles[2 * leg : 2 * leg + 2], base)
    loops = ElementTree.SubElement(root, "equality")
    ElementTree.SubElement(
        loops,
        "connect",
        name="loop",
        site1="end_1",
        site2="end_2",
        solref="0.002 1",
        solimp="0.9999 0.9999 0.001 0.5 2",
    )
    actuators = ElementTree.SubElement(root, "actuator")
    for joint in ("crank_1", "crank_2"):
        ElementTree.SubElement(actuators, "motor", name=f"{joint}_motor", joint=joint, gear="1")
    return _text(root, linkage)


def _reference(linkage: FiveBar, xy: ArrayLike, mode: Mode) -> Array:
    """(theta_1, psi_1, theta_2, psi_2) of the reference pose."""
    pose = solve_pose(linkage, xy, mode)
    if len(pose.xy) != 1:
        raise StateError(f"{linkage.name}: the reference pose is one point (2,)")
    theta = np.arctan2(pose.u[0, :, 1], pose.u[0, :, 0])
    psi = np.arctan2(pose.sine[0], np.einsum("ij,ij->i", pose.u[0], pose.w[0]))
    return np.stack([theta, psi], axis=1).ravel()


def _mjcf_leg(linkage: FiveBar, leg: int, angles: Array, base: ElementTree.Element) -> None:
    l1, l2 = float(linkage.l1[leg]), float(linkage.l2[leg])
    rotor = linkage.reflected_inertia
    parent, x = base, float(linkage.base_x[leg])
    for part, length, angle in (("crank", l1, angles[0]), ("rod", l2, angles[1])):
        quaternion = _numbers([np.cos(0.5 * angle), 0.0, 0.0, np.sin(0.5 * angle)])
        body = ElementTree.SubElement(
            parent, "body", name=f"{part}_{leg + 1}", pos=_numbers([x, 0.0, 0.0]), quat=quaternion
        )
        mass, com, spin = body_inertia(linkage, part, leg)
        if mass <= 0.0 or spin <= 0.0:
            raise InertiaError(
                f"{linkage.name}: {part} {leg + 1} has mass {mass:g} kg and inertia {spin:g} "
                "kg m^2; MuJoCo needs both positive for every moving body"
            )
        joint = JOINTS[2 * leg + (part == "rod")]
        armature = repr(float(rotor[leg])) if part == "crank" else "0"
        ElementTree.SubElement(
            body, "joint", name=joint, type="hinge", axis="0 0 1", armature=armature
        )
        ElementTree.SubElement(
            body,
            "inertial",
            pos=_numbers([com, 0.0, 0.0]),
            mass=repr(mass),
            diaginertia=_numbers([spin] * 3),
        )
        ElementTree.SubElement(
            body,
            "geom",
            type="capsule",
            size=repr(0.03 * length),
            rgba=_COLOURS[leg],
            fromto=_numbers([0.0, 0.0, 0.0, length, 0.0, 0.0]),
            contype="0",
            conaffinity="0",
        )
        parent, x = body, length
    ElementTree.SubElement(parent, "site", name=f"end_{leg + 1}", pos=_numbers([l2, 0.0, 0.0]))


def body_inertia(linkage: FiveBar, part: str, leg: int) -> tuple[float, float, float]:
    """Mass, centre along the bar and inertia about it; the payload rides at the end of rod 1."""
    mass, com, spin = (
        float(getattr(linkage, f"{part}_{what}")[leg]) for what in ("mass", "com", "inertia")
    )
    if part == "crank" or leg == 1 or linkage.payload == 0.0:
        return mass, com, spin
    load, at = linkage.payload, float(linkage.l2[0])
    total = mass + load
    return total, (mass * com + load * at) / total, spin + mass * load / total * (at - com) ** 2


def to_urdf(linkage: FiveBar) -> str:
    """URDF text of the tree cut at the tool; q = 0 has all bars along x.

    Links: base_link, crank_1, rod_1, tool (on rod 1), crank_2, rod_2, loop_end (on rod 2).
    The loop, gravity and rotor inertia are in :func:`loop_sidecar`.
    """
    robot = ElementTree.Element("robot", name=linkage.name.replace(" ", "_"))
    ElementTree.SubElement(robot, "link", name="base_link")
    for leg, end in enumerate(("tool", "loop_end")):
        parent, x = "base_link", float(linkage.base_x[leg])
        for part in ("crank", "rod"):
            name = f"{part}_{leg + 1}"
            length = float(np.asarray(linkage.l1 if part == "crank" else linkage.l2)[leg])
            _urdf_link(robot, name, length, body_inertia(linkage, part, leg))
            joint = JOINTS[2 * leg + (part == "rod")]
            element = _urdf_joint(robot, joint, "revolute", parent, name, x)
            ElementTree.SubElement(element, "axis", xyz="0 0 1")
            ElementTree.SubElement(
                element,
                "limit",
                effort=_EFFORT,
                velocity=_VELOCITY,
                lower=f"-{_FULL_TURN}",
                upper=_FULL_TURN,
            )
            parent, x = name, length
        ElementTree.SubElement(robot, "link", name=end)
        _urdf_joint(robot, f"{end}_joint", "fixed", parent, end, x)
    return _text(robot, linkage)


def _urdf_link(
    robot: ElementTree.Element, name: str, length: float, inertia: tuple[float, float, float]
) -> None:
    link = ElementTree.SubElement(robot, "link", name=name)
    mass, com, spin = inertia
    if mass > 0.0 or spin > 0.0:
        element = ElementTree.SubElement(link, "inertial")
        ElementTree.SubElement(element, "origin", xyz=_numbers([com, 0.0, 0.0]), rpy="0 0 0")
        ElementTree.SubElement(element, "mass", value=repr(mass))
        tensor = {"ixx": spin, "iyy": spin, "izz": spin, "ixy": 0.0, "ixz": 0.0, "iyz": 0.0}
        ElementTree.SubElement(element, "inertia", {k: repr(v) for k, v in tensor.items()})
    visual = ElementTree.SubElement(link, "visual")
    middle = _numbers([0.5 * length, 0.0, 0.0])
    ElementTree.SubElement(visual, "origin", xyz=middle, rpy="0 0 0")
    geometry = ElementTree.SubElement(visual, "geometry")
    size = _numbers([length, 0.06 * length, 0.06 * length])
    ElementTree.SubElement(geometry, "box", size=size)


def _urdf_joint(
    robot: ElementTree.Element, name: str, kind: str, parent: str, child: str, x: float
) -> ElementTree.Element:
    joint = ElementTree.SubElement(robot, "joint", name=name, type=kind)
    ElementTree.SubElement(joint, "parent", link=parent)
    ElementTree.SubElement(joint, "child", link=child)
    ElementTree.SubElement(joint, "origin", xyz=_numbers([x, 0.0, 0.0]), rpy="0 0 0")
    return joint


def loop_sidecar(linkage: FiveBar, xy: ArrayLike, mode: Mode = HANGING) -> str:
    """TOML text of what the URDF cannot hold: the loop, what is driven, gravity, rotors.

    Args:
        linkage: the five-bar.
        xy: tool of a pose in which the loop is closed, (2,), m.
        mode: its working mode.

    Raises:
        UnreachableError: xy is out of reach. StateError: xy is not one point.
    """
    angles = _reference(linkage, xy, mode)
    ends = linkage.l2
    rotor = linkage.reflected_inertia
    document: dict[str, Any] = {
        "mechanism": linkage.name,
        "actuated": ["crank_1", "crank_2"],
        "gravity": [*linkage.gravity.tolist(), 0.0],
        "armature": {"crank_1": float(rotor[0]), "crank_2": float(rotor[1])},
        "closed_pose": dict(zip(JOINTS, angles.tolist(), strict=True)),
        "loop": [
            {
                "type": "point",
                "plane": "xy",
                "link_1": "rod_1",
                "point_1": [float(ends[0]), 0.0, 0.0],
                "link_2": "rod_2",
                "point_2": [float(ends[1]), 0.0, 0.0],
            }
        ],
    }
    return tomli_w.dumps(document)


def export(linkage: FiveBar, path: str | Path, xy: ArrayLike, mode: Mode = HANGING) -> list[Path]:
    """Writes ``.xml`` (MJCF), or ``.urdf`` with ``<name>.loop.toml`` beside it.

    Returns:
        The files written.

    Raises:
        FileError: another suffix, or a file that cannot be written.
        InertiaError, UnreachableError: as :func:`to_mjcf`.
    """
    file = Path(path)
    texts = {}
    if file.suffix.lower() == ".xml":
        texts[file] = to_mjcf(linkage, xy, mode)
    elif file.suffix.lower() == ".urdf":
        texts[file] = to_urdf(linkage)
        texts[file.with_suffix(".loop.toml")] = loop_sidecar(linkage, xy, mode)
    else:
        raise FileError(f"{file}: name a .xml file for MJCF or a .urdf file for URDF with its loop")
    for target, text in texts.items():
        write_text(target, text)
    return list(texts)


def _numbers(values: list[float]) -> str:
    return " ".join(repr(float(v)) for v in values)


def _text(root: ElementTree.Element, linkage: FiveBar) -> str:
    about = f" {linkage.name}. {linkage.source} ".replace("--", "- -")
    root.insert(0, ElementTree.Comment(about))
    ElementTree.indent(root, "  ")
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(root, "unicode") + "\n"
